// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture of a volume shows: the voxels under a transfer function, and surfaces within.
#include "cli/volume/volume_scene.h"
#include "cli/input/inputs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BINS = 256, CORNERS = 8 };

/// How many times as wide as thick a volume is when it is a slice or a picture.
static const double SLICE_RATIO = 8;

bool volume_scene_is_preset(const char *word) {
    const char *name;
    for (uint32_t i = 0; (name = ewa_transfer_preset_name(i, NULL)); i++)
        if (strcmp(name, word) == 0) return true;
    return false;
}

/// Says what else --transfer could have meant.
static void note_presets(cli_session *session) {
    char names[256] = "auto";
    const char *name;
    for (uint32_t i = 0; (name = ewa_transfer_preset_name(i, NULL)); i++) {
        const size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, ", %s", name);
    }
    session_note(session, "the presets of --transfer are %s", names);
}

/// The value at an end of --range: a number, or that below which so many per cent of the voxels lie.
static double range_end(const option_bounds *range, int end, const ewa_volume_facts *facts) {
    if (!range->percent[end]) return range->values[end];
    const double wanted = 0.01 * range->values[end] * (double)facts->finite_count;
    double below = 0;
    int bin = 0;
    while (bin < BINS - 1 && below + (double)facts->histogram[bin] < wanted)
        below += (double)facts->histogram[bin++];
    return facts->low + (facts->high - facts->low) * bin / (BINS - 1);
}

/// Spreads the points of a transfer function over other values.
static bool apply_range(cli_session *session, const option_bounds *range, const ewa_volume_facts *facts,
                        ewa_transfer *transfer) {
    const double low = range_end(range, 0, facts), high = range_end(range, 1, facts);
    ewa_transfer_point *points = transfer->points, *last = &points[transfer->point_count - 1];
    const double from = points->value, width = last->value - from;
    if (!(low < high) || !(width > 0)) {
        session_fail(session, "--range: from %g to %g there is nothing", low, high);
        return false;
    }
    for (ewa_transfer_point *p = points; p <= last; p++)
        p->value = low + (p->value - from) / width * (high - low);
    return true;
}

/// Chooses the transfer function: from a file, a preset, or the histogram. Returns false after reporting.
static bool choose_transfer(cli_session *session, const volume_scene_arguments *arguments,
                            const ewa_volume *volume, ewa_transfer *transfer) {
    const char *word = arguments->transfer;
    const bool file = word && strcmp(word, "auto") != 0 && !volume_scene_is_preset(word);
    ewa_volume_facts facts;
    ewa_status status = ewa_volume_measure(volume, &facts);
    if (status == EWA_OK && !facts.finite_count) {
        session_fail(session, "no voxel is a finite number");
        return false;
    }
    const char *subject = session->subject;
    if (file) session->subject = word;
    if (status == EWA_OK)
        status = file                                ? ewa_transfer_load(session->context, word, transfer)
                 : word && strcmp(word, "auto") != 0 ? ewa_transfer_preset(volume, &facts, word, transfer)
                                                     : ewa_transfer_automatic(volume, &facts, transfer);
    if (status != EWA_OK) {
        session_failed(session, status);
        if (file && status == EWA_ERROR_IO) note_presets(session);
        return false;
    }
    session->subject = subject;
    if (arguments->range.given && !apply_range(session, &arguments->range, &facts, transfer)) return false;
    if (arguments->gradient.count) {
        transfer->gradient_low = arguments->gradient.values[0];
        transfer->gradient_high = arguments->gradient.values[1];
    }
    if (!arguments->save_transfer_path) return true;
    session->subject = arguments->save_transfer_path;
    status = ewa_transfer_save(session->context, transfer, arguments->save_transfer_path);
    if (status != EWA_OK) session_failed(session, status);
    session->subject = subject;
    return status == EWA_OK;
}

/// Loads the surfaces within. Returns false after reporting.
static bool load_surfels(cli_session *session, const char *path, volume_scene *scene) {
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    double estimate_s = 0;
    ewa_cloud *cloud = input_as_surfels(session, path, options.cutoff, &estimate_s);
    if (!cloud) return false;
    ewa_status status = ewa_cloud_measure(cloud, &scene->surfels_bounds);
    if (status == EWA_OK) status = ewa_surfels_create(cloud, &options, &scene->surfels);
    bool done = status == EWA_OK;
    if (done) {
        ewa_surfels_info info;
        ewa_surfels_describe(scene->surfels, &info);
        session->subject = path;
        done = ewa_cloud_report_invalid_points(cloud, &info) == EWA_OK;
    } else {
        session_failed(session, status);
    }
    ewa_cloud_destroy(&cloud);
    return done;
}

