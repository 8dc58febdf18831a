"""Every test in a folder of its own, with the files that a user might have there."""

from __future__ import annotations

from pathlib import Path

import pytest

CRATES = """
[[obstacle]]
shape = "box"
size = [0.3, 0.08, 0.3]
position = [0.1, 0.04, 0.5]
yaw = 0.3
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the working folder, in which are crates.toml, limp.toml and bad files."""
    monkeypatch.chdir(tmp_path)
    Path("crates.toml").write_text(CRATES)
    feet = "\n".join(f"[[foot]]\nstart = {k / 8}\nextent = 0.3" for k in range(8))
    Path("limp.toml").write_text(f'name = "limp"\n{feet}\n')
    Path("text.glb").write_text("this is no glTF")
    Path("bytes.toml").write_bytes(b"\xff\xfe\x00")
    Path("empty.toml").write_text("")
    Path("a-folder.glb").mkdir()
    return tmp_path
