// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// .splat: records of 32 bytes and nothing else. The centre and the scales are floats; red, green, blue and the opacity
// are bytes, shares of 255; so are w x y z of the quaternion, 128 being 0 and 1 being 128 more.
//
// Based on: K. Kwok, antimatter15/splat, 2023.
#include "io/gaussian/gaussian.h"

#include <strings.h>

enum { RECORD_BYTES = 32, SCALE_AT = 12, COLOR_AT = 24, ROTATION_AT = 28, LOOKED_RECORDS = 1024 };

/// Numbers beyond which bytes are no coordinates.
static const float MAX_WORLD = 1e9f;

typedef struct splat_job {
    const uint8_t *bytes;
    ewa_gaussians *set;
} splat_job;

static void decode(void *data, uint32_t first, uint32_t end) {
    const splat_job *job = data;
    ewa_gaussians *set = job->set;
    for (uint32_t i = first; i < end; i++) {
        const uint8_t *record = job->bytes + (size_t)i * RECORD_BYTES;
        for (uint32_t k = 0; k < 3; k++) {
            set->centers[3 * (size_t)i + k] = ewa_file_f32(record + 4 * k);
            set->scales[3 * (size_t)i + k] = ewa_file_f32(record + SCALE_AT + 4 * k);
            set->harmonics[3 * (size_t)i + k] = ewa_sh_of_color(record[COLOR_AT + k] / 255.0);
        }
        set->opacities[i] = (float)(record[COLOR_AT + 3] / 255.0);
        for (uint32_t k = 0; k < 4; k++)
            set->rotations[4 * (size_t)i + k] = (float)((record[ROTATION_AT + k] - 128) / 128.0);
    }
}

static ewa_status read_splat(const ewa_gaussian_source *source, ewa_gaussians *set,
                             ewa_gaussian_facts *facts) {
    (void)facts;
    if (source->size_bytes % RECORD_BYTES)
        return ewa_fail(
            source->context, EWA_ERROR_FORMAT,
            "%s: %zu bytes are no whole number of records of 32: the file is cut short, or no .splat",
            source->name, source->size_bytes);
    EWA_TRY(ewa_gaussians_make(source, source->size_bytes / RECORD_BYTES, RECORD_BYTES, source->size_bytes, 0,
                               set));
    splat_job job = {source->bytes, set};
    ewa_gaussians_decode(source->context, set->count, decode, &job);
    return ewa_gaussians_settle(source, &(ewa_gaussian_form){.log_scales = false}, set);
}

/// Whether a record looks like a Gaussian: its quaternion is one of length 1.
static bool is_plausible(const uint8_t *record) {
    double norm2 = 0;
    for (int k = 0; k < 3; k++) {
        const float center = ewa_file_f32(record + 4 * k), scale = ewa_file_f32(record + SCALE_AT + 4 * k);
        if (!(fabsf(center) < MAX_WORLD) || !(scale >= 0 && scale < MAX_WORLD)) return false;
    }
    for (int k = 0; k < 4; k++) {
        const double part = (record[ROTATION_AT + k] - 128) / 128.0;
        norm2 += part * part;
    }
    return norm2 > 0.81 && norm2 < 1.21;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    (void)status;
    const size_t length = strlen(source->name);
    if (length > 6 && strcasecmp(source->name + length - 6, ".splat") == 0) return true;
    if (source->size_bytes % RECORD_BYTES) return false;
    const size_t count = source->size_bytes / RECORD_BYTES,
                 looked = count < LOOKED_RECORDS ? count : LOOKED_RECORDS;
    for (size_t i = 0; i < looked; i++)
        if (!is_plausible(source->bytes + ewa_split(count, (uint32_t)looked, (uint32_t)i) * RECORD_BYTES))
            return false;
    return true;
}

const ewa_gaussian_reader ewa_gaussians_splat = {EWA_GAUSSIANS_SPLAT, probe, read_splat};
