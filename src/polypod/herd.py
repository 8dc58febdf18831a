"""All creatures of one morphology in a world: what they are and do, and what is asked of them."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from polypod.allocation import make_command, make_state
from polypod.body.blow import judge_place, land_blow, strike
from polypod.body.hull import make_hull_scratch
from polypod.command import Command, numbers_of
from polypod.config import Settings
from polypod.controller.lift import WIDEST_SEARCH
from polypod.controller.spawn import WIDEST_SPAWN
from polypod.crowd.avoid import HEEDED
from polypod.crowd.company import Company, make_company
from polypod.crowd.legs import COMPANY_SEGMENTS
from polypod.errors import SettingError
from polypod.footprints.plan import PlanScratch, make_plan_scratch
from polypod.footprints.scratch import SeenPlaces, seen_places
from polypod.footprints.settings import PlanSettings
from polypod.gait.follow import PINNED, ladder_names
from polypod.morphology.types import BoolArray, FloatArray, IntArray, Morphology
from polypod.paths.apart import make_legs_ahead
from polypod.paths.curve import PathRow, path_store
from polypod.reference import by_reference
from polypod.routes.passable import CELL
from polypod.routes.state import ROUTE_CELLS, RouteScratch, make_route_scratch
from polypod.spine.struck import bend_by_blow
from polypod.state import HerdTables
from polypod.tables import folding_room, make_tables, step_share

WAYPOINT_ROOM = 256
# Part of what a leg can fold in stance that a step on level ground may take.
FOLDING = 0.4
FASTEST = 1e3  # m/s, of any push
# Ways are looked for in a map so far to each side, and a cell, leg lengths; steps within less.
SIGHT = (0.5 * ROUTE_CELLS + 1.0) * CELL


class Scratch(NamedTuple):
    """Working memory of one thread."""

    plan: PlanScratch
    seen: SeenPlaces
    path: PathRow  # the path just planned, before it is taken
    hull: FloatArray  # [points, 2]
    progress: FloatArray  # [K]
    sole: FloatArray  # [K, 3]
    turn: FloatArray  # [K, 4]
    pitch: FloatArray  # [K, 3]
    bend: FloatArray  # [K, 3]
    hip: FloatArray  # [2, 3] of the foot just planned: now and at touchdown
    held: BoolArray  # [K]
    start: FloatArray  # [K]
    extent: FloatArray  # [K]
    leg_rotation: FloatArray  # [M, 4]
    leg_point: FloatArray  # [M + 1, 3]
    route: RouteScratch
    company: Company  # all creatures of the world, as all threads read them
    node: FloatArray  # [G, 5] where the spine's girdles are to be, see polypod.spine.curve
    more: FloatArray  # [G, 5] the same with what the gait adds
    wish: FloatArray  # [G] rad
    neighbour: IntArray  # [HEEDED] rows of the company
    neighbour_gap: FloatArray  # [HEEDED] m


class Pose(NamedTuple):
    """Where every joint is: views of the herd's state, valid until the next step."""

    position: FloatArray  # [C, J, 3] world, m
    rotation: FloatArray  # [C, J, 4] world, away from the rest pose; x, y, z, w


