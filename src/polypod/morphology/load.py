"""From a rig file and the names of its hips and feet to a morphology (P1 3.1)."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError, SettingError, choices
from polypod.morphology.backbone import Middle
from polypod.morphology.builtin import NAMES as BUILT_IN
from polypod.morphology.builtin import build as build_builtin
from polypod.morphology.chains import spine_and_tail
from polypod.morphology.creature import Creature, judge_limits, read_creature
from polypod.morphology.detect import detect_legs
from polypod.morphology.facing import turn_to_face
from polypod.morphology.girdles import find_girdles
from polypod.morphology.layout import arrange, back_to_front
from polypod.morphology.limb import Limb, build_limb
from polypod.morphology.names import split_leg
from polypod.morphology.overrides import override_feet, override_limits
from polypod.morphology.roll import find_rolls
from polypod.morphology.segments import Trunk, build_spine
from polypod.morphology.skeleton import Skeleton, read_skeleton
from polypod.morphology.stance import stand
from polypod.morphology.table import joint_rows, leg_table, stand_upright
from polypod.morphology.trunk import body_centre, measure_trunk
from polypod.morphology.types import BodyTable, Morphology, RigSource
from polypod.rigs.gltf import GltfDocument

FloatArray = NDArray[np.float64]

LARGEST = 1000.0  # m
SMALLEST = 1e-6  # m
SUFFIXES = (".glb", ".gltf", ".toml")


def load_rig(
    rig: str | os.PathLike[str],
    *,
    legs: Sequence[str] | None = None,
    spine: Sequence[str] | None = None,
    forward: str | None = None,
    height: float | None = None,
    body_height: float | None = None,
    weights: Mapping[str, float] | None = None,
    limits: Mapping[str, Mapping[str, object]] | None = None,
) -> Morphology:
    """Read a rig and work out how its creature is built.

    Args:
        rig: path of a .glb or .gltf file, of a creature file (.toml, see
            `polypod.morphology.creature`), or the name of a built-in creature. What is given here
            besides takes the place of what a creature file says.
        legs: "HIP:FOOT" for each leg, nodes by name or #index; None: detected.
        spine: joints by name or #index, from back to head; None: detected.
        forward: the file's direction that the creature faces: "+z", "-z", "+x" or "-x"; None:
            guessed.
        height: m, from the ground to the top of the skin at rest; None: file units are metres.
        body_height: m, preferred height of the body centre above the soles; None: from the rest.
        weights: by a foot's name or #index, how much of the body it carries where others carry 1;
            it counts for the body's vertical motion.
        limits: by a joint's name or #index, how far it turns, as a creature file's `limit` has it;
            {}: as far as follows from its build.

    Returns:
        The morphology, in metres, in the body frame.

    Raises:
        RigError: the file cannot be read, or its legs cannot walk.
        SettingError: an argument is out of its range.
    """
    creature = _ask(rig, legs, spine, forward, height, body_height, weights)
    if limits is not None:
        creature = replace(creature, limit=judge_limits(creature.file, limits))
    named = creature.spine is not None
    document, creature = _open(creature)
    file_skeleton = read_skeleton(document)
    turn, _, facing_guess = turn_to_face(file_skeleton, creature.forward)
    scale = _scale(file_skeleton, creature.height)
    to_frame = np.eye(4)
    to_frame[:3, :3] = scale * turn
    skeleton = file_skeleton.turned(to_frame)
    limbs, guesses = _find_limbs(skeleton, creature)
    if facing_guess:
        guesses.insert(0, facing_guess)
    if creature.height is None and creature.rig not in BUILT_IN:
        size = skeleton.top - skeleton.ground
        guesses.append(
            f"its file units are metres, so it is {size:.4g} m tall; --height says otherwise"
        )
    morphology = _assemble(skeleton, to_frame, limbs, creature, named, guesses)
    return override_limits(override_feet(morphology, skeleton, creature), skeleton, creature)


def _ask(
    rig: str | os.PathLike[str],
    legs: Sequence[str] | None,
    spine: Sequence[str] | None,
    forward: str | None,
    height: float | None,
    body_height: float | None,
    weights: Mapping[str, float] | None,
) -> Creature:
    """Return what is asked for: the creature file's words with the arguments over them."""
    path = Path(rig)
    is_file = path.suffix.lower() == ".toml"
    creature = read_creature(path) if is_file else Creature(str(rig), str(rig))
    for what, value in (("height", height), ("body_height", body_height)):
        if value is not None and not (math.isfinite(value) and 0.0 < value <= LARGEST):
            raise SettingError(
                f"{what}: must be metres above 0 and at most {LARGEST:g}, not {value}"
            )
    if isinstance(legs, str) or isinstance(spine, str):
        raise SettingError('legs and spine: must be lists of texts, as in ["HIP:FOOT"]')
    for name, weight in ({} if weights is None else weights).items():
        if not (isinstance(weight, int | float) and 0.0 < weight < math.inf):
            raise SettingError(f"weights: {name!r}: must be a number above 0, not {weight!r}")
    return replace(
        creature,
        foot_weight=creature.foot_weight if weights is None else dict(weights),
        legs=creature.legs if legs is None else tuple(legs),
        spine=creature.spine if spine is None else tuple(spine),
        forward=creature.forward if forward is None else forward,
        height=creature.height if height is None else float(height),
        body_height=creature.body_height if body_height is None else float(body_height),
    )


