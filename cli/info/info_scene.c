// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a scene file shows, for ewa info.
#include "cli/info/info_scene.h"
#include "cli/input/scene_input.h"

#include <stdio.h>

static void print_box(const char *indent, const ewa_bounds *bounds) {
    const double *low = bounds->low_world, *high = bounds->high_world;
    if (!bounds->finite_count) return;
    printf("%slow         %.8g %.8g %.8g\n", indent, low[0], low[1], low[2]);
    printf("%shigh        %.8g %.8g %.8g\n", indent, high[0], high[1], high[2]);
}

static void write_box(json_writer *json, const ewa_bounds *bounds) {
    if (!bounds->finite_count) return;
    json_vector(json, "low", 3, bounds->low_world);
    json_vector(json, "high", 3, bounds->high_world);
}

/// Describes an instance; returns whether it is shown.
static bool describe(const ewa_scene *scene, uint32_t index, ewa_asset_info *info) {
    ewa_instance instance;
    ewa_asset_describe(ewa_scene_asset(scene, index), info);
    return ewa_scene_get(scene, index, &instance) == EWA_OK && instance.visible;
}

static void print_text(const char *path, const ewa_scene *scene, const ewa_bounds *bounds,
                       const ewa_camera *camera) {
    printf("%s\n  format      scene\n  items       %u\n", path, ewa_scene_count(scene));
    print_box("  ", bounds);
    if (camera) printf("  camera      %u x %u\n", camera->width_px, camera->height_px);
    for (uint32_t i = 0; i < ewa_scene_count(scene); i++) {
        ewa_asset_info info;
        const bool visible = describe(scene, i, &info);
        printf("  %s\n    kind        %s%s\n    count       %llu\n", info.name,
               ewa_asset_kind_name(info.kind), visible ? "" : ", hidden", (unsigned long long)info.count);
        print_box("    ", &info.bounds);
    }
}

static void print_json(json_writer *json, const char *path, const ewa_scene *scene, const ewa_bounds *bounds,
                       const ewa_camera *camera) {
    json_object(json, NULL);
    json_text(json, "file", path);
    json_text(json, "format", "scene");
    write_box(json, bounds);
    json_flag(json, "camera", camera != NULL);
    json_array(json, "items");
    for (uint32_t i = 0; i < ewa_scene_count(scene); i++) {
        ewa_asset_info info;
        const bool visible = describe(scene, i, &info);
        json_object(json, NULL);
        json_text(json, "file", info.name);
        json_text(json, "kind", ewa_asset_kind_name(info.kind));
        json_flag(json, "visible", visible);
        json_count(json, "count", info.count);
        write_box(json, &info.bounds);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

bool info_scene(cli_session *session, const char *path, json_writer *json) {
    const ewa_asset_options options = scene_input_asset_options(session);
    ewa_scene *scene = NULL;
    session->subject = NULL; // messages name the file and the place
    ewa_status status = ewa_scene_create(session->context, NULL, &scene);
    if (status == EWA_OK) status = ewa_scene_open(scene, path, &options);
    if (status == EWA_OK) {
        ewa_bounds bounds;
        ewa_camera camera;
        ewa_scene_bounds(scene, &bounds);
        const bool has_camera = ewa_scene_get_camera(scene, &camera);
        if (json)
            print_json(json, path, scene, &bounds, has_camera ? &camera : NULL);
        else
            print_text(path, scene, &bounds, has_camera ? &camera : NULL);
    } else {
        session_failed(session, status);
    }
    ewa_scene_destroy(&scene);
    return status == EWA_OK;
}
