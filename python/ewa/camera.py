# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Cameras: OpenCV axes (x right, y down, z forward), pixel centres at half integers."""
from __future__ import annotations

import ctypes
import math
import operator
import os
from typing import Any, Sequence, Union

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._context import Context, core_of
from ._errors import ArgumentError, make
from ._library import functions as lib
from ._scene import World, core_of_things, place_at_box, things_of, view_options
from ._struct import numbers, path_bytes

#: Vertical field of view where nobody says, degrees; that of the program.
DEFAULT_FOV_DEG = 30.0
#: Picture where nobody says, pixels; that of the program.
DEFAULT_SIZE = (1280, 720)

PathLike = Union[str, "os.PathLike[str]"]
#: Three numbers.
Vector = Union[Sequence[float], Array]


def _check(status: int, what: str) -> None:
    if status:
        raise make(status, what)


def as_size(value: Any, label: str = "size") -> tuple[int, int]:
    """Width and height in pixels, each in [1, 65536]."""
    try:
        width, height = (operator.index(number) for number in value)
    except (TypeError, ValueError):
        raise ArgumentError(f"{label}: {value!r} is no pair of whole numbers (width, height)") from None
    if not (1 <= width <= 65536 and 1 <= height <= 65536):
        raise ArgumentError(f"{label}: {width} x {height} pixels are outside [1, 65536]")
    return width, height


