"""Compiles what a first walk needs besides planning, in a process of its own beside that walk.

Planning is more than half of all kernels and is asked for first; by the time that it is compiled,
the rest lies in the cache. Numba compiles in one thread of a process only.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any


def start() -> Any:
    """Start it where there is a second core; return the process, or None."""
    from polypod.compute import core_count

    if core_count() < 2 or "NUMBA_DISABLE_JIT" in os.environ:
        return None
    return subprocess.Popen(
        [sys.executable, "-m", "polypod.jobs.compile_rest"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def main() -> None:
    """Call every kernel of a frame but planning, on a creature that stands nowhere yet."""
    from polypod.config import Settings
    from polypod.controller.spawn import stand_body
    from polypod.environment.environment import Environment
    from polypod.environment.terrain import Terrain
    from polypod.frame import begin_frame, drive_creatures, pose_creatures, settle_creatures
    from polypod.gait.library import default_gait
    from polypod.herd import Herd
    from polypod.morphology.load import load_rig
    from polypod.reference import by_reference
    from polypod.world import set_disks

    herd = Herd(load_rig("spider"), 1, Settings())
    legs = herd.tables.legs
    herd.command.set_gait(default_gait(legs.side, legs.row, legs.upright, 0.1))
    set_disks(0, 0.0, herd.kernel_state, herd.kernel_command)
    env = by_reference(Environment(Terrain.flat()).table)
    walker = (herd.kernel_state, herd.kernel_command, herd.kernel_tables, herd.kernel_settings)
    stand_body(0, *walker, env, herd.scratch(0))
    begin_frame(0, 1, 1.0 / 30.0, herd.kernel_state)
    for part in (settle_creatures, drive_creatures, pose_creatures):
        part(0, 1, 0, 1.0 / 30.0, *walker, env, herd.kernel_plan, herd.scratch(0))


if __name__ == "__main__":
    main()
