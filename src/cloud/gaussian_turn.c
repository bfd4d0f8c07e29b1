// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Turning and mirroring of functions on the sphere that are given by real harmonics: a turn mixes those of one degree
// only, so the mixture follows from as many directions as the degree has harmonics.
//
// Based on: B. Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", 2023 (order and signs);
// Khronos, KHR_gaussian_splatting, appendix A.
#include "cloud/gaussian_turn.h"

#include <math.h>

void ewa_sh_values(const double direction[3], uint32_t sh_degree, double *values) {
    const double x = direction[0], y = direction[1], z = direction[2], xx = x * x, yy = y * y, zz = z * z;
    values[0] = 0.28209479177387814;
    if (sh_degree < 1) return;
    values[1] = -0.4886025119029199 * y;
    values[2] = 0.4886025119029199 * z;
    values[3] = -0.4886025119029199 * x;
    if (sh_degree < 2) return;
    values[4] = 1.0925484305920792 * x * y;
    values[5] = -1.0925484305920792 * y * z;
    values[6] = 0.31539156525252005 * (2 * zz - xx - yy);
    values[7] = -1.0925484305920792 * x * z;
    values[8] = 0.5462742152960396 * (xx - yy);
    if (sh_degree < 3) return;
    values[9] = -0.5900435899266435 * y * (3 * xx - yy);
    values[10] = 2.890611442640554 * x * y * z;
    values[11] = -0.4570457994644658 * y * (4 * zz - xx - yy);
    values[12] = 0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy);
    values[13] = -0.4570457994644658 * x * (4 * zz - xx - yy);
    values[14] = 1.445305721320277 * z * (xx - yy);
    values[15] = -0.5900435899266435 * x * (xx - 3 * yy);
    if (sh_degree < 4) return;
    values[16] = 2.5033429417967046 * x * y * (xx - yy);
    values[17] = -1.7701307697799304 * y * z * (3 * xx - yy);
    values[18] = 0.9461746957575601 * x * y * (7 * zz - 1);
    values[19] = -0.6690465435572892 * y * z * (7 * zz - 3);
    values[20] = 0.10578554691520431 * (zz * (35 * zz - 30) + 3);
    values[21] = -0.6690465435572892 * x * z * (7 * zz - 3);
    values[22] = 0.47308734787878004 * (xx - yy) * (7 * zz - 1);
    values[23] = -1.7701307697799304 * x * z * (xx - 3 * yy);
    values[24] = 0.6258357354491761 * (xx * (xx - 3 * yy) - yy * (3 * xx - yy));
}

/// Solves A X = B for square matrices of `n` rows by elimination with pivots; B becomes X.
static void solve(uint32_t n, double *a, double *b) {
    for (uint32_t k = 0; k < n; k++) {
        uint32_t pivot = k;
        for (uint32_t r = k + 1; r < n; r++)
            if (fabs(a[r * n + k]) > fabs(a[pivot * n + k])) pivot = r;
        for (uint32_t c = 0; c < n; c++) {
            const double swapped_a = a[k * n + c], swapped_b = b[k * n + c];
            a[k * n + c] = a[pivot * n + c], a[pivot * n + c] = swapped_a;
            b[k * n + c] = b[pivot * n + c], b[pivot * n + c] = swapped_b;
        }
        for (uint32_t r = 0; r < n; r++) {
            if (r == k) continue;
            const double factor = a[r * n + k] / a[k * n + k];
            for (uint32_t c = 0; c < n; c++) {
                a[r * n + c] -= factor * a[k * n + c];
                b[r * n + c] -= factor * b[k * n + c];
            }
        }
    }
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t c = 0; c < n; c++) b[r * n + c] /= a[r * n + r];
}

/// Directions spread over the sphere, no two of them opposite: a spiral over its upper half, which is enough for
/// functions that are even or odd.
static void sphere_direction(uint32_t index, uint32_t count, double direction[3]) {
    const double z = (index + 0.5) / count, angle = 2.399963229728653 * index, radius = sqrt(1 - z * z);
    direction[0] = radius * cos(angle), direction[1] = radius * sin(angle), direction[2] = z;
}

void ewa_sh_turn_make(const double turn[9], ewa_sh_turn *made) {
    for (uint32_t degree = 1; degree <= EWA_MAX_SH_DEGREE; degree++) {
        const uint32_t n = 2 * degree + 1;
        double after[EWA_MAX_SH_ROW * EWA_MAX_SH_ROW], *before = made->map[degree - 1];
        for (uint32_t i = 0; i < n; i++) {
            double from[3], to[3], values[(EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1)];
            sphere_direction(i, n, from);
            for (int r = 0; r < 3; r++)
                to[r] = turn[3 * r] * from[0] + turn[3 * r + 1] * from[1] + turn[3 * r + 2] * from[2];
            ewa_sh_values(from, degree, values);
            for (uint32_t k = 0; k < n; k++) before[i * n + k] = values[degree * degree + k];
            ewa_sh_values(to, degree, values);
            for (uint32_t k = 0; k < n; k++) after[i * n + k] = values[degree * degree + k];
        }
        solve(n, after, before);
    }
}

void ewa_sh_turn_apply(const ewa_sh_turn *turn, uint32_t sh_degree, float *harmonics) {
    for (uint32_t degree = 1; degree <= sh_degree; degree++) {
        const uint32_t n = 2 * degree + 1;
        const double *map = turn->map[degree - 1];
        float *row = harmonics + 3 * degree * degree;
        for (uint32_t color = 0; color < 3; color++) {
            double old[EWA_MAX_SH_ROW];
            for (uint32_t k = 0; k < n; k++) old[k] = (double)row[3 * k + color];
            for (uint32_t r = 0; r < n; r++) {
                double sum = 0;
                for (uint32_t k = 0; k < n; k++) sum += map[r * n + k] * old[k];
                row[3 * r + color] = (float)sum;
            }
        }
    }
}
