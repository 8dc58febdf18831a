"""`polypod bench`: what this machine does in a frame, beside P1's Table 1.

All walking is World.step with full planning and inverse kinematics for every creature: no level of
detail, nobody off screen. The parts of a frame are measured on the same walk, in one thread. Each
figure is the best of three runs of the very same work: what else the machine does only adds.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from polypod.jobs.outputs import judge_output
from polypod.jobs.screen import note, telling_of_compilation

if TYPE_CHECKING:
    from polypod.world import World

FPS = 30.0
# Herds, and how many of each, in crates of their own: few spiders meet few crates, by chance.
HERDS = {10: 20, 100: 2, 1000: 1}
FRAMES = 60
# Frames before a clock runs: standing creatures are not yet what is measured.
START_FRAMES = 30
WALK_SECONDS = 20.0
# Crates a square leg length: 45 on the strip that one spider walks over in 20 s.
CRATES_A_SQUARE = 0.85
CREATURE = "spider"
REPEATS = 3


class Figure(NamedTuple):
    """One line of the table."""

    name: str
    value: float
    unit: str
    asked: str = ""
    paper: str = ""  # P1's Table 1: Core i7 2.7 GHz of 2012, 100 eight-legged characters


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `polypod bench`."""
    parser.add_argument("--json", metavar="FILE", help="write the figures there too")
    parser.add_argument(
        "--no-first-run",
        action="store_true",
        help="leave out the first run of a new machine, which compiles everything anew",
    )


def run_bench(arguments: argparse.Namespace) -> int:
    """Measure, print the table, write the JSON if asked for; return the exit code."""
    if arguments.json:
        judge_output("--json", arguments.json, (".json",))
    with telling_of_compilation():
        crowd(2, threads=1).step(1.0 / FPS)
    figures = measure_all(first_run=not arguments.no_first_run)
    print(format_figures(figures))
    if arguments.json:
        from polypod.report.files import replacing

        with replacing(arguments.json) as temporary:
            table = {figure.name: figure.value for figure in figures}
            temporary.write_text(json.dumps(table, indent=2) + "\n", encoding="utf-8")
    return 0


def measure_all(first_run: bool) -> list[Figure]:
    """Return all figures, in the order in which they read best."""
    from polypod.compute import thread_count

    threads = thread_count()
    figures = hundred_spiders(threads)
    note("bench: one spider")
    figures.append(Figure("one spider, 20 s at 30 fps", one_walk(), "s", "under 1"))
    moving = walk_ms(True) / walk_ms(False)
    name = "its frame among 40 moving crates"
    figures.append(Figure(name, moving, "times still", "at most 2"))
    each = []
    for count, worlds in HERDS.items():
        note(f"bench: {count} spiders")
        # In one thread, by its processor time: a second thread helps a thousand more than ten, and
        # other programs disturb a clock.
        each.append(1e3 * frame_ms(count, 1, worlds, time.thread_time) / count)
        figures.append(Figure(f"{count} spiders, each, 1 thread", each[-1], "us a frame"))
    spread = max(each) / min(each)
    figures.append(Figure("most over least of these", spread, "times", "at most 1.25"))
    if first_run:
        note("bench: the first run of a new machine, with nothing compiled; about a minute")
        seconds, says = first_walk()
        said = "and says so" if says else "and does not say so"
        figures.append(Figure(f"very first run, {said}", seconds, "s", "under 60"))
    return figures


def hundred_spiders(threads: int) -> list[Figure]:
    """Return P1's Table 1 here: 100 spiders over crates, in all and part by part."""
    note("bench: 100 spiders over crates")
    paper = "45, 28 (LOD)"
    all_ms = frame_ms(100, threads, HERDS[100])
    name = f"100 spiders over crates, {threads} threads"
    figures = [Figure(name, all_ms, "ms a frame", "under 10 on 2", paper)]
    one_ms = all_ms
    if threads > 1:
        one_ms = frame_ms(100, 1, HERDS[100])
        figures.append(Figure("the same, 1 thread", one_ms, "ms a frame"))
        figures.append(Figure(f"{threads} threads against 1", one_ms / all_ms, "times"))
    papers = ("", "4 (maps alone)", "", "13")
    parts = part_ms(FRAMES)
    for (part, ms), paper_ms in zip(parts, papers, strict=True):
        figures.append(Figure(f"  of it {part}", ms, "ms a frame", "", paper_ms))
    return figures


def crowd(
    count: int, threads: int, seed: int = 0, seconds: float = (START_FRAMES + FRAMES) / FPS
) -> World:
    """Return spiders in rows that walk over as many crates for each, whatever their number."""
    from polypod.environment.scattering import scatter
    from polypod.environment.terrain import Terrain
    from polypod.morphology.load import load_rig
    from polypod.world import World, rows

    morphology = load_rig(CREATURE)
    unit = float(morphology.legs.length.mean())
    speed = 0.25 * (9.81 * unit) ** 0.5
    places = rows(count, unit)
    way = speed * seconds
    x0, z0 = places.min(axis=0) - 2.0 * unit
    x1, z1 = places.max(axis=0) + 2.0 * unit
    area = (x0, z0, x1, z1 + way)
    crates = round(CRATES_A_SQUARE * (x1 - x0) * (z1 + way - z0) / unit**2)
    size = ((0.16 * unit, 0.04 * unit, 0.16 * unit), (0.6 * unit, 0.16 * unit, 0.6 * unit))
    ground = Terrain.flat()
    world = World(ground, scatter(ground, crates, area, size, seed), threads=threads)
    world.add(morphology, count, position=places, speed=speed)
    return world


