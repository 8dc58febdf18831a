"""What was found in a rig, as text: `polypod rig` prints it."""

from __future__ import annotations

import numpy as np

from polypod.errors import choices
from polypod.morphology.girdles import find_girdles
from polypod.morphology.roll import FLAT, HEEL_FIRST
from polypod.morphology.types import FloatArray, Morphology

SIDES = {1: "left", 0: "middle", -1: "right"}


def describe(morphology: Morphology) -> str:
    """Return a description of what was found: sizes, legs, limits, spine, joints and guesses.

    Sizes are in metres, angles in degrees.
    """
    parts = [_size(morphology), _legs(morphology), _limits(morphology), _spine(morphology)]
    parts += [_girdles(morphology), _joints(morphology), _guesses(morphology)]
    return "\n\n".join(part for part in parts if part)


def joint_label(morphology: Morphology, row: int) -> str:
    """Return a joint's name, or # and its node index where it has none of its own."""
    name = morphology.joint_name[row]
    unique = name and morphology.joint_name.count(name) == 1
    return name if unique else f"#{morphology.joint_node[row]} {name}".rstrip()


def _size(morphology: Morphology) -> str:
    body, legs = morphology.body, morphology.legs
    width, height, length = 2.0 * body.half_size
    scale = float(np.cbrt(np.linalg.det(morphology.source.body_from_file[:3, :3])))
    return "\n".join(
        [
            f"{morphology.name}: {_count(len(legs.length), 'leg')}, "
            f"{_count(len(morphology.joint_name), 'joint')}, one file unit is {scale:.4g} m",
            f"body centre {body.height:.4g} m above the ground in stance, belly "
            f"{body.thickness:.4g} m below it",
            f"trunk {width:.4g} wide, {height:.4g} high, {length:.4g} long (m)",
        ]
    )


def _legs(morphology: Morphology) -> str:
    lines = ["legs, 0 hindmost (lengths and places in m from the body centre: left, up, forward)"]
    legs = morphology.legs
    for k, foot in enumerate(morphology.foot_name):
        turned = int(legs.joint_count[k])
        chain = " > ".join(joint_label(morphology, int(row)) for row in legs.joint[k, :turned])
        end = "the sole is fixed to the last"
        if legs.foot_joint[k] >= 0:
            end = f"then the foot {joint_label(morphology, int(legs.foot_joint[k]))}"
        sections = np.linalg.norm(np.diff(legs.point_rest[k, : turned + 1], axis=0), axis=1)
        at_rest, in_stance = extensions(morphology)[:, k]
        posture = "upright" if legs.upright[k] else "sprawling"
        lines += [
            f"  {foot}: row {legs.row[k]} {SIDES[int(legs.side[k])]}, {posture}, "
            f"{legs.length[k]:.4g} long, sections {' '.join(f'{s:.4g}' for s in sections)}",
            f"    {chain}; {end}",
            f"    extended {at_rest:.0%} at rest, {in_stance:.0%} in stance; sole at "
            f"{_place(legs.sole_stance[k])}, {_size_of_foot(legs.foot_half_size[k])}"
            f"{_roll_of_foot(morphology, k)}",
        ]
    return "\n".join(lines)


