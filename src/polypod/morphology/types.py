"""What a creature is: static data, made once and never changed by a walk.

The *body frame* is fixed to the trunk: metres, origin at the body centre, +Y up, +Z forward, +X to
the creature's left. "Rest" is the bind pose of the file seen in that frame; "stance" is how the
creature stands, which may be crouched or spread against the rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.spine import SpineTable
from polypod.rigs.gltf import GltfDocument

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


class LegTable(NamedTuple):
    """The K legs of a morphology, as kernels read them; M is the most joints any leg has.

    A leg's inverse kinematics turns `joint[k, :joint_count[k]]`, hip first, so that its *effector*
    reaches a place. Where the leg has a foot joint, the effector is that joint's pivot (the ankle),
    and the foot keeps an orientation of its own; otherwise the effector is the sole itself, fixed
    to the last joint.
    """

    joint_count: IntArray  # [K] joints turned by inverse kinematics
    joint: IntArray  # [K, M] row in the joint table, -1 beyond joint_count
    foot_joint: IntArray  # [K] row in the joint table of the oriented foot, -1 where there is none
    point_rest: (
        FloatArray  # [K, M + 1, 3] body frame, m: the pivots, then (at joint_count) effector
    )
    sole_rest: FloatArray  # [K, 3] body frame, m
    sole_stance: FloatArray  # [K, 3] body frame, m: where the sole is when the creature stands
    length: FloatArray  # [K] m, hip to sole along the chain
    foot_half_size: FloatArray  # [K, 2] m, half extents of the foot's shape along body x and z
    foot_behind: FloatArray  # [K] m, from the sole back to the middle of that shape
    roll_kind: IntArray  # [K] polypod.morphology.roll: FLAT, TOE_FIRST or HEEL_FIRST
    roll_pivot: FloatArray  # [K, 3] body frame, m, at rest: about it the heel rises
    toe_joint: (
        IntArray  # [K] row of the joint there, whose toes stay flat; -1: none, it is the sole
    )
    section_radius: FloatArray  # [K, M + 1] m, half the thickness from each point to the next, the
    # last of an oriented foot from ankle to sole; 0 beyond
    weight: FloatArray  # [K] share of the body's weight that the leg carries, sums to 1
    side: IntArray  # [K] +1 left, -1 right, 0 in the middle
    row: IntArray  # [K] 0 for the hindmost legs, counted forward
    upright: BoolArray  # [K] the leg stands below its hip; False: it sprawls
    bend_limit: FloatArray  # [K, M, 2] rad about the rest bend, NaN where the default holds
    hip_limit: FloatArray  # [K, 3] rad: flexion, sideways, twist of the first joint; NaN: default


class BodyTable(NamedTuple):
    """The trunk as kernels read it; body frame, metres."""

    thickness: float  # from the body centre down to the belly
    height: float  # from the soles in stance up to the body centre
    half_size: FloatArray  # [3] half extents of the trunk's box
    box_centre: FloatArray  # [3] centre of that box


@dataclass(frozen=True)
class RigSource:
    """The file behind a morphology and how its space maps to the body frame.

    `body_from_file` [4, 4] takes file world coordinates in the bind pose to the body frame: a
    uniform scale (metres per file unit), a turn to face +Z and a shift of the body centre.
    `joint_rest_file` [J, 4, 4] are the joints' world matrices in the bind pose, in file space.
    """

    document: GltfDocument
    body_from_file: FloatArray
    joint_rest_file: FloatArray


@dataclass(frozen=True)
class Morphology:
    """Everything known about a creature before it moves.

    A joint's pose is a rigid motion away from the rest: a position and a rotation that is the
    identity in the rest pose, so no convention of the file's own axes is needed here.
    J joints: all joints of all skins, and every node of a leg.
    """

    name: str
    source: RigSource
    joint_name: tuple[str, ...]  # [J] empty where the file has none
    joint_node: IntArray  # [J] node index in the file
    joint_parent: IntArray  # [J] row of the joint it rides on, -1: the body; parents come first
    joint_rest: FloatArray  # [J, 3] body frame, m
    legs: LegTable
    foot_name: tuple[str, ...]  # [K]
    foot_node: IntArray  # [K] node index to which the sole is fixed
    foot_offset: FloatArray  # [K, 3] the sole in that node's own frame and units
    spine: tuple[int, ...]  # rows of the joint table, from back to head; may be empty
    segments: SpineTable  # what of the spine bends, and what rides on it
    body: BodyTable
    guesses: tuple[str, ...]  # one sentence for each thing that was guessed
