// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of points as inputs.
#include "lod_input.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/// Boxes of so much of an octree are cheaper to have by its nodes than by reading all and leaving out the rest.
static const double SMALL_SHARE = 0.25;

void lod_input_set_defaults(lod_arguments *arguments) {
    ewa_lod_options_init(&arguments->options, sizeof arguments->options);
    arguments->options.memory_bytes = 0;
    arguments->options.spacing_px = 0;
    arguments->options.error = -1;
}

bool lod_input_asked(const lod_arguments *arguments) {
    const ewa_lod_options *given = &arguments->options;
    return given->memory_bytes || given->spacing_px > 0 || given->error > 0;
}

ewa_lod_options lod_input_options(const lod_arguments *arguments) {
    const ewa_lod_options *given = &arguments->options;
    ewa_lod_options options;
    ewa_lod_options_init(&options, sizeof options);
    if (given->memory_bytes) options.memory_bytes = given->memory_bytes;
    if (given->spacing_px > 0) options.spacing_px = given->spacing_px;
    if (given->error >= 0) options.error = given->error;
    return options;
}

bool lod_input_is_folder(cli_session *session, const char *path) {
    struct stat status;
    const char *slash = strrchr(path, '/');
    const bool folder = stat(path, &status) == 0 && S_ISDIR(status.st_mode);
    return (folder || strcmp(slash ? slash + 1 : path, "ept.json") == 0) &&
           ewa_lod_probe(session->context, path);
}

ewa_lod *lod_input_open(cli_session *session, const char *path) {
    ewa_lod *lod = NULL;
    session->subject = path;
    const ewa_status status = ewa_lod_open(session->context, path, &lod);
    if (status != EWA_OK) session_failed(session, status);
    return lod;
}

bool lod_input_is_large(cli_session *session, const char *path) {
    uint64_t point_count = 0;
    if (!lod_input_is_folder(session, path)) { // whose header is enough
        ewa_cloud_reader *reader = NULL;
        if (ewa_cloud_reader_open(session->context, path, &session->load, &reader) == EWA_OK)
            point_count = ewa_cloud_reader_most_points(reader);
        ewa_cloud_reader_close(&reader);
        return point_count > LOD_WHOLE_POINTS;
    }
    ewa_lod *lod = lod_input_open(session, path);
    if (!lod) return false;
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    ewa_lod_close(&lod);
    return info.point_count > LOD_WHOLE_POINTS;
}

bool lod_input_choose(cli_session *session, const common_arguments *common, const lod_arguments *arguments,
                      const char *clash, ewa_lod **lod) {
    *lod = NULL;
    const char *path = common->operands[0];
    const bool asked = lod_input_asked(arguments);
    if (arguments->options.error == 0 || (!asked && common->operand_count > 1)) return true;
    if (asked && common->operand_count > 1) {
        session_fail(session, "--memory, --lod-spacing and --lod-error are for one octree alone");
        return false;
    }
    if (!ewa_lod_probe(session->context, path)) {
        if (!asked) return true;
        session_fail(session, "%s: not an octree (COPC, EPT); `ewa lod %s -o FILE.copc.laz` makes one", path,
                     path);
        return false;
    }
    if (session->filter) clash = "--filter";
    if (session->load.columns) clash = "--columns";
    if (!asked && (clash || session->load.keep_going || !lod_input_is_large(session, path))) return true;
    session->subject = path;
    if (clash) {
        session_fail(session,
                     "%s needs all points, --memory, --lod-spacing and --lod-error do without; leave these "
                     "out, or `ewa convert` what is wanted to a file of its own",
                     clash);
        return false;
    }
    *lod = lod_input_open(session, path);
    return *lod != NULL;
}

ewa_cloud *lod_input_sample(cli_session *session, ewa_lod *lod, const char *path) {
    ewa_cloud *cloud = NULL;
    session->subject = path;
    const ewa_status status = ewa_lod_sample(lod, LOD_SAMPLE_POINTS, &cloud);
    if (status != EWA_OK) session_failed(session, status);
    if (status != EWA_OK || ewa_cloud_point_count(cloud)) return cloud;
    session_fail(session, "%s: the file has no points", path);
    ewa_cloud_destroy(&cloud);
    return NULL;
}

bool lod_input_serves(cli_session *session, const char *path, const double corners_world[6]) {
    if (!ewa_lod_probe(session->context, path)) return false;
    if (lod_input_is_folder(session, path)) return true;
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