def started(world: World) -> World:
    """Return the world when its creatures walk."""
    for _ in range(START_FRAMES):
        world.step(1.0 / FPS)
    return world


def frame_ms(
    count: int, threads: int, worlds: int, clock: Callable[[], float] = time.perf_counter
) -> float:
    """Return the mean time of a frame of `count` spiders, over some worlds of crates, ms."""
    total = 0.0
    for seed in range(worlds):
        best = float("inf")
        for _ in range(REPEATS):
            world = started(crowd(count, threads, seed))
            began = clock()
            for _ in range(FRAMES):
                world.step(1.0 / FPS)
            best = min(best, clock() - began)
        total += best
    return 1e3 * total / (worlds * FRAMES)


def walk_ms(moving: bool) -> float:
    """Return the mean time of a frame of one spider among 40 crates that move, or the same still.

    They go to and fro at a third of its speed, over the strip on which it walks.
    """
    from dataclasses import replace

    from polypod.environment.scattering import scatter
    from polypod.environment.terrain import Terrain
    from polypod.morphology.load import load_rig
    from polypod.world import World

    morphology = load_rig(CREATURE)
    unit = float(morphology.legs.length.mean())
    speed = 0.25 * (9.81 * unit) ** 0.5
    ground = Terrain.flat()
    size = ((0.16 * unit, 0.04 * unit, 0.16 * unit), (0.6 * unit, 0.16 * unit, 0.6 * unit))
    area = (-1.5 * unit, 1.5 * unit, 1.5 * unit, speed * WALK_SECONDS)
    crates = scatter(ground, 40, area, size, 1)
    if moving:
        crates = tuple(
            replace(
                crate,
                path=((-crate.position[0], crate.position[1], crate.position[2] + unit),),
                speed=speed / 3.0,
            )
            for crate in crates
        )
    taken = []
    for _ in range(REPEATS):
        world = World(ground, crates, threads=1)
        world.add(morphology, position=[0.0, 0.0], speed=speed)
        started(world)
        frames = round(WALK_SECONDS * FPS) - START_FRAMES
        began = time.thread_time()
        for _ in range(frames):
            world.step(1.0 / FPS)
        taken.append((time.thread_time() - began) / frames)
    return 1e3 * min(taken)


def one_walk() -> float:
    """Return the seconds that one spider's walk over crates takes, recording included."""
    from polypod.recording import record_walk

    taken = []
    for _ in range(REPEATS):
        world = crowd(1, threads=1, seconds=WALK_SECONDS)
        began = time.perf_counter()
        record_walk(world, WALK_SECONDS, FPS)
        taken.append(time.perf_counter() - began)
    return min(taken)


def first_walk() -> tuple[float, bool]:
    """Return the seconds of a first `polypod walk` and whether it said that it compiles.

    In a process of its own with an empty cache, from start to GLB.
    """
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "POLYPOD_CACHE": str(Path(folder) / "cache")}
        # This process has set it for itself.
        environment.pop("NUMBA_CACHE_DIR", None)
        scene = Path(folder) / "crates.toml"
        scene.write_text(
            "[[scatter]]\ncount = 45\narea = [-1.0, 0.6, 1.0, 7.0]\n"
            "size = [[0.08, 0.02, 0.08], [0.3, 0.08, 0.3]]\nseed = 7\n"
        )
        words = ["walk", CREATURE, "--scene", str(scene), "--seconds", f"{WALK_SECONDS:g}"]
        words += ["-o", str(Path(folder) / "walk.glb")]
        began = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-m", "polypod", *words],
            env=environment, capture_output=True, text=True, check=False,
        )  # fmt: skip
        seconds = time.perf_counter() - began
    if done.returncode != 0:
        raise RuntimeError(f"the first run failed: {done.stderr.strip()[-500:]}")
    return seconds, "compiling" in done.stderr


def part_ms(frames: int) -> list[tuple[str, float]]:
    """Return the parts of a frame of 100 spiders in one thread and the mean time of each, ms."""
    import numpy as np

    from polypod.frame import PARTS, step_creatures

    best = np.full(len(PARTS), np.inf)
    for _ in range(REPEATS):
        world = started(crowd(100, 1))
        seconds = np.zeros(len(PARTS))
        for _ in range(frames):
            world.look_round()
            for herd in world.herds:
                step_creatures(herd, world.kernel_environment, 1.0 / FPS, 0, herd.count, 0, seconds)
        best = np.minimum(best, seconds)
    return list(zip(PARTS, (1e3 * best / frames).tolist(), strict=True))


def format_figures(figures: list[Figure]) -> str:
    """Return the table as text."""
    from polypod.compute import thread_count

    wide = max(len(figure.name) for figure in figures)
    lines = [
        f"Polypod on {thread_count()} cores. P1: Table 1 of the paper, on a Core i7 2.7 GHz of its "
        "time, ms for 100 eight-legged characters.",
        f"{'':<{wide}}  {'here':>9}  {'':<11} {'asked':<14} P1",
    ]
    for figure in figures:
        number = f"{figure.value:9.3g}" if figure.value < 100.0 else f"{figure.value:9.0f}"
        lines.append(
            f"{figure.name:<{wide}}  {number}  {figure.unit:<11} {figure.asked:<14} {figure.paper}"
            .rstrip()
        )  # fmt: skip
    return "\n".join(lines)
