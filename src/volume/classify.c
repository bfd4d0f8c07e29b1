// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a volume's voxels look like under a transfer function: colour, extinction, normal (docs/math.md
// section 12).
//
// Based on: M. Levoy, "Display of Surfaces from Volume Data", 1988 (classification by value and gradient,
// shading by the gradient); S. Zucker, R. Hummel, "A Three-Dimensional Edge Operator", 1981 (differences
// averaged across their direction).
#include "volume/classify.h"
#include "base/base.h"
#include "image/transfer.h"

#include <math.h>

static ewa_status check_volume(ewa_context *context, const ewa_volume *volume) {
    enum { MAXIMUM = 1 << 21 };
    if (!volume->voxels) return ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: no voxels");
    for (int a = 0; a < 3; a++)
        if (volume->dims[a] == 0 || volume->dims[a] > MAXIMUM)
            return ewa_fail(context, volume->dims[a] ? EWA_ERROR_LIMIT : EWA_ERROR_ARGUMENT,
                            "volume: %u x %u x %u voxels, allowed are 1 to %d along each axis",
                            volume->dims[0], volume->dims[1], volume->dims[2], MAXIMUM);
    for (int i = 0; i < 12; i++)
        if (!isfinite(volume->index_to_world[i]))
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: index_to_world[%d] is %g", i,
                            volume->index_to_world[i]);
    switch (volume->type) {
    case EWA_U8:
    case EWA_I8:
    case EWA_U16:
    case EWA_I16:
    case EWA_F32:
        return EWA_OK;
    default:
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: voxels of type %d", (int)volume->type);
    }
}

ewa_status ewa_classifier_make(ewa_context *context, const ewa_volume *volume, const ewa_transfer *transfer,
                               ewa_classifier *classifier) {
    EWA_TRY(check_volume(context, volume));
    EWA_TRY(ewa_transfer_check(context, "transfer function", transfer));
    const double *m = volume->index_to_world;
    ewa_classifier c = {.volume = volume, .transfer = transfer, .spacing_world = INFINITY};
    double longest = 0;
    ewa_mat3 axes;
    for (int axis = 0; axis < 3; axis++) {
        const double length = vec3_length_scaled(vec3_make(m[axis], m[4 + axis], m[8 + axis]));
        c.spacing_world = fmin(c.spacing_world, length);
        longest = fmax(longest, length);
    }
    // In units of the shortest step, so that the world's scale does not matter.
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 3; k++) axes.m[axis][k] = m[4 * k + axis] / c.spacing_world;
    const double determinant = mat3_determinant(&axes), ratio = longest / c.spacing_world;
    // Axes that are all but in one plane.
    if (!(fabs(determinant) > 1e-9 * ratio * ratio) || !isfinite(determinant))
        return ewa_fail(
            context, EWA_ERROR_ARGUMENT,
            "volume: index_to_world is not invertible: its axes span %g of the shortest one cubed",
            determinant);
    const ewa_mat3 adjugate = mat3_adjugate(&axes);
    c.units_to_index = mat3_scale(&adjugate, 1 / determinant);
    c.unit_length_world = transfer->unit_length_world > 0 ? transfer->unit_length_world : c.spacing_world;
    // The values of one slice say nothing of surfaces: as a picture it is as light as its colours.
    c.has_normals = volume->dims[0] > 1 && volume->dims[1] > 1 && volume->dims[2] > 1;
    c.with_ramp = transfer->gradient_low != 0 || transfer->gradient_high != 0;
    *classifier = c;
    return EWA_OK;
}

double ewa_volume_value(const ewa_volume *volume, uint32_t i, uint32_t j, uint32_t k) {
    const size_t at = ((size_t)k * volume->dims[1] + j) * volume->dims[0] + i;
    switch (volume->type) {
    case EWA_U8:
        return ((const uint8_t *)volume->voxels)[at];
    case EWA_I8:
        return ((const int8_t *)volume->voxels)[at];
    case EWA_U16:
        return ((const uint16_t *)volume->voxels)[at];
    case EWA_I16:
        return ((const int16_t *)volume->voxels)[at];
    default:
        return (double)((const float *)volume->voxels)[at];
    }
}

