// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the chunks of a LAZ file lie. Nothing is believed that the bytes between the first chunk and the
// table could not hold.
//
// Based on: rapidlasso, "LAZ Specification 1.4", sections on the LASzip record and the chunk table.
#include "base/base.h"
#include "io/las/laz_chunks.h"

#include <string.h>

enum {
    VLR_BYTES = 34, // before the items
    ITEM_BYTES = 6,
    TABLE_HEAD_BYTES = 8,
};

static ewa_status read_record(const ewa_cloud_source *source, const ewa_las_header *header,
                              ewa_laz_layout *layout, uint32_t *chunk_points) {
    ewa_las_vlr vlr;
    if (!ewa_las_find(source, header, EWA_LAZ_VLR_USER, EWA_LAZ_VLR_ID, &vlr) || vlr.size_bytes < VLR_BYTES)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: compressed, but the record of LASzip that says how is missing or cut short",
                        source->name);
    const uint8_t *bytes = vlr.bytes;
    const uint16_t coder = ewa_las_u16(bytes + 2), item_count = ewa_las_u16(bytes + 32);
    layout->packing = ewa_las_u16(bytes);
    layout->version_major = bytes[4];
    layout->version_minor = bytes[5];
    *chunk_points = ewa_bytes_u32(bytes + 12);
    if (layout->packing < EWA_LAZ_POINTWISE || layout->packing > EWA_LAZ_LAYERED || coder != 0)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: compressed by LASzip's compressor %u with coder %u; compressors 1 to 3 with "
                        "coder 0 are read",
                        source->name, layout->packing, coder);
    if (item_count == 0 || item_count > EWA_LAZ_MAX_ITEMS ||
        (vlr.size_bytes - VLR_BYTES) / ITEM_BYTES < item_count)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: LASzip's record counts %u items; 1 to %d, and %llu fit into it", source->name,
                        item_count, EWA_LAZ_MAX_ITEMS,
                        (unsigned long long)((vlr.size_bytes - VLR_BYTES) / ITEM_BYTES));
    layout->plan.item_count = item_count;
    for (uint32_t i = 0; i < item_count; i++) {
        const uint8_t *item = bytes + VLR_BYTES + i * ITEM_BYTES;
        layout->plan.items[i] =
            (ewa_laz_item){ewa_las_u16(item), ewa_las_u16(item + 2), ewa_las_u16(item + 4)};
    }
    return EWA_OK;
}

/// Checks that the items are those of the point format and of this kind of container.
static ewa_status check_plan(const ewa_cloud_source *source, const ewa_las_header *header,
                             ewa_laz_layout *layout) {
    const char *fault = ewa_laz_plan_check(&layout->plan);
    const uint16_t first = layout->plan.items[0].type;
    if (!fault && layout->plan.layered != (layout->packing == EWA_LAZ_LAYERED))
        fault = layout->plan.layered ? "layered items in chunks without layers"
                                     : "items without layers in layered chunks";
    if (!fault && layout->plan.record_bytes != header->record_bytes)
        fault = "the items are not as long together as the header says of a record";
    if (!fault && first != (header->point_format < 6 ? EWA_LAZ_POINT10 : EWA_LAZ_POINT14))
        fault = "the first item is not of the header's point format";
    if (!fault) return EWA_OK;
    return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: LASzip's record: %s", source->name, fault);
}

/// Makes room for chunks.
static ewa_status make_chunks(ewa_context *context, ewa_laz_layout *layout, uint64_t count) {
    layout->chunks = ewa_allocate_zeroed(context, count, sizeof *layout->chunks);
    layout->at_bytes = layout->chunks ? ewa_allocate_zeroed(context, count, sizeof *layout->at_bytes) : NULL;
    layout->chunk_count = count;
    return layout->at_bytes ? EWA_OK : EWA_ERROR_MEMORY;
}

/// All points in one chunk without a table, which ends where the extended records begin, or the file.
static ewa_status read_single(const ewa_cloud_source *source, const ewa_las_header *header, uint64_t at,
                              ewa_laz_layout *layout) {
    EWA_TRY(make_chunks(source->context, layout, 1));
    const bool ends_before = header->evlr_count && header->evlrs_at >= at;
    const uint64_t end =
        ends_before && header->evlrs_at < source->size_bytes ? header->evlrs_at : source->size_bytes;
    layout->chunks[0] = (ewa_laz_chunk){header->point_count, end - at};
    return EWA_OK;
}

