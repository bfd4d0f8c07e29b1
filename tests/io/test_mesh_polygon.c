// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Polygons to triangles: areas are kept, no two triangles overlap, whatever the outline; what meets itself,
// is large or lies far away costs no more than its share.
#include "io/mesh/build.h"
#include "io/mesh_check.h"

static mesh_messages messages;
static ewa_context *context;
static ewa_mesh_source source;

static int begin(void **state) {
    context = mesh_context(&messages);
    source = (ewa_mesh_source){.context = context, .name = "polygon"};
    return 0;
}

static int end(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// Puts a polygon of the plane into space, in one of some planes, and cuts it.
static void cut(const double (*outline)[2], uint32_t count, int plane, const double shift[3],
                ewa_mesh_build *build) {
    ewa_mesh_build_open(&source, build);
    ewa_mesh_corner *corners = malloc(count * sizeof *corners);
    for (uint32_t i = 0; i < count; i++) {
        const double x = outline[i][0], y = outline[i][1];
        const double planes[4][3] = {{x, y, 0}, {0, x, y}, {y, 0, x}, {x, y, x - 2 * y}};
        double place[3];
        for (int c = 0; c < 3; c++) place[c] = planes[plane][c] + shift[c];
        assert_int_equal(ewa_mesh_add_position(build, place), EWA_OK);
        corners[i] = (ewa_mesh_corner){i, EWA_MESH_NONE, EWA_MESH_NONE};
    }
    assert_int_equal(ewa_mesh_add_polygon(build, corners, count), EWA_OK);
    free(corners);
}

static double area_of(const double (*outline)[2], uint32_t count) {
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double *a = outline[i], *b = outline[(i + 1) % count];
        sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    return sum;
}

/// All triangles turn like the polygon and add up to it: none overlaps another.
static void hold(const double (*outline)[2], uint32_t count, const char *name) {
    static const double shifts[2][3] = {{0, 0, 0}, {524288, -4194304, 1048576}};
    static const double factors[4] = {1, 1, 1, 2.449489742783178}; // of the plane z = x - 2 y
    static uint32_t first[6000];
    for (int plane = 0; plane < 4; plane++)
        for (int s = 0; s < 2; s++) {
            OWNED(ewa_mesh_build_close) ewa_mesh_build build;
            cut(outline, count, plane, shifts[s], &build);
            const uint32_t *corners = build.corners.items;
            const double *p = build.positions.items;
            const double wanted = area_of(outline, count);
            double sum = 0;
            if (build.corners.count != count - 2)
                fail_msg("%s: %llu triangles", name, (unsigned long long)build.corners.count);
            if (s)
                assert_memory_equal(corners, first, 3 * (count - 2) * sizeof *first);
            else
                memcpy(first, corners, 3 * (count - 2) * sizeof *first);
            for (uint32_t t = 0; t < count - 2; t++) {
                double e[2][3], n[3], dot;
                for (int k = 0; k < 2; k++)
                    for (int c = 0; c < 3; c++)
                        e[k][c] = p[3 * corners[3 * t + 1 + (uint32_t)k] + (uint32_t)c] -
                                  p[3 * corners[3 * t] + (uint32_t)c];
                for (int c = 0; c < 3; c++)
                    n[c] =
                        0.5 * (e[0][(c + 1) % 3] * e[1][(c + 2) % 3] - e[0][(c + 2) % 3] * e[1][(c + 1) % 3]);
                static const double normals[4][3] = {
                    {0, 0, 1},
                    {1, 0, 0},
                    {0, 1, 0},
                    {-0.408248290463863, 0.816496580927726, 0.408248290463863}};
                dot = n[0] * normals[plane][0] + n[1] * normals[plane][1] + n[2] * normals[plane][2];
                if (dot * wanted < -1e-12 * wanted * wanted) fail_msg("%s: triangle %u is turned", name, t);
                sum += dot;
            }
            assert_true(fabs(sum - factors[plane] * wanted) < 1e-9 * fabs(wanted) * factors[plane]);
            assert_int_equal(build.uncut_count, 0);
        }
}

TEST_WITHIN(test_shapes, begin, end) {
    static const double concave_quad[][2] = {{0, 0}, {2, 1}, {4, 0}, {2, 4}},
                        turned_quad[][2] = {{2, 4}, {4, 0}, {2, 1}, {0, 0}};
    static const double arrow[][2] = {{2, 1}, {4, 0}, {2, 4}, {0, 0}};
    static const double l_shape[][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
    static const double straight[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {1, 3}, {0, 3}};
    static const double comb[][2] = {{0, 0}, {8, 0}, {8, 4}, {7, 1}, {6, 4}, {5, 1},
                                     {4, 4}, {3, 1}, {2, 4}, {1, 1}, {0, 4}};
    // A square with a hole, cut open along a line that is walked twice.
    static const double ring[][2] = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0},
                                     {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}};
    static const double spiral[][2] = {{0, 0}, {7, 0}, {7, 6},   {1, 6},   {1, 2}, {5, 2}, {5, 4}, {3, 4},
                                       {3, 3}, {4, 3}, {4, 2.5}, {2, 2.5}, {2, 5}, {6, 5}, {6, 1}, {0, 1}};
    hold(concave_quad, 4, "concave quad");
    hold(turned_quad, 4, "turned quad");
    hold(arrow, 4, "arrow");
    hold(l_shape, 6, "L");
    hold(straight, 8, "straight corners");
    hold(comb, 11, "comb");
    hold(ring, 10, "ring");
    hold(spiral, 16, "spiral");
}