static bool classify(cli_session *session, const ewa_volume *volume, const ewa_transfer *transfer,
                     double reach_steps, uint32_t level_count, volume_scene *scene) {
    ewa_voxels_options options;
    ewa_voxels_options_init(&options, sizeof options);
    options.level_count = level_count;
    const double started_s = clock_now_s();
    ewa_status status = ewa_voxels_create(volume, transfer, &options, &scene->voxels);
    scene->classify_s = clock_now_s() - started_s;
    if (status == EWA_OK) status = ewa_volume_outline(volume, transfer, reach_steps, &scene->outline);
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    ewa_voxels_describe(scene->voxels, &scene->info);
    if (!scene->info.occupied_count) session_warn(session, "the transfer function leaves all voxels empty");
    return true;
}

/// A patient is seen from the front, a slice from where it is not a line (a picture upright), and what
/// nothing is known of from a corner, which shows most of any shape.
static int choose_view(const ewa_volume *volume) {
    double thickness = INFINITY, width = INFINITY;
    int thin = 0, single_count = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double *m = volume->index_to_world + axis;
        const bool single = volume->dims[axis] == 1;
        const double extent = single ? 0 : volume->dims[axis] * hypot(hypot(m[0], m[4]), m[8]);
        single_count += single;
        if (extent < thickness) {
            width = thickness;
            thickness = extent;
            thin = axis;
        } else if (extent < width) {
            width = extent;
        }
    }
    const double *m = volume->index_to_world + thin;
    const double x = fabs(m[0]), y = fabs(m[4]), z = fabs(m[8]);
    if (single_count < 2 && width > SLICE_RATIO * thickness)
        return z >= x && z >= y ? EWA_VIEW_BOTTOM : x > y ? EWA_VIEW_LEFT : EWA_VIEW_FRONT;
    return volume->anatomical ? EWA_VIEW_FRONT : EWA_VIEW_ISO;
}

bool volume_scene_load(cli_session *session, const volume_input_arguments *input,
                       const volume_scene_arguments *arguments, const char *path, uint32_t level_count,
                       volume_scene *scene) {
    *scene = (volume_scene){.voxels = NULL};
    const char *word = arguments->transfer;
    scene->flat = word && (strcmp(word, "fog") == 0 || strcmp(word, "gray") == 0);
    const double started_s = clock_now_s();
    ewa_volume volume = {.context = NULL};
    ewa_transfer transfer;
    bool done = volume_input_load(session, input, path, &volume);
    scene->load_s = clock_now_s() - started_s;
    done = done && choose_transfer(session, arguments, &volume, &transfer) &&
           classify(session, &volume, &transfer, arguments->options.sigma * arguments->options.cutoff,
                    level_count, scene);
    if (done) scene->view = choose_view(&volume);
    ewa_volume_free(&volume);
    if (done && arguments->surfels_path) done = load_surfels(session, arguments->surfels_path, scene);
    session->subject = path;
    return done;
}

void volume_scene_free(volume_scene *scene) {
    ewa_voxels_destroy(&scene->voxels);
    ewa_surfels_destroy(&scene->surfels);
    ewa_cloud_destroy(&scene->outline);
}

/// Adds the corners of the surfaces' box, or of any box when there is nothing at all, to the outline of the
/// volume. NULL after reporting.
static ewa_cloud *make_outline(cli_session *session, const volume_scene *scene) {
    const ewa_bounds *box = &scene->surfels_bounds;
    static const ewa_bounds any = {.low_world = {-1, -1, -1}, .high_world = {1, 1, 1}};
    const bool surfels = scene->surfels && box->finite_count;
    const uint64_t count = ewa_cloud_point_count(scene->outline);
    if (!surfels && !count) box = &any;
    const uint64_t corners = surfels || !count ? CORNERS : 0;
    ewa_cloud *cloud = NULL;
    void *data = NULL;
    ewa_status status = ewa_cloud_create(session->context, count + corners, &cloud);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data);
    if (status != EWA_OK) {
        session_failed(session, status);
        ewa_cloud_destroy(&cloud);
        return NULL;
    }
    double *positions = data;
    ewa_attribute_read_f64(ewa_cloud_find(scene->outline, EWA_POSITION), 0, count, positions);
    positions += 3 * count;
    for (uint64_t i = 0; i < corners; i++)
        for (int k = 0; k < 3; k++)
            positions[3 * i + (uint64_t)k] = i >> k & 1 ? box->high_world[k] : box->low_world[k];
    return cloud;
}

bool volume_scene_frame(cli_session *session, const frames_arguments *arguments, const volume_scene *scene,
                        frame_cameras *frames) {
    ewa_cloud *cloud = make_outline(session, scene);
    if (!cloud) return false;
    // Scanners' volumes stand on z, whatever their proportions.
    frames_arguments chosen = *arguments;
    view_arguments *view = &chosen.view;
    const bool turned = view->azimuth_deg != 0 || view->elevation_deg != 0 || view->up.count;
    if (view->view < 0) view->view = turned ? EWA_VIEW_FRONT : scene->view;
    const bool done = frames_make(session, &chosen,
                                  &(view_subject){.cloud = cloud, .radius_scale = 1, .up_axis = 2}, frames);
    ewa_cloud_destroy(&cloud);
    return done;
}
