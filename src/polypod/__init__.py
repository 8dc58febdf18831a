"""Polypod makes any legged creature walk.

Everything below is imported when it is first used, so that `import polypod` and `polypod --help`
are instant.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from polypod.cache import use_kernel_cache

if TYPE_CHECKING:
    from polypod.activity import Activity
    from polypod.config import Settings
    from polypod.environment.environment import Environment
    from polypod.environment.obstacles import Obstacle
    from polypod.environment.scattering import scatter
    from polypod.environment.scene import read_scene
    from polypod.environment.terrain import Terrain
    from polypod.errors import PolypodError
    from polypod.gait.files import read_gait, write_gait
    from polypod.gait.library import make_gait
    from polypod.gait.pattern import Gait
    from polypod.gait.validation import GaitCheck, check_gait
    from polypod.morphology.load import load_rig
    from polypod.recording import record_walk
    from polypod.report.figures import measure
    from polypod.report.record import read_record, write_record
    from polypod.report.strip import write_strip
    from polypod.rigs.export import write_glb
    from polypod.world import World

__version__ = "0.1.0"

use_kernel_cache()

_HOMES = {
    "Activity": "polypod.activity",
    "Environment": "polypod.environment.environment",
    "Gait": "polypod.gait.pattern",
    "GaitCheck": "polypod.gait.validation",
    "Obstacle": "polypod.environment.obstacles",
    "PolypodError": "polypod.errors",
    "Settings": "polypod.config",
    "Terrain": "polypod.environment.terrain",
    "World": "polypod.world",
    "check_gait": "polypod.gait.validation",
    "load_rig": "polypod.morphology.load",
    "make_gait": "polypod.gait.library",
    "measure": "polypod.report.figures",
    "read_gait": "polypod.gait.files",
    "read_record": "polypod.report.record",
    "read_scene": "polypod.environment.scene",
    "record_walk": "polypod.recording",
    "scatter": "polypod.environment.scattering",
    "write_gait": "polypod.gait.files",
    "write_glb": "polypod.rigs.export",
    "write_record": "polypod.report.record",
    "write_strip": "polypod.report.strip",
}

__all__ = [
    "Activity",
    "Environment",
    "Gait",
    "GaitCheck",
    "Obstacle",
    "PolypodError",
    "Settings",
    "Terrain",
    "World",
    "check_gait",
    "load_rig",
    "make_gait",
    "measure",
    "read_gait",
    "read_record",
    "read_scene",
    "record_walk",
    "scatter",
    "write_gait",
    "write_glb",
    "write_record",
    "write_strip",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'polypod' has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
