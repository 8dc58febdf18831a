"""Reads accessors (glTF 2.0, 5.1): views of the buffers, judged before a byte is allocated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from polypod.rigs.fields import Place

Buffer = bytes | memoryview
DataType: TypeAlias = "np.dtype[Any]"

COMPONENT_TYPES: dict[int, DataType] = {
    5120: np.dtype("<i1"),
    5121: np.dtype("<u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
# Columns and rows of each type.
SHAPES = {
    "SCALAR": (1, 1),
    "VEC2": (1, 2),
    "VEC3": (1, 3),
    "VEC4": (1, 4),
    "MAT2": (2, 2),
    "MAT3": (3, 3),
    "MAT4": (4, 4),
}


@dataclass(frozen=True)
class Layout:
    """What one element of an accessor looks like."""

    dtype: DataType
    columns: int
    rows: int

    @property
    def column_stride(self) -> int:
        """Bytes from a column to the next; a matrix's columns start at multiples of four bytes."""
        tight = self.rows * self.dtype.itemsize
        return tight if self.columns == 1 else (tight + 3) // 4 * 4

    @property
    def size(self) -> int:
        """Bytes of one element."""
        return self.columns * self.column_stride


class AccessorReader:
    """Reads the accessors of one document."""

    def __init__(self, root: Place, buffers: Sequence[Buffer]):
        self.accessors = root.parts("accessors")
        self.views = root.parts("bufferViews")
        self.buffers = buffers
        self.byte_count = sum(len(buffer) for buffer in buffers)

    def read(self, index: int) -> NDArray[Any]:
        """Return [count], [count, n] or [count, n, n]: float64, or int64 for plain integers.

        Matrices are in the order of ordinary mathematics: `matrix @ column`.

        Raises:
            RigError: it does not fit into its buffer or its fields are wrong.
        """
        place = self.accessors[index]
        layout, count = self.layout(place), self.count(place)
        if place.has("bufferView"):
            raw = self._strided(place, layout, count).copy()
        else:
            raw = np.zeros((count, layout.columns, layout.rows), layout.dtype)
        if place.has("sparse"):
            self._apply_sparse(place, layout, raw)
        values = _plain(raw, bool(place.value.get("normalized", False)))
        if layout.columns > 1:
            return values.transpose(0, 2, 1).copy()
        return values.reshape(count) if layout.rows == 1 else values.reshape(count, layout.rows)

    def check(self, index: int) -> None:
        """Judge an accessor's claims against its buffer without reading it.

        Raises:
            RigError: it does not fit into its buffer or its fields are wrong.
        """
        place = self.accessors[index]
        layout, count = self.layout(place), self.count(place)
        if place.has("bufferView"):
            self._strided(place, layout, count)

    def view_bytes(self, index: int) -> Buffer:
        """Return the bytes of a buffer view.

        Raises:
            RigError: it reaches beyond the end of its buffer.
        """
        place = self.views[index]
        buffer = self.buffers[place.integer("buffer", below=len(self.buffers))]
        start, length = place.integer("byteOffset", 0), place.integer("byteLength")
        if start + length > len(buffer):
            raise place.error(
                f"ends at byte {start + length}, but its buffer has {len(buffer)} bytes"
            )
        return memoryview(buffer)[start : start + length]

    def layout(self, place: Place) -> Layout:
        """Return what an element of the accessor looks like.

        Raises:
            RigError: an unknown type or component type.
        """
        kind, component = place.text("type"), place.integer("componentType")
        if kind not in SHAPES:
            raise place.error(f"is {kind[:20]!r}, but must be one of {', '.join(SHAPES)}", "type")
        return Layout(_component(place, component), *SHAPES[kind])

    def count(self, place: Place) -> int:
        """Return the number of elements; one not backed by bytes is held to the file's size.

        Raises:
            RigError: no whole number, or absurdly large.
        """
        count = place.integer("count")
        if not place.has("bufferView") and count > max(self.byte_count, 65536):
            raise place.error(
                f"is {count}, more than the {self.byte_count} bytes of all buffers", "count"
            )
        return count

    def _strided(self, place: Place, layout: Layout, count: int) -> NDArray[Any]:
        index = place.integer("bufferView", below=len(self.views))
        stride = self.views[index].integer("byteStride", layout.size) or layout.size
        if stride < layout.size:
            raise self.views[index].error(
                f"is {stride}, less than the {layout.size} bytes of an element of {place.path}",
                "byteStride",
            )
        return self._window(place, index, layout, count, stride)

    def _window(
        self, place: Place, view_index: int, layout: Layout, count: int, stride: int
    ) -> NDArray[Any]:
        """Return a view [count, columns, rows] of a buffer view's bytes, no copy."""
        view = self.view_bytes(view_index)
        offset = place.integer("byteOffset", 0)
        needed = offset + (count - 1) * stride + layout.size if count else offset
        if needed > len(view):
            raise place.error(
                f"claims {count} elements, {needed} bytes, but its buffer view has {len(view)}"
            )
        shape = (count, layout.columns, layout.rows)
        strides = (stride, layout.column_stride, layout.dtype.itemsize)
        if count == 0:
            return np.zeros(shape, layout.dtype)
        return np.ndarray(shape, layout.dtype, view, offset, strides)

    def _apply_sparse(self, place: Place, layout: Layout, raw: NDArray[Any]) -> None:
        sparse = place.part("sparse")
        count = sparse.integer("count", below=len(raw) + 1)
        indices, values = sparse.part("indices"), sparse.part("values")
        kind = Layout(_component(indices, indices.integer("componentType")), 1, 1)
        index_view = indices.integer("bufferView", below=len(self.views))
        value_view = values.integer("bufferView", below=len(self.views))
        at = self._window(indices, index_view, kind, count, kind.size).reshape(count)
        if kind.dtype.kind != "u" or (count and int(at.max()) >= len(raw)):
            raise indices.error(f"must be unsigned indices below {len(raw)}")
        raw[at.astype(np.int64)] = self._window(values, value_view, layout, count, layout.size)


def _component(place: Place, component: int) -> DataType:
    if component not in COMPONENT_TYPES:
        known = ", ".join(str(number) for number in COMPONENT_TYPES)
        raise place.error(f"is {component}, but must be one of {known}", "componentType")
    return COMPONENT_TYPES[component]


def _plain(raw: NDArray[Any], normalized: bool) -> NDArray[Any]:
    """Return float64 for floats and normalised integers (glTF 2.0, 3.11), else int64."""
    if raw.dtype.kind == "f":
        return raw.astype(np.float64)
    if not normalized:
        return raw.astype(np.int64)
    return np.maximum(raw.astype(np.float64) / float(np.iinfo(raw.dtype).max), -1.0)
