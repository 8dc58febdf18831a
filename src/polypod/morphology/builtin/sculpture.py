"""Puts patches on a skeleton: joints, weights, colours, and on the right a twin of all on the left.

A joint whose name begins with "Left" gets its "Right" twin at once, and so does every patch bound
to such a joint: creatures describe their middle and their left, and are mirror symmetric.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from polypod.morphology.builtin.curves import FloatArray
from polypod.morphology.builtin.fusion import fused
from polypod.morphology.builtin.shapes import IntArray, Patch, mirrored
from polypod.rigs.author import Joint, Material, SkinnedSurface, author_glb

DECIMALS = 6  # positions are kept to the micrometre: the same bytes whatever the platform's sine
HIDE = Material("Hide", roughness=0.85)
SHELL = Material("Shell", roughness=0.4)
GLOSS = Material("Gloss", roughness=0.12)
METAL = Material("Metal", roughness=0.35, metallic=0.7)
MATERIALS = (HIDE, SHELL, GLOSS, METAL)


@dataclass(frozen=True)
class BuiltIn:
    """A creature made in code, ready to be read like any rig file."""

    name: str
    glb: bytes
    legs: tuple[str, ...]  # "HIP:FOOT" joint names, back to front, left before right in a row
    spine: tuple[str, ...]  # joint names from back to head; empty where the trunk is stiff


class Piece(NamedTuple):
    """A patch that was added, with its twin if it has one."""

    material: Material
    rows: tuple[int, ...]  # among the surfaces of that material


class Paint(NamedTuple):
    """Vertex colours of a patch, as "#rrggbb".

    `stops` are colours along the axis, `belly` covers the underside up to `belly_edge` (the ring's
    height, -1 to 1), `bands` are (place, half width, colour) across the axis.
    """

    stops: tuple[tuple[float, str], ...]
    belly: str | None = None
    belly_edge: float = -0.2
    bands: tuple[tuple[float, float, str], ...] = ()


def plain(colour: str) -> Paint:
    """Return a paint of one colour."""
    return Paint(((0.0, colour),))


class Sculpture:
    """A creature in the making."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._joints: list[Joint] = []
        self._row: dict[str, int] = {}
        self._surfaces: dict[Material, list[SkinnedSurface]] = {}

    def joint(
        self, name: str, position: ArrayLike, parent: str | None = None, skinned: bool = True
    ) -> None:
        """Add a joint at a world position, and its twin if its name begins with "Left"."""
        place = np.round(np.asarray(position, dtype=np.float64), DECIMALS) + 0.0
        self._append(name, place, parent, skinned)
        if name.startswith("Left"):
            other = _twin(parent) if parent is not None else None
            self._append(_twin(name), place * (-1.0, 1.0, 1.0) + 0.0, other, skinned)

    def chain(
        self, names: Sequence[str], points: ArrayLike, parent: str | None = None, marker: str = ""
    ) -> None:
        """Add joints, each the parent of the next; `marker`: a plain node at the last point."""
        places = np.asarray(points, dtype=np.float64)
        for name, place in zip(names, places, strict=False):
            self.joint(name, place, parent)
            parent = name
        if marker:
            self.joint(marker, places[len(names)], parent, skinned=False)

    def position(self, name: str) -> FloatArray:
        """Return a joint's world position [3], m."""
        return np.array(self._joints[self._row[name]].position)

    def add(
        self,
        patch: Patch,
        bones: str | Sequence[str],
        paint: Paint,
        material: Material = HIDE,
        blend: float = 0.3,
        both: bool = False,
    ) -> Piece:
        """Add a patch bound to one joint or along a chain of joints.

        Args:
            patch: the shape.
            bones: a joint, or joints from root to tip; a plain node at the end only marks where the
                last bone ends.
            paint: its colours.
            material: how it reflects.
            blend: part of the shorter of two neighbouring bones over which weight passes from one
                to the other, on each side of the joint; at most 0.5.
            both: make a twin though no bone's name begins with "Left".

        Returns:
            what `fuse` knows the patch and its twin by.
        """
        names = (bones,) if isinstance(bones, str) else tuple(bones)
        rows = [self._bind(patch, names, paint, material, blend)]
        if both or any(name.startswith("Left") for name in names):
            twins = tuple(map(_twin, names))
            rows.append(self._bind(mirrored(patch), twins, paint, material, blend))
        return Piece(material, tuple(rows))

    def fuse(self, trunk: Piece, limbs: Sequence[Piece], width: float) -> None:
        """Let limbs, and their twins, grow out of the trunk without a seam.

        Args:
            trunk: a piece without a twin.
            limbs: pieces of the same material.
            width: m, how far from the seam the skin is changed.
        """
        surfaces = self._surfaces[trunk.material]
        rows = [*trunk.rows, *(row for limb in limbs for row in limb.rows)]
        first, *rest = (surfaces[row] for row in rows)
        for row, grown in zip(rows, fused(first, rest, width, len(self._joints)), strict=True):
            positions = np.round(grown.positions, DECIMALS) + 0.0
            colours = np.round(grown.colours, 4)
            surfaces[row] = replace(grown, positions=positions, colours=colours)

    def finish(self, legs: Sequence[str], spine: Sequence[str] = ()) -> BuiltIn:
        """Return the creature; `legs` are those of the left and the middle, back to front."""
        materials = [material for material in MATERIALS if material in self._surfaces]
        surfaces = [
            _joined(self._surfaces[material], index) for index, material in enumerate(materials)
        ]
        every_leg: list[str] = []
        for leg in legs:
            every_leg.append(leg)
            if leg.startswith("Left"):
                every_leg.append(":".join(_twin(name) for name in leg.split(":")))
        title = self.name.capitalize()
        glb = author_glb(title, self._joints, surfaces, materials)
        return BuiltIn(self.name, glb, tuple(every_leg), tuple(spine))

    def _append(
        self, name: str, place: NDArray[np.floating[Any]], parent: str | None, skinned: bool
    ) -> None:
        parent_row = -1 if parent is None else self._row[parent]
        self._row[name] = len(self._joints)
        x, y, z = (float(value) for value in place)
        self._joints.append(Joint(name, parent_row, (x, y, z), skinned))

    def _bind(
        self, patch: Patch, names: tuple[str, ...], paint: Paint, material: Material, blend: float
    ) -> int:
        joints, weights = self._weights(patch, names, blend)
        positions = np.round(patch.positions, DECIMALS) + 0.0
        positions[:, 1] = np.maximum(positions[:, 1], 0.0)  # nothing reaches into the ground
        triangles = patch.triangles
        colours = _colours(patch, paint)
        if patch.faceted:
            corners = triangles.reshape(-1)
            positions, colours = positions[corners], colours[corners]
            joints, weights = joints[corners], weights[corners]
            triangles = np.arange(len(corners)).reshape(-1, 3)
        positions, triangles = _without_slivers(positions, triangles)
        surface = SkinnedSurface(
            positions,
            _normals(positions, triangles),
            np.round(colours, 4),
            joints,
            weights,
            triangles,
            0,
        )
        surfaces = self._surfaces.setdefault(material, [])
        surfaces.append(surface)
        return len(surfaces) - 1

    def _weights(
        self, patch: Patch, names: tuple[str, ...], blend: float
    ) -> tuple[IntArray, FloatArray]:
        """Return joint rows [V, 4] and weights [V, 4] by place along a chain of joints."""
        count = len(patch.positions)
        rows = [self._row[name] for name in names]
        chain = np.array([self._joints[row].position for row in rows])
        if not self._joints[rows[-1]].skinned:
            rows = rows[:-1]
        elif len(rows) > 1:  # the last bone goes on beyond its joint
            chain = np.concatenate([chain, 2.0 * chain[-1:] - chain[-2:-1]])
        joints, weights = np.zeros((count, 4), np.int64), np.zeros((count, 4))
        if len(rows) == 1:
            joints[:, 0], weights[:, 0] = rows[0], 1.0
            return joints, weights
        past = _shares_past_joints(chain, patch.centres, blend)[:, : len(rows)]
        share = past - np.concatenate([past[:, 1:], np.zeros((count, 1))], axis=1)
        strongest = np.argsort(-share, axis=1, kind="stable")[:, :2]
        weights[:, :2] = np.round(np.take_along_axis(share, strongest, axis=1), 4)
        weights[:, :2] /= weights[:, :2].sum(axis=1, keepdims=True)
        joints[:, :2] = np.where(weights[:, :2] > 0.0, np.array(rows)[strongest], 0)
        return joints, weights


