"""Figures of a walk in closed form, then of the same walk with one known fault at a time."""

from __future__ import annotations

import dataclasses
import json
import math
import re

import numpy as np
import pytest
import synthetic
from synthetic import APEX, DUTY, LEG, PHASES, SPEED, STRIDE_S

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.report.apart import leg_room
from polypod.report.arrays import angles_of, conjugate_all, multiply_all, rotate_all
from polypod.report.figures import measure, measure_played, write_report
from polypod.report.verdict import failures, remarks

FPS = 30
FLAT = Environment().table
STRIDE_FRAMES = round(STRIDE_S * FPS)


def figures_of(recording, environment=FLAT, **asked):
    return measure(recording, environment, **asked)


@pytest.fixture(scope="module")
def faultless():
    recording = synthetic.walk()
    seconds = recording.time[-1]
    return figures_of(
        recording,
        commanded_distance_m=SPEED * seconds,
        gait_duty=np.full(6, DUTY),
        gait_phase=PHASES,
        joint_limits=True,
    )


def test_faultless_walk_has_no_failures_and_no_remarks(faultless):
    assert failures(faultless, 0.95) == []
    assert remarks(faultless) == []


@pytest.mark.parametrize(
    "name",
    [
        *("stance_slip_of_leg", "stance_off_surface_of_leg", "stance_residual_of_leg"),
        *("stance_inside_of_leg", "swing_inside_of_leg", "swing_residual_of_leg"),
        *("bone_variation", "flight_share", "legs_crossed_share", "body_tilt_deg"),
    ],
)
def test_faultless_walk_measures_zero(faultless, name):
    assert faultless[name] == pytest.approx(0.0, abs=1e-12)


def test_stride_duty_phase_and_support_are_the_gaits(faultless):
    frame = 1.0 / STRIDE_FRAMES
    assert faultless["stride_s"] == pytest.approx(STRIDE_S, rel=0.01)
    assert faultless["stride_m"] == pytest.approx(SPEED * STRIDE_S, rel=0.01)
    assert faultless["duty"] == pytest.approx(DUTY, abs=frame)
    assert faultless["duty_error"] <= frame
    for measured, asked in zip(faultless["phase_of_foot"], PHASES, strict=True):
        assert abs((measured - asked + 0.5) % 1.0 - 0.5) <= frame
    assert faultless["phase_error"] <= frame
    # Mean number of feet down is the sum of the duty factors.
    assert faultless["feet_down_mean"] == pytest.approx(6 * DUTY, abs=6 * frame)
    assert faultless["feet_down_least"] == 3


def test_swings_rise_to_their_apex_and_speed_up_in_the_middle(faultless):
    assert faultless["swing_apex_of_leg"] == pytest.approx(APEX / LEG, rel=0.03)
    # Along z the speed is that of smoothstep, whose peak is 3/2 of its mean; the arc flattens it.
    assert 1.0 < faultless["swing_speed_peak_over_mean"] < 1.6


def test_distance_is_that_of_the_body(faultless):
    assert faultless["distance_m"] == pytest.approx(SPEED * 4.0, rel=1e-9)
    assert faultless["distance_share"] == pytest.approx(1.0)


def test_bounce_and_implied_force_are_those_of_a_cosine():
    """y = b cos(w t): excursion 2 b, least force 1 - b (2 sin(w dt / 2) / dt)^2 / g."""
    bob, omega, dt = 0.004, 4 * math.pi / STRIDE_S, 1.0 / FPS
    figures = figures_of(synthetic.walk(bob=bob))
    assert figures["body_excursion_m"] == pytest.approx(2 * bob, rel=0.02)
    curvature = bob * (2.0 * math.sin(0.5 * omega * dt) / dt) ** 2
    assert figures["body_force_least_g"] == pytest.approx(1.0 - curvature / 9.81, rel=1e-6)
    assert figures["body_force_mean_g"] == pytest.approx(1.0, abs=0.01)
    assert figures["body_tremor_share"] < 0.001
    # Both tripods' mid-stances are at the same phase of its two beats.
    assert figures["body_mid_stance"] == pytest.approx(math.cos(2 * math.pi * DUTY), abs=0.1)


