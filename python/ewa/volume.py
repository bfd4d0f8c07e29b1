# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Volumes: numbers on a grid, transfer functions, and pictures of them."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterable, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import DTYPE_OF, TYPE_OF, Array, as_numbers, export
from ._context import Context, Core, Handle, Pin, core_of
from ._errors import ArgumentError, ClosedError
from ._held import Held
from ._keywords import keywords
from ._library import functions as lib
from ._scene import World, drawables_of, is_path
from ._struct import Source, fill, initialised, loader, numbers, path_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .rendering import draw
from .shade import Light

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import VolumeGenerateOptions, VolumeOptions

_T = b.ewa_type
_VOXELS = tuple(DTYPE_OF[kind] for kind in (_T.EWA_U8, _T.EWA_I8, _T.EWA_U16, _T.EWA_I16, _T.EWA_F32))


class Volume(Held):
    """Numbers on a regular grid.

    Parameters
    ----------
    voxels : array_like, shape (nz, ny, nx)
        uint8, int8, uint16, int16 or float32; borrowed where it is C-contiguous. Other floats are rounded to float32,
        other whole numbers taken where that changes none. NaN is no matter at all.
    spacing : float or array_like of shape (3,), optional
        Distances of voxels along x, y, z, world units. Default 1.
    index_to_world : array_like, shape (3, 4), optional
        Acts on columns (i, j, k, 1), whole numbers at the voxels' centres. Default: by `spacing`, the middle at the
        origin.

    Raises
    ------
    ArgumentError
    """

    _what = "the volume"

    def _asset_members(self) -> dict[str, Any]:
        return {"volume": self}

    def __init__(self, voxels: Any, *, spacing: float | Sequence[float] = 1.0, index_to_world: Any = None,
                 context: Context | None = None) -> None:
        core = core_of(context)
        array = as_numbers(voxels, "voxels")
        if array.ndim != 3 or 0 in array.shape or max(array.shape) >= 2**32:
            raise ArgumentError(f"voxels: shape {array.shape}; (nz, ny, nx) is needed")
        if array.dtype not in _VOXELS and (array.dtype.kind == "f" or np.array_equal(array, array.astype(np.float32))):
            array = array.astype(np.float32)
        if array.dtype not in _VOXELS:
            raise ArgumentError(f"voxels: numbers of type {array.dtype}; {', '.join(map(str, _VOXELS))} are")
        array = np.require(array, None, ["C", "A"])
        dims = array.shape[::-1]
        if index_to_world is not None:
            matrix = list(numbers(index_to_world, 12, "index_to_world"))
        else:
            steps = list(numbers([spacing] * 3 if np.ndim(spacing) == 0 else spacing, 3, "spacing"))
            if not all(step > 0 for step in steps):
                raise ArgumentError(f"spacing: {steps} are not all above 0")
            matrix = [0.0] * 12
            for c in range(3):
                matrix[5 * c], matrix[4 * c + 3] = steps[c], -0.5 * steps[c] * (dims[c] - 1)
        self._struct = b.ewa_volume(context=core.address, dims=dims, type=TYPE_OF[array.dtype],
                                    voxels=array.ctypes.data, index_to_world=tuple(matrix))
        self._handle = Handle(core, None, lib.ewa_volume_free, "the volume", (Pin(array, "voxels"),))

    @staticmethod
    def _made(core: Core, function: Any, *arguments: Any) -> Volume:
        volume = Volume.__new__(Volume)
        struct = b.ewa_volume()
        volume._fill(core, struct, "voxels", function, lib.ewa_volume_free, *arguments, ctypes.byref(struct))
        return volume

    @property
    def voxels(self) -> Array:
        """The numbers; shape (nz, ny, nx), read-only."""
        return export(self._h, self._struct.voxels, tuple(self._struct.dims)[::-1], DTYPE_OF[self._struct.type])

    @property
    def index_to_world(self) -> Array:
        """float64, shape (3, 4)."""
        return np.array(self._struct.index_to_world).reshape(3, 4)

    def _facts(self) -> b.ewa_volume_facts:
        facts = b.ewa_volume_facts()
        self._call(lib.ewa_volume_measure, ctypes.byref(facts))
        return facts

    @property
    def range(self) -> tuple[float, float]:
        """Least and largest finite number."""
        facts = self._facts()
        return facts.low, facts.high

    def save(self, path: PathLike, *, plain: bool = False) -> None:
        """Write the volume as NRRD (.nrrd); `plain`: not compressed.

        Raises
        ------
        FileError, FormatError
        """
        made = initialised(b.ewa_volume_save_options, lib.ewa_volume_save_options_init)
        fill(made, "ewa_volume_save_options", {"plain": plain})
        self._call(lib.ewa_volume_save, path_bytes(path), ctypes.byref(made))

    def __reduce__(self) -> Any:
        return _restore, (self.voxels, self.index_to_world, bool(self._struct.anatomical))

    def __repr__(self) -> str:
        if self._handle is None:
            return "<ewa.Volume, closed>"
        nx, ny, nz = self._struct.dims
        return f"<ewa.Volume {nx}x{ny}x{nz}, {DTYPE_OF[self._struct.type]}>"


