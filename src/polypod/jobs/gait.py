"""`polypod gait`: list gaits, show one as disks, write it, count its feet."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from polypod.errors import SettingError
from polypod.jobs.outputs import judge_distinct
from polypod.jobs.rig_options import load_given_rig
from polypod.jobs.values import filled, number, whole

if TYPE_CHECKING:
    from polypod.gait.pattern import Gait, IntArray

DESCRIPTION = """Without a name lists all gaits; with one shows its disks: # stands, . swings.

  polypod gait trot --legs 4
  polypod gait tripod --rig ant -o tripod.png -o tripod.toml"""
DEFAULT_LEGS = 4


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `polypod gait`."""
    parser.add_argument(
        "gait", nargs="?", type=filled, metavar="NAME|FILE", help="a gait's name or a gait file"
    )
    feet = parser.add_mutually_exclusive_group()
    feet.add_argument("--rig", type=filled, metavar="RIG", help="for the feet of this creature")
    feet.add_argument(
        "--legs",
        type=whole(2, 400, "a number of legs"),
        metavar="N",
        help=f"for so many legs in pairs; default: {DEFAULT_LEGS}, or the gait file's",
    )
    parser.add_argument(
        "--duty",
        type=number(0.01, 0.99, "of the cycle"),
        help="mean share of the cycle in which a foot stands, kept within the gait's own range",
    )
    parser.add_argument(
        "-o",
        dest="out",
        action="append",
        default=[],
        type=filled,
        metavar="OUT.png|OUT.toml",
        help="the gait as a picture, or as a gait file; repeatable",
    )
    parser.add_argument("--check", action="store_true", help="print duties, feet down and flight")
    # Rig options that `load_given_rig` reads and this command leaves to a creature file.
    parser.set_defaults(leg=None, spine=None, forward=None, height=None, body_height=None)


def run(given: argparse.Namespace) -> int:
    """List, show, write."""
    if given.gait is None:
        for option, value in (("-o", given.out), ("--check", given.check), ("--duty", given.duty)):
            if value:
                raise SettingError(f"{option} needs a gait's name or file before it")
        print(_list(given))
        return 0
    _judge(given)
    gait, feet = _find(given)
    if given.check:
        print(check(gait))
    else:
        from polypod.gait.draw import describe

        print(describe(gait, feet))
    for name in given.out:
        _write(gait, Path(name), feet)
        print(f"wrote {name}")
    return 0


def check(gait: Gait) -> str:
    """Return a gait's duties, feet down and flight as text; its arcs are exact."""
    length, down = gait.support()
    mean = float((length * down).sum() / length.sum())
    duties = " ".join(f"{1.0 - extent:.3f}" for extent in gait.swing_extent)
    return "\n".join(
        [
            f"{gait.name}: {gait.foot_count} feet, {gait.family}",
            f"mean duty       {gait.duty:.3f}, from {gait.duty_low:.3f} to {gait.duty_high:.3f}",
            f"duty of feet    {duties}",
            f"feet down       at least {gait.minimum_feet_down}, {mean:.2f} on the mean, at most "
            f"{gait.maximum_feet_down}",
            f"flight          {100.0 * gait.flight_share:.1f} % of the cycle",
        ]
    )


def _judge(given: argparse.Namespace) -> None:
    asked = [("-o", name, (".png", ".toml")) for name in given.out]
    judge_distinct(asked, [Path(given.gait)])


def _find(given: argparse.Namespace) -> tuple[Gait, tuple[str, ...]]:
    """Return the gait and the names of the feet, none where they have none."""
    from polypod.gait.files import read_gait
    from polypod.gait.library import make_gait
    from polypod.jobs.cast import find_gait, gait_file

    file = gait_file(given.gait)
    feet: tuple[str, ...] = ()
    if given.rig is not None:
        morphology = load_given_rig(given)
        gait, feet = find_gait(given.gait, morphology), morphology.foot_name
    elif file is not None:
        gait = read_gait(file, given.legs)
    else:
        gait = make_gait(given.gait, *paired_legs(given.legs or DEFAULT_LEGS))
    return (gait if given.duty is None else gait.with_duty(given.duty)), feet


def paired_legs(count: int) -> tuple[IntArray, IntArray]:
    """Return sides and rows [count] of legs in pairs from the back; an odd one is in front."""
    import numpy as np

    leg = np.arange(count)
    side = 1 - 2 * (leg % 2)
    if count % 2:
        side[-1] = 0
    return side, leg // 2


def _write(gait: Gait, path: Path, feet: tuple[str, ...]) -> None:
    from polypod.gait.draw import draw_gait
    from polypod.gait.files import write_gait

    if path.suffix.lower() == ".png":
        draw_gait(gait, path, foot_name=feet)
    else:
        write_gait(gait, path)


def _list(given: argparse.Namespace) -> str:
    """Return a line for each gait, for the legs asked for."""
    from polypod.gait.library import make_gait, names

    side, row = paired_legs(given.legs or DEFAULT_LEGS)
    if given.rig is not None:
        legs = load_given_rig(given).legs
        side, row = legs.side, legs.row
    lines = [f"gaits, here for {len(side)} feet (--legs or --rig for others):", ""]
    lines.append(f"{'name':18} {'family':10} {'duty':14} feet down   flight")
    for name in names():
        gait = make_gait(name, side, row)
        duty = f"{gait.duty_low:.2f} to {gait.duty_high:.2f}"
        down = f"{gait.minimum_feet_down} to {gait.maximum_feet_down}"
        flight = f"{100.0 * gait.flight_share:.0f} %"
        lines.append(f"{name:18} {gait.family:10} {duty:14} {down:11} {flight:>5}")
    return "\n".join(lines)
