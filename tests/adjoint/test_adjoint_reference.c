// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the derivative in double precision: differences of pictures at fixed sets, number by number.
#include "reference/adjoint.h"
#include "reference/adjoint_frame.h"
#include "reference/surface.h"
#include "tests/adjoint/adjoint_scene.h"

#include <math.h>

enum { SIDE = 20, POINTS = 36 };

/// A scene, its sets, random cotangents of its picture, and what they pull back to.
typedef struct derivative {
    adjoint_scene *scene;
    ewa_reference_sets *sets;
    uint32_t pixel_count;
    ewa_reference_values *cotangent, *values;
    ewa_reference_point_cotangent points[POINTS];
    double camera[EWA_CAMERA_NUMBERS];
} derivative;

static double loss(derivative *d, const ewa_camera *camera) {
    assert_int_equal(ewa_reference_sets_draw(d->sets, d->scene->cloud, camera, d->values), EWA_OK);
    double sum = 0;
    for (uint32_t i = 0; i < d->pixel_count; i++) {
        const ewa_reference_values *a = &d->cotangent[i], *b = &d->values[i];
        for (int c = 0; c < 4; c++) sum += a->rgba[c] * b->rgba[c];
        for (int c = 0; c < 3; c++) sum += a->normal[c] * b->normal[c];
        sum += a->coverage * b->coverage;
        if (isfinite(b->depth)) sum += a->depth * b->depth;
    }
    return sum;
}

static derivative *start(ewa_context *context, uint32_t kind) {
    derivative *d = calloc(1, sizeof *d);
    assert_non_null(d);
    d->scene = adjoint_scene_make(context, kind, POINTS, SIDE, kind & ADJOINT_EDGES ? 1.2 : 4, kind + 1);
    d->pixel_count = d->scene->camera.width_px * d->scene->camera.height_px;
    d->cotangent = calloc(d->pixel_count, sizeof *d->cotangent);
    d->values = calloc(d->pixel_count, sizeof *d->values);
    assert_true(d->cotangent && d->values);
    check_random random = {7};
    for (uint32_t i = 0; i < d->pixel_count; i++) {
        for (int c = 0; c < 4; c++) d->cotangent[i].rgba[c] = check_uniform(&random, -1, 1);
        check_uniform3(&random, -0.3, 0.3, d->cotangent[i].normal);
        d->cotangent[i].depth = check_uniform(&random, -1, 1);
        d->cotangent[i].coverage = check_uniform(&random, -0.2, 0.2);
    }
    adjoint_scene *s = d->scene;
    assert_int_equal(
        ewa_reference_sets_create(s->cloud, NULL, s->unit_coverage, &s->camera, &s->options, &d->sets), EWA_OK);
    assert_int_equal(
        ewa_reference_sets_pull_back(d->sets, s->cloud, &s->camera, d->cotangent, d->points, d->camera), EWA_OK);
    return d;
}

static void finish(derivative *d) {
    ewa_reference_sets_destroy(&d->sets);
    adjoint_scene_free(&d->scene);
    free(d->cotangent), free(d->values);
    free(d);
}

/// By so much of the largest a gradient may differ from a difference.
static const double TOLERANCE = 1e-6;

/// Holds the cotangents of an attribute to differences of its numbers. `stride`: numbers of a point.
static void hold(derivative *d, const char *name, double *numbers, int stride, int count, size_t member, double step) {
    double largest = 0, off = 0;
    for (int i = 0; i < POINTS; i++)
        for (int c = 0; c < count; c++) {
            double *number = &numbers[stride * i + c];
            const double before = *number;
            *number = before + step;
            const double above = loss(d, &d->scene->camera);
            *number = before - step;
            const double below = loss(d, &d->scene->camera);
            *number = before;
            const double wanted = (above - below) / (2 * step);
            const double *is = (const double *)(const void *)((const char *)&d->points[i] + member) + c;
            largest = fmax(largest, fabs(wanted));
            off = fmax(off, fabs(wanted - *is));
        }
    print_message("%-10s largest %.3g, off by %.2g of it\n", name, largest, off / largest);
    assert_true(largest > 0);
    assert_true(off <= TOLERANCE * largest);
}

