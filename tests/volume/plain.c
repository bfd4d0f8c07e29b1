// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of volumes by the words of ewa/volume_render.h alone.
#include "volume/plain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAXIMUM = 4096 };

static const double PI = 3.14159265358979323846;

typedef struct vector {
    double v[3];
} vector;

typedef struct matrix {
    double m[3][3]; // acts on columns
} matrix;

static double dot(vector a, vector b) { return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2]; }

static vector sum(vector a, vector b, double times) {
    return (vector){{a.v[0] + times * b.v[0], a.v[1] + times * b.v[1], a.v[2] + times * b.v[2]}};
}

static vector scaled(vector a, double by) { return sum((vector){{0, 0, 0}}, a, by); }

static vector unit(vector a) {
    const double length = sqrt(dot(a, a));
    return length > 0 ? scaled(a, 1 / length) : a;
}

static vector times(const matrix *m, vector a) {
    vector out;
    for (int r = 0; r < 3; r++) out.v[r] = dot((vector){{m->m[r][0], m->m[r][1], m->m[r][2]}}, a);
    return out;
}

static matrix product(const matrix *a, const matrix *b) {
    matrix out;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            out.m[r][c] = a->m[r][0] * b->m[0][c] + a->m[r][1] * b->m[1][c] + a->m[r][2] * b->m[2][c];
    return out;
}

static matrix transposed(const matrix *a) {
    matrix out;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) out.m[r][c] = a->m[c][r];
    return out;
}

static matrix inverse(const matrix *a) {
    matrix out;
    double determinant = 0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
            out.m[r][c] = a->m[r1][c1] * a->m[r2][c2] - a->m[r1][c2] * a->m[r2][c1];
        }
    for (int c = 0; c < 3; c++) determinant += a->m[0][c] * out.m[c][0];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) out.m[r][c] /= determinant;
    return out;
}

/// A voxel: what it looks like and where it is in camera space.
typedef struct voxel {
    double color[3], extinction, slice, distance;
    vector place;
    int number;
} voxel;

typedef struct scene {
    const ewa_volume *volume;
    const ewa_transfer *transfer;
    const ewa_camera *camera;
    const ewa_volume_options *options;
    matrix steps;           ///< from the index to camera space, without its place
    matrix covariance;      ///< of the kernels in camera space
    matrix covariance_less; ///< its inverse
    vector first;           ///< voxel 0, 0, 0 in camera space
    double camera_scale;    ///< camera units per world unit
    double step_world;      ///< the shortest
    voxel voxels[MAXIMUM];
    int count;
} scene;

static double value_at(const ewa_volume *volume, int i, int j, int k) {
    const int x = (int)volume->dims[0], y = (int)volume->dims[1], z = (int)volume->dims[2];
    if (i < 0 || j < 0 || k < 0 || i >= x || j >= y || k >= z) return NAN;
    const double value = (double)((const float *)volume->voxels)[(k * y + j) * x + i];
    return isfinite(value) ? value : NAN;
}

/// Differences along one axis, central or to the one side that there is, averaged over nine lines.
static double slope_at(const ewa_volume *volume, int i, int j, int k, int axis) {
    double total = 0, weights = 0;
    for (int b = -1; b <= 1; b++)
        for (int c = -1; c <= 1; c++) {
            int at[3] = {i, j, k};
            at[(axis + 1) % 3] += b;
            at[(axis + 2) % 3] += c;
            double line[3];
            for (int n = 0; n < 3; n++) {
                int here[3] = {at[0], at[1], at[2]};
                here[axis] += n - 1;
                line[n] = value_at(volume, here[0], here[1], here[2]);
            }
            double slope = 0.5 * (line[2] - line[0]);
            if (isnan(slope)) slope = isnan(line[2]) ? line[1] - line[0] : line[2] - line[1];
            if (isnan(slope)) continue;
            const double weight = (b ? 1 : 2) * (c ? 1 : 2);
            total += weight * slope;
            weights += weight;
        }
    return weights > 0 ? total / weights : 0;
}

