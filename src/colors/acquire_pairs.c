// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What two kernels have to do with each other: who interacts with whom, inner products in closed form, and
// the texture under a product (docs/math.md section 10).
//
// The product of two Gaussians is a Gaussian. On a curved surface kernels get a thickness, the same for all:
// inner products of Gaussians in space always make a positive definite matrix, in a plane they are those of
// the plane, and sheets that lie above each other come apart. So they do by a factor ((1 + cos) / 2)^4 of the
// angle between the normals, which is a positive definite matrix too, as is the product by entries of both
// (Schur). The texture is looked up in the plane between the two.
//
// Inner products are those of whole kernels, also at edges: kernels cut by different lines would not keep the
// matrix definite. The texture is looked up under what is cut, as the Gaussian of the same mean and
// covariance, so that nothing beyond the edge of a chart comes in.
// Based on M. Zwicker, H. Pfister, J. van Baar, M. Gross, "Surface Splatting", 2001, appendix A; the moments
// of what is cut after N. L. Johnson, S. Kotz, "Continuous Univariate Distributions 1", 1970, chapter 13.
#include "base/base.h"
#include "colors/acquire.h"
#include "homogeneous/frame.h"
#include "math/gaussian.h"

/// Smallest cosine between the normals of kernels that interact.
#define MIN_FACING (-0.5)

/// Centres this far behind a clip line, in standard deviations, are still on its side.
#define BEHIND 0.05

/// Kernels this many times as large as is usual reach no farther.
#define MAX_SIZE 8

/// Less than this share of a kernel is never left by its clip lines.
#define MIN_SHARE 1e-3

/// Two charts are one piece of a picture when each tells where the other's centre is, up to this share of the
/// distance.
#define SAME_CHART 0.3

static ewa_vec3 load(const float v[3]) { return vec3_make((double)v[0], (double)v[1], (double)v[2]); }

static double major_sigma(const ewa_acquire_point *point) {
    const ewa_vec3 u = load(point->axis[0]), v = load(point->axis[1]);
    return sqrt(fmax(vec3_dot(u, u), vec3_dot(v, v)));
}

/// Covariance of a kernel, projected into a plane: xx, xy, yy.
static void project(const ewa_acquire_point *point, const ewa_vec3 axis[2], double covariance[3]) {
    covariance[0] = covariance[1] = covariance[2] = 0;
    for (int k = 0; k < 2; k++) {
        const ewa_vec3 t = load(point->axis[k]);
        const double x = vec3_dot(t, axis[0]), y = vec3_dot(t, axis[1]);
        covariance[0] += x * x;
        covariance[1] += x * y;
        covariance[2] += y * y;
    }
}

/// Cuts a Gaussian in a plane by the half spaces of a point, whose centre is at `from`: sets its moments,
/// returns the share that is left.
static double cut(const ewa_acquire_point *point, const ewa_vec3 axis[2], const double from[2],
                  double mean[2], double covariance[3]) {
    double left = 1;
    for (uint32_t i = 0; i < point->side_count; i++) {
        const ewa_vec3 g = load(point->side[i]);
        const double a = vec3_dot(g, axis[0]), b = vec3_dot(g, axis[1]);
        const double ca = covariance[0] * a + covariance[1] * b, cb = covariance[1] * a + covariance[2] * b;
        const double sigma = sqrt(a * ca + b * cb);
        if (!(sigma > 0)) continue;
        const double z =
            (a * (mean[0] - from[0]) + b * (mean[1] - from[1]) + (double)point->side[i][3]) / sigma;
        const double share = fmax(ewa_normal_below(z), MIN_SHARE);
        const double hazard = ewa_normal_density(z) / share;
        const double narrower = fmin(fmax(hazard * (hazard + z), 0), 0.99) / (sigma * sigma);
        mean[0] += ca / sigma * hazard;
        mean[1] += cb / sigma * hazard;
        covariance[0] -= ca * ca * narrower;
        covariance[1] -= ca * cb * narrower;
        covariance[2] -= cb * cb * narrower;
        left *= share;
    }
    return fmax(left, MIN_SHARE);
}

