# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from docs/api.json; a test holds it to that. Do not edit.

"""The C interface of libewa as ctypes, under its own names; see include/ewa."""
import ctypes as c
from enum import IntEnum
from typing import Annotated, Any, Callable, Optional, TypeVar


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


class ewa_resize(IntEnum):
    EWA_RESIZE_STRETCH = 0
    EWA_RESIZE_HEIGHT = 1


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


_Type = TypeVar("_Type", bound=c.Structure)


def _struct(made: type[_Type]) -> type[_Type]:
    """A struct whose annotations are its members: of each a struct, or its type in Python with that in C."""
    made._fields_ = [(name, getattr(kind, "__metadata__", (kind,))[0]) for name, kind in made.__annotations__.items()]
    return made


@_struct
class ewa_file_source(c.Structure):
    size_bytes: Annotated[int, c.c_uint64]
    read_at: Annotated[Any, c.CFUNCTYPE(c.c_int64, c.c_void_p, c.c_uint64, c.c_void_p, c.c_size_t)]
    close: Annotated[Any, c.CFUNCTYPE(None, c.c_void_p)]
    user: Annotated[Optional[int], c.c_void_p]


ewa_file_opener = c.CFUNCTYPE(c.c_bool, c.c_void_p, c.c_char_p, c.POINTER(ewa_file_source))
ewa_message_callback = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p)
ewa_progress_callback = c.CFUNCTYPE(c.c_bool, c.c_void_p, c.c_char_p, c.c_double)
ewa_task = c.CFUNCTYPE(None, c.c_void_p, c.c_uint32, c.c_uint32)


@_struct
class ewa_camera(c.Structure):
    projection: Annotated[int, c.c_int]
    width_px: Annotated[int, c.c_uint32]
    height_px: Annotated[int, c.c_uint32]
    fx_px: Annotated[float, c.c_double]
    fy_px: Annotated[float, c.c_double]
    cx_px: Annotated[float, c.c_double]
    cy_px: Annotated[float, c.c_double]
    world_to_camera: Annotated[c.Array[c.c_double], c.c_double * 16]


ewa_camera_callback = c.CFUNCTYPE(None, c.c_void_p, c.c_uint32, c.POINTER(ewa_camera))
ewa_line_callback = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p)


@_struct
class ewa_image(c.Structure):
    context: Annotated[Optional[int], c.c_void_p]
    width_px: Annotated[int, c.c_uint32]
    height_px: Annotated[int, c.c_uint32]
    channel_count: Annotated[int, c.c_uint32]
    pixels: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_mesh_material(c.Structure):
    base_color: Annotated[c.Array[c.c_float], c.c_float * 4]
    texture: Annotated[int, c.c_uint32]


@_struct
class ewa_mesh(c.Structure):
    context: Annotated[Optional[int], c.c_void_p]
    vertex_count: Annotated[int, c.c_uint32]
    triangle_count: Annotated[int, c.c_uint32]
    material_count: Annotated[int, c.c_uint32]
    positions: Annotated[Optional[int], c.c_void_p]
    normals: Annotated[Optional[int], c.c_void_p]
    colors: Annotated[Optional[int], c.c_void_p]
    texcoords: Annotated[Optional[int], c.c_void_p]
    triangles: Annotated[Optional[int], c.c_void_p]
    triangle_materials: Annotated[Optional[int], c.c_void_p]
    materials: Annotated[Any, c.POINTER(ewa_mesh_material)]
    textures: Annotated[Any, c.POINTER(ewa_image)]
    attributes: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_model(c.Structure):
    format: Annotated[int, c.c_int]
    lost_count: Annotated[int, c.c_uint64]
    face_count: Annotated[int, c.c_uint64]
    mesh: ewa_mesh
    points: Annotated[Optional[int], c.c_void_p]
    elements: Annotated[Optional[int], c.c_void_p]


ewa_asset_reader = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_char_p, c.POINTER(ewa_model), c.c_void_p)


@_struct
class ewa_allocator(c.Structure):
    user: Annotated[Optional[int], c.c_void_p]
    allocate: Annotated[Any, c.CFUNCTYPE(c.c_void_p, c.c_void_p, c.c_size_t)]
    release: Annotated[Any, c.CFUNCTYPE(None, c.c_void_p, c.c_void_p, c.c_size_t)]


@_struct
class ewa_bounds(c.Structure):
    low_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    high_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    finite_count: Annotated[int, c.c_uint64]


@_struct
class ewa_executor(c.Structure):
    user: Annotated[Optional[int], c.c_void_p]
    worker_count: Annotated[int, c.c_uint32]
    run: Annotated[Any, c.CFUNCTYPE(None, c.c_void_p, ewa_task, c.c_void_p, c.c_uint32)]


@_struct
class ewa_limits(c.Structure):
    max_points: Annotated[int, c.c_uint64]
    max_memory_bytes: Annotated[int, c.c_uint64]
    max_image_side: Annotated[int, c.c_uint32]
    max_seconds: Annotated[float, c.c_double]


@_struct
class ewa_context_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    allocator: ewa_allocator
    executor: ewa_executor
    thread_count: Annotated[int, c.c_uint32]
    cpu_mask: Annotated[int, c.c_uint32]
    message_level: Annotated[int, c.c_int]
    message: Annotated[Any, ewa_message_callback]
    message_user: Annotated[Optional[int], c.c_void_p]
    progress: Annotated[Any, ewa_progress_callback]
    progress_user: Annotated[Optional[int], c.c_void_p]
    limits: ewa_limits
    named_files: Annotated[int, c.c_int]
    untrusted: Annotated[bool, c.c_bool]
    open_file: Annotated[Any, ewa_file_opener]
    open_file_user: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_acquire_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    filter: Annotated[int, c.c_int]
    fit: Annotated[int, c.c_int]
    wrap_s: Annotated[int, c.c_int]
    wrap_t: Annotated[int, c.c_int]
    pixel_sigma_px: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    ridge: Annotated[float, c.c_double]
    modulate: Annotated[bool, c.c_bool]


@_struct
class ewa_acquire_report(c.Structure):
    textured_count: Annotated[int, c.c_uint64]
    pair_count: Annotated[int, c.c_uint64]
    iterations: Annotated[int, c.c_uint32]
    gradient: Annotated[float, c.c_double]
    ridge: Annotated[float, c.c_double]


@_struct
class ewa_camera_cotangent(c.Structure):
    rotation: Annotated[c.Array[c.c_double], c.c_double * 3]
    translation: Annotated[c.Array[c.c_double], c.c_double * 3]
    focal_px: Annotated[c.Array[c.c_double], c.c_double * 2]
    principal_px: Annotated[c.Array[c.c_double], c.c_double * 2]


