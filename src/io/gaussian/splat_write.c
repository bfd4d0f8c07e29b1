// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as .splat: see splat.c for its records.
#include "io/gaussian/save.h"

enum { RECORD_BYTES = 32 };

/// Fills a record; returns whether the colour lies within what a byte can hold.
static bool make_record(const ewa_gaussians *set, size_t i, uint8_t record[RECORD_BYTES]) {
    const float *harmonics = set->harmonics + i * 3 * ewa_sh_count(set->sh_degree);
    uint8_t *to = record;
    bool fits = true;
    for (size_t k = 0; k < 3; k++)
        to = ewa_put_f32(to, (float)(set->origin[k] + (double)set->centers[3 * i + k]));
    for (size_t k = 0; k < 3; k++) to = ewa_put_f32(to, set->scales[3 * i + k]);
    for (int k = 0; k < 3; k++) {
        const double color = 255 * (0.5 + EWA_SH_CONSTANT * (double)harmonics[k]);
        fits &= color > -0.5 && color < 255.5;
        *to++ = ewa_byte_of(color);
    }
    *to++ = ewa_byte_of(255 * (double)set->opacities[i]);
    for (size_t k = 0; k < 4; k++) *to++ = ewa_byte_of(128 + 128 * (double)set->rotations[4 * i + k]);
    return fits;
}

ewa_status ewa_gaussians_write_splat(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    uint32_t clamped_count = 0;
    for (size_t i = 0; i < set->count; i++) {
        uint8_t record[RECORD_BYTES];
        clamped_count += !make_record(set, i, record);
        EWA_TRY(ewa_writer_put(target->writer, record, sizeof record));
    }
    if (set->sh_degree > 0)
        ewa_report(
            set->context, EWA_SEVERITY_WARNING,
            "%s: .splat has no room for the harmonics of degree 1 to %u: colours no longer change with the "
            "direction",
            target->name, set->sh_degree);
    if (clamped_count)
        ewa_report(set->context, EWA_SEVERITY_WARNING,
                   "%s: colours of %u Gaussians beyond [0, 1] are clamped", target->name, clamped_count);
    return EWA_OK;
}
