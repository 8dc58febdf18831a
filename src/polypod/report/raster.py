"""A small depth-buffer renderer: orthographic, one sun with shadows, a bright sky.

It exists so that a walk can be looked at without a viewer, wherever Polypod runs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.compute import kernel
from polypod.report.arrays import FloatArray

IntArray = NDArray[np.int64]
ByteImage = NDArray[np.uint8]

PAPER = np.array([0.955, 0.96, 0.965])  # sRGB of the background
SUN = np.array([0.34, 0.86, -0.38])  # from the scene toward the sun, camera right, up, toward
SUN_LIGHT = 0.86
SKY_LIGHT, GROUND_LIGHT = 0.42, 0.20
SHADOW_PIXELS = 1400
CREASE = math.cos(math.radians(42.0))  # surfaces that meet more sharply show an edge


class Camera(NamedTuple):
    """An orthographic view of width x height pixels."""

    centre: FloatArray  # [3] world m, seen in the middle of the picture
    right: FloatArray  # [3] unit
    up: FloatArray  # [3] unit
    toward: FloatArray  # [3] unit, from the scene to the viewer
    pixels_per_metre: float
    width: int
    height: int

    def project(self, points: FloatArray) -> FloatArray:
        """Return pixel column, pixel row and depth (m, rising away) of world points [..., 3]."""
        offset = points - self.centre
        scale = self.pixels_per_metre
        return np.stack(
            [
                0.5 * self.width + scale * (offset @ self.right),
                0.5 * self.height - scale * (offset @ self.up),
                -(offset @ self.toward),
            ],
            axis=-1,
        )

    def enlarged(self, factor: int) -> Camera:
        """Return the same view with `factor` times the pixels each way."""
        return self._replace(
            pixels_per_metre=self.pixels_per_metre * factor,
            width=self.width * factor,
            height=self.height * factor,
        )


def camera_along(
    heading: FloatArray,
    azimuth: float,
    elevation: float,
    centre: FloatArray,
    pixels_per_metre: float,
    size: tuple[int, int],
) -> Camera:
    """Return the view from the creature's right (azimuth 0), in which it walks to the right.

    `heading` [3] is a unit vector of the ground plane. A rising azimuth (rad) goes round to the
    creature's front, a rising elevation (rad) up to the view from above.
    """
    vertical = np.array([0.0, 1.0, 0.0])
    aside = np.cross(heading, vertical)
    level = aside * math.cos(azimuth) + heading * math.sin(azimuth)
    toward = level * math.cos(elevation) + vertical * math.sin(elevation)
    up = vertical * math.cos(elevation) - level * math.sin(elevation)
    return Camera(centre, np.cross(up, toward), up, toward, pixels_per_metre, *size)


@dataclass
class Scene:
    """Triangles with colours, collected piece by piece; world metres, sRGB."""

    corners: list[FloatArray] = field(default_factory=list)  # [T, 3, 3]
    normals: list[FloatArray] = field(default_factory=list)  # [T, 3, 3]
    colours: list[FloatArray] = field(default_factory=list)  # [T, 3, 3]
    kinds: list[IntArray] = field(default_factory=list)  # [T] 0 lit, 1 plain colour, 2 ground

    LIT, PLAIN, GROUND = 0, 1, 2

    def add(
        self,
        positions: FloatArray,
        triangles: IntArray,
        colour: FloatArray,
        kind: int = LIT,
    ) -> None:
        """Add a surface: positions [V, 3], triangles [T, 3], colour [3] or [V, 3]."""
        if not len(triangles):
            return
        corners = positions[triangles]
        self.corners.append(corners)
        self.normals.append(corner_normals(positions, triangles))
        each = np.broadcast_to(colour, positions.shape)[triangles]
        self.colours.append(each)
        self.kinds.append(np.full(len(triangles), kind, np.int64))

    def joined(self, other: Scene) -> Scene:
        """Return a scene of the pieces of both."""
        return Scene(
            self.corners + other.corners,
            self.normals + other.normals,
            self.colours + other.colours,
            self.kinds + other.kinds,
        )


def corner_normals(positions: FloatArray, triangles: IntArray) -> FloatArray:
    """Return unit normals [T, 3, 3] for each triangle's corners, smooth but across creases."""
    corners = positions[triangles]
    face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # Vertices doubled for texture seams are one place.
    _, place = np.unique(np.round(positions, 9), axis=0, return_inverse=True)
    place = place.reshape(-1)
    total = np.zeros((int(place.max()) + 1, 3))
    for corner in range(3):
        np.add.at(total, place[triangles[:, corner]], face)
    smooth = _unit(total)[place[triangles]]
    flat = np.broadcast_to(_unit(face)[:, None, :], smooth.shape)
    same = (smooth * flat).sum(axis=2, keepdims=True) > CREASE
    return np.where(same, smooth, flat)


