// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of ewa_cloud_generate(): the objects' geometry against closed forms, evenness and cover of the
// sampling, the same bytes for every thread count and machine, refused options, failing allocations.
#include "generate/generate.h"
#include "math/generate_number.h"
#include "prepare/check_generated.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.141592653589793

enum { OBJECT_COUNT = EWA_OBJECT_TERRAIN + 1 };

static const void *data_of(const ewa_cloud *cloud, const char *name) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    assert_non_null(attribute);
    return attribute->data;
}

static double length_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static double distance2(const float *a, const double *b) {
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

TEST(test_sine_and_cosine) {
    const double circle = 6.283185307179586;
    double largest = 0, largest_coarse = 0;
    for (int i = -4000; i <= 4000; i++) {
        const double turns = i / 1000.0;
        double sine, cosine;
        ewa_generate_sincos(turns, &sine, &cosine);
        largest = fmax(largest, fmax(fabs(sine - sin(circle * turns)), fabs(cosine - cos(circle * turns))));
        largest_coarse = fmax(largest_coarse, fabs(ewa_generate_sin((float)turns) - sin(circle * turns)));
    }
    assert_true(largest < 1e-14);
    assert_true(largest_coarse < 1.2e-3);
}

TEST_ON(test_counts_and_attributes, 2) {
    static const uint64_t counts[] = {0, 1, 2, 3, 5, 7, 64, 65, 1000, 12345};
    for (int object = 0; object < OBJECT_COUNT; object++) {
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
            ewa_generate_options options = check_generate_options((ewa_object)object, counts[c]);
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
            assert_int_equal(ewa_cloud_point_count(cloud), counts[c]);
            const bool bends = object == EWA_OBJECT_SPHERE || object == EWA_OBJECT_TORUS;
            assert_int_equal(ewa_cloud_attribute_count(cloud), 4 + bends);
            assert_int_equal(ewa_cloud_find(cloud, EWA_POSITION)->type, EWA_F32);
            assert_int_equal(ewa_cloud_find(cloud, EWA_NORMAL)->component_count, 3);
            assert_int_equal(ewa_cloud_find(cloud, EWA_COLOR)->type, EWA_U8);
            const float *position = data_of(cloud, EWA_POSITION), *radius = data_of(cloud, EWA_RADIUS);
            for (uint64_t i = 0; i < counts[c]; i++) {
                for (int k = 0; k < 3; k++) assert_true(fabsf(position[3 * i + k]) <= 1);
                assert_true(radius[i] > 0 && isfinite(radius[i]));
            }
        }
        ewa_generate_options options = check_generate_options((ewa_object)object, 100);
        options.positions_only = true;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
        assert_int_equal(ewa_cloud_attribute_count(cloud), 2);
        assert_null(ewa_cloud_find(cloud, EWA_NORMAL));
        assert_null(ewa_cloud_find(cloud, EWA_RADIUS));
    }
}

/// What the surface and its normal are at a position, from the closed form.
static void check_on_surface(ewa_object object, double size, const float *position, const float *normal) {
    const double p[3] = {position[0] / size, position[1] / size, position[2] / size};
    double expected[3] = {0, 0, 1};
    double off = p[2];
    if (object == EWA_OBJECT_SPHERE) {
        off = length_of(p) - 0.5;
        for (int c = 0; c < 3; c++) expected[c] = 2 * p[c];
    } else if (object == EWA_OBJECT_TORUS) {
        const double ring = sqrt(p[0] * p[0] + p[1] * p[1]), major = 2.5 / 7, minor = 1.0 / 7;
        const double tube[3] = {p[0] * (1 - major / ring), p[1] * (1 - major / ring), p[2]};
        off = length_of(tube) - minor;
        for (int c = 0; c < 3; c++) expected[c] = tube[c] / minor;
    } else if (object == EWA_OBJECT_CUBE) {
        int axis = 0;
        for (int c = 1; c < 3; c++)
            if (fabs(p[c]) > fabs(p[axis])) axis = c;
        off = fabs(p[axis]) - 0.5;
        for (int c = 0; c < 3; c++) expected[c] = c == axis ? (p[c] > 0 ? 1 : -1) : 0;
    }
    assert_true(fabs(off) < 1e-6);
    for (int c = 0; c < 3; c++) assert_true(fabs(expected[c] - normal[c]) < 2e-6);
}

