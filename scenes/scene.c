// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small scenes. Objects are those of ewa_cloud_generate(); what it does not make is made here.
#include "scenes/scene.h"

#include <math.h>

/// Standard deviation of the kernels in units of the spacing of the points: the default radius, cut at F = 3.
static const double SIGMA = EWA_DEFAULT_RADIUS_SCALE / 3;

/// Share of a kernel that lies within the default cutoff: 1 - exp(-F^2 / 2), F = 3.
static const double KERNEL_SHARE = 0.9888910034617577;

/// A splitmix64 stream of numbers.
typedef struct stream {
    uint64_t state;
} stream;

static double uniform(stream *numbers, double low, double high) {
    uint64_t z = numbers->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static void random_direction(stream *numbers, double v[3]) {
    double length2;
    do {
        length2 = 0;
        for (int c = 0; c < 3; c++) {
            v[c] = uniform(numbers, -1, 1);
            length2 += v[c] * v[c];
        }
    } while (length2 > 1 || length2 < 0.01);
    for (int c = 0; c < 3; c++) v[c] /= sqrt(length2);
}

/// The part of `v` across the unit `axis`, with a length of `length`.
static void across(const double axis[3], double length, double v[3]) {
    const double along = v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2];
    double length2 = 0;
    for (int c = 0; c < 3; c++) {
        v[c] -= along * axis[c];
        length2 += v[c] * v[c];
    }
    for (int c = 0; c < 3; c++) v[c] *= length / sqrt(length2);
}

/// Streams of a cloud of ellipses.
typedef struct ellipses {
    float (*position)[3], (*tangent_u)[3], (*tangent_v)[3];
    uint8_t (*color)[3];
} ellipses;

static ewa_status add_ellipses(ewa_context *context, uint64_t count, ewa_cloud **cloud, ellipses *streams) {
    ewa_status status = ewa_cloud_create(context, count, cloud);
    void *data[4];
    static const char *const names[] = {EWA_POSITION, EWA_TANGENT_U, EWA_TANGENT_V, EWA_COLOR};
    for (int i = 0; i < 4 && status == EWA_OK; i++)
        status = ewa_cloud_add(*cloud, names[i], i < 3 ? EWA_F32 : EWA_U8, 3, &data[i]);
    if (status != EWA_OK) return status;
    *streams = (ellipses){data[0], data[1], data[2], data[3]};
    return EWA_OK;
}

/// An ellipse with a random direction, or nearly in a plane with the view from `eye`; minor axis 0.1 to 1 of
/// `sigma`.
static void put_ellipse(stream *numbers, const ellipses *streams, uint64_t i, const double center[3],
                        const double eye[3], bool edge_on, double sigma) {
    double normal[3], u[3], v[3];
    random_direction(numbers, normal);
    if (edge_on) {
        double view[3], length2 = 0;
        for (int c = 0; c < 3; c++) {
            view[c] = center[c] - eye[c];
            length2 += view[c] * view[c];
        }
        for (int c = 0; c < 3; c++) view[c] /= sqrt(length2);
        across(view, 1, normal);
        const double lean = uniform(numbers, -0.02, 0.02);
        for (int c = 0; c < 3; c++) normal[c] = (normal[c] + lean * view[c]) / sqrt(1 + lean * lean);
    }
    random_direction(numbers, u);
    across(normal, sigma, u);
    const double aspect = uniform(numbers, 0.1, 1);
    for (int c = 0; c < 3; c++) {
        const int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        v[c] = aspect * (normal[c1] * u[c2] - normal[c2] * u[c1]);
    }
    for (int c = 0; c < 3; c++) {
        streams->position[i][c] = (float)center[c];
        streams->tangent_u[i][c] = (float)u[c];
        streams->tangent_v[i][c] = (float)v[c];
        streams->color[i][c] = (uint8_t)uniform(numbers, 0, 256);
    }
}

static ewa_status make_ellipses(ewa_context *context, uint64_t count, scene *made) {
    ellipses streams;
    const ewa_status status = add_ellipses(context, count, &made->cloud, &streams);
    if (status != EWA_OK) return status;
    stream numbers = {1};
    const double eye[3] = {0, 0, -4}, spacing = 4 / sqrt((double)count);
    for (uint64_t i = 0; i < count; i++) {
        double center[3];
        for (int c = 0; c < 3; c++) center[c] = uniform(&numbers, -1, 1);
        put_ellipse(&numbers, &streams, i, center, eye, i % 10 == 0, uniform(&numbers, 0.1, 0.5) * spacing);
    }
    made->unit_coverage = 0.1;
    made->camera.world_to_camera[11] = 4;
    return EWA_OK;
}

