"""One table of a scene file, read strictly: every value judged, every unknown key refused."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn, TypeVar

from polypod.errors import SceneError, choices

Value = TypeVar("Value")
Made = TypeVar("Made")

ANY_NUMBER = 1e9


class SceneTable:
    """The keys and values of one table, with the words that say where it is."""

    def __init__(self, place: str, values: object, keys: Iterable[str]) -> None:
        """Refuse what is no table or has an unknown key.

        Args:
            place: file and table, the start of each error.
            values: what the file holds there.
            keys: all keys that such a table may have.
        """
        self.place = place
        if not isinstance(values, Mapping):
            raise SceneError(f"{place} must be a table of keys, not {shown(values)}")
        self.values: Mapping[str, Any] = values
        for key in values:
            if key not in keys:
                raise SceneError(f"{place} has no key {key!r}; its keys are {choices(keys)}")

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def fail(self, key: str, wanted: str) -> NoReturn:
        """Raise the error that says what `key` is and what it must be."""
        if key not in self.values:
            raise SceneError(f"{self.place} needs {key}: {wanted}")
        raise SceneError(f"{self.place} has {key} = {shown(self.values[key])}; it must be {wanted}")

    def _read(
        self, key: str, default: Value | None, wanted: str, read: Callable[[Any], Value | None]
    ) -> Value:
        if key not in self.values and default is not None:
            return default
        value = read(self.values.get(key))
        if value is None:
            self.fail(key, wanted)
        return value

    def number(
        self,
        key: str,
        default: float | None = None,
        least: float = -ANY_NUMBER,
        greatest: float = ANY_NUMBER,
    ) -> float:
        """Return a number within bounds; without a default the key is required."""
        wanted = f"a number from {least:g} to {greatest:g}"
        return self._read(key, default, wanted, lambda v: as_number(v, least, greatest))

    def whole(self, key: str, default: int | None, least: int, greatest: int) -> int:
        """Return a whole number within bounds."""

        def read(value: Any) -> int | None:
            whole = isinstance(value, int) and not isinstance(value, bool)
            return value if whole and least <= value <= greatest else None

        return self._read(key, default, f"a whole number from {least} to {greatest}", read)

    def text(self, key: str, default: str | None = None) -> str:
        """Return a text that is not empty."""
        return self._read(key, default, "a text", as_text)

    def flag(self, key: str, default: bool) -> bool:
        """Return true or false."""
        return self._read(
            key, default, "true or false", lambda v: v if isinstance(v, bool) else None
        )

    def numbers(
        self,
        key: str,
        names: str,
        default: tuple[float, ...] | None = None,
        least: float = -ANY_NUMBER,
        greatest: float = ANY_NUMBER,
    ) -> tuple[float, ...]:
        """Return as many numbers as `names` has words: `"x z"`."""
        listed = ", ".join(names.split())
        wanted = f"[{listed}], each a number from {least:g} to {greatest:g}"
        return self._read(
            key, default, wanted, lambda v: as_numbers(v, len(names.split()), least, greatest)
        )

    def rows(
        self, key: str, names: str, fewest: int, most: int, default: tuple[()] | None = None
    ) -> tuple[tuple[float, ...], ...]:
        """Return a list of `fewest` to `most` lists of numbers."""
        listed = ", ".join(names.split())
        wanted = f"{fewest} to {most} times [{listed}], all numbers"

        def read(value: Any) -> tuple[tuple[float, ...], ...] | None:
            if not isinstance(value, list) or not fewest <= len(value) <= most:
                return None
            rows = [as_numbers(row, len(names.split()), -ANY_NUMBER, ANY_NUMBER) for row in value]
            return tuple(row for row in rows if row is not None) if None not in rows else None

        return self._read(key, default, wanted, read)

    def texts(self, key: str) -> tuple[str, ...]:
        """Return a list of texts; nothing when the key is missing."""

        def read(value: Any) -> tuple[str, ...] | None:
            if not isinstance(value, list) or any(as_text(entry) is None for entry in value):
                return None
            return tuple(value)

        return self._read(key, (), "a list of texts", read)


def within(place: str, make: Callable[[], Made]) -> Made:
    """Return what `make` makes; an error of it says the place first."""
    try:
        return make()
    except SceneError as error:
        raise SceneError(f"{place}: {error}") from None


def as_number(value: Any, least: float, greatest: float) -> float | None:
    """Return a number as float, or None where it is none or out of bounds."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return float(value) if least <= value <= greatest else None


def as_numbers(value: Any, count: int, least: float, greatest: float) -> tuple[float, ...] | None:
    """Return a list of `count` numbers as a tuple, or None where it is not one."""
    if not isinstance(value, list) or len(value) != count:
        return None
    numbers = [as_number(entry, least, greatest) for entry in value]
    return tuple(n for n in numbers if n is not None) if None not in numbers else None


def as_text(value: Any) -> str | None:
    """Return a text that is not blank, or None."""
    return value if isinstance(value, str) and value.strip() else None


def shown(value: object) -> str:
    """Return a value as the file would show it, shortened."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int) and abs(value) > 10**18:
        return "a number of many digits"
    try:
        text = repr(value)
    except (ValueError, RecursionError):
        return "something too large to show"
    return text if len(text) <= 60 else text[:57] + "..."
