"""What the page fetches to draw the world: skins of the kinds that walk, and the ground about."""

from __future__ import annotations

from collections.abc import Mapping

from polypod.studio.meshes import ground_reach, pack_ground, pack_skin
from polypod.studio.stage import Stage

# The ground is sent anew when the first creature has gone so much of what was sent.
GONE = 0.4


class Drawn:
    """Skins and grounds by their numbers, which count up.

    Attributes:
        skins: as named arrays.
        skin_numbers: of each rig, by the id of its source: other limits are no other skin.
        grounds: as named arrays; the newest has the greatest number.
    """

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self.skins: dict[int, bytes] = {}
        self.skin_numbers: dict[int, int] = {}
        self.grounds: dict[int, bytes] = {}
        self._counter = 0
        self.renew_skins()
        self.renew_ground({})

    @property
    def ground(self) -> int:
        """The number of the newest ground."""
        return max(self.grounds)

    def renew_skins(self) -> None:
        """Make the skins of those who walk now."""
        herds = self._stage.herds
        for herd in herds:
            key = id(herd.morphology.source)
            if key not in self.skin_numbers:
                self._counter += 1
                self.skin_numbers[key] = self._counter
                self.skins[self._counter] = pack_skin(herd.morphology)
        walking = {id(herd.morphology.source) for herd in herds}
        for key, number in list(self.skin_numbers.items()):
            if key not in walking:
                del self.skin_numbers[key]
                self.skins.pop(number, None)

    def renew_ground(self, kept: Mapping[int, bytes]) -> None:
        """Make the ground about the first creature; others stay as they are `kept`."""
        stage = self._stage
        self._counter += 1
        centre = stage.herd.state.position[0].copy()
        reach = ground_reach(stage.herd.tables.leg_length)
        self._ground_at = (centre, reach)
        shown = len(stage.document["obstacle"])
        packed = pack_ground(stage.world.environment, shown, centre, reach)
        self.grounds = {**kept, self._counter: packed}

    @property
    def gone(self) -> bool:
        """Whether the first creature has gone far on the newest ground."""
        centre, reach = self._ground_at
        here = self._stage.herd.state.position[0]
        return max(abs(here[0] - centre[0]), abs(here[2] - centre[2])) > GONE * reach
