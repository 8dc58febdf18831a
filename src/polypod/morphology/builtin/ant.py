"""A worker ant the size of a dog: three parts, elbowed antennae, six slender legs."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import GLOSS, SHELL, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb
from polypod.morphology.builtin.stance import folded_leg, outward_side

RUST, DARK, AMBER, INK = "#7a3218", "#32150d", "#b4622c", "#0d0908"

# Leg, front to back: hip x, z; foot's heading from +Z toward +X in degrees and distance from the
# hip in plan; length relative to the segments below. All metres.
LEGS = (
    (0.040, 0.070, 36.0, 0.315, 0.97),
    (0.044, 0.000, 88.0, 0.310, 0.96),
    (0.040, -0.070, 143.0, 0.350, 1.07),
)
HIP_HEIGHT = 0.25
SEGMENTS = (0.055, 0.175, 0.165, 0.105)
BENDS = (-48.0, 96.0, 24.0)
SEGMENT_NAMES = ("Coxa", "Femur", "Tibia", "Tarsus")
LEG_PROFILE = (
    (0.0, 0.017),
    (0.6, 0.016),
    (1.0, 0.0095),
    (1.4, 0.0135),
    (1.95, 0.0075),
    (2.1, 0.0090),
    (2.5, 0.0098),
    (2.95, 0.0066),
    (3.1, 0.0060),
    (3.8, 0.0042),
    (4.0, 0.0),
)
LEG_PAINT = Paint(((0.0, RUST), (1.4, AMBER), (2.0, RUST), (3.0, AMBER), (4.0, DARK)))


def build() -> BuiltIn:
    """Return the ant."""
    ant = Sculpture("ant")
    ant.joint("Body", (0.0, 0.270, 0.0))
    ant.joint("Head", (0.0, 0.285, 0.130), "Body")
    ant.joint("Petiole", (0.0, 0.262, -0.115), "Body")
    ant.joint("Gaster", (0.0, 0.270, -0.175), "Petiole")
    _trunk(ant)
    _face(ant)
    for number, (x, z, heading, distance, scale) in enumerate(LEGS, start=1):
        hip = np.array([x, HIP_HEIGHT, z])
        turn = np.radians(heading)
        foot = hip * (1.0, 0.0, 1.0) + distance * np.array([np.sin(turn), 0.0, np.cos(turn)])
        points = folded_leg(hip, foot, [scale * length for length in SEGMENTS], BENDS)
        names = [f"LeftLeg{number}{segment}" for segment in SEGMENT_NAMES]
        ant.chain(names, points, "Body", marker=f"LeftLeg{number}Foot")
        patch = limb(points, LEG_PROFILE, sides=8, side=outward_side(points), corner=0.12)
        ant.add(patch, (*names, f"LeftLeg{number}Foot"), LEG_PAINT, SHELL, blend=0.12)
    return ant.finish([f"LeftLeg{k}Coxa:LeftLeg{k}Foot" for k in (3, 2, 1)])


def _trunk(ant: Sculpture) -> None:
    """Add the thorax in three humps, the petiole's node and the banded gaster."""
    thorax = body(
        (
            (0.0, 0.262, -0.112, 0.0),
            (0.0, 0.266, -0.090, 0.034, 0.030, 0.026),
            (0.0, 0.276, -0.050, 0.044, 0.042, 0.034),
            (0.0, 0.272, -0.012, 0.038, 0.030, 0.032),
            (0.0, 0.282, 0.035, 0.050, 0.046, 0.040),
            (0.0, 0.282, 0.080, 0.044, 0.038, 0.034),
            (0.0, 0.278, 0.112, 0.020, 0.018, 0.018),
            (0.0, 0.280, 0.125, 0.0),
        ),
        rings=24,
        sides=14,
    )
    shade = Paint(((0.0, DARK), (0.3, RUST), (0.5, DARK), (0.7, RUST), (1.0, DARK)), DARK, -0.4)
    ant.add(thorax, "Body", shade, SHELL)
    node = body(
        (
            (0.0, 0.258, -0.106, 0.014),
            (0.0, 0.262, -0.128, 0.015, 0.014, 0.012),
            (0.0, 0.270, -0.143, 0.021, 0.034, 0.016),
            (0.0, 0.264, -0.160, 0.014, 0.014, 0.012),
            (0.0, 0.268, -0.182, 0.014),
        ),
        rings=13,
        sides=12,
    )
    ant.add(node, "Petiole", Paint(((0.0, RUST), (0.5, AMBER), (1.0, DARK))), SHELL)
    gaster = body(
        (
            (0.0, 0.268, -0.168, 0.0),
            (0.0, 0.276, -0.200, 0.062, 0.052, 0.046),
            (0.0, 0.284, -0.260, 0.094, 0.080, 0.070),
            (0.0, 0.276, -0.335, 0.078, 0.064, 0.066),
            (0.0, 0.256, -0.395, 0.034, 0.028, 0.034),
            (0.0, 0.244, -0.418, 0.0),
        ),
        rings=22,
        sides=18,
    )
    bands = tuple((place, 0.030, AMBER) for place in (0.34, 0.55, 0.74))
    ant.add(
        gaster, "Gaster", Paint(((0.0, RUST), (0.3, DARK), (1.0, DARK)), None, 0.0, bands), SHELL
    )


def _face(ant: Sculpture) -> None:
    """Add the head with eyes, mandibles and elbowed antennae."""
    head = body(
        (
            (0.0, 0.284, 0.118, 0.0),
            (0.0, 0.290, 0.140, 0.056, 0.036, 0.034),
            (0.0, 0.290, 0.180, 0.078, 0.046, 0.042),
            (0.0, 0.278, 0.225, 0.064, 0.040, 0.038),
            (0.0, 0.262, 0.258, 0.038, 0.026, 0.024),
            (0.0, 0.258, 0.268, 0.0),
        ),
        rings=20,
        sides=18,
        exponent=2.3,
    )
    ant.add(head, "Head", Paint(((0.0, DARK), (0.5, RUST), (1.0, AMBER)), DARK, -0.5), SHELL)
    eye = ellipsoid((0.064, 0.305, 0.200), (0.006, 0.004, 0.018), 0.011, 0.015, rings=7, sides=10)
    ant.add(eye, "Head", plain(INK), GLOSS, both=True)
    mandible = limb(
        [
            (0.028, 0.252, 0.250),
            (0.046, 0.246, 0.290),
            (0.026, 0.240, 0.322),
            (0.003, 0.238, 0.318),
        ],
        ((0.0, 0.014, 0.012), (1.0, 0.013, 0.010), (2.0, 0.010, 0.007), (3.0, 0.0)),
        sides=8,
    )
    ant.add(mandible, "Head", Paint(((0.0, AMBER), (2.0, DARK), (3.0, INK))), GLOSS, both=True)
    antenna = limb(
        [
            (0.022, 0.292, 0.240),
            (0.085, 0.345, 0.290),
            (0.105, 0.322, 0.350),
            (0.112, 0.285, 0.408),
        ],
        (
            (0.0, 0.0075),
            (0.2, 0.0055),
            (0.95, 0.0050),
            (1.1, 0.0062),
            (2.0, 0.0066),
            (2.8, 0.0075),
            (3.0, 0.0),
        ),
        sides=7,
        pointed=False,
    )
    ant.add(antenna, "Head", Paint(((0.0, RUST), (1.0, AMBER), (3.0, DARK))), SHELL, both=True)
