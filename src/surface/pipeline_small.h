// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: the two passes over splats of few pixels (docs/math.md section 6). Blocks would be
// mostly empty: sixteen splats are evaluated at once, pixel by pixel, and what each pixel gets is added to all
// of its sums at once. The same terms as pipeline_raster.h adds, which test `small` compares.
#ifndef EWA_SRC_SURFACE_PIPELINE_SMALL_H
#define EWA_SRC_SURFACE_PIPELINE_SMALL_H

#include "surface/pipeline_raster.h"

/// Sixteen splats with boxes of as many pixels, a splat per lane: what their columns and rows share.
typedef struct small_splats {
    wf quadratic[EWA_SMALL_PX], cross[EWA_SMALL_PX], key_x[EWA_SMALL_PX],
        bound_x[EWA_SMALL_PX]; ///< by column
    wf dy;                     ///< of the first row
    wf yy, key_y, bound_y;
    wm steep;
    wf key_low, key_high, bound_scale, bound_offset; ///< of steep ones
    int32_t first_pixel[EWA_BLOCK_LANES];            ///< in ewa_tile.pixels
    /// Where pixels are in a plane: the sum of both.
    int32_t column_at[EWA_SMALL_PX][EWA_BLOCK_LANES], row_at[EWA_SMALL_PX][EWA_BLOCK_LANES];
} small_splats;

/// From a row of ewa_tile.pixels to the next.
static ALWAYS_INLINE size_t pixel_row_floats(const ewa_tile *tile) {
    return (size_t)tile->blocks_per_row * EWA_BLOCK_PX * EWA_PIXEL_FLOATS;
}

/// Splats `order[0 .. 16)`.
static ALWAYS_INLINE void load_small(const pass *p, const uint16_t *order, uint32_t columns, uint32_t rows,
                                     small_splats *s) {
    wf f[EWA_BLOCK_LANES];
    for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) f[i] = wf_load(&p->run->records[order[i]].offset_x);
    w_transpose(f);
    const wi box = wi_of_bits(f[15]), in_block = wi_set(EWA_BLOCK_PX - 1);
    const wi column_px = wi_and(wi_sar(box, EWA_SMALL_X_SHIFT), in_block),
             row_px = wi_and(wi_sar(box, EWA_SMALL_Y_SHIFT), in_block);
    const wf half = wf_set(0.5f), first_dx = wf_add(f[0], wf_add(wf_from_i(column_px), half));
    s->dy = wf_add(f[1], wf_add(wf_from_i(row_px), half));
    s->yy = f[4], s->key_y = f[7], s->bound_y = f[10];
    s->steep = wf_lt(wf_set(0), wf_from_i(wi_and(box, wi_set(EWA_STEEP_BIT))));
    s->bound_scale = f[8], s->bound_offset = f[9], s->key_high = f[10], s->key_low = f[11];
    // From a block to the next, and from a row of blocks.
    const wi x = wi_add(wi_shl(wi_and(box, wi_set(0x3f)), 2), column_px);
    const wi y = wi_add(wi_shl(wi_and(wi_sar(box, 8), wi_set(0x3f)), 2), row_px);
    const wf row_floats = wf_set((float)(p->tile->blocks_per_row * EWA_BLOCK_LANES));
    const wf row_pixels = wf_set((float)(p->tile->blocks_per_row * EWA_BLOCK_PX)),
             at = wf_fma(wf_from_i(y), row_pixels, wf_from_i(x));
    wi_store(s->first_pixel, wi_shl(wi_from_f(at), 3)); // EWA_PIXEL_FLOATS
    for (uint32_t i = 0; i < columns; i++) {
        const wf dx = wf_add(first_dx, wf_set((float)i));
        s->quadratic[i] = wf_mul(wf_mul(f[2], dx), dx);
        s->cross[i] = wf_mul(f[3], dx);
        s->key_x[i] = wf_fma(f[6], dx, f[5]);
        s->bound_x[i] = wf_fma(f[9], dx, f[8]);
        const wi column = wi_add(x, wi_set((int32_t)i));
        wi_store(s->column_at[i], wi_add(wi_shl(wi_sar(column, 2), 4), wi_and(column, in_block)));
    }
    for (uint32_t i = 0; i < rows; i++) {
        const wi row = wi_add(y, wi_set((int32_t)i));
        wi_store(s->row_at[i], wi_add(wi_from_f(wf_mul(wf_from_i(wi_sar(row, 2)), row_floats)),
                                      wi_shl(wi_and(row, in_block), 2)));
    }
}

