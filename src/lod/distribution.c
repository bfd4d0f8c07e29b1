// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points distributed to regions. A piece is sorted by region first, so that threads share the work and
// records of a region keep the order of the input.
#include "lod/distribution.h"
#include "cloud/cloud.h"

#include <stdlib.h>
#include <string.h>

enum {
    BLOCK_BYTES = 1 << 16,
    SLICE_POINTS = 1 << 14, // of a piece, sorted by one task
    SLICES = EWA_INPUT_PIECE_POINTS / SLICE_POINTS,
    NEIGHBOURS = 27,
};

static ewa_region *grow_regions(ewa_distribution *s) {
    ewa_buffer buffer = {s->regions, s->region_capacity_bytes};
    const ewa_status status = ewa_buffer_grow(s->context, &buffer, s->region_count,
                                              (size_t)s->region_count + 1, sizeof *s->regions);
    s->regions = buffer.data, s->region_capacity_bytes = buffer.capacity_bytes;
    return status == EWA_OK ? &s->regions[s->region_count++] : NULL;
}

/// Divides the cells [first, end) of a node until its points are few enough.
static ewa_status divide(ewa_distribution *s, uint32_t first, uint32_t end, uint32_t level,
                         uint64_t max_points) {
    const ewa_statistics *statistics = s->statistics;
    uint64_t point_count = 0;
    for (uint32_t i = first; i < end; i++) point_count += statistics->cells[i].point_count;
    const uint32_t below = statistics->cell_level - level;
    if (point_count <= max_points || below == 0) {
        if (point_count > 4 * max_points)
            return ewa_fail(s->context, EWA_ERROR_LIMIT,
                            "%llu points in a node of 1/%llu of the whole are more than fit in memory",
                            (unsigned long long)point_count, 1ull << level);
        ewa_region *region = grow_regions(s);
        if (!region) return EWA_ERROR_MEMORY;
        const uint64_t prefix = statistics->cells[first].prefix >> 3 * below;
        *region = (ewa_region){.key = ewa_code_key(prefix << 3 * (EWA_CODE_LEVELS - level), level),
                               .first_prefix = prefix << 3 * below,
                               .end_prefix = (prefix + 1) << 3 * below,
                               .point_count = point_count};
        for (uint32_t i = first; i < end; i++) s->region_of[i] = s->region_count - 1;
        return EWA_OK;
    }
    ewa_status status = EWA_OK;
    while (first < end && status == EWA_OK) {
        const uint64_t child = statistics->cells[first].prefix >> 3 * (below - 1);
        uint32_t next = first;
        while (next < end && statistics->cells[next].prefix >> 3 * (below - 1) == child) next++;
        status = divide(s, first, next, level + 1, max_points);
        first = next;
    }
    return status;
}

static uint32_t find_cell(const ewa_statistics *statistics, uint64_t prefix) {
    uint32_t low = 0, high = statistics->cell_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (statistics->cells[middle].prefix < prefix)
            low = middle + 1;
        else
            high = middle;
    }
    return low < statistics->cell_count && statistics->cells[low].prefix == prefix ? low : UINT32_MAX;
}

