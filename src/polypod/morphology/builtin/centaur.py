"""A six-legged beast whose forebody rises: three girdles, all of whose legs walk (P2 Figure 14)."""

from __future__ import annotations

import numpy as np

from polypod.morphology.builtin.paws import add_paw
from polypod.morphology.builtin.sculpture import GLOSS, BuiltIn, Paint, Piece, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb

SLATE, MOSS, DUSK, BONE, RUST, INK, EMBER = (
    "#4c5a5e", "#3c4a3f", "#2a3338", "#cfc7ae", "#8a5a3c", "#121312", "#d8912b",
)  # fmt: skip

# Joints of the middle, m. From the middle girdle on the spine rises toward the foremost.
SPINE = {
    "Pelvis": (0.0, 0.600, -0.574),
    "Spine1": (0.0, 0.612, -0.450),
    "Spine2": (0.0, 0.615, -0.327),
    "Spine3": (0.0, 0.612, -0.205),
    "Withers": (0.0, 0.610, -0.084),
    "Spine4": (0.0, 0.628, 0.056),
    "Spine5": (0.0, 0.666, 0.188),
    "Spine6": (0.0, 0.725, 0.306),
    "Chest": (0.0, 0.790, 0.415),
    "Neck1": (0.0, 0.870, 0.522),
    "Neck2": (0.0, 0.939, 0.584),
    "Head": (0.0, 1.003, 0.648),
}
TAIL = (
    (0.0, 0.593, -0.715),
    (0.0, 0.564, -0.825),
    (0.0, 0.513, -0.930),
    (0.0, 0.458, -1.028),
    (0.0, 0.409, -1.128),
    (0.0, 0.377, -1.232),
    (0.0, 0.365, -1.337),
)
RUMP = (0.0, 0.586, -0.625)  # inside the trunk, where the tail begins
# Hip, knee (forward), hock (back), ball of the paw; shoulder, elbow (back), wrist, ball.
HIND_LEG = (
    (0.082, 0.563, -0.574),
    (0.099, 0.377, -0.488),
    (0.087, 0.186, -0.654),
    (0.086, 0.045, -0.619),
)
# Its feet stand outside the track of the others, which come near them at each step.
MIDDLE_LEG = (
    (0.084, 0.544, -0.081),
    (0.116, 0.404, -0.210),
    (0.118, 0.165, -0.170),
    (0.122, 0.043, -0.116),
)
FORE_LEG = (
    (0.087, 0.716, 0.463),
    (0.119, 0.505, 0.297),
    (0.104, 0.195, 0.369),
    (0.100, 0.045, 0.441),
)
HIND_NAMES = ("LeftThigh", "LeftShin", "LeftMetatarsus", "LeftHindPaw")
MIDDLE_NAMES = ("LeftMiddleArm", "LeftMiddleForearm", "LeftMiddleMetacarpus", "LeftMiddlePaw")
FORE_NAMES = ("LeftUpperArm", "LeftForearm", "LeftMetacarpus", "LeftForePaw")

