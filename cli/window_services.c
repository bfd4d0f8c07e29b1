// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the viewer asks of the program.
#include "window_services.h"
#include "color_by.h"
#include "gaussian_files.h"
#include "gaussian_scene.h"
#include "inputs.h"
#include "lod_input.h"
#include "resident.h"
#include "volume_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEVELS = 8,
    VOXEL_LEVELS = 2,
    PREVIEW_POINTS = 200000,
    MANY_POINTS = 400000,   ///< take a while to become surfels with levels
    SAMPLE_POINTS = 100000, ///< of each of several clouds, for framing them together
};

/// Radii of a preview, in units that keep its area.
static const double PREVIEW_GROWTH = 1.5;

/// The session of one file, which lives as long as what was loaded: its context reports to it.
typedef struct file_session {
    cli_session session;
    session_listener listener;
} file_session;

/// Frees what a file gave, and its session.
static void free_content(viewer_content *content) {
    file_session *file = content->keeper;
    ewa_surfels_destroy(&content->surfels);
    ewa_voxels_destroy(&content->voxels);
    ewa_splats_destroy(&content->splats);
    ewa_cloud_destroy(&content->cloud);
    ewa_cloud_destroy(&content->outline);
    ewa_lod_close(&content->lod);
    ewa_context_destroy(&file->session.context);
    free(file);
}

/// Makes a session whose news go to the viewer; NULL after telling it.
static file_session *make_session(const window_services *own, const viewer_news *news, uint32_t thread_count,
                                  bool quiet, viewer_content *content) {
    file_session *file = calloc(1, sizeof *file);
    if (!file) {
        news->message(news->user, EWA_SEVERITY_ERROR, "out of memory");
        return NULL;
    }
    file->listener = (session_listener){news->user, news->message, news->progress};
    file->session = (cli_session){.load = own->session.load,
                                  .filter = own->session.filter,
                                  .listener = &file->listener,
                                  .quiet = quiet,
                                  .started_s = clock_now_s()};
    file->session.context = session_context(&file->session, thread_count, EWA_CPU_ALL);
    *content = (viewer_content){.keeper = file, .free = free_content, .context = file->session.context};
    if (file->session.context) return file;
    free_content(content);
    *content = (viewer_content){.keeper = NULL};
    return NULL;
}

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

/// Shows some points of a cloud that is not ready. Without memory there is nothing to see until it is.
static void show_preview(const window_services *own, const viewer_news *news, const ewa_cloud *cloud) {
    viewer_content content;
    file_session *file = make_session(own, news, 1, true, &content);
    if (!file) return;
    const ewa_attribute *normal = ewa_cloud_find(cloud, EWA_NORMAL),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    const bool whole = normal && radius && normal->component_count == 3 && radius->component_count == 1;
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    content.cloud = make_preview_cloud(content.context, cloud, whole);
    content.as_points = !whole;
    if (content.cloud && ewa_surfels_create(content.cloud, &options, &content.surfels) == EWA_OK)
        news->preview(news->user, &content);
    else
        free_content(&content);
}

static bool load_volume(cli_session *session, const char *path, viewer_content *content) {
    volume_input_arguments input = {.type = -1};
    volume_scene_arguments arguments = {.transfer = NULL};
    volume_input_set_defaults(&input);
    ewa_volume_options_init(&arguments.options, sizeof arguments.options);
    volume_scene scene;
    const bool done = volume_scene_load(session, &input, &arguments, path, VOXEL_LEVELS, &scene);
    if (done) {
        content->voxels = scene.voxels;
        content->outline = scene.outline;
        scene.voxels = NULL;
        scene.outline = NULL;
    }
    volume_scene_free(&scene);
    return done;
}

static bool load_gaussians(cli_session *session, const char *path, viewer_content *content) {
    gaussian_scene scene = {.path = NULL};
    const bool done = gaussian_scene_load(session, path, &scene);
    if (done) {
        content->splats = scene.splats;
        content->outline = scene.outline;
        content->up_axis = scene.up_axis;
        scene.splats = NULL;
        scene.outline = NULL;
    }
    gaussian_scene_free(&scene);
    return done;
}

