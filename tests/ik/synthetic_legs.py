"""Legs of many kinds, made of points: no rig file is needed to test inverse kinematics."""

from __future__ import annotations

import numpy as np

from polypod.ik.reach import reach_shift
from polypod.ik.solve import solve_leg
from polypod.ik.table import build_ik_table
from polypod.math.vec3 import Vec3
from polypod.morphology.types import LegTable
from polypod.reference import by_reference


def make_legs(
    chains,
    stance=None,
    upright=True,
    row=None,
    side=None,
    bend_limit=None,
    hip_limit=None,
) -> LegTable:
    """Return legs from lists of points, hip first and effector last; the effector is the sole."""
    count = len(chains)
    most = max(len(chain) - 1 for chain in chains)
    points = np.zeros((count, most + 1, 3))
    joint = np.full((count, most), -1, dtype=np.int64)
    limits = np.full((count, most, 2), np.nan)
    for k, chain in enumerate(chains):
        points[k, : len(chain)] = chain
        joint[k, : len(chain) - 1] = np.arange(len(chain) - 1) + 100 * k
        if bend_limit is not None:
            limits[k, 1 : len(chain) - 1] = bend_limit
    joint_count = np.array([len(chain) - 1 for chain in chains], dtype=np.int64)
    sole = points[np.arange(count), joint_count].copy()
    lengths = [np.linalg.norm(np.diff(np.array(c, float), axis=0), axis=1).sum() for c in chains]
    return LegTable(
        joint_count=joint_count,
        joint=joint,
        foot_joint=np.full(count, -1, dtype=np.int64),
        point_rest=points,
        sole_rest=sole,
        sole_stance=sole.copy() if stance is None else np.array(stance, float),
        length=np.array(lengths),
        foot_half_size=np.zeros((count, 2)),
        foot_behind=np.zeros(count),
        roll_kind=np.zeros(count, np.int64),
        roll_pivot=sole.copy(),
        toe_joint=np.full(count, -1, np.int64),
        section_radius=np.zeros((count, most + 1)),
        weight=np.full(count, 1.0 / count),
        side=np.array(side if side is not None else np.sign(sole[:, 0]), dtype=np.int64),
        row=np.array(row if row is not None else np.zeros(count), dtype=np.int64),
        upright=np.full(count, upright, dtype=np.bool_),
        bend_limit=limits,
        hip_limit=np.tile(np.full(3, np.nan) if hip_limit is None else hip_limit, (count, 1)),
    )


def both_sides(chains):
    """Return the left chains, then their mirror images."""
    mirrored = [[(-x, y, z) for x, y, z in chain] for chain in chains]
    return list(chains) + mirrored


def around(points, headings):
    """Return a chain that leads along +Z, turned to each heading."""
    turned = []
    for h in headings:
        c, s = np.cos(h), np.sin(h)
        turned.append([(x * c + z * s, y, z * c - x * s) for x, y, z in points])
    return turned


def spider() -> LegTable:
    """Return 8 legs of 3 joints: coxa, femur up, tibia down."""
    leg = [(0, 0, 0.05), (0, 0.02, 0.10), (0, 0.16, 0.26), (0, -0.20, 0.42)]
    angles = np.radians([35, 70, 105, 145])
    chains = around(leg, angles)
    return make_legs(both_sides(chains), upright=False, row=[3, 2, 1, 0] * 2)


def beetle() -> LegTable:
    """Return 6 legs of 4 joints with a bent foot, 3 mm long."""
    leg = np.array([(0, 0, 0.3), (0, -0.25, 0.5), (0, 0.6, 1.1), (0, -0.6, 1.7), (0, -1.0, 2.2)])
    chains = around([tuple(p) for p in leg * 1e-3], np.radians([40, 90, 140]))
    return make_legs(both_sides(chains), upright=False, row=[2, 1, 0] * 2)


def wolf() -> LegTable:
    """Return Z-shaped digitigrade hind legs and fore legs straight at rest (extension .999)."""
    hind = [(0.1, 0, -0.4), (0.1, -0.22, -0.28), (0.1, -0.38, -0.48), (0.1, -0.52, -0.42)]
    fore = [(0.1, 0, 0.4), (0.1, -0.25, 0.405), (0.1, -0.48, 0.39)]
    chains = both_sides([hind, fore])
    stance = [c[-1] for c in chains]
    stance = [(x, y + (0.06 if z > 0 else 0.0), z) for x, y, z in stance]
    return make_legs(chains, stance=stance, row=[0, 1, 0, 1])


def horse_fore() -> LegTable:
    """Return hind legs, and fore legs straight at rest whose only hinge lies low: a wrist."""
    hind = [(0.1, 0, -0.4), (0.1, -0.4, -0.3), (0.1, -0.9, -0.4)]
    fore = [(0.1, 0, 0.4), (0.1, -0.6, 0.4), (0.1, -0.9, 0.4)]
    chains = both_sides([hind, fore])
    stance = [(x, y + 0.12, z) for (x, y, z) in (c[-1] for c in chains)]
    return make_legs(chains, stance=stance, row=[0, 1, 0, 1])


