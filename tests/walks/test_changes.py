"""Whatever is asked of a walking creature, and whenever: feet hold, joints reach, and it obeys."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from polypod.config import Settings
from polypod.environment.scattering import scatter
from polypod.environment.terrain import Terrain
from polypod.errors import GaitError, SettingError
from polypod.gait.library import make_gait
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.figures import measure
from polypod.report.record import Recording
from polypod.report.verdict import failures
from polypod.world import World

FPS = 30.0


@pytest.fixture
def world() -> World:
    return World(threads=1)


@pytest.fixture
def spider(world: World) -> Herd:
    return world.add(load_rig("spider"), speed=0.5)


def walk(world: World, seconds: float) -> Recording:
    return record_walk(world, seconds, FPS)[0]


def assert_sound(recording: Recording, world: World) -> dict[str, object]:
    """Hold a walk to all of the limits that every walk must keep."""
    figures = measure(recording, world.environment.table)
    assert failures(figures) == []
    return figures


def change_speed(herd: Herd) -> None:
    herd.command.speed = 0.15


def change_heading(herd: Herd) -> None:
    herd.command.heading = 2.0


def change_travel(herd: Herd) -> None:
    herd.command.travel = 0.5 * math.pi
    herd.command.speed = 0.25


def change_step_height(herd: Herd) -> None:
    herd.command.step_height = herd.command.step_height * 2.5


def change_body_height(herd: Herd) -> None:
    herd.command.body_height = herd.command.body_height * 0.7


def change_spacing(herd: Herd) -> None:
    side = herd.tables.legs.side
    herd.command.spacing = np.stack([0.05 * side, np.zeros(len(side))], axis=1)


def change_gait(herd: Herd) -> None:
    legs = herd.tables.legs
    herd.command.set_gait(make_gait("wave", legs.side, legs.row))


def change_period(herd: Herd) -> None:
    herd.command.period = 0.5


CHANGES = [
    change_speed,
    change_heading,
    change_travel,
    change_step_height,
    change_body_height,
    change_spacing,
    change_gait,
    change_period,
]


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
def test_a_change_while_walking_slips_no_foot(
    world: World, spider: Herd, change: Callable[[Herd], None]
) -> None:
    frames = [walk(world, 1.5)]
    change(spider)
    frames.append(walk(world, 4.0))
    for recording in frames:
        assert_sound(recording, world)
    # Across the change, too: no standing foot moved, no foot jumped.
    before, after = frames[0].foot_position[-1], frames[1].foot_position[0]
    assert np.array_equal(before, after)


@pytest.mark.parametrize("seed", range(3))
def test_any_changes_at_any_time(world: World, spider: Herd, seed: int) -> None:
    random = np.random.default_rng(seed)
    for _ in range(6):
        CHANGES[random.integers(len(CHANGES))](spider)
        spider.command.speed = float(random.uniform(0.0, 0.7))
        spider.command.heading = float(random.uniform(-3.0, 3.0))
        assert_sound(walk(world, float(random.uniform(0.2, 1.2))), world)


def test_it_takes_the_speed(world: World, spider: Herd) -> None:
    walk(world, 2.0)
    for speed in (0.2, 0.6, 0.4):
        spider.command.speed = speed
        walk(world, 2.0)
        recording = walk(world, 3.0)
        way = recording.body_position[-1] - recording.body_position[0]
        assert np.hypot(way[0], way[2]) / 3.0 == pytest.approx(speed, rel=0.05)


@pytest.mark.parametrize("angle", [-2.5, 0.8, 3.1])
def test_it_takes_the_heading(world: World, spider: Herd, angle: float) -> None:
    spider.command.heading = angle
    walk(world, 8.0)
    assert spider.state.heading[0] == pytest.approx(angle, abs=0.02)
    recording = walk(world, 2.0)
    way = recording.body_position[-1] - recording.body_position[0]
    assert math.atan2(way[0], way[2]) == pytest.approx(angle, abs=0.06)


def test_it_steps_as_high_as_asked(world: World, spider: Herd) -> None:
    low = measure(walk(world, 4.0), world.environment.table)["swing_apex_of_leg"]
    change_step_height(spider)
    walk(world, 1.0)
    high = measure(walk(world, 4.0), world.environment.table)["swing_apex_of_leg"]
    assert isinstance(low, float)
    assert high == pytest.approx(2.5 * low, rel=0.1)


def test_it_stands_as_high_as_asked(world: World, spider: Herd) -> None:
    high = walk(world, 3.0).body_position[-60:, 1].mean()
    change_body_height(spider)
    walk(world, 2.0)
    low = walk(world, 2.0).body_position[:, 1].mean()
    assert low == pytest.approx(0.7 * high, rel=0.05)


def test_its_feet_move_apart_as_asked(world: World, spider: Herd) -> None:
    def width(recording: Recording) -> float:
        across = recording.foot_position - recording.body_position[:, None]
        standing = np.where(recording.foot_stance, across[:, :, 0], np.nan)
        return float(np.nanmean(standing * spider.tables.legs.side))

    narrow = width(walk(world, 3.0))
    change_spacing(spider)
    walk(world, 2.0)
    assert width(walk(world, 3.0)) - narrow == pytest.approx(0.05, abs=0.012)


@pytest.mark.parametrize("name", ["wave", "tetrapod", "spider"])
def test_it_takes_the_gait(world: World, name: str) -> None:
    """After a transition the footfalls are those of the gait that was asked for."""
    herd = world.add(load_rig("spider"), speed=0.12, gait="tripod")
    legs = herd.tables.legs
    walk(world, 2.0)
    wanted = make_gait(name, legs.side, legs.row)
    herd.command.set_gait(wanted)
    walk(world, 8.0)
    recording = record_walk(world, 15.0, 90.0)[0]
    duty = 1.0 - herd.state.goal_extent[0]
    phase = (herd.state.goal_start[0] - duty) % 1.0
    figures = measure(recording, world.environment.table, gait_duty=duty, gait_phase=phase)
    assert failures(figures) == []
    assert wanted.duty_low - 0.02 <= duty.mean() <= wanted.duty_high + 0.02
    assert figures["duty_error"] < 0.06  # type: ignore[operator]
    assert figures["phase_error"] < 0.05  # type: ignore[operator]


def test_who_stands_does_not_move_a_foot(world: World) -> None:
    world.add(load_rig("spider"))
    recording = walk(world, 5.0)
    assert recording.foot_stance.all()
    assert np.ptp(recording.foot_position, axis=0).max() == 0.0
    assert np.ptp(recording.body_position, axis=0).max() < 1e-9


def test_who_stops_comes_to_rest(world: World, spider: Herd) -> None:
    walk(world, 2.0)
    spider.command.speed = 0.0
    assert_sound(walk(world, 4.0), world)
    recording = walk(world, 5.0)
    assert recording.foot_stance.all()
    # The body's filter still moves in the last bit.
    assert np.ptp(recording.foot_position, axis=0).max() < 1e-14


def test_a_path_is_followed_to_its_end(world: World) -> None:
    herd = world.add(load_rig("spider"), speed=0.5)
    path = np.array([[0.0, 0.0], [0.0, 1.5], [1.5, 2.5]])
    herd.command.set_path(path.tolist(), 0)
    recording = walk(world, 12.0)
    assert_sound(recording, world)
    place = recording.body_position[:, [0, 2]]
    leg = herd.tables.leg_length
    for waypoint in path:
        assert np.linalg.norm(place - waypoint, axis=1).min() < 0.6 * leg
    assert np.linalg.norm(place[-1] - path[-1]) < 0.15 * leg
    rest = walk(world, 3.0)
    assert rest.foot_stance.all()
    assert np.ptp(rest.foot_position, axis=0).max() < 1e-12


def test_turning_on_the_spot(world: World) -> None:
    herd = world.add(load_rig("spider"))
    herd.command.heading = 2.5
    recording = walk(world, 9.0)
    assert_sound(recording, world)
    assert herd.state.heading[0] == pytest.approx(2.5, abs=0.02)
    assert not recording.foot_stance.all()
    drift = np.linalg.norm(recording.body_position[:, [0, 2]], axis=1).max()
    assert drift < 0.2 * herd.tables.leg_length


def test_a_crowd_of_several_kinds(world: World) -> None:
    kinds = ["spider", "wolf", "ant"]
    place = World(Terrain.flat(), scatter(Terrain.flat(), 60, (-3.0, 0.5, 3.0, 4.0),
                  ((0.08, 0.02, 0.08), (0.3, 0.07, 0.3)), 5))  # fmt: skip
    for n, kind in enumerate(kinds):
        where = [[3.0 * (n - 1) - 0.5, -1.0], [3.0 * (n - 1) + 0.5, -1.0]]
        place.add(load_rig(kind), 2, position=where, speed=0.4)
    recordings = record_walk(place, 4.0, FPS)
    assert len(recordings) == 2 * len(kinds)
    for recording in recordings:
        assert_sound(recording, place)
        assert recording.body_position[-1, 2] > recording.body_position[0, 2] + 0.8


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, -1.0, 1e9, "fast", None])
@pytest.mark.parametrize("name", ["speed", "step_height", "body_height", "blend_cycles"])
def test_absurd_numbers_are_refused(spider: Herd, name: str, value: object) -> None:
    before = np.array(getattr(spider.command, name))
    with pytest.raises(SettingError, match=name):
        setattr(spider.command, name, value)
    assert np.array_equal(getattr(spider.command, name), before)


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e9])
@pytest.mark.parametrize("name", ["heading", "travel"])
def test_absurd_angles_are_refused(spider: Herd, name: str, value: float) -> None:
    with pytest.raises(SettingError, match=name):
        setattr(spider.command, name, value)


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, "slow"])
def test_absurd_periods_are_refused(spider: Herd, value: object) -> None:
    with pytest.raises(SettingError, match="period"):
        spider.command.period = value


@pytest.mark.parametrize("value", [math.nan, math.inf, [1.0, 2.0, 3.0], "wide", 1e9])
def test_absurd_spacings_are_refused(spider: Herd, value: object) -> None:
    with pytest.raises(SettingError, match="spacing"):
        spider.command.spacing = value


@pytest.mark.parametrize(
    "path", [[], [[0.0, math.nan]], [[0.0, 0.0, 0.0]], [["a", "b"]], [[0.0, 1e300]]]
)
def test_absurd_paths_are_refused(spider: Herd, path: list[list[float]]) -> None:
    with pytest.raises(SettingError, match="path"):
        spider.command.set_path(path, 0)


@pytest.mark.parametrize("dt", [0.0, -0.1, math.nan, math.inf, 2.0])
def test_absurd_time_steps_are_refused(world: World, spider: Herd, dt: float) -> None:
    with pytest.raises(SettingError, match="step"):
        world.step(dt)
    assert world.time == 0.0


def test_absurd_creatures_are_refused(world: World) -> None:
    spider = load_rig("spider")
    for count in (0, -1, 1.5, 10**9):
        with pytest.raises(SettingError, match="count"):
            world.add(spider, count)  # type: ignore[arg-type]
    for position in ([math.nan, 0.0], [1e300, 0.0], [1.0, 2.0, 3.0], ["a", "b"]):
        with pytest.raises(SettingError, match="position"):
            world.add(spider, position=position)
    with pytest.raises(GaitError, match="no gait"):
        world.add(spider, gait="moonwalk")
    with pytest.raises(SettingError, match="speed"):
        world.add(spider, speed=[1.0, 2.0])
    assert world.herds == []


def test_steps_of_any_length_walk(world: World, spider: Herd) -> None:
    """Frames far longer than a swing, and far shorter, both walk."""
    for dt in (1.0, 0.3, 1e-3):
        for _ in range(6):
            world.step(dt)
            assert np.isfinite(spider.state.joint_position).all()
            leg = spider.tables.leg_length
            assert spider.state.residual[~spider.state.swinging].max(initial=0.0) < 1e-3 * leg
    assert spider.state.position[0, 2] > 1.5


def test_a_body_told_to_stay_level_stays_level_uphill() -> None:
    world = World(Terrain.slope(0.3, length=6.0, start=0.5), threads=1)
    herd = world.add(load_rig("spider"), speed=0.4, settings=Settings(tilt_share=0.0))
    assert_sound(walk(world, 6.0), world)
    assert herd.state.position[0, 1] > 0.3
    assert np.abs(herd.state.tilt).max() == 0.0
