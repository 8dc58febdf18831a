"""A shore crab as large as a dog: a wide toothed shell, claws, eight legs to the sides."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import GLOSS, SHELL, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, embossed, limb
from polypod.morphology.builtin.stance import outward_side, spread_leg

UP = np.array([0.0, 1.0, 0.0])
BRICK, CORAL, OCHRE, CREAM, UMBER, INK = (
    "#8c2f1d", "#c4502f", "#cf7f45", "#e6cda4", "#3a1a12", "#100c0b",
)  # fmt: skip

# Leg, front to back: hip x, z; foot's heading from +Z toward +X in degrees and distance from the
# hip in plan; length relative to the segments below. All metres.
LEGS = (
    (0.140, 0.052, 53.0, 0.300, 1.02),
    (0.150, 0.013, 77.0, 0.305, 1.02),
    (0.148, -0.030, 103.0, 0.305, 1.02),
    (0.132, -0.072, 131.0, 0.300, 1.02),
)
HIP_HEIGHT = 0.25
SEGMENTS = (0.035, 0.165, 0.145, 0.160)  # coxa, merus, carpus with propodus, dactyl
BENDS = (-34.0, 82.0, 22.0)
SEGMENT_NAMES = ("Coxa", "Merus", "Propodus", "Dactyl")
# Place in joints, half widths across and up: the merus is a flat blade, the dactyl a pick.
LEG_PROFILE = (
    (0.0, 0.020),
    (0.7, 0.021),
    (1.0, 0.015),
    (1.25, 0.015, 0.025),
    (1.7, 0.014, 0.023),
    (1.95, 0.012, 0.014),
    (2.08, 0.014, 0.016),
    (2.3, 0.015, 0.018),
    (2.42, 0.013, 0.014),
    (2.65, 0.013, 0.017),
    (2.95, 0.010, 0.012),
    (3.1, 0.0095, 0.011),
    (3.5, 0.0075, 0.0085),
    (4.0, 0.0),
)
LEG_PAINT = Paint(
    ((0.0, BRICK), (1.5, BRICK), (2.2, CORAL), (2.9, OCHRE), (3.3, OCHRE), (4.0, UMBER)),
    belly=CREAM,
    belly_edge=-0.7,
    bands=((2.0, 0.05, OCHRE), (2.43, 0.04, OCHRE), (3.0, 0.05, CREAM)),
)
# Tooth of the shell's edge: root x, z, heading from +Z toward +X in degrees, length.
TEETH = (
    (0.190, 0.036, 84.0, 0.036),
    (0.184, 0.060, 66.0, 0.031),
    (0.168, 0.081, 52.0, 0.029),
    (0.145, 0.097, 40.0, 0.027),
    (0.118, 0.109, 28.0, 0.024),
    (0.084, 0.118, 16.0, 0.022),
)
# Bosses and grooves of the shell; those off the middle have a twin.
RELIEF = (
    (0.0, 0.050, 0.055, 0.010),
    (0.0, -0.062, 0.045, 0.009),
    (0.0, -0.008, 0.034, -0.008),
    (0.066, 0.054, 0.045, 0.009),
    (0.052, 0.004, 0.036, -0.011),
    (0.098, 0.034, 0.030, -0.009),
    (0.096, -0.038, 0.066, 0.012),
    (0.044, -0.074, 0.030, -0.008),
    (0.138, 0.034, 0.040, 0.008),
)


def build() -> BuiltIn:
    """Return the crab."""
    crab = Sculpture("crab")
    crab.joint("Body", (0.0, 0.268, 0.0))
    _shell(crab)
    _face(crab)
    _claw(crab)
    for number, leg in enumerate(LEGS, start=1):
        points = spread_leg(leg, HIP_HEIGHT, SEGMENTS, BENDS)
        names = [f"LeftLeg{number}{segment}" for segment in SEGMENT_NAMES]
        crab.chain(names, points, "Body", marker=f"LeftLeg{number}Foot")
        patch = limb(points, LEG_PROFILE, sides=8, side=outward_side(points), corner=0.08)
        crab.add(patch, (*names, f"LeftLeg{number}Foot"), LEG_PAINT, SHELL, blend=0.10)
    return crab.finish([f"LeftLeg{k}Coxa:LeftLeg{k}Foot" for k in (4, 3, 2, 1)])


def _shell(crab: Sculpture) -> None:
    """Add the carapace with its bosses, grooves and teeth, and the plates under it."""
    carapace = body(
        (
            (0.0, 0.266, -0.132, 0.0),
            (0.0, 0.268, -0.120, 0.086, 0.022, 0.024),
            (0.0, 0.272, -0.070, 0.138, 0.046, 0.034),
            (0.0, 0.274, -0.010, 0.182, 0.058, 0.038),
            (0.0, 0.273, 0.036, 0.198, 0.056, 0.036),
            (0.0, 0.271, 0.080, 0.172, 0.044, 0.032),
            (0.0, 0.269, 0.114, 0.112, 0.028, 0.028),
            (0.0, 0.268, 0.130, 0.058, 0.014, 0.018),
            (0.0, 0.267, 0.134, 0.0),
        ),
        rings=28,
        sides=32,
        exponent=1.75,
    )
    bosses = [(sign * x, z, radius, rise) for x, z, radius, rise in RELIEF
              for sign in ((1.0, -1.0) if x > 0.0 else (1.0,))]  # fmt: skip
    paint = Paint(
        ((0.0, UMBER), (0.2, BRICK), (0.6, BRICK), (0.85, CORAL), (1.0, OCHRE)), CREAM, -0.2
    )
    crab.add(embossed(carapace, bosses), "Body", paint, SHELL)
    for x, z, heading, length in TEETH:
        turn = np.radians(heading)
        way = np.array([np.sin(turn), 0.12, np.cos(turn)])
        root = np.array([x, 0.270, z]) - 0.012 * way
        tooth = limb(
            [root, root + (length + 0.012) * way],
            ((0.0, 0.017, 0.010), (0.5, 0.011, 0.007), (1.0, 0.0)),
            sides=6,
            side=np.cross(UP, way),
        )
        crab.add(tooth, "Body", Paint(((0.0, CORAL), (0.6, OCHRE), (1.0, CREAM))), SHELL, both=True)
    breast = ellipsoid((0.0, 0.242, -0.005), (0.0, 0.0, 0.100), 0.128, 0.026, rings=9, sides=16)
    crab.add(breast, "Body", plain(CREAM), SHELL)


def _face(crab: Sculpture) -> None:
    """Add the brow between the eyes, the eyes on stalks, the feelers and the mouth's lids."""
    for x, length in ((0.0, 0.020), (0.020, 0.017)):
        brow = limb(
            [(x, 0.270, 0.122), (1.15 * x, 0.270, 0.136 + length)],
            ((0.0, 0.012, 0.008), (0.6, 0.009, 0.006), (1.0, 0.0)),
            sides=6,
        )
        crab.add(brow, "Body", Paint(((0.0, CORAL), (1.0, OCHRE))), SHELL, both=x > 0.0)
    crab.joint("LeftEye", (0.050, 0.274, 0.118), "Body")
    stalk = limb(
        [(0.050, 0.270, 0.112), (0.056, 0.300, 0.134), (0.060, 0.324, 0.138)],
        ((0.0, 0.011), (0.6, 0.0075), (1.2, 0.0085), (2.0, 0.010)),
        sides=8,
        pointed=False,
    )
    crab.add(stalk, "LeftEye", Paint(((0.0, BRICK), (2.0, OCHRE))), SHELL)
    eye = ellipsoid((0.0605, 0.329, 0.139), (0.002, 0.015, 0.002), 0.0125, rings=7, sides=10)
    crab.add(eye, "LeftEye", plain(INK), GLOSS)
    lid = ellipsoid((0.0165, 0.240, 0.112), (0.0, 0.028, 0.006), 0.016, 0.010, rings=6, sides=8)
    crab.add(lid, "Body", Paint(((0.0, CREAM), (1.0, OCHRE))), SHELL, both=True)
    for points in (
        [(0.026, 0.262, 0.124), (0.040, 0.276, 0.190), (0.070, 0.268, 0.250)],
        [(0.010, 0.258, 0.124), (0.014, 0.262, 0.156), (0.010, 0.250, 0.170)],
    ):
        feeler = limb(points, ((0.0, 0.0042), (1.0, 0.0030), (2.0, 0.0)), sides=5)
        crab.add(feeler, "Body", Paint(((0.0, CORAL), (2.0, UMBER))), SHELL, both=True)


