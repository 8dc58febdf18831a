"""`polypod rig`: what was found in a rig, and what was guessed."""

from __future__ import annotations

import argparse

from polypod.jobs.rig_options import RIG_HELP, add_rig_options, load_given_rig
from polypod.jobs.values import filled

DESCRIPTION = "Prints a rig's joints, legs, spine, limits and size, and what was guessed of it."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `polypod rig`."""
    parser.add_argument("rig", type=filled, metavar="RIG", help=RIG_HELP)
    add_rig_options(parser)


def run(given: argparse.Namespace) -> int:
    """Print the description."""
    from polypod.morphology.describe import describe

    print(describe(load_given_rig(given)))
    return 0
