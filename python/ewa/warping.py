# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Pictures mapped forward: depth images seen by another camera, flat images by a homography or a camera."""
from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array, as_numbers
from ._context import Context, core_of
from ._errors import ArgumentError
from ._keywords import keywords
from ._library import functions as lib
from ._struct import fill, initialised, numbers, path_bytes
from .camera import Camera
from .image import Color, Image, as_picture, read_depth
from .rendering import new_frame
from .shade import set_background

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import TextureOptions, WarpOptions

_KINDS = ("z", "ray", "disparity")
_METHODS = ("hybrid", "mcmillan")


class DepthImage(NamedTuple):
    """A picture with depths.

    Attributes
    ----------
    depth : path or array_like, shape (height, width)
        uint16 or float32; 0, negative, NaN, infinite: no depth.
    color : path or array_like, shape (height, width, 1, 3 or 4), or None
        uint8: sRGB; float32: linear, premultiplied. None: grey.
    camera : Camera
        That took it, of the size of both.
    kind : {"z", "ray", "disparity"}
        What the numbers are: camera-space z, distance to the eye, pixels.
    scale : float, optional
        Numbers per world unit. Default 1; of .png files that are no disparities 1000, as in the program.
    baseline, disparity_offset : float
        Of disparities: distance of the eyes, world units; difference of the principal points, pixels.
    """

    depth: Any
    color: Any
    camera: Camera
    kind: str = "z"
    scale: float | None = None
    baseline: float = 0.0
    disparity_offset: float = 0.0


def _plane(value: Any, label: str, kinds: tuple[Any, ...], dimensions: int) -> Array:
    array = as_numbers(value, label)
    if array.ndim != dimensions or array.dtype not in kinds or 0 in array.shape:
        raise ArgumentError(f"{label}: {array.dtype} of shape {array.shape} is no such picture")
    return np.ascontiguousarray(array)


def _take(image: DepthImage, struct: b.ewa_depth_image, index: int) -> tuple[Array, ...]:
    """Fill the library's struct; returns the arrays that it points to."""
    lib.ewa_depth_image_init(ctypes.byref(struct))
    label = f"images[{index}]."
    if not isinstance(image.camera, Camera):
        raise TypeError(f"{label}camera: an ewa.Camera")
    if image.kind not in _KINDS:
        raise ArgumentError(f"{label}kind: '{image.kind}' is none of {', '.join(_KINDS)}")
    is_file = isinstance(image.depth, (str, bytes, os.PathLike))
    scale = image.scale
    if scale is None:
        scale = lib.ewa_depth_file_scale(path_bytes(image.depth) if is_file else None, _KINDS.index(image.kind))
    depth = _plane(read_depth(image.depth) if is_file else image.depth, label + "depth",
                   (np.dtype(np.uint16), np.dtype(np.float32)), 2)
    width, height = image.camera.size
    if depth.shape != (height, width):
        raise ArgumentError(f"{label}depth: shape {depth.shape}, but the camera's picture is {width} x {height}")
    struct.camera = image.camera._struct
    struct.depth, struct.kind = depth.ctypes.data, _KINDS.index(image.kind)
    struct.depth_type = b.ewa_type.EWA_U16 if depth.dtype == np.uint16 else b.ewa_type.EWA_F32
    struct.depth_scale = numbers([scale], 1, label + "scale")[0]
    struct.baseline_world = numbers([image.baseline], 1, label + "baseline")[0]
    struct.disparity_offset_px = numbers([image.disparity_offset], 1, label + "disparity_offset")[0]
    if image.color is None:
        return (depth,)
    if isinstance(image.color, (str, bytes, os.PathLike)):
        color = as_picture(image.color, label + "color")
    else:
        color = np.asarray(image.color)
        color = _plane(color[:, :, None] if color.ndim == 2 else color, label + "color",
                       (np.dtype(np.uint8), np.dtype(np.float32)), 3)
    if color.shape[:2] != (height, width) or color.shape[2] not in (1, 3, 4):
        raise ArgumentError(f"{label}color: shape {color.shape}; ({height}, {width}, 1, 3 or 4) is needed")
    struct.color, struct.color_channel_count = color.ctypes.data, color.shape[2]
    struct.color_type = b.ewa_type.EWA_U8 if color.dtype == np.uint8 else b.ewa_type.EWA_F32
    return depth, color


