// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is under the pointer: the surface from a few pixels of depth, its nearest point, and distances.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BLOCK = 512, MOST_REACH_PX = 32, MANY_SPLATS = 2000000 };

/// See reach_of().
static const double POINT_REACH = 40, POINT_SHARE = 0.01;

static const double PI = 3.14159265358979323846;

/// The depths of a window of pixels about a place, its middle first; +infinity where nothing is. What is
/// drawn there is what the picture shows: sections count. `coarse`: with fewer surfels where there are many.
static double nearest_depth(viewer *v, double x_px, double y_px, int reach_px, bool coarse,
                            double place_px[2]) {
    enum { SIDE = 2 * MOST_REACH_PX + 1 };
    float depth[SIDE * SIDE];
    const int side = 2 * reach_px + 1, middle_x = (int)floor(x_px), middle_y = (int)floor(y_px);
    paint_scene scene;
    viewer_scene(v, &scene);
    uint64_t count = 0;
    for (uint32_t i = 0; i < scene.surfels_count; i++) {
        ewa_surfels_info info;
        ewa_surfels_describe(scene.surfels[i], &info);
        count += info.point_count;
    }
    scene.render.level = coarse && count > MANY_SPLATS ? 2 : 0;
    if (scene.lods_count && !v->waits) { // what draws them goes on afterwards
        painter_hurry(v->painter);
        v->posted_whole = false;
    }
    scene.render.shading = EWA_SHADING_NONE;
    scene.render.eye_dome = 0;
    scene.camera.cx_px -= middle_x - reach_px, scene.camera.cy_px -= middle_y - reach_px;
    scene.camera.width_px = scene.camera.height_px = (uint32_t)side;
    if (paint_scene_depth(&v->probe, &scene, depth) != EWA_OK) return INFINITY;
    double found = INFINITY;
    int nearest = 2 * side * side;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const int dx = x - reach_px, dy = y - reach_px, away = dx * dx + dy * dy;
            if (away >= nearest || away > reach_px * reach_px || !isfinite(depth[y * side + x])) continue;
            nearest = away;
            found = (double)depth[y * side + x];
            place_px[0] = away ? middle_x + dx + 0.5 : x_px;
            place_px[1] = away ? middle_y + dy + 0.5 : y_px;
        }
    return found;
}

static bool find_surface(viewer *v, double x, double y, double reach, bool coarse, double place_world[3]) {
    const double most = fmin(reach * v->scale, MOST_REACH_PX), x_px = x * v->scale, y_px = y * v->scale;
    const bool inside = x_px >= -most && y_px >= -most && x_px < v->camera.width_px + most &&
                        y_px < v->camera.height_px + most;
    double place_px[2];
    const double depth = inside ? nearest_depth(v, x_px, y_px, (int)most, coarse, place_px) : INFINITY;
    if (!isfinite(depth)) return false;
    navigate_unproject(&v->camera, place_px[0], place_px[1], depth, place_world);
    return true;
}

bool pick_surface(viewer *v, double x, double y, double reach, double place_world[3]) {
    return find_surface(v, x, y, reach, true, place_world);
}

/// Whether a point is not cut away.
static bool is_kept(const ewa_render_options *render, const double p[3]) {
    for (uint32_t i = 0; i < render->section_count; i++) {
        const double *plane = render->section_planes[i];
        if (!(plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3] >= 0)) return false;
    }
    return true;
}

/// How far from a place of a surface its points may be: some of the window's points, or a share of the scene.
static double reach_of(const viewer *v, const double place_world[3]) {
    const double depth = navigate_depth(&v->camera, place_world);
    const double per_px = (v->camera.projection == EWA_ORTHOGRAPHIC ? 1 : depth) / v->camera.fy_px;
    const double *m = &v->camera.world_to_camera[8], scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    return fmax(POINT_REACH * v->scale * per_px / scale, POINT_SHARE * v->reach_world);
}

/// What a place is compared with.
typedef struct search {
    const ewa_render_options *render; ///< whose sections cut
    const double *place_world;
    double best; ///< square of the distance of what was found, or within which to look
} search;

/// The point of a cloud that is nearest to a place, and nearer than what was found; false: there is none.
static bool find_in_cloud(search *s, const ewa_cloud *cloud, viewer_pick *pick) {
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    const uint64_t count = ewa_cloud_point_count(cloud);
    double origin[3], block[BLOCK][3];
    bool found = false;
    ewa_cloud_origin(cloud, origin);
    for (uint64_t first = 0; first < count; first += BLOCK) {
        const uint64_t in_block = count - first < BLOCK ? count - first : BLOCK;
        ewa_attribute_read_f64(position, first, in_block, &block[0][0]);
        for (uint64_t k = 0; k < in_block; k++) {
            double p[3], away = 0;
            for (int c = 0; c < 3; c++) {
                p[c] = block[k][c] + origin[c];
                away += (p[c] - s->place_world[c]) * (p[c] - s->place_world[c]);
            }
            if (!(away < s->best) || !is_kept(s->render, p)) continue;
            s->best = away;
            found = true;
            pick->given = true;
            pick->point = first + k;
            memcpy(pick->place_world, p, sizeof p);
        }
    }
    return found;
}

