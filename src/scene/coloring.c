// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of points that stand for a number, on one scale for all clouds that are coloured together.
#include "ewa/coloring.h"
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "ewa/select.h"
#include "scene/parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// sRGB of numbers that have no colour.
static const uint8_t GREY_SRGB = 128;

/// Percentiles of the first and the last colour of strengths of light.
#define SIGNAL_PERCENT_LOW 2.0
#define SIGNAL_PERCENT_HIGH 98.0

/// What surveys show without any other number.
static const char HEIGHT[] = "z";

/// Codes of classes are below.
enum { CLASS_COUNT = 1 << 16, BLOCK = 512 };

#define AT(member) offsetof(ewa_coloring, member)

static const ewa_option coloring_rows[] = {
    {"map", EWA_OPTION_CHOICE, AT(map),
     .words = "auto|viridis|turbo|gray|plasma|inferno|magma|cividis|coolwarm|classes",
     .help = "colours of the numbers; auto: classes for whole numbers named classification, else viridis"},
    {"ranged", EWA_OPTION_BOOL, AT(ranged), .help = "the range is given"},
    {"percent", EWA_OPTION_BOOL, AT(percent), .count = 2, .help = "an end of the range is a percentile"},
    {"range", EWA_OPTION_F64, AT(range), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 2,
     .help = "numbers of the first and the last colour"},
    {"tinted", EWA_OPTION_BOOL, AT(tinted), .help = "all points have the colour tint"},
    {"tint", EWA_OPTION_F64, AT(tint), 0, 1, .count = 3, .help = "sRGB"},
};

const ewa_option_table ewa_coloring_table = EWA_OPTION_TABLE(ewa_coloring, coloring_rows);

void ewa_coloring_init(ewa_coloring *coloring, size_t struct_size) {
    ewa_options_init(&ewa_coloring_table, coloring, struct_size);
}

bool ewa_coloring_is_auto(const char *attribute) { return !attribute[0] || strcmp(attribute, "auto") == 0; }

/// Whether a word means colours of the points that have to be there.
static bool is_rgb(const char *attribute) {
    return strcmp(attribute, "rgb") == 0 || strcmp(attribute, EWA_COLOR) == 0;
}

bool ewa_coloring_is_own(const char *attribute) {
    if (!attribute) return false;
    return ewa_coloring_is_auto(attribute) || strcmp(attribute, "none") == 0 || is_rgb(attribute);
}

bool ewa_colorings_agree(const ewa_coloring *a, const ewa_coloring *b) {
    bool agree = strcmp(a->attribute, b->attribute) == 0 && a->map == b->map && a->ranged == b->ranged &&
                 a->tinted == b->tinted;
    for (int end = 0; end < 2 && a->ranged; end++)
        agree = agree && a->percent[end] == b->percent[end] && a->range[end] == b->range[end];
    for (int c = 0; c < 3 && a->tinted; c++) agree = agree && a->tint[c] == b->tint[c];
    return agree;
}

ewa_status ewa_coloring_take(ewa_context *context, const ewa_coloring *given, ewa_coloring *taken) {
    ewa_coloring_init(taken, sizeof *taken);
    EWA_TRY(ewa_options_take(context, &ewa_coloring_table, given, taken));
    if (!memchr(taken->attribute, 0, sizeof taken->attribute))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "attribute: a name has at most %d characters",
                        (int)sizeof taken->attribute - 1);
    for (int end = 0; end < 2 && taken->ranged; end++)
        if (taken->percent[end] && !(taken->range[end] >= 0 && taken->range[end] <= 100))
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "range: %g is no percentile, which is in [0, 100]",
                            taken->range[end]);
    return EWA_OK;
}

void ewa_legend_free(ewa_legend *legend) {
    if (!legend || !legend->context) return;
    const size_t room = legend->category_count + (size_t)1;
    ewa_release(legend->context, legend->categories, room, sizeof *legend->categories);
    ewa_release(legend->context, legend->names, room, EWA_CLASS_NAME_BYTES);
    *legend = (ewa_legend){.context = NULL};
}

/// The numbers of the clouds' points that colours stand for.
typedef struct numbers {
    ewa_context *context;
    ewa_cloud *const *clouds;
    ewa_scalar *scalars; ///< [count]
    uint32_t count;
} numbers;

/// Calls a function with all numbers, block by block; false ends it.
typedef bool take_block(void *user, uint32_t count, const double *block);

