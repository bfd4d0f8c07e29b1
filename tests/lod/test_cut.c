// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The cut through an octree: weights that are one together wherever one goes down, and who says what is in front.
#include "lod/cut.h"
#include "lod_scene.h"
#include "surface/levels.h"
#include "surface/render.h"

#include <math.h>

enum { POINTS = 300000, SIDE_PX = 240, BYTES = 4 * SIDE_PX * SIDE_PX };

static const char file[] = "ground.copc.laz";

static int enter(void **state) {
    lod_build_ground(POINTS, file);
    return 0;
}

static int leave(void **state) {
    lod_clear();
    return 0;
}

/// From low above the ground, so that nodes of many levels are in one picture.
static ewa_camera camera_at(double distance) {
    ewa_camera camera = check_camera(SIDE_PX, SIDE_PX);
    const double eye[3] = {0, -distance, 0.3 * distance}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
    return camera;
}

/// Weights of a node's items, and how many there are.
static double weight_of(const ewa_cut *cut, uint32_t node, uint32_t *count) {
    double weight = 0;
    for (uint32_t i = 0; i < cut->item_count; i++)
        if (cut->items[i].node == node) weight += cut->items[i].weight, (*count)++;
    return weight;
}

/// Goes down to what is drawn last: there all weights on the way are one. Returns how many items are there and below.
static uint32_t hold_weights(const ewa_cut *cut, uint32_t index, double above) {
    const ewa_lod_node *node = &cut->lod->nodes[index];
    uint32_t own = 0, below = 0;
    const double sum = above + weight_of(cut, index, &own);
    for (int i = 0; i < 8; i++)
        if (node->children[i] != EWA_NO_NODE) below += hold_weights(cut, node->children[i], sum);
    if (own && !below) assert_true(fabs(sum - 1) < 1e-12);
    for (uint32_t i = 0; i < cut->item_count; i++)
        if (cut->items[i].node == index && cut->items[i].level == 0) assert_int_equal(cut->items[i].hides, below == 0);
    return own + below;
}

/// The picture of a cut, put together here.
static void draw_cut(const ewa_cut *cut, ewa_renderer *renderer, const ewa_render_options *options, uint8_t *rgba8) {
    const ewa_frame frame = {.rgba8 = rgba8};
    assert_int_equal(ewa_render_begin(renderer, cut->camera, options, &frame), EWA_OK);
    for (uint32_t i = 0; i < cut->item_count; i++) {
        uint32_t level = cut->items[i].level;
        const ewa_surfels *surfels = ewa_levels_find(cut->items[i].lod->nodes[cut->items[i].node].surfels, &level);
        const ewa_render_source how = {cut->items[i].weight, cut->items[i].hides};
        assert_int_equal(ewa_render_add_source(renderer, surfels, &how), EWA_OK);
    }
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
}

TEST_ON(what_gives_way_hides_nothing, 2) {
    char path[512];
    OWNED(ewa_lod_close) ewa_lod *lod = NULL;
    assert_int_equal(ewa_lod_open(context, scratch_path(file, path), &lod), EWA_OK);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    OWNED(check_free) uint8_t *made = malloc(BYTES), *expected = malloc(BYTES);
    WITH_DEFAULTS(ewa_render_options, options);
    WITH_DEFAULTS(ewa_lod_options, chosen);
    options.supersampling = 1, chosen.error = 8, chosen.max_splats = POINTS, chosen.memory_bytes = 1 << 30;
    const ewa_lod_scene scene = {.lods = &lod, .lod_count = 1};
    uint32_t giving_way = 0, pictures_that_tell = 0;
    for (int i = 0; i < 50; i++) {
        const ewa_camera camera = camera_at(2.2 * pow(1.012, i));
        const ewa_frame frame = {.rgba8 = made};
        assert_int_equal(ewa_lod_render(lod, renderer, &camera, &options, &chosen, &frame, NULL), EWA_OK);
        ewa_cut cut;
        assert_int_equal(ewa_cut_begin(&cut, &scene, &camera, &options, &chosen), EWA_OK);
        assert_int_equal(ewa_cut_choose(&cut, false), EWA_OK);
        assert_int_equal(hold_weights(&cut, 0, 0), cut.item_count);
        for (uint32_t k = 0; k < cut.item_count; k++) giving_way += !cut.items[k].hides;
        draw_cut(&cut, renderer, &options, expected);
        assert_memory_equal(made, expected, BYTES);
        for (uint32_t k = 0; k < cut.item_count; k++) cut.items[k].hides = true;
        draw_cut(&cut, renderer, &options, expected);
        pictures_that_tell += memcmp(made, expected, BYTES) != 0;
    }
    print_message("%u items give way, in %u pictures it is seen\n", giving_way, pictures_that_tell);
    assert_true(giving_way >= 8 && pictures_that_tell >= 4);
}