def test_tremor_is_the_share_of_energy_above_six_strides():
    """A tremor of a third of the bounce's amplitude has 1/9 of its energy: share 1/10."""
    recording = synthetic.walk(bob=0.006)
    height = recording.body_position.copy()
    height[:, 1] += 0.002 * np.cos(2 * math.pi * 10.0 * recording.time)  # 10 Hz: 8 strides
    figures = figures_of(dataclasses.replace(recording, body_position=height))
    assert figures["body_tremor_share"] == pytest.approx(0.1, rel=0.1)
    assert any("tremor" in remark for remark in remarks(figures))


def first_stance(foot):
    """Return the middle of a whole stance of a foot, s."""
    return (1.0 + PHASES[foot] + 0.5 * DUTY) * STRIDE_S


def during(foot, time, stands=True):
    """Say whether `time` is in the second half of that stance, or in the swing after it."""
    begin = first_stance(foot)
    end = (1.0 + PHASES[foot] + DUTY) * STRIDE_S - 1e-6
    return begin <= time <= end if stands else end < time < end + (1 - DUTY) * STRIDE_S


def only(figures, expected):
    """Assert that the walk fails in exactly the figures named."""
    wrong = {
        "slip": "slips by",
        "surface": "off the surface",
        "missed": "misses its place",
        "inside": "a standing foot is .* inside",
        "swing inside": "a swinging foot is .* inside",
        "swing missed": "misses its way",
        "turn": "a joint turns",
        "bone": "a bone's length",
        "on": "stand on a forbidden",
        "across": "cross a forbidden",
    }
    found = " | ".join(failures(figures))
    assert {name for name, words in wrong.items() if re.search(words, found)} == set(expected)


def test_slip_of_sole_and_target_is_only_a_slip():
    def slide(frame, time, soles, targets, stance, support):
        if during(2, time):
            soles[2, 0] += 0.001
            targets[2, 0] += 0.001

    figures = figures_of(synthetic.walk(edit=slide))
    assert figures["stance_slip_of_leg"] == pytest.approx(0.001 / LEG)
    assert figures["stance_skate_mm_a_frame"] == pytest.approx(1.0)
    only(figures, {"slip"})


def test_slip_back_and_forth_is_the_widest_distance():
    """Places 0, +a, -a along x: the slip is 2 a, not the way from the first place."""

    def shake(frame, time, soles, targets, stance, support):
        if during(2, time):
            soles[2, 0] += 0.001 if frame % 2 else -0.001

    figures = figures_of(synthetic.walk(edit=shake))
    assert figures["stance_slip_of_leg"] == pytest.approx(0.002 / LEG)
    assert figures["stance_residual_of_leg"] == pytest.approx(0.001 / LEG)
    only(figures, {"slip", "missed"})


def test_foot_on_a_moving_obstacle_is_seen_from_it():
    """A carrier that moves by 1 cm a frame and turns carries its foot along: no slip."""
    turn_a_frame = 0.01

    def carried(frame, time, soles, targets, stance, support):
        if during(2, time):
            support[2] = 0

    recording = synthetic.walk(edit=carried, obstacle_count=1)
    on_it = recording.foot_support[:, 2] == 0
    frames = np.flatnonzero(on_it)
    angle = turn_a_frame * np.arange(len(recording.time))
    place = np.stack([0.01 * np.arange(len(angle)), 0 * angle, 0 * angle], axis=1)
    spin = np.stack([0 * angle, np.sin(angle / 2), 0 * angle, np.cos(angle / 2)], axis=1)
    feet = recording.foot_position.copy()
    feet[frames, 2] = place[frames] + rotate_all(spin[frames], np.array([0.1, 0.0, 0.2]))
    stance = recording.foot_stance.copy()
    stance[:, 2] = on_it
    moved = dataclasses.replace(
        recording,
        foot_position=feet,
        foot_stance=stance,
        obstacle_position=place[:, None],
        obstacle_rotation=spin[:, None],
    )
    assert figures_of(moved)["stance_slip_of_leg"] == pytest.approx(0.0, abs=1e-12)
    still = dataclasses.replace(moved, foot_support=np.full_like(moved.foot_support, -1))
    assert figures_of(still)["stance_slip_of_leg"] > 0.1


