// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of points as inputs.
#include "cli/input/lod_input.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/// Boxes of so much of an octree are cheaper to have by its nodes than by reading all and leaving out the rest.
static const double SMALL_SHARE = 0.25;

void lod_input_set_defaults(lod_arguments *arguments) {
    ewa_lod_options_init(&arguments->options, sizeof arguments->options);
}

ewa_octree_levels lod_input_levels(const lod_arguments *arguments) {
    const bool whole = arguments->options.error == 0 && arguments->levels == EWA_OCTREE_AUTO;
    return whole ? EWA_OCTREE_NEVER : (ewa_octree_levels)arguments->levels;
}

ewa_lod *lod_input_open(cli_session *session, const char *path) {
    ewa_lod *lod = NULL;
    session->subject = path;
    const ewa_status status = ewa_lod_open(session->context, path, &lod);
    if (status != EWA_OK) session_failed(session, status);
    return lod;
}

bool lod_input_serves(cli_session *session, const char *path, const double corners_world[6]) {
    if (!ewa_lod_probe(session->context, path)) return false;
    if (ewa_lod_is_folder(session->context, path)) return true;
    ewa_lod *lod = lod_input_open(session, path);
    if (!lod) return false;
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    double share = 1;
    for (int c = 0; c < 3; c++) {
        const double low = info.bounds.low_world[c], high = info.bounds.high_world[c];
        const double inside = fmin(corners_world[3 + c], high) - fmax(corners_world[c], low);
        if (high > low) share *= fmax(inside, 0) / (high - low);
    }
    ewa_lod_close(&lod);
    return share < SMALL_SHARE;
}

ewa_cloud *lod_input_read(cli_session *session, const char *path, const double corners_world[6]) {
    ewa_lod *lod = lod_input_open(session, path);
    if (!lod) return NULL;
    double low_world[3], high_world[3];
    for (int c = 0; c < 3; c++) {
        low_world[c] = corners_world ? fmin(corners_world[c], corners_world[3 + c]) : -INFINITY;
        high_world[c] = corners_world ? fmax(corners_world[c], corners_world[3 + c]) : INFINITY;
    }
    ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_lod_read(lod, low_world, high_world, 0, &cloud);
    if (status != EWA_OK) session_failed(session, status);
    ewa_lod_close(&lod);
    return cloud;
}
