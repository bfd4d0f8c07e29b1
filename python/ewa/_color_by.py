# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Colours that stand for numbers, as ``--color-by`` of the program makes them."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

from ._arrays import Array
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import numbers, table

if TYPE_CHECKING:
    from .cloud import Cloud

_GREY, _CLASSES, _SIGNALS = 128, 1 << 16, ("intensity", "nir", "amplitude", "reflectance")


def _bare(word: str) -> str:
    lower = word.lower()
    return lower[len("scalar_"):] if lower.startswith("scalar_") else lower


def _is_class(values: Array) -> Array:
    with np.errstate(invalid="ignore"):
        made: Array = (values >= 0) & (values < _CLASSES) & (values == np.floor(values))
    return made


def _percentile(finite: Array, percent: float) -> float:
    if not len(finite):
        return 0.0
    rank = int(percent / 100 * (len(finite) - 1) + 0.5)
    return float(np.partition(finite, rank)[rank])


def colors_by(cloud: Cloud, word: str, colormap: str | None, ends_asked: Sequence[float] | None) -> Array:
    """sRGB colours of one number of each point; uint8, shape (n, 3)."""
    values = cloud.scalar(word)
    maps = table("ewa_furniture_options")["colormap"].words
    if colormap is not None and colormap not in maps + ("classes",):
        raise ArgumentError(f"colormap: '{colormap}' is none of {', '.join(maps)}, classes")
    ends: Any = None if ends_asked is None else numbers(ends_asked, 2, "range")
    if colormap == "classes" and ends is not None:
        raise ArgumentError("range: colours of classes have none")
    classes = _is_class(values)
    if colormap == "classes" or (colormap is None and ends is None and _bare(word) == "classification"
                                 and bool(classes.all())):
        codes, places = np.unique(np.where(classes, values, 0).astype(np.int64), return_inverse=True)
        palette = np.array([_color(lib.ewa_class_color, int(code)) for code in codes], np.uint8).reshape(-1, 3)
        return np.where(classes[:, None], palette[places.reshape(-1)], np.uint8(_GREY))
    if ends is None:
        finite = values[np.isfinite(values)]
        signal = _bare(word) in _SIGNALS
        ends = [_percentile(finite, 2 if signal else 0), _percentile(finite, 98 if signal else 100)]
    extent = ends[1] - ends[0]
    made = np.full((len(values), 3), _GREY, np.uint8)
    for first in range(0, len(values), 1 << 20):
        block = slice(first, first + (1 << 20))
        with np.errstate(all="ignore"):
            shares = (values[block] - ends[0]) / extent if extent else np.full(len(values[block]), 0.5)
        finite_ones = np.isfinite(values[block])
        made[block][finite_ones] = _colormap(maps.index(colormap or "viridis"), shares[finite_ones])
    return made


def _colormap(index: int, numbers: Array) -> Array:
    """ewa_colormap_color() of many numbers: lines between the places of its table, to the same bytes."""
    codes = np.array([_color(lib.ewa_colormap_color, index, i / 255) for i in range(256)], np.float64)
    with np.errstate(invalid="ignore"):
        places = 255 * np.where(numbers > 0, np.minimum(numbers, 1.0), 0.0)
    if (codes[:, 0] == codes[:, 1]).all() and (codes[:, 0] == codes[:, 2]).all():  # grey has no table
        return np.repeat((places + 0.5).astype(np.uint8)[:, None], 3, axis=1)
    low = np.minimum(places, 254).astype(np.int64)
    share = (places - low)[:, None]
    made: Array = ((1 - share) * codes[low] + share * codes[low + 1] + 0.5).astype(np.uint8)
    return made


def _color(function: Any, *arguments: Any) -> list[int]:
    srgb = (ctypes.c_uint8 * 3)()
    function(*arguments, srgb)
    return list(srgb)
