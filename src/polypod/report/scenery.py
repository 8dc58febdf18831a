"""What a picture shows besides the creature: ground, obstacles, footprints, swing paths."""

from __future__ import annotations

import colorsys
import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from polypod.environment.shapes import SPHERE
from polypod.environment.table import EnvironmentTable, TiledTable
from polypod.report.arrays import FloatArray, conjugate_all, rotate_all, runs_of
from polypod.report.ground import terrain_height
from polypod.report.raster import Scene
from polypod.report.record import Recording
from polypod.report.shading import GROUND, PLAIN

IntArray = NDArray[np.int64]

EARTH = np.array([0.80, 0.79, 0.74])
WATER = np.array([0.55, 0.70, 0.82])
STONE = np.array([0.74, 0.72, 0.67])
CRATE = np.array([0.80, 0.66, 0.47])
FORBIDDEN = np.array([0.82, 0.25, 0.21])
MOST_SAMPLES = 220  # of the ground across a picture
ROUND = 20  # sides of what is round
FOOT_COLOURS = (
    "#d1495b", "#00798c", "#edae49", "#66a182", "#6c4ab6", "#2e86de", "#e17c05", "#3d5a80",
    "#b5179e", "#588157",
)  # fmt: skip
# Of a box whose corners are counted x slowest, z fastest; counter-clockwise from outside.
BOX_TRIANGLES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
     [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], np.int64
)  # fmt: skip


def foot_colours(count: int) -> list[FloatArray]:
    """Return a colour [3] for each foot, easy to tell apart up to ten."""
    if count <= len(FOOT_COLOURS):
        return [
            np.array([int(name[i : i + 2], 16) / 255.0 for i in (1, 3, 5)])
            for name in FOOT_COLOURS[:count]
        ]
    return [np.array(colorsys.hsv_to_rgb(i / count, 0.75, 0.8)) for i in range(count)]


def add_ground(
    scene: Scene, environment: EnvironmentTable, centre: FloatArray, reach: float
) -> None:
    """Add the terrain within `reach` metres (in x and in z) of a centre [3]."""
    least, most = centre[[0, 2]] - reach, centre[[0, 2]] + reach
    x = _lattice(least[0], most[0], environment.terrain_place[0], environment, axis=1)
    z = _lattice(least[1], most[1], environment.terrain_place[1], environment, axis=0)
    across, along = np.meshgrid(x, z)
    height = terrain_height(environment, across.ravel(), along.ravel())
    positions = np.stack([across.ravel(), height, along.ravel()], axis=1)
    cell = np.arange((len(z) - 1) * len(x)).reshape(len(z) - 1, len(x))[:, :-1].ravel()
    # Counter-clockwise from above.
    first = np.stack([cell, cell + len(x), cell + 1], axis=1)
    second = np.stack([cell + 1, cell + len(x), cell + len(x) + 1], axis=1)
    colour = np.broadcast_to(EARTH, positions.shape).copy()
    if environment.water.size:
        colour[wet_at(environment, across.ravel(), along.ravel())] = WATER
    scene.add(positions, np.concatenate([first, second]), colour, GROUND)


