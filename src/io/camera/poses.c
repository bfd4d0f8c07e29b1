// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras as text: poses as 4 x 4 matrices, one after another, or trajectories of the TUM benchmark; a lens as a 3 x 3 matrix.
// Based on: J. Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", 2012 (file formats).
#include "base/base.h"
#include "io/camera/file.h"
#include "io/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NUMBERS = 8, MATRIX_ROWS = 4, HEADER_NUMBERS = 3 };

typedef struct text {
    ewa_camera_list *list;
    const char *next, *end;
    unsigned long long line; // the one that was read last, from 1
} text;

static ewa_status fail_line(const text *in, const char *what) {
    return ewa_fail(in->list->context, EWA_ERROR_FORMAT, "%s: line %llu: %s", in->list->name, in->line, what);
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == ','; }

/// Reads the numbers of the next line that has some; 0 of them at the end of the text.
static ewa_status read_line(text *in, double numbers[MAX_NUMBERS], int *count) {
    *count = 0;
    while (*count == 0 && in->next < in->end) {
        const size_t left = (size_t)(in->end - in->next);
        const char *feed = memchr(in->next, '\n', left), *line_end = feed ? feed : in->end;
        const char *comment = memchr(in->next, '#', (size_t)(line_end - in->next));
        const char *at = in->next, *stop = comment ? comment : line_end;
        in->line++;
        for (;;) {
            while (at < stop && is_blank(*at)) at++;
            if (at == stop) break;
            if (*count == MAX_NUMBERS) return fail_line(in, "more than eight numbers");
            at = ewa_number_read_f64(at, stop, &numbers[*count]);
            if (!at || (at < stop && !is_blank(*at))) return fail_line(in, "what is no number");
            if (!isfinite(numbers[*count])) return fail_line(in, "a number is not finite");
            (*count)++;
        }
        in->next = feed ? feed + 1 : in->end;
    }
    return EWA_OK;
}

static ewa_status add_pose(const text *in, const ewa_camera *lens, const double rotation[9],
                           const double eye_world[3]) {
    double square = 0;
    for (int i = 0; i < 9; i++) square += rotation[i] * rotation[i];
    if (!(square > 0)) return fail_line(in, "the rotation is zero");
    ewa_camera camera = *lens;
    ewa_camera_set_inverse(&camera, rotation, eye_world);
    char where[64];
    snprintf(where, sizeof where, "pose %zu, before line %llu", in->list->count, in->line + 1);
    return ewa_camera_list_add(in->list, where, &camera);
}

/// Camera to world from position and quaternion x y z w.
static ewa_status add_quaternion(const text *in, const ewa_camera *lens, const double numbers[8]) {
    const double *q = numbers + 4;
    const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(length2 > 0) || !isfinite(length2)) return fail_line(in, "the quaternion is zero or too long");
    const double s = 2 / length2, x = q[0], y = q[1], z = q[2], w = q[3];
    const double rotation[9] = {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                                s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                                s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
    return add_pose(in, lens, rotation, numbers + 1);
}

/// Reads the rows of a matrix after its first one.
static ewa_status read_matrix(text *in, const ewa_camera *lens, const double first[4]) {
    double rotation[9], eye_world[3], row[MAX_NUMBERS];
    memcpy(row, first, 4 * sizeof *row);
    for (int r = 0; r < MATRIX_ROWS; r++) {
        int count = 4;
        if (r > 0) EWA_TRY(read_line(in, row, &count));
        if (count != 4) return fail_line(in, "four numbers of a 4 x 4 matrix wanted");
        if (r == 3) break;
        memcpy(rotation + 3 * r, row, 3 * sizeof *row);
        eye_world[r] = row[3];
    }
    if (row[0] != 0 || row[1] != 0 || row[2] != 0 || row[3] != 1)
        return fail_line(in, "the last row of a matrix is not 0 0 0 1");
    return add_pose(in, lens, rotation, eye_world);
}

ewa_status ewa_camera_list_read_poses(ewa_camera_list *list, const ewa_camera *lens, const uint8_t *bytes,
                                      size_t size_bytes) {
    text in = {list, (const char *)bytes, (const char *)bytes + size_bytes, 0};
    bool headed = false; // the line before was the header of a matrix
    for (;;) {
        double numbers[MAX_NUMBERS];
        int count;
        EWA_TRY(read_line(&in, numbers, &count));
        if (count == 0) break;
        if (count == 8 && !headed)
            EWA_TRY(add_quaternion(&in, lens, numbers));
        else if (count == 4)
            EWA_TRY(read_matrix(&in, lens, numbers));
        else if (count > HEADER_NUMBERS || headed)
            return fail_line(&in, "neither a row of a 4 x 4 matrix nor time, position and quaternion");
        headed = count <= HEADER_NUMBERS;
    }
    if (list->count == 0 || headed)
        return ewa_fail(list->context, EWA_ERROR_FORMAT, "%s: %s", list->name,
                        headed ? "ends before a matrix" : "no camera pose");
    return EWA_OK;
}

ewa_status ewa_camera_read_matrix(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                                  ewa_camera *lens) {
    ewa_camera_list list = {.context = context, .name = name};
    text in = {&list, (const char *)bytes, (const char *)bytes + size_bytes, 0};
    double rows[4][MAX_NUMBERS];
    for (int r = 0; r < 4; r++) {
        int count;
        EWA_TRY(read_line(&in, rows[r], &count));
        if (count != (r < 3 ? 3 : 0))
            return fail_line(&in, "no row of a 3 x 3 matrix fx 0 cx, 0 fy cy, 0 0 1, as a lens is in a text");
    }
    const double scale = rows[2][2];
    if (rows[1][0] != 0 || rows[2][0] != 0 || rows[2][1] != 0 || !(rows[0][0] / scale > 0) || !(rows[1][1] / scale > 0))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: no lens: its matrix has to be fx 0 cx, 0 fy cy, 0 0 1, fx and fy above 0",
                        name);
    if (rows[0][1] != 0)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: a lens with a skew of %g, which has to be 0", name,
                        rows[0][1] / scale);
    lens->fx_px = rows[0][0] / scale;
    lens->fy_px = rows[1][1] / scale;
    lens->cx_px = rows[0][2] / scale;
    lens->cy_px = rows[1][2] / scale;
    return EWA_OK;
}