def _restore(voxels: Array, index_to_world: Array, anatomical: bool) -> Volume:
    """The volume of a pickle, in the default context."""
    volume = Volume(voxels, index_to_world=index_to_world)
    volume._struct.anatomical = anatomical
    return volume


def read_volume(path: Source, *, dims: Sequence[int] | None = None, dtype: Any = None, big_endian: bool = False,
                header_bytes: int = 0, spacing: Sequence[float] | None = None,
                context: Context | None = None) -> Volume:
    """Read NRRD, NIfTI, Analyze, MetaImage, VTK, or raw numbers.

    Parameters
    ----------
    path : path, or the bytes of a file, or a file that is open for bytes
    dims : (nx, ny, nz), optional
        The file is raw numbers, x fastest.
    dtype : optional
        Type of raw numbers, as numpy names it. Default: by the file's name, else uint8.
    big_endian, header_bytes
        Of raw numbers.
    spacing : (x, y, z), optional
        Distances of voxels, world units. Default: as the file says, else 1.

    Raises
    ------
    FileError, FormatError, OutOfMemory
    """
    made = initialised(b.ewa_volume_load_options, lib.ewa_volume_load_options_init)
    given: dict[str, Any] = {"big_endian": big_endian, "header_bytes": header_bytes}
    if dims is not None:
        given["dims"] = dims
    if spacing is not None:
        given["spacing_world"] = spacing
    fill(made, "ewa_volume_load_options", given)
    if dtype is not None:
        kind = TYPE_OF.get(np.dtype(dtype))
        if kind is None:
            raise ArgumentError(f"dtype: {np.dtype(dtype)} is no type of voxels")
        made.type = kind
    core = core_of(context)
    load, source = loader(lib.ewa_volume_load, lib.ewa_volume_load_memory, path)
    return Volume._made(core, load, core.address, *source, ctypes.byref(made))


def as_volume(value: Any, *, context: Context | None = None) -> Volume:
    """Return the volume that something is: a path, an array of (nz, ny, nx) numbers, an image of PyVista.

    Raises
    ------
    TypeError, ArgumentError, FormatError
    """
    if is_path(value):
        return read_volume(value, context=context)
    found = drawables_of(value, core_of(context))
    if len(found) != 1 or not isinstance(found[0], Volume):
        raise TypeError(f"no volume is made of {type(value).__module__}.{type(value).__name__}")
    return found[0]


