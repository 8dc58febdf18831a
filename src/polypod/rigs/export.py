"""Writes a walk as a GLB: the user's own file with one animation added and nothing lost."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from polypod.errors import SettingError
from polypod.report.files import replacing
from polypod.report.record import Recording
from polypod.rigs.editing import GltfEditor
from polypod.rigs.fields import Place
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.nodes import IntArray, local_matrix, local_parts, read_parents
from polypod.rigs.tracks import RestParts, Track, tracks_of

ANIMATION_NAME = "Polypod walk"
MOTION_NODE_NAME = "Polypod motion"


def write_glb(recording: Recording, path: str | os.PathLike[str]) -> None:
    """Write the recorded creature's file with its walk as the last animation.

    An interrupted run leaves either the whole file or what was there before.

    Raises:
        SettingError: the folder does not exist, the name does not end in .glb, or the disk is full.
        RigError: a joint cannot be placed because a node above it has scale zero.
    """
    if Path(path).suffix.lower() != ".glb":
        raise SettingError(f"cannot write {path}: a walk is written as .glb")
    with replacing(path) as temporary:
        temporary.write_bytes(glb_bytes(recording))


def glb_bytes(recording: Recording) -> bytes:
    """Return the bytes of the file that `write_glb` writes.

    Raises:
        RigError: a joint cannot be placed because a node above it has scale zero.
    """
    document = recording.morphology.source.document
    editor = GltfEditor(document)
    joints = {int(node) for node in recording.morphology.joint_node}
    motion_node = _motion_node(document, editor, joints)
    for node in sorted(joints | {motion_node}):
        editor.parts_from_matrix(node)
    tracks = tracks_of(recording, _rest_parts(document, editor), motion_node, _keyed(document))
    _add_animation(editor, recording, tracks)
    return editor.glb()


def _motion_node(document: GltfDocument, editor: GltfEditor, joints: set[int]) -> int:
    """Return a node above all joints and skinned meshes that is no joint; add one if need be."""
    parents = document.node_parents()
    carried = set(joints)
    for node, place in enumerate(document.root.parts("nodes")):
        # Engines ignore where a skinned mesh hangs, but judge by it whether the mesh is in view.
        if place.has("skin"):
            carried.add(node)
    roots = sorted({_root_of(node, parents) for node in carried})
    if len(roots) == 1 and roots[0] not in carried:
        return roots[0]
    return editor.add_root(MOTION_NODE_NAME, roots)


def _root_of(node: int, parents: IntArray) -> int:
    while parents[node] >= 0:
        node = int(parents[node])
    return node


def _rest_parts(document: GltfDocument, editor: GltfEditor) -> RestParts:
    places = Place(document.name, "", editor.json).parts("nodes")
    parts = [local_parts(place) for place in places]
    translation, rotation, scale = (np.array(column) for column in zip(*parts, strict=True))
    names = tuple(place.text("name") for place in places)
    local = np.array([local_matrix(place) for place in places])
    return RestParts(read_parents(places), local, translation, rotation, scale, names)


def _keyed(document: GltfDocument) -> set[tuple[int, str]]:
    """Return (node, path) for everything that the file's own animations move."""
    node_count = len(document.root.parts("nodes"))
    targets = [
        channel.part("target")
        for animation in document.root.parts("animations")
        for channel in animation.parts("channels")
    ]
    return {(target.reference("node", node_count), target.text("path")) for target in targets}


def _add_animation(editor: GltfEditor, recording: Recording, tracks: list[Track]) -> None:
    """Add one animation whose samplers all run on the record's times."""
    time = editor.add_accessor(recording.time.astype(np.float32), bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for track in tracks:
        target = {"node": track.node, "path": track.path}
        channels.append({"sampler": len(samplers), "target": target})
        output = editor.add_accessor(track.values)
        samplers.append({"input": time, "output": output, "interpolation": "LINEAR"})
    editor.add_animation({"name": ANIMATION_NAME, "channels": channels, "samplers": samplers})
