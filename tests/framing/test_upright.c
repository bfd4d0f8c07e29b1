// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where each rule of docs/framing.md begins and ends to hold: pairs of shapes, one on either side of its
// limit and less than a fifth from it.
#include "check.h"

#include <math.h>
#include <stdbool.h>

#include "framing/upright.h"
#include "framing/upright_measure.h"

enum { MAX_POINTS = 1 << 17 };

/// Points of a test object, from the middle of nothing: world coordinates.
typedef struct shape {
    double points[MAX_POINTS][3];
    size_t count;
    check_random random;
} shape;

static shape made;

static void start(void) { made = (shape){.random = {17}}; }

static double between(double low, double high) { return check_uniform(&made.random, low, high); }

static void add(double x, double y, double z) {
    assert_true(made.count < MAX_POINTS);
    double *p = made.points[made.count++];
    p[0] = x, p[1] = y, p[2] = z;
}

/// Points inside of a box, which may have no thickness.
static void add_block(double x0, double x1, double y0, double y1, double z0, double z1, int count) {
    for (int i = 0; i < count; i++) add(between(x0, x1), between(y0, y1), between(z0, z1));
    for (int i = 0; i < 8; i++) add(i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0);
}

/// An octahedron about (0, y, 0): pointed, so that no side of it is a base.
static void add_diamond(double y, double rx, double ry, double rz) {
    for (int i = 0; i < 30000; i++) {
        double p[3], sum = 0;
        for (int c = 0; c < 3; c++) sum += fabs(p[c] = between(-1, 1));
        if (sum > 0) add(rx * p[0] / sum, y + ry * p[1] / sum, rz * p[2] / sum);
    }
    for (int sign = -1; sign <= 1; sign += 2) {
        add(sign * rx, y, 0);
        add(0, y + sign * ry, 0);
        add(0, y, sign * rz);
    }
}

/// What is measured of the shape.
static point_cloud_sample measured(double middle_world[3]) {
    point_cloud_sample points = {.count = made.count, .offsets = (const double(*)[3])made.points};
    for (int c = 0; c < 3; c++) middle_world[c] = 0;
    points.middle_world = middle_world;
    ewa_measure_extent(&points);
    return points;
}

/// Checks what is chosen for the shape, moved by `middle`, and a part of the reason.
static void expect_at(const double middle[3], ewa_up_convention convention, int axis, ewa_named_view view,
                      const char *why, int line) {
    const ewa_upright chosen =
        ewa_upright_choose(made.count, (const double(*)[3])made.points, middle, convention);
    if (chosen.axis != axis || chosen.view != view || !strstr(chosen.why, why))
        fail_msg("line %d: axis %d, view %d, %s", line, chosen.axis, (int)chosen.view, chosen.why);
}

static const double AT_ORIGIN[3] = {0, 0, 0};

static ewa_upright chosen_at_origin(ewa_up_convention convention) {
    return ewa_upright_choose(made.count, (const double(*)[3])made.points, AT_ORIGIN, convention);
}

#define EXPECT(convention, axis, view, why) expect_at(AT_ORIGIN, convention, axis, view, why, __LINE__)

/// A plane is thinner than 1e-4 of the size, and wider than that.
TEST(test_planes) {
    start();
    add_block(0, 1.85e-4, -1, 1, -1, 1, 5000);
    EXPECT(EWA_UP_ANY, 1, EWA_VIEW_RIGHT, "plane");
    start();
    add_block(0, 2.2e-4, -1, 1, -1, 1, 5000);
    EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, "nothing speaks");
    start();
    add_block(-1, 1, 0, 2.2e-4, 0, 0, 5000);
    EXPECT(EWA_UP_ANY, 2, EWA_VIEW_TOP, "plane");
    start();
    add_block(-1, 1, 0, 1.85e-4, 0, 0, 5000);
    const ewa_upright line = chosen_at_origin(EWA_UP_ANY);
    assert_null(strstr(line.why, "plane"));
}

