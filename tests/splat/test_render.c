// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The fast pipeline against the reference, and against itself: threads, instruction sets, order of the
// points.
#include "cloud/cloud.h"
#include "image/srgb.h"
#include "surface/semantics.h"
#include "tests/splat/picture.h"

#include <math.h>
#include <string.h>

enum { SIDE_PX = PICTURE_SIDE_PX, POINTS = 3600 };

static const double THRESHOLD = 1e-3;

/// What the packets' 16-bit normals may do to pixels of surfels seen edge-on, whose weight is proportional to
/// the small n.p: so much, in so many pixels. Their share grows as 1 / (sigma h): 21 pixels of the sphere.
static const double GRAZING_ERROR = 4e-3, GRAZING_SHARE = 4e-4;

/// Draws a scene both ways. Fewer than 0.1 % of the pixels may be beyond the threshold; away from cutoffs and
/// visibility ties only by the error of the normals.
static void hold(scene_kind kind, const ewa_surfels_options *surfels_options,
                 const ewa_render_options *options, bool orthographic, const char *what) {
    ewa_context *context = check_context(0, NULL);
    scene of = picture_measured_scene(context, kind, POINTS, surfels_options);
    if (orthographic) picture_set_orthographic(&of);
    picture reference = picture_of_scene(&of, surfels_options, options);
    picture fast = picture_draw(context, of.cloud, &of.camera, surfels_options, options);
    uint8_t *mask = calloc(SIDE_PX, SIDE_PX);
    picture_mark_edges(&of, surfels_options, options, 2e-3, 1e-3, mask);
    const picture_report report = picture_compare(&reference, &fast, THRESHOLD, mask);
    char name[96];
    snprintf(name, sizeof name, "%s, %s", scene_name(kind), what);
    picture_print(name, &report);
    // With one pass the surfels of a plane are equally near but for rounding: the mask knows.
    assert_true(options->passes == 1 || report.over_count * 1000 < report.pixel_count);
    if (options->edge_layers == 1) { // the mask knows the nearest surface only
        // Circles use planes 16 radii beyond the disc, not 2, and so the error of the normals.
        const double farther =
            options->kernel == EWA_KERNEL_CIRCULAR ? EWA_GRAZING_TOLERANCE / EWA_FREE_RADII : 1;
        const double elsewhere = (double)(report.over_count - report.edge_over_count);
        assert_true(elsewhere <= farther * GRAZING_SHARE * (double)report.pixel_count);
        // A surfel on the rule's edge between ellipse and pixel rays is one more tie that the mask does not
        // know.
        if (kind != SCENE_NEAR && kind != SCENE_ELLIPSES)
            assert_true(report.color < GRAZING_ERROR && report.depth < farther * THRESHOLD);
    }
    free(mask);
    picture_free(&reference);
    picture_free(&fast);
    scene_free(&of);
    ewa_context_destroy(&context);
}

TEST(test_defaults_hold) {
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        WITH_DEFAULTS(ewa_render_options, options);
        hold((scene_kind)kind, NULL, &options, false, "defaults");
        options.edge_layers = 1;
        hold((scene_kind)kind, NULL, &options, false, "one edge layer");
    }
}

TEST(test_kernels_hold) {
    static const struct {
        ewa_kernel kernel;
        const char *name;
    } kernels[] = {{EWA_KERNEL_PERSPECTIVE, "perspective"},
                   {EWA_KERNEL_AFFINE, "affine"},
                   {EWA_KERNEL_SOURCE, "source"},
                   {EWA_KERNEL_CIRCULAR, "circular"},
                   {EWA_KERNEL_RAYCAST, "raycast"}};
    static const scene_kind kinds[] = {SCENE_PLANE, SCENE_TORUS, SCENE_CUBE, SCENE_ELLIPSES, SCENE_NEAR};
    for (size_t k = 0; k < sizeof kernels / sizeof kernels[0]; k++) {
        char what[64];
        for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
            WITH_DEFAULTS(ewa_render_options, options);
            options.kernel = kernels[k].kernel;
            options.edge_layers = 3;
            snprintf(what, sizeof what, "%s, three edge layers", kernels[k].name);
            hold(kinds[i], NULL, &options, false, what);
            options.edge_layers = 1;
            hold(kinds[i], NULL, &options, false, kernels[k].name);
            snprintf(what, sizeof what, "%s, orthographic", kernels[k].name);
            if (kinds[i] != SCENE_PLANE && kinds[i] != SCENE_NEAR) hold(kinds[i], NULL, &options, true, what);
            options.passes = 1;
            snprintf(what, sizeof what, "%s, one pass", kernels[k].name);
            hold(kinds[i], NULL, &options, false, what);
            options.passes = 3, options.prefilter_px = 1;
            snprintf(what, sizeof what, "%s, prefilter of the papers", kernels[k].name);
            hold(kinds[i], NULL, &options, false, what);
        }
    }
}

