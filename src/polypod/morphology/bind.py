"""Where the joints are in the bind pose, in the file's world space.

Inverse bind matrices give each joint's place in the *mesh's* space, which files put anywhere:
scaled by 100 or 0.01, turned, or shared with the mesh's node. One matrix G leads from there to the
space in which the nodes live. It is not written down; it is found by agreement with the node tree.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError
from polypod.rigs.gltf import GltfDocument, Skin

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# Node pose and bind pose agree in these parts (rotation in radians, place in creature sizes).
SAME = 2e-3
# A likely answer is believed while its misfit is no more than this beyond the least misfit: more
# where a root joint is exactly where it puts it.
DOUBT, MUCH_DOUBT = 0.25, 1.5
SCALE_TOLERANCE = 0.05


def bind_matrices(document: GltfDocument) -> tuple[FloatArray, FloatArray]:
    """Find every node's world matrix in the bind pose.

    Args:
        document: the file.

    Returns:
        rest [N, 4, 4], the nodes' world matrices in the bind pose (nodes that no skin names ride on
        their parent by their local matrix), and [S, 4, 4], each skin's G: mesh space to file world.

    Raises:
        RigError: an inverse bind matrix that has no inverse.
    """
    world = document.node_world_matrices()
    skins = document.skins()
    known: dict[int, FloatArray] = {}
    spaces = np.tile(np.eye(4), (len(skins), 1, 1))
    for index, skin in enumerate(skins):
        bind = _bind_in_mesh_space(document, index, skin)
        shown_by = sorted({part.node for part in document.mesh_parts() if part.skin == index})
        shared = [row for row, joint in enumerate(skin.joints) if int(joint) in known]
        if shared:
            targets = np.array([known[int(skin.joints[row])] for row in shared])
            spaces[index] = _by_agreement(bind[shared], targets, np.empty((0, 4, 4)))
        else:
            hints = np.concatenate([world[shown_by], np.eye(4)[None]])
            parents = document.node_parents()
            spaces[index] = find_space(bind, world[skin.joints], skin.joints, parents, hints)
        for row, joint in enumerate(skin.joints):
            known.setdefault(int(joint), spaces[index] @ bind[row])
    return _carry_to_all_nodes(document, known), spaces


def _bind_in_mesh_space(document: GltfDocument, index: int, skin: Skin) -> FloatArray:
    size = np.abs(np.linalg.det(skin.inverse_bind[:, :3, :3]))
    flat = np.flatnonzero(size <= 1e-30)
    if len(flat):
        name = document.node_names()[int(skin.joints[flat[0]])]
        raise RigError(
            f"{document.name}: skins[{index}].inverseBindMatrices: the matrix of joint "
            f'"{name}" flattens space and has no inverse; export the rig with its bind pose'
        )
    return np.asarray(np.linalg.inv(skin.inverse_bind), np.float64)


def find_space(
    bind: FloatArray, world: FloatArray, joints: IntArray, parents: IntArray, hints: FloatArray
) -> FloatArray:
    """Find the matrix from a skin's bind space to the world in which its nodes live.

    Args:
        bind: [n, 4, 4] the joints in bind space.
        world: [n, 4, 4] the same joints as the nodes pose them.
        joints: [n] their node indices.
        parents: [N] parent of each node, -1 for roots.
        hints: [h, 4, 4] likely answers, likeliest first: the mesh's node, the identity.

    Returns:
        [4, 4] the matrix.
    """
    above = _nearest_above(joints, parents)
    stretch = _length_ratio(bind, world, above)
    own = world @ np.linalg.inv(bind)
    # The root that carries most joints: if it did not move between the poses, it has the answer.
    root = _main_root(above)
    candidates = np.concatenate([hints, own[root : root + 1], own[:: max(1, len(own) // 64)]])
    sizes = np.cbrt(np.abs(np.linalg.det(candidates[:, :3, :3])))
    usable = np.abs(np.log(np.maximum(sizes, 1e-300) / stretch)) < SCALE_TOLERANCE
    if not usable.any():
        return _by_agreement(bind, world, own)
    fit = [_fit(candidate, bind, world) for candidate in candidates]
    score = np.where(usable, [f.misfit for f in fit], np.inf)
    share = np.where(usable, [f.exact.mean() for f in fit], 0.0)
    if share.max() == 1.0:
        return np.asarray(candidates[int(share.argmax())])
    # A body may lean as a whole in mid-clip, so most joints agreeing is no proof, as it is that a
    # root is exactly where a hint puts it.
    anchored = [bool(f.exact[above < 0].any()) for f in fit]
    order = sorted(range(len(hints)), key=lambda i: (not anchored[i], score[i]))
    for i in [*order, len(hints)]:
        doubt = MUCH_DOUBT if anchored[i] else DOUBT
        if score[i] <= score.min() + doubt:
            return np.asarray(candidates[i])
    return np.asarray(candidates[int(score.argmin())])


def _main_root(above: IntArray) -> int:
    """Return the row of the root that has the most joints below it."""
    below = np.zeros(len(above), np.int64)
    for row in range(len(above)):
        top = row
        while above[top] >= 0:
            top = int(above[top])
        below[top] += 1
    return int(below.argmax())


def _nearest_above(joints: IntArray, parents: IntArray) -> IntArray:
    """Return [n] the row of each joint's nearest ancestor among the joints, -1 for none."""
    row_of = {int(joint): row for row, joint in enumerate(joints)}
    above = np.full(len(joints), -1, np.int64)
    for row, joint in enumerate(joints):
        node = int(parents[joint])
        while node >= 0 and node not in row_of:
            node = int(parents[node])
        above[row] = row_of.get(node, -1)
    return above