/// Integral of the product of two kernels with a thickness, over that of the thickness alone.
static double integrate(const ewa_acquire_point *a, const ewa_acquire_point *b, double thickness_world) {
    const ewa_vec3 na = load(a->normal), nb = load(b->normal);
    const ewa_vec3 ua = load(a->axis[0]), va = load(a->axis[1]), ub = load(b->axis[0]), vb = load(b->axis[1]);
    const ewa_vec3 d = vec3_sub(vec3_load(b->place), vec3_load(a->place));
    const double t = thickness_world;
    const ewa_vec3 spread[6] = {ua, va, vec3_scale(na, t), ub, vb, vec3_scale(nb, t)};
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    for (int k = 0; k < 6; k++) {
        const ewa_vec3 s = spread[k];
        xx += s.x * s.x, xy += s.x * s.y, xz += s.x * s.z;
        yy += s.y * s.y, yz += s.y * s.z, zz += s.z * s.z;
    }
    const double axx = yy * zz - yz * yz, axy = xz * yz - xy * zz, axz = xy * yz - xz * yy,
                 ayy = xx * zz - xz * xz, ayz = xy * xz - xx * yz, azz = xx * yy - xy * xy;
    const double determinant = xx * axx + xy * axy + xz * axz;
    const double square = (d.x * d.x * axx + d.y * d.y * ayy + d.z * d.z * azz +
                           2 * (d.x * d.y * axy + d.x * d.z * axz + d.y * d.z * ayz)) /
                          determinant;
    const double volumes = fabs(vec3_dot(vec3_cross(ua, va), na)) * fabs(vec3_dot(vec3_cross(ub, vb), nb));
    const double facing = 0.5 + 0.5 * vec3_dot(na, nb), facing2 = facing * facing;
    // (2 pi)^3/2 in space, over sqrt(pi) t of two equal thicknesses.
    return 8.885765876316732 * t * volumes / sqrt(determinant) * ewa_exp(-0.5 * fmin(square, 1200)) *
           facing2 * facing2;
}

void ewa_acquire_single(const ewa_acquire_point *point, ewa_acquire_pair *pair) {
    double covariance[3];
    const double origin[2] = {0, 0};
    *pair = (ewa_acquire_pair){0};
    ewa_frame_of(load(point->normal), pair->axis);
    project(point, pair->axis, covariance);
    const double determinant = fmax(covariance[0] * covariance[2] - covariance[1] * covariance[1], 0);
    cut(point, pair->axis, origin, pair->mean, covariance);
    pair->integral = 6.283185307179586 * sqrt(determinant);
    pair->xx = covariance[0], pair->xy = covariance[1], pair->yy = covariance[2];
}

void ewa_acquire_multiply(const ewa_acquire_set *set, const ewa_acquire_point *a, const ewa_acquire_point *b,
                          ewa_acquire_pair *pair) {
    ewa_vec3 normal = vec3_add(load(a->normal), load(b->normal));
    vec3_normalize(&normal);
    ewa_frame_of(normal, pair->axis);
    const ewa_vec3 between = vec3_sub(vec3_load(b->place), vec3_load(a->place));
    const double d[2] = {vec3_dot(between, pair->axis[0]), vec3_dot(between, pair->axis[1])};
    double p[3], q[3];
    project(a, pair->axis, p);
    project(b, pair->axis, q);
    const double xx = p[0] + q[0], xy = p[1] + q[1], yy = p[2] + q[2], sum = xx * yy - xy * xy;
    const double of_p = p[0] * p[2] - p[1] * p[1], of_q = q[0] * q[2] - q[1] * q[1];
    // (P + Q)^-1 d, then P times that: where the product has its mean.
    const double w[2] = {(yy * d[0] - xy * d[1]) / sum, (xx * d[1] - xy * d[0]) / sum};
    pair->between[0] = d[0], pair->between[1] = d[1];
    pair->exponent = 0.5 * (d[0] * w[0] + d[1] * w[1]);
    pair->mean[0] = p[0] * w[0] + p[1] * w[1];
    pair->mean[1] = p[1] * w[0] + p[2] * w[1];
    // P (P + Q)^-1 Q = (|Q| P + |P| Q) / |P + Q|.
    double covariance[3];
    for (int c = 0; c < 3; c++) covariance[c] = (of_q * p[c] + of_p * q[c]) / sum;
    // Kernels cut by one and the same line are cut once; of a kernel that no line reaches, nothing is off.
    const double origin[2] = {0, 0};
    double by_a[2] = {pair->mean[0], pair->mean[1]}, by_b[2] = {pair->mean[0], pair->mean[1]};
    double of_a[3] = {covariance[0], covariance[1], covariance[2]},
           of_b[3] = {covariance[0], covariance[1], covariance[2]};
    const double share_a = cut(a, pair->axis, origin, by_a, of_a),
                 share_b = cut(b, pair->axis, d, by_b, of_b);
    const double *mean = share_a <= share_b ? by_a : by_b, *moments = share_a <= share_b ? of_a : of_b;
    pair->integral = integrate(a, b, set->usual_sigma_world);
    pair->mean[0] = mean[0], pair->mean[1] = mean[1];
    pair->xx = moments[0], pair->xy = moments[1], pair->yy = moments[2];
}

