// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the writers of Gaussians share: each writes a checked set to a file that is open.
#ifndef EWA_SRC_GAUSSIAN_SAVE_H
#define EWA_SRC_GAUSSIAN_SAVE_H

#include "io/file.h"
#include "io/gaussian/gaussian.h"

typedef struct ewa_gaussian_target {
    const ewa_gaussians *set;
    const char *name; ///< stands for the file in messages
    ewa_writer *writer;
    uint32_t sh_degree; ///< that is written, at most that of the set
    uint32_t spz_version;
    bool keep_order; ///< of SOG, whose pictures are else of neighbours in space
} ewa_gaussian_target;

typedef ewa_status ewa_gaussian_write(const ewa_gaussian_target *target);
ewa_gaussian_write ewa_gaussians_write_ply, ewa_gaussians_write_packed_ply, ewa_gaussians_write_splat,
    ewa_gaussians_write_spz, ewa_gaussians_write_gltf, ewa_gaussians_write_sog, ewa_gaussians_write_streamed_sog;

/// Turns a set about x so that what is up is -y, as in 3DGS. Errors: EWA_ERROR_ARGUMENT (up is along x), EWA_ERROR_NUMERIC.
ewa_status ewa_gaussians_turn_up(ewa_gaussians *set, const double up_world[3]);

/// Writes a number with its lowest byte first and returns what follows.
static inline uint8_t *ewa_put_u32(uint8_t *to, uint32_t value) {
    for (int k = 0; k < 4; k++) to[k] = (uint8_t)(value >> 8 * k);
    return to + 4;
}
static inline uint8_t *ewa_put_u64(uint8_t *to, uint64_t value) {
    return ewa_put_u32(ewa_put_u32(to, (uint32_t)value), (uint32_t)(value >> 32));
}
static inline uint8_t *ewa_put_f32(uint8_t *to, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return ewa_put_u32(to, bits);
}

/// The byte nearest to a number, the ends for what is beyond them.
static inline uint8_t ewa_byte_of(double value) {
    return (uint8_t)(value > 0 ? value < 255 ? floor(value + 0.5) : 255 : 0);
}

/// The logarithm that is written for a scale: of 0 that of something too small to be seen.
static inline double ewa_log_scale(float scale) { return log(fmax((double)scale, 1e-30)); }

/// The same within what few bits can tell apart.
static inline double ewa_log_scale_within(float scale) { return fmax(fmin(ewa_log_scale(scale), 20), -20); }

#endif
