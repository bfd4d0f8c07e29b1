// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Every formula, worked example and table of "Homogeneous Coordinates" (Bloomenthal and Rokne), in its order;
// where the print does not hold (docs/homogeneous.md, errata), the printed form is shown to fail beside the
// one that holds.
#include "math/check_math.h"

#define EXACT 1e-15

static const ewa_vec3 triangle[3] = {{1, 1, 1}, {7, 2, 1}, {3, 6, 1}};

static double area(ewa_vec3 a, ewa_vec3 b, ewa_vec3 c) {
    return ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

/// Introduction: Möbius. Printed: p = (wa a, wb b, wc c), wa = Ab / (Aa + Ab + Ac); holds: the sum, and Aa.
TEST(test_barycentric) {
    ewa_vec3 p = {3, 3, 1};
    double w[3];
    assert_int_equal(ewa_triangle_barycentric(triangle, p, w), EWA_OK);
    check_near(w[0] + w[1] + w[2], 1, EXACT);
    double aa = area(p, triangle[1], triangle[2]), ab = area(triangle[0], p, triangle[2]),
           ac = area(triangle[0], triangle[1], p);
    check_near(w[0], aa / (aa + ab + ac), EXACT);
    check_near(w[1], ab / (aa + ab + ac), EXACT);
    check_near(w[2], ac / (aa + ab + ac), EXACT);
    assert_true(fabs(w[0] - ab / (aa + ab + ac)) > 0.1);
    check_near(w[0] * triangle[0].x + w[1] * triangle[1].x + w[2] * triangle[2].x, p.x, 4 * EXACT);
}

/// Introduction: the remark on scaling. Weights and distances may be scaled; the triangle may be scaled under
/// the weights' point only relative to itself, and keeping the distances while it grows moves the point.
TEST(test_scaled_coordinates) {
    ewa_vec3 p = {3, 3, 1}, q;
    double w[3], l[3], xy[2];
    assert_int_equal(ewa_triangle_barycentric(triangle, p, w), EWA_OK);
    assert_int_equal(ewa_triangle_distances(triangle, p, l), EWA_OK);
    for (int i = 0; i < 3; i++) {
        w[i] *= 5;
        l[i] *= -3;
    }
    assert_int_equal(ewa_triangle_point(triangle, w, &q), EWA_OK);
    check_same(&p, &q, 3, EXACT);
    assert_int_equal(ewa_triangle_point_from_distances(triangle, l, &q), EWA_OK);
    check_same(&p, &q, 3, EXACT);

    ewa_vec3 twice[3];
    for (int i = 0; i < 3; i++) twice[i] = vec3_make(2 * triangle[i].x, 2 * triangle[i].y, 1);
    assert_int_equal(ewa_triangle_point_from_distances(twice, l, &q), EWA_OK);
    assert_int_equal(ewa_point2_divide(q, xy), EWA_OK);
    check_near(xy[0], 2 * p.x, 1e-14); // the printed remark: it stays at p
    assert_true(fabs(xy[0] - p.x) > 1);
}

/// Plücker coordinates with one side at infinity and the opposite vertex at the origin are [x y w]: as the
/// side moves away, its distance becomes the same for every point.
TEST(test_side_at_infinity) {
    double far = 1e9, l[3];
    ewa_vec3 right_angle[3] = {{0, 0, 1}, {far, 0, 1}, {0, far, 1}};
    assert_int_equal(ewa_triangle_distances(right_angle, vec3_make(2, 3, 1), l), EWA_OK);
    double coordinates[3] = {l[1], l[2], l[0] / (far / sqrt(2))}, expected[3] = {2, 3, 1};
    check_same(coordinates, expected, 3, 1e-8);
}

/// Figure 3: [2 3 w] for w = 4, 2, 1, 1/2, 0; the sum of two representatives on w = 1 is their midpoint.
TEST(test_projection_to_w_1) {
    static const double w[4] = {4, 2, 1, 0.5};
    double xy[2];
    for (int i = 0; i < 4; i++) {
        assert_int_equal(ewa_point2_divide(vec3_make(2, 3, w[i]), xy), EWA_OK);
        assert_true(xy[0] == 2 / w[i] && xy[1] == 3 / w[i]);
    }
    assert_int_equal(ewa_point2_divide(vec3_make(2, 3, 0), xy), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_point2_divide(vec3_add(vec3_make(2, 3, 1), vec3_make(4, -1, 1)), xy), EWA_OK);
    assert_true(xy[0] == 3 && xy[1] == 1);
}

/// The homogeneous conic: degree two, and w^2 times the Euclidean one.
TEST(test_homogeneous_conic) {
    double a = 3, b = 2, c = 0.5, d = -1, e = 4, f = -7, x = 1.5, y = -2.5, w = 2;
    ewa_conic q = {a, c / 2, d / 2, b, e / 2, f};
    double euclidean = a * x * x + b * y * y + c * x * y + d * x + e * y + f;
    check_near(ewa_conic_value(&q, vec3_make(x, y, 1)), euclidean, 1e-13);
    check_near(ewa_conic_value(&q, vec3_make(w * x, w * y, w)), w * w * euclidean, 1e-13);
}

/// Transformations: translation, rotation, scaling, bordered form.
TEST(test_transformations) {
    const ewa_mat3 t = {{{1, 0, 0}, {0, 1, 0}, {5, -2, 1}}}, s = {{{3, 0, 0}, {0, 0.5, 0}, {0, 0, 1}}};
    check_vec3(ewa_point2_transform(vec3_make(4, 6, 2), &s), 12, 3, 2, 0);
    check_vec3(ewa_point2_transform(vec3_make(1, 1, 1), &t), 6, -1, 1, 0);
    check_vec3(ewa_point2_transform(vec3_make(1, 1, 0), &t), 1, 1, 0, 0); // a direction is not translated
    const ewa_mat3 bordered = {{{1, 2, 0}, {3, 4, 0}, {5, 6, 1}}};
    check_vec3(ewa_point2_transform(vec3_make(10, 20, 1), &bordered), 75, 106, 1, 0); // pA + c

    // Printed: [cos -sin; sin cos] "counter-clockwise". With row vectors that turns x towards -y: clockwise.
    const ewa_mat3 quarter = check_turn(acos(-1) / 2);
    check_vec3(ewa_point2_transform(vec3_make(1, 0, 1), &quarter), 0, 1, 1, EXACT);
    double co = cos(0.7), si = sin(0.7);
    const ewa_mat3 printed = {{{co, -si, 0}, {si, co, 0}, {0, 0, 1}}}, turn = check_turn(0.7);
    ewa_mat3 inverse;
    assert_int_equal(ewa_mat3_invert(&turn, &inverse), EWA_OK);
    assert_true(ewa_point2_transform(vec3_make(1, 0, 1), &printed).y < 0);
    check_numbers(printed.m, inverse.m, 9, EXACT);
}

/// Sequences: translation, rotation, scaling = [RS 0; cRS 1].
TEST(test_sequence) {
    const ewa_mat3 t = {{{1, 0, 0}, {0, 1, 0}, {5, -2, 1}}}, s = {{{3, 0, 0}, {0, 0.5, 0}, {0, 0, 1}}},
                   r = check_turn(0.7);
    ewa_mat3 product = ewa_mat3_concatenate(&t, &r);
    product = ewa_mat3_concatenate(&product, &s);
    double co = cos(0.7), si = sin(0.7);
    const double rs[2][2] = {{co * 3, si * 0.5}, {-si * 3, co * 0.5}};
    const double crs[2] = {5 * rs[0][0] - 2 * rs[1][0], 5 * rs[0][1] - 2 * rs[1][1]};
    const ewa_mat3 expected = {{{rs[0][0], rs[0][1], 0}, {rs[1][0], rs[1][1], 0}, {crs[0], crs[1], 1}}};
    check_numbers(product.m, expected.m, 9, 4 * EXACT);
}

static double det2(double a, double b, double c, double d) { return a * d - b * c; }

/// Homogeneous Lines: the intersection by determinants is the cross product; parallel lines; the line at
/// infinity.
TEST(test_lines) {
    double a1 = 2, b1 = -3, c1 = 5, a2 = 1, b2 = 4, c2 = -6;
    ewa_vec3 point, k = {a1, b1, c1}, l = {a2, b2, c2};
    assert_int_equal(ewa_line2_meet(k, l, &point), EWA_OK);
    check_vec3(point, det2(-c1, b1, -c2, b2), det2(a1, -c1, a2, -c2), det2(a1, b1, a2, b2), 0);
    double xy[2];
    assert_int_equal(ewa_point2_divide(point, xy), EWA_OK);
    check_near(a1 * xy[0] + b1 * xy[1] + c1, 0, 4 * EXACT);
    check_near(a2 * xy[0] + b2 * xy[1] + c2, 0, 4 * EXACT);

    // [a b c] x [a b d] = (d - c) [b -a 0]: the print leaves the factor out, which does not matter to the
    // point.
    assert_int_equal(ewa_line2_meet(vec3_make(2, -3, 5), vec3_make(2, -3, 9), &point), EWA_OK);
    check_vec3(point, -3 * 4, -2 * 4, 0, 0);
    check_same(&point, (&(ewa_vec3){1, 2.0 / 3, 0}), 3, EXACT);
    const ewa_vec3 at_infinity = {0, 0, 1};
    assert_true(ewa_incidence2(point, at_infinity) == 0);
    assert_true(ewa_incidence2(vec3_make(1, 2, 1), at_infinity) != 0);
}

/// The paper's maps with an image plane z = D: the perspective, the projection, and their product.
static ewa_mat4 perspective_of(double d) {
    return (ewa_mat4){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1 / d}, {0, 0, -1, 0}}};
}

