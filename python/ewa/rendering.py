# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Pictures of surfels."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._context import Context, Core, Handle, core_of
from ._errors import ArgumentError
from ._keywords import keywords
from ._library import functions as lib
from ._options import RenderOptions, SurfelsOptions
from ._scene import World, core_of_things, things_of, view_options
from ._struct import fill, initialised, table
from .camera import Camera
from .image import Color, Image
from .shade import (Environment, Light, Materials, set_background, set_lights, set_materials, set_section)
from .surfels import Surfels

if TYPE_CHECKING:
    from typing_extensions import Unpack


class DrawOptions(RenderOptions, SurfelsOptions, total=False):
    """What clouds are drawn with."""


#: Names of planes: their types and numbers per pixel.
PLANES: dict[str, tuple[Any, int]] = {"rgba8": (np.uint8, 4), "rgba": (np.float32, 4), "depth": (np.float32, 1),
                                      "normal": (np.float32, 3), "coverage": (np.float32, 1)}
_BACKENDS = ("cpu", "gl", "gl-raster", "auto")


def new_frame(image: Image, size: tuple[int, int], planes: str | Iterable[str], out: Image | None,
              without: tuple[str, ...] = ()) -> b.ewa_frame:
    """Make the planes of an image, or take those of `out`; returns where the library writes."""
    width, height = size
    frame = b.ewa_frame()
    names = (planes,) if isinstance(planes, str) else tuple(planes)
    if names == ("all",):
        names = tuple(name for name in PLANES if name not in without)
    if not names:
        raise ArgumentError("planes: none is asked for")
    for name in names:
        if name not in PLANES or name in without:
            raise ArgumentError(f"planes: '{name}' is none of {', '.join(n for n in PLANES if n not in without)}")
        dtype, count = PLANES[name]
        shape = (height, width) if count == 1 else (height, width, count)
        plane: Array | None = out._planes.get(name) if out is not None else None
        if plane is None:
            plane = np.empty(shape, dtype)
        elif plane.shape != shape or plane.dtype != dtype or not plane.flags.carray:
            raise ArgumentError(f"out: its plane {name} is {plane.shape} {plane.dtype}; {shape} is needed")
        setattr(image, name, plane)
        setattr(frame, name, plane.ctypes.data)
    return frame


def set_surfaces(made: Any, surfaces: Image | None, size: tuple[int, int]) -> Any:
    """Fill in the planes of opaque surfaces; returns what has to live as long as they are used."""
    if surfaces is None:
        return None
    width, height = size
    depth, rgba = surfaces.depth, surfaces.rgba
    if depth.shape != (height, width) or rgba.shape != (height, width, 4):
        raise ArgumentError(f"surfaces: planes depth and rgba of {width} x {height} pixels are needed")
    keep = np.ascontiguousarray(depth, np.float32), np.ascontiguousarray(rgba, np.float32)
    made.surface_depth, made.surface_rgba = keep[0].ctypes.data, keep[1].ctypes.data
    return keep


def options_of(options: dict[str, Any], lights: Sequence[Light] | None, materials: Materials | None,
               environment: Environment | Any, background: Color | None, layers: int | str | None,
               section_box: Any, section_planes: Sequence[Sequence[float]] | None, core: Core,
               made: b.ewa_render_options) -> tuple[b.ewa_render_options, bool, tuple[Any, ...]]:
    """The struct of options, from what it has on; whether the background is opaque; what has to live as long."""
    fill(made, "ewa_render_options", options)
    keep: tuple[Any, ...] = ()
    if lights is not None:
        set_lights(made, lights)
    if materials is not None or environment is not None:
        keep = (set_materials(made, materials),)
        if environment is not None and not isinstance(environment, Environment):
            environment = Environment(environment)
        if environment is not None:
            made.environment = core.resolve(environment._handle)
            keep += (environment,)
        if options.get("shading") is None:
            made.shading = b.ewa_shading.EWA_SHADING_PHONG
    if section_box is not None or section_planes is not None:
        set_section(made, section_box, section_planes)
    if layers is not None:
        words = {"auto": 0, "exact": b.EWA_LAYERS_EXACT}
        fill(made, "ewa_render_options", {"layers": words.get(layers, layers) if isinstance(layers, str) else layers},
             own=True)
    return made, set_background(made, background), keep


