"""The papers' imaginary five-legged robot: a dome with a ring of lamps on five machined legs.

All that a leg is made of repeats every 72 degrees; only the eye on top tells the front.
"""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.curves import FloatArray
from polypod.morphology.builtin.machined import beam, turned
from polypod.morphology.builtin.sculpture import (
    GLOSS,
    METAL,
    SHELL,
    BuiltIn,
    Sculpture,
    plain,
)
from polypod.morphology.builtin.shapes import ellipsoid

WHITE, STEEL, DARK, ORANGE, GLOW = "#dcdcd6", "#8b9299", "#2c3036", "#e0701a", "#5fe3ff"

HIP_HEIGHT, HIP_RADIUS = 0.25, 0.150
ANKLE_HEIGHT = 0.040
COXA, THIGH = 0.050, 0.180  # m
THIGH_RISE, SHIN_FALL = 14.0, 70.0  # degrees against the horizontal
BONES = ("Coxa", "Thigh", "Shin")
# Legs of the middle and the left, degrees from +Z toward +X; those on the right are their images.
LEGS = (("FrontLeg", 0.0), ("LeftMidLeg", 72.0), ("LeftBackLeg", 144.0))
UP = np.array([0.0, 1.0, 0.0])


def build() -> BuiltIn:
    """Return the pentapod."""
    robot = Sculpture("pentapod")
    robot.joint("Body", (0.0, 0.262, 0.0))
    _hull(robot)
    _lamps(robot)
    for leg, degrees in LEGS:
        out = _plan(degrees)
        side = np.array([out[2], 0.0, -out[0]])
        points = _standing(out)
        bones = [leg + bone for bone in BONES]
        robot.chain([*bones, leg + "Foot"], points, "Body")
        _coxa(robot, bones[0], points, side)
        _thigh(robot, bones[1], points, side)
        _shin(robot, bones[2], points, side)
        _foot(robot, leg + "Foot", points[3], side)
    return robot.finish([f"{leg}Coxa:{leg}Foot" for leg, _ in reversed(LEGS)])


def _plan(degrees: float) -> FloatArray:
    """Return the unit direction [3] in plan at an angle from +Z toward +X."""
    angle = np.radians(degrees)
    return np.array([np.round(np.sin(angle), 15) + 0.0, 0.0, np.cos(angle)])


def _standing(out: FloatArray) -> FloatArray:
    """Return hip, thigh pivot, knee and ankle [4, 3] of the leg that reaches out that way."""
    rise, fall = np.radians(THIGH_RISE), np.radians(SHIN_FALL)
    knee_height = HIP_HEIGHT + THIGH * np.sin(rise)
    reach = np.cumsum(
        [
            HIP_RADIUS,
            COXA,
            THIGH * np.cos(rise),
            (knee_height - ANKLE_HEIGHT) / np.tan(fall),
        ]
    )
    heights = np.array([HIP_HEIGHT, HIP_HEIGHT, knee_height, ANKLE_HEIGHT])
    return reach[:, None] * out + heights[:, None] * UP


