// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transparency as the paper has it, in double precision, to be read beside it: one pass over the points, a
// few fragments per pixel, merged as soon as there are too many. Based on: M. Zwicker, H. Pfister, J. van
// Baar, M. Gross, "Surface Splatting", 2001, sections 4, 6 and 7, table 1, equation 12.
//
// What the paper leaves open is decided here so:
// - A fragment's depth is the weighted mean of its contributions'; that of a merged one is the front one's.
// - The threshold is the tolerance of the contribution's splat (docs/math.md section 6). Where several
// fragments
//   lie within it, the contribution goes to the nearest in depth.
// - "Smaller than the limit" is read as: at most l fragments stay.
// - A contribution to a fragment that has been shaded is shaded by itself and averaged in; the negative
//   weight goes on counting.
// - Equation 12 takes straight colours and gives a premultiplied one. Merged again as printed, that would be
//   multiplied by its alpha twice; shaded fragments are premultiplied here.
#include "splat/abuffer.h"

#include "base/base.h"
#include "cloud/cloud.h"
#include "reference/contour.h"
#include "reference/splat.h"
#include "surface/options.h"

/// SS table 1. Sums are weighted; colours by alpha too.
typedef struct fragment {
    ewa_vec3 color; ///< a sum; once shaded, premultiplied
    double alpha;   ///< a sum; once shaded, what it is
    ewa_vec3 normal_world;
    double weight; ///< the sum of weights; once shaded, negative
    double z;      ///< mean
} fragment;

typedef struct abuffer {
    ewa_reference_view view;
    ewa_render_options options;
    double unit_coverage;
    abuffer_shader *shader;
    const void *shader_data;
    uint32_t limit;
    fragment *fragments; ///< [pixel][limit + 1]: the last place is for the temporary one
    uint32_t *counts;    ///< [pixel]
} abuffer;

/// Colour premultiplied, with alpha: the mean of a fragment or of one contribution, shaded (SS 6).
static ewa_vec3 shade(const abuffer *buffer, const fragment *at, double x_px, double y_px, double *alpha) {
    *alpha = buffer->options.opacity * at->alpha / at->weight;
    if (!(at->alpha > 0)) return vec3_make(0, 0, 0);
    ewa_vec3 color = vec3_scale(at->color, 1 / at->alpha);
    if (buffer->shader) {
        const double length = vec3_length(at->normal_world);
        const ewa_vec3 normal = vec3_scale(at->normal_world, length > 0 ? 1 / length : 0);
        color = buffer->shader(buffer->shader_data, color, normal, x_px, y_px);
    }
    return vec3_scale(color, *alpha);
}

/// Shades a fragment once and lets its coverage take from it (SS 7: alpha' = alpha q / tau).
static void shade_fragment(const abuffer *buffer, fragment *at, double x_px, double y_px) {
    if (at->weight < 0) return;
    double alpha;
    const ewa_vec3 color = shade(buffer, at, x_px, y_px, &alpha);
    const double coverage = at->weight / (buffer->unit_coverage * buffer->options.edge_threshold);
    const double share = buffer->options.edge_antialiasing ? fmin(1, coverage) : 1;
    at->color = vec3_scale(color, share);
    at->alpha = alpha * share;
    at->weight = -at->weight;
}

/// Equation 12, of shaded fragments.
static fragment merge(const fragment *front, const fragment *back) {
    const double through = 1 - front->alpha;
    return (fragment){.color = vec3_add(front->color, vec3_scale(back->color, through)),
                      .alpha = front->alpha + through * back->alpha,
                      .weight = front->weight + back->weight,
                      .z = front->z};
}

/// Accumulate-or-separate decision: the fragment whose surface a contribution belongs to, or NULL.
static fragment *find_surface(fragment *fragments, uint32_t count, double z, double tolerance) {
    fragment *nearest = NULL;
    for (uint32_t i = 0; i < count; i++)
        if (fabs(fragments[i].z - z) <= tolerance &&
            (!nearest || fabs(fragments[i].z - z) < fabs(nearest->z - z)))
            nearest = &fragments[i];
    return nearest;
}

static void accumulate(const abuffer *buffer, fragment *to, const fragment *contribution, double x_px,
                       double y_px) {
    if (to->weight < 0) {
        double alpha;
        const ewa_vec3 color = shade(buffer, contribution, x_px, y_px, &alpha);
        const double share = contribution->weight / (contribution->weight - to->weight);
        to->color = vec3_add(vec3_scale(to->color, 1 - share), vec3_scale(color, share));
        to->alpha += share * (alpha - to->alpha);
        to->weight -= contribution->weight;
        return;
    }
    to->color = vec3_add(to->color, contribution->color);
    to->alpha += contribution->alpha;
    to->normal_world = vec3_add(to->normal_world, contribution->normal_world);
    to->weight += contribution->weight;
    to->z += contribution->weight / to->weight * (contribution->z - to->z);
}

static void sort_by_depth(fragment *fragments, uint32_t count) {
    for (uint32_t end = 1; end < count; end++) {
        const fragment last = fragments[end];
        uint32_t at = end;
        for (; at > 0 && fragments[at - 1].z > last.z; at--) fragments[at] = fragments[at - 1];
        fragments[at] = last;
    }
}

