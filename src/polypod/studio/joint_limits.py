"""How far joints turn: what is asked of a creature's, and what the page is told of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from polypod.errors import choices
from polypod.herd import Herd
from polypod.ik.table import BEND_MOST, HIP_LIMIT_ERECT, HIP_LIMIT_SPRAWLING, IkTable
from polypod.morphology.creature import (
    HIP_KEYS,
    SPINE_KEYS,
    Creature,
    judge_limits,
    read_creature,
)
from polypod.morphology.describe import joint_label
from polypod.morphology.load import load_rig
from polypod.morphology.overrides import override_limits
from polypod.morphology.skeleton import Skeleton, read_skeleton
from polypod.morphology.types import FloatArray, LegTable, Morphology
from polypod.state import HerdTables

Facts = dict[str, Any]
Joint = tuple[int, int]  # leg, and number in it, 0 its hip
# A leg may miss where it stands by so much of its length: the body stands lower, or aslant.
CROUCH = 0.1


class LimitedRig:
    """A rig that was read once, to be limited in any way.

    Attributes:
        morphology: limited as follows from its build alone.
        said: what its creature file says of limits, as a document does; {} where it has none.
    """

    def __init__(self, file: Any, asked: Mapping[str, Any]) -> None:
        """Read a rig.

        Args:
            file: of the rig or its creature, or a built-in's name.
            asked: `leg`, `spine`, `forward`, `height` and `body_height` as a document has them.

        Raises:
            PolypodError: it cannot be read, or not so.
        """
        self.morphology = load_rig(
            file,
            legs=asked.get("leg"),
            spine=asked.get("spine"),
            forward=asked.get("forward"),
            height=asked.get("height"),
            body_height=asked.get("body_height"),
            limits={},
        )
        path = Path(file)
        self.said: dict[str, Any] = {}
        if path.suffix.lower() == ".toml":
            self.said = {
                name: {
                    key: list(angles) if len(angles) > 1 else angles[0]
                    for key, angles in said.items()
                }
                for name, said in read_creature(path).limit.items()
            }

    @cached_property
    def _skeleton(self) -> Skeleton:
        return read_skeleton(self.morphology.source.document)

    def limited(self, limits: Mapping[str, Any] | None) -> Morphology:
        """Return the creature with a document's limits; None: with those of its file.

        Raises:
            RigError: they name no joint that turns, or give one what is not its own.
        """
        asked = judge_limits("the creature", self.said if limits is None else limits)
        if not asked:
            return self.morphology
        creature = Creature("the creature", self.morphology.name, limit=asked)
        return override_limits(self.morphology, self._skeleton, creature)


def why_not_standing(limited: Morphology, ik: IkTable, joints: Iterable[Joint]) -> str | None:
    """Return in a sentence which of some joints keeps its leg from its stance; None: none does.

    A leg is as long as its hinges let it be; a little shorter or longer the body makes up for.

    Args:
        limited: the creature with its limits.
        ik: its legs.
        joints: leg and number of each that may be to blame, those first that were changed last.
    """
    for leg, joint in joints:
        if not np.isfinite(limited.legs.bend_limit[leg, joint]).any():
            continue
        wanted = float(np.linalg.norm(ik.effector_stance[leg] - ik.hip_rest[leg]))
        shortest, longest = float(ik.shortest[leg]), float(ik.longest[leg])
        fault = None
        if wanted > longest + CROUCH * ik.chain_length[leg]:
            fault = f"reaches {longest:.3g} m from the hip at most"
        elif wanted < shortest - CROUCH * ik.chain_length[leg]:
            fault = f"folds to {shortest:.3g} m from the hip at least"
        if fault is not None:
            return (
                f"{joint_label(limited, int(limited.legs.joint[leg, joint]))} cannot be limited "
                f"so: its leg to {limited.foot_name[leg]} {fault} then, and {limited.name} stands "
                f"with it at {wanted:.3g} m"
            )
    return None


def why_not_stepping(herd: Herd, before: HerdTables) -> str | None:
    """Return in a sentence which of a herd's joints keeps a leg from any step; None: none does.

    `before`: the tables that the herd had until now. A leg that took no step then is not judged.
    """
    travel = herd.tables.ik.stance_travel
    for leg, joint in changed_joints(before.legs, herd.morphology.legs):
        if travel[leg] <= 0.0 < before.ik.stance_travel[leg]:
            row = int(herd.morphology.legs.joint[leg, joint])
            return (
                f"{joint_label(herd.morphology, row)} cannot be limited so: its leg to "
                f"{herd.morphology.foot_name[leg]} can take no step then"
            )
    return None


def cannot_be(limited: Morphology, joints: Iterable[Joint]) -> str:
    """Return a sentence where nothing is known but that a creature cannot stand."""
    names = choices(joint_label(limited, int(limited.legs.joint[pair])) for pair in joints)
    return (
        f"{names or 'its joints'} cannot be limited so: {limited.name} cannot stand then, for not "
        "every foot finds a place within reach"
    )


def hinges_said(legs: LegTable) -> list[Joint]:
    """Return leg and number of each hinge whose limits are said."""
    return [(int(k), int(m)) for k, m in np.argwhere(np.isfinite(legs.bend_limit[:, :, 0]))]


def changed_joints(before: LegTable, after: LegTable) -> Iterator[Joint]:
    """Yield leg and number of each joint whose limits are others."""
    for leg, count in enumerate(after.joint_count):
        for joint in range(int(count)):
            pairs = [(before.bend_limit[leg, joint], after.bend_limit[leg, joint])]
            if joint == 0:
                pairs.append((before.hip_limit[leg], after.hip_limit[leg]))
            if not all(np.array_equal(one, other, equal_nan=True) for one, other in pairs):
                yield leg, joint


def list_limits(herd: Herd, rig: LimitedRig) -> list[Facts]:
    """Return for each joint that turns how far it does, what that is by default, and how to see it.

    A `hinge` of a leg turns about its `axis` against row `of` of the pose; a `hip` away from its
    `stance` (a quaternion), flexed about `flexion` and twisted about `limb`; joints of `spine` and
    `tail` by yaw, pitch and roll. All at rest in the body frame.
    """
    call = _Names(herd.morphology)
    return [*_hips_and_hinges(herd, call), *_spine_joints(herd, rig.morphology, call)]


class _Names:
    """How documents call joints: by their names where these are the only ones, else by number."""

    def __init__(self, morphology: Morphology) -> None:
        self.morphology = morphology
        nodes = morphology.source.document.json.get("nodes", [])
        self.count = Counter(node.get("name") for node in nodes)

    def of(self, row: int) -> Facts:
        """Return how the joint of a row is known."""
        name, node = self.morphology.joint_name[row], int(self.morphology.joint_node[row])
        plain = name if name and self.count[name] == 1 else f"#{node}"
        return {"joint": row, "node": node, "name": plain}


def _hips_and_hinges(herd: Herd, call: _Names) -> Iterator[Facts]:
    ik, legs, spine = herd.tables.ik, herd.morphology.legs, herd.morphology.segments
    for leg, count in enumerate(ik.joint_count):
        segment = int(spine.of_leg[leg])
        carrier = int(spine.joint[segment]) if segment >= 0 else len(herd.morphology.joint_node)
        usual = HIP_LIMIT_ERECT if legs.upright[leg] else HIP_LIMIT_SPRAWLING
        yield {
            **call.of(int(legs.joint[leg, 0])),
            "kind": "hip",
            "leg": leg,
            "index": 0,
            "of": carrier,
            "stance": _listed(ik.hip_stance[leg]),
            "limb": _listed(ik.limb_axis[leg]),
            "flexion": _listed(ik.flexion_axis[leg]),
            "turns": _either_way(HIP_KEYS, ik.hip_limit[leg], usual),
        }
        for joint in range(1, int(count)):
            axis, rest = ik.axis[leg, joint], float(ik.bend_rest[leg, joint])
            if not axis.any():
                continue  # it does not bend
            turn = {
                "key": "bend",
                "least": float(ik.turn_low[leg, joint]),
                "most": float(ik.turn_high[leg, joint]),
                "default": [min(-rest, 0.0), max(BEND_MOST - rest, 0.0)],
            }
            yield {
                **call.of(int(legs.joint[leg, joint])),
                "kind": "hinge",
                "leg": leg,
                "index": joint,
                "of": int(legs.joint[leg, joint - 1]),
                "axis": _listed(axis),
                "turns": [turn],
            }


def _spine_joints(herd: Herd, built: Morphology, call: _Names) -> Iterator[Facts]:
    spine, usual = herd.morphology.segments, built.segments
    for index, row in enumerate(spine.joint):
        hinge = int(spine.hinge[index])
        if not 0 < hinge < len(spine.joint):
            continue  # at the end nothing is behind it
        yield {
            **call.of(int(row)),
            "kind": "spine",
            "leg": -1,
            "index": index,
            "moves": int(spine.joint[hinge]),
            "of": int(spine.joint[hinge - 1]),
            "turns": _either_way(SPINE_KEYS, spine.limit[hinge], usual.limit[hinge]),
        }
    for index, row in enumerate(spine.tail_joint):
        behind = spine.tail_joint[index - 1] if index else spine.joint[0]
        yield {
            **call.of(int(row)),
            "kind": "tail",
            "leg": -1,
            "index": index,
            "moves": int(row),
            "of": int(behind),
            "turns": _either_way(SPINE_KEYS, spine.tail_limit[index], usual.tail_limit[index]),
        }


def _either_way(keys: tuple[str, ...], limit: FloatArray, usual: FloatArray) -> list[Facts]:
    pairs = zip(keys, limit.tolist(), usual.tolist(), strict=True)
    return [
        {"key": key, "least": -most, "most": most, "default": [-default, default]}
        for key, most, default in pairs
    ]


def _listed(values: FloatArray) -> list[float]:
    return [round(float(v), 6) for v in values]
