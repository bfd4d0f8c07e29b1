# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Derivatives of pictures: what a loss changes per number of a cloud and of a camera."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array, as_contiguous
from ._errors import ArgumentError
from ._keywords import keywords
from ._library import functions as lib
from ._options import RenderOptions
from ._struct import fill, initialised
from .adapters import as_cloud
from .camera import Camera
from .image import Color
from .rendering import PLANES, options_of
from .shade import Light

if TYPE_CHECKING:
    from typing_extensions import Unpack


class BackwardOptions(RenderOptions, total=False):
    """What pictures that have derivatives are drawn with."""

    cutoff: float | None
    radius_scale: float | None


#: What there are derivatives by: numbers per point.
STREAMS = {"color": 3, "opacity": 1, "position": 3, "normal": 3, "radius": 1, "tangent_u": 3, "tangent_v": 3}
SURFELS_OPTIONS = ("cutoff", "radius_scale")


class CameraGradient(NamedTuple):
    """What a loss changes per small motion of a camera, and per number of its lens.

    Attributes
    ----------
    rotation, translation : ndarray, float64, shape (3,)
        Of camera space: points p become p + r x p + t, r in radians, t in its units.
    focal_px, principal_px : ndarray, float64, shape (2,)
    """

    rotation: Array
    translation: Array
    focal_px: Array
    principal_px: Array


class Gradients(NamedTuple):
    """What a loss changes per number of a cloud: float64, shape (n, 3) or (n,); None: not asked for.

    Attributes
    ----------
    color : ndarray
        By linear light.
    opacity : ndarray
        By the alpha of the colours, [0, 1].
    position, normal, radius, tangent_u, tangent_v : ndarray
        By the numbers of the streams.
    camera : CameraGradient
    rgba : ndarray, shape (height, width, 4)
        No derivative, but the picture that they are of: linear, premultiplied.
    """

    color: Array | None = None
    opacity: Array | None = None
    position: Array | None = None
    normal: Array | None = None
    radius: Array | None = None
    tangent_u: Array | None = None
    tangent_v: Array | None = None
    camera: CameraGradient | None = None
    rgba: Array | None = None


@keywords("ewa_render_options", "ewa_surfels_options", without=("level_count",))
def render_backward(cloud: Any, camera: Camera, *, rgba: Any = None, depth: Any = None, normal: Any = None,
                    coverage: Any = None, by: str | Iterable[str] = ("color", "position", "camera"),
                    unit_coverage: float | None = None, background: Color = "white",
                    lights: Sequence[Light] | None = None, layers: int | str | None = None,
                    section_box: Any = None, section_planes: Sequence[Sequence[float]] | None = None,
                    **options: Unpack[BackwardOptions]) -> Gradients:
    """Take what a loss changes per number of a picture to what it changes per number of what made it.

    The picture is that of ``render(cloud.surfels(close_gaps=False), camera, supersampling=1)`` with the same options. What jumps has no
    derivative: which surfels are seen where. The same bytes for any number of threads and order of the points.

    Parameters
    ----------
    cloud : Cloud, path, or whatever :func:`as_cloud` takes
        With positions, normals and radii, or positions and both tangents.
    camera : Camera
    rgba, depth, normal, coverage : array_like, optional
        What the loss changes per number of these planes: of their shapes, finite. Default: nothing.
    by : "all", or some of "color", "opacity", "position", "normal", "radius", "tangent_u", "tangent_v", "camera", "rgba"
        What is computed. Colours alone go back through the pipeline that draws, in its precision and in about twice the
        time of a picture; with all else in double precision. "rgba" is that picture.
    unit_coverage : float, optional
        What kernels add up to where a pixel is covered. Default: as the cloud's surfels measure it.
    background, lights, layers, section_box, section_planes
        As of :func:`render`.
    **options

    Returns
    -------
    Gradients

    Raises
    ------
    ArgumentError
        A plane of another shape, a number that is not finite, an option out of its range.
    FormatError
        An option without a derivative: kernels other than perspective and affine, one pass, points of a size, highlights,
        eye-dome lighting, levels of detail.
    OutOfMemory, ClosedError
    """
    cloud = as_cloud(cloud)
    camera = Camera._checked(camera)
    names = (by,) if isinstance(by, str) else tuple(by)
    if names == ("all",):
        names = (*STREAMS, "camera", "rgba")
    for name in names:
        if name not in (*STREAMS, "camera", "rgba"):
            raise ArgumentError(f"by: '{name}' is none of {', '.join((*STREAMS, 'camera', 'rgba'))}")
    core = cloud._core
    surfels = initialised(b.ewa_surfels_options, lib.ewa_surfels_options_init)
    given: dict[str, Any] = dict(options)
    fill(surfels, "ewa_surfels_options", {name: given.pop(name) for name in SURFELS_OPTIONS if name in given})
    made, _, keep = options_of(given, lights, None, None, background, layers, section_box, section_planes, core,
                               initialised(b.ewa_render_options, lib.ewa_render_options_init))
    cotangent, planes = b.ewa_frame_cotangent(), {"rgba": rgba, "depth": depth, "normal": normal, "coverage": coverage}
    width, height = camera.size
    for name, plane in planes.items():
        if plane is None:
            continue
        count = PLANES[name][1]
        array = as_contiguous(plane, np.float32, (height, width) if count == 1 else (height, width, count), name)
        setattr(cotangent, name, array.ctypes.data)
        keep += (array,)
    arrays: dict[str, Array] = {}
    gradient, lens = b.ewa_gradient(), b.ewa_camera_cotangent()
    for name in names:
        if name == "camera":
            gradient.camera = ctypes.pointer(lens)
            continue
        count = 4 if name == "rgba" else STREAMS[name]
        shape: tuple[int, ...] = (height, width, 4) if name == "rgba" else (len(cloud), 3) if count == 3 else (len(cloud),)
        arrays[name] = np.zeros(shape)
        setattr(gradient, name, arrays[name].ctypes.data)
    core.call(lib.ewa_render_backward, cloud._h, ctypes.byref(surfels),
              0.0 if unit_coverage is None else float(unit_coverage), ctypes.byref(camera._struct), ctypes.byref(made),
              ctypes.byref(cotangent), ctypes.byref(gradient))
    del keep
    found = CameraGradient(*(np.array(getattr(lens, name)) for name in CameraGradient._fields))
    return Gradients(**arrays, camera=found if "camera" in names else None)
