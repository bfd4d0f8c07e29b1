# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/scene.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
import json
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import Array
from ._context import Context, Core, Handle, core_of
from ._errors import ArgumentError, ClosedError
from ._library import functions as lib
from ._scene import World, core_of_things, is_path, view_options
from ._struct import fill, initialised, numbers, path_bytes, text_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .profiles import Profile
from .rendering import draw, draw_outlines
from .shade import Environment, Light, Materials
from typing_extensions import Unpack
from ._options import FurnitureOptions
class Scene:
    def __init__(self, *things: Any, close_gaps: bool=True, up: str='auto', context: Context | None=None,
            cutoff: float | None = None,  # standard deviations at which a kernel ends; (0, 4]; default 3
            radius_scale: float | None = None,  # multiplies every radius and axis; (0, 1e15]; default 1
            level_count: int | None = None,  # levels of detail, each of a quarter of the surfels of the one before; 1: all surfels only; [1, 8]; default 1
            ) -> None: ...
    def __len__(self) -> int: ...
    def add(self, thing: Any, *, visible: bool=True, opacity: float=1.0, radius_scale: float=1.0, color_by: str='', colormap: str='auto', range: Sequence[float] | None=None, tint: Sequence[float] | None=None, transfer: str | None=None, to_world: Any=None, gaussians_as_surfels: bool | None=None, levels: str | None=None, cutoff: float | None=None, voxel_level_count: int | None=None, reach_steps: float | None=None) -> int: ...
    @property
    def bounds(self) -> Array: ...
    def camera(self, view: str | Sequence[float] | None=None, up: str | Sequence[float] | None=None, *, size: Sequence[int] | None=None, fov: float | None=None, ortho: float | None=None, eye: Sequence[float] | None=None, target: Sequence[float] | None=None, azimuth: float=0, elevation: float=0) -> Camera: ...
    def render(self, camera: Camera | None=None, *, size: Sequence[int] | None=None, planes: str | Iterable[str]=('rgba8',), background: Color | None=None, lights: Sequence[Light] | None=None, materials: Materials | None=None, environment: Environment | Any=None, layers: int | str | None=None, section_box: Any=None, section_planes: Sequence[Sequence[float]] | None=None, out: Image | None=None, panorama: str | Mapping[str, Any] | None=None,
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
            ) -> Image: ...
    def draw_outlines(self, image: Image, count: int) -> None: ...
    def points(self) -> Cloud: ...
    def hide(self, *, box: Any=None, outline: Any=None, camera: Camera | None=None, classes: Iterable[int] | None=None) -> None: ...
    def keep(self, *, box: Any=None, outline: Any=None, camera: Camera | None=None, classes: Iterable[int] | None=None) -> None: ...
    def show_all(self) -> None: ...
    def profile(self, line: Any, width: float=1.0, up: Sequence[float] | None=None) -> Profile: ...
    def draw_furniture(self, image: Image, *, title: str | None=None, unit: str | None=None, color_label: str | None=None, color_unit: str | None=None,
            axes: bool | None = None,  # show how the world's axes x, y, z lie, in the lower left corner; default False
            scale_bar: bool | None = None,  # show a length, in the lower right corner; default False
            color_bar: bool | None = None,  # show what the colours mean, on the right; default False
            scale_depth_world: float | None = None,  # distance along the view at which the scale bar of a perspective camera holds; 0: no such bar; [0, 1e30] world; default 0
            colormap: Literal["viridis", "turbo", "gray", "plasma", "inferno", "magma", "cividis", "coolwarm"] | None = None,  # colours of the colour bar; default viridis
            range: Sequence[float] | None = None,  # numbers of the first and the last colour; (-inf, inf); default [0, 1]
            pixel_scale: float | None = None,  # pixels per point, of which text has 12; 0: a 720th of the picture's smaller side, at least 0.84; [0, 100] px; default 0
            ink: Literal["auto", "dark", "light"] | None = None,  # colour of text and lines; default auto
            ) -> Image: ...
    def save(self, path: PathLike, camera: Camera | None=None) -> None: ...
    def describe(self) -> dict[str, Any]: ...
    def close(self) -> None: ...
