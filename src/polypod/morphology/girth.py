"""How thick a leg is: each section's radius, from the skin that hangs on it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.limb import Limb
from polypod.morphology.skeleton import Skeleton

FloatArray = NDArray[np.float64]

# Where no skin tells: half the thickness, parts of the leg's length.
PLAIN = 0.02
LEAST = 0.002
# Skin is measured along this part of a section: at its ends it belongs to the joints.
MIDDLE = (0.1, 0.9)
FEWEST = 3  # vertices that tell a thickness
# Legs that lie closer together at rest than they are thick are one mass there: a section's radius
# is at most this part of its distance to the nearest section of another leg.
OF_GAP = 0.45
SAMPLES = 9  # places on a section


def leg_points(skeleton: Skeleton, limb: Limb) -> FloatArray:
    """Return [N + 1, 3] the ends of a leg's N sections, hip first, the sole last.

    Args:
        skeleton: the rig, metres.
        limb: the leg.
    """
    points = [*skeleton.position[list(limb.joints)], limb.effector]
    return np.array([*points, limb.sole.place] if limb.foot_joint >= 0 else points)


def section_radii(skeleton: Skeleton, limbs: list[Limb]) -> list[FloatArray]:
    """Return for each leg [N] m: half the thickness of its sections, hip first.

    The median distance of a section's own skin from its bone, so that neither a spike nor a joint's
    bulge counts, and never so much that legs at rest are inside one another.
    """
    points = [leg_points(skeleton, limb) for limb in limbs]
    radii = []
    for k, limb in enumerate(limbs):
        nodes = [*limb.joints, limb.foot_joint][: len(points[k]) - 1]
        of_skin = [
            _radius_of_skin(skeleton, node, points[k][i], points[k][i + 1], limb.length)
            for i, node in enumerate(nodes)
        ]
        room = OF_GAP * _gaps(points, k)
        radii.append(np.maximum(np.minimum(of_skin, room), LEAST * limb.length))
    return radii


def _radius_of_skin(
    skeleton: Skeleton, node: int, start: FloatArray, end: FloatArray, length: float
) -> float:
    """Return the median distance of a node's skin from its bone, m."""
    bone = end - start
    square = float(bone @ bone)
    skin = skeleton.vertex[skeleton.share([node]) >= 0.5]
    if square <= (1e-6 * length) ** 2 or not len(skin):
        return PLAIN * length
    along = (skin - start) @ bone / square
    inside = (along > MIDDLE[0]) & (along < MIDDLE[1])
    if np.count_nonzero(inside) < FEWEST:
        return PLAIN * length
    away = skin[inside] - start - along[inside, None] * bone
    return float(np.median(np.linalg.norm(away, axis=1)))


def _gaps(points: list[FloatArray], leg: int) -> FloatArray:
    """Return [N] each section's distance from the nearest other leg at rest, m."""
    share = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    others = [
        end_a + (end_b - end_a) * share
        for k, place in enumerate(points)
        if k != leg
        for end_a, end_b in pairwise(place)
    ]
    sections = len(points[leg]) - 1
    if not others:
        return np.full(sections, np.inf)
    about = np.concatenate(others)
    gaps = np.zeros(sections)
    for i in range(sections):
        own = points[leg][i] + (points[leg][i + 1] - points[leg][i]) * share
        gaps[i] = np.linalg.norm(own[:, None] - about[None], axis=2).min()
    return gaps
