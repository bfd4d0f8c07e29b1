// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera, grid and options in the single-precision form that the kernels read; depth units; point filters
// (docs/math.md section 12).
#include "volume/view.h"

#include <math.h>
#include <string.h>

/// Standard deviation up to which points are as good as splats: 60 dB.
static const double WIDEST_POINT_PX = 0.8;

/// Standard deviations by which at least rays that meet a kernel's rim are ahead of the eye, where voxels are
/// drawn as ellipses: 0.14 % of what is at the rim is behind it then, at three standard deviations 1.5e-5 of
/// the voxel.
static const double AHEAD_DEVIATIONS = 3;

static double focal_px(const ewa_grid_view *grid) { return fmax(grid->fx_px, grid->fy_px); }

/// Depths of the grid's corners.
static void depth_range(const ewa_voxel_level *level, const ewa_grid_view *grid, double *low, double *high) {
    *low = INFINITY, *high = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        const double z =
            ewa_grid_place(grid, corner & 1 ? level->dims[0] - 1.0 : 0, corner & 2 ? level->dims[1] - 1.0 : 0,
                           corner & 4 ? level->dims[2] - 1.0 : 0)
                .z;
        *low = fmin(*low, z), *high = fmax(*high, z);
    }
}

double ewa_volume_depth_unit(const ewa_grid_view *grid, const ewa_volume_options *options) {
    double shortest = INFINITY;
    for (int axis = 0; axis < 3; axis++) shortest = fmin(shortest, vec3_length(mat3_row(&grid->axes, axis)));
    return shortest * options->depth_unit;
}

double ewa_volume_first_far_unit(const ewa_grid_view *grid, double unit) {
    if (grid->orthographic) return -INFINITY;
    const double end = grid->depth_sigma * sqrt(grid->cutoff2 + AHEAD_DEVIATIONS * AHEAD_DEVIATIONS);
    return ewa_volume_unit_of(grid, unit, end) + 1;
}

void ewa_volume_slices_make(ewa_volume_slices *slices, const ewa_voxel_level *level,
                            const ewa_grid_view *grid, const ewa_volume_options *options) {
    enum { MAX_SLICES = 1 << 20 };
    double low, high, shortest = INFINITY;
    depth_range(level, grid, &low, &high);
    for (int axis = 0; axis < 3; axis++) shortest = fmin(shortest, vec3_length(mat3_row(&grid->axes, axis)));
    double unit = shortest * options->depth_unit;
    // Slabs of flat voxels would be cut into more slices than there is anything in.
    while ((high - low) / unit > MAX_SLICES) unit *= 2;
    const double lowest = ewa_volume_unit_of(grid, unit, low), highest = ewa_volume_unit_of(grid, unit, high);
    const double far = ewa_volume_first_far_unit(grid, unit), first_unit = fmax(lowest, far);
    *slices = (ewa_volume_slices){.unit = unit, .start = grid->origin.z + (first_unit - 0.5) * unit};
    slices->count = (uint32_t)fmax(highest - first_unit, 0) + 1;
    slices->has_near = lowest < far && high > -grid->near;
    const int32_t all = 0, none = (int32_t)slices->count;
    // From this depth on (orthographic: at 1) voxels are as small as asked for, and their filter as narrow as
    // four taps hold well.
    const double widest2 = WIDEST_POINT_PX * WIDEST_POINT_PX;
    const double nearest_points =
        fmax(grid->longest_step * focal_px(grid) / options->point_threshold_px,
             sqrt(grid->mean_variance * grid->fx_px * grid->fy_px / (widest2 - grid->prefilter2_px2)));
    if (options->method == EWA_VOLUME_POINTS) {
        slices->point_slice = all;
    } else if (options->method == EWA_VOLUME_SPLATS || options->point_threshold_px == 0) {
        slices->point_slice = none;
    } else if (grid->prefilter2_px2 >= widest2) {
        slices->point_slice = none;
    } else if (grid->orthographic) {
        slices->point_slice = nearest_points <= 1 ? all : none;
    } else {
        const double z = nearest_points;
        const double first = ceil((z - slices->start) / unit - 0.5); // whose middle is beyond z
        slices->point_slice = first <= 0 ? all : first >= none ? none : (int32_t)first;
    }
}

static void store_symmetric(const ewa_mat3 *from, float to[6]) {
    to[0] = (float)from->m[0][0], to[1] = (float)from->m[0][1], to[2] = (float)from->m[0][2];
    to[3] = (float)from->m[1][1], to[4] = (float)from->m[1][2], to[5] = (float)from->m[2][2];
}

static void set_shading(ewa_volume_view *view, const ewa_grid_view *grid, const ewa_camera *camera,
                        const ewa_shading_setup *shading) {
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            view->to_world[3 * row + column] =
                (float)(camera->world_to_camera[4 * column + row] / grid->scale);
    for (int c = 0; c < 3; c++) view->toward_viewer[c] = -view->to_world[3 * c + 2];
    const ewa_material *material = &shading->materials[0];
    view->lit = shading->lit, view->highlights = shading->highlights && material->specular > 0;
    view->ambient = material->ambient, view->diffuse = material->diffuse;
    view->specular = material->specular, view->shininess = material->shininess;
    view->light_count = shading->light_count;
    for (uint32_t i = 0; i < shading->light_count; i++) {
        const ewa_shading_light *from = &shading->lights[i];
        ewa_kernel_light *to = &view->lights[i];
        to->headlight = from->headlight;
        to->toward[0] = (float)from->toward_world.x, to->toward[1] = (float)from->toward_world.y;
        to->toward[2] = (float)from->toward_world.z;
        for (int c = 0; c < 3; c++) to->color[c] = (float)from->color[c];
    }
}

