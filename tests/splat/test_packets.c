// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/surface/packets.c, discs.c and the packing kernels: every way from a cloud to packets gives
// the same surfels, and bounds hold what they are around.
#include "check.h"
#include "surface/packets.h"
#include "surface/surfel.h"

#include <math.h>
#include <string.h>

enum { POINTS = 16 * 300 + 7, SPOILT_STEP = 97 };

/// The numbers of a cloud of discs, some of which cannot be drawn.
typedef struct numbers {
    float position[POINTS][3], normal[POINTS][3], radius[POINTS];
    uint8_t color[POINTS][3];
    uint64_t spoilt_count;
} numbers;

static void make_numbers(numbers *made) {
    check_random random = {7};
    made->spoilt_count = 0;
    for (int i = 0; i < POINTS; i++) {
        for (int c = 0; c < 3; c++) {
            made->position[i][c] = (float)check_uniform(&random, -3, 5);
            made->normal[i][c] = (float)(check_uniform(&random, -1, 1) * pow(10, i % 61 - 30));
            made->color[i][c] = (uint8_t)check_random_u64(&random);
        }
        made->radius[i] = (float)check_uniform(&random, 0.001, 0.2);
        if (i % 5 == 0) made->normal[i][i % 3] = 0;
        if (i % SPOILT_STEP) continue;
        made->spoilt_count++;
        switch (i / SPOILT_STEP % 6) {
        case 0:
            made->position[i][1] = NAN;
            break;
        case 1:
            made->position[i][2] = -INFINITY;
            break;
        case 2:
            memset(made->normal[i], 0, sizeof made->normal[i]);
            break;
        case 3:
            made->normal[i][0] = -INFINITY;
            break;
        case 4:
            made->radius[i] = 0;
            break;
        case 5:
            made->radius[i] = NAN;
            break;
        }
    }
}

static void borrow(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t components, const void *data,
                   size_t stride_bytes) {
    assert_int_equal(ewa_cloud_borrow(cloud, name, type, components, data, stride_bytes), EWA_OK);
}

static ewa_surfels *make_surfels(ewa_cloud *cloud) {
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    return surfels;
}

/// Surfels of float streams that lie side by side.
static ewa_surfels *surfels_of(ewa_context *context, const numbers *of) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, POINTS);
    borrow(cloud, EWA_POSITION, EWA_F32, 3, of->position, 0);
    borrow(cloud, EWA_NORMAL, EWA_F32, 3, of->normal, 0);
    borrow(cloud, EWA_RADIUS, EWA_F32, 1, of->radius, 0);
    borrow(cloud, EWA_COLOR, EWA_U8, 3, of->color, 0);
    ewa_surfels *surfels = make_surfels(cloud);
    return surfels;
}

static void assert_same_packets(const ewa_surfels *a, const ewa_surfels *b) {
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->left_out_count, b->left_out_count);
    assert_int_equal(a->packet_count, b->packet_count);
    assert_true(a->unit == b->unit);
    assert_memory_equal(a->origin_world, b->origin_world, sizeof a->origin_world);
    assert_memory_equal(a->packets, b->packets, a->packet_count * sizeof *a->packets);
    assert_memory_equal(a->bounds_memory, b->bounds_memory, a->bounds_stride * EWA_BOUNDS_BYTES);
}

TEST(test_same_bytes_from_all_kernels) {
    static numbers of;
    make_numbers(&of);
    OWNED(ewa_context_destroy) ewa_context *plain = check_context_of(1, 0);
    OWNED(ewa_surfels_destroy) ewa_surfels *expected = surfels_of(plain, &of);
    assert_int_equal(expected->left_out_count, of.spoilt_count);
    static const uint32_t masks[] = {EWA_CPU_AVX2, EWA_CPU_ALL};
    for (int i = 0; i < 2; i++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(3, masks[i]);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(context, &of);
        assert_same_packets(expected, surfels);
    }
}

