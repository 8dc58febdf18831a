"""What a creature is made of inside, for the page to draw: limits of joints, spine, pelvis nodes.

All of it is given at rest in the body frame, with the row of the pose that carries it: what is
fixed to row `of` and at `place` at rest is at q place q* + t of that row's pose in a frame, whose
last row is the body itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from polypod.herd import Herd
from polypod.morphology.types import Morphology
from polypod.report.arrays import FloatArray

Fan = dict[str, Any]


def limit_fans(herd: Herd) -> list[Fan]:
    """Return how far each joint turns: a fan `of` a row, at a `place`, about an `axis`.

    It reaches from the `least` to the `most` angle, radians about the axis, of a direction `from`,
    at right angles to it. A hinge has one fan, a hip two, forward and sideways about its stance; a
    joint of the spine two, for yaw and pitch.
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
        limb, flexion = ik.limb_axis[leg], ik.flexion_axis[leg]
        for axis, limit in ((flexion, ik.hip_limit[leg, 0]),
                            (np.cross(limb, flexion), ik.hip_limit[leg, 1])):  # fmt: skip
            fans.append(_fan(of, ik.hip_rest[leg], axis, limb, -limit, limit))
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
            fans.append(
                _fan(
                    int(legs.joint[leg, joint - 1]),
                    legs.point_rest[leg, joint],
                    axis,
                    across / size,
                    float(ik.turn_low[leg, joint]),
                    float(ik.turn_high[leg, joint]),
                )
            )
    return fans


def _spine_fans(morphology: Morphology) -> list[Fan]:
    spine, fans = morphology.segments, []
    upward, left = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    for segment in range(1, len(spine.joint)):
        of = int(spine.joint[segment - 1])
        begin, end = spine.pivot_rest[segment], spine.pivot_rest[segment + 1]
        for axis, limit in zip((upward, left), spine.limit[segment], strict=False):
            along = (end - begin) - ((end - begin) @ axis) * axis
            size = float(np.linalg.norm(along))
            if size > 1e-9:
                fans.append(_fan(of, begin, axis, along / size, -float(limit), float(limit)))
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
