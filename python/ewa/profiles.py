# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Profiles: the points beside a line on the map, by how far along it and how high they are, and their graph."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._context import Core, Handle
from ._errors import ArgumentError
from ._held import Held
from ._keywords import keywords
from ._library import functions as lib
from ._struct import fill, initialised, numbers
from .cloud import Cloud
from .image import Image

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import ProfileGraphOptions


def corners_of(line: Any) -> Array:
    """Corners of a line as the library takes them: shape (n, 3)."""
    corners = np.asarray(line, dtype=np.float64)
    if corners.ndim != 2 or corners.shape[1] not in (2, 3):
        raise ArgumentError(f"line: shape {corners.shape}; (n, 2) or (n, 3) is needed")
    made = np.zeros((len(corners), 3))
    made[:, :corners.shape[1]] = corners
    return made


class Profile(Held):
    """The points of a scene beside a line; :meth:`Scene.profile` makes one.

    Attributes
    ----------
    cloud : Cloud
        The points, by station, then height and offset, with all that their files say and the streams ``station`` (along
        the line), ``offset`` (to its right) and ``profile_height``; world units.
    colors : ndarray of uint8, shape (n, 3)
        sRGB, as the scene colours them without light.
    length : float
        Of the line, seen from above; world units.
    up : ndarray of float64, shape (3,)
        What is up, a unit vector.
    """

    _what = "the profile"
    cloud: Cloud

    def __init__(self, core: Core, scene: Handle, line: Any, width: float, up: Sequence[float] | None) -> None:
        corners = corners_of(line)
        options = initialised(b.ewa_profile_options, lib.ewa_profile_options_init)
        members: dict[str, Any] = {"width_world": width}
        if up is not None:
            members["up_world"] = list(numbers(up, 3, "up"))
        fill(options, "ewa_profile_options", members)
        struct = b.ewa_profile()
        self._fill(core, struct, "context", lib.ewa_scene_profile, lib.ewa_profile_free, scene, corners.ctypes.data_as(
            ctypes.POINTER(ctypes.c_double)), len(corners), ctypes.byref(options), ctypes.byref(struct))
        one = (ctypes.c_void_p * 1)(struct.points)
        self.cloud = Cloud._made(core, lib.ewa_cloud_merge, one, 1)
        self.colors = np.zeros((len(self.cloud), 3), np.uint8)
        if struct.srgb:
            ctypes.memmove(self.colors.ctypes.data, struct.srgb, self.colors.nbytes)
        self.length = float(struct.length_world)
        self.up = np.array(struct.up_world[:])

    def __repr__(self) -> str:
        return f"<ewa.Profile of {len(self.cloud)} points along {self.length:g}>"

    @keywords("ewa_profile_graph_options")
    def draw(self, size: Sequence[int] = (1280, 720), *, title: str = "", unit: str = "",
             **options: Unpack[ProfileGraphOptions]) -> Image:
        """Draw the graph of stations and heights: the bytes of ``ewa profile --graph``.

        Parameters
        ----------
        size : (int, int)
            Width and height, pixels.
        title, unit : str
            A line over the top; what the world's lengths are called, by default as the files say.
        **options

        Raises
        ------
        ArgumentError, OutOfMemory, ClosedError
        """
        made = initialised(b.ewa_profile_graph_options, lib.ewa_profile_graph_options_init)
        fill(made, "ewa_profile_graph_options", options)
        made.title = title.encode() if title else None
        made.unit = unit.encode() if unit else None
        width, height = (int(side) for side in size)
        if not (1 <= width <= 65536 and 1 <= height <= 65536):
            raise ArgumentError(f"size: {width} x {height} pixels; 1 to 65536 are allowed")
        image = Image(None)
        image.rgba8 = np.zeros((height, width, 4), np.uint8)
        canvas = b.ewa_canvas(image.rgba8.ctypes.data, width, height)
        self._call(lib.ewa_profile_draw, ctypes.byref(made), ctypes.byref(canvas))
        return image
