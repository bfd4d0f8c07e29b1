// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Levels of a file of Gaussians that does not have to fit into memory. The order along the Morton curve is that of all, on a grid over all: so
// the file is read first for the grid, then for how many Gaussians its cells have, of which those in a row that fit into memory together
// make a bin, then to put each Gaussian into the part of a temporary file that is its bin's. The bins are ordered one after the other, and
// what comes out is, to the byte, what comes of the same set in memory.
#include "cloud/morton.h"
#include "io/file.h"
#include "io/gaussian/levels_write.h"
#include "io/gaussian/ply.h"
#include "io/gaussian/streamed.h"
#include "io/spool.h"

enum {
    PIECE_GAUSSIANS = 1 << 17, ///< that are read at a time
    BIN_BYTES = 16 << 20,      ///< of the Gaussians of a bin
    BLOCK_BYTES = 1 << 18,     ///< of a bin that are written at a time
    CODE_BITS = 63,
    DIGIT_BITS = 15, ///< of codes: cells that have too many are divided by so many bits
    DIGITS = 1 << DIGIT_BITS,
};

/// Cells in a row along the curve: codes from `first` on, up to where the next begins.
typedef struct cell {
    uint64_t first, count;
    uint32_t shift;   ///< lower bits of its codes that are free
    uint32_t *counts; ///< [DIGITS] while it is divided
} cell;

/// What is in memory of a bin while the file is read, and where the rest is.
typedef struct bin {
    uint64_t first_code, count, put; ///< put: of the count, into records
    ewa_buffer blocks; ///< of uint64_t: places in the temporary file
    size_t block_count;
    float *records; ///< that are in no block yet
    uint32_t filled;
} bin;

typedef struct building {
    ewa_context *context;
    const ewa_gaussian_source *source;
    ewa_ply_header *header;
    const ewa_gaussians_save_options *options;
    uint64_t count;
    bool mapped, classes_told; ///< mapped: the source is
    bool repeated; ///< the file was read once: what there is to say of it was said
    ewa_gaussian_facts facts;
    ewa_gaussians like; ///< the degree, the filter and the count of all
    ewa_bounds box;
    uint64_t *codes; ///< [PIECE_GAUSSIANS]
    ewa_buffer cells, bins;
    uint32_t cell_count, bin_count;
    uint32_t numbers, block_records; ///< floats of a record, records of a block
    ewa_spool *spool;
} building;

typedef ewa_status piece_take(building *b, const ewa_gaussians *piece);

/// Reads the file, piece by piece.
static ewa_status each_piece(building *b, piece_take *take) {
    for (uint64_t first = 0; first < b->count; first += PIECE_GAUSSIANS) {
        const uint64_t left = b->count - first;
        ewa_gaussians piece;
        if (b->repeated) ewa_reports_hush(b->context, true);
        ewa_status status = ewa_gaussians_ply_piece(b->source, b->header, first, (uint32_t)(left < PIECE_GAUSSIANS ? left : PIECE_GAUSSIANS), &piece,
                                                    &b->facts);
        if (b->repeated) ewa_reports_hush(b->context, false);
        if (status == EWA_OK) status = ewa_gaussians_turn_up(&piece, b->facts.up_world);
        if (status == EWA_OK) status = take(b, &piece);
        ewa_gaussians_free(&piece);
        if (b->mapped) ewa_file_passed(b->source->bytes, b->header->body_at + first * ewa_ply_vertices(b->header)->record_bytes);
        EWA_TRY(status);
    }
    b->repeated = true;
    return EWA_OK;
}

/// Widens the box of all.
static ewa_status take_box(building *b, const ewa_gaussians *piece) {
    if (piece->classes && !b->classes_told)
        ewa_report(b->context, EWA_SEVERITY_WARNING, "%s: streamed SOG has no room for classes, which .ply has", b->source->name);
    b->classes_told = piece->classes;
    b->like.sh_degree = piece->sh_degree, b->like.flat = piece->flat, b->like.antialiased = piece->antialiased;
    for (size_t i = 0; i < piece->count; i++)
        for (size_t k = 0; k < 3; k++) {
            const double at = (double)piece->centers[3 * i + k];
            b->box.low_world[k] = fmin(b->box.low_world[k], at), b->box.high_world[k] = fmax(b->box.high_world[k], at);
        }
    return EWA_OK;
}

