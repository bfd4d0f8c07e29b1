// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clipping of segments and polygons against brute-force sampling, hyperbolic interpolation against three
// dimensions.
#include <fenv.h>
#include <string.h>

#include "math/check_math.h"

enum { SEGMENTS = 4000, SAMPLES = 64, POLYGONS = 400 };

/// The smallest boundary coordinate of a point with the sign of its w, relative to its size: visible where >=
/// 0.
static double visibility(ewa_vec4 p) {
    double s = p.w < 0 ? -1 : 1;
    double size = fabs(p.x) + fabs(p.y) + fabs(p.z) + fabs(p.w);
    double smallest = fmin(s * p.z, s * (p.w - p.z));
    smallest = fmin(smallest, fmin(s * (p.w + p.x), s * (p.w - p.x)));
    return fmin(smallest, fmin(s * (p.w + p.y), s * (p.w - p.y))) / size;
}

static ewa_vec4 mix(ewa_vec4 a, ewa_vec4 b, double t) {
    return vec4_add(vec4_scale(a, 1 - t), vec4_scale(b, t));
}

/// Points near, on and beside the frustum, of both signs of w; every fourth on whole numbers, which is
/// degenerate.
static ewa_vec4 random_clip_point(check_random *random, int i) {
    double w = check_uniform(random, -1, 2);
    ewa_vec4 p = {check_uniform(random, -1.5, 1.5), check_uniform(random, -1.5, 1.5),
                  check_uniform(random, -0.5, 1.5), w};
    if (i % 4 == 0) p = vec4_make(rint(p.x), rint(p.y), rint(p.z), rint(p.w));
    if (i % 16 == 1) p.w = 0;
    if (i % 16 == 2) p.z = p.w;
    return p;
}

static void check_part(ewa_vec4 p1, ewa_vec4 p2, const ewa_segment_part *part, double sign) {
    assert_true(part->alpha[0] >= 0 && part->alpha[0] <= part->alpha[1] && part->alpha[1] <= 1);
    for (int e = 0; e < 2; e++) {
        ewa_vec4 expected = mix(p1, p2, part->alpha[e]);
        check_numbers(&part->end[e], &expected, 4, 1e-14);
        assert_true(sign * part->end[e].w > 0 && visibility(part->end[e]) >= 0);
    }
}

TEST(test_segments_by_sampling) {
    check_random random = {1};
    int seen[4] = {0};
    for (int i = 0; i < SEGMENTS; i++) {
        ewa_vec4 p1 = random_clip_point(&random, i), p2 = random_clip_point(&random, i / 4);
        ewa_segment_part parts[2];
        uint32_t visible = 99;
        ewa_status status = ewa_clip_segment(p1, p2, parts, &visible);
        if (vec4_dot(p1, p1) == 0 || vec4_dot(p2, p2) == 0) {
            assert_int_equal(status, EWA_ERROR_NUMERIC);
            continue;
        }
        assert_int_equal(status, EWA_OK);
        seen[visible]++;
        for (int k = 0; k < 2; k++)
            if (visible & 1u << k) check_part(p1, p2, &parts[k], k ? -1 : 1);
        for (int s = 0; s <= SAMPLES; s++) {
            double alpha = (double)s / SAMPLES;
            ewa_vec4 p = mix(p1, p2, alpha);
            double v = visibility(p);
            if (fabs(v) < 1e-12 || fabs(p.w) < 1e-9) continue; // on the boundary, to within rounding
            int k = p.w < 0;
            bool inside = (visible & 1u << k) && alpha >= parts[k].alpha[0] && alpha <= parts[k].alpha[1];
            assert_true(inside == (v > 0));
        }
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k] > SEGMENTS / 100); // every case occurs, two parts too
}

