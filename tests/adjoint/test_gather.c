// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/surface/gather.h and of colours by ewa_render_backward(): the transpose of the pipeline's pictures.
#include "surface/gather.h"
#include "adjoint/tiles.h"
#include "surface/packet_order.h"
#include "surface/packets.h"
#include "surface/proxy.h"
#include "surface/render.h"
#include "tests/adjoint/adjoint_scene.h"

#include <math.h>

/// Scenes with what the way back takes.
static const uint32_t KINDS[] = {
    ADJOINT_PLAIN,
    ADJOINT_UNLIT | ADJOINT_HARD,
    ADJOINT_ORTHOGRAPHIC | ADJOINT_EDGES,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES,
    ADJOINT_BILLBOARDS | ADJOINT_AFFINE,
    ADJOINT_NEAR,
    ADJOINT_SECTION | ADJOINT_HARD,
    ADJOINT_MERGED | ADJOINT_EDGES,
    ADJOINT_TRANSPARENT | ADJOINT_ELLIPSES,
    ADJOINT_MERGED | ADJOINT_TRANSPARENT | ADJOINT_BILLBOARDS,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES | ADJOINT_TRANSPARENT | ADJOINT_NEAR,
    ADJOINT_CURVED | ADJOINT_EDGES,
    ADJOINT_CURVED,
    ADJOINT_CURVED | ADJOINT_ELLIPSES | ADJOINT_TRANSPARENT,
};
enum { KIND_COUNT = sizeof KINDS / sizeof KINDS[0] };

typedef struct way_back {
    adjoint_scene *scene;
    uint32_t pixel_count;
    float *rgba, *picture; ///< cotangent; what is drawn
    double *color;
} way_back;

static way_back make(ewa_context *context, uint32_t kind, uint32_t count, uint32_t side_px) {
    const double radius_px = kind & ADJOINT_EDGES ? 2 : 5;
    way_back w = {.scene = adjoint_scene_make(context, kind, count, side_px, radius_px, kind + 3)};
    adjoint_scene *s = w.scene;
    memset(s->options.background, 0, sizeof s->options.background);
    w.pixel_count = s->camera.width_px * s->camera.height_px;
    w.rgba = calloc(4 * w.pixel_count, sizeof *w.rgba), w.color = calloc(3 * count, sizeof *w.color);
    w.picture = calloc(4 * w.pixel_count, sizeof *w.picture);
    assert_true(w.rgba && w.color && w.picture);
    check_random random = {9};
    for (uint32_t i = 0; i < 4 * w.pixel_count; i++) w.rgba[i] = (float)check_uniform(&random, -1, 1);
    // What packets code as it is.
    for (uint32_t i = 0; i < 3 * s->count; i++) s->color[i / 3 * 4 + i % 3] = i % 7 / 8.0;
    return w;
}

static void drop(way_back *w) {
    free(w->rgba), free(w->picture), free(w->color);
    adjoint_scene_free(&w->scene);
}

static ewa_status back(way_back *w) {
    const adjoint_scene *s = w->scene;
    const ewa_frame_cotangent cotangent = {.rgba = w->rgba};
    const ewa_gradient gradient = {.color = w->color};
    return ewa_render_backward(s->cloud, NULL, 0, &s->camera, &s->options, &cotangent, &gradient);
}

static void draw(way_back *w, ewa_context *context) {
    const adjoint_scene *s = w->scene;
    const ewa_frame frame = {.rgba = w->picture};
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(s->cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render(renderer, surfels, &s->camera, &s->options, &frame, NULL), EWA_OK);
}

/// What the loss changes of a picture's colours.
static double loss(const way_back *w) {
    double sum = 0;
    for (uint32_t i = 0; i < 4 * w->pixel_count; i++)
        if (i % 4 < 3) sum += (double)w->picture[i] * (double)w->rgba[i];
    return sum;
}

