# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Arrays in and out: memory that the library borrows, and memory of the library that arrays show."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _bindings as b
from ._context import Handle
from ._errors import ArgumentError

Array = npt.NDArray[Any]

_T = b.ewa_type
#: ewa_type of each type of numpy, and the other way.
TYPE_OF: dict[np.dtype[Any], int] = {np.dtype(np.float32): int(_T.EWA_F32), np.dtype(np.float64): int(_T.EWA_F64),
           np.dtype(np.int8): int(_T.EWA_I8), np.dtype(np.uint8): int(_T.EWA_U8),
           np.dtype(np.int16): int(_T.EWA_I16), np.dtype(np.uint16): int(_T.EWA_U16),
           np.dtype(np.int32): int(_T.EWA_I32), np.dtype(np.uint32): int(_T.EWA_U32)}
DTYPE_OF: dict[int, np.dtype[Any]] = {number: dtype for dtype, number in TYPE_OF.items()}


class _Exporter:
    """Memory of a handle as numpy sees it; the array's base, so that the handle lives as long as the array."""

    __slots__ = ("handle", "__array_interface__")

    def __init__(self, handle: Handle, interface: dict[str, Any]) -> None:
        self.handle = handle
        self.__array_interface__ = interface
        handle.exports += 1

    def __del__(self) -> None:
        self.handle.exports -= 1


def export(handle: Handle, address: int | None, shape: tuple[int, ...], dtype: np.dtype[Any],
           strides: tuple[int, ...] | None = None) -> Array:
    """An array, read-only, that shows memory of a handle."""
    if not address or 0 in shape:
        return np.empty(shape, dtype)
    return np.asarray(_Exporter(handle, {"version": 3, "data": (address, True), "shape": shape, "typestr": dtype.str,
                                         "strides": strides}))


def _converted(array: Array) -> Array:
    """The same numbers in a type that the library has, where one holds all of them: 64-bit integers, as lists make them, in
    32 bits or as doubles, half floats as floats. Else the array as it is."""
    if array.dtype == np.float16:
        return array.astype(np.float32)
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8:
        low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
        for dtype in (np.int32, np.uint32):
            if np.iinfo(dtype).min <= low and high <= np.iinfo(dtype).max:
                return array.astype(dtype)
        if max(-low, high) <= 2**53:
            return array.astype(np.float64)
    return array


def as_numbers(value: Any, label: str) -> Array:
    """An array of a type that the library has, the given one itself where it is of such."""
    if isinstance(value, np.ma.MaskedArray):
        raise ArgumentError(f"{label}: a masked array; fill it first, with NaN where nothing is")
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"{label}: no array: {error}") from None
    if array.dtype == np.dtype(bool):
        array = array.view(np.uint8)
    if not array.dtype.isnative and array.dtype.newbyteorder("=") in TYPE_OF:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype not in TYPE_OF:
        array = _converted(array)
    if array.dtype not in TYPE_OF:
        raise ArgumentError(f"{label}: numbers of type {array.dtype}; there are "
                            f"{', '.join(str(dtype) for dtype in TYPE_OF)}")
    return array


def as_points(value: Any, label: str, copy: bool | None) -> Array:
    """An array of (n, k) or (n,) numbers that the library can borrow: itself where that may be, else a copy."""
    array = as_numbers(value, label)
    if array.ndim not in (1, 2) or (array.ndim == 2 and not 1 <= array.shape[1] <= 4):
        raise ArgumentError(f"{label}: shape {array.shape}; (n,) or (n, 1) to (n, 4) is needed")
    size = array.itemsize
    width = array.shape[1] if array.ndim == 2 else 1
    packed = array.ndim == 1 or width == 1 or array.strides[1] == size
    step = array.strides[0] if len(array) > 1 else size * width
    fits = packed and array.flags.aligned and step >= size * width and step % size == 0
    if copy is False and isinstance(value, np.ndarray) and not np.shares_memory(array, value) and array.size:
        raise ArgumentError(f"{label}: numbers of type {value.dtype} cannot be borrowed")
    if copy is False and not fits:
        raise ArgumentError(f"{label}: strides {array.strides} of {size}-byte numbers cannot be borrowed")
    return array if fits and not copy else np.array(array, order="C", copy=True)


def as_contiguous(value: Any, dtype: Any, shape: tuple[int | None, ...], label: str) -> Array:
    """An array of just this type and shape (None: any length), C-contiguous; numbers are converted safely."""
    array = as_numbers(value, label)
    wanted = np.dtype(dtype)
    if array.ndim != len(shape) or any(s is not None and s != n for s, n in zip(shape, array.shape)):
        text = ", ".join("n" if s is None else str(s) for s in shape)
        raise ArgumentError(f"{label}: shape {array.shape}; ({text}) is needed")
    if array.dtype != wanted and not np.can_cast(array.dtype, wanted, "same_kind"):
        raise ArgumentError(f"{label}: numbers of type {array.dtype}; {wanted} is needed")
    return np.require(array, wanted, ["C", "A"])