TEST(test_options_hold) {
    WITH_DEFAULTS(ewa_render_options, init);
    init.edge_layers = 1;
    static const scene_kind kinds[] = {SCENE_PLANE, SCENE_TORUS, SCENE_ELLIPSES, SCENE_NEAR};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        ewa_render_options o = init;
        o.kernel = EWA_KERNEL_AFFINE;
        hold(kinds[i], NULL, &o, false, "affine");
        o = init, o.prefilter_px = 1.5;
        hold(kinds[i], NULL, &o, false, "wide prefilter");
        o = init, o.edge_antialiasing = false, o.shading = EWA_SHADING_NONE;
        hold(kinds[i], NULL, &o, false, "no edges, no shading");
        o = init, o.cull = EWA_CULL_BACK, o.tolerance = 0.5;
        hold(kinds[i], NULL, &o, false, "culled, less tolerance");
        o = init, picture_set_light(&o, 1, 0, 2), o.background[1] = 0.5f, o.background[3] = 0.7f;
        hold(kinds[i], NULL, &o, false, "light and background");
        WITH_DEFAULTS(ewa_surfels_options, surfels);
        surfels.cutoff = 3.2, surfels.radius_scale = 1.3;
        hold(kinds[i], &surfels, &init, false, "long cutoff");
    }
    hold(SCENE_TORUS, NULL, &init, true, "orthographic");
    hold(SCENE_CUBE, NULL, &init, true, "orthographic");
    hold(SCENE_ELLIPSES, NULL, &init, true, "orthographic");
}

/// Draws a small scene by some threads and instructions; it has to be what the first such call has drawn.
static void draw_same(scene_kind kind, uint32_t threads, uint32_t mask, const ewa_render_options *options, picture *first) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context_of(threads, mask);
    OWNED(scene_free) scene of;
    // Small, because plain C under sanitizers takes its time.
    assert_int_equal(scene_make(context, kind, POINTS / 4, 101, 97, &of), EWA_OK);
    picture made = picture_draw(context, of.cloud, &of.camera, NULL, options);
    if (first->frame.rgba) {
        picture_expect_same(first, &made);
        picture_free(&made);
    } else {
        *first = made;
    }
}

TEST(test_same_bytes_of_every_kernel) {
    static const uint32_t masks[] = {EWA_CPU_ALL, EWA_CPU_AVX2, 0};
    static const scene_kind kinds[] = {SCENE_PLANE, SCENE_ELLIPSES, SCENE_NEAR};
    for (int kernel = EWA_KERNEL_AFFINE; kernel <= EWA_KERNEL_RAYCAST; kernel++) {
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
            WITH_DEFAULTS(ewa_render_options, options);
            options.kernel = (ewa_kernel)kernel;
            OWNED(picture_free) picture first = {0};
            for (size_t i = 0; i < sizeof masks / sizeof masks[0]; i++)
                draw_same(kinds[k], 1 + (uint32_t)i, masks[i], &options, &first);
        }
    }
}

