// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adaptive models: what happens now and then; see laz_model.h.
#include "io/las/laz_model.h"

enum {
    MAX_TOTAL = 1 << EWA_LAZ_MODEL_BITS,   // counts are halved above it
    MAX_BIT_TOTAL = 1 << EWA_LAZ_BIT_BITS, // the same for bits
    MAX_BIT_CYCLE = 64,
    NEVER = 0xFFFF, // above every quotient
};

#define INVERSE(i)     (uint16_t)((1u << 26) / ((i) + 1025))
#define INVERSE_4(i)   INVERSE(i), INVERSE((i) + 1), INVERSE((i) + 2), INVERSE((i) + 3)
#define INVERSE_16(i)  INVERSE_4(i), INVERSE_4((i) + 4), INVERSE_4((i) + 8), INVERSE_4((i) + 12)
#define INVERSE_64(i)  INVERSE_16(i), INVERSE_16((i) + 16), INVERSE_16((i) + 32), INVERSE_16((i) + 48)
#define INVERSE_256(i) INVERSE_64(i), INVERSE_64((i) + 64), INVERSE_64((i) + 128), INVERSE_64((i) + 192)

const uint16_t ewa_laz_inverses[1024] = {INVERSE_256(0), INVERSE_256(256), INVERSE_256(512),
                                         INVERSE_256(768)};

static void distribute(ewa_laz_model *model, uint32_t symbol_count) {
    ewa_laz_slot *slots = ewa_laz_model_slots(model);
    const uint32_t scale = (1u << 31) / model->total;
    uint32_t sum = 0;
    for (uint32_t i = 0; i < symbol_count; i++) {
        slots[i].low = (uint16_t)((scale * sum) >> (31 - EWA_LAZ_MODEL_BITS));
        sum += slots[i].count;
    }
}

/// Sets the entry of each stretch of quotients to the symbol of its first one.
static void tabulate(ewa_laz_model *model, uint32_t symbol_count, uint32_t room) {
    const ewa_laz_slot *slots = ewa_laz_model_slots(model);
    uint8_t *table = ewa_laz_model_table(model, room);
    const uint32_t bits = EWA_LAZ_TABLE_BITS(symbol_count), step = EWA_LAZ_TABLE_STEP(room);
    const uint32_t shift = EWA_LAZ_MODEL_BITS - bits, last = symbol_count - 1;
    uint32_t entry = 0;
    for (uint32_t i = 0; i < last; i++)
        for (const uint32_t end = ((slots[i + 1].low - 1u) >> shift) + 1; entry < end; entry++)
            table[entry] = (uint8_t)(i / step);
    for (; entry <= 1u << bits; entry++) table[entry] = (uint8_t)(last / step);
}

void ewa_laz_model_start(bool encoding, ewa_laz_model *model, uint32_t symbol_count, uint32_t room,
                         uint32_t generation) {
    ewa_laz_slot *slots = ewa_laz_model_slots(model);
    for (uint32_t i = 0; i < symbol_count; i++) slots[i].count = 1;
    slots[symbol_count].low = NEVER;
    model->generation = generation;
    model->total = symbol_count;
    model->cycle = model->left = (uint16_t)((symbol_count + 6) >> 1);
    distribute(model, symbol_count);
    if (!encoding) tabulate(model, symbol_count, room);
}

void ewa_laz_model_update(bool encoding, ewa_laz_model *model, uint32_t symbol_count, uint32_t room) {
    model->total += model->cycle;
    if (model->total > MAX_TOTAL) {
        ewa_laz_slot *slots = ewa_laz_model_slots(model);
        uint32_t total = 0;
        for (uint32_t i = 0; i < symbol_count; i++) {
            slots[i].count = (uint16_t)((slots[i].count + 1) >> 1);
            total += slots[i].count;
        }
        model->total = total;
    }
    distribute(model, symbol_count);
    if (!encoding) tabulate(model, symbol_count, room);
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
