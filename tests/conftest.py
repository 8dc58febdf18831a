"""Shared fixtures: where the real rigs lie, if they are here at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

RIGS_FOLDER = Path(os.environ.get("POLYPOD_RIGS", Path(__file__).parents[2] / "shared" / "rigs"))


@pytest.fixture
def shared_rig() -> Callable[[str], Path]:
    """Return the path of a third-party rig by its name below the rigs folder, or skip the test."""

    def find(name: str) -> Path:
        path = RIGS_FOLDER / name
        if not path.is_file():
            pytest.skip(f"the third-party rig {name} is not in {RIGS_FOLDER}; set POLYPOD_RIGS")
        return path

    return find
