// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small files of Gaussians in every form, made by hand, and what they hold.
#ifndef EWA_TESTS_GAUSSIAN_SAMPLE_H
#define EWA_TESTS_GAUSSIAN_SAMPLE_H

#include "check.h"

#include <libdeflate.h>
#include <math.h>
#include <webp/encode.h>
#include <zstd.h>

enum { SAMPLE_COUNT = 3, SAMPLE_ROOM = 1 << 16 };

/// A file under construction.
typedef struct sample_file {
    uint8_t bytes[SAMPLE_ROOM];
    size_t size;
} sample_file;

static inline void sample_put(sample_file *file, const void *bytes, size_t size) {
    assert_true(file->size + size <= SAMPLE_ROOM);
    memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}
static inline void sample_text(sample_file *file, const char *text) { sample_put(file, text, strlen(text)); }
static inline void sample_u8(sample_file *file, unsigned value) {
    const uint8_t byte = (uint8_t)value;
    sample_put(file, &byte, 1);
}
static inline void sample_u16(sample_file *file, unsigned value) {
    sample_u8(file, value & 255);
    sample_u8(file, value >> 8 & 255);
}
static inline void sample_u32(sample_file *file, uint32_t value) {
    sample_u16(file, value & 65535);
    sample_u16(file, value >> 16);
}
static inline void sample_f32(sample_file *file, double value) {
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    sample_u32(file, bits);
}
static inline void sample_zeros(sample_file *file, size_t count) {
    for (size_t i = 0; i < count; i++) sample_u8(file, 0);
}

/// The half float of a number that has one.
static inline unsigned sample_half(double value) {
    int exponent;
    const double fraction = frexp(fabs(value), &exponent);
    if (value == 0) return 0;
    return (value < 0 ? 0x8000u : 0) | (unsigned)(exponent + 14) << 10 | ((unsigned)(fraction * 2048) & 1023);
}

// What the samples hold, as far as their form can say it: centres (1, -2, 0.5) * (i + 1), scales 2^-i, 2^-(i + 1), 1,
// a turn about axis i by 90 degrees, opacity (i + 1) / 4, the colours' first coefficients as near (i - 1) / 2 as can be,
// the others k / 32 for number k of red, less for green and blue.
static inline double sample_center(uint32_t i, uint32_t k) {
    return (k == 0 ? 1 : k == 1 ? -2 : 0.5) * (i + 1);
}
static inline double sample_scale(uint32_t i, uint32_t k) { return k == 2 ? 1 : ldexp(1, -(int)(i + k)); }
static inline double sample_turn(uint32_t i, uint32_t k) { return k == 0 || k == i + 1 ? sqrt(0.5) : 0; }
static inline double sample_opacity(uint32_t i) { return (i + 1) / 4.0; }
static inline double sample_first(uint32_t i) { return ((double)i - 1) / 2; }
static inline double sample_rest(uint32_t k, uint32_t color) { return k / 32.0 - color / 8.0; }

/// Checks that a set holds the sample, to the given accuracies.
typedef struct sample_limits {
    double center, scale, turn, opacity, first, rest;
} sample_limits;

static inline void sample_near(const char *what, uint32_t i, float value, double wanted, double limit) {
    if (!(fabs((double)value - wanted) <= limit))
        fail_msg("%s of %u: %.9g is not %.9g within %g", what, i, (double)value, wanted, limit);
}

static inline void sample_check(const ewa_gaussians *set, uint32_t sh_degree, const sample_limits *limits) {
    assert_int_equal(set->count, SAMPLE_COUNT);
    assert_int_equal(set->sh_degree, sh_degree);
    const uint32_t coefficients = (sh_degree + 1) * (sh_degree + 1);
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        double turn = 0; // a quaternion and its negative are the same turn
        for (uint32_t k = 0; k < 4; k++) turn += (double)set->rotations[4 * i + k] * sample_turn(i, k);
        sample_near("turn", i, (float)fabs(turn), 1, limits->turn);
        for (uint32_t k = 0; k < 3; k++) {
            sample_near("centre", i, set->centers[3 * i + k], sample_center(i, k) - set->origin[k],
                        limits->center);
            sample_near("scale", i, set->scales[3 * i + k], set->flat && k == 2 ? 0 : sample_scale(i, k),
                        limits->scale * sample_scale(i, k));
            sample_near("colour", i, set->harmonics[3 * i * coefficients + k], sample_first(i),
                        limits->first);
            for (uint32_t n = 1; n < coefficients; n++)
                sample_near("harmonic", i, set->harmonics[3 * (i * coefficients + n) + k], sample_rest(n, k),
                            limits->rest);
        }
        sample_near("opacity", i, set->opacities[i], sample_opacity(i), limits->opacity);
    }
}

