// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Edges and corners in one neighbourhood.
#include "edges/feature_fit.h"

#include <math.h>
#include <string.h>

enum {
    SEEDS = 12,      // hypotheses: planes through small groups of points
    SEED_POINTS = 9, // points of such a group
    REFINEMENTS = 8,
    QUADRIC = 6, // its coefficients
    LANES = 8,   // FEATURE_POINTS is a multiple
    SWEEPS = 8,  // of Jacobi rotations: a 3 x 3 matrix is diagonal to the last bit after five or so
};

// Residuals are counted up to this many standard deviations of noise.
#define TRUNCATION 3.0
// Noise below this share of the spacing is not told from a surface that is slightly bent.
#define NOISE_FLOOR 0.04
// How much better than a quadric an edge, and than an edge a corner, has to explain the points.
#define EDGE_GAIN   1.3
#define CORNER_GAIN 1.4
// Squares that a good fit leaves, as a share of the noise: some of it goes into the planes, some is
// truncated.
#define GOOD_FIT 0.6
// Smallest share of the points on each plane.
#define EDGE_SHARE   0.1
#define CORNER_SHARE 0.07

typedef struct plane {
    double normal[3], offset;
} plane;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Diagonalises a symmetric matrix in place by Jacobi's rotations; the columns of `vectors` are its
/// eigenvectors.
static void decompose(double m[3][3], double vectors[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) vectors[i][j] = i == j;
    const double small = 1e-16 * (fabs(m[0][0]) + fabs(m[1][1]) + fabs(m[2][2]));
    bool turned = true;
    for (int sweep = 0; sweep < SWEEPS && turned; sweep++) {
        turned = false;
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                if (fabs(m[p][q]) <= small) continue;
                turned = true;
                const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                const double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1));
                const double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; k++) {
                    const double a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
                }
                for (int k = 0; k < 3; k++) {
                    const double a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
                    const double u = vectors[k][p], v = vectors[k][q];
                    vectors[k][p] = c * u - s * v, vectors[k][q] = s * u + c * v;
                }
            }
        }
    }
}

/// The mean and the axes of the points whose label is `label` (NULL: of all), the direction of smallest
/// variance last; false for less than three points.
static bool find_axes(const feature_points *points, const uint8_t *labels, uint8_t label, double mean[3],
                      double axes[3][3]) {
    double n = 0, first[3] = {0}, m[3][3] = {{0}}, vectors[3][3];
    for (uint32_t i = 0; i < points->count; i++) {
        if (labels && labels[i] != label) continue;
        const double p[3] = {points->x[i], points->y[i], points->z[i]};
        n++;
        for (int a = 0; a < 3; a++) {
            first[a] += p[a];
            for (int b = a; b < 3; b++) m[a][b] += p[a] * p[b];
        }
    }
    if (n < 3) return false;
    for (int a = 0; a < 3; a++) mean[a] = first[a] / n;
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) m[a][b] = m[b][a] = m[a][b] - n * mean[a] * mean[b];
    decompose(m, vectors);
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (m[order[j]][order[j]] < m[order[j + 1]][order[j + 1]]) {
                const int swap = order[j];
                order[j] = order[j + 1], order[j + 1] = swap;
            }
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) axes[i][c] = vectors[c][order[i]];
    return true;
}

/// Fits a plane to the points of a label, on the side of their normals.
static bool fit_plane(const feature_points *points, const uint8_t *labels, uint8_t label, plane *fitted) {
    double mean[3], axes[3][3], side = 0;
    if (!find_axes(points, labels, label, mean, axes)) return false;
    for (uint32_t i = 0; i < points->count; i++)
        if (labels[i] == label)
            for (int c = 0; c < 3; c++) side += (double)points->normal[i][c] * axes[2][c];
    const double sign = side < 0 ? -1 : 1;
    for (int c = 0; c < 3; c++) fitted->normal[c] = sign * axes[2][c];
    fitted->offset = dot(fitted->normal, mean);
    return true;
}

