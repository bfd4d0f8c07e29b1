// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ray-traced truth of the cube and the part. What is taken out of the block are intervals of the ray: the
// first place of the block that is in none of them is the hit.
#include "quality/solid_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_VOIDS = EWA_SOLID_MAX_REMOVED + EWA_SOLID_MAX_HOLES };

/// An interval of a ray inside a convex body, with the outward normals at its ends.
typedef struct ray_span {
    double from, to;
    double normal_from[3], normal_to[3];
    int surface_from, surface_to;
} ray_span;

/// The part of the ray between two parallel planes; false when there is none left.
static bool clip_to_slab(ray_span *span, const double eye[3], const double ray[3], int axis, double low,
                         double high, int surface) {
    for (int side = 0; side < 2; side++) {
        const double at = side ? high : low, sign = side ? 1 : -1;
        const double height = sign * (eye[axis] - at), slope = sign * ray[axis];
        if (slope == 0) {
            if (height > 0) return false;
            continue;
        }
        const double t = -height / slope;
        if (slope < 0 && t > span->from) {
            span->from = t;
            memset(span->normal_from, 0, sizeof span->normal_from);
            span->normal_from[axis] = sign;
            span->surface_from = surface + 2 * axis + side;
        }
        if (slope > 0 && t < span->to) {
            span->to = t;
            memset(span->normal_to, 0, sizeof span->normal_to);
            span->normal_to[axis] = sign;
            span->surface_to = surface + 2 * axis + side;
        }
    }
    return span->from < span->to;
}

static bool meet_box(ray_span *span, const double eye[3], const double ray[3], const double low[3],
                     const double high[3], int surface) {
    *span = (ray_span){.from = -INFINITY, .to = INFINITY};
    for (int c = 0; c < 3; c++)
        if (!clip_to_slab(span, eye, ray, c, low[c], high[c], surface)) return false;
    return true;
}

static bool meet_cylinder(ray_span *span, const double eye[3], const double ray[3],
                          const ewa_solid_hole *hole, int surface) {
    const int u = (hole->axis + 1) % 3, v = (hole->axis + 2) % 3;
    const double eu = eye[u] - hole->center[0], ev = eye[v] - hole->center[1];
    const double a = ray[u] * ray[u] + ray[v] * ray[v], b = eu * ray[u] + ev * ray[v];
    const double c = eu * eu + ev * ev - hole->radius * hole->radius, d = b * b - a * c;
    if (a == 0 || d <= 0) return false;
    const double ends[2] = {(-b - sqrt(d)) / a, (-b + sqrt(d)) / a};
    *span = (ray_span){.from = ends[0], .to = ends[1], .surface_from = surface, .surface_to = surface};
    span->normal_to[u] = (eu + ends[1] * ray[u]) / hole->radius;
    span->normal_to[v] = (ev + ends[1] * ray[v]) / hole->radius;
    return true;
}

solid_hit solid_trace(const ewa_solid_shape *shape, const double eye_world[3], const double ray[3]) {
    double eye[3], low[3], high[3];
    for (int c = 0; c < 3; c++) {
        eye[c] = eye_world[c] / 2;
        low[c] = shape->breaks[c][0];
        high[c] = shape->breaks[c][shape->interval_count[c]];
    }
    solid_hit hit = {.any = false};
    ray_span block, voids[MAX_VOIDS];
    if (!meet_box(&block, eye, ray, low, high, 0) || block.to <= 0) return hit;
    int count = 0;
    for (uint32_t i = 0; i < shape->removed_count; i++) {
        for (int c = 0; c < 3; c++) {
            low[c] = shape->breaks[c][shape->removed[i].low[c]];
            high[c] = shape->breaks[c][shape->removed[i].end[c]];
        }
        count += meet_box(&voids[count], eye, ray, low, high, 10 * ((int)i + 1));
    }
    for (uint32_t h = 0; h < shape->hole_count; h++)
        count += meet_cylinder(&voids[count], eye, ray, &shape->holes[h], 100 + (int)h);
    double t = block.from;
    const double *normal = block.normal_from;
    double sign = 1;
    hit.surface = block.surface_from;
    const double minimum = 1e-12;
    for (int i = 0; i < count; i++) {
        if (!(voids[i].from <= t + minimum && voids[i].to > t + minimum)) continue;
        t = voids[i].to;
        normal = voids[i].normal_to;
        sign = -1;
        hit.surface = voids[i].surface_to;
        i = -1; // another void may go on from here
    }
    if (t <= 0 || t >= block.to - minimum) return hit;
    hit.any = true;
    for (int c = 0; c < 3; c++) {
        hit.normal[c] = sign * normal[c];
        hit.place_world[c] = 2 * (eye[c] + t * ray[c]);
    }
    return hit;
}

