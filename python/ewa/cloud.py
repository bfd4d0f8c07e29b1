# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Point clouds: named streams of numbers, of the caller's arrays or of files."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import TYPE_OF, Array, as_points, exported
from ._colormaps import color_codes, colors_of_map
from ._context import Context, Core, Handle, Pin, core_of
from ._errors import ArgumentError, ClosedError
from ._keywords import keywords
from ._library import functions as lib
from ._library import library
from ._struct import fill, initialised, numbers, path_bytes, text_bytes
from .camera import Camera, PathLike
from .photographs import PhotosReport
from .photographs import color as color_from_photos
from .surfels import Surfels

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import (CloudSaveOptions, EstimateOptions, FeatureOptions, GenerateOptions, PhotosOptions,
                           ProcedureOptions, RefitOptions, SurfelsOptions)

# Notes may hold zeros, which end a text of ctypes.
_note = library["ewa_cloud_note"]
_note.restype = ctypes.c_void_p
_note.argtypes = (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)

#: Names of arguments that stand for the library's.
_ALIASES = {"normals": "normal", "colors": "color"}

#: Streams that the library knows.
MEANT = ("position", "normal", "color", "radius", "tangent_u", "tangent_v", "material", "clip0", "clip1", "clip_mode", "border",
         "surfaceness", "signed_curvature")