static void each_block(const numbers *from, take_block *take, void *user) {
    double block[BLOCK];
    for (uint32_t k = 0; k < from->count; k++) {
        const uint64_t count = ewa_cloud_point_count(from->clouds[k]);
        for (uint64_t first = 0; first < count; first += BLOCK) {
            const uint32_t in_block = count - first < BLOCK ? (uint32_t)(count - first) : BLOCK;
            ewa_scalar_read(&from->scalars[k], first, in_block, block);
            if (!take(user, in_block, block)) return;
        }
    }
}

/// The finite ones of some numbers.
typedef struct finite_numbers {
    double *numbers;
    size_t count;
} finite_numbers;

static bool take_finite(void *user, uint32_t count, const double *block) {
    finite_numbers *finite = user;
    for (uint32_t i = 0; i < count; i++) {
        finite->numbers[finite->count] = block[i];
        finite->count += isfinite(block[i]) ? 1 : 0;
    }
    return true;
}

/// Finds the numbers of the first and the last colour.
static ewa_status find_range(const numbers *from, const ewa_coloring *coloring, double ends[2]) {
    bool percent[2] = {true, true};
    const bool signal = ewa_attribute_is_signal(from->scalars[0].attribute.name);
    ends[0] = signal ? SIGNAL_PERCENT_LOW : 0;
    ends[1] = signal ? SIGNAL_PERCENT_HIGH : 100;
    if (coloring->ranged) {
        memcpy(ends, coloring->range, sizeof coloring->range);
        memcpy(percent, coloring->percent, sizeof percent);
    }
    if (!percent[0] && !percent[1]) return EWA_OK;
    size_t total = 1;
    for (uint32_t k = 0; k < from->count; k++) total += ewa_cloud_point_count(from->clouds[k]);
    finite_numbers finite = {ewa_allocate(from->context, total, sizeof(double)), 0};
    if (!finite.numbers) return EWA_ERROR_MEMORY;
    for (int end = 0; end < 2; end++) {
        if (!percent[end]) continue;
        finite.count = 0;
        each_block(from, take_finite, &finite); // the choice of one leaves them in no order, some twice
        const double place = ends[end] / 100 * ((double)finite.count - 1);
        ends[end] = finite.count ? ewa_rank_select(finite.numbers, finite.count, (size_t)(place + 0.5)) : 0;
    }
    ewa_release(from->context, finite.numbers, total, sizeof(double));
    return EWA_OK;
}

/// Whether a number is the code of a class.
static bool is_class(double number) { return number >= 0 && number < CLASS_COUNT && number == floor(number); }

static bool mark_classes(void *user, uint32_t count, const double *block) {
    bool *there = user;
    for (uint32_t i = 0; i < count; i++)
        if (is_class(block[i])) there[(uint32_t)block[i]] = true;
    return true;
}

/// Makes room for the rows of a legend.
static ewa_status make_rows(const numbers *from, uint32_t count, ewa_legend *legend) {
    legend->categories = ewa_allocate_zeroed(from->context, count + (size_t)1, sizeof *legend->categories);
    legend->names = ewa_allocate_zeroed(from->context, count + (size_t)1, EWA_CLASS_NAME_BYTES);
    legend->category_count = count;
    return legend->categories && legend->names ? EWA_OK : EWA_ERROR_MEMORY;
}

static void name_class(ewa_legend *legend, uint32_t row, uint32_t code) {
    char *name = legend->names + (size_t)row * EWA_CLASS_NAME_BYTES;
    ewa_class_name(code, name);
    legend->categories[row].name = name;
}

/// Lists the classes that there are, by code.
static ewa_status list_classes(const numbers *from, ewa_legend *legend) {
    bool *there = ewa_allocate_zeroed(from->context, CLASS_COUNT, sizeof *there);
    if (!there) return EWA_ERROR_MEMORY;
    each_block(from, mark_classes, there);
    uint32_t count = 0;
    for (uint32_t code = 0; code < CLASS_COUNT; code++) count += there[code];
    legend->classes = true;
    const ewa_status status = make_rows(from, count, legend);
    for (uint32_t code = 0, k = 0; status == EWA_OK && code < CLASS_COUNT; code++) {
        if (!there[code]) continue;
        legend->categories[k].value = code;
        name_class(legend, k, code);
        ewa_class_color(code, legend->categories[k++].srgb);
    }
    ewa_release(from->context, there, CLASS_COUNT, sizeof *there);
    return status;
}

/// The different numbers, ascending; one more than a legend shows: too many, or one that is not whole.
typedef struct whole_numbers {
    uint32_t count;
    double numbers[EWA_LEGEND_NUMBERS + 1];
} whole_numbers;