@_struct
class ewa_frame_cotangent(c.Structure):
    rgba: Annotated[Optional[int], c.c_void_p]
    depth: Annotated[Optional[int], c.c_void_p]
    normal: Annotated[Optional[int], c.c_void_p]
    coverage: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_gradient(c.Structure):
    color: Annotated[Optional[int], c.c_void_p]
    opacity: Annotated[Optional[int], c.c_void_p]
    position: Annotated[Optional[int], c.c_void_p]
    normal: Annotated[Optional[int], c.c_void_p]
    radius: Annotated[Optional[int], c.c_void_p]
    tangent_u: Annotated[Optional[int], c.c_void_p]
    tangent_v: Annotated[Optional[int], c.c_void_p]
    camera: Annotated[Any, c.POINTER(ewa_camera_cotangent)]
    rgba: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_attribute(c.Structure):
    name: Annotated[bytes, c.c_char * 64]
    type: Annotated[int, c.c_int]
    component_count: Annotated[int, c.c_uint32]
    stride_bytes: Annotated[int, c.c_size_t]
    data: Annotated[Optional[int], c.c_void_p]
    borrowed: Annotated[bool, c.c_bool]


@_struct
class ewa_coordinate_grid(c.Structure):
    step_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    offset_world: Annotated[c.Array[c.c_double], c.c_double * 3]


@_struct
class ewa_parcel(c.Structure):
    data: Annotated[Optional[int], c.c_void_p]
    size_bytes: Annotated[int, c.c_size_t]


@_struct
class ewa_exchange(c.Structure):
    user: Annotated[Optional[int], c.c_void_p]
    rank: Annotated[int, c.c_uint32]
    rank_count: Annotated[int, c.c_uint32]
    picture_rank: Annotated[int, c.c_uint32]
    swap: Annotated[Any, c.CFUNCTYPE(c.c_int, c.c_void_p, c.POINTER(ewa_parcel), c.POINTER(ewa_parcel))]


@_struct
class ewa_coloring(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    attribute: Annotated[bytes, c.c_char * 68]
    map: Annotated[int, c.c_int]
    ranged: Annotated[bool, c.c_bool]
    percent: Annotated[c.Array[c.c_bool], c.c_bool * 2]
    range: Annotated[c.Array[c.c_double], c.c_double * 2]
    tinted: Annotated[bool, c.c_bool]
    tint: Annotated[c.Array[c.c_double], c.c_double * 3]


@_struct
class ewa_category(c.Structure):
    value: Annotated[float, c.c_double]
    name: Annotated[Optional[bytes], c.c_char_p]
    srgb: Annotated[c.Array[c.c_uint8], c.c_uint8 * 3]


@_struct
class ewa_legend(c.Structure):
    context: Annotated[Optional[int], c.c_void_p]
    colormap: Annotated[int, c.c_int]
    range: Annotated[c.Array[c.c_double], c.c_double * 2]
    length: Annotated[bool, c.c_bool]
    classes: Annotated[bool, c.c_bool]
    category_count: Annotated[int, c.c_uint32]
    categories: Annotated[Any, c.POINTER(ewa_category)]
    names: Annotated[Optional[bytes], c.c_char_p]
    grey_count: Annotated[int, c.c_uint64]
    attribute: Annotated[bytes, c.c_char * 68]


@_struct
class ewa_cloud_invalid_points(c.Structure):
    position_count: Annotated[int, c.c_uint64]
    normal_count: Annotated[int, c.c_uint64]
    radius_count: Annotated[int, c.c_uint64]
    axis_count: Annotated[int, c.c_uint64]
    color_count: Annotated[int, c.c_uint64]


@_struct
class ewa_gaussian_columns(c.Structure):
    dimensions: Annotated[int, c.c_uint32]
    sh_degree: Annotated[int, c.c_uint32]
    filtered: Annotated[bool, c.c_bool]


@_struct
class ewa_framing_info(c.Structure):
    box: ewa_bounds
    middle_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    sample_count: Annotated[int, c.c_uint64]
    trimmed: Annotated[bool, c.c_bool]


@_struct
class ewa_upright(c.Structure):
    axis: Annotated[int, c.c_int]
    reversed: Annotated[bool, c.c_bool]
    view: Annotated[int, c.c_int]
    from_origin: Annotated[bool, c.c_bool]
    why: Annotated[Optional[bytes], c.c_char_p]


@_struct
class ewa_canvas(c.Structure):
    rgba8: Annotated[Optional[int], c.c_void_p]
    width_px: Annotated[int, c.c_uint32]
    height_px: Annotated[int, c.c_uint32]


@_struct
class ewa_furniture_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    title: Annotated[Optional[bytes], c.c_char_p]
    axes: Annotated[bool, c.c_bool]
    scale_bar: Annotated[bool, c.c_bool]
    color_bar: Annotated[bool, c.c_bool]
    scale_depth_world: Annotated[float, c.c_double]
    unit: Annotated[Optional[bytes], c.c_char_p]
    colormap: Annotated[int, c.c_int]
    range: Annotated[c.Array[c.c_double], c.c_double * 2]
    color_label: Annotated[Optional[bytes], c.c_char_p]
    color_unit: Annotated[Optional[bytes], c.c_char_p]
    categories: Annotated[Any, c.POINTER(ewa_category)]
    category_count: Annotated[int, c.c_uint32]
    pixel_scale: Annotated[float, c.c_double]
    ink: Annotated[int, c.c_int]


@_struct
class ewa_text_style(c.Structure):
    height_px: Annotated[float, c.c_double]
    rgba: Annotated[c.Array[c.c_uint8], c.c_uint8 * 4]
    halo_px: Annotated[float, c.c_double]
    halo_rgba: Annotated[c.Array[c.c_uint8], c.c_uint8 * 4]
    anchor: Annotated[int, c.c_int]


@_struct
class ewa_gaussians(c.Structure):
    context: Annotated[Optional[int], c.c_void_p]
    count: Annotated[int, c.c_uint32]
    sh_degree: Annotated[int, c.c_uint32]
    flat: Annotated[bool, c.c_bool]
    antialiased: Annotated[bool, c.c_bool]
    origin: Annotated[c.Array[c.c_double], c.c_double * 3]
    centers: Annotated[Optional[int], c.c_void_p]
    scales: Annotated[Optional[int], c.c_void_p]
    rotations: Annotated[Optional[int], c.c_void_p]
    opacities: Annotated[Optional[int], c.c_void_p]
    harmonics: Annotated[Optional[int], c.c_void_p]
    classes: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_gaussian_facts(c.Structure):
    format: Annotated[int, c.c_int]
    version: Annotated[int, c.c_uint32]
    filtered: Annotated[bool, c.c_bool]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    size_bytes: Annotated[int, c.c_uint64]


@_struct
class ewa_gaussians_save_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    sh_degree: Annotated[int, c.c_uint32]
    spz_version: Annotated[int, c.c_uint32]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]


