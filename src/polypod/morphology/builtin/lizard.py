"""A big sprawling lizard: flat head, splayed toes, a tail as long as the rest of it."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import GLOSS, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb
from polypod.morphology.builtin.stance import folded_leg, outward_side

OLIVE, MOSS, SAND, CREAM, BROWN, INK, AMBER = (
    "#5f6b3a", "#37421f", "#a39a5d", "#d8cf9f", "#4a3a22", "#0f0e0b", "#c8892a",
)  # fmt: skip

SPINE = {
    "Pelvis": (0.0, 0.122, -0.190),
    "Spine1": (0.0, 0.124, -0.115),
    "Spine2": (0.0, 0.125, -0.040),
    "Spine3": (0.0, 0.125, 0.035),
    "Spine4": (0.0, 0.124, 0.105),
    "Chest": (0.0, 0.123, 0.170),
    "Neck": (0.0, 0.126, 0.245),
    "Head": (0.0, 0.132, 0.300),
}
TAIL = tuple((0.0, y, z) for y, z in (
    (0.118, -0.270), (0.104, -0.355), (0.088, -0.445), (0.072, -0.535), (0.056, -0.625),
    (0.042, -0.715), (0.030, -0.805), (0.022, -0.890),
))  # fmt: skip
HIP_HEIGHT, ANKLE_HEIGHT = 0.12, 0.022
# Hip x, z; the ankle's heading from +Z toward +X in degrees, and its distance from the hip in plan.
LEGS = (
    ("LeftHind", 0.038, -0.190, 100.0, 0.096, (0.082, 0.076)),
    ("LeftFore", 0.044, 0.165, 76.0, 0.090, (0.078, 0.074)),
)
BEND = (84.0,)
SEAM = 0.018  # how far around the roots of limbs the skin flows over, m

TRUNK_SECTIONS = (
    (0.0, 0.119, -0.285, 0.0),
    (0.0, 0.119, -0.262, 0.024, 0.020, 0.024),
    (0.0, 0.121, -0.225, 0.040, 0.028, 0.033),
    (0.0, 0.122, -0.180, 0.047, 0.031, 0.037),
    (0.0, 0.124, -0.110, 0.056, 0.034, 0.046),
    (0.0, 0.124, -0.010, 0.067, 0.036, 0.054),
    (0.0, 0.124, 0.085, 0.062, 0.035, 0.049),
    (0.0, 0.124, 0.160, 0.051, 0.032, 0.039),
    (0.0, 0.126, 0.215, 0.037, 0.027, 0.031),
    (0.0, 0.129, 0.255, 0.036, 0.025, 0.028),
    (0.0, 0.132, 0.290, 0.045, 0.024, 0.025),
    (0.0, 0.134, 0.325, 0.044, 0.024, 0.019),
    (0.0, 0.131, 0.360, 0.034, 0.020, 0.015),
    (0.0, 0.126, 0.392, 0.024, 0.014, 0.012),
    (0.0, 0.122, 0.416, 0.016, 0.010, 0.010),
    (0.0, 0.120, 0.426, 0.0),
)
STRIPES = tuple((place, 0.018, MOSS) for place in np.linspace(0.06, 0.74, 9).tolist())
HIDE_PAINT = Paint(((0.0, OLIVE), (0.7, OLIVE), (0.85, SAND), (1.0, OLIVE)), CREAM, -0.25, STRIPES)
LEG_PROFILE = (
    (0.0, 0.0),
    (0.06, 0.016),
    (0.15, 0.0225),
    (0.35, 0.0255),
    (0.5, 0.0252),
    (0.62, 0.0242),
    (0.85, 0.020),
    (1.0, 0.0185),
    (1.2, 0.0190),
    (1.4, 0.0175),
    (1.6, 0.0150),
    (1.85, 0.0125),
    (2.0, 0.0135),
)
LEG_PAINT = Paint(((0.0, OLIVE), (2.0, SAND)), CREAM, -0.6, ((0.5, 0.1, MOSS), (1.4, 0.1, MOSS)))


def build() -> BuiltIn:
    """Return the lizard."""
    lizard = Sculpture("lizard")
    names = tuple(SPINE)
    lizard.chain(names, np.array(list(SPINE.values())))
    tail = [f"Tail{k}" for k in range(1, len(TAIL))]
    lizard.chain(tail, TAIL, "Pelvis", marker="TailTip")
    hide = lizard.add(body(TRUNK_SECTIONS, rings=54, sides=18), names, HIDE_PAINT, blend=0.45)
    whip = limb(
        ((0.0, 0.121, -0.200), *TAIL),
        (
            (0.0, 0.026, 0.022, 0.024),
            (0.5, 0.034, 0.026, 0.030),
            (1.0, 0.032, 0.027, 0.030),
            (1.5, 0.029, 0.026, 0.028),
            (2.0, 0.026, 0.024, 0.025),
            (2.5, 0.0225),
            (3.0, 0.020),
            (3.5, 0.0175),
            (4.0, 0.0155),
            (4.5, 0.0135),
            (5.0, 0.0115),
            (6.0, 0.0085),
            (7.0, 0.0050),
            (8.0, 0.0),
        ),
        sides=14,
        side=(-1.0, 0.0, 0.0),
    )
    rings = tuple((place, 0.16, MOSS) for place in np.arange(1.2, 7.6, 0.7).tolist())
    paint = Paint(((0.0, OLIVE), (5.0, BROWN), (8.0, MOSS)), CREAM, -0.6, rings)
    limbs = [lizard.add(whip, ("Pelvis", *tail, "TailTip"), paint, blend=0.4)]
    _head(lizard)
    legs = []
    for leg, x, z, heading, distance, lengths in LEGS:
        hip = np.array([x, HIP_HEIGHT, z])
        way = np.array([np.sin(np.radians(heading)), 0.0, np.cos(np.radians(heading))])
        ankle = hip * (1.0, 0.0, 1.0) + distance * way + (0.0, ANKLE_HEIGHT, 0.0)
        points = folded_leg(hip, ankle, lengths, BEND)
        bones = [leg + "UpperLeg", leg + "LowerLeg"]
        lizard.chain([*bones, leg + "Foot"], points, "Pelvis" if leg == "LeftHind" else "Chest")
        patch = limb(points, LEG_PROFILE, sides=10, side=outward_side(points), pointed=False)
        limbs.append(lizard.add(patch, (*bones, leg + "Foot"), LEG_PAINT))
        _foot(lizard, leg + "Foot", 64.0 if leg == "LeftHind" else 40.0)
        legs.append(f"{bones[0]}:{leg}Foot")
    lizard.fuse(hide, limbs, SEAM)
    return lizard.finish(legs, names)


def _foot(lizard: Sculpture, bone: str, heading: float) -> None:
    """Add the sole and five splayed toes with claws."""
    ankle = lizard.position(bone)
    palm = ellipsoid(
        (ankle[0] + 0.003, 0.0115, ankle[2] + 0.003),
        (0.014, -0.001, 0.014),
        0.0175,
        0.0155,
        sides=12,
    )
    lizard.add(palm, bone, Paint(((0.0, SAND),), CREAM, -0.6))
    for k, length in enumerate((0.026, 0.036, 0.044, 0.042, 0.028)):
        angle = np.radians(heading + 30.0 * (k - 2.0))
        way = np.array([np.sin(angle), 0.0, np.cos(angle)])
        root = np.array([ankle[0] + 0.004, 0.009, ankle[2] + 0.004]) + 0.010 * way
        toe = limb(
            [root, root + 0.55 * length * way, root + length * way - (0.0, 0.005, 0.0)],
            ((0.0, 0.0062), (1.0, 0.0054), (1.7, 0.0036), (2.0, 0.0)),
            sides=6,
            pointed=False,
        )
        lizard.add(toe, bone, Paint(((0.0, SAND), (2.0, SAND)), CREAM, -0.6))
        tip = root + length * way - (0.0, 0.004, 0.0)
        claw = limb(
            [tip - 0.003 * way, tip + 0.006 * way, tip + 0.011 * way - (0.0, 0.004, 0.0)],
            ((0.0, 0.0028), (1.0, 0.0022), (2.0, 0.0)),
            sides=5,
        )
        lizard.add(claw, bone, plain(INK), GLOSS)


def _head(lizard: Sculpture) -> None:
    """Add jaw, eyes, nostrils and a crest along the back."""
    jaw = body(
        (
            (0.0, 0.119, 0.276, 0.0),
            (0.0, 0.114, 0.308, 0.0395, 0.012, 0.011),
            (0.0, 0.112, 0.350, 0.033, 0.009, 0.010),
            (0.0, 0.113, 0.400, 0.018, 0.006, 0.008),
            (0.0, 0.115, 0.414, 0.0),
        ),
        rings=12,
        sides=12,
    )
    lizard.add(jaw, "Head", Paint(((0.0, CREAM),)))
    eye = ellipsoid((0.0355, 0.1455, 0.338), (0.001, 0.0, 0.008), 0.0065, rings=7, sides=10)
    lizard.add(eye, "Head", plain(AMBER), GLOSS, both=True)
    pupil = ellipsoid((0.0395, 0.1462, 0.3385), (0.0, 0.0, 0.0018), 0.0031, 0.0042, 5, 8)
    lizard.add(pupil, "Head", plain(INK), GLOSS, both=True)
    lid = ellipsoid((0.0340, 0.1490, 0.337), (0.001, 0.0, 0.0105), 0.0070, 0.0050, 7, 10)
    lizard.add(lid, "Head", plain(OLIVE), both=True)
    drum = ellipsoid((0.0435, 0.131, 0.300), (0.0, 0.0, 0.006), 0.0018, 0.006, rings=6, sides=8)
    lizard.add(drum, "Head", plain(BROWN), both=True)
    nostril = ellipsoid((0.010, 0.130, 0.408), (0.0, 0.0, 0.002), 0.0022, rings=5, sides=6)
    lizard.add(nostril, "Head", plain(INK), both=True)
    names = tuple(SPINE)
    for k in range(13):
        z = -0.19 + 0.033 * k
        tall = 0.6 + 0.4 * np.sin(np.pi * (k + 1.0) / 14.0)
        bone = max(
            (name for name in names if SPINE[name][2] <= z + 1e-9), key=lambda n: SPINE[n][2]
        )
        spike = limb(
            [
                (0.0, 0.148, z),
                (0.0, 0.152 + 0.016 * tall, z - 0.007),
                (0.0, 0.152 + 0.026 * tall, z - 0.017),
            ],
            ((0.0, 0.006, 0.010), (1.0, 0.003, 0.006), (2.0, 0.0)),
            sides=6,
        )
        lizard.add(spike, bone, Paint(((0.0, MOSS), (2.0, BROWN))))