static resident_options surfels_options(const window_services *own, double radius_scale) {
    resident_options options = {own->surfels, own->close_gaps, false};
    options.surfels.level_count = LEVELS;
    options.surfels.radius_scale *= radius_scale;
    return options;
}

static bool load_points(const window_services *own, cli_session *session, const char *path,
                        const viewer_news *news, viewer_content *content) {
    double estimate_s = 0;
    content->cloud = input_points(session, path, own->surfels.cutoff, &content->mesh);
    if (!content->cloud) return false;
    const bool takes_time = ewa_cloud_point_count(content->cloud) > MANY_POINTS;
    if (takes_time || !cloud_is_drawable(content->cloud)) show_preview(own, news, content->cloud);
    render_report report = {.load_s = 0};
    const resident_options options = surfels_options(own, 1);
    return input_complete(session, path, &content->cloud, &estimate_s) &&
           resident_make(session, &options, &content->cloud, &content->surfels, &report);
}

/// What an octree says while it is drawn, on whichever thread: nobody waits for it.
static void octree_message(void *user, ewa_severity severity, const char *text) {
    const file_session *file = user;
    (void)severity;
    if (!file->session.quiet) fprintf(stderr, "ewa: %s\n", text);
}

static bool octree_progress(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return true;
}

/// Opens an octree that is drawn from its levels: one that has surfels for them, or a large one. `*done` is false
/// after reporting. Returns whether it is one.
static bool load_octree(const window_services *own, file_session *file, const char *path,
                        viewer_content *content, bool *done) {
    cli_session *session = &file->session;
    *done = true;
    if (own->whole || session->filter || session->load.columns || !ewa_lod_probe(session->context, path))
        return false;
    ewa_lod *lod = lod_input_open(session, path);
    if (!lod) return false; // its points may be read yet
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    if (!info.merged && info.point_count <= LOD_WHOLE_POINTS) {
        ewa_lod_close(&lod);
        return false;
    }
    content->lod = lod;
    double estimate_s = 0;
    content->outline = lod_input_sample(session, lod, path);
    *done = content->outline && input_complete(session, path, &content->outline, &estimate_s);
    if (*done) file->listener = (session_listener){file, octree_message, octree_progress};
    return true;
}

static bool load(void *user, const char *path, const viewer_news *news, viewer_content *content) {
    const window_services *own = user;
    file_session *file = make_session(own, news, own->thread_count, own->quiet, content);
    if (!file) return false;
    file->session.subject = path;
    bool done = true;
    if (volume_input_is_named(path))
        done = load_volume(&file->session, path, content);
    else if (gaussian_files_format(&file->session, path) != EWA_GAUSSIANS_NONE)
        done = load_gaussians(&file->session, path, content);
    else if (!load_octree(own, file, path, content, &done))
        done = load_points(own, &file->session, path, news, content);
    file->session.subject = NULL;
    return done;
}

/// Multiplies the points' alpha.
static ewa_status fade(ewa_cloud *cloud, double alpha) {
    const ewa_status status = colors_to_linear(cloud);
    if (status != EWA_OK) return status;
    float *colors = ewa_cloud_find(cloud, EWA_COLOR)->data;
    const uint64_t count = ewa_cloud_point_count(cloud);
    for (uint64_t i = 0; i < count; i++) colors[4 * i + 3] *= (float)alpha;
    return EWA_OK;
}

/// A cloud over the streams of another one, which stay where they are.
static ewa_status borrow_cloud(const ewa_cloud *cloud, ewa_context *context, ewa_cloud **made) {
    ewa_status status = ewa_cloud_create(context, ewa_cloud_point_count(cloud), made);
    const ewa_attribute *a;
    for (uint32_t k = 0; status == EWA_OK && (a = ewa_cloud_attribute_at(cloud, k)); k++)
        status = ewa_cloud_borrow(*made, a->name, a->type, a->component_count, a->data, a->stride_bytes);
    if (status != EWA_OK) return status;
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    ewa_cloud_set_origin(*made, origin);
    return EWA_OK;
}

