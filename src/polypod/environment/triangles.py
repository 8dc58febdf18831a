"""Triangles out of a mesh file: OBJ or glTF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from polypod.environment.obj import ObjReader
from polypod.environment.obstacles import LARGEST
from polypod.errors import RigError, SceneError, choices
from polypod.rigs.gltf import GltfDocument, MeshPart

FloatArray = NDArray[np.float64]

MESHES = (".obj", ".glb", ".gltf")


def read_triangles(path: Path, scale: float = 1.0) -> FloatArray:
    """Return the triangles [T, 3 corners, x y z] of a mesh file, in metres.

    Args:
        path: an .obj, .glb or .gltf file, y up; of glTF, every node's triangles as the file poses
            them.
        scale: metres of one unit of the file.

    Raises:
        SceneError: the file cannot be read, or a vertex is no number or too far away.
    """
    if path.suffix.lower() not in MESHES:
        raise SceneError(f"{path}: a mesh must be one of {choices(MESHES)}")
    read = ObjReader(path).read if path.suffix.lower() == ".obj" else lambda: _read_gltf(path)
    with np.errstate(all="ignore"):  # what is no number is refused below
        triangles = read() * scale
    if not bool(np.all(np.abs(triangles) <= LARGEST)):
        raise SceneError(
            f"{path}: a vertex is no number or not within {LARGEST:g} m of the origin; "
            "scale says the metres of one unit of the file"
        )
    return triangles


def _read_gltf(path: Path) -> FloatArray:
    """Return triangles [T, 3 corners, x y z] of all nodes, in the file's units and world."""
    try:
        document = GltfDocument.read(path)
        parts = document.mesh_parts()
    except RigError as error:
        raise SceneError(str(error)) from None
    found = [_posed(document, part)[part.triangles] for part in parts]
    return np.concatenate([np.zeros((0, 3, 3)), *found])


def _posed(document: GltfDocument, part: MeshPart) -> FloatArray:
    """Return a part's vertices [V, 3] where its node, or the joints of its skin, have them."""
    world = document.node_world_matrices()
    if part.skin < 0:
        return part.positions @ world[part.node, :3, :3].T + world[part.node, :3, 3]
    skin = document.skins()[part.skin]
    joints = world[skin.joints] @ skin.inverse_bind
    posed = np.zeros_like(part.positions)
    for slot in range(part.joints.shape[1]):
        moved = joints[part.joints[:, slot]]
        there = np.einsum("vij,vj->vi", moved[:, :3, :3], part.positions) + moved[:, :3, 3]
        posed += part.weights[:, slot, None] * there
    return posed
