# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/cloud.py and docs/options.json; a test holds it to that. Do not edit.
from typing import Any, Literal, Sequence
import ctypes
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence
import numpy as np
from . import _bindings as b
from ._arrays import DTYPE_OF, TYPE_OF, Array, as_points, export
from ._colormaps import color_codes, colors_of_map
from ._context import Context, Core, Handle, Pin, core_of
from ._errors import ArgumentError, ClosedError
from ._library import functions as lib
from ._library import library
from ._struct import fill, initialised, numbers, path_bytes, text_bytes
from .camera import Camera, PathLike
from .photographs import PhotosReport
from .photographs import color as color_from_photos
from .surfels import Surfels
from typing_extensions import Unpack
from ._options import CloudSaveOptions, EstimateOptions, FeatureOptions, GenerateOptions, PhotosOptions, ProcedureOptions, RefitOptions, SurfelsOptions
_note = library['ewa_cloud_note']
_ALIASES: Any
class Cloud:
    def __init__(self, positions: Any, *, normals: Any=None, colors: Any=None, radius: Any=None, origin: Sequence[float] | None=None, copy: bool | None=None, context: Context | None=None, **attributes: Any) -> None: ...
    def __len__(self) -> int: ...
    def keys(self) -> list[str]: ...
    def __iter__(self) -> Iterator[str]: ...
    def __contains__(self, name: object) -> bool: ...
    def __getitem__(self, name: str) -> Array: ...
    def borrows(self, name: str) -> bool: ...
    def __setitem__(self, name: str, value: Any) -> None: ...
    def __delitem__(self, name: str) -> None: ...
    @property
    def origin(self) -> Array: ...
    @property
    def bounds(self) -> Array: ...
    @property
    def notes(self) -> dict[str, bytes]: ...
    def scalar(self, word: str) -> Array: ...
    def __reduce__(self) -> Any: ...
    def close(self) -> None: ...
    def __repr__(self) -> str: ...
    def estimate(self, *,
            neighbour_count: int | None = None,  # nearest neighbours that a point is judged by; [6, 64]; default 16
            orientation: Literal["propagate", "viewpoint", "none", "auto"] | None = None,  # side that normals point to: consistent along the surface and outward, towards the viewpoint, as they come; auto: to the scanners that the cloud knows, else up where points have return numbers, else consistent; default auto
            viewpoint_world: Sequence[float] | None = None,  # place that normals point to, such as the scanner's; (-inf, inf); default 0
            shape: Literal["disc", "ellipse"] | None = None,  # disc: a radius from the local density; ellipse: two axes from the local anisotropy of the sampling; default disc
            radius_scale: float | None = None,  # support radius in units of the local spacing; (0, inf); default 1.14
            radius_limit: float | None = None,  # largest radius that closes a gap, in median spacings of the places around; [1, inf); default 2.75
            cutoff: float | None = None,  # standard deviations at which kernels end: axes are the support radius over this; (0, 4]; default 3
            keep_normals: bool | None = None,  # keep the normals that the file has; default True
            keep_radii: bool | None = None,  # keep the radii or axes that the file has; default True
            outlier_factor: float | None = None,  # remove points whose mean distance to their neighbours is over the mean plus so many standard deviations of all; 0: keep all; [0, inf); default 0
            ) -> Cloud: ...
    def surfels(self, *, close_gaps: bool=True,
            cutoff: float | None = None,  # standard deviations at which a kernel ends; (0, 4]; default 3
            radius_scale: float | None = None,  # multiplies every radius and axis; (0, 1e15]; default 1
            level_count: int | None = None,  # levels of detail, each of a quarter of the surfels of the one before; 1: all surfels only; [1, 8]; default 1
            ) -> Surfels: ...
    def transform(self, matrix: Any) -> Cloud: ...
    def select(self, points: Any) -> Cloud: ...
    def filter(self, *conditions: str) -> Cloud: ...
    def crop(self, low: Sequence[float], high: Sequence[float]) -> Cloud: ...
    def thin(self, *, voxel: float | None=None, distance: float | None=None) -> Cloud: ...
    def without_outliers(self, outlier_factor: float=3, neighbour_count: int | None=None) -> Cloud: ...
    def color_by(self, word: str, colormap: Any=None, range: Sequence[float] | None=None) -> Cloud: ...
    def features(self, *,
            neighbour_count: int | None = None,  # nearest neighbours that planes are fitted to; 0: 24 for exact points up to 64 for noisy ones; 0 or [16, 64]; default 0
            angle_deg: float | None = None,  # smallest angle between the normals of two planes that meet in an edge; less is a smooth surface; [10, 120] deg; default 30
            noise: float | None = None,  # standard deviation of the points from the surface in units of the spacing; negative: measured; (-inf, 1]; default -1
            cutoff: float | None = None,  # standard deviations at which kernels end: axes are the support radius over this; (0, 4]; default 3
            project: bool | None = None,  # move the points beside an edge onto their plane; default True
            ) -> Cloud: ...
    def procedure(self, procedure: str, *,
            frequency: float | None = None,  # features per world unit: cubes, veins, rings, waves; (0, 1000000000]; default 8
            prefilter: float | None = None,  # width of the filter in units of the surfel's kernel; 0: none, which aliases; [0, 10]; default 1
            cutoff: float | None = None,  # standard deviations at which kernels end; (0, 4]; default 3
            seed: int | None = None,  # same seed, same noise; [0, inf); default 1
            colors: Sequence[float] | None = None,  # two linear colours, whose defaults go with the procedure; [0, 1]; default 0
            ) -> Cloud: ...
    def refit_colors(self, *,
            goal: Literal["interpolate", "fit"] | None = None,  # the picture has each point's colour at the point, or nearly, for noisy or aliased colours; default interpolate
            cutoff: float | None = None,  # standard deviations at which kernels will end where the cloud is drawn; (0, 4]; default 3
            ) -> Cloud: ...
    def color_from_photos(self, cameras: PathLike | Sequence[tuple[Camera, Any]], images: PathLike | None=None, masks: PathLike | None=None, *,
            method: Literal["fit", "median", "mean", "best"] | None = None,  # colours whose pictures differ least from the photographs; or, of what these show at a point, the weighted median, the weighted mean, or that of the one that sees it largest; default fit
            exposure: Literal["gain", "gain-offset", "off"] | None = None,  # what photographs are corrected by, channel by channel: gain, gain and offset, or nothing; default gain
            hold_out: int | None = None,  # photographs 0, N, 2N, ... are not used and compared with the result; 0: all are used; [0, 65535]; default 0
            rounds: int | None = None,  # rounds of the fit, each with new weights of pixels and exposures; [1, 20]; default 3
            robust: float | None = None,  # difference of sRGB numbers in [0, 1] at which a pixel counts a quarter; 0: all count; [0, 1]; default 0.05
            ridge: float | None = None,  # pull of the fit towards the median, of the median point's own weight; (0, 10]; default 0.1
            spacing_px: float | None = None,  # photographs are halved while points stay so many pixels apart; 0: never; [0, 100]; default 2
            cutoff: float | None = None,  # standard deviations at which kernels end; (0, 4]; default 3
            ) -> tuple[Cloud, PhotosReport]: ...
    def save(self, path: PathLike, *,
            ply_encoding: Literal["little-endian", "big-endian", "ascii"] | None = None,  # how PLY files hold numbers; default little-endian
            step_world: float | None = None,  # step of the coordinates of LAS, world units; 0: that of the cloud, else by the size of the box; [0, inf); default 0
            chunk_points: int | None = None,  # points of one chunk of LAZ; [1, 10000000]; default 50000
            ) -> None: ...
def merge_clouds(parts: Sequence[Cloud]) -> Cloud: ...
def generate(object: str='plane', point_count: int=100000, *, context: Context | None=None,
        seed: int | None = None,  # same seed, same bytes, on every machine; [0, inf); default 1
        size_world: float | None = None,  # edge of plane, cube, terrain and town, outer diameter of sphere and torus, length of csg, in world units; [1e-25, 1e25]; default 2
        jitter: float | None = None,  # 0: a regular grid, 1: anywhere in the cell; [0, 1]; default 0.5
        checks: float | None = None,  # squares along an edge of the checkerboard and of the cube's faces; [1e-6, 1000000]; default 16
        radius_scale: float | None = None,  # support radius in units of the spacing; 0: closed for the jitter; 0 or [1e-6, 1000000]; default 0
        positions_only: bool | None = None,  # leave out normals and radii; default False
        sharp: bool | None = None,  # cube and csg: rows of points on every edge, and clip lines; default False
        texcoords: bool | None = None,  # add texture coordinates; default False
        ) -> Cloud: ...
