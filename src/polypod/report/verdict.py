"""What figures must be, and in plain words which of them are not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple


class Limit(NamedTuple):
    """A bound on one figure."""

    name: str
    least: float
    most: float
    words: str  # what is wrong beyond it; {} is the value


INFINITE = float("inf")


def _most(name: str, most: float, words: str) -> Limit:
    return Limit(name, -INFINITE, most, words)


# What every walk must keep.
LIMITS = (
    _most("stance_slip_of_leg", 1e-3, "a standing foot slips by {} leg lengths"),
    _most("stance_off_surface_of_leg", 2e-3, "a standing foot is {} leg lengths off the surface"),
    _most("stance_residual_of_leg", 1e-3, "a standing foot misses its place by {} leg lengths"),
    _most("stance_inside_of_leg", 2e-3, "a standing foot is {} leg lengths inside something"),
    _most("swing_inside_of_leg", 1e-2, "a swinging foot is {} leg lengths inside something"),
    _most("swing_residual_of_leg_999", 1e-3, "1 of 1000 swing frames misses by {} leg lengths"),
    _most("swing_residual_of_leg", 1e-2, "a swinging foot misses its way by {} leg lengths"),
    _most("forbidden_stances", 0, "{} steps stand on a forbidden obstacle"),
    _most("forbidden_crossings", 0, "{} swings cross a forbidden obstacle"),
    _most("joint_turn_deg", 45.0, "a joint turns by {} degrees between two frames"),
    _most("joint_limit_excess_deg", 1e-3, "a joint is {} degrees beyond its limit"),
    _most("spine_limit_excess_deg", 1e-3, "a joint of the spine is {} degrees beyond its limit"),
    _most("spine_twist_step_deg", 10.0, "the spine twists by {} degrees between two frames"),
    _most("bone_variation", 1e-5, "a bone's length varies by {} of itself"),
    _most("played_stance_slip_of_leg", 1e-3, "as played, a standing foot slips by {} leg lengths"),
    _most(
        "played_stance_off_surface_of_leg",
        2e-3,
        "as played, a standing foot is {} leg lengths off the surface",
    ),
)

# What a good walk keeps: worth a look where it does not.
YARDSTICKS = (
    _most("blocked_s", 0.0, "no way led to its goal, it stood before it for {} s"),
    _most("waiting_s", 1.0, "it waited {} s for a place to step or for others"),
    # Legs reach so far and no farther, but for rounding.
    _most("leg_stretch", 0.97 + 1e-9, "a leg is stretched to {} of its length"),
    Limit("body_clearance_of_leg", 0.0, INFINITE, "the belly clears the ground by {} leg lengths"),
    Limit("body_force_least_g", 0.0, INFINITE, "the body is pushed by {} g"),
    _most("body_tremor_share", 0.02, "{} of the body's motion is tremor"),
    _most("duty_error", 0.06, "a duty factor is {} off the gait's"),
    _most("phase_error", 0.05, "a footfall is {} of a stride off the gait's"),
    Limit("swing_apex_of_leg", 0.08, 0.35, "swings rise by {} leg lengths"),
    _most("foot_tilt_deg", 5.0, "feet stand {} degrees from flat on the ground"),
    _most("foot_sunk_of_leg", 1e-2, "a standing foot's shape is {} leg lengths in the ground"),
    _most("legs_touching_share", 1e-3, "legs touch each other in {} of the frames"),
)


def failures(figures: Mapping[str, object], least_distance_share: float | None = None) -> list[str]:
    """Return one sentence for each limit that is broken, none for a walk that keeps them all.

    `least_distance_share` is the share of the commanded distance that must be walked. A figure
    that is absent or None is not judged, but for the distance where a share of it is asked for.
    """
    limits = list(LIMITS)
    if least_distance_share is not None:
        words = "{} of the commanded distance is walked"
        limits.append(Limit("distance_share", least_distance_share, INFINITE, words))
        if not isinstance(figures.get("distance_share"), int | float):
            return [*_broken(figures, limits), "the distance walked was not measured"]
    return _broken(figures, limits)


def remarks(figures: Mapping[str, object]) -> list[str]:
    """Return one sentence for each yardstick of a good walk that is missed."""
    return _broken(figures, YARDSTICKS)


def _broken(figures: Mapping[str, object], limits: tuple[Limit, ...] | list[Limit]) -> list[str]:
    sentences = []
    for limit in limits:
        value = figures.get(limit.name)
        if not isinstance(value, int | float) or limit.least <= value <= limit.most:
            continue
        under = value < limit.least
        bound = limit.least if under else limit.most
        words = limit.words.format(_beside(value, bound))
        sentences.append(f"{words}, {'under' if under else 'over'} {_number(bound)}")
    return sentences


def _beside(value: float, bound: float) -> str:
    """Return a number with as many digits as tell it from a bound."""
    for digits in range(4, 17):
        text = f"{value:.{digits}g}"
        if isinstance(value, int) or float(text) != bound:
            break
    return str(value) if isinstance(value, int) else text


def _number(value: float) -> str:
    return str(value) if isinstance(value, int) else f"{value:.4g}"
