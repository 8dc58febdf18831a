"""A trunk as others see it bends with its spine."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.config import Settings
from polypod.crowd.company import Company
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.world import World


def turning(rig: str, spine: float) -> tuple[Herd, Company]:
    """Return one of two creatures that walks in a tight circle, as the other sees it."""
    morphology = load_rig(rig)
    brisk = 0.25 * math.sqrt(9.81 * float(morphology.legs.length.mean()))
    world = World(threads=1)
    places = [[0.0, 0.0], [50.0, 0.0]]
    herd = world.add(morphology, 2, position=places, speed=brisk, settings=Settings(spine=spine))
    for _ in range(150):
        herd.command.heading = herd.state.heading + 0.8
        world.step(1.0 / 30.0)
    world.look_round()
    return herd, world._company


def off_the_backbone(herd: Herd, company: Company) -> np.ndarray:
    """Return how far the discs' middles are from the line through the spine's joints, in plan.

    In leg lengths. The joints' places are those of the pose that is shown.
    """
    rows = herd.morphology.segments.joint
    joints = herd.state.joint_position[0, rows][:, [0, 2]]
    begin, step = joints[:-1], np.diff(joints, axis=0)
    discs = company.disc[0, : company.discs[0]]
    way = np.maximum((step**2).sum(axis=1), 1e-18)
    share = np.clip(((discs[:, None] - begin) * step).sum(axis=2) / way, 0.0, 1.0)
    gap = np.linalg.norm(discs[:, None] - begin - share[..., None] * step, axis=2)
    return gap.min(axis=1) / herd.tables.leg_length


@pytest.mark.parametrize("rig", ["wolf", "centipede"])
def test_discs_lie_along_the_bent_spine(rig: str) -> None:
    herd, company = turning(rig, 1.0)
    assert company.discs[0] == 4
    gap = off_the_backbone(herd, company)
    # The hindmost may lie behind the spine's first joint.
    assert np.all(gap[1:] < 0.03)
    assert gap[0] < 0.15
    # The row of discs is bent: its ends do not lie along the body's axis.
    heading = herd.state.heading[0]
    out = company.disc[0, :4] - company.origin[0, :2]
    aside = out @ [math.cos(heading), -math.sin(heading)]
    assert np.abs(aside).max() > 0.02 * herd.tables.leg_length


def test_a_rigid_trunk_is_a_straight_row() -> None:
    _, company = turning("wolf", 0.0)
    discs = company.disc[0, : company.discs[0]]
    way = discs[-1] - discs[0]
    aside = (discs - discs[0]) @ [way[1], -way[0]] / np.linalg.norm(way)
    assert np.abs(aside).max() < 1e-9
