"""The same walk to the last bit: for any number of threads, run, process, and company."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from polypod.config import Settings
from polypod.environment.obstacles import Obstacle
from polypod.environment.scattering import scatter
from polypod.environment.terrain import Terrain
from polypod.frame import step_creatures
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.record import write_record
from polypod.world import World, rows

SECONDS, FPS, COUNT, SPEED = 2.0, 30.0, 7, 0.5


def crates() -> tuple[Obstacle, ...]:
    size = ((0.08, 0.02, 0.08), (0.3, 0.08, 0.3))
    return scatter(Terrain.flat(), 200, (-3.0, -3.0, 3.0, 4.0), size, 3)


def make_world(threads: int, count: int = COUNT, space: float = 1.0) -> World:
    spider = load_rig("spider")
    world = World(Terrain.flat(), crates(), threads=threads)
    # The places of the largest herd: a creature starts where it would in company.
    places = rows(COUNT, float(spider.legs.length.mean()))[:count]
    settings = Settings(personal_space=space)
    herd = world.add(spider, count, position=places, speed=SPEED, settings=settings)
    herd.command.heading = np.linspace(-0.4, 0.4, COUNT)[:count]
    herd.push([0.7, 0.1, 0.4], 0, at=0.05)
    return world


def digests(threads: int, count: int = COUNT, space: float = 1.0) -> list[str]:
    """Return a digest of each creature's record."""
    parts = []
    for recording in record_walk(make_world(threads, count, space), SECONDS, FPS):
        arrays = (value for value in vars(recording).values() if isinstance(value, np.ndarray))
        parts.append(hashlib.sha256(b"".join(a.tobytes() for a in arrays)).hexdigest())
    return parts


@pytest.fixture(scope="module")
def expected() -> list[str]:
    return digests(1)


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_threads_and_runs_make_no_difference(threads: int, expected: list[str]) -> None:
    assert digests(threads) == expected
    assert len(set(expected)) == COUNT  # and the creatures do not all walk alike


def test_company_makes_no_difference_to_who_does_not_heed_it() -> None:
    assert digests(1, count=3, space=0.0) == digests(1, space=0.0)[:3]


def test_equal_walks_give_equal_record_files(tmp_path: Path) -> None:
    for name in ("one.npz", "two.npz"):
        write_record(record_walk(make_world(2, 1), 0.5, FPS)[0], tmp_path / name)
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()


@pytest.mark.parametrize("hash_seed", ["1", "77"])
def test_another_process_makes_no_difference(hash_seed: str, expected: list[str]) -> None:
    here = Path(__file__).resolve()
    script = f"import sys; sys.path.insert(0, {str(here.parent)!r}); import {here.stem} as walk; "
    done = subprocess.run(
        [sys.executable, "-c", script + "print('\\n'.join(walk.digests(2)))"],
        env={**os.environ, "PYTHONHASHSEED": hash_seed},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.split() == expected


def test_clocks_change_nothing_and_see_every_part() -> None:
    whole, clocked = make_world(1), make_world(1)
    seconds = np.zeros(4)
    for _ in range(45):
        whole.step(1.0 / FPS)
        clocked.look_round()
        for herd in clocked.herds:
            step_creatures(herd, clocked.kernel_environment, 1.0 / FPS, 0, herd.count, 0, seconds)
    for name, array in whole.herds[0].state._asdict().items():
        if isinstance(array, np.ndarray):
            assert array.tobytes() == getattr(clocked.herds[0].state, name).tobytes(), name
    assert np.all(seconds > 0.0)