static ewa_mat4 projection_of(double d) {
    return (ewa_mat4){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}, {0, 0, d, 1}}};
}

static ewa_mat4 product_of(double d) {
    return (ewa_mat4){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1 / d}, {0, 0, 0, 0}}};
}

/// Perspective Projection: (x, y, z) -> (xD/z, yD/z, D). Printed: for D -> infinity orthographic; with the
/// eye at the origin the picture grows with D and still depends on z. With the eye at z = -D, last column [0
/// 0 1/D 1], it holds.
TEST(test_perspective_projection) {
    double d = 3, xyz[3];
    ewa_mat4 map = product_of(d);
    check_vec4(ewa_point3_transform(vec4_make(4, -5, 6, 1), &map), 4, -5, 6, 6 / d, 0);
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(4, -5, 6, 1), &map), xyz), EWA_OK);
    check_near(xyz[0], 4 * d / 6, EXACT);
    check_near(xyz[1], -5 * d / 6, EXACT);
    check_near(xyz[2], d, EXACT);

    double near_point[3], far_point[3], large = 1e8;
    map = product_of(large);
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(1, 0, 2, 1), &map), near_point),
                     EWA_OK);
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(1, 0, 4, 1), &map), far_point), EWA_OK);
    check_near(near_point[0] / far_point[0], 2, EXACT);
    assert_true(near_point[0] > large / 4);

    ewa_mat4 moved = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1 / large}, {0, 0, 0, 1}}};
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(1, 0, 2, 1), &moved), near_point),
                     EWA_OK);
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(1, 0, 4, 1), &moved), far_point),
                     EWA_OK);
    check_near(near_point[0], 1, 1e-7);
    check_near(far_point[0], 1, 1e-7);
}

