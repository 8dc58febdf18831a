"""The spine and the tail as chains of nodes: as a user names them, or as they are found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from polypod.errors import RigError, choices
from polypod.morphology.backbone import Middle, find_spine, find_tail
from polypod.morphology.creature import Creature
from polypod.morphology.names import find_node
from polypod.morphology.skeleton import Skeleton

LEAST = 3  # joints of a spine that is found where legs hang on a single girdle; with more, 2


class Chains(NamedTuple):
    """Nodes of the spine, from back to head, and of the tail, from the trunk to the tip."""

    spine: list[int]
    tail: list[int]
    guesses: list[str]


def spine_and_tail(
    middle: Middle, creature: Creature, joints: Sequence[int], girdles: int
) -> Chains:
    """Return the chains that a creature names, and those found where it says nothing.

    Args:
        middle: the joints among which they are looked for.
        creature: what is said of it.
        joints: nodes of the joint table.
        girdles: how many there are.

    Raises:
        RigError: what is named is no joint of the trunk, or named twice.
    """
    skeleton, guesses = middle.skeleton, []
    if creature.spine is not None:
        spine = _named(middle, creature.spine, joints, "spine", "from back to head")
    else:
        spine = find_spine(middle)
        spine = spine if len(spine) >= (LEAST if girdles == 1 else 2) else []
        if spine:
            guesses.append(f"its spine {_from_to(skeleton, spine)}; --spine names another")
    if creature.tail is not None:
        tail = _named(middle, creature.tail, joints, "tail", "from the trunk to the tip")
        both = sorted(set(spine) & set(tail))
        if both:
            raise RigError(
                f'{skeleton.document.name}: tail: "{skeleton.label(both[0])}" belongs to the spine'
            )
    else:
        tail = find_tail(middle, spine)
        if tail and spine and girdles > 1 and creature.spine is None:
            guesses.append(f"its tail {_from_to(skeleton, tail)}; a creature file names another")
    return Chains(spine, tail, guesses)


def _from_to(skeleton: Skeleton, chain: list[int]) -> str:
    count = f"{len(chain)} joint{'s' if len(chain) > 1 else ''}"
    return f'runs from "{skeleton.label(chain[0])}" to "{skeleton.label(chain[-1])}", {count}'


def _named(
    middle: Middle, names: Sequence[str], joints: Sequence[int], what: str, order: str
) -> list[int]:
    """Return the nodes that a user names, judged."""
    skeleton, file = middle.skeleton, middle.skeleton.document.name
    nodes = [find_node(skeleton, text, what) for text in names]
    turned = {node for limb in middle.limbs for node in (*limb.joints, limb.foot_joint)}
    for node in nodes:
        if node not in joints:
            valid = choices(skeleton.label(joint) for joint in joints)
            raise RigError(
                f'{file}: {what}: "{skeleton.label(node)}" is no joint of the skin; its joints are '
                f"{valid}"
            )
        if node in turned or nodes.count(node) > 1:
            fault = "belongs to a leg" if node in turned else "is named twice"
            raise RigError(
                f'{file}: {what}: "{skeleton.label(node)}" {fault}; '
                f"name joints of the trunk, {order}"
            )
    return nodes
