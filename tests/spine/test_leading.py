"""The way that a long body keeps ahead of its middle, as its head took it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.config import Settings
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.spine.leading import KEPT, follows_head, go_on, keep_bent, kept_yaw, lead_on


@pytest.fixture(scope="module")
def herd() -> Herd:
    return Herd(load_rig("centipede"), 1, Settings())


@pytest.fixture(autouse=True)
def _at_rest(herd: Herd) -> None:
    state = herd.state
    for array in (state.kept_way, state.kept_gone, state.front_rate, state.girdle_bend):
        array[:] = 0.0
    state.halts[:] = 0
    herd.command.speed = 0.3
    herd.command.travel = 0.0
    herd.command.arrays.waypoint_count[:] = 0


def yaw(herd: Herd, place: float) -> float:
    return kept_yaw(0, place, herd.kernel_state, herd.kernel_tables)


def lead(herd: Herd, error: float, speed: float, dt: float = 1.0 / 30.0) -> None:
    lead_on(
        0, dt, error, speed, herd.kernel_state, herd.kernel_command, herd.kernel_tables,
        herd.kernel_settings,
    )  # fmt: skip


@settings(deadline=None, max_examples=60)
@given(
    seed=st.integers(0, 1000),
    gone=st.floats(0.01, 0.999),
    steps=st.floats(0.0, 3.0),
    turned=st.floats(-0.5, 0.5),
)
def test_a_way_that_was_kept_stays_where_it_was(
    herd: Herd, seed: int, gone: float, steps: float, turned: float
) -> None:
    """What is so far ahead after going on is what was as much farther ahead before."""
    kept = herd.tables.bend.kept
    step = kept / KEPT
    state = herd.state
    state.kept_way[0] = np.random.default_rng(seed).normal(size=KEPT + 2)
    state.kept_gone[0] = gone * step
    way = steps * step
    # Beyond the last of the places it is on its way to the head.
    places = np.linspace(0.0, kept - gone * step - way, 40)
    before = [yaw(herd, place + way) for place in places]
    go_on(0, way, turned, herd.kernel_state, herd.kernel_tables)
    assert 0.0 <= state.kept_gone[0] < step
    after = [yaw(herd, place) for place in places]
    assert after == pytest.approx(np.array(before) - turned, abs=1e-9)


@settings(deadline=None, max_examples=40)
@given(error=st.floats(-3.0, 3.0), speed=st.floats(0.02, 1.0))
def test_the_head_turns_on_no_tighter_arc_than_the_body_can(
    herd: Herd, error: float, speed: float
) -> None:
    state = herd.state
    state.kept_way[:] = 0.0
    state.front_rate[:] = 0.0
    dt = 1.0 / 30.0
    for _ in range(300):
        front = float(state.kept_way[0, KEPT + 1])
        lead(herd, error - front, speed, dt)
        moved = float(state.kept_way[0, KEPT + 1]) - front
        assert abs(moved) <= herd.tables.bend.tightest * speed * dt * (1.0 + 1e-9)
    # It gets there, where the arc is short enough, and does not pass it by much.
    front = float(state.kept_way[0, KEPT + 1])
    if abs(error) < 0.5 * herd.tables.bend.tightest * speed * 300 * dt:
        assert front == pytest.approx(error, abs=0.02)


def test_it_begins_as_the_body_lies(herd: Herd) -> None:
    place = herd.tables.girdles.place
    herd.state.girdle_bend[0, :, 2, 0] = 0.4 * place
    keep_bent(0, herd.kernel_state, herd.kernel_tables)
    for at in np.linspace(0.0, place[-1], 30):
        assert yaw(herd, float(at)) == pytest.approx(
            0.4 * at, abs=0.4 * herd.tables.bend.kept / KEPT
        )


def test_only_who_walks_on_with_a_heading_is_led(herd: Herd) -> None:
    def led(speed: float = 0.0) -> bool:
        return follows_head(
            0, speed, herd.kernel_state, herd.kernel_command, herd.kernel_tables,
            herd.kernel_settings,
        )  # fmt: skip

    assert led()
    herd.command.travel = 0.5 * math.pi
    assert not led()
    herd.command.travel = 0.0
    herd.state.halts[0] = 1
    assert not led()
    herd.state.halts[0] = 0
    herd.command.arrays.waypoint_count[0] = 1
    assert not led()
    herd.command.arrays.waypoint_count[0] = 0
    herd.command.speed = 0.0
    assert not led()
    assert led(0.3)


@pytest.mark.parametrize("name", ["wolf", "lizard", "centaur", "spider"])
def test_short_bodies_are_steered_about_their_middle(name: str) -> None:
    assert Herd(load_rig(name), 1, Settings()).tables.bend.kept == 0.0