/// A drawing across z has y up, in a PCD y down, unless it lies on a map.
TEST(test_drawings) {
    start();
    add_block(-1, 1, -1, 1, 0, 0, 5000);
    EXPECT(EWA_UP_ANY, 2, EWA_VIEW_TOP, "plane");
    EXPECT(EWA_UP_CAMERA_USUAL, 1, EWA_VIEW_FRONT, "a plane across a camera's axis");
    assert_true(chosen_at_origin(EWA_UP_CAMERA_USUAL).reversed);
    expect_at((double[3]){5e5, 4e6, 0}, EWA_UP_CAMERA_USUAL, 2, EWA_VIEW_TOP, "plane", __LINE__);
    start();
    add_block(-1, 1, 0, 0, -1, 1, 5000);
    EXPECT(EWA_UP_CAMERA_USUAL, 2, EWA_VIEW_FRONT, "face on");
}

/// Map coordinates are over 100 sizes from the origin; what is 1.5 times higher than wide there is a tower.
TEST(test_maps) {
    for (int tower = 0; tower < 2; tower++) {
        const double size = tower ? 3.2 : 2.8;
        start();
        add_block(-1, 1, -1, 1, 0, size, 20000);
        const ewa_named_view view = tower ? EWA_VIEW_FRONT : EWA_VIEW_ISO;
        expect_at((double[3]){112 * size, 0, 0}, EWA_UP_Y_USUAL, 2, view, "map", __LINE__);
        expect_at((double[3]){0, -112 * size, 0}, EWA_UP_Y_USUAL, 2, view, "map", __LINE__);
        expect_at((double[3]){90 * size, -90 * size, 1e4}, EWA_UP_Y_USUAL, 1,
                  tower ? EWA_VIEW_ISO : EWA_VIEW_FRONT, "files", __LINE__);
    }
}

/// Ground is lower than 0.4 of its width, and has something above it in less than 0.3 of its places.
TEST(test_ground) {
    for (int within = 0; within < 2; within++) {
        start();
        const double height = within ? 0.74 : 0.86;
        for (int i = 0; i < 20000; i++) {
            const double x = between(-1, 1), z = between(-1, 1);
            add(x, 0.5 * height * sin(3 * x) * cos(2 * z), z);
        }
        assert_int_equal(strstr(chosen_at_origin(EWA_UP_ANY).why, "ground") != NULL, within);
        start();
        for (int i = 0; i < 60000; i++) {
            const double x = between(-1, 1), z = between(-1, 1);
            add(x, i % 2 && x < (within ? 0.54 : 0.66) - 1 ? 0.4 : 0, z);
        }
        assert_int_equal(strstr(chosen_at_origin(EWA_UP_ANY).why, "ground") != NULL, within);
    }
}

/// A picture of a camera at the origin along z: `columns` by `rows` slopes up to `across` and `down`, of
/// which `kept` in 20 are there, of a wavy wall.
static void make_pixels(int columns, int rows, double across, double down, int kept) {
    start();
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
            const double u = across * (2.0 * c / (columns - 1) - 1), v = down * (2.0 * r / (rows - 1) - 1);
            const double z = 4 + 0.2 * sin(3 * u) * cos(2 * v);
            if ((7 * r + 3 * c) % 20 < kept) add(u * z, v * z, z);
        }
}

/// Pixels are few columns or rows against the points, lie within 45 degrees and are no strip.
TEST(test_pixels) {
    for (int within = 0; within < 2; within++) {
        make_pixels(80, 60, within ? 0.93 : 1.08, 0.5, 20);
        ewa_upright chosen = chosen_at_origin(EWA_UP_ANY);
        assert_int_equal(chosen.from_origin, within);
        make_pixels(80, 60, 0.5, within ? 0.93 : 1.08, 20);
        chosen = chosen_at_origin(EWA_UP_ANY);
        assert_int_equal(chosen.from_origin, within);
        make_pixels(20, 20, 0.5, 0.5, within ? 11 : 9);
        chosen = chosen_at_origin(EWA_UP_ANY);
        assert_int_equal(chosen.from_origin, within);
        make_pixels(30, within ? 4 : 3, 0.5, 0.5, 20); // 120 points, 90: too few to tell
        assert_int_equal(chosen_at_origin(EWA_UP_ANY).from_origin, within);
        make_pixels(400, 20, 0.5, within ? 0.0275 : 0.0225, 20);
        chosen = chosen_at_origin(EWA_UP_ANY);
        assert_non_null(strstr(chosen.why, "by its pixels"));
        assert_int_equal(chosen.from_origin, within);
    }
}