def _hull(robot: Sculpture) -> None:
    """Add the belly, the skirt, the dome and the eye's turret."""
    base, top = np.array([0.0, 0.200, 0.0]), np.array([0.0, 0.400, 0.0])

    def hull(*runs: tuple[tuple[float, float], ...]) -> list[list[tuple[float, float]]]:
        return [[((height - 0.2) / 0.2, radius) for height, radius in run] for run in runs]

    dome = tuple(
        (0.276 + 0.066 * np.sin(angle), 0.050 + 0.092 * np.cos(angle) ** 0.8)
        for angle in np.radians([0.0, 13.0, 19.0, 32.0, 46.0, 60.0, 75.0, 89.0])
    )
    parts = (
        (((0.214, 0.0), (0.214, 0.052)), DARK),
        (((0.214, 0.052), (0.205, 0.058)), STEEL),
        (((0.205, 0.058), (0.205, 0.078)), STEEL),
        (((0.205, 0.078), (0.214, 0.086)), STEEL),
        (((0.214, 0.086), (0.226, 0.132), (0.238, 0.150)), DARK),
        (((0.238, 0.150), (0.246, 0.163)), WHITE),
        (((0.246, 0.163), (0.254, 0.163)), WHITE),
        (((0.254, 0.163), (0.256, 0.158)), DARK),
        (((0.256, 0.158), (0.268, 0.156)), DARK),
        (((0.268, 0.156), (0.270, 0.160)), WHITE),
        (((0.270, 0.160), (0.277, 0.156)), WHITE),
        (((0.277, 0.156), (0.277, 0.146)), WHITE),
        (((0.277, 0.146), (0.273, 0.142)), DARK),
        (((0.273, 0.142), dome[0]), DARK),
        (dome[:2], WHITE),
        (dome[1:3], ORANGE),
        (dome[2:], WHITE),
        ((dome[-1], (0.3395, 0.049)), DARK),
        (((0.3395, 0.049), (0.3395, 0.040)), DARK),
        (((0.3395, 0.040), (0.358, 0.034)), STEEL),
        (((0.358, 0.034), (0.366, 0.027)), STEEL),
        (((0.366, 0.027), (0.366, 0.0)), DARK),
    )
    for run, colour in parts:
        hard = turned(base, top, hull(run), sides=30)
        robot.add(hard, "Body", plain(colour), METAL if colour == STEEL else SHELL)
    socket = turned(
        (0.0, 0.352, 0.022),
        (0.0, 0.352, 0.046),
        [[(0.0, 0.013), (1.0, 0.012)], [(1.0, 0.012), (1.0, 0.0)]],
        sides=16,
    )
    robot.add(socket, "Body", plain(DARK), METAL)
    eye = ellipsoid((0.0, 0.352, 0.044), (0.0, 0.0, 0.008), 0.0095, rings=6, sides=14)
    robot.add(eye, "Body", plain(GLOW), GLOSS)


def _lamps(robot: Sculpture) -> None:
    """Add the ring of lamps around the skirt, three between each two legs."""
    for degrees in (18.0, 36.0, 54.0, 90.0, 108.0, 126.0, 162.0, 180.0):
        out = _plan(degrees)
        side = np.array([out[2], 0.0, -out[0]])
        glass = ellipsoid(0.1555 * out + 0.262 * UP, 0.0055 * out, 0.0125, 0.0045, 3, 8, side)
        robot.add(glass, "Body", plain(GLOW), GLOSS, both=degrees < 180.0)


def _pivot(
    robot: Sculpture, bone: str, centre: FloatArray, side: FloatArray, radius: float, half: float
) -> None:
    """Add a joint's motor: a drum across the leg with bevelled ends and coloured caps."""
    start, end = centre - half * side, centre + half * side
    face = 0.74 * radius
    drum = [
        [(0.0, face), (0.10, radius)],
        [(0.10, radius), (0.90, radius)],
        [(0.90, radius), (1.0, face)],
    ]
    robot.add(turned(start, end, drum, 14, UP), bone, plain(DARK), METAL)
    caps = [[(0.0, 0.0), (0.0, face)], [(1.0, face), (1.0, 0.0)]]
    robot.add(turned(start, end, caps, 14, UP), bone, plain(ORANGE), SHELL)


def _coxa(robot: Sculpture, bone: str, points: FloatArray, side: FloatArray) -> None:
    """Add the upright drum that turns the leg, and the fork that holds the thigh."""
    hip, thigh = points[0], points[1]
    drum = [
        [(0.0, 0.0), (0.0, 0.020)],
        [(0.0, 0.020), (0.10, 0.026)],
        [(0.10, 0.026), (0.86, 0.026)],
        [(0.86, 0.026), (1.0, 0.020)],
        [(1.0, 0.020), (1.0, 0.0)],
    ]
    drum_patch = turned(hip - 0.036 * UP, hip + 0.028 * UP, drum, 12, side)
    robot.add(drum_patch, bone, plain(STEEL), METAL)
    for across in (-1.0, 1.0):
        arm = np.stack([hip, thigh]) + across * 0.030 * side
        robot.add(
            beam(arm, ((0.0, 0.006, 0.019), (1.24, 0.006, 0.013)), side),
            bone,
            plain(WHITE),
            SHELL,
        )


