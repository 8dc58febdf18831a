"""Feet that have a shape: flat on the ground in stance, rolled about their toes, never slipping."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.body.reach import effector_world, pitched
from polypod.config import PROFILES, Settings
from polypod.controller.align import ground_normal_under, misfit
from polypod.controller.roll import bend_along, pitch_along, stride_share
from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.terrain import Terrain
from polypod.errors import SettingError
from polypod.footprints.settings import placed_shape
from polypod.math.quat import from_axis_angle, from_heading, rotate
from polypod.math.vec3 import Vec3, distance, dot, length, load_vec3, normalized
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.recording import record_walk
from polypod.reference import by_reference
from polypod.report.arrays import multiply_all, runs_of
from polypod.report.figures import measure
from polypod.report.record import Recording
from polypod.tables import make_tables
from polypod.world import World

FPS = 30.0
WALKERS = {"wolf": 1.0, "biped": 1.4}  # m/s
ANGLES = st.floats(-0.7, 0.7)


@pytest.fixture(scope="module", params=list(WALKERS))
def walker(request: pytest.FixtureRequest) -> Morphology:
    return load_rig(request.param)


def walk(
    morphology: Morphology,
    seconds: float,
    place: Environment | None = None,
    settings: Settings | None = None,
    fps: float = FPS,
) -> Recording:
    world = World(place, threads=1)
    speed = WALKERS[morphology.name]
    world.add(morphology, position=[0.0, 0.0], speed=speed, settings=settings)
    return record_walk(world, seconds, fps)[0]


def heel_angles(recording: Recording, foot: int) -> np.ndarray:
    """Return how far [F] a foot's heel is up against level, rad, by its joint as recorded."""
    row = int(recording.morphology.legs.foot_joint[foot])
    x, y, z, w = recording.joint_rotation[:, row].T
    return np.arcsin(np.clip(-2.0 * (y * z - w * x), -1.0, 1.0))


@given(yaw=st.floats(-3.0, 3.0), tilt=ANGLES, pitch=ANGLES, bend=ANGLES)
@settings(max_examples=40, deadline=None)
def test_sole_and_pivot_stay_while_the_ankle_turns(yaw, tilt, pitch, bend):
    for name in WALKERS:
        legs = make_tables(load_rig(name)).legs
        tables = by_reference(make_tables(load_rig(name)))
        turn = from_axis_angle(Vec3(0.6, 0.0, 0.8), tilt) * from_heading(yaw)
        turn = pitched(turn, pitch)
        sole = Vec3(0.3, -0.2, 1.7)
        for k in range(len(legs.length)):
            pivot_rest = load_vec3(legs.roll_pivot[k])
            ankle_rest = load_vec3(legs.point_rest[k, legs.joint_count[k]])
            pivot = sole - rotate(turn, load_vec3(legs.sole_rest[k]) - pivot_rest)
            ankle = effector_world(k, tables, sole, turn, bend)
            flat = effector_world(k, tables, sole, turn, 0.0)
            arm = distance(ankle_rest, pivot_rest)
            assert distance(ankle, pivot) == pytest.approx(arm, abs=1e-12)
            cosine = dot(ankle - pivot, flat - pivot) / arm**2
            # About the foot's own left-right axis, along which the ankle does not move.
            across = rotate(turn, Vec3(1.0, 0.0, 0.0))
            out = dot(ankle - pivot, across) / arm
            assert dot(flat - pivot, across) / arm == pytest.approx(out, abs=1e-12)
            swung = (cosine - out**2) / (1.0 - out**2)
            assert math.acos(min(1.0, max(-1.0, swung))) == pytest.approx(abs(bend), abs=1e-6)
            if bend > 0.0:
                # The heel is raised: the ankle goes up and forward over toes ahead of it.
                up = rotate(turn, Vec3(0.0, 1.0, 0.0))
                back = math.atan2(ankle_rest.y - pivot_rest.y, pivot_rest.z - ankle_rest.z)
                higher = math.sin(back + bend) - math.sin(back)
                assert dot(ankle - flat, up) == pytest.approx(
                    higher * math.hypot(ankle_rest.y - pivot_rest.y, pivot_rest.z - ankle_rest.z),
                    abs=1e-9,
                )