/// Colours by an attribute, without the outermost two per cent of the numbers where no range is asked for, and
/// fills in what the colours mean.
static bool color_scaled(cli_session *session, ewa_cloud *cloud, viewer_coloring *wish) {
    const option_bounds range = wish->ranged
                                    ? (option_bounds){{wish->range[0], wish->range[1]}, {false, false}, true}
                                    : (option_bounds){{2, 98}, {true, true}, true};
    color_scale scale = {.categories = NULL};
    const bool classes = !wish->ranged && wish->colormap == VIEWER_COLORMAP_AUTO &&
                         color_by_shows_classes(session, cloud, wish->attribute);
    const bool done = color_by(session, cloud, wish->attribute, classes ? COLOR_BY_CLASSES : wish->colormap,
                               &range, &scale);
    memcpy(wish->range, scale.range, sizeof scale.range);
    wish->class_count = 0;
    for (uint32_t k = 0; done && k < scale.category_count && k < VIEWER_MAX_CLASSES; k++) {
        viewer_class *to = &wish->classes[wish->class_count++];
        to->value = scale.categories[k].value;
        memcpy(to->srgb, scale.categories[k].srgb, sizeof to->srgb);
        snprintf(to->name, sizeof to->name, "%s", scale.categories[k].name);
    }
    color_scale_free(&scale);
    return done;
}

static bool color(void *user, const viewer_content *content, const viewer_news *news, viewer_coloring *wish,
                  ewa_surfels **surfels) {
    const window_services *own = user;
    file_session *file = content->keeper;
    file->listener = (session_listener){news->user, news->message, news->progress};
    cli_session *session = &file->session;
    session->reported = false;
    ewa_cloud *cloud = NULL;
    ewa_status status = borrow_cloud(content->cloud, content->context, &cloud);
    bool done = status == EWA_OK;
    if (done && wish->attribute[0])
        done = color_scaled(session, cloud, wish);
    else if (done && wish->tinted)
        status = cloud_set_color(cloud, wish->tint);
    if (done && status == EWA_OK && wish->alpha < 1) status = fade(cloud, wish->alpha);
    const resident_options options = surfels_options(own, wish->radius_scale);
    if (done && status == EWA_OK) status = ewa_surfels_create(cloud, &options.surfels, surfels);
    ewa_cloud_destroy(&cloud);
    if (status != EWA_OK) session_failed(session, status);
    return done && status == EWA_OK;
}

/// Adds the positions of some points, and their radii where there are some.
static void sample_points(const ewa_cloud *cloud, uint64_t step, double *positions, float *radii) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    for (uint64_t i = 0; i < count; i += step, positions += 3, radii++) {
        double r = 0;
        ewa_attribute_read_f64(position, i, 1, positions);
        for (int c = 0; c < 3; c++) positions[c] += origin[c];
        if (radius && radius->component_count == 1) ewa_attribute_read_f64(radius, i, 1, &r);
        *radii = (float)r;
    }
}

static const ewa_cloud *outline_of(const viewer_content *content) {
    return content->cloud ? content->cloud : content->outline;
}

static uint64_t sample_step(const ewa_cloud *cloud) {
    return ewa_cloud_point_count(cloud) / SAMPLE_POINTS + 1;
}

