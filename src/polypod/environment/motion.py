"""Obstacles that move: where they are at a time, and which buckets list them then."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from polypod.compute import kernel
from polypod.environment.build import MOST_BUCKETS_MOVING
from polypod.environment.convex import FloatArray
from polypod.environment.obstacles import Obstacle
from polypod.environment.table import EnvironmentTable, IntArray

# So far ahead in seconds obstacles are listed where they will be: no swing takes longer.
HORIZON = 1.5


class Tracks(NamedTuple):
    """The ways of M obstacles that move by themselves; P points are padded to the most.

    Each goes straight from point to point and from the last to the first; what has a constant
    velocity has one point, from which it goes for ever.
    """

    obstacle: IntArray  # [M]
    points: IntArray  # [M] how many there are
    point: FloatArray  # [M, P, 3] m, from where the obstacle starts
    direction: FloatArray  # [M, P, 3] from each point to the next, unit
    end: FloatArray  # [M, P] m of way, from the start to the end of each stretch
    speed: FloatArray  # [M] m/s
    turn_rate: FloatArray  # [M] rad/s


def make_tracks(obstacles: Sequence[Obstacle]) -> Tracks:
    """Return the ways of those obstacles that move by themselves."""
    moving = [i for i, obstacle in enumerate(obstacles) if obstacle.moves]
    most = max([1 + len(obstacles[i].path) for i in moving], default=1)
    tracks = Tracks(
        obstacle=np.array(moving, dtype=np.int64),
        points=np.ones(len(moving), np.int64),
        point=np.zeros((len(moving), most, 3)),
        direction=np.zeros((len(moving), most, 3)),
        end=np.full((len(moving), most), np.inf),
        speed=np.zeros(len(moving)),
        turn_rate=np.array([obstacles[i].turn_rate for i in moving], dtype=np.float64),
    )
    for m, i in enumerate(moving):
        obstacle = obstacles[i]
        if not obstacle.path:
            speed = math.hypot(*obstacle.velocity)
            tracks.speed[m] = speed
            if speed > 0.0:
                tracks.direction[m, 0] = np.array(obstacle.velocity) / speed
            continue
        points = np.array([obstacle.position, *obstacle.path])
        legs = np.roll(points, -1, axis=0) - points
        lengths = np.linalg.norm(legs, axis=1)
        real = lengths > 0.0
        if not real.any():
            continue
        count = int(real.sum())
        tracks.points[m] = count
        tracks.speed[m] = obstacle.speed
        tracks.point[m, :count] = (points - points[0])[real]
        tracks.direction[m, :count] = legs[real] / lengths[real, None]
        tracks.end[m, :count] = np.cumsum(lengths[real])
    return tracks


@kernel
def move_obstacles(env: EnvironmentTable, tracks: Tracks, time: float) -> None:
    """Put what moves by itself where it is at a time, seconds from the start, and list it there."""
    for m in range(tracks.obstacle.shape[0]):
        o = tracks.obstacle[m]
        along = tracks.speed[m] * time
        last = tracks.points[m] - 1
        if tracks.end[m, last] < math.inf:
            along = along % tracks.end[m, last]
        leg = 0
        while leg < last and along >= tracks.end[m, leg]:
            leg += 1
        after = leg + 1 if leg < last else 0
        gone = along - (tracks.end[m, leg - 1] if leg > 0 else 0.0)
        for axis in range(3):
            env.shift[o, axis] = tracks.point[m, leg, axis] + tracks.direction[m, leg, axis] * gone
            env.velocity[o, axis] = tracks.direction[m, leg, axis] * tracks.speed[m]
            env.next_velocity[o, axis] = tracks.direction[m, after, axis] * tracks.speed[m]
        if tracks.speed[m] > 0.0:
            env.turn_in[o] = (tracks.end[m, leg] - along) / tracks.speed[m]
        env.yaw[o] = tracks.turn_rate[m] * time
        env.yaw_rate[o] = tracks.turn_rate[m]
    list_obstacles(env)


@kernel
def list_obstacles(env: EnvironmentTable) -> None:
    """Write `swept` and the buckets for where all solids are now and within the horizon."""
    count = env.bounds.shape[0]
    x0 = math.inf
    z0 = math.inf
    x1 = -math.inf
    z1 = -math.inf
    for o in range(count):
        i = env.owner[o]
        turns = env.yaw[i] != 0.0 or env.yaw_rate[i] != 0.0
        for axis in range(3):
            before = min(HORIZON, env.turn_in[i])
            turn = env.velocity[i, axis] * before
            end = turn + env.next_velocity[i, axis] * (HORIZON - before)
            low = env.shift[i, axis] + min(turn, end, 0.0)
            high = env.shift[i, axis] + max(turn, end, 0.0)
            least = env.bounds[o, axis]
            greatest = env.bounds[o, 3 + axis]
            if turns and axis != 1:
                # All the way round: in a few frames it may be anywhere there.
                least = env.pivot[i, axis] - env.radius[o]
                greatest = env.pivot[i, axis] + env.radius[o]
            env.swept[o, axis] = least + low
            env.swept[o, 3 + axis] = greatest + high
        x0 = min(x0, env.swept[o, 0])
        z0 = min(z0, env.swept[o, 2])
        x1 = max(x1, env.swept[o, 3])
        z1 = max(z1, env.swept[o, 5])
    side = max(math.sqrt((x1 - x0) * (z1 - z0) / MOST_BUCKETS_MOVING), 1e-6)
    side = max(side, max(x1 - x0, z1 - z0) / MOST_BUCKETS_MOVING)
    while True:
        rows = int((z1 - z0) / side) + 1
        columns = int((x1 - x0) / side) + 1
        listed = 0
        for o in range(count):
            env.bucket_range[o, 0] = int((env.swept[o, 2] - z0) / side)
            env.bucket_range[o, 1] = int((env.swept[o, 0] - x0) / side)
            env.bucket_range[o, 2] = int((env.swept[o, 5] - z0) / side)
            env.bucket_range[o, 3] = int((env.swept[o, 3] - x0) / side)
            listed += (env.bucket_range[o, 2] - env.bucket_range[o, 0] + 1) * (
                env.bucket_range[o, 3] - env.bucket_range[o, 1] + 1
            )
        if listed <= env.bucket_item.shape[0] and rows * columns <= MOST_BUCKETS_MOVING:
            break
        side *= 1.25
    env.bucket_place[0] = x0
    env.bucket_place[1] = z0
    env.bucket_place[2] = side
    env.bucket_shape[0] = rows
    env.bucket_shape[1] = columns
    fill_buckets(env, rows * columns)


@kernel
def fill_buckets(env: EnvironmentTable, buckets: int) -> None:
    """List every solid in the buckets of its range, in rising order: a counting sort."""
    columns = env.bucket_shape[1]
    start = env.bucket_start
    for bucket in range(buckets + 1):
        start[bucket] = 0
    for o in range(env.bounds.shape[0]):
        for row in range(env.bucket_range[o, 0], env.bucket_range[o, 2] + 1):
            for column in range(env.bucket_range[o, 1], env.bucket_range[o, 3] + 1):
                start[row * columns + column] += 1
    total = 0
    for bucket in range(buckets):
        total += start[bucket]
        start[bucket] = total
    start[buckets] = total
    # From the end, each bucket's start moves down to its place.
    for back in range(env.bounds.shape[0]):
        o = env.bounds.shape[0] - 1 - back
        for row in range(env.bucket_range[o, 0], env.bucket_range[o, 2] + 1):
            for column in range(env.bucket_range[o, 1], env.bucket_range[o, 3] + 1):
                bucket = row * columns + column
                start[bucket] -= 1
                env.bucket_item[start[bucket]] = o