class Renderer:
    """An object that owns the memory of frames; :func:`render` keeps one per context.

    Parameters
    ----------
    context : Context, optional
    backend : {"cpu", "gl", "gl-raster", "auto"}, optional
        What draws: the processor, or OpenGL where the library was built with it.

    Raises
    ------
    FormatError
        There is no such device.
    """

    def __init__(self, *, context: Context | None = None, backend: str = "cpu") -> None:
        self._handle = _renderer(core_of(context), backend)

    @keywords("ewa_render_options", "ewa_surfels_options")
    def render(self, scene: Any, camera: Camera | None = None, *, size: Sequence[int] | None = None,
               planes: str | Iterable[str] = ("rgba8",), background: Color | None = None,
               lights: Sequence[Light] | None = None, materials: Materials | None = None,
               environment: Environment | Any = None, layers: int | str | None = None, section_box: Any = None,
               section_planes: Sequence[Sequence[float]] | None = None, out: Image | None = None,
               close_gaps: bool | None = None, **options: Unpack[DrawOptions]) -> Image:
        """Draw as :func:`render` does, which see, by this renderer, of which many frames are expected: surfels and scenes of more than
        262,144 points are drawn by levels of detail where the picture is off by no more than 1/255 (root of the mean square).

        Parameters
        ----------
        scene, camera, size, planes, background, lights, materials, environment, layers, section_box, section_planes, out, close_gaps
            As of :func:`render`.
        **options
        """
        return render(scene, camera, size=size, planes=planes, background=background, lights=lights, materials=materials,
                      environment=environment, layers=layers, section_box=section_box, section_planes=section_planes,
                      renderer=self, out=out, close_gaps=close_gaps, **options)


def _renderer(core: Core, backend: str) -> Handle:
    if backend not in _BACKENDS:
        raise ArgumentError(f"backend: '{backend}' is none of {', '.join(_BACKENDS)}")
    return core.make(lib.ewa_scene_renderer_create, core.address, _BACKENDS.index(backend), None,
                     destroy=lib.ewa_scene_renderer_destroy, what="the renderer")


def _shared(core: Core, backend: str) -> Handle:
    handle = core.renderers.get(backend)
    if handle is None or handle.address is None:
        handle = core.renderers[backend] = _renderer(core, backend)
    return handle


@keywords("ewa_render_options", "ewa_surfels_options")
def render(scene: Any, camera: Camera | None = None, *, size: Sequence[int] | None = None,
           planes: str | Iterable[str] = ("rgba8",), background: Color | None = None,
           lights: Sequence[Light] | None = None, materials: Materials | None = None,
           environment: Environment | Any = None, layers: int | str | None = None, section_box: Any = None,
           section_planes: Sequence[Sequence[float]] | None = None, backend: str = "cpu",
           renderer: Renderer | None = None, out: Image | None = None, close_gaps: bool | None = None,
           panorama: str | Mapping[str, Any] | None = None, **options: Unpack[DrawOptions]) -> Image:
    """Draw anything: what :class:`Scene` takes, objects of other packages too, as ``ewa render`` draws the same in files.

    Parameters
    ----------
    scene : Scene, or whatever one takes (:meth:`Scene.add`), or a list of such
        Several make one picture, whose surfaces meet and blend. What is drawn often is made surfels (:meth:`Cloud.surfels`)
        or a scene once.
    camera : Camera, optional
        Default: one that has all in its picture, ``Camera.frame(scene)``.
    size : (int, int), optional
        Width and height in pixels; scales the camera's picture. Default: the camera's.
    planes : "all", or some of "rgba8", "rgba", "depth", "normal", "coverage"
        What is drawn, as the attributes of :class:`Image`.
    background : colour, optional
        Linear (r, g, b[, a]), or text: "white", "transparent", "#ff8800", "r,g,b" of sRGB.
        Default: opaque white, as `ewa render` has it, or that of a scene file.
    lights : sequence, optional
        At most 8 directions (x, y, z), or with linear colours (x, y, z, r, g, b). Default: from the eye.
    materials : path or sequence of mappings, optional
        By the points' "material": ambient, diffuse, specular, shininess, reflection.
    environment : Environment, path or array, optional
        What surfaces mirror.
    layers : int, "auto" or "exact", optional
        Transparent surfaces of a pixel that are composited.
    section_box : array_like, shape (2, 3), optional
        Draws only what is within a box, world units.
    section_planes : sequence of (a, b, c, d), optional
        Draws only what fulfils a x + b y + c z + d >= 0.
    backend : {"cpu", "gl", "gl-raster", "auto"}, optional
    renderer : Renderer, optional
        In place of the context's.
    out : Image, optional
        Whose planes are drawn into; they have to be of the picture's size.
    close_gaps : bool, optional
        Of clouds, as of :meth:`Cloud.surfels`. Default: True, but with `point_size_px`.
    panorama : "equirectangular", "fisheye", or a mapping, optional
        All that is around the camera's eye, in a picture of its size: kind, and fov_deg (of a fisheye), up_world (default: what is up in
        the scene) and finer as in `ewa_panorama_options`. Depths are distances. Without a camera: from the middle of what there is,
        2048 x 1024 or 1024 x 1024.
    **options
        ``cutoff``: Of clouds, as of :meth:`Cloud.surfels`. Default: 3. ``radius_scale``: Of clouds, likewise. Default: 1.
        ``shading``: Default: "phong" where there are materials or an environment, else "lambert".

    Returns
    -------
    Image

    Raises
    ------
    ArgumentError
        An option out of its range, a camera that is none, a scene of several contexts.
    OutOfMemory, ClosedError
    """
    given: dict[str, Any] = dict(options)
    making = {name: given.pop(name) for name in table("ewa_surfels_options") if name in given}
    parts = things_of(scene)
    if not parts:
        raise ArgumentError("scene: there is nothing")
    if (making or close_gaps is not None) and any(hasattr(part, "_whole") for part in parts):
        raise TypeError(f"{', '.join(making) or 'close_gaps'}: said where surfels or a scene are made, Cloud.surfels() or Scene()")
    if close_gaps is None:
        close_gaps = not given.get("point_size_px")
    world = parts[0]._whole() if len(parts) == 1 and hasattr(parts[0], "_whole") else None
    if world is None:
        world = World(core_of_things(parts), close_gaps=close_gaps, surfels=making)
        for part in parts:
            world.add(part)
    # Levels of what is made surfels here would be made anew for every picture.
    lasting = all(isinstance(part, Surfels) or hasattr(part, "_whole") for part in parts)
    return draw(world, camera, size=size, planes=planes, background=background, lights=lights, materials=materials,
                environment=environment, layers=layers, section_box=section_box, section_planes=section_planes,
                renderer=renderer if renderer is not None else backend, out=out, render=given, panorama=panorama,
                many_frames=renderer is not None and lasting)


