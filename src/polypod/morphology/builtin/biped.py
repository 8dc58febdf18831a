"""An android as tall as a person: light shells over dark joints; hip height 0.9 m."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import (
    GLOSS,
    METAL,
    SHELL,
    BuiltIn,
    Paint,
    Sculpture,
    plain,
)
from polypod.morphology.builtin.shapes import body, ellipsoid, limb

WHITE, GREY, DARK, ORANGE = "#d8d9d4", "#7d848b", "#2b2f35", "#e0761f"
VISOR, GLOW = "#0b0e14", "#57e0ff"

# Joints, m. Knees bend forward, elbows back; the ankle lies behind the middle of its foot.
SPINE = {
    "Pelvis": (0.0, 0.945, -0.005),
    "Spine1": (0.0, 1.030, -0.012),
    "Spine2": (0.0, 1.115, -0.012),
    "Chest": (0.0, 1.210, -0.008),
    "Neck": (0.0, 1.440, -0.012),
    "Head": (0.0, 1.535, 0.004),
}
LEG = {
    "LeftThigh": (0.098, 0.900, -0.010),
    "LeftShin": (0.106, 0.485, 0.126),
    "LeftFoot": (0.104, 0.092, -0.060),
    "LeftToes": (0.110, 0.030, 0.088),
}
ARM = {
    "LeftClavicle": (0.035, 1.392, -0.010),
    "LeftUpperArm": (0.190, 1.388, -0.016),
    "LeftForearm": (0.240, 1.120, -0.052),
    "LeftHand": (0.262, 0.892, 0.046),
}
# Place in joints, half widths across, to the front, to the back.
LEG_PROFILE = (
    (0.0, 0.0),
    (0.04, 0.060, 0.064, 0.066),
    (0.16, 0.075, 0.082, 0.084),
    (0.40, 0.074, 0.082, 0.080),
    (0.72, 0.057, 0.064, 0.060),
    (0.86, 0.052, 0.056, 0.052),
    (0.90, 0.043, 0.046, 0.044),
    (1.10, 0.042, 0.042, 0.046),
    (1.14, 0.048, 0.046, 0.058),
    (1.36, 0.053, 0.046, 0.072),
    (1.62, 0.044, 0.040, 0.056),
    (1.84, 0.035, 0.034, 0.038),
    (1.87, 0.027, 0.028, 0.029),
    (2.00, 0.027, 0.030, 0.030),
)
LEG_PAINT = Paint(
    (
        (0.0, GREY),
        (0.10, WHITE),
        (0.85, WHITE),
        (0.89, DARK),
        (1.11, DARK),
        (1.15, WHITE),
        (1.83, WHITE),
        (1.86, DARK),
    ),
    bands=((0.20, 0.02, ORANGE), (1.24, 0.02, ORANGE)),
)
ARM_PROFILE = (
    (0.0, 0.0),
    (0.06, 0.042),
    (0.20, 0.047, 0.052),
    (0.50, 0.043, 0.050),
    (0.80, 0.038, 0.042),
    (0.86, 0.030, 0.032),
    (1.12, 0.030, 0.032),
    (1.18, 0.037, 0.043),
    (1.42, 0.038, 0.046),
    (1.82, 0.028, 0.033),
    (1.90, 0.021, 0.024),
    (2.00, 0.021, 0.024),
)
ARM_PAINT = Paint(
    (
        (0.0, GREY),
        (0.10, WHITE),
        (0.79, WHITE),
        (0.85, DARK),
        (1.13, DARK),
        (1.19, WHITE),
        (1.81, WHITE),
        (1.88, DARK),
    ),
    bands=((1.70, 0.03, ORANGE),),
)
# Sections of a shoe from heel to tip, the origin below the ankle: height of the axis, z, half
# widths across, up, down.
SHOE = (
    (0.046, -0.064, 0.0),
    (0.048, -0.054, 0.030, 0.034, 0.048),
    (0.056, -0.022, 0.040, 0.050, 0.056),
    (0.052, 0.030, 0.042, 0.052, 0.052),
    (0.040, 0.085, 0.047, 0.038, 0.040),
    (0.032, 0.140, 0.051, 0.026, 0.032),
    (0.027, 0.190, 0.045, 0.020, 0.027),
    (0.022, 0.215, 0.026, 0.014, 0.021),
    (0.022, 0.224, 0.0),
)


def build() -> BuiltIn:
    """Return the biped."""
    android = Sculpture("biped")
    android.chain(tuple(SPINE), np.array(list(SPINE.values())))
    android.chain(tuple(LEG), np.array(list(LEG.values())), "Pelvis")
    android.chain(tuple(ARM), np.array(list(ARM.values())), "Chest")
    _trunk(android)
    _head(android)
    _leg(android)
    _arm(android)
    return android.finish(["LeftThigh:LeftFoot"], tuple(SPINE))


def _trunk(android: Sculpture) -> None:
    """Add pelvis, bellows of the waist, chest, pack and neck; half widths across, back, front."""
    pelvis = body(
        (
            (0.0, 0.838, 0.002, 0.0),
            (0.0, 0.850, 0.000, 0.044, 0.044, 0.044),
            (0.0, 0.900, -0.004, 0.098, 0.088, 0.076),
            (0.0, 0.955, -0.006, 0.146, 0.094, 0.084),
            (0.0, 0.995, -0.008, 0.142, 0.086, 0.082),
            (0.0, 1.008, -0.010, 0.112, 0.070, 0.068),
            (0.0, 1.010, -0.010, 0.0),
        ),
        rings=13,
        sides=16,
        exponent=2.4,
    )
    android.add(
        pelvis, "Pelvis", Paint(((0.0, DARK), (0.35, DARK), (0.45, WHITE), (1.0, WHITE))), SHELL
    )
    ribs = [(0.994 + 0.011 * k, 0.104 if k % 2 else 0.096) for k in range(14)]
    waist = body(
        [(0.0, height, -0.012, width, 0.68 * width, 0.66 * width) for height, width in ribs],
        rings=27,
        sides=12,
    )
    android.add(waist, ("Pelvis", "Spine1", "Spine2", "Chest"), plain(DARK), blend=0.5)
    chest = body(
        (
            (0.0, 1.098, -0.010, 0.0),
            (0.0, 1.102, -0.010, 0.102, 0.070, 0.074),
            (0.0, 1.130, -0.008, 0.128, 0.084, 0.092),
            (0.0, 1.220, -0.004, 0.152, 0.096, 0.108),
            (0.0, 1.320, -0.004, 0.172, 0.104, 0.116),
            (0.0, 1.385, -0.008, 0.160, 0.094, 0.092),
            (0.0, 1.432, -0.012, 0.098, 0.066, 0.060),
            (0.0, 1.452, -0.012, 0.060, 0.052, 0.048),
            (0.0, 1.456, -0.012, 0.0),
        ),
        rings=18,
        sides=20,
        exponent=2.5,
    )
    panel = Paint(((0.0, GREY), (0.12, GREY), (0.16, WHITE), (0.93, WHITE), (0.96, GREY)))
    android.add(chest, "Chest", panel, SHELL)
    lamp = ellipsoid((0.0, 1.330, 0.107), (0.0, 0.004, 0.012), 0.020, rings=6, sides=12)
    android.add(lamp, "Chest", plain(GLOW), GLOSS)
    pack = body(
        (
            (0.0, 1.300, -0.085, 0.112, 0.120),
            (0.0, 1.300, -0.140, 0.104, 0.112),
            (0.0, 1.300, -0.162, 0.080, 0.088),
            (0.0, 1.300, -0.166, 0.0),
        ),
        rings=7,
        sides=12,
        exponent=4.0,
    )
    android.add(pack, "Chest", Paint(((0.0, DARK), (0.6, DARK), (1.0, GREY))), METAL)
    neck = limb(
        [(0.0, 1.425, -0.012), SPINE["Neck"], SPINE["Head"], (0.0, 1.590, 0.010)],
        ((0.0, 0.056), (1.0, 0.046), (2.0, 0.043), (3.0, 0.043)),
        sides=14,
    )
    android.add(neck, ("Chest", "Neck", "Head"), plain(DARK))


def _head(android: Sculpture) -> None:
    """Add a helmet with a visor, two lights for eyes and discs for ears."""
    helmet = body(
        (
            (0.0, 1.532, 0.026, 0.0),
            (0.0, 1.540, 0.028, 0.034, 0.030, 0.048),
            (0.0, 1.580, 0.018, 0.062, 0.068, 0.072),
            (0.0, 1.640, 0.006, 0.080, 0.098, 0.092),
            (0.0, 1.700, -0.004, 0.078, 0.096, 0.090),
            (0.0, 1.745, -0.012, 0.054, 0.068, 0.062),
            (0.0, 1.764, -0.016, 0.0),
        ),
        rings=14,
        sides=20,
    )
    android.add(helmet, "Head", plain(WHITE), SHELL)
    visor = ellipsoid((0.0, 1.648, 0.052), (0.0, 0.006, 0.056), 0.069, 0.036, rings=8, sides=20)
    android.add(visor, "Head", plain(VISOR), GLOSS)
    eye = ellipsoid((0.026, 1.652, 0.100), (0.002, 0.0, 0.007), 0.011, 0.007, rings=5, sides=10)
    android.add(eye, "Head", plain(GLOW), GLOSS, both=True)
    ear = limb(
        [(0.070, 1.640, -0.008), (0.092, 1.640, -0.008)],
        ((0.0, 0.034), (0.7, 0.030), (1.0, 0.0)),
        sides=14,
        side=(0.0, 0.0, 1.0),
    )
    android.add(ear, "Head", Paint(((0.0, GREY), (0.8, ORANGE))), METAL, both=True)


def _leg(android: Sculpture) -> None:
    """Add the leg's tube, the caps of hip and knee, and the shoe."""
    thigh, shin, foot, _ = (np.array(place) for place in LEG.values())
    patch = limb((thigh, shin, foot), LEG_PROFILE, sides=12, corner=0.12, pointed=False)
    android.add(patch, ("Pelvis", *LEG), LEG_PAINT, SHELL, blend=0.12)
    ball = ellipsoid(thigh, (0.072, 0.0, 0.0), 0.064, rings=7, sides=12, side=(0.0, 0.0, 1.0))
    android.add(ball, "LeftThigh", plain(DARK), METAL)
    cap = ellipsoid(
        shin + np.array([0.0, 0.004, 0.040]), (0.0, 0.052, 0.010), 0.034, 0.018, rings=6, sides=10
    )
    android.add(cap, "LeftShin", plain(ORANGE), SHELL)
    x, _, z = foot
    shoe = body(
        [(x + 0.04 * ahead, height, z + ahead, *widths) for height, ahead, *widths in SHOE],
        rings=17,
        sides=14,
        exponent=3.0,
    )
    paint = Paint(
        ((0.0, WHITE), (0.62, WHITE), (0.68, GREY), (1.0, GREY)),
        DARK,
        -0.65,
        ((0.66, 0.012, DARK),),
    )
    android.add(shoe, ("LeftFoot", "LeftToes"), paint, SHELL, blend=0.2)
    ankle = ellipsoid(foot, (0.046, 0.0, 0.0), 0.034, rings=6, sides=10, side=(0.0, 0.0, 1.0))
    android.add(ankle, "LeftFoot", plain(DARK), METAL)


