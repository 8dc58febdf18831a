"""A hand-made six-legged creature and a walk of it in closed form, for judging the judge.

Each leg has a hip, a knee and a pointed sole, two bones of equal length a = L / 2. The knee follows
from the law of cosines: with d = |sole - hip| it lies d / 2 along the way to the sole and
sqrt(a^2 - d^2 / 4) above it, in the vertical plane of that way.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from polypod.morphology.spine import rigid_trunk
from polypod.morphology.types import BodyTable, LegTable, Morphology, RigSource
from polypod.report.record import Recorder, Recording
from polypod.rigs.author import Joint, Material, SkinnedSurface, author_glb
from polypod.rigs.gltf import GltfDocument

LEG = 0.5  # m
BONE = 0.5 * LEG
HEIGHT = 0.2  # m, of the body centre above the soles
HIPS = np.array([[side * 0.1, 0.0, z] for z in (-0.18, 0.0, 0.18) for side in (1.0, -1.0)])
# Each row has a track of its own, so that a thing in the way of one foot is in no other's.
REACHES = (0.22, 0.30, 0.26)
REST_SOLES = HIPS + np.array(
    [
        [side * reach, -HEIGHT, 0.5 * z]
        for z, reach in zip((-0.2, 0.0, 0.2), REACHES, strict=True)
        for side in (1, -1)
    ]
)
PHASES = np.array([0.0, 0.5, 0.5, 0.0, 0.0, 0.5])  # touchdowns of the alternating tripod
DUTY = 0.6
STRIDE_S = 0.8
SPEED = 0.3
APEX = 0.06  # m


def knee_of(hip, sole):
    """Return the knee that makes both bones BONE long, bent upward."""
    way = sole - hip
    d = np.linalg.norm(way)
    along = way / d
    up = np.array([0.0, 1.0, 0.0]) - along * along[1]
    up /= np.linalg.norm(up)
    return hip + 0.5 * way + up * np.sqrt(BONE**2 - 0.25 * d**2)


def frame_of(bone, plane_normal):
    """Return the rotation matrix whose columns are the bone, the plane's normal, their product."""
    x = bone / np.linalg.norm(bone)
    y = plane_normal / np.linalg.norm(plane_normal)
    return np.stack([x, y, np.cross(x, y)], axis=1)


def quaternion_of(matrix):
    """Return x, y, z, w of a rotation matrix, by its largest eigenvector (Bar-Itzhack 2000)."""
    m = matrix
    k = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
            [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
            [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)],
        ]
    )
    values, vectors = np.linalg.eigh(k)
    q = vectors[:, values.argmax()]
    return q if q[3] >= 0.0 else -q


def normal_of(hip, knee, sole):
    return np.cross(knee - hip, sole - knee)


@cache
def morphology() -> Morphology:
    """Return the creature; its mesh is a box for the trunk and one for each bone."""
    joints = [Joint("Body", -1, (0.0, 0.0, 0.0))]
    rows = np.zeros((6, 2), np.int64)
    point_rest = np.zeros((6, 3, 3))
    for leg in range(6):
        knee = knee_of(HIPS[leg], REST_SOLES[leg])
        rows[leg] = [len(joints), len(joints) + 1]
        joints.append(Joint(f"Hip{leg}", 0, tuple(HIPS[leg])))
        joints.append(Joint(f"Knee{leg}", int(rows[leg, 0]), tuple(knee)))
        point_rest[leg] = [HIPS[leg], knee, REST_SOLES[leg]]
    document = GltfDocument.from_bytes(
        author_glb("Hexapod", joints, _surfaces(point_rest, rows), [Material("skin", 0.8)]),
        "hexapod.glb",
    )
    rest = np.array([joint.position for joint in joints])
    rest_file = np.tile(np.eye(4), (len(joints), 1, 1))
    rest_file[:, :3, 3] = rest
    legs = LegTable(
        joint_count=np.full(6, 2, np.int64),
        joint=rows,
        foot_joint=np.full(6, -1, np.int64),
        point_rest=point_rest,
        sole_rest=REST_SOLES.copy(),
        sole_stance=REST_SOLES.copy(),
        length=np.full(6, LEG),
        foot_half_size=np.full((6, 2), 0.01),
        foot_behind=np.zeros(6),
        roll_kind=np.zeros(6, np.int64),
        roll_pivot=REST_SOLES.copy(),
        toe_joint=np.full(6, -1, np.int64),
        section_radius=np.tile([0.01, 0.01, 0.0], (6, 1)),
        weight=np.full(6, 1.0 / 6),
        side=np.array([1, -1, 1, -1, 1, -1], np.int64),
        row=np.array([0, 0, 1, 1, 2, 2], np.int64),
        upright=np.zeros(6, np.bool_),
        bend_limit=np.full((6, 2, 2), np.nan),
        hip_limit=np.full((6, 3), np.nan),
    )
    return Morphology(
        name="Hexapod",
        source=RigSource(document, np.eye(4), rest_file),
        joint_name=tuple(joint.name for joint in joints),
        joint_node=np.arange(len(joints)),
        joint_parent=np.array([joint.parent for joint in joints]),
        joint_rest=rest,
        legs=legs,
        foot_name=tuple(f"Foot{leg}" for leg in range(6)),
        foot_node=rows[:, 1].copy(),
        foot_offset=REST_SOLES - point_rest[:, 1],
        spine=(),
        segments=rigid_trunk(6, len(joints), 1),
        body=BodyTable(0.06, HEIGHT, np.array([0.1, 0.06, 0.25]), np.zeros(3)),
        guesses=(),
    )


