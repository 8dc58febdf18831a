"""Skins and ground as the page draws them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from polypod.environment.environment import Environment
from polypod.environment.terrain import Terrain
from polypod.morphology.types import Morphology
from polypod.report.arrays import FloatArray
from polypod.report.ground import terrain_height
from polypod.report.scenery import EARTH, STONE, WATER, obstacle_surface, wet_at
from polypod.report.skin import Flesh, flesh_of
from polypod.studio.arrays import pack_arrays
from polypod.studio.pictures import cover

IntArray = NDArray[np.int64]

INFLUENCES = 4
# The ground about a place is sent so far to each side, leg lengths, and sent anew from half of it.
GROUND_REACH = 60.0
SAMPLES = 181  # of it along each side


def pack_skin(morphology: Morphology) -> bytes:
    """Return all surfaces of a creature at rest, body frame, as one mesh; see `skin`.

    A vertex has four joints; the body itself is the one after the last.
    """
    surfaces = [_wound(surface) for surface in flesh_of(morphology)]
    body = len(morphology.joint_node)
    places, normals, joints, weights, colours, triangles = [], [], [], [], [], []
    begun = 0
    for surface in surfaces:
        joint, weight = _strongest(surface, body)
        place = _place(surface)
        places.append(place)
        smooth = surface.normal
        normals.append(normals_of(place, surface.triangles) if smooth is None else smooth)
        joints.append(joint)
        weights.append(weight)
        colours.append(surface.colour)
        triangles.append(surface.triangles + begun)
        begun += len(place)
    if not surfaces:
        places, normals = [np.zeros((0, 3))], [np.zeros((0, 3))]
        joints, weights = [np.zeros((0, INFLUENCES), np.int64)], [np.zeros((0, INFLUENCES))]
        colours, triangles = [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)]
    covering, parts = cover(morphology.source.document, surfaces)
    if covering:
        covering["tint"] = as_bytes(covering["tint"])
    return pack_arrays(
        "skin",
        {
            "place": np.concatenate(places).astype(np.float32),
            "normal": np.concatenate(normals).astype(np.float32),
            "joint": np.concatenate(joints).astype(np.uint16),
            "weight": np.concatenate(weights).astype(np.float32),
            "colour": as_bytes(np.concatenate(colours)),
            "triangles": np.concatenate(triangles).astype(np.uint32),
            **covering,
        },
        joints=body + 1,
        parts=parts,
    )


def _place(surface: Flesh) -> FloatArray:
    """Return [V, 3] where vertices are at rest, body frame, m."""
    place: FloatArray = np.einsum("vw,vwa->va", surface.weight, surface.place)
    return place


def _wound(surface: Flesh) -> Flesh:
    """Return a surface whose triangles face the way that its own normals do.

    Those of a mirrored part, and of a file that is careless about it, are the other way round, and
    what is lit by the way that triangles face would be dark.
    """
    if surface.normal is None:
        return surface
    corner = _place(surface)[surface.triangles]
    face = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    ahead = surface.normal[surface.triangles].sum(axis=1)
    turned = np.einsum("ta,ta->t", face, ahead) < 0.0
    triangles = surface.triangles.copy()
    triangles[turned] = triangles[turned][:, ::-1]
    return replace(surface, triangles=triangles)


def _strongest(surface: Flesh, body: int) -> tuple[IntArray, FloatArray]:
    """Return the four strongest influences [V, 4] of each vertex, joints and weights of sum 1."""
    count, width = surface.weight.shape
    order = np.argsort(-surface.weight, axis=1, kind="stable")[:, :INFLUENCES]
    rows = np.arange(count)[:, None]
    joint = np.full((count, INFLUENCES), body, np.int64)
    weight = np.zeros((count, INFLUENCES))
    kept = min(width, INFLUENCES)
    joint[:, :kept] = np.where(surface.row < 0, body, surface.row)[rows, order]
    weight[:, :kept] = surface.weight[rows, order]
    total = weight.sum(axis=1, keepdims=True)
    # A vertex that nothing holds rides on the body.
    weight[:, 0] = np.where(total[:, 0] > 0.0, weight[:, 0], 1.0)
    return joint, weight / np.where(total > 0.0, total, 1.0)


def normals_of(place: FloatArray, triangles: IntArray) -> FloatArray:
    """Return unit normals [V, 3]: means of the triangles' [T, 3], by area."""
    corner = place[triangles]
    face = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal = np.zeros_like(place)
    for i in range(3):
        np.add.at(normal, triangles[:, i], face)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.where(size > 0.0, normal / np.where(size > 0.0, size, 1.0), [0.0, 1.0, 0.0])