/// <A c, r> = <c, A' r>, A c being the picture that ewa_render() draws.
TEST(test_transpose) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    for (size_t k = 0; k < KIND_COUNT; k++) {
        OWNED(drop) way_back w = make(context, KINDS[k], 3000, 160);
        const adjoint_scene *s = w.scene;
        assert_int_equal(back(&w), EWA_OK);
        draw(&w, context);
        double backward = 0, size = 0;
        for (uint32_t i = 0; i < 3 * s->count; i++) {
            const double product = s->color[i / 3 * 4 + i % 3] * w.color[i];
            backward += product, size += fabs(product);
        }
        print_message("%#x: %.9g and %.9g, %.2g of the sizes apart\n", KINDS[k], loss(&w), backward,
                      fabs(loss(&w) - backward) / size);
        // Pictures of transparent surfaces are rounded once for each of these.
        const double allowed = KINDS[k] & ADJOINT_NEAR ? 5e-6 : KINDS[k] & ADJOINT_TRANSPARENT ? 2e-6 : 1e-6;
        assert_true(fabs(loss(&w) - backward) <= allowed * size);
    }
}

static double *replaced(ewa_cloud *cloud, const char *name, uint32_t component_count) {
    void *memory;
    assert_int_equal(ewa_cloud_add(cloud, name, EWA_F64, component_count, &memory), EWA_OK);
    return memory;
}

/// The cloud with the numbers that packets keep of it.
static ewa_cloud *as_drawn(const ewa_cloud *given) {
    const uint64_t count = ewa_cloud_point_count(given);
    OWNED(check_free) uint64_t *all = calloc(count, sizeof *all);
    assert_non_null(all);
    for (uint64_t i = 0; i < count; i++) all[i] = i;
    ewa_cloud *cloud = NULL;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = NULL;
    assert_int_equal(ewa_cloud_select(given, all, count, &cloud), EWA_OK);
    assert_int_equal(ewa_surfels_create_kept(given, NULL, &surfels), EWA_OK);
    const bool ellipses = ewa_cloud_find(cloud, EWA_TANGENT_U);
    double *position = replaced(cloud, EWA_POSITION, 3), *color = replaced(cloud, EWA_COLOR, 4);
    double *normal = replaced(cloud, EWA_NORMAL, 3), *radius = ellipses ? NULL : replaced(cloud, EWA_RADIUS, 1);
    double *axis_u = ellipses ? replaced(cloud, EWA_TANGENT_U, 3) : NULL;
    double *axis_v = ellipses ? replaced(cloud, EWA_TANGENT_V, 3) : NULL;
    double *curvature = surfels->curvatures ? replaced(cloud, EWA_CURVATURE, 1) : NULL;
    WITH_DEFAULTS(ewa_surfels_options, options);
    for (size_t i = 0; i < (size_t)surfels->packet_count * EWA_PACKET_LANES; i++) {
        const size_t point = surfels->points[i];
        if (point == EWA_NO_POINT) continue;
        ewa_packet_surfel s;
        ewa_packet_decode(surfels, (uint32_t)(i / EWA_PACKET_LANES), i % EWA_PACKET_LANES, &s);
        const ewa_vec3 center = ewa_packet_center(surfels, (uint32_t)(i / EWA_PACKET_LANES));
        const ewa_vec3 origin = vec3_load(surfels->origin_world);
        const double unit = surfels->unit / options.radius_scale, size = s.billboard ? EWA_BILLBOARD_SCALE : 1;
        vec3_store(vec3_add(vec3_scale(vec3_add(center, s.offset), surfels->unit), origin), position + 3 * point);
        vec3_store(s.normal, normal + 3 * point);
        if (radius) radius[point] = vec3_length(s.axis_u) * unit * options.cutoff / size;
        if (axis_u) vec3_store(vec3_scale(s.axis_u, unit), axis_u + 3 * point);
        if (axis_v) vec3_store(vec3_scale(s.axis_v, unit), axis_v + 3 * point);
        for (int c = 0; c < 4; c++) color[4 * point + (size_t)c] = c < 3 ? s.color[c] : s.opacity;
        if (curvature) curvature[point] = ewa_packet_decode_curvature(surfels->curvatures[i]) / surfels->unit;
    }
    return cloud;
}

