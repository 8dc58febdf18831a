"""Settings of the walk, keyword-only, each with its unit.

Lengths are fractions of leg length and times are seconds, or fractions of the gait cycle, so that
one set serves a fly and a dinosaur.

Tuning, by symptom:

* the body nods or shivers over rubble: raise `height_smoothing`, then `tilt_smoothing`;
* the body lags behind a climb or hits a crate: lower `height_smoothing`;
* the creature leans into slopes too much, or its legs do: change `tilt_share`, `upright_lean`;
* steps look like clockwork: `stride_variation`;
* turns look like a turret's: lower `turn_rate`; it misses waypoints: raise it;
* feet hesitate in front of obstacles: raise `wider_search` (costs planning time);
* creatures of a crowd crowd too much, or too little: raise or lower `personal_space`;
* the body bounces or nods too much, or looks as if it floated: `bounce`, `nod`, `vaulting`;
* it rocks from side to side: lower `sway`;
* turns look stiff, or too supple: `spine`; a lizard wriggles too much: `spine_yaw`; a gallop
  arches its back too much: `spine_flexion`; the head looks about too much: `gaze`;
* swing feet twitch when the heading changes: raise `replan_distance`;
* feet scrape or step too high: `step_height`; they start and stop too gently: `swing_profile`;
* a foot's toes or heel hang in the air on steep ground: raise `foot_tilt`, then `ankle_range`;
  ankles look broken there: lower `ankle_range`.
"""

from __future__ import annotations

import dataclasses
import math
from collections import namedtuple
from dataclasses import dataclass
from typing import Any

from polypod.errors import SettingError, choices