static void cross(const double a[3], const double b[3], double product[3]) {
    for (int i = 0; i < 3; i++)
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/// Turns camera space by r, and moves it by t.
static void move(ewa_camera *camera, const double turn[3], const double way[3]) {
    const double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    const double s = angle > 0 ? sin(angle) / angle : 1, c = angle > 0 ? (1 - cos(angle)) / (angle * angle) : 0.5;
    double old[12];
    memcpy(old, camera->world_to_camera, sizeof old);
    for (int column = 0; column < 4; column++) {
        const double v[3] = {old[column], old[4 + column], old[8 + column]};
        double a[3], b[3];
        cross(turn, v, a), cross(turn, a, b);
        for (int r = 0; r < 3; r++)
            camera->world_to_camera[4 * r + column] = v[r] + s * a[r] + c * b[r] + (column == 3 ? way[r] : 0);
    }
}

static ewa_camera change(const ewa_camera *from, int number, double by) {
    ewa_camera camera = *from;
    double turn[3] = {0}, way[3] = {0};
    if (number < 3) turn[number] = by;
    if (number >= 3 && number < 6) way[number - 3] = by;
    move(&camera, turn, way);
    double *const lens[4] = {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px};
    if (number >= 6) *lens[number - 6] += by;
    return camera;
}

static void hold_camera(derivative *d) {
    for (int i = 0; i < EWA_CAMERA_NUMBERS; i++) {
        const double step = i < 6 ? 1e-6 : 1e-5;
        const ewa_camera above = change(&d->scene->camera, i, step), below = change(&d->scene->camera, i, -step);
        const double wanted = (loss(d, &above) - loss(d, &below)) / (2 * step), is = d->camera[i];
        print_message("camera %d   %.6g, off by %.2g\n", i, wanted, fabs(is - wanted));
        const double first = i < 3 ? fabs(d->camera[0]) + fabs(d->camera[1]) + fabs(d->camera[2])
                             : i < 6 ? fabs(d->camera[3]) + fabs(d->camera[4]) + fabs(d->camera[5])
                                     : fabs(wanted) + 0.1;
        assert_true(fabs(is - wanted) <= TOLERANCE * first);
    }
}

static const uint32_t KINDS[] = {
    ADJOINT_PLAIN,
    ADJOINT_ELLIPSES,
    ADJOINT_TRANSPARENT,
    ADJOINT_ORTHOGRAPHIC,
    ADJOINT_AFFINE,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES,
    ADJOINT_BILLBOARDS,
    ADJOINT_BILLBOARDS | ADJOINT_ELLIPSES | ADJOINT_LIGHTS,
    ADJOINT_LIGHTS | ADJOINT_EDGES,
    ADJOINT_HARD | ADJOINT_TRANSPARENT | ADJOINT_ELLIPSES,
    ADJOINT_SECTION,
    ADJOINT_UNLIT | ADJOINT_EDGES | ADJOINT_ORTHOGRAPHIC | ADJOINT_TRANSPARENT | ADJOINT_ELLIPSES,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES | ADJOINT_EDGES | ADJOINT_TRANSPARENT,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES | ADJOINT_EDGES,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES | ADJOINT_EDGES | ADJOINT_UNLIT,
    ADJOINT_CLIPPED | ADJOINT_ELLIPSES | ADJOINT_EDGES | ADJOINT_UNLIT | ADJOINT_ORTHOGRAPHIC,
    ADJOINT_MERGED | ADJOINT_EDGES,
    ADJOINT_MERGED | ADJOINT_TRANSPARENT,
    ADJOINT_MERGED | ADJOINT_TRANSPARENT | ADJOINT_CLIPPED | ADJOINT_ELLIPSES,
    ADJOINT_NEAR | ADJOINT_LIGHTS,
    ADJOINT_CURVED,
    ADJOINT_CURVED | ADJOINT_ELLIPSES | ADJOINT_TRANSPARENT,
    ADJOINT_CURVED | ADJOINT_ORTHOGRAPHIC | ADJOINT_LIGHTS,
    ADJOINT_CURVED | ADJOINT_ELLIPSES | ADJOINT_ORTHOGRAPHIC | ADJOINT_EDGES,
    ADJOINT_CURVED | ADJOINT_AFFINE | ADJOINT_EDGES,
};

/// Every number of every surfel, and of the camera, in scenes of all kinds.
TEST(test_differences) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    for (size_t k = 0; k < sizeof KINDS / sizeof KINDS[0]; k++) {
        print_message("kind %#x\n", KINDS[k]);
        derivative *d = start(context, KINDS[k]);
        adjoint_scene *s = d->scene;
#define OF(member) offsetof(ewa_reference_point_cotangent, member)
        hold(d, "color", s->color, 4, 3, OF(color), 1e-4);
        if (KINDS[k] & ADJOINT_TRANSPARENT) hold(d, "opacity", s->color + 3, 4, 1, OF(opacity), 1e-6);
        hold(d, "position", s->position, 3, 3, OF(position), 1e-6);
        if (KINDS[k] & ADJOINT_ELLIPSES) {
            hold(d, "tangent_u", s->tangent_u, 3, 3, OF(tangent_u), 1e-7);
            hold(d, "tangent_v", s->tangent_v, 3, 3, OF(tangent_v), 1e-7);
        } else {
            hold(d, "normal", s->normal, 3, 3, OF(normal), 1e-6);
            hold(d, "radius", s->radius, 1, 1, OF(radius), 1e-7);
        }
        hold_camera(d);
        finish(d);
    }
}