// ---- What choosing takes

enum { DEPTH = 8, MAX_NODES = 87381 }; // (4^9 - 1) / 3

/// Makes the node that covers a square of a ground of side 2, and those below it.
static uint32_t add_square(ewa_lod *lod, double x, double y, double side, int depth) {
    const uint32_t index = lod->node_count++;
    ewa_lod_node *node = &lod->nodes[index];
    *node = (ewa_lod_node){.divided = depth < DEPTH,
                           .box_low_world = {x, y, -side / 8},
                           .box_high_world = {x + side, y + side, side / 8},
                           .spacing_world = side / 128,
                           .largest_radius_world = side / 64,
                           .error = 2,
                           .count = 16384};
    for (int i = 0; i < 8; i++) node->children[i] = EWA_NO_NODE;
    for (int i = 0; i < 4 && depth < DEPTH; i++) {
        const uint32_t child = add_square(lod, x + side / 2 * (i & 1), y + side / 2 * (i >> 1), side / 2, depth + 1);
        lod->nodes[index].children[i] = child;
    }
    return index;
}

/// Choosing looks at the nodes of the cut and those above them. Where the cut has to be made coarser, for a bound of surfels, it looks
/// at those of the finest cut once, and counts them 26 times. Whatever lies below that, or in files, costs nothing.
TEST_ON(choice_goes_by_the_cut, 1) {
    OWNED(check_free) ewa_lod_node *nodes = malloc(MAX_NODES * sizeof *nodes);
    assert_non_null(nodes);
    ewa_lod lod = {.context = context, .nodes = nodes, .stretch = 1};
    for (int i = 0; i < 4; i++) lod.appearance.to_world[5 * i] = 1;
    lod.appearance.radius_scale = 1;
    add_square(&lod, -1, -1, 2, 0);
    assert_int_equal(lod.node_count, MAX_NODES);
    ewa_lod *const lods[] = {&lod};
    const ewa_lod_scene scene = {.lods = lods, .lod_count = 1};
    const ewa_camera camera = camera_at(3);
    WITH_DEFAULTS(ewa_render_options, options);
    options.supersampling = 1;
    static const double spacings_px[] = {1.0 / 2, 1.0 / 32, 1.0 / 512, 1.0 / 512};
    uint32_t counts[4];
    double took_s[4];
    for (int k = 0; k < 4; k++) {
        WITH_DEFAULTS(ewa_lod_options, chosen);
        chosen.spacing_px = spacings_px[k], chosen.error = 255, chosen.max_splats = (uint64_t)1 << 40;
        if (k == 3) chosen.max_splats = 1 << 28;
        ewa_cut cut;
        double least_s = INFINITY;
        for (int run = 0; run < 5; run++) {
            const double start_s = ewa_now_s();
            assert_int_equal(ewa_cut_begin(&cut, &scene, &camera, &options, &chosen), EWA_OK);
            assert_int_equal(ewa_cut_choose(&cut, false), EWA_OK);
            least_s = fmin(least_s, ewa_now_s() - start_s);
        }
        counts[k] = cut.item_count, took_s[k] = least_s;
        print_message("%u nodes, coarser by %.3g: %.3f ms, %.3f us each\n", counts[k], cut.coarser, 1e3 * least_s,
                      1e6 * least_s / counts[k]);
        assert_true((cut.coarser > 1) == (k == 3));
    }
    assert_true(counts[0] < 1000 && counts[1] > 1000 && counts[2] > 50000);
    // By the node it takes as long in large cuts as in small ones, within what a busy machine does.
    assert_true(took_s[2] / counts[2] < 20 * took_s[1] / counts[1]);
    ewa_buffer_free(context, &lod.items);
    ewa_buffer_free(context, &lod.cover);
    ewa_buffer_free(context, &lod.measured);
}

int main(void) { return RUN_TESTS(enter, leave); }
