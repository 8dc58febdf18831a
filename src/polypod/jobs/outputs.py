"""Files that a walk leaves: judged before anything runs, written when all went well."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from polypod.errors import SettingError
from polypod.jobs.screen import note

if TYPE_CHECKING:
    from polypod.environment.environment import Environment
    from polypod.report.record import Recording

WALK_SUFFIXES = (".glb", ".png")
PLOT_SUFFIXES = (".png", ".svg", ".pdf")


@dataclass(frozen=True)
class Outputs:
    """Where to write what; one file a creature but for the pictures, which show all."""

    glb: tuple[Path, ...] = ()
    png: tuple[Path, ...] = ()
    record: Path | None = None
    report: Path | None = None
    plots: Path | None = None


def judge_outputs(
    out: Sequence[str],
    record: str | None,
    report: str | None,
    plots: str | None,
    inputs: Iterable[Path],
) -> Outputs:
    """Return where to write.

    Raises:
        SettingError: a suffix that is none of ours, a folder that is not there or not writable, one
            file named twice, or a file that the run reads.
    """
    asked: list[tuple[str, str, tuple[str, ...]]] = [("-o", name, WALK_SUFFIXES) for name in out]
    asked += [("--record", record, (".npz",))] if record is not None else []
    asked += [("--report", report, (".json",))] if report is not None else []
    asked += [("--plots", plots, PLOT_SUFFIXES)] if plots is not None else []
    judge_distinct(asked, inputs)
    return Outputs(
        glb=tuple(Path(name) for name in out if Path(name).suffix.lower() == ".glb"),
        png=tuple(Path(name) for name in out if Path(name).suffix.lower() == ".png"),
        record=None if record is None else Path(record),
        report=None if report is None else Path(report),
        plots=None if plots is None else Path(plots),
    )


def judge_distinct(
    asked: Iterable[tuple[str, str, tuple[str, ...]]], inputs: Iterable[Path]
) -> None:
    """Judge each output: option, name, suffixes.

    Raises:
        SettingError: see `judge_output`; one file named twice, or one that the run reads.
    """
    taken = {path.absolute(): "is read by this run" for path in inputs}
    for option, name, suffixes in asked:
        path = judge_output(option, name, suffixes).absolute()
        if path in taken:
            raise SettingError(f"{option} {name}: {taken[path]}; name another file")
        taken[path] = "is named twice"


def judge_output(option: str, name: str, suffixes: Sequence[str]) -> Path:
    """Return the path of an output that can be written.

    Raises:
        SettingError: its suffix is none of `suffixes`, or its folder is not there or not writable.
    """
    path = Path(name)
    if path.suffix.lower() not in suffixes:
        raise SettingError(f"{option} {name}: must end in {' or '.join(suffixes)}")
    try:
        if not path.parent.is_dir():
            raise SettingError(f"{option} {name}: the folder {path.parent} does not exist")
        if path.is_dir():
            raise SettingError(f"{option} {name}: is a folder; name a file")
        if not os.access(path if path.exists() else path.parent, os.W_OK):
            raise SettingError(f"{option} {name}: cannot be written, permission is denied")
    except (OSError, ValueError) as error:
        raise SettingError(f"{option} {name}: cannot be written ({error})") from None
    return path


def numbered(path: Path, count: int) -> list[Path]:
    """Return the path for a single creature, else run-000.npz, run-001.npz ... for `count`."""
    if count == 1:
        return [path]
    digits = max(3, len(str(count - 1)))
    return [path.with_name(f"{path.stem}-{i:0{digits}d}{path.suffix}") for i in range(count)]


def write_outputs(
    outputs: Outputs,
    recordings: Sequence[Recording],
    environment: Environment,
    reports: Sequence[dict[str, object]],
) -> list[Path]:
    """Write all files and return their paths; each is there whole or not at all."""
    from polypod.report.figures import write_report
    from polypod.report.plots import write_plots
    from polypod.report.record import write_record
    from polypod.report.strip import write_strip
    from polypod.rigs.export import write_glb

    count = len(recordings)
    written: list[Path] = []
    for target in outputs.glb:
        for path, recording in zip(numbered(target, count), recordings, strict=True):
            write_glb(recording, path)
            written.append(path)
    if outputs.record is not None:
        for path, recording in zip(numbered(outputs.record, count), recordings, strict=True):
            write_record(recording, path)
            written.append(path)
    if outputs.report is not None:
        for path, report in zip(numbered(outputs.report, count), reports, strict=True):
            write_report(report, path)
            written.append(path)
    if outputs.plots is not None:
        for path, recording in zip(numbered(outputs.plots, count), recordings, strict=True):
            write_plots(recording, path)
            written.append(path)
    for target in outputs.png:
        note(f"drawing {target}")
        write_strip(recordings, environment.table, target)
        written.append(target)
    return written
