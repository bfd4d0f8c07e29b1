# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Scenes: everything that a picture shows, of any files and objects, as the program and the viewer draw it."""
from __future__ import annotations

import ctypes
import json
from typing import Any, Iterable, Sequence, Union

from . import _bindings as b
from ._arrays import Array
from ._context import Context, Core, core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import fill, initialised, numbers, path_bytes, text_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .gaussians import Gaussians, Splats
from .image import Color, Image
from .mesh import Mesh
from .octree import Octree
from .rendering import new_frame, options_of, renderer_of
from .shade import Environment, Light, Materials
from .surfels import Surfels
from .volume import Volume, Voxels

#: What a scene takes beside the names of files.
Drawable = Union[Cloud, Mesh, Surfels, Octree, Gaussians, Splats, Volume, Voxels]

_VIEWS = ("front", "back", "left", "right", "top", "bottom", "iso")
_UPS = {"y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class Scene:
    """Instances of clouds, meshes, octrees, Gaussians and volumes, drawn together.

    Clouds and meshes become one surface; clouds without normals and radii that overlap or touch are estimated
    together. What is added to a scene has to stay open as long as the scene is used.

    Parameters
    ----------
    *things : path, Cloud, Mesh, Surfels, Octree, Gaussians, Splats, Volume or Voxels
        Each is added as by :meth:`add`.
    close_gaps : bool, optional
        Measure radii anew where those of files leave gaps. Default True.
    up : {"auto", "y", "z", "-y", "-z"}, optional
        What is up. Default: as files and points say.
    **surfels
        Members of ``ewa_surfels_options``, of all surfaces: ``cutoff``, ``radius_scale``, ``level_count``.

    Raises
    ------
    FileError, FormatError, ArgumentError, OutOfMemory
    """

    def __init__(self, *things: PathLike | Drawable, close_gaps: bool = True, up: str = "auto",
                 context: Context | None = None, **surfels: Any) -> None:
        own = next((thing for thing in things if hasattr(thing, "_core") or hasattr(thing, "_h")), None)
        self._core: Core = _core_of(own) if own is not None and context is None else core_of(context)
        options = initialised(b.ewa_scene_options, lib.ewa_scene_options_init)
        fill(options, "ewa_scene_options", {"close_gaps": close_gaps, "up": up})
        fill(options.surfels, "ewa_surfels_options", surfels)
        self._keep: list[Any] = []
        self._handle = self._core.make(lib.ewa_scene_create, self._core.address, ctypes.byref(options),
                                       destroy=lib.ewa_scene_destroy, what="the scene")
        for thing in things:
            self.add(thing)

    def __len__(self) -> int:
        return int(self._core.value(lib.ewa_scene_count, self._handle))

    def add(self, thing: PathLike | Drawable, *, visible: bool = True, opacity: float = 1.0, radius_scale: float = 1.0,
            color_by: str = "", colormap: str = "auto", range: Sequence[float] | None = None,
            tint: Sequence[float] | None = None, transfer: str | None = None, **options: Any) -> int:
        """Add something; returns its number.

        Parameters
        ----------
        thing : path, Cloud, Mesh, Surfels, Octree, Gaussians, Splats, Volume or Voxels
            Of a scene file (``.json``), everything that it names is added, as it says; its options and its camera become
            the scene's. The number is that of the first one.
        visible, opacity, radius_scale, color_by, colormap, range, tint : optional
            How it is shown; all but `visible` are of points.
        transfer : str, optional
            Of volumes: a file of a transfer function, or the name of a preset.
        **options
            Members of ``ewa_asset_options``: ``to_world``, ``gaussians_as_surfels``, ``levels``, ``cutoff``, ...

        Raises
        ------
        FileError, FormatError, ArgumentError, OutOfMemory
        """
        made = initialised(b.ewa_asset_options, lib.ewa_asset_options_init)
        fill(made, "ewa_asset_options", options)
        if transfer is not None:
            made.transfer = path_bytes(transfer, "transfer")
        instance = initialised(b.ewa_instance, lib.ewa_instance_init)
        fill(instance, "ewa_instance", {"visible": visible, "opacity": opacity, "radius_scale": radius_scale})
        coloring: dict[str, Any] = {"map": colormap}
        if range is not None:
            coloring.update(ranged=True, range=range)
        if tint is not None:
            coloring.update(tinted=True, tint=tint)
        fill(instance.coloring, "ewa_coloring", coloring)
        instance.coloring.attribute = text_bytes(color_by, b.EWA_SCALAR_NAME_BYTES, "color_by")
        number = len(self)
        if not (hasattr(thing, "_core") or hasattr(thing, "_h")) and \
                self._core.value(lib.ewa_scene_file_probe, path_bytes(thing)):
            if not visible or opacity != 1 or radius_scale != 1 or color_by or range is not None or tint is not None:
                raise ArgumentError(f"{thing}: how its items are shown is said in the scene file")
            self._core.call(lib.ewa_scene_open, self._handle, path_bytes(thing), ctypes.byref(made))
            return number
        asset = self._load(thing, made)
        self._core.call(lib.ewa_scene_add, self._handle, asset, ctypes.byref(instance))
        self._keep.append(thing)
        return number

    def _load(self, thing: Any, options: b.ewa_asset_options) -> Any:
        """The asset of a file or an object."""
        core = self._core

        def make(function: Any, *arguments: Any) -> Any:
            return core.make(function, *arguments, destroy=lib.ewa_asset_release, what="the asset")

        source = b.ewa_asset_source()
        if isinstance(thing, (Mesh, Gaussians, Volume)):
            name = {Mesh: "mesh", Gaussians: "gaussians", Volume: "volume"}[type(thing)]

            def create(pointer: Any, *given: Any) -> int:
                setattr(source, name, ctypes.cast(pointer, type(getattr(source, name))))
                status: int = lib.ewa_asset_create(core.address, ctypes.byref(source), *given)
                return status

            if isinstance(thing, Gaussians):
                source.up_world[:] = _up_of(thing._up)
            return make(thing._bound(create), ctypes.byref(options))
        if isinstance(thing, (Cloud, Surfels, Octree, Splats, Voxels)):
            name = {Cloud: "cloud", Surfels: "surfels", Octree: "lod", Splats: "splats", Voxels: "voxels"}[type(thing)]
            handle = thing._h if isinstance(thing, (Cloud, Surfels, Octree)) else thing._handle
            setattr(source, name, core.resolve(handle))
            if isinstance(thing, (Splats, Voxels)):
                outline = thing.outline()
                self._keep.append(outline)
                source.outline = core.resolve(outline._h)
                source.up_world[:] = _up_of(thing._up) if isinstance(thing, Splats) else (0.0, 0.0, 1.0)
                source.flat = isinstance(thing, Voxels) and thing._flat
            return make(lib.ewa_asset_create, core.address, ctypes.byref(source), ctypes.byref(options))
        if hasattr(thing, "_core") or hasattr(thing, "_h"):
            raise TypeError(f"thing: a path, a cloud, a mesh, surfels, an octree, Gaussians, splats, a volume or voxels, "
                            f"not {type(thing).__name__}")
        return make(lib.ewa_asset_load, core.address, path_bytes(thing), ctypes.byref(options))

    @property
    def bounds(self) -> Array:
        """Lower and upper corner of all visible centres; float64, shape (2, 3)."""
        import numpy as np

        box = b.ewa_bounds()
        self._core.value(lib.ewa_scene_bounds, self._handle, ctypes.byref(box))
        return np.array([box.low_world, box.high_world])

    def camera(self, view: str | None = None, up: str | Sequence[float] | None = None, *,
               size: Sequence[int] | None = None, fov: float | None = None, ortho: float | None = None,
               eye: Sequence[float] | None = None, target: Sequence[float] | None = None, azimuth: float = 0,
               elevation: float = 0) -> Camera:
        """Return the camera of ``ewa render`` with the same options: that of the scene file, if there is one, where they
        say nothing but the size.

        Parameters
        ----------
        size : (int, int), optional
            Width and height in pixels. Default: those of the scene file's camera, else 1280 x 720.
        view, up, fov, ortho, eye, target, azimuth, elevation : optional
            As of :meth:`Camera.frame`.

        Raises
        ------
        ArgumentError, NumericError
        """
        made = initialised(b.ewa_view_options, lib.ewa_view_options_init)
        members: dict[str, Any] = {"azimuth_deg": float(azimuth), "elevation_deg": float(elevation)}
        if size is not None:
            members.update(width_px=size[0], height_px=size[1])
        if fov is not None:
            members["fov_deg"] = fov
        if ortho is not None:
            members["ortho_height_world"] = ortho
        if up is not None:
            if isinstance(up, str) and up not in _UPS:
                raise ArgumentError(f"up: '{up}' is none of {', '.join(_UPS)}, nor 3 numbers")
            members["up_world"] = _UPS[up] if isinstance(up, str) else list(numbers(up, 3, "up"))
        if eye is not None:
            members.update(has_eye=True, eye_world=list(numbers(eye, 3, "eye")))
        if target is not None:
            members.update(has_target=True, target_world=list(numbers(target, 3, "target")))
        fill(made, "ewa_view_options", members)
        if view is not None:
            if view not in _VIEWS:
                raise ArgumentError(f"view: '{view}' is none of {', '.join(_VIEWS)}")
            made.view = _VIEWS.index(view)
        camera = b.ewa_camera()
        self._core.call(lib.ewa_scene_place_camera, self._handle, ctypes.byref(made), ctypes.byref(camera), None)
        return Camera._of(camera)

    def render(self, camera: Camera | None = None, *, size: Sequence[int] | None = None,
               planes: str | Iterable[str] = ("rgba8",), background: Color | None = None,
               lights: Sequence[Light] | None = None, materials: Materials | None = None,
               environment: Environment | Any = None, layers: int | str | None = None, section_box: Any = None,
               section_planes: Sequence[Sequence[float]] | None = None, out: Image | None = None,
               **options: Any) -> Image:
        """Draw a frame: the bytes of ``ewa render`` with the same files, camera and options.

        Parameters
        ----------
        camera : Camera, optional
            Default: :meth:`camera`.
        background : colour, optional
            Default: white, or that of the scene file.
        size, planes, lights, materials, environment, layers, section_box, section_planes, out
            As of :func:`render`.
        **options
            Members of ``ewa_render_options``; those that are not given are of the scene file, if there is one.

        Raises
        ------
        ArgumentError, FormatError, OutOfMemory, ClosedError
        """
        core = self._core
        if camera is None:
            camera = self.camera(size=size)
        if size is not None and tuple(size) != camera.size:
            camera = camera.resized(*size)
        made = initialised(b.ewa_scene_options, lib.ewa_scene_options_init)
        core.value(lib.ewa_scene_get_options, self._handle, ctypes.byref(made))
        _, opaque, keep = options_of(dict(options), lights, materials, environment, background, layers,
                                          section_box, section_planes, core, made.render)
        image = Image(camera, opaque)
        frame = new_frame(image, camera.size, planes, out)
        stats = b.ewa_scene_stats()
        renderer = renderer_of(core, "scene", _create_renderer, lib.ewa_scene_renderer_destroy)
        core.call(lib.ewa_scene_draw, self._handle, renderer, ctypes.byref(camera._struct), ctypes.byref(made),
                  ctypes.byref(frame), ctypes.byref(stats))
        del keep
        image._stats = stats.render
        return image

    def save(self, path: PathLike, camera: Camera | None = None) -> None:
        """Write a scene file: everything, which must have been added from files below the file's folder, and `camera`.

        Raises
        ------
        FileError, FormatError, OutOfMemory
        """
        of = ctypes.byref(camera._struct) if camera is not None else None
        self._core.call(lib.ewa_scene_save, self._handle, of, path_bytes(path))

    def describe(self) -> dict[str, Any]:
        """Return what the scene is: of every item its name, kind, count, box and how it is shown; the box of all; the
        options that are no defaults."""
        text = ctypes.c_char_p()
        self._core.call(lib.ewa_scene_describe_json, self._handle, ctypes.byref(text))
        made: dict[str, Any] = json.loads((text.value or b"{}").decode())
        lib.ewa_text_free(ctypes.byref(text))
        return made

    def close(self) -> None:
        """Free what was made for the scene; what was added to it stays."""
        self._handle = None  # type: ignore[assignment]
        self._keep.clear()


def _create_renderer(context: Any, made: Any) -> int:
    status: int = lib.ewa_scene_renderer_create(context, 0, None, made)
    return status


def _core_of(thing: Any) -> Core:
    core: Core = thing._core if hasattr(thing, "_core") else thing._h.core
    return core


def _up_of(name: str) -> tuple[float, float, float]:
    sign = -1.0 if name.startswith("-") else 1.0
    return (0.0, sign, 0.0) if name.endswith("y") else (0.0, 0.0, sign)
