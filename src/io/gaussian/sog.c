// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// SOG: a Gaussian for each pixel of some lossless WebP pictures, which meta.json names, in a zip archive or beside it.
// Centres are 16 bits of a symmetric logarithm, scales and colours indices into tables of numbers, quaternions their
// three smallest components; harmonics beyond the first an index into a picture of palettes.
//
// Based on: PlayCanvas, "SOG format", version 2.
#include "io/gaussian/zip.h"
#include "io/image/webp.h"
#include "io/json_text.h"
#include "io/referenced_file.h"
#include "math/gaussian.h"

#include <stdatomic.h>
#include <stdio.h>

enum { TABLE = 256, FIRST_TAG = 252, PALETTE_COLUMNS = 64, MAX_BANDS = 3 };

/// The pictures.
enum { MEANS_LOW, MEANS_HIGH, SCALES, QUATERNIONS, COLORS, PALETTES, LABELS, PICTURES };

typedef struct sog_picture {
    uint32_t width_px, height_px;
    uint8_t *codes; ///< red green blue alpha
    size_t code_bytes;
} sog_picture;

typedef struct sog {
    const ewa_gaussian_source *source;
    bool archive;
    const cJSON *root;
    uint64_t count;
    uint32_t bands; ///< degree of the harmonics
    uint64_t palette_count;
    double low[3], high[3]; ///< of the logarithms of centres
    float scales[TABLE], colors[TABLE], harmonics[TABLE];
    sog_picture pictures[PICTURES];
    ewa_gaussians *set;
    atomic_bool bad_tag, bad_label;
} sog;

static ewa_status fail(const sog *s, const char *what) {
    return ewa_fail(s->source->context, EWA_ERROR_FORMAT, "%s: SOG: %s", s->source->name, what);
}

static bool read_numbers(const cJSON *array, uint32_t count, double *numbers) {
    if (!cJSON_IsArray(array) || (uint32_t)cJSON_GetArraySize(array) != count) return false;
    const cJSON *item;
    uint32_t n = 0;
    cJSON_ArrayForEach(item, array) {
        if (!cJSON_IsNumber(item)) return false;
        numbers[n++] = item->valuedouble;
    }
    return true;
}

static bool read_table(const cJSON *object, float table[TABLE]) {
    double numbers[TABLE];
    if (!read_numbers(cJSON_GetObjectItemCaseSensitive(object, "codebook"), TABLE, numbers)) return false;
    for (int i = 0; i < TABLE; i++) table[i] = (float)numbers[i];
    return true;
}

static bool read_count(const cJSON *object, const char *name, uint64_t *count) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < 0x1p32)) return false;
    *count = (uint64_t)item->valuedouble;
    return (double)*count == item->valuedouble;
}

/// Reads what is no picture.
static ewa_status read_meta(sog *s) {
    const cJSON *means = cJSON_GetObjectItemCaseSensitive(s->root, "means"),
                *scales = cJSON_GetObjectItemCaseSensitive(s->root, "scales"),
                *colors = cJSON_GetObjectItemCaseSensitive(s->root, "sh0"),
                *harmonics = cJSON_GetObjectItemCaseSensitive(s->root, "shN");
    uint64_t version = 1, bands = 0;
    if (cJSON_GetObjectItemCaseSensitive(s->root, "version") && !read_count(s->root, "version", &version))
        return fail(s, "version is no number");
    if (version != 2)
        return ewa_fail(s->source->context, EWA_ERROR_UNSUPPORTED, "%s: SOG of version %llu; 2 is read",
                        s->source->name, (unsigned long long)version);
    if (!read_count(s->root, "count", &s->count)) return fail(s, "count is no number of Gaussians");
    if (!read_numbers(cJSON_GetObjectItemCaseSensitive(means, "mins"), 3, s->low) ||
        !read_numbers(cJSON_GetObjectItemCaseSensitive(means, "maxs"), 3, s->high))
        return fail(s, "means.mins or means.maxs are no three numbers");
    if (!read_table(scales, s->scales) || !read_table(colors, s->colors))
        return fail(s, "scales.codebook or sh0.codebook are no 256 numbers");
    if (!harmonics) return EWA_OK;
    if (!read_count(harmonics, "bands", &bands) || bands > MAX_BANDS ||
        !read_count(harmonics, "count", &s->palette_count))
        return fail(s, "shN.bands is not 0 to 3, or shN.count no number");
    if (bands && !read_table(harmonics, s->harmonics)) return fail(s, "shN.codebook are no 256 numbers");
    s->bands = (uint32_t)bands;
    return EWA_OK;
}

