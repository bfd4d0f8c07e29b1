// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LAZ's arithmetic coder, in both directions: every function takes `encoding`, which is a constant where it is
// called, so that what a record consists of is written down once. A decoder gives the symbol that it finds and
// ignores the one that it is given; an encoder writes that one and gives it back.
//
// A coder is copied to a local variable where several symbols follow each other, so that it stays in registers.
//
// Based on: A. Said, "Introduction to Arithmetic Coding: Theory and Practice", HPL-2004-76 (2004); G. N. N.
// Martin, "Range encoding" (1979); rapidlasso, "LAZ Specification 1.4", section "Entropy coder".
#ifndef EWA_SRC_LAZ_CODER_H
#define EWA_SRC_LAZ_CODER_H

#include "io/las/laz_model.h"

#include <stddef.h>

// Sanitizers look at every access: with all of it in one function, compilers take minutes.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) ||                                   \
    __has_feature(undefined_behavior_sanitizer)
#define EWA_LAZ_SANITIZED 1
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define EWA_LAZ_SANITIZED 1
#endif
#if defined(EWA_LAZ_SANITIZED)
#define EWA_LAZ_INLINE static __attribute__((noinline, unused))
#elif defined(__wasm__)
#define EWA_LAZ_INLINE static inline
#else
#define EWA_LAZ_INLINE static inline __attribute__((always_inline))
#endif

#define EWA_LAZ_RARELY(condition) __builtin_expect(!!(condition), 0)

enum { EWA_LAZ_MIN_LENGTH_BITS = 24 }; ///< an interval is at least 2^24 long before a symbol

typedef struct ewa_laz_coder {
    uint32_t generation; ///< of the models: those of other chunks are started anew
    uint32_t length;     ///< of the interval
    uint32_t value;      ///< decoder: the code's distance from the interval's lower end; encoder: that end
    bool damaged;        ///< decoder: more bytes were wanted than there are, or what no encoder writes came
    const uint8_t *at, *end; ///< decoder: next byte
    uint8_t *to;             ///< encoder: next byte; its user makes room before each record
} ewa_laz_coder;

/// The next four bytes with the first on top, zeros behind the end.
static inline uint32_t ewa_laz_tail(const uint8_t *at, const uint8_t *end) {
    uint32_t word = 0;
    for (int i = 0; i < 4; i++) word = word << 8 | (end - at > i ? at[i] : 0u);
    return word;
}

/// Makes the interval long again.
EWA_LAZ_INLINE void ewa_laz_renormalise_decoder(ewa_laz_coder *c) {
    const uint32_t shift = (uint32_t)__builtin_clz(c->length) & 24;
    uint32_t word;
    if (EWA_LAZ_RARELY(c->end - c->at < 4)) {
        word = ewa_laz_tail(c->at, c->end);
        if (c->end - c->at < (ptrdiff_t)(shift >> 3)) {
            c->damaged = true;
            c->at = c->end;
        } else {
            c->at += shift >> 3;
        }
    } else {
        word = (uint32_t)c->at[0] << 24 | (uint32_t)c->at[1] << 16 | (uint32_t)c->at[2] << 8 | c->at[3];
        c->at += shift >> 3;
    }
    c->value = (uint32_t)((((uint64_t)c->value << 32 | word) << shift) >> 32);
    c->length <<= shift;
}

/// Adds to the interval's lower end; the carry runs through the bytes before it.
EWA_LAZ_INLINE void ewa_laz_raise(ewa_laz_coder *c, uint32_t by) {
    c->value += by;
    if (EWA_LAZ_RARELY(c->value < by)) {
        uint8_t *byte = c->to - 1;
        while (*byte == 0xFF) *byte-- = 0;
        ++*byte;
    }
}

EWA_LAZ_INLINE void ewa_laz_renormalise_encoder(ewa_laz_coder *c) {
    // All four are stored, as many of them are kept as are needed: up to three.
    c->to[0] = (uint8_t)(c->value >> 24);
    c->to[1] = (uint8_t)(c->value >> 16);
    c->to[2] = (uint8_t)(c->value >> 8);
    c->to[3] = (uint8_t)c->value;
    const uint32_t shift = (uint32_t)__builtin_clz(c->length) & 24;
    c->to += shift >> 3;
    c->value <<= shift;
    c->length <<= shift;
}

/// Begins to decode bytes.
static inline void ewa_laz_decoder_start(ewa_laz_coder *c, const uint8_t *bytes, uint64_t size_bytes,
                                         uint32_t generation) {
    *c = (ewa_laz_coder){.generation = generation, .length = UINT32_MAX, .end = bytes + size_bytes};
    c->damaged = size_bytes < 4;
    c->at = c->damaged ? c->end : bytes + 4;
    c->value = c->damaged ? 0 : ewa_laz_tail(bytes, c->end);
    // The code has to lie in the interval; every symbol keeps it there.
    if (c->value == UINT32_MAX) {
        c->damaged = true;
        c->value = 0;
    }
}

static inline void ewa_laz_encoder_start(ewa_laz_coder *c, uint8_t *to, uint32_t generation) {
    *c = (ewa_laz_coder){.generation = generation, .length = UINT32_MAX, .to = to};
}

enum { EWA_LAZ_FINISH_BYTES = 8 }; ///< room that ewa_laz_encoder_finish() needs

