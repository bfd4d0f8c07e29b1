// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Several clouds as one.
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/color.h"

#include <math.h>
#include <string.h>

enum { BLOCK_POINTS = 256, CRS_NAME_BYTES = 64 };

/// sRGB of EWA_DEFAULT_GREY, for points of clouds without colours.
static const uint8_t GREY_SRGB = 203;

typedef struct merge_job {
    ewa_context *context;
    const ewa_cloud *const *clouds;
    uint32_t count;
    ewa_cloud *made;
    ewa_color_table colors;
} merge_job;

/// How an attribute is stored in the merged cloud.
typedef struct merged_stream {
    const char *name;
    ewa_type type;
    uint32_t component_count;
    uint32_t lacking_count; ///< clouds that do not have it
    bool moved;             ///< positions whose origins differ
    bool converted;         ///< colours that change their meaning with their type
} merged_stream;

/// The type that holds every number of both types.
static ewa_type common_type(ewa_type a, ewa_type b) {
    if (a == b) return a;
    const bool wide =
        a == EWA_F64 || a == EWA_I32 || a == EWA_U32 || b == EWA_F64 || b == EWA_I32 || b == EWA_U32;
    return wide ? EWA_F64 : EWA_F32;
}

/// The type of colours that holds both: whole numbers of 8 bits become 16, all else linear floats.
static ewa_type common_color_type(ewa_type a, ewa_type b) {
    const bool whole = (a == EWA_U8 || a == EWA_U16) && (b == EWA_U8 || b == EWA_U16);
    return a == b ? a : whole ? EWA_U16 : EWA_F32;
}

/// Whether an attribute makes surfels: half of a cloud with made-up ones would be worse than none.
static bool shapes_surfels(const char *name) {
    static const char *const names[] = {EWA_POSITION,  EWA_NORMAL, EWA_RADIUS, EWA_TANGENT_U,
                                        EWA_TANGENT_V, EWA_CLIP0,  EWA_CLIP1,  EWA_CLIP_MODE, EWA_BORDER};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(name, names[i]) == 0) return true;
    return false;
}

/// Plans how all clouds' streams of a name become one; false when the merged cloud does without.
static bool plan_stream(const merge_job *job, const ewa_attribute *first, merged_stream *stream) {
    *stream =
        (merged_stream){.name = first->name, .type = first->type, .component_count = first->component_count};
    const bool color = strcmp(first->name, EWA_COLOR) == 0, position = strcmp(first->name, EWA_POSITION) == 0;
    double origin_world[3], other_world[3];
    ewa_cloud_origin(job->clouds[0], origin_world);
    for (uint32_t k = 0; k < job->count; k++) {
        const ewa_attribute *other = ewa_cloud_find(job->clouds[k], first->name);
        if (!other) {
            stream->lacking_count++;
            continue;
        }
        if (color && other->component_count > stream->component_count)
            stream->component_count = other->component_count;
        if (!color && other->component_count != first->component_count) return false;
        stream->converted |=
            color && (other->type != first->type || other->component_count != first->component_count);
        stream->type =
            color ? common_color_type(stream->type, other->type) : common_type(stream->type, other->type);
        ewa_cloud_origin(job->clouds[k], other_world);
        for (int c = 0; c < 3; c++) stream->moved |= position && other_world[c] != origin_world[c];
    }
    if (stream->moved) stream->type = EWA_F64;
    const bool rare = stream->type != EWA_U8 && stream->type != EWA_U16 && stream->type != EWA_F64;
    if (color && rare && (stream->converted || stream->lacking_count)) {
        stream->converted = stream->converted || stream->type != EWA_F32;
        stream->type = EWA_F32;
    }
    return stream->lacking_count == 0 || !shapes_surfels(first->name);
}

/// Copies `count` points of an attribute tightly packed to `bytes`.
static void copy_points(const ewa_attribute *attribute, uint64_t count, char *bytes) {
    const size_t point_bytes = attribute->component_count * ewa_type_bytes(attribute->type);
    const char *from = attribute->data;
    if (attribute->stride_bytes == point_bytes) {
        if (count) memcpy(bytes, from, count * point_bytes);
        return;
    }
    for (uint64_t i = 0; i < count; i++)
        memcpy(bytes + i * point_bytes, from + i * attribute->stride_bytes, point_bytes);
}

