// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Counts points by cells of a grid whose size adapts to them: cells double whenever there are too many.
#include "lod/statistics.h"
#include "cloud/cloud.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SLICE_POINTS = 1 << 15, // of a piece, counted by one task
    SLICE_TABLE = 1 << 16,
    SLICES = EWA_INPUT_PIECE_POINTS / SLICE_POINTS,
    TABLE = 4 * EWA_STATISTICS_CELLS,
    FIRST_CELLS_BITS = 9, // cells along the longest side of the first piece
    MAX_EXTENT_BITS = 31, // of all points, in steps: what LAS can hold
};

typedef struct count_cell {
    int64_t cell[3];
    uint64_t count; // 0: free
} count_cell;

typedef struct slice_result {
    int64_t minimum[3], maximum[3];
    uint64_t left_out_count;
    uint32_t cell_count;
    count_cell *cells; // [SLICE_POINTS]
    bool *varies;      // [column]
} slice_result;

typedef struct statistics_job {
    const ewa_inputs *inputs;
    ewa_context *context;
    ewa_statistics *statistics;
    const ewa_cloud *piece;
    int64_t *places;    // of the piece's points
    count_cell *tables; // one of SLICE_TABLE per worker
    uint32_t worker_count;
    slice_result slices[SLICES];
    uint32_t slice_count;
    count_cell *table;
    uint32_t cell_count;
    uint32_t shift; // cells are 2^shift steps wide
    bool begun;
} statistics_job;

uint64_t ewa_statistics_places(const ewa_lattice *lattice, const ewa_cloud *piece, uint64_t first,
                               uint64_t count, int64_t *places) {
    enum { BLOCK = 512 };
    static const double MAXIMUM = 0x1p52;
    const ewa_attribute *position = ewa_cloud_find(piece, EWA_POSITION);
    double origin[3], block[3 * BLOCK];
    ewa_cloud_origin(piece, origin);
    for (int c = 0; c < 3; c++) origin[c] -= lattice->offset_world[c];
    const double per_step = 1 / lattice->step_world;
    uint64_t left_out_count = 0;
    for (uint64_t done = 0; done < count; done += BLOCK) {
        const uint64_t part = count - done < BLOCK ? count - done : BLOCK;
        ewa_attribute_read_f64(position, first + done, part, block);
        for (uint64_t i = 0; i < part; i++, places += 3) {
            bool good = true;
            for (int c = 0; c < 3; c++) {
                const double place = (block[3 * i + (uint64_t)c] + origin[c]) * per_step;
                good = good && fabs(place) < MAXIMUM;
                places[c] = good ? llrint(place) : 0;
            }
            if (good) continue;
            places[0] = EWA_NOWHERE;
            left_out_count++;
        }
    }
    return left_out_count;
}

/// Whether some of `count` groups of bytes behind each other are others than `value`: without a branch, several at a time.
#define DEFINE_DIFFERS(type)                                                                                 \
    static bool differs_##type(const uint8_t *bytes, uint64_t count, const uint8_t *value) {                 \
        type all = 0, number, wanted;                                                                        \
        memcpy(&wanted, value, sizeof wanted);                                                               \
        for (uint64_t i = 0; i < count; i++) {                                                               \
            memcpy(&number, bytes + i * sizeof number, sizeof number);                                       \
            all |= (type)(number ^ wanted);                                                                  \
        }                                                                                                    \
        return all != 0;                                                                                     \
    }

DEFINE_DIFFERS(uint8_t)
DEFINE_DIFFERS(uint16_t)
DEFINE_DIFFERS(uint32_t)

bool ewa_statistics_differs(const ewa_statistics_column *column, const ewa_attribute *attribute, uint64_t first, uint64_t count) {
    const uint8_t *bytes = (const uint8_t *)attribute->data + first * attribute->stride_bytes;
    const size_t dense_bytes = attribute->stride_bytes == column->size_bytes ? column->size_bytes : 0;
    if (dense_bytes == 1) return differs_uint8_t(bytes, count, column->value);
    if (dense_bytes == 2) return differs_uint16_t(bytes, count, column->value);
    if (dense_bytes == 4) return differs_uint32_t(bytes, count, column->value);
    for (uint64_t i = 0; i < count; i++)
        if (memcmp(bytes + i * attribute->stride_bytes, column->value, column->size_bytes) != 0) return true;
    return false;
}