def extensions(morphology: Morphology) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Return [2, K]: hip to effector over the length of the chain, at rest and in stance."""
    legs = morphology.legs
    found = np.zeros((2, len(legs.length)))
    for k in range(len(legs.length)):
        points = legs.point_rest[k, : int(legs.joint_count[k]) + 1]
        chain = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        shift = legs.sole_stance[k] - legs.sole_rest[k]
        found[0, k] = np.linalg.norm(points[-1] - points[0]) / chain
        found[1, k] = np.linalg.norm(points[-1] + shift - points[0]) / chain
    return found


def _limits(morphology: Morphology) -> str:
    legs, lines = morphology.legs, []
    for k in range(len(legs.length)):
        for m in range(int(legs.joint_count[k])):
            joint = joint_label(morphology, int(legs.joint[k, m]))
            if m == 0 and np.isfinite(legs.hip_limit[k]).any():
                names = ("flexion", "sideways", "twist")
                angles = zip(names, np.degrees(legs.hip_limit[k]), strict=True)
                said = ", ".join(f"{name} {a:.0f}" for name, a in angles if np.isfinite(a))
                lines.append(f"  {joint}: {said} degrees")
            elif np.isfinite(legs.bend_limit[k, m]).all():
                low, high = np.degrees(legs.bend_limit[k, m])
                lines.append(f"  {joint}: bend {low:.0f} to {high:.0f} degrees about the rest")
    if not lines:
        return "joint limits: defaults from the rest pose's bends; a creature file sets others"
    return "\n".join(["joint limits (others: defaults from the rest pose's bends)", *lines])


def _spine(morphology: Morphology) -> str:
    table, named = (
        morphology.segments,
        " > ".join(joint_label(morphology, row) for row in morphology.spine),
    )
    if not len(table.joint):
        rigid = f"spine: {named or 'none'}; the trunk moves as one piece"
        return rigid if named else f"{rigid}; --spine J,J,... names one"
    lines = [
        f"spine: {named}",
        "  segments, from back to head (length in m; yaw, pitch, roll against the one behind)",
    ]
    for s, row in enumerate(table.joint):
        turn = table.limit[s] if s else None
        lines.append(
            f"  {_segment(morphology, int(row), table.bone_length[s], turn)}{_parts(morphology, s)}"
        )
    for t, row in enumerate(table.tail_joint):
        said = _segment(morphology, int(row), table.tail_length[t], table.tail_limit[t])
        lines.append(f"  {said}, tail{_riders(morphology, len(table.joint) + t)}")
    return "\n".join(lines)


def _segment(morphology: Morphology, row: int, length: float, limit: FloatArray | None) -> str:
    said = f"{joint_label(morphology, row)}: {length:.4g}"
    if limit is not None:
        said += ", turns " + " ".join(f"{angle:.0f}" for angle in np.degrees(limit)) + " degrees"
    return said


def _parts(morphology: Morphology, segment: int) -> str:
    """Say what part of the body a segment of the spine is, and what hangs and rides on it."""
    table = morphology.segments
    part = ", head" if segment == table.head else ", neck" if segment >= table.neck else ""
    feet = [
        foot for foot, s in zip(morphology.foot_name, table.of_leg, strict=True) if s == segment
    ]
    legs = f", carries the legs to {', '.join(feet)}" if feet else ""
    return f"{part}{legs}{_riders(morphology, segment)}"


def _riders(morphology: Morphology, segment: int) -> str:
    """Name the joints that ride on a segment, but not those below them."""
    table, parents = morphology.segments, morphology.joint_parent
    own = {-1, *table.joint.tolist(), *table.tail_joint.tolist()}
    riders = [
        joint_label(morphology, row)
        for row in np.flatnonzero(table.of_joint == segment).tolist()
        if row not in own and (parents[row] in own or table.of_joint[parents[row]] < 0)
    ]
    return f"; with it {choices(riders)}" if riders else ""


def _girdles(morphology: Morphology) -> str:
    girdles = find_girdles(morphology.legs)
    if len(girdles.place) == 1:
        return "girdles: one, all legs hang on it"
    said = (
        f"{count} legs at {place:.3g} m with {weight:.0%} of the weight"
        for count, place, weight in zip(
            np.bincount(girdles.of_leg), girdles.place, girdles.weight, strict=True
        )
    )
    return f"girdles, forward of the body centre: {'; '.join(said)}"


def _joints(morphology: Morphology) -> str:
    depth = np.zeros(len(morphology.joint_name), np.int64)
    children: dict[int, list[int]] = {}
    for row, parent in enumerate(morphology.joint_parent):
        depth[row] = 0 if parent < 0 else depth[parent] + 1
        children.setdefault(int(parent), []).append(row)
    lines, waiting = ["joints (node: place at rest in m from the body centre)"], [-1]
    while waiting:
        row = waiting.pop()
        if row >= 0:
            indent = "  " * (int(depth[row]) + 1)
            name = morphology.joint_name[row] or "without a name"
            place = _place(morphology.joint_rest[row])
            lines.append(f"{indent}{name} (#{morphology.joint_node[row]}: {place})")
        waiting.extend(reversed(children.get(row, [])))
    return "\n".join(lines)


def _guesses(morphology: Morphology) -> str:
    if not morphology.guesses:
        return "guessed: nothing"
    return "\n".join(["guessed:", *(f"  {guess}" for guess in morphology.guesses)])


def _place(place: np.ndarray[tuple[int], np.dtype[np.float64]]) -> str:
    return " ".join(f"{value + 0.0:.4g}" for value in np.round(place, 6))


def _size_of_foot(half_size: np.ndarray[tuple[int], np.dtype[np.float64]]) -> str:
    return f"{2.0 * half_size[0]:.3g} wide, {2.0 * half_size[1]:.3g} long"


def _roll_of_foot(morphology: Morphology, k: int) -> str:
    legs = morphology.legs
    if legs.roll_kind[k] == FLAT:
        return ""
    first = "heel" if legs.roll_kind[k] == HEEL_FIRST else "toes"
    about = "the front of its sole"
    if legs.toe_joint[k] >= 0:
        about = joint_label(morphology, int(legs.toe_joint[k]))
    return f", lands {first} first and rolls off about {about}"


def _count(number: int, word: str) -> str:
    return f"{number} {word}{'' if number == 1 else 's'}"
