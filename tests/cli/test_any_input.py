"""No words and no bytes, however wrong, make a traceback or a fault of Polypod's own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import polypod.jobs.bench
import polypod.jobs.walk
import polypod.jobs.warmup
from cli.running import Run
from cli.running import polypod as polypod_command
from polypod.errors import SettingError
from polypod.morphology import builtin

ANY = settings(
    max_examples=50,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
OPTIONS = [
    "walk", "rig", "gait", "--leg", "--spine", "--forward", "--height", "--body-height", "--scene",
    "--gait", "--speed", "--path", "--seconds", "--fps", "--seed", "-o", "--record", "--report",
    "--plots",
    "--rig", "--legs", "--duty", "--check", "--help", "--version", "--",
]  # fmt: skip
VALUES = [
    "spider", "wolf", "trot", "crates.toml", "limp.toml", "text.glb", "a.glb", "a.png", "run.npz",
    "report.json", "0,0 1,1", "+x", "-x", "a:b", "#0:#1", "LeftLeg1Coxa:LeftLeg1Foot", "1", "0",
    "-1", "nan", "inf", "-inf", "1e400", "0x10", "1_0", "", " ", ".", "/", "~", "\0", "é", "\ud800",
    "%s", "{}", "a" * 300, "٣",
]  # fmt: skip
WORD = st.one_of(st.sampled_from(OPTIONS), st.sampled_from(VALUES), st.text(max_size=8))


@pytest.fixture(autouse=True)
def _nothing_long_runs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Stop each run where walking, measuring or compiling would begin."""

    def stop(*_: Any) -> None:
        raise SettingError("everything was judged")

    monkeypatch.setattr(polypod.jobs.walk, "_walk", stop)
    monkeypatch.setattr(polypod.jobs.warmup, "telling_of_compilation", stop)
    yield
    assert sorted(path.name for path in folder.glob(".*")) == []


def assert_polite(run: Run) -> None:
    """Assert that a run ended well, or with one sentence and code 2."""
    assert run.code in (0, 2), run
    assert "Traceback" not in run.err
    if run.code == 2:
        assert run.err.startswith("polypod: ")
        sentences = [line for line in run.err.splitlines() if "warning" not in line]
        assert len(sentences) == 1, run.err


@ANY
@given(first=st.sampled_from(["walk", "rig", "gait", "warmup"]), words=st.lists(WORD, max_size=6))
@example(first="walk", words=["--path", "-1,0 1,0", "--forward", "-x"])
@example(first="walk", words=["\0"])
@example(first="walk", words=["--scene", "\0"])
@example(first="walk", words=["--gait", "\0.toml"])
@example(first="walk", words=["-o", "\0.glb"])
@example(first="gait", words=["trot", "-o", "\ud800.png"])
@example(first="gait", words=["\ud800"])
@example(first="rig", words=["\ud800.glb"])
def test_any_words(first: str, words: list[str]) -> None:
    assert_polite(polypod_command(first, *words))


@ANY
@given(words=st.lists(WORD, max_size=3))
def test_any_first_word(words: list[str]) -> None:
    assert_polite(polypod_command(*words))


SCENE = """[terrain]
generator = "hills"
relief = 0.3
[[obstacle]]
shape = "box"
size = [0.4, 0.1, 0.4]
position = [0.2, 0.25, 1.2]
yaw = 0.3
forbidden = true
[[scatter]]
count = 4
area = [-1.0, 1.0, 1.0, 4.0]
size = [[0.08, 0.04, 0.08], [0.3, 0.08, 0.3]]
[[creature]]
rig = "spider"
gait = "limp.toml"
speed = 0.4
path = [[0, 0], [0, 2]]
[[push]]
time = 1.0
velocity = [0.1, 0.0, 0.0]
"""
CREATURE = """rig = "spider"
leg = ["LeftLeg1Coxa:LeftLeg1Foot", "RightLeg1Coxa:RightLeg1Foot"]
spine = ["Abdomen"]
forward = "+z"
height = 0.8
body_height = 0.2
[body]
centre = [0.0, 0.3, 0.0]
thickness = 0.05
[foot."LeftLeg1Foot"]
half_size = [0.01, 0.02]
[limit."LeftLeg1Tibia"]
bend = [-0.3, 1.0]
"""
GAIT = "".join(f"[[foot]]\nstart = {k / 8}\nextent = 0.3\n" for k in range(8))
PIECES = [
    "nan", "inf", "-inf", "1e308", "-1", "0", "9" * 400, "true", '""', '"\\u0000"', "[]", "{}",
    "[[1]]", '"spider"', "1979-05-27", "[", "]", "=", '"', "\n[terrain]\n", "\n[[creature]]\n",
    "[" * 2000,
]  # fmt: skip


def mutated(text: str) -> st.SearchStrategy[str]:
    """Return texts in which some values or lines are others."""
    lines = text.splitlines()

    def mutate(changes: list[tuple[int, int, str]]) -> str:
        found = list(lines)
        for line, kind, piece in changes:
            key, equals, _ = found[line].partition("=")
            if kind == 0 and equals:
                found[line] = f"{key}= {piece}"
            elif kind == 1:
                found[line] = piece
            else:
                found[line] = found[line].replace(piece[:1], piece)
        return "\n".join(found)

    change = st.tuples(st.integers(0, len(lines) - 1), st.integers(0, 2), st.sampled_from(PIECES))
    return st.lists(change, min_size=1, max_size=3).map(mutate)


@ANY
@given(text=mutated(SCENE))
def test_any_scene(text: str) -> None:
    Path("scene.toml").write_text(text)
    assert_polite(polypod_command("walk", "--scene", "scene.toml"))


@ANY
@given(text=mutated(CREATURE))
def test_any_creature_file(text: str) -> None:
    Path("creature.toml").write_text(text)
    assert_polite(polypod_command("rig", "creature.toml"))


@ANY
@given(text=mutated(GAIT))
def test_any_gait_file(text: str) -> None:
    Path("gait.toml").write_text(text)
    assert_polite(polypod_command("gait", "gait.toml", "--check"))
    assert_polite(polypod_command("walk", "--gait", "gait.toml"))


@ANY
@given(
    changes=st.lists(st.tuples(st.floats(0.0, 1.0), st.integers(0, 255)), max_size=4),
    end=st.floats(0.0, 1.0),
)
@example(changes=[], end=1.0)
def test_any_rig_bytes(changes: list[tuple[float, int]], end: float) -> None:
    data = bytearray(SPIDER)
    for place, value in changes:
        # The JSON in front is a small share of the file and holds most of the meaning.
        data[int(place**3 * (len(data) - 1))] = value
    Path("rig.glb").write_bytes(data[: round(len(data) * end**0.2)])
    assert_polite(polypod_command("rig", "rig.glb"))


SPIDER = builtin.build("spider").glb