solid_hit solid_trace_px(const ewa_solid_shape *shape, const ewa_camera *camera, double x_px, double y_px) {
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double *m = camera->world_to_camera;
    double eye[3], ray[3];
    ewa_camera_eye(camera, eye);
    for (int c = 0; c < 3; c++) ray[c] = m[c] * x + m[4 + c] * y + m[8 + c];
    return solid_trace(shape, eye, ray);
}

void solid_color(const double normal[3], float color[3]) {
    static const double tint[3] = {0.30, 0.36, 0.42};
    for (int c = 0; c < 3; c++) color[c] = (float)(0.5 + tint[c] * normal[c] - 0.1 * normal[(c + 1) % 3]);
}

void solid_color_cloud(ewa_cloud *cloud) {
    const ewa_attribute normals = *ewa_cloud_find(cloud, EWA_NORMAL);
    float *color = check_add(cloud, EWA_COLOR, EWA_F32, 3);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        double normal[3];
        ewa_attribute_read_f64(&normals, i, 1, normal);
        solid_color(normal, &color[3 * i]);
    }
}

void solid_mark_edges(const ewa_solid_shape *shape, const ewa_camera *camera, int reach_px, uint8_t *mask) {
    const int width = (int)camera->width_px, height = (int)camera->height_px;
    const size_t count = (size_t)width * (size_t)height;
    OWNED(check_free) int *surface = malloc(count * sizeof *surface);
    assert_non_null(surface);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const solid_hit hit = solid_trace_px(shape, camera, x + 0.5, y + 0.5);
            surface[y * width + x] = hit.any ? hit.surface : -1;
        }
    memset(mask, 0, count);
    for (int y = 0; y + 1 < height; y++)
        for (int x = 0; x + 1 < width; x++) {
            const int *at = &surface[y * width + x];
            if (at[0] == at[1] && at[0] == at[width]) continue;
            for (int dy = -reach_px; dy <= reach_px; dy++)
                for (int dx = -reach_px; dx <= reach_px; dx++)
                    if (dx * dx + dy * dy <= reach_px * reach_px && x + dx >= 0 && x + dx < width &&
                        y + dy >= 0 && y + dy < height)
                        mask[(y + dy) * width + x + dx] = 1;
        }
}

void solid_picture(const ewa_solid_shape *shape, const ewa_camera *camera, int side, float *rgba) {
    const int width = (int)camera->width_px, height = (int)camera->height_px;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum[4] = {0};
            for (int k = 0; k < side * side; k++) {
                const solid_hit hit =
                    solid_trace_px(shape, camera, x + (k % side + 0.5) / side, y + (k / side + 0.5) / side);
                if (!hit.any) continue;
                float color[3];
                solid_color(hit.normal, color);
                for (int c = 0; c < 3; c++) sum[c] += color[c];
                sum[3] += 1;
            }
            for (int c = 0; c < 4; c++) rgba[4 * (y * width + x) + c] = (float)(sum[c] / (side * side));
        }
}