/// A slanted wall before the origin, in any directions; a share of these see another wall behind it too.
static void make_view(double layered, int columns) {
    start();
    for (int i = 0; i < 60000; i++) {
        double u = between(-0.4, 0.4);
        if (columns) u = 0.8 * ((i % columns) / (columns - 1.0) - 0.5);
        const double v = between(-0.3, 0.3);
        const double z = (3 + u / 0.4) * (u < 0.8 * layered - 0.4 && between(0, 1) < 0.5 ? 1.4 : 1);
        add(u * z, v * z, z);
    }
}

/// Where less than 0.15 of the directions have something behind another, 0.3 of those of pixels, a camera
/// took what is aimed at.
TEST(test_camera_views) {
    for (int within = 0; within < 2; within++) {
        make_view(within ? 0.135 : 0.165, 0);
        ewa_upright chosen = chosen_at_origin(EWA_UP_ANY);
        assert_int_equal(chosen.from_origin, within);
        make_view(within ? 0.27 : 0.33, 100);
        chosen = chosen_at_origin(EWA_UP_ANY);
        assert_int_equal(chosen.from_origin, within);
        // What the camera looks past: x from -0.09 or -0.11 of its width on.
        make_view(0, 0);
        size_t kept = 0;
        double right = 0;
        for (size_t i = 0; i < made.count; i++) right = fmax(right, made.points[i][0]);
        const double share = within ? 0.115 : 0.085, left = -right * share / (1 - share);
        for (size_t i = 0; i < made.count; i++) {
            if (made.points[i][0] < left) continue;
            memcpy(made.points[kept++], made.points[i], sizeof made.points[i]);
        }
        made.count = kept;
        chosen = chosen_at_origin(EWA_UP_ANY);
        assert_int_equal(chosen.from_origin, within);
    }
}

/// A pointed body on a rectangular foot that fills `share` of its footprint.
static void make_footed(double share) {
    start();
    add_diamond(0.7, 0.5, 0.5, 1);
    const double a = sqrt(share / 8), b = 2 * a; // 4 a b of a rhombus of area 1
    add_block(-a, a, 0, 0.02, -b, b, 5000);
}

static double share_of(int axis, bool *stable) {
    double middle[3];
    const point_cloud_sample points = measured(middle);
    base_facts facts;
    ewa_measure_base(&points, axis, &facts);
    if (stable) *stable = facts.stable;
    return facts.share;
}

/// What stands has a base of 0.2 of its footprint, 0.3 against the usual axis.
TEST(test_base_shares) {
    for (int large = 0; large < 2; large++) {
        make_footed(large ? 0.22 : 0.18);
        assert_float_equal(share_of(1, NULL), large ? 0.22 : 0.18, 0.005);
        assert_true(share_of(2, NULL) < 0.05);
        EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, large ? "base" : "nothing speaks");
        make_footed(large ? 0.33 : 0.27);
        if (large)
            EXPECT(EWA_UP_Z_USUAL, 1, EWA_VIEW_ISO, "base");
        else
            EXPECT(EWA_UP_Z_USUAL, 2, EWA_VIEW_FRONT, "files");
        EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, "base");
    }
}

/// A prism along z whose outline narrows from 3 to 3 `bottom` towards y = 0, and by `taper` towards z = depth.
static void make_prism(double bottom, double depth, double taper) {
    start();
    for (int i = 0; i < 40000; i++) {
        const double y = between(0, 2), half = 1.5 * (bottom + (1 - bottom) * 0.5 * y), z = between(0, depth);
        const double far = 1 - taper, there = 1 - taper * z / depth;
        add(between(-half, half) * (i % 2 ? 1 : far), y, i % 2 ? 0 : depth);
        add((i % 2 ? -half : half) * there, y, z);
        add(between(-1.5, 1.5) * (i % 2 ? bottom : 1) * there, i % 2 ? 0 : 2, z);
    }
}

/// What is its mirror image across one axis, by 0.85, and across the other less than 0.85 times as much is level along
/// the first.
TEST(test_halves) {
    make_prism(0.25, 1.5, 0.18);
    EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, "nothing speaks");
    EXPECT(EWA_UP_Z_USUAL, 2, EWA_VIEW_FRONT, "base");
    make_prism(0.25, 1.5, 0.22);
    EXPECT(EWA_UP_ANY, 2, EWA_VIEW_FRONT, "base");
    static const struct {
        double bottom, taper;
        bool mirrored;
    } turned[] = {{0.55, 0.12, true}, {0.55, 0.22, false}, {0.84, 0, true}, {0.92, 0, false}};
    for (int k = 0; k < 4; k++) {
        make_prism(turned[k].bottom, 1.5, turned[k].taper);
        for (size_t i = 0; i < made.count; i++) {
            const double y = made.points[i][1];
            made.points[i][1] = made.points[i][2], made.points[i][2] = y;
        }
        if (turned[k].mirrored)
            EXPECT(EWA_UP_ANY, 2, EWA_VIEW_ISO, "halves");
        else
            EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, "nothing speaks");
        EXPECT(EWA_UP_Y_USUAL, 1, EWA_VIEW_ISO, "files");
    }
}

