# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Pictures: what rendering returns, colours, files of pictures."""
from __future__ import annotations

import ctypes
import numbers
import os
import tempfile
from typing import Any, Generic, Sequence, TypeVar, Union, overload

import numpy as np
import numpy.typing as npt

from . import _bindings as b
from ._arrays import Array, as_contiguous
from ._context import Context, core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import Source, initialised, loader, path_bytes
from .camera import Camera, PathLike

#: Linear light (r, g, b[, a]), straight alpha, as in C; or text as the program takes it: "white", "transparent",
#: "#ff8800", and "r,g,b[,a]" of sRGB numbers in [0, 1].
Color = Union[str, Sequence[float]]


def linear(color: Color, label: str = "background") -> tuple[float, ...]:
    """Return four linear numbers, straight alpha."""
    if not isinstance(color, str):
        numbers = tuple(color) if hasattr(color, "__iter__") else ()
        if len(numbers) not in (3, 4):
            raise ArgumentError(f"{label}: {color!r} is no colour: 3 or 4 numbers, or text")
        return numbers if len(numbers) == 4 else numbers + (1.0,)
    srgba = (ctypes.c_double * 4)()
    if not lib.ewa_color_read(color.encode(), srgba):
        raise ArgumentError(f"{label}: '{color}' is no colour")
    return tuple(lib.ewa_linear_from_srgb(number) for number in srgba[:3]) + (srgba[3],)


#: Channels of OpenEXR that planes are written as.
_CHANNELS = {"depth": "Z", "normal": "N.X,N.Y,N.Z", "coverage": "coverage"}

_Number = TypeVar("_Number", bound="np.generic[Any]")


class _Plane(Generic[_Number]):
    """A plane of an image, which raises where it was not drawn, so that what there is, is an array."""

    def __init__(self, kind: type[_Number], meaning: str) -> None:
        self.__doc__ = meaning

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, image: None, owner: type) -> _Plane[_Number]: ...

    @overload
    def __get__(self, image: Image, owner: type) -> npt.NDArray[_Number]: ...

    def __get__(self, image: Image | None, owner: type) -> Any:
        if image is None:
            return self
        plane = image._planes.get(self.name)
        if plane is None:
            raise ArgumentError(f"the plane {self.name} was not drawn; planes=(..., \"{self.name}\") asks for it")
        return plane

    def __set__(self, image: Image, plane: npt.NDArray[_Number]) -> None:
        image._planes[self.name] = plane


