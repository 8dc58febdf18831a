"""Joint limits that change while creatures walk."""

from __future__ import annotations

import numpy as np

from polypod.herd import Herd
from polypod.ik.skeleton import pose_joints
from polypod.morphology.types import Morphology
from polypod.tables import make_tables
from polypod.world import World


def relimit(herd: Herd, morphology: Morphology) -> None:
    """Let the creatures of a herd go on with other joint limits.

    They go on from where they are; what is bent farther than is allowed now comes within the
    limits at once.

    Args:
        herd: of any world.
        morphology: what they are, limited otherwise.

    Raises:
        SettingError: so limited they could not stand on level ground; nothing has changed.
    """
    tables = make_tables(morphology, herd.tables)
    World(threads=1).enter(Herd(morphology, 1, herd.settings, tables))
    herd.take_limits(morphology, tables)
    most = np.concatenate([tables.spine.limit, tables.spine.tail_limit])
    most[: min(1, len(tables.spine.joint))] = np.inf  # the hindmost turns against the body, freely
    np.clip(herd.state.spine_angle, -most, most, out=herd.state.spine_angle)
    scratch = herd.scratch(0)
    for c in range(herd.count):
        pose_joints(c, herd.kernel_state, herd.kernel_tables, scratch)
