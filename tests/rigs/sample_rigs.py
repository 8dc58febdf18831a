"""Small glTF files with known contents, and recordings of random motion on them."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from polypod.morphology.spine import rigid_trunk
from polypod.morphology.types import BodyTable, LegTable, Morphology, RigSource
from polypod.report.record import Recording
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.nodes import compose, parent_first_order

COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class SampleFile:
    """A glTF under construction: JSON and one buffer."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}, "bufferViews": []}
        self.json["accessors"] = []
        self.binary = b""

    def view(self, content: bytes, **fields: Any) -> int:
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(content)}
        self.binary += content
        self.json["bufferViews"].append(view | fields)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values: Any, kind: str = "f4", **fields: Any) -> int:
        array = np.asarray(values, f"<{kind}")
        width = int(np.prod(array.shape[1:], dtype=int))
        accessor = {
            "bufferView": self.view(array.tobytes()),
            "componentType": COMPONENTS[kind],
            "count": len(array),
            "type": TYPES[width],
        }
        self.json["accessors"].append(accessor | fields)
        return len(self.json["accessors"]) - 1

    def finish(self) -> None:
        self.binary += b"\0" * (-len(self.binary) % 4)
        if self.binary:
            self.json["buffers"] = [{"byteLength": len(self.binary)}]

    def glb(self, extra_chunks: tuple[tuple[int, bytes], ...] = ()) -> bytes:
        self.finish()
        return pack_glb(self.json, self.binary, extra_chunks)

    def document(self, name: str = "sample.glb") -> GltfDocument:
        return GltfDocument.from_bytes(self.glb(), name)


def pack_glb(
    content: dict[str, Any], binary: bytes, extra: tuple[tuple[int, bytes], ...] = ()
) -> bytes:
    return pack_text(json.dumps(content), binary, extra)


