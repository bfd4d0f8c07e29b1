// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scene's plain numbers as the streams of a cloud, of the types that files have. What a stream cannot hold
// exactly is rounded in the plain numbers too, so that both forms stay the same scene.
#include "tests/independent/random_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double decoded(double code) {
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

static double encoded(double light) {
    const double value = light <= 0 ? 0 : light >= 1 ? 1 : light;
    return value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1 / 2.4) - 0.055;
}

static void *add(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t components) {
    void *data = NULL;
    if (ewa_cloud_add(cloud, name, type, components, &data) != EWA_OK) abort();
    return data;
}

/// Stores numbers as floats, and keeps what has been stored.
static void store_floats(float *to, double *values, int count) {
    for (int i = 0; i < count; i++) {
        to[i] = (float)values[i];
        values[i] = (double)to[i];
    }
}

ewa_type scene_cloud_color_type(const random_scene *made, uint32_t choice) {
    bool bright = choice > 1;
    for (uint64_t i = 0; i < made->scene.surfel_count; i++)
        for (int c = 0; c < 3; c++) bright = bright || made->surfels[i].color[c] > 1;
    return bright ? EWA_F32 : choice == 0 ? EWA_U8 : EWA_U16;
}

static void make_color_stream(random_scene *made, ewa_type type) {
    uint32_t components = 3;
    for (uint64_t i = 0; i < made->scene.surfel_count; i++)
        if (made->surfels[i].alpha < 1) components = 4;
    void *data = add(made->cloud, EWA_COLOR, type, components);
    uint8_t *bytes = data;
    uint16_t *words = data;
    for (uint64_t i = 0; i < made->scene.surfel_count; i++) {
        independent_surfel *s = &made->surfels[i];
        for (uint32_t c = 0; c < components; c++) {
            double *value = c < 3 ? &s->color[c] : &s->alpha;
            const double code = c < 3 ? encoded(*value) : *value;
            const uint64_t at = components * i + c;
            if (type == EWA_F32) {
                store_floats((float *)data + at, value, 1);
            } else if (type == EWA_U8) {
                bytes[at] = (uint8_t)(255 * code + 0.5);
                *value = bytes[at] / 255.0;
            } else {
                words[at] = (uint16_t)(65535 * code + 0.5);
                *value = words[at] / 65535.0;
            }
            if (type != EWA_F32 && c < 3) *value = decoded(*value);
        }
    }
}

void scene_cloud_make(ewa_context *context, random_scene *made, const double origin[3], ewa_type positions,
                      ewa_type colors) {
    const uint64_t count = made->scene.surfel_count;
    const bool discs = made->surfels[0].disc;
    if (ewa_cloud_create(context, count, &made->cloud) != EWA_OK) abort();
    ewa_cloud_set_origin(made->cloud, origin);
    uint8_t *material = add(made->cloud, EWA_MATERIAL, EWA_U8, 1), *mode = NULL;
    void *position = add(made->cloud, EWA_POSITION, positions, 3);
    float *normal = add(made->cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = NULL, *axes[2] = {NULL, NULL}, *clip[2] = {NULL, NULL};
    if (discs) {
        radius = add(made->cloud, EWA_RADIUS, EWA_F32, 1);
    } else {
        axes[0] = add(made->cloud, EWA_TANGENT_U, EWA_F32, 3),
        axes[1] = add(made->cloud, EWA_TANGENT_V, EWA_F32, 3);
        clip[0] = add(made->cloud, EWA_CLIP0, EWA_F32, 3), clip[1] = add(made->cloud, EWA_CLIP1, EWA_F32, 3);
        mode = add(made->cloud, EWA_CLIP_MODE, EWA_U8, 1);
    }
    for (uint64_t i = 0; i < count; i++) {
        independent_surfel *s = &made->surfels[i];
        if (positions == EWA_F64)
            memcpy((double *)position + 3 * i, s->position, sizeof s->position);
        else
            store_floats((float *)position + 3 * i, s->position, 3);
        for (int c = 0; c < 3; c++) s->position[c] += origin[c];
        store_floats(normal + 3 * i, s->normal, 3);
        material[i] = (uint8_t)s->material;
        if (discs) {
            store_floats(radius + i, &s->radius, 1);
            continue;
        }
        store_floats(axes[0] + 3 * i, s->axis_u, 3);
        store_floats(axes[1] + 3 * i, s->axis_v, 3);
        for (int k = 0; k < 2; k++) store_floats(clip[k] + 3 * i, s->clip[k], 3);
        mode[i] = s->clip_either;
    }
    make_color_stream(made, colors);
    made->scene.surfels = made->surfels;
}

void random_scene_free(random_scene *made) {
    ewa_cloud_destroy(&made->cloud);
    ewa_environment_destroy(&made->environment);
    if (made->sky) independent_environment_free(made->sky);
    free(made->sky);
    free(made->surfels);
    *made = (random_scene){.surfels = NULL};
}