def _arm(android: Sculpture) -> None:
    """Add collar, shoulder, arm and a hand with a thumb and four fingers."""
    clavicle, shoulder, elbow, wrist = (np.array(place) for place in ARM.values())
    collar = limb((clavicle, shoulder), ((0.0, 0.050), (1.0, 0.036)), sides=10, side=(0, 0, 1))
    android.add(collar, ("LeftClavicle",), plain(DARK), METAL)
    arm = limb((shoulder, elbow, wrist), ARM_PROFILE, sides=10, corner=0.12, pointed=False)
    android.add(arm, tuple(ARM)[1:], ARM_PAINT, SHELL, blend=0.12)
    guard = ellipsoid(
        shoulder + np.array([0.012, 0.006, 0.0]),
        (0.032, 0.060, 0.0),
        0.064,
        0.056,
        rings=8,
        sides=12,
    )
    android.add(guard, "LeftUpperArm", Paint(((0.0, GREY), (0.4, WHITE))), SHELL)
    down = (wrist - elbow) / np.linalg.norm(wrist - elbow)
    down = 0.5 * (down + np.array([0.0, -1.0, 0.0]))
    down /= np.linalg.norm(down)
    inward = np.array([-1.0, 0.0, 0.0])
    ahead = np.cross(down, inward)
    palm = body(
        [
            (*(wrist - 0.006 * down), 0.0),
            (*(wrist + 0.004 * down), 0.019, 0.024),
            (*(wrist + 0.045 * down), 0.019, 0.039),
            (*(wrist + 0.082 * down), 0.016, 0.040),
            (*(wrist + 0.094 * down), 0.0),
        ],
        rings=8,
        sides=10,
        exponent=2.6,
    )
    android.add(palm, "LeftHand", plain(GREY), SHELL)
    for aside, length in ((-0.029, 0.80), (-0.010, 0.95), (0.010, 1.0), (0.029, 0.92)):
        knuckle = wrist + 0.082 * down + aside * ahead
        middle = knuckle + length * (0.042 * down + 0.006 * inward)
        tip = middle + length * (0.030 * down + 0.022 * inward)
        finger = limb(
            (knuckle, middle, tip),
            ((0.0, 0.0095), (1.0, 0.009), (1.8, 0.008), (2.0, 0.0)),
            sides=6,
            pointed=False,
        )
        android.add(finger, "LeftHand", Paint(((0.0, DARK), (0.9, DARK), (1.1, GREY))), METAL)
    base = wrist + 0.022 * down + 0.026 * ahead
    thumb = limb(
        (base, base + 0.034 * down + 0.022 * ahead, base + 0.066 * down + 0.020 * ahead),
        ((0.0, 0.012), (1.0, 0.011), (1.8, 0.009), (2.0, 0.0)),
        sides=6,
        pointed=False,
    )
    android.add(thumb, "LeftHand", Paint(((0.0, DARK), (0.9, DARK), (1.1, GREY))), METAL)