/// Turns y and z of a set to their other end, by signs written out: of x, yz, and of harmonics of degree 1 to 4 from the
/// lowest order on.
static inline void sample_turn_over(ewa_gaussians *set) {
    static const char signs[] = "+--+-++-+-+--+-+-+-++-+-+";
    const uint32_t coefficients = (set->sh_degree + 1) * (set->sh_degree + 1);
    for (uint32_t i = 0; i < set->count; i++) {
        for (uint32_t k = 1; k < 3; k++) {
            set->centers[3 * i + k] = -set->centers[3 * i + k];
            set->rotations[4 * i + 1 + k] = -set->rotations[4 * i + 1 + k];
        }
        for (uint32_t n = 0; n < coefficients; n++)
            for (uint32_t k = 0; k < 3; k++)
                if (signs[n] == '-')
                    set->harmonics[3 * (i * coefficients + n) + k] =
                        -set->harmonics[3 * (i * coefficients + n) + k];
    }
}

/// A byte for a share of 255.
static inline unsigned sample_byte(double value) { return (unsigned)floor(fmin(fmax(value, 0), 255) + 0.5); }
static inline unsigned sample_color_byte(uint32_t i) {
    return sample_byte(255 * (0.5 + 0.28209479177387814 * sample_first(i)));
}

/// Three of four components as integers: `steps` for the half of sqrt 2, moved by `zero`; w comes first.
static inline uint32_t sample_packed_turn(uint32_t i, double steps, double zero, bool sign_bits) {
    uint32_t word = 0, largest = 0; // w is as large as any
    word = largest;
    for (uint32_t k = 1; k < 4; k++) {
        const double part = sample_turn(i, k) * sqrt(2);
        word = word << 10 |
               (sign_bits ? (uint32_t)floor(part * steps + 0.5) : (uint32_t)floor(zero + part * steps + 0.5));
    }
    return word;
}

// ---- PlayCanvas's compressed PLY

static inline void sample_packed_ply(sample_file *file, bool colors, bool rest) {
    static const char *const names[] = {"x", "y", "z", "scale_x", "scale_y", "scale_z", "r", "g", "b"};
    file->size = 0;
    sample_text(file, "ply\nformat binary_little_endian 1.0\nelement chunk 1\n");
    const uint32_t groups = colors ? 3 : 2;
    char line[64];
    for (uint32_t g = 0; g < groups; g++)
        for (int end = 0; end < 2; end++)
            for (uint32_t k = 0; k < 3; k++) {
                snprintf(line, sizeof line, "property float %s_%s\n", end ? "max" : "min", names[3 * g + k]);
                sample_text(file, line);
            }
    sample_text(file, "element vertex 3\nproperty uint packed_position\nproperty uint packed_rotation\n"
                      "property uint packed_scale\nproperty uint packed_color\n");
    if (rest) {
        sample_text(file, "element sh 3\n");
        for (int k = 0; k < 9; k++) {
            snprintf(line, sizeof line, "property uchar f_rest_%d\n", k);
            sample_text(file, line);
        }
    }
    sample_text(file, "end_header\n");
    // Bounds of the centres, of the scales' logarithms, of colours.
    const double bounds[18] = {0, -8, 0, 4, 0, 2, -4, -4, -4, 0, 0, 0, -1, -1, -1, 2, 2, 2};
    for (uint32_t k = 0; k < 6 * groups; k++) sample_f32(file, bounds[k]);
    static const uint32_t bits[3] = {11, 10, 11};
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        uint32_t center = 0, scale = 0, color = 0;
        for (uint32_t k = 0; k < 3; k++) {
            const double maximum = (double)((1u << bits[k]) - 1);
            center = center << bits[k] |
                     (uint32_t)floor(
                         maximum * (sample_center(i, k) - bounds[k]) / (bounds[3 + k] - bounds[k]) + 0.5);
            scale = scale << bits[k] | (uint32_t)floor(maximum * (log(sample_scale(i, k)) + 4) / 4 + 0.5);
            const double shown = 0.5 + 0.28209479177387814 * sample_first(i);
            color = color << 8 | sample_byte(255 * (colors ? (shown + 1) / 3 : shown));
        }
        sample_u32(file, center);
        sample_u32(file, sample_packed_turn(i, 511.5, 511.5, false));
        sample_u32(file, scale);
        sample_u32(file, color << 8 | sample_byte(255 * sample_opacity(i)));
    }
    for (uint32_t i = 0; i < SAMPLE_COUNT && rest; i++)
        for (uint32_t k = 0; k < 9; k++)
            sample_u8(file, sample_byte(256 * (sample_rest(1 + k % 3, k / 3) / 8 + 0.5) - 0.5));
}