static double distance2(const feature_points *p, uint32_t i, uint32_t j) {
    const double x = p->x[i] - p->x[j], y = p->y[i] - p->y[j], z = p->z[i] - p->z[j];
    return x * x + y * y + z * z;
}

/// Planes through groups around points that are as far from each other as can be; returns how many.
static uint32_t make_seeds(const feature_points *points, plane seeds[SEEDS]) {
    const uint32_t n = points->count;
    double nearest[FEATURE_POINTS]; // to the seeds so far
    uint32_t made = 0, seed = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double d =
            points->x[i] * points->x[i] + points->y[i] * points->y[i] + points->z[i] * points->z[i];
        nearest[i] = INFINITY;
        if (i == 0 || d > nearest[seed]) seed = i;
    }
    for (uint32_t s = 0; s < SEEDS && s < n; s++) {
        double distance[FEATURE_POINTS], limit[SEED_POINTS];
        for (int k = 0; k < SEED_POINTS; k++) limit[k] = INFINITY;
        for (uint32_t i = 0; i < n; i++) {
            double d = distance[i] = distance2(points, i, seed);
            if (d < nearest[i]) nearest[i] = d;
            for (int k = 0; k < SEED_POINTS && d < limit[SEED_POINTS - 1]; k++)
                if (d < limit[k]) {
                    const double swap = limit[k];
                    limit[k] = d, d = swap;
                }
        }
        uint8_t group[FEATURE_POINTS];
        for (uint32_t i = 0; i < n; i++) group[i] = distance[i] <= limit[SEED_POINTS - 1];
        made += fit_plane(points, group, 1, &seeds[made]);
        for (uint32_t i = 0; i < n; i++)
            if (nearest[i] > nearest[seed]) seed = i;
    }
    return made;
}

/// The squared height, at most `maximum`.
static double truncated(double height, double maximum) {
    const double square = height * height;
    return square < maximum ? square : maximum;
}

static double pick(bool larger, double a, double b) { return larger == (a > b) ? a : b; }

static double height_of(const plane *p, const feature_points *points, uint32_t i) {
    return p->normal[0] * points->x[i] + p->normal[1] * points->y[i] + p->normal[2] * points->z[i] -
           p->offset;
}

/// Heights of all points over planes, in single precision for the search; zero behind the last point.
typedef float height_table[FEATURE_POINTS];

static void find_heights(const feature_points *points, const plane *planes, uint32_t count,
                         height_table *heights) {
    for (uint32_t p = 0; p < count; p++) {
        memset(heights[p], 0, sizeof heights[p]);
        for (uint32_t i = 0; i < points->count; i++) heights[p][i] = (float)height_of(&planes[p], points, i);
    }
}

static inline float pick_f32(bool larger, float a, float b) {
    return larger ? (a > b ? a : b) : (a < b ? a : b);
}

/// The truncated squares of outer(a, inner(b, c)). Sums LANES by LANES, which compilers turn into wide
/// instructions; the flags are constants where this is inlined.
static inline float sum_costs(const float *a, const float *b, const float *c, uint32_t count, bool outer_max,
                              bool inner_max, float maximum) {
    float sums[LANES] = {0}, sum = 0;
    for (uint32_t i = 0; i < count; i += LANES)
        for (uint32_t lane = 0; lane < LANES; lane++) {
            const float inner = pick_f32(inner_max, b[i + lane], c[i + lane]);
            const float height = pick_f32(outer_max, a[i + lane], inner), square = height * height;
            sums[lane] += square < maximum ? square : maximum;
        }
    for (uint32_t lane = 0; lane < LANES; lane++) sum += sums[lane];
    return sum;
}

static float cost_of(const float *a, const float *b, const float *c, uint32_t count, bool outer_max,
                     bool inner_max, float maximum) {
    if (outer_max)
        return inner_max ? sum_costs(a, b, c, count, true, true, maximum)
                         : sum_costs(a, b, c, count, true, false, maximum);
    return inner_max ? sum_costs(a, b, c, count, false, true, maximum)
                     : sum_costs(a, b, c, count, false, false, maximum);
}

