// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the test volumes: closed forms, line integrals, the same bytes again.
#include "io/scratch.h"

#include <math.h>

static void make(ewa_context *context, ewa_volume_object object, uint32_t x, uint32_t y, uint32_t z,
                 ewa_volume *volume) {
    WITH_DEFAULTS(ewa_volume_generate_options, options);
    options.object = object;
    options.dims[0] = x, options.dims[1] = y, options.dims[2] = z;
    options.size_world = 5;
    assert_int_equal(ewa_volume_generate(context, &options, volume), EWA_OK);
}

static void index_to_world(const ewa_volume *volume, const double index[3], double world[3]) {
    for (int k = 0; k < 3; k++) {
        const double *row = volume->index_to_world + 4 * k;
        world[k] = row[0] * index[0] + row[1] * index[1] + row[2] * index[2] + row[3];
    }
}

/// Sums along each column of z are the documented line integrals: for these smooth functions the trapezoidal
/// rule is exact to many digits.
TEST_ON(test_line_integrals, 0) {
    for (int kind = 0; kind < 2; kind++) {
        OWNED(ewa_volume_free) ewa_volume volume;
        make(context, kind ? EWA_VOLUME_BALL : EWA_VOLUME_BLOB, 65, 33, 129, &volume);
        assert_int_equal(volume.type, EWA_F32);
        const float *voxels = volume.voxels;
        double worst = 0;
        for (uint32_t j = 0; j < 33; j++)
            for (uint32_t i = 0; i < 65; i++) {
                double world[3], sum = 0;
                index_to_world(&volume, (const double[3]){i, j, 64}, world);
                for (uint32_t k = 0; k < 129; k++) sum += (double)voxels[(k * 33 + j) * 65 + i];
                sum *= 5.0 / 128;
                const double dd = world[0] * world[0] + world[1] * world[1], q = 0.5, r = 2;
                const double wanted = kind ? 16.0 / 15 * pow(fmax(r * r - dd, 0), 2.5) / (r * r * r * r)
                                           : q * sqrt(2 * 3.141592653589793) * exp(-dd / (2 * q * q));
                worst = fmax(worst, fabs(sum - wanted));
            }
        if (worst > (kind ? 2e-4 : 1e-6)) fail_msg("%s: off by %g", kind ? "ball" : "blob", worst);
    }
}

TEST_ON(test_checkerbox, 0) {
    OWNED(ewa_volume_free) ewa_volume volume;
    make(context, EWA_VOLUME_CHECKERBOX, 129, 129, 129, &volume);
    const uint8_t *voxels = volume.voxels;
    uint64_t counts[256] = {0};
    for (size_t i = 0; i < 129 * 129 * 129; i++) counts[voxels[i]]++;
    assert_int_equal(counts[0] + counts[96] + counts[255], 129 * 129 * 129);
    // 97 voxels along each edge of the box of 3/4 of the size.
    assert_int_equal(counts[96] + counts[255], 97 * 97 * 97);
    assert_int_equal(voxels[(16 * 129 + 16) * 129 + 15], 0);
    // Neighbouring cubes of 12 voxels take turns.
    for (int c = 0; c < 8; c++)
        assert_int_equal(voxels[(20 * 129 + 20) * 129 + 20 + 12 * c], c & 1 ? 96 : 255);
}

/// FNV-1a over the voxels.
static uint64_t hash(const ewa_volume *volume) {
    const size_t bytes =
        (size_t)volume->dims[0] * volume->dims[1] * volume->dims[2] * ewa_type_bytes(volume->type);
    uint64_t sum = 0xcbf29ce484222325u;
    for (size_t i = 0; i < bytes; i++) sum = (sum ^ ((const uint8_t *)volume->voxels)[i]) * 0x100000001b3u;
    return sum;
}

TEST(test_same_bytes) {
    uint64_t sums[4][2];
    for (uint32_t threads = 1; threads <= 2; threads++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(3 * threads - 2, NULL);
        for (int object = 0; object < 4; object++) {
            OWNED(ewa_volume_free) ewa_volume volume;
            make(context, (ewa_volume_object)object, 48, 40, 56, &volume);
            sums[object][threads - 1] = hash(&volume);
        }
    }
    for (int object = 0; object < 4; object++) assert_true(sums[object][0] == sums[object][1]);
}

/// The tree is thin, inside, of the documented brightness, and another one for another seed.
TEST_ON(test_vessels, 0) {
    WITH_DEFAULTS(ewa_volume_generate_options, options);
    options.object = EWA_VOLUME_VESSELS;
    uint64_t sums[2];
    for (uint64_t seed = 0; seed < 2; seed++) {
        OWNED(ewa_volume_free) ewa_volume volume;
        options.seed = seed;
        assert_int_equal(ewa_volume_generate(context, &options, &volume), EWA_OK);
        const uint8_t *voxels = volume.voxels;
        uint64_t occupied = 0, bright = 0, high = 0;
        for (size_t i = 0; i < 128 * 128 * 128; i++) {
            occupied += voxels[i] > 0;
            bright += voxels[i] > 250;
            high += voxels[i] > 0 && i > 96 * 128 * 128;
        }
        assert_true(occupied > 2000 && occupied < 40000);
        if (bright <= 50 || high <= 100)
            fail_msg("%llu bright, %llu high", (unsigned long long)bright, (unsigned long long)high);
        sums[seed] = hash(&volume);
    }
    assert_true(sums[0] != sums[1]);
}

