// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras read from one file, and what all formats do with a pose.
#include "base/base.h"
#include "homogeneous/camera.h"
#include "io/camera/file.h"

#include <string.h>

static ewa_status grow(ewa_camera_list *list, size_t capacity) {
    ewa_context *context = list->context;
    const size_t old = list->capacity, count = list->count;
    ewa_camera *cameras = ewa_allocate(context, capacity, sizeof *cameras);
    ewa_lens *lenses = ewa_allocate(context, capacity, sizeof *lenses);
    char **pictures = ewa_allocate(context, capacity, sizeof *pictures);
    if (!cameras || !lenses || !pictures) {
        ewa_release(context, cameras, capacity, sizeof *cameras);
        ewa_release(context, lenses, capacity, sizeof *lenses);
        ewa_release(context, pictures, capacity, sizeof *pictures);
        return EWA_ERROR_MEMORY;
    }
    if (count) {
        memcpy(cameras, list->cameras, count * sizeof *cameras);
        memcpy(lenses, list->lenses, count * sizeof *lenses);
        memcpy(pictures, list->pictures, count * sizeof *pictures);
    }
    ewa_release(context, list->cameras, old, sizeof *cameras);
    ewa_release(context, list->lenses, old, sizeof *lenses);
    ewa_release(context, list->pictures, old, sizeof *pictures);
    list->cameras = cameras, list->lenses = lenses, list->pictures = pictures;
    list->capacity = capacity;
    return EWA_OK;
}

ewa_status ewa_camera_list_add(ewa_camera_list *list, const char *where, const ewa_camera *camera) {
    char problem[EWA_CAMERA_PROBLEM_BYTES];
    if (ewa_camera_find_problem(camera, problem))
        return ewa_fail(list->context, EWA_ERROR_FORMAT, "%s: %s%s%s", list->name, where,
                        where[0] ? ": " : "", problem);
    if (list->count == list->capacity) EWA_TRY(grow(list, list->capacity ? 2 * list->capacity : 8));
    list->pictures[list->count] = NULL;
    list->lenses[list->count] = (ewa_lens){.model = EWA_LENS_PINHOLE};
    list->cameras[list->count++] = *camera;
    return EWA_OK;
}

void ewa_camera_list_set_lens(ewa_camera_list *list, const ewa_lens *lens) { list->lenses[list->count - 1] = *lens; }

ewa_status ewa_camera_list_name(ewa_camera_list *list, ewa_text picture) {
    char *copy = ewa_allocate(list->context, picture.length + 1, 1);
    if (!copy) return EWA_ERROR_MEMORY;
    if (picture.length) memcpy(copy, picture.chars, picture.length);
    copy[picture.length] = '\0';
    list->pictures[list->count - 1] = copy;
    return EWA_OK;
}

void ewa_camera_list_free(ewa_camera_list *list) {
    for (size_t i = 0; i < list->count; i++)
        if (list->pictures[i]) ewa_release(list->context, list->pictures[i], strlen(list->pictures[i]) + 1, 1);
    ewa_release(list->context, list->cameras, list->capacity, sizeof *list->cameras);
    ewa_release(list->context, list->pictures, list->capacity, sizeof *list->pictures);
    ewa_release(list->context, list->lenses, list->capacity, sizeof *list->lenses);
    list->cameras = NULL, list->lenses = NULL, list->pictures = NULL;
    list->count = list->capacity = 0;
}

void ewa_camera_set_inverse(ewa_camera *camera, const double rotation[9], const double centre_world[3]) {
    double square = 0; // of the scale
    for (int i = 0; i < 9; i++) square += rotation[i] * rotation[i] / 3;
    double *m = camera->world_to_camera;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) m[4 * r + c] = rotation[3 * c + r] / square;
        m[4 * r + 3] =
            -(m[4 * r] * centre_world[0] + m[4 * r + 1] * centre_world[1] + m[4 * r + 2] * centre_world[2]);
    }
}