/// The last of `count` entries, each of which begins with a code, whose code is at most that.
static size_t find(const void *entries, size_t size_bytes, size_t count, uint64_t code) {
    size_t low = 0, high = count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        uint64_t first;
        memcpy(&first, (const uint8_t *)entries + middle * size_bytes, sizeof first);
        *(first <= code ? &low : &high) = middle;
    }
    return low;
}

static ewa_status take_counts(building *b, const ewa_gaussians *piece) {
    cell *cells = b->cells.data;
    ewa_morton_codes(b->context, &b->box, piece->centers, piece->count, b->codes);
    for (uint32_t i = 0; i < piece->count; i++) {
        cell *own = &cells[find(cells, sizeof *cells, b->cell_count, b->codes[i])];
        if (own->counts) own->counts[(b->codes[i] - own->first) >> (own->shift - DIGIT_BITS)]++;
    }
    return EWA_OK;
}

static void free_counts(building *b) {
    cell *cells = b->cells.data;
    for (uint32_t i = 0; i < b->cell_count; i++) ewa_release(b->context, cells[i].counts, DIGITS, sizeof *cells[i].counts);
    for (uint32_t i = 0; i < b->cell_count; i++) cells[i].counts = NULL;
}

static uint64_t bin_room(const building *b) { return BIN_BYTES / (b->numbers * sizeof(float)); }

/// Puts the parts of counted cells in the place of these.
static ewa_status divide_cells(building *b) {
    const cell *from = b->cells.data;
    ewa_buffer made = {.data = NULL};
    uint32_t count = 0;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < b->cell_count && status == EWA_OK; i++)
        for (uint32_t digit = 0; digit < (from[i].counts ? DIGITS : 1) && status == EWA_OK; digit++) {
            cell part = {from[i].first, from[i].count, from[i].shift, NULL};
            if (from[i].counts) {
                part.shift -= DIGIT_BITS;
                part.first += (uint64_t)digit << part.shift, part.count = from[i].counts[digit];
            }
            if (part.count) status = ewa_buffer_grow(b->context, &made, count, count + (size_t)1, sizeof part);
            if (part.count && status == EWA_OK) ((cell *)made.data)[count++] = part;
        }
    free_counts(b);
    ewa_buffer_free(b->context, &b->cells);
    b->cells = made, b->cell_count = count;
    return status;
}

/// Counts what cells have, until none that can be divided has more than a bin has room for.
static ewa_status count_cells(building *b) {
    EWA_TRY(ewa_buffer_grow(b->context, &b->cells, 0, 1, sizeof(cell)));
    *(cell *)b->cells.data = (cell){0, b->count, CODE_BITS, NULL};
    for (b->cell_count = 1;;) {
        cell *cells = b->cells.data;
        bool any = false;
        for (uint32_t i = 0; i < b->cell_count; i++) {
            if (cells[i].count <= bin_room(b) || cells[i].shift < DIGIT_BITS) continue;
            cells[i].counts = ewa_allocate_zeroed(b->context, DIGITS, sizeof *cells[i].counts);
            if (!cells[i].counts) return EWA_ERROR_MEMORY;
            any = true;
        }
        if (!any) return EWA_OK;
        EWA_TRY(each_piece(b, take_counts));
        EWA_TRY(divide_cells(b));
    }
}

