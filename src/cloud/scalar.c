// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One number of each point, by the words that people use for it.
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/select.h"

#include <stdio.h>
#include <string.h>

enum { BLOCK_POINTS = 256, LIST_BYTES = 640 };

/// Words for components of attributes that have names of their own.
static const struct {
    const char *word, *attribute;
    uint32_t component;
} synonyms[] = {
    {"x", EWA_POSITION, 0}, {"y", EWA_POSITION, 1},  {"z", EWA_POSITION, 2}, {"nx", EWA_NORMAL, 0},
    {"ny", EWA_NORMAL, 1},  {"nz", EWA_NORMAL, 2},   {"red", EWA_COLOR, 0},  {"green", EWA_COLOR, 1},
    {"blue", EWA_COLOR, 2}, {"alpha", EWA_COLOR, 3},
};

enum { SYNONYM_COUNT = sizeof synonyms / sizeof synonyms[0] };

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

bool ewa_attribute_names_agree(const char *a, const char *b) {
    static const char before[] = "scalar_";
    if (strncmp(a, before, sizeof before - 1) == 0) a += sizeof before - 1;
    if (strncmp(b, before, sizeof before - 1) == 0) b += sizeof before - 1;
    for (;; a++, b++) {
        while (*a == '_') a++;
        while (*b == '_') b++;
        if (lower(*a) != lower(*b)) return false;
        if (!*a) return true;
    }
}

const char *ewa_signal_name(uint32_t index) {
    static const char *const names[] = {"intensity", "reflectance", "amplitude", "nir"};
    return index < sizeof names / sizeof names[0] ? names[index] : NULL;
}

bool ewa_attribute_is_signal(const char *name) {
    for (uint32_t i = 0; ewa_signal_name(i); i++)
        if (ewa_attribute_names_agree(name, ewa_signal_name(i))) return true;
    return false;
}

static const ewa_attribute *find_attribute(const ewa_cloud *cloud, const char *name, bool loosely) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    for (uint32_t k = 0; !attribute && loosely && (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        if (ewa_attribute_names_agree(attribute->name, name)) break;
        attribute = NULL;
    }
    return attribute;
}

/// Splits "NAME.x" or "NAME.r"; false when a word is not of that form.
static bool split(const char *word, char name[EWA_NAME_BYTES], uint32_t *component) {
    static const char axes[] = "xyzw", colors[] = "rgba";
    const char *dot = strrchr(word, '.');
    if (!dot || dot == word || !dot[1] || dot[2] || dot - word >= EWA_NAME_BYTES) return false;
    const char *axis = strchr(axes, dot[1]), *color = strchr(colors, dot[1]);
    *component = (uint32_t)(axis ? axis - axes : color ? color - colors : 4);
    memcpy(name, word, (size_t)(dot - word));
    name[dot - word] = 0;
    return *component < 4;
}

/// Finds an attribute that has the component; the same name first, then a name that is alike.
static const ewa_attribute *find_component(const ewa_cloud *cloud, const char *word, uint32_t *component) {
    char name[EWA_NAME_BYTES];
    for (int loosely = 0; loosely < 2; loosely++) {
        *component = 0;
        const ewa_attribute *found = find_attribute(cloud, word, loosely);
        if (found) return found;
        for (size_t i = 0; i < SYNONYM_COUNT; i++) {
            const char *synonym = synonyms[i].word;
            if (!(loosely ? ewa_attribute_names_agree(word, synonym) : strcmp(word, synonym) == 0)) continue;
            found = ewa_cloud_find(cloud, synonyms[i].attribute);
            *component = synonyms[i].component;
            if (found && *component < found->component_count) return found;
        }
        if (!split(word, name, component)) continue;
        found = find_attribute(cloud, name, loosely);
        if (found && *component < found->component_count) return found;
    }
    return NULL;
}

bool ewa_cloud_has_scalar(const ewa_cloud *cloud, const char *word) {
    uint32_t component;
    return find_component(cloud, word, &component) != NULL;
}

/// Lists the attributes with the words for their components; "..." stands for those that find no room.
static void list_attributes(const ewa_cloud *cloud, char list[LIST_BYTES]) {
    size_t used = 0;
    list[0] = 0;
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        if (used + EWA_NAME_BYTES + 32 > LIST_BYTES) {
            snprintf(list + used, LIST_BYTES - used, ", ...");
            return;
        }
        used += (size_t)snprintf(list + used, LIST_BYTES - used, "%s%s", k ? ", " : "", attribute->name);
        const char *before = " (";
        for (size_t i = 0; i < SYNONYM_COUNT; i++) {
            if (strcmp(synonyms[i].attribute, attribute->name) != 0 ||
                synonyms[i].component >= attribute->component_count)
                continue;
            used += (size_t)snprintf(list + used, LIST_BYTES - used, "%s%s", before, synonyms[i].word);
            before = " ";
        }
        if (before[1] == 0) used += (size_t)snprintf(list + used, LIST_BYTES - used, ")");
    }
}

ewa_status ewa_cloud_find_scalar(const ewa_cloud *cloud, const char *word, ewa_scalar *scalar) {
    if (!cloud || !word || !scalar) return EWA_ERROR_ARGUMENT;
    uint32_t component;
    const ewa_attribute *found = find_component(cloud, word, &component);
    if (!found) {
        char list[LIST_BYTES];
        list_attributes(cloud, list);
        return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
                        "there is no attribute '%.80s'; there are %s", word, list);
    }
    *scalar = (ewa_scalar){.attribute = *found, .component = component};
    if (strcmp(found->name, EWA_POSITION) != 0 || component > 2) return EWA_OK;
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    ewa_cloud_grid(cloud, &scalar->grid);
    scalar->shift_world = origin_world[component];
    return EWA_OK;
}

void ewa_scalar_read(const ewa_scalar *scalar, uint64_t first, uint64_t count, double *numbers) {
    const ewa_attribute *attribute = &scalar->attribute;
    const uint32_t component = scalar->component, components = attribute->component_count;
    if (components == 1) {
        ewa_attribute_read_f64(attribute, first, count, numbers);
    } else {
        double block[4 * BLOCK_POINTS];
        for (uint64_t done = 0; done < count; done += BLOCK_POINTS) {
            const uint64_t taken = count - done < BLOCK_POINTS ? count - done : BLOCK_POINTS;
            ewa_attribute_read_f64(attribute, first + done, taken, block);
            for (uint64_t i = 0; i < taken; i++) numbers[done + i] = block[i * components + component];
        }
    }
    if (scalar->shift_world != 0)
        for (uint64_t i = 0; i < count; i++) numbers[i] += scalar->shift_world;
    if (component < 3 && scalar->grid.step_world[component] > 0)
        for (uint64_t i = 0; i < count; i++)
            numbers[i] = ewa_grid_world(&scalar->grid, component, numbers[i]);
}