static ALWAYS_INLINE void small_visibility(const pass *p, const uint16_t *order, uint32_t count,
                                           uint32_t columns, uint32_t rows) {
    small_splats s;
    load_small(p, order, columns, rows, &s);
    const wf end = wf_set(p->view->exponent_end), never = wf_set(-__builtin_inff());
    const bool any_steep = wm_bits(s.steep) != 0;
    const wm is_exact =
        p->view->orthographic ? wm_of_bits(0) : wm_and(s.steep, wf_le(s.bound_scale, wf_set(0)));
    const bool any_exact = wm_bits(is_exact) != 0;
    float bounds[EWA_SMALL_PX * EWA_SMALL_PX][EWA_BLOCK_LANES];
    wf dy = s.dy;
    for (uint32_t row = 0; row < rows; row++, dy = wf_add(dy, wf_set(1))) {
        UNROLL_COLUMNS
        for (uint32_t i = 0; i < columns; i++) {
            const wf exponent = wf_fma(dy, wf_fma(s.yy, dy, s.cross[i]), s.quadratic[i]);
            wf bound = wf_fma(s.bound_y, dy, s.bound_x[i]);
            if (any_steep) {
                const wf plane = wf_fma(s.key_y, dy, s.key_x[i]);
                const wf key = wf_min(wf_max(plane, s.key_low), s.key_high);
                bound = wf_select(s.steep, wf_fma(s.bound_scale, key, s.bound_offset), bound);
                if (any_exact) {
                    const wf exact = wf_mul(key, wf_reciprocal(wf_fma(s.bound_offset, key, wf_set(1))));
                    bound = wf_select(is_exact, exact, bound);
                }
            }
            wf_store(bounds[row * columns + i], wf_select(wf_lt(exponent, end), bound, never));
        }
    }
    for (uint32_t k = 0; k < count; k++) {
        size_t column[EWA_SMALL_PX];
        UNROLL_COLUMNS
        for (uint32_t i = 0; i < columns; i++) column[i] = (size_t)s.column_at[i][k];
        for (uint32_t row = 0; row < rows; row++) {
            float *nearest = p->tile->nearest + s.row_at[row][k];
            UNROLL_COLUMNS
            for (uint32_t i = 0; i < columns; i++) {
                const float bound = bounds[row * columns + i][k], old = nearest[column[i]];
                nearest[column[i]] = bound > old ? bound : old;
            }
        }
    }
}

