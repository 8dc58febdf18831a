"""A hunting spider the size of a large dog: eight arched legs, hip height 0.25 m."""

from __future__ import annotations

from polypod.morphology.builtin.sculpture import GLOSS, SHELL, BuiltIn, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb
from polypod.morphology.builtin.stance import outward_side, spread_leg

BARK, UMBER, SAND, INK, RUST = "#4f3a28", "#2e2118", "#a5845a", "#0c0a0a", "#6e4326"

# Leg, front to back: hip x, z; foot's heading from +Z toward +X in degrees and distance from the
# hip in plan; length relative to the segments below. All metres.
LEGS = (
    (0.040, 0.056, 30.0, 0.315, 1.04),
    (0.052, 0.020, 66.0, 0.300, 1.00),
    (0.052, -0.018, 104.0, 0.270, 0.92),
    (0.042, -0.052, 146.0, 0.325, 1.06),
)
HIP_HEIGHT = 0.25
SEGMENTS = (0.050, 0.165, 0.165, 0.150)  # coxa with trochanter, femur, patella with tibia, tarsus
BENDS = (-42.0, 92.0, 30.0)
SEGMENT_NAMES = ("Coxa", "Femur", "Tibia", "Tarsus")
# Place in joints, radius. The femur swells, the patella is a knob behind the knee.
LEG_PROFILE = (
    (0.0, 0.017),
    (0.7, 0.016),
    (1.0, 0.0125),
    (1.3, 0.0185),
    (1.75, 0.0145),
    (1.97, 0.0105),
    (2.12, 0.0135),
    (2.26, 0.0105),
    (2.55, 0.0135),
    (2.97, 0.0085),
    (3.3, 0.0090),
    (3.75, 0.0058),
    (3.93, 0.0042),
    (4.0, 0.0),
)
LEG_PAINT = Paint(
    ((0.0, BARK), (1.2, UMBER), (2.0, BARK), (3.0, BARK), (4.0, UMBER)),
    belly=RUST,
    belly_edge=-0.5,
    bands=((2.0, 0.06, SAND), (2.3, 0.05, SAND), (3.0, 0.07, SAND), (3.45, 0.08, SAND)),
)
# x, z to the side and ahead, height, radius of each eye: two rows of four.
EYES = (
    (0.0115, 0.0865, 0.273, 0.0105),
    (0.0300, 0.0790, 0.270, 0.0062),
    (0.0175, 0.0790, 0.289, 0.0072),
    (0.0320, 0.0600, 0.287, 0.0066),
)


def build() -> BuiltIn:
    """Return the spider."""
    spider = Sculpture("spider")
    spider.joint("Body", (0.0, 0.262, 0.0))
    spider.joint("Abdomen", (0.0, 0.266, -0.066), "Body")
    _trunk(spider)
    for number, leg in enumerate(LEGS, start=1):
        points = spread_leg(leg, HIP_HEIGHT, SEGMENTS, BENDS)
        names = [f"LeftLeg{number}{segment}" for segment in SEGMENT_NAMES]
        spider.chain(names, points, "Body", marker=f"LeftLeg{number}Foot")
        patch = limb(points, LEG_PROFILE, sides=8, side=outward_side(points), corner=0.12)
        spider.add(patch, (*names, f"LeftLeg{number}Foot"), LEG_PAINT, blend=0.12)
    return spider.finish([f"LeftLeg{k}Coxa:LeftLeg{k}Foot" for k in (4, 3, 2, 1)])


def _trunk(spider: Sculpture) -> None:
    """Add the cephalothorax, the abdomen and what the face carries."""
    cephalothorax = body(
        (
            (0.0, 0.262, -0.078, 0.0),
            (0.0, 0.264, -0.045, 0.052, 0.028, 0.028),
            (0.0, 0.264, 0.000, 0.064, 0.032, 0.030),
            (0.0, 0.266, 0.045, 0.048, 0.032, 0.026),
            (0.0, 0.268, 0.076, 0.037, 0.027, 0.022),
            (0.0, 0.266, 0.094, 0.0),
        ),
        rings=13,
        sides=14,
    )
    back = Paint(
        ((0.0, UMBER), (0.3, BARK), (0.5, RUST), (0.8, BARK), (1.0, UMBER)), UMBER, belly_edge=-0.3
    )
    spider.add(cephalothorax, "Body", back)
    abdomen = body(
        (
            (0.0, 0.266, -0.060, 0.014),
            (0.0, 0.274, -0.090, 0.048, 0.040, 0.036),
            (0.0, 0.282, -0.160, 0.083, 0.070, 0.058),
            (0.0, 0.280, -0.225, 0.072, 0.058, 0.054),
            (0.0, 0.268, -0.285, 0.026, 0.022, 0.026),
            (0.0, 0.264, -0.298, 0.0),
        ),
        rings=17,
        sides=16,
    )
    marks = tuple((place, 0.022, SAND) for place in (0.30, 0.46, 0.61, 0.74))
    spider.add(
        abdomen,
        ("Body", "Abdomen"),
        Paint(((0.0, RUST), (0.5, BARK), (1.0, UMBER)), UMBER, 0.0, marks),
    )
    for x, z, height, radius in EYES:
        eye = ellipsoid(
            (x, height, z), (0.2 * radius, 0.2 * radius, radius), radius, rings=5, sides=8
        )
        spider.add(eye, "Body", plain(INK), GLOSS, both=True)
    chelicera = limb(
        [(0.016, 0.262, 0.078), (0.019, 0.240, 0.104), (0.017, 0.212, 0.110)],
        ((0.0, 0.014), (0.4, 0.0165), (1.0, 0.0145), (1.8, 0.009), (2.0, 0.0)),
        sides=8,
        pointed=False,
    )
    spider.add(chelicera, "Body", Paint(((0.0, RUST), (1.2, UMBER))), SHELL, both=True)
    fang = limb(
        [(0.019, 0.216, 0.111), (0.015, 0.200, 0.114), (0.007, 0.190, 0.106)],
        ((0.0, 0.006), (1.0, 0.0042), (2.0, 0.0)),
        sides=6,
    )
    spider.add(fang, "Body", plain(INK), GLOSS, both=True)
    palp = limb(
        [
            (0.028, 0.250, 0.080),
            (0.046, 0.272, 0.122),
            (0.044, 0.236, 0.162),
            (0.040, 0.196, 0.168),
        ],
        (
            (0.0, 0.010),
            (0.6, 0.0105),
            (1.0, 0.008),
            (1.5, 0.009),
            (2.0, 0.0075),
            (2.7, 0.009),
            (3, 0),
        ),
        sides=6,
        pointed=False,
    )
    spider.add(
        palp, "Body", Paint(((0.0, BARK), (3.0, UMBER)), None, 0.0, ((2.0, 0.2, SAND),)), both=True
    )
    spinneret = limb(
        [(0.010, 0.262, -0.285), (0.014, 0.256, -0.318)], ((0.0, 0.007), (1.0, 0.0)), sides=6
    )
    spider.add(spinneret, "Abdomen", plain(UMBER), both=True)