/// A base is twice as large as the other one; bases of 0.6 are those of a box, which lies when it is lower
/// than 0.4 of its width.
TEST(test_boxes) {
    for (int large = 0; large < 2; large++) {
        make_prism(large ? 0.55 : 0.45, 1.5, 0.3);
        assert_float_equal(share_of(1, NULL), large ? 0.55 : 0.45, 0.03);
        assert_true(share_of(2, NULL) > 0.98);
        if (large)
            EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, "nothing speaks");
        else
            EXPECT(EWA_UP_ANY, 2, EWA_VIEW_FRONT, "base");
        make_prism(large ? 0.66 : 0.54, 0.3, 0);
        if (large)
            EXPECT(EWA_UP_ANY, 2, EWA_VIEW_ISO, "flat lies");
        else
            EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, "nothing speaks");
        make_prism(1, large ? 0.86 : 0.74, 0);
        if (large)
            EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, "nothing speaks");
        else
            EXPECT(EWA_UP_ANY, 2, EWA_VIEW_ISO, "flat lies");
    }
}

/// A body with a front at z = 1, a share of it in one plane and the rest `step` behind, and a rounded back.
static void make_faced(double share, double step) {
    start();
    for (int i = 0; i < 60000; i++) {
        const double x = between(0, 1), y = between(0, 1), back = 0.8 * (x - 0.5) * (x - 0.5) + 0.4 * (y - 0.5) * (y - 0.5);
        add(x, y, i % 2 ? (x < share ? 1 : 1 - step) : back);
    }
}

/// What shows a plane in 0.6 of its front, 0.02 of its size thick, is seen at an angle; not what is surveyed.
TEST(test_faces) {
    for (int large = 0; large < 2; large++) {
        const ewa_named_view view = large ? EWA_VIEW_ISO : EWA_VIEW_FRONT;
        make_faced(large ? 0.63 : 0.57, 0.1);
        EXPECT(EWA_UP_Y_USUAL, 1, view, "");
        EXPECT(EWA_UP_Y_REQUIRED, 1, view, "");
        // With z up the front is -y.
        for (size_t i = 0; i < made.count; i++) {
            const double y = made.points[i][1];
            made.points[i][1] = 1 - made.points[i][2], made.points[i][2] = y;
        }
        EXPECT(EWA_UP_Z_USUAL, 2, view, "");
        EXPECT(EWA_UP_Z_SURVEYED, 2, EWA_VIEW_FRONT, "");
        make_faced(0.5, large ? 0.018 : 0.022);
        EXPECT(EWA_UP_Y_USUAL, 1, view, "");
    }
    // But for boxes: a front that is all one plane, with half of its width behind it.
    for (int deep = 0; deep < 2; deep++) {
        start();
        for (int i = 0; i < 60000; i++) {
            const double x = between(0, 1), z = between(0, 1), y = between(0, deep ? 0.6 : 0.4), far = deep ? 0.6 : 0.4;
            i % 4 == 0 ? add(x, 0, z) : i % 4 == 1 ? add(x, far, z) : i % 4 == 2 ? add(0, y, z) : add(1, y, z);
        }
        EXPECT(EWA_UP_Z_SURVEYED, 2, deep ? EWA_VIEW_ISO : EWA_VIEW_FRONT, "");
    }
    // From the other side it is round.
    make_faced(1, 0);
    for (size_t i = 0; i < made.count; i++) made.points[i][2] = 1 - made.points[i][2];
    EXPECT(EWA_UP_Y_USUAL, 1, EWA_VIEW_FRONT, "");
    // An open sheet is seen face on.
    start();
    for (int i = 0; i < 60000; i++) add(between(0, 1), between(0, 1), made.count % 16 ? 1 : 0.97);
    EXPECT(EWA_UP_Y_REQUIRED, 1, EWA_VIEW_FRONT, "");
}

