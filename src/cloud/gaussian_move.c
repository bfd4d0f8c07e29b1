// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of Gaussians under affine maps.
#include "base/base.h"
#include "cloud/gaussian_merge.h"
#include "cloud/gaussian_turn.h"

#include <math.h>

/// A linear map taken apart: turn * stretch, the turn orthogonal.
typedef struct parts {
    double linear[9];
    double turn[9]; ///< orthogonal, maybe with a mirroring
    double factor;  ///< linear = factor * turn where is_similar
    bool is_similar;
} parts;

static double dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Makes the columns orthogonal and of length 1, from the first on.
static bool take_apart(const double m[16], parts *made) {
    double columns[3][3], lengths[3];
    made->is_similar = true;
    for (int c = 0; c < 3; c++) {
        for (int r = 0; r < 3; r++) made->linear[3 * r + c] = columns[c][r] = m[4 * r + c];
        lengths[c] = sqrt(dot3(columns[c], columns[c]));
        for (int k = 0; k < c; k++) {
            const double along = dot3(columns[c], columns[k]);
            if (fabs(along) > 1e-9 * lengths[c]) made->is_similar = false;
            for (int r = 0; r < 3; r++) columns[c][r] -= along * columns[k][r];
        }
        const double rest = sqrt(dot3(columns[c], columns[c]));
        if (!isfinite(lengths[c]) || !(rest > 1e-12 * lengths[c])) return false;
        for (int r = 0; r < 3; r++) columns[c][r] /= rest;
        if (fabs(lengths[c] - lengths[0]) > 1e-9 * lengths[0]) made->is_similar = false;
    }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) made->turn[3 * r + c] = columns[c][r];
    made->factor = lengths[0];
    return true;
}

void ewa_gaussian_axes(const float rotation[4], double axes[9]) {
    const double w = (double)rotation[0], x = (double)rotation[1], y = (double)rotation[2],
                 z = (double)rotation[3];
    axes[0] = 1 - 2 * (y * y + z * z), axes[1] = 2 * (x * y - w * z), axes[2] = 2 * (x * z + w * y);
    axes[3] = 2 * (x * y + w * z), axes[4] = 1 - 2 * (x * x + z * z), axes[5] = 2 * (y * z - w * x);
    axes[6] = 2 * (x * z - w * y), axes[7] = 2 * (y * z + w * x), axes[8] = 1 - 2 * (x * x + y * y);
}

/// The unit quaternion of a rotation matrix, by its largest component, which is > 0.
static void rotation_of(const double a[9], float rotation[4]) {
    const double squares[4] = {1 + a[0] + a[4] + a[8], 1 + a[0] - a[4] - a[8], 1 - a[0] + a[4] - a[8],
                               1 - a[0] - a[4] + a[8]}; // four times those of w x y z
    int largest = 0;
    for (int k = 1; k < 4; k++)
        if (squares[k] > squares[largest]) largest = k;
    // Four times the products of w x y z by the largest.
    const double products[4][4] = {
        {squares[0], a[7] - a[5], a[2] - a[6], a[3] - a[1]},
        {a[7] - a[5], squares[1], a[1] + a[3], a[2] + a[6]},
        {a[2] - a[6], a[1] + a[3], squares[2], a[5] + a[7]},
        {a[3] - a[1], a[2] + a[6], a[5] + a[7], squares[3]},
    };
    double norm2 = 0;
    for (int k = 0; k < 4; k++) norm2 += products[largest][k] * products[largest][k];
    for (int k = 0; k < 4; k++) rotation[k] = (float)(products[largest][k] / sqrt(norm2));
}

/// Turns the columns of a matrix against each other until they are orthogonal (one-sided Jacobi): they are the
/// axes of the ellipsoid then.
static void make_orthogonal(double columns[3][3]) {
    for (int sweep = 0; sweep < 30; sweep++) {
        bool changed = false;
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                const double pp = dot3(columns[p], columns[p]), qq = dot3(columns[q], columns[q]),
                             pq = dot3(columns[p], columns[q]);
                if (pq * pq <= 1e-30 * pp * qq) continue;
                changed = true;
                const double angle = 0.5 * atan2(2 * pq, pp - qq), c = cos(angle), s = sin(angle);
                for (int r = 0; r < 3; r++) {
                    const double a = columns[p][r], b = columns[q][r];
                    columns[p][r] = c * a + s * b;
                    columns[q][r] = c * b - s * a;
                }
            }
        if (!changed) return;
    }
}

