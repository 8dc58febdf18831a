"""Files from a page that wait for the scene that names them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

from polypod.errors import PolypodError, SceneError
from polypod.studio.mesh_limits import judge_file
from polypod.studio.rigs_given import clean_name

MOST, MOST_BYTES = 512, 256 << 20


class WaitingFiles:
    """Files by their names. Its methods may be called from any thread."""

    def __init__(self, new_folder: Callable[[], Path]) -> None:
        """Prepare; `new_folder` makes a folder for them."""
        self._new_folder = new_folder
        self._folder: Path | None = None
        self._files: dict[str, Path] = {}
        self._lock = threading.Lock()

    def keep(self, data: bytes, name: str) -> str:
        """Keep a file, and return what it is called.

        Raises:
            PolypodError: it is of no kind that scenes name, or too large; or there are too many,
                and none is kept any more.
        """
        title = clean_name(name, Path(name).suffix.lower())
        with self._lock:
            if self._folder is None:
                self._folder = self._new_folder()
            file = self._folder / title
            held = sum(one.stat().st_size for one in self._files.values() if one != file)
            if len(self._files) >= MOST or held + len(data) > MOST_BYTES:
                self._let_go()
                raise SceneError(
                    f"a scene's files may be {MOST} of {MOST_BYTES >> 20} MiB together; open it "
                    "from where it is: polypod studio SCENE.toml"
                )
            self._files.pop(title, None)
            file.write_bytes(data)
            try:
                judge_file(file)
            except PolypodError:
                file.unlink()
                raise
            self._files[title] = file
        return title

    @property
    def files(self) -> dict[str, Path]:
        """The files by their names."""
        with self._lock:
            return dict(self._files)

    def let_go(self) -> None:
        """Delete them."""
        with self._lock:
            self._let_go()

    def _let_go(self) -> None:
        for file in self._files.values():
            file.unlink(missing_ok=True)
        self._files.clear()