// ---- .splat

static inline void sample_splat(sample_file *file) {
    file->size = 0;
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        for (uint32_t k = 0; k < 3; k++) sample_f32(file, sample_center(i, k));
        for (uint32_t k = 0; k < 3; k++) sample_f32(file, sample_scale(i, k));
        for (uint32_t k = 0; k < 3; k++) sample_u8(file, sample_color_byte(i));
        sample_u8(file, sample_byte(255 * sample_opacity(i)));
        for (uint32_t k = 0; k < 4; k++) sample_u8(file, sample_byte(128 + 128 * sample_turn(i, k)));
    }
}

// ---- SPZ

static inline void sample_gzip(sample_file *file) {
    static uint8_t packed[SAMPLE_ROOM];
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
    const size_t size = libdeflate_gzip_compress(compressor, file->bytes, file->size, packed, sizeof packed);
    libdeflate_free_compressor(compressor);
    assert_true(size > 0);
    file->size = 0;
    sample_put(file, packed, size);
}

/// Stream `k` of a version, in the order of the file.
static inline void sample_spz_stream(sample_file *file, uint32_t version, uint32_t sh_degree, int k) {
    const uint32_t coefficients = (sh_degree + 1) * (sh_degree + 1);
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        if (k == 1) sample_u8(file, sample_byte(255 * sample_opacity(i)));
        for (uint32_t c = 0; c < 3; c++) {
            const uint32_t fixed = (uint32_t)(int32_t)floor(sample_center(i, c) * 4096 + 0.5);
            if (k == 0 && version == 1) sample_u16(file, sample_half(sample_center(i, c)));
            if (k == 0 && version > 1) {
                sample_u16(file, fixed & 65535);
                sample_u8(file, fixed >> 16 & 255);
            }
            if (k == 2) sample_u8(file, sample_byte(255 * (0.5 + 0.15 * sample_first(i))));
            if (k == 3) sample_u8(file, sample_byte(16 * (log(sample_scale(i, c)) + 10)));
            if (k == 4 && version < 3) sample_u8(file, sample_byte(127.5 + 127.5 * sample_turn(i, c + 1)));
        }
        // x y z w: of two that are equal, w is left out.
        if (k == 4 && version >= 3) sample_u32(file, sample_packed_turn(i, 511, 0, true) | 3u << 30);
        if (k == 5)
            for (uint32_t n = 1; n < coefficients; n++)
                for (uint32_t c = 0; c < 3; c++) sample_u8(file, sample_byte(128 + 128 * sample_rest(n, c)));
    }
}

static inline void sample_spz(sample_file *file, uint32_t version, uint32_t sh_degree) {
    file->size = 0;
    const uint32_t streams = sh_degree ? 6 : 5;
    sample_text(file, "NGSP");
    sample_u32(file, version);
    sample_u32(file, SAMPLE_COUNT);
    sample_u8(file, sh_degree);
    sample_u8(file, 12);
    sample_u8(file, 1); // antialiased
    sample_u8(file, version >= 4 ? streams : 0);
    if (version < 4) {
        for (int k = 0; k < 6; k++) sample_spz_stream(file, version, sh_degree, k);
        sample_gzip(file);
        return;
    }
    static sample_file stream, packed;
    sample_u32(file, 32);
    sample_zeros(file, 12);
    packed.size = 0;
    for (uint32_t k = 0; k < streams; k++) {
        stream.size = 0;
        sample_spz_stream(&stream, version, sh_degree, (int)k);
        const size_t size = ZSTD_compress(packed.bytes + packed.size, SAMPLE_ROOM - packed.size, stream.bytes,
                                          stream.size, 3);
        assert_false(ZSTD_isError(size));
        sample_u32(file, (uint32_t)size);
        sample_u32(file, 0);
        sample_u32(file, (uint32_t)stream.size);
        sample_u32(file, 0);
        packed.size += size;
    }
    sample_put(file, packed.bytes, packed.size);
}