/// Writes a number that the type holds.
static void put_number(const merged_stream *stream, char *bytes, uint64_t index, double number) {
    if (stream->type == EWA_F32)
        ((float *)(void *)bytes)[index] = (float)number;
    else if (stream->type == EWA_F64)
        ((double *)(void *)bytes)[index] = number;
    else if (stream->type == EWA_U16)
        ((uint16_t *)(void *)bytes)[index] = (uint16_t)number;
    else
        ((uint8_t *)bytes)[index] = (uint8_t)number;
}

/// Copies one cloud's numbers, widened and moved.
static void merge_numbers(const ewa_attribute *from, const merged_stream *stream, uint64_t count,
                          const double shift_world[3], char *bytes) {
    double block[4 * BLOCK_POINTS];
    for (uint64_t first = 0; first < count; first += BLOCK_POINTS) {
        const uint64_t block_count = count - first < BLOCK_POINTS ? count - first : BLOCK_POINTS;
        ewa_attribute_read_f64(from, first, block_count, block);
        for (uint64_t i = 0; i < block_count * from->component_count; i++)
            put_number(stream, bytes, first * from->component_count + i,
                       block[i] + (stream->moved ? shift_world[i % 3] : 0));
    }
}

/// Copies one cloud's colours, of another type or with alpha.
static void merge_colors(const merge_job *job, const ewa_attribute *from, const merged_stream *stream,
                         uint64_t count, char *bytes) {
    const double full = ewa_color_full_scale(stream->type);
    for (uint64_t i = 0; i < count; i++) {
        double value[4], numbers[4];
        ewa_attribute_read_f64(from, i, 1, value);
        numbers[3] = ewa_color_alpha(from, value) * (full > 0 ? full : 1);
        if (full > 0) // 255 divides 65535
            for (int c = 0; c < 3; c++) numbers[c] = value[c] * (full / ewa_color_full_scale(from->type));
        else
            ewa_color_decode(&job->colors, from, value, numbers);
        for (uint32_t c = 0; c < stream->component_count; c++)
            put_number(stream, bytes, i * stream->component_count + c, numbers[c]);
    }
}

bool ewa_cloud_absent_number(const char *name, double *number) {
    const bool surfaceness = strcmp(name, EWA_SURFACENESS) == 0, curvature = strcmp(name, EWA_CURVATURE) == 0;
    *number = surfaceness ? 1 : curvature ? (double)NAN : 0;
    return surfaceness || curvature;
}

/// Fills in what a cloud lacks: what its absence means, grey for colours, NaN for other floats, 0 for other whole
/// numbers.
static void fill_missing(const merged_stream *stream, uint64_t count, char *bytes) {
    const bool color = strcmp(stream->name, EWA_COLOR) == 0,
               is_float = stream->type == EWA_F32 || stream->type == EWA_F64;
    double absent;
    if (!ewa_cloud_absent_number(stream->name, &absent)) absent = (double)NAN;
    const size_t point_bytes = stream->component_count * ewa_type_bytes(stream->type);
    if (!color && !is_float) {
        memset(bytes, 0, count * point_bytes);
        return;
    }
    const double grey = is_float                  ? EWA_DEFAULT_GREY
                        : stream->type == EWA_U16 ? GREY_SRGB * 257.0
                                                  : GREY_SRGB,
                 full = is_float ? 1 : ewa_color_full_scale(stream->type);
    for (uint64_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < stream->component_count; c++)
            put_number(stream, bytes, i * stream->component_count + c,
                       !color  ? absent
                       : c < 3 ? grey
                               : full);
}

/// Adds the stream of all clouds.
static ewa_status merge_stream(const merge_job *job, const merged_stream *stream) {
    void *data = NULL;
    EWA_TRY(ewa_cloud_add(job->made, stream->name, stream->type, stream->component_count, &data));
    double origin_world[3], shift_world[3];
    ewa_cloud_origin(job->clouds[0], origin_world);
    char *bytes = data;
    for (uint32_t k = 0; k < job->count; k++) {
        const ewa_attribute *from = ewa_cloud_find(job->clouds[k], stream->name);
        const uint64_t point_count = ewa_cloud_point_count(job->clouds[k]);
        ewa_cloud_origin(job->clouds[k], shift_world);
        for (int c = 0; c < 3; c++) shift_world[c] -= origin_world[c];
        if (!from)
            fill_missing(stream, point_count, bytes);
        else if (stream->converted)
            merge_colors(job, from, stream, point_count, bytes);
        else if (from->type == stream->type && !stream->moved)
            copy_points(from, point_count, bytes);
        else
            merge_numbers(from, stream, point_count, shift_world, bytes);
        bytes += point_count * stream->component_count * ewa_type_bytes(stream->type);
    }
    double absent;
    if (stream->lacking_count && !ewa_cloud_absent_number(stream->name, &absent)) {
        const bool is_float = stream->type == EWA_F32 || stream->type == EWA_F64;
        ewa_report(job->context, EWA_SEVERITY_WARNING,
                   "attribute '%s': %u of %u clouds lack it, their points get %s", stream->name,
                   stream->lacking_count, job->count,
                   strcmp(stream->name, EWA_COLOR) == 0 ? "grey"
                   : is_float                           ? "NaN"
                                                        : "0");
    }
    return EWA_OK;
}

