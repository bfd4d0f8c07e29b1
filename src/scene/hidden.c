// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What regions leave of Gaussians and volumes: parts of what is resident, for pictures, and of the files, for what is written.
// A Gaussian and a voxel are where their centres are; voxels are of no class.
#include "base/base.h"
#include "ewa/gaussian_io.h"
#include "ewa/io.h"
#include "scene/asset.h"
#include "volume/classify.h"
#include "volume/shown.h"

#include <math.h>
#include <string.h>

void ewa_left_part_release(ewa_left_part **given) {
    ewa_left_part *part = given ? *given : NULL;
    if (!part) return;
    *given = NULL;
    if (atomic_fetch_sub(&part->references, 1) > 1) return;
    ewa_splats_destroy(&part->splats);
    ewa_voxels_destroy(&part->voxels);
    ewa_release(part->context, part, 1, sizeof *part);
}

static bool is_left(const void *user, const double place_world[3], int32_t code) {
    const ewa_scene_options *options = user;
    return ewa_regions_keep_place(options->regions, options->region_count, place_world, code);
}

/// Whether a place is also not cut away.
static bool is_shown(const void *user, const double place_world[3], int32_t code) {
    const ewa_scene_options *options = user;
    return ewa_sections_keep(&options->render, place_world) && is_left(user, place_world, code);
}

bool ewa_left_part_is_of(const ewa_left_part *part, const ewa_scene_options *options) {
    const uint32_t count = part ? part->region_count : 0;
    return count == options->region_count &&
           (!count || memcmp(part->regions, options->regions, count * sizeof part->regions[0]) == 0);
}

ewa_status ewa_left_part_make(ewa_context *context, const ewa_scene_options *options, const ewa_splats *splats, const ewa_voxels *voxels,
                              ewa_left_part **made) {
    ewa_left_part *part = ewa_allocate_zeroed(context, 1, sizeof *part);
    *made = part;
    if (!part) return EWA_ERROR_MEMORY;
    part->context = context;
    atomic_init(&part->references, 1);
    part->region_count = options->region_count;
    memcpy(part->regions, options->regions, part->region_count * sizeof part->regions[0]);
    const ewa_status status = splats ? ewa_splats_show(context, splats, is_left, options, &part->splats)
                                     : ewa_voxels_show(context, voxels, is_left, options, &part->voxels);
    if (status != EWA_OK) ewa_left_part_release(made);
    return status;
}

ewa_status ewa_scene_hide_parts(ewa_scene *scene) {
    const ewa_scene_options *options = &scene->options;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < scene->count && status == EWA_OK; i++) {
        ewa_scene_item *item = &scene->items[i];
        const ewa_asset *asset = item->asset;
        if (ewa_left_part_is_of(item->left, options)) continue;
        ewa_left_part_release(&item->left);
        if ((asset->splats || asset->voxels) && options->region_count)
            status = ewa_left_part_make(scene->context, options, asset->splats, asset->voxels, &item->left);
    }
    return status;
}

/// What takes the centres in.
typedef struct center_list {
    const ewa_scene_options *options;
    uint64_t count, step, kept; ///< step 0: they are counted only
    double *places_world;
} center_list;

static void take_center(void *user, const double place_world[3], int32_t code) {
    center_list *list = user;
    if (!is_shown(list->options, place_world, code)) return;
    if (list->step && list->count % list->step == 0) memcpy(list->places_world + 3 * list->kept++, place_world, 3 * sizeof(double));
    list->count++;
}

static void visit_all(const ewa_scene *scene, center_list *list) {
    list->count = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        if (!scene->items[i].instance.visible) continue;
        if (asset->splats) ewa_splats_visit(asset->splats, take_center, list);
        if (asset->voxels) ewa_voxels_visit(asset->voxels, take_center, list);
    }
}

ewa_status ewa_scene_centers(const ewa_scene *scene, uint64_t limit, ewa_cloud **cloud, uint64_t *count) {
    if (!cloud || !count) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    *count = 0;
    if (!scene || !limit) return EWA_ERROR_ARGUMENT;
    center_list list = {.options = &scene->options};
    visit_all(scene, &list);
    const uint64_t all = list.count;
    list.step = all / limit + (all % limit > 0);
    ewa_status status = ewa_cloud_create(scene->context, list.step ? (all - 1) / list.step + 1 : 0, cloud);
    void *places = NULL;
    if (status == EWA_OK) status = ewa_cloud_add(*cloud, EWA_POSITION, EWA_F64, 3, &places);
    list.places_world = places;
    if (status == EWA_OK && list.step) visit_all(scene, &list);
    if (status != EWA_OK) ewa_cloud_destroy(cloud);
    *count = all;
    return status;
}