/// The source kernel is the affine one (SS 3.2: equations 7 and 8 are equivalent), in the pipeline's single
/// precision.
TEST_ON(test_source_is_affine, 0) {
    double worst = 0;
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        OWNED(scene_free) scene of;
        WITH_DEFAULTS(ewa_render_options, options);
        options.edge_layers = 1;
        assert_int_equal(scene_make(context, (scene_kind)kind, POINTS, SIDE_PX, SIDE_PX, &of), EWA_OK);
        options.kernel = EWA_KERNEL_AFFINE;
        picture affine = picture_draw(context, of.cloud, &of.camera, NULL, &options);
        options.kernel = EWA_KERNEL_SOURCE;
        OWNED(picture_free) picture source = picture_draw(context, of.cloud, &of.camera, NULL, &options);
        uint8_t *mask = calloc(SIDE_PX, SIDE_PX);
        of.unit_coverage = 1;
        picture_mark_edges(&of, NULL, &options, 1e-4, 1e-4, mask);
        const picture_report report = picture_compare(&affine, &source, 1e-4, mask);
        char name[64];
        snprintf(name, sizeof name, "%s, source against affine", scene_name((scene_kind)kind));
        picture_print(name, &report);
        worst = fmax(worst, fmax(report.color, fmax(report.depth, report.coverage)));
        free(mask);
        picture_free(&affine);
    }
    print_message("largest difference: %.2g\n", worst);
    assert_true(worst < 1e-4);
}

TEST(test_same_bytes_on_all_threads_and_instruction_sets) {
    static const struct {
        uint32_t threads, mask;
    } runs[] = {{1, EWA_CPU_ALL},  {2, EWA_CPU_ALL},  {7, EWA_CPU_ALL},
                {32, EWA_CPU_ALL}, {2, EWA_CPU_AVX2}, {2, 0}};
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        OWNED(picture_free) picture first = {0};
        for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++)
            draw_same((scene_kind)kind, runs[i].threads, runs[i].mask, NULL, &first);
    }
}

/// The cloud with its points in the order i * step mod count, the last quarter of them all at one place.
static ewa_cloud *reordered(const ewa_cloud *cloud, uint64_t step) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_cloud *made = check_cloud_of(ewa_cloud_context(cloud), count);
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(cloud); a++) {
        const ewa_attribute *from = ewa_cloud_attribute_at(cloud, a);
        char *to = NULL;
        assert_int_equal(ewa_cloud_add(made, from->name, from->type, from->component_count, (void **)&to), EWA_OK);
        const size_t bytes = from->component_count * ewa_type_bytes(from->type);
        const bool position = strcmp(from->name, EWA_POSITION) == 0;
        for (uint64_t i = 0; i < count; i++) {
            uint64_t k = i * step % count;
            if (position && k >= count - count / 4) k = count - 1;
            memcpy(to + i * bytes, (const char *)from->data + k * from->stride_bytes, bytes);
        }
    }
    return made;
}

TEST_ON(test_order_of_points_does_not_matter, 0) {
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        OWNED(scene_free) scene of;
        assert_int_equal(scene_make(context, (scene_kind)kind, POINTS, SIDE_PX, SIDE_PX, &of), EWA_OK);
        uint64_t step = 1009; // a prime that does not divide the count
        while (ewa_cloud_point_count(of.cloud) % step == 0) step += 2;
        OWNED(ewa_cloud_destroy) ewa_cloud *same = reordered(of.cloud, 1), *other = reordered(of.cloud, step);
        OWNED(picture_free)
        picture a = picture_draw(context, same, &of.camera, NULL, NULL),
                b = picture_draw(context, other, &of.camera, NULL, NULL);
        picture_expect_same(&a, &b);
    }
}

/// More splats in a tile than are kept from pass to pass: the runs are set up again, with the same result.
TEST_ON(test_dense_tile_holds, 0) {
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_TORUS, 300000, 48, 40, &of), EWA_OK);
    ewa_surfels *surfels = check_surfels(of.cloud, NULL);
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    of.unit_coverage = info.unit_coverage;
    ewa_surfels_destroy(&surfels);
    WITH_DEFAULTS(ewa_render_options, whole);
    whole.supersampling = 1;
    OWNED(picture_free)
    picture reference = picture_of_scene(&of, NULL, &whole),
            fast = picture_draw(context, of.cloud, &of.camera, NULL, &whole);
    uint8_t mask[48 * 40];
    picture_mark_edges(&of, NULL, NULL, 2e-3, 1e-3, mask);
    const picture_report report = picture_compare(&reference, &fast, THRESHOLD, mask);
    picture_print("dense tile", &report);
    assert_true(report.over_count <= 10 && report.color < GRAZING_ERROR);
}

