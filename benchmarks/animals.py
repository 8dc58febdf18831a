"""Stride and duty factor against speed: what walks here beside what was measured on animals.

    python benchmarks/animals.py docs/images/animals.png

Built-in creatures are scaled to the animal's hip height (the lizard to the length of its leg), walk
over flat ground at each speed in the gait that follows from it, and the footfalls of their records
are measured as an animal's would be.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path

from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.recording import record_walk
from polypod.report.strides import stride_figures
from polypod.tables import make_tables
from polypod.world import World

# What a walk may differ from an animal's.
STRIDE, DUTY = 0.25, 0.06
FPS = 120.0
# Pendulum times of the leg until a walk is steady, and for which it is measured.
SETTLING, MEASURED = 24.0, 16.0


@dataclass(frozen=True)
class Point:
    """What was measured of an animal at a speed: m/s, m, and the mean of its feet."""

    speed: float
    stride: float
    duty: float | None
    source: str


@dataclass(frozen=True)
class Animal:
    """An animal and the built-in creature that stands for it."""

    name: str
    creature: str
    hip_height: float  # m, as the creature stands; NaN: by its leg's length
    leg_length: float  # m
    points: tuple[Point, ...]


def _walking(speed: float, duty: float) -> Point:
    """Return a man's stride (Grieve & Gear 1966, 64.8 V^.57 a minute, V in statures of 1.75 m)."""
    rate = 64.8 * (speed / 1.75) ** 0.57 / 60.0
    return Point(speed, speed / rate, duty, "Grieve & Gear 1966")


def _dog(speed: float, duty: float) -> Point:
    """Return the stride of a cursorial mammal with a hip 0.5 m high (Alexander & Jayes 1983)."""
    froude = speed * speed / (9.81 * 0.5)
    symmetrical = froude < 2.0
    stride = 2.4 * froude**0.34 if symmetrical else 1.9 * froude**0.40
    return Point(speed, 0.5 * stride, duty, "Alexander & Jayes 1983, Hildebrand 1976")


def _iguana(speed: float) -> Point:
    """Return the desert iguana's, between the ends that were measured (Fieler & Jayne 1998)."""
    along = math.log(speed / 0.5) / math.log(3.5 / 0.5)
    stride = 0.133 * (0.394 / 0.133) ** along
    return Point(speed, stride, 0.63 * (0.34 / 0.63) ** along, "Fieler & Jayne 1998")


def _horse(speed: float) -> Point:
    """Return a Thoroughbred's, mean of fore and hind feet (Witte 2006)."""
    along = (speed - 9.0) / 8.0
    return Point(speed, 4.46 + 2.66 * along, 0.276 - 0.072 * along, "Witte 2006")


