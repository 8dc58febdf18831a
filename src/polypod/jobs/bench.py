"""`polypod bench`: what this machine does in a frame, beside P1's Table 1.

All walking is World.step with full planning and inverse kinematics for every creature: no level of
detail, nobody off screen. The parts of a frame are measured by calling the loop's own kernels one
after another on the same walk, creature by creature; a test holds that walk against World.step to
the last bit. What a call from Python costs is measured apart and taken off.
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
from typing import TYPE_CHECKING, Any, NamedTuple

from polypod.jobs.screen import note, telling_of_compilation
from polypod.report.files import replacing

if TYPE_CHECKING:
    from polypod.world import World

FPS = 30.0
HERDS = (10, 100, 1000)
# Frames of each herd: as many creature-frames, but never too few to average over a gait cycle.
FRAMES = {10: 300, 100: 90, 1000: 30}
# Frames before a clock runs: standing creatures are not yet what is measured.
START_FRAMES = 30
WALK_SECONDS = 20.0
# Crates a square leg length: 45 on the strip that one spider walks over in 20 s.
CRATES_A_SQUARE = 0.85
SEED = 7
CREATURE = "spider"
PARTS = ("gait and steering", "maps, footprints and paths", "body", "inverse kinematics")


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
    with telling_of_compilation():
        crowd(2, threads=1).step(1.0 / FPS)
    figures = measure_all(first_run=not arguments.no_first_run)
    print(format_figures(figures))
    if arguments.json:
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
    each = []
    for count in HERDS:
        note(f"bench: {count} spiders")
        each.append(1e3 * frame_ms(crowd(count, threads), FRAMES[count]) / count)
        figures.append(Figure(f"{count} spiders, each", each[-1], "us a frame"))
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
    all_ms = frame_ms(crowd(100, threads), FRAMES[100])
    name = f"100 spiders over crates, {threads} threads"
    figures = [Figure(name, all_ms, "ms a frame", "under 10 on 2", paper)]
    one_ms = all_ms
    if threads > 1:
        one_ms = frame_ms(crowd(100, 1), FRAMES[100])
        figures.append(Figure("the same, 1 thread", one_ms, "ms a frame"))
        figures.append(Figure(f"{threads} threads against 1", one_ms / all_ms, "times"))
    papers = ("", "4 (maps)", "", "13")
    for part, ms, note_of_paper in zip(PARTS, part_ms(crowd(100, 1), FRAMES[100]), papers,
                                       strict=True):  # fmt: skip
        figures.append(Figure(f"  of it {part}", ms, "ms a frame", "", note_of_paper))
    return figures


def crowd(count: int, threads: int) -> World:
    """Return spiders in rows that walk over as many crates for each, whatever their number."""
    from polypod.environment.obstacles import scatter
    from polypod.environment.terrain import Terrain
    from polypod.morphology.load import load_rig
    from polypod.world import World, rows

    morphology = load_rig(CREATURE)
    unit = float(morphology.legs.length.mean())
    speed = 0.25 * (9.81 * unit) ** 0.5
    places = rows(count, unit)
    way = speed * (START_FRAMES + max(FRAMES.values())) / FPS
    x0, z0 = places.min(axis=0) - 2.0 * unit
    x1, z1 = places.max(axis=0) + 2.0 * unit
    area = (x0, z0, x1, z1 + way)
    crates = round(CRATES_A_SQUARE * (x1 - x0) * (z1 + way - z0) / unit**2)
    size = ((0.16 * unit, 0.04 * unit, 0.16 * unit), (0.6 * unit, 0.16 * unit, 0.6 * unit))
    ground = Terrain.flat()
    world = World(ground, scatter(ground, crates, area, size, SEED), threads=threads)
    world.add(morphology, count, position=places, speed=speed)
    return world


def frame_ms(world: World, frames: int) -> float:
    """Return the mean time of a frame of walking, ms."""
    for _ in range(START_FRAMES):
        world.step(1.0 / FPS)
    began = time.perf_counter()
    for _ in range(frames):
        world.step(1.0 / FPS)
    return 1e3 * (time.perf_counter() - began) / frames


def one_walk() -> float:
    """Return the seconds that one spider's walk over crates takes, recording included: median."""
    from polypod.recording import record_walk

    taken = []
    for _ in range(3):
        world = crowd(1, threads=1)
        began = time.perf_counter()
        record_walk(world, WALK_SECONDS, FPS)
        taken.append(time.perf_counter() - began)
    return sorted(taken)[1]


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


