"""What went wrong, where, and the valid choices.

Every error a user can cause is a `PolypodError` whose text is one sentence. The command line prints
it and exits with code 2; the library lets it through.
"""

from __future__ import annotations

from collections.abc import Iterable


class PolypodError(Exception):
    """Something given cannot be used; the text names the file, the place and the choices."""


class RigError(PolypodError):
    """A rig file cannot be read, or its legs cannot walk."""


class SceneError(PolypodError):
    """A scene file, a terrain or an obstacle cannot be used."""


class GaitError(PolypodError):
    """A gait has no such name, or its disks are not a gait."""


class SettingError(PolypodError):
    """A number, a name or an output path asked for cannot be used."""


def choices(names: Iterable[str], limit: int = 24) -> str:
    """Return names as an English list, shortened to `limit` of them."""
    listed = [str(name) for name in names]
    shown = ", ".join(listed[:limit])
    return shown if len(listed) <= limit else f"{shown} and {len(listed) - limit} more"