class Camera:
    """A pinhole or orthographic camera; it never changes.

    Parameters
    ----------
    K : array_like, shape (3, 3), optional
        ``[[fx, s, cx], [0, fy, cy], [0, 0, 1]]`` in pixels, the skew ``s`` 0, pixel centres at half integers: the
        middle of a picture is ``(width / 2, height / 2)``, which is 0.5 more than in OpenCV. Default: from `fov`.
    world_to_camera : array_like, shape (4, 4) or (3, 4), optional
        A rotation, possibly times a positive scale, and a translation; acts on columns. Default: the identity.
    size : (int, int), optional
        Width and height in pixels, each 1 to 65536. Default (1280, 720).
    fov : float, optional
        Vertical field of view in degrees, in (0, 180), in place of `K`. Default 30.
    ortho : float, optional
        World units from the bottom to the top of an orthographic picture, in place of `K` and `fov`.

    Raises
    ------
    ArgumentError
        A number is not finite or out of range, the matrix is no rotation times a scale.
    """

    __slots__ = ("_struct", "_lens", "__weakref__")
    _struct: b.ewa_camera
    _lens: b.ewa_lens

    def __init__(self, K: Any = None, world_to_camera: Any = None, size: Sequence[int] = DEFAULT_SIZE, *,
                 fov: float | None = None, ortho: float | None = None) -> None:
        made = b.ewa_camera()
        lib.ewa_camera_init(ctypes.byref(made))
        made.width_px, made.height_px = as_size(size)
        if K is not None and (fov is not None or ortho is not None):
            raise ArgumentError("K: it excludes fov and ortho")
        if K is not None:
            k = numbers(K, 9, "K")
            if k[1] or k[3] or k[6] or k[7] or k[8] != 1:
                raise ArgumentError("K: [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] is needed")
            made.fx_px, made.cx_px, made.fy_px, made.cy_px = k[0], k[2], k[4], k[5]
        else:
            _set_lens(made, fov, ortho)
        if world_to_camera is not None:
            flat = np.asarray(world_to_camera, dtype=object).size
            m = numbers(world_to_camera, 12 if flat == 12 else 16, "world_to_camera")
            for i in range(len(m)):
                made.world_to_camera[i] = m[i]
        self._struct = checked(made)
        self._lens = b.ewa_lens()

    @staticmethod
    def _of(struct: b.ewa_camera, lens: b.ewa_lens | None = None) -> Camera:
        camera = Camera.__new__(Camera)
        camera._struct = struct
        camera._lens = b.ewa_lens() if lens is None else lens
        return camera

    @staticmethod
    def _checked(given: object) -> Camera:
        if isinstance(given, Camera):
            return given
        hint = "; ewa.cameras() reads those of a file" if isinstance(given, (str, os.PathLike)) else ""
        raise TypeError(f"camera: an ewa.Camera, not {type(given).__name__}{hint}")

    def _copy(self) -> b.ewa_camera:
        return b.ewa_camera.from_buffer_copy(self._struct)

    @classmethod
    def from_opencv(cls, K: Any, R: Any = None, t: Any = None, distortion: Any = None, *,
                    size: Sequence[int] | None = None, fisheye: bool = False) -> Camera:
        """Make the camera of OpenCV's numbers, as ``cv2.calibrateCamera`` and ``cv2.solvePnP`` return them.

        Pictures are drawn as by a pinhole without distortion; :func:`undistort` makes such a picture of a photograph, and
        :meth:`Cloud.color_from_photos` does so itself.

        Parameters
        ----------
        K : array_like, shape (3, 3)
            Pixels, pixel centres at whole numbers, which is half a pixel less than here.
        R : array_like, shape (3, 3) or (3,), optional
            Rotation from the world to the camera, a matrix, or axis times angle in radians. Default: none.
        t : array_like, shape (3,), optional
            Translation from the world to the camera, world units. Default: 0.
        distortion : array_like, up to 8 numbers, optional
            k1, k2, p1, p2, k3, k4, k5, k6; of a fisheye k1, k2, k3, k4. Default: 0.
        size : (int, int), optional
            Width and height in pixels. Default: that whose middle is the principal point.
        fisheye : bool, optional
            The lens is that of ``cv2.fisheye``.

        Raises
        ------
        ArgumentError
        """
        k = np.array(numbers(K, 9, "K")).reshape(3, 3)
        if size is None:
            size = [round(2 * float(k[i, 2]) + 1) for i in range(2)]
        k[:2, 2] += 0.5
        matrix = np.eye(4)
        if R is not None:
            matrix[:3, :3] = _rotation(R)
        if t is not None:
            matrix[:3, 3] = numbers(t, 3, "t")
        camera = cls(k, matrix, size)
        if distortion is not None:
            camera._lens = _lens_of(distortion, fisheye)
        return camera

    @property
    def distortion(self) -> Array:
        """What the lens does beside the pinhole, as OpenCV counts it: k1, k2, p1, p2, k3, k4, k5, k6; float64, shape (8,); of
        a fisheye k1, k2, k3, k4."""
        radial, tangential = list(self._lens.radial), list(self._lens.tangential)
        if self._lens.model == b.ewa_lens_model.EWA_LENS_FISHEYE:
            return np.array(radial[:4])
        return np.array(radial[:2] + tangential + radial[2:])

    @classmethod
    def look_at(cls, eye: Vector, target: Vector, up: Vector = (0, 0, 1), *,
                size: Sequence[int] = DEFAULT_SIZE, fov: float | None = None, ortho: float | None = None) -> Camera:
        """Make a camera at `eye` that looks at `target`, world units.

        Parameters
        ----------
        eye, target : array_like, shape (3,)
        up : array_like, shape (3,), optional
            What points up in the picture; default (0, 0, 1).
        size, fov, ortho
            As of :class:`Camera`.

        Raises
        ------
        NumericError
            Eye and target coincide.
        ArgumentError
        """
        camera = cls(size=size, fov=fov, ortho=ortho)
        made = camera._copy()
        _check(lib.ewa_camera_look_at(ctypes.byref(made), numbers(eye, 3, "eye"), numbers(target, 3, "target"),
                                      numbers(up, 3, "up")), "look_at: the eye is also where the camera looks")
        return cls._of(checked(made))

    @classmethod
    def frame(cls, what: Any, view: str | Sequence[float] | None = None,
              up: str | Sequence[float] | None = None, *, size: Sequence[int] = DEFAULT_SIZE,
              fov: float | None = None, ortho: float | None = None, azimuth: float = 0, elevation: float = 0,
              radius_scale: float = 1) -> Camera:
        """Make a camera that has the whole of something in its picture, as large as it goes.

        The camera is that of ``ewa render`` with the same options, to the last bit; that of a cloud without normals and
        radii sees what is estimated.

        Parameters
        ----------
        what : Scene, or anything that one takes; a list of these; array_like of shape (2, 3)
            What is to be seen; six numbers: the lower and the upper corner of a box.
        view : {"front", "back", "left", "right", "top", "bottom", "iso"} or array_like of shape (3,), optional
            Side from which it is seen, or the direction of the view. Default: by the shape.
        up : {"y", "z", "-y", "-z"} or array_like of shape (3,), optional
            What points up in the picture. Default: chosen by the points, as the program does. What has y or z down is
            seen from the sides of what hangs, as Gaussians do whose y points down.
        azimuth, elevation : float, optional
            Degrees by which the camera is carried about the up axis from there, then raised.
        radius_scale : float, optional
            Factor of the surfels' radii.
        size, fov, ortho
            As of :class:`Camera`.

        Raises
        ------
        ArgumentError
        NumericError
            There is no finite point.
        """
        cls(size=size, fov=fov, ortho=ortho)  # which says what is wrong with these
        asked = view_options(view, up, size=size, fov=fov, ortho=ortho, azimuth=azimuth, elevation=elevation)
        if _is_box(what):
            return cls._of(checked(place_at_box(core_of(None), what, asked)))
        things = things_of(what)
        if len(things) == 1 and hasattr(things[0], "_whole") and radius_scale == 1:
            return cls._of(checked(things[0]._whole().place(asked)))
        world = World(core_of_things(things), surfels={"radius_scale": radius_scale})
        for thing in things:
            world.add(thing)
        return cls._of(checked(world.place(asked)))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, pixels."""
        return self._struct.width_px, self._struct.height_px

    @property
    def K(self) -> Array:
        """Focal lengths and principal point, pixels; float64, shape (3, 3)."""
        s = self._struct
        return np.array([[s.fx_px, 0, s.cx_px], [0, s.fy_px, s.cy_px], [0, 0, 1]])

    @property
    def world_to_camera(self) -> Array:
        """float64, shape (4, 4); acts on columns."""
        return np.array(self._struct.world_to_camera).reshape(4, 4)

    @property
    def orthographic(self) -> bool:
        """Whether the projection is orthographic; focal lengths are pixels per world unit then."""
        return self._struct.projection == b.ewa_projection.EWA_ORTHOGRAPHIC

    @property
    def eye(self) -> Array:
        """Position in the world; float64, shape (3,)."""
        eye = (ctypes.c_double * 3)()
        lib.ewa_camera_eye(ctypes.byref(self._struct), eye)
        return np.array(eye)

    def orbit(self, pivot: Vector, axis: Vector, angle_deg: float) -> Camera:
        """Return the camera carried about an axis, right-handed, by degrees: a turntable.

        Raises
        ------
        ArgumentError, NumericError
        """
        made = self._copy()
        _check(lib.ewa_camera_orbit(ctypes.byref(made), numbers(pivot, 3, "pivot"), numbers(axis, 3, "axis"),
                                    _real(angle_deg, "angle_deg")), "orbit: no axis")
        return Camera._of(checked(made), self._lens)

    def resized(self, width: int, height: int) -> Camera:
        """Return the camera with a picture of another size that shows the same.

        Raises
        ------
        ArgumentError
        """
        made = self._copy()
        lib.ewa_camera_resize(ctypes.byref(made), b.ewa_resize.EWA_RESIZE_STRETCH, *as_size((width, height)))
        return Camera._of(checked(made), self._lens)

    def save(self, path: PathLike) -> None:
        """Write a camera file (JSON) with every digit, for ``--camera`` of the program and :func:`cameras`.

        Raises
        ------
        FileError
        """
        core = core_of(None)
        core.call(lib.ewa_camera_save, core.address, ctypes.byref(self._struct), path_bytes(path))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Camera) and self._bytes() == other._bytes()

    def __hash__(self) -> int:
        return hash(self._bytes())

    def _bytes(self) -> bytes:
        return bytes(self._struct) + bytes(self._lens)

    def __repr__(self) -> str:
        kind = "orthographic" if self.orthographic else "perspective"
        eye = ", ".join(f"{x:.6g}" for x in self.eye)
        return f"<ewa.Camera {self.size[0]}x{self.size[1]}, {kind}, eye ({eye})>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (bytes(self._struct), bytes(self._lens))


def _is_box(what: Any) -> bool:
    """Whether something is two rows of three numbers, and no two things."""
    if isinstance(what, np.ndarray):
        return bool(what.shape == (2, 3))
    return isinstance(what, (list, tuple)) and len(what) == 2 and all(
        isinstance(row, (list, tuple, np.ndarray)) and len(row) == 3 and not isinstance(row[0], np.ndarray) for row in what)


def _restore(data: bytes, lens: bytes) -> Camera:
    if len(data) != ctypes.sizeof(b.ewa_camera) or len(lens) != ctypes.sizeof(b.ewa_lens):
        raise ArgumentError("no camera")
    return Camera._of(checked(b.ewa_camera.from_buffer_copy(data)), b.ewa_lens.from_buffer_copy(lens))


def _rotation(value: Any) -> Array:
    """A rotation of three numbers, by Rodrigues's formula, or of nine."""
    if np.size(np.asarray(value, dtype=object)) != 3:
        return np.array(numbers(value, 9, "R")).reshape(3, 3)
    vector = np.array(numbers(value, 3, "R"))
    angle = float(np.linalg.norm(vector))
    x, y, z = vector / angle if angle else vector
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    made: Array = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * (cross @ cross)
    return made