def _claw(crab: Sculpture) -> None:
    """Add the left claw: arm, wrist, swollen hand with a fixed finger, and the moving finger."""
    points = np.array(
        [
            (0.090, 0.254, 0.062),
            (0.160, 0.284, 0.144),
            (0.160, 0.260, 0.204),
            (0.090, 0.232, 0.290),
        ]
    )
    names = ("LeftClawArm", "LeftClawWrist", "LeftClawHand")
    crab.chain(names, points, "Body")
    crab.joint("LeftClawFinger", (0.104, 0.258, 0.274), "LeftClawHand")
    paint = Paint(((0.0, BRICK), (2.0, CORAL), (3.0, OCHRE)), CREAM, -0.6)
    arm = limb(
        points[:3],
        (
            (0.0, 0.018),
            (0.3, 0.024, 0.026),
            (0.8, 0.027, 0.028),
            (1.0, 0.021, 0.022),
            (1.2, 0.029),
            (1.7, 0.027),
            (2.0, 0.018),
        ),
        sides=12,
        corner=0.15,
    )
    crab.add(arm, names, paint, SHELL, blend=0.15)
    hand = body(
        (
            (0.166, 0.262, 0.196, 0.0),
            (0.158, 0.260, 0.210, 0.021, 0.022, 0.022),
            (0.140, 0.254, 0.236, 0.034, 0.042, 0.038),
            (0.116, 0.246, 0.262, 0.034, 0.044, 0.040),
            (0.094, 0.234, 0.286, 0.026, 0.026, 0.028),
            (0.074, 0.224, 0.308, 0.017, 0.016, 0.020),
            (0.052, 0.223, 0.330, 0.011, 0.010, 0.013),
            (0.032, 0.232, 0.343, 0.0),
        ),
        rings=16,
        sides=12,
        side=(0.76, 0.0, 0.65),
        pointed=True,
    )
    tip = Paint(
        ((0.0, BRICK), (0.5, CORAL), (0.75, OCHRE), (0.9, CREAM), (1.0, UMBER)), CREAM, -0.8
    )
    crab.add(hand, "LeftClawHand", tip, SHELL)
    finger = limb(
        [
            (0.112, 0.262, 0.260),
            (0.084, 0.280, 0.300),
            (0.052, 0.272, 0.333),
            (0.032, 0.243, 0.346),
        ],
        ((0.0, 0.017, 0.020), (0.8, 0.015, 0.018), (1.6, 0.011, 0.012), (2.4, 0.0075), (3.0, 0.0)),
        sides=10,
        side=(0.76, 0.0, 0.65),
    )
    jaw = Paint(((0.0, CORAL), (1.2, OCHRE), (2.3, CREAM), (3.0, UMBER)))
    crab.add(finger, "LeftClawFinger", jaw, SHELL)
    for share in (0.2, 0.45, 0.7):
        low = np.array([0.076, 0.234, 0.306]) + share * np.array([-0.040, 0.000, 0.034])
        high = np.array([0.076, 0.266, 0.308]) + share * np.array([-0.040, -0.010, 0.034])
        for bone, root, rise in (("LeftClawHand", low, 0.015), ("LeftClawFinger", high, -0.014)):
            tooth = limb([root, root + rise * UP], ((0.0, 0.0065), (1.0, 0.0)), sides=5)
            crab.add(tooth, bone, plain(CREAM), SHELL)
