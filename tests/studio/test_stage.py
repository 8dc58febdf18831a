"""A stage walks what its document asks for, and takes each change while it walks."""

from __future__ import annotations

import numpy as np
import pytest

from polypod.errors import PolypodError, SettingError
from polypod.gait.library import make_gait
from polypod.studio.asked import disks_of
from polypod.studio.document import Document, default_document, edited
from polypod.studio.stage import Stage

DT = 1.0 / 60.0
CRATE = {"shape": "box", "size": [0.6, 0.08, 0.4], "position": [0.0, 0.04, 1.0]}


def find(name: str) -> str:
    return name


def stage_of(**changes: object) -> Stage:
    document = default_document()
    for key, value in changes.items():
        document[key] = value
    return Stage(document, find)


def change(stage: Stage, *at: str | int, to: object) -> Document:
    document = edited(stage.document, list(at), to)
    stage.apply(document)
    return document


def walk(stage: Stage, seconds: float) -> None:
    for _ in range(round(seconds / DT)):
        stage.step(DT)


def test_speed_and_heading_change_while_it_walks() -> None:
    stage = stage_of()
    walk(stage, 1.0)
    change(stage, "command", "speed", to=0.8)
    walk(stage, 1.5)
    assert stage.herd.state.speed[0] == pytest.approx(0.8, abs=0.02)
    change(stage, "command", "heading", to=1.0)
    walk(stage, 3.0)
    assert stage.herd.state.heading[0] == pytest.approx(1.0, abs=0.05)


def test_a_foots_sector_drawn_anew_is_the_foots_duty_in_the_walk() -> None:
    stage = stage_of()
    walk(stage, 1.0)
    state = stage.herd.state
    start, extent = state.swing_start[0].tolist(), state.swing_extent[0].tolist()
    extent[2] = 0.5 * extent[2]
    gait = {"name": "edited", "start": start, "extent": extent}
    change(stage, "gait", to=gait)
    walk(stage, 4.0)
    assert state.swing_extent[0, 2] == pytest.approx(extent[2], abs=0.02)
    down = []
    for _ in range(240):
        stage.step(DT)
        down.append(~state.swinging[0])
    measured = np.mean(down, axis=0)
    assert measured[2] == pytest.approx(1.0 - extent[2], abs=0.06)
    assert measured[2] > measured[3] + 0.05
    # And back to what follows the speed.
    change(stage, "gait", to=None)
    walk(stage, 3.0)
    assert stage.herd.gait_name == ("spider",)


def needle_jump(stage: Stage) -> float:
    """Take a step; return by how much more the needle went than by the tempo, cycles."""
    before = float(stage.herd.state.needle[0])
    stage.step(DT)
    state = stage.herd.state
    turned = float(state.needle[0]) - before - float(state.cycle_rate[0]) * DT
    return abs((turned + 0.5) % 1.0 - 0.5)


def test_a_sector_dragged_far_moves_nothing_else_on_the_wheels() -> None:
    stage = stage_of()
    walk(stage, 2.0)
    state = stage.herd.state
    start, extent = state.swing_start[0].copy(), state.swing_extent[0].copy()
    for far in (0.2, 0.45, -0.3):
        drawn = start.copy()
        drawn[3] = (start[3] + far) % 1.0
        gait = {"name": "edited", "start": drawn.tolist(), "extent": extent.tolist()}
        change(stage, "gait", to=gait)
        assert max(needle_jump(stage) for _ in range(180)) < 1e-9
        others = [foot for foot in range(len(start)) if foot != 3]
        assert state.swing_start[0, others] == pytest.approx(start[others], abs=2e-3)
        assert state.swing_start[0, 3] == pytest.approx(drawn[3], abs=2e-3)
    # Undone, it goes the same way back; and later gaits are brought near again.
    change(stage, "gait", to=None)
    assert max(needle_jump(stage) for _ in range(180)) < 1e-9
    legs = stage.herd.tables.legs
    change(stage, "gait", to=disks_of(make_gait("millipede", legs.side, legs.row)))
    assert needle_jump(stage) > 1.0 / 64.0 - 1e-9


def test_a_crate_is_stepped_on_moved_and_taken_away_under_its_feet() -> None:
    stage = stage_of(obstacle=[CRATE])
    stood = False
    for frame in range(420):
        stage.step(DT)
        state = stage.herd.state
        stood = stood or bool((state.foot_support[0] == 0).any())
        if stood and frame > 200 and len(stage.document["obstacle"]) == 1:
            change(stage, "obstacle", 0, to=None)
    assert stood
    assert stage.document["obstacle"] == []
    assert (state.foot_support[0] == -1).all()
    standing = ~state.swinging[0]
    assert np.abs(state.foot[0, standing, 1]).max() < 1e-6, "no foot stands where the crate was"
    assert state.position[0, 2] > 1.0


