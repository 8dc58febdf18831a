"""The papers' imaginary five-legged robot: a domed hull on a ring of legs, one of them ahead."""

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
from polypod.morphology.builtin.shapes import FloatArray, body, ellipsoid, limb
from polypod.morphology.builtin.stance import folded_leg, outward_side

WHITE, STEEL, DARK, ORANGE, GLOW = "#d8d9d4", "#7d848b", "#2b2f35", "#e0761f", "#57e0ff"

HIP_HEIGHT, HIP_RADIUS = 0.25, 0.130
ANKLE_HEIGHT, FOOT_RADIUS = 0.040, 0.415
SEGMENTS = (0.085, 0.205, 0.180)
BENDS = (-50.0, 104.0)
NAMES = ("Hip", "Thigh", "Shin")
# Legs of the middle and the left, degrees from +Z toward +X; the right ones are their mirror images.
LEGS = (("FrontLeg", 0.0), ("LeftMidLeg", 72.0), ("LeftBackLeg", 144.0))
LEG_PROFILE = (
    (0.0, 0.026),
    (0.75, 0.024),
    (1.0, 0.030),
    (1.12, 0.030),
    (1.2, 0.019, 0.024),
    (1.75, 0.016, 0.020),
    (1.88, 0.026),
    (2.1, 0.026),
    (2.2, 0.017, 0.020),
    (2.75, 0.011, 0.013),
    (2.9, 0.016),
    (3.0, 0.014),
)
LEG_PAINT = Paint(
    ((0.0, STEEL), (0.95, DARK), (1.15, DARK), (1.25, WHITE), (1.75, WHITE), (1.85, DARK),
     (2.12, DARK), (2.22, WHITE), (2.7, STEEL), (3.0, DARK)),
    bands=((1.5, 0.03, ORANGE), (2.45, 0.03, ORANGE)),
)  # fmt: skip


def build() -> BuiltIn:
    """Return the pentapod."""
    robot = Sculpture("pentapod")
    robot.joint("Body", (0.0, 0.262, 0.0))
    _hull(robot)
    for leg, degrees in LEGS:
        way = _plan(np.radians(degrees))
        hip = HIP_RADIUS * way + (0.0, HIP_HEIGHT, 0.0)
        ankle = FOOT_RADIUS * way + (0.0, ANKLE_HEIGHT, 0.0)
        points = folded_leg(hip, ankle, SEGMENTS, BENDS)
        names = [leg + name for name in NAMES]
        robot.chain([*names, leg + "Foot"], points, "Body")
        side = outward_side(points)
        patch = limb(points, LEG_PROFILE, sides=10, side=side, corner=0.04, pointed=False)
        robot.add(patch, (*names, leg + "Foot"), LEG_PAINT, METAL, blend=0.05)
        _plates(robot, names, points, side)
        _pad(robot, leg + "Foot", ankle)
    return robot.finish([f"{leg}Hip:{leg}Foot" for leg, _ in reversed(LEGS)])


def _plan(angle: float) -> FloatArray:
    """Return the unit direction [3] in plan at an angle from +Z toward +X."""
    return np.array([np.sin(angle), 0.0, np.cos(angle)])


def _hull(robot: Sculpture) -> None:
    """Add the dome, its belly, a ring of lamps and the sensor on top."""
    up = (1.0, 0.0, 0.0)
    dome = body(
        (
            (0.0, 0.205, 0.0, 0.0),
            (0.0, 0.208, 0.0, 0.080),
            (0.0, 0.232, 0.0, 0.146),
            (0.0, 0.252, 0.0, 0.160),
            (0.0, 0.272, 0.0, 0.156),
            (0.0, 0.276, 0.0, 0.140),
            (0.0, 0.310, 0.0, 0.116),
            (0.0, 0.336, 0.0, 0.060),
            (0.0, 0.344, 0.0, 0.0),
        ),
        rings=30,
        sides=40,
        side=up,
    )
    paint = Paint(
        ((0.0, DARK), (0.42, STEEL), (0.55, STEEL), (0.6, DARK), (0.66, WHITE), (1.0, WHITE)),
        bands=((0.80, 0.012, ORANGE),),
    )
    robot.add(dome, "Body", paint, SHELL)
    for k in range(10):
        way = _plan(np.radians(36.0 * k + 18.0))
        if way[0] < 0.0:
            continue
        lamp = ellipsoid(0.155 * way + (0.0, 0.262, 0.0), 0.006 * way, 0.011, rings=5, sides=8)
        robot.add(lamp, "Body", plain(GLOW), GLOSS, both=way[0] > 1e-9)
    mast = limb(
        [(0.0, 0.335, 0.0), (0.0, 0.362, 0.0)], ((0.0, 0.030), (0.8, 0.026), (1.0, 0.0)), sides=16
    )
    robot.add(mast, "Body", plain(DARK), METAL)
    eye = ellipsoid((0.0, 0.352, 0.020), (0.0, 0.0, 0.014), 0.014, rings=7, sides=12)
    robot.add(eye, "Body", plain(GLOW), GLOSS)


def _plates(robot: Sculpture, names: list[str], points: FloatArray, side: FloatArray) -> None:
    """Add a guard on the thigh, one on the shin and a ram beside the knee."""
    thigh, knee, ankle = points[1], points[2], points[3]
    for bone, start, end, width in ((names[1], thigh, knee, 0.021), (names[2], knee, ankle, 0.018)):
        along = end - start
        up = np.cross(along / np.linalg.norm(along), side)
        up *= (
            np.sign(up[1])
            if abs(up[1]) > 0.2
            else np.sign(up @ np.array([*start[:1], 0, start[2]]))
        )
        offset = 0.016 * up
        guard = limb(
            [start + 0.24 * along + offset, start + 0.5 * along + 1.4 * offset,
             start + 0.76 * along + offset],
            ((0.0, 0.0), (0.15, width, 0.007), (1.0, 1.1 * width, 0.009), (1.85, width, 0.007),
             (2.0, 0.0)),
            sides=8, side=side, pointed=False,
        )  # fmt: skip
        robot.add(guard, bone, Paint(((0.0, WHITE), (1.0, WHITE)), ORANGE, -0.9), SHELL)
    axle = limb(
        [knee - 0.034 * side, knee + 0.034 * side],
        ((0.0, 0.016), (1.0, 0.016)),
        sides=12,
        side=(0.0, 1.0, 0.0),
        pointed=False,
    )
    robot.add(axle, names[2], plain(ORANGE), METAL)


def _pad(robot: Sculpture, bone: str, ankle: FloatArray) -> None:
    """Add the round foot."""
    floor = ankle * (1.0, 0.0, 1.0)
    pad = body(
        (
            (*(floor + (0.0, 0.0, 0.0)), 0.0),
            (*(floor + (0.0, 0.0008, 0.0)), 0.030),
            (*(floor + (0.0, 0.010, 0.0)), 0.036),
            (*(floor + (0.0, 0.018, 0.0)), 0.030),
            (*(floor + (0.0, 0.034, 0.0)), 0.018),
            (*(floor + (0.0, 0.046, 0.0)), 0.0),
        ),
        rings=14,
        sides=16,
        side=(1.0, 0.0, 0.0),
    )
    robot.add(pad, bone, Paint(((0.0, DARK), (0.5, DARK), (0.7, STEEL), (1.0, STEEL))), METAL)
