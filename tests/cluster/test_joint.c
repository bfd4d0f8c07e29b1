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
    size_t desk_bytes; ///< of each rank, where shares keep their splats
    picture found[RANKS_MOST];
    ewa_status status[RANKS_MOST];
} subject;

static void draw_as_rank(const ewa_exchange *exchange, void *data) {
    subject *of = data;
    const uint32_t rank = exchange->rank;
    ewa_context *context = check_context(1, NULL);
    ewa_renderer *renderer = NULL;
    of->status[rank] = ewa_renderer_create_joint(context, exchange, &renderer);
    void *state = NULL;
    ewa_renderer_backend(renderer, &context, &state);
    ((ewa_joint *)state)->desk_bytes = of->desk_bytes;
    if (of->status[rank] == EWA_OK)
        of->status[rank] =
            joint_frame_draw(context, renderer, &of->frame, rank, exchange->rank_count, &of->found[rank]);
    ewa_renderer_destroy(&renderer);
    ewa_context_destroy(&context);
}

static void hold(subject *of, int index) {
    ewa_context *context = check_context(2, NULL);
    ewa_renderer *renderer = NULL;
    picture expected = picture_make(JOINT_WIDTH_PX, JOINT_HEIGHT_PX);
    assert_int_equal(ewa_renderer_create(context, &renderer), EWA_OK);
    assert_int_equal(joint_frame_draw(context, renderer, &of->frame, 0, 1, &expected), EWA_OK);
    static const uint32_t counts[] = {1, 2, 3, 4, 7};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        for (uint32_t rank = 0; rank < counts[i]; rank++)
            of->found[rank] = picture_make(JOINT_WIDTH_PX, JOINT_HEIGHT_PX);
        of->desk_bytes = (size_t[]){0, EWA_JOINT_DESK_BYTES, 1 << 20}[i % 3];
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
    picture_free(&expected);
    ewa_renderer_destroy(&renderer);
    ewa_context_destroy(&context);
}

static void test_bytes_of_one_process(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    for (int i = 0; i < JOINT_FRAMES; i++) {
        subject of;
        joint_frame_make(context, i, &of.frame);
        hold(&of, i);
    }
    ewa_context_destroy(&context);
}

/// What a rank gathers and adds up.
static void gather_and_add(const ewa_exchange *exchange, void *data) {
    enum { COUNT = 11 };
    ewa_context *context = check_context(1, NULL);
    bool *right = data;
    uint32_t all[RANKS_MOST] = {0}, mine = 100 + exchange->rank;
    int64_t values[COUNT];
    for (int i = 0; i < COUNT; i++) values[i] = (int64_t)(exchange->rank + 1) * (i - 5);
    const bool done = ewa_exchange_gather(context, exchange, &mine, sizeof mine, all) == EWA_OK &&
                      ewa_exchange_add(context, exchange, values, COUNT) == EWA_OK;
    bool fine = done;
    const int64_t sum = (int64_t)exchange->rank_count * (exchange->rank_count + 1) / 2;
    for (uint32_t r = 0; r < exchange->rank_count; r++) fine = fine && all[r] == 100 + r;
    for (int i = 0; i < COUNT; i++) fine = fine && values[i] == sum * (i - 5);
    right[exchange->rank] = fine;
    ewa_context_destroy(&context);
}

static void test_gather_and_add(void **state) {
    (void)state;
    for (uint32_t count = 1; count <= RANKS_MOST; count++) {
        bool right[RANKS_MOST] = {false};
        ranks_run(count, 0, gather_and_add, right);
        for (uint32_t r = 0; r < count; r++) assert_true(right[r]);
    }
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
        cmocka_unit_test(test_gather_and_add),
        cmocka_unit_test(test_bad_exchanges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
