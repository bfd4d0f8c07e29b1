// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How fast segments are clipped: random ones, most of which cross the view volume.
#include "bench/clip.h"

#include <stdlib.h>

enum { COORDINATES = 8, ALPHAS = 4, ENDS = 16, CALLS_PER_RUN = 64 };

/// A number in [-2, 2) from a linear congruential generator.
static float random_coordinate(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * 0x1p-22f - 2;
}

ewa_status bench_clip(ewa_context *context, double *run_s, int run_count) {
    const size_t count = BENCH_CLIP_SEGMENTS;
    float *numbers = malloc((COORDINATES + ALPHAS + ENDS) * count * sizeof *numbers);
    uint8_t *visible = malloc(count);
    ewa_status status = numbers && visible ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        uint32_t state = 1;
        for (size_t i = 0; i < COORDINATES * count; i++) numbers[i] = random_coordinate(&state);
        ewa_segment_batch segments = {.count = count};
        ewa_segment_clips clips = {.visible = visible};
        float *next = numbers;
        for (int k = 0; k < COORDINATES; k++, next += count) segments.end[k / 4][k % 4] = next;
        for (int k = 0; k < ALPHAS; k++, next += count) clips.alpha[k / 2][k % 2] = next;
        for (int k = 0; k < ENDS; k++, next += count) clips.end[k / 8][k / 4 % 2][k % 4] = next;
        for (int run = -1; run < run_count && status == EWA_OK; run++) { // run -1 warms up
            const double started_s = clock_now_s();
            for (int call = 0; call < CALLS_PER_RUN && status == EWA_OK; call++)
                status = ewa_clip_segments(context, &segments, &clips);
            if (run >= 0) run_s[run] = (clock_now_s() - started_s) / CALLS_PER_RUN;
        }
    }
    free(visible);
    free(numbers);
    return status;
}
