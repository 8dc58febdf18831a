"""How kernels are compiled: one decorator, one cache folder, threads over creatures.

A kernel is a Python function compiled by Numba. `NUMBA_DISABLE_JIT=1` runs the same source as plain
Python, for debugging and coverage.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, cached_property, partial, update_wrapper
from types import FunctionType
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.core import config
from numba.extending import models, register_model, typeof_impl

from polypod.inner import make_inner

Function = TypeVar("Function", bound=Callable[..., Any])

# Numba's own type hints do not know all that is used of it.
unliteral: Any = types.unliteral
typeof: Any = numba.typeof
njit: Any = partial(numba.njit, cache=True, error_model="numpy", nogil=True)

# Below this many creatures a thread costs more than it saves (measured: about 40 us a hand-over).
CREATURES_WORTH_A_THREAD = 2


class Kernel:
    """A compiled function: one form for other kernels to call, and one for Python.

    Of all kernels only a few are ever called from Python; the wrappers that this takes were a
    quarter of the time to compile them all. So the inner form has none, and the other is compiled
    where it is asked for.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        update_wrapper(self, function)
        self.function = function
        self.inner = make_inner(function, njit)

    @cached_property
    def outer(self) -> Any:
        """The form for Python: the same code under a name of its own in the cache."""
        function = self.function
        twin = FunctionType(
            function.__code__, function.__globals__, function.__name__, function.__defaults__
        )
        twin.__qualname__ = f"{function.__qualname__}_from_python"
        return njit()(twin)

    def __call__(self, *arguments: Any) -> Any:
        """Run it, compiled for these arguments."""
        return self.outer(*arguments)


class KernelType(types.Dispatcher):
    """Numba's type of a kernel that a kernel calls: literal numbers make no form of their own."""

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        general = {name: unliteral(kind) for name, kind in kws.items()}
        return super().get_call_type(context, tuple(unliteral(kind) for kind in args), general)


register_model(KernelType)(models.OpaqueModel)


@typeof_impl.register(Kernel)
def _typeof_kernel(value: Kernel, context: Any) -> Any:
    return KernelType(value.inner)


def kernel(function: Function) -> Function:
    """Compile with Numba: cached on disk, IEEE division, free of the interpreter's lock."""
    if config.DISABLE_JIT:  # type: ignore[attr-defined]
        return function
    return cast(Function, Kernel(function))


def prepare(function: Any, *arguments: Any) -> None:
    """Compile the inner form of a kernel into the cache, for values or Numba's types of them."""
    kinds = [a if isinstance(a, types.Type) else typeof(a) for a in arguments]
    function.inner.compile(tuple(kinds))


def core_count() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def thread_count() -> int:
    """Return how many threads kernels may use: `POLYPOD_THREADS`, or the cores of this process."""
    asked = os.environ.get("POLYPOD_THREADS", "")
    if asked.isdigit() and int(asked) > 0:
        return int(asked)
    return core_count()


@cache
def _pool(workers: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(workers, thread_name_prefix="polypod")


def over_creatures(run: Callable[[int, int, int], Any], creature_count: int, threads: int) -> None:
    """Call `run(first, last, worker)` for ranges that together cover all creatures.

    Each creature writes only its own rows, so results are bit-identical for any thread count.
    `worker` is below `threads` and tells a call which scratch memory is its own.
    """
    workers = min(threads, creature_count // CREATURES_WORTH_A_THREAD)
    if workers <= 1:
        run(0, creature_count, 0)
        return
    bounds = [creature_count * i // workers for i in range(workers + 1)]
    pool = _pool(workers)
    waiting = [pool.submit(run, bounds[i], bounds[i + 1], i) for i in range(1, workers)]
    run(bounds[0], bounds[1], 0)
    for future in waiting:
        future.result()
