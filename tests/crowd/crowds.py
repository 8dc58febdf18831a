"""Crowds, and what is measured of them by the bodies' own boxes and feet, apart from what they see.

Lengths in leg lengths.
"""

from __future__ import annotations

import math

import numpy as np

from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.world import World

FPS = 30.0


def crowd(rig: str, starts, goals, *, threads=1, place=None, personal_space=1.0) -> World:
    """Return a world of creatures that go from starts [N, 2] to goals [N, 2], x and z."""
    morphology = load_rig(rig)
    leg = float(morphology.legs.length.mean())
    starts, goals = np.array(starts, float) * leg, np.array(goals, float) * leg
    way = goals - starts
    world = World(place or Environment(), threads=threads)
    herd = world.add(
        morphology,
        len(starts),
        position=starts,
        heading=np.arctan2(way[:, 0], way[:, 1]),
        speed=0.25 * math.sqrt(9.81 * leg),
        settings=Settings(personal_space=personal_space),
    )
    for c, goal in enumerate(goals):
        herd.command.set_path([goal], c)
    return world


def spines(herd: Herd) -> np.ndarray:
    """Return the ends [C, 2, 2] of the middle lines of the trunks, x and z, m."""
    half = herd.tables.body.half_size
    inner = max(half[2] - half[0], 0.0)
    heading = herd.state.heading
    along = np.stack([np.sin(heading), np.cos(heading)], axis=1)
    centre = herd.state.position[:, [0, 2]] + along * herd.tables.body.box_centre[2]
    return np.stack([centre - along * inner, centre + along * inner], axis=1)


def distance_to_lines(points: np.ndarray, lines: np.ndarray) -> np.ndarray:
    """Return the distances [P, L] of points [P, 2] to segments [L, 2, 2]."""
    a, step = lines[:, 0], lines[:, 1] - lines[:, 0]
    square = np.maximum((step**2).sum(axis=1), 1e-18)
    share = np.clip(((points[:, None] - a) * step).sum(axis=2) / square, 0.0, 1.0)
    return np.linalg.norm(points[:, None] - a - share[..., None] * step, axis=2)


def trunk_gap(herd: Herd) -> float:
    """Return the least distance between two trunks, round as their width; below 0 they overlap."""
    lines, half = spines(herd), herd.tables.body.half_size
    along = np.linspace(0.0, 1.0, 9)[:, None]
    points = (lines[:, None, 0] + (lines[:, 1] - lines[:, 0])[:, None] * along).reshape(-1, 2)
    gap = distance_to_lines(points, lines)
    gap[np.repeat(np.arange(len(lines)), 9)[:, None] == np.arange(len(lines))] = np.inf
    return float(gap.min() - 2.0 * min(half[0], half[2])) / herd.tables.leg_length


def feet_gap(herd: Herd) -> float:
    """Return the least distance in plan from a foot to another creature's trunk."""
    lines, half = spines(herd), herd.tables.body.half_size
    feet = herd.state.foot_reached[..., [0, 2]]
    gap = distance_to_lines(feet.reshape(-1, 2), lines)
    gap[np.repeat(np.arange(len(lines)), feet.shape[1])[:, None] == np.arange(len(lines))] = np.inf
    return float(gap.min() - min(half[0], half[2])) / herd.tables.leg_length


def soles_gap(herd: Herd) -> float:
    """Return the least distance between standing feet of two creatures, less both feet's halves."""
    stands = ~herd.state.swinging
    owner = np.nonzero(stands)[0]
    feet = herd.state.foot_reached[stands][:, [0, 2]]
    gap = np.linalg.norm(feet[:, None] - feet, axis=2)
    gap[owner[:, None] == owner] = np.inf
    foot = float(herd.tables.legs.foot_half_size.max())
    return float(gap.min() - 2.0 * foot) / herd.tables.leg_length


def far_from_goal(herd: Herd) -> np.ndarray:
    """Return how far each is from its goal."""
    goal = herd.command.arrays.waypoints[:, 0]
    return np.linalg.norm(herd.state.position[:, [0, 2]] - goal, axis=1) / herd.tables.leg_length