class Cloud:
    """Points as named streams, of which the library knows ``position normal color radius tangent_u tangent_v
    material clip0 clip1 clip_mode border``; every other name is kept.

    Arrays are borrowed, not copied, where they are of a type that the library has (float32, float64, integers of 8 to
    32 bits), aligned, and the numbers of one point lie side by side; points may be any distance apart. Others are
    copied. Do not change or free a borrowed array while it is used.

    Parameters
    ----------
    positions : array_like, shape (n, 3)
        World units, relative to `origin`; float32 or float64, integers become float64. NaN: a point that is not drawn.
    normals : array_like, shape (n, 3), optional
        Outward, any length but zero.
    colors : array_like, shape (n, 3) or (n, 4), optional
        Red, green, blue, alpha: integers are sRGB over their whole range, floats linear light.
    radius : array_like, shape (n,), optional
        Support radius of the discs, world units.
    origin : array_like, shape (3,), optional
        What has to be added to the positions to give world coordinates. Default: 0, 0, 0.
    copy : bool, optional
        None (default): copy what cannot be borrowed; False: fail instead; True: copy everything.
    context : Context, optional
    **attributes
        Further streams, arrays of shape (n,) or (n, 1) to (n, 4).

    Raises
    ------
    ArgumentError
        A shape, type or number of points that does not fit.
    """

    _handle: Handle | None
    _name: bytes | None = None  # its file, if that says by its kind what is up

    def __init__(self, positions: Any, *, normals: Any = None, colors: Any = None, radius: Any = None,
                 origin: Sequence[float] | None = None, copy: bool | None = None, context: Context | None = None,
                 **attributes: Any) -> None:
        position = as_points(positions, "positions", copy)
        if position.ndim != 2 or position.shape[1] != 3:
            raise ArgumentError(f"positions: shape {position.shape}; (n, 3) is needed")
        if position.dtype.kind != "f" and copy is False:
            raise ArgumentError(f"positions: numbers of type {position.dtype}; float32 or float64 is needed")
        if position.dtype.kind != "f":
            position = position.astype(np.float64)
        streams = {"position": position}
        given = {"normal": normals, "color": colors, "radius": radius, **attributes}
        for name, value in given.items():
            if value is not None:
                streams[_ALIASES.get(name, name)] = as_points(value, name, copy)
        self._handle = borrowed(core_of(context), streams, len(position))
        if origin is not None:
            self._core.value(lib.ewa_cloud_set_origin, self._handle, numbers(origin, 3, "origin"))

    @staticmethod
    def _of(handle: Handle) -> Cloud:
        cloud = Cloud.__new__(Cloud)
        cloud._handle = handle
        return cloud

    @staticmethod
    def _made(core: Core, function: Any, *arguments: Any, keep: tuple[Any, ...] = ()) -> Cloud:
        """The cloud that a function of the library makes; its last argument receives it."""
        return Cloud._of(core.make(function, *arguments, destroy=lib.ewa_cloud_destroy, what="the cloud", keep=keep))

    @property
    def _h(self) -> Handle:
        if self._handle is None:
            raise ClosedError("the cloud is closed")
        return self._handle

    @property
    def _core(self) -> Core:
        return self._h.core

    # ---- What is there ------------------------------------------------------------------------------------------

    def __len__(self) -> int:
        return int(self._core.value(lib.ewa_cloud_point_count, self._h))

    def _attributes(self) -> list[b.ewa_attribute]:
        def read(cloud: int) -> list[b.ewa_attribute]:
            count = lib.ewa_cloud_attribute_count(cloud)
            return [b.ewa_attribute.from_buffer_copy(lib.ewa_cloud_attribute_at(cloud, i).contents)
                    for i in range(count)]

        found: list[b.ewa_attribute] = self._core.value(read, self._h)
        return found

    def keys(self) -> list[str]:
        """Return the names of the streams, in their order."""
        return [attribute.name.decode() for attribute in self._attributes()]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and bool(self._core.value(lib.ewa_cloud_find, self._h, name.encode()))

    def __getitem__(self, name: str) -> Array:
        """Return a stream: shape (n, k), or (n,) for one number per point; read-only, not copied."""
        if not isinstance(name, str):
            raise TypeError(f"the name of a stream, not {type(name).__name__}")
        attribute = self._core.value(lambda cloud: _copied(lib.ewa_cloud_find(cloud, name.encode())), self._h)
        if attribute is None:
            raise KeyError(name)
        return exported(self._h, attribute, len(self))

    def borrows(self, name: str) -> bool:
        """Return whether a stream is memory of the array that it was made of."""
        for attribute in self._attributes():
            if attribute.name.decode() == name:
                return bool(attribute.borrowed)
        raise KeyError(name)

    def __setitem__(self, name: str, value: Any) -> None:
        """Add a stream, or replace one; the array is borrowed as by the constructor."""
        array = as_points(value, name, None)
        if len(array) != len(self):
            raise ArgumentError(f"{name}: {len(array)} points, not {len(self)}")
        changed = self._derive(without=name)
        _borrow(changed._h, {name: array})
        changed._h.keep += (Pin(array, name),)
        self._handle = changed._handle

    def __delitem__(self, name: str) -> None:
        if name not in self:
            raise KeyError(name)
        self._handle = self._derive(without=name)._handle

    @property
    def origin(self) -> Array:
        """What has to be added to positions to give world coordinates; float64, shape (3,)."""
        origin = (ctypes.c_double * 3)()
        self._core.value(lib.ewa_cloud_origin, self._h, origin)
        return np.array(origin)

    @property
    def bounds(self) -> Array:
        """Lower and upper corner of the finite positions, world units; float64, shape (2, 3).

        Where there is none the lower corner is above the upper one.
        """
        box = self._measure()
        return np.array([box.low_world, box.high_world])

    def _measure(self) -> b.ewa_bounds:
        box = b.ewa_bounds()
        self._core.call(lib.ewa_cloud_measure, self._h, ctypes.byref(box))
        return box

    @property
    def notes(self) -> dict[str, bytes]:
        """What the file said beside its points: "crs", "file.generator", ..."""

        def read(cloud: int) -> dict[str, bytes]:
            found: dict[str, bytes] = {}
            while True:
                name = lib.ewa_cloud_note_name(cloud, len(found))
                if name is None:
                    return found
                size = ctypes.c_size_t()
                text = _note(cloud, name, ctypes.byref(size))
                found[name.decode()] = ctypes.string_at(text, size.value) if text else b""

        notes: dict[str, bytes] = self._core.value(read, self._h)
        return notes

    def scalar(self, word: str) -> Array:
        """Return one number per point by any of its names: "intensity", "normal.x", "x", "red", "ReturnNumber".

        Returns
        -------
        ndarray of float64, shape (n,)
            Coordinates in world units.

        Raises
        ------
        ArgumentError
            There is none; the message has the names that there are.
        """
        found = np.empty(len(self))

        def read(cloud: int) -> int:
            scalar = b.ewa_scalar()
            status = lib.ewa_cloud_find_scalar(cloud, str(word).encode(), ctypes.byref(scalar))
            if status == b.ewa_status.EWA_OK:
                lib.ewa_scalar_read(ctypes.byref(scalar), 0, len(found), found.ctypes.data)
            return status

        self._core.call(read, self._h)
        return found

    def __reduce__(self) -> Any:
        grid = b.ewa_coordinate_grid()
        self._core.value(lib.ewa_cloud_grid, self._h, ctypes.byref(grid))
        return _restore, ({name: self[name] for name in self}, len(self), self.origin, bytes(grid), self.notes, self._name)

    def close(self) -> None:
        """Give up the cloud; its memory is freed when no array shows it. Later use raises ClosedError."""
        self._handle = None

    def __repr__(self) -> str:
        if self._handle is None:
            return "<ewa.Cloud, closed>"
        return f"<ewa.Cloud of {len(self)} points: {', '.join(self)}>"

    # ---- Other clouds -------------------------------------------------------------------------------------------

    def _derive(self, without: str | None = None) -> Cloud:
        """A cloud of the same streams, borrowed, so that what is done to it leaves this one alone."""
        derived = Cloud._made(self._core, lib.ewa_cloud_create, self._core.address, len(self), keep=(self._h,))
        core, h = self._core, derived._h
        for attribute in self._attributes():
            if attribute.name.decode() != without:
                core.call(lib.ewa_cloud_borrow, h, attribute.name, attribute.type, attribute.component_count,
                          attribute.data, attribute.stride_bytes)
        origin = (ctypes.c_double * 3)()
        core.value(lib.ewa_cloud_origin, self._h, origin)
        core.value(lib.ewa_cloud_set_origin, h, origin)
        grid = b.ewa_coordinate_grid()
        core.value(lib.ewa_cloud_grid, self._h, ctypes.byref(grid))
        core.value(lib.ewa_cloud_set_grid, h, ctypes.byref(grid))
        for name, text in self.notes.items():
            core.call(lib.ewa_cloud_set_note, h, name.encode(), text, len(text))
        derived._name = self._name
        return derived

    @keywords("ewa_estimate_options")
    def estimate(self, **options: Unpack[EstimateOptions]) -> Cloud:
        """Return the cloud with the normals and radii that it lacks, estimated from its neighbours.

        Parameters
        ----------
        **options
            ``viewpoint_world``: One that is given is what normals point to, unless ``orientation`` says otherwise.
            Default: None.

        Raises
        ------
        ArgumentError, OutOfMemory
        """
        made = initialised(b.ewa_estimate_options, lib.ewa_estimate_options_init)
        fill(made, "ewa_estimate_options", options)
        if options.get("viewpoint_world") is not None and options.get("orientation") is None:
            made.orientation = b.ewa_orientation.EWA_ORIENT_VIEWPOINT
        cloud = self._derive()
        handle = cloud._h

        def run(address: int) -> int:
            pointer = ctypes.c_void_p(address)
            status: int = lib.ewa_cloud_estimate(ctypes.byref(pointer), ctypes.byref(made))
            handle.address = pointer.value
            return status

        self._core.call(run, handle)
        return cloud

    def _is_drawable(self) -> bool:
        return ("tangent_u" in self and "tangent_v" in self) or ("normal" in self and "radius" in self)

    @keywords("ewa_surfels_options")
    def surfels(self, *, close_gaps: bool = True, **options: Unpack[SurfelsOptions]) -> Surfels:
        """Return the resident form of the cloud, which is what is drawn.

        Normals and radii that it lacks are estimated first. As in the program, radii that leave gaps between the discs
        are measured anew from the spacing.

        Parameters
        ----------
        close_gaps : bool, optional
            False: draw the radii as they are, with gaps.
        **options

        Raises
        ------
        ArgumentError
            An attribute of a wrong shape.
        FormatError
            None of the points can be drawn; columns of Gaussian splatting, which are no surfels.
        OutOfMemory
        """
        return Surfels._made(self, close_gaps, options)

    def _asset_members(self) -> dict[str, Any]:
        return {"cloud": self._h, **({"name": self._name} if self._name else {})}

    def _completed(self) -> Cloud:
        """The cloud with normals and radii, estimated where it has none, as the program does with its inputs."""
        if self._is_drawable():
            return self
        cloud = self._derive()
        self._core.call(lib.ewa_cloud_refuse_gaussians, cloud._h)
        self._core.value(lib.ewa_cloud_drop_zero_normals, cloud._h)
        return cloud.estimate()

    def transform(self, matrix: Any) -> Cloud:
        """Return the cloud mapped by a matrix that acts on columns, (4, 4) or (3, 4), with all directions and sizes.

        Raises
        ------
        ArgumentError, NumericError
        """
        flat = list(numbers(matrix, 12 if np.size(matrix) == 12 else 16, "matrix"))
        whole = (ctypes.c_double * 16)(*(flat + [0, 0, 0, 1] if len(flat) == 12 else flat))
        cloud = self._derive()
        self._core.call(lib.ewa_cloud_transform, cloud._h, whole)
        return cloud

    def select(self, points: Any) -> Cloud:
        """Return a cloud of some points, by a mask of shape (n,) or by their indices, in that order.

        Raises
        ------
        ArgumentError
            An index beyond the last point, a mask of another length.
        """
        array = np.asarray(points)
        if array.dtype == np.dtype(bool):
            if array.shape != (len(self),):
                raise ArgumentError(f"points: a mask of shape {array.shape}, not ({len(self)},)")
            array = np.flatnonzero(array)
        if array.ndim != 1 or array.dtype.kind not in "iu" and array.size:
            raise ArgumentError(f"points: indices of shape {array.shape} and type {array.dtype}")
        if array.size and int(array.min()) < 0:
            raise ArgumentError("points: a negative index")
        indices = np.ascontiguousarray(array, np.uint64)
        return Cloud._made(self._core, lib.ewa_cloud_select, self._h, indices.ctypes.data, len(indices))

    def filter(self, *conditions: str) -> Cloud:
        """Return a cloud of the points that fulfil conditions such as ``"classification=2,6"`` or ``"z<=12.5"``.

        Raises
        ------
        ArgumentError
        """
        terms = b.ewa_filter()
        for text in conditions:
            problem = ctypes.create_string_buffer(b.EWA_OPTION_TEXT_BYTES)
            if lib.ewa_filter_add(ctypes.byref(terms), str(text).encode(), problem):
                raise ArgumentError(f"filter: {problem.value.decode('utf-8', 'replace')}")
        marks = np.ones(len(self), np.uint8)
        self._core.call(lib.ewa_filter_mark, ctypes.byref(terms), self._h, marks.ctypes.data)
        return self._kept(marks)

    def _kept(self, marks: Array) -> Cloud:
        return Cloud._made(self._core, lib.ewa_cloud_keep, self._h, marks.ctypes.data)

    def crop(self, low: Sequence[float], high: Sequence[float]) -> Cloud:
        """Return a cloud of the points within a box, world units, both sides included.

        Raises
        ------
        ArgumentError
        """
        marks = np.ones(len(self), np.uint8)
        corners = (ctypes.c_double * 6)(*numbers(low, 3, "low"), *numbers(high, 3, "high"))
        self._core.call(lib.ewa_box_mark, corners, self._h, marks.ctypes.data)
        return self._kept(marks)

    def crop_sphere(self, center: Sequence[float], radius: float) -> Cloud:
        """Return a cloud of the points within a sphere, world units, its surface included.

        Raises
        ------
        ArgumentError
        """
        marks = np.ones(len(self), np.uint8)
        middle = (ctypes.c_double * 3)(*numbers(center, 3, "center"))
        self._core.call(lib.ewa_sphere_mark, middle, numbers([radius], 1, "radius")[0], self._h, marks.ctypes.data)
        return self._kept(marks)

    def thin(self, *, voxel: float | None = None, distance: float | None = None) -> Cloud:
        """Return a cloud of fewer points: one per voxel of a size, or points at least a distance apart, world units.

        Raises
        ------
        ArgumentError, OutOfMemory
        """
        marks = np.ones(len(self), np.uint8)
        if voxel is not None:
            self._core.call(lib.ewa_cloud_thin_voxels, self._h, numbers([voxel], 1, "voxel")[0], marks.ctypes.data)
        if distance is not None:
            self._core.call(lib.ewa_cloud_thin_distance, self._h, numbers([distance], 1, "distance")[0],
                            marks.ctypes.data)
        return self._kept(marks)

    def without_outliers(self, outlier_factor: float = 3, neighbour_count: int | None = None) -> Cloud:
        """Return a cloud without points that are far from all others, as :meth:`estimate` leaves them out.

        Parameters
        ----------
        outlier_factor : float, above 0
            Standard deviations over the mean of all that the mean distance to its neighbours may be.
        neighbour_count : int, 6 to 64, optional
            Of these neighbours. Default: 16.

        Raises
        ------
        ArgumentError, OutOfMemory
        """
        made = initialised(b.ewa_estimate_options, lib.ewa_estimate_options_init)
        fill(made, "ewa_estimate_options", {"outlier_factor": outlier_factor, "neighbour_count": neighbour_count})
        marks = np.ones(len(self), np.uint8)
        self._core.call(lib.ewa_cloud_mark_outliers, self._h, ctypes.byref(made), marks.ctypes.data)
        return self._kept(marks)

    def color_by(self, word: str, colormap: Any = None, range: Sequence[float] | None = None) -> Cloud:
        """Return the cloud in colours that stand for one number of each point.

        Parameters
        ----------
        word : str
            As of :meth:`scalar`.
        colormap : str, matplotlib.colors.Colormap, or array_like of shape (n, 3), optional
            "viridis", "turbo", "gray", "plasma", "inferno", "magma", "cividis", "coolwarm", or "classes" for the
            colours of LAS; another one of matplotlib, by its name or itself; or sRGB colours from the first to the last, in
            [0, 1] or as text ("#ff8800"). Default: "classes" for whole numbers named classification, else "viridis".
        range : (float, float), optional
            Numbers of the first and the last colour. Default: smallest to largest; of intensities without the outermost
            two per cent.

        Raises
        ------
        ArgumentError
        """
        own = None if colormap is None else colors_of_map(colormap)
        if own is not None:
            colormap = "gray"
        if colormap == "classes" and range is not None:
            raise ArgumentError("range: colours of classes have none")
        coloring = initialised(b.ewa_coloring, lib.ewa_coloring_init)
        fill(coloring, "ewa_coloring", {"map": colormap or "auto"})
        if range is not None:
            fill(coloring, "ewa_coloring", {"ranged": True, "range": range})
        coloring.attribute = text_bytes(word, b.EWA_SCALAR_NAME_BYTES, "word")
        cloud = self._derive()
        ends = [0.0, 0.0]

        def run(address: int) -> int:
            legend = b.ewa_legend()
            status: int = lib.ewa_clouds_color((ctypes.c_void_p * 1)(address), 1, ctypes.byref(coloring),
                                               ctypes.byref(legend))
            ends[:] = legend.range
            lib.ewa_legend_free(ctypes.byref(legend))
            return status

        self._core.call(run, cloud._h)
        if own is not None:  # points without a number keep the library's colour
            scalar = self.scalar(word)
            codes = color_codes(scalar, own, *ends)
            cloud["color"] = np.where(np.isfinite(scalar)[:, None], codes, cloud["color"][:, :3])
        return cloud

    @keywords("ewa_feature_options")
    def features(self, **options: Unpack[FeatureOptions]) -> Cloud:
        """Return the surfels cut by clip lines at the sharp edges and corners that are found; lacking normals and
        radii are estimated first.

        Parameters
        ----------
        **options

        Raises
        ------
        ArgumentError, OutOfMemory
        """
        made = initialised(b.ewa_feature_options, lib.ewa_feature_options_init)
        fill(made, "ewa_feature_options", options)
        cloud = self.estimate(cutoff=made.cutoff)._derive()
        self._core.call(lib.ewa_cloud_detect_features, cloud._h, ctypes.byref(made), None)
        return cloud

    @keywords("ewa_procedure_options")
    def procedure(self, procedure: str, **options: Unpack[ProcedureOptions]) -> Cloud:
        """Return the cloud coloured by a solid texture: "checker", "marble", "wood" or "noise".

        Parameters
        ----------
        **options
            ``colors``: Default: as suits the procedure.

        Raises
        ------
        ArgumentError
        """
        made = b.ewa_procedure_options()
        made.struct_size = ctypes.sizeof(made)
        fill(made, "ewa_procedure_options", {"procedure": procedure}, own=True)
        lib.ewa_procedure_options_init(ctypes.byref(made), made.procedure, ctypes.sizeof(made))
        fill(made, "ewa_procedure_options", options)
        cloud = self._derive()
        self._core.call(lib.ewa_cloud_color_by_procedure, cloud._h, ctypes.byref(made))
        return cloud

    @keywords("ewa_refit_options")
    def refit_colors(self, **options: Unpack[RefitOptions]) -> Cloud:
        """Return the cloud with coefficients in place of colours, for sharper pictures of the same surfels.

        Parameters
        ----------
        **options

        Raises
        ------
        ArgumentError, OutOfMemory
        """
        made = initialised(b.ewa_refit_options, lib.ewa_refit_options_init)
        fill(made, "ewa_refit_options", options)
        cloud = self._derive()
        self._core.call(lib.ewa_cloud_refit_colors, cloud._h, ctypes.byref(made), None)
        return cloud

    @keywords("ewa_photos_options")
    def color_from_photos(self, cameras: PathLike | Sequence[tuple[Camera, Any]], images: PathLike | None = None,
                          masks: PathLike | None = None, **options: Unpack[PhotosOptions]) -> tuple[Cloud, PhotosReport]:
        """Return the cloud in the colours that photographs show, and what they came to; lacking normals and radii are
        estimated first.

        Parameters
        ----------
        cameras : path or sequence of (Camera, array_like of shape (height, width, 3 or 4))
            The folder of a COLMAP model, cameras.xml, transforms.json, cameras.json; or cameras with what they took: uint8: sRGB,
            float32: linear light, premultiplied; pixels that are not opaque are not looked at.
        images : path, optional
            The folder of the photographs. Default: where the file says.
        masks : path, optional
            A folder of masks, white where photographs count: of NAME.jpg NAME.jpg.png or NAME.png.
        **options

        Raises
        ------
        ArgumentError, FileError, FormatError, OutOfMemory
        """
        cloud = self.estimate()._derive()
        return cloud, color_from_photos(cloud._h, cameras, images, masks, options)

    @keywords("ewa_cloud_save_options")
    def save(self, path: PathLike, **options: Unpack[CloudSaveOptions]) -> None:
        """Write the cloud; the suffix chooses the format: .ply .las .laz .pcd .xyz .txt .asc .pts .csv.

        Parameters
        ----------
        **options

        Raises
        ------
        ArgumentError, FileError, FormatError
        """
        made = initialised(b.ewa_cloud_save_options, lib.ewa_cloud_save_options_init)
        fill(made, "ewa_cloud_save_options", options)
        self._core.call(lib.ewa_cloud_save, self._h, path_bytes(path), ctypes.byref(made))


