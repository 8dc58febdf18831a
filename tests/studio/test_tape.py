"""A record while the world is built: obstacles come and go, the ground changes, nothing is lost."""

from __future__ import annotations

import io
import zipfile
from typing import Any

import numpy as np
import pytest

from polypod.errors import SettingError
from polypod.report.record import read_record
from polypod.rigs.export import glb_bytes
from polypod.rigs.gltf import GltfDocument
from polypod.studio import conductor, exports
from polypod.studio.conductor import Conductor
from polypod.studio.document import default_document, edited
from polypod.studio.exports import EXPORTS, WALKS, ended_tape, zip_of_walks
from polypod.studio.obeying import obey
from polypod.studio.places import on_other_ground, renumbered
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.stage import STEP, Stage
from polypod.studio.world_files import WorldFiles

PLATE = {"name": "plate", "shape": "box", "size": [3.0, 0.1, 3.0], "position": [0.0, 0.05, 0.0]}
FAR = {"name": "far", "shape": "sphere", "size": [0.5, 0.5, 0.5], "position": [9.0, 0.0, 9.0]}


class Set:
    """A conductor, and what it said."""

    def __init__(self, *obstacles: dict[str, Any]) -> None:
        document = default_document()
        document["obstacle"] = list(obstacles)
        self.told: list[Any] = []
        self.conductor = Conductor(Stage(document, lambda rig: rig), self.told.append)

    def order(self, **order: Any) -> None:
        obey(self.conductor, order)

    def edit(self, *at: str | int, to: Any) -> None:
        document = edited(self.conductor.stage.document, list(at), to)
        self.conductor.take(document)

    def walk(self, frames: int) -> None:
        for _ in range(frames):
            self.conductor.step(STEP)

    def said(self, kind: str) -> list[dict[str, Any]]:
        return [e.content for e in self.told if e.kind == "text" and e.content["is"] == kind]


def test_obstacles_come_and_go_and_the_record_holds_them_all(tmp_path: Any) -> None:
    world = Set(PLATE)
    world.walk(10)
    world.order(do="record", on=True)
    world.walk(9)
    world.edit("obstacle", 1, to=FAR)
    world.walk(10)
    world.edit("obstacle", 1, "position", to=[9.0, 0.0, 8.0])
    world.walk(10)
    world.edit("obstacle", 0, to=None)
    world.walk(10)
    assert world.conductor.tape is not None
    assert world.conductor.tape.recording
    assert world.said("trouble") == []
    walk, there = world.conductor.tape.walk(0)
    assert len(walk.time) == 40
    assert np.diff(walk.time) == pytest.approx(STEP)
    # The plate until it was taken away, the sphere from when it came.
    assert there[:, 0].tolist() == [True] * 30 + [False] * 10
    assert there[:, 1].tolist() == [False] * 10 + [True] * 30
    far = walk.obstacle_position[:, 1, 2]
    assert far == pytest.approx([9.0] * 20 + [8.0] * 20)
    assert np.isfinite(walk.obstacle_position).all()
    assert np.linalg.norm(walk.obstacle_rotation, axis=2) == pytest.approx(1.0)
    # Feet stood on the plate, and on nothing that is gone.
    assert (walk.foot_support[:10][walk.foot_stance[:10]] == 0).all()
    assert (walk.foot_support[-5:] == -1).all()
    # The files: the record is one to who reads records, and says when each stood.
    export = EXPORTS["walk.npz"]
    content = export.write(export.read(world.conductor, 0), GivenRigs(), WorldFiles())
    file = tmp_path / "walk.npz"
    file.write_bytes(content)
    assert read_record(file).obstacle_position.shape == (40, 2, 3)
    with np.load(io.BytesIO(content), allow_pickle=False) as record:
        assert np.array_equal(record["obstacle_there"], there)
    assert len(GltfDocument.from_bytes(glb_bytes(walk), "w").root.parts("animations")) == 1


def test_another_ground_goes_on_in_the_same_record() -> None:
    world = Set(FAR)
    world.order(do="record", on=True)
    world.walk(20)
    time = world.conductor.stage.world.time
    world.edit("terrain", to={"generator": "stairs", "start": 4.0})
    assert world.conductor.stage.world.time == time
    world.walk(20)
    world.edit("terrain", to=None)
    world.walk(5)
    tape = world.conductor.tape
    assert tape is not None
    assert tape.recording
    walk, there = tape.walk(0)
    assert len(walk.time) == 46
    assert np.diff(walk.time) == pytest.approx(STEP)
    # The obstacle stood all the time, the steps only in between.
    assert there[:, 0].all()
    assert there.shape[1] > 5
    assert not there[:21, 1:].any()
    assert there[21:41, 1:].all()
    # It goes on from where it was.
    step = np.linalg.norm(np.diff(walk.body_position[:, [0, 2]], axis=0), axis=1)
    assert step.max() < 0.05