/// An external segment: from one side of the picture through infinity to the other.
TEST(test_external_segment) {
    ewa_segment_part parts[2];
    uint32_t visible;
    // (0.5, 0) with w = 1 and (-0.5, 0) with w = -1: what is drawn is the outside of the two, cut at the
    // picture's edges.
    assert_int_equal(
        ewa_clip_segment(vec4_make(0.5, 0, 0.5, 1), vec4_make(0.5, 0, -0.5, -1), parts, &visible), EWA_OK);
    assert_int_equal(visible, EWA_VISIBLE_POSITIVE | EWA_VISIBLE_NEGATIVE);
    double xyz[3];
    static const double expected[2][2] = {{0.5, 1}, {-1, -0.5}};
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++) {
            assert_int_equal(ewa_point3_divide(parts[k].end[e], xyz), EWA_OK);
            check_near(xyz[0], expected[k][e], 1e-15);
        }
    // The same segment with the second end's other representative is the inside: one part.
    assert_int_equal(ewa_clip_segment(vec4_make(0.5, 0, 0.5, 1), vec4_make(-0.5, 0, 0.5, 1), parts, &visible),
                     EWA_OK);
    assert_int_equal(visible, EWA_VISIBLE_POSITIVE);
}

TEST(test_degenerate_segments) {
    ewa_segment_part parts[2];
    uint32_t visible;
    ewa_vec4 inside = {0.1, 0.2, 0.3, 1}, outside = {2, 0, 0.5, 1}, corner = {1, 1, 1, 1};
    assert_int_equal(ewa_clip_segment(inside, inside, parts, &visible), EWA_OK); // a point
    assert_int_equal(visible, EWA_VISIBLE_POSITIVE);
    assert_int_equal(ewa_clip_segment(outside, outside, parts, &visible), EWA_OK);
    assert_int_equal(visible, 0);
    assert_int_equal(ewa_clip_segment(vec4_make(2, 0, 1, 1), vec4_make(0, 2, 1, 1), parts, &visible), EWA_OK);
    assert_int_equal(visible, EWA_VISIBLE_POSITIVE); // touches the frustum in a corner
    check_numbers(&parts[0].end[0], &corner, 4, 0);
    check_numbers(&parts[0].end[1], &corner, 4, 0);

    // p2 = -k p1 is the same point: the segment runs through [0 0 0 0], which is none.
    check_random random = {2};
    for (int i = 0; i < 1000; i++) {
        ewa_vec4 p = random_clip_point(&random, 3 + 4 * i), q = vec4_scale(p, -ldexp(1, i % 15 - 7));
        assert_int_equal(ewa_clip_segment(p, q, parts, &visible), EWA_OK);
        bool is_visible = visibility(p) >= 0;
        assert_int_equal(visible, is_visible ? EWA_VISIBLE_POSITIVE | EWA_VISIBLE_NEGATIVE : 0);
        for (int e = 0; e < 4 && is_visible; e++) check_same(&parts[e / 2].end[e % 2], &p, 4, 1e-15);
        // Rounded, the segment passes by [0 0 0 0] and any of it may be visible, as long as it is.
        q = vec4_scale(p, -check_uniform(&random, 0.01, 100));
        assert_int_equal(ewa_clip_segment(p, q, parts, &visible), EWA_OK);
        for (int k = 0; k < 2; k++)
            if (visible & 1u << k) check_part(p, q, &parts[k], k ? -1 : 1);
    }
    // Both ends are directions: nothing of the line at infinity is in the frustum.
    assert_int_equal(ewa_clip_segment(vec4_make(1, 0, 0, 0), vec4_make(0, 1, 0, 0), parts, &visible), EWA_OK);
    assert_int_equal(visible, 0);
    // Representatives do not matter, however large or small.
    for (int exponent = -1000; exponent <= 1023; exponent += 7) {
        ewa_vec4 a = vec4_scale(inside, ldexp(1, exponent)),
                 b = vec4_scale(vec4_make(1.5, 0, 0.3, 1), ldexp(1, exponent));
        assert_int_equal(ewa_clip_segment(a, b, parts, &visible), EWA_OK);
        assert_int_equal(visible, EWA_VISIBLE_POSITIVE);
        check_near(parts[0].alpha[1], 0.9 / 1.4, 1e-15);
        a.x = ldexp(-1.5, exponent); // w + x of the other end overflows at the top
        assert_int_equal(ewa_clip_segment(a, b, parts, &visible), EWA_OK);
        check_near(parts[0].alpha[0], 0.5 / 3, 1e-15);
        check_near(parts[0].alpha[1], 2.5 / 3, 1e-15);
    }
}

