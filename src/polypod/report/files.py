"""Output files that are either whole or not there."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from polypod.errors import SettingError


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside `path`; put it in its place once all went well.

    The temporary file keeps the suffix of `path`, so that writers which go by it work. It is
    removed when anything goes wrong, Ctrl-C included, and `path` is then as it was.

    Raises:
        SettingError: the folder of `path` does not exist, `path` is a folder, or the system
            refuses to write there.
    """
    target = Path(path)
    folder = target.parent
    if not folder.is_dir():
        raise SettingError(f"cannot write {target}: the folder {folder} does not exist")
    if target.is_dir():
        raise SettingError(f"cannot write {target}: it is a folder, name a file")
    temporary = target.with_name(f".{target.stem}-{os.getpid()}{target.suffix}")
    try:
        yield temporary
        os.replace(temporary, target)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise SettingError(f"cannot write {target}: {error.strerror or error}") from error
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
