// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras from files: with their lens, or as poses that get one from the command line.
#include "cli/input/camera_input.h"
#include "cli/base/pattern.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool camera_input_is_poses(const char *path) { return path_has_suffix(path, ".txt|.log|.tum"); }

/// Reads exactly four finite numbers separated by commas.
static bool read_numbers(const char *text, double numbers[4]) {
    for (int i = 0; i < 4; i++) {
        char *end;
        numbers[i] = strtod(text, &end);
        if (end == text || !isfinite(numbers[i]) || *end != (i < 3 ? ',' : 0)) return false;
        text = end + 1;
    }
    return true;
}

bool camera_input_check_lens(const char *intrinsics, char message[OPTION_ERROR_BYTES]) {
    if (!intrinsics) return true;
    double numbers[4];
    const char *wrong = NULL;
    if (read_numbers(intrinsics, numbers)) {
        if (!(numbers[0] > 0 && numbers[1] > 0))
            wrong = "--intrinsics: the focal lengths have to be positive";
    } else if (strspn(intrinsics, "0123456789.,+-eE ") == strlen(intrinsics)) {
        wrong = "--intrinsics: neither fx,fy,cx,cy nor a file";
    }
    return options_fine(wrong, message);
}

bool camera_input_load_lens(cli_session *session, const char *intrinsics, ewa_camera *camera) {
    double numbers[4];
    if (!read_numbers(intrinsics, numbers)) {
        session->subject = intrinsics;
        const ewa_status status = ewa_camera_load_lens(session->context, intrinsics, camera);
        if (status != EWA_OK) session_failed(session, status);
        session->subject = NULL;
        return status == EWA_OK;
    }
    camera->fx_px = numbers[0];
    camera->fy_px = numbers[1];
    camera->cx_px = numbers[2];
    camera->cy_px = numbers[3];
    session->subject = NULL;
    const double middle_x = 0.5 * camera->width_px, middle_y = 0.5 * camera->height_px;
    if (numbers[2] == middle_x - 0.5 && numbers[3] == middle_y - 0.5)
        session_note(
            session,
            "--intrinsics: %g,%g is the middle of %u x %u pixels where pixel centres are whole numbers, "
            "as in OpenCV, Open3D and TUM's files; here they are halves and the middle is %g,%g: add "
            "0.5 to cx and cy",
            numbers[2], numbers[3], camera->width_px, camera->height_px, middle_x, middle_y);
    return true;
}

/// The camera that is looked for among the poses of a file.
typedef struct wanted_pose {
    uint32_t index, count;
    ewa_camera *camera;
} wanted_pose;

static void take_pose(void *user, uint32_t index, const ewa_camera *camera) {
    wanted_pose *wanted = user;
    if (index == wanted->index) *wanted->camera = *camera;
    wanted->count = index + 1;
}

bool camera_input_load(cli_session *session, const char *path, uint32_t index, const ewa_camera *lens,
                       ewa_camera *camera) {
    if (camera_input_is_poses(path)) {
        wanted_pose wanted = {.index = index, .camera = camera};
        if (!camera_input_load_each(session, path, lens, take_pose, &wanted)) return false;
        if (index < wanted.count) return true;
        session_fail(session, "%s: pose %u wanted, %u there (counted from 0)", path, index, wanted.count);
        return false;
    }
    session->subject = path;
    ewa_camera_init(camera);
    const ewa_status status = ewa_camera_load(session->context, path, index, camera);
    if (status != EWA_OK) session_failed(session, status);
    session->subject = NULL;
    return status == EWA_OK;
}

bool camera_input_load_each(cli_session *session, const char *path, const ewa_camera *lens,
                            ewa_camera_callback *receive, void *user) {
    session->subject = path;
    const ewa_status status = camera_input_is_poses(path)
                                  ? ewa_camera_load_poses(session->context, path, lens, receive, user)
                                  : ewa_camera_load_each(session->context, path, receive, user);
    if (status != EWA_OK) session_failed(session, status);
    session->subject = NULL;
    return status == EWA_OK;
}
