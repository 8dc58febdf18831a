"""Surfaces swept along curves: the few shapes all built-in creatures are made of.

A `Patch` remembers for each vertex where on its axis it sits, so that weights and colours can be
given along the axis and not vertex by vertex. World frame at rest: metres, +Y up, facing +Z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from polypod.morphology.builtin.curves import (
    FloatArray,
    arc_length,
    frames,
    monotone_curve,
    rounded_chain,
)

IntArray = NDArray[np.int64]

LEFT = (1.0, 0.0, 0.0)


@dataclass(frozen=True)
class Patch:
    """A triangle mesh with what its painting and skinning need. V vertices, T triangles."""

    positions: FloatArray  # [V, 3] m
    triangles: IntArray  # [T, 3] counter-clockwise from outside
    centres: FloatArray  # [V, 3] m, the point of the axis each vertex surrounds
    along: FloatArray  # [V] place along the axis: a fraction for bodies, a joint count for limbs
    height: FloatArray  # [V] -1 at the underside to 1 at the upper side of the ring
    faceted: bool = False  # each triangle flat, with edges to be seen


def round_ring(sides: int, exponent: float = 2.0) -> FloatArray:
    """Return a closed superellipse [sides, 2]; exponent 2 is a circle, more is squarer."""
    angle = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    cos, sin = np.cos(angle), np.sin(angle)
    power = 2.0 / exponent
    ring = np.stack([np.sign(cos) * np.abs(cos) ** power, np.sign(sin) * np.abs(sin) ** power], 1)
    return np.round(ring, 12)


def sweep(
    centres: FloatArray,
    radii: FloatArray,
    ring: FloatArray,
    side: ArrayLike = LEFT,
    along: FloatArray | None = None,
    faceted: bool = False,
) -> Patch:
    """Return the tube of a ring carried along a curve.

    Args:
        centres: [R, 3] the curve.
        radii: [R, 3] half widths: across, up and down; a zero first or last row closes to a point,
            any other end is closed flat.
        ring: [S, 2] the section (across, up) for half widths of 1.
        side: the direction of "across"; "up" is the tangent's cross product with it.
        along: [R] what to note as each ring's place; its fraction of the length if omitted.
        faceted: whether to keep edges sharp.
    """
    count, sides = len(centres), len(ring)
    if along is None:
        along = arc_length(centres)
        along = along / along[-1]
    across, up = frames(centres, np.asarray(side, dtype=np.float64))
    vertical = np.where(ring[:, 1] >= 0.0, radii[:, 1:2], radii[:, 2:3]) * ring[:, 1]
    lateral = radii[:, 0:1] * ring[:, 0]
    body = (
        centres[:, None, :]
        + lateral[:, :, None] * across[:, None, :]
        + vertical[:, :, None] * up[:, None, :]
    )
    closed = [bool(np.all(radii[0] <= 0.0)), bool(np.all(radii[-1] <= 0.0))]
    rows = np.arange(count)[int(closed[0]) : count - int(closed[1])]
    points = np.concatenate([body[rows].reshape(-1, 3), centres[[0, -1]]])
    grid = np.arange(len(rows) * sides).reshape(len(rows), sides)
    poles = len(rows) * sides, len(rows) * sides + 1
    vertex_row = np.concatenate([np.repeat(rows, sides), [0, count - 1]])
    return Patch(
        positions=points,
        triangles=_tube_triangles(grid, poles),
        centres=centres[vertex_row],
        along=along[vertex_row],
        height=np.concatenate([np.tile(ring[:, 1], len(rows)), [0.0, 0.0]]),
        faceted=faceted,
    )


def body(
    keys: Sequence[Sequence[float]],
    rings: int,
    sides: int = 12,
    side: ArrayLike = LEFT,
    exponent: float = 2.0,
    pointed: bool = False,
) -> Patch:
    """Return a smooth solid through a few sections.

    Args:
        keys: rows of x, y, z of the centre, then half widths: one (round), two (across, up and
            down alike) or three (across, up, down).
        rings: sections to make.
        sides: vertices around.
        side: the direction of "across".
        exponent: of the superellipse.
        pointed: a zero radius at an end makes a cone instead of a dome.
    """
    table = np.array([_widths(key) for key in keys])
    place = arc_length(table[:, :3])
    place = place / place[-1]
    at = _ring_places(rings, table[0, 3] <= 0.0, table[-1, 3] <= 0.0, pointed)
    power = 1.0 if pointed else 2.0  # the square of a dome's radius falls off in a straight line
    curves = np.concatenate([table[:, :3], table[:, 3:] ** power], axis=1)
    smooth = monotone_curve(place, curves, at)
    radii = np.maximum(smooth[:, 3:], 0.0) ** (1.0 / power)
    return sweep(smooth[:, :3], radii, round_ring(sides, exponent), side, at)


def plated(
    keys: Sequence[Sequence[float]],
    edges: Sequence[float],
    rings: int,
    sides: int = 12,
    side: ArrayLike = LEFT,
    lip: float = 0.06,
    exponent: float = 2.0,
) -> Patch:
    """Return a domed body whose skin is cut into plates, each overlapping the one before it.

    Args:
        keys: as for `body`, closed to a point at both ends.
        edges: places in (0, 1), ascending, where a plate begins that overlaps the one before.
        rings: sections of each plate.
        sides: vertices around.
        side: the direction of "across".
        lip: how far a plate's edge stands out, as a part of the radius there.
        exponent: of the superellipse.
    """
    table = np.array([_widths(key) for key in keys])
    place = arc_length(table[:, :3])
    place = place / place[-1]
    # Domes need their rings close together at the ends, and so the plates are even in angle.
    angle = np.arccos(1.0 - 2.0 * np.array([0.0, *edges, 1.0]))
    at, rise = [], []
    for index in range(len(edges) + 1):
        part = np.linspace(0.0, 1.0, rings + 1)
        at.append(angle[index] + part * (angle[index + 1] - angle[index]))
        at[-1][-1] -= 0.15 * (at[-1][-1] - at[-1][-2]) * (index < len(edges))
        rise.append(lip * (1.0 - part) * (index > 0))
    places = 0.5 - 0.5 * np.cos(np.concatenate(at))
    curves = np.concatenate([table[:, :3], table[:, 3:] ** 2], axis=1)
    smooth = monotone_curve(place, curves, places)
    radii = np.sqrt(np.maximum(smooth[:, 3:], 0.0)) * (1.0 + np.concatenate(rise))[:, None]
    radii[[0, -1]] = 0.0
    return sweep(smooth[:, :3], radii, round_ring(sides, exponent), side, places)


def ellipsoid(
    centre: ArrayLike,
    half_axis: ArrayLike,
    across: float,
    up: float | None = None,
    rings: int = 8,
    sides: int = 10,
    side: ArrayLike = LEFT,
) -> Patch:
    """Return an ellipsoid from its centre, its half axis as a vector and its half widths."""
    middle, axis = np.asarray(centre, dtype=np.float64), np.asarray(half_axis, dtype=np.float64)
    angle = np.linspace(0.0, np.pi, rings + 1)
    centres = middle - np.cos(angle)[:, None] * axis
    height = across if up is None else up
    sine = np.sin(angle)
    sine[[0, -1]] = 0.0
    radii = sine[:, None] * np.array([across, height, height])
    return sweep(centres, radii, round_ring(sides), side)


def limb(
    points: ArrayLike,
    profile: Sequence[Sequence[float]],
    sides: int = 8,
    side: ArrayLike = LEFT,
    corner: float = 0.25,
    pointed: bool = True,
) -> Patch:
    """Return a limb: a tube along a chain of joints, its bends rounded.

    Args:
        points: [N, 3] the joints and the end, m.
        profile: rows of the place in joints (1.5 is halfway between the second and the third
            point), then half widths as for `body`.
        sides: vertices around.
        side: the direction of "across".
        corner: part of the shorter neighbouring segment that a rounded bend takes up on each side.
        pointed: a zero radius at the end makes a cone instead of a dome.
    """
    chain = np.asarray(points, dtype=np.float64)
    table = np.array([_widths([key[0], 0.0, 0.0, *key[1:]]) for key in profile])
    bends = np.arange(1, len(chain) - 1)
    around = (bends[:, None] + corner * np.array([-1.0, -0.5, 0.0, 0.5, 1.0])).reshape(-1)
    around = around[(around > table[0, 0]) & (around < table[-1, 0])]
    places = np.concatenate([table[:, 0], around])
    # Two rings closer than this would make slivers; the profile's own places win.
    order = np.argsort(places, kind="stable")
    places = places[order]
    own = order < len(table)
    keep = np.ones(len(places), dtype=bool)
    for index in np.flatnonzero(~own):
        near = np.abs(places - places[index]) < 0.3 * corner
        keep[index] = not np.any(near & own)
    places = places[keep]
    power = 1.0 if pointed else 2.0
    radii = np.maximum(monotone_curve(table[:, 0], table[:, 3:] ** power, places), 0.0)
    return sweep(
        rounded_chain(chain, places, corner),
        radii ** (1.0 / power),
        round_ring(sides),
        side,
        places,
    )


def embossed(patch: Patch, spots: Sequence[tuple[float, float, float, float]]) -> Patch:
    """Return a patch whose upper side is raised or sunk in round spots.

    Args:
        patch: a shape.
        spots: x and z of the middle in plan, radius and rise there, m; a negative rise is a dent.
    """
    positions = patch.positions.copy()
    for x, z, radius, rise in spots:
        away = np.hypot(patch.positions[:, 0] - x, patch.positions[:, 2] - z) / radius
        share = np.maximum(1.0 - away**2, 0.0) ** 2 * np.maximum(patch.height, 0.0)
        positions[:, 1] += rise * share
    return replace(patch, positions=positions)


def mirrored(patch: Patch) -> Patch:
    """Return a patch on the other side of the plane x = 0."""
    flip = np.array([-1.0, 1.0, 1.0])
    return Patch(
        patch.positions * flip,
        patch.triangles[:, ::-1],
        patch.centres * flip,
        patch.along,
        patch.height,
        patch.faceted,
    )


def _widths(key: Sequence[float]) -> list[float]:
    """Return a key as x, y, z, across, up, down."""
    across = key[3]
    up = key[4] if len(key) > 4 else across
    return [*key[:3], across, up, key[5] if len(key) > 5 else up]


def _ring_places(rings: int, dome_start: bool, dome_end: bool, pointed: bool) -> FloatArray:
    """Return places [rings] in [0, 1], closer together at domed ends."""
    part = np.linspace(0.0, 1.0, rings)
    if pointed or not (dome_start or dome_end):
        return part
    if dome_start and dome_end:
        return 0.5 - 0.5 * np.cos(np.pi * part)
    if dome_end:
        return np.sin(0.5 * np.pi * part)
    return 1.0 - np.cos(0.5 * np.pi * part)


def _tube_triangles(grid: IntArray, poles: tuple[int, int]) -> IntArray:
    """Return the triangles of rows of vertices [R, S] and the two poles."""
    nextward = np.roll(grid, -1, axis=1)
    start = np.stack([nextward[0], grid[0], np.full_like(grid[0], poles[0])], -1)
    end = np.stack([grid[-1], nextward[-1], np.full_like(grid[0], poles[1])], -1)
    return np.concatenate([start, band_triangles(grid), end])


def band_triangles(grid: IntArray) -> IntArray:
    """Return the triangles between rows of vertices [R, S]."""
    nextward = np.roll(grid, -1, axis=1)
    a, b, c, d = grid[:-1], nextward[:-1], nextward[1:], grid[1:]
    # The diagonal flips on one side of the ring, so that the mesh mirrors onto itself.
    sides = grid.shape[1]
    half = (np.cos(2.0 * np.pi * (np.arange(sides) + 1.0) / sides) > 1e-9)[None, :, None]
    first = np.where(half, np.stack([a, b, c], -1), np.stack([a, b, d], -1)).reshape(-1, 3)
    second = np.where(half, np.stack([a, c, d], -1), np.stack([b, c, d], -1)).reshape(-1, 3)
    return np.concatenate([first, second])