@pytest.mark.parametrize(("lift", "inside"), [(0.002, 0.0), (-0.002, 0.002 / LEG)])
def test_float_and_sinking(lift, inside):
    def raised(frame, time, soles, targets, stance, support):
        if stance[4]:
            soles[4, 1] += lift
            targets[4, 1] += lift

    figures = figures_of(synthetic.walk(edit=raised))
    assert figures["stance_off_surface_of_leg"] == pytest.approx(abs(lift) / LEG)
    assert figures["stance_float_of_leg"] == pytest.approx(max(lift, 0.0) / LEG, abs=1e-12)
    assert figures["stance_sunk_of_leg"] == pytest.approx(max(-lift, 0.0) / LEG, abs=1e-12)
    assert figures["stance_inside_of_leg"] == pytest.approx(inside, abs=1e-12)
    only(figures, {"surface", "inside"} if inside else {"surface"})


def test_one_swing_frame_that_misses_is_beyond_the_999th():
    done = []

    def miss(frame, time, soles, targets, stance, support):
        if during(3, time, stands=False) and not done:
            done.append(frame)
            targets[3, 2] += 0.006

    figures = figures_of(synthetic.walk(edit=miss))
    assert figures["swing_residual_of_leg"] == pytest.approx(0.006 / LEG)
    assert figures["swing_residual_of_leg_999"] == pytest.approx(0.0, abs=1e-12)
    assert figures["stance_residual_of_leg"] == pytest.approx(0.0, abs=1e-12)
    only(figures, {"swing missed"})


def way_of(foot):
    """Return where, in plan, a foot is half-way through the swing after its first whole stance."""
    place, _ = synthetic.sole_at(foot, (1.0 + PHASES[foot] + 0.5 + 0.5 * DUTY) * STRIDE_S)
    return place


def wall(foot, height, forbidden=False):
    """Return a scene with a thin wall across the way of a foot's swing."""
    x, _, z = way_of(foot)
    box = Obstacle.box((0.04, height, 0.08), (x, 0.5 * height, z), forbidden=forbidden)
    return Environment(obstacles=[box]).table


def test_swing_through_a_wall_is_as_deep_as_the_nearest_face():
    """Half-way through the wall the sides are 2 cm away in x and 4 cm in z, the top much more."""
    figures = figures_of(synthetic.walk(obstacle_count=1), wall(5, 0.3))
    assert figures["swing_inside_of_leg"] == pytest.approx(0.02 / LEG)
    assert 0.0 < figures["swing_inside_share"] < 0.05
    only(figures, {"swing inside"})


def test_swing_over_a_low_box_is_no_fault_unless_it_is_forbidden():
    recording = synthetic.walk(obstacle_count=1)
    only(figures_of(recording, wall(5, 0.02)), set())
    figures = figures_of(recording, wall(5, 0.02, forbidden=True))
    assert figures["forbidden_crossings"] == 1
    assert figures["forbidden_stances"] == 0
    only(figures, {"across"})


