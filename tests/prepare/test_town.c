// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the generated town: what it consists of, where its points lie, that walls are closed, the same bytes for
// every number of threads and on every machine, failing allocations.
#include "generate/generate.h"
#include "prepare/check_generated.h"
#include "prepare/check_prepare.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { POINTS = 200000, SIZE_WORLD = 2 };

static ewa_generate_options town_options(uint64_t point_count) {
    return check_generate_options(EWA_OBJECT_TOWN, point_count);
}

TEST_ON(test_counts_and_unit_normals, 2) {
    static const uint64_t counts[] = {0, 1, 2, 3, 64, 1000, 54321};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        const ewa_generate_options options = town_options(counts[c]);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
        assert_int_equal(ewa_cloud_point_count(cloud), counts[c]);
        assert_int_equal(ewa_cloud_attribute_count(cloud), 4);
        const float *position = check_stream(cloud, EWA_POSITION), *normal = check_stream(cloud, EWA_NORMAL);
        const float *radius = check_stream(cloud, EWA_RADIUS);
        for (uint64_t i = 0; i < counts[c]; i++) {
            double length2 = 0;
            for (int k = 0; k < 3; k++) {
                assert_true(fabsf(position[3 * i + k]) <= 1);
                length2 += (double)normal[3 * i + k] * normal[3 * i + k];
            }
            assert_true(position[3 * i + 2] >= 0);
            assert_true(fabs(length2 - 1) < 1e-5);
            assert_true(radius[i] > 0);
        }
    }
}

TEST(test_there_are_160_boxes_and_1400_trees) {
    OWNED(check_free) ewa_town_patch *patches = calloc(EWA_TOWN_PATCHES, sizeof *patches);
    const double area = ewa_town_make(1, patches);
    uint32_t counts[EWA_TOWN_SCATTER + 1] = {0};
    double sum = 0;
    for (uint32_t p = 0; p < EWA_TOWN_PATCHES; p++) {
        counts[patches[p].kind]++;
        sum += patches[p].area;
        assert_true(patches[p].area > 0 && patches[p].height > 0);
    }
    assert_true(fabs(sum - area) < 1e-12 * area);
    assert_int_equal(counts[EWA_TOWN_GROUND], 1);
    assert_int_equal(counts[EWA_TOWN_ROOF], 160);
    assert_int_equal(counts[EWA_TOWN_WALL], 4 * 160);
    assert_int_equal(counts[EWA_TOWN_CROWN], 1400);
    assert_int_equal(counts[EWA_TOWN_TRUNK], 1400);
}

/// Whether a point lies on a rectangle, but for rounding.
static bool is_on(const ewa_town_patch *patch, const double p[3], const float *normal) {
    for (int c = 0; c < 3; c++) {
        const double low = patch->corner[c] - 1e-6, high = patch->corner[c] + patch->along[c] + patch->across[c] + 1e-6;
        if (p[c] < low || p[c] > high || fabs(patch->normal[c] - (double)normal[c]) > 1e-6) return false;
    }
    return true;
}

/// Points of walls, roofs and ground lie on them, one of each patch after another, as many as their areas say.
TEST_ON(test_points_lie_on_their_patches, 2) {
    OWNED(check_free) ewa_town_patch *patches = calloc(EWA_TOWN_PATCHES, sizeof *patches);
    const ewa_generate_options options = town_options(POINTS);
    const double area = ewa_town_make(options.seed, patches);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
    const float *position = check_stream(cloud, EWA_POSITION), *normal = check_stream(cloud, EWA_NORMAL);
    double below = 0;
    for (uint32_t p = 0; p < EWA_TOWN_PATCHES; p++) {
        const uint64_t first = (uint64_t)(POINTS * (below / area) + 0.5);
        below += patches[p].area;
        const uint64_t end = p + 1 == EWA_TOWN_PATCHES ? POINTS : (uint64_t)(POINTS * (below / area) + 0.5);
        for (uint64_t i = first; i < end; i++) {
            double at[3], from_middle = 0;
            for (int c = 0; c < 3; c++) {
                at[c] = (double)position[3 * i + c] / SIZE_WORLD;
                const double off = (at[c] - patches[p].corner[c]) / fmax(patches[p].along[c], 1e-9);
                from_middle += off * off;
            }
            if (patches[p].kind <= EWA_TOWN_ROOF) assert_true(is_on(&patches[p], at, &normal[3 * i]));
            if (patches[p].kind == EWA_TOWN_CROWN) assert_true(from_middle > 0.249 && from_middle < 1.001);
            if (patches[p].kind == EWA_TOWN_SCATTER) assert_true(at[2] < 0.01);
        }
    }
}