/// Reads the points of an octree about a place; NULL: it cannot.
static ewa_cloud *read_about(const viewer *v, ewa_lod *lod, const double place_world[3], double reach) {
    double low[3], high[3];
    for (int c = 0; c < 3; c++) low[c] = place_world[c] - reach, high[c] = place_world[c] + reach;
    ewa_cloud *cloud = NULL;
    pthread_mutex_lock(v->lods_lock);
    ewa_lod_read(lod, low, high, 0, &cloud);
    pthread_mutex_unlock(v->lods_lock);
    return cloud;
}

/// The point that is nearest to a place; false: there is none about there. `*read` gets the points of the octree
/// that it belongs to, the caller's; NULL: it is of a cloud.
static bool find_point(const viewer *v, const double place_world[3], viewer_pick *pick, ewa_cloud **read) {
    paint_scene scene;
    viewer_scene(v, &scene);
    const double reach = reach_of(v, place_world);
    search s = {&scene.render, place_world, reach * reach};
    bool found = false;
    *read = NULL;
    for (size_t i = 0; i < v->item_count; i++) {
        const scene_item *item = &v->items[i];
        if (!item->visible || !item->loaded || (!item->content.cloud && !item->content.lod)) continue;
        ewa_cloud *about = item->content.lod ? read_about(v, item->content.lod, place_world, reach) : NULL;
        const ewa_cloud *cloud = about ? about : item->content.cloud;
        if (!cloud || !find_in_cloud(&s, cloud, pick)) {
            ewa_cloud_destroy(&about);
            continue;
        }
        found = true;
        pick->item = i;
        ewa_cloud_destroy(read);
        *read = about;
    }
    return found;
}

/// Adds to a text what fits.
static void add(char *text, size_t text_bytes, const char *more) {
    const size_t used = strlen(text);
    if (used < text_bytes) snprintf(text + used, text_bytes - used, "%s", more);
}

/// A coordinate with the digits that it was stored with.
static void write_number(char text[40], double number, bool is_float) {
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

/// Says what a point is: its number, its exact place and everything that the file says of it. Points of an octree,
/// of which `read` holds some, have no numbers.
static void describe(viewer *v, const viewer_pick *pick, const ewa_cloud *read) {
    const scene_item *item = &v->items[pick->item];
    const ewa_cloud *cloud = read ? read : item->content.cloud;
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
    for (int c = 0; c < 3; c++) {
        write_number(number, pick->place_world[c], whole);
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
            write_number(number, numbers[c], attribute->type == EWA_F32);
            add(line, sizeof line, c ? "," : "="), add(line, sizeof line, number);
            add(shown, VIEWER_TEXT_BYTES, " "), add(shown, VIEWER_TEXT_BYTES, number);
        }
    }
    viewer_say(v, "%s", line);
}

/// Says how far it is from the first point to the second.
static void describe_measure(viewer *v) {
    const double *a = v->picks[0].place_world, *b = v->picks[1].place_world, *up = v->up_world;
    double d[3], distance2 = 0, rise = 0, up2 = 0;
    for (int c = 0; c < 3; c++) {
        d[c] = b[c] - a[c];
        distance2 += d[c] * d[c];
        rise += d[c] * up[c];
        up2 += up[c] * up[c];
    }
    rise /= sqrt(up2);
    const double horizontal = sqrt(fmax(distance2 - rise * rise, 0));
    const double slope_deg = distance2 > 0 ? atan2(rise, horizontal) * 180 / PI : 0;
    viewer_say(v, "measure distance %.9g dx %.9g dy %.9g dz %.9g horizontal %.9g rise %.9g slope %.4g deg",
               sqrt(distance2), d[0], d[1], d[2], horizontal, rise, slope_deg);
    snprintf(v->state.picked, sizeof v->state.picked,
             "distance %.9g\ndx %.9g\ndy %.9g\ndz %.9g\nhorizontal %.9g\nrise %.9g\nslope %.4g deg",
             sqrt(distance2), d[0], d[1], d[2], horizontal, rise, slope_deg);
}

static void copy_picked(viewer *v) {
    if (v->services.clipboard_set) v->services.clipboard_set(v->services.user, v->state.picked);
    snprintf(v->clipboard, sizeof v->clipboard, "%s", v->state.picked);
}

bool pick_point(viewer *v, double x, double y, bool second) {
    viewer_pick pick;
    double place_world[3];
    if (!find_surface(v, x, y, 4, false, place_world)) return false;
    ewa_cloud *read = NULL;
    if (!find_point(v, place_world, &pick, &read)) { // a volume: the place itself
        snprintf(v->state.picked, sizeof v->state.picked, "at %.9g %.9g %.9g", place_world[0], place_world[1],
                 place_world[2]);
        viewer_say(v, "pick place at %.9g %.9g %.9g", place_world[0], place_world[1], place_world[2]);
        pick = (viewer_pick){true, SIZE_MAX, 0, {place_world[0], place_world[1], place_world[2]}};
    } else {
        describe(v, &pick, read);
    }
    ewa_cloud_destroy(&read);
    second = second && v->picks[0].given;
    v->picks[second ? 1 : 0] = pick;
    if (second)
        describe_measure(v);
    else
        v->picks[1].given = false;
    copy_picked(v);
    viewer_mark(v);
    return true;
}

void pick_clear(viewer *v) {
    if (v->picks[0].given) viewer_mark(v);
    v->picks[0].given = v->picks[1].given = false;
    v->state.picked[0] = 0;
}