/// Lists for each cell the regions of the cells next to it other than its own.
static ewa_status find_adjacent(ewa_distribution *s) {
    const ewa_statistics *statistics = s->statistics;
    const int32_t cells_per_axis = (int32_t)1 << statistics->cell_level;
    ewa_buffer adjacent = {0};
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < statistics->cell_count && status == EWA_OK; i++) {
        s->adjacent_first[i] = s->adjacent_count;
        if (s->region_count == 1) continue;
        const uint64_t code = statistics->cells[i].prefix << 3 * (EWA_CODE_LEVELS - statistics->cell_level);
        const ewa_octree_key key = ewa_code_key(code, statistics->cell_level);
        status = ewa_buffer_grow(s->context, &adjacent, s->adjacent_count,
                                 (size_t)s->adjacent_count + NEIGHBOURS, sizeof(uint32_t));
        s->adjacent = adjacent.data, s->adjacent_capacity_bytes = adjacent.capacity_bytes;
        for (int n = 0; n < NEIGHBOURS && status == EWA_OK; n++) {
            ewa_octree_key other = key;
            const int32_t step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
            bool inside = true;
            for (int c = 0; c < 3; c++) {
                other.cell[c] += step[c];
                inside = inside && other.cell[c] >= 0 && other.cell[c] < cells_per_axis;
            }
            if (!inside) continue;
            const uint32_t cell =
                find_cell(statistics, ewa_code_prefix(ewa_key_code(&other), statistics->cell_level));
            if (cell == UINT32_MAX || s->region_of[cell] == s->region_of[i]) continue;
            bool known = false;
            for (uint32_t k = s->adjacent_first[i]; k < s->adjacent_count; k++)
                known |= s->adjacent[k] == s->region_of[cell];
            if (!known) s->adjacent[s->adjacent_count++] = s->region_of[cell];
        }
    }
    s->adjacent_first[statistics->cell_count] = s->adjacent_count;
    return status;
}

/// What one task found out about its points.
typedef struct slice {
    uint32_t *regions; ///< [SLICE_POINTS]: UINT32_MAX: not wanted
    uint32_t *cells;   ///< [SLICE_POINTS]: of the statistics
    uint32_t *counts;  ///< [region]: then places in `records`
    uint8_t *records;  ///< sorted by region
    int64_t *places;   ///< [SLICE_POINTS][3]
    uint64_t unknown_count; ///< points in cells that the statistics do not have
} slice;

typedef struct distributor {
    ewa_distribution *distribution;
    const ewa_cloud *piece;
    slice slices[SLICES];
    uint32_t slice_count;
    uint64_t unknown_count;
} distributor;

static void free_distributor(distributor *s) {
    ewa_context *context = s->distribution->context;
    const size_t record_bytes = s->distribution->statistics->record_bytes;
    for (uint32_t i = 0; i < SLICES; i++) {
        slice *part = &s->slices[i];
        ewa_release(context, part->regions, SLICE_POINTS, sizeof *part->regions);
        ewa_release(context, part->cells, SLICE_POINTS, sizeof *part->cells);
        ewa_release(context, part->counts, (size_t)s->distribution->region_count + 1, sizeof *part->counts);
        ewa_release(context, part->records, SLICE_POINTS, record_bytes);
        ewa_release(context, part->places, 3 * SLICE_POINTS, sizeof *part->places);
    }
}

