# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Arrays in and out: memory that the library borrows, and memory of the library that arrays show."""
from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _bindings as b
from ._context import Handle, call_depth
from ._errors import ArgumentError, EwaWarning

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


def exported(handle: Handle, attribute: b.ewa_attribute, count: int) -> Array:
    """A stream of a cloud, read-only: shape (count, k), or (count,) for one number per point."""
    width, dtype = attribute.component_count, DTYPE_OF[attribute.type]
    shape = (count,) if width == 1 else (count, width)
    strides = (attribute.stride_bytes,) if width == 1 else (attribute.stride_bytes, dtype.itemsize)
    return export(handle, attribute.data, shape, dtype, strides)


def _converted(array: Array, label: str) -> Array:
    """The same numbers in a type that the library has: half floats as floats, 64-bit integers, as lists make them, in 32 bits
    where these hold them, all else as doubles. Whole numbers that doubles round are said to be."""
    if array.dtype == np.float16:
        return array.astype(np.float32)
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8:
        low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
        for dtype in (np.int32, np.uint32):
            if np.iinfo(dtype).min <= low and high <= np.iinfo(dtype).max:
                return array.astype(dtype)
        if max(-low, high) > 2**53:
            warnings.warn(f"{label}: whole numbers beyond 2^53 are rounded to doubles", EwaWarning, stacklevel=call_depth())
        return array.astype(np.float64)
    return array.astype(np.float64) if array.dtype.kind == "f" else array


def _plain(value: Any, label: str) -> Any:
    """What numpy makes an array of: tensors and whatever else has DLPack, from the processor's memory; columns of tables
    whose numbers may be missing, which become NaN."""
    if isinstance(value, np.ndarray):
        return value
    if hasattr(value, "detach") and hasattr(value, "cpu"):  # torch: off its graph and its device
        value = value.detach().cpu()
        return value.float().numpy() if str(value.dtype) == "torch.bfloat16" else value.numpy()
    if hasattr(value, "__dlpack__") and not hasattr(value, "__array__"):
        return np.from_dlpack(value)
    kind = getattr(value, "dtype", None)
    if kind is not None and not isinstance(kind, np.dtype) and hasattr(value, "isna"):  # types of pandas's own
        return value.to_numpy(np.float64, na_value=np.nan) if value.isna().any() else value.to_numpy(kind.numpy_dtype)
    return value


def as_numbers(value: Any, label: str) -> Array:
    """An array of a type that the library has, the given one itself where it is of such."""
    if isinstance(value, np.ma.MaskedArray):
        raise ArgumentError(f"{label}: a masked array; fill it first, with NaN where nothing is")
    try:
        array = np.asarray(_plain(value, label))
    except (AttributeError, BufferError, RuntimeError, TypeError, ValueError) as error:
        raise ArgumentError(f"{label}: no array: {error}") from None
    if array.dtype == np.dtype(bool):
        array = array.view(np.uint8)
    if not array.dtype.isnative and array.dtype.newbyteorder("=") in TYPE_OF:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype not in TYPE_OF:
        array = _converted(array, label)
    if array.dtype not in TYPE_OF:
        raise ArgumentError(f"{label}: numbers of type {array.dtype}, which are no real ones")
    return array


def as_colors(value: Any, label: str) -> Array:
    """Colours whose whole numbers are codes of all their type's bits: those of 32 bits and more, as lists and tables have
    them, become codes of 8 bits, where none is above 255, or of 16."""
    array = as_numbers(value, label)
    if array.dtype.kind in "iu" and array.itemsize > 2 and array.size and int(array.min()) >= 0:
        high = int(array.max())
        if high < 2**16:
            return array.astype(np.uint8 if high < 2**8 else np.uint16)
    return array


def as_points(value: Any, label: str, copy: bool | None, codes: bool | None = None) -> Array:
    """An array of (n, k) or (n,) numbers that the library can borrow: itself where that may be, else a copy; `codes`: wide whole
    numbers of colours may have fewer bits, by default those of a stream that is called so."""
    if codes is None:
        codes = label in ("colors", "color")
    array = as_colors(value, label) if codes else as_numbers(value, label)
    if array.ndim not in (1, 2) or (array.ndim == 2 and not 1 <= array.shape[1] <= 4):
        raise ArgumentError(f"{label}: shape {array.shape}; (n,) or (n, 1) to (n, 4) is needed")
    size = array.itemsize
    width = array.shape[1] if array.ndim == 2 else 1
    packed = array.ndim == 1 or width == 1 or array.strides[1] == size
    step = array.strides[0] if len(array) > 1 else size * width
    fits = packed and array.flags.aligned and step >= size * width and step % size == 0
    given = _plain(value, label) if copy is False else None
    if isinstance(given, np.ndarray) and not np.shares_memory(array, given) and array.size:
        raise ArgumentError(f"{label}: numbers of type {given.dtype} cannot be borrowed")
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