class Image:
    """A picture and its further planes; one that was not asked for raises ArgumentError.

    Attributes
    ----------
    rgba8 : ndarray of uint8, shape (height, width, 4)
        sRGB, straight alpha, over the background.
    rgba : ndarray of float32, shape (height, width, 4)
        Linear light, premultiplied, over the background.
    depth : ndarray of float32, shape (height, width)
        Camera-space z, world units; infinite where nothing is.
    normal : ndarray of float32, shape (height, width, 3)
        Unit, world space, towards the viewer; 0 where nothing is.
    coverage : ndarray of float32, shape (height, width)
        Sum of kernels over its expectation, 1: covered.
    holes : ndarray of uint8, shape (height, width)
        Of warping: 255 where less than half of a pixel is covered.
    planes : tuple of str
        Names of those that were drawn.
    camera : Camera
        That drew it.
    opaque : bool
        Whether alpha says nothing, so that files are written without.
    stats : dict
        What it took: counts, and seconds per stage.
    """

    __slots__ = ("_planes", "camera", "opaque", "_stats", "_of_floats")
    rgba8 = _Plane(np.uint8, "sRGB, straight alpha")
    rgba = _Plane(np.float32, "Linear light, premultiplied")
    depth = _Plane(np.float32, "Camera-space z, world units")
    normal = _Plane(np.float32, "Unit, world space")
    coverage = _Plane(np.float32, "1: covered")
    holes = _Plane(np.uint8, "255 where less than half of a pixel is covered")

    def __init__(self, camera: Camera | None, opaque: bool = False, of_floats: bool = False) -> None:
        self._planes: dict[str, Array] = {}
        self.camera = camera
        self.opaque = opaque
        self._of_floats = of_floats  # as the program does: files of 8 bits are made of the plane rgba
        self._stats: Any = None

    @property
    def planes(self) -> tuple[str, ...]:
        return tuple(self._planes)

    @property
    def stats(self) -> dict[str, Any]:
        if self._stats is None:
            return {}
        return {name: getattr(self._stats, name) for name, *_ in self._stats._fields_}

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        for plane in self._planes.values():
            return plane.shape[1], plane.shape[0]
        return 0, 0

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        plane: Array = self.rgba if "rgba" in self._planes and "rgba8" not in self._planes else self.rgba8
        return plane if dtype is None or plane.dtype == dtype else plane.astype(dtype)

    def _repr_png_(self) -> bytes | None:
        return self.encode() if "rgba8" in self._planes or self._of_floats else None

    def encode(self, suffix: str = ".png", *, quality: int | None = None) -> bytes:
        """Return the bytes of the file that :meth:`save` writes.

        Parameters
        ----------
        suffix : str, optional
            What it is: ".png", ".jpg", ".exr", ".pfm".
        quality : int, optional
            As of :meth:`save`.

        Raises
        ------
        ArgumentError, FormatError
        """
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "image" + suffix)
            self.save(path, quality=quality)
            with open(path, "rb") as file:
                return file.read()

    def __repr__(self) -> str:
        return f"<ewa.Image {self.size[0]}x{self.size[1]}: {', '.join(self._planes)}>"

    def save(self, path: PathLike, *, quality: int | None = None) -> None:
        """Write the picture: .png, .jpg (8-bit sRGB), .exr (linear floats, all planes), .pfm (linear RGB).

        The bytes are those that the program writes.

        Parameters
        ----------
        path : path
        quality : int, optional
            Of .jpg, [0, 100], small to good; 95 where it is not given.

        Raises
        ------
        ArgumentError
            The plane that the format needs (rgba8, of textures rgba; rgba) was not drawn; a quality of another format.
        FileError, FormatError
        """
        file = path_bytes(path)
        if quality is not None and not file.lower().endswith((b".jpg", b".jpeg")):
            raise ArgumentError(f"'{os.fsdecode(file)}': quality={quality}; of pictures .jpg alone has one")
        if file.lower().endswith((b".png", b".jpg", b".jpeg")):
            if self._of_floats:
                save_image(path, self.rgba[:, :, :3] if self.opaque else self.rgba, quality=quality)
                return
            pixels = _without_alpha(self.rgba8) if self.opaque else np.ascontiguousarray(self.rgba8)
            height, width, channels = pixels.shape
            core = core_of(None)
            core.call_apart(lib.ewa_pixels_save, core.address, file, width, height, channels, pixels.ctypes.data,
                            width * channels, ctypes.byref(_save_options(quality)), keep=pixels)
            return
        if "rgba" not in self._planes and not file.lower().endswith((b".exr", b".pfm")):
            raise ArgumentError(f"'{os.fsdecode(file)}': pictures are written to .png, .jpg, .exr and .pfm")
        if not file.lower().endswith(b".exr"):
            save_image(path, self.rgba[:, :, :3], camera=self.camera)
            return
        names, planes = ["R,G,B,A"], [self.rgba]
        for plane, channels in _CHANNELS.items():
            if plane in self._planes:
                names.append(channels)
                planes.append(self._planes[plane].reshape(*self.rgba.shape[:2], -1))
        save_image(path, np.concatenate(planes, axis=2), channel_names=",".join(names), camera=self.camera)

    def save_plane(self, name: str, path: PathLike) -> None:
        """Write one plane, "depth", "normal" or "coverage", to .exr or .pfm, as ``--aov`` of the program does.

        Raises
        ------
        ArgumentError, FileError, FormatError
        """
        if name not in _CHANNELS:
            raise ArgumentError(f"'{name}' is none of {', '.join(_CHANNELS)}")
        save_image(path, getattr(self, name), channel_names=_CHANNELS[name], camera=self.camera)


def _without_alpha(rgba8: Array) -> Array:
    """The colours alone, some rows at a time, between which Ctrl-C is heard."""
    made = np.empty(rgba8.shape[:2] + (3,), np.uint8)
    for y in range(0, len(made), 256):
        made[y:y + 256] = rgba8[y:y + 256, :, :3]
    return made


def _save_options(quality: int | None) -> b.ewa_image_save_options:
    options = initialised(b.ewa_image_save_options, lib.ewa_image_save_options_init)
    if quality is not None:
        if not isinstance(quality, numbers.Integral) or not 0 <= quality <= 100:
            raise ArgumentError(f"quality: {quality!r}; a whole number in [0, 100] is needed")
        options.jpeg_quality = int(quality)
    return options