/// Makes bins of cells in a row.
static ewa_status make_bins(building *b) {
    const cell *cells = b->cells.data;
    for (uint32_t i = 0; i < b->cell_count; i++) {
        bin *last = b->bin_count ? (bin *)b->bins.data + b->bin_count - 1 : NULL;
        if (last && last->count + cells[i].count <= bin_room(b)) {
            last->count += cells[i].count;
            continue;
        }
        EWA_TRY(ewa_buffer_grow(b->context, &b->bins, b->bin_count, b->bin_count + (size_t)1, sizeof(bin)));
        bin *made = (bin *)b->bins.data + b->bin_count++;
        *made = (bin){.first_code = b->bin_count > 1 ? cells[i].first : 0, .count = cells[i].count};
        made->records = ewa_allocate(b->context, b->block_records, b->numbers * sizeof(float));
        if (!made->records) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

static ewa_status put_block(building *b, bin *own) {
    uint64_t at_bytes;
    if (!own->filled) return EWA_OK;
    EWA_TRY(ewa_spool_put(b->spool, own->records, own->filled * (size_t)b->numbers * sizeof(float), &at_bytes));
    EWA_TRY(ewa_buffer_grow(b->context, &own->blocks, own->block_count, own->block_count + 1, sizeof at_bytes));
    ((uint64_t *)own->blocks.data)[own->block_count++] = at_bytes;
    own->filled = 0;
    return EWA_OK;
}

/// The streams of a set and the floats that each Gaussian has in it.
typedef struct streams {
    float *of[5];
    size_t numbers[5];
} streams;

static streams streams_of(const ewa_gaussians *set) {
    return (streams){{set->centers, set->scales, set->rotations, set->opacities, set->harmonics},
                     {3, 3, 4, 1, 3 * (size_t)ewa_sh_count(set->sh_degree)}};
}

/// A bin has the room that was counted, and no more.
static ewa_status fail_changed(const building *b) {
    return ewa_fail(b->context, EWA_ERROR_FORMAT, "%s: changed while it was read", b->source->name);
}

static ewa_status take_records(building *b, const ewa_gaussians *piece) {
    const streams from = streams_of(piece);
    ewa_morton_codes(b->context, &b->box, piece->centers, piece->count, b->codes);
    for (size_t i = 0; i < piece->count; i++) {
        bin *own = (bin *)b->bins.data + find(b->bins.data, sizeof *own, b->bin_count, b->codes[i]);
        if (own->put++ == own->count) return fail_changed(b);
        float *to = own->records + own->filled++ * (size_t)b->numbers;
        for (int s = 0; s < 5; s++, to += from.numbers[s - 1]) memcpy(to, from.of[s] + from.numbers[s] * i, from.numbers[s] * sizeof(float));
        if (own->filled == b->block_records) EWA_TRY(put_block(b, own));
    }
    return EWA_OK;
}

/// Reads a bin behind the first `at` Gaussians of a set.
static ewa_status get_bin(building *b, bin *own, ewa_gaussians *set, size_t at) {
    const streams to = streams_of(set);
    for (size_t block = 0; block < own->block_count; block++) {
        const uint64_t left = own->count - block * b->block_records;
        const uint32_t count = left < b->block_records ? (uint32_t)left : b->block_records;
        EWA_TRY(ewa_spool_get(b->spool, ((const uint64_t *)own->blocks.data)[block], own->records, count * (size_t)b->numbers * sizeof(float)));
        const float *from = own->records;
        for (uint32_t i = 0; i < count; i++, at++)
            for (int s = 0; s < 5; from += to.numbers[s++]) memcpy(to.of[s] + to.numbers[s] * at, from, to.numbers[s] * sizeof(float));
    }
    return EWA_OK;
}

/// Orders a bin, of a set behind the first `kept` Gaussians, which come first.
static ewa_status order_bin(const building *b, const ewa_gaussians *set, uint32_t kept, uint32_t *order) {
    const ewa_attribute position = {
        .data = set->centers + 3 * (size_t)kept, .type = EWA_F32, .component_count = 3, .stride_bytes = 3 * sizeof(float)};
    for (uint32_t i = 0; i < kept; i++) order[i] = i;
    EWA_TRY(ewa_morton_order_in(b->context, &position, set->count - kept, &b->box, NULL, order + kept, NULL));
    for (uint32_t i = kept; i < set->count; i++) order[i] += kept;
    return EWA_OK;
}

/// Keeps what is of no whole leaf yet, in order.
static ewa_status keep_rest(const ewa_gaussians *set, const uint32_t *order, uint32_t count, ewa_gaussians *rest) {
    EWA_TRY(ewa_gaussians_create(set->context, count, set->sh_degree, rest));
    const streams from = streams_of(set), to = streams_of(rest);
    for (size_t i = 0; i < count; i++)
        for (int s = 0; s < 5; s++)
            memcpy(to.of[s] + to.numbers[s] * i, from.of[s] + from.numbers[s] * order[i], from.numbers[s] * sizeof(float));
    return EWA_OK;
}

/// Has the leaves of a bin written; `*rest` has what was left of the ones before, then what is left.
static ewa_status write_bin(building *b, ewa_levels_writer *writer, bin *own, ewa_gaussians *rest) {
    ewa_gaussians set;
    size_t kept = 0;
    uint32_t taken = 0;
    EWA_TRY(ewa_gaussians_create(b->context, rest->count + (uint32_t)own->count, b->like.sh_degree, &set));
    if (rest->count) ewa_streamed_copy(rest, 0, rest->count, &set, &kept);
    ewa_gaussians_free(rest);
    uint32_t *order = ewa_allocate(b->context, set.count, sizeof *order);
    ewa_status status = order ? get_bin(b, own, &set, kept) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = order_bin(b, &set, (uint32_t)kept, order);
    if (status == EWA_OK) status = ewa_levels_writer_add(writer, &set, order, set.count, &taken);
    if (status == EWA_OK && taken < set.count) status = keep_rest(&set, order + taken, set.count - taken, rest);
    ewa_release(b->context, order, set.count, sizeof *order);
    ewa_gaussians_free(&set);
    return status;
}

static ewa_status write_bins(building *b, const char *to) {
    ewa_gaussian_target target = {.set = &b->like,
                                  .name = to,
                                  .sh_degree = b->options->sh_degree < b->like.sh_degree ? b->options->sh_degree : b->like.sh_degree};
    ewa_levels_writer *writer = NULL;
    ewa_gaussians rest = {.context = NULL};
    EWA_TRY(ewa_writer_open(b->context, to, &target.writer));
    ewa_status status = ewa_levels_writer_open(&target, &writer);
    for (uint32_t i = 0; i < b->bin_count && status == EWA_OK; i++) {
        bin *own = (bin *)b->bins.data + i;
        status = write_bin(b, writer, own, &rest);
        ewa_release(b->context, own->records, b->block_records, b->numbers * sizeof(float));
        own->records = NULL;
    }
    if (status == EWA_OK) status = ewa_levels_writer_finish(writer);
    ewa_gaussians_free(&rest);
    ewa_levels_writer_close(&writer);
    if (status == EWA_OK) return ewa_writer_commit(&target.writer);
    ewa_writer_abort(&target.writer);
    return status;
}

static ewa_status write_levels(building *b, const char *to) {
    b->codes = ewa_allocate(b->context, PIECE_GAUSSIANS, sizeof *b->codes);
    if (!b->codes) return EWA_ERROR_MEMORY;
    EWA_TRY(each_piece(b, take_box));
    b->numbers = 11 + 3 * ewa_sh_count(b->like.sh_degree);
    b->block_records = BLOCK_BYTES / (b->numbers * (uint32_t)sizeof(float));
    EWA_TRY(count_cells(b));
    EWA_TRY(make_bins(b));
    EWA_TRY(ewa_spool_open(b->context, to, &b->spool));
    EWA_TRY(each_piece(b, take_records));
    for (uint32_t i = 0; i < b->bin_count; i++) {
        bin *own = (bin *)b->bins.data + i;
        if (own->put != own->count) return fail_changed(b);
        EWA_TRY(put_block(b, own));
    }
    return write_bins(b, to);
}

static void free_all(building *b) {
    bin *bins = b->bins.data;
    free_counts(b);
    for (uint32_t i = 0; i < b->bin_count; i++) {
        ewa_release(b->context, bins[i].records, b->block_records, b->numbers * sizeof(float));
        ewa_buffer_free(b->context, &bins[i].blocks);
    }
    ewa_buffer_free(b->context, &b->bins);
    ewa_buffer_free(b->context, &b->cells);
    ewa_release(b->context, b->codes, PIECE_GAUSSIANS, sizeof *b->codes);
    ewa_release(b->context, b->header, 1, sizeof *b->header);
    ewa_spool_close(&b->spool);
}

/// Writes the levels of what a file has, if it is one that is read in pieces.
static ewa_status write_source(building *b, const char *to) {
    EWA_TRY(ewa_gaussians_ply_pieces(b->source, b->header, &b->count));
    if (b->count > UINT32_MAX)
        return ewa_fail(b->context, EWA_ERROR_LIMIT, "%s: %llu Gaussians are over the limit of %u", b->source->name, (unsigned long long)b->count,
                        UINT32_MAX);
    b->like = (ewa_gaussians){.context = b->context, .count = (uint32_t)b->count};
    return b->count ? write_levels(b, to) : EWA_OK;
}

ewa_status ewa_gaussians_write_file_levels(ewa_context *context, const char *from, const char *to, const ewa_gaussians_save_options *options,
                                           uint64_t *count) {
    ewa_file file;
    *count = 0;
    if (!ewa_file_may_read(context, from)) return EWA_OK;
    EWA_TRY(ewa_file_map(context, from, &file));
    const ewa_gaussian_source source = {context, from, from, file.bytes, file.size_bytes};
    building b = {.context = context, .source = &source, .mapped = file.mapped, .options = options};
    for (int k = 0; k < 3; k++) b.box.low_world[k] = INFINITY, b.box.high_world[k] = -INFINITY;
    b.header = ewa_allocate(context, 1, sizeof *b.header);
    const ewa_status status = b.header ? write_source(&b, to) : EWA_ERROR_MEMORY;
    *count = b.count;
    free_all(&b);
    ewa_file_unmap(context, &file);
    return status;
}