/// Merges the attributes of cloud `k` that no earlier one has; says which the merged cloud does without.
static ewa_status merge_attributes(const merge_job *job, uint32_t k) {
    const ewa_attribute *attribute;
    for (uint32_t a = 0; (attribute = ewa_cloud_attribute_at(job->clouds[k], a)); a++) {
        bool seen = false;
        for (uint32_t e = 0; e < k && !seen; e++)
            seen = ewa_cloud_find(job->clouds[e], attribute->name) != NULL;
        merged_stream stream;
        if (!seen && plan_stream(job, attribute, &stream))
            EWA_TRY(merge_stream(job, &stream));
        else if (!seen || !ewa_cloud_find(job->made, attribute->name))
            ewa_report(job->context, EWA_SEVERITY_WARNING,
                       "attribute '%s' of cloud %u is dropped: not every cloud has it in the same shape",
                       attribute->name, k + 1);
    }
    return EWA_OK;
}

/// Keeps the grid of the first cloud on the axes on which all have the same.
static void merge_grids(const merge_job *job) {
    ewa_coordinate_grid grid, other;
    ewa_cloud_grid(job->clouds[0], &grid);
    for (uint32_t k = 1; k < job->count; k++) {
        ewa_cloud_grid(job->clouds[k], &other);
        for (int c = 0; c < 3; c++)
            if (other.step_world[c] != grid.step_world[c] || other.offset_world[c] != grid.offset_world[c])
                grid.step_world[c] = 0;
    }
    ewa_cloud_set_grid(job->made, &grid);
}

/// The name of a cloud's coordinate reference system, or how its text begins.
static void name_crs(const ewa_cloud *cloud, const char *crs, char name[CRS_NAME_BYTES]) {
    const char *given = ewa_cloud_note(cloud, "crs_name", NULL);
    size_t length = 0;
    if (!given) given = crs;
    for (; length < CRS_NAME_BYTES - 1 && given[length] >= ' ' && given[length] <= '~'; length++)
        name[length] = given[length];
    name[length] = 0;
}

/// Warns of the first two clouds whose coordinates are of different systems.
static void compare_crs(const merge_job *job) {
    const char *first = NULL;
    uint32_t of = 0;
    for (uint32_t k = 0; k < job->count; k++) {
        const char *crs = ewa_cloud_note(job->clouds[k], "crs", NULL);
        if (!crs || (first && strcmp(crs, first) == 0)) continue;
        if (first) {
            char names[2][CRS_NAME_BYTES];
            name_crs(job->clouds[of], first, names[0]);
            name_crs(job->clouds[k], crs, names[1]);
            ewa_report(job->context, EWA_SEVERITY_WARNING,
                       "clouds %u and %u are in different coordinate reference systems, '%s' and '%s'; their "
                       "coordinates are taken as they are",
                       of + 1, k + 1, names[0], names[1]);
            return;
        }
        first = crs;
        of = k;
    }
}

ewa_status ewa_cloud_merge(const ewa_cloud *const *clouds, uint32_t count, ewa_cloud **merged) {
    if (!clouds || !merged || count == 0) return EWA_ERROR_ARGUMENT;
    *merged = NULL;
    uint64_t total = 0;
    for (uint32_t k = 0; k < count; k++) {
        if (!clouds[k]) return EWA_ERROR_ARGUMENT;
        total += ewa_cloud_point_count(clouds[k]);
    }
    merge_job job = {.context = ewa_cloud_context(clouds[0]), .clouds = clouds, .count = count};
    ewa_color_table_make(&job.colors);
    ewa_status status = ewa_cloud_create(job.context, total, &job.made);
    for (uint32_t k = 0; k < count && status == EWA_OK; k++) status = merge_attributes(&job, k);
    if (status == EWA_OK) status = ewa_cloud_follow(job.made, clouds[0]);
    if (status != EWA_OK) {
        ewa_cloud_destroy(&job.made);
        return status;
    }
    merge_grids(&job);
    compare_crs(&job);
    *merged = job.made;
    return EWA_OK;
}
