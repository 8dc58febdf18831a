"""The world: herds of creatures in an environment, and the loop that walks them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from polypod.command import FARTHEST, numbers_of
from polypod.compute import kernel, over_creatures, thread_count
from polypod.config import Settings
from polypod.controller.spawn import spawn
from polypod.crowd.company import list_company, make_company, note_herd
from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.terrain import Terrain
from polypod.environment.tiled import TiledTerrain
from polypod.errors import SettingError
from polypod.frame import step_creatures
from polypod.gait.advance import destination_disks
from polypod.gait.follow import PINNED, take_gait
from polypod.gait.library import make_gait, own_duty
from polypod.gait.needle import minimum_feet_down
from polypod.gait.pattern import Gait
from polypod.herd import Herd
from polypod.ik.skeleton import pose_joints
from polypod.morphology.types import FloatArray, Morphology
from polypod.reference import by_reference

LONGEST_STEP = 1.0


@kernel
def set_disks(c: int, phase: float, duty: float, state: Any, command: Any, tables: Any) -> None:
    """Give a creature that has not walked yet the disks of its gait, and its needle a place."""
    state.duty[c] = duty
    state.gait_number[c] = command.gait_number[c]
    state.rung[c] = 0 if command.follows[c] else PINNED
    take_gait(c, state.rung[c], state, command, tables)
    destination_disks(c, state, state.duty[c], state.goal_start[c], state.goal_extent[c])
    destination_disks(c, state, state.duty[c], state.swing_start[c], state.swing_extent[c])
    state.least_down[c] = minimum_feet_down(state.swing_start[c], state.swing_extent[c])
    state.needle[c] = phase
    for k in range(state.stood.shape[1]):
        state.stood[c, k] = 1.0


class Push(NamedTuple):
    """A push that is planned."""

    time: float  # s
    herd: Herd
    row: int  # of the herd
    velocity: FloatArray  # [3]
    at: float  # m


class World:
    """Creatures and the place they walk in.

    Args:
        place: the terrain, or a whole environment; flat ground where omitted.
        obstacles: what stands on the terrain, where `place` is a terrain.
        threads: how many threads may step creatures; all cores where omitted. Results do not
            depend on it, to the last bit.
        seed: of what varies from stride to stride, where settings ask for that.
    """

    def __init__(
        self,
        place: Terrain | TiledTerrain | Environment | None = None,
        obstacles: Sequence[Obstacle] = (),
        *,
        threads: int | None = None,
        seed: int = 0,
    ) -> None:
        if not isinstance(seed, int | np.integer) or not 0 <= seed < 2**31:
            raise SettingError(f"seed is {seed!r}; it must be a whole number from 0 to {2**31 - 1}")
        if not isinstance(place, Environment):
            place = Environment(place, obstacles)
        # Another world may have left it at a later time.
        place.advance(0.0)
        self.environment = place
        self.kernel_environment = place.kernel_table
        self.herds: list[Herd] = []
        self._meet()
        self.time = 0.0
        self._pushes: list[Push] = []
        self.seed = int(seed)
        self.threads = thread_count() if threads is None else max(1, int(threads))

    def add(
        self,
        morphology: Morphology,
        count: int = 1,
        *,
        position: ArrayLike | None = None,
        heading: ArrayLike = 0.0,
        gait: Gait | str | None = None,
        speed: ArrayLike = 0.0,
        settings: Settings | None = None,
    ) -> Herd:
        """Stand creatures of one morphology in the world and return them as a herd.

        Args:
            morphology: what they are.
            count: how many.
            position: [count, 2] or [2]: x, z, m; in rows beside each other where omitted.
            heading: rad about +Y from +Z toward +X, one number or [count].
            gait: a gait or its name, kept at any speed; where omitted the gait follows the speed.
            speed: m/s, asked for from the first step on.
            settings: how they are controlled.

        Raises:
            SettingError: no room to stand at a position, or an argument that cannot be used.
            GaitError: no such gait.
        """
        if not isinstance(count, int) or not 1 <= count <= 100_000:
            raise SettingError(f"count is {count!r}; it must be from 1 to 100000 creatures")
        herd = Herd(morphology, count, settings or Settings())
        herd.command.speed = speed
        herd.command.heading = heading
        self.enter(herd, position, gait)
        return herd

    def enter(
        self, herd: Herd, position: ArrayLike | None = None, gait: Gait | str | None = None
    ) -> None:
        """Stand a herd that was made elsewhere in the world; arguments and errors are `add`'s."""
        morphology, count = herd.morphology, herd.count
        places = rows(count, herd.tables.leg_length) if position is None else position
        given = numbers_of("a creature's position", places, "metres")
        if given.shape not in ((2,), (count, 2)) or not np.all(np.abs(given) <= FARTHEST):
            raise SettingError(
                f"a creature's position must be x, z within {FARTHEST:g} m, or [{count}, 2] of them"
            )
        points = np.broadcast_to(given, (count, 2))
        herd.state.position[:, 0] = points[:, 0]
        herd.state.position[:, 2] = points[:, 1]
        herd.state.heading[:] = herd.command.heading
        herd.state.track_from[:] = herd.command.heading
        self.environment.load_ground(herd.state.position[:, [0, 2]], herd.sight(0.0))
        herd.state.seed[:] = self.seed
        chosen = self._gait(herd, gait)
        for c in range(count):
            # A golden-angle offset, so that the creatures of a herd are not in step.
            # Just before a lift-off: at it, rounding would decide which frame the foot leaves in.
            phase = (chosen.standing_phase - 1e-6 + c * 0.618033988749895) % 1.0
            set_disks(
                c, phase, chosen.duty, herd.kernel_state, herd.kernel_command, herd.kernel_tables
            )
            if not self._spawn(herd, c):
                x, z = points[c]
                raise SettingError(
                    f"{morphology.name} cannot stand at x {x:g}, z {z:g}: not every foot finds a "
                    "place within reach; choose a flatter or freer position"
                )
        self.herds.append(herd)
        self._meet()

    def _meet(self) -> None:
        """Make the creatures of all herds known to each other."""
        counts = [herd.count for herd in self.herds]
        feet = [len(herd.morphology.foot_name) for herd in self.herds]
        every = [k for k, count in zip(feet, counts, strict=True) for _ in range(count)]
        self._company = make_company(every)
        self._kernel_company = by_reference(self._company)
        first = 0
        for herd in self.herds:
            herd.join(self._company, first)
            first += herd.count

    def change_place(self, place: Environment, renumbered: Sequence[int]) -> None:
        """Let the creatures that walk here go on in another environment.

        Feet that stood on an obstacle that is gone look for another place.

        Args:
            place: the environment, which is put where it is at this world's time.
            renumbered: for each obstacle of the environment before, which one it is now, -1: gone.
        """
        place.advance(self.time)
        self.environment = place
        self.kernel_environment = place.kernel_table
        number = np.array([*renumbered, -1], np.int64)
        for herd in self.herds:
            for support in (herd.state.foot_support, herd.state.landing_support):
                support[:] = number[support]

    def look_round(self) -> None:
        """Let each creature see where the others are now; `step` does it as a frame begins."""
        self._company.most[:] = 0.0
        self._company.size[0] = 0
        if sum(herd.count for herd in self.herds) < 2:
            return
        company = self._kernel_company
        for herd in self.herds:
            note_herd(herd.kernel_state, herd.kernel_command, herd.kernel_tables, company)
        list_company(company)

    def _load_ground(self, dt: float) -> None:
        """Have the ground about all creatures at hand, where it comes in tiles."""
        if self.environment.pager is not None and self.herds:
            places = [herd.state.position[:, [0, 2]] for herd in self.herds]
            sight = [herd.sight(dt) for herd in self.herds]
            self.environment.load_ground(np.concatenate(places), np.concatenate(sight))

    def _spawn(self, herd: Herd, c: int) -> bool:
        scratch = herd.scratch(0)
        fits = spawn(
            c, herd.kernel_state, herd.kernel_command, herd.kernel_tables, herd.kernel_settings,
            self.kernel_environment, herd.kernel_plan, scratch, herd.settings.search_radius,
        )  # fmt: skip
        if fits:
            pose_joints(c, herd.kernel_state, herd.kernel_tables, scratch)
        return fits

    def _gait(self, herd: Herd, gait: Gait | str | None) -> Gait:
        """Ask for a herd's gait, or that it follows speed; return the one it starts in."""
        legs = herd.tables.legs
        if gait is None:
            herd.command.follow_speed()
            speed = float(np.max(herd.command.speed))
            size = herd.tables.hip_height if herd.tables.upright else herd.tables.leg_length
            duty = own_duty(herd.ladder[0], legs.upright, speed * speed / (9.81 * size))
            return make_gait(herd.ladder[0], legs.side, legs.row, duty)
        if not isinstance(gait, Gait):
            gait = make_gait(gait, legs.side, legs.row)
        herd.command.set_gait(gait)
        return gait

    def push_at(
        self, time: float, velocity: ArrayLike, creature: int = 0, *, at: float = 0.0
    ) -> None:
        """Plan a push, which acts at the beginning of the frame nearest to its time.

        Args:
            time: s, from now on.
            velocity: [3] as in `Herd.push`.
            creature: counts the creatures of all herds, in their order.
            at: as in `Herd.push`.

        Raises:
            SettingError: a time that has passed, or what `Herd.push` refuses.
        """
        if not isinstance(time, int | float) or not self.time <= time < math.inf:
            raise SettingError(f"a push at {time!r} s; the time must be from {self.time:g} s on")
        row = creature if isinstance(creature, int | np.integer) else -1
        for herd in self.herds:
            if 0 <= row < herd.count:
                _, given = herd.judge_push(velocity, int(row), at)
                self._pushes.append(Push(time, herd, int(row), given[0], at))
                return
            row -= herd.count
        count = sum(herd.count for herd in self.herds)
        raise SettingError(f"creature is {creature!r}; it must be from 0 to {count - 1}")

    def _push(self, dt: float) -> None:
        """Carry out the pushes whose time has come."""
        if not self._pushes:
            return
        later = []
        for push in self._pushes:
            if push.time < self.time + 0.5 * dt:
                push.herd.push(push.velocity, push.row, at=push.at)
            else:
                later.append(push)
        self._pushes = later

    def step(self, dt: float) -> None:
        """Advance everything by `dt` seconds.

        Raises:
            SettingError: `dt` is not above 0 and at most 1 s.
        """
        if not 0.0 < dt <= LONGEST_STEP:
            raise SettingError(f"a step of {dt!r} s; it must be above 0 and at most {LONGEST_STEP}")
        self._push(dt)
        self.environment.advance(self.time + dt)
        self._load_ground(dt)
        self.look_round()
        for herd in self.herds:
            for worker in range(self.threads):
                herd.scratch(worker)

            def run(first: int, last: int, worker: int, herd: Herd = herd) -> None:
                step_creatures(herd, self.kernel_environment, dt, first, last, worker)

            over_creatures(run, herd.count, self.threads)
        if self.environment.table.missed[0]:
            raise RuntimeError("a creature asked for ground beyond its sight")
        self.time += dt


def rows(count: int, leg_length: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return places [count, 2] in a square of rows, three leg lengths apart, about the origin."""
    side = math.ceil(math.sqrt(count))
    index = np.arange(count)
    grid = np.stack([index % side, index // side], axis=1).astype(np.float64)
    return (grid - 0.5 * (side - 1)) * 3.0 * leg_length
