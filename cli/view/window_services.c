// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the viewer asks of the program.
#include "cli/view/window_services.h"
#include "cli/base/pattern.h"
#include "cli/input/lod_input.h"
#include "cli/input/photo_input.h"
#include "cli/input/scene_input.h"
#include "cli/render/picture.h"
#include "cli/view/window_files.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    PREVIEW_POINTS = 200000,
    MANY_POINTS = 400000, ///< take a while to become surfels with levels
};

/// Radii of a preview, in units that keep its area.
static const double PREVIEW_GROWTH = 1.5;

/// Copies point `from` of a stream, when there is one.
static void copy_numbers(const ewa_attribute *stream, uint64_t from, uint64_t to, double scale,
                         float *numbers) {
    double read[4];
    if (!stream) return;
    ewa_attribute_read_f64(stream, from, 1, read);
    for (uint32_t c = 0; c < stream->component_count; c++)
        numbers[stream->component_count * to + c] = (float)(scale * read[c]);
}

/// One of every `step` points, not always the same one: files have rows.
static uint64_t choose_point(uint64_t index, uint64_t step, uint64_t count) {
    const uint64_t mixed = (index * 0x9e3779b97f4a7c15u) >> 32, point = index * step + mixed % step;
    return point < count ? point : count - 1;
}

/// Gives points that are drawn as discs of pixels a radius that framing does not see.
static void set_small_radii(const ewa_cloud *cloud, uint64_t count, float *radii) {
    ewa_bounds box = {.finite_count = 0};
    double size = 0;
    if (ewa_cloud_measure(cloud, &box) == EWA_OK && box.finite_count)
        for (int c = 0; c < 3; c++) size += box.high_world[c] - box.low_world[c];
    for (uint64_t i = 0; i < count; i++) radii[i] = (float)(size > 0 ? 1e-4 * size : 1);
}

/// Some of a cloud's points: larger, where they have normals and radii, else with what draws them as discs of
/// pixels. NULL: no memory.
static ewa_cloud *make_preview_cloud(ewa_context *context, const ewa_cloud *cloud, bool whole) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const uint64_t step = (count + PREVIEW_POINTS - 1) / PREVIEW_POINTS, kept = (count + step - 1) / step;
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION),
                        *color = ewa_cloud_find(cloud, EWA_COLOR);
    const ewa_attribute *normal = whole ? ewa_cloud_find(cloud, EWA_NORMAL) : NULL,
                        *radius = whole ? ewa_cloud_find(cloud, EWA_RADIUS) : NULL;
    const double larger = PREVIEW_GROWTH * sqrt((double)step);
    ewa_cloud *made = NULL;
    void *positions = NULL, *normals = NULL, *radii = NULL, *colors = NULL;
    const bool with_color = color && color->type == EWA_U8 && color->component_count == 3;
    ewa_status status = ewa_cloud_create(context, kept, &made);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_POSITION, EWA_F64, 3, &positions);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_NORMAL, EWA_F32, 3, &normals);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_RADIUS, EWA_F32, 1, &radii);
    if (status == EWA_OK && with_color) status = ewa_cloud_add(made, EWA_COLOR, EWA_U8, 3, &colors);
    if (status != EWA_OK) {
        ewa_cloud_destroy(&made);
        return NULL;
    }
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    ewa_cloud_set_origin(made, origin);
    for (uint64_t i = 0; i < kept; i++) {
        const uint64_t point = choose_point(i, step, count);
        ewa_attribute_read_f64(position, point, 1, (double *)positions + 3 * i);
        memcpy((float *)normals + 3 * i, (const float[3]){0, 0, 1}, 3 * sizeof(float));
        copy_numbers(normal, point, i, 1, normals);
        copy_numbers(radius, point, i, larger, radii);
        double rgb[3];
        if (with_color) ewa_attribute_read_f64(color, point, 1, rgb);
        for (int c = 0; c < 3 && with_color; c++) ((uint8_t *)colors)[3 * i + (uint64_t)c] = (uint8_t)rgb[c];
    }
    if (!radius) set_small_radii(made, kept, radii);
    return made;
}

/// Frees what a preview is of.
static void free_preview(void *user) {
    ewa_surfels *surfels = user;
    ewa_surfels_destroy(&surfels);
}

/// Shows some points of an asset that takes time to be ready. Without memory there is nothing to see until it is.
static void show_preview(ewa_context *context, const viewer_news *news, const ewa_asset_info *info) {
    const ewa_cloud *cloud = info->cloud;
    const ewa_attribute *normal = ewa_cloud_find(cloud, EWA_NORMAL),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    const bool whole = normal && radius && normal->component_count == 3 && radius->component_count == 1;
    ewa_cloud *some = make_preview_cloud(context, cloud, whole);
    ewa_surfels *surfels = NULL;
    ewa_asset *asset = NULL;
    if (some && ewa_surfels_create(some, NULL, &surfels) == EWA_OK) {
        const ewa_asset_source source = {
            .name = info->name, .surfels = surfels, .release = free_preview, .user = surfels};
        if (ewa_asset_create(context, &source, NULL, &asset) == EWA_OK)
            news->preview(news->user, asset, !whole);
    }
    ewa_cloud_destroy(&some);
}

