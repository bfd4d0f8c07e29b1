// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scene files: what the members of their options, lights, planes, regions and measurements set.
#include "base/base.h"
#include "io/number.h"
#include "scene/file.h"
#include "scene/region.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define LIGHT(member) offsetof(ewa_light, member)

const ewa_option ewa_scene_light_rows[EWA_SCENE_LIGHT_ROWS] = {
    {"direction_world", EWA_OPTION_F64, LIGHT(direction_world), -INFINITY, INFINITY,
     EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3, .initial = 0},
    {"color", EWA_OPTION_F32, LIGHT(color), 0, 1e6, .count = 3, .initial = 1},
};

static const ewa_option plane_row = {
    "section_planes", EWA_OPTION_F64, 0, -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 4,
    .initial = 0};

const ewa_option_table *ewa_scene_section_table(ewa_scene_section section, ewa_scene_options *options,
                                                void **part) {
    switch (section) {
    case EWA_SCENE_OPTIONS:
        *part = options;
        return &ewa_scene_options_table;
    case EWA_SCENE_SURFELS:
        *part = &options->surfels;
        return &ewa_surfels_options_table;
    case EWA_SCENE_LOD:
        *part = &options->lod;
        return &ewa_lod_options_table;
    case EWA_SCENE_RENDER:
        *part = &options->render;
        return &ewa_render_options_table;
    case EWA_SCENE_GAUSSIANS:
        *part = &options->gaussians;
        return &ewa_gaussian_options_table;
    default:
        *part = &options->volumes;
        return &ewa_volume_options_table;
    }
}

bool ewa_scene_option_is_kept(const ewa_option *option) {
    // How many there are is as many as there stand in the file; what stays in memory is nothing of a picture.
    return strcmp(option->name, "light_count") != 0 && strcmp(option->name, "section_count") != 0 &&
           strcmp(option->name, "region_count") != 0 && strcmp(option->name, "keep_points") != 0;
}

bool ewa_scene_option_is_same(const ewa_option *option, const void *options, const void *others) {
    static const size_t sizes[] = {[EWA_OPTION_BOOL] = sizeof(bool),    [EWA_OPTION_CHOICE] = sizeof(int32_t),
                                   [EWA_OPTION_U32] = sizeof(uint32_t), [EWA_OPTION_U64] = sizeof(uint64_t),
                                   [EWA_OPTION_F32] = sizeof(float),    [EWA_OPTION_F64] = sizeof(double)};
    const size_t size = sizes[option->type] * (option->count ? option->count : 1);
    return memcmp((const char *)options + option->offset, (const char *)others + option->offset, size) == 0;
}

ewa_status ewa_scene_fail_at(const ewa_scene_reading *in, const ewa_scene_member *member, const char *what) {
    char place[EWA_SCENE_PLACE_BYTES];
    ewa_scene_text_place(member, place);
    return ewa_fail(in->text->context, EWA_ERROR_FORMAT, "%s: %s: %s", in->path, place, what);
}

ewa_status ewa_scene_set_option(const ewa_scene_reading *in, const ewa_scene_member *member, const ewa_option *option,
                                void *options) {
    char problem[EWA_OPTION_TEXT_BYTES];
    if (ewa_option_set(option, options, ewa_scene_text_value(in->text, member), problem) == EWA_OK)
        return EWA_OK;
    return ewa_scene_fail_at(in, member, problem);
}

/// Sets what a member of "options" says; `only_defaults`: where the options have their default.
static ewa_status apply_member(const ewa_scene_reading *in, const ewa_scene_member *member, bool only_defaults,
                               ewa_scene_options *options) {
    ewa_scene_options defaults;
    void *part, *initial;
    const ewa_option_table *table = ewa_scene_section_table(member->section, options, &part);
    const ewa_option *option = ewa_option_find(table, member->name);
    if (!option || !ewa_scene_option_is_kept(option))
        return ewa_scene_fail_at(in, member, "no scene has such an option");
    ewa_scene_options_init(&defaults, sizeof defaults);
    (void)ewa_scene_section_table(member->section, &defaults, &initial);
    return only_defaults && !ewa_scene_option_is_same(option, part, initial)
               ? EWA_OK
               : ewa_scene_set_option(in, member, option, part);
}