def _thigh(robot: Sculpture, bone: str, points: FloatArray, side: FloatArray) -> None:
    """Add the thigh: its motor, a box girder, a shell on top and a ram below."""
    thigh, knee = points[1], points[2]
    line = np.stack([thigh, knee])
    up = np.cross(knee - thigh, side) / THIGH
    _pivot(robot, bone, thigh, side, 0.022, 0.026)
    girder = beam(line, ((0.06, 0.015, 0.012), (0.5, 0.013, 0.012), (0.94, 0.013, 0.010)), side)
    robot.add(girder, bone, plain(STEEL), METAL)
    shell = beam(
        line + 0.012 * up,
        (
            (0.12, 0.014, 0.006),
            (0.17, 0.021, 0.012),
            (0.55, 0.020, 0.015),
            (0.80, 0.017, 0.010),
            (0.84, 0.012, 0.006),
        ),
        side,
        0.4,
    )
    robot.add(shell, bone, plain(WHITE), SHELL)
    band = beam(line + 0.012 * up, ((0.60, 0.0205, 0.0150), (0.65, 0.0200, 0.0145)), side, 0.4)
    robot.add(band, bone, plain(ORANGE), SHELL)
    ram = [
        [(0.05, 0.0085), (0.55, 0.0085)],
        [(0.55, 0.0085), (0.58, 0.0050)],
        [(0.58, 0.0050), (1.0, 0.0050)],
    ]
    low = line - np.array([[0.010], [0.008]]) * up
    robot.add(turned(low[0] - 0.008 * up, low[1], ram, 10, side), bone, plain(DARK), METAL)


def _shin(robot: Sculpture, bone: str, points: FloatArray, side: FloatArray) -> None:
    """Add the shin: the knee's motor, a girder, a guard in front and the piston of the ankle."""
    knee, ankle = points[2], points[3]
    line = np.stack([knee, ankle])
    front = np.cross(ankle - knee, side)
    front /= np.linalg.norm(front)
    _pivot(robot, bone, knee, side, 0.024, 0.030)
    girder = beam(line, ((0.04, 0.013, 0.014), (0.40, 0.014, 0.015), (0.66, 0.012, 0.012)), side)
    robot.add(girder, bone, plain(DARK), METAL)
    guard = beam(
        line + 0.013 * front,
        (
            (0.09, 0.010, 0.006),
            (0.14, 0.021, 0.010),
            (0.38, 0.022, 0.014),
            (0.62, 0.015, 0.009),
            (0.70, 0.009, 0.004),
        ),
        side,
        0.4,
    )
    robot.add(guard, bone, plain(WHITE), SHELL)
    band = beam(line + 0.013 * front, ((0.43, 0.0215, 0.0138), (0.47, 0.0205, 0.0130)), side, 0.4)
    robot.add(band, bone, plain(ORANGE), SHELL)
    piston = [
        [(0.60, 0.0125), (0.72, 0.0125)],
        [(0.72, 0.0125), (0.74, 0.0080)],
        [(0.74, 0.0080), (1.0, 0.0080)],
    ]
    robot.add(turned(knee, ankle, piston, 10, side), bone, plain(STEEL), METAL)


def _foot(robot: Sculpture, bone: str, ankle: FloatArray, side: FloatArray) -> None:
    """Add the ball of the ankle and the round pad."""
    floor = ankle * (1.0, 0.0, 1.0)
    ball = ellipsoid(ankle, 0.016 * UP, 0.016, rings=5, sides=10, side=side)
    robot.add(ball, bone, plain(STEEL), METAL)
    rubber = [
        [(0.0, 0.0), (0.0, 0.036)],
        [(0.0, 0.036), (0.10, 0.040)],
        [(0.10, 0.040), (0.36, 0.040)],
        [(0.36, 0.040), (0.46, 0.035)],
    ]
    robot.add(turned(floor, ankle, rubber, 16, side), bone, plain(DARK), SHELL)
    cup = [
        [(0.46, 0.035), (0.56, 0.030)],
        [(0.56, 0.030), (0.70, 0.020), (1.05, 0.0165)],
        [(1.05, 0.0165), (1.05, 0.010)],
    ]
    robot.add(turned(floor, ankle, cup, 16, side), bone, plain(WHITE), SHELL)