// ---- .ksplat

static inline void sample_ksplat(sample_file *file, uint32_t level, uint32_t sh_degree) {
    static const uint32_t orders[3][2] = {{1, 4}, {4, 9}, {9, 16}};
    file->size = 0;
    sample_u8(file, 0);
    sample_u8(file, 1);
    sample_u16(file, 0);
    sample_u32(file, 1);
    sample_zeros(file, 8);
    sample_u32(file, SAMPLE_COUNT);
    sample_u16(file, level);
    sample_zeros(file, 14);
    sample_f32(file, -2);
    sample_f32(file, 2);
    sample_zeros(file, 4096 - file->size);
    // One section; the first two Gaussians fill a bucket, the third is in one of its own.
    sample_u32(file, SAMPLE_COUNT);
    sample_u32(file, SAMPLE_COUNT);
    sample_u32(file, 2);
    sample_u32(file, 2);
    sample_f32(file, 16);
    sample_u16(file, 12);
    sample_u16(file, 0);
    sample_u32(file, 32767);
    sample_u32(file, 0);
    sample_u32(file, 1);
    sample_u32(file, 1);
    sample_u16(file, sh_degree);
    sample_zeros(file, 4096 + 1024 - file->size);
    sample_u32(file, 1); // size of the last bucket
    for (uint32_t k = 0; k < 6; k++) sample_f32(file, k < 3 ? 1 : 2);
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        const double middle = i < 2 ? 1 : 2;
        for (uint32_t k = 0; k < 3; k++)
            if (level == 0)
                sample_f32(file, sample_center(i, k));
            else
                sample_u16(file, (unsigned)floor((sample_center(i, k) - middle) / 8 * 32767 + 32767.5));
        for (uint32_t k = 0; k < 7; k++) {
            const double value = k < 3 ? sample_scale(i, k) : sample_turn(i, k - 3);
            if (level == 0)
                sample_f32(file, value);
            else
                sample_u16(file, sample_half(value));
        }
        for (uint32_t k = 0; k < 3; k++) sample_u8(file, sample_color_byte(i));
        sample_u8(file, sample_byte(255 * sample_opacity(i)));
        for (uint32_t degree = 0; degree < sh_degree; degree++)
            for (uint32_t color = 0; color < 3; color++)
                for (uint32_t n = orders[degree][0]; n < orders[degree][1]; n++) {
                    const double value = sample_rest(n, color);
                    if (level == 0) sample_f32(file, value);
                    if (level == 1) sample_u16(file, sample_half(value));
                    if (level == 2) sample_u8(file, sample_byte((value + 2) / 4 * 255));
                }
    }
}

// ---- glTF

