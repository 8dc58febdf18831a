"""Lets a limb grow out of a trunk: where two skins meet, each takes on half of the other.

Both surfaces are lifted to nearly the same smooth union of the two shapes (the polynomial smooth
minimum of their distances, as used for implicit surfaces), and take each other's colour and weights
by the same share: the seam is seen neither at rest nor in motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.builtin.curves import FloatArray
from polypod.rigs.author import SkinnedSurface

IntArray = NDArray[np.int64]

INFLUENCES = 4
LEAST_WEIGHT = 0.01  # less is not felt, and a tie of two such could favour one side


class _Meeting(NamedTuple):
    """What a surface's vertices [V] take from another surface."""

    share: FloatArray  # [V] 0 far outside the other, 0.5 on it, 1 deep inside
    lift: FloatArray  # [V] m, outward
    normal: FloatArray  # [V, 3] the other's
    colour: FloatArray  # [V, 4] the other's
    weight: FloatArray  # [V, J] the other's


def fused(
    trunk: SkinnedSurface, limbs: Sequence[SkinnedSurface], width: float, joints: int
) -> list[SkinnedSurface]:
    """Return the trunk and the limbs, grown together.

    Args:
        trunk: what the limbs stick in.
        limbs: closed surfaces.
        width: m, how far from the seam the skin is still changed.
        joints: number of joints of the skeleton.
    """
    grown = [_grown(limb, [_meeting(limb, trunk, width, joints)], joints) for limb in limbs]
    return [_grown(trunk, [_meeting(trunk, limb, width, joints) for limb in limbs], joints), *grown]


def _meeting(surface: SkinnedSurface, other: SkinnedSurface, width: float, joints: int) -> _Meeting:
    """Return what each vertex takes from the other surface."""
    count = len(surface.positions)
    result = _Meeting(
        np.zeros(count),
        np.zeros(count),
        surface.normals.copy(),
        surface.colours.copy(),
        _dense(surface, joints),
    )
    low, high = other.positions.min(axis=0) - width, other.positions.max(axis=0) + width
    near = np.flatnonzero(np.all((surface.positions > low) & (surface.positions < high), axis=1))
    if not len(near):
        return result
    places = surface.positions[near]
    square = (
        np.einsum("vk,vk->v", places, places)[:, None]
        + np.einsum("uk,uk->u", other.positions, other.positions)
        - 2.0 * places @ other.positions.T
    )
    closest = np.maximum(square.min(axis=1, keepdims=True), 0.0)
    # The other's planes, averaged over a neighbourhood (implicit moving least squares).
    kernel = np.exp((closest - square) / (0.5 * width) ** 2)
    kernel /= kernel.sum(axis=1, keepdims=True)
    plane = np.einsum("uk,uk->u", other.positions, other.normals)
    distance = np.einsum("vk,vk->v", places, kernel @ other.normals) - kernel @ plane
    # A plane goes on for ever; the surface does not.
    fade = np.clip(2.0 - np.sqrt(closest[:, 0]) / width, 0.0, 1.0)
    result.share[near] = fade * np.clip(0.5 - 0.5 * distance / width, 0.0, 1.0)
    result.lift[near] = (
        0.25 * width * (fade * np.clip(1.0 - np.abs(distance) / width, 0.0, 1.0)) ** 2
    )
    result.normal[near] = kernel @ other.normals
    result.colour[near] = kernel @ other.colours
    result.weight[near] = kernel @ _dense(other, joints)
    return result


def _grown(surface: SkinnedSurface, meetings: Sequence[_Meeting], joints: int) -> SkinnedSurface:
    """Return a surface that has taken from others what it should."""
    total = sum((meeting.share for meeting in meetings), np.zeros(len(surface.positions)))
    scale = 1.0 / np.maximum(total, 1.0)
    own = 1.0 - np.minimum(total, 1.0)
    normal, colour = own[:, None] * surface.normals, own[:, None] * surface.colours
    weight = own[:, None] * _dense(surface, joints)
    lift = np.zeros(len(surface.positions))
    for meeting in meetings:
        share = (meeting.share * scale)[:, None]
        normal = normal + share * meeting.normal
        colour = colour + share * meeting.colour
        weight = weight + share * meeting.weight
        lift = lift + meeting.lift
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    slant = np.maximum(np.einsum("vk,vk->v", normal, surface.normals), 0.5)
    rows, shares = _strongest(weight)
    return replace(
        surface,
        positions=surface.positions + (lift / slant)[:, None] * normal,
        normals=normal,
        colours=colour,
        joints=rows,
        weights=shares,
    )


def _dense(surface: SkinnedSurface, joints: int) -> FloatArray:
    """Return the weights [V, J] on all joints."""
    weight = np.zeros((len(surface.positions), joints))
    vertex = np.arange(len(weight))
    for influence in range(surface.joints.shape[1]):
        weight[vertex, surface.joints[:, influence]] += surface.weights[:, influence]
    return weight


def _strongest(weight: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the joints [V, 4] with most weight, and the weights [V, 4] shared among them."""
    rounded = np.where(weight < LEAST_WEIGHT, 0.0, np.round(weight, 4))
    rows = np.argsort(-rounded, axis=1, kind="stable")[:, :INFLUENCES]
    shares = np.take_along_axis(rounded, rows, axis=1)
    shares /= shares.sum(axis=1, keepdims=True)
    return np.where(shares > 0.0, rows, 0), shares