@_struct
class ewa_gaussian_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    projection: Annotated[int, c.c_int]
    filter: Annotated[int, c.c_int]
    prefilter_px2: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    minimum_alpha: Annotated[float, c.c_double]
    minimum_transmittance: Annotated[float, c.c_double]
    near_world: Annotated[float, c.c_double]
    sh_degree: Annotated[int, c.c_uint32]
    background: Annotated[c.Array[c.c_float], c.c_float * 4]
    surface_depth: Annotated[Optional[int], c.c_void_p]
    surface_rgba: Annotated[Optional[int], c.c_void_p]
    section_planes: Annotated[c.Array[Any], (c.c_double * 4) * 8]
    section_count: Annotated[int, c.c_uint32]
    surface_normal: Annotated[Optional[int], c.c_void_p]
    surface_coverage: Annotated[Optional[int], c.c_void_p]
    order: Annotated[int, c.c_int]
    merge_px: Annotated[float, c.c_double]
    display: Annotated[int, c.c_int]
    ellipsoid_radius: Annotated[float, c.c_double]
    dot_px: Annotated[float, c.c_double]
    depth: Annotated[int, c.c_int]


@_struct
class ewa_gaussian_stats(c.Structure):
    splat_count: Annotated[int, c.c_uint64]
    visible_count: Annotated[int, c.c_uint64]
    near_count: Annotated[int, c.c_uint64]
    tile_count: Annotated[int, c.c_uint64]
    block_count: Annotated[int, c.c_uint64]
    sorted_count: Annotated[int, c.c_uint64]
    project_s: Annotated[float, c.c_double]
    bin_s: Annotated[float, c.c_double]
    draw_s: Annotated[float, c.c_double]
    total_s: Annotated[float, c.c_double]


@_struct
class ewa_splats_info(c.Structure):
    splat_count: Annotated[int, c.c_uint32]
    sh_degree: Annotated[int, c.c_uint32]
    antialiased: Annotated[bool, c.c_bool]
    has_levels: Annotated[bool, c.c_bool]
    has_classes: Annotated[bool, c.c_bool]
    resident_bytes: Annotated[int, c.c_size_t]
    bounds: ewa_bounds
    core: ewa_bounds
    near_world: Annotated[float, c.c_double]