@keywords("ewa_volume_generate_options")
def generate_volume(object: str = "checkerbox", *, context: Context | None = None,
                    **options: Unpack[VolumeGenerateOptions]) -> Volume:
    """Make a test volume: "checkerbox", "blob", "ball" or "vessels".

    Parameters
    ----------
    **options

    Raises
    ------
    ArgumentError, OutOfMemory
    """
    made = initialised(b.ewa_volume_generate_options, lib.ewa_volume_generate_options_init)
    fill(made, "ewa_volume_generate_options", {"object": object, **options}, own=True)
    core = core_of(context)
    return Volume._made(core, lib.ewa_volume_generate, core.address, ctypes.byref(made))


class Transfer:
    """What values of a volume look like.

    Parameters
    ----------
    points : sequence of (value, (r, g, b), extinction)
        In ascending order of their values; linear colours; optical depth per unit length.
    unit_length : float, optional
        World units; 0 (default): the volume's smallest spacing.
    gradient : (float, float), optional
        Lengths of gradients, value per world unit, between which the extinction grows from none to all.

    Raises
    ------
    ArgumentError
    """

    def __init__(self, points: Sequence[Any], *, unit_length: float = 0.0,
                 gradient: Sequence[float] = (0.0, 0.0)) -> None:
        self._struct = b.ewa_transfer()
        if not 2 <= len(points) <= b.EWA_MAX_TRANSFER_POINTS:
            raise ArgumentError(f"points: {len(points)} of them; [2, {b.EWA_MAX_TRANSFER_POINTS}]")
        for i, point in enumerate(points):
            value, r, g, blue, extinction = numbers(point, 5, f"points[{i}]")
            self._struct.points[i] = b.ewa_transfer_point(value, (r, g, blue), extinction)
        self._struct.point_count = len(points)
        self._struct.unit_length_world = numbers([unit_length], 1, "unit_length")[0]
        self._struct.gradient_low, self._struct.gradient_high = numbers(gradient, 2, "gradient")

    @staticmethod
    def _of(struct: b.ewa_transfer) -> Transfer:
        transfer = Transfer.__new__(Transfer)
        transfer._struct = struct
        return transfer

    @staticmethod
    def presets() -> dict[str, str]:
        """Return the names of the presets, and a few words about each."""
        found: dict[str, str] = {}
        what = ctypes.c_char_p()
        while True:
            name = lib.ewa_transfer_preset_name(len(found), ctypes.byref(what))
            if name is None:
                return found
            found[name.decode()] = (what.value or b"").decode()

    @staticmethod
    def of(volume: Volume, name: str | PathLike = "auto") -> Transfer:
        """Return a preset for a volume, "auto" by its histogram, or that of a JSON file.

        Raises
        ------
        ArgumentError, NumericError, FileError, FormatError
        """
        struct, core, word = b.ewa_transfer(), volume._h.core, path_bytes(name, "transfer")

        def choose(pointer: Any, made: Any) -> int:
            status: int = lib.ewa_transfer_choose(core.address, word, pointer, made)
            return status

        volume._call(choose, ctypes.byref(struct))
        return Transfer._of(struct)

    def __reduce__(self) -> Any:
        return _restore_transfer, (bytes(self._struct),)

    @property
    def points(self) -> list[tuple[float, tuple[float, float, float], float]]:
        """(value, (r, g, b), extinction) of each point."""
        return [(p.value, (p.color[0], p.color[1], p.color[2]), p.extinction)
                for p in self._struct.points[:self._struct.point_count]]

    def save(self, path: PathLike) -> None:
        """Write a JSON file, for ``--transfer`` of the program and :meth:`of`.

        Raises
        ------
        FileError
        """
        core = core_of(None)
        core.call(lib.ewa_transfer_save, core.address, ctypes.byref(self._struct), path_bytes(path))


def _restore_transfer(data: bytes) -> Transfer:
    if len(data) != ctypes.sizeof(b.ewa_transfer):
        raise ArgumentError("no transfer function")
    return Transfer._of(b.ewa_transfer.from_buffer_copy(data))