/// The boxes stand apart, so that no wall lies in another box.
TEST(test_boxes_stand_apart) {
    for (uint64_t seed = 0; seed < 5; seed++) {
        OWNED(check_free) ewa_town_patch *patches = calloc(EWA_TOWN_PATCHES, sizeof *patches);
        ewa_town_make(seed, patches);
        for (uint32_t a = 0; a < EWA_TOWN_PATCHES; a++) {
            if (patches[a].kind != EWA_TOWN_ROOF) continue;
            for (uint32_t b = a + 1; b < EWA_TOWN_PATCHES; b++) {
                if (patches[b].kind != EWA_TOWN_ROOF) continue;
                const double *low[2] = {patches[a].corner, patches[b].corner};
                const double width[2] = {patches[a].along[0], patches[b].along[0]};
                const double depth[2] = {patches[a].across[1], patches[b].across[1]};
                const bool apart = low[0][0] + width[0] < low[1][0] || low[1][0] + width[1] < low[0][0] ||
                                   low[0][1] + depth[0] < low[1][1] || low[1][1] + depth[1] < low[0][1];
                assert_true(apart);
            }
        }
    }
}

/// Every place of the walls, roofs and the ground is within the disc of some point of them.
TEST_ON(test_discs_close_the_walls, 2) {
    enum { PROBES = 300 };
    OWNED(check_free) ewa_town_patch *patches = calloc(EWA_TOWN_PATCHES, sizeof *patches);
    const ewa_generate_options options = town_options(POINTS);
    ewa_town_make(options.seed, patches);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
    const float *position = check_stream(cloud, EWA_POSITION), *normal = check_stream(cloud, EWA_NORMAL);
    const float *radius = check_stream(cloud, EWA_RADIUS);
    check_random random = {5};
    for (uint32_t probe = 0; probe < PROBES; probe++) {
        const ewa_town_patch *patch = &patches[(uint32_t)check_uniform(&random, 0, 1 + 160 * 5)];
        const double u = check_uniform(&random, 0, 1), v = check_uniform(&random, 0, 1);
        bool covered = false;
        for (uint64_t i = 0; i < POINTS && !covered; i++) {
            double distance2 = 0, facing = 0;
            for (int c = 0; c < 3; c++) {
                const double place = patch->corner[c] + u * patch->along[c] + v * patch->across[c];
                const double off = SIZE_WORLD * place - (double)position[3 * i + c];
                distance2 += off * off, facing += patch->normal[c] * (double)normal[3 * i + c];
            }
            covered = distance2 < (double)radius[i] * radius[i] && facing > 0.999;
        }
        assert_true(covered);
    }
}

/// Bytes are a promise, as those of other objects (test generate).
TEST(test_bytes_are_known_for_every_thread_count) {
    static const uint32_t threads[] = {1, 2, 7, 32};
    static const uint64_t known = 0x2a9e5caed89e7b5eu;
    for (size_t t = 0; t < sizeof threads / sizeof threads[0]; t++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[t], NULL);
        ewa_generate_options options = town_options(54321);
        options.seed = 42;
        options.radius_scale = 1.14;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
        const uint64_t hash = check_cloud_hash(cloud);
        ewa_cloud_destroy(&cloud);
        if (hash != known) print_error("%u threads: 0x%016llx\n", threads[t], (unsigned long long)hash);
        assert_true(hash == known);
        options.seed = 43;
        cloud = check_generated(context, &options);
        assert_true(check_cloud_hash(cloud) != known);
    }
}

TEST_LOGGED(test_positions_alone_and_a_picture_upon_it, 0) {
    ewa_generate_options options = town_options(1000);
    options.positions_only = true;
    ewa_cloud *cloud = check_generated(context, &options);
    assert_int_equal(ewa_cloud_attribute_count(cloud), 2);
    assert_null(ewa_cloud_find(cloud, EWA_NORMAL));
    ewa_cloud_destroy(&cloud);
    options.positions_only = false, options.texcoords = true;
    cloud = check_generated(context, &options);
    const float *position = check_stream(cloud, EWA_POSITION), *texcoord = check_stream(cloud, EWA_TEXCOORD);
    for (int i = 0; i < 1000; i++)
        for (int c = 0; c < 2; c++) assert_true(fabsf(2 * texcoord[2 * i + c] - 1 - position[3 * i + c]) < 1e-6f);
    ewa_cloud_destroy(&cloud);
    options.sharp = true;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_ERROR_ARGUMENT);
    assert_null(cloud);
}

TEST(test_every_failing_allocation) {
    const ewa_generate_options options = town_options(1000);
    check_generate_without_memory(&options);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
