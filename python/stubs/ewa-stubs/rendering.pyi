# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/rendering.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import Array
from ._context import Context, Core, Handle, core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._scene import World, core_of_things, things_of, view_options
from ._struct import fill, initialised, table
from .camera import Camera
from .image import Color, Image
from .shade import Environment, Light, Materials, set_background, set_lights, set_materials, set_section
from typing_extensions import Unpack
from ._options import RenderOptions, SurfelsOptions
PLANES: dict[str, tuple[Any, int]]
_BACKENDS: Any
def new_frame(image: Image, size: tuple[int, int], planes: str | Iterable[str], out: Image | None, without: tuple[str, ...]=()) -> b.ewa_frame: ...
def set_surfaces(made: Any, surfaces: Image | None, size: tuple[int, int]) -> Any: ...
def options_of(options: dict[str, Any], lights: Sequence[Light] | None, materials: Materials | None, environment: Environment | Any, background: Color | None, layers: int | str | None, section_box: Any, section_planes: Sequence[Sequence[float]] | None, core: Core, made: b.ewa_render_options) -> tuple[b.ewa_render_options, bool, tuple[Any, ...]]: ...
class Renderer:
    def __init__(self, *, context: Context | None=None, backend: str='cpu') -> None: ...
    def render(self, scene: Any, camera: Camera | None=None, *, size: Sequence[int] | None=None, planes: str | Iterable[str]=('rgba8',), background: Color | None=None, lights: Sequence[Light] | None=None, materials: Materials | None=None, environment: Environment | Any=None, layers: int | str | None=None, section_box: Any=None, section_planes: Sequence[Sequence[float]] | None=None, out: Image | None=None, close_gaps: bool | None=None,
            kernel: Literal["perspective", "affine", "source", "circular", "raycast"] | None = None,  # projected shape of a splat: its exact ellipse, the ellipse of the affine map at its centre, the same evaluated in the surfel's plane, the circle around it, or the exact kernel at each pixel; default perspective
            prefilter_px: float | None = None,  # standard deviation of the pixel filter; 0: none; [0, 4] px; default 0.35
            point_size_px: float | None = None,  # draws every point as a disc of that diameter that faces the viewer: for points that are no surface; 0: surfels as they are; 0 or [1, 256] px; default 0
            tolerance: float | None = None,  # splats closer in depth than so many support radii are blended as one surface; [0, 1e15]; default 1
            passes: int | None = None,  # 3: splats of one surface are blended; 1: the nearest splat of each pixel wins; 1|3; default 3
            edge_antialiasing: bool | None = None,  # smooth silhouettes by coverage; default True
            edge_threshold: float | None = None,  # coverage, as a share of a covered pixel's, from which a pixel is opaque; (0, 4]; default 0.45
            edge_layers: int | None = None,  # surfaces that show through each other at smoothed silhouettes, the last of them all that is left; 1: the background shows through instead; [1, 8]; default 8
            opacity: float | None = None,  # of every surface, times the alpha of the colours; [0, 1]; default 1
            cull: Literal["none", "back"] | None = None,  # leave out splats that face away; default none
            shading: Literal["none", "lambert", "phong"] | None = None,  # light: none gives the bare colours, lambert matt surfaces, phong materials with highlights; default lambert
            ambient: float | None = None,  # share of the light that comes from everywhere, where materials do not say; [0, 1]; default 0.15
            environment_up: Sequence[float] | None = None,  # direction in the world of the surroundings' upper edge; (-inf, inf); default [0, 1, 0]
            eye_dome: float | None = None,  # eye-dome lighting: darken what lies behind its surroundings; 0: none, 1: strong; [0, 100]; default 0
            level: int | None = None,  # level of detail, if the surfels have levels; 0: all surfels; [0, 7]; default 0
            budget_s: float | None = None,  # time for a frame: of the levels of detail from `level` on, the finest that is expected to be drawn in that time; 0: `level`; [0, 1e15] s; default 0
            supersampling: int | None = None,  # draws every pixel as so many by so many parts, and their average: for what is far, where a pixel holds many small things; 0: 1, 2, 4 or 8, as the surfels need to be about as large as a part; [0, 8]; default 1
            cutoff: float | None = None,  # standard deviations at which a kernel ends; (0, 4]; default 3
            radius_scale: float | None = None,  # multiplies every radius and axis; (0, 1e15]; default 1
            level_count: int | None = None,  # levels of detail, each of a quarter of the surfels of the one before; 1: all surfels only; [1, 8]; default 1
            ) -> Image: ...