def pack_text(content: str, binary: bytes, extra: tuple[tuple[int, bytes], ...] = ()) -> bytes:
    text = content.encode()
    chunks = [(0x4E4F534A, text + b" " * (-len(text) % 4))]
    if binary:
        chunks.append((0x004E4942, binary))
    body = b"".join(struct.pack("<II", len(c), kind) + c for kind, c in [*chunks, *extra])
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def nasty_rig() -> SampleFile:
    """A skinned rig with what writers trip over, all in one file.

    Two roots (skeleton, skinned mesh), an armature turned and scaled by 100, a bind pose that is
    not the node pose, a joint given by a matrix, a joint without a name, two of one name, a
    detached foot, an unskinned mesh that rides on a joint, a mirrored joint, an animation, extras,
    extensions and an image.
    """
    sample = SampleFile()
    half = np.sqrt(0.5)
    matrix = compose(
        np.array([0.0, 0.01, 0.002]), np.array([0.0, 0.0, half, half]), np.array([1.0, 1.0, 1.0])
    )
    nodes: list[dict[str, Any]] = [
        {"name": "Armature", "rotation": [-half, 0, 0, half], "scale": [100, 100, 100]},
        {"name": "Root", "translation": [0, 0, 0.01], "extras": {"kept": [1, 2.5, None]}},
        {"name": "Spine", "matrix": [float(x) for x in matrix.T.ravel()]},
        {"name": "Leg", "translation": [0.01, 0, 0], "rotation": [0, 0.6, 0, 0.8]},
        {"name": "Leg", "translation": [0.02, 0, 0], "scale": [0.5, 0.5, 0.5]},
        {"translation": [0, 0.02, 0], "scale": [-1, 1, 1]},
        {"name": "Foot", "translation": [0.04, 0.0, 0.0]},
        {"name": "Helper", "translation": [0.001, 0.002, 0.003], "rotation": [0.6, 0, 0, 0.8]},
        {"name": "Shell"},
        {"name": "Body", "translation": [3, 2, 1]},
        {"name": "Lamp"},
    ]
    for parent, children in {0: [1], 1: [2, 6], 2: [7], 7: [3], 3: [4, 8], 4: [5]}.items():
        nodes[parent]["children"] = children
    nodes[8]["mesh"], nodes[9]["mesh"], nodes[9]["skin"] = 0, 1, 0
    sample.json |= {"nodes": nodes, "scenes": [{"nodes": [10, 0, 9]}], "scene": 0}
    joints = [1, 2, 3, 4, 5, 6]
    sample.finish()
    sample.json["skins"] = [{"joints": joints, "inverseBindMatrices": 0, "skeleton": 1}]
    world = _rest_worlds(nodes)
    # The bind pose differs from the node pose: every joint was turned a little when it was skinned.
    rng = np.random.default_rng(5)
    inverse_bind = [np.linalg.inv(world[j] @ _small_motion(rng, 0.002)) for j in joints]
    inverse_bind = np.array(inverse_bind)
    inverse_bind[:, 3] = [0.0, 0.0, 0.0, 1.0]
    sample.accessor(inverse_bind.transpose(0, 2, 1))
    points = rng.uniform(-1, 1, (6, 3)).astype(np.float32)
    bounds = {"min": [float(x) for x in points.min(0)], "max": [float(x) for x in points.max(0)]}
    rigid = {"POSITION": sample.accessor(points, **bounds)}
    skinned = dict(rigid)
    skinned["JOINTS_0"] = sample.accessor(np.tile(np.arange(4), (6, 1)), "u1")
    skinned["WEIGHTS_0"] = sample.accessor(np.tile([0.5, 0.25, 0.25, 0.0], (6, 1)))
    sample.json["meshes"] = [
        {"primitives": [{"attributes": rigid, "material": 0}]},
        {"primitives": [{"attributes": skinned}]},
    ]
    sample.json["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1]}}]
    times = sample.accessor([0.0, 1.0], min=[0.0], max=[1.0])
    turns = sample.accessor([[0, 0, 0, 1], [0, 0.6, 0, 0.8]])
    sample.json["animations"] = [
        {
            "name": "Polypod walk",
            "channels": [{"sampler": 0, "target": {"node": 3, "path": "rotation"}}],
            "samplers": [{"input": times, "output": turns}],
        }
    ]
    sample.json["extensionsUsed"] = ["EXT_unheard_of"]
    sample.json["extensions"] = {"EXT_unheard_of": {"deep": [{"a": 1.0}]}}
    return sample


def two_joint_rig() -> SampleFile:
    """The smallest skinned rig: two joints in a row at the scene's root, metres."""
    sample = SampleFile()
    sample.json |= {
        "nodes": [
            {"name": "hip", "translation": [0, 1, 0], "children": [1]},
            {"name": "foot", "translation": [0, -1, 0]},
            {"name": "skin", "mesh": 0, "skin": 0},
        ],
        "scenes": [{"nodes": [0, 2]}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": 0}],
    }
    inverse_bind = np.tile(np.eye(4), (2, 1, 1))
    inverse_bind[0, 1, 3] = -1.0
    sample.accessor(inverse_bind.transpose(0, 2, 1))
    points = np.array([[0, 0, 0], [0, 1, 0], [0.1, 0, 0]], np.float32)
    attributes = {
        "POSITION": sample.accessor(points, min=[0.0, 0.0, 0.0], max=[float(points[2, 0]), 1, 0]),
        "JOINTS_0": sample.accessor(np.array([[1, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0]]), "u1"),
        "WEIGHTS_0": sample.accessor(np.tile([1.0, 0, 0, 0], (3, 1))),
    }
    indices = sample.accessor([0, 1, 2], "u2")
    sample.json["meshes"] = [{"primitives": [{"attributes": attributes, "indices": indices}]}]
    return sample


def as_gltf_folder(sample: SampleFile, folder: Path, image: bytes) -> Path:
    """Write a sample as .gltf with its buffer and an image in outside files."""
    sample.finish()
    (folder / "the buffer.bin").write_bytes(sample.binary)
    (folder / "skin.png").write_bytes(image)
    content = json.loads(json.dumps(sample.json))
    content["buffers"][0]["uri"] = "the%20buffer.bin"
    spare = base64.b64encode(b"spare").decode()
    content["buffers"].append(
        {"byteLength": 5, "uri": f"data:application/octet-stream;base64,{spare}"}
    )
    content["images"] = [{"uri": "skin.png"}]
    content["textures"] = [{"source": 0}]
    path = folder / "rig.gltf"
    path.write_text(json.dumps(content))
    return path


def morphology_of(document: GltfDocument, metres_per_unit: float = 0.01) -> Morphology:
    """A morphology of all skin joints, made without looking for legs; it faces -Z in the file."""
    parents = document.node_parents()
    skin = document.skins()[0]
    order = [node for node in parent_first_order(parents) if node in set(skin.joints.tolist())]
    to_file = document.node_world_matrices()[skin.joints[0]] @ skin.inverse_bind[0]
    bind = {
        int(j): to_file @ np.linalg.inv(skin.inverse_bind[i]) for i, j in enumerate(skin.joints)
    }
    rest_file = np.array([bind[node] for node in order])
    turn, scale = np.array([0.0, 1.0, 0.0, 0.0]), np.full(3, metres_per_unit)
    centre = rest_file[:, :3, 3].mean(axis=0) * metres_per_unit
    body_from_file = compose(np.array([centre[0], -centre[1], centre[2]]), turn, scale)
    rest = (body_from_file @ rest_file)[:, :3, 3]
    row = {node: at for at, node in enumerate(order)}
    joint_parent = np.array([_nearest(node, parents, row) for node in order])
    none3, none2 = np.zeros((0, 3)), np.zeros((0, 2))
    none = np.zeros(0, np.int64)
    legs = LegTable(
        none, np.zeros((0, 1), np.int64), none, np.zeros((0, 2, 3)), none3, none3, np.zeros(0),
        none2, np.zeros(0), none, none3, none, none2, np.zeros(0), none, none,
        np.zeros(0, np.bool_), np.zeros((0, 1, 2)), none3,
    )  # fmt: skip
    return Morphology(
        document.name,
        RigSource(document, body_from_file, rest_file),
        tuple(document.node_names()[node] for node in order),
        np.array(order),
        joint_parent,
        rest,
        legs,
        (),
        none,
        none3,
        (),
        rigid_trunk(0, len(order), 0),
        BodyTable(0.1, 0.2, np.ones(3), np.zeros(3)),
        (),
    )


def random_walk(morphology: Morphology, frames: int = 40, far: float = 20.0) -> Recording:
    """Record smooth random turns of every joint while the body travels `far` metres away.

    Joints without a parent also drift from the body, as detached feet do.
    """
    rng = np.random.default_rng(frames)
    time = np.arange(frames) / 30.0
    count = len(morphology.joint_node)
    size = float(np.ptp(morphology.joint_rest, axis=0).max())
    body_position = np.outer(np.linspace(0, far, frames), [0.6, 0.0, 0.8])
    body_position[:, 1] = size * (1.0 + 0.1 * np.sin(time * 5.0))
    body_rotation = _smooth_turns(rng, time, 4.0)
    position, rotation = np.zeros((frames, count, 3)), np.zeros((frames, count, 4))
    for joint, parent in enumerate(morphology.joint_parent):
        turn = _smooth_turns(rng, time, 0.7)
        if parent < 0:
            base_position, base_rotation = body_position, body_rotation
            arm = morphology.joint_rest[joint] + 0.1 * size * np.sin(np.outer(time, [2, 3, 4]))
        else:
            base_position, base_rotation = position[:, parent], rotation[:, parent]
            arm = morphology.joint_rest[joint] - morphology.joint_rest[parent]
        position[:, joint] = base_position + rotate_all(base_rotation, arm)
        rotation[:, joint] = _product(base_rotation, turn)
    # The writer does not look at feet and obstacles.
    feet, obstacles = (frames, len(morphology.foot_name)), (frames, 0)
    return Recording(
        morphology=morphology,
        time=time,
        body_position=body_position,
        body_rotation=body_rotation,
        joint_position=position,
        joint_rotation=rotation,
        foot_position=np.zeros((*feet, 3)),
        foot_target=np.zeros((*feet, 3)),
        foot_stance=np.zeros(feet, np.bool_),
        foot_support=np.zeros(feet, np.int64),
        obstacle_position=np.zeros((*obstacles, 3)),
        obstacle_rotation=np.zeros((*obstacles, 4)),
        activity=np.zeros(feet[0], np.int64),
        gait=np.full(feet[0], "trot"),
    )


def rotate_all(rotation: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    matrices = compose(np.zeros(3), rotation, np.ones(3))[..., :3, :3]
    return np.einsum(
        "...ij,...j->...i", matrices, np.broadcast_to(vectors, (*rotation.shape[:-1], 3))
    )


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    vector = a[..., 3:] * b[..., :3] + b[..., 3:] * a[..., :3] + np.cross(a[..., :3], b[..., :3])
    scalar = a[..., 3] * b[..., 3] - np.einsum("...i,...i->...", a[..., :3], b[..., :3])
    return np.concatenate([vector, scalar[..., None]], axis=-1)


def _smooth_turns(rng: np.random.Generator, time: np.ndarray, most: float) -> np.ndarray:
    """Quaternions [F, 4] that turn up to `most` radians; signs are random, as in records."""
    axis = rng.normal(size=3)
    angle = most * np.sin(time * rng.uniform(1, 4) + rng.uniform(0, 6))
    turns = np.concatenate(
        [np.outer(np.sin(angle / 2), axis / np.linalg.norm(axis)), np.cos(angle / 2)[:, None]],
        axis=1,
    )
    return turns * rng.choice([-1.0, 1.0], (len(time), 1))


def _small_motion(rng: np.random.Generator, shift: float) -> np.ndarray:
    turn = rng.normal(size=4) * 0.2 + [0, 0, 0, 1]
    return compose(rng.normal(size=3) * shift, turn / np.linalg.norm(turn), np.ones(3))


def _nearest(node: int, parents: np.ndarray, row: dict[int, int]) -> int:
    node = int(parents[node])
    while node >= 0 and node not in row:
        node = int(parents[node])
    return row.get(node, -1)


def _rest_worlds(nodes: list[dict[str, Any]]) -> np.ndarray:
    plain = {"asset": {"version": "2.0"}, "nodes": nodes}
    stripped = json.loads(json.dumps(plain))
    for node in stripped["nodes"]:
        node.pop("mesh", None)
        node.pop("skin", None)
    return GltfDocument.from_bytes(json.dumps(stripped).encode(), "nodes").node_world_matrices()
