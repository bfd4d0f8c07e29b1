// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is under the pointer: the surface from a few pixels of depth, its nearest point, and distances.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_REACH_PX = 32, MANY_SPLATS = 2000000 };

/// See reach_of().
static const double POINT_REACH = 40, POINT_SHARE = 0.01;

/// Points of the window about a click.
static const double PICK_REACH = 4;

/// How far from a place of a surface its points may be: some of the window's points, or a share of the scene.
static double reach_of(const viewer *v, const double place_world[3]) {
    const double depth = navigate_depth(&v->camera, place_world);
    const double per_px = (v->camera.projection == EWA_ORTHOGRAPHIC ? 1 : depth) / v->camera.fy_px;
    const double *m = &v->camera.world_to_camera[8], scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    return fmax(POINT_REACH * v->scale * per_px / scale, POINT_SHARE * v->reach_world);
}

/// Finds what is seen at a place of the window, within `reach` of its points. What is drawn there is what the picture
/// shows. `coarse`: with fewer surfels where there are many. `reach_world`: of its nearest point; 0: none is looked for.
static bool find(viewer *v, double x, double y, double reach, bool coarse, double reach_world, ewa_scene_hit *hit) {
    paint_scene scene;
    ewa_scene_info info;
    viewer_scene(v, &scene);
    ewa_scene_describe(v->scene, &info);
    scene.options.render.level = coarse && info.surfels.point_count > MANY_SPLATS ? 2 : 0;
    if (scene.octrees && !v->waits) { // what draws them goes on afterwards
        painter_hurry(v->painter);
        v->posted_whole = false;
    }
    scene.options.lod.resident_only = v->node_reader != NULL;
    const bool reads = scene.octrees && (reach_world > 0 || !scene.options.lod.resident_only);
    if (reads) turns_take(&v->turns->files);
    if (scene.octrees) turns_take(&v->turns->nodes);
    const ewa_status status = ewa_scene_pick(v->scene, v->probe.renderer, &scene.camera, &scene.options, x * v->scale,
                                             y * v->scale, fmin(reach * v->scale, MAX_REACH_PX), reach_world, hit);
    if (scene.octrees) turns_give(&v->turns->nodes);
    if (reads) turns_give(&v->turns->files);
    return status == EWA_OK && hit->hit;
}

bool pick_surface(viewer *v, double x, double y, double reach, double place_world[3]) {
    ewa_scene_hit hit;
    if (!find(v, x, y, reach, true, 0, &hit)) return false;
    memcpy(place_world, hit.place_world, sizeof hit.place_world);
    return true;
}

bool pick_item(viewer *v, double x, double y, double reach, size_t *index, double place_world[3]) {
    ewa_scene_hit hit;
    if (!find(v, x, y, reach, false, 0, &hit)) return false;
    memcpy(place_world, hit.place_world, sizeof hit.place_world);
    if (!find(v, x, y, reach, false, reach_of(v, place_world), &hit)) return false;
    ewa_cloud_destroy(&hit.points);
    *index = hit.has_point ? items_find_instance(v, hit.instance) : SIZE_MAX;
    // What has no points is found by its box.
    for (size_t i = 0; *index == SIZE_MAX && i < v->item_count; i++) {
        ewa_asset_info info = {.count = 0};
        if (v->items[i].asset && v->items[i].visible) ewa_asset_describe(v->items[i].asset, &info);
        bool inside = info.bounds.finite_count > 0;
        for (int c = 0; c < 3; c++)
            inside = inside && place_world[c] >= info.bounds.low_world[c] && place_world[c] <= info.bounds.high_world[c];
        if (inside) *index = i;
    }
    return *index < v->item_count;
}

/// Adds to a text what fits.
static void add(char *text, size_t text_bytes, const char *more) {
    const size_t used = strlen(text);
    if (used < text_bytes) snprintf(text + used, text_bytes - used, "%s", more);
}

void pick_write_number(char text[40], double number, bool is_float) {
    snprintf(text, 40, is_float ? "%.9g" : "%.17g", number);
    for (int digits = is_float ? 6 : 15; digits <= (is_float ? 8 : 16); digits++) {
        char shorter[40];
        snprintf(shorter, sizeof shorter, "%.*g", digits, number);
        double read = 0;
        sscanf(shorter, "%lf", &read);
        if (is_float ? (float)read == (float)number : read == number) {
            memcpy(text, shorter, sizeof shorter);
            return;
        }
    }
}

