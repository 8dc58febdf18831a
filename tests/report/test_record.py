"""The record: what is in the file, that it comes back, that bad files are refused."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import synthetic

from polypod.errors import SettingError
from polypod.report.files import replacing
from polypod.report.record import Record, bones, read_record, write_record

F, K, J, B, O = 31, 6, 13, 6, 2  # frames, feet, joints, bones, obstacles  # noqa: E741
SHAPES = {
    "time": ("<f8", (F,)),
    "foot_name": ("<U5", (K,)),
    "foot_position": ("<f8", (F, K, 3)),
    "foot_target": ("<f8", (F, K, 3)),
    "foot_stance": ("|b1", (F, K)),
    "foot_support": ("<i8", (F, K)),
    "foot_node": ("<i8", (K,)),
    "foot_offset": ("<f8", (K, 3)),
    "leg_length": ("<f8", (K,)),
    "body_position": ("<f8", (F, 3)),
    "body_rotation": ("<f8", (F, 4)),
    "joint_node": ("<i8", (J,)),
    "joint_name": ("<U5", (J,)),
    "joint_position": ("<f8", (F, J, 3)),
    "bone": ("<i8", (B, 2)),
    "obstacle_position": ("<f8", (F, O, 3)),
    "obstacle_rotation": ("<f8", (F, O, 4)),
    "activity": ("<i8", (F,)),
    "gait": ("<U6", (F,)),
}


@pytest.fixture
def recording():
    return synthetic.walk(seconds=1.0, obstacle_count=O)


def test_file_holds_exactly_the_arrays_of_the_format(recording, tmp_path):
    path = tmp_path / "run.npz"
    write_record(recording, path)
    with np.load(path, allow_pickle=False) as archive:
        found = {name: (archive[name].dtype.str, archive[name].shape) for name in archive.files}
    assert found == SHAPES
    assert set(SHAPES) == set(Record._fields)


def test_what_is_written_is_read_back(recording, tmp_path):
    path = tmp_path / "run.npz"
    write_record(recording, path)
    record = read_record(path)
    for name in ("time", "foot_position", "foot_target", "foot_stance", "body_rotation"):
        assert np.array_equal(getattr(record, name), getattr(recording, name))
    assert tuple(record.foot_name) == recording.morphology.foot_name
    assert np.array_equal(record.joint_position, recording.joint_position)


def test_equal_walks_give_equal_bytes(recording, tmp_path):
    write_record(recording, tmp_path / "a.npz")
    write_record(synthetic.walk(seconds=1.0, obstacle_count=O), tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_bones_are_hip_to_knee_of_every_leg(recording):
    legs = recording.morphology.legs
    assert bones(recording.morphology).tolist() == legs.joint.tolist()


def test_detached_foot_is_a_bone_at_the_effector_count_and_spine_pairs_follow():
    body = synthetic.morphology()
    # Foot 0 is said to be an oriented joint of its own: the other leg's hip row stands for it.
    foot = np.full(6, -1)
    foot[0] = body.legs.joint[5, 0]
    changed = dataclasses.replace(body, legs=body.legs._replace(foot_joint=foot), spine=(0, 1, 3))
    pairs = bones(changed).tolist()
    hip, knee = body.legs.joint[0]
    assert [hip, knee] in pairs
    assert [knee, int(foot[0])] in pairs
    assert [0, 1] in pairs
    assert [1, 3] in pairs
    assert len(pairs) == 6 + 1 + 2


def test_recording_refuses_arrays_that_do_not_fit(recording):
    with pytest.raises(ValueError, match="foot_stance has shape"):
        dataclasses.replace(recording, foot_stance=recording.foot_stance[:, :3])


def test_missing_folder_is_said(recording, tmp_path):
    with pytest.raises(SettingError, match=r"the folder .*nowhere does not exist"):
        write_record(recording, tmp_path / "nowhere" / "run.npz")


@pytest.mark.parametrize("fault", [ValueError, KeyboardInterrupt])
def test_interrupted_write_leaves_the_old_file(tmp_path, fault):
    path = tmp_path / "run.npz"
    path.write_text("old")

    def interrupted():
        with replacing(path) as temporary:
            temporary.write_text("half")
            raise fault

    with pytest.raises(fault):
        interrupted()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def broken(recording, tmp_path, **changes):
    """Write a record with some arrays replaced, or left out where None."""
    path = tmp_path / "run.npz"
    write_record(recording, path)
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    arrays.update(changes)
    np.savez(path, **{name: values for name, values in arrays.items() if values is not None})
    return path


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bone": None}, "has no array bone"),
        ({"foot_stance": np.zeros((F, K))}, "the array foot_stance is float64"),
        ({"foot_target": np.full((F, K, 3), np.nan)}, "foot_target holds numbers that are not"),
        ({"time": np.zeros(F)}, "the array time does not rise"),
        ({"bone": np.array([[0, J]])}, f"beyond the {J} there are"),
        ({"time": np.array(1.0)}, "the array time is float64"),
        ({"foot_name": np.array([{}], object)}, "is not a record of plain arrays"),
    ],
)
def test_records_that_are_none_are_refused(recording, tmp_path, changes, words):
    with pytest.raises(SettingError, match=words):
        read_record(broken(recording, tmp_path, **changes))


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04 cut off"])
def test_files_that_are_no_archive_are_refused(tmp_path, content):
    path = tmp_path / "run.npz"
    path.write_bytes(content)
    with pytest.raises(SettingError, match="is not a record of plain arrays"):
        read_record(path)
    with pytest.raises(SettingError, match="there is no record file"):
        read_record(tmp_path / "other.npz")
