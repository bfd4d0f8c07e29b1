// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the set-up of a band asks the host for.
#include "gl/host_records.h"

#include <string.h>

ewa_status ewa_gl_host_records_reserve(ewa_context *context, ewa_gl_host_records *host_records, uint32_t near_count,
                                       uint32_t clip_count) {
    host_records->near_count = near_count, host_records->clip_count = clip_count;
    EWA_TRY(ewa_buffer_reserve(context, &host_records->requests, (size_t)near_count + clip_count, sizeof(ewa_gl_host_request)));
    EWA_TRY(ewa_buffer_reserve(context, &host_records->nears, near_count, sizeof(ewa_gl_near)));
    return ewa_buffer_reserve(context, &host_records->clips, clip_count, sizeof(ewa_gl_clip));
}

static ewa_tile field_tile(const ewa_tile_job *job, const ewa_gl_host_request *request) {
    return (ewa_tile){.x_px = (int32_t)((request->field & 0xffff) * EWA_FIELD_PX),
                      .y_px = (int32_t)((request->field >> 16) * EWA_FIELD_PX),
                      .field_x_px = -EWA_FIELD_PX / 2,
                      .field_y_px = -EWA_FIELD_PX / 2,
                      .with_opacity = job->with_opacity,
                      .with_materials = job->with_materials};
}

ewa_status ewa_gl_host_records_make(ewa_context *context, ewa_gl_host_records *host_records, const ewa_tile_job *job,
                                    uint32_t first_field_row, uint32_t field_rows) {
    const uint32_t columns = job->tiles.columns, fields = columns * field_rows;
    EWA_TRY(ewa_buffer_reserve(context, &host_records->ranges, fields, 2 * sizeof(uint32_t)));
    host_records->field_count = fields;
    uint32_t(*ranges)[2] = host_records->ranges.data;
    memset(ranges, 0, fields * sizeof *ranges);
    const ewa_gl_host_request *requests = host_records->requests.data;
    for (uint32_t i = 0; i < host_records->near_count; i++)
        ranges[((requests[i].field >> 16) - first_field_row) * columns + (requests[i].field & 0xffff)][1]++;
    for (uint32_t i = 0, first = 0; i < fields; i++) {
        const uint32_t here = ranges[i][1];
        ranges[i][0] = ranges[i][1] = first;
        first += here;
    }
    ewa_gl_near *nears = host_records->nears.data;
    for (uint32_t i = 0; i < host_records->near_count; i++) {
        const ewa_tile_source *source = &job->sources[requests[i].source];
        const ewa_tile tile = field_tile(job, &requests[i]);
        ewa_near_record record;
        if (!ewa_near_record_set(&record, source->surfels, requests[i].surfel, &source->view, &tile)) continue;
        uint32_t *range = ranges[((requests[i].field >> 16) - first_field_row) * columns + (requests[i].field & 0xffff)];
        ewa_gl_near_set(&nears[range[1]++], &record, requests[i].source);
    }
    ewa_gl_clip *clips = host_records->clips.data;
    for (uint32_t i = 0; i < host_records->clip_count; i++) {
        const ewa_gl_host_request *request = &requests[host_records->near_count + i];
        const ewa_tile_source *source = &job->sources[request->source];
        const ewa_tile tile = field_tile(job, request);
        ewa_clip clip;
        ewa_clip_set(&clip, source->surfels, request->surfel, &source->view, &tile);
        ewa_gl_clip_set(&clips[i], &clip);
    }
    return EWA_OK;
}

void ewa_gl_host_records_free(ewa_context *context, ewa_gl_host_records *host_records) {
    ewa_buffer_free(context, &host_records->requests);
    ewa_buffer_free(context, &host_records->nears);
    ewa_buffer_free(context, &host_records->ranges);
    ewa_buffer_free(context, &host_records->clips);
}
