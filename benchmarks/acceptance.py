"""Walks every creature over every place and judges each walk by what no walk may get wrong.

    python benchmarks/acceptance.py --rigs spider wolf --places crates forbidden --seeds 3

One row a walk, a mark (!) at each value that is out of bounds, and below a failing row when and
where the worst of each happened. Exit code 1 where a walk fails. Third-party rigs are taken from
the folder POLYPOD_RIGS, and left out, by name, where they are not there.
"""

from __future__ import annotations

import argparse
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from typing import NamedTuple

from audit import Finding, audit
from places import (
    LEAST_SHARE,
    LONG_BACKED,
    PLACES,
    RIGS,
    UNSEEDED,
    Rig,
    default_speed,
    load,
    make_place,
)

from polypod.errors import PolypodError
from polypod.recording import record_walk
from polypod.world import World

# Column heads: criterion, width, factor and digits to show it by.
COLUMNS = {
    "distance": (9, 1.0, 3),
    "slip": (8, 100.0, 4),
    "off": (8, 100.0, 4),
    "residual": (9, 100.0, 4),
    "inside": (8, 100.0, 4),
    "swing in": (9, 100.0, 3),
    "swing 99.9": (11, 100.0, 4),
    "swing res": (10, 100.0, 3),
    "forb. stands": (13, 1.0, 0),
    "forb. swings": (13, 1.0, 0),
    "limits deg": (11, 1.0, 4),
    "turn deg": (9, 1.0, 1),
    "bones": (10, 1e5, 3),
    "joints": (8, 1e5, 3),
}


class Walk(NamedTuple):
    """One walk of the matrix."""

    rig: Rig
    place: str
    seed: int
    seconds: float
    fps: float


class Result(NamedTuple):
    """How a walk went."""

    walk: Walk
    findings: dict[str, Finding]
    words: str  # why there was no walk
    seconds: float  # taken to walk, without the audit

    @property
    def fails(self) -> bool:
        """Whether anything is out of bounds."""
        return bool(self.words) or any(finding.fails for finding in self.findings.values())


def run(walk: Walk) -> Result:
    """Walk and audit."""
    try:
        morphology = load(walk.rig)
        if morphology is None:
            return Result(walk, {}, f"its file {walk.rig.file} is not here", 0.0)
        speed = default_speed(morphology)
        commanded = speed * walk.seconds
        place = make_place(walk.place, morphology, commanded, walk.seed)
        world = World(place, threads=1)
        world.add(morphology, speed=speed, position=[0.0, 0.0])
        began = time.perf_counter()
        recording = record_walk(world, walk.seconds, walk.fps)[0]
        taken = time.perf_counter() - began
    except PolypodError as error:
        return Result(walk, {}, str(error), 0.0)
    least = LEAST_SHARE[walk.place]
    return Result(walk, audit(recording, place.table, commanded, least), "", taken)


def heading() -> str:
    """Return the table's first line."""
    cells = "".join(f"{name:>{width + 1}}" for name, (width, _, _) in COLUMNS.items())
    return f"{'rig':<11}{'place':<10}{'seed':>4}{cells}"


def row(result: Result) -> str:
    """Return one walk's lines."""
    walk = result.walk
    head = f"{walk.rig.name:<11}{walk.place:<10}{walk.seed:>4}"
    if result.words:
        return f"{head}  NO WALK: {result.words}"
    cells = []
    for name, (width, factor, digits) in COLUMNS.items():
        finding = result.findings[name]
        cells.append(f"{finding.value * factor:>{width}.{digits}f}{'!' if finding.fails else ' '}")
    lines = [head + "".join(cells)]
    for name, finding in result.findings.items():
        if finding.fails:
            sign = "<" if finding.least else ">"
            place = "" if finding.time != finding.time else f" at t={finding.time:.3f} s"
            lines.append(
                f"      FAIL {name}: {finding.value:.5g} {sign} {finding.limit:g}"
                f"{place} {finding.where}"
            )
    return "\n".join(lines)


def summary(results: list[Result]) -> str:
    """Return how many walks fail, by criterion, by rig and by place."""
    failing = [result for result in results if result.fails]
    lines = [f"{len(results) - len(failing)} of {len(results)} walks keep every limit"]
    if any(result.words for result in results):
        lines.append(f"no walk: {sum(bool(result.words) for result in results)}")
    for name in COLUMNS:
        broken = [r for r in results if r.findings and r.findings[name].fails]
        if broken:
            which = ", ".join(f"{r.walk.rig.name}/{r.walk.place}/{r.walk.seed}" for r in broken)
            lines.append(f"{name}: {len(broken)} ({which})")
    return "\n".join(lines)


def main() -> int:
    """Run the matrix."""
    names = [rig.name for rig in (*RIGS, *LONG_BACKED)]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rigs", nargs="+", default=names, choices=names, metavar="RIG")
    parser.add_argument("--places", nargs="+", default=PLACES, choices=PLACES, metavar="PLACE")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--fps", type=float, default=30.0)
    parser.add_argument("--seeds", type=int, default=3, help="how many, of places with a seed")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    arguments = parser.parse_args()
    walks = [
        Walk(rig, place, seed, arguments.seconds, arguments.fps)
        for rig in (*RIGS, *LONG_BACKED)
        if rig.name in arguments.rigs
        for place in arguments.places
        for seed in range(arguments.first_seed, arguments.first_seed + arguments.seeds)
        if place not in UNSEEDED or seed == arguments.first_seed
    ]
    print("lengths in % of leg length, bones and joints in 1e-5")
    print(heading(), flush=True)
    results = []
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for result in pool.map(run, walks) if arguments.jobs > 1 else map(run, walks):
            results.append(result)
            print(row(result), flush=True)
    print(summary(results))
    return int(any(result.fails for result in results))


if __name__ == "__main__":
    sys.exit(main())
