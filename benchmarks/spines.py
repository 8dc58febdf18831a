"""Spines that bend, measured and drawn: turns with and without, yaw, flexion, and what they cost.

    python benchmarks/spines.py [--picture docs/images/spine.png]

Prints how far the hindmost girdle strays from where the head went in a turn by 90 degrees, with the
spine and without (P2 Figure 13); a lizard's pelvic yaw and a wolf's flexion (BIOMECHANICS 4); and a
frame's time with the spine over that without, of one creature on open ground.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.recording import add_frame
from polypod.report import scenery
from polypod.report.arrays import rotate_all
from polypod.report.backbone import backbone_figures
from polypod.report.raster import Scene, camera_along, render
from polypod.report.record import Recorder, Recording
from polypod.report.skin import flesh_of, pose
from polypod.world import World

Floats = NDArray[np.float64]
FPS = 30
RIGID = Settings(spine=0.0)
# Rigs, their turn's speed as a share of a brisk walk, and its seconds.
TURNERS = (
    ("wolf", 1.0, 5.0),
    ("lizard", 1.0, 5.0),
    ("centaur", 1.0, 5.0),
    ("centipede", 1.0, 9.0),
    ("centipede", 0.5, 14.0),
)
GAITS = (("trot", 1.6), ("canter", 2.5), ("transverse-gallop", 3.0), ("rotary-gallop", 5.0))
SHOWN = (1.2, 1.6, 2.0, 2.4, 2.8, 3.3)  # s, of the picture
PANEL = 300


def brisk(morphology: Morphology) -> float:
    """Return a comfortable walking speed, m/s."""
    return 0.25 * math.sqrt(9.81 * float(morphology.legs.length.mean()))


def turn_by(angle: float) -> Callable[[float, Herd], None]:
    """Return what asks for another heading after a second."""

    def steer(now: float, herd: Herd) -> None:
        if now >= 1.0:
            herd.command.heading = angle

    return steer


def go(
    morphology: Morphology,
    seconds: float,
    steer: Callable[[float, Herd], None] = lambda now, herd: None,
    place: Environment | None = None,
    *,
    speed: float | None = None,
    gait: str | None = None,
    settings: Settings | None = None,
) -> tuple[Recording, World]:
    """Walk and return the record; `steer(time, herd)` before each frame."""
    world = World(place, threads=1)
    pace = brisk(morphology) if speed is None else speed
    herd = world.add(morphology, position=[0.0, 0.0], speed=pace, gait=gait, settings=settings)
    recorder = Recorder(morphology, len(world.environment.obstacles))
    add_frame(recorder, world, herd, 0)
    for frame in range(round(seconds * FPS)):
        steer(frame / FPS, herd)
        world.step(1.0 / FPS)
        world.time = (frame + 1) / FPS
        add_frame(recorder, world, herd, 0)
    return recorder.finish(), world


def place_of(recording: Recording, segment: int, rest: Floats) -> Floats:
    """Return where a point of a segment, at rest in the body frame, is in each frame [F, 3]."""
    morphology = recording.morphology
    row = int(morphology.segments.joint[segment])
    arm = rest - morphology.joint_rest[row]
    return recording.joint_position[:, row] + rotate_all(recording.joint_rotation[:, row], arm)


def distance_to_way(points: Floats, way: Floats) -> float:
    """Return the farthest of points [N, 2] from a polyline [F, 2]."""
    begin, step = way[:-1], np.diff(way, axis=0)
    square = np.maximum(np.einsum("fi,fi->f", step, step), 1e-18)
    most = 0.0
    for point in points:
        share = np.clip(np.einsum("fi,fi->f", point - begin, step) / square, 0.0, 1.0)
        gap = np.linalg.norm(begin + share[:, None] * step - point, axis=1).min()
        most = max(most, float(gap))
    return most


def off_the_track(recording: Recording) -> float:
    """Return how far the hindmost girdle strays from where the head went, body lengths."""
    spine = recording.morphology.segments
    head = place_of(recording, spine.head, spine.pivot_rest[spine.head])[:, [0, 2]]
    hind = place_of(recording, 0, spine.girdle_rest[0])[:, [0, 2]]
    length = float(spine.pivot_rest[-1, 2] - spine.pivot_rest[0, 2])
    came_from = head[:1] - [[0.0, 3.0 * length]]
    return distance_to_way(hind, np.concatenate([came_from, head])) / length


def cost(morphology: Morphology, settings: Settings, frames: int = 240) -> float:
    """Return the processor time of a frame, s, of a creature that weaves on open ground."""
    world = World(threads=1)
    herd = world.add(morphology, speed=0.5 * brisk(morphology), settings=settings)
    spent = 0.0
    for frame in range(frames + 30):
        herd.command.heading = 0.5 * math.sin(frame / 25.0)
        began = time.thread_time()
        world.step(1.0 / FPS)
        spent += time.thread_time() - began if frame >= 30 else 0.0
    return spent / frames


def print_figures() -> None:
    """Print all that is measured."""
    print("turn by 90 degrees: the hind girdle off the head's track, per cent of body length")
    for name, share, seconds in TURNERS:
        morphology = load_rig(name)
        for side, angle in (("left", 0.5 * math.pi), ("right", -0.5 * math.pi)):
            off = []
            for settings in (Settings(), RIGID):
                speed = share * brisk(morphology)
                walked, _ = go(morphology, seconds, turn_by(angle), speed=speed, settings=settings)
                off.append(100.0 * off_the_track(walked))
            print(f"  {name:10} {side:6} bends {off[0]:5.1f}   rigid {off[1]:5.1f}")
    lizard = load_rig("lizard")
    for share in (0.4, 0.7, 1.0, 1.5):
        walked, _ = go(lizard, 5.0, speed=share * brisk(lizard))
        yaw = backbone_figures(walked)["pelvis_yaw_deg"]
        print(f"lizard at {share * brisk(lizard):.2f} m/s: pelvic yaw {yaw:.1f} degrees a stride")
    for gait, speed in GAITS:
        walked, _ = go(load_rig("wolf"), 6.0, speed=speed, gait=gait)
        print(f"wolf, {gait}: flexion {backbone_figures(walked)['spine_flexion_deg']:.1f} degrees")
    for name in dict.fromkeys(name for name, _, _ in TURNERS):
        morphology = load_rig(name)
        times = [min(cost(morphology, s) for _ in range(3)) for s in (Settings(), RIGID)]
        print(f"{name}: a frame takes {times[0] / times[1]:.2f} times as long as without a spine")


def draw(path: str) -> None:
    """Draw a wolf and a lizard in a turn from above: in each pair of rows rigid, then bent."""
    rows = []
    for name in ("wolf", "lizard"):
        morphology = load_rig(name)
        span = 1.25 * float(np.ptp(morphology.joint_rest[:, 2]))
        for settings in (RIGID, Settings()):
            walked, world = go(morphology, 3.5, turn_by(0.5 * math.pi), settings=settings)
            frames = [round(moment * FPS) for moment in SHOWN]
            panels = [_from_above(walked, world, frame, span) for frame in frames]
            rows.append(np.concatenate(panels, axis=1))
    Image.fromarray(np.concatenate(rows)).save(path)


def _from_above(recording: Recording, world: World, frame: int, span: float) -> NDArray[np.uint8]:
    ahead = np.array([0.0, 0.0, 1.0])
    centre, scale = recording.body_position[frame], PANEL / span
    camera = camera_along(ahead, 0.0, math.radians(90.0), centre, scale, (PANEL, PANEL))
    scene = Scene()
    scenery.add_ground(scene, world.environment.table, centre, 2.0 * span)
    for part in flesh_of(recording.morphology):
        scene.add(pose(part, recording, frame), part.triangles, part.colour)
    scenery.add_footprints(scene, recording, 0.015 * span, 0, frame)
    return render(scene, camera, grid=0.25, oversampling=2)


def main() -> None:
    """Measure, or draw where a picture is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", help="a PNG to draw instead of measuring")
    arguments = parser.parse_args()
    if arguments.picture:
        draw(arguments.picture)
    else:
        print_figures()


if __name__ == "__main__":
    main()
