// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The file of an octree put together: regions one after the other in the order of codes, the nodes above as
// soon as all of their parts are there.
#include "lod/assemble.h"

#include <stdlib.h>
#include <string.h>

/// Appends a region's nodes and pages to the file.
static ewa_status take(ewa_lod_builder *b, ewa_region_result *result) {
    ewa_octree_chunk *chunks = result->chunks.data;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < result->chunk_count && status == EWA_OK; i++) {
        status = ewa_octree_append(b->plan.writer, &chunks[i]);
        if ((uint32_t)chunks[i].key.level >= b->stats.level_count)
            b->stats.level_count = (uint32_t)chunks[i].key.level + 1;
    }
    b->stats.node_count += result->chunk_count;
    uint64_t at_bytes = 0;
    EWA_TRY(status);
    EWA_TRY(ewa_spool_put(b->blocks, result->blocks.data, result->blocks_bytes, &at_bytes));
    EWA_TRY(ewa_buffer_grow(b->context, &b->pages, b->page_count, (size_t)b->page_count + result->page_count,
                            sizeof(ewa_levels_page)));
    for (uint32_t i = 0; i < result->page_count; i++) {
        ewa_levels_page *page = (ewa_levels_page *)b->pages.data + b->page_count++;
        *page = ((const ewa_levels_page *)result->pages.data)[i];
        page->at_bytes += at_bytes;
        b->stats.merged_count += page->surfel_count;
    }
    const size_t record_bytes = b->plan.record_bytes;
    for (uint32_t level = 0; level < EWA_CODE_LEVELS; level++) {
        const uint32_t count = result->above_counts[level];
        if (!count) continue;
        EWA_TRY(ewa_buffer_grow(b->context, &b->above[level], b->above_counts[level],
                                (size_t)b->above_counts[level] + count, record_bytes));
        memcpy((uint8_t *)b->above[level].data + b->above_counts[level] * record_bytes,
               result->above[level].data, count * record_bytes);
        b->above_counts[level] += count;
    }
    return EWA_OK;
}

/// Makes the regions [first, end) of the node `key` and the node itself.
static ewa_status make_node(ewa_lod_builder *b, uint32_t first, uint32_t end, uint32_t level,
                            ewa_representatives *representatives, uint64_t *point_count) {
    const ewa_lod_region *regions = b->regions;
    ewa_region_result result = {.chunk_count = 0};
    ewa_status status = EWA_OK;
    *point_count = 0;
    if (end - first == 1 && (uint32_t)regions[first].key.level == level) {
        status = b->get(b, first, &result);
        if (status == EWA_OK) status = take(b, &result);
        *representatives = result.representatives;
        *point_count = regions[first].point_count;
        result.representatives = (ewa_representatives){.count = 0};
        ewa_region_result_free(b->context, &result);
        if (status == EWA_OK) status = ewa_progress(b->context, "octree", (double)end / b->region_count);
        return status;
    }
    ewa_representatives children[8] = {{0}};
    uint32_t child_count = 0;
    const ewa_octree_key key = ewa_code_key(ewa_key_code(&regions[first].key), level);
    for (uint32_t i = first, next; i < end && status == EWA_OK; i = next) {
        const uint64_t prefix = ewa_code_prefix(ewa_key_code(&regions[i].key), level + 1);
        next = i + 1;
        while (next < end && ewa_code_prefix(ewa_key_code(&regions[next].key), level + 1) == prefix) next++;
        uint64_t child_points;
        status = make_node(b, i, next, level + 1, &children[child_count++], &child_points);
        *point_count += child_points;
    }
    if (status == EWA_OK)
        status =
            ewa_region_page(&b->plan, &key, *point_count, children, child_count, &result, representatives);
    if (status == EWA_OK) status = take(b, &result);
    ewa_region_result_free(b->context, &result);
    for (uint32_t i = 0; i < child_count; i++) ewa_representatives_free(b->context, &children[i]);
    return status;
}

static int compare_floats(const void *a, const void *b) {
    const float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

/// The median of what was measured.
static ewa_status find_coverage(ewa_lod_builder *b, double *unit_coverage) {
    const ewa_levels_page *pages = b->pages.data;
    float *values = ewa_allocate(b->context, b->page_count, sizeof *values);
    uint32_t count = 0;
    *unit_coverage = 0;
    if (!values) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < b->page_count; i++)
        if (pages[i].unit_coverage > 0) values[count++] = pages[i].unit_coverage;
    qsort(values, count, sizeof *values, compare_floats);
    if (count) *unit_coverage = (double)values[count / 2];
    ewa_release(b->context, values, b->page_count, sizeof *values);
    return EWA_OK;
}

static int compare_pages(const void *a, const void *b) {
    return ewa_octree_key_compare(&((const ewa_levels_page *)a)->key, &((const ewa_levels_page *)b)->key);
}

