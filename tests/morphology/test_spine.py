"""Spines: the segments found in rigs of all kinds, and what rides on each."""

from __future__ import annotations

import base64
import json
from pathlib import Path

import numpy as np
import pytest
from authored_rigs import BACK, Rig, long_back, quadruped
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from polypod.errors import RigError
from polypod.morphology.describe import describe
from polypod.morphology.load import load_rig
from polypod.morphology.segments import nearest_bone
from polypod.morphology.spine import SpineTable
from polypod.morphology.types import Morphology
from polypod.report.arrays import matrices_of
from polypod.report.record import bones
from polypod.report.skin import flesh_of

FloatArray = NDArray[np.float64]

PAWS = tuple(f"{end}Upper.{side}:{end}Foot.{side}" for end in ("Hind", "Fore") for side in "LR")
CHAIN = ["Spine0", "Spine1", "Spine2", "Spine3", "Neck", "Head"]


def names_of(morphology: Morphology, rows: NDArray[np.int64]) -> list[str]:
    return [morphology.joint_name[row] for row in rows]


def seats(morphology: Morphology) -> dict[str, str]:
    """By the name of each joint that rides on a segment, the name of that segment's own joint."""
    table = morphology.segments
    own = names_of(morphology, np.concatenate([table.joint, table.tail_joint]))
    return {
        morphology.joint_name[row]: own[segment]
        for row, segment in enumerate(table.of_joint)
        if segment >= 0
    }


def assert_sound(morphology: Morphology) -> None:
    """Check what holds for the segments of any creature."""
    table, legs = morphology.segments, morphology.legs
    count, tail = len(table.joint), len(table.tail_joint)
    assert count != 1
    assert table.of_joint.shape == morphology.joint_node.shape
    assert table.of_leg.shape == legs.length.shape
    for array in table:
        assert not isinstance(array, np.ndarray) or array.flags.c_contiguous
    if count == 0:
        assert (table.of_joint == -1).all()
        assert (table.of_leg == -1).all()
        assert table.head == -1
        assert tail == 0
        return
    assert table.pivot_rest.shape == (count + 1, 3)
    assert table.tail_pivot_rest.shape == (tail + 1, 3)
    steps = np.diff(table.pivot_rest, axis=0)
    assert table.bone_length == pytest.approx(np.linalg.norm(steps, axis=1))
    assert (table.bone_length > 0.0).all()
    assert (table.tail_length > 0.0).all()
    assert table.of_girdle[0] == 0
    assert (np.diff(table.of_girdle) >= 0).all()
    assert table.neck == table.of_girdle[-1] + 1
    assert table.head == (count - 1 if table.neck < count else -1)
    if len(table.of_girdle) > 1:
        assert (steps[: table.neck, 2] > 0.0).all()
    assert (table.limit[0] == 0.0).all()
    assert (table.limit >= 0.0).all()
    assert (table.of_joint[table.joint] == np.arange(count)).all()
    assert (table.of_joint[table.tail_joint] == count + np.arange(tail)).all()
    assert (table.of_joint[legs.joint[legs.joint >= 0]] == -1).all()


Motion = tuple[FloatArray, FloatArray, FloatArray]  # a turn, where a pivot goes, the pivot at rest


def motions(table: SpineTable, turns: FloatArray) -> list[Motion]:
    """Return how each segment of spine and tail moves when it turns [S + T, 3, 3] on the last."""

    def follow(pivots: FloatArray, turn: FloatArray, begin: FloatArray, own: FloatArray) -> None:
        for s in range(len(pivots) - 1):
            turn = turn @ own[s]
            found.append((turn, begin, pivots[s]))
            begin = begin + turn @ (pivots[s + 1] - pivots[s])

    found: list[Motion] = []
    follow(table.pivot_rest, np.eye(3), table.pivot_rest[0], turns)
    first, place, rest = found[0]
    root = place + first @ (table.tail_pivot_rest[0] - rest)
    follow(table.tail_pivot_rest, first, root, turns[len(table.joint) :])
    return found


def bent(morphology: Morphology, seed: int) -> FloatArray:
    """Return the joints [J, 3], body frame, with every segment turned against the one behind it."""
    table, random = morphology.segments, np.random.default_rng(seed)
    count = len(table.joint) + len(table.tail_joint)
    quaternion = random.normal(size=(count, 4)) * [0.2, 0.2, 0.2, 0.0] + [0.0, 0.0, 0.0, 1.0]
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    moved, found = morphology.joint_rest.copy(), motions(table, matrices_of(quaternion))
    for row, segment in enumerate(table.of_joint):
        if segment >= 0:
            turn, place, rest = found[segment]
            moved[row] = place + turn @ (morphology.joint_rest[row] - rest)
    return moved