/// Finds the table's byte; 0 when there is none within the file.
static ewa_status find_table(const ewa_cloud_source *source, const ewa_las_header *header, uint64_t *table_at) {
    const uint64_t first = header->points_at + 8, size_bytes = source->size_bytes;
    const uint8_t *bytes;
    *table_at = 0;
    if (size_bytes < first) return EWA_OK;
    EWA_TRY(ewa_cloud_need(source, header->points_at, 8, &bytes));
    uint64_t at = ewa_las_u64(bytes);
    // Who could not go back has written it into the last 8 bytes.
    if (at == UINT64_MAX || at < first) {
        EWA_TRY(ewa_cloud_need(source, size_bytes - 8, 8, &bytes));
        at = ewa_las_u64(bytes);
    }
    if (at >= first && at <= size_bytes && size_bytes - at >= TABLE_HEAD_BYTES) *table_at = at;
    return EWA_OK;
}

/// Reads the table at byte `table_at`.
static ewa_status read_table(const ewa_cloud_source *source, const ewa_las_header *header, uint64_t table_at,
                             ewa_laz_layout *layout) {
    const uint8_t *head, *entries;
    EWA_TRY(ewa_cloud_need(source, table_at, TABLE_HEAD_BYTES, &head));
    const uint32_t version = ewa_bytes_u32(head), count = ewa_bytes_u32(head + 4);
    // Each chunk begins with a whole record.
    const uint64_t maximum = (table_at - header->points_at - 8) / header->record_bytes;
    if (version != 0 || count > maximum)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: the table of chunks at byte %llu has version %u and counts %u chunks; %llu fit "
                        "before it",
                        source->name, (unsigned long long)table_at, version, count,
                        (unsigned long long)maximum);
    EWA_TRY(make_chunks(source->context, layout, count));
    if (count == 0) return EWA_OK;
    // Two numbers of 32 bits a chunk, and what begins and ends their code, take no more.
    const uint64_t left_bytes = source->size_bytes - table_at - TABLE_HEAD_BYTES, max_bytes = 16 * (uint64_t)count + 64;
    const uint64_t entry_bytes = left_bytes < max_bytes ? left_bytes : max_bytes;
    EWA_TRY(ewa_cloud_need(source, table_at + TABLE_HEAD_BYTES, entry_bytes, &entries));
    const char *fault = ewa_laz_table_decode(entries, entry_bytes, count, layout->variable, layout->chunks);
    if (fault)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the table of %u chunks at byte %llu: %s",
                        source->name, count, (unsigned long long)table_at, fault);
    return EWA_OK;
}

/// Gives each chunk of a file of equal ones its points; chunks beyond the last point are left out.
static ewa_status share_points(const ewa_cloud_source *source, uint64_t point_count, uint32_t chunk_points,
                               ewa_laz_layout *layout) {
    if (chunk_points == 0)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: LASzip's record: chunks of 0 points",
                        source->name);
    const uint64_t wanted = point_count / chunk_points + (point_count % chunk_points != 0);
    uint64_t left = point_count;
    layout->point_count = 0;
    for (uint64_t i = 0; i < layout->chunk_count; i++) {
        layout->chunks[i].point_count = left < chunk_points ? left : chunk_points;
        left -= layout->chunks[i].point_count;
    }
    if (wanted <= layout->chunk_count) return EWA_OK;
    return ewa_cloud_damage(source, left,
                            "%s: %llu points in chunks of %u need %llu chunks, the table has %llu",
                            source->name, (unsigned long long)point_count, chunk_points,
                            (unsigned long long)wanted, (unsigned long long)layout->chunk_count);
}

