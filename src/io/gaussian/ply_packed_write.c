// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as PlayCanvas's compressed PLY: see ply_packed.c for its chunks. Neighbours share a chunk, so that its bounds
// are narrow.
#include "cloud/morton.h"
#include "io/gaussian/save.h"

#include <stdio.h>

enum { CHUNK = 256, BOUNDS = 9, WORDS = 4, HEAD_BYTES = 4096, MAX_REST = 3 * ((EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1) - 1) };

typedef struct packing {
    const ewa_gaussian_target *target;
    const ewa_gaussians *set;
    uint32_t *order;
} packing;

/// What is packed of a Gaussian: centre, logarithms of scales, colour.
static void take_numbers(const ewa_gaussians *set, size_t i, float numbers[BOUNDS]) {
    const float *harmonics = set->harmonics + i * 3 * ewa_sh_count(set->sh_degree);
    for (size_t k = 0; k < 3; k++) {
        numbers[k] = (float)(set->origin[k] + (double)set->centers[3 * i + k]);
        numbers[3 + k] = (float)ewa_log_scale_within(set->scales[3 * i + k]);
        numbers[6 + k] = (float)(0.5 + EWA_SH_CONSTANT * (double)harmonics[k]);
    }
}

static void bound_chunk(const packing *p, uint32_t first, float low[BOUNDS], float high[BOUNDS]) {
    for (uint32_t i = first; i < first + CHUNK && i < p->set->count; i++) {
        float numbers[BOUNDS];
        take_numbers(p->set, p->order[i], numbers);
        for (int k = 0; k < BOUNDS; k++) {
            low[k] = i == first ? numbers[k] : fminf(low[k], numbers[k]);
            high[k] = i == first ? numbers[k] : fmaxf(high[k], numbers[k]);
        }
    }
}

/// Share of a number between two bounds in steps of so many bits.
static uint32_t steps_of(float number, float low, float high, uint32_t bits) {
    const double maximum = (double)((1u << bits) - 1);
    return high > low ? (uint32_t)floor(((double)number - (double)low) / ((double)high - (double)low) * maximum + 0.5) : 0;
}

/// Three numbers in 11, 10 and 11 bits.
static uint32_t pack_three(const float *numbers, const float *low, const float *high) {
    return steps_of(numbers[0], low[0], high[0], 11) << 21 | steps_of(numbers[1], low[1], high[1], 10) << 11 |
           steps_of(numbers[2], low[2], high[2], 11);
}

/// A unit quaternion without its largest component, which is told by two bits, in 10 bits each.
static uint32_t pack_rotation(const float q[4]) {
    uint32_t largest = 0;
    for (uint32_t k = 1; k < 4; k++)
        if (fabsf(q[k]) > fabsf(q[largest])) largest = k;
    uint32_t word = largest;
    for (uint32_t k = 0; k < 4; k++) {
        if (k == largest) continue;
        const double side = q[largest] < 0 ? -(double)q[k] : (double)q[k];
        word = word << 10 | (uint32_t)fmax(fmin(floor((side / sqrt(2) + 0.5) * 1023 + 0.5), 1023), 0);
    }
    return word;
}

static ewa_status put_header(const packing *p, uint32_t chunk_count, uint32_t rest_count) {
    static const char *const bounds[BOUNDS] = {"x", "y", "z", "scale_x", "scale_y", "scale_z", "r", "g", "b"};
    char head[HEAD_BYTES];
    int length = snprintf(head, sizeof head, "ply\nformat binary_little_endian 1.0\nelement chunk %u\n", chunk_count);
    for (int part = 0; part < 3; part++)
        for (int side = 0; side < 2; side++)
            for (int k = 0; k < 3; k++)
                length += snprintf(head + length, sizeof head - (size_t)length, "property float %s_%s\n",
                                   side ? "max" : "min", bounds[3 * part + k]);
    length += snprintf(head + length, sizeof head - (size_t)length,
                       "element vertex %u\nproperty uint packed_position\nproperty uint packed_rotation\n"
                       "property uint packed_scale\nproperty uint packed_color\n",
                       p->set->count);
    if (rest_count) length += snprintf(head + length, sizeof head - (size_t)length, "element sh %u\n", p->set->count);
    for (uint32_t k = 0; k < rest_count; k++)
        length += snprintf(head + length, sizeof head - (size_t)length, "property uchar f_rest_%u\n", k);
    length += snprintf(head + length, sizeof head - (size_t)length, "end_header\n");
    return ewa_writer_put(p->target->writer, head, (size_t)length);
}