def _open(creature: Creature) -> tuple[GltfDocument, Creature]:
    """Return the document, and the creature with what a built-in one says of itself."""
    if creature.rig in BUILT_IN and not Path(creature.rig).is_file():
        made = build_builtin(creature.rig)
        document = GltfDocument.from_bytes(made.glb, f"{creature.rig}.glb")
        if creature.legs is None:
            spine = made.spine if creature.spine is None else creature.spine
            creature = replace(creature, legs=made.legs, spine=spine)
        return document, replace(creature, forward=creature.forward or "+z")
    path = Path(creature.rig)
    if path.suffix.lower() not in SUFFIXES[:2]:
        raise RigError(
            f"{creature.rig}: is no rig: give a file that ends in {choices(SUFFIXES)}, or one of "
            f"{choices(BUILT_IN)}"
        )
    return GltfDocument.read(path), creature


def _scale(skeleton: Skeleton, height: float | None) -> float:
    """Return metres per file unit."""
    size = skeleton.top - skeleton.ground
    file = skeleton.document.name
    if not size > 0.0 or not math.isfinite(size):
        raise RigError(f"{file}: its skin has no height at rest, so its size cannot be told")
    if height is not None:
        return height / size
    extent = float(np.ptp(skeleton.vertex, axis=0).max())
    if not SMALLEST <= extent <= LARGEST:
        raise RigError(
            f"{file}: is {extent:.4g} m large if its units are metres; give its height (--height)"
        )
    return 1.0


def _find_limbs(skeleton: Skeleton, creature: Creature) -> tuple[list[Limb], list[str]]:
    """Return the legs, named or detected, and what was guessed."""
    if creature.legs is None:
        pairs, guesses = detect_legs(skeleton)
    else:
        pairs, guesses = [split_leg(skeleton, text) for text in creature.legs], []
    if not pairs:
        raise RigError(
            f"{skeleton.document.name}: legs: at least one is needed; name them with --leg HIP:FOOT"
        )
    limbs = [build_limb(skeleton, hip, foot) for hip, foot in pairs]
    _refuse_shared(skeleton, limbs)
    guesses.extend(_guesses_by_foot(skeleton, limbs))
    if creature.legs is None:
        layout = arrange(*_hips_and_soles(skeleton, limbs))
        limbs = [limbs[k] for k in back_to_front(layout)]
    return limbs, guesses


def _guesses_by_foot(skeleton: Skeleton, limbs: list[Limb]) -> list[str]:
    """Return one sentence for each thing guessed about feet, naming all the feet it is true of."""
    feet: dict[str, list[str]] = {}
    for limb in limbs:
        single = ("its leg has a single joint and cannot bend",) if len(limb.joints) == 1 else ()
        for guess in (*limb.guesses, *single):
            feet.setdefault(guess, []).append(skeleton.label(limb.foot))
    return [f"{choices(names, 6)}: {guess}; --leg says otherwise" for guess, names in feet.items()]


