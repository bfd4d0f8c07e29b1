// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From what files hold to what a set says: activations, filters, unit quaternions, an origin; and the check of
// every number.
//
// Based on: B. Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", 2023 (scales are
// exponentials, opacities sigmoids); Z. Yu et al., "Mip-Splatting", 2024, eq. 9 (the 3D filter).
#include "io/gaussian/gaussian.h"
#include "math/gaussian.h"

#include <math.h>

enum { PIECES = 64 }; // of the set, for the workers; a fixed number, so that the first fault is the same

/// What is wrong with a Gaussian.
typedef enum fault {
    FAULT_NONE,
    FAULT_CENTER,
    FAULT_SCALE,
    FAULT_ROTATION,
    FAULT_OPACITY,
    FAULT_HARMONICS,
} fault;

ewa_status ewa_gaussians_make(const ewa_gaussian_source *source, uint64_t count, uint64_t min_bytes,
                              uint64_t left_bytes, uint32_t sh_degree, ewa_gaussians *gaussians) {
    if (count == 0)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: there are no Gaussians", source->name);
    if (min_bytes && count > left_bytes / min_bytes)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: %llu Gaussians take at least %llu bytes each, but %llu bytes are left",
                        source->name, (unsigned long long)count, (unsigned long long)min_bytes,
                        (unsigned long long)left_bytes);
    if (count > UINT32_MAX)
        return ewa_fail(source->context, EWA_ERROR_LIMIT, "%s: %llu Gaussians are over the limit of %u",
                        source->name, (unsigned long long)count, UINT32_MAX);
    return ewa_gaussians_create(source->context, (uint32_t)count, sh_degree, gaussians);
}

typedef struct decode_job {
    uint32_t count;
    ewa_gaussian_decode *decode;
    void *data;
} decode_job;

static void decode_piece(void *data, uint32_t piece, uint32_t worker) {
    (void)worker;
    const decode_job *job = data;
    job->decode(job->data, (uint32_t)ewa_split(job->count, PIECES, piece),
                (uint32_t)ewa_split(job->count, PIECES, piece + 1));
}

void ewa_gaussians_decode(ewa_context *context, uint32_t count, ewa_gaussian_decode *decode, void *data) {
    decode_job job = {count, decode, data};
    ewa_parallel(context, decode_piece, &job, PIECES);
}

void ewa_quaternion_complete(const double others[3], uint32_t largest, float rotation[4]) {
    double rest = 1;
    for (uint32_t k = 0, from = 0; k < 4; k++) {
        if (k == largest) continue;
        rotation[k] = (float)others[from];
        rest -= others[from] * others[from];
        from++;
    }
    rotation[largest] = (float)sqrt(fmax(rest, 0));
}

typedef struct settle_job {
    ewa_gaussians *set;
    const ewa_gaussian_form *form;
    uint32_t at[PIECES]; ///< the first Gaussian of a piece that is wrong
    fault faults[PIECES];
} settle_job;

/// exp(x), infinite where doubles end.
static double exponential(double x) { return x > 700 ? (double)INFINITY : isnan(x) ? x : ewa_exp(x); }

static bool is_finite(const float *numbers, uint32_t count) {
    // Anything times zero is zero, but for what is not finite.
    float sum = 0;
    for (uint32_t i = 0; i < count; i++) sum += 0 * numbers[i];
    return sum == 0;
}

/// Widens a Gaussian by its filter, which keeps what it adds in all.
static void apply_filter(double filter, double scales[3], double *opacity) {
    double before = 1, after = 1;
    for (int k = 0; k < 3; k++) {
        const double wide2 = scales[k] * scales[k] + filter * filter;
        before *= scales[k] * scales[k];
        after *= wide2;
        scales[k] = sqrt(wide2);
    }
    if (after > 0) *opacity *= sqrt(before / after);
}