/// Every number is that of the derivative in double precision of the surfels as packets keep them, within 1e-4 of the
/// largest, and what the pipeline's picture changes by when that colour does.
TEST(test_each) {
    (void)state;
    enum { WORST = 24 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    for (size_t k = 0; k < KIND_COUNT; k++) {
        OWNED(drop) way_back w = make(context, KINDS[k], 3000, 160);
        adjoint_scene *s = w.scene;
        assert_int_equal(back(&w), EWA_OK);
        double *wanted = calloc(3 * s->count, sizeof *wanted), largest = 0, off = 0, worst = 0;
        assert_non_null(wanted);
        const ewa_frame_cotangent cotangent = {.rgba = w.rgba};
        const ewa_gradient gradient = {.color = wanted};
        double unit_coverage;
        assert_int_equal(ewa_surfels_measure_unit_coverage(s->cloud, NULL, &unit_coverage), EWA_OK);
        // Clip lines are of the axes that were given.
        ewa_cloud *drawn = KINDS[k] & ADJOINT_CLIPPED ? NULL : as_drawn(s->cloud);
        assert_int_equal(ewa_adjoint_backward(drawn ? drawn : s->cloud, NULL, unit_coverage, &s->camera, &s->options,
                                              &cotangent, &gradient, EWA_ADJOINT_TILE_PX),
                         EWA_OK);
        ewa_cloud_destroy(&drawn);
        uint32_t far = 0;
        for (uint32_t i = 0; i < 3 * s->count; i++) largest = fmax(largest, fabs(wanted[i]));
        for (uint32_t i = 0; i < 3 * s->count; i++) {
            const double difference = fabs(wanted[i] - w.color[i]) / largest;
            off = fmax(off, difference), far += difference > 1e-4;
        }
        draw(&w, context);
        OWNED(check_free) float *first = calloc(4 * w.pixel_count, sizeof *first);
        assert_non_null(first);
        memcpy(first, w.picture, 4 * w.pixel_count * sizeof *first);
        for (uint32_t n = 0; n < WORST; n++) {
            uint32_t at = (n * 997) % (3 * s->count);
            for (uint32_t i = 0; i < 3 * s->count && n < WORST / 2; i++) // the farthest that are left
                if (fabs(wanted[i] - w.color[i]) > fabs(wanted[at] - w.color[at])) at = i;
            double *number = &s->color[at / 3 * 4 + at % 3], changed = 0;
            const double is = *number;
            *number = is < 0.375 ? 0.75 : 0;
            draw(&w, context);
            for (uint32_t i = at % 3; i < 4 * w.pixel_count; i += 4)
                changed += ((double)w.picture[i] - (double)first[i]) / (*number - is) * (double)w.rgba[i];
            *number = is;
            worst = fmax(worst, fabs(changed - w.color[at]) / largest);
            wanted[at] = w.color[at]; // done
        }
        print_message("%#x: largest %.3g, off by %.2g, %u of %u by more than 1e-4; from the pictures' changes %.2g\n", KINDS[k],
                      largest, off, far, 3 * s->count, worst);
        // Of many surfaces behind each other, where lines leave pixels next to no area, and of large discs that are seen from their
        // edge, whose depth goes through several surfaces within a pixel, last digits decide more often.
        const bool decided = KINDS[k] != ADJOINT_CURVED &&
                             !(KINDS[k] & (ADJOINT_CLIPPED | ADJOINT_SECTION | ADJOINT_TRANSPARENT));
        assert_true(decided ? off <= 1e-4 : far <= 3 * s->count / 100);
        assert_true(worst <= 5e-5); // pictures are rounded to whole numbers of units
        free(wanted);
    }
}

static ewa_surfels *surfels_of(const ewa_cloud *cloud) {
    ewa_surfels *surfels = NULL;
    assert_int_equal(ewa_surfels_create_kept(cloud, NULL, &surfels), EWA_OK);
    return surfels;
}

/// The same bytes for threads, instruction sets, tiles, and any order of the points.
TEST(test_same_bytes) {
    (void)state;
    enum { COUNT = 4000, RUNS = 9 };
    static const uint32_t threads[RUNS] = {1, 2, 3, 4, 5, 1, 1, 2, 2}, tiles[RUNS] = {64, 64, 64, 64, 64, 64, 64, 16, 128};
    static const uint32_t masks[RUNS] = {~0u, ~0u, ~0u, ~0u, ~0u, 0, EWA_CPU_AVX2, ~0u, ~0u};
    for (size_t k = 0; k < KIND_COUNT; k++) {
        OWNED(check_free) double *first = NULL;
        for (int n = 0; n < RUNS; n++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context_of(threads[n], masks[n]);
            OWNED(drop) way_back w = make(context, KINDS[k], COUNT, 200);
            const adjoint_scene *s = w.scene;
            uint64_t order[COUNT];
            for (uint64_t i = 0; i < COUNT; i++) order[i] = n % 2 ? (i * 1399 + 77) % COUNT : i;
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
            assert_int_equal(ewa_cloud_select(s->cloud, order, COUNT, &cloud), EWA_OK);
            OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud);
            bool any;
            const ewa_gather_request request = {.surfels = surfels, .point_count = COUNT, .camera = s->camera,
                                                .options = s->options, .tile_px = tiles[n], .rgba = w.rgba,
                                                .sums = w.color};
            assert_int_equal(ewa_gather_run(&request, &any), EWA_OK);
            assert_true(any);
            if (!first) {
                first = calloc(3 * COUNT, sizeof *first);
                assert_non_null(first);
                memcpy(first, w.color, 3 * COUNT * sizeof *first);
            }
            for (uint64_t i = 0; i < COUNT; i++)
                assert_memory_equal(w.color + 3 * i, first + 3 * order[i], 3 * sizeof *first);
        }
    }
}