/// Decodes a picture, file `index` of a member.
static ewa_status read_picture(sog *s, const char *member, int index, sog_picture *picture) {
    ewa_context *context = s->source->context;
    const cJSON *files =
        cJSON_GetObjectItemCaseSensitive(cJSON_GetObjectItemCaseSensitive(s->root, member), "files");
    const cJSON *name = cJSON_GetArrayItem(files, index);
    if (!cJSON_IsString(name)) {
        char what[64];
        snprintf(what, sizeof what, "%s.files names no picture %d", member, index);
        return fail(s, what);
    }
    char shown[256];
    snprintf(shown, sizeof shown, "%s: %s", s->source->name, name->valuestring);
    if (s->archive) {
        ewa_zip_file file;
        ewa_status status = ewa_zip_open(s->source, name->valuestring, UINT32_MAX, &file);
        if (status == EWA_OK)
            status = ewa_webp_decode_codes(context, shown, file.bytes, file.size_bytes, &picture->width_px,
                                           &picture->height_px, &picture->codes, &picture->code_bytes);
        ewa_zip_close(context, &file);
        return status;
    }
    char reason[EWA_REASON_BYTES];
    ewa_file file;
    if (!s->source->path)
        return ewa_fail(context, EWA_ERROR_IO, "%s: there is no folder that it could be in", shown);
    if (!ewa_referenced_file_map(context, s->source->path, (ewa_text){name->valuestring, strlen(name->valuestring)},
                                 &file, reason))
        return ewa_fail(context, EWA_ERROR_IO, "%s: %s", shown, reason);
    const ewa_status status =
        ewa_webp_decode_codes(context, shown, file.bytes, file.size_bytes, &picture->width_px,
                              &picture->height_px, &picture->codes, &picture->code_bytes);
    ewa_file_unmap(context, &file);
    return status;
}

static ewa_status read_pictures(sog *s) {
    static const struct {
        const char *member;
        int index;
    } named[PICTURES] = {{"means", 0}, {"means", 1}, {"scales", 0}, {"quats", 0},
                         {"sh0", 0},   {"shN", 0},   {"shN", 1}};
    const uint32_t pictures = s->bands ? PICTURES : PALETTES;
    for (uint32_t k = 0; k < pictures; k++) {
        EWA_TRY(read_picture(s, named[k].member, named[k].index, &s->pictures[k]));
        const uint64_t pixels = (uint64_t)s->pictures[k].width_px * s->pictures[k].height_px;
        if (k != PALETTES && pixels < s->count)
            return ewa_fail(s->source->context, EWA_ERROR_FORMAT,
                            "%s: SOG: %llu Gaussians in a picture of %llu pixels", s->source->name,
                            (unsigned long long)s->count, (unsigned long long)pixels);
    }
    if (!s->bands) return EWA_OK;
    const sog_picture *palettes = &s->pictures[PALETTES];
    if (palettes->width_px != PALETTE_COLUMNS * (ewa_sh_count(s->bands) - 1) ||
        s->palette_count > (uint64_t)PALETTE_COLUMNS * palettes->height_px)
        return ewa_fail(s->source->context, EWA_ERROR_FORMAT,
                        "%s: SOG: %llu palettes of degree %u in a picture of %u x %u pixels", s->source->name,
                        (unsigned long long)s->palette_count, s->bands, palettes->width_px,
                        palettes->height_px);
    return EWA_OK;
}

/// The coordinate of which the symmetric logarithm is given.
static double spread(double logarithm) {
    const double size = fabs(logarithm);
    const double far = size < 700 ? ewa_exp(size) - 1 : (double)INFINITY;
    return logarithm < 0 ? -far : far;
}

static bool decode_harmonics(const sog *s, size_t i, float *harmonics) {
    const uint8_t *label = s->pictures[LABELS].codes + 4 * i;
    const uint32_t number = ewa_file_u16(label), coefficients = ewa_sh_count(s->bands) - 1;
    if (number >= s->palette_count) return false;
    const sog_picture *palettes = &s->pictures[PALETTES];
    const uint8_t *from = palettes->codes + 4 * ((size_t)(number / PALETTE_COLUMNS) * palettes->width_px +
                                                 number % PALETTE_COLUMNS * coefficients);
    for (uint32_t n = 0; n < coefficients; n++)
        for (uint32_t k = 0; k < 3; k++) harmonics[3 * (n + 1) + k] = s->harmonics[from[4 * n + k]];
    return true;
}

