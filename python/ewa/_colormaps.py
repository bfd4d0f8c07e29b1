# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Colours of numbers that the library does not have: of matplotlib, or of a list."""
from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from ._arrays import Array, as_numbers
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import table

_COUNT = 256


def colors_of_map(colormap: Any) -> Array | None:
    """sRGB shares of a map, shape (n, 3), one for each n-th part of the range; None: the library has it."""
    words = table("ewa_coloring")["map"].words
    if isinstance(colormap, int) or (isinstance(colormap, str) and colormap in words):
        return None
    if isinstance(colormap, str):
        try:
            import matplotlib  # type: ignore[import-not-found,unused-ignore]

            colormap = matplotlib.colormaps[colormap]
        except (ImportError, AttributeError):
            raise ArgumentError(f"map: '{colormap}' is none of {'|'.join(words)}, and matplotlib is not there") from None
        except KeyError:
            raise ArgumentError(f"map: '{colormap}' is none of {'|'.join(words)}, nor of matplotlib") from None
    if callable(colormap):  # of matplotlib
        count = int(getattr(colormap, "N", _COUNT))
        made: Array = np.asarray(colormap(np.arange(count)), np.float64)[:, :3]
        return made
    given = as_numbers([_shares(color) for color in colormap] if _has_text(colormap) else colormap, "colormap")
    if given.ndim != 2 or given.shape[1] not in (3, 4) or not len(given):
        raise ArgumentError(f"colormap: shape {given.shape}; (n, 3) is needed")
    shares = given[:, :3].astype(np.float64) / (255 if given.dtype.kind in "iu" else 1)
    places = np.linspace(0, len(shares) - 1, _COUNT)
    return np.stack([np.interp(places, np.arange(len(shares)), shares[:, c]) for c in range(3)], axis=1)


def _has_text(colormap: Any) -> bool:
    return isinstance(colormap, (list, tuple)) and any(isinstance(color, str) for color in colormap)


def _shares(color: Any) -> list[float]:
    """sRGB shares of a colour of a list: text as the program takes it, or numbers."""
    if not isinstance(color, str):
        return list(color)[:3]
    srgba = (ctypes.c_double * 4)()
    if not lib.ewa_color_read(color.encode(), srgba):
        raise ArgumentError(f"colormap: '{color}' is no colour")
    return list(srgba[:3])


def color_codes(scalar: Array, colors: Array, low: float, high: float) -> Array:
    """sRGB codes of numbers, as matplotlib takes colours of a map; those of numbers that are not finite say nothing."""
    with np.errstate(invalid="ignore", over="ignore"):
        share = (scalar - low) / (high - low) if high != low else np.zeros(len(scalar))
        place = np.clip(np.nan_to_num(share) * len(colors), 0, len(colors) - 1).astype(np.intp)
    made: Array = np.rint(np.clip(colors, 0, 1) * 255).astype(np.uint8)[place]
    return made