/// What is twice as long as wide, and has no base, lies.
TEST(test_tall) {
    start();
    add_diamond(0, 0.5, 0.92, 0.4);
    EXPECT(EWA_UP_ANY, 1, EWA_VIEW_FRONT, "nothing speaks");
    start();
    add_diamond(0, 0.5, 1.08, 0.4);
    EXPECT(EWA_UP_ANY, 2, EWA_VIEW_ISO, "long");
    start();
    add_diamond(0, 0.4, 0.5, 1.08);
    EXPECT(EWA_UP_Z_USUAL, 2, EWA_VIEW_FRONT, "files");
    // With a base that is too small against the usual axis it lies no more.
    start();
    add_diamond(1.08, 0.5, 1.08, 0.4);
    add_block(-0.2, 0.2, -0.03, 0.01, -0.15, 0.15, 3000);
    EXPECT(EWA_UP_ANY, 1, EWA_VIEW_FRONT, "base");
}

/// From the front; iso where it is lower than 0.4 of its width, or 1.5 times as deep as wide and not higher.
TEST(test_views) {
    assert_int_equal(ewa_upright_view((double[3]){1, 0.37, 1.2}, 1), EWA_VIEW_ISO);
    assert_int_equal(ewa_upright_view((double[3]){1, 0.43, 1.2}, 1), EWA_VIEW_FRONT);
    assert_int_equal(ewa_upright_view((double[3]){1, 1.2, 0.37}, 2), EWA_VIEW_ISO);
    assert_int_equal(ewa_upright_view((double[3]){1, 1.2, 0.43}, 2), EWA_VIEW_FRONT);
    assert_int_equal(ewa_upright_view((double[3]){1, 0.9, 1.4}, 1), EWA_VIEW_FRONT);
    assert_int_equal(ewa_upright_view((double[3]){1, 0.9, 1.6}, 1), EWA_VIEW_ISO);
    assert_int_equal(ewa_upright_view((double[3]){1, 1.5, 1.6}, 1), EWA_VIEW_ISO);
    assert_int_equal(ewa_upright_view((double[3]){1, 1.7, 1.6}, 1), EWA_VIEW_FRONT);
}

/// A floor with a peak in its middle, and a roof over a share of it: an open sheet has no base.
TEST(test_open_sheets) {
    for (int closed = 0; closed < 2; closed++) {
        start();
        const double roof = closed ? 0.165 : 0.135;
        for (int i = 0; i < 60000; i++) {
            const double x = between(-1, 1), z = between(-1, 1), r = sqrt(x * x + z * z);
            add(x, i % 2 && x < 2 * roof / 0.9 - 1 && fabs(z) < 0.9 ? 0.5 : fmax(0, 1.5 * (0.6 - r)), z);
        }
        EXPECT(EWA_UP_ANY, 1, EWA_VIEW_FRONT, closed ? "base" : "nothing speaks");
    }
}

/// A body above a plate that ends at x = `end`, where `below` of 100,000 points lie under it.
static void make_on_plate(double end, double lift, int below) {
    start();
    for (int i = 0; i < 60000; i++) {
        const int side = i % 6, axis = side / 2;
        double p[3] = {between(0, 1), between(0.1, 1), between(0, 1)};
        p[axis] = side % 2 ? 1 : axis == 1 ? 0.1 : 0;
        add(p[0], p[1], p[2]);
    }
    for (int i = 0; i < 40000 - below; i++) add(between(end, 1), i % 2 ? lift : 0, between(0, 1));
    for (int i = 0; i < below; i++) add(1, -0.1, 0.5);
    // Half of the plate is lifted: the rest is a strip at its edge.
    for (size_t i = 60000; lift > 0 && i < made.count; i++)
        if (made.points[i][1] <= 0) made.points[i][0] = 1 - 0.1 * (1 - made.points[i][0]);
}

