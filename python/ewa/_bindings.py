# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from docs/api.json; a test holds it to that. Do not edit.

"""The C interface of libewa as ctypes, under its own names; see include/ewa."""
from __future__ import annotations

import ctypes as c
from enum import IntEnum
from typing import Any, Callable


EWA_CPU_AVX2 = 1
EWA_CPU_AVX512 = 2
EWA_CPU_NEON = 4
EWA_CPU_ALL = 2147483647
EWA_FILE_PIECE_BYTES = 4194304
EWA_VERSION_MAJOR = 0
EWA_VERSION_MINOR = 1
EWA_VERSION_PATCH = 0
EWA_TEXCOORD = 'texcoord'
EWA_TEXCOORD_S = 'texcoord_s'
EWA_TEXCOORD_T = 'texcoord_t'
EWA_TEXTURE = 'texture'
EWA_TEXTURE_PART = 'texture_part'
EWA_NAME_BYTES = 64
EWA_BORDER = 'border'
EWA_CLIP0 = 'clip0'
EWA_CLIP1 = 'clip1'
EWA_CLIP_MODE = 'clip_mode'
EWA_COLOR = 'color'
EWA_CURVATURE = 'signed_curvature'
EWA_MATERIAL = 'material'
EWA_NORMAL = 'normal'
EWA_POSITION = 'position'
EWA_RADIUS = 'radius'
EWA_SURFACENESS = 'surfaceness'
EWA_TANGENT_U = 'tangent_u'
EWA_TANGENT_V = 'tangent_v'
EWA_MAX_RANKS = 1048576
EWA_ALL_RANKS = 4294967295
EWA_SCALAR_NAME_BYTES = 68
EWA_LEGEND_NUMBERS = 16
EWA_DIAGNOSIS_TEXT_BYTES = 400
EWA_UPRIGHT_TEXT_BYTES = 160
EWA_MAX_SH_DEGREE = 4
EWA_VISIBLE_POSITIVE = 1
EWA_VISIBLE_NEGATIVE = 2
EWA_VISIBLE_INVALID = 255
EWA_CLASS_NAME_BYTES = 32
EWA_POINTS_UNKNOWN = 18446744073709551615
EWA_MEASURE_PLACES = 64
EWA_MAX_MEASURES = 64
EWA_MEASURE_NAME_BYTES = 64
EWA_MESH_COLORS = 1
EWA_MESH_TEXCOORDS = 2
EWA_MESH_NORMALS = 4
EWA_MAX_MIXED_VOLUMES = 64
EWA_MODEL_MESH = 1
EWA_MODEL_POINTS = 2
EWA_MODEL_ELEMENTS = 4
EWA_OPTION_ABOVE = 1
EWA_OPTION_BELOW = 2
EWA_OPTION_OR_ZERO = 4
EWA_OPTION_TEXT_BYTES = 256
EWA_PHOTO_COUNT = 'photo_count'
EWA_PHOTO_RESIDUAL = 'photo_residual'
EWA_DEFAULT_RADIUS_LIMIT = 2.75
EWA_DEFAULT_RADIUS_SCALE = 1.14
EWA_PROFILE_CORNERS = 1024
EWA_PROFILE_HEIGHT = 'profile_height'
EWA_PROFILE_OFFSET = 'offset'
EWA_PROFILE_STATION = 'station'
EWA_MAX_REGIONS = 16
EWA_REGION_CORNERS = 64
EWA_REGION_CLASSES = 256
EWA_REGION_WORDS = 8
EWA_MAX_LEVELS = 8
EWA_MAX_EDGE_LAYERS = 8
EWA_MAX_SECTION_PLANES = 8
EWA_MAX_SUPERSAMPLING = 8
EWA_LAYERS_EXACT = 4294967295
EWA_OCTREE_WHOLE_POINTS = 4000000
EWA_OCTREE_SAMPLE_POINTS = 400000
EWA_SCENE_MAX_INSTANCES = 65536
EWA_MAX_KEYFRAMES = 64
EWA_MATERIAL_OWN = 4294967295
EWA_VIEW_FOV_DEG = 30.0
EWA_SCENE_FILE_DEPTH = 8
EWA_SCENE_FILE_COUNT = 1024
EWA_FILTER_TERMS = 16
EWA_FILTER_RANGES = 32
EWA_MAX_LIGHTS = 8
EWA_MAX_MATERIALS = 256
EWA_MAX_TRANSFER_POINTS = 1024
EWA_MAX_VOLUME_LEVELS = 4
EWA_MARKED_SPLAT_OTHER = 0.03
EWA_MARKED_SPLAT_RED = 0.8


class ewa_named_files(IntEnum):
    EWA_NAMED_BELOW = 0
    EWA_NAMED_ANYWHERE = 1
    EWA_NAMED_NONE = 2


class ewa_severity(IntEnum):
    EWA_SEVERITY_ERROR = 0
    EWA_SEVERITY_WARNING = 1
    EWA_SEVERITY_NOTE = 2
    EWA_SEVERITY_INFO = 3
    EWA_SEVERITY_DEBUG = 4


class ewa_status(IntEnum):
    EWA_OK = 0
    EWA_ERROR_ARGUMENT = -1
    EWA_ERROR_MEMORY = -2
    EWA_ERROR_IO = -3
    EWA_ERROR_FORMAT = -4
    EWA_ERROR_UNSUPPORTED = -5
    EWA_ERROR_LIMIT = -6
    EWA_ERROR_NUMERIC = -7
    EWA_CANCELLED = -8


class ewa_type(IntEnum):
    EWA_F32 = 0
    EWA_F64 = 1
    EWA_I8 = 2
    EWA_U8 = 3
    EWA_I16 = 4
    EWA_U16 = 5
    EWA_I32 = 6
    EWA_U32 = 7


class ewa_texture_fit(IntEnum):
    EWA_FIT_NORMALIZED = 0
    EWA_FIT_SUM = 1


class ewa_projection(IntEnum):
    EWA_PERSPECTIVE = 0
    EWA_ORTHOGRAPHIC = 1


class ewa_coloring_map(IntEnum):
    EWA_COLORING_AUTO = 0
    EWA_COLORING_VIRIDIS = 1
    EWA_COLORING_TURBO = 2
    EWA_COLORING_GRAY = 3
    EWA_COLORING_PLASMA = 4
    EWA_COLORING_INFERNO = 5
    EWA_COLORING_MAGMA = 6
    EWA_COLORING_CIVIDIS = 7
    EWA_COLORING_COOLWARM = 8
    EWA_COLORING_CLASSES = 9


class ewa_named_view(IntEnum):
    EWA_VIEW_FRONT = 0
    EWA_VIEW_BACK = 1
    EWA_VIEW_LEFT = 2
    EWA_VIEW_RIGHT = 3
    EWA_VIEW_TOP = 4
    EWA_VIEW_BOTTOM = 5
    EWA_VIEW_ISO = 6


class ewa_up_convention(IntEnum):
    EWA_UP_ANY = 0
    EWA_UP_Y_USUAL = 1
    EWA_UP_Z_USUAL = 2
    EWA_UP_Y_REQUIRED = 3
    EWA_UP_Z_SURVEYED = 4
    EWA_UP_CAMERA_USUAL = 5


class ewa_ink(IntEnum):
    EWA_INK_AUTO = 0
    EWA_INK_DARK = 1
    EWA_INK_LIGHT = 2


class ewa_text_anchor(IntEnum):
    EWA_TEXT_LEFT = 0
    EWA_TEXT_CENTER = 1
    EWA_TEXT_RIGHT = 2
    EWA_TEXT_LEFT_MIDDLE = 3
    EWA_TEXT_CENTER_MIDDLE = 4
    EWA_TEXT_RIGHT_MIDDLE = 5
    EWA_TEXT_LEFT_TOP = 6
    EWA_TEXT_CENTER_TOP = 7
    EWA_TEXT_RIGHT_TOP = 8


class ewa_gaussian_format(IntEnum):
    EWA_GAUSSIANS_NONE = 0
    EWA_GAUSSIANS_PLY = 1
    EWA_GAUSSIANS_PACKED_PLY = 2
    EWA_GAUSSIANS_SPLAT = 3
    EWA_GAUSSIANS_SPZ = 4
    EWA_GAUSSIANS_GLTF = 5
    EWA_GAUSSIANS_KSPLAT = 6
    EWA_GAUSSIANS_SOG = 7
    EWA_GAUSSIANS_STREAMED_SOG = 8


class ewa_gaussian_depth(IntEnum):
    EWA_DEPTH_MEDIAN = 0
    EWA_DEPTH_EXPECTED = 1


class ewa_gaussian_display(IntEnum):
    EWA_DISPLAY_BLENDED = 0
    EWA_DISPLAY_ELLIPSOIDS = 1
    EWA_DISPLAY_POINTS = 2


class ewa_gaussian_filter(IntEnum):
    EWA_FILTER_OF_SET = 0
    EWA_FILTER_THICKEN = 1
    EWA_FILTER_KEEP = 2


class ewa_gaussian_order(IntEnum):
    EWA_ORDER_OF_PROJECTION = 0
    EWA_ORDER_CENTER = 1
    EWA_ORDER_RAY = 2


class ewa_gaussian_projection(IntEnum):
    EWA_PROJECTION_TRAINED = 0
    EWA_PROJECTION_EXACT = 1


class ewa_backend_kind(IntEnum):
    EWA_BACKEND_CPU = 0
    EWA_BACKEND_GL = 1
    EWA_BACKEND_GL_RASTER = 2
    EWA_BACKEND_AUTO = 3


class ewa_gpu_class(IntEnum):
    EWA_GPU_NONE = 0
    EWA_GPU_UNUSABLE = 1
    EWA_GPU_CLOSE = 2
    EWA_GPU_EXACT = 3


class ewa_clip_plane(IntEnum):
    EWA_CLIP_LEFT = 0
    EWA_CLIP_RIGHT = 1
    EWA_CLIP_BOTTOM = 2
    EWA_CLIP_TOP = 3
    EWA_CLIP_NEAR = 4
    EWA_CLIP_FAR = 5


class ewa_colormap(IntEnum):
    EWA_COLORMAP_VIRIDIS = 0
    EWA_COLORMAP_TURBO = 1
    EWA_COLORMAP_GRAY = 2
    EWA_COLORMAP_PLASMA = 3
    EWA_COLORMAP_INFERNO = 4
    EWA_COLORMAP_MAGMA = 5
    EWA_COLORMAP_CIVIDIS = 6
    EWA_COLORMAP_COOLWARM = 7


class ewa_texture_filter(IntEnum):
    EWA_TEXTURE_NEAREST = 0
    EWA_TEXTURE_EWA = 1
    EWA_TEXTURE_OPTIMAL = 2


class ewa_texture_wrap(IntEnum):
    EWA_TEXTURE_REPEAT = 0
    EWA_TEXTURE_CLAMP = 1


class ewa_lens_model(IntEnum):
    EWA_LENS_PINHOLE = 0
    EWA_LENS_BROWN = 1
    EWA_LENS_FISHEYE = 2


class ewa_picture_heights(IntEnum):
    EWA_HEIGHTS_NONE = 0
    EWA_HEIGHTS_TERRAIN_RGB = 1
    EWA_HEIGHTS_TERRARIUM = 2


class ewa_ply_encoding(IntEnum):
    EWA_PLY_BINARY_LITTLE_ENDIAN = 0
    EWA_PLY_BINARY_BIG_ENDIAN = 1
    EWA_PLY_ASCII = 2


class ewa_measure_kind(IntEnum):
    EWA_MEASURE_DISTANCE = 0
    EWA_MEASURE_HEIGHT = 1
    EWA_MEASURE_ANGLE = 2
    EWA_MEASURE_AREA = 3
    EWA_MEASURE_NOTE = 4


class ewa_model_format(IntEnum):
    EWA_MODEL_UNKNOWN = 0
    EWA_MODEL_PLY = 1
    EWA_MODEL_OBJ = 2
    EWA_MODEL_STL = 3
    EWA_MODEL_OFF = 4
    EWA_MODEL_GLTF = 5
    EWA_MODEL_LAS = 6
    EWA_MODEL_E57 = 7
    EWA_MODEL_PCD = 8
    EWA_MODEL_PTX = 9
    EWA_MODEL_TEXT = 10
    EWA_MODEL_GRID = 11
    EWA_MODEL_TIFF = 12
    EWA_MODEL_TERRAIN = 13
    EWA_MODEL_VTK = 14


class ewa_option_type(IntEnum):
    EWA_OPTION_BOOL = 0
    EWA_OPTION_CHOICE = 1
    EWA_OPTION_U32 = 2
    EWA_OPTION_U64 = 3
    EWA_OPTION_F32 = 4
    EWA_OPTION_F64 = 5


class ewa_panorama_kind(IntEnum):
    EWA_PANORAMA_NONE = 0
    EWA_PANORAMA_EQUIRECTANGULAR = 1
    EWA_PANORAMA_FISHEYE = 2


class ewa_photos_exposure(IntEnum):
    EWA_EXPOSURE_GAIN = 0
    EWA_EXPOSURE_GAIN_OFFSET = 1
    EWA_EXPOSURE_OFF = 2


class ewa_photos_method(IntEnum):
    EWA_PHOTOS_FIT = 0
    EWA_PHOTOS_MEDIAN = 1
    EWA_PHOTOS_MEAN = 2
    EWA_PHOTOS_BEST = 3


class ewa_csg_operation(IntEnum):
    EWA_CSG_UNION = 0
    EWA_CSG_INTERSECTION = 1
    EWA_CSG_DIFFERENCE = 2


class ewa_object(IntEnum):
    EWA_OBJECT_PLANE = 0
    EWA_OBJECT_CHECKER = 1
    EWA_OBJECT_CUBE = 2
    EWA_OBJECT_SPHERE = 3
    EWA_OBJECT_TORUS = 4
    EWA_OBJECT_TERRAIN = 5
    EWA_OBJECT_CSG = 6
    EWA_OBJECT_TOWN = 7


class ewa_orientation(IntEnum):
    EWA_ORIENT_PROPAGATE = 0
    EWA_ORIENT_VIEWPOINT = 1
    EWA_ORIENT_NONE = 2
    EWA_ORIENT_AUTO = 3


class ewa_refit(IntEnum):
    EWA_REFIT_INTERPOLATE = 0
    EWA_REFIT_FIT = 1


class ewa_surfel_shape(IntEnum):
    EWA_SHAPE_DISC = 0
    EWA_SHAPE_ELLIPSE = 1


class ewa_volume_object(IntEnum):
    EWA_VOLUME_CHECKERBOX = 0
    EWA_VOLUME_BLOB = 1
    EWA_VOLUME_BALL = 2
    EWA_VOLUME_VESSELS = 3


class ewa_procedure(IntEnum):
    EWA_PROCEDURE_CHECKER = 0
    EWA_PROCEDURE_MARBLE = 1
    EWA_PROCEDURE_WOOD = 2
    EWA_PROCEDURE_NOISE = 3


class ewa_cull(IntEnum):
    EWA_CULL_NONE = 0
    EWA_CULL_BACK = 1


class ewa_kernel(IntEnum):
    EWA_KERNEL_PERSPECTIVE = 0
    EWA_KERNEL_AFFINE = 1
    EWA_KERNEL_SOURCE = 2
    EWA_KERNEL_CIRCULAR = 3
    EWA_KERNEL_RAYCAST = 4


class ewa_shading(IntEnum):
    EWA_SHADING_NONE = 0
    EWA_SHADING_LAMBERT = 1
    EWA_SHADING_PHONG = 2


class ewa_pixel_format(IntEnum):
    EWA_PIXEL_SRGB8 = 0
    EWA_PIXEL_LINEAR = 1


class ewa_texture_method(IntEnum):
    EWA_TEXTURE_HYBRID = 0
    EWA_TEXTURE_SPLAT = 1
    EWA_TEXTURE_POINT = 2
    EWA_TEXTURE_BILINEAR = 3


class ewa_asset_kind(IntEnum):
    EWA_ASSET_POINTS = 0
    EWA_ASSET_MESH = 1
    EWA_ASSET_SURFELS = 2
    EWA_ASSET_OCTREE = 3
    EWA_ASSET_GAUSSIANS = 4
    EWA_ASSET_VOLUME = 5


class ewa_octree_levels(IntEnum):
    EWA_OCTREE_AUTO = 0
    EWA_OCTREE_ALWAYS = 1
    EWA_OCTREE_NEVER = 2


class ewa_scene_up(IntEnum):
    EWA_UP_AUTO = 0
    EWA_UP_Y = 1
    EWA_UP_Z = 2
    EWA_UP_MINUS_Y = 3
    EWA_UP_MINUS_Z = 4


class ewa_volume_index(IntEnum):
    EWA_INDEX_EXACT = 0
    EWA_INDEX_TABLE = 1


class ewa_volume_method(IntEnum):
    EWA_VOLUME_HYBRID = 0
    EWA_VOLUME_SPLATS = 1
    EWA_VOLUME_POINTS = 2


class ewa_depth_kind(IntEnum):
    EWA_DEPTH_Z = 0
    EWA_DEPTH_RAY = 1
    EWA_DEPTH_DISPARITY = 2


class ewa_warp_method(IntEnum):
    EWA_WARP_HYBRID = 0
    EWA_WARP_MCMILLAN = 1


class ewa_file_source(c.Structure):
    size_bytes: int
    read_at: Any
    close: Any
    user: int | None
    _fields_ = [
        ("size_bytes", c.c_uint64),
        ("read_at", c.CFUNCTYPE(c.c_int64, c.c_void_p, c.c_uint64, c.c_void_p, c.c_size_t)),
        ("close", c.CFUNCTYPE(None, c.c_void_p)),
        ("user", c.c_void_p),
    ]


ewa_file_opener = c.CFUNCTYPE(c.c_bool, c.c_void_p, c.c_char_p, c.POINTER(ewa_file_source))


ewa_message_callback = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p)


ewa_progress_callback = c.CFUNCTYPE(c.c_bool, c.c_void_p, c.c_char_p, c.c_double)


ewa_task = c.CFUNCTYPE(None, c.c_void_p, c.c_uint32, c.c_uint32)


class ewa_camera(c.Structure):
    projection: int
    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float
    world_to_camera: c.Array[c.c_double]
    _fields_ = [
        ("projection", c.c_int),
        ("width_px", c.c_uint32),
        ("height_px", c.c_uint32),
        ("fx_px", c.c_double),
        ("fy_px", c.c_double),
        ("cx_px", c.c_double),
        ("cy_px", c.c_double),
        ("world_to_camera", c.c_double * 16),
    ]


