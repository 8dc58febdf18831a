"""Imports a GLB with Blender's own importer and says where nodes are in its last animation.

Usage: python play_blender.py FILE.glb TIME,TIME,... NODE,NODE,...

Prints JSON: positions[time][node] = [x, y, z] in glTF's axes. Runs in the environment that
install_blender.py makes.
"""

from __future__ import annotations

import json
import struct
import sys
import tempfile
from pathlib import Path
from typing import Any

import bpy


def renamed(source: Path, folder: Path) -> tuple[Path, str]:
    """Copy a GLB with node indices as node names, by which Blender's bones can then be found.

    Returns the copy and the name of the last animation, which is made unlike the others.
    """
    data = source.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    content: dict[str, Any] = json.loads(data[20 : 20 + length])
    for index, node in enumerate(content["nodes"]):
        node["name"] = f"node-{index}"
    content["animations"][-1]["name"] = "the-last"
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    header = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
    copy = folder / "renamed.glb"
    copy.write_bytes(header + text + rest)
    return copy, "the-last"


def play_only(animation: str) -> int:
    """Let every object play this animation and no other; return how many objects do."""
    playing = 0
    for thing in bpy.data.objects:
        data = thing.animation_data
        if data is None:
            continue
        data.action = None
        for track in data.nla_tracks:
            # The strips on the tracks begin a frame late: the action itself has the file's times.
            track.mute = True
            if track.name == animation:
                data.action = track.strips[0].action
                if hasattr(track.strips[0], "action_slot"):  # Blender 4.4 and later
                    data.action_slot = track.strips[0].action_slot
                playing += 1
    return playing


def place(node: int) -> list[float]:
    """Return where a node is, in glTF's axes: Blender's z is up."""
    name = f"node-{node}"
    for thing in bpy.data.objects:
        if thing.type == "ARMATURE" and name in thing.pose.bones:
            x, y, z = thing.matrix_world @ thing.pose.bones[name].head
            return [x, z, -y]
    x, y, z = bpy.data.objects[name].matrix_world.translation
    return [x, z, -y]


def main() -> None:
    """Print where the nodes are at the times."""
    source, times, nodes = Path(sys.argv[1]), sys.argv[2].split(","), sys.argv[3].split(",")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with tempfile.TemporaryDirectory() as folder:
        copy, animation = renamed(source, Path(folder))
        bpy.ops.import_scene.gltf(filepath=str(copy))
    playing = play_only(animation)
    scene = bpy.context.scene
    positions = []
    for time in times:
        frame = float(time) * scene.render.fps / scene.render.fps_base
        scene.frame_set(int(frame), subframe=frame - int(frame))
        positions.append([place(int(node)) for node in nodes])
    print("\n" + json.dumps({"objects_playing": playing, "positions": positions}))


if __name__ == "__main__":
    main()
