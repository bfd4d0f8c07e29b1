# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Trained Gaussians: sets of them, and pictures of all that lets light through, in one order of depth."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterable, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array, as_contiguous, export
from ._context import Context, Core, Handle, Pin, core_of
from ._errors import ArgumentError
from ._held import Held
from ._keywords import keywords
from ._library import functions as lib
from ._scene import UPS, World
from ._struct import Source, fill, initialised, loader, numbers, path_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .rendering import draw
from .shade import Light
from .volume import Voxels

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import GaussianOptions, GaussiansSaveOptions


class Gaussians(Held):
    """A set of trained Gaussians with their colours by direction.

    Arrays of float32 that are C-contiguous are borrowed, others are converted.

    Parameters
    ----------
    centers : array_like, shape (n, 3)
        World units, from `origin` on.
    scales : array_like, shape (n, 3)
        Standard deviations, world units, >= 0: not their logarithms, which files have.
    rotations : array_like, shape (n, 4)
        Unit quaternions w, x, y, z, from the axes to the world.
    opacities : array_like, shape (n,)
        In [0, 1], not the logits of files.
    harmonics : array_like, shape (n, (L + 1)**2, 3)
        Coefficients of red, green, blue for L in [0, 4], in the order and with the signs of 3DGS.
    origin : array_like, shape (3,), optional
        float64, world units. Default 0.
    antialiased : bool, optional
        Trained with a pixel filter that keeps what a Gaussian adds (Mip-Splatting).
    classes : array_like, shape (n,), optional
        uint16, codes of the attribute ``classification``. Default: they have none.

    Raises
    ------
    ArgumentError
    """

    _what = "the Gaussians"
    _up: str = "-y"

    def _asset_members(self) -> dict[str, Any]:
        return {"gaussians": self, "up_world": UPS[self._up]}

    def __init__(self, centers: Any, scales: Any, rotations: Any, opacities: Any, harmonics: Any, *,
                 origin: Any = None, antialiased: bool = False, classes: Any = None, context: Context | None = None) -> None:
        core = core_of(context)
        given = {"centers": as_contiguous(centers, np.float32, (None, 3), "centers"),
                 "scales": as_contiguous(scales, np.float32, (None, 3), "scales"),
                 "rotations": as_contiguous(rotations, np.float32, (None, 4), "rotations"),
                 "opacities": as_contiguous(opacities, np.float32, (None,), "opacities"),
                 "harmonics": as_contiguous(harmonics, np.float32, (None, None, 3), "harmonics")}
        if classes is not None:
            given["classes"] = as_contiguous(classes, np.uint16, (None,), "classes")
        count = len(given["centers"])
        for name, array in given.items():
            if len(array) != count:
                raise ArgumentError(f"{name}: {len(array)} of them for {count} centers")
        degrees = {(degree + 1) ** 2: degree for degree in range(b.EWA_MAX_SH_DEGREE + 1)}
        if given["harmonics"].shape[1] not in degrees:
            raise ArgumentError(f"harmonics: {given['harmonics'].shape[1]} for each; "
                                f"{', '.join(map(str, degrees))} are")
        if count >= 2**32:
            raise ArgumentError(f"centers: {count} of them, at maximum {2**32 - 1}")
        self._struct = b.ewa_gaussians(
            context=core.address, count=count, sh_degree=degrees[given["harmonics"].shape[1]],
            flat=bool(count) and not given["scales"][:, 2].any(), antialiased=bool(antialiased),
            origin=tuple(numbers((0, 0, 0) if origin is None else origin, 3, "origin")),
            **{name: array.ctypes.data for name, array in given.items()})
        self._handle = Handle(core, None, lib.ewa_gaussians_free, "the Gaussians",
                              tuple(Pin(array, name) for name, array in given.items()))

    @staticmethod
    def _read(core: Core, path: Source) -> Gaussians:
        gaussians = Gaussians.__new__(Gaussians)
        struct, facts = b.ewa_gaussians(), b.ewa_gaussian_facts()
        load, source = loader(lib.ewa_gaussians_load, lib.ewa_gaussians_load_memory, path, named=True)
        gaussians._fill(core, struct, "centers", load, lib.ewa_gaussians_free, core.address, *source,
                        ctypes.byref(struct), ctypes.byref(facts))
        gaussians._set_up(facts.up_world)
        return gaussians

    @staticmethod
    def _of_scene(core: Core, handle: Any) -> Gaussians:
        gaussians = Gaussians.__new__(Gaussians)
        struct, up = b.ewa_gaussians(), (ctypes.c_double * 3)()
        gaussians._fill(core, struct, "centers", lib.ewa_scene_gaussians, lib.ewa_gaussians_free, handle, ctypes.byref(struct), up)
        gaussians._set_up(up)
        return gaussians

    def _set_up(self, up: Any) -> None:
        if abs(up[2]) > abs(up[1]):
            self._up = "z" if up[2] > 0 else "-z"
        elif up[1] > 0:
            self._up = "y"

    def __len__(self) -> int:
        return int(self._struct.count) if self._handle is not None else 0

    @property
    def sh_degree(self) -> int:
        """Degree of the harmonics."""
        return int(self._struct.sh_degree)

    @property
    def flat(self) -> bool:
        """Whether these are 2D Gaussians."""
        return bool(self._struct.flat)

    @property
    def antialiased(self) -> bool:
        """Whether they were trained with a pixel filter that keeps what a Gaussian adds."""
        return bool(self._struct.antialiased)

    @property
    def origin(self) -> Array:
        """What centres are relative to; float64, shape (3,)."""
        return np.array(self._struct.origin)

    def _stream(self, name: str, shape: tuple[int, ...]) -> Array:
        return export(self._h, getattr(self._struct, name), (len(self), *shape), np.dtype(np.float32))

    @property
    def centers(self) -> Array:
        """float32, shape (n, 3), read-only, world units from the origin on."""
        return self._stream("centers", (3,))

    @property
    def scales(self) -> Array:
        """Standard deviations; float32, shape (n, 3), read-only."""
        return self._stream("scales", (3,))

    @property
    def rotations(self) -> Array:
        """Quaternions w, x, y, z; float32, shape (n, 4), read-only."""
        return self._stream("rotations", (4,))

    @property
    def opacities(self) -> Array:
        """float32, shape (n,), read-only."""
        return self._stream("opacities", ())

    @property
    def harmonics(self) -> Array:
        """float32, shape (n, (sh_degree + 1)**2, 3), read-only."""
        return self._stream("harmonics", ((self.sh_degree + 1) ** 2, 3))

    @property
    def classes(self) -> Array | None:
        """Codes of the attribute ``classification``; uint16, shape (n,), read-only; None: they have none."""
        if not self._struct.classes:
            return None
        return export(self._h, self._struct.classes, (len(self),), np.dtype(np.uint16))

    @keywords("ewa_gaussians_save_options")
    def save(self, path: PathLike, **options: Unpack[GaussiansSaveOptions]) -> None:
        """Write .ply (as 3DGS), .compressed.ply (of PlayCanvas), .splat, .spz, .glb, .sog, meta.json with its pictures beside it, or lod-meta.json with levels.

        Parameters
        ----------
        **options
            ``up_world``: Default: as the file that was read says.

        Raises
        ------
        FileError, ArgumentError, FormatError
        """
        made = initialised(b.ewa_gaussians_save_options, lib.ewa_gaussians_save_options_init)
        fill(made, "ewa_gaussians_save_options", {"up_world": UPS[self._up], **options})
        self._call(lib.ewa_gaussians_save, path_bytes(path), ctypes.byref(made))

    def to_cloud(self) -> Cloud:
        """Return surfels: the two longest axes, the normal across them, the constant colour."""
        return Cloud._made(self._h.core, self._bound(lib.ewa_gaussians_to_cloud))

    def __reduce__(self) -> Any:
        return _restore, (self.centers, self.scales, self.rotations, self.opacities, self.harmonics, self.origin,
                          self.antialiased, self.flat, self._up, self.classes)

    def __repr__(self) -> str:
        if self._handle is None:
            return "<ewa.Gaussians, closed>"
        return f"<ewa.Gaussians, {len(self)} of degree {self.sh_degree}{', flat' if self.flat else ''}>"


