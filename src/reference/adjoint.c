// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The derivative of a picture, pixel by pixel over all splats. Forward: what a surfel's numbers make of the picture
// while the sets stay. Backward: its transpose (docs/math.md section 15).
#include "reference/adjoint.h"
#include "base/base.h"
#include "reference/adjoint_frame.h"

#include <string.h>

struct ewa_reference_sets {
    ewa_context *context;
    ewa_surfels_options surfels_options;
    ewa_render_options options;
    double unit_coverage;
    ewa_reference_layering layering;
    uint64_t point_count;
    uint32_t width_px, height_px;
    ewa_reference_fragment *fragments; ///< of all pixels; their splats are those of the call at hand
    uint64_t *first;                   ///< [pixel + 1]
    uint64_t fragment_count, capacity;
    uint32_t largest; ///< fragments of a pixel
    uint64_t pixel_count;
};

/// What a call needs beside the sets.
typedef struct work {
    ewa_reference_frame frame;
    ewa_surfel *surfels;
    ewa_reference_splat *splats;
    ewa_reference_fragment *fragments; ///< of one pixel
    ewa_reference_layer *layers;
    uint64_t capacity;
} work;

static void free_work(work *w) {
    ewa_context *context = w->frame.context;
    ewa_release(context, w->layers, w->capacity, sizeof *w->layers);
    ewa_release(context, w->fragments, w->capacity, sizeof *w->fragments);
    ewa_release(context, w->splats, w->frame.point_count, sizeof *w->splats);
    ewa_release(context, w->surfels, w->frame.point_count, sizeof *w->surfels);
}

/// Projects all points; free_work() whatever comes of it.
static ewa_status project_all(work *w, uint64_t fragments) {
    ewa_context *context = w->frame.context;
    w->capacity = fragments;
    w->surfels = ewa_allocate(context, w->frame.point_count, sizeof *w->surfels);
    w->splats = ewa_allocate(context, w->frame.point_count, sizeof *w->splats);
    w->fragments = ewa_allocate(context, fragments, sizeof *w->fragments);
    w->layers = ewa_allocate(context, fragments, sizeof *w->layers);
    if (!w->surfels || !w->splats || !w->fragments || !w->layers) return EWA_ERROR_MEMORY;
    ewa_reference_frame_project(&w->frame, 0, w->frame.point_count, w->surfels, w->splats);
    return EWA_OK;
}

/// The centre of a pixel.
static void center_of(const ewa_reference_view *view, uint64_t pixel, double center_px[2]) {
    center_px[0] = (double)(pixel % (uint64_t)view->width_px) + 0.5;
    center_px[1] = (double)(pixel / (uint64_t)view->width_px) + 0.5;
}

static ewa_status append(ewa_reference_sets *sets, const ewa_reference_fragment *fragments, uint32_t count) {
    ewa_context *context = sets->context;
    if (sets->fragment_count + count > sets->capacity) {
        const uint64_t capacity = 2 * (sets->fragment_count + count);
        ewa_reference_fragment *grown = ewa_allocate(context, capacity, sizeof *grown);
        if (!grown) return EWA_ERROR_MEMORY;
        if (sets->fragment_count) memcpy(grown, sets->fragments, sets->fragment_count * sizeof *grown);
        ewa_release(context, sets->fragments, sets->capacity, sizeof *grown);
        sets->fragments = grown, sets->capacity = capacity;
    }
    if (count) memcpy(sets->fragments + sets->fragment_count, fragments, count * sizeof *fragments);
    sets->fragment_count += count;
    if (count > sets->largest) sets->largest = count;
    return EWA_OK;
}

