// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of ewa_render_backward(): held to the derivative in double precision, and the same bytes whatever the threads,
// the instruction sets and the order of the points.
#include "tests/adjoint/adjoint_scene.h"
#include "adjoint/tiles.h"
#include "reference/adjoint.h"

#include <math.h>

/// The cotangents of a picture and what comes of them.
typedef struct backward {
    adjoint_scene *scene;
    uint32_t pixel_count;
    float *rgba, *depth, *normal, *coverage;
    double *color, *opacity, *position, *normals, *radius, *tangent_u, *tangent_v, *picture;
    ewa_camera_cotangent camera;
    bool colors_only; ///< cotangents of colours and no picture: filled pixels end by the kernels
} backward;

static void *zeroed(size_t count, size_t size_bytes) {
    void *made = calloc(count, size_bytes);
    assert_non_null(made);
    return made;
}

static backward make(adjoint_scene *scene) {
    backward b = {.scene = scene, .pixel_count = scene->camera.width_px * scene->camera.height_px};
    const size_t n = scene->count, pixels = b.pixel_count;
    b.rgba = zeroed(4 * pixels, sizeof(float)), b.depth = zeroed(pixels, sizeof(float));
    b.normal = zeroed(3 * pixels, sizeof(float)), b.coverage = zeroed(pixels, sizeof(float));
    b.color = zeroed(3 * n, sizeof(double)), b.opacity = zeroed(n, sizeof(double));
    b.position = zeroed(3 * n, sizeof(double)), b.normals = zeroed(3 * n, sizeof(double));
    b.radius = zeroed(n, sizeof(double)), b.tangent_u = zeroed(3 * n, sizeof(double));
    b.tangent_v = zeroed(3 * n, sizeof(double)), b.picture = zeroed(4 * pixels, sizeof(double));
    check_random random = {11};
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 4; c++) b.rgba[4 * i + c] = (float)check_uniform(&random, -1, 1);
        for (size_t c = 0; c < 3; c++) b.normal[3 * i + c] = (float)check_uniform(&random, -0.3, 0.3);
        b.depth[i] = (float)check_uniform(&random, -1, 1);
        b.coverage[i] = (float)check_uniform(&random, -0.2, 0.2);
    }
    return b;
}

static void drop(backward *b) {
    free(b->rgba), free(b->depth), free(b->normal), free(b->coverage);
    free(b->color), free(b->opacity), free(b->position), free(b->normals);
    free(b->radius), free(b->tangent_u), free(b->tangent_v), free(b->picture);
}

/// Leaves the cotangents of colours alone.
static void leave_colors(backward *b) {
    b->colors_only = true;
    memset(b->depth, 0, b->pixel_count * sizeof *b->depth);
    memset(b->normal, 0, 3 * b->pixel_count * sizeof *b->normal);
    memset(b->coverage, 0, b->pixel_count * sizeof *b->coverage);
}

/// By tiles of a side.
static ewa_status run_tiles(backward *b, const ewa_cloud *cloud, uint32_t tile_px) {
    const adjoint_scene *s = b->scene;
    const ewa_frame_cotangent all = {b->rgba, b->depth, b->normal, b->coverage}, of_colors = {.rgba = b->rgba};
    const ewa_frame_cotangent cotangent = b->colors_only ? of_colors : all;
    const ewa_gradient gradient = {.color = b->color, .opacity = b->opacity, .position = b->position,
                                   .normal = b->normals, .radius = b->radius, .tangent_u = b->tangent_u,
                                   .tangent_v = b->tangent_v, .camera = &b->camera, .rgba = b->colors_only ? NULL : b->picture};
    return ewa_adjoint_backward(cloud, NULL, s->unit_coverage, &s->camera, &s->options, &cotangent, &gradient, tile_px);
}

static ewa_status run(backward *b, const ewa_cloud *cloud) { return run_tiles(b, cloud, EWA_ADJOINT_TILE_PX); }

