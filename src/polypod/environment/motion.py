"""Obstacles that move: where they are at a time, and which buckets list them then."""

from __future__ import annotations

import math

import numpy as np

from polypod.compute import kernel
from polypod.environment.build import MOST_BUCKETS_MOVING
from polypod.environment.convex import FloatArray
from polypod.environment.obstacles import Obstacle
from polypod.environment.table import EnvironmentTable

# So far ahead in seconds obstacles are listed where they will be: no swing takes longer.
HORIZON = 1.5


class Track:
    """The way of one obstacle: constant velocity, or round a closed path at constant speed."""

    def __init__(self, obstacle: Obstacle) -> None:
        """Read what the obstacle says of its motion."""
        self.velocity = np.array(obstacle.velocity)
        points = np.array([obstacle.position, *obstacle.path])
        legs = np.roll(points, -1, axis=0) - points
        lengths = np.linalg.norm(legs, axis=1)
        legs, self.lengths = legs[lengths > 0.0], lengths[lengths > 0.0]
        self.starts = (points - points[0])[lengths > 0.0]
        self.directions = legs / self.lengths[:, None] if len(legs) else legs
        self.speed = obstacle.speed

    def at(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return how far [3] it is from its start at a time in seconds, and its velocity [3]."""
        if len(self.lengths) == 0:
            return self.velocity * time, self.velocity
        ends = np.cumsum(self.lengths)
        along = math.fmod(self.speed * time, float(ends[-1]))
        leg = min(int(np.searchsorted(ends, along, side="right")), len(ends) - 1)
        gone = along - (ends[leg] - self.lengths[leg])
        return self.starts[leg] + self.directions[leg] * gone, self.directions[leg] * self.speed


@kernel
def list_obstacles(env: EnvironmentTable) -> None:
    """Write `swept` and the buckets for where all obstacles are now and within the horizon."""
    count = env.bounds.shape[0]
    x0 = math.inf
    z0 = math.inf
    x1 = -math.inf
    z1 = -math.inf
    for o in range(count):
        for axis in range(3):
            way = env.velocity[o, axis] * HORIZON
            env.swept[o, axis] = env.bounds[o, axis] + env.shift[o, axis] + min(way, 0.0)
            env.swept[o, 3 + axis] = env.bounds[o, 3 + axis] + env.shift[o, axis] + max(way, 0.0)
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
    """List every obstacle in the buckets of its range, in rising order: a counting sort."""
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