static fault settle(ewa_gaussians *set, const ewa_gaussian_form *form, uint32_t i) {
    float *center = set->centers + 3 * (size_t)i, *scale = set->scales + 3 * (size_t)i,
          *rotation = set->rotations + 4 * (size_t)i;
    if (!is_finite(center, 3)) return FAULT_CENTER;
    double scales[3], opacity = (double)set->opacities[i];
    const int scale_count = set->flat ? 2 : 3;
    for (int k = 0; k < 3; k++) scales[k] = k < scale_count ? (double)scale[k] : 0;
    if (form->log_scales)
        for (int k = 0; k < scale_count; k++) scales[k] = exponential(scales[k]);
    if (form->logits) opacity = 1 / (1 + exponential(-opacity));
    if (form->filter) {
        if (!is_finite(&form->filter[i], 1)) return FAULT_SCALE;
        apply_filter((double)form->filter[i], scales, &opacity);
    }
    for (int k = 0; k < 3; k++) {
        scale[k] = (float)scales[k];
        if (!(scale[k] >= 0) || !is_finite(&scale[k], 1)) return FAULT_SCALE;
    }
    if (!(opacity >= 0 && opacity <= 1)) return FAULT_OPACITY;
    set->opacities[i] = (float)opacity;
    double norm2 = 0;
    for (int k = 0; k < 4; k++) norm2 += (double)rotation[k] * (double)rotation[k];
    if (!(norm2 > 0) || !is_finite(rotation, 4)) return FAULT_ROTATION;
    const double norm = sqrt(norm2);
    for (int k = 0; k < 4; k++) rotation[k] = (float)((double)rotation[k] / norm);
    const uint32_t count = 3 * ewa_sh_count(set->sh_degree);
    return is_finite(set->harmonics + (size_t)i * count, count) ? FAULT_NONE : FAULT_HARMONICS;
}

static void settle_piece(void *data, uint32_t piece, uint32_t worker) {
    (void)worker;
    settle_job *job = data;
    const uint32_t first = (uint32_t)ewa_split(job->set->count, PIECES, piece),
                   end = (uint32_t)ewa_split(job->set->count, PIECES, piece + 1);
    job->faults[piece] = FAULT_NONE;
    for (uint32_t i = first; i < end && job->faults[piece] == FAULT_NONE; i++) {
        job->at[piece] = i;
        job->faults[piece] = settle(job->set, job->form, i);
    }
}

ewa_status ewa_gaussians_settle(const ewa_gaussian_source *source, const ewa_gaussian_form *form,
                                ewa_gaussians *gaussians) {
    static const char *const reasons[] = {
        [FAULT_CENTER] = "a coordinate of the centre is not finite",
        [FAULT_SCALE] = "a scale is not finite or below 0",
        [FAULT_ROTATION] = "the quaternion is zero or not finite",
        [FAULT_OPACITY] = "the opacity is no number in [0, 1]",
        [FAULT_HARMONICS] = "a coefficient of the colour is not finite",
    };
    settle_job job = {.set = gaussians, .form = form};
    ewa_parallel(source->context, settle_piece, &job, PIECES);
    for (int piece = 0; piece < PIECES; piece++)
        if (job.faults[piece] != FAULT_NONE)
            return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: Gaussian %llu of %llu: %s", source->name,
                            (unsigned long long)(form->first + job.at[piece]),
                            (unsigned long long)(form->whole ? form->whole : gaussians->count), reasons[job.faults[piece]]);
    return EWA_OK;
}

void ewa_gaussians_place(const double *centers_world, ewa_gaussians *gaussians) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < gaussians->count; i++)
        for (int k = 0; k < 3; k++) {
            const double at = centers_world[3 * (size_t)i + (size_t)k];
            if (!isfinite(at)) continue;
            low[k] = fmin(low[k], at);
            high[k] = fmax(high[k], at);
        }
    // A whole number, so that files of decimals keep them as they are read.
    for (int k = 0; k < 3; k++)
        gaussians->origin[k] = low[k] <= high[k] ? floor(0.5 * low[k] + 0.5 * high[k]) : 0;
    for (uint32_t i = 0; i < gaussians->count; i++)
        for (int k = 0; k < 3; k++)
            gaussians->centers[3 * (size_t)i + (size_t)k] =
                (float)(centers_world[3 * (size_t)i + (size_t)k] - gaussians->origin[k]);
}

void ewa_gaussians_flatten(ewa_gaussians *gaussians) {
    gaussians->flat = true;
    for (size_t i = 0; i < gaussians->count; i++) gaussians->scales[3 * i + 2] = 0;
}
