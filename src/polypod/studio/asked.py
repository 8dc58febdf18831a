"""What a document asks of its first creature, written to the herd; and what may be asked of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from polypod.config import Settings
from polypod.errors import SettingError
from polypod.gait.library import make_gait, names
from polypod.gait.pattern import Gait
from polypod.gait.tempo import top_speed
from polypod.herd import Herd
from polypod.jobs.cast import comfortable_speed
from polypod.morphology.types import Morphology
from polypod.report.record import bones
from polypod.report.scenery import foot_colours
from polypod.studio.anatomy import limit_fans, pelvis_nodes, spine_line
from polypod.studio.document import SETTINGS, Document
from polypod.studio.joint_limits import LimitedRig, list_limits

# How much farther than the gait's top speed a speed may be asked for, and how high feet may be
# lifted and bodies carried, leg lengths.
FASTER = 1.25
HIGHEST_STEP, LOWEST_BODY, HIGHEST_BODY = 0.8, 0.5, 1.25
EDITED_DUTY = (0.05, 0.95)


def settings_of(document: Document) -> Settings:
    """Return the settings that a document asks for."""
    scales = {key: float(document["settings"][key]) for key in SETTINGS}
    return replace(Settings(), **scales)  # type: ignore[arg-type]


def gait_of(document: Document, morphology: Morphology) -> Gait | None:
    """Return the gait that a document asks for; None: it follows the speed.

    Disks that are those of a gait of the library are that gait: its duty follows the speed. Others
    stay as they were drawn.

    Raises:
        SettingError: they are for another number of feet, or no gait.
    """
    asked = document["gait"]
    if asked is None:
        return None
    start, extent = np.array(asked["start"], float), np.array(asked["extent"], float)
    feet = len(morphology.foot_name)
    if len(start) != feet or len(extent) != feet:
        raise SettingError(
            f"the gait has {len(start)} starts and {len(extent)} extents; "
            f"{morphology.name} has {feet} feet"
        )
    if asked["name"] in names():
        legs = morphology.legs
        known = make_gait(asked["name"], legs.side, legs.row)
        if np.allclose(known.swing_start, start) and np.allclose(known.swing_extent, extent):
            return known
    return Gait(asked["name"], np.mod(start, 1.0), extent)


def is_drawn(document: Document) -> bool:
    """Return whether a document's gait is none of the library's."""
    return document["gait"] is not None and document["gait"]["name"] not in names()


def disks_of(gait: Gait) -> dict[str, Any]:
    """Return a gait as a document holds it."""
    return {
        "name": gait.name,
        "start": [float(v) for v in gait.swing_start],
        "extent": [float(v) for v in gait.swing_extent],
    }


def spacing_of(document: Document, morphology: Morphology) -> np.ndarray[Any, Any]:
    """Return the shift [K, 2] of each foot's rest place, m, stance width included.

    Raises:
        SettingError: the document's is for another number of feet.
    """
    feet = len(morphology.foot_name)
    pairs = document["spacing"] or [[0.0, 0.0]] * feet
    if len(pairs) != feet:
        raise SettingError(f"the spacing is for {len(pairs)} feet; {morphology.name} has {feet}")
    wider = document["command"]["stance_width"] - 1.0
    spacing = np.array(pairs, float)
    spacing[:, 0] += wider * morphology.legs.sole_stance[:, 0]
    return spacing


def ask(herd: Herd, document: Document, before: Document | None) -> None:
    """Write what a document asks for to a herd, as far as it is new.

    Raises:
        SettingError: it asks for what this creature cannot be asked; nothing was written.
    """
    morphology = herd.morphology
    gait = gait_of(document, morphology)
    spacing = spacing_of(document, morphology)
    settings = settings_of(document)
    ranges = ranges_of(herd)
    command = {key: _number(key, document, ranges) for key in ranges}
    herd.settings = settings
    for key in ("speed", "heading", "travel", "step_height", "body_height", "blend_cycles"):
        if before is None or document["command"][key] != before["command"][key]:
            setattr(herd.command, key, command[key])
    herd.command.spacing = spacing
    if before is None or document["gait"] != before["gait"]:
        # Disks that are drawn are drawn out of those in use.
        drawn = before is not None and (is_drawn(document) or is_drawn(before))
        if gait is None:
            herd.command.follow_speed(same_circle=drawn)
        else:
            herd.command.set_gait(gait, same_circle=drawn)
    # After the gait, which may bring a period of its own.
    herd.command.period = document["command"]["period"]
    herd.command.duty = document["command"]["duty"]
    if before is None or document["path"] != before["path"]:
        for c in range(herd.count):
            if document["path"]:
                herd.command.set_path(document["path"], c)
            else:
                herd.command.arrays.waypoint_count[c] = 0


def _number(key: str, document: Document, ranges: dict[str, dict[str, Any]]) -> float:
    """Return a number of the command, or the default where it says nothing."""
    asked = document["command"][key]
    span = ranges[key]
    if asked is None:
        return math.nan if span["default"] is None else float(span["default"])
    if not span["least"] - 1e-9 <= asked <= span["most"] + 1e-9:
        raise SettingError(
            f"{key} is {asked:g}; it must be from {span['least']:.4g} to {span['most']:.4g} "
            f"{span['unit']}"
        )
    return float(asked)


def ranges_of(herd: Herd) -> dict[str, dict[str, Any]]:
    """Return for each number of the command its least, most, default, unit and step."""
    tables = herd.tables
    leg, body = tables.leg_length, herd.morphology.body.height
    slowest_duty = float(tables.ladder.duty[:, 1].min())
    fastest = float(top_speed(leg, slowest_duty, float(tables.ik.stance_travel.min())))
    comfortable = comfortable_speed(herd.morphology)
    step = herd.own_step_height(Settings())
    pendulum = tables.pendulum_time

    def span(least: float, most: float, default: float | None, unit: str) -> dict[str, Any]:
        return {
            "least": least, "most": most, "default": default, "unit": unit,
            "step": (most - least) / 200.0,
        }  # fmt: skip

    return {
        "speed": span(0.0, FASTER * max(fastest, comfortable), comfortable, "m/s"),
        "heading": span(-1e4, 1e4, 0.0, "rad"),
        "travel": span(-math.pi, math.pi, 0.0, "rad"),
        "step_height": span(0.0, max(HIGHEST_STEP * leg, step), step, "m"),
        "body_height": span(LOWEST_BODY * body, HIGHEST_BODY * body, body, "m"),
        "stance_width": span(0.5, 1.6, 1.0, "times"),
        "period": span(0.5 * pendulum, 20.0 * pendulum, None, "s"),
        "duty": span(*EDITED_DUTY, None, "of the cycle"),
        "blend_cycles": span(0.1, 10.0, 1.0, "cycles"),
    }


def limits_of(herd: Herd, rig: LimitedRig) -> dict[str, Any]:
    """Return the message that says how far a creature's joints turn now."""
    return {
        "is": "limits",
        "ranges": ranges_of(herd),
        "limits": list_limits(herd, rig),
        "fans": limit_fans(herd),
    }