/// Makes the place of a point exact and says what it is: its number, its place and everything that the file says of it. Points of an octree,
/// of which `read` holds some, have no numbers.
static void describe(viewer *v, viewer_pick *pick, const ewa_cloud *read) {
    const scene_item *item = &v->items[pick->item];
    ewa_asset_info info;
    ewa_asset_describe(item->asset, &info);
    const ewa_cloud *cloud = read ? read : info.cloud;
    char line[VIEWER_TEXT_BYTES], number[40];
    if (read)
        snprintf(number, sizeof number, "point");
    else
        snprintf(number, sizeof number, "point %llu", (unsigned long long)pick->point);
    snprintf(line, sizeof line, "pick %.200s %s at", item->name, number);
    char *shown = v->state.picked;
    snprintf(shown, VIEWER_TEXT_BYTES, "%s of %.200s\nat", number, item->name);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    const bool whole = position->type == EWA_F32 && origin[0] == 0 && origin[1] == 0 && origin[2] == 0;
    ewa_coordinate_grid grid;
    ewa_cloud_grid(cloud, &grid);
    for (int c = 0; c < 3; c++) {
        // Sums of an origin and an offset lose the last digit of the file's decimals.
        pick->place_world[c] = ewa_grid_world(&grid, (uint32_t)c, pick->place_world[c]);
        pick_write_number(number, pick->place_world[c], whole);
        add(line, sizeof line, " "), add(line, sizeof line, number);
        add(shown, VIEWER_TEXT_BYTES, " "), add(shown, VIEWER_TEXT_BYTES, number);
    }
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        if (strcmp(attribute->name, EWA_POSITION) == 0) continue;
        double numbers[4];
        ewa_attribute_read_f64(attribute, pick->point, 1, numbers);
        add(line, sizeof line, " "), add(line, sizeof line, attribute->name);
        add(shown, VIEWER_TEXT_BYTES, "\n"), add(shown, VIEWER_TEXT_BYTES, attribute->name);
        for (uint32_t c = 0; c < attribute->component_count; c++) {
            pick_write_number(number, numbers[c], attribute->type == EWA_F32);
            add(line, sizeof line, c ? "," : "="), add(line, sizeof line, number);
            add(shown, VIEWER_TEXT_BYTES, " "), add(shown, VIEWER_TEXT_BYTES, number);
        }
    }
    viewer_say(v, "%s", line);
}

/// Says how far it is from the first point to the second.
static void describe_measure(viewer *v) {
    double places_world[6];
    for (int k = 0; k < 2; k++) memcpy(places_world + 3 * k, v->picks[k].place_world, sizeof v->picks[k].place_world);
    const double *a = places_world, *b = places_world + 3;
    ewa_measurement m;
    if (ewa_places_measure(EWA_MEASURE_DISTANCE, places_world, 2, v->up_world, &m) != EWA_OK) return;
    char distance[64], horizontal[64], rise[64];
    measures_write(v, distance, sizeof distance, m.length_world, 9, 1);
    measures_write(v, horizontal, sizeof horizontal, m.horizontal_world, 9, 1);
    measures_write(v, rise, sizeof rise, m.rise_world, 9, 1);
    viewer_say(v, "measure distance %s dx %.9g dy %.9g dz %.9g horizontal %s rise %s slope %.4g deg", distance, b[0] - a[0],
               b[1] - a[1], b[2] - a[2], horizontal, rise, m.slope_deg);
    snprintf(v->state.picked, sizeof v->state.picked,
             "distance %s\ndx %.9g\ndy %.9g\ndz %.9g\nhorizontal %s\nrise %s\nslope %.4g deg", distance, b[0] - a[0], b[1] - a[1],
             b[2] - a[2], horizontal, rise, m.slope_deg);
}

void pick_copy(viewer *v) {
    if (v->services.clipboard_set) v->services.clipboard_set(v->services.user, v->state.picked);
    snprintf(v->clipboard, sizeof v->clipboard, "%s", v->state.picked);
}

bool pick_point(viewer *v, double x, double y, bool second) {
    ewa_scene_hit hit;
    if (!find(v, x, y, PICK_REACH, false, 0, &hit)) return false;
    if (!find(v, x, y, PICK_REACH, false, reach_of(v, hit.place_world), &hit)) return false;
    viewer_pick pick = {true, hit.has_point ? items_find_instance(v, hit.instance) : SIZE_MAX, hit.point, {0}};
    const double *place_world = hit.has_point ? hit.point_world : hit.place_world;
    memcpy(pick.place_world, place_world, sizeof pick.place_world);
    if (pick.item == SIZE_MAX) { // what has no points: the place itself
        snprintf(v->state.picked, sizeof v->state.picked, "at %.9g %.9g %.9g", place_world[0], place_world[1],
                 place_world[2]);
        viewer_say(v, "pick place at %.9g %.9g %.9g", place_world[0], place_world[1], place_world[2]);
    } else {
        describe(v, &pick, hit.points);
    }
    ewa_cloud_destroy(&hit.points);
    second = second && v->picks[0].given;
    v->picks[second ? 1 : 0] = pick;
    if (second)
        describe_measure(v);
    else
        v->picks[1].given = false;
    pick_copy(v);
    viewer_note(v, "%s, and copied as text", second ? "measured" : "picked");
    viewer_mark(v);
    return true;
}

bool viewer_get_pick(const viewer *v, int index, double place_world[3]) {
    if (index < 0 || index > 1 || !v->picks[index].given) return false;
    memcpy(place_world, v->picks[index].place_world, sizeof v->picks[index].place_world);
    return true;
}

void pick_clear(viewer *v) {
    if (v->picks[0].given) viewer_mark(v);
    v->picks[0].given = v->picks[1].given = false;
    v->state.picked[0] = 0;
}
