// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of sources that are spread over ranks is the frame of one process with all of them, byte for byte.
#include "cluster/joint.h"
#include "cluster/joint_frames.h"
#include "cluster/ranks.h"

#include <string.h>

typedef struct subject {
    joint_frame frame;
    size_t tile_cache_bytes; ///< of each rank, where shares keep their splats
    picture found[RANKS_MAX];
    ewa_status status[RANKS_MAX];
} subject;

static void draw_as_rank(const ewa_exchange *exchange, void *data) {
    subject *of = data;
    const uint32_t rank = exchange->rank;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    of->status[rank] = ewa_renderer_create_joint(context, exchange, &renderer);
    void *state = NULL;
    ewa_renderer_backend(renderer, &context, &state);
    ((ewa_joint *)state)->tile_cache_bytes = of->tile_cache_bytes;
    if (of->status[rank] == EWA_OK)
        of->status[rank] =
            joint_frame_draw(context, renderer, &of->frame, rank, exchange->rank_count, &of->found[rank]);
}

static void hold(subject *of, int index) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(picture_free) picture expected = picture_make(JOINT_WIDTH_PX, JOINT_HEIGHT_PX);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(joint_frame_draw(context, renderer, &of->frame, 0, 1, &expected), EWA_OK);
    static const uint32_t counts[] = {1, 2, 3, 4, 7};
    // Each frame on every second number of ranks, by turns of two frames, of which one has all planes.
    for (size_t i = (size_t)index / 2 % 2; i < sizeof counts / sizeof counts[0]; i += 2) {
        for (uint32_t rank = 0; rank < counts[i]; rank++)
            of->found[rank] = picture_make(JOINT_WIDTH_PX, JOINT_HEIGHT_PX);
        of->tile_cache_bytes = (size_t[]){0, EWA_JOINT_TILE_CACHE_BYTES, 1 << 20}[i % 3];
        // For one rank, or for all.
        const uint32_t picture_rank = i % 2 ? EWA_ALL_RANKS : counts[i] - 1;
        ranks_run(counts[i], picture_rank, draw_as_rank, of);
        for (uint32_t rank = 0; rank < counts[i]; rank++) {
            assert_int_equal(of->status[rank], EWA_OK);
            if ((i % 2 || rank == picture_rank) && !joint_frame_same(&of->frame, &expected, &of->found[rank]))
                fail_msg("frame %d on %u ranks: other bytes", index, counts[i]);
            picture_free(&of->found[rank]);
        }
    }
}

TEST_ON(test_bytes_of_one_process, 1) {
    for (int i = 0; i < JOINT_FRAMES; i++) {
        subject of;
        joint_frame_make(context, i, &of.frame);
        hold(&of, i);
    }
}

enum { MODEL_PX = 640 };

/// What docs/cluster.md says that a rank gives of a picture of one surface, of which all blocks of shared tiles have
/// something.
static double modelled_bytes(const ewa_joint *joint) {
    const ewa_joint_tiles *tiles = &joint->tiles;
    const uint32_t own = joint->exchange.rank;
    double bytes = 0;
    for (uint32_t tile = 0; tile < tiles->tile_count; tile++) {
        const ewa_tile_rect rect = ewa_tiles_rect(&joint->job.tiles, tile);
        const double pixels = (double)rect.width_px * rect.height_px;
        if (tiles->owners[tile] == own && own != joint->exchange.picture_rank) bytes += 4 * pixels;
        if (tiles->busy_counts[tile] < 2) continue;
        bytes += tiles->owners[tile] == own ? 4 * (tiles->busy_counts[tile] - 1) * pixels
                                            : (4 + 4 * joint->job.channel_count) * pixels;
    }
    return bytes;
}