/// A and A' of filled pixels: what points show is the picture; A' W A x, in one go, is A' of W times what x shows; the
/// squares of A are those of what single points show. The same bytes for threads, instruction sets and tiles.
TEST(test_filled) {
    (void)state;
    enum { COUNT = 3000, RUNS = 6, SINGLES = 12 };
    static const uint32_t kinds[] = {ADJOINT_UNLIT, ADJOINT_UNLIT | ADJOINT_CLIPPED | ADJOINT_ELLIPSES,
                                     ADJOINT_UNLIT | ADJOINT_NEAR | ADJOINT_BILLBOARDS};
    static const uint32_t threads[RUNS] = {1, 2, 3, 1, 1, 2}, masks[RUNS] = {~0u, ~0u, ~0u, 0, EWA_CPU_AVX2, ~0u};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        OWNED(check_free) double *first = NULL;
        for (int n = 0; n < RUNS; n++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context_of(threads[n], masks[n]);
            OWNED(drop) way_back w = make(context, kinds[k], COUNT, 160);
            const adjoint_scene *s = w.scene;
            w.scene->options.edge_layers = 1; // nothing behind
            OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(s->cloud);
            const uint32_t pixels = w.pixel_count;
            float *shown = calloc(4 * pixels, sizeof *shown), *weights = calloc(pixels, sizeof *weights);
            float *weighted = calloc(4 * pixels, sizeof *weighted), *single = calloc(4 * pixels, sizeof *single);
            double *x = calloc(3 * COUNT, sizeof *x), *sums = calloc(3 * COUNT, sizeof *sums);
            OWNED(check_free) double *again = calloc(3 * COUNT, sizeof *again);
            assert_true(shown && weights && weighted && single && x && sums && again);
            for (uint32_t i = 0; i < 3 * COUNT; i++) x[i] = s->color[i / 3 * 4 + i % 3];
            for (uint32_t i = 0; i < pixels; i++) weights[i] = fabsf(w.rgba[4 * i]);
            ewa_gather_room room = {.state = NULL};
            ewa_gather_request request = {.surfels = surfels, .point_count = COUNT, .camera = s->camera,
                                          .options = s->options, .filled = true, .minimum_alpha = 0.99f,
                                          .weights = weights, .colors = x, .shown = shown, .sums = sums, .room = &room};
            assert_int_equal(ewa_gather_run(&request, NULL), EWA_OK);
            draw(&w, context);
            uint32_t full = 0;
            double apart = 0;
            for (uint32_t i = 0; i < pixels; i++) {
                const bool fills = shown[4 * i + 3] == 1;
                const double alpha = (double)w.picture[4 * i + 3];
                assert_true(fills || shown[4 * i + 3] == 0);
                assert_true(fills ? alpha > 0.9899 : alpha < 0.9901 || shown[4 * i] == 0);
                full += fills;
                for (uint32_t c = 0; c < 3; c++) {
                    if (fills && alpha == 1) apart = fmax(apart, fabs((double)(shown[4 * i + c] - w.picture[4 * i + c])));
                    if (fills) weighted[4 * i + c] = weights[i] * shown[4 * i + c];
                }
            }
            print_message("%#x: pictures %.2g apart\n", kinds[k], apart);
            assert_true(full > pixels / 4 && apart < 1e-3);
            if (!first) {
                first = calloc(3 * COUNT, sizeof *first);
                assert_non_null(first);
                memcpy(first, sums, 3 * COUNT * sizeof *first);
            }
            assert_memory_equal(sums, first, 3 * COUNT * sizeof *first);
            request.weights = NULL, request.colors = NULL, request.shown = NULL;
            request.rgba = weighted, request.sums = again;
            double largest = 0, off = 0;
            assert_int_equal(ewa_gather_run(&request, NULL), EWA_OK);
            for (uint32_t i = 0; i < 3 * COUNT; i++) {
                largest = fmax(largest, fabs(again[i]));
                off = fmax(off, fabs(again[i] - sums[i]));
            }
            assert_true(largest > 0.1 && off < 1e-5 * largest);
            // The diagonal of A' W A.
            request.rgba = NULL, request.weights = weights, request.squares = true;
            memset(again, 0, 3 * COUNT * sizeof *again);
            assert_int_equal(ewa_gather_run(&request, NULL), EWA_OK);
            for (uint32_t m = 0; m < SINGLES && n == 0; m++) {
                const uint32_t point = m * 241 % COUNT;
                double *unit = calloc(3 * COUNT, sizeof *unit), wanted = 0;
                assert_non_null(unit);
                unit[3 * point] = 1;
                ewa_gather_request alone = request;
                alone.squares = false, alone.sums = NULL, alone.colors = unit, alone.shown = single;
                assert_int_equal(ewa_gather_run(&alone, NULL), EWA_OK);
                for (uint32_t i = 0; i < pixels; i++)
                    wanted += (double)weights[i] * (double)single[4 * i] * (double)single[4 * i];
                assert_true(fabs(again[3 * point] - wanted) < 1e-4 * fmax(wanted, 0.1));
                free(unit);
            }
            ewa_gather_room_free(context, &room);
            free(shown), free(weights), free(weighted), free(single), free(x), free(sums);
        }
    }
}