static bool take_whole(void *user, uint32_t count, const double *block) {
    whole_numbers *found = user;
    for (uint32_t i = 0; i < count; i++) {
        if (i && block[i] == block[i - 1]) continue;
        uint32_t place = 0;
        while (place < found->count && found->numbers[place] < block[i]) place++;
        if (place < found->count && found->numbers[place] == block[i]) continue;
        memmove(&found->numbers[place + 1], &found->numbers[place], (found->count - place) * sizeof block[i]);
        found->numbers[place] = block[i];
        found->count = block[i] == floor(block[i]) ? found->count + 1 : EWA_LEGEND_NUMBERS + 1;
        if (found->count > EWA_LEGEND_NUMBERS) return false;
    }
    return true;
}

static bool are_classes(void *user, uint32_t count, const double *block) {
    bool *all = user;
    for (uint32_t i = 0; i < count && *all; i++) *all = is_class(block[i]);
    return *all;
}

bool ewa_coloring_names_classes(const char *name) {
    return name && ewa_attribute_names_agree(name, "classification");
}

/// Whether an attribute holds classes by its name and its numbers.
static bool holds_classes(const numbers *from) {
    bool held = ewa_coloring_names_classes(from->scalars[0].attribute.name);
    if (held) each_block(from, are_classes, &held);
    return held;
}

/// The colour of a number; false, and grey, when it has none.
static bool find_color(const ewa_color_scale *scale, double number, uint8_t srgb[3]) {
    const double extent = scale->range[1] - scale->range[0];
    const bool has = scale->classes ? is_class(number) : isfinite(number);
    if (!has)
        memset(srgb, GREY_SRGB, 3);
    else if (scale->classes)
        ewa_class_color((uint32_t)number, srgb);
    else
        ewa_colormap_color(scale->colormap, extent != 0 ? (number - scale->range[0]) / extent : 0.5, srgb);
    return has;
}

ewa_color_scale ewa_color_scale_of(const ewa_legend *legend) {
    return (ewa_color_scale){
        legend->colormap, legend->classes, {legend->range[0], legend->range[1]}};
}

/// Lists numbers that are whole and few, in the colours of the range: nobody reads a bar for the first to the fifth return.
static ewa_status list_numbers(const numbers *from, const ewa_coloring *coloring, ewa_legend *legend) {
    const char *name = from->scalars[0].attribute.name;
    if (coloring->ranged || legend->length || ewa_attribute_is_signal(name) || strcmp(name, EWA_COLOR) == 0) return EWA_OK;
    whole_numbers found = {.count = 0};
    each_block(from, take_whole, &found);
    if (!found.count || found.count > EWA_LEGEND_NUMBERS) return EWA_OK;
    EWA_TRY(make_rows(from, found.count, legend));
    const bool named = ewa_coloring_names_classes(name);
    const ewa_color_scale scale = ewa_color_scale_of(legend);
    for (uint32_t k = 0; k < found.count; k++) {
        legend->categories[k].value = found.numbers[k];
        if (named && is_class(found.numbers[k])) name_class(legend, k, (uint32_t)found.numbers[k]);
        (void)find_color(&scale, found.numbers[k], legend->categories[k].srgb);
    }
    return EWA_OK;
}

/// Chooses colours for the numbers; says which.
static ewa_status choose_scale(const numbers *from, const ewa_coloring *coloring, ewa_legend *legend) {
    const bool automatic = coloring->map == EWA_COLORING_AUTO;
    const bool classes =
        coloring->map == EWA_COLORING_CLASSES || (automatic && !coloring->ranged && holds_classes(from));
    legend->colormap =
        automatic || classes ? EWA_COLORMAP_VIRIDIS : (ewa_colormap)(coloring->map - EWA_COLORING_VIRIDIS);
    const char *word = coloring->attribute;
    EWA_TRY(classes ? list_classes(from, legend) : find_range(from, coloring, legend->range));
    if (!classes) EWA_TRY(list_numbers(from, coloring, legend));
    if (classes)
        ewa_report(from->context, EWA_SEVERITY_INFO, "%s has %u classes, drawn in the colours of classes%s",
                   word, legend->category_count, automatic ? " (viridis shows the numbers)" : "");
    else
        ewa_report(from->context, EWA_SEVERITY_INFO, "colours: %s from %g to %g", word, legend->range[0],
                   legend->range[1]);
    return EWA_OK;
}

