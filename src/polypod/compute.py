"""How kernels are compiled: one decorator, one cache folder, threads over creatures.

A kernel is a Python function compiled by Numba. `NUMBA_DISABLE_JIT=1` runs the same source as plain
Python, for debugging and coverage.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any, TypeVar, cast

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

# Below this many creatures a thread costs more than it saves (measured: about 40 us a hand-over).
CREATURES_WORTH_A_THREAD = 2


def kernel(function: Function) -> Function:
    """Compile with Numba: cached on disk, IEEE division, free of the interpreter's lock."""
    compiled: Any = numba.njit(cache=True, error_model="numpy", nogil=True)(function)
    return cast(Function, compiled)


def thread_count() -> int:
    """Return how many threads kernels may use: `POLYPOD_THREADS`, or the cores of this process."""
    asked = os.environ.get("POLYPOD_THREADS", "")
    if asked.isdigit() and int(asked) > 0:
        return int(asked)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


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