def _surfaces(point_rest, rows):
    pieces = [_box(np.array([0, 0, -0.25]), np.array([0, 0, 0.25]), 0.09, 0, (0.35, 0.2, 0.16))]
    for leg in range(6):
        hip, knee, sole = point_rest[leg]
        pieces.append(_box(hip, knee, 0.022, int(rows[leg, 0]), (0.55, 0.33, 0.2)))
        pieces.append(_box(knee, sole, 0.014, int(rows[leg, 1]), (0.75, 0.5, 0.3)))
    return pieces


def _box(start, end, radius, row, colour):
    """Return a stick of square section, every vertex carried by one joint."""
    along = end - start
    side = np.cross(along, [0.3, 1.0, 0.2])
    side /= np.linalg.norm(side)
    up = np.cross(side, along / np.linalg.norm(along))
    signs = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    corners = [p + radius * (a * side + b * up) for p in (start, end) for a, b in signs]
    faces = [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)] + [
        [3, 2, 1, 0],
        [4, 5, 6, 7],
    ]
    positions = np.array([corners[i] for face in faces for i in face])
    centre = positions.mean(axis=0)
    normals, triangles = [], []
    for f in range(6):
        a, b, c = positions[4 * f], positions[4 * f + 1], positions[4 * f + 2]
        normal = np.cross(b - a, c - a)
        order = [0, 1, 2, 3]
        if normal @ (a - centre) < 0.0:
            normal, order = -normal, [0, 3, 2, 1]
        normals += [normal / np.linalg.norm(normal)] * 4
        triangles += [[4 * f + order[0], 4 * f + order[i], 4 * f + order[i + 1]] for i in (1, 2)]
    count = len(positions)
    joints = np.zeros((count, 4), np.int64)
    joints[:, 0] = row
    weights = np.zeros((count, 4))
    weights[:, 0] = 1.0
    colours = np.tile(np.array([*colour, 1.0]), (count, 1))
    return SkinnedSurface(
        positions, np.array(normals), colours, joints, weights, np.array(triangles), 0
    )


def sole_at(leg, time):
    """Return where a foot is planned to be, whether it stands, walking along +z at SPEED.

    It touches down at cycle k + phase, DUTY / 2 of a stride's way in front of its rest place, and
    swings along a straight line with smoothstep timing and a height of APEX sin(pi s).
    """
    cycle = time / STRIDE_S - PHASES[leg]
    count = np.floor(cycle)
    share = cycle - count
    touchdown_s = (count + PHASES[leg]) * STRIDE_S
    rest = REST_SOLES[leg] + np.array([0.0, HEIGHT, 0.0])
    here = rest + np.array([0.0, 0.0, SPEED * (touchdown_s + 0.5 * DUTY * STRIDE_S)])
    if share < DUTY:
        return here, True
    s = (share - DUTY) / (1.0 - DUTY)
    eased = s * s * (3.0 - 2.0 * s)
    return here + np.array([0.0, APEX * np.sin(np.pi * s), eased * SPEED * STRIDE_S]), False


def walk(seconds=4.0, fps=30, bob=0.004, obstacle_count=0, edit=None) -> Recording:
    """Return a faultless walk over flat ground, or one with faults.

    The body's height is HEIGHT + bob cos(4 pi t / T): two beats a stride. `edit(frame, time, soles,
    targets, stance, support)` may change where soles [6, 3] are led to, and what was planned.
    """
    body = morphology()
    recorder = Recorder(body, obstacle_count)
    for frame in range(round(seconds * fps) + 1):
        time = frame / fps
        centre = np.array([0.0, HEIGHT + bob * np.cos(4 * np.pi * time / STRIDE_S), SPEED * time])
        planned = [sole_at(leg, time) for leg in range(6)]
        targets = np.array([place for place, _ in planned])
        stance = np.array([stands for _, stands in planned])
        support = np.full(6, -1)
        soles = targets.copy()
        if edit is not None:
            edit(frame, time, soles, targets, stance, support)
        position, rotation = pose_of(body, centre, soles)
        recorder.add(
            time, centre, [0, 0, 0, 1], position, rotation, soles, targets, stance, support,
            np.zeros((obstacle_count, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (obstacle_count, 1)), 0,
            "tripod",
        )  # fmt: skip
    return recorder.finish()


def pose_of(body, centre, soles):
    """Return joint positions [13, 3] and rotations [13, 4] that lead the legs to their soles."""
    position = np.zeros((13, 3))
    rotation = np.tile([0.0, 0.0, 0.0, 1.0], (13, 1))
    position[0] = centre
    for leg in range(6):
        hip, sole = HIPS[leg] + centre, soles[leg]
        knee = knee_of(hip, sole)
        rest = body.legs.point_rest[leg]
        upper, lower = body.legs.joint[leg]
        position[upper], position[lower] = hip, knee
        normal, rest_normal = normal_of(hip, knee, sole), normal_of(*rest)
        for row, bone, rest_bone in (
            (upper, knee - hip, rest[1] - rest[0]),
            (lower, sole - knee, rest[2] - rest[1]),
        ):
            turn = frame_of(bone, normal) @ frame_of(rest_bone, rest_normal).T
            rotation[row] = quaternion_of(turn)
    return position, rotation
