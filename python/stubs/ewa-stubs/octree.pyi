# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/octree.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
import math
import os
from typing import TYPE_CHECKING, Any, Iterable, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import Array
from ._context import Context, Core, Handle, core_of
from ._errors import ArgumentError, ClosedError
from ._library import functions as lib
from ._scene import World
from ._struct import fill, initialised, numbers, path_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .rendering import Renderer, draw
from .shade import Light
from typing_extensions import Unpack
from ._options import LodBuildOptions, LodOptions
_SAMPLE_POINTS: Any
class Octree:
    def __init__(self, path: PathLike, *, context: Context | None=None) -> None: ...
    def __reduce__(self) -> Any: ...
    def __len__(self) -> int: ...
    @property
    def bounds(self) -> Array: ...
    @property
    def level_count(self) -> int: ...
    def sample(self, maximum_points: int=_SAMPLE_POINTS) -> Cloud: ...
    def read(self, low: Sequence[float] | None=None, high: Sequence[float] | None=None, spacing: float=0.0) -> Cloud: ...
    def render(self, camera: Camera | None=None, *, size: Sequence[int] | None=None, planes: str | Iterable[str]=('rgba8',), background: Color='white', lights: Sequence[Light] | None=None, section_box: Any=None, section_planes: Sequence[Sequence[float]] | None=None, renderer: Renderer | None=None, render: dict[str, Any] | None=None,
            spacing_px: float | None = None,  # nodes are drawn by surfels that represent their points where these are no farther apart; (0, 64] px; default 1
            error: float | None = None,  # and expected to be off by no more than so much, rms, in 1/255; 0: all points; [0, 255]; default 3
            memory_bytes: int | None = None,  # memory for nodes; a picture that needs more is drawn in bands; [16777216, 1.125899907e15] bytes; default 1073741824
            load_s: float | None = None,  # time for reading nodes; what is missing then is drawn coarser; 0: as long as it takes; [0, 1e15] s; default 0
            share: int | None = None,  # part that a rank draws of what a renderer of several ranks shows; [0, 1048576]; default 0
            share_count: int | None = None,  # of so many; 0: no parts; [0, 1048576]; default 0
            max_splats: int | None = None,  # about so many surfels and points are drawn of octrees, coarser ones where it would be more; 0: 8 for each pixel that they cover; [0, 9.007199255e15]; default 0
            resident_only: bool | None = None,  # nothing is read: nodes that are not in memory are drawn coarser and counted as missing; default False
            ) -> Image: ...
    def close(self) -> None: ...
    def __repr__(self) -> str: ...
def build_octree(sources: PathLike | Sequence[PathLike], target: PathLike, *, context: Context | None=None,
        memory_bytes: int | None = None,  # memory for points at hand; [67108864, 1.125899907e15] bytes; default 2147483648
        subset: int | None = None,  # which part is made, counted from 0; [0, 65535]; default 0
        subset_count: int | None = None,  # how many parts are made, to be merged; 1: the whole at once; [1, 65536]; default 1
        keep_going: bool | None = None,  # step over damaged pieces of files; default False
        ) -> None: ...
def is_folder(core: Core, path: PathLike) -> bool: ...