/// Colour and extinction per world unit of a value; false when nothing is there.
static bool look_up(const scene *s, double value, double color[3], double *extinction) {
    const ewa_transfer *t = s->transfer;
    if (isnan(value) || value < t->points[0].value || value > t->points[t->point_count - 1].value)
        return false;
    uint32_t n = 0;
    while (n + 2 < t->point_count && t->points[n + 1].value <= value) n++;
    const ewa_transfer_point *a = &t->points[n], *b = a + 1;
    const double share = (value - a->value) / (b->value - a->value);
    for (int c = 0; c < 3; c++) color[c] = (1 - share) * (double)a->color[c] + share * (double)b->color[c];
    *extinction = (1 - share) * (double)a->extinction + share * (double)b->extinction;
    *extinction /= t->unit_length_world > 0 ? t->unit_length_world : s->step_world;
    return *extinction > 0;
}

/// The depth unit of a depth, counted from that of voxel 0, 0, 0.
static double slice_of(const scene *s, double z) {
    const double slice = s->options->depth_unit * s->step_world * s->camera_scale;
    return floor((z - s->first.v[2]) / slice + 0.5);
}

/// Blinn and Phong's answer, from both sides; light from everywhere where there is no gradient.
static void shade(const scene *s, vector normal_world, vector place, double color[3]) {
    const ewa_volume_options *o = s->options;
    if (o->shading == EWA_SHADING_NONE) return;
    const ewa_material *m = &o->material;
    if (dot(normal_world, normal_world) == 0) {
        for (int c = 0; c < 3; c++) color[c] *= (double)m->ambient + (double)m->diffuse;
        return;
    }
    const double *w = s->camera->world_to_camera;
    const vector back = s->camera->projection == EWA_ORTHOGRAPHIC ? (vector){{0, 0, -1}} : scaled(place, -1);
    vector eye = {{0, 0, 0}};
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) eye.v[c] += w[4 * r + c] * back.v[r];
    eye = unit(eye);
    if (dot(normal_world, eye) < 0) normal_world = scaled(normal_world, -1);
    double out[3];
    for (int c = 0; c < 3; c++) out[c] = color[c] * (double)m->ambient;
    for (uint32_t i = 0; i < (o->light_count ? o->light_count : 1); i++) {
        const ewa_light *light = &o->lights[i];
        const double *d = light->direction_world;
        vector toward = {{d[0], d[1], d[2]}};
        const bool headlight = !o->light_count || dot(toward, toward) == 0;
        toward = headlight ? eye : unit(toward);
        const double facing = dot(normal_world, toward);
        if (facing <= 0) continue;
        const double half = fmax(dot(normal_world, unit(sum(toward, eye, 1))), 0);
        const double shine =
            o->shading == EWA_SHADING_PHONG ? (double)m->specular * pow(half, (double)m->shininess) : 0;
        for (int c = 0; c < 3; c++)
            out[c] += (o->light_count ? (double)light->color[c] : 1) *
                      (color[c] * (double)m->diffuse * facing + shine);
    }
    memcpy(color, out, sizeof out);
}

static void add_voxel(scene *s, int i, int j, int k, const matrix *to_index) {
    voxel made = {.number = s->count};
    const double value = value_at(s->volume, i, j, k);
    if (!look_up(s, value, made.color, &made.extinction)) return;
    // The slopes are along the index; a differential goes to the world by the transposed inverse.
    vector slopes;
    for (int axis = 0; axis < 3; axis++) slopes.v[axis] = slope_at(s->volume, i, j, k, axis);
    const matrix turned = transposed(to_index);
    const vector gradient = times(&turned, slopes);
    const double length = sqrt(dot(gradient, gradient)), low = s->transfer->gradient_low,
                 high = s->transfer->gradient_high;
    if (low != 0 || high != 0) made.extinction *= fmin(fmax((length - low) / (high - low), 0), 1);
    if (!(made.extinction > 0)) return;
    made.place = sum(s->first, times(&s->steps, (vector){{i, j, k}}), 1);
    shade(s, unit(scaled(gradient, -1)), made.place, made.color);
    made.extinction *= s->options->density_scale / s->camera_scale; // per camera unit
    made.slice = slice_of(s, made.place.v[2]);
    made.distance = sqrt(dot(made.place, made.place));
    if (s->camera->projection == EWA_ORTHOGRAPHIC) {
        // But for its fourth order, the distance from an eye that sees the picture under 40 degrees.
        const double x = made.place.v[0], y = made.place.v[1];
        const double away = s->camera->height_px / s->camera->fy_px / (2 * tan(PI / 9));
        made.distance = made.place.v[2] + (x * x + y * y) / (2 * away);
    }
    s->voxels[s->count++] = made;
}