static ALWAYS_INLINE void small_accumulate(const pass *p, const uint16_t *order, uint32_t count,
                                           uint32_t columns, uint32_t rows) {
    small_splats s;
    load_small(p, order, columns, rows, &s);
    const wf end = wf_set(p->view->exponent_end), infinite = wf_set(__builtin_inff());
    const wf key_low = wf_select(s.steep, s.key_low, wf_negate(infinite)),
             key_high = wf_select(s.steep, s.key_high, infinite);
    float weights[EWA_SMALL_PX * EWA_SMALL_PX][EWA_BLOCK_LANES];
    wm misses = wm_of_bits(0);
    wf dy = s.dy;
    for (uint32_t row = 0; row < rows; row++, dy = wf_add(dy, wf_set(1))) {
        const wi row_at = wi_load(s.row_at[row]);
        UNROLL_COLUMNS
        for (uint32_t i = 0; i < columns; i++) {
            const wf exponent = wf_fma(dy, wf_fma(s.yy, dy, s.cross[i]), s.quadratic[i]);
            const wf plane = wf_fma(s.key_y, dy, s.key_x[i]), key = wf_min(wf_max(plane, key_low), key_high);
            const wf bound = wf_gather(p->tile->nearest, wi_add(row_at, wi_load(s.column_at[i])));
            const wm within = wf_lt(exponent, end), reaches = wf_le(bound, key);
            misses = wm_or(misses, wm_and(within, wm_not(reaches)));
            wf_store(weights[row * columns + i], wf_keep(wm_and(within, reaches), exponential(exponent, 2)));
        }
    }
    uint32_t beyond = wm_bits(misses);
    if (count < EWA_BLOCK_LANES) beyond &= (1u << count) - 1;
    for (; beyond; beyond &= beyond - 1)
        ewa_mark_box(p->tile->beyond_rows, p->run->records[order[__builtin_ctz(beyond)]].box);
    float *const pixels = p->tile->pixels;
    const ewa_record *records = p->run->records;
    const ewa_load *loads = p->run->loads;
    const size_t row_floats = pixel_row_floats(p->tile);
    for (uint32_t k = 0; k < count; k++) {
        const w8 add = w8_join(loads[order[k]].normal, &records[order[k]].red);
        float *first = pixels + s.first_pixel[k];
        for (uint32_t row = 0; row < rows; row++, first += row_floats) {
            UNROLL_COLUMNS
            for (uint32_t i = 0; i < columns; i++) {
                const w8 weight = w8_set(weights[row * columns + i][k]);
                float *pixel = first + (size_t)i * EWA_PIXEL_FLOATS;
                w8_store(pixel, w8_fma(weight, add, w8_load(pixel)));
            }
        }
    }
}

typedef void small_group(const pass *p, const uint16_t *order, uint32_t count, uint32_t columns,
                         uint32_t rows);

/// Calls `body` for the splats of each class of small ones, sixteen at a time.
static ALWAYS_INLINE void for_each_small(const pass *p, small_group *body) {
    const uint16_t *first = p->run->class_first + EWA_SMALL_CLASS;
    UNROLL_COLUMNS
    for (uint32_t columns = 1; columns <= EWA_SMALL_PX; columns++)
        for (uint32_t rows = 1; rows <= EWA_SMALL_PX; rows++, first++)
            for (uint32_t i = first[0]; i < first[1]; i += EWA_BLOCK_LANES)
                body(p, p->run->order + i, first[1] - i < EWA_BLOCK_LANES ? first[1] - i : EWA_BLOCK_LANES,
                     columns, rows);
}

/// Adds what small splats have left in pixels to the tile's sums; all that are there are whole numbers.
static void gather_pixels(const ewa_tile *tile) {
    enum { LANES = EWA_BLOCK_LANES };
    static const int order[] = {3, 4, 5, 6, 0, 1, 2}; // of the channels in ewa_tile.pixels
    const uint32_t channels = tile->channel_count, columns = tile->blocks_per_row;
    for (uint32_t block = 0; block < columns * tile->block_rows; block++) {
        float *planes = tile->sums.planes + (size_t)block * channels * LANES;
        const float *pixels = tile->pixels + block / columns * EWA_BLOCK_PX * pixel_row_floats(tile) +
                              (size_t)(block % columns) * EWA_BLOCK_PX * EWA_PIXEL_FLOATS;
        wf f[LANES];
        for (uint32_t i = 0; i < LANES; i++)
            f[i] = wf_load(pixels + i / EWA_BLOCK_PX * pixel_row_floats(tile) +
                           (size_t)(i % EWA_BLOCK_PX) * EWA_PIXEL_FLOATS);
        w_transpose(f);
        for (uint32_t c = 0; c < channels; c++) {
            const wf others = tile->only_small ? wf_set(BIAS) : wf_load(planes + c * LANES);
            wf_store(planes + c * LANES, wf_add(others, wf_sub(f[order[c]], wf_set(BIAS))));
        }
    }
}

#endif