/// Fills the sets, pixel by pixel.
static ewa_status find_sets(ewa_reference_sets *sets, work *w) {
    ewa_status status = project_all(w, w->frame.point_count + 1);
    for (uint64_t pixel = 0; pixel < sets->pixel_count && status == EWA_OK; pixel++) {
        double at[2];
        center_of(&w->frame.view, pixel, at);
        uint32_t count = 0;
        for (uint64_t k = 0; k < w->frame.point_count; k++)
            if (w->splats[k].drawn)
                count += ewa_reference_fragment_make(&w->frame, &w->splats[k], k, at[0], at[1], &w->fragments[count]);
        ewa_reference_layers_find(&w->frame.resolve, at[0], at[1], w->fragments, count, w->layers);
        sets->first[pixel] = sets->fragment_count;
        status = append(sets, w->fragments, count);
    }
    sets->first[sets->pixel_count] = sets->fragment_count;
    return status;
}

ewa_status ewa_reference_sets_create(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                     double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                     ewa_reference_sets **sets) {
    *sets = NULL;
    work w = {.surfels = NULL};
    EWA_TRY(ewa_reference_frame_make(cloud, surfels_options, unit_coverage, camera, options, &w.frame));
    ewa_context *context = w.frame.context;
    ewa_reference_sets *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->options = w.frame.options;
    ewa_surfels_options_init(&made->surfels_options, sizeof made->surfels_options);
    if (surfels_options) made->surfels_options = *surfels_options;
    made->unit_coverage = unit_coverage;
    made->layering = w.frame.resolve.layering;
    made->point_count = w.frame.point_count;
    made->width_px = camera->width_px, made->height_px = camera->height_px;
    made->pixel_count = (uint64_t)camera->width_px * camera->height_px;
    made->first = ewa_allocate(context, made->pixel_count + 1, sizeof *made->first);
    ewa_status status = made->first ? find_sets(made, &w) : EWA_ERROR_MEMORY;
    free_work(&w);
    if (status == EWA_OK)
        *sets = made;
    else
        ewa_reference_sets_destroy(&made);
    return status;
}

void ewa_reference_sets_destroy(ewa_reference_sets **sets) {
    ewa_reference_sets *old = *sets;
    if (!old) return;
    ewa_context *context = old->context;
    ewa_release(context, old->fragments, old->capacity, sizeof *old->fragments);
    ewa_release(context, old->first, old->pixel_count + 1, sizeof *old->first);
    ewa_release(context, old, 1, sizeof *old);
    *sets = NULL;
}

/// Starts a call for a cloud and a camera that may be others than those of the sets.
static ewa_status start(const ewa_reference_sets *sets, const ewa_cloud *cloud, const ewa_camera *camera, work *w) {
    EWA_TRY(ewa_reference_frame_make(cloud, &sets->surfels_options, sets->unit_coverage, camera, &sets->options,
                                     &w->frame));
    w->frame.resolve.layering = sets->layering;
    if (w->frame.point_count != sets->point_count || camera->width_px != sets->width_px ||
        camera->height_px != sets->height_px)
        return ewa_fail(w->frame.context, EWA_ERROR_ARGUMENT,
                        "reference: %llu points and %u x %u pixels instead of %llu and %u x %u",
                        (unsigned long long)w->frame.point_count, camera->width_px, camera->height_px,
                        (unsigned long long)sets->point_count, sets->width_px, sets->height_px);
    return project_all(w, (uint64_t)sets->largest + 1);
}

/// The surfaces of a pixel as the sets have them, of the splats that there are now. What clip lines leave stays, and
/// the depth of a splat whose disc's range decided it, and near splats altogether.
static uint32_t gather_pixel(const ewa_reference_sets *sets, work *w, uint64_t pixel, uint32_t *layer_count) {
    double at[2];
    center_of(&w->frame.view, pixel, at);
    uint32_t count = 0, layers = 0;
    for (uint64_t i = sets->first[pixel]; i < sets->first[pixel + 1]; i++) {
        const ewa_reference_fragment *from = &sets->fragments[i];
        if (from->layer == EWA_NO_LAYER) continue;
        const ewa_reference_splat *splat = &w->splats[from->index];
        ewa_reference_fragment *fragment = &w->fragments[count++];
        *fragment = *from;
        fragment->splat = splat;
        ewa_reference_sample now = {.share = 1};
        if (splat->drawn && !splat->by_rays && ewa_reference_sample_at(&w->frame.view, splat, at[0], at[1], &now)) {
            fragment->sample.weight = now.weight * (from->sample.share / now.share);
            if (ewa_reference_is_on_plane(&w->frame.view, splat, at[0], at[1])) fragment->sample.z = now.z;
        }
        if (from->layer + 1 > layers) layers = from->layer + 1;
    }
    ewa_reference_layers_gather(&w->frame.resolve, at[0], at[1], w->fragments, count, layers, w->layers);
    *layer_count = layers;
    return count;
}