/// Fragment merging: the two nearest in depth become one, shaded before. `count` >= 2.
static void merge_nearest(const abuffer *buffer, fragment *fragments, uint32_t count, double x_px,
                          double y_px) {
    sort_by_depth(fragments, count);
    uint32_t front = 0;
    for (uint32_t i = 1; i + 1 < count; i++)
        if (fragments[i + 1].z - fragments[i].z < fragments[front + 1].z - fragments[front].z) front = i;
    shade_fragment(buffer, &fragments[front], x_px, y_px);
    shade_fragment(buffer, &fragments[front + 1], x_px, y_px);
    fragments[front] = merge(&fragments[front], &fragments[front + 1]);
    for (uint32_t i = front + 1; i + 1 < count; i++) fragments[i] = fragments[i + 1];
}

/// SS 6, the three steps of a contribution.
static void splat(const abuffer *buffer, size_t pixel, const fragment *contribution, double tolerance) {
    fragment *fragments = buffer->fragments + pixel * (buffer->limit + 1);
    uint32_t *count = &buffer->counts[pixel];
    const size_t width = (size_t)buffer->view.width_px;
    const double x_px = (double)(pixel % width) + 0.5, y_px = (double)(pixel / width) + 0.5;
    fragment *same = find_surface(fragments, *count, contribution->z, tolerance);
    if (same) {
        accumulate(buffer, same, contribution, x_px, y_px);
        return;
    }
    fragments[(*count)++] = *contribution;
    if (*count <= buffer->limit) return;
    merge_nearest(buffer, fragments, *count, x_px, y_px);
    (*count)--;
}

static void splat_surfel(const abuffer *buffer, const ewa_surfel *surfel) {
    const ewa_reference_view *view = &buffer->view;
    ewa_reference_splat projected;
    ewa_reference_project(view, surfel, &projected);
    if (!projected.drawn) return;
    for (int32_t y = projected.y_begin; y < projected.y_end; y++)
        for (int32_t x = projected.x_begin; x < projected.x_end; x++) {
            ewa_reference_sample sample;
            if (!ewa_reference_sample_at(view, &projected, x + 0.5, y + 0.5, &sample) ||
                sample.distance2 >= view->cutoff * view->cutoff)
                continue;
            const double weight = sample.weight, weighted_alpha = weight * projected.opacity;
            const fragment contribution = {.color = vec3_scale(projected.color, weighted_alpha),
                                           .alpha = weighted_alpha,
                                           .normal_world = vec3_scale(projected.normal_world, weight),
                                           .weight = weight,
                                           .z = sample.z};
            splat(buffer, (size_t)y * (size_t)view->width_px + (size_t)x, &contribution, projected.epsilon);
        }
}

/// After all points: what is left is shaded and blended back to front.
static void blend(const abuffer *buffer, size_t pixel, float rgba[4]) {
    fragment *fragments = buffer->fragments + pixel * (buffer->limit + 1);
    const size_t width = (size_t)buffer->view.width_px;
    const double x_px = (double)(pixel % width) + 0.5, y_px = (double)(pixel / width) + 0.5;
    sort_by_depth(fragments, buffer->counts[pixel]);
    fragment all = {.alpha = 0};
    for (uint32_t i = buffer->counts[pixel]; i-- > 0;) {
        shade_fragment(buffer, &fragments[i], x_px, y_px);
        all = merge(&fragments[i], &all);
    }
    rgba[0] = (float)all.color.x, rgba[1] = (float)all.color.y, rgba[2] = (float)all.color.z;
    rgba[3] = (float)all.alpha;
}

static void draw(const abuffer *buffer, const ewa_surfel_reader *reader, uint64_t surfel_count, float *rgba) {
    const size_t pixel_count = (size_t)buffer->view.width_px * (size_t)buffer->view.height_px;
    for (uint64_t k = 0; k < surfel_count; k++) {
        ewa_surfel surfel;
        bool drawable;
        ewa_surfel_read(reader, k, 1, &surfel, &drawable);
        if (drawable) splat_surfel(buffer, &surfel);
    }
    for (size_t i = 0; i < pixel_count; i++) blend(buffer, i, rgba + 4 * i);
}

ewa_status abuffer_render(const ewa_cloud *cloud, double unit_coverage, const ewa_camera *camera,
                          const ewa_render_options *options, uint32_t fragment_limit, abuffer_shader *shader,
                          const void *shader_data, float *rgba) {
    if (!cloud || !camera || !options || !rgba || fragment_limit == 0) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    abuffer buffer = {.unit_coverage = unit_coverage,
                      .limit = fragment_limit,
                      .shader = shader,
                      .shader_data = shader_data};
    ewa_surfels_options surfels;
    ewa_surfel_reader reader;
    ewa_status status = ewa_surfels_options_choose(context, NULL, &surfels);
    if (status == EWA_OK) status = ewa_render_options_choose(context, options, &buffer.options);
    if (status == EWA_OK) status = ewa_camera_check(context, camera);
    if (status == EWA_OK) status = ewa_surfel_reader_open(cloud, &surfels, &reader);
    if (status != EWA_OK) return status;
    ewa_reference_view_make(camera, surfels.cutoff, &buffer.options, &buffer.view);
    ewa_reference_view_contours(&buffer.options, true, &buffer.view);
    const size_t pixel_count = (size_t)camera->width_px * camera->height_px;
    const size_t bytes = (fragment_limit + 1) * sizeof *buffer.fragments;
    buffer.fragments = ewa_allocate(context, pixel_count, bytes);
    buffer.counts = ewa_allocate_zeroed(context, pixel_count, sizeof *buffer.counts);
    if (buffer.fragments && buffer.counts)
        draw(&buffer, &reader, ewa_cloud_point_count(cloud), rgba);
    else
        status = EWA_ERROR_MEMORY;
    ewa_release(context, buffer.counts, pixel_count, sizeof *buffer.counts);
    ewa_release(context, buffer.fragments, pixel_count, bytes);
    return status;
}
