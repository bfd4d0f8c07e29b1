// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras read from one file, and what all formats do with a pose.
#include "base/base.h"
#include "homogeneous/camera.h"
#include "io/camera/file.h"

#include <string.h>

ewa_status ewa_camera_list_add(ewa_camera_list *list, const char *where, const ewa_camera *camera) {
    char problem[EWA_CAMERA_PROBLEM_BYTES];
    if (ewa_camera_find_problem(camera, problem))
        return ewa_fail(list->context, EWA_ERROR_FORMAT, "%s: %s%s%s", list->name, where,
                        where[0] ? ": " : "", problem);
    if (list->count == list->capacity) {
        const size_t capacity = list->capacity ? 2 * list->capacity : 8;
        ewa_camera *larger = ewa_allocate(list->context, capacity, sizeof *larger);
        if (!larger) return EWA_ERROR_MEMORY;
        if (list->count) memcpy(larger, list->cameras, list->count * sizeof *larger);
        ewa_release(list->context, list->cameras, list->capacity, sizeof *larger);
        list->cameras = larger;
        list->capacity = capacity;
    }
    list->cameras[list->count++] = *camera;
    return EWA_OK;
}

void ewa_camera_list_free(ewa_camera_list *list) {
    ewa_release(list->context, list->cameras, list->capacity, sizeof *list->cameras);
    list->cameras = NULL;
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
