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
from ._keywords import keywords
from ._library import functions as lib
from ._scene import World
from ._struct import fill, initialised, numbers, path_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .rendering import Renderer, draw
from .shade import Light

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
    _world: World | None = None
    _asset: Handle | None = None

    def __init__(self, path: PathLike, *, context: Context | None = None) -> None:
        core = core_of(context)
        self._path = path
        self._handle = core.make(lib.ewa_lod_open, core.address, path_bytes(path), destroy=lib.ewa_lod_close,
                                 what="the octree")

    def __reduce__(self) -> Any:
        return Octree, (self._path,)

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

    @keywords("ewa_lod_options")
    def render(self, camera: Camera | None = None, *, size: Sequence[int] | None = None,
               planes: str | Iterable[str] = ("rgba8",), background: Color = "white",
               lights: Sequence[Light] | None = None, section_box: Any = None,
               section_planes: Sequence[Sequence[float]] | None = None, renderer: Renderer | None = None,
               render: dict[str, Any] | None = None, **options: Unpack[LodOptions]) -> Image:
        """Draw the octree, every part as coarse as the options allow, reading what is needed.

        Parameters
        ----------
        camera, size, planes, background, lights, section_box, section_planes, renderer
            As of :func:`render`. Default camera: that of ``ewa render``.
        render : dict, optional
            Members of ``ewa_render_options``.
        **options

        Raises
        ------
        ArgumentError, FileError, FormatError, OutOfMemory, ClosedError
        """
        if self._world is None:
            self._world = World(self._core)
            self._world.add(self)
        return draw(self._world, camera, size=size, planes=planes, background=background, lights=lights,
                    section_box=section_box, section_planes=section_planes, renderer=renderer, render=render, lod=options)

    def close(self) -> None:
        """Close the file and free the nodes; later use raises ClosedError."""
        self._handle = self._world = self._asset = None

    def _asset_members(self) -> dict[str, Any]:
        return {"lod": self._h}

    def __repr__(self) -> str:
        return "<ewa.Octree, closed>" if self._handle is None else f"<ewa.Octree of {len(self)} points>"


@keywords("ewa_lod_build_options")
def build_octree(sources: PathLike | Sequence[PathLike], target: PathLike, *, attributes: Iterable[str] | None = None,
                 context: Context | None = None, **options: Unpack[LodBuildOptions]) -> None:
    """Make one COPC file of the points of any files, with surfels that represent the points of each node.

    Parameters
    ----------
    sources : path or sequence of path
    target : path
        .copc.laz
    attributes : iterable of str, optional
        Attributes of one number that surfels which represent points have, too: what pictures of levels are coloured and filtered by.
        Default: classification and intensity, where the points have them.
    **options

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
    if attributes is not None:
        made.attributes = ",".join([attributes] if isinstance(attributes, str) else attributes).encode()
    core = core_of(context)
    core.call(lib.ewa_lod_build, core.address, array, len(paths), path_bytes(target), ctypes.byref(made), None)


def is_folder(core: Core, path: PathLike) -> bool:
    """Whether a path is a folder of EPT, or its ept.json."""
    name = os.fspath(path)
    base = os.fsencode(os.path.basename(name))
    return (os.path.isdir(name) or base == b"ept.json") and bool(
        core.value(lib.ewa_lod_probe, core.address, path_bytes(path)))
