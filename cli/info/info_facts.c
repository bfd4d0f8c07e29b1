// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a file of points says beside its numbers, for ewa info.
#include "cli/info/info_facts.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { LINE_BYTES = 160, BLOCK_POINTS = 512 };

static const char FACT[] = "file.";

/// Cuts text to one line that can be printed.
static void take_line(const char *text, char line[LINE_BYTES]) {
    size_t length = 0;
    for (; text[length] && text[length] != '\n' && length < LINE_BYTES - 4; length++)
        line[length] = (char)((unsigned char)text[length] < ' ' || text[length] == 127 ? '?' : text[length]);
    memcpy(line + length, text[length] ? "..." : "", text[length] ? 4 : 1);
}

static bool is_fact(const char *name) { return strncmp(name, FACT, sizeof FACT - 1) == 0; }

/// The name of the coordinate reference system, else its text; NULL when there is none.
static const char *find_crs(const ewa_cloud *cloud) {
    const char *name = ewa_cloud_note(cloud, "crs_name", NULL);
    return name ? name : ewa_cloud_note(cloud, "crs", NULL);
}

/// Whether the coordinates lie on a grid, by one axis at least.
static bool has_grid(const ewa_coordinate_grid *grid) {
    return grid->step_world[0] > 0 || grid->step_world[1] > 0 || grid->step_world[2] > 0;
}

void info_facts_print(const ewa_cloud *cloud) {
    char line[LINE_BYTES];
    const char *crs = find_crs(cloud), *name;
    if (crs) {
        take_line(crs, line);
        printf("  crs         %s\n", line);
    }
    ewa_coordinate_grid grid;
    ewa_cloud_grid(cloud, &grid);
    if (has_grid(&grid)) {
        printf("  scale       %.10g %.10g %.10g\n", grid.step_world[0], grid.step_world[1],
               grid.step_world[2]);
        printf("  offset      %.15g %.15g %.15g\n", grid.offset_world[0], grid.offset_world[1],
               grid.offset_world[2]);
    }
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    if (origin_world[0] || origin_world[1] || origin_world[2])
        printf("  origin      %.15g %.15g %.15g\n", origin_world[0], origin_world[1], origin_world[2]);
    bool headed = false;
    for (uint32_t i = 0; (name = ewa_cloud_note_name(cloud, i)); i++) {
        if (!is_fact(name)) continue;
        if (!headed) printf("  of the file\n");
        headed = true;
        take_line(ewa_cloud_note(cloud, name, NULL), line);
        printf("    %-20s %s\n", name + sizeof FACT - 1, line);
    }
}

void info_facts_write(json_writer *json, const ewa_cloud *cloud) {
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    const char *crs = find_crs(cloud), *name;
    if (crs) {
        char line[LINE_BYTES];
        take_line(crs, line);
        json_text(json, "crs_name", line);
        if (ewa_cloud_note(cloud, "crs", NULL)) json_text(json, "crs", ewa_cloud_note(cloud, "crs", NULL));
    }
    ewa_coordinate_grid grid;
    ewa_cloud_grid(cloud, &grid);
    if (has_grid(&grid)) {
        json_vector(json, "scale", 3, grid.step_world);
        json_vector(json, "offset", 3, grid.offset_world);
    }
    json_vector(json, "origin", 3, origin_world);
    json_object(json, "of_the_file");
    for (uint32_t i = 0; (name = ewa_cloud_note_name(cloud, i)); i++)
        if (is_fact(name)) json_text(json, name + sizeof FACT - 1, ewa_cloud_note(cloud, name, NULL));
    json_close(json, '}');
}

void info_upright_print(const ewa_upright *upright) {
    char text[EWA_UPRIGHT_TEXT_BYTES];
    ewa_upright_describe(upright, text);
    printf("  up          %s\n", text);
}

void info_upright_write(json_writer *json, const ewa_upright *upright) {
    double up_world[3] = {0};
    up_world[upright->axis] = upright->reversed ? -1 : 1;
    json_vector(json, "up", 3, up_world);
    json_text(json, "up_because", upright->why);
    json_text(json, "view", ewa_upright_place(upright));
}

void info_classes_count(const ewa_cloud *cloud, class_counts *classes) {
    *classes = (class_counts){.attribute = NULL};
    const ewa_attribute *attribute = NULL;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++)
        if (attribute->component_count == 1 && ewa_coloring_names_classes(attribute->name)) break;
    if (!attribute) return;
    const uint64_t count = ewa_cloud_point_count(cloud);
    double numbers[BLOCK_POINTS];
    for (uint64_t first = 0; first < count; first += BLOCK_POINTS) {
        const uint64_t taken = count - first < BLOCK_POINTS ? count - first : BLOCK_POINTS;
        ewa_attribute_read_f64(attribute, first, taken, numbers);
        for (uint64_t i = 0; i < taken; i++) {
            if (!(numbers[i] >= 0 && numbers[i] < INFO_CLASSES) || numbers[i] != floor(numbers[i])) return;
            classes->counts[(int)numbers[i]]++;
        }
    }
    classes->attribute = attribute;
}

void info_classes_print(const class_counts *classes) {
    if (!classes->attribute) return;
    printf("  classes\n");
    for (uint32_t code = 0; code < INFO_CLASSES; code++) {
        if (!classes->counts[code]) continue;
        char name[EWA_CLASS_NAME_BYTES];
        ewa_class_name(code, name);
        printf("    %3u %-20s %" PRIu64 "\n", code, name, classes->counts[code]);
    }
}

void info_classes_write(json_writer *json, const class_counts *classes) {
    if (!classes->attribute) return;
    json_array(json, "classes");
    for (uint32_t code = 0; code < INFO_CLASSES; code++) {
        if (!classes->counts[code]) continue;
        char name[EWA_CLASS_NAME_BYTES];
        ewa_class_name(code, name);
        json_object(json, NULL);
        json_count(json, "code", code);
        json_text(json, "name", name);
        json_count(json, "points", classes->counts[code]);
        json_close(json, '}');
    }
    json_close(json, ']');
}
