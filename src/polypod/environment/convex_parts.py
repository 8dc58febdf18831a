"""A concave piece of a surface split into convex parts by the library coacd, once for each piece.

The library runs in a process of its own: on surfaces that it cannot deal with it may end the
process that it runs in. What it took seconds or minutes for is kept beside the compiled kernels.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import subprocess
import sys
import zipfile
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from polypod.cache import user_cache_folder
from polypod.errors import SceneError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_FACES = 200_000  # splitting more takes many minutes
FINEST, COARSEST = 0.01, 1.0
COARSER = 1.5  # where there are too many parts, so many times as much concavity is allowed
SPLIT_SECONDS = 600.0
# What reading an .npz raises that is none.
BROKEN = (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile)
WORKER = Path(__file__).with_name("split_alone.py")


def convex_parts(
    path: Path, points: FloatArray, faces: IntArray, concavity: float, most: int
) -> list[FloatArray]:
    """Return the corners [N, 3] of at most `most` convex parts of a concave piece.

    Args:
        path: the mesh's file, for errors.
        points: corners [N, 3] of a closed piece, m.
        faces: [T, 3] counter-clockwise from outside.
        concavity: how deep a part may be hollow beneath its hull, half extents.
        most: how many there may be; where that takes it, concavity is raised.

    Raises:
        SceneError: coacd is not installed or fails, or there are too many faces or parts.
    """
    if find_spec("coacd") is None:
        raise SceneError(
            f"{path}: the mesh is concave, and splitting it takes coacd: pip install coacd, or "
            "Polypod's extra meshes"
        )
    if len(faces) > MOST_FACES:
        raise SceneError(
            f"{path}: a concave piece has {len(faces)} faces; simplify it to {MOST_FACES} or fewer"
        )
    while True:
        parts = _parts_at(path, points, faces, concavity)
        if len(parts) <= most:
            return parts
        if concavity >= COARSEST:
            raise SceneError(
                f"{path}: the mesh takes {len(parts)} convex parts even at the coarsest concavity, "
                f"where most_parts leaves {most}; raise most_parts"
            )
        concavity = min(COARSER * concavity, COARSEST)


def _parts_at(
    path: Path, points: FloatArray, faces: IntArray, concavity: float
) -> list[FloatArray]:
    """Return the parts [N, 3] at a concavity, from the cache if they were made before."""
    packed = io.BytesIO()
    np.savez(packed, points=points, faces=faces.astype(np.int32), concavity=np.array(concavity))
    given = packed.getvalue()
    digest = hashlib.sha256(version("coacd").encode() + WORKER.read_bytes())
    for array in (points, faces, np.array(concavity)):
        digest.update(np.ascontiguousarray(array).tobytes() + repr(array.shape).encode())
    kept = user_cache_folder() / "meshes" / f"{digest.hexdigest()[:32]}.npz"
    with contextlib.suppress(*BROKEN):
        return _unpacked(kept.read_bytes())
    made = _run_coacd(path, given)
    try:
        parts = _unpacked(made)
    except BROKEN:
        raise SceneError(f"{path}: coacd found no solid in the mesh") from None
    # Without a cache it only takes longer.
    with contextlib.suppress(OSError):
        kept.parent.mkdir(parents=True, exist_ok=True)
        temporary = kept.with_name(f".{kept.stem}-{os.getpid()}")
        temporary.write_bytes(made)
        temporary.replace(kept)
    return parts


def _unpacked(made: bytes) -> list[FloatArray]:
    """Return the parts in an .npz of the other process; raise ValueError where there are none."""
    with np.load(io.BytesIO(made), allow_pickle=False) as archive:
        parts = [np.asarray(archive[name], np.float64) for name in sorted(archive.files)]
    if not parts or any(part.ndim != 2 or part.shape[1:] != (3,) for part in parts):
        raise ValueError("no parts")
    return parts


def _run_coacd(path: Path, given: bytes) -> bytes:
    """Return what the other process answers."""
    # Its threads wait asleep: awake they took ten times as long on a busy machine.
    surroundings = {**os.environ, "OMP_WAIT_POLICY": "passive"}
    # Without its folder on the path before others: it imports nothing of ours.
    command = [sys.executable, "-P", str(WORKER)]
    try:
        done = subprocess.run(
            command,
            input=given,
            capture_output=True,
            timeout=SPLIT_SECONDS,
            check=True,
            env=surroundings,
        )
    except (subprocess.SubprocessError, OSError) as error:
        words = "took too long" if isinstance(error, subprocess.TimeoutExpired) else "failed"
        raise SceneError(
            f"{path}: splitting the mesh into convex parts {words}; simplify the mesh, or raise "
            "concavity"
        ) from None
    return done.stdout