def assert_bones_stay_as_long(morphology: Morphology) -> None:
    """Check that the record's pairs of spine and tail are as far apart however the spine bends."""
    table = morphology.segments
    chain = {*table.joint.tolist(), *table.tail_joint.tolist()}
    pairs = np.array([pair for pair in bones(morphology).tolist() if set(pair) <= chain])
    assert len(pairs) >= len(chain) - 1 - (len(table.tail_joint) == 0) - 1
    for seed in range(3):
        length = [
            np.linalg.norm(place[pairs[:, 0]] - place[pairs[:, 1]], axis=1)
            for place in (morphology.joint_rest, bent(morphology, seed))
        ]
        assert length[1] == pytest.approx(length[0], rel=1e-9)


@pytest.mark.parametrize(
    ("name", "segments", "tail", "of_girdle"),
    [
        ("wolf", 8, 5, [0, 4]),
        ("lizard", 8, 7, [0, 5]),
        ("centaur", 12, 6, [0, 4, 8]),
        ("centipede", 21, 0, list(range(20))),
    ],
)
def test_built_in_creatures(name: str, segments: int, tail: int, of_girdle: list[int]) -> None:
    morphology = load_rig(name)
    table = morphology.segments
    assert_sound(morphology)
    assert_bones_stay_as_long(morphology)
    assert (len(table.joint), len(table.tail_joint)) == (segments, tail)
    assert table.of_girdle.tolist() == of_girdle
    assert tuple(table.joint.tolist()) == morphology.spine
    assert table.head == segments - 1
    assert table.hinge.tolist() == list(range(segments))
    # All that no leg carries rides on something: nothing is left behind when the spine bends.
    on_leg = np.isin(np.arange(len(table.of_joint)), morphology.legs.joint)
    for row, parent in enumerate(morphology.joint_parent):
        on_leg[row] |= parent >= 0 and on_leg[parent]
    on_leg[morphology.legs.foot_joint[morphology.legs.foot_joint >= 0]] = True
    assert (on_leg == (table.of_joint < 0)).all()
    # What BIOMECHANICS 4 has animals do, limits allow: a fast galloper's sagittal range of 60
    # degrees, and 18 either way at a lizard's pelvis.
    trunk = np.degrees(table.limit[: table.of_girdle[-1] + 1].sum(axis=0))
    if name == "wolf":
        assert trunk[1] == pytest.approx(30.0)
    if name == "lizard":
        assert trunk[0] == pytest.approx(60.0)


