"""The same promises on the legs of real rigs, where the third-party files are at hand."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic_legs import Solver, turns_against_parent

from polypod.ik.limits import limit_excess
from polypod.morphology.load import load_rig

RIGS = {
    "khronos_fox/Fox.glb": 0.7,
    "quaternius/spider.glb": 0.5,
    "quaternius/horse.glb": 2.0,
    "quaternius/triceratops.glb": 3.0,
    "quaternius/mech_george.glb": 4.0,
    "spider_bot/spider_bot_model.gltf": 1.0,
}


@pytest.mark.parametrize("name", RIGS)
def test_a_real_rigs_legs_keep_the_promises(name, shared_rig):
    solver = Solver(load_rig(shared_rig(name), height=RIGS[name]).legs)
    rng = np.random.default_rng(1)
    for leg in range(len(solver.ik.longest)):
        count = int(solver.ik.joint_count[leg])
        length = solver.length(leg)
        assert solver.ik.stance_travel_least[leg] > 0.15 * length
        met = 0
        for target in solver.cycle_box(leg, 150, rng):
            residual, rotation, _ = solver.solve(leg, target)
            assert limit_excess(solver.ik, leg, rotation) < 1e-9
            if not solver.reaches(leg, target):
                continue
            met += 1
            assert residual < 1e-4 * length
            step = rng.normal(size=3)
            beside = target + 0.1 * length * step / np.linalg.norm(step)
            if solver.reaches(leg, beside):
                other = solver.solve(leg, beside)[1]
                turns = turns_against_parent(rotation, other, count)
                assert turns.max() < np.radians(45.0)
        assert met > 70
