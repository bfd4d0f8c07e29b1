// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers of places and cells that have a name in a file of meshes: they become attributes of vertices and points.
#include "base/base.h"
#include "io/mesh/build.h"

#include <math.h>
#include <stdio.h>

enum { MAX_ARRAYS = 256, MAX_COMPONENTS = 4, SAID = 4 };

/// Attributes that have a meaning, which a file of meshes does not mean by such a name.
static bool is_taken(const char *name) {
    static const char *const taken[] = {EWA_POSITION,  EWA_NORMAL, EWA_COLOR, EWA_RADIUS, EWA_TANGENT_U,
                                        EWA_TANGENT_V, EWA_MATERIAL, EWA_SURFACENESS, EWA_CURVATURE, EWA_CLIP0,
                                        EWA_CLIP1,     EWA_CLIP_MODE, EWA_BORDER};
    for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++)
        if (strcmp(name, taken[i]) == 0) return true;
    return false;
}

static void say_left_out(const ewa_mesh_build *build, ewa_text name, const char *why) {
    char quote[EWA_QUOTE_BYTES];
    ewa_report(build->context, EWA_SEVERITY_INFO, "%s: array %s is left out: %s", build->source->name, ewa_quote(name, quote),
               why);
}

static void prefix(char name[EWA_NAME_BYTES], const char *before) {
    const size_t length = strlen(before);
    memmove(name + length, name, strlen(name) + 1);
    memcpy(name, before, length);
}

static ewa_mesh_array *find(const ewa_mesh_build *build, const char *name) {
    ewa_mesh_array *arrays = build->arrays.items;
    for (uint64_t i = 0; i < build->arrays.count; i++)
        if (strcmp(arrays[i].name, name) == 0) return &arrays[i];
    return NULL;
}

ewa_status ewa_mesh_find_array(ewa_mesh_build *build, bool of_cells, ewa_text name, ewa_type type, uint64_t component_count,
                               uint64_t first, ewa_mesh_array **array) {
    static const char before[] = "scalar_";
    char kept[EWA_NAME_BYTES];
    *array = NULL;
    const bool short_enough = name.length && name.length + sizeof before <= sizeof kept;
    if (short_enough) {
        snprintf(kept, sizeof kept, "%.*s", (int)name.length, name.chars);
        // Names are words of PLY and of filters.
        for (char *c = kept; *c; c++) *c = *c == ' ' ? '_' : *c;
    }
    if (!short_enough || !ewa_text_is_name((ewa_text){kept, strlen(kept)})) {
        say_left_out(build, name, "its name is not UTF-8 of at most 56 bytes");
        return EWA_OK;
    }
    if (component_count < 1 || component_count > MAX_COMPONENTS) {
        say_left_out(build, name, "it has not from 1 to 4 numbers for each point");
        return EWA_OK;
    }
    if (is_taken(kept)) prefix(kept, before);
    *array = find(build, kept);
    if (*array && (*array)->of_cells != of_cells && strlen(kept) + sizeof before <= sizeof kept) {
        prefix(kept, of_cells ? "cell_" : "point_");
        *array = find(build, kept);
    }
    const ewa_mesh_array *same = *array;
    if (same && (same->of_cells != of_cells || same->type != type || same->component_count != component_count || same->values.count > first)) {
        say_left_out(build, name, "there is one of that name");
        *array = NULL;
    } else if (!same && build->arrays.count == MAX_ARRAYS) {
        say_left_out(build, name, "there are 256 before it");
    } else if (!same) {
        ewa_status status = EWA_OK;
        *array = ewa_mesh_list_add(build, &build->arrays, &status);
        if (!*array) return status;
        **array = (ewa_mesh_array){.type = type, .component_count = (uint32_t)component_count, .of_cells = of_cells};
        build->has_cell_data |= of_cells;
        (*array)->values.item_bytes = (uint32_t)(component_count * ewa_type_bytes(type));
        memcpy((*array)->name, kept, sizeof kept);
    }
    static const double unknown[MAX_COMPONENTS] = {NAN, NAN, NAN, NAN};
    while (*array && (*array)->values.count < first) EWA_TRY(ewa_mesh_add_numbers(build, *array, unknown));
    return EWA_OK;
}

