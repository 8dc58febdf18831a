"""Who walks, where and how: from the command line and the scene to creatures in a world.

Everything is read and judged here before the world is made, because making it compiles kernels.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from polypod.errors import SettingError, choices
from polypod.jobs.rig_options import RIG_OPTIONS, load_given_rig
from polypod.jobs.screen import warn

if TYPE_CHECKING:
    from polypod.config import Settings
    from polypod.environment.scene import CreatureSpec, PushSpec, Scene
    from polypod.gait.pattern import Gait
    from polypod.gait.validation import GaitCheck
    from polypod.herd import Herd
    from polypod.morphology.types import Morphology
    from polypod.world import World

GRAVITY = 9.81  # m/s^2
FASTEST = 100.0  # m/s
Places = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Role:
    """Creatures of one kind and what is asked of them."""

    place: str  # for messages: where it was asked for
    morphology: Morphology
    gait: Gait | None  # None: it follows the speed
    speed: float  # m/s
    count: int
    position: tuple[float, float]  # x, z, m; of several: the middle of their rows
    heading: float  # rad
    path: Places  # of one that starts at `position`, without its start; empty: straight ahead

    @property
    def way(self) -> float:
        """Length of the path, m; infinite where there is none."""
        if not self.path:
            return math.inf
        places = (self.position, *self.path)
        return sum(math.dist(a, b) for a, b in pairwise(places))


def cast_roles(given: argparse.Namespace, scene: Scene | None) -> list[Role]:
    """Return who walks: the rig on the command line, else the scene's creatures, else the spider.

    A rig on the command line takes the place of the scene's creatures; it starts where the first of
    them would and goes its way, unless there is a --path.

    Raises:
        PolypodError: a rig, a gait or an option that cannot be used.
    """
    from polypod.environment.scene import CreatureSpec

    creatures = scene.creatures if scene is not None else ()
    if given.rig is not None or not creatures:
        first = creatures[0] if creatures else CreatureSpec(rig="")
        lone = CreatureSpec(rig="", position=first.position, heading=first.heading, path=first.path)
        return [_role("the command line", load_given_rig(given), lone, given, Path())]
    return _scene_roles(given, creatures, scene.path if scene is not None else Path())


def _scene_roles(
    given: argparse.Namespace, creatures: tuple[CreatureSpec, ...], scene: Path
) -> list[Role]:
    for key, option in RIG_OPTIONS.items():
        if getattr(given, key) is not None:
            raise SettingError(
                f"{option} is for a rig on the command line, and {scene} has creatures of its own; "
                "name a rig, or write it into the scene's [[creature]]"
            )
    if given.path is not None and sum(spec.count for spec in creatures) > 1:
        raise SettingError(
            f"--path is for one creature, and {scene} has more; write path into its [[creature]]s"
        )
    roles = []
    for i, spec in enumerate(creatures):
        place = f"{scene}: [[creature]] number {i + 1}"
        roles.append(_role(place, _load(place, spec, scene.parent), spec, given, scene.parent))
    return roles


def _load(place: str, spec: CreatureSpec, folder: Path) -> Morphology:
    from polypod.errors import PolypodError
    from polypod.morphology.load import load_rig

    beside = folder / spec.rig
    try:
        return load_rig(
            beside if _is_file(beside) else spec.rig,
            legs=spec.leg or None,
            spine=spec.spine or None,
            forward=spec.forward,
            height=spec.height,
            body_height=spec.body_height,
            limits=spec.limit,
        )
    except PolypodError as error:
        raise type(error)(f"{place}: {error}") from None


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # too long, or with a null character
        return False


def _role(
    place: str,
    morphology: Morphology,
    spec: CreatureSpec,
    given: argparse.Namespace,
    folder: Path,
) -> Role:
    """Return one kind of creature; options of the command line come before the scene's words."""
    from polypod.herd import WAYPOINT_ROOM

    gait_name, gait_folder = (given.gait, Path()) if given.gait else (spec.gait, folder)
    gait = None if gait_name is None else find_gait(gait_name, morphology, gait_folder)
    speed = given.speed if given.speed is not None else spec.speed
    if speed is None:
        speed = comfortable_speed(morphology)
    if speed > FASTEST:
        raise SettingError(f"{place}: speed is {speed:g}; it must be from 0 to {FASTEST:g} m/s")
    path = _without_repeats(given.path or spec.path)
    position, heading = spec.position, spec.heading
    if given.path is not None or position is None:
        position = path[0] if path else (0.0, 0.0)
    if path and path[0] == position:
        path = path[1:]
    if given.path is not None or heading is None:
        heading = _heading_toward(position, path)
    if len(path) > WAYPOINT_ROOM:
        raise SettingError(
            f"{place}: the path has {len(path) + 1} places; it may have {WAYPOINT_ROOM + 1}"
        )
    return Role(place, morphology, gait, speed, spec.count, position, heading, path)


