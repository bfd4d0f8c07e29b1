# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Measurements between places: distances along a line, heights, angles, areas."""
from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Sequence

import numpy as np

from . import _bindings as b
from ._context import core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import numbers

_KINDS = ("distance", "height", "angle", "area")


class Measurement(NamedTuple):
    """What places are apart: world units, squares of them, degrees.

    Attributes
    ----------
    length, horizontal : float
        Of the line from place to place, of an area around it; the same, seen from above.
    rise, slope : float
        Of the last place above the first; degrees of the way there.
    angle : float
        At the second of three places, degrees; else 0.
    area, horizontal_area : float
        Within the places, of the plane in which it is largest; the same, seen from above.
    """

    length: float
    horizontal: float
    rise: float
    slope: float
    angle: float
    area: float
    horizontal_area: float


def measure(kind: str, places: Any, up: Sequence[float] = (0, 0, 1)) -> Measurement:
    """Measure places.

    Parameters
    ----------
    kind : {"distance", "height", "angle", "area"}
        Of 2 or more, of 2, of 3, of 3 or more places.
    places : array_like of shape (n, 3)
        World units.
    up : sequence of 3 floats, optional
        What is up. Default: z.

    Raises
    ------
    ArgumentError
    """
    if kind not in _KINDS:
        raise ArgumentError(f"kind: {kind!r} is none of {', '.join(_KINDS)}")
    given = np.ascontiguousarray(places, dtype=np.float64)
    if given.ndim != 2 or given.shape[1] != 3:
        raise ArgumentError(f"places: shape {given.shape}; (n, 3) is needed")
    found = b.ewa_measurement()
    axis = (ctypes.c_double * 3)(*numbers(up, 3, "up"))
    status = core_of(None).value(lib.ewa_places_measure, _KINDS.index(kind),
                                 given.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), len(given), axis,
                                 ctypes.byref(found))
    if status != b.ewa_status.EWA_OK:
        raise ArgumentError(f"{kind}: {len(given)} places, of which some may not be finite, or no up")
    return Measurement(found.length_world, found.horizontal_world, found.rise_world, found.slope_deg, found.angle_deg,
                       found.area, found.horizontal_area)
