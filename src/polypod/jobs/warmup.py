"""`polypod warmup`: compile everything now, so that the first walk does not wait."""

from __future__ import annotations

import argparse

from polypod.jobs.rig_options import DEFAULT_RIG
from polypod.jobs.screen import telling_of_compilation

DESCRIPTION = "Compiles all kernels, which the first walk would do otherwise, and keeps them."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """`polypod warmup` has no options."""


def run(given: argparse.Namespace) -> int:
    """Walk a little over crates and judge it: that asks for every kernel."""
    with telling_of_compilation():
        from polypod.cache import kernel_cache_folder
        from polypod.environment.environment import Environment
        from polypod.environment.scattering import scatter
        from polypod.environment.terrain import Terrain
        from polypod.gait.tempo import top_speed
        from polypod.morphology.load import load_rig
        from polypod.recording import record_walk
        from polypod.report.figures import measure
        from polypod.world import World

        ground = Terrain.flat()
        crates = scatter(ground, 3, (-1.0, 0.5, 1.0, 2.0), ((0.1, 0.05, 0.1), (0.2, 0.1, 0.2)), 0)
        environment = Environment(ground, crates)
        world = World(environment, threads=1)
        herd = world.add(load_rig(DEFAULT_RIG), 2, speed=0.5)
        herd.command.set_path([[0.0, 2.0]], 0)
        for recording in record_walk(world, 0.5, 30.0):
            measure(recording, environment.table)
        top_speed(1.0, 0.5, 1.0)
    print(f"all kernels are compiled, in {kernel_cache_folder()}")
    return 0
