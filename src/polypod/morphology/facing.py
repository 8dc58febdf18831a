"""Which way a creature faces in its file: by names, by symmetry, by its feet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polypod.errors import SettingError, choices
from polypod.morphology.names import has_word, side_hint
from polypod.morphology.skeleton import Skeleton

FloatArray = NDArray[np.float64]

UP = np.array([0.0, 1.0, 0.0])
DIRECTIONS = {
    "+z": np.array([0.0, 0.0, 1.0]),
    "-z": np.array([0.0, 0.0, -1.0]),
    "+x": np.array([1.0, 0.0, 0.0]),
    "-x": np.array([-1.0, 0.0, 0.0]),
}
HEAD = ("head", "skull", "jaw", "snout", "muzzle", "nose", "eye", "mouth", "neck", "beak")
TAIL = ("tail", "rump", "abdomen", "sting")
FRONT = ("front", "fore", "frnt")
BACK = ("back", "hind", "rear")
# Words that begin like a hint and mean something else.
NOT_FRONT = ("forearm", "forehead", "forefinger")
NOT_BACK = ("backbone",)
# A mirror image is believed when it fits this much better than the one across it.
CLEARLY_BETTER = 0.8


def turn_to_face(skeleton: Skeleton, forward: str | None) -> tuple[FloatArray, str, str]:
    """Find the turn about +Y that makes the creature face +Z.

    Args:
        skeleton: the rig in file space.
        forward: "+z", "-z", "+x", "-x", or None to find out.

    Returns:
        the rotation [3, 3], the direction's name, and a sentence about how it was guessed (empty
        where it was given).

    Raises:
        SettingError: `forward` is none of the four.
    """
    reason = ""
    if forward is None:
        forward, reason = guess_forward(skeleton)
        reason = f"it faces {forward} ({reason}); --forward says otherwise"
    key = str(forward).strip().lower()
    if key not in DIRECTIONS:
        raise SettingError(f"forward: must be one of {choices(DIRECTIONS)}, not {forward!r}")
    ahead = DIRECTIONS[key]
    left = np.cross(UP, ahead)
    return np.array([left, UP, ahead]), key, reason


def guess_forward(skeleton: Skeleton) -> tuple[str, str]:
    """Return the likeliest direction's name and what speaks for it."""
    size = max(float(np.linalg.norm(np.ptp(_body_points(skeleton), axis=0)[[0, 2]])), 1e-300)
    votes = {
        "names of left and right": _by_sides(skeleton),
        "names of head and tail": _by_ends(skeleton, HEAD, TAIL) / size,
        "names of front and back": _by_ends(skeleton, FRONT, BACK) / size,
    }
    total = sum(votes.values(), np.zeros(3))
    best = max(DIRECTIONS, key=lambda name: float(total @ DIRECTIONS[name]))
    if float(total @ DIRECTIONS[best]) > 0.02:
        reasons = [why for why, vote in votes.items() if float(vote @ DIRECTIONS[best]) > 0.02]
        return best, " and ".join(reasons)
    return _by_shape(skeleton)


def _body_points(skeleton: Skeleton) -> FloatArray:
    """Return the places of all joints that carry skin."""
    return skeleton.position[skeleton.is_joint & (skeleton.weight > 0.0)]


def _by_sides(skeleton: Skeleton) -> FloatArray:
    """Return a horizontal vector of length at most 1: forward by the names of left and right."""
    sides = np.array([side_hint(name) for name in skeleton.name])
    sides[~skeleton.is_joint | (skeleton.weight <= 0.0)] = 0
    if not ((sides > 0).any() and (sides < 0).any()):
        return np.zeros(3)
    across = skeleton.position[sides > 0].mean(axis=0) - skeleton.position[sides < 0].mean(axis=0)
    ahead = np.cross(across, UP)
    length = float(np.linalg.norm(ahead))
    return ahead / length if length > 0.0 else np.zeros(3)


def _by_ends(skeleton: Skeleton, ahead: tuple[str, ...], behind: tuple[str, ...]) -> FloatArray:
    """Return the way from the nodes named like `behind` to those named like `ahead`, in plan."""
    places = []
    for hints, others in ((ahead, NOT_FRONT), (behind, NOT_BACK)):
        rows = [
            node
            for node, name in enumerate(skeleton.name)
            if skeleton.is_joint[node]
            and skeleton.weight[node] > 0.0
            and has_word(name, *hints)
            and not has_word(name.replace("Arm", "arm").replace("Head", "head"), *others)
        ]
        places.append(skeleton.position[rows].mean(axis=0) if rows else None)
    middle = _body_points(skeleton).mean(axis=0)
    head, tail = places
    if head is None and tail is None:
        return np.zeros(3)
    way = (middle if head is None else head) - (middle if tail is None else tail)
    way[1] = 0.0
    return np.asarray(way)


def _by_shape(skeleton: Skeleton) -> tuple[str, str]:
    """Return the direction by the mirror plane, and its sign by where the toes and head are."""
    points = _body_points(skeleton)
    across_x, across_z = (mirror_misfit(points, axis)[0] for axis in (0, 2))
    axis = 0 if across_z < CLEARLY_BETTER * across_x else 2
    toes = _toes(skeleton, axis)
    low, high = points[:, axis].min(), points[:, axis].max()
    level = skeleton.ground + 0.9 * (skeleton.top - skeleton.ground)
    upper = skeleton.vertex[skeleton.vertex[:, 1] > level, axis]
    length = max(float(high - low), 1e-300)
    crest = (float(upper.mean()) - 0.5 * float(low + high)) / length
    lean = toes + (crest if abs(crest) > 0.1 else 0.0)
    sign = "-" if lean < -0.02 else "+"
    evidence = "its mirror plane, its toes and its head" if abs(lean) > 0.02 else "its mirror plane"
    return f"{sign}{'xyz'[axis]}", evidence


def _toes(skeleton: Skeleton, axis: int) -> float:
    """Return how far, as a share of height, soles reach beyond their ankles along an axis."""
    height = max(skeleton.top - skeleton.ground, 1e-300)
    low = skeleton.vertex[:, 1] < skeleton.ground + 0.03 * height
    reaches = []
    for node in np.unique(skeleton.carrier[low]):
        sole = skeleton.vertex[low & (skeleton.carrier == node)]
        middle = 0.5 * (sole[:, axis].min() + sole[:, axis].max())
        reaches.append(middle - skeleton.position[node, axis])
    return float(np.mean(reaches)) / height if reaches else 0.0


def mirror_misfit(points: FloatArray, axis: int) -> tuple[float, float]:
    """Return how badly points [n, 3] match their mirror image, and the mirror's place on the axis.

    The misfit is the mean distance from a mirrored point to the nearest point, in units of the
    points' spread.
    """
    spread = max(float(np.linalg.norm(np.ptp(points, axis=0))), 1e-300)
    centre = 0.5 * float(points[:, axis].min() + points[:, axis].max())
    places = (0.0, float(points[:, axis].mean()), centre)
    best = (np.inf, 0.0)
    for place in places:
        image = points.copy()
        image[:, axis] = 2.0 * place - image[:, axis]
        distance = np.linalg.norm(image[:, None] - points[None], axis=2).min(axis=1)
        best = min(best, (float(distance.mean()) / spread, place))
    return best