def _refuse_shared(skeleton: Skeleton, limbs: list[Limb]) -> None:
    """Refuse joints that two legs would both turn."""
    owner: dict[int, Limb] = {}
    for limb in limbs:
        for node in (*limb.joints, *([limb.foot_joint] if limb.foot_joint >= 0 else [])):
            other = owner.setdefault(node, limb)
            if other is not limb:
                raise RigError(
                    f"{skeleton.document.name}: legs: "
                    f'"{skeleton.label(limb.foot)}" and "{skeleton.label(other.foot)}" share '
                    f'"{skeleton.label(node)}"; name a hip of its own for each'
                )


def _hips_and_soles(skeleton: Skeleton, limbs: list[Limb]) -> tuple[FloatArray, FloatArray]:
    hip = skeleton.position[[limb.joints[0] for limb in limbs]]
    return hip, np.array([limb.sole.place for limb in limbs])


def _assemble(
    skeleton: Skeleton,
    to_frame: FloatArray,
    limbs: list[Limb],
    creature: Creature,
    named: bool,
    guesses: list[str],
) -> Morphology:
    """Put stance, trunk, spine and tables together; `named`: the user says what the spine is."""
    hip, sole = _hips_and_soles(skeleton, limbs)
    layout = arrange(hip, sole)
    centre = body_centre(hip) if creature.centre is None else np.array(creature.centre)
    asked = None if creature.body_height is None else float(centre[1]) - creature.body_height
    stance = stand(hip, limbs, layout, asked)
    trunk = measure_trunk(skeleton, limbs, hip, centre)
    body_height = float(centre[1] - stance.sole[0, 1])
    rows, parents = joint_rows(skeleton, limbs)
    body_from_file = to_frame.copy()
    body_from_file[:3, 3] -= centre
    upright = stand_upright(skeleton, limbs, stance.sole)
    rolls = find_rolls(skeleton, limbs, upright, layout)
    legs = leg_table(skeleton, limbs, rolls, layout, stance.sole, rows, centre)
    girdles = find_girdles(legs)
    chains = spine_and_tail(Middle(skeleton, limbs, hip), creature, rows, len(girdles.place))
    # P2's model moves girdles against each other: on a single one a spine bends if a user says so.
    bends = named or len(girdles.place) > 1
    segments, seat_guess = build_spine(
        Trunk(skeleton, centre, rows, parents, legs, girdles), chains if bends else None
    )
    nodes = [
        roll.toe_joint if roll.toe_joint >= 0 else limb.sole_node
        for limb, roll in zip(limbs, rolls, strict=True)
    ]
    return Morphology(
        name=Path(creature.file).stem,
        source=RigSource(skeleton.document, body_from_file, skeleton.rest_file[rows].copy()),
        joint_name=tuple(skeleton.name[node] for node in rows),
        joint_node=np.array(rows, np.int64),
        joint_parent=parents,
        joint_rest=skeleton.position[rows] - centre,
        legs=legs,
        foot_name=tuple(skeleton.label(limb.foot) for limb in limbs),
        foot_node=np.array(nodes, np.int64),
        foot_offset=_in_nodes(skeleton, to_frame, np.array(nodes), legs.sole_rest + centre),
        spine=tuple(rows.index(node) for node in chains.spine),
        segments=segments,
        body=BodyTable(
            thickness=creature.thickness or min(trunk.thickness, 0.9 * body_height),
            height=body_height,
            half_size=trunk.half_size
            if creature.half_size is None
            else np.array(creature.half_size),
            box_centre=trunk.box_centre - centre,
        ),
        guesses=(*guesses, *stance.guesses, *chains.guesses, *seat_guess),
    )


def _in_nodes(
    skeleton: Skeleton, to_frame: FloatArray, nodes: NDArray[np.int64], place: FloatArray
) -> FloatArray:
    """Return [K, 3] places of the frame in the nodes' own frames and units."""
    node_to_frame = to_frame @ skeleton.rest_file[nodes]
    inverse = np.linalg.inv(node_to_frame)
    return np.asarray((inverse[:, :3, :3] @ place[:, :, None])[:, :, 0] + inverse[:, :3, 3])