void ewa_volume_view_set(ewa_volume_view *view, const ewa_grid_view *grid, const ewa_volume_slices *slices,
                         const ewa_voxels *voxels, const ewa_camera *camera,
                         const ewa_volume_options *options, const ewa_shading_setup *shading,
                         const ewa_footprint_table *table) {
    memset(view, 0, sizeof *view);
    view->orthographic = grid->orthographic;
    view->exact = options->index == EWA_INDEX_EXACT;
    view->with_sections = options->section_count > 0;
    view->with_surface = options->surface_depth || view->with_sections;
    view->fx_px = (float)grid->fx_px, view->fy_px = (float)grid->fy_px;
    view->cx_px = (float)grid->cx_px, view->cy_px = (float)grid->cy_px;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) view->axes[i][j] = (float)grid->axes.m[i][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            view->to_deviations[i][j] = (float)(grid->to_steps.m[i][j] / grid->kernel_steps);
    view->deviations_per_step = (float)(1 / grid->kernel_steps);
    view->near = (float)grid->near, view->has_near = slices->has_near;
    view->unit_camera = grid->unit_camera;
    view->unit_inverse = (float)(1 / slices->unit),
    view->unit_offset = (float)(-slices->start / slices->unit);
    view->point_slice = slices->point_slice;
    view->color_scale = (float)(voxels->color_scale / 65535);
    view->point_mass = (float)grid->point_mass, view->splat_peak = (float)grid->splat_peak;
    view->density = (float)options->density_scale;
    store_symmetric(&grid->covariance, view->covariance);
    store_symmetric(&grid->inverse, view->inverse);
    view->bend = (float)grid->bend;
    view->cutoff = (float)grid->cutoff, view->cutoff2 = (float)grid->cutoff2;
    view->prefilter2_px2 = (float)grid->prefilter2_px2;
    // The trace bounds the largest variance whatever the angles between the axes.
    view->reach = (float)(grid->cutoff * sqrt(3 * grid->mean_variance));
    view->mark_splats = options->mark_splats;
    for (int c = 0; c < 3; c++) view->marked_color[c] = (float)(c == 0 ? EWA_MARKED_SPLAT_RED : EWA_MARKED_SPLAT_OTHER);
    view->minimum_transmittance = (float)options->minimum_transmittance;
    view->depth_deviation = (float)grid->depth_sigma;
    set_shading(view, grid, camera, shading);
    view->table = table;
}

void ewa_volume_target_set(ewa_volume_target *target, const ewa_camera *camera, const ewa_frame *frame,
                           const ewa_surface_planes *surface, const float background[4]) {
    *target = (ewa_volume_target){.width_px = camera->width_px,
                                  .height_px = camera->height_px,
                                  .surface = *surface,
                                  .rgba8 = frame->rgba8,
                                  .rgba = frame->rgba,
                                  .depth = frame->depth,
                                  .normal = frame->normal,
                                  .coverage = frame->coverage};
    for (int c = 0; c < 4; c++) target->background[c] = c < 3 ? background[c] * background[3] : background[3];
}

void ewa_point_filters_make(ewa_point_filter filters[EWA_FILTER_COUNT]) {
    for (uint32_t f = 0; f < EWA_FILTER_COUNT; f++) {
        const double sigma = fmax((double)EWA_FILTER_MAX_PX * f / (EWA_FILTER_COUNT - 1), 1e-3);
        for (uint32_t phase = 0; phase < EWA_FILTER_PHASES; phase++) {
            // Against the nearest tap, so that they do not all vanish.
            double taps[4], sum = 0, nearest = INFINITY;
            for (int i = 0; i < 4; i++) {
                taps[i] = i - 1 - (phase + 0.5) / EWA_FILTER_PHASES;
                nearest = fmin(nearest, taps[i] * taps[i]);
            }
            for (int i = 0; i < 4; i++) {
                taps[i] = exp((nearest - taps[i] * taps[i]) / (2 * sigma * sigma));
                if (taps[i] < 1e-9) taps[i] = 0; // far from where floats get slow
                sum += taps[i];
            }
            float *to = filters[f][phase];
            memset(to, 0, sizeof filters[f][phase]);
            for (int i = 0; i < 4; i++) to[4 + i] = (float)(taps[i] / sum);
        }
    }
}

uint32_t ewa_point_filter_choose(const ewa_grid_view *grid, double z) {
    const double scale = grid->orthographic ? 1 : 1 / z;
    const double variance =
        grid->prefilter2_px2 + grid->mean_variance * grid->fx_px * grid->fy_px * scale * scale;
    const double sigma = fmin(sqrt(variance), (double)EWA_FILTER_MAX_PX);
    return (uint32_t)(sigma / (double)EWA_FILTER_MAX_PX * (EWA_FILTER_COUNT - 1) + 0.5);
}
