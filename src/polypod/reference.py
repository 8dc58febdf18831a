"""Named tuples of arrays passed to kernels as one pointer.

Numba hands a tuple of arrays to a function as some seven words for each array, flattened. A herd's
tables, state and scratch are two hundred arrays: with plain tuples the loop's kernels took 190 s to
compile and most of their time to copy arguments. A reference is the address of a block of words in
which each field lies at a fixed place; kernels read `state.position` from it as from the tuple, and
source and tests need not know the difference.

The words of a field: of an array its address, size and strides; of a number the number; of a
nested named tuple the address of its own block. The reference owns what its block points at.
"""

from __future__ import annotations

import hashlib
from typing import Any, TypeVar

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils, config, imputils
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    NativeValue,
    infer_getattr,
    lower_getattr_generic,
    register_model,
    typeof_impl,
    unbox,
)
from numba.np.arrayobj import populate_array

Tuple = TypeVar("Tuple", bound=tuple[Any, ...])
WORD = 8


class ReferenceType(types.Type):
    """Numba's type of a reference: the fields, their types, and the first word of each."""

    def __init__(self, tuple_name: str, fields: tuple[tuple[str, Any, int], ...]) -> None:
        self.fields = fields
        digest = hashlib.sha256(repr(fields).encode()).hexdigest()[:12]
        super().__init__(name=f"{tuple_name}_{digest}")

    def part(self, *names: str) -> Any:
        """Return the type of a field, or of a field of a field."""
        kind: Any = self
        for name in names:
            kind = kind.field(name)[0]
        return kind

    def field(self, name: str) -> tuple[Any, int] | None:
        """Return type and first word of a field, or None where there is no such field."""
        for field_name, kind, word in self.fields:
            if field_name == name:
                return kind, word
        return None


class Reference:
    """A named tuple's fields as one block of words; see the module."""

    __slots__ = ("_parts", "_words", "address", "kind")

    def __init__(self, value: Any) -> None:
        words: list[int] = []
        fields = []
        self._parts: list[Any] = []
        for name, part in zip(value._fields, value, strict=True):
            kind, own = self._words_of(part)
            fields.append((name, kind, len(words)))
            words.extend(own)
        self._words = np.array(words, np.int64)
        self.address = int(self._words.ctypes.data)
        self.kind = ReferenceType(type(value).__name__, tuple(fields))

    def _words_of(self, part: Any) -> tuple[Any, list[int]]:
        if isinstance(part, np.ndarray):
            if not part.flags.c_contiguous:
                raise ValueError("only C-contiguous arrays can be referred to")
            self._parts.append(part)
            kind = types.Array(numba.from_dtype(part.dtype), part.ndim, "C")
            return kind, [part.ctypes.data, part.size, *part.shape, *part.strides]
        if isinstance(part, tuple):
            nested = Reference(part)
            self._parts.append(nested)
            return nested.kind, [nested.address]
        if isinstance(part, bool | np.bool_):
            return types.boolean, [int(part)]
        if isinstance(part, int | np.integer):
            return types.int64, [int(part)]
        return types.float64, [int(np.float64(part).view(np.int64))]


def by_reference(value: Tuple) -> Tuple:
    """Return what kernels take in place of a named tuple: a reference, or itself without JIT."""
    if config.DISABLE_JIT:  # type: ignore[attr-defined]
        return value
    return Reference(value)  # type: ignore[return-value]


@typeof_impl.register(Reference)
def _typeof_reference(value: Reference, context: Any) -> ReferenceType:
    return value.kind


register_model(ReferenceType)(models.OpaqueModel)


@unbox(ReferenceType)
def _unbox_reference(kind: ReferenceType, value: Any, c: Any) -> NativeValue:
    address = c.pyapi.object_getattr_string(value, "address")
    number = c.pyapi.long_as_longlong(address)
    c.pyapi.decref(address)
    return NativeValue(c.builder.inttoptr(number, cgutils.voidptr_t))


@infer_getattr
class _ReferenceFields(AttributeTemplate):
    key = ReferenceType

    def generic_resolve(self, kind: Any, name: str) -> Any:  # type: ignore[override]
        found = kind.field(name)
        return None if found is None else found[0]


@lower_getattr_generic(ReferenceType)
def _lower_field(context: Any, builder: Any, kind: ReferenceType, value: Any, name: str) -> Any:
    found = kind.field(name)
    assert found is not None  # typed before it is lowered
    field, first = found
    words = builder.bitcast(value, ir.IntType(64).as_pointer())

    def word(index: int) -> Any:
        place = builder.gep(words, [ir.Constant(ir.IntType(64), first + index)], inbounds=True)
        loaded = builder.load(place)
        # The block never changes: loops may keep what they read.
        loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
        return loaded

    if isinstance(field, types.Array):
        result = _load_array(context, builder, field, word)
    elif isinstance(field, ReferenceType):
        result = builder.inttoptr(word(0), cgutils.voidptr_t)
    elif field == types.boolean:
        result = builder.trunc(word(0), ir.IntType(1))
    elif field == types.int64:
        result = word(0)
    else:
        result = builder.bitcast(word(0), ir.DoubleType())
    return imputils.impl_ret_untracked(context, builder, field, result)


def _load_array(context: Any, builder: Any, kind: Any, word: Any) -> Any:
    array = context.make_array(kind)(context, builder)
    data_type = context.get_data_type(kind.dtype).as_pointer()
    itemsize = context.get_abi_sizeof(context.get_data_type(kind.dtype))
    populate_array(
        array,
        data=builder.inttoptr(word(0), data_type),
        shape=cgutils.pack_array(builder, [word(2 + i) for i in range(kind.ndim)]),
        strides=cgutils.pack_array(builder, [word(2 + kind.ndim + i) for i in range(kind.ndim)]),
        itemsize=context.get_constant(types.intp, itemsize),
        meminfo=None,
    )
    return array._getvalue()