/// The picture at the sets is that of the reference.
TEST(test_picture) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    for (size_t k = 0; k < sizeof KINDS / sizeof KINDS[0]; k++) {
        derivative *d = start(context, KINDS[k]);
        adjoint_scene *s = d->scene;
        loss(d, &s->camera);
        float *rgba = malloc(4 * d->pixel_count * sizeof *rgba), *depth = malloc(d->pixel_count * sizeof *depth);
        float *normal = malloc(3 * d->pixel_count * sizeof *normal);
        float *coverage = malloc(d->pixel_count * sizeof *coverage);
        assert_true(rgba && depth && normal && coverage);
        const ewa_frame frame = {.rgba = rgba, .depth = depth, .normal = normal, .coverage = coverage};
        assert_int_equal(
            ewa_render_reference(s->cloud, NULL, s->unit_coverage, &s->camera, &s->options, &frame), EWA_OK);
        for (uint32_t i = 0; i < d->pixel_count; i++) {
            for (int c = 0; c < 4; c++)
                assert_true(fabs((double)rgba[4 * i + (uint32_t)c] - d->values[i].rgba[c]) < 1e-6);
            for (int c = 0; c < 3; c++)
                assert_true(fabs((double)normal[3 * i + (uint32_t)c] - d->values[i].normal[c]) < 1e-6);
            assert_true(depth[i] == (float)d->values[i].depth || fabs((double)depth[i] - d->values[i].depth) < 1e-5);
            assert_true(fabs((double)coverage[i] - d->values[i].coverage) < 1e-5);
        }
        free(rgba), free(depth), free(normal), free(coverage);
        finish(d);
    }
}

/// Colours without opacity are linear: <A c, r> = <c, A' r>, A being the picture without its background.
TEST(test_transpose) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    for (size_t k = 0; k < sizeof KINDS / sizeof KINDS[0]; k++) {
        derivative *d = start(context, KINDS[k]);
        adjoint_scene *s = d->scene;
        double product = 0, size = 0;
        for (uint32_t i = 0; i < POINTS; i++)
            for (uint32_t c = 0; c < 3; c++) {
                product += s->color[4 * i + c] * d->points[i].color[c];
                size += fabs(s->color[4 * i + c] * d->points[i].color[c]);
            }
        const double all = loss(d, &s->camera);
        for (uint32_t i = 0; i < POINTS; i++) s->color[4 * i] = s->color[4 * i + 1] = s->color[4 * i + 2] = 0;
        assert_true(fabs(all - loss(d, &s->camera) - product) <= 1e-12 * size);
        finish(d);
    }
}

