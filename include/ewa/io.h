// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files: point clouds, images, cameras. Formats are chosen by content on input and by suffix on output.
// Output files appear whole or not at all: they are written under a temporary name and renamed. Every failure
// names the file, the place in it and the reason.
#ifndef EWA_IO_H
#define EWA_IO_H

#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/cloud.h"
#include "ewa/image.h"
#include "ewa/options.h"
#include "ewa/shade.h"
#include "ewa/volume.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Returns which of the parts that can be left out of a library are in the one that runs, with blanks between: "spng deflate
/// jpeg threads" (EWA_WITH_SPNG and so on, docs/install.md); never NULL. Any thread.
EWA_API const char *ewa_parts(void);

/// Reads a point cloud, the format by content: PLY, LAS and LAZ, E57, PCD, PTX, ASCII grids, GeoTIFF, and text in
/// columns (XYZ, PTS, CSV); docs/files.md says what is read of each. Of PLY (ascii, binary of both byte orders), the element
/// "vertex" holds the points; other elements and lists are skipped. Its properties become the attributes of
/// ewa/cloud.h by their names:
///   - x y z: "position", F64 when one of them is a double or a 32-bit integer, so that it is exact, else
///     F32;
///   - nx ny nz or normal_x normal_y normal_z: "normal", F32;
///   - red green blue [alpha], or diffuse_red ..., or r g b [a]: "color"; U16 from ushort, F32 from float
///     and double, U8 from every other integer type, clamped to [0, 255];
///   - radius, tu_x tu_y tu_z, tv_x tv_y tv_z, clip0_a clip0_b clip0_c, clip1_a clip1_b clip1_c, border_x border_y
///     border_z: "radius", "tangent_u", "tangent_v", "clip0", "clip1", "border", F32;
///   - every other scalar: an attribute of that name and type.
///
/// "-" reads standard input. The caller owns `*cloud`, which is NULL after a failure. A file that another
/// program cuts short while it is read ends the process by SIGBUS, as every mapped file does. Errors:
/// EWA_ERROR_IO, EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_cloud_load(ewa_context *context, const char *path, ewa_cloud **cloud);

/// The same from `size_bytes` bytes in memory; `name` stands for the file in messages.
EWA_API ewa_status ewa_cloud_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                         const char *name, ewa_cloud **cloud);

/// What the colours of a picture say about heights.
typedef enum ewa_picture_heights {
    EWA_HEIGHTS_NONE = 0,    ///< nothing: it is a picture
    EWA_HEIGHTS_TERRAIN_RGB, ///< of Mapbox: (65536 R + 256 G + B) / 10 - 10000 metres
    EWA_HEIGHTS_TERRARIUM,   ///< 256 R + G + B / 256 - 32768 metres
} ewa_picture_heights;

/// How a cloud is read. Fill with ewa_cloud_load_options_init().
typedef struct ewa_cloud_load_options {
    size_t struct_size;
    /// Step over damaged pieces of a file, with a warning that says where, and count the points that are lost
    /// with them; default false: the first one ends the call.
    bool keep_going;
    /// Names of the attributes that are wanted, comma-separated, besides "position"; default NULL: all.
    const char *attributes;
    /// Columns of a text file in their order, comma-separated: x, y, z, r, g, b, nx, ny, nz, intensity, ...
    /// or "-" for one that is left out; default NULL: as the file's head or its numbers say.
    const char *columns;
    /// PNG and WebP are grids of heights, a point for each pixel; default EWA_HEIGHTS_NONE: refused as pictures.
    ewa_picture_heights heights;
} ewa_cloud_load_options;

EWA_API extern const ewa_option_table ewa_cloud_load_options_table;
EWA_API void ewa_cloud_load_options_init(ewa_cloud_load_options *options, size_t struct_size);

/// A number of points that is not known before all have been read.
#define EWA_POINTS_UNKNOWN UINT64_MAX

/// A file whose points are read piece by piece, in the order of the file.
typedef struct ewa_cloud_reader ewa_cloud_reader;

/// Opens a file of points for reading in pieces; of PLY with faces, the vertices are read. The caller closes
/// `*reader`, which is NULL after a failure. `options` may be NULL and is not needed after the call. Errors
/// as ewa_cloud_load().
EWA_API ewa_status ewa_cloud_reader_open(ewa_context *context, const char *path,
                                         const ewa_cloud_load_options *options, ewa_cloud_reader **reader);