/// Finds the one visible asset of a kind whose file can be read again.
static ewa_status find_alone(const ewa_scene *scene, ewa_asset_kind kind, const ewa_asset **found) {
    uint32_t count = 0;
    const char *name = ewa_asset_kind_name(kind);
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        if (!scene->items[i].instance.visible || asset->kind != kind) continue;
        *found = asset;
        count++;
    }
    if (count != 1)
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT, "%u items of the scene are of the kind '%s' and visible, not one", count, name);
    if (!(*found)->of_file)
        return ewa_fail(scene->context, EWA_ERROR_UNSUPPORTED, "%s: it is in memory, and no file that could be read again",
                        (*found)->name);
    return EWA_OK;
}

ewa_status ewa_scene_gaussians(const ewa_scene *scene, ewa_gaussians *gaussians, double up_world[3]) {
    if (!gaussians) return EWA_ERROR_ARGUMENT;
    *gaussians = (ewa_gaussians){.context = NULL};
    if (!scene) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->context;
    const ewa_asset *asset;
    EWA_TRY(find_alone(scene, EWA_ASSET_GAUSSIANS, &asset));
    ewa_gaussians set = {.context = NULL};
    ewa_gaussian_facts facts;
    EWA_TRY(ewa_gaussians_load(context, asset->name, &set, &facts));
    uint8_t *marks = ewa_allocate(context, set.count, 1);
    ewa_status status = marks ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK && ewa_asset_is_moved(asset)) status = ewa_gaussians_transform(&set, asset->to_world);
    for (uint32_t i = 0; i < set.count && status == EWA_OK; i++) {
        double place[3];
        for (int c = 0; c < 3; c++) place[c] = set.origin[c] + (double)set.centers[3 * (size_t)i + (size_t)c];
        marks[i] = is_shown(&scene->options, place, set.classes ? set.classes[i] : -1);
    }
    if (status == EWA_OK) status = ewa_gaussians_keep(&set, marks, gaussians);
    if (status == EWA_OK && up_world) memcpy(up_world, facts.up_world, sizeof facts.up_world);
    ewa_release(context, marks, set.count, 1);
    ewa_gaussians_free(&set);
    return status;
}

/// The part of a grid that is left.
typedef struct grid_box {
    uint32_t low[3], high[3]; ///< both within
    uint64_t count;
} grid_box;

static bool is_voxel_shown(const ewa_scene *scene, const ewa_volume *volume, const uint32_t at[3]) {
    double place[3];
    vec3_store(ewa_volume_place(volume->index_to_world, at[0], at[1], at[2]), place);
    return is_shown(&scene->options, place, -1);
}

static grid_box find_box(const ewa_scene *scene, const ewa_volume *volume) {
    grid_box box = {{UINT32_MAX, UINT32_MAX, UINT32_MAX}, {0, 0, 0}, 0};
    uint32_t at[3];
    for (at[2] = 0; at[2] < volume->dims[2]; at[2]++)
        for (at[1] = 0; at[1] < volume->dims[1]; at[1]++)
            for (at[0] = 0; at[0] < volume->dims[0]; at[0]++) {
                if (!is_voxel_shown(scene, volume, at)) continue;
                box.count++;
                for (int axis = 0; axis < 3; axis++) {
                    if (at[axis] < box.low[axis]) box.low[axis] = at[axis];
                    if (at[axis] > box.high[axis]) box.high[axis] = at[axis];
                }
            }
    return box;
}

/// Writes a whole number of a type of voxels; what is no matter at all, as a float.
static void write_value(ewa_type type, double value, uint8_t bytes[4]) {
    const int32_t whole = type == EWA_F32 ? 0 : (int32_t)value;
    const float number = (float)value;
    if (type == EWA_F32)
        memcpy(bytes, &number, 4);
    else if (type == EWA_U8)
        bytes[0] = (uint8_t)whole;
    else if (type == EWA_I8)
        memcpy(bytes, &(int8_t){(int8_t)whole}, 1);
    else if (type == EWA_U16)
        memcpy(bytes, &(uint16_t){(uint16_t)whole}, 2);
    else
        memcpy(bytes, &(int16_t){(int16_t)whole}, 2);
}

