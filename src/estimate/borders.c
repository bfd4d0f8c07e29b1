// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Borders by place, then by point.
#include "estimate/borders.h"
#include "base/base.h"
#include "cloud/border.h"
#include "cloud/cloud.h"

#include <string.h>

ewa_status ewa_borders_make(ewa_context *context, uint32_t place_count, border_set *made) {
    *made = (border_set){.place_count = place_count};
    made->notes = ewa_allocate_zeroed(context, place_count, sizeof *made->notes);
    made->ends = ewa_allocate(context, place_count, sizeof *made->ends);
    return made->notes && made->ends ? EWA_OK : EWA_ERROR_MEMORY;
}

void ewa_borders_free(ewa_context *context, border_set *set) {
    ewa_release(context, set->notes, set->place_count, sizeof *set->notes);
    ewa_release(context, set->ends, set->place_count, sizeof *set->ends);
}

void ewa_borders_note(border_set *set, uint32_t place, const float to_world[3]) {
    border_end *end = &set->ends[atomic_fetch_add_explicit(&set->end_count, 1, memory_order_relaxed)];
    end->place = place;
    memcpy(end->to_world, to_world, sizeof end->to_world);
    atomic_fetch_or_explicit(&set->notes[place], BORDER_NEAR, memory_order_relaxed);
}

void ewa_borders_ask(border_set *set, uint32_t place) {
    atomic_fetch_or_explicit(&set->notes[place], BORDER_ASKED, memory_order_relaxed);
}

bool ewa_borders_take_asked(border_set *set, uint8_t value, uint8_t *notes) {
    bool any = false;
    if (!set->end_count) return false; // only places near borders ask
    for (uint32_t place = 0; place < set->place_count; place++) {
        const bool asked = set->notes[place] == BORDER_ASKED;
        notes[place] = asked ? value : 0;
        any |= asked;
    }
    return any;
}

ewa_status ewa_borders_add(const border_set *set, const ewa_neighbours *neighbours, const float *tangent_u,
                           const float *tangent_v, ewa_cloud *cloud) {
    static const char *const replaced[] = {EWA_CLIP0, EWA_CLIP1, EWA_CLIP_MODE, EWA_BORDER};
    for (size_t i = 0; i < sizeof replaced / sizeof replaced[0]; i++) ewa_cloud_remove(cloud, replaced[i]);
    if (!set->end_count) return EWA_OK;
    void *data = NULL;
    EWA_TRY(ewa_cloud_add(cloud, tangent_u ? EWA_CLIP0 : EWA_BORDER, EWA_F32, 3, &data));
    float(*out)[3] = data;
    memset(data, 0, sizeof *out * ewa_cloud_point_count(cloud));
    for (uint32_t k = 0; k < set->end_count; k++) {
        const float *to = set->ends[k].to_world;
        uint32_t count;
        const uint32_t *points = ewa_neighbours_points(neighbours, set->ends[k].place, &count);
        for (uint32_t i = 0; i < count; i++) {
            memcpy(out[points[i]], to, sizeof *out);
            if (!tangent_u) continue;
            const float *u = &tangent_u[3 * (size_t)points[i]], *v = &tangent_v[3 * (size_t)points[i]];
            double numbers[3][3], line[3];
            for (int c = 0; c < 3; c++)
                numbers[0][c] = (double)to[c], numbers[1][c] = (double)u[c], numbers[2][c] = (double)v[c];
            ewa_border_line(numbers[0], numbers[1], numbers[2], line);
            for (int c = 0; c < 3; c++) out[points[i]][c] = (float)line[c];
        }
    }
    return EWA_OK;
}
