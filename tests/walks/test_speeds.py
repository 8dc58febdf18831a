"""Walks whose gaits follow their speed: when they change, what is pinned; strides that vary."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.config import Settings
from polypod.errors import SettingError
from polypod.gait.follow import PINNED
from polypod.gait.library import make_gait
from polypod.gait.tempo import GRAVITY
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.world import World


def speed_of(froude: float, length: float = 0.5) -> float:
    return math.sqrt(froude * GRAVITY * length)


def walk(
    herd: Herd, world: World, seconds: float, fps: float, speed: float | None = None
) -> list[str]:
    """Walk on and return the gaits taken, one after the other."""
    if speed is not None:
        herd.command.speed = speed
    taken: list[str] = []
    for _ in range(round(seconds * fps)):
        world.step(1.0 / fps)
        down = int(np.count_nonzero(~herd.state.swinging[0]))
        assert down >= herd.state.least_down[0]
        if not taken or taken[-1] != herd.gait_name[0]:
            taken.append(herd.gait_name[0])
    return taken


def start(kind: str, speed: float, **asked: object) -> tuple[World, Herd]:
    world = World(threads=1)
    return world, world.add(load_rig(kind), speed=speed, **asked)  # type: ignore[arg-type]


@pytest.mark.parametrize("fps", [24.0, 60.0, 240.0])
def test_a_wolf_goes_through_its_gaits_at_any_frame_rate(fps: float) -> None:
    world, herd = start("wolf", 6.0)
    assert walk(herd, world, 3.0, fps) == ["walk", "trot", "canter", "transverse-gallop"]
    assert walk(herd, world, 5.0, fps, speed=0.0)[-1] == "walk"
    # Each change is a whole transition: the disks are those of the gait it ended in.
    assert walk(herd, world, 4.0, fps, speed=1.6) == ["walk", "trot"]
    walk(herd, world, 3.0, fps)
    assert herd.state.blend_left[0] == 0.0
    trot = make_gait("trot", herd.tables.legs.side, herd.tables.legs.row, float(herd.state.duty[0]))
    shift = (herd.state.goal_start[0] - trot.swing_start + 0.5) % 1.0
    assert np.ptp(shift) < 1e-9
    assert herd.state.goal_extent[0] == pytest.approx(trot.swing_extent)


def test_a_speed_that_wobbles_about_a_limit_changes_nothing() -> None:
    world, herd = start("wolf", 1.0)
    limit = speed_of(0.35, herd.tables.hip_height)
    walk(herd, world, 2.0, 30.0)
    for k in range(12):
        # A twentieth in speed is a tenth in Froude number.
        wobble = 1.0 + 0.045 * (-1) ** k
        assert walk(herd, world, 0.5, 30.0, speed=limit * wobble) == ["walk"]
    assert walk(herd, world, 2.0, 30.0, speed=1.1 * limit)[-1] == "trot"
    for k in range(12):
        wobble = 1.0 + 0.045 * (-1) ** k
        assert walk(herd, world, 0.5, 30.0, speed=limit * wobble) == ["trot"]


def test_a_pinned_gait_stays_and_can_be_let_go() -> None:
    world, herd = start("wolf", 1.0, gait="pace")
    assert herd.state.rung[0] == PINNED
    assert walk(herd, world, 2.0, 30.0) == ["pace"]
    assert walk(herd, world, 2.0, 30.0, speed=3.0) == ["pace"]
    herd.command.follow_speed()
    assert walk(herd, world, 2.0, 30.0)[-1] == "trot" or herd.gait_name[0] == "canter"
    legs = herd.tables.legs
    herd.command.set_gait(make_gait("amble", legs.side, legs.row))
    assert walk(herd, world, 2.0, 30.0)[-1] == "amble"


def test_duty_and_period_are_pinned_each_alone() -> None:
    world, herd = start("spider", 0.4)
    herd.command.duty = 0.7
    walk(herd, world, 3.0, 60.0)
    assert herd.state.duty[0] == pytest.approx(0.7, abs=0.005)
    free = float(herd.state.cycle_rate[0])
    herd.command.duty = None
    herd.command.period = 0.5
    walk(herd, world, 3.0, 60.0)
    assert 1.0 / herd.state.cycle_rate[0] == pytest.approx(0.5)
    assert herd.gait_name == ("spider",)
    herd.command.period = None
    walk(herd, world, 3.0, 60.0)
    assert herd.state.cycle_rate[0] != pytest.approx(free, rel=1e-3)
    # A duty beyond the gait's own range is kept within it.
    herd.command.duty = 0.95
    walk(herd, world, 3.0, 60.0)
    assert herd.state.duty[0] == pytest.approx(0.75, abs=0.005)
    for absurd in (0.0, 1.0, math.inf, "often"):
        with pytest.raises(SettingError, match="duty"):
            herd.command.duty = absurd


def test_an_insects_pattern_glides_from_wave_to_tripod() -> None:
    world, herd = start("ant", 0.03)
    walk(herd, world, 4.0, 60.0)
    slow = float(herd.state.duty[0])
    assert slow > 0.8
    assert herd.state.least_down[0] >= 5
    moved = []
    herd.command.speed = 2.2
    for _ in range(240):
        before = herd.state.goal_start[0].copy()
        needle = float(herd.state.needle[0])
        world.step(1 / 60)
        turn = (float(herd.state.needle[0]) - needle) % 1.0
        shift = (herd.state.goal_start[0] - before + 0.5) % 1.0 - 0.5
        # A lift moves by the touchdown's way and the stance's, and never faster than the needle.
        moved.append(float(np.abs(shift).max()) / max(turn, 1e-9))
    assert max(moved) < 0.6
    assert herd.state.duty[0] == pytest.approx(0.5, abs=0.01)
    assert herd.state.least_down[0] >= 2


def test_a_run_changes_no_speed_in_flight() -> None:
    world, herd = start("biped", 3.5)
    fps, in_flight, changed = 240.0, 0, 0
    for _ in range(round(2.0 * fps)):
        before = float(herd.state.speed[0])
        airborne = bool(herd.state.swinging[0].all())
        world.step(1.0 / fps)
        if airborne and herd.state.swinging[0].all():
            in_flight += 1
            assert herd.state.speed[0] == before
        else:
            changed += herd.state.speed[0] != before
    assert in_flight > 20
    assert changed > 20
    assert herd.state.speed[0] == pytest.approx(3.5)


def test_who_runs_to_a_place_stops_there() -> None:
    world, herd = start("biped", 3.0)
    herd.command.set_path([[0.0, 0.0], [0.0, 8.0]], 0)
    farthest = 0.0
    for _ in range(round(8.0 * 60.0)):
        world.step(1 / 60)
        farthest = max(farthest, float(herd.state.position[0, 2]))
    assert herd.state.speed[0] == 0.0
    assert herd.state.position[0, 2] == pytest.approx(8.0, abs=0.15)
    assert farthest < 8.15


def touchdowns(seed: int, variation: float, fps: float, threads: int = 1) -> np.ndarray:
    """Return the moments [N] at which a spider's first foot lands, s."""
    world = World(threads=threads, seed=seed)
    herd = world.add(
        load_rig("spider"), 4, speed=0.5, settings=Settings(stride_variation=variation)
    )
    landed, moments = True, []
    for _ in range(round(12.0 * fps)):
        world.step(1.0 / fps)
        stands = not herd.state.swinging[1, 0]
        if stands and not landed and world.time > 2.0:
            moments.append(world.time)
        landed = stands
    return np.array(moments)


