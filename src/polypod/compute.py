"""How kernels are compiled: one decorator, one cache folder, threads over creatures.

A kernel is a Python function compiled by Numba. `NUMBA_DISABLE_JIT=1` runs the same source as plain
Python, for debugging and coverage.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., Any])

PACKAGE_FOLDER = Path(__file__).parent
# Below this many creatures a thread costs more than it saves (measured: about 40 us a hand-over).
CREATURES_WORTH_A_THREAD = 2


def user_cache_folder() -> Path:
    """Return the folder for compiled kernels, following each system's custom."""
    if "POLYPOD_CACHE" in os.environ:
        return Path(os.environ["POLYPOD_CACHE"])
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "polypod"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "polypod"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "polypod"


@cache
def source_digest() -> str:
    """Return a digest of all the package's sources.

    Numba's cache does not notice an edited callee in another file and then gives wrong answers, so
    the cache folder is named after all the sources together.
    """
    digest = hashlib.sha256()
    for path in sorted(PACKAGE_FOLDER.rglob("*.py")):
        digest.update(path.relative_to(PACKAGE_FOLDER).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def kernel_cache_folder() -> Path:
    """Return the folder that holds the kernels compiled from the present sources."""
    return user_cache_folder() / "kernels" / source_digest()


# Must be set before Numba is imported: it reads the variable once.
os.environ.setdefault("NUMBA_CACHE_DIR", str(kernel_cache_folder()))

import numba  # noqa: E402


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