@given(
    start=ANGLES,
    rate=st.floats(-3.0, 3.0),
    trail=st.floats(0.0, 0.7),
    up=st.floats(-0.4, 0.2),
    end=st.floats(-0.1, 0.2),
)
@settings(max_examples=60, deadline=None)
def test_a_swing_s_roll_is_smooth_and_keeps_its_ends(start, rate, trail, up, end):
    step = 1e-6
    gone = np.linspace(0.0, 1.0 - step, 800)
    for curve, ends in (
        (lambda u: pitch_along(u, start, rate, trail, up, end), end),
        (lambda u: bend_along(u, start, rate), 0.0),
    ):
        value = np.array([curve(u) for u in gone])
        slope = (np.array([curve(u + step) for u in gone]) - value) / step
        assert value[0] == pytest.approx(start)
        assert slope[0] == pytest.approx(rate, abs=2e-3)
        assert curve(1.0) == pytest.approx(ends, abs=1e-12)
        assert slope[-1] == pytest.approx(0.0, abs=0.05)
        # Continuous: from sample to sample neither angle nor rate may jump.
        assert np.abs(np.diff(value)).max() < 0.05
        assert np.abs(np.diff(slope)).max() < 1.2


@given(
    yaw=st.floats(-3.0, 3.0),
    x=st.floats(-2.0, 2.0),
    z=st.floats(1.0, 6.0),
    angle=st.floats(0.02, 0.6),
    behind=st.floats(0.0, 0.08),
)
@settings(max_examples=40, deadline=None)
def test_on_a_slope_the_plane_under_a_foot_is_the_slope(yaw, x, z, angle, behind):
    place = Environment(Terrain.slope(angle, length=12.0, start=-2.0))
    foot = placed_shape(0.05, 0.1, behind, yaw)
    ground = Vec3(x, (z + 2.0) * math.tan(angle), z)
    normal = ground_normal_under(place.kernel_table, foot, ground, 0.0)
    wanted = Vec3(0.0, math.cos(angle), -math.sin(angle))
    assert normalized(normal, wanted) == pytest.approx(wanted, abs=1e-9)
    assert misfit(place.kernel_table, foot, ground, wanted, 0.0) == pytest.approx(0.0, abs=1e-9)


def test_over_an_edge_a_foot_stays_on_what_it_stands_on():
    """A crate lies under a little of the toes' outer side: the foot does not climb it."""
    crate = Obstacle.box((0.4, 0.05, 0.4), (0.24, 0.025, 0.28))
    place = Environment(Terrain.flat(), [crate])
    foot = placed_shape(0.05, 0.1, 0.0, 0.0)
    normal = ground_normal_under(place.kernel_table, foot, Vec3(0.0, 0.0, 0.0), 0.0)
    assert normalized(normal, normal) == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)


def test_steps_on_the_spot_and_backward_do_not_roll():
    assert stride_share(0.0, 0.5) == stride_share(-0.4, 0.5) == 0.0
    assert stride_share(0.25, 0.5) == pytest.approx(1.0)