/// Returns a cloud of no points with the attributes, the origin, the grid and the notes of every piece.
EWA_API const ewa_cloud *ewa_cloud_reader_prototype(const ewa_cloud_reader *reader);

/// Returns a number of points that is never exceeded.
EWA_API uint64_t ewa_cloud_reader_maximum_points(const ewa_cloud_reader *reader);

/// Reads the next points, at most `maximum_points` > 0, into a cloud that the caller owns; NULL at the end.
EWA_API ewa_status ewa_cloud_reader_next(ewa_cloud_reader *reader, uint64_t maximum_points,
                                         ewa_cloud **piece);

/// Returns how many points were lost to damage so far (`keep_going`).
EWA_API uint64_t ewa_cloud_reader_lost_count(const ewa_cloud_reader *reader);

/// Closes the file and sets `*reader` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_cloud_reader_close(ewa_cloud_reader **reader);

/// Receives one line of text without its line feed, valid during the call.
typedef void ewa_line_callback(void *user, const char *line);

/// Hands over the header of a PLY file, checked, line by line without the first ("ply") and the last
/// ("end_header"): "format binary_little_endian 1.0", "comment ...", "element vertex 341989", "property float
/// x", ... Bytes that are no printable ASCII are shown as '?', lines longer than 511 bytes are cut. Errors:
/// EWA_ERROR_IO, EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_ply_describe(ewa_context *context, const char *path, ewa_line_callback *line,
                                    void *user);

typedef enum ewa_ply_encoding {
    EWA_PLY_BINARY_LITTLE_ENDIAN = 0,
    EWA_PLY_BINARY_BIG_ENDIAN = 1,
    EWA_PLY_ASCII = 2,
} ewa_ply_encoding;

/// What a PLY file holds beside its vertices, such as faces: ewa_model_load() reads it, ewa_cloud_save()
/// writes it.
typedef struct ewa_elements ewa_elements;

/// Returns how many faces and strips are among them; of NULL, 0.
EWA_API uint64_t ewa_elements_face_count(const ewa_elements *elements);

/// Frees the elements and sets `*elements` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_elements_free(ewa_elements **elements);

typedef struct ewa_cloud_save_options {
    size_t struct_size;
    ewa_ply_encoding ply_encoding; ///< default EWA_PLY_BINARY_LITTLE_ENDIAN
    /// Elements that are written with the vertices, in the order of their file, after its comments; default
    /// NULL. Their numbers of vertices count only as long as the cloud has the points of that file in their
    /// order.
    const ewa_elements *elements;
    /// Step of the coordinates of LAS, LAZ, world units, [0, inf); default 0: that of the cloud's grid, else the finest
    /// of 1e-4, 1e-3, 1e-2 with which the box fits 32 bits, finer for small objects.
    double step_world;
    uint32_t chunk_points; ///< points of one chunk of LAZ; default 50000
} ewa_cloud_save_options;

EWA_API extern const ewa_option_table ewa_cloud_save_options_table;
EWA_API void ewa_cloud_save_options_init(ewa_cloud_save_options *options, size_t struct_size);

/// Writes a point cloud; the suffix (.ply) chooses the format; "-" writes PLY to standard output. Attributes
/// get the first property names that ewa_cloud_load() knows them by and keep their types; with an origin
/// other than zero, positions are written as doubles in world units. Any other attribute of several
/// components becomes name_0, name_1, ... In all encodings, numbers keep every bit (ascii: except of NaN).
/// `options` may be NULL. Errors: EWA_ERROR_ARGUMENT (no position, two attributes that become one property),
/// EWA_ERROR_LIMIT (over 1,000 properties), EWA_ERROR_IO, EWA_ERROR_UNSUPPORTED (suffix), EWA_ERROR_MEMORY,
/// EWA_CANCELLED.
EWA_API ewa_status ewa_cloud_save(const ewa_cloud *cloud, const char *path,
                                  const ewa_cloud_save_options *options);

/// A file of points that is written piece by piece.
typedef struct ewa_cloud_writer ewa_cloud_writer;

/// Whether a cloud like the prototype can be written to a path, by its suffix, only when the box of all points
/// is known before the first.
EWA_API bool ewa_cloud_writer_needs_bounds(const char *path, const ewa_cloud *prototype);