/// Places the chunks one after the other up to byte `end`, and counts their points.
static ewa_status place_chunks(const ewa_cloud_source *source, uint64_t at, uint64_t end,
                               ewa_laz_layout *layout) {
    layout->point_count = 0;
    for (uint64_t i = 0; i < layout->chunk_count; i++) {
        ewa_laz_chunk *chunk = &layout->chunks[i];
        layout->at_bytes[i] = at;
        if (chunk->size_bytes > end - at)
            return ewa_fail(source->context, EWA_ERROR_FORMAT,
                            "%s: chunk %llu of %llu has %llu bytes from byte %llu on; chunks end at %llu",
                            source->name, (unsigned long long)i + 1, (unsigned long long)layout->chunk_count,
                            (unsigned long long)chunk->size_bytes, (unsigned long long)at,
                            (unsigned long long)end);
        if (chunk->point_count / EWA_LAZ_MAX_POINTS_PER_BYTE > chunk->size_bytes)
            return ewa_fail(source->context, EWA_ERROR_FORMAT,
                            "%s: chunk %llu of %llu is said to hold %llu points in %llu bytes", source->name,
                            (unsigned long long)i + 1, (unsigned long long)layout->chunk_count,
                            (unsigned long long)chunk->point_count, (unsigned long long)chunk->size_bytes);
        const uint64_t max_bytes = ewa_context_limits(source->context)->max_memory_bytes;
        if (chunk->point_count > max_bytes / layout->plan.record_bytes)
            return ewa_fail(source->context, EWA_ERROR_LIMIT,
                            "%s: chunk %llu of %llu, %llu points, is over the limit of %llu bytes",
                            source->name, (unsigned long long)i + 1, (unsigned long long)layout->chunk_count,
                            (unsigned long long)chunk->point_count, (unsigned long long)max_bytes);
        at += chunk->size_bytes;
        layout->point_count += chunk->point_count;
    }
    return EWA_OK;
}

/// Holds the sum of chunks that count for themselves to the header.
static ewa_status compare_counts(const ewa_cloud_source *source, const ewa_las_header *header,
                                 const ewa_laz_layout *layout) {
    const uint64_t said = header->point_count, there = layout->point_count;
    if (said == there) return EWA_OK;
    if (said == 0) {
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: the header counts no points, the chunks hold %llu", source->name,
                   (unsigned long long)there);
        return EWA_OK;
    }
    return ewa_cloud_damage(source, said > there ? said - there : 0,
                            "%s: the header counts %llu points, the chunks hold %llu", source->name,
                            (unsigned long long)said, (unsigned long long)there);
}

ewa_status ewa_laz_layout_read(const ewa_cloud_source *source, const ewa_las_header *header,
                               ewa_laz_layout *layout) {
    *layout = (ewa_laz_layout){0};
    uint32_t chunk_points = 0;
    EWA_TRY(read_record(source, header, layout, &chunk_points));
    EWA_TRY(check_plan(source, header, layout));
    const bool pointwise = layout->packing == EWA_LAZ_POINTWISE;
    layout->variable = !pointwise && chunk_points == EWA_LAZ_VARIABLE;
    if (header->point_count == 0 && !layout->variable) return EWA_OK;
    uint64_t table_at = 0;
    if (!pointwise) EWA_TRY(find_table(source, header, &table_at));
    const uint64_t first = pointwise ? header->points_at : header->points_at + 8;
    const bool walkable = layout->variable ? layout->plan.layered : chunk_points > 0;
    if (!pointwise && table_at == 0 && walkable && source->options->keep_going) {
        EWA_TRY(ewa_laz_layout_rebuild(source, first, header->point_count, chunk_points, layout));
        return place_chunks(source, first, source->size_bytes, layout);
    }
    if (pointwise || (table_at == 0 && !layout->variable && header->point_count <= chunk_points &&
                      source->size_bytes > first)) {
        EWA_TRY(read_single(source, header, first, layout));
        return place_chunks(source, first, source->size_bytes, layout);
    }
    if (table_at == 0)
        return ewa_cloud_damage(source, header->point_count,
                                "%s: the table of chunks, which says where the %llu points are, is missing: "
                                "the file is cut short or was never finished",
                                source->name, (unsigned long long)header->point_count);
    ewa_status status = read_table(source, header, table_at, layout);
    if (status == EWA_OK && !layout->variable)
        status = share_points(source, header->point_count, chunk_points, layout);
    if (status == EWA_OK) status = place_chunks(source, first, table_at, layout);
    return status == EWA_OK && layout->variable ? compare_counts(source, header, layout) : status;
}

void ewa_laz_layout_free(ewa_context *context, ewa_laz_layout *layout) {
    ewa_release(context, layout->chunks, layout->chunk_count, sizeof *layout->chunks);
    ewa_release(context, layout->at_bytes, layout->chunk_count, sizeof *layout->at_bytes);
    *layout = (ewa_laz_layout){0};
}
