"""Audits a walk by what no walk may get wrong: read back from the bytes of its GLB.

Where a foot is comes from the file that engines play: its node's world matrix at the keys' float32
times, times the recorded sole offset. What is solid comes from the shapes, not from the maps that
walks are planned with.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.environment.table import EnvironmentTable
from polypod.ik.limits import limit_excess
from polypod.ik.table import build_ik_table
from polypod.report.arrays import conjugate_all, multiply_all, runs_of, widest
from polypod.report.ground import Ground
from polypod.report.joints import frames_of_leg, leg_rows
from polypod.report.played import soles_played
from polypod.report.record import Recording, bones
from polypod.rigs.export import glb_bytes
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.playback import Playback

Floats = NDArray[np.float64]

CALM_TRAVEL = 0.1  # leg lengths a frame: beyond it joints may turn as they must
CHORD_PLACES = 8
SLOW_WINDOW = 0.7  # s: at less than half of the speed for so long a walk is slow


class Finding(NamedTuple):
    """The worst value of one criterion, and where it was met."""

    value: float
    limit: float
    time: float = math.nan
    where: str = ""
    least: bool = False  # the limit is the least allowed, not the most

    @property
    def fails(self) -> bool:
        """Whether the limit is broken; a value that is no number is."""
        return not (self.value >= self.limit if self.least else self.value <= self.limit)


class Played(NamedTuple):
    """What a player of the GLB shows: F frames, K feet, J joints; metres."""

    sole: Floats  # [F, K, 3]
    joint: Floats  # [F, J, 3]
    local: Floats  # [F, J, 3, 3] each joint's rotation relative to its node's parent


def play(recording: Recording) -> Played:
    """Return the walk as read back from the bytes of its GLB."""
    morphology = recording.morphology
    playback = Playback(GltfDocument.from_bytes(glb_bytes(recording), "walk.glb"))
    times = recording.time.astype(np.float32).astype(np.float64)
    world = playback.world_matrices(times)
    sole = soles_played(recording)
    local = playback.local_matrices(times)[:, morphology.joint_node, :3, :3]
    local = local / np.linalg.norm(local, axis=2, keepdims=True)
    return Played(sole, world[:, morphology.joint_node][..., :3, 3], local)


def audit(
    recording: Recording,
    environment: EnvironmentTable,
    commanded: float,
    least_share: float,
) -> dict[str, Finding]:
    """Return every criterion of a walk by name; lengths are shares of the foot's own leg.

    Args:
        recording: the walk.
        environment: where it was walked.
        commanded: speed x time, m.
        least_share: how much of it must be walked.
    """
    played = play(recording)
    ground = Ground(environment, recording)
    walk = _Walk(recording, played)
    return {
        "distance": _distance(walk, commanded, least_share),
        "slip": _slip(walk),
        **_standing(walk, ground),
        **_swinging(walk, ground),
        **_forbidden(walk, ground),
        "limits deg": _limits(walk),
        "turn deg": _turn(walk),
        "bones": _bones(walk),
        "joints": _joints(walk),
    }


class _Walk:
    """A recording beside what plays, and words for places in it."""

    def __init__(self, recording: Recording, played: Played) -> None:
        self.recording = recording
        self.played = played
        self.time = recording.time
        self.leg = recording.morphology.legs.length

    def worst(self, values: Floats, among: NDArray[np.bool_], limit: float) -> Finding:
        """Return the largest of values [F, K] where `among`."""
        if not among.any():
            return Finding(0.0, limit)
        masked = np.where(among, values, -np.inf)
        # argmax takes the first NaN: a foot nowhere is the worst.
        frame, foot = np.unravel_index(int(masked.argmax()), masked.shape)
        return self.finding(float(values[frame, foot]), limit, int(frame), int(foot))

    def finding(self, value: float, limit: float, frame: int, foot: int) -> Finding:
        return Finding(value, limit, float(self.time[frame]), self.foot(foot))

    def foot(self, foot: int) -> str:
        return f"foot {foot} {self.recording.morphology.foot_name[foot]}"


def _distance(walk: _Walk, commanded: float, least_share: float) -> Finding:
    """Return the share of the way that the body got ahead, and where it first lost time."""
    place, time = walk.recording.body_position[:, [0, 2]], walk.time
    share = float(np.linalg.norm(place[-1] - place[0])) / commanded
    speed = commanded / float(time[-1] - time[0])
    window = max(round(SLOW_WINDOW * len(time) / float(time[-1])), 1)
    got = np.linalg.norm(place[window:] - place[:-window], axis=1)
    slow = got < 0.5 * speed * (time[window:] - time[:-window])
    slow[: 2 * window] = False  # it starts from rest
    if not slow.any():
        return Finding(share, least_share, least=True)
    frame = int(slow.argmax())
    # The foot that has stood longest by then is the one that holds the body.
    stood = np.argmax(~walk.recording.foot_stance[frame + window :: -1], axis=0)
    words = f"slow for {slow.mean() * float(time[-1]):.1f} s in all, held by {{}}"
    foot = walk.foot(int(stood.argmax()))
    return Finding(share, least_share, float(time[frame]), words.format(foot), least=True)


def _slip(walk: _Walk) -> Finding:
    """Return the largest distance between two places of a foot in one stance."""
    worst = Finding(0.0, 1e-3)
    for foot, leg in enumerate(walk.leg):
        for start, stop in runs_of(walk.recording.foot_stance[:, foot]):
            slip = widest(walk.played.sole[start:stop, foot]) / float(leg)
            if not slip <= worst.value:
                worst = walk.finding(slip, 1e-3, start, foot)
    return worst


def _standing(walk: _Walk, ground: Ground) -> dict[str, Finding]:
    stance, sole = walk.recording.foot_stance, walk.played.sole
    flat = sole.reshape(-1, 3)
    frame = np.repeat(np.arange(len(stance)), stance.shape[1])
    surface = ground.surface(flat[:, 0], flat[:, 2], frame).reshape(stance.shape)
    inside = ground.penetration(flat, frame).reshape(stance.shape)
    residual = np.linalg.norm(sole - walk.recording.foot_target, axis=2)
    return {
        "off": walk.worst(np.abs(sole[:, :, 1] - surface) / walk.leg, stance, 2e-3),
        "residual": walk.worst(residual / walk.leg, stance, 1e-3),
        # Never inside: but for what the surface's own tolerance lets a sole sink.
        "inside": walk.worst(inside / walk.leg, stance, 1e-3),
    }


def _swinging(walk: _Walk, ground: Ground) -> dict[str, Finding]:
    swing, sole = ~walk.recording.foot_stance, walk.played.sole
    frame = np.repeat(np.arange(len(swing)), swing.shape[1])
    inside = ground.penetration(sole.reshape(-1, 3), frame).reshape(swing.shape)
    residual = np.linalg.norm(sole - walk.recording.foot_target, axis=2) / walk.leg
    most = walk.worst(residual, swing, 1e-2)
    usual = float(np.quantile(residual[swing], 0.999, method="lower")) if swing.any() else 0.0
    return {
        "swing in": walk.worst(inside / walk.leg, swing, 1e-2),
        "swing 99.9": Finding(usual, 1e-3, most.time, most.where),
        "swing res": most,
    }


def _forbidden(walk: _Walk, ground: Ground) -> dict[str, Finding]:
    """Count the stances on forbidden things and the swings over them, by what plays."""
    stances, crossings = Finding(0.0, 0.0), Finding(0.0, 0.0)
    share = np.linspace(0.0, 1.0, CHORD_PLACES, endpoint=False)[:, None]
    recording = walk.recording
    for foot in range(len(walk.leg)):
        sole = walk.played.sole[:, foot]
        for start, stop in runs_of(recording.foot_stance[:, foot]):
            on = int(recording.foot_support[start, foot]) in ground.forbidden
            if on or ground.over_forbidden(sole[start:stop]).any():
                stances = walk.finding(stances.value + 1.0, 0.0, start, foot)
        for start, stop in runs_of(~recording.foot_stance[:, foot]):
            ends = sole[max(start - 1, 0) : stop + 1]
            chords = [a + (b - a) * share for a, b in pairwise(ends)]
            if chords and ground.over_forbidden(np.concatenate(chords)).any():
                found = walk.finding(crossings.value + 1.0, 0.0, start, foot)
                depth, obstacle = _over(ground, np.concatenate(chords))
                words = f"{found.where}, {depth / walk.leg[foot]:.4f} legs over obstacle {obstacle}"
                crossings = found._replace(where=words)
    return {"forb. stands": stances, "forb. swings": crossings}


def _over(ground: Ground, points: Floats) -> tuple[float, int]:
    """Return how far the points come inside a forbidden obstacle's plan outline, m, and which."""
    table, most, which = ground.environment, 0.0, -1
    for index in ground.forbidden_solids:
        side = table.footprint_side[index, : table.footprint_count[index]]
        depth = (side[:, 2] - points[:, [0, 2]] @ side[:, :2].T).min(axis=1).max()
        if depth > most:
            most, which = float(depth), int(table.owner[index])
    return most, which