static void set_plane(feature_model *model, uint32_t p, const plane *from) {
    memcpy(model->normal[p], from->normal, sizeof from->normal);
    model->offset[p] = from->offset;
}

static plane get_plane(const feature_model *model, uint32_t p) {
    const double *n = model->normal[p];
    return (plane){{n[0], n[1], n[2]}, model->offset[p]};
}

/// The truncated squares of a model, and which plane each point is on (UINT8_MAX: none).
static double assign(const feature_points *points, const feature_model *model, double maximum,
                     uint8_t *labels) {
    double cost = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        const double place[3] = {points->x[i], points->y[i], points->z[i]};
        const uint32_t active = ewa_feature_active(model, place);
        const double square = truncated(feature_height(model, active, place), maximum);
        labels[i] = square < maximum ? (uint8_t)active : UINT8_MAX;
        cost += square;
    }
    return cost;
}

/// Fits planes and assigns points in turns as long as that helps; returns the cost.
static double refine(const feature_points *points, double maximum, feature_model *model, uint8_t *labels) {
    double cost = assign(points, model, maximum, labels);
    for (int turn = 0; turn < REFINEMENTS; turn++) {
        feature_model next = *model;
        uint8_t next_labels[FEATURE_POINTS];
        for (uint32_t p = 0; p < model->plane_count; p++) {
            plane fitted;
            if (!fit_plane(points, labels, (uint8_t)p, &fitted)) return cost;
            set_plane(&next, p, &fitted);
        }
        const double next_cost = assign(points, &next, maximum, next_labels);
        if (!(next_cost < cost)) return cost;
        cost = next_cost;
        *model = next;
        memcpy(labels, next_labels, points->count);
    }
    return cost;
}

/// The edge of two hypotheses with the smallest cost; false when all of them are much the same plane.
static bool find_edge(const feature_points *points, const plane *seeds, const height_table *heights,
                      uint32_t seed_count, double cos_max, double maximum, feature_model *best) {
    float minimum = INFINITY;
    for (uint32_t a = 0; a < seed_count; a++) {
        for (uint32_t b = a + 1; b < seed_count; b++) {
            if (dot(seeds[a].normal, seeds[b].normal) > cos_max) continue;
            for (int larger = 0; larger < 2; larger++) {
                const float cost = cost_of(heights[a], heights[b], heights[b], points->count, larger, larger,
                                           (float)maximum);
                if (cost >= minimum) continue;
                minimum = cost;
                *best = (feature_model){.plane_count = 2, .outer_max = larger, .inner_max = larger};
                set_plane(best, 0, &seeds[a]);
                set_plane(best, 1, &seeds[b]);
            }
        }
    }
    return minimum < INFINITY;
}

/// The corner of an edge's planes and a hypothesis with the smallest cost.
static bool find_corner(const feature_points *points, const feature_model *edge, const plane *seeds,
                        const height_table *heights, uint32_t seed_count, double cos_max, double maximum,
                        feature_model *best) {
    const plane two[2] = {get_plane(edge, 0), get_plane(edge, 1)};
    height_table two_heights[2];
    float minimum = INFINITY;
    find_heights(points, two, 2, two_heights);
    for (uint32_t s = 0; s < seed_count; s++) {
        if (dot(seeds[s].normal, two[0].normal) > cos_max || dot(seeds[s].normal, two[1].normal) > cos_max)
            continue;
        const plane *planes[3] = {&two[0], &two[1], &seeds[s]};
        const float *h[3] = {two_heights[0], two_heights[1], heights[s]};
        for (int way = 0; way < 12; way++) {
            // Which plane is the outer one matters for mixed corners only.
            const int a = way % 3, b = (a + 1) % 3, c = (a + 2) % 3;
            const bool outer_max = way / 3 & 1, inner_max = way / 6;
            if (outer_max == inner_max && a != 0) continue;
            const float cost = cost_of(h[a], h[b], h[c], points->count, outer_max, inner_max, (float)maximum);
            if (cost >= minimum) continue;
            minimum = cost;
            *best = (feature_model){.plane_count = 3, .outer_max = outer_max, .inner_max = inner_max};
            set_plane(best, 0, planes[a]);
            set_plane(best, 1, planes[b]);
            set_plane(best, 2, planes[c]);
        }
    }
    return minimum < INFINITY;
}