/// The last point whose value is not above `value`; false outside of the points.
static bool find_point(const ewa_transfer *transfer, double value, uint32_t *point) {
    uint32_t low = 0, high = transfer->point_count; // points[low].value <= value < points[high].value
    if (!(value >= transfer->points[0].value) || value > transfer->points[high - 1].value) return false;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (transfer->points[middle].value <= value)
            low = middle;
        else
            high = middle;
    }
    *point = low;
    return true;
}

/// Colour and extinction (per unit length of the transfer function) of a value.
static double look_up(const ewa_transfer *transfer, double value, double color[3]) {
    uint32_t i;
    if (!find_point(transfer, value, &i)) return 0;
    const ewa_transfer_point *a = &transfer->points[i], *b = a + (i + 1 < transfer->point_count);
    const double t = a == b ? 0 : (value - a->value) / (b->value - a->value);
    for (int c = 0; c < 3; c++)
        color[c] = (double)a->color[c] + t * ((double)b->color[c] - (double)a->color[c]);
    return (double)a->extinction + t * ((double)b->extinction - (double)a->extinction);
}

/// Whether a value can be seen where the gradient does not take it away.
static bool sees(const ewa_classifier *classifier, double value) {
    double color[3];
    return look_up(classifier->transfer, value, color) > 0;
}

bool ewa_classifier_reaches(const ewa_classifier *classifier, double low, double high) {
    if (sees(classifier, low) || sees(classifier, high)) return true;
    const ewa_transfer *transfer = classifier->transfer;
    for (uint32_t i = 0; i < transfer->point_count; i++) {
        const ewa_transfer_point *p = &transfer->points[i];
        if (p->value >= low && p->value <= high && p->extinction > 0) return true;
    }
    return false;
}

/// The values around a voxel, [k][j][i]; NaN beyond the border and where there is no number.
typedef double surroundings[3][3][3];

#define READ_AROUND(type)                                                                                    \
    {                                                                                                        \
        const type *from = (const type *)volume->voxels + at;                                                \
        for (int c = 0; c < 3; c++)                                                                          \
            for (int b = 0; b < 3; b++) {                                                                    \
                const type *row = from + (c - 1) * slice + (b - 1) * line;                                   \
                for (int a = 0; a < 3; a++) around[c][b][a] = (double)row[a - 1];                            \
            }                                                                                                \
        break;                                                                                               \
    }

static void read_inside(const ewa_volume *volume, size_t at, surroundings around) {
    const ptrdiff_t line = volume->dims[0], slice = line * (ptrdiff_t)volume->dims[1];
    switch (volume->type) {
    case EWA_U8:
        READ_AROUND(uint8_t)
    case EWA_I8:
        READ_AROUND(int8_t)
    case EWA_U16:
        READ_AROUND(uint16_t)
    case EWA_I16:
        READ_AROUND(int16_t)
    default:
        READ_AROUND(float)
    }
}

static void read_at_border(const ewa_volume *volume, const uint32_t at[3], surroundings around) {
    const uint32_t *dims = volume->dims;
    for (uint32_t n = 0; n < 27; n++) {
        // One more than the place, so that nothing is below zero.
        const uint32_t i = at[0] + n % 3, j = at[1] + n / 3 % 3, k = at[2] + n / 9;
        const bool inside = i >= 1 && i <= dims[0] && j >= 1 && j <= dims[1] && k >= 1 && k <= dims[2];
        const double value = inside ? ewa_volume_value(volume, i - 1, j - 1, k - 1) : NAN;
        around[n / 9][n / 3 % 3][n % 3] = isfinite(value) ? value : NAN;
    }
}

/// The slope along a line of three, one-sided where an end is missing; false where it cannot be had.
static bool slope_of(double below, double middle, double above, double *slope) {
    if (isnan(below) || isnan(above)) {
        if (isnan(middle) || (isnan(below) && isnan(above))) return false;
        *slope = isnan(below) ? above - middle : middle - below;
    } else {
        *slope = 0.5 * (above - below);
    }
    return true;
}

