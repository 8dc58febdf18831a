"""Help, versions, rigs, gaits; interruptions and faults."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import polypod.jobs.rig
import polypod.jobs.walk
from cli.running import polypod as polypod_run
from polypod import __version__
from polypod.gait.files import read_gait
from polypod.gait.library import make_gait, names
from polypod.gait.validation import check_gait
from polypod.jobs.gait import describe_check, paired_legs
from polypod.jobs.rig_options import RIG_HELP
from polypod.morphology import builtin
from polypod.morphology.load import load_rig


@pytest.mark.parametrize("command", ["", "walk", "rig", "gait", "bench", "warmup"])
def test_help(command: str) -> None:
    run = polypod_run(*command.split(), "--help")
    assert run.code == 0
    assert run.out.startswith(f"usage: polypod {command}".rstrip())


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; from polypod.cli import main; main(['walk', '--help']);"
        "sys.exit(str(sorted({'numpy', 'numba', 'matplotlib', 'PIL', 'tqdm'} & set(sys.modules))))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stderr == "[]\n"


def test_version() -> None:
    assert polypod_run("--version").out == f"polypod {__version__}\n"


def test_help_names_the_built_in_creatures() -> None:
    listed = RIG_HELP.split("creature: ")[1].split(", ")
    assert sorted(listed) == sorted(builtin.NAMES)


def test_rig_says_what_it_found() -> None:
    run = polypod_run("rig", "spider", "--height", "2")
    assert run.code == 0
    assert "8 legs" in run.out
    assert "guessed" in run.out


def test_gaits_are_listed_with_their_figures() -> None:
    run = polypod_run("gait", "--legs", "6")
    assert run.code == 0
    for name in names():
        assert f"\n{name} " in run.out
    tripod = next(line for line in run.out.splitlines() if line.startswith("tripod"))
    assert "3 to 6" in tripod or "3 to 3" in tripod


def test_gait_is_drawn_and_written(folder: Path) -> None:
    run = polypod_run("gait", "trot", "-o", "trot.png", "-o", "trot.toml")
    assert run.code == 0, run
    assert run.out.count("|") == 8
    assert Path("trot.png").read_bytes().startswith(b"\x89PNG")
    side, row = paired_legs(4)
    assert read_gait("trot.toml").touchdown == pytest.approx(make_gait("trot", side, row).touchdown)


def test_gait_of_a_rig_names_its_feet() -> None:
    run = polypod_run("gait", "wave", "--rig", "spider")
    assert run.code == 0, run
    assert "LeftLeg1Foot" in run.out


HOPS = "family = 'run'\nperiod = 0.9\n" + 8 * "[[foot]]\nstart = 0.1\nextent = 0.8\n"


@pytest.mark.parametrize(
    "words",
    [
        "trot",
        "trot --speed 3",
        "trot --duty 0.4 --speed 3",
        "tripod --legs 6",
        "hops.toml",
        "hops.toml --rig spider --speed 0.2",
        "walk --rig wolf",
    ],
)
def test_check_prints_the_figures_of_the_library_call(words: str, folder: Path) -> None:
    Path("hops.toml").write_text(HOPS)
    name, *options = words.split()
    given = dict(zip(options[::2], options[1::2], strict=True))
    creature = load_rig(given["--rig"]) if "--rig" in given else None
    side, row = paired_legs(int(given.get("--legs", 4)))
    if creature is not None:
        side, row = creature.legs.side, creature.legs.row
    gait = read_gait(name) if name.endswith(".toml") else make_gait(name, side, row)
    if "--duty" in given:
        duty = float(given["--duty"])
        gait = replace(gait.with_duty(duty), duty_low=math.nan, duty_high=math.nan)
    speed = float(given["--speed"]) if "--speed" in given else None
    check = check_gait(gait, creature, speed=speed)
    run = polypod_run("gait", name, *options, "--check")
    assert run.code == 0, run
    names = () if creature is None else creature.foot_name
    assert run.out == describe_check(check, names) + "\n"
    for part in (f"{check.speed:.3g} m/s", f"to {check.body_peak:.2f} g", check.verdict):
        assert part in run.out
    assert (f"plausible with  {check.change.text}" if check.change else "plausible") in run.out


def test_check_counts_feet() -> None:
    # A trot at duty .45: pairs stand for .45 each, and nobody for the rest.
    run = polypod_run("gait", "trot", "--duty", "0.45", "--check")
    assert "mean duty       0.450" in run.out
    assert "at least 0, 1.80 on the mean, at most 2" in run.out
    assert "10.0 % of the cycle" in run.out
    assert "bears up to 3.49 times its load in standing" in run.out


def test_check_says_that_legs_do_not_reach_so_far(folder: Path) -> None:
    Path("hops.toml").write_text(HOPS)
    run = polypod_run("gait", "hops.toml", "--rig", "spider", "--speed", "4", "--check")
    assert "; the 0.9 s asked for take longer strides than the legs reach" in run.out


def test_a_checked_gait_is_drawn_as_it_is_stepped(folder: Path) -> None:
    run = polypod_run("gait", "trot", "--speed", "3", "--check", "-o", "t.png", "-o", "t.toml")
    assert run.code == 0, run
    assert Path("t.png").read_bytes().startswith(b"\x89PNG")
    # The file keeps the gait as it is, with its range.
    assert read_gait("t.toml").duty == pytest.approx(0.45)


def test_an_odd_leg_is_in_front() -> None:
    side, row = paired_legs(5)
    np.testing.assert_array_equal(side, [1, -1, 1, -1, 0])
    np.testing.assert_array_equal(row, [0, 0, 1, 1, 2])


def test_ctrl_c_is_130_and_leaves_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # What takes the function over must do so before it is patched, or it keeps the patch.
    import polypod.report.played  # noqa: F401

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("polypod.rigs.export.glb_bytes", interrupt)
    before = sorted(folder.iterdir())
    run = polypod_run("walk", "--seconds", "0.1", "-o", "walk.glb")
    assert run.code == 130
    assert sorted(folder.iterdir()) == before
    assert "interrupted" in run.err


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise on Windows")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_signals_to_a_long_walk(folder: Path, number: signal.Signals, code: int) -> None:
    words = ["walk", "--seconds", "3000", "-o", "walk.glb"]
    program = "import sys; from polypod.cli import main; sys.exit(main(sys.argv[1:]))"
    before = sorted(folder.iterdir())
    run = subprocess.Popen(
        [sys.executable, "-c", program, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Who runs the tests in the background ignores interrupts, and children inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    time.sleep(2.0)
    run.send_signal(number)
    out, err = run.communicate(timeout=120)
    assert run.returncode == code, (out, err)
    assert "Traceback" not in err
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize(
    ("fault", "code", "part"),
    [
        (MemoryError(), 2, "memory"),
        (PermissionError(13, "Permission denied", "walk.glb"), 2, "walk.glb: Permission denied"),
        (IndexError("no such\nplace"), 1, "IndexError: no such place"),
    ],
)
def test_faults_are_one_sentence(
    fault: Exception, code: int, part: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any) -> None:
        raise fault

    monkeypatch.setattr(polypod.jobs.rig, "load_given_rig", fail)
    run = polypod_run("rig", "spider")
    assert run.code == code
    assert run.err.count("\n") == 1
    assert part in run.err
    monkeypatch.setenv("POLYPOD_DEBUG", "1")
    assert "Traceback" in polypod_run("rig", "spider").err


def test_a_reader_that_leaves_is_no_fault() -> None:
    command = f"{sys.executable} -m polypod rig spider | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert done.stderr == ""
    assert done.stdout.startswith("spider: ")


def test_warmup_compiles_what_a_walk_needs(folder: Path) -> None:
    run = polypod_run("warmup")
    assert run.code == 0, run
    assert "all kernels are compiled" in run.out
    run = polypod_run("walk", "--scene", "crates.toml", "--gait", "wave", "--seconds", "0.3")
    assert run.code == 0, run
    assert "compil" not in run.err


def environment_with_cache(folder: Path) -> dict[str, str]:
    """Return this process's environment with another folder for compiled kernels."""
    kept = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    return {**kept, "POLYPOD_CACHE": str(folder)}


def test_compiling_is_said(folder: Path) -> None:
    program = (
        "from polypod.jobs.screen import telling_of_compilation\n"
        "with telling_of_compilation():\n"
        "    from polypod.gait.tempo import top_speed\n"
        "    top_speed(1.0, 0.5, 1.0)\n"
    )
    for expected in (True, False):
        done = subprocess.run(
            [sys.executable, "-c", program],
            capture_output=True,
            text=True,
            env=environment_with_cache(folder / "cache"),
        )
        assert done.returncode == 0, done.stderr
        assert ("compiling kernels (first run only" in done.stderr) == expected


def test_an_unwritable_cache_is_said(folder: Path) -> None:
    (folder / "file").write_text("")
    program = (
        "from polypod.jobs.screen import telling_of_compilation\n"
        "with telling_of_compilation():\n"
        "    from polypod.gait.tempo import top_speed\n"
        "    print(top_speed(1.0, 0.5, 1.0) > 0)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        env=environment_with_cache(folder / "file" / "cache"),
    )
    assert done.stdout == "True\n", done.stderr
    assert "POLYPOD_CACHE" in done.stderr
