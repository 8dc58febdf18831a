"""All creatures of a world as the others see them: where trunks and legs are as a frame begins.

Everything that a creature knows of others it reads here, so that the order in which they are
stepped, and the number of threads, make no difference. A trunk is a row of discs in plan: one for a
spider's, four for a centipede's, which bend with its spine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.activity import ARRIVED, BLOCKED, STANDING
from polypod.compute import kernel
from polypod.math.quat import load_quat, rotate
from polypod.math.vec3 import Vec3, load_vec3, store_vec3
from polypod.spine.frames import segment_at, segment_frame

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_DISCS = 4
BUCKETS_EACH = 4  # for each creature, that is


class Company(NamedTuple):
    """N creatures with D discs each at most, and M legs; world, metres and seconds."""

    size: IntArray  # [1] creatures: N, or 0 where nobody heeds anybody
    origin: FloatArray  # [N, 3] x, z and heading of the body
    centre: FloatArray  # [N, 2] x, z of the trunk's middle
    velocity: FloatArray  # [N, 2] x, z
    bound: FloatArray  # [N] around trunk and feet
    height: FloatArray  # [N, 2] of the belly and of the back
    goes: IntArray  # [N] 1: it is on its way, and steps aside itself
    discs: IntArray  # [N]
    disc: FloatArray  # [N, D, 2] x, z
    disc_radius: FloatArray  # [N] of the trunk's discs
    feet_room: FloatArray  # [N] how far feet stand out of them
    first_leg: IntArray  # [N + 1]
    leg_sole: FloatArray  # [M, 3] where it stands or will land
    leg_knee: FloatArray  # [M, 3]
    leg_radius: FloatArray  # [M]
    most: FloatArray  # [2] the greatest bound, and speed
    bucket_place: FloatArray  # [3] x, z of the corner of bucket [0, 0]; its side
    bucket_shape: IntArray  # [2] rows (along z), columns (along x)
    bucket_start: IntArray  # [BUCKETS_EACH N + 2]
    bucket_item: IntArray  # [N] creatures, bucket by bucket, in rising order


def make_company(feet: Sequence[int]) -> Company:
    """Return the table for creatures with so many feet each."""
    n, m = len(feet), sum(feet)
    return Company(
        size=np.zeros(1, np.int64),
        origin=np.zeros((n, 3)),
        centre=np.zeros((n, 2)),
        velocity=np.zeros((n, 2)),
        bound=np.zeros(n),
        height=np.zeros((n, 2)),
        goes=np.zeros(n, np.int64),
        discs=np.zeros(n, np.int64),
        disc=np.zeros((n, MOST_DISCS, 2)),
        disc_radius=np.zeros(n),
        feet_room=np.zeros(n),
        first_leg=np.concatenate([[0], np.cumsum(feet)]).astype(np.int64),
        leg_sole=np.zeros((m, 3)),
        leg_knee=np.zeros((m, 3)),
        leg_radius=np.zeros(m),
        most=np.zeros(2),
        bucket_place=np.zeros(3),
        bucket_shape=np.zeros(2, np.int64),
        bucket_start=np.zeros(BUCKETS_EACH * n + 2, np.int64),
        bucket_item=np.zeros(n, np.int64),
    )


@kernel
def note_creature(
    row: int, c: int, state: Any, command: Any, tables: Any, company: Company
) -> None:
    """Write a creature's row of the company: as it is now, its swinging feet as they will land."""
    position = load_vec3(state.position[c])
    turn = load_quat(state.rotation[c])
    half = tables.body.half_size
    middle = rotate(turn, load_vec3(tables.body.box_centre))
    company.origin[row, 0] = position.x
    company.origin[row, 1] = position.z
    company.origin[row, 2] = state.heading[c]
    company.centre[row, 0] = position.x + middle.x
    company.centre[row, 1] = position.z + middle.z
    course = state.heading[c] + command.travel[c]
    company.velocity[row, 0] = math.sin(course) * state.speed[c]
    company.velocity[row, 1] = math.cos(course) * state.speed[c]
    does = state.activity[c]
    stays = does in (STANDING, ARRIVED, BLOCKED)
    company.goes[row] = 0 if stays or command.speed[c] <= 0.0 else 1
    company.height[row, 0] = position.y - tables.body.thickness
    company.height[row, 1] = position.y + middle.y + half[1]
    along = max(half[0], half[2])
    across = max(min(half[0], half[2]), 1e-9)
    discs = int(min(max(math.floor(along / across + 0.5), 1.0), float(MOST_DISCS)))
    axis = Vec3(1.0, 0.0, 0.0) if half[0] > half[2] else Vec3(0.0, 0.0, 1.0)
    radius = math.hypot(across, along / discs)
    for d in range(discs):
        rest = load_vec3(tables.body.box_centre) + axis * (((2.0 * d + 1.0) / discs - 1.0) * along)
        origin, frame = segment_frame(c, segment_at(rest.z, tables), position, turn, state)
        place = origin + rotate(frame, rest)
        company.disc[row, d, 0] = place.x
        company.disc[row, d, 1] = place.z
    company.discs[row] = discs
    company.disc_radius[row] = radius
    legs = tables.legs
    room = 0.0
    bound = along + radius
    first = company.first_leg[row]
    for k in range(state.swinging.shape[1]):
        stand = load_vec3(legs.sole_stance[k])
        foot = max(legs.foot_half_size[k, 0], legs.foot_half_size[k, 1])
        beside = abs(stand.x) if half[2] >= half[0] else abs(stand.z)
        room = max(room, beside + foot - radius)
        bound = max(bound, math.hypot(stand.x, stand.z) + foot)
        sole = load_vec3(state.foot_target[c, k] if state.swinging[c, k] else state.foot[c, k])
        knee = load_vec3(state.joint_position[c, legs.joint[k, legs.joint_count[k] - 1]])
        store_vec3(company.leg_sole[first + k], sole)
        store_vec3(company.leg_knee[first + k], knee + sole - load_vec3(state.foot_reached[c, k]))
        company.leg_radius[first + k] = foot
    company.feet_room[row] = max(room, 0.0)
    company.bound[row] = bound
    company.most[0] = max(company.most[0], bound)
    company.most[1] = max(company.most[1], abs(state.speed[c]))


