// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds from clouds: some of the points, several clouds as one, an affine map of space.
//
// Based on: Bloomenthal and Rokne, "Homogeneous Coordinates", 1994: points go by M, planes (normals) by the
// inverse transpose.
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/cloud.h"

#include <math.h>
#include <string.h>

enum { BLOCK_POINTS = 256 };

/// Copies `count` points of an attribute, from point `first` on, tightly packed to `bytes`.
static void copy_points(const ewa_attribute *attribute, uint64_t first, uint64_t count, char *bytes) {
    const size_t point_bytes = attribute->component_count * ewa_type_bytes(attribute->type);
    const char *from = (const char *)attribute->data + first * attribute->stride_bytes;
    if (attribute->stride_bytes == point_bytes) {
        if (count) memcpy(bytes, from, count * point_bytes);
        return;
    }
    for (uint64_t i = 0; i < count; i++)
        memcpy(bytes + i * point_bytes, from + i * attribute->stride_bytes, point_bytes);
}

ewa_status ewa_cloud_select(const ewa_cloud *cloud, const uint64_t *indices, uint64_t count,
                            ewa_cloud **selected) {
    if (!cloud || !selected || (count && !indices)) return EWA_ERROR_ARGUMENT;
    *selected = NULL;
    ewa_context *context = ewa_cloud_context(cloud);
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    for (uint64_t i = 0; i < count; i++)
        if (indices[i] >= point_count)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "point %llu of a cloud of %llu points",
                            (unsigned long long)indices[i], (unsigned long long)point_count);
    ewa_cloud *made = NULL;
    ewa_status status = ewa_cloud_create(context, count, &made);
    const ewa_attribute *attribute;
    for (uint32_t k = 0; status == EWA_OK && (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        void *data = NULL;
        status = ewa_cloud_add(made, attribute->name, attribute->type, attribute->component_count, &data);
        const size_t point_bytes = attribute->component_count * ewa_type_bytes(attribute->type);
        for (uint64_t i = 0; status == EWA_OK && i < count; i++)
            memcpy((char *)data + i * point_bytes,
                   (const char *)attribute->data + indices[i] * attribute->stride_bytes, point_bytes);
    }
    if (status == EWA_OK) status = ewa_cloud_follow(made, cloud);
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    *selected = made;
    return status;
}

/// The type that holds every number of both types.
static ewa_type common_type(ewa_type a, ewa_type b) {
    if (a == b) return a;
    const bool wide =
        a == EWA_F64 || a == EWA_I32 || a == EWA_U32 || b == EWA_F64 || b == EWA_I32 || b == EWA_U32;
    return wide ? EWA_F64 : EWA_F32;
}

static bool same_origin(const double a[3], const double b[3]) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// How an attribute is stored in the merged cloud.
typedef struct merged_stream {
    ewa_type type;
    bool moved; // positions whose origins differ
} merged_stream;

/// Whether all clouds have the attribute in one shape, and what type takes them all.
static bool plan_stream(const ewa_cloud *const *clouds, uint32_t count, const ewa_attribute *first,
                        merged_stream *stream) {
    *stream = (merged_stream){first->type, false};
    double origin_world[3], other_world[3];
    ewa_cloud_origin(clouds[0], origin_world);
    for (uint32_t k = 1; k < count; k++) {
        const ewa_attribute *other = ewa_cloud_find(clouds[k], first->name);
        if (!other || other->component_count != first->component_count) return false;
        if (strcmp(first->name, EWA_COLOR) == 0 && other->type != first->type) return false;
        stream->type = common_type(stream->type, other->type);
        ewa_cloud_origin(clouds[k], other_world);
        if (strcmp(first->name, EWA_POSITION) == 0 && !same_origin(origin_world, other_world))
            stream->moved = true;
    }
    if (stream->moved) stream->type = EWA_F64;
    return true;
}

/// Copies one cloud's stream to its place in the merged one.
static void merge_stream(const ewa_attribute *from, const merged_stream *stream, uint64_t count,
                         const double shift_world[3], char *bytes) {
    if (from->type == stream->type && !stream->moved) {
        copy_points(from, 0, count, bytes);
        return;
    }
    double block[4 * BLOCK_POINTS];
    for (uint64_t first = 0; first < count; first += BLOCK_POINTS) {
        const uint64_t block_count = count - first < BLOCK_POINTS ? count - first : BLOCK_POINTS;
        ewa_attribute_read_f64(from, first, block_count, block);
        for (uint64_t i = 0; i < block_count * from->component_count; i++) {
            const uint64_t to = first * from->component_count + i;
            if (stream->moved) block[i] += shift_world[i % 3];
            if (stream->type == EWA_F32)
                ((float *)(void *)bytes)[to] = (float)block[i];
            else
                ((double *)(void *)bytes)[to] = block[i];
        }
    }
}

