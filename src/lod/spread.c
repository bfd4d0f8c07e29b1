// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points put aside by regions. A piece is sorted by region first, so that threads share the work and records of a region keep
// the order of the input.
#include "lod/spread.h"
#include "cloud/cloud.h"

#include <stdlib.h>
#include <string.h>

enum {
    BLOCK_BYTES = 1 << 16,
    SLICE_POINTS = 1 << 14, // of a piece, sorted by one task
    SLICES = EWA_INPUT_PIECE_POINTS / SLICE_POINTS,
    NEIGHBOURS = 27,
};

static ewa_region *grow_regions(ewa_spread *s) {
    ewa_buffer buffer = {s->regions, s->region_capacity_bytes};
    const ewa_status status = ewa_buffer_grow(s->context, &buffer, s->region_count,
                                              (size_t)s->region_count + 1, sizeof *s->regions);
    s->regions = buffer.data, s->region_capacity_bytes = buffer.capacity_bytes;
    return status == EWA_OK ? &s->regions[s->region_count++] : NULL;
}

/// Divides the cells [first, end) of a cube until its points are few enough.
static ewa_status divide(ewa_spread *s, uint32_t first, uint32_t end, uint32_t level, uint64_t most_points) {
    const ewa_survey *survey = s->survey;
    uint64_t point_count = 0;
    for (uint32_t i = first; i < end; i++) point_count += survey->cells[i].point_count;
    const uint32_t below = survey->cell_level - level;
    if (point_count <= most_points || below == 0) {
        if (point_count > 4 * most_points)
            return ewa_fail(s->context, EWA_ERROR_LIMIT,
                            "%llu points in a cube of 1/%llu of the whole are more than fit in memory",
                            (unsigned long long)point_count, 1ull << level);
        ewa_region *region = grow_regions(s);
        if (!region) return EWA_ERROR_MEMORY;
        const uint64_t prefix = survey->cells[first].prefix >> 3 * below;
        *region = (ewa_region){.key = ewa_code_key(prefix << 3 * (EWA_CODE_LEVELS - level), level),
                               .first_prefix = prefix << 3 * below,
                               .end_prefix = (prefix + 1) << 3 * below,
                               .point_count = point_count};
        for (uint32_t i = first; i < end; i++) s->region_of[i] = s->region_count - 1;
        return EWA_OK;
    }
    ewa_status status = EWA_OK;
    while (first < end && status == EWA_OK) {
        const uint64_t child = survey->cells[first].prefix >> 3 * (below - 1);
        uint32_t next = first;
        while (next < end && survey->cells[next].prefix >> 3 * (below - 1) == child) next++;
        status = divide(s, first, next, level + 1, most_points);
        first = next;
    }
    return status;
}

static uint32_t find_cell(const ewa_survey *survey, uint64_t prefix) {
    uint32_t low = 0, high = survey->cell_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (survey->cells[middle].prefix < prefix)
            low = middle + 1;
        else
            high = middle;
    }
    return low < survey->cell_count && survey->cells[low].prefix == prefix ? low : UINT32_MAX;
}

/// Lists for each cell the regions of the cells next to it other than its own.
static ewa_status find_beside(ewa_spread *s) {
    const ewa_survey *survey = s->survey;
    const int32_t cells_per_axis = (int32_t)1 << survey->cell_level;
    ewa_buffer beside = {0};
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < survey->cell_count && status == EWA_OK; i++) {
        s->beside_first[i] = s->beside_count;
        if (s->region_count == 1) continue;
        const uint64_t code = survey->cells[i].prefix << 3 * (EWA_CODE_LEVELS - survey->cell_level);
        const ewa_octree_key key = ewa_code_key(code, survey->cell_level);
        status = ewa_buffer_grow(s->context, &beside, s->beside_count, (size_t)s->beside_count + NEIGHBOURS,
                                 sizeof(uint32_t));
        s->beside = beside.data, s->beside_capacity_bytes = beside.capacity_bytes;
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
                find_cell(survey, ewa_code_prefix(ewa_key_code(&other), survey->cell_level));
            if (cell == UINT32_MAX || s->region_of[cell] == s->region_of[i]) continue;
            bool known = false;
            for (uint32_t k = s->beside_first[i]; k < s->beside_count; k++)
                known |= s->beside[k] == s->region_of[cell];
            if (!known) s->beside[s->beside_count++] = s->region_of[cell];
        }
    }
    s->beside_first[survey->cell_count] = s->beside_count;
    return status;
}

