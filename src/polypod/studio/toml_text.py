"""Writes TOML: the standard library only reads it."""

from __future__ import annotations

import re
from collections.abc import Mapping
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
    return f"[{', '.join(value_text(item) for item in value)}]"


def key_text(key: str) -> str:
    """Return a key, in quotes where it needs them."""
    return key if BARE.fullmatch(key) else value_text(key)


def table(header: str, values: Mapping[str, Any]) -> str:
    """Return a table with its header; it is empty for the top of a file."""
    lines = [f"{key_text(key)} = {value_text(value)}" for key, value in values.items()]
    return "\n".join([*([header] if header else []), *lines, ""])


def tables_by_name(header: str, tables: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Return a table for each name, under a header that is common to all: `[header.NAME]`."""
    return [table(f"[{header}.{key_text(name)}]", values) for name, values in tables.items()]


def _letter(c: str) -> str:
    if c in '"\\':
        return f"\\{c}"
    return c if c.isprintable() else f"\\U{ord(c):08x}"
