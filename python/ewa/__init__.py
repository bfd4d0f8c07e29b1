# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Point clouds as continuous, antialiased surfaces: numpy in, numpy out.

>>> import ewa
>>> image = ewa.render(ewa.read("scan.ply"))
>>> image.save("scan.png")

Arrays become surfels, surfels become pictures; volumes, depth images, textures and meshes take the same pipeline. All
lengths are world units, all colours linear light unless they are uint8, which are sRGB; cameras have OpenCV's axes.
"""
from __future__ import annotations

from ._arrays import Array
from ._context import Context, default_context, progress
from ._errors import (ArgumentError, Cancelled, ClosedError, Error, EwaWarning, FileError, FormatError, NumericError,
                      OutOfMemory)
from ._library import version
from .adapters import as_cloud, as_drawables
from .camera import Camera, CameraPath, cameras, save_cameras
from .cloud import Cloud, generate
from .combining import csg, merge
from .films import film, turntable
from .gaussians import Gaussians, Splats, read_gaussians, render_gaussians
from .gradients import CameraGradient, Gradients, render_backward
from .image import Image, read_depth, read_image, save_image
from .measuring import Measurement, measure
from .mesh import Mesh, convert, read, read_mesh, sample
from .octree import Octree, build_octree
from .photographs import ImageQuality, PhotoReport, PhotosReport, compare_images, undistort
from .profiles import Profile
from .rendering import Renderer, render
from .scene import Scene
from .shade import Environment
from .surfels import Surfels
from .volume import Transfer, Volume, Voxels, as_volume, generate_volume, read_volume, render_volume
from .warping import DepthImage, texture, warp

__version__ = version()

__all__ = [
    "ArgumentError", "Array", "Camera", "CameraGradient", "CameraPath", "Cancelled", "ClosedError", "Cloud",
    "Context", "DepthImage", "Environment", "Error", "EwaWarning", "FileError", "FormatError", "Gaussians",
    "Gradients", "Image", "ImageQuality", "Measurement", "Mesh", "NumericError", "Octree", "OutOfMemory",
    "PhotoReport", "PhotosReport", "Profile", "Renderer", "Scene", "Splats", "Surfels", "Transfer", "Volume",
    "Voxels", "as_cloud", "as_drawables", "as_volume", "build_octree", "cameras", "compare_images", "convert",
    "csg", "default_context", "film", "generate", "generate_volume", "measure", "merge", "progress", "read",
    "read_depth", "read_gaussians", "read_image", "read_mesh", "read_volume", "render", "render_backward",
    "render_gaussians", "render_volume", "sample", "save_cameras", "save_image", "texture", "turntable",
    "undistort", "version", "warp",
]
