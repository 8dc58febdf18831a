"""Finds the nodes that a user names, and reads what names hint at."""

from __future__ import annotations

import difflib
import re

from polypod.errors import RigError, choices
from polypod.morphology.skeleton import Skeleton

Leg = tuple[int, int]


def find_node(skeleton: Skeleton, text: str, what: str) -> int:
    """Return the node that `text` names: its name, or # and its index.

    Args:
        skeleton: the rig.
        text: what the user wrote.
        what: where they wrote it, for the message: `leg "A:B"`.

    Raises:
        RigError: no node has the name, or several have it.
    """
    file = skeleton.document.name
    found = [node for node, name in enumerate(skeleton.name) if name == text and text]
    if len(found) == 1:
        return found[0]
    index = _index(text)
    if not found and index is not None:
        if index < len(skeleton.name):
            return index
        raise RigError(f"{file}: {what}: has no node {text}; nodes are #0 to #{_last(skeleton)}")
    if found:
        where = choices(f"#{node} (below {_parent_label(skeleton, node)})" for node in found)
        raise RigError(f'{file}: {what}: {len(found)} nodes are named "{text}"; choose {where}')
    raise RigError(f'{file}: {what}: has no node named "{text}"; {near_names(skeleton, text)}')


def near_names(skeleton: Skeleton, text: str) -> str:
    """Return a phrase with the names most like `text`, or the joints' names."""
    named = {name for name in skeleton.name if name}
    lower = {name.lower(): name for name in sorted(named)}
    near = difflib.get_close_matches(text.lower(), list(lower), n=5, cutoff=0.5)
    near += [name for name in sorted(lower) if text and text.lower() in name and name not in near]
    if near:
        return f"near it are {choices((lower[name] for name in near), 8)}"
    joints = [skeleton.label(node) for node in range(len(skeleton.name)) if skeleton.is_joint[node]]
    return f"its joints are {choices(joints)}"


def split_leg(skeleton: Skeleton, text: str) -> Leg:
    """Return hip and foot of "HIP:FOOT"; names may hold colons themselves.

    Raises:
        RigError: there is no colon between two nodes' names, or both name the same node.
    """
    what = f'leg "{text}"'
    places = [at for at, letter in enumerate(text) if letter == ":"]
    sides = [(text[:at].strip(), text[at + 1 :].strip()) for at in places]
    known = [pair for pair in sides if all(_exists(skeleton, side) for side in pair)]
    if not known:
        if not sides or not all(sides[0]):
            raise RigError(
                f"{skeleton.document.name}: {what}: must be HIP:FOOT, two nodes' names or #indices "
                f"with a colon between them; {near_names(skeleton, text.strip(': '))}"
            )
        # Blame the side that is wrong; of several colons, the best one has the other side right.
        half = [p for p in sides if any(_exists(skeleton, side) for side in p)] or sides
        for side in half[0]:
            find_node(skeleton, side, what)
    if len(known) > 1:
        either = choices(f'"{hip}" to "{foot}"' for hip, foot in known)
        raise RigError(
            f"{skeleton.document.name}: {what}: its colons can be read in {len(known)} ways, "
            f"{either}; write #index for one of the nodes"
        )
    hip, foot = (find_node(skeleton, side, what) for side in known[0])
    if hip == foot:
        raise RigError(
            f"{skeleton.document.name}: {what}: hip and foot are the same node; "
            f"below it are {_labels_below(skeleton, hip)}"
        )
    return hip, foot


def _labels_below(skeleton: Skeleton, node: int) -> str:
    below = skeleton.below(node)[1:]
    return choices((skeleton.label(other) for other in below), 12) if below else "no nodes"


def _exists(skeleton: Skeleton, text: str) -> bool:
    index = _index(text)
    return bool(text) and (
        text in skeleton.name or (index is not None and index < len(skeleton.name))
    )


def _index(text: str) -> int | None:
    return int(text[1:]) if re.fullmatch(r"#[0-9]{1,9}", text) else None


def _last(skeleton: Skeleton) -> int:
    return len(skeleton.name) - 1


def _parent_label(skeleton: Skeleton, node: int) -> str:
    parent = int(skeleton.parent[node])
    return f"#{parent} {skeleton.name[parent]}".strip() if parent >= 0 else "the scene"


def words(name: str) -> set[str]:
    """Return a name's words in lower case: FrontUpLeg.L has front, up, leg and l."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Za-z])(?=[0-9])|(?<=[0-9])(?=[A-Za-z])", " ", name)
    return set(re.findall(r"[a-z]+", spaced.lower()))


def has_word(name: str, *hints: str) -> bool:
    """Tell whether one of the name's words begins with one of the hints."""
    return any(word.startswith(hint) for word in words(name) for hint in hints)


def side_hint(name: str) -> int:
    """Return +1 where a name says left, -1 where it says right, 0 where it says neither."""
    found = words(name)
    left = any(word.startswith("left") for word in found) or "l" in found or "左" in name
    right = any(word.startswith("right") for word in found) or "r" in found or "右" in name
    if left or right:
        return int(left) - int(right)
    # Robots and insects: LF_HAA, RHCoxa.
    return {"L": 1, "R": -1}.get(name[:1], 0) if name[1:2].isupper() else 0
