"""Blocks of code in the project's texts, and how a test runs what they say."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
TEXTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PROGRAMS = {"polypod": "-m polypod", "python": ""}


class Block(NamedTuple):
    """A fenced block: its language and its text."""

    language: str
    text: str


def blocks(path: Path) -> list[Block]:
    """Return a text's fenced blocks in their order."""
    return [Block(*found) for found in FENCE.findall(path.read_text(encoding="utf-8"))]


def file_named(block: Block) -> str | None:
    """Return the file that a block says it is, in a comment on its first line."""
    found = re.match(r"# ([\w-]+\.toml)\n", block.text)
    return found.group(1) if found else None


def jobs(line: str) -> list[list[str]]:
    """Return a line's commands but for those that install or run all tests, as words.

    `polypod` and `.venv/bin/polypod` become this interpreter's.
    """
    found = []
    for part in line.split(" && "):
        words = shlex.split(part)
        program = words[0].removeprefix(".venv/bin/")
        if program in ("python3", "python3.11", "pip", "cd", "npm") or "pytest" in words:
            continue
        assert program in PROGRAMS, f"no test knows how to run {part!r}"
        found.append([sys.executable, *PROGRAMS[program].split(), *words[1:]])
    return found