static const uint32_t KINDS[] = {
    ADJOINT_PLAIN,
    ADJOINT_ELLIPSES | ADJOINT_TRANSPARENT,
    ADJOINT_ORTHOGRAPHIC | ADJOINT_LIGHTS | ADJOINT_EDGES,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES,
    ADJOINT_BILLBOARDS | ADJOINT_AFFINE,
    ADJOINT_NEAR | ADJOINT_UNLIT,
    ADJOINT_MERGED | ADJOINT_EDGES,
    ADJOINT_MERGED | ADJOINT_TRANSPARENT | ADJOINT_ELLIPSES,
    ADJOINT_CURVED | ADJOINT_EDGES,
    ADJOINT_CURVED | ADJOINT_ELLIPSES | ADJOINT_ORTHOGRAPHIC,
    ADJOINT_AFFINE | ADJOINT_HARD,
    ADJOINT_TRANSPARENT | ADJOINT_CURVED,
    ADJOINT_NEAR | ADJOINT_ORTHOGRAPHIC | ADJOINT_LIGHTS,
};

/// The largest number of a stream, and how far another is from it.
static void hold(const char *name, const double *is, const double *wanted, size_t stride, size_t count, size_t points) {
    double largest = 0, off = 0;
    for (size_t i = 0; i < points; i++)
        for (size_t c = 0; c < count; c++) {
            largest = fmax(largest, fabs(wanted[stride * i + c]));
            off = fmax(off, fabs(wanted[stride * i + c] - is[count * i + c]));
        }
    print_message("  %-10s largest %.3g, off by %.2g of it\n", name, largest, largest > 0 ? off / largest : off);
    assert_true(off <= 1e-7 * largest);
}

/// Every number is that of the reference.
TEST(test_reference) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    for (size_t n = 0; n < 2 * (sizeof KINDS / sizeof KINDS[0]); n++) {
        const uint32_t kind = KINDS[n / 2];
        print_message("kind %#x%s\n", kind, n % 2 ? ", colours alone" : "");
        OWNED(adjoint_scene_free)
        adjoint_scene *s = adjoint_scene_make(context, kind, 400, 70, kind & ADJOINT_EDGES ? 2 : 5, n / 2);
        OWNED(drop) backward b = make(s);
        if (n % 2) leave_colors(&b);
        assert_int_equal(run(&b, s->cloud), EWA_OK);
        ewa_reference_sets *sets;
        assert_int_equal(ewa_reference_sets_create(s->cloud, NULL, s->unit_coverage, &s->camera, &s->options, &sets),
                         EWA_OK);
        ewa_reference_values *cotangent = zeroed(b.pixel_count, sizeof *cotangent);
        for (uint32_t i = 0; i < b.pixel_count; i++) {
            for (uint32_t c = 0; c < 4; c++) cotangent[i].rgba[c] = (double)b.rgba[4 * i + c];
            for (uint32_t c = 0; c < 3; c++) cotangent[i].normal[c] = (double)b.normal[3 * i + c];
            cotangent[i].depth = (double)b.depth[i], cotangent[i].coverage = (double)b.coverage[i];
        }
        OWNED(check_free) ewa_reference_point_cotangent *points = zeroed(s->count, sizeof *points);
        double camera[EWA_CAMERA_NUMBERS];
        assert_int_equal(ewa_reference_sets_pull_back(sets, s->cloud, &s->camera, cotangent, points, camera), EWA_OK);
        const size_t stride = sizeof *points / sizeof(double);
        hold("color", b.color, points->color, stride, 3, s->count);
        hold("opacity", b.opacity, &points->opacity, stride, 1, s->count);
        hold("position", b.position, points->position, stride, 3, s->count);
        hold("normal", b.normals, points->normal, stride, 3, s->count);
        hold("radius", b.radius, &points->radius, stride, 1, s->count);
        hold("tangent_u", b.tangent_u, points->tangent_u, stride, 3, s->count);
        hold("tangent_v", b.tangent_v, points->tangent_v, stride, 3, s->count);
        hold("turn", b.camera.rotation, camera, 3, 3, 1);
        hold("way", b.camera.translation, camera + 3, 3, 3, 1);
        hold("focal", b.camera.focal_px, camera + 6, 2, 2, 1);
        hold("principal", b.camera.principal_px, camera + 8, 2, 2, 1);
        ewa_reference_sets_destroy(&sets);
        free(cotangent);
    }
}

/// Puts every tenth point where the one before it is: of two that begin at one depth their looks say which comes first.
static void pair_points(const adjoint_scene *s) {
    static const char *const names[] = {EWA_POSITION, EWA_NORMAL, EWA_RADIUS};
    for (int k = 0; k < 3; k++) {
        const ewa_attribute *stream = ewa_cloud_find(s->cloud, names[k]);
        if (!stream) continue;
        const size_t bytes = stream->component_count * ewa_type_bytes(stream->type);
        for (size_t i = 1; i < s->count; i += 10) memcpy((char *)stream->data + i * bytes, (char *)stream->data + (i - 1) * bytes, bytes);
    }
}