static void jacobian(const ewa_acquire_point *point, const ewa_vec3 axis[2], double j[2][2]) {
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 2; c++) j[k][c] = vec3_dot(load(point->gradient[k]), axis[c]);
}

/// Where the middle between two points is on the picture, if both are on one piece of it: the parabola
/// through both with both slopes. Else false.
static bool find_middle(const ewa_acquire_set *set, const ewa_acquire_point *point,
                        const ewa_acquire_point *other, double j[2][2], double o[2][2], const double d[2],
                        double middle[2]) {
    if (point->texture != other->texture || point->texture == EWA_ACQUIRE_NO_TEXTURE) return false;
    const ewa_texture *texture = &set->textures[point->texture];
    double gap2 = 0, step2 = 0;
    for (int k = 0; k < 2; k++) {
        const double size = k ? texture->levels[0].height_px : texture->levels[0].width_px;
        const double step = 0.5 * ((j[k][0] + o[k][0]) * d[0] + (j[k][1] + o[k][1]) * d[1]);
        double gap = other->at_px[k] - point->at_px[k] - step;
        if (texture->repeats[k]) gap -= size * floor(gap / size + 0.5);
        const double turn = (j[k][0] - o[k][0]) * d[0] + (j[k][1] - o[k][1]) * d[1];
        middle[k] = point->at_px[k] + 0.5 * (step + gap) + 0.125 * turn;
        gap2 += gap * gap;
        step2 += step * step;
    }
    return gap2 <= SAME_CHART * SAME_CHART * step2 + 1e-6;
}

/// Where a plane is on the picture: a place on both, and the Jacobian, rows x and y of the picture.
typedef struct plane_chart {
    double plane[2], at_px[2], j[2][2];
} plane_chart;

/// Mean of the point's texture under the Gaussian of a pair, times a tint.
static void look(const ewa_acquire_set *set, const ewa_acquire_point *point, const plane_chart *chart,
                 const ewa_acquire_pair *pair, double color[4]) {
    for (int c = 0; c < 4; c++) color[c] = (double)point->tint[c];
    if (point->texture == EWA_ACQUIRE_NO_TEXTURE) return;
    const double d[2] = {pair->mean[0] - chart->plane[0], pair->mean[1] - chart->plane[1]};
    const double(*j)[2] = chart->j;
    const ewa_texture *texture = &set->textures[point->texture];
    double mean[4];
    if (j[0][0] == 0 && j[0][1] == 0 && j[1][0] == 0 && j[1][1] == 0) {
        // All of a triangle on one place: the picture is a palette, whose pixels are no neighbours.
        ewa_texture_nearest(texture, chart->at_px[0], chart->at_px[1], mean);
        for (int c = 0; c < 4; c++) color[c] *= mean[c];
        return;
    }
    // J C J'.
    const double ax = j[0][0] * pair->xx + j[0][1] * pair->xy, ay = j[0][0] * pair->xy + j[0][1] * pair->yy;
    const double bx = j[1][0] * pair->xx + j[1][1] * pair->xy, by = j[1][0] * pair->xy + j[1][1] * pair->yy;
    ewa_texture_gauss gauss = {
        .x_px = chart->at_px[0] + j[0][0] * d[0] + j[0][1] * d[1],
        .y_px = chart->at_px[1] + j[1][0] * d[0] + j[1][1] * d[1],
        .xx_px2 = ax * j[0][0] + ay * j[0][1] + set->pixel_variance_px2,
        .xy_px2 = ax * j[1][0] + ay * j[1][1],
        .yy_px2 = bx * j[1][0] + by * j[1][1] + set->pixel_variance_px2,
    };
    ewa_texture_round(&gauss);
    ewa_texture_mean(texture, ewa_texture_level_of(texture, &gauss), &gauss, mean);
    for (int c = 0; c < 4; c++) color[c] *= mean[c];
}

