"""Pushes against what their equations say in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from polypod.body.blow import strike
from polypod.body.push import (
    FARTHEST_TURN,
    HARDEST,
    NO_DEFLECTION,
    Deflection,
    recover,
    recovery_rate,
)
from polypod.morphology.types import BodyTable

RATE = recovery_rate(0.5, 0.6)
UNIT = math.sqrt(9.81 * 0.5)
small = st.floats(-1.0, 1.0)


def trunk(width: float, length: float) -> BodyTable:
    return BodyTable(0.1, 0.5, np.array([width, 0.1, length]), np.zeros(3))


def test_a_blow_takes_a_body_as_far_as_a_critically_damped_spring() -> None:
    blown = NO_DEFLECTION._replace(rate_x=1.3)
    places = [recover(blown, RATE, t).x for t in np.linspace(0.0, 4.0 / RATE, 401)]
    assert max(places) == pytest.approx(1.3 / (math.e * RATE), rel=1e-5)
    assert int(np.argmax(places)) == 100
    # A body over its capture point slows down at the pendulum's rate: the spring does at first.
    soon = recover(blown, RATE, 1e-6)
    assert (1.3 - soon.rate_x) / 1e-6 == pytest.approx(math.sqrt(9.81 / 0.5) * 1.3, rel=1e-4)


@given(start=st.tuples(*[small] * 6), parts=st.lists(st.floats(1e-4, 0.5), min_size=1, max_size=8))
def test_any_steps_lead_to_the_same_place(start: tuple[float, ...], parts: list[float]) -> None:
    whole = recover(Deflection(*start), RATE, sum(parts))
    stepped = Deflection(*start)
    for part in parts:
        stepped = recover(stepped, RATE, part)
    assert np.allclose(whole, stepped, rtol=0.0, atol=1e-12)


@given(
    velocity=st.tuples(small, small, small),
    heading=st.floats(-4.0, 4.0),
    at=st.floats(-0.4, 0.4),
)
def test_the_struck_place_gets_the_velocity(
    velocity: tuple[float, float, float], heading: float, at: float
) -> None:
    given_velocity = np.array([velocity])
    body = trunk(0.15, 0.4)
    blow = strike(given_velocity, np.array([heading]), at, body, RATE)
    left = np.array([math.cos(heading), 0.0, -math.sin(heading)])
    # Of a plate that turns about the vertical; it nods as well, which the pitch has.
    struck = blow.velocity[0] + left * (at * blow.turn_rate[0])
    assert struck[[0, 2]] == pytest.approx(given_velocity[0, [0, 2]], abs=1e-12)
    # As much angular momentum as the lever makes of the impulse.
    gyration = (0.15**2 + 0.4**2) / 3.0
    across = float(blow.velocity[0] @ left)
    assert gyration * blow.turn_rate[0] == pytest.approx(at * across, abs=1e-12)


def test_what_legs_cannot_answer_is_lost() -> None:
    for size in (10.0, 1e3):
        blow = strike(np.array([[size, size, size]]), np.zeros(1), 0.3, trunk(0.1, 0.4), RATE)
        assert np.linalg.norm(blow.velocity) == pytest.approx(HARDEST * UNIT)
        farthest = recover(NO_DEFLECTION._replace(rate_heading=blow.turn_rate[0]), RATE, 1.0 / RATE)
        assert farthest.heading == pytest.approx(FARTHEST_TURN)
        assert abs(blow.roll_rate[0]) <= math.sqrt(9.81 / 0.5) + 1e-12


@pytest.mark.parametrize("angle", [0.4, -2.0])
def test_a_blow_turned_with_the_body_is_the_same(angle: float) -> None:
    body = trunk(0.1, 0.4)
    ahead = strike(np.array([[0.3, 0.1, 0.2]]), np.zeros(1), 0.2, body, RATE)
    sine, cosine = math.sin(angle), math.cos(angle)
    turned = np.array([[0.3 * cosine + 0.2 * sine, 0.1, 0.2 * cosine - 0.3 * sine]])
    blow = strike(turned, np.array([angle]), 0.2, body, RATE)
    x, y, z = blow.velocity[0]
    assert [x * cosine - z * sine, y, z * cosine + x * sine] == pytest.approx(ahead.velocity[0])
    for name in ("turn_rate", "pitch_rate", "roll_rate"):
        assert getattr(blow, name) == pytest.approx(getattr(ahead, name))
