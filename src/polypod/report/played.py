"""A walk as a player of its GLB shows it."""

from __future__ import annotations

import numpy as np

from polypod.report.arrays import FloatArray
from polypod.report.record import Recording
from polypod.rigs.export import glb_bytes
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.playback import Playback


def soles_played(recording: Recording) -> FloatArray:
    """Return the soles [F, K, 3] read back from the bytes of a recording's GLB, world, m.

    Each is its node's world matrix, at the keys' own float32 times, times the record's foot offset.
    """
    morphology = recording.morphology
    playback = Playback(GltfDocument.from_bytes(glb_bytes(recording), "walk.glb"))
    world = playback.world_matrices(recording.time.astype(np.float32).astype(np.float64))
    offset = np.append(morphology.foot_offset, np.ones((len(morphology.foot_offset), 1)), axis=1)
    soles = np.einsum("fkij,kj->fki", world[:, morphology.foot_node], offset)
    return np.asarray(soles[:, :, :3])
