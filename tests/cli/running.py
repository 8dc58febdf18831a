"""Runs the command line in this process, so that kernels are compiled once for all tests."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from typing import NamedTuple

from polypod.cli import main


class Run(NamedTuple):
    """What a run left."""

    code: int
    out: str
    err: str


def polypod(*words: str) -> Run:
    """Run `polypod WORDS...`."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = main([str(word) for word in words])
    return Run(code, out.getvalue(), err.getvalue())


def assert_refused(run: Run, *parts: str) -> None:
    """Assert that a run said one sentence with the parts in it and ended with code 2."""
    assert run.code == 2, run
    assert run.out == ""
    assert run.err.startswith("polypod: ")
    assert run.err.endswith("\n")
    assert run.err.count("\n") == 1, run.err
    assert "Traceback" not in run.err
    for part in parts:
        assert part in run.err
