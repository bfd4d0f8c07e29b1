// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of an octree that were made by themselves, on any machine of the same byte order: what is known of the whole, and the
// results of some regions. A part's sections: what it is; the statistics; the prototype; all regions; then
// one for each region that was made.
#include "lod/part.h"
#include "io/sections.h"

#include <stdlib.h>
#include <string.h>

enum {
    HEAD = 1,
    STATISTICS = 2,
    PROTOTYPE = 3,
    REGIONS = 4,
    RESULT = 5,
    COMMON_SECTIONS = 3,
    PART_VERSION = 4,
    ATTRIBUTES_BYTES = EWA_LEVELS_MAX_ATTRIBUTES * (EWA_NAME_BYTES + 1) // of names, a comma between them
};

/// The first section.
typedef struct part_head {
    char magic[8];
    uint32_t version, representative_bytes, page_bytes, sums_bytes; // of structs that are stored as they are
    uint32_t subset, subset_count;
} part_head;

static part_head make_head(uint32_t subset, uint32_t subset_count) {
    return (part_head){
        "EWAPART", PART_VERSION, sizeof(ewa_representative), sizeof(ewa_levels_page), sizeof(ewa_octree_sums),
        subset,    subset_count};
}

static ewa_status put_statistics(ewa_context *context, const ewa_statistics *statistics, ewa_section *to) {
    EWA_TRY(ewa_section_put(context, to, &statistics->lattice, sizeof statistics->lattice));
    const uint64_t numbers[4] = {statistics->point_count, statistics->left_out_count,
                                 statistics->column_count, statistics->record_bytes};
    EWA_TRY(ewa_section_put(context, to, numbers, sizeof numbers));
    EWA_TRY(ewa_section_put(context, to, statistics->minimum, sizeof statistics->minimum));
    EWA_TRY(ewa_section_put(context, to, statistics->maximum, sizeof statistics->maximum));
    return ewa_section_put(context, to, statistics->columns,
                           statistics->column_count * sizeof *statistics->columns);
}

/// Puts what points and representatives have.
static ewa_status put_prototype(const ewa_region_plan *plan, ewa_section *to) {
    ewa_context *context = plan->context;
    const ewa_cloud *cloud = plan->inputs;
    const uint32_t count = ewa_cloud_attribute_count(cloud);
    EWA_TRY(ewa_section_put(context, to, &count, sizeof count));
    for (uint32_t a = 0; a < count; a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(cloud, a);
        const uint32_t shape[2] = {(uint32_t)attribute->type, attribute->component_count};
        EWA_TRY(ewa_section_put(context, to, attribute->name, EWA_NAME_BYTES));
        EWA_TRY(ewa_section_put(context, to, shape, sizeof shape));
    }
    uint32_t note_count = 0;
    while (ewa_cloud_note_name(cloud, note_count)) note_count++;
    EWA_TRY(ewa_section_put(context, to, &note_count, sizeof note_count));
    for (uint32_t n = 0; n < note_count; n++) {
        char name[EWA_NAME_BYTES] = {0};
        strncpy(name, ewa_cloud_note_name(cloud, n), sizeof name - 1);
        size_t size = 0;
        const char *bytes = ewa_cloud_note(cloud, name, &size);
        const uint64_t note_bytes = size;
        EWA_TRY(ewa_section_put(context, to, name, sizeof name));
        EWA_TRY(ewa_section_put(context, to, &note_bytes, sizeof note_bytes));
        EWA_TRY(ewa_section_put(context, to, bytes, size));
    }
    char names[ATTRIBUTES_BYTES] = "";
    for (uint32_t a = 0; a < plan->attribute_count; a++)
        strcat(strcat(names, a ? "," : ""), plan->attributes[a].name);
    return ewa_section_put(context, to, names, sizeof names);
}