static ewa_status put_chunk(const packing *p, uint32_t first) {
    float low[BOUNDS], high[BOUNDS];
    uint8_t record[2 * BOUNDS * sizeof(float)], *to = record;
    bound_chunk(p, first, low, high);
    for (int part = 0; part < 3; part++) {
        for (int k = 0; k < 3; k++) to = ewa_put_f32(to, low[3 * part + k]);
        for (int k = 0; k < 3; k++) to = ewa_put_f32(to, high[3 * part + k]);
    }
    return ewa_writer_put(p->target->writer, record, sizeof record);
}

static ewa_status put_vertices(const packing *p, uint32_t first) {
    float low[BOUNDS], high[BOUNDS], numbers[BOUNDS];
    uint8_t records[CHUNK * WORDS * 4], *to = records;
    bound_chunk(p, first, low, high);
    for (uint32_t i = first; i < first + CHUNK && i < p->set->count; i++) {
        const size_t from = p->order[i];
        take_numbers(p->set, from, numbers);
        uint32_t color = 0;
        for (int k = 6; k < BOUNDS; k++) color = color << 8 | steps_of(numbers[k], low[k], high[k], 8);
        to = ewa_put_u32(to, pack_three(numbers, low, high));
        to = ewa_put_u32(to, pack_rotation(p->set->rotations + 4 * from));
        to = ewa_put_u32(to, pack_three(numbers + 3, low + 3, high + 3));
        to = ewa_put_u32(to, color << 8 | ewa_byte_of(255 * (double)p->set->opacities[from]));
    }
    return ewa_writer_put(p->target->writer, records, (size_t)(to - records));
}

/// The harmonics beyond the first of a Gaussian, colour by colour, from -4 to 4 in 256 steps.
static ewa_status put_harmonics(const packing *p, size_t from) {
    const uint32_t coefficients = ewa_sh_count(p->target->sh_degree);
    const float *harmonics = p->set->harmonics + from * 3 * ewa_sh_count(p->set->sh_degree);
    uint8_t record[MAX_REST], *to = record;
    for (size_t color = 0; color < 3; color++)
        for (size_t k = 1; k < coefficients; k++)
            *to++ = (uint8_t)fmax(fmin(floor(((double)harmonics[3 * k + color] / 8 + 0.5) * 256), 255), 0);
    return ewa_writer_put(p->target->writer, record, (size_t)(to - record));
}

static ewa_status write_packed(const packing *p) {
    const uint32_t count = p->set->count, rest_count = 3 * (ewa_sh_count(p->target->sh_degree) - 1);
    EWA_TRY(put_header(p, count / CHUNK + (count % CHUNK != 0), rest_count));
    for (uint64_t first = 0; first < count; first += CHUNK) EWA_TRY(put_chunk(p, (uint32_t)first));
    for (uint64_t first = 0; first < count; first += CHUNK) EWA_TRY(put_vertices(p, (uint32_t)first));
    for (uint32_t i = 0; i < count && rest_count; i++) EWA_TRY(put_harmonics(p, p->order[i]));
    return EWA_OK;
}

ewa_status ewa_gaussians_write_packed_ply(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    const ewa_attribute position = {
        .data = set->centers, .type = EWA_F32, .component_count = 3, .stride_bytes = 3 * sizeof(float)};
    packing p = {.target = target, .set = set, .order = ewa_allocate(set->context, set->count, sizeof *p.order)};
    if (!p.order) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < set->count; i++) p.order[i] = i;
    ewa_status status = EWA_OK;
    if (set->count > CHUNK) // one chunk stays as it is
        status = ewa_morton_order(set->context, &position, set->count, p.order, NULL, NULL);
    if (status == EWA_OK) status = write_packed(&p);
    ewa_release(set->context, p.order, set->count, sizeof *p.order);
    if (status == EWA_OK && (set->flat || set->antialiased))
        ewa_report(set->context, EWA_SEVERITY_WARNING, "%s: compressed PLY does not say that Gaussians are %s", target->name,
                   set->flat ? "flat: their third scale is e^-20" : "trained with a filter that keeps what they add");
    return status;
}
