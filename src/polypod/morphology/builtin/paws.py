"""A paw under the last joint of a leg: the ball, four toes with claws."""

from __future__ import annotations

from polypod.morphology.builtin.sculpture import GLOSS, Paint, Sculpture, plain
from polypod.morphology.builtin.shapes import body, ellipsoid, limb

# Of the toes, the outer one last: across and ahead of the joint, m.
TOES = ((-0.0225, 0.040), (-0.0080, 0.053), (0.0080, 0.053), (0.0225, 0.040))


def add_paw(
    creature: Sculpture, bone: str, scale: float, fur: str, pad: str, claw_colour: str
) -> None:
    """Add a paw.

    Args:
        creature: it grows there.
        bone: the joint, above the ground by the height of the paw.
        scale: of its plan, where a wolf's is 1.
        fur: colour of its upper side.
        pad: colour of its sole.
        claw_colour: of the claws.
    """
    x, height, z = (float(value) for value in creature.position(bone))
    paint = Paint(((0.0, fur),), pad, belly_edge=-0.8)
    ball = body(
        [
            (x, 0.5 * height, z - 0.030 * scale, 0.0),
            (x, 0.5 * height, z - 0.020 * scale, 0.025 * scale, 0.6 * height, 0.54 * height),
            (x, 0.5 * height, z + 0.008 * scale, 0.031 * scale, 0.78 * height, 0.54 * height),
            (x, 0.42 * height, z + 0.035 * scale, 0.027 * scale, 0.45 * height, 0.46 * height),
            (x, 0.38 * height, z + 0.050 * scale, 0.0),
        ],
        rings=9,
        sides=12,
        exponent=2.6,
    )
    creature.add(ball, bone, paint)
    for aside, ahead in TOES:
        middle = (x + aside * scale, 0.0125 * scale, z + ahead * scale)
        toe = ellipsoid(
            middle,
            (0.15 * aside, 0.0, 0.020 * scale),
            0.0095 * scale,
            0.0125 * scale,
            rings=5,
            sides=8,
        )
        creature.add(toe, bone, paint)
        _, y, end = middle
        claw = limb(
            [
                (middle[0], y - 0.001, end + 0.014 * scale),
                (middle[0], y - 0.001, end + 0.014 * scale + 0.008),
                (middle[0], y - 0.007, end + 0.014 * scale + 0.015),
            ],
            ((0.0, 0.0042), (1.0, 0.0035), (2.0, 0.0)),
            sides=6,
        )
        creature.add(claw, bone, plain(claw_colour), GLOSS)
