// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a cloud becomes a LAS file: the point format, which attribute goes into which field, the grid of the
// coordinates, the records before the points.
#ifndef EWA_SRC_LAS_WRITE_H
#define EWA_SRC_LAS_WRITE_H

#include "io/las/las.h"
#include "io/las/laz.h"

/// What is decided before the first point is written.
typedef struct ewa_las_plan {
    uint8_t version_minor, point_format;
    uint16_t global_encoding;
    bool compressed;
    ewa_las_table table;                  ///< fields of the records; `scale` is that of the coordinates
    int32_t sources[EWA_LAS_MAX_COLUMNS]; ///< index of the attribute that each field takes; -1: none, 0s
    double offset_world[3];
    double intensity_scale; ///< of an intensity that is no whole number
    ewa_buffer extras;      ///< descriptions of the extra bytes
    uint32_t extra_count;
} ewa_las_plan;

/// Begins the names of notes that say, as decimal text, what one of an attribute's whole numbers stands for.
#define EWA_LAS_NOTE_SCALE "scale."

/// Makes the plan, for which the numbers of the first piece are looked at, or NULL; `is_whole`: no other will
/// come; `is_new`: by the point formats 6 to 8 only. Whole numbers in extra bytes get the scale that a note
/// EWA_LAS_NOTE_SCALE says, normals in I16 one of 1 / 32767. Free with ewa_las_plan_free(), also after a failure. Errors: EWA_ERROR_ARGUMENT (no position), EWA_ERROR_LIMIT (the
/// box does not fit 32 bits, too many attributes), EWA_ERROR_MEMORY.
ewa_status ewa_las_plan_make(const ewa_cloud_target *target, const ewa_cloud *piece, bool is_whole,
                             bool is_new, ewa_las_plan *plan);
void ewa_las_plan_free(ewa_context *context, ewa_las_plan *plan);

/// Chooses scale and offset of the coordinates. Errors: EWA_ERROR_LIMIT.
ewa_status ewa_las_grid_choose(const ewa_cloud_target *target, ewa_las_plan *plan);

/// Appends the variable length records that are written, those of LASzip left out. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_las_records_make(const ewa_cloud_target *target, ewa_las_plan *plan, ewa_buffer *records,
                                size_t *size_bytes, uint32_t *count);

/// Appends the head of a record and its bytes. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_las_record_append(ewa_context *context, const char *user, uint16_t id, const char *description,
                                 const void *bytes, size_t size_bytes, ewa_buffer *records, size_t *at_bytes);

/// What the points of some records come to.
typedef struct ewa_las_sums {
    int32_t low[3], high[3]; ///< whole numbers; low > high: no points
    uint64_t by_return[EWA_LAS_RETURNS + 1];
    uint64_t clamped_count; ///< numbers that are out of the range of their field
} ewa_las_sums;

#define EWA_LAS_NO_SUMS                                                                                      \
    ((ewa_las_sums){.low = {INT32_MAX, INT32_MAX, INT32_MAX}, .high = {INT32_MIN, INT32_MIN, INT32_MIN}})

void ewa_las_sums_add(ewa_las_sums *sums, const ewa_las_sums *more);

/// What the public header says of the points and of where they are.
typedef struct ewa_las_head {
    uint64_t points_at, point_count, evlrs_at;
    uint32_t vlr_count, evlr_count;
    const ewa_las_sums *sums;
} ewa_las_head;

/// Makes the public header; returns its size.
uint16_t ewa_las_head_make(const ewa_las_plan *plan, const ewa_cloud *prototype, const ewa_las_head *said,
                           uint8_t head[EWA_LAS_HEAD_14_BYTES]);

/// Appends the record by which LASzip's readers find out how the points are packed. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_las_laz_record_append(ewa_context *context, const ewa_laz_plan *laz, uint32_t chunk_points,
                                     ewa_buffer *records, size_t *at_bytes);

/// Makes records of points `first` to `first + count - 1` of a piece, one after the other, and adds to the
/// sums. All positions must be finite and within the range of the plan.
void ewa_las_pack(const ewa_las_plan *plan, const ewa_cloud *piece, uint64_t first, uint64_t count,
                  uint8_t *records, ewa_las_sums *sums);

#endif
