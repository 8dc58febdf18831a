"""Compiles half of what a first walk needs, in a process of its own beside that walk.

Numba compiles in one thread of a process only, and a kernel's callees before the kernel. So this
process compiles first what the walk's own comes to last, and each finds what the other has
compiled in the cache; what both are at in the same moment is compiled twice, to the same code.
"""

from __future__ import annotations

import os
import subprocess
import sys
from functools import partial
from typing import Any, get_type_hints


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
    """Compile the planner's parts in the order in which they are asked for, then the rest."""
    from polypod.config import Settings
    from polypod.controller.spawn import stand_body
    from polypod.environment.environment import Environment
    from polypod.environment.terrain import Terrain
    from polypod.frame import begin_frame, drive_creatures, pose_creatures, settle_creatures
    from polypod.herd import Herd
    from polypod.morphology.load import load_rig
    from polypod.world import set_disks

    env = Environment(Terrain.flat()).kernel_table
    prepare_maps(env)
    # Later than the other process, which finds the kernels of a leg's reach compiled by then.
    herd = Herd(load_rig("spider"), 1, Settings())
    herd.command.follow_speed()
    set_disks(0, 0.0, 0.6, herd.kernel_state, herd.kernel_command, herd.kernel_tables)
    walker = (herd.kernel_state, herd.kernel_command, herd.kernel_tables, herd.kernel_settings)
    everything = (*walker, env, herd.kernel_plan, herd.scratch(0))
    prepare_search(env, herd.kernel_plan, herd.scratch(0))
    drive_creatures(0, 0, 0, 0.0, *everything)
    prepare_feet(*everything)
    for part in (settle_creatures, pose_creatures):
        part(0, 0, 0, 0.0, *everything)
    begin_frame(0, 0, 0.0, herd.kernel_state, herd.kernel_tables)
    # On a creature that stands nowhere yet.
    stand_body(0, False, *walker, env, herd.scratch(0))


def prepare_maps(env: Any) -> None:
    """Compile what draws the maps of obstacles, which needs no creature."""
    from polypod.compute import prepare
    from polypod.environment.elevation import fill_terrain
    from polypod.environment.grown import fill_obstacles
    from polypod.environment.maps import make_local_map
    from polypod.reference import by_reference

    window = by_reference(make_local_map(1))
    prepare(fill_obstacles, env, window, 0.0, 0.0, 0.0, 0.0)
    prepare(fill_terrain, env, window)


def prepare_search(env: Any, settings: Any, scratch: Any) -> None:
    """Compile most of what `footprints.plan` calls; the other process begins with its callers."""
    from numba import types

    from polypod.compute import prepare
    from polypod.footprints.place import judge_place
    from polypod.footprints.plan import fill_window
    from polypod.footprints.settings import StepRequest
    from polypod.math.vec3 import Vec3
    from polypod.paths.scratch import OtherLegs
    from polypod.paths.slices import place_slices, plan_layer, plan_top

    plan = partial(scratch.kind.part, "plan")
    window, grid, lift = plan("window"), plan("grid"), plan("lift")
    place = Vec3(0.0, 0.0, 0.0)
    sample = {Vec3: place, float: 0.0, int: 0, bool: False}
    parts: list[Any] = [sample[kind] for kind in get_type_hints(StepRequest).values()]
    request = StepRequest(*parts)
    named_tuple: Any = types.NamedTuple
    legs = named_tuple((plan("other_a"), plan("other_b"), plan("other_radius")), OtherLegs)
    prepare(judge_place, env, settings, request, legs, plan("ahead"), plan("ground"), 0.0, 0.0)
    prepare(fill_window, env, settings, request, window)
    highest, corner = plan("window", "highest"), plan("window", "place")
    prepare(plan_layer, grid, lift, highest, corner, 0, 0, place, place, 0, 0)
    places = plan("found", "place")
    prepare(place_slices, grid, highest, corner, 0, places, 0, place, 0.0, 0, 0.0)
    prepare(plan_top, highest, corner, 0, plan("lift", "plan"), 0)


def prepare_feet(
    state: Any, command: Any, tables: Any, settings: Any, env: Any, plan: Any, scratch: Any
) -> None:
    """Compile most of what `controller.plan` calls besides the planner."""
    from polypod.body.push import NO_DEFLECTION
    from polypod.compute import prepare
    from polypod.controller.lift import (
        foot_out_of_turn,
        leave_ground,
        note_standing,
        swings_longer,
        way_off,
    )
    from polypod.controller.moving import foot_in_the_way, step_out, way_blocked
    from polypod.controller.steering import PlanPose
    from polypod.controller.swing import take_new_way, way_on
    from polypod.crowd.legs import is_taken
    from polypod.math.vec3 import Vec3

    pose = PlanPose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, NO_DEFLECTION, 0.0)
    prepare(way_blocked, 0, 0, state, tables, env)
    prepare(is_taken, 0, 0, state, tables, scratch)
    place = Vec3(0.0, 0.0, 0.0)
    prepare(way_on, 0, 0, place, 0.0, 0.0, state)
    prepare(take_new_way, 0, 0, 0.0, place, state, settings, scratch)
    prepare(note_standing, 0, 0.0, 0.0, state, tables, settings, scratch)
    prepare(foot_in_the_way, 0, 0, state, tables, env)
    prepare(step_out, 0, 0, state, tables, env)
    prepare(foot_out_of_turn, 0, 0.0, pose, state, tables, scratch)
    prepare(swings_longer, 0, 0, state)
    prepare(way_off, 0, 0, 0.0, pose, state, command, tables, settings)
    prepare(leave_ground, 0, 0, 0.0, state, tables, settings, scratch, env)


if __name__ == "__main__":
    main()