def _restore(streams: Mapping[str, Array], count: int, origin: Array, grid: bytes, notes: Mapping[str, bytes],
             name: bytes | None) -> Cloud:
    """The cloud of a pickle, in the default context."""
    core = core_of(None)
    cloud = Cloud._of(borrowed(core, {key: as_points(array, key, None, False) for key, array in streams.items()}, count))
    core.value(lib.ewa_cloud_set_origin, cloud._h, numbers(origin, 3, "origin"))
    core.value(lib.ewa_cloud_set_grid, cloud._h, ctypes.byref(b.ewa_coordinate_grid.from_buffer_copy(grid)))
    for key, text in notes.items():
        core.call(lib.ewa_cloud_set_note, cloud._h, key.encode(), text, len(text))
    cloud._name = name
    return cloud


def _copied(pointer: Any) -> b.ewa_attribute | None:
    return b.ewa_attribute.from_buffer_copy(pointer.contents) if pointer else None


def _borrow(handle: Handle, streams: Mapping[str, Array]) -> None:
    for name, array in streams.items():
        width = array.shape[1] if array.ndim == 2 else 1
        stride = array.strides[0] if len(array) > 1 else 0
        handle.core.call(lib.ewa_cloud_borrow, handle, name.encode(), TYPE_OF[array.dtype], width, array.ctypes.data,
                         stride)