class Voxels:
    """The resident form of a volume under a transfer function, which is what is drawn.

    Parameters
    ----------
    volume : Volume, or whatever :func:`as_volume` takes
    transfer : Transfer or str, optional
        Or a preset, "auto" (default), a JSON file.
    level_count : int, optional
        Levels of detail, 1 to 4. Default 2.

    Raises
    ------
    ArgumentError, OutOfMemory
    """

    _asset: Handle | None = None

    def __init__(self, volume: Any, transfer: Transfer | str = "auto", *, level_count: int = 2) -> None:
        if not isinstance(volume, Volume):
            volume = as_volume(volume)
        core: Core = volume._h.core
        self._flat = transfer in ("fog", "gray") if isinstance(transfer, str) else False
        self._transfer = transfer if isinstance(transfer, Transfer) else Transfer.of(volume, transfer)
        made = initialised(b.ewa_voxels_options, lib.ewa_voxels_options_init)
        fill(made, "ewa_voxels_options", {"level_count": level_count})
        self._handle = core.make(volume._bound(lib.ewa_voxels_create), ctypes.byref(self._transfer._struct),
                                           ctypes.byref(made), destroy=lib.ewa_voxels_destroy, what="the voxels")
        self._volume: Volume = volume

    @property
    def _core(self) -> Core:
        return self._handle.core

    @property
    def occupied_count(self) -> int:
        """Voxels with an extinction."""
        info = b.ewa_voxels_info()
        self._core.value(lib.ewa_voxels_describe, self._handle, ctypes.byref(info))
        return info.occupied_count

    def _asset_members(self) -> dict[str, Any]:
        return {"voxels": self._handle, "outline": self.outline()._h, "volume": self._volume, "flat": self._flat,
                "up_world": (0.0, 0.0, 1.0)}

    def outline(self, reach_steps: float = 1.8) -> Cloud:
        """Return points that a camera has to have in its picture, `reach_steps` steps of the grid around."""
        return Cloud._made(self._core, self._volume._bound(lib.ewa_volume_outline),
                           ctypes.byref(self._transfer._struct), float(reach_steps))


@keywords("ewa_volume_options")
def render_volume(volume: Any, camera: Camera | None = None, *, transfer: Transfer | str = "auto",
                  size: Sequence[int] | None = None, planes: str | Iterable[str] = ("rgba8",),
                  background: Color = "black", lights: Sequence[Light] | None = None,
                  surfaces: Image | None = None, section_box: Any = None,
                  section_planes: Sequence[Sequence[float]] | None = None, out: Image | None = None,
                  **options: Unpack[VolumeOptions]) -> Image:
    """Draw a volume.

    Parameters
    ----------
    volume : Voxels, Volume, or whatever :func:`as_volume` takes
    camera : Camera, optional
        Default: that of ``ewa volume``, which has the whole in its picture.
    transfer : Transfer or str, optional
        Of a volume: a preset, "auto" (default), a JSON file.
    size, planes, background, out
        As of :func:`render`. Default background: black.
    lights : sequence, optional
    surfaces : Image, optional
        With the planes rgba and depth, of the same size: what stands in the volume, opaque.
    section_box, section_planes
        As of :func:`render`.
    **options
        ``shading``: Default: "auto", which is "phong", and "none" of the presets gray and fog.

    Raises
    ------
    ArgumentError, OutOfMemory, ClosedError
    """
    voxels = volume if isinstance(volume, Voxels) else Voxels(volume, transfer, level_count=1)
    world = World(voxels._core)
    world.add(voxels)
    chosen = {name: value for name, value in options.items() if (name, value) != ("shading", "auto")}
    return draw(world, camera, size=size, planes=planes, background=background, lights=lights, surfaces=surfaces,
                section_box=section_box, section_planes=section_planes, out=out, volumes=chosen)