ewa_status ewa_reference_sets_draw(const ewa_reference_sets *sets, const ewa_cloud *cloud, const ewa_camera *camera,
                                   ewa_reference_values *values) {
    work w = {.surfels = NULL};
    ewa_status status = start(sets, cloud, camera, &w);
    for (uint64_t pixel = 0; pixel < sets->pixel_count && status == EWA_OK; pixel++) {
        uint32_t layer_count;
        gather_pixel(sets, &w, pixel, &layer_count);
        values[pixel] = ewa_reference_layers_show(&w.frame.resolve, w.layers, layer_count);
        values[pixel].depth *= w.frame.view.placement.unit;
    }
    free_work(&w);
    return status;
}

ewa_status ewa_reference_sets_pull_back(const ewa_reference_sets *sets, const ewa_cloud *cloud,
                                        const ewa_camera *camera, const ewa_reference_values *cotangent,
                                        ewa_reference_point_cotangent *points, double numbers[EWA_CAMERA_NUMBERS]) {
    work w = {.surfels = NULL};
    ewa_status status = start(sets, cloud, camera, &w);
    const ewa_reference_frame *frame = &w.frame;
    typedef double sums_of_splat[EWA_MOMENT_COUNT];
    sums_of_splat *moments = NULL;
    if (status == EWA_OK) {
        moments = ewa_allocate_zeroed(frame->context, frame->point_count, sizeof *moments);
        if (!moments) status = EWA_ERROR_MEMORY;
    }
    memset(numbers, 0, EWA_CAMERA_NUMBERS * sizeof *numbers);
    for (uint64_t pixel = 0; pixel < sets->pixel_count && status == EWA_OK; pixel++) {
        double at[2];
        center_of(&frame->view, pixel, at);
        uint32_t layer_count;
        const uint32_t count = gather_pixel(sets, &w, pixel, &layer_count);
        ewa_reference_values of_pixel = cotangent[pixel];
        of_pixel.depth *= frame->view.placement.unit;
        ewa_reference_layers_pull_back(&frame->resolve, at[0], at[1], &of_pixel, w.layers, layer_count, numbers);
        for (uint32_t i = 0; i < count; i++) {
            const ewa_reference_fragment *fragment = &w.fragments[i];
            double terms[EWA_MOMENT_COUNT];
            ewa_reference_moments_at(&frame->view, fragment->splat, &fragment->sample, at[0], at[1],
                                     frame->resolve.layering.transparent, &w.layers[fragment->layer].cotangent, terms);
            for (int m = 0; m < EWA_MOMENT_COUNT; m++) moments[fragment->index][m] += terms[m];
        }
    }
    for (uint64_t k = 0; k < frame->point_count && status == EWA_OK; k++) {
        memset(&points[k], 0, sizeof points[k]);
        if (!w.splats[k].drawn) continue;
        ewa_reference_surfel_cotangent surfel;
        ewa_reference_moments_pull_back(&frame->view, &w.splats[k], &w.surfels[k], moments[k], &surfel, numbers);
        ewa_reference_surfel_pull_back(&frame->reader, k, &w.surfels[k], &surfel, &points[k]);
    }
    ewa_release(frame->context, moments, frame->point_count, sizeof *moments);
    free_work(&w);
    return status;
}
