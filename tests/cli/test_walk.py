"""`polypod walk` leaves what was asked for, and the same again."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from cli.running import assert_refused, polypod
from polypod.report.record import read_record
from polypod.rigs.gltf import GltfDocument

SHORT = ("--seconds", "0.5")


def test_writes_everything_asked_for(folder: Path) -> None:
    run = polypod(
        "walk", "spider", "--scene", "crates.toml", *SHORT,
        "-o", "walk.glb", "-o", "walk.png", "--record", "run.npz", "--report", "report.json",
        "--plots", "plots.svg",
    )  # fmt: skip
    assert run.code == 0, run
    for name in ("walk.glb", "walk.png", "run.npz", "report.json", "plots.svg"):
        assert name in run.out
    record = read_record(folder / "run.npz")
    assert len(record.time) == 16
    assert record.obstacle_position.shape[1] == 1
    document = GltfDocument.read(folder / "walk.glb")
    assert len(document.root.parts("animations")) >= 1
    report = json.loads(Path("report.json").read_text())
    assert report["creature"] == "spider"
    assert report["failures"] == []
    assert report["frames"] == 16
    assert 0.0 <= report["played_stance_slip_of_leg"] <= 1e-3
    assert Path("plots.svg").read_text().count("<path") > 50
    with Image.open("walk.png") as picture:
        assert len(np.unique(np.asarray(picture).reshape(-1, 3), axis=0)) > 100
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]


def test_the_same_words_make_the_same_bytes(folder: Path) -> None:
    for name in ("a", "b"):
        words = ("walk", "--scene", "crates.toml", *SHORT, "-o", f"{name}.glb")
        assert polypod(*words, "--record", f"{name}.npz").code == 0
    assert Path("a.glb").read_bytes() == Path("b.glb").read_bytes()
    assert Path("a.npz").read_bytes() == Path("b.npz").read_bytes()


def test_plain_python_walks_the_same_walk(folder: Path) -> None:
    words = ["walk", "--scene", "crates.toml", *SHORT, "--record"]
    assert polypod(*words, "compiled.npz").code == 0
    done = subprocess.run(
        [sys.executable, "-m", "polypod", *words, "plain.npz"],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert "compil" not in done.stderr
    compiled, plain = read_record(folder / "compiled.npz"), read_record(folder / "plain.npz")
    np.testing.assert_array_equal(plain.foot_stance, compiled.foot_stance)
    np.testing.assert_allclose(plain.joint_position, compiled.joint_position, rtol=0.0, atol=1e-9)


def test_path_sets_start_facing_and_time(folder: Path) -> None:
    run = polypod("walk", "--path", "-1,2 0,2", "--speed", "0.6", "--record", "run.npz")
    assert run.code == 0, run
    record = read_record(folder / "run.npz")
    assert record.body_position[0, [0, 2]] == pytest.approx([-1.0, 2.0], abs=1e-6)
    # Facing +X is half a half turn about +Y.
    assert record.body_rotation[0, 1] == pytest.approx(math.sin(math.pi / 4), abs=0.05)
    leg = float(record.leg_length.mean())
    assert record.body_position[-1, [0, 2]] == pytest.approx([0.0, 2.0], abs=0.3 * leg)
    last = np.linalg.norm(np.diff(record.body_position[-6:], axis=0), axis=1)
    assert last.max() * 30.0 < 0.1 * 0.6, "it should stand at the end of its path"


def test_standing_still(folder: Path) -> None:
    run = polypod("walk", "--speed", "0", *SHORT, "--record", "run.npz", "--report", "r.json")
    assert run.code == 0, run
    record = read_record(folder / "run.npz")
    assert record.foot_stance.all()
    assert np.ptp(record.body_position[:, [0, 2]], axis=0).max() < 1e-3


def test_fps_sets_frames_and_times(folder: Path) -> None:
    assert polypod("walk", "--seconds", "0.5", "--fps", "24", "--record", "run.npz").code == 0
    record = read_record(folder / "run.npz")
    assert record.time == pytest.approx(np.arange(13) / 24)


def test_gait_file_is_walked(folder: Path) -> None:
    run = polypod("walk", "--gait", "limp.toml", *SHORT)
    assert run.code == 0, run


def test_scene_with_several_creatures_writes_numbered_files(folder: Path) -> None:
    Path("three.toml").write_text(
        '[[creature]]\nrig = "spider"\ncount = 2\nposition = [0.0, 0.0]\npath = [[0,0], [0,5]]\n'
        '[[creature]]\nrig = "spider"\nposition = [5.0, 0.0]\nheading = 1.0\nspeed = 0.2\n'
    )
    run = polypod(
        "walk", "--scene", "three.toml", *SHORT, "-o", "w.glb", "--record", "run.npz",
        "--report", "r.json",
    )  # fmt: skip
    assert run.code == 0, run
    made = sorted(path.name for path in folder.glob("*-00*"))
    assert made == [
        f"{stem}-00{i}.{suffix}"
        for stem, suffix in (("r", "json"), ("run", "npz"), ("w", "glb"))
        for i in range(3)
    ]
    starts = [read_record(folder / f"run-00{i}.npz").body_position[0] for i in range(3)]
    assert np.linalg.norm(starts[0] - starts[1]) > 1.0
    assert starts[2][0] == pytest.approx(5.0, abs=1e-6)


def test_a_rig_takes_the_place_of_the_scenes_creatures(folder: Path) -> None:
    Path("two.toml").write_text(
        '[[creature]]\nrig = "nosuch.glb"\npath = [[1,1], [1,5]]\n[[creature]]\nrig = "spider"\n'
    )
    run = polypod("walk", "spider", "--scene", "two.toml", *SHORT, "--record", "run.npz")
    assert run.code == 0, run
    assert read_record(folder / "run.npz").body_position[0, [0, 2]] == pytest.approx([1.0, 1.0])


def test_seed_moves_the_crates(folder: Path) -> None:
    Path("field.toml").write_text(
        "[[scatter]]\ncount = 3\narea = [-1, 2, 1, 3]\nsize = [[0.1, 0.1, 0.1], [0.2, 0.1, 0.2]]\n"
    )
    places = []
    for seed in ("0", "1"):
        words = ("--seed", seed, "--record", f"{seed}.npz")
        assert polypod("walk", "--scene", "field.toml", *SHORT, *words).code == 0
        places.append(read_record(folder / f"{seed}.npz").obstacle_position[0])
    assert np.abs(places[0] - places[1]).max() > 0.1


def test_pushes_are_said_to_be_left_out(folder: Path) -> None:
    Path("push.toml").write_text("[[push]]\ntime = 0.2\nvelocity = [1, 0, 0]\n")
    run = polypod("walk", "--scene", "push.toml", *SHORT)
    assert run.code == 0, run
    assert "pushes" in run.err


def test_speeds_beyond_the_legs_are_said(folder: Path) -> None:
    run = polypod("walk", "--speed", "60", *SHORT)
    assert run.code == 0, run
    assert "60 m/s" in run.err


def test_no_room_to_stand_names_the_creature(folder: Path) -> None:
    Path("taboo.toml").write_text(
        '[[obstacle]]\nshape = "box"\nsize = [9, 0.1, 9]\nposition = [0, 0, 0]\nforbidden = true\n'
        '[[creature]]\nrig = "spider"\n'
    )
    run = polypod("walk", "--scene", "taboo.toml", *SHORT, "-o", "walk.glb")
    assert_refused(run, "taboo.toml", "[[creature]] number 1", "cannot stand")
    assert not Path("walk.glb").exists()


def test_a_gait_that_no_animal_walks_is_walked_with_a_warning(folder: Path) -> None:
    feet = 8 * "[[foot]]\nstart = 0.1\nextent = 0.88\n"
    Path("hops.toml").write_text(f"family = 'arthropod'\n{feet}")
    run = polypod("walk", "spider", "--gait", "hops.toml", *SHORT, "--report", "r.json")
    assert run.code == 0, run
    warnings = [line for line in run.err.splitlines() if "gait 'hops'" in line]
    assert len(warnings) == 1
    assert "is implausible, with 13.1 g at the peak" in warnings[0]
    assert "; plausible with a " in warnings[0]
    report = json.loads(Path("r.json").read_text())
    assert (report["gait"], report["gait_verdict"]) == ("hops", "implausible")
    assert report["gait_body_peak_g"] == pytest.approx(math.pi / 0.24)
    assert len(report["gait_reasons"]) > 1
    run = polypod("walk", "spider", "--gait", "tetrapod", *SHORT, "--report", "r.json")
    assert "implausible" not in run.err
    assert json.loads(Path("r.json").read_text())["gait_verdict"] == "plausible"
    polypod("walk", "spider", *SHORT, "--report", "r.json")
    assert "gait_verdict" not in json.loads(Path("r.json").read_text())