/// What one task found out about its points.
typedef struct slice {
    uint32_t *regions; ///< [SLICE_POINTS]: UINT32_MAX: not wanted
    uint32_t *cells;   ///< [SLICE_POINTS]: of the survey
    uint32_t *counts;  ///< [region]: then places in `records`
    uint8_t *records;  ///< sorted by region
    int64_t *places;   ///< [SLICE_POINTS][3]
    uint64_t strays;   ///< points in cells that the survey did not see
} slice;

typedef struct spreader {
    ewa_spread *spread;
    const ewa_cloud *piece;
    slice slices[SLICES];
    uint32_t slice_count;
    uint64_t stray_count;
} spreader;

static void free_spreader(spreader *s) {
    ewa_context *context = s->spread->context;
    const size_t record_bytes = s->spread->survey->record_bytes;
    for (uint32_t i = 0; i < SLICES; i++) {
        slice *part = &s->slices[i];
        ewa_release(context, part->regions, SLICE_POINTS, sizeof *part->regions);
        ewa_release(context, part->cells, SLICE_POINTS, sizeof *part->cells);
        ewa_release(context, part->counts, (size_t)s->spread->region_count + 1, sizeof *part->counts);
        ewa_release(context, part->records, SLICE_POINTS, record_bytes);
        ewa_release(context, part->places, 3 * SLICE_POINTS, sizeof *part->places);
    }
}

static ewa_status make_spreader(ewa_spread *spread, spreader *s) {
    ewa_context *context = spread->context;
    *s = (spreader){.spread = spread};
    bool good = true;
    for (uint32_t i = 0; i < SLICES && good; i++) {
        slice *part = &s->slices[i];
        part->regions = ewa_allocate(context, SLICE_POINTS, sizeof *part->regions);
        part->cells = ewa_allocate(context, SLICE_POINTS, sizeof *part->cells);
        part->counts = ewa_allocate(context, (size_t)spread->region_count + 1, sizeof *part->counts);
        part->records = ewa_allocate(context, SLICE_POINTS, spread->survey->record_bytes);
        part->places = ewa_allocate(context, 3 * SLICE_POINTS, sizeof *part->places);
        good = part->regions && part->cells && part->counts && part->records && part->places;
    }
    return good ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Finds the region of each point of a slice.
static void find_regions(spreader *s, slice *part, uint64_t count) {
    const ewa_survey *survey = s->spread->survey;
    const int64_t shift = survey->lattice.bits - survey->cell_level;
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
            at[c] = (place[c] - survey->lattice.low[c]) >> shift;
            inside = inside && at[c] >= 0 && at[c] < (int64_t)1 << survey->cell_level;
        }
        if (!known || memcmp(at, last, sizeof at) != 0) {
            memcpy(last, at, sizeof last);
            known = true;
            cell = inside ? find_cell(survey, ewa_code_prefix(ewa_lattice_code(&survey->lattice, place),
                                                              survey->cell_level))
                          : UINT32_MAX;
        }
        if (cell == UINT32_MAX) {
            part->strays++;
            continue;
        }
        part->cells[i] = cell;
        part->regions[i] = s->spread->region_of[cell];
    }
}

/// Writes a place from the root's corner.
static void write_place(const ewa_lattice *lattice, const int64_t place[3], uint8_t *to) {
    for (int c = 0; c < 3; c++) {
        const uint32_t from = (uint32_t)(place[c] - lattice->low[c]);
        memcpy(to + 4 * c, &from, sizeof from);
    }
}

/// Writes the record of a point: what varies of its numbers.
static bool write_record(const ewa_survey *survey, const ewa_cloud *piece, uint64_t point,
                         const int64_t place[3], uint8_t *record) {
    bool changed = false;
    write_place(&survey->lattice, place, record);
    uint32_t k = 0;
    for (uint32_t a = 0; a <= survey->column_count; a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(piece, a);
        if (strcmp(attribute->name, EWA_POSITION) == 0) continue;
        const ewa_survey_column *column = &survey->columns[k++];
        const uint8_t *from = (const uint8_t *)attribute->data + point * attribute->stride_bytes;
        if (column->constant)
            changed |= memcmp(from, column->value, column->size_bytes) != 0;
        else
            memcpy(record + column->at_bytes, from, column->size_bytes);
    }
    return changed;
}

