// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which frames have plain discs, and these between points and kernels (discs.h).
#include "adjoint/tiles.h"
#include "cloud/cloud.h"

#include <string.h>

bool ewa_adjoint_discs_make(const ewa_reference_frame *frame, ewa_disc_view *view) {
    const ewa_surfel_reader *reader = &frame->reader;
    const ewa_reference_view *from = &frame->view;
    if (!reader->radius || reader->border || reader->surfaceness || from->section_count || from->point_sigma_px > 0) return false;
    const ewa_placement *placement = &from->placement;
    *view = (ewa_disc_view){
        .linear = placement->linear, .anchor = placement->anchor, .offset = placement->offset,
        .fx_px = from->fx_px, .fy_px = from->fy_px, .cx_px = from->cx_px, .cy_px = from->cy_px,
        .width_px = from->width_px, .height_px = from->height_px, .cutoff = from->cutoff,
        .cutoff2 = from->orthographic || from->kernel != EWA_KERNEL_PERSPECTIVE ? 0 : from->cutoff * from->cutoff,
        .prefilter_px = from->prefilter_px, .tolerance = from->tolerance, .contour_shift = from->contour_shift,
        .contour_sine2 = from->contour_shift > 0 ? from->contour_sine2 : -1,
        .concave_from = from->transparent ? INFINITY : EWA_CONTOUR_CONCAVE,
        .back_from = from->cull == EWA_CULL_BACK ? 0 : INFINITY,
        .unit = placement->unit, .scale = vec3_length(mat3_row(&placement->linear, 2)),
        .sigma_per_radius = reader->sigma_per_radius, .flat = from->orthographic};
    return true;
}

/// Numbers of one point.
static void read_point(const ewa_attribute *from, uint64_t point, size_t count, double to[4]) {
    const char *bytes = (const char *)from->data + point * from->stride_bytes;
    if (from->type == EWA_F32) {
        float numbers[4];
        memcpy(numbers, bytes, count * sizeof *numbers);
        for (size_t i = 0; i < count; i++) to[i] = (double)numbers[i];
    } else if (from->type == EWA_U8) {
        for (size_t i = 0; i < count; i++) to[i] = (double)((const uint8_t *)bytes)[i];
    } else {
        ewa_attribute_read_f64(from, point, 1, to);
    }
}

void ewa_adjoint_discs_read(const ewa_surfel_reader *reader, const uint32_t *points, uint32_t count, ewa_disc_points *to) {
    for (uint32_t lane = 0; lane < EWA_DISC_LANES; lane++) {
        const uint64_t point = points[lane < count ? lane : count - 1];
        double numbers[4];
        read_point(reader->position, point, 3, numbers);
        for (int c = 0; c < 3; c++) to->position[c][lane] = numbers[c];
        read_point(reader->normal, point, 3, numbers);
        for (int c = 0; c < 3; c++) to->normal[c][lane] = numbers[c];
        read_point(reader->radius, point, 1, numbers);
        to->radius[lane] = numbers[0];
        to->curvature[lane] = reader->curvature ? ewa_surfel_curvature(reader, point) : 0;
    }
}

static ewa_vec3 lane_of(const double from[3][EWA_DISC_LANES], uint32_t lane) {
    return vec3_make(from[0][lane], from[1][lane], from[2][lane]);
}

void ewa_adjoint_read_color(const ewa_surfel_reader *reader, uint64_t point, double color[3], double *opacity) {
    double numbers[4];
    *opacity = 1;
    for (int c = 0; c < 3; c++) color[c] = EWA_DEFAULT_GREY;
    if (!reader->color) return;
    read_point(reader->color, point, reader->color->component_count, numbers);
    ewa_color_decode(&reader->colors, reader->color, numbers, color);
    *opacity = ewa_color_alpha(reader->color, numbers);
}

/// Lane by lane.
static void store_splat(const ewa_disc_splats *from, uint32_t lane, ewa_reference_splat *to) {
    to->drawn = true, to->by_rays = false;
    to->is_back = from->is_back[lane] > 0, to->concave = from->concave[lane] > 0;
    to->x_begin = (int32_t)from->box[0][lane], to->x_end = (int32_t)from->box[1][lane];
    to->y_begin = (int32_t)from->box[2][lane], to->y_end = (int32_t)from->box[3][lane];
    for (int i = 0; i < 2; i++) to->center_px[i] = from->center_px[i][lane], to->moved_px[i] = from->moved_px[i][lane];
    for (int i = 0; i < 3; i++) {
        to->variance_px2[i] = from->variance_px2[i][lane];
        to->inverse[i] = from->inverse[i][lane], to->plane[i] = from->plane[i][lane];
    }
    to->peak = from->peak[lane], to->epsilon = from->epsilon[lane], to->half_range = from->half_range[lane];
    to->key_low = from->key_low[lane], to->key_high = from->key_high[lane];
    to->center = lane_of(from->center, lane), to->normal = lane_of(from->normal, lane);
    to->axis_u = lane_of(from->axis_u, lane), to->axis_v = lane_of(from->axis_v, lane);
    to->normal_world = lane_of(from->normal_world, lane);
    to->clip_count = 0, to->clip_either = false;
}

/// A point that is no plain disc, or near.
static void project_alone(const ewa_adjoint_job *job, uint32_t point, ewa_reference_splat *splat) {
    ewa_surfel surfel;
    ewa_reference_frame_project(&job->frame, point, 1, &surfel, splat);
    if (!splat->drawn) *splat = (ewa_reference_splat){.drawn = false}; // in no pixel
}

void ewa_adjoint_project(const ewa_adjoint_job *job, const uint32_t *points, uint32_t count, ewa_reference_splat *splats) {
    ewa_disc_points discs;
    ewa_disc_splats projected;
    for (uint32_t i = 0; i < count && !job->discs; i++) project_alone(job, points[i], &splats[i]);
    for (uint32_t first = 0; first < count && job->discs; first += EWA_DISC_LANES) {
        const uint32_t here = count - first < EWA_DISC_LANES ? count - first : EWA_DISC_LANES;
        ewa_adjoint_discs_read(&job->frame.reader, points + first, here, &discs);
        job->disc_kernels->project(&job->disc_view, &discs, &projected);
        for (uint32_t lane = 0; lane < here; lane++) {
            ewa_reference_splat *splat = &splats[first + lane];
            if (projected.drawn[lane] < 0) project_alone(job, points[first + lane], splat);
            if (projected.drawn[lane] == 0) *splat = (ewa_reference_splat){.drawn = false};
            if (!(projected.drawn[lane] > 0)) continue;
            store_splat(&projected, lane, splat);
            double color[3];
            ewa_adjoint_read_color(&job->frame.reader, points[first + lane], color, &splat->opacity);
            splat->color = vec3_load(color);
        }
    }
}
