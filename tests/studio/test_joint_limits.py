"""Limits of joints that are asked for are obeyed, kept in files, and refused in words."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cli.running import assert_refused, polypod
from polypod import World, load_rig
from polypod.environment.scene import read_scene
from polypod.errors import PolypodError
from polypod.ik.limits import limit_excess
from polypod.report.record import read_record
from polypod.studio.conductor import Conductor
from polypod.studio.document import Document, default_document, edited
from polypod.studio.joint_limits import list_limits
from polypod.studio.obeying import obey
from polypod.studio.outbox import Telling
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.saved import document_of_scene, scene_text
from polypod.studio.scenes import creature_toml
from polypod.studio.stage import Stage
from polypod.studio.world_files import WorldFiles
from polypod.tables import make_tables

DT = 1.0 / 60.0
SHIN = {"LeftShin": {"bend": [-0.15, 0.3]}, "RightShin": {"bend": [-0.15, 0.3]}}
EVERYWHERE = {
    **SHIN,
    "LeftThigh": {"flexion": 0.7, "sideways": 0.3},
    "Spine2": {"yaw": 0.05, "roll": 0.0},
    "Tail2": {"pitch": 0.1},
}


def stage_of(rig: str, limit: Any = None) -> Stage:
    document = default_document(rig)
    document["creature"]["limit"] = limit
    return Stage(document, lambda name: name)


def limit(stage: Stage, to: Any) -> Document:
    document = edited(stage.document, ["creature", "limit"], to)
    assert stage.apply(document).limits
    return document


def walk(stage: Stage, seconds: float) -> None:
    for _ in range(round(seconds / DT)):
        stage.step(DT)


def bends(stage: Stage, joint: str, seconds: float) -> np.ndarray:
    """Return how a hinge was turned in each frame, rad, measured on the pose."""
    herd = stage.herd
    morphology, ik = herd.morphology, herd.tables.ik
    row = morphology.joint_name.index(joint)
    leg, number = (int(i) for i in np.argwhere(morphology.legs.joint == row)[0])
    axis, above = ik.axis[leg, number], int(morphology.legs.joint[leg, number - 1])
    found = []
    for _ in range(round(seconds / DT)):
        stage.step(DT)
        turns = herd.state.joint_rotation[0]
        own = _own_turn(turns[above], turns[row])
        found.append(2.0 * math.atan2(float(own[:3] @ axis), float(own[3])))
    return np.array(found)


def _own_turn(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return conj(a) b of quaternions x, y, z, w."""
    vector = a[3] * b[:3] - b[3] * a[:3] - np.cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] + a[:3] @ b[:3])


def test_a_joint_obeys_while_it_walks_and_the_walk_goes_on() -> None:
    stage = stage_of("wolf")
    walk(stage, 1.5)
    free = bends(stage, "LeftShin", 1.5)
    assert free.max() > 0.4, "it bends farther than it will be allowed to"
    place, time = stage.herd.state.position[0].copy(), stage.world.time
    limit(stage, SHIN)
    assert np.array_equal(stage.herd.state.position[0], place)
    assert stage.world.time == time
    held = bends(stage, "LeftShin", 2.5)
    assert -0.15 - 1e-9 <= held.min() < held.max() <= 0.3 + 1e-9
    assert np.linalg.norm(stage.herd.state.position[0] - place) > 0.5, "it walks on"
    leg = stage.herd.morphology.foot_name.index("LeftHindPaw")
    rows = stage.herd.morphology.legs.joint[leg]
    posed = stage.herd.state.joint_rotation[0, rows[rows >= 0]]
    assert limit_excess(stage.herd.tables.ik, leg, _in_body(stage, posed)) < 1e-6
    # And back: one document, one step.
    limit(stage, None)
    assert bends(stage, "LeftShin", 2.0).max() > 0.4


def _in_body(stage: Stage, rotation: np.ndarray) -> np.ndarray:
    spine = stage.herd.morphology.segments
    carrier = int(spine.joint[spine.of_leg[0]])
    frame = stage.herd.state.joint_rotation[0, carrier]
    return np.array([_own_turn(frame, one) for one in rotation])