ewa_camera_callback = c.CFUNCTYPE(None, c.c_void_p, c.c_uint32, c.POINTER(ewa_camera))


ewa_line_callback = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p)


class ewa_image(c.Structure):
    context: int | None
    width_px: int
    height_px: int
    channel_count: int
    pixels: int | None
    _fields_ = [
        ("context", c.c_void_p),
        ("width_px", c.c_uint32),
        ("height_px", c.c_uint32),
        ("channel_count", c.c_uint32),
        ("pixels", c.c_void_p),
    ]


class ewa_mesh_material(c.Structure):
    base_color: c.Array[c.c_float]
    texture: int
    _fields_ = [
        ("base_color", c.c_float * 4),
        ("texture", c.c_uint32),
    ]


class ewa_mesh(c.Structure):
    context: int | None
    vertex_count: int
    triangle_count: int
    material_count: int
    positions: int | None
    normals: int | None
    colors: int | None
    texcoords: int | None
    triangles: int | None
    triangle_materials: int | None
    materials: Any
    textures: Any
    attributes: int | None
    _fields_ = [
        ("context", c.c_void_p),
        ("vertex_count", c.c_uint32),
        ("triangle_count", c.c_uint32),
        ("material_count", c.c_uint32),
        ("positions", c.c_void_p),
        ("normals", c.c_void_p),
        ("colors", c.c_void_p),
        ("texcoords", c.c_void_p),
        ("triangles", c.c_void_p),
        ("triangle_materials", c.c_void_p),
        ("materials", c.POINTER(ewa_mesh_material)),
        ("textures", c.POINTER(ewa_image)),
        ("attributes", c.c_void_p),
    ]


class ewa_model(c.Structure):
    format: int
    lost_count: int
    face_count: int
    mesh: ewa_mesh
    points: int | None
    elements: int | None
    _fields_ = [
        ("format", c.c_int),
        ("lost_count", c.c_uint64),
        ("face_count", c.c_uint64),
        ("mesh", ewa_mesh),
        ("points", c.c_void_p),
        ("elements", c.c_void_p),
    ]


ewa_asset_reader = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_char_p, c.POINTER(ewa_model), c.c_void_p)


class ewa_allocator(c.Structure):
    user: int | None
    allocate: Any
    release: Any
    _fields_ = [
        ("user", c.c_void_p),
        ("allocate", c.CFUNCTYPE(c.c_void_p, c.c_void_p, c.c_size_t)),
        ("release", c.CFUNCTYPE(None, c.c_void_p, c.c_void_p, c.c_size_t)),
    ]


class ewa_bounds(c.Structure):
    low_world: c.Array[c.c_double]
    high_world: c.Array[c.c_double]
    finite_count: int
    _fields_ = [
        ("low_world", c.c_double * 3),
        ("high_world", c.c_double * 3),
        ("finite_count", c.c_uint64),
    ]


class ewa_executor(c.Structure):
    user: int | None
    worker_count: int
    run: Any
    _fields_ = [
        ("user", c.c_void_p),
        ("worker_count", c.c_uint32),
        ("run", c.CFUNCTYPE(None, c.c_void_p, ewa_task, c.c_void_p, c.c_uint32)),
    ]


class ewa_limits(c.Structure):
    max_points: int
    max_memory_bytes: int
    max_image_side: int
    max_seconds: float
    _fields_ = [
        ("max_points", c.c_uint64),
        ("max_memory_bytes", c.c_uint64),
        ("max_image_side", c.c_uint32),
        ("max_seconds", c.c_double),
    ]


class ewa_context_options(c.Structure):
    struct_size: int
    allocator: ewa_allocator
    executor: ewa_executor
    thread_count: int
    cpu_mask: int
    message_level: int
    message: Any
    message_user: int | None
    progress: Any
    progress_user: int | None
    limits: ewa_limits
    named_files: int
    untrusted: bool
    open_file: Any
    open_file_user: int | None
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("allocator", ewa_allocator),
        ("executor", ewa_executor),
        ("thread_count", c.c_uint32),
        ("cpu_mask", c.c_uint32),
        ("message_level", c.c_int),
        ("message", ewa_message_callback),
        ("message_user", c.c_void_p),
        ("progress", ewa_progress_callback),
        ("progress_user", c.c_void_p),
        ("limits", ewa_limits),
        ("named_files", c.c_int),
        ("untrusted", c.c_bool),
        ("open_file", ewa_file_opener),
        ("open_file_user", c.c_void_p),
    ]


class ewa_acquire_options(c.Structure):
    struct_size: int
    filter: int
    fit: int
    wrap_s: int
    wrap_t: int
    pixel_sigma_px: float
    cutoff: float
    ridge: float
    modulate: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("filter", c.c_int),
        ("fit", c.c_int),
        ("wrap_s", c.c_int),
        ("wrap_t", c.c_int),
        ("pixel_sigma_px", c.c_double),
        ("cutoff", c.c_double),
        ("ridge", c.c_double),
        ("modulate", c.c_bool),
    ]


class ewa_acquire_report(c.Structure):
    textured_count: int
    pair_count: int
    iterations: int
    gradient: float
    ridge: float
    _fields_ = [
        ("textured_count", c.c_uint64),
        ("pair_count", c.c_uint64),
        ("iterations", c.c_uint32),
        ("gradient", c.c_double),
        ("ridge", c.c_double),
    ]


class ewa_camera_cotangent(c.Structure):
    rotation: c.Array[c.c_double]
    translation: c.Array[c.c_double]
    focal_px: c.Array[c.c_double]
    principal_px: c.Array[c.c_double]
    _fields_ = [
        ("rotation", c.c_double * 3),
        ("translation", c.c_double * 3),
        ("focal_px", c.c_double * 2),
        ("principal_px", c.c_double * 2),
    ]


class ewa_frame_cotangent(c.Structure):
    rgba: int | None
    depth: int | None
    normal: int | None
    coverage: int | None
    _fields_ = [
        ("rgba", c.c_void_p),
        ("depth", c.c_void_p),
        ("normal", c.c_void_p),
        ("coverage", c.c_void_p),
    ]


class ewa_gradient(c.Structure):
    color: int | None
    opacity: int | None
    position: int | None
    normal: int | None
    radius: int | None
    tangent_u: int | None
    tangent_v: int | None
    camera: Any
    rgba: int | None
    _fields_ = [
        ("color", c.c_void_p),
        ("opacity", c.c_void_p),
        ("position", c.c_void_p),
        ("normal", c.c_void_p),
        ("radius", c.c_void_p),
        ("tangent_u", c.c_void_p),
        ("tangent_v", c.c_void_p),
        ("camera", c.POINTER(ewa_camera_cotangent)),
        ("rgba", c.c_void_p),
    ]


class ewa_attribute(c.Structure):
    name: bytes
    type: int
    component_count: int
    stride_bytes: int
    data: int | None
    borrowed: bool
    _fields_ = [
        ("name", c.c_char * 64),
        ("type", c.c_int),
        ("component_count", c.c_uint32),
        ("stride_bytes", c.c_size_t),
        ("data", c.c_void_p),
        ("borrowed", c.c_bool),
    ]


class ewa_coordinate_grid(c.Structure):
    step_world: c.Array[c.c_double]
    offset_world: c.Array[c.c_double]
    _fields_ = [
        ("step_world", c.c_double * 3),
        ("offset_world", c.c_double * 3),
    ]


class ewa_parcel(c.Structure):
    data: int | None
    size_bytes: int
    _fields_ = [
        ("data", c.c_void_p),
        ("size_bytes", c.c_size_t),
    ]


class ewa_exchange(c.Structure):
    user: int | None
    rank: int
    rank_count: int
    picture_rank: int
    swap: Any
    _fields_ = [
        ("user", c.c_void_p),
        ("rank", c.c_uint32),
        ("rank_count", c.c_uint32),
        ("picture_rank", c.c_uint32),
        ("swap", c.CFUNCTYPE(c.c_int, c.c_void_p, c.POINTER(ewa_parcel), c.POINTER(ewa_parcel))),
    ]


class ewa_coloring(c.Structure):
    struct_size: int
    attribute: bytes
    map: int
    ranged: bool
    percent: c.Array[c.c_bool]
    range: c.Array[c.c_double]
    tinted: bool
    tint: c.Array[c.c_double]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("attribute", c.c_char * 68),
        ("map", c.c_int),
        ("ranged", c.c_bool),
        ("percent", c.c_bool * 2),
        ("range", c.c_double * 2),
        ("tinted", c.c_bool),
        ("tint", c.c_double * 3),
    ]


class ewa_category(c.Structure):
    value: float
    name: bytes | None
    srgb: c.Array[c.c_uint8]
    _fields_ = [
        ("value", c.c_double),
        ("name", c.c_char_p),
        ("srgb", c.c_uint8 * 3),
    ]


class ewa_legend(c.Structure):
    context: int | None
    colormap: int
    range: c.Array[c.c_double]
    length: bool
    classes: bool
    category_count: int
    categories: Any
    names: bytes | None
    grey_count: int
    attribute: bytes
    _fields_ = [
        ("context", c.c_void_p),
        ("colormap", c.c_int),
        ("range", c.c_double * 2),
        ("length", c.c_bool),
        ("classes", c.c_bool),
        ("category_count", c.c_uint32),
        ("categories", c.POINTER(ewa_category)),
        ("names", c.c_char_p),
        ("grey_count", c.c_uint64),
        ("attribute", c.c_char * 68),
    ]


class ewa_cloud_invalid_points(c.Structure):
    position_count: int
    normal_count: int
    radius_count: int
    axis_count: int
    color_count: int
    _fields_ = [
        ("position_count", c.c_uint64),
        ("normal_count", c.c_uint64),
        ("radius_count", c.c_uint64),
        ("axis_count", c.c_uint64),
        ("color_count", c.c_uint64),
    ]


class ewa_gaussian_columns(c.Structure):
    dimensions: int
    sh_degree: int
    filtered: bool
    _fields_ = [
        ("dimensions", c.c_uint32),
        ("sh_degree", c.c_uint32),
        ("filtered", c.c_bool),
    ]


class ewa_framing_info(c.Structure):
    box: ewa_bounds
    middle_world: c.Array[c.c_double]
    sample_count: int
    trimmed: bool
    _fields_ = [
        ("box", ewa_bounds),
        ("middle_world", c.c_double * 3),
        ("sample_count", c.c_uint64),
        ("trimmed", c.c_bool),
    ]


class ewa_upright(c.Structure):
    axis: int
    reversed: bool
    view: int
    from_origin: bool
    why: bytes | None
    _fields_ = [
        ("axis", c.c_int),
        ("reversed", c.c_bool),
        ("view", c.c_int),
        ("from_origin", c.c_bool),
        ("why", c.c_char_p),
    ]


class ewa_canvas(c.Structure):
    rgba8: int | None
    width_px: int
    height_px: int
    _fields_ = [
        ("rgba8", c.c_void_p),
        ("width_px", c.c_uint32),
        ("height_px", c.c_uint32),
    ]


class ewa_furniture_options(c.Structure):
    struct_size: int
    title: bytes | None
    axes: bool
    scale_bar: bool
    color_bar: bool
    scale_depth_world: float
    unit: bytes | None
    colormap: int
    range: c.Array[c.c_double]
    color_label: bytes | None
    color_unit: bytes | None
    categories: Any
    category_count: int
    pixel_scale: float
    ink: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("title", c.c_char_p),
        ("axes", c.c_bool),
        ("scale_bar", c.c_bool),
        ("color_bar", c.c_bool),
        ("scale_depth_world", c.c_double),
        ("unit", c.c_char_p),
        ("colormap", c.c_int),
        ("range", c.c_double * 2),
        ("color_label", c.c_char_p),
        ("color_unit", c.c_char_p),
        ("categories", c.POINTER(ewa_category)),
        ("category_count", c.c_uint32),
        ("pixel_scale", c.c_double),
        ("ink", c.c_int),
    ]


class ewa_text_style(c.Structure):
    height_px: float
    rgba: c.Array[c.c_uint8]
    halo_px: float
    halo_rgba: c.Array[c.c_uint8]
    anchor: int
    _fields_ = [
        ("height_px", c.c_double),
        ("rgba", c.c_uint8 * 4),
        ("halo_px", c.c_double),
        ("halo_rgba", c.c_uint8 * 4),
        ("anchor", c.c_int),
    ]


class ewa_gaussians(c.Structure):
    context: int | None
    count: int
    sh_degree: int
    flat: bool
    antialiased: bool
    origin: c.Array[c.c_double]
    centers: int | None
    scales: int | None
    rotations: int | None
    opacities: int | None
    harmonics: int | None
    classes: int | None
    _fields_ = [
        ("context", c.c_void_p),
        ("count", c.c_uint32),
        ("sh_degree", c.c_uint32),
        ("flat", c.c_bool),
        ("antialiased", c.c_bool),
        ("origin", c.c_double * 3),
        ("centers", c.c_void_p),
        ("scales", c.c_void_p),
        ("rotations", c.c_void_p),
        ("opacities", c.c_void_p),
        ("harmonics", c.c_void_p),
        ("classes", c.c_void_p),
    ]


class ewa_gaussian_facts(c.Structure):
    format: int
    version: int
    filtered: bool
    up_world: c.Array[c.c_double]
    size_bytes: int
    _fields_ = [
        ("format", c.c_int),
        ("version", c.c_uint32),
        ("filtered", c.c_bool),
        ("up_world", c.c_double * 3),
        ("size_bytes", c.c_uint64),
    ]


class ewa_gaussians_save_options(c.Structure):
    struct_size: int
    sh_degree: int
    spz_version: int
    up_world: c.Array[c.c_double]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("sh_degree", c.c_uint32),
        ("spz_version", c.c_uint32),
        ("up_world", c.c_double * 3),
    ]


class ewa_gaussian_options(c.Structure):
    struct_size: int
    projection: int
    filter: int
    prefilter_px2: float
    cutoff: float
    minimum_alpha: float
    minimum_transmittance: float
    near_world: float
    sh_degree: int
    background: c.Array[c.c_float]
    surface_depth: int | None
    surface_rgba: int | None
    section_planes: c.Array[Any]
    section_count: int
    surface_normal: int | None
    surface_coverage: int | None
    order: int
    merge_px: float
    display: int
    ellipsoid_radius: float
    dot_px: float
    depth: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("projection", c.c_int),
        ("filter", c.c_int),
        ("prefilter_px2", c.c_double),
        ("cutoff", c.c_double),
        ("minimum_alpha", c.c_double),
        ("minimum_transmittance", c.c_double),
        ("near_world", c.c_double),
        ("sh_degree", c.c_uint32),
        ("background", c.c_float * 4),
        ("surface_depth", c.c_void_p),
        ("surface_rgba", c.c_void_p),
        ("section_planes", (c.c_double * 4) * 8),
        ("section_count", c.c_uint32),
        ("surface_normal", c.c_void_p),
        ("surface_coverage", c.c_void_p),
        ("order", c.c_int),
        ("merge_px", c.c_double),
        ("display", c.c_int),
        ("ellipsoid_radius", c.c_double),
        ("dot_px", c.c_double),
        ("depth", c.c_int),
    ]


class ewa_gaussian_stats(c.Structure):
    splat_count: int
    visible_count: int
    near_count: int
    tile_count: int
    block_count: int
    sorted_count: int
    project_s: float
    bin_s: float
    draw_s: float
    total_s: float
    _fields_ = [
        ("splat_count", c.c_uint64),
        ("visible_count", c.c_uint64),
        ("near_count", c.c_uint64),
        ("tile_count", c.c_uint64),
        ("block_count", c.c_uint64),
        ("sorted_count", c.c_uint64),
        ("project_s", c.c_double),
        ("bin_s", c.c_double),
        ("draw_s", c.c_double),
        ("total_s", c.c_double),
    ]


class ewa_splats_info(c.Structure):
    splat_count: int
    sh_degree: int
    antialiased: bool
    has_levels: bool
    has_classes: bool
    resident_bytes: int
    bounds: ewa_bounds
    core: ewa_bounds
    near_world: float
    _fields_ = [
        ("splat_count", c.c_uint32),
        ("sh_degree", c.c_uint32),
        ("antialiased", c.c_bool),
        ("has_levels", c.c_bool),
        ("has_classes", c.c_bool),
        ("resident_bytes", c.c_size_t),
        ("bounds", ewa_bounds),
        ("core", ewa_bounds),
        ("near_world", c.c_double),
    ]


class ewa_gpu_info(c.Structure):
    struct_size: int
    vendor: bytes
    renderer: bytes
    version: bytes
    software: bool
    device_class: int
    differs: bytes
    native_fma: bool
    native_division: bool
    native_root: bool
    storage_bytes: int
    storage_count: int
    group_threads: int
    texture_px: int
    devices: bytes
    subnormals: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("vendor", c.c_char * 128),
        ("renderer", c.c_char * 128),
        ("version", c.c_char * 128),
        ("software", c.c_bool),
        ("device_class", c.c_int),
        ("differs", c.c_char * 64),
        ("native_fma", c.c_bool),
        ("native_division", c.c_bool),
        ("native_root", c.c_bool),
        ("storage_bytes", c.c_uint64),
        ("storage_count", c.c_uint32),
        ("group_threads", c.c_uint32),
        ("texture_px", c.c_uint32),
        ("devices", c.c_char * 1024),
        ("subnormals", c.c_bool),
    ]


class ewa_renderer_info(c.Structure):
    struct_size: int
    backend: bytes
    device: bytes
    device_class: int
    remark: bytes
    wait_count: int
    readback_count: int
    dispatch_count: int
    upload_bytes: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("backend", c.c_char * 16),
        ("device", c.c_char * 128),
        ("device_class", c.c_int),
        ("remark", c.c_char * 160),
        ("wait_count", c.c_uint32),
        ("readback_count", c.c_uint32),
        ("dispatch_count", c.c_uint32),
        ("upload_bytes", c.c_uint64),
    ]


class ewa_conic(c.Structure):
    xx: float
    xy: float
    xw: float
    yy: float
    yw: float
    ww: float
    _fields_ = [
        ("xx", c.c_double),
        ("xy", c.c_double),
        ("xw", c.c_double),
        ("yy", c.c_double),
        ("yw", c.c_double),
        ("ww", c.c_double),
    ]