TEST(test_alphas_of_all_planes) {
    check_random random = {3};
    for (int i = 0; i < SEGMENTS; i++) {
        ewa_vec4 p1 = random_clip_point(&random, i), p2 = random_clip_point(&random, i / 4);
        double alpha[6];
        uint32_t crossed;
        assert_int_equal(ewa_clip_alphas(p1, p2, alpha, &crossed), EWA_OK);
        for (int k = 0; k < 6; k++) {
            ewa_vec4 p = mix(p1, p2, alpha[k]);
            const double b[6] = {p.w + p.x, p.w - p.x, p.w + p.y, p.w - p.y, p.z, p.w - p.z};
            if (crossed & 1u << k)
                check_near(b[k], 0, 1e-13 * (1 + fabs(alpha[k])));
            else
                assert_true(alpha[k] == 0);
        }
    }
    double alpha[6];
    uint32_t crossed;
    assert_int_equal(ewa_clip_alphas(vec4_make(0, 0, 0, 1), vec4_make(0, 0.5, 0, 1), alpha, &crossed),
                     EWA_OK);
    assert_int_equal(crossed, 1 << EWA_CLIP_BOTTOM | 1 << EWA_CLIP_TOP); // parallel to the others
}

/// A convex polygon in a random plane of the four-dimensional space.
static void random_polygon(check_random *random, ewa_vec4 *points, uint32_t count, int i) {
    ewa_vec4 center = random_clip_point(random, i), a = random_clip_point(random, 3),
             b = random_clip_point(random, 3);
    if (i % 2) a.w = b.w = 0; // w is the same all over: parallel to the picture
    for (uint32_t k = 0; k < count; k++) {
        double angle = 2 * acos(-1) * k / count;
        points[k] = vec4_add(center, vec4_add(vec4_scale(a, cos(angle)), vec4_scale(b, sin(angle))));
    }
}

/// How far a place on the screen is inside a convex polygon (negative: outside).
static double inside_by(const ewa_vec4 *points, uint32_t count, double x, double y) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        ewa_vec4 p = points[i], q = points[(i + 1) % count];
        double px = p.x / p.w, py = p.y / p.w, qx = q.x / q.w, qy = q.y / q.w,
               length = hypot(qx - px, qy - py);
        if (length < 1e-9) continue;
        double distance = ((qx - px) * (y - py) - (qy - py) * (x - px)) / length;
        low = fmin(low, distance);
        high = fmax(high, distance);
    }
    return count ? fmax(low, -high) : -INFINITY;
}

