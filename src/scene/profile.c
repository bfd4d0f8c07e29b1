// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The points beside a line: of all that is visible, with what their files say and the colours that the scene gives them.
#include "scene/profile.h"
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "cloud/color.h"
#include "scene/points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Of points without a colour: to be seen on white.
enum { GREY_SRGB = 96 };

/// Parts of a step of the files' grid to which stations and offsets are told.
static const double PARTS_OF_STEP = 1000;

/// The colours of points until they are in their order.
static const char SHOWN[] = "ewa_profile_srgb";

#define AT(member) offsetof(ewa_profile_options, member)

static const ewa_option option_rows[] = {
    {"width_world", EWA_OPTION_F64, AT(width_world), 0, 1e30, EWA_OPTION_ABOVE, .initial = 1, .unit = "world",
     .help = "of the strip beside the line, half of it on each side"},
    {"up_world", EWA_OPTION_F64, AT(up_world), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3,
     .help = "what is up; zeros: as the scene has it"},
};

const ewa_option_table ewa_profile_options_table = EWA_OPTION_TABLE(ewa_profile_options, option_rows);

void ewa_profile_options_init(ewa_profile_options *options, size_t struct_size) {
    ewa_options_init(&ewa_profile_options_table, options, struct_size);
}

void ewa_profile_free(ewa_profile *profile) {
    if (!profile || !profile->context) return;
    const uint64_t count = profile->points ? ewa_cloud_point_count(profile->points) : 0;
    ewa_release(profile->context, profile->srgb, count, 3);
    ewa_cloud_destroy(&profile->points);
    *profile = (ewa_profile){.context = NULL};
}

/// A profile that is being made.
typedef struct profile_job {
    ewa_scene *scene;
    ewa_strip strip;
    const ewa_surface *legends;
    uint32_t count;
    ewa_cloud **pieces; ///< what each instance has in the strip; [capacity]
} profile_job;

static bool is_in_strip(const void *user, const double place_world[3]) {
    double station, offset;
    return ewa_strip_locate(user, place_world, &station, &offset);
}

/// Rounds to the parts of a step that mean anything; 0: to none.
static double round_to(double value, double per_world) {
    return per_world > 0 ? nearbyint(value * per_world) / per_world : value;
}

/// How many parts of a unit stations are told to; 0: there is no grid.
static double parts_of(const ewa_coordinate_grid *grid) {
    double finest = INFINITY;
    for (int c = 0; c < 3; c++)
        if (grid->step_world[c] > 0) finest = fmin(finest, grid->step_world[c]);
    const double parts = nearbyint(PARTS_OF_STEP / finest);
    return parts >= 1 && parts < 1e12 ? parts : 0;
}

/// The height of a place: of an up axis of the world, the file's own number.
static double height_of(const double up_world[3], const ewa_coordinate_grid *grid, const double place_world[3]) {
    double height = 0;
    for (uint32_t c = 0; c < 3; c++) {
        if (fabs(up_world[c]) == 1) return up_world[c] * ewa_grid_world(grid, c, place_world[c]);
        height += up_world[c] * place_world[c];
    }
    return height;
}

/// Gives the points of a piece their stations, offsets and heights.
static ewa_status measure(const ewa_strip *strip, ewa_cloud *piece) {
    static const char *const names[] = {EWA_PROFILE_STATION, EWA_PROFILE_OFFSET, EWA_PROFILE_HEIGHT};
    void *data[3];
    for (int k = 0; k < 3; k++) {
        if (ewa_cloud_find(piece, names[k]))
            ewa_report(ewa_cloud_context(piece), EWA_SEVERITY_WARNING,
                       "profile: an attribute of the file, %s, gives way to that of the profile", names[k]);
        EWA_TRY(ewa_cloud_add(piece, names[k], EWA_F64, 1, &data[k]));
    }
    double *stations = data[0], *offsets = data[1], *heights = data[2], origin[3];
    const ewa_attribute *position = ewa_cloud_find(piece, EWA_POSITION);
    ewa_coordinate_grid grid;
    ewa_cloud_grid(piece, &grid);
    ewa_cloud_origin(piece, origin);
    const double parts = parts_of(&grid);
    for (uint64_t i = 0; i < ewa_cloud_point_count(piece); i++) {
        double p[3];
        ewa_attribute_read_f64(position, i, 1, p);
        for (int c = 0; c < 3; c++) p[c] += origin[c];
        (void)ewa_strip_locate(strip, p, &stations[i], &offsets[i]);
        stations[i] = round_to(stations[i], parts);
        offsets[i] = round_to(offsets[i], parts) + 0.0; // no negative zero
        heights[i] = height_of(strip->up_world, &grid, p);
    }
    return EWA_OK;
}