/// Whether all planes differ enough from each other, and each has its share of the points.
static bool is_sharp(const feature_model *model, const uint8_t *labels, uint32_t count, double cos_threshold,
                     double share) {
    for (uint32_t p = 0; p < model->plane_count; p++) {
        uint32_t on = 0;
        for (uint32_t i = 0; i < count; i++) on += labels[i] == p;
        if (on < 4 || on < share * count) return false;
        for (uint32_t q = 0; q < p; q++) {
            const double cosine = dot(model->normal[p], model->normal[q]);
            // Two sides of a thin sheet meet nowhere near.
            if (cosine > cos_threshold || cosine < -0.966) return false;
        }
    }
    return true;
}

/// Solves the normal equations by Cholesky's method; false when they are singular.
static bool solve(double a[QUADRIC][QUADRIC], double b[QUADRIC]) {
    for (int i = 0; i < QUADRIC; i++) {
        const double before = a[i][i];
        for (int j = 0; j <= i; j++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++) sum -= a[i][k] * a[j][k];
            if (j < i)
                a[i][j] = sum / a[j][j];
            else if (!(sum > 1e-12 * before))
                return false;
            else
                a[i][i] = sqrt(sum);
        }
    }
    for (int i = 0; i < QUADRIC; i++) {
        for (int k = 0; k < i; k++) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (int i = QUADRIC - 1; i >= 0; i--) {
        for (int k = i + 1; k < QUADRIC; k++) b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
    return true;
}

/// Distances, to first order, from the height field of second degree over the plane of the points that fits
/// best; false when there is none.
static bool find_quadric_heights(const feature_points *points, double *heights) {
    double mean[3], axes[3][3], a[QUADRIC][QUADRIC] = {{0}}, b[QUADRIC] = {0};
    double u[FEATURE_POINTS], v[FEATURE_POINTS], w[FEATURE_POINTS];
    if (!find_axes(points, NULL, 0, mean, axes)) return false;
    double size2 = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        const double d[3] = {points->x[i] - mean[0], points->y[i] - mean[1], points->z[i] - mean[2]};
        u[i] = dot(d, axes[0]), v[i] = dot(d, axes[1]), w[i] = dot(d, axes[2]);
        size2 += u[i] * u[i] + v[i] * v[i];
    }
    if (!(size2 > 0)) return false;
    const double scale = sqrt(points->count / size2);
    for (uint32_t i = 0; i < points->count; i++) {
        const double s = u[i] * scale, t = v[i] * scale;
        const double row[QUADRIC] = {1, s, t, s * s, s * t, t * t};
        for (int p = 0; p < QUADRIC; p++) {
            b[p] += row[p] * w[i];
            for (int q = 0; q <= p; q++) a[p][q] += row[p] * row[q];
        }
    }
    if (!solve(a, b)) return false;
    for (uint32_t i = 0; i < points->count; i++) {
        const double s = u[i] * scale, t = v[i] * scale;
        const double height =
            w[i] - (b[0] + b[1] * s + b[2] * t + b[3] * s * s + b[4] * s * t + b[5] * t * t);
        const double ds = scale * (b[1] + 2 * b[3] * s + b[4] * t),
                     dt = scale * (b[2] + b[4] * s + 2 * b[5] * t);
        heights[i] = height / sqrt(1 + ds * ds + dt * dt);
    }
    return true;
}

uint32_t ewa_feature_active(const feature_model *model, const double place[3]) {
    const double first = feature_height(model, 0, place);
    uint32_t other = 1;
    double height = feature_height(model, 1, place);
    if (model->plane_count == 3) {
        const double last = feature_height(model, 2, place);
        if (pick(model->inner_max, height, last) == last) height = last, other = 2;
    }
    return pick(model->outer_max, first, height) == first ? 0 : other;
}

