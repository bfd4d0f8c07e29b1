// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as SOG of version 2: see sog.c for its pictures. Neighbours in space are neighbours in them, which packs better.
#include "cloud/morton.h"
#include "base/platform.h"
#include "io/gaussian/codebook.h"
#include "io/gaussian/save.h"
#include "io/gaussian/zip.h"
#include "io/image/webp.h"
#include "io/number.h"

#include <stdio.h>

enum { FIRST_TAG = 252, PALETTE_COLUMNS = 64, SOME_PALETTES = 1024, MAX_DEGREE = 3, TEXT_BYTES = 1 << 15, PATH_BYTES = 4096 };

/// The files, in the order of their writing; meta.json is the last.
enum { MEANS_LOW, MEANS_HIGH, SCALES, QUATERNIONS, COLORS, PALETTES, LABELS, META, FILES };
static const char *const names[FILES] = {"means_l.webp", "means_u.webp",       "scales.webp",      "quats.webp",
                                         "sh0.webp",     "shN_centroids.webp", "shN_labels.webp", "meta.json"};

typedef struct writing {
    const ewa_gaussian_target *target;
    const ewa_gaussians *set;
    ewa_context *context;
    uint32_t *order; ///< the Gaussian of each pixel
    uint32_t sh_degree, width_px, height_px;
    uint8_t *codes;  ///< of the picture that is being made, of `code_bytes` bytes
    size_t code_bytes;
    double low[3], high[3]; ///< of the logarithms of centres
    float scales[EWA_CODES], colors[EWA_CODES], harmonics[EWA_CODES];
    ewa_palettes palettes;
    bool archive;
    ewa_zip_target zip;
    ewa_writer *beside[FILES]; ///< open files beside meta.json, by their number
    char text[TEXT_BYTES];     ///< of meta.json
    size_t text_bytes;
} writing;

/// Puts one file into the archive, or beside meta.json; it gets its name when all are there.
static ewa_status put_file(writing *w, int file, const void *bytes, size_t size_bytes) {
    if (w->archive) return ewa_zip_put(&w->zip, names[file], bytes, size_bytes);
    if (file == META) return ewa_writer_put(w->target->writer, bytes, size_bytes);
    char path[PATH_BYTES];
    const int folder_bytes = (int)(ewa_platform_file_name(w->target->name) - w->target->name);
    if (snprintf(path, sizeof path, "%.*s%s", folder_bytes, w->target->name, names[file]) >= (int)sizeof path)
        return ewa_fail(w->context, EWA_ERROR_LIMIT, "%s: the path is longer than %d bytes", w->target->name, PATH_BYTES);
    EWA_TRY(ewa_writer_open(w->context, path, &w->beside[file]));
    return ewa_writer_put(w->beside[file], bytes, size_bytes);
}

/// Puts a picture of the codes.
static ewa_status put_picture(writing *w, int file, uint32_t width_px, uint32_t height_px, const uint8_t *codes) {
    ewa_webp webp;
    EWA_TRY(ewa_webp_encode_codes(w->context, w->target->name, width_px, height_px, codes, &webp));
    const ewa_status status = put_file(w, file, webp.bytes, webp.size_bytes);
    ewa_webp_free(&webp);
    return status;
}

/// The symmetric logarithm of a coordinate.
static double squeeze(const ewa_gaussians *set, size_t i, size_t axis) {
    const double world = set->origin[axis] + (double)set->centers[3 * i + axis];
    return world < 0 ? -log(1 - world) : log(1 + world);
}

static float take_scale(const void *data, size_t index) {
    const ewa_gaussians *set = data;
    const size_t axes = set->flat ? 2 : 3; // a third scale of 0 would leave few codes for the others
    return (float)ewa_log_scale_within(set->scales[3 * (index / axes) + index % axes]);
}
static float take_color(const void *data, size_t index) {
    const ewa_gaussians *set = data;
    return set->harmonics[index / 3 * 3 * ewa_sh_count(set->sh_degree) + index % 3];
}
static float take_palette(const void *data, size_t index) { return ((const ewa_palettes *)data)->numbers[index]; }

