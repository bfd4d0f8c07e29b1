// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: what a packet's numbers stand for, normals, axes and colours (docs/math.md section 2).
#ifndef EWA_SRC_SURFACE_PIPELINE_PACKET_H
#define EWA_SRC_SURFACE_PIPELINE_PACKET_H

#include "surface/pipeline_camera.h"

/// Normals, not yet of unit length.
static ALWAYS_INLINE void decode_normals(const ewa_packet *packet, wf n[3]) {
    const wf unit = wf_set(1.0f / 32767.0f);
    unfold_flat(wf_mul(wf_from_i(wi_load_i16(packet->oct_x)), unit),
                wf_mul(wf_from_i(wi_load_i16(packet->oct_y)), unit), n);
}

/// Lanes that are billboards.
static ALWAYS_INLINE wm find_billboards(const ewa_packet *packet) {
    return wf_lt(wf_from_i(wi_load_i16(packet->oct_x)), wf_set(EWA_BILLBOARD + 0.5f));
}

/// Unit major axes: the frame of packet_frame() (packets.c) turned by the diamond angle.
static inline void decode_axes(const ewa_packet *packet, const wf n[3], wf axis[3]) {
    const wf t = wf_mul(wf_from_i(wi_load_u16(packet->angle)), wf_set(1.0f / 32768.0f));
    wf c = wf_sub(wf_set(1), t);
    wf s = wf_sub(wf_set(1), wf_abs(c));
    const wf inverse = wf_inverse_root(wf_fma(c, c, wf_mul(s, s)));
    c = wf_mul(c, inverse), s = wf_mul(s, inverse);
    const wf sign = wf_select(wf_lt(n[2], wf_set(0)), wf_set(-1), wf_set(1));
    const wf a = wf_div(wf_set(-1), wf_add(sign, n[2]));
    const wf b = wf_mul(wf_mul(n[0], n[1]), a);
    // First frame vector (1 + sign nx^2 a, sign b, -sign nx), second (b, sign + ny^2 a, -ny).
    const wf ux = wf_fma(wf_mul(sign, n[0]), wf_mul(n[0], a), wf_set(1)), uy = wf_mul(sign, b);
    const wf uz = wf_negate(wf_mul(sign, n[0])), vy = wf_fma(wf_mul(n[1], n[1]), a, sign);
    axis[0] = wf_fma(c, ux, wf_mul(s, b));
    axis[1] = wf_fma(c, uy, wf_mul(s, vy));
    axis[2] = wf_fnma(s, n[1], wf_mul(c, uz));
}

/// Minor sigmas over major ones.
static inline wf decode_ratios(const ewa_packet *packet) {
    const wf root = wf_mul(wf_from_i(wi_load_u16(packet->ratio)), wf_set(1.0f / 65535.0f));
    const wf square = wf_mul(root, root);
    return wf_mul(square, square);
}

/// How the colours of a packet are coded (ewa_packet_bounds).
typedef struct color_form {
    bool even;
    float unit;     ///< even: of a step
    int shift;      ///< the rest is of those that are not
    int32_t digits; ///< the bits of a code but for its sign
} color_form;

static inline color_form read_color_form(uint16_t form) {
    const bool with_sign = form & EWA_COLOR_SIGN;
    const int octave_bits = form >> 8 & 15;
    const bool even = !with_sign && octave_bits == 0;
    // A power of two, by way of its bits; the step of even codes has the digits of 1 / 65535.
    const union {
        float value;
        uint32_t bits;
    } step = {.value = 1.0f / 65535.0f}, unit = {.bits = ((uint32_t)(form & 255) - 1) << 23},
      even_unit = {.bits = step.bits + (((uint32_t)(form & 255) - 128) << 23)};
    return (color_form){even, even ? even_unit.value : unit.value, 7 + octave_bits + with_sign,
                        with_sign ? 0x7fff : 0xffff};
}

static ALWAYS_INLINE wf decode_color(const color_form *form, const uint16_t *values) {
    const wi code = wi_load_u16(values);
    const wf unit = wf_set(form->unit);
    if (form->even) return wf_mul(wf_from_i(code), unit);
    const wi digits = wi_set(form->digits);
    const wf octaves = wf_of_bits(wi_add(wi_shl(wi_and(code, digits), form->shift), wi_set(0x3f800000)));
    const wf size = wf_fma(octaves, unit, wf_negate(unit));
    const wi sign = wi_shl(wi_and(code, wi_sub(wi_set(0xffff), digits)), 16);
    return wf_of_bits(wi_or(wi_of_bits(size), sign));
}

#endif
