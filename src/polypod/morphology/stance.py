"""How a creature stands: from its rest pose, crouched a little, or made up where rest is none."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.errors import SettingError
from polypod.morphology.layout import Layout
from polypod.morphology.limb import Limb

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# Parts of a leg's length.
MOST_EXTENSION = 0.9  # in stance: what is left is for the stride
TOLERATED_EXTENSION = 0.935  # a modeller's own stance is left alone up to here
FULL_EXTENSION = 0.97  # with a body height that was asked for
LEAST_DROP = 0.15  # a sole at least this far below its hip stands
LEVEL = 0.15  # soles within this of each other are on one ground
MOST_CROUCH = 0.2  # beyond it the soles are drawn in instead
ERECT = 0.45  # a sole no farther aside of its hip than this part of its drop is under it
UNDER_HIP, MOST_MOVE = 0.85, 0.3  # how much of what it is ahead or behind is taken back
SPREAD, DROP = 0.6, 0.47  # a made-up stance: out from the hip, and down
ASYMMETRY = 0.25  # pairs nearer to mirror images than this are made so


class Stance(NamedTuple):
    """Where the soles are when the creature stands; same frame as the limbs."""

    sole: FloatArray  # [K, 3] all at one height
    guesses: tuple[str, ...]


def stand(hip: FloatArray, limbs: list[Limb], layout: Layout, ground_asked: float | None) -> Stance:
    """Find the stance.

    Args:
        hip: [K, 3] m.
        limbs: the K legs at rest.
        layout: who is whose partner.
        ground_asked: height of the soles' plane where the user set the body's height.

    Raises:
        SettingError: the legs do not reach the plane asked for.
    """
    sole = np.array([limb.sole.place for limb in limbs])
    length = np.array([limb.length for limb in limbs])
    standing = _standing(hip, sole, length, limbs)
    guesses: list[str] = []
    ground = _level(sole[standing, 1]) if standing.any() else 0.0
    if 2 * int(standing.sum()) < len(limbs):
        standing[:] = False
        ground = float(np.mean(hip[:, 1] - DROP * length))
        guesses.append(
            "the rest pose is no stance, so one was made up: soles "
            f"{SPREAD:g} leg lengths out from the hips and {DROP:g} down; --body-height says how "
            "high"
        )
    elif not standing.all():
        guesses.append(
            f"{int((~standing).sum())} of {len(limbs)} feet are off the ground at rest; in stance "
            "they were put down"
        )
    sole = _put_down(hip, sole, length, layout, standing, ground)
    sole[:, 1] = ground
    sole = _under_hips(hip, sole, limbs)
    sole = _symmetric(sole, hip, length, layout)
    if ground_asked is not None:
        sole[:, 1] = ground_asked
        _refuse_overstretch(hip, sole, limbs)
        return Stance(sole, tuple(guesses))
    sole, crouch = _crouch(hip, sole, limbs)
    sole = _symmetric(sole, hip, length, layout)
    if crouch > 1e-6 * float(length.max()):
        guesses.append(
            f"its legs are nearly straight at rest, so it stands {crouch:.3g} m lower, no leg "
            f"extended beyond {MOST_EXTENSION:g} of its length; --body-height says otherwise"
        )
    return Stance(sole, tuple(guesses))


def _standing(
    hip: FloatArray, sole: FloatArray, length: FloatArray, limbs: list[Limb]
) -> BoolArray:
    """Tell which feet are on a common ground below their hips."""
    stretched = np.array([limb.sole.stretched for limb in limbs])
    hanging = (hip[:, 1] - sole[:, 1] > LEAST_DROP * length) & ~stretched
    if not hanging.any():
        return hanging
    level = _level(sole[hanging, 1])
    return np.asarray(hanging & (np.abs(sole[:, 1] - level) < LEVEL * length))


def _level(heights: FloatArray) -> float:
    return float(np.median(heights))


def _put_down(
    hip: FloatArray,
    sole: FloatArray,
    length: FloatArray,
    layout: Layout,
    standing: BoolArray,
    ground: float,
) -> FloatArray:
    """Return soles [K, 3] with those that do not stand placed like their partner, or outward."""
    placed = sole.copy()
    middle = hip.mean(axis=0)
    for k in np.flatnonzero(~standing):
        other = int(layout.partner[k])
        if other >= 0 and standing[other]:
            away = sole[other] - hip[other]
            placed[k] = hip[k] + away * np.array([-1.0, 1.0, 1.0])
            continue
        outward = sole[k] - hip[k]
        if np.hypot(outward[0], outward[2]) < 0.3 * length[k]:
            outward = hip[k] - middle
        plan = float(np.hypot(outward[0], outward[2]))
        # A leg that has no way outward stands below its hip.
        spread = SPREAD * length[k] / plan if plan > 1e-6 * length[k] else 0.0
        placed[k] = [hip[k, 0] + spread * outward[0], ground, hip[k, 2] + spread * outward[2]]
    return placed


def _under_hips(hip: FloatArray, sole: FloatArray, limbs: list[Limb]) -> FloatArray:
    """Return soles with those of erect legs moved along the body until they are under their hips.

    A foot swings as far ahead of its hip as behind it: one that rests off its hip, as a sculptor's
    pose has it, leaves half of the stride out of reach.
    """
    effector, chain = _effectors(sole, limbs)
    moved = sole.copy()
    for k in range(len(limbs)):
        drop = hip[k, 1] - effector[k, 1]
        aside = abs(effector[k, 0] - hip[k, 0])
        ahead = effector[k, 2] - hip[k, 2]
        if aside < ERECT * drop and abs(ahead) < drop:
            most = MOST_MOVE * chain[k]
            moved[k, 2] -= min(most, max(-most, UNDER_HIP * ahead))
    return moved


def _symmetric(sole: FloatArray, hip: FloatArray, length: FloatArray, layout: Layout) -> FloatArray:
    """Return soles with each pair the mirror image of the other, seen from their hips' middle."""
    result = sole.copy()
    for k, other in enumerate(layout.partner):
        if other <= k:
            continue
        middle = 0.5 * (hip[k, 0] + hip[other, 0])
        image = sole[other] * np.array([-1.0, 1.0, 1.0]) + np.array([2.0 * middle, 0.0, 0.0])
        if np.linalg.norm(image - sole[k]) < ASYMMETRY * length[k]:
            mean = 0.5 * (sole[k] + image)
            result[k] = mean
            result[other] = mean * np.array([-1.0, 1.0, 1.0]) + np.array([2.0 * middle, 0.0, 0.0])
    return result


