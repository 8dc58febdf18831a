"""Walks creatures for long where it is hard to walk, and measures them against the true geometry.

    python benchmarks/soak.py --rigs spider wolf --places crates trenches --seeds 3

Of 40 `crates` that go to and fro at up to half of the walker's speed, `platforms` that rise and
fall under its way, and `careless` crates that change their course every half second without
warning; a third of 45 crates `forbidden`; a `corridor` of forbidden posts; `stairs` with landings;
`trenches`; `rubble` of random hulls. One row a walk: how deep a foot is inside anything at worst,
at four moments between frames too, and in what share of them beyond 1 % of its leg; slip in the
frame of what is stood on; distance to the surface; residual; in what share of frames two legs
touch; share of the commanded distance; longest halt. Exit code 1 where a walk breaks a limit.
"""

from __future__ import annotations

import argparse
import sys
from typing import NamedTuple

import numpy as np
from acceptance import load
from places import RIGS, Rig, default_speed
from soak_places import PLACES, Careless, make_place

from polypod.environment.environment import Environment
from polypod.morphology.builtin import NAMES
from polypod.morphology.types import Morphology
from polypod.recording import add_frame
from polypod.report.apart import leg_room
from polypod.report.ground import Ground
from polypod.report.record import Recorder, Recording
from polypod.report.stances import slip_per_stance
from polypod.world import World

SUBFRAMES = 4
# Shares of leg lengths, of frames, and seconds; nothing that is no number keeps a limit.
LIMITS = {
    "inside": 0.01, "slip": 1e-3, "off": 2e-3, "residual": 0.01, "touching": 1e-2, "halt": 3.0,
}  # fmt: skip
# Of the frames of all walks together, the share in which two legs may touch.
TOUCHING = 1e-3
# Least share of the commanded distance.
LEAST = {"forbidden": 0.8}


class Soaked(NamedTuple):
    """The worst of a walk; lengths in leg lengths."""

    inside: float
    beyond: float  # share of moments in which a foot is inside by more than the limit
    slip: float
    off: float
    residual: float
    touching: float  # share of frames in which two legs touch
    distance: float  # share of what was commanded
    halt: float  # s

    def broken(self, place: str) -> list[str]:
        """Return the limits that are broken at a place."""
        broken = [name for name, limit in LIMITS.items() if not getattr(self, name) <= limit]
        return broken + (["distance"] if not self.distance >= LEAST.get(place, 0.0) else [])


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
        float(np.mean(leg_room(recording).of_leg < 0.0)),
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
          f"{'residual':>10}{'touching':>10}{'distance':>10}{'halt':>6}")  # fmt: skip
    kept = total = 0
    touching = 0.0
    for name in given.rigs:
        morphology = load(next((rig for rig in RIGS if rig.name == name), Rig(name)))
        if morphology is None:
            print(f"{name:<11}its file is not here")
            continue
        for place in given.places:
            for seed in range(1, given.seeds + 1):
                recording, environment = walk(morphology, place, seed, given.seconds, given.fps)
                result = judge(recording, environment, default_speed(morphology))
                broken = result.broken(place)
                total += 1
                kept += not broken
                touching += result.touching
                print(
                    f"{name:<11}{place:<10}{seed:>4}{100 * result.inside:>9.3f}"
                    f"{result.beyond:>10.6f}{100 * result.slip:>8.4f}{100 * result.off:>8.4f}"
                    f"{100 * result.residual:>10.3f}{result.touching:>10.5f}"
                    f"{result.distance:>10.3f}{result.halt:>6.1f}"
                    f"{'  BREAKS ' + ', '.join(broken) if broken else ''}",
                    flush=True,
                )
    print(f"{kept} of {total} walks keep every limit")
    print(f"two legs touch in {touching / max(total, 1):.5f} of all frames, at most {TOUCHING}")
    return 0 if kept == total and touching <= TOUCHING * total else 1


if __name__ == "__main__":
    sys.exit(main())
