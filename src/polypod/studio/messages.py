"""The messages that tell tabs how things are (docs/studio-protocol.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from polypod import __version__
from polypod.environment.generators import GENERATORS, generator_keys
from polypod.morphology.builtin import NAMES as BUILT_IN
from polypod.studio.judge import Verdict
from polypod.studio.stage import RATE

if TYPE_CHECKING:
    from polypod.studio.conductor import Conductor

Message = dict[str, Any]


def welcome_message(conductor: Conductor) -> Message:
    """Say what this studio is and has."""
    return {
        "is": "welcome",
        "version": __version__,
        "rigs": list(BUILT_IN),
        "generators": {name: generator_keys(name) for name in GENERATORS},
        "fps": RATE,
    }


def kinds_message(conductor: Conductor) -> Message:
    """Say who walks, and which skins and ground that is drawn with."""
    kinds = [
        {
            "skin": conductor.drawn.skin_numbers[id(herd.morphology.source)],
            "count": herd.count,
            "joints": len(herd.morphology.joint_node) + 1,
            "name": herd.morphology.name,
        }
        for herd in conductor.stage.herds
    ]
    return {"is": "kinds", "kinds": kinds, "ground": conductor.drawn.ground}


def document_message(conductor: Conductor) -> Message:
    """Say what is asked for now."""
    return {
        "is": "document",
        "document": conductor.stage.document,
        "can_undo": conductor.history.can_undo,
        "can_redo": conductor.history.can_redo,
    }


def files_message(conductor: Conductor) -> Message:
    """Say which meshes and grounds of files there are."""
    files = conductor.stage.files
    return {"is": "files", "meshes": files.mesh_names, "grounds": files.ground_names}


def clock_message(conductor: Conductor) -> Message:
    """Say how time goes."""
    return {
        "is": "clock",
        "playing": conductor.playing,
        "rate": conductor.rate,
        "behind": conductor.behind,
        "time": conductor.stage.world.time,
        "frame": conductor.number,
    }


def verdict_message(verdict: Verdict) -> Message:
    """Say what to think of the gait (P2 4)."""
    check = verdict.check
    return {
        "is": "verdict",
        "verdict": check.verdict,
        "sentence": check.sentence,
        "reasons": list(check.reasons),
        "body_peak": float(check.body_peak),
        "foot_peak": [float(v) for v in check.foot_peak],
        "flight": float(check.flight),
        "speed": float(check.speed),
        "searching": verdict.searching,
    }


def tape_message(conductor: Conductor) -> Message:
    """Say what is recorded."""
    tape = conductor.tape
    kinds = [] if tape is None else tape.kinds
    return {
        "is": "tape",
        "recording": tape is not None and tape.recording,
        "frames": 0 if tape is None else len(tape.frames),
        "seconds": 0.0 if tape is None else tape.seconds,
        "scrub": conductor.scrubbed,
        "kinds": [{"name": kind.name, "count": kind.creatures} for kind in kinds],
    }


def backdrop_message(conductor: Conductor) -> Message:
    """Say what stood in the frame of the tape that is shown; nulls where none is."""
    backdrop = conductor.backdrop
    return {
        "is": "backdrop",
        "obstacle": None if backdrop is None else backdrop.obstacle,
        "ground": None if backdrop is None else backdrop.ground,
    }
