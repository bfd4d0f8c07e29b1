# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Getting the whole of something into a picture, as large as it goes: the library's framing, as the program asks it."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

from . import _bindings as b
from ._errors import ArgumentError, make
from ._library import functions as lib
from ._struct import numbers, path_bytes

if TYPE_CHECKING:
    from .camera import PathLike
    from .cloud import Cloud

VIEWS = ("front", "back", "left", "right", "top", "bottom", "iso")


def convention_of(paths: Sequence[PathLike]) -> int:
    """What the kind of some files says about up; a value of ewa_up_convention."""
    names = (ctypes.c_char_p * len(paths))(*[path_bytes(path) for path in paths])
    return int(lib.ewa_up_convention_of(len(paths), names))


UPS = {"y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0], "-y": [0.0, -1.0, 0.0], "-z": [0.0, 0.0, -1.0]}


def _up(up: Any) -> list[float] | None:
    if isinstance(up, str):
        if up not in UPS:
            raise ArgumentError(f"up: '{up}' is none of {', '.join(UPS)}, nor 3 numbers")
        return UPS[up]
    return None if up is None else list(numbers(up, 3, "up"))


def _as_cloud(what: Any) -> Cloud:
    """What is framed, as a cloud: of surfels the corners of their box."""
    from .cloud import Cloud
    from .surfels import Surfels

    if isinstance(what, Cloud):
        return what
    if isinstance(what, Surfels):
        boxes = [what.bounds]
    elif isinstance(what, (list, tuple)) and what and all(isinstance(part, (Surfels, Cloud)) for part in what):
        boxes = [part.bounds for part in what]
    else:
        boxes = [np.array(numbers(what, 6, "what")).reshape(2, 3)]
    low, high = np.min([box[0] for box in boxes], 0), np.max([box[1] for box in boxes], 0)
    corners = [[(high if i >> c & 1 else low)[c] for c in range(3)] for i in range(8)]
    return Cloud(np.array(corners, np.float64))


def frame(camera: b.ewa_camera, what: Any, view: Any, up: Any, azimuth: float, elevation: float,
          ortho: float | None, fov: float | None, radius_scale: float) -> b.ewa_camera:
    """Place a camera whose picture and projection are set."""
    cloud = _as_cloud(what)
    core, asked, place = cloud._core, _up(up), ctypes.byref(camera)
    hangs = isinstance(up, str) and up.startswith("-")
    direction = None if view is None or isinstance(view, str) else numbers(view, 3, "view")
    if isinstance(view, str) and view not in VIEWS:
        raise ArgumentError(f"view: '{view}' is none of {', '.join(VIEWS)}, nor 3 numbers")
    framing = core.make(lib.ewa_framing_create, cloud._h, float(radius_scale), destroy=lib.ewa_framing_destroy,
                        what="the framing")
    chosen, info = b.ewa_upright(), b.ewa_framing_info()
    if asked is None:
        core.value(lib.ewa_framing_choose, framing, cloud._convention, ctypes.byref(chosen))
    else:
        core.value(lib.ewa_framing_describe, framing, ctypes.byref(info))
        extent = (ctypes.c_double * 3)(*[info.box.high_world[c] - info.box.low_world[c] for c in range(3)])
        chosen.axis = 2 if abs(asked[2]) > abs(asked[1]) else 1
        chosen.reversed = hangs  # then the sides are those of what hangs, too
        chosen.view = lib.ewa_upright_view(extent, chosen.axis)
    if isinstance(view, str):
        chosen.view = VIEWS.index(view)
    axis_world = [0.0, 0.0, 0.0]
    axis_world[chosen.axis] = -1.0 if chosen.reversed else 1.0
    axis = (ctypes.c_double * 3)(*(asked or axis_world))
    looked, up_world = (ctypes.c_double * 3)(), (ctypes.c_double * 3)()
    lib.ewa_upright_look(ctypes.byref(chosen), looked, up_world)
    if direction is not None:
        looked = direction
    if (asked is not None and not hangs) or direction is not None:
        up_world = (ctypes.c_double * 3)(*axis)
    if azimuth != 0 or elevation != 0:
        status = lib.ewa_upright_turn(axis, azimuth, elevation, looked, up_world)
        if status:
            raise make(status, "frame: view, up, azimuth and elevation give no direction")
    elif chosen.from_origin and view is None and fov is None and ortho is None:
        core.call(lib.ewa_framing_zoom, framing, (ctypes.c_double * 3)(), up_world, place)
        return camera
    core.call(lib.ewa_framing_fit, framing, looked, up_world, place)
    if ortho is not None:
        status = lib.ewa_camera_set_ortho(place, float(ortho))
        if status:
            raise make(status, "ortho")
    return camera