static ewa_status apply_light(const ewa_scene_reading *in, const ewa_scene_member *member, ewa_scene_options *options) {
    for (int i = 0; i < EWA_SCENE_LIGHT_ROWS; i++)
        if (strcmp(ewa_scene_light_rows[i].name, member->name) == 0)
            return ewa_scene_set_option(in, member, &ewa_scene_light_rows[i], &options->render.lights[member->index]);
    return ewa_scene_fail_at(in, member, "no light has such a member");
}

static ewa_status apply_plane(const ewa_scene_reading *in, const ewa_scene_member *member, ewa_scene_options *options) {
    double *plane = options->render.section_planes[member->index];
    EWA_TRY(ewa_scene_set_option(in, member, &plane_row, plane));
    if (plane[0] == 0 && plane[1] == 0 && plane[2] == 0) return ewa_scene_fail_at(in, member, "its normal is 0, 0, 0");
    return EWA_OK;
}

/// Reads numbers separated by commas; false: they are none, or more than `maximum`.
static bool read_numbers(const char *text, uint32_t maximum, double *numbers, uint32_t *count) {
    const char *last = text + strlen(text);
    for (*count = 0;; text++) {
        const char *end = *count < maximum ? ewa_number_read_f64(text, last, &numbers[*count]) : NULL;
        if (!end || end == text || !isfinite(numbers[*count])) return false;
        ++*count;
        if (!*end) return true;
        if (*end != ',') return false;
        text = end;
    }
}

/// Sets the classes of a region.
static bool set_classes(const double *codes, uint32_t count, ewa_region *region) {
    region->has_classes = true;
    for (uint32_t i = 0; i < count; i++) {
        if (!(codes[i] >= 0 && codes[i] < EWA_REGION_CLASSES && codes[i] == floor(codes[i]))) return false;
        const uint32_t code = (uint32_t)codes[i];
        region->classes[code / 32] |= (uint32_t)1 << code % 32;
    }
    return true;
}

static ewa_status apply_region(const ewa_scene_reading *in, const ewa_scene_member *member, ewa_scene_options *options) {
    const char *value = ewa_scene_text_value(in->text, member), *name = member->name;
    ewa_region *region = &options->regions[member->index];
    double numbers[EWA_REGION_CLASSES];
    uint32_t count = 0;
    if (strcmp(name, "keep") == 0) {
        region->kept = strcmp(value, "on") == 0;
        return region->kept || strcmp(value, "off") == 0 ? EWA_OK
                                                         : ewa_scene_fail_at(in, member, "is neither true nor false");
    }
    const bool fine = read_numbers(value, EWA_REGION_CLASSES, numbers, &count);
    if (strcmp(name, "box") == 0) {
        region->has_box = true;
        if (!fine || count != 6 || !ewa_region_is_box(numbers))
            return ewa_scene_fail_at(in, member, "is not 6 numbers: the lower and the upper corner");
        memcpy(region->box_world, numbers, sizeof region->box_world);
        return EWA_OK;
    }
    if (strcmp(name, "box_axes") == 0) {
        if (!fine || count != 9) return ewa_scene_fail_at(in, member, "is not 9 numbers: three axes");
        memcpy(region->box_axes_world, numbers, sizeof region->box_axes_world);
        return EWA_OK;
    }
    if (strcmp(name, "classes") == 0)
        return fine && set_classes(numbers, count, region)
                   ? EWA_OK
                   : ewa_scene_fail_at(in, member, "is no list of codes from 0 to 255");
    if (strcmp(name, "outline") == 0) {
        if (!fine || count % 2 || count < 6 || count > 2 * EWA_REGION_CORNERS)
            return ewa_scene_fail_at(in, member, "is not 3 to 64 corners x, y");
        region->corner_count = count / 2;
        memcpy(region->outline_px, numbers, count * sizeof numbers[0]);
        return EWA_OK;
    }
    if (strcmp(name, "world_to_picture") == 0) {
        if (!fine || count != 12) return ewa_scene_fail_at(in, member, "is not 12 numbers");
        memcpy(region->world_to_picture, numbers, sizeof region->world_to_picture);
        return EWA_OK;
    }
    return ewa_scene_fail_at(in, member, "no region has such a member");
}

