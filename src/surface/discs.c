// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Discs straight from a cloud's streams.
#include "surface/discs.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { LANES = EWA_PACKET_LANES };

/// The numbers of one point of a stream.
static inline const void *numbers_at(const ewa_attribute *attribute, uint64_t point) {
    return (const char *)attribute->data + point * attribute->stride_bytes;
}

static inline double center_at(const ewa_discs *discs, uint64_t point, int c) {
    const void *at = numbers_at(discs->reader->position, point);
    return discs->wide_positions ? ((const double *)at)[c] : (double)((const float *)at)[c];
}

static inline double sigma_at(const ewa_discs *discs, uint64_t point) {
    const float radius = *(const float *)numbers_at(discs->reader->radius, point);
    return (double)radius * discs->reader->sigma_per_radius;
}

/// What is safe in single precision; everything else is looked at in double precision.
static ewa_safe_range safe_range(const ewa_surfel_reader *reader) {
    const double minimum = 2 / EWA_SURFEL_LIMIT / reader->sigma_per_radius,
                 maximum = 0.5 * EWA_SURFEL_LIMIT / reader->sigma_per_radius;
    return (ewa_safe_range){.radius_min = (float)fmax(minimum, (double)FLT_MIN),
                            .radius_max = (float)fmin(maximum, (double)FLT_MAX)};
}

bool ewa_discs_open(const ewa_surfel_reader *reader, const ewa_pack_kernels *kernels, ewa_discs *discs) {
    *discs = (ewa_discs){
        .reader = reader, .kernels = kernels, .wide_positions = reader->position->type == EWA_F64};
    const bool are_discs = !reader->tangent_u &&
                           (discs->wide_positions || reader->position->type == EWA_F32) &&
                           reader->normal->type == EWA_F32 && reader->radius->type == EWA_F32 &&
                           (!reader->color || reader->color->type == EWA_U8);
    if (!are_discs) return false;
    discs->packed = !discs->wide_positions && reader->position->stride_bytes == 3 * sizeof(float) &&
                    reader->normal->stride_bytes == 3 * sizeof(float) &&
                    reader->radius->stride_bytes == sizeof(float);
    discs->safe = safe_range(reader);
    return true;
}

/// Measures up to sixteen points from `first` on into running boxes of each lane; the last one fills the
/// rest.
static inline void measure_lanes(const ewa_discs *discs, uint64_t first, uint64_t count,
                                 uint8_t drawable[LANES], double low[3][LANES], double high[3][LANES]) {
    double center[3][LANES], length[LANES], sigma[LANES];
    for (uint32_t i = 0; i < LANES; i++) {
        const uint64_t point = first + (i < count ? i : count - 1);
        for (int c = 0; c < 3; c++) center[c][i] = center_at(discs, point, c);
        const float *n = numbers_at(discs->reader->normal, point);
        // In double precision the sum of floats neither overflows nor vanishes.
        length[i] = fabs((double)n[0]) + fabs((double)n[1]) + fabs((double)n[2]);
        sigma[i] = sigma_at(discs, point);
    }
    for (int i = 0; i < LANES; i++)
        drawable[i] = (fabs(center[0][i]) <= EWA_SURFEL_LIMIT) & (fabs(center[1][i]) <= EWA_SURFEL_LIMIT) &
                      (fabs(center[2][i]) <= EWA_SURFEL_LIMIT) & (length[i] > 0) & (length[i] < INFINITY) &
                      (sigma[i] >= 1 / EWA_SURFEL_LIMIT) & (sigma[i] <= EWA_SURFEL_LIMIT);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) {
            const double value = center[c][i], minimum = low[c][i], maximum = high[c][i];
            low[c][i] = (drawable[i] & (value < minimum)) ? value : minimum;
            high[c][i] = (drawable[i] & (value > maximum)) ? value : maximum;
        }
}

/// Measures whole groups of sixteen as far as the kernel can; returns how many points that were.
static uint64_t measure_packed(const ewa_discs *discs, uint64_t first, uint64_t count, uint8_t *drawable,
                               ewa_disc_facts *facts) {
    const ewa_surfel_reader *r = discs->reader;
    float low[EWA_BOX_FLOATS], high[EWA_BOX_FLOATS];
    for (int k = 0; k < EWA_BOX_FLOATS; k++) low[k] = INFINITY, high[k] = -INFINITY;
    const uint64_t groups =
        discs->kernels->measure_discs(&discs->safe, numbers_at(r->position, first), numbers_at(r->normal, first),
                               numbers_at(r->radius, first), count / LANES, low, high);
    memset(drawable, 1, groups * LANES);
    for (int k = 0; groups && k < EWA_BOX_FLOATS; k++) {
        facts->low[k % 3] = fmin(facts->low[k % 3], (double)low[k]);
        facts->high[k % 3] = fmax(facts->high[k % 3], (double)high[k]);
    }
    return groups * LANES;
}

void ewa_discs_measure(const ewa_discs *discs, uint64_t first, uint64_t count, uint8_t *drawable,
                       ewa_disc_facts *facts) {
    double low[3][LANES], high[3][LANES];
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) low[c][i] = INFINITY, high[c][i] = -INFINITY;
    *facts =
        (ewa_disc_facts){.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    for (uint64_t done = 0; done < count;) {
        if (discs->packed) done += measure_packed(discs, first + done, count - done, drawable + done, facts);
        if (done == count) break;
        const uint64_t left = count - done, here = left < LANES ? left : LANES;
        uint8_t flags[LANES];
        measure_lanes(discs, first + done, here, flags, low, high);
        memcpy(drawable + done, flags, here);
        done += here;
    }
    for (uint64_t i = 0; i < count; i++) facts->drawable_count += drawable[i];
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) {
            facts->low[c] = fmin(facts->low[c], low[c][i]);
            facts->high[c] = fmax(facts->high[c], high[c][i]);
        }
}

void ewa_discs_load(const ewa_discs *discs, double unit, const uint32_t *points, uint32_t count,
                    double first[3], ewa_packet *packet, float normal[3][LANES]) {
    const double per_unit = 1 / unit;
    double start[3];
    for (int c = 0; c < 3; c++) start[c] = center_at(discs, points[0], c), first[c] = start[c] * per_unit;
    for (uint32_t i = 0; i < LANES; i++) {
        const uint32_t point = points[i < count ? i : 0];
        const float *n = numbers_at(discs->reader->normal, point);
        packet->x[i] = (float)((center_at(discs, point, 0) - start[0]) * per_unit);
        packet->y[i] = (float)((center_at(discs, point, 1) - start[1]) * per_unit);
        packet->z[i] = (float)((center_at(discs, point, 2) - start[2]) * per_unit);
        packet->sigma[i] = ewa_packed_sigma(sigma_at(discs, point) * per_unit);
        for (int c = 0; c < 3; c++) normal[c][i] = n[c];
    }
    for (uint32_t i = 0; i < LANES; i++) packet->angle[i] = 0, packet->ratio[i] = UINT16_MAX;
}

void ewa_discs_prefetch(const ewa_discs *discs, uint32_t point) {
    const ewa_surfel_reader *r = discs->reader;
    __builtin_prefetch(numbers_at(r->position, point));
    __builtin_prefetch(numbers_at(r->normal, point));
    __builtin_prefetch(numbers_at(r->radius, point));
    if (r->color) __builtin_prefetch(numbers_at(r->color, point));
}
