// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the set-up of a band asks the host for.
#include "gl/answers.h"

#include <string.h>

ewa_status ewa_gl_answers_reserve(ewa_context *context, ewa_gl_answers *answers, uint32_t near_count,
                                  uint32_t clip_count) {
    answers->near_count = near_count, answers->clip_count = clip_count;
    EWA_TRY(ewa_buffer_reserve(context, &answers->asks, (size_t)near_count + clip_count, sizeof(ewa_gl_ask)));
    EWA_TRY(ewa_buffer_reserve(context, &answers->nears, near_count, sizeof(ewa_gl_near)));
    return ewa_buffer_reserve(context, &answers->clips, clip_count, sizeof(ewa_gl_clip));
}

static ewa_tile field_tile(const ewa_tile_job *job, const ewa_gl_ask *ask) {
    return (ewa_tile){.x_px = (int32_t)((ask->field & 0xffff) * EWA_FIELD_PX),
                      .y_px = (int32_t)((ask->field >> 16) * EWA_FIELD_PX),
                      .field_x_px = -EWA_FIELD_PX / 2,
                      .field_y_px = -EWA_FIELD_PX / 2,
                      .with_opacity = job->with_opacity,
                      .with_materials = job->with_materials};
}

ewa_status ewa_gl_answers_make(ewa_context *context, ewa_gl_answers *answers, const ewa_tile_job *job,
                               uint32_t first_field_row, uint32_t field_rows) {
    const uint32_t columns = job->tiles.columns, fields = columns * field_rows;
    EWA_TRY(ewa_buffer_reserve(context, &answers->ranges, fields, 2 * sizeof(uint32_t)));
    answers->field_count = fields;
    uint32_t(*ranges)[2] = answers->ranges.data;
    memset(ranges, 0, fields * sizeof *ranges);
    const ewa_gl_ask *asks = answers->asks.data;
    for (uint32_t i = 0; i < answers->near_count; i++)
        ranges[((asks[i].field >> 16) - first_field_row) * columns + (asks[i].field & 0xffff)][1]++;
    for (uint32_t i = 0, first = 0; i < fields; i++) {
        const uint32_t here = ranges[i][1];
        ranges[i][0] = ranges[i][1] = first;
        first += here;
    }
    ewa_gl_near *nears = answers->nears.data;
    for (uint32_t i = 0; i < answers->near_count; i++) {
        const ewa_tile_source *source = &job->sources[asks[i].source];
        const ewa_tile tile = field_tile(job, &asks[i]);
        ewa_near_record record;
        if (!ewa_near_record_set(&record, source->surfels, asks[i].surfel, &source->view, &tile)) continue;
        uint32_t *range = ranges[((asks[i].field >> 16) - first_field_row) * columns + (asks[i].field & 0xffff)];
        ewa_gl_near_set(&nears[range[1]++], &record, asks[i].source);
    }
    ewa_gl_clip *clips = answers->clips.data;
    for (uint32_t i = 0; i < answers->clip_count; i++) {
        const ewa_gl_ask *ask = &asks[answers->near_count + i];
        const ewa_tile_source *source = &job->sources[ask->source];
        const ewa_tile tile = field_tile(job, ask);
        ewa_clip clip;
        ewa_clip_set(&clip, source->surfels, ask->surfel, &source->view, &tile);
        ewa_gl_clip_set(&clips[i], &clip);
    }
    return EWA_OK;
}

void ewa_gl_answers_free(ewa_context *context, ewa_gl_answers *answers) {
    ewa_buffer_free(context, &answers->asks);
    ewa_buffer_free(context, &answers->nears);
    ewa_buffer_free(context, &answers->ranges);
    ewa_buffer_free(context, &answers->clips);
}
