"""Steps keep whole legs apart, as they will be posed."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from polypod.environment.environment import Environment
from polypod.environment.scattering import scatter
from polypod.environment.terrain import Terrain
from polypod.math.quat import from_heading, rotate, store_quat
from polypod.math.vec3 import Vec3, load_vec3, store_vec3
from polypod.morphology.load import load_rig
from polypod.paths.apart import MOMENTS, ROOM, TOUCHING, make_legs_ahead, place_factor
from polypod.recording import add_frame
from polypod.report.apart import leg_room
from polypod.report.record import Recorder
from polypod.world import World

from polypod.ik.table import build_ik_table  # isort: skip
from stepping import ask  # isort: skip

SPIDER = load_rig("spider")
IK = build_ik_table(SPIDER.legs)


def standing(heading=0.0):
    """Return the spider as it stands at every moment, and the row of a leg beside leg 3."""
    legs = SPIDER.legs
    ahead = make_legs_ahead(IK, legs.section_radius, legs.foot_joint)
    turn = from_heading(heading)
    ahead.own[0], ahead.leg[0], ahead.others[0] = 3, 5, 1
    for moment in range(len(MOMENTS)):
        for leg in (3, 5):
            store_vec3(ahead.position[moment, leg], Vec3(1.0, 2.0, 3.0))
            store_quat(ahead.rotation[moment, leg], turn)
        sole = Vec3(1.0, 2.0, 3.0) + rotate(turn, load_vec3(legs.sole_stance[5]))
        store_vec3(ahead.sole[moment, 0], sole)
        store_vec3(ahead.effector[moment, 0], sole)
        ahead.posed[moment, 0] = False
    return ahead, turn


def factor(share, heading=0.0):
    """Return the worth of a place from the leg's own stance (0) to the other's (1)."""
    ahead, turn = standing(heading)
    own, other = (load_vec3(SPIDER.legs.sole_stance[k]) for k in (3, 5))
    place = Vec3(1.0, 2.0, 3.0) + rotate(turn, own + (other - own) * share)
    length = float(SPIDER.legs.length[3])
    env = Environment().kernel_table
    request = ask(env, place, place)._replace(leg_length=length)
    return place_factor(ahead, request, place)


def test_a_place_is_worth_less_the_nearer_the_legs_come():
    assert factor(0.0) == 1.0
    worth = [factor(share) for share in np.linspace(0.0, 1.0, 41)]
    assert all(b <= a + 1e-12 for a, b in pairwise(worth))
    assert worth[-1] < 0.5 * TOUCHING
    assert all(0.0 < value <= 1.0 for value in worth)
    assert any(TOUCHING < value < 1.0 for value in worth)


@pytest.mark.parametrize("heading", [0.7, 2.0, -2.9])
def test_what_it_is_worth_does_not_depend_on_the_heading(heading):
    for share in (0.3, 0.7, 0.9, 1.0):
        assert factor(share, heading) == pytest.approx(factor(share), abs=1e-9)


@pytest.mark.parametrize("rig", ["spider", "ant", "wolf"])
def test_legs_hardly_ever_touch_among_crates(rig):
    morphology = load_rig(rig)
    unit = float(morphology.legs.length.mean())
    area = (-1.2 * unit, 1.2 * unit, 1.2 * unit, 12.0 * unit)
    size = ((0.16 * unit, 0.05 * unit, 0.16 * unit), (0.6 * unit, 0.2 * unit, 0.6 * unit))
    world = World(Environment(obstacles=scatter(Terrain.flat(), 45, area, size, 3)), threads=1)
    herd = world.add(morphology, speed=0.25 * (9.81 * unit) ** 0.5, position=[0.0, 0.0])
    recorder = Recorder(morphology, 45)
    for _ in range(360):
        world.step(1.0 / 30.0)
        add_frame(recorder, world, herd, 0)
    room = leg_room(recorder.finish()).of_leg
    # A tenth of ROOM: what turns up otherwise than foreseen is not deep.
    assert np.quantile(room, 0.005) > -0.1 * ROOM
    assert room.min() > -1.5 * ROOM