/// Perspective, Projection, and Perspective Projection: z' = D - D/z (printed z^-1 for z - 1 in the product),
/// [1, inf] to [0, D], and the product of the two maps.
TEST(test_perspective_times_projection) {
    double d = 3, xyz[3];
    const ewa_mat4 perspective = perspective_of(d), projection = projection_of(d), expected = product_of(d);
    ewa_mat4 singular;
    check_numbers(ewa_mat4_concatenate(&perspective, &projection).m, expected.m, 16, 0);

    ewa_vec4 point = ewa_point3_transform(vec4_make(4, -5, 6, 1), &perspective);
    check_vec4(point, 4, -5, 6 - 1, 6 / d, 0);
    assert_true(fabs(point.z - 1.0 / 6) > 1);
    assert_int_equal(ewa_point3_divide(point, xyz), EWA_OK);
    check_near(xyz[2], d - d / 6, EXACT);
    assert_true(ewa_point3_transform(vec4_make(0, 0, 1, 1), &perspective).z == 0);
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(0, 0, 1, 0), &perspective), xyz),
                     EWA_OK);
    check_near(xyz[2], d, EXACT);

    // The near plane z = D goes to D - 1 before scaling, not to 0; the far plane to D - D/F.
    check_vec4(ewa_point3_transform(vec4_make(0, 0, d, 1), &perspective), 0, 0, d - 1, 1, 0);
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(0, 0, 9, 1), &perspective), xyz),
                     EWA_OK);
    check_near(xyz[2], d - d / 9, EXACT);

    // Invertible with the extra term, singular without.
    assert_int_equal(ewa_mat4_invert(&perspective, &singular), EWA_OK);
    assert_int_equal(ewa_mat4_invert(&projection, &singular), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_mat4_invert(&expected, &singular), EWA_ERROR_NUMERIC);
}

