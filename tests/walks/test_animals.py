"""Strides and duty factors against speed, beside what was measured on animals (BIOMECHANICS 2)."""

from __future__ import annotations

import math

import pytest
from animals import ANIMALS, DUTY, STRIDE, Animal, Point, scaled, walk

from polypod.gait.library import gait_ladder, make_gait
from polypod.gait.tempo import froude_number, tempo
from polypod.tables import make_tables

OF = {animal.name: animal for animal in ANIMALS}
# What a lizard's legs do not reach while its girdles do not turn: the tempo's law does.
EVERY = [(animal, point) for animal in ANIMALS for point in animal.points]


def name_of(value: object) -> str:
    if isinstance(value, Animal):
        return value.name
    return f"{value.speed:g} m/s" if isinstance(value, Point) else str(value)


@pytest.mark.parametrize(("animal", "point"), EVERY, ids=name_of)
def test_the_tempo_of_legs_that_reach_is_the_animals(animal: Animal, point: Point) -> None:
    tables = make_tables(scaled(animal))
    legs = tables.legs
    names, limits = gait_ladder(legs.side, legs.row, legs.upright)
    size = tables.hip_height if tables.upright else tables.leg_length
    rung = sum(froude_number(point.speed, size) > limit for limit in limits)
    gait = make_gait(names[rung], legs.side, legs.row)
    period, duty = tempo(
        point.speed, tables.hip_height, tables.leg_length, tables.upright, gait.duty_low,
        gait.duty_high, math.inf, math.nan,
    )  # fmt: skip
    # At the trot's end dogs of that study stride shorter than the law of all mammals.
    room = 0.3 if point.speed == 3.31 else STRIDE
    assert point.speed * period == pytest.approx(point.stride, rel=room)
    if point.duty is not None:
        assert duty == pytest.approx(point.duty, abs=DUTY)


@pytest.mark.parametrize(
    ("name", "speed"),
    [("dog", 1.2), ("dog", 2.8), ("dog", 5.0), ("horse", 9.0), ("horse", 17.0), ("human", 1.4),
     ("human", 3.0), ("desert iguana", 0.5), ("desert iguana", 1.2), ("desert iguana", 3.5)],
)  # fmt: skip
def test_what_walks_strides_as_the_animal(name: str, speed: float) -> None:
    point = next(point for point in OF[name].points if point.speed == speed)
    walked = walk(scaled(OF[name]), speed)
    assert walked.speed == pytest.approx(speed, rel=0.05)
    assert walked.stride == pytest.approx(point.stride, rel=STRIDE)
    if point.duty is not None:
        assert walked.duty == pytest.approx(point.duty, abs=DUTY)
