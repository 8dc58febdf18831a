"""On open ground a walk moved, turned, mirrored or scaled is the same walk.

The walks turn tightly enough that legs get into each other's way and ways around are looked for.

Tolerances are what was found on 4 s of walking, with room for another machine's rounding: errors of
rounding grow slowly along a walk, because feet are planned from feet.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest

from polypod.environment.terrain import Terrain
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.report.arrays import rotate_all
from polypod.world import World

SECONDS, FPS = 4.0, 30.0
TOLERANCE = 1e-9  # leg lengths
# Legs that pull at a pushed body do so one after the other, until it is as near as this to where
# all reach: another order ends elsewhere.
PULLED = 2e-5


class Walked(NamedTuple):
    """What is compared; F frames."""

    body: np.ndarray  # [F, 3]
    feet: np.ndarray  # [F, K, 3]
    joints: np.ndarray  # [F, J, 3]
    swinging: np.ndarray  # [F, K]


def walk(
    morphology: Morphology,
    *,
    speed: float,
    position: tuple[float, float] = (0.0, 0.0),
    heading: float = 0.0,
    turn: float = 0.9,
    travel: float = 0.0,
    shift: float = 0.0,
    height: float = 0.0,
    time_scale: float = 1.0,
    push: tuple[float, float] = (0.0, 0.0),
) -> Walked:
    """Walk straight on for a second and then along a turn; `shift` of the cycle ahead.

    Half a second later a blow to the front gives it a velocity, `push`: ahead and left.
    """
    world = World(Terrain.flat(height), threads=1)
    herd = world.add(morphology, position=position, heading=heading, speed=speed)
    herd.command.travel = travel
    # A standing creature's needle is where its first foot lifts: off that tie, or rounding decides.
    herd.state.needle[:] = (herd.state.needle + 1e-3 + shift) % 1.0
    frames = []
    for frame in range(round(SECONDS * FPS)):
        if frame == round(FPS):
            herd.command.heading = heading + turn
        if frame == round(1.5 * FPS) and push != (0.0, 0.0):
            sine, cosine = math.sin(heading), math.cos(heading)
            ahead, left = push
            blow = [ahead * sine + left * cosine, 0.0, ahead * cosine - left * sine]
            herd.push(blow, at=0.5 * float(morphology.body.half_size[2]))
        world.step(time_scale / FPS)
        state = herd.state
        frames.append(
            (
                state.position[0].copy(),
                state.foot_reached[0].copy(),
                state.joint_position[0].copy(),
                state.swinging[0].copy(),
            )
        )
    return Walked(*(np.array(part) for part in zip(*frames, strict=True)))


def unit(morphology: Morphology) -> float:
    return float(morphology.legs.length.mean())


def brisk(morphology: Morphology) -> float:
    return 0.25 * math.sqrt(9.81 * unit(morphology))


def assert_same(a: Walked, b: Walked, leg: float, tolerance: float = TOLERANCE) -> None:
    assert np.array_equal(a.swinging, b.swinging)
    assert a.swinging.any()
    for name in ("body", "feet", "joints"):
        gap = np.abs(getattr(a, name) - getattr(b, name)).max() / leg
        assert gap <= tolerance, f"{name} differ by {gap:.3g} leg lengths"


@pytest.fixture(scope="module", params=["spider", "wolf", "lizard", "centaur", "centipede"])
def creature(request: pytest.FixtureRequest) -> Morphology:
    return load_rig(request.param)


@pytest.fixture(scope="module")
def base(creature: Morphology) -> Walked:
    return walk(creature, speed=brisk(creature))


@pytest.mark.parametrize(
    "place", [(0.1, 0.3, 0.0), (-7.7, 3.3, 1.25), (12.5, -40.0, -3.0)], ids=str
)
def test_moved(creature: Morphology, base: Walked, place: tuple[float, float, float]) -> None:
    x, z, height = place
    moved = walk(creature, speed=brisk(creature), position=(x, z), height=height)
    shift = np.array([x, height, z])
    back = moved._replace(
        body=moved.body - shift, feet=moved.feet - shift, joints=moved.joints - shift
    )
    assert_same(base, back, unit(creature))


@pytest.mark.parametrize("angle", [0.3, 0.5 * math.pi, -2.0, 3.0])
def test_turned(creature: Morphology, base: Walked, angle: float) -> None:
    turned = walk(creature, speed=brisk(creature), heading=angle)
    back = np.array([0.0, math.sin(-0.5 * angle), 0.0, math.cos(-0.5 * angle)])
    unturned = turned._replace(
        **{name: rotate_all(back, getattr(turned, name)) for name in ("body", "feet", "joints")}
    )
    assert_same(base, unturned, unit(creature))


@pytest.mark.parametrize(
    ("turn", "travel", "push"), [(0.9, 0.0, 0.0), (0.0, 0.3, 0.0), (0.9, 0.0, 1.5)]
)
def test_mirrored(creature: Morphology, turn: float, travel: float, push: float) -> None:
    """Left for right, with the other side's feet half a cycle on: the gaits are symmetric."""
    speed = brisk(creature)
    left = walk(creature, speed=speed, turn=turn, travel=travel, push=(0.0, push * speed))
    right = walk(
        creature, speed=speed, turn=-turn, travel=-travel, shift=0.5, push=(0.0, -push * speed)
    )
    swap = mirrored_feet(creature)
    flip = np.array([-1.0, 1.0, 1.0])
    joints = mirrored_joints(creature)
    mirrored = Walked(
        right.body * flip,
        right.feet[:, swap] * flip,
        right.joints[:, joints] * flip,
        right.swinging[:, swap],
    )
    assert_same(left, mirrored, unit(creature), PULLED if push else TOLERANCE)