def borrowed(core: Core, streams: Mapping[str, Array], count: int) -> Handle:
    for name, array in streams.items():
        if len(array) != count:
            raise ArgumentError(f"{name}: {len(array)} points, not {count}")
    pins = tuple(Pin(array, name) for name, array in streams.items())
    handle = Cloud._made(core, lib.ewa_cloud_create, core.address, count, keep=pins)._h
    _borrow(handle, streams)
    return handle


def merge_clouds(parts: Sequence[Cloud]) -> Cloud:
    """One cloud of several of one context, of which there is one."""
    core = parts[0]._core
    count = len(parts)

    def run(*given: Any) -> int:
        status: int = lib.ewa_cloud_merge((ctypes.c_void_p * count)(*given[:-1]), count, given[-1])
        return status

    return Cloud._made(core, run, *[cloud._h for cloud in parts])


@keywords("ewa_generate_options")
def generate(object: str = "plane", point_count: int = 100000, *, context: Context | None = None,
             **options: Unpack[GenerateOptions]) -> Cloud:
    """Make a test object: "plane", "checker", "cube", "sphere", "torus", "terrain", "csg" or "town".

    Parameters
    ----------
    object : str
    point_count : int
    **options

    Raises
    ------
    ArgumentError, OutOfMemory
    """
    made = initialised(b.ewa_generate_options, lib.ewa_generate_options_init)
    fill(made, "ewa_generate_options", {"object": object, "point_count": point_count, **options}, own=True)
    core = core_of(context)
    return Cloud._made(core, lib.ewa_cloud_generate, core.address, ctypes.byref(made))