def test_crossing_between_two_frames_is_found():
    """A forbidden post 2 mm thick stands between two frames: only the chord meets it."""
    recording = synthetic.walk(obstacle_count=1)
    swing = np.flatnonzero(~recording.foot_stance[:, 5])
    swing = swing[swing > 2 * STRIDE_FRAMES]
    frame = swing[len(swing) // 3]
    middle = 0.5 * (recording.foot_position[frame, 5] + recording.foot_position[frame + 1, 5])
    post = Obstacle.box((0.002, 0.01, 0.006), (middle[0], 0.005, middle[2]), forbidden=True)
    scene = Environment(obstacles=[post]).table
    assert figures_of(recording, scene)["forbidden_crossings"] == 1


def test_stance_on_forbidden_ground_is_counted_once_a_stance():
    place, stands = synthetic.sole_at(1, first_stance(1))
    assert stands
    plate = Obstacle.box((0.05, 0.002, 0.05), (place[0], -0.001, place[2]), forbidden=True)
    scene = Environment(obstacles=[plate]).table
    figures = figures_of(synthetic.walk(obstacle_count=1), scene)
    assert figures["forbidden_stances"] == 1
    assert figures["forbidden_crossings"] == 2  # off it and onto it


def test_knee_flip_is_the_turn_of_the_hip():
    """From a frame on, a leg is turned by pi about the line from hip to sole.

    The hip turns by the rest of that against its body; the knee's bend and all bones stay.
    """
    recording = synthetic.walk()
    frame = round(first_stance(0) * FPS)
    upper, lower = recording.morphology.legs.joint[0]
    hip = recording.joint_position[frame:, upper]
    axis = recording.foot_position[frame:, 0] - hip
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    half_turn = np.concatenate([axis, np.zeros((len(axis), 1))], axis=1)
    position, rotation = recording.joint_position.copy(), recording.joint_rotation.copy()
    position[frame:, lower] = hip + rotate_all(half_turn, position[frame:, lower] - hip)
    for row in (upper, lower):
        rotation[frame:, row] = multiply_all(half_turn, rotation[frame:, row])
    flipped = dataclasses.replace(recording, joint_position=position, joint_rotation=rotation)
    figures = figures_of(flipped)
    assert 170.0 < figures["joint_turn_deg"] <= 180.0
    assert figures["joint_turn_at"] == f"Hip0, at {recording.time[frame]:.3f} s"
    assert figures["bone_variation"] < 1e-12
    only(figures, {"turn"})


def test_turn_while_the_foot_travels_far_is_not_judged():
    """The same flip of a foot that leaps by over a tenth of its leg is no fault of the joints."""
    recording = synthetic.walk()
    frame = round(first_stance(0) * FPS)
    rotation, feet = recording.joint_rotation.copy(), recording.foot_position.copy()
    upper = recording.morphology.legs.joint[0, 0]
    rotation[frame:, upper] = multiply_all(np.array([0.0, 1.0, 0.0, 0.0]), rotation[frame:, upper])
    turned = dataclasses.replace(recording, joint_rotation=rotation)
    assert figures_of(turned)["joint_turn_deg"] > 170.0
    feet[frame:, 0, 0] += 0.11 * LEG
    leaping = dataclasses.replace(turned, foot_position=feet)
    assert figures_of(leaping)["joint_turn_deg"] < 45.0


def test_bone_variation_is_the_range_over_the_mean():
    recording = synthetic.walk()
    position = recording.joint_position.copy()
    lower = recording.morphology.legs.joint[3, 1]
    upper = recording.morphology.legs.joint[3, 0]
    bone = position[50, lower] - position[50, upper]
    position[50, lower] += 1e-4 * bone
    figures = figures_of(dataclasses.replace(recording, joint_position=position))
    assert figures["bone_variation"] == pytest.approx(1e-4, rel=1e-2)
    only(figures, {"bone"})


def test_crossed_legs_and_stretch():
    recording = synthetic.walk()
    feet = recording.foot_position.copy()
    # In ten frames feet 0 and 2 of the left side change places along z: their legs cross in plan.
    feet[40:50, [0, 2]] = feet[40:50, [2, 0]]
    crossed = figures_of(dataclasses.replace(recording, foot_position=feet))
    assert crossed["legs_crossed_share"] == pytest.approx(10 / len(recording.time))
    hips = recording.joint_position[:, recording.morphology.legs.joint[:, 0]]
    reach = np.linalg.norm(recording.foot_position - hips, axis=2).max()
    assert figures_of(recording)["leg_stretch"] == pytest.approx(reach / LEG)


def test_legs_touch_where_their_surfaces_do():
    recording = synthetic.walk()
    legs = recording.morphology.legs
    assert leg_room(recording).of_leg.min() > 0.0
    assert figures_of(recording)["legs_touching_share"] == 0.0
    # In ten frames sole 2 stands where sole 0 is, a little more than their thickness aside.
    thick = legs.section_radius[0, 1] + legs.section_radius[2, 1]
    for aside, share in ((1.01, 0.0), (0.99, 10 / len(recording.time))):
        place, feet = recording.joint_position.copy(), recording.foot_position.copy()
        knee = legs.joint[:, 1]
        shift = np.array([0.0, 0.0, aside * thick])
        feet[40:50, 2] = feet[40:50, 0] + shift
        place[40:50, knee[2]] = place[40:50, knee[0]] + 5.0 * shift
        near = dataclasses.replace(recording, foot_position=feet, joint_position=place)
        room = leg_room(near)
        assert room.of_leg[45] == pytest.approx((aside - 1.0) * thick / LEG, abs=1e-9)
        assert room.legs[45] == (0, 2)
        figures = figures_of(near)
        assert figures["legs_touching_share"] == pytest.approx(share)
        assert ("legs touch" in " ".join(remarks(figures))) == (share > 0.0)


def test_belly_clearance_is_to_the_crate_under_it():
    """The belly is at height - thickness + bob; a plate of 5 cm under it leaves that much less."""
    plate = Obstacle.box((0.3, 0.05, 0.1), (0.0, 0.025, 0.5))
    figures = figures_of(
        synthetic.walk(bob=0.0, obstacle_count=1), Environment(obstacles=[plate]).table
    )
    expected = (synthetic.HEIGHT - 0.06 - 0.05) / LEG
    assert figures["body_clearance_of_leg"] == pytest.approx(expected)


def test_soles_played_from_a_file_are_judged_by_the_same_rules():
    recording = synthetic.walk()
    played = recording.foot_position.copy()
    played[60:, :, 0] += 0.001
    figures = measure_played(recording, FLAT, played)
    assert figures["played_stance_slip_of_leg"] == pytest.approx(0.001 / LEG)
    assert failures(figures) == [
        "as played, a standing foot slips by 0.002 leg lengths, over 0.001"
    ]


def test_standing_creature_has_nothing_to_measure_and_says_so():
    recording = synthetic.walk(seconds=1.0)
    still = {
        field.name: np.repeat(getattr(recording, field.name)[:1], 31, axis=0)
        for field in dataclasses.fields(recording)
        if field.name not in ("morphology", "time")
    }
    still["foot_stance"] = np.ones((31, 6), np.bool_)
    figures = figures_of(dataclasses.replace(recording, **still), commanded_distance_m=1.0)
    assert figures["swing_count"] == 0
    assert figures["stride_s"] is None
    assert figures["distance_m"] == 0.0
    sentences = failures(figures, 0.95)
    assert "0 of the commanded distance is walked, under 0.95" in sentences
    unknown = {name: value for name, value in figures.items() if name != "distance_share"}
    assert "the distance walked was not measured" in failures(unknown, 0.95)


def test_report_is_json(faultless, tmp_path):
    path = tmp_path / "report.json"
    write_report(faultless, path)
    assert json.loads(path.read_text(encoding="utf-8")) == faultless


def test_figures_do_not_depend_on_size_or_place():
    """A walk ten times as large, elsewhere and turned, has the same shares of leg length."""
    recording = synthetic.walk()
    factor, shift, angle = 10.0, np.array([3.0, 0.0, -7.0]), 0.7
    turn = np.array([0.0, math.sin(angle / 2), 0.0, math.cos(angle / 2)])

    def moved(place):
        return factor * rotate_all(turn, place) + shift

    body = recording.morphology
    legs = body.legs._replace(
        length=factor * body.legs.length, section_radius=factor * body.legs.section_radius
    )
    trunk = body.body._replace(
        thickness=factor * body.body.thickness,
        half_size=factor * body.body.half_size,
        box_centre=factor * body.body.box_centre,
    )
    large = dataclasses.replace(
        recording,
        morphology=dataclasses.replace(body, legs=legs, body=trunk),
        **{
            name: moved(getattr(recording, name))
            for name in ("body_position", "joint_position", "foot_position", "foot_target")
        },
        **{
            name: multiply_all(turn, getattr(recording, name))
            for name in ("body_rotation", "joint_rotation")
        },
    )
    here, there = figures_of(recording), figures_of(large)
    for name in here:
        if name.endswith(("_of_leg", "_share", "_deg", "_variation", "leg_stretch", "duty")):
            if here[name] is None:
                assert there[name] is None, name
                continue
            assert there[name] == pytest.approx(here[name], rel=1e-6, abs=1e-9), name


def test_limit_excess_is_the_bend_beyond_the_range():
    """With the knees' ranges cut to +-0.05 rad about the rest, the widest bend exceeds by the rest.

    The bend is the angle of the lower bone's rotation as seen from the upper bone.
    """
    recording = synthetic.walk()
    legs = recording.morphology.legs
    upper, lower = (recording.joint_rotation[:, legs.joint[:, i]] for i in (0, 1))
    bend = angles_of(multiply_all(conjugate_all(upper), lower)).max()
    limit = legs.bend_limit.copy()
    limit[:, 1] = (-0.05, 0.05)
    body = dataclasses.replace(recording.morphology, legs=legs._replace(bend_limit=limit))
    figures = figures_of(dataclasses.replace(recording, morphology=body), joint_limits=True)
    assert bend > 0.1
    assert figures["joint_limit_excess_deg"] == pytest.approx(math.degrees(bend - 0.05), rel=1e-6)
    assert any("beyond its limit" in sentence for sentence in failures(figures))
