// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours from an attribute.
#include "color_by.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/// sRGB of numbers that have no colour.
static const uint8_t GREY_SRGB = 128;

/// Codes of classes are below.
enum { CLASS_COUNT = 1 << 16 };

/// The numbers of a cloud's points that colours stand for.
typedef struct scalar {
    ewa_scalar of;
    uint64_t count;
} scalar;

static double read_scalar(const scalar *from, uint64_t index) {
    double number;
    ewa_scalar_read(&from->of, index, 1, &number);
    return number;
}

/// Whether an attribute is a strength of light, of which a few mirrors give numbers far above all others.
static bool is_signal(const char *name) {
    static const char *const names[] = {"intensity", "nir", "amplitude", "reflectance"};
    static const char before[] = "scalar_";
    if (strncmp(name, before, sizeof before - 1) == 0) name += sizeof before - 1;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcasecmp(name, names[i]) == 0) return true;
    return false;
}

/// Finds the numbers of the first and the last colour; false after reporting.
static bool find_range(cli_session *session, const scalar *from, const option_bounds *range, double ends[2]) {
    static const option_bounds all = {.values = {0, 100}, .percent = {true, true}},
                               most = {.values = {2, 98}, .percent = {true, true}};
    if (!range->given) range = is_signal(from->of.attribute.name) ? &most : &all;
    memcpy(ends, range->values, sizeof range->values);
    double *numbers = malloc((from->count + 1) * sizeof *numbers);
    if (!numbers) {
        session_fail(session, "--range: out of memory for %llu numbers", (unsigned long long)from->count);
        return false;
    }
    for (int end = 0; end < 2; end++) {
        if (!range->percent[end]) continue;
        size_t count = 0;
        for (uint64_t i = 0; i < from->count; i++) {
            numbers[count] = read_scalar(from, i);
            count += isfinite(numbers[count]) ? 1 : 0;
        }
        const double place = range->values[end] / 100 * ((double)count - 1);
        ends[end] = count ? ewa_rank_select(numbers, count, (size_t)(place + 0.5)) : 0;
    }
    free(numbers);
    return true;
}

/// Whether a number is the code of a class.
static bool is_class(double number) { return number >= 0 && number < CLASS_COUNT && number == floor(number); }

/// Lists the classes that there are, by code. False after reporting.
static bool list_classes(cli_session *session, const scalar *from, color_scale *scale) {
    bool *there = calloc(CLASS_COUNT, sizeof *there);
    for (uint64_t i = 0; there && i < from->count; i++) {
        const double number = read_scalar(from, i);
        if (!is_class(number)) continue;
        scale->category_count += !there[(uint32_t)number];
        there[(uint32_t)number] = true;
    }
    scale->categories = calloc(scale->category_count + 1, sizeof *scale->categories);
    scale->names = calloc(scale->category_count + 1, sizeof *scale->names);
    const bool done = there && scale->categories && scale->names;
    if (!done) session_fail(session, "--color-by: out of memory for %u classes", scale->category_count);
    for (uint32_t code = 0, k = 0; done && code < CLASS_COUNT; code++) {
        if (!there[code]) continue;
        ewa_class_name(code, scale->names[k]);
        scale->categories[k] = (ewa_category){.value = code, .name = scale->names[k]};
        ewa_class_color(code, scale->categories[k++].srgb);
    }
    free(there);
    return done;
}

bool color_by_names_classes(const char *name) {
    static const char *const names[] = {"classification", "Classification", "scalar_classification",
                                        "scalar_Classification"};
    bool named = false;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) named = named || strcmp(name, names[i]) == 0;
    return named;
}

/// Whether an attribute holds classes by its name and its numbers.
static bool holds_classes(const scalar *from) {
    bool named = color_by_names_classes(from->of.attribute.name);
    for (uint64_t i = 0; named && i < from->count; i++) named = is_class(read_scalar(from, i));
    return named;
}