class ewa_vec3(c.Structure):
    x: float
    y: float
    z: float
    _fields_ = [
        ("x", c.c_double),
        ("y", c.c_double),
        ("z", c.c_double),
    ]


class ewa_line3(c.Structure):
    direction: ewa_vec3
    moment: ewa_vec3
    _fields_ = [
        ("direction", ewa_vec3),
        ("moment", ewa_vec3),
    ]


class ewa_mat3(c.Structure):
    m: c.Array[Any]
    _fields_ = [
        ("m", (c.c_double * 3) * 3),
    ]


class ewa_mat4(c.Structure):
    m: c.Array[Any]
    _fields_ = [
        ("m", (c.c_double * 4) * 4),
    ]


class ewa_segment_batch(c.Structure):
    count: int
    end: c.Array[Any]
    _fields_ = [
        ("count", c.c_uint64),
        ("end", (c.c_void_p * 4) * 2),
    ]


class ewa_segment_clips(c.Structure):
    visible: int | None
    alpha: c.Array[Any]
    end: c.Array[Any]
    _fields_ = [
        ("visible", c.c_void_p),
        ("alpha", (c.c_void_p * 2) * 2),
        ("end", ((c.c_void_p * 4) * 2) * 2),
    ]


class ewa_vec4(c.Structure):
    x: float
    y: float
    z: float
    w: float
    _fields_ = [
        ("x", c.c_double),
        ("y", c.c_double),
        ("z", c.c_double),
        ("w", c.c_double),
    ]


class ewa_segment_part(c.Structure):
    alpha: c.Array[c.c_double]
    end: c.Array[ewa_vec4]
    _fields_ = [
        ("alpha", c.c_double * 2),
        ("end", ewa_vec4 * 2),
    ]


class ewa_cloud_load_options(c.Structure):
    struct_size: int
    keep_going: bool
    attributes: bytes | None
    columns: bytes | None
    heights: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("keep_going", c.c_bool),
        ("attributes", c.c_char_p),
        ("columns", c.c_char_p),
        ("heights", c.c_int),
    ]


class ewa_cloud_save_options(c.Structure):
    struct_size: int
    ply_encoding: int
    elements: int | None
    step_world: float
    chunk_points: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("ply_encoding", c.c_int),
        ("elements", c.c_void_p),
        ("step_world", c.c_double),
        ("chunk_points", c.c_uint32),
    ]


class ewa_image_save_options(c.Structure):
    struct_size: int
    channel_names: bytes | None
    exr_half: bool
    world_to_camera: int | None
    srgb_alpha_straight: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("channel_names", c.c_char_p),
        ("exr_half", c.c_bool),
        ("world_to_camera", c.c_void_p),
        ("srgb_alpha_straight", c.c_bool),
    ]


class ewa_lens(c.Structure):
    model: int
    radial: c.Array[c.c_double]
    tangential: c.Array[c.c_double]
    _fields_ = [
        ("model", c.c_int),
        ("radial", c.c_double * 6),
        ("tangential", c.c_double * 2),
    ]


class ewa_photo(c.Structure):
    camera: ewa_camera
    lens: ewa_lens
    path: bytes | None
    image: Any
    mask_path: bytes | None
    _fields_ = [
        ("camera", ewa_camera),
        ("lens", ewa_lens),
        ("path", c.c_char_p),
        ("image", c.POINTER(ewa_image)),
        ("mask_path", c.c_char_p),
    ]


class ewa_volume_load_options(c.Structure):
    struct_size: int
    dims: c.Array[c.c_uint32]
    type: int
    big_endian: bool
    header_bytes: int
    spacing_world: c.Array[c.c_double]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("dims", c.c_uint32 * 3),
        ("type", c.c_int),
        ("big_endian", c.c_bool),
        ("header_bytes", c.c_uint64),
        ("spacing_world", c.c_double * 3),
    ]


class ewa_volume_save_options(c.Structure):
    struct_size: int
    plain: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("plain", c.c_bool),
    ]


class ewa_lod_build_options(c.Structure):
    struct_size: int
    memory_bytes: int
    subset: int
    subset_count: int
    keep_going: bool
    attributes: bytes | None
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("memory_bytes", c.c_uint64),
        ("subset", c.c_uint32),
        ("subset_count", c.c_uint32),
        ("keep_going", c.c_bool),
        ("attributes", c.c_char_p),
    ]


class ewa_lod_build_stats(c.Structure):
    point_count: int
    left_out_count: int
    merged_count: int
    node_count: int
    level_count: int
    temporary_bytes: int
    statistics_s: float
    distribute_s: float
    estimate_s: float
    merge_s: float
    write_s: float
    total_s: float
    _fields_ = [
        ("point_count", c.c_uint64),
        ("left_out_count", c.c_uint64),
        ("merged_count", c.c_uint64),
        ("node_count", c.c_uint32),
        ("level_count", c.c_uint32),
        ("temporary_bytes", c.c_uint64),
        ("statistics_s", c.c_double),
        ("distribute_s", c.c_double),
        ("estimate_s", c.c_double),
        ("merge_s", c.c_double),
        ("write_s", c.c_double),
        ("total_s", c.c_double),
    ]


class ewa_lod_info(c.Structure):
    kind: bytes | None
    point_count: int
    bounds: ewa_bounds
    low_world: c.Array[c.c_double]
    side_world: float
    spacing_world: float
    node_count: int
    level_count: int
    merged: bool
    merged_count: int
    surfels: bool
    prototype: int | None
    represented: int | None
    _fields_ = [
        ("kind", c.c_char_p),
        ("point_count", c.c_uint64),
        ("bounds", ewa_bounds),
        ("low_world", c.c_double * 3),
        ("side_world", c.c_double),
        ("spacing_world", c.c_double),
        ("node_count", c.c_uint32),
        ("level_count", c.c_uint32),
        ("merged", c.c_bool),
        ("merged_count", c.c_uint64),
        ("surfels", c.c_bool),
        ("prototype", c.c_void_p),
        ("represented", c.c_void_p),
    ]


class ewa_lod_options(c.Structure):
    struct_size: int
    spacing_px: float
    error: float
    memory_bytes: int
    load_s: float
    share: int
    share_count: int
    max_splats: int
    resident_only: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("spacing_px", c.c_double),
        ("error", c.c_double),
        ("memory_bytes", c.c_uint64),
        ("load_s", c.c_double),
        ("share", c.c_uint32),
        ("share_count", c.c_uint32),
        ("max_splats", c.c_uint64),
        ("resident_only", c.c_bool),
    ]


class ewa_lod_scene(c.Structure):
    lods: int | None
    lod_count: int
    surfels_count: int
    surfels: int | None
    _fields_ = [
        ("lods", c.c_void_p),
        ("lod_count", c.c_uint32),
        ("surfels_count", c.c_uint32),
        ("surfels", c.c_void_p),
    ]


class ewa_render_stats(c.Structure):
    splat_count: int
    culled_count: int
    hidden_count: int
    drawn_count: int
    fragment_count: int
    bin_s: float
    setup_s: float
    visibility_s: float
    accumulate_s: float
    edge_s: float
    resolve_s: float
    total_s: float
    level: int
    _fields_ = [
        ("splat_count", c.c_uint64),
        ("culled_count", c.c_uint64),
        ("hidden_count", c.c_uint64),
        ("drawn_count", c.c_uint64),
        ("fragment_count", c.c_uint64),
        ("bin_s", c.c_double),
        ("setup_s", c.c_double),
        ("visibility_s", c.c_double),
        ("accumulate_s", c.c_double),
        ("edge_s", c.c_double),
        ("resolve_s", c.c_double),
        ("total_s", c.c_double),
        ("level", c.c_uint32),
    ]


class ewa_lod_stats(c.Structure):
    render: ewa_render_stats
    surfel_count: int
    node_count: int
    loaded_count: int
    missing_count: int
    band_count: int
    resident_bytes: int
    choose_s: float
    load_s: float
    coarser: float
    _fields_ = [
        ("render", ewa_render_stats),
        ("surfel_count", c.c_uint64),
        ("node_count", c.c_uint32),
        ("loaded_count", c.c_uint32),
        ("missing_count", c.c_uint32),
        ("band_count", c.c_uint32),
        ("resident_bytes", c.c_uint64),
        ("choose_s", c.c_double),
        ("load_s", c.c_double),
        ("coarser", c.c_double),
    ]


class ewa_measure(c.Structure):
    kind: int
    name: bytes
    count: int
    places_world: c.Array[c.c_double]
    _fields_ = [
        ("kind", c.c_int),
        ("name", c.c_char * 64),
        ("count", c.c_uint32),
        ("places_world", c.c_double * 192),
    ]


class ewa_measurement(c.Structure):
    length_world: float
    horizontal_world: float
    rise_world: float
    slope_deg: float
    angle_deg: float
    area: float
    horizontal_area: float
    _fields_ = [
        ("length_world", c.c_double),
        ("horizontal_world", c.c_double),
        ("rise_world", c.c_double),
        ("slope_deg", c.c_double),
        ("angle_deg", c.c_double),
        ("area", c.c_double),
        ("horizontal_area", c.c_double),
    ]


class ewa_mesh_sample_options(c.Structure):
    struct_size: int
    point_count: int
    spacing_world: float
    seed: int
    crease_degrees: float
    radius_scale: float
    cutoff: float
    clip_lines: bool
    smooth_normals: bool
    texture_filter: int
    pixel_sigma_px: float
    texcoords: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("point_count", c.c_uint64),
        ("spacing_world", c.c_double),
        ("seed", c.c_uint64),
        ("crease_degrees", c.c_double),
        ("radius_scale", c.c_double),
        ("cutoff", c.c_double),
        ("clip_lines", c.c_bool),
        ("smooth_normals", c.c_bool),
        ("texture_filter", c.c_int),
        ("pixel_sigma_px", c.c_double),
        ("texcoords", c.c_bool),
    ]


class ewa_light(c.Structure):
    direction_world: c.Array[c.c_double]
    color: c.Array[c.c_float]
    _fields_ = [
        ("direction_world", c.c_double * 3),
        ("color", c.c_float * 3),
    ]


class ewa_material(c.Structure):
    ambient: float
    diffuse: float
    specular: float
    shininess: float
    reflection: float
    _fields_ = [
        ("ambient", c.c_float),
        ("diffuse", c.c_float),
        ("specular", c.c_float),
        ("shininess", c.c_float),
        ("reflection", c.c_float),
    ]


class ewa_volume_options(c.Structure):
    struct_size: int
    method: int
    index: int
    sigma: float
    cutoff: float
    prefilter_px: float
    point_threshold_px: float
    depth_unit: float
    level: int
    density_scale: float
    minimum_transmittance: float
    shading: int
    lights: c.Array[ewa_light]
    light_count: int
    material: ewa_material
    background: c.Array[c.c_float]
    surface_depth: int | None
    surface_rgba: int | None
    section_planes: c.Array[Any]
    section_count: int
    surface_normal: int | None
    surface_coverage: int | None
    mark_splats: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("method", c.c_int),
        ("index", c.c_int),
        ("sigma", c.c_double),
        ("cutoff", c.c_double),
        ("prefilter_px", c.c_double),
        ("point_threshold_px", c.c_double),
        ("depth_unit", c.c_double),
        ("level", c.c_uint32),
        ("density_scale", c.c_double),
        ("minimum_transmittance", c.c_double),
        ("shading", c.c_int),
        ("lights", ewa_light * 8),
        ("light_count", c.c_uint32),
        ("material", ewa_material),
        ("background", c.c_float * 4),
        ("surface_depth", c.c_void_p),
        ("surface_rgba", c.c_void_p),
        ("section_planes", (c.c_double * 4) * 8),
        ("section_count", c.c_uint32),
        ("surface_normal", c.c_void_p),
        ("surface_coverage", c.c_void_p),
        ("mark_splats", c.c_bool),
    ]


class ewa_volume_stats(c.Structure):
    voxel_count: int
    culled_count: int
    near_count: int
    hidden_count: int
    splat_count: int
    point_count: int
    point_share: float
    bin_s: float
    setup_s: float
    points_s: float
    splats_s: float
    resolve_s: float
    total_s: float
    _fields_ = [
        ("voxel_count", c.c_uint64),
        ("culled_count", c.c_uint64),
        ("near_count", c.c_uint64),
        ("hidden_count", c.c_uint64),
        ("splat_count", c.c_uint64),
        ("point_count", c.c_uint64),
        ("point_share", c.c_double),
        ("bin_s", c.c_double),
        ("setup_s", c.c_double),
        ("points_s", c.c_double),
        ("splats_s", c.c_double),
        ("resolve_s", c.c_double),
        ("total_s", c.c_double),
    ]


class ewa_mixed_volume(c.Structure):
    renderer: int | None
    voxels: int | None
    options: Any
    stats: Any
    _fields_ = [
        ("renderer", c.c_void_p),
        ("voxels", c.c_void_p),
        ("options", c.POINTER(ewa_volume_options)),
        ("stats", c.POINTER(ewa_volume_stats)),
    ]


class ewa_mixture(c.Structure):
    splats: int | None
    splats_count: int
    volume_count: int
    volumes: Any
    _fields_ = [
        ("splats", c.c_void_p),
        ("splats_count", c.c_uint32),
        ("volume_count", c.c_uint32),
        ("volumes", c.POINTER(ewa_mixed_volume)),
    ]


class ewa_option(c.Structure):
    name: bytes | None
    type: int
    offset: int
    minimum: float
    maximum: float
    limits: int
    count: int
    initial: float
    initials: int | None
    unit: bytes | None
    words: bytes | None
    help: bytes | None
    _fields_ = [
        ("name", c.c_char_p),
        ("type", c.c_int),
        ("offset", c.c_size_t),
        ("minimum", c.c_double),
        ("maximum", c.c_double),
        ("limits", c.c_uint32),
        ("count", c.c_uint32),
        ("initial", c.c_double),
        ("initials", c.c_void_p),
        ("unit", c.c_char_p),
        ("words", c.c_char_p),
        ("help", c.c_char_p),
    ]


class ewa_option_table(c.Structure):
    name: bytes | None
    options: Any
    option_count: int
    struct_size: int
    _fields_ = [
        ("name", c.c_char_p),
        ("options", c.POINTER(ewa_option)),
        ("option_count", c.c_size_t),
        ("struct_size", c.c_size_t),
    ]


class ewa_panorama_options(c.Structure):
    struct_size: int
    kind: int
    fov_deg: float
    up_world: c.Array[c.c_double]
    finer: float
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("kind", c.c_int),
        ("fov_deg", c.c_double),
        ("up_world", c.c_double * 3),
        ("finer", c.c_double),
    ]


class ewa_image_quality(c.Structure):
    pixel_count: int
    mean_squared_error: float
    psnr_db: float
    ssim: float
    _fields_ = [
        ("pixel_count", c.c_uint64),
        ("mean_squared_error", c.c_double),
        ("psnr_db", c.c_double),
        ("ssim", c.c_double),
    ]


class ewa_photo_report(c.Structure):
    held_out: bool
    width_px: int
    height_px: int
    pixel_count: int
    point_count: int
    gain: c.Array[c.c_double]
    offset: c.Array[c.c_double]
    rms: float
    rejected: float
    psnr_db: float
    world_to_camera: c.Array[c.c_double]
    shift_px: float
    _fields_ = [
        ("held_out", c.c_bool),
        ("width_px", c.c_uint32),
        ("height_px", c.c_uint32),
        ("pixel_count", c.c_uint64),
        ("point_count", c.c_uint64),
        ("gain", c.c_double * 3),
        ("offset", c.c_double * 3),
        ("rms", c.c_double),
        ("rejected", c.c_double),
        ("psnr_db", c.c_double),
        ("world_to_camera", c.c_double * 16),
        ("shift_px", c.c_double),
    ]


class ewa_photos_options(c.Structure):
    struct_size: int
    method: int
    exposure: int
    hold_out: int
    rounds: int
    robust: float
    ridge: float
    spacing_px: float
    cutoff: float
    pose_steps: int
    vignetting: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("method", c.c_int),
        ("exposure", c.c_int),
        ("hold_out", c.c_uint32),
        ("rounds", c.c_uint32),
        ("robust", c.c_double),
        ("ridge", c.c_double),
        ("spacing_px", c.c_double),
        ("cutoff", c.c_double),
        ("pose_steps", c.c_uint32),
        ("vignetting", c.c_bool),
    ]


class ewa_photos_report(c.Structure):
    used_count: int
    held_out_count: int
    seen_count: int
    rms: float
    held_out_rms: float
    psnr_db: float
    held_out_psnr_db: float
    vignetting: c.Array[c.c_double]
    low: float
    high: float
    _fields_ = [
        ("used_count", c.c_uint32),
        ("held_out_count", c.c_uint32),
        ("seen_count", c.c_uint64),
        ("rms", c.c_double),
        ("held_out_rms", c.c_double),
        ("psnr_db", c.c_double),
        ("held_out_psnr_db", c.c_double),
        ("vignetting", c.c_double * 2),
        ("low", c.c_float),
        ("high", c.c_float),
    ]


class ewa_csg_options(c.Structure):
    struct_size: int
    operation: int
    cutoff: float
    names: c.Array[c.c_char_p]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("operation", c.c_int),
        ("cutoff", c.c_double),
        ("names", c.c_char_p * 2),
    ]


class ewa_estimate_options(c.Structure):
    struct_size: int
    neighbour_count: int
    orientation: int
    viewpoint_world: c.Array[c.c_double]
    shape: int
    radius_scale: float
    radius_limit: float
    cutoff: float
    keep_normals: bool
    keep_radii: bool
    outlier_factor: float
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("neighbour_count", c.c_uint32),
        ("orientation", c.c_int),
        ("viewpoint_world", c.c_double * 3),
        ("shape", c.c_int),
        ("radius_scale", c.c_double),
        ("radius_limit", c.c_double),
        ("cutoff", c.c_double),
        ("keep_normals", c.c_bool),
        ("keep_radii", c.c_bool),
        ("outlier_factor", c.c_double),
    ]


class ewa_feature_counts(c.Structure):
    snapped_count: int
    edge_count: int
    corner_count: int
    noise: float
    neighbour_count: int
    _fields_ = [
        ("snapped_count", c.c_uint64),
        ("edge_count", c.c_uint64),
        ("corner_count", c.c_uint64),
        ("noise", c.c_double),
        ("neighbour_count", c.c_uint32),
    ]