def _restore(centers: Array, scales: Array, rotations: Array, opacities: Array, harmonics: Array, origin: Array,
             antialiased: bool, flat: bool, up: str, classes: Array | None) -> Gaussians:
    """The Gaussians of a pickle, in the default context."""
    made = Gaussians(centers, scales, rotations, opacities, harmonics, origin=origin, antialiased=antialiased, classes=classes)
    made._struct.flat, made._up = flat, up
    return made


def read_gaussians(path: Source, *, context: Context | None = None) -> Gaussians:
    """Read Gaussians of 3DGS, 2DGS, Mip-Splatting (PLY), compressed PLY, .splat, SPZ, glTF, .ksplat or SOG; of a path,
    or of the bytes of a file, which is read alone.

    Raises
    ------
    FileError, FormatError, OutOfMemory
    """
    return Gaussians._read(core_of(context), path)


class Splats:
    """The resident form of a set of Gaussians, which is what is drawn; the set is not needed afterwards.

    Parameters
    ----------
    gaussians : Gaussians
    levels : bool
        Large sets get levels, among which `merge_px` of pictures chooses, in twice the time.

    Raises
    ------
    ArgumentError, OutOfMemory
    """

    _asset: Handle | None = None

    def __init__(self, gaussians: Gaussians, levels: bool = False) -> None:
        if not isinstance(gaussians, Gaussians):
            raise TypeError(f"gaussians: an ewa.Gaussians, not {type(gaussians).__name__}")
        self._core = gaussians._h.core
        self._handle = self._core.make(gaussians._bound(lib.ewa_splats_create), levels, destroy=lib.ewa_splats_destroy,
                                       what="the splats")
        self._info = b.ewa_splats_info()
        self._core.value(lib.ewa_splats_describe, self._handle, ctypes.byref(self._info))
        self._up = gaussians._up
        self._outline = Cloud._made(self._core, gaussians._bound(lib.ewa_gaussians_outline),
                                    ctypes.byref(self._info.core))

    def __len__(self) -> int:
        return int(self._info.splat_count)

    @property
    def resident_bytes(self) -> int:
        """Memory that they take."""
        return int(self._info.resident_bytes)

    @property
    def core(self) -> Array:
        """Box of the middle 96 % of the opacities, which far floaters do not widen; float64, shape (2, 3)."""
        return np.array([self._info.core.low_world, self._info.core.high_world])

    def outline(self) -> Cloud:
        """Return points that a camera has to have in its picture."""
        return self._outline

    def _asset_members(self) -> dict[str, Any]:
        return {"splats": self._handle, "outline": self._outline._h, "up_world": UPS[self._up]}