/// The same bytes for one to five threads, every instruction set, points in another order, and tiles of other sizes.
TEST(test_same_bytes) {
    (void)state;
    enum { COUNT = 1500, RUNS = 10 };
    static const uint32_t threads[RUNS] = {1, 2, 3, 4, 5, 2, 2, 3, 4, 1};
    static const uint32_t tiles[RUNS] = {16, 16, 16, 16, 16, 16, 5, 32, 64, 16};
    static const uint32_t masks[RUNS] = {~0u, ~0u, 0, EWA_CPU_AVX2, ~0u, ~0u, 0, ~0u, EWA_CPU_AVX2, ~0u};
    for (size_t k = 0; k < 2 * (sizeof KINDS / sizeof KINDS[0]); k++) {
        OWNED(drop) backward first = {.scene = NULL};
        for (int n = 0; n < RUNS; n++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context_of(threads[n], masks[n]);
            OWNED(adjoint_scene_free)
            adjoint_scene *s = adjoint_scene_make(context, KINDS[k / 2], COUNT, 130, 4, k / 2);
            pair_points(s);
            uint64_t order[COUNT];
            for (uint64_t i = 0; i < COUNT; i++) order[i] = n >= 5 ? (i * 1399 + 77) % COUNT : i;
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
            assert_int_equal(ewa_cloud_select(s->cloud, order, COUNT, &cloud), EWA_OK);
            backward b = make(s);
            if (k % 2) leave_colors(&b);
            assert_int_equal(run_tiles(&b, cloud, tiles[n]), EWA_OK);
            if (n == 0) first = b;
            for (uint64_t i = 0; i < COUNT; i++) {
                assert_memory_equal(b.color + 3 * i, first.color + 3 * order[i], 3 * sizeof(double));
                assert_memory_equal(b.opacity + i, first.opacity + order[i], sizeof(double));
                assert_memory_equal(b.position + 3 * i, first.position + 3 * order[i], 3 * sizeof(double));
                assert_memory_equal(b.normals + 3 * i, first.normals + 3 * order[i], 3 * sizeof(double));
                assert_memory_equal(b.radius + i, first.radius + order[i], sizeof(double));
                assert_memory_equal(b.tangent_u + 3 * i, first.tangent_u + 3 * order[i], 3 * sizeof(double));
                assert_memory_equal(b.tangent_v + 3 * i, first.tangent_v + 3 * order[i], 3 * sizeof(double));
            }
            assert_memory_equal(&b.camera, &first.camera, sizeof b.camera);
            assert_memory_equal(b.picture, first.picture, 4 * b.pixel_count * sizeof(double));
            if (n > 0) drop(&b);
        }
    }
}

/// Streams of floats and of doubles of the same numbers are the same points.
TEST(test_types) {
    (void)state;
    enum { COUNT = 2000 };
    static const char *const names[] = {EWA_POSITION, EWA_NORMAL, EWA_RADIUS};
    ewa_context *context = check_context(2, NULL);
    ewa_generate_options generate;
    ewa_generate_options_init(&generate, sizeof generate);
    generate.object = EWA_OBJECT_TORUS, generate.point_count = COUNT;
    ewa_cloud *clouds[2];
    for (int i = 0; i < 2; i++) assert_int_equal(ewa_cloud_generate(context, &generate, &clouds[i]), EWA_OK);
    for (int i = 0; i < 3; i++) {
        const ewa_attribute *from = ewa_cloud_find(clouds[0], names[i]);
        assert_int_equal(from->type, EWA_F32);
        void *to;
        assert_int_equal(ewa_cloud_add(clouds[1], names[i], EWA_F64, from->component_count, &to), EWA_OK);
        ewa_attribute_read_f64(ewa_cloud_find(clouds[0], names[i]), 0, COUNT, to);
    }
    adjoint_scene *s = adjoint_scene_make(context, ADJOINT_PLAIN, COUNT, 70, 5, 3);
    const double eye[3] = {0.5, -4, 2}, middle[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&s->camera, eye, middle, up), EWA_OK);
    backward of[2];
    for (int i = 0; i < 2; i++) {
        of[i] = make(s);
        leave_colors(&of[i]);
        assert_int_equal(run(&of[i], clouds[i]), EWA_OK);
    }
    double largest = 0;
    for (int i = 0; i < 3 * COUNT; i++) largest = fmax(largest, fabs(of[0].position[i]));
    assert_true(largest > 0);
    assert_memory_equal(of[0].color, of[1].color, 3 * COUNT * sizeof(double));
    assert_memory_equal(of[0].position, of[1].position, 3 * COUNT * sizeof(double));
    assert_memory_equal(of[0].normals, of[1].normals, 3 * COUNT * sizeof(double));
    assert_memory_equal(of[0].radius, of[1].radius, COUNT * sizeof(double));
    assert_memory_equal(&of[0].camera, &of[1].camera, sizeof of[0].camera);
    for (int i = 0; i < 2; i++) {
        drop(&of[i]);
        ewa_cloud_destroy(&clouds[i]);
    }
    adjoint_scene_free(&s);
    ewa_context_destroy(&context);
}