class ewa_feature_options(c.Structure):
    struct_size: int
    neighbour_count: int
    angle_deg: float
    noise: float
    cutoff: float
    project: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("neighbour_count", c.c_uint32),
        ("angle_deg", c.c_double),
        ("noise", c.c_double),
        ("cutoff", c.c_double),
        ("project", c.c_bool),
    ]


class ewa_generate_options(c.Structure):
    struct_size: int
    object: int
    point_count: int
    seed: int
    size_world: float
    jitter: float
    checks: float
    radius_scale: float
    positions_only: bool
    sharp: bool
    texcoords: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("object", c.c_int),
        ("point_count", c.c_uint64),
        ("seed", c.c_uint64),
        ("size_world", c.c_double),
        ("jitter", c.c_double),
        ("checks", c.c_double),
        ("radius_scale", c.c_double),
        ("positions_only", c.c_bool),
        ("sharp", c.c_bool),
        ("texcoords", c.c_bool),
    ]


class ewa_refit_options(c.Structure):
    struct_size: int
    goal: int
    cutoff: float
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("goal", c.c_int),
        ("cutoff", c.c_double),
    ]


class ewa_refit_report(c.Structure):
    surfel_count: int
    left_out_count: int
    before_rms: float
    after_rms: float
    low: float
    high: float
    iteration_count: int
    _fields_ = [
        ("surfel_count", c.c_uint64),
        ("left_out_count", c.c_uint64),
        ("before_rms", c.c_double),
        ("after_rms", c.c_double),
        ("low", c.c_float),
        ("high", c.c_float),
        ("iteration_count", c.c_uint32),
    ]


class ewa_spacing(c.Structure):
    median_world: float
    mean_world: float
    low_world: float
    high_world: float
    duplicate_count: int
    _fields_ = [
        ("median_world", c.c_double),
        ("mean_world", c.c_double),
        ("low_world", c.c_double),
        ("high_world", c.c_double),
        ("duplicate_count", c.c_uint64),
    ]


class ewa_volume_generate_options(c.Structure):
    struct_size: int
    object: int
    dims: c.Array[c.c_uint32]
    size_world: float
    checks: float
    seed: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("object", c.c_int),
        ("dims", c.c_uint32 * 3),
        ("size_world", c.c_double),
        ("checks", c.c_double),
        ("seed", c.c_uint64),
    ]


class ewa_procedure_options(c.Structure):
    struct_size: int
    procedure: int
    frequency: float
    prefilter: float
    cutoff: float
    seed: int
    colors: c.Array[Any]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("procedure", c.c_int),
        ("frequency", c.c_double),
        ("prefilter", c.c_double),
        ("cutoff", c.c_double),
        ("seed", c.c_uint64),
        ("colors", (c.c_float * 3) * 2),
    ]


class ewa_profile(c.Structure):
    context: int | None
    points: int | None
    srgb: int | None
    length_world: float
    up_world: c.Array[c.c_double]
    unit: bytes | None
    _fields_ = [
        ("context", c.c_void_p),
        ("points", c.c_void_p),
        ("srgb", c.c_void_p),
        ("length_world", c.c_double),
        ("up_world", c.c_double * 3),
        ("unit", c.c_char_p),
    ]


class ewa_profile_graph_options(c.Structure):
    struct_size: int
    exaggeration: float
    point_size_px: float
    pixel_scale: float
    title: bytes | None
    unit: bytes | None
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("exaggeration", c.c_double),
        ("point_size_px", c.c_double),
        ("pixel_scale", c.c_double),
        ("title", c.c_char_p),
        ("unit", c.c_char_p),
    ]


class ewa_profile_options(c.Structure):
    struct_size: int
    width_world: float
    up_world: c.Array[c.c_double]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("width_world", c.c_double),
        ("up_world", c.c_double * 3),
    ]


class ewa_region(c.Structure):
    kept: bool
    has_box: bool
    has_classes: bool
    box_world: c.Array[c.c_double]
    box_axes_world: c.Array[c.c_double]
    corner_count: int
    outline_px: c.Array[c.c_double]
    world_to_picture: c.Array[c.c_double]
    classes: c.Array[c.c_uint32]
    _fields_ = [
        ("kept", c.c_bool),
        ("has_box", c.c_bool),
        ("has_classes", c.c_bool),
        ("box_world", c.c_double * 6),
        ("box_axes_world", c.c_double * 9),
        ("corner_count", c.c_uint32),
        ("outline_px", c.c_double * 128),
        ("world_to_picture", c.c_double * 12),
        ("classes", c.c_uint32 * 8),
    ]


class ewa_frame(c.Structure):
    rgba8: int | None
    rgba: int | None
    depth: int | None
    normal: int | None
    coverage: int | None
    _fields_ = [
        ("rgba8", c.c_void_p),
        ("rgba", c.c_void_p),
        ("depth", c.c_void_p),
        ("normal", c.c_void_p),
        ("coverage", c.c_void_p),
    ]


class ewa_render_options(c.Structure):
    struct_size: int
    kernel: int
    prefilter_px: float
    point_size_px: float
    tolerance: float
    passes: int
    edge_antialiasing: bool
    edge_threshold: float
    edge_layers: int
    opacity: float
    layers: int
    cull: int
    shading: int
    lights: c.Array[ewa_light]
    light_count: int
    ambient: float
    materials: Any
    material_count: int
    environment: int | None
    environment_up: c.Array[c.c_double]
    eye_dome: float
    background: c.Array[c.c_float]
    section_planes: c.Array[Any]
    section_count: int
    level: int
    budget_s: float
    supersampling: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("kernel", c.c_int),
        ("prefilter_px", c.c_double),
        ("point_size_px", c.c_double),
        ("tolerance", c.c_double),
        ("passes", c.c_uint32),
        ("edge_antialiasing", c.c_bool),
        ("edge_threshold", c.c_double),
        ("edge_layers", c.c_uint32),
        ("opacity", c.c_double),
        ("layers", c.c_uint32),
        ("cull", c.c_int),
        ("shading", c.c_int),
        ("lights", ewa_light * 8),
        ("light_count", c.c_uint32),
        ("ambient", c.c_double),
        ("materials", c.POINTER(ewa_material)),
        ("material_count", c.c_uint32),
        ("environment", c.c_void_p),
        ("environment_up", c.c_double * 3),
        ("eye_dome", c.c_double),
        ("background", c.c_float * 4),
        ("section_planes", (c.c_double * 4) * 8),
        ("section_count", c.c_uint32),
        ("level", c.c_uint32),
        ("budget_s", c.c_double),
        ("supersampling", c.c_uint32),
    ]


class ewa_surfels_info(c.Structure):
    point_count: int
    left_out_count: int
    resident_bytes: int
    unit_coverage: float
    transparent: bool
    bounds: ewa_bounds
    material_count: int
    level_count: int
    _fields_ = [
        ("point_count", c.c_uint64),
        ("left_out_count", c.c_uint64),
        ("resident_bytes", c.c_size_t),
        ("unit_coverage", c.c_double),
        ("transparent", c.c_bool),
        ("bounds", ewa_bounds),
        ("material_count", c.c_uint32),
        ("level_count", c.c_uint32),
    ]


class ewa_surfels_options(c.Structure):
    struct_size: int
    cutoff: float
    radius_scale: float
    level_count: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("cutoff", c.c_double),
        ("radius_scale", c.c_double),
        ("level_count", c.c_uint32),
    ]


class ewa_texture_options(c.Structure):
    struct_size: int
    method: int
    prefilter_px: float
    cutoff: float
    sigma_texels: float
    point_spacing_px: float
    repeat: bool
    background: c.Array[c.c_float]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("method", c.c_int),
        ("prefilter_px", c.c_double),
        ("cutoff", c.c_double),
        ("sigma_texels", c.c_double),
        ("point_spacing_px", c.c_double),
        ("repeat", c.c_bool),
        ("background", c.c_float * 4),
    ]


class ewa_texture_source(c.Structure):
    pixels: int | None
    format: int
    channel_count: int
    width_px: int
    height_px: int
    stride_bytes: int
    _fields_ = [
        ("pixels", c.c_void_p),
        ("format", c.c_int),
        ("channel_count", c.c_uint32),
        ("width_px", c.c_uint32),
        ("height_px", c.c_uint32),
        ("stride_bytes", c.c_size_t),
    ]


class ewa_texture_stats(c.Structure):
    splat_count: int
    point_count: int
    texel_count: int
    point_texel_count: int
    level_bytes: int
    levels_s: float
    total_s: float
    _fields_ = [
        ("splat_count", c.c_uint64),
        ("point_count", c.c_uint64),
        ("texel_count", c.c_uint64),
        ("point_texel_count", c.c_uint64),
        ("level_bytes", c.c_uint64),
        ("levels_s", c.c_double),
        ("total_s", c.c_double),
    ]


class ewa_texture_target(c.Structure):
    pixels: int | None
    format: int
    channel_count: int
    width_px: int
    height_px: int
    stride_bytes: int
    _fields_ = [
        ("pixels", c.c_void_p),
        ("format", c.c_int),
        ("channel_count", c.c_uint32),
        ("width_px", c.c_uint32),
        ("height_px", c.c_uint32),
        ("stride_bytes", c.c_size_t),
    ]


class ewa_asset_info(c.Structure):
    kind: int
    name: bytes | None
    count: int
    bounds: ewa_bounds
    cloud: int | None
    lod: int | None
    surfels: int | None
    splats: int | None
    voxels: int | None
    up_world: c.Array[c.c_double]
    load_s: float
    drawable: bool
    changeable: bool
    colorable: bool
    _fields_ = [
        ("kind", c.c_int),
        ("name", c.c_char_p),
        ("count", c.c_uint64),
        ("bounds", ewa_bounds),
        ("cloud", c.c_void_p),
        ("lod", c.c_void_p),
        ("surfels", c.c_void_p),
        ("splats", c.c_void_p),
        ("voxels", c.c_void_p),
        ("up_world", c.c_double * 3),
        ("load_s", c.c_double),
        ("drawable", c.c_bool),
        ("changeable", c.c_bool),
        ("colorable", c.c_bool),
    ]


class ewa_filter_range(c.Structure):
    low: float
    high: float
    low_open: bool
    high_open: bool
    _fields_ = [
        ("low", c.c_double),
        ("high", c.c_double),
        ("low_open", c.c_bool),
        ("high_open", c.c_bool),
    ]


class ewa_filter_term(c.Structure):
    name: bytes
    outside: bool
    range_count: int
    ranges: c.Array[ewa_filter_range]
    _fields_ = [
        ("name", c.c_char * 64),
        ("outside", c.c_bool),
        ("range_count", c.c_uint32),
        ("ranges", ewa_filter_range * 32),
    ]


class ewa_filter(c.Structure):
    term_count: int
    terms: c.Array[ewa_filter_term]
    _fields_ = [
        ("term_count", c.c_uint32),
        ("terms", ewa_filter_term * 16),
    ]


class ewa_asset_options(c.Structure):
    struct_size: int
    load: Any
    filter: Any
    to_world: c.Array[c.c_double]
    gaussians_as_surfels: bool
    gaussian_levels: bool
    levels: int
    cutoff: float
    transfer: bytes | None
    voxel_level_count: int
    voxel_level_minimum: int
    reach_steps: float
    own_context: bool
    reader: Any
    reader_user: int | None
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("load", c.POINTER(ewa_cloud_load_options)),
        ("filter", c.POINTER(ewa_filter)),
        ("to_world", c.c_double * 16),
        ("gaussians_as_surfels", c.c_bool),
        ("gaussian_levels", c.c_bool),
        ("levels", c.c_int),
        ("cutoff", c.c_double),
        ("transfer", c.c_char_p),
        ("voxel_level_count", c.c_uint32),
        ("voxel_level_minimum", c.c_uint32),
        ("reach_steps", c.c_double),
        ("own_context", c.c_bool),
        ("reader", ewa_asset_reader),
        ("reader_user", c.c_void_p),
    ]


class ewa_transfer_point(c.Structure):
    value: float
    color: c.Array[c.c_float]
    extinction: float
    _fields_ = [
        ("value", c.c_double),
        ("color", c.c_float * 3),
        ("extinction", c.c_float),
    ]


class ewa_transfer(c.Structure):
    points: c.Array[ewa_transfer_point]
    point_count: int
    unit_length_world: float
    gradient_low: float
    gradient_high: float
    _fields_ = [
        ("points", ewa_transfer_point * 1024),
        ("point_count", c.c_uint32),
        ("unit_length_world", c.c_double),
        ("gradient_low", c.c_double),
        ("gradient_high", c.c_double),
    ]


class ewa_volume(c.Structure):
    context: int | None
    dims: c.Array[c.c_uint32]
    type: int
    voxels: int | None
    index_to_world: c.Array[c.c_double]
    anatomical: bool
    _fields_ = [
        ("context", c.c_void_p),
        ("dims", c.c_uint32 * 3),
        ("type", c.c_int),
        ("voxels", c.c_void_p),
        ("index_to_world", c.c_double * 12),
        ("anatomical", c.c_bool),
    ]


class ewa_asset_source(c.Structure):
    name: bytes | None
    cloud: int | None
    surfels: int | None
    lod: int | None
    splats: int | None
    voxels: int | None
    mesh: Any
    gaussians: Any
    volume: Any
    transfer: Any
    outline: int | None
    up_world: c.Array[c.c_double]
    flat: bool
    release: Any
    user: int | None
    _fields_ = [
        ("name", c.c_char_p),
        ("cloud", c.c_void_p),
        ("surfels", c.c_void_p),
        ("lod", c.c_void_p),
        ("splats", c.c_void_p),
        ("voxels", c.c_void_p),
        ("mesh", c.POINTER(ewa_mesh)),
        ("gaussians", c.POINTER(ewa_gaussians)),
        ("volume", c.POINTER(ewa_volume)),
        ("transfer", c.POINTER(ewa_transfer)),
        ("outline", c.c_void_p),
        ("up_world", c.c_double * 3),
        ("flat", c.c_bool),
        ("release", c.CFUNCTYPE(None, c.c_void_p)),
        ("user", c.c_void_p),
    ]


class ewa_instance(c.Structure):
    struct_size: int
    visible: bool
    opacity: float
    radius_scale: float
    material: int
    coloring: ewa_coloring
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("visible", c.c_bool),
        ("opacity", c.c_double),
        ("radius_scale", c.c_double),
        ("material", c.c_uint32),
        ("coloring", ewa_coloring),
    ]


class ewa_photo_comparison(c.Structure):
    photo: ewa_image
    picture: ewa_image
    quality: ewa_image_quality
    _fields_ = [
        ("photo", ewa_image),
        ("picture", ewa_image),
        ("quality", ewa_image_quality),
    ]


class ewa_scene_hit(c.Structure):
    hit: bool
    depth: float
    place_world: c.Array[c.c_double]
    has_point: bool
    instance: int
    point: int
    point_world: c.Array[c.c_double]
    points: int | None
    _fields_ = [
        ("hit", c.c_bool),
        ("depth", c.c_double),
        ("place_world", c.c_double * 3),
        ("has_point", c.c_bool),
        ("instance", c.c_uint32),
        ("point", c.c_uint64),
        ("point_world", c.c_double * 3),
        ("points", c.c_void_p),
    ]


class ewa_scene_info(c.Structure):
    instance_count: int
    visible_count: int
    point_count: int
    surfaces: bool
    octrees: bool
    gaussians: bool
    volumes: bool
    gaussian_levels: bool
    surfels: ewa_surfels_info
    resident: int | None
    unit: bytes | None
    estimated_count: int
    load_s: float
    estimate_s: float
    surfels_s: float
    _fields_ = [
        ("instance_count", c.c_uint32),
        ("visible_count", c.c_uint32),
        ("point_count", c.c_uint64),
        ("surfaces", c.c_bool),
        ("octrees", c.c_bool),
        ("gaussians", c.c_bool),
        ("volumes", c.c_bool),
        ("gaussian_levels", c.c_bool),
        ("surfels", ewa_surfels_info),
        ("resident", c.c_void_p),
        ("unit", c.c_char_p),
        ("estimated_count", c.c_uint64),
        ("load_s", c.c_double),
        ("estimate_s", c.c_double),
        ("surfels_s", c.c_double),
    ]


class ewa_scene_options(c.Structure):
    struct_size: int
    up: int
    close_gaps: bool
    keep_points: bool
    shade_volumes: bool
    surfels: ewa_surfels_options
    lod: ewa_lod_options
    render: ewa_render_options
    gaussians: ewa_gaussian_options
    volumes: ewa_volume_options
    regions: c.Array[ewa_region]
    region_count: int
    many_frames: bool
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("up", c.c_int),
        ("close_gaps", c.c_bool),
        ("keep_points", c.c_bool),
        ("shade_volumes", c.c_bool),
        ("surfels", ewa_surfels_options),
        ("lod", ewa_lod_options),
        ("render", ewa_render_options),
        ("gaussians", ewa_gaussian_options),
        ("volumes", ewa_volume_options),
        ("regions", ewa_region * 16),
        ("region_count", c.c_uint32),
        ("many_frames", c.c_bool),
    ]


class ewa_scene_stats(c.Structure):
    render: ewa_render_stats
    lod: ewa_lod_stats
    volumes: ewa_volume_stats
    total_s: float
    _fields_ = [
        ("render", ewa_render_stats),
        ("lod", ewa_lod_stats),
        ("volumes", ewa_volume_stats),
        ("total_s", c.c_double),
    ]


class ewa_view_info(c.Structure):
    upright: ewa_upright
    up_world: c.Array[c.c_double]
    pivot_world: c.Array[c.c_double]
    trimmed: bool
    _fields_ = [
        ("upright", ewa_upright),
        ("up_world", c.c_double * 3),
        ("pivot_world", c.c_double * 3),
        ("trimmed", c.c_bool),
    ]


