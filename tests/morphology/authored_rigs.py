"""Small rigs made in memory: joints with boxes of skin on them, and the traps that files set."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6]


def matrix(scale=1.0, turn_x=0.0, turn_y=0.0, shift=(0.0, 0.0, 0.0)):
    """A similarity: scaled, turned about x, then about y (degrees), shifted."""
    a, b = np.radians([turn_x, turn_y])
    about_x = [[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]]
    about_y = [[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]]
    result = np.eye(4)
    result[:3, :3] = scale * np.array(about_y) @ np.array(about_x)
    result[:3, 3] = shift
    return result


@dataclass
class Bone:
    """A node at a place; with a `tip`, a bar of skin leads there; with `box`, a box hangs on it."""

    name: str
    parent: str | None
    place: tuple[float, float, float]
    tip: tuple[float, float, float] | None = None
    box: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None
    joint: bool = True
    width: float = 0.02

    def skin(self):
        """Vertices [n, 3] at rest, in boxes of eight."""
        boxes = []
        if self.tip is not None:
            steps = np.linspace(self.place, self.tip, 4)
            half = self.width * np.ones(3)
            boxes += [at + BOX * half for at in steps]
        if self.box is not None:
            low, high = np.array(self.box, float)
            boxes.append(0.5 * (low + high) + 0.5 * (high - low) * BOX)
        return np.concatenate(boxes) if boxes else np.zeros((0, 3))


@dataclass
class Rig:
    """Bones, and how the file tells of them."""

    bones: list[Bone] = field(default_factory=list)

    def add(self, name, parent, place, tip=None, box=None, joint=True, width=0.02):
        self.bones.append(Bone(name, parent, tuple(place), tip, box, joint, width))
        return self

    def renamed(self, rename):
        """The same rig with each name passed through a function."""
        return Rig(
            [
                replace(bone, name=rename(bone.name), parent=bone.parent and rename(bone.parent))
                for bone in self.bones
            ]
        )

    def glb(
        self,
        armature=None,
        mesh_node=None,
        space=None,
        turns=None,
        pose=None,
        names=None,
        unskinned=(),
    ):
        """Return the file.

        Args:
            armature: [4, 4] matrix of the node above all bones.
            mesh_node: [4, 4] matrix of the node that shows the mesh.
            space: [4, 4] G: what leads from mesh space to where the bones rest.
            turns: degrees, each bone's own axes are turned by multiples of it.
            pose: bone name -> [4, 4] that moves the node from its rest, in its own frame.
            names: names to write instead of the bones' (None: leave out).
            unskinned: bones whose skin is shown as a rigid mesh below them.
        """
        armature = np.eye(4) if armature is None else armature
        mesh_node = np.eye(4) if mesh_node is None else mesh_node
        space = np.eye(4) if space is None else space
        row = {bone.name: i for i, bone in enumerate(self.bones)}
        rest = np.array(
            [
                matrix(1.0, i * (turns or 0.0), 2 * i * (turns or 0.0), bone.place)
                for i, bone in enumerate(self.bones)
            ]
        )
        nodes = []
        for i, bone in enumerate(self.bones):
            above = armature if bone.parent is None else rest[row[bone.parent]]
            local = np.linalg.inv(above) @ rest[i] @ (pose or {}).get(bone.name, np.eye(4))
            node = {"matrix": local.T.ravel().tolist()}
            label = bone.name if names is None else names[i]
            if label is not None:
                node["name"] = label
            children = [row[other.name] for other in self.bones if other.parent == bone.name]
            if children:
                node["children"] = children
            nodes.append(node)
        roots = [i for i, bone in enumerate(self.bones) if bone.parent is None]
        joints = [i for i, bone in enumerate(self.bones) if bone.joint]
        buffer = _Buffer()
        skin = [(i, bone.skin()) for i, bone in enumerate(self.bones)]
        skinned = [(i, v) for i, v in skin if len(v) and self.bones[i].name not in unskinned]
        to_mesh = np.linalg.inv(space)
        vertex = np.concatenate([v for _, v in skinned]) @ to_mesh[:3, :3].T + to_mesh[:3, 3]
        carrier = np.concatenate([np.full(len(v), joints.index(i)) for i, v in skinned])
        influence = np.zeros((len(vertex), 4), np.uint16)
        influence[:, 0] = carrier
        weight = np.tile(np.array([1, 0, 0, 0], np.float32), (len(vertex), 1))
        meshes = [_mesh(buffer, vertex, influence, weight)]
        inverse = np.linalg.inv(rest[joints]) @ space
        bind = buffer.add(np.transpose(inverse, (0, 2, 1)).reshape(-1, 16), "MAT4")
        nodes.append({"name": "Armature", "children": roots, "matrix": armature.T.ravel().tolist()})
        shown = {"name": "Skin", "mesh": 0, "skin": 0, "matrix": mesh_node.T.ravel().tolist()}
        nodes.append(shown)
        for i, v in skin:
            if self.bones[i].name in unskinned:
                local = np.linalg.inv(rest[i])
                meshes.append(_mesh(buffer, v @ local[:3, :3].T + local[:3, 3]))
                nodes[i].setdefault("children", []).append(len(nodes))
                nodes.append({"name": self.bones[i].name, "mesh": len(meshes) - 1})
        document = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [len(self.bones), len(self.bones) + 1]}],
            "nodes": nodes,
            "meshes": meshes,
            "skins": [{"joints": joints, "inverseBindMatrices": bind}],
            "accessors": buffer.accessors,
            "bufferViews": buffer.views,
            "buffers": [{"byteLength": len(buffer.data)}],
        }
        return container(document, bytes(buffer.data))

    def write(self, folder: Path, **options):
        """Write the file into a folder and return its path."""
        path = folder / "authored.glb"
        path.write_bytes(self.glb(**options))
        return path


class _Buffer:
    def __init__(self):
        self.data, self.views, self.accessors = bytearray(), [], []

    def add(self, array, shape):
        kinds = {np.dtype(np.uint16): 5123, np.dtype(np.float32): 5126}
        array = array if array.dtype == np.uint16 else array.astype(np.float32)
        raw = array.tobytes()
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw)})
        self.data += raw
        accessor = {"bufferView": len(self.views) - 1, "componentType": kinds[array.dtype]}
        accessor |= {"count": len(array), "type": shape}
        if shape == "VEC3":
            accessor |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _mesh(buffer, vertex, influence=None, weight=None):
    faces = np.concatenate([8 * i + np.array(FACES, np.uint16) for i in range(len(vertex) // 8)])
    attributes = {"POSITION": buffer.add(vertex, "VEC3")}
    if influence is not None:
        attributes["JOINTS_0"] = buffer.add(influence, "VEC4")
        attributes["WEIGHTS_0"] = buffer.add(weight, "VEC4")
    indices = buffer.add(faces.astype(np.uint16), "SCALAR")
    return {"primitives": [{"attributes": attributes, "indices": indices}]}


def container(document, binary):
    """The GLB of a document and its binary chunk."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    total = 28 + len(text) + len(binary)
    head = struct.pack("<4sII", b"glTF", 2, total)
    return b"".join(
        [
            head,
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(binary), b"BIN\0"),
            binary,
        ]
    )