/// Begins a file for `point_count` points (EWA_POINTS_UNKNOWN: as many as come) that all have the attributes,
/// in their order, the origin, the grid and the notes of `prototype`, whose own points are not looked at;
/// `bounds` is the box of all of them, which LAS needs where there is no grid; else NULL. The suffix chooses
/// the format as in ewa_cloud_save(). `options` and `prototype` stay the caller's and are not needed after
/// the call. End with ewa_cloud_writer_commit() or ewa_cloud_writer_abort(). Errors as ewa_cloud_save().
EWA_API ewa_status ewa_cloud_writer_open(ewa_context *context, const char *path,
                                         const ewa_cloud_save_options *options, const ewa_cloud *prototype,
                                         uint64_t point_count, const ewa_bounds *bounds,
                                         ewa_cloud_writer **writer);

/// Appends the points of a piece, which has the attributes of the prototype.
EWA_API ewa_status ewa_cloud_writer_put(ewa_cloud_writer *writer, const ewa_cloud *piece);

/// Finishes the file, which appears now, and sets `*writer` to NULL, also after a failure, which removes it.
EWA_API ewa_status ewa_cloud_writer_commit(ewa_cloud_writer **writer);

/// Removes what was written and sets `*writer` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_cloud_writer_abort(ewa_cloud_writer **writer);

/// What a picture file says beside its pixels. Fill with ewa_image_save_options_init().
typedef struct ewa_image_save_options {
    size_t struct_size;
    /// Names of the image's channels for EXR, comma-separated, such as "R,G,B,A" or "Z"; default NULL: by
    /// count, 1 Y, 3 RGB, 4 RGBA; other counts need names.
    const char *channel_names;
    bool exr_half; ///< store half floats; default false: float
    /// 16 numbers as in ewa_camera, or NULL: EXR attribute worldToCamera (m44f), transposed there, since
    /// OpenEXR's matrices act on row vectors.
    const double *world_to_camera;
    bool srgb_alpha_straight; ///< PNG, JPEG: un-premultiply before encoding; default true
    uint32_t jpeg_quality;    ///< JPEG: from 0 (small) to 100 (good), on libjpeg's scale; [0, 100]; default 95
} ewa_image_save_options;

EWA_API extern const ewa_option_table ewa_image_save_options_table;
EWA_API void ewa_image_save_options_init(ewa_image_save_options *options, size_t struct_size);

/// Writes a float image by suffix: .png (8-bit sRGB from linear light; RGBA loses its alpha when that is 1
/// all over), .jpg or .jpeg (the same by ewa_jpeg_save()), .exr (linear, ZIP), .pfm (linear, rows bottom-up; of RGBA the colours as they are, which is
/// over black).
/// "-" writes PNG to standard output. `options` may be NULL.
/// Errors: EWA_ERROR_ARGUMENT (channel names), EWA_ERROR_IO, EWA_ERROR_UNSUPPORTED (suffix, channel count of
/// the format), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_image_save(const ewa_image *image, const char *path,
                                  const ewa_image_save_options *options);

/// Writes 8-bit pixels as PNG: rows from the top, `stride_bytes` apart, `channel_count` 1 grey, 3 RGB or 4
/// RGBA straight alpha, sRGB. The same pixels give the same file on every machine and for any number of
/// threads. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_IO, EWA_ERROR_UNSUPPORTED (channel count),
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_png_save(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                                uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes);

/// Writes 8-bit pixels as JPEG of the `jpeg_quality` of `options` (NULL: defaults), of which no other member counts; colours as fine as
/// light; the other arguments as of ewa_png_save(). Transparent pixels are put over white, which a warning tells. The same pixels give the
/// same file for any number of threads. Errors:
/// EWA_ERROR_ARGUMENT (over 65,500 pixels a side, too), EWA_ERROR_IO, EWA_ERROR_UNSUPPORTED (channel count),
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_jpeg_save(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                                 uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes,
                                 const ewa_image_save_options *options);

/// Writes 8-bit pixels by suffix: .jpg and .jpeg by ewa_jpeg_save(), .png and "-", standard output, by ewa_png_save(), which see, and
/// which take no options.
/// Errors: theirs; EWA_ERROR_UNSUPPORTED for other suffixes, too.
EWA_API ewa_status ewa_pixels_save(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                                   uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes,
                                   const ewa_image_save_options *options);

/// Reads PNG, JPEG, WebP, OpenEXR, PFM or Radiance (.hdr), by content; "-" reads standard input. The caller
/// frees the image. PNG: sRGB of up to 16 bits to linear light; grey gives 1 channel, RGB and palettes 3,
/// anything with alpha 4, premultiplied; gamma and colour profiles are not looked at. JPEG: grey or colour,
/// sRGB. WebP: a still picture, sRGB, with alpha 4 channels, premultiplied. OpenEXR: the data window of the
/// first part, scan lines or tiles; R G B [A] when present, else its channels in alphabetical order, at
/// most 16. PFM: 1 or 3 channels, either byte order. Radiance: RGBE, plain or run-length encoded, divided by
/// its exposure; 3 channels. Errors (image empty): EWA_ERROR_IO, EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED,
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_image_load(ewa_context *context, const char *path, ewa_image *image);

