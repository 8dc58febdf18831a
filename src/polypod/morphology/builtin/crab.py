"""A shore crab as large as a dog: a wide toothed shell, claws, eight legs to the sides."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import GLOSS, SHELL, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb
from polypod.morphology.builtin.stance import folded_leg, outward_side

SHELL_TOP, SHELL_EDGE, CREAM, CORAL, INK = "#a63a22", "#c9653a", "#e8cfa8", "#d9542f", "#14100e"

# Leg, front to back: hip x, z; foot's heading from +Z toward +X in degrees and distance from the
# hip in plan; length relative to the segments below. All metres.
LEGS = (
    (0.150, 0.055, 62.0, 0.300, 0.98),
    (0.158, 0.015, 80.0, 0.320, 1.04),
    (0.156, -0.027, 99.0, 0.315, 1.03),
    (0.144, -0.066, 120.0, 0.285, 0.95),
)
HIP_HEIGHT = 0.25
SEGMENTS = (0.050, 0.190, 0.110, 0.150)
BENDS = (-34.0, 74.0, 44.0)
SEGMENT_NAMES = ("Coxa", "Merus", "Carpus", "Dactyl")
LEG_PROFILE = (
    (0.0, 0.022),
    (0.7, 0.021),
    (1.0, 0.017),
    (1.4, 0.021, 0.026),
    (1.9, 0.017, 0.020),
    (2.1, 0.017, 0.019),
    (2.6, 0.017, 0.020),
    (2.95, 0.012),
    (3.1, 0.012),
    (3.5, 0.009),
    (4.0, 0.0),
)
LEG_PAINT = Paint(
    ((0.0, SHELL_TOP), (1.5, CORAL), (2.9, SHELL_EDGE), (3.4, CREAM), (4.0, INK)), CREAM, -0.5
)


def build() -> BuiltIn:
    """Return the crab."""
    crab = Sculpture("crab")
    crab.joint("Body", (0.0, 0.268, 0.0))
    _shell(crab)
    _claw(crab)
    for number, (x, z, heading, distance, scale) in enumerate(LEGS, start=1):
        hip = np.array([x, HIP_HEIGHT, z])
        turn = np.radians(heading)
        foot = hip * (1.0, 0.0, 1.0) + distance * np.array([np.sin(turn), 0.0, np.cos(turn)])
        points = folded_leg(hip, foot, [scale * length for length in SEGMENTS], BENDS)
        names = [f"LeftLeg{number}{segment}" for segment in SEGMENT_NAMES]
        crab.chain(names, points, "Body", marker=f"LeftLeg{number}Foot")
        patch = limb(points, LEG_PROFILE, sides=8, side=outward_side(points), corner=0.10)
        crab.add(patch, (*names, f"LeftLeg{number}Foot"), LEG_PAINT, SHELL, blend=0.10)
    return crab.finish([f"LeftLeg{k}Coxa:LeftLeg{k}Foot" for k in (4, 3, 2, 1)])


def _shell(crab: Sculpture) -> None:
    """Add the carapace with its teeth, the eyes on stalks and the mouth."""
    carapace = body(
        (
            (0.0, 0.262, -0.125, 0.0),
            (0.0, 0.266, -0.112, 0.085, 0.024, 0.022),
            (0.0, 0.270, -0.060, 0.150, 0.046, 0.034),
            (0.0, 0.274, 0.000, 0.192, 0.058, 0.038),
            (0.0, 0.274, 0.050, 0.200, 0.052, 0.036),
            (0.0, 0.270, 0.095, 0.150, 0.036, 0.032),
            (0.0, 0.266, 0.118, 0.080, 0.022, 0.026),
            (0.0, 0.264, 0.126, 0.0),
        ),
        rings=24,
        sides=26,
        exponent=2.2,
    )
    paint = Paint(
        ((0.0, SHELL_TOP), (0.5, SHELL_TOP), (0.8, CORAL), (1.0, SHELL_EDGE)), CREAM, -0.25
    )
    crab.add(carapace, "Body", paint, SHELL)
    for x, z, outward in (
        (0.198, 0.040, 90.0),
        (0.193, 0.066, 70.0),
        (0.176, 0.088, 52.0),
        (0.150, 0.103, 36.0),
        (0.120, 0.114, 22.0),
    ):
        way = np.array([np.sin(np.radians(outward)), 0.05, np.cos(np.radians(outward))])
        root = np.array([x, 0.270, z]) - 0.008 * way
        tooth = limb([root, root + 0.026 * way], ((0.0, 0.013, 0.009), (1.0, 0.0)), sides=6)
        crab.add(tooth, "Body", Paint(((0.0, SHELL_EDGE), (1.0, CREAM))), SHELL, both=True)
    stalk = limb(
        [(0.040, 0.276, 0.108), (0.050, 0.304, 0.126), (0.052, 0.322, 0.132)],
        ((0.0, 0.009), (1.0, 0.007), (1.8, 0.008), (2.0, 0.0)),
        sides=8,
        pointed=False,
    )
    crab.add(stalk, "Body", plain(SHELL_EDGE), SHELL, both=True)
    eye = ellipsoid((0.052, 0.327, 0.133), (0.0, 0.013, 0.002), 0.011, rings=7, sides=10)
    crab.add(eye, "Body", plain(INK), GLOSS, both=True)
    jaw = ellipsoid((0.018, 0.250, 0.116), (0.0, 0.024, 0.0), 0.017, 0.012, rings=6, sides=8)
    crab.add(jaw, "Body", Paint(((0.0, CREAM), (1.0, SHELL_EDGE))), SHELL, both=True)
    feeler = limb(
        [(0.024, 0.272, 0.120), (0.036, 0.290, 0.175), (0.056, 0.300, 0.215)],
        ((0.0, 0.0035), (2.0, 0.0)),
        sides=5,
    )
    crab.add(feeler, "Body", plain(CORAL), SHELL, both=True)


def _claw(crab: Sculpture) -> None:
    """Add the left claw: arm, hand with its fixed finger, and the finger that moves."""
    points = np.array(
        [
            (0.118, 0.250, 0.088),
            (0.205, 0.262, 0.150),
            (0.185, 0.235, 0.230),
            (0.120, 0.215, 0.300),
        ]
    )
    names = ("LeftClawArm", "LeftClawWrist", "LeftClawHand")
    crab.chain(names, points, "Body")
    arm = limb(
        points,
        (
            (0.0, 0.020),
            (0.6, 0.026),
            (1.0, 0.022),
            (1.5, 0.030),
            (1.95, 0.022),
            (2.3, 0.036, 0.046),
            (2.7, 0.036, 0.048),
            (3.0, 0.022, 0.030),
        ),
        sides=12,
        corner=0.15,
    )
    paint = Paint(((0.0, SHELL_TOP), (2.0, CORAL), (3.0, SHELL_EDGE)), CREAM, -0.5)
    crab.add(arm, names, paint, SHELL, blend=0.12)
    crab.joint("LeftClawFinger", (0.122, 0.232, 0.296), "LeftClawHand")
    for bone, rise in (("LeftClawFinger", 0.024), ("LeftClawHand", -0.020)):
        finger = limb(
            [
                (0.124, 0.217 + rise, 0.290),
                (0.092, 0.222 + 1.7 * rise, 0.335),
                (0.052, 0.218 + 0.2 * rise, 0.362),
            ],
            ((0.0, 0.018), (1.0, 0.014), (2.0, 0.0)),
            sides=8,
        )
        crab.add(finger, bone, Paint(((0.0, SHELL_EDGE), (1.2, CREAM), (2.0, INK))), SHELL)
