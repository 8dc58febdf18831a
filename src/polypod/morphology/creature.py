"""Creature files: a rig and everything about it that a file cannot say itself.

```toml
rig = "spider.glb"               # beside this file, or the name of a built-in creature
leg = ["Hip.L:Foot.L", "Hip.R:Foot.R"]   # omitted: detected
spine = ["Pelvis", "Chest", "Head"]      # from back to head; omitted: detected
tail = ["Tail1", "Tail2"]                # from the trunk to the tip; omitted: detected
forward = "+z"                   # +z, -z, +x or -x; omitted: guessed
height = 1.2                     # m, ground to the top of the skin at rest; omitted: units are m
body_height = 0.5                # m, preferred height of the body centre above the soles

[body]                           # metres in the rest pose; each key may be left out
centre = [0.0, 0.6, -0.1]        # x left, y up from the file's origin, z forward
thickness = 0.2                  # from the centre down to the belly
half_size = [0.2, 0.2, 0.5]      # of the trunk's box

[foot."Foot.L"]                  # by the foot's name as in leg
half_size = [0.02, 0.05]         # along x and z, m
weight = 1.5                     # how much it carries where the others carry 1

[limit."Knee.L"]                 # by the joint's name, radians
bend = [-0.3, 2.0]               # about the rest bend
[limit."Hip.L"]                  # the first joint of a leg
flexion = 1.2                    # either way, from the rest
sideways = 0.5
twist = 0.4
[limit."Spine1"]                 # a joint of spine or tail: either way, against the one before it
yaw = 0.2
pitch = 0.1
roll = 0.1
```

Unknown keys are errors.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from polypod.errors import RigError, choices

KEYS = (
    "rig", "leg", "spine", "tail", "forward", "height", "body_height", "body", "foot", "limit",
)  # fmt: skip
BODY_KEYS = ("centre", "thickness", "half_size")
FOOT_KEYS = ("half_size", "weight")
HIP_KEYS = ("flexion", "sideways", "twist")
SPINE_KEYS = ("yaw", "pitch", "roll")
LIMIT_KEYS = ("bend", *HIP_KEYS, *SPINE_KEYS)
LARGEST_NUMBER = 1e300
# By a joint's name, and by key: one angle or two, radians.
Limits = Mapping[str, Mapping[str, tuple[float, ...]]]


@dataclass(frozen=True)
class Creature:
    """What a creature file says; None or empty where it says nothing."""

    file: str  # for messages
    rig: str
    legs: tuple[str, ...] | None = None
    spine: tuple[str, ...] | None = None
    tail: tuple[str, ...] | None = None
    forward: str | None = None
    height: float | None = None
    body_height: float | None = None
    centre: tuple[float, ...] | None = None
    thickness: float | None = None
    half_size: tuple[float, ...] | None = None
    foot_half_size: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    foot_weight: Mapping[str, float] = field(default_factory=dict)
    limit: Limits = field(default_factory=dict)


def read_creature(path: Path) -> Creature:
    """Read and judge a creature file; `rig` comes back as a path where it names a file beside it.

    Raises:
        RigError: it cannot be read, or holds what it should not.
    """
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as fault:
        raise RigError(f"{path}: cannot be read: {fault.strerror}") from None
    # Beside syntax: bytes that are no text, numbers of thousands of digits, endless brackets.
    except (ValueError, RecursionError) as fault:
        raise RigError(f"{path}: is no TOML: {fault}") from None
    table = _Table(path.name, "", data)
    table.refuse_others(KEYS)
    rig = table.text("rig")
    if rig is None:
        raise RigError(f'{path.name}: rig: must be there, as in rig = "spider.glb"')
    beside = path.parent / rig
    body = table.inner("body", BODY_KEYS)
    feet = table.named("foot", FOOT_KEYS)
    return Creature(
        file=path.name,
        rig=str(beside) if beside.is_file() else rig,
        legs=table.texts("leg"),
        spine=table.texts("spine"),
        tail=table.texts("tail"),
        forward=table.text("forward"),
        height=table.number("height", above=0.0),
        body_height=table.number("body_height", above=0.0),
        centre=body.numbers("centre", 3),
        thickness=body.number("thickness", above=0.0),
        half_size=body.numbers("half_size", 3, above=0.0),
        foot_half_size={
            name: size
            for name, foot in feet.items()
            if (size := foot.numbers("half_size", 2, above=0.0)) is not None
        },
        foot_weight={
            name: weight
            for name, foot in feet.items()
            if (weight := foot.number("weight", above=0.0)) is not None
        },
        limit=_all_limits(table),
    )


def judge_limits(what: str, values: object) -> Limits:
    """Return joint limits by the joints' names, as a creature file's [limit] has them, judged.

    Which joints there are is judged where the rig is known.

    Args:
        what: holds them, the start of each error.
        values: a table for each joint.

    Raises:
        RigError: a key that is none, or an angle out of its range.
    """
    return _all_limits(_Table(what, "", {"limit": values}))


def _all_limits(table: _Table) -> Limits:
    return {name: _limits(entry) for name, entry in table.named("limit", LIMIT_KEYS).items()}


def _limits(entry: _Table) -> dict[str, tuple[float, ...]]:
    found: dict[str, tuple[float, ...]] = {}
    bend = entry.numbers("bend", 2)
    if bend is not None:
        if not -math.pi <= bend[0] < bend[1] <= math.pi:
            raise entry.error("bend", "must be two angles, the least first, within -pi and pi")
        found["bend"] = bend
    for key in (*HIP_KEYS, *SPINE_KEYS):
        angle = entry.number(key)
        if angle is not None:
            # A spine may be stiff at a joint; a leg that cannot turn at all cannot walk.
            stiff = key in SPINE_KEYS and angle == 0.0
            if not (stiff or 0.0 < angle <= math.pi):
                least = "0 or more" if key in SPINE_KEYS else "above 0"
                raise entry.error(key, f"must be radians, {least} and at most pi")
            found[key] = (angle,)
    return found


@dataclass(frozen=True)
class _Table:
    """A TOML table that knows where it stands."""

    file: str
    place: str
    data: Mapping[str, Any]

    def error(self, key: str, fault: str) -> RigError:
        return RigError(f"{self.file}: {self.place}{key}: {fault}")

    def refuse_others(self, valid: tuple[str, ...]) -> None:
        for key in self.data:
            if key not in valid:
                raise self.error(key, f"is no key here; valid are {choices(valid)}")

    def inner(self, key: str, valid: tuple[str, ...]) -> _Table:
        value = self.data.get(key, {})
        if not isinstance(value, dict):
            raise self.error(key, f"must be a table with {choices(valid)}")
        found = _Table(self.file, f"{self.place}{key}.", value)
        found.refuse_others(valid)
        return found

    def named(self, key: str, valid: tuple[str, ...]) -> dict[str, _Table]:
        value = self.data.get(key, {})
        if not isinstance(value, dict):
            raise self.error(key, f'must hold tables by name, as in [{key}."NAME"]')
        holder = _Table(self.file, f"{self.place}{key}.", value)
        return {name: holder.inner(name, valid) for name in value}

    def text(self, key: str) -> str | None:
        value = self.data.get(key)
        if value is not None and not (isinstance(value, str) and value):
            raise self.error(key, "must be a text in quotes")
        return value

    def texts(self, key: str) -> tuple[str, ...] | None:
        value = self.data.get(key)
        if value is None:
            return None
        if not (isinstance(value, list) and all(isinstance(item, str) and item for item in value)):
            raise self.error(key, 'must be a list of texts, as in ["A", "B"]')
        return tuple(value)

    def number(self, key: str, above: float = -math.inf) -> float | None:
        value = self.data.get(key)
        if value is None:
            return None
        return self._judge(key, value, above)

    def numbers(self, key: str, count: int, above: float = -math.inf) -> tuple[float, ...] | None:
        value = self.data.get(key)
        if value is None:
            return None
        if not (isinstance(value, list | tuple) and len(value) == count):
            raise self.error(key, f"must be a list of {count} numbers")
        return tuple(self._judge(key, item, above) for item in value)

    def _judge(self, key: str, value: Any, above: float) -> float:
        usable = isinstance(value, int | float) and not isinstance(value, bool)
        # Whole numbers may have more digits than any float.
        if not usable or not abs(value) <= LARGEST_NUMBER or not value > above:
            bound = "" if above == -math.inf else f" above {above:g}"
            raise self.error(key, f"must be a number{bound}")
        return float(value)
