"""Walks creatures among things that move, and measures them against the true geometry.

    python benchmarks/soak.py --rigs spider wolf --places crates platforms careless --seeds 3

`crates` go to and fro at up to half of the walker's speed, `platforms` rise and fall under its way,
`turning` ones turn as they do, with crates that turn to and fro between them,
`careless` crates change their course every half second without warning. One row a walk: how deep a
foot is inside anything at worst, at four moments between frames too, and in what share of them
beyond 1 % of its leg; slip in the frame of what is stood on; distance to the surface; residual;
share of the commanded distance; longest halt. Exit code 1 where a walk breaks a limit.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import sys
from typing import NamedTuple

import numpy as np
from acceptance import load
from places import RIGS, Rig, crates, default_speed, front, leg_length

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.morphology.builtin import NAMES
from polypod.morphology.types import Morphology
from polypod.recording import add_frame
from polypod.report.ground import Ground
from polypod.report.record import Recorder, Recording
from polypod.report.stances import slip_per_stance
from polypod.world import World

SUBFRAMES = 4
PLACES = ("crates", "platforms", "turning", "careless")
CRATES = 40
COURSE_SECONDS = 0.5  # after which careless crates change their course
LIMITS = {"inside": 0.01, "slip": 1e-3, "off": 2e-3, "residual": 0.01, "halt": 3.0}


class Soaked(NamedTuple):
    """The worst of a walk; lengths in leg lengths."""

    inside: float
    beyond: float  # share of moments in which a foot is inside by more than the limit
    slip: float
    off: float
    residual: float
    distance: float  # share of what was commanded
    halt: float  # s

    def broken(self) -> list[str]:
        """Return the limits that are broken."""
        return [name for name, limit in LIMITS.items() if not getattr(self, name) <= limit]


class Careless:
    """Crates that change their course without warning."""

    def __init__(self, environment: Environment, speed: float, seed: int) -> None:
        """Give each a course."""
        self.environment = environment
        self.random = np.random.default_rng(seed)
        self.speed = speed
        self.place = environment.places()
        self.velocity = np.zeros_like(self.place)
        self.until = self.random.uniform(0.0, COURSE_SECONDS, len(self.place))

    def step(self, time: float, dt: float) -> None:
        """Move them all."""
        turn = np.flatnonzero(self.until <= time)
        course = self.random.uniform(0.0, 2.0 * math.pi, len(turn))
        size = self.random.uniform(0.0, self.speed, len(turn))
        self.velocity[turn, 0] = size * np.sin(course)
        self.velocity[turn, 2] = size * np.cos(course)
        self.until[turn] += COURSE_SECONDS
        self.place += self.velocity * dt
        for index, place in enumerate(self.place):
            self.environment.move(index, place, self.velocity[index])


def moving_crates(morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return crates that go to and fro over the strip that is walked."""
    unit, speed = leg_length(morphology), default_speed(morphology)
    random = np.random.default_rng(seed)
    made = []
    for crate in crates(morphology, front(morphology) + 0.5 * unit, distance, seed, 0.0)[:CRATES]:
        course, way = random.uniform(0.0, 2.0 * math.pi), random.uniform(1.0, 3.0) * unit
        end = np.array(crate.position) + way * np.array([math.sin(course), 0.0, math.cos(course)])
        pace = float(random.uniform(0.1, 0.5)) * speed
        made.append(dataclasses.replace(crate, path=(tuple(end.tolist()),), speed=pace))
    return Environment(None, made)


