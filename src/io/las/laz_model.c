// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adaptive models: what happens now and then; see laz_model.h.
#include "io/las/laz_model.h"

enum {
    MAX_TOTAL = 1 << EWA_LAZ_MODEL_BITS,   // counts are halved above it
    MAX_BIT_TOTAL = 1 << EWA_LAZ_BIT_BITS, // the same for bits
    MAX_BIT_CYCLE = 64,
    NEVER = 0xFFFF, // behind the last symbol: above every quotient
};

static void distribute(ewa_laz_model *model, uint32_t symbol_count, uint32_t room) {
    uint16_t *numbers = ewa_laz_model_distribution(model, room);
    const uint16_t *counts = ewa_laz_model_counts(model, room);
    const uint32_t scale = (1u << 31) / model->total;
    uint32_t sum = 0;
    for (uint32_t i = 0; i < symbol_count; i++) {
        numbers[i] = (uint16_t)((scale * sum) >> (31 - EWA_LAZ_MODEL_BITS));
        sum += counts[i];
    }
    if (room <= EWA_LAZ_GROUP) return;
    uint16_t *firsts = ewa_laz_model_firsts(model);
    for (uint32_t i = 0; i < EWA_LAZ_GROUPS(symbol_count); i++) firsts[i] = numbers[i * EWA_LAZ_GROUP];
}

void ewa_laz_model_start(ewa_laz_model *model, uint32_t symbol_count, uint32_t room, uint32_t generation) {
    uint16_t *numbers = ewa_laz_model_distribution(model, room), *counts = ewa_laz_model_counts(model, room);
    for (uint32_t i = 0; i < EWA_LAZ_FIRSTS(room); i++) ewa_laz_model_firsts(model)[i] = NEVER;
    for (uint32_t i = symbol_count; i < EWA_LAZ_GROUPS(room) * EWA_LAZ_GROUP; i++) numbers[i] = NEVER;
    for (uint32_t i = 0; i < symbol_count; i++) counts[i] = 1;
    model->generation = generation;
    model->total = symbol_count;
    model->cycle = model->left = (uint16_t)((symbol_count + 6) >> 1);
    distribute(model, symbol_count, room);
}

void ewa_laz_model_update(ewa_laz_model *model, uint32_t symbol_count, uint32_t room) {
    model->total += model->cycle;
    if (model->total > MAX_TOTAL) {
        uint16_t *counts = ewa_laz_model_counts(model, room);
        uint32_t total = 0;
        for (uint32_t i = 0; i < symbol_count; i++) {
            counts[i] = (uint16_t)((counts[i] + 1) >> 1);
            total += counts[i];
        }
        model->total = total;
    }
    distribute(model, symbol_count, room);
    const uint32_t cycle = model->cycle * 5u / 4, max_cycle = (symbol_count + 6) * 8;
    model->cycle = model->left = (uint16_t)(cycle < max_cycle ? cycle : max_cycle);
}

static void set_probability(ewa_laz_bit *bit) {
    bit->zero_probability = (bit->zeros * ((1u << 31) / bit->total)) >> (31 - EWA_LAZ_BIT_BITS);
}

void ewa_laz_bit_start(ewa_laz_bit *bit, uint32_t generation) {
    *bit = (ewa_laz_bit){.generation = generation, .left = 4, .cycle = 4, .zeros = 1, .total = 2};
    set_probability(bit);
}

void ewa_laz_bit_update(ewa_laz_bit *bit) {
    bit->total += bit->cycle;
    if (bit->total > MAX_BIT_TOTAL) {
        bit->total = (bit->total + 1) >> 1;
        bit->zeros = (bit->zeros + 1) >> 1;
        if (bit->zeros == bit->total) bit->total++;
    }
    set_probability(bit);
    const uint32_t cycle = bit->cycle * 5 / 4;
    bit->cycle = bit->left = cycle < MAX_BIT_CYCLE ? cycle : MAX_BIT_CYCLE;
}