def _lens_of(distortion: Any, fisheye: bool) -> b.ewa_lens:
    """The lens of OpenCV's numbers, of which trailing ones may be left out, or be zeros."""
    count = int(np.size(np.asarray(distortion, dtype=object)))
    given = list(numbers(distortion, count, "distortion")) if count else []
    maximum = 4 if fisheye else 8
    if any(given[maximum:]):
        raise ArgumentError(f"distortion: {count} numbers; thin prisms and tilted sensors are not known" if not fisheye else
                            f"distortion: {count} numbers; a fisheye has 4")
    given = (given + [0.0] * maximum)[:maximum]
    lens = b.ewa_lens()
    if not any(given):
        return lens
    lens.model = b.ewa_lens_model.EWA_LENS_FISHEYE if fisheye else b.ewa_lens_model.EWA_LENS_BROWN
    for i, number in enumerate(given if fisheye else given[:2] + given[4:]):
        lens.radial[i] = number
    if not fisheye:
        lens.tangential[:] = given[2:4]
    return lens


def _real(value: Any, label: str) -> float:
    return float(numbers([value], 1, label)[0])


def _set_lens(camera: b.ewa_camera, fov: float | None, ortho: float | None) -> None:
    if ortho is not None:
        if fov is not None:
            raise ArgumentError("fov: it excludes ortho")
        _check(lib.ewa_camera_set_ortho(ctypes.byref(camera), _real(ortho, "ortho")),
               f"ortho: {ortho} is outside (0, inf)")
        return
    angle = _real(DEFAULT_FOV_DEG if fov is None else fov, "fov")
    _check(lib.ewa_camera_set_fov(ctypes.byref(camera), angle), f"fov: {angle} is outside (0, 180)")


