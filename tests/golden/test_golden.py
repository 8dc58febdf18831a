"""Walks stay what they were, until somebody means to change them.

The key quantities of two walks are kept in walks.json. After a change of motion that was wanted,
look at the walks, then renew the file:

    python tests/golden/test_golden.py

Compared with a tolerance: another machine's sine rounds differently.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from polypod.environment.environment import Environment
from polypod.environment.scattering import scatter
from polypod.environment.terrain import Terrain
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.arrays import runs_of
from polypod.world import World

KEPT = Path(__file__).with_name("walks.json")
SECONDS, FPS = 5.0, 30.0
TOLERANCE = 1e-4  # leg lengths
NAMES = ("spider over crates", "wolf over hills")


def make_walk(name: str) -> tuple[World, float]:
    """Return the world of a walk, and the leg length of its creature."""
    kind, _, place = name.split()
    morphology = load_rig(kind)
    if place == "crates":
        size = ((0.08, 0.02, 0.08), (0.3, 0.08, 0.3))
        crates = scatter(Terrain.flat(), 25, (-0.8, 0.7, 0.8, 3.5), size, 7)
        environment = Environment(obstacles=crates)
    else:
        environment = Environment(Terrain.hills(seed=4, relief=0.5, wavelength=4.0, size=30.0))
    world = World(environment, threads=1)
    world.add(morphology, speed=0.55 if kind == "spider" else 0.9, position=[0.0, 0.0])
    return world, float(morphology.legs.length.mean())


def digest(name: str) -> dict[str, Any]:
    """Return what is kept of a walk; lengths in leg lengths."""
    world, leg = make_walk(name)
    recording = record_walk(world, SECONDS, FPS)[0]
    landings = [
        [start for start, _ in runs_of(stance) if start > 0] for stance in recording.foot_stance.T
    ]
    every_second = slice(None, None, round(FPS))
    return {
        "touchdown_frames": landings,
        "touchdowns": [
            (recording.foot_position[frames, foot] / leg).tolist()
            for foot, frames in enumerate(landings)
        ],
        "stood_on_obstacles": int((recording.foot_support >= 0).any(axis=0).sum()),
        "body": (recording.body_position[every_second] / leg).tolist(),
        "body_rotation": recording.body_rotation[every_second].tolist(),
        "joints_at_the_end": (recording.joint_position[-1] / leg).tolist(),
        "highest_swing": float((recording.foot_position[:, :, 1] / leg).max()),
    }


@pytest.mark.parametrize("name", NAMES)
def test_a_walk_is_what_it_was(name: str) -> None:
    kept = json.loads(KEPT.read_text(encoding="utf-8"))[name]
    walked = digest(name)
    assert walked.keys() == kept.keys()
    assert walked["touchdown_frames"] == kept["touchdown_frames"]
    assert sum(map(len, walked["touchdown_frames"])) >= 20
    for key, value in kept.items():
        if key == "touchdown_frames":
            continue
        for mine, theirs in zip(flat(walked[key]), flat(value), strict=True):
            assert mine == pytest.approx(theirs, abs=TOLERANCE), key


def flat(value: Any) -> list[float]:
    """Return the numbers of nested lists, whose rows may be of unequal length."""
    if isinstance(value, list):
        return [number for part in value for number in flat(part)]
    return [float(value)]


def test_walks_tell_changes_of_motion_apart() -> None:
    """The digest notices what a golden walk is for: a creature lifting its feet a little higher."""
    world, leg = make_walk(NAMES[0])
    world.herds[0].command.step_height = world.herds[0].command.step_height * 1.02
    highest = record_walk(world, SECONDS, FPS)[0].foot_position[:, :, 1].max() / leg
    kept = json.loads(KEPT.read_text(encoding="utf-8"))[NAMES[0]]["highest_swing"]
    assert abs(highest - kept) > 5.0 * TOLERANCE


def renew() -> None:
    """Write the walks as they are now."""
    rounded = {name: _rounded(digest(name)) for name in NAMES}
    KEPT.write_text(json.dumps(rounded, indent=1) + "\n", encoding="utf-8")


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _rounded(part) for key, part in value.items()}
    if isinstance(value, list):
        return [_rounded(part) for part in value]
    return round(value, 6) if isinstance(value, float | np.floating) else value


if __name__ == "__main__":
    renew()
