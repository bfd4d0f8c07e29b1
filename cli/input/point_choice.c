// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which points of a file are taken.
#include "cli/input/point_choice.h"

#include <stdlib.h>
#include <string.h>

/// By what each point is alone.
static ewa_status mark_chosen(const point_choice *choice, const ewa_cloud *cloud, uint8_t *marks) {
    ewa_status status = choice->filter ? ewa_filter_mark(choice->filter, cloud, marks) : EWA_OK;
    if (status == EWA_OK && choice->corners_world) {
        double corners_world[2][3];
        memcpy(corners_world, choice->corners_world, sizeof corners_world);
        status = ewa_box_mark((const double(*)[3])corners_world, cloud, marks);
    }
    if (status == EWA_OK && choice->sphere_world)
        status = ewa_sphere_mark(choice->sphere_world, choice->sphere_world[3], cloud, marks);
    if (status == EWA_OK && choice->polygon) status = ewa_polygon_mark(choice->polygon, cloud, marks);
    return status;
}

static ewa_status mark_thinned(const point_choice *choice, const ewa_cloud *cloud, uint8_t *marks) {
    ewa_status status = EWA_OK;
    if (choice->voxel_world > 0) status = ewa_cloud_thin_voxels(cloud, choice->voxel_world, marks);
    if (status == EWA_OK && choice->distance_world > 0) status = ewa_cloud_thin_distance(cloud, choice->distance_world, marks);
    return status;
}

static ewa_status mark_outliers(const point_choice *choice, const ewa_cloud *cloud, uint8_t *marks) {
    return ewa_cloud_mark_outliers(cloud, choice->outliers, marks);
}

/// Leaves what one step marks; the neighbours of the next are what is left.
static bool take(cli_session *session, const point_choice *choice,
                 ewa_status (*mark)(const point_choice *choice, const ewa_cloud *cloud, uint8_t *marks), ewa_cloud **cloud) {
    const uint64_t count = ewa_cloud_point_count(*cloud);
    uint8_t *marks = malloc(count + 1);
    if (!marks) {
        session_fail(session, "out of memory: %llu marks", (unsigned long long)count);
        return false;
    }
    memset(marks, 1, count);
    ewa_cloud *chosen = NULL;
    ewa_status status = mark(choice, *cloud, marks);
    const bool all = status == EWA_OK && !memchr(marks, 0, count);
    if (status == EWA_OK && !all) status = ewa_cloud_keep(*cloud, marks, &chosen);
    free(marks);
    if (status != EWA_OK) session_failed(session, status);
    if (chosen) {
        ewa_cloud_destroy(cloud);
        *cloud = chosen;
    }
    return status == EWA_OK;
}

bool choose_points(cli_session *session, const point_choice *choice, ewa_cloud **cloud) {
    const uint64_t count = ewa_cloud_point_count(*cloud);
    if (choice->filter || choice->corners_world || choice->sphere_world || choice->polygon)
        if (!take(session, choice, mark_chosen, cloud)) return false;
    if (choice->outliers && ewa_cloud_point_count(*cloud))
        if (!take(session, choice, mark_outliers, cloud)) return false;
    if (choice->voxel_world > 0 || choice->distance_world > 0)
        if (!take(session, choice, mark_thinned, cloud)) return false;
    if (ewa_cloud_point_count(*cloud) < count)
        session_say(session, "%llu of %llu points are taken", (unsigned long long)ewa_cloud_point_count(*cloud),
                    (unsigned long long)count);
    return true;
}

ewa_polygon *choose_outline(cli_session *session, const char *text) {
    ewa_polygon *polygon = NULL;
    const bool numbers = strchr(text, ';') && strspn(text, "0123456789+-.eE,; ") == strlen(text);
    const ewa_status status =
        numbers ? ewa_polygon_read(session->context, "--crop-polygon", text, strlen(text), &polygon)
                : ewa_polygon_load(session->context, text, &polygon);
    if (status != EWA_OK) session_failed(session, status);
    return polygon;
}