/// Says which attributes of a cloud the merged one lacks.
static void report_dropped(const ewa_cloud *cloud, uint32_t index, const ewa_cloud *merged) {
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++)
        if (!ewa_cloud_find(merged, attribute->name))
            ewa_report(ewa_cloud_context(cloud), EWA_SEVERITY_WARNING,
                       "attribute '%s' of cloud %u is dropped: not every cloud has it in the same shape",
                       attribute->name, index + 1);
}

/// Keeps the grid of the first cloud on the axes on which all have the same.
static void merge_grids(const ewa_cloud *const *clouds, uint32_t count, ewa_cloud *merged) {
    ewa_coordinate_grid grid, other;
    ewa_cloud_grid(clouds[0], &grid);
    for (uint32_t k = 1; k < count; k++) {
        ewa_cloud_grid(clouds[k], &other);
        for (int c = 0; c < 3; c++)
            if (other.step_world[c] != grid.step_world[c] || other.offset_world[c] != grid.offset_world[c])
                grid.step_world[c] = 0;
    }
    ewa_cloud_set_grid(merged, &grid);
}

ewa_status ewa_cloud_merge(const ewa_cloud *const *clouds, uint32_t count, ewa_cloud **merged) {
    if (!clouds || !merged || count == 0) return EWA_ERROR_ARGUMENT;
    *merged = NULL;
    uint64_t total = 0;
    for (uint32_t k = 0; k < count; k++) {
        if (!clouds[k]) return EWA_ERROR_ARGUMENT;
        total += ewa_cloud_point_count(clouds[k]);
    }
    ewa_cloud *made = NULL;
    ewa_status status = ewa_cloud_create(ewa_cloud_context(clouds[0]), total, &made);
    double origin_world[3];
    ewa_cloud_origin(clouds[0], origin_world);
    const ewa_attribute *first;
    for (uint32_t a = 0; status == EWA_OK && (first = ewa_cloud_attribute_at(clouds[0], a)); a++) {
        merged_stream stream;
        if (!plan_stream(clouds, count, first, &stream)) continue;
        void *data = NULL;
        status = ewa_cloud_add(made, first->name, stream.type, first->component_count, &data);
        char *bytes = data;
        for (uint32_t k = 0; status == EWA_OK && k < count; k++) {
            double shift_world[3];
            ewa_cloud_origin(clouds[k], shift_world);
            for (int c = 0; c < 3; c++) shift_world[c] -= origin_world[c];
            const uint64_t point_count = ewa_cloud_point_count(clouds[k]);
            merge_stream(ewa_cloud_find(clouds[k], first->name), &stream, point_count, shift_world, bytes);
            bytes += point_count * first->component_count * ewa_type_bytes(stream.type);
        }
    }
    if (status == EWA_OK) status = ewa_cloud_follow(made, clouds[0]);
    if (status != EWA_OK) {
        ewa_cloud_destroy(&made);
        return status;
    }
    merge_grids(clouds, count, made);
    for (uint32_t k = 0; k < count; k++) report_dropped(clouds[k], k, made);
    *merged = made;
    return EWA_OK;
}

/// Cofactors of the upper left 3x3, row-major: det * inverse transpose. Returns the determinant.
static double cofactors(const double m[16], double cofactor[9]) {
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            cofactor[3 * r + c] = m[4 * r1 + c1] * m[4 * r2 + c2] - m[4 * r1 + c2] * m[4 * r2 + c1];
        }
    }
    return m[0] * cofactor[0] + m[1] * cofactor[1] + m[2] * cofactor[2];
}

/// Replaces a stream of floating-point triples by `linear` times them, normalised when asked for.
static ewa_status map_triples(ewa_cloud *cloud, const char *name, const double linear[9], bool normalised) {
    const ewa_attribute *found = ewa_cloud_find(cloud, name);
    if (!found) return EWA_OK;
    if (found->component_count != 3)
        return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
                        "attribute '%s' has %u components, not 3", name, found->component_count);
    const ewa_attribute from = *found;
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_type type =
        from.type == EWA_F64 || from.type == EWA_I32 || from.type == EWA_U32 ? EWA_F64 : EWA_F32;
    ewa_context *context = ewa_cloud_context(cloud);
    char *mapped = ewa_allocate(context, count, 3 * ewa_type_bytes(type));
    if (!mapped) return EWA_ERROR_MEMORY;
    for (uint64_t i = 0; i < count; i++) {
        double p[3], q[3];
        ewa_attribute_read_f64(&from, i, 1, p);
        for (int r = 0; r < 3; r++)
            q[r] = linear[3 * r] * p[0] + linear[3 * r + 1] * p[1] + linear[3 * r + 2] * p[2];
        const double length = normalised ? sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) : 1;
        for (int r = 0; r < 3; r++) {
            const double value = length > 0 ? q[r] / length : 0;
            if (type == EWA_F64)
                ((double *)(void *)mapped)[3 * i + (uint64_t)r] = value;
            else
                ((float *)(void *)mapped)[3 * i + (uint64_t)r] = (float)value;
        }
    }
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, name, type, 3, &data);
    if (status == EWA_OK && count) memcpy(data, mapped, count * 3 * ewa_type_bytes(type));
    ewa_release(context, mapped, count, 3 * ewa_type_bytes(type));
    return status;
}

