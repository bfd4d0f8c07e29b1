// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// SOG: a Gaussian for each pixel of some lossless WebP pictures, which meta.json names, in a zip archive or beside it.
// Centres are 16 bits of a symmetric logarithm, scales and colours indices into tables of numbers, quaternions their
// three smallest components; harmonics beyond the first an index into a picture of palettes. Version 1 has even steps
// between two numbers where version 2 has tables: its tables are made of them.
//
// Based on: PlayCanvas, "SOG format", version 2; splat-transform's and the engine's readers of version 1.
#include "base/unpacking.h"
#include "io/gaussian/zip.h"
#include "io/image/webp.h"
#include "io/json_text.h"
#include "io/referenced_file.h"
#include "math/gaussian.h"

#include <stdatomic.h>
#include <stdio.h>

enum { TABLE = 256, FIRST_TAG = 252, PALETTE_COLUMNS = 64, MAX_BANDS = 3 };

/// How many times the pixels that are needed a picture may have, and how many it may have besides: sides may be multiples of
/// something, and writers do not all choose the same shape. Lossless WebP takes little more than a pixel's four bytes.
enum { MAX_SPARE = 4, SPARE_PIXELS = 1 << 16, MAX_PIXEL_BYTES = 5 };

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
    uint64_t version, count;
    uint32_t bands; ///< degree of the harmonics
    uint64_t palette_count;
    double low[3], high[3]; ///< of the logarithms of centres
    float scales[3][TABLE], colors[3][TABLE], opacities[TABLE], harmonics[TABLE];
    sog_picture pictures[PICTURES];
    uint64_t packed_bytes, picture_count; ///< of the pictures so far
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

/// Reads a table into `count` ones.
static bool read_table(const cJSON *object, uint32_t count, float tables[][TABLE]) {
    double numbers[TABLE];
    if (!read_numbers(cJSON_GetObjectItemCaseSensitive(object, "codebook"), TABLE, numbers)) return false;
    for (uint32_t k = 0; k < count; k++)
        for (int i = 0; i < TABLE; i++) tables[k][i] = (float)numbers[i];
    return true;
}

static void fill_steps(double low, double high, float table[TABLE]) {
    for (int i = 0; i < TABLE; i++) table[i] = (float)(low + (high - low) * (i / (TABLE - 1.0)));
}

/// Reads the ends of `count` ranges.
static bool read_ranges(const cJSON *object, uint32_t count, double *low, double *high) {
    return read_numbers(cJSON_GetObjectItemCaseSensitive(object, "mins"), count, low) &&
           read_numbers(cJSON_GetObjectItemCaseSensitive(object, "maxs"), count, high);
}

static bool take_count(const cJSON *item, uint64_t *count) {
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < 0x1p32)) return false;
    *count = (uint64_t)item->valuedouble;
    return (double)*count == item->valuedouble;
}

static bool read_count(const cJSON *object, const char *name, uint64_t *count) {
    return take_count(cJSON_GetObjectItemCaseSensitive(object, name), count);
}

/// Reads what version 1 says; how many harmonics there are its picture of palettes does.
static ewa_status read_steps(sog *s, const cJSON *means, const cJSON *scales, const cJSON *colors,
                             const cJSON *harmonics) {
    double low[4], high[4];
    if (!take_count(cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(means, "shape"), 0), &s->count))
        return fail(s, "means.shape begins with no number of Gaussians");
    if (!read_ranges(scales, 3, low, high)) return fail(s, "scales.mins or scales.maxs are no three numbers");
    for (int k = 0; k < 3; k++) fill_steps(low[k], high[k], s->scales[k]);
    if (!read_ranges(colors, 4, low, high)) return fail(s, "sh0.mins or sh0.maxs are no four numbers");
    for (int k = 0; k < 3; k++) fill_steps(low[k], high[k], s->colors[k]);
    fill_steps(low[3], high[3], s->opacities);
    if (!harmonics) return EWA_OK;
    const cJSON *minimum = cJSON_GetObjectItemCaseSensitive(harmonics, "mins"),
                *maximum = cJSON_GetObjectItemCaseSensitive(harmonics, "maxs");
    if (!cJSON_IsNumber(minimum) || !cJSON_IsNumber(maximum)) return fail(s, "shN.mins or shN.maxs is no number");
    fill_steps(minimum->valuedouble, maximum->valuedouble, s->harmonics);
    s->bands = MAX_BANDS;
    return EWA_OK;
}

/// Reads what version 2 says.
static ewa_status read_tables(sog *s, const cJSON *scales, const cJSON *colors, const cJSON *harmonics) {
    uint64_t bands = 0;
    if (!read_count(s->root, "count", &s->count)) return fail(s, "count is no number of Gaussians");
    if (!read_table(scales, 3, s->scales) || !read_table(colors, 3, s->colors))
        return fail(s, "scales.codebook or sh0.codebook are no 256 numbers");
    fill_steps(0, 1, s->opacities);
    if (!harmonics) return EWA_OK;
    if (!read_count(harmonics, "bands", &bands) || bands > MAX_BANDS ||
        !read_count(harmonics, "count", &s->palette_count))
        return fail(s, "shN.bands is not 0 to 3, or shN.count no number");
    if (bands && !read_table(harmonics, 1, &s->harmonics)) return fail(s, "shN.codebook are no 256 numbers");
    s->bands = (uint32_t)bands;
    return EWA_OK;
}