def _length_ratio(bind: FloatArray, world: FloatArray, above: IntArray) -> float:
    """Return how many times longer bones are in the world than in bind space.

    Bone lengths hardly change in animation, so this survives any pose of the nodes.
    """
    child = np.flatnonzero(above >= 0)
    if not len(child):
        child, parent = np.arange(1, len(bind)), np.zeros(max(0, len(bind) - 1), np.int64)
    else:
        parent = above[child]
    in_bind = np.linalg.norm(bind[child, :3, 3] - bind[parent, :3, 3], axis=1)
    in_world = np.linalg.norm(world[child, :3, 3] - world[parent, :3, 3], axis=1)
    real = in_bind > 1e-6 * max(in_bind.max(initial=0.0), 1e-300)
    real &= in_world > 1e-6 * max(in_world.max(initial=0.0), 1e-300)
    if not real.any():
        sizes = np.cbrt(np.abs(np.linalg.det((world @ np.linalg.inv(bind))[:, :3, :3])))
        return float(np.median(sizes))
    return float(np.median(in_world[real] / in_bind[real]))


class _Fit(NamedTuple):
    """How well joints fit their nodes under a candidate."""

    misfit: float  # mean over the joints, in [0, 2]
    exact: BoolArray  # [n] the joint is where its node is


def _fit(space: FloatArray, bind: FloatArray, world: FloatArray) -> _Fit:
    placed = space @ bind
    spread = np.ptp(world[:, :3, 3], axis=0)
    size = max(float(np.linalg.norm(spread)), 1e-300)
    away = np.linalg.norm(placed[:, :3, 3] - world[:, :3, 3], axis=1) / size
    a, b = _directions(placed), _directions(world)
    turned = np.linalg.norm(a - b, axis=(1, 2)) / np.sqrt(2.0)  # 2 sin(angle / 2)
    misfit = np.minimum(turned, 1.0) + np.minimum(4.0 * away, 1.0)
    return _Fit(float(misfit.mean()), (turned < SAME) & (away < SAME))


def _directions(matrices: FloatArray) -> FloatArray:
    """Return [n, 3, 3] the matrices' axes as unit vectors in columns."""
    axes = matrices[:, :3, :3]
    return np.asarray(axes / np.maximum(np.linalg.norm(axes, axis=1, keepdims=True), 1e-300))


def _by_agreement(bind: FloatArray, world: FloatArray, own: FloatArray) -> FloatArray:
    """Return the joint's own answer that suits all joints best."""
    candidates = own if len(own) else world @ np.linalg.inv(bind)
    scores = [_fit(candidate, bind, world).misfit for candidate in candidates]
    return np.asarray(candidates[int(np.argmin(scores))])


def _carry_to_all_nodes(document: GltfDocument, known: dict[int, FloatArray]) -> FloatArray:
    """Return [N, 4, 4]: joints where their bind puts them, other nodes riding on their parent."""
    parents, local = document.node_parents(), document.node_local_matrices()
    rest = document.node_world_matrices()
    done = np.zeros(len(parents), bool)
    for start in range(len(parents)):
        branch = []
        node = start
        while node >= 0 and not done[node]:
            branch.append(node)
            node = int(parents[node])
        for node in reversed(branch):
            if node in known:
                rest[node] = known[node]
            elif parents[node] >= 0:
                rest[node] = rest[parents[node]] @ local[node]
            done[node] = True
    return rest
