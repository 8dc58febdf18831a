"""How near a creature's legs come to one another: the room between their sections, in 3D."""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from polypod.report.arrays import FloatArray
from polypod.report.joints import leg_rows
from polypod.report.record import Recording


class Room(NamedTuple):
    """The least room between any two legs in each frame."""

    of_leg: FloatArray  # [F] leg lengths, negative: inside one another; infinite for a single leg
    legs: tuple[tuple[int, int], ...]  # [F] whose it is


def leg_places(recording: Recording, leg: int) -> FloatArray:
    """Return [F, N + 1, 3] the ends of a leg's N sections, hip first, the sole last; world, m."""
    rows = leg_rows(recording.morphology.legs, leg)
    sole = recording.foot_position[:, leg, None]
    return np.concatenate([recording.joint_position[:, rows], sole], axis=1)


def leg_room(recording: Recording) -> Room:
    """Return the least room between two legs' surfaces in each frame.

    A section is as thick as the skin about it (`LegTable.section_radius`). Two thighs are not
    compared: they hang on the body as it was made.
    """
    morphology = recording.morphology
    places = [leg_places(recording, leg) for leg in range(len(morphology.foot_name))]
    least = np.full(len(recording.time), np.inf)
    whose = np.zeros((len(recording.time), 2), np.int64)
    for a, b in combinations(range(len(places)), 2):
        leg_length = float(min(morphology.legs.length[a], morphology.legs.length[b]))
        reach = float(morphology.legs.length[a] + morphology.legs.length[b])
        apart = np.linalg.norm(places[a][:, 0] - places[b][:, 0], axis=1).min()
        if apart > reach:
            continue
        for i in range(places[a].shape[1] - 1):
            for j in range(places[b].shape[1] - 1):
                if i == 0 and j == 0:
                    continue
                thick = morphology.legs.section_radius[a, i] + morphology.legs.section_radius[b, j]
                gap = segment_distance(
                    places[a][:, i], places[a][:, i + 1], places[b][:, j], places[b][:, j + 1]
                )
                room = (gap - thick) / leg_length
                nearer = room < least
                least[nearer] = room[nearer]
                whose[nearer] = (a, b)
    return Room(least, tuple((int(a), int(b)) for a, b in whose))


def apart_figures(recording: Recording) -> dict[str, object]:
    """Return the least room between two legs, and in what share of frames any two touch."""
    room = leg_room(recording).of_leg
    if not np.isfinite(room).any():
        return {"leg_room_of_leg": None, "legs_touching_share": 0.0}
    return {
        "leg_room_of_leg": float(room.min()),
        "legs_touching_share": float(np.mean(room < 0.0)),
    }


def segment_distance(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    """Return [F] the distances between the segments a-b and c-d [F, 3].

    The least of the four ends' distances from the other segment, and, where the lines' own nearest
    points lie on both segments, of theirs.
    """
    ends = [_from_segment(a, c, d), _from_segment(b, c, d)]
    ends += [_from_segment(c, a, b), _from_segment(d, a, b)]
    nearest: FloatArray = np.min(ends, axis=0)
    across = np.cross(b - a, d - c)
    square = np.einsum("fi,fi->f", across, across)
    scale = np.einsum("fi,fi->f", b - a, b - a) * np.einsum("fi,fi->f", d - c, d - c)
    skew = square > 1e-12 * scale
    safe = np.where(skew, square, 1.0)
    s = np.einsum("fi,fi->f", np.cross(c - a, d - c), across) / safe
    t = np.einsum("fi,fi->f", np.cross(c - a, b - a), across) / safe
    inside = skew & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    gap = np.abs(np.einsum("fi,fi->f", c - a, across)) / np.sqrt(safe)
    return np.where(inside, np.minimum(nearest, gap), nearest)


def _from_segment(point: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    way = b - a
    square = np.einsum("fi,fi->f", way, way)
    along = np.einsum("fi,fi->f", point - a, way) / np.where(square > 0.0, square, 1.0)
    nearest = a + np.clip(along, 0.0, 1.0)[:, None] * way
    distance: FloatArray = np.linalg.norm(point - nearest, axis=1)
    return distance
