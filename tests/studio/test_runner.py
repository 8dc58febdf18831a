"""The simulation's thread: orders, frames, time, the tape."""

from __future__ import annotations

import struct
import threading
import time
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest

from polypod.errors import SettingError
from polypod.rigs.export import glb_bytes
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.playback import Playback
from polypod.studio.document import default_document
from polypod.studio.orders import ORDERS, judge_order
from polypod.studio.outbox import Telling
from polypod.studio.runner import Runner

PATIENCE = 240.0  # s: a cold start compiles


@pytest.fixture(scope="module")
def runner() -> Iterator[Runner]:
    runner = Runner(default_document(), lambda name: name)
    runner.start()
    assert runner.ready.wait(PATIENCE)
    yield runner
    runner.stop()


def give(runner: Runner, **order: Any) -> str | None:
    done = threading.Event()
    words: list[str | None] = []

    def answer(why: str | None) -> None:
        words.append(why)
        done.set()

    judge_order(order)
    runner.order(order, answer)
    assert done.wait(PATIENCE)
    return words[0]


def hear(runner: Runner, kind: str, count: int) -> list[Any]:
    heard: list[Any] = []
    enough = threading.Event()

    def listen(event: Telling) -> None:
        if event.kind == kind and len(heard) < count:
            heard.append(event.content)
        if len(heard) >= count:
            enough.set()

    stop = runner.listen(listen)
    assert enough.wait(PATIENCE)
    stop()
    return heard


def test_a_new_tab_is_told_all_it_needs(runner: Runner) -> None:
    said = [message["is"] for message in runner.greeting()]
    assert said == [
        "welcome", "creature", "kinds", "files", "document", "clock", "verdict", "tape", "backdrop",
    ]  # fmt: skip
    kinds = runner.greeting()[2]
    assert runner.skin(kinds["kinds"][0]["skin"])
    assert runner.ground(kinds["ground"])
    assert runner.skin(10_000) is None


def test_frames_follow_each_other_a_step_apart(runner: Runner) -> None:
    assert give(runner, do="clock", playing=True, rate=1.0) is None
    frames = hear(runner, "frame", 6)
    heads = [struct.unpack_from("<IId", frame) for frame in frames]
    assert [b[1] - a[1] for a, b in pairwise(heads)] == [1] * 5
    for a, b in pairwise(heads):
        assert b[2] - a[2] == pytest.approx(1.0 / 60.0)


def test_paused_it_stands_and_goes_on_by_steps(runner: Runner) -> None:
    assert give(runner, do="clock", playing=False) is None
    before = runner.call(lambda conductor: conductor.stage.world.time).result(PATIENCE)
    time.sleep(0.1)
    assert runner.call(lambda conductor: conductor.stage.world.time).result(PATIENCE) == before
    assert give(runner, do="clock", steps=3) is None
    after = runner.call(lambda conductor: conductor.stage.world.time).result(PATIENCE)
    assert after - before == pytest.approx(3.0 / 60.0)


def test_lost_time_is_made_up_for_evenly(runner: Runner) -> None:
    assert give(runner, do="clock", playing=True, rate=1.0) is None
    begun: list[float] = []

    def watch(conductor: Any) -> None:
        step = conductor.step

        def stepped(dt: float) -> None:
            begun.append(time.perf_counter())
            if len(begun) == 5:
                time.sleep(0.08)
            step(dt)

        conductor.step = stepped

    runner.call(watch).result(PATIENCE)
    hear(runner, "frame", 20)
    runner.call(lambda conductor: conductor.__dict__.pop("step")).result(PATIENCE)
    # Five steps are due after the long one; they come one by one.
    assert min(b - a for a, b in pairwise(begun)) > 0.9 / (60.0 * 1.5)


def test_what_the_planner_sees_is_told_again_only_when_something_moves(runner: Runner) -> None:
    assert give(runner, do="clock", playing=False) is None
    told: list[str] = []
    stop = runner.listen(lambda event: told.append(event.name) if event.kind == "arrays" else None)
    runner.watched(frozenset({"cells"}))

    def rest(conductor: Any) -> None:
        for _ in range(3):
            conductor.rest()
            time.sleep(0.21)  # longer than between two tellings

    runner.call(rest).result(PATIENCE)
    assert told == ["cells"]
    assert give(runner, do="clock", steps=1) is None
    runner.call(rest).result(PATIENCE)
    stop()
    runner.watched(frozenset())
    assert told == ["cells", "cells"]


def test_orders_are_answered_and_undone(runner: Runner) -> None:
    assert give(runner, do="edit", at=["command", "speed"], to=0.6) is None
    refusal = give(runner, do="edit", at=["command", "speed"], to=60.0)
    assert refusal is not None
    assert refusal.startswith("speed is 60; it must be from 0 to")
    speed = runner.call(lambda conductor: conductor.stage.document["command"]["speed"])
    assert speed.result(PATIENCE) == 0.6
    assert give(runner, do="undo") is None
    speed = runner.call(lambda conductor: conductor.stage.document["command"]["speed"])
    assert speed.result(PATIENCE) is None
    assert give(runner, do="redo") is None
    assert give(runner, do="redo") == "there is nothing to redo"


