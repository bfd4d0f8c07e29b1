# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Clouds larger than memory: octrees of points in files, COPC and EPT, of which a picture reads what it shows."""
from __future__ import annotations

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
from ._struct import fill, initialised, numbers, path_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .rendering import Renderer, _shared, new_frame, options_of
from .shade import Light
from .surfels import complete

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import LodBuildOptions, LodOptions

# A sample stands for the whole where that is framed.
_SAMPLE_POINTS = 400000


class Octree:
    """An octree of points in a file, with the nodes that are in memory.

    Parameters
    ----------
    path : path
        A COPC file (.copc.laz), a folder of EPT or its ept.json.

    Raises
    ------
    FileError, FormatError, OutOfMemory
    """

    _handle: Handle | None

    def __init__(self, path: PathLike, *, context: Context | None = None) -> None:
        core = core_of(context)
        self._handle = core.make(lib.ewa_lod_open, core.address, path_bytes(path), destroy=lib.ewa_lod_close,
                                 what="the octree")

    @property
    def _h(self) -> Handle:
        if self._handle is None:
            raise ClosedError("the octree is closed")
        return self._handle

    @property
    def _core(self) -> Core:
        return self._h.core

    @property
    def _info(self) -> b.ewa_lod_info:
        info = b.ewa_lod_info()
        self._core.value(lib.ewa_lod_describe, self._h, ctypes.byref(info))
        return info

    def __len__(self) -> int:
        """Points, as the hierarchy says."""
        return self._info.point_count

    @property
    def bounds(self) -> Array:
        """Lower and upper corner of the points, world units; float64, shape (2, 3)."""
        box = self._info.bounds
        return np.array([box.low_world, box.high_world])

    @property
    def level_count(self) -> int:
        """Levels, the coarsest counted too."""
        return self._info.level_count

    def sample(self, maximum_points: int = _SAMPLE_POINTS) -> Cloud:
        """Return whole levels, from the coarsest on, as long as they have at most so many points together.

        Raises
        ------
        ArgumentError, FileError, FormatError, OutOfMemory
        """
        if not 1 <= maximum_points < 2**64:
            raise ArgumentError(f"maximum_points: {maximum_points} is outside [1, 2^64)")
        return Cloud._made(self._core, lib.ewa_lod_sample, self._h, maximum_points)

    def read(self, low: Sequence[float] | None = None, high: Sequence[float] | None = None,
             spacing: float = 0.0) -> Cloud:
        """Return the points of a box, both sides included, of levels down to a spacing; world units.

        Parameters
        ----------
        low, high : array_like, shape (3,), optional
            Default: everything.
        spacing : float, optional
            0 (default): all points.

        Raises
        ------
        ArgumentError, FileError, FormatError, OutOfMemory
        """
        corners = [numbers(end, 3, name) if end is not None else (ctypes.c_double * 3)(*3 * [none])
                   for name, end, none in (("low", low, -math.inf), ("high", high, math.inf))]
        return Cloud._made(self._core, lib.ewa_lod_read, self._h, *corners, numbers([spacing], 1, "spacing")[0])

    def render(self, camera: Camera | None = None, *, size: Sequence[int] | None = None,
               planes: str | Iterable[str] = ("rgba8",), background: Color = "white",
               lights: Sequence[Light] | None = None, section_box: Any = None,
               section_planes: Sequence[Sequence[float]] | None = None, renderer: Renderer | None = None,
               render: dict[str, Any] | None = None, **options: Unpack[LodOptions]) -> Image:
        """Draw the octree, every part as coarse as the options allow, reading what is needed.

        Parameters
        ----------
        camera, size, planes, background, lights, section_box, section_planes, renderer
            As of :func:`render`. Default camera: that of a sample.
        render : dict, optional
            Members of ``ewa_render_options``.
        **options
            Members of ``ewa_lod_options``: ``spacing_px``, ``error``, ``memory_bytes``, ``load_s``.

        Raises
        ------
        ArgumentError, FileError, FormatError, OutOfMemory, ClosedError
        """
        if camera is None:
            camera = Camera.frame(complete(self.sample()), size=size or (1280, 720))
        elif not isinstance(camera, Camera):
            raise TypeError(f"camera: an ewa.Camera, not {type(camera).__name__}")
        if size is not None and tuple(size) != camera.size:
            camera = camera.resized(*size)
        core = self._core
        made, opaque, keep = options_of(dict(render or {}), lights, None, None, background, None, section_box,
                                        section_planes, core)
        chosen = initialised(b.ewa_lod_options, lib.ewa_lod_options_init)
        fill(chosen, "ewa_lod_options", options)
        image = Image(camera, opaque)
        frame = new_frame(image, camera.size, planes, None)
        stats = b.ewa_lod_stats()
        handle = renderer._handle if renderer is not None else _shared(core, "cpu")
        core.call(lib.ewa_lod_render, self._h, handle, ctypes.byref(camera._struct), ctypes.byref(made),
                  ctypes.byref(chosen), ctypes.byref(frame), ctypes.byref(stats))
        del keep
        image._stats = stats
        return image

    def close(self) -> None:
        """Close the file and free the nodes; later use raises ClosedError."""
        self._handle = None

    def __repr__(self) -> str:
        return "<ewa.Octree, closed>" if self._handle is None else f"<ewa.Octree of {len(self)} points>"


def build_octree(sources: PathLike | Sequence[PathLike], target: PathLike, *, context: Context | None = None,
                 **options: Unpack[LodBuildOptions]) -> None:
    """Make one COPC file of the points of any files, with surfels that represent the points of each node.

    Parameters
    ----------
    sources : path or sequence of path
    target : path
        .copc.laz
    **options
        Members of ``ewa_lod_build_options``: ``memory_bytes``, ``subset``, ``subset_count``, ``keep_going``.

    Raises
    ------
    ArgumentError, FileError, FormatError, OutOfMemory
    """
    paths = [sources] if isinstance(sources, (str, bytes, os.PathLike)) else list(sources)
    if not paths:
        raise ArgumentError("sources: there is none")
    array = (ctypes.c_char_p * len(paths))(*[path_bytes(path, "sources") for path in paths])
    made = initialised(b.ewa_lod_build_options, lib.ewa_lod_build_options_init)
    fill(made, "ewa_lod_build_options", options)
    core = core_of(context)
    core.call(lib.ewa_lod_build, core.address, array, len(paths), path_bytes(target), ctypes.byref(made), None)


def is_folder(core: Core, path: PathLike) -> bool:
    """Whether a path is a folder of EPT, or its ept.json."""
    name = os.fspath(path)
    base = os.fsencode(os.path.basename(name))
    return (os.path.isdir(name) or base == b"ept.json") and bool(
        core.value(lib.ewa_lod_probe, core.address, path_bytes(path)))