/// The same from `size_bytes` bytes in memory; `name` stands for the file in messages.
EWA_API ewa_status ewa_image_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                         const char *name, ewa_image *image);

/// Reads the numbers of a depth image into one channel, by content; "-" reads standard input. The caller
/// frees the image. PNG: grey of 8 or 16 bits, the integers themselves, but for 65535, which says that
/// nothing was measured and becomes infinity. OpenEXR, PFM: the only channel. Errors (image empty):
/// EWA_ERROR_IO, EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED (other pictures), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_depth_load(ewa_context *context, const char *path, ewa_image *depth);

/// The same from `size_bytes` bytes in memory; `name` stands for the file in messages.
EWA_API ewa_status ewa_depth_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                         const char *name, ewa_image *depth);

/// Reads a material table from JSON: an array of objects, or an object whose "materials" is one, with any of
/// the members "ambient", "diffuse", "specular", "shininess", "reflection" of ewa_material and "name", which
/// is not looked at; members that are not there have the default. `*count` gets how many there are, 1 to
/// EWA_MAX_MATERIALS; 0 after a failure. "-" reads standard input. Errors, with the member: EWA_ERROR_IO,
/// EWA_ERROR_FORMAT, EWA_ERROR_LIMIT (more than EWA_MAX_MATERIALS), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_materials_load(ewa_context *context, const char *path,
                                      ewa_material materials[EWA_MAX_MATERIALS], uint32_t *count);

/// Whether a name has a suffix of volumes, which is how they are told from other files. Any thread.
EWA_API bool ewa_volume_is_named(const char *path);

/// Whether a file is to be read as a volume: by its name, but for VTK files of polygons or cells, which are meshes.
EWA_API bool ewa_volume_is_file(ewa_context *context, const char *path);

/// What a volume file does not say itself. Fill with ewa_volume_load_options_init().
typedef struct ewa_volume_load_options {
    size_t struct_size;
    uint32_t dims[3];        ///< given: the file is raw numbers, x fastest; default zeros: as the file says
    int type;                ///< ewa_type of raw numbers; default -1: from the file's name, or EWA_U8
    bool big_endian;         ///< of raw numbers; default false
    uint64_t header_bytes;   ///< in front of raw numbers; default 0
    double spacing_world[3]; ///< distances of voxels, of every format; [0, inf); default zeros: as the file
                             ///< says, or 1
} ewa_volume_load_options;

EWA_API extern const ewa_option_table ewa_volume_load_options_table;
EWA_API void ewa_volume_load_options_init(ewa_volume_load_options *options, size_t struct_size);

/// Reads a volume, the format by content; "-" reads standard input:
/// - NRRD, attached and detached (.nhdr): encodings raw, gzip, bzip2, ascii, hex; lists and patterns of
///   files;
/// - NIfTI-1 and -2 and Analyze: .nii, .nii.gz, pairs .hdr and .img; sform before qform; slope and intercept;
/// - MetaImage: .mha, .mhd; zlib; lists and patterns of files;
/// - VTK: legacy structured points, and .vti with appended raw data, plain or zlib;
/// - raw numbers, also in gzip, by `options` or by a name such as aneurism_256x256x256_uint8.raw.gz.
///
/// World axes are the patient's left, posterior, superior where the file says so (DICOM, ITK): files in
/// right-anterior-superior are turned. A file that says no place has the volume's middle at the origin.
/// Numbers of 32 and 64 bits become floats; so do colours, as their luminance. Of several volumes the first
/// is read, with a warning. What is infinite becomes NaN. The caller frees the volume; `options` may be NULL.
/// Errors (volume zeroed): EWA_ERROR_IO, EWA_ERROR_FORMAT (also bytes that contradict the dims, spacings of
/// zero, axes in one plane), EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_volume_load(ewa_context *context, const char *path,
                                   const ewa_volume_load_options *options, ewa_volume *volume);

/// The same from `size_bytes` bytes in memory; `name` stands for the file in messages. Voxels in other files
/// are EWA_ERROR_UNSUPPORTED.
EWA_API ewa_status ewa_volume_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                          const char *name, const ewa_volume_load_options *options,
                                          ewa_volume *volume);