# Sections from the rump to the nose: x, y, z, half widths across, up, down.
HIDE_SECTIONS = (
    (0.0, 0.564, -0.753, 0.0),
    (0.0, 0.565, -0.726, 0.052, 0.052, 0.058),
    (0.0, 0.573, -0.625, 0.091, 0.073, 0.104),
    (0.0, 0.582, -0.498, 0.093, 0.071, 0.123),
    (0.0, 0.586, -0.357, 0.086, 0.065, 0.125),
    (0.0, 0.587, -0.217, 0.084, 0.061, 0.128),
    (0.0, 0.584, -0.089, 0.091, 0.065, 0.141),
    (0.0, 0.588, 0.035, 0.099, 0.073, 0.153),
    (0.0, 0.614, 0.142, 0.095, 0.074, 0.140),
    (0.0, 0.657, 0.239, 0.089, 0.073, 0.121),
    (0.0, 0.709, 0.327, 0.093, 0.074, 0.123),
    (0.0, 0.763, 0.408, 0.100, 0.078, 0.130),
    (0.0, 0.815, 0.477, 0.095, 0.076, 0.119),
    (0.0, 0.869, 0.534, 0.076, 0.067, 0.093),
    (0.0, 0.923, 0.582, 0.061, 0.058, 0.071),
    (0.0, 0.969, 0.634, 0.057, 0.052, 0.060),
    (0.0, 0.995, 0.692, 0.060, 0.047, 0.054),
    (0.0, 0.993, 0.752, 0.052, 0.038, 0.045),
    (0.0, 0.973, 0.811, 0.040, 0.029, 0.035),
    (0.0, 0.947, 0.873, 0.033, 0.023, 0.027),
    (0.0, 0.928, 0.923, 0.025, 0.019, 0.020),
    (0.0, 0.921, 0.943, 0.0),
)
BANDS = tuple((place, 0.011, DUSK) for place in np.linspace(0.08, 0.62, 13).tolist())
HIDE_PAINT = Paint(
    ((0.0, SLATE), (0.35, MOSS), (0.6, SLATE), (0.75, SLATE), (0.86, RUST), (0.95, SLATE)),
    BONE, -0.4, BANDS,
)  # fmt: skip
# Place in joints, half widths across, to the front, to the back.
HIND_PROFILE = (
    (0.0, 0.0),
    (0.05, 0.022, 0.036, 0.038),
    (0.13, 0.038, 0.060, 0.064),
    (0.25, 0.050, 0.078, 0.084),
    (0.42, 0.058, 0.088, 0.096),
    (0.60, 0.057, 0.084, 0.096),
    (0.80, 0.050, 0.068, 0.084),
    (1.00, 0.042, 0.050, 0.066),
    (1.20, 0.037, 0.040, 0.054),
    (1.45, 0.030, 0.031, 0.039),
    (1.72, 0.023, 0.024, 0.027),
    (1.97, 0.022, 0.021, 0.030),
    (2.15, 0.020, 0.020, 0.023),
    (2.60, 0.020, 0.020, 0.020),
    (2.88, 0.024, 0.024, 0.024),
    (3.00, 0.027, 0.027, 0.026),
)
# The fore and middle legs begin at the shoulder blade's upper end: a joint more.
FORE_PROFILE = (
    (0.0, 0.0),
    (0.08, 0.013, 0.028, 0.028),
    (0.25, 0.024, 0.046, 0.046),
    (0.50, 0.036, 0.058, 0.060),
    (0.80, 0.044, 0.062, 0.070),
    (1.05, 0.047, 0.062, 0.076),
    (1.30, 0.045, 0.057, 0.072),
    (1.60, 0.040, 0.047, 0.057),
    (1.85, 0.036, 0.039, 0.047),
    (2.02, 0.033, 0.035, 0.042),
    (2.20, 0.030, 0.032, 0.036),
    (2.50, 0.024, 0.026, 0.027),
    (2.85, 0.021, 0.022, 0.023),
    (3.00, 0.023, 0.024, 0.025),
    (3.30, 0.021, 0.022, 0.022),
    (3.80, 0.025, 0.026, 0.025),
    (4.00, 0.028, 0.028, 0.026),
)
LEG_PAINT = Paint(((0.0, SLATE), (1.0, SLATE), (1.8, RUST), (3.0, BONE)))
ARM_PAINT = Paint(((0.0, SLATE), (1.0, SLATE), (2.4, RUST), (4.0, BONE)))
HAUNCH = (0.050, 0.625, -0.595)  # where the thigh's mass begins
MIDDLE_BLADE = (0.047, 0.629, -0.156)  # the upper ends of the shoulder blades
FORE_BLADE = (0.048, 0.807, 0.377)
SEAM = 0.055  # how far around the roots of limbs the skin flows over, m


