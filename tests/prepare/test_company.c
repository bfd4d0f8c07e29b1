// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a place gives by many neighbours does not depend on which others fill the lanes of its batch: workers fill them
// as they come, so whatever did would make surfels differ from run to run.
#include "base/base.h"
#include "estimate/local.h"
#include "prepare/check_prepare.h"

enum { PLACES = 200, BLOCKS = 40, NEAREST = 24 };

/// All that the kernels tell of a batch.
typedef struct told {
    float around[EWA_BLOCK_LANES], farthest2[EWA_BLOCK_LANES];
    local_surface surface;
    local_border border;
    uint32_t ends; // bits of the lanes at whose end the surface is
} told;

/// The surface ends along y; places are random, or in rows, the outermost of which are lanes.
static void make_block(int number, ewa_block *block) {
    check_random random = {(uint64_t)number + 1};
    const bool rows = number % 2;
    memset(block, 0, sizeof *block);
    block->candidate_count = PLACES, block->lane_count = EWA_BLOCK_LANES;
    block->unit_world = 1;
    for (int i = 0; i < PLACES; i++) {
        const double column = i % 20, row = i / 20;
        block->x[i] = (float)(rows ? -0.1 * row : check_uniform(&random, i < EWA_BLOCK_LANES ? -0.03 : -1, 0));
        block->y[i] = (float)(rows ? 0.1 * column - 1 : check_uniform(&random, -1, 1));
        block->z[i] = (float)check_uniform(&random, -1e-3, 1e-3);
        block->place[i] = (uint32_t)i;
    }
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) {
        float sorted[PLACES];
        block->lane_x[lane] = block->x[lane], block->lane_y[lane] = block->y[lane];
        block->lane_z[lane] = block->z[lane];
        for (uint32_t i = 0; i < PLACES; i++) {
            const float x = block->x[i] - block->x[lane], y = block->y[i] - block->y[lane],
                        z = block->z[i] - block->z[lane], distance2 = x * x + y * y + z * z;
            block->distance2[i][lane] = distance2;
            uint32_t to = i;
            for (; to > 0 && sorted[to - 1] > distance2; to--) sorted[to] = sorted[to - 1];
            sorted[to] = distance2;
        }
        block->radius2[lane] = sorted[NEAREST + 8 * lane];
    }
}

/// As the estimate goes through a batch.
static void measure_all(const local_kernels *kernels, local_batch *batch, told *t) {
    memset(t, 0, sizeof *t);
    local_sizes sizes;
    kernels->median(batch, t->around, t->farthest2);
    float limit[EWA_BLOCK_LANES];
    for (int lane = 0; lane < EWA_BLOCK_LANES; lane++) {
        sizes.around[lane] = t->around[lane], sizes.farthest[lane] = sqrtf(t->farthest2[lane]);
        limit[lane] = sizes.limit[lane] = 1.6f * t->around[lane];
        sizes.radius[lane] = 1.4f * t->around[lane];
        sizes.beyond[lane] = batch->place[lane] % 2 ? 0.5f : 0;
    }
    kernels->enclose(batch, LOCAL_REACH | LOCAL_SHAPE, NULL, limit, &t->surface);
    t->ends = kernels->border(batch, &t->surface, &sizes, &t->border);
}

static void hold_lane(const told *all, uint32_t lane, const told *alone) {
    assert_true(all->around[lane] == alone->around[0] && all->farthest2[lane] == alone->farthest2[0]);
    const local_surface *a = &all->surface, *b = &alone->surface;
    for (int c = 0; c < 3; c++)
        assert_true(a->normal[c][lane] == b->normal[c][0] && a->major[c][lane] == b->major[c][0]);
    assert_true(a->aspect[lane] == b->aspect[0] && a->spacing[lane] == b->spacing[0]);
    assert_true(a->reach[lane] == b->reach[0] && a->ellipse_reach[lane] == b->ellipse_reach[0]);
    assert_true(a->variation[lane] == b->variation[0] && a->lean[lane] == b->lean[0]);
    assert_true((a->thin >> lane & 1) == (b->thin & 1) && (a->degenerate >> lane & 1) == (b->degenerate & 1));
    assert_true((all->ends >> lane & 1) == (alone->ends & 1));
    if (!(alone->ends & 1)) return;
    assert_true(all->border.distance[lane] == alone->border.distance[0]);
    for (int c = 0; c < 3; c++) assert_true(all->border.direction[c][lane] == alone->border.direction[c][0]);
}

TEST(test_company) {
    static const uint32_t masks[] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    static ewa_block block;
    static local_batch batch;
    static float values[PLACES];
    for (int i = 0; i < PLACES; i++) values[i] = 0.1f + 1e-4f * (float)i;
    for (int k = 0; k < 3; k++) {
        const local_kernels *kernels = EWA_CHOOSE(masks[k] & ewa_cpu_detect(), ewa_local_kernels);
        int ends = 0;
        for (int i = 0; i < BLOCKS; i++) {
            make_block(i, &block);
            told all, alone;
            batch.lane_count = 0;
            assert_int_equal(kernels->collect(&block, 0xffff, values, &batch), 0);
            measure_all(kernels, &batch, &all);
            for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) {
                batch.lane_count = 0;
                assert_int_equal(kernels->collect(&block, 1u << lane, values, &batch), 0);
                measure_all(kernels, &batch, &alone);
                hold_lane(&all, lane, &alone);
                ends += alone.ends & 1;
            }
        }
        print_message("%d ends of %d\n", ends, BLOCKS * EWA_BLOCK_LANES);
        assert_true(ends > BLOCKS * EWA_BLOCK_LANES / 4);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
