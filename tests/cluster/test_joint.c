// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of sources that are spread over ranks is the frame of one process with all of them, byte for byte.
#include "cluster/ranks.h"
#include "splat/picture.h"
#include "surface/render.h"

#include <string.h>

enum { WIDTH_PX = 150, HEIGHT_PX = 131, POINTS = 2500, PARTS = 5 };

/// A frame of PARTS sources.
typedef struct subject {
    bool clips; ///< some parts have clip lines
    ewa_render_source how[PARTS];
    ewa_camera camera;
    ewa_render_options options;
    bool planes;
    picture found[RANKS_MOST];
    ewa_status status[RANKS_MOST];
} subject;

static const scene_kind kinds[PARTS] = {SCENE_SPHERE, SCENE_CUBE, SCENE_ELLIPSES, SCENE_NEAR, SCENE_TORUS};

/// Makes surfels of a part in a context and adds them.
static ewa_surfels *add_part(ewa_context *context, ewa_renderer *renderer, const subject *of, uint32_t part) {
    ewa_surfels *surfels = NULL;
    scene made;
    assert_int_equal(scene_make(context, kinds[part], POINTS, WIDTH_PX, HEIGHT_PX, &made), EWA_OK);
    if (of->clips && part != 2) picture_add_clips(made.cloud);
    assert_int_equal(ewa_surfels_create(made.cloud, NULL, &surfels), EWA_OK);
    assert_int_equal(ewa_render_add_source(renderer, surfels, &of->how[part]), EWA_OK);
    scene_free(&made);
    return surfels;
}

static ewa_frame frame_of(const subject *of, const picture *into) {
    return of->planes ? into->frame : (ewa_frame){.rgba8 = into->frame.rgba8};
}

/// Draws parts `rank`, `rank` + count, ... of the frame.
static void draw(ewa_context *context, ewa_renderer *renderer, const subject *of, uint32_t rank,
                 uint32_t count, const picture *into, ewa_status *status) {
    ewa_surfels *surfels[PARTS] = {NULL};
    const ewa_frame frame = frame_of(of, into);
    *status = ewa_render_begin(renderer, &of->camera, &of->options, &frame);
    for (uint32_t i = rank; i < PARTS; i += count) surfels[i] = add_part(context, renderer, of, i);
    if (*status == EWA_OK) *status = ewa_render_finish(renderer, NULL);
    for (uint32_t i = 0; i < PARTS; i++) ewa_surfels_destroy(&surfels[i]);
}

static void draw_as_rank(const ewa_exchange *exchange, void *data) {
    subject *of = data;
    ewa_context *context = check_context(1, NULL);
    ewa_renderer *renderer = NULL;
    of->status[exchange->rank] = ewa_renderer_create_joint(context, exchange, &renderer);
    if (of->status[exchange->rank] == EWA_OK)
        draw(context, renderer, of, exchange->rank, exchange->rank_count, &of->found[exchange->rank],
             &of->status[exchange->rank]);
    ewa_renderer_destroy(&renderer);
    ewa_context_destroy(&context);
}

static void assert_same(const subject *of, const picture *a, const picture *b, uint32_t ranks) {
    const size_t pixels = (size_t)WIDTH_PX * HEIGHT_PX;
    bool same = memcmp(a->frame.rgba8, b->frame.rgba8, 4 * pixels) == 0;
    if (of->planes)
        same = same && memcmp(a->frame.rgba, b->frame.rgba, 16 * pixels) == 0 &&
               memcmp(a->frame.depth, b->frame.depth, 4 * pixels) == 0 &&
               memcmp(a->frame.normal, b->frame.normal, 12 * pixels) == 0 &&
               memcmp(a->frame.coverage, b->frame.coverage, 4 * pixels) == 0;
    if (!same) fail_msg("%u ranks: other bytes", ranks);
}

static void hold(subject *of) {
    ewa_context *context = check_context(2, NULL);
    ewa_renderer *renderer = NULL;
    ewa_status status = EWA_OK;
    picture expected = picture_make(WIDTH_PX, HEIGHT_PX);
    assert_int_equal(ewa_renderer_create(context, &renderer), EWA_OK);
    draw(context, renderer, of, 0, 1, &expected, &status);
    assert_int_equal(status, EWA_OK);
    static const uint32_t counts[] = {1, 2, 3, 7};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        for (uint32_t rank = 0; rank < counts[i]; rank++) of->found[rank] = picture_make(WIDTH_PX, HEIGHT_PX);
        // For one rank, or for all.
        const uint32_t picture_rank = i % 2 ? EWA_ALL_RANKS : counts[i] - 1;
        ranks_run(counts[i], picture_rank, draw_as_rank, of);
        for (uint32_t rank = 0; rank < counts[i]; rank++) {
            assert_int_equal(of->status[rank], EWA_OK);
            if (i % 2 || rank == picture_rank) assert_same(of, &expected, &of->found[rank], counts[i]);
            picture_free(&of->found[rank]);
        }
    }
    picture_free(&expected);
    ewa_renderer_destroy(&renderer);
    ewa_context_destroy(&context);
}

/// Scenes of several kinds in one frame, seen by the camera of the one at `seen`.
static subject make(ewa_context *context, int seen) {
    subject made;
    memset(&made, 0, sizeof made);
    scene of;
    assert_int_equal(scene_make(context, kinds[seen], POINTS, WIDTH_PX, HEIGHT_PX, &of), EWA_OK);
    made.camera = of.camera;
    scene_free(&of);
    for (int i = 0; i < PARTS; i++) made.how[i] = (ewa_render_source){1, true};
    ewa_render_options_init(&made.options, sizeof made.options);
    return made;
}

static void test_bytes_of_one_process(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    for (int i = 0; i < 12; i++) {
        subject of = make(context, i % PARTS);
        ewa_render_options *o = &of.options;
        of.planes = i % 2;
        switch (i) {
        case 2:
            o->opacity = 0.5;
            break;
        case 3:
            o->opacity = 0.5, o->layers = 3;
            break;
        case 4:
            o->kernel = EWA_KERNEL_RAYCAST;
            break;
        case 5:
            o->passes = 1;
            break;
        case 6:
            o->edge_antialiasing = false;
            break;
        case 7:
            o->eye_dome = 1;
            break;
        case 8:
            of.clips = true;
            break;
        case 9:
            of.how[2].weight = 0.3, of.how[4] = (ewa_render_source){0.7, false};
            break;
        case 10:
            o->point_size_px = 3;
            break;
        case 11:
            o->section_count = 1, o->section_planes[0][0] = 1, o->section_planes[0][3] = -0.05;
            break;
        default:
            break;
        }
        hold(&of);
    }
    ewa_context_destroy(&context);
}

static void test_bad_exchanges(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    ewa_renderer *renderer = NULL;
    const ewa_exchange nothing = {.rank_count = 1};
    assert_int_equal(ewa_renderer_create_joint(context, &nothing, &renderer), EWA_ERROR_ARGUMENT);
    assert_null(renderer);
    assert_int_equal(ewa_renderer_create_joint(context, NULL, &renderer), EWA_ERROR_ARGUMENT);
    ewa_context_destroy(&context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bytes_of_one_process),
        cmocka_unit_test(test_bad_exchanges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