def render(scene: Any, camera: Camera | None=None, *, size: Sequence[int] | None=None, planes: str | Iterable[str]=('rgba8',), background: Color | None=None, lights: Sequence[Light] | None=None, materials: Materials | None=None, environment: Environment | Any=None, layers: int | str | None=None, section_box: Any=None, section_planes: Sequence[Sequence[float]] | None=None, backend: str='cpu', renderer: Renderer | None=None, out: Image | None=None, close_gaps: bool | None=None, panorama: str | Mapping[str, Any] | None=None,
        kernel: Literal["perspective", "affine", "source", "circular", "raycast"] | None = None,  # projected shape of a splat: its exact ellipse, the ellipse of the affine map at its centre, the same evaluated in the surfel's plane, the circle around it, or the exact kernel at each pixel; default perspective
        prefilter_px: float | None = None,  # standard deviation of the pixel filter; 0: none; [0, 4] px; default 0.35
        point_size_px: float | None = None,  # draws every point as a disc of that diameter that faces the viewer: for points that are no surface; 0: surfels as they are; 0 or [1, 256] px; default 0
        tolerance: float | None = None,  # splats closer in depth than so many support radii are blended as one surface; [0, 1e15]; default 1
        passes: int | None = None,  # 3: splats of one surface are blended; 1: the nearest splat of each pixel wins; 1|3; default 3
        edge_antialiasing: bool | None = None,  # smooth silhouettes by coverage; default True
        edge_threshold: float | None = None,  # coverage, as a share of a covered pixel's, from which a pixel is opaque; (0, 4]; default 0.45
        edge_layers: int | None = None,  # surfaces that show through each other at smoothed silhouettes, the last of them all that is left; 1: the background shows through instead; [1, 8]; default 8
        opacity: float | None = None,  # of every surface, times the alpha of the colours; [0, 1]; default 1
        cull: Literal["none", "back"] | None = None,  # leave out splats that face away; default none
        shading: Literal["none", "lambert", "phong"] | None = None,  # light: none gives the bare colours, lambert matt surfaces, phong materials with highlights; default lambert
        ambient: float | None = None,  # share of the light that comes from everywhere, where materials do not say; [0, 1]; default 0.15
        environment_up: Sequence[float] | None = None,  # direction in the world of the surroundings' upper edge; (-inf, inf); default [0, 1, 0]
        eye_dome: float | None = None,  # eye-dome lighting: darken what lies behind its surroundings; 0: none, 1: strong; [0, 100]; default 0
        level: int | None = None,  # level of detail, if the surfels have levels; 0: all surfels; [0, 7]; default 0
        budget_s: float | None = None,  # time for a frame: of the levels of detail from `level` on, the finest that is expected to be drawn in that time; 0: `level`; [0, 1e15] s; default 0
        supersampling: int | None = None,  # draws every pixel as so many by so many parts, and their average: for what is far, where a pixel holds many small things; 0: 1, 2, 4 or 8, as the surfels need to be about as large as a part; [0, 8]; default 1
        cutoff: float | None = None,  # standard deviations at which a kernel ends; (0, 4]; default 3
        radius_scale: float | None = None,  # multiplies every radius and axis; (0, 1e15]; default 1
        level_count: int | None = None,  # levels of detail, each of a quarter of the surfels of the one before; 1: all surfels only; [1, 8]; default 1
        ) -> Image: ...
def draw(world: World, camera: Camera | None, *, size: Sequence[int] | None, planes: str | Iterable[str], background: Color | None, lights: Sequence[Light] | None, section_box: Any, section_planes: Sequence[Sequence[float]] | None, materials: Materials | None=None, environment: Environment | Any=None, layers: int | str | None=None, surfaces: Image | None=None, renderer: Renderer | str | None=None, out: Image | None=None, render: Mapping[str, Any] | None=None, lod: Mapping[str, Any] | None=None, gaussians: Mapping[str, Any] | None=None, volumes: Mapping[str, Any] | None=None, panorama: str | Mapping[str, Any] | None=None) -> Image: ...
def draw_outlines(world: World, image: Image, count: int) -> None: ...
