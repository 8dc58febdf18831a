"""Plays a document's animation: where each node is at given times (glTF 2.0, section 3.11)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from polypod.rigs.fields import Place
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.nodes import FloatArray, compose, local_parts, parent_first_order

WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}


class Playback:
    """One animation of a document, sampled at any times."""

    def __init__(self, document: GltfDocument, animation: int = -1):
        """Read an animation by its index; negative ones count from the end, so -1 is the last.

        Raises:
            RigError: there is no such animation, or its samplers cannot be read.
        """
        self.document = document
        animations = document.root.parts("animations")
        if not -len(animations) <= animation < len(animations):
            raise document.root.error(
                f"has no number {animation}: there are {len(animations)}", "animations"
            )
        self._place = animations[animation]
        self._samplers = self._place.parts("samplers")
        self._channels = self._read_channels()
        inputs = [self._times(sampler) for sampler in self._samplers]
        self.start = min((float(times[0]) for times in inputs), default=0.0)
        self.end = max((float(times[-1]) for times in inputs), default=0.0)

    def local_matrices(self, times: FloatArray) -> FloatArray:
        """Return [F, N, 4, 4] each node's own matrix at times [F] in seconds."""
        places = self.document.root.parts("nodes")
        parts = [local_parts(place) for place in places]
        posed = {
            path: np.tile(np.array([part[at] for part in parts]), (len(times), 1, 1))
            for at, path in enumerate(("translation", "rotation", "scale"))
        }
        for node, path, sampler in self._channels:
            posed[path][:, node] = self._sample(sampler, path, np.asarray(times, np.float64))
        local = compose(posed["translation"], posed["rotation"], posed["scale"])
        moved = {node for node, _, _ in self._channels}
        at_rest = self.document.node_local_matrices()
        still = [node for node in range(len(places)) if node not in moved]
        local[:, still] = at_rest[still]  # a matrix may hold more than the three parts can
        return local

    def world_matrices(self, times: FloatArray) -> FloatArray:
        """Return [F, N, 4, 4] each node's world matrix at times [F] in seconds."""
        world = self.local_matrices(times)
        parents = self.document.node_parents()
        for node in parent_first_order(parents):
            if parents[node] >= 0:
                world[:, node] = world[:, parents[node]] @ world[:, node]
        return world

    def _read_channels(self) -> list[tuple[int, str, Place]]:
        node_count = len(self.document.root.parts("nodes"))
        channels = []
        for place in self._place.parts("channels"):
            target = place.part("target")
            node, path = target.reference("node", node_count), target.text("path")
            sampler = self._samplers[place.integer("sampler", below=len(self._samplers))]
            if node >= 0 and path in WIDTHS:
                channels.append((node, path, sampler))
        return channels

    def _times(self, sampler: Place) -> FloatArray:
        times = self.document.accessor(sampler.integer("input"))
        if times.ndim != 1 or len(times) == 0 or times.dtype != np.float64:
            raise sampler.error("must be times of type SCALAR", "input")
        if not np.isfinite(times).all() or bool((np.diff(times) <= 0.0).any()):
            raise sampler.error("must be finite times that rise", "input")
        return np.asarray(times, np.float64)

    def _sample(self, sampler: Place, path: str, times: FloatArray) -> FloatArray:
        """Return [F, 3] or [F, 4] a sampler's value at times [F]."""
        keys = self._times(sampler)
        values = self.document.accessor(sampler.integer("output")).astype(np.float64)
        mode = sampler.text("interpolation", "LINEAR")
        if mode not in INTERPOLATIONS:
            known = ", ".join(INTERPOLATIONS)
            raise sampler.error(f"is {mode[:20]!r}, but must be one of {known}", "interpolation")
        each = 3 if mode == "CUBICSPLINE" else 1
        if values.shape != (len(keys) * each, WIDTHS[path]) or not np.isfinite(values).all():
            raise sampler.error(f"must hold {len(keys) * each} finite values of {path}", "output")
        held = np.clip(times, keys[0], keys[-1])
        left = np.clip(np.searchsorted(keys, held, "right") - 1, 0, max(len(keys) - 2, 0))
        right = np.minimum(left + 1, len(keys) - 1)
        span = np.where(right > left, keys[right] - keys[left], 1.0)
        weight = ((held - keys[left]) / span)[:, None]
        sampled = INTERPOLATIONS[mode](values, left, right, weight, span[:, None])
        if path == "rotation":
            sizes = np.linalg.norm(sampled, axis=1, keepdims=True)
            if float(sizes.min(initial=1.0)) < 1e-30:
                raise sampler.error("holds a rotation of length zero", "output")
            sampled = sampled / sizes
        return sampled


def _step(
    values: FloatArray,
    left: NDArray[np.int64],
    right: NDArray[np.int64],
    weight: FloatArray,
    span: FloatArray,
) -> FloatArray:
    return np.where(weight < 1.0, values[left], values[right])


def _linear(
    values: FloatArray,
    left: NDArray[np.int64],
    right: NDArray[np.int64],
    weight: FloatArray,
    span: FloatArray,
) -> FloatArray:
    """Mix neighbours; rotations take the shortest arc (glTF 2.0, appendix C.3 and C.4)."""
    before, after = values[left], values[right]
    if values.shape[1] == 3:
        return before * (1.0 - weight) + after * weight
    cosine = np.einsum("fi,fi->f", before, after)[:, None]
    after = np.where(cosine < 0.0, -after, after)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    sine = np.sin(angle)
    wide = sine > 1e-4
    safe = np.where(wide, sine, 1.0)
    share_before = np.where(wide, np.sin((1.0 - weight) * angle) / safe, 1.0 - weight)
    share_after = np.where(wide, np.sin(weight * angle) / safe, weight)
    return np.asarray(before * share_before + after * share_after)


def _cubic(
    values: FloatArray,
    left: NDArray[np.int64],
    right: NDArray[np.int64],
    weight: FloatArray,
    span: FloatArray,
) -> FloatArray:
    """Hermite spline from in-tangent, value and out-tangent triples (glTF 2.0, appendix C.5)."""
    t, t2, t3 = weight, weight**2, weight**3
    value_before, out_before = values[3 * left + 1], values[3 * left + 2]
    value_after, in_after = values[3 * right + 1], values[3 * right]
    return np.asarray(
        (2.0 * t3 - 3.0 * t2 + 1.0) * value_before
        + span * (t3 - 2.0 * t2 + t) * out_before
        + (-2.0 * t3 + 3.0 * t2) * value_after
        + span * (t3 - t2) * in_after
    )


Interpolation = Callable[
    [FloatArray, NDArray[np.int64], NDArray[np.int64], FloatArray, FloatArray], FloatArray
]
INTERPOLATIONS: dict[str, Interpolation] = {
    "LINEAR": _linear,
    "STEP": _step,
    "CUBICSPLINE": _cubic,
}