static ewa_status put_chunks(ewa_context *context, const ewa_region_result *result, ewa_section *to) {
    const ewa_octree_chunk *chunks = result->chunks.data;
    EWA_TRY(ewa_section_put(context, to, &result->chunk_count, sizeof result->chunk_count));
    for (uint32_t i = 0; i < result->chunk_count; i++) {
        const ewa_octree_chunk *chunk = &chunks[i];
        const uint64_t size_bytes = chunk->size_bytes;
        EWA_TRY(ewa_section_put(context, to, &chunk->key, sizeof chunk->key));
        EWA_TRY(ewa_section_put(context, to, &chunk->point_count, sizeof chunk->point_count));
        EWA_TRY(ewa_section_put(context, to, &chunk->sums, sizeof chunk->sums));
        EWA_TRY(ewa_section_put(context, to, &size_bytes, sizeof size_bytes));
        EWA_TRY(ewa_section_put(context, to, chunk->bytes.data, chunk->size_bytes));
    }
    return EWA_OK;
}

static ewa_status put_result(ewa_context *context, const ewa_region_result *result, uint32_t region,
                             uint32_t record_bytes, ewa_section *to) {
    const uint64_t blocks_bytes = result->blocks_bytes;
    EWA_TRY(ewa_section_put(context, to, &region, sizeof region));
    EWA_TRY(put_chunks(context, result, to));
    EWA_TRY(ewa_section_put(context, to, &result->page_count, sizeof result->page_count));
    EWA_TRY(ewa_section_put(context, to, result->pages.data, result->page_count * sizeof(ewa_levels_page)));
    EWA_TRY(ewa_section_put(context, to, &blocks_bytes, sizeof blocks_bytes));
    EWA_TRY(ewa_section_put(context, to, result->blocks.data, result->blocks_bytes));
    for (uint32_t level = 0; level < EWA_CODE_LEVELS; level++) {
        const uint32_t count = result->above_counts[level];
        EWA_TRY(ewa_section_put(context, to, &count, sizeof count));
        EWA_TRY(ewa_section_put(context, to, result->above[level].data, (size_t)count * record_bytes));
    }
    const ewa_representatives *representatives = &result->representatives;
    const float drawn[2] = {representatives->radius_scale, representatives->unit_coverage};
    EWA_TRY(ewa_section_put(context, to, &representatives->count, sizeof representatives->count));
    EWA_TRY(ewa_section_put(context, to, drawn, sizeof drawn));
    EWA_TRY(ewa_section_put(context, to, representatives->items,
                            representatives->count * sizeof *representatives->items));
    return ewa_section_put(context, to, representatives->numbers,
                           (size_t)representatives->count * representatives->number_count *
                               sizeof *representatives->numbers);
}

/// Writes what all parts have in common.
static ewa_status write_common(ewa_lod_builder *b, ewa_writer *writer, uint32_t subset,
                               uint32_t subset_count) {
    ewa_section section = {.size_bytes = 0};
    const part_head head = make_head(subset, subset_count);
    ewa_status status = ewa_section_put(b->context, &section, &head, sizeof head);
    if (status == EWA_OK) status = ewa_section_write(writer, HEAD, &section);
    if (status == EWA_OK) status = put_statistics(b->context, b->plan.statistics, &section);
    if (status == EWA_OK) status = ewa_section_write(writer, STATISTICS, &section);
    if (status == EWA_OK) status = put_prototype(&b->plan, &section);
    if (status == EWA_OK) status = ewa_section_write(writer, PROTOTYPE, &section);
    if (status == EWA_OK)
        status = ewa_section_put(b->context, &section, b->regions, b->region_count * sizeof *b->regions);
    if (status == EWA_OK) status = ewa_section_write(writer, REGIONS, &section);
    ewa_section_free(b->context, &section);
    return status;
}

ewa_status ewa_lod_part_write(ewa_lod_builder *b, const char *out, uint32_t subset, uint32_t subset_count) {
    ewa_writer *writer = NULL;
    ewa_evaluator evaluator = {.context = NULL};
    ewa_section section = {.size_bytes = 0};
    ewa_status status =
        ewa_lod_prepare(b, out, &evaluator); // chunks have the form of the file that they will be in
    if (status == EWA_OK) status = ewa_writer_open(b->context, out, &writer);
    if (status == EWA_OK) status = write_common(b, writer, subset, subset_count);
    for (uint32_t i = subset; i < b->region_count && status == EWA_OK; i += subset_count) {
        ewa_region_result result = {.chunk_count = 0};
        status = b->get(b, i, &result);
        if (status == EWA_OK) status = put_result(b->context, &result, i, b->plan.record_bytes, &section);
        if (status == EWA_OK) status = ewa_section_write(writer, RESULT, &section);
        b->stats.point_count += b->regions[i].point_count;
        b->stats.node_count += result.chunk_count;
        ewa_region_result_free(b->context, &result);
        if (status == EWA_OK) status = ewa_progress(b->context, "octree", (double)(i + 1) / b->region_count);
    }
    ewa_section_free(b->context, &section);
    ewa_octree_writer_abort(&b->plan.writer);
    ewa_evaluator_free(&evaluator);
    if (status == EWA_OK)
        status = ewa_writer_commit(&writer);
    else
        ewa_writer_abort(&writer);
    return status;
}