static ewa_status make_codes(writing *w) {
    const ewa_gaussians *set = w->set;
    for (size_t k = 0; k < 3; k++) {
        w->low[k] = INFINITY, w->high[k] = -INFINITY;
        for (size_t i = 0; i < set->count; i++) {
            const double at = squeeze(set, i, k);
            w->low[k] = fmin(w->low[k], at), w->high[k] = fmax(w->high[k], at);
        }
    }
    EWA_TRY(ewa_codebook_make(w->context, take_scale, set, (set->flat ? 2 : 3) * (size_t)set->count, w->scales));
    EWA_TRY(ewa_codebook_make(w->context, take_color, set, 3 * (size_t)set->count, w->colors));
    if (w->sh_degree == 0) return EWA_OK;
    uint32_t room = set->count < SOME_PALETTES ? set->count : SOME_PALETTES;
    while (room < EWA_MAX_PALETTES && room >= SOME_PALETTES && 2 * (uint64_t)room <= set->count) room *= 2;
    EWA_TRY(ewa_palettes_make(w->context, set->harmonics + 3, 3 * (size_t)ewa_sh_count(set->sh_degree), set->count,
                              3 * (ewa_sh_count(w->sh_degree) - 1), room, &w->palettes));
    return ewa_codebook_make(w->context, take_palette, &w->palettes, (size_t)w->palettes.count * w->palettes.size, w->harmonics);
}

static void encode_quaternion(const float q[4], uint8_t code[4]) {
    uint32_t largest = 0;
    for (uint32_t k = 1; k < 4; k++)
        if (fabsf(q[k]) > fabsf(q[largest])) largest = k;
    for (uint32_t k = 0; k < 4; k++)
        if (k != largest) *code++ = ewa_byte_of(127.5 * (1 + sqrt(2) * (q[largest] < 0 ? -(double)q[k] : (double)q[k])));
    *code = (uint8_t)(FIRST_TAG + largest);
}

/// The four bytes of a Gaussian in a picture.
static void encode(const writing *w, int file, size_t i, uint8_t code[4]) {
    const ewa_gaussians *set = w->set;
    code[3] = 255;
    if (file == QUATERNIONS) {
        encode_quaternion(set->rotations + 4 * i, code);
        return;
    }
    for (size_t k = 0; k < 3; k++) {
        if (file == SCALES) {
            code[k] = ewa_codebook_find(w->scales, (float)ewa_log_scale_within(set->scales[3 * i + k]));
        } else if (file == COLORS) {
            code[k] = ewa_codebook_find(w->colors, take_color(set, 3 * i + k));
        } else if (file == LABELS) {
            code[k] = (uint8_t)(k < 2 ? w->palettes.labels[i] >> 8 * k : 0);
        } else {
            const double wide = w->high[k] - w->low[k];
            const uint32_t steps = wide > 0 ? (uint32_t)floor((squeeze(set, i, k) - w->low[k]) / wide * 65535 + 0.5) : 0;
            code[k] = (uint8_t)(file == MEANS_LOW ? steps : steps >> 8);
        }
    }
    if (file == COLORS) code[3] = ewa_byte_of(255 * (double)set->opacities[i]);
}

/// The picture of palettes: 64 of them in each row.
static ewa_status put_palettes(writing *w) {
    const uint32_t coefficients = w->palettes.size / 3, width_px = PALETTE_COLUMNS * coefficients,
                   height_px = (w->palettes.count - 1) / PALETTE_COLUMNS + 1;
    const size_t pixels = (size_t)width_px * height_px;
    uint8_t *codes = ewa_allocate_zeroed(w->context, pixels, 4);
    if (!codes) return EWA_ERROR_MEMORY;
    for (size_t n = 0; n < (size_t)w->palettes.count * coefficients; n++) {
        for (size_t k = 0; k < 3; k++) codes[4 * n + k] = ewa_codebook_find(w->harmonics, w->palettes.numbers[3 * n + k]);
        codes[4 * n + 3] = 255;
    }
    const ewa_status status = put_picture(w, PALETTES, width_px, height_px, codes);
    ewa_release(w->context, codes, pixels, 4);
    return status;
}

static ewa_status put_pictures(writing *w) {
    const int last = w->sh_degree ? LABELS : COLORS;
    for (int file = 0; file <= last; file++) {
        if (file == PALETTES) {
            EWA_TRY(put_palettes(w));
            continue;
        }
        for (size_t n = 0; n < w->set->count; n++) encode(w, file, w->order[n], w->codes + 4 * n);
        EWA_TRY(put_picture(w, file, w->width_px, w->height_px, w->codes));
    }
    return EWA_OK;
}

static void say(writing *w, const char *text) {
    const size_t length = strlen(text);
    memcpy(w->text + w->text_bytes, text, length);
    w->text_bytes += length;
}

static void say_numbers(writing *w, const char *name, const float *floats, const double *doubles, uint32_t count) {
    say(w, "\"");
    say(w, name);
    say(w, "\":[");
    for (uint32_t k = 0; k < count; k++) {
        if (k) say(w, ",");
        char *to = w->text + w->text_bytes;
        w->text_bytes += floats ? ewa_number_write_f32(floats[k], to) : ewa_number_write_f64(doubles[k], to);
    }
    say(w, "],");
}