def build() -> BuiltIn:
    """Return the centaur."""
    centaur = Sculpture("centaur")
    names = tuple(SPINE)
    centaur.chain(names, np.array(list(SPINE.values())))
    centaur.joint("Jaw", (0.0, 0.967, 0.694), "Head")
    tail = [f"Tail{k}" for k in range(1, len(TAIL))]
    centaur.chain(tail, TAIL, "Pelvis", marker="TailTip")
    centaur.chain(HIND_NAMES, HIND_LEG, "Pelvis")
    centaur.chain(MIDDLE_NAMES, MIDDLE_LEG, "Withers")
    centaur.chain(FORE_NAMES, FORE_LEG, "Chest")
    hide = centaur.add(body(HIDE_SECTIONS, rings=74, sides=22), names, HIDE_PAINT, blend=0.48)
    limbs = [_tail(centaur, tail)]
    hind = limb((HAUNCH, *HIND_LEG[1:]), HIND_PROFILE, sides=12)
    limbs.append(centaur.add(hind, ("Pelvis", *HIND_NAMES), LEG_PAINT))
    for blade, points, carrier, bones in (
        (MIDDLE_BLADE, MIDDLE_LEG, "Withers", MIDDLE_NAMES),
        (FORE_BLADE, FORE_LEG, "Chest", FORE_NAMES),
    ):
        arm = limb((blade, *points), FORE_PROFILE, sides=12, corner=0.4)
        limbs.append(centaur.add(arm, (carrier, *bones), ARM_PAINT))
    centaur.fuse(hide, limbs, SEAM)
    _head(centaur)
    legs = []
    for bones, scale in ((HIND_NAMES, 1.08), (MIDDLE_NAMES, 1.04), (FORE_NAMES, 1.14)):
        add_paw(centaur, bones[-1], scale, BONE, DUSK, INK)
        legs.append(f"{bones[0]}:{bones[-1]}")
    return centaur.finish(legs, names)


def _tail(centaur: Sculpture, names: list[str]) -> Piece:
    """Add the long tail that balances the raised forebody."""
    whip = limb(
        (RUMP, *TAIL),
        (
            (0.0, 0.036),
            (0.6, 0.048, 0.044, 0.048),
            (1.0, 0.046, 0.042, 0.046),
            (2.0, 0.037),
            (3.0, 0.030),
            (4.0, 0.024),
            (5.0, 0.018),
            (6.0, 0.012),
            (7.0, 0.0),
        ),
        sides=14,
        side=(-1.0, 0.0, 0.0),
    )
    rings = tuple((place, 0.12, DUSK) for place in np.arange(1.2, 6.8, 0.55).tolist())
    paint = Paint(((0.0, SLATE), (4.0, MOSS), (7.0, DUSK)), BONE, -0.6, rings)
    return centaur.add(whip, ("Pelvis", *names, "TailTip"), paint, blend=0.45)


def _head(centaur: Sculpture) -> None:
    """Add jaw, nostrils, eyes and the horns that sweep back."""
    jaw = body(
        (
            (0.0, 0.958, 0.684, 0.0),
            (0.0, 0.950, 0.715, 0.042, 0.020, 0.022),
            (0.0, 0.934, 0.782, 0.032, 0.014, 0.019),
            (0.0, 0.915, 0.854, 0.023, 0.010, 0.013),
            (0.0, 0.906, 0.906, 0.0),
        ),
        rings=11,
        sides=10,
    )
    centaur.add(jaw, "Jaw", Paint(((0.0, SLATE), (1.0, RUST)), BONE, -0.1))
    eye = ellipsoid((0.040, 1.014, 0.759), (0.006, 0.001, 0.009), 0.0085, 0.0090, rings=6, sides=8)
    centaur.add(eye, "Head", plain(EMBER), GLOSS, both=True)
    pupil = ellipsoid((0.046, 1.014, 0.764), (0.002, 0.0, 0.003), 0.0042, rings=5, sides=8)
    centaur.add(pupil, "Head", plain(INK), GLOSS, both=True)
    nostril = ellipsoid((0.013, 0.936, 0.929), (0.003, 0.001, 0.003), 0.0042, rings=5, sides=8)
    centaur.add(nostril, "Head", plain(INK), both=True)
    horn = limb(
        (
            (0.033, 1.034, 0.709),
            (0.052, 1.086, 0.673),
            (0.069, 1.114, 0.609),
            (0.076, 1.112, 0.534),
            (0.074, 1.092, 0.470),
        ),
        ((0.0, 0.0175), (0.5, 0.0165), (1.0, 0.0145), (2.0, 0.0105), (3.0, 0.0060), (4.0, 0.0)),
        sides=10,
    )
    rings = tuple((place, 0.07, DUSK) for place in np.arange(0.4, 3.0, 0.3).tolist())
    paint = Paint(((0.0, RUST), (2.0, BONE), (4.0, INK)), bands=rings)
    centaur.add(horn, "Head", paint, GLOSS, both=True)
