// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Voxels at the eye (docs/math.md section 12).
#include "volume/near.h"
#include "volume/sort.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/// Half angle of a cone from which on it is taken for everywhere; what angles are widened by.
static const double WIDEST = 1.5, SLACK = 1e-5;

/// The direction of a pixel's ray, in standard deviations along i, j, k; length 1.
static ewa_vec3 ray_through(const ewa_grid_view *grid, double x_px, double y_px) {
    ewa_vec3 ray = vec3_make((x_px - grid->cx_px) / grid->fx_px, (y_px - grid->cy_px) / grid->fy_px, 1);
    ray = vec3_mul_mat3(ray, &grid->to_steps); // the kernel is as wide along each
    vec3_normalize(&ray);
    return ray;
}

static double angle_between(ewa_vec3 a, ewa_vec3 b) { return acos(fmin(fmax(vec3_dot(a, b), -1), 1)); }

void ewa_ray_cone_make(ewa_ray_cone *cone, const ewa_grid_view *grid, double left, double top, double right,
                       double bottom) {
    const ewa_vec3 axis = ray_through(grid, 0.5 * (left + right), 0.5 * (top + bottom));
    double angle = 0;
    for (int corner = 0; corner < 4; corner++)
        angle = fmax(angle, angle_between(axis, ray_through(grid, corner & 1 ? right : left,
                                                            corner & 2 ? bottom : top)));
    vec3_store(axis, cone->axis);
    cone->angle = angle < WIDEST ? angle + SLACK : PI;
}

bool ewa_ray_cone_hits(const ewa_ray_cone *cone, const double offset[3], double radius) {
    ewa_vec3 toward = vec3_load(offset);
    const double distance = vec3_length(toward);
    if (!(distance > radius) || !vec3_normalize(&toward)) return true;
    return angle_between(toward, vec3_load(cone->axis)) <= cone->angle + asin(radius / distance) + SLACK;
}

ewa_volume_source ewa_block_source(const ewa_voxel_level *level, const ewa_grid_view *grid,
                                   const ewa_block_view *view) {
    const ewa_voxel_block *block = &level->blocks[view->block];
    const double side = EWA_BLOCK_SIDE;
    const double i = side * block->place[0], j = side * block->place[1], k = side * block->place[2];
    const ewa_vec3 origin = ewa_grid_place(grid, i, j, k), eye = grid->eye_steps;
    return (ewa_volume_source){
        .places = level->places + block->first,
        .colors = {level->colors[0] + block->first, level->colors[1] + block->first,
                   level->colors[2] + block->first},
        .extinctions = level->extinctions + block->first,
        .normals = level->normals + block->first,
        .count = block->count,
        .origin = {(float)origin.x, (float)origin.y, (float)origin.z},
        .from_eye = {(float)(i - eye.x), (float)(j - eye.y), (float)(k - eye.z)},
        .slice_first = view->slice_first,
        .slice_last = view->slice_last,
    };
}

/// Whether rays of the picture may meet voxels of a block.
static bool hits_block(const ewa_ray_cone *picture, const ewa_voxel_level *level, const ewa_grid_view *grid,
                       const ewa_block_view *view) {
    const ewa_voxel_block *block = &level->blocks[view->block];
    const double eye[3] = {grid->eye_steps.x, grid->eye_steps.y, grid->eye_steps.z};
    double middle[3], squares = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double half = 0.5 * (block->high[axis] - block->low[axis]);
        middle[axis] = EWA_BLOCK_SIDE * (double)block->place[axis] + block->low[axis] + half - eye[axis];
        squares += half * half;
    }
    return ewa_ray_cone_hits(picture, middle, sqrt(squares) + grid->cutoff * grid->kernel_steps);
}

/// Sorts what was found by depth unit, in each by distance.
static void sort_voxels(ewa_near_list *list, uint32_t count) {
    const ewa_near_voxel *found = list->found.data;
    ewa_near_voxel *sorted = list->sorted.data;
    uint32_t *numbers = list->order.data, *keys = list->keys.data;
    for (uint32_t i = 0; i < count; i++) numbers[i] = i, keys[i] = ewa_sort_key(found[i].distance);
    const uint32_t *by_distance = ewa_sort_by_keys(numbers, keys, count, count);
    for (uint32_t i = 0; i < count; i++) sorted[i] = found[by_distance[i]];
    for (uint32_t i = 0; i < count; i++) numbers[i] = i, keys[i] = (uint32_t)(sorted[i].slice + (1 << 20));
    const uint32_t *by_slice = ewa_sort_by_keys(numbers, keys, count, count);
    ewa_near_voxel *final = list->found.data;
    for (uint32_t i = 0; i < count; i++) final[i] = sorted[by_slice[i]];
}

ewa_status ewa_near_list_fill(ewa_context *context, ewa_near_list *list, const ewa_volume_kernels *kernels,
                              const ewa_volume_view *view, const ewa_voxel_level *level,
                              const ewa_grid_view *grid, const ewa_volume_bins *bins,
                              const ewa_camera *camera) {
    list->count = 0;
    if (!view->has_near) return EWA_OK;
    ewa_ray_cone picture;
    ewa_ray_cone_make(&picture, grid, 0, 0, camera->width_px, camera->height_px);
    uint64_t room = 0;
    for (uint64_t b = 0; b < level->block_count; b++)
        if (bins->views[b].near && hits_block(&picture, level, grid, &bins->views[b]))
            room += level->blocks[b].count;
    if (room >= UINT32_MAX / 2)
        return ewa_fail(context, EWA_ERROR_MEMORY, "volume: %llu voxels at the eye",
                        (unsigned long long)room);
    EWA_TRY(ewa_buffer_reserve(context, &list->found, room, sizeof(ewa_near_voxel)));
    EWA_TRY(ewa_buffer_reserve(context, &list->sorted, room, sizeof(ewa_near_voxel)));
    EWA_TRY(ewa_buffer_reserve(context, &list->order, 2 * room, sizeof(uint32_t)));
    EWA_TRY(ewa_buffer_reserve(context, &list->keys, 2 * room, sizeof(uint32_t)));
    ewa_near_voxel *voxels = list->found.data;
    const double reach = view->cutoff;
    for (uint64_t b = 0; b < level->block_count; b++) {
        if (!bins->views[b].near || !hits_block(&picture, level, grid, &bins->views[b])) continue;
        const ewa_volume_source source = ewa_block_source(level, grid, &bins->views[b]);
        const uint32_t added = kernels->append_near(view, &source, voxels + list->count);
        // Of a block at the eye few voxels are in the picture.
        for (uint32_t i = list->count, end = list->count + added; i < end; i++) {
            const double offset[3] = {(double)voxels[i].offset[0], (double)voxels[i].offset[1],
                                      (double)voxels[i].offset[2]};
            if (ewa_ray_cone_hits(&picture, offset, reach)) voxels[list->count++] = voxels[i];
        }
    }
    sort_voxels(list, list->count);
    list->voxels = list->found.data;
    return EWA_OK;
}

void ewa_near_list_free(ewa_context *context, ewa_near_list *list) {
    ewa_buffer_free(context, &list->found);
    ewa_buffer_free(context, &list->sorted);
    ewa_buffer_free(context, &list->order);
    ewa_buffer_free(context, &list->keys);
}
