// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures in tests.
#include "tests/splat/picture.h"
#include "cloud/cloud.h"
#include "reference/contour.h"
#include "reference/splat.h"
#include "reference/surface.h"
#include "surface/options.h"

#include <string.h>

static void *allocate(size_t count, size_t size_bytes) {
    void *memory = calloc(count, size_bytes);
    assert_non_null(memory);
    return memory;
}

void picture_set_light(ewa_render_options *options, double x, double y, double z) {
    options->light_count = 1;
    ewa_light_init(&options->lights[0]);
    vec3_store(vec3_make(x, y, z), options->lights[0].direction_world);
}

picture picture_make(uint32_t width_px, uint32_t height_px) {
    const size_t count = (size_t)width_px * height_px;
    return (picture){width_px,
                     height_px,
                     {.rgba8 = allocate(count, 4),
                      .rgba = allocate(count, 4 * sizeof(float)),
                      .depth = allocate(count, sizeof(float)),
                      .normal = allocate(count, 3 * sizeof(float)),
                      .coverage = allocate(count, sizeof(float))}};
}

void picture_free(picture *made) {
    free(made->frame.rgba8);
    free(made->frame.rgba);
    free(made->frame.depth);
    free(made->frame.normal);
    free(made->frame.coverage);
    *made = (picture){0};
}

picture picture_of_scene(const scene *of, const ewa_surfels_options *surfels_options,
                         const ewa_render_options *options) {
    picture made = picture_make(of->camera.width_px, of->camera.height_px);
    assert_int_equal(ewa_render_reference(of->cloud, surfels_options, of->unit_coverage, &of->camera, options,
                                          &made.frame),
                     EWA_OK);
    return made;
}

/// Calls `visit` for each surfel and each pixel of the picture where it has a value near or within the
/// cutoff.
typedef void edge_visit(void *data, size_t pixel, const ewa_reference_splat *splat,
                        const ewa_reference_sample *sample);

typedef struct edges {
    ewa_reference_view view;
    ewa_surfel_reader reader;
    uint64_t surfel_count;
    bool one_pass;
    double support_band, depth_band;
    double *bound;  // B(x), or the smallest depth
    uint32_t *near; // one pass: surfels within the band of the smallest depth
    uint8_t *mask;
} edges;

static void walk(edges *work, edge_visit *visit) {
    for (uint64_t k = 0; k < work->surfel_count; k++) {
        ewa_surfel surfel;
        ewa_reference_splat splat;
        bool drawable;
        ewa_surfel_read(&work->reader, k, 1, &surfel, &drawable);
        if (!drawable) continue;
        ewa_reference_project(&work->view, &surfel, &splat);
        if (!splat.drawn) continue;
        // Two pixels more, for what lies within the band outside of the box.
        for (int32_t y = splat.y_begin - 2; y < splat.y_end + 2; y++)
            for (int32_t x = splat.x_begin - 2; x < splat.x_end + 2; x++) {
                ewa_reference_sample sample;
                if (x < 0 || y < 0 || x >= work->view.width_px || y >= work->view.height_px) continue;
                if (ewa_reference_sample_at(&work->view, &splat, x + 0.5, y + 0.5, &sample))
                    visit(work, (size_t)y * (size_t)work->view.width_px + (size_t)x, &splat, &sample);
            }
    }
}

static void find_bound(void *data, size_t at, const ewa_reference_splat *splat,
                       const ewa_reference_sample *sample) {
    edges *work = data;
    if (sample->distance2 >= work->view.cutoff * work->view.cutoff) return;
    work->bound[at] = fmin(work->bound[at], sample->z + (work->one_pass ? 0 : splat->epsilon));
}

static void mark(void *data, size_t at, const ewa_reference_splat *splat,
                 const ewa_reference_sample *sample) {
    (void)splat;
    edges *work = data;
    const double end2 = work->view.cutoff * work->view.cutoff, band = work->depth_band * fabs(sample->z);
    if (sample->z > work->bound[at] + band) return;
    if (fabs(sample->distance2 - end2) < work->support_band * end2) work->mask[at] |= PICTURE_ON_CUTOFF;
    if (sample->distance2 >= end2) return;
    if (work->one_pass ? work->near[at]++ > 0 : sample->z > work->bound[at] - band)
        work->mask[at] |= PICTURE_ON_BOUND;
}