def _effectors(sole: FloatArray, limbs: list[Limb]) -> tuple[FloatArray, FloatArray]:
    """Return the effectors [K, 3] over these soles and the chains' lengths [K] up to them."""
    raised = np.array([limb.effector - limb.sole.place for limb in limbs])
    chain = np.array(
        [limb.length - float(np.linalg.norm(r)) for limb, r in zip(limbs, raised, strict=True)]
    )
    return sole + raised, chain


def extension(hip: FloatArray, sole: FloatArray, limbs: list[Limb]) -> FloatArray:
    """Return [K] the distance from hip to effector as a part of the chain's length."""
    effector, chain = _effectors(sole, limbs)
    return np.asarray(np.linalg.norm(effector - hip, axis=1) / chain)


def _crouch(hip: FloatArray, sole: FloatArray, limbs: list[Limb]) -> tuple[FloatArray, float]:
    """Return soles raised together, and drawn in where that is not enough; and by how much."""
    effector, chain = _effectors(sole, limbs)
    if extension(hip, sole, limbs).max() <= TOLERATED_EXTENSION:
        return sole, 0.0
    most = MOST_EXTENSION * chain
    plan = np.hypot(*(effector - hip)[:, [0, 2]].T)
    drop = hip[:, 1] - effector[:, 1]
    allowed = np.sqrt(np.maximum(most**2 - plan**2, 0.0))
    needed = np.where(drop > allowed, drop - allowed, 0.0)
    crouch = float(np.minimum(needed, MOST_CROUCH * chain).max())
    raised = sole + np.array([0.0, crouch, 0.0])
    plan_allowed = np.sqrt(np.maximum(most**2 - (drop - crouch) ** 2, 0.0))
    for k in np.flatnonzero(plan > plan_allowed * (1.0 + 1e-9)):
        inward = (effector[k] - hip[k]) * (1.0 - plan_allowed[k] / plan[k])
        raised[k, [0, 2]] -= inward[[0, 2]]
    return raised, crouch


def _refuse_overstretch(hip: FloatArray, sole: FloatArray, limbs: list[Limb]) -> None:
    effector, chain = _effectors(sole, limbs)
    plan = np.hypot(*(effector - hip)[:, [0, 2]].T)
    room = np.sqrt(np.maximum((FULL_EXTENSION * chain) ** 2 - plan**2, 0.0))
    raised = effector[:, 1] - sole[:, 1]
    highest = float((raised + room + hip[:, 1].mean() - hip[:, 1]).min())
    asked = float(hip[:, 1].mean() - sole[:, 1].mean())
    if asked > highest * (1.0 + 1e-9):
        raise SettingError(
            f"body_height: {asked:.4g} m is more than the legs reach; give at most {highest:.4g}"
        )
