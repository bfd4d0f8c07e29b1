# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/warping.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
import os
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import Array, as_numbers
from ._context import Context, core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import fill, initialised, numbers, path_bytes
from .camera import Camera
from .image import Color, Image, as_picture, read_depth
from .rendering import new_frame
from .shade import set_background
from typing_extensions import Unpack
from ._options import TextureOptions, WarpOptions
_KINDS: Any
_METHODS: Any
class DepthImage(NamedTuple):
    depth: Any
    color: Any
    camera: Camera
    kind: str = 'z'
    scale: float | None = None
    baseline: float = 0.0
    disparity_offset: float = 0.0
def warp(images: DepthImage | Sequence[DepthImage], camera: Camera | None=None, *, shift: Sequence[float] | None=None, size: Sequence[int] | None=None, planes: str | Iterable[str]=('rgba8',), method: str='hybrid', background: Color='transparent', render: dict[str, Any] | None=None, context: Context | None=None,
        cutoff: float | None = None,  # standard deviations at which a kernel ends; (0, 4]; default 3
        radius_spacings: float | None = None,  # support radius of a splat in units of the distance to its neighbours; [0.5, 10]; default 1.14
        depth_jump: float | None = None,  # depths of neighbours that differ by more than this share are on different surfaces, unless they continue a plane; (0, 1]; default 0.02
        depth_noise: float | None = None,  # steps of a sensor's depths at distance 1, growing with its square: depths that differ by little more are averaged over 5 x 5 pixels. 0.0036 for a first Kinect in metres; 0: taken as they are; [0, 1000000]; default 0
        drop_flying: bool | None = None,  # leave out samples that hang between two surfaces; default True
        nearest_world: float | None = None,  # nearer depths are left out; [1e-9, 1e12] world; default 1e-06
        farthest_world: float | None = None,  # farther depths are left out; [1e-9, 1e12] world; default 1000000000.0
        ) -> Image: ...
def texture(picture: Any, *, homography: Any=None, corners: Any=None, camera: Camera | None=None, plane: Any=None, size: Sequence[int] | None=None, background: Color=(0, 0, 0, 0), context: Context | None=None,
        method: Literal["hybrid", "splat", "point", "bilinear"] | None = None,  # hybrid: texels are points where they are minified along both axes, and splats elsewhere; all splats; all points, with holes where magnified; backward, by bilinear interpolation, which aliases; default hybrid
        prefilter_px: float | None = None,  # standard deviation of the pixel filter in pixels; [0.1, 4] px; default 0.3
        cutoff: float | None = None,  # standard deviations at which kernels end; [1, 4]; default 3.3
        sigma_texels: float | None = None,  # standard deviation of a texel's disc, in texels: larger is softer where magnified; [0.3, 2]; default 0.4
        point_spacing_px: float | None = None,  # hybrid: texels that are not farther apart than this, in pixels, are points; [0.05, 1] px; default 0.5
        repeat: bool | None = None,  # fill the whole plane with copies of the image, up to the horizon; default False
        ) -> Image: ...