/// One part that is read.
typedef struct open_part {
    const char *path;
    ewa_file file;
    part_head head;
    ewa_section_view common[COMMON_SECTIONS];
    ewa_section_view results; ///< the rest of the file
} open_part;

/// A builder whose regions are fetched from parts.
typedef struct part_builder {
    ewa_lod_builder base;
    open_part *parts; ///< by subset
    uint32_t part_count;
    ewa_section_view *results; ///< [region]
    ewa_statistics statistics;
    ewa_cloud *inputs;
    ewa_lod_region *regions;
} part_builder;

static ewa_status fail_part(ewa_context *context, const open_part *part, const char *fault) {
    return ewa_fail(context, EWA_ERROR_FORMAT, "%s: no part of an octree: %s", part->path, fault);
}

static ewa_status open_part_file(ewa_context *context, const char *path, open_part *part) {
    part->path = path;
    EWA_TRY(ewa_file_map(context, path, &part->file));
    ewa_section_view file = {part->file.bytes, part->file.size_bytes};
    for (uint32_t i = 0; i <= COMMON_SECTIONS; i++) {
        ewa_section_view section;
        const char *fault;
        uint32_t tag;
        if (!ewa_section_next(&file, &tag, &section, &fault))
            return fail_part(context, part, fault ? fault : "it is too short");
        if (tag != HEAD + i) return fail_part(context, part, "its sections are others");
        if (i > 0) {
            part->common[i - 1] = section;
            continue;
        }
        const bool whole = ewa_section_take(&section, &part->head, sizeof part->head);
        const part_head known = make_head(part->head.subset, part->head.subset_count);
        if (!whole || memcmp(&known, &part->head, sizeof known) != 0 || known.subset >= known.subset_count)
            return fail_part(context, part, "it is of another program or version");
    }
    part->results = file;
    return EWA_OK;
}

/// Whether what was copied into a truth value is one.
static bool is_truth(const bool *copied) {
    uint8_t byte;
    memcpy(&byte, copied, sizeof byte);
    return byte <= 1;
}

/// Reads what is known of all points.
static bool take_statistics(ewa_context *context, ewa_section_view from, ewa_statistics *statistics,
                            ewa_status *status) {
    enum { MAX_COLUMNS = 4096, MAX_RECORD_BYTES = 1 << 16 };
    uint64_t numbers[4];
    bool good = ewa_section_take(&from, &statistics->lattice, sizeof statistics->lattice) &&
                ewa_section_take(&from, numbers, sizeof numbers) &&
                ewa_section_take(&from, statistics->minimum, sizeof statistics->minimum) &&
                ewa_section_take(&from, statistics->maximum, sizeof statistics->maximum);
    if (!good || statistics->lattice.bits > EWA_LATTICE_BITS || !(statistics->lattice.step_world > 0) ||
        numbers[2] > MAX_COLUMNS || numbers[3] > MAX_RECORD_BYTES)
        return false;
    statistics->point_count = numbers[0], statistics->left_out_count = numbers[1];
    statistics->column_count = (uint32_t)numbers[2], statistics->record_bytes = (uint32_t)numbers[3];
    statistics->columns = ewa_allocate(context, statistics->column_count, sizeof *statistics->columns);
    if (!statistics->columns) *status = EWA_ERROR_MEMORY;
    if (!statistics->columns ||
        !ewa_section_take(&from, statistics->columns, statistics->column_count * sizeof *statistics->columns))
        return false;
    for (uint32_t k = 0; k < statistics->column_count; k++) {
        const ewa_statistics_column *column = &statistics->columns[k];
        good = good && column->size_bytes <= sizeof column->value && is_truth(&column->constant) &&
               is_truth(&column->seen) &&
               (column->constant || (column->at_bytes <= statistics->record_bytes &&
                                     column->size_bytes <= statistics->record_bytes - column->at_bytes));
    }
    return good && statistics->record_bytes >= 3 * sizeof(uint32_t);
}