class Herd:
    """All creatures of one morphology in a world; made by `World.add`.

    Attributes:
        morphology: what they are.
        command: what is asked of them; write to it at any time between steps.
        state: what changes, arrays [creature, ...].
        pose: where every joint is, after the last step.
    """

    def __init__(
        self,
        morphology: Morphology,
        count: int,
        settings: Settings,
        tables: HerdTables | None = None,
    ) -> None:
        """Make a herd that stands nowhere yet; `tables` are the morphology's, if they are made."""
        feet = len(morphology.foot_name)
        joints = len(morphology.joint_node)
        self.morphology = morphology
        self.plan_settings = PlanSettings()
        self.tables = make_tables(morphology) if tables is None else tables
        spine = self.tables.spine
        self.state = make_state(
            count,
            feet,
            joints,
            len(self.tables.girdles.place),
            len(spine.joint),
            len(spine.tail_joint),
        )
        self.command = Command(make_command(count, feet, WAYPOINT_ROOM))
        self.command.body_height = morphology.body.height
        self.command.step_height = self.own_step_height(settings)
        # What kernels take: the same arrays, by reference.
        self.kernel_tables = by_reference(self.tables)
        self.kernel_state = by_reference(self.state)
        self.kernel_command = by_reference(self.command.arrays)
        self.settings = settings
        self.kernel_plan = by_reference(self.plan_settings)
        self._memory: list[Scratch] = []
        self._scratch: list[Scratch] = []
        self._company = make_company([])
        self._watched = -1

    def own_step_height(self, settings: Settings) -> float:
        """Return how high, m, feet are lifted over level ground where nobody says how high."""
        share = step_share(settings, self.tables) * self.tables.leg_length
        return float(min(share, FOLDING * folding_room(self.tables)))

    def take_limits(self, morphology: Morphology, tables: HerdTables) -> None:
        """Go on with other joint limits; `polypod.relimit` judges them first.

        Args:
            morphology: the same creature, limited otherwise.
            tables: its own.
        """
        self.morphology, self.tables = morphology, tables
        self.kernel_tables = by_reference(tables)
        # Working memory refers to the tables.
        self._memory.clear()
        self._scratch.clear()

    def join(self, company: Company, first: int) -> None:
        """Take part in a world's company, its creatures in rows from `first` on."""
        self.state.member[:] = np.arange(first, first + self.count)
        self._company = company
        self._memory.clear()
        self._scratch.clear()

    def push(
        self, velocity: ArrayLike, creature: int | slice = slice(None), *, at: float = 0.0
    ) -> None:
        """Push creatures: a blow that bends their motion, and that they recover from (P2 6).

        The body leaves its path and comes back to it, feet step to where they catch it, and what
        was asked for still counts. Speeds beyond 1.5 sqrt(g x hip height) are cut to that.

        Args:
            velocity: [3] or [creatures, 3], by how much the struck place's velocity changes; world,
                m/s.
            creature: who is pushed; all where omitted.
            at: how far ahead of the body's centre it is struck, m, within the trunk; behind it
                where negative. Away from the centre the body turns as well, and is moved less.

        Raises:
            SettingError: no such creature, no velocity, or a place off the trunk.
        """
        rows, given = self.judge_push(velocity, creature, at)
        state, tables = self.state, self.tables
        blow = strike(given, state.heading[rows], at, tables.body, tables.recovery)
        land_blow(blow, rows, state, tables)
        bend_by_blow(given, at, rows, state, tables)

    def judge_push(
        self, velocity: ArrayLike, creature: int | slice, at: float
    ) -> tuple[IntArray, FloatArray]:
        """Return the rows [N] and velocities [N, 3] of a push; what it refuses is `push`'s."""
        try:
            rows = np.atleast_1d(np.arange(self.count)[creature])
        except (IndexError, TypeError):
            raise SettingError(
                f"creature is {creature!r}; it must be from 0 to {self.count - 1}"
            ) from None
        numbers = numbers_of("a push's velocity", velocity, "m/s")
        if numbers.shape not in ((3,), (len(rows), 3)) or not np.all(np.abs(numbers) <= FASTEST):
            raise SettingError(
                f"a push's velocity is {velocity!r}; it must be x, y, z up to {FASTEST:g} m/s, "
                f"or [{len(rows)}, 3] of them"
            )
        judge_place(self.morphology, at)
        return rows, np.broadcast_to(numbers, (len(rows), 3))

    @property
    def settings(self) -> Settings:
        """How the walk is controlled; may be replaced between steps, and feet do not jump.

        A step height in it counts when the herd is made; later `command.step_height` does.
        """
        return self._settings

    @settings.setter
    def settings(self, settings: Settings) -> None:
        self._settings = settings
        self.kernel_settings = by_reference(settings.values())

    @property
    def count(self) -> int:
        """How many creatures there are."""
        return int(self.state.heading.shape[0])

    @cached_property
    def ladder(self) -> tuple[str, ...]:
        """Names of the gaits that follow speed, from slow to fast; `state.rung` counts them."""
        return ladder_names(self.tables.legs)

    @property
    def gait_name(self) -> tuple[str, ...]:
        """Name of the gait that each creature walks in, or is changing to."""
        pairs = zip(self.state.rung, self.command.gait_name, strict=True)
        return tuple(name if rung == PINNED else self.ladder[rung] for rung, name in pairs)

    @property
    def follows(self) -> bool:
        """Whether any creature follows waypoints."""
        return bool(self.command.arrays.waypoint_count.any())

    @cached_property
    def _extent(self) -> tuple[float, float]:
        """Length of the longest leg, and the most that feet or trunk lie off the centre, m."""
        legs, body = self.morphology.legs, self.morphology.body
        rest = np.abs(legs.sole_stance[:, [0, 2]]).sum(axis=1).max()
        trunk = np.abs(body.half_size).sum() + np.abs(body.box_centre).sum()
        return float(legs.length.max()), float(max(rest, trunk))

    def sight(self, dt: float) -> FloatArray:
        """Return how far [C] from its body each creature may ask for ground in a frame, m.

        Along x or z: footprints are looked for about where the body will be, ways in a map; `dt` is
        the frame's length, s.
        """
        longest, size = self._extent
        searched = SIGHT + max(WIDEST_SEARCH, WIDEST_SPAWN) * self.settings.search_radius
        own = searched * longest + size
        spacing = np.maximum(np.abs(self.command.arrays.spacing), np.abs(self.state.spacing))
        spaced = spacing.sum(axis=2).max(axis=1)
        speed = np.maximum(self.command.arrays.speed, self.state.speed)
        thrown = np.hypot(self.state.deflection[:, 3], self.state.deflection[:, 4])
        off = np.hypot(self.state.deflection[:, 0], self.state.deflection[:, 1])
        pushed = off + thrown * (dt + 1.0 / self.tables.recovery)
        return np.asarray(own + spaced + dt * speed + pushed)

    @property
    def pose(self) -> Pose:
        """Where every joint is, after the last step."""
        return Pose(self.state.joint_position, self.state.joint_rotation)

    def scratch(self, worker: int) -> Scratch:
        """Return the working memory of a thread, made when first asked for."""
        while len(self._scratch) <= worker:
            legs = self.morphology.legs
            feet, most = legs.joint.shape
            path = path_store(1, 1)
            plan = make_plan_scratch(
                self.plan_settings,
                make_legs_ahead(self.tables.ik, legs.section_radius, legs.foot_joint),
                COMPANY_SEGMENTS,
            )
            seen = seen_places(feet, len(plan.found.score))
            seen.who[0] = self._watched
            scratch = Scratch(
                plan=plan,
                seen=seen,
                path=PathRow(*(array[0, 0] for array in path)),
                hull=make_hull_scratch(feet),
                progress=np.zeros(feet),
                sole=np.zeros((feet, 3)),
                turn=np.zeros((feet, 4)),
                pitch=np.zeros((feet, 3)),
                bend=np.zeros((feet, 3)),
                hip=np.zeros((2, 3)),
                held=np.zeros(feet, np.bool_),
                start=np.zeros(feet),
                extent=np.zeros(feet),
                leg_rotation=np.zeros((most, 4)),
                leg_point=np.zeros((most + 1, 3)),
                route=make_route_scratch(),
                company=self._company,
                node=np.zeros((len(self.tables.girdles.place), 5)),
                more=np.zeros((len(self.tables.girdles.place), 5)),
                wish=np.zeros(len(self.tables.girdles.place)),
                neighbour=np.zeros(HEEDED, np.int64),
                neighbour_gap=np.zeros(HEEDED),
            )
            self._memory.append(scratch)
            self._scratch.append(by_reference(scratch))
        return self._scratch[worker]

    def watch(self, creature: int) -> None:
        """Keep from now on what the feet of one creature look at, to be shown; -1: nobody's."""
        if creature == self._watched:
            return
        self._watched = creature
        for scratch in self._memory:
            scratch.seen.who[0] = creature
            scratch.seen.count[:] = 0

    def seen(self, foot: int) -> tuple[FloatArray, FloatArray]:
        """Return the places [N, 3] looked at when a foot of the watched one was planned last.

        With their scores [N]; none before it was planned. Where the direct swing to the preferred
        place was good enough that place is the only one.
        """
        for scratch in self._memory:
            count = int(scratch.seen.count[foot])
            if count:
                return scratch.seen.place[foot, :count], scratch.seen.score[foot, :count]
        return np.zeros((0, 3)), np.zeros(0)
