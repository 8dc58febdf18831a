"""Writes TOML: the standard library only reads it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

BARE = re.compile(r"[A-Za-z0-9_-]+")


def value_text(value: Any) -> str:
    """Return a text, a truth, a number or a list of these as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str):
        return f'"{"".join(_letter(c) for c in value)}"'
    if isinstance(value, Mapping):
        return f"{{ {', '.join(pairs(value))} }}"
    return f"[{', '.join(value_text(item) for item in value)}]"


def key_text(key: str) -> str:
    """Return a key, in quotes where it needs them."""
    return key if BARE.fullmatch(key) else value_text(key)


def pairs(values: Mapping[str, Any]) -> list[str]:
    """Return `key = value` for each that is not None."""
    return [f"{key_text(k)} = {value_text(v)}" for k, v in values.items() if v is not None]


def table(header: str, values: Mapping[str, Any], *comments: str) -> str:
    """Return a table with its header, empty for the top of a file, and comments above its keys."""
    lines: Iterable[str] = [f"# {comment}" for comment in comments]
    return "\n".join([*([header] if header else []), *lines, *pairs(values), ""])


def _letter(c: str) -> str:
    if c in '"\\':
        return f"\\{c}"
    return c if c.isprintable() else f"\\U{ord(c):08x}"
