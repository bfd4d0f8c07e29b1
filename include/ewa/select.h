// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which points of a cloud: by their numbers, by an outline on the map, one per voxel, so far apart.
//
// Choices are marks: one byte per point, not 0: the point stays. Every call clears marks and sets none, so
// that calls follow each other; ewa_cloud_keep() makes a cloud of what is left. Filters and polygons look at
// every point alone: the pieces of a file give what the whole would.
#ifndef EWA_SELECT_H
#define EWA_SELECT_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/// One number of each point: a component of an attribute.
typedef struct ewa_scalar {
    ewa_attribute attribute; ///< of the cloud, valid as long as its data
    uint32_t component;
    double shift_world;       ///< added to what is stored: the origin of a position, else 0
    ewa_coordinate_grid grid; ///< of a position; no steps for all else
} ewa_scalar;

/// Finds the number that a word means: the name of an attribute (its first component), "NAME.x" to "NAME.w"
/// or "NAME.r" to "NAME.a" for one of its components, x, y, z of the position, nx, ny, nz of the normal,
/// red, green, blue, alpha of the colour. Where no name is the same, one counts that differs in case,
/// underscores and the "scalar_" before it only, so that "ReturnNumber" is return_number. Errors:
/// EWA_ERROR_ARGUMENT, with the attributes that there are.
EWA_API ewa_status ewa_cloud_find_scalar(const ewa_cloud *cloud, const char *word, ewa_scalar *scalar);

/// Reads `count` numbers from point `first`; coordinates are in world units, on the grid if there is one. Any
/// thread.
EWA_API void ewa_scalar_read(const ewa_scalar *scalar, uint64_t first, uint64_t count, double *numbers);

/// Returns the number that would be at place `rank` in [0, count) if `numbers`, of which none is NaN, were sorted:
/// a median, a percentile. Shuffles and overwrites them; takes time in proportion to `count`, whatever they are.
/// Any thread.
EWA_API double ewa_rank_select(double *numbers, size_t count, size_t rank);

enum { EWA_FILTER_TERMS = 16, EWA_FILTER_RANGES = 32 };

/// Numbers from low to high, both of them among these unless the range is open there.
typedef struct ewa_filter_range {
    double low, high;
    bool low_open, high_open;
} ewa_filter_range;

/// What one number of a point has to be.
typedef struct ewa_filter_term {
    char name[EWA_NAME_BYTES]; ///< for ewa_cloud_find_scalar()
    bool outside;              ///< false: in one of the ranges, true: in none
    uint32_t range_count;
    ewa_filter_range ranges[EWA_FILTER_RANGES];
} ewa_filter_term;

/// What a point has to be: all terms hold. Zero-initialised: any point. A number that is NaN fulfils no term.
typedef struct ewa_filter {
    uint32_t term_count;
    ewa_filter_term terms[EWA_FILTER_TERMS];
} ewa_filter;

/// Adds the terms of an expression to a filter:
///
///     expression = term { "and" term }
///     term       = NAME ( "=" | "!=" ) value { "," value }  |  NAME ( "<" | "<=" | ">" | ">=" ) NUMBER
///     value      = NUMBER  |  [ NUMBER ] ".." [ NUMBER ]  |  CLASS
///
/// Ranges hold both ends. CLASS is a name of ewa_class_name(), in any case, with '_' or '-' for a blank, or
/// vegetation (3 to 5) or noise (7, 18). "==" is "=". What is wrong with the text goes to `problem`, which may
/// be NULL; the filter is then unchanged. Any thread. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_filter_add(ewa_filter *filter, const char *text, char problem[EWA_OPTION_TEXT_BYTES]);

/// Writes a filter as ewa_filter_add() reads it, ended by a zero. False: it needs more than `size_bytes`; the text is cut.
/// Any thread.
EWA_API bool ewa_filter_write(const ewa_filter *filter, char *text, size_t size_bytes);

/// Clears the marks, one per point, of the points that do not fulfil the filter. Numbers of F32 attributes are
/// compared with the filter's numbers rounded to F32, so that "=0.1" finds what a file calls 0.1. Errors:
/// EWA_ERROR_ARGUMENT (no such attribute; the message lists those there are).
EWA_API ewa_status ewa_filter_mark(const ewa_filter *filter, const ewa_cloud *cloud, uint8_t *marks);