/// A constant cotangent comes back whole: where alpha is 1, what pixels give is what surfels get, also of tiles with more
/// records than are kept.
TEST(test_sum) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    enum { COUNT = 300000, SIDE = 64 };
    static const float z[2] = {0, 0.5f};
    for (int many = 0; many < 2; many++) {
        const uint64_t count = many ? COUNT : 3000;
        ewa_cloud *cloud = check_cloud_of(context, count);
        float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
        float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
        float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
        check_random random = {2};
        for (uint64_t i = 0; i < count; i++) {
            position[3 * i] = (float)check_uniform(&random, -3, 3), position[3 * i + 1] = (float)check_uniform(&random, -3, 3);
            position[3 * i + 2] = z[i % 2];
            normal[3 * i] = normal[3 * i + 1] = 0, normal[3 * i + 2] = -1;
            radius[i] = many ? 0.05f : 0.3f;
        }
        ewa_camera camera;
        ewa_camera_init(&camera);
        const double eye[3] = {0, 0, -4}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
        camera.width_px = camera.height_px = SIDE, camera.cx_px = camera.cy_px = SIDE / 2;
        camera.fx_px = camera.fy_px = SIDE;
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        WITH_DEFAULTS(ewa_render_options, options);
        options.shading = EWA_SHADING_NONE, options.edge_antialiasing = false;
        float *rgba = calloc(4 * SIDE * SIDE, sizeof *rgba);
        double *color = calloc(3 * count, sizeof *color), sums[3] = {0};
        assert_true(rgba && color);
        for (int i = 0; i < SIDE * SIDE; i++) rgba[4 * i] = 1, rgba[4 * i + 1] = -0.5f, rgba[4 * i + 3] = 3;
        const ewa_frame_cotangent cotangent = {.rgba = rgba};
        const ewa_gradient gradient = {.color = color};
        assert_int_equal(ewa_render_backward(cloud, NULL, 0, &camera, &options, &cotangent, &gradient), EWA_OK);
        for (uint64_t i = 0; i < 3 * count; i++) {
            sums[i % 3] += color[i];
            if (position[i / 3 * 3 + 2] > 0.4f && !many) assert_true(color[i] == 0); // hidden
        }
        const double pixels = SIDE * SIDE;
        assert_true(fabs(sums[0] - pixels) < 1e-4 * pixels && fabs(sums[1] + pixels / 2) < 1e-4 * pixels && sums[2] == 0);
        ewa_cloud_destroy(&cloud);
        free(rgba), free(color);
    }
}