/// A .glb with one node of the given members (such as "\"scale\":[2,2,2],"); `prefix` of the attributes.
static inline void sample_glb(sample_file *file, uint32_t sh_degree, const char *node, const char *prefix) {
    static char json[1 << 14];
    static sample_file body;
    size_t at = 0;
    uint32_t views = 0;
    char attributes[4096] = "", accessors[8192] = "";
    body.size = 0;
    const uint32_t coefficients = (sh_degree + 1) * (sh_degree + 1);
    for (uint32_t a = 0; a < 4 + coefficients; a++) {
        static const char *const names[] = {"POSITION", "ROTATION", "SCALE", "OPACITY"};
        static const uint32_t sizes[] = {3, 4, 3, 1};
        const uint32_t size = a < 4 ? sizes[a] : 3;
        char name[80];
        uint32_t degree = 0;
        while (a >= 4 && (degree + 1) * (degree + 1) <= a - 4) degree++;
        if (a < 4)
            snprintf(name, sizeof name, "%s%s", a ? prefix : "", names[a]);
        else
            snprintf(name, sizeof name, "%sSH_DEGREE_%u_COEF_%u", prefix, degree, a - 4 - degree * degree);
        snprintf(attributes + strlen(attributes), sizeof attributes - strlen(attributes), "%s\"%s\":%u",
                 a ? "," : "", name, a);
        snprintf(accessors + strlen(accessors), sizeof accessors - strlen(accessors),
                 "%s{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":5126,\"count\":3,\"type\":\"%s\"}",
                 a ? "," : "", body.size,
                 size == 1   ? "SCALAR"
                 : size == 3 ? "VEC3"
                             : "VEC4");
        for (uint32_t i = 0; i < SAMPLE_COUNT; i++)
            for (uint32_t k = 0; k < size; k++)
                sample_f32(&body, a == 0   ? sample_center(i, k)
                                  : a == 1 ? sample_turn(i, (k + 1) % 4)
                                  : a == 2 ? sample_scale(i, k)
                                  : a == 3 ? sample_opacity(i)
                                  : a == 4 ? sample_first(i)
                                           : sample_rest(a - 4, k));
        views = a + 1;
    }
    (void)views;
    at = (size_t)snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_gaussian_splatting\"],\"scene\":0,"
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{%s\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"mode\":0,"
        "\"attributes\":{%s},\"extensions\":{\"KHR_gaussian_splatting\":{\"kernel\":\"ellipse\","
        "\"colorSpace\":"
        "\"srgb_rec709_display\"}}}]}],\"accessors\":[%s],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}]"
        ","
        "\"buffers\":[{\"byteLength\":%zu}]}",
        node, attributes, accessors, body.size, body.size);
    while (at % 4) json[at++] = ' ';
    file->size = 0;
    sample_text(file, "glTF");
    sample_u32(file, 2);
    sample_u32(file, (uint32_t)(28 + at + body.size));
    sample_u32(file, (uint32_t)at);
    sample_text(file, "JSON");
    sample_put(file, json, at);
    sample_u32(file, (uint32_t)body.size);
    sample_put(file, "BIN", 4);
    sample_put(file, body.bytes, body.size);
}

// ---- SOG

/// Pictures of SOG, four bytes per Gaussian; their names.
enum { SAMPLE_PICTURES = 7 };
static const char *const sample_picture_names[SAMPLE_PICTURES] = {
    "means_l.webp", "means_u.webp",       "scales.webp",    "quats.webp",
    "sh0.webp",     "shN_centroids.webp", "shN_labels.webp"};

/// A byte of 255 even steps from `low` to `high`, as version 1 of SOG has them.
static inline uint8_t sample_step(double value, double low, double high) {
    return (uint8_t)sample_byte(255 * (value - low) / (high - low));
}

static inline size_t sample_sog_picture(int picture, bool steps, uint8_t **webp) {
    static uint8_t codes[4 * 64 * 3];
    memset(codes, 0, sizeof codes);
    const int width = picture == 5 ? 64 * 3 : SAMPLE_COUNT;
    for (uint32_t i = 0; i < SAMPLE_COUNT && picture != 5; i++)
        for (uint32_t k = 0; k < 4; k++) {
            const double center = k < 3 ? sample_center(i, k) : 0;
            const double place = ((center < 0 ? -1 : 1) * log(1 + fabs(center)) + 4) / 8 * 65535;
            const unsigned whole = (unsigned)floor(place + 0.5);
            codes[4 * i + k] =
                (uint8_t)(picture == 0   ? whole & 255
                          : picture == 1 ? whole >> 8
                          : picture == 2 ? (k < 3 ? 16 * (i + 1) + k : 255)
                          : picture == 3
                              ? (k < 3 ? sample_byte((sample_turn(i, k + 1) * sqrt(2) + 1) / 2 * 255) : 252)
                          : picture == 4 ? (k < 3 ? 7 + i : sample_byte(255 * sample_opacity(i)))
                                         : (k == 0   ? 1
                                            : k == 3 ? 255
                                                     : 0));
        }
    for (uint32_t i = 0; i < SAMPLE_COUNT && steps; i++) {
        const double logit = log(sample_opacity(i) / (1 - sample_opacity(i)));
        for (uint32_t k = 0; k < 3 && picture == 2; k++) codes[4 * i + k] = sample_step(log(sample_scale(i, k)), -3, 1);
        for (uint32_t k = 0; k < 4 && picture == 4; k++)
            codes[4 * i + k] = k < 3 ? sample_step(sample_first(i), -1, 1) : sample_step(logit, -2, 2);
    }
    // Palette 1: the harmonics of the sample.
    for (uint32_t n = 0; n < 3 && picture == 5; n++)
        for (uint32_t k = 0; k < 4; k++)
            codes[4 * (3 + n) + k] = k == 3  ? 255
                                     : steps ? sample_step(sample_rest(n + 1, k), -0.25, 0.25)
                                             : (uint8_t)(10 * (n + 1) + k);
    if (picture < 2)
        for (uint32_t i = 0; i < SAMPLE_COUNT; i++) codes[4 * i + 3] = 255;
    return WebPEncodeLosslessRGBA(codes, width, 1, 4 * width, webp);
}