static ewa_status make_distributor(ewa_distribution *distribution, distributor *s) {
    ewa_context *context = distribution->context;
    *s = (distributor){.distribution = distribution};
    bool good = true;
    for (uint32_t i = 0; i < SLICES && good; i++) {
        slice *part = &s->slices[i];
        part->regions = ewa_allocate(context, SLICE_POINTS, sizeof *part->regions);
        part->cells = ewa_allocate(context, SLICE_POINTS, sizeof *part->cells);
        part->counts = ewa_allocate(context, (size_t)distribution->region_count + 1, sizeof *part->counts);
        part->records = ewa_allocate(context, SLICE_POINTS, distribution->statistics->record_bytes);
        part->places = ewa_allocate(context, 3 * SLICE_POINTS, sizeof *part->places);
        good = part->regions && part->cells && part->counts && part->records && part->places;
    }
    return good ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Finds the region of each point of a slice.
static void find_regions(distributor *s, slice *part, uint64_t count) {
    const ewa_statistics *statistics = s->distribution->statistics;
    const int64_t shift = statistics->lattice.bits - statistics->cell_level;
    int64_t last[3] = {0};
    uint32_t cell = UINT32_MAX;
    bool known = false;
    for (uint64_t i = 0; i < count; i++) {
        const int64_t *place = part->places + 3 * i;
        part->regions[i] = UINT32_MAX;
        if (place[0] == EWA_NOWHERE) continue;
        int64_t at[3];
        bool inside = true;
        for (int c = 0; c < 3; c++) {
            at[c] = (place[c] - statistics->lattice.low[c]) >> shift;
            inside = inside && at[c] >= 0 && at[c] < (int64_t)1 << statistics->cell_level;
        }
        if (!known || memcmp(at, last, sizeof at) != 0) {
            memcpy(last, at, sizeof last);
            known = true;
            cell = inside
                       ? find_cell(statistics, ewa_code_prefix(ewa_lattice_code(&statistics->lattice, place),
                                                               statistics->cell_level))
                       : UINT32_MAX;
        }
        if (cell == UINT32_MAX) {
            part->unknown_count++;
            continue;
        }
        part->cells[i] = cell;
        part->regions[i] = s->distribution->region_of[cell];
    }
}

/// Writes a place from the root's corner.
static void write_place(const ewa_lattice *lattice, const int64_t place[3], uint8_t *to) {
    for (int c = 0; c < 3; c++) {
        const uint32_t from = (uint32_t)(place[c] - lattice->low[c]);
        memcpy(to + 4 * c, &from, sizeof from);
    }
}

/// The attribute that says where points are, which are no column.
static uint32_t find_position(const ewa_statistics *statistics, const ewa_cloud *piece) {
    uint32_t a = 0;
    while (a < statistics->column_count && strcmp(ewa_cloud_attribute_at(piece, a)->name, EWA_POSITION) != 0) a++;
    return a;
}

/// How many of the numbers that all points had are others in a part of a piece; `position` is find_position().
static uint64_t count_changed(const ewa_statistics *statistics, const ewa_cloud *piece, uint32_t position, uint64_t first, uint64_t count) {
    uint64_t changed = 0;
    for (uint32_t k = 0; k < statistics->column_count; k++)
        changed += statistics->columns[k].constant &&
                   ewa_statistics_differs(&statistics->columns[k], ewa_cloud_attribute_at(piece, k + (k >= position)), first, count);
    return changed;
}

/// Writes the record of a point: what varies of its numbers; `position` is find_position().
static void write_record(const ewa_statistics *statistics, const ewa_cloud *piece, uint32_t position, uint64_t point,
                         const int64_t place[3], uint8_t *record) {
    write_place(&statistics->lattice, place, record);
    for (uint32_t k = 0; k < statistics->column_count; k++) {
        const ewa_statistics_column *column = &statistics->columns[k];
        if (column->constant) continue;
        const ewa_attribute *attribute = ewa_cloud_attribute_at(piece, k + (k >= position));
        memcpy(record + column->at_bytes, (const uint8_t *)attribute->data + point * attribute->stride_bytes, column->size_bytes);
    }
}

static void sort_slice(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    distributor *s = data;
    const ewa_distribution *distribution = s->distribution;
    const ewa_statistics *statistics = distribution->statistics;
    slice *part = &s->slices[index];
    const uint64_t first = (uint64_t)index * SLICE_POINTS, left = ewa_cloud_point_count(s->piece) - first;
    const uint64_t count = left < SLICE_POINTS ? left : SLICE_POINTS;
    const uint32_t position = find_position(statistics, s->piece);
    part->unknown_count = count_changed(statistics, s->piece, position, first, count);
    ewa_statistics_places(&statistics->lattice, s->piece, first, count, part->places);
    find_regions(s, part, count);
    memset(part->counts, 0, ((size_t)distribution->region_count + 1) * sizeof *part->counts);
    for (uint64_t i = 0; i < count; i++)
        if (part->regions[i] != UINT32_MAX && distribution->regions[part->regions[i]].wanted)
            part->counts[part->regions[i] + 1]++;
    for (uint32_t r = 0; r < distribution->region_count; r++) part->counts[r + 1] += part->counts[r];
    for (uint64_t i = 0; i < count; i++) {
        const uint32_t region = part->regions[i];
        if (region == UINT32_MAX || !distribution->regions[region].wanted) continue;
        uint8_t *record = part->records + (size_t)part->counts[region]++ * statistics->record_bytes;
        write_record(statistics, s->piece, position, first + i, part->places + 3 * i, record);
    }
}

static ewa_status flush(ewa_distribution *s, ewa_region_stream *stream) {
    ewa_buffer blocks = {stream->blocks, stream->block_capacity_bytes};
    ewa_status status = ewa_buffer_grow(s->context, &blocks, stream->block_count, stream->block_count + 1,
                                        sizeof *stream->blocks);
    stream->blocks = blocks.data, stream->block_capacity_bytes = blocks.capacity_bytes;
    if (status == EWA_OK)
        status =
            ewa_spool_put(s->spool, stream->buffer, stream->filled, &stream->blocks[stream->block_count]);
    if (status == EWA_OK) stream->block_count++;
    stream->filled = 0;
    return status;
}

static ewa_status append(ewa_distribution *s, ewa_region_stream *stream, const uint8_t *bytes,
                         size_t size_bytes) {
    if (!stream->buffer && !(stream->buffer = ewa_allocate(s->context, BLOCK_BYTES, 1)))
        return EWA_ERROR_MEMORY;
    while (size_bytes) {
        const size_t room = BLOCK_BYTES - stream->filled, part = size_bytes < room ? size_bytes : room;
        memcpy(stream->buffer + stream->filled, bytes, part);
        stream->filled += (uint32_t)part;
        bytes += part;
        size_bytes -= part;
        if (stream->filled == BLOCK_BYTES) EWA_TRY(flush(s, stream));
    }
    return EWA_OK;
}

/// Gives the points of a slice to the regions beside them.
static ewa_status append_around(ewa_distribution *distribution, const slice *part, uint64_t count) {
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        if (part->regions[i] == UINT32_MAX) continue;
        const uint32_t cell = part->cells[i];
        uint8_t from[EWA_AROUND_BYTES];
        write_place(&distribution->statistics->lattice, part->places + 3 * i, from);
        for (uint32_t k = distribution->adjacent_first[cell];
             k < distribution->adjacent_first[cell + 1] && status == EWA_OK; k++) {
            ewa_region *region = &distribution->regions[distribution->adjacent[k]];
            if (!region->wanted) continue;
            status = append(distribution, &region->around, from, EWA_AROUND_BYTES);
            region->around.count++;
        }
    }
    return status;
}