static inline uint64_t mix(const int64_t cell[3]) {
    uint64_t h = (uint64_t)cell[0] * 0x9e3779b97f4a7c15u ^ (uint64_t)cell[1] * 0xc2b2ae3d27d4eb4fu ^
                 (uint64_t)cell[2] * 0x165667b19e3779f9u;
    return h ^ h >> 29;
}

/// Adds to the count of a cell of an open table; returns whether the cell is new.
static bool add_to(count_cell *table, uint32_t capacity, const int64_t cell[3], uint64_t count) {
    for (uint64_t at = mix(cell);; at++) {
        count_cell *slot = &table[at & (capacity - 1)];
        const bool is_new = slot->count == 0;
        if (is_new) memcpy(slot->cell, cell, sizeof slot->cell);
        if (!is_new && memcmp(slot->cell, cell, sizeof slot->cell) != 0) continue;
        slot->count += count;
        return is_new;
    }
}

static void look_for_changes(const statistics_job *s, uint64_t first, uint64_t count, bool *varies) {
    uint32_t column = 0;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(s->piece); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(s->piece, a);
        if (strcmp(attribute->name, EWA_POSITION) == 0) continue;
        const ewa_statistics_column *known = &s->statistics->columns[column];
        bool *changed = &varies[column++];
        *changed = !known->constant || ewa_statistics_differs(known, attribute, first, count);
    }
}

static void place_slice(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    statistics_job *s = data;
    slice_result *r = &s->slices[index];
    const uint64_t first = (uint64_t)index * SLICE_POINTS, left = ewa_cloud_point_count(s->piece) - first;
    const uint64_t count = left < SLICE_POINTS ? left : SLICE_POINTS;
    int64_t *places = s->places + 3 * first;
    r->left_out_count = ewa_statistics_places(&s->statistics->lattice, s->piece, first, count, places);
    for (int c = 0; c < 3; c++) r->minimum[c] = INT64_MAX, r->maximum[c] = INT64_MIN;
    for (uint64_t i = 0; i < count; i++) {
        if (places[3 * i] == EWA_NOWHERE) continue;
        for (uint64_t c = 0; c < 3; c++) {
            if (places[3 * i + c] < r->minimum[c]) r->minimum[c] = places[3 * i + c];
            if (places[3 * i + c] > r->maximum[c]) r->maximum[c] = places[3 * i + c];
        }
    }
    look_for_changes(s, first, count, r->varies);
}

static void count_slice(void *data, uint32_t index, uint32_t worker) {
    statistics_job *s = data;
    slice_result *r = &s->slices[index];
    count_cell *table = s->tables + (size_t)worker * SLICE_TABLE;
    const uint64_t first = (uint64_t)index * SLICE_POINTS, left = ewa_cloud_point_count(s->piece) - first;
    const uint64_t count = left < SLICE_POINTS ? left : SLICE_POINTS;
    const int64_t *places = s->places + 3 * first;
    memset(table, 0, SLICE_TABLE * sizeof *table);
    int64_t last[3] = {0};
    uint64_t run = 0;
    for (uint64_t i = 0; i < count; i++) {
        if (places[3 * i] == EWA_NOWHERE) continue;
        int64_t cell[3];
        for (uint64_t c = 0; c < 3; c++) cell[c] = places[3 * i + c] >> s->shift;
        if (run && memcmp(cell, last, sizeof cell) == 0) {
            run++;
            continue;
        }
        if (run) add_to(table, SLICE_TABLE, last, run);
        memcpy(last, cell, sizeof last);
        run = 1;
    }
    if (run) add_to(table, SLICE_TABLE, last, run);
    r->cell_count = 0;
    for (uint32_t i = 0; i < SLICE_TABLE; i++)
        if (table[i].count) r->cells[r->cell_count++] = table[i];
}

