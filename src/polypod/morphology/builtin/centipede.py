"""A giant centipede: twenty plated segments, each with a pair of legs, and poison claws."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import GLOSS, SHELL, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb
from polypod.morphology.builtin.stance import folded_leg, outward_side

CHESTNUT, UMBER, TEAL, HONEY, RED, INK = (
    "#5f2c17", "#24130d", "#22322c", "#d99a3a", "#a8341a", "#0c0807",
)  # fmt: skip

PAIRS = 20
PITCH = 0.064  # m, from a segment to the next
HIP_HEIGHT, CENTRE_HEIGHT = 0.08, 0.090
FOOT_DISTANCE = 0.100  # m in plan, from the hip
FAN = (78.0, 102.0)  # degrees from +Z toward +X: where the first and the last leg reach
SEGMENTS = (0.017, 0.056, 0.054, 0.042)  # coxa with trochanter, prefemur with femur, tibia, tarsus
BENDS = (-38.0, 92.0, 16.0)
SEGMENT_NAMES = ("Coxa", "Femur", "Tibia", "Tarsus")
LEG_PROFILE = (
    (0.0, 0.0090),
    (0.9, 0.0068),
    (1.5, 0.0074),
    (2.0, 0.0058),
    (3.1, 0.0044),
    (4.0, 0.0),
)
LEG_PAINT = Paint(
    ((0.0, RED), (0.8, HONEY), (2.4, HONEY), (3.1, RED), (4.0, UMBER)),
    bands=((2.0, 0.08, CHESTNUT), (3.0, 0.08, CHESTNUT)),
)


def build() -> BuiltIn:
    """Return the centipede."""
    centipede = Sculpture("centipede")
    # Numbered from the front, as zoologists do; the skeleton's root is the hindmost.
    numbers = range(PAIRS, 0, -1)
    place = {number: PITCH * (0.5 * (PAIRS + 1) - number) for number in numbers}
    spine = [*(f"Segment{number}" for number in numbers), "Head"]
    neck = place[1] + 0.72 * PITCH
    heights = [*(CENTRE_HEIGHT for _ in numbers), 0.092]
    centipede.chain(
        spine, [(0.0, y, z) for y, z in zip(heights, [*place.values(), neck], strict=True)]
    )
    for number, z in place.items():
        _segment(centipede, number, z)
        _leg(centipede, number, z)
    _head(centipede, neck)
    _antennae(centipede, neck)
    _poison_claws(centipede, neck)
    _tail(centipede, place[PAIRS])
    return centipede.finish([f"LeftLeg{k}Coxa:LeftLeg{k}Foot" for k in numbers], spine)


def _width(number: int) -> float:
    """Return a segment's width over that of the widest; the body tapers to both ends."""
    return 0.76 + 0.24 * float(np.sin(np.pi * (number - 0.3) / (PAIRS + 0.8))) ** 0.7


def _segment(centipede: Sculpture, number: int, z: float) -> None:
    """Add a segment: a flat back plate whose hind edge overlaps the next, and a pale belly."""
    width = 0.046 * _width(number)
    long = 0.04 * (number % 2)  # plates are long and short by turns
    plate = body(
        (
            (0.0, 0.0895, z - (0.53 + long) * PITCH, 0.90 * width, 0.0175, 0.0150),
            (0.0, 0.0900, z - (0.49 + long) * PITCH, 0.97 * width, 0.0205, 0.0165),
            (0.0, 0.0905, z - 0.05 * PITCH, width, 0.0200, 0.0175),
            (0.0, 0.0900, z + 0.42 * PITCH, 0.86 * width, 0.0160, 0.0150),
            (0.0, 0.0900, z + 0.60 * PITCH, 0.70 * width, 0.0120, 0.0120),
        ),
        rings=6,
        sides=12,
        exponent=2.5,
    )
    paint = Paint(
        ((0.0, UMBER), (0.12, TEAL), (0.45, TEAL), (0.75, CHESTNUT), (1.0, RED)), HONEY, -0.35
    )
    centipede.add(plate, f"Segment{number}", paint, SHELL)


def _leg(centipede: Sculpture, number: int, z: float) -> None:
    """Add the left leg of a segment; legs fan out, and are longer toward the tail."""
    share = (number - 1.0) / (PAIRS - 1.0)
    turn = np.radians((1.0 - share) * FAN[0] + share * FAN[1])
    length = 0.98 + 0.12 * share**2
    hip = np.array([0.036 * _width(number), HIP_HEIGHT, z])
    out = np.array([np.sin(turn), 0.0, np.cos(turn)])
    foot = hip * (1.0, 0.0, 1.0) + FOOT_DISTANCE * length * out
    points = folded_leg(hip, foot, [length * part for part in SEGMENTS], BENDS)
    names = [f"LeftLeg{number}{segment}" for segment in SEGMENT_NAMES]
    centipede.chain(names, points, f"Segment{number}", marker=f"LeftLeg{number}Foot")
    patch = limb(points, LEG_PROFILE, sides=5, side=outward_side(points), corner=0.14)
    centipede.add(patch, (*names, f"LeftLeg{number}Foot"), LEG_PAINT, SHELL, blend=0.14)


