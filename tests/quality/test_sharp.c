// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clip lines keep edges: the cube and the part, close up, with and without clip lines against the ray-traced
// solid; outlines where they are and as soft as they should be; no holes along edges from random cameras.
//
// EWA_QUALITY_CAMERAS sets the number of cameras (default 20; the documented run takes 500).
#include "check.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "quality/solid_scene.h"

enum { SIDE = 256, EDGE_REACH_PX = 5, RAYS = 8 };

static uint32_t camera_count(void) {
    const char *text = getenv("EWA_QUALITY_CAMERAS");
    const long wanted = text ? strtol(text, NULL, 10) : 0;
    return wanted > 0 && wanted <= 1000000 ? (uint32_t)wanted : 20;
}

static ewa_camera camera_at(const double eye[3], const double target[3], double fov_deg) {
    static const double up[3] = {0.1, 0.05, 1};
    ewa_camera camera = check_camera(SIDE, SIDE);
    assert_int_equal(ewa_camera_set_fov(&camera, fov_deg), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    return camera;
}

static ewa_cloud *make_solid(ewa_context *context, ewa_object object, uint64_t points, bool sharp) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.point_count = points;
    options.jitter = 0;
    options.sharp = sharp;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    solid_color_cloud(cloud);
    return cloud;
}

static void draw_with(ewa_renderer *renderer, const ewa_cloud *cloud, const ewa_camera *camera,
                      ewa_kernel kernel, ewa_cull cull, const ewa_frame *frame) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    options.kernel = kernel;
    options.cull = cull;
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    assert_int_equal(ewa_render(renderer, surfels, camera, &options, frame, NULL), EWA_OK);
    ewa_surfels_destroy(&surfels);
}

static void draw(ewa_renderer *renderer, const ewa_cloud *cloud, const ewa_camera *camera,
                 const ewa_frame *frame) {
    draw_with(renderer, cloud, camera, EWA_KERNEL_PERSPECTIVE, EWA_CULL_BACK, frame);
}

/// PSNR over the marked pixels, of premultiplied linear colours and alpha.
static double psnr(const float *picture, const float *truth, const uint8_t *mask) {
    double sum = 0;
    uint64_t count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (!mask[i]) continue;
        for (int c = 0; c < 4; c++) {
            const double difference = (double)picture[4 * i + c] - (double)truth[4 * i + c];
            sum += difference * difference;
        }
        count += 4;
    }
    assert_true(count > 0);
    return 10 * log10((double)count / sum);
}

TEST_ON(test_edges_close_up, 0) {
    static const struct {
        const char *name;
        ewa_object object;
        uint64_t points;
        double eye[3], target[3], fov_deg;
    } views[] = {
        {"cube, edge", EWA_OBJECT_CUBE, 6000, {2.2, -2.6, 1.9}, {0.9, -1, 0.5}, 22},
        {"cube, corner", EWA_OBJECT_CUBE, 6000, {2.2, -2.6, 1.9}, {1, -1, 1}, 10},
        {"part", EWA_OBJECT_CSG, 7000, {1.2, -2.5, 2.4}, {0, 0, 0}, 40},
        {"part, slot", EWA_OBJECT_CSG, 7000, {1.1, -1.6, 1.4}, {0.3, -0.6, 0.2}, 22},
        {"part, notch", EWA_OBJECT_CSG, 7000, {1.9, 1.8, 1.5}, {0.8, 0.4, 0.2}, 18},
        {"part, round hole", EWA_OBJECT_CSG, 7000, {-0.9, -1.2, 1.6}, {-0.45, 0.1, 0.3}, 22},
    };
    static float truth[4 * SIDE * SIDE], rgba[4 * SIDE * SIDE];
    static uint8_t mask[SIDE * SIDE];
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++) {
        const ewa_solid_shape *shape = ewa_solid_shape_of(views[i].object);
        const ewa_camera camera = camera_at(views[i].eye, views[i].target, views[i].fov_deg);
        solid_picture(shape, &camera, RAYS, truth);
        solid_mark_edges(shape, &camera, EDGE_REACH_PX, mask);
        const ewa_frame frame = {.rgba = rgba};
        OWNED(ewa_cloud_destroy) ewa_cloud *sharp = make_solid(context, views[i].object, views[i].points, true);
        draw(renderer, sharp, &camera, &frame);
        const double with_lines = psnr(rgba, truth, mask);
        ewa_cloud_remove(sharp, EWA_CLIP0);
        ewa_cloud_remove(sharp, EWA_CLIP1);
        draw(renderer, sharp, &camera, &frame);
        const double without = psnr(rgba, truth, mask);
        double plain = without;
        if (views[i].object == EWA_OBJECT_CUBE) {
            // Rows half a spacing inside: as much as can be had without lines.
            OWNED(ewa_cloud_destroy) ewa_cloud *inside = make_solid(context, views[i].object, views[i].points, false);
            draw(renderer, inside, &camera, &frame);
            plain = psnr(rgba, truth, mask);
        }
        print_message("%s: %.1f dB with clip lines, %.1f dB without, %.1f dB with no points on edges\n",
                      views[i].name, with_lines, without, plain);
        assert_true(with_lines >= without + 10);
        assert_true(with_lines >= plain + 10);
    }
}

