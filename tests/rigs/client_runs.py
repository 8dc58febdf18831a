"""Runs other people's glTF readers: the Khronos validator, three.js, Blender."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "clients"


def validator_errors(paths: list[Path]) -> list[dict[str, int]]:
    """How often the Khronos validator names each error code, per file."""
    reports: list[dict[str, Any]] = _run([_node(), "validate.mjs", *map(str, paths)])
    return [report["errors"] for report in reports]


def three_positions(path: Path, times: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """World positions [time, node, 3] that three.js gives the nodes in the last animation."""
    answer = _run([_node(), "play-three.mjs", *_arguments(path, times, nodes)])
    return np.array(answer["positions"])


def blender_positions(path: Path, times: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """World positions [time, node, 3] that Blender gives the nodes in the last animation."""
    answer = _run([_blender_python(), "play_blender.py", *_arguments(path, times, nodes)])
    assert answer["objects_playing"] > 0
    return np.array(answer["positions"])


def _arguments(path: Path, times: np.ndarray, nodes: np.ndarray) -> list[str]:
    # The file holds single precision: asked for these, a client stands exactly on a key.
    spelled = [repr(float(np.float32(time))) for time in times]
    return [str(path), ",".join(spelled), ",".join(str(node) for node in nodes)]


def _run(command: list[str]) -> Any:
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout.strip().splitlines()[-1])


@cache
def _node() -> str:
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node is not installed: the Khronos validator and three.js cannot be asked")
    if not (FOLDER / "node_modules").is_dir():
        pytest.skip("the Node clients are not installed: run `npm ci` in clients/")
    return node


@cache
def _blender_python() -> str:
    """The Python of an environment that has bpy: POLYPOD_BPY, or clients/.bpy."""
    home = FOLDER / ".bpy"
    beside = [home / "bin" / "python", home / "Scripts" / "python.exe"]
    asked = os.environ.get("POLYPOD_BPY")
    for python in [Path(asked)] if asked else beside:
        if python.is_file():
            return str(python)
    pytest.skip("Blender is not installed: run `python clients/install_blender.py`")
