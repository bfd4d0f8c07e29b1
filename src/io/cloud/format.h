// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a format of point clouds has to offer: one way in, one way out. A format says what its points have
// before any of them is read, then hands them over in the order of the file, as many at a time as the caller
// has room for; so the same reader fills a whole cloud and passes a file through that is larger than memory.
#ifndef EWA_SRC_FORMAT_H
#define EWA_SRC_FORMAT_H

#include "ewa/io.h"
#include "ewa/model.h"
#include "io/ranges.h"

/// A file that is read and where messages about it go.
typedef struct ewa_cloud_source {
    ewa_context *context;
    const char *name;     ///< stands for the file in messages
    const char *path;     ///< of the file, for formats that name others beside it; NULL: there is none
    const uint8_t *bytes; ///< of the whole file; NULL: by ewa_cloud_need(), of octrees only
    uint64_t size_bytes;
    ewa_ranges *ranges; ///< that parts are read from; NULL: all bytes are there
    const ewa_cloud_load_options *options; ///< complete, of this version
    uint64_t *lost_count;                  ///< points that ewa_cloud_damage() gave up
    bool mapped;                           ///< the bytes are pages of a file (ewa_cloud_passed())
} ewa_cloud_source;

/// Makes `*bytes` point to bytes [at, at + size), which lie within the file. On the thread that calls the library. Errors: those
/// of ewa_ranges_need().
static inline ewa_status ewa_cloud_need(const ewa_cloud_source *source, uint64_t at_bytes, uint64_t size_bytes,
                                        const uint8_t **bytes) {
    if (source->ranges) return ewa_ranges_need(source->ranges, at_bytes, size_bytes, bytes);
    *bytes = source->bytes + at_bytes;
    return EWA_OK;
}

/// Returns them where they are there already; NULL: they are to be read first. Any thread.
static inline const uint8_t *ewa_cloud_find_bytes(const ewa_cloud_source *source, uint64_t at_bytes, uint64_t size_bytes) {
    return source->ranges ? ewa_ranges_find(source->ranges, at_bytes, size_bytes) : source->bytes + at_bytes;
}

/// Where the numbers of one attribute go: point i of a call to `to + i * stride_bytes`. NULL: not wanted.
typedef struct ewa_cloud_sink {
    uint8_t *to;
    size_t stride_bytes;
} ewa_cloud_sink;

/// One format that is read.
typedef struct ewa_cloud_format {
    ewa_model_format format;

    /// Whether the bytes are of this format; `name` helps only where bytes of two formats look alike.
    bool (*probe)(const char *name, const uint8_t *bytes, uint64_t size_bytes);

    /// Reads what comes before the points. `prototype` is a cloud of no points: the format adds the
    /// attributes that its points have, sets origin and grid, and adds notes (ewa_cloud_set_note()).
    /// `*point_count`: never more points than this come; it must be bounded by the bytes that are there. The
    /// source and its bytes stay until close(). `*state` stays NULL after a failure.
    ewa_status (*open)(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                       void **state);

    /// Reads the next points, at most `maximum`, into one sink per attribute of the prototype, in its order.
    /// `*got_count` is 0 at the end only. Uses threads by ewa_parallel().
    ewa_status (*read)(void *state, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count);

    /// Frees the state; accepts NULL.
    void (*close)(void *state);
} ewa_cloud_format;

/// Says that a piece of a file is damaged: with `keep_going` a warning, `lost_count` points are counted as
/// lost and EWA_OK returned, so that the reader goes on behind the piece; else an error and
/// EWA_ERROR_FORMAT. The text begins with the name of the file.
ewa_status ewa_cloud_damage(const ewa_cloud_source *source, uint64_t lost_count, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Says that the bytes before `at_bytes` are not needed again, so that pages of a mapped file can leave
/// memory.
void ewa_cloud_passed(const ewa_cloud_source *source, uint64_t at_bytes);

/// A file that is written.
typedef struct ewa_cloud_target {
    ewa_context *context;
    const char *name; ///< stands for the file in messages
    struct ewa_writer *writer;
    const ewa_cloud_save_options *options; ///< complete, of this version
    const ewa_cloud *prototype; ///< attributes and their order, origin, grid and notes of every piece
    uint64_t point_count;       ///< of all pieces together; EWA_POINTS_UNKNOWN
    const ewa_bounds *bounds;   ///< world box of all pieces together; NULL: not known
} ewa_cloud_target;

/// One format that is written.
typedef struct ewa_cloud_write_format {
    const char *suffixes; ///< in small letters, separated by '|': ".las|.laz"
    bool needs_bounds;    ///< open() fails without bounds unless the prototype has a grid
    bool needs_count;     ///< point_count must be known

    /// Begins a file. The target stays until close(). `*state` stays NULL after a failure.
    ewa_status (*open)(const ewa_cloud_target *target, void **state);

    /// Appends the points of a piece.
    ewa_status (*put)(void *state, const ewa_cloud *piece);

    /// Writes what comes after the points and what only now is known (ewa_writer_patch()).
    ewa_status (*finish)(void *state);

    /// Frees the state; accepts NULL.
    void (*close)(void *state);
} ewa_cloud_write_format;

/// The formats, in the order in which they are asked. Each lives in a file of its own.
extern const ewa_cloud_format ewa_format_ply, ewa_format_las, ewa_format_e57, ewa_format_pcd, ewa_format_ptx,
    ewa_format_tiff, ewa_format_terrain, ewa_format_grid, ewa_format_text;
extern const ewa_cloud_write_format ewa_write_ply, ewa_write_las, ewa_write_pcd, ewa_write_text;

/// What messages say is read and written.
#define EWA_CLOUD_FORMATS  "PLY, LAS, LAZ, E57, PCD, PTX, PTS, XYZ, CSV, ASCII grids, GeoTIFF"
#define EWA_CLOUD_SUFFIXES ".ply, .las, .laz, .pcd, .xyz, .txt, .asc, .pts or .csv"

/// Finds the format that a path is written in, by its suffix; "-" and devices, which have none: PLY. NULL: none.
const ewa_cloud_write_format *ewa_cloud_write_format_of(const char *path);

/// Which formats are asked.
typedef enum ewa_probe {
    EWA_PROBE_MAGIC, ///< those that are known by their first bytes for certain
    EWA_PROBE_ALL,   ///< text in columns too, for what is no mesh
} ewa_probe;

/// Finds the format of a file, pictures among them when the options (may be NULL) say so; NULL when it is of none
/// of them.
const ewa_cloud_format *ewa_cloud_format_of(const char *name, const uint8_t *bytes, uint64_t size_bytes,
                                            ewa_probe probe, const ewa_cloud_load_options *options);

/// Makes a cloud with room for `point_count` points that have the attributes of a prototype that are wanted
/// (names, comma-separated, besides "position"; NULL: all), its origin, grid and notes, and one sink for each
/// attribute of the prototype. `name` stands for the file in messages. Errors: EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY.
ewa_status ewa_cloud_make_room(const char *name, const ewa_cloud *prototype, const char *wanted,
                               uint64_t point_count, ewa_cloud **cloud, ewa_cloud_sink *sinks);

/// Gives positions in doubles that are decimals of a few places, far from the origin, an origin of whole
/// thousands and what is left as exact as the decimals: then the same object anywhere has the same numbers.
/// Only a whole cloud shows whether they are.
void ewa_cloud_settle(ewa_cloud *cloud);

/// Reads all points of a source into a cloud.
ewa_status ewa_cloud_read_all(const ewa_cloud_source *source, const ewa_cloud_format *format,
                              ewa_cloud **cloud);

#endif