/// Draws one plane, seen from above, which both ranks have; says how many bytes this took, of those of the model.
static void give_plane(const ewa_exchange *exchange, void *data) {
    double *shares = data;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    WITH_DEFAULTS(ewa_generate_options, plane);
    plane.object = EWA_OBJECT_PLANE;
    plane.point_count = 40000;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = NULL;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    WITH_DEFAULTS(ewa_render_options, options);
    options.edge_layers = 1;
    ewa_camera camera = check_camera(MODEL_PX, MODEL_PX);
    OWNED(picture_free) picture into = picture_make(MODEL_PX, MODEL_PX);
    const ewa_frame frame = {.rgba8 = into.frame.rgba8};
    ewa_bounds box;
    void *state = NULL;
    bool done =
        ewa_cloud_generate(context, &plane, &cloud) == EWA_OK && ewa_cloud_measure(cloud, &box) == EWA_OK &&
        ewa_surfels_create(cloud, NULL, &surfels) == EWA_OK && ewa_camera_set_fov(&camera, 30) == EWA_OK &&
        ewa_camera_frame(&camera, &box, (double[3]){0, 0, -1}, (double[3]){0, 1, 0}, 0) == EWA_OK &&
        ewa_renderer_create_joint(context, exchange, &renderer) == EWA_OK &&
        ewa_render(renderer, surfels, &camera, &options, &frame, NULL) == EWA_OK;
    if (done) ewa_renderer_backend(renderer, &context, &state);
    shares[exchange->rank] = done ? (double)ranks_given_bytes(exchange) / modelled_bytes(state) : -1;
}

TEST(test_bytes_of_the_model) {
    for (uint32_t count = 2; count <= 4; count++) {
        double shares[RANKS_MAX] = {0};
        ranks_run(count, 0, give_plane, shares);
        for (uint32_t r = 0; r < count; r++) {
            print_message("rank %u of %u: %.3f of the model\n", r, count, shares[r]);
            assert_true(shares[r] > 0.97 && shares[r] < 1.03);
        }
    }
}

/// What a rank gathers and adds up.
static void gather_and_add(const ewa_exchange *exchange, void *data) {
    enum { COUNT = 11 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    bool *right = data;
    uint32_t all[RANKS_MAX] = {0}, mine = 100 + exchange->rank;
    int64_t values[COUNT];
    for (int i = 0; i < COUNT; i++) values[i] = (int64_t)(exchange->rank + 1) * (i - 5);
    const bool done = ewa_exchange_gather(context, exchange, &mine, sizeof mine, all) == EWA_OK &&
                      ewa_exchange_add(context, exchange, values, COUNT) == EWA_OK;
    bool fine = done;
    const int64_t sum = (int64_t)exchange->rank_count * (exchange->rank_count + 1) / 2;
    for (uint32_t r = 0; r < exchange->rank_count; r++) fine = fine && all[r] == 100 + r;
    for (int i = 0; i < COUNT; i++) fine = fine && values[i] == sum * (i - 5);
    right[exchange->rank] = fine;
}

TEST(test_gather_and_add) {
    for (uint32_t count = 1; count <= RANKS_MAX; count++) {
        bool right[RANKS_MAX] = {false};
        ranks_run(count, 0, gather_and_add, right);
        for (uint32_t r = 0; r < count; r++) assert_true(right[r]);
    }
}

TEST_ON(test_bad_exchanges, 1) {
    ewa_renderer *renderer = NULL;
    const ewa_exchange nothing = {.rank_count = 1};
    assert_int_equal(ewa_renderer_create_joint(context, &nothing, &renderer), EWA_ERROR_ARGUMENT);
    assert_null(renderer);
    assert_int_equal(ewa_renderer_create_joint(context, NULL, &renderer), EWA_ERROR_ARGUMENT);
    int64_t value = 1, all = 0;
    assert_int_equal(ewa_exchange_gather(context, NULL, &value, sizeof value, &all), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_exchange_gather(context, &nothing, &value, sizeof value, &all), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_exchange_add(context, NULL, &value, 1), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_exchange_add(context, &nothing, &value, 1), EWA_ERROR_ARGUMENT);
    assert_true(value == 1 && all == 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
