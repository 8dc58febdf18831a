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
from polypod.studio.rigs_given import GivenRigs, clean_name
from polypod.studio.scenes import creature_toml, scene_toml, scene_zip
from polypod.studio.tape import NOTHING, Tape, Walk
from polypod.studio.world_files import WorldFiles

MOST_BYTES = 512 << 20  # of the walks of all creatures together
WALKS = ("walk.glb", "walk.npz")
ALL = "all"


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


def ended_tape(conductor: Conductor) -> Tape:
    """Return the tape when nothing is added to it any more.

    Raises:
        SettingError: nothing was recorded, or the record is not at its end.
    """
    tape = conductor.tape
    if tape is None:
        raise SettingError(NOTHING)
    if tape.recording:
        raise SettingError("all creatures are exported together once the record has ended")
    return tape


def zip_of_walks(
    tape: Tape, name: str, export: Export, rigs: GivenRigs, files: WorldFiles
) -> bytes:
    """Return a zip of the walks of all creatures, each in a file of its own.

    Args:
        tape: that has ended.
        name: of the export, whose suffix the files have.
        export: how each is written.
        rigs: that were given.
        files: of the world.

    Raises:
        SettingError: nothing was recorded, or the files are too large together.
    """
    packed, total, creature = io.BytesIO(), 0, 0
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for i, kind in enumerate(tape.kinds):
            for number in range(1, kind.creatures + 1):
                content = export.write(tape.walk(creature), rigs, files)
                total += len(content)
                if total > MOST_BYTES:
                    raise SettingError(
                        f"{sum(kind.creatures for kind in tape.kinds)} walks have more than "
                        f"{MOST_BYTES >> 20} MiB; export creatures one by one, or record for less "
                        "time"
                    )
                # Two kinds may be called alike.
                member = clean_name(f"{i + 1}-{kind.name}-{number}.", Path(name).suffix)
                archive.writestr(zipfile.ZipInfo(member, MEMBER_DATE), content)
                creature += 1
    return packed.getvalue()


EXPORTS = {
    "walk.glb": Export("model/gltf-binary", _walk, _glb),
    "walk.npz": Export("application/octet-stream", _walk, _npz),
    "scene.toml": Export("application/toml", _document, _scene),
    "scene.zip": Export("application/zip", _document, _scene_zip),
    "creature.toml": Export("application/toml", _document, _creature),
}