void picture_mark_edges(const scene *of, const ewa_surfels_options *surfels_options,
                        const ewa_render_options *options, double support_band, double depth_band,
                        uint8_t *mask) {
    const size_t pixel_count = (size_t)of->camera.width_px * of->camera.height_px;
    ewa_context *context = ewa_cloud_context(of->cloud);
    ewa_surfels_options surfels;
    ewa_render_options chosen;
    edges work = {.surfel_count = ewa_cloud_point_count(of->cloud),
                  .support_band = support_band,
                  .depth_band = depth_band,
                  .bound = allocate(pixel_count, sizeof(double)),
                  .near = allocate(pixel_count, sizeof(uint32_t)),
                  .mask = mask};
    assert_int_equal(ewa_surfels_options_choose(context, surfels_options, &surfels), EWA_OK);
    assert_int_equal(ewa_render_options_choose(context, options, &chosen), EWA_OK);
    assert_int_equal(ewa_surfel_reader_open(of->cloud, &surfels, &work.reader), EWA_OK);
    ewa_reference_view_make(&of->camera, surfels.cutoff, &chosen, &work.view);
    ewa_reference_view_contours(&chosen, false, &work.view);
    work.one_pass = chosen.passes == 1;
    for (size_t i = 0; i < pixel_count; i++) work.bound[i] = INFINITY;
    memset(mask, 0, pixel_count);
    walk(&work, find_bound);
    walk(&work, mark);
    free(work.bound);
    free(work.near);
}

/// |a - b|, 0 for two equal infinities, infinite for one NaN.
static double distance(float a, float b) {
    if (a == b) return 0;
    const double d = fabs((double)a - (double)b);
    return isnan(d) ? INFINITY : d;
}

picture_report picture_compare(const picture *reference, const picture *other, double threshold,
                               const uint8_t *mask) {
    picture_report report = {.pixel_count = (uint64_t)reference->width_px * reference->height_px};
    const ewa_frame *a = &reference->frame, *b = &other->frame;
    double worst = 0, deepest = 0;
    for (size_t i = 0; i < report.pixel_count; i++)
        if (isfinite(a->depth[i])) deepest = fmax(deepest, fabs((double)a->depth[i]));
    for (size_t i = 0; i < report.pixel_count; i++) {
        double color = 0, normal = 0;
        for (size_t c = 4 * i; c < 4 * i + 4; c++) color = fmax(color, distance(a->rgba[c], b->rgba[c]));
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            normal = fmax(normal, distance(a->normal[c], b->normal[c]));
        const double coverage = distance(a->coverage[i], b->coverage[i]) / fmax((double)a->coverage[i], 1);
        double depth = distance(a->depth[i], b->depth[i]);
        if (isfinite(a->depth[i])) depth /= fmax(fabs((double)a->depth[i]), 0.01 * deepest);
        if ((double)a->coverage[i] < threshold && (double)b->coverage[i] < threshold) depth = normal = 0;
        const double largest = fmax(color, fmax(depth, coverage));
        const bool edge = mask && mask[i];
        report.edge_count += edge;
        if (largest > threshold) {
            report.over_count++;
            report.edge_over_count += edge;
        }
        if (edge) continue;
        report.color = fmax(report.color, color);
        report.depth = fmax(report.depth, depth);
        report.coverage = fmax(report.coverage, coverage);
        report.normal = fmax(report.normal, normal);
        if (largest > worst) {
            worst = largest;
            report.worst_px[0] = (uint32_t)(i % reference->width_px);
            report.worst_px[1] = (uint32_t)(i / reference->width_px);
        }
    }
    return report;
}

