# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Triangles of other packages on their way to a mesh: several become one, as those of one file do."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Sequence

import numpy as np

from ._arrays import Array, as_contiguous
from ._context import Context
from .cloud import MEANT
from .image import linear_of_codes
from .mesh import Mesh

#: What there is without a material.
WHITE: tuple[Any, Any] = ((1.0, 1.0, 1.0, 1.0), None)


@dataclass
class Surface:
    """Arguments of :class:`Mesh`; colours are linear and have four components."""

    vertices: Array
    triangles: Array
    normals: Array | None = None
    colors: Array | None = None
    texcoords: Array | None = None
    materials: list[tuple[Any, Any]] = field(default_factory=list)
    triangle_materials: Array | None = None
    numbers: dict[str, Array] = field(default_factory=dict)

    def add_numbers(self, name: str, values: Any) -> None:
        """Add numbers of the vertices, unless nothing is drawn by them: of other types, or more than four for each; names
        are made such as those of the arrays of VTK's files."""
        array = np.asarray(values)
        if array.dtype.kind not in "fiub" or array.ndim not in (1, 2) or (array.ndim == 2 and not 1 <= array.shape[1] <= 4):
            return
        name = name.replace(" ", "_")
        self.numbers["scalar_" + name if name in MEANT else name] = array

    def moved(self, matrix: Any) -> Surface:
        """The surface mapped by a matrix of (4, 4) that acts on columns."""
        m = np.asarray(matrix, np.float64)
        normals = self.normals
        if normals is not None:  # by cofactors, which also hold where the matrix is singular
            rows = m[:3, :3]
            cofactors = np.stack([np.cross(rows[1], rows[2]), np.cross(rows[2], rows[0]), np.cross(rows[0], rows[1])])
            normals = normals @ cofactors.T
        mirrored = np.linalg.det(m[:3, :3]) < 0
        return Surface(self.vertices @ m[:3, :3].T + m[:3, 3], self.triangles[:, ::-1] if mirrored else self.triangles,
                       normals, self.colors, self.texcoords, self.materials, self.triangle_materials, self.numbers)

    def apart(self) -> Surface:
        """The surface with vertices of its own for every triangle, for what is said of each or of its corners."""
        corners = self.triangles.reshape(-1)
        return Surface(self.vertices[corners], np.arange(len(corners)).reshape(-1, 3),
                       None if self.normals is None else self.normals[corners],
                       None if self.colors is None else self.colors[corners],
                       None if self.texcoords is None else self.texcoords[corners], self.materials,
                       self.triangle_materials, {name: values[corners] for name, values in self.numbers.items()})


def linear_colors(colors: Any) -> Array:
    """Linear light of sRGB colours, codes or shares, of three or four components."""
    given = np.asarray(colors)
    codes = given if given.dtype.kind == "u" else srgb8(given)
    if codes.shape[1] == 3:
        codes = np.concatenate([codes, np.full((len(codes), 1), np.iinfo(codes.dtype).max, codes.dtype)], axis=1)
    return linear_of_codes(codes)


def srgb8(colors: Array) -> Array:
    """Codes of 8 bits of shares that are sRGB."""
    made: Array = np.rint(np.clip(np.nan_to_num(colors), 0, 1) * 255).astype(np.uint8)
    return made


def _joined(name: str, surfaces: Sequence[Surface]) -> Array:
    """Numbers of all vertices; where a surface has none they are NaN, whole ones 0."""
    given = [surface.numbers.get(name) for surface in surfaces]
    first = next(numbers for numbers in given if numbers is not None)
    other = np.nan if first.dtype.kind == "f" else 0
    return np.concatenate([
        np.full((len(surface.vertices), *first.shape[1:]), other, first.dtype) if numbers is None else numbers
        for surface, numbers in zip(surfaces, given)])


def mesh_of(surfaces: Sequence[Surface], context: Context | None) -> Mesh:
    """One mesh of several; what only some have is white, no normal, the picture's corner, no number."""
    first = np.cumsum([0] + [len(surface.vertices) for surface in surfaces])
    streams: dict[str, Any] = {}
    for name, width, otherwise in (("normals", 3, 0), ("colors", 4, 1), ("texcoords", 2, 0)):
        parts = [getattr(surface, name) for surface in surfaces]
        if any(part is not None for part in parts):
            streams[name] = np.concatenate([
                np.full((len(surface.vertices), width), otherwise, np.float32) if part is None
                else as_contiguous(part, np.float32, (len(surface.vertices), width), name)
                for surface, part in zip(surfaces, parts)])
    for name in dict.fromkeys(name for surface in surfaces for name in surface.numbers):
        streams[name] = _joined(name, surfaces)
    if any(surface.materials for surface in surfaces):
        materials: list[tuple[Any, Any]] = []
        which = []
        for surface in surfaces:
            own = surface.triangle_materials
            which.append(len(materials) + (np.zeros(len(surface.triangles), np.int64) if own is None else own))
            materials += surface.materials or [WHITE]
        streams.update(materials=materials, triangle_materials=np.concatenate(which))
    return Mesh(np.concatenate([np.asarray(surface.vertices, np.float64) for surface in surfaces]),
                np.concatenate([np.asarray(surface.triangles, np.int64) + at for surface, at in zip(surfaces, first)]),
                context=context, **streams)