static void decode(void *data, uint32_t first, uint32_t end) {
    sog *s = data;
    ewa_gaussians *set = s->set;
    for (size_t i = first; i < end; i++) {
        float *harmonics = set->harmonics + i * 3 * ewa_sh_count(s->bands);
        const uint8_t *quaternion = s->pictures[QUATERNIONS].codes + 4 * i;
        double others[3];
        for (size_t k = 0; k < 3; k++) {
            const uint32_t steps = s->pictures[MEANS_LOW].codes[4 * i + k] |
                                   (uint32_t)s->pictures[MEANS_HIGH].codes[4 * i + k] << 8;
            set->centers[3 * i + k] = (float)spread(s->low[k] + (s->high[k] - s->low[k]) * (steps / 65535.0));
            set->scales[3 * i + k] = s->scales[s->pictures[SCALES].codes[4 * i + k]];
            harmonics[k] = s->colors[s->pictures[COLORS].codes[4 * i + k]];
            others[k] = (quaternion[k] / 255.0 * 2 - 1) * sqrt(0.5);
        }
        set->opacities[i] = (float)(s->pictures[COLORS].codes[4 * i + 3] / 255.0);
        if (quaternion[3] < FIRST_TAG)
            atomic_store(&s->bad_tag, true);
        else
            ewa_quaternion_complete(others, quaternion[3] - FIRST_TAG, set->rotations + 4 * i);
        if (s->bands && !decode_harmonics(s, i, harmonics)) atomic_store(&s->bad_label, true);
    }
}

static ewa_status read_with(sog *s, ewa_gaussian_facts *facts) {
    EWA_TRY(read_meta(s));
    EWA_TRY(read_pictures(s));
    EWA_TRY(ewa_gaussians_make(s->source, s->count, 0, 0, s->bands, s->set));
    ewa_gaussians_decode(s->source->context, s->set->count, decode, s);
    if (atomic_load(&s->bad_tag))
        return fail(s, "a quaternion's alpha is below 252, which names no component");
    if (atomic_load(&s->bad_label)) return fail(s, "a label is beyond the palettes");
    const cJSON *model = cJSON_GetObjectItemCaseSensitive(s->root, "model");
    const char *word = cJSON_IsString(model) ? model->valuestring : "";
    s->set->antialiased = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(s->root, "antialias")) ||
                          strcmp(word, "antialiased") == 0;
    if (strcmp(word, "2dgs") == 0) ewa_gaussians_flatten(s->set);
    facts->version = 2;
    return ewa_gaussians_settle(s->source, &(ewa_gaussian_form){.log_scales = true}, s->set);
}

static ewa_status read_sog(const ewa_gaussian_source *source, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    sog s = {.source = source, .set = set, .archive = memcmp(source->bytes, "PK", 2) == 0};
    ewa_zip_file meta = {.bytes = source->bytes, .size_bytes = source->size_bytes};
    ewa_json json = {0};
    ewa_status status = s.archive ? ewa_zip_open(source, "meta.json", EWA_JSON_BYTES, &meta) : EWA_OK;
    if (status == EWA_OK)
        status = ewa_json_parse(source->context, source->name, "meta.json of SOG", meta.bytes,
                                meta.size_bytes, &json);
    s.root = json.root;
    if (status == EWA_OK) status = read_with(&s, facts);
    for (int k = 0; k < PICTURES; k++)
        ewa_release(source->context, s.pictures[k].codes, s.pictures[k].code_bytes, 1);
    ewa_json_free(source->context, &json);
    ewa_zip_close(source->context, &meta);
    return status;
}

/// Whether a text has a word in quotes.
static bool has_word(const uint8_t *bytes, size_t size_bytes, const char *word) {
    const size_t length = strlen(word);
    const uint8_t *at = bytes, *end = bytes + size_bytes;
    for (; (at = memchr(at, '"', (size_t)(end - at))); at++)
        if ((size_t)(end - at) >= length + 2 && memcmp(at + 1, word, length) == 0 && at[length + 1] == '"')
            return true;
    return false;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    (void)status;
    if (source->size_bytes < 4) return false;
    if (memcmp(source->bytes, "PK", 2) == 0)
        return ewa_zip_has(source->bytes, source->size_bytes, "meta.json");
    size_t at = 0;
    while (at < source->size_bytes && strchr(" \t\r\n", source->bytes[at]) && source->bytes[at]) at++;
    return at < source->size_bytes && source->bytes[at] == '{' &&
           has_word(source->bytes, source->size_bytes, "means") &&
           has_word(source->bytes, source->size_bytes, "quats") &&
           has_word(source->bytes, source->size_bytes, "sh0");
}

const ewa_gaussian_reader ewa_gaussians_sog = {EWA_GAUSSIANS_SOG, probe, read_sog};