TEST_ON(test_positions_and_normals, 2) {
    for (int object = 0; object < EWA_OBJECT_TERRAIN; object++) {
        ewa_generate_options options = check_generate_options((ewa_object)object, 10000);
        options.size_world = 5;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
        const float *position = data_of(cloud, EWA_POSITION), *normal = data_of(cloud, EWA_NORMAL);
        for (uint64_t i = 0; i < 10000; i++)
            check_on_surface((ewa_object)object, 5, &position[3 * i], &normal[3 * i]);
    }
}

TEST(test_terrain_normals_are_its_derivatives) {
    ewa_terrain terrain;
    ewa_terrain_init(&terrain, 3, 100000);
    check_random random = {5};
    const double step = 1.0 / 8192;
    for (int round = 0; round < 200; round++) {
        // Central differences of a coarse prefix of the octaves, where the float heights resolve the step.
        terrain.octave_count = 4;
        const double x = check_uniform(&random, 0.05, 0.95), y = check_uniform(&random, 0.05, 0.95);
        const double xs[5] = {x, x - step, x + step, x, x}, ys[5] = {y, y, y, y - step, y + step};
        ewa_terrain_heights h;
        ewa_terrain_evaluate(&terrain, 5, xs, ys, &h);
        assert_true(fabs((h.height[2] - h.height[1]) / (2 * step) - h.by_x[0]) < 0.005);
        assert_true(fabs((h.height[4] - h.height[3]) / (2 * step) - h.by_y[0]) < 0.005);
    }
}

TEST_ON(test_terrain_has_land_water_and_upward_unit_normals, 2) {
    for (uint64_t seed = 0; seed < 5; seed++) {
        ewa_generate_options options = check_generate_options(EWA_OBJECT_TERRAIN, 50000);
        options.seed = seed;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
        const float *position = data_of(cloud, EWA_POSITION), *normal = data_of(cloud, EWA_NORMAL);
        uint64_t water = 0;
        double highest = 0;
        for (uint64_t i = 0; i < 50000; i++) {
            const double n[3] = {normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]};
            assert_true(fabs(length_of(n) - 1) < 1e-6 && n[2] > 0.1);
            assert_true(position[3 * i + 2] >= 0);
            if (position[3 * i + 2] == 0) {
                water++;
                assert_true(n[2] == 1);
            }
            highest = fmax(highest, position[3 * i + 2]);
        }
        assert_in_range(water, 500, 40000);
        assert_true(highest > 0.1 && highest < 0.8);
    }
}

/// A place on the object, uniform on it (terrain: on its ground), for size 2.
static void random_place(ewa_object object, const ewa_terrain *terrain, check_random *random,
                         double place[3]) {
    const double u = check_uniform(random, 0, 1), v = check_uniform(random, 0, 1);
    place[0] = 2 * u - 1;
    place[1] = 2 * v - 1;
    place[2] = 0;
    if (object == EWA_OBJECT_CUBE) {
        const int axis = (int)check_uniform(random, 0, 3);
        place[2] = place[axis];
        place[axis] = check_uniform(random, -1, 1) < 0 ? -1 : 1;
    } else if (object == EWA_OBJECT_SPHERE) {
        const double z = 2 * v - 1, ring = sqrt(1 - z * z);
        place[0] = ring * cos(2 * PI * u);
        place[1] = ring * sin(2 * PI * u);
        place[2] = z;
    } else if (object == EWA_OBJECT_TORUS) {
        // By rejection: the density is proportional to the ring's length at that angle of the tube.
        double t, ring;
        do {
            t = check_uniform(random, 0, 2 * PI);
            ring = (5 + 2 * cos(t)) / 7;
        } while (check_uniform(random, 0, 1) > ring);
        place[0] = ring * cos(2 * PI * u);
        place[1] = ring * sin(2 * PI * u);
        place[2] = 2.0 / 7 * sin(t);
    } else if (object == EWA_OBJECT_TERRAIN) {
        ewa_terrain_heights heights;
        ewa_terrain_evaluate(terrain, 1, &u, &v, &heights);
        place[2] = 2 * fmax(0, heights.height[0]);
    }
}