@_struct
class ewa_gpu_info(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    vendor: Annotated[bytes, c.c_char * 128]
    renderer: Annotated[bytes, c.c_char * 128]
    version: Annotated[bytes, c.c_char * 128]
    software: Annotated[bool, c.c_bool]
    device_class: Annotated[int, c.c_int]
    differs: Annotated[bytes, c.c_char * 64]
    native_fma: Annotated[bool, c.c_bool]
    native_division: Annotated[bool, c.c_bool]
    native_root: Annotated[bool, c.c_bool]
    storage_bytes: Annotated[int, c.c_uint64]
    storage_count: Annotated[int, c.c_uint32]
    group_threads: Annotated[int, c.c_uint32]
    texture_px: Annotated[int, c.c_uint32]
    devices: Annotated[bytes, c.c_char * 1024]
    subnormals: Annotated[bool, c.c_bool]


@_struct
class ewa_renderer_info(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    backend: Annotated[bytes, c.c_char * 16]
    device: Annotated[bytes, c.c_char * 128]
    device_class: Annotated[int, c.c_int]
    remark: Annotated[bytes, c.c_char * 160]
    wait_count: Annotated[int, c.c_uint32]
    readback_count: Annotated[int, c.c_uint32]
    dispatch_count: Annotated[int, c.c_uint32]
    upload_bytes: Annotated[int, c.c_uint64]
    readback_bytes: Annotated[int, c.c_uint64]
    mixture: Annotated[bytes, c.c_char * 16]
    mixture_remark: Annotated[bytes, c.c_char * 160]


@_struct
class ewa_conic(c.Structure):
    xx: Annotated[float, c.c_double]
    xy: Annotated[float, c.c_double]
    xw: Annotated[float, c.c_double]
    yy: Annotated[float, c.c_double]
    yw: Annotated[float, c.c_double]
    ww: Annotated[float, c.c_double]


@_struct
class ewa_vec3(c.Structure):
    x: Annotated[float, c.c_double]
    y: Annotated[float, c.c_double]
    z: Annotated[float, c.c_double]


@_struct
class ewa_line3(c.Structure):
    direction: ewa_vec3
    moment: ewa_vec3


@_struct
class ewa_mat3(c.Structure):
    m: Annotated[c.Array[Any], (c.c_double * 3) * 3]


@_struct
class ewa_mat4(c.Structure):
    m: Annotated[c.Array[Any], (c.c_double * 4) * 4]


@_struct
class ewa_segment_batch(c.Structure):
    count: Annotated[int, c.c_uint64]
    end: Annotated[c.Array[Any], (c.c_void_p * 4) * 2]


@_struct
class ewa_segment_clips(c.Structure):
    visible: Annotated[Optional[int], c.c_void_p]
    alpha: Annotated[c.Array[Any], (c.c_void_p * 2) * 2]
    end: Annotated[c.Array[Any], ((c.c_void_p * 4) * 2) * 2]


@_struct
class ewa_vec4(c.Structure):
    x: Annotated[float, c.c_double]
    y: Annotated[float, c.c_double]
    z: Annotated[float, c.c_double]
    w: Annotated[float, c.c_double]


@_struct
class ewa_segment_part(c.Structure):
    alpha: Annotated[c.Array[c.c_double], c.c_double * 2]
    end: Annotated[c.Array[ewa_vec4], ewa_vec4 * 2]


@_struct
class ewa_cloud_load_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    keep_going: Annotated[bool, c.c_bool]
    attributes: Annotated[Optional[bytes], c.c_char_p]
    columns: Annotated[Optional[bytes], c.c_char_p]
    heights: Annotated[int, c.c_int]


@_struct
class ewa_cloud_save_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    ply_encoding: Annotated[int, c.c_int]
    elements: Annotated[Optional[int], c.c_void_p]
    step_world: Annotated[float, c.c_double]
    chunk_points: Annotated[int, c.c_uint32]


@_struct
class ewa_image_save_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    channel_names: Annotated[Optional[bytes], c.c_char_p]
    exr_half: Annotated[bool, c.c_bool]
    world_to_camera: Annotated[Optional[int], c.c_void_p]
    srgb_alpha_straight: Annotated[bool, c.c_bool]
    jpeg_quality: Annotated[int, c.c_uint32]


@_struct
class ewa_lens(c.Structure):
    model: Annotated[int, c.c_int]
    radial: Annotated[c.Array[c.c_double], c.c_double * 6]
    tangential: Annotated[c.Array[c.c_double], c.c_double * 2]


@_struct
class ewa_photo(c.Structure):
    camera: ewa_camera
    lens: ewa_lens
    path: Annotated[Optional[bytes], c.c_char_p]
    image: Annotated[Any, c.POINTER(ewa_image)]
    mask_path: Annotated[Optional[bytes], c.c_char_p]


@_struct
class ewa_volume_load_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    dims: Annotated[c.Array[c.c_uint32], c.c_uint32 * 3]
    type: Annotated[int, c.c_int]
    big_endian: Annotated[bool, c.c_bool]
    header_bytes: Annotated[int, c.c_uint64]
    spacing_world: Annotated[c.Array[c.c_double], c.c_double * 3]


@_struct
class ewa_volume_save_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    plain: Annotated[bool, c.c_bool]


@_struct
class ewa_lod_build_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    memory_bytes: Annotated[int, c.c_uint64]
    subset: Annotated[int, c.c_uint32]
    subset_count: Annotated[int, c.c_uint32]
    keep_going: Annotated[bool, c.c_bool]
    attributes: Annotated[Optional[bytes], c.c_char_p]


@_struct
class ewa_lod_build_stats(c.Structure):
    point_count: Annotated[int, c.c_uint64]
    left_out_count: Annotated[int, c.c_uint64]
    merged_count: Annotated[int, c.c_uint64]
    node_count: Annotated[int, c.c_uint32]
    level_count: Annotated[int, c.c_uint32]
    temporary_bytes: Annotated[int, c.c_uint64]
    statistics_s: Annotated[float, c.c_double]
    distribute_s: Annotated[float, c.c_double]
    estimate_s: Annotated[float, c.c_double]
    merge_s: Annotated[float, c.c_double]
    write_s: Annotated[float, c.c_double]
    total_s: Annotated[float, c.c_double]


@_struct
class ewa_lod_info(c.Structure):
    kind: Annotated[Optional[bytes], c.c_char_p]
    point_count: Annotated[int, c.c_uint64]
    bounds: ewa_bounds
    low_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    side_world: Annotated[float, c.c_double]
    spacing_world: Annotated[float, c.c_double]
    node_count: Annotated[int, c.c_uint32]
    level_count: Annotated[int, c.c_uint32]
    merged: Annotated[bool, c.c_bool]
    merged_count: Annotated[int, c.c_uint64]
    surfels: Annotated[bool, c.c_bool]
    prototype: Annotated[Optional[int], c.c_void_p]
    represented: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_lod_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    spacing_px: Annotated[float, c.c_double]
    error: Annotated[float, c.c_double]
    memory_bytes: Annotated[int, c.c_uint64]
    load_s: Annotated[float, c.c_double]
    share: Annotated[int, c.c_uint32]
    share_count: Annotated[int, c.c_uint32]
    max_splats: Annotated[int, c.c_uint64]
    resident_only: Annotated[bool, c.c_bool]


@_struct
class ewa_lod_scene(c.Structure):
    lods: Annotated[Optional[int], c.c_void_p]
    lod_count: Annotated[int, c.c_uint32]
    surfels_count: Annotated[int, c.c_uint32]
    surfels: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_render_stats(c.Structure):
    splat_count: Annotated[int, c.c_uint64]
    culled_count: Annotated[int, c.c_uint64]
    hidden_count: Annotated[int, c.c_uint64]
    drawn_count: Annotated[int, c.c_uint64]
    fragment_count: Annotated[int, c.c_uint64]
    bin_s: Annotated[float, c.c_double]
    setup_s: Annotated[float, c.c_double]
    visibility_s: Annotated[float, c.c_double]
    accumulate_s: Annotated[float, c.c_double]
    edge_s: Annotated[float, c.c_double]
    resolve_s: Annotated[float, c.c_double]
    total_s: Annotated[float, c.c_double]
    level: Annotated[int, c.c_uint32]


@_struct
class ewa_lod_stats(c.Structure):
    render: ewa_render_stats
    surfel_count: Annotated[int, c.c_uint64]
    node_count: Annotated[int, c.c_uint32]
    loaded_count: Annotated[int, c.c_uint32]
    missing_count: Annotated[int, c.c_uint32]
    band_count: Annotated[int, c.c_uint32]
    resident_bytes: Annotated[int, c.c_uint64]
    choose_s: Annotated[float, c.c_double]
    load_s: Annotated[float, c.c_double]
    coarser: Annotated[float, c.c_double]


@_struct
class ewa_measure(c.Structure):
    kind: Annotated[int, c.c_int]
    name: Annotated[bytes, c.c_char * 64]
    count: Annotated[int, c.c_uint32]
    places_world: Annotated[c.Array[c.c_double], c.c_double * 192]


@_struct
class ewa_measurement(c.Structure):
    length_world: Annotated[float, c.c_double]
    horizontal_world: Annotated[float, c.c_double]
    rise_world: Annotated[float, c.c_double]
    slope_deg: Annotated[float, c.c_double]
    angle_deg: Annotated[float, c.c_double]
    area: Annotated[float, c.c_double]
    horizontal_area: Annotated[float, c.c_double]


@_struct
class ewa_mesh_sample_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    point_count: Annotated[int, c.c_uint64]
    spacing_world: Annotated[float, c.c_double]
    seed: Annotated[int, c.c_uint64]
    crease_degrees: Annotated[float, c.c_double]
    radius_scale: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    clip_lines: Annotated[bool, c.c_bool]
    smooth_normals: Annotated[bool, c.c_bool]
    texture_filter: Annotated[int, c.c_int]
    pixel_sigma_px: Annotated[float, c.c_double]
    texcoords: Annotated[bool, c.c_bool]


@_struct
class ewa_light(c.Structure):
    direction_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    color: Annotated[c.Array[c.c_float], c.c_float * 3]


@_struct
class ewa_material(c.Structure):
    ambient: Annotated[float, c.c_float]
    diffuse: Annotated[float, c.c_float]
    specular: Annotated[float, c.c_float]
    shininess: Annotated[float, c.c_float]
    reflection: Annotated[float, c.c_float]


@_struct
class ewa_volume_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    method: Annotated[int, c.c_int]
    index: Annotated[int, c.c_int]
    sigma: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    prefilter_px: Annotated[float, c.c_double]
    point_threshold_px: Annotated[float, c.c_double]
    depth_unit: Annotated[float, c.c_double]
    level: Annotated[int, c.c_uint32]
    density_scale: Annotated[float, c.c_double]
    minimum_transmittance: Annotated[float, c.c_double]
    shading: Annotated[int, c.c_int]
    lights: Annotated[c.Array[ewa_light], ewa_light * 8]
    light_count: Annotated[int, c.c_uint32]
    material: ewa_material
    background: Annotated[c.Array[c.c_float], c.c_float * 4]
    surface_depth: Annotated[Optional[int], c.c_void_p]
    surface_rgba: Annotated[Optional[int], c.c_void_p]
    section_planes: Annotated[c.Array[Any], (c.c_double * 4) * 8]
    section_count: Annotated[int, c.c_uint32]
    surface_normal: Annotated[Optional[int], c.c_void_p]
    surface_coverage: Annotated[Optional[int], c.c_void_p]
    mark_splats: Annotated[bool, c.c_bool]


@_struct
class ewa_volume_stats(c.Structure):
    voxel_count: Annotated[int, c.c_uint64]
    culled_count: Annotated[int, c.c_uint64]
    near_count: Annotated[int, c.c_uint64]
    hidden_count: Annotated[int, c.c_uint64]
    splat_count: Annotated[int, c.c_uint64]
    point_count: Annotated[int, c.c_uint64]
    point_share: Annotated[float, c.c_double]
    bin_s: Annotated[float, c.c_double]
    setup_s: Annotated[float, c.c_double]
    points_s: Annotated[float, c.c_double]
    splats_s: Annotated[float, c.c_double]
    resolve_s: Annotated[float, c.c_double]
    total_s: Annotated[float, c.c_double]


@_struct
class ewa_mixed_volume(c.Structure):
    renderer: Annotated[Optional[int], c.c_void_p]
    voxels: Annotated[Optional[int], c.c_void_p]
    options: Annotated[Any, c.POINTER(ewa_volume_options)]
    stats: Annotated[Any, c.POINTER(ewa_volume_stats)]


@_struct
class ewa_mixture(c.Structure):
    splats: Annotated[Optional[int], c.c_void_p]
    splats_count: Annotated[int, c.c_uint32]
    volume_count: Annotated[int, c.c_uint32]
    volumes: Annotated[Any, c.POINTER(ewa_mixed_volume)]


@_struct
class ewa_option(c.Structure):
    name: Annotated[Optional[bytes], c.c_char_p]
    type: Annotated[int, c.c_int]
    offset: Annotated[int, c.c_size_t]
    minimum: Annotated[float, c.c_double]
    maximum: Annotated[float, c.c_double]
    limits: Annotated[int, c.c_uint32]
    count: Annotated[int, c.c_uint32]
    initial: Annotated[float, c.c_double]
    initials: Annotated[Optional[int], c.c_void_p]
    unit: Annotated[Optional[bytes], c.c_char_p]
    words: Annotated[Optional[bytes], c.c_char_p]
    help: Annotated[Optional[bytes], c.c_char_p]


@_struct
class ewa_option_table(c.Structure):
    name: Annotated[Optional[bytes], c.c_char_p]
    options: Annotated[Any, c.POINTER(ewa_option)]
    option_count: Annotated[int, c.c_size_t]
    struct_size: Annotated[int, c.c_size_t]


@_struct
class ewa_panorama_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    kind: Annotated[int, c.c_int]
    fov_deg: Annotated[float, c.c_double]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    finer: Annotated[float, c.c_double]


@_struct
class ewa_image_quality(c.Structure):
    pixel_count: Annotated[int, c.c_uint64]
    mean_squared_error: Annotated[float, c.c_double]
    psnr_db: Annotated[float, c.c_double]
    ssim: Annotated[float, c.c_double]


@_struct
class ewa_photo_report(c.Structure):
    held_out: Annotated[bool, c.c_bool]
    width_px: Annotated[int, c.c_uint32]
    height_px: Annotated[int, c.c_uint32]
    pixel_count: Annotated[int, c.c_uint64]
    point_count: Annotated[int, c.c_uint64]
    gain: Annotated[c.Array[c.c_double], c.c_double * 3]
    offset: Annotated[c.Array[c.c_double], c.c_double * 3]
    rms: Annotated[float, c.c_double]
    rejected: Annotated[float, c.c_double]
    psnr_db: Annotated[float, c.c_double]
    world_to_camera: Annotated[c.Array[c.c_double], c.c_double * 16]
    shift_px: Annotated[float, c.c_double]


@_struct
class ewa_photos_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    method: Annotated[int, c.c_int]
    exposure: Annotated[int, c.c_int]
    hold_out: Annotated[int, c.c_uint32]
    rounds: Annotated[int, c.c_uint32]
    robust: Annotated[float, c.c_double]
    ridge: Annotated[float, c.c_double]
    spacing_px: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    pose_steps: Annotated[int, c.c_uint32]
    vignetting: Annotated[bool, c.c_bool]


@_struct
class ewa_photos_report(c.Structure):
    used_count: Annotated[int, c.c_uint32]
    held_out_count: Annotated[int, c.c_uint32]
    seen_count: Annotated[int, c.c_uint64]
    rms: Annotated[float, c.c_double]
    held_out_rms: Annotated[float, c.c_double]
    psnr_db: Annotated[float, c.c_double]
    held_out_psnr_db: Annotated[float, c.c_double]
    vignetting: Annotated[c.Array[c.c_double], c.c_double * 2]
    low: Annotated[float, c.c_float]
    high: Annotated[float, c.c_float]


@_struct
class ewa_csg_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    operation: Annotated[int, c.c_int]
    cutoff: Annotated[float, c.c_double]
    names: Annotated[c.Array[c.c_char_p], c.c_char_p * 2]


@_struct
class ewa_estimate_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    neighbour_count: Annotated[int, c.c_uint32]
    orientation: Annotated[int, c.c_int]
    viewpoint_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    shape: Annotated[int, c.c_int]
    radius_scale: Annotated[float, c.c_double]
    radius_limit: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    keep_normals: Annotated[bool, c.c_bool]
    keep_radii: Annotated[bool, c.c_bool]
    outlier_factor: Annotated[float, c.c_double]


@_struct
class ewa_feature_counts(c.Structure):
    snapped_count: Annotated[int, c.c_uint64]
    edge_count: Annotated[int, c.c_uint64]
    corner_count: Annotated[int, c.c_uint64]
    noise: Annotated[float, c.c_double]
    neighbour_count: Annotated[int, c.c_uint32]


@_struct
class ewa_feature_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    neighbour_count: Annotated[int, c.c_uint32]
    angle_deg: Annotated[float, c.c_double]
    noise: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    project: Annotated[bool, c.c_bool]


@_struct
class ewa_generate_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    object: Annotated[int, c.c_int]
    point_count: Annotated[int, c.c_uint64]
    seed: Annotated[int, c.c_uint64]
    size_world: Annotated[float, c.c_double]
    jitter: Annotated[float, c.c_double]
    checks: Annotated[float, c.c_double]
    radius_scale: Annotated[float, c.c_double]
    positions_only: Annotated[bool, c.c_bool]
    sharp: Annotated[bool, c.c_bool]
    texcoords: Annotated[bool, c.c_bool]


@_struct
class ewa_refit_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    goal: Annotated[int, c.c_int]
    cutoff: Annotated[float, c.c_double]


@_struct
class ewa_refit_report(c.Structure):
    surfel_count: Annotated[int, c.c_uint64]
    left_out_count: Annotated[int, c.c_uint64]
    before_rms: Annotated[float, c.c_double]
    after_rms: Annotated[float, c.c_double]
    low: Annotated[float, c.c_float]
    high: Annotated[float, c.c_float]
    iteration_count: Annotated[int, c.c_uint32]


@_struct
class ewa_spacing(c.Structure):
    median_world: Annotated[float, c.c_double]
    mean_world: Annotated[float, c.c_double]
    low_world: Annotated[float, c.c_double]
    high_world: Annotated[float, c.c_double]
    duplicate_count: Annotated[int, c.c_uint64]


@_struct
class ewa_volume_generate_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    object: Annotated[int, c.c_int]
    dims: Annotated[c.Array[c.c_uint32], c.c_uint32 * 3]
    size_world: Annotated[float, c.c_double]
    checks: Annotated[float, c.c_double]
    seed: Annotated[int, c.c_uint64]


@_struct
class ewa_procedure_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    procedure: Annotated[int, c.c_int]
    frequency: Annotated[float, c.c_double]
    prefilter: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    seed: Annotated[int, c.c_uint64]
    colors: Annotated[c.Array[Any], (c.c_float * 3) * 2]


@_struct
class ewa_profile(c.Structure):
    context: Annotated[Optional[int], c.c_void_p]
    points: Annotated[Optional[int], c.c_void_p]
    srgb: Annotated[Optional[int], c.c_void_p]
    length_world: Annotated[float, c.c_double]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    unit: Annotated[Optional[bytes], c.c_char_p]


@_struct
class ewa_profile_graph_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    exaggeration: Annotated[float, c.c_double]
    point_size_px: Annotated[float, c.c_double]
    pixel_scale: Annotated[float, c.c_double]
    title: Annotated[Optional[bytes], c.c_char_p]
    unit: Annotated[Optional[bytes], c.c_char_p]


@_struct
class ewa_profile_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    width_world: Annotated[float, c.c_double]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]


@_struct
class ewa_region(c.Structure):
    kept: Annotated[bool, c.c_bool]
    has_box: Annotated[bool, c.c_bool]
    has_classes: Annotated[bool, c.c_bool]
    box_world: Annotated[c.Array[c.c_double], c.c_double * 6]
    box_axes_world: Annotated[c.Array[c.c_double], c.c_double * 9]
    corner_count: Annotated[int, c.c_uint32]
    outline_px: Annotated[c.Array[c.c_double], c.c_double * 128]
    world_to_picture: Annotated[c.Array[c.c_double], c.c_double * 12]
    classes: Annotated[c.Array[c.c_uint32], c.c_uint32 * 8]


@_struct
class ewa_frame(c.Structure):
    rgba8: Annotated[Optional[int], c.c_void_p]
    rgba: Annotated[Optional[int], c.c_void_p]
    depth: Annotated[Optional[int], c.c_void_p]
    normal: Annotated[Optional[int], c.c_void_p]
    coverage: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_render_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    kernel: Annotated[int, c.c_int]
    prefilter_px: Annotated[float, c.c_double]
    point_size_px: Annotated[float, c.c_double]
    tolerance: Annotated[float, c.c_double]
    passes: Annotated[int, c.c_uint32]
    edge_antialiasing: Annotated[bool, c.c_bool]
    edge_threshold: Annotated[float, c.c_double]
    edge_layers: Annotated[int, c.c_uint32]
    opacity: Annotated[float, c.c_double]
    layers: Annotated[int, c.c_uint32]
    cull: Annotated[int, c.c_int]
    shading: Annotated[int, c.c_int]
    lights: Annotated[c.Array[ewa_light], ewa_light * 8]
    light_count: Annotated[int, c.c_uint32]
    ambient: Annotated[float, c.c_double]
    materials: Annotated[Any, c.POINTER(ewa_material)]
    material_count: Annotated[int, c.c_uint32]
    environment: Annotated[Optional[int], c.c_void_p]
    environment_up: Annotated[c.Array[c.c_double], c.c_double * 3]
    eye_dome: Annotated[float, c.c_double]
    background: Annotated[c.Array[c.c_float], c.c_float * 4]
    section_planes: Annotated[c.Array[Any], (c.c_double * 4) * 8]
    section_count: Annotated[int, c.c_uint32]
    level: Annotated[int, c.c_uint32]
    budget_s: Annotated[float, c.c_double]
    supersampling: Annotated[int, c.c_uint32]


@_struct
class ewa_surfels_info(c.Structure):
    point_count: Annotated[int, c.c_uint64]
    left_out_count: Annotated[int, c.c_uint64]
    resident_bytes: Annotated[int, c.c_size_t]
    unit_coverage: Annotated[float, c.c_double]
    transparent: Annotated[bool, c.c_bool]
    bounds: ewa_bounds
    material_count: Annotated[int, c.c_uint32]
    level_count: Annotated[int, c.c_uint32]


@_struct
class ewa_surfels_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    cutoff: Annotated[float, c.c_double]
    radius_scale: Annotated[float, c.c_double]
    level_count: Annotated[int, c.c_uint32]


@_struct
class ewa_texture_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    method: Annotated[int, c.c_int]
    prefilter_px: Annotated[float, c.c_double]
    cutoff: Annotated[float, c.c_double]
    sigma_texels: Annotated[float, c.c_double]
    point_spacing_px: Annotated[float, c.c_double]
    repeat: Annotated[bool, c.c_bool]
    background: Annotated[c.Array[c.c_float], c.c_float * 4]


@_struct
class ewa_texture_source(c.Structure):
    pixels: Annotated[Optional[int], c.c_void_p]
    format: Annotated[int, c.c_int]
    channel_count: Annotated[int, c.c_uint32]
    width_px: Annotated[int, c.c_uint32]
    height_px: Annotated[int, c.c_uint32]
    stride_bytes: Annotated[int, c.c_size_t]


@_struct
class ewa_texture_stats(c.Structure):
    splat_count: Annotated[int, c.c_uint64]
    point_count: Annotated[int, c.c_uint64]
    texel_count: Annotated[int, c.c_uint64]
    point_texel_count: Annotated[int, c.c_uint64]
    level_bytes: Annotated[int, c.c_uint64]
    levels_s: Annotated[float, c.c_double]
    total_s: Annotated[float, c.c_double]


@_struct
class ewa_texture_target(c.Structure):
    pixels: Annotated[Optional[int], c.c_void_p]
    format: Annotated[int, c.c_int]
    channel_count: Annotated[int, c.c_uint32]
    width_px: Annotated[int, c.c_uint32]
    height_px: Annotated[int, c.c_uint32]
    stride_bytes: Annotated[int, c.c_size_t]


@_struct
class ewa_asset_info(c.Structure):
    kind: Annotated[int, c.c_int]
    name: Annotated[Optional[bytes], c.c_char_p]
    count: Annotated[int, c.c_uint64]
    bounds: ewa_bounds
    cloud: Annotated[Optional[int], c.c_void_p]
    lod: Annotated[Optional[int], c.c_void_p]
    surfels: Annotated[Optional[int], c.c_void_p]
    splats: Annotated[Optional[int], c.c_void_p]
    voxels: Annotated[Optional[int], c.c_void_p]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    load_s: Annotated[float, c.c_double]
    drawable: Annotated[bool, c.c_bool]
    changeable: Annotated[bool, c.c_bool]
    colorable: Annotated[bool, c.c_bool]


@_struct
class ewa_filter_range(c.Structure):
    low: Annotated[float, c.c_double]
    high: Annotated[float, c.c_double]
    low_open: Annotated[bool, c.c_bool]
    high_open: Annotated[bool, c.c_bool]


@_struct
class ewa_filter_term(c.Structure):
    name: Annotated[bytes, c.c_char * 64]
    outside: Annotated[bool, c.c_bool]
    range_count: Annotated[int, c.c_uint32]
    ranges: Annotated[c.Array[ewa_filter_range], ewa_filter_range * 32]


@_struct
class ewa_filter(c.Structure):
    term_count: Annotated[int, c.c_uint32]
    terms: Annotated[c.Array[ewa_filter_term], ewa_filter_term * 16]


@_struct
class ewa_asset_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    load: Annotated[Any, c.POINTER(ewa_cloud_load_options)]
    filter: Annotated[Any, c.POINTER(ewa_filter)]
    to_world: Annotated[c.Array[c.c_double], c.c_double * 16]
    gaussians_as_surfels: Annotated[bool, c.c_bool]
    gaussian_levels: Annotated[bool, c.c_bool]
    levels: Annotated[int, c.c_int]
    cutoff: Annotated[float, c.c_double]
    transfer: Annotated[Optional[bytes], c.c_char_p]
    voxel_level_count: Annotated[int, c.c_uint32]
    voxel_level_minimum: Annotated[int, c.c_uint32]
    reach_steps: Annotated[float, c.c_double]
    own_context: Annotated[bool, c.c_bool]
    reader: Annotated[Any, ewa_asset_reader]
    reader_user: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_transfer_point(c.Structure):
    value: Annotated[float, c.c_double]
    color: Annotated[c.Array[c.c_float], c.c_float * 3]
    extinction: Annotated[float, c.c_float]


@_struct
class ewa_transfer(c.Structure):
    points: Annotated[c.Array[ewa_transfer_point], ewa_transfer_point * 1024]
    point_count: Annotated[int, c.c_uint32]
    unit_length_world: Annotated[float, c.c_double]
    gradient_low: Annotated[float, c.c_double]
    gradient_high: Annotated[float, c.c_double]


@_struct
class ewa_volume(c.Structure):
    context: Annotated[Optional[int], c.c_void_p]
    dims: Annotated[c.Array[c.c_uint32], c.c_uint32 * 3]
    type: Annotated[int, c.c_int]
    voxels: Annotated[Optional[int], c.c_void_p]
    index_to_world: Annotated[c.Array[c.c_double], c.c_double * 12]
    anatomical: Annotated[bool, c.c_bool]


@_struct
class ewa_asset_source(c.Structure):
    name: Annotated[Optional[bytes], c.c_char_p]
    cloud: Annotated[Optional[int], c.c_void_p]
    surfels: Annotated[Optional[int], c.c_void_p]
    lod: Annotated[Optional[int], c.c_void_p]
    splats: Annotated[Optional[int], c.c_void_p]
    voxels: Annotated[Optional[int], c.c_void_p]
    mesh: Annotated[Any, c.POINTER(ewa_mesh)]
    gaussians: Annotated[Any, c.POINTER(ewa_gaussians)]
    volume: Annotated[Any, c.POINTER(ewa_volume)]
    transfer: Annotated[Any, c.POINTER(ewa_transfer)]
    outline: Annotated[Optional[int], c.c_void_p]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    flat: Annotated[bool, c.c_bool]
    release: Annotated[Any, c.CFUNCTYPE(None, c.c_void_p)]
    user: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_instance(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    visible: Annotated[bool, c.c_bool]
    opacity: Annotated[float, c.c_double]
    radius_scale: Annotated[float, c.c_double]
    material: Annotated[int, c.c_uint32]
    coloring: ewa_coloring


@_struct
class ewa_photo_comparison(c.Structure):
    photo: ewa_image
    picture: ewa_image
    quality: ewa_image_quality


@_struct
class ewa_scene_hit(c.Structure):
    hit: Annotated[bool, c.c_bool]
    depth: Annotated[float, c.c_double]
    place_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    has_point: Annotated[bool, c.c_bool]
    instance: Annotated[int, c.c_uint32]
    point: Annotated[int, c.c_uint64]
    point_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    points: Annotated[Optional[int], c.c_void_p]


@_struct
class ewa_scene_info(c.Structure):
    instance_count: Annotated[int, c.c_uint32]
    visible_count: Annotated[int, c.c_uint32]
    point_count: Annotated[int, c.c_uint64]
    surfaces: Annotated[bool, c.c_bool]
    octrees: Annotated[bool, c.c_bool]
    gaussians: Annotated[bool, c.c_bool]
    volumes: Annotated[bool, c.c_bool]
    gaussian_levels: Annotated[bool, c.c_bool]
    surfels: ewa_surfels_info
    resident: Annotated[Optional[int], c.c_void_p]
    unit: Annotated[Optional[bytes], c.c_char_p]
    estimated_count: Annotated[int, c.c_uint64]
    load_s: Annotated[float, c.c_double]
    estimate_s: Annotated[float, c.c_double]
    surfels_s: Annotated[float, c.c_double]


@_struct
class ewa_scene_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    up: Annotated[int, c.c_int]
    close_gaps: Annotated[bool, c.c_bool]
    keep_points: Annotated[bool, c.c_bool]
    shade_volumes: Annotated[bool, c.c_bool]
    surfels: ewa_surfels_options
    lod: ewa_lod_options
    render: ewa_render_options
    gaussians: ewa_gaussian_options
    volumes: ewa_volume_options
    regions: Annotated[c.Array[ewa_region], ewa_region * 16]
    region_count: Annotated[int, c.c_uint32]
    many_frames: Annotated[bool, c.c_bool]


@_struct
class ewa_scene_stats(c.Structure):
    render: ewa_render_stats
    lod: ewa_lod_stats
    volumes: ewa_volume_stats
    total_s: Annotated[float, c.c_double]


@_struct
class ewa_view_info(c.Structure):
    upright: ewa_upright
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    pivot_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    trimmed: Annotated[bool, c.c_bool]


@_struct
class ewa_view_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    width_px: Annotated[int, c.c_uint32]
    height_px: Annotated[int, c.c_uint32]
    fov_deg: Annotated[float, c.c_double]
    ortho_height_world: Annotated[float, c.c_double]
    view: Annotated[int, c.c_int32]
    up_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    has_eye: Annotated[bool, c.c_bool]
    has_target: Annotated[bool, c.c_bool]
    eye_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    target_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    azimuth_deg: Annotated[float, c.c_double]
    elevation_deg: Annotated[float, c.c_double]
    turntable: Annotated[bool, c.c_bool]
    direction_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    color_bar: Annotated[bool, c.c_bool]


@_struct
class ewa_scene_entry(c.Structure):
    path: Annotated[Optional[bytes], c.c_char_p]
    asset: ewa_asset_options
    instance: ewa_instance


@_struct
class ewa_scalar(c.Structure):
    attribute: ewa_attribute
    component: Annotated[int, c.c_uint32]
    shift_world: Annotated[float, c.c_double]
    grid: ewa_coordinate_grid


@_struct
class ewa_volume_facts(c.Structure):
    voxel_count: Annotated[int, c.c_uint64]
    finite_count: Annotated[int, c.c_uint64]
    low: Annotated[float, c.c_double]
    high: Annotated[float, c.c_double]
    mean: Annotated[float, c.c_double]
    histogram: Annotated[c.Array[c.c_uint64], c.c_uint64 * 256]
    spacing_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    low_world: Annotated[c.Array[c.c_double], c.c_double * 3]
    high_world: Annotated[c.Array[c.c_double], c.c_double * 3]


@_struct
class ewa_voxels_info(c.Structure):
    voxel_count: Annotated[int, c.c_uint64]
    occupied_count: Annotated[int, c.c_uint64]
    block_count: Annotated[int, c.c_uint64]
    skipped_count: Annotated[int, c.c_uint64]
    level_count: Annotated[int, c.c_uint32]
    resident_bytes: Annotated[int, c.c_size_t]
    bounds: ewa_bounds
    spacing_world: Annotated[float, c.c_double]


@_struct
class ewa_voxels_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    level_count: Annotated[int, c.c_uint32]


@_struct
class ewa_depth_image(c.Structure):
    camera: ewa_camera
    depth: Annotated[Optional[int], c.c_void_p]
    depth_type: Annotated[int, c.c_int]
    depth_stride_bytes: Annotated[int, c.c_size_t]
    kind: Annotated[int, c.c_int]
    depth_scale: Annotated[float, c.c_double]
    baseline_world: Annotated[float, c.c_double]
    disparity_offset_px: Annotated[float, c.c_double]
    color: Annotated[Optional[int], c.c_void_p]
    color_type: Annotated[int, c.c_int]
    color_channel_count: Annotated[int, c.c_uint32]
    color_stride_bytes: Annotated[int, c.c_size_t]


@_struct
class ewa_warp_facts(c.Structure):
    pixel_count: Annotated[int, c.c_uint64]
    sample_count: Annotated[int, c.c_uint64]
    flying_count: Annotated[int, c.c_uint64]
    take_s: Annotated[float, c.c_double]


@_struct
class ewa_warp_options(c.Structure):
    struct_size: Annotated[int, c.c_size_t]
    cutoff: Annotated[float, c.c_double]
    radius_spacings: Annotated[float, c.c_double]
    depth_jump: Annotated[float, c.c_double]
    depth_noise: Annotated[float, c.c_double]
    drop_flying: Annotated[bool, c.c_bool]
    nearest_world: Annotated[float, c.c_double]
    farthest_world: Annotated[float, c.c_double]


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
        self.ewa_camera_resize: Callable[..., None] = bind("ewa_camera_resize", None, c.POINTER(ewa_camera), c.c_int, c.c_uint32, c.c_uint32)
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
        self.ewa_jpeg_save: Callable[..., int] = bind("ewa_jpeg_save", c.c_int, c.c_void_p, c.c_char_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p, c.c_size_t, c.POINTER(ewa_image_save_options))
        self.ewa_materials_load: Callable[..., int] = bind("ewa_materials_load", c.c_int, c.c_void_p, c.c_char_p, c.POINTER(ewa_material), c.c_void_p)
        self.ewa_parts: Callable[..., bytes | None] = bind("ewa_parts", c.c_char_p)
        self.ewa_photo_list_destroy: Callable[..., None] = bind("ewa_photo_list_destroy", None, c.c_void_p)
        self.ewa_photo_list_find_masks: Callable[..., int] = bind("ewa_photo_list_find_masks", c.c_int, c.c_void_p, c.c_char_p)
        self.ewa_photo_list_load: Callable[..., int] = bind("ewa_photo_list_load", c.c_int, c.c_void_p, c.c_char_p, c.c_char_p, c.c_void_p)
        self.ewa_photo_list_photos: Callable[..., Any] = bind("ewa_photo_list_photos", c.POINTER(ewa_photo), c.c_void_p, c.c_void_p)
        self.ewa_pixels_save: Callable[..., int] = bind("ewa_pixels_save", c.c_int, c.c_void_p, c.c_char_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p, c.c_size_t, c.POINTER(ewa_image_save_options))
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
        self.ewa_scene_renderer_describe: Callable[..., int] = bind("ewa_scene_renderer_describe", c.c_int, c.c_void_p, c.POINTER(ewa_renderer_info))
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