/// Reads what is no picture.
static ewa_status read_meta(sog *s) {
    const cJSON *means = cJSON_GetObjectItemCaseSensitive(s->root, "means"),
                *scales = cJSON_GetObjectItemCaseSensitive(s->root, "scales"),
                *colors = cJSON_GetObjectItemCaseSensitive(s->root, "sh0"),
                *harmonics = cJSON_GetObjectItemCaseSensitive(s->root, "shN");
    s->version = 1;
    if (cJSON_GetObjectItemCaseSensitive(s->root, "version") && !read_count(s->root, "version", &s->version))
        return fail(s, "version is no number");
    if (s->version != 1 && s->version != 2)
        return ewa_fail(s->source->context, EWA_ERROR_UNSUPPORTED, "%s: SOG of version %llu; 1 and 2 are read",
                        s->source->name, (unsigned long long)s->version);
    if (!read_ranges(means, 3, s->low, s->high))
        return fail(s, "means.mins or means.maxs are no three numbers");
    return s->version == 1 ? read_steps(s, means, scales, colors, harmonics)
                           : read_tables(s, scales, colors, harmonics);
}

/// Pixels that a picture may have: of as many as there are numbers, but for rows that are filled up.
static uint64_t max_pixels(const sog *s, const sog_picture *picture) {
    if (picture != &s->pictures[PALETTES]) return MAX_SPARE * s->count + SPARE_PIXELS;
    // Version 1 does not say how many there are; labels have 16 bits.
    const uint64_t palette_count = s->version == 1 ? 1 << 16 : s->palette_count;
    return MAX_SPARE * palette_count * (ewa_sh_count(s->bands) - 1) + SPARE_PIXELS;
}

/// What the pictures of the numbers so far unpack to has to be explained by their files: a picture of one colour takes 40 bytes,
/// however large it is.
static ewa_status check_pictures(sog *s, const char *name, size_t size_bytes) {
    s->packed_bytes += size_bytes;
    s->picture_count++;
    return ewa_memory_check_unpacked(s->source->context, s->packed_bytes, EWA_UNPACKED_RATIO,
                                     4 * s->count * s->picture_count, "%s: %llu Gaussians", name, (unsigned long long)s->count);
}

/// Decodes a picture that is there.
static ewa_status decode_picture(sog *s, const char *name, const uint8_t *bytes, size_t size_bytes, sog_picture *picture) {
    ewa_context *context = s->source->context;
    EWA_TRY(check_pictures(s, name, size_bytes));
    EWA_TRY(ewa_webp_look(context, name, bytes, size_bytes, &picture->width_px, &picture->height_px));
    if ((uint64_t)picture->width_px * picture->height_px > max_pixels(s, picture))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: SOG: %u x %u pixels, of which at most %llu are needed", name,
                        picture->width_px, picture->height_px, (unsigned long long)max_pixels(s, picture));
    return ewa_webp_decode_codes(context, name, bytes, size_bytes, &picture->width_px, &picture->height_px, &picture->codes,
                                 &picture->code_bytes);
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
        const uint64_t max_bytes = MAX_PIXEL_BYTES * max_pixels(s, picture);
        ewa_status status = ewa_zip_open(s->source, name->valuestring,
                                         max_bytes < UINT32_MAX ? (uint32_t)max_bytes : UINT32_MAX, &file);
        if (status == EWA_OK) status = decode_picture(s, shown, file.bytes, file.size_bytes, picture);
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
    const ewa_status status = decode_picture(s, shown, file.bytes, file.size_bytes, picture);
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
    if (s->version == 1) {
        while (s->bands && palettes->width_px != PALETTE_COLUMNS * (ewa_sh_count(s->bands) - 1)) s->bands--;
        s->palette_count = (uint64_t)PALETTE_COLUMNS * palettes->height_px;
        if (!s->bands) return fail(s, "the picture of palettes is not 192, 512 or 960 pixels wide");
    }
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
            set->scales[3 * i + k] = s->scales[k][s->pictures[SCALES].codes[4 * i + k]];
            harmonics[k] = s->colors[k][s->pictures[COLORS].codes[4 * i + k]];
            others[k] = (quaternion[k] / 255.0 * 2 - 1) * sqrt(0.5);
        }
        set->opacities[i] = s->opacities[s->pictures[COLORS].codes[4 * i + 3]];
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
    EWA_TRY(ewa_memory_check_unpacked(s->source->context, s->packed_bytes, EWA_UNPACKED_RATIO,
                                      s->count * sizeof(float) * (11 + 3 * ewa_sh_count(s->bands)), "%s: %llu Gaussians",
                                      s->source->name, (unsigned long long)s->count));
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
    facts->version = (uint32_t)s->version;
    const ewa_gaussian_form form = {.log_scales = true, .logits = s->version == 1};
    return ewa_gaussians_settle(s->source, &form, s->set);
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

bool ewa_gaussian_text_has(const ewa_gaussian_source *source, const char *const *words, uint32_t count) {
    size_t at = 0;
    while (at < source->size_bytes && strchr(" \t\r\n", source->bytes[at]) && source->bytes[at]) at++;
    bool has = at < source->size_bytes && source->bytes[at] == '{';
    for (uint32_t k = 0; k < count && has; k++) has = has_word(source->bytes, source->size_bytes, words[k]);
    return has;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    (void)status;
    if (source->size_bytes < 4) return false;
    if (memcmp(source->bytes, "PK", 2) == 0)
        return ewa_zip_has(source->bytes, source->size_bytes, "meta.json");
    return ewa_gaussian_text_has(source, (const char *const[]){"means", "quats", "sh0"}, 3);
}

const ewa_gaussian_reader ewa_gaussians_sog = {EWA_GAUSSIANS_SOG, probe, read_sog};