void ewa_acquire_look(const ewa_acquire_set *set, const ewa_acquire_point *point,
                      const ewa_acquire_pair *alone, double color[4]) {
    plane_chart chart = {.at_px = {point->at_px[0], point->at_px[1]}};
    jacobian(point, alone->axis, chart.j);
    look(set, point, &chart, alone, color);
}

double ewa_acquire_look_between(const ewa_acquire_set *set, const ewa_acquire_point *a,
                                const ewa_acquire_point *b, const ewa_acquire_pair *pair, double color[4]) {
    plane_chart of_a = {.at_px = {a->at_px[0], a->at_px[1]}},
                of_b = {.plane = {pair->between[0], pair->between[1]}, .at_px = {b->at_px[0], b->at_px[1]}},
                middle;
    double other[4];
    jacobian(a, pair->axis, of_a.j);
    jacobian(b, pair->axis, of_b.j);
    if (find_middle(set, a, b, of_a.j, of_b.j, pair->between, middle.at_px)) {
        for (int k = 0; k < 2; k++) {
            middle.plane[k] = 0.5 * pair->between[k];
            for (int c = 0; c < 2; c++) middle.j[k][c] = 0.5 * (of_a.j[k][c] + of_b.j[k][c]);
        }
        ewa_acquire_point both = *a;
        for (int c = 0; c < 4; c++) both.tint[c] = 0.5f * (a->tint[c] + b->tint[c]);
        look(set, &both, &middle, pair, color);
        return 0;
    }
    look(set, a, &of_a, pair, color);
    look(set, b, &of_b, pair, other);
    double maximum = 0;
    for (int c = 0; c < 4; c++) {
        maximum = fmax(maximum, fabs(color[c] - other[c]));
        color[c] = 0.5 * (color[c] + other[c]);
    }
    return maximum;
}

static bool is_surfel(const ewa_acquire_point *point) {
    return vec3_dot(load(point->axis[0]), load(point->axis[0])) > 0;
}

static bool is_behind(const ewa_acquire_point *point, ewa_vec3 to_other, double sigma) {
    for (uint32_t i = 0; i < point->side_count; i++)
        if (vec3_dot(load(point->side[i]), to_other) + (double)point->side[i][3] < -BEHIND * sigma)
            return true;
    return false;
}

/// Whether two different kernels interact; mutual.
static bool interact(const ewa_acquire_grid *grid, const ewa_acquire_point *a, double sigma_a,
                     const ewa_acquire_point *b) {
    const ewa_vec3 between = vec3_sub(vec3_load(b->place), vec3_load(a->place));
    const double distance2 = vec3_dot(between, between), sigma_b = major_sigma(b);
    const double cutoff = grid->set->cutoff;
    if (!(distance2 <= grid->cell_world * grid->cell_world) ||
        !(distance2 <= 2 * cutoff * cutoff * (sigma_a * sigma_a + sigma_b * sigma_b)))
        return false;
    if (vec3_dot(load(a->normal), load(b->normal)) < MIN_FACING) return false;
    if (a->part != b->part) return false;
    if (grid->set->has_parts) return true;
    return !is_behind(a, between, sigma_a) && !is_behind(b, vec3_scale(between, -1), sigma_b);
}

static void cell_of(const ewa_acquire_grid *grid, const double place[3], int64_t cell[3]) {
    for (int c = 0; c < 3; c++) cell[c] = (int64_t)floor((place[c] - grid->low[c]) / grid->cell_world);
}

