// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which properties of a PLY file make up which attribute of a cloud, in both directions.
#include "base/base.h"
#include "io/cloud/ply.h"

#include <stdio.h>
#include <string.h>

enum { MAX_SPELLINGS = 3 };

/// How the type of an attribute follows from the types in the file.
typedef enum type_rule {
    RULE_FLOAT,    // float
    RULE_POSITION, // float where that is exact, else double
    RULE_COLOR,    // uchar, ushort and float mean shares of their range; other integers count from 0 to 255
} type_rule;

/// An attribute of several properties, or of one whose type has a rule. The first spelling is the one
/// written.
typedef struct group {
    const char *attribute;
    type_rule rule;
    uint32_t min_components, max_components;
    const char *spellings[MAX_SPELLINGS][4];
} group;

static const group groups[] = {
    {EWA_POSITION, RULE_POSITION, 3, 3, {{"x", "y", "z"}}},
    {EWA_NORMAL, RULE_FLOAT, 3, 3, {{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}}},
    {EWA_COLOR,
     RULE_COLOR,
     3,
     4,
     {{"red", "green", "blue", "alpha"},
      {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
      {"r", "g", "b", "a"}}},
    {EWA_RADIUS, RULE_FLOAT, 1, 1, {{"radius"}}},
    {EWA_TANGENT_U, RULE_FLOAT, 3, 3, {{"tu_x", "tu_y", "tu_z"}}},
    {EWA_TANGENT_V, RULE_FLOAT, 3, 3, {{"tv_x", "tv_y", "tv_z"}}},
    {EWA_CLIP0, RULE_FLOAT, 3, 3, {{"clip0_a", "clip0_b", "clip0_c"}}},
    {EWA_CLIP1, RULE_FLOAT, 3, 3, {{"clip1_a", "clip1_b", "clip1_c"}}},
    {EWA_BORDER, RULE_FLOAT, 3, 3, {{"border_x", "border_y", "border_z"}}},
};
enum { GROUP_COUNT = sizeof groups / sizeof groups[0] };

static const ewa_ply_property *find_scalar(const ewa_ply_header *header, const ewa_ply_element *element,
                                           const char *name) {
    const size_t length = strlen(name);
    for (uint32_t i = 0; i < element->property_count; i++) {
        const ewa_ply_property *property = &header->properties[element->first_property + i];
        if (!property->is_list && property->name.length == length &&
            memcmp(property->name.chars, name, length) == 0)
            return property;
    }
    return NULL;
}

static ewa_type color_type(ewa_type type) {
    if (type == EWA_F32 || type == EWA_F64) return EWA_F32;
    return type == EWA_U16 ? EWA_U16 : EWA_U8;
}

static ewa_type attribute_type(type_rule rule, const ewa_ply_column *column) {
    if (rule == RULE_COLOR) return color_type(column->sources[0]->type);
    if (rule == RULE_POSITION)
        for (uint32_t c = 0; c < column->component_count; c++) {
            const ewa_type part = column->sources[c]->type;
            if (part == EWA_F64 || part == EWA_I32 || part == EWA_U32) return EWA_F64;
        }
    return EWA_F32;
}

/// Fills a column when all properties of one spelling are there.
static bool match(const ewa_ply_header *header, const ewa_ply_element *element, const group *g,
                  ewa_ply_column *column) {
    for (uint32_t s = 0; s < MAX_SPELLINGS && g->spellings[s][0]; s++) {
        uint32_t found = 0;
        for (uint32_t c = 0; c < g->min_components; c++) {
            column->sources[c] = find_scalar(header, element, g->spellings[s][c]);
            found += column->sources[c] != NULL;
        }
        // Part of the first spelling would be left as scalars whose names the group is written under.
        if (s == 0 && found && found < g->min_components) return false;
        if (found < g->min_components) continue;
        column->component_count = g->min_components;
        if (g->rule == RULE_COLOR) {
            // Numbers that mean shares of different ranges are no colour.
            const ewa_type type = color_type(column->sources[0]->type);
            if (color_type(column->sources[1]->type) != type || color_type(column->sources[2]->type) != type)
                return false;
            const ewa_ply_property *alpha = find_scalar(header, element, g->spellings[0][3]);
            if (!alpha) alpha = find_scalar(header, element, g->spellings[s][3]);
            if (alpha && color_type(alpha->type) == type) column->sources[column->component_count++] = alpha;
        }
        memcpy(column->attribute, g->attribute, strlen(g->attribute) + 1);
        column->type = attribute_type(g->rule, column);
        return true;
    }
    return false;
}

static bool is_used(const ewa_ply_column *columns, uint32_t column_count, const ewa_ply_property *property) {
    for (uint32_t i = 0; i < column_count; i++)
        for (uint32_t c = 0; c < columns[i].component_count; c++)
            if (columns[i].sources[c] == property) return true;
    return false;
}

/// Whether a scalar can be an attribute under its own name; if not, says why.
static bool is_keepable(const ewa_ply_source *source, ewa_text name) {
    char quote[EWA_QUOTE_BYTES];
    if (name.length >= EWA_NAME_BYTES || !ewa_text_is_name(name)) {
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: property %s is left out: its name is not UTF-8 of at most %d bytes", source->name,
                   ewa_quote(name, quote), EWA_NAME_BYTES - 1);
        return false;
    }
    for (uint32_t g = 0; g < GROUP_COUNT; g++) {
        const size_t length = strlen(groups[g].attribute);
        if (groups[g].min_components > 1 && name.length == length &&
            memcmp(name.chars, groups[g].attribute, length) == 0) {
            ewa_report(source->context, EWA_SEVERITY_WARNING,
                       "%s: property %s is left out: an attribute of that name has %u components",
                       source->name, ewa_quote(name, quote), groups[g].min_components);
            return false;
        }
    }
    return true;
}

