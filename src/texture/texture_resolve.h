// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of texture_body.h: from sums to pixels, sixteen at a time; ewa_texture_put() in single precision
// (docs/math.md section 11).
#ifndef EWA_SRC_TEXTURE_TEXTURE_RESOLVE_H
#define EWA_SRC_TEXTURE_TEXTURE_RESOLVE_H

#include "texture/texture.h"
#include "wide/pixels.h"

/// Colours of sixteen pixels over the background, premultiplied.
static ALWAYS_INLINE void resolve_pixels(const ewa_texture_sums *sums, size_t at, const float *coverage,
                                         const float background[4], wf out[4]) {
    const wf one = wf_set(1);
    w_load4(sums->color + 4 * at, 16, out);
    const wf weight = sums->weight ? wf_load(sums->weight + at) : out[3];
    const wm reached = wf_lt(wf_set(0), weight);
    const wf inverse = wf_keep(reached, wf_div(one, wf_select(reached, weight, one)));
    const wf covered = coverage ? wf_load(coverage) : one, share = wf_mul(inverse, covered);
    for (int c = 0; c < 4; c++) out[c] = wf_mul(out[c], share);
    if (!sums->weight) out[3] = wf_keep(reached, covered); // exactly
    const wf behind = wf_mul(wf_sub(one, out[3]), wf_set(background[3]));
    for (int c = 0; c < 3; c++) out[c] = wf_fma(behind, wf_set(background[c]), out[c]);
    out[3] = wf_add(out[3], behind);
}

/// 8-bit numbers of sixteen pixels; with alpha, what rounds to none is black.
static ALWAYS_INLINE wi encode_pixels(const wf color[4], bool with_alpha) {
    const wf one = wf_set(1), opaque[4] = {color[0], color[1], color[2], one};
    if (!with_alpha) return color_codes(opaque);
    const wm shown = wf_le(one, wf_fma(wf_clamp01(color[3]), wf_set(255), wf_set(0.5f)));
    return wi_of_bits(wf_keep(shown, wf_of_bits(color_codes(color))));
}

static void resolve(const ewa_texture_target *target, const float background[4], const ewa_tile_rect *tile,
                    const ewa_texture_sums *sums, const float *coverage) {
    const uint32_t channels = target->channel_count;
    const bool linear = target->format == EWA_PIXEL_LINEAR;
    const size_t pixel_bytes = channels * (linear ? sizeof(float) : 1);
    for (uint32_t row = 0; row < tile->height_px; row++) {
        char *out = (char *)target->pixels + (size_t)(tile->y_px + row) * target->stride_bytes +
                    tile->x_px * pixel_bytes;
        for (uint32_t column = 0; column < tile->width_px; column += 16, out += 16 * pixel_bytes) {
            const size_t at = (size_t)(row + 1) * EWA_TEXTURE_PITCH + column + 1;
            const uint32_t left = tile->width_px - column, count = left < 16 ? left : 16;
            wf color[4];
            resolve_pixels(sums, at, coverage ? coverage + (size_t)row * EWA_TEXTURE_TILE + column : NULL,
                           background, color);
            if (linear) {
                float numbers[64];
                w_store4(numbers, color[0], color[1], color[2], color[3]);
                for (uint32_t i = 0; i < count; i++)
                    memcpy(out + i * pixel_bytes, numbers + 4 * (size_t)i, pixel_bytes);
            } else {
                int32_t codes[16];
                wi_store(codes, encode_pixels(color, channels == 4));
                if (channels == 4)
                    memcpy(out, codes, count * sizeof *codes);
                else
                    for (uint32_t i = 0; i < count; i++)
                        for (uint32_t c = 0; c < channels; c++)
                            out[i * channels + c] = (char)(codes[i] >> (8 * c) & 255);
            }
        }
    }
}

#endif