double ewa_feature_quadric_residual(const feature_points *points) {
    double heights[FEATURE_POINTS], sum = 0;
    if (points->count <= QUADRIC || !find_quadric_heights(points, heights)) return 0;
    for (uint32_t i = 0; i < points->count; i++) sum += heights[i] * heights[i];
    return sqrt(sum / (points->count - QUADRIC));
}

void ewa_feature_fit(const feature_points *points, const feature_scale *scale, feature_model *model) {
    model->plane_count = 0;
    plane seeds[SEEDS];
    height_table heights[SEEDS];
    double quadric[FEATURE_POINTS];
    if (points->count < 2 * SEED_POINTS || !find_quadric_heights(points, quadric)) return;
    const double deviation = fmax(scale->noise, NOISE_FLOOR * scale->spacing);
    const double maximum = TRUNCATION * TRUNCATION * deviation * deviation;
    // What no model can explain: keeps the ratio of two good ones from meaning anything.
    const double rest = points->count * (NOISE_FLOOR * NOISE_FLOOR) * scale->spacing * scale->spacing;
    double smooth = 0;
    for (uint32_t i = 0; i < points->count; i++) smooth += truncated(quadric[i], maximum);
    // What is left of a good fit.
    const double minimum = rest + GOOD_FIT * points->count * scale->noise * scale->noise;
    if (smooth + rest < EDGE_GAIN * minimum) return;
    smooth += rest;
    // Hypotheses are less certain than what is fitted to more points.
    const double cos_hypotheses = 1 - 0.5 * (1 - scale->cos_threshold);
    const uint32_t seed_count = make_seeds(points, seeds);
    find_heights(points, seeds, seed_count, heights);
    feature_model edge, corner;
    uint8_t edge_labels[FEATURE_POINTS], corner_labels[FEATURE_POINTS];
    if (!find_edge(points, seeds, heights, seed_count, cos_hypotheses, maximum, &edge)) return;
    const double edge_cost = rest + refine(points, maximum, &edge, edge_labels);
    const bool is_edge = edge_cost * EDGE_GAIN < smooth &&
                         is_sharp(&edge, edge_labels, points->count, scale->cos_threshold, EDGE_SHARE);
    if (is_edge) *model = edge;
    if (edge_cost < CORNER_GAIN * minimum) return;
    if (!find_corner(points, &edge, seeds, heights, seed_count, cos_hypotheses, maximum, &corner)) return;
    const double corner_cost = rest + refine(points, maximum, &corner, corner_labels);
    if (corner_cost * CORNER_GAIN < edge_cost && corner_cost * EDGE_GAIN < smooth &&
        is_sharp(&corner, corner_labels, points->count, scale->cos_threshold, CORNER_SHARE))
        *model = corner;
}

uint32_t ewa_feature_lines(const feature_model *model, uint32_t active, const double place[3], double reach,
                           feature_line lines[2], bool *either) {
    const double above = feature_height(model, active, place), *n = model->normal[active];
    uint32_t count = 0;
    *either = model->plane_count == 3 && active == 0 && model->outer_max != model->inner_max;
    for (uint32_t q = 0; q < model->plane_count; q++) {
        if (q == active) continue;
        const double *m = model->normal[q];
        const double cosine = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
        const double sine = sqrt(fmax(1 - cosine * cosine, 0));
        if (!(sine > 0)) continue;
        // Planes of the inner pair bound each other by its own operation.
        const bool larger = active && q ? model->inner_max : model->outer_max;
        const double sign = larger ? -1 : 1;
        feature_line line;
        for (int c = 0; c < 3; c++) line.across[c] = sign * (m[c] - cosine * n[c]) / sine;
        line.distance = sign * (feature_height(model, q, place) - cosine * above) / sine;
        if (fabs(line.distance) >= reach) {
            // A line that holds all over the disc is enough where either has to.
            if (*either && line.distance > 0) return 0;
            continue;
        }
        if (count && fabs(line.distance) < fabs(lines[0].distance)) {
            lines[1] = lines[0];
            lines[0] = line;
        } else {
            lines[count] = line;
        }
        count++;
    }
    return count;
}
