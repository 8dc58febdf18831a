"""The record of a walk: plain arrays, one file a creature, the same frames as the GLB."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from polypod.errors import SettingError, choices
from polypod.report.files import replacing

if TYPE_CHECKING:
    from polypod.morphology.types import Morphology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# A bone shorter than this share of the longest leg is two names for one place, not a bone.
SHORTEST_BONE = 1e-4
# Members of the archive carry this date, so that equal walks give equal bytes.
MEMBER_DATE = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True, eq=False)
class Recording:
    """A walk of one creature: F frames, J joints, K feet, O obstacles; world frame, metres.

    A point `x` of the body frame that is fixed to joint `j` at rest is found in frame `f` at
    `joint_position[f, j] + rotate(joint_rotation[f, j], x - morphology.joint_rest[j])`.
    """

    morphology: Morphology
    time: FloatArray  # [F] s, rising
    body_position: FloatArray  # [F, 3] m: the body frame's origin
    body_rotation: FloatArray  # [F, 4] x, y, z, w: the body frame's rotation
    joint_position: FloatArray  # [F, J, 3] m
    joint_rotation: FloatArray  # [F, J, 4] away from the rest pose, which is the identity
    foot_position: FloatArray  # [F, K, 3] m: the sole after inverse kinematics
    foot_target: FloatArray  # [F, K, 3] m: where the sole was planned to be
    foot_stance: BoolArray  # [F, K] the foot stands
    foot_support: IntArray  # [F, K] what it stands on: -1 the ground, else the obstacle's index
    obstacle_position: FloatArray  # [F, O, 3] m
    obstacle_rotation: FloatArray  # [F, O, 4]
    activity: IntArray  # [F] polypod.activity.Activity
    gait: NDArray[np.str_]  # [F] name of the gait that it walks in, or changes to

    def __post_init__(self) -> None:
        """Raise ValueError where an array has not the shape that its neighbours imply."""
        frames, feet = len(self.time), len(self.morphology.foot_name)
        joints = len(self.morphology.joint_node)
        obstacles = self.obstacle_position.shape[1]
        expected = {
            "time": (frames,),
            "body_position": (frames, 3),
            "body_rotation": (frames, 4),
            "joint_position": (frames, joints, 3),
            "joint_rotation": (frames, joints, 4),
            "foot_position": (frames, feet, 3),
            "foot_target": (frames, feet, 3),
            "foot_stance": (frames, feet),
            "foot_support": (frames, feet),
            "obstacle_position": (frames, obstacles, 3),
            "obstacle_rotation": (frames, obstacles, 4),
            "activity": (frames,),
            "gait": (frames,),
        }
        for name, shape in expected.items():
            if getattr(self, name).shape != shape:
                raise ValueError(f"{name} has shape {getattr(self, name).shape}, not {shape}")


class Recorder:
    """Collects the frames of a walk."""

    def __init__(self, morphology: Morphology, obstacle_count: int) -> None:
        """Prepare for a creature in a scene of `obstacle_count` obstacles."""
        self.morphology = morphology
        self.obstacle_count = obstacle_count
        self._frames: list[tuple[NDArray[Any], ...]] = []

    def add(
        self,
        time: float,
        body_position: ArrayLike,
        body_rotation: ArrayLike,
        joint_position: ArrayLike,
        joint_rotation: ArrayLike,
        foot_position: ArrayLike,
        foot_target: ArrayLike,
        foot_stance: ArrayLike,
        foot_support: ArrayLike,
        obstacle_position: ArrayLike,
        obstacle_rotation: ArrayLike,
        activity: int,
        gait: str = "",
    ) -> None:
        """Keep a copy of one frame; shapes as in `Recording` without the first axis."""
        obstacles = self.obstacle_count
        self._frames.append(
            (
                np.array(time, np.float64),
                np.array(body_position, np.float64),
                np.array(body_rotation, np.float64),
                np.array(joint_position, np.float64),
                np.array(joint_rotation, np.float64),
                np.array(foot_position, np.float64),
                np.array(foot_target, np.float64),
                np.array(foot_stance, np.bool_),
                np.array(foot_support, np.int64),
                np.array(obstacle_position, np.float64).reshape(obstacles, 3),
                np.array(obstacle_rotation, np.float64).reshape(obstacles, 4),
                np.array(activity, np.int64),
                np.array(gait, np.str_),
            )
        )

    def finish(self) -> Recording:
        """Return all frames kept so far as one recording.

        Raises:
            ValueError: no frame was added.
        """
        if not self._frames:
            raise ValueError("a recording needs at least one frame")
        return Recording(
            self.morphology, *(np.stack(frames) for frames in zip(*self._frames, strict=True))
        )


class Record(NamedTuple):
    """What a record file holds; F frames, K feet, J joints, B bones, O obstacles."""

    time: FloatArray  # [F] s
    foot_name: NDArray[np.str_]  # [K]
    foot_position: FloatArray  # [F, K, 3] world, m: the sole after inverse kinematics
    foot_target: FloatArray  # [F, K, 3] world, m: where the sole was planned to be
    foot_stance: BoolArray  # [F, K]
    foot_support: IntArray  # [F, K] -1 the ground, else the obstacle's index
    foot_node: IntArray  # [K] node index in the GLB
    foot_offset: FloatArray  # [K, 3] the sole in that node's own frame and units
    leg_length: FloatArray  # [K] m
    body_position: FloatArray  # [F, 3] world, m
    body_rotation: FloatArray  # [F, 4]
    joint_node: IntArray  # [J] node index in the GLB
    joint_name: NDArray[np.str_]  # [J] empty where the file has none
    joint_position: FloatArray  # [F, J, 3] world, m
    bone: IntArray  # [B, 2] rows of the joint table whose distance is constant
    obstacle_position: FloatArray  # [F, O, 3] world, m
    obstacle_rotation: FloatArray  # [F, O, 4]
    activity: IntArray  # [F] 0 walking, 1 standing, 2 arrived, 3 waiting, 4 blocked
    gait: NDArray[np.str_]  # [F] name of the gait


def bones(morphology: Morphology) -> IntArray:
    """Return the pairs [B, 2] of joints, consecutive in legs, spine and tail, at constant distance.

    Along a leg: the pivots that inverse kinematics turns, then the foot's joint, which is held at
    the effector even where the file does not hang it below the leg.
    """
    legs = morphology.legs
    row_of_node = {int(node): row for row, node in enumerate(morphology.joint_node)}
    least = SHORTEST_BONE * float(legs.length.max()) if len(legs.length) else 0.0
    pairs: list[tuple[int, int]] = []
    for leg, count in enumerate(legs.joint_count):
        chain = [int(row) for row in legs.joint[leg, :count]]
        if legs.foot_joint[leg] >= 0:
            chain.append(int(legs.foot_joint[leg]))
        tip = row_of_node.get(int(morphology.foot_node[leg]), -1)
        if tip >= 0 and tip not in chain and morphology.joint_parent[tip] == chain[-1]:
            chain.append(tip)
        pairs.extend(pairwise(chain))
    table = morphology.segments
    pairs.extend(pairwise(table.joint.tolist() if len(table.joint) else morphology.spine))
    if len(table.tail_joint):
        pairs.extend(pairwise([int(table.joint[0]), *table.tail_joint.tolist()]))
    rest = morphology.joint_rest
    kept = [(a, b) for a, b in pairs if np.linalg.norm(rest[a] - rest[b]) > least]
    return np.array(list(dict.fromkeys(kept)), np.int64).reshape(-1, 2)


def record_of(recording: Recording) -> Record:
    """Return the plain arrays of a recording, as they go into its file."""
    morphology = recording.morphology
    return Record(
        time=_floats(recording.time),
        foot_name=_names(morphology.foot_name),
        foot_position=_floats(recording.foot_position),
        foot_target=_floats(recording.foot_target),
        foot_stance=np.ascontiguousarray(recording.foot_stance, np.bool_),
        foot_support=np.ascontiguousarray(recording.foot_support, np.int64),
        foot_node=np.ascontiguousarray(morphology.foot_node, np.int64),
        foot_offset=_floats(morphology.foot_offset),
        leg_length=_floats(morphology.legs.length),
        body_position=_floats(recording.body_position),
        body_rotation=_floats(recording.body_rotation),
        joint_node=np.ascontiguousarray(morphology.joint_node, np.int64),
        joint_name=_names(morphology.joint_name),
        joint_position=_floats(recording.joint_position),
        bone=bones(morphology),
        obstacle_position=_floats(recording.obstacle_position),
        obstacle_rotation=_floats(recording.obstacle_rotation),
        activity=np.ascontiguousarray(recording.activity, np.int64),
        gait=_names(recording.gait),
    )


def write_record(recording: Recording, path: str | os.PathLike[str]) -> None:
    """Write a recording as an .npz of plain arrays; equal walks give equal bytes.

    Raises:
        SettingError: the folder does not exist or cannot be written to.
    """
    with (
        replacing(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_STORED) as archive,
    ):
        for name, values in record_of(recording)._asdict().items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, values, version=(1, 0), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", MEMBER_DATE), buffer.getvalue())


def read_record(path: str | os.PathLike[str]) -> Record:
    """Read a record file back.

    Raises:
        SettingError: the file is missing, is no record, or its arrays do not fit together.
    """
    source = Path(path)
    if not source.is_file():
        raise SettingError(f"there is no record file {source}")
    try:
        with np.load(source, allow_pickle=False) as archive:
            found = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, AttributeError) as error:
        raise SettingError(f"{source} is not a record of plain arrays (.npz)") from error
    missing = [name for name in Record._fields if name not in found]
    if missing:
        raise SettingError(f"{source} is not a record: it has no array {choices(missing)}")
    record = Record(**{name: found[name] for name in Record._fields})
    _check(record, source)
    return record


def _check(record: Record, source: Path) -> None:
    """Raise SettingError where an array has a kind, a shape or a value that no record has."""
    frames, feet, joints = (
        _rows(values) for values in (record.time, record.foot_name, record.joint_node)
    )
    obstacles = _rows(record.obstacle_position, axis=1)
    shapes: dict[str, tuple[str, tuple[int, ...]]] = {
        "time": ("f", (frames,)),
        "foot_name": ("U", (feet,)),
        "foot_position": ("f", (frames, feet, 3)),
        "foot_target": ("f", (frames, feet, 3)),
        "foot_stance": ("b", (frames, feet)),
        "foot_support": ("i", (frames, feet)),
        "foot_node": ("i", (feet,)),
        "foot_offset": ("f", (feet, 3)),
        "leg_length": ("f", (feet,)),
        "body_position": ("f", (frames, 3)),
        "body_rotation": ("f", (frames, 4)),
        "joint_node": ("i", (joints,)),
        "joint_name": ("U", (joints,)),
        "joint_position": ("f", (frames, joints, 3)),
        "bone": ("i", (_rows(record.bone), 2)),
        "obstacle_position": ("f", (frames, obstacles, 3)),
        "obstacle_rotation": ("f", (frames, obstacles, 4)),
        "activity": ("i", (frames,)),
        "gait": ("U", (frames,)),
    }
    for name, (kind, shape) in shapes.items():
        values = getattr(record, name)
        if values.dtype.kind != kind or values.shape != shape:
            raise SettingError(
                f"{source}: the array {name} is {values.dtype} {values.shape}, "
                f"where a record has {shape}"
            )
        if kind == "f" and not np.isfinite(values).all():
            raise SettingError(f"{source}: the array {name} holds numbers that are not finite")
    if frames and bool((np.diff(record.time) <= 0.0).any()):
        raise SettingError(f"{source}: the array time does not rise")
    if record.bone.size and not (record.bone.min() >= 0 and record.bone.max() < joints):
        raise SettingError(f"{source}: the array bone names joints beyond the {joints} there are")


def _rows(values: NDArray[Any], axis: int = 0) -> int:
    """Return the length of an axis, zero where the array has no such axis."""
    return int(values.shape[axis]) if values.ndim > axis else 0


def _floats(values: NDArray[Any]) -> FloatArray:
    return np.ascontiguousarray(values, np.float64)


def _names(names: Iterable[str]) -> NDArray[np.str_]:
    """Return names as fixed-width text; an empty list keeps the kind of text."""
    return np.array(list(names), np.str_)