/// Writes the record of the pages, their blocks after it.
static ewa_status write_pages(ewa_lod_builder *b) {
    enum { STEP_BYTES = 1 << 20 };
    ewa_levels levels = {
        .pages = b->pages.data, .page_count = b->page_count, .surfel_count = b->stats.merged_count, .has_curvatures = true, .attribute_count = b->plan.attribute_count};
    memcpy(levels.attributes, b->plan.attributes, sizeof levels.attributes);
    EWA_TRY(find_coverage(b, &levels.unit_coverage));
    if (levels.page_count) qsort(levels.pages, levels.page_count, sizeof *levels.pages, compare_pages);
    const size_t table_bytes = EWA_LEVELS_HEAD_BYTES + levels.attribute_count * EWA_LEVELS_ATTRIBUTE_BYTES +
                               (size_t)levels.page_count * EWA_LEVELS_PAGE_BYTES;
    const uint64_t blocks_bytes = ewa_spool_size(b->blocks);
    uint8_t *bytes = ewa_allocate(b->context, table_bytes, 1),
            *step = ewa_allocate(b->context, STEP_BYTES, 1);
    ewa_status status = EWA_OK;
    if (!bytes || !step) status = EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        ewa_levels_write(&levels, bytes);
        status = ewa_octree_levels_begin(b->plan.writer, table_bytes + blocks_bytes);
    }
    if (status == EWA_OK) status = ewa_octree_levels_put(b->plan.writer, bytes, table_bytes);
    for (uint64_t at = 0; at < blocks_bytes && status == EWA_OK; at += STEP_BYTES) {
        const size_t part = blocks_bytes - at < STEP_BYTES ? (size_t)(blocks_bytes - at) : STEP_BYTES;
        status = ewa_spool_get(b->blocks, at, step, part);
        if (status == EWA_OK) status = ewa_octree_levels_put(b->plan.writer, step, part);
    }
    ewa_release(b->context, bytes, table_bytes, 1);
    ewa_release(b->context, step, STEP_BYTES, 1);
    return status;
}

/// Writes the nodes above all regions.
static ewa_status write_above(ewa_lod_builder *b) {
    ewa_status status = EWA_OK;
    for (uint32_t level = 0; level < EWA_CODE_LEVELS && status == EWA_OK; level++) {
        if (!b->above_counts[level]) continue;
        ewa_region_result result = {.chunk_count = 0};
        status = ewa_region_encode(&b->plan, b->above[level].data, b->above_counts[level], level, &result);
        if (status == EWA_OK) status = take(b, &result);
        ewa_region_result_free(b->context, &result);
    }
    return status;
}

ewa_status ewa_lod_prepare(ewa_lod_builder *b, const char *out, ewa_evaluator *evaluator) {
    const ewa_statistics *statistics = b->plan.statistics;
    const ewa_lattice *lattice = &statistics->lattice;
    ewa_octree_plan plan = {.prototype = b->plan.output,
                            .bounds.finite_count = statistics->point_count,
                            .side_world = ewa_lattice_side_world(lattice, 0)};
    plan.spacing_world = plan.side_world / (1 << EWA_PAGE_BITS);
    for (int c = 0; c < 3; c++) {
        plan.low_world[c] = ewa_lattice_world(lattice, c, lattice->low[c]);
        plan.bounds.low_world[c] =
            ewa_lattice_world(lattice, c, statistics->point_count ? statistics->minimum[c] : 0);
        plan.bounds.high_world[c] =
            ewa_lattice_world(lattice, c, statistics->point_count ? statistics->maximum[c] : 0);
    }
    const ewa_status status =
        ewa_evaluator_make(b->context, !ewa_cloud_find(b->plan.inputs, EWA_COLOR), evaluator);
    b->plan.evaluator = evaluator;
    return status == EWA_OK ? ewa_octree_writer_open(b->context, out, &plan, &b->plan.writer) : status;
}

ewa_status ewa_lod_write(ewa_lod_builder *b, const char *out) {
    const ewa_statistics *statistics = b->plan.statistics;
    ewa_evaluator evaluator = {.context = NULL};
    ewa_status status = ewa_lod_prepare(b, out, &evaluator);
    if (status == EWA_OK) status = ewa_spool_open(b->context, out, &b->blocks);
    ewa_representatives representatives = {.count = 0};
    uint64_t point_count;
    if (status == EWA_OK && b->region_count)
        status = make_node(b, 0, b->region_count, 0, &representatives, &point_count);
    ewa_representatives_free(b->context, &representatives);
    if (status == EWA_OK) status = write_above(b);
    if (status == EWA_OK) status = write_pages(b);
    if (status == EWA_OK)
        status = ewa_octree_writer_commit(&b->plan.writer);
    else
        ewa_octree_writer_abort(&b->plan.writer);
    b->stats.point_count = statistics->point_count;
    b->stats.left_out_count = statistics->left_out_count;
    ewa_spool_close(&b->blocks);
    ewa_buffer_free(b->context, &b->pages);
    for (uint32_t level = 0; level < EWA_CODE_LEVELS; level++) ewa_buffer_free(b->context, &b->above[level]);
    ewa_evaluator_free(&evaluator);
    return status;
}