def test_what_is_limited_while_it_walks_is_what_is_read_anew() -> None:
    stage = stage_of("wolf")
    walk(stage, 0.3)
    limit(stage, EVERYWHERE)
    anew = make_tables(load_rig("wolf", limits=EVERYWHERE))
    for part in ("legs", "ik", "spine", "bend", "stride"):
        for name, mine in getattr(stage.herd.tables, part)._asdict().items():
            assert np.array_equal(mine, getattr(getattr(anew, part), name), equal_nan=True), name
    walk(stage, 0.5)
    spine = stage.herd.morphology.segments
    most = np.concatenate([spine.limit[1:], spine.tail_limit])
    assert np.all(np.abs(stage.herd.state.spine_angle[0, 1:]) <= most + 1e-12)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (
            {"LeftShin": {"bend": [1.2, 1.6]}},
            r"LeftShin cannot be limited so: its leg to LeftHindPaw reaches .* m .* stands",
        ),
        (
            {name: {"flexion": 0.005, "sideways": 0.005} for name in ("LeftThigh", "RightThigh")},
            "LeftThigh cannot be limited so: its leg to LeftHindPaw can take no step",
        ),
        ({"Knee": {"bend": [0.0, 1.0]}}, 'no node named "Knee"'),
        ({"LeftThigh": {"bend": [0.0, 1.0]}}, "bend: is not for the first joint of a leg"),
        ({"LeftHindPaw": {"bend": [0.0, 1.0]}}, "no joint that turns"),
        ({"Spine2": {"yaw": 0.1}, "#SPINE2": {"roll": 0.1}}, "leave one out"),
    ],
)  # fmt: skip
def test_limits_that_cannot_be_are_refused_and_the_walk_goes_on(asked: Any, words: str) -> None:
    stage = stage_of("wolf", SHIN)
    walk(stage, 0.5)
    herd = stage.herd
    node = int(herd.morphology.joint_node[herd.morphology.joint_name.index("Spine2")])
    asked = {name.replace("#SPINE2", f"#{node}"): said for name, said in asked.items()}
    before = stage.document, herd.morphology, herd.tables, stage.world
    angles = herd.state.spine_angle.copy()
    with pytest.raises(PolypodError, match=words):
        stage.apply(edited(stage.document, ["creature", "limit"], asked))
    after = stage.document, herd.morphology, herd.tables, stage.world
    assert all(a is b for a, b in zip(before, after, strict=True))
    assert np.array_equal(herd.state.spine_angle, angles)
    place = herd.state.position[0].copy()
    walk(stage, 0.5)
    assert np.linalg.norm(herd.state.position[0] - place) > 0.2


def test_a_creature_file_walks_with_the_same_limits(tmp_path: Path) -> None:
    stage = stage_of("wolf", EVERYWHERE)
    rigs = GivenRigs()
    file = tmp_path / "creature.toml"
    try:
        text = creature_toml(stage.document["creature"], rigs)
        file.write_text(text, encoding="utf-8")
        # And from there once more, through a studio that is opened on the file.
        again = Stage(default_document(rigs.point_to(file)), rigs.find)
        assert again.rig.said == EVERYWHERE
    finally:
        rigs.close()
    for read in (load_rig(file), again.herd.morphology):
        _same_limits(read, stage.herd.morphology)
    written = ["--record", str(tmp_path / "run.npz"), "-o", str(tmp_path / "walk.glb")]
    run = polypod("walk", str(file), "--seconds", "2", *written)
    assert run.code == 0, run.err
    record = read_record(tmp_path / "run.npz")
    knees = _inner_angles(record, stage.herd.morphology, "LeftHindPaw")
    # The knee's angle at rest, and what is allowed about it.
    rest = _inner_angles_at_rest(stage.herd.morphology, "LeftHindPaw")
    assert rest - 0.15 - 1e-5 <= knees.min() < knees.max() <= rest + 0.3 + 1e-5


