"""A walk as curves: footfalls, heights of body and feet, how fast the joints turn."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from polypod.report.arrays import FloatArray, runs_of
from polypod.report.files import replacing
from polypod.report.joints import turns_of_leg
from polypod.report.record import Recording
from polypod.report.scenery import foot_colours


def write_plots(recording: Recording, path: str | os.PathLike[str]) -> None:
    """Write a picture (by suffix: .png, .pdf, .svg) of a walk's curves over time.

    From above: the footfall diagram (bars are stances, one row a foot), the heights of body and
    soles in metres, and for each leg the fastest turn of any joint against its parent, degrees a
    second.

    Raises:
        SettingError: the folder does not exist or cannot be written to.
    """
    # Without a display, and without touching the state that a caller's own plots use.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 8.0), layout="constrained")
    FigureCanvasAgg(figure)
    footfalls, heights, turns = figure.subplots(3, 1, sharex=True)
    colours = foot_colours(len(recording.morphology.foot_name))
    _draw_footfalls(footfalls, recording, colours)
    _draw_heights(heights, recording, colours)
    _draw_turns(turns, recording, colours)
    turns.set_xlabel("time, s")
    figure.suptitle(recording.morphology.name)
    for axes in (footfalls, heights, turns):
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(alpha=0.25)
    with replacing(path) as temporary:
        # No date in the file: equal walks give equal pictures.
        figure.savefig(temporary, dpi=110)


def _draw_footfalls(axes: Any, recording: Recording, colours: list[FloatArray]) -> None:
    time = recording.time
    frame_s = float(np.diff(time).mean()) if len(time) > 1 else 0.0
    names = recording.morphology.foot_name
    for foot, colour in enumerate(colours):
        stances = runs_of(recording.foot_stance[:, foot])
        bars = [(float(time[a]), float(time[b - 1] - time[a]) + frame_s) for a, b in stances]
        axes.broken_barh(bars, (foot - 0.4, 0.8), color=tuple(colour))
    axes.set_yticks(range(len(names)), names, fontsize=8)
    axes.set_title("stances", loc="left", fontsize=10)


def _draw_heights(axes: Any, recording: Recording, colours: list[FloatArray]) -> None:
    for foot, colour in enumerate(colours):
        height = recording.foot_position[:, foot, 1]
        axes.plot(recording.time, height, color=tuple(colour), linewidth=0.8)
    axes.plot(recording.time, recording.body_position[:, 1], color="black", linewidth=1.6)
    axes.set_ylabel("m")
    axes.set_title("height of body (black) and soles", loc="left", fontsize=10)


def _draw_turns(axes: Any, recording: Recording, colours: list[FloatArray]) -> None:
    if len(recording.time) > 1:
        step_s = np.diff(recording.time)
        for leg, colour in enumerate(colours):
            fastest = np.degrees(turns_of_leg(recording, leg).max(axis=1)) / step_s
            axes.plot(recording.time[1:], fastest, color=tuple(colour), linewidth=0.8)
    axes.set_ylabel("degrees / s")
    axes.set_title("fastest turn of a joint against its parent", loc="left", fontsize=10)