TEST_ON(test_discs_cover_every_place, 2) {
    for (int object = 0; object < OBJECT_COUNT; object++) {
        for (int jittered = 0; jittered < 2; jittered++) {
            const uint64_t count = 8000;
            ewa_generate_options options = check_generate_options((ewa_object)object, count);
            options.jitter = 0.5 * jittered;
            options.radius_scale = jittered ? 1.2 : 0.8;
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
            ewa_terrain terrain;
            ewa_terrain_init(&terrain, options.seed, count);
            const float *position = data_of(cloud, EWA_POSITION), *radius = data_of(cloud, EWA_RADIUS);
            check_random random = {17};
            for (int probe = 0; probe < 2000; probe++) {
                double place[3];
                random_place((ewa_object)object, &terrain, &random, place);
                bool covered = false;
                for (uint64_t i = 0; i < count && !covered; i++)
                    covered = distance2(&position[3 * i], place) < (double)radius[i] * radius[i];
                assert_true(covered);
            }
        }
    }
}

/// Which of 8 x 8 parts of equal area a place lies in.
static int area_bin(ewa_object object, const float *p) {
    double u = (p[0] + 1) / 2, v = (p[1] + 1) / 2;
    if (object == EWA_OBJECT_SPHERE || object == EWA_OBJECT_TORUS) u = 0.5 + atan2(p[1], p[0]) / (2 * PI);
    if (object == EWA_OBJECT_SPHERE) v = (1 - p[2]) / 2;
    if (object == EWA_OBJECT_TORUS) {
        const double t = atan2(p[2], sqrt((double)p[0] * p[0] + (double)p[1] * p[1]) - 5.0 / 7);
        v = 0.5 + (t + 0.4 * sin(t)) / (2 * PI);
    }
    const int i = (int)(8 * u), j = (int)(8 * v);
    return 8 * (j > 7 ? 7 : j) + (i > 7 ? 7 : i);
}

TEST_ON(test_density_is_even, 2) {
    static const ewa_object objects[] = {EWA_OBJECT_PLANE, EWA_OBJECT_SPHERE, EWA_OBJECT_TORUS,
                                         EWA_OBJECT_TERRAIN};
    for (size_t o = 0; o < sizeof objects / sizeof objects[0]; o++) {
        for (uint64_t seed = 0; seed < 4; seed++) {
            ewa_generate_options options = check_generate_options(objects[o], 64 * 997);
            options.seed = seed;
            options.jitter = 1;
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
            const float *position = data_of(cloud, EWA_POSITION);
            double counts[64] = {0}, chi_square = 0;
            for (uint64_t i = 0; i < options.point_count; i++)
                counts[area_bin(objects[o], &position[3 * i])]++;
            for (int b = 0; b < 64; b++) chi_square += (counts[b] - 997) * (counts[b] - 997) / 997;
            // Independent points would give 63 +- 11; one point per cell varies along the bins' borders only.
            assert_true(chi_square < 30);
        }
    }
}

TEST_ON(test_regular_grid, 1) {
    ewa_generate_options options = check_generate_options(EWA_OBJECT_PLANE, 16);
    options.jitter = 0;
    options.radius_scale = 1;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
    const float *position = data_of(cloud, EWA_POSITION), *radius = data_of(cloud, EWA_RADIUS);
    for (int i = 0; i < 16; i++) {
        assert_true(position[3 * i] == -0.75f + 0.5f * (float)(i % 4));
        assert_true(position[3 * i + 1] == -0.75f + 0.5f * (float)(i / 4));
        assert_true(radius[i] == 0.5f);
    }
}

TEST_ON(test_checks, 1) {
    ewa_generate_options options = check_generate_options(EWA_OBJECT_CHECKER, 10000);
    options.checks = 5;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
    const float *position = data_of(cloud, EWA_POSITION);
    const uint8_t *color = data_of(cloud, EWA_COLOR);
    for (int i = 0; i < 10000; i++) {
        const double u = 2.5 * (position[3 * i] + 1), v = 2.5 * (position[3 * i + 1] + 1);
        if (fabs(u - round(u)) < 1e-5 || fabs(v - round(v)) < 1e-5) continue; // rounded across the line
        const int expected = ((int)u + (int)v) % 2 ? 0 : 255;
        for (int c = 0; c < 3; c++) assert_int_equal(color[3 * i + c], expected);
    }
}

TEST(test_same_bytes_for_every_thread_count) {
    static const uint32_t threads[] = {1, 2, 7, 32};
    for (int object = 0; object < OBJECT_COUNT; object++) {
        uint64_t first = 0;
        for (size_t t = 0; t < sizeof threads / sizeof threads[0]; t++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[t], NULL);
            ewa_generate_options options = check_generate_options((ewa_object)object, 54321);
            ewa_cloud *cloud = check_generated(context, &options);
            const uint64_t hash = check_cloud_hash(cloud);
            if (t == 0) first = hash;
            assert_true(hash == first);
            ewa_cloud_destroy(&cloud);
            if (t == 0) {
                options.seed = 2;
                cloud = check_generated(context, &options);
                assert_true(check_cloud_hash(cloud) != first);
                ewa_cloud_destroy(&cloud);
            }
        }
    }
}