/// meta.json; the table of scales has logarithms at 16 (i + 1) + k, that of colours at 7 + i, of harmonics at
/// 10 n + k.
static inline void sample_sog_meta(sample_file *file, const char *version) {
    char number[32];
    double scales[256] = {0}, colors[256] = {0}, harmonics[256] = {0};
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        for (uint32_t k = 0; k < 3; k++) scales[16 * (i + 1) + k] = log(sample_scale(i, k));
        colors[7 + i] = sample_first(i);
    }
    for (uint32_t n = 1; n < 4; n++)
        for (uint32_t k = 0; k < 3; k++) harmonics[10 * n + k] = sample_rest(n, k);
    const struct {
        const char *name;
        const double *table;
        const char *files;
    } members[] = {{"scales", scales, "\"scales.webp\""},
                   {"sh0", colors, "\"sh0.webp\""},
                   {"shN", harmonics, "\"shN_centroids.webp\",\"shN_labels.webp\""}};
    file->size = 0;
    sample_text(file, "{\"version\":");
    sample_text(file, version);
    sample_text(file,
                ",\"count\":3,\"antialias\":true,\"means\":{\"mins\":[-4,-4,-4],\"maxs\":[4,4,4],"
                "\"files\":[\"means_l.webp\",\"means_u.webp\"]},\"quats\":{\"files\":[\"quats.webp\"]}");
    for (int m = 0; m < 3; m++) {
        sample_text(file, ",\"");
        sample_text(file, members[m].name);
        sample_text(file, m == 2 ? "\":{\"count\":64,\"bands\":1,\"codebook\":[" : "\":{\"codebook\":[");
        for (int t = 0; t < 256; t++) {
            snprintf(number, sizeof number, "%s%.9g", t ? "," : "", members[m].table[t]);
            sample_text(file, number);
        }
        sample_text(file, "],\"files\":[");
        sample_text(file, members[m].files);
        sample_text(file, "]}");
    }
    sample_text(file, "}");
}

/// Adds a file to an archive: deflated when asked for.
static inline void sample_zip_add(sample_file *file, sample_file *directory, const char *name,
                                  const uint8_t *bytes, size_t size, bool deflated) {
    static uint8_t packed[SAMPLE_ROOM];
    size_t packed_size = size;
    if (deflated) {
        struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
        packed_size = libdeflate_deflate_compress(compressor, bytes, size, packed, sizeof packed);
        libdeflate_free_compressor(compressor);
        bytes = packed;
    }
    const uint32_t at = (uint32_t)file->size;
    sample_put(file, "PK\3\4", 4);
    sample_put(directory, "PK\1\2", 4);
    sample_u16(directory, 20);
    sample_file *const both[] = {file, directory};
    for (int k = 0; k < 2; k++) {
        sample_u16(both[k], 20);
        sample_u16(both[k], 0);
        sample_u16(both[k], deflated ? 8 : 0);
        sample_u32(both[k], 0);
        sample_u32(both[k], 0);
        sample_u32(both[k], (uint32_t)packed_size);
        sample_u32(both[k], (uint32_t)size);
        sample_u16(both[k], (unsigned)strlen(name));
        sample_u16(both[k], 0);
    }
    sample_zeros(directory, 10);
    sample_u32(directory, at);
    sample_text(file, name);
    sample_text(directory, name);
    sample_put(file, bytes, packed_size);
}