/// Chooses colours for the numbers; says which. False after reporting.
static bool choose_scale(cli_session *session, const scalar *from, const char *word, int colormap,
                         const option_bounds *range, color_scale *scale) {
    const bool classes =
        colormap == COLOR_BY_CLASSES || (colormap == COLOR_BY_AUTO && !range->given && holds_classes(from));
    scale->colormap = colormap >= 0 && !classes ? (ewa_colormap)colormap : EWA_COLORMAP_VIRIDIS;
    if (!classes) {
        if (!find_range(session, from, range, scale->range)) return false;
        session_say(session, "--color-by: %s from %g to %g", word, scale->range[0], scale->range[1]);
        return true;
    }
    if (!list_classes(session, from, scale)) return false;
    session_say(session, "--color-by: %s has %u classes, drawn in the colours of classes%s", word,
                scale->category_count,
                colormap == COLOR_BY_CLASSES ? "" : " (--colormap viridis shows the numbers)");
    return true;
}

/// The colour of a number; false, and grey, when it has none.
static bool find_color(const color_scale *scale, double number, uint8_t srgb[3]) {
    const double extent = scale->range[1] - scale->range[0];
    const bool has = scale->categories ? is_class(number) : isfinite(number);
    if (!has)
        memset(srgb, GREY_SRGB, 3);
    else if (scale->categories)
        ewa_class_color((uint32_t)number, srgb);
    else
        ewa_colormap_color(scale->colormap, extent != 0 ? (number - scale->range[0]) / extent : 0.5, srgb);
    return has;
}

/// Finds the numbers that a word means; false after reporting.
static bool find_scalar(cli_session *session, const ewa_cloud *cloud, const char *word, scalar *from) {
    from->count = ewa_cloud_point_count(cloud);
    const ewa_status status = ewa_cloud_find_scalar(cloud, word, &from->of);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

bool color_by_shows_classes(cli_session *session, const ewa_cloud *cloud, const char *word) {
    scalar from;
    return !color_by_is_own(word) && find_scalar(session, cloud, word, &from) && holds_classes(&from);
}

bool color_by_is_own(const char *word) { return strcmp(word, "rgb") == 0 || strcmp(word, EWA_COLOR) == 0; }

void color_scale_free(color_scale *scale) {
    free(scale->categories);
    free(scale->names);
    *scale = (color_scale){.categories = NULL};
}

bool color_by(cli_session *session, ewa_cloud *cloud, const char *word, int colormap,
              const option_bounds *range, color_scale *scale) {
    *scale = (color_scale){.categories = NULL};
    if (color_by_is_own(word)) {
        if (!ewa_cloud_find(cloud, EWA_COLOR)) session_fail(session, "--color-by: there are no colours");
        return ewa_cloud_find(cloud, EWA_COLOR) != NULL;
    }
    const uint64_t count = ewa_cloud_point_count(cloud);
    scalar from;
    if (!find_scalar(session, cloud, word, &from)) return false;
    scale->length = strcmp(from.of.attribute.name, EWA_POSITION) == 0;
    if (!choose_scale(session, &from, word, colormap, range, scale)) return false;
    uint8_t(*colors)[3] = NULL;
    // Under a name of its own first: the colours themselves may be what is read.
    static const char made[] = "ewa_color_by";
    ewa_status status = ewa_cloud_add(cloud, made, EWA_U8, 3, (void **)&colors);
    uint64_t grey_count = 0;
    for (uint64_t i = 0; status == EWA_OK && i < count; i++)
        grey_count += !find_color(scale, read_scalar(&from, i), colors[i]);
    void *data = NULL;
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &data);
    if (status == EWA_OK) memcpy(data, colors, 3 * count);
    ewa_cloud_remove(cloud, made);
    if (status != EWA_OK) session_failed(session, status);
    if (status == EWA_OK && grey_count)
        session_warn(session, "--color-by: %llu of %llu numbers of %s are %s; these points are drawn in grey",
                     (unsigned long long)grey_count, (unsigned long long)count, word,
                     scale->categories ? "no classes" : "not finite");
    return status == EWA_OK;
}
