"""From the command line to a studio that is served."""

from __future__ import annotations

import argparse
import tomllib
from pathlib import Path

from polypod.errors import SettingError
from polypod.jobs.rig_options import RIG_OPTIONS
from polypod.jobs.screen import note, telling_of_compilation
from polypod.morphology.builtin import NAMES as BUILT_IN
from polypod.morphology.load import load_rig
from polypod.studio.document import Document, default_document, judged
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.runner import Runner
from polypod.studio.scenes import read_document
from polypod.studio.serve import bind, open_browser, serve
from polypod.studio.world_files import WorldFiles

SCENE_KEYS = ("terrain", "obstacle", "scatter", "creature", "push")


def open_studio(given: argparse.Namespace) -> None:
    """Serve what the command line asks for until Ctrl-C.

    Raises:
        PolypodError: a rig, a scene or a port that cannot be used.
    """

    def opened(address: str) -> None:
        print(f"the studio is at {address} (Ctrl-C ends it)", flush=True)
        if not given.no_browser:
            open_browser(address)

    rigs, files = GivenRigs(), WorldFiles()
    try:
        document = opening(given, rigs, files)
        listener = bind(given.port)
        runner = Runner(document, rigs.find, files)
        try:
            with telling_of_compilation():
                runner.start()
                runner.ready.wait()
            if runner.failed is not None:
                raise runner.failed
            serve(runner, rigs, files, listener, opened)
        finally:
            listener.close()
            runner.stop()
    finally:
        rigs.close()
        files.close()
    note("the studio is closed")


def opening(given: argparse.Namespace, rigs: GivenRigs, files: WorldFiles) -> Document:
    """Return the first document; its scene's rigs and files are known from then on.

    Raises:
        PolypodError: the rig or the scene cannot be used.
    """
    if given.rig is not None and given.scene is None and _is_scene(given.rig):
        given.rig, given.scene = None, given.rig
    document = default_document()
    if given.scene is not None:
        document = read_document(Path(given.scene), document, rigs, files)
    asked = {key: getattr(given, key) for key in RIG_OPTIONS}
    said = [RIG_OPTIONS[key] for key, value in asked.items() if value is not None]
    if given.rig is None:
        if said and given.scene is not None:
            raise SettingError(f"{said[0]} is for a rig on the command line; name one")
    else:
        document["creature"]["rig"] = _known(given.rig, rigs)
        document["creature"]["limit"] = document["gait"] = None
    if given.rig is not None or said:
        lists = {
            key: None if value is None else list(value)
            for key, value in asked.items()
            if key in ("leg", "spine")
        }
        document["creature"] |= asked | lists
    return judged(document)


def _known(rig: str, rigs: GivenRigs) -> str:
    """Return what a document calls the rig on the command line."""
    if rig in BUILT_IN and not _is_file(rig):
        return rig
    if not _is_file(rig):
        load_rig(rig)  # says what is wrong, as it does to other commands
    return rigs.point_to(Path(rig))


def _is_scene(name: str) -> bool:
    """Return whether a file is a scene, and no creature file."""
    if not (name.lower().endswith(".toml") and _is_file(name)):
        return False
    try:
        keys = tomllib.loads(Path(name).read_bytes().decode())
    except (OSError, ValueError, RecursionError):
        return False
    return "rig" not in keys and any(key in keys for key in SCENE_KEYS)


def _is_file(name: str) -> bool:
    try:
        return Path(name).is_file()
    except (OSError, ValueError):  # too long, or with a null character
        return False