def facts_of(herd: Herd, rig: LimitedRig) -> dict[str, Any]:
    """Return the message that says what a creature is."""
    morphology, tables = herd.morphology, herd.tables
    legs, body, spine = morphology.legs, morphology.body, morphology.segments
    colours = foot_colours(len(morphology.foot_name))
    feet = [
        {
            "name": name,
            "side": int(legs.side[k]),
            "row": int(legs.row[k]),
            "colour": "#" + "".join(f"{round(255 * v):02x}" for v in colours[k]),
            "rest": [float(legs.sole_stance[k, 0]), float(legs.sole_stance[k, 2])],
            "hip": [float(v) for v in legs.point_rest[k, 0]],
            "length": float(legs.length[k]),
        }
        for k, name in enumerate(morphology.foot_name)
    ]
    return {
        **limits_of(herd, rig),
        "is": "creature",
        "name": morphology.name,
        "feet": feet,
        "joints": list(morphology.joint_name),
        "rest": np.round(morphology.joint_rest, 6).tolist(),
        "bones": bones(morphology).tolist(),
        "spine": [int(row) for row in spine.joint],
        "body": {
            "half_size": [float(v) for v in body.half_size],
            "centre": [float(v) for v in tables.body.box_centre],
            "height": float(body.height),
            "thickness": float(body.thickness),
        },
        "leg_length": float(tables.leg_length),
        "hip_height": float(tables.hip_height),
        "pendulum_time": float(tables.pendulum_time),
        "guesses": list(morphology.guesses),
        "gaits": list(names()),
        "ladder": list(herd.ladder),
        "file_limit": rig.said,
        "spine_line": spine_line(morphology),
        "pelvis": pelvis_nodes(morphology),
    }
