// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture shows of all that lets light through, alone or with surfaces among them.
#include "mixture_scene.h"
#include "gaussian_files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 8 };

void mixture_set_defaults(mixture_arguments *arguments) {
    ewa_gaussian_options_init(&arguments->gaussians, sizeof arguments->gaussians);
    ewa_volume_options_init(&arguments->volumes.options, sizeof arguments->volumes.options);
}

/// What an operand is.
typedef enum operand_kind { SURFACE, GAUSSIANS, VOLUME, KINDS } operand_kind;

static operand_kind kind_of(cli_session *session, const char *path, const mixture_arguments *arguments,
                            size_t operand_count) {
    if (volume_input_is_named(path)) return operand_count > 1 ? VOLUME : SURFACE; // which says what draws it
    return !arguments->surface && gaussian_files_format(session, path) != EWA_GAUSSIANS_NONE ? GAUSSIANS
                                                                                             : SURFACE;
}

bool mixture_scene_find(cli_session *session, const common_arguments *common,
                        const mixture_arguments *arguments, mixture_scene *scene) {
    const size_t count = common->operand_count;
    scene->rest = *common;
    scene->operands = malloc(count * sizeof *scene->operands);
    operand_kind *kinds = malloc(count * sizeof *kinds);
    const bool done = scene->operands && kinds;
    size_t found[KINDS] = {0}, next = 0;
    for (size_t i = 0; i < count && done; i++)
        found[kinds[i] = kind_of(session, common->operands[i], arguments, count)]++;
    for (int kind = 0; kind < KINDS && done; kind++)
        for (size_t i = 0; i < count; i++)
            if ((int)kinds[i] == kind) scene->operands[next++] = common->operands[i];
    free(kinds);
    session->subject = NULL;
    if (!done) return session_fail(session, "out of memory for %zu names", count) == EXIT_DONE;
    scene->rest.operands = scene->operands;
    scene->rest.operand_count = found[SURFACE];
    scene->splats_count = (uint32_t)found[GAUSSIANS];
    scene->volume_count = (uint32_t)found[VOLUME];
    return true;
}

const char *mixture_scene_path(const mixture_scene *scene) {
    return scene->operands[scene->rest.operand_count];
}

/// Copies the places of a cloud, and their radii where it has some; `*at` is where the next ones go.
static void add_outline(const ewa_cloud *from, uint64_t *at, double *positions, float *radii) {
    const uint64_t count = ewa_cloud_point_count(from);
    const ewa_attribute *radius = ewa_cloud_find(from, EWA_RADIUS);
    ewa_attribute_read_f64(ewa_cloud_find(from, EWA_POSITION), 0, count, positions + 3 * *at);
    for (uint64_t i = 0; i < count; i++) {
        double own = 0;
        if (radius) ewa_attribute_read_f64(radius, i, 1, &own);
        radii[*at + i] = (float)own;
    }
    *at += count;
}

/// Puts the outlines of all together, and the corners of a box around the surfaces, or of any where there is nothing.
static ewa_status make_outline(ewa_context *context, const ewa_cloud *others, mixture_scene *scene) {
    static const ewa_bounds any = {.low_world = {-1, -1, -1}, .high_world = {1, 1, 1}};
    ewa_bounds box = {.finite_count = 0};
    if (others) ewa_cloud_measure(others, &box);
    uint64_t count = 0, at = 0;
    for (uint32_t i = 0; i < scene->splats_count; i++) count += ewa_cloud_point_count(scene->sets[i].outline);
    for (uint32_t i = 0; i < scene->volume_count; i++)
        count += ewa_cloud_point_count(scene->volumes[i].outline);
    const uint64_t corners = box.finite_count || !count ? CORNERS : 0;
    if (!box.finite_count) box = any;
    count += corners;
    void *positions = NULL, *radii = NULL;
    ewa_status status = ewa_cloud_create(context, count, &scene->outline);
    if (status == EWA_OK) status = ewa_cloud_add(scene->outline, EWA_POSITION, EWA_F64, 3, &positions);
    if (status == EWA_OK) status = ewa_cloud_add(scene->outline, EWA_RADIUS, EWA_F32, 1, &radii);
    if (status != EWA_OK) return status;
    for (uint32_t i = 0; i < scene->splats_count; i++)
        add_outline(scene->sets[i].outline, &at, positions, radii);
    for (uint32_t i = 0; i < scene->volume_count; i++)
        add_outline(scene->volumes[i].outline, &at, positions, radii);
    for (uint64_t i = 0; i < corners; i++, at++) {
        ((float *)radii)[at] = 0;
        for (uint64_t k = 0; k < 3; k++)
            ((double *)positions)[3 * at + k] = i >> k & 1 ? box.high_world[k] : box.low_world[k];
    }
    return EWA_OK;
}