/// The bytes are a promise to everybody who names an object, a count and a seed: a change here needs a
/// changelog line.
TEST_ON(test_bytes_are_known, 0) {
    static const uint64_t known[OBJECT_COUNT] = {0x4b5329827d8f3eda, 0x3fc871025e145fa5, 0xd45a56f3a3a49a4a,
                                                 0xc38fbb3e780e9457, 0xbe57c01769ed62b2, 0xf927b2c3daffc417};
    int wrong = 0;
    for (int object = 0; object < OBJECT_COUNT; object++) {
        ewa_generate_options options = check_generate_options((ewa_object)object, 10007);
        options.seed = 42;
        options.radius_scale = EWA_DEFAULT_RADIUS_SCALE;
        ewa_cloud *cloud = check_generated(context, &options);
        const uint64_t hash = check_cloud_hash(cloud);
        ewa_cloud_destroy(&cloud);
        if (hash == known[object]) continue;
        print_error("object %d: 0x%016llx\n", object, (unsigned long long)hash);
        wrong++;
    }
    assert_int_equal(wrong, 0);
}

static void check_refused(ewa_context *context, const check_log *log, const ewa_generate_options *options,
                          const char *member) {
    ewa_cloud *cloud = (ewa_cloud *)(uintptr_t)1;
    assert_int_equal(ewa_cloud_generate(context, options, &cloud), EWA_ERROR_ARGUMENT);
    assert_null(cloud);
    assert_non_null(strstr(log->text, member));
}

TEST_LOGGED(test_bad_options, 1) {
    const ewa_generate_options good = check_generate_options(EWA_OBJECT_CHECKER, 10);
    static const double bad[] = {NAN, INFINITY, -INFINITY, -1, 0, 1e300, 1e-300};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ewa_generate_options options = good;
        options.size_world = bad[i];
        check_refused(context, log, &options, "size_world");
        options = good;
        options.checks = bad[i];
        check_refused(context, log, &options, "checks");
        options = good;
        options.radius_scale = bad[i];
        if (bad[i] != 0) check_refused(context, log, &options, "radius_scale");
        options = good;
        options.jitter = bad[i];
        if (!(bad[i] >= 0 && bad[i] <= 1)) check_refused(context, log, &options, "jitter");
    }
    ewa_generate_options options = good;
    options.object = (ewa_object)17;
    check_refused(context, log, &options, "object");
    options = good;
    options.struct_size = 8;
    check_refused(context, log, &options, "struct_size");
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(NULL, &good, &cloud), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_generate(context, &good, NULL), EWA_ERROR_ARGUMENT);
    options = good;
    options.point_count = UINT64_MAX;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_ERROR_LIMIT);
    assert_null(cloud);
}

TEST_ON(test_extreme_sizes_stay_finite, 1) {
    static const double sizes[] = {1e-25, 1e25}, scales[] = {1e-6, 1e6};
    for (int object = 0; object < OBJECT_COUNT; object++) {
        for (int i = 0; i < 4; i++) {
            ewa_generate_options options = check_generate_options((ewa_object)object, 1000);
            options.size_world = sizes[i & 1];
            options.radius_scale = scales[i >> 1];
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
            const float *radius = data_of(cloud, EWA_RADIUS);
            for (int k = 0; k < 1000; k++) assert_true(radius[k] >= FLT_MIN && radius[k] <= FLT_MAX);
        }
    }
}

TEST(test_every_failing_allocation) {
    const ewa_generate_options options = check_generate_options(EWA_OBJECT_TORUS, 1000);
    check_generate_without_memory(&options);
}

static bool cancel(void *user, const char *stage, double fraction) {
    (void)user;
    assert_string_equal(stage, "generate");
    return fraction < 0.4;
}

TEST(test_progress_cancels) {
    WITH_DEFAULTS(ewa_context_options, context_options);
    context_options.progress = cancel;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&context_options, &context), EWA_OK);
    const ewa_generate_options options = check_generate_options(EWA_OBJECT_PLANE, 1000);
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_CANCELLED);
    assert_null(cloud);
}