/// sRGB of the points' own colours.
static void take_own_colors(const ewa_cloud *piece, uint8_t *srgb) {
    const ewa_attribute *color = ewa_cloud_find(piece, EWA_COLOR);
    const uint64_t count = ewa_cloud_point_count(piece);
    if (!color || color->component_count < 3) {
        memset(srgb, GREY_SRGB, 3 * count);
        return;
    }
    ewa_color_table table;
    ewa_color_table_make(&table);
    for (uint64_t i = 0; i < count; i++) {
        double value[4], linear[3];
        ewa_attribute_read_f64(color, i, 1, value);
        (void)ewa_color_decode(&table, color, value, linear);
        for (int c = 0; c < 3; c++) srgb[3 * i + (uint64_t)c] = ewa_srgb8_from_linear((float)linear[c]);
    }
}

/// Gives the points of a piece the colours that their instance has in the scene.
static ewa_status color(const profile_job *job, const ewa_scene_item *item, ewa_cloud *piece) {
    const ewa_coloring *coloring = &item->instance.coloring;
    const ewa_legend *legend = ewa_surface_legend(job->legends, item->asset);
    const uint64_t count = ewa_cloud_point_count(piece);
    ewa_cloud *shown = NULL;
    void *data = NULL;
    EWA_TRY(ewa_cloud_add(piece, SHOWN, EWA_U8, 3, &data));
    EWA_TRY(ewa_cloud_view(ewa_cloud_context(piece), piece, 0, count, &shown));
    ewa_status status = EWA_OK;
    if (legend) {
        ewa_scalar scalar;
        const ewa_color_scale scale = ewa_color_scale_of(legend);
        uint64_t grey_count = 0; // those of the whole have been told
        status = ewa_cloud_find_scalar(shown, legend->attribute, &scalar);
        if (status == EWA_OK) status = ewa_cloud_color_by(shown, &scalar, &scale, &grey_count);
    } else if (coloring->tinted && ewa_coloring_is_own(coloring->attribute)) {
        status = ewa_cloud_tint(shown, coloring->tint);
    }
    if (status == EWA_OK) take_own_colors(shown, data);
    ewa_cloud_destroy(&shown);
    return status;
}

/// Cuts the piece of one instance; NULL: it has no points.
static ewa_status take_item(const profile_job *job, const ewa_scene_item *item, ewa_cloud **piece) {
    const ewa_strip *strip = &job->strip;
    EWA_TRY(ewa_scene_cut_item(job->scene, item, strip->low_world, strip->high_world, is_in_strip, strip, piece));
    ewa_status status = *piece ? measure(strip, *piece) : EWA_OK;
    if (status == EWA_OK && *piece) status = color(job, item, *piece);
    if (status != EWA_OK) ewa_cloud_destroy(piece);
    return status;
}

/// Where a point comes in the order of a profile.
typedef struct profile_rank {
    double key[3]; ///< station, height, offset
    uint64_t point;
} profile_rank;

static int compare_ranks(const void *a, const void *b) {
    const profile_rank *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
    return p->point < q->point ? -1 : 1;
}

/// Puts the points in their order.
static ewa_status sort(ewa_context *context, ewa_cloud **cloud) {
    static const char *const names[] = {EWA_PROFILE_STATION, EWA_PROFILE_HEIGHT, EWA_PROFILE_OFFSET};
    const uint64_t count = ewa_cloud_point_count(*cloud);
    profile_rank *ranks = ewa_allocate(context, count, sizeof *ranks);
    uint64_t *order = ewa_allocate(context, count, sizeof *order);
    ewa_cloud *sorted = NULL;
    ewa_status status = ranks && order ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        for (int k = 0; k < 3; k++) {
            const double *numbers = ewa_cloud_find(*cloud, names[k])->data;
            for (uint64_t i = 0; i < count; i++) ranks[i].key[k] = numbers[i];
        }
        for (uint64_t i = 0; i < count; i++) ranks[i].point = i;
        qsort(ranks, count, sizeof *ranks, compare_ranks);
        for (uint64_t i = 0; i < count; i++) order[i] = ranks[i].point;
        status = ewa_cloud_select(*cloud, order, count, &sorted);
    }
    ewa_release(context, ranks, count, sizeof *ranks);
    ewa_release(context, order, count, sizeof *order);
    if (status == EWA_OK) {
        ewa_cloud_destroy(cloud);
        *cloud = sorted;
    }
    return status;
}

