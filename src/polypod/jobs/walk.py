"""`polypod walk`: a rig and a place go in, a walk comes out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polypod.errors import SettingError
from polypod.jobs.outputs import judge_outputs, write_outputs
from polypod.jobs.rig_options import DEFAULT_RIG, RIG_HELP, add_rig_options
from polypod.jobs.screen import note, progress, telling_of_compilation, warn
from polypod.jobs.values import filled, number, waypoints, whole

if TYPE_CHECKING:
    from polypod.environment.environment import Environment
    from polypod.environment.scene import PushSpec, Scene
    from polypod.gait.validation import GaitCheck
    from polypod.jobs.cast import Role
    from polypod.report.record import Recording

DESCRIPTION = """Makes a creature walk and writes the walk.

  polypod walk spider --scene crates.toml -o walk.glb -o walk.png
  polypod walk fox.glb --height 0.8 --path "0,0 0,5 3,8" -o fox_walks.glb"""
DEFAULT_SECONDS = 10.0
MOST_FRAMES = 100_000
# Of all creatures together: each takes 56 bytes, twice while a recording is finished.
MOST_JOINT_FRAMES = 20_000_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `polypod walk`."""
    parser.add_argument(
        "rig", nargs="?", type=filled, metavar="RIG", help=f"{RIG_HELP}; omitted: {DEFAULT_RIG}"
    )
    add_rig_options(parser)
    parser.add_argument(
        "--scene", type=filled, metavar="SCENE.toml", help="where to walk; omitted: flat ground"
    )
    parser.add_argument(
        "--gait",
        type=filled,
        metavar="NAME|FILE",
        help="see polypod gait; omitted: it follows the speed",
    )
    parser.add_argument(
        "--speed",
        type=number(0.0, 100.0, "m/s"),
        metavar="M/S",
        help="omitted: what is comfortable for the legs",
    )
    parser.add_argument(
        "--path",
        type=waypoints,
        metavar='"x,z x,z ..."',
        help="places in metres: start at the first, face the second, stop at the last",
    )
    parser.add_argument(
        "--seconds",
        type=number(0.0, 1e6, "s", above=True),
        metavar="S",
        help=f"omitted: what the path takes, or {DEFAULT_SECONDS:g}",
    )
    parser.add_argument(
        "--fps", type=number(1.0, 1000.0, "frames a second"), default=30.0, help="default: 30"
    )
    parser.add_argument(
        "--seed",
        type=whole(0, 2**31 - 1, "a seed"),
        default=0,
        metavar="N",
        help="another number, another field, other strides: added to the seeds of the scene",
    )
    parser.add_argument(
        "--stride-variation",
        type=number(0.0, 0.2, "of a stride's time"),
        default=0.0,
        metavar="SHARE",
        help="by how much strides' times differ, 0.02 to 0.04 in animals; default: 0",
    )
    parser.add_argument(
        "-o",
        dest="out",
        action="append",
        default=[],
        type=filled,
        metavar="OUT.glb|OUT.png",
        help="the walk as a GLB, or as a strip of pictures; repeatable",
    )
    parser.add_argument("--record", type=filled, metavar="RUN.npz", help="the walk as arrays")
    parser.add_argument(
        "--report", type=filled, metavar="REPORT.json", help="how good the walk is, in numbers"
    )
    parser.add_argument(
        "--plots",
        type=filled,
        metavar="PLOTS.png|.svg|.pdf",
        help="the walk as curves: stances, heights of body and soles, turns of joints",
    )


def run(given: argparse.Namespace) -> int:
    """Judge everything, walk, write, and say how it went."""
    outputs = judge_outputs(given.out, given.record, given.report, given.plots, _inputs(given))
    from polypod.environment.scene import read_scene
    from polypod.jobs.cast import cast_roles, list_pushes, walking_seconds

    scene = read_scene(given.scene, given.seed) if given.scene is not None else None
    roles = cast_roles(given, scene)
    seconds = given.seconds
    if seconds is None:
        seconds = walking_seconds(roles, DEFAULT_SECONDS)
    _judge_length(roles, seconds, given.fps)
    pushes = list_pushes(roles, scene, seconds) if scene is not None else []
    with telling_of_compilation():
        recordings, environment, gaits = _walk(roles, scene, pushes, seconds, given)
        reports = _judge_walks(
            roles, gaits, recordings, environment, seconds, bool(given.report and outputs.glb)
        )
        written = write_outputs(outputs, recordings, environment, reports)
    _sum_up(reports, written)
    return 0


def _inputs(given: argparse.Namespace) -> list[Path]:
    """Return the files that the command line names for reading."""
    return [Path(name) for name in (given.rig, given.scene, given.gait) if name is not None]