TEST_ON(test_empty_and_lonely, 0) {
    for (uint64_t count = 0; count < 2; count++) {
        const float position[3] = {0, 0, 5}, normal[3] = {0, 0, -1}, radius = 1;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, count);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_RADIUS, EWA_F32, 1, &radius, 0), EWA_OK);
        ewa_camera camera = check_camera(65, 63);
        assert_int_equal(ewa_camera_set_fov(&camera, 40), EWA_OK);
        OWNED(picture_free) picture made = picture_draw(context, cloud, &camera, NULL, NULL);
        const size_t middle = 31 * 65 + 32;
        assert_true(made.frame.rgba[4 * middle + 3] == (float)count); // a lone disc is opaque in its middle
        assert_true(made.frame.rgba[3] == 0 && isinf(made.frame.depth[0]));
        if (count) assert_true(fabsf(made.frame.depth[middle] - 5) < 1e-5f);
    }
}

/// Whether a linear colour is, but for the packets' 16 bits, that of one of the surfels.
static bool is_some_surfel(const ewa_cloud *cloud, const float rgb[3]) {
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    const uint8_t *codes = color->data;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        bool same = true;
        for (int c = 0; c < 3; c++)
            same = same && fabs((double)rgb[c] - ewa_srgb_decode(codes[3 * i + (uint64_t)c] / 255.0)) < 2e-5;
        if (same) return true;
    }
    return false;
}

/// One pass (PAS 6): every pixel shows one surfel, opaque and whole; three passes blend.
/// Cameras whose scale takes depths beyond the range of floats draw something or nothing, safely.
TEST_ON(test_scales_beyond_floats, 1) {
    static const double scales[] = {1e-40, 1e-30, 1e20, 3e38, 1e60};
    WITH_DEFAULTS(ewa_generate_options, generate);
    generate.object = EWA_OBJECT_SPHERE;
    generate.point_count = 40000; // so that a tile has several runs
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &generate, &cloud), EWA_OK);
    for (size_t i = 0; i < 2 * sizeof scales / sizeof scales[0]; i++) {
        ewa_camera camera = check_camera(200, 150);
        camera.fx_px = camera.fy_px = 200, camera.cx_px = 100, camera.cy_px = 75;
        const double s = scales[i / 2], away = i % 2 ? 3 * s : 0; // from the middle, and from afar
        const double rows[12] = {s, 0, 0, 0, 0, -s, 0, 0, 0, 0, -s, away};
        memcpy(camera.world_to_camera, rows, sizeof rows);
        WITH_DEFAULTS(ewa_render_options, options);
        options.kernel = EWA_KERNEL_AFFINE; // whose packets are not culled by the sides of the view
        OWNED(picture_free) picture drawn = picture_draw(context, cloud, &camera, NULL, &options);
    }
}

/// Without a prefilter, splats that are nearly lines are of a few pixels, not beyond all numbers.
TEST_ON(test_seen_from_the_edge, 1) {
    enum { WIDTH_PX = 96, DISCS = 400 };
    static const ewa_kernel kernels[] = {EWA_KERNEL_PERSPECTIVE, EWA_KERNEL_AFFINE, EWA_KERNEL_SOURCE};
    for (size_t k = 0; k < sizeof kernels / sizeof kernels[0]; k++) {
        int covered = 0;
        float most = 0, whole = 0; // of coverage: of the first disc, which is seen from the front, and of the others
        for (int i = 0; i < DISCS; i++) {
            // From half a degree down to where single precision sees no area, along slanted lines.
            const double tilt = i ? 0.01 * pow(10, -6.0 * i / DISCS) : 1.2, roll = 0.3 + 1.0 * i / DISCS;
            void *position = NULL, *normal = NULL, *radius = NULL, *color = NULL;
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1);
            assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &color), EWA_OK);
            assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &position), EWA_OK);
            assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normal), EWA_OK);
            assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
            memcpy(normal, (float[3]){0, 0, 1}, 3 * sizeof(float));
            *(float *)radius = 1;
            memset(position, 0, 3 * sizeof(float)), memset(color, 255, 3);
            ewa_camera camera = check_camera(WIDTH_PX, WIDTH_PX);
            camera.fx_px = camera.fy_px = 2 * WIDTH_PX, camera.cx_px = camera.cy_px = WIDTH_PX / 2;
            const double eye[3] = {3 * cos(tilt), 0, 3 * sin(tilt)}, target[3] = {0, 0, 0};
            const double up[3] = {0, sin(roll), cos(roll)};
            assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
            WITH_DEFAULTS(ewa_render_options, options);
            options.kernel = kernels[k], options.prefilter_px = 0, options.shading = EWA_SHADING_NONE;
            OWNED(picture_free) picture drawn = picture_draw(context, cloud, &camera, NULL, &options);
            for (size_t at = 0; at < WIDTH_PX * WIDTH_PX; at++) {
                const float *rgba = &drawn.frame.rgba[4 * at];
                assert_true(rgba[3] >= 0 && rgba[3] <= 1);
                most = fmaxf(most, drawn.frame.coverage[at]);
                if (rgba[3] > 0) assert_float_equal(rgba[0], rgba[3], 2e-6);
                covered += rgba[3] > 0;
            }
            if (i == 0) whole = most;
        }
        print_message("kernel %d: %d pixels, coverage %g and %g\n", (int)kernels[k], covered, (double)whole,
                      (double)most);
        assert_true(covered > 10000 && most < 1.02F * whole);
    }
}