/// meta.json of version 1, which does not say so.
static inline void sample_sog_meta_1(sample_file *file) {
    file->size = 0;
    sample_text(file, "{\"means\":{\"shape\":[3,3],\"dtype\":\"float32\",\"mins\":[-4,-4,-4],\"maxs\":[4,4,4],"
                      "\"files\":[\"means_l.webp\",\"means_u.webp\"]},"
                      "\"scales\":{\"shape\":[3,3],\"mins\":[-3,-3,-3],\"maxs\":[1,1,1],\"files\":[\"scales.webp\"]},"
                      "\"quats\":{\"encoding\":\"quaternion_packed\",\"files\":[\"quats.webp\"]},"
                      "\"sh0\":{\"mins\":[-1,-1,-1,-2],\"maxs\":[1,1,1,2],\"files\":[\"sh0.webp\"]},"
                      "\"shN\":{\"shape\":[3,9],\"mins\":-0.25,\"maxs\":0.25,\"quantization\":8,"
                      "\"files\":[\"shN_centroids.webp\",\"shN_labels.webp\"]}}");
}

/// An archive of a version; NULL: version 1.
static inline void sample_sog(sample_file *file, const char *version) {
    static sample_file directory, meta;
    file->size = directory.size = 0;
    for (int picture = 0; picture < SAMPLE_PICTURES; picture++) {
        uint8_t *webp = NULL;
        const size_t size = sample_sog_picture(picture, !version, &webp);
        assert_true(size > 0);
        sample_zip_add(file, &directory, sample_picture_names[picture], webp, size, false);
        WebPFree(webp);
    }
    if (version)
        sample_sog_meta(&meta, version);
    else
        sample_sog_meta_1(&meta);
    sample_zip_add(file, &directory, "meta.json", meta.bytes, meta.size, true);
    const uint32_t at = (uint32_t)file->size;
    sample_put(file, directory.bytes, directory.size);
    sample_put(file, "PK\5\6", 4);
    sample_u32(file, 0);
    sample_u16(file, SAMPLE_PICTURES + 1);
    sample_u16(file, SAMPLE_PICTURES + 1);
    sample_u32(file, (uint32_t)directory.size);
    sample_u32(file, at);
    sample_u16(file, 0);
}

/// All forms, by number; false beyond the last. `*degree` and `*limits`: what they hold.
static inline bool sample_make(int number, sample_file *file, uint32_t *degree, sample_limits *limits) {
    static const sample_limits packed = {2e-2, 2e-3, 1e-5, 2e-3, 3e-2, 2e-2},
                               exact = {1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6},
                               splat = {1e-6, 1e-6, 2e-4, 2e-3, 1e-2, 1e-2},
                               spz = {1e-3, 4e-2, 2e-4, 2e-3, 2e-2, 1e-2},
                               ksplat = {1e-3, 1e-3, 2e-6, 2e-3, 1e-2, 1e-2},
                               sog = {2e-3, 1e-6, 2e-5, 2e-3, 1e-6, 1e-6},
                               sog_1 = {2e-3, 1e-2, 2e-5, 4e-3, 5e-3, 2e-3};
    *degree = 0;
    if (number < 4) {
        sample_packed_ply(file, number % 2, number / 2);
        *degree = number / 2 ? 1 : 0;
        *limits = packed;
    } else if (number == 4) {
        sample_splat(file);
        *limits = splat;
    } else if (number < 9) {
        *degree = (uint32_t)number - 5;
        sample_spz(file, (uint32_t)number - 4, *degree);
        *limits = spz;
    } else if (number < 12) {
        *degree = (uint32_t)number - 9;
        sample_ksplat(file, (uint32_t)number - 9, *degree);
        *limits = ksplat;
    } else if (number < 16) {
        *degree = (uint32_t)number - 12;
        sample_glb(file, *degree, "", number == 12 ? "_" : "KHR_gaussian_splatting:");
        *limits = exact;
    } else {
        *degree = 1;
        sample_sog(file, number == 16 ? "2" : NULL);
        *limits = number == 16 ? sog : sog_1;
    }
    return number <= 17;
}

#endif
