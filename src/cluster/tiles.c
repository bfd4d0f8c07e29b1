// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which rank has splats in which tiles, and at which rank those of a tile meet: at one that has some, so that these
// need not travel.
#include "cluster/tiles.h"

#include <string.h>

enum { WORD_BITS = 64 };

static size_t word_count(uint32_t tiles) { return (tiles + WORD_BITS - 1) / WORD_BITS; }

/// Whether a rank has splats in a tile.
static bool is_busy(const ewa_joint_tiles *tiles, uint32_t rank, uint32_t tile) {
    const uint64_t *words =
        (const uint64_t *)tiles->busy.data + (size_t)(rank + 1) * word_count(tiles->tile_count);
    return words[tile / WORD_BITS] >> tile % WORD_BITS & 1;
}

/// Gathers a bit for each tile and rank; this rank's come first, too.
static ewa_status gather_busy(ewa_context *context, const ewa_exchange *exchange, const ewa_tile_job *job,
                              ewa_joint_tiles *tiles) {
    const size_t words = word_count(tiles->tile_count);
    EWA_TRY(ewa_buffer_reserve(context, &tiles->busy, words * ((size_t)exchange->rank_count + 1),
                               sizeof(uint64_t)));
    uint64_t *mine = tiles->busy.data;
    memset(mine, 0, words * sizeof *mine);
    for (uint32_t i = 0; i < job->source_count; i++) {
        const uint64_t *starts = job->sources[i].bins.lists.starts;
        for (uint32_t tile = 0; tile < tiles->tile_count; tile++)
            if (starts[tile + 1] > starts[tile]) mine[tile / WORD_BITS] |= (uint64_t)1 << tile % WORD_BITS;
    }
    return ewa_exchange_gather(context, exchange, mine, words * sizeof *mine, mine + words);
}

/// Settles the owners; counts what there is of each kind.
static void choose_owners(const ewa_exchange *exchange, ewa_joint_tiles *tiles) {
    tiles->alone_count = tiles->contribution_count = tiles->reduction_count = tiles->incoming_count = 0;
    for (uint32_t tile = 0; tile < tiles->tile_count; tile++) {
        uint32_t count = 0;
        for (uint32_t r = 0; r < exchange->rank_count; r++) count += is_busy(tiles, r, tile);
        // One after the other of those that have some, or of all where nobody has.
        uint32_t left = tile % (count ? count : exchange->rank_count), owner = 0;
        while (count && (!is_busy(tiles, owner, tile) || left)) left -= is_busy(tiles, owner++, tile);
        if (!count) owner = left;
        tiles->owners[tile] = owner;
        tiles->busy_counts[tile] = count;
        const bool owned = owner == exchange->rank;
        tiles->alone_count += owned && count < 2;
        if (count < 2) continue;
        tiles->contribution_count += is_busy(tiles, exchange->rank, tile);
        tiles->reduction_count += owned;
        tiles->incoming_count += owned ? count : 0;
    }
}

static ewa_status reserve(ewa_context *context, const ewa_exchange *exchange, ewa_joint_tiles *tiles) {
    const uint32_t ranks = exchange->rank_count;
    EWA_TRY(ewa_buffer_reserve(context, &tiles->contribution_buffer, tiles->contribution_count,
                               sizeof *tiles->contributions));
    EWA_TRY(ewa_buffer_reserve(context, &tiles->reduction_buffer, tiles->reduction_count + (size_t)1,
                               sizeof *tiles->reductions));
    EWA_TRY(
        ewa_buffer_reserve(context, &tiles->incoming_buffer, tiles->incoming_count, sizeof *tiles->incoming));
    EWA_TRY(ewa_buffer_grow(context, &tiles->numbers, 2 * (size_t)tiles->tile_count,
                            3 * (size_t)tiles->tile_count + ranks + 1 + tiles->incoming_count,
                            sizeof(uint32_t)));
    tiles->contributions = tiles->contribution_buffer.data;
    tiles->reductions = tiles->reduction_buffer.data;
    tiles->incoming = tiles->incoming_buffer.data;
    tiles->owners = tiles->numbers.data;
    tiles->busy_counts = tiles->owners + tiles->tile_count;
    tiles->alone = tiles->busy_counts + tiles->tile_count;
    tiles->contribution_first = tiles->alone + tiles->tile_count;
    tiles->order = tiles->contribution_first + ranks + 1;
    return EWA_OK;
}

