// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Point clouds as named attribute streams.
#ifndef EWA_CLOUD_H
#define EWA_CLOUD_H

#include "ewa/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The attributes that the library gives a meaning to. Every other name is kept and passed through.
///
/// | name         | components | meaning                                                                   |
/// |--------------|-----------:|---------------------------------------------------------------------------|
/// | position     |          3 | world units, relative to the cloud's origin; F32 or F64                   |
/// | normal       |          3 | outward; any length but zero                                              |
/// | color        |       3, 4 | red green blue [alpha]; integer types are sRGB over their whole range,    |
/// |              |            | floats linear                                                             |
/// | radius       |          1 | support radius of the disc, world units: sigma = radius / cutoff          |
/// | tangent_u    |          3 | first axis of the kernel, length = one standard deviation, world units    |
/// | tangent_v    |          3 | second axis; they win over radius; the normal is u x v unless given       |
/// | material     |          1 | index into a material table                                               |
/// | surfaceness  |          1 | 1: part of a surface, to 0: not at all; below 0.5 it faces the viewer     |
/// | signed_curvature |      1 | sqrt((k^2 + m^2) / 2), at most abs(k + m), with the sign of k + m: of the |
/// |              |            | principal curvatures, in 1 / world unit, positive where the surface turns |
/// |              |            | away from its normal's side; 0: flat, or not known; NaN: not measured     |
/// | clip0, clip1 |          3 | clip line (a, b, c): keep a u + b v + c >= 0 at                           |
/// |              |            | position + u tangent_u + v tangent_v                                      |
/// | clip_mode    |          1 | 0: both lines hold, 1: either holds                                       |
/// | border       |          3 | of discs: vector b from the position to where the surface ends, world     |
/// |              |            | units: of the disc, x with (x - position).b <= b.b are kept; 0: all       |
///
/// Readers of scans give these names, with one component each, to what the formats have in common: intensity,
/// return_number, number_of_returns, scan_direction_flag, edge_of_flight_line, classification, synthetic,
/// key_point, withheld, overlap, scanner_channel, user_data, scan_angle (degrees, F32), point_source_id,
/// gps_time (F64), nir. 8-bit colours become U8, 16-bit colours U16. Invalid or missing numbers are NaN in
/// floats. Scans of one file are told apart by "scan" (U16), the scanner of each by the note "scanners": 3
/// numbers x y z per scan as text, a line each, world units.
#define EWA_POSITION    "position"
#define EWA_NORMAL      "normal"
#define EWA_COLOR       "color"
#define EWA_RADIUS      "radius"
#define EWA_TANGENT_U   "tangent_u"
#define EWA_TANGENT_V   "tangent_v"
#define EWA_MATERIAL    "material"
#define EWA_SURFACENESS "surfaceness"
#define EWA_CURVATURE   "signed_curvature"
#define EWA_CLIP0       "clip0"
#define EWA_CLIP1       "clip1"
#define EWA_CLIP_MODE   "clip_mode"
#define EWA_BORDER      "border"

enum { EWA_NAME_BYTES = 64 };

/// One stream: `component_count` numbers of `type` per point, points `stride_bytes` apart.
typedef struct ewa_attribute {
    char name[EWA_NAME_BYTES]; ///< zero-terminated UTF-8
    ewa_type type;
    uint32_t component_count; ///< 1 to 4
    size_t stride_bytes;      ///< component_count * size of the type when the cloud owns the data
    void *data;               ///< aligned to the type
    bool borrowed;            ///< true: the caller's memory, which the cloud reads and never frees
} ewa_attribute;

typedef struct ewa_cloud ewa_cloud;

/// Makes a cloud of `point_count` points without attributes; the caller owns `*cloud`.
/// Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_cloud_create(ewa_context *context, uint64_t point_count, ewa_cloud **cloud);

/// Frees the cloud and the attributes it owns; sets `*cloud` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_cloud_destroy(ewa_cloud **cloud);

EWA_API uint64_t ewa_cloud_point_count(const ewa_cloud *cloud);

/// Adds a stream that the cloud owns, uninitialised, replacing one of the same name; `*data` (may be NULL)
/// gets its first number. Pointers to other attributes of the cloud become invalid; their data does not move.
/// Errors: EWA_ERROR_ARGUMENT (empty or too long name, component_count outside 1..4), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_cloud_add(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t component_count,
                                 void **data);

/// Adds a stream over the caller's memory, which must outlive the cloud; nothing is copied.
/// `stride_bytes` is the distance of consecutive points, 0 for tightly packed.
EWA_API ewa_status ewa_cloud_borrow(ewa_cloud *cloud, const char *name, ewa_type type,
                                    uint32_t component_count, const void *data, size_t stride_bytes);

/// Removes a stream if there is one of that name.
EWA_API void ewa_cloud_remove(ewa_cloud *cloud, const char *name);

/// Returns the stream of that name or NULL; valid until the next add, borrow or remove.
EWA_API const ewa_attribute *ewa_cloud_find(const ewa_cloud *cloud, const char *name);

/// Whether a cloud has all that surfels need: normals and radii, or both axes. Any thread.
EWA_API bool ewa_cloud_is_drawable(const ewa_cloud *cloud);