/// Perspective Space: printed [a b c 0] -> w = -c/D from a last column [0 0 -1/D 1]; the column of every
/// matrix in the paper is [0 0 1/D 0], and w = c/D.
TEST(test_vanishing_point) {
    const ewa_mat4 map = perspective_of(4);
    const ewa_vec4 vanishing = ewa_point3_transform(vec4_make(1, 2, 8, 0), &map);
    check_vec4(vanishing, 1, 2, 8, 8 / 4.0, 0);
    assert_true(vanishing.w != -8 / 4.0);
    for (int i = 1; i < 30; i++) { // parallel lines approach it, from wherever they start
        double xyz[3], reach = ldexp(1, i);
        ewa_vec4 p = vec4_make(i % 5 - 2 + reach, i % 3 + 2 * reach, 1 + 8 * reach, 1);
        assert_int_equal(ewa_point3_divide(ewa_point3_transform(p, &map), xyz), EWA_OK);
        check_near(xyz[0], vanishing.x / vanishing.w, 4 / reach);
        check_near(xyz[1], vanishing.y / vanishing.w, 4 / reach);
    }
    assert_true(ewa_point3_transform(vec4_make(1, 2, 0, 0), &map).w == 0); // parallel to the image plane
}

/// The frustum map [P], the two transformed points, and the nine rows of Example Perspective Transformations.
TEST(test_example_perspective_transformations) {
    double d = 2, f = 10, fov = 1.1, s = d * tan(fov / 2), k = 1 / (1 - d / f), a = 3, b = -7, c = 5;
    ewa_mat4 p;
    assert_int_equal(check_window_map((const double[]){-s, s, -s, s}, d, f, false, &p), EWA_OK);
    const double printed[16] = {1 / s, 0, 0, 0,  0, 1 / s, 0, 0, 0, 0, 1 / (d * (1 - d / f)),
                                1 / d, 0, 0, -k, 0};
    check_numbers(p.m, printed, 16, EXACT);

    const struct {
        ewa_vec4 point, image;
        bool exact; // the very numbers; else the same point, [a' b' c' 1] standing for its own a', b', c'
    } rows[9] = {
        {{a, b, d, 1}, {a / s, b / s, 0, 1}, true},                      // near plane -> z' = 0
        {{a, b, f, 1}, {a / s * d / f, b / s * d / f, 1, 1}, false},     // far plane -> z' = 1
        {{0, 0, 1, 0}, {0, 0, k, 1}, false},                             // vanishing point of the z axis
        {{a, b, c, 0}, {a * d / (c * s), b * d / (c * s), k, 1}, false}, // vanishing point of a line
        {{a, b, d, 1}, {a / s, b / s, 0, 1}, true},        // image plane unchanged but for scale
        {{a, b, 0, 0}, {a / s, b / s, 0, 0}, true},        // parallel lines in xy stay parallel
        {{a, 0, b, 0}, {a * d / (b * s), 0, k, 1}, false}, // perspective horizon
        {{s, -s, d, 1}, {1, -1, 0, 1}, true},              // frustum corner -> window corner
        {{0, 0, 0, 1}, {0, 0, -k, 0}, true},               // eye -> infinity
    };
    for (int i = 0; i < 9; i++) {
        ewa_vec4 image = ewa_point3_transform(rows[i].point, &p);
        if (rows[i].exact) check_numbers(&image, &rows[i].image, 4, 4 * EXACT);
        check_same(&image, &rows[i].image, 4, EXACT);
    }
    for (int corner = 0; corner < 4; corner++) {
        double x = corner & 1 ? 1 : -1, y = corner & 2 ? 1 : -1;
        check_vec4(ewa_point3_transform(vec4_make(x * s, y * s, d, 1), &p), x, y, 0, 1, EXACT);
    }
    // "[a b c 0] -> [a' b' c' 1]" fails for c = 0 (row six), where w' = 0.
    assert_true(ewa_point3_transform(vec4_make(a, b, 0, 0), &p).w == 0);
    // Printed: columns scaled "by Sx and Sy". By their inverses: else the corner would land on S^2.
    ewa_mat4 scaled = p;
    scaled.m[0][0] = s;
    assert_true(fabs(ewa_point3_transform(vec4_make(s, 0, d, 1), &scaled).x - 1) > 0.1);
}

