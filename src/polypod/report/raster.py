"""A small depth-buffer renderer: orthographic, one sun with shadows, a bright sky.

It exists so that a walk can be looked at without a viewer, wherever Polypod runs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.report.arrays import FloatArray
from polypod.report.shading import LIT, PLAIN, Look, fill_triangles, shade_pixels

IntArray = NDArray[np.int64]
ByteImage = NDArray[np.uint8]

SOIL = np.array([0.60, 0.56, 0.50])  # sRGB of a cut through the ground
PAPER = np.array([0.955, 0.96, 0.965])  # sRGB of the background
SUN = np.array([0.34, 0.86, -0.38])  # from the scene toward the sun, camera right, up, toward
SHADOW_PIXELS = 1400
TIE = 0.05  # pixels: a plate's top that lies in the ground is ground
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
    """Return unit normals [T, 3, 3] for each triangle's corners, smooth but across creases.

    A vertex's normal is the mean of its faces', each weighted by its angle there, so that how
    faces are split into triangles does not matter.
    """
    corners = positions[triangles]
    face = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    # Vertices doubled for texture seams are one place.
    _, place = np.unique(np.round(positions, 9), axis=0, return_inverse=True)
    place = place.reshape(-1)
    total = np.zeros((int(place.max()) + 1, 3))
    for corner in range(3):
        one = _unit(corners[:, (corner + 1) % 3] - corners[:, corner])
        other = _unit(corners[:, (corner + 2) % 3] - corners[:, corner])
        angle = np.arccos(np.clip((one * other).sum(axis=1), -1.0, 1.0))
        np.add.at(total, place[triangles[:, corner]], face * angle[:, None])
    smooth = _unit(total)[place[triangles]]
    flat = np.broadcast_to(face[:, None, :], smooth.shape)
    same = (smooth * flat).sum(axis=2, keepdims=True) > CREASE
    return np.where(same, smooth, flat)


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
        nearest: depth before which everything is cut away, m; the cut through the ground is soil.
        oversampling: pixels drawn each way for one that is shown.
    """
    large = camera.enlarged(oversampling)
    corners = np.ascontiguousarray(np.concatenate(scene.corners))
    depth, owner, share = _draw(
        large.project(corners), large.width, large.height, nearest, TIE / large.pixels_per_metre
    )
    picture = np.empty((large.height, large.width, 3))
    picture[:] = linear_from_srgb(PAPER)
    if nearest > -math.inf:
        seen = owner >= 0
        # Nothing is seen further down either, and something is further up.
        below = ~np.logical_or.accumulate(seen[::-1], axis=0)[::-1] & seen.any(axis=0)
        picture[below] = linear_from_srgb(SOIL)
    shade_pixels(
        corners,
        np.concatenate(scene.normals),
        linear_from_srgb(np.concatenate(scene.colours)),
        np.concatenate(scene.kinds),
        _look(scene, large, grid, fade),
        depth,
        owner,
        share,
        picture,
    )
    shape = (camera.height, oversampling, camera.width, oversampling, 3)
    return _bytes(picture.reshape(shape).mean(axis=(1, 3)))


def _draw(
    corners: FloatArray, width: int, height: int, nearest: float, tie: float
) -> tuple[FloatArray, IntArray, FloatArray]:
    depth = np.full((height, width), np.inf)
    owner = np.full((height, width), -1, np.int64)
    share = np.zeros((height, width, 2))
    fill_triangles(np.ascontiguousarray(corners), nearest, tie, depth, owner, share)
    return depth, owner, share


def _look(scene: Scene, camera: Camera, grid: float, fade: tuple[float, float]) -> Look:
    """Return how to shade a scene: the sun's own view of it, lines and fading."""
    toward = sun_direction(camera)
    right = _unit(np.cross(np.array([0.0, 1.0, 0.0]), toward))
    up = np.cross(toward, right)
    solid = [
        corners.reshape(-1, 3)
        for corners, kind in zip(scene.corners, scene.kinds, strict=True)
        if kind[0] != PLAIN
    ]
    # The sun looks at what the picture shows; what lies beyond it may cast no shadow there.
    half = np.array([0.5 * camera.width, 0.5 * camera.height]) / camera.pixels_per_metre
    corners = np.concatenate([np.zeros((0, 3)), *solid])
    offset = corners - camera.centre
    shown = (np.abs(offset @ camera.right) < 1.2 * half[0]) & (
        np.abs(offset @ camera.up) < 1.2 * half[1]
    )
    # Without anything solid the map is empty: all is in the sun.
    seen = corners[shown] if shown.any() else camera.centre[None]
    plan = np.stack([seen @ right, seen @ up], axis=1)
    least, most = plan.min(axis=0), plan.max(axis=0)
    middle = 0.5 * (least + most)
    size = max(2, min(SHADOW_PIXELS, camera.width))
    scale = 0.98 * size / max(float((most - least).max()), 1e-12)
    view = Camera(middle[0] * right + middle[1] * up, right, up, toward, scale, size, size)
    depth, _, _ = _draw(view.project(corners.reshape(-1, 3, 3)), size, size, -math.inf, 0.0)
    begin, end = fade if math.isfinite(fade[1]) else (1e30, 2e30)
    return Look(
        camera.toward,
        view.centre,
        right,
        up,
        toward,
        scale,
        depth,
        grid,
        camera.pixels_per_metre,
        begin,
        end,
        linear_from_srgb(PAPER),
    )


def sun_direction(camera: Camera) -> FloatArray:
    """Return the unit direction [3] to the sun, which stands over the viewer's left shoulder."""
    sun = SUN / np.linalg.norm(SUN)
    level = _unit(camera.right - np.array([0.0, camera.right[1], 0.0]))
    aside = np.cross(level, np.array([0.0, 1.0, 0.0]))
    toward: FloatArray = level * sun[0] + np.array([0.0, sun[1], 0.0]) - aside * sun[2]
    return toward


def _unit(vectors: FloatArray) -> FloatArray:
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    scaled: FloatArray = vectors / np.where(size > 1e-300, size, 1.0)
    return scaled


def linear_from_srgb(srgb: FloatArray) -> FloatArray:
    """Return how bright colours are that a screen shows so, near enough."""
    lightness: FloatArray = np.clip(srgb, 0.0, 1.0) ** 2.2
    return lightness


def _bytes(linear: FloatArray) -> ByteImage:
    # A soft shoulder keeps bright surfaces from burning out.
    rolled = np.where(linear > 0.8, 0.8 + 0.2 * np.tanh((linear - 0.8) / 0.2), linear)
    encoded: ByteImage = np.round(255.0 * np.clip(rolled, 0.0, 1.0) ** (1.0 / 2.2)).astype(np.uint8)
    return encoded