def part_ms(world: World, frames: int) -> tuple[float, ...]:
    """Return the mean time of each of PARTS in a frame of one thread, ms."""
    for _ in range(START_FRAMES):
        world.step(1.0 / FPS)
    clock = PartClock()
    for _ in range(frames):
        step_in_parts(world, 1.0 / FPS, clock)
    cost = call_seconds(world)
    return tuple(
        1e3 * (seconds - calls * cost) / frames
        for seconds, calls in zip(clock.seconds, clock.calls, strict=True)
    )


class PartClock:
    """Adds up the time and the kernel calls of each part of a frame."""

    def __init__(self) -> None:
        self.seconds = [0.0] * len(PARTS)
        self.calls = [0] * len(PARTS)

    def time(self, part: int, calls: int, run: Callable[[], Any]) -> Any:
        """Run one part of a creature's frame and return what it returns."""
        began = time.perf_counter()
        result = run()
        self.seconds[part] += time.perf_counter() - began
        self.calls[part] += calls
        return result


def call_seconds(world: World) -> float:
    """Return what a call of a kernel from Python costs, with the clock around it."""
    from polypod.controller.steering import plan_pose

    state = world.herds[0].kernel_state
    clock = PartClock()
    for _ in range(20_000):
        clock.time(0, 1, lambda: plan_pose(0, state))
    return clock.seconds[0] / clock.calls[0]


def step_in_parts(world: World, dt: float, clock: PartClock) -> None:
    """Advance a world as World.step does, by the same kernels called one by one."""
    from polypod.gait.needle import step_count

    for herd in world.herds:
        for c in range(herd.count):
            parts = step_count(dt * herd.state.cycle_rate[c], herd.state.swing_extent[c])
            for _ in range(parts):
                step_creature_in_parts(world, herd, c, dt / parts, clock)
    world.time += dt


def step_creature_in_parts(world: World, herd: Any, c: int, dt: float, clock: PartClock) -> None:
    """Advance one creature: `polypod.world.step_creature` with a clock about each part."""
    from polypod.body.pose import update_tilt, wished_height
    from polypod.body.support import body_rotation, feet_plane
    from polypod.controller.settle import advance_swings, settle_body
    from polypod.controller.steering import move_body
    from polypod.controller.swing import any_off_place, lift_feet, replan_feet, shift_spacing
    from polypod.gait.advance import advance_gait
    from polypod.ik.skeleton import pose_joints
    from polypod.world import note_pose

    state, command = herd.kernel_state, herd.kernel_command
    tables, settings = herd.kernel_tables, herd.kernel_settings
    env, scratch = world.kernel_environment, herd.scratch(0)

    def plan_and_steer() -> Any:
        shift_spacing(c, dt, state, command, tables, settings)
        restless = any_off_place(c, state, tables, settings)
        turn = advance_gait(c, dt, restless, state, command, tables, scratch)
        return turn, move_body(c, dt, state, command, tables, settings)

    def feet() -> None:
        rest = (state, command, tables, settings, env, herd.kernel_plan, scratch)
        replan_feet(c, pose, *rest)
        lift_feet(c, dt, turn, pose, *rest)

    def body() -> None:
        plane = feet_plane(c, state, tables)
        update_tilt(c, dt, plane, state, tables, settings)
        tilt = herd.state.tilt
        lean = body_rotation(pose.heading, tilt[c, 0, 0], tilt[c, 1, 0])
        over = (state, command, tables, settings, env, scratch)
        height = wished_height(c, dt, pose, plane, lean, *over)
        note_pose(c, pose, state)
        settle_body(c, dt, pose, height, state, tables, scratch)
        advance_swings(c, state, scratch, env)

    turn, pose = clock.time(0, 4, plan_and_steer)
    clock.time(1, 2, feet)
    clock.time(2, 7, body)
    clock.time(3, 1, lambda: pose_joints(c, state, tables, scratch))


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
