// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The scene of a volume: its voxels under the transfer function that the options ask for, and a surface within.
#include "cli/volume/volume_scene.h"
#include "cli/input/scene_input.h"

#include <string.h>

enum { BINS = 256 };

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
static bool apply_range(cli_session *session, const option_bounds *range, const ewa_volume *volume,
                        ewa_transfer *transfer) {
    ewa_volume_facts facts;
    const ewa_status status = ewa_volume_measure(volume, &facts);
    if (status != EWA_OK) return session_failed(session, status) == EXIT_DONE;
    const double low = range_end(range, 0, &facts), high = range_end(range, 1, &facts);
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

/// Makes the transfer function that the options ask for, and saves it. Returns false after reporting.
static bool make_transfer(cli_session *session, const volume_scene_arguments *arguments,
                          const ewa_volume *volume, ewa_transfer *transfer) {
    ewa_status status = ewa_transfer_choose(session->context, arguments->transfer, volume, transfer);
    if (status != EWA_OK) return session_failed(session, status) == EXIT_DONE;
    if (arguments->range.given && !apply_range(session, &arguments->range, volume, transfer)) return false;
    if (arguments->gradient.count) {
        transfer->gradient_low = arguments->gradient.values[0];
        transfer->gradient_high = arguments->gradient.values[1];
    }
    if (!arguments->save_transfer_path) return true;
    session->subject = arguments->save_transfer_path;
    status = ewa_transfer_save(session->context, transfer, arguments->save_transfer_path);
    return status == EWA_OK || session_failed(session, status) == EXIT_DONE;
}

/// Adds what an asset source or a file is; `path` is what messages call it. Returns false after reporting.
static bool add(cli_session *session, const char *path, const ewa_asset_source *source,
                const ewa_asset_options *options, ewa_scene *scene) {
    ewa_asset *asset = NULL;
    ewa_asset_info info = {.kind = EWA_ASSET_POINTS};
    session->subject = NULL;
    ewa_status status = source ? ewa_asset_create(session->context, source, options, &asset)
                               : ewa_asset_load(session->context, path, options, &asset);
    if (status == EWA_OK) ewa_asset_describe(asset, &info);
    const bool wrong = !source && info.kind == EWA_ASSET_VOLUME;
    if (wrong) session_fail(session, "%s: a volume is no surface; `ewa render` draws several volumes", path);
    if (status == EWA_OK && !wrong) status = ewa_scene_add(scene, asset, NULL);
    ewa_asset_release(&asset);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK && !wrong;
}

bool volume_scene_fill(cli_session *session, const volume_input_arguments *input,
                       const volume_scene_arguments *arguments, const char *path, uint32_t level_count,
                       ewa_scene *scene) {
    ewa_asset_options options = scene_input_asset_options(session);
    options.transfer = arguments->transfer; // by which what is made of it is lit, or not
    options.voxel_level_count = level_count;
    options.reach_steps = arguments->options.sigma * arguments->options.cutoff;
    options.gaussians_as_surfels = true; // opaque, as all else within
    ewa_volume volume = {.context = NULL};
    ewa_transfer transfer;
    const ewa_asset_source source = {.name = path, .volume = &volume, .transfer = &transfer};
    const bool done = volume_input_load(session, input, path, &volume) &&
                      make_transfer(session, arguments, &volume, &transfer) &&
                      add(session, path, &source, &options, scene) &&
                      (!arguments->surfels_path || add(session, arguments->surfels_path, NULL, &options, scene));
    ewa_volume_free(&volume);
    session->subject = path;
    return done;
}