static void sort_slice(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    spreader *s = data;
    const ewa_spread *spread = s->spread;
    const ewa_survey *survey = spread->survey;
    slice *part = &s->slices[index];
    const uint64_t first = (uint64_t)index * SLICE_POINTS, left = ewa_cloud_point_count(s->piece) - first;
    const uint64_t count = left < SLICE_POINTS ? left : SLICE_POINTS;
    part->strays = 0;
    ewa_survey_places(&survey->lattice, s->piece, first, count, part->places);
    find_regions(s, part, count);
    memset(part->counts, 0, ((size_t)spread->region_count + 1) * sizeof *part->counts);
    for (uint64_t i = 0; i < count; i++)
        if (part->regions[i] != UINT32_MAX && spread->regions[part->regions[i]].wanted)
            part->counts[part->regions[i] + 1]++;
    for (uint32_t r = 0; r < spread->region_count; r++) part->counts[r + 1] += part->counts[r];
    for (uint64_t i = 0; i < count; i++) {
        const uint32_t region = part->regions[i];
        if (region == UINT32_MAX || !spread->regions[region].wanted) continue;
        uint8_t *record = part->records + (size_t)part->counts[region]++ * survey->record_bytes;
        if (write_record(survey, s->piece, first + i, part->places + 3 * i, record)) part->strays++;
    }
}

static ewa_status flush(ewa_spread *s, ewa_spread_stream *stream) {
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

static ewa_status append(ewa_spread *s, ewa_spread_stream *stream, const uint8_t *bytes, size_t size_bytes) {
    ewa_status status = EWA_OK;
    if (!stream->buffer && !(stream->buffer = ewa_allocate(s->context, BLOCK_BYTES, 1)))
        return EWA_ERROR_MEMORY;
    while (size_bytes && status == EWA_OK) {
        const size_t room = BLOCK_BYTES - stream->filled, part = size_bytes < room ? size_bytes : room;
        memcpy(stream->buffer + stream->filled, bytes, part);
        stream->filled += (uint32_t)part;
        bytes += part;
        size_bytes -= part;
        if (stream->filled == BLOCK_BYTES) status = flush(s, stream);
    }
    return status;
}

/// Gives the points of a slice to the regions beside them.
static ewa_status append_around(ewa_spread *spread, const slice *part, uint64_t count) {
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        if (part->regions[i] == UINT32_MAX) continue;
        const uint32_t cell = part->cells[i];
        uint8_t from[EWA_AROUND_BYTES];
        write_place(&spread->survey->lattice, part->places + 3 * i, from);
        for (uint32_t k = spread->beside_first[cell]; k < spread->beside_first[cell + 1] && status == EWA_OK;
             k++) {
            ewa_region *region = &spread->regions[spread->beside[k]];
            if (!region->wanted) continue;
            status = append(spread, &region->around, from, EWA_AROUND_BYTES);
            region->around.count++;
        }
    }
    return status;
}

static ewa_status spread_piece(void *user, const ewa_cloud *piece) {
    spreader *s = user;
    ewa_spread *spread = s->spread;
    const uint64_t count = ewa_cloud_point_count(piece);
    s->piece = piece;
    s->slice_count = (uint32_t)((count + SLICE_POINTS - 1) / SLICE_POINTS);
    ewa_parallel(spread->context, sort_slice, s, s->slice_count);
    ewa_status status = EWA_OK;
    const size_t record_bytes = spread->survey->record_bytes;
    for (uint32_t i = 0; i < s->slice_count && status == EWA_OK; i++) {
        const slice *part = &s->slices[i];
        s->stray_count += part->strays;
        uint32_t first = 0; // counts have become the ends of regions
        for (uint32_t r = 0; r < spread->region_count && status == EWA_OK; r++) {
            const uint32_t end = part->counts[r];
            if (end > first)
                status = append(spread, &spread->regions[r].own, part->records + first * record_bytes,
                                (end - first) * record_bytes);
            spread->regions[r].own.count += end - first;
            first = end;
        }
        const uint64_t left = count - (uint64_t)i * SLICE_POINTS;
        if (status == EWA_OK && spread->region_count > 1)
            status = append_around(spread, part, left < SLICE_POINTS ? left : SLICE_POINTS);
    }
    return status;
}