/// Doubles the cells.
static ewa_status coarsen(statistics_job *s) {
    count_cell *table = ewa_allocate_zeroed(s->context, TABLE, sizeof *table);
    if (!table) return EWA_ERROR_MEMORY;
    s->cell_count = 0;
    for (uint32_t i = 0; i < TABLE; i++) {
        count_cell *old = &s->table[i];
        if (!old->count) continue;
        for (int c = 0; c < 3; c++) old->cell[c] >>= 1;
        s->cell_count += add_to(table, TABLE, old->cell, old->count);
    }
    ewa_release(s->context, s->table, TABLE, sizeof *s->table);
    s->table = table;
    s->shift++;
    return EWA_OK;
}

static uint32_t bits_of(uint64_t number) { return number ? 64 - (uint32_t)__builtin_clzll(number) : 0; }

static uint64_t longest_side(const ewa_statistics *statistics) {
    uint64_t side = 0;
    for (int c = 0; c < 3 && statistics->point_count; c++) {
        const uint64_t extent = (uint64_t)(statistics->maximum[c] - statistics->minimum[c]) + 1;
        side = extent > side ? extent : side;
    }
    return side;
}

/// Takes the first point's numbers as those that all others may have.
static void take_values(statistics_job *s) {
    uint32_t column = 0;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(s->piece); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(s->piece, a);
        if (strcmp(attribute->name, EWA_POSITION) == 0) continue;
        ewa_statistics_column *known = &s->statistics->columns[column++];
        if (!known->seen) memcpy(known->value, attribute->data, known->size_bytes);
        known->seen = true;
    }
}

static ewa_status count_piece(void *user, const ewa_cloud *piece) {
    statistics_job *s = user;
    ewa_statistics *statistics = s->statistics;
    const uint64_t count = ewa_cloud_point_count(piece);
    s->piece = piece;
    s->slice_count = (uint32_t)((count + SLICE_POINTS - 1) / SLICE_POINTS);
    take_values(s);
    ewa_parallel(s->context, place_slice, s, s->slice_count);
    statistics->point_count += count;
    for (uint32_t i = 0; i < s->slice_count; i++) {
        const slice_result *r = &s->slices[i];
        statistics->point_count -= r->left_out_count;
        statistics->left_out_count += r->left_out_count;
        for (int c = 0; c < 3; c++) {
            if (r->minimum[c] < statistics->minimum[c]) statistics->minimum[c] = r->minimum[c];
            if (r->maximum[c] > statistics->maximum[c]) statistics->maximum[c] = r->maximum[c];
        }
        for (uint32_t k = 0; k < statistics->column_count; k++)
            if (r->varies[k]) statistics->columns[k].constant = false;
    }
    if (!statistics->point_count) return EWA_OK;
    const uint32_t side_bits = bits_of(longest_side(statistics));
    if (!s->begun) s->shift = side_bits > FIRST_CELLS_BITS ? side_bits - FIRST_CELLS_BITS : 0;
    s->begun = true;
    // Codes have so many levels only.
    while (side_bits > s->shift + EWA_CODE_LEVELS - 2) EWA_TRY(coarsen(s));
    ewa_parallel(s->context, count_slice, s, s->slice_count);
    const uint32_t counted_shift = s->shift;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < s->slice_count; i++)
        for (uint32_t k = 0; k < s->slices[i].cell_count && status == EWA_OK; k++) {
            count_cell *cell = &s->slices[i].cells[k];
            for (int c = 0; c < 3; c++) cell->cell[c] >>= s->shift - counted_shift;
            s->cell_count += add_to(s->table, TABLE, cell->cell, cell->count);
            if (s->cell_count > EWA_STATISTICS_CELLS) status = coarsen(s);
        }
    return status;
}

static int compare_cells(const void *a, const void *b) {
    const ewa_statistics_cell *p = a, *q = b;
    return p->prefix < q->prefix ? -1 : p->prefix > q->prefix;
}