def alike(some: np.ndarray, others: np.ndarray) -> float:
    """Return how far the strides between two lists of moments [N] are long and short together."""
    return float(np.corrcoef(np.diff(some), np.diff(others))[0, 1])


def test_strides_of_a_walk_vary_at_any_frame_rate_and_threads() -> None:
    steady, varied = touchdowns(5, 0.0, 120.0), touchdowns(5, 0.04, 120.0)
    assert np.diff(steady).std() < 0.012 * np.diff(steady).mean()
    assert 0.02 < np.diff(varied).std() / np.diff(varied).mean() < 0.07
    assert np.array_equal(varied, touchdowns(5, 0.04, 120.0, threads=3))
    coarse = touchdowns(5, 0.04, 40.0)
    shared = min(len(coarse), len(varied))
    # The first step begins a frame or two earlier or later, and legs at their ends hurry others;
    # but the same strides are long and short.
    assert np.ptp(coarse[:shared] - varied[:shared]) < 0.12
    assert alike(coarse[:shared], varied[:shared]) > 0.6
    other = touchdowns(6, 0.04, 120.0)
    shared = min(len(other), len(varied))
    assert np.abs(other[:shared] - varied[:shared]).max() > 0.02
    assert alike(other[:shared], varied[:shared]) < 0.4