/// The pixels of outlines: those where a single face ends before the background, two pixels around it and no
/// other face within two more.
static uint64_t mark_outlines(const ewa_solid_shape *shape, const ewa_camera *camera, uint8_t *mask) {
    enum { NEAR = 2, ALONE = 4 };
    static int surface[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        const solid_hit hit = solid_trace_px(shape, camera, i % SIDE + 0.5, i / SIDE + 0.5);
        surface[i] = hit.any ? hit.surface : -1;
    }
    uint64_t count = 0;
    memset(mask, 0, SIDE * SIDE);
    for (int y = ALONE; y < SIDE - ALONE; y++)
        for (int x = ALONE; x < SIDE - ALONE; x++) {
            int face = -1;
            bool alone = true, inside = false, outside = false;
            for (int dy = -ALONE; dy <= ALONE; dy++)
                for (int dx = -ALONE; dx <= ALONE; dx++) {
                    const int there = surface[(y + dy) * SIDE + x + dx];
                    alone &= there < 0 || face < 0 || there == face;
                    face = there < 0 ? face : there;
                    if (abs(dx) > NEAR || abs(dy) > NEAR) continue;
                    inside |= there >= 0;
                    outside |= there < 0;
                }
            mask[y * SIDE + x] = alone && inside && outside;
            count += mask[y * SIDE + x];
        }
    return count;
}

static bool is_partly(float alpha) { return alpha > 1.0f / 512 && alpha < 1 - 1.0f / 512; }

/// What outlines of solids that nobody culls are like.
static void hold_outlines(ewa_context *context, ewa_renderer *renderer, ewa_object object, uint64_t points,
                          ewa_kernel kernel, ewa_cull cull, const char *name) {
    enum { FINE = 16 };
    static const double eyes[][3] = {{2.2, -2.6, 1.9}, {3, -0.4, 1.2}, {0.1, -4, 0.2}, {-9, 13, 6}};
    static const double middle[3] = {0, 0, 0};
    static float rgba[4 * SIDE * SIDE];
    static uint8_t mask[SIDE * SIDE];
    const ewa_solid_shape *shape = ewa_solid_shape_of(object);
    ewa_cloud *cloud = make_solid(context, object, points, true);
    double excess = 0, error2 = 0;
    uint64_t pixels = 0, partly = 0, truly = 0;
    for (size_t view = 0; view < sizeof eyes / sizeof eyes[0]; view++) {
        const ewa_camera camera = camera_at(eyes[view], middle, view == 3 ? 16 : 45);
        const ewa_frame frame = {.rgba = rgba};
        draw_with(renderer, cloud, &camera, kernel, cull, &frame);
        pixels += mark_outlines(shape, &camera, mask);
        for (int i = 0; i < SIDE * SIDE; i++) {
            if (!mask[i]) continue;
            int hits = 0;
            for (int k = 0; k < FINE * FINE; k++)
                hits += solid_trace_px(shape, &camera, i % SIDE + (k % FINE + 0.5) / FINE,
                                       i / SIDE + (k / FINE + 0.5) / FINE)
                            .any;
            const float alpha = rgba[4 * i + 3], covered = (float)hits / (FINE * FINE);
            excess += (double)alpha - (double)covered;
            error2 += ((double)alpha - (double)covered) * ((double)alpha - (double)covered);
            partly += is_partly(alpha);
            truly += is_partly(covered);
        }
    }
    // A straight outline crosses 4 / pi pixels for each of its length.
    const double shift_px = excess / (double)truly * 4 / 3.141592653589793;
    print_message("%s: outlines %+.3f px off, %llu pixels partly covered of %llu, alpha off by %.3f (RMS)\n",
                  name, shift_px, (unsigned long long)partly, (unsigned long long)truly,
                  sqrt(error2 / (double)pixels));
    assert_true(truly > 500 && fabs(shift_px) < 0.05);
    assert_true(10 * partly > 9 * truly && 10 * partly < 11 * truly);
    ewa_cloud_destroy(&cloud);
}