def _head(centipede: Sculpture, z: float) -> None:
    """Add the flat round head with four simple eyes on each side."""
    head = body(
        (
            (0.0, 0.091, z - 0.034, 0.0),
            (0.0, 0.092, z - 0.024, 0.032, 0.014, 0.012),
            (0.0, 0.094, z + 0.010, 0.041, 0.018, 0.014),
            (0.0, 0.092, z + 0.038, 0.031, 0.014, 0.011),
            (0.0, 0.090, z + 0.054, 0.0),
        ),
        rings=13,
        sides=18,
        exponent=2.2,
    )
    paint = Paint(((0.0, CHESTNUT), (0.4, RED), (1.0, RED)), HONEY, -0.4)
    centipede.add(head, "Head", paint, SHELL)
    for x, y, ahead in ((0.033, 0.101, 0.027), (0.029, 0.103, 0.033), (0.036, 0.098, 0.021)):
        eye = ellipsoid((x, y, z + ahead), (0.0, 0.0, 0.0034), 0.0034, rings=4, sides=6)
        centipede.add(eye, "Head", plain(INK), GLOSS, both=True)


def _antennae(centipede: Sculpture, z: float) -> None:
    """Add the long beaded antennae, three joints each."""
    points = np.array(
        [
            (0.017, 0.097, z + 0.038),
            (0.056, 0.126, z + 0.104),
            (0.104, 0.128, z + 0.176),
            (0.156, 0.092, z + 0.240),
        ]
    )
    names = [f"LeftAntenna{k}" for k in (1, 2, 3)]
    centipede.chain(names, points, "Head", marker="LeftAntennaTip")
    beads = [
        (place + offset, (0.0064 - 0.0013 * place) * swell)
        for place in np.arange(0.1, 2.9, 0.25)
        for offset, swell in ((0.0, 1.0), (0.125, 0.78))
    ]
    antenna = limb(points, ((0.0, 0.0066), *beads, (3.0, 0.0)), sides=6, corner=0.1)
    paint = Paint(((0.0, RED), (1.5, HONEY), (3.0, CHESTNUT)))
    centipede.add(antenna, (*names, "LeftAntennaTip"), paint, SHELL, blend=0.2)


def _poison_claws(centipede: Sculpture, z: float) -> None:
    """Add the plate under the head and the poison claws it carries, each on a joint."""
    plate = ellipsoid((0.0, 0.080, z - 0.016), (0.0, 0.0, 0.036), 0.036, 0.012, rings=7, sides=12)
    centipede.add(plate, "Head", Paint(((0.0, HONEY), (1.0, RED))), SHELL)
    centipede.joint("LeftPoisonClaw", (0.028, 0.080, z - 0.012), "Head")
    claw = limb(
        [
            (0.026, 0.080, z - 0.016),
            (0.052, 0.076, z + 0.028),
            (0.036, 0.072, z + 0.064),
            (0.006, 0.070, z + 0.074),
        ],
        ((0.0, 0.014), (0.7, 0.0145), (1.0, 0.0115), (1.3, 0.0120), (2.0, 0.0072), (3.0, 0.0)),
        sides=8,
    )
    paint = Paint(((0.0, HONEY), (0.9, RED), (1.7, CHESTNUT), (2.2, INK), (3.0, INK)))
    centipede.add(claw, "LeftPoisonClaw", paint, GLOSS)


def _tail(centipede: Sculpture, z: float) -> None:
    """Add the tail plate and the last legs, which trail behind and do not walk."""
    bone = f"Segment{PAIRS}"
    plate = body(
        (
            (0.0, 0.088, z - 0.088, 0.0),
            (0.0, 0.089, z - 0.076, 0.022, 0.010, 0.010),
            (0.0, 0.090, z - 0.036, 0.032, 0.015, 0.014),
            (0.0, 0.090, z - 0.012, 0.0),
        ),
        rings=8,
        sides=14,
        exponent=2.3,
    )
    centipede.add(plate, bone, Paint(((0.0, RED), (1.0, CHESTNUT)), HONEY, -0.35), SHELL)
    points = np.array(
        [
            (0.020, 0.086, z - 0.058),
            (0.046, 0.104, z - 0.112),
            (0.070, 0.098, z - 0.166),
            (0.082, 0.074, z - 0.214),
            (0.084, 0.046, z - 0.252),
        ]
    )
    names = [f"LeftLastLeg{segment}" for segment in SEGMENT_NAMES]
    centipede.chain(names, points, bone, marker="LeftLastLegTip")
    last = limb(
        points,
        (
            (0.0, 0.0095),
            (0.6, 0.0110),
            (0.97, 0.0085),
            (1.4, 0.0100),
            (1.97, 0.0075),
            (2.4, 0.0085),
            (2.97, 0.0058),
            (3.3, 0.0060),
            (4.0, 0.0),
        ),
        sides=8,
        corner=0.1,
    )
    paint = Paint(((0.0, RED), (1.5, HONEY), (2.6, RED), (3.4, CHESTNUT), (4.0, INK)))
    centipede.add(last, (*names, "LeftLastLegTip"), paint, SHELL, blend=0.14)