def draw(world: World, camera: Camera | None, *, size: Sequence[int] | None, planes: str | Iterable[str],
         background: Color | None, lights: Sequence[Light] | None, section_box: Any,
         section_planes: Sequence[Sequence[float]] | None, materials: Materials | None = None,
         environment: Environment | Any = None, layers: int | str | None = None, surfaces: Image | None = None,
         renderer: Renderer | str | None = None, out: Image | None = None, render: Mapping[str, Any] | None = None,
         lod: Mapping[str, Any] | None = None, gaussians: Mapping[str, Any] | None = None,
         volumes: Mapping[str, Any] | None = None, panorama: str | Mapping[str, Any] | None = None,
         many_frames: bool = False) -> Image:
    """Draw a scene: what every call that makes a picture of something ends in; arguments as of :func:`render`.

    `render`, `lod`, `gaussians` and `volumes` are members of the structs of options of these.
    """
    core = world.core
    around = initialised(b.ewa_panorama_options, lib.ewa_panorama_options_init)
    fill(around, "ewa_panorama_options", {"kind": panorama} if isinstance(panorama, str) else panorama or {})
    placed = None
    if panorama:
        height = 1024
        view = view_options(size=size or (height if around.kind == b.ewa_panorama_kind.EWA_PANORAMA_FISHEYE else 2 * height, height))
        placed = Camera._of(b.ewa_camera())
        core.call(lib.ewa_scene_place_panorama, world.handle, ctypes.byref(view), ctypes.byref(around), ctypes.byref(placed._struct))
    if camera is None and placed:
        camera = placed
    elif camera is None:
        camera = Camera._of(world.place(view_options(size=size)))
    camera = Camera._checked(camera)
    if size is not None and tuple(size) != camera.size:
        camera = camera.resized(*size)
    made = initialised(b.ewa_scene_options, lib.ewa_scene_options_init)
    core.value(lib.ewa_scene_get_options, world.handle, ctypes.byref(made))
    _, opaque, keep = options_of(dict(render or {}), lights, materials, environment, background, layers, section_box,
                                 section_planes, core, made.render)
    fill(made.lod, "ewa_lod_options", lod or {})
    fill(made.gaussians, "ewa_gaussian_options", gaussians or {})
    fill(made.volumes, "ewa_volume_options", volumes or {})
    made.many_frames = many_frames
    made.shade_volumes = made.shade_volumes and (volumes or {}).get("shading") is None
    keep += (set_surfaces(made.gaussians, surfaces, camera.size),)
    image = Image(camera, opaque)
    frame = new_frame(image, camera.size, planes, out)
    stats = b.ewa_scene_stats()
    handle = renderer._handle if isinstance(renderer, Renderer) else _shared(core, renderer or "cpu")
    core.call(lib.ewa_scene_draw_panorama, world.handle, handle, ctypes.byref(camera._struct), ctypes.byref(made),
              ctypes.byref(around), ctypes.byref(frame), ctypes.byref(stats))
    del keep
    image._stats = stats.render
    return image


def draw_outlines(world: World, image: Image, count: int) -> None:
    """Draw outlines over a picture that `draw()` made with the plane rgba8."""
    if image.camera is None or not image.rgba8.flags.carray:
        raise ArgumentError("outlines: an image with the plane rgba8, as render() makes it")
    canvas = b.ewa_canvas()
    canvas.rgba8 = image.rgba8.ctypes.data
    canvas.width_px, canvas.height_px = image.size
    world.core.call(lib.ewa_scene_draw_outlines, world.handle, _shared(world.core, "cpu"), ctypes.byref(image.camera._struct),
                    None, count, ctypes.byref(canvas))
