"""When a creature waited, and whether it got where it was to go."""

from __future__ import annotations

import numpy as np

from polypod.activity import Activity
from polypod.report.arrays import runs_of
from polypod.report.record import Recording


def wait_figures(recording: Recording) -> dict[str, object]:
    """Return how long and when it waited, s, and what it did in the end, in a word."""
    time = recording.time
    waits = [
        (float(time[first]), float(time[min(last, len(time) - 1)]))
        for first, last in runs_of(recording.activity == Activity.WAITING)
    ]
    blocked = (recording.activity == Activity.BLOCKED)[:-1]
    return {
        "waiting_s": sum(end - start for start, end in waits),
        "waiting_from_s": [start for start, _ in waits],
        "waiting_until_s": [end for _, end in waits],
        "blocked_s": float(np.diff(time)[blocked].sum()),
        "ended": Activity(int(recording.activity[-1])).name.lower(),
    }