/// The eye is at the origin and looks along +z, y down: a floor at y = 0.5 and a wall at x = -0.7, both from
/// z = -1 to 9, of round discs on a grid; every eighth splat is an ellipse within a box around the eye.
static ewa_status make_near(ewa_context *context, uint64_t count, scene *made) {
    ellipses streams;
    const ewa_status status = add_ellipses(context, count, &made->cloud, &streams);
    if (status != EWA_OK) return status;
    stream numbers = {2};
    const double eye[3] = {0, 0, 0}, spacing = sqrt(30.0 / (double)count), sigma = SIGMA * spacing;
    for (uint64_t i = 0; i < count; i++) {
        if (i % 8 == 7) {
            const double center[3] = {uniform(&numbers, -0.6, 1.5), uniform(&numbers, -1, 0.4),
                                      uniform(&numbers, -0.5, 2)};
            put_ellipse(&numbers, &streams, i, center, eye, false, uniform(&numbers, 0.2, 1) * spacing);
            continue;
        }
        const bool on_floor = i % 2 == 0;
        const double across_it = on_floor ? uniform(&numbers, -0.7, 2) : uniform(&numbers, -1, 0.5);
        const double along = uniform(&numbers, -1, 9);
        const float position[3] = {on_floor ? (float)across_it : -0.7f, on_floor ? 0.5f : (float)across_it,
                                   (float)along};
        for (int c = 0; c < 3; c++) {
            streams.position[i][c] = position[c];
            streams.tangent_u[i][c] = c == 2 ? (float)sigma : 0;
            streams.tangent_v[i][c] = c == (on_floor ? 0 : 1) ? (float)sigma : 0;
        }
        const bool dark = (int64_t)floor(4 * along + 100) % 2 == (int64_t)floor(4 * across_it + 100) % 2;
        for (int c = 0; c < 3; c++) streams.color[i][c] = dark ? 60 : c == (on_floor ? 1 : 0) ? 240 : 200;
    }
    made->unit_coverage = SIGMA * SIGMA * KERNEL_SHARE;
    return EWA_OK;
}

/// An object of ewa_cloud_generate() seen from `eye`, looking at `target`, z up.
static ewa_status make_object(ewa_context *context, ewa_object object, uint64_t count, const double eye[3],
                              const double target[3], scene *made) {
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.object = object;
    options.point_count = count;
    options.radius_scale = EWA_DEFAULT_RADIUS_SCALE;
    if (object == EWA_OBJECT_CUBE) options.checks = 4;
    ewa_status status = ewa_cloud_generate(context, &options, &made->cloud);
    static const double up[3] = {0, 0, 1};
    if (status == EWA_OK) status = ewa_camera_look_at(&made->camera, eye, target, up);
    made->unit_coverage = SIGMA * SIGMA * KERNEL_SHARE;
    return status;
}

const char *scene_name(scene_kind kind) {
    static const char *const names[SCENE_COUNT] = {"plane", "sphere", "torus", "cube", "ellipses", "near"};
    return (unsigned)kind < SCENE_COUNT ? names[kind] : "unknown";
}

ewa_status scene_make(ewa_context *context, scene_kind kind, uint64_t point_count, uint32_t width_px,
                      uint32_t height_px, scene *made) {
    *made = (scene){.cloud = NULL};
    ewa_camera_init(&made->camera);
    made->camera.width_px = width_px;
    made->camera.height_px = height_px;
    ewa_status status = ewa_camera_set_fov(&made->camera, 50);
    static const double middle[3] = {0, 0, 0};
    if (status == EWA_OK) {
        switch (kind) {
        case SCENE_PLANE:
            status = make_object(context, EWA_OBJECT_CHECKER, point_count, (double[3]){0.03, -0.98, 0.06},
                                 (double[3]){0, -0.7, 0.02}, made);
            break;
        case SCENE_SPHERE:
            status =
                make_object(context, EWA_OBJECT_SPHERE, point_count, (double[3]){1.5, -1.8, 1}, middle, made);
            break;
        case SCENE_TORUS:
            status = make_object(context, EWA_OBJECT_TORUS, point_count, (double[3]){0.9, -1.6, 1.2}, middle,
                                 made);
            break;
        case SCENE_CUBE:
            status = make_object(context, EWA_OBJECT_CUBE, point_count, (double[3]){1.7, 1.9, 1.5},
                                 (double[3]){0.3, 0.3, 0.2}, made);
            break;
        case SCENE_ELLIPSES:
            status = make_ellipses(context, point_count, made);
            break;
        default:
            status = make_near(context, point_count, made);
            break;
        }
    }
    if (status != EWA_OK) scene_free(made);
    return status;
}

void scene_free(scene *made) { ewa_cloud_destroy(&made->cloud); }
