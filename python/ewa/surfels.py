# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Surfels: the resident form of a cloud, made as the program makes it."""
from __future__ import annotations

import ctypes
import math
import warnings
from typing import Any, Mapping

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._context import Core, Handle
from ._errors import ArgumentError, ClosedError, EwaWarning
from ._library import functions as lib
from ._struct import fill, initialised
from .cloud import Cloud

# Points from which gaps are looked for, and the support radius in spacings under which there are some.
_GAP_POINTS, _GAP_RADIUS = 1000, 1.0
# What scenes of Gaussian splatting have.
_GAUSSIAN = ("f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "rot_0", "rot_1", "rot_2", "rot_3")


class Surfels:
    """What is drawn: discs or ellipses in the order and packing of the renderer, at most 33 bytes each.

    Made by :meth:`Cloud.surfels`; immutable, needs the cloud no longer, may be drawn any number of times.
    """

    _handle: Handle | None

    def __init__(self) -> None:
        raise TypeError("Cloud.surfels() makes these")

    @staticmethod
    def _made(cloud: Cloud, options: b.ewa_surfels_options) -> Surfels:
        surfels = Surfels.__new__(Surfels)
        surfels._handle = cloud._core.make(lib.ewa_surfels_create, cloud._h, ctypes.byref(options),
                                           destroy=lib.ewa_surfels_destroy, what="the surfels")
        return surfels

    @property
    def _h(self) -> Handle:
        if self._handle is None:
            raise ClosedError("the surfels are closed")
        return self._handle

    @property
    def _core(self) -> Core:
        return self._h.core

    @property
    def _info(self) -> b.ewa_surfels_info:
        info = b.ewa_surfels_info()
        self._core.value(lib.ewa_surfels_describe, self._h, ctypes.byref(info))
        return info

    def __len__(self) -> int:
        """Points that can be drawn."""
        return self._info.point_count

    @property
    def left_out_count(self) -> int:
        """Points of the cloud that cannot be drawn."""
        return self._info.left_out_count

    @property
    def resident_bytes(self) -> int:
        """Memory of all levels."""
        return self._info.resident_bytes

    @property
    def level_count(self) -> int:
        """Levels of detail."""
        return self._info.level_count

    @property
    def transparent(self) -> bool:
        """Whether some colour has an alpha below 1."""
        return bool(self._info.transparent)

    @property
    def bounds(self) -> Array:
        """Lower and upper corner of the centres, world units; float64, shape (2, 3)."""
        box = self._info.bounds
        return np.array([box.low_world, box.high_world])

    def close(self) -> None:
        """Free the surfels; later use raises ClosedError."""
        self._handle = None

    def __repr__(self) -> str:
        return "<ewa.Surfels, closed>" if self._handle is None else f"<ewa.Surfels, {len(self)}>"


def _has_zero_normals(cloud: Cloud) -> bool:
    """Whether no point with finite coordinates has a normal with a length."""
    normals = cloud["normal"]
    positions = cloud["position"]
    for first in range(0, len(normals), 1 << 16):
        block = slice(first, first + (1 << 16))
        good = np.isfinite(normals[block]).all(1) & (normals[block] != 0).any(1)
        if (good & np.isfinite(positions[block]).all(1)).any():
            return False
    return True


def complete(cloud: Cloud) -> Cloud:
    """The cloud with normals and radii, estimated where it has none, as the program does with its inputs."""
    if cloud._is_drawable():
        return cloud
    if all(name in cloud for name in _GAUSSIAN):
        raise ArgumentError("a scene of Gaussian splatting, which cannot be drawn as surfels; "
                            "estimate(keep_normals=False) makes surfels of the centres")
    if "normal" in cloud and cloud["normal"].ndim == 2 and _has_zero_normals(cloud):
        warnings.warn("all normals are zero or not finite, and count as missing", EwaWarning, stacklevel=4)
        cloud = cloud._derive(without="normal")
    return cloud.estimate()


def make_surfels(cloud: Cloud, close_gaps: bool, options: Mapping[str, Any]) -> Surfels:
    """The surfels that the program would draw."""
    made = initialised(b.ewa_surfels_options, lib.ewa_surfels_options_init)
    fill(made, "ewa_surfels_options", options)
    cloud = complete(cloud)
    surfels = Surfels._made(cloud, made)
    info = surfels._info
    if close_gaps and "radius" in cloud and "tangent_u" not in cloud and info.point_count >= _GAP_POINTS:
        # From the unit coverage q = s^2 d (1 - exp(-F^2 / 2)), s = radius / F, d the density.
        kernel = 1 - math.exp(-0.5 * made.cutoff * made.cutoff)
        radius = made.cutoff * math.sqrt(info.unit_coverage / kernel) / min(made.radius_scale, 1.0)
        if radius < _GAP_RADIUS:
            warnings.warn(f"the radii are {radius:.2f} of the points' spacing, which leaves gaps: larger ones are used "
                          "(close_gaps=False keeps them)", EwaWarning, stacklevel=3)
            surfels = Surfels._made(cloud.estimate(cutoff=made.cutoff, keep_radii=False), made)
            info = surfels._info
    if info.point_count == 0 and len(cloud):
        raise ArgumentError(f"none of the {len(cloud)} points can be drawn: their coordinates are not finite, their "
                            "normals zero, or nothing says how large they are")
    if info.left_out_count:
        warnings.warn(f"{info.left_out_count} of {len(cloud)} points are left out: coordinates, normals or radii that "
                      "are zero or not finite", EwaWarning, stacklevel=3)
    return surfels