TEST(test_polygons_by_sampling) {
    check_random random = {4};
    int seen[4] = {0};
    enum { MAXIMUM = 9 };
    for (int i = 0; i < POLYGONS; i++) {
        uint32_t count = 3 + (uint32_t)i % (MAXIMUM - 2), clipped_count[2];
        ewa_vec4 points[MAXIMUM], clipped[3 * (MAXIMUM + 6)], functional[2];
        double attributes[2 * MAXIMUM], clipped_attributes[2 * 3 * (MAXIMUM + 6)];
        random_polygon(&random, points, count, i);
        for (int a = 0; a < 2; a++) {
            functional[a] = check_random_vec4(&random);
            for (uint32_t k = 0; k < count; k++) attributes[2 * k + a] = vec4_dot(functional[a], points[k]);
        }
        assert_int_equal(
            ewa_clip_polygon(points, attributes, count, 2, clipped, clipped_attributes, clipped_count),
            EWA_OK);
        seen[(clipped_count[0] > 0) + 2 * (clipped_count[1] > 0)]++;
        for (int part = 0; part < 2; part++) {
            size_t first = part * (count + 6);
            assert_true(clipped_count[part] <= count + 6 && clipped_count[part] != 1 &&
                        clipped_count[part] != 2);
            for (size_t k = first; k < first + clipped_count[part]; k++) {
                assert_true((part ? -clipped[k].w : clipped[k].w) > 0 && visibility(clipped[k]) >= 0);
                for (int a = 0; a < 2; a++)
                    check_near(clipped_attributes[2 * k + a], vec4_dot(functional[a], clipped[k]), 1e-13);
            }
        }
        for (int s = 0; s < 200;
             s++) { // a point of the polygon: visible exactly where one of the parts covers it
            uint32_t k = (uint32_t)s % (count - 2) + 1;
            double u = check_uniform(&random, 0, 1), v = check_uniform(&random, 0, 1), xyz[3];
            ewa_vec4 p = mix(points[0], mix(points[k], points[k + 1], v), sqrt(u));
            if (ewa_point3_divide(p, xyz) != EWA_OK || fabs(visibility(p)) < 1e-6 || fabs(p.w) < 1e-6)
                continue;
            size_t part = p.w < 0, other = 1 - part;
            double inside = inside_by(clipped + part * (count + 6), clipped_count[part], xyz[0], xyz[1]);
            assert_true(visibility(p) > 0 ? inside > -1e-7 : inside < 1e-7);
            assert_true(inside_by(clipped + other * (count + 6), clipped_count[other], xyz[0], xyz[1]) <
                        1e-7);
        }
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k] > 5);
}

/// Neighbours share an edge in opposite directions; the corners that clipping makes on it are the same bytes.
TEST(test_polygons_stay_joined) {
    check_random random = {5};
    int shared = 0;
    for (int i = 0; i < 1000; i++) {
        ewa_vec4 p = random_clip_point(&random, 3), q = random_clip_point(&random, 3), clipped[2][27];
        ewa_vec4 triangles[2][3] = {{p, q, random_clip_point(&random, 3)},
                                    {q, p, random_clip_point(&random, 3)}};
        uint32_t count[2][2];
        for (int t = 0; t < 2; t++)
            assert_int_equal(ewa_clip_polygon(triangles[t], NULL, 3, 0, clipped[t], NULL, count[t]), EWA_OK);
        ewa_segment_part parts[2];
        uint32_t visible;
        assert_int_equal(ewa_clip_segment(p, q, parts, &visible), EWA_OK);
        for (size_t k = 0; k < 2; k++) {
            if (!(visible & 1u << k) || parts[k].alpha[1] - parts[k].alpha[0] < 1e-6) continue;
            int found = 0;
            for (uint32_t a = 0; a < count[0][k]; a++)
                for (uint32_t b = 0; b < count[1][k]; b++)
                    found += memcmp(&clipped[0][9 * k + a], &clipped[1][9 * k + b], sizeof(ewa_vec4)) == 0;
            if (count[0][k] && count[1][k]) {
                assert_true(found >= 2);
                shared++;
            }
        }
    }
    assert_true(shared > 100);
}

