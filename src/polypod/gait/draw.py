"""Gaits to look at: disks, footfalls and the body's motion, as a picture and as text."""

from __future__ import annotations

import io
import math
import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from polypod.gait.files import write_whole
from polypod.gait.orbit import GRAVITY, Orbit, orbit_of, vault_of
from polypod.gait.pattern import Gait

SWING_COLOUR = "#e8833a"
STANCE_COLOUR = "#2f4b6e"
NEEDLE_COLOUR = "#b01030"
DISKS_A_ROW = 8
BAR_CELLS = 48
SAMPLES_A_CYCLE = 240


def draw_gait(
    gait: Gait,
    path: str | os.PathLike[str],
    needle: float = 0.0,
    foot_name: Sequence[str] = (),
    orbit: Orbit | None = None,
) -> None:
    """Draw a gait to a PNG: disks (P1 Figure 8), footfalls, and the body's motion (P2 Figure 11).

    Heights and forces are shown over two cycles, the body's and those of each foot's own particle.

    Args:
        gait: the gait.
        path: the PNG to write.
        needle: phase at which the needle is drawn.
        foot_name: [K] names of the feet; numbers where omitted.
        orbit: the motion; omitted: in units of g T^2 for any size, upright but for arthropods'.

    Raises:
        GaitError: the file cannot be written.
    """
    from matplotlib.figure import Figure

    names = _names(gait, foot_name)
    rows = math.ceil(gait.foot_count / DISKS_A_ROW)
    columns = min(gait.foot_count, DISKS_A_ROW)
    diagram = 0.22 * gait.foot_count + 0.9
    figure = Figure(figsize=(9.0, 1.45 * rows + diagram + 5.1), layout="constrained")
    figure.suptitle(_headline(gait), fontsize=10)
    halves = figure.add_gridspec(2, 1, height_ratios=(1.45 * rows, diagram + 4.6))
    above, below = figure.add_subfigure(halves[0]), figure.add_subfigure(halves[1])
    disks = above.subplots(rows, columns, squeeze=False)
    for place, axes in enumerate(disks.flat):
        axes.set_aspect("equal")
        axes.axis("off")
        if place < gait.foot_count:
            _draw_disk(axes, gait, place, needle, names[place])
    bars, down, *motion = below.subplots(4, 1, sharex=True, height_ratios=(diagram, 1.0, 1.8, 1.4))
    _draw_footfalls(bars, gait, names)
    _draw_feet_down(down, gait)
    _draw_motion(motion, gait, orbit)
    for axes in (bars, down, *motion):
        axes.axvline(needle, color=NEEDLE_COLOUR, linewidth=1.2)
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=110)
    write_whole(path, picture.getvalue())


def describe(gait: Gait, foot_name: Sequence[str] = ()) -> str:
    """Return a gait as text: one bar a foot over a cycle ('#' stands, '.' swings), and its numbers.

    A bar's cell shows the middle of its share of the cycle.
    """
    names = _names(gait, foot_name)
    width = max(len(name) for name in names)
    cells = (np.arange(BAR_CELLS) + 0.5) / BAR_CELLS
    lines = [_headline(gait), ""]
    lines.append(f"{'':{width}}  {'0':<{BAR_CELLS // 2}}{'.5':<{BAR_CELLS // 2}}1  touchdown  duty")
    for k in range(gait.foot_count):
        inside = np.mod(cells - gait.swing_start[k], 1.0) < gait.swing_extent[k]
        bar = "".join(np.where(inside, ".", "#"))
        touchdown, duty = gait.touchdown[k], 1.0 - gait.swing_extent[k]
        lines.append(f"{names[k]:{width}} |{bar}|  {touchdown:9.3f} {duty:5.3f}")
    lines.append("")
    lines.append(
        f"feet down: {gait.minimum_feet_down} to {gait.maximum_feet_down} of {gait.foot_count}, "
        f"{gait.duty_sum:.2f} on the mean; in flight {100.0 * gait.flight_share:.0f} % of the cycle"
    )
    return "\n".join(lines)


def _names(gait: Gait, foot_name: Sequence[str]) -> list[str]:
    if len(foot_name) != gait.foot_count:
        return [f"foot {k}" for k in range(gait.foot_count)]
    return [name or f"foot {k}" for k, name in enumerate(foot_name)]