def platforms(morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return plates that rise and fall, one behind the other."""
    unit, speed = leg_length(morphology), default_speed(morphology)
    random = np.random.default_rng(seed)
    made = []
    z = front(morphology) + 0.6 * unit
    while z < distance:
        size = float(random.uniform(1.5, 2.5)) * unit
        low = (0.0, 0.06 * unit, z + 0.5 * size)
        high = (0.0, low[1] + float(random.uniform(0.05, 0.25)) * unit, low[2])
        pace = float(random.uniform(0.05, 0.2)) * speed
        plate = Obstacle("box", (4.0 * unit, 0.12 * unit, size), low, path=(high,), speed=pace)
        made.append(plate)
        z += size + float(random.uniform(0.0, 0.3)) * unit
    return Environment(None, made)


def turning(morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return platforms that turn as they rise and fall, and crates that turn as they go."""
    unit, speed = leg_length(morphology), default_speed(morphology)
    random = np.random.default_rng(seed)
    # At its rim a platform is about as fast as the crates.
    made = [
        dataclasses.replace(plate, turn_rate=float(random.uniform(-0.3, 0.3)) * speed / unit)
        for plate in platforms(morphology, distance, seed).obstacles
    ]
    for crate in moving_crates(morphology, distance, seed).obstacles[::4]:
        rate = float(random.uniform(-1.0, 1.0)) * speed / unit
        made.append(dataclasses.replace(crate, turn_rate=rate))
    return Environment(None, made)


def make_place(place: str, morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return one of the places."""
    if place == "platforms":
        return platforms(morphology, distance, seed)
    if place == "turning":
        return turning(morphology, distance, seed)
    if place == "crates":
        return moving_crates(morphology, distance, seed)
    first = front(morphology) + 0.5 * leg_length(morphology)
    still = crates(morphology, first, distance, seed, 0.0)[:CRATES]
    return Environment(None, still, movable=True)


def walk(
    morphology: Morphology, place: str, seed: int, seconds: float, fps: float
) -> tuple[Recording, Environment]:
    """Return a walk and where it was walked."""
    speed = default_speed(morphology)
    environment = make_place(place, morphology, speed * seconds, seed)
    world = World(environment, threads=1)
    herd = world.add(morphology, speed=speed, position=[0.0, 0.0])
    careless = Careless(environment, 0.5 * speed, seed) if place == "careless" else None
    recorder = Recorder(morphology, len(environment.obstacles))
    add_frame(recorder, world, herd, 0)
    for frame in range(1, round(seconds * fps) + 1):
        if careless is not None:
            careless.step(world.time, 1.0 / fps)
        world.step(1.0 / fps)
        world.time = frame / fps
        add_frame(recorder, world, herd, 0)
    return recorder.finish(), environment


def judge(recording: Recording, environment: Environment, speed: float) -> Soaked:
    """Measure a walk against the shapes themselves."""
    ground = Ground(environment.table, recording)
    foot, leg = recording.foot_position, recording.morphology.legs.length
    depth = []
    for part in range(SUBFRAMES):
        share = part / SUBFRAMES
        place = foot[:-1] + (foot[1:] - foot[:-1]) * share
        frame = np.repeat(np.arange(len(place)) + share, len(leg))
        inside = ground.penetration(place.reshape(-1, 3), frame)
        depth.append(inside.reshape(len(place), len(leg)) / leg)
    stance = recording.foot_stance
    standing, row = foot[stance], np.nonzero(stance)[0]
    off = np.abs(standing[:, 1] - ground.surface(standing[:, 0], standing[:, 2], row))
    residual = np.linalg.norm(foot - recording.foot_target, axis=2) / leg
    body = recording.body_position[:, [0, 2]]
    pace = np.linalg.norm(np.diff(body, axis=0), axis=1) / np.diff(recording.time)
    halt = longest = 0.0
    for slow, step in zip(pace < 0.05 * speed, np.diff(recording.time), strict=True):
        halt = halt + float(step) if slow else 0.0
        longest = max(longest, halt)
    return Soaked(
        float(np.max(depth)),
        float(np.mean(np.array(depth) > LIMITS["inside"])),
        max(slip_per_stance(recording, foot), default=0.0),
        float((off / np.broadcast_to(leg, stance.shape)[stance]).max()),
        float(residual.max()),
        float(np.linalg.norm(body[-1] - body[0]) / (speed * recording.time[-1])),
        longest,
    )


def main() -> int:
    """Walk, print a table, and say whether all limits are kept."""
    names = [rig.name for rig in RIGS]
    every = [*names, *(name for name in NAMES if name not in names)]
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--rigs", nargs="+", default=names, choices=every, metavar="RIG")
    parser.add_argument("--places", nargs="+", default=PLACES, choices=PLACES, metavar="PLACE")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--fps", type=float, default=30.0)
    parser.add_argument("--seeds", type=int, default=3)
    given = parser.parse_args()
    print("in % of leg length; distance as a share, halt in s")
    print(f"{'rig':<11}{'place':<10}{'seed':>4}{'inside':>9}{'beyond':>10}{'slip':>8}{'off':>8}"
          f"{'residual':>10}{'distance':>10}{'halt':>6}")  # fmt: skip
    kept = total = 0
    for name in given.rigs:
        morphology = load(next((rig for rig in RIGS if rig.name == name), Rig(name)))
        if morphology is None:
            print(f"{name:<11}its file is not here")
            continue
        for place in given.places:
            for seed in range(1, given.seeds + 1):
                recording, environment = walk(morphology, place, seed, given.seconds, given.fps)
                result = judge(recording, environment, default_speed(morphology))
                broken = result.broken()
                total += 1
                kept += not broken
                print(
                    f"{name:<11}{place:<10}{seed:>4}{100 * result.inside:>9.3f}"
                    f"{result.beyond:>10.6f}{100 * result.slip:>8.4f}{100 * result.off:>8.4f}"
                    f"{100 * result.residual:>10.3f}{result.distance:>10.3f}{result.halt:>6.1f}"
                    f"{'  BREAKS ' + ', '.join(broken) if broken else ''}",
                    flush=True,
                )
    print(f"{kept} of {total} walks keep every limit")
    return 0 if kept == total else 1


if __name__ == "__main__":
    sys.exit(main())