/// Colours with the picture are those that come with all others, and the picture is that of the pipeline: within what floats and
/// packets round. <A c, r> = <c, A' r>, A c being that picture without its background.
TEST(test_picture) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    for (size_t k = 0; k < sizeof KINDS / sizeof KINDS[0]; k++) {
        OWNED(adjoint_scene_free) adjoint_scene *s = adjoint_scene_make(context, KINDS[k], 400, 70, 5, k);
        for (int c = 0; c < 4; c++) s->options.background[c] = 0;
        for (uint32_t i = 0; i < 4 * s->count; i++) s->color[i] = fmax(s->color[i], 0);
        OWNED(drop) backward b = make(s);
        for (uint32_t i = 0; i < b.pixel_count; i++) b.rgba[4 * i + 3] = 0; // alpha does not depend on colours
        memset(b.depth, 0, b.pixel_count * sizeof *b.depth);
        assert_int_equal(run(&b, s->cloud), EWA_OK);
        OWNED(check_free) double *color = zeroed(3 * s->count, sizeof *color);
        const ewa_frame_cotangent cotangent = {.rgba = b.rgba};
        const ewa_gradient colors = {.color = color, .rgba = b.picture}; // else the pipeline gives them: test gather
        assert_int_equal(ewa_render_backward(s->cloud, NULL, s->unit_coverage, &s->camera, &s->options,
                                             &cotangent, &colors),
                         EWA_OK);
        hold("colors", color, b.color, 3, 3, s->count);
        OWNED(check_free) float *rgba = zeroed(4 * b.pixel_count, sizeof *rgba);
        const ewa_frame frame = {.rgba = rgba};
        ewa_surfels_info info;
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(s->cloud, NULL);
        ewa_surfels_describe(surfels, &info);
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
        assert_int_equal(ewa_render(renderer, surfels, &s->camera, &s->options, &frame, NULL), EWA_OK);
        s->unit_coverage = info.unit_coverage;
        assert_int_equal(run(&b, s->cloud), EWA_OK);
        double forward = 0, back = 0, size = 0;
        uint32_t far = 0;
        for (uint32_t i = 0; i < 4 * b.pixel_count; i++) {
            far += fabs((double)rgba[i] - b.picture[i]) > 2e-3;
            forward += (double)rgba[i] * (double)b.rgba[i];
        }
        for (uint32_t i = 0; i < s->count; i++)
            for (uint32_t c = 0; c < 3; c++) {
                back += s->color[4 * i + c] * b.color[3 * i + c];
                size += fabs(s->color[4 * i + c] * b.color[3 * i + c]);
            }
        print_message("%#x: %u of %u numbers off, products differ by %.2g\n", KINDS[k], far, 4 * b.pixel_count,
                      fabs(forward - back) / size);
        assert_true(far <= 4 * b.pixel_count / 200);
        assert_true(fabs(forward - back) <= 1e-3 * size);
    }
}