/// The box of an outline.
static ewa_bounds outline_box(const ewa_volume *volume, const ewa_transfer *transfer, double reach_steps) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    ewa_bounds bounds;
    assert_int_equal(ewa_volume_outline(volume, transfer, reach_steps, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
    return bounds;
}

TEST_ON(test_outline, 1) {
    OWNED(ewa_volume_free) ewa_volume volume;
    assert_int_equal(ewa_volume_create(context, (const uint32_t[3]){20, 20, 20}, EWA_U8, &volume), EWA_OK);
    static const double place[12] = {0, -2, 0, 10, 1, 0, 0, 20, 0, 0, 3, 30};
    memcpy(volume.index_to_world, place, sizeof place);
    uint8_t *voxels = volume.voxels;
    for (int k = 5; k < 9; k++)
        for (int j = 2; j < 4; j++)
            for (int i = 7; i < 17; i++) voxels[400 * k + 20 * j + i] = 200;
    voxels[399] = voxels[398] = 200; // two that stray
    ewa_transfer transfer = {.point_count = 2};
    transfer.points[0] = (ewa_transfer_point){100, {1, 1, 1}, 0};
    transfer.points[1] = (ewa_transfer_point){255, {1, 1, 1}, 1};
    ewa_bounds bounds = outline_box(&volume, &transfer, 1.5);
    assert_int_equal(bounds.finite_count, 8 * 8); // eight corners for each of 4 x 2 rows
    // x is -2 j + 10, y is i + 20, z is 3 k + 30, each one and a half voxels wider.
    assert_true(bounds.low_world[0] == 10 - 2 * 4.5 && bounds.high_world[0] == 10 - 2 * 0.5);
    assert_true(bounds.low_world[1] == 20 + 5.5 && bounds.high_world[1] == 20 + 17.5);
    assert_true(bounds.low_world[2] == 30 + 3 * 3.5 && bounds.high_world[2] == 30 + 3 * 9.5);
    // Three together are no noise, however they are together.
    voxels[400 + 399 - 21] = 200;
    bounds = outline_box(&volume, &transfer, 0);
    assert_true(bounds.low_world[2] == 30 && bounds.finite_count == 8 * 10);
    // Faint matter counts when a line of sight would show it, here through 20 + 40 + 60 units of 1.
    transfer.points[1].extinction = 0.003f;
    for (int i = 0; i < 8000; i++) voxels[i] = voxels[i] ? 101 : 0;
    assert_int_equal(outline_box(&volume, &transfer, 0).finite_count, 8 * 10);
    transfer.points[1].extinction = 0.002f;
    assert_int_equal(outline_box(&volume, &transfer, 0).finite_count, 0);
    // Where there is nothing but single voxels they count.
    transfer.points[1].extinction = 1;
    memset(voxels, 0, 8000);
    assert_int_equal(outline_box(&volume, &transfer, 0).finite_count, 0);
    voxels[4321] = 200;
    assert_int_equal(outline_box(&volume, &transfer, 0).finite_count, 8);
    ewa_cloud *cloud;
    assert_int_equal(ewa_volume_outline(&volume, &transfer, -1, &cloud), EWA_ERROR_ARGUMENT);
}

TEST_ON(test_bad_options, 1) {
    ewa_volume volume;
    for (int i = 0; i < 7; i++) {
        WITH_DEFAULTS(ewa_volume_generate_options, options);
        ewa_status wanted = EWA_ERROR_ARGUMENT;
        if (i == 0) options.dims[1] = 1;
        if (i == 1) options.size_world = 0;
        if (i == 2) options.size_world = NAN;
        if (i == 3) options.checks = -1;
        if (i == 4) options.object = (ewa_volume_object)9;
        if (i == 5) options.struct_size--;
        if (i == 6) {
            options.dims[0] = options.dims[1] = options.dims[2] = 4000000000u;
            wanted = EWA_ERROR_LIMIT;
        }
        assert_int_equal(ewa_volume_generate(context, &options, &volume), wanted);
        assert_null(volume.voxels);
    }
}

static ewa_status generate_and_outline(ewa_context *context, void *user) {
    WITH_DEFAULTS(ewa_volume_generate_options, options);
    options.object = *(ewa_volume_object *)user;
    options.dims[0] = options.dims[1] = options.dims[2] = 8;
    OWNED(ewa_volume_free) ewa_volume volume;
    ewa_volume_facts facts;
    ewa_transfer transfer;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    ewa_status status = ewa_volume_generate(context, &options, &volume);
    if (status == EWA_OK) status = ewa_volume_measure(&volume, &facts);
    if (status == EWA_OK) status = ewa_transfer_automatic(&volume, &facts, &transfer);
    if (status == EWA_OK) status = ewa_volume_outline(&volume, &transfer, 1.8, &cloud);
    assert_true((status == EWA_OK) == (cloud != NULL));
    return status;
}

TEST(test_failing_allocations) {
    for (int object = 0; object < 4; object++) {
        ewa_volume_object chosen = (ewa_volume_object)object;
        scratch_fail_each(generate_and_outline, &chosen);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