TEST_ON(test_outlines, 0) {
    // Not circles: those of discs that are seen edge-on reach far beyond what their clip lines leave.
    static const struct {
        ewa_kernel kernel;
        const char *name;
    } kernels[] = {{EWA_KERNEL_PERSPECTIVE, "cube, perspective"},
                   {EWA_KERNEL_AFFINE, "cube, affine"},
                   {EWA_KERNEL_SOURCE, "cube, source"},
                   {EWA_KERNEL_RAYCAST, "cube, raycast"}};
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    for (size_t i = 0; i < sizeof kernels / sizeof kernels[0]; i++)
        hold_outlines(context, renderer, EWA_OBJECT_CUBE, 6000, kernels[i].kernel, EWA_CULL_NONE,
                      kernels[i].name);
    hold_outlines(context, renderer, EWA_OBJECT_CUBE, 6000, EWA_KERNEL_PERSPECTIVE, EWA_CULL_BACK,
                  "cube, back faces culled");
    hold_outlines(context, renderer, EWA_OBJECT_CSG, 7000, EWA_KERNEL_PERSPECTIVE, EWA_CULL_NONE, "part");
}

/// Whether a pixel and its surroundings of half a pixel are all within the solid's picture.
static bool is_inside(const ewa_solid_shape *shape, const ewa_camera *camera, int x, int y) {
    for (int k = 0; k < 25; k++)
        if (!solid_trace_px(shape, camera, x - 0.5 + 0.5 * (k % 5), y - 0.5 + 0.5 * (k / 5)).any)
            return false;
    return true;
}

static void count_holes(ewa_object object, uint64_t points) {
    static float rgba[4 * SIDE * SIDE], coverage[SIDE * SIDE];
    static uint8_t mask[SIDE * SIDE];
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_solid(context, object, points, true);
    const ewa_solid_shape *shape = ewa_solid_shape_of(object);
    check_random random = {2004};
    uint64_t inside = 0, holes = 0, thin = 0;
    double minimum = 1;
    const uint32_t cameras = camera_count();
    for (uint32_t i = 0; i < cameras; i++) {
        double eye[3], length = 0, target[3];
        for (int c = 0; c < 3; c++) {
            eye[c] = check_uniform(&random, -1, 1);
            length += eye[c] * eye[c];
            target[c] = check_uniform(&random, -0.8, 0.8);
        }
        // Beyond the cube's corners, at sqrt(3).
        const double distance = exp(check_uniform(&random, log(1.9), log(6))) / sqrt(length);
        for (int c = 0; c < 3; c++) eye[c] *= distance;
        const ewa_camera camera = camera_at(eye, target, check_uniform(&random, 10, 60));
        const ewa_frame frame = {.rgba = rgba, .coverage = coverage};
        draw(renderer, cloud, &camera, &frame);
        solid_mark_edges(shape, &camera, EDGE_REACH_PX, mask);
        for (int y = 1; y + 1 < SIDE; y++)
            for (int x = 1; x + 1 < SIDE; x++) {
                const int at = y * SIDE + x;
                if (!mask[at] || !is_inside(shape, &camera, x, y)) continue;
                inside++;
                holes += !(coverage[at] > 0) || rgba[4 * at + 3] < 0.5f;
                thin += rgba[4 * at + 3] < 0.99f;
                minimum = fmin(minimum, (double)rgba[4 * at + 3]);
            }
    }
    print_message(
        "%u cameras: of %llu pixels along edges %llu are holes, %llu not opaque (smallest alpha %.3f)\n",
        cameras, (unsigned long long)inside, (unsigned long long)holes, (unsigned long long)thin, minimum);
    assert_true(inside > 1000);
    assert_int_equal(holes, 0);
}

TEST(test_no_holes_along_edges) {
    count_holes(EWA_OBJECT_CUBE, 6000);
    count_holes(EWA_OBJECT_CSG, 7000);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
