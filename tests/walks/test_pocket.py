"""Pockets among what is forbidden: who keeps a heading finds out of them and past them."""

from __future__ import annotations

import numpy as np
from places import default_speed, front, hip_height, leg_length

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.math.segments import segment_gap
from polypod.math.vec3 import Vec3
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.world import World

FPS = 30.0


def pocket(morphology: Morphology) -> tuple[list[Obstacle], float]:
    """Return forbidden posts on three sides of the way along +z, and where the last side is, m."""
    unit, height = leg_length(morphology), 0.5 * hip_height(morphology)
    near = front(morphology) + 1.5 * unit
    far = near + 1.5 * unit
    places = [(x, far) for x in np.arange(-2.0, 2.01, 0.25) * unit]
    places += [
        (2.0 * side * unit, z) for side in (-1, 1) for z in np.arange(near, far, 0.25 * unit)
    ]
    posts = [
        Obstacle.cylinder(0.1 * unit, height, (float(x), 0.5 * height, float(z)), forbidden=True)
        for x, z in places
    ]
    return posts, far


def test_a_pocket_in_the_way_is_left_and_passed() -> None:
    morphology = load_rig("wolf")
    posts, far = pocket(morphology)
    world = World(Environment(None, posts), threads=1)
    herd = world.add(morphology, speed=default_speed(morphology), position=[0.0, 0.0])
    state = herd.state
    went_aside = 0.0
    post = np.array([[obstacle.position[0], 0.0, obstacle.position[2]] for obstacle in posts])
    radius = 0.05 * leg_length(morphology)
    for _ in range(round(70.0 * FPS)):
        before = state.foot[0].copy()
        world.step(1.0 / FPS)
        went_aside = max(went_aside, abs(float(state.shy[0])))
        for k in range(len(before)):
            # What is played of the frame is a straight way: it leads round every post.
            ends = [Vec3(float(p[0]), 0.0, float(p[2])) for p in (before[k], state.foot[0, k])]
            near = post[np.abs(post - before[k] * [1, 0, 1]).max(axis=1) < 10.0 * radius]
            for x, y, z in near:
                at = Vec3(float(x), float(y), float(z))
                assert segment_gap(*ends, at, at) > 0.9 * radius
    assert went_aside > 0.5
    assert state.position[0, 2] > far + 2.0 * leg_length(morphology)


def test_where_nothing_is_forbidden_nobody_goes_aside() -> None:
    morphology = load_rig("spider")
    high = Obstacle.box((10.0, 3.0, 0.5), (0.0, 1.5, 1.5))
    world = World(Environment(None, [high]), threads=1)
    herd = world.add(morphology, speed=default_speed(morphology), position=[0.0, 0.0])
    for _ in range(round(12.0 * FPS)):
        world.step(1.0 / FPS)
    assert herd.state.shy[0] == 0.0
    assert herd.state.halts[0] > 0
    assert herd.state.position[0, 2] < 1.5