@pytest.mark.parametrize("name", ["wolf", "lizard", "centaur", "centipede"])
def test_spines_are_found_in_files_without_names(name: str, tmp_path: Path) -> None:
    """Also where a jaw hangs on the head: it is no part of the spine."""
    path, known = tmp_path / "nameless.gltf", load_rig(name)
    content = json.loads(json.dumps(known.source.document.json))
    for node in content["nodes"]:
        del node["name"]
    data = base64.b64encode(known.source.document.binary).decode()
    content["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{data}"
    path.write_text(json.dumps(content))
    found = load_rig(path, forward="+z")
    for rows in ("joint", "tail_joint"):
        nodes = found.joint_node[getattr(found.segments, rows)]
        assert nodes.tolist() == known.joint_node[getattr(known.segments, rows)].tolist()
    assert found.segments.of_girdle.tolist() == known.segments.of_girdle.tolist()


@pytest.mark.parametrize("name", ["wolf", "lizard", "centaur", "centipede"])
@pytest.mark.parametrize(("axis", "sign"), [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)])
def test_the_skin_of_built_in_creatures_bends_smoothly(name: str, axis: int, sign: float) -> None:
    """With all joints of spine and tail at their limits at once, no edge is torn or crushed."""
    morphology = load_rig(name)
    table, legs = morphology.segments, morphology.legs
    angle = 0.5 * sign * np.concatenate([table.limit, table.tail_limit])[:, axis]
    about = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])[axis]
    quaternion = np.concatenate([np.sin(angle)[:, None] * about, np.cos(angle)[:, None]], axis=1)
    found = motions(table, matrices_of(quaternion))
    seat = table.of_joint.copy()
    for k, segment in enumerate(table.of_leg):
        joints = np.append(legs.joint[k], legs.foot_joint[k])
        seat[joints[joints >= 0]] = segment
    for row, parent in enumerate(morphology.joint_parent):
        seat[row] = seat[parent] if seat[row] < 0 else seat[row]
    for flesh in flesh_of(morphology):
        moved = np.zeros((len(flesh.place), 3))
        for w in range(flesh.place.shape[1]):
            rides = seat[flesh.row[:, w]]
            for segment in np.unique(rides):
                turn, place, rest = found[segment]
                rows = np.flatnonzero(rides == segment)
                to = place + (flesh.place[rows, w] - rest) @ turn.T
                moved[rows] += flesh.weight[rows, w, None] * to
        edge = np.concatenate([flesh.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
        before, after = (
            np.linalg.norm(place[edge[:, 0]] - place[edge[:, 1]], axis=1)
            for place in (flesh.place[:, 0], moved)
        )
        ratio = (after / before)[before > 0.2 * np.median(before)]
        assert ratio.min() > 0.2
        assert ratio.max() < 2.5
        assert np.percentile(ratio, 99.0) < 1.6


@pytest.mark.parametrize("name", ["spider", "ant", "crab", "pentapod", "biped"])
def test_a_trunk_with_a_single_girdle_is_rigid(name: str) -> None:
    morphology = load_rig(name)
    assert len(morphology.segments.joint) == 0
    assert_sound(morphology)


def test_a_spine_that_is_named_bends_on_a_single_girdle_too() -> None:
    morphology = load_rig("biped", spine=["Pelvis", "Chest", "Neck", "Head"])
    assert_sound(morphology)
    table = morphology.segments
    assert names_of(morphology, table.joint) == ["Pelvis", "Chest", "Neck", "Head"]
    assert (table.neck, table.head) == (1, 3)
    seat = seats(morphology)
    assert seat["Spine2"] == "Pelvis"
    assert seat["LeftHand"] == "Chest"


@pytest.mark.parametrize("root", [0, 1, 2, 3])
@pytest.mark.parametrize("named", [False, True])
def test_a_back_may_hang_on_any_of_its_joints(tmp_path: Path, root: int, named: bool) -> None:
    """From the hips, from the chest both ways, or between: the same segments, the same riders."""
    path = long_back(root).write(tmp_path)
    morphology = load_rig(path, spine=CHAIN if named else None)
    assert_sound(morphology)
    assert_bones_stay_as_long(morphology)
    table = morphology.segments
    centre = np.array([0.0, 0.6, 0.0])
    assert names_of(morphology, table.joint) == CHAIN
    assert names_of(morphology, table.tail_joint) == ["Tail1", "Tail2"]
    assert table.pivot_rest[1:5] == pytest.approx(BACK[1:] - centre, abs=1e-6)
    assert table.pivot_rest[0, 2] == pytest.approx(-0.44 if root == 0 else -0.4, abs=1e-6)
    assert table.of_girdle.tolist() == [0, 3]
    assert table.of_leg.tolist() == [0, 0, 3, 3]
    assert table.hinge.tolist() == [s + (s < root) for s in range(6)]
    seat = seats(morphology)
    assert "Root" not in seat
    assert seat["HindGirdle.L"] == "Spine0"
    assert seat["ForeGirdle.R"] == "Spine3"
    assert seat["Ear.L"] == seat["Ear.R"] == "Head"


def test_joints_of_the_trunk_may_be_siblings(tmp_path: Path) -> None:
    morphology = load_rig(long_back(flat=True).write(tmp_path))
    assert_sound(morphology)
    assert_bones_stay_as_long(morphology)
    table = morphology.segments
    assert names_of(morphology, table.joint) == CHAIN
    assert table.of_leg.tolist() == [0, 0, 3, 3]
    seat = seats(morphology)
    assert seat["ForeGirdle.L"] == "Spine3"
    assert seat["HindGirdle.R"] == "Spine0"
    assert seat["Ear.R"] == "Head"
    told = " ".join(morphology.guesses)
    assert (
        'HindUpper.L, HindUpper.R: hang on no joint of the spine, so they go with "Spine0"' in told
    )


@pytest.mark.parametrize("root", [0, 3])
def test_legs_that_all_hang_on_one_joint_go_with_what_is_near(tmp_path: Path, root: int) -> None:
    morphology = load_rig(long_back(root, legs_on_root=True).write(tmp_path))
    assert morphology.segments.of_girdle.tolist() == [0, 3]
    far = "Fore" if root == 0 else "Hind"
    assert [guess for guess in morphology.guesses if f"{far}Upper.L, {far}Upper.R" in guess]
    assert seats(morphology)[f"{far}Girdle.L"] == ("Spine3" if root == 0 else "Spine0")


def test_hips_behind_the_spine_are_where_it_begins(tmp_path: Path) -> None:
    """The pelvis's joint is ahead of the hips, and a bone leads back from there to the tail."""
    rig = long_back()
    for bone in rig.bones:
        if bone.name == "Spine0":
            bone.place = (0.0, 0.62, -0.24)
    rig.add("Sacrum", "Root", (0.0, 0.62, -0.25), tip=(0.0, 0.62, -0.48), width=0.08)
    for bone in rig.bones:
        if bone.name in ("Tail1", "HindGirdle.L", "HindGirdle.R"):
            bone.parent = "Sacrum"
    morphology = load_rig(rig.write(tmp_path))
    assert_sound(morphology)
    assert_bones_stay_as_long(morphology)
    table = morphology.segments
    assert names_of(morphology, table.joint) == ["Sacrum", *CHAIN]
    assert table.pivot_rest[0, 2] == pytest.approx(-0.4)
    assert table.of_girdle.tolist() == [0, 4]
    assert names_of(morphology, table.tail_joint) == ["Tail1", "Tail2"]


def test_what_is_named_behind_the_hips_is_tail(tmp_path: Path) -> None:
    path = long_back().write(tmp_path)
    morphology = load_rig(path, spine=["Tail2", "Tail1", *CHAIN])
    assert_sound(morphology)
    assert names_of(morphology, morphology.segments.joint) == CHAIN
    assert names_of(morphology, morphology.segments.tail_joint) == ["Tail1", "Tail2"]


def one_bone(head: bool) -> Rig:
    """A beast whose trunk is one bone."""
    rig = long_back(head=False, tail=False)
    body = Rig([bone for bone in rig.bones if not bone.name.startswith("Spine")])
    body.bones[0].parent = None
    body.add("Body", "Root", (0, 0.65, 0.0), box=((-0.1, 0.55, -0.5), (0.1, 0.75, 0.5)))
    if head:
        body.add("Head", "Body", (0, 0.7, 0.5), box=((-0.06, 0.65, 0.5), (0.06, 0.8, 0.75)))
    for bone in body.bones:
        if bone.parent in ("Spine0", "Spine3"):
            bone.parent = "Body"
    return body


def test_a_trunk_of_one_bone_does_not_bend_between_its_girdles(tmp_path: Path) -> None:
    morphology = load_rig(one_bone(head=True).write(tmp_path))
    assert_sound(morphology)
    table = morphology.segments
    assert names_of(morphology, table.joint) == ["Body", "Head"]
    assert table.of_girdle.tolist() == [0, 0]
    assert (table.neck, table.head) == (1, 1)
    assert [
        guess for guess in morphology.guesses if 'no joint between its girdles but "Body"' in guess
    ]
    # Without a head nothing bends at all.
    rigid = load_rig(one_bone(head=False).write(tmp_path))
    assert_sound(rigid)
    assert len(rigid.segments.joint) == 0


def test_a_spine_without_a_head_ends_at_the_chest(tmp_path: Path) -> None:
    for spine in (None, ["Spine0", "Spine1", "Spine2", "Spine3"]):
        morphology = load_rig(long_back(head=False).write(tmp_path), spine=spine)
        assert_sound(morphology)
        table = morphology.segments
        assert names_of(morphology, table.joint) == CHAIN[:4]
        assert (table.neck, table.head) == (4, -1)


def test_joints_at_one_place_are_one_segment(tmp_path: Path) -> None:
    rig = long_back()
    at = next(i for i, bone in enumerate(rig.bones) if bone.name == "Spine2")
    double = Rig(rig.bones[: at + 1]).add("Twin", "Spine2", BACK[2], tip=BACK[3], width=0.05).bones
    rig.bones = double + rig.bones[at + 1 :]
    for bone in rig.bones:
        if bone.name == "Spine3":
            bone.parent = "Twin"
    morphology = load_rig(rig.write(tmp_path))
    assert_sound(morphology)
    table = morphology.segments
    assert len(table.joint) == 6
    assert len(morphology.spine) == 7
    assert seats(morphology)["Spine2"] in ("Spine2", "Spine1", "Twin")


def test_what_carries_no_skin_and_hangs_nowhere_stays_with_the_body(tmp_path: Path) -> None:
    rig = long_back().add("Pole.L", "Root", (0.2, 0.3, 1.0)).add("Mark", "Neck", (0, 0.9, 0.6))
    morphology = load_rig(rig.write(tmp_path))
    seat = seats(morphology)
    assert "Pole.L" not in seat
    assert "Root" not in seat
    assert seat["Mark"] == "Neck"


FILE = """
rig = "authored.glb"
spine = ["Spine0", "Spine1", "Spine2", "Spine3", "Neck", "Head"]
"""


def creature(folder: Path, text: str, root: int = 0) -> Path:
    long_back(root).write(folder)
    path = folder / "beast.toml"
    path.write_text(FILE + text)
    return path


def test_a_creature_file_sets_limits_and_the_tail(tmp_path: Path) -> None:
    text = 'tail = ["Tail2"]\n[limit.Spine2]\nyaw = 0.25\nroll = 0\n[limit.Tail2]\npitch = 0.5\n'
    usual = load_rig(creature(tmp_path, "")).segments
    table = load_rig(creature(tmp_path, text)).segments
    assert table.limit[2] == pytest.approx([0.25, usual.limit[2, 1], 0.0])
    assert np.delete(table.limit, 2, axis=0) == pytest.approx(np.delete(usual.limit, 2, axis=0))
    assert len(table.tail_joint) == 1
    assert table.tail_limit[0, 1] == 0.5
    # Where the file leads backward a joint turns against the one ahead of it.
    back = load_rig(creature(tmp_path, "[limit.Spine2]\nyaw = 0.25\n", root=3)).segments
    assert back.limit[3, 0] == 0.25
    assert back.limit[2, 0] != 0.25
    none = load_rig(creature(tmp_path, "tail = []\n")).segments
    assert len(none.tail_joint) == 0
    rigid = tmp_path / "rigid.toml"
    rigid.write_text('rig = "authored.glb"\nspine = []\n')
    assert len(load_rig(rigid).segments.joint) == 0


def test_the_description_says_what_bends_and_what_rides_where(tmp_path: Path) -> None:
    told = describe(load_rig(creature(tmp_path, "[limit.Spine2]\nyaw = 0.25\nroll = 0\n")))
    for said in (
        "spine: Spine0 > Spine1 > Spine2 > Spine3 > Neck > Head\n",
        "carries the legs to HindFoot.L, HindFoot.R; with it HindGirdle.L, HindGirdle.R\n",
        "degrees, neck\n",
        "degrees, head; with it Ear.L, Ear.R\n",
        "degrees, tail\n",
    ):
        assert said in told
    assert [
        line for line in told.splitlines() if line.startswith("  Spine2") and "turns 14 " in line
    ]
    rigid = tmp_path / "rigid.toml"
    rigid.write_text('rig = "authored.glb"\nspine = []\n')
    assert "spine: none; the trunk moves as one piece" in describe(load_rig(rigid))


WRONG = {
    'tail = ["Head"]\n': r'tail: "Head" belongs to the spine',
    'tail = ["HindUpper.L"]\n': r'tail: "HindUpper.L" belongs to a leg',
    'tail = ["Tail1", "Tail1"]\n': r'tail: "Tail1" is named twice',
    'tail = ["Tial1"]\n': r'tail: has no node named "Tial1".*Tail1',
    "tail = 1\n": r"tail: must be a list of texts",
    "[limit.Spine2]\nbend = [0, 1]\n": r"bend: is not for a joint of spine or tail; valid is yaw",
    "[limit.Spine2]\nyaw = -0.1\n": r"yaw: must be radians, 0 or more and at most pi",
    "[limit.Spine0]\nyaw = 0.1\n": r'limit."Spine0": is no joint that turns.*Spine1.*Tail2',
    '[limit."HindUpper.L"]\nyaw = 0.1\n': r"yaw: is not for the first joint of a leg",
}


@pytest.mark.parametrize("text", list(WRONG))
def test_what_a_creature_file_may_not_say_of_a_spine(tmp_path: Path, text: str) -> None:
    with pytest.raises(RigError, match=WRONG[text]) as caught:
        load_rig(creature(tmp_path, text))
    assert "\n" not in str(caught.value)


@given(
    joint=st.sampled_from(["Spine0", "Spine1", "Spine3", "Head", "Tail2", "HindLower.L", "Ear.L"]),
    key=st.sampled_from(["yaw", "pitch", "roll"]),
    value=st.one_of(st.floats(), st.integers(-5, 5), st.booleans(), st.text(max_size=3)),
)
@settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_any_limit_is_taken_or_refused_in_a_sentence(
    tmp_path: Path, joint: str, key: str, value: object
) -> None:
    if isinstance(value, bool):
        said = str(value).lower()
    else:
        said = repr(value) if isinstance(value, int | float) else "'''" + value + "'''"  # type: ignore[operator]
    path = creature(tmp_path, f'[limit."{joint}"]\n{key} = {said}\n')
    turns = joint not in ("Spine0", "HindLower.L", "Ear.L")
    angle = isinstance(value, int | float) and not isinstance(value, bool)
    if not (turns and angle and 0.0 <= value <= np.pi):  # type: ignore[operator]
        with pytest.raises(RigError):
            load_rig(path)
        return
    table = load_rig(path).segments
    found = np.concatenate([table.limit[:, ["yaw", "pitch", "roll"].index(key)],
                            table.tail_limit[:, ["yaw", "pitch", "roll"].index(key)]])  # fmt: skip
    assert float(value) in found.tolist()


@given(
    count=st.integers(2, 7),
    root=st.integers(0, 6),
    rise=st.floats(-0.3, 0.3),
)
@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_named_joints_of_any_trunk_give_a_sound_table(
    tmp_path: Path, count: int, root: int, rise: float
) -> None:
    """Any of a back's joints, from back to head, in a file hung on any of them."""
    rig = long_back(root % 4)
    for bone in rig.bones:
        if bone.name == "Head":
            bone.place = (0.0, 0.82 + rise, 0.65)
    chain = [*CHAIN[: count - 1], "Head"] if count < 7 else CHAIN
    morphology = load_rig(rig.write(tmp_path), spine=list(dict.fromkeys(chain)))
    assert_sound(morphology)
    assert_bones_stay_as_long(morphology)


def test_the_nearest_bone_is_that_at_the_least_distance_seen_from_the_side() -> None:
    pivot = np.array([[0, 0, 0], [0, 0, 1], [0, 1, 2]], float)
    assert nearest_bone(pivot, np.array([5.0, 0.3, 0.5])) == 0
    assert nearest_bone(pivot, np.array([0.0, 0.6, 1.4])) == 1
    assert nearest_bone(pivot, np.array([0.0, -9.0, 0.9])) == 0


@pytest.mark.parametrize(
    ("name", "of_girdle", "tail", "seat"),
    [
        ("khronos_fox/Fox.glb", [0, 2], 3, {}),
        (
            "quaternius/horse.glb",
            [0, 2],
            7,
            {"Ear4.L": "Head", "FrontShoulder.L": "Torso2", "BackShoulder.R": "Back"},
        ),
        (
            "quaternius/triceratops.glb",
            [0, 3],
            5,
            {"BackLeg.L": "Back", "FrontLeg.R": "Shoulders"},
        ),
    ],
)
def test_spines_of_other_peoples_rigs(shared_rig, name, of_girdle, tail, seat) -> None:  # type: ignore[no-untyped-def]
    morphology = load_rig(shared_rig(name))
    assert_sound(morphology)
    assert_bones_stay_as_long(morphology)
    table = morphology.segments
    assert table.of_girdle.tolist() == of_girdle
    assert len(table.tail_joint) == tail
    assert table.head == len(table.joint) - 1
    assert seat.items() <= seats(morphology).items()


def test_a_head_may_be_low_and_a_root_of_its_own(tmp_path: Path) -> None:
    """A beast that grazes, in a flat file whose last node is named as a head, too."""
    rig = long_back(flat=True)
    for bone in rig.bones:
        if bone.name == "Head":
            bone.parent, bone.place = None, (0.0, 0.1, 0.8)
            bone.box = ((-0.06, 0.0, 0.75), (0.06, 0.15, 1.0))
        if bone.name == "Neck":
            bone.tip = (0.0, 0.15, 0.78)
    rig.add("HeadMarker", "Root", (0.0, 0.1, 1.0), joint=False)
    morphology = load_rig(rig.write(tmp_path))
    assert_sound(morphology)
    assert names_of(morphology, morphology.segments.joint) == CHAIN


def test_a_quadruped_with_two_joints_in_its_trunk(tmp_path: Path) -> None:
    morphology = load_rig(quadruped(girdle=True).write(tmp_path), legs=PAWS)
    assert_sound(morphology)
    table = morphology.segments
    assert names_of(morphology, table.joint) == ["Pelvis", "Chest", "Neck", "Head"]
    assert names_of(morphology, table.tail_joint) == ["Tail1", "Tail2"]
