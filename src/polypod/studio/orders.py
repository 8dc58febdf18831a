"""What the page may order, and how an order must look (docs/studio-protocol.md)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from polypod.environment.scene_values import shown
from polypod.errors import SettingError, choices
from polypod.studio.overlay_names import OVERLAYS

LONGEST_TEXT = 200
MOST_STEPS_AT_ONCE = 600
SLOWEST, FASTEST = 0.02, 10.0
DEEPEST = 8
Judge = Callable[[Any], bool]


def is_number(value: Any, least: float = -1e9, most: float = 1e9) -> bool:
    """Return whether a value is a finite number within bounds."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and math.isfinite(value) and least <= value <= most


def is_whole(value: Any, least: int = 0, most: int = 2**31 - 1) -> bool:
    """Return whether a value is a whole number within bounds."""
    return isinstance(value, int) and not isinstance(value, bool) and least <= value <= most


def is_text(value: Any) -> bool:
    """Return whether a value is a text that is not too long."""
    return isinstance(value, str) and 0 < len(value) <= LONGEST_TEXT


def _is_place(value: Any) -> bool:
    return (
        isinstance(value, list)
        and 0 < len(value) <= DEEPEST
        and all(is_text(step) or is_whole(step) for step in value)
    )


def _is_vector(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(is_number(v) for v in value)


def _are_overlays(value: Any) -> bool:
    return isinstance(value, list) and all(v in OVERLAYS for v in value) and len(value) <= 32


def _is_anything(value: Any) -> bool:
    return True


# For each order its keys: what each must be, in words, how that is judged, and whether it may miss.
Key = tuple[str, Judge, bool]
ORDERS: dict[str, dict[str, Key]] = {
    "edit": {
        "at": ("a list of keys and indices", _is_place, False),
        "to": ("a value", _is_anything, False),
        "gesture": ("a text", is_text, True),
    },
    "undo": {},
    "redo": {},
    "open": {"document": ("a document", lambda v: isinstance(v, dict), False)},
    "gait": {
        "name": ("a gait's name or null", lambda v: v is None or is_text(v), False),
    },
    "clock": {
        "playing": ("true or false", lambda v: isinstance(v, bool), True),
        "rate": (
            f"a number from {SLOWEST:g} to {FASTEST:g}",
            lambda v: is_number(v, SLOWEST, FASTEST),
            True,
        ),
        "steps": (
            f"a whole number from 1 to {MOST_STEPS_AT_ONCE}",
            lambda v: is_whole(v, 1, MOST_STEPS_AT_ONCE),
            True,
        ),
    },
    "push": {
        "creature": ("a creature's number", is_whole, True),
        "velocity": ("three numbers, m/s", _is_vector, False),
        "at": ("a number of metres", is_number, True),
    },
    "restart": {},
    "see": {"overlays": (f"a list out of {choices(OVERLAYS)}", _are_overlays, False)},
    "record": {"on": ("true or false", lambda v: isinstance(v, bool), False)},
    "scrub": {"frame": ("a frame's number or null", lambda v: v is None or is_whole(v), False)},
    "watch": {"creature": ("a creature's number", is_whole, False)},
    "drive": {},
    "ack": {"frame": ("a frame's number", lambda v: is_whole(v, 0, 2**32 - 1), False)},
}
# Those that change nothing for others: any tab may give them.
FOR_ALL = ("see", "watch", "drive", "ack")


def judge_order(order: Mapping[str, Any]) -> None:
    """Judge an order's keys and values; its `id` is whole, if it has one.

    Raises:
        SettingError: what is wrong with it, and what may be.
    """
    name = order.get("do")
    if not isinstance(name, str) or name not in ORDERS:
        raise SettingError(f"there is no order {shown(name)}; the orders are {choices(ORDERS)}")
    keys = ORDERS[name]
    for key in order:
        if key not in keys and key not in ("do", "id"):
            have = choices(keys) if keys else "none"
            raise SettingError(f"{name} has no key {shown(key)}; its keys are {have}")
    if "id" in order and not is_whole(order["id"]):
        raise SettingError(f"an order's id is {shown(order['id'])}; it must be a whole number")
    for key, (words, good, may_miss) in keys.items():
        if key not in order:
            if may_miss:
                continue
            raise SettingError(f"{name} needs {key}: {words}")
        if not good(order[key]):
            raise SettingError(f"{name} has {key} = {shown(order[key])}; it must be {words}")
