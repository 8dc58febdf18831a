"""The options that say what a rig file does not: legs, spine, front and size."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from polypod.jobs.values import filled, names, number

if TYPE_CHECKING:
    from polypod.morphology.types import Morphology

DEFAULT_RIG = "spider"
RIG_HELP = (
    "a .glb or .gltf file, a creature file (.toml), or a built-in creature: spider, ant, crab, "
    "pentapod, centipede, wolf, lizard, centaur, biped"
)
# Options of a rig, as they are typed, by the name under which they are read.
RIG_OPTIONS = {
    "leg": "--leg",
    "spine": "--spine",
    "forward": "--forward",
    "height": "--height",
    "body_height": "--body-height",
}
size = number(0.0, 1000.0, "m", above=True)


def add_rig_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a rig."""
    parser.add_argument(
        "--leg",
        action="append",
        type=filled,
        metavar="HIP:FOOT",
        help="a leg by two nodes, names or #index; repeat for each leg; omitted: detected",
    )
    parser.add_argument(
        "--spine",
        type=names,
        metavar="J,J,...",
        help="joints of the spine from back to head; omitted: detected",
    )
    parser.add_argument(
        "--forward",
        choices=("+z", "-z", "+x", "-x"),
        help="the file's direction that the creature faces; omitted: guessed",
    )
    parser.add_argument(
        "--height",
        type=size,
        metavar="M",
        help="from the ground to the top of the skin at rest; omitted: file units are metres",
    )
    parser.add_argument(
        "--body-height",
        type=size,
        metavar="M",
        help="preferred height of the body's centre above the ground",
    )


def load_given_rig(given: argparse.Namespace) -> Morphology:
    """Return the morphology of the rig on the command line, the spider where there is none.

    Raises:
        PolypodError: it cannot be read, or its legs cannot walk.
    """
    from polypod.morphology.load import load_rig

    return load_rig(
        given.rig or DEFAULT_RIG,
        legs=given.leg,
        spine=given.spine,
        forward=given.forward,
        height=given.height,
        body_height=given.body_height,
    )