/// Loads the sets. Returns false after reporting.
static bool load_sets(cli_session *session, mixture_scene *scene) {
    const char *const *paths = scene->operands + scene->rest.operand_count;
    scene->near_world = INFINITY;
    for (uint32_t i = 0; i < scene->splats_count; i++) {
        gaussian_scene *set = &scene->sets[i];
        session->subject = paths[i];
        if (!gaussian_scene_load(session, paths[i], set)) return false;
        if (i == 0) scene->up_axis = set->up_axis;
        scene->near_world = fmin(scene->near_world, set->info.near_world);
        scene->splats[i] = set->splats;
    }
    session->subject = NULL;
    return true;
}

/// Loads the volumes, and sets how they are drawn. Returns false after reporting.
static bool load_volumes(cli_session *session, const mixture_arguments *arguments,
                         const light_arguments *light, mixture_scene *scene) {
    const char *const *paths = scene->operands + scene->rest.operand_count + scene->splats_count;
    const light_objects nothing = {.material_count = 0};
    const ewa_render_options lit = light_apply(light, &nothing);
    volume_input_arguments input = {.type = -1};
    volume_input_set_defaults(&input);
    if (!scene->splats_count) scene->up_axis = 2; // scanners' volumes stand on z
    for (uint32_t i = 0; i < scene->volume_count; i++) {
        volume_scene *volume = &scene->volumes[i];
        if (!volume_scene_load(session, &input, &arguments->volumes, paths[i], 1, volume)) return false;
        ewa_volume_options *options = &scene->volume_options[i];
        *options = arguments->volumes.options;
        options->shading = light->shading >= 0 ? (ewa_shading)light->shading
                           : volume->flat      ? EWA_SHADING_NONE
                                               : EWA_SHADING_PHONG;
        options->light_count = lit.light_count;
        memcpy(options->lights, lit.lights, sizeof options->lights);
        scene->mixed[i] = (ewa_mixed_volume){
            .voxels = volume->voxels, .options = options, .stats = &scene->volume_stats[i]};
        const ewa_status status = ewa_volume_renderer_create(session->context, &scene->mixed[i].renderer);
        if (status != EWA_OK) return session_failed(session, status) == EXIT_DONE;
    }
    session->subject = NULL;
    return true;
}