TEST(test_polygon_input) {
    ewa_vec4 points[5] = {
        {0, 0, 0.5, 1}, {0.5, 0, 0.5, 1}, {0.5, 0.5, 0.5, 1}, {0, 0.5, 0.5, 1}, {9, 9, 9, 9}};
    ewa_vec4 clipped[3 * 11];
    uint32_t count[2];
    assert_int_equal(ewa_clip_polygon(points, NULL, 2, 0, clipped, NULL, count), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_clip_polygon(points, NULL, 1 << 21, 0, clipped, NULL, count), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_clip_polygon(points, NULL, 4, 0, clipped, NULL, count), EWA_OK); // inside: unchanged
    assert_true(count[0] == 4 && count[1] == 0 && memcmp(points, clipped, 4 * sizeof points[0]) == 0);
    double attributes[4] = {1, 2, NAN, 4}, out[3 * 10];
    assert_int_equal(ewa_clip_polygon(points, attributes, 4, 1, clipped, out, count), EWA_ERROR_NUMERIC);
    points[2].x = INFINITY;
    assert_int_equal(ewa_clip_polygon(points, NULL, 4, 0, clipped, NULL, count), EWA_ERROR_NUMERIC);
    // A star is not convex: what comes out is cut off, not out of bounds, and still inside the frustum.
    check_random random = {6};
    for (int i = 0; i < 1000; i++) {
        ewa_vec4 star[16], result[3 * 22 + 1];
        for (int k = 0; k < 16; k++) star[k] = random_clip_point(&random, i + k);
        memset(&result[66], 0x55, sizeof result[66]);
        ewa_vec4 guard = result[66];
        assert_int_equal(ewa_clip_polygon(star, NULL, 16, 0, result, NULL, count), EWA_OK);
        assert_true(count[0] <= 22 && count[1] <= 22 && memcmp(&guard, &result[66], sizeof guard) == 0);
        for (uint32_t k = 0; k < count[0]; k++) assert_true(visibility(result[k]) >= 0);
    }
}

/// Object space, a triangle with attributes; the map of a frustum; the picture: the same numbers both ways.
TEST(test_hyperbolic_is_3d_interpolation) {
    check_random random = {7};
    ewa_mat4 map;
    assert_int_equal(check_window_map((const double[]){-0.7, 1.1, -0.4, 0.6}, 0.5, 20, false, &map), EWA_OK);
    for (int i = 0; i < 1000; i++) {
        ewa_vec4 corner[3], clip[3];
        double values[6];
        ewa_vec3 numerators[2], denominator;
        for (int k = 0; k < 3; k++) { // some corners behind the eye
            const double z = check_uniform(&random, -1, 9), y = check_uniform(&random, -4, 4);
            corner[k] = vec4_make(check_uniform(&random, -4, 4), y, z, 1);
            clip[k] = ewa_point3_transform(corner[k], &map);
            values[2 * k] = check_uniform(&random, -1, 1);
            values[2 * k + 1] = check_uniform(&random, 5, 9);
        }
        assert_int_equal(ewa_hyperbolic_fit(clip, values, 2, numerators, &denominator), EWA_OK);
        for (int s = 0; s < 10; s++) {
            double a = check_uniform(&random, 0, 1), b = check_uniform(&random, 0, 1 - a), c = 1 - a - b,
                   xyz[3], value;
            ewa_vec4 p = vec4_add(vec4_scale(corner[0], a),
                                  vec4_add(vec4_scale(corner[1], b), vec4_scale(corner[2], c)));
            if (fabs(p.z) < 0.05) continue;
            assert_int_equal(ewa_point3_divide(ewa_point3_transform(p, &map), xyz), EWA_OK);
            for (int n = 0; n < 2; n++) {
                assert_int_equal(ewa_hyperbolic_at(numerators[n], denominator, xyz[0], xyz[1], &value),
                                 EWA_OK);
                check_near(value, a * values[n] + b * values[2 + n] + c * values[4 + n], 1e-8);
            }
        }
        // Along an edge by the two w alone.
        double t = check_uniform(&random, 0.01, 0.99), alpha, x[3], x1[3], x2[3];
        if (fabs(corner[0].z) < 0.05 || fabs(corner[1].z) < 0.05) continue;
        if (ewa_hyperbolic_alpha(clip[0].w, clip[1].w, t, &alpha) != EWA_OK || fabs(alpha) > 50) continue;
        assert_int_equal(ewa_point3_divide(clip[0], x1), EWA_OK);
        assert_int_equal(ewa_point3_divide(clip[1], x2), EWA_OK);
        assert_int_equal(ewa_point3_divide(mix(clip[0], clip[1], alpha), x), EWA_OK);
        for (int n = 0; n < 3; n++) // the point at alpha is seen at t
            check_near(x[n], (1 - t) * x1[n] + t * x2[n], 1e-9 * (1 + fabs(x1[n]) + fabs(x2[n])));
    }
    ewa_vec4 edge_on[3] = {{0, 0, 0, 1}, {1, 1, 0, 2}, {2, 2, 5, 3}};
    double values[3] = {1, 2, 3}, number;
    ewa_vec3 n, d;
    assert_int_equal(ewa_hyperbolic_fit(edge_on, values, 1, &n, &d), EWA_ERROR_NUMERIC);
    edge_on[1].x = NAN;
    assert_int_equal(ewa_hyperbolic_fit(edge_on, values, 1, &n, &d), EWA_ERROR_NUMERIC);
    edge_on[1].x = 5;
    values[1] = INFINITY;
    assert_int_equal(ewa_hyperbolic_fit(edge_on, values, 1, &n, &d), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_hyperbolic_at(vec3_make(1, 0, 0), vec3_make(1, 0, -0.5), 0.5, 0, &number),
                     EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_hyperbolic_at(vec3_make(1, 0, 0), vec3_make(1, 0, 1), NAN, 0, &number),
                     EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_hyperbolic_alpha(1, -1, 0.5, &number), EWA_ERROR_NUMERIC); // the vanishing point
    assert_int_equal(ewa_hyperbolic_alpha(NAN, -1, 0.5, &number), EWA_ERROR_NUMERIC);
}

