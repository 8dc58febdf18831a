"""Pushes walking and standing creatures from eight sides, and measures how they take it.

    python benchmarks/pushes.py --rigs spider wolf --places flat crates --strengths 0.5 2.5

A strength of 1 changes the body's velocity by sqrt(g h), h the height of its hips. Of a herd of
twins each is pushed to another side, at another moment of its gait, and one like it is not pushed.
One row for a rig, a place, walking or standing, and a strength; of all sides the worst: slip, what
a standing foot is off the surface, residual of standing feet and of swinging ones, how deep a foot
is inside anything, joints beyond their limits (degrees), share of frames in which two legs touch;
how far the body was pushed off its path, and how far it is off it in the end, across and along;
the fewest feet of any that went to stand elsewhere. Lengths are % of leg length. Exit code 1 where
one breaks a limit.
"""

from __future__ import annotations

import argparse
import math
import sys
from typing import NamedTuple

import numpy as np
from audit import audit
from places import GRAVITY, RIGS, Rig, default_speed, hip_height, leg_length, load, make_place

from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.morphology.builtin import NAMES
from polypod.morphology.types import Morphology
from polypod.recording import record_walk
from polypod.report.apart import leg_room
from polypod.report.record import Recording
from polypod.world import World

SIDES = 8
PUSHED_AT = 2.5  # s
# What is played in between counts at any strength; the rest is asked of who is not thrown.
ALWAYS = ("slip", "off", "inside", "limits deg", "bones")
USUAL = ("residual", "swing in", "swing res")
GENTLE = 1.0
# Who is back is so near to its twin's path, leg lengths: on rough ground each finds its own way.
BACK = {"flat": 0.04}
BACK_ELSEWHERE = 0.35


class Pushed(NamedTuple):
    """The worst of all sides; lengths in leg lengths."""

    findings: dict[str, float]
    broken: set[str]
    touching: float
    farthest: float
    across: float
    along: float
    steps: int


def take(
    morphology: Morphology, place: str, speed: float, strength: float, seconds: float, fps: float,
    sides: int = SIDES,
) -> tuple[list[Recording], list[Recording], Environment]:  # fmt: skip
    """Return the walks of those that are pushed, of their twins, and where."""
    # Above what they walk on when they are pushed, crates lie all about.
    ahead = default_speed(morphology) * seconds
    environment = make_place(place, morphology, ahead, 1)
    walks = []
    for share in (strength, 0.0):
        world = World(environment, threads=1)
        alone = Settings(personal_space=0.0)
        world.add(morphology, sides, position=[0.0, 0.0], speed=speed, settings=alone)
        size = share * math.sqrt(GRAVITY * hip_height(morphology))
        for side in range(sides if share > 0.0 else 0):
            angle = 2.0 * math.pi * side / sides
            push = (size * math.sin(angle), 0.0, size * math.cos(angle))
            world.push_at(PUSHED_AT, push, side)
        walks.append(record_walk(world, seconds, fps))
    return walks[0], walks[1], environment


def judge(
    pushed: list[Recording], alone: list[Recording], environment: Environment, commanded: float
) -> Pushed:
    """Measure the walks of one kind and strength."""
    findings: dict[str, float] = {}
    broken: set[str] = set()
    touching = farthest = across = along = 0.0
    steps = 1000
    for walk, twin in zip(pushed, alone, strict=True):
        leg = float(walk.morphology.legs.length.mean())
        for name, finding in audit(walk, environment.table, max(commanded, 1e-9), 0.0).items():
            if not finding.value <= findings.get(name, -1.0):
                findings[name] = finding.value
            if finding.fails:
                broken.add(name)
        touching = max(touching, float(np.mean(leg_room(walk).of_leg < 0.0)))
        gap = (walk.body_position - twin.body_position)[:, [0, 2]] / leg
        farthest = max(farthest, float(np.linalg.norm(gap, axis=1).max()))
        # Twins out of step sway apart: the mean of the last second.
        left = np.abs(gap[walk.time > walk.time[-1] - 1.0].mean(axis=0))
        across, along = max(across, float(left[0])), max(along, float(left[1]))
        lifted = (walk.foot_stance[:-1] & ~walk.foot_stance[1:]).sum()
        steps = min(steps, int(lifted))
    return Pushed(findings, broken, touching, farthest, across, along, steps)


def failures(result: Pushed, place: str, strength: float) -> list[str]:
    """Return what is out of bounds."""
    names = (*ALWAYS, *USUAL) if strength <= GENTLE else ALWAYS
    failed = [name for name in names if name in result.broken]
    if not result.across <= BACK.get(place, BACK_ELSEWHERE):
        failed.append("across")
    return failed


def main() -> int:
    """Push, print a table, and say whether all limits are kept."""
    names = [rig.name for rig in RIGS]
    every = [*names, *(name for name in NAMES if name not in names)]
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--rigs", nargs="+", default=["spider", "wolf"], choices=every)
    parser.add_argument("--places", nargs="+", default=["flat", "crates"])
    parser.add_argument("--strengths", nargs="+", type=float, default=[0.5, 2.5])
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--fps", type=float, default=30.0)
    given = parser.parse_args()
    columns = (*ALWAYS[:4], *USUAL)
    print("lengths in % of leg length")
    print(f"{'rig':<11}{'place':<8}{'does':<6}{'strength':>9}"
          + "".join(f"{name:>11}" for name in columns)
          + f"{'touching':>10}{'farthest':>10}{'across':>8}{'along':>8}{'steps':>6}")  # fmt: skip
    kept = total = 0
    for name in given.rigs:
        morphology = load(next((rig for rig in RIGS if rig.name == name), Rig(name)))
        if morphology is None:
            print(f"{name:<11}its file is not here")
            continue
        # Large creatures are slower by what a leg's pendulum is.
        seconds = PUSHED_AT + max(given.seconds - PUSHED_AT, 22.0 * pendulum(morphology))
        for place in given.places:
            for does in ("walks", "stands"):
                for strength in given.strengths:
                    speed = default_speed(morphology) if does == "walks" else 0.0
                    walks = take(morphology, place, speed, strength, seconds, given.fps)
                    result = judge(*walks, speed * seconds)
                    failed = failures(result, place, strength)
                    total += 1
                    kept += not failed
                    cells = "".join(
                        f"{result.findings[c] * (1.0 if 'deg' in c else 100.0):>11.4f}"
                        for c in columns
                    )
                    print(
                        f"{name:<11}{place:<8}{does:<6}{strength:>9g}{cells}"
                        f"{result.touching:>10.4f}{100 * result.farthest:>10.1f}"
                        f"{100 * result.across:>8.2f}{100 * result.along:>8.2f}{result.steps:>6}"
                        f"{'  BREAKS ' + ', '.join(failed) if failed else ''}",
                        flush=True,
                    )
    print(f"{kept} of {total} keep every limit")
    return 0 if kept == total else 1


def pendulum(morphology: Morphology) -> float:
    """Return the pendulum time of a creature's legs, s."""
    return math.sqrt(leg_length(morphology) / GRAVITY)


if __name__ == "__main__":
    sys.exit(main())