def _listed(what: Any, kinds: tuple[type, ...], label: str) -> list[Any]:
    found = list(what) if isinstance(what, (list, tuple)) else [what]
    for item in found:
        if not isinstance(item, kinds):
            raise TypeError(f"{label}: {' or '.join('ewa.' + kind.__name__ for kind in kinds)}, "
                            f"not {type(item).__name__}")
    return found


@keywords("ewa_gaussian_options")
def render_gaussians(gaussians: Gaussians | Splats | Sequence[Gaussians | Splats], camera: Camera | None = None, *,
                     volumes: Voxels | Sequence[Voxels] = (), size: Sequence[int] | None = None,
                     planes: str | Iterable[str] = ("rgba8",), background: Color = "white",
                     lights: Sequence[Light] | None = None, surfaces: Image | None = None, section_box: Any = None,
                     section_planes: Sequence[Sequence[float]] | None = None, out: Image | None = None,
                     **options: Unpack[GaussianOptions]) -> Image:
    """Draw Gaussians, and volumes among them, in one order of depth.

    Parameters
    ----------
    gaussians : Gaussians or Splats, or a list of these
        Splats, where they are drawn more than once. An empty list: volumes alone.
    camera : Camera, optional
        Default: that of ``ewa render``, which has all but far floaters in its picture.
    volumes : Voxels or a list of these, optional
        Lit by `lights`, but for those of the presets gray and fog.
    size, planes, background, out
        As of :func:`render`.
    surfaces : Image, optional
        With the planes rgba (over nothing: background="transparent") and depth, of the same size: what stands
        among them, opaque, with what is seen past its edges.
    section_box, section_planes
        As of :func:`render`.
    **options

    Raises
    ------
    ArgumentError, OutOfMemory, ClosedError
    """
    levels = bool(options.get("merge_px"))
    sets = [item if isinstance(item, Splats) else Splats(item, levels)
            for item in _listed(gaussians, (Gaussians, Splats), "gaussians")]
    among = _listed(volumes, (Voxels,), "volumes")
    if not sets and not among:
        raise ArgumentError("gaussians: none, and no volumes")
    world = World((sets or among)[0]._core)
    for item in [*sets, *among]:
        world.add(item)
    return draw(world, camera, size=size, planes=planes, background=background, lights=lights, surfaces=surfaces,
                section_box=section_box, section_planes=section_planes, out=out, gaussians=options)