/// The middle has to be over the base, 0.05 of the footprint's size from its rim.
TEST(test_stable) {
    bool stable = false;
    make_on_plate(0.466, 0, 0);
    assert_float_equal(share_of(1, &stable), 0.534, 0.01);
    assert_true(stable);
    make_on_plate(0.476, 0, 0);
    assert_float_equal(share_of(1, &stable), 0.524, 0.01);
    assert_false(stable);
    // What would fall over does not stand there.
    for (int under = 0; under < 2; under++) {
        const double foot = under ? -0.14 : 0.02;
        start();
        add_diamond(0.7, 0.5, 0.5, 1);
        add_block(foot, foot + 0.28, 0, 0.02, -0.5, 0.5, 5000);
        assert_true(share_of(1, NULL) > 0.25);
        EXPECT(EWA_UP_ANY, 1, EWA_VIEW_ISO, under ? "base" : "nothing speaks");
    }
}

/// A base is what is within 0.02 of the size above the lowest points, but for 0.002 of them.
TEST(test_base_height) {
    make_on_plate(0.3, 0.018, 0);
    assert_float_equal(share_of(1, NULL), 0.7, 0.02);
    make_on_plate(0.3, 0.022, 0);
    assert_true(share_of(1, NULL) < 0.1);
    make_on_plate(0.3, 0, 180);
    assert_float_equal(share_of(1, NULL), 0.7, 0.02);
    make_on_plate(0.3, 0, 220);
    assert_true(share_of(1, NULL) < 0.1);
}

/// One surface is behind another when it is three cells away.
TEST(test_layers) {
    for (int apart = 0; apart < 2; apart++) {
        start();
        for (int i = 0; i < 60000; i++)
            add(between(0, 1), i % 2 ? (apart ? 3.3 : 2.7) / 64 : 0, between(0, 1));
        double middle[3];
        const point_cloud_sample points = measured(middle);
        assert_float_equal(ewa_measure_layers(&points, 1), apart, 0.01);
        // Few points have larger cells, of 8 points: 1000 points 11 by 11.
        start();
        for (int i = 0; i < 992; i++) add(between(0, 1), i % 2 ? (apart ? 0.29 : 0.255) : 0, between(0, 1));
        add_block(0, 1, 0, 0, 0, 1, 0);
        double also[3];
        const point_cloud_sample few = measured(also);
        assert_float_equal(ewa_measure_layers(&few, 1), apart, 0.05);
    }
}