static ewa_status distribute_piece(void *user, const ewa_cloud *piece) {
    distributor *s = user;
    ewa_distribution *distribution = s->distribution;
    const uint64_t count = ewa_cloud_point_count(piece);
    s->piece = piece;
    s->slice_count = (uint32_t)((count + SLICE_POINTS - 1) / SLICE_POINTS);
    ewa_parallel(distribution->context, sort_slice, s, s->slice_count);
    ewa_status status = EWA_OK;
    const size_t record_bytes = distribution->statistics->record_bytes;
    for (uint32_t i = 0; i < s->slice_count && status == EWA_OK; i++) {
        const slice *part = &s->slices[i];
        s->unknown_count += part->unknown_count;
        uint32_t first = 0; // counts have become the ends of regions
        for (uint32_t r = 0; r < distribution->region_count && status == EWA_OK; r++) {
            const uint32_t end = part->counts[r];
            if (end > first)
                status = append(distribution, &distribution->regions[r].own,
                                part->records + first * record_bytes, (end - first) * record_bytes);
            distribution->regions[r].own.count += end - first;
            first = end;
        }
        const uint64_t left = count - (uint64_t)i * SLICE_POINTS;
        if (status == EWA_OK && distribution->region_count > 1)
            status = append_around(distribution, part, left < SLICE_POINTS ? left : SLICE_POINTS);
    }
    return status;
}

