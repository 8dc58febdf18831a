"""A grey wolf: deep narrow chest, tucked waist, digitigrade legs; hip height 0.5 m."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.paws import add_paw
from polypod.morphology.builtin.sculpture import GLOSS, BuiltIn, Paint, Piece, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb

SADDLE, FUR, CREAM, TAN, INK = "#4b433c", "#85786a", "#d9cfbd", "#a28a6b", "#14110f"
AMBER, PAD = "#b9822c", "#2b2522"

# Joints of the middle, m. The spine runs in the upper third of the trunk, as backbones do.
SPINE = {
    "Pelvis": (0.0, 0.548, -0.225),
    "Spine1": (0.0, 0.562, -0.125),
    "Spine2": (0.0, 0.564, -0.025),
    "Spine3": (0.0, 0.558, 0.075),
    "Chest": (0.0, 0.552, 0.175),
    "Neck1": (0.0, 0.580, 0.285),
    "Neck2": (0.0, 0.634, 0.370),
    "Head": (0.0, 0.694, 0.448),
}
TAIL = (
    (0.0, 0.554, -0.325),
    (0.0, 0.520, -0.400),
    (0.0, 0.455, -0.447),
    (0.0, 0.380, -0.466),
    (0.0, 0.305, -0.478),
    (0.0, 0.225, -0.500),
)
RUMP = (0.0, 0.548, -0.270)  # inside the trunk, where the brush begins
# Hip, knee (forward), hock (back), ball of the paw; shoulder, elbow (back), wrist, ball.
HIND_LEG = (
    (0.075, 0.520, -0.230),
    (0.090, 0.350, -0.153),
    (0.080, 0.172, -0.305),
    (0.078, 0.043, -0.272),
)
FORE_LEG = (
    (0.074, 0.480, 0.240),
    (0.086, 0.348, 0.104),
    (0.078, 0.148, 0.140),
    (0.076, 0.040, 0.182),
)
HIND_NAMES = ("LeftThigh", "LeftShin", "LeftMetatarsus", "LeftHindPaw")
FORE_NAMES = ("LeftUpperArm", "LeftForearm", "LeftMetacarpus", "LeftForePaw")

# Sections from the rump to the nose: x, y, z, half widths across, up, down.
HIDE_SECTIONS = (
    (0.0, 0.515, -0.358, 0.0),
    (0.0, 0.515, -0.335, 0.052, 0.056, 0.060),
    (0.0, 0.525, -0.250, 0.088, 0.072, 0.105),
    (0.0, 0.536, -0.160, 0.084, 0.064, 0.122),
    (0.0, 0.536, -0.070, 0.082, 0.062, 0.138),
    (0.0, 0.530, 0.030, 0.094, 0.070, 0.178),
    (0.0, 0.525, 0.130, 0.103, 0.084, 0.210),
    (0.0, 0.532, 0.205, 0.100, 0.092, 0.208),
    (0.0, 0.560, 0.290, 0.090, 0.092, 0.170),
    (0.0, 0.612, 0.360, 0.084, 0.082, 0.130),
    (0.0, 0.660, 0.410, 0.081, 0.072, 0.104),
    (0.0, 0.692, 0.450, 0.083, 0.060, 0.088),
    (0.0, 0.706, 0.500, 0.072, 0.049, 0.058),
    (0.0, 0.700, 0.542, 0.055, 0.040, 0.046),
    (0.0, 0.684, 0.578, 0.036, 0.026, 0.034),
    (0.0, 0.674, 0.625, 0.029, 0.022, 0.025),
    (0.0, 0.668, 0.662, 0.023, 0.020, 0.019),
    (0.0, 0.666, 0.676, 0.0),
)
HIDE_PAINT = Paint(
    (
        (0.0, FUR),
        (0.15, SADDLE),
        (0.5, SADDLE),
        (0.68, FUR),
        (0.80, FUR),
        (0.88, SADDLE),
        (0.95, TAN),
        (1.0, SADDLE),
    ),
    CREAM,
    belly_edge=-0.35,
)
# Place in joints, half widths across, to the front, to the back.
HIND_PROFILE = (
    (0.0, 0.0),
    (0.05, 0.020, 0.034, 0.036),
    (0.13, 0.034, 0.056, 0.060),
    (0.25, 0.046, 0.074, 0.080),
    (0.42, 0.056, 0.086, 0.094),
    (0.60, 0.057, 0.083, 0.096),
    (0.80, 0.051, 0.068, 0.084),
    (1.00, 0.042, 0.050, 0.066),
    (1.18, 0.037, 0.040, 0.054),
    (1.40, 0.031, 0.032, 0.040),
    (1.70, 0.021, 0.022, 0.025),
    (1.97, 0.020, 0.019, 0.028),
    (2.15, 0.018, 0.018, 0.021),
    (2.60, 0.018, 0.018, 0.018),
    (2.88, 0.022, 0.022, 0.022),
    (3.00, 0.025, 0.025, 0.024),
)
FORE_PROFILE = (
    (0.0, 0.0),
    (0.08, 0.012, 0.026, 0.026),
    (0.25, 0.022, 0.046, 0.046),
    (0.50, 0.033, 0.058, 0.062),
    (0.80, 0.041, 0.062, 0.074),
    (1.05, 0.045, 0.062, 0.082),
    (1.30, 0.045, 0.058, 0.078),
    (1.60, 0.040, 0.048, 0.060),
    (1.85, 0.036, 0.039, 0.049),
    (2.02, 0.032, 0.034, 0.043),
    (2.20, 0.028, 0.031, 0.034),
    (2.50, 0.022, 0.024, 0.025),
    (2.85, 0.019, 0.020, 0.021),
    (3.00, 0.021, 0.022, 0.023),
    (3.30, 0.019, 0.020, 0.020),
    (3.80, 0.023, 0.024, 0.023),
    (4.00, 0.026, 0.026, 0.024),
)
LEG_PAINT = Paint(((0.0, FUR), (1.0, FUR), (1.8, TAN), (3.0, CREAM)))
FORE_PAINT = Paint(((0.0, SADDLE), (0.8, FUR), (2.0, TAN), (4.0, CREAM)))
HAUNCH = (0.046, 0.580, -0.245)  # where the thigh's mass begins
SEAM = 0.05  # how far around the roots of limbs the skin flows over, m
BLADE = (0.044, 0.575, 0.178)  # the upper end of the shoulder blade


def build() -> BuiltIn:
    """Return the wolf."""
    wolf = Sculpture("wolf")
    names = tuple(SPINE)
    wolf.chain(names, np.array(list(SPINE.values())))
    wolf.joint("Jaw", (0.0, 0.664, 0.490), "Head")
    tail = [f"Tail{k}" for k in range(1, len(TAIL))]
    wolf.chain(tail, TAIL, "Pelvis", marker="TailTip")
    wolf.chain(HIND_NAMES, HIND_LEG, "Pelvis")
    wolf.chain(FORE_NAMES, FORE_LEG, "Chest")
    hide = wolf.add(body(HIDE_SECTIONS, rings=64, sides=26), names, HIDE_PAINT, blend=0.45)
    brush = _tail(wolf, tail)
    _head(wolf)
    hind = limb((HAUNCH, *HIND_LEG[1:]), HIND_PROFILE, sides=14)
    hind_leg = wolf.add(hind, ("Pelvis", *HIND_NAMES), LEG_PAINT)
    fore = limb((BLADE, *FORE_LEG), FORE_PROFILE, sides=14, corner=0.4)
    fore_leg = wolf.add(fore, ("Chest", *FORE_NAMES), FORE_PAINT)
    wolf.fuse(hide, (brush, hind_leg, fore_leg), SEAM)
    add_paw(wolf, HIND_NAMES[-1], 0.94, CREAM, PAD, INK)
    add_paw(wolf, FORE_NAMES[-1], 1.0, CREAM, PAD, INK)
    return wolf.finish(
        [f"{HIND_NAMES[0]}:{HIND_NAMES[-1]}", f"{FORE_NAMES[0]}:{FORE_NAMES[-1]}"], names
    )


def _tail(wolf: Sculpture, names: list[str]) -> Piece:
    """Add the brush."""
    brush = limb(
        (RUMP, *TAIL),
        (
            (0.0, 0.024),
            (1.0, 0.030),
            (1.5, 0.032),
            (2.0, 0.038),
            (2.5, 0.044),
            (3.0, 0.049),
            (3.5, 0.052),
            (4.0, 0.052),
            (4.5, 0.049),
            (5.0, 0.042),
            (5.5, 0.030),
            (5.8, 0.017),
            (6.0, 0.0),
        ),
        sides=14,
        side=(-1.0, 0.0, 0.0),
    )
    paint = Paint(
        ((0.0, FUR), (1.0, SADDLE), (2.5, FUR), (4.6, FUR), (5.3, INK), (6.0, INK)),
        TAN,
        belly_edge=-0.5,
    )
    return wolf.add(brush, ("Pelvis", *names, "TailTip"), paint)


def _head(wolf: Sculpture) -> None:
    """Add jaw, nose, eyes, ears and cheeks."""
    jaw = body(
        (
            (0.0, 0.656, 0.484, 0.0),
            (0.0, 0.652, 0.508, 0.044, 0.020, 0.022),
            (0.0, 0.650, 0.560, 0.031, 0.014, 0.020),
            (0.0, 0.648, 0.615, 0.022, 0.010, 0.014),
            (0.0, 0.650, 0.654, 0.0),
        ),
        rings=11,
        sides=10,
    )
    wolf.add(jaw, "Jaw", plain(CREAM))
    nose = ellipsoid((0.0, 0.677, 0.672), (0.0, -0.002, 0.011), 0.015, 0.012, rings=6, sides=10)
    wolf.add(nose, "Head", plain(INK), GLOSS)
    eye = ellipsoid((0.0405, 0.716, 0.545), (0.005, 0.001, 0.010), 0.008, 0.0085, rings=6, sides=8)
    wolf.add(eye, "Head", plain(AMBER), GLOSS, both=True)
    pupil = ellipsoid((0.0455, 0.716, 0.5505), (0.002, 0.0, 0.004), 0.0042, rings=5, sides=8)
    wolf.add(pupil, "Head", plain(INK), GLOSS, both=True)
    ear = body(
        (
            (0.044, 0.725, 0.462, 0.030, 0.020, 0.012),
            (0.052, 0.760, 0.460, 0.027, 0.015, 0.004),
            (0.058, 0.788, 0.461, 0.017, 0.009, 0.002),
            (0.063, 0.814, 0.464, 0.0),
        ),
        rings=8,
        sides=10,
        pointed=True,
    )
    wolf.add(ear, "Head", Paint(((0.0, FUR), (1.0, SADDLE)), CREAM, belly_edge=-0.3), both=True)