@kernel
def fill_triangles(
    corner: FloatArray, nearest: float, depth: FloatArray, owner: IntArray, share: FloatArray
) -> None:
    """Draw triangles [T, 3, 3] (column, row, depth) into depth [H, W], owner [H, W], share.

    `share` [H, W, 2] are the weights of a pixel's first two corners. What is nearer than `nearest`
    is cut away.
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
                if nearest <= d < depth[row, column]:
                    depth[row, column] = d
                    owner[row, column] = t
                    share[row, column, 0] = a
                    share[row, column, 1] = b


def render(
    scene: Scene,
    camera: Camera,
    *,
    grid: float,
    fade: tuple[float, float] = (math.inf, math.inf),
    nearest: float = -math.inf,
    oversampling: int = 2,
) -> ByteImage:
    """Return the picture [height, width, 3].

    Args:
        scene: what there is.
        camera: where it is seen from.
        grid: metres between the lines on the ground.
        fade: depths (m) at which things begin to fade into the paper, and are gone.
        nearest: depth before which everything is cut away, m.
        oversampling: pixels drawn each way for one that is shown.
    """
    large = camera.enlarged(oversampling)
    corners = np.concatenate(scene.corners)
    depth, owner, share = _draw(large.project(corners), large.width, large.height, nearest)
    seen = owner >= 0
    triangle = owner[seen]
    weight = np.empty((len(triangle), 3))
    weight[:, :2] = share[seen]
    weight[:, 2] = 1.0 - weight[:, 0] - weight[:, 1]

    def at_pixels(values: FloatArray) -> FloatArray:
        picked: FloatArray = np.einsum("pc,pcn->pn", weight, values[triangle])
        return picked

    place = at_pixels(corners)
    normal = _unit(at_pixels(np.concatenate(scene.normals)))
    kind = np.concatenate(scene.kinds)[triangle]
    colour = _linear(at_pixels(np.concatenate(scene.colours)))
    ground = kind == Scene.GROUND
    colour[ground] *= _grid_lines(place[ground], grid, large.pixels_per_metre)[:, None]
    lit = _light(scene, camera, place, normal)
    colour = np.where((kind == Scene.PLAIN)[:, None], colour, colour * lit[:, None])
    begin, end = fade
    if math.isfinite(end):
        gone = np.clip((depth[seen] - begin) / (end - begin), 0.0, 1.0)[:, None]
        colour = colour * (1.0 - gone) + _linear(PAPER) * gone
    picture = np.broadcast_to(_linear(PAPER), (large.height, large.width, 3)).copy()
    picture[seen] = colour
    shape = (camera.height, oversampling, camera.width, oversampling, 3)
    return _bytes(picture.reshape(shape).mean(axis=(1, 3)))


def _draw(
    corners: FloatArray, width: int, height: int, nearest: float
) -> tuple[FloatArray, IntArray, FloatArray]:
    depth = np.full((height, width), np.inf)
    owner = np.full((height, width), -1, np.int64)
    share = np.zeros((height, width, 2))
    fill_triangles(np.ascontiguousarray(corners), nearest, depth, owner, share)
    return depth, owner, share


def _light(scene: Scene, camera: Camera, place: FloatArray, normal: FloatArray) -> FloatArray:
    """Return how bright each pixel is: sky from above, the sun where nothing is in its way."""
    sun = SUN / np.linalg.norm(SUN)
    level = _unit(camera.right - np.array([0.0, camera.right[1], 0.0]))
    aside = np.cross(level, np.array([0.0, 1.0, 0.0]))
    toward = level * sun[0] + np.array([0.0, sun[1], 0.0]) - aside * sun[2]
    # Thin parts are often modelled from one side: light what faces the viewer.
    facing = np.where((normal @ camera.toward)[:, None] < 0.0, -normal, normal)
    cosine = np.maximum(facing @ toward, 0.0)
    sky = GROUND_LIGHT + (SKY_LIGHT - GROUND_LIGHT) * (0.5 + 0.5 * facing[:, 1])
    shade: FloatArray = sky + SUN_LIGHT * cosine * _sunlit(scene, camera, place, toward)
    return shade


def _sunlit(scene: Scene, camera: Camera, place: FloatArray, toward: FloatArray) -> FloatArray:
    """Return the share [P] of the sun that reaches each place, by a depth map from the sun."""
    right = _unit(np.cross(np.array([0.0, 1.0, 0.0]), toward))
    size = max(2, min(SHADOW_PIXELS, 2 * max(camera.width, camera.height)))
    span = np.ptp(place @ np.stack([right, np.cross(toward, right)], axis=1), axis=0).max()
    middle = 0.5 * (place.min(axis=0) + place.max(axis=0))
    scale = 0.98 * size / max(float(span), 1e-12)
    view = Camera(middle, right, np.cross(toward, right), toward, scale, size, size)
    solid = [
        corners
        for corners, kind in zip(scene.corners, scene.kinds, strict=True)
        if kind[0] != Scene.PLAIN
    ]
    depth, _, _ = _draw(view.project(np.concatenate(solid)), size, size, -math.inf)
    where = view.project(place)
    # A surface must not shade itself: allow for its depth changing within a few map pixels.
    bias = 3.5 / scale
    light = np.zeros(len(place))
    offsets = [(x, y) for x in (-1.2, 0.0, 1.2) for y in (-1.2, 0.0, 1.2)]
    for x, y in offsets:
        column = np.clip((where[:, 0] + x).astype(np.int64), 0, size - 1)
        row = np.clip((where[:, 1] + y).astype(np.int64), 0, size - 1)
        light += depth[row, column] > where[:, 2] - bias
    shared: FloatArray = light / len(offsets)
    return shared


def _grid_lines(place: FloatArray, grid: float, pixels_per_metre: float) -> FloatArray:
    """Return how much lines and a faint chequer on the ground darken each place [P, 3]."""
    cells = place[:, [0, 2]] / grid
    to_line = np.abs(cells - np.round(cells)).min(axis=1) * grid * pixels_per_metre
    chequer = np.floor(cells).sum(axis=1) % 2.0
    lines: FloatArray = np.where(to_line < 1.2, 0.80, 1.0) * (1.0 - 0.045 * chequer)
    return lines


def _unit(vectors: FloatArray) -> FloatArray:
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    scaled: FloatArray = vectors / np.where(size > 1e-300, size, 1.0)
    return scaled


def _linear(srgb: FloatArray) -> FloatArray:
    lightness: FloatArray = np.clip(srgb, 0.0, 1.0) ** 2.2
    return lightness


def _bytes(linear: FloatArray) -> ByteImage:
    # A soft shoulder keeps bright surfaces from burning out.
    rolled = np.where(linear > 0.8, 0.8 + 0.2 * np.tanh((linear - 0.8) / 0.2), linear)
    encoded: ByteImage = np.round(255.0 * np.clip(rolled, 0.0, 1.0) ** (1.0 / 2.2)).astype(np.uint8)
    return encoded