static void cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1], c[1] = a[2] * b[0] - a[0] * b[2], c[2] = a[0] * b[1] - a[1] * b[0];
}

void ewa_gaussian_of_columns(double columns[3][3], float scales[3], float rotation[4]) {
    double lengths[3];
    make_orthogonal(columns);
    int shortest = 2;
    for (int c = 0; c < 3; c++) {
        lengths[c] = sqrt(dot3(columns[c], columns[c]));
        scales[c] = (float)lengths[c];
        for (int r = 0; r < 3 && lengths[c] > 0; r++) columns[c][r] /= lengths[c];
    }
    for (int c = 0; c < 3; c++)
        if (lengths[c] < lengths[shortest]) shortest = c;
    const double *u = columns[(shortest + 1) % 3], *v = columns[(shortest + 2) % 3];
    double across[3], turned[9];
    cross(u, v, across);
    if (!(dot3(across, across) > 0.5)) return; // a point or a line: any axes are as good as the old ones
    for (int r = 0; r < 3; r++) columns[shortest][r] = across[r];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) turned[3 * r + c] = columns[c][r];
    rotation_of(turned, rotation);
}

/// Any ellipsoid: its axes are those of the columns of linear * axes * scales.
static void map_ellipsoid(const parts *by, const double axes[9], float scales[3], float rotation[4]) {
    double columns[3][3];
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) {
            columns[c][r] = 0;
            for (int k = 0; k < 3; k++)
                columns[c][r] += by->linear[3 * r + k] * axes[3 * k + c] * (double)scales[c];
        }
    ewa_gaussian_of_columns(columns, scales, rotation);
}

/// Turned and scaled alike in all directions: the axes stay the axes.
static void map_similar(const parts *by, const double axes[9], bool mirrors, float scales[3],
                        float rotation[4]) {
    double turned[9];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            turned[3 * r + c] = 0;
            for (int k = 0; k < 3; k++) turned[3 * r + c] += by->turn[3 * r + k] * axes[3 * k + c];
            // The ellipsoid does not know which way its axes point.
            if (mirrors) turned[3 * r + c] = -turned[3 * r + c];
        }
    rotation_of(turned, rotation);
    for (int c = 0; c < 3; c++) scales[c] = (float)(by->factor * (double)scales[c]);
}

ewa_status ewa_gaussians_transform(ewa_gaussians *gaussians, const double world_to_world[16]) {
    if (!gaussians || !world_to_world || !gaussians->context) return EWA_ERROR_ARGUMENT;
    const double *m = world_to_world;
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]) || (i >= 12 && m[i] != (i == 15)))
            return ewa_fail(gaussians->context, EWA_ERROR_ARGUMENT,
                            "transform: number %d is %g; all have to be finite and the last row 0 0 0 1",
                            i + 1, m[i]);
    parts by;
    if (!take_apart(m, &by))
        return ewa_fail(gaussians->context, EWA_ERROR_NUMERIC, "transform: the matrix has no inverse");
    double across[3];
    cross((const double[]){by.turn[0], by.turn[3], by.turn[6]},
          (const double[]){by.turn[1], by.turn[4], by.turn[7]}, across);
    const bool mirrors = dot3(across, (const double[]){by.turn[2], by.turn[5], by.turn[8]}) < 0;
    ewa_sh_turn turn;
    ewa_sh_turn_make(by.turn, &turn);
    const size_t numbers = 3 * (size_t)(gaussians->sh_degree + 1) * (gaussians->sh_degree + 1);
    for (size_t i = 0; i < gaussians->count; i++) {
        float *center = gaussians->centers + 3 * i, *rotation = gaussians->rotations + 4 * i,
              *scales = gaussians->scales + 3 * i;
        const double old[3] = {(double)center[0], (double)center[1], (double)center[2]};
        for (int r = 0; r < 3; r++) center[r] = (float)dot3(by.linear + 3 * r, old);
        double axes[9];
        ewa_gaussian_axes(rotation, axes);
        if (by.is_similar)
            map_similar(&by, axes, mirrors, scales, rotation);
        else
            map_ellipsoid(&by, axes, scales, rotation);
        ewa_sh_turn_apply(&turn, gaussians->sh_degree, gaussians->harmonics + i * numbers);
    }
    double origin[3];
    for (int r = 0; r < 3; r++) origin[r] = dot3(by.linear + 3 * r, gaussians->origin) + m[4 * r + 3];
    for (int r = 0; r < 3; r++) gaussians->origin[r] = origin[r];
    return EWA_OK;
}