def _shares_past_joints(chain: FloatArray, centres: FloatArray, blend: float) -> FloatArray:
    """Return for each centre [V] and bone [B] how far, 0 to 1, it is past the bone's start."""
    start, bone = chain[:-1], np.diff(chain, axis=0)
    length = np.linalg.norm(bone, axis=1)
    begin = np.concatenate([[0.0], np.cumsum(length)[:-1]])
    offset = centres[:, None, :] - start
    part = np.clip(np.einsum("vbk,bk->vb", offset, bone) / length**2, 0.0, 1.0)
    distance = np.linalg.norm(offset - part[:, :, None] * bone, axis=2)
    nearest = np.argmin(np.round(distance, 9), axis=1)
    at = begin[nearest] + part[np.arange(len(part)), nearest] * length[nearest]
    reach = blend * np.minimum(length[1:], length[:-1])
    step = np.clip((at[:, None] - begin[1:] + reach) / (2.0 * reach), 0.0, 1.0)
    return np.concatenate([np.ones((len(at), 1)), step**2 * (3.0 - 2.0 * step)], axis=1)


def _colours(patch: Patch, paint: Paint) -> FloatArray:
    """Return linear colours [V, 4]."""
    places = [place for place, _ in paint.stops]
    stops = np.array([_linear(colour) for _, colour in paint.stops])
    colours = np.stack([np.interp(patch.along, places, stops[:, k]) for k in range(3)], axis=1)
    if paint.belly is not None:
        share = np.clip((paint.belly_edge + 0.3 - patch.height) / 0.6, 0.0, 1.0)[:, None]
        colours += share * (_linear(paint.belly) - colours)
    for place, half_width, colour in paint.bands:
        share = np.clip(1.5 - np.abs(patch.along - place) / half_width, 0.0, 1.0)[:, None]
        colours += share * (_linear(colour) - colours)
    return np.concatenate([colours, np.ones((len(colours), 1))], axis=1)


