// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Discs straight from a cloud's streams.
#include "splat/discs.h"

#include <math.h>

enum { LANES = EWA_PACKET_LANES };

/// The numbers of one point of a stream.
static inline const void *numbers_at(const ewa_attribute *attribute, uint64_t point) {
    return (const char *)attribute->data + point * attribute->stride_bytes;
}

static inline void load_center(const ewa_discs *discs, uint64_t point, uint32_t lane, ewa_lanes *lanes) {
    const ewa_surfel_reader *r = discs->reader;
    const void *at = numbers_at(r->position, point);
    for (int c = 0; c < 3; c++) {
        const double number =
            discs->wide_positions ? ((const double *)at)[c] : (double)((const float *)at)[c];
        lanes->center_world[c][lane] = number + r->origin_world[c];
    }
}

static inline void load_disc(const ewa_discs *discs, uint64_t point, uint32_t lane, ewa_lanes *lanes) {
    const ewa_surfel_reader *r = discs->reader;
    load_center(discs, point, lane, lanes);
    const float *normal = numbers_at(r->normal, point), *radius = numbers_at(r->radius, point);
    for (int c = 0; c < 3; c++) lanes->normal[c][lane] = (double)normal[c];
    lanes->sigma_world[lane] = (double)*radius * r->sigma_per_radius;
}

bool ewa_discs_open(const ewa_surfel_reader *reader, ewa_discs *discs) {
    *discs = (ewa_discs){.reader = reader, .wide_positions = reader->position->type == EWA_F64};
    return !reader->tangent_u && (discs->wide_positions || reader->position->type == EWA_F32) &&
           reader->normal->type == EWA_F32 && reader->radius->type == EWA_F32 &&
           (!reader->color || reader->color->type == EWA_U8);
}

/// Surveys sixteen loaded lanes into running boxes of each lane; returns the number of drawable ones.
static inline uint32_t survey_lanes(const ewa_lanes *lanes, uint8_t *drawable, double low[3][LANES],
                                    double high[3][LANES]) {
    uint32_t kept = 0;
    for (int i = 0; i < LANES; i++) {
        const double x = lanes->center_world[0][i], y = lanes->center_world[1][i],
                     z = lanes->center_world[2][i], sigma = lanes->sigma_world[i];
        const double nx = fabs(lanes->normal[0][i]), ny = fabs(lanes->normal[1][i]),
                     nz = fabs(lanes->normal[2][i]);
        const double length = nx + ny + nz; // of floats: neither overflows nor vanishes
        const bool kept_here = (fabs(x) <= EWA_SURFEL_LIMIT) & (fabs(y) <= EWA_SURFEL_LIMIT) &
                               (fabs(z) <= EWA_SURFEL_LIMIT) & (length > 0) & (length < INFINITY) &
                               (sigma >= 1 / EWA_SURFEL_LIMIT) & (sigma <= EWA_SURFEL_LIMIT);
        drawable[i] = kept_here;
        kept += kept_here;
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) {
            const double value = lanes->center_world[c][i], least = low[c][i], most = high[c][i];
            low[c][i] = drawable[i] && value < least ? value : least;
            high[c][i] = drawable[i] && value > most ? value : most;
        }
    return kept;
}

void ewa_discs_survey(const ewa_discs *discs, uint64_t first, uint64_t count, uint8_t *drawable,
                      ewa_disc_facts *facts) {
    double low[3][LANES], high[3][LANES];
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) low[c][i] = INFINITY, high[c][i] = -INFINITY;
    *facts = (ewa_disc_facts){.drawable_count = 0};
    ewa_lanes lanes;
    uint64_t done = 0;
    for (; done + LANES <= count; done += LANES) {
        for (uint32_t i = 0; i < LANES; i++) load_disc(discs, first + done + i, i, &lanes);
        facts->drawable_count += survey_lanes(&lanes, drawable + done, low, high);
    }
    if (done < count) {
        uint8_t last[LANES];
        for (uint32_t i = 0; i < LANES; i++) load_disc(discs, first + done, i, &lanes);
        for (uint32_t i = 0; i < count - done; i++) load_disc(discs, first + done + i, i, &lanes);
        survey_lanes(&lanes, last, low, high);
        for (uint64_t i = 0; done < count; i++, done++) {
            drawable[done] = last[i];
            facts->drawable_count += last[i];
        }
    }
    for (int c = 0; c < 3; c++) {
        facts->low_world[c] = INFINITY, facts->high_world[c] = -INFINITY;
        for (int i = 0; i < LANES; i++) {
            facts->low_world[c] = low[c][i] < facts->low_world[c] ? low[c][i] : facts->low_world[c];
            facts->high_world[c] = high[c][i] > facts->high_world[c] ? high[c][i] : facts->high_world[c];
        }
    }
}

void ewa_discs_load(const ewa_discs *discs, const uint32_t *points, uint32_t count, ewa_lanes *lanes) {
    for (uint32_t i = 0; i < LANES; i++) {
        load_disc(discs, points[i < count ? i : 0], i, lanes);
        lanes->ratio[i] = 1;
    }
}

void ewa_discs_prefetch(const ewa_discs *discs, uint32_t point) {
    const ewa_surfel_reader *r = discs->reader;
    __builtin_prefetch(numbers_at(r->position, point));
    __builtin_prefetch(numbers_at(r->normal, point));
    __builtin_prefetch(numbers_at(r->radius, point));
    if (r->color) __builtin_prefetch(numbers_at(r->color, point));
}