static bool take_prototype(ewa_section_view from, const ewa_statistics *statistics, ewa_cloud *cloud,
                           char attributes[ATTRIBUTES_BYTES], ewa_status *status) {
    uint32_t count, note_count, column = 0;
    bool good = ewa_section_take(&from, &count, sizeof count) && count == statistics->column_count + 1;
    for (uint32_t a = 0; a < count && good && *status == EWA_OK; a++) {
        char name[EWA_NAME_BYTES];
        uint32_t shape[2];
        good = ewa_section_take(&from, name, sizeof name) && ewa_section_take(&from, shape, sizeof shape);
        good = good && memchr(name, 0, sizeof name) && shape[0] <= EWA_U32 && shape[1] >= 1 && shape[1] <= 4;
        const bool is_place = good && strcmp(name, EWA_POSITION) == 0;
        good = good && (is_place ? shape[1] == 3
                                 : column < statistics->column_count &&
                                       statistics->columns[column++].size_bytes ==
                                           shape[1] * ewa_type_bytes((ewa_type)shape[0]));
        if (good) *status = ewa_cloud_add(cloud, name, (ewa_type)shape[0], shape[1], NULL);
    }
    good =
        good && column == statistics->column_count && ewa_section_take(&from, &note_count, sizeof note_count);
    for (uint32_t n = 0; good && n < note_count && *status == EWA_OK; n++) {
        char name[EWA_NAME_BYTES];
        uint64_t size_bytes;
        good = ewa_section_take(&from, name, sizeof name) &&
               ewa_section_take(&from, &size_bytes, sizeof size_bytes);
        const uint8_t *bytes = good ? ewa_section_skip(&from, size_bytes) : NULL;
        good = bytes && memchr(name, 0, sizeof name);
        if (good) *status = ewa_cloud_set_note(cloud, name, bytes, (size_t)size_bytes);
    }
    good = good && ewa_section_take(&from, attributes, ATTRIBUTES_BYTES);
    return good && memchr(attributes, 0, ATTRIBUTES_BYTES);
}

/// Whether regions are nodes in the order of codes, none of them in another.
static bool are_regions(const ewa_lod_region *regions, uint32_t count) {
    uint64_t minimum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const ewa_octree_key *key = &regions[i].key;
        if (key->level < 0 || key->level >= EWA_CODE_LEVELS) return false;
        for (int c = 0; c < 3; c++)
            if (key->cell[c] < 0 || key->cell[c] >= 1 << key->level) return false;
        const uint64_t code = ewa_key_code(key);
        if (code < minimum) return false;
        minimum = code + ((uint64_t)1 << 3 * (EWA_CODE_LEVELS - (uint32_t)key->level));
    }
    return true;
}

/// Finds the results of all regions.
static ewa_status find_results(part_builder *p) {
    ewa_context *context = p->base.context;
    p->results = ewa_allocate_zeroed(context, p->base.region_count, sizeof *p->results);
    if (!p->results) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < p->part_count; i++) {
        open_part *part = &p->parts[i];
        ewa_section_view section;
        const char *fault;
        uint32_t tag, region;
        while (ewa_section_next(&part->results, &tag, &section, &fault)) {
            if (tag != RESULT || !ewa_section_take(&section, &region, sizeof region) ||
                region >= p->base.region_count || region % p->part_count != i || p->results[region].bytes)
                return fail_part(context, part, "it has a region that is not its own, or twice");
            p->results[region] = section;
        }
        if (fault) return fail_part(context, part, fault);
        for (region = i; region < p->base.region_count; region += p->part_count)
            if (!p->results[region].bytes) return fail_part(context, part, "a region is missing");
    }
    return EWA_OK;
}

