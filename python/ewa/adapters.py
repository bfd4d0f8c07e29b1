# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Clouds of the objects of other packages; none of these is imported here."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._context import Context
from ._errors import ArgumentError
from ._scene import is_path
from .cloud import Cloud
from .combining import cloud_of


def _package(value: Any) -> str:
    return type(value).__module__.split(".")[0]


def from_laspy(las: Any, *, context: Context | None = None) -> Cloud:
    """Make a cloud of ``laspy.LasData``: coordinates as doubles, colours, all other dimensions under their names."""
    streams: dict[str, Any] = {}
    names = list(las.point_format.dimension_names)
    if all(name in names for name in ("red", "green", "blue")):
        streams["colors"] = np.stack([np.asarray(las[name], np.uint16) for name in ("red", "green", "blue")], 1)
    for name in names:
        if name in ("X", "Y", "Z", "red", "green", "blue"):
            continue
        values = np.asarray(las[name])
        if values.ndim == 1 or (values.ndim == 2 and values.shape[1] <= 4):
            wide = values.dtype.kind in "iu" and values.itemsize == 8
            streams[name] = values.astype(np.float64) if wide else values
    return Cloud(np.asarray(las.xyz, np.float64), context=context, **streams)


def from_open3d(cloud: Any, *, context: Context | None = None) -> Cloud:
    """Make a cloud of ``open3d.geometry.PointCloud``, whose arrays are borrowed, or of ``open3d.t``'s; sRGB colours."""
    if hasattr(cloud, "point"):  # open3d.t
        fields = {name: np.asarray(cloud.point[name].numpy()) for name in cloud.point}
        positions, normals, colors = fields["positions"], fields.get("normals"), fields.get("colors")
    else:
        positions = np.asarray(cloud.points)
        normals = np.asarray(cloud.normals) if cloud.has_normals() else None
        colors = np.asarray(cloud.colors) if cloud.has_colors() else None
    return Cloud(positions, normals=normals, colors=_srgb8(colors), context=context)


def from_trimesh(mesh: Any, *, context: Context | None = None) -> Cloud:
    """Make a cloud of ``trimesh.PointCloud``, or of points on the faces of ``trimesh.Trimesh``."""
    if hasattr(mesh, "faces"):
        from .mesh import Mesh

        return Mesh(mesh.vertices, np.asarray(mesh.faces), context=context).sample()
    colors = getattr(mesh, "colors", None)
    some = colors is not None and len(colors) == len(mesh.vertices)
    return Cloud(np.asarray(mesh.vertices), colors=np.asarray(colors, np.uint8) if some else None, context=context)


def from_pyvista(data: Any, *, context: Context | None = None) -> Cloud:
    """Make a cloud of the points of ``pyvista.PolyData`` and such, with their arrays; the points are borrowed."""
    streams: dict[str, Any] = {}
    for name in data.point_data.keys():
        values = np.asarray(data.point_data[name])
        if values.dtype.kind in "iu" and values.itemsize == 8:
            values = values.astype(np.float64)
        if values.dtype.kind not in "fiub" or values.ndim > 2 or (values.ndim == 2 and values.shape[1] > 4):
            continue
        known = {"Normals": "normals", "normals": "normals", "RGB": "colors", "RGBA": "colors", "rgb": "colors",
                 "rgba": "colors"}
        streams[known.get(name, name)] = values
    return Cloud(np.asarray(data.points), context=context, **streams)


def _srgb8(colors: Any) -> Any:
    """Colours of floats that are sRGB as bytes, which are sRGB here."""
    if colors is None or colors.dtype.kind != "f":
        return colors
    return np.rint(np.clip(np.nan_to_num(colors), 0, 1) * 255).astype(np.uint8)


_KINDS = {"laspy": from_laspy, "open3d": from_open3d, "trimesh": from_trimesh, "pyvista": from_pyvista}


def as_cloud(value: Any, *, context: Context | None = None) -> Cloud:
    """Make a cloud of an array of positions, a path, or an object of laspy, Open3D, trimesh or PyVista.

    Raises
    ------
    ArgumentError
        The object is of none of these packages, and no array.
    """
    if isinstance(value, Cloud) or is_path(value):
        return cloud_of(value)
    make = _KINDS.get(_package(value))
    if make is not None:
        return make(value, context=context)
    if isinstance(value, np.ndarray) or isinstance(value, (list, tuple)):
        return Cloud(value, context=context)
    raise ArgumentError(f"no cloud is made of {type(value).__module__}.{type(value).__name__}; there are arrays, and "
                        f"the objects of {', '.join(_KINDS)}")
