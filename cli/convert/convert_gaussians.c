// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa convert for Gaussians: to another form of them, moved.
#include "cli/convert/convert_gaussians.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/point_choice.h"
#include "cli/input/scene_input.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool convert_gaussians_is_named(const char *path) {
    const ewa_gaussian_format format = ewa_gaussians_format_of(path);
    return format != EWA_GAUSSIANS_NONE && format != EWA_GAUSSIANS_PLY;
}

/// The name of the attribute by which a centre is known again.
static const char NUMBER[] = "gaussian";

/// Names of what Gaussians are chosen by.
#define OPACITY "opacity"
#define SIZE "size"
#define CLASSES "classification"

/// Centres as points, with what Gaussians are chosen by; borrows the centres. The caller destroys it.
static ewa_status make_points(const ewa_gaussians *set, ewa_cloud **points) {
    void *opacities = NULL, *sizes = NULL, *numbers = NULL;
    ewa_status status = ewa_cloud_create(set->context, set->count, points);
    if (status == EWA_OK) status = ewa_cloud_borrow(*points, "position", EWA_F32, 3, set->centers, 0);
    if (status == EWA_OK) status = ewa_cloud_add(*points, OPACITY, EWA_F32, 1, &opacities);
    if (status == EWA_OK) status = ewa_cloud_add(*points, SIZE, EWA_F32, 1, &sizes);
    if (status == EWA_OK && set->classes) status = ewa_cloud_borrow(*points, CLASSES, EWA_U16, 1, set->classes, 0);
    if (status == EWA_OK) status = ewa_cloud_add(*points, NUMBER, EWA_U32, 1, &numbers);
    if (status != EWA_OK) return status;
    ewa_cloud_set_origin(*points, set->origin);
    for (uint32_t i = 0; i < set->count; i++) {
        const float *scales = set->scales + 3 * (size_t)i;
        ((float *)opacities)[i] = set->opacities[i];
        ((float *)sizes)[i] = fmaxf(fmaxf(scales[0], scales[1]), scales[2]);
        ((uint32_t *)numbers)[i] = i;
    }
    return EWA_OK;
}

/// Leaves those of a set that points are the centres of.
static ewa_status keep(ewa_gaussians *set, const ewa_cloud *points) {
    const ewa_attribute *number = ewa_cloud_find(points, NUMBER);
    uint8_t *marks = calloc(set->count ? set->count : 1, 1);
    if (!marks) return EWA_ERROR_MEMORY;
    for (uint64_t i = 0; i < ewa_cloud_point_count(points); i++) {
        uint32_t from;
        memcpy(&from, (const uint8_t *)number->data + i * number->stride_bytes, sizeof from);
        marks[from] = 1;
    }
    ewa_gaussians part;
    const ewa_status status = ewa_gaussians_keep(set, marks, &part);
    free(marks);
    if (status != EWA_OK) return status;
    ewa_gaussians_free(set);
    *set = part;
    return EWA_OK;
}

/// The size that 99 of 100 Gaussians have at most; negative where there is no memory to find out.
static double usual_size(const ewa_cloud *points) {
    const size_t count = (size_t)ewa_cloud_point_count(points);
    const float *sizes = ewa_cloud_find(points, SIZE)->data;
    double *numbers = malloc(count * sizeof *numbers);
    if (!numbers) return -1;
    for (size_t i = 0; i < count; i++) numbers[i] = (double)sizes[i];
    const double usual = ewa_rank_select(numbers, count, count - 1 - count / 100);
    free(numbers);
    return usual;
}

/// Leaves out what floats or is never seen; false after reporting.
static bool prune(cli_session *session, double factor, ewa_cloud **points) {
    const double usual = usual_size(*points);
    if (usual < 0) {
        session_fail(session, "out of memory: %llu sizes", (unsigned long long)ewa_cloud_point_count(*points));
        return false;
    }
    ewa_filter filter = {.term_count = 0};
    ewa_estimate_options outliers;
    ewa_estimate_options_init(&outliers, sizeof outliers);
    outliers.outlier_factor = factor;
    char text[128];
    snprintf(text, sizeof text, OPACITY ">=%.17g and " SIZE "<=%.17g", 1 / 255.0, fmin(factor * usual, DBL_MAX));
    return session_passed(session, ewa_filter_add(&filter, text, NULL)) &&
           choose_points(session, &(point_choice){.filter = &filter, .outliers = &outliers}, points);
}

/// Leaves what is chosen of a set; false after reporting.
static bool choose_gaussians(cli_session *session, double factor, convert_chooser *choose, const void *data, ewa_gaussians *set) {
    ewa_cloud *points = NULL;
    bool done = session_passed(session, make_points(set, &points));
    if (done && factor > 0) done = prune(session, factor, &points);
    if (done && choose) done = choose(session, data, &points);
    done = done && session_passed(session, keep(set, points));
    ewa_cloud_destroy(&points);
    return done;
}

/// Writes a file as it is; false after reporting.
static bool convert_whole(cli_session *session, const char *from, const char *to, const ewa_gaussians_save_options *options) {
    uint64_t count;
    session->subject = from;
    if (!session_passed(session, ewa_gaussians_convert(session->context, from, to, options, &count))) return false;
    session_say(session, "%s: %llu Gaussians written (%s)", to, (unsigned long long)count, ewa_gaussian_format_name(ewa_gaussians_format_of(to)));
    return true;
}

bool convert_gaussians(cli_session *session, const char *from, const char *to,
                       const ewa_gaussians_save_options *options, double prune_factor, convert_chooser *choose, const void *data,
                       const double (*matrices)[16], uint32_t count) {
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    ewa_gaussians_save_options chosen = *options;
    const bool changed = choose || prune_factor > 0 || count || ewa_scene_file_probe(from);
    if (!changed && ewa_gaussians_format_of(to) == EWA_GAUSSIANS_STREAMED_SOG) return convert_whole(session, from, to, options);
    if (ewa_scene_file_probe(from)) {
        if (!scene_input_gaussians(session, from, &set, chosen.up_world)) return false;
    } else {
        if (!gaussian_files_load(session, from, &set, &facts)) return false;
        memcpy(chosen.up_world, facts.up_world, sizeof chosen.up_world);
    }
    session->subject = from;
    if ((choose || prune_factor > 0) && !choose_gaussians(session, prune_factor, choose, data, &set)) {
        ewa_gaussians_free(&set);
        return false;
    }
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        status = ewa_gaussians_transform(&set, matrices[i]);
    session->subject = to;
    if (status == EWA_OK) status = ewa_gaussians_save(&set, to, &chosen);
    if (status != EWA_OK)
        session_failed(session, status);
    else
        session_say(session, "%s: %u Gaussians written (%s)", to, set.count,
                    ewa_gaussian_format_name(ewa_gaussians_format_of(to)));
    ewa_gaussians_free(&set);
    return status == EWA_OK;
}
