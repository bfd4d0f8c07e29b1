// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adaptive models of LAZ's arithmetic coder: how often each symbol came, as a cumulative distribution of 15
// bits that is made anew now and then.
//
// Based on: A. Said, "Introduction to Arithmetic Coding: Theory and Practice", HPL-2004-76 (2004), section
// 3.2; rapidlasso, "LAZ Specification 1.4", section "Entropy coder".
#ifndef EWA_SRC_LAZ_MODEL_H
#define EWA_SRC_LAZ_MODEL_H

#include <stdalign.h>
#include <stdbool.h>
#include <stdint.h>

enum {
    EWA_LAZ_MODEL_BITS = 15, ///< of the distribution: it ends at 2^15
    EWA_LAZ_BIT_BITS = 13,   ///< of the probability of a bit
};

/// Where a model stands; behind it lie its symbols, and for decoders the table that finds them.
typedef struct ewa_laz_model {
    uint32_t generation; ///< the chunk for which it was started
    uint16_t left;       ///< symbols until the distribution is made anew
    uint16_t cycle;      ///< symbols between two such times
    uint32_t total;      ///< of the counts
    uint32_t unused;
} ewa_laz_model;

/// A symbol: its place in the distribution ends where the next one's begins. Behind the last one is one that no
/// quotient reaches.
typedef struct ewa_laz_slot {
    uint16_t low;   ///< where it begins
    uint16_t count; ///< how often it came
} ewa_laz_slot;

/// A bit's model.
typedef struct ewa_laz_bit {
    uint32_t generation, left, cycle, zeros, total, zero_probability;
} ewa_laz_bit;

/// Bits of a quotient that are looked up, and how many symbols an entry of the table stands for.
#define EWA_LAZ_TABLE_BITS(n) ((n) >= 256 ? 8 : 31 - __builtin_clz(n))
#define EWA_LAZ_TABLE_STEP(n) ((n) > 256 ? 4 : 1)
/// A model of n symbols.
#define EWA_LAZ_MODEL(n)                                                                                     \
    struct {                                                                                                 \
        alignas(16) ewa_laz_model head;                                                                      \
        ewa_laz_slot slots[(n) + 1];                                                                         \
        uint8_t table[(1 << EWA_LAZ_TABLE_BITS(n)) + 1];                                                     \
    }

/// 2^26 / (1025 + i), rounded down: inverses of lengths of 32 bits whose eleven upper ones are 1024 + i, rounded up.
extern const uint16_t ewa_laz_inverses[1024];

static inline ewa_laz_slot *ewa_laz_model_slots(ewa_laz_model *model) { return (ewa_laz_slot *)(model + 1); }

/// `room`: for how many symbols the model was made.
static inline uint8_t *ewa_laz_model_table(ewa_laz_model *model, uint32_t room) {
    return (uint8_t *)(ewa_laz_model_slots(model) + room + 1);
}

/// Sets every one of `symbol_count` symbols equally likely. `encoding`: the table is not needed.
void ewa_laz_model_start(bool encoding, ewa_laz_model *model, uint32_t symbol_count, uint32_t room,
                         uint32_t generation);

/// Makes the distribution anew from the counts.
void ewa_laz_model_update(bool encoding, ewa_laz_model *model, uint32_t symbol_count, uint32_t room);

void ewa_laz_bit_start(ewa_laz_bit *bit, uint32_t generation);
void ewa_laz_bit_update(ewa_laz_bit *bit);

#endif