typedef struct ewa_volume_save_options {
    size_t struct_size;
    bool plain; ///< not compressed; default false: gzip
} ewa_volume_save_options;

EWA_API extern const ewa_option_table ewa_volume_save_options_table;
EWA_API void ewa_volume_save_options_init(ewa_volume_save_options *options, size_t struct_size);

/// Writes a volume as NRRD (.nrrd) with its place in left-posterior-superior; "-" is standard output. The
/// same voxels give the same file on every machine. `options` may be NULL. Errors: EWA_ERROR_ARGUMENT,
/// EWA_ERROR_UNSUPPORTED (suffix), EWA_ERROR_IO, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_volume_save(const ewa_volume *volume, const char *path,
                                   const ewa_volume_save_options *options);

/// Reads a transfer function from JSON (docs/volume_files.md): {"points": [{"value", "color": [r, g, b],
/// "opacity" or "extinction"}, ...], "unit_length", "color_space": "srgb" or "linear", "gradient": [low,
/// high]}. "-" reads standard input. Errors, with the member: EWA_ERROR_IO, EWA_ERROR_FORMAT,
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_transfer_load(ewa_context *context, const char *path, ewa_transfer *transfer);

/// Makes the transfer function that a word stands for: a preset's name, "auto" (NULL too: ewa_transfer_automatic()), or a
/// file, of which a note names the presets where it is not there. Errors: those of ewa_transfer_load() and
/// ewa_transfer_preset(); EWA_ERROR_FORMAT (no voxel is finite).
EWA_API ewa_status ewa_transfer_choose(ewa_context *context, const char *word, const ewa_volume *volume,
                                       ewa_transfer *transfer);

/// Writes a transfer function so that ewa_transfer_load() gives the same numbers. Errors: EWA_ERROR_ARGUMENT
/// (a member that is not what ewa_transfer says), EWA_ERROR_IO, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_transfer_save(ewa_context *context, const ewa_transfer *transfer, const char *path);

/// Reads camera `index`, counted from 0 in the file's order, into an initialised `*camera`. The format goes
/// by content:
/// - ours: {"width", "height", "fx", "fy", "cx", "cy", "world_to_camera": 16 numbers, row-major} in pixels,
///   with "projection": "orthographic" for such; or an array of these;
/// - Open3D PinholeCameraParameters and PinholeCameraTrajectory;
/// - transforms.json of nerfstudio and instant-ngp; without "w", "h" the size is that of the frame's PNG
///   picture;
/// - cameras.json of INRIA's Gaussian splatting;
/// - cameras.xml of Metashape: aligned and enabled cameras of its first chunk, in the space of exported points;
/// - stacks of matrices: {"width", "height", "viewmats" or "viewmats_world_to_camera", "Ks"};
/// - a folder with a COLMAP model: cameras and images, .bin or else .txt;
/// - scene files: their camera, where there is one, then their keyframes.
///
/// Principal points are those of pixel centres at halves; Open3D's, which has them at whole numbers, move by
/// half a pixel. Lens distortion is left out with a warning. "-" reads standard input. Errors (camera
/// unchanged), with the member that is missing or wrong: EWA_ERROR_IO, EWA_ERROR_FORMAT,
/// EWA_ERROR_UNSUPPORTED (fisheye), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_ERROR_ARGUMENT (index).
EWA_API ewa_status ewa_camera_load(ewa_context *context, const char *path, uint32_t index,
                                   ewa_camera *camera);

/// Reads size, projection and intrinsics of the first camera of a file; `*lens` is at the origin then.
/// Formats as ewa_camera_load(), and Open3D's PinholeCameraIntrinsic, which has no pose; of the text of a 3 x 3 matrix
/// (fx 0 cx, 0 fy cy, 0 0 1) intrinsics alone, and `*lens` keeps all else. Errors (lens unchanged) as there.
EWA_API ewa_status ewa_camera_load_lens(ewa_context *context, const char *path, ewa_camera *lens);

/// Receives camera `index`, counted from 0, of a file; `*camera` is valid during the call.
typedef void ewa_camera_callback(void *user, uint32_t index, const ewa_camera *camera);

/// Hands over every camera of a file, in its order, having read it once, of a scene file its keyframes alone; formats and
/// errors as ewa_camera_load(). After a failure, none has been handed over.
EWA_API ewa_status ewa_camera_load_each(ewa_context *context, const char *path, ewa_camera_callback *receive,
                                        void *user);

