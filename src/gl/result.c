// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the device makes of a band of rows.
#include "gl/result.h"

#include <string.h>

ewa_gl_result ewa_gl_result_of(const ewa_resolve *drawn, const ewa_eye_dome_pass *eye_dome, uint64_t first,
                               uint64_t pixel_count) {
    void *to[EWA_GL_PLANES] = {drawn->rgba8, drawn->rgba, drawn->depth, drawn->normal, drawn->coverage};
    bool made[EWA_GL_PLANES];
    for (int i = 0; i < EWA_GL_PLANES; i++) made[i] = to[i] != NULL;
    if (eye_dome) {
        to[EWA_GL_BYTES] = eye_dome->eye_dome.rgba8, to[EWA_GL_COLORS] = eye_dome->eye_dome.rgba;
        made[EWA_GL_BYTES] = to[EWA_GL_BYTES] != NULL;
        if (drawn->depth == eye_dome->depth.data) to[EWA_GL_DEPTHS] = NULL; // the pass's own
    }
    static const uint32_t words[EWA_GL_PLANES] = {1, 4, 1, 3, 1};
    ewa_gl_result result = {.pixel_count = pixel_count};
    for (int read = 1; read >= 0; read--) {
        for (int i = 0; i < EWA_GL_PLANES; i++) {
            ewa_gl_plane *plane = &result.planes[i];
            if (read) *plane = (ewa_gl_plane){.words = words[i], .at = -1};
            if (!made[i] || (to[i] != NULL) != read) continue;
            if (read) plane->to = (uint8_t *)to[i] + first * words[i] * sizeof(float);
            plane->at = (int64_t)result.words;
            result.words += words[i] * pixel_count;
        }
        if (read) result.read_words = result.words;
    }
    return result;
}

void ewa_gl_result_copy(const ewa_gl_result *result, const uint8_t *words) {
    for (int i = 0; i < EWA_GL_PLANES; i++) {
        const ewa_gl_plane *plane = &result->planes[i];
        if (plane->to)
            memcpy(plane->to, words + (uint64_t)plane->at * sizeof(float), result->pixel_count * plane->words * sizeof(float));
    }
}