/// Fixes the root's cube, and the cells in it.
static ewa_status fix_root_cube(statistics_job *s) {
    ewa_statistics *statistics = s->statistics;
    ewa_lattice *lattice = &statistics->lattice;
    uint64_t cells = 1;
    for (int c = 0; c < 3; c++) {
        const int64_t first = statistics->point_count ? statistics->minimum[c] >> s->shift : 0;
        const int64_t last = statistics->point_count ? statistics->maximum[c] >> s->shift : 0;
        lattice->low[c] = (int64_t)((uint64_t)first << s->shift);
        if ((uint64_t)(last - first) + 1 > cells) cells = (uint64_t)(last - first) + 1;
    }
    statistics->cell_level = bits_of(cells - 1);
    lattice->bits = statistics->cell_level + s->shift;
    statistics->cell_capacity = s->cell_count;
    statistics->cells = ewa_allocate(s->context, statistics->cell_capacity, sizeof *statistics->cells);
    if (!statistics->cells) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < TABLE; i++) {
        if (!s->table[i].count) continue;
        int64_t place[3];
        for (int c = 0; c < 3; c++) place[c] = (int64_t)((uint64_t)s->table[i].cell[c] << s->shift);
        statistics->cells[statistics->cell_count++] = (ewa_statistics_cell){
            ewa_code_prefix(ewa_lattice_code(lattice, place), statistics->cell_level), s->table[i].count};
    }
    qsort(statistics->cells, statistics->cell_count, sizeof *statistics->cells, compare_cells);
    statistics->record_bytes = 3 * sizeof(uint32_t);
    for (uint32_t k = 0; k < statistics->column_count; k++) {
        ewa_statistics_column *column = &statistics->columns[k];
        if (column->constant) continue;
        column->at_bytes = statistics->record_bytes;
        statistics->record_bytes += column->size_bytes;
    }
    return EWA_OK;
}

static ewa_status make_columns(const ewa_inputs *inputs, ewa_statistics *statistics) {
    statistics->column_count = ewa_cloud_attribute_count(inputs->prototype) - 1;
    statistics->columns =
        ewa_allocate_zeroed(inputs->context, statistics->column_count, sizeof *statistics->columns);
    if (!statistics->columns) return EWA_ERROR_MEMORY;
    uint32_t column = 0;
    for (uint32_t a = 0; a <= statistics->column_count; a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(inputs->prototype, a);
        if (strcmp(attribute->name, EWA_POSITION) == 0) continue;
        statistics->columns[column++] = (ewa_statistics_column){
            .size_bytes = (uint32_t)(attribute->component_count * ewa_type_bytes(attribute->type)),
            .constant = true};
    }
    return EWA_OK;
}

static void free_job(statistics_job *s) {
    for (uint32_t i = 0; i < SLICES; i++) {
        ewa_release(s->context, s->slices[i].cells, SLICE_POINTS, sizeof *s->slices[i].cells);
        ewa_release(s->context, s->slices[i].varies, s->statistics->column_count,
                    sizeof *s->slices[i].varies);
    }
    ewa_release(s->context, s->places, 3 * EWA_INPUT_PIECE_POINTS, sizeof *s->places);
    ewa_release(s->context, s->tables, (size_t)s->worker_count * SLICE_TABLE, sizeof *s->tables);
    ewa_release(s->context, s->table, TABLE, sizeof *s->table);
}

