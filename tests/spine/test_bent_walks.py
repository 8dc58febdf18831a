"""Whole walks of creatures whose spines bend: what must hold wherever they go."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from spines import FPS, brisk, go, off_the_track, turn_by

from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.environment.terrain import Terrain
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.report.arrays import rotate_all
from polypod.report.backbone import backbone_figures, joint_angles
from polypod.report.figures import measure

SPINED = ("wolf", "lizard", "centaur", "centipede")
# By strangers, and how high they stand, m.
SHARED = {
    "khronos_fox/Fox.glb": 0.6,
    "quaternius/horse.glb": 1.8,
    "quaternius/triceratops.glb": 2.0,
}


def circle(side: float) -> Callable[[float, Herd], None]:
    def steer(time: float, herd: Herd) -> None:
        if time > 0.5:
            herd.command.heading = herd.state.heading[0] + 0.8 * side

    return steer


def eight(time: float, herd: Herd) -> None:
    circle(1.0 if time < 3.0 else -1.0)(time, herd)


def pushed(time: float, herd: Herd) -> None:
    if abs(time - 1.0) < 0.5 / FPS:
        at = 0.8 * float(herd.morphology.body.half_size[2])
        herd.push([2.0 * brisk(herd.morphology), 0.0, 0.0], at=at)


def turn_back(time: float, herd: Herd) -> None:
    herd.command.heading = 0.0 if time < 1.0 else math.pi - 0.1


def stairs(morphology: Morphology) -> Environment:
    leg = float(morphology.legs.length.mean())
    return Environment(Terrain.stairs(rise=0.15 * leg, run=0.8 * leg, count=6, start=1.5 * leg))


def hills(morphology: Morphology) -> Environment:
    leg = float(morphology.legs.length.mean())
    return Environment(
        Terrain.hills(seed=4, relief=0.8 * leg, wavelength=7.0 * leg, size=60.0 * leg)
    )


WAYS = {
    "straight": (lambda time, herd: None, None, 4.0),
    "circle to the left": (circle(1.0), None, 4.0),
    "circle to the right": (circle(-1.0), None, 4.0),
    "figure of eight": (eight, None, 6.0),
    "back": (turn_back, None, 5.0),
    "stairs": (lambda time, herd: None, stairs, 5.0),
    "hills": (circle(0.8), hills, 5.0),
    "pushed": (pushed, None, 3.0),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", SPINED)
def test_what_holds_in_every_frame(name: str, way: str) -> None:
    keeps_what_holds(load_rig(name), way)


@pytest.mark.parametrize("way", ["figure of eight", "stairs", "pushed"])
@pytest.mark.parametrize("name", SHARED)
def test_what_holds_of_rigs_by_strangers(
    name: str, way: str, shared_rig: Callable[[str], Path]
) -> None:
    keeps_what_holds(load_rig(shared_rig(name), height=SHARED[name]), way)


def keeps_what_holds(morphology: Morphology, way: str) -> None:
    steer, place, seconds = WAYS[way]
    environment = place(morphology) if place is not None else None
    recording, world = go(morphology, seconds, steer, environment)
    figures = measure(recording, world.environment.table, joint_limits=True)
    assert figures["bone_variation"] < 1e-6
    assert figures["spine_limit_excess_deg"] < 1e-6
    assert figures["spine_twist_step_deg"] < 10.0
    assert figures["joint_limit_excess_deg"] < 1e-3
    assert figures["stance_slip_of_leg"] < 1e-3
    assert figures["stance_residual_of_leg"] < 1e-3
    # It does bend.
    if way not in ("straight", "stairs", "pushed"):
        assert (
            np.degrees(
                np.abs(joint_angles(recording)[:, : morphology.segments.neck - 1, 0])
                .sum(axis=1)
                .max()
            )
            > 15.0
        )


@pytest.mark.parametrize(
    ("name", "side"), [("wolf", 1.0), ("wolf", -1.0), ("lizard", 1.0), ("centaur", -1.0)]
)
def test_the_head_leads_and_the_back_follows_on_its_track(name: str, side: float) -> None:
    morphology = load_rig(name)
    turn = turn_by(0.5 * math.pi * side)
    bent, _ = go(morphology, 7.0, turn)
    rigid, _ = go(morphology, 5.0, turn, settings=Settings(spine=0.0))
    assert off_the_track(bent) < 0.10
    assert off_the_track(rigid) > 0.15
    # The head has turned by 20 degrees before the chest has, and that before the pelvis.
    spine = morphology.segments
    ahead = np.array([0.0, 0.0, 1.0])
    turned = [
        rotate_all(bent.joint_rotation[:, spine.joint[s]], ahead)
        for s in (spine.head, int(spine.of_girdle[-1]), 0)
    ]
    yaw = [np.arctan2(way[:, 0], way[:, 2]) * side for way in turned]
    first = [int(np.argmax(angle > math.radians(20.0))) for angle in yaw]
    assert 0 < first[0] < first[1] < first[2]
    # And the trunk is straight again in the end.
    trunk = np.degrees(joint_angles(bent)[-FPS:, : spine.neck - 1, 0].sum(axis=1))
    assert abs(trunk.mean()) < 4.0


@pytest.mark.parametrize("share", [0.6, 1.0])
def test_a_lizard_yaws_its_pelvis_as_lizards_do(share: float) -> None:
    """36 degrees in total, as a standing wave, concave where fore and hind foot come together."""
    morphology = load_rig("lizard")
    recording, _ = go(morphology, 5.0, speed=share * brisk(morphology))
    figures = backbone_figures(recording)
    assert figures["pelvis_yaw_deg"] == pytest.approx(36.0, rel=0.3)
    assert figures["spine_flexion_deg"] < 6.0
    spine = morphology.segments
    steady = slice(round(1.5 * FPS), None)
    trunk = joint_angles(recording)[steady, : spine.neck - 1, 0].sum(axis=1)
    # A chest yawed to the left of the pelvis is concave on the left.
    feet = recording.foot_position[steady]
    side = [
        np.linalg.norm(feet[:, fore] - feet[:, hind], axis=1) for hind, fore in ((0, 2), (1, 3))
    ]
    assert np.corrcoef(trunk, side[1] - side[0])[0, 1] > 0.7
    joints = joint_angles(recording)[steady, : spine.neck - 1, 0]
    lags = [np.corrcoef(joints[:, 0], joints[:, s])[0, 1] for s in range(joints.shape[1])]
    assert min(lags) > 0.5, "all of the trunk bends to one side at a time"


def test_effects_of_the_gait_are_scaled_to_nothing() -> None:
    morphology = load_rig("lizard")
    still = Settings(spine_yaw=0.0, spine_flexion=0.0)
    recording, _ = go(morphology, 4.0, settings=still)
    assert backbone_figures(recording)["pelvis_yaw_deg"] < 0.5
    rigid, _ = go(morphology, 4.0, circle(1.0), settings=Settings(spine=0.0))
    assert np.abs(joint_angles(rigid)).max() < 1e-12


@pytest.mark.parametrize(("gait", "speed"), [("bound", 4.0), ("transverse-gallop", 3.0)])
def test_a_gallop_flexes_with_the_hind_feet(gait: str, speed: float) -> None:
    """Most flexed about the hind feet's touchdown, most stretched after they have pushed off."""
    morphology = load_rig("wolf")
    recording, _ = go(morphology, 6.0, speed=speed, gait=gait)
    steady = slice(3 * FPS, None)
    flexion = -joint_angles(recording)[steady, : morphology.segments.neck - 1, 1].sum(axis=1)
    stance = recording.foot_stance[steady]
    hind = stance[:, 0] | stance[:, 1]
    down = np.flatnonzero(hind[1:] & ~hind[:-1]) + 1
    up = np.flatnonzero(~hind[1:] & hind[:-1]) + 1
    middle = 0.5 * (flexion.max() + flexion.min())
    assert np.median(flexion[down]) > middle + 0.2 * np.ptp(flexion)
    after = np.minimum(up + 1, len(flexion) - 1)
    assert np.median(flexion[after]) < middle - 0.2 * np.ptp(flexion)
    assert 15.0 < backbone_figures(recording)["spine_flexion_deg"] < 60.0


