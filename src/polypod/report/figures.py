"""How good a walk is, in plain numbers (BIOMECHANICS section 5), against the true geometry.

`_of_leg` is a share of the foot's own leg length; `_share` a share of frames, of time or of what
was asked; other units are in the names. `None` stands for what this walk gives no way to measure.
"""

from __future__ import annotations

import json
import os

from numpy.typing import ArrayLike

from polypod.environment.table import EnvironmentTable
from polypod.report.apart import apart_figures
from polypod.report.arrays import FloatArray
from polypod.report.backbone import backbone_figures
from polypod.report.contact import contact_figures
from polypod.report.files import replacing
from polypod.report.ground import Ground
from polypod.report.joints import joint_figures
from polypod.report.record import Recording
from polypod.report.stances import stance_figures
from polypod.report.strides import stride_figures
from polypod.report.swings import forbidden_figures, swing_figures
from polypod.report.trunk import trunk_figures, way_figures
from polypod.report.waits import wait_figures


def measure(
    recording: Recording,
    environment: EnvironmentTable,
    *,
    commanded_distance_m: float | None = None,
    gait_duty: ArrayLike | None = None,
    gait_phase: ArrayLike | None = None,
    joint_limits: bool = False,
) -> dict[str, object]:
    """Return all figures of a walk.

    Args:
        recording: the walk.
        environment: the scene it was walked in.
        commanded_distance_m: speed times time as asked for.
        gait_duty: [K] the duty factors that the gait asks for.
        gait_phase: [K] touchdowns that the gait asks for, fractions of the cycle.
        joint_limits: also judge every joint's limits in every frame (`joint_limit_excess_deg`),
            which takes many times as long as all the rest.

    Returns:
        Numbers, texts, lists of numbers and None, by name, in the order in which they read best.
    """
    ground = Ground(environment, recording)
    seconds = float(recording.time[-1] - recording.time[0])
    return {
        "frames": len(recording.time),
        "seconds": seconds,
        "leg_length_m": float(recording.morphology.legs.length.mean()),
        **way_figures(recording, commanded_distance_m),
        **wait_figures(recording),
        **stance_figures(recording, ground),
        **contact_figures(recording, ground),
        **swing_figures(recording, ground),
        **forbidden_figures(recording, ground),
        **joint_figures(recording, joint_limits),
        **apart_figures(recording),
        **stride_figures(recording, gait_duty, gait_phase),
        **trunk_figures(recording, ground),
        **backbone_figures(recording),
    }


def measure_played(
    recording: Recording, environment: EnvironmentTable, foot_played: FloatArray
) -> dict[str, object]:
    """Return the stance figures of soles [F, K, 3] read back from a file, names with `played_`.

    A sole as played is its node's world matrix times the record's `foot_offset`.
    """
    figures = stance_figures(recording, Ground(environment, recording), foot_played)
    return {f"played_{name}": value for name, value in figures.items()}


def write_report(figures: dict[str, object], path: str | os.PathLike[str]) -> None:
    """Write figures as JSON.

    Raises:
        SettingError: the folder does not exist or cannot be written to.
    """
    with replacing(path) as temporary:
        text = json.dumps(figures, indent=2, allow_nan=False, ensure_ascii=False)
        temporary.write_text(text + "\n", encoding="utf-8")