EWA_API uint32_t ewa_cloud_attribute_count(const ewa_cloud *cloud);

/// Returns stream `index` in order of addition, NULL beyond the last.
EWA_API const ewa_attribute *ewa_cloud_attribute_at(const ewa_cloud *cloud, uint32_t index);

/// Sets what has to be added to "position" to give world coordinates (default 0, 0, 0): georeferenced data
/// keeps its exact place while the streams stay small numbers.
EWA_API void ewa_cloud_set_origin(ewa_cloud *cloud, const double origin_world[3]);
EWA_API void ewa_cloud_origin(const ewa_cloud *cloud, double origin_world[3]);

/// The grid of decimal coordinates that a file holds: world coordinates are offset + whole number * step.
typedef struct ewa_coordinate_grid {
    double step_world[3]; ///< > 0; 0: there is none on this axis
    double offset_world[3];
} ewa_coordinate_grid;

/// Sets or returns the grid that the positions came from (default: none). Writers put the same decimals into
/// files again, which positions in binary fractions alone would not give. It changes no position.
EWA_API void ewa_cloud_set_grid(ewa_cloud *cloud, const ewa_coordinate_grid *grid);
EWA_API void ewa_cloud_grid(const ewa_cloud *cloud, ewa_coordinate_grid *grid);

/// Returns the double nearest to the place of the grid that is nearest to a world coordinate; the coordinate
/// itself where there is no grid, or no such place within range. Any thread.
EWA_API double ewa_grid_world(const ewa_coordinate_grid *grid, uint32_t axis, double world);

/// Keeps bytes with the cloud, a copy, replacing those of the same name; none when `size_bytes` is 0. Known
/// names: "crs", the coordinate reference system as text (WKT, or a name such as "EPSG:32632"); "crs_name", a
/// name for people; "crs_unit", "m", "ft" or "US ft", where the text does not say it; "las.vlrs", raw variable length records; "file.WHAT", facts about the file that
/// the points came from, as text for people. Selections and the first of merged clouds hand them on. Errors:
/// EWA_ERROR_ARGUMENT (name empty or too long), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_cloud_set_note(ewa_cloud *cloud, const char *name, const void *bytes,
                                      size_t size_bytes);

/// Returns the bytes of a note, behind which a zero stands, or NULL; `*size_bytes` (may be NULL) without that
/// zero. Valid until the notes change.
EWA_API const char *ewa_cloud_note(const ewa_cloud *cloud, const char *name, size_t *size_bytes);

/// Returns the name of note `index` in the order of addition, NULL beyond the last.
EWA_API const char *ewa_cloud_note_name(const ewa_cloud *cloud, uint32_t index);

/// Reads `count` points from point `first` as floats, `component_count` of the attribute each, tightly packed
/// into `values`. Integers are converted as numbers, not normalised.
EWA_API void ewa_attribute_read_f32(const ewa_attribute *attribute, uint64_t first, uint64_t count,
                                    float *values);
/// The same in double precision.
EWA_API void ewa_attribute_read_f64(const ewa_attribute *attribute, uint64_t first, uint64_t count,
                                    double *values);

/// Measures the box of all finite positions, origin included. Does not depend on the order of the points.
/// Errors: EWA_ERROR_ARGUMENT when there is no "position" of three components.
EWA_API ewa_status ewa_cloud_measure(const ewa_cloud *cloud, ewa_bounds *bounds);

/// Makes a cloud of the points `indices[0]` to `indices[count - 1]` of another, in that order, with all its
/// attributes and its origin. The caller owns `*selected`. Errors: EWA_ERROR_ARGUMENT (an index beyond the
/// last point), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_cloud_select(const ewa_cloud *cloud, const uint64_t *indices, uint64_t count,
                                    ewa_cloud **selected);

/// Makes one cloud of `count` > 0 clouds of one context: the points one after another, the origin of the
/// first, and the attributes that any has. Points of a cloud that lacks one get NaN in floats, 0 in whole
/// numbers, linear 0.6 in colours, and without a word 1 in "surfaceness" and NaN in "signed_curvature"; positions,
/// normals, radii, axes and clip lines are kept only where all have them. Types that differ become the float type that holds both, of colours U16 or linear F32; positions
/// become doubles where the origins differ. Attributes of different components are dropped, but for colours.
/// What is filled in or dropped, and coordinate reference systems (note "crs") that differ, are reported as
/// warnings. The caller owns `*merged`. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_cloud_merge(const ewa_cloud *const *clouds, uint32_t count, ewa_cloud **merged);

/// Maps space: positions and tangent axes by the matrix, normals by its inverse transpose, radii by the cube
/// root of its determinant, clip lines with their axes. `world_to_world` is row-major, acts on column
/// vectors, its last row is 0 0 0 1. The translation goes into the origin, so that the streams stay small
/// numbers. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC (no inverse), EWA_ERROR_MEMORY (the cloud is then
/// half mapped).
EWA_API ewa_status ewa_cloud_transform(ewa_cloud *cloud, const double world_to_world[16]);

#ifdef __cplusplus
}
#endif
#endif