def _linear(colour: str) -> FloatArray:
    """Return linear red, green and blue [3] of an sRGB "#rrggbb" (IEC 61966-2-1)."""
    encoded = np.array([int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)])
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _without_slivers(positions: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the mesh without triangles that have no area."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return positions, triangles[area > 1e-12]


def _normals(positions: FloatArray, triangles: IntArray) -> FloatArray:
    """Return unit normals [V, 3], weighted by the area of the triangles around each vertex."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    facing = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    corners = triangles.reshape(-1)
    total = np.stack(
        [np.bincount(corners, facing[:, k], minlength=len(positions)) for k in range(3)], axis=1
    )
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(length > 0.0, total / np.maximum(length, 1e-30), (0.0, 1.0, 0.0))


def _joined(surfaces: Sequence[SkinnedSurface], material: int) -> SkinnedSurface:
    """Return surfaces as one."""
    starts = np.cumsum([0, *(len(surface.positions) for surface in surfaces)])
    return SkinnedSurface(
        np.concatenate([surface.positions for surface in surfaces]),
        np.concatenate([surface.normals for surface in surfaces]),
        np.concatenate([surface.colours for surface in surfaces]),
        np.concatenate([surface.joints for surface in surfaces]),
        np.concatenate([surface.weights for surface in surfaces]),
        np.concatenate(
            [surface.triangles + start for surface, start in zip(surfaces, starts, strict=False)]
        ),
        material,
    )


def _twin(name: str) -> str:
    """Return the name on the right of one on the left; a name in the middle is its own."""
    return "Right" + name.removeprefix("Left") if name.startswith("Left") else name