def test_a_trot_hardly_flexes() -> None:
    recording, _ = go(load_rig("wolf"), 4.0, speed=1.6, gait="trot")
    assert backbone_figures(recording)["spine_flexion_deg"] < 8.0


@pytest.mark.parametrize(("at", "sign"), [(0.7, 1.0), (-0.7, 1.0), (0.0, -1.0)])
def test_a_push_bends_the_spine_at_the_struck_girdle(at: float, sign: float) -> None:
    """A struck end goes with the push; of a struck middle both ends stay behind. Then it is over.

    A push to the left: the front's yaw against the pelvis is to the left where an end goes left.
    """
    morphology = load_rig("wolf")
    place = at * float(morphology.body.half_size[2])

    def hit(time: float, herd: Herd) -> None:
        if abs(time - 1.0) < 0.5 / FPS:
            herd.push([1.2, 0.0, 0.0], at=place)

    recording, _ = go(morphology, 6.0, hit, speed=0.0, settings=Settings(gaze=0.0))
    bend = np.degrees(joint_angles(recording)[:, : morphology.segments.neck - 1, 0].sum(axis=1))
    soon = bend[FPS : round(1.5 * FPS)]
    assert np.abs(bend[:FPS]).max() < 0.1
    assert 3.0 < sign * soon[np.abs(soon).argmax()] < 45.0
    assert abs(bend[-1]) < 1.0