class ewa_view_options(c.Structure):
    struct_size: int
    width_px: int
    height_px: int
    fov_deg: float
    ortho_height_world: float
    view: int
    up_world: c.Array[c.c_double]
    has_eye: bool
    has_target: bool
    eye_world: c.Array[c.c_double]
    target_world: c.Array[c.c_double]
    azimuth_deg: float
    elevation_deg: float
    turntable: bool
    direction_world: c.Array[c.c_double]
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("width_px", c.c_uint32),
        ("height_px", c.c_uint32),
        ("fov_deg", c.c_double),
        ("ortho_height_world", c.c_double),
        ("view", c.c_int32),
        ("up_world", c.c_double * 3),
        ("has_eye", c.c_bool),
        ("has_target", c.c_bool),
        ("eye_world", c.c_double * 3),
        ("target_world", c.c_double * 3),
        ("azimuth_deg", c.c_double),
        ("elevation_deg", c.c_double),
        ("turntable", c.c_bool),
        ("direction_world", c.c_double * 3),
    ]


class ewa_scene_entry(c.Structure):
    path: bytes | None
    asset: ewa_asset_options
    instance: ewa_instance
    _fields_ = [
        ("path", c.c_char_p),
        ("asset", ewa_asset_options),
        ("instance", ewa_instance),
    ]


class ewa_scalar(c.Structure):
    attribute: ewa_attribute
    component: int
    shift_world: float
    grid: ewa_coordinate_grid
    _fields_ = [
        ("attribute", ewa_attribute),
        ("component", c.c_uint32),
        ("shift_world", c.c_double),
        ("grid", ewa_coordinate_grid),
    ]


class ewa_volume_facts(c.Structure):
    voxel_count: int
    finite_count: int
    low: float
    high: float
    mean: float
    histogram: c.Array[c.c_uint64]
    spacing_world: c.Array[c.c_double]
    low_world: c.Array[c.c_double]
    high_world: c.Array[c.c_double]
    _fields_ = [
        ("voxel_count", c.c_uint64),
        ("finite_count", c.c_uint64),
        ("low", c.c_double),
        ("high", c.c_double),
        ("mean", c.c_double),
        ("histogram", c.c_uint64 * 256),
        ("spacing_world", c.c_double * 3),
        ("low_world", c.c_double * 3),
        ("high_world", c.c_double * 3),
    ]


class ewa_voxels_info(c.Structure):
    voxel_count: int
    occupied_count: int
    block_count: int
    skipped_count: int
    level_count: int
    resident_bytes: int
    bounds: ewa_bounds
    spacing_world: float
    _fields_ = [
        ("voxel_count", c.c_uint64),
        ("occupied_count", c.c_uint64),
        ("block_count", c.c_uint64),
        ("skipped_count", c.c_uint64),
        ("level_count", c.c_uint32),
        ("resident_bytes", c.c_size_t),
        ("bounds", ewa_bounds),
        ("spacing_world", c.c_double),
    ]


class ewa_voxels_options(c.Structure):
    struct_size: int
    level_count: int
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("level_count", c.c_uint32),
    ]


class ewa_depth_image(c.Structure):
    camera: ewa_camera
    depth: int | None
    depth_type: int
    depth_stride_bytes: int
    kind: int
    depth_scale: float
    baseline_world: float
    disparity_offset_px: float
    color: int | None
    color_type: int
    color_channel_count: int
    color_stride_bytes: int
    _fields_ = [
        ("camera", ewa_camera),
        ("depth", c.c_void_p),
        ("depth_type", c.c_int),
        ("depth_stride_bytes", c.c_size_t),
        ("kind", c.c_int),
        ("depth_scale", c.c_double),
        ("baseline_world", c.c_double),
        ("disparity_offset_px", c.c_double),
        ("color", c.c_void_p),
        ("color_type", c.c_int),
        ("color_channel_count", c.c_uint32),
        ("color_stride_bytes", c.c_size_t),
    ]


class ewa_warp_facts(c.Structure):
    pixel_count: int
    sample_count: int
    flying_count: int
    take_s: float
    _fields_ = [
        ("pixel_count", c.c_uint64),
        ("sample_count", c.c_uint64),
        ("flying_count", c.c_uint64),
        ("take_s", c.c_double),
    ]


class ewa_warp_options(c.Structure):
    struct_size: int
    cutoff: float
    radius_spacings: float
    depth_jump: float
    depth_noise: float
    drop_flying: bool
    nearest_world: float
    farthest_world: float
    _fields_ = [
        ("struct_size", c.c_size_t),
        ("cutoff", c.c_double),
        ("radius_spacings", c.c_double),
        ("depth_jump", c.c_double),
        ("depth_noise", c.c_double),
        ("drop_flying", c.c_bool),
        ("nearest_world", c.c_double),
        ("farthest_world", c.c_double),
    ]


#: Tables of options that the library exports.
TABLES = (
    "ewa_acquire_options_table",
    "ewa_coloring_table",
    "ewa_furniture_options_table",
    "ewa_gaussians_save_options_table",
    "ewa_gaussian_options_table",
    "ewa_cloud_load_options_table",
    "ewa_cloud_save_options_table",
    "ewa_image_save_options_table",
    "ewa_volume_load_options_table",
    "ewa_volume_save_options_table",
    "ewa_lod_options_table",
    "ewa_lod_build_options_table",
    "ewa_mesh_sample_options_table",
    "ewa_context_options_table",
    "ewa_limits_table",
    "ewa_panorama_options_table",
    "ewa_photos_options_table",
    "ewa_estimate_options_table",
    "ewa_csg_options_table",
    "ewa_feature_options_table",
    "ewa_refit_options_table",
    "ewa_generate_options_table",
    "ewa_volume_generate_options_table",
    "ewa_procedure_options_table",
    "ewa_profile_options_table",
    "ewa_profile_graph_options_table",
    "ewa_surfels_options_table",
    "ewa_render_options_table",
    "ewa_texture_options_table",
    "ewa_asset_options_table",
    "ewa_scene_options_table",
    "ewa_instance_table",
    "ewa_view_options_table",
    "ewa_material_table",
    "ewa_voxels_options_table",
    "ewa_volume_options_table",
    "ewa_warp_options_table",
)