def test_heels_rise_while_the_sole_stays(walker: Morphology) -> None:
    recording = walk(walker, 4.0)
    figures = measure(recording, World().environment.table)
    assert figures["stance_slip_of_leg"] < 1e-9
    assert figures["stance_off_surface_of_leg"] < 1e-9
    assert figures["foot_tilt_deg"] < 0.2
    assert figures["foot_sunk_of_leg"] < 0.01
    assert figures["foot_sunk_in_swing_of_leg"] < 0.01
    for foot in range(len(walker.legs.length)):
        heel = heel_angles(recording, foot)
        stances = runs_of(recording.foot_stance[:, foot])[1:-1]
        assert len(stances) >= 3
        for start, stop in stances:
            quarter = max((stop - start) // 4, 1)
            assert np.abs(heel[start + quarter : start + 2 * quarter]).max() < 0.12, "first it lies"
            assert heel[stop - 1] > 0.25, "then its heel rises"
            settled = start + (stop - start) // 3
            assert np.diff(heel[settled:stop]).min() > -0.02, "and does not sink again"


def test_feet_turn_without_a_jolt(walker: Morphology) -> None:
    """At four times the frame rate a foot turns a quarter as far in a frame, and evenly.

    Once it walks: who sets out takes a quick step.
    """
    recording = walk(walker, 3.0, fps=4.0 * FPS)
    for foot in range(len(walker.legs.length)):
        row = int(walker.legs.foot_joint[foot])
        turn = recording.joint_rotation[round(4.0 * FPS) :, row]
        step = multiply_all(turn[1:], turn[:-1] * np.array([-1.0, -1.0, -1.0, 1.0]))
        rate = 2.0 * step[:, :3] * np.sign(step[:, 3:])
        assert np.linalg.norm(rate, axis=1).max() < 0.16
        assert np.linalg.norm(np.diff(rate, axis=0), axis=1).max() < 0.07


def test_long_soles_strike_with_the_heel_and_paws_with_their_toes() -> None:
    for name, low, high in (("biped", -0.5, -0.08), ("wolf", 0.02, 0.2)):
        recording = walk(load_rig(name), 4.0, fps=4.0 * FPS)
        for foot in range(len(recording.foot_stance[0])):
            heel = heel_angles(recording, foot)
            swings = [run for run in runs_of(~recording.foot_stance[:, foot]) if run[0] > 240]
            for start, stop in swings[:-1]:
                assert heel[start : start + (stop - start) // 2].max() > 0.2, "it trails"
                late = heel[start + round(0.6 * (stop - start)) : stop]
                assert low < late.min() < high
                assert heel[stop] > -0.02, "its heel is never in the ground"


@pytest.mark.parametrize("degrees", [10.0, 20.0])
def test_soles_lie_flat_on_slopes(walker: Morphology, degrees: float) -> None:
    place = Environment(Terrain.slope(math.radians(degrees), length=20.0, start=-5.0))
    figures = measure(walk(walker, 3.0, place), place.table)
    # As far as ankles go: on the steeper one some end a little short.
    assert figures["foot_tilt_deg_max"] < 6.0
    assert figures["foot_tilt_deg"] < 0.2
    assert figures["foot_sunk_of_leg"] < 0.01
    assert figures["stance_slip_of_leg"] < 1e-9


def test_ankles_and_settings_bound_the_tilt() -> None:
    place = Environment(Terrain.slope(math.radians(20.0), length=20.0, start=-5.0))
    wolf = load_rig("wolf")
    for given_settings, least in (
        (Settings(foot_align=0.0), 19.0),
        (Settings(foot_tilt=math.radians(5.0)), 14.0),
        (Settings(ankle_range=0.0), 5.0),
    ):
        figures = measure(walk(wolf, 2.0, place, given_settings), place.table)
        assert figures["foot_tilt_deg_max"] > least
        assert figures["stance_slip_of_leg"] < 1e-9
        assert figures["stance_off_surface_of_leg"] < 2e-3


def test_the_report_sees_feet_that_do_not_lie_flat() -> None:
    recording = walk(load_rig("wolf"), 2.0)
    turned = recording.joint_rotation.copy()
    rows = recording.morphology.legs.foot_joint
    nod = np.array(from_axis_angle(Vec3(0.0, 0.0, 1.0), 0.2))
    turned[:, rows] = multiply_all(turned[:, rows], nod)
    table = World().environment.table
    before = measure(recording, table)
    figures = measure(dataclasses.replace(recording, joint_rotation=turned), table)
    assert figures["foot_tilt_deg"] == pytest.approx(math.degrees(0.2), abs=0.3)
    half = recording.morphology.legs.foot_half_size[:, 0] / recording.morphology.legs.length
    assert figures["foot_sunk_of_leg"] > before["foot_sunk_of_leg"] + 0.15 * half.min()


def test_feet_without_a_shape_are_not_judged() -> None:
    world = World(threads=1)
    world.add(load_rig("spider"), position=[0.0, 0.0], speed=0.3)
    figures = measure(record_walk(world, 1.0, FPS)[0], world.environment.table)
    assert figures["foot_tilt_deg"] is None
    assert figures["foot_sunk_in_swing_of_leg"] is None


def test_swings_follow_the_profile_named() -> None:
    wolf = load_rig("wolf")
    peak = {}
    for name in PROFILES:
        recording = walk(wolf, 3.0, settings=Settings(swing_profile=name), fps=120.0)
        figures = measure(recording, World().environment.table)
        peak[name] = figures["swing_speed_peak_over_mean"]
        assert figures["stance_slip_of_leg"] < 1e-9
    assert 1.6 < peak["bell"] < 2.1
    assert 1.0 <= peak["constant"] < 1.2


def test_a_change_of_settings_in_mid_swing_moves_no_foot_by_a_jump() -> None:
    world = World(threads=1)
    wolf = load_rig("wolf")
    herd = world.add(wolf, position=[0.0, 0.0], speed=1.0)
    leg = float(wolf.legs.length.mean())
    before = herd.state.foot[0].copy()
    longest = 0.0
    for frame in range(240):
        if frame >= 120 and frame % 7 == 0:
            other = "constant" if herd.settings.swing_profile == "bell" else "bell"
            herd.settings = Settings(swing_profile=other)
            herd.command.heading = 0.2 * math.sin(frame)  # and feet are planned anew
        world.step(1.0 / 60.0)
        step = np.linalg.norm(herd.state.foot[0] - before, axis=1).max() / leg
        before = herd.state.foot[0].copy()
        if frame < 120:
            longest = max(longest, step)
        else:
            assert step < 1.25 * longest


@given(name=st.text(max_size=12).filter(lambda text: text not in PROFILES))
def test_an_unknown_profile_is_refused(name: str) -> None:
    with pytest.raises(SettingError, match="swing_profile"):
        Settings(swing_profile=name)


@given(value=st.one_of(st.floats(), st.text(max_size=5), st.none()))
@settings(max_examples=60)
def test_every_setting_is_a_number_in_range_or_refused(value: object) -> None:
    for name in ("ankle_range", "foot_tilt", "step_height"):
        fits = isinstance(value, float) and 0.0 <= value <= 1e3
        if fits or (value is None and name == "step_height"):
            Settings(**{name: value})
        else:
            with pytest.raises(SettingError, match=name):
                Settings(**{name: value})


def test_clearance_is_by_build_unless_it_is_set() -> None:
    """BIOMECHANICS 2: mammals' apex is 8-15 % of leg length, arthropods' 10-25 %."""
    for name, low, high in (("wolf", 0.08, 0.15), ("spider", 0.10, 0.25), ("ant", 0.10, 0.25)):
        world = World(threads=1)
        herd = world.add(load_rig(name), position=[0.0, 0.0], speed=0.5)
        assert low < herd.command.step_height[0] / herd.tables.leg_length < high
        figures = measure(record_walk(world, 3.0, 60.0)[0], world.environment.table)
        assert low < figures["swing_apex_of_leg"] < high
        set_by_user = world.add(
            load_rig(name), position=[5.0, 0.0], settings=Settings(step_height=0.05)
        )
        assert set_by_user.command.step_height[0] == pytest.approx(
            0.05 * set_by_user.tables.leg_length
        )


def test_normals_of_any_length_do() -> None:
    """What `ground_normal_under` returns is no unit vector; no caller may need one."""
    foot = placed_shape(0.05, 0.1, 0.0, 0.4)
    place = Environment(Terrain.slope(0.5, length=12.0, start=-2.0))
    normal = ground_normal_under(place.kernel_table, foot, Vec3(0.0, 4.0 * math.tan(0.5), 2.0), 0.0)
    assert length(normal) > 1.1
    table = place.kernel_table
    sole = Vec3(0.0, 4.0 * math.tan(0.5), 2.0)
    assert misfit(table, foot, sole, normal, 0.0) == pytest.approx(
        misfit(table, foot, sole, normal * 3.0, 0.0), abs=1e-12
    )
