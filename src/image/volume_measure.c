// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the voxels of a volume hold.
#include "base/base.h"
#include "ewa/volume.h"
#include "image/volume.h"

#include <math.h>

enum { BINS = 256, ROW = 1024, COLUMNS = 48 }; ///< columns along an axis across lines of sight

#define READ_EACH(type)                                                                                      \
    {                                                                                                        \
        const type *from = (const type *)volume->voxels + first;                                             \
        for (size_t i = 0; i < count; i++) numbers[i] = (float)from[i * stride];                             \
        break;                                                                                               \
    }

/// Inlined twice, so that the compiler knows the stride of rows.
static inline __attribute__((always_inline)) void read_each(const ewa_volume *volume, uint64_t first,
                                                            size_t stride, size_t count, float *numbers) {
    switch (volume->type) {
    case EWA_U8:
        READ_EACH(uint8_t)
    case EWA_I8:
        READ_EACH(int8_t)
    case EWA_U16:
        READ_EACH(uint16_t)
    case EWA_I16:
        READ_EACH(int16_t)
    default:
        READ_EACH(float)
    }
}

void ewa_volume_read(const ewa_volume *volume, uint64_t first, size_t count, float *numbers) {
    read_each(volume, first, 1, count, numbers);
}

ewa_status ewa_volume_look_through(const ewa_volume *volume, ewa_line_of_sight *look, void *user) {
    const uint32_t *dims = volume->dims;
    const uint64_t strides[3] = {1, dims[0], (uint64_t)dims[0] * dims[1]};
    uint32_t longest = dims[0];
    for (int axis = 1; axis < 3; axis++) longest = dims[axis] > longest ? dims[axis] : longest;
    float *numbers = ewa_allocate(volume->context, longest, sizeof *numbers);
    if (!numbers) return EWA_ERROR_MEMORY;
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const uint32_t u_step = 1 + dims[u] / COLUMNS, v_step = 1 + dims[v] / COLUMNS;
        for (uint32_t b = v_step / 2; b < dims[v]; b += v_step)
            for (uint32_t a = u_step / 2; a < dims[u]; a += u_step) {
                read_each(volume, a * strides[u] + b * strides[v], strides[axis], dims[axis], numbers);
                look(user, numbers, 1, dims[axis]);
                look(user, numbers + dims[axis] - 1, -1, dims[axis]);
            }
    }
    ewa_release(volume->context, numbers, longest, sizeof *numbers);
    return EWA_OK;
}

static uint64_t count_voxels(const ewa_volume *volume) {
    return (uint64_t)volume->dims[0] * volume->dims[1] * volume->dims[2];
}

static void measure_range(const ewa_volume *volume, ewa_volume_facts *facts) {
    float numbers[ROW];
    double low = INFINITY, high = -INFINITY, sum = 0;
    for (uint64_t first = 0; first < facts->voxel_count; first += ROW) {
        const uint64_t left = facts->voxel_count - first;
        const size_t count = left < ROW ? (size_t)left : ROW;
        double row = 0;
        ewa_volume_read(volume, first, count, numbers);
        for (size_t i = 0; i < count; i++) {
            const double number = numbers[i];
            if (!isfinite(number)) continue;
            facts->finite_count++;
            low = number < low ? number : low;
            high = number > high ? number : high;
            row += number;
        }
        sum += row;
    }
    if (!facts->finite_count) return;
    facts->low = low;
    facts->high = high;
    facts->mean = sum / (double)facts->finite_count;
}

static void measure_histogram(const ewa_volume *volume, ewa_volume_facts *facts) {
    float numbers[ROW];
    const double scale = facts->high > facts->low ? (BINS - 1) / (facts->high - facts->low) : 0;
    for (uint64_t first = 0; first < facts->voxel_count; first += ROW) {
        const uint64_t left = facts->voxel_count - first;
        const size_t count = left < ROW ? (size_t)left : ROW;
        ewa_volume_read(volume, first, count, numbers);
        for (size_t i = 0; i < count; i++)
            if (isfinite(numbers[i])) facts->histogram[(int)((numbers[i] - facts->low) * scale + 0.5)]++;
    }
}

static void measure_place(const ewa_volume *volume, ewa_volume_facts *facts) {
    for (int k = 0; k < 3; k++) {
        const double *row = volume->index_to_world + 4 * k;
        facts->low_world[k] = facts->high_world[k] = row[3];
        for (int axis = 0; axis < 3; axis++) {
            const double reach = row[axis] * (volume->dims[axis] - 1.0);
            *(reach < 0 ? &facts->low_world[k] : &facts->high_world[k]) += reach;
            facts->spacing_world[axis] += row[axis] * row[axis];
        }
    }
    for (int axis = 0; axis < 3; axis++) facts->spacing_world[axis] = sqrt(facts->spacing_world[axis]);
}

ewa_status ewa_volume_measure(const ewa_volume *volume, ewa_volume_facts *facts) {
    if (!volume || !volume->voxels || !facts) return EWA_ERROR_ARGUMENT;
    *facts = (ewa_volume_facts){.voxel_count = count_voxels(volume)};
    measure_range(volume, facts);
    if (facts->finite_count) measure_histogram(volume, facts);
    measure_place(volume, facts);
    return EWA_OK;
}