def save_image(path: PathLike, pixels: Any, *, channel_names: str | None = None, camera: Camera | None = None,
               quality: int | None = None) -> None:
    """Write float pixels: .png, .jpg (sRGB from linear light), .exr or .pfm.

    Parameters
    ----------
    path : path
    pixels : array_like, shape (height, width) or (height, width, channels)
        float32; colours linear, 4 channels premultiplied.
    channel_names : str, optional
        Names of the channels of .exr, comma-separated.
    camera : Camera, optional
        Written into .exr.
    quality : int, optional
        Of .jpg, [0, 100]; 95 where it is not given.

    Raises
    ------
    ArgumentError, FileError, FormatError
    """
    array = np.asarray(pixels)
    array = as_contiguous(array[:, :, None] if array.ndim == 2 else array, np.float32, (None, None, None), "pixels")
    core = core_of(None)
    image = pixels_struct(array, core.address)
    options = _save_options(quality)
    if channel_names is not None:
        options.channel_names = channel_names.encode()
    if camera is not None:
        offset: int = getattr(b.ewa_camera, "world_to_camera").offset
        options.world_to_camera = ctypes.addressof(camera._struct) + offset
    core.call_apart(lib.ewa_image_save, ctypes.byref(image), path_bytes(path), ctypes.byref(options), keep=(array, camera))


def pixels_struct(array: Array, context: int | None) -> b.ewa_image:
    """An image of the library over an array of (h, w, c) floats."""
    height, width, channels = array.shape
    if not (1 <= height <= 65536 and 1 <= width <= 65536 and 1 <= channels <= 16):
        raise ArgumentError(f"pixels: shape {array.shape}; sides of 1 to 65536, 1 to 16 channels are needed")
    return b.ewa_image(context=context, width_px=width, height_px=height, channel_count=channels,
                       pixels=array.ctypes.data)


def as_picture(value: Any, label: str) -> Array:
    """A picture as (height, width, channels) floats, linear: of a path, of floats, or of uint8, which are sRGB."""
    if isinstance(value, (str, bytes, os.PathLike)):
        return read_image(value)
    if isinstance(value, Image):
        value = value.rgba if "rgba" in value.planes else value.rgba8
    array = np.asarray(value)
    array = array[:, :, None] if array.ndim == 2 else array
    if array.dtype != np.uint8:
        return as_contiguous(array, np.float32, (None, None, None), label)
    made = linear_of_codes(array)
    if array.shape[2] == 4:
        made[:, :, :3] *= made[:, :, 3:]
    return np.ascontiguousarray(made)


def linear_of_codes(codes: Array) -> Array:
    """Linear light of sRGB codes of all bits of an unsigned type, as float32; a fourth component is alpha."""
    high = int(np.iinfo(codes.dtype).max)
    used, places = (np.arange(256), codes) if high == 255 else np.unique(codes, return_inverse=True)
    table = np.array([lib.ewa_linear_from_srgb(code / high) for code in used.tolist()], np.float32)
    made: Array = table[places].reshape(codes.shape)
    if codes.shape[-1] == 4:
        made[..., 3] = codes[..., 3].astype(np.float32) / np.float32(high)
    return made


def taken(image: b.ewa_image) -> Array:
    """The pixels of an image of the library, which is freed."""
    shape = (image.height_px, image.width_px, image.channel_count)
    data = ctypes.string_at(image.pixels or 0, 4 * shape[0] * shape[1] * shape[2])
    lib.ewa_image_free(ctypes.byref(image))
    return np.frombuffer(bytearray(data), np.float32).reshape(shape)


def _read(load: Any, load_memory: Any, path: Source, context: Context | None) -> Array:
    core = core_of(context)
    image = b.ewa_image()
    function, source = loader(load, load_memory, path)

    def read(address: int) -> Any:
        status = function(address, *source, ctypes.byref(image))
        if status:
            return status
        pixels.append(taken(image))
        return status

    pixels: list[Array] = []
    core.call_apart(read, core.address)
    return pixels[0]


def read_image(path: Source, *, context: Context | None = None) -> Array:
    """Read PNG, JPEG, WebP, OpenEXR, PFM or Radiance, of a path, or of the bytes of a file.

    Returns
    -------
    ndarray of float32, shape (height, width, channels)
        Linear light; 4 channels premultiplied.

    Raises
    ------
    FileError, FormatError, OutOfMemory
    """
    return _read(lib.ewa_image_load, lib.ewa_image_load_memory, path, context)


def read_depth(path: Source, *, context: Context | None = None) -> Array:
    """Read the numbers of a depth image, of a path or the bytes of a file: PNG of 8 or 16 bits, OpenEXR, PFM; 65535 of PNG
    becomes infinite.

    Returns
    -------
    ndarray of float32, shape (height, width)

    Raises
    ------
    FileError, FormatError, OutOfMemory
    """
    return _read(lib.ewa_depth_load, lib.ewa_depth_load_memory, path, context)[:, :, 0]