def checked(camera: b.ewa_camera) -> b.ewa_camera:
    core = core_of(None)
    core.call(lib.ewa_camera_check, core.address, ctypes.byref(camera))
    return camera


def _is_poses(path: bytes) -> bool:
    return path.lower().endswith((b".txt", b".log", b".tum")) and not os.path.isdir(path)


def cameras(path: PathLike, lens: Camera | PathLike | None = None) -> list[Camera]:
    """Read every camera of a file.

    Reads ewa's own JSON, Open3D, nerfstudio, INRIA, stacks of matrices, folders of COLMAP models, and poses as text
    (.txt, .log, .tum: 4 x 4 matrices, or lines of TUM; camera to world).

    Parameters
    ----------
    path : path
    lens : Camera or path, optional
        Size and lens of poses, which have none; or a file with a lens. Default: 1280 x 720, 30 degrees.

    Returns
    -------
    list of Camera
        In the order of the file.

    Raises
    ------
    FileError, FormatError, OutOfMemory
    """
    file = path_bytes(path)
    found: list[b.ewa_camera] = []

    def receive(user: int | None, index: int, camera: Any) -> None:
        found.append(b.ewa_camera.from_buffer_copy(camera.contents))

    callback = b.ewa_camera_callback(receive)
    core = core_of(None)
    if not _is_poses(file):
        core.call(lib.ewa_camera_load_each, core.address, file, callback, None)
    else:
        if lens is None:
            lens = Camera()
        elif not isinstance(lens, Camera):
            struct = Camera()._copy()
            core.call(lib.ewa_camera_load_lens, core.address, path_bytes(lens, "lens"), ctypes.byref(struct))
            lens = Camera._of(struct)
        core.call(lib.ewa_camera_load_poses, core.address, file, ctypes.byref(lens._struct), callback, None)
    return [Camera._of(struct) for struct in found]


def save_cameras(path: PathLike, cameras: Sequence[Camera]) -> None:
    """Write cameras as one file (JSON), for ``--path`` of the program and :func:`cameras`.

    Raises
    ------
    FileError, ArgumentError
    """
    core = core_of(None)
    array = (b.ewa_camera * max(len(cameras), 1))(*[camera._struct for camera in cameras])
    core.call(lib.ewa_camera_save_list, core.address, array, len(cameras), path_bytes(path))


class CameraPath:
    """A smooth way through cameras that are evenly spaced in time.

    Parameters
    ----------
    keys : sequence of Camera
        At least one, all of one size and projection.
    closed : bool, optional
        Whether the way goes on from the last to the first.

    Raises
    ------
    ArgumentError
    """

    def __init__(self, keys: Sequence[Camera], closed: bool = False, *, context: Context | None = None) -> None:
        core = core_of(context)
        array = (b.ewa_camera * max(len(keys), 1))(*[camera._struct for camera in keys])
        self._handle = core.make(lib.ewa_camera_path_create, core.address, array, len(keys), bool(closed),
                                 destroy=lib.ewa_camera_path_destroy, what="the path")

    def at(self, place: float) -> Camera:
        """Return the camera at a place counted in keys: 0 is the first, 1.5 half-way from the second to the third.

        Raises
        ------
        ArgumentError
        """
        if not math.isfinite(place):
            raise ArgumentError(f"place: {place} is not finite")
        made = b.ewa_camera()
        self._handle.core.call(lib.ewa_camera_path_at, self._handle, float(place), ctypes.byref(made))
        return Camera._of(made)