static ewa_status set_measure(const ewa_scene_reading *in, const ewa_scene_member *member, ewa_measure *measure) {
    const char *value = ewa_scene_text_value(in->text, member), *word;
    if (strcmp(member->name, "kind") == 0) {
        for (uint32_t k = 0; (word = ewa_measure_kind_name(k)); k++) {
            measure->kind = (ewa_measure_kind)k;
            if (strcmp(value, word) == 0) return EWA_OK;
        }
        return ewa_scene_fail_at(in, member, "is no kind of measurement");
    }
    if (strcmp(member->name, "name") == 0) {
        if (strlen(value) >= sizeof measure->name) return ewa_scene_fail_at(in, member, "is too long a name");
        snprintf(measure->name, sizeof measure->name, "%s", value);
        return EWA_OK;
    }
    if (strcmp(member->name, "places_world") != 0) return ewa_scene_fail_at(in, member, "no measurement has such a member");
    const bool fine = read_numbers(value, 3 * EWA_MEASURE_PLACES, measure->places_world, &measure->count) && measure->count % 3 == 0;
    measure->count /= 3;
    return fine ? EWA_OK : ewa_scene_fail_at(in, member, "is not up to 64 places x, y, z");
}

ewa_status ewa_scene_read_measures(const ewa_scene_reading *in, ewa_measure *measures) {
    static const double up_world[3] = {0, 0, 1};
    const ewa_scene_text *text = in->text;
    for (size_t i = 0; i < text->member_count; i++)
        if (text->members[i].section == EWA_SCENE_MEASURE)
            EWA_TRY(set_measure(in, &text->members[i], &measures[text->members[i].index]));
    for (uint32_t i = 0; i < text->measure_count; i++) {
        ewa_measurement measured;
        const ewa_scene_member at = {EWA_SCENE_MEASURE, i, NULL, 0};
        if (ewa_places_measure(measures[i].kind, measures[i].places_world, measures[i].count, up_world, &measured) != EWA_OK)
            return ewa_scene_fail_at(in, &at, "has not the places of its kind");
    }
    return EWA_OK;
}

ewa_status ewa_scene_apply_text(const ewa_scene_reading *in, bool only_defaults, ewa_scene_options *options) {
    const ewa_scene_text *text = in->text;
    if (text->light_count > EWA_MAX_LIGHTS || text->section_count > EWA_MAX_SECTION_PLANES)
        return ewa_fail(text->context, EWA_ERROR_LIMIT,
                        "%s: %u lights and %u section planes; there may be %d and %d", in->path,
                        text->light_count, text->section_count, EWA_MAX_LIGHTS, EWA_MAX_SECTION_PLANES);
    const bool lit = only_defaults && options->render.light_count,
               cut = only_defaults && options->render.section_count;
    if (text->region_count > EWA_MAX_REGIONS)
        return ewa_fail(text->context, EWA_ERROR_LIMIT, "%s: %u regions; there may be %d", in->path, text->region_count,
                        EWA_MAX_REGIONS);
    const bool hidden = only_defaults && options->region_count;
    for (uint32_t i = 0; i < text->light_count && !lit; i++) ewa_light_init(&options->render.lights[i]);
    // Their members add to what is there, which may be regions that have been taken out.
    if (!hidden) memset(options->regions, 0, text->region_count * sizeof options->regions[0]);
    ewa_status status = EWA_OK;
    for (size_t i = 0; i < text->member_count && status == EWA_OK; i++) {
        const ewa_scene_member *member = &text->members[i];
        if (member->section == EWA_SCENE_ITEM || member->section == EWA_SCENE_MEASURE) continue;
        if (member->section == EWA_SCENE_LIGHT)
            status = lit ? EWA_OK : apply_light(in, member, options);
        else if (member->section == EWA_SCENE_REGION)
            status = hidden ? EWA_OK : apply_region(in, member, options);
        else if (member->section == EWA_SCENE_SECTION_PLANE)
            status = cut ? EWA_OK : apply_plane(in, member, options);
        else
            status = apply_member(in, member, only_defaults, options);
    }
    if (!lit && text->light_count) options->render.light_count = text->light_count;
    if (!cut && text->section_count) options->render.section_count = text->section_count;
    if (!hidden && text->region_count) options->region_count = text->region_count;
    return status;
}
