# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/volume.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
from typing import TYPE_CHECKING, Any, Iterable, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import DTYPE_OF, TYPE_OF, Array, as_numbers, export
from ._context import Context, Core, Handle, Pin, core_of
from ._errors import ArgumentError, ClosedError
from ._held import Held
from ._library import functions as lib
from ._scene import World, drawables_of, is_path
from ._struct import Source, fill, initialised, loader, numbers, path_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .rendering import draw
from .shade import Light
from typing_extensions import Unpack
from ._options import VolumeGenerateOptions, VolumeOptions
_T = b.ewa_type
_VOXELS: Any
class Volume(Held):
    def __init__(self, voxels: Any, *, spacing: float | Sequence[float]=1.0, index_to_world: Any=None, context: Context | None=None) -> None: ...
    @property
    def voxels(self) -> Array: ...
    @property
    def index_to_world(self) -> Array: ...
    @property
    def range(self) -> tuple[float, float]: ...
    def save(self, path: PathLike, *, plain: bool=False) -> None: ...
    def __reduce__(self) -> Any: ...
    def __repr__(self) -> str: ...
def read_volume(path: Source, *, dims: Sequence[int] | None=None, dtype: Any=None, big_endian: bool=False, header_bytes: int=0, spacing: Sequence[float] | None=None, context: Context | None=None) -> Volume: ...
def as_volume(value: Any, *, context: Context | None=None) -> Volume: ...
def generate_volume(object: str='checkerbox', *, context: Context | None=None,
        dims: Sequence[int] | None = None,  # voxels along each axis; [2, 4294967295]; default 128
        size_world: float | None = None,  # distance of the outermost voxels along the longest axis, in world units; (0, inf); default 1
        checks: float | None = None,  # cubes along an edge of checkerbox; (0, 1000000]; default 8
        seed: int | None = None,  # of the vessels: same seed, same bytes, on every machine; [0, inf); default 0
        ) -> Volume: ...
class Transfer:
    def __init__(self, points: Sequence[Any], *, unit_length: float=0.0, gradient: Sequence[float]=(0.0, 0.0)) -> None: ...
    @staticmethod
    def presets() -> dict[str, str]: ...
    @staticmethod
    def of(volume: Volume, name: str | PathLike='auto') -> Transfer: ...
    def __reduce__(self) -> Any: ...
    @property
    def points(self) -> list[tuple[float, tuple[float, float, float], float]]: ...
    def save(self, path: PathLike) -> None: ...
class Voxels:
    def __init__(self, volume: Any, transfer: Transfer | str='auto', *, level_count: int=2) -> None: ...
    @property
    def occupied_count(self) -> int: ...
    def outline(self, reach_steps: float=1.8) -> Cloud: ...
def render_volume(volume: Any, camera: Camera | None=None, *, transfer: Transfer | str='auto', size: Sequence[int] | None=None, planes: str | Iterable[str]=('rgba8',), background: Color='black', lights: Sequence[Light] | None=None, surfaces: Image | None=None, section_box: Any=None, section_planes: Sequence[Sequence[float]] | None=None, out: Image | None=None,
        method: Literal["hybrid", "splats", "points"] | None = None,  # voxels as splats where they are magnified and as points where they are minified, or all as one of these; default hybrid
        index: Literal["exact", "table"] | None = None,  # how a pixel finds its place in a splat: how far its ray passes the voxel's centre, or the paper's table; default exact
        sigma: float | None = None,  # standard deviation of the kernel around each voxel, in voxels; [0.3, 2]; default 0.6
        cutoff: float | None = None,  # standard deviations at which a kernel ends; [1, 4]; default 3
        prefilter_px: float | None = None,  # standard deviation of the pixel filter in pixels; 0: none; [0, 4] px; default 0.35
        point_threshold_px: float | None = None,  # spacing on the screen up to which voxels are points; [0, 1.5] px; default 1.2
        depth_unit: float | None = None,  # depth that is composited at once, in smallest spacings of the grid; [0.25, 16]; default 1
        level: int | None = None,  # which of the voxels' levels; 0: all voxels; [0, 3]; default 0
        density_scale: float | None = None,  # multiplies every extinction: 2 is twice as dense; [0, 1e15]; default 1
        minimum_transmittance: float | None = None,  # where less of what is behind would show, nothing more is drawn; 0: everything is; [0, 0.999999]; default 0.001953125
        shading: Literal["none", "lambert", "phong"] | None = None,  # light, by the gradient: none gives the bare colours, lambert matt matter, phong highlights; default none
        mark_splats: bool | None = None,  # draw voxels that are splats in red, points as they are; default False
        ) -> Image: ...