def test_the_tape_shows_what_stood_then(tmp_path: Any) -> None:
    world = Set(PLATE)
    world.order(do="record", on=True)
    world.walk(5)
    world.edit("obstacle", 0, to=None)
    world.walk(5)
    world.edit("terrain", to={"generator": "hills"})
    world.walk(5)
    world.order(do="record", on=False)
    shown = {}
    for frame in (2, 8, 13):
        world.order(do="scrub", frame=frame)
        shown[frame] = world.said("backdrop")[-1]
        assert world.conductor.drawn.grounds[shown[frame]["ground"]]
    assert [shown[2]["obstacle"], shown[8]["obstacle"]] == [[PLATE], []]
    assert shown[2]["ground"] == shown[8]["ground"] != shown[13]["ground"]
    told = len(world.said("backdrop"))
    world.order(do="scrub", frame=12)
    assert len(world.said("backdrop")) == told, "only what is new is said"
    # Building goes on in the world, not on the tape.
    world.edit("obstacle", 0, to=PLATE)
    assert world.conductor.scrubbed is None
    assert world.said("backdrop")[-1] == {"is": "backdrop", "obstacle": None, "ground": None}


def test_what_ends_a_record_is_said_and_nothing_is_lost() -> None:
    for change in ({"rig": "ant", "count": 1}, None):
        world = Set()
        world.order(do="record", on=True)
        world.walk(5)
        if change:
            world.edit("crowd", 0, to=change)
        else:
            world.order(do="restart")
        world.walk(3)
        (said,) = world.said("trouble")
        assert "recording has ended" in said["why"]
        assert world.conductor.tape is not None
        assert len(world.conductor.tape.walk(0).recording.time) == 6


@pytest.mark.parametrize(
    ("before", "after", "numbers"),
    [
        ("ab", "ab", (0, 1)), ("ab", "abc", (0, 1)), ("ab", "b", (-1, 0)), ("ab", "a", (0, -1)),
        ("b", "ab", (1,)), ("ab", "xb", (0, 1)), ("aa", "ba", (0, 1)), ("abc", "ac", (0, -1, 1)),
        ("ab", "", (-1, -1)), ("ab", "ba", (1, 0)), ("", "a", ()),
    ],
)  # fmt: skip
def test_obstacles_are_found_again(before: str, after: str, numbers: tuple[int, ...]) -> None:
    old, new = ([{"name": name} for name in names] for names in (before, after))
    assert renumbered(old, new, len(before)) == numbers
    # Two steps of the terrain's own follow them.
    own = (len(after), len(after) + 1)
    assert renumbered(old, new, len(before) + 2) == (*numbers, *own)
    assert on_other_ground(old, new, len(before) + 2) == (*numbers, -1, -1)


def test_all_creatures_are_exported_together_once_the_record_has_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = Set()
    world.edit("crowd", to=[{"rig": "ant", "count": 2}, {"rig": "ant", "count": 1}])
    with pytest.raises(SettingError, match=r"^nothing is recorded"):
        ended_tape(world.conductor)
    world.order(do="record", on=True)
    world.walk(5)
    said = world.said("tape")[-1]["kinds"]
    assert [(kind["name"], kind["count"]) for kind in said] == [
        ("spider", 1),
        ("ant", 2),
        ("ant", 1),
    ]
    with pytest.raises(SettingError, match="once the record has ended"):
        ended_tape(world.conductor)
    world.order(do="record", on=False)
    tape = ended_tape(world.conductor)
    given = (GivenRigs(), WorldFiles())
    for name in WALKS:
        export = EXPORTS[name]
        content = zip_of_walks(tape, name, export, *given)
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            suffix = name[4:]
            members = [f"{one}{suffix}" for one in ("1-spider-1", "2-ant-1", "2-ant-2", "3-ant-1")]
            assert archive.namelist() == members
            for creature, member in enumerate(members):
                alone = export.write(export.read(world.conductor, creature), *given)
                assert archive.read(member) == alone
        assert content == zip_of_walks(tape, name, export, *given), "the same bytes"
    monkeypatch.setattr(exports, "MOST_BYTES", 1 << 20)
    big = EXPORTS["walk.glb"]._replace(write=lambda *_: bytes(300_000))
    with pytest.raises(SettingError, match=r"^4 walks have more than 1 MiB"):
        zip_of_walks(tape, "walk.glb", big, *given)


def test_large_frames_are_not_all_sent_but_all_recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    world = Set()

    def sent() -> int:
        return sum(one.kind == "frame" for one in world.told)

    world.order(do="record", on=True)
    before = sent()
    world.walk(12)
    assert sent() == before + 12
    monkeypatch.setattr(conductor, "MOST_SENT", 30 * len(world.conductor.newest))
    before = sent()
    world.walk(12)
    assert sent() == before + 4, "every third"
    # Who stops time sees where everything came to.
    for _ in range(3):
        world.walk(1)
        world.conductor.rest()
        frames = [one.content for one in world.told if one.kind == "frame"]
        assert frames[-1] == world.conductor.newest
        world.conductor.rest()
        assert sent() == len(frames), "once"
    # What follows from an order is sent at once.
    for speed in (0.1, 0.2, 0.3):
        world.order(do="edit", at=["command", "speed"], to=speed)
        before = sent()
        world.walk(1)
        assert sent() == before + 1
    tape = world.conductor.tape
    assert tape is not None
    assert len(tape.frames) == 31
    assert len(tape.walk(0).recording.time) == 31