def pegs() -> LegTable:
    """Return two stiff legs of one joint."""
    return make_legs(both_sides([[(0.1, 0, 0), (0.12, -0.5, 0)]]))


def human() -> LegTable:
    """Return two legs, all but straight: thigh and shank to the ankle."""
    chains = both_sides([[(0.1, 0.0, 0.0), (0.1, -0.45, 0.01), (0.1, -0.88, -0.01)]])
    return make_legs(chains, stance=[(0.1, -0.80, 0.0), (-0.1, -0.80, 0.0)])


def mech() -> LegTable:
    """Return two zigzag legs of four sections."""
    leg = [(0.8, 0, 0), (0.9, -0.8, 0.9), (0.9, -1.6, -0.5), (0.95, -2.5, 0.4), (0.95, -3.0, 0.1)]
    return make_legs(both_sides([leg]))


def radial_robot() -> LegTable:
    """Return 4 legs of 4 sections, straight and horizontal at rest; the stance is made up."""
    leg = [(0, 0, 0.9), (0, 0, 1.6), (0, 0, 2.9), (0, 0, 4.0), (0, 0, 5.0)]
    headings = np.radians([45, 135, -45, -135])
    stance = around([(0, -1.5, 3.0)], headings)
    chains = around(leg, headings)
    return make_legs(chains, [s[0] for s in stance], upright=False, row=[1, 0, 1, 0])


def lizard() -> LegTable:
    """Return 4 sprawling legs of 2 joints, 2 m long as a dinosaur's would be."""
    leg = [(0.4, 0, 0), (1.3, 0.15, -0.2), (1.5, -0.9, 0.1)]
    chains = both_sides([[(x, y, z - 2) for x, y, z in leg], [(x, y, z + 2) for x, y, z in leg]])
    return make_legs(chains, upright=False, row=[0, 1, 0, 1])


def quadruped_robot() -> LegTable:
    """Return 4 erect legs with a sideways first section, as robots have them."""
    hind = [(0.1, 0, -0.3), (0.2, 0, -0.3), (0.22, -0.2, -0.45), (0.22, -0.5, -0.3)]
    fore = [(x, y, -z) for x, y, z in hind]
    return make_legs(both_sides([hind, fore]), row=[0, 1, 0, 1])


CREATURES = {
    "spider": spider,
    "beetle": beetle,
    "wolf": wolf,
    "horse_fore": horse_fore,
    "human": human,
    "mech": mech,
    "radial_robot": radial_robot,
    "lizard": lizard,
    "quadruped_robot": quadruped_robot,
}


class Solver:
    """Inverse kinematics of some legs, called as the simulation calls it."""

    def __init__(self, legs):
        self.legs = legs
        self.ik = build_ik_table(legs)
        self.kernel_ik = by_reference(self.ik)

    def solve(self, leg, target):
        """Return residual, rotations [M, 4] and points [M + 1, 3] of one leg."""
        most = self.ik.axis.shape[1]
        rotation = np.zeros((most, 4))
        rotation[:, 3] = 1.0
        point = np.zeros((most + 1, 3))
        residual = solve_leg(self.kernel_ik, leg, Vec3(*map(float, target)), rotation, point)
        return residual, rotation, point

    def shift(self, leg, target):
        """Return the least displacement [3] that brings a target within reach."""
        return np.array(reach_shift(self.kernel_ik, leg, Vec3(*map(float, target))))

    def reaches(self, leg, target):
        return not self.shift(leg, target).any()

    def length(self, leg):
        return float(self.ik.chain_length[leg])

    def cycle_box(self, leg, count, rng):
        """Return targets [count, 3] of a cycle: .6 leg lengths of travel, heights +-20 %."""
        spread = np.array([0.3, 0.2, 0.3]) * self.length(leg)
        return self.ik.effector_stance[leg] + rng.uniform(-1, 1, (count, 3)) * spread

    def around_hip(self, leg, count, rng):
        """Return targets [count, 3] all around the hip, some of them out of reach."""
        direction = rng.normal(size=(count, 3))
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        distance = self.length(leg) * 1.1 * rng.uniform(0, 1, count) ** 0.5
        return self.ik.hip_rest[leg] + direction * distance[:, None]


def turns_against_parent(rotation_a, rotation_b, count):
    """Return how far each joint turned against its parent between two poses, rad [count]."""
    parent_a = parent_b = np.array([0.0, 0.0, 0.0, 1.0])
    turns = []
    for a, b in zip(rotation_a[:count], rotation_b[:count], strict=True):
        own_a = product(conjugated(parent_a), a)
        own_b = product(conjugated(parent_b), b)
        change = product(conjugated(own_a), own_b)
        turns.append(2.0 * np.arctan2(np.linalg.norm(change[:3]), abs(change[3])))
        parent_a, parent_b = a, b
    return np.array(turns)


def product(a, b):
    vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] - a[:3] @ b[:3])


def conjugated(q):
    return q * np.array([-1.0, -1.0, -1.0, 1.0])