static ewa_context *context(void *user, const viewer_news *news) {
    window_services *own = user;
    own->listener = (session_listener){news->user, news->message, news->progress};
    own->loading.reported = false;
    if (!own->loading.context)
        own->loading.context = session_context(&own->loading, own->thread_count, EWA_CPU_ALL);
    if (!own->loading.context) news->message(news->user, EWA_SEVERITY_ERROR, "out of memory");
    return own->loading.context;
}

/// How a file is loaded of which a scene file and the user have said so much.
static ewa_asset_options load_options(window_services *own, const ewa_asset_options *said) {
    const ewa_asset_options program = scene_input_asset_options(&own->loading);
    ewa_asset_options options = *said;
    options.load = program.load;
    options.reader = program.reader;
    options.reader_user = program.reader_user;
    if (!options.filter) options.filter = program.filter;
    // As scene files are opened by a command: they say more than it does of one file.
    ewa_asset_options look = options;
    look_set_asset_options(own->look, &look);
    if (options.levels == EWA_OCTREE_AUTO) options.levels = look.levels;
    if (!options.gaussians_as_surfels) options.gaussians_as_surfels = look.gaussians_as_surfels;
    options.cutoff = look.cutoff;
    options.reach_steps = look.reach_steps;
    return options;
}

static bool load(void *user, const char *path, const ewa_asset_options *said, const viewer_news *news, ewa_asset **asset) {
    window_services *own = user;
    ewa_asset_options options = load_options(own, said);
    options.voxel_level_minimum = VIEWER_VOXEL_LEVELS;
    options.gaussian_levels = true;
    options.own_context = true;
    if (!session_passed(&own->loading, ewa_asset_load(own->loading.context, path, &options, asset)))
        return false;
    ewa_asset_info info;
    ewa_asset_describe(*asset, &info);
    if (info.cloud && !info.count) {
        news->message(news->user, EWA_SEVERITY_ERROR, "--filter: none of the points is left");
        ewa_asset_release(asset);
        return false;
    }
    if (info.cloud && (info.count > MANY_POINTS || !info.drawable))
        show_preview(own->loading.context, news, &info);
    return true;
}

/// Loads all points of a file, in their own colours.
static bool load_points(cli_session *session, const char *path, const ewa_asset_options *options, ewa_cloud **cloud) {
    ewa_scene *scene = NULL;
    ewa_asset *asset = NULL;
    ewa_instance instance;
    ewa_instance_init(&instance, sizeof instance);
    strcpy(instance.coloring.attribute, "none");
    const bool done = session_passed(session, ewa_asset_load(session->context, path, options, &asset)) &&
                      session_passed(session, ewa_scene_create(session->context, NULL, &scene)) &&
                      session_passed(session, ewa_scene_add(scene, asset, &instance)) &&
                      session_passed(session, ewa_scene_cloud(scene, cloud));
    ewa_asset_release(&asset);
    ewa_scene_destroy(&scene);
    return done;
}

static bool photos(void *user, const char *path, const ewa_asset_options *said, const viewer_photos *wanted, const viewer_news *news,
                   ewa_photos_report *report) {
    (void)news; // the session tells
    window_services *own = user;
    cli_session *session = &own->loading;
    ewa_asset_options options = load_options(own, said);
    options.gaussians_as_surfels = true;
    options.levels = EWA_OCTREE_NEVER;
    options.cutoff = wanted->options.cutoff;
    const photo_arguments arguments = {.cameras_path = wanted->cameras,
                                       .images_path = wanted->images[0] ? wanted->images : NULL,
                                       .masks_path = wanted->masks[0] ? wanted->masks : NULL};
    uint32_t count;
    ewa_photo_list *list = photo_input_load(session, &arguments);
    const ewa_photo *taken = ewa_photo_list_photos(list, &count);
    ewa_cloud *cloud = NULL;
    const bool done = list && load_points(session, path, &options, &cloud) &&
                      session_passed(session, ewa_cloud_color_from_photos(cloud, taken, count, &wanted->options, report, NULL)) &&
                      session_passed(session, ewa_cloud_save(cloud, wanted->to, NULL));
    ewa_cloud_destroy(&cloud);
    ewa_photo_list_destroy(&list);
    return done;
}

