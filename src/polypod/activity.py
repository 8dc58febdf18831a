"""What a creature is doing, in a word."""

from __future__ import annotations

from enum import IntEnum

# Kernels read plain numbers.
WALKING, STANDING, ARRIVED, WAITING, BLOCKED = range(5)


class Activity(IntEnum):
    """What a creature is doing; `herd.state.activity` holds these numbers."""

    WALKING = WALKING
    """It moves, or a foot is off the ground."""
    STANDING = STANDING
    """It stands, and nothing else is asked of it."""
    ARRIVED = ARRIVED
    """It stands at the last place of its path."""
    WAITING = WAITING
    """It would go on, and stands: nowhere is a safe place to step, or others are in its way."""
    BLOCKED = BLOCKED
    """It stands as near to its goal as there is a way."""