void picture_print(const char *name, const picture_report *report) {
    print_message(
        "%s: %llu of %llu pixels over, %llu of them on %llu edges; elsewhere color %.2g depth %.2g coverage "
        "%.2g normal %.2g, worst at %u, %u\n",
        name, (unsigned long long)report->over_count, (unsigned long long)report->pixel_count,
        (unsigned long long)report->edge_over_count, (unsigned long long)report->edge_count, report->color,
        report->depth, report->coverage, report->normal, report->worst_px[0], report->worst_px[1]);
}

scene picture_measured_scene(ewa_context *context, scene_kind kind, uint64_t points,
                             const ewa_surfels_options *options) {
    scene made;
    assert_int_equal(scene_make(context, kind, points, PICTURE_SIDE_PX, PICTURE_SIDE_PX, &made), EWA_OK);
    ewa_surfels *surfels = check_surfels(made.cloud, options);
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    made.unit_coverage = info.unit_coverage;
    ewa_surfels_destroy(&surfels);
    return made;
}

picture picture_draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera,
                     const ewa_surfels_options *surfels_options, const ewa_render_options *options) {
    picture made = picture_make(camera->width_px, camera->height_px);
    ewa_surfels *surfels = check_surfels(cloud, surfels_options);
    ewa_renderer *renderer = check_renderer(context);
    for (int frame = 0; frame < 2; frame++) // the second frame runs in warm memory
        assert_int_equal(ewa_render(renderer, surfels, camera, options, &made.frame, NULL), EWA_OK);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    return made;
}

scene picture_small_scene(ewa_context *context, scene_kind kind) {
    scene made;
    const uint64_t count = kind == SCENE_ELLIPSES || kind == SCENE_NEAR ? 500 : 3000;
    assert_int_equal(scene_make(context, kind, count, PICTURE_SMALL_PX, PICTURE_SMALL_PX, &made), EWA_OK);
    return made;
}

void picture_expect_same(const picture *a, const picture *b) {
    const size_t count = (size_t)a->width_px * a->height_px;
    assert_memory_equal(a->frame.rgba8, b->frame.rgba8, 4 * count);
    assert_memory_equal(a->frame.rgba, b->frame.rgba, 16 * count);
    assert_memory_equal(a->frame.depth, b->frame.depth, 4 * count);
    assert_memory_equal(a->frame.normal, b->frame.normal, 12 * count);
    assert_memory_equal(a->frame.coverage, b->frame.coverage, 4 * count);
}

void picture_set_orthographic(scene *of) {
    ewa_bounds bounds;
    const double direction[3] = {0.3, 0.8, -0.5}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_cloud_measure(of->cloud, &bounds), EWA_OK);
    assert_int_equal(ewa_camera_set_ortho(&of->camera, 1), EWA_OK);
    assert_int_equal(ewa_camera_frame(&of->camera, &bounds, direction, up, 0.05), EWA_OK);
}

void picture_hold(scene *of, const ewa_render_options *options, bool orthographic, const char *what) {
    if (orthographic) picture_set_orthographic(of);
    OWNED(picture_free) picture reference = picture_of_scene(of, NULL, options);
    OWNED(picture_free)
    picture fast = picture_draw(ewa_cloud_context(of->cloud), of->cloud, &of->camera, NULL, options);
    const picture_report report = picture_compare(&reference, &fast, 2e-3, NULL);
    picture_print(what, &report);
    assert_true(report.over_count * 200 < report.pixel_count);
}

void picture_add_clips(ewa_cloud *cloud) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    float *clip[2] = {NULL, NULL};
    check_random random = {11};
    assert_int_equal(ewa_cloud_add(cloud, EWA_CLIP0, EWA_F32, 3, (void **)&clip[0]), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_CLIP1, EWA_F32, 3, (void **)&clip[1]), EWA_OK);
    uint8_t *mode = check_add(cloud, EWA_CLIP_MODE, EWA_U8, 1);
    for (uint64_t i = 0; i < count; i++) {
        for (int k = 0; k < 2; k++)
            for (int c = 0; c < 3; c++)
                clip[k][3 * i + (uint64_t)c] = i % 3 > (uint64_t)k ? (float)check_uniform(&random, -1, 1) : 0;
        mode[i] = i % 2 == 0;
    }
}