def test_a_gait_by_its_name_is_written_as_disks(runner: Runner) -> None:
    assert give(runner, do="edit", at=["command", "blend_cycles"], to=2.0) is None
    assert give(runner, do="gait", name="tripod") is None
    document = runner.call(lambda conductor: conductor.stage.document).result(PATIENCE)
    assert document["command"]["blend_cycles"] == 2.0
    gait = document["gait"]
    assert gait["name"] == "tripod"
    assert len(gait["start"]) == 8
    refusal = give(runner, do="gait", name="moonwalk")
    assert refusal is not None
    assert "no gait 'moonwalk'" in refusal
    assert give(runner, do="gait", name=None) is None


def test_what_is_recorded_is_scrubbed_and_exported_as_it_was(runner: Runner) -> None:
    give(runner, do="clock", playing=False)
    assert give(runner, do="record", on=True) is None
    assert give(runner, do="clock", steps=30) is None
    assert give(runner, do="record", on=False) is None
    walk = runner.call(lambda conductor: conductor.tape.walk(0)).result(PATIENCE).recording
    with pytest.raises(SettingError, match="no creature 1; 1 were recorded"):
        runner.call(lambda conductor: conductor.tape.walk(1)).result(PATIENCE)
    assert len(walk.time) == 31
    assert walk.time[0] == 0.0
    # The GLB plays the same motion.
    played = Playback(GltfDocument.from_bytes(glb_bytes(walk), "walk.glb"))
    worlds = played.world_matrices(walk.time)
    node = int(walk.morphology.joint_node[0])
    assert worlds[:, node, :3, 3] == pytest.approx(walk.joint_position[:, 0], abs=1e-5)

    frames: list[bytes] = []
    stop = runner.listen(lambda e: frames.append(e.content) if e.kind == "frame" else None)
    assert give(runner, do="scrub", frame=10) is None
    refusal = give(runner, do="scrub", frame=31)
    stop()
    assert refusal is not None
    assert "it has 31 frames" in refusal
    assert struct.unpack_from("<I", frames[-1], 28) == (11,)
    assert give(runner, do="scrub", frame=None) is None


def test_overlays_come_while_they_are_watched(runner: Runner) -> None:
    runner.watched(frozenset(("cells", "candidates", "paths", "hull")))
    give(runner, do="clock", playing=True)
    names: set[str] = set()
    enough = threading.Event()

    def listen(event: Telling) -> None:
        if event.kind == "arrays":
            names.add(event.name)
        if len(names) == 4:
            enough.set()

    stop = runner.listen(listen)
    assert enough.wait(PATIENCE), names
    stop()
    runner.watched(frozenset())


@pytest.mark.parametrize(
    ("order", "words"),
    [
        ({"do": "fly"}, "there is no order 'fly'"),
        ({"do": "undo", "now": 1}, "undo has no key 'now'"),
        ({"do": "edit", "at": ["command"]}, "edit needs to"),
        ({"do": "edit", "at": [], "to": 1}, "edit has at"),
        ({"do": "push", "velocity": [1.0, float("nan"), 0.0]}, "push has velocity"),
        ({"do": "clock", "rate": 1e9}, "clock has rate"),
        ({"do": "see", "overlays": ["secrets"]}, "see has overlays"),
        ({"do": "ack", "frame": -1}, "ack has frame"),
        ({"do": "undo", "id": "x"}, "an order's id"),
        ({}, "there is no order None"),
    ],
)
def test_malformed_orders_are_refused(order: dict[str, Any], words: str) -> None:
    with pytest.raises(SettingError, match=words):
        judge_order(order)


def test_every_order_has_somebody_who_carries_it_out(runner: Runner) -> None:
    orders: list[dict[str, Any]] = [
        {"do": "edit", "at": ["command", "heading"], "to": 0.25},
        {"do": "undo"},
        {"do": "redo"},
        {"do": "open", "document": default_document()},
        {"do": "gait", "name": None},
        {"do": "clock", "playing": False, "steps": 2},
        {"do": "push", "velocity": [0.1, 0.0, 0.0]},
        {"do": "record", "on": True},
        {"do": "record", "on": False},
        {"do": "scrub", "frame": 0},
        {"do": "scrub", "frame": None},
        {"do": "watch", "creature": 0},
        {"do": "restart"},
    ]
    by_the_link = {"see", "drive", "ack"}
    assert {order["do"] for order in orders} == set(ORDERS) - by_the_link
    for order in orders:
        assert give(runner, **order) is None, order


def test_what_cannot_be_undone_any_more_stays_in_the_history(runner: Runner) -> None:
    assert give(runner, do="open", document=default_document()) is None
    assert give(runner, do="edit", at=["command", "heading"], to=0.75) is None

    def fail(document: Any) -> None:
        raise SettingError("its rig is gone")

    def break_stage(conductor: Any) -> None:
        conductor.stage.apply = fail

    def mend_stage(conductor: Any) -> None:
        del conductor.stage.apply

    def heading(conductor: Any) -> float:
        return float(conductor.stage.document["command"]["heading"])

    runner.call(break_stage).result(PATIENCE)
    assert give(runner, do="undo") == "its rig is gone"
    runner.call(mend_stage).result(PATIENCE)
    assert runner.call(heading).result(PATIENCE) == 0.75
    assert give(runner, do="redo") == "there is nothing to redo"
    assert give(runner, do="undo") is None
    assert runner.call(heading).result(PATIENCE) == 0.0
    assert give(runner, do="redo") is None
    assert runner.call(heading).result(PATIENCE) == 0.75