def as_bytes(colour: FloatArray) -> NDArray[np.uint8]:
    """Return sRGB colours [N, 3] in [0, 1] as bytes [N, 4], opaque."""
    values = np.round(255.0 * np.clip(colour, 0.0, 1.0)).astype(np.uint8)
    return np.concatenate([values, np.full((len(values), 1), 255, np.uint8)], axis=1)


def ground_reach(leg_length: float) -> float:
    """Return how far from its middle, m, the ground is sent."""
    return GROUND_REACH * leg_length


def pack_ground(environment: Environment, shown: int, centre: FloatArray, reach: float) -> bytes:
    """Return the ground within `reach` m of a centre [3], with the steps that are part of it.

    Args:
        environment: the place.
        shown: how many of its obstacles are drawn as such; those after them belong to the ground.
        centre: world, m.
        reach: m.
    """
    if environment.pager is not None:
        environment.load_ground(centre[None, [0, 2]], np.array([1.5 * reach]))
    place, triangles, colour = _field(environment, centre, reach)
    places, normals = [place], [normals_of(place, triangles)]
    faces, colours = [triangles], [colour]
    for index in np.flatnonzero(environment.table.owner >= shown):
        # Each corner by itself: the sides of a step are not smooth.
        corner, sides = obstacle_surface(environment.table, int(index))
        corner = corner[sides].reshape(-1, 3)
        face = np.arange(len(corner)).reshape(-1, 3)
        faces.append(face + sum(map(len, places)))
        places.append(corner)
        normals.append(normals_of(corner, face))
        colours.append(np.broadcast_to(STONE, corner.shape))
    return pack_arrays(
        "ground",
        {
            "place": np.concatenate(places).astype(np.float32),
            "normal": np.concatenate(normals).astype(np.float32),
            "colour": as_bytes(np.concatenate(colours)),
            "triangles": np.concatenate(faces).astype(np.uint32),
        },
        centre=[float(v) for v in centre],
        reach=reach,
        endless=is_level(environment),
    )


def _field(
    environment: Environment, centre: FloatArray, reach: float
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return places [V, 3], triangles [T, 3] and colours [V, 3] of the terrain about a centre."""
    count = 2 if is_level(environment) else SAMPLES
    axis = np.linspace(-reach, reach, count)
    across, along = (v.ravel() for v in np.meshgrid(centre[0] + axis, centre[2] + axis))
    height = terrain_height(environment.table, across, along)
    place = np.stack([across, height, along], axis=1)
    cell = np.arange((count - 1) * count).reshape(count - 1, count)[:, :-1].ravel()
    # Counter-clockwise from above.
    first = np.stack([cell, cell + count, cell + 1], axis=1)
    second = np.stack([cell + 1, cell + count, cell + count + 1], axis=1)
    colour = np.broadcast_to(EARTH, place.shape).copy()
    if environment.table.water.size:
        colour[wet_at(environment.table, across, along)] = WATER
    return place, np.concatenate([first, second]), colour


def is_level(environment: Environment) -> bool:
    """Return whether the terrain is level everywhere; steps on it do not count."""
    terrain = environment.terrain
    return isinstance(terrain, Terrain) and float(np.ptp(terrain.heights)) == 0.0