/// Multiplies component `component` of a stream by `factor`; the stream becomes one of doubles.
static ewa_status scale_component(ewa_cloud *cloud, const char *name, uint32_t component, double factor) {
    const ewa_attribute *found = ewa_cloud_find(cloud, name);
    if (!found || factor == 1) return EWA_OK;
    const ewa_attribute from = *found;
    const uint64_t count = ewa_cloud_point_count(cloud), components = from.component_count;
    ewa_context *context = ewa_cloud_context(cloud);
    double *scaled = ewa_allocate(context, count * components, sizeof *scaled);
    if (!scaled) return EWA_ERROR_MEMORY;
    ewa_attribute_read_f64(&from, 0, count, scaled);
    for (uint64_t i = 0; i < count; i++) scaled[i * components + component] *= factor;
    const ewa_type type = from.type == EWA_F32 ? EWA_F32 : EWA_F64;
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, name, type, from.component_count, &data);
    for (uint64_t i = 0; status == EWA_OK && i < count * components; i++) {
        if (type == EWA_F32)
            ((float *)data)[i] = (float)scaled[i];
        else
            ((double *)data)[i] = scaled[i];
    }
    ewa_release(context, scaled, count * components, sizeof *scaled);
    return status;
}

/// A cloud that is shifted as a whole keeps its grid, shifted; any other map leaves none.
static void move_grid(ewa_cloud *cloud, const double linear[9], const double shift_world[3]) {
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    ewa_coordinate_grid grid;
    ewa_cloud_grid(cloud, &grid);
    const bool shifted = memcmp(linear, identity, sizeof identity) == 0;
    for (int c = 0; c < 3; c++) {
        grid.offset_world[c] += shift_world[c];
        if (!shifted) grid.step_world[c] = 0;
    }
    ewa_cloud_set_grid(cloud, &grid);
}

ewa_status ewa_cloud_transform(ewa_cloud *cloud, const double world_to_world[16]) {
    if (!cloud || !world_to_world) return EWA_ERROR_ARGUMENT;
    const double *m = world_to_world;
    double inverse_transpose[9];
    const double determinant = cofactors(m, inverse_transpose);
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]) || (i >= 12 && m[i] != (i == 15)))
            return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
                            "transform: number %d is %g; all have to be finite and the last row 0 0 0 1",
                            i + 1, m[i]);
    if (!isfinite(determinant) || determinant == 0)
        return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_NUMERIC,
                        "transform: determinant %g has no inverse", determinant);
    const double linear[9] = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    double sided[9], mirrored[9];
    for (int i = 0; i < 9; i++) {
        sided[i] = inverse_transpose[i] / determinant;
        mirrored[i] = determinant < 0 ? -linear[i] : linear[i];
    }
    ewa_status status = map_triples(cloud, EWA_POSITION, linear, false);
    if (status == EWA_OK) status = map_triples(cloud, EWA_NORMAL, sided, true);
    if (status == EWA_OK) status = map_triples(cloud, EWA_TANGENT_U, linear, false);
    // A reflection turns u x v inside out: v changes its sign, and with it b of the clip lines.
    if (status == EWA_OK) status = map_triples(cloud, EWA_TANGENT_V, mirrored, false);
    const double sign = determinant < 0 ? -1 : 1;
    if (status == EWA_OK) status = scale_component(cloud, EWA_CLIP0, 1, sign);
    if (status == EWA_OK) status = scale_component(cloud, EWA_CLIP1, 1, sign);
    if (status == EWA_OK) status = scale_component(cloud, EWA_RADIUS, 0, cbrt(fabs(determinant)));
    if (status != EWA_OK) return status;
    double origin_world[3], moved_world[3];
    ewa_cloud_origin(cloud, origin_world);
    for (int r = 0; r < 3; r++)
        moved_world[r] = linear[3 * r] * origin_world[0] + linear[3 * r + 1] * origin_world[1] +
                         linear[3 * r + 2] * origin_world[2] + m[4 * r + 3];
    ewa_cloud_set_origin(cloud, moved_world);
    move_grid(cloud, linear, (const double[3]){m[3], m[7], m[11]});
    return EWA_OK;
}