/// Records of all numbers side by side, and positions in double precision: the same packets.
TEST(test_same_bytes_from_all_layouts) {
    static numbers of;
    static struct {
        double position[3];
        float normal[3], radius;
        uint8_t color[3], pad[5];
    } records[POINTS];
    make_numbers(&of);
    for (int i = 0; i < POINTS; i++) {
        for (int c = 0; c < 3; c++) records[i].position[c] = (double)of.position[i][c];
        memcpy(records[i].normal, of.normal[i], sizeof records[i].normal);
        memcpy(records[i].color, of.color[i], sizeof records[i].color);
        records[i].radius = of.radius[i];
    }
    OWNED(ewa_context_destroy) ewa_context *context = check_context_of(2, EWA_CPU_ALL);
    OWNED(ewa_surfels_destroy) ewa_surfels *expected = surfels_of(context, &of);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, POINTS);
    borrow(cloud, EWA_POSITION, EWA_F64, 3, records[0].position, sizeof records[0]);
    borrow(cloud, EWA_NORMAL, EWA_F32, 3, records[0].normal, sizeof records[0]);
    borrow(cloud, EWA_RADIUS, EWA_F32, 1, &records[0].radius, sizeof records[0]);
    borrow(cloud, EWA_COLOR, EWA_U8, 3, records[0].color, sizeof records[0]);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(cloud);
    assert_same_packets(expected, surfels);
}

/// Discs by the vectorised path and surfel by surfel, which normals in double precision ask for: as equal as
/// their codes are.
TEST(test_discs_equal_surfels) {
    static numbers of;
    static double normal[POINTS][3];
    make_numbers(&of);
    for (int i = 0; i < POINTS; i++)
        for (int c = 0; c < 3; c++) normal[i][c] = (double)of.normal[i][c];
    OWNED(ewa_context_destroy) ewa_context *context = check_context_of(2, EWA_CPU_ALL);
    OWNED(ewa_surfels_destroy) ewa_surfels *discs = surfels_of(context, &of);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, POINTS);
    borrow(cloud, EWA_POSITION, EWA_F32, 3, of.position, 0);
    borrow(cloud, EWA_NORMAL, EWA_F64, 3, normal, 0);
    borrow(cloud, EWA_RADIUS, EWA_F32, 1, of.radius, 0);
    borrow(cloud, EWA_COLOR, EWA_U8, 3, of.color, 0);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(cloud);
    assert_int_equal(surfels->count, POINTS - of.spoilt_count);
    assert_int_equal(discs->count, surfels->count);
    for (uint32_t i = 0; i < discs->count; i++) {
        ewa_packet_surfel a, b;
        ewa_packet_decode(discs, (uint32_t)(i / 16), i % 16, &a);
        ewa_packet_decode(surfels, (uint32_t)(i / 16), i % 16, &b);
        assert_memory_equal(&a.offset, &b.offset, sizeof a.offset);
        assert_memory_equal(a.color, b.color, sizeof a.color);
        assert_true(vec3_dot(a.normal, b.normal) > 1 - 1e-8);
        const double sigma = vec3_length(b.axis_u);
        assert_true(fabs(vec3_length(a.axis_u) - sigma) <= 1e-6 * sigma);
        assert_true(fabs(vec3_length(a.axis_v) - sigma) <= 1e-6 * sigma);
    }
}

/// The code of a normal is the nearest one, or nearly.
TEST(test_normals_are_kept) {
    check_random random = {3};
    OWNED(ewa_context_destroy) ewa_context *context = check_context_of(1, EWA_CPU_ALL);
    for (int turn = 0; turn < 2000; turn++) {
        float position[3] = {1, 2, 3}, normal[3], radius = 1;
        for (int c = 0; c < 3; c++) normal[c] = (float)check_uniform(&random, -1, 1);
        if (turn % 3 == 0) normal[turn % 9 / 3] = 0;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1);
        borrow(cloud, EWA_POSITION, EWA_F32, 3, position, 0);
        borrow(cloud, EWA_NORMAL, EWA_F32, 3, normal, 0);
        borrow(cloud, EWA_RADIUS, EWA_F32, 1, &radius, 0);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(cloud);
        ewa_packet_surfel surfel;
        ewa_packet_decode(surfels, (uint32_t)(0), 0, &surfel);
        ewa_vec3 given = vec3_make((double)normal[0], (double)normal[1], (double)normal[2]);
        assert_true(vec3_normalize(&given));
        assert_true(vec3_length(vec3_sub(surfel.normal, given)) < 1e-4);
    }
}

