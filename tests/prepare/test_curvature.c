// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Signed curvatures against surfaces that are known: estimated from points, of meshes, of generated objects; what noise
// and moving make of them.
#include "prepare/check_generated.h"
#include "prepare/check_prepare.h"
#include "prepare/mesh_shapes.h"

enum { COUNT = 12000 };

#define PI 3.141592653589793

typedef enum shape { SPHERE, CYLINDER, SADDLE, PLANE, ROUGH_PLANE, SHAPES } shape;

/// A random place of a surface of size 1: a sphere and a cylinder of radius 1 / 2, a saddle that bends by 2 and -2.
static void place_on(shape of, check_random *random, double p[3]) {
    const double a = check_uniform(random, 0, 2 * PI);
    for (int c = 0; c < 3; c++) p[c] = check_uniform(random, -0.5, 0.5);
    if (of == SPHERE) {
        check_direction(random, p);
        for (int c = 0; c < 3; c++) p[c] *= 0.5;
    } else if (of == CYLINDER) {
        p[0] = 0.5 * cos(a), p[1] = 0.5 * sin(a);
    } else if (of == SADDLE) {
        p[0] *= 0.4, p[1] *= 0.4;
        p[2] = p[0] * p[0] - p[1] * p[1];
    } else {
        p[2] *= of == ROUGH_PLANE ? 0.5 / sqrt(COUNT) : 0;
    }
}

static ewa_cloud *make_points(ewa_context *context, shape of, double size) {
    float *xyz = NULL;
    ewa_cloud *cloud = check_cloud(context, COUNT, &xyz);
    check_random random = {5};
    for (int i = 0; i < COUNT; i++) {
        double p[3];
        place_on(of, &random, p);
        for (int c = 0; c < 3; c++) xyz[3 * i + c] = (float)(size * p[c]);
    }
    return cloud;
}