/// Lists the tiles that the rank owns.
static void list_owned(const ewa_exchange *exchange, ewa_joint_tiles *tiles) {
    uint32_t alone = 0, reductions = 0, incoming = 0;
    for (uint32_t tile = 0; tile < tiles->tile_count; tile++) {
        if (tiles->owners[tile] != exchange->rank) continue;
        if (tiles->busy_counts[tile] < 2) {
            tiles->alone[alone++] = tile;
            continue;
        }
        tiles->reductions[reductions++] = (ewa_joint_reduction){tile, incoming, true};
        incoming += tiles->busy_counts[tile];
    }
    tiles->reductions[reductions].first_incoming = incoming;
    incoming = 0;
    for (uint32_t r = 0; r < exchange->rank_count; r++) {
        if (r == exchange->rank) tiles->own_incoming_first = incoming;
        for (uint32_t m = 0; m < reductions; m++) {
            if (!is_busy(tiles, r, tiles->reductions[m].tile)) continue;
            tiles->incoming[incoming] = (ewa_joint_incoming){r, m};
            // Filled from the front: the beginnings are put back below.
            tiles->order[tiles->reductions[m].first_incoming++] = incoming++;
        }
    }
    for (uint32_t m = reductions; m > 0; m--)
        tiles->reductions[m].first_incoming = tiles->reductions[m - 1].first_incoming;
    tiles->reductions[0].first_incoming = 0;
}

/// Lists the tiles of several ranks that this one has splats in: a counting sort by owners.
static void list_contributions(const ewa_exchange *exchange, ewa_joint_tiles *tiles) {
    uint32_t *first = tiles->contribution_first;
    memset(first, 0, ((size_t)exchange->rank_count + 1) * sizeof *first);
    for (int fill = 0; fill < 2; fill++) {
        for (uint32_t tile = 0; tile < tiles->tile_count; tile++) {
            if (tiles->busy_counts[tile] < 2 || !is_busy(tiles, exchange->rank, tile)) continue;
            const uint32_t owner = tiles->owners[tile];
            if (fill) tiles->contributions[first[owner]] = (ewa_joint_contribution){tile, owner, true};
            first[owner + (fill ? 0 : 1)]++;
        }
        for (uint32_t r = 0; r < exchange->rank_count && !fill; r++) first[r + 1] += first[r];
    }
    // Each beginning has become the next one's.
    for (uint32_t r = exchange->rank_count; r > 0; r--) first[r] = first[r - 1];
    first[0] = 0;
}

ewa_status ewa_joint_tiles_assign(ewa_context *context, const ewa_exchange *exchange, const ewa_tile_job *job,
                                  ewa_joint_tiles *tiles) {
    tiles->tile_count = ewa_tiles_count(&job->tiles);
    EWA_TRY(gather_busy(context, exchange, job, tiles));
    EWA_TRY(ewa_buffer_reserve(context, &tiles->numbers, 2 * (size_t)tiles->tile_count, sizeof(uint32_t)));
    tiles->owners = tiles->numbers.data;
    tiles->busy_counts = tiles->owners + tiles->tile_count;
    choose_owners(exchange, tiles);
    EWA_TRY(reserve(context, exchange, tiles));
    list_owned(exchange, tiles);
    list_contributions(exchange, tiles);
    return EWA_OK;
}

void ewa_joint_tiles_free(ewa_context *context, ewa_joint_tiles *tiles) {
    ewa_buffer *const buffers[] = {&tiles->busy, &tiles->numbers, &tiles->contribution_buffer,
                                   &tiles->reduction_buffer, &tiles->incoming_buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
}