/// What is wrong is told with names and numbers; nothing is left behind when memory ends.
TEST(test_errors) {
    (void)state;
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    OWNED(adjoint_scene_free) adjoint_scene *s = adjoint_scene_make(context, ADJOINT_PLAIN, 50, 40, 5, 1);
    OWNED(drop) backward b = make(s);
    b.rgba[4 * (3 * 40 + 7) + 2] = NAN;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "number 2 of the rgba cotangent at pixel (7, 3) is nan"));
    b.rgba[4 * (3 * 40 + 7) + 2] = 0, b.depth[41] = INFINITY;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "depth cotangent at pixel (1, 1) is inf"));
    b.depth[41] = 0;
    s->unit_coverage = -1;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "unit_coverage is -1"));
    s->unit_coverage = 0.5;
    const ewa_render_options good = s->options;
    s->options.kernel = EWA_KERNEL_CIRCULAR;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "kernel is circular"));
    s->options = good, s->options.passes = 1;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_UNSUPPORTED);
    s->options = good, s->options.point_size_px = 3;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_UNSUPPORTED);
    s->options = good, s->options.shading = EWA_SHADING_PHONG;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_UNSUPPORTED);
    s->options = good, s->options.eye_dome = 1;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_UNSUPPORTED);
    s->options = good, s->options.level = 1;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_UNSUPPORTED);
    s->options = good, s->options.supersampling = 2;
    assert_int_equal(run(&b, s->cloud), EWA_ERROR_UNSUPPORTED);
    s->options = good;
    const ewa_camera camera = s->camera;
    const double away[3] = {0, 0, -9}, eye[3] = {0, 0, -3}, up[3] = {0, 1, 0};
    assert_int_equal(ewa_camera_look_at(&s->camera, eye, away, up), EWA_OK);
    log.count = 0;
    assert_int_equal(run(&b, s->cloud), EWA_OK);
    assert_non_null(strstr(log.text, "none of 50 surfels is in the picture of 40 x 37 pixels"));
    for (uint32_t i = 0; i < 3 * s->count; i++) assert_true(b.color[i] == 0 && b.position[i] == 0);
    for (int i = 0; i < 3; i++) assert_true(b.camera.rotation[i] == 0 && b.camera.translation[i] == 0);
    assert_true(fabs(b.picture[3] - (double)s->options.background[3]) < 1e-12);
    s->camera = camera;
    assert_int_equal(ewa_render_backward(s->cloud, NULL, 0.5, &s->camera, NULL, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_backward(NULL, NULL, 0.5, &s->camera, NULL, NULL, NULL), EWA_ERROR_ARGUMENT);
}

TEST(test_memory) {
    (void)state;
    bool whole = false;
    for (long calls = 0; !whole; calls++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(2, &memory);
        adjoint_scene *s = adjoint_scene_make(context, ADJOINT_PLAIN, 50, 40, 5, 1);
        backward b = make(s);
        const int64_t held = memory.held_bytes;
        memory.calls_left = calls;
        const ewa_status status = run(&b, s->cloud);
        whole = status == EWA_OK;
        assert_true(whole || status == EWA_ERROR_MEMORY);
        assert_int_equal(memory.held_bytes, held);
        memory.calls_left = -1;
        drop(&b);
        adjoint_scene_free(&s);
        ewa_context_destroy(&context);
        assert_true(calls < 200);
    }
}

/// Sums that no order changes.
TEST(test_exact) {
    (void)state;
    check_random random = {5};
    enum { COUNT = 1000 };
    double values[COUNT];
    for (int i = 0; i < COUNT; i++) {
        const double part = check_uniform(&random, -1, 1);
        values[i] = ldexp(part, (int)check_uniform(&random, -60, 60));
    }
    values[0] = 1e300, values[1] = -1e300, values[2] = 5e-324, values[3] = -5e-324, values[4] = 0, values[5] = -0x1p52;
    static const ewa_exact_sum zero;
    ewa_exact_sum up = zero, down = zero, part = zero;
    for (int i = 0; i < COUNT; i++) ewa_exact_add(&up, values[i]);
    for (int i = COUNT; i-- > 0;) ewa_exact_add(i % 3 ? &down : &part, values[i]);
    ewa_exact_join(&down, &part);
    const double sum = ewa_exact_value(&up);
    assert_true(sum == ewa_exact_value(&down));
    long double wanted = 0;
    for (int i = 2; i < COUNT; i++) wanted += (long double)values[i];
    assert_true(fabsl((long double)sum - wanted) < 1e-15L * fabsl(wanted));
    for (int i = 0; i < COUNT; i++) {
        ewa_exact_sum one = zero;
        ewa_exact_add(&one, values[i]);
        assert_true(ewa_exact_value(&one) == values[i]);
        ewa_exact_add(&one, -values[i]);
        assert_true(ewa_exact_value(&one) == 0);
    }
    ewa_exact_add(&part, -INFINITY);
    ewa_exact_join(&up, &part);
    assert_true(isnan(ewa_exact_value(&up)) && ewa_exact_value(&down) == sum);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