class Functions:
    """Every function of the library, with the types of its arguments."""

    def __init__(self, library: c.CDLL) -> None:
        def bind(name: str, result: Any, *parameters: Any) -> Any:
            function = getattr(library, name)
            function.restype = result
            function.argtypes = parameters
            return function

        self.ewa_context_cpu_features: Callable[..., int] = bind("ewa_context_cpu_features", c.c_uint32, c.c_void_p)
        self.ewa_context_create: Callable[..., int] = bind("ewa_context_create", c.c_int, c.POINTER(ewa_context_options), c.c_void_p)
        self.ewa_context_destroy: Callable[..., None] = bind("ewa_context_destroy", None, c.c_void_p)
        self.ewa_context_options_init: Callable[..., None] = bind("ewa_context_options_init", None, c.POINTER(ewa_context_options), c.c_size_t)
        self.ewa_context_worker_count: Callable[..., int] = bind("ewa_context_worker_count", c.c_uint32, c.c_void_p)
        self.ewa_status_name: Callable[..., bytes | None] = bind("ewa_status_name", c.c_char_p, c.c_int)
        self.ewa_type_bytes: Callable[..., int] = bind("ewa_type_bytes", c.c_size_t, c.c_int)
        self.ewa_type_name: Callable[..., bytes | None] = bind("ewa_type_name", c.c_char_p, c.c_int)
        self.ewa_version: Callable[..., bytes | None] = bind("ewa_version", c.c_char_p)
        self.ewa_acquire_options_init: Callable[..., None] = bind("ewa_acquire_options_init", None, c.POINTER(ewa_acquire_options), c.c_size_t)
        self.ewa_cloud_acquire: Callable[..., int] = bind("ewa_cloud_acquire", c.c_int, c.c_void_p, c.POINTER(ewa_image), c.c_uint32, c.POINTER(ewa_acquire_options), c.POINTER(ewa_acquire_report))
        self.ewa_render_backward: Callable[..., int] = bind("ewa_render_backward", c.c_int, c.c_void_p, c.POINTER(ewa_surfels_options), c.c_double, c.POINTER(ewa_camera), c.POINTER(ewa_render_options), c.POINTER(ewa_frame_cotangent), c.POINTER(ewa_gradient))
        self.ewa_camera_check: Callable[..., int] = bind("ewa_camera_check", c.c_int, c.c_void_p, c.POINTER(ewa_camera))
        self.ewa_camera_eye: Callable[..., None] = bind("ewa_camera_eye", None, c.POINTER(ewa_camera), c.c_void_p)
        self.ewa_camera_frame: Callable[..., int] = bind("ewa_camera_frame", c.c_int, c.POINTER(ewa_camera), c.POINTER(ewa_bounds), c.c_void_p, c.c_void_p, c.c_double)
        self.ewa_camera_init: Callable[..., None] = bind("ewa_camera_init", None, c.POINTER(ewa_camera))
        self.ewa_camera_look_at: Callable[..., int] = bind("ewa_camera_look_at", c.c_int, c.POINTER(ewa_camera), c.c_void_p, c.c_void_p, c.c_void_p)
        self.ewa_camera_orbit: Callable[..., int] = bind("ewa_camera_orbit", c.c_int, c.POINTER(ewa_camera), c.c_void_p, c.c_void_p, c.c_double)
        self.ewa_camera_path_at: Callable[..., int] = bind("ewa_camera_path_at", c.c_int, c.c_void_p, c.c_double, c.POINTER(ewa_camera))
        self.ewa_camera_path_create: Callable[..., int] = bind("ewa_camera_path_create", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.c_size_t, c.c_bool, c.c_void_p)
        self.ewa_camera_path_destroy: Callable[..., None] = bind("ewa_camera_path_destroy", None, c.c_void_p)
        self.ewa_camera_set_fov: Callable[..., int] = bind("ewa_camera_set_fov", c.c_int, c.POINTER(ewa_camera), c.c_double)
        self.ewa_camera_set_ortho: Callable[..., int] = bind("ewa_camera_set_ortho", c.c_int, c.POINTER(ewa_camera), c.c_double)
        self.ewa_attribute_read_f32: Callable[..., None] = bind("ewa_attribute_read_f32", None, c.POINTER(ewa_attribute), c.c_uint64, c.c_uint64, c.c_void_p)
        self.ewa_attribute_read_f64: Callable[..., None] = bind("ewa_attribute_read_f64", None, c.POINTER(ewa_attribute), c.c_uint64, c.c_uint64, c.c_void_p)
        self.ewa_cloud_add: Callable[..., int] = bind("ewa_cloud_add", c.c_int, c.c_void_p, c.c_char_p, c.c_int, c.c_uint32, c.c_void_p)
        self.ewa_cloud_attribute_at: Callable[..., Any] = bind("ewa_cloud_attribute_at", c.POINTER(ewa_attribute), c.c_void_p, c.c_uint32)
        self.ewa_cloud_attribute_count: Callable[..., int] = bind("ewa_cloud_attribute_count", c.c_uint32, c.c_void_p)
        self.ewa_cloud_borrow: Callable[..., int] = bind("ewa_cloud_borrow", c.c_int, c.c_void_p, c.c_char_p, c.c_int, c.c_uint32, c.c_void_p, c.c_size_t)
        self.ewa_cloud_create: Callable[..., int] = bind("ewa_cloud_create", c.c_int, c.c_void_p, c.c_uint64, c.c_void_p)
        self.ewa_cloud_destroy: Callable[..., None] = bind("ewa_cloud_destroy", None, c.c_void_p)
        self.ewa_cloud_find: Callable[..., Any] = bind("ewa_cloud_find", c.POINTER(ewa_attribute), c.c_void_p, c.c_char_p)
        self.ewa_cloud_grid: Callable[..., None] = bind("ewa_cloud_grid", None, c.c_void_p, c.POINTER(ewa_coordinate_grid))
        self.ewa_cloud_is_drawable: Callable[..., bool] = bind("ewa_cloud_is_drawable", c.c_bool, c.c_void_p)
        self.ewa_cloud_measure: Callable[..., int] = bind("ewa_cloud_measure", c.c_int, c.c_void_p, c.POINTER(ewa_bounds))
        self.ewa_cloud_merge: Callable[..., int] = bind("ewa_cloud_merge", c.c_int, c.c_void_p, c.c_uint32, c.c_void_p)
        self.ewa_cloud_note: Callable[..., bytes | None] = bind("ewa_cloud_note", c.c_char_p, c.c_void_p, c.c_char_p, c.c_void_p)
        self.ewa_cloud_note_name: Callable[..., bytes | None] = bind("ewa_cloud_note_name", c.c_char_p, c.c_void_p, c.c_uint32)
        self.ewa_cloud_origin: Callable[..., None] = bind("ewa_cloud_origin", None, c.c_void_p, c.c_void_p)
        self.ewa_cloud_point_count: Callable[..., int] = bind("ewa_cloud_point_count", c.c_uint64, c.c_void_p)
        self.ewa_cloud_remove: Callable[..., None] = bind("ewa_cloud_remove", None, c.c_void_p, c.c_char_p)
        self.ewa_cloud_select: Callable[..., int] = bind("ewa_cloud_select", c.c_int, c.c_void_p, c.c_void_p, c.c_uint64, c.c_void_p)
        self.ewa_cloud_set_grid: Callable[..., None] = bind("ewa_cloud_set_grid", None, c.c_void_p, c.POINTER(ewa_coordinate_grid))
        self.ewa_cloud_set_note: Callable[..., int] = bind("ewa_cloud_set_note", c.c_int, c.c_void_p, c.c_char_p, c.c_void_p, c.c_size_t)
        self.ewa_cloud_set_origin: Callable[..., None] = bind("ewa_cloud_set_origin", None, c.c_void_p, c.c_void_p)
        self.ewa_cloud_transform: Callable[..., int] = bind("ewa_cloud_transform", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_grid_world: Callable[..., float] = bind("ewa_grid_world", c.c_double, c.POINTER(ewa_coordinate_grid), c.c_uint32, c.c_double)
        self.ewa_exchange_add: Callable[..., int] = bind("ewa_exchange_add", c.c_int, c.c_void_p, c.POINTER(ewa_exchange), c.c_void_p, c.c_size_t)
        self.ewa_exchange_gather: Callable[..., int] = bind("ewa_exchange_gather", c.c_int, c.c_void_p, c.POINTER(ewa_exchange), c.c_void_p, c.c_size_t, c.c_void_p)
        self.ewa_renderer_create_joint: Callable[..., int] = bind("ewa_renderer_create_joint", c.c_int, c.c_void_p, c.POINTER(ewa_exchange), c.c_void_p)
        self.ewa_clouds_color: Callable[..., int] = bind("ewa_clouds_color", c.c_int, c.c_void_p, c.c_uint32, c.POINTER(ewa_coloring), c.POINTER(ewa_legend))
        self.ewa_coloring_init: Callable[..., None] = bind("ewa_coloring_init", None, c.POINTER(ewa_coloring), c.c_size_t)
        self.ewa_coloring_is_own: Callable[..., bool] = bind("ewa_coloring_is_own", c.c_bool, c.c_char_p)
        self.ewa_coloring_names_classes: Callable[..., bool] = bind("ewa_coloring_names_classes", c.c_bool, c.c_char_p)
        self.ewa_legend_free: Callable[..., None] = bind("ewa_legend_free", None, c.POINTER(ewa_legend))
        self.ewa_cloud_check_degrees: Callable[..., None] = bind("ewa_cloud_check_degrees", None, c.c_void_p)
        self.ewa_cloud_check_steps: Callable[..., None] = bind("ewa_cloud_check_steps", None, c.c_void_p)
        self.ewa_cloud_count_invalid_points: Callable[..., None] = bind("ewa_cloud_count_invalid_points", None, c.c_void_p, c.POINTER(ewa_cloud_invalid_points))
        self.ewa_cloud_drop_zero_normals: Callable[..., None] = bind("ewa_cloud_drop_zero_normals", None, c.c_void_p)
        self.ewa_cloud_find_degrees: Callable[..., bool] = bind("ewa_cloud_find_degrees", c.c_bool, c.c_void_p, c.c_void_p)
        self.ewa_cloud_find_gaussians: Callable[..., ewa_gaussian_columns] = bind("ewa_cloud_find_gaussians", ewa_gaussian_columns, c.c_void_p)
        self.ewa_cloud_refuse_gaussians: Callable[..., int] = bind("ewa_cloud_refuse_gaussians", c.c_int, c.c_void_p)
        self.ewa_cloud_report_invalid_points: Callable[..., int] = bind("ewa_cloud_report_invalid_points", c.c_int, c.c_void_p, c.POINTER(ewa_surfels_info))
        self.ewa_gaussian_columns_describe: Callable[..., None] = bind("ewa_gaussian_columns_describe", None, c.POINTER(ewa_gaussian_columns), c.c_void_p)
        self.ewa_framing_choose: Callable[..., None] = bind("ewa_framing_choose", None, c.c_void_p, c.c_int, c.POINTER(ewa_upright))
        self.ewa_framing_create: Callable[..., int] = bind("ewa_framing_create", c.c_int, c.c_void_p, c.c_double, c.c_void_p)
        self.ewa_framing_describe: Callable[..., None] = bind("ewa_framing_describe", None, c.c_void_p, c.POINTER(ewa_framing_info))
        self.ewa_framing_destroy: Callable[..., None] = bind("ewa_framing_destroy", None, c.c_void_p)
        self.ewa_framing_fit: Callable[..., int] = bind("ewa_framing_fit", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera))
        self.ewa_framing_revolve: Callable[..., int] = bind("ewa_framing_revolve", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p)
        self.ewa_framing_zoom: Callable[..., int] = bind("ewa_framing_zoom", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera))
        self.ewa_up_convention_of: Callable[..., int] = bind("ewa_up_convention_of", c.c_int, c.c_size_t, c.c_void_p)
        self.ewa_upright_describe: Callable[..., None] = bind("ewa_upright_describe", None, c.POINTER(ewa_upright), c.c_void_p)
        self.ewa_upright_look: Callable[..., None] = bind("ewa_upright_look", None, c.POINTER(ewa_upright), c.c_void_p, c.c_void_p)
        self.ewa_upright_place: Callable[..., bytes | None] = bind("ewa_upright_place", c.c_char_p, c.POINTER(ewa_upright))
        self.ewa_upright_turn: Callable[..., int] = bind("ewa_upright_turn", c.c_int, c.c_void_p, c.c_double, c.c_double, c.c_void_p, c.c_void_p)
        self.ewa_upright_view: Callable[..., int] = bind("ewa_upright_view", c.c_int, c.c_void_p, c.c_int)
        self.ewa_draw_line: Callable[..., None] = bind("ewa_draw_line", None, c.POINTER(ewa_canvas), c.c_double, c.c_double, c.c_double, c.c_double, c.c_double, c.c_void_p)
        self.ewa_draw_rectangle: Callable[..., None] = bind("ewa_draw_rectangle", None, c.POINTER(ewa_canvas), c.c_double, c.c_double, c.c_double, c.c_double, c.c_void_p)
        self.ewa_draw_text: Callable[..., None] = bind("ewa_draw_text", None, c.POINTER(ewa_canvas), c.c_char_p, c.c_double, c.c_double, c.POINTER(ewa_text_style))
        self.ewa_furniture_draw: Callable[..., int] = bind("ewa_furniture_draw", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_furniture_options), c.POINTER(ewa_canvas))
        self.ewa_furniture_options_init: Callable[..., None] = bind("ewa_furniture_options_init", None, c.POINTER(ewa_furniture_options), c.c_size_t)
        self.ewa_text_width_px: Callable[..., float] = bind("ewa_text_width_px", c.c_double, c.c_char_p, c.c_double)
        self.ewa_gaussians_add_classes: Callable[..., int] = bind("ewa_gaussians_add_classes", c.c_int, c.POINTER(ewa_gaussians))
        self.ewa_gaussians_create: Callable[..., int] = bind("ewa_gaussians_create", c.c_int, c.c_void_p, c.c_uint32, c.c_uint32, c.POINTER(ewa_gaussians))
        self.ewa_gaussians_free: Callable[..., None] = bind("ewa_gaussians_free", None, c.POINTER(ewa_gaussians))
        self.ewa_gaussians_keep: Callable[..., int] = bind("ewa_gaussians_keep", c.c_int, c.POINTER(ewa_gaussians), c.c_void_p, c.POINTER(ewa_gaussians))
        self.ewa_gaussians_measure: Callable[..., int] = bind("ewa_gaussians_measure", c.c_int, c.POINTER(ewa_gaussians), c.POINTER(ewa_bounds))
        self.ewa_gaussians_outline: Callable[..., int] = bind("ewa_gaussians_outline", c.c_int, c.POINTER(ewa_gaussians), c.POINTER(ewa_bounds), c.c_void_p)
        self.ewa_gaussians_to_cloud: Callable[..., int] = bind("ewa_gaussians_to_cloud", c.c_int, c.POINTER(ewa_gaussians), c.c_void_p)
        self.ewa_gaussians_transform: Callable[..., int] = bind("ewa_gaussians_transform", c.c_int, c.POINTER(ewa_gaussians), c.c_void_p)
        self.ewa_gaussian_format_name: Callable[..., bytes | None] = bind("ewa_gaussian_format_name", c.c_char_p, c.c_int)
        self.ewa_gaussians_convert: Callable[..., int] = bind("ewa_gaussians_convert", c.c_int, c.c_void_p, c.c_char_p, c.c_char_p, c.POINTER(ewa_gaussians_save_options), c.c_void_p)
        self.ewa_gaussians_format_of: Callable[..., int] = bind("ewa_gaussians_format_of", c.c_int, c.c_char_p)
        self.ewa_gaussians_load: Callable[..., int] = bind("ewa_gaussians_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_gaussians), c.POINTER(ewa_gaussian_facts))
        self.ewa_gaussians_load_memory: Callable[..., int] = bind("ewa_gaussians_load_memory", c.c_int, c.c_void_p, c.c_void_p, c.c_size_t, c.c_char_p, c.c_char_p, c.POINTER(ewa_gaussians), c.POINTER(ewa_gaussian_facts))
        self.ewa_gaussians_probe: Callable[..., int] = bind("ewa_gaussians_probe", c.c_int, c.c_void_p, c.c_char_p, c.c_void_p)
        self.ewa_gaussians_save: Callable[..., int] = bind("ewa_gaussians_save", c.c_int, c.POINTER(ewa_gaussians), c.c_char_p, c.POINTER(ewa_gaussians_save_options))
        self.ewa_gaussians_save_options_init: Callable[..., None] = bind("ewa_gaussians_save_options_init", None, c.POINTER(ewa_gaussians_save_options), c.c_size_t)
        self.ewa_gaussian_options_init: Callable[..., None] = bind("ewa_gaussian_options_init", None, c.POINTER(ewa_gaussian_options), c.c_size_t)
        self.ewa_gaussian_render: Callable[..., int] = bind("ewa_gaussian_render", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_gaussian_options), c.POINTER(ewa_frame), c.POINTER(ewa_gaussian_stats))
        self.ewa_gaussian_renderer_create: Callable[..., int] = bind("ewa_gaussian_renderer_create", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_gaussian_renderer_destroy: Callable[..., None] = bind("ewa_gaussian_renderer_destroy", None, c.c_void_p)
        self.ewa_splats_create: Callable[..., int] = bind("ewa_splats_create", c.c_int, c.POINTER(ewa_gaussians), c.c_bool, c.c_void_p)
        self.ewa_splats_describe: Callable[..., None] = bind("ewa_splats_describe", None, c.c_void_p, c.POINTER(ewa_splats_info))
        self.ewa_splats_destroy: Callable[..., None] = bind("ewa_splats_destroy", None, c.c_void_p)
        self.ewa_gpu_class_name: Callable[..., bytes | None] = bind("ewa_gpu_class_name", c.c_char_p, c.c_int)
        self.ewa_gpu_describe: Callable[..., int] = bind("ewa_gpu_describe", c.c_int, c.c_void_p, c.POINTER(ewa_gpu_info))
        self.ewa_renderer_create_on: Callable[..., int] = bind("ewa_renderer_create_on", c.c_int, c.c_void_p, c.c_int, c.c_void_p)
        self.ewa_renderer_describe: Callable[..., int] = bind("ewa_renderer_describe", c.c_int, c.c_void_p, c.POINTER(ewa_renderer_info))
        self.ewa_camera_clip_map: Callable[..., int] = bind("ewa_camera_clip_map", c.c_int, c.POINTER(ewa_camera), c.c_double, c.c_double, c.POINTER(ewa_mat4))
        self.ewa_clip_alphas: Callable[..., int] = bind("ewa_clip_alphas", c.c_int, ewa_vec4, ewa_vec4, c.c_void_p, c.c_void_p)
        self.ewa_clip_polygon: Callable[..., int] = bind("ewa_clip_polygon", c.c_int, c.POINTER(ewa_vec4), c.c_void_p, c.c_uint32, c.c_uint32, c.POINTER(ewa_vec4), c.c_void_p, c.c_void_p)
        self.ewa_clip_segment: Callable[..., int] = bind("ewa_clip_segment", c.c_int, ewa_vec4, ewa_vec4, c.POINTER(ewa_segment_part), c.c_void_p)
        self.ewa_clip_segments: Callable[..., int] = bind("ewa_clip_segments", c.c_int, c.c_void_p, c.POINTER(ewa_segment_batch), c.POINTER(ewa_segment_clips))
        self.ewa_conic_dual: Callable[..., ewa_conic] = bind("ewa_conic_dual", ewa_conic, c.POINTER(ewa_conic))
        self.ewa_conic_polar: Callable[..., ewa_vec3] = bind("ewa_conic_polar", ewa_vec3, c.POINTER(ewa_conic), ewa_vec3)
        self.ewa_conic_pull: Callable[..., ewa_conic] = bind("ewa_conic_pull", ewa_conic, c.POINTER(ewa_conic), c.POINTER(ewa_mat3))
        self.ewa_conic_transform: Callable[..., int] = bind("ewa_conic_transform", c.c_int, c.POINTER(ewa_conic), c.POINTER(ewa_mat3), c.POINTER(ewa_conic))
        self.ewa_conic_value: Callable[..., float] = bind("ewa_conic_value", c.c_double, c.POINTER(ewa_conic), ewa_vec3)
        self.ewa_dual_conic_ellipse: Callable[..., int] = bind("ewa_dual_conic_ellipse", c.c_int, c.POINTER(ewa_conic), c.c_void_p, c.c_void_p)
        self.ewa_dual_conic_transform: Callable[..., ewa_conic] = bind("ewa_dual_conic_transform", ewa_conic, c.POINTER(ewa_conic), c.POINTER(ewa_mat3))
        self.ewa_hyperbolic_alpha: Callable[..., int] = bind("ewa_hyperbolic_alpha", c.c_int, c.c_double, c.c_double, c.c_double, c.c_void_p)
        self.ewa_hyperbolic_at: Callable[..., int] = bind("ewa_hyperbolic_at", c.c_int, ewa_vec3, ewa_vec3, c.c_double, c.c_double, c.c_void_p)
        self.ewa_hyperbolic_fit: Callable[..., int] = bind("ewa_hyperbolic_fit", c.c_int, c.POINTER(ewa_vec4), c.c_void_p, c.c_uint32, c.POINTER(ewa_vec3), c.POINTER(ewa_vec3))
        self.ewa_incidence2: Callable[..., float] = bind("ewa_incidence2", c.c_double, ewa_vec3, ewa_vec3)
        self.ewa_incidence3: Callable[..., float] = bind("ewa_incidence3", c.c_double, ewa_vec4, ewa_vec4)
        self.ewa_line2_distance: Callable[..., int] = bind("ewa_line2_distance", c.c_int, ewa_vec3, ewa_vec3, c.c_void_p)
        self.ewa_line2_join: Callable[..., int] = bind("ewa_line2_join", c.c_int, ewa_vec3, ewa_vec3, c.POINTER(ewa_vec3))
        self.ewa_line2_meet: Callable[..., int] = bind("ewa_line2_meet", c.c_int, ewa_vec3, ewa_vec3, c.POINTER(ewa_vec3))
        self.ewa_line2_pull: Callable[..., ewa_vec3] = bind("ewa_line2_pull", ewa_vec3, ewa_vec3, c.POINTER(ewa_mat3))
        self.ewa_line2_transform: Callable[..., int] = bind("ewa_line2_transform", c.c_int, ewa_vec3, c.POINTER(ewa_mat3), c.POINTER(ewa_vec3))
        self.ewa_line3_incidence: Callable[..., float] = bind("ewa_line3_incidence", c.c_double, ewa_line3, ewa_line3)
        self.ewa_line3_join: Callable[..., int] = bind("ewa_line3_join", c.c_int, ewa_vec4, ewa_vec4, c.POINTER(ewa_line3))
        self.ewa_line3_join_point: Callable[..., int] = bind("ewa_line3_join_point", c.c_int, ewa_line3, ewa_vec4, c.POINTER(ewa_vec4))
        self.ewa_line3_meet: Callable[..., int] = bind("ewa_line3_meet", c.c_int, ewa_vec4, ewa_vec4, c.POINTER(ewa_line3))
        self.ewa_line3_meet_plane: Callable[..., int] = bind("ewa_line3_meet_plane", c.c_int, ewa_line3, ewa_vec4, c.POINTER(ewa_vec4))
        self.ewa_line3_transform: Callable[..., ewa_line3] = bind("ewa_line3_transform", ewa_line3, ewa_line3, c.POINTER(ewa_mat4))
        self.ewa_mat3_concatenate: Callable[..., ewa_mat3] = bind("ewa_mat3_concatenate", ewa_mat3, c.POINTER(ewa_mat3), c.POINTER(ewa_mat3))
        self.ewa_mat3_invert: Callable[..., int] = bind("ewa_mat3_invert", c.c_int, c.POINTER(ewa_mat3), c.POINTER(ewa_mat3))
        self.ewa_mat4_concatenate: Callable[..., ewa_mat4] = bind("ewa_mat4_concatenate", ewa_mat4, c.POINTER(ewa_mat4), c.POINTER(ewa_mat4))
        self.ewa_mat4_invert: Callable[..., int] = bind("ewa_mat4_invert", c.c_int, c.POINTER(ewa_mat4), c.POINTER(ewa_mat4))
        self.ewa_plane_distance: Callable[..., int] = bind("ewa_plane_distance", c.c_int, ewa_vec4, ewa_vec4, c.c_void_p)
        self.ewa_plane_join: Callable[..., int] = bind("ewa_plane_join", c.c_int, ewa_vec4, ewa_vec4, ewa_vec4, c.POINTER(ewa_vec4))
        self.ewa_plane_meet: Callable[..., int] = bind("ewa_plane_meet", c.c_int, ewa_vec4, ewa_vec4, ewa_vec4, c.POINTER(ewa_vec4))
        self.ewa_plane_pull: Callable[..., ewa_vec4] = bind("ewa_plane_pull", ewa_vec4, ewa_vec4, c.POINTER(ewa_mat4))
        self.ewa_plane_transform: Callable[..., int] = bind("ewa_plane_transform", c.c_int, ewa_vec4, c.POINTER(ewa_mat4), c.POINTER(ewa_vec4))
        self.ewa_point2_divide: Callable[..., int] = bind("ewa_point2_divide", c.c_int, ewa_vec3, c.c_void_p)
        self.ewa_point2_transform: Callable[..., ewa_vec3] = bind("ewa_point2_transform", ewa_vec3, ewa_vec3, c.POINTER(ewa_mat3))
        self.ewa_point3_divide: Callable[..., int] = bind("ewa_point3_divide", c.c_int, ewa_vec4, c.c_void_p)
        self.ewa_point3_transform: Callable[..., ewa_vec4] = bind("ewa_point3_transform", ewa_vec4, ewa_vec4, c.POINTER(ewa_mat4))
        self.ewa_triangle_barycentric: Callable[..., int] = bind("ewa_triangle_barycentric", c.c_int, c.POINTER(ewa_vec3), ewa_vec3, c.c_void_p)
        self.ewa_triangle_distances: Callable[..., int] = bind("ewa_triangle_distances", c.c_int, c.POINTER(ewa_vec3), ewa_vec3, c.c_void_p)
        self.ewa_triangle_point: Callable[..., int] = bind("ewa_triangle_point", c.c_int, c.POINTER(ewa_vec3), c.c_void_p, c.POINTER(ewa_vec3))
        self.ewa_triangle_point_from_distances: Callable[..., int] = bind("ewa_triangle_point_from_distances", c.c_int, c.POINTER(ewa_vec3), c.c_void_p, c.POINTER(ewa_vec3))
        self.ewa_class_color: Callable[..., None] = bind("ewa_class_color", None, c.c_uint32, c.c_void_p)
        self.ewa_class_find: Callable[..., bool] = bind("ewa_class_find", c.c_bool, c.c_char_p, c.c_void_p)
        self.ewa_class_name: Callable[..., None] = bind("ewa_class_name", None, c.c_uint32, c.c_void_p)
        self.ewa_colormap_color: Callable[..., None] = bind("ewa_colormap_color", None, c.c_int, c.c_double, c.c_void_p)
        self.ewa_image_create: Callable[..., int] = bind("ewa_image_create", c.c_int, c.c_void_p, c.c_uint32, c.c_uint32, c.c_uint32, c.POINTER(ewa_image))
        self.ewa_image_free: Callable[..., None] = bind("ewa_image_free", None, c.POINTER(ewa_image))
        self.ewa_linear_from_srgb: Callable[..., float] = bind("ewa_linear_from_srgb", c.c_float, c.c_float)
        self.ewa_srgb_from_linear: Callable[..., float] = bind("ewa_srgb_from_linear", c.c_float, c.c_float)
        self.ewa_camera_load: Callable[..., int] = bind("ewa_camera_load", c.c_int, c.c_void_p, c.c_char_p, c.c_uint32, c.POINTER(ewa_camera))
        self.ewa_camera_load_each: Callable[..., int] = bind("ewa_camera_load_each", c.c_int, c.c_void_p, c.c_char_p, ewa_camera_callback, c.c_void_p)
        self.ewa_camera_load_lens: Callable[..., int] = bind("ewa_camera_load_lens", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_camera))
        self.ewa_camera_load_poses: Callable[..., int] = bind("ewa_camera_load_poses", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_camera), ewa_camera_callback, c.c_void_p)
        self.ewa_camera_save: Callable[..., int] = bind("ewa_camera_save", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.c_char_p)
        self.ewa_camera_save_list: Callable[..., int] = bind("ewa_camera_save_list", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.c_size_t, c.c_char_p)
        self.ewa_cloud_load: Callable[..., int] = bind("ewa_cloud_load", c.c_int, c.c_void_p, c.c_char_p, c.c_void_p)
        self.ewa_cloud_load_memory: Callable[..., int] = bind("ewa_cloud_load_memory", c.c_int, c.c_void_p, c.c_void_p, c.c_size_t, c.c_char_p, c.c_void_p)
        self.ewa_cloud_load_options_init: Callable[..., None] = bind("ewa_cloud_load_options_init", None, c.POINTER(ewa_cloud_load_options), c.c_size_t)
        self.ewa_cloud_reader_close: Callable[..., None] = bind("ewa_cloud_reader_close", None, c.c_void_p)
        self.ewa_cloud_reader_lost_count: Callable[..., int] = bind("ewa_cloud_reader_lost_count", c.c_uint64, c.c_void_p)
        self.ewa_cloud_reader_maximum_points: Callable[..., int] = bind("ewa_cloud_reader_maximum_points", c.c_uint64, c.c_void_p)
        self.ewa_cloud_reader_next: Callable[..., int] = bind("ewa_cloud_reader_next", c.c_int, c.c_void_p, c.c_uint64, c.c_void_p)
        self.ewa_cloud_reader_open: Callable[..., int] = bind("ewa_cloud_reader_open", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_cloud_load_options), c.c_void_p)
        self.ewa_cloud_reader_prototype: Callable[..., int | None] = bind("ewa_cloud_reader_prototype", c.c_void_p, c.c_void_p)
        self.ewa_cloud_save: Callable[..., int] = bind("ewa_cloud_save", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_cloud_save_options))
        self.ewa_cloud_save_options_init: Callable[..., None] = bind("ewa_cloud_save_options_init", None, c.POINTER(ewa_cloud_save_options), c.c_size_t)
        self.ewa_cloud_writer_abort: Callable[..., None] = bind("ewa_cloud_writer_abort", None, c.c_void_p)
        self.ewa_cloud_writer_commit: Callable[..., int] = bind("ewa_cloud_writer_commit", c.c_int, c.c_void_p)
        self.ewa_cloud_writer_needs_bounds: Callable[..., bool] = bind("ewa_cloud_writer_needs_bounds", c.c_bool, c.c_char_p, c.c_void_p)
        self.ewa_cloud_writer_open: Callable[..., int] = bind("ewa_cloud_writer_open", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_cloud_save_options), c.c_void_p, c.c_uint64, c.POINTER(ewa_bounds), c.c_void_p)
        self.ewa_cloud_writer_put: Callable[..., int] = bind("ewa_cloud_writer_put", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_depth_load: Callable[..., int] = bind("ewa_depth_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_image))
        self.ewa_depth_load_memory: Callable[..., int] = bind("ewa_depth_load_memory", c.c_int, c.c_void_p, c.c_void_p, c.c_size_t, c.c_char_p, c.POINTER(ewa_image))
        self.ewa_elements_face_count: Callable[..., int] = bind("ewa_elements_face_count", c.c_uint64, c.c_void_p)
        self.ewa_elements_free: Callable[..., None] = bind("ewa_elements_free", None, c.c_void_p)
        self.ewa_image_load: Callable[..., int] = bind("ewa_image_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_image))
        self.ewa_image_load_memory: Callable[..., int] = bind("ewa_image_load_memory", c.c_int, c.c_void_p, c.c_void_p, c.c_size_t, c.c_char_p, c.POINTER(ewa_image))
        self.ewa_image_save: Callable[..., int] = bind("ewa_image_save", c.c_int, c.POINTER(ewa_image), c.c_char_p, c.POINTER(ewa_image_save_options))
        self.ewa_image_save_options_init: Callable[..., None] = bind("ewa_image_save_options_init", None, c.POINTER(ewa_image_save_options), c.c_size_t)
        self.ewa_jpeg_save: Callable[..., int] = bind("ewa_jpeg_save", c.c_int, c.c_void_p, c.c_char_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p, c.c_size_t)
        self.ewa_materials_load: Callable[..., int] = bind("ewa_materials_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_material), c.c_void_p)
        self.ewa_parts: Callable[..., bytes | None] = bind("ewa_parts", c.c_char_p)
        self.ewa_photo_list_destroy: Callable[..., None] = bind("ewa_photo_list_destroy", None, c.c_void_p)
        self.ewa_photo_list_find_masks: Callable[..., int] = bind("ewa_photo_list_find_masks", c.c_int, c.c_void_p, c.c_char_p)
        self.ewa_photo_list_load: Callable[..., int] = bind("ewa_photo_list_load", c.c_int, c.c_void_p, c.c_char_p, c.c_char_p, c.c_void_p)
        self.ewa_photo_list_photos: Callable[..., Any] = bind("ewa_photo_list_photos", c.POINTER(ewa_photo), c.c_void_p, c.c_void_p)
        self.ewa_pixels_save: Callable[..., int] = bind("ewa_pixels_save", c.c_int, c.c_void_p, c.c_char_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p, c.c_size_t)
        self.ewa_ply_describe: Callable[..., int] = bind("ewa_ply_describe", c.c_int, c.c_void_p, c.c_char_p, ewa_line_callback, c.c_void_p)
        self.ewa_png_save: Callable[..., int] = bind("ewa_png_save", c.c_int, c.c_void_p, c.c_char_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p, c.c_size_t)
        self.ewa_transfer_choose: Callable[..., int] = bind("ewa_transfer_choose", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_volume), c.POINTER(ewa_transfer))
        self.ewa_transfer_load: Callable[..., int] = bind("ewa_transfer_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_transfer))
        self.ewa_transfer_save: Callable[..., int] = bind("ewa_transfer_save", c.c_int, c.c_void_p, c.POINTER(ewa_transfer), c.c_char_p)
        self.ewa_volume_is_file: Callable[..., bool] = bind("ewa_volume_is_file", c.c_bool, c.c_void_p, c.c_char_p)
        self.ewa_volume_is_named: Callable[..., bool] = bind("ewa_volume_is_named", c.c_bool, c.c_char_p)
        self.ewa_volume_load: Callable[..., int] = bind("ewa_volume_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_volume_load_options), c.POINTER(ewa_volume))
        self.ewa_volume_load_memory: Callable[..., int] = bind("ewa_volume_load_memory", c.c_int, c.c_void_p, c.c_void_p, c.c_size_t, c.c_char_p, c.POINTER(ewa_volume_load_options), c.POINTER(ewa_volume))
        self.ewa_volume_load_options_init: Callable[..., None] = bind("ewa_volume_load_options_init", None, c.POINTER(ewa_volume_load_options), c.c_size_t)
        self.ewa_volume_save: Callable[..., int] = bind("ewa_volume_save", c.c_int, c.POINTER(ewa_volume), c.c_char_p, c.POINTER(ewa_volume_save_options))
        self.ewa_volume_save_options_init: Callable[..., None] = bind("ewa_volume_save_options_init", None, c.POINTER(ewa_volume_save_options), c.c_size_t)
        self.ewa_lod_build: Callable[..., int] = bind("ewa_lod_build", c.c_int, c.c_void_p, c.c_void_p, c.c_uint32, c.c_char_p, c.POINTER(ewa_lod_build_options), c.POINTER(ewa_lod_build_stats))
        self.ewa_lod_build_options_init: Callable[..., None] = bind("ewa_lod_build_options_init", None, c.POINTER(ewa_lod_build_options), c.c_size_t)
        self.ewa_lod_close: Callable[..., None] = bind("ewa_lod_close", None, c.c_void_p)
        self.ewa_lod_describe: Callable[..., None] = bind("ewa_lod_describe", None, c.c_void_p, c.POINTER(ewa_lod_info))
        self.ewa_lod_is_folder: Callable[..., bool] = bind("ewa_lod_is_folder", c.c_bool, c.c_void_p, c.c_char_p)
        self.ewa_lod_merge: Callable[..., int] = bind("ewa_lod_merge", c.c_int, c.c_void_p, c.c_void_p, c.c_uint32, c.c_char_p, c.POINTER(ewa_lod_build_stats))
        self.ewa_lod_open: Callable[..., int] = bind("ewa_lod_open", c.c_int, c.c_void_p, c.c_char_p, c.c_void_p)
        self.ewa_lod_options_init: Callable[..., None] = bind("ewa_lod_options_init", None, c.POINTER(ewa_lod_options), c.c_size_t)
        self.ewa_lod_probe: Callable[..., bool] = bind("ewa_lod_probe", c.c_bool, c.c_void_p, c.c_char_p)
        self.ewa_lod_read: Callable[..., int] = bind("ewa_lod_read", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.c_double, c.c_void_p)
        self.ewa_lod_render: Callable[..., int] = bind("ewa_lod_render", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_render_options), c.POINTER(ewa_lod_options), c.POINTER(ewa_frame), c.POINTER(ewa_lod_stats))
        self.ewa_lod_sample: Callable[..., int] = bind("ewa_lod_sample", c.c_int, c.c_void_p, c.c_uint64, c.c_void_p)
        self.ewa_lod_scene_render: Callable[..., int] = bind("ewa_lod_scene_render", c.c_int, c.POINTER(ewa_lod_scene), c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_render_options), c.POINTER(ewa_lod_options), c.POINTER(ewa_frame), c.POINTER(ewa_lod_stats))
        self.ewa_measure_kind_name: Callable[..., bytes | None] = bind("ewa_measure_kind_name", c.c_char_p, c.c_uint32)
        self.ewa_places_measure: Callable[..., int] = bind("ewa_places_measure", c.c_int, c.c_int, c.c_void_p, c.c_uint32, c.c_void_p, c.POINTER(ewa_measurement))
        self.ewa_mesh_create: Callable[..., int] = bind("ewa_mesh_create", c.c_int, c.c_void_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_uint32, c.POINTER(ewa_mesh))
        self.ewa_mesh_free: Callable[..., None] = bind("ewa_mesh_free", None, c.POINTER(ewa_mesh))
        self.ewa_mesh_is_closed: Callable[..., int] = bind("ewa_mesh_is_closed", c.c_int, c.POINTER(ewa_mesh), c.c_void_p)
        self.ewa_mesh_load: Callable[..., int] = bind("ewa_mesh_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_mesh))
        self.ewa_mesh_sample: Callable[..., int] = bind("ewa_mesh_sample", c.c_int, c.POINTER(ewa_mesh), c.POINTER(ewa_mesh_sample_options), c.c_void_p)
        self.ewa_mesh_sample_options_init: Callable[..., None] = bind("ewa_mesh_sample_options_init", None, c.POINTER(ewa_mesh_sample_options), c.c_size_t)
        self.ewa_mesh_set_picture: Callable[..., int] = bind("ewa_mesh_set_picture", c.c_int, c.POINTER(ewa_mesh), c.POINTER(ewa_image))
        self.ewa_mixture_render: Callable[..., int] = bind("ewa_mixture_render", c.c_int, c.c_void_p, c.POINTER(ewa_mixture), c.POINTER(ewa_camera), c.POINTER(ewa_gaussian_options), c.POINTER(ewa_frame), c.POINTER(ewa_gaussian_stats))
        self.ewa_model_format_name: Callable[..., bytes | None] = bind("ewa_model_format_name", c.c_char_p, c.c_int)
        self.ewa_model_free: Callable[..., None] = bind("ewa_model_free", None, c.POINTER(ewa_model))
        self.ewa_model_load: Callable[..., int] = bind("ewa_model_load", c.c_int, c.c_void_p, c.c_char_p, c.c_uint32, c.POINTER(ewa_cloud_load_options), c.POINTER(ewa_model))
        self.ewa_model_load_memory: Callable[..., int] = bind("ewa_model_load_memory", c.c_int, c.c_void_p, c.c_void_p, c.c_size_t, c.c_char_p, c.c_char_p, c.c_uint32, c.POINTER(ewa_cloud_load_options), c.POINTER(ewa_model))
        self.ewa_model_probe: Callable[..., int] = bind("ewa_model_probe", c.c_int, c.c_void_p, c.c_char_p, c.c_void_p)
        self.ewa_color_read: Callable[..., bool] = bind("ewa_color_read", c.c_bool, c.c_char_p, c.c_void_p)
        self.ewa_option_find: Callable[..., Any] = bind("ewa_option_find", c.POINTER(ewa_option), c.POINTER(ewa_option_table), c.c_char_p)
        self.ewa_option_get: Callable[..., None] = bind("ewa_option_get", None, c.POINTER(ewa_option), c.c_void_p, c.c_void_p)
        self.ewa_option_range: Callable[..., None] = bind("ewa_option_range", None, c.POINTER(ewa_option), c.c_void_p)
        self.ewa_option_set: Callable[..., int] = bind("ewa_option_set", c.c_int, c.POINTER(ewa_option), c.c_void_p, c.c_char_p, c.c_void_p)
        self.ewa_panorama_options_init: Callable[..., None] = bind("ewa_panorama_options_init", None, c.POINTER(ewa_panorama_options), c.c_size_t)
        self.ewa_scene_draw_panorama: Callable[..., int] = bind("ewa_scene_draw_panorama", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_scene_options), c.POINTER(ewa_panorama_options), c.POINTER(ewa_frame), c.POINTER(ewa_scene_stats))
        self.ewa_scene_place_panorama: Callable[..., int] = bind("ewa_scene_place_panorama", c.c_int, c.c_void_p, c.POINTER(ewa_view_options), c.POINTER(ewa_panorama_options), c.POINTER(ewa_camera))
        self.ewa_cloud_color_from_photos: Callable[..., int] = bind("ewa_cloud_color_from_photos", c.c_int, c.c_void_p, c.POINTER(ewa_photo), c.c_uint32, c.POINTER(ewa_photos_options), c.POINTER(ewa_photos_report), c.POINTER(ewa_photo_report))
        self.ewa_image_compare: Callable[..., int] = bind("ewa_image_compare", c.c_int, c.POINTER(ewa_image), c.POINTER(ewa_image), c.POINTER(ewa_image_quality))
        self.ewa_image_undistort: Callable[..., int] = bind("ewa_image_undistort", c.c_int, c.POINTER(ewa_image), c.POINTER(ewa_camera), c.POINTER(ewa_lens), c.POINTER(ewa_image))
        self.ewa_photo_load: Callable[..., int] = bind("ewa_photo_load", c.c_int, c.c_void_p, c.POINTER(ewa_photo), c.c_void_p, c.POINTER(ewa_image))
        self.ewa_photos_options_init: Callable[..., None] = bind("ewa_photos_options_init", None, c.POINTER(ewa_photos_options), c.c_size_t)
        self.ewa_cloud_csg: Callable[..., int] = bind("ewa_cloud_csg", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_csg_options), c.c_void_p)
        self.ewa_cloud_detect_features: Callable[..., int] = bind("ewa_cloud_detect_features", c.c_int, c.c_void_p, c.POINTER(ewa_feature_options), c.POINTER(ewa_feature_counts))
        self.ewa_cloud_estimate: Callable[..., int] = bind("ewa_cloud_estimate", c.c_int, c.c_void_p, c.POINTER(ewa_estimate_options))
        self.ewa_cloud_generate: Callable[..., int] = bind("ewa_cloud_generate", c.c_int, c.c_void_p, c.POINTER(ewa_generate_options), c.c_void_p)
        self.ewa_cloud_mark_outliers: Callable[..., int] = bind("ewa_cloud_mark_outliers", c.c_int, c.c_void_p, c.POINTER(ewa_estimate_options), c.c_void_p)
        self.ewa_cloud_measure_spacing: Callable[..., int] = bind("ewa_cloud_measure_spacing", c.c_int, c.c_void_p, c.c_uint64, c.POINTER(ewa_spacing))
        self.ewa_cloud_refit_colors: Callable[..., int] = bind("ewa_cloud_refit_colors", c.c_int, c.c_void_p, c.POINTER(ewa_refit_options), c.POINTER(ewa_refit_report))
        self.ewa_csg_options_init: Callable[..., None] = bind("ewa_csg_options_init", None, c.POINTER(ewa_csg_options), c.c_size_t)
        self.ewa_estimate_options_init: Callable[..., None] = bind("ewa_estimate_options_init", None, c.POINTER(ewa_estimate_options), c.c_size_t)
        self.ewa_feature_options_init: Callable[..., None] = bind("ewa_feature_options_init", None, c.POINTER(ewa_feature_options), c.c_size_t)
        self.ewa_generate_options_init: Callable[..., None] = bind("ewa_generate_options_init", None, c.POINTER(ewa_generate_options), c.c_size_t)
        self.ewa_refit_options_init: Callable[..., None] = bind("ewa_refit_options_init", None, c.POINTER(ewa_refit_options), c.c_size_t)
        self.ewa_volume_generate: Callable[..., int] = bind("ewa_volume_generate", c.c_int, c.c_void_p, c.POINTER(ewa_volume_generate_options), c.POINTER(ewa_volume))
        self.ewa_volume_generate_options_init: Callable[..., None] = bind("ewa_volume_generate_options_init", None, c.POINTER(ewa_volume_generate_options), c.c_size_t)
        self.ewa_volume_outline: Callable[..., int] = bind("ewa_volume_outline", c.c_int, c.POINTER(ewa_volume), c.POINTER(ewa_transfer), c.c_double, c.c_void_p)
        self.ewa_cloud_color_by_procedure: Callable[..., int] = bind("ewa_cloud_color_by_procedure", c.c_int, c.c_void_p, c.POINTER(ewa_procedure_options))
        self.ewa_procedure_options_init: Callable[..., None] = bind("ewa_procedure_options_init", None, c.POINTER(ewa_procedure_options), c.c_int, c.c_size_t)
        self.ewa_profile_draw: Callable[..., int] = bind("ewa_profile_draw", c.c_int, c.POINTER(ewa_profile), c.POINTER(ewa_profile_graph_options), c.POINTER(ewa_canvas))
        self.ewa_profile_free: Callable[..., None] = bind("ewa_profile_free", None, c.POINTER(ewa_profile))
        self.ewa_profile_graph_options_init: Callable[..., None] = bind("ewa_profile_graph_options_init", None, c.POINTER(ewa_profile_graph_options), c.c_size_t)
        self.ewa_profile_line_read: Callable[..., int] = bind("ewa_profile_line_read", c.c_int, c.c_char_p, c.c_void_p, c.c_void_p, c.c_void_p)
        self.ewa_profile_options_init: Callable[..., None] = bind("ewa_profile_options_init", None, c.POINTER(ewa_profile_options), c.c_size_t)
        self.ewa_scene_profile: Callable[..., int] = bind("ewa_scene_profile", c.c_int, c.c_void_p, c.c_void_p, c.c_uint32, c.POINTER(ewa_profile_options), c.POINTER(ewa_profile))
        self.ewa_region_set_outline: Callable[..., int] = bind("ewa_region_set_outline", c.c_int, c.POINTER(ewa_region), c.POINTER(ewa_camera), c.c_void_p, c.c_uint32)
        self.ewa_regions_mark: Callable[..., int] = bind("ewa_regions_mark", c.c_int, c.POINTER(ewa_region), c.c_uint32, c.c_void_p, c.c_void_p)
        self.ewa_render: Callable[..., int] = bind("ewa_render", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_render_options), c.POINTER(ewa_frame), c.POINTER(ewa_render_stats))
        self.ewa_render_add: Callable[..., int] = bind("ewa_render_add", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_render_add_weighted: Callable[..., int] = bind("ewa_render_add_weighted", c.c_int, c.c_void_p, c.c_void_p, c.c_double)
        self.ewa_render_begin: Callable[..., int] = bind("ewa_render_begin", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_render_options), c.POINTER(ewa_frame))
        self.ewa_render_finish: Callable[..., int] = bind("ewa_render_finish", c.c_int, c.c_void_p, c.POINTER(ewa_render_stats))
        self.ewa_render_options_init: Callable[..., None] = bind("ewa_render_options_init", None, c.POINTER(ewa_render_options), c.c_size_t)
        self.ewa_render_stats_add: Callable[..., None] = bind("ewa_render_stats_add", None, c.POINTER(ewa_render_stats), c.POINTER(ewa_render_stats))
        self.ewa_renderer_create: Callable[..., int] = bind("ewa_renderer_create", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_renderer_destroy: Callable[..., None] = bind("ewa_renderer_destroy", None, c.c_void_p)
        self.ewa_surfels_create: Callable[..., int] = bind("ewa_surfels_create", c.c_int, c.c_void_p, c.POINTER(ewa_surfels_options), c.c_void_p)
        self.ewa_surfels_describe: Callable[..., None] = bind("ewa_surfels_describe", None, c.c_void_p, c.POINTER(ewa_surfels_info))
        self.ewa_surfels_destroy: Callable[..., None] = bind("ewa_surfels_destroy", None, c.c_void_p)
        self.ewa_surfels_options_init: Callable[..., None] = bind("ewa_surfels_options_init", None, c.POINTER(ewa_surfels_options), c.c_size_t)
        self.ewa_texture_map: Callable[..., int] = bind("ewa_texture_map", c.c_int, c.c_void_p, c.POINTER(ewa_texture_source), c.POINTER(ewa_mat3), c.POINTER(ewa_texture_options), c.POINTER(ewa_texture_target), c.POINTER(ewa_texture_stats))
        self.ewa_texture_map_from_camera: Callable[..., int] = bind("ewa_texture_map_from_camera", c.c_int, c.c_void_p, c.c_uint32, c.c_uint32, c.POINTER(ewa_camera), c.c_void_p, c.c_void_p, c.c_void_p, c.POINTER(ewa_mat3))
        self.ewa_texture_map_from_corners: Callable[..., int] = bind("ewa_texture_map_from_corners", c.c_int, c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.POINTER(ewa_mat3))
        self.ewa_texture_options_init: Callable[..., None] = bind("ewa_texture_options_init", None, c.POINTER(ewa_texture_options), c.c_size_t)
        self.ewa_asset_create: Callable[..., int] = bind("ewa_asset_create", c.c_int, c.c_void_p, c.POINTER(ewa_asset_source), c.POINTER(ewa_asset_options), c.c_void_p)
        self.ewa_asset_describe: Callable[..., None] = bind("ewa_asset_describe", None, c.c_void_p, c.POINTER(ewa_asset_info))
        self.ewa_asset_find_upright: Callable[..., int] = bind("ewa_asset_find_upright", c.c_int, c.c_void_p, c.POINTER(ewa_upright))
        self.ewa_asset_kind_name: Callable[..., bytes | None] = bind("ewa_asset_kind_name", c.c_char_p, c.c_int)
        self.ewa_asset_load: Callable[..., int] = bind("ewa_asset_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_asset_options), c.c_void_p)
        self.ewa_asset_map_is_valid: Callable[..., bool] = bind("ewa_asset_map_is_valid", c.c_bool, c.c_void_p)
        self.ewa_asset_options_init: Callable[..., None] = bind("ewa_asset_options_init", None, c.POINTER(ewa_asset_options), c.c_size_t)
        self.ewa_asset_probe: Callable[..., int] = bind("ewa_asset_probe", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_asset_options), c.c_void_p)
        self.ewa_asset_release: Callable[..., None] = bind("ewa_asset_release", None, c.c_void_p)
        self.ewa_asset_retain: Callable[..., int | None] = bind("ewa_asset_retain", c.c_void_p, c.c_void_p)
        self.ewa_cloud_place_camera: Callable[..., int] = bind("ewa_cloud_place_camera", c.c_int, c.c_void_p, c.c_double, c.c_int, c.c_int, c.POINTER(ewa_view_options), c.POINTER(ewa_camera), c.POINTER(ewa_view_info))
        self.ewa_instance_init: Callable[..., None] = bind("ewa_instance_init", None, c.POINTER(ewa_instance), c.c_size_t)
        self.ewa_scene_add: Callable[..., int] = bind("ewa_scene_add", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_instance))
        self.ewa_scene_asset: Callable[..., int | None] = bind("ewa_scene_asset", c.c_void_p, c.c_void_p, c.c_uint32)
        self.ewa_scene_bounds: Callable[..., None] = bind("ewa_scene_bounds", None, c.c_void_p, c.POINTER(ewa_bounds))
        self.ewa_scene_centers: Callable[..., int] = bind("ewa_scene_centers", c.c_int, c.c_void_p, c.c_uint64, c.c_void_p, c.c_void_p)
        self.ewa_scene_cloud: Callable[..., int] = bind("ewa_scene_cloud", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_scene_commit: Callable[..., int] = bind("ewa_scene_commit", c.c_int, c.c_void_p)
        self.ewa_scene_compare_photo: Callable[..., int] = bind("ewa_scene_compare_photo", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_photo), c.POINTER(ewa_scene_options), c.POINTER(ewa_photo_comparison))
        self.ewa_scene_complete: Callable[..., int] = bind("ewa_scene_complete", c.c_int, c.c_void_p)
        self.ewa_scene_copy: Callable[..., int] = bind("ewa_scene_copy", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p)
        self.ewa_scene_count: Callable[..., int] = bind("ewa_scene_count", c.c_uint32, c.c_void_p)
        self.ewa_scene_create: Callable[..., int] = bind("ewa_scene_create", c.c_int, c.c_void_p, c.POINTER(ewa_scene_options), c.c_void_p)
        self.ewa_scene_describe: Callable[..., None] = bind("ewa_scene_describe", None, c.c_void_p, c.POINTER(ewa_scene_info))
        self.ewa_scene_destroy: Callable[..., None] = bind("ewa_scene_destroy", None, c.c_void_p)
        self.ewa_scene_draw: Callable[..., int] = bind("ewa_scene_draw", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_scene_options), c.POINTER(ewa_frame), c.POINTER(ewa_scene_stats))
        self.ewa_scene_draw_outlines: Callable[..., int] = bind("ewa_scene_draw_outlines", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_scene_options), c.c_uint32, c.POINTER(ewa_canvas))
        self.ewa_scene_gaussians: Callable[..., int] = bind("ewa_scene_gaussians", c.c_int, c.c_void_p, c.POINTER(ewa_gaussians), c.c_void_p)
        self.ewa_scene_get: Callable[..., int] = bind("ewa_scene_get", c.c_int, c.c_void_p, c.c_uint32, c.POINTER(ewa_instance))
        self.ewa_scene_get_camera: Callable[..., bool] = bind("ewa_scene_get_camera", c.c_bool, c.c_void_p, c.POINTER(ewa_camera))
        self.ewa_scene_get_options: Callable[..., None] = bind("ewa_scene_get_options", None, c.c_void_p, c.POINTER(ewa_scene_options))
        self.ewa_scene_keyframe: Callable[..., Any] = bind("ewa_scene_keyframe", c.POINTER(ewa_camera), c.c_void_p, c.c_uint32)
        self.ewa_scene_legend: Callable[..., Any] = bind("ewa_scene_legend", c.POINTER(ewa_legend), c.c_void_p, c.c_uint32)
        self.ewa_scene_measure: Callable[..., Any] = bind("ewa_scene_measure", c.POINTER(ewa_measure), c.c_void_p, c.c_uint32)
        self.ewa_scene_options_init: Callable[..., None] = bind("ewa_scene_options_init", None, c.POINTER(ewa_scene_options), c.c_size_t)
        self.ewa_scene_pick: Callable[..., int] = bind("ewa_scene_pick", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_scene_options), c.c_double, c.c_double, c.c_double, c.c_double, c.POINTER(ewa_scene_hit))
        self.ewa_scene_place_camera: Callable[..., int] = bind("ewa_scene_place_camera", c.c_int, c.c_void_p, c.POINTER(ewa_view_options), c.POINTER(ewa_camera), c.POINTER(ewa_view_info))
        self.ewa_scene_points: Callable[..., int] = bind("ewa_scene_points", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_scene_reader_choose: Callable[..., int] = bind("ewa_scene_reader_choose", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_scene_options), c.c_uint32, c.c_void_p)
        self.ewa_scene_reader_create: Callable[..., int] = bind("ewa_scene_reader_create", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_scene_reader_destroy: Callable[..., None] = bind("ewa_scene_reader_destroy", None, c.c_void_p)
        self.ewa_scene_reader_put: Callable[..., None] = bind("ewa_scene_reader_put", None, c.c_void_p)
        self.ewa_scene_reader_read: Callable[..., int] = bind("ewa_scene_reader_read", c.c_int, c.c_void_p)
        self.ewa_scene_remove: Callable[..., int] = bind("ewa_scene_remove", c.c_int, c.c_void_p, c.c_uint32)
        self.ewa_scene_renderer_create: Callable[..., int] = bind("ewa_scene_renderer_create", c.c_int, c.c_void_p, c.c_int, c.POINTER(ewa_exchange), c.c_void_p)
        self.ewa_scene_renderer_destroy: Callable[..., None] = bind("ewa_scene_renderer_destroy", None, c.c_void_p)
        self.ewa_scene_renderer_surfaces: Callable[..., int | None] = bind("ewa_scene_renderer_surfaces", c.c_void_p, c.c_void_p)
        self.ewa_scene_reuse: Callable[..., None] = bind("ewa_scene_reuse", None, c.c_void_p, c.c_void_p)
        self.ewa_scene_set: Callable[..., int] = bind("ewa_scene_set", c.c_int, c.c_void_p, c.c_uint32, c.POINTER(ewa_instance))
        self.ewa_scene_set_camera: Callable[..., int] = bind("ewa_scene_set_camera", c.c_int, c.c_void_p, c.POINTER(ewa_camera))
        self.ewa_scene_set_keyframes: Callable[..., int] = bind("ewa_scene_set_keyframes", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.c_uint32)
        self.ewa_scene_set_measures: Callable[..., int] = bind("ewa_scene_set_measures", c.c_int, c.c_void_p, c.POINTER(ewa_measure), c.c_uint32)
        self.ewa_scene_set_options: Callable[..., int] = bind("ewa_scene_set_options", c.c_int, c.c_void_p, c.POINTER(ewa_scene_options))
        self.ewa_scene_volume: Callable[..., int] = bind("ewa_scene_volume", c.c_int, c.c_void_p, c.POINTER(ewa_volume))
        self.ewa_view_options_init: Callable[..., None] = bind("ewa_view_options_init", None, c.POINTER(ewa_view_options), c.c_size_t)
        self.ewa_scene_describe_json: Callable[..., int] = bind("ewa_scene_describe_json", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_scene_file_apply: Callable[..., None] = bind("ewa_scene_file_apply", None, c.c_void_p, c.POINTER(ewa_scene_options))
        self.ewa_scene_file_camera: Callable[..., bool] = bind("ewa_scene_file_camera", c.c_bool, c.c_void_p, c.POINTER(ewa_camera))
        self.ewa_scene_file_count: Callable[..., int] = bind("ewa_scene_file_count", c.c_uint32, c.c_void_p)
        self.ewa_scene_file_destroy: Callable[..., None] = bind("ewa_scene_file_destroy", None, c.c_void_p)
        self.ewa_scene_file_entry: Callable[..., int] = bind("ewa_scene_file_entry", c.c_int, c.c_void_p, c.c_uint32, c.POINTER(ewa_scene_entry))
        self.ewa_scene_file_keyframe: Callable[..., bool] = bind("ewa_scene_file_keyframe", c.c_bool, c.c_void_p, c.c_uint32, c.POINTER(ewa_camera))
        self.ewa_scene_file_load: Callable[..., int] = bind("ewa_scene_file_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_asset_options), c.c_void_p)
        self.ewa_scene_file_measure: Callable[..., bool] = bind("ewa_scene_file_measure", c.c_bool, c.c_void_p, c.c_uint32, c.POINTER(ewa_measure))
        self.ewa_scene_file_probe: Callable[..., bool] = bind("ewa_scene_file_probe", c.c_bool, c.c_char_p)
        self.ewa_scene_open: Callable[..., int] = bind("ewa_scene_open", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_asset_options))
        self.ewa_scene_save: Callable[..., int] = bind("ewa_scene_save", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.c_char_p)
        self.ewa_text_free: Callable[..., None] = bind("ewa_text_free", None, c.c_void_p)
        self.ewa_box_mark: Callable[..., int] = bind("ewa_box_mark", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p)
        self.ewa_cloud_find_scalar: Callable[..., int] = bind("ewa_cloud_find_scalar", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_scalar))
        self.ewa_cloud_keep: Callable[..., int] = bind("ewa_cloud_keep", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p)
        self.ewa_cloud_thin_distance: Callable[..., int] = bind("ewa_cloud_thin_distance", c.c_int, c.c_void_p, c.c_double, c.c_void_p)
        self.ewa_cloud_thin_voxels: Callable[..., int] = bind("ewa_cloud_thin_voxels", c.c_int, c.c_void_p, c.c_double, c.c_void_p)
        self.ewa_filter_add: Callable[..., int] = bind("ewa_filter_add", c.c_int, c.POINTER(ewa_filter), c.c_char_p, c.c_void_p)
        self.ewa_filter_mark: Callable[..., int] = bind("ewa_filter_mark", c.c_int, c.POINTER(ewa_filter), c.c_void_p, c.c_void_p)
        self.ewa_filter_write: Callable[..., bool] = bind("ewa_filter_write", c.c_bool, c.POINTER(ewa_filter), c.c_char_p, c.c_size_t)
        self.ewa_polygon_box: Callable[..., None] = bind("ewa_polygon_box", None, c.c_void_p, c.c_void_p)
        self.ewa_polygon_create: Callable[..., int] = bind("ewa_polygon_create", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.c_uint32, c.c_void_p)
        self.ewa_polygon_destroy: Callable[..., None] = bind("ewa_polygon_destroy", None, c.c_void_p)
        self.ewa_polygon_load: Callable[..., int] = bind("ewa_polygon_load", c.c_int, c.c_void_p, c.c_char_p, c.c_void_p)
        self.ewa_polygon_mark: Callable[..., int] = bind("ewa_polygon_mark", c.c_int, c.c_void_p, c.c_void_p, c.c_void_p)
        self.ewa_polygon_read: Callable[..., int] = bind("ewa_polygon_read", c.c_int, c.c_void_p, c.c_char_p, c.c_void_p, c.c_size_t, c.c_void_p)
        self.ewa_rank_select: Callable[..., float] = bind("ewa_rank_select", c.c_double, c.c_void_p, c.c_size_t, c.c_size_t)
        self.ewa_scalar_read: Callable[..., None] = bind("ewa_scalar_read", None, c.POINTER(ewa_scalar), c.c_uint64, c.c_uint64, c.c_void_p)
        self.ewa_sphere_mark: Callable[..., int] = bind("ewa_sphere_mark", c.c_int, c.c_void_p, c.c_double, c.c_void_p, c.c_void_p)
        self.ewa_environment_create: Callable[..., int] = bind("ewa_environment_create", c.c_int, c.POINTER(ewa_image), c.c_void_p)
        self.ewa_environment_destroy: Callable[..., None] = bind("ewa_environment_destroy", None, c.c_void_p)
        self.ewa_light_init: Callable[..., None] = bind("ewa_light_init", None, c.POINTER(ewa_light))
        self.ewa_material_init: Callable[..., None] = bind("ewa_material_init", None, c.POINTER(ewa_material))
        self.ewa_transfer_automatic: Callable[..., int] = bind("ewa_transfer_automatic", c.c_int, c.POINTER(ewa_volume), c.POINTER(ewa_volume_facts), c.POINTER(ewa_transfer))
        self.ewa_transfer_preset: Callable[..., int] = bind("ewa_transfer_preset", c.c_int, c.POINTER(ewa_volume), c.POINTER(ewa_volume_facts), c.c_char_p, c.POINTER(ewa_transfer))
        self.ewa_transfer_preset_name: Callable[..., bytes | None] = bind("ewa_transfer_preset_name", c.c_char_p, c.c_uint32, c.c_void_p)
        self.ewa_volume_create: Callable[..., int] = bind("ewa_volume_create", c.c_int, c.c_void_p, c.c_void_p, c.c_int, c.POINTER(ewa_volume))
        self.ewa_volume_free: Callable[..., None] = bind("ewa_volume_free", None, c.POINTER(ewa_volume))
        self.ewa_volume_measure: Callable[..., int] = bind("ewa_volume_measure", c.c_int, c.POINTER(ewa_volume), c.POINTER(ewa_volume_facts))
        self.ewa_volume_options_init: Callable[..., None] = bind("ewa_volume_options_init", None, c.POINTER(ewa_volume_options), c.c_size_t)
        self.ewa_volume_render: Callable[..., int] = bind("ewa_volume_render", c.c_int, c.c_void_p, c.c_void_p, c.POINTER(ewa_camera), c.POINTER(ewa_volume_options), c.POINTER(ewa_frame), c.POINTER(ewa_volume_stats))
        self.ewa_volume_renderer_create: Callable[..., int] = bind("ewa_volume_renderer_create", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_volume_renderer_destroy: Callable[..., None] = bind("ewa_volume_renderer_destroy", None, c.c_void_p)
        self.ewa_voxels_create: Callable[..., int] = bind("ewa_voxels_create", c.c_int, c.POINTER(ewa_volume), c.POINTER(ewa_transfer), c.POINTER(ewa_voxels_options), c.c_void_p)
        self.ewa_voxels_describe: Callable[..., None] = bind("ewa_voxels_describe", None, c.c_void_p, c.POINTER(ewa_voxels_info))
        self.ewa_voxels_destroy: Callable[..., None] = bind("ewa_voxels_destroy", None, c.c_void_p)
        self.ewa_voxels_options_init: Callable[..., None] = bind("ewa_voxels_options_init", None, c.POINTER(ewa_voxels_options), c.c_size_t)
        self.ewa_depth_file_scale: Callable[..., float] = bind("ewa_depth_file_scale", c.c_double, c.c_char_p, c.c_int)
        self.ewa_depth_image_init: Callable[..., None] = bind("ewa_depth_image_init", None, c.POINTER(ewa_depth_image))
        self.ewa_warp_create: Callable[..., int] = bind("ewa_warp_create", c.c_int, c.c_void_p, c.c_void_p)
        self.ewa_warp_destroy: Callable[..., None] = bind("ewa_warp_destroy", None, c.c_void_p)
        self.ewa_warp_draw: Callable[..., int] = bind("ewa_warp_draw", c.c_int, c.c_void_p, c.POINTER(ewa_camera), c.c_int, c.POINTER(ewa_render_options), c.POINTER(ewa_frame), c.c_void_p, c.POINTER(ewa_render_stats))
        self.ewa_warp_options_init: Callable[..., None] = bind("ewa_warp_options_init", None, c.POINTER(ewa_warp_options), c.c_size_t)
        self.ewa_warp_render_options_init: Callable[..., None] = bind("ewa_warp_render_options_init", None, c.POINTER(ewa_render_options), c.c_size_t)
        self.ewa_warp_take: Callable[..., int] = bind("ewa_warp_take", c.c_int, c.c_void_p, c.POINTER(ewa_depth_image), c.c_uint32, c.POINTER(ewa_warp_options), c.POINTER(ewa_warp_facts))