TEST_ON(test_one_pass_shows_one_surfel, 0) {
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_ELLIPSES, 600, 96, 96, &of), EWA_OK);
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    options.edge_antialiasing = false;
    int others[2] = {0, 0}, covered = 0;
    for (int pass = 0; pass < 2; pass++) {
        options.passes = pass == 0 ? 1 : 3;
        OWNED(picture_free) picture made = picture_draw(context, of.cloud, &of.camera, NULL, &options);
        for (size_t i = 0; i < 96 * 96; i++) {
            const float *rgba = &made.frame.rgba[4 * i];
            if (rgba[3] == 0) continue;
            assert_true(rgba[3] == 1);
            if (pass == 0) assert_true(made.frame.coverage[i] == 1);
            covered += pass == 0;
            others[pass] += !is_some_surfel(of.cloud, rgba);
        }
    }
    print_message("%d pixels; of a mixed colour with one pass %d, with three %d\n", covered, others[0],
                  others[1]);
    assert_true(covered > 1000 && others[0] == 0 && others[1] > covered / 20);
}

TEST(test_every_failing_allocation_is_clean) {
    bool done = false;
    for (long n = 0; !done; n++) {
        check_memory memory = {.calls_left = n};
        WITH_DEFAULTS(ewa_context_options, options);
        options.allocator = check_allocator(&memory);
        options.thread_count = 2;
        ewa_context *context = NULL;
        scene of = {0};
        ewa_surfels *surfels = NULL;
        ewa_renderer *renderer = NULL;
        uint8_t *rgba8 = calloc(SIDE_PX * SIDE_PX, 4);
        const ewa_frame frame = {.rgba8 = rgba8};
        ewa_status status = ewa_context_create(&options, &context);
        if (status == EWA_OK) status = scene_make(context, SCENE_NEAR, 300, SIDE_PX, SIDE_PX, &of);
        if (status == EWA_OK) status = ewa_surfels_create(of.cloud, NULL, &surfels);
        if (status == EWA_OK) status = ewa_renderer_create(context, &renderer);
        if (status == EWA_OK) status = ewa_render(renderer, surfels, &of.camera, NULL, &frame, NULL);
        done = status == EWA_OK;
        if (!done) assert_int_equal(status, EWA_ERROR_MEMORY);
        ewa_renderer_destroy(&renderer);
        ewa_surfels_destroy(&surfels);
        scene_free(&of);
        ewa_context_destroy(&context);
        free(rgba8);
        assert_int_equal(memory.held_bytes, 0);
        assert_true(n < 1000);
    }
}

/// A warm renderer allocates nothing.
TEST(test_warm_frames_allocate_nothing) {
    check_memory memory = {.calls_left = -1};
    OWNED(ewa_context_destroy) ewa_context *context = check_context_on(0, &memory);
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_TORUS, POINTS, SIDE_PX, SIDE_PX, &of), EWA_OK);
    picture made = picture_make(SIDE_PX, SIDE_PX);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(of.cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render(renderer, surfels, &of.camera, NULL, &made.frame, NULL), EWA_OK);
    const long calls = memory.calls_left;
    assert_int_equal(ewa_render(renderer, surfels, &of.camera, NULL, &made.frame, NULL), EWA_OK);
    assert_int_equal(memory.calls_left, calls);
    picture_free(&made);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