# Time profiles of a swing, by number for kernels and by name for people.
PROFILE_BELL = 0
PROFILE_CONSTANT = 1
PROFILES = {"bell": PROFILE_BELL, "constant": PROFILE_CONSTANT}
# Where the body's vertical motion comes from.
MOTION_NONE = 0
MOTION_SINUSOID = 1
MOTION_PARTICLES = 2
MOTIONS = {"particles": MOTION_PARTICLES, "sinusoid": MOTION_SINUSOID, "none": MOTION_NONE}
# Alexander's q of a human walk's two-humped force (BIOMECHANICS 3), and the forces by name; beyond
# 1 a foot would pull.
WALKING_VAULT = 0.4
VAULTS = {"gait": math.nan, "bounce": 0.0, "vault": WALKING_VAULT}
NAMED = {"swing_profile": PROFILES, "body_motion": MOTIONS}


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How a walk is controlled; everything a user may tune and no morphology implies."""

    acceleration: float = 1.6
    """Share of the speed asked for that is gained in a gait cycle."""

    hardest_acceleration: float = 0.5
    """Greatest change of speed, g: what feet find hold for and transitions between gaits time."""

    stride_variation: float = 0.0
    """Standard deviation of the strides' durations, a share: 0.02 to 0.04 in animals. Which stride
    is longer or shorter follows from the world's `seed`."""

    turn_rate: float = 0.35
    """Largest turn rate, radians per leg pendulum time sqrt(leg length / g)."""

    turn_response: float = 2.5
    """Leg pendulum times in which most of an error of heading is made up."""

    step_height: float | None = None
    """Clearance of a swing foot over level ground, leg lengths; None: by the creature's build, the
    middle of what BIOMECHANICS 2 gives for it. A command's `step_height` is in metres and wins."""

    swing_profile: str = "bell"
    """Speed of a swing foot along its path: "bell", from rest to rest as animals do, or "constant",
    P1's (P1 5.2)."""

    late_lift: float = 0.5
    """A foot that could not lift may do so until this share of its swing sector."""

    replan_distance: float = 0.06
    """A swing foot plans anew when its preferred place has moved so far, leg lengths."""

    replan_until: float = 0.75
    """Share of the swing after which a foot keeps its plan."""

    search_radius: float = 0.6
    """Where a footprint is looked for around the preferred place, leg lengths."""

    wider_search: float = 1.2
    """Growth of `search_radius` for each gait cycle that a foot finds no place."""

    height_smoothing: float = 0.35
    """Time in which the body's height follows what it walks over, gait cycles."""

    tilt_smoothing: float = 0.6
    """Time in which pitch and roll follow the feet, gait cycles."""

    tilt_share: float = 0.85
    """How much of the slope under the feet the body takes on; 0 keeps it level."""

    upright_lean: float = 0.5
    """For legs that stand upright: share of that tilt by which the feet stay under the body."""

    body_motion: str = "particles"
    """What moves the body up and down: "particles", one for each foot, driven by the gait (P2 4),
    "sinusoid", P1's, or "none"."""

    bounce: float = 1.0
    """Scale of that motion; above 1 feet may seem to pull."""

    vaulting: str | float = "gait"
    """Force of a foot through its stance: "vault", with the body highest at mid-stance, "bounce",
    with it lowest, or "gait": walks of upright animals vault, all else bounces. Also Alexander's q,
    0 to 1, of which these are 0.4 and 0."""

    nod: float = 1.0
    """Scale of pitch and roll by the gait."""

    sway: float = 1.0
    """Scale of an upright animal's sway toward the feet that stand."""

    spine: float = 1.0
    """How much a spine bends: along the way in turns, by its gait, neck and tail; 0: a rigid trunk
    (P2 5)."""

    spine_yaw: float = 1.0
    """Scale of the yaw of a sprawler's girdles by their feet, P2's visual yaw effect; 0: none."""

    spine_flexion: float = 1.0
    """Scale of the flexion of upright animals' spines by their feet, as in a gallop; 0: none."""

    gaze: float = 1.0
    """How much the head turns toward the way ahead and keeps level; 0: it rides on the chest."""

    tail: float = 1.0
    """How much the tail follows and swings; 0: it is stiff."""

    feedback_share: float = 0.35
    """Share of the mean offset of chosen footprints by which the body shifts (P1 3.2, Fig 7)."""

    feedback_threshold: float = 0.06
    """Mean offset below which it is discarded, leg lengths."""

    spacing_rate: float = 0.5
    """How fast feet spacing moves to a new target, leg lengths a second (P1 Fig 6)."""

    personal_space: float = 1.0
    """Share of the room for its feet that a creature keeps from others; 0: they do not matter."""

    foot_align: float = 1.0
    """Share of the ground's tilt that a foot joint takes on in stance."""

    foot_tilt: float = 0.9
    """Largest tilt of a foot joint to the ground, radians."""

    ankle_range: float = 0.8
    """Largest turn of a foot against its shank, away from the stance, radians: on ground that asks
    for more a foot stands less flat."""

    def __post_init__(self) -> None:
        """Refuse what no walk can use."""
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.name in NAMED:
                if not isinstance(value, str) or value not in NAMED[field.name]:
                    raise SettingError(
                        f"setting {field.name} is {value!r}; choose from "
                        f"{choices(NAMED[field.name])}"
                    )
            elif field.name == "vaulting":
                self._judge_vaulting()
            elif value is None and field.default is None:
                continue
            elif not isinstance(value, int | float) or not 0.0 <= float(value) <= 1e3:
                raise SettingError(
                    f"setting {field.name} is {value!r}; it must be a number from 0 to 1000"
                )

    def _judge_vaulting(self) -> None:
        value = self.vaulting
        if isinstance(value, str):
            if value in VAULTS:
                return
        elif isinstance(value, int | float) and 0.0 <= value <= 1.0:
            return
        raise SettingError(
            f"setting vaulting is {value!r}; choose from {choices(VAULTS)}, or give a number from "
            "0 to 1"
        )

    def values(self) -> Any:
        """Return the settings as a named tuple of floats, as kernels read them.

        A name is its number; what is left to the creature's build or gait is NaN.
        """
        own = dataclasses.asdict(self)
        for name, numbers in NAMED.items():
            own[name] = numbers[own[name]]
        if isinstance(self.vaulting, str):
            own["vaulting"] = VAULTS[self.vaulting]
        return SettingValues(
            *(math.nan if value is None else float(value) for value in own.values())
        )


_names = [field.name for field in dataclasses.fields(Settings)]
SettingValues: Any = namedtuple("SettingValues", _names)  # type: ignore[misc]
