"""A rig in its rest pose: nodes, the skin's vertices, and who carries them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError
from polypod.morphology.bind import bind_matrices
from polypod.rigs.gltf import GltfDocument

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Skeleton:
    """Nodes and skin in the rest pose. N nodes, V vertices, W weights a vertex.

    Positions are in the file's world space, or, after `turned`, in metres with the creature facing
    +Z and the origin where the file has it.
    """

    document: GltfDocument
    name: tuple[str, ...]  # [N] empty where the file has none
    parent: IntArray  # [N] -1 for roots
    rest_file: FloatArray  # [N, 4, 4] world matrices in the bind pose, file space
    is_joint: BoolArray  # [N] a skin names the node
    position: FloatArray  # [N, 3] at rest
    vertex: FloatArray  # [V, 3] at rest
    vertex_node: IntArray  # [V, W] nodes that carry the vertex
    vertex_weight: FloatArray  # [V, W] rows sum to one

    def turned(self, file_to_frame: FloatArray) -> Skeleton:
        """Return the same rig seen through a matrix [4, 4] from file space."""
        linear, shift = file_to_frame[:3, :3], file_to_frame[:3, 3]
        return replace(
            self,
            position=self.rest_file[:, :3, 3] @ linear.T + shift,
            vertex=self.vertex @ linear.T + shift,
        )

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """[N] each node's children."""
        found: list[list[int]] = [[] for _ in self.parent]
        for node, parent in enumerate(self.parent):
            if parent >= 0:
                found[parent].append(node)
        return tuple(tuple(nodes) for nodes in found)

    @cached_property
    def carrier(self) -> IntArray:
        """[V] the node with the largest weight on each vertex."""
        if not len(self.vertex):
            return np.zeros(0, np.int64)
        return np.asarray(
            self.vertex_node[np.arange(len(self.vertex)), self.vertex_weight.argmax(1)]
        )

    @cached_property
    def weight(self) -> FloatArray:
        """[N] the sum of the weights that each node has on the skin."""
        total = np.zeros(len(self.parent))
        np.add.at(total, self.vertex_node.ravel(), self.vertex_weight.ravel())
        return total

    @cached_property
    def ground(self) -> float:
        """Height of the lowest vertex: where the ground is if the rest pose stands."""
        return float(self.vertex[:, 1].min())

    @cached_property
    def top(self) -> float:
        """Height of the highest vertex."""
        return float(self.vertex[:, 1].max())

    def below(self, node: int) -> list[int]:
        """Return the node and everything under it, parents first."""
        found = [node]
        for other in found:
            found.extend(self.children[other])
        return found

    def path(self, top: int, bottom: int) -> list[int]:
        """Return the nodes from `top` down to `bottom`, both included; empty if there is no way."""
        found = [bottom]
        while found[-1] != top:
            above = int(self.parent[found[-1]])
            if above < 0:
                return []
            found.append(above)
        return found[::-1]

    def above(self, node: int) -> list[int]:
        """Return the node's ancestors, nearest first."""
        found = []
        node = int(self.parent[node])
        while node >= 0:
            found.append(node)
            node = int(self.parent[node])
        return found

    def share(self, nodes: list[int]) -> FloatArray:
        """Return [V] how much of each vertex the nodes carry together, 0 to 1."""
        chosen = np.zeros(len(self.parent), bool)
        chosen[nodes] = True
        return np.asarray((self.vertex_weight * chosen[self.vertex_node]).sum(axis=1))

    def label(self, node: int) -> str:
        """Return the node's name, or #index where it has none of its own."""
        name = self.name[node]
        return name if name and self.name.count(name) == 1 else f"#{node}"


def read_skeleton(document: GltfDocument) -> Skeleton:
    """Return the rig in its bind pose, in the file's world space.

    Raises:
        RigError: the file has no skin, or no vertex hangs on it.
    """
    skins = document.skins()
    if not skins:
        raise RigError(
            f"{document.name}: has no skin, so nothing says which joints move it; "
            "export the mesh skinned to an armature"
        )
    rest, spaces = bind_matrices(document)
    is_joint = np.zeros(len(rest), bool)
    for skin in skins:
        is_joint[skin.joints] = True
    vertex, node, weight = _rest_vertices(document, rest, spaces, is_joint)
    if not np.any(is_joint[node] & (weight > 0.0)):
        raise RigError(f"{document.name}: no mesh uses its skin; export the mesh with its armature")
    if not (np.isfinite(rest).all() and np.isfinite(vertex).all()):
        raise RigError(f"{document.name}: its rest pose holds numbers that are not finite")
    return Skeleton(
        document=document,
        name=document.node_names(),
        parent=document.node_parents(),
        rest_file=rest,
        is_joint=is_joint,
        position=rest[:, :3, 3].copy(),
        vertex=vertex,
        vertex_node=node,
        vertex_weight=weight,
    )


def _rest_vertices(
    document: GltfDocument, rest: FloatArray, spaces: FloatArray, is_joint: BoolArray
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return vertices [V, 3] at rest, the nodes [V, W] that carry them and their weights.

    Rigid meshes count where they hang on a joint, so that a trunk made of plain boxes is seen.
    """
    parents = document.node_parents()
    pieces: list[tuple[FloatArray, IntArray, FloatArray]] = []
    for part in document.mesh_parts():
        if part.skin >= 0:
            space = spaces[part.skin]
            nodes, weights = document.skins()[part.skin].joints[part.joints], part.weights
        else:
            space = rest[part.node]
            carrier = part.node
            while carrier >= 0 and not is_joint[carrier]:
                carrier = int(parents[carrier])
            if carrier < 0:
                continue
            nodes = np.full((len(part.positions), 1), carrier, np.int64)
            weights = np.ones((len(part.positions), 1))
        pieces.append((part.positions @ space[:3, :3].T + space[:3, 3], nodes, weights))
    widest = max((piece[1].shape[1] for piece in pieces), default=1)
    vertex = np.concatenate([np.zeros((0, 3)), *(piece[0] for piece in pieces)])
    node = np.zeros((len(vertex), widest), np.int64)
    weight = np.zeros((len(vertex), widest))
    start = 0
    for _, nodes, weights in pieces:
        rows = slice(start, start + len(nodes))
        node[rows, : nodes.shape[1]] = nodes
        weight[rows, : nodes.shape[1]] = weights
        start += len(nodes)
    return vertex, node, weight
