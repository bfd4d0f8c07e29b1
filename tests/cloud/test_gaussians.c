// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of Gaussians: moved ones have the covariances and the colours that the map gives; surfels of them.
#include "../check.h"

#include "cloud/gaussian_tree.h"
#include "cloud/gaussian_turn.h"

#include <math.h>

enum { COUNT = 20 };

static void fill(ewa_context *context, uint32_t sh_degree, check_random *random, ewa_gaussians *set) {
    assert_int_equal(ewa_gaussians_create(context, COUNT, sh_degree, set), EWA_OK);
    const uint32_t numbers = 3 * (sh_degree + 1) * (sh_degree + 1);
    for (uint32_t i = 0; i < COUNT; i++) {
        double norm2 = 0;
        for (int k = 0; k < 4; k++) {
            set->rotations[4 * i + (uint32_t)k] = (float)check_uniform(random, -1, 1);
            norm2 += pow((double)set->rotations[4 * i + (uint32_t)k], 2);
        }
        for (uint32_t k = 0; k < 4; k++) set->rotations[4 * i + k] /= (float)sqrt(norm2);
        for (uint32_t k = 0; k < 3; k++) {
            set->centers[3 * i + k] = (float)check_uniform(random, -2, 2);
            set->scales[3 * i + k] = (float)check_uniform(random, 0.01, 1);
        }
        set->opacities[i] = (float)check_uniform(random, 0, 1);
        for (uint32_t k = 0; k < numbers; k++)
            set->harmonics[i * numbers + k] = (float)check_uniform(random, -1, 1);
    }
    set->origin[0] = 10;
}

static void covariance(const ewa_gaussians *set, uint32_t i, double sigma[9]) {
    const float *q = set->rotations + 4 * i;
    const double w = (double)q[0], x = (double)q[1], y = (double)q[2], z = (double)q[3];
    const double r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            sigma[3 * a + b] = 0;
            for (int k = 0; k < 3; k++)
                sigma[3 * a + b] +=
                    r[3 * a + k] * r[3 * b + k] * pow((double)set->scales[3 * i + (uint32_t)k], 2);
        }
}

static double red_in(const ewa_gaussians *set, uint32_t i, const double direction[3]) {
    double values[25], sum = 0;
    const uint32_t count = (set->sh_degree + 1) * (set->sh_degree + 1);
    ewa_sh_values(direction, set->sh_degree, values);
    for (uint32_t k = 0; k < count; k++) sum += values[k] * (double)set->harmonics[3 * (i * count + k)];
    return sum;
}

static void check_moved(const double m[16], const double turn[9], uint32_t sh_degree) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    check_random random = {7};
    OWNED(ewa_gaussians_free) ewa_gaussians before, after;
    fill(context, sh_degree, &random, &before);
    random.state = 7;
    fill(context, sh_degree, &random, &after);
    assert_int_equal(ewa_gaussians_transform(&after, m), EWA_OK);
    for (uint32_t i = 0; i < COUNT; i++) {
        double sigma[9], moved[9];
        covariance(&before, i, sigma);
        covariance(&after, i, moved);
        for (int a = 0; a < 3; a++) {
            double center = m[4 * a + 3];
            for (int k = 0; k < 3; k++)
                center += m[4 * a + k] * (before.origin[k] + (double)before.centers[3 * i + (uint32_t)k]);
            assert_true(fabs(center - after.origin[a] - (double)after.centers[3 * i + (uint32_t)a]) < 1e-5);
            for (int b = 0; b < 3; b++) {
                double wanted = 0;
                for (int k = 0; k < 3; k++)
                    for (int l = 0; l < 3; l++) wanted += m[4 * a + k] * sigma[3 * k + l] * m[4 * b + l];
                assert_true(fabs(wanted - moved[3 * a + b]) < 2e-5);
            }
        }
        const double from[3] = {0.48, -0.6, 0.64};
        double to[3];
        for (int r = 0; r < 3; r++)
            to[r] = turn[3 * r] * from[0] + turn[3 * r + 1] * from[1] + turn[3 * r + 2] * from[2];
        assert_true(fabs(red_in(&before, i, from) - red_in(&after, i, to)) < 1e-5);
    }
}