static bool take_chunks(ewa_context *context, ewa_section_view *from, ewa_region_result *result,
                        ewa_status *status) {
    uint32_t count;
    bool good = ewa_section_take(from, &count, sizeof count) && count <= from->size_bytes;
    if (good) *status = ewa_buffer_reserve(context, &result->chunks, count, sizeof(ewa_octree_chunk));
    if (!good || *status != EWA_OK) return false;
    if (count) memset(result->chunks.data, 0, count * sizeof(ewa_octree_chunk));
    result->chunk_count = count;
    ewa_octree_chunk *chunks = result->chunks.data;
    for (uint32_t i = 0; i < count && good && *status == EWA_OK; i++) {
        ewa_octree_chunk *chunk = &chunks[i];
        uint64_t size_bytes;
        good = ewa_section_take(from, &chunk->key, sizeof chunk->key) &&
               ewa_section_take(from, &chunk->point_count, sizeof chunk->point_count) &&
               ewa_section_take(from, &chunk->sums, sizeof chunk->sums) &&
               ewa_section_take(from, &size_bytes, sizeof size_bytes);
        good = good && chunk->key.level >= 0 && chunk->key.level < EWA_OCTREE_LEVELS;
        const uint8_t *bytes = good ? ewa_section_skip(from, size_bytes) : NULL;
        good = bytes != NULL;
        if (good) *status = ewa_buffer_reserve(context, &chunk->bytes, (size_t)size_bytes, 1);
        if (!good || *status != EWA_OK) break;
        memcpy(chunk->bytes.data, bytes, (size_t)size_bytes);
        chunk->size_bytes = (size_t)size_bytes;
    }
    return good && *status == EWA_OK;
}

/// Copies `count` things of a section into a buffer.
static bool take_array(ewa_context *context, ewa_section_view *from, uint64_t count, size_t size_bytes,
                       ewa_buffer *to, ewa_status *status) {
    if (count > from->size_bytes / size_bytes) return false;
    *status = ewa_buffer_reserve(context, to, (size_t)count, size_bytes);
    return *status == EWA_OK && ewa_section_take(from, to->data, count * size_bytes);
}

static bool take_result(const ewa_region_plan *plan, ewa_section_view from, ewa_region_result *result, ewa_status *status) {
    ewa_context *context = plan->context;
    uint64_t blocks_bytes;
    float drawn[2];
    if (!take_chunks(context, &from, result, status)) return false;
    if (!ewa_section_take(&from, &result->page_count, sizeof result->page_count) ||
        !take_array(context, &from, result->page_count, sizeof(ewa_levels_page), &result->pages, status) ||
        !ewa_section_take(&from, &blocks_bytes, sizeof blocks_bytes) ||
        !take_array(context, &from, blocks_bytes, 1, &result->blocks, status))
        return false;
    result->blocks_bytes = (size_t)blocks_bytes;
    for (uint32_t i = 0; i < result->page_count; i++) {
        const ewa_levels_page *page = (const ewa_levels_page *)result->pages.data + i;
        if (page->at_bytes > blocks_bytes || page->size_bytes > blocks_bytes - page->at_bytes ||
            page->attributes_bytes > blocks_bytes - page->at_bytes - page->size_bytes)
            return false;
    }
    for (uint32_t level = 0; level < EWA_CODE_LEVELS; level++)
        if (!ewa_section_take(&from, &result->above_counts[level], sizeof result->above_counts[level]) ||
            !take_array(context, &from, result->above_counts[level], plan->record_bytes, &result->above[level], status))
            return false;
    ewa_representatives *representatives = &result->representatives;
    ewa_buffer items = {0}, numbers = {0};
    const bool good =
        ewa_section_take(&from, &representatives->count, sizeof representatives->count) &&
        ewa_section_take(&from, drawn, sizeof drawn) &&
        take_array(context, &from, representatives->count, sizeof *representatives->items, &items, status) &&
        take_array(context, &from, (uint64_t)representatives->count * plan->attribute_count, sizeof *representatives->numbers,
                   &numbers, status);
    representatives->numbers = numbers.data, representatives->numbers_capacity_bytes = numbers.capacity_bytes;
    representatives->number_count = plan->attribute_count;
    representatives->items = items.data, representatives->capacity_bytes = items.capacity_bytes;
    representatives->radius_scale = drawn[0], representatives->unit_coverage = drawn[1];
    return good && from.size_bytes == 0 && drawn[0] > 0;
}