def test_adding_a_crate_leaves_the_others_numbers_and_the_walk_as_they_are() -> None:
    stage = stage_of(obstacle=[CRATE])
    walk(stage, 1.0)
    before = stage.herd.state.position[0].copy()
    change(stage, "obstacle", 1, to={**CRATE, "position": [0.0, 0.04, 3.0], "forbidden": True})
    assert len(stage.world.environment.obstacles) == 2
    assert np.array_equal(stage.herd.state.position[0], before)
    walk(stage, 1.0)
    # Moved, it is where it was put, with its turn.
    change(stage, "obstacle", 1, "position", to=[1.0, 0.04, 3.0])
    change(stage, "obstacle", 1, "yaw", to=0.5)
    walk(stage, 0.1)
    poses = stage.obstacle_poses()
    assert poses[1, 4:] == pytest.approx([1.0, 0.04, 3.0])
    assert 2.0 * np.arctan2(poses[1, 1], poses[1, 3]) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("at", "to"),
    [
        (["command", "speed"], 50.0),
        (["gait"], {"name": "edited", "start": [0.0, 0.5], "extent": [0.3, 0.3]}),
        (["spacing"], [[0.0, 0.0]]),
        (["creature", "rig"], "no-such-rig.glb"),
        (["terrain"], {"given": "nowhere"}),
    ],
)
def test_what_cannot_be_walked_leaves_the_stage_as_it_was(at: list[str], to: object) -> None:
    stage = stage_of()
    walk(stage, 0.2)
    before, world = stage.document, stage.world
    with pytest.raises(PolypodError):
        stage.apply(edited(before, at, to))
    assert stage.document is before
    assert stage.world is world
    walk(stage, 0.2)


def test_spacing_and_stance_width_move_the_feet() -> None:
    stage = stage_of()
    legs = stage.herd.morphology.legs
    change(stage, "command", "stance_width", to=1.2)
    walk(stage, 3.0)
    wide = 0.2 * legs.sole_stance[:, 0]
    assert stage.herd.state.spacing[0, :, 0] == pytest.approx(wide, abs=1e-3)


def test_another_creature_and_a_crowd_stand_and_stroll() -> None:
    stage = stage_of()
    applied = stage.apply(edited(stage.document, ["crowd"], [{"rig": "ant", "count": 5}]))
    assert applied.creature
    assert [herd.count for herd in stage.herds] == [1, 5]
    begun = stage.herds[1].state.position.copy()
    walk(stage, 3.0)
    gone = np.linalg.norm(stage.herds[1].state.position - begun, axis=1)
    assert (gone > 0.2).all()


def test_a_crowd_is_as_large_as_it_is_asked_for() -> None:
    stage = stage_of()
    kinds = [{"rig": "wolf", "height": 0.4, "count": 2}, {"rig": "wolf", "count": 1}]
    stage.apply(edited(stage.document, ["crowd"], kinds))
    small, own = (herd.tables.leg_length for herd in stage.herds[1:])
    assert small < 0.6 * own


def test_on_another_ground_it_goes_on_from_where_it_is() -> None:
    stage = stage_of()
    walk(stage, 2.0)
    place = stage.herd.state.position[0, [0, 2]].copy()
    change(stage, "terrain", to={"generator": "hills", "relief": 0.2, "wavelength": 2.0})
    assert stage.herd.state.position[0, [0, 2]] == pytest.approx(place)
    stage.restart()
    assert np.hypot(*stage.herd.state.position[0, [0, 2]]) < 0.2


def test_pushes_are_judged() -> None:
    stage = stage_of()
    stage.push(0, [1.0, 0.0, 0.0], 0.0)
    walk(stage, 0.3)
    assert stage.herd.state.position[0, 0] > 0.02
    with pytest.raises(SettingError, match="no creature 4"):
        stage.push(4, [1.0, 0.0, 0.0], 0.0)
    with pytest.raises(SettingError, match="a push's velocity"):
        stage.push(0, [1e6, 0.0, 0.0], 0.0)


def test_who_lets_go_of_a_gait_is_judged_by_the_one_that_its_speed_asks_for() -> None:
    stage = stage_of()
    walk(stage, 0.5)
    followed = stage.question().gait.name
    gait = stage.question().gait
    start, extent = gait.swing_start.tolist(), gait.swing_extent.tolist()
    drawn = {"name": "edited", "start": start, "extent": extent}
    change(stage, "gait", to=drawn)
    assert stage.question().gait.name == "edited"
    change(stage, "gait", to=None)
    assert stage.question().gait.name == followed
