// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// SPZ: Gaussians in few bytes. Centres are fixed-point numbers of 24 bits, scales logarithms in sixteenths, the rest
// bytes; of quaternions the smallest three components, or x y z, are there.
//
// Axes are right, up, back, or those that the file names; sets have the right, down, front of 3DGS.
//
// Based on: Niantic Labs, "spz", README and sources, versions 1 to 4.
#include "io/gaussian/spz.h"
#include "io/source.h"

/// Coordinate systems that a file can name: number 1 + bits, set for right, up, front; from 9 on the second and
/// third axis are exchanged.
enum { AXES_RIGHT = 1, AXES_UP = 2, AXES_FRONT = 4, AXES_PLAIN = 8, AXES_USUAL = 1 + AXES_RIGHT + AXES_UP };

typedef struct spz_job {
    const ewa_spz_header *header;
    const uint8_t *streams[EWA_SPZ_STREAMS];
    ewa_gaussians *set;
} spz_job;

static void decode_center(const spz_job *job, uint32_t i) {
    const uint32_t bytes = ewa_spz_stream_bytes(job->header, EWA_SPZ_CENTERS);
    const uint8_t *from = job->streams[EWA_SPZ_CENTERS] + (size_t)i * bytes;
    float *center = job->set->centers + 3 * (size_t)i;
    for (uint32_t k = 0; k < 3; k++) {
        if (bytes == 6) {
            center[k] = ewa_file_f16(from + 2 * k);
        } else {
            const uint32_t bits = ewa_file_u16(from + 3 * k) | (uint32_t)from[3 * k + 2] << 16;
            const int32_t fixed = bits & 0x800000 ? (int32_t)bits - 0x1000000 : (int32_t)bits;
            center[k] = ldexpf((float)fixed, -(int)job->header->fraction_bits);
        }
    }
}

/// Quaternions are x y z w there.
static void decode_rotation(const spz_job *job, uint32_t i) {
    const uint32_t bytes = ewa_spz_stream_bytes(job->header, EWA_SPZ_ROTATIONS);
    const uint8_t *from = job->streams[EWA_SPZ_ROTATIONS] + (size_t)i * bytes;
    float *rotation = job->set->rotations + 4 * (size_t)i, found[4];
    double others[3];
    uint32_t largest = 3;
    if (bytes == 3) {
        for (int k = 0; k < 3; k++) others[k] = from[k] / 127.5 - 1;
    } else {
        const uint32_t word = ewa_bytes_u32(from);
        largest = word >> 30;
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t part = word >> (20 - 10 * k);
            others[k] = (part & 511) / 511.0 * sqrt(0.5) * (part & 512 ? -1 : 1);
        }
    }
    ewa_quaternion_complete(others, largest, found);
    for (int k = 0; k < 4; k++) rotation[k] = found[(k + 3) % 4];
}

static void decode(void *data, uint32_t first, uint32_t end) {
    const spz_job *job = data;
    ewa_gaussians *set = job->set;
    const uint32_t rest = ewa_spz_stream_bytes(job->header, EWA_SPZ_HARMONICS);
    for (uint32_t i = first; i < end; i++) {
        float *harmonics = set->harmonics + (size_t)i * (rest + 3);
        decode_center(job, i);
        decode_rotation(job, i);
        for (uint32_t k = 0; k < 3; k++) {
            set->scales[3 * (size_t)i + k] =
                (float)(job->streams[EWA_SPZ_SCALES][3 * (size_t)i + k] / 16.0 - 10);
            harmonics[k] =
                (float)((job->streams[EWA_SPZ_COLORS][3 * (size_t)i + k] / 255.0 - 0.5) / EWA_SPZ_COLOR);
        }
        set->opacities[i] = (float)(job->streams[EWA_SPZ_OPACITIES][i] / 255.0);
        for (uint32_t k = 0; k < rest; k++)
            harmonics[3 + k] = (float)((job->streams[EWA_SPZ_HARMONICS][(size_t)i * rest + k] - 128) / 128.0);
    }
}

/// Turns the axes of a file, 0: the usual ones, to right, down, front. Errors: EWA_ERROR_UNSUPPORTED.
static ewa_status turn(const ewa_gaussian_source *source, uint32_t axes, ewa_gaussians *set,
                       ewa_gaussian_facts *facts) {
    if (axes > AXES_PLAIN)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: SPZ: axes of number %u; 1 to 8, whose second one is up or down, are read",
                        source->name, axes);
    const uint32_t bits = (axes ? axes : AXES_USUAL) - 1;
    ewa_gaussians_mirror(
        set, (const int[]){bits & AXES_RIGHT ? 1 : -1, bits & AXES_UP ? -1 : 1, bits & AXES_FRONT ? 1 : -1});
    facts->up_world[1] = -1;
    return EWA_OK;
}

static ewa_status read_spz(const ewa_gaussian_source *source, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    ewa_spz_header header;
    uint8_t *bytes;
    size_t size_bytes, at[EWA_SPZ_STREAMS];
    uint32_t axes;
    EWA_TRY(ewa_spz_unpack(source, &header, &axes, &bytes, &size_bytes, at));
    ewa_status status = ewa_gaussians_make(source, header.count, 0, 0, header.sh_degree, set);
    if (status == EWA_OK) {
        spz_job job = {.header = &header, .set = set};
        for (int k = 0; k < EWA_SPZ_STREAMS; k++) job.streams[k] = bytes + at[k];
        ewa_gaussians_decode(source->context, set->count, decode, &job);
        set->antialiased = header.flags & EWA_SPZ_ANTIALIASED;
        facts->version = header.version;
        status = ewa_gaussians_settle(source, &(ewa_gaussian_form){.log_scales = true}, set);
    }
    if (status == EWA_OK) status = turn(source, axes, set, facts);
    ewa_release(source->context, bytes, size_bytes, 1);
    return status;
}

/// Whether bytes are a gzip stream that begins as SPZ does.
static bool is_packed_spz(const ewa_gaussian_source *source, ewa_status *status) {
    if (source->size_bytes < 18 || source->bytes[0] != 0x1f || source->bytes[1] != 0x8b) return false;
    ewa_source *packed = NULL;
    uint8_t magic[4];
    size_t got = 0;
    ewa_failures_soften(source->context, true);
    ewa_status opened = ewa_source_open(source->context, source->name, EWA_PACKING_DEFLATE, source->bytes,
                                        source->size_bytes, &packed);
    if (opened == EWA_OK) opened = ewa_source_read(packed, magic, sizeof magic, &got);
    if (opened == EWA_ERROR_MEMORY) *status = opened;
    const bool found = opened == EWA_OK && got == sizeof magic && ewa_bytes_u32(magic) == EWA_SPZ_MAGIC;
    ewa_source_close(&packed);
    ewa_failures_soften(source->context, false);
    return found;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    return (source->size_bytes >= 4 && ewa_bytes_u32(source->bytes) == EWA_SPZ_MAGIC) ||
           is_packed_spz(source, status);
}

const ewa_gaussian_reader ewa_gaussians_spz = {EWA_GAUSSIANS_SPZ, probe, read_spz};
