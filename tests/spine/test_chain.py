"""A spine's segments as a chain: bones keep their length, and angles come back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.config import Settings
from polypod.herd import Herd
from polypod.math.vec3 import Vec3
from polypod.morphology.load import load_rig
from polypod.report.arrays import rotate_all
from polypod.spine.chain import joint_angles, joint_turn, keep_bend, place_segments, within

ANGLE = st.floats(-1.4, 1.4)


@pytest.fixture(scope="module", params=["wolf", "lizard"])
def herd(request: pytest.FixtureRequest) -> Herd:
    return Herd(load_rig(request.param), 1, Settings())


@settings(deadline=None)
@given(ANGLE, ANGLE, ANGLE)
def test_angles_are_those_that_a_turn_was_made_of(yaw: float, pitch: float, roll: float) -> None:
    assert joint_angles(joint_turn(yaw, pitch, roll)) == pytest.approx(
        (yaw, pitch, roll), abs=1e-12
    )


@settings(deadline=None)
@given(ANGLE, ANGLE, ANGLE)
def test_angles_are_brought_within_limits_and_no_farther(x: float, y: float, z: float) -> None:
    limit = np.array([0.3, 0.2, 0.1])
    kept = within(Vec3(x, y, z), limit)
    assert np.all(np.abs(kept) <= limit)
    inside = np.abs([x, y, z]) <= limit
    assert np.array_equal(np.array(kept)[inside], np.array([x, y, z])[inside])


def pivots(herd: Herd) -> list[np.ndarray]:
    """Return the pivots of spine and tail, body frame, each chain as its segments place them."""
    spine, state = herd.tables.spine, herd.state
    first = len(spine.joint)
    chains = []
    for rest, begin in ((spine.pivot_rest, 0), (spine.tail_pivot_rest, first)):
        rows = begin + np.arange(len(rest) - 1)
        shift, turn = state.segment_shift[0, rows], state.segment_turn[0, rows]
        begins = shift + rotate_all(turn, rest[:-1])
        ends = shift + rotate_all(turn, rest[1:])
        assert begins[1:] == pytest.approx(ends[:-1], abs=1e-12), "segments hang together"
        chains.append(np.concatenate([begins, ends[-1:]]))
    return chains


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 1000), share=st.floats(0.0, 1.0))
def test_bones_keep_their_length_at_every_share_of_a_bend(
    herd: Herd, seed: int, share: float
) -> None:
    random = np.random.default_rng(seed)
    state, spine = herd.state, herd.tables.spine
    limit = np.concatenate([spine.limit, spine.tail_limit])
    state.spine_angle[0] = limit * random.uniform(-1.0, 1.0, limit.shape)
    state.spine_wish[0] = limit * random.uniform(-1.0, 1.0, limit.shape)
    state.spine_base_wish[0] = random.normal(size=3)
    place_segments(0, share, herd.kernel_state, herd.kernel_tables)
    for chain, length in zip(pivots(herd), (spine.bone_length, spine.tail_length), strict=True):
        assert np.linalg.norm(np.diff(chain, axis=0), axis=1) == pytest.approx(length, rel=1e-12)
    keep_bend(0, share, herd.kernel_state, herd.kernel_tables)
    assert np.all(np.abs(state.spine_angle[0]) <= limit * (1.0 + 1e-12))


def test_a_spine_at_rest_moves_nothing(herd: Herd) -> None:
    state = herd.state
    for array in (state.spine_angle, state.spine_wish, state.spine_base, state.spine_base_wish):
        array[:] = 0.0
    place_segments(0, 1.0, herd.kernel_state, herd.kernel_tables)
    assert not state.segment_shift.any()
    assert np.array_equal(
        state.segment_turn[0], np.tile([0, 0, 0, 1.0], (len(state.segment_turn[0]), 1))
    )
