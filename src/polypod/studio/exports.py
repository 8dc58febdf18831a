"""What may be taken away: the walk as a GLB and a record, what is asked for as files."""

from __future__ import annotations

import copy
import io
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from polypod.errors import SettingError
from polypod.report.record import MEMBER_DATE, write_record
from polypod.rigs.export import glb_bytes
from polypod.studio.conductor import Conductor
from polypod.studio.document import Document
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.scenes import creature_toml, scene_toml, scene_zip
from polypod.studio.tape import NOTHING, Walk
from polypod.studio.world_files import WorldFiles


class Export(NamedTuple):
    """How a file is made: what is read between two frames, and how it is written after."""

    kind: str  # as browsers call it
    read: Callable[..., Any]  # (conductor, creature)
    write: Callable[[Any, GivenRigs, WorldFiles], bytes]


def _walk(conductor: Conductor, creature: int) -> Walk:
    if conductor.tape is None:
        raise SettingError(NOTHING)
    return conductor.tape.walk(creature)


def _document(conductor: Conductor, creature: int) -> Document:
    return copy.deepcopy(conductor.stage.document)


def _glb(walk: Walk, rigs: GivenRigs, files: WorldFiles) -> bytes:
    return glb_bytes(walk.recording)


def _npz(walk: Walk, rigs: GivenRigs, files: WorldFiles) -> bytes:
    with tempfile.TemporaryDirectory(prefix="polypod-studio-") as folder:
        file = Path(folder) / "walk.npz"
        write_record(walk.recording, file)
        # What a walk of the command line does not need: there all obstacles stand all the time.
        there = io.BytesIO()
        np.lib.format.write_array(there, walk.there, version=(1, 0), allow_pickle=False)
        with zipfile.ZipFile(file, "a", zipfile.ZIP_STORED) as archive:
            archive.writestr(zipfile.ZipInfo("obstacle_there.npy", MEMBER_DATE), there.getvalue())
        return file.read_bytes()


def _scene(document: Document, rigs: GivenRigs, files: WorldFiles) -> bytes:
    return scene_toml(document, rigs, files).encode()


def _scene_zip(document: Document, rigs: GivenRigs, files: WorldFiles) -> bytes:
    return scene_zip(document, rigs, files)


def _creature(document: Document, rigs: GivenRigs, files: WorldFiles) -> bytes:
    return creature_toml(document["creature"], rigs).encode()


EXPORTS = {
    "walk.glb": Export("model/gltf-binary", _walk, _glb),
    "walk.npz": Export("application/octet-stream", _walk, _npz),
    "scene.toml": Export("application/toml", _document, _scene),
    "scene.zip": Export("application/zip", _document, _scene_zip),
    "creature.toml": Export("application/toml", _document, _creature),
}