/// Chooses what stands where a part has no voxels: a NaN, or the smallest number of the volume or beyond that the transfer function
/// leaves empty; the smallest where it leaves none empty.
static ewa_status choose_fill(const ewa_asset *asset, const ewa_volume *volume, double *fill) {
    ewa_context *context = volume->context;
    *fill = NAN;
    if (volume->type == EWA_F32) return EWA_OK;
    const double highest = volume->type == EWA_U8 ? 255 : volume->type == EWA_I8 ? 127 : volume->type == EWA_U16 ? 65535 : 32767;
    ewa_volume_facts facts;
    ewa_classifier classifier;
    ewa_transfer *transfer = ewa_allocate(context, 1, sizeof *transfer);
    ewa_status status = transfer ? ewa_volume_measure(volume, &facts) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_transfer_choose(context, asset->transfer, volume, transfer);
    if (status == EWA_OK) status = ewa_classifier_make(context, volume, transfer, &classifier);
    if (status == EWA_OK) {
        *fill = facts.low;
        while (*fill < highest && ewa_classifier_reaches(&classifier, *fill, *fill)) (*fill)++;
        if (ewa_classifier_reaches(&classifier, *fill, *fill)) *fill = facts.low;
    }
    ewa_release(context, transfer, 1, sizeof *transfer);
    return status;
}

/// Copies the box of a volume, without what is hidden within.
static ewa_status copy_box(const ewa_scene *scene, const ewa_volume *from, const grid_box *box, double fill, ewa_volume *to) {
    const size_t bytes = ewa_type_bytes(from->type);
    uint8_t nothing[4];
    uint32_t dims[3], at[3];
    write_value(from->type, fill, nothing);
    for (int axis = 0; axis < 3; axis++) dims[axis] = box->high[axis] - box->low[axis] + 1;
    EWA_TRY(ewa_volume_create(from->context, dims, from->type, to));
    memcpy(to->index_to_world, from->index_to_world, sizeof to->index_to_world);
    to->anatomical = from->anatomical;
    double first[3];
    vec3_store(ewa_volume_place(from->index_to_world, box->low[0], box->low[1], box->low[2]), first);
    for (int row = 0; row < 3; row++) to->index_to_world[4 * row + 3] = first[row];
    uint8_t *next = to->voxels;
    for (at[2] = box->low[2]; at[2] <= box->high[2]; at[2]++)
        for (at[1] = box->low[1]; at[1] <= box->high[1]; at[1]++)
            for (at[0] = box->low[0]; at[0] <= box->high[0]; at[0]++, next += bytes) {
                const uint64_t index = ((uint64_t)at[2] * from->dims[1] + at[1]) * from->dims[0] + at[0];
                memcpy(next, is_voxel_shown(scene, from, at) ? (const uint8_t *)from->voxels + index * bytes : nothing, bytes);
            }
    return EWA_OK;
}

ewa_status ewa_scene_volume(const ewa_scene *scene, ewa_volume *volume) {
    if (!volume) return EWA_ERROR_ARGUMENT;
    *volume = (ewa_volume){.context = NULL};
    if (!scene) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->context;
    const ewa_asset *asset;
    EWA_TRY(find_alone(scene, EWA_ASSET_VOLUME, &asset));
    ewa_volume all = {.context = NULL};
    ewa_volume_load_options options;
    ewa_volume_load_options_init(&options, sizeof options);
    EWA_TRY(ewa_volume_load(context, asset->name, &options, &all));
    ewa_asset_move_volume(asset->to_world, &all);
    const grid_box box = find_box(scene, &all);
    double fill = NAN;
    ewa_status status = box.count ? EWA_OK : ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: no voxel of it is left", asset->name);
    if (status == EWA_OK) status = choose_fill(asset, &all, &fill);
    if (status == EWA_OK) status = copy_box(scene, &all, &box, fill, volume);
    ewa_volume_free(&all);
    if (status != EWA_OK) ewa_volume_free(volume);
    return status;
}