/// Appends the names of the files of a member, which end it.
static void say_files(writing *w, int first, int count) {
    say(w, "\"files\":[");
    for (int k = 0; k < count; k++) {
        say(w, k ? ",\"" : "\"");
        say(w, names[first + k]);
        say(w, "\"");
    }
    say(w, "]}");
}

static ewa_status put_meta(writing *w) {
    char number[96];
    snprintf(number, sizeof number, "{\"version\":2,\"count\":%u,", w->set->count);
    say(w, number);
    if (w->set->antialiased) say(w, "\"antialias\":true,");
    if (w->set->flat) say(w, "\"model\":\"2dgs\",");
    say(w, "\"means\":{");
    say_numbers(w, "mins", NULL, w->low, 3);
    say_numbers(w, "maxs", NULL, w->high, 3);
    say_files(w, MEANS_LOW, 2);
    say(w, ",\"scales\":{");
    say_numbers(w, "codebook", w->scales, NULL, EWA_CODES);
    say_files(w, SCALES, 1);
    say(w, ",\"quats\":{");
    say_files(w, QUATERNIONS, 1);
    say(w, ",\"sh0\":{");
    say_numbers(w, "codebook", w->colors, NULL, EWA_CODES);
    say_files(w, COLORS, 1);
    if (w->sh_degree) {
        snprintf(number, sizeof number, ",\"shN\":{\"count\":%u,\"bands\":%u,", w->palettes.count, w->sh_degree);
        say(w, number);
        say_numbers(w, "codebook", w->harmonics, NULL, EWA_CODES);
        say_files(w, PALETTES, 2);
    }
    say(w, "}");
    return put_file(w, META, w->text, w->text_bytes);
}

static ewa_status write_files(writing *w) {
    EWA_TRY(make_codes(w));
    EWA_TRY(put_pictures(w));
    EWA_TRY(put_meta(w));
    if (w->archive) return ewa_zip_finish(&w->zip);
    for (int file = 0; file < FILES; file++)
        if (w->beside[file]) EWA_TRY(ewa_writer_commit(&w->beside[file]));
    return EWA_OK;
}

/// Makes the room of pictures and the order of their pixels.
static ewa_status begin(writing *w) {
    const ewa_gaussians *set = w->set;
    const ewa_attribute position = {
        .data = set->centers, .type = EWA_F32, .component_count = 3, .stride_bytes = 3 * sizeof(float)};
    w->width_px = 4 * (uint32_t)ceil(sqrt((double)set->count) / 4);
    w->height_px = (set->count - 1) / w->width_px / 4 * 4 + 4;
    w->code_bytes = 4 * (size_t)w->width_px * w->height_px;
    w->codes = ewa_allocate_zeroed(w->context, w->code_bytes, 1);
    w->order = ewa_allocate(w->context, set->count, sizeof *w->order);
    if (!w->codes || !w->order) return EWA_ERROR_MEMORY;
    if (w->target->keep_order) {
        for (uint32_t i = 0; i < set->count; i++) w->order[i] = i;
        return EWA_OK;
    }
    return ewa_morton_order(w->context, &position, set->count, w->order, NULL, NULL);
}

ewa_status ewa_gaussians_write_sog(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    writing *w = ewa_allocate_zeroed(set->context, 1, sizeof *w);
    if (!w) return EWA_ERROR_MEMORY;
    w->target = target, w->set = set, w->context = set->context;
    w->sh_degree = target->sh_degree < MAX_DEGREE ? target->sh_degree : MAX_DEGREE;
    w->archive = strcmp(ewa_platform_file_name(target->name), names[META]) != 0;
    w->zip = (ewa_zip_target){.context = w->context, .name = target->name, .writer = target->writer};
    ewa_status status = begin(w);
    if (status == EWA_OK) status = write_files(w);
    for (int file = 0; file < FILES; file++) ewa_writer_abort(&w->beside[file]);
    ewa_palettes_free(w->context, &w->palettes);
    ewa_release(w->context, w->order, set->count, sizeof *w->order);
    ewa_release(w->context, w->codes, w->code_bytes, 1);
    ewa_release(w->context, w, 1, sizeof *w);
    if (status == EWA_OK && target->sh_degree > MAX_DEGREE)
        ewa_report(set->context, EWA_SEVERITY_WARNING, "%s: SOG has no room for harmonics of degree 4", target->name);
    return status;
}