@pytest.mark.parametrize(("side", "share", "seconds"), [(1.0, 1.0, 9.0), (-1.0, 0.5, 14.0)])
def test_a_long_body_goes_where_its_head_went(side: float, share: float, seconds: float) -> None:
    """A centipede's last legs follow its first; a rigid one of its length cuts the corner."""
    morphology = load_rig("centipede")
    turn = turn_by(0.5 * math.pi * side)
    speed = share * brisk(morphology)
    bent, world = go(morphology, seconds, turn, speed=speed)
    rigid, _ = go(morphology, seconds, turn, speed=speed, settings=Settings(spine=0.0))
    assert off_the_track(bent) < 0.06
    assert off_the_track(rigid) > 0.2
    # It comes round, its legs do not hold it up on the way, and none is dragged.
    (herd,) = world.herds
    assert herd.state.heading[0] * side == pytest.approx(0.5 * math.pi, abs=math.radians(3.0))
    way = np.linalg.norm(np.diff(bent.body_position[:, [0, 2]], axis=0), axis=1).sum()
    assert way > 0.93 * speed * seconds
    figures = measure(bent, world.environment.table, joint_limits=True)
    assert figures["stance_slip_of_leg"] < 1e-3
    assert figures["spine_limit_excess_deg"] < 1e-6
    assert figures["bone_variation"] < 1e-6


def test_a_long_body_turns_the_same_to_both_sides() -> None:
    morphology = load_rig("centipede")
    left, _ = go(morphology, 3.0, turn_by(1.0))
    right, _ = go(morphology, 3.0, turn_by(-1.0))
    mirrored = right.body_position * [-1.0, 1.0, 1.0]
    # In the first steps its gait has the left foot of a pair first, and so it sways.
    assert np.abs(left.body_position - mirrored).max() < 0.1 * float(morphology.legs.length.mean())


def test_a_long_body_that_stands_turns_on_the_spot() -> None:
    morphology = load_rig("centipede")
    walked, world = go(morphology, 6.0, turn_by(1.0), speed=0.0)
    (herd,) = world.herds
    assert herd.state.heading[0] == pytest.approx(1.0, abs=0.05)
    gone = np.linalg.norm(walked.body_position[-1] - walked.body_position[0])
    assert gone < float(morphology.legs.length.mean())