def quadruped(detached=False, markers=True, straight=False, girdle=False):
    """A beast 0.9 m tall facing +Z: four legs of two sections and a flat paw each."""
    rig = Rig()
    rig.add("Root", None, (0, 0, 0))
    rig.add("Pelvis", "Root", (0, 0.65, -0.4), tip=(0, 0.65, 0), width=0.1)
    rig.add("Chest", "Pelvis", (0, 0.65, 0.0), tip=(0, 0.65, 0.4), width=0.1)
    rig.add("Neck", "Chest", (0, 0.68, 0.5), tip=(0, 0.8, 0.6), width=0.05)
    rig.add("Head", "Neck", (0, 0.82, 0.65), box=((-0.06, 0.75, 0.6), (0.06, 0.9, 0.85)))
    rig.add("Tail1", "Pelvis", (0, 0.7, -0.5), tip=(0, 0.6, -0.8))
    rig.add("Tail2", "Tail1", (0, 0.6, -0.8), tip=(0, 0.5, -1.0))
    for end, z, trunk in (("Hind", -0.4, "Pelvis"), ("Fore", 0.4, "Chest")):
        for side, x in (("L", 0.15), ("R", -0.15)):
            bend = 0.0 if straight else (0.12 if end == "Hind" else -0.12)
            hip, knee, ankle = (x, 0.6, z), (x, 0.32, z + bend), (x, 0.05, z)
            above = trunk
            if girdle:
                above = f"{end}Girdle.{side}"
                rig.add(above, trunk, (0.3 * x, 0.62, z), tip=hip)
            upper, lower = f"{end}Upper.{side}", f"{end}Lower.{side}"
            rig.add(upper, above, hip, tip=knee, width=0.04)
            rig.add(lower, upper, knee, tip=ankle, width=0.03)
            if detached and markers:
                rig.add(f"{lower}_end", lower, ankle, joint=False)
            paw = ((x - 0.04, 0.0, z - 0.03), (x + 0.04, 0.08, z + 0.11))
            rig.add(f"{end}Foot.{side}", "Root" if detached else lower, ankle, box=paw)
    return rig