ANIMALS = (
    Animal(
        "dog", "wolf", 0.5, math.nan,
        (
            _dog(0.8, 0.66), _dog(1.2, 0.60), _dog(1.6, 0.47), _dog(2.2, 0.42), _dog(2.8, 0.38),
            Point(3.31, 1.157, None, "Heglund, Taylor & McMahon 1974, 25 kg, trot to gallop"),
            _dog(5.0, 0.28),
        ),
    ),
    Animal("horse", "wolf", 1.3, math.nan, tuple(_horse(v) for v in (9.0, 11.0, 13.0, 15.0, 17.0))),
    Animal(
        "human", "biped", 0.9, math.nan,
        (
            _walking(0.9, 0.66), _walking(1.2, 0.635), _walking(1.4, 0.62), _walking(1.7, 0.60),
            Point(2.7, 2.03, 0.36, "Karamanidis & Arampatzis 2005"),
            Point(3.0, 2.12, None, "Lieberman 2015"),
            Point(4.0, 2.80, 0.32, "Cavagna 1988"),
        ),
    ),
    Animal(
        "desert iguana", "lizard", math.nan, 0.09,
        tuple(_iguana(v) for v in (0.5, 0.8, 1.2, 2.0, 3.5)),
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Walked:
    """What was measured of a walk; the real speed, m/s."""

    speed: float
    stride: float
    duty: float
    gait: str


def scaled(animal: Animal) -> Morphology:
    """Return the creature at the animal's size."""
    unit = make_tables(load_rig(animal.creature, height=1.0))
    if math.isnan(animal.hip_height):
        return load_rig(animal.creature, height=animal.leg_length / unit.leg_length)
    return load_rig(animal.creature, height=animal.hip_height / unit.hip_height)


def walk(morphology: Morphology, speed: float) -> Walked:
    """Walk a creature at a speed until that is steady, and measure its footfalls."""
    world = World(threads=1)
    herd = world.add(morphology, speed=speed)
    pendulum = herd.tables.pendulum_time
    # Small creatures' frames are shorter: a stance is many of them.
    fps = max(FPS, 40.0 / pendulum)
    for _ in range(round(SETTLING * pendulum * fps)):
        world.step(1.0 / fps)
    recording = record_walk(world, MEASURED * pendulum, fps)[0]
    figures = stride_figures(recording)
    way = recording.body_position[-1] - recording.body_position[0]
    seconds = float(recording.time[-1] - recording.time[0])
    stride, duty = figures["stride_m"], figures["duty"]
    assert isinstance(stride, float)
    assert isinstance(duty, float)
    return Walked(math.hypot(way[0], way[2]) / seconds, stride, duty, herd.gait_name[0])


def main() -> None:
    """Walk, print a table, draw it where a file is named."""
    walks: dict[str, list[Walked]] = {}
    for animal in ANIMALS:
        morphology = scaled(animal)
        walks[animal.name] = []
        for point in animal.points:
            walked = walk(morphology, point.speed)
            walks[animal.name].append(walked)
            stride_error = walked.stride / point.stride - 1.0
            duty_error = math.nan if point.duty is None else walked.duty - point.duty
            off = abs(stride_error) > STRIDE or abs(duty_error) > DUTY
            print(
                f"{animal.name:14} {point.speed:5.2f} m/s  walked {walked.speed:5.2f}  "
                f"stride {walked.stride:6.3f} m {100.0 * stride_error:+4.0f} %  "
                f"duty {walked.duty:.3f} {duty_error:+.3f}  {walked.gait}{'  OFF' if off else ''}",
                flush=True,
            )
    if len(sys.argv) > 1:
        draw(walks, Path(sys.argv[1]))


def draw(walks: dict[str, list[Walked]], path: Path) -> None:
    """Draw walks beside animals: a column for each, stride above duty."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, len(ANIMALS), figsize=(11.0, 5.0), sharex="col")
    for column, animal in enumerate(ANIMALS):
        upper, lower = axes[0, column], axes[1, column]
        speed = [point.speed for point in animal.points]
        stride = [point.stride for point in animal.points]
        upper.fill_between(
            speed, [(1 - STRIDE) * s for s in stride], [(1 + STRIDE) * s for s in stride],
            color="#cdd8df", linewidth=0,
        )  # fmt: skip
        upper.plot(speed, stride, "o", color="#1f5673", markersize=4, label="animal")
        known = [(p.speed, p.duty) for p in animal.points if p.duty is not None]
        lower.fill_between(
            [v for v, _ in known], [d - DUTY for _, d in known], [d + DUTY for _, d in known],
            color="#cdd8df", linewidth=0,
        )  # fmt: skip
        lower.plot([v for v, _ in known], [d for _, d in known], "o", color="#1f5673", markersize=4)
        mine = walks[animal.name]
        upper.plot(
            [w.speed for w in mine], [w.stride for w in mine], "x-", color="#d1495b", label="walked"
        )
        lower.plot([w.speed for w in mine], [w.duty for w in mine], "x-", color="#d1495b")
        upper.set_title(f"{animal.name} ({animal.creature})", fontsize=10)
        upper.set_ylim(bottom=0.0)
        lower.set_ylim(0.0, 0.8)
        lower.set_xlabel("speed, m/s")
        for part in (upper, lower):
            part.grid(alpha=0.3)
            part.spines[["top", "right"]].set_visible(False)
    axes[0, 0].set_ylabel("stride, m")
    axes[1, 0].set_ylabel("duty factor")
    axes[0, 0].legend(fontsize=8, frameon=False)
    figure.tight_layout()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    main()
