"""Strides from the side beside the body's height and the feet's stances: one look at each gait.

    python benchmarks/strips.py docs/images/strides.png

A gallop, a trot, a slow walk and a spider's run on flat ground, each once it is steady: a stride in
eight frames; below them two strides of the body's height, and when each foot stands.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Any

import numpy as np

from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.arrays import runs_of
from polypod.report.record import Recording
from polypod.report.scenery import foot_colours
from polypod.report.strides import mean_stride_s
from polypod.report.strip import draw_side
from polypod.world import World

FPS = 120.0
SETTLING = 4.0  # s
COLUMNS = 8


@dataclass(frozen=True)
class Shown:
    """A walk to look at; m/s."""

    title: str
    creature: str
    gait: str
    speed: float


WALKS = (
    Shown("rotary gallop, 5 m/s", "wolf", "rotary-gallop", 5.0),
    Shown("trot, 2.2 m/s", "wolf", "trot", 2.2),
    Shown("slow walk, 0.8 m/s", "wolf", "walk", 0.8),
    Shown("spider's run, 1 m/s", "spider", "spider", 1.0),
)


def walked(shown: Shown) -> tuple[Recording, World]:
    """Return two strides or more of a steady walk."""
    world = World(threads=1)
    world.add(load_rig(shown.creature), speed=shown.speed, gait=shown.gait, position=[0.0, 0.0])
    for _ in range(round(SETTLING * FPS)):
        world.step(1.0 / FPS)
    return record_walk(world, 3.0, FPS)[0], world


def draw_heights(axes: Any, recording: Recording) -> None:
    """Draw two strides: the body's height about its mean, and bars where feet stand."""
    span = 2.0 * (mean_stride_s(recording) or 0.5)
    shown = recording.time - recording.time[0] <= span
    time = recording.time[shown] - recording.time[0]
    height = 100.0 * recording.body_position[shown, 1]
    height = height - height.mean()
    low = min(float(height.min()), -0.5)
    most = max(float(height.max()), 0.5)
    step = 0.12 * (most - low)
    colours = foot_colours(recording.foot_stance.shape[1])
    for foot, colour in enumerate(colours):
        for start, stop in runs_of(recording.foot_stance[shown, foot]):
            axes.barh(
                low - step * (foot + 1.5), time[stop - 1] - time[start], left=time[start],
                height=0.7 * step, color=np.clip(colour, 0.0, 1.0), align="center",
            )  # fmt: skip
    axes.plot(time, height, color="black", linewidth=1.6)
    axes.set_xlim(0.0, span)
    axes.set_ylabel("body, cm", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.spines[["top", "right"]].set_visible(False)


def main() -> None:
    """Walk, and draw it all into the file that is named."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(
        2 * len(WALKS), 1, figsize=(11.0, 2.8 * len(WALKS)),
        gridspec_kw={"height_ratios": [0.75, 1.0] * len(WALKS)},
    )  # fmt: skip
    for row, shown in enumerate(WALKS):
        recording, world = walked(shown)
        picture = draw_side(recording, world.environment.table, COLUMNS, 1400)
        axes[2 * row].imshow(picture)
        axes[2 * row].axis("off")
        axes[2 * row].set_title(f"{shown.creature}: {shown.title}", fontsize=10, loc="left")
        draw_heights(axes[2 * row + 1], recording)
    axes[-1].set_xlabel("s", fontsize=8)
    figure.tight_layout()
    figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "strides.png", dpi=90)


if __name__ == "__main__":
    main()
