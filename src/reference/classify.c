// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a voxel looks like under a transfer function, for the reference of volumes.
//
// Based on: M. Levoy, "Display of Surfaces from Volume Data", 1988; S. Zucker, R. Hummel, "A Three-Dimensional Edge
// Operator", 1981.
#include "reference/classify.h"

/// The grid's axes in the world over the shortest one, as rows; returns the length of that.
static double find_axes(const ewa_volume *volume, ewa_mat3 *axes) {
    const double *m = volume->index_to_world;
    double shortest = INFINITY;
    for (int axis = 0; axis < 3; axis++)
        shortest = fmin(shortest, hypot(hypot(m[axis], m[4 + axis]), m[8 + axis]));
    for (int axis = 0; axis < 3; axis++)
        for (int c = 0; c < 3; c++) axes->m[axis][c] = m[4 * c + axis] / shortest;
    return shortest;
}

double ewa_reference_spacing(const ewa_volume *volume) {
    ewa_mat3 axes;
    const double spacing = find_axes(volume, &axes), cell = mat3_determinant(&axes);
    return isfinite(spacing) && isfinite(cell) && cell != 0 ? spacing : 0;
}

/// The number at a place; NaN outside.
static double value_at(const ewa_volume *volume, int64_t i, int64_t j, int64_t k) {
    const uint32_t *dims = volume->dims;
    if (i < 0 || j < 0 || k < 0 || i >= dims[0] || j >= dims[1] || k >= dims[2]) return NAN;
    const size_t at = ((size_t)k * dims[1] + (size_t)j) * dims[0] + (size_t)i;
    if (volume->type == EWA_U8) return ((const uint8_t *)volume->voxels)[at];
    if (volume->type == EWA_I8) return ((const int8_t *)volume->voxels)[at];
    if (volume->type == EWA_U16) return ((const uint16_t *)volume->voxels)[at];
    if (volume->type == EWA_I16) return ((const int16_t *)volume->voxels)[at];
    const double value = (double)((const float *)volume->voxels)[at];
    return isfinite(value) ? value : NAN;
}

/// Colour and extinction of a value, per unit length of the transfer function.
static double look_up(const ewa_transfer *transfer, double value, double color[3]) {
    const ewa_transfer_point *p = transfer->points;
    const uint32_t last = transfer->point_count - 1;
    if (!(value >= p[0].value && value <= p[last].value)) return 0;
    uint32_t i = last;
    while (p[i].value > value) i--;
    const ewa_transfer_point *a = &p[i], *b = i < last ? a + 1 : a;
    const double t = a == b ? 0 : (value - a->value) / (b->value - a->value);
    for (int c = 0; c < 3; c++) color[c] = (1 - t) * (double)a->color[c] + t * (double)b->color[c];
    return (1 - t) * (double)a->extinction + t * (double)b->extinction;
}

/// The slope of the values along an axis of the grid: mean over the nine lines around the voxel, weighted 1 2 1 by
/// 1 2 1, of central differences, one-sided ones at borders and beside what is no number.
static double slope_along(const ewa_volume *volume, const int64_t at[3], int axis) {
    double sum = 0, weights = 0;
    for (int b = -1; b <= 1; b++)
        for (int c = -1; c <= 1; c++) {
            double line[3];
            for (int n = 0; n < 3; n++) {
                int64_t place[3];
                place[axis] = at[axis] + n - 1;
                place[(axis + 1) % 3] = at[(axis + 1) % 3] + b;
                place[(axis + 2) % 3] = at[(axis + 2) % 3] + c;
                line[n] = value_at(volume, place[0], place[1], place[2]);
            }
            double slope = (line[2] - line[0]) / 2;
            if (isnan(line[0])) slope = line[2] - line[1];
            if (isnan(line[2])) slope = line[1] - line[0];
            if (isnan(slope)) continue;
            const double weight = (b ? 1 : 2) * (c ? 1 : 2);
            sum += weight * slope, weights += weight;
        }
    return weights > 0 ? sum / weights : 0;
}

bool ewa_reference_classify(const ewa_volume *volume, const ewa_transfer *transfer, uint32_t i, uint32_t j,
                            uint32_t k, ewa_reference_voxel *voxel) {
    double color[3];
    const double extinction = look_up(transfer, value_at(volume, i, j, k), color);
    if (!(extinction > 0)) return false;
    ewa_mat3 axes;
    const double spacing = find_axes(volume, &axes);
    const double unit_length = transfer->unit_length_world > 0 ? transfer->unit_length_world : spacing;
    const int64_t at[3] = {i, j, k};
    double slopes[3];
    for (int axis = 0; axis < 3; axis++) slopes[axis] = slope_along(volume, at, axis);
    // A step along an axis changes the value by its slope: axes . gradient = slopes.
    const ewa_mat3 adjugate = mat3_adjugate(&axes);
    const ewa_vec3 gradient =
        vec3_scale(mat3_mul_vec3(&adjugate, vec3_load(slopes)), 1 / mat3_determinant(&axes));
    voxel->color = vec3_load(color);
    voxel->extinction = extinction * (spacing / unit_length);
    const double low = transfer->gradient_low, high = transfer->gradient_high;
    if (low != 0 || high != 0) {
        const double length = vec3_length(gradient) / spacing;
        voxel->extinction *= length >= high ? 1 : length <= low ? 0 : (length - low) / (high - low);
    }
    // One slice is a picture, not a surface.
    const bool slice = volume->dims[0] == 1 || volume->dims[1] == 1 || volume->dims[2] == 1;
    voxel->normal_world = slice ? vec3_make(0, 0, 0) : vec3_scale(gradient, -1);
    if (!vec3_normalize(&voxel->normal_world)) voxel->normal_world = vec3_make(0, 0, 0);
    return voxel->extinction > 0;
}
