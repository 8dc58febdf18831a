"""What cannot be used is said in one sentence, with exit code 2, before anything is compiled."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

import polypod.jobs.walk
from cli.running import assert_refused
from cli.running import polypod as polypod_command

BAD = [
    ([], ["COMMAND"]),
    (["fly"], ["fly", "walk", "rig", "gait", "warmup"]),
    (["walk", "--sped", "1"], ["--sped"]),
    (["walk", "spider", "wolf"], ["wolf"]),
    (["walk", ""], ["RIG", "empty"]),
    (["walk", "nosuch"], ["nosuch", "spider", ".glb"]),
    (["walk", "nosuch.glb"], ["nosuch.glb"]),
    (["walk", "text.glb"], ["text.glb"]),
    (["walk", "a-folder.glb"], ["a-folder.glb"]),
    (["walk", "bytes.toml"], ["bytes.toml"]),
    (["walk", "empty.toml"], ["empty.toml", "rig"]),
    (["walk", "x" * 5000 + ".glb"], [".glb"]),
    (["walk", "--leg", "Nose:Tail"], ["Nose"]),
    (["walk", "--leg", "Nose"], ["Nose"]),
    (["walk", "--leg", "#99999:#2"], ["99999"]),
    (["walk", "--spine", "a,,b"], ["--spine", "empty"]),
    (["walk", "--spine", "Nose"], ["Nose"]),
    (["walk", "--forward", "up"], ["--forward", "up", "+z"]),
    (["walk", "--height", "0"], ["--height", "above 0"]),
    (["walk", "--height", "nan"], ["--height", "nan"]),
    (["walk", "--height", "-1"], ["--height", "-1"]),
    (["walk", "--height", "1e9"], ["--height", "1000"]),
    (["walk", "--body-height", "inf"], ["--body-height", "inf"]),
    (["walk", "--speed", "fast"], ["--speed", "fast"]),
    (["walk", "--speed", "nan"], ["--speed", "nan"]),
    (["walk", "--speed", "-1"], ["--speed", "-1"]),
    (["walk", "--speed", "-inf"], ["--speed", "-inf"]),
    (["walk", "--speed", "101"], ["--speed", "100"]),
    (["walk", "--seconds", "-3"], ["--seconds", "-3"]),
    (["walk", "--seconds", "0"], ["--seconds", "above 0"]),
    (["walk", "--seconds", "0.001"], ["--seconds", "0.001"]),
    (["walk", "--seconds", "1e6"], ["frames", "--seconds"]),
    (["walk", "--seconds", "3400"], ["frames", "--seconds"]),
    (["walk", "--fps", "0"], ["--fps", "from 1 to 1000"]),
    (["walk", "--fps", "1e5"], ["--fps"]),
    (["walk", "--seed", "1.5"], ["--seed", "1.5"]),
    (["walk", "--seed", "9" * 5000], ["--seed"]),
    (["walk", "--path", ""], ["--path"]),
    (["walk", "--path", "0,0"], ["--path", "0,0"]),
    (["walk", "--path", "0,0 0,0"], ["--path"]),
    (["walk", "--path", "0,0 1"], ["--path", "'1'"]),
    (["walk", "--path", "0,0 a,b"], ["--path", "a,b"]),
    (["walk", "--path", "0,0 nan,1"], ["--path", "nan,1"]),
    (["walk", "--path", "-1,0"], ["--path", "-1,0"]),
    (["walk", "--path", "0,0 1e9,0"], ["--path", "1e9,0"]),
    (["walk", "--path", "0,0 99999,0"], ["frames"]),
    (["walk", "--path", " ".join(f"0,{i}" for i in range(300))], ["300", "257"]),
    (["walk", "--gait", "moonwalk"], ["moonwalk", "tripod", ".toml"]),
    (["walk", "--gait", "nosuch.toml"], ["nosuch.toml"]),
    (["walk", "--gait", "bytes.toml"], ["bytes.toml"]),
    (["walk", "--gait", "four.toml"], ["four.toml", "4", "8"]),
    (["walk", "--scene", "nosuch.toml"], ["nosuch.toml"]),
    (["walk", "--scene", "bytes.toml"], ["bytes.toml"]),
    (["walk", "--scene", "a-folder.glb"], ["a-folder.glb"]),
    (["walk", "--scene", "typo.toml"], ["typo.toml", "obstacel", "obstacle"]),
    (["walk", "--scene", "fast.toml"], ["fast.toml", "[[creature]] number 1", "100"]),
    (["walk", "--scene", "rigless.toml"], ["rigless.toml", "[[creature]] number 2", "nosuch.glb"]),
    (["walk", "--scene", "null.toml"], ["null.toml"]),
    (["walk", "--scene", "two.toml", "--leg", "a:b"], ["--leg", "two.toml"]),
    (["walk", "--scene", "two.toml", "--path", "0,0 0,1"], ["--path", "two.toml"]),
    (["walk", "--scene", "crowd.toml"], ["frames", "joints"]),
    (["walk", "-o", "walk.fbx"], ["-o walk.fbx", ".glb", ".png"]),
    (["walk", "-o", "walk"], ["-o walk", ".glb"]),
    (["walk", "-o", "nowhere/walk.glb"], ["nowhere", "does not exist"]),
    (["walk", "-o", "text.glb/walk.glb"], ["text.glb", "does not exist"]),
    (["walk", "-o", "a-folder.glb"], ["a-folder.glb", "folder"]),
    (["walk", "-o", "w.glb", "-o", "./w.glb"], ["w.glb", "twice"]),
    (["walk", "text.glb", "-o", "text.glb"], ["text.glb", "read by this run"]),
    (["walk", "-o", "x" * 300 + ".glb"], [".glb"]),
    (["walk", "--record", "run.csv"], ["--record run.csv", ".npz"]),
    (["walk", "--plots", "plots.txt"], ["--plots plots.txt", ".svg"]),
    (["walk", "--report", "report.txt"], ["--report report.txt", ".json"]),
    (["rig"], ["RIG"]),
    (["rig", "nosuch.glb"], ["nosuch.glb"]),
    (["rig", "text.glb"], ["text.glb"]),
    (["rig", "spider", "--leg", "Nose:Tail"], ["Nose"]),
    (["gait", "moonwalk"], ["moonwalk", "tripod"]),
    (["gait", "bytes.toml"], ["bytes.toml"]),
    (["gait", "four.toml", "--legs", "6"], ["four.toml", "4", "6"]),
    (["gait", "trot", "--legs", "1"], ["--legs", "1"]),
    (["gait", "trot", "--legs", "1e3"], ["--legs", "1e3"]),
    (["gait", "trot", "--legs", "4", "--rig", "spider"], ["--rig", "--legs"]),
    (["gait", "trot", "--rig", "nosuch.glb"], ["nosuch.glb"]),
    (["gait", "trot", "--duty", "nan"], ["--duty", "nan"]),
    (["gait", "trot", "-o", "trot.jpg"], ["-o trot.jpg", ".png", ".toml"]),
    (["gait", "four.toml", "-o", "four.toml"], ["four.toml", "read by this run"]),
    (["gait", "--check"], ["--check"]),
    (["gait", "-o", "gait.png"], ["-o"]),
    (["gait", "--speed", "1"], ["--speed"]),
    (["gait", "trot", "--speed", "1"], ["--speed", "--check"]),
    (["gait", "trot", "--check", "--speed", "-1"], ["--speed", "-1"]),
    (["gait", "four.toml", "--check", "--rig", "spider"], ["four.toml", "4", "8"]),
    (["warmup", "now"], ["now"]),
    (["bench", "--json", "nowhere/b.json"], ["nowhere", "does not exist"]),
]


@pytest.fixture
def bad_files(folder: Path) -> Path:
    """Write scenes and gaits with something wrong in them."""
    foot = "[[foot]]\nstart = 0.5\nextent = 0.3\n"
    Path("four.toml").write_text(4 * foot)
    Path("typo.toml").write_text("[[obstacel]]\n")
    creature = '[[creature]]\nrig = "spider"\n'
    Path("fast.toml").write_text(creature + "speed = 900\n")
    Path("rigless.toml").write_text(creature + '[[creature]]\nrig = "nosuch.glb"\n')
    Path("null.toml").write_text('[[creature]]\nrig = "a\\u0000b.glb"\n')
    Path("two.toml").write_text(creature + creature)
    Path("crowd.toml").write_text(creature + "count = 90000\n")
    return folder


@pytest.mark.parametrize(("words", "parts"), BAD, ids=lambda value: " ".join(value)[:60])
def test_refused(
    words: list[str], parts: list[str], bad_files: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def walk(*_: Any) -> None:
        raise AssertionError("the input should have been refused before a world was made")

    monkeypatch.setattr(polypod.jobs.walk, "_walk", walk)
    before = {path: path.read_bytes() for path in bad_files.iterdir() if path.is_file()}
    assert_refused(polypod_command(*words), *parts)
    after = {path: path.read_bytes() for path in bad_files.iterdir() if path.is_file()}
    assert after == before


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write all")
def test_unwritable_folder(folder: Path) -> None:
    Path("locked").mkdir(mode=0o500)
    assert_refused(polypod_command("walk", "-o", "locked/walk.glb"), "locked/walk.glb")