static int by_depth(const void *a, const void *b) {
    const voxel *left = a, *right = b;
    if (left->slice != right->slice) return left->slice < right->slice ? -1 : 1;
    if (left->distance != right->distance) return left->distance < right->distance ? -1 : 1;
    return left->number - right->number;
}

/// What of a normal distribution lies beyond -t.
static double share_ahead(double t) { return 0.5 * erfc(-t / sqrt(2)); }

/// The optical depth of a voxel along the ray of a place in the picture; 0 beyond the cutoff.
static double ray_depth(const scene *s, const voxel *at, double x_px, double y_px) {
    const ewa_camera *camera = s->camera;
    const ewa_volume_options *o = s->options;
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const bool flat = camera->projection == EWA_ORTHOGRAPHIC;
    const vector from = flat ? (vector){{x, y, 0}} : (vector){{0, 0, 0}};
    const vector along = unit(flat ? (vector){{0, 0, 1}} : (vector){{x, y, 1}});
    const vector to = sum(at->place, from, -1);
    const double a = dot(along, times(&s->covariance_less, along));
    const double b = dot(along, times(&s->covariance_less, to)), c = dot(to, times(&s->covariance_less, to));
    const double distance2 = c - b * b / a, ahead = flat ? INFINITY : b / sqrt(a);
    if (distance2 >= o->cutoff * o->cutoff || ahead <= -o->cutoff) return 0;
    // The kernel's integral is extinction times cell.
    const double s3 = o->sigma * o->sigma * o->sigma, whole = 1 / (1 - exp(-o->cutoff * o->cutoff / 2));
    return whole * at->extinction / (2 * PI * s3 * sqrt(a)) * exp(-distance2 / 2) * share_ahead(ahead);
}

/// The ellipse of a voxel: centre, and covariance in px^2. Perspective: of the cone of rays that touch F
/// standard deviations, p' S x x' S p - (p' S p - F^2) x' S x = 0 with S the inverse covariance.
static void ellipse_of(const scene *s, const voxel *at, double center[2], double v[3]) {
    const ewa_camera *camera = s->camera;
    const double f2 = s->options->cutoff * s->options->cutoff;
    if (camera->projection == EWA_ORTHOGRAPHIC) {
        center[0] = camera->fx_px * at->place.v[0] + camera->cx_px;
        center[1] = camera->fy_px * at->place.v[1] + camera->cy_px;
        v[0] = s->covariance.m[0][0] * camera->fx_px * camera->fx_px;
        v[1] = s->covariance.m[0][1] * camera->fx_px * camera->fy_px;
        v[2] = s->covariance.m[1][1] * camera->fy_px * camera->fy_px;
        return;
    }
    const vector q = times(&s->covariance_less, at->place);
    const double c = dot(at->place, q) - f2;
    double m[3][3];
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) m[r][k] = c * s->covariance_less.m[r][k] - q.v[r] * q.v[k];
    // (x - x0)' A (x - x0) = e over the plane z = 1: the covariance is e / F^2 A^-1.
    const double determinant = m[0][0] * m[1][1] - m[0][1] * m[0][1];
    const double x0 = (m[0][1] * m[1][2] - m[1][1] * m[0][2]) / determinant;
    const double y0 = (m[0][1] * m[0][2] - m[0][0] * m[1][2]) / determinant;
    const double e = -(m[2][2] + m[0][2] * x0 + m[1][2] * y0) / f2;
    center[0] = camera->fx_px * x0 + camera->cx_px;
    center[1] = camera->fy_px * y0 + camera->cy_px;
    v[0] = e * m[1][1] / determinant * camera->fx_px * camera->fx_px;
    v[1] = -e * m[0][1] / determinant * camera->fx_px * camera->fy_px;
    v[2] = e * m[0][0] / determinant * camera->fy_px * camera->fy_px;
}

