"""Inner kernels: no machine code of their own, kept in the cache, and right when taken from it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from polypod.controller.moving import step_out
from polypod.jobs import compile_rest

MODULE = """
from polypod.compute import kernel


@kernel
def doubled(number: float) -> float:
    return 2.0 * number


@kernel
def shifted(number: float) -> float:
    return doubled(number) + 1.0


@kernel
def chained(number: float) -> float:
    return shifted(number) * shifted(doubled(number))
"""

RUN = """
from numba.core import event

counts = []


class Listener(event.Listener):
    def on_start(self, event):
        counts.append(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event):
        pass


event.register("numba:compile", Listener())
from chain import chained, doubled, shifted
from polypod.compute import prepare

{before}
print(chained(3.0), len(counts), len(shifted.inner.overloads))
"""

pytestmark = pytest.mark.skipif("NUMBA_DISABLE_JIT" in os.environ, reason="nothing is compiled")


def run(folder: Path, before: str = "") -> list[str]:
    environment = {**os.environ, "POLYPOD_CACHE": str(folder / "cache")}
    environment.pop("NUMBA_CACHE_DIR", None)
    environment["PYTHONPATH"] = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", RUN.format(before=before)],
        capture_output=True, text=True, env=environment, check=True,
    )  # fmt: skip
    return done.stdout.split()


def test_a_kernel_taken_from_the_cache_is_the_kernel(tmp_path: Path) -> None:
    (tmp_path / "chain.py").write_text(MODULE)
    assert run(tmp_path) == ["91.0", "3", "1"]
    # The outermost is found whole: not even its callees are loaded.
    assert run(tmp_path) == ["91.0", "0", "0"]


def test_what_another_process_prepared_is_taken_in(tmp_path: Path) -> None:
    (tmp_path / "chain.py").write_text(MODULE)
    prepared = run(tmp_path, "prepare(shifted, 1.0)\nchained = lambda number: number")
    assert prepared == ["3.0", "2", "1"]
    # Only the outermost is left to compile, from callees out of the cache.
    assert run(tmp_path) == ["91.0", "1", "1"]


def test_the_second_process_gets_to_its_end() -> None:
    compile_rest.main()
    last: Any = step_out
    assert last.inner.overloads


def test_an_inner_kernel_has_no_machine_code(tmp_path: Path) -> None:
    (tmp_path / "chain.py").write_text(MODULE)
    library = "next(iter(shifted.inner.overloads.values())).library"
    before = f"prepare(shifted, 1.0)\nprint({library}._codegen._engine.is_symbol_defined("
    before += "next(iter(shifted.inner.overloads.values())).fndesc.mangled_name))"
    assert run(tmp_path, before)[0] == "False"