def _lattice(
    least: float, most: float, origin: float, environment: EnvironmentTable, axis: int
) -> FloatArray:
    """Return coordinates at every n-th sample, so that the picture has the terrain's own edges."""
    cell = float(environment.terrain_place[2])
    edges = ((environment.first_row, environment.last_row),
             (environment.first_column, environment.last_column))  # fmt: skip
    first, last = math.floor((least - origin) / cell), math.ceil((most - origin) / cell)
    # Beyond its edges the ground is level across: nothing to sample there.
    inner = np.arange(max(first, edges[axis][0]), min(last, edges[axis][1]) + 1)
    inner = inner[:: max(1, -(-len(inner) // MOST_SAMPLES))]
    places: FloatArray = origin + cell * inner.astype(np.float64)
    return np.unique(np.concatenate([[least], places[(places > least) & (places < most)], [most]]))


def wet_at(environment: EnvironmentTable, x: FloatArray, z: FloatArray) -> NDArray[np.bool_]:
    """Return [N] whether the samples next to places x [N] and z [N] are water."""
    x0, z0, cell = environment.terrain_place
    column = np.round((x - x0) / cell).astype(np.int64)
    row = np.round((z - z0) / cell).astype(np.int64)
    column = np.clip(column, environment.first_column, environment.last_column)
    row = np.clip(row, environment.first_row, environment.last_row)
    if isinstance(environment, TiledTable):
        return environment.ground.wet_at(row, column)
    wet: NDArray[np.bool_] = environment.water[row, column]
    return wet


class Obstacles:
    """The surfaces of the obstacles' solids, cut out of their planes once."""

    def __init__(self, environment: EnvironmentTable, recorded: int) -> None:
        """Prepare; what the table lists beyond the `recorded` obstacles is part of the terrain."""
        self.environment = environment
        self.recorded = recorded
        self._surfaces: dict[int, tuple[FloatArray, IntArray]] = {}

    def add(self, scene: Scene, recording: Recording, frame: int, shown: NDArray[np.bool_]) -> None:
        """Add the solids for which `shown` [S] holds, where they are in that frame."""
        positions: list[FloatArray] = []
        triangles: list[IntArray] = []
        colours: list[FloatArray] = []
        for index in np.flatnonzero(shown):
            place, faces = self._placed(recording, frame, int(index))
            triangles.append(faces + sum(map(len, positions)))
            positions.append(place)
            colours.append(np.broadcast_to(self._colour(int(index)), place.shape))
        if positions:
            scene.add(np.concatenate(positions), np.concatenate(triangles), np.concatenate(colours))

    def _colour(self, index: int) -> FloatArray:
        owner = int(self.environment.owner[index])
        if owner >= self.recorded:
            return STONE
        colour = FORBIDDEN if self.environment.forbidden[index] else CRATE
        # Neighbouring crates differ a little, so that a heap can be read.
        varied: FloatArray = colour * (1.0 - 0.10 * (((owner * 7) % 5) / 4.0))
        return varied

    def centres(self, recording: Recording, frame: int) -> FloatArray:
        """Return the middles [S, 3] of the solids' bounds, where they are in a frame."""
        bounds = self.environment.bounds
        middle: FloatArray = 0.5 * (bounds[:, :3] + bounds[:, 3:])
        for index in range(len(middle)):
            middle[index] = self._moved(middle[index], recording, frame, index)
        return middle

    def _placed(self, recording: Recording, frame: int, index: int) -> tuple[FloatArray, IntArray]:
        """Return world positions and triangles of a solid in a frame."""
        if index not in self._surfaces:
            self._surfaces[index] = obstacle_surface(self.environment, index)
        positions, triangles = self._surfaces[index]
        return self._moved(positions, recording, frame, index), triangles

    def _moved(
        self, points: FloatArray, recording: Recording, frame: int, index: int
    ) -> FloatArray:
        """Return where points [..., 3] among a solid's rows are in a frame, world."""
        table, owner = self.environment, int(self.environment.owner[index])
        if owner >= self.recorded:
            return points
        local = rotate_all(conjugate_all(table.rotation[index]), points - table.pivot[owner])
        turned = rotate_all(recording.obstacle_rotation[frame, owner], local)
        moved: FloatArray = recording.obstacle_position[frame, owner] + turned
        return moved


def obstacle_surface(environment: EnvironmentTable, index: int) -> tuple[FloatArray, IntArray]:
    """Return world positions [V, 3] and triangles [T, 3] of a solid's surface."""
    if environment.kind[index] == SPHERE:
        return _ball(environment.position[index], float(environment.half_size[index, 0]))
    planes = environment.planes[index, : environment.plane_count[index]]
    positions: list[FloatArray] = []
    triangles: list[list[int]] = []
    for face in range(len(planes)):
        polygon = _face(planes, face, environment.bounds[index])
        start = sum(map(len, positions))
        positions.append(polygon)
        triangles.extend([start, start + i, start + i + 1] for i in range(1, len(polygon) - 1))
    return np.concatenate(positions), np.array(triangles, np.int64).reshape(-1, 3)


def _face(planes: FloatArray, face: int, bounds: FloatArray) -> FloatArray:
    """Return the corners [N, 3] of one face of the solid, counter-clockwise from outside.

    A square on the face's plane, larger than the solid, is cut by every other plane.
    """
    normal, offset = planes[face, :3], planes[face, 3]
    centre = 0.5 * (bounds[:3] + bounds[3:])
    middle = centre + normal * (offset - normal @ centre)
    least = np.zeros(3)
    least[int(np.abs(normal).argmin())] = 1.0
    u = np.cross(normal, least)
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    size = 2.0 * float(np.linalg.norm(bounds[3:] - bounds[:3]))
    polygon = [middle + size * (a * u + b * v) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    for other in range(len(planes)):
        if other == face:
            continue
        polygon = _cut(polygon, planes[other, :3], float(planes[other, 3]))
    return np.array(polygon).reshape(-1, 3)


def _cut(polygon: list[FloatArray], normal: FloatArray, offset: float) -> list[FloatArray]:
    """Return the part of a convex polygon with normal . p <= offset."""
    kept: list[FloatArray] = []
    for index, point in enumerate(polygon):
        following = polygon[(index + 1) % len(polygon)]
        here, there = float(normal @ point) - offset, float(normal @ following) - offset
        if here <= 0.0:
            kept.append(point)
        if here * there < 0.0:
            kept.append(point + (following - point) * (here / (here - there)))
    return kept


def _ball(centre: FloatArray, radius: float) -> tuple[FloatArray, IntArray]:
    polar = np.linspace(0.0, math.pi, ROUND // 2 + 1)
    around = 2.0 * math.pi * np.arange(ROUND) / ROUND
    ring = np.stack([np.sin(around), np.zeros(ROUND), np.cos(around)], axis=1)
    levels = [ring * math.sin(a) + np.array([0.0, math.cos(a), 0.0]) for a in polar]
    triangles = []
    for level in range(len(polar) - 1):
        for i in range(ROUND):
            a, b = level * ROUND + i, level * ROUND + (i + 1) % ROUND
            triangles += [[a, a + ROUND, b], [b, a + ROUND, b + ROUND]]
    return centre + radius * np.concatenate(levels), np.array(triangles, np.int64)


def add_footprints(
    scene: Scene, recording: Recording, radius: float, first: int, last: int
) -> None:
    """Add a disc in the foot's colour for each stance that begins in frames [first, last]."""
    angle = 2.0 * math.pi * np.arange(ROUND) / ROUND
    rim = radius * np.stack([np.sin(angle), np.zeros(ROUND), np.cos(angle)], axis=1)
    fan = np.array([[ROUND, i, (i + 1) % ROUND] for i in range(ROUND)], np.int64)
    for foot, colour in enumerate(foot_colours(recording.foot_stance.shape[1])):
        for start, _ in runs_of(recording.foot_stance[:, foot]):
            if first <= start <= last:
                # Raised, so that the ground's slope within the disc does not hide it.
                centre = recording.foot_position[start, foot] + np.array([0.0, 0.25 * radius, 0.0])
                scene.add(np.concatenate([centre + rim, [centre]]), fan, colour, PLAIN)


def add_swings(
    scene: Scene, recording: Recording, toward: FloatArray, width: float, first: int, last: int
) -> None:
    """Add the ways of the swing feet in frames [first, last] as ribbons that face the viewer."""
    for foot, colour in enumerate(foot_colours(recording.foot_stance.shape[1])):
        for start, stop in runs_of(~recording.foot_stance[:, foot]):
            begin, end = max(start - 1, first), min(stop, last, len(recording.time) - 1)
            if end > begin:
                _add_ribbon(
                    scene, recording.foot_position[begin : end + 1, foot], toward, width, colour
                )


def _add_ribbon(
    scene: Scene, path: FloatArray, toward: FloatArray, width: float, colour: FloatArray
) -> None:
    side = np.cross(np.gradient(path, axis=0), toward)
    size = np.linalg.norm(side, axis=1, keepdims=True)
    side = 0.5 * width * side / np.where(size > 1e-300, size, 1.0)
    positions = np.concatenate([path + side, path - side])
    count = len(path)
    a = np.arange(count - 1)
    triangles = np.concatenate(
        [
            np.stack([a, a + 1, a + count], axis=1),
            np.stack([a + 1, a + count + 1, a + count], axis=1),
        ]
    )
    scene.add(positions, triangles, colour, PLAIN)


def add_bones(scene: Scene, recording: Recording, frame: int, colour: FloatArray) -> None:
    """Add a creature that has no surface: its legs and spine as sticks, its trunk as a box."""
    legs, body = recording.morphology.legs, recording.morphology.body
    half = np.array([body.half_size[0], body.half_size[1], body.half_size[2]])
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)
    box = recording.body_position[frame] + rotate_all(
        recording.body_rotation[frame], body.box_centre + half * corners
    )
    scene.add(box, BOX_TRIANGLES, colour)
    for leg, count in enumerate(legs.joint_count):
        chain = recording.joint_position[frame, legs.joint[leg, :count]]
        chain = np.concatenate([chain, recording.foot_position[frame, leg][None]])
        for start, end in pairwise(chain):
            _add_stick(scene, start, end, 0.035 * float(legs.length[leg]), colour)


def _add_stick(
    scene: Scene, start: FloatArray, end: FloatArray, radius: float, colour: FloatArray
) -> None:
    """Add a six-sided stick between two points, pointed at its end."""
    way = end - start
    size = float(np.linalg.norm(way))
    if size < 1e-12:
        return
    least = np.zeros(3)
    least[int(np.abs(way).argmin())] = 1.0
    u = np.cross(way / size, least)
    u /= np.linalg.norm(u)
    v = np.cross(way / size, u)
    angle = 2.0 * math.pi * np.arange(6) / 6.0
    ring = np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v
    positions = np.concatenate([start + radius * ring, end + 0.5 * radius * ring])
    a = np.arange(6)
    b = (a + 1) % 6
    triangles = np.concatenate(
        [np.stack([a, b, a + 6], axis=1), np.stack([b, b + 6, a + 6], axis=1)]
    )
    scene.add(positions, triangles, colour)
