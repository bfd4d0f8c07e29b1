// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras before distant points.
//
// Sums of products with twice the digits after: Ogita, Rump, Oishi, "Accurate Sum and Dot Product", 2005.
#include "homogeneous/placement.h"
#include "homogeneous/vec.h"

#include <math.h>

/// The sum of a[i] b[i] as if computed with twice the digits and rounded once.
static double sum_products(const double *a, const double *b, int count) {
    double sum = 0, rest = 0;
    for (int i = 0; i < count; i++) {
        const double product = a[i] * b[i], lost = fma(a[i], b[i], -product);
        const double next = sum + product, part = next - sum;
        rest += ((sum - (next - part)) + (product - part)) + lost;
        sum = next;
    }
    return sum + rest;
}

/// A (origin + point) + t.
static ewa_vec3 image_of(const ewa_camera *camera, const double origin[3], ewa_vec3 point) {
    double out[3];
    for (int r = 0; r < 3; r++) {
        const double *row = &camera->world_to_camera[4 * r];
        const double factors[7] = {row[0], row[1], row[2], row[0], row[1], row[2], row[3]};
        const double terms[7] = {origin[0], origin[1], origin[2], point.x, point.y, point.z, 1};
        out[r] = sum_products(factors, terms, 7);
    }
    return vec3_load(out);
}

/// The point that the camera takes to 0; anything where that is beyond doubles. A is a rotation times a scale
/// only roughly: files carry rounded matrices.
static ewa_vec3 eye_of(const ewa_camera *camera, ewa_vec3 image_of_origin) {
    ewa_mat3 a;
    double largest = 0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            a.m[r][c] = camera->world_to_camera[4 * r + c];
            largest = fmax(largest, fabs(a.m[r][c]));
        }
    a = mat3_scale(&a, 1 / largest);
    const ewa_mat3 adjugate = mat3_adjugate(&a);
    return vec3_scale(mat3_mul_vec3(&adjugate, vec3_scale(image_of_origin, 1 / largest)),
                      -1 / mat3_determinant(&a));
}

static double clamp(double value, double low, double high) { return fmin(fmax(value, low), high); }

/// The power of two that is at most `size`; 1 for zero.
static double unit_of(double size) { return size > 0 && isfinite(size) ? ldexp(1, ilogb(size)) : 1; }

static double largest_of(ewa_vec3 v) { return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))); }

void ewa_placement_plane(const double plane_world[4], const double origin_world[3], double plane[4]) {
    int exponent = 0;
    frexp(largest_of(vec3_load(plane_world)), &exponent);
    for (int i = 0; i < 4; i++) plane[i] = ldexp(plane_world[i], -exponent); // rounds nothing
    const double factors[4] = {plane[0], plane[1], plane[2], plane[3]};
    const double terms[4] = {origin_world[0], origin_world[1], origin_world[2], 1};
    const double distance = sum_products(factors, terms, 4), length = vec3_length(vec3_load(plane));
    if (isfinite(distance)) plane[3] = distance; // else d is beyond all points
    for (int i = 0; i < 4; i++) plane[i] /= length;
}

ewa_vec3 ewa_placement_apply(const ewa_placement *placement, ewa_vec3 point) {
    return vec3_add(mat3_mul_vec3(&placement->linear, vec3_sub(point, placement->anchor)), placement->offset);
}

ewa_placement ewa_placement_make(const ewa_camera *camera, const double origin_world[3],
                                 const ewa_bounds *box, double size_world) {
    ewa_placement made = {.unit = 1};
    double scale = 0;
    for (int r = 0; r < 3; r++) {
        const ewa_vec3 row = vec3_load(&camera->world_to_camera[4 * r]);
        vec3_store(row, made.linear.m[r]);
        scale = fmax(scale, largest_of(row));
    }
    made.anchor = eye_of(camera, image_of(camera, origin_world, vec3_make(0, 0, 0)));
    const bool boxed = box && box->low_world[0] <= box->high_world[0];
    if (boxed) {
        made.anchor.x = clamp(made.anchor.x, box->low_world[0], box->high_world[0]);
        made.anchor.y = clamp(made.anchor.y, box->low_world[1], box->high_world[1]);
        made.anchor.z = clamp(made.anchor.z, box->low_world[2], box->high_world[2]);
    }
    made.offset = image_of(camera, origin_world, made.anchor);
    if (boxed) made.unit = unit_of(fmax(largest_of(made.offset), scale * size_world));
    made.linear = mat3_scale(&made.linear, 1 / made.unit);
    made.offset = vec3_scale(made.offset, 1 / made.unit);
    return made;
}