static ewa_status prepare(ewa_distribution *s, uint64_t max_points, uint32_t subset, uint32_t subset_count) {
    const ewa_statistics *statistics = s->statistics;
    s->region_of = ewa_allocate(s->context, statistics->cell_count, sizeof *s->region_of);
    s->adjacent_first =
        ewa_allocate(s->context, (size_t)statistics->cell_count + 1, sizeof *s->adjacent_first);
    if (!s->region_of || !s->adjacent_first) return EWA_ERROR_MEMORY;
    ewa_status status = statistics->cell_count ? divide(s, 0, statistics->cell_count, 0, max_points) : EWA_OK;
    for (uint32_t i = 0; i < s->region_count; i++) s->regions[i].wanted = i % subset_count == subset;
    return status == EWA_OK ? find_adjacent(s) : status;
}

ewa_status ewa_distribution_make(ewa_inputs *inputs, const ewa_statistics *statistics,
                                 const char *output_path, uint64_t max_points, uint32_t subset,
                                 uint32_t subset_count, ewa_distribution *distribution) {
    *distribution = (ewa_distribution){.context = inputs->context, .statistics = statistics};
    EWA_TRY(prepare(distribution, max_points, subset, subset_count));
    EWA_TRY(ewa_spool_open(inputs->context, output_path, &distribution->spool));
    distributor s;
    ewa_status status = make_distributor(distribution, &s);
    if (status == EWA_OK) status = ewa_inputs_read(inputs, "distribute", distribute_piece, &s);
    for (uint32_t i = 0; i < distribution->region_count && status == EWA_OK; i++) {
        ewa_region *region = &distribution->regions[i];
        if (region->own.filled) status = flush(distribution, &region->own);
        if (status == EWA_OK && region->around.filled) status = flush(distribution, &region->around);
        if (region->wanted && region->own.count != region->point_count) s.unknown_count++;
        ewa_release(distribution->context, region->own.buffer, BLOCK_BYTES, 1);
        ewa_release(distribution->context, region->around.buffer, BLOCK_BYTES, 1);
        region->own.buffer = region->around.buffer = NULL;
    }
    if (status == EWA_OK && s.unknown_count)
        status = ewa_fail(inputs->context, EWA_ERROR_FORMAT, "%s%s: changed while it was read",
                          inputs->paths[0], inputs->path_count > 1 ? ", or another of the files" : "");
    free_distributor(&s);
    return status;
}

static void free_stream(ewa_context *context, ewa_region_stream *stream) {
    ewa_buffer blocks = {stream->blocks, stream->block_capacity_bytes};
    ewa_buffer_free(context, &blocks);
    ewa_release(context, stream->buffer, BLOCK_BYTES, 1);
    *stream = (ewa_region_stream){0};
}

ewa_status ewa_distribution_read(ewa_distribution *distribution, ewa_region_stream *stream,
                                 uint32_t record_bytes, uint8_t *records) {
    uint64_t left = stream->count * record_bytes;
    ewa_status status = EWA_OK;
    for (size_t i = 0; i < stream->block_count && status == EWA_OK; i++) {
        const size_t part = left < BLOCK_BYTES ? (size_t)left : BLOCK_BYTES;
        status = ewa_spool_get(distribution->spool, stream->blocks[i], records, part);
        records += part;
        left -= part;
    }
    free_stream(distribution->context, stream);
    return status;
}

void ewa_distribution_free(ewa_distribution *distribution) {
    ewa_context *context = distribution->context;
    for (uint32_t i = 0; i < distribution->region_count; i++) {
        free_stream(context, &distribution->regions[i].own);
        free_stream(context, &distribution->regions[i].around);
    }
    ewa_buffer regions = {distribution->regions, distribution->region_capacity_bytes},
               adjacent = {distribution->adjacent, distribution->adjacent_capacity_bytes};
    ewa_buffer_free(context, &regions);
    ewa_buffer_free(context, &adjacent);
    ewa_release(context, distribution->region_of, distribution->statistics->cell_count,
                sizeof *distribution->region_of);
    ewa_release(context, distribution->adjacent_first, (size_t)distribution->statistics->cell_count + 1,
                sizeof *distribution->adjacent_first);
    ewa_spool_close(&distribution->spool);
}