static ewa_status prepare(ewa_spread *s, uint64_t most_points, uint32_t subset, uint32_t subset_count) {
    const ewa_survey *survey = s->survey;
    s->region_of = ewa_allocate(s->context, survey->cell_count, sizeof *s->region_of);
    s->beside_first = ewa_allocate(s->context, (size_t)survey->cell_count + 1, sizeof *s->beside_first);
    if (!s->region_of || !s->beside_first) return EWA_ERROR_MEMORY;
    ewa_status status = survey->cell_count ? divide(s, 0, survey->cell_count, 0, most_points) : EWA_OK;
    for (uint32_t i = 0; i < s->region_count; i++) s->regions[i].wanted = i % subset_count == subset;
    return status == EWA_OK ? find_beside(s) : status;
}

ewa_status ewa_spread_make(const ewa_inputs *inputs, const ewa_survey *survey, const char *beside,
                           uint64_t most_points, uint32_t subset, uint32_t subset_count, ewa_spread *spread) {
    *spread = (ewa_spread){.context = inputs->context, .survey = survey};
    ewa_status status = prepare(spread, most_points, subset, subset_count);
    if (status == EWA_OK) status = ewa_spool_open(inputs->context, beside, &spread->spool);
    if (status != EWA_OK) return status;
    spreader s;
    status = make_spreader(spread, &s);
    if (status == EWA_OK) status = ewa_inputs_read(inputs, "distribute", spread_piece, &s);
    for (uint32_t i = 0; i < spread->region_count && status == EWA_OK; i++) {
        ewa_region *region = &spread->regions[i];
        if (region->own.filled) status = flush(spread, &region->own);
        if (status == EWA_OK && region->around.filled) status = flush(spread, &region->around);
        if (region->wanted && region->own.count != region->point_count) s.stray_count++;
        ewa_release(spread->context, region->own.buffer, BLOCK_BYTES, 1);
        ewa_release(spread->context, region->around.buffer, BLOCK_BYTES, 1);
        region->own.buffer = region->around.buffer = NULL;
    }
    if (status == EWA_OK && s.stray_count)
        status = ewa_fail(inputs->context, EWA_ERROR_FORMAT, "%s%s: changed while it was read",
                          inputs->paths[0], inputs->path_count > 1 ? ", or another of the files" : "");
    free_spreader(&s);
    return status;
}

static void free_stream(ewa_context *context, ewa_spread_stream *stream) {
    ewa_buffer blocks = {stream->blocks, stream->block_capacity_bytes};
    ewa_buffer_free(context, &blocks);
    ewa_release(context, stream->buffer, BLOCK_BYTES, 1);
    *stream = (ewa_spread_stream){0};
}

ewa_status ewa_spread_read(ewa_spread *spread, ewa_spread_stream *stream, uint32_t record_bytes,
                           uint8_t *records) {
    uint64_t left = stream->count * record_bytes;
    ewa_status status = EWA_OK;
    for (size_t i = 0; i < stream->block_count && status == EWA_OK; i++) {
        const size_t part = left < BLOCK_BYTES ? (size_t)left : BLOCK_BYTES;
        status = ewa_spool_get(spread->spool, stream->blocks[i], records, part);
        records += part;
        left -= part;
    }
    free_stream(spread->context, stream);
    return status;
}

void ewa_spread_free(ewa_spread *spread) {
    ewa_context *context = spread->context;
    for (uint32_t i = 0; i < spread->region_count; i++) {
        free_stream(context, &spread->regions[i].own);
        free_stream(context, &spread->regions[i].around);
    }
    ewa_buffer regions = {spread->regions, spread->region_capacity_bytes},
               beside = {spread->beside, spread->beside_capacity_bytes};
    ewa_buffer_free(context, &regions);
    ewa_buffer_free(context, &beside);
    ewa_release(context, spread->region_of, spread->survey->cell_count, sizeof *spread->region_of);
    ewa_release(context, spread->beside_first, (size_t)spread->survey->cell_count + 1,
                sizeof *spread->beside_first);
    ewa_spool_close(&spread->spool);
}