static ewa_status make_job(const ewa_inputs *inputs, ewa_statistics *statistics, statistics_job *s) {
    ewa_context *context = inputs->context;
    *s = (statistics_job){.inputs = inputs,
                          .context = context,
                          .statistics = statistics,
                          .worker_count = ewa_context_worker_count(context)};
    s->places = ewa_allocate(context, 3 * EWA_INPUT_PIECE_POINTS, sizeof *s->places);
    s->tables = ewa_allocate(context, (size_t)s->worker_count * SLICE_TABLE, sizeof *s->tables);
    s->table = ewa_allocate_zeroed(context, TABLE, sizeof *s->table);
    bool good = s->places && s->tables && s->table;
    for (uint32_t i = 0; i < SLICES && good; i++) {
        s->slices[i].cells = ewa_allocate(context, SLICE_POINTS, sizeof *s->slices[i].cells);
        s->slices[i].varies = ewa_allocate(context, statistics->column_count, sizeof *s->slices[i].varies);
        good = s->slices[i].cells && s->slices[i].varies;
    }
    return good ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Grows the box of all points, for files whose coordinates are on no grid.
static ewa_status grow_box(void *user, const ewa_cloud *piece) {
    ewa_bounds *all = user;
    ewa_bounds bounds;
    const ewa_status status = ewa_cloud_measure(piece, &bounds);
    for (int c = 0; c < 3 && bounds.finite_count; c++) {
        all->low_world[c] = fmin(all->low_world[c], bounds.low_world[c]);
        all->high_world[c] = fmax(all->high_world[c], bounds.high_world[c]);
    }
    all->finite_count += bounds.finite_count;
    return status;
}

/// Chooses the steps of the coordinates: those of the files, or decimal ones, 10^8 or more of which make the box.
static ewa_status choose_steps(ewa_inputs *inputs, ewa_lattice *lattice) {
    ewa_coordinate_grid grid;
    ewa_cloud_grid(inputs->prototype, &grid);
    if (inputs->has_grid) {
        lattice->step_world = inputs->min_step_world;
        memcpy(lattice->offset_world, grid.offset_world, sizeof lattice->offset_world);
        return EWA_OK;
    }
    ewa_bounds all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    const ewa_status status = ewa_inputs_read(inputs, "bounds", grow_box, &all);
    double extent = 0;
    for (int c = 0; c < 3; c++) {
        lattice->offset_world[c] = 0;
        if (!all.finite_count) continue;
        extent = fmax(extent, all.high_world[c] - all.low_world[c]);
    }
    lattice->step_world = extent > 0 ? pow(10, floor(log10(extent)) - 8) : 1e-3;
    for (int c = 0; c < 3 && all.finite_count; c++) {
        // Whole steps, and not so many that doubles lose them.
        const double middle = all.low_world[c] / 2 + all.high_world[c] / 2;
        lattice->offset_world[c] = floor(middle / (1e6 * lattice->step_world)) * (1e6 * lattice->step_world);
    }
    return status;
}

ewa_status ewa_statistics_make(ewa_inputs *inputs, ewa_statistics *statistics) {
    enum { COARSER = 10, TRIES = 12 };
    *statistics = (ewa_statistics){0};
    EWA_TRY(make_columns(inputs, statistics));
    EWA_TRY(choose_steps(inputs, &statistics->lattice));
    ewa_status status = EWA_OK;
    for (int i = 0; status == EWA_OK; i++) {
        statistics_job s;
        statistics->point_count = statistics->left_out_count = 0;
        for (int c = 0; c < 3; c++) statistics->minimum[c] = INT64_MAX, statistics->maximum[c] = INT64_MIN;
        status = make_job(inputs, statistics, &s);
        if (status == EWA_OK) status = ewa_inputs_read(inputs, "statistics", count_piece, &s);
        const bool fits = bits_of(longest_side(statistics)) <= MAX_EXTENT_BITS;
        if (status == EWA_OK && fits) status = fix_root_cube(&s);
        free_job(&s);
        if (status != EWA_OK || fits) break;
        if (i == TRIES)
            status = ewa_fail(inputs->context, EWA_ERROR_LIMIT, "%s: coordinates are too far apart",
                              inputs->paths[0]);
        ewa_report(inputs->context, EWA_SEVERITY_WARNING,
                   "%s: coordinates in steps of %g do not fit the 32 bits of LAS; steps of %g are taken",
                   inputs->paths[0], statistics->lattice.step_world,
                   COARSER * statistics->lattice.step_world);
        statistics->lattice.step_world *= COARSER;
    }
    return status;
}

void ewa_statistics_free(ewa_context *context, ewa_statistics *statistics) {
    ewa_release(context, statistics->cells, statistics->cell_capacity, sizeof *statistics->cells);
    ewa_release(context, statistics->columns, statistics->column_count, sizeof *statistics->columns);
    *statistics = (ewa_statistics){0};
}
