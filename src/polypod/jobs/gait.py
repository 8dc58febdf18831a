"""`polypod gait`: list gaits, show one as disks, write it, judge it."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from polypod.errors import SettingError
from polypod.jobs.outputs import judge_distinct
from polypod.jobs.rig_options import load_given_rig
from polypod.jobs.screen import telling_of_compilation
from polypod.jobs.values import filled, number, whole

if TYPE_CHECKING:
    from polypod.gait.orbit import Orbit
    from polypod.gait.pattern import Gait, IntArray
    from polypod.gait.validation import GaitCheck
    from polypod.morphology.types import Morphology

DESCRIPTION = """Without a name lists all gaits; with one shows its disks: # stands, . swings.

  polypod gait trot --legs 4
  polypod gait tripod --rig ant -o tripod.png -o tripod.toml
  polypod gait rotary-gallop --rig wolf --speed 6 --check"""
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
    parser.add_argument(
        "--check",
        action="store_true",
        help="judge it: forces, flight, the body's rise and fall, balance, and what would mend it",
    )
    parser.add_argument(
        "--speed",
        type=number(0.0, 100.0, "m/s"),
        metavar="M/S",
        help="with --check; omitted: what is comfortable for the legs",
    )
    # Rig options that `load_given_rig` reads and this command leaves to a creature file.
    parser.set_defaults(leg=None, spine=None, forward=None, height=None, body_height=None)


def run(given: argparse.Namespace) -> int:
    """List, show, write."""
    if given.gait is None:
        asked = {"-o": given.out or None, "--check": given.check or None, "--duty": given.duty}
        for option, value in (asked | {"--speed": given.speed}).items():
            if value is not None:
                raise SettingError(f"{option} needs a gait's name or file before it")
        print(_list(given))
        return 0
    _judge(given)
    gait, morphology = _find(given)
    feet = () if morphology is None else morphology.foot_name
    if given.check:
        checked = _check(given, gait, morphology)
        print(describe_check(checked, feet))
        drawn, orbit = checked.gait, checked.orbit
    else:
        from polypod.gait.draw import describe

        print(describe(gait, feet))
        drawn, orbit = gait, None
    for name in given.out:
        _write(gait, drawn, orbit, Path(name), feet)
        print(f"wrote {name}")
    return 0


def _check(given: argparse.Namespace, gait: Gait, morphology: Morphology | None) -> GaitCheck:
    from polypod.gait.validation import check_gait

    if given.duty is not None:
        # Asked for, so it does not follow the speed.
        gait = replace(gait, duty_low=gait.duty, duty_high=gait.duty)
    with telling_of_compilation(whole=False):
        return check_gait(gait, morphology, speed=given.speed)


def describe_check(check: GaitCheck, foot_name: Sequence[str] = ()) -> str:
    """Return a gait's figures at a speed as text, its verdict last; its arcs are exact."""
    gait = check.gait
    length, down = gait.support()
    mean = float((length * down).sum() / length.sum())
    pushed = check.orbit.lowest.phase, check.orbit.highest.phase
    names = [f"; {name}" if name else "" for name in foot_name] or [""] * gait.foot_count
    lines = [
        f"{gait.name}: {gait.foot_count} feet, {gait.family}, for {check.creature}",
        f"speed           {check.speed:.3g} m/s, a Froude number of {check.froude:.3g}",
        f"period          {check.period:.3g} s a cycle{_asked_period(check)}",
        f"mean duty       {gait.duty:.3f}, from {gait.duty_low:.3f} to {gait.duty_high:.3f}",
        f"feet down       at least {gait.minimum_feet_down}, {mean:.2f} on the mean, at most "
        f"{gait.maximum_feet_down}; {check.feet_needed} needed, fewer for "
        f"{100.0 * check.short_share:.1f} % of the cycle",
        f"flight          {100.0 * check.flight_share:.1f} % of the cycle, "
        f"{check.flight:.3f} s at a time",
        f"body's force    {check.body_least:.2f} to {check.body_peak:.2f} g",
        f"body's height   {100.0 * check.excursion:.2g} cm from lowest, at phase {pushed[0]:.2f}, "
        f"to highest, at {pushed[1]:.2f}; {check.excursion_hips:.3f} hip heights, over a standing "
        f"foot {check.stroke_hips:.3f}",
        f"balance         centre at least {check.margin_least:.2f} leg lengths inside its feet, "
        f"{check.margin_mean:.2f} on the mean; negative: outside",
    ]
    for k, (peak, share) in enumerate(zip(check.foot_peak, check.foot_share, strict=True)):
        lines.append(
            f"foot {k:<10} duty {1.0 - gait.swing_extent[k]:.3f}, bears up to {peak:.2f} times its "
            f"load in standing, {share:.2f} of the body's weight{names[k]}"
        )
    lines.append(f"verdict         {check.verdict}, with {check.body_peak:.2f} g at the peak")
    lines += [f"because         {reason}" for reason in check.reasons]
    if check.change is not None:
        lines.append(f"plausible with  {check.change.text}")
    elif check.reasons:
        lines.append("plausible with  nothing near: no duty, period, speed or gait that was tried")
    return "\n".join(lines)


def _asked_period(check: GaitCheck) -> str:
    """Say so where a gait's own period was shortened."""
    asked = check.gait.period
    if math.isnan(asked) or asked == check.period:
        return ""
    return f"; the {asked:.3g} s asked for take longer strides than the legs reach"


def _judge(given: argparse.Namespace) -> None:
    if given.speed is not None and not given.check:
        raise SettingError("--speed is for --check, which was not asked for")
    asked = [("-o", name, (".png", ".toml")) for name in given.out]
    judge_distinct(asked, [Path(given.gait)])


def _find(given: argparse.Namespace) -> tuple[Gait, Morphology | None]:
    """Return the gait, and the creature if one was named."""
    from polypod.gait.files import read_gait
    from polypod.gait.library import make_gait
    from polypod.jobs.cast import find_gait, gait_file

    file = gait_file(given.gait)
    morphology = None
    if given.rig is not None:
        morphology = load_given_rig(given)
        gait = find_gait(given.gait, morphology)
    elif file is not None:
        gait = read_gait(file, given.legs)
    else:
        gait = make_gait(given.gait, *paired_legs(given.legs or DEFAULT_LEGS))
    return (gait if given.duty is None else gait.with_duty(given.duty)), morphology


def paired_legs(count: int) -> tuple[IntArray, IntArray]:
    """Return sides and rows [count] of legs in pairs from the back; an odd one is in front."""
    import numpy as np

    leg = np.arange(count)
    side = 1 - 2 * (leg % 2)
    if count % 2:
        side[-1] = 0
    return side, leg // 2


def _write(gait: Gait, drawn: Gait, orbit: Orbit | None, path: Path, feet: tuple[str, ...]) -> None:
    from polypod.gait.draw import draw_gait
    from polypod.gait.files import write_gait

    if path.suffix.lower() == ".png":
        draw_gait(drawn, path, foot_name=feet, orbit=orbit)
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