@kernel
def note_herd(state: Any, command: Any, tables: Any, company: Company) -> None:
    """Write the rows of a herd's creatures."""
    for c in range(state.member.shape[0]):
        note_creature(state.member[c], c, state, command, tables, company)


@kernel
def list_company(company: Company) -> None:
    """List the creatures in buckets of the plan, in rising order: a counting sort."""
    count = company.centre.shape[0]
    x0 = math.inf
    z0 = math.inf
    x1 = -math.inf
    z1 = -math.inf
    for row in range(count):
        x0 = min(x0, company.centre[row, 0])
        x1 = max(x1, company.centre[row, 0])
        z0 = min(z0, company.centre[row, 1])
        z1 = max(z1, company.centre[row, 1])
    room = BUCKETS_EACH * count
    side = max(2.0 * company.most[0], 1e-9)
    side = max(side, math.sqrt(max((x1 - x0) * (z1 - z0), 0.0) / room))
    side = max(side, max(x1 - x0, z1 - z0) / room)
    while (int((x1 - x0) / side) + 1) * (int((z1 - z0) / side) + 1) > room:
        side *= 1.25
    rows = int((z1 - z0) / side) + 1
    columns = int((x1 - x0) / side) + 1
    company.bucket_place[0] = x0
    company.bucket_place[1] = z0
    company.bucket_place[2] = side
    company.bucket_shape[0] = rows
    company.bucket_shape[1] = columns
    start = company.bucket_start
    for bucket in range(rows * columns + 1):
        start[bucket] = 0
    for row in range(count):
        start[bucket_of(company, row) + 1] += 1
    for bucket in range(rows * columns):
        start[bucket + 1] += start[bucket]
    # Each start moves to its bucket's end, and back as creatures are taken from the end.
    for bucket in range(rows * columns):
        start[bucket] = start[bucket + 1]
    for back in range(count):
        row = count - 1 - back
        bucket = bucket_of(company, row)
        start[bucket] -= 1
        company.bucket_item[start[bucket]] = row
    company.size[0] = count


@kernel
def bucket_of(company: Company, row: int) -> int:
    """Return the bucket of a creature."""
    side = company.bucket_place[2]
    column = int((company.centre[row, 0] - company.bucket_place[0]) / side)
    line = int((company.centre[row, 1] - company.bucket_place[1]) / side)
    return int(line * company.bucket_shape[1] + column)