/// Splats at one pixel, of all shares, that their lines keep about one side: a half of them on the first of two
/// surfaces.
enum { FRAGMENTS = 6 };
static void random_pixel(check_random *random, ewa_reference_splat *splats, ewa_reference_fragment *fragments) {
    const double agree = check_uniform(random, 0.1, 3), cut = check_uniform(random, 0, 1);
    for (uint32_t i = 0; i < FRAGMENTS; i++) {
        double numbers[3];
        const double side = check_uniform(random, 0, 1), opacity = check_uniform(random, 0.1, 1);
        splats[i] = (ewa_reference_splat){.is_back = side < 0.3, .opacity = opacity};
        check_uniform3(random, 0, 1, numbers);
        splats[i].color = vec3_load(numbers);
        check_uniform3(random, -1, 1, numbers);
        splats[i].normal_world = vec3_load(numbers);
        const double share = check_uniform(random, 0, 1) < cut ? check_uniform(random, 0.01, 1) : 1;
        const double angle = check_uniform(random, -agree, agree), length = check_uniform(random, 0.8, 1);
        const double direction = i < FRAGMENTS / 2 || check_uniform(random, 0, 1) < 0.5 ? 1 : -1;
        fragments[i] = (ewa_reference_fragment){
            .splat = &splats[i],
            .index = i,
            .layer = i < FRAGMENTS / 2 ? 0 : 1,
            .sample = {.weight = check_uniform(random, 0.001, 0.16) * share, .z = check_uniform(random, 1, 2),
                       .share = share, .inward = {direction * length * cos(angle), length * sin(angle)}}};
    }
}

/// The pixel alone: every weight, in many random pixels, so that every branch of what covers is gone through.
TEST(test_pixels) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    OWNED(adjoint_scene_free) adjoint_scene *s = adjoint_scene_make(context, ADJOINT_LIGHTS, 1, SIDE, 4, 1);
    ewa_reference_frame frame;
    assert_int_equal(ewa_reference_frame_make(s->cloud, NULL, s->unit_coverage, &s->camera, &s->options, &frame),
                     EWA_OK);
    check_random random = {3};
    int off = 0;
    enum { PIXELS = 20000 };
    for (int n = 0; n < PIXELS; n++) {
        ewa_reference_splat splats[FRAGMENTS];
        ewa_reference_fragment fragments[FRAGMENTS];
        ewa_reference_layer layers[2];
        random_pixel(&random, splats, fragments);
        frame.resolve.layering = (ewa_reference_layering){2, n % 4 == 3, n % 3 == 0};
        frame.resolve.unit_coverage = check_uniform(&random, 0.05, 0.5);
        ewa_reference_values cotangent = {.coverage = check_uniform(&random, -1, 1)};
        cotangent.depth = check_uniform(&random, -1, 1);
        for (int c = 0; c < 4; c++) cotangent.rgba[c] = check_uniform(&random, -1, 1);
        check_uniform3(&random, -1, 1, cotangent.normal);
        double camera[EWA_CAMERA_NUMBERS];
        ewa_reference_layers_gather(&frame.resolve, 5.5, 6.5, fragments, FRAGMENTS, 2, layers);
        ewa_reference_layers_pull_back(&frame.resolve, 5.5, 6.5, &cotangent, layers, 2, camera);
        for (uint32_t i = 0; i < FRAGMENTS; i++) {
            ewa_reference_sample *sample = &fragments[i].sample;
            double terms[EWA_MOMENT_COUNT], sides[2], weight = sample->weight, step = 1e-7;
            ewa_reference_moments_at(&frame.view, &splats[i], sample, 5.5, 6.5, frame.resolve.layering.transparent,
                                     &layers[fragments[i].layer].cotangent, terms);
            for (int side = 0; side < 2; side++) {
                ewa_reference_layer moved[2];
                sample->weight = weight + (side ? step : -step);
                ewa_reference_layers_gather(&frame.resolve, 5.5, 6.5, fragments, FRAGMENTS, 2, moved);
                const ewa_reference_values is = ewa_reference_layers_show(&frame.resolve, moved, 2);
                sides[side] = cotangent.coverage * is.coverage + cotangent.depth * is.depth;
                for (int c = 0; c < 4; c++) sides[side] += cotangent.rgba[c] * is.rgba[c];
                for (int c = 0; c < 3; c++) sides[side] += cotangent.normal[c] * is.normal[c];
            }
            sample->weight = weight;
            const double wanted = (sides[1] - sides[0]) / (2 * step), is = terms[EWA_MOMENT_WEIGHT] / weight;
            off += fabs(wanted - is) > 1e-5 * (1 + fabs(wanted));
        }
    }
    // Where a step crosses a kink.
    print_message("%d of %d weights off\n", off, PIXELS * FRAGMENTS);
    assert_true(off <= 4);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