/// Makes one cloud of the pieces.
static ewa_status join(const profile_job *job, ewa_profile *profile) {
    ewa_context *context = job->scene->context;
    if (!job->count) return ewa_cloud_create(context, 0, &profile->points);
    ewa_cloud *merged = NULL;
    ewa_status status = ewa_cloud_merge((const ewa_cloud *const *)job->pieces, job->count, &merged);
    if (status == EWA_OK) status = sort(context, &merged);
    const uint64_t count = status == EWA_OK ? ewa_cloud_point_count(merged) : 0;
    uint8_t *srgb = count ? ewa_allocate(context, count, 3) : NULL;
    if (status == EWA_OK && !srgb) status = EWA_ERROR_MEMORY;
    if (status != EWA_OK) {
        ewa_cloud_destroy(&merged);
        return status;
    }
    memcpy(srgb, ewa_cloud_find(merged, SHOWN)->data, 3 * count);
    ewa_cloud_remove(merged, SHOWN);
    profile->points = merged;
    profile->srgb = srgb;
    return EWA_OK;
}

/// Cuts all that is visible.
static ewa_status take_all(profile_job *job) {
    uint32_t without_count = 0;
    for (uint32_t i = 0; i < job->scene->count; i++) {
        const ewa_scene_item *item = &job->scene->items[i];
        if (!item->instance.visible) continue;
        const bool points = ewa_asset_is_points(item->asset) || item->asset->lod;
        without_count += !points;
        if (!points) continue;
        EWA_TRY(take_item(job, item, &job->pieces[job->count]));
        job->count += job->pieces[job->count] != NULL;
    }
    if (without_count)
        ewa_report(job->scene->context, EWA_SEVERITY_NOTE,
                   "profile: %u of what is shown has no points (Gaussians, volumes, resident surfels) and no part in it",
                   without_count);
    return EWA_OK;
}

/// Takes what is up from the options, or finds it.
static ewa_status choose_up(ewa_scene *scene, const ewa_profile_options *options, double up_world[3]) {
    const double *up = options->up_world, length = sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
    if (length == 0) return ewa_scene_find_up(scene, up_world);
    if (!isfinite(length)) return ewa_fail(scene->context, EWA_ERROR_NUMERIC, "profile: what is up is too long a vector");
    for (int c = 0; c < 3; c++) up_world[c] = up[c] / length;
    return EWA_OK;
}

ewa_status ewa_scene_profile(ewa_scene *scene, const double *corners_world, uint32_t corner_count,
                             const ewa_profile_options *given, ewa_profile *profile) {
    if (!profile) return EWA_ERROR_ARGUMENT;
    *profile = (ewa_profile){.context = NULL};
    if (!scene || !corners_world) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->context;
    ewa_profile_options options;
    double up_world[3];
    ewa_profile_options_init(&options, sizeof options);
    EWA_TRY(ewa_options_take(context, &ewa_profile_options_table, given, &options));
    if (corner_count < 2 || corner_count > EWA_PROFILE_CORNERS)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "profile: a line has 2 to %d corners, not %u", EWA_PROFILE_CORNERS,
                        corner_count);
    if (scene->points_gone)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "the points of this scene are gone (keep_points)");
    EWA_TRY(choose_up(scene, &options, up_world));
    profile_job job = {.scene = scene};
    ewa_surface *legends = NULL;
    EWA_TRY(ewa_strip_make(context, corners_world, corner_count, up_world, options.width_world, &job.strip));
    job.pieces = ewa_allocate_zeroed(context, scene->count, sizeof(ewa_cloud *));
    ewa_status status = job.pieces ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK && !(scene->committed && scene->surface)) status = ewa_surface_make_legends(scene, &legends);
    job.legends = legends ? legends : scene->surface;
    if (status == EWA_OK) status = take_all(&job);
    ewa_scene_info info;
    ewa_scene_describe(scene, &info);
    *profile = (ewa_profile){.context = context, .length_world = job.strip.length_world, .unit = info.unit};
    memcpy(profile->up_world, up_world, sizeof up_world);
    if (status == EWA_OK) status = join(&job, profile);
    for (uint32_t i = 0; job.pieces && i < job.count; i++) ewa_cloud_destroy(&job.pieces[i]);
    ewa_release(context, job.pieces, scene->count, sizeof(ewa_cloud *));
    ewa_surface_release(&legends);
    ewa_strip_free(&job.strip);
    if (status != EWA_OK) ewa_profile_free(profile);
    return status;
}