/// Writes what tells the last symbols apart, and zeros for what the decoder reads ahead.
static inline void ewa_laz_encoder_finish(ewa_laz_coder *c) {
    const bool long_interval = c->length > 2u << EWA_LAZ_MIN_LENGTH_BITS;
    ewa_laz_raise(c, 1u << (long_interval ? EWA_LAZ_MIN_LENGTH_BITS : EWA_LAZ_MIN_LENGTH_BITS - 1));
    c->length = 1u << (long_interval ? EWA_LAZ_MIN_LENGTH_BITS - 1 : EWA_LAZ_MIN_LENGTH_BITS - 9);
    ewa_laz_renormalise_encoder(c);
    for (int i = 0; i < (long_interval ? 3 : 2); i++) *c->to++ = 0;
}

/// Codes a symbol below `symbol_count`; `room` says which kind of model it is, a constant.
EWA_LAZ_INLINE uint32_t ewa_laz_symbol_of(bool encoding, ewa_laz_coder *c, ewa_laz_model *model,
                                          uint32_t symbol_count, uint32_t room, uint32_t symbol) {
    if (EWA_LAZ_RARELY(model->generation != c->generation))
        ewa_laz_model_start(encoding, model, symbol_count, room, c->generation);
    ewa_laz_slot *slots = ewa_laz_model_slots(model);
    const uint32_t unit = c->length >> EWA_LAZ_MODEL_BITS;
    if (!encoding) {
        // value / unit from below: a division takes longer than the products that tell the symbols apart.
        const uint32_t zeros = (uint32_t)__builtin_clz(c->length),
                       inverse = (c->length << zeros) >> 21 & 1023;
        const uint32_t quotient = (uint32_t)((uint64_t)(c->value << zeros) * ewa_laz_inverses[inverse] >> 32);
        symbol = ewa_laz_model_table(
            model, room)[quotient >> (EWA_LAZ_MODEL_BITS - EWA_LAZ_TABLE_BITS(symbol_count))];
        symbol *= EWA_LAZ_TABLE_STEP(room);
        while ((uint64_t)slots[symbol + 1].low * unit <= c->value) symbol++;
    }
    const uint32_t low = slots[symbol].low * unit;
    const uint32_t high = symbol + 1 == symbol_count ? c->length : slots[symbol + 1].low * unit;
    c->length = high - low;
    if (encoding) {
        ewa_laz_raise(c, low);
        ewa_laz_renormalise_encoder(c);
    } else {
        c->value -= low;
        ewa_laz_renormalise_decoder(c);
    }
    slots[symbol].count++;
    if (EWA_LAZ_RARELY(--model->left == 0)) ewa_laz_model_update(encoding, model, symbol_count, room);
    return symbol;
}

/// Codes a symbol below `symbol_count`, a constant.
#define ewa_laz_symbol(encoding, c, model, symbol_count, symbol)                                             \
    ewa_laz_symbol_of(encoding, c, &(model)->head, symbol_count, symbol_count, symbol)

/// Codes a bit.
EWA_LAZ_INLINE uint32_t ewa_laz_bit_code(bool encoding, ewa_laz_coder *c, ewa_laz_bit *model, uint32_t bit) {
    if (EWA_LAZ_RARELY(model->generation != c->generation)) ewa_laz_bit_start(model, c->generation);
    const uint32_t border = model->zero_probability * (c->length >> EWA_LAZ_BIT_BITS);
    if (!encoding) bit = c->value >= border;
    model->zeros += !bit;
    c->length = bit ? c->length - border : border;
    if (encoding) {
        ewa_laz_raise(c, bit ? border : 0);
        ewa_laz_renormalise_encoder(c);
    } else {
        c->value -= bit ? border : 0;
        ewa_laz_renormalise_decoder(c);
    }
    if (EWA_LAZ_RARELY(--model->left == 0)) ewa_laz_bit_update(model);
    return bit;
}

/// Codes 1 to 19 bits that are equally likely.
EWA_LAZ_INLINE uint32_t ewa_laz_few_bits(bool encoding, ewa_laz_coder *c, uint32_t count, uint32_t bits) {
    c->length >>= count;
    if (encoding) {
        ewa_laz_raise(c, bits * c->length);
        ewa_laz_renormalise_encoder(c);
        return bits;
    }
    bits = c->value / c->length;
    c->value -= bits * c->length;
    ewa_laz_renormalise_decoder(c);
    if (EWA_LAZ_RARELY(bits >> count)) { // in the rest that the division leaves: no encoder points there
        c->damaged = true;
        bits = 0;
    }
    return bits;
}

/// Codes 1 to 32 bits that are equally likely: the lower 16 first if there are 20 or more.
EWA_LAZ_INLINE uint32_t ewa_laz_bits(bool encoding, ewa_laz_coder *c, uint32_t count, uint32_t bits) {
    if (count <= 19) return ewa_laz_few_bits(encoding, c, count, bits);
    const uint32_t lower = ewa_laz_few_bits(encoding, c, 16, bits & 0xFFFF);
    return ewa_laz_few_bits(encoding, c, count - 16, bits >> 16) << 16 | lower;
}

/// Codes 64 bits, the lower half first.
EWA_LAZ_INLINE uint64_t ewa_laz_bits64(bool encoding, ewa_laz_coder *c, uint64_t bits) {
    const uint64_t lower = ewa_laz_bits(encoding, c, 32, (uint32_t)bits);
    return (uint64_t)ewa_laz_bits(encoding, c, 32, (uint32_t)(bits >> 32)) << 32 | lower;
}

#endif
