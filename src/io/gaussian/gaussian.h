// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the readers and writers of Gaussians share. A reader fills the streams with what its file holds; then one
// pass makes of that what ewa_gaussians says, and looks for numbers that cannot be.
#ifndef EWA_SRC_GAUSSIAN_IO_H
#define EWA_SRC_GAUSSIAN_IO_H

#include "base/base.h"
#include "ewa/gaussian_io.h"
#include "io/reader.h"

#include <math.h>
#include <string.h>

/// The first harmonic, constant: a colour is 0.5 + this times the first coefficients.
#define EWA_SH_CONSTANT 0.28209479177387814

/// A file that is read and where messages about it go.
typedef struct ewa_gaussian_source {
    ewa_context *context;
    const char *name;     ///< stands for the file in messages
    const char *path;     ///< of the file, for formats that name others beside it; NULL: there is none
    const uint8_t *bytes; ///< of the whole file
    size_t size_bytes;
} ewa_gaussian_source;

/// One format that is read.
typedef struct ewa_gaussian_reader {
    ewa_gaussian_format format;

    /// Whether the bytes are of this format.
    bool (*probe)(const ewa_gaussian_source *source, ewa_status *status);

    /// Makes and fills the set; `facts` has the format and the size already. The set is freed by the caller, also
    /// after a failure. Numbers are checked by the caller (ewa_gaussians_settle()).
    ewa_status (*read)(const ewa_gaussian_source *source, ewa_gaussians *gaussians,
                       ewa_gaussian_facts *facts);
} ewa_gaussian_reader;

/// The formats, in the order in which they are asked. Each lives in a file of its own.
extern const ewa_gaussian_reader ewa_gaussians_ply, ewa_gaussians_packed_ply, ewa_gaussians_spz,
    ewa_gaussians_splat, ewa_gaussians_ksplat, ewa_gaussians_gltf, ewa_gaussians_sog, ewa_gaussians_sog_streamed;

/// Whether a file is a JSON object that has some words in quotes (sog.c).
bool ewa_gaussian_text_has(const ewa_gaussian_source *source, const char *const *words, uint32_t count);

/// Makes a set for `count` Gaussians that the file says it has, of which each takes `min_bytes` of the
/// `left_bytes` that are there. Errors: EWA_ERROR_FORMAT (there are fewer bytes, or no Gaussians),
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_gaussians_make(const ewa_gaussian_source *source, uint64_t count, uint64_t min_bytes,
                              uint64_t left_bytes, uint32_t sh_degree, ewa_gaussians *gaussians);

/// Decodes Gaussians [first, end) of a file into a set; any thread.
typedef void ewa_gaussian_decode(void *data, uint32_t first, uint32_t end);

/// Has all Gaussians decoded, on all workers.
void ewa_gaussians_decode(ewa_context *context, uint32_t count, ewa_gaussian_decode *decode, void *data);

/// Coefficients of each colour.
static inline uint32_t ewa_sh_count(uint32_t sh_degree) { return (sh_degree + 1) * (sh_degree + 1); }

/// How the streams of a set hold what they mean.
typedef struct ewa_gaussian_form {
    bool log_scales;     ///< scales are logarithms
    bool logits;         ///< opacities are logits
    const float *filter; ///< of Mip-Splatting: one standard deviation per Gaussian; NULL: none
    uint64_t first, whole; ///< of a piece: number of its first Gaussian, and how many there are; 0, 0: it is all
} ewa_gaussian_form;

/// Makes scales, opacities and unit quaternions of what was read, and checks every number. Errors:
/// EWA_ERROR_FORMAT, with the first Gaussian that is wrong.
ewa_status ewa_gaussians_settle(const ewa_gaussian_source *source, const ewa_gaussian_form *form,
                                ewa_gaussians *gaussians);

/// The coefficient of the constant harmonic that gives a colour in [0, 1].
static inline float ewa_sh_of_color(double color) { return (float)((color - 0.5) / EWA_SH_CONSTANT); }

/// Fills a unit quaternion w x y z whose component `largest` was left out, which is >= 0, from the three others
/// in their order.
void ewa_quaternion_complete(const double others[3], uint32_t largest, float rotation[4]);

/// Numbers of files, lowest byte first.
static inline uint32_t ewa_file_u16(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
}
static inline float ewa_file_f32(const uint8_t *bytes) {
    const uint32_t bits = ewa_bytes_u32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// A half float.
static inline float ewa_file_f16(const uint8_t *bytes) {
    const uint32_t bits = ewa_file_u16(bytes), exponent = bits >> 10 & 31, mantissa = bits & 1023;
    float value;
    if (exponent == 31)
        value = mantissa ? NAN : INFINITY;
    else
        value =
            exponent ? ldexpf((float)(1024 + mantissa), (int)exponent - 25) : ldexpf((float)mantissa, -24);
    return bits >> 15 ? -value : value;
}

/// What is multiplied with the numbers of a Gaussian when axes are turned to their other end.
enum { EWA_SH_ROOM = (EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1) };
typedef struct ewa_gaussian_signs {
    float center[3], rotation[3]; ///< of x y z of the quaternion
    float harmonics[EWA_SH_ROOM];
} ewa_gaussian_signs;

/// Fills the signs of a half turn about x, which leads from the right-down-front of 3DGS to right-up-back, and back.
void ewa_gaussian_signs_turn(ewa_gaussian_signs *signs);

/// Turns a set so.
void ewa_gaussians_turn(ewa_gaussians *gaussians);

/// Turns the axes k to their other end whose sign[k] is -1; the others are 1.
void ewa_gaussians_mirror(ewa_gaussians *gaussians, const int sign[3]);

/// Makes 2D Gaussians of a set that is said to hold such, whatever its third scales.
void ewa_gaussians_flatten(ewa_gaussians *gaussians);

/// Gives centres in doubles, 3 per Gaussian, an origin amid them and makes floats of them.
void ewa_gaussians_place(const double *centers_world, ewa_gaussians *gaussians);

#endif