/// One cloud of a sample of all of them, for framing. NULL after reporting.
static ewa_cloud *join_samples(cli_session *session, size_t count, const viewer_content *const *contents) {
    uint64_t total = 0;
    for (size_t i = 0; i < count; i++) {
        const ewa_cloud *cloud = outline_of(contents[i]);
        const uint64_t step = sample_step(cloud);
        total += (ewa_cloud_point_count(cloud) + step - 1) / step;
    }
    ewa_cloud *joined = NULL;
    void *positions = NULL, *radii = NULL;
    ewa_status status = ewa_cloud_create(session->context, total, &joined);
    if (status == EWA_OK) status = ewa_cloud_add(joined, EWA_POSITION, EWA_F64, 3, &positions);
    if (status == EWA_OK) status = ewa_cloud_add(joined, EWA_RADIUS, EWA_F32, 1, &radii);
    if (status != EWA_OK) {
        session_failed(session, status);
        ewa_cloud_destroy(&joined);
        return NULL;
    }
    uint64_t at = 0;
    for (size_t i = 0; i < count; i++) {
        const ewa_cloud *cloud = outline_of(contents[i]);
        const uint64_t step = sample_step(cloud);
        sample_points(cloud, step, (double *)positions + 3 * at, (float *)radii + at);
        at += (ewa_cloud_point_count(cloud) + step - 1) / step;
    }
    return joined;
}

/// The camera's options, for a named view without those that say otherwise.
static view_arguments place_arguments(const window_services *own, size_t count, const char *const *paths,
                                      const char *view, const ewa_camera *camera) {
    static const char *const names[] = {"front", "back", "left", "right", "top", "bottom", "iso"};
    view_arguments arguments = *own->view;
    arguments.common.operands = paths;
    arguments.common.operand_count = count;
    arguments.size = (option_size){camera->width_px, camera->height_px, true};
    if (!view) return arguments;
    arguments.camera_path = NULL;
    arguments.eye.count = arguments.target.count = 0;
    arguments.azimuth_deg = arguments.elevation_deg = 0;
    for (int i = 0; i < (int)(sizeof names / sizeof names[0]); i++)
        if (strcmp(view, names[i]) == 0) arguments.view = i;
    return arguments;
}

static bool place(void *user, size_t count, const viewer_content *const *contents, const char *const *paths,
                  const char *view, ewa_camera *camera, double up_world[3]) {
    window_services *own = user;
    cli_session *session = &own->session;
    session->reported = false;
    view_arguments arguments = place_arguments(own, count, paths, view, camera);
    if (count == 1 && contents[0]->voxels && !arguments.up.count) { // scanners' volumes stand on z
        arguments.up_axis = 2;
        if (arguments.view < 0 && !view_is_placed(&arguments)) arguments.view = EWA_VIEW_ISO;
    }
    if (count == 1 && contents[0]->up_axis && !arguments.up.count) arguments.up_axis = contents[0]->up_axis;
    ewa_cloud *joined = count > 1 ? join_samples(session, count, contents) : NULL;
    if (count > 1 && !joined) return false;
    const ewa_cloud *cloud = joined ? joined : outline_of(contents[0]);
    ewa_upright chosen = {.axis = abs(arguments.up_axis), .reversed = arguments.up_axis < 0};
    bool done = view_make(session, &arguments, cloud, 1, camera, NULL);
    if (done && arguments.up.count)
        memcpy(up_world, arguments.up.values, 3 * sizeof *up_world);
    else if (done && (chosen.axis || view_default(session, paths[0], cloud, 0, &chosen)))
        for (int c = 0; c < 3; c++) up_world[c] = c == chosen.axis ? (chosen.reversed ? -1 : 1) : 0;
    else
        done = false;
    ewa_cloud_destroy(&joined);
    return done;
}

static void say(void *user, bool message, const char *text) {
    const window_services *own = user;
    if (!message) {
        puts(text);
        fflush(stdout);
    } else if (!own->quiet) {
        fprintf(stderr, "ewa: %s\n", text);
    }
}

static bool interrupted(void *user) {
    (void)user;
    return session_interrupted();
}

bool window_services_make(window_services *own, const view_arguments *view, viewer_services *services) {
    const common_arguments *common = &view->common;
    *own = (window_services){
        .view = view, .close_gaps = true, .thread_count = (uint32_t)common->threads, .quiet = common->quiet};
    ewa_surfels_options_init(&own->surfels, sizeof own->surfels);
    *services = (viewer_services){
        .user = own, .load = load, .color = color, .place = place, .say = say, .interrupted = interrupted};
    return session_start(&own->session, common);
}

void window_services_free(window_services *own) { session_end(&own->session, EXIT_DONE); }
