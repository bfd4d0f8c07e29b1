// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adaptive models of LAZ's arithmetic coder: how often each symbol came, as a cumulative distribution of 15
// bits that is made anew now and then. Symbols are found by counting the sixteen first numbers of groups of
// sixteen, then the sixteen of one group: without branches, hence without mispredicted ones.
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
    EWA_LAZ_GROUP = 16,      ///< symbols that are compared at once
};

/// Where a model stands; behind it lie the first numbers of its groups, the distribution and the counts.
typedef struct ewa_laz_model {
    uint32_t generation; ///< the chunk for which it was started
    uint16_t left;       ///< symbols until the distribution is made anew
    uint16_t cycle;      ///< symbols between two such times
    uint32_t total;      ///< of the counts
    uint32_t unused;
} ewa_laz_model;

/// A bit's model.
typedef struct ewa_laz_bit {
    uint32_t generation, left, cycle, zeros, total, zero_probability;
} ewa_laz_bit;

#define EWA_LAZ_GROUPS(n) (((n) + EWA_LAZ_GROUP - 1) / EWA_LAZ_GROUP)
/// Numbers of the first level: none for one group.
#define EWA_LAZ_FIRSTS(n) ((n) <= EWA_LAZ_GROUP ? 0 : EWA_LAZ_GROUPS(EWA_LAZ_GROUPS(n)) * EWA_LAZ_GROUP)
/// A model with room for n symbols.
#define EWA_LAZ_MODEL(n)                                                                                     \
    struct {                                                                                                 \
        alignas(16) ewa_laz_model head;                                                                      \
        uint16_t numbers[EWA_LAZ_FIRSTS(n) + 2 * EWA_LAZ_GROUPS(n) * EWA_LAZ_GROUP];                         \
    }

static inline uint16_t *ewa_laz_model_firsts(ewa_laz_model *model) { return (uint16_t *)(model + 1); }

static inline uint16_t *ewa_laz_model_distribution(ewa_laz_model *model, uint32_t room) {
    return ewa_laz_model_firsts(model) + EWA_LAZ_FIRSTS(room);
}

static inline uint16_t *ewa_laz_model_counts(ewa_laz_model *model, uint32_t room) {
    return ewa_laz_model_distribution(model, room) + EWA_LAZ_GROUPS(room) * EWA_LAZ_GROUP;
}

/// Sets every one of `symbol_count` symbols equally likely; `room`: for how many symbols there is room.
void ewa_laz_model_start(ewa_laz_model *model, uint32_t symbol_count, uint32_t room, uint32_t generation);

/// Makes the distribution anew from the counts.
void ewa_laz_model_update(ewa_laz_model *model, uint32_t symbol_count, uint32_t room);

void ewa_laz_bit_start(ewa_laz_bit *bit, uint32_t generation);
void ewa_laz_bit_update(ewa_laz_bit *bit);

#endif
