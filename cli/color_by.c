// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours from an attribute.
#include "color_by.h"
#include "rank.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// sRGB of numbers that are not finite.
static const uint8_t GREY_SRGB = 128;

static bool find_component(const ewa_cloud *cloud, const char *attribute_name, const char *component_name,
                           char name[EWA_NAME_BYTES], uint32_t *component) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, attribute_name);
    if (!attribute) return false;
    static const char letters[] = "xyzw", colors[] = "rgba";
    *component = 0;
    if (component_name) {
        if (!component_name[0] || component_name[1]) return false;
        const char *at = strchr(letters, component_name[0]);
        if (at)
            *component = (uint32_t)(at - letters);
        else if ((at = strchr(colors, component_name[0])))
            *component = (uint32_t)(at - colors);
        else
            return false;
    }
    snprintf(name, EWA_NAME_BYTES, "%s", attribute->name);
    return *component < attribute->component_count;
}

bool color_by_find(cli_session *session, const ewa_cloud *cloud, const char *word, char name[EWA_NAME_BYTES],
                   uint32_t *component) {
    if (find_component(cloud, word, NULL, name, component)) return true;
    if (strlen(word) == 1 && strchr("xyz", word[0]) &&
        find_component(cloud, EWA_POSITION, word, name, component))
        return true;
    const char *dot = strrchr(word, '.');
    char attribute_name[EWA_NAME_BYTES];
    if (dot && dot - word < EWA_NAME_BYTES) {
        snprintf(attribute_name, sizeof attribute_name, "%.*s", (int)(dot - word), word);
        if (find_component(cloud, attribute_name, dot + 1, name, component)) return true;
    }
    char list[512] = "";
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "", attribute->name);
    }
    session_fail(session, "--color-by: there is no attribute '%s'; there are %s", word, list);
    return false;
}

/// One component of an attribute, in world units.
typedef struct scalar {
    ewa_attribute attribute;
    uint32_t component;
    double shift; ///< added to the stored numbers
    uint64_t count;
} scalar;

static double read_scalar(const scalar *from, uint64_t index) {
    double numbers[4];
    ewa_attribute_read_f64(&from->attribute, index, 1, numbers);
    return numbers[from->component] + from->shift;
}

/// Finds the numbers of the first and the last colour; false after reporting.
static bool find_range(cli_session *session, const scalar *from, const option_bounds *range, double ends[2]) {
    const option_bounds all = {.values = {0, 100}, .percent = {true, true}};
    if (!range->given) range = &all;
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
        ends[end] = count ? rank_select(numbers, count, (size_t)(place + 0.5)) : 0;
    }
    free(numbers);
    return true;
}

bool color_by(cli_session *session, ewa_cloud *cloud, const char *word, ewa_colormap colormap,
              const option_bounds *range) {
    char name[EWA_NAME_BYTES];
    uint32_t component;
    if (!color_by_find(session, cloud, word, name, &component)) return false;
    const uint64_t count = ewa_cloud_point_count(cloud);
    scalar from = {*ewa_cloud_find(cloud, name), component, 0, count};
    if (strcmp(name, EWA_POSITION) == 0) {
        double origin_world[3] = {0, 0, 0};
        ewa_cloud_origin(cloud, origin_world);
        from.shift = origin_world[component];
    }
    double ends[2];
    if (!find_range(session, &from, range, ends)) return false;
    session_say(session, "--color-by: %s from %g to %g", word, ends[0], ends[1]);
    const double extent = ends[1] - ends[0];
    uint8_t(*colors)[3] = NULL;
    // Under a name of its own first: the colours themselves may be what is read.
    static const char made[] = "ewa_color_by";
    ewa_status status = ewa_cloud_add(cloud, made, EWA_U8, 3, (void **)&colors);
    uint64_t grey_count = 0;
    for (uint64_t i = 0; status == EWA_OK && i < count; i++) {
        const double number = read_scalar(&from, i);
        if (isfinite(number))
            ewa_colormap_color(colormap, extent != 0 ? (number - ends[0]) / extent : 0.5, colors[i]);
        else
            memset(colors[i], GREY_SRGB, 3);
        grey_count += !isfinite(number);
    }
    void *data = NULL;
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &data);
    if (status == EWA_OK) memcpy(data, colors, 3 * count);
    ewa_cloud_remove(cloud, made);
    if (status != EWA_OK) session_failed(session, status);
    if (status == EWA_OK && grey_count)
        session_warn(session,
                     "--color-by: %llu of %llu numbers of %s are not finite; these points are drawn in grey",
                     (unsigned long long)grey_count, (unsigned long long)count, word);
    return status == EWA_OK;
}
