"""The creatures and places of the acceptance walks, all scaled to the creature."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.scattering import scatter
from polypod.environment.terrain import Terrain
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology

GRAVITY = 9.81
RIGS_FOLDER = Path(os.environ.get("POLYPOD_RIGS", Path(__file__).parents[2] / "shared" / "rigs"))


class Rig(NamedTuple):
    """A creature to walk: a built-in, or a file of the third-party rigs with its height."""

    name: str
    file: str = ""
    height: float | None = None  # m


RIGS = (
    Rig("spider"),
    Rig("ant"),
    Rig("pentapod"),
    Rig("wolf"),
    Rig("biped"),
    Rig("q-spider", "quaternius/spider.glb", 0.5),
    Rig("fox", "khronos_fox/Fox.glb", 0.6),
    Rig("horse", "quaternius/horse.glb", 1.8),
    Rig("spider-bot", "spider_bot/spider_bot_model.gltf", 1.5),
    Rig("mech", "quaternius/mech_george.glb", 3.0),
)
# Those with long backs beside wolf, fox and horse.
LONG_BACKED = (
    Rig("lizard"),
    Rig("centaur"),
    Rig("centipede"),
    Rig("triceratops", "quaternius/triceratops.glb", 2.5),
)
# Places whose only random numbers are none: one seed says all.
UNSEEDED = ("flat", "stairs", "slope")
PLACES = ("flat", "hills", "stairs", "slope", "crates", "forbidden")
# Least share of speed x time that must be walked. None is asked for on stairs; a walk that stops
# before them would pass everything else, so the crates' share is taken.
LEAST_SHARE = {
    "flat": 0.95,
    "hills": 0.95,
    "stairs": 0.90,
    "slope": 0.95,
    "crates": 0.90,
    "forbidden": 0.50,
}
CRATES = 45


def load(rig: Rig) -> Morphology | None:
    """Return the morphology of a rig, or None where its file is not here."""
    if not rig.file:
        return load_rig(rig.name)
    path = RIGS_FOLDER / rig.file
    return load_rig(path, height=rig.height) if path.is_file() else None


def leg_length(morphology: Morphology) -> float:
    """Return the mean leg length, m."""
    return float(morphology.legs.length.mean())


def hip_height(morphology: Morphology) -> float:
    """Return the mean height of the hips over the soles in stance, m."""
    legs = morphology.legs
    return float(np.mean(legs.point_rest[:, 0, 1] - legs.sole_stance[:, 1]))


def default_speed(morphology: Morphology) -> float:
    """Return a brisk walk, m/s: Froude number 0.2 if upright, else v^2 / (g L) = 1/16."""
    if float(morphology.legs.upright.mean()) > 0.5:
        return 0.45 * math.sqrt(GRAVITY * hip_height(morphology))
    return 0.25 * math.sqrt(GRAVITY * leg_length(morphology))


def make_place(place: str, morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return a place in whose way a creature from the origin along +z has `distance` m to walk."""
    unit = leg_length(morphology)
    if place == "flat":
        return Environment()
    if place == "hills":
        size = 2.0 * distance + 20.0 * unit
        wavelength = max(8.0 * unit, size / 200.0)
        return Environment(Terrain.hills(seed=seed, relief=unit, wavelength=wavelength, size=size))
    first = front(morphology) + 0.5 * unit
    if place == "slope":
        length = distance + 10.0 * unit
        return Environment(Terrain.slope(math.radians(20.0), length=length, start=first))
    if place == "stairs":
        # Up, over a landing, and down again before the walk ends.
        landing = 3.0 * unit
        room = 0.9 * distance - first - landing
        count = max(3, math.floor(room / unit))
        return Environment(
            Terrain.stairs(
                rise=0.15 * unit,
                run=0.5 * unit,
                count=count,
                width=12.0 * unit,
                start=first,
                landing=landing,
                down=True,
            )
        )
    if place in ("crates", "forbidden"):
        share = 1.0 / 3.0 if place == "forbidden" else 0.0
        return Environment(obstacles=crates(morphology, first, distance, seed, share))
    raise ValueError(f"no place {place}; choose from {PLACES}")


def front(morphology: Morphology) -> float:
    """Return how far ahead of its centre a standing creature's feet are, m."""
    return float(morphology.legs.sole_stance[:, 2].max())


def crates(
    morphology: Morphology, first: float, distance: float, seed: int, forbidden: float
) -> tuple[Obstacle, ...]:
    """Return 45 crates, up to a third of the legs' height, over all of the walked strip."""
    unit, top = leg_length(morphology), hip_height(morphology) / 3.0
    beside = float(np.abs(morphology.legs.sole_stance[:, 0]).max()) + 0.4 * unit
    area = (-beside, first + 0.3 * unit, beside, max(distance, first + 2.0 * unit))
    size = ((0.16 * unit, 0.25 * top, 0.16 * unit), (0.6 * unit, top, 0.6 * unit))
    return scatter(Terrain.flat(), CRATES, area, size, seed, forbidden)