/// Clears the marks of points outside of a box, whose faces belong to it; a corner is low or high on each axis
/// as its numbers are. Errors: EWA_ERROR_ARGUMENT (no positions).
EWA_API ewa_status ewa_box_mark(const double corners_world[2][3], const ewa_cloud *cloud, uint8_t *marks);

/// Clears the marks of points outside of a sphere, whose surface belongs to it. Errors: EWA_ERROR_ARGUMENT (no positions, a
/// radius below 0 or that is no number).
EWA_API ewa_status ewa_sphere_mark(const double center_world[3], double radius_world, const ewa_cloud *cloud, uint8_t *marks);

/// Outlines in world x, y: rings, of which an odd number is around what is inside, so that rings in rings are
/// holes.
typedef struct ewa_polygon ewa_polygon;

/// Reads outlines from text: "x,y;x,y;...", lines "x y" with an empty line or one that begins with '>' between
/// rings, WKT (POLYGON, MULTIPOLYGON) or GeoJSON. Rings close themselves; further coordinates than x and y are
/// not looked at. `name` stands for the text in messages. The caller owns `*polygon`, NULL after a failure.
/// Errors: EWA_ERROR_FORMAT, EWA_ERROR_LIMIT (over 64 MiB), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_polygon_read(ewa_context *context, const char *name, const void *text,
                                    size_t size_bytes, ewa_polygon **polygon);

/// The same from a file; "-" reads standard input. Errors also: EWA_ERROR_IO.
EWA_API ewa_status ewa_polygon_load(ewa_context *context, const char *path, ewa_polygon **polygon);

/// Makes outlines of numbers: ring k has `ring_counts[k]` >= 3 corners x, y, one ring after the other in
/// `corners_world`, all finite. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT (over 2^28 corners),
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_polygon_create(ewa_context *context, const double *corners_world,
                                      const uint32_t *ring_counts, uint32_t ring_count,
                                      ewa_polygon **polygon);

/// Frees the outlines; sets `*polygon` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_polygon_destroy(ewa_polygon **polygon);

/// Returns the box of the outlines in x, y: low x, low y, high x, high y.
EWA_API void ewa_polygon_box(const ewa_polygon *polygon, double box_world[4]);

/// Clears the marks of points outside of the outlines; what lies on one is inside. Errors: EWA_ERROR_ARGUMENT
/// (no positions).
EWA_API ewa_status ewa_polygon_mark(const ewa_polygon *polygon, const ewa_cloud *cloud, uint8_t *marks);

/// Thins to one point per voxel: of the marked points in each cube of `size_world` the one stays that is
/// nearest to their mean, with all its attributes. Cubes are aligned to the world's origin, so that clouds
/// that are thinned apart fit together. Marks of points that are not finite are cleared.
///
/// The result depends neither on the order of the points nor on threads: of points equally near the one whose
/// coordinates, then whose other attributes come first stays. Needs about 24 bytes per point meanwhile.
/// Progress stage: "thinning". Errors: EWA_ERROR_ARGUMENT (no positions, a size that is not above 0),
/// EWA_ERROR_MEMORY, EWA_CANCELLED; marks are unspecified then.
EWA_API ewa_status ewa_cloud_thin_voxels(const ewa_cloud *cloud, double size_world, uint8_t *marks);

/// Thins to points that are at least `distance_world` from each other: every marked point that goes is nearer
/// than that to one that stays (a maximal Poisson-disc sample). All else as ewa_cloud_thin_voxels(); points
/// take their turns by a hash of their coordinates. Needs about 30 bytes per point meanwhile. Based on R. L.
/// Cook, "Stochastic sampling in computer graphics", 1986, section 5 (dart throwing), in blocks of 8 colours.
EWA_API ewa_status ewa_cloud_thin_distance(const ewa_cloud *cloud, double distance_world, uint8_t *marks);

/// Makes a cloud of the marked points, in their order, as ewa_cloud_select() does. The caller owns
/// `*selected`. Errors: EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_cloud_keep(const ewa_cloud *cloud, const uint8_t *marks, ewa_cloud **selected);

#ifdef __cplusplus
}
#endif
#endif
