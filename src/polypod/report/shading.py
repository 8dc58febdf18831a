"""The renderer's inner loops: which triangle a pixel shows, and how bright it is there."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.compute import kernel
from polypod.math.vec3 import Vec3, dot, load_vec3, normalized
from polypod.report.arrays import FloatArray

IntArray = NDArray[np.int64]

# Kinds of triangles: lit, of a plain colour, ground (lit, with lines).
LIT, PLAIN, GROUND = 0, 1, 2
SUN_LIGHT = 0.86
SKY_LIGHT, GROUND_LIGHT = 0.42, 0.20
LINE_TONE, CHEQUER_TONE = 0.80, 0.955  # how much lines and every other square darken the ground
LINE_HALF_WIDTH = 1.2  # pixels
SHADOW_TAPS = 1.2  # pixels of the sun's map between its nine samples for a soft edge
SHADOW_BIAS = 2.0  # pixels of the sun's map that a surface may be behind itself, facing the sun


class Look(NamedTuple):
    """How a scene is shaded."""

    toward_viewer: FloatArray  # [3] unit
    sun_centre: FloatArray  # [3] world, in the middle of the sun's map
    sun_right: FloatArray  # [3] unit
    sun_up: FloatArray  # [3] unit
    sun_toward: FloatArray  # [3] unit, from the scene to the sun
    sun_scale: float  # map pixels a metre
    sun_depth: FloatArray  # [N, N] m, rising away from the sun; infinite where there is nothing
    grid: float  # m
    pixels_per_metre: float
    fade_begin: float  # depth, m
    fade_end: float
    paper: FloatArray  # [3] linear


@kernel
def fill_triangles(
    corner: FloatArray,
    nearest: float,
    tie: float,
    depth: FloatArray,
    owner: IntArray,
    share: FloatArray,
) -> None:
    """Draw triangles [T, 3, 3] (column, row, depth) into depth [H, W], owner [H, W], share.

    `share` [H, W, 2] are the weights of a pixel's first two corners. What is nearer than `nearest`
    is cut away. Of surfaces closer together than `tie` the first one stays.
    """
    height, width = depth.shape
    for t in range(corner.shape[0]):
        ax, ay, ad = corner[t, 0, 0], corner[t, 0, 1], corner[t, 0, 2]
        bx, by, bd = corner[t, 1, 0], corner[t, 1, 1], corner[t, 1, 2]
        cx, cy, cd = corner[t, 2, 0], corner[t, 2, 1], corner[t, 2, 2]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-12:
            continue
        first = math.ceil(max(min(ax, min(bx, cx)) - 0.5, 0.0))
        last = math.floor(min(max(ax, max(bx, cx)) - 0.5, width - 1.0))
        top = math.ceil(max(min(ay, min(by, cy)) - 0.5, 0.0))
        bottom = math.floor(min(max(ay, max(by, cy)) - 0.5, height - 1.0))
        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(first, last + 1):
                x = column + 0.5
                a = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                b = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                c = 1.0 - a - b
                if a < 0.0 or b < 0.0 or c < 0.0:
                    continue
                d = a * ad + b * bd + c * cd
                if nearest <= d < depth[row, column] - tie:
                    depth[row, column] = d
                    owner[row, column] = t
                    share[row, column, 0] = a
                    share[row, column, 1] = b


@kernel
def sun_share(look: Look, place: Vec3, cosine: float) -> float:
    """Return the share of the sun that reaches a place whose surface it meets at `cosine`."""
    size = look.sun_depth.shape[0]
    offset = place - load_vec3(look.sun_centre)
    column = 0.5 * size + look.sun_scale * dot(offset, load_vec3(look.sun_right))
    row = 0.5 * size - look.sun_scale * dot(offset, load_vec3(look.sun_up))
    depth = -dot(offset, load_vec3(look.sun_toward))
    # A slanting surface changes its depth within the samples: it must not shade itself.
    slant = min(math.sqrt(1.0 - cosine * cosine) / max(cosine, 0.02), 40.0)
    limit = depth - SHADOW_BIAS * (1.0 + slant) / look.sun_scale
    lit = 0.0
    for i in range(-1, 2):
        for j in range(-1, 2):
            c = math.floor(column + SHADOW_TAPS * i)
            r = math.floor(row + SHADOW_TAPS * j)
            if c < 0 or r < 0 or c >= size or r >= size or look.sun_depth[r, c] > limit:
                lit += 1.0
    return lit / 9.0


@kernel
def ground_tone(look: Look, place: Vec3) -> float:
    """Return how much the lines and a faint chequer darken the ground at a place."""
    u = place.x / look.grid
    v = place.z / look.grid
    nearest = min(abs(u - math.floor(u + 0.5)), abs(v - math.floor(v + 0.5)))
    tone = 1.0
    if nearest * look.grid * look.pixels_per_metre < LINE_HALF_WIDTH:
        tone = LINE_TONE
    if (math.floor(u) + math.floor(v)) % 2 != 0:
        tone *= CHEQUER_TONE
    return tone


@kernel
def shade_pixels(
    corner: FloatArray,
    normal: FloatArray,
    colour: FloatArray,
    kind: IntArray,
    look: Look,
    depth: FloatArray,
    owner: IntArray,
    share: FloatArray,
    picture: FloatArray,
) -> None:
    """Write the linear colour of every pixel that shows a triangle into picture [H, W, 3].

    `corner` (world), `normal`, `colour` (linear) are [T, 3, 3]; `kind` [T]; the rest comes from
    `fill_triangles`. The sky lights from above, the sun where nothing is in its way.
    """
    sun = load_vec3(look.sun_toward)
    viewer = load_vec3(look.toward_viewer)
    upward = Vec3(0.0, 1.0, 0.0)
    for row in range(owner.shape[0]):
        for column in range(owner.shape[1]):
            t = owner[row, column]
            if t < 0:
                continue
            a = share[row, column, 0]
            b = share[row, column, 1]
            c = 1.0 - a - b
            tone = 1.0
            if kind[t] != PLAIN:
                place = load_vec3(corner[t, 0]) * a + load_vec3(corner[t, 1]) * b
                place = place + load_vec3(corner[t, 2]) * c
                out = load_vec3(normal[t, 0]) * a + load_vec3(normal[t, 1]) * b
                out = normalized(out + load_vec3(normal[t, 2]) * c, upward)
                # Thin parts are often modelled from one side: light what faces the viewer.
                if dot(out, viewer) < 0.0:
                    out = -out
                cosine = dot(out, sun)
                tone = GROUND_LIGHT + (SKY_LIGHT - GROUND_LIGHT) * (0.5 + 0.5 * out.y)
                if cosine > 0.0:
                    tone += SUN_LIGHT * cosine * sun_share(look, place, cosine)
                if kind[t] == GROUND:
                    tone *= ground_tone(look, place)
            gone = (depth[row, column] - look.fade_begin) / (look.fade_end - look.fade_begin)
            gone = min(max(gone, 0.0), 1.0)
            for i in range(3):
                own = a * colour[t, 0, i] + b * colour[t, 1, i] + c * colour[t, 2, i]
                picture[row, column, i] = own * tone * (1.0 - gone) + look.paper[i] * gone