/// The convention that all names share, by their suffixes in any case.
TEST(test_conventions) {
    static const struct {
        size_t count;
        const char *paths[3];
        ewa_up_convention convention;
    } cases[] = {{1, {"a.ply"}, EWA_UP_ANY},
                 {1, {"folder/a.OBJ"}, EWA_UP_Y_USUAL},
                 {2, {"a.glb", "b.gltf"}, EWA_UP_Y_REQUIRED},
                 {3, {"a.stl", "b.stl", "c.STL"}, EWA_UP_Z_USUAL},
                 {3, {"a.las", "b.copc.laz", "folder/ept.json"}, EWA_UP_Z_SURVEYED},
                 {3, {"a.e57", "b.PTX", "c.pts"}, EWA_UP_Z_SURVEYED},
                 {2, {"a.las", "b.stl"}, EWA_UP_ANY},
                 {3, {"a.stl", "b.stl", "c.obj"}, EWA_UP_ANY},
                 {2, {"a.stl", "b.ply"}, EWA_UP_ANY},
                 {2, {"a.ply", "b.stl"}, EWA_UP_ANY},
                 {2, {"a.pcd", "b.PCD"}, EWA_UP_CAMERA_USUAL},
                 {2, {"a.pcd", "b.ply"}, EWA_UP_ANY},
                 {1, {"stl"}, EWA_UP_ANY},
                 {0, {NULL}, EWA_UP_ANY}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        assert_int_equal(ewa_up_convention_of(cases[k].count, cases[k].paths), cases[k].convention);
}

static void expect_look(int axis, bool reversed, ewa_named_view view, const double direction[3],
                        const double up[3], int line) {
    const ewa_upright upright = {.axis = axis, .reversed = reversed, .view = view, .why = ""};
    double ahead[3], above[3];
    ewa_upright_look(&upright, ahead, above);
    for (int c = 0; c < 3; c++)
        if (ahead[c] != direction[c] || above[c] != up[c])
            fail_msg("line %d: (%g, %g, %g), up (%g, %g, %g)", line, ahead[0], ahead[1], ahead[2], above[0],
                     above[1], above[2]);
}

#define V(x, y, z) ((const double[3]){x, y, z})

/// Where each side is, with y, z and -y up.
TEST(test_looks) {
    expect_look(2, false, EWA_VIEW_FRONT, V(0, 1, 0), V(0, 0, 1), __LINE__);
    expect_look(2, false, EWA_VIEW_BACK, V(0, -1, 0), V(0, 0, 1), __LINE__);
    expect_look(2, false, EWA_VIEW_LEFT, V(1, 0, 0), V(0, 0, 1), __LINE__);
    expect_look(2, false, EWA_VIEW_RIGHT, V(-1, 0, 0), V(0, 0, 1), __LINE__);
    expect_look(2, false, EWA_VIEW_TOP, V(0, 0, -1), V(0, 1, 0), __LINE__);
    expect_look(2, false, EWA_VIEW_BOTTOM, V(0, 0, 1), V(0, -1, 0), __LINE__);
    expect_look(2, false, EWA_VIEW_ISO, V(-1, 1, -1), V(0, 0, 1), __LINE__);
    expect_look(1, false, EWA_VIEW_FRONT, V(0, 0, -1), V(0, 1, 0), __LINE__);
    expect_look(1, false, EWA_VIEW_TOP, V(0, -1, 0), V(0, 0, -1), __LINE__);
    expect_look(1, false, EWA_VIEW_ISO, V(-1, -1, -1), V(0, 1, 0), __LINE__);
    expect_look(1, true, EWA_VIEW_FRONT, V(0, 0, 1), V(0, -1, 0), __LINE__);
    expect_look(1, true, EWA_VIEW_TOP, V(0, 1, 0), V(0, 0, 1), __LINE__);
}

/// The eye goes counter-clockwise about the axis, then up; over a pole up turns along.
TEST(test_turns) {
    const double *axis = V(0, 0, 1);
    double ahead[3] = {0, 1, 0}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_upright_turn(axis, 90, 0, ahead, up), EWA_OK); // the eye from -y to +x
    assert_true(fabs(ahead[0] + 1) < 1e-12 && fabs(ahead[1]) < 1e-12 && fabs(up[2] - 1) < 1e-12);
    assert_int_equal(ewa_upright_turn(axis, 0, 30, ahead, up), EWA_OK);
    assert_true(fabs(ahead[2] + 0.5) < 1e-12 && fabs(up[2] - sqrt(0.75)) < 1e-12);
    assert_int_equal(ewa_upright_turn(axis, 0, 90, ahead, up), EWA_OK);
    assert_true(ahead[2] < 0 && up[2] < -0.49);
    double kept[3] = {0, 1, 0}, above[3] = {0, 0, 1};
    assert_int_equal(ewa_upright_turn(V(0, 0, 0), 1, 0, kept, above), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_upright_turn(V(0, 0, 1), NAN, 0, kept, above), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_upright_turn(NULL, 1, 0, kept, above), EWA_ERROR_ARGUMENT);
    assert_true(kept[1] == 1 && above[2] == 1);
}

/// The words that a program prints.
TEST(test_words) {
    char text[EWA_UPRIGHT_TEXT_BYTES];
    ewa_upright upright = {.axis = 2, .view = EWA_VIEW_ISO, .why = "map coordinates"};
    ewa_upright_describe(&upright, text);
    assert_string_equal(text, "z (map coordinates), seen from iso");
    upright = (ewa_upright){.axis = 1, .reversed = true, .from_origin = true, .why = "so"};
    ewa_upright_describe(&upright, text);
    assert_string_equal(text, "-y (so), seen from the origin");
    assert_string_equal(ewa_upright_place(&upright), "the origin");
}

/// What a cloud's framing chooses is what its points choose; in another order too.
TEST_ON(test_of_cloud, 1) {
    make_footed(0.33);
    const ewa_upright direct = chosen_at_origin(EWA_UP_Z_USUAL);
    for (int order = 0; order < 2; order++) {
        OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
        ewa_upright chosen;
        ewa_cloud *cloud = check_cloud_of(context, made.count);
        double *position = check_add(cloud, EWA_POSITION, EWA_F64, 3);
        for (size_t i = 0; i < made.count; i++)
            memcpy(position + 3 * i, made.points[order ? made.count - 1 - i : i], sizeof made.points[0]);
        assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
        ewa_cloud_destroy(&cloud);
        ewa_framing_choose(framing, EWA_UP_Z_USUAL, &chosen);
        assert_int_equal(chosen.axis, direct.axis);
        assert_int_equal(chosen.view, direct.view);
        assert_ptr_equal(chosen.why, direct.why);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
