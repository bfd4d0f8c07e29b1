// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the passes of a frame take by the device's own clock.
#include "gl/times.h"

#include <string.h>

static bool has_clock(void) {
    GLint bits = 0;
    glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
    return bits > 0;
}

void ewa_gl_times_start(ewa_gl_times *times) {
    if (!times->queries[0] && has_clock()) glGenQueries(EWA_GL_MAX_MARKS, times->queries);
    memset(times->seconds, 0, sizeof times->seconds);
}

void ewa_gl_times_resume(ewa_gl_times *times) {
    times->count = 0;
    ewa_gl_times_mark(times, EWA_GL_CULL);
}

void ewa_gl_times_mark(ewa_gl_times *times, ewa_gl_pass pass) {
    if (!times->queries[0]) return;
    if (times->count > 1 && times->passes[times->count - 1] == pass) times->count--; // it goes on
    if (times->count == EWA_GL_MAX_MARKS) return;
    times->passes[times->count] = (uint8_t)pass;
    glQueryCounter(times->queries[times->count++], GL_TIMESTAMP);
}

void ewa_gl_times_read(ewa_gl_times *times) {
    GLuint64 before_ns = 0, now_ns = 0;
    for (uint32_t i = 0; i < times->count; i++, before_ns = now_ns) {
        glGetQueryObjectui64v(times->queries[i], GL_QUERY_RESULT, &now_ns);
        if (i && now_ns > before_ns) times->seconds[times->passes[i]] += 1e-9 * (double)(now_ns - before_ns);
    }
    times->count = 0;
}

void ewa_gl_times_tell(const ewa_gl_times *times, ewa_render_stats *stats) {
    const double *s = times->seconds;
    stats->bin_s += s[EWA_GL_CULL], stats->setup_s = s[EWA_GL_SETUP] + s[EWA_GL_DIVIDE] + s[EWA_GL_FILL];
    stats->visibility_s = s[EWA_GL_VISIBILITY], stats->accumulate_s = s[EWA_GL_SUMS], stats->edge_s = s[EWA_GL_EDGES];
    stats->resolve_s = s[EWA_GL_FIRST_SURFACE] + s[EWA_GL_PICTURE] + s[EWA_GL_EYE_DOME] + s[EWA_GL_AVERAGES];
}

void ewa_gl_times_free(ewa_gl_times *times) {
    if (times->queries[0]) glDeleteQueries(EWA_GL_MAX_MARKS, times->queries);
    memset(times, 0, sizeof *times);
}