TEST(test_not_finite) {
    double bad[3] = {NAN, INFINITY, -INFINITY}, alpha[6];
    ewa_segment_part parts[2];
    uint32_t bits = 77;
    for (int i = 0; i < 12; i++) {
        double c[4] = {0, 0, 0.5, 1};
        c[i % 4] = bad[i / 4];
        ewa_vec4 p = {c[0], c[1], c[2], c[3]}, good = {0, 0, 0.5, 1};
        assert_int_equal(ewa_clip_segment(p, good, parts, &bits), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_clip_segment(good, p, parts, &bits), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_clip_alphas(good, p, alpha, &bits), EWA_ERROR_NUMERIC);
        assert_int_equal(bits, 77);
    }
}

/// Every combination of w = 0 and zero boundary coordinates: no division by zero, nothing invalid.
TEST(test_no_division_by_zero) {
    feclearexcept(FE_ALL_EXCEPT);
    ewa_segment_part parts[2];
    uint32_t bits, count[2];
    double alpha[6];
    for (int i = 0; i < 81 * 81; i++) {
        double c[8];
        for (int k = 0, rest = i; k < 8; k++, rest /= 3) c[k] = rest % 3 - 1;
        ewa_vec4 p = {c[0], c[1], c[2], c[3]}, q = {c[4], c[5], c[6], c[7]},
                 triangle[3] = {p, q, {0, 0, 0, 0}};
        ewa_vec4 clipped[27];
        ewa_clip_segment(p, q, parts, &bits);
        ewa_clip_alphas(p, q, alpha, &bits);
        ewa_clip_polygon(triangle, NULL, 3, 0, clipped, NULL, count);
        ewa_hyperbolic_alpha(p.w, q.w, 0.5, alpha);
    }
    // Clang divides on both sides of a branch and takes the one that it needs: what it raises is not the
    // code's.
#if !defined(__clang__)
    assert_int_equal(fetestexcept(FE_DIVBYZERO | FE_INVALID), 0);
#endif
}

int main(void) { return RUN_TESTS(NULL, NULL); }
