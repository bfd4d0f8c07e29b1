// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Every operation of src/wide once; compiled for each instruction set (CMakeLists.txt).
#include "wide/wide.h"
#include "wide/wide_double.h"

#include "math/wide_operations.h"

void EWA_VERSION(wide_operate)(const wide_input *in, wide_output *out) {
    const wf a = wf_load(in->a), b = wf_load(in->b), c = wf_load(in->c);
    const wi i = wi_load(in->i), j = wi_load(in->j), at = wi_load(in->at);
    const wm less = wf_lt(a, b), given = wm_of_bits(in->bits);
    wf_store(out->add, wf_add(a, b));
    wf_store(out->sub, wf_sub(a, b));
    wf_store(out->mul, wf_mul(a, b));
    wf_store(out->div, wf_div(a, b));
    wf_store(out->sqrt, wf_sqrt(a));
    wf_store(out->abs, wf_abs(a));
    wf_store(out->floor, wf_floor(a));
    wf_store(out->min, wf_min(a, b));
    wf_store(out->max, wf_max(a, b));
    wf_store(out->fma, wf_fma(a, b, c));
    wf_store(out->fnma, wf_fnma(a, b, c));
    wf_store(out->fma_twice, wf_fma_twice(a, b, c, wf_load(in->k)));
    wf_store(out->horner, wf_horner(a, in->coefficients, 5));
    wf_store(out->fma_whole, wf_fma_whole(wf_load(in->share), wf_load(in->odd), wf_load(in->sum)));
    wf_store(out->select, wf_select(given, a, b));
    wf_store(out->keep, wf_keep(given, a));
    wf_store(out->from_i, wf_from_i(i));
    wf_store(out->gather, wf_gather(in->table, at));
    wf_store(out->lookup, wf_lookup(in->table, at));
    wf_store(out->lookup32, wf_lookup32(in->table, at));
    wf_store(out->rows, wf_load_rows(in->table, 20));
    wf_store(out->repeat4, wf_repeat4(in->table));
    wf_store(out->spread4, wf_spread4(in->table));
    wf rows[16], pixels[4];
    for (int n = 0; n < 16; n++) rows[n] = wf_load(in->table + 16 * n);
    w_transpose(rows);
    for (int n = 0; n < 16; n++) wf_store(out->transposed + 16 * n, rows[n]);
    w_store4(out->store4, a, b, c, wf_set(7));
    w_load4(in->table, 24, pixels);
    for (int n = 0; n < 4; n++) wf_store(out->load4 + 16 * n, pixels[n]);
    wf_pack(out->packed, given, a);
    wi_pack(out->wi_packed, given, i);
    w8_store(out->eight, w8_fma(w8_load(in->a), w8_set(in->b[0]), w8_load(in->c)));
    w8_store(out->joined, w8_join(in->a, in->b));

    const wd d = wd_load(in->d), e = wd_load(in->e), f = wd_load(in->f);
    wd_store(out->double_fma, wd_fma(d, e, f));
    wd_store(out->double_fnma, wd_fnma(d, e, f));
    wd_store(out->double_add, wd_add(d, wd_set(in->e[0])));
    wd_store(out->double_sub, wd_sub(d, e));
    wd_store(out->widened, wd_from_f(a));
    wf_store(out->narrowed, wf_from_d(d));

    wi_store(out->int_of, wi_from_f(wf_load(in->whole)));
    wi_store(out->wi_add, wi_add(i, j));
    wi_store(out->wi_sub, wi_sub(i, j));
    wi_store(out->wi_min, wi_min(i, j));
    wi_store(out->wi_max, wi_max(i, j));
    wi_store(out->wi_or, wi_or(i, j));
    wi_store(out->wi_and, wi_and(i, j));
    wi_store(out->wi_shl, wi_shl(i, in->shift));
    wi_store(out->wi_sar, wi_sar(i, in->shift));
    wi_store(out->from_u16, wi_load_u16(in->u16));
    wi_store(out->from_i16, wi_load_i16((const int16_t *)in->u16));
    wi_store_rows((uint8_t *)out->int_rows, 64, i);
    wi_store_u8(out->u8, at);
    out->less = wm_bits(less), out->less_equal = wm_bits(wf_le(a, b)), out->bits = wm_bits(given);
    out->both = wm_bits(wm_and(less, given)), out->either = wm_bits(wm_or(less, given));
    out->neither = wm_bits(wm_not(wm_or(less, given)));
}
