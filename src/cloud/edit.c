// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds from clouds: some of the points, an affine map of space.
//
// Based on: Bloomenthal and Rokne, "Homogeneous Coordinates", 1994: points go by M, planes (normals) by the
// inverse transpose.
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/scanners.h"
#include "ewa/cloud.h"

#include <math.h>
#include <string.h>

enum { BLOCK_POINTS = 256 };

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

/// Maps borders, of which each, b, stands for the plane b.x = b.b: like normals, and by the length that they get.
static ewa_status map_borders(ewa_cloud *cloud, const double inverse_transpose[9]) {
    const ewa_attribute *found = ewa_cloud_find(cloud, EWA_BORDER);
    if (!found) return EWA_OK;
    const ewa_attribute from = *found;
    ewa_context *context = ewa_cloud_context(cloud);
    if (from.component_count != 3)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "attribute '%s' has %u components, not 3", EWA_BORDER,
                        from.component_count);
    const uint64_t count = ewa_cloud_point_count(cloud);
    double(*mapped)[3] = ewa_allocate(context, count, sizeof *mapped);
    if (!mapped) return EWA_ERROR_MEMORY;
    ewa_attribute_read_f64(&from, 0, count, mapped[0]);
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_BORDER, EWA_F32, 3, &data);
    for (uint64_t i = 0; status == EWA_OK && i < count; i++) {
        const double *b = mapped[i], length2 = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
        double n[3];
        for (int r = 0; r < 3; r++)
            n[r] = inverse_transpose[3 * r] * b[0] + inverse_transpose[3 * r + 1] * b[1] +
                   inverse_transpose[3 * r + 2] * b[2];
        const double normal2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        const double scale = normal2 > 0 ? length2 / normal2 : 0;
        for (int r = 0; r < 3; r++) ((float *)data)[3 * i + (uint64_t)r] = (float)(n[r] * scale);
    }
    ewa_release(context, mapped, count, sizeof *mapped);
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

/// Scanners go with what they saw; that of a range image which names none stood at the origin.
static ewa_status map_scanners(ewa_cloud *cloud, const double m[16]) {
    ewa_context *context = ewa_cloud_context(cloud);
    const size_t known = ewa_cloud_read_scanners(cloud, 0, NULL), count = known ? known : ewa_cloud_note(cloud, "file.organised", NULL) != NULL;
    if (!count) return EWA_OK;
    double(*world)[3] = ewa_allocate_zeroed(context, count, sizeof *world);
    if (!world) return EWA_ERROR_MEMORY;
    ewa_cloud_read_scanners(cloud, known, world);
    for (size_t i = 0; i < count; i++) {
        const double p[3] = {world[i][0], world[i][1], world[i][2]};
        for (int r = 0; r < 3; r++) world[i][r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
    }
    const ewa_status status = ewa_cloud_write_scanners(cloud, count, (const double(*)[3])world);
    ewa_release(context, world, count, sizeof *world);
    return status;
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
    EWA_TRY(map_triples(cloud, EWA_POSITION, linear, false));
    EWA_TRY(map_triples(cloud, EWA_NORMAL, sided, true));
    EWA_TRY(map_triples(cloud, EWA_TANGENT_U, linear, false));
    // A reflection turns u x v inside out: v changes its sign, and with it b of the clip lines.
    EWA_TRY(map_triples(cloud, EWA_TANGENT_V, mirrored, false));
    const double sign = determinant < 0 ? -1 : 1;
    EWA_TRY(scale_component(cloud, EWA_CLIP0, 1, sign));
    EWA_TRY(scale_component(cloud, EWA_CLIP1, 1, sign));
    EWA_TRY(map_borders(cloud, sided));
    EWA_TRY(map_scanners(cloud, m));
    EWA_TRY(scale_component(cloud, EWA_RADIUS, 0, cbrt(fabs(determinant))));
    EWA_TRY(scale_component(cloud, EWA_CURVATURE, 0, 1 / cbrt(fabs(determinant))));
    double origin_world[3], moved_world[3];
    ewa_cloud_origin(cloud, origin_world);
    for (int r = 0; r < 3; r++)
        moved_world[r] = linear[3 * r] * origin_world[0] + linear[3 * r + 1] * origin_world[1] +
                         linear[3 * r + 2] * origin_world[2] + m[4 * r + 3];
    ewa_cloud_set_origin(cloud, moved_world);
    move_grid(cloud, linear, (const double[3]){m[3], m[7], m[11]});
    return EWA_OK;
}