/// The axis of a cone and the sine of its half angle; 2: it is no cone.
static double decode_cone(uint32_t code, ewa_vec3 *axis) {
    const int mask = (1 << EWA_CONE_BITS) - 1, x = (int)code & mask, y = (int)(code >> EWA_CONE_BITS) & mask;
    const double u = (x - EWA_CONE_AXIS) / (double)EWA_CONE_AXIS,
                 v = (y - EWA_CONE_AXIS) / (double)EWA_CONE_AXIS;
    const double z = 1 - fabs(u) - fabs(v), fold = fmax(-z, 0);
    *axis = vec3_make(u - (u < 0 ? -fold : fold), v - (v < 0 ? -fold : fold), z);
    assert_true(vec3_normalize(axis));
    const uint32_t sine = code >> 2 * EWA_CONE_BITS;
    return sine > EWA_CONE_SINE ? 2 : sine / (double)EWA_CONE_SINE;
}

static double radius_of(const ewa_surfels *surfels, uint32_t packet) {
    const uint32_t bits = (uint32_t)surfels->bounds.radius[packet] << EWA_RADIUS_SHIFT;
    float radius;
    memcpy(&radius, &bits, sizeof radius);
    return (double)radius;
}

/// Spheres and cones hold their surfels, and are hardly larger.
TEST(test_bounds_hold) {
    static numbers of;
    make_numbers(&of);
    for (int i = 0; i < POINTS; i++) of.normal[i][2] = 30 * fabsf(of.normal[i][0]); // narrow and wide cones
    OWNED(ewa_context_destroy) ewa_context *context = check_context_of(2, EWA_CPU_ALL);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(context, &of);
    int narrow = 0;
    for (uint32_t p = 0; p < surfels->packet_count; p++) {
        ewa_vec3 axis;
        const double sine = decode_cone(surfels->bounds.cone[p], &axis);
        double reach = 0, widest = 0;
        for (uint32_t lane = 0; lane < 16 && p * 16 + lane < surfels->count; lane++) {
            ewa_packet_surfel s;
            ewa_packet_decode(surfels, p, lane, &s);
            reach = fmax(reach, vec3_length(s.offset) + surfels->cutoff * vec3_length(s.axis_u));
            widest = fmax(widest, vec3_length(vec3_cross(s.normal, axis)));
            if (sine > 1) continue;
            narrow++;
            assert_true(vec3_dot(s.normal, axis) > 0);
        }
        const double radius = radius_of(surfels, p);
        assert_true(reach <= radius && radius < 1.01 * reach);
        assert_true(sine > 1 || (widest <= sine && sine < widest + 0.003));
    }
    assert_true(narrow > POINTS / 4);
}

/// The largest sigmas are those of some surfel, of discs and of ellipses, wherever in the set it is.
TEST(test_largest_sigmas) {
    static float position[POINTS][3], axis_u[POINTS][3], axis_v[POINTS][3];
    static const uint32_t counts[] = {1, 17, 16 * 64 - 1, POINTS};
    check_random random = {11};
    OWNED(ewa_context_destroy) ewa_context *context = check_context_of(2, EWA_CPU_ALL);
    for (int turn = 0; turn < 16; turn++) {
        const uint32_t count = counts[turn / 4];
        const double max_aspect = turn % 2 ? 5 : 1;
        for (uint32_t i = 0; i < count; i++) {
            for (int c = 0; c < 3; c++) position[i][c] = (float)check_uniform(&random, -3, 5);
            const double sigma = check_uniform(&random, 0.01, 0.02);
            memcpy(axis_u[i], (float[3]){(float)(sigma * check_uniform(&random, 1, max_aspect)), 0, 0}, 12);
            memcpy(axis_v[i], (float[3]){0, 0, (float)sigma}, 12);
            if (max_aspect == 1) axis_u[i][0] = axis_v[i][2];
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, count);
        borrow(cloud, EWA_POSITION, EWA_F32, 3, position, 0);
        borrow(cloud, EWA_TANGENT_U, EWA_F32, 3, axis_u, 0);
        borrow(cloud, EWA_TANGENT_V, EWA_F32, 3, axis_v, 0);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(cloud);
        assert_int_equal(surfels->ellipses, max_aspect > 1);
        double largest[2] = {0, 0};
        for (uint32_t i = 0; i < count; i++) {
            ewa_packet_surfel surfel;
            ewa_packet_decode(surfels, i / 16, i % 16, &surfel);
            largest[0] = fmax(largest[0], vec3_length(surfel.axis_u) * surfels->unit);
            largest[1] = fmax(largest[1], vec3_length(surfel.axis_v) * surfels->unit);
        }
        for (int k = 0; k < 2; k++)
            assert_true(fabs(surfels->largest_sigmas_world[k] - largest[k]) <= 1e-6 * largest[k]);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
