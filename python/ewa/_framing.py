# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Getting the whole of a cloud into a picture, as large as it goes: the program's cameras (cli/framing.c, cli/view.c).

The same numbers in the same order as there, so that pictures of the package and of the program are the same bytes.
"""
from __future__ import annotations

import ctypes
import math
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._errors import ArgumentError, NumericError, make
from ._library import functions as lib
from ._struct import numbers
from ._upright import VIEWS, Points, Upright, choose, usual_view

if TYPE_CHECKING:
    from .cloud import Cloud

_SAMPLES, _FAR_SHARE, _FAR_RATIO, _RIM_RATIO, _MARGIN = 1 << 16, 0.005, 3.0, 3.0, 0.04

# Written for z up, from the front at -y; y up is the same turned about x.
_DIRECTIONS = {"front": (0.0, 1.0, 0.0), "back": (0.0, -1.0, 0.0), "left": (1.0, 0.0, 0.0), "right": (-1.0, 0.0, 0.0),
               "top": (0.0, 0.0, -1.0), "bottom": (0.0, 0.0, 1.0), "iso": (-1.0, 1.0, -1.0)}


def _mix(hashes: Array, values: Array) -> Array:
    """Mixes numbers into hashes (the finish of splitmix64)."""
    bits = (values + 0.0).view(np.uint64)  # -0 is 0
    z = hashes ^ (bits + np.uint64(0x9E3779B97F4A7C15))
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    mixed: Array = z ^ (z >> np.uint64(31))
    return mixed


def _sample(cloud: Cloud, positions: Array) -> Array:
    """Indices of some points, the same ones in whatever order they are: those of the least hashes."""
    count = len(cloud)
    radii = cloud["radius"] if "radius" in cloud and cloud["radius"].ndim == 1 else None
    finite, hashes = np.empty(count, bool), np.empty(count, np.uint64)
    with np.errstate(over="ignore"):
        for first in range(0, count, 1 << 20):
            block = slice(first, first + (1 << 20))
            p = positions[block].astype(np.float64)
            finite[block] = np.isfinite(p).all(1)
            h = np.zeros(len(p), np.uint64)
            for c in range(3):
                h = _mix(h, np.ascontiguousarray(p[:, c]))
            hashes[block] = _mix(h, radii[block].astype(np.float64) if radii is not None else np.zeros(len(p)))
    if count <= _SAMPLES:
        return np.flatnonzero(finite)
    limit = min(int(2.0**63 * (_SAMPLES / count)) * 2, 2**64 - 1)
    for most in (limit, 2**64 - 1):
        chosen = np.flatnonzero(finite & (hashes <= np.uint64(most)))
        if len(chosen) > 2 * _SAMPLES:  # equal ones count once
            _, first_ones = np.unique(hashes[chosen], return_index=True)
            chosen = chosen[first_ones[:_SAMPLES]]
        if len(chosen) >= _SAMPLES // 2:
            break
    return chosen


def _rank(values: Array, rank: int) -> float:
    return float(np.partition(values, rank)[rank])


def _diagonal(low: Array, high: Array) -> float:
    e = high - low
    return math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])


def _dot(a: Array, v: Array) -> Array:
    product: Array = a[:, 0] * v[:, 0] + a[:, 1] * v[:, 1] + a[:, 2] * v[:, 2]
    return product


def _rims(cloud: Cloud, sample: Array, radius_scale: float) -> Array:
    """How far the discs of the sampled points reach beyond them, none over thrice the median."""
    def three(name: str) -> bool:
        return name in cloud and cloud[name].ndim == 2 and cloud[name].shape[1] == 3

    if three("tangent_u") and three("tangent_v"):
        u, v = (cloud[name][sample].astype(np.float64) for name in ("tangent_u", "tangent_v"))
        uu, vv, uv = _dot(u, u), _dot(v, v), _dot(u, v)
        half = 0.5 * (uu - vv)
        reach = 3.0 * np.sqrt(0.5 * (uu + vv) + np.sqrt(half * half + uv * uv))
    elif "radius" in cloud and cloud["radius"].ndim == 1:
        reach = cloud["radius"][sample].astype(np.float64)
    else:
        return np.zeros(len(sample))
    rims = radius_scale * np.where((reach > 0) & np.isfinite(reach), reach, 0.0)
    positive = rims[rims > 0]
    most = _RIM_RATIO * _rank(positive, len(positive) // 2) if len(positive) else 0.0
    return np.minimum(rims, most)


class _Framing:
    """Where a cloud is, from a sample of its points that does not depend on their order."""

    def __init__(self, cloud: Cloud, radius_scale: float) -> None:
        self.box = cloud._measure()
        if self.box.finite_count == 0:
            raise NumericError("no point has finite coordinates", "EWA_ERROR_NUMERIC")
        positions = cloud["position"]
        sample = _sample(cloud, positions)
        points = positions[sample].astype(np.float64) + cloud.origin
        low, high = np.array(self.box.low_world), np.array(self.box.high_world)
        self.trimmed = False
        if len(points):
            skipped = int(_FAR_SHARE * len(points))
            lows = np.array([_rank(points[:, c], skipped) for c in range(3)])
            highs = np.array([_rank(points[:, c], len(points) - 1 - skipped) for c in range(3)])
            rim = 0.05 * (highs - lows)
            inner = lows - rim, highs + rim
            if _diagonal(*inner) > 0 and _diagonal(low, high) > _FAR_RATIO * _diagonal(*inner):
                self.trimmed = True
                low, high = np.maximum(low, inner[0]), np.minimum(high, inner[1])
                self.box.low_world[:], self.box.high_world[:] = low, high
        self.low, self.high = low, high
        self.middle = 0.5 * low + 0.5 * high
        rims = _rims(cloud, sample, radius_scale)
        inside = ((points >= low) & (points <= high)).all(1)
        self.offsets = points[inside] - self.middle
        self.rims = rims[inside]


def _fit_axis(framing: _Framing, m: Array, axis: int, slope: float) -> tuple[float, float]:
    """Where the camera has to stand, sideways and in depth, so that all is between two planes through it."""
    side, ahead, p = m[axis], m[2], framing.offsets
    x = side[0] * p[:, 0] + side[1] * p[:, 1] + side[2] * p[:, 2]
    z = ahead[0] * p[:, 0] + ahead[1] * p[:, 1] + ahead[2] * p[:, 2]
    rim = math.sqrt(1 + slope * slope) * framing.rims
    above, below = float((x - slope * z + rim).max()), float((-x - slope * z + rim).max())
    return 0.5 * (above - below), -(above + below) / (2 * slope) if slope > 0 else math.inf


def _three(vector: Sequence[float] | Array) -> Any:
    return (ctypes.c_double * 3)(*[float(x) for x in vector])


def _must(status: int, what: str) -> None:
    if status:
        raise make(status, what)


def _fit(framing: _Framing, direction: Sequence[float], up: Sequence[float], camera: b.ewa_camera) -> None:
    _must(lib.ewa_camera_frame(ctypes.byref(camera), ctypes.byref(framing.box), _three(direction), _three(up),
                               _MARGIN), "frame: no camera can be placed")
    flat = _diagonal(framing.low, framing.high) == 0 and not framing.rims.any()
    if not len(framing.offsets) or flat or camera.projection != b.ewa_projection.EWA_PERSPECTIVE:
        return
    m = np.array(camera.world_to_camera).reshape(4, 4)
    inside = 1 - 2 * _MARGIN
    x, depth_x = _fit_axis(framing, m, 0, inside * camera.width_px / (2 * camera.fx_px))
    y, depth_y = _fit_axis(framing, m, 1, inside * camera.height_px / (2 * camera.fy_px))
    place, middle = (x, y, min(depth_x, depth_y)), framing.middle
    for r in range(3):
        camera.world_to_camera[4 * r + 3] = -place[r] - (m[r, 0] * middle[0] + m[r, 1] * middle[1]
                                                         + m[r, 2] * middle[2])


def _zoom(framing: _Framing, up: Sequence[float], camera: b.ewa_camera) -> None:
    """Sets the lens of a camera at the origin so that the sampled points just fit."""
    eye, target = np.zeros(3), framing.middle
    low, high = np.zeros(2), np.zeros(2)
    for last in (False, True):
        _must(lib.ewa_camera_look_at(ctypes.byref(camera), _three(eye), _three(target), _three(up)),
              "frame: no camera can be placed")
        m, p = np.array(camera.world_to_camera).reshape(4, 4), framing.offsets + framing.middle
        q = [m[r, 3] + m[r, 0] * p[:, 0] + m[r, 1] * p[:, 1] + m[r, 2] * p[:, 2] for r in range(3)]
        ahead = q[2] > 0
        z, rim = q[2][ahead], framing.rims[ahead] / q[2][ahead]
        low = np.array([(q[c][ahead] / z - rim).min(initial=math.inf) for c in range(2)])
        high = np.array([(q[c][ahead] / z + rim).max(initial=-math.inf) for c in range(2)])
        if last:
            break
        target = eye + m[2, :3] + 0.5 * (low[0] + high[0]) * m[0, :3] + 0.5 * (low[1] + high[1]) * m[1, :3]
    across, down = max(-low[0], high[0]), max(-low[1], high[1])
    focal = 0.5 * (1 - 2 * _MARGIN) * min(camera.width_px / across, camera.height_px / down)
    if not (focal > 0 and math.isfinite(focal)):
        raise NumericError("frame: no camera can be placed", "EWA_ERROR_NUMERIC")
    camera.fx_px = camera.fy_px = focal


def view_direction(view: str, axis: int, reverse: bool) -> list[float]:
    """Direction of a named view with y (1) or z (2) up; `reverse`: with that axis down, turned about x."""
    d = _DIRECTIONS[view]
    direction = [d[0], d[1] if axis == 2 else d[2], d[2] if axis == 2 else -d[1]]
    return [direction[0], -direction[1], -direction[2]] if reverse else direction


def _turned(direction: list[float], up: list[float], axis: list[float], azimuth: float,
            elevation: float) -> tuple[list[float], list[float]]:
    camera = b.ewa_camera()
    lib.ewa_camera_init(ctypes.byref(camera))
    zero = _three((0, 0, 0))
    _must(lib.ewa_camera_look_at(ctypes.byref(camera), zero, _three(direction), _three(up)), "view: no direction")
    _must(lib.ewa_camera_orbit(ctypes.byref(camera), zero, _three(axis), azimuth), "azimuth")
    m = camera.world_to_camera
    _must(lib.ewa_camera_orbit(ctypes.byref(camera), zero, _three((m[0], m[1], m[2])), -elevation), "elevation")
    return [m[8], m[9], m[10]], [-m[4], -m[5], -m[6]]


def _up(up: Any) -> list[float] | None:
    if isinstance(up, str):
        if up not in ("y", "z"):
            raise ArgumentError(f"up: '{up}' is neither 'y' nor 'z', nor 3 numbers")
        return [0.0, 1.0, 0.0] if up == "y" else [0.0, 0.0, 1.0]
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
    framing = _Framing(cloud, float(radius_scale))
    asked = _up(up)
    extent = framing.high - framing.low
    if asked is None:
        chosen = choose(Points(framing.offsets, framing.middle), cloud._convention)
    else:
        axis = 2 if abs(asked[2]) > abs(asked[1]) else 1
        chosen = Upright(axis, usual_view(extent, axis))
    sign = -1.0 if chosen.reversed else 1.0
    up_world = asked or [sign if c == chosen.axis else 0.0 for c in range(3)]
    axis_world = list(up_world)
    turned = azimuth != 0 or elevation != 0
    if view is not None and not isinstance(view, str):
        direction = list(numbers(view, 3, "view"))
    else:
        name = chosen.view if view is None else view
        if name not in VIEWS:
            raise ArgumentError(f"view: '{name}' is none of {', '.join(VIEWS)}, nor 3 numbers")
        direction = view_direction(name, chosen.axis, chosen.reversed)
        if name in ("top", "bottom") and asked is None:
            up_world = view_direction("front" if name == "top" else "back", chosen.axis, chosen.reversed)
    if turned:
        direction, up_world = _turned(direction, up_world, axis_world, azimuth, elevation)
    if chosen.from_origin and view is None and not turned and fov is None and ortho is None:
        _zoom(framing, up_world, camera)
        return camera
    _fit(framing, direction, up_world, camera)
    if ortho is not None:
        _must(lib.ewa_camera_set_ortho(ctypes.byref(camera), float(ortho)), "ortho")
    return camera