BACK = np.array(
    [[0, 0.62, -0.44], [0, 0.66, -0.2], [0, 0.67, 0.0], [0, 0.66, 0.2], [0, 0.64, 0.46]]
)


def long_back(root=0, flat=False, head=True, tail=True, legs_on_root=False):
    """A quadruped whose back has four joints, hung together in the file in one way or another.

    Args:
        root: of the four, which one all the others hang on: 0 the pelvis, 3 the chest.
        flat: all joints of the trunk hang on a root on the ground instead, and so do the legs.
        head: there are neck and head.
        tail: there is a tail of two joints.
        legs_on_root: all legs hang on the root joint, as in a flat rig.
    """
    rig = Rig().add("Root", None, (0, 0, 0))
    order = [root, *range(root - 1, -1, -1), *range(root + 1, 4)]
    for i in order:
        parent = "Root" if flat or i == root else f"Spine{i + 1 if i < root else i - 1}"
        begin, end = BACK[i], BACK[i + 1]
        # A joint lies where it turns against the one that it hangs on.
        place, tip = (end, begin) if i < root and not flat else (begin, end)
        rig.add(f"Spine{i}", parent, place, tip=tip, width=0.08)
    top, rump = ("Root", "Root") if flat else ("Spine3", "Spine0")
    if head:
        rig.add("Neck", top, BACK[4], tip=(0, 0.8, 0.6), width=0.05)
        above = "Root" if flat else "Neck"
        rig.add("Head", above, (0, 0.82, 0.65), box=((-0.06, 0.75, 0.6), (0.06, 0.9, 0.85)))
        rig.add("Ear.L", above if flat else "Head", (0.05, 0.9, 0.7), tip=(0.06, 1.0, 0.7))
        rig.add("Ear.R", above if flat else "Head", (-0.05, 0.9, 0.7), tip=(-0.06, 1.0, 0.7))
    if tail:
        rig.add("Tail1", rump, (0, 0.62, -0.5), tip=(0, 0.6, -0.7))
        rig.add("Tail2", "Root" if flat else "Tail1", (0, 0.6, -0.7), tip=(0, 0.5, -0.9))
    for end, z, trunk in (("Hind", -0.4, "Spine0"), ("Fore", 0.4, "Spine3")):
        for side, x in (("L", 0.15), ("R", -0.15)):
            bend = 0.12 if end == "Hind" else -0.12
            hip, knee, ankle = (x, 0.6, z), (x, 0.32, z + bend), (x, 0.05, z)
            above = "Root" if flat else f"Spine{root}" if legs_on_root else trunk
            rig.add(f"{end}Girdle.{side}", above, (0.3 * x, 0.62, z), tip=hip)
            rig.add(f"{end}Upper.{side}", f"{end}Girdle.{side}", hip, tip=knee, width=0.04)
            rig.add(f"{end}Lower.{side}", f"{end}Upper.{side}", knee, tip=ankle, width=0.03)
            paw = ((x - 0.04, 0.0, z - 0.03), (x + 0.04, 0.08, z + 0.11))
            rig.add(f"{end}Foot.{side}", f"{end}Lower.{side}", ankle, box=paw)
    return rig


