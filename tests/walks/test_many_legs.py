"""Forty legs: they keep their pace, out of each other's way."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from audit import audit
from places import LEAST_SHARE, default_speed, make_place

from polypod.gait.library import make_gait
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.apart import leg_room
from polypod.world import World

FPS = 30.0
START = 2.0


@pytest.mark.parametrize(("place", "seconds"), [("flat", 4.0), ("stairs", 8.0), ("crates", 8.0)])
def test_a_centipede_keeps_its_pace(place: str, seconds: float) -> None:
    morphology = load_rig("centipede")
    speed = default_speed(morphology)
    environment = make_place(place, morphology, 20.0 * speed, 1)
    world = World(environment, threads=1)
    world.add(morphology, speed=speed, position=[0.0, 0.0])
    # From rest it first gains speed.
    record_walk(world, START, FPS)
    walked = record_walk(world, seconds, FPS)[0]
    findings = audit(walked, environment.table, speed * seconds, max(LEAST_SHARE[place], 0.95))
    assert [f"{name}: {found}" for name, found in findings.items() if found.fails] == []
    # With waves from back to front two legs touched in every second frame.
    assert np.mean(leg_room(walked).of_leg < 0.0) < (0.1 if place == "stairs" else 0.01)
    # Half of the feet carry it at any moment.
    assert walked.foot_stance.sum(axis=1).min() >= len(morphology.foot_name) // 2


def test_its_waves_run_from_front_to_back() -> None:
    morphology = load_rig("centipede")
    world = World(threads=1)
    speed = default_speed(morphology)
    world.add(morphology, speed=speed, position=[0.0, 0.0])
    record_walk(world, START, FPS)
    walked = record_walk(world, 4.0, FPS)[0]
    legs = morphology.legs
    landed = np.diff(walked.foot_stance.astype(int), axis=0) > 0
    left = [k for k in np.argsort(legs.row) if legs.side[k] > 0]
    first = [np.flatnonzero(landed[:, k]) for k in left]
    lags = []
    for behind, ahead in pairwise(first):
        for frame in ahead:
            later = behind[behind >= frame]
            if len(later):
                lags.append((later[0] - frame) / FPS)
    gait = make_gait("centipede", legs.side, legs.row)
    stride = np.median(np.concatenate([np.diff(frames) for frames in first])) / FPS
    # The foot behind lands a tenth of a cycle later, beside the print of the one ahead.
    lag = (gait.touchdown[left[0]] - gait.touchdown[left[1]]) % 1.0
    assert np.median(lags) / stride == pytest.approx(lag, abs=0.05)
    gap = float(legs.sole_stance[left[1], 2] - legs.sole_stance[left[0], 2])
    assert abs(gap - lag * stride * speed) < gap