TEST(similar) {
    // A turn about a slanted axis, twice as large.
    const double turn[9] = {2.0 / 3,  -1.0 / 3, 2.0 / 3, 2.0 / 3, 2.0 / 3,
                            -1.0 / 3, -1.0 / 3, 2.0 / 3, 2.0 / 3};
    for (uint32_t degree = 0; degree <= 4; degree++) {
        double m[16] = {0};
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) m[4 * r + c] = 2 * turn[3 * r + c];
        m[3] = 1, m[7] = -2, m[11] = 3, m[15] = 1;
        check_moved(m, turn, degree);
    }
}

TEST(mirrored) {
    const double m[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    check_moved(m, (const double[]){1, 0, 0, 0, -1, 0, 0, 0, 1}, 4);
}

TEST(stretched) {
    const double m[16] = {2, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    check_moved(m, (const double[]){1, 0, 0, 0, 1, 0, 0, 0, 1}, 2);
    const double sheared[16] = {1, 0.5, 0, 0, 0, 1, 0.25, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    check_moved(sheared, (const double[]){1, 0, 0, 0, 1, 0, 0, 0, 1}, 2);
}

/// Flat ones stay flat, with the third axis as the normal.
TEST_ON(flat, 1) {
    OWNED(ewa_gaussians_free) ewa_gaussians set;
    assert_int_equal(ewa_gaussians_create(context, 1, 0, &set), EWA_OK);
    set.flat = true;
    set.scales[0] = 1, set.scales[1] = 2, set.rotations[0] = 1;
    const double m[16] = {1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 3, 0, 0, 0, 0, 1};
    assert_int_equal(ewa_gaussians_transform(&set, m), EWA_OK);
    assert_true(fabs((double)set.scales[0] - 1) < 1e-6 && fabs((double)set.scales[1] - 2) < 1e-6);
    assert_true(set.scales[2] == 0 && fabs(fabs((double)set.rotations[0]) - 1) < 1e-6);
    const double zero[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    assert_int_equal(ewa_gaussians_transform(&set, zero), EWA_ERROR_NUMERIC);
    const double last[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    assert_int_equal(ewa_gaussians_transform(&set, last), EWA_ERROR_ARGUMENT);
}

/// The shortest axis is the normal, wherever it is; colours are of the display, clouds hold light.
TEST(surfels) {
    static const float scales[3][3] = {{3, 2, 1}, {3, 1, 2}, {1, 3, 2}};
    for (int shortest = 2, n = 0; shortest >= 0; shortest--, n++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        assert_int_equal(ewa_gaussians_create(context, 1, 1, &set), EWA_OK);
        memcpy(set.scales, scales[n], sizeof scales[n]);
        // A quarter of a turn about z: x becomes y.
        set.rotations[0] = set.rotations[3] = (float)sqrt(0.5);
        set.opacities[0] = 0.25f;
        set.harmonics[0] = (float)(0.5 / 0.28209479177387814); // white
        set.harmonics[2] = -9;
        set.origin[1] = 5;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
        assert_int_equal(ewa_gaussians_to_cloud(&set, &cloud), EWA_OK);
        static const char *const names[] = {EWA_TANGENT_U, EWA_TANGENT_V, EWA_NORMAL, EWA_COLOR};
        float numbers[4][4];
        for (int k = 0; k < 4; k++) ewa_attribute_read_f32(ewa_cloud_find(cloud, names[k]), 0, 1, numbers[k]);
        static const int turned[3] = {1, 0, 2};
        const int u = (shortest + 1) % 3, v = (shortest + 2) % 3;
        assert_true(fabs(fabs((double)numbers[0][turned[u]]) - (double)set.scales[u]) < 1e-6);
        assert_true(fabs(fabs((double)numbers[1][turned[v]]) - (double)set.scales[v]) < 1e-6);
        assert_true(fabs(fabs((double)numbers[2][turned[shortest]]) - 1) < 1e-6);
        double across = 0; // u x v along the normal
        for (int k = 0; k < 3; k++)
            across +=
                (double)numbers[2][k] * ((double)numbers[0][(k + 1) % 3] * (double)numbers[1][(k + 2) % 3] -
                                         (double)numbers[0][(k + 2) % 3] * (double)numbers[1][(k + 1) % 3]);
        assert_true(across > 0);
        assert_true(fabs((double)numbers[3][0] - 1) < 1e-6);
        assert_true(fabs((double)numbers[3][1] - 0.21404114) < 1e-6 && numbers[3][2] == 0);
        assert_true(numbers[3][3] == 0.25f);
        float opacity, size;
        ewa_attribute_read_f32(ewa_cloud_find(cloud, "opacity"), 0, 1, &opacity);
        ewa_attribute_read_f32(ewa_cloud_find(cloud, "size"), 0, 1, &size);
        assert_true(opacity == 0.25f && size == fmaxf(set.scales[u], set.scales[v]));
        double origin[3];
        ewa_cloud_origin(cloud, origin);
        assert_true(origin[1] == 5);
    }
}

static double mean_area(const float *scales) {
    const double a = (double)scales[0], b = (double)scales[1], c = (double)scales[2];
    return sqrt((a * a * b * b + b * b * c * c + c * c * a * a) / 3);
}

/// One for several has their mean, covariance and colours, each by its opacity and its area, written out in double precision.
TEST_ON(merged, 1) {
    check_random random = {3};
    OWNED(ewa_gaussians_free) ewa_gaussians set, one;
    uint32_t members[COUNT];
    ewa_gaussian_mass masses[COUNT];
    fill(context, 3, &random, &set);
    assert_int_equal(ewa_gaussians_create(context, 2, 3, &one), EWA_OK);
    double mass = 0, depth = 0, mean[3] = {0}, wanted[9] = {0}, got[9], red = 0, apart2 = 0;
    const double direction[3] = {0.48, -0.6, 0.64};
    for (uint32_t i = 0; i < COUNT; i++) {
        members[i] = COUNT - 1 - i;
        const double area = mean_area(set.scales + 3 * i), opacity = fmin((double)set.opacities[i], 0.99);
        mass += opacity * area, depth -= log(1 - opacity) * area;
        red += opacity * area * red_in(&set, i, direction);
        for (uint32_t k = 0; k < 3; k++) mean[k] += opacity * area * (double)set.centers[3 * i + k];
    }
    for (int k = 0; k < 3; k++) mean[k] /= mass;
    for (uint32_t i = 0; i < COUNT; i++) {
        const double share = mean_area(set.scales + 3 * i) * fmin((double)set.opacities[i], 0.99) / mass;
        covariance(&set, i, got);
        for (uint32_t a = 0; a < 3; a++) {
            const double off = (double)set.centers[3 * i + a] - mean[a];
            apart2 += share * off * off;
            for (uint32_t b = 0; b < 3; b++) wanted[3 * a + b] += share * (got[3 * a + b] + off * ((double)set.centers[3 * i + b] - mean[b]));
        }
    }
    for (uint32_t i = 0; i < COUNT; i++) ewa_gaussian_weigh(&set, members[i], &masses[i]);
    assert_true(fabs(ewa_gaussians_merge(&set, members, masses, COUNT, &one, 1) - apart2) < 1e-9);
    covariance(&one, 1, got);
    for (uint32_t k = 0; k < 3; k++) assert_true(fabs((double)one.centers[3 + k] - mean[k]) < 1e-6);
    for (int k = 0; k < 9; k++) assert_true(fabs(got[k] - wanted[k]) < 2e-6);
    assert_true(fabs(red_in(&one, 1, direction) - red / mass) < 1e-5);
    const double area = mean_area(one.scales + 3);
    assert_true(fabs((double)one.opacities[1] - fmin(mass / area, 1 - exp(-depth / area))) < 1e-6);
}

/// Opacities of one for four: alike ones at one place let through what they do one behind the other; those far from each other take
/// as much light as before; those that cover a place are as opaque as each is. Nothing of the opaque gets more than opaque.
TEST_ON(merged_opacities, 1) {
    static const struct {
        double apart, opacity, wanted;
    } cases[] = {{0, 0.3, 1 - 0.7 * 0.7 * 0.7 * 0.7}, {0, 1, 1}, {100, 0.5, 0}, {1.4, 0.95, 0.95}};
    const uint32_t members[4] = {0, 1, 2, 3};
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        OWNED(ewa_gaussians_free) ewa_gaussians set, one;
        assert_int_equal(ewa_gaussians_create(context, 4, 0, &set), EWA_OK);
        assert_int_equal(ewa_gaussians_create(context, 1, 0, &one), EWA_OK);
        for (uint32_t i = 0; i < 4; i++) {
            set.centers[3 * i] = (float)(i % 2 * cases[c].apart), set.centers[3 * i + 1] = (float)(i / 2 * cases[c].apart);
            set.scales[3 * i] = set.scales[3 * i + 1] = 1, set.scales[3 * i + 2] = 0.01f;
            set.rotations[4 * i] = 1;
            set.opacities[i] = (float)cases[c].opacity;
        }
        ewa_gaussian_mass masses[4];
        for (uint32_t i = 0; i < 4; i++) ewa_gaussian_weigh(&set, i, &masses[i]);
        ewa_gaussians_merge(&set, members, masses, 4, &one, 0);
        const double light = (double)one.opacities[0] * mean_area(one.scales), before = 4 * cases[c].opacity * mean_area(set.scales);
        print_message("%g apart: opacity %g, light %g of %g\n", cases[c].apart, (double)one.opacities[0], light, before);
        if (cases[c].wanted > 0)
            assert_true(fabs((double)one.opacities[0] - cases[c].wanted) < (cases[c].apart > 0 ? 0.06 : 1e-6));
        else
            assert_true(fabs(light - before) < 1e-3 * before);
        assert_true(one.opacities[0] <= 1);
    }
}

/// Cuts of trees over two thin rods, of which the second has one Gaussian of a hundred, over places that are the same, and over what cannot be
/// seen: every member is in one group, and from twelve groups on none is of both rods.
TEST_ON(groups, 1) {
    enum { MANY = 3000 };
    static const uint32_t group_counts[] = {1, 2, 3, 12, 47, 188, 750, MANY};
    ewa_gaussian_tree *tree = malloc(sizeof *tree);
    uint32_t *members = malloc(MANY * sizeof *members);
    uint8_t *seen = malloc(MANY);
    assert_true(tree && members && seen);
    check_random random = {7};
    for (int n = 0; n < 3; n++) {
        ewa_gaussians set;
        assert_int_equal(ewa_gaussians_create(context, MANY, 0, &set), EWA_OK);
        for (uint32_t i = 0; i < MANY; i++) {
            members[i] = (i * 7) % MANY; // 7 and MANY have no common divisor
            const bool second = i % 100 == 99;
            if (n == 0) set.centers[3 * i] = second ? 3 : -0.5f, set.centers[3 * i + 1] = (float)check_uniform(&random, -1, 1);
            if (n == 2) set.centers[3 * i + 2] = (float)check_uniform(&random, -1, 1);
            for (size_t k = 0; k < 3; k++) set.scales[3 * i + k] = 0.01f;
            set.rotations[4 * i] = 1;
            set.opacities[i] = n == 2 ? 0 : 0.5f;
        }
        ewa_gaussian_tree_make(tree, &set, members, MANY);
        double before = INFINITY;
        for (size_t c = 0; c < sizeof group_counts / sizeof *group_counts; c++) {
            double cost = 0;
            ewa_gaussian_tree_cut(tree, group_counts[c]);
            assert_int_equal(tree->group_count, group_counts[c]);
            memset(seen, 0, MANY);
            for (uint32_t g = 0, first = 0; g < tree->group_count; g++) {
                const ewa_gaussian_node *node = &tree->nodes[tree->groups[g]];
                assert_int_equal(node->first, first);
                first += node->count;
                cost += node->cost;
                for (uint32_t i = node->first; i < first; i++) {
                    assert_false(seen[tree->members[i]]++);
                    if (n == 0 && group_counts[c] >= 12) assert_int_equal(set.centers[3 * (size_t)tree->members[i]] > 0, set.centers[3 * (size_t)tree->members[node->first]] > 0);
                }
            }
            assert_null(memchr(seen, 0, MANY));
            assert_true(cost < before || n > 0);
            before = cost;
        }
        ewa_gaussians_free(&set);
    }
    free(seen);
    free(members);
    free(tree);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