/// The camera's options, for a named view without those that say otherwise.
static view_arguments place_arguments(const window_services *own, const char *view,
                                      const ewa_camera *camera) {
    view_arguments arguments = *own->view;
    arguments.size = (option_size){camera->width_px, camera->height_px, true};
    if (!view) return arguments;
    arguments.camera_path = NULL;
    arguments.eye.count = arguments.target.count = 0;
    arguments.azimuth_deg = arguments.elevation_deg = 0;
    const int named = viewer_view_find(view);
    if (named >= 0) arguments.view = named;
    return arguments;
}

static bool place(void *user, ewa_scene *scene, const char *view, bool color_bar, ewa_camera *camera, double up_world[3]) {
    window_services *own = user;
    cli_session *session = &own->session;
    session->reported = false;
    view_arguments arguments = place_arguments(own, view, camera);
    arguments.color_bar = color_bar;
    const view_subject subject = {.scene = scene};
    view_turn turn;
    return view_make(session, &arguments, &subject, camera, NULL) &&
           view_axis(session, &arguments, &subject, &turn) &&
           memcpy(up_world, turn.axis_world, sizeof turn.axis_world);
}

static void say(void *user, bool message, const char *text) {
    const window_services *own = user;
    if (!message) {
        puts(text);
        fflush(stdout);
    } else if (!own->session.quiet) {
        fprintf(stderr, "ewa: %s\n", text);
    }
}

static bool film_begin(void *user, const char *path, uint32_t width_px, uint32_t height_px, bool opaque) {
    window_services *own = user;
    cli_session *session = &own->session;
    const video_format *format = video_find_format(path);
    const video_settings settings = {
        .width_px = width_px, .height_px = height_px, .frames_per_s = VIDEO_FRAMES_PER_S, .quality = VIDEO_QUALITY, .opaque = opaque};
    session->reported = false;
    own->film_path = path;
    own->film_width_px = width_px, own->film_height_px = height_px;
    own->film_opaque = opaque;
    own->film_count = 0;
    own->video = (cli_video){.path = NULL};
    if (!format && !pattern_is_numbered(path))
        session_fail(session, "%s: neither a film (.mp4, .mkv, .webm, .gif) nor numbered pictures (%%04d.png)", path);
    else if (format && !video_has_alpha(format) && !opaque)
        session_fail(session, "%s: this film has no transparency; .webm has, and so have numbered pictures", path);
    else
        return !format || video_start(session, path, &settings, &own->video);
    return false;
}

static bool film_put(void *user, uint8_t *rgba8) {
    window_services *own = user;
    cli_session *session = &own->session;
    if (own->video.path) return video_put(session, &own->video, rgba8);
    char path[VIEWER_PATH_BYTES];
    session->subject = path;
    const bool named = pattern_expand(own->film_path, own->film_count++, sizeof path, path);
    const bool done = named && session_passed(session, picture_save_codes(session->context, path, own->film_width_px,
                                                                          own->film_height_px, own->film_opaque, rgba8, NULL));
    session->subject = NULL;
    return done;
}

static bool film_end(void *user, bool whole) {
    window_services *own = user;
    if (own->video.path && whole) return video_finish(&own->session, &own->video);
    video_drop(&own->video);
    return true;
}

static bool interrupted(void *user) {
    (void)user;
    return session_interrupted();
}

bool window_services_make(window_services *own, const view_arguments *view, const look_arguments *arguments, viewer_look *look,
                          viewer_services *services) {
    const common_arguments *common = &view->common;
    *own = (window_services){.view = view, .look = arguments, .thread_count = (uint32_t)common->threads};
    *services = (viewer_services){.user = own,
                                  .context = context,
                                  .load = load,
                                  .photos = photos,
                                  .place = place,
                                  .say = say,
                                  .interrupted = interrupted,
                                  .film_begin = film_begin,
                                  .film_put = film_put,
                                  .film_end = film_end};
    if (!session_start(&own->session, common)) return false;
    own->loading = (cli_session){.load = own->session.load,
                                 .filter = own->session.filter,
                                 .listener = &own->listener,
                                 .open_file = window_file_open,
                                 .limits = own->session.limits,
                                 .named_files = own->session.named_files,
                                 .untrusted = own->session.untrusted,
                                 .quiet = common->quiet,
                                 .started_s = clock_now_s()};
    if (!light_load(&own->session, &arguments->light, &own->lit_by)) return false;
    own->session.subject = NULL;
    viewer_look_init(look);
    look->scene = look_scene_options(arguments, &own->lit_by);
    look->furniture.title = arguments->furniture.title;
    look->furniture.unit = arguments->furniture.unit;
    look->furniture.axes = arguments->furniture.axes;
    look->furniture.scale_bar = arguments->furniture.scale_bar;
    look->furniture.color_bar = arguments->furniture.color_bar;
    scene_input_coloring(&arguments->coloring, &look->coloring);
    look->transfer = arguments->transfer;
    return true;
}

void window_services_free(window_services *own) {
    light_free(&own->lit_by);
    ewa_context_destroy(&own->loading.context);
    session_end(&own->session, EXIT_DONE);
}