static size_t bucket_of(const ewa_acquire_grid *grid, const int64_t cell[3]) {
    uint64_t hash = 0;
    for (int c = 0; c < 3; c++) {
        hash = (hash ^ (uint64_t)cell[c]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash & (grid->bucket_count - 1);
}

ewa_status ewa_acquire_grid_make(const ewa_acquire_set *set, ewa_acquire_grid *grid) {
    *grid = (ewa_acquire_grid){.set = set, .bucket_count = 64};
    double maximum = 0;
    bool any = false;
    for (uint32_t i = 0; i < set->count; i++) {
        if (!is_surfel(&set->points[i])) continue;
        maximum = fmax(maximum, major_sigma(&set->points[i]));
        for (int c = 0; c < 3; c++)
            grid->low[c] = any ? fmin(grid->low[c], set->points[i].place[c]) : set->points[i].place[c];
        any = true;
    }
    grid->cell_world = 2 * set->cutoff * fmin(maximum, MAX_SIZE * set->usual_sigma_world);
    if (!(grid->cell_world > 0)) grid->cell_world = 1;
    while (grid->bucket_count < set->count) grid->bucket_count *= 2;
    grid->first = ewa_allocate_zeroed(set->context, grid->bucket_count + 2, sizeof *grid->first);
    grid->entry = ewa_allocate(set->context, set->count, sizeof *grid->entry);
    if (!grid->first || !grid->entry) {
        ewa_acquire_grid_free(grid);
        return EWA_ERROR_MEMORY;
    }
    int64_t cell[3];
    for (uint32_t i = 0; i < set->count; i++) {
        if (!is_surfel(&set->points[i])) continue;
        cell_of(grid, set->points[i].place, cell);
        grid->first[bucket_of(grid, cell) + 2]++;
    }
    for (size_t b = 0; b < grid->bucket_count; b++) grid->first[b + 2] += grid->first[b + 1];
    for (uint32_t i = 0; i < set->count; i++) {
        if (!is_surfel(&set->points[i])) continue;
        cell_of(grid, set->points[i].place, cell);
        grid->entry[grid->first[bucket_of(grid, cell) + 1]++] = i;
    }
    return EWA_OK;
}

void ewa_acquire_grid_free(ewa_acquire_grid *grid) {
    if (!grid->set) return;
    ewa_release(grid->set->context, grid->first, grid->bucket_count + 2, sizeof *grid->first);
    ewa_release(grid->set->context, grid->entry, grid->set->count, sizeof *grid->entry);
    *grid = (ewa_acquire_grid){0};
}

/// Puts a number into its place among `count` ascending ones.
static void insert(uint32_t *numbers, uint32_t count, uint32_t number) {
    while (count > 0 && numbers[count - 1] > number) {
        numbers[count] = numbers[count - 1];
        count--;
    }
    numbers[count] = number;
}

uint32_t ewa_acquire_find(const ewa_acquire_grid *grid, uint32_t index, uint32_t *others) {
    const ewa_acquire_point *point = &grid->set->points[index];
    if (others) others[0] = index;
    if (!is_surfel(point)) return 1;
    const double sigma = major_sigma(point);
    uint32_t count = 1;
    int64_t middle[3], cell[3], at[3];
    cell_of(grid, point->place, middle);
    for (int n = 0; n < 27; n++) {
        for (int c = 0; c < 3; c++) cell[c] = middle[c] + (c == 0 ? n % 3 : c == 1 ? n / 3 % 3 : n / 9) - 1;
        const size_t bucket = bucket_of(grid, cell);
        for (uint32_t i = grid->first[bucket]; i < grid->first[bucket + 1]; i++) {
            const uint32_t other = grid->entry[i];
            if (other == index || !interact(grid, point, sigma, &grid->set->points[other])) continue;
            cell_of(grid, grid->set->points[other].place, at); // other cells share the bucket
            if (at[0] != cell[0] || at[1] != cell[1] || at[2] != cell[2]) continue;
            if (count == EWA_ACQUIRE_MAX_PAIRS) return EWA_ACQUIRE_MAX_PAIRS + 1;
            if (others) insert(others, count, other);
            count++;
        }
    }
    return count;
}
