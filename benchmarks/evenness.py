"""How evenly bodies get on: what they lose of their speed where legs hold them back.

    python benchmarks/evenness.py --rigs wolf fox --places flat crates

Prints for walks over each place, at an ordinary speed and at twice that, and for changes of speed
on flat ground, the share of frames in which the body lost more than a quarter of its speed, and the
most that it lost in one. Third-party rigs are taken from the folder POLYPOD_RIGS, and left out
where they are not there.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator

import numpy as np
from places import PLACES, RIGS, UNSEEDED, Rig, default_speed, load, make_place
from tqdm import tqdm

from polypod.environment.environment import Environment
from polypod.gait.tempo import GRAVITY
from polypod.morphology.types import Morphology
from polypod.world import World

FPS = 60.0
SECONDS = 10.0
LOST = 0.25  # of the speed in a frame
# Speeds before and after a change, sqrt(g L), and how long it is watched.
CHANGES = ((0.3, 0.6), (0.3, 1.2), (0.6, 1.2), (0.6, 2.0), (1.2, 0.4), (0.0, 0.6), (2.0, 0.3))
CHANGE_SECONDS = 4.0
OTHERS = (Rig("lizard"), Rig("centaur"), Rig("centipede"))


class Walk:
    """A creature that walks from the origin, and what it lost in each frame."""

    def __init__(self, morphology: Morphology, place: Environment, speed: float) -> None:
        self.world = World(place, threads=1)
        self.herd = self.world.add(morphology, speed=speed)

    def losses(self, seconds: float, of_speed: float) -> Iterator[float]:
        """Walk on; yield for each frame by how much it got on less than steering said."""
        state = self.herd.state
        for _ in range(round(seconds * FPS)):
            place, before = state.position[0].copy(), float(state.speed[0])
            self.world.step(1.0 / FPS)
            way = state.position[0] - place
            asked = 0.5 * (before + float(state.speed[0]))
            yield (asked - FPS * math.hypot(way[0], way[2])) / of_speed


def over(morphology: Morphology, place: str, times: float, seeds: int) -> list[float]:
    """Return the losses in walks over a kind of place."""
    speed = times * default_speed(morphology)
    found: list[float] = []
    for seed in range(1, 1 + (1 if place in UNSEEDED else seeds)):
        ground = make_place(place, morphology, speed * SECONDS, seed)
        found += Walk(morphology, ground, speed).losses(SECONDS, speed)
    return found


def changing(morphology: Morphology) -> list[float]:
    """Return the losses while speeds are changed on flat ground, at eight moments of a stride."""
    unit = math.sqrt(GRAVITY * float(morphology.legs.length.mean()))
    found: list[float] = []
    for before, after in CHANGES:
        for moment in range(8):
            walk = Walk(morphology, Environment(), before * unit)
            for _ in range(120 + 7 * moment):
                walk.world.step(1.0 / FPS)
            walk.herd.command.speed = after * unit
            found += walk.losses(CHANGE_SECONDS, max(before, after) * unit)
    return found


def shown(losses: list[float]) -> str:
    """Return a cell: the share of frames with a loss, and the largest."""
    return f"{100.0 * float(np.mean(np.array(losses) > LOST)):6.2f} % {max(losses):5.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    known = {rig.name: rig for rig in (*RIGS, *OTHERS)}
    parser.add_argument("--rigs", nargs="+", choices=list(known), default=list(known))
    parser.add_argument("--places", nargs="+", choices=PLACES, default=["flat", "hills", "crates"])
    parser.add_argument("--seeds", type=int, default=2)
    asked = parser.parse_args()
    cases = [(place, times) for times in (1.0, 2.0) for place in asked.places]
    heads = [f"{place} x {times:g}" for place, times in cases] + ["changes"]
    print(f"share of frames in which {LOST:.0%} of the speed are lost, and the most lost")
    print(f"{'rig':12s}" + "".join(f"{head:>18s}" for head in heads))
    for name in tqdm(asked.rigs, leave=False, disable=None):
        rig = known[name]
        morphology = load(rig)
        if morphology is None:
            tqdm.write(f"{name:12s}  {rig.file} is not there")
            continue
        columns = [over(morphology, place, times, asked.seeds) for place, times in cases]
        columns.append(changing(morphology))
        tqdm.write(f"{name:12s}" + "".join(f"{shown(column):>18s}" for column in columns))


if __name__ == "__main__":
    main()
