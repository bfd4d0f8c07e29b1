// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lines of profiles as text, and the strip beside one.
#include "base/base.h"
#include "homogeneous/vec.h"
#include "io/number.h"
#include "scene/profile.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Says what is wrong with a line; for callers that hand on a failure.
static ewa_status refuse(char *problem, const char *text) {
    if (problem) snprintf(problem, EWA_OPTION_TEXT_BYTES, "%s", text);
    return EWA_ERROR_ARGUMENT;
}

/// Reads the numbers of a corner; NULL: there are not two or three.
static const char *read_corner(const char *text, const char *end, double corner_world[3]) {
    int count = 0;
    corner_world[2] = 0;
    do {
        while (*text == ' ') text++;
        const char *after = ewa_number_read_f64(text, end, &corner_world[count]);
        if (!after || after == text || !isfinite(corner_world[count])) return NULL;
        for (text = after; *text == ' ';) text++;
        count++;
    } while (count < 3 && *text == ',' && text++);
    return count >= 2 ? text : NULL;
}

ewa_status ewa_profile_line_read(const char *text, double *corners_world, uint32_t *corner_count,
                                 char problem[EWA_OPTION_TEXT_BYTES]) {
    if (!text || !corners_world || !corner_count) return EWA_ERROR_ARGUMENT;
    const char *end = text + strlen(text);
    for (*corner_count = 0; *text; (*corner_count)++) {
        if (*corner_count == EWA_PROFILE_CORNERS) return refuse(problem, "a line has at most 1024 corners");
        text = read_corner(text, end, corners_world + 3 * *corner_count);
        if (!text || (*text && *text != ';')) return refuse(problem, "a line is x,y;x,y;... or x,y,z;x,y,z;...");
        text += *text == ';';
    }
    return *corner_count >= 2 ? EWA_OK : refuse(problem, "a line has at least two corners");
}

/// Adds the piece between two corners, unless they are one place on the map.
static void add_piece(ewa_strip *strip, const double from_world[3], const double to_world[3]) {
    const ewa_vec3 up = vec3_load(strip->up_world), from = vec3_load(from_world), by = vec3_sub(vec3_load(to_world), from);
    const ewa_vec3 across = vec3_sub(by, vec3_scale(up, vec3_dot(by, up)));
    const double length = vec3_length(across);
    if (!(length > 0)) return;
    const ewa_vec3 along = vec3_make(across.x / length, across.y / length, across.z / length);
    strip->pieces[strip->piece_count++] = (ewa_strip_piece){.from_world = from,
                                                            .along_world = along,
                                                            .right_world = vec3_cross(along, up),
                                                            .station = strip->length_world,
                                                            .length_world = length};
    strip->length_world += length;
}

ewa_status ewa_strip_make(ewa_context *context, const double *corners_world, uint32_t corner_count,
                          const double up_world[3], double width_world, ewa_strip *strip) {
    *strip = (ewa_strip){.context = context, .half_width_world = 0.5 * width_world, .capacity = corner_count};
    memcpy(strip->up_world, up_world, sizeof strip->up_world);
    strip->pieces = ewa_allocate(context, corner_count, sizeof *strip->pieces);
    if (!strip->pieces) return EWA_ERROR_MEMORY;
    bool finite = true;
    for (int c = 0; c < 3; c++) strip->low_world[c] = INFINITY, strip->high_world[c] = -INFINITY;
    for (uint32_t i = 0; i < corner_count; i++)
        for (int c = 0; c < 3; c++) {
            finite = finite && isfinite(corners_world[3 * i + (uint32_t)c]);
            strip->low_world[c] = fmin(strip->low_world[c], corners_world[3 * i + (uint32_t)c] - strip->half_width_world);
            strip->high_world[c] = fmax(strip->high_world[c], corners_world[3 * i + (uint32_t)c] + strip->half_width_world);
        }
    for (int c = 0; c < 3; c++) // the strip is a wall: it goes up and down without end, obliquely to any axis that up is not across
        if (up_world[c] != 0) strip->low_world[c] = -INFINITY, strip->high_world[c] = INFINITY;
    for (uint32_t i = 0; i + 1 < corner_count && finite; i++) add_piece(strip, corners_world + 3 * i, corners_world + 3 * i + 3);
    if (finite && isfinite(strip->length_world) && strip->piece_count) return EWA_OK;
    ewa_strip_free(strip);
    return ewa_fail(context, EWA_ERROR_ARGUMENT, finite ? "profile: the line has no length, seen from above"
                                                        : "profile: a corner of the line is not finite");
}

void ewa_strip_free(ewa_strip *strip) {
    if (strip->context) ewa_release(strip->context, strip->pieces, strip->capacity, sizeof *strip->pieces);
    *strip = (ewa_strip){.context = NULL};
}

bool ewa_strip_locate(const ewa_strip *strip, const double place_world[3], double *station, double *offset) {
    double nearest2 = INFINITY;
    bool beyond = true;
    for (uint32_t i = 0; i < strip->piece_count; i++) {
        const ewa_strip_piece *piece = &strip->pieces[i];
        const ewa_vec3 from = vec3_sub(vec3_load(place_world), piece->from_world);
        const double along = vec3_dot(from, piece->along_world), right = vec3_dot(from, piece->right_world);
        const double on = fmin(fmax(along, 0), piece->length_world), past = along - on;
        const double away2 = past * past + right * right;
        if (!(away2 < nearest2)) continue;
        nearest2 = away2;
        beyond = (i == 0 && past < 0) || (i + 1 == strip->piece_count && past > 0);
        *station = piece->station + on;
        *offset = past == 0 ? right : copysign(sqrt(away2), right);
    }
    return !beyond && fabs(*offset) <= strip->half_width_world;
}
