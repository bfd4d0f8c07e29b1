// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The frames of test joint by the ranks of an MPI job: run by mpirun. The first rank compares with what it draws alone.
#include "cluster/joint_frames.h"
#include "mpi/exchange.h"

#include <stdlib.h>

static mpi_exchange ranks;

static bool never(void) { return false; }

TEST_ON(test_bytes_of_one_process, 1) {
    const ewa_exchange exchange = mpi_exchange_of(&ranks);
    OWNED(ewa_renderer_destroy) ewa_renderer *joint = NULL, *alone = NULL;
    assert_int_equal(ewa_renderer_create_joint(context, &exchange, &joint), EWA_OK);
    assert_int_equal(ewa_renderer_create(context, &alone), EWA_OK);
    for (int i = 0; i < JOINT_FRAMES; i++) {
        joint_frame frame;
        joint_frame_make(context, i, &frame);
        picture found = picture_make(JOINT_WIDTH_PX, JOINT_HEIGHT_PX), expected;
        assert_int_equal(joint_frame_draw(context, joint, &frame, exchange.rank, exchange.rank_count, &found),
                         EWA_OK);
        if (exchange.rank == 0) {
            expected = picture_make(JOINT_WIDTH_PX, JOINT_HEIGHT_PX);
            assert_int_equal(joint_frame_draw(context, alone, &frame, 0, 1, &expected), EWA_OK);
            if (!joint_frame_same(&frame, &expected, &found))
                fail_msg("frame %d on %u ranks: other bytes", i, exchange.rank_count);
            picture_free(&expected);
        }
        picture_free(&found);
    }
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    mpi_exchange_open(&ranks, MPI_COMM_WORLD, 60, never);
    if (ranks.rank && !freopen("/dev/null", "w", stderr)) return EXIT_FAILURE;
    const int failed = RUN_TESTS(NULL, NULL);
    if (failed) MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    mpi_exchange_close(&ranks);
    MPI_Finalize();
    return failed;
}
