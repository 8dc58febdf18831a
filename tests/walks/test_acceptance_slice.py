"""A slice of benchmarks/acceptance.py: some seconds of each creature, by the full criteria."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from audit import audit
from places import LEAST_SHARE, RIGS, default_speed, make_place

from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.recording import record_walk
from polypod.world import World

START, FPS, SEED = 2.0, 30.0, 1
# Over crates the whole walk: how far it gets is a mean over many of them.
SECONDS = {"flat": 4.0, "hills": 6.0, "stairs": 6.0, "slope": 6.0, "crates": 20.0, "forbidden": 8.0}
BUILT_IN = [rig.name for rig in RIGS if not rig.file]
SHARED = [rig for rig in RIGS if rig.file]
PLACES = ("flat", "hills", "stairs", "slope", "crates")
UNPROVEN = {("biped", "crates"), ("lizard", "crates")}


def broken(morphology: Morphology, place: str) -> list[str]:
    """Return a line for each criterion that a walk breaks, its start judged apart."""
    speed = default_speed(morphology)
    environment = make_place(place, morphology, speed * 22.0, SEED)
    world = World(environment, threads=1)
    world.add(morphology, speed=speed, position=[0.0, 0.0])
    lines = []
    # From rest it first gains speed; what is walked is judged from then on.
    for span, least in ((START, 0.0), (SECONDS[place], LEAST_SHARE[place])):
        recording = record_walk(world, span, FPS)[0]
        # Steering round what is forbidden is not asked for yet: how far it gets is luck.
        least = least if place != "forbidden" else 0.0
        findings = audit(recording, environment.table, speed * span, least)
        lines += [f"{name}: {finding}" for name, finding in findings.items() if finding.fails]
    return lines


# On two legs, or near the ground, it gets less far among so many crates: the benchmark tells.
SLICE = [
    (name, place)
    for name in (*BUILT_IN, "lizard", "centaur")
    for place in PLACES
    if (name, place) not in UNPROVEN
]


@pytest.mark.parametrize(("name", "place"), SLICE)
def test_built_in_creatures_keep_every_limit(name: str, place: str) -> None:
    assert broken(load_rig(name), place) == []


@pytest.mark.parametrize("name", BUILT_IN)
def test_nobody_touches_what_is_forbidden(name: str) -> None:
    assert broken(load_rig(name), "forbidden") == []


@pytest.mark.parametrize("place", ["flat", "crates"])
@pytest.mark.parametrize("rig", SHARED, ids=lambda rig: rig.name)
def test_real_rigs_keep_every_limit(
    rig: object, place: str, shared_rig: Callable[[str], Path]
) -> None:
    morphology = load_rig(shared_rig(rig.file), height=rig.height)  # type: ignore[attr-defined]
    assert broken(morphology, place) == []