/// Slopes along i, j, k: means over the nine lines around the voxel with weights 1 2 1 by 1 2 1, which keeps
/// steps of a voxel from showing as terraces.
static void find_slopes(surroundings v, double slopes[3]) {
    static const double weights[3] = {1, 2, 1};
    for (int axis = 0; axis < 3; axis++) {
        double sum = 0, all = 0;
        for (int c = 0; c < 3; c++)
            for (int b = 0; b < 3; b++) {
                const double line[3] = {axis == 0   ? v[c][b][0]
                                        : axis == 1 ? v[c][0][b]
                                                    : v[0][c][b],
                                        axis == 0   ? v[c][b][1]
                                        : axis == 1 ? v[c][1][b]
                                                    : v[1][c][b],
                                        axis == 0   ? v[c][b][2]
                                        : axis == 1 ? v[c][2][b]
                                                    : v[2][c][b]};
                double slope;
                if (!slope_of(line[0], line[1], line[2], &slope)) continue;
                sum += weights[b] * weights[c] * slope;
                all += weights[b] * weights[c];
            }
        slopes[axis] = all > 0 ? sum / all : 0;
    }
}

/// The same where nothing is missing.
static void find_slopes_inside(surroundings v, double slopes[3]) {
    double x = 0, y = 0, z = 0;
    for (int c = 0; c < 3; c++)
        for (int b = 0; b < 3; b++) {
            const double weight = (b == 1 ? 2 : 1) * (c == 1 ? 2 : 1);
            x += weight * (v[c][b][2] - v[c][b][0]);
            y += weight * (v[c][2][b] - v[c][0][b]);
            z += weight * (v[2][c][b] - v[0][c][b]);
        }
    slopes[0] = x / 32, slopes[1] = y / 32, slopes[2] = z / 32;
}

/// Value per unit.
static ewa_vec3 gradient(const ewa_classifier *classifier, uint32_t i, uint32_t j, uint32_t k) {
    const ewa_volume *volume = classifier->volume;
    const uint32_t *dims = volume->dims, at[3] = {i, j, k};
    surroundings around;
    double slopes[3] = {0, 0, NAN};
    if (i && j && k && i + 1 < dims[0] && j + 1 < dims[1] && k + 1 < dims[2]) {
        read_inside(volume, ((size_t)k * dims[1] + j) * dims[0] + i, around);
        find_slopes_inside(around, slopes);
    }
    if (!isfinite(slopes[0] + slopes[1] + slopes[2])) {
        read_at_border(volume, at, around);
        find_slopes(around, slopes);
    }
    // The value's differential is a row of the index, which units_to_index takes there from the world.
    return mat3_mul_vec3(&classifier->units_to_index, vec3_load(slopes));
}

bool ewa_classify(const ewa_classifier *classifier, uint32_t i, uint32_t j, uint32_t k, bool with_normal,
                  ewa_voxel *voxel) {
    const ewa_transfer *transfer = classifier->transfer;
    const double value = ewa_volume_value(classifier->volume, i, j, k);
    const double extinction = look_up(transfer, value, voxel->color);
    if (!(extinction > 0)) return false;
    voxel->extinction = extinction * (classifier->spacing_world / classifier->unit_length_world);
    voxel->normal_world = vec3_make(0, 0, 0);
    if (!(with_normal && classifier->has_normals) && !classifier->with_ramp) return voxel->extinction > 0;
    const ewa_vec3 slope = gradient(classifier, i, j, k);
    if (classifier->with_ramp) {
        const double low = transfer->gradient_low, high = transfer->gradient_high;
        const double length = vec3_length(slope) / classifier->spacing_world;
        voxel->extinction *= length >= high ? 1 : length <= low ? 0 : (length - low) / (high - low);
    }
    if (!classifier->has_normals) return voxel->extinction > 0;
    voxel->normal_world = vec3_scale(slope, -1);
    if (!vec3_normalize(&voxel->normal_world)) voxel->normal_world = vec3_make(0, 0, 0);
    return voxel->extinction > 0;
}
