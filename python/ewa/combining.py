# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Several clouds, or files, made one."""
from __future__ import annotations

import ctypes
from typing import Any, Sequence

from . import _bindings as b
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import fill, initialised
from .adapters import as_cloud
from .cloud import Cloud, merge_clouds


def merge(clouds: Sequence[Any]) -> Cloud:
    """Return one cloud of several of one context, or of files or whatever :func:`as_cloud` takes; streams that only some
    have are filled.

    Raises
    ------
    ArgumentError, FileError, FormatError, OutOfMemory
    """
    if not clouds:
        raise ArgumentError("clouds: there is none")
    return merge_clouds([as_cloud(cloud) for cloud in clouds])


def csg(a: Any, other: Any, operation: str = "union", *, cutoff: float = 3) -> Cloud:
    """Combine two closed solids of surfels, with clip lines where their surfaces meet.

    Normals and radii that they lack are estimated.

    Parameters
    ----------
    a, other : Cloud, path, or whatever :func:`as_cloud` takes
        Of one context, normals outward.
    operation : {"union", "intersection", "difference"}, optional
        "difference": `a` without `other`.
    cutoff : float, optional
        Standard deviations at which kernels end, in (0, 4].

    Raises
    ------
    ArgumentError
        An operand is not closed.
    """
    made = initialised(b.ewa_csg_options, lib.ewa_csg_options_init)
    fill(made, "ewa_csg_options", {"operation": operation, "cutoff": cutoff})
    first, second = (as_cloud(cloud)._completed() for cloud in (a, other))
    return Cloud._made(first._core, lib.ewa_cloud_csg, first._h, second._h, ctypes.byref(made))