static int compare(const void *a, const void *b) {
    const float *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/// The value below which a share of all lies.
static double percentile(const float *values, uint64_t count, double share) {
    OWNED(check_free) float *sorted = malloc(count * sizeof *sorted);
    memcpy(sorted, values, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare);
    const double found = (double)sorted[(uint64_t)(share * (double)(count - 1))];
    return found;
}

/// Points of known surfaces, of any size; curvature is the other way where normals point to the other side.
TEST_ON(test_known_surfaces, 2) {
    static const double sizes[] = {1, 1e-18, 1e18};
    for (int k = 0; k < 3 * SHAPES; k++) {
        const shape of = (shape)(k % SHAPES);
        const double size = sizes[k / SHAPES];
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_points(context, of, size);
        ewa_estimate_options options = check_estimate_options();
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        if (of == PLANE) { // flat throughout
            assert_null(ewa_cloud_find(cloud, EWA_CURVATURE));
            ewa_cloud_destroy(&cloud);
            continue;
        }
        const float *found = check_stream(cloud, EWA_CURVATURE);
        const double low = size * percentile(found, COUNT, 0.1), middle = size * percentile(found, COUNT, 0.5),
                     high = size * percentile(found, COUNT, 0.9);
        print_message("shape %d of %g: %.3f, %.3f, %.3f\n", (int)of, size, low, middle, high);
        // Less by how far neighbours are apart; for some way from the ends of a cylinder nothing is told.
        const double expected = of == SPHERE ? 2 : of == CYLINDER ? sqrt(2) : 0;
        assert_true(fabs(middle - expected) <= (of == SADDLE ? 0.05 : 0.12 * expected));
        if (of == SPHERE || of == CYLINDER) assert_true(size * percentile(found, COUNT, of == SPHERE ? 0.1 : 0.35) > 0.7 * expected);
        if (of == SPHERE || of == CYLINDER) assert_true(low >= 0 && high < 1.1 * expected);
        if (of == SADDLE) assert_true(low > -0.5 && high < 0.5);
        if (of == ROUGH_PLANE) assert_true(low == 0 && high == 0);
        float *before = malloc(COUNT * sizeof *before), *normal = ewa_cloud_find(cloud, EWA_NORMAL)->data;
        memcpy(before, found, COUNT * sizeof *before);
        for (int i = 0; i < 3 * COUNT; i++) normal[i] *= -2; // of any length
        options.keep_radii = false;
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        found = check_stream(cloud, EWA_CURVATURE);
        assert_memory_equal(found, before, COUNT * sizeof *before); // kept, as the normals are
        ewa_cloud_remove(cloud, EWA_CURVATURE);
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        found = check_stream(cloud, EWA_CURVATURE);
        for (int i = 0; i < COUNT; i++)
            assert_true(fabs((double)found[i] + (double)before[i]) * size <
                        0.01 * fmax(1, fabs((double)before[i]) * size));
        free(before);
    }
}

/// Meshes and generated objects know as much, and a torus bends least where it is hollow.
TEST_ON(test_made_surfaces, 0) {
    ewa_mesh mesh;
    shape_sphere(context, 60, &mesh);
    WITH_DEFAULTS(ewa_mesh_sample_options, sampling);
    sampling.point_count = COUNT;
    ewa_cloud *cloud = shape_sample(&mesh, &sampling);
    ewa_mesh_free(&mesh);
    const float *found = check_stream(cloud, EWA_CURVATURE);
    const uint64_t count = ewa_cloud_point_count(cloud);
    assert_true(percentile(found, count, 0.02) > 0.9 && percentile(found, count, 0.98) < 1.1);
    ewa_cloud_destroy(&cloud);
    for (int k = 0; k < 3; k++) {
        WITH_DEFAULTS(ewa_generate_options, options);
        options.point_count = COUNT;
        options.size_world = 7;
        options.object = k == 0 ? EWA_OBJECT_SPHERE : k == 1 ? EWA_OBJECT_TORUS : EWA_OBJECT_PLANE;
        assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
        if (k == 2) {
            assert_null(ewa_cloud_find(cloud, EWA_CURVATURE));
        } else {
            found = check_stream(cloud, EWA_CURVATURE);
            // A tube of radius 1 around a ring of 2.5.
            const double least = k == 0 ? 2 / 7.0 : 1 - 1 / 1.5;
            const double most = k == 0 ? 2 / 7.0 : sqrt((1 + 1 / 3.5 / 3.5) / 2);
            assert_true(fabs(percentile(found, COUNT, 0) - least) < 0.01);
            assert_true(fabs(percentile(found, COUNT, 1) - most) < 0.01);
        }
        ewa_cloud_destroy(&cloud);
    }
}

/// Normals turn round the edges of a cube, which does not bend there: splats that moved by half of their radius would
/// leave gaps beside the edges.
TEST_ON(test_edges, 0) {
    for (uint64_t wanted = 6000; wanted <= 60000; wanted *= 10) {
        WITH_DEFAULTS(ewa_generate_options, generate);
        generate.object = EWA_OBJECT_CUBE;
        generate.point_count = wanted;
        generate.positions_only = true;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        assert_int_equal(ewa_cloud_generate(context, &generate, &cloud), EWA_OK);
        ewa_estimate_options options = check_estimate_options();
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const uint64_t count = ewa_cloud_point_count(cloud);
        const float *found = ewa_cloud_find(cloud, EWA_CURVATURE) ? check_stream(cloud, EWA_CURVATURE) : NULL;
        const double most = found ? fmax(percentile(found, count, 1), -percentile(found, count, 0)) : 0;
        const double spacing = generate.size_world * sqrt(6.0 / (double)count);
        print_message("%llu points: at most %.3f of a spacing\n", (unsigned long long)count, most * spacing);
        assert_true(most * spacing < 0.35);
    }
}

/// Moved points bend as they are moved: by 1 / scale, and a mirror changes no sign, since normals stay outside.
TEST_ON(test_moved, 0) {
    static const double mirror[16] = {0, -4, 0, 1, 4, 0, 0, 2, 0, 0, -4, 3, 0, 0, 0, 1};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_object(context, EWA_OBJECT_SPHERE, 100);
    assert_int_equal(ewa_cloud_transform(cloud, mirror), EWA_OK);
    const float *found = check_stream(cloud, EWA_CURVATURE), *place = check_stream(cloud, EWA_POSITION),
                *normal = check_stream(cloud, EWA_NORMAL);
    for (int i = 0; i < 100; i++) {
        double outward = 0;
        for (int c = 0; c < 3; c++) outward += (double)place[3 * i + c] * (double)normal[3 * i + c];
        assert_true(fabs((double)found[i] - 0.25) < 1e-5 && outward > 0);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
