# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Colours of points from photographs whose cameras are known; how like pictures are to them."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, NamedTuple, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._context import Context, Handle, core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import fill, initialised, path_bytes
from .camera import Camera, PathLike
from .image import as_picture, pixels_struct, taken

if TYPE_CHECKING:
    from ._options import PhotosOptions


class PhotoReport(NamedTuple):
    """What one photograph came to.

    Attributes
    ----------
    held_out : bool
        Not used, but compared.
    size : (int, int)
        Width and height as it was looked at, after halving, pixels.
    pixel_count, point_count : int
        Pixels that a surface fills; points that it sees.
    gain, offset : ndarray of float64, shape (3,)
        It shows gain * colour + offset, linear light.
    rms, psnr_db, rejected : float
        Difference from the points' picture, sRGB numbers in [0, 1]; share of its pixels that count less than a quarter.
    world_to_camera : ndarray of float64, shape (4, 4)
        The pose, as pose steps have refined it.
    shift_px : float
        How far these have moved what is seen, in pixels after halving: root of the mean square.
    """

    held_out: bool
    size: tuple[int, int]
    pixel_count: int
    point_count: int
    gain: Array
    offset: Array
    rms: float
    psnr_db: float
    rejected: float
    world_to_camera: Array
    shift_px: float


class PhotosReport(NamedTuple):
    """What photographs came to.

    Attributes
    ----------
    seen_count : int
        Points that some photograph sees.
    psnr_db, held_out_psnr_db : float
        Over all pixels of photographs that were used, that were not; NaN: there are none.
    vignetting : (float, float)
        a, b: 1 + a r^2 + b r^4 is left of the light, r being 1 in the corners.
    photographs : list of PhotoReport
        In the caller's order.
    """

    seen_count: int
    psnr_db: float
    held_out_psnr_db: float
    vignetting: tuple[float, float]
    photographs: list[PhotoReport]


class ImageQuality(NamedTuple):
    """How near a picture is to the true one.

    Attributes
    ----------
    psnr_db : float
        Of sRGB numbers in [0, 1]; infinite where nothing differs.
    ssim : float
        Structural similarity, at most 1, as 3DGS reports it.
    pixel_count : int
        Pixels that were compared.
    """

    psnr_db: float
    ssim: float
    pixel_count: int


def undistort(picture: Any, camera: Camera) -> Array:
    """Return the picture of a pinhole of one that the lens of a camera took (:meth:`Camera.from_opencv`).

    Parameters
    ----------
    picture : path, Image, or array_like of shape (height, width) or (height, width, 1, 3 or 4)
        Of the camera's size. Floats are linear light, premultiplied; uint8 is sRGB.
    camera : Camera

    Returns
    -------
    ndarray of float32, shape (height, width, 4)
        Linear light, premultiplied; transparent where the lens shows nothing.

    Raises
    ------
    ArgumentError, OutOfMemory
    """
    core = core_of(None)
    pixels = as_picture(picture, "picture")
    image, made = pixels_struct(pixels, core.address), b.ewa_image()
    core.call(lib.ewa_image_undistort, ctypes.byref(image), ctypes.byref(camera._struct), ctypes.byref(camera._lens),
              ctypes.byref(made))
    return taken(made)


def compare_images(image: Any, reference: Any, *, context: Context | None = None) -> ImageQuality:
    """Compare two pictures of one size by PSNR and SSIM, in sRGB numbers.

    Parameters
    ----------
    image, reference : path, Image, or array_like of shape (height, width) or (height, width, 1, 3 or 4)
        Floats are linear light, premultiplied; uint8 is sRGB. Pixels where `reference` is not opaque are not compared.

    Raises
    ------
    ArgumentError, OutOfMemory
    """
    core = core_of(context)
    keep = [as_picture(image, "image"), as_picture(reference, "reference")]
    both = [b.ewa_image(core.address, array.shape[1], array.shape[0], array.shape[2], array.ctypes.data) for array in keep]
    found = b.ewa_image_quality()
    core.call(lib.ewa_image_compare, ctypes.byref(both[0]), ctypes.byref(both[1]), ctypes.byref(found))
    return ImageQuality(found.psnr_db, found.ssim, found.pixel_count)


def _of_arrays(photos: Sequence[tuple[Camera, Any]]) -> tuple[Any, list[Any]]:
    """Photographs of cameras and arrays, and what has to stay meanwhile."""
    made = (b.ewa_photo * max(1, len(photos)))()
    keep: list[Any] = []
    for i, (camera, value) in enumerate(photos):
        pixels = as_picture(value, f"photograph {i}")
        if pixels.shape[2] not in (1, 3, 4):
            raise ArgumentError(f"photograph {i}: shape {pixels.shape}; 1, 3 or 4 channels are needed")
        image = b.ewa_image(None, pixels.shape[1], pixels.shape[0], pixels.shape[2], pixels.ctypes.data)
        made[i].camera, made[i].lens = camera._copy(), camera._lens
        made[i].image = ctypes.pointer(image)
        keep += [pixels, image]
    return made, keep


def color(handle: Handle, cameras: PathLike | Sequence[tuple[Camera, Any]], images: PathLike | None,
          masks: PathLike | None, options: PhotosOptions) -> PhotosReport:
    """Colour a cloud; see :meth:`Cloud.color_from_photos`."""
    core = handle.core
    made = initialised(b.ewa_photos_options, lib.ewa_photos_options_init)
    fill(made, "ewa_photos_options", options)
    listed: Handle | None = None
    keep: list[Any] = []
    if isinstance(cameras, (list, tuple)):
        if masks is not None:
            raise ArgumentError("masks: of photographs in files; arrays have four channels where they are masked")
        photos, keep = _of_arrays(cameras)
        count = len(cameras)
    else:
        listed = core.make(lib.ewa_photo_list_load, core.address, path_bytes(cameras),
                           path_bytes(images) if images is not None else None, destroy=lib.ewa_photo_list_destroy,
                           what="the list of photographs")
        if masks is not None:
            core.call(lib.ewa_photo_list_find_masks, listed, path_bytes(masks, "masks"))
        number = ctypes.c_uint32()
        photos = core.value(lib.ewa_photo_list_photos, listed, ctypes.byref(number))
        count = number.value
    report = b.ewa_photos_report()
    each = (b.ewa_photo_report * max(1, count))()
    core.call(lib.ewa_cloud_color_from_photos, handle, photos, count, ctypes.byref(made), ctypes.byref(report), each)
    del keep, listed  # what the photographs lie in
    return PhotosReport(report.seen_count, report.psnr_db, report.held_out_psnr_db, (report.vignetting[0], report.vignetting[1]),
                        [PhotoReport(bool(r.held_out), (r.width_px, r.height_px), r.pixel_count, r.point_count,
                                     np.array(r.gain), np.array(r.offset), r.rms, r.psnr_db, r.rejected,
                                     np.array(r.world_to_camera).reshape(4, 4), r.shift_px)
                         for r in each[:count]])
