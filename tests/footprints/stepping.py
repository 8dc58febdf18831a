"""A sprawling leg of half a metre that steps forward, and audits of what it is told to do."""

from __future__ import annotations

import math

import numpy as np

from polypod.compute import kernel
from polypod.environment import Environment, Terrain, scatter
from polypod.environment.table import is_forbidden, penetration, surface
from polypod.footprints.plan import make_plan_scratch, plan_step
from polypod.footprints.settings import PlanSettings, StepRequest
from polypod.ik.table import build_ik_table
from polypod.math.quat import from_axis_angle, rotate, store_quat
from polypod.math.vec3 import Vec3, load_vec3, mix, store_vec3
from polypod.morphology.load import load_rig
from polypod.paths.apart import MOMENTS, make_legs_ahead
from polypod.paths.curve import path_point, path_store
from polypod.reference import by_reference

LEG = 0.5
STRIDE = 0.25
SETTINGS = PlanSettings()
LEGS = load_rig("spider").legs
# The leg that stands most squarely beside the body.
MIDDLE = int(np.argmax(LEGS.sole_stance[:, 0]))
SCRATCH = make_plan_scratch(
    SETTINGS, make_legs_ahead(build_ik_table(LEGS), LEGS.section_radius, LEGS.foot_joint)
)


def ask(env, start, preferred, leg=LEG, stride=STRIDE, side=1.0, **changes):
    """Return a request: the hip 0.6 legs inward, half a leg up, half a stride behind the foot."""
    level = 0.5 * (surface(env, start.x, start.z)[0] + surface(env, preferred.x, preferred.z)[0])
    hip = Vec3(preferred.x - 0.6 * leg * side, level + 0.5 * leg, preferred.z - 0.5 * stride)
    ahead = Vec3(0.0, 0.0, stride)
    request = StepRequest(
        start_world=start,
        start_velocity=Vec3(0.0, 0.0, 0.0),
        preferred_world=preferred,
        hip_start=hip + ahead * -0.5,
        hip_touchdown=hip,
        hip_end_of_stance=hip + ahead,
        effector_offset_touchdown=Vec3(0.0, 0.0, 0.0),
        effector_offset_end_of_stance=Vec3(0.0, 0.0, 0.0),
        reach_min=0.15 * leg,
        reach_max=0.97 * leg,
        reach_comfort_max=0.9 * leg,
        leg_length=leg,
        step_height=0.15 * leg,
        foot_half_x=0.02 * leg,
        foot_half_z=0.02 * leg,
        foot_yaw=0.0,
        body_position=hip + Vec3(-0.2 * leg * side, 0.0, 0.0),
        side=Vec3(side, 0.0, 0.0),
        swing_seconds=0.3,
        speed_limit=math.inf,
        search_radius=0.4 * leg,
        other_foot_count=0,
    )
    return request._replace(**changes)


KERNEL_SCRATCH = by_reference(SCRATCH)


def carry_hip(request):
    """Put the body of a spider where its leg, here a middle one, has the request's hips."""
    ahead = SCRATCH.ahead
    # A body that faces +z has its left at +x.
    turn = from_axis_angle(Vec3(0.0, 1.0, 0.0), math.atan2(-request.side.z, request.side.x))
    hip_rest = rotate(turn, load_vec3(ahead.ik.hip_rest[MIDDLE]))
    ahead.own[0] = MIDDLE
    for moment, share in enumerate(MOMENTS):
        hip = mix(request.hip_start, request.hip_touchdown, min(float(share), 1.0))
        for leg in range(len(ahead.ik.hip_rest)):
            store_vec3(ahead.position[moment, leg], hip - hip_rest)
            store_quat(ahead.rotation[moment, leg], turn)


def plan(env, request, settings=SETTINGS):
    """Return whether a pair was found, its score and its path."""
    carry_hip(request)
    path = path_store()
    found, score = plan_step(env, by_reference(settings), KERNEL_SCRATCH, request, path)
    return found, score, path


def sample(path, count=200):
    """Return points along a path [count + 1, 3]."""
    return np.array(
        [
            path_point(path.point, path.tangent, path.fraction, int(path.count[0]), k / count)
            for k in range(count + 1)
        ]
    )


@kernel
def audit(env, path, samples, margin):
    """Return the deepest penetration along a path, and whether it comes near forbidden things."""
    worst = -1e300
    barred = False
    for k in range(samples + 1):
        point = path_point(path.point, path.tangent, path.fraction, path.count[0], k / samples)
        depth, _ = penetration(env, point)
        worst = max(worst, depth)
        barred = barred or is_forbidden(env, point.x, point.z, margin)
    return worst, barred


def crates(seed, forbidden=0.0, count=45):
    """Return the design's field of crates: 2 x 6.5 m, up to 0.3 m wide and 0.18 m high."""
    flat = Terrain.flat()
    boxes = scatter(
        flat,
        count,
        [-1.0, 0.5, 1.0, 7.0],
        [[0.08, 0.04, 0.08], [0.3, 0.18, 0.3]],
        seed,
        forbidden,
    )
    return Environment(flat, boxes).kernel_table


def walk(env, seed, steps, settings=SETTINGS):
    """Walk one foot forward; yield request, found and path. A foot that is held tries wider."""
    random = np.random.default_rng(seed)
    x, z = random.uniform(-0.8, 0.8), random.uniform(0.0, 0.3)
    start = Vec3(x, surface(env, x, z)[0], z)
    for _ in range(steps):
        z += STRIDE
        wanted = Vec3(x + random.uniform(-0.03, 0.03), 0.0, z)
        request = ask(env, start, wanted)
        found, _, path = plan(env, request, settings)
        yield request, found, path
        if not found:
            request = ask(env, start, wanted, search_radius=0.8 * LEG)
            found, _, path = plan(env, request, settings)
            if not found:
                return
        start = Vec3(*path.point[path.count[0] - 1])