TEST_LOGGED(test_sharp_objects, 0) {
    for (int object = 0; object <= EWA_OBJECT_CSG; object++) {
        ewa_generate_options options = check_generate_options((ewa_object)object, 7000);
        options.sharp = true;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        const bool has_edges = object == EWA_OBJECT_CUBE || object == EWA_OBJECT_CSG;
        const ewa_status status = ewa_cloud_generate(context, &options, &cloud);
        assert_int_equal(status, has_edges ? EWA_OK : EWA_ERROR_ARGUMENT);
        if (!has_edges) continue;
        const uint64_t count = ewa_cloud_point_count(cloud);
        assert_true(count <= 7000 && count > 6000);
        assert_null(ewa_cloud_find(cloud, EWA_RADIUS));
        const float *clip[2] = {data_of(cloud, EWA_CLIP0), data_of(cloud, EWA_CLIP1)};
        const uint8_t *mode = data_of(cloud, EWA_CLIP_MODE);
        uint64_t lines[3] = {0}, either = 0;
        for (uint64_t i = 0; i < count; i++) {
            uint32_t found = 0;
            for (int k = 0; k < 2; k++) found += clip[k][3 * i] != 0 || clip[k][3 * i + 1] != 0;
            lines[found]++;
            either += mode[i];
        }
        assert_true(lines[0] > lines[1] && lines[1] > lines[2]);
        // The cube has four convex corners on each face: the surfel on it, two beside it, one across.
        if (object == EWA_OBJECT_CUBE) assert_int_equal(lines[2], 6 * 4 * 4);
        assert_true((either > 0) == (object == EWA_OBJECT_CSG));
        ewa_cloud_destroy(&cloud);
        options.sharp = false;
        cloud = check_generated(context, &options);
        assert_null(ewa_cloud_find(cloud, EWA_CLIP0));
        assert_non_null(ewa_cloud_find(cloud, EWA_RADIUS));
    }
    ewa_generate_options few = check_generate_options(EWA_OBJECT_CSG, 100);
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &few, &cloud), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "point_count is 100"));
    few.point_count = 0;
    assert_int_equal(ewa_cloud_generate(context, &few, &cloud), EWA_ERROR_ARGUMENT);
}

/// The part measures what docs/sharp.md says: its box, the floors of slot and notch, and its holes, whose
/// axes are a radius in front of every place of their walls.
TEST_ON(test_part_measures, 0) {
    enum { WALLS = 2 };
    static const struct {
        int axis;
        double center[2], radius; ///< across the axis: x and y, or x and z
    } holes[WALLS] = {{2, {-0.225, 0}, 0.32 / 2}, {1, {0.395, -0.1}, 0.1 / 2}};
    static const double box[3] = {1, 0.7, 0.4};
    ewa_generate_options options = check_generate_options(EWA_OBJECT_CSG, 7000);
    options.size_world = 3;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_generated(context, &options);
    const float *p = data_of(cloud, EWA_POSITION), *n = data_of(cloud, EWA_NORMAL);
    uint64_t on_wall[WALLS] = {0}, bottom_of_slot = 0, bottom_of_notch = 0;
    double high[3] = {0};
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        double at[3], facing[3];
        for (int c = 0; c < 3; c++) {
            at[c] = p[3 * i + c] / options.size_world, facing[c] = n[3 * i + c];
            high[c] = fmax(high[c], fabs(at[c]));
        }
        if (facing[2] == 1 && fabs(at[2]) < 1e-6) {
            const bool slot = at[0] > 0.05 - 1e-6 && at[0] < 0.25 + 1e-6;
            assert_true(slot || (at[0] > 0.35 - 1e-6 && at[1] > 0.1 - 1e-6));
            bottom_of_slot += slot;
            bottom_of_notch += !slot;
        }
        for (int k = 0; k < WALLS; k++) {
            const int across[2] = {0, 3 - holes[k].axis};
            if (facing[holes[k].axis] != 0 || facing[0] == 0 || facing[across[1]] == 0) continue;
            on_wall[k]++;
            for (int c = 0; c < 2; c++)
                assert_true(fabs(at[across[c]] + holes[k].radius * facing[across[c]] - holes[k].center[c]) <
                            1e-6);
        }
    }
    for (int c = 0; c < 3; c++) assert_true(fabs(2 * high[c] - box[c]) < 1e-6);
    for (int k = 0; k < WALLS; k++) assert_true(on_wall[k] > 100);
    assert_true(bottom_of_slot > 100 && bottom_of_notch > 30);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