/// What the pipeline does not go back from is done in double precision, as all is that comes with more than colours.
TEST(test_roads) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    static const uint32_t kinds[] = {ADJOINT_LIGHTS, ADJOINT_PLAIN};
    for (int k = 0; k < 2; k++) {
        OWNED(drop) way_back w = make(context, kinds[k], 500, 80);
        adjoint_scene *s = w.scene;
        OWNED(check_free)
        double *exact = calloc(3 * s->count, sizeof *exact), *picture = calloc(4 * w.pixel_count, sizeof *picture);
        assert_true(exact && picture);
        const ewa_frame_cotangent cotangent = {.rgba = w.rgba};
        const ewa_gradient colors = {.color = exact}, both = {.color = w.color, .rgba = picture};
        assert_int_equal(ewa_adjoint_backward(s->cloud, NULL, 0.5, &s->camera, &s->options, &cotangent, &colors, 16),
                         EWA_OK);
        assert_int_equal(ewa_render_backward(s->cloud, NULL, 0.5, &s->camera, &s->options, &cotangent, &both), EWA_OK);
        assert_memory_equal(w.color, exact, 3 * s->count * sizeof *exact);
        const ewa_gradient alone = {.color = w.color};
        assert_int_equal(ewa_render_backward(s->cloud, NULL, 0.5, &s->camera, &s->options, &cotangent, &alone), EWA_OK);
        const bool same = memcmp(w.color, exact, 3 * s->count * sizeof *exact) == 0;
        assert_true(same == (kinds[k] == ADJOINT_LIGHTS));
    }
}

TEST(test_errors) {
    (void)state;
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    OWNED(drop) way_back w = make(context, ADJOINT_PLAIN, 50, 40);
    adjoint_scene *s = w.scene;
    const ewa_render_options good = s->options;
    s->options.kernel = EWA_KERNEL_RAYCAST;
    assert_int_equal(back(&w), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "kernel is raycast"));
    s->options = good, s->options.passes = 1;
    assert_int_equal(back(&w), EWA_ERROR_UNSUPPORTED);
    s->options = good;
    w.rgba[4 * 83 + 1] = NAN;
    assert_int_equal(back(&w), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "number 1 of the rgba cotangent at pixel (3, 2) is nan"));
    memset(w.rgba, 0, 4 * w.pixel_count * sizeof *w.rgba);
    w.color[7] = 3;
    assert_int_equal(back(&w), EWA_OK);
    for (int i = 0; i < 150; i++) assert_true(w.color[i] == 0);
    const double away[3] = {0, 0, -9}, eye[3] = {0, 0, -3}, up[3] = {0, 1, 0};
    assert_int_equal(ewa_camera_look_at(&s->camera, eye, away, up), EWA_OK);
    log.count = 0;
    assert_int_equal(back(&w), EWA_OK);
    assert_non_null(strstr(log.text, "none of 50 surfels is in the picture of 40 x 37 pixels"));
}

TEST(test_memory) {
    (void)state;
    bool whole = false;
    for (long calls = 0; !whole; calls++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(2, &memory);
        way_back w = make(context, ADJOINT_UNLIT, 50, 40);
        const int64_t held = memory.held_bytes;
        memory.calls_left = calls;
        ewa_status status = back(&w);
        ewa_surfels *surfels = NULL;
        float shown[4 * 40 * 40];
        double x[3 * 50] = {1}, sums[3 * 50] = {0};
        if (status == EWA_OK) status = ewa_surfels_create_kept(w.scene->cloud, NULL, &surfels);
        const ewa_gather_request request = {.surfels = surfels, .point_count = 50, .camera = w.scene->camera,
                                            .options = w.scene->options, .filled = true, .minimum_alpha = 0.99f,
                                            .colors = x, .shown = shown, .sums = sums};
        if (status == EWA_OK) status = ewa_gather_run(&request, NULL);
        ewa_surfels_destroy(&surfels);
        whole = status == EWA_OK;
        assert_true(whole || status == EWA_ERROR_MEMORY);
        assert_int_equal(memory.held_bytes, held);
        memory.calls_left = -1;
        drop(&w);
        ewa_context_destroy(&context);
        assert_true(calls < 1000);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