def _without_repeats(path: Places) -> Places:
    return tuple(point for i, point in enumerate(path) if i == 0 or point != path[i - 1])


def _heading_toward(position: tuple[float, float], path: Places) -> float:
    if not path:
        return 0.0
    return math.atan2(path[0][0] - position[0], path[0][1] - position[1])


def find_gait(name: str, morphology: Morphology, folder: Path = Path()) -> Gait:
    """Return a gait by name, or from a gait file, for a creature's feet.

    Raises:
        GaitError: there is none of that name, or the file is not a gait for so many feet.
    """
    from polypod.gait.files import read_gait
    from polypod.gait.library import make_gait

    file = gait_file(name, folder)
    legs = morphology.legs
    if file is not None:
        return read_gait(file, len(legs.length))
    return make_gait(name, legs.side, legs.row)


def gait_file(name: str, folder: Path = Path()) -> Path | None:
    """Return the file that a gait is to be read from, None where it is a gait's name.

    Raises:
        GaitError: it is neither.
    """
    from polypod.errors import GaitError
    from polypod.gait.library import names

    if name in names():
        return None
    beside = folder / name
    if beside.suffix.lower() == ".toml" or _is_file(beside):
        return beside
    raise GaitError(
        f"there is no gait {name!r}; give a gait file (.toml) or one of {choices(names())}"
    )


def comfortable_speed(morphology: Morphology) -> float:
    """Return the speed, m/s, at which a creature walks when nobody says how fast."""
    from polypod.gait import tempo

    legs = morphology.legs
    hip = float((legs.point_rest[:, 0, 1] - legs.sole_stance[:, 1]).mean())
    upright = float(legs.upright.mean()) > 0.5
    return tempo.comfortable_speed(hip, float(legs.length.mean()), upright)


def walking_seconds(roles: list[Role], default: float) -> float:
    """Return how long the longest path takes, starting, stopping and detours included."""
    longest = 0.0
    for role in roles:
        if math.isinf(role.way) or role.speed <= 0.0:
            longest = max(longest, default)
            continue
        # Speed is gained and lost at about g of the leg's own time: twice the legs' pendulum.
        pendulum = math.sqrt(float(role.morphology.legs.length.mean()) / GRAVITY)
        longest = max(longest, 1.15 * role.way / role.speed + 6.0 * pendulum + 1.0)
    return math.ceil(longest * 10.0) / 10.0


def list_pushes(roles: list[Role], scene: Scene, seconds: float) -> list[PushSpec]:
    """Return a scene's pushes for those who walk, and say which are left out.

    Raises:
        SettingError: one strikes beside the trunk.
    """
    from polypod.body.blow import judge_place

    who = [role for role in roles for _ in range(role.count)]
    pushes = []
    for number, push in enumerate(scene.pushes, start=1):
        place = f"{scene.path}: [[push]] number {number}"
        if push.creature >= len(who):
            warn(f"{place} is for creature {push.creature}, who does not walk here; it is left out")
        elif push.time >= seconds:
            warn(f"{place} is at {push.time:g} s, and the walk ends at {seconds:g} s")
        else:
            try:
                judge_place(who[push.creature].morphology, push.at)
            except SettingError as error:
                raise SettingError(f"{place}: {error}") from None
            pushes.append(push)
    return pushes


def enter(world: World, role: Role, settings: Settings | None = None) -> Herd:
    """Stand a role's creatures in the world, in rows if they are several, each with its path.

    Raises:
        SettingError: one of them finds no place to stand.
    """
    from polypod.world import rows

    middle = rows(role.count, float(role.morphology.legs.length.mean()))
    places = middle + role.position
    herd = world.add(
        role.morphology,
        role.count,
        position=places,
        heading=role.heading,
        gait=role.gait,
        speed=role.speed,
        settings=settings,
    )
    if role.path:
        for c in range(role.count):
            herd.command.set_path(middle[c] + role.path, c)
    return herd


def overdone(role: Role, herd: Herd) -> str | None:
    """Return a sentence where a speed is beyond what the legs can do, else None."""
    from polypod.gait.tempo import top_speed

    tables = herd.tables
    follows = bool(herd.command.arrays.follows[0])
    duties = tables.ladder.duty[:, 1] if follows else herd.command.arrays.gait_duty[:, 1]
    lowest_duty = float(duties.min())
    most = float(top_speed(tables.leg_length, lowest_duty, float(tables.ik.stance_travel.min())))
    if role.speed <= most:
        return None
    return (
        f"{role.morphology.name} is asked for {role.speed:.3g} m/s, and its legs can do about "
        f"{most:.2g} m/s{'' if follows else ' in this gait'}; its feet will not keep up"
    )


def judge_gait(role: Role) -> GaitCheck | None:
    """Return what to think of the gait that is asked of a role at its speed; None: none is."""
    if role.gait is None:
        return None
    from polypod.gait.validation import check_gait

    return check_gait(role.gait, role.morphology, speed=role.speed)