def arthropod(rows=3, marks=True, feet=False):
    """A bug 0.3 m tall facing +Z: legs of three sections that end in points."""
    rig = Rig()
    rig.add("Body", None, (0, 0.2, 0), box=((-0.1, 0.15, -0.25), (0.1, 0.3, 0.25)))
    for row in range(rows):
        z = 0.4 * (row / (rows - 1) - 0.5)
        for side, sign in (("L", 1), ("R", -1)):
            points = [
                (0.1 * sign, 0.2, z),
                (0.2 * sign, 0.24, 1.2 * z),
                (0.4 * sign, 0.3, 1.8 * z),
                (0.5 * sign, 0.0, 2.0 * z),
            ]
            parent = "Body"
            for i, part in enumerate(("Coxa", "Femur", "Tibia")):
                name = f"{part}{row}.{side}"
                rig.add(name, parent, points[i], tip=points[i + 1], width=0.008)
                parent = name
            if marks:
                rig.add(f"Tip{row}.{side}", parent, points[3], joint=False)
    return rig


def biped():
    """A person 1.8 m tall facing +Z, arms spread, names as motion capture has them."""
    rig = Rig()
    rig.add("Hips", None, (0, 1.0, 0), tip=(0, 1.1, 0), width=0.12)
    rig.add("Spine", "Hips", (0, 1.1, 0), tip=(0, 1.3, 0), width=0.12)
    rig.add("Chest", "Spine", (0, 1.3, 0), tip=(0, 1.5, 0), width=0.12)
    rig.add("Neck", "Chest", (0, 1.52, 0), tip=(0, 1.6, 0), width=0.05)
    rig.add("Head", "Neck", (0, 1.62, 0), box=((-0.08, 1.6, -0.1), (0.08, 1.8, 0.12)))
    for side, sign in (("Left", 1), ("Right", -1)):
        rig.add(f"{side}Shoulder", "Chest", (0.05 * sign, 1.45, 0), tip=(0.18 * sign, 1.45, 0))
        rig.add(f"{side}Arm", f"{side}Shoulder", (0.18 * sign, 1.45, 0), tip=(0.45 * sign, 1.45, 0))
        rig.add(f"{side}ForeArm", f"{side}Arm", (0.45 * sign, 1.45, 0), tip=(0.7 * sign, 1.45, 0))
        x = 0.1 * sign
        rig.add(f"{side}UpLeg", "Hips", (x, 0.95, 0), tip=(x, 0.52, 0.01), width=0.06)
        rig.add(f"{side}Leg", f"{side}UpLeg", (x, 0.52, 0.01), tip=(x, 0.1, -0.02), width=0.05)
        heel = ((x - 0.04, 0.0, -0.08), (x + 0.04, 0.1, 0.1))
        rig.add(f"{side}Foot", f"{side}Leg", (x, 0.09, -0.02), box=heel)
        toes = ((x - 0.04, 0.0, 0.1), (x + 0.04, 0.04, 0.18))
        rig.add(f"{side}ToeBase", f"{side}Foot", (x, 0.02, 0.1), box=toes)
        rig.add(f"{side}Toe_End", f"{side}ToeBase", (x, 0.02, 0.18), joint=False)
    return rig


def middle_of_foot(legs, k):
    """Return the middle of a foot's shape at rest [3]; the sole may lie ahead of it."""
    return legs.sole_rest[k] - [0.0, 0.0, legs.foot_behind[k]]