/// Stars around a point, of up to 2,000 corners, turned both ways.
TEST_WITHIN(test_stars, begin, end) {
    static double outline[2000][2], turned[2000][2];
    static const uint32_t counts[] = {5, 17, 100, 2000};
    check_random random = {11};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        for (uint32_t k = 0; k < counts[i]; k++) {
            // Dyadic numbers, so that a shift is exact.
            const double angle = 6.283185307179586 * k / counts[i], radius = check_uniform(&random, 0.2, 1);
            outline[k][0] = round(radius * cos(angle) * 0x1p24) * 0x1p-24;
            outline[k][1] = round(radius * sin(angle) * 0x1p24) * 0x1p-24;
            memcpy(turned[counts[i] - 1 - k], outline[k], sizeof outline[k]);
        }
        hold((const double(*)[2])outline, counts[i], "star");
        hold((const double(*)[2])turned, counts[i], "turned star");
    }
}

/// What has no area, crosses itself, repeats itself or is no number becomes some triangles, and ends soon.
TEST_WITHIN(test_degenerate, begin, end) {
    static const double point[][2] = {{1, 1}, {1, 1}, {1, 1}, {1, 1}},
                        line[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1.5, 0}};
    static const double bow[][2] = {{0, 0}, {2, 2}, {2, 0}, {0, 2}},
                        star[][2] = {{0, 3}, {2, -3}, {-3, 1}, {3, 1}, {-2, -3}};
    static const double nan[][2] = {{0, 0}, {1, NAN}, {1, 1}, {0, 1}, {-1, 0.5}},
                        huge[][2] = {{0, 0}, {1e200, 0}, {1e200, 1e200}, {5e199, 1e199}, {0, 1e200}};
    const struct {
        const double (*outline)[2];
        uint32_t count;
    } cases[] = {{point, 4}, {line, 5}, {bow, 4}, {star, 5}, {nan, 5}, {huge, 5}};
    static const double nowhere[3] = {0, 0, 0};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        OWNED(ewa_mesh_build_close) ewa_mesh_build build;
        cut(cases[i].outline, cases[i].count, 0, nowhere, &build);
        assert_true(build.corners.count >= 1 && build.corners.count <= cases[i].count - 2);
    }
    // A zigzag that crosses itself at every step, and a random tangle, of many corners.
    enum { MANY = 60000 };
    double(*outline)[2] = malloc(MANY * sizeof *outline);
    check_random random = {5};
    for (int kind = 0; kind < 3; kind++) {
        for (uint32_t k = 0; k < MANY; k++) {
            outline[k][0] = kind == 0   ? (double)(k % 2 ? MANY - k : k)
                            : kind == 1 ? check_uniform(&random, 0, 1)
                                        : (double)(k / 4 % 2 ? -1.0 : 1.0) * k;
            outline[k][1] = kind == 0   ? (double)(k % 3)
                            : kind == 1 ? check_uniform(&random, 0, 1)
                                        : (double)(k % 4) * (double)(k % 7);
        }
        OWNED(ewa_mesh_build_close) ewa_mesh_build build;
        cut((const double(*)[2])outline, MANY, 0, nowhere, &build);
        assert_true(build.corners.count >= 1 && build.corners.count <= MANY - 2);
    }
    free(outline);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
