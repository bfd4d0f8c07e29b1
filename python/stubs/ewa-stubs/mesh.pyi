# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/mesh.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
from typing import TYPE_CHECKING, Any, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import Array, as_colors, as_contiguous, as_numbers, export
from ._context import Context, Core, Handle, Pin, core_of
from ._errors import ArgumentError, ClosedError, FormatError
from ._library import functions as lib
from ._scene import is_path
from ._struct import Source, fill, initialised, loader, numbers, path_bytes
from .camera import PathLike
from .cloud import Cloud, merge_clouds
from .image import as_picture, linear_of_codes, pixels_struct
from .octree import Octree, is_folder
from typing_extensions import Unpack
from ._options import CloudSaveOptions, MeshSampleOptions
class Mesh:
    def __init__(self, vertices: Any, triangles: Any, *, normals: Any=None, colors: Any=None, texcoords: Any=None, materials: Sequence[tuple[Sequence[float], Any]] | None=None, triangle_materials: Any=None, context: Context | None=None) -> None: ...
    @property
    def vertices(self) -> Array: ...
    @property
    def triangles(self) -> Array: ...
    @property
    def closed(self) -> bool: ...
    def sample(self, *,
            point_count: int | None = None,  # about how many points; [0, inf); default 100000
            spacing_world: float | None = None,  # square root of the area per point away from edges, in world units; 0: by the count; [0, inf) world; default 0
            seed: int | None = None,  # same seed, same bytes, on every machine; [0, inf); default 1
            crease_degrees: float | None = None,  # edges that bend by more are sharp; [0, 180] deg; default 35
            radius_scale: float | None = None,  # support radius in units of the spacing; [0.5, 10]; default 1.6
            cutoff: float | None = None,  # standard deviations at which kernels end: axes are the support radius over this; (0, 4]; default 3
            clip_lines: bool | None = None,  # make sharp edges, corners and borders exact by clip lines; default True
            smooth_normals: bool | None = None,  # interpolate normals across edges that are not sharp; off: those of the triangles; default True
            texture_filter: Literal["nearest", "ewa", "optimal"] | None = None,  # how pictures come onto the points; default optimal
            pixel_sigma_px: float | None = None,  # standard deviation of the Gaussian that stands for one pixel of a picture, in pixels; [0.3, 8] px; default 0.5
            texcoords: bool | None = None,  # keep texture coordinates; default False
            ) -> Cloud: ...
    def __reduce__(self) -> Any: ...
    def close(self) -> None: ...
    def __repr__(self) -> str: ...
def read(path: Source, *more: Source, filter: str | Sequence[str] | None=None, vertices: bool=False, keep_going: bool=False, attributes: Sequence[str] | None=None, columns: Sequence[str] | None=None, heights: str='none', context: Context | None=None) -> Cloud: ...
def read_model(core: Core, source: Source) -> Cloud | Mesh: ...
def points_on(mesh: Mesh) -> Cloud: ...
def read_mesh(path: Source, *, context: Context | None=None) -> Mesh: ...
def sample(path: Source, *, context: Context | None=None,
        point_count: int | None = None,  # about how many points; [0, inf); default 100000
        spacing_world: float | None = None,  # square root of the area per point away from edges, in world units; 0: by the count; [0, inf) world; default 0
        seed: int | None = None,  # same seed, same bytes, on every machine; [0, inf); default 1
        crease_degrees: float | None = None,  # edges that bend by more are sharp; [0, 180] deg; default 35
        radius_scale: float | None = None,  # support radius in units of the spacing; [0.5, 10]; default 1.6
        cutoff: float | None = None,  # standard deviations at which kernels end: axes are the support radius over this; (0, 4]; default 3
        clip_lines: bool | None = None,  # make sharp edges, corners and borders exact by clip lines; default True
        smooth_normals: bool | None = None,  # interpolate normals across edges that are not sharp; off: those of the triangles; default True
        texture_filter: Literal["nearest", "ewa", "optimal"] | None = None,  # how pictures come onto the points; default optimal
        pixel_sigma_px: float | None = None,  # standard deviation of the Gaussian that stands for one pixel of a picture, in pixels; [0.3, 8] px; default 0.5
        texcoords: bool | None = None,  # keep texture coordinates; default False
        ) -> Cloud: ...
def convert(source: PathLike, target: PathLike, *, filter: str | Sequence[str] | None=None, crop: Any=None, voxel: float | None=None, distance: float | None=None, transform: Any=None, columns: Sequence[str] | None=None, context: Context | None=None,
        ply_encoding: Literal["little-endian", "big-endian", "ascii"] | None = None,  # how PLY files hold numbers; default little-endian
        step_world: float | None = None,  # step of the coordinates of LAS, world units; 0: that of the cloud, else by the size of the box; [0, inf); default 0
        chunk_points: int | None = None,  # points of one chunk of LAZ; [1, 10000000]; default 50000
        ) -> int: ...