@pytest.mark.parametrize(("kind", "speed"), [("lizard", 0.7), ("lizard", 1.2), ("spider", 0.9)])
@pytest.mark.parametrize("fps", [24.0, 30.0])
def test_small_fast_walkers_do_not_stop_and_go_at_film_rates(
    kind: str, speed: float, fps: float
) -> None:
    """A foot that is down a frame late must not hold its body up."""
    world, herd = start(kind, speed)
    walk(herd, world, 2.0, fps)
    begun = herd.state.position[0, 2]
    slowest = speed
    for _ in range(round(4.0 * fps)):
        world.step(1.0 / fps)
        slowest = min(slowest, float(herd.state.speed[0]))
    assert herd.state.position[0, 2] - begun > 0.95 * 4.0 * speed
    assert slowest > 0.75 * speed


@pytest.mark.parametrize("speed", [0.9, 1.2, 1.5, 1.8, 2.4])
def test_a_fast_spider_keeps_an_even_speed(speed: float) -> None:
    """Feet that land where those before them still stand would hold the body back each cycle."""
    world, herd = start("spider", 0.5)
    walk(herd, world, 1.0, 60.0)
    walk(herd, world, 1.5, 60.0, speed=speed)  # it gains speed, and keeps it from then on
    places = np.empty((481, 3))
    for place in places:
        place[:] = herd.state.position[0]
        world.step(1.0 / 60.0)
    of_frames = np.linalg.norm(np.diff(places, axis=0), axis=1) * 60.0
    assert of_frames.min() > 0.95 * speed
    assert of_frames.max() < 1.05 * speed


@pytest.mark.parametrize("kind", ["wolf", "biped"])
@pytest.mark.parametrize("begun", range(5))
def test_a_change_of_gait_holds_no_body_back(kind: str, begun: int) -> None:
    """Feet that swung meanwhile leave before their legs are at their ends, and land in turn."""
    world, herd = start(kind, 0.0)
    unit = math.sqrt(GRAVITY * herd.tables.leg_length)
    walk(herd, world, 2.0 + 0.12 * begun, 60.0, speed=0.3 * unit)
    herd.command.speed = 1.2 * unit
    worst, held, before = 0.0, 0, float(herd.state.speed[0])
    for _ in range(180):
        place = herd.state.position[0].copy()
        world.step(1.0 / 60.0)
        way = (herd.state.position[0] - place)[[0, 2]]
        speed = float(herd.state.speed[0])
        short = 0.5 * (before + speed) - 60.0 * float(np.linalg.norm(way))
        before = speed
        worst = max(worst, short / (1.2 * unit))
        held += short > 0.25 * 1.2 * unit
    assert herd.gait_name[0] == ("trot" if kind == "wolf" else "run")
    assert worst < 0.5
    assert held <= 3
