// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects: where their points are on a picture, and how fast that changes along the surface.
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/acquire.h"
#include "generate/generate.h"
#include "homogeneous/vec.h"
#include "math/angle.h"

enum { TASK_POINTS = 1 << 13 };

/// Nearer to a pole than this share of the radius the longitude's gradient grows no more.
#define POLE 1e-3

typedef struct chart_job {
    const ewa_generate_options *options;
    uint64_t count;
    const float *position, *normal;
    float *texcoord, *gradient[2];
} chart_job;

/// Coordinates on the picture and their gradients, per unit of size_world.
typedef struct chart {
    double at[2];
    ewa_vec3 gradient[2];
} chart;

/// Turns of the direction (x, y) in [-1/2, 1/2]; 0 for (0, 0).
static double turns_of(double x, double y) {
    if (x == 0 && y == 0) return 0;
    const double acute = ewa_atan(fabs(y) / fabs(x)), half = x < 0 ? EWA_PI - acute : acute;
    return copysign(half / (2 * EWA_PI), y);
}

/// The picture lies upon the object: x to the right, y up.
static chart flat_chart(const double p[3]) {
    return (chart){{p[0] + 0.5, p[1] + 0.5}, {vec3_make(1, 0, 0), vec3_make(0, 1, 0)}};
}

/// Every face has the whole picture, upright on the sides; above, y is up, as below.
static chart box_chart(const double p[3], const float *normal) {
    int axis = 0;
    for (int c = 1; c < 3; c++)
        if (fabsf(normal[c]) > fabsf(normal[axis])) axis = c;
    const double side = normal[axis] < 0 ? -1 : 1;
    const ewa_vec3 right = axis == 0   ? vec3_make(0, side, 0)
                           : axis == 1 ? vec3_make(-side, 0, 0)
                                       : vec3_make(side, 0, 0);
    const ewa_vec3 up = axis == 2 ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1), at = vec3_load(p);
    return (chart){{vec3_dot(at, right) + 0.5, vec3_dot(at, up) + 0.5}, {right, up}};
}

/// Longitude and latitude: the left and right edge of the picture meet at -x, the upper one is the north
/// pole.
static chart sphere_chart(const double p[3]) {
    const double ring = sqrt(p[0] * p[0] + p[1] * p[1]), radius2 = ring * ring + p[2] * p[2],
                 safe = fmax(ring, POLE * sqrt(radius2));
    chart made = {.at = {turns_of(p[0], p[1]) + 0.5, 2 * turns_of(ring, p[2]) + 0.5}};
    made.gradient[0] = vec3_scale(vec3_make(-p[1], p[0], 0), 1 / (2 * EWA_PI * safe * safe));
    made.gradient[1] =
        vec3_scale(vec3_make(-p[2] * p[0] / safe, -p[2] * p[1] / safe, ring), 1 / (EWA_PI * radius2));
    return made;
}

/// Around the ring, and around the tube, whose outermost circle is the middle of the picture.
static chart torus_chart(const double p[3]) {
    const double ring = sqrt(p[0] * p[0] + p[1] * p[1]), out = ring - 0.5 * EWA_TORUS_MAJOR,
                 tube2 = out * out + p[2] * p[2];
    chart made = {.at = {turns_of(p[0], p[1]) + 0.5, turns_of(out, p[2]) + 0.5}};
    made.gradient[0] = vec3_scale(vec3_make(-p[1], p[0], 0), 1 / (2 * EWA_PI * ring * ring));
    made.gradient[1] =
        vec3_scale(vec3_make(-p[2] * p[0] / ring, -p[2] * p[1] / ring, out), 1 / (2 * EWA_PI * tube2));
    return made;
}

static chart chart_of(const chart_job *job, uint64_t i) {
    const double size = job->options->size_world;
    double p[3];
    for (int c = 0; c < 3; c++) p[c] = (double)job->position[3 * i + (uint64_t)c] / size;
    switch (job->options->object) {
    case EWA_OBJECT_SPHERE:
        return sphere_chart(p);
    case EWA_OBJECT_TORUS:
        return torus_chart(p);
    case EWA_OBJECT_CUBE:
    case EWA_OBJECT_CSG:
        return box_chart(p, job->normal + 3 * i);
    default:
        return flat_chart(p);
    }
}

static void chart_points(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const chart_job *job = data;
    const uint64_t first = (uint64_t)part * TASK_POINTS,
                   end = first + TASK_POINTS < job->count ? first + TASK_POINTS : job->count;
    for (uint64_t i = first; i < end; i++) {
        const chart made = chart_of(job, i);
        for (int k = 0; k < 2; k++) {
            double gradient[3];
            vec3_store(made.gradient[k], gradient);
            job->texcoord[2 * i + (uint64_t)k] = (float)made.at[k];
            for (uint64_t c = 0; c < 3; c++)
                job->gradient[k][3 * i + c] = (float)(gradient[c] / job->options->size_world);
        }
    }
}

ewa_status ewa_generate_charts(const ewa_generate_options *options, ewa_cloud *cloud) {
    ewa_context *context = ewa_cloud_context(cloud);
    void *texcoord = NULL, *gradient[2] = {NULL, NULL};
    EWA_TRY(ewa_cloud_add(cloud, EWA_TEXCOORD, EWA_F32, 2, &texcoord));
    EWA_TRY(ewa_cloud_add(cloud, EWA_TEXCOORD_S, EWA_F32, 3, &gradient[0]));
    EWA_TRY(ewa_cloud_add(cloud, EWA_TEXCOORD_T, EWA_F32, 3, &gradient[1]));
    chart_job job = {
        .options = options,
        .count = ewa_cloud_point_count(cloud),
        .position = ewa_cloud_find(cloud, EWA_POSITION)->data,
        .normal = ewa_cloud_find(cloud, EWA_NORMAL)->data,
        .texcoord = texcoord,
        .gradient = {gradient[0], gradient[1]},
    };
    ewa_parallel(context, chart_points, &job, (uint32_t)((job.count + TASK_POINTS - 1) / TASK_POINTS));
    return EWA_OK;
}
