"""Values of options, judged as they are read: each returns the value or says what is wanted."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable

LARGEST_PLACE = 1e5  # m: beyond it positions lose the precision of a footprint
MOST_WAYPOINTS = 10_000


def number(low: float, high: float, unit: str, *, above: bool = False) -> Callable[[str], float]:
    """Return a reader of numbers from `low` (or `above` it) to `high`."""
    bound = f"above {low:g} and at most {high:g}" if above else f"from {low:g} to {high:g}"
    wanted = f"give a number {bound}{' ' + unit if unit else ''}"

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{shown(text)} is no number; {wanted}") from None
        if not (low <= value <= high and not (above and value <= low)):
            raise argparse.ArgumentTypeError(f"{shown(text)} is out of range; {wanted}")
        return value

    return read


def whole(low: int, high: int, what: str) -> Callable[[str], int]:
    """Return a reader of whole numbers from `low` to `high`."""
    wanted = f"give {what}, a whole number from {low} to {high}"

    def read(text: str) -> int:
        # Python refuses to read numbers of thousands of digits.
        try:
            value = int(text)
        except ValueError:
            message = f"{shown(text)} is no whole number; {wanted}"
            raise argparse.ArgumentTypeError(message) from None
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{shown(text)} is out of range; {wanted}")
        return value

    return read


def waypoints(text: str) -> tuple[tuple[float, float], ...]:
    """Read "x,z x,z ..." in metres, two places at least."""
    wanted = 'give at least two places in metres, as in "0,0 2,5"'
    points: list[tuple[float, float]] = []
    for part in text.split():
        numbers = part.split(",")
        try:
            values = [float(value) for value in numbers]
        except ValueError:
            values = []
        if len(values) != 2:
            raise argparse.ArgumentTypeError(f"{shown(part)} is no place x,z; {wanted}")
        if not all(math.isfinite(v) and abs(v) <= LARGEST_PLACE for v in values):
            message = f"{shown(part)} is not within {LARGEST_PLACE:g} m of the origin; {wanted}"
            raise argparse.ArgumentTypeError(message)
        if not points or (values[0], values[1]) != points[-1]:
            points.append((values[0], values[1]))
    if len(points) < 2:
        raise argparse.ArgumentTypeError(f"{shown(text)} has no way to walk; {wanted}")
    return tuple(points)


def names(text: str) -> tuple[str, ...]:
    """Read names separated by commas."""
    found = tuple(name.strip() for name in text.split(","))
    if not all(found):
        raise argparse.ArgumentTypeError(
            f"{shown(text)} has an empty name; give joints with commas between, as in Pelvis,Chest"
        )
    return found


def filled(text: str) -> str:
    """Read a text that is not empty."""
    if not text.strip():
        raise argparse.ArgumentTypeError("it is empty; give a name or a file")
    return text


def shown(text: str) -> str:
    """Return a user's word, quoted and not too long."""
    return repr(text if len(text) <= 60 else text[:57] + "...")