ewa_status ewa_cloud_color_by(ewa_cloud *cloud, const ewa_scalar *scalar, const ewa_color_scale *scale,
                              uint64_t *grey_count) {
    // Under a name of its own first: the colours themselves may be what is read.
    static const char made[] = "ewa_color_by";
    const uint64_t count = ewa_cloud_point_count(cloud);
    uint8_t(*colors)[3] = NULL;
    void *data = NULL;
    ewa_status status = ewa_cloud_add(cloud, made, EWA_U8, 3, (void **)&colors);
    double block[BLOCK];
    for (uint64_t first = 0; status == EWA_OK && first < count; first += BLOCK) {
        const uint64_t in_block = count - first < BLOCK ? count - first : BLOCK;
        ewa_scalar_read(scalar, first, in_block, block);
        for (uint64_t i = 0; i < in_block; i++)
            *grey_count += !find_color(scale, block[i], colors[first + i]);
    }
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &data);
    if (status == EWA_OK) memcpy(data, colors, 3 * count);
    ewa_cloud_remove(cloud, made);
    return status;
}

ewa_status ewa_cloud_tint(ewa_cloud *cloud, const double srgb[3]) {
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &data);
    uint8_t *colors = data;
    const uint64_t count = status == EWA_OK ? ewa_cloud_point_count(cloud) : 0;
    for (uint64_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) colors[3 * i + (uint64_t)c] = (uint8_t)(255 * srgb[c] + 0.5);
    return status;
}

/// Colours by an attribute.
static ewa_status color_by(const numbers *from, const ewa_coloring *coloring, ewa_legend *legend) {
    for (uint32_t k = 0; k < from->count; k++)
        EWA_TRY(ewa_cloud_find_scalar(from->clouds[k], coloring->attribute, &from->scalars[k]));
    legend->length = strcmp(from->scalars[0].attribute.name, EWA_POSITION) == 0;
    EWA_TRY(choose_scale(from, coloring, legend));
    const ewa_color_scale scale = ewa_color_scale_of(legend);
    uint64_t count = 0;
    for (uint32_t k = 0; k < from->count; k++) {
        EWA_TRY(ewa_cloud_color_by(from->clouds[k], &from->scalars[k], &scale, &legend->grey_count));
        count += ewa_cloud_point_count(from->clouds[k]);
    }
    if (legend->grey_count)
        ewa_report(from->context, EWA_SEVERITY_WARNING,
                   "%llu of %llu numbers of %s are %s; these points are drawn in grey",
                   (unsigned long long)legend->grey_count, (unsigned long long)count, coloring->attribute,
                   legend->classes ? "no classes" : "not finite");
    return EWA_OK;
}

bool ewa_asset_has_colors(const ewa_asset *asset) {
    ewa_lod_info info;
    ewa_lod_describe(asset->lod, &info);
    return ewa_cloud_find(info.prototype, EWA_COLOR) != NULL;
}

void ewa_cloud_drop_signals(ewa_cloud *cloud, const ewa_cloud *kept) {
    for (uint32_t k = ewa_cloud_attribute_count(cloud); k-- > 0;) {
        char name[EWA_NAME_BYTES];
        memcpy(name, ewa_cloud_attribute_at(cloud, k)->name, sizeof name);
        if (ewa_attribute_is_signal(name) && !ewa_cloud_find(kept, name)) ewa_cloud_remove(cloud, name);
    }
}

/// Whether a cloud has an attribute of one number that is called so.
static bool has_called(const ewa_cloud *cloud, const char *word) {
    const ewa_attribute *a;
    for (uint32_t k = 0; (a = ewa_cloud_attribute_at(cloud, k)); k++)
        if (a->component_count == 1 && ewa_attribute_names_agree(a->name, word)) return true;
    return false;
}

/// Whether a cloud has colours that show something: converters write black where they know none.
static bool has_colors(const ewa_cloud *cloud) {
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    if (!color) return false;
    if (color->component_count < 3 || color->component_count > 4) return true;
    double block[4 * BLOCK];
    const uint64_t count = ewa_cloud_point_count(cloud);
    for (uint64_t first = 0; first < count; first += BLOCK) {
        const uint64_t in_block = count - first < BLOCK ? count - first : BLOCK;
        ewa_attribute_read_f64(color, first, in_block, block);
        for (uint64_t i = 0; i < in_block * color->component_count; i++)
            if (i % color->component_count < 3 && block[i] != 0) return true;
    }
    return false;
}

/// Whether the points are of the ground: a grid of heights, or what a laser scanned, by what files of such scans have.
static bool is_surveyed(const ewa_cloud *cloud) {
    bool classes = false;
    const ewa_attribute *a;
    for (uint32_t k = 0; (a = ewa_cloud_attribute_at(cloud, k)); k++)
        classes = classes || ewa_coloring_names_classes(a->name);
    return classes || ewa_cloud_find(cloud, "return_number") || ewa_cloud_note(cloud, "file.heights", NULL);
}

