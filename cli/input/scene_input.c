// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The scene that a command's operands and options ask for.
#include "cli/input/scene_input.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/import.h"

#include <string.h>

/// Has formats that the library does not read read by the helper program.
static ewa_status read_rare(void *user, ewa_context *context, const char *path, ewa_model *model,
                            bool *taken) {
    cli_session *session = user;
    (void)context;
    if (!import_is_named(path)) return EWA_OK;
    *taken = true;
    // What went wrong has been said.
    return import_load(session, path, EWA_MODEL_MESH, model) ? EWA_OK : EWA_ERROR_UNSUPPORTED;
}

ewa_asset_options scene_input_asset_options(cli_session *session) {
    ewa_asset_options options;
    ewa_asset_options_init(&options, sizeof options);
    options.load = &session->load;
    options.filter = session->filter;
    options.reader = read_rare;
    options.reader_user = session;
    return options;
}

void scene_input_coloring(const coloring_arguments *arguments, ewa_coloring *coloring) {
    ewa_coloring_init(coloring, sizeof *coloring);
    if (!arguments->color_by) return;
    const option_bounds *range = &arguments->range;
    strncat(coloring->attribute, arguments->color_by, sizeof coloring->attribute - 1);
    coloring->map = (ewa_coloring_map)(arguments->colormap + 1);
    coloring->ranged = range->given;
    memcpy(coloring->range, range->values, sizeof coloring->range);
    memcpy(coloring->percent, range->percent, sizeof coloring->percent);
}

/// Adds one file. Returns false after reporting.
static bool add_file(cli_session *session, const char *path, const ewa_asset_options *options,
                     const ewa_coloring *coloring, ewa_scene *scene) {
    ewa_asset *asset = NULL;
    ewa_status status = ewa_asset_load(session->context, path, options, &asset);
    ewa_asset_info info = {.count = 0};
    if (status == EWA_OK) ewa_asset_describe(asset, &info);
    if (status == EWA_OK && info.changeable && !info.count) {
        session->subject = path;
        session_note(session, "--filter takes none of its points; it is left out");
        session->subject = NULL;
    } else if (status == EWA_OK) {
        ewa_instance instance;
        ewa_instance_init(&instance, sizeof instance);
        if (info.colorable) instance.coloring = *coloring;
        status = ewa_scene_add(scene, asset, &instance);
    }
    ewa_asset_release(&asset);
    return session_passed(session, status);
}

/// Adds what a scene file names; points that have their own colours there get those of the command.
static bool add_scene(cli_session *session, const char *path, const ewa_asset_options *options,
                      const ewa_coloring *coloring, ewa_scene *scene) {
    const uint32_t first = ewa_scene_count(scene);
    ewa_status status = ewa_scene_open(scene, path, options);
    for (uint32_t i = first; i < ewa_scene_count(scene) && status == EWA_OK; i++) {
        ewa_instance instance;
        ewa_asset_info info;
        ewa_asset_describe(ewa_scene_asset(scene, i), &info);
        status = ewa_scene_get(scene, i, &instance);
        if (!info.colorable || instance.coloring.tinted || instance.coloring.attribute[0])
            continue;
        instance.coloring = *coloring;
        if (status == EWA_OK) status = ewa_scene_set(scene, i, &instance);
    }
    return session_passed(session, status);
}

bool scene_input_add(cli_session *session, size_t count, const char *const *paths, const ewa_asset_options *options,
                     const ewa_coloring *coloring, ewa_scene *scene) {
    session->subject = NULL;
    for (size_t i = 0; i < count; i++) {
        const bool is_scene = ewa_scene_file_probe(paths[i]);
        if (!(is_scene ? add_scene : add_file)(session, paths[i], options, coloring, scene)) return false;
    }
    if (ewa_scene_count(scene)) return true;
    if (session->filter)
        session_fail(session, "--filter: none of the points is left");
    else
        session_fail(session, "%s: there is nothing to draw", paths[0]);
    return false;
}

ewa_cloud *scene_input_cloud(cli_session *session, size_t count, const char *const *paths, double cutoff) {
    ewa_asset_options options = scene_input_asset_options(session);
    options.gaussians_as_surfels = true;
    options.levels = EWA_OCTREE_NEVER;
    options.cutoff = cutoff;
    ewa_coloring own;
    ewa_coloring_init(&own, sizeof own);
    strcpy(own.attribute, "none");
    ewa_scene *scene = NULL;
    ewa_cloud *cloud = NULL;
    if (session_passed(session, ewa_scene_create(session->context, NULL, &scene)) &&
        scene_input_add(session, count, paths, &options, &own, scene))
        (void)session_passed(session, ewa_scene_cloud(scene, &cloud));
    ewa_scene_destroy(&scene);
    return cloud;
}

ewa_cloud *scene_input_points(cli_session *session, const char *path) {
    const ewa_asset_options options = scene_input_asset_options(session);
    ewa_scene *scene = NULL;
    ewa_cloud *cloud = NULL;
    if (session_passed(session, ewa_scene_create(session->context, NULL, &scene)) &&
        session_passed(session, ewa_scene_open(scene, path, &options)))
        (void)session_passed(session, ewa_scene_points(scene, &cloud));
    ewa_scene_destroy(&scene);
    return cloud;
}

bool scene_input_is_of_gaussians(cli_session *session, const char *path) {
    ewa_scene_file *file = NULL;
    const ewa_asset_options options = scene_input_asset_options(session);
    // What is wrong with it is said by who reads it.
    if (!ewa_scene_file_probe(path) || ewa_scene_file_load(session->context, path, &options, &file) != EWA_OK) return false;
    uint32_t count = 0, others = 0;
    for (uint32_t i = 0; i < ewa_scene_file_count(file); i++) {
        ewa_scene_entry entry;
        if (ewa_scene_file_entry(file, i, &entry) != EWA_OK || !entry.instance.visible) continue;
        const bool gaussians = !entry.asset.gaussians_as_surfels && gaussian_files_format(session, entry.path) != EWA_GAUSSIANS_NONE;
        *(gaussians ? &count : &others) += 1;
    }
    ewa_scene_file_destroy(&file);
    return count && !others;
}

bool scene_input_gaussians(cli_session *session, const char *path, ewa_gaussians *set, double up_world[3]) {
    const ewa_asset_options options = scene_input_asset_options(session);
    ewa_scene *scene = NULL;
    const bool done = session_passed(session, ewa_scene_create(session->context, NULL, &scene)) &&
                      session_passed(session, ewa_scene_open(scene, path, &options)) &&
                      session_passed(session, ewa_scene_gaussians(scene, set, up_world));
    ewa_scene_destroy(&scene);
    return done;
}
