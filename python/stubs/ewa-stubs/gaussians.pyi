# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/gaussians.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
from typing import TYPE_CHECKING, Any, Iterable, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import Array, as_contiguous, export
from ._context import Context, Core, Handle, Pin, core_of
from ._errors import ArgumentError
from ._held import Held
from ._library import functions as lib
from ._scene import World
from ._struct import Source, fill, initialised, loader, numbers, path_bytes
from .camera import Camera, PathLike
from .cloud import Cloud
from .image import Color, Image
from .rendering import draw
from .shade import Light
from .volume import Voxels
from typing_extensions import Unpack
from ._options import GaussianOptions, GaussiansSaveOptions
_UPS: Any
class Gaussians(Held):
    def __init__(self, centers: Any, scales: Any, rotations: Any, opacities: Any, harmonics: Any, *, origin: Any=None, antialiased: bool=False, context: Context | None=None) -> None: ...
    def __len__(self) -> int: ...
    @property
    def sh_degree(self) -> int: ...
    @property
    def flat(self) -> bool: ...
    @property
    def antialiased(self) -> bool: ...
    @property
    def origin(self) -> Array: ...
    @property
    def centers(self) -> Array: ...
    @property
    def scales(self) -> Array: ...
    @property
    def rotations(self) -> Array: ...
    @property
    def opacities(self) -> Array: ...
    @property
    def harmonics(self) -> Array: ...
    def save(self, path: PathLike, *,
            sh_degree: int | None = None,  # highest degree of the spherical harmonics that are kept; .splat: 0; [0, 4]; default 4
            up_world: Sequence[float] | None = None,  # what is up in the set, which is turned to what is up in files; zeros: -y, as in 3DGS; (-inf, inf); default 0
            spz_version: int | None = None,  # of .spz: 2 and 3 are gzip, 3 has finer quaternions, 4 is zstd; [2, 4]; default 3
            ) -> None: ...
    def to_cloud(self) -> Cloud: ...
    def __reduce__(self) -> Any: ...
    def __repr__(self) -> str: ...
def read_gaussians(path: Source, *, context: Context | None=None) -> Gaussians: ...
class Splats:
    def __init__(self, gaussians: Gaussians) -> None: ...
    def __len__(self) -> int: ...
    @property
    def resident_bytes(self) -> int: ...
    @property
    def core(self) -> Array: ...
    def outline(self) -> Cloud: ...
def render_gaussians(gaussians: Gaussians | Splats | Sequence[Gaussians | Splats], camera: Camera | None=None, *, volumes: Voxels | Sequence[Voxels]=(), size: Sequence[int] | None=None, planes: str | Iterable[str]=('rgba8',), background: Color='white', lights: Sequence[Light] | None=None, surfaces: Image | None=None, section_box: Any=None, section_planes: Sequence[Sequence[float]] | None=None, out: Image | None=None,
        projection: Literal["trained", "exact"] | None = None,  # how a Gaussian gets onto the screen: by the affine map at its centre, as in training, or by what each pixel's ray meets of it; default trained
        order: Literal["auto", "centre", "ray"] | None = None,  # what is in front of what: by the depth of the centres, as in training, or in each pixel by the depth at which its ray passes the greatest density; auto: centre of trained, ray of exact; default auto
        filter: Literal["file", "thicken", "keep"] | None = None,  # what the pixel filter does to small Gaussians: what the file was trained with, of 2DGS a dot at least, nothing but thicken them, or lower them so that they add as much as before; default file
        prefilter_px2: float | None = None,  # variance of the pixel filter; [0, 16] px^2; default 0.3
        cutoff: float | None = None,  # standard deviations at which every Gaussian ends; [1, 6]; default 4
        minimum_alpha: float | None = None,  # less of a Gaussian is not drawn; [1e-6, 0.5]; default 0.00392156862745098
        minimum_transmittance: float | None = None,  # a pixel where less of what is behind would show gets nothing more; [0, 0.999999]; default 0.001953125
        near_world: float | None = None,  # trained: Gaussians whose centres are nearer to the eye along its axis are not drawn; [0, 1e15] world; default 0.2
        sh_degree: int | None = None,  # spherical harmonics beyond that degree are not used; [0, 4]; default 4
        ) -> Image: ...