@pytest.mark.parametrize("strength", [0.5, 2.5])
def test_pushed_and_turned(creature: Morphology, strength: float) -> None:
    push = (0.5 * strength * brisk(creature), 1.5 * strength * brisk(creature))
    base = walk(creature, speed=brisk(creature), push=push)
    turned = walk(creature, speed=brisk(creature), heading=-2.0, push=push)
    back = np.array([0.0, math.sin(1.0), 0.0, math.cos(1.0)])
    unturned = turned._replace(
        **{name: rotate_all(back, getattr(turned, name)) for name in ("body", "feet", "joints")}
    )
    assert_same(base, unturned, unit(creature))


def mirrored_feet(morphology: Morphology) -> list[int]:
    """Return each foot's counterpart on the other side."""
    legs = morphology.legs
    pairs = list(zip(legs.side.tolist(), legs.row.tolist(), strict=True))
    return [pairs.index((-side, row)) for side, row in pairs]


def mirrored_joints(morphology: Morphology) -> list[int]:
    """Return each joint's counterpart: where it lies at rest, mirrored."""
    rest = morphology.joint_rest
    flip = rest * np.array([-1.0, 1.0, 1.0])
    gaps = np.linalg.norm(flip[:, None] - rest[None], axis=2)
    assert gaps.min(axis=1).max() < 1e-4 * unit(morphology)
    return [int(row) for row in gaps.argmin(axis=1)]


@pytest.mark.parametrize("scale", [0.01, 0.37, 4.0, 20.0])
def test_scaled(scale: float) -> None:
    """Lengths by s and times by sqrt(s), gravity being what it is, is the same sprawler's walk.

    (An upright animal's contact time is measured in metres and seconds, Hoyt 2000: a horse is no
    scaled dog.)
    """
    small = load_rig("spider", height=0.4)
    large = load_rig("spider", height=0.4 * scale)
    base = walk(small, speed=brisk(small), push=(0.0, brisk(small)))
    scaled = walk(large, speed=brisk(large), time_scale=math.sqrt(scale), push=(0.0, brisk(large)))
    back = scaled._replace(
        body=scaled.body / scale, feet=scaled.feet / scale, joints=scaled.joints / scale
    )
    assert_same(base, back, unit(small))
