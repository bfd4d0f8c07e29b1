// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The checkerboard of space under a Gaussian in a plane.
//
// Footprints up to about a cell: along lines through the footprint the pattern is a step function, whose mean
// under a normal density is a sum of distribution functions at the steps, in closed form. The means of
// parallel lines are added up by the trapezoidal rule. The lines cross every family of edges at 30 degrees or
// more (three families leave a gap of 60 somewhere), so that across the lines the means have no jumps, and
// kinks only where edges meet.
//
// Wider ones: the Fourier series of the pattern, of which the Gaussian leaves only wave vectors near the
// normal of the plane.
#include "base/base.h"
#include "colors/pattern.h"
#include "math/gaussian.h"
#include "math/wave.h"

#include <math.h>

enum {
    MAX_STEPS = 48,   // of one line
    DIRECTIONS = 12,  // tried for the lines
    MAX_ORDER = 7,    // of the two lesser axes in the Fourier series
    ORDER_WINDOW = 6, // of the axis nearest to the normal, around the best
};

// Beyond so many standard deviations there is nothing left: 6e-5 of the density.
static const double REACH = 4;
// Distance of the lines in standard deviations.
static const double LINE_STEP = 0.25;
// Longest footprint, in cells, that lines take. Of longer ones the Fourier series leaves out less than 1e-2
// where they are at least a quarter as wide.
static const double WIDE = 0.8;

static double coordinate(ewa_vec3 a, int c) { return c == 0 ? a.x : c == 1 ? a.y : a.z; }

static double parity(double x) { return x - 2 * floor(0.5 * x) >= 1 ? -1 : 1; }

/// The axes of the same Gaussian, turned so that lines along the first cross all edges well.
static void turn_axes(const pattern_footprint *footprint, ewa_vec3 *along, ewa_vec3 *across) {
    double best = -1;
    *along = footprint->u, *across = footprint->v;
    for (int d = 0; d < DIRECTIONS; d++) {
        const double cosine = ewa_wave(0.5 * d / DIRECTIONS), sine = ewa_wave(0.5 * d / DIRECTIONS - 0.25);
        const ewa_vec3 a = vec3_add(vec3_scale(footprint->u, cosine), vec3_scale(footprint->v, sine)),
                       b = vec3_sub(vec3_scale(footprint->v, cosine), vec3_scale(footprint->u, sine));
        double minimum = 1;
        for (int c = 0; c < 3; c++) {
            const double x = coordinate(a, c), y = coordinate(b, c), length = sqrt(x * x + y * y);
            if (length > 1e-9) minimum = fmin(minimum, fabs(x) / length);
        }
        if (minimum > best) best = minimum, *along = a, *across = b;
    }
}

/// Share of the standard normal distribution above z, within 1e-7: M. Abramowitz, I. Stegun, "Handbook of
/// mathematical functions", 1964, 26.2.17.
static double normal_above(double z) {
    const double t = 1 / (1 + 0.2316419 * fabs(z));
    const double tail =
        ewa_normal_density(z) * t *
        (0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))));
    return z < 0 ? 1 - tail : tail;
}

/// Mean of the pattern along place + s along, s normal.
static double mean_of_line(ewa_vec3 place, ewa_vec3 along) {
    double steps[MAX_STEPS], sign = 1;
    int count = 0;
    for (int c = 0; c < 3; c++) {
        const double x = coordinate(place, c), slope = coordinate(along, c), reach = REACH * fabs(slope);
        sign *= parity(x - REACH * slope);
        for (double edge = ceil(x - reach); edge < x + reach && count < MAX_STEPS; edge++) {
            const double at = (edge - x) / slope;
            int to = count++;
            for (; to > 0 && steps[to - 1] > at; to--) steps[to] = steps[to - 1];
            steps[to] = at;
        }
    }
    double mean = sign;
    for (int i = 0; i < count; i++) {
        sign = -sign;
        mean += 2 * sign * normal_above(steps[i]);
    }
    return mean;
}

static double mean_by_lines(const pattern_footprint *footprint) {
    ewa_vec3 along, across;
    turn_axes(footprint, &along, &across);
    double sum = 0, weights = 0;
    for (double t = -REACH; t <= REACH; t += LINE_STEP) {
        const double weight = ewa_exp(-0.5 * t * t);
        sum += weight * mean_of_line(vec3_add(footprint->place, vec3_scale(across, t)), along);
        weights += weight;
    }
    return sum / weights;
}

/// The product of three square waves as sum over odd m of (2 / (i pi))^3 / (m1 m2 m3) exp(i pi m.x), each
/// term times exp(-pi^2 / 2 m Sigma m'); those of m and -m together are real.
static double mean_by_series(const pattern_footprint *footprint) {
    const ewa_vec3 normal = vec3_cross(footprint->u, footprint->v);
    int axis = 0; // nearest to the normal
    for (int c = 1; c < 3; c++)
        if (fabs(coordinate(normal, c)) > fabs(coordinate(normal, axis))) axis = c;
    double place[3], u[3], v[3];
    for (int c = 0; c < 3; c++) {
        place[c] = coordinate(footprint->place, (axis + c) % 3);
        u[c] = coordinate(footprint->u, (axis + c) % 3);
        v[c] = coordinate(footprint->v, (axis + c) % 3);
    }
    const double own = u[0] * u[0] + v[0] * v[0];
    double sum = 0;
    for (int m1 = 1; m1 <= MAX_ORDER; m1 += 2)
        for (int m2 = -MAX_ORDER; m2 <= MAX_ORDER; m2 += 2) {
            // m Sigma m' is a parabola in m0; only orders near its vertex are left.
            const double mu = m1 * u[1] + m2 * u[2], mv = m1 * v[1] + m2 * v[2];
            const double vertex = own > 1e-9 ? -(mu * u[0] + mv * v[0]) / own : 0;
            if (!(fabs(vertex) < 1e6)) continue;
            const int middle = 2 * (int)floor(0.5 * vertex) + 1;
            for (int m0 = middle - ORDER_WINDOW; m0 <= middle + ORDER_WINDOW; m0 += 2) {
                const double a = mu + m0 * u[0], b = mv + m0 * v[0],
                             exponent = 4.934802200544679 * (a * a + b * b);
                if (exponent > 12) continue;
                const double turns = 0.5 * (m0 * place[0] + m1 * place[1] + m2 * place[2]);
                sum -= ewa_wave(turns - 0.25) * ewa_exp(-exponent) / ((double)m0 * m1 * m2);
            }
        }
    return 0.5160245509311919 * sum; // 16 / pi^3
}

double ewa_pattern_checker(const pattern_footprint *footprint) {
    double sign = 1;
    bool whole = true;
    for (int c = 0; c < 3; c++) {
        const double x = coordinate(footprint->place, c), u = coordinate(footprint->u, c),
                     v = coordinate(footprint->v, c), reach = REACH * sqrt(u * u + v * v);
        sign *= parity(x);
        whole = whole && floor(x - reach) == floor(x + reach);
    }
    if (whole) return sign;
    const double uu = vec3_dot(footprint->u, footprint->u), vv = vec3_dot(footprint->v, footprint->v),
                 uv = vec3_dot(footprint->u, footprint->v),
                 long2 = 0.5 * (uu + vv) + sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
    return long2 > WIDE * WIDE ? mean_by_series(footprint) : mean_by_lines(footprint);
}