def _limits(walk: _Walk) -> Finding:
    """Return how far any joint is outside its limits, degrees."""
    recording = walk.recording
    legs = recording.morphology.legs
    ik = build_ik_table(legs)
    excess = np.zeros(recording.foot_stance.shape)
    for leg, count in enumerate(legs.joint_count):
        rows = legs.joint[leg, :count]
        unturned = conjugate_all(frames_of_leg(recording, leg))[:, None]
        turned = multiply_all(unturned, recording.joint_rotation[:, rows])
        for frame in range(len(turned)):
            excess[frame, leg] = limit_excess(ik, leg, turned[frame])
    return walk.worst(np.degrees(excess), np.ones_like(excess, np.bool_), 1e-3)


def _turn(walk: _Walk) -> Finding:
    """Return the largest turn of a joint against its node's parent while its foot is calm."""
    recording, local = walk.recording, walk.played.local
    worst = Finding(0.0, 45.0)
    unturned = np.swapaxes(_matrices(recording.body_rotation), 1, 2)
    for leg, length in enumerate(walk.leg):
        sole = walk.played.sole[:, leg]
        own = np.einsum("fij,fj->fi", unturned, sole - recording.body_position)
        travel = [np.linalg.norm(np.diff(place, axis=0), axis=1) for place in (sole, own)]
        calm = np.minimum(*travel) <= CALM_TRAVEL * float(length)
        for row in leg_rows(recording.morphology.legs, leg):
            trace = np.einsum("fij,fij->f", local[:-1, row], local[1:, row])
            angle = np.degrees(np.arccos(np.clip(0.5 * (trace - 1.0), -1.0, 1.0)))
            angle = np.where(calm, angle, 0.0)
            frame = int(angle.argmax())
            if not angle[frame] <= worst.value:
                found = walk.finding(float(angle[frame]), 45.0, frame + 1, leg)
                name = recording.morphology.joint_name[row]
                worst = found._replace(where=f"{found.where}, joint {name}")
    return worst