ewa_status ewa_ply_columns_map(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, ewa_ply_column *columns,
                               uint32_t *column_count) {
    uint32_t count = 0;
    for (uint32_t g = 0; g < GROUP_COUNT; g++) count += match(header, element, &groups[g], &columns[count]);
    if (count == 0 || strcmp(columns[0].attribute, EWA_POSITION) != 0) {
        if (find_scalar(header, element, "packed_position") &&
            find_scalar(header, element, "packed_rotation"))
            return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                            "%s: holds 3D Gaussians in PlayCanvas's compressed form (packed_position), which "
                            "is no cloud: ewa_gaussians_load() reads it",
                            source->name);
        const char *missing = "x";
        for (uint32_t c = 3; c-- > 0;)
            if (!find_scalar(header, element, groups[0].spellings[0][c])) missing = groups[0].spellings[0][c];
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the vertices have no number named '%s'",
                        source->name, missing);
    }
    for (uint32_t i = 0; i < element->property_count; i++) {
        const ewa_ply_property *property = &header->properties[element->first_property + i];
        if (property->is_list || is_used(columns, count, property) || !is_keepable(source, property->name))
            continue;
        ewa_ply_column *column = &columns[count++];
        column->type = property->type;
        column->component_count = 1;
        column->sources[0] = property;
        memcpy(column->attribute, property->name.chars, property->name.length);
        column->attribute[property->name.length] = 0;
    }
    *column_count = count;
    return EWA_OK;
}

void ewa_ply_property_name(const ewa_attribute *attribute, uint32_t component,
                           char name[EWA_PLY_NAME_BYTES]) {
    for (uint32_t g = 0; g < GROUP_COUNT; g++) {
        if (strcmp(attribute->name, groups[g].attribute) != 0 ||
            attribute->component_count < groups[g].min_components ||
            attribute->component_count > groups[g].max_components)
            continue;
        snprintf(name, EWA_PLY_NAME_BYTES, "%s", groups[g].spellings[0][component]);
        return;
    }
    if (attribute->component_count == 1)
        snprintf(name, EWA_PLY_NAME_BYTES, "%s", attribute->name);
    else
        snprintf(name, EWA_PLY_NAME_BYTES, "%s_%u", attribute->name, component);
    for (char *c = name; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == 0x7f) *c = '_';
}
