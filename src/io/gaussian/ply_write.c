// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as PLY with the columns of 3DGS, of 2DGS where they are flat; normals are zeros, as its own program writes.
#include "io/gaussian/save.h"

#include <stdio.h>

enum {
    HEAD_BYTES = 4096,
    MAX_NUMBERS = 6 + 3 * (EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1) + 8,
    RECORD_BYTES = 3 * 8 + 4 * MAX_NUMBERS + 2,
};

/// The largest logit that is written: 1 / (1 + exp(-it)) is 1 to a float, and opacities of 0 cannot be seen.
static const double MAX_LOGIT = 18;

static bool has_origin(const ewa_gaussians *set) {
    return set->origin[0] != 0 || set->origin[1] != 0 || set->origin[2] != 0;
}

static ewa_status put_header(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    char head[HEAD_BYTES];
    const char *type = has_origin(set) ? "double" : "float";
    int length =
        snprintf(head, sizeof head,
                 "ply\nformat binary_little_endian 1.0\n%selement vertex %u\nproperty %s x\nproperty %s y\n"
                 "property %s z\nproperty float nx\nproperty float ny\nproperty float nz\n",
                 set->antialiased ? "comment SplatRenderMode: mip\n"
                 : set->flat      ? "comment SplatRenderMode: 2dgs\n"
                                  : "",
                 set->count, type, type, type);
    static const char *const names[] = {"f_dc", "f_rest", NULL, "scale", "rot"};
    const uint32_t counts[] = {3, 3 * (ewa_sh_count(target->sh_degree) - 1), 1, set->flat ? 2 : 3, 4};
    for (size_t n = 0; n < sizeof counts / sizeof counts[0]; n++)
        for (uint32_t k = 0; k < counts[n]; k++)
            length += names[n]
                          ? snprintf(head + length, sizeof head - (size_t)length, "property float %s_%u\n",
                                     names[n], k)
                          : snprintf(head + length, sizeof head - (size_t)length, "property float opacity\n");
    length += snprintf(head + length, sizeof head - (size_t)length, "%send_header\n",
                       set->classes ? "property ushort classification\n" : "");
    return ewa_writer_put(target->writer, head, (size_t)length);
}

static float logit(float opacity) {
    const double value = log((double)opacity / (1 - (double)opacity));
    return (float)fmax(fmin(value, MAX_LOGIT), -MAX_LOGIT);
}

static ewa_status put_record(const ewa_gaussian_target *target, size_t i) {
    const ewa_gaussians *set = target->set;
    const uint32_t coefficients = ewa_sh_count(target->sh_degree);
    const float *harmonics = set->harmonics + i * 3 * ewa_sh_count(set->sh_degree);
    uint8_t record[RECORD_BYTES], *to = record;
    for (size_t k = 0; k < 3; k++) {
        const float center = set->centers[3 * i + k];
        if (has_origin(set)) {
            const double world = set->origin[k] + (double)center;
            uint64_t bits;
            memcpy(&bits, &world, sizeof bits);
            to = ewa_put_u64(to, bits);
        } else {
            to = ewa_put_f32(to, center);
        }
    }
    for (int k = 0; k < 3; k++) to = ewa_put_f32(to, 0);
    for (size_t k = 0; k < 3; k++) to = ewa_put_f32(to, harmonics[k]);
    for (size_t color = 0; color < 3; color++)
        for (size_t k = 1; k < coefficients; k++) to = ewa_put_f32(to, harmonics[3 * k + color]);
    to = ewa_put_f32(to, logit(set->opacities[i]));
    for (size_t k = 0; k < (set->flat ? 2u : 3u); k++)
        to = ewa_put_f32(to, (float)ewa_log_scale(set->scales[3 * i + k]));
    for (size_t k = 0; k < 4; k++) to = ewa_put_f32(to, set->rotations[4 * i + k]);
    if (set->classes) *to++ = (uint8_t)set->classes[i], *to++ = (uint8_t)(set->classes[i] >> 8);
    return ewa_writer_put(target->writer, record, (size_t)(to - record));
}

ewa_status ewa_gaussians_write_ply(const ewa_gaussian_target *target) {
    EWA_TRY(put_header(target));
    for (size_t i = 0; i < target->set->count; i++) EWA_TRY(put_record(target, i));
    return EWA_OK;
}