def _matrices(rotation: Floats) -> Floats:
    x, y, z, w = np.moveaxis(rotation, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def _bones(walk: _Walk) -> Finding:
    pairs = bones(walk.recording.morphology)
    if not len(pairs):
        return Finding(0.0, 1e-5)
    place = walk.played.joint
    length = np.linalg.norm(place[:, pairs[:, 0]] - place[:, pairs[:, 1]], axis=2)
    spread = np.ptp(length, axis=0) / length.mean(axis=0)
    bone = int(spread.argmax())
    names = walk.recording.morphology.joint_name
    frame = int(np.abs(length[:, bone] - length[0, bone]).argmax())
    where = " to ".join(names[row] for row in pairs[bone])
    return Finding(float(spread[bone]), 1e-5, float(walk.time[frame]), where)


def _joints(walk: _Walk) -> Finding:
    """Return how far joints play from where the record says, of the largest coordinate."""
    recorded = walk.recording.joint_position
    gap = np.linalg.norm(walk.played.joint - recorded, axis=2)
    frame, row = np.unravel_index(int(gap.argmax()), gap.shape)
    share = float(gap[frame, row]) / float(np.abs(recorded).max())
    name = walk.recording.morphology.joint_name[int(row)]
    return Finding(share, 1e-5, float(walk.time[int(frame)]), f"joint {name}")