/// A number as a whole one within a range; what is none is 0.
static int64_t whole(double number, double low, double high) {
    return number >= low && number <= high ? (int64_t)number : 0;
}

static void store(ewa_type type, double number, uint8_t *to) {
    const int64_t integer = whole(number, INT32_MIN, UINT32_MAX);
    const float single = (float)number;
    switch (type) {
    case EWA_F32:
        memcpy(to, &single, sizeof single);
        return;
    case EWA_F64:
        memcpy(to, &number, sizeof number);
        return;
    case EWA_I8:
    case EWA_U8:
        *to = (uint8_t)integer;
        return;
    case EWA_I16:
    case EWA_U16:
        memcpy(to, &(uint16_t){(uint16_t)integer}, sizeof(uint16_t));
        return;
    default:
        memcpy(to, &(uint32_t){(uint32_t)integer}, sizeof(uint32_t));
    }
}

ewa_status ewa_mesh_add_numbers(ewa_mesh_build *build, ewa_mesh_array *array, const double *numbers) {
    ewa_status status = EWA_OK;
    uint8_t *to = ewa_mesh_list_add(build, &array->values, &status);
    for (uint32_t c = 0; to && c < array->component_count; c++)
        store(array->type, numbers[c], to + c * ewa_type_bytes(array->type));
    return status;
}

/// Says which arrays points alone do not have, the first few by name.
static void say_of_cells(const ewa_mesh_build *build) {
    const ewa_mesh_array *arrays = build->arrays.items;
    char names[SAID * (EWA_NAME_BYTES + 2) + 8] = "";
    size_t at = 0, count = 0;
    for (uint64_t a = 0; a < build->arrays.count; a++) {
        if (!arrays[a].of_cells || count++ > SAID) continue;
        at += (size_t)snprintf(names + at, sizeof names - at, "%s%s", at ? ", " : "", count > SAID ? "..." : arrays[a].name);
    }
    if (count)
        ewa_report(build->context, EWA_SEVERITY_NOTE, "%s: numbers of cells (%s): faces have them as they are drawn, points do not",
                   build->source->name, names);
}

/// The type that vertices get: of wide whole numbers one of four bytes, where that holds all of them.
static ewa_type final_type(const ewa_mesh_array *array) {
    const double *numbers = array->values.items;
    const uint64_t count = array->wide ? array->values.count * array->component_count : 0;
    for (uint64_t i = 0; i < count; i++)
        if (!(numbers[i] >= INT32_MIN && numbers[i] <= INT32_MAX && numbers[i] == floor(numbers[i]))) return array->type;
    return array->wide ? EWA_I32 : array->type;
}

ewa_status ewa_mesh_fill_arrays(const ewa_mesh_build *build, const uint32_t *places, const uint32_t *cells, size_t stride,
                                ewa_cloud *cloud) {
    const ewa_mesh_array *arrays = build->arrays.items;
    const uint64_t count = ewa_cloud_point_count(cloud);
    if (!cells) say_of_cells(build);
    for (uint64_t a = 0; a < build->arrays.count; a++) {
        const ewa_mesh_array *array = &arrays[a];
        const ewa_type type = final_type(array);
        const uint32_t *numbers = array->of_cells ? cells : places;
        const size_t number_bytes = ewa_type_bytes(type), bytes = array->component_count * number_bytes;
        void *data;
        if (array->of_cells && !cells) continue;
        EWA_TRY(ewa_memory_check(build->context, count * bytes, "%s: array %s", build->source->name, array->name));
        EWA_TRY(ewa_cloud_add(cloud, array->name, type, array->component_count, &data));
        uint8_t *to = data;
        for (uint64_t i = 0; i < count; i++, to += bytes) {
            const uint64_t place = numbers ? numbers[i * stride] : i;
            const bool is_there = place < array->values.count;
            if (is_there && type == array->type) {
                memcpy(to, (const uint8_t *)array->values.items + place * bytes, bytes);
                continue;
            }
            const double *wide = is_there ? (const double *)array->values.items + place * array->component_count : NULL;
            for (uint32_t c = 0; c < array->component_count; c++) store(type, wide ? wide[c] : NAN, to + c * number_bytes);
        }
    }
    return EWA_OK;
}