bool mixture_scene_load(cli_session *session, const mixture_arguments *arguments,
                        const light_arguments *light, const ewa_cloud *others, mixture_scene *scene) {
    const size_t sets = scene->splats_count + (size_t)1, volumes = scene->volume_count + (size_t)1;
    scene->sets = calloc(sets, sizeof *scene->sets);
    scene->splats = calloc(sets, sizeof *scene->splats);
    scene->volumes = calloc(volumes, sizeof *scene->volumes);
    scene->mixed = calloc(volumes, sizeof *scene->mixed);
    scene->volume_options = calloc(volumes, sizeof *scene->volume_options);
    scene->volume_stats = calloc(volumes, sizeof *scene->volume_stats);
    scene->context = session->context;
    if (!scene->sets || !scene->splats || !scene->volumes || !scene->mixed || !scene->volume_options ||
        !scene->volume_stats)
        return session_fail(session, "out of memory for %zu inputs", sets + volumes - 2) == EXIT_DONE;
    if (!load_sets(session, scene) || !load_volumes(session, arguments, light, scene)) return false;
    ewa_status status = ewa_gaussian_renderer_create(session->context, &scene->renderer);
    if (status == EWA_OK) status = make_outline(session->context, others, scene);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

ewa_status mixture_paint_surface(ewa_context *context, ewa_renderer *renderer, const ewa_surfels *surfels,
                                 const ewa_camera *camera, const ewa_render_options *options, ewa_image *rgba,
                                 ewa_image *depth, ewa_render_stats *stats) {
    const uint32_t width = camera->width_px, height = camera->height_px;
    ewa_status status = EWA_OK;
    if (rgba->width_px != width || rgba->height_px != height) {
        ewa_image_free(rgba);
        ewa_image_free(depth);
        status = ewa_image_create(context, width, height, 1, depth);
        if (status == EWA_OK) status = ewa_image_create(context, width, height, 4, rgba);
    }
    if (status != EWA_OK) return status;
    ewa_render_options over_nothing = *options;
    memset(over_nothing.background, 0, sizeof over_nothing.background);
    const ewa_frame frame = {.rgba = rgba->pixels, .depth = depth->pixels};
    return ewa_render(renderer, surfels, camera, &over_nothing, &frame, stats);
}

ewa_status mixture_scene_paint(mixture_scene *scene, ewa_renderer *renderer, const ewa_surfels *surfels,
                               const ewa_camera *camera, const ewa_render_options *options,
                               const ewa_gaussian_options *gaussians, const ewa_frame *frame,
                               ewa_render_stats *stats) {
    ewa_gaussian_options among = *gaussians;
    memcpy(among.background, options->background, sizeof among.background);
    memcpy(among.section_planes, options->section_planes, sizeof among.section_planes);
    among.section_count = options->section_count;
    if (scene->splats_count) among.near_world = scene->near_world;
    *stats = (ewa_render_stats){.splat_count = 0};
    ewa_status status = EWA_OK;
    if (surfels) {
        status = mixture_paint_surface(scene->context, renderer, surfels, camera, options,
                                       &scene->surface_rgba, &scene->surface_depth, stats);
        among.surface_rgba = scene->surface_rgba.pixels;
        among.surface_depth = scene->surface_depth.pixels;
    }
    const ewa_mixture mixture = {scene->splats, scene->splats_count, scene->volume_count, scene->mixed};
    ewa_gaussian_stats drawn;
    if (status == EWA_OK)
        status = ewa_mixture_render(scene->renderer, &mixture, camera, &among, frame, &drawn);
    if (status != EWA_OK) return status;
    stats->splat_count += drawn.splat_count;
    stats->culled_count += drawn.splat_count - drawn.visible_count;
    stats->drawn_count += drawn.visible_count;
    stats->total_s += drawn.total_s;
    for (uint32_t i = 0; i < scene->volume_count; i++) {
        const ewa_volume_stats *voxels = &scene->volume_stats[i];
        stats->splat_count += voxels->voxel_count;
        stats->culled_count += voxels->culled_count;
        stats->drawn_count += voxels->splat_count + voxels->point_count;
    }
    return EWA_OK;
}

void mixture_scene_free(mixture_scene *scene) {
    for (uint32_t i = 0; scene->sets && i < scene->splats_count; i++) gaussian_scene_free(&scene->sets[i]);
    for (uint32_t i = 0; scene->volumes && i < scene->volume_count; i++)
        volume_scene_free(&scene->volumes[i]);
    for (uint32_t i = 0; scene->mixed && i < scene->volume_count; i++)
        ewa_volume_renderer_destroy(&scene->mixed[i].renderer);
    ewa_gaussian_renderer_destroy(&scene->renderer);
    ewa_cloud_destroy(&scene->outline);
    ewa_image_free(&scene->surface_rgba);
    ewa_image_free(&scene->surface_depth);
    free(scene->sets);
    free(scene->volumes);
    free(scene->splats);
    free(scene->mixed);
    free(scene->volume_options);
    free(scene->volume_stats);
    free(scene->operands);
}
