"""What goes over the wire, read back by its description in docs/studio-protocol.md."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
import pytest

from polypod.morphology.load import load_rig
from polypod.report.arrays import rotate_all
from polypod.studio.arrays import pack_arrays
from polypod.studio.frames import FOCUS, FOOT, Focus, Motion, MotionMeter, pack_frame
from polypod.studio.meshes import pack_skin
from polypod.world import World

TYPES = {"f4": "<f4", "u4": "<u4", "u2": "<u2", "u1": "u1"}


def unpacked(message: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    kind, length = struct.unpack_from("<II", message)
    assert kind == 2
    head = json.loads(message[8 : 8 + length])
    at, arrays = 8 + length, {}
    for one in head["arrays"]:
        count = int(np.prod(one["shape"]))
        array = np.frombuffer(message, TYPES[one["type"]], count, at)
        arrays[one["name"]] = array.reshape(one["shape"])
        at += -(-array.nbytes // 4) * 4
    assert at == len(message)
    return head, arrays


def test_named_arrays_come_back_as_they_went() -> None:
    given = {
        "a": np.arange(7, dtype=np.uint8),
        "b": np.arange(6, dtype=np.float32).reshape(2, 3),
        "c": np.zeros((0, 3), np.uint32),
        "d": np.arange(3, dtype=np.uint16),
    }
    head, arrays = unpacked(pack_arrays("some", given, more="words"))
    assert (head["name"], head["more"]) == ("some", "words")
    for name, array in given.items():
        assert np.array_equal(arrays[name], array)
        assert arrays[name].shape == array.shape


@pytest.mark.parametrize("rig", ["spider", "lizard"])
def test_a_skin_posed_as_the_page_does_is_where_the_pictures_have_it(rig: str) -> None:
    morphology = load_rig(rig)
    head, skin = unpacked(pack_skin(morphology))
    assert head["joints"] == len(morphology.joint_node) + 1
    assert np.allclose(skin["weight"].sum(axis=1), 1.0, atol=1e-5)
    assert skin["joint"].max() < head["joints"]
    assert skin["triangles"].max() < len(skin["place"])
    assert np.allclose(np.linalg.norm(skin["normal"], axis=1), 1.0, atol=1e-4)

    world = World(threads=1)
    herd = world.add(morphology, 2, position=[[0.0, 0.0], [3.0, 0.0]], speed=0.2)
    for _ in range(20):
        world.step(1.0 / 30.0)
    frame = pack_frame(
        7,
        1.25,
        [herd],
        np.zeros((0, 7)),
        Focus(0, 1),
        Motion(1.0, np.ones(len(morphology.foot_name))),
    )
    kind, number, time, kinds, obstacles, feet, tape = struct.unpack_from("<IIdIIII", frame)
    assert (kind, number, time, kinds, obstacles, tape) == (1, 7, 1.25, 1, 0, 0)
    count, joints = struct.unpack_from("<II", frame, 32)
    assert (count, joints) == (2, head["joints"])
    floats = np.frombuffer(frame, "<f4", offset=40)
    assert len(floats) == 7 * count * (1 + joints) + FOCUS + FOOT * feet
    pose = floats[7 * count : 7 * count * (1 + joints)].reshape(count, joints, 7)

    from polypod.recording import add_frame
    from polypod.report.record import Recorder
    from polypod.report.skin import flesh_of
    from polypod.report.skin import pose as posed

    recorder = Recorder(morphology, 0)
    add_frame(recorder, world, herd, 1)
    recording = recorder.finish()
    expected = np.concatenate([posed(part, recording, 0) for part in flesh_of(morphology)])
    drawn = np.zeros_like(expected)
    for w in range(4):
        joint = pose[1, skin["joint"][:, w]]
        moved = rotate_all(joint[:, :4].astype(float), skin["place"].astype(float)) + joint[:, 4:]
        drawn += skin["weight"][:, w, None] * moved
    assert np.abs(drawn - expected).max() < 2e-3 * herd.tables.leg_length
    # A foot in focus is where its sole is.
    first = floats[-FOOT * feet :].reshape(feet, FOOT)
    assert np.allclose(first[:, :3], herd.state.foot_reached[1], atol=1e-5)
    assert np.array_equal(first[:, 9] > 0.5, ~herd.state.swinging[1])


def test_a_free_fall_weighs_nothing() -> None:
    morphology = load_rig("spider")
    herd = World(threads=1).add(morphology)
    meter, dt = MotionMeter(), 1.0 / 60.0
    for n in range(4):
        herd.state.position[0, 1] = 2.0 - 0.5 * 9.81 * (n * dt) ** 2
        motion = meter.note(herd, 0, dt)
    assert motion.force == pytest.approx(0.0, abs=1e-9)