@keywords("ewa_warp_options")
def warp(images: DepthImage | Sequence[DepthImage], camera: Camera | None = None, *,
         shift: Sequence[float] | None = None, size: Sequence[int] | None = None,
         planes: str | Iterable[str] = ("rgba8",), method: str = "hybrid", background: Color = "transparent",
         render: dict[str, Any] | None = None, context: Context | None = None,
         **options: Unpack[WarpOptions]) -> Image:
    """Draw pictures with depths as another camera sees them.

    Parameters
    ----------
    images : DepthImage or a sequence of them
    camera : Camera, optional
        The new camera. Default: that of the first image.
    shift : (x, y, z), optional
        Moves it to its right, down and ahead, world units.
    size, planes, background
        As of :func:`render`.
    method : {"hybrid", "mcmillan"}, optional
    render : dict, optional
        Options of drawing, members of ``ewa_render_options``.
    **options

    Returns
    -------
    Image
        Its plane `holes` is 255 where less than half of a pixel is covered.

    Raises
    ------
    ArgumentError, OutOfMemory
    """
    given = [images] if isinstance(images, DepthImage) else list(images)
    if not given or not all(isinstance(image, DepthImage) for image in given):
        raise TypeError("images: an ewa.DepthImage or several")
    if method not in _METHODS:
        raise ArgumentError(f"method: '{method}' is none of {', '.join(_METHODS)}")
    core = core_of(context)
    structs = (b.ewa_depth_image * len(given))()
    keep = [_take(image, structs[i], i) for i, image in enumerate(given)]
    made = initialised(b.ewa_warp_options, lib.ewa_warp_options_init)
    fill(made, "ewa_warp_options", dict(options))
    drawn = initialised(b.ewa_render_options, lib.ewa_warp_render_options_init)
    fill(drawn, "ewa_render_options", render or {})
    opaque = set_background(drawn, background)
    camera = camera if camera is not None else given[0].camera
    target = camera._copy()
    if shift is not None:
        steps = numbers(shift, 3, "shift")
        m = target.world_to_camera
        scale = sum(m[i] * m[i] for i in range(3)) ** 0.5
        for i in range(3):
            m[4 * i + 3] -= scale * steps[i]
    target_camera = Camera._of(target)
    if size is not None:
        target_camera = target_camera.resized(*size)
    width, height = target_camera.size
    image = Image(target_camera, opaque)
    frame = new_frame(image, (width, height), planes, None)
    image.holes = np.empty((height, width), np.uint8)
    handle = core.make(lib.ewa_warp_create, core.address, destroy=lib.ewa_warp_destroy, what="the warp")
    core.call(lib.ewa_warp_take, handle, structs, len(given), ctypes.byref(made), None)
    del keep
    core.call(lib.ewa_warp_draw, handle, ctypes.byref(target_camera._struct), _METHODS.index(method),
              ctypes.byref(drawn), ctypes.byref(frame), image.holes.ctypes.data, None)
    return image


@keywords("ewa_texture_options")
def texture(picture: Any, *, homography: Any = None, corners: Any = None, camera: Camera | None = None,
            plane: Any = None, size: Sequence[int] | None = None, background: Color = (0, 0, 0, 0),
            context: Context | None = None, **options: Unpack[TextureOptions]) -> Image:
    """Map a flat image forward, antialiased to the horizon.

    Parameters
    ----------
    picture : path or array_like, shape (height, width, 1, 3 or 4)
        uint8: sRGB; floats: linear, premultiplied.
    homography : array_like, shape (3, 3), optional
        From pixels of the image to pixels of the picture, columns on its right, pixel centres at half integers.
    corners : array_like, shape (4, 2), optional
        Where the upper left, upper right, lower right, lower left corners go, pixels of the picture.
    camera : Camera, optional
        That sees the image on a plane of the world.
    plane : array_like, shape (3, 3), optional
        With `camera`: the upper left corner, the way along the upper edge, the way down the left edge. Default: 1 high,
        upright in the x-y plane, its middle at the origin.
    size : (int, int), optional
        Of the picture, pixels. Default: of the image; the camera's.
    **options

    Returns
    -------
    Image
        With the plane `rgba`.

    Raises
    ------
    ArgumentError, NumericError, OutOfMemory
    """
    source = as_picture(picture, "picture")
    height, width, channels = source.shape
    if channels not in (1, 3, 4):
        raise ArgumentError(f"picture: {channels} channels; 1, 3 or 4 are needed")
    if (homography is not None) + (corners is not None) + (camera is not None) != 1:
        raise ArgumentError("one of homography, corners and camera is needed")
    core = core_of(context)
    made_map = b.ewa_mat3()
    place = ctypes.byref(made_map)
    if homography is not None:
        h = numbers(homography, 9, "homography")
        w = h[6] * 0.5 * width + h[7] * 0.5 * height + h[8]
        for i in range(3):
            for j in range(3):
                made_map.m[i][j] = -h[3 * j + i] if w < 0 else h[3 * j + i]
    elif corners is not None:
        core.call(lib.ewa_texture_map_from_corners, core.address, width, height, numbers(corners, 8, "corners"), place)
    else:
        assert camera is not None
        if size is not None:
            camera = camera.resized(*size)
        ratio = width / height
        p = numbers(plane if plane is not None else [-0.5 * ratio, 0.5, 0, ratio, 0, 0, 0, -1, 0], 9, "plane")
        parts = [(ctypes.c_double * 3)(*p[3 * i:3 * i + 3]) for i in range(3)]
        core.call(lib.ewa_texture_map_from_camera, core.address, width, height, ctypes.byref(camera._struct), *parts,
                  place)
    drawn_size = camera.size if camera is not None else (width, height) if size is None else (size[0], size[1])
    made = initialised(b.ewa_texture_options, lib.ewa_texture_options_init)
    fill(made, "ewa_texture_options", dict(options))
    image = Image(camera, set_background(made, background), of_floats=True)
    new_frame(image, Camera(size=drawn_size).size, "rgba", None)
    given = b.ewa_texture_source(source.ctypes.data, b.ewa_pixel_format.EWA_PIXEL_LINEAR, channels, width, height,
                                 width * channels * 4)
    target = b.ewa_texture_target(image.rgba.ctypes.data, b.ewa_pixel_format.EWA_PIXEL_LINEAR, 4, drawn_size[0],
                                  drawn_size[1], drawn_size[0] * 16)
    stats = b.ewa_texture_stats()
    core.call(lib.ewa_texture_map, core.address, ctypes.byref(given), place, ctypes.byref(made), ctypes.byref(target),
              ctypes.byref(stats))
    image._stats = stats
    return image
