# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Scenes: everything that a picture shows, of any files and objects, as the program and the viewer draw it."""
from __future__ import annotations

import ctypes
import json
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._context import Context, Core, Handle, core_of
from ._errors import ArgumentError, ClosedError
from ._keywords import keywords
from ._library import functions as lib
from ._scene import World, core_of_things, is_path, view_options
from ._struct import fill, initialised, numbers, path_bytes, text_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .gaussians import Gaussians
from .image import Color, Image
from .profiles import Profile
from .rendering import draw, draw_outlines
from .shade import Environment, Light, Materials
from .volume import Volume

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import AssetOptions, FurnitureOptions, RenderOptions, SurfelsOptions

@keywords("ewa_surfels_options")
class Scene:
    """Instances of clouds, meshes, octrees, Gaussians and volumes, drawn together.

    Clouds and meshes become one surface; clouds without normals and radii that overlap or touch are estimated
    together. What is added to a scene has to stay open as long as the scene is used.

    Parameters
    ----------
    *things : objects
        Each is added as by :meth:`add`.
    close_gaps : bool, optional
        Measure radii anew where those of files leave gaps. Default True.
    up : {"auto", "y", "z", "-y", "-z"}, optional
        What is up. Default: as files and points say.
    **surfels

    Raises
    ------
    FileError, FormatError, ArgumentError, OutOfMemory
    """

    def __init__(self, *things: Any, close_gaps: bool = True, up: str = "auto",
                 context: Context | None = None, **surfels: Unpack[SurfelsOptions]) -> None:
        self._core: Core = core_of_things(things) if context is None else core_of(context)
        self._world = World(self._core, close_gaps=close_gaps, up=up, surfels=surfels)
        for thing in things:
            self.add(thing)

    def __len__(self) -> int:
        return int(self._core.value(lib.ewa_scene_count, self._handle))

    @keywords("ewa_asset_options")
    def add(self, thing: Any, *, visible: bool = True, opacity: float = 1.0, radius_scale: float = 1.0,
            color_by: str = "", colormap: str = "auto", range: Sequence[float] | None = None,
            tint: Sequence[float] | None = None, transfer: str | None = None, to_world: Any = None,
            **options: Unpack[AssetOptions]) -> int:
        """Add something; returns its number.

        Parameters
        ----------
        thing : path, Cloud, Mesh, Surfels, Octree, Gaussians, Splats, Volume, Voxels, or what :func:`as_drawables` takes
            Of a scene file (``.json``), everything that it names is added, as it says; its options and its camera become
            the scene's. The number is that of the first one.
        visible, opacity, radius_scale, color_by, colormap, range, tint : optional
            How it is shown; all but `visible` are of points, the colours of Gaussians, too.
        transfer : str, optional
            Of volumes: a file of a transfer function, or the name of a preset.
        to_world : array_like, shape (4, 4), optional
            Where its coordinates lie in the scene; acts on columns.
        **options

        Raises
        ------
        FileError, FormatError, ArgumentError, OutOfMemory
        """
        made = initialised(b.ewa_asset_options, lib.ewa_asset_options_init)
        fill(made, "ewa_asset_options", options)
        fill(made, "ewa_asset_options", {"to_world": to_world}, own=True)
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
        if not is_path(thing):
            plain = transfer is None and to_world is None and all(value is None for value in options.values())
            self._world.add(thing, None if plain else made, instance)
        else:
            changed = not visible or opacity != 1 or radius_scale != 1 or color_by or range is not None or tint is not None
            if changed and self._core.value(lib.ewa_scene_file_probe, path_bytes(thing)):
                raise ArgumentError(f"{thing}: how its items are shown is said in the scene file")
            self._world.add(thing, made, instance)
        return number

    def _whole(self) -> World:
        """What is drawn; raises ClosedError where there is nothing more."""
        self._handle
        return self._world

    @property
    def _handle(self) -> Handle:
        if self._world is None:
            raise ClosedError("the scene is closed")
        return self._world.handle

    @property
    def bounds(self) -> Array:
        """Lower and upper corner of all visible centres; float64, shape (2, 3)."""
        box = b.ewa_bounds()
        self._core.value(lib.ewa_scene_bounds, self._handle, ctypes.byref(box))
        return np.array([box.low_world, box.high_world])

    def camera(self, view: str | Sequence[float] | None = None, up: str | Sequence[float] | None = None, *,
               size: Sequence[int] | None = None, fov: float | None = None, ortho: float | None = None,
               eye: Sequence[float] | None = None, target: Sequence[float] | None = None, azimuth: float = 0,
               elevation: float = 0, color_bar: bool = False) -> Camera:
        """Return the camera of ``ewa render`` with the same options: that of the scene file, if there is one, where they
        say nothing but the size.

        Parameters
        ----------
        size : (int, int), optional
            Width and height in pixels. Default: those of the scene file's camera, else 1280 x 720.
        view, up, fov, ortho, eye, target, azimuth, elevation : optional
            As of :meth:`Camera.frame`.
        color_bar : bool
            Leave room for a colour bar. Default: False.

        Raises
        ------
        ArgumentError, NumericError
        """
        asked = view_options(view, up, size=size, fov=fov, ortho=ortho, eye=eye, target=target, azimuth=azimuth,
                             elevation=elevation, color_bar=color_bar)
        return Camera._of(self._world.place(asked))

    @keywords("ewa_render_options")
    def render(self, camera: Camera | None = None, *, size: Sequence[int] | None = None,
               planes: str | Iterable[str] = ("rgba8",), background: Color | None = None,
               lights: Sequence[Light] | None = None, materials: Materials | None = None,
               environment: Environment | Any = None, layers: int | str | None = None, section_box: Any = None,
               section_planes: Sequence[Sequence[float]] | None = None, out: Image | None = None,
               panorama: str | Mapping[str, Any] | None = None, **options: Unpack[RenderOptions]) -> Image:
        """Draw a frame: the bytes of ``ewa render`` with the same files, camera and options. Those that are not given are of the
        scene file, if there is one.

        Parameters
        ----------
        camera : Camera, optional
            Default: :meth:`camera`.
        background : colour, optional
            Default: white, or that of the scene file.
        size, planes, lights, materials, environment, layers, section_box, section_planes, out, panorama
            As of :func:`render`.
        **options

        Raises
        ------
        ArgumentError, FormatError, OutOfMemory, ClosedError
        """
        return draw(self._world, camera, size=size, planes=planes, background=background, lights=lights,
                    materials=materials, environment=environment, layers=layers, section_box=section_box,
                    section_planes=section_planes, out=out, render=options, panorama=panorama)

    def draw_outlines(self, image: Image, count: int) -> None:
        """Draw the outlines of `count` of the surfels that are seen over a picture that :meth:`render` made.

        Raises
        ------
        ArgumentError, OutOfMemory
        """
        draw_outlines(self._world, image, count)

    def points(self) -> Cloud:
        """Return the points of all that is visible as one cloud, with every attribute of their files, without those that are
        hidden or cut away by the sections of a scene file.

        Raises
        ------
        ArgumentError, OutOfMemory, ClosedError
        """
        return Cloud._made(self._core, lib.ewa_scene_points, self._handle)

    def gaussians(self) -> Gaussians:
        """Return the trained Gaussians of the one visible file of them, read again, without those that are hidden or cut away by
        the sections of a scene file.

        Raises
        ------
        ArgumentError, FileError, FormatError, OutOfMemory, ClosedError
        """
        return Gaussians._of_scene(self._core, self._handle)

    def volume(self) -> Volume:
        """Return the part of the one visible volume's file that is neither hidden nor cut away by the sections of a scene file: the
        smallest grid around it, in which other voxels are empty.

        Raises
        ------
        ArgumentError, FileError, FormatError, OutOfMemory, ClosedError
        """
        return Volume._made(self._core, lib.ewa_scene_volume, self._handle)

    def hide(self, *, box: Any = None, outline: Any = None, camera: Camera | None = None,
             classes: Iterable[int] | None = None) -> None:
        """Hide points, Gaussians and voxels: those for whose places and classes all that is given holds.

        Parameters
        ----------
        box : array_like of shape (2, 3), optional
            Its lower and its upper corner, world units.
        outline : array_like of shape (n, 2), optional
            Corners on the picture of `camera`, pixels.
        camera : Camera, optional
            Default: :meth:`camera`.
        classes : iterable of int, optional
            Codes of the attribute ``classification``.

        Raises
        ------
        ArgumentError, ClosedError
        """
        self._add_region(False, box, outline, camera, classes)

    def keep(self, *, box: Any = None, outline: Any = None, camera: Camera | None = None,
             classes: Iterable[int] | None = None) -> None:
        """Hide all other points, Gaussians and voxels than those that :meth:`hide` would.

        Raises
        ------
        ArgumentError, ClosedError
        """
        self._add_region(True, box, outline, camera, classes)

    def show_all(self) -> None:
        """Show again all that :meth:`hide` and :meth:`keep` have hidden."""
        options = self._options()
        options.region_count = 0
        self._core.call(lib.ewa_scene_set_options, self._handle, ctypes.byref(options))

    def _options(self) -> b.ewa_scene_options:
        options = b.ewa_scene_options()
        self._core.value(lib.ewa_scene_get_options, self._handle, ctypes.byref(options))
        return options

    def _add_region(self, kept: bool, box: Any, outline: Any, camera: Camera | None, classes: Iterable[int] | None) -> None:
        options = self._options()
        if options.region_count == b.EWA_MAX_REGIONS:
            raise ArgumentError(f"there are {b.EWA_MAX_REGIONS} regions already")
        region = options.regions[options.region_count]
        options.region_count += 1
        region.kept = kept
        if box is not None:
            region.has_box = True
            region.box_world[:] = numbers(box, 6, "box")
        if classes is not None:
            region.has_classes = True
            for code in classes:
                if not 0 <= code < b.EWA_REGION_CLASSES:
                    raise ArgumentError(f"classes: {code} is no code from 0 to {b.EWA_REGION_CLASSES - 1}")
                region.classes[code // 32] |= 1 << code % 32
        if outline is not None:
            corners = [float(number) for corner in outline for number in corner]
            seen = camera if camera is not None else self.camera()
            made = (ctypes.c_double * len(corners))(*corners)
            self._core.call(lib.ewa_region_set_outline, ctypes.byref(region), ctypes.byref(seen._struct), made,
                            len(corners) // 2)
        self._core.call(lib.ewa_scene_set_options, self._handle, ctypes.byref(options))

    def profile(self, line: Any, width: float = 1.0, up: Sequence[float] | None = None) -> Profile:
        """Take the points beside a line on the map, of all that is visible.

        Parameters
        ----------
        line : array_like of shape (n, 2) or (n, 3)
            Its corners, world units; only where it goes on the map counts.
        width : float
            Of the strip, half of it on each side; world units.
        up : sequence of 3 floats, optional
            In which heights count. Default: as the files say.

        Raises
        ------
        ArgumentError, NumericError, OutOfMemory, ClosedError
        """
        return Profile(self._core, self._handle, line, width, up)

    @keywords("ewa_furniture_options")
    def draw_furniture(self, image: Image, *, title: str | None = None, unit: str | None = None,
                       color_label: str | None = None, color_unit: str | None = None,
                       **options: Unpack[FurnitureOptions]) -> Image:
        """Draw a title, axes, a scale bar and a colour bar over a picture that was drawn, as ``ewa render`` does.

        Parameters
        ----------
        image : Image
            With the plane rgba8, which is drawn into; returned.
        title : str, optional
        unit : str, optional
            Of the world's lengths, such as "m". Default: as the reference systems of the files say.
        color_label, color_unit : str, optional
            Above the colour bar. Default: what the scene is coloured by.
        **options
            ``scale_depth_world``: Default: that of the scene's middle. ``colormap``: Default: that of the scene. ``range``:
            Default: that of the scene.

        Raises
        ------
        ArgumentError
        """
        made = initialised(b.ewa_furniture_options, lib.ewa_furniture_options_init)
        camera = image.camera
        if camera is None or not image.rgba8.flags.carray:
            raise ArgumentError("image: the plane rgba8 of a picture, as render() makes it")
        if options.get("scale_bar") and options.get("scale_depth_world") is None:
            middle = np.array([*self._world.view(view_options())[1].pivot_world, 1.0])
            depth = float(camera.world_to_camera[2] @ middle / np.linalg.norm(camera.world_to_camera[2, :3]))
            made.scale_depth_world = depth if 0 < depth < 1e30 else 0
        info = b.ewa_scene_info()
        self._core.value(lib.ewa_scene_describe, self._handle, ctypes.byref(info))
        if unit is None and info.unit:
            unit = info.unit.decode()
        legend = self._legend() if options.get("color_bar") else None
        if legend is not None:
            made.colormap, made.range[:] = legend.colormap, list(legend.range)
            made.categories, made.category_count = legend.categories, legend.category_count
            made.color_label = legend.attribute
            made.color_unit = unit.encode() if unit is not None and legend.length else None
        fill(made, "ewa_furniture_options", options)
        for name, text in (("title", title), ("unit", unit), ("color_label", color_label), ("color_unit", color_unit)):
            if text is not None:
                setattr(made, name, text.encode())
        canvas = b.ewa_canvas()
        canvas.rgba8 = image.rgba8.ctypes.data
        canvas.width_px, canvas.height_px = image.size
        self._core.call(lib.ewa_furniture_draw, self._core.address, ctypes.byref(camera._struct), ctypes.byref(made),
                        ctypes.byref(canvas))
        return image

    def _legend(self) -> b.ewa_legend | None:
        """What the colours of the first item mean whose colours stand for something."""
        for i in range(len(self)):
            found = self._core.value(lib.ewa_scene_legend, self._handle, i)
            if found:
                legend: b.ewa_legend = found.contents
                return legend
        return None

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
        self._world = None  # type: ignore[assignment]