def _judge_length(roles: list[Role], seconds: float, fps: float) -> None:
    frames = round(seconds * fps) + 1
    if frames > MOST_FRAMES:
        raise SettingError(
            f"{seconds:g} s at {fps:g} frames a second are {frames} frames; the most is "
            f"{MOST_FRAMES}; give fewer --seconds"
        )
    if frames < 2:
        raise SettingError(
            f"--seconds {seconds:g} is less than a frame; give at least {1.0 / fps:.3g}"
        )
    joints = sum(len(role.morphology.joint_node) * role.count for role in roles)
    if joints * frames > MOST_JOINT_FRAMES:
        raise SettingError(
            f"{frames} frames of {joints} joints are too much to keep, the most is "
            f"{MOST_JOINT_FRAMES // joints} frames; give fewer --seconds"
        )


def _walk(
    roles: list[Role],
    scene: Scene | None,
    pushes: list[PushSpec],
    seconds: float,
    given: argparse.Namespace,
) -> tuple[list[Recording], Environment, list[GaitCheck | None]]:
    from polypod.config import Settings
    from polypod.environment.environment import Environment
    from polypod.jobs.cast import enter, overdone
    from polypod.recording import record_walk
    from polypod.world import World

    environment = Environment() if scene is None else scene.environment()
    world = World(environment, seed=given.seed)
    settings = Settings(stride_variation=given.stride_variation)
    for role in roles:
        try:
            herd = enter(world, role, settings)
        except SettingError as error:
            raise SettingError(f"{role.place}: {error}") from None
        too_fast = overdone(role, herd)
        if too_fast is not None:
            warn(too_fast)
    for push in pushes:
        world.push_at(push.time, push.velocity, push.creature, at=push.at)
    gaits = _judge_gaits(roles)
    with progress("walking") as advance:
        return record_walk(world, seconds, given.fps, advance), environment, gaits


def _judge_gaits(roles: list[Role]) -> list[GaitCheck | None]:
    """Return what to think of each role's gait, and warn of those that no animal could walk."""
    from polypod.gait.validation import IMPLAUSIBLE
    from polypod.jobs.cast import judge_gait

    checks = [judge_gait(role) for role in roles]
    for role, check in zip(roles, checks, strict=True):
        if check is not None and check.verdict == IMPLAUSIBLE:
            warn(f"{role.morphology.name}: {check.sentence}")
    return checks


def _judge_walks(
    roles: list[Role],
    gaits: list[GaitCheck | None],
    recordings: list[Recording],
    environment: Environment,
    seconds: float,
    played: bool,
) -> list[dict[str, object]]:
    """Return what goes into each creature's report, with what a player of its GLB will show."""
    from polypod.report.figures import measure, measure_played
    from polypod.report.played import soles_played
    from polypod.report.verdict import failures, remarks

    reports: list[dict[str, object]] = []
    who = [pair for pair in zip(roles, gaits, strict=True) for _ in range(pair[0].count)]
    with progress("judging") as advance:
        for (role, gait), recording in zip(who, recordings, strict=True):
            asked = min(role.speed * seconds, role.way)
            figures = measure(recording, environment.table, commanded_distance_m=asked)
            if played:
                figures |= measure_played(recording, environment.table, soles_played(recording))
            reports.append(
                {
                    "creature": role.morphology.name,
                    "speed_asked_m_s": role.speed,
                    **({} if gait is None else _gait_figures(gait)),
                    **figures,
                    "failures": failures(figures),
                    "remarks": remarks(figures),
                }
            )
            advance(len(reports), len(who))
    return reports


def _gait_figures(check: GaitCheck) -> dict[str, object]:
    """Return what a report says of the gait that was asked for."""
    return {
        "gait": check.gait.name,
        "gait_verdict": check.verdict,
        "gait_reasons": list(check.reasons),
        "gait_body_peak_g": check.body_peak,
    }


def _sum_up(reports: list[dict[str, Any]], written: list[Path]) -> None:
    """Print a line a creature, what failed, and what was written."""
    for report in reports[:10]:
        slip = 1000.0 * report.get("stance_slip_of_leg", 0.0) * report["leg_length_m"]
        print(
            f"{report['creature']} walked {report['distance_m']:.3g} m of "
            f"{report['distance_commanded_m']:.3g} m asked for in {report['seconds']:.3g} s, "
            f"{report['swing_count']} steps, no foot slipped more than {slip:.2g} mm"
        )
    if len(reports) > 10:
        print(f"and {len(reports) - 10} more")
    for report in reports:
        for failure in report["failures"]:
            warn(f"{report['creature']}: {failure}")
    for report in reports[:10]:
        for remark in report["remarks"]:
            note(f"polypod: worth a look: {report['creature']}: {remark}")
    if written:
        print("wrote " + ", ".join(str(path) for path in written))
    else:
        print("nothing was written; -o walk.glb writes the walk, -o walk.png pictures of it")
