"""Gait files: a user's own disks as TOML.

name = "limp"
period = 1.2               # s, optional: else speed and morphology set it
family = "walk"            # optional: walk, run or arthropod
duty = [0.6, 0.7]          # optional: range the mean duty may take with speed

[[foot]]                   # one for each foot, in the creature's order
start = 0.65               # lift-off, fraction of the cycle
extent = 0.35              # swing, fraction of the cycle
lag_per_duty = -1.0        # optional: touchdown's shift per unit of mean duty
"""

from __future__ import annotations

import json
import math
import os
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from polypod.errors import GaitError, choices
from polypod.gait.pattern import Gait

_GAIT_KEYS = ("name", "period", "family", "duty", "foot")
# A foot's keys and what they are where omitted; None: they must be there.
_DISK: tuple[tuple[str, float | None], ...] = (
    ("start", None),
    ("extent", None),
    ("lag_per_duty", 0.0),
)
# A gait is a few lines; anything larger is another file.
LARGEST_FILE = 1_000_000


def read_gait(path: str | os.PathLike[str], foot_count: int | None = None) -> Gait:
    """Read a gait file.

    Args:
        path: the file.
        foot_count: feet of the creature it is for; None: any.

    Raises:
        GaitError: the file cannot be read, or is not a gait for this creature.
    """
    try:
        table = tomllib.loads(_text(path))
    # Beside syntax errors: numbers of thousands of digits, brackets nested beyond the stack.
    except (ValueError, RecursionError) as error:
        reason = " ".join(str(error).split())
        raise GaitError(f"gait file {path} is not valid TOML: {reason}") from None
    _check_keys(path, "the gait", table, _GAIT_KEYS)
    tables = table.get("foot")
    if not (isinstance(tables, list) and tables and all(isinstance(t, dict) for t in tables)):
        raise GaitError(f"gait file {path} needs a [[foot]] table for each foot")
    feet = list(enumerate(tables))
    if foot_count is not None and len(feet) != foot_count:
        raise GaitError(
            f"gait file {path} has {len(feet)} [[foot]] tables; this creature has {foot_count} feet"
        )
    for k, foot in feet:
        _check_keys(path, f"foot {k}", foot, tuple(key for key, _ in _DISK))
    duty = _duty_range(path, table)
    period = _number(path, table, "period", math.nan)
    if "period" in table and math.isnan(period):
        raise GaitError(f"gait file {path}: period must be a number of seconds, not nan")
    disks = np.array(
        [[_number(path, foot, key, default, k) for key, default in _DISK] for k, foot in feet]
    )
    try:
        return Gait(
            name=table.get("name", Path(path).stem),
            swing_start=disks[:, 0],
            swing_extent=disks[:, 1],
            duty_low=duty[0],
            duty_high=duty[1],
            family=table.get("family", "walk"),
            lag_per_duty=disks[:, 2],
            period=period,
        )
    except GaitError as error:
        raise GaitError(f"gait file {path}: {error}") from None


def write_gait(gait: Gait, path: str | os.PathLike[str]) -> None:
    """Write a gait file that reads back as the same gait; an interrupted write leaves no file.

    Raises:
        GaitError: the file cannot be written.
    """
    lines = [f"name = {json.dumps(gait.name, ensure_ascii=False)}"]
    if not math.isnan(gait.period):
        lines.append(f"period = {gait.period!r}  # s")
    lines.append(f'family = "{gait.family}"')
    lines.append(f"duty = [{gait.duty_low!r}, {gait.duty_high!r}]")
    for k in range(gait.foot_count):
        start, extent = float(gait.swing_start[k]), float(gait.swing_extent[k])
        lines += ["", "[[foot]]", f"start = {start!r}", f"extent = {extent!r}"]
        if gait.lag_per_duty[k] != 0.0:
            lines.append(f"lag_per_duty = {float(gait.lag_per_duty[k])!r}")
    write_whole(path, ("\n".join(lines) + "\n").encode())


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a file under another name first, so that it is there whole or not at all.

    Raises:
        GaitError: the file cannot be written.
    """
    target = Path(path)
    try:
        handle, part = tempfile.mkstemp(prefix=f".{target.name}-", dir=target.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            # mkstemp keeps others out; an output file is as open as any other.
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(part, 0o666 & ~mask)
            os.replace(part, target)
        except BaseException:
            Path(part).unlink(missing_ok=True)
            raise
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise GaitError(f"gait output {path} cannot be written: {reason}") from None


def _text(path: str | os.PathLike[str]) -> str:
    try:
        with open(path, "rb") as file:
            data = file.read(LARGEST_FILE + 1)
        if len(data) > LARGEST_FILE:
            raise GaitError(f"gait file {path} is larger than a gait, {LARGEST_FILE} bytes")
        return data.decode("utf-8")
    except OSError as error:
        raise GaitError(f"gait file {path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise GaitError(f"gait file {path} is not UTF-8 text") from None
    except ValueError as error:  # a path with a null character
        raise GaitError(f"gait file {path!r} cannot be read: {error}") from None


def _check_keys(
    path: str | os.PathLike[str], place: str, table: dict[str, Any], known: tuple[str, ...]
) -> None:
    for key in table:
        if key not in known:
            raise GaitError(
                f"gait file {path}: {place} has no key {key!r}; choose from {choices(known)}"
            )


def _number(
    path: str | os.PathLike[str],
    table: dict[str, Any],
    key: str,
    default: float | None,
    foot: int | None = None,
) -> float:
    place = f"foot {foot}: " if foot is not None else ""
    if key not in table:
        if default is None:
            raise GaitError(f"gait file {path}: {place}{key} is missing")
        return default
    value = table[key]
    if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e300:
        raise GaitError(f"gait file {path}: {place}{key} must be a number, not {str(value)[:40]!r}")
    return float(value)


def _duty_range(path: str | os.PathLike[str], table: dict[str, Any]) -> tuple[float, float]:
    if "duty" not in table:
        return math.nan, math.nan
    given = table["duty"]
    if not isinstance(given, list) or len(given) != 2:
        raise GaitError(f"gait file {path}: duty must be [lowest, highest], two numbers")
    low, high = (_number(path, {"duty": value}, "duty", None) for value in given)
    if not 0.0 < low <= high < 1.0:
        raise GaitError(f"gait file {path}: duty must rise from lowest to highest, between 0 and 1")
    return low, high
