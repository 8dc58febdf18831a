"""Reads fields of parsed JSON that may hold anything, and names the place when one is wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from polypod.errors import RigError

MISSING = object()
LARGEST_WHOLE = 1 << 53  # what every JSON reader can hold; nothing in a file is larger


@dataclass(frozen=True)
class Place:
    """A JSON object together with where it is, so that an error can say both."""

    file: str  # name of the file, for messages
    path: str  # such as "nodes[3].translation"; empty for the whole file
    value: dict[str, Any]

    def error(self, text: str, key: str = "") -> RigError:
        """Return an error whose sentence starts with the file and the place."""
        place = ".".join(part for part in (self.path, key) if part)
        return RigError(f"{self.file}: {place} {text}" if place else f"{self.file}: {text}")

    def has(self, key: str) -> bool:
        """Return whether the field is there at all."""
        return key in self.value

    def integer(self, key: str, default: int | None = None, below: int | None = None) -> int:
        """Return a whole number, not negative and, where `below` is given, under it.

        Raises:
            RigError: it is missing without a default, no whole number, or out of range.
        """
        found = self.value.get(key, MISSING)
        if found is MISSING and default is not None:
            return default
        number = whole(found)
        if number is None or not 0 <= number < LARGEST_WHOLE:
            raise self.error(f"must be a whole number, not {shown(found)}", key)
        if below is not None and number >= below:
            raise self.error(f"is {number}, but must be below {below}", key)
        return number

    def reference(self, key: str, count: int) -> int:
        """Return an index into a list of `count` things, or -1 where the field is missing."""
        return self.integer(key, below=count) if self.has(key) else -1

    def indices(self, key: str, count: int) -> list[int]:
        """Return a list of indices, each below `count`; empty where the field is missing."""
        listed = self.value.get(key, [])
        if not isinstance(listed, list):
            raise self.error(f"must be a list, not {shown(listed)}", key)
        numbers = [whole(item) for item in listed]
        result = [number for number in numbers if number is not None and 0 <= number < count]
        if len(result) != len(listed):
            at = next(i for i, n in enumerate(numbers) if n is None or not 0 <= n < count)
            raise self.error(f"is {shown(listed[at])}, but must be below {count}", f"{key}[{at}]")
        return result

    def numbers(self, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """Return as many finite numbers as the default has.

        Raises:
            RigError: too few, too many, or something that is no finite number.
        """
        found = self.value.get(key, MISSING)
        if found is MISSING:
            return default
        if not isinstance(found, list) or len(found) != len(default):
            raise self.error(f"must be {len(default)} numbers, not {shown(found)}", key)
        result = tuple(finite(item) for item in found)
        for at, item in enumerate(result):
            if item is None:
                raise self.error(f"must be a finite number, not {shown(found[at])}", f"{key}[{at}]")
        return tuple(item for item in result if item is not None)

    def text(self, key: str, default: str = "") -> str:
        """Return a string."""
        found = self.value.get(key, default)
        if not isinstance(found, str):
            raise self.error(f"must be text, not {shown(found)}", key)
        return found

    def part(self, key: str) -> Place:
        """Return an object inside this one; an empty one where the field is missing."""
        found = self.value.get(key, {})
        if not isinstance(found, dict):
            raise self.error(f"must be an object, not {shown(found)}", key)
        return Place(self.file, f"{self.path}.{key}" if self.path else key, found)

    def parts(self, key: str) -> list[Place]:
        """Return the objects of a list; none where the field is missing."""
        found = self.value.get(key, [])
        if not isinstance(found, list):
            raise self.error(f"must be a list, not {shown(found)}", key)
        prefix = f"{self.path}.{key}" if self.path else key
        for at, item in enumerate(found):
            if not isinstance(item, dict):
                raise self.error(f"must be an object, not {shown(item)}", f"{key}[{at}]")
        return [Place(self.file, f"{prefix}[{at}]", item) for at, item in enumerate(found)]

    def texts(self, key: str) -> list[str]:
        """Return a list of strings; empty where the field is missing."""
        found = self.value.get(key, [])
        if not isinstance(found, list) or not all(isinstance(item, str) for item in found):
            raise self.error(f"must be a list of texts, not {shown(found)}", key)
        return list(found)


def whole(found: object) -> int | None:
    """Return a JSON number as an int if it is a whole one."""
    if isinstance(found, bool):
        return None
    if isinstance(found, int):
        return found
    return int(found) if isinstance(found, float) and found.is_integer() else None


def finite(found: object) -> float | None:
    """Return a JSON number as a float if it is a finite one."""
    if isinstance(found, bool) or not isinstance(found, int | float):
        return None
    try:
        number = float(found)
    except OverflowError:  # an integer of hundreds of digits
        return None
    return number if math.isfinite(number) else None


def shown(found: object) -> str:
    """Return a value as an error message shows it: short, whatever it is."""
    if found is MISSING:
        return "missing"
    if isinstance(found, int) and found.bit_length() > 256:
        return "an enormous number"
    text = repr(found)
    return text if len(text) <= 40 else text[:37] + "..."
