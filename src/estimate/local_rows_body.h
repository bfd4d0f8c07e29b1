// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The part of local_body.h that brings the neighbours of a block's lanes together: a quarter of what a block holds
// is near any one of its places, and what goes through a row of neighbours skips the others. Each lane has its
// neighbours in the order of the candidates, so that sums are those over all candidates. No section of
// docs/math.md is about it.

enum { WORD_BITS = 32, WORDS = EWA_BLOCK_CANDIDATES / WORD_BITS, KEY_INDEX_BITS = 10 };
_Static_assert(EWA_BLOCK_CANDIDATES <= 1 << KEY_INDEX_BITS, "the candidate fits its bits");

/// The key of no neighbour.
#define NO_KEY 3e38f

static inline vec row_offset(const local_row *row) {
    return (vec){wf_load(row->x), wf_load(row->y), wf_load(row->z)};
}

/// Bit k of each lane: whether candidate begin + k is its neighbour.
static wi find_inside(const ewa_block *block, uint32_t begin) {
    const wf radius2 = wf_load(block->radius2);
    const uint32_t left = block->candidate_count - begin, count = left < WORD_BITS ? left : WORD_BITS;
    wi word = wi_set(0);
    for (uint32_t k = 0; k < count; k++) {
        const wm in = wf_le(wf_load(block->distance2[begin + k]), radius2);
        word = wi_or(word, wi_of_bits(wf_keep(in, wf_of_bits(wi_set((int32_t)(1u << k))))));
    }
    return word;
}

/// Writes rows of neighbours, one of each lane; lanes that have none left stay at their place, where they add
/// nothing, until all candidates of a word are through. Values are keys for link_nearest(): the squared distance
/// to 1 part in 8192 above the number of the candidate, so that ties go to the lower one. Returns the number of
/// rows, which candidates are no fewer than; `*count` gets that of each lane's neighbours.
static uint32_t arrange(const ewa_block *block, local_batch *batch, wf *count) {
    const vec at = lanes_of(block);
    const wf zero = wf_set(0), one = wf_set(1);
    local_row *row = batch->row;
    *count = zero;
    for (uint32_t begin = 0; begin < block->candidate_count; begin += WORD_BITS) {
        wi word = find_inside(block, begin);
        for (;;) {
            // The exponent of the lowest bit is its number; the sign of the last one is not looked at.
            const wi lowest = wi_and(word, wi_sub(wi_set(0), word));
            const wf power = wf_from_i(lowest);
            const wm found = wf_lt(zero, wf_abs(power));
            if (!wm_bits(found)) break;
            const wi number =
                wi_and(wi_sub(wi_sar(wi_of_bits(power), 23), wi_set(127)), wi_set(WORD_BITS - 1));
            const vec to = {wf_lookup32(&block->x[begin], number), wf_lookup32(&block->y[begin], number),
                            wf_lookup32(&block->z[begin], number)};
            vec d = v_sub(to, at);
            d = (vec){wf_keep(found, d.x), wf_keep(found, d.y), wf_keep(found, d.z)};
            const wf distance2 = v_dot(d, d);
            const wi upper = wi_shl(wi_sar(wi_of_bits(distance2), KEY_INDEX_BITS), KEY_INDEX_BITS);
            const wf key = wf_of_bits(wi_or(upper, wi_add(number, wi_set((int32_t)begin))));
            wf_store(row->x, d.x);
            wf_store(row->y, d.y);
            wf_store(row->z, d.z);
            wf_store(row->distance2, distance2);
            wf_store(row->value, wf_select(found, key, wf_set(NO_KEY)));
            *count = wf_add(*count, wf_keep(found, one));
            word = wi_sub(word, lowest);
            row++;
        }
    }
    batch->row_count = (uint32_t)(row - batch->row);
    return batch->row_count;
}

static void sum_moments(const local_batch *batch, uint32_t rows, moments *m) {
    for (uint32_t i = 0; i < rows; i++) add_offset(m, row_offset(&batch->row[i]));
}