/// Associated Vertex Transformations: parallel to the picture, the quotient becomes linear (d = e = 0).
TEST(test_parallel_polygon_is_linear) {
    ewa_vec4 corners[3] = {{0, 0, 1, 4}, {8, 0, 1, 4}, {0, 8, 1, 4}};
    const double values[3] = {1, 5, 9};
    ewa_vec3 numerator, denominator;
    assert_int_equal(ewa_hyperbolic_fit(corners, values, 1, &numerator, &denominator), EWA_OK);
    assert_true(denominator.x == 0 && denominator.y == 0 && denominator.z != 0);
    double value;
    assert_int_equal(ewa_hyperbolic_at(numerator, denominator, 0.5, 0.25, &value), EWA_OK);
    check_near(value, 1 + 4 * 0.25 + 8 * 0.125, EXACT);
}

/// Homogeneous Clipping: behind the eye z < 0 gives w < 0 and z' > 0, indeed z' > 1: such points are never
/// visible with this [P]; negative w becomes visible through points that have it themselves.
TEST(test_behind_the_eye) {
    ewa_mat4 p;
    assert_int_equal(check_window_map((const double[]){-1, 1, -1, 1}, 2, 10, false, &p), EWA_OK);
    for (double z = -0.01; z > -1e6; z *= 3) {
        ewa_vec4 q = ewa_point3_transform(vec4_make(0, 0, z, 1), &p);
        assert_true(q.w < 0 && q.z / q.w > 1);
    }
    ewa_vec4 q = ewa_point3_transform(vec4_make(-0.0, -0.0, -5, -1), &p); // the point (0, 0, 5)
    ewa_segment_part parts[2];
    uint32_t visible;
    assert_true(q.w < 0);
    assert_int_equal(ewa_clip_segment(q, q, parts, &visible), EWA_OK);
    assert_int_equal(visible, EWA_VISIBLE_NEGATIVE);
}

/// Homogeneous Clipping: the worked example. Printed alpha = 8/3; holds: 8/9, with the printed end point.
TEST(test_clipping_example) {
    double y1 = 0.5, z1 = 1, y2 = 0.25, z2 = 0.25, alpha[6], xyz[3];
    ewa_vec4 p1 = {2, y1, z1, 2}, p2 = {-1, y2, z2, 0.5};
    uint32_t crossed, visible;
    assert_int_equal(ewa_clip_alphas(p1, p2, alpha, &crossed), EWA_OK);
    assert_true(crossed & 1u << EWA_CLIP_LEFT);
    check_near(alpha[EWA_CLIP_LEFT], 8.0 / 9, EXACT);
    const double x = 2 + 8.0 / 3 * (-1 - 2), w = 2 + 8.0 / 3 * (0.5 - 2);
    assert_true(fabs(x / w + 1) > 1); // nor on the plane

    ewa_segment_part parts[2];
    assert_int_equal(ewa_clip_segment(p1, p2, parts, &visible), EWA_OK);
    assert_int_equal(visible, EWA_VISIBLE_POSITIVE);
    check_near(parts[0].alpha[0], 0, 0);
    check_near(parts[0].alpha[1], 8.0 / 9, EXACT);
    check_vec4(parts[0].end[1], -2.0 / 3, y1 + 8.0 / 9 * (y2 - y1), z1 + 8.0 / 9 * (z2 - z1), 2.0 / 3, EXACT);
    assert_int_equal(ewa_point3_divide(parts[0].end[1], xyz), EWA_OK);
    assert_true(xyz[0] >= -1);
    check_near(xyz[0], -1, EXACT);
}

/// The six formulas for alpha, as printed, against the points they name.
TEST(test_alpha_formulas) {
    ewa_vec4 p1 = {0.3, -2, 5, 1.5}, p2 = {-4, 3, -1, 0.7};
    double dx = p2.x - p1.x, dy = p2.y - p1.y, dz = p2.z - p1.z, dw = p2.w - p1.w, alpha[6];
    const double printed[6] = {(p1.x + p1.w) / (-dw - dx),
                               (p1.x - p1.w) / (dw - dx),
                               (p1.y + p1.w) / (-dw - dy),
                               (p1.y - p1.w) / (dw - dy),
                               p1.z / -dz,
                               (p1.z - p1.w) / (dw - dz)};
    uint32_t crossed;
    assert_int_equal(ewa_clip_alphas(p1, p2, alpha, &crossed), EWA_OK);
    assert_int_equal(crossed, 63);
    check_numbers(alpha, printed, 6, 4 * EXACT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