/// The same filtered by the pixel: a pixel's place in the wider ellipse is one in the true one, and what is
/// spread is thinner.
static double filtered_depth(const scene *s, const voxel *at, double x_px, double y_px) {
    const double h2 = s->options->prefilter_px * s->options->prefilter_px;
    // A kernel that reaches the eye has no ellipse, and covers very many pixels: depth units near by are
    // whole.
    const double end = sqrt((s->options->cutoff * s->options->cutoff + 9) * s->covariance.m[2][2]);
    const bool near = s->camera->projection == EWA_PERSPECTIVE && at->slice <= slice_of(s, end);
    if (h2 == 0 || near) return ray_depth(s, at, x_px, y_px);
    double center[2], v[3];
    ellipse_of(s, at, center, v);
    const double w[3] = {v[0] + h2, v[1], v[2] + h2};
    // Lower triangles l l' = v and m m' = w: the place is l m^-1 of what it was.
    const double l0 = sqrt(v[0]), l1 = v[1] / l0, l2 = sqrt(v[2] - l1 * l1);
    const double m0 = sqrt(w[0]), m1 = w[1] / m0, m2 = sqrt(w[2] - m1 * m1);
    const double u0 = (x_px - center[0]) / m0, u1 = (y_px - center[1] - m1 * u0) / m2;
    if (u0 * u0 + u1 * u1 >= s->options->cutoff * s->options->cutoff) return 0;
    const double thinner = l0 * l2 / (m0 * m2);
    return thinner * ray_depth(s, at, center[0] + l0 * u0, center[1] + l1 * u0 + l2 * u1);
}

static void make_scene(scene *s) {
    const double *g = s->volume->index_to_world, *w = s->camera->world_to_camera;
    matrix to_world, to_camera;
    vector start, shift;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) to_world.m[r][c] = g[4 * r + c], to_camera.m[r][c] = w[4 * r + c];
        start.v[r] = g[4 * r + 3];
        shift.v[r] = w[4 * r + 3];
    }
    s->steps = product(&to_camera, &to_world);
    s->first = sum(times(&to_camera, start), shift, 1);
    const matrix across = transposed(&s->steps);
    s->covariance = product(&s->steps, &across);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) s->covariance.m[r][c] *= s->options->sigma * s->options->sigma;
    s->covariance_less = inverse(&s->covariance);
    s->camera_scale = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    s->step_world = INFINITY;
    for (int c = 0; c < 3; c++)
        s->step_world = fmin(s->step_world, sqrt(g[c] * g[c] + g[4 + c] * g[4 + c] + g[8 + c] * g[8 + c]));
    const matrix to_index = inverse(&to_world);
    for (int k = 0; k < (int)s->volume->dims[2]; k++)
        for (int j = 0; j < (int)s->volume->dims[1]; j++)
            for (int i = 0; i < (int)s->volume->dims[0]; i++) add_voxel(s, i, j, k, &to_index);
    qsort(s->voxels, (size_t)s->count, sizeof s->voxels[0], by_depth);
}

void plain_draw(const ewa_volume *volume, const ewa_transfer *transfer, const ewa_camera *camera,
                const ewa_volume_options *options, double *rgba, double *depth) {
    scene *s = calloc(1, sizeof *s);
    if (!s) abort();
    s->volume = volume, s->transfer = transfer, s->camera = camera, s->options = options;
    make_scene(s);
    for (uint32_t y = 0; y < camera->height_px; y++)
        for (uint32_t x = 0; x < camera->width_px; x++) {
            const size_t pixel = (size_t)y * camera->width_px + x;
            double through = 1, light[3] = {0, 0, 0}, half = INFINITY;
            for (int n = 0; n < s->count; n++) {
                const voxel *at = &s->voxels[n];
                const double t = filtered_depth(s, at, x + 0.5, y + 0.5), left = through * exp(-t);
                for (int c = 0; c < 3; c++) light[c] += (through - left) * at->color[c];
                if (through > 0.5 && left <= 0.5) half = fmax(at->place.v[2], 0);
                through = left;
            }
            const double behind = (double)options->background[3];
            for (int c = 0; c < 3; c++)
                rgba[4 * pixel + (size_t)c] = light[c] + through * (double)options->background[c] * behind;
            rgba[4 * pixel + 3] = 1 - through + through * behind;
            if (depth) depth[pixel] = half;
        }
    free(s);
}
