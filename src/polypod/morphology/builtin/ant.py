"""A wood ant the size of a large dog: big head, waist, plated gaster; hip height 0.25 m."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.sculpture import GLOSS, SHELL, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb, plated
from polypod.morphology.builtin.stance import outward_side, spread_leg

RUST, MAHOGANY, PITCH, AMBER, INK = "#8a3a1c", "#5a2413", "#22140f", "#b0683a", "#0b0909"

# Leg, front to back: hip x, z; foot's heading from +Z toward +X in degrees and distance from the
# hip in plan; length relative to the segments below. All metres.
LEGS = (
    (0.034, 0.082, 47.0, 0.300, 1.02),
    (0.036, 0.004, 90.0, 0.306, 1.00),
    (0.034, -0.080, 136.0, 0.324, 1.10),
)
HIP_HEIGHT = 0.25
SOCKET = np.array([-0.010, 0.008, 0.0])  # of the coxa, from the hip, m
SEGMENTS = (0.045, 0.170, 0.165, 0.130)  # coxa with trochanter, femur, tibia, tarsus
BENDS = (-55.0, 100.0, -10.0)
SEGMENT_NAMES = ("Coxa", "Femur", "Tibia", "Tarsus")
# Place in joints, radius. The coxa is stout, the trochanter a waist, the femur a slender spindle.
LEG_PROFILE = (
    (0.0, 0.017),
    (0.5, 0.019),
    (0.9, 0.0105),
    (1.08, 0.0095),
    (1.4, 0.0155),
    (1.75, 0.0120),
    (1.97, 0.0085),
    (2.08, 0.0095),
    (2.5, 0.0098),
    (2.9, 0.0085),
    (3.05, 0.0055),
    (3.5, 0.0050),
    (3.85, 0.0046),
    (4.0, 0.0),
)
LEG_PAINT = Paint(
    ((0.0, MAHOGANY), (1.0, RUST), (1.5, MAHOGANY), (2.0, RUST), (3.0, MAHOGANY), (4.0, PITCH)),
    belly=PITCH,
    belly_edge=-0.6,
    bands=((1.0, 0.05, AMBER), (2.0, 0.04, AMBER), (3.02, 0.04, AMBER)),
)


def build() -> BuiltIn:
    """Return the ant."""
    ant = Sculpture("ant")
    ant.joint("Body", (0.0, 0.275, 0.0))
    ant.joint("Head", (0.0, 0.296, 0.128), "Body")
    ant.joint("Petiole", (0.0, 0.262, -0.118), "Body")
    ant.joint("Gaster", (0.0, 0.268, -0.192), "Petiole")
    _thorax(ant)
    _waist_and_gaster(ant)
    _head(ant)
    _jaws(ant)
    _antennae(ant)
    for number, leg in enumerate(LEGS, start=1):
        points = spread_leg(leg, HIP_HEIGHT, SEGMENTS, BENDS)
        names = [f"LeftLeg{number}{segment}" for segment in SEGMENT_NAMES]
        ant.chain(names, points, "Body", marker=f"LeftLeg{number}Foot")
        socket = ellipsoid(points[0] + SOCKET, (0.0, 0.0, 0.024), 0.024, 0.020, 7, 10)
        ant.add(socket, "Body", plain(MAHOGANY), SHELL, both=True)
        patch = limb(points, LEG_PROFILE, sides=8, side=outward_side(points), corner=0.12)
        ant.add(patch, (*names, f"LeftLeg{number}Foot"), LEG_PAINT, SHELL, blend=0.12)
    return ant.finish([f"LeftLeg{k}Coxa:LeftLeg{k}Foot" for k in (3, 2, 1)])


def _thorax(ant: Sculpture) -> None:
    """Add the three parts of the thorax, back to front, and the neck."""
    propodeum = (
        (0.0, 0.256, -0.136, 0.0),
        (0.0, 0.266, -0.112, 0.030, 0.028, 0.022),
        (0.0, 0.274, -0.072, 0.037, 0.036, 0.034),
        (0.0, 0.272, -0.030, 0.030, 0.028, 0.032),
        (0.0, 0.272, -0.008, 0.0),
    )
    mesothorax = (
        (0.0, 0.270, -0.044, 0.0),
        (0.0, 0.272, -0.022, 0.030, 0.026, 0.032),
        (0.0, 0.280, 0.014, 0.039, 0.036, 0.042),
        (0.0, 0.284, 0.050, 0.036, 0.036, 0.040),
        (0.0, 0.284, 0.074, 0.0),
    )
    pronotum = (
        (0.0, 0.284, 0.016, 0.0),
        (0.0, 0.286, 0.040, 0.042, 0.039, 0.040),
        (0.0, 0.286, 0.074, 0.044, 0.038, 0.040),
        (0.0, 0.288, 0.106, 0.030, 0.025, 0.026),
        (0.0, 0.294, 0.128, 0.016, 0.014, 0.014),
        (0.0, 0.298, 0.142, 0.012),
    )
    shell = Paint(((0.0, RUST), (0.6, RUST), (1.0, MAHOGANY)), PITCH, belly_edge=-0.55)
    for keys in (propodeum, mesothorax):
        ant.add(body(keys, rings=10, sides=14), "Body", shell, SHELL)
    ant.add(body(pronotum, rings=12, sides=14), ("Body", "Head"), shell, SHELL, blend=0.12)


def _waist_and_gaster(ant: Sculpture) -> None:
    """Add the petiole with its upright scale, and the gaster of overlapping plates."""
    stalk = (
        (0.0, 0.266, -0.214, 0.014),
        (0.0, 0.258, -0.176, 0.0125),
        (0.0, 0.256, -0.140, 0.0125),
        (0.0, 0.262, -0.112, 0.016),
    )
    ant.add(body(stalk, rings=7, sides=10), ("Petiole", "Gaster"), plain(RUST), SHELL)
    scale = (
        (0.0, 0.252, -0.158, 0.015, 0.013),
        (0.0, 0.276, -0.160, 0.026, 0.012),
        (0.0, 0.302, -0.164, 0.022, 0.0065),
        (0.0, 0.315, -0.166, 0.0),
    )
    ant.add(body(scale, rings=8, sides=12), "Petiole", plain(RUST), SHELL)
    gaster = (
        (0.0, 0.232, -0.446, 0.0),
        (0.0, 0.240, -0.424, 0.024, 0.022, 0.020),
        (0.0, 0.262, -0.372, 0.064, 0.060, 0.054),
        (0.0, 0.274, -0.305, 0.088, 0.080, 0.072),
        (0.0, 0.274, -0.245, 0.074, 0.064, 0.064),
        (0.0, 0.268, -0.200, 0.030, 0.028, 0.030),
        (0.0, 0.266, -0.188, 0.0),
    )
    edges = (0.10, 0.24, 0.42, 0.66)
    paint = Paint(
        ((0.0, PITCH), (0.85, PITCH), (1.0, MAHOGANY)),
        MAHOGANY,
        -0.75,
        tuple((edge + 0.012, 0.012, AMBER) for edge in edges),
    )
    ant.add(plated(gaster, edges, rings=4, sides=18, lip=0.05), "Gaster", paint, SHELL)


def _head(ant: Sculpture) -> None:
    """Add the head, its compound eyes and its three simple eyes."""
    head = (
        (0.0, 0.297, 0.136, 0.0),
        (0.0, 0.298, 0.154, 0.056, 0.034, 0.034),
        (0.0, 0.294, 0.190, 0.071, 0.042, 0.042),
        (0.0, 0.284, 0.228, 0.062, 0.038, 0.038),
        (0.0, 0.272, 0.260, 0.047, 0.026, 0.026),
        (0.0, 0.264, 0.276, 0.0),
    )
    paint = Paint(((0.0, MAHOGANY), (0.5, RUST), (1.0, MAHOGANY)), PITCH, belly_edge=-0.6)
    ant.add(body(head, rings=13, sides=18, exponent=2.3), "Head", paint, SHELL)
    eye = ellipsoid((0.062, 0.308, 0.196), (0.004, -0.004, 0.017), 0.010, 0.012, rings=6, sides=10)
    ant.add(eye, "Head", plain(INK), GLOSS, both=True)
    for x, y, z in ((0.013, 0.334, 0.172), (0.0, 0.335, 0.184)):
        ocellus = ellipsoid((x, y, z), (0.0, 0.0, 0.0045), 0.0045, rings=4, sides=6)
        ant.add(ocellus, "Head", plain(INK), GLOSS, both=x > 0.0)


def _jaws(ant: Sculpture) -> None:
    """Add the toothed mandibles, each on a joint."""
    ant.joint("LeftMandible", (0.034, 0.262, 0.252), "Head")
    blade = limb(
        [(0.034, 0.262, 0.248), (0.052, 0.254, 0.296), (0.012, 0.246, 0.334)],
        (
            (0.0, 0.014, 0.011),
            (0.5, 0.017, 0.010),
            (1.0, 0.020, 0.009),
            (1.5, 0.016, 0.007),
            (2.0, 0.0),
        ),
        sides=10,
    )
    ant.add(blade, "LeftMandible", Paint(((0.0, MAHOGANY), (1.2, PITCH), (2.0, INK))), SHELL)
    for x, y, z in ((0.034, 0.251, 0.300), (0.026, 0.249, 0.311), (0.017, 0.247, 0.322)):
        tooth = limb(
            [(x + 0.006, y, z), (x - 0.013, y - 0.002, z - 0.003)],
            ((0.0, 0.0045), (1.0, 0.0)),
            sides=5,
            side=(0.0, 0.0, 1.0),
        )
        ant.add(tooth, "LeftMandible", plain(INK), SHELL)


def _antennae(ant: Sculpture) -> None:
    """Add the elbowed antennae: a long scape and a beaded whip, three joints each."""
    points = [
        (0.024, 0.306, 0.244),
        (0.098, 0.372, 0.292),
        (0.120, 0.352, 0.372),
        (0.122, 0.292, 0.438),
    ]
    names = ("LeftAntennaScape", "LeftAntennaFunicle", "LeftAntennaClub")
    ant.chain(names, points, "Head", marker="LeftAntennaTip")
    beads = [
        (place + offset, radius)
        for place in np.arange(1.15, 2.8, 0.25)
        for offset, radius in ((0.0, 0.0052), (0.125, 0.0074))
    ]
    antenna = limb(
        points,
        ((0.0, 0.008), (0.08, 0.005), (0.85, 0.0075), (1.0, 0.0062), *beads, (3.0, 0.0)),
        sides=6,
        corner=0.1,
    )
    paint = Paint(((0.0, MAHOGANY), (1.0, RUST), (2.0, MAHOGANY), (3.0, PITCH)))
    ant.add(antenna, (*names, "LeftAntennaTip"), paint, SHELL, blend=0.1)
