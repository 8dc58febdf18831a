"""Creatures that come with the package, made in code: skeleton, skinned mesh, colours."""

from __future__ import annotations

from collections.abc import Callable

from polypod.errors import RigError, choices
from polypod.morphology.builtin import (
    ant,
    biped,
    centaur,
    centipede,
    crab,
    lizard,
    pentapod,
    spider,
    wolf,
)
from polypod.morphology.builtin.sculpture import BuiltIn

_BUILDERS: dict[str, Callable[[], BuiltIn]] = {
    "spider": spider.build,
    "ant": ant.build,
    "crab": crab.build,
    "pentapod": pentapod.build,
    "centipede": centipede.build,
    "wolf": wolf.build,
    "lizard": lizard.build,
    "centaur": centaur.build,
    "biped": biped.build,
}
NAMES = tuple(_BUILDERS)


def build(name: str) -> BuiltIn:
    """Return a built-in creature as a GLB with the names of its legs and spine.

    It stands on the plane y = 0 facing +Z, its left toward +X, in metres; the bind pose is the node
    pose. Legs of pairs are numbered from the front, as zoologists do.

    Raises:
        RigError: there is no built-in of that name.
    """
    if name not in _BUILDERS:
        raise RigError(f'there is no built-in creature "{name}"; choose from {choices(NAMES)}')
    return _BUILDERS[name]()


__all__ = ["NAMES", "BuiltIn", "build"]