def _headline(gait: Gait) -> str:
    duty = f"duty {gait.duty:.2f} ({gait.duty_low:.2f} to {gait.duty_high:.2f})"
    period = "" if math.isnan(gait.period) else f", {gait.period:.3g} s a cycle"
    return f"{gait.name}: {gait.family}, {gait.foot_count} feet, {duty}{period}"


def _draw_disk(axes: Any, gait: Gait, foot: int, needle: float, name: str) -> None:
    from matplotlib.patches import Circle, Wedge

    # Phase 0 is up, and the needle turns clockwise.
    start, extent = 360.0 * gait.swing_start[foot], 360.0 * gait.swing_extent[foot]
    axes.add_patch(Circle((0.0, 0.0), 1.0, facecolor="white", edgecolor=STANCE_COLOUR))
    axes.add_patch(
        Wedge((0.0, 0.0), 1.0, 90.0 - start - extent, 90.0 - start, facecolor=SWING_COLOUR)
    )
    angle = 2.0 * math.pi * needle
    axes.plot([0.0, math.sin(angle)], [0.0, math.cos(angle)], color=NEEDLE_COLOUR, linewidth=1.6)
    axes.set_xlim(-1.05, 1.05)
    axes.set_ylim(-1.05, 1.05)
    axes.set_title(name, fontsize=7, pad=2)


def _draw_footfalls(axes: Any, gait: Gait, names: Sequence[str]) -> None:
    for k in range(gait.foot_count):
        stance = 1.0 - gait.swing_extent[k]
        # Two cycles, so that a stance across phase 0 is seen whole.
        spans = [(gait.touchdown[k] + turn, stance) for turn in (-1, 0, 1)]
        axes.broken_barh(spans, (k - 0.36, 0.72), facecolor=STANCE_COLOUR)
    axes.set_yticks(range(gait.foot_count), names, fontsize=7)
    axes.set_ylim(gait.foot_count - 0.4, -0.6)
    axes.set_xlim(0.0, 2.0)
    axes.set_title("stance over two cycles", fontsize=8)


def _draw_feet_down(axes: Any, gait: Gait) -> None:
    from matplotlib.ticker import MaxNLocator

    length, down = gait.support()
    first = min(gait.swing_start.min(), gait.touchdown.min())
    # Three cycles from the one before, of which two are in view.
    edges = first - 1.0 + np.concatenate([[0.0], np.cumsum(np.tile(length, 3))])
    axes.stairs(np.tile(down, 3), edges, baseline=None, color=STANCE_COLOUR)
    axes.set_ylim(-0.3, gait.maximum_feet_down * 1.08 + 0.3)
    axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.set_ylabel("feet down", fontsize=7)
    axes.tick_params(labelsize=7)


def _draw_motion(motion: Sequence[Any], gait: Gait, orbit: Orbit | None) -> None:
    """Draw heights about their mean and forces: the body's thick, the feet's particles' thin."""
    if orbit is None:
        vault = vault_of(gait, upright=gait.family != "arthropod")
        orbit, scale, unit = orbit_of(gait, GRAVITY**-0.5, vault=vault), 1.0, "g T²"
    else:
        scale, unit = 100.0, "cm"
    phase = np.linspace(0.0, 2.0, 2 * SAMPLES_A_CYCLE + 1)
    height, force = motion
    height.plot(phase, scale * orbit.foot_height(phase), color=SWING_COLOUR, linewidth=0.7)
    height.plot(phase, scale * orbit.height(phase), color=STANCE_COLOUR, linewidth=2.0)
    height.set_ylabel(f"height, {unit}", fontsize=7)
    size = scale * orbit.excursion
    height.set_title(
        f"the body (dark), {size:.2g} {unit} up and down, and each foot's own particle", fontsize=8
    )
    force.plot(phase, orbit.foot_force(phase), color=SWING_COLOUR, linewidth=0.7)
    force.plot(phase, orbit.force(phase), color=STANCE_COLOUR, linewidth=2.0)
    force.axhline(1.0, color="#888888", linewidth=0.6)
    force.set_ylabel("force, g", fontsize=7)
    force.set_xlabel("cycles", fontsize=8)
    for axes in motion:
        axes.tick_params(labelsize=7)