/// Hands over a camera for every pose of a text file, in its order: `lens` there. Poses are camera to world,
/// with OpenCV's axes: matrices of four lines of four numbers, a line of up to three numbers before each left
/// out (trajectories of Open3D and Redwood); or lines of time, position and quaternion x y z w (TUM). Blank
/// lines and what follows a '#' are skipped. Errors, with the line; none has been handed over then:
/// EWA_ERROR_IO, EWA_ERROR_FORMAT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_camera_load_poses(ewa_context *context, const char *path, const ewa_camera *lens,
                                         ewa_camera_callback *receive, void *user);

/// Writes a camera file of our format with every digit that a double needs.
/// Errors: EWA_ERROR_ARGUMENT (as ewa_camera_check()), EWA_ERROR_IO, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_camera_save(ewa_context *context, const ewa_camera *camera, const char *path);

/// Writes `count` >= 1 cameras as an array of our format. Errors as ewa_camera_save().
EWA_API ewa_status ewa_camera_save_list(ewa_context *context, const ewa_camera *cameras, size_t count,
                                        const char *path);

typedef enum ewa_lens_model {
    EWA_LENS_PINHOLE = 0, ///< no distortion
    /// OpenCV's: of a slope (x, y), r2 = x2 + y2, are shown x f + 2 p1 x y + p2 (r2 + 2 x2) and y f + 2 p2 x y +
    /// p1 (r2 + 2 y2), f = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)
    EWA_LENS_BROWN = 1,
    /// OpenCV's fisheye: at the angle a from the axis, a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8) from the middle
    EWA_LENS_FISHEYE = 2,
} ewa_lens_model;

/// What a lens does to the picture of a pinhole, whose focal lengths and principal point stay.
typedef struct ewa_lens {
    ewa_lens_model model;
    double radial[6];     ///< k1 to k6; fisheye: to k4
    double tangential[2]; ///< p1, p2
} ewa_lens;

/// A photograph and the camera that took it.
typedef struct ewa_photo {
    ewa_camera camera;
    ewa_lens lens;          ///< zeros: none
    const char *path;       ///< of its file; NULL: none
    const ewa_image *image; ///< of the camera's size, 1, 3 or 4 channels, linear light, premultiplied; NULL: as the file has it
    const char *mask_path; ///< picture of the photograph's size, white where it counts, black where not; NULL: it all counts
} ewa_photo;

/// The photographs that a file of cameras names.
typedef struct ewa_photo_list ewa_photo_list;

/// Reads cameras and finds the photographs that they took, none of which is read: a COLMAP model, Metashape's
/// cameras.xml, transforms.json, cameras.json, our own cameras with a "file_path"; with their lenses: COLMAP's SIMPLE_RADIAL,
/// RADIAL, OPENCV, FULL_OPENCV, SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE and OPENCV_FISHEYE, nerfstudio's OPENCV and OPENCV_FISHEYE,
/// Metashape's frame and fisheye but for k4 and skew of the former. `images`: the folder that names are relative to; NULL: the folder
/// "images" in or above that of a COLMAP model, else that of the file. Names without a suffix get .png, .jpg, .JPG,
/// .jpeg. What files name lies where ewa_context_options.named_files lets it be. The caller destroys `*list`, which is
/// NULL after a failure. Errors: those of ewa_camera_load(); EWA_ERROR_FORMAT (a camera without a name),
/// EWA_ERROR_UNSUPPORTED (another model of a lens), EWA_ERROR_IO (a photograph that is not there; the message has its name).
EWA_API ewa_status ewa_photo_list_load(ewa_context *context, const char *path, const char *images,
                                       ewa_photo_list **list);

/// Finds the masks of photographs in a folder: of a photograph NAME.jpg the picture NAME.jpg.png (COLMAP), NAME.png, .jpg,
/// .JPG or .jpeg, in the folder of that name or by the last part of the name alone. A photograph without a mask counts as a
/// whole, which a warning says. Errors: EWA_ERROR_IO (a folder that has a mask of none), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_photo_list_find_masks(ewa_photo_list *list, const char *folder);

/// Returns the photographs in the order of the file, borrowed; `*count` gets how many there are.
EWA_API const ewa_photo *ewa_photo_list_photos(const ewa_photo_list *list, uint32_t *count);

/// Frees the list and sets `*list` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_photo_list_destroy(ewa_photo_list **list);

#ifdef __cplusplus
}
#endif
#endif
