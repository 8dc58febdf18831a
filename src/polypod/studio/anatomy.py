"""What a creature is made of inside, for the page to draw: limits of joints, spine, pelvis nodes.

All of it is given at rest in the body frame, with the row of the pose that carries it: what is
fixed to row `of` and at `place` at rest is at q place q* + t of that row's pose in a frame, whose
last row is the body itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from polypod.herd import Herd
from polypod.morphology.creature import HIP_KEYS
from polypod.morphology.types import Morphology
from polypod.report.arrays import FloatArray

Fan = dict[str, Any]


def limit_fans(herd: Herd) -> list[Fan]:
    """Return how far each `joint` turns: a fan `of` a row, at a `place`, about an `axis`.

    It reaches from the `least` to the `most` angle, radians about the axis, of a direction `from`,
    at right angles to it. A fan is of one `key` of the joint's limits: a hinge has one, a hip and a
    joint of spine or tail three.
    """
    return [*_hip_fans(herd), *_hinge_fans(herd), *_spine_fans(herd.morphology)]


def spine_line(morphology: Morphology) -> list[dict[str, Any]]:
    """Return where the segments of the spine meet, from back to head: `of` and `place` of each."""
    spine = morphology.segments
    last = len(spine.joint) - 1
    return [
        {"of": int(spine.joint[min(i, last)]), "place": _listed(place)}
        for i, place in enumerate(spine.pivot_rest if last >= 0 else ())
    ]


def pelvis_nodes(morphology: Morphology) -> list[dict[str, Any]]:
    """Return the middle of each row of hips, from the hindmost: `of` and `place` of each."""
    legs = morphology.legs
    nodes = []
    for row in np.unique(legs.row):
        of_row = np.flatnonzero(legs.row == row)
        place = legs.point_rest[of_row, 0].mean(axis=0)
        nodes.append({"of": _carrier(morphology, int(of_row[0])), "place": _listed(place)})
    return nodes


def _carrier(morphology: Morphology, leg: int) -> int:
    """Return the row of the pose that a leg hangs on: its segment's joint, or the body."""
    spine = morphology.segments
    segment = int(spine.of_leg[leg])
    return int(spine.joint[segment]) if segment >= 0 else len(morphology.joint_node)


def _hip_fans(herd: Herd) -> list[Fan]:
    ik, fans = herd.tables.ik, []
    for leg in range(len(ik.joint_count)):
        of = _carrier(herd.morphology, leg)
        joint = int(herd.morphology.legs.joint[leg, 0])
        limb, flexion = ik.limb_axis[leg], ik.flexion_axis[leg]
        ways = (flexion, limb), (np.cross(limb, flexion), limb), (limb, flexion)
        for key, (axis, start), limit in zip(HIP_KEYS, ways, ik.hip_limit[leg], strict=True):
            fan = _fan(of, ik.hip_rest[leg], axis, start, -limit, limit)
            fans.append(fan | {"joint": joint, "key": key})
    return fans


def _hinge_fans(herd: Herd) -> list[Fan]:
    ik, legs, fans = herd.tables.ik, herd.morphology.legs, []
    for leg, count in enumerate(ik.joint_count):
        for joint in range(1, int(count)):
            axis = ik.axis[leg, joint]
            bone = ik.bone_rest[leg, joint]
            across = bone - (bone @ axis) * axis
            size = float(np.linalg.norm(across))
            # What does not bend, or lies along its own hinge, has nothing to show.
            if not axis.any() or size < 1e-9:
                continue
            fan = _fan(
                int(legs.joint[leg, joint - 1]),
                legs.point_rest[leg, joint],
                axis,
                across / size,
                float(ik.turn_low[leg, joint]),
                float(ik.turn_high[leg, joint]),
            )
            fans.append(fan | {"joint": int(legs.joint[leg, joint]), "key": "bend"})
    return fans


def _spine_fans(morphology: Morphology) -> list[Fan]:
    spine, fans = morphology.segments, []
    for index, hinge in enumerate(spine.hinge):
        if 0 < hinge < len(spine.joint):
            ends = spine.pivot_rest[hinge], spine.pivot_rest[hinge + 1]
            joint, of = int(spine.joint[index]), int(spine.joint[hinge - 1])
            fans += _three_ways(joint, of, *ends, spine.limit[hinge])
    for index, row in enumerate(spine.tail_joint):
        ends = spine.tail_pivot_rest[index], spine.tail_pivot_rest[index + 1]
        of = int(spine.tail_joint[index - 1] if index else spine.joint[0])
        fans += _three_ways(int(row), of, *ends, spine.tail_limit[index])
    return fans


def _three_ways(
    joint: int, of: int, begin: FloatArray, end: FloatArray, limit: FloatArray
) -> list[Fan]:
    """Return the fans of a joint of spine or tail: yaw, pitch and roll."""
    left, upward, ahead = np.eye(3)
    fans = []
    for key, axis, start, most in (
        ("yaw", upward, end - begin, limit[0]),
        ("pitch", left, end - begin, limit[1]),
        ("roll", ahead, upward, limit[2]),
    ):
        along = start - (start @ axis) * axis
        size = float(np.linalg.norm(along))
        if size > 1e-9:
            fan = _fan(of, begin, axis, along / size, -float(most), float(most))
            fans.append(fan | {"joint": joint, "key": key})
    return fans


def _fan(
    of: int, place: FloatArray, axis: FloatArray, start: FloatArray, least: float, most: float
) -> Fan:
    return {
        "of": of,
        "place": _listed(place),
        "axis": _listed(axis),
        "from": _listed(start),
        "least": float(least),
        "most": float(most),
    }


def _listed(values: FloatArray) -> list[float]:
    return [round(float(v), 6) for v in values]
