"""A giant centipede: twenty segments, each with a pair of legs, and poison claws."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import GLOSS, SHELL, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb
from polypod.morphology.builtin.stance import folded_leg, outward_side

PLATE, DARK, HONEY, RED, INK = "#5a2a16", "#2a130c", "#d08a34", "#a5311a", "#0c0807"

PAIRS = 20
PITCH = 0.064  # m, from a segment to the next
HIP_HEIGHT = 0.08
SEGMENTS = (0.022, 0.058, 0.052, 0.040)
BENDS = (-46.0, 86.0, 34.0)
SEGMENT_NAMES = ("Coxa", "Femur", "Tibia", "Tarsus")
LEG_PROFILE = (
    (0.0, 0.0085),
    (1.0, 0.0062),
    (1.5, 0.0066),
    (2.0, 0.0052),
    (3.0, 0.0040),
    (4.0, 0.0),
)
LEG_PAINT = Paint(((0.0, RED), (1.0, HONEY), (3.0, HONEY), (4.0, DARK)))


def build() -> BuiltIn:
    """Return the centipede."""
    centipede = Sculpture("centipede")
    start = -0.5 * PITCH * (PAIRS - 1)
    # Numbered from the front, as zoologists do; the skeleton's root is the hindmost.
    place = {number: start + PITCH * (PAIRS - number) for number in range(1, PAIRS + 1)}
    spine = [f"Segment{number}" for number in range(PAIRS, 0, -1)]
    centres = [(0.0, 0.090, place[number]) for number in range(PAIRS, 0, -1)]
    centipede.chain([*spine, "Head"], [*centres, (0.0, 0.092, place[1] + 0.050)])
    for number in range(1, PAIRS + 1):
        _segment(centipede, number, place[number])
        _leg(centipede, number, place[number])
    _head(centipede, place[1] + 0.050)
    _tail(centipede, place[PAIRS])
    legs = [f"LeftLeg{k}Coxa:LeftLeg{k}Foot" for k in range(PAIRS, 0, -1)]
    return centipede.finish(legs, [*spine, "Head"])


def _width(number: int) -> float:
    """Return a segment's width over that of the widest."""
    return 0.74 + 0.26 * float(np.sin(np.pi * (number - 0.5) / PAIRS)) ** 0.7


def _segment(centipede: Sculpture, number: int, z: float) -> None:
    """Add a segment: a flattened plate that overlaps the next."""
    width = 0.046 * _width(number)
    plate = body(
        (
            (0.0, 0.090, z - 0.62 * PITCH, 0.0),
            (0.0, 0.090, z - 0.56 * PITCH, 0.86 * width, 0.014, 0.014),
            (0.0, 0.091, z - 0.10 * PITCH, width, 0.021, 0.018),
            (0.0, 0.090, z + 0.38 * PITCH, 0.88 * width, 0.016, 0.015),
            (0.0, 0.089, z + 0.50 * PITCH, 0.0),
        ),
        rings=9,
        sides=12,
        exponent=2.5,
    )
    paint = Paint(((0.0, DARK), (0.25, PLATE), (0.8, PLATE), (1.0, RED)), HONEY, -0.3)
    centipede.add(plate, f"Segment{number}", paint, SHELL)


def _leg(centipede: Sculpture, number: int, z: float) -> None:
    """Add the left leg of a segment; legs fan out, and are longer toward the tail."""
    share = (number - 1.0) / (PAIRS - 1.0)
    turn = np.radians(68.0 + 46.0 * share)
    length = 0.94 + 0.16 * share
    hip = np.array([0.034 * _width(number), HIP_HEIGHT, z])
    foot = hip * (1.0, 0.0, 1.0) + 0.112 * length * np.array([np.sin(turn), 0.0, np.cos(turn)])
    points = folded_leg(hip, foot, [length * part for part in SEGMENTS], BENDS)
    names = [f"LeftLeg{number}{segment}" for segment in SEGMENT_NAMES]
    centipede.chain(names, points, f"Segment{number}", marker=f"LeftLeg{number}Foot")
    patch = limb(points, LEG_PROFILE, sides=5, side=outward_side(points), corner=0.12)
    centipede.add(patch, (*names, f"LeftLeg{number}Foot"), LEG_PAINT, SHELL, blend=0.12)


def _head(centipede: Sculpture, z: float) -> None:
    """Add the head with antennae, eyes and the poison claws under it."""
    head = body(
        (
            (0.0, 0.091, z - 0.030, 0.0),
            (0.0, 0.092, z - 0.020, 0.034, 0.015, 0.014),
            (0.0, 0.093, z + 0.012, 0.040, 0.018, 0.016),
            (0.0, 0.090, z + 0.042, 0.026, 0.012, 0.012),
            (0.0, 0.089, z + 0.050, 0.0),
        ),
        rings=14,
        sides=16,
    )
    centipede.add(head, "Head", Paint(((0.0, RED), (1.0, RED)), HONEY, -0.4), SHELL)
    eye = ellipsoid((0.030, 0.100, z + 0.026), (0.0, 0.0, 0.006), 0.0055, rings=5, sides=8)
    centipede.add(eye, "Head", plain(INK), GLOSS, both=True)
    antenna = limb(
        [
            (0.016, 0.096, z + 0.040),
            (0.060, 0.120, z + 0.110),
            (0.110, 0.122, z + 0.190),
            (0.150, 0.100, z + 0.260),
        ],
        ((0.0, 0.0055), (1.0, 0.0045), (2.0, 0.0034), (3.0, 0.0)),
        sides=6,
    )
    centipede.add(antenna, "Head", Paint(((0.0, RED), (3.0, HONEY))), SHELL, both=True)
    claw = limb(
        [
            (0.028, 0.080, z - 0.010),
            (0.050, 0.074, z + 0.030),
            (0.034, 0.070, z + 0.064),
            (0.008, 0.068, z + 0.070),
        ],
        ((0.0, 0.012), (1.0, 0.0115), (2.0, 0.007), (3.0, 0.0)),
        sides=7,
    )
    centipede.add(claw, "Head", Paint(((0.0, RED), (1.5, HONEY), (3.0, INK))), GLOSS, both=True)


def _tail(centipede: Sculpture, z: float) -> None:
    """Add the last legs, which trail behind and do not walk."""
    trailing = limb(
        [
            (0.018, 0.090, z - 0.030),
            (0.050, 0.112, z - 0.090),
            (0.076, 0.098, z - 0.160),
            (0.090, 0.060, z - 0.220),
        ],
        ((0.0, 0.0085), (1.0, 0.0080), (2.0, 0.0055), (3.0, 0.0)),
        sides=6,
    )
    bone = f"Segment{PAIRS}"
    centipede.add(trailing, bone, Paint(((0.0, RED), (3.0, HONEY))), SHELL, both=True)
