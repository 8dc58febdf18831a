"""The arrays of a herd's state and command, made for its numbers of creatures, feet and joints."""

from __future__ import annotations

from typing import Any, get_type_hints

import numpy as np

from polypod.activity import STANDING
from polypod.body.particles import HARMONICS
from polypod.morphology.types import BoolArray, IntArray
from polypod.paths.curve import path_store
from polypod.routes.state import make_route_state
from polypod.spine.advancing import MOMENTS, TRACK
from polypod.spine.leading import KEPT
from polypod.state import HerdCommand, HerdState


def _allocate(kind: Any, shapes: dict[str, tuple[int, ...]], **given: Any) -> Any:
    hints = get_type_hints(kind)
    zeros = {name: np.zeros(shape, _dtype(hints[name])) for name, shape in shapes.items()}
    return kind(**zeros, **given)


def _dtype(hint: Any) -> Any:
    if hint == IntArray:
        return np.int64
    return np.bool_ if hint == BoolArray else np.float64


def make_state(
    count: int, feet: int, joints: int, girdles: int, segments: int, tail: int
) -> HerdState:
    """Return the state of a herd, all zero; `segments` of a spine, and `tail` of its tail."""
    c, k, j = count, feet, joints
    scalar = dict.fromkeys(
        (
            "heading",
            "turn_rate",
            "speed",
            "waypoint",
            "travelled",
            "needle",
            "cycle_rate",
            "held",
            "duty",
            "plane_height",
            "hurry",
            "frame",
            "detour",
            "blend_left",
            "gait_number",
            "least_down",
            "turn",
            "steps",
            "pace",
            "yielded",
            "crowded",
            "member",
            "activity",
            "halted",
            "halts",
            "gravity_share",
            "beat_period",
            "vault",
            "sinusoid_share",
            "heave",
            "heave_step",
            "rung",
            "gait_speed",
            "gait_vault",
            "sink",
            "caution",
            "cycles",
            "seed",
            "sway",
            "swayed",
            "caught",
            "caught_clock",
            "shy",
            "track_gone",
            "track_from",
            "led",
            "kept_gone",
            "front_rate",
        ),
        (c,),
    )
    per_foot = dict.fromkeys(
        (
            *(
                "swing_start",
                "swing_extent",
                "goal_start",
                "goal_extent",
                "swinging",
                "stood",
                "airborne",
            ),
            *(
                "lift_phase",
                "swing_progress",
                "waiting",
                "foot_support",
                "path_launch",
                "path_profile",
                "residual",
                "pull",
                "reaching",
                "landing_support",
                "plan_clock",
                "plan_seconds",
                "swing_begun",
                "particle_offset",
                "particle_rise",
                "gait_touchdown",
                "gait_share",
                "gait_lag",
            ),
        ),
        (c, k),
    )
    places = dict.fromkeys(
        (
            "foot",
            "foot_start",
            "foot_shown",
            "foot_target",
            "foot_preferred",
            "foot_reached",
            "wish",
            "landing_own",
        ),
        (c, k, 3),
    )
    turns = dict.fromkeys(
        ("foot_rotation", "foot_rotation_start", "foot_rotation_target"), (c, k, 4)
    )
    shapes: dict[str, tuple[int, ...]] = {
        **scalar,
        **per_foot,
        **places,
        **turns,
        "position": (c, 3),
        "rotation": (c, 4),
        "foot_pitch": (c, k, 3),
        "foot_bend": (c, k, 3),
        "roll_start": (c, k, 4),
        "roll_plan": (c, k, 3),
        "spacing": (c, k, 2),
        "deflection": (c, 6),
        "gait_duty": (c, 3),
        "steered": (c, 16),
        "slope": (c, 2),
        "asked": (c, 4),
        "judged": (c, 3),
        "tilt": (c, 2, 3),
        "lift": (c, 3),
        "girdle_offset": (c, girdles),
        "beat": (c, HARMONICS, 6),
        "nod_share": (c, 2),
        "nod": (c, 2),
        "room": (c, 2),
        "sway_share": (c, 3),
        "segment_shift": (c, segments + tail, 3),
        "segment_turn": (c, segments + tail, 4),
        "spine_angle": (c, segments + tail, 3),
        "spine_base": (c, 3),
        "spine_wish": (c, segments + tail, 3),
        "spine_base_wish": (c, 3),
        "girdle_bend": (c, girdles, 5, 3),
        "girdle_was": (c, girdles, 5, 3),
        "girdle_sway": (c, girdles, 2),
        "spine_share": (c, 2, 3),
        "spine_struck": (c, 2),
        "gaze": (c, 3),
        "tail_sway": (c, tail, 2, 3),
        "track": (c, TRACK),
        "kept_way": (c, KEPT + 2),
        "way_ahead": (c, MOMENTS, 2),
        "joint_position": (c, j, 3),
        "joint_rotation": (c, j, 4),
    }
    state: HerdState = _allocate(
        HerdState, shapes, path=path_store(c, k), route=make_route_state(c)
    )
    for turn in (
        state.rotation, state.joint_rotation, state.foot_rotation, state.segment_turn
    ):  # fmt: skip
        turn[..., 3] = 1.0
    state.foot_rotation_start[..., 3] = 1.0
    state.foot_rotation_target[..., 3] = 1.0
    state.foot_support[:] = -1
    state.landing_support[:] = -1
    state.pace[:] = 1.0
    state.activity[:] = STANDING
    return state


def make_command(count: int, feet: int, waypoints: int) -> HerdCommand:
    """Return a herd's command, all zero but for period and duty, which follow speed."""
    c, k = count, feet
    shapes: dict[str, tuple[int, ...]] = {
        **dict.fromkeys(("speed", "heading", "travel", "step_height", "body_height"), (c,)),
        **dict.fromkeys(("period", "blend_cycles", "waypoint_count", "gait_number"), (c,)),
        "gait_vault": (c,),
        **dict.fromkeys(("duty", "follows", "same_circle"), (c,)),
        "spacing": (c, k, 2),
        "reaching": (c, k),
        "reach_place": (c, k, 3),
        **dict.fromkeys(("gait_touchdown", "gait_share", "gait_lag"), (c, k)),
        "gait_duty": (c, 3),
        "waypoints": (c, max(waypoints, 1), 2),
    }
    command: HerdCommand = _allocate(HerdCommand, shapes)
    command.period[:] = np.nan
    command.duty[:] = np.nan
    command.blend_cycles[:] = 1.5
    return command
