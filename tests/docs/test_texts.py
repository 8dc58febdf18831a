"""Every command and snippet of README and docs does what it says."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from docs.fenced import ROOT, TEXTS, blocks, file_named, jobs
from polypod.morphology import builtin


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.name)
def test_all_blocks_run(path: Path, tmp_path: Path) -> None:
    # What a reader has: the examples, and a rig of their own.
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    (tmp_path / "creature.glb").write_bytes(builtin.build("spider").glb)
    for block in blocks(path):
        name = file_named(block)
        if name is not None:
            (tmp_path / name).write_text(block.text, encoding="utf-8")
        elif block.language == "python":
            run([sys.executable, "-c", block.text], tmp_path)
        elif block.language == "sh":
            for line in block.text.splitlines():
                for words in jobs(line):
                    run(words, tmp_path)
        else:
            assert block.language == "", f"no test runs {block.language!r} in {path.name}"


def run(words: list[str], folder: Path) -> None:
    """Run a command, which must succeed and write what it names."""
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, (words, done.stderr)
    for option, value in pairwise(words):
        if option in ("-o", "--record", "--report"):
            assert (folder / value).stat().st_size > 100, f"{value} was not written"


def test_readme_sets_up_with_two_commands() -> None:
    commands = [block.text.strip() for block in blocks(ROOT / "README.md")][:2]
    for command in commands:
        assert "\n" not in command
        assert command.startswith("python3 -m venv .venv && .venv/bin/pip install -c constraints")
    walk, test = commands
    assert walk.endswith(
        "polypod walk spider --scene examples/scenes/crates.toml -o walk.glb -o walk.png"
    )
    assert test.endswith('-e ".[test]" && .venv/bin/python -m pytest')
    assert f"\n{test}\n" in (ROOT / ".ci" / "run").read_text()


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.name)
def test_links_lead_somewhere(path: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", path.read_text(encoding="utf-8")):
        assert (path.parent / target).exists(), target


def test_paper_map_names_files_that_exist() -> None:
    package = ROOT / "src" / "polypod"
    for row in (ROOT / "docs" / "paper-map.md").read_text(encoding="utf-8").splitlines():
        if not row.startswith("|"):
            continue
        folder = package
        for name in re.findall(r"`([\w/]+\.py)`", row.split("|")[3]):
            # A name without a folder lies beside the one before it.
            place = package / name if "/" in name else folder / name
            assert place.is_file(), f"{name} in: {row}"
            folder = place.parent


def test_architecture_names_every_room() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    package = ROOT / "src" / "polypod"
    rooms = {path.parent.relative_to(package).parts[0] for path in package.glob("*/__init__.py")}
    for room in rooms:
        assert f"{room}/" in text, room
    for name in re.findall(r"^  (\w+\.py) ", text, re.MULTILINE):
        assert (package / name).is_file(), name


EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*.py"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_examples_run(path: Path, tmp_path: Path) -> None:
    run([sys.executable, str(path)], tmp_path)
    for name in re.findall(r"\"(\w+\.(?:glb|png|toml|npz))\"\)$", path.read_text(), re.MULTILINE):
        if not name.startswith("crates.toml"):
            assert (tmp_path / name).stat().st_size > 100, name


@pytest.mark.parametrize("path", sorted((ROOT / "examples" / "scenes").glob("*.toml")), ids=str)
def test_example_scenes_walk_by_themselves(path: Path, tmp_path: Path) -> None:
    words = [sys.executable, "-m", "polypod", "walk", "--scene", str(path), "--seconds", "1"]
    run([*words, "--record", "run.npz"], tmp_path)
