// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is written before the points of every LAS file: the public header, and the record of LASzip.
#include "io/las/las_write.h"
#include "io/las/laz_chunks.h"

#include <stdio.h>
#include <string.h>

uint16_t ewa_las_head_make(const ewa_las_plan *plan, const ewa_cloud *prototype, const ewa_las_head *said,
                           uint8_t head[EWA_LAS_HEAD_14_BYTES]) {
    const uint16_t head_bytes = plan->version_minor >= 4 ? EWA_LAS_HEAD_14_BYTES : EWA_LAS_HEAD_BYTES;
    const char *system = ewa_cloud_note(prototype, "file.system", NULL);
    memset(head, 0, EWA_LAS_HEAD_14_BYTES);
    memcpy(head, "LASF", 4);
    ewa_las_put_u16(head + 6, plan->global_encoding);
    head[24] = 1;
    head[25] = plan->version_minor;
    memcpy(head + 26, system ? system : "OTHER", strnlen(system ? system : "OTHER", 32));
    snprintf((char *)head + 58, 32, "ewa %s", ewa_version());
    ewa_las_put_u16(head + 94, head_bytes);
    ewa_las_put_u32(head + 96, (uint32_t)said->points_at);
    ewa_las_put_u32(head + 100, said->vlr_count);
    head[104] = (uint8_t)(plan->point_format | (plan->compressed ? 0x80 : 0));
    ewa_las_put_u16(head + 105, (uint16_t)plan->table.record_bytes);
    // The fields of 32 bits stay 0 where the format is newer than they are, or the number too large.
    if (plan->point_format < 6 && said->point_count <= UINT32_MAX) {
        ewa_las_put_u32(head + 107, (uint32_t)said->point_count);
        for (int r = 1; r <= 5; r++) ewa_las_put_u32(head + 107 + 4 * r, (uint32_t)said->sums->by_return[r]);
    }
    for (int c = 0; c < 3; c++) {
        const double scale = plan->table.scale[c], offset = plan->offset_world[c];
        const bool empty = said->sums->low[c] > said->sums->high[c];
        ewa_las_put_f64(head + 131 + 8 * c, scale);
        ewa_las_put_f64(head + 155 + 8 * c, offset);
        ewa_las_put_f64(head + 179 + 16 * c, empty ? 0 : offset + said->sums->high[c] * scale);
        ewa_las_put_f64(head + 187 + 16 * c, empty ? 0 : offset + said->sums->low[c] * scale);
    }
    if (plan->version_minor >= 4) {
        ewa_las_put_u64(head + 235, said->evlrs_at);
        ewa_las_put_u32(head + 243, said->evlr_count);
        ewa_las_put_u64(head + 247, said->point_count);
        for (int r = 1; r <= EWA_LAS_RETURNS; r++)
            ewa_las_put_u64(head + 247 + 8 * r, said->sums->by_return[r]);
    }
    return head_bytes;
}

ewa_status ewa_las_laz_record_append(ewa_context *context, const ewa_laz_plan *laz, uint32_t chunk_points,
                                     ewa_buffer *records, size_t *at_bytes) {
    enum { HEAD_BYTES = 34, ITEM_BYTES = 6 };
    uint8_t bytes[HEAD_BYTES + ITEM_BYTES * EWA_LAZ_MAX_ITEMS] = {0};
    ewa_las_put_u16(bytes, laz->layered ? EWA_LAZ_LAYERED : EWA_LAZ_CHUNKED);
    bytes[4] = laz->layered ? 3 : 2;
    bytes[5] = laz->layered ? 4 : 2;
    ewa_las_put_u32(bytes + 12, chunk_points);
    ewa_las_put_u64(bytes + 16, UINT64_MAX); // special records: none
    ewa_las_put_u64(bytes + 24, UINT64_MAX);
    ewa_las_put_u16(bytes + 32, (uint16_t)laz->item_count);
    for (uint32_t i = 0; i < laz->item_count; i++) {
        uint8_t *item = bytes + HEAD_BYTES + i * ITEM_BYTES;
        ewa_las_put_u16(item, laz->items[i].type);
        ewa_las_put_u16(item + 2, laz->items[i].size_bytes);
        ewa_las_put_u16(item + 4, laz->items[i].version);
    }
    return ewa_las_record_append(context, EWA_LAZ_VLR_USER, EWA_LAZ_VLR_ID, "by ewa", bytes,
                                 HEAD_BYTES + ITEM_BYTES * laz->item_count, records, at_bytes);
}
