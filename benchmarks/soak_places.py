"""The places of the soak: things that move, and hard ground; all scaled to the creature."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from numpy.typing import NDArray
from places import crates, default_speed, front, hip_height, leg_length

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.terrain import Terrain
from polypod.morphology.types import Morphology

PLACES = (
    "crates",
    "platforms",
    "careless",
    "forbidden",
    "corridor",
    "stairs",
    "trenches",
    "rubble",
)
CRATES = 40
FORBIDDEN_CRATES = 45
COURSE_SECONDS = 0.5  # after which careless crates change their course
STEPS = 5  # of each flight of stairs


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


def outermost(morphology: Morphology) -> float:
    """Return how far beside its centre a standing creature's feet are, m."""
    return float(np.abs(morphology.legs.sole_stance[:, 0]).max())


def corridor(morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return a corridor between two rows of forbidden posts, with posts in its middle too."""
    unit = leg_length(morphology)
    random = np.random.default_rng(seed)
    height, side = 0.5 * hip_height(morphology), outermost(morphology) + 0.5 * unit
    made = []
    first = front(morphology) + 0.8 * unit
    for z in np.arange(first, distance + 2.0 * unit, 0.8 * unit):
        for x in (-side, side):
            made.append((float(x), float(z)))
    z = first + unit
    while z < distance:
        made.append((float(random.uniform(-0.7, 0.7)) * side, float(z)))
        z += float(random.uniform(1.5, 3.0)) * unit
    return Environment(
        None,
        [
            Obstacle.cylinder(0.08 * unit, height, (x, 0.5 * height, z), forbidden=True)
            for x, z in made
        ],
    )


def staircase(morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return flights of stairs up and down again, with landings between them."""
    unit = leg_length(morphology)
    random = np.random.default_rng(seed)
    rise, run = 0.12 * unit, 0.5 * unit
    made: list[Obstacle] = []
    z, level = front(morphology) + 0.5 * unit, 0
    while z < distance:
        up = level == 0 or (level < 3 * STEPS and bool(random.integers(0, 2)))
        for _ in range(STEPS):
            level += 1 if up else -1
            made.append(tread(level, rise, z, run, unit))
            z += run
        landing = float(random.uniform(1.0, 3.0)) * unit
        made.append(tread(level, rise, z, landing, unit))
        z += landing
    made.append(tread(level, rise, z, 20.0 * unit, unit))
    return Environment(None, [part for part in made if part.size[1] > 0.1 * rise])


def tread(level: int, rise: float, start: float, length: float, unit: float) -> Obstacle:
    """Return a tread that is solid down to a step below the ground."""
    height = (level + 1) * rise
    return Obstacle.box(
        (12.0 * unit, height, length), (0.0, 0.5 * height - rise, start + 0.5 * length)
    )


def trenches(morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return ground cut by trenches of up to a quarter of a leg's length."""
    unit = leg_length(morphology)
    start = front(morphology) + 0.6 * unit
    return Environment(
        Terrain.trenches(
            seed=seed,
            narrowest=0.05 * unit,
            widest=0.25 * unit,
            apart=1.2 * unit,
            depth=1.5 * unit,
            count=max(2, math.floor((distance - start) / unit)),
            width=30.0 * unit,
            start=start,
        )
    )


def rubble(morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return stones of all shapes: hulls of random points, half sunk in, at any rotation."""
    unit, top = leg_length(morphology), hip_height(morphology) / 3.0
    random = np.random.default_rng(seed)
    beside, first = outermost(morphology) + 0.4 * unit, front(morphology) + 0.7 * unit
    count = round(3.0 * beside * (distance - first) / (unit * unit))
    made = []
    for _ in range(count):
        points = random.normal(size=(12, 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        half: NDArray[np.float64] = random.uniform((0.1, 0.5, 0.1), (0.35, 1.0, 0.35))
        points *= half * np.array([unit, top, unit])
        turn = from_random(random)
        low = float(turned(points, turn)[:, 1].min())
        rise = float(turned(points, turn)[:, 1].max())
        x, z = random.uniform((-beside, first), (beside, distance))
        # No stone stands higher than a crate would, however it came to lie.
        y = float(random.uniform(0.2, 1.0)) * min(top, rise - low) - rise
        made.append(Obstacle.hull(points, (float(x), y, float(z)), turn))
    return Environment(None, made)


def from_random(random: np.random.Generator) -> NDArray[np.float64]:
    """Return a rotation, all alike likely."""
    turn = random.normal(size=4)
    rotation: NDArray[np.float64] = turn / np.linalg.norm(turn)
    return rotation


def turned(points: NDArray[np.float64], turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points [N, 3] turned by a quaternion."""
    axis, scalar = turn[:3], turn[3]
    twice = 2.0 * np.cross(axis, points)
    result: NDArray[np.float64] = points + scalar * twice + np.cross(axis, twice)
    return result


STILL = {
    "corridor": corridor,
    "stairs": staircase,
    "trenches": trenches,
    "rubble": rubble,
}


def make_place(place: str, morphology: Morphology, distance: float, seed: int) -> Environment:
    """Return one of the places."""
    if place in STILL:
        return STILL[place](morphology, distance, seed)
    if place == "forbidden":
        begin = front(morphology) + 0.5 * leg_length(morphology)
        return Environment(None, crates(morphology, begin, distance, seed, 1.0 / 3.0))
    if place == "platforms":
        return platforms(morphology, distance, seed)
    if place == "crates":
        return moving_crates(morphology, distance, seed)
    first = front(morphology) + 0.5 * leg_length(morphology)
    still = crates(morphology, first, distance, seed, 0.0)[:CRATES]
    return Environment(None, still, movable=True)
