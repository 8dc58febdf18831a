"""A walk as one picture: a wide view, then a stride from the side and from above."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image

from polypod.environment.table import EnvironmentTable
from polypod.report import scenery
from polypod.report.arrays import FloatArray
from polypod.report.captions import Caption, draw_captions, round_length, scale_bar
from polypod.report.files import replacing
from polypod.report.raster import ByteImage, Camera, Scene, camera_along, render
from polypod.report.record import Recording
from polypod.report.skin import Flesh, flesh_of, pose
from polypod.report.strides import mean_stride_s

SIDE_ELEVATION = math.radians(9.0)
WIDE_AZIMUTH, WIDE_ELEVATION = math.radians(38.0), math.radians(27.0)
ABOVE = math.radians(90.0)
WIDE_ASPECT = 0.34  # height of the wide view over its width
WIDE_POSES = 3
GAP = 2  # pixels between panels
MARGIN = 1.14  # room around the creature in its panel


@dataclass(frozen=True)
class _Walker:
    """One creature, its surfaces, and what its panels need to know of its size."""

    recording: Recording
    flesh: list[Flesh]
    skin_colour: FloatArray  # [3] for what is drawn where a rig has no surface

    def add(self, scene: Scene, frame: int) -> None:
        """Add the creature as it is in a frame; one without surfaces as its bones."""
        for part in self.flesh:
            scene.add(pose(part, self.recording, frame), part.triangles, part.colour)
        if not self.flesh:
            scenery.add_bones(scene, self.recording, frame, self.skin_colour)

    def points(self, frame: int) -> FloatArray:
        """Return world points [N, 3] that span the creature in a frame."""
        clouds = [self.recording.joint_position[frame], self.recording.foot_position[frame]]
        clouds += [pose(part, self.recording, frame) for part in self.flesh]
        return np.concatenate(clouds)


def write_strip(
    recordings: Recording | Sequence[Recording],
    environment: EnvironmentTable,
    path: str | os.PathLike[str],
    *,
    columns: int = 8,
    width: int = 1920,
    oversampling: int = 2,
) -> None:
    """Write a PNG: a wide view of the walk, then frames from the side and from above.

    The frames are a stride of the first creature in the middle of the walk, evenly spaced; the view
    goes with it. Discs are footprints and ribbons the swing feet's ways, a colour a foot;
    forbidden obstacles are red.

    Args:
        recordings: one walk, or several in the same scene with the same times.
        environment: the scene.
        path: the PNG.
        columns: frames in a row.
        width: of the picture, pixels.
        oversampling: pixels drawn each way for one that is shown.

    Raises:
        SettingError: the folder does not exist or cannot be written to.
    """
    several = [recordings] if isinstance(recordings, Recording) else list(recordings)
    picture = draw_strip(several, environment, columns, width, oversampling)
    with replacing(path) as temporary:
        Image.fromarray(picture).save(temporary, format="PNG")


def draw_strip(
    recordings: list[Recording],
    environment: EnvironmentTable,
    columns: int,
    width: int,
    oversampling: int = 2,
) -> ByteImage:
    """Return the picture [height, width, 3] that `write_strip` writes."""
    frames = stride_frames(recordings[0], columns)
    drawing = _Drawing(_walkers(recordings), environment, frames, width, oversampling)
    rows = [drawing.wide_view()]
    rows += [drawing.row(elevation) for elevation in (SIDE_ELEVATION, ABOVE)]
    gap = np.full((GAP, width, 3), 255, np.uint8)
    pieces = [rows[0]]
    for row in rows[1:]:
        pieces += [gap, row]
    return np.concatenate(pieces)


def draw_side(
    recording: Recording, environment: EnvironmentTable, columns: int, width: int
) -> ByteImage:
    """Return a picture [height, width, 3] of a stride from the side, in so many frames."""
    frames = stride_frames(recording, columns)
    return _Drawing(_walkers([recording]), environment, frames, width, 2).row(SIDE_ELEVATION)


def _walkers(recordings: list[Recording]) -> list[_Walker]:
    colour = np.array([0.35, 0.36, 0.40])
    return [_Walker(one, flesh_of(one.morphology), colour) for one in recordings]


def stride_frames(recording: Recording, count: int) -> list[int]:
    """Return `count` frames, evenly spaced over one stride in the middle of the walk."""
    time = recording.time
    span = min(mean_stride_s(recording) or math.inf, float(time[-1] - time[0]))
    first = 0.5 * (time[0] + time[-1]) - 0.5 * span
    moments = first + span * np.arange(count) / count
    return [int(np.abs(time - moment).argmin()) for moment in moments]


class _Drawing:
    """What all views of one walk share."""

    def __init__(
        self,
        walkers: list[_Walker],
        environment: EnvironmentTable,
        frames: list[int],
        width: int,
        oversampling: int,
    ) -> None:
        self.walkers = walkers
        self.environment = environment
        self.frames = frames
        self.width = width
        self.oversampling = oversampling
        self.leader = walkers[0].recording
        self.obstacles = scenery.Obstacles(environment, self.leader.obstacle_position.shape[1])
        self.heading = _heading(self.leader, frames)
        self.leg_length = float(self.leader.morphology.legs.length.mean())
        # From where the body is, so that hills do not widen the panels.
        self.spread = np.concatenate(
            [walkers[0].points(f) - self.leader.body_position[f] for f in frames]
        )

    def row(self, elevation: float) -> ByteImage:
        """Return a row of panels, one a frame, all at the same scale."""
        columns = len(self.frames)
        panel_width = (self.width - GAP * (columns - 1)) // columns
        probe = camera_along(self.heading, 0.0, elevation, np.zeros(3), 1.0, (1, 1))
        across, upward = self.spread @ probe.right, self.spread @ probe.up
        scale = panel_width / (MARGIN * float(np.ptp(across)))
        room = 1.35 if elevation < ABOVE else MARGIN
        height = int(
            np.clip(scale * room * float(np.ptp(upward)), 0.45 * panel_width, 1.6 * panel_width)
        )
        # The creature's own middle in the panel, the same in every frame: the view goes with it.
        middle = 0.5 * (across.min() + across.max()) * probe.right
        lowest, highest = upward.min(), upward.max()
        middle = middle + (0.5 * (lowest + highest)) * probe.up
        height_smooth = _smoothed_heights(self.leader, self.frames)
        panels = []
        for frame, level in zip(self.frames, height_smooth, strict=True):
            centre = self.leader.body_position[frame] + middle
            centre[1] += level - self.leader.body_position[frame, 1]
            size = (panel_width, height)
            camera = camera_along(self.heading, 0.0, elevation, centre, scale, size)
            image = self._render(camera, [frame], frame, elevation)
            seconds = f"{self.leader.time[frame]:.2f} s"
            draw_captions(image, [Caption(seconds, 8, height - 8, anchor="ls")])
            panels.append(image)
        title = "from the side" if elevation < ABOVE else "from above"
        draw_captions(panels[0], [Caption(title, 8, 8, anchor="la", strong=True)])
        scale_bar(panels[-1], scale)
        # What does not divide evenly is paper at the right.
        row = np.full((height, self.width, 3), 255, np.uint8)
        for column, panel in enumerate(panels):
            left = column * (panel_width + GAP)
            row[:, left : left + panel_width] = panel
        return row

    def wide_view(self) -> ByteImage:
        """Return the walk from three quarters, with the creature at a few moments of it."""
        size = (self.width, round(WIDE_ASPECT * self.width))
        probe = camera_along(self.heading, WIDE_AZIMUTH, WIDE_ELEVATION, np.zeros(3), 1.0, (1, 1))
        poses = self._wide_poses(probe)
        seen = np.concatenate([walker.points(frame) for walker in self.walkers for frame in poses])
        corners = np.stack([seen @ probe.right, seen @ probe.up], axis=1)
        least, most = corners.min(axis=0), corners.max(axis=0)
        scale = min(
            size[0] / (1.22 * (most[0] - least[0])), size[1] / (1.30 * (most[1] - least[1]))
        )
        middle = 0.5 * (least + most)
        depth = float((seen @ probe.toward).mean())
        centre = middle[0] * probe.right + middle[1] * probe.up + depth * probe.toward
        camera = probe._replace(
            centre=centre, pixels_per_metre=scale, width=size[0], height=size[1]
        )
        image = self._render(camera, poses, len(self.leader.time) - 1, WIDE_ELEVATION)
        names = self.leader.morphology.foot_name
        colours = scenery.foot_colours(len(names))
        captions = [Caption(self.leader.morphology.name, 16, 14, anchor="la", strong=True)]
        moments = ", ".join(f"{self.leader.time[frame]:.1f} s" for frame in poses)
        captions.append(Caption(f"at {moments}", 16, 38, anchor="la"))
        if len(names) <= 10:
            left = 16.0
            for name, colour in zip(names, colours, strict=True):
                captions.append(Caption(name, left, size[1] - 14, anchor="ls", colour=colour))
                left += captions[-1].width() + 16.0
        draw_captions(image, captions)
        scale_bar(image, scale)
        return image

    def _wide_poses(self, probe: Camera) -> list[int]:
        """Return up to three frames about the middle whose creatures do not hide one another."""
        place = self.leader.body_position @ probe.right
        size = 1.02 * float(np.ptp(self.spread @ probe.right))
        middle = self.frames[len(self.frames) // 2]
        before = np.flatnonzero(place[:middle] <= place[middle] - size)
        after = middle + np.flatnonzero(place[middle:] >= place[middle] + size)
        poses = [middle]
        if WIDE_POSES >= 3 and before.size and after.size:
            poses = [int(before[-1]), middle, int(after[0])]
        return poses

    def _render(self, camera: Camera, poses: list[int], latest: int, elevation: float) -> ByteImage:
        """Draw creatures in the frames `poses`, and their marks up to the frame `latest`."""
        pixel = 1.0 / camera.pixels_per_metre
        half_width = 0.5 * camera.width * pixel
        # A level view sees far along the ground: end it softly before the horizon.
        depth_reach = 0.5 * camera.height * pixel / max(math.sin(elevation), 0.12) + half_width
        reach = math.hypot(half_width, min(depth_reach, 4.0 * half_width)) + 2.0 * self.leg_length
        scene = Scene()
        scenery.add_ground(scene, self.environment, camera.centre, reach)
        cut = elevation < math.radians(20.0)
        near = self._near_obstacles(camera, poses[0], reach, cut)
        self.obstacles.add(scene, self.leader, poses[0], near)
        for walker in self.walkers:
            for frame in poses:
                walker.add(scene, frame)
            scenery.add_footprints(
                scene, walker.recording, max(0.028 * self.leg_length, 2.2 * pixel), 0, latest
            )
            stride = 1.2 * (mean_stride_s(walker.recording) or 0.0)
            earliest = int(
                np.searchsorted(walker.recording.time, walker.recording.time[poses[0]] - stride)
            )
            end = latest if len(poses) == 1 else poses[-1]
            width = max(0.010 * self.leg_length, 1.3 * pixel)
            scenery.add_swings(scene, walker.recording, camera.toward, width, earliest, end)
        nearest = (
            -1.02 * self._toward_viewer(camera) if elevation < math.radians(20.0) else -math.inf
        )
        fade = (0.55 * reach, 0.95 * reach) if elevation < ABOVE else (math.inf, math.inf)
        return render(
            scene,
            camera,
            grid=round_length(0.5 * self.leg_length),
            fade=fade,
            nearest=nearest,
            oversampling=self.oversampling,
        )

    def _toward_viewer(self, camera: Camera) -> float:
        """Return how far the creature reaches toward the viewer from the view's centre, m."""
        return float((self.spread @ camera.toward).max()) + 0.3 * self.leg_length

    def _near_obstacles(self, camera: Camera, frame: int, reach: float, cut: bool) -> np.ndarray:
        """Return [S] which solids to draw: near ones, and none that would hide the creature."""
        bounds = self.environment.bounds
        centre = self.obstacles.centres(self.leader, frame)
        size = 0.5 * np.linalg.norm(bounds[:, 3:] - bounds[:, :3], axis=1)
        offset = centre - camera.centre
        shown: np.ndarray = np.linalg.norm(offset[:, [0, 2]], axis=1) - size < reach
        if cut:
            level = camera.toward * np.array([1.0, 0.0, 1.0])
            shown &= offset @ level < self._toward_viewer(camera)
        return shown


def _heading(recording: Recording, frames: list[int]) -> FloatArray:
    """Return the unit direction [3] in the ground plane in which the frames' walk goes."""
    way = recording.body_position[frames[-1]] - recording.body_position[frames[0]]
    way = way * np.array([1.0, 0.0, 1.0])
    size = float(np.linalg.norm(way))
    if size > 0.05 * float(recording.morphology.legs.length.mean()):
        return np.asarray(way / size)
    # It stands: from back to front.
    x, y, z, w = recording.body_rotation[frames[0]]
    ahead = np.array([2.0 * (x * z + w * y), 0.0, 1.0 - 2.0 * (x * x + y * y)])
    return np.asarray(ahead / max(float(np.linalg.norm(ahead)), 1e-12))


def _smoothed_heights(recording: Recording, frames: list[int]) -> list[float]:
    """Return the height of the view in each frame: a straight line, so that bounce is seen."""
    height = recording.body_position[frames, 1]
    if len(set(frames)) < 2:
        return [float(h) for h in height]
    slope, start = np.polyfit(recording.time[frames], height, 1)
    return [float(start + slope * recording.time[frame]) for frame in frames]