static ewa_status fetch_region(ewa_lod_builder *b, uint32_t index, ewa_region_result *result) {
    part_builder *p = (part_builder *)b;
    ewa_status status = EWA_OK;
    if (!take_result(&b->plan, p->results[index], result, &status) &&
        status == EWA_OK)
        status = fail_part(b->context, &p->parts[index % p->part_count], "a region is damaged");
    return status;
}

/// Opens the parts and puts them in order.
static ewa_status open_parts(part_builder *p, const char *const *paths, uint32_t count) {
    ewa_context *context = p->base.context;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        open_part part = {.path = paths[i]};
        status = open_part_file(context, paths[i], &part);
        if (status == EWA_OK && part.head.subset_count != count)
            status = ewa_fail(context, EWA_ERROR_FORMAT, "%s: part %u of %u, but %u parts are given",
                              paths[i], part.head.subset, part.head.subset_count, count);
        if (status == EWA_OK && p->parts[part.head.subset].path)
            status =
                ewa_fail(context, EWA_ERROR_FORMAT, "%s: part %u is given twice", paths[i], part.head.subset);
        for (int k = 0; k < COMMON_SECTIONS && status == EWA_OK && i > 0; k++) {
            const open_part *other = p->parts;
            while (!other->path) other++;
            if (part.common[k].size_bytes != other->common[k].size_bytes ||
                memcmp(part.common[k].bytes, other->common[k].bytes, (size_t)part.common[k].size_bytes) != 0)
                status = fail_part(context, &part, "it is of other points than the others");
        }
        if (status == EWA_OK)
            p->parts[part.head.subset] = part;
        else
            ewa_file_unmap(context, &part.file);
    }
    return status;
}

static ewa_status prepare(part_builder *p) {
    ewa_lod_builder *b = &p->base;
    const open_part *any = &p->parts[0];
    EWA_TRY(ewa_cloud_create(b->context, 0, &p->inputs));
    ewa_status status = EWA_OK;
    char attributes[ATTRIBUTES_BYTES];
    const bool good = take_statistics(b->context, any->common[0], &p->statistics, &status) &&
                      take_prototype(any->common[1], &p->statistics, p->inputs, attributes, &status);
    if (status == EWA_OK && !good)
        status = fail_part(b->context, any, "what it says of all points is damaged");
    EWA_TRY(status);
    ewa_section_view from = any->common[2];
    b->region_count = (uint32_t)(from.size_bytes / sizeof *p->regions);
    p->regions = ewa_allocate(b->context, b->region_count, sizeof *p->regions);
    if (!p->regions) return EWA_ERROR_MEMORY;
    ewa_section_take(&from, p->regions, b->region_count * sizeof *p->regions);
    b->regions = p->regions;
    if (!are_regions(p->regions, b->region_count))
        return fail_part(b->context, any, "its regions are damaged");
    EWA_TRY(find_results(p));
    return ewa_region_plan_make(b->context, &p->statistics, p->inputs, attributes, &b->plan);
}

ewa_status ewa_lod_merge(ewa_context *context, const char *const *parts, uint32_t part_count, const char *out,
                         ewa_lod_build_stats *stats) {
    if (!context || !parts || part_count == 0 || !out) return EWA_ERROR_ARGUMENT;
    part_builder p = {.base = {.context = context, .get = fetch_region}, .part_count = part_count};
    const double start_s = ewa_now_s();
    p.parts = ewa_allocate_zeroed(context, part_count, sizeof *p.parts);
    if (!p.parts) return EWA_ERROR_MEMORY;
    ewa_status status = open_parts(&p, parts, part_count);
    if (status == EWA_OK) status = prepare(&p);
    if (status == EWA_OK) status = ewa_lod_write(&p.base, out);
    p.base.stats.total_s = ewa_now_s() - start_s;
    if (stats) *stats = p.base.stats;
    ewa_region_plan_free(&p.base.plan);
    ewa_statistics_free(context, &p.statistics);
    ewa_cloud_destroy(&p.inputs);
    ewa_release(context, p.regions, p.base.region_count, sizeof *p.regions);
    ewa_release(context, p.results, p.base.region_count, sizeof *p.results);
    for (uint32_t i = 0; i < part_count; i++) ewa_file_unmap(context, &p.parts[i].file);
    ewa_release(context, p.parts, part_count, sizeof *p.parts);
    return status;
}