/// Whether an attribute of a cloud is worth to be seen in place of colours.
static bool is_offered(const ewa_cloud *cloud, const char *word) {
    return strcmp(word, HEIGHT) == 0 ? is_surveyed(cloud) : has_called(cloud, word);
}

/// Has the clouds that offer an attribute, and have no colours yet, coloured by it where its numbers differ. `from` has
/// room for all.
static ewa_status choose_attribute(ewa_cloud **clouds, uint32_t count, const char *word, ewa_coloring **colorings,
                                   numbers *from) {
    static const ewa_coloring percentiles = {
        .ranged = true, .percent = {true, true}, .range = {SIGNAL_PERCENT_LOW, SIGNAL_PERCENT_HIGH}};
    double ends[2];
    uint32_t offered = 0; // these come first
    for (uint32_t k = 0; k < count; k++) {
        ewa_cloud *cloud = clouds[k];
        ewa_coloring *coloring = colorings[k];
        if (!ewa_coloring_is_auto(coloring->attribute) || !is_offered(cloud, word)) continue;
        clouds[k] = clouds[offered], clouds[offered] = cloud;
        colorings[k] = colorings[offered], colorings[offered] = coloring;
        EWA_TRY(ewa_cloud_find_scalar(cloud, word, &from->scalars[offered++]));
    }
    from->count = offered;
    if (offered) EWA_TRY(find_range(from, &percentiles, ends));
    if (!offered || !(ends[0] < ends[1])) return EWA_OK;
    for (uint32_t k = 0; k < offered; k++) {
        snprintf(colorings[k]->attribute, sizeof colorings[k]->attribute, "%s", word);
        if (!colorings[k]->ranged) memcpy(colorings[k]->range, ends, sizeof ends);
        colorings[k]->ranged = true;
    }
    ewa_report(from->context, EWA_SEVERITY_NOTE,
               "no colours: coloured by %s; ewa_coloring says otherwise (another number, or none)",
               strcmp(word, HEIGHT) == 0 ? "height (z)" : word);
    return EWA_OK;
}

ewa_status ewa_colorings_choose(ewa_cloud **clouds, uint32_t count, ewa_coloring **colorings) {
    uint32_t bare = 0;
    for (uint32_t k = 0; k < count; k++) {
        if (has_colors(clouds[k])) continue;
        clouds[bare] = clouds[k];
        colorings[bare++] = colorings[k];
    }
    if (!bare) return EWA_OK;
    ewa_context *context = ewa_cloud_context(clouds[0]);
    numbers from = {context, clouds, ewa_allocate_zeroed(context, bare, sizeof *from.scalars), 0};
    ewa_status status = from.scalars ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t i = 0; ewa_signal_name(i) && status == EWA_OK; i++)
        status = choose_attribute(clouds, bare, ewa_signal_name(i), colorings, &from);
    if (status == EWA_OK) status = choose_attribute(clouds, bare, HEIGHT, colorings, &from);
    ewa_release(context, from.scalars, bare, sizeof *from.scalars);
    return status;
}

ewa_status ewa_clouds_color(ewa_cloud *const *clouds, uint32_t count, const ewa_coloring *given,
                            ewa_legend *legend) {
    if (!clouds || !count || !legend) return EWA_ERROR_ARGUMENT;
    *legend = (ewa_legend){.context = NULL};
    ewa_context *context = ewa_cloud_context(clouds[0]);
    ewa_coloring coloring;
    EWA_TRY(ewa_coloring_take(context, given, &coloring));
    if (ewa_coloring_is_own(coloring.attribute)) {
        bool colored = !is_rgb(coloring.attribute);
        for (uint32_t k = 0; k < count; k++) colored = colored || ewa_cloud_find(clouds[k], EWA_COLOR);
        if (!colored) return ewa_fail(context, EWA_ERROR_ARGUMENT, "colours: there are none");
        for (uint32_t k = 0; k < count && coloring.tinted; k++)
            EWA_TRY(ewa_cloud_tint(clouds[k], coloring.tint));
        return EWA_OK;
    }
    numbers from = {context, clouds, ewa_allocate_zeroed(context, count, sizeof *from.scalars), count};
    if (!from.scalars) return EWA_ERROR_MEMORY;
    legend->context = context;
    memcpy(legend->attribute, coloring.attribute, sizeof legend->attribute);
    ewa_status status = color_by(&from, &coloring, legend);
    ewa_release(context, from.scalars, count, sizeof *from.scalars);
    if (status != EWA_OK) ewa_legend_free(legend);
    return status;
}
