// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the device makes of a band of rows.
#include "gl/result.h"

#include <string.h>

ewa_gl_result ewa_gl_result_of(const ewa_resolve *drawn, const ewa_eye_dome_pass *eye_dome, uint32_t finer, uint64_t first,
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
    const uint64_t parts = (uint64_t)finer * finer;
    ewa_gl_result result = {.finer = finer, .pixel_count = pixel_count / parts};
    for (int i = 0; i < EWA_GL_PLANES; i++) {
        ewa_gl_plane *plane = &result.planes[i];
        *plane = (ewa_gl_plane){.words = words[i], .at = -1, .mean_at = -1};
        if (!made[i] || !to[i]) continue;
        plane->to = (uint8_t *)to[i] + first / parts * words[i] * sizeof(float);
        *(finer > 1 ? &plane->mean_at : &plane->at) = (int64_t)result.words;
        result.words += words[i] * result.pixel_count;
    }
    result.read_words = result.words;
    for (int i = 0; i < EWA_GL_PLANES; i++) {
        if (!made[i] || result.planes[i].at >= 0) continue;
        result.planes[i].at = (int64_t)result.words;
        result.words += words[i] * pixel_count;
    }
    return result;
}

void ewa_gl_result_copy(const ewa_gl_result *result, const uint8_t *words) {
    for (int i = 0; i < EWA_GL_PLANES; i++) {
        const ewa_gl_plane *plane = &result->planes[i];
        const int64_t at = result->finer > 1 ? plane->mean_at : plane->at;
        if (plane->to) memcpy(plane->to, words + (uint64_t)at * sizeof(float), result->pixel_count * plane->words * sizeof(float));
    }
}
