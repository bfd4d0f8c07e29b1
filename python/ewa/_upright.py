# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Which way is up in a cloud, and from where it is looked at when nobody says: docs/framing.md.

The same decisions as the program's (cli/upright.c, cli/upright_measure.c), from the same counts, on arrays.
"""
from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Array

VIEWS = ("front", "back", "left", "right", "top", "bottom", "iso")

_GRID, _POINTS_PER_CELL, _FEW_POINTS, _HEIGHTS, _STRIPS, _MARKS = 64, 8, 100, 4096, 256, 1 << 17
_LAYER_CELLS, _BELOW_SHARE, _BASE_THICKNESS, _STABLE_MARGIN = 3.0, 0.002, 0.02, 0.05
_PLANE_RATIO, _FLAT_RATIO, _MAP_RATIO = 1e-4, 0.4, 100.0
_SHEET_SHARE, _BROKEN_SHARE, _CONE_SLOPE, _PIXEL_SHARE, _NARROW_RATIO = 0.15, 0.3, 1.0, 0.1, 0.05
_BASE_SHARE, _UNUSUAL_SHARE, _BASE_RATIO, _BOX_SHARE, _TALL_RATIO, _DEEP_RATIO = 0.2, 0.3, 2.0, 0.6, 2.0, 1.5


class Upright(NamedTuple):
    """What is up (1: y, 2: z), whether its negative is, the view, whether the eye belongs at the origin."""

    axis: int
    view: str = "front"
    reversed: bool = False
    from_origin: bool = False


class Points:
    """Sampled points, from the middle of their box."""

    def __init__(self, offsets: Array, middle: Array) -> None:
        self.offsets = offsets
        self.middle = middle
        some = len(offsets) > 0
        self.low = offsets.min(0) if some else np.full(3, np.inf)
        self.high = offsets.max(0) if some else np.full(3, -np.inf)
        self.extent = self.high - self.low if some else np.zeros(3)


def _classes(places: Array, count: int) -> Array:
    """The class of `count` that each place in classes is in."""
    with np.errstate(invalid="ignore"):
        inside = np.where(places >= 0, np.minimum(places, count - 1), 0)
    classes: Array = inside.astype(np.int64)
    return classes


def _layered_share(x: Array, y: Array, depth: Array, low: Array, high: Array, relative: bool) -> float:
    """Share of the cells with several points whose depths differ by much."""
    longer, shorter = max(high - low), min(high - low)
    narrow = max(shorter, 1e-3 * longer) / longer
    sides = int(min(_GRID, max(4, math.sqrt(len(x) / _POINTS_PER_CELL / narrow))))
    cell = longer / sides
    index = _classes((y - low[1]) / cell, sides) * _GRID + _classes((x - low[0]) / cell, sides)
    nearest, farthest = np.full(_GRID * _GRID, np.inf), np.full(_GRID * _GRID, -np.inf)
    np.minimum.at(nearest, index, depth)
    np.maximum.at(farthest, index, depth)
    several = np.bincount(index, minlength=_GRID * _GRID) >= 2
    unit = nearest[several] if relative else 1.0
    layered = farthest[several] - nearest[several] > _LAYER_CELLS * cell * unit
    return float(layered.sum()) / int(several.sum()) if several.any() else 0.0


def _plane(axis: int) -> tuple[int, int]:
    return (1 if axis == 0 else 0), (1 if axis == 2 else 2)


def _layers(points: Points, axis: int) -> float:
    x, y = _plane(axis)
    low, high = points.low[[x, y]], points.high[[x, y]]
    if not max(high - low) > 0:
        return 0.0
    p = points.offsets
    return _layered_share(p[:, x], p[:, y], p[:, axis], low, high, False)


def _mark_count(numbers: Array, low: float, high: float) -> int:
    """Classes that are met; those side by side count as one."""
    met = np.zeros(_MARKS + 1, bool)
    met[1 + (_classes((numbers - low) / (high - low) * (_MARKS - 1), _MARKS) if high > low else 0)] = True
    return int((met[1:] & ~met[:-1]).sum())


def _range(points: Points, sign: int) -> tuple[float, int, int, float] | None:
    """What tells whether the points are a picture of a camera at the origin; None: they are none."""
    if len(points.offsets) < _FEW_POINTS:
        return None
    world = points.offsets + points.middle
    depth = sign * world[:, 2]
    if not (depth > 0).all():
        return None
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        x, y = world[:, 0] / depth, world[:, 1] / depth
    if (np.abs(x) > _CONE_SLOPE).any() or (np.abs(y) > _CONE_SLOPE).any():
        return None
    low, high = np.array([x.min(), y.min()]), np.array([x.max(), y.max()])
    if not (low < high).all():
        return None
    width, height = high - low
    return (_layered_share(x, y, depth, low, high, True), _mark_count(x, low[0], high[0]),
            _mark_count(y, low[1], high[1]), min(width, height) / max(width, height))


def _turn(a: Any, b: Any, c: Any) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _hull(x: Array, y: Array, low: float, high: float) -> list[tuple[float, float]]:
    """Corners of the convex hull of the outermost points of strips across x, counter-clockwise."""
    if not len(x):
        return []
    strips = _classes(((x - low) / (high - low) if high > low else np.zeros(len(x))) * _STRIPS, _STRIPS)
    kept = [(float(x[i]), float(y[i])) for i in (np.lexsort((y, x))[0], np.lexsort((y, x))[-1])]
    first, last = kept
    sorted_points = [first]
    bottoms, tops = np.lexsort((x, y, strips)), np.lexsort((x, -y, strips))
    for bottom, top in zip(bottoms[np.flatnonzero(np.diff(strips[bottoms], prepend=-1))],
                           tops[np.flatnonzero(np.diff(strips[tops], prepend=-1))]):
        sorted_points += sorted([(float(x[bottom]), float(y[bottom])), (float(x[top]), float(y[top]))])
    sorted_points.append(last)
    corners: list[tuple[float, float]] = []

    def add(point: tuple[float, float], start: int) -> None:
        while len(corners) > start + 1 and _turn(corners[-2], corners[-1], point) <= 0:
            corners.pop()
        corners.append(point)

    for point in sorted_points:
        add(point, 0)
    lower = len(corners)
    for point in reversed(sorted_points[:-1]):
        add(point, lower - 1)
    return corners[:-1] if len(corners) > 1 else corners


def _area(corners: list[tuple[float, float]]) -> float:
    total = 0.0
    for i in range(2, len(corners)):
        total += _turn(corners[0], corners[i - 1], corners[i])
    return 0.5 * total


def _depth(corners: list[tuple[float, float]], point: tuple[float, float]) -> float:
    """Least distance of a point inside of a convex polygon from its edges."""
    least = math.inf if len(corners) >= 3 else -math.inf
    for i, a in enumerate(corners if len(corners) >= 3 else []):
        b = corners[(i + 1) % len(corners)]
        length = math.sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]))
        if length > 0:
            least = min(least, _turn(a, b, point) / length)
    return least


def _occupied_middle(points: Points, size: float) -> Array:
    places = np.stack([_classes((points.offsets[:, c] - points.low[c]) / size * _GRID, _GRID) for c in range(3)], 1)
    cubes = np.unique(places @ np.array([1, _GRID, _GRID * _GRID]))
    middle = [points.low[c] + size / _GRID * (float((cubes // _GRID**c % _GRID).sum()) / len(cubes) + 0.5)
              for c in range(3)]
    return np.array(middle)


def _base_height(points: Points, axis: int) -> float:
    low, extent = float(points.low[axis]), float(points.extent[axis])
    if not extent > 0:
        return low
    counts = np.bincount(_classes((points.offsets[:, axis] - low) / extent * (_HEIGHTS - 1), _HEIGHTS),
                         minlength=_HEIGHTS)
    step, most = 0, _BELOW_SHARE * len(points.offsets)
    total = np.cumsum(counts)
    while step < _HEIGHTS - 1 and total[step] <= most:
        step += 1
    return low + extent * step / (_HEIGHTS - 1)


def _base_share(points: Points, axis: int) -> float:
    """Share of the footprint that is the base; 0 where the weight is not over it, and for open sheets."""
    x, y = _plane(axis)
    size = float(max(points.extent))
    p = points.offsets
    low, high = float(points.low[x]), float(points.high[x])
    footprint = _area(_hull(p[:, x], p[:, y], low, high))
    if not footprint > 1e-9 * size * size:
        return 0.0
    base = p[p[:, axis] <= _base_height(points, axis) + _BASE_THICKNESS * size]
    corners = _hull(base[:, x], base[:, y], low, high)
    middle = _occupied_middle(points, size)
    stable = _depth(corners, (float(middle[x]), float(middle[y]))) > _STABLE_MARGIN * math.sqrt(footprint)
    return _area(corners) / footprint if stable and _layers(points, axis) >= _SHEET_SHARE else 0.0


def usual_view(extent: Array, axis: int) -> str:
    """The view of something with an axis up."""
    width, depth, height = extent[0], extent[3 - axis], extent[axis]
    wide = height < _FLAT_RATIO * min(width, depth)
    deep = depth > _DEEP_RATIO * width and depth >= height
    return "iso" if wide or deep else "front"


def _camera(points: Points, pixels_wanted: bool) -> Upright | None:
    """The view of a camera at the origin, if the points are what one saw along z or -z."""
    for sign in (1, -1):
        facts = _range(points, sign)
        if facts is None:
            continue
        layered, columns, rows, narrowness = facts
        pixels = min(columns, rows) < _PIXEL_SHARE * len(points.offsets)
        aimed = all(points.middle[c] + points.low[c] < -0.1 * points.extent[c]
                    and points.middle[c] + points.high[c] > 0.1 * points.extent[c] for c in range(2))
        if (not pixels if pixels_wanted else not aimed) or layered >= (_BROKEN_SHARE if pixels else _SHEET_SHARE):
            continue
        narrow = narrowness < _NARROW_RATIO
        return Upright(1, "iso" if narrow else "front", sign > 0, not narrow)
    return None


def _body(points: Points, convention: str) -> int:
    y, z, e = _base_share(points, 1), _base_share(points, 2), points.extent
    usual = 2 if convention == "z" else 1
    other, larger = 3 - usual, 1 if y > z else 2
    least = _BASE_SHARE if not convention or larger == usual else _UNUSUAL_SHARE
    if max(y, z) >= max(least, _BASE_RATIO * min(y, z)):
        return larger
    box = min(y, z) >= _BOX_SHARE
    if box and convention != "y" and min(e[1], e[2]) < _FLAT_RATIO * min(e[0], max(e[1], e[2])):
        return 1 if e[1] < e[2] else 2
    if e[usual] > _TALL_RATIO * max(e[0], e[other]) and (y if usual == 1 else z) < _BASE_SHARE:
        return other
    return usual


def choose(points: Points, convention: str) -> Upright:
    """Choose what is up; `convention`: "" none, "y" usual (OBJ), "z" usual (STL), "Y" required (glTF)."""
    e = points.extent
    size = float(max(e))
    if not size > 0:
        return Upright(1)
    if convention == "Y":
        return Upright(1, usual_view(e, 1))
    for axis, view in enumerate(("right", "front", "top")):
        if e[axis] < _PLANE_RATIO * size and min(e[(axis + 1) % 3], e[(axis + 2) % 3]) > _PLANE_RATIO * size:
            return Upright(1 if axis == 0 else 2, view)
    found = _camera(points, True)
    if found is not None:
        return found
    if max(abs(points.middle[0]), abs(points.middle[1])) > _MAP_RATIO * size:
        return Upright(2, "front" if e[2] > _DEEP_RATIO * max(e[0], e[1]) else "iso")
    for axis in (2, 1):
        if e[axis] < _FLAT_RATIO * min(e[0], e[3 - axis]) and _layers(points, axis) < _BROKEN_SHARE:
            return Upright(axis, "iso")
    found = _camera(points, False)
    if found is not None:
        return found
    axis = _body(points, convention)
    return Upright(axis, usual_view(e, axis))