def _same_limits(one: Any, other: Any) -> None:
    for part, name in (
        ("legs", "bend_limit"), ("legs", "hip_limit"), ("segments", "limit"),
        ("segments", "tail_limit"),
    ):  # fmt: skip
        mine, theirs = getattr(getattr(one, part), name), getattr(getattr(other, part), name)
        assert np.array_equal(mine, theirs, equal_nan=True), name


def _knee_rows(morphology: Any, foot: str) -> list[int]:
    leg = morphology.foot_name.index(foot)
    return [int(row) for row in morphology.legs.joint[leg, :3]]


def _angle(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    before, after = b - a, c - b
    cosine = (before * after).sum(-1)
    cosine = cosine / np.linalg.norm(before, axis=-1) / np.linalg.norm(after, axis=-1)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def _inner_angles(record: Any, morphology: Any, foot: str) -> np.ndarray:
    rows = _knee_rows(morphology, foot)
    names = [morphology.joint_name[row] for row in rows]
    at = [list(record.joint_name).index(name) for name in names]
    return _angle(*(record.joint_position[:, row] for row in at))


def _inner_angles_at_rest(morphology: Any, foot: str) -> np.ndarray:
    return _angle(*(morphology.joint_rest[row] for row in _knee_rows(morphology, foot)))


def test_a_scene_keeps_the_limits_and_the_command_line_has_them(tmp_path: Path) -> None:
    document = default_document("wolf")
    document["creature"]["limit"] = EVERYWHERE
    document["crowd"] = [{"rig": "ant", "count": 2}]
    file = tmp_path / "scene.toml"
    file.write_text(scene_text(document), encoding="utf-8")
    opened = document_of_scene(file, default_document(), WorldFiles(), own=False)
    assert opened["creature"] == document["creature"]
    assert opened["crowd"] == document["crowd"]
    assert read_scene(file).creatures[1].limit is None
    file.write_text('[[creature]]\nrig = "wolf"\n[creature.limit.LeftShin]\nbend = [1, -1]\n')
    with pytest.raises(PolypodError, match=r"number 1: limit\.LeftShin\.bend.*least first"):
        read_scene(file)
    file.write_text('[[creature]]\nrig = "wolf"\n[creature.limit.Shin]\nbend = [0, 1]\n')
    run = polypod("walk", "--scene", str(file), "--seconds", "1")
    assert_refused(run, "number 1", 'limit."Shin"', 'no node named "Shin"')


def test_what_a_document_says_takes_the_place_of_its_creature_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('rig = "wolf"\n[limit.LeftShin]\nbend = [-0.5, 1]\n[limit.Spine2]\nyaw = 0.1\n')
    rigs = GivenRigs()
    try:
        stage = Stage(default_document(rigs.point_to(file)), rigs.find)
        legs = stage.herd.morphology.legs
        assert stage.rig.said == {"LeftShin": {"bend": [-0.5, 1.0]}, "Spine2": {"yaw": 0.1}}
        assert np.nanmax(legs.bend_limit) == 1.0
        limit(stage, SHIN)
        written = tmp_path / "written.toml"
        written.write_text(creature_toml(stage.document["creature"], rigs), encoding="utf-8")
        _same_limits(load_rig(written), load_rig("wolf", limits=SHIN))
        _same_limits(stage.herd.morphology, load_rig("wolf", limits=SHIN))
        limit(stage, {})
        assert np.isnan(stage.herd.morphology.legs.bend_limit).all()
    finally:
        rigs.close()


@pytest.mark.parametrize("rig", ["spider", "wolf", "biped"])
def test_each_joint_is_listed_with_what_holds_by_default(rig: str) -> None:
    stage = stage_of(rig)
    listed = list_limits(stage.herd, stage.rig)
    names = [one["name"] for one in listed]
    assert len(set(names)) == len(names)
    for one in listed:
        for turn in one["turns"]:
            assert [turn["least"], turn["most"]] == pytest.approx(turn["default"])
    # What is said of any of them by the name that is told is taken, and told then.
    asked = {
        one["name"]: {
            turn["key"]: [0.9 * turn["least"], 0.9 * turn["most"]]
            if turn["key"] == "bend"
            else 0.9 * turn["most"]
            for turn in one["turns"]
        }
        for one in listed
    }
    limit(stage, asked)
    for one, before in zip(list_limits(stage.herd, stage.rig), listed, strict=True):
        for turn, old in zip(one["turns"], before["turns"], strict=True):
            assert turn["default"] == pytest.approx(old["default"])
            assert turn["most"] == pytest.approx(0.9 * old["most"]), one["name"]


class Heard:
    """A conductor, and what it tells."""

    def __init__(self, rig: str) -> None:
        self.told: list[dict[str, Any]] = []
        self.conductor = Conductor(stage_of(rig), self._hear)

    def _hear(self, event: Telling) -> None:
        if event.kind == "text":
            self.told.append(event.content)

    def edit(self, to: Any, gesture: str) -> None:
        self.told.clear()
        order = {"do": "edit", "at": ["creature", "limit"], "to": to, "gesture": gesture}
        obey(self.conductor, order)


def test_a_drag_is_one_step_of_undo_and_tells_limits_alone() -> None:
    heard = Heard("spider")
    conductor = heard.conductor
    skins = dict(conductor.drawn.skin_numbers)
    for most in (1.0, 0.9, 0.8):
        heard.edit({"LeftLeg2Tibia": {"bend": [-0.5, most]}}, "drag")
        told = {one["is"]: one for one in heard.told}
        assert {"limits", "document"} <= set(told) <= {"limits", "document", "verdict"}
        joint = next(one for one in told["limits"]["limits"] if one["name"] == "LeftLeg2Tibia")
        assert joint["turns"][0]["most"] == most
        fan = next(one for one in told["limits"]["fans"] if one["joint"] == joint["joint"])
        assert (fan["key"], fan["least"], fan["most"]) == ("bend", -0.5, most)
    assert conductor.drawn.skin_numbers == skins
    obey(conductor, {"do": "undo"})
    assert conductor.stage.document["creature"]["limit"] is None
    assert not conductor.history.can_undo
    assert np.isnan(conductor.stage.herd.morphology.legs.bend_limit).all()


def test_a_recording_ends_when_limits_change() -> None:
    heard = Heard("spider")
    obey(heard.conductor, {"do": "record", "on": True})
    heard.conductor.step(DT)
    heard.edit({"LeftLeg2Tibia": {"bend": [-0.5, 1.0]}}, "drag")
    heard.conductor.step(DT)
    assert any("limits" in one.get("why", "") for one in heard.told)
    assert heard.conductor.tape is not None
    assert not heard.conductor.tape.recording


@pytest.fixture(scope="module")
def walking() -> Stage:
    """Return a stage that a wolf has begun to walk on."""
    stage = stage_of("wolf")
    walk(stage, 1.0)
    return stage


angles = st.floats(-1.2, 1.2).map(lambda v: round(v, 3))
ranges = st.lists(angles, min_size=2, max_size=2, unique=True).map(sorted)
sizes = st.floats(0.01, 1.5).map(lambda v: round(v, 3))
hinges = st.sampled_from(["LeftShin", "LeftMetatarsus", "RightShin", "LeftForearm"])
hips = st.sampled_from(["LeftThigh", "RightThigh", "LeftUpperArm", "RightUpperArm"])
any_limits = st.builds(
    lambda bends, swings: {**bends, **swings},
    st.dictionaries(hinges, st.fixed_dictionaries({"bend": ranges}), max_size=2),
    st.dictionaries(hips, st.fixed_dictionaries({"flexion": sizes, "sideways": sizes}), max_size=4),
)


@settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(any_limits)
def test_what_is_taken_can_be_stood_with_and_what_is_not_says_why(
    walking: Stage, asked: dict[str, Any]
) -> None:
    before = walking.document
    why = None
    try:
        walking.apply(edited(before, ["creature", "limit"], asked))
    except PolypodError as error:
        why = str(error)
    if why is None:
        # As a restart would, or whoever opens the file.
        World().add(load_rig("wolf", limits=asked))
    else:
        assert re.search(r"cannot be limited so: .*(leg to|every foot)|must be from", why)
        assert walking.document is before
    walk(walking, 0.1)
    assert np.isfinite(walking.herd.state.joint_position).all()
