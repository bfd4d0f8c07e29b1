// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up and from where clouds are seen when nobody says: docs/framing.md.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("cli_view"); }

/// Points of a test object.
typedef struct shape {
    double (*points)[3];
    size_t count, capacity;
    check_random random;
} shape;

static void add_point(shape *to, double x, double y, double z) {
    if (to->count == to->capacity) {
        to->capacity = to->capacity ? 2 * to->capacity : 1024;
        to->points = realloc(to->points, to->capacity * sizeof *to->points);
        assert_non_null(to->points);
    }
    double *p = to->points[to->count++];
    p[0] = x, p[1] = y, p[2] = z;
}

static double between(shape *to, double low, double high) { return check_uniform(&to->random, low, high); }

/// The surface of a box, `density` points per unit of area.
static void add_box(shape *to, const double low[3], const double high[3], double density) {
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const int count = (int)(density * (high[u] - low[u]) * (high[v] - low[v]));
        for (int i = 0; i < 2 * count; i++) {
            double p[3];
            p[axis] = i % 2 ? low[axis] : high[axis];
            p[u] = between(to, low[u], high[u]);
            p[v] = between(to, low[v], high[v]);
            add_point(to, p[0], p[1], p[2]);
        }
    }
}

/// The surface of an ellipsoid above y = `cut`, and the disc there where `closed`.
static void add_egg(shape *to, const double radii[3], double cut, bool closed, int count) {
    for (int i = 0; i < count; i++) {
        const double c = between(to, -1, 1), s = sqrt(1 - c * c), turn = between(to, 0, 6.283185307179586);
        double y = radii[1] * c, scale = 1;
        if (y < cut && !closed) continue;
        if (y < cut) {
            y = cut; // a chord through the egg, shrunk to fill its disc
            scale = sqrt(between(to, 0, 1)) * sqrt(1 - cut * cut / (radii[1] * radii[1])) / fmax(s, 1e-9);
        }
        add_point(to, scale * radii[0] * s * cos(turn), y, scale * radii[2] * s * sin(turn));
    }
}

/// A four-legged animal, y up, its head towards +z.
static shape animal(void) {
    shape to = {.random = {7}};
    add_egg(&to, (double[3]){0.5, 0.45, 1.7}, -9, false, 15000);
    for (size_t i = 0; i < to.count; i++) to.points[i][1] += 1.2;
    add_box(&to, (double[3]){-0.25, 1.5, 1.4}, (double[3]){0.25, 2.1, 2.1}, 1500);
    for (int leg = 0; leg < 4; leg++) {
        const double x = leg % 2 ? 0.2 : -0.4, z = leg / 2 ? 1.2 : -1.4;
        add_box(&to, (double[3]){x, 0, z}, (double[3]){x + 0.2, 0.8, z + 0.2}, 1500);
    }
    return to;
}

/// A sheet of hills over x and z, y up.
static shape hills(double height) {
    shape to = {.random = {9}};
    for (int i = 0; i < 20000; i++) {
        const double x = between(&to, -5, 5), z = between(&to, -5, 5);
        add_point(&to, x, height * (sin(1.3 * x) * cos(0.9 * z) + 0.2 * x), z);
    }
    return to;
}

/// A wall, a floor and a ball as a camera at the origin sees them that looks along +z with y down; `columns`
/// of pixels, or anywhere in the picture.
static shape range_image(int columns, bool pixels, double sign) {
    shape to = {.random = {11}};
    const int rows = 3 * columns / 4;
    for (int i = 0; i < columns * rows; i++) {
        const double column = pixels ? i % columns : between(&to, 0, columns);
        const double row = pixels ? i / columns : between(&to, 0, rows);
        const double u = (column - 0.5 * columns) / columns, v = (row - 0.5 * rows) / columns;
        double z = 4; // the wall
        if (v > 0.2) z = fmin(z, 0.8 / v);
        const double a = u * u + v * v + 1, b = 2.5, c = 2.5 * 2.5 - 0.36; // the ball at (0, 0, 2.5)
        if (b * b > a * c) z = fmin(z, (b - sqrt(b * b - a * c)) / a);
        add_point(&to, u * z, sign * v * z, sign * z);
    }
    return to;
}

/// Turns y up into z up: (x, y, z) to (x, -z, y).
static void stand_on_z(shape *of) {
    for (size_t i = 0; i < of->count; i++) {
        double *p = of->points[i], y = p[1];
        p[1] = -p[2];
        p[2] = y;
    }
}

static void move(shape *of, double x, double y, double z) {
    for (size_t i = 0; i < of->count; i++) {
        of->points[i][0] += x;
        of->points[i][1] += y;
        of->points[i][2] += z;
    }
}

/// Writes the points as doubles; frees them.
static void write_shape(const char *name, shape *of) {
    char header[256];
    const int length =
        snprintf(header, sizeof header,
                 "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty double x\n"
                 "property double y\nproperty double z\nend_header\n",
                 of->count);
    const size_t bytes = of->count * sizeof *of->points;
    char *all = malloc((size_t)length + bytes);
    assert_non_null(all);
    memcpy(all, header, (size_t)length);
    memcpy(all + length, of->points, bytes);
    scratch_write(name, all, (size_t)length + bytes);
    free(all);
    free(of->points);
    *of = (shape){.count = 0};
}

/// Draws a file and checks what is said of its up axis and its view.
static void expect(const char *path, const char *up, const char *view) {
    assert_true(run("ewa render '%s' -o view.png --size 32x24 --verbose", path) == 0);
    char wanted[64], place[64];
    snprintf(wanted, sizeof wanted, "up: %s (", up);
    snprintf(place, sizeof place, "), seen from %s\n", view);
    if (!strstr(last_run.err, wanted) || !strstr(last_run.err, place))
        fail_msg("%s: '%s' and '%s' wanted, said: %s", path, wanted, place, last_run.err);
}

/// Writes a shape and checks what info says of it.
static void expect_shape(const char *name, shape of, const char *up, const char *view) {
    write_shape(name, &of);
    assert_int_equal(run("ewa info %s", name), 0);
    char wanted[64], place[64];
    snprintf(wanted, sizeof wanted, "  up          %s (", up);
    snprintf(place, sizeof place, "), seen from %s\n", view);
    if (!strstr(last_run.out, wanted) || !strstr(last_run.out, place))
        fail_msg("%s: '%s' and '%s' wanted, said: %.400s", name, wanted, place, last_run.out);
}

/// What stands has a base that its weight is over, whichever axis is the longest.
TEST(test_bases) {
    shape to = animal();
    expect_shape("animal.ply", to, "y", "iso"); // long in z: seen at an angle
    to = animal();
    stand_on_z(&to);
    expect_shape("animal_z.ply", to, "z", "iso");
    // From the side it is as wide as deep, and seen from the front.
    to = animal();
    for (size_t i = 0; i < to.count; i++) {
        const double x = to.points[i][0];
        to.points[i][0] = to.points[i][2];
        to.points[i][2] = -x;
    }
    expect_shape("aside.ply", to, "y", "front");
    // A bust, closed below and open below.
    for (int closed = 0; closed < 2; closed++) {
        for (int axis = 1; axis <= 2; axis++) {
            to = (shape){.random = {3}};
            add_egg(&to, (double[3]){0.8, 1.2, 0.7}, -0.7, closed, 30000);
            if (axis == 2) stand_on_z(&to);
            expect_shape("bust.ply", to, axis == 1 ? "y" : "z", "front");
        }
    }
    // A statue that is tall, on z.
    to = (shape){.random = {4}};
    add_egg(&to, (double[3]){0.3, 2, 0.25}, -1.6, true, 20000);
    move(&to, 0, 2, 0);
    add_box(&to, (double[3]){-0.6, 0, -0.6}, (double[3]){0.6, 0.4, 0.6}, 3000);
    stand_on_z(&to);
    expect_shape("statue.ply", to, "z", "front");
    // What is drawn is what info says.
    expect("statue.ply", "z", "front");
    expect("animal.ply", "y", "iso");
}

/// Info says of a file what is drawn of it.
static void expect_same(const char *path) {
    char wanted[200] = "up: ";
    assert_int_equal(run("ewa info %s", path), 0);
    const char *up = strstr(last_run.out, "  up          ");
    assert_non_null(up);
    strncat(wanted, up + 14, strcspn(up + 14, "\n") + 1);
    assert_int_equal(run("ewa render %s -o view.png --size 32x24 --verbose", path), 0);
    if (!strstr(last_run.err, wanted)) fail_msg("%s: info says %swhat is drawn: %s", path, wanted, last_run.err);
}

/// Of meshes the faces stand, of Gaussians the kind of file says it, of folders the octree in them.
TEST(test_info) {
    // Eight corners of a plate and eight of a pillar on it, of which the corners alone say nothing.
    scratch_text("pillar.off", "OFF\n16 10 0\n"
                               "-2 -2 0\n2 -2 0\n2 2 0\n-2 2 0\n-2 -2 0.4\n2 -2 0.4\n2 2 0.4\n-2 2 0.4\n"
                               "-0.3 -0.3 0.4\n0.3 -0.3 0.4\n0.3 0.3 0.4\n-0.3 0.3 0.4\n"
                               "-0.3 -0.3 3\n0.3 -0.3 3\n0.3 0.3 3\n-0.3 0.3 3\n"
                               "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"
                               "4 8 9 13 12\n4 9 10 14 13\n4 10 11 15 14\n4 11 8 12 15\n");
    expect_same("pillar.off");
    assert_non_null(strstr(last_run.err, "up: z (it stands on a base)"));
    float numbers[8] = {0, 0, 0, 0.1f, 0.2f, 0.3f};
    memcpy(&numbers[6], "\377\200\100\377\377\200\200\200", 8);
    FILE *file = fopen(scratch_path("one.splat"), "wb");
    assert_non_null(file);
    for (int i = 0; i < 3; i++) {
        numbers[i] = 1;
        assert_int_equal(fwrite(numbers, sizeof numbers, 1, file), 1);
    }
    assert_int_equal(fclose(file), 0);
    expect_same("one.splat");
    assert_non_null(strstr(last_run.err, "up: -y"));
    assert_int_equal(run("ewa generate terrain -o flat.ply -n 3000 && ewa lod flat.ply -o flat.copc.laz"), 0);
    expect_same("flat.ply");
    expect_same("flat.copc.laz");
}

/// A man with his arms out is flat in z, and has two sides: no ground.
TEST(test_flat_body) {
    shape to = {.random = {5}};
    add_box(&to, (double[3]){-0.2, 0.9, -0.1}, (double[3]){0.2, 1.75, 0.12}, 20000);
    add_box(&to, (double[3]){-0.9, 1.3, -0.05}, (double[3]){0.9, 1.42, 0.06}, 20000);
    for (int leg = -1; leg <= 1; leg += 2)
        add_box(&to, (double[3]){0.12 * leg - 0.08, 0, -0.1}, (double[3]){0.12 * leg + 0.08, 0.9, 0.18},
                20000);
    expect_shape("man.ply", to, "y", "front");
}

/// Ground is seen from above; so is what stands at map coordinates, flat or not, unless it is a tower.
TEST(test_ground) {
    shape to = hills(0.4);
    expect_shape("ground_y.ply", to, "y", "iso");
    to = hills(0.4);
    stand_on_z(&to);
    expect_shape("ground_z.ply", to, "z", "iso");
    to = hills(2.5); // not flat
    stand_on_z(&to);
    move(&to, 635000, 4850000, 120);
    expect_shape("map.ply", to, "z", "iso");
    to = (shape){.random = {6}}; // a strip along a power line
    add_box(&to, (double[3]){0, 0, 0}, (double[3]){500, 5, 6}, 1);
    move(&to, 1694038, 1816492, 5592);
    expect_shape("strip.ply", to, "z", "iso");
    to = (shape){.random = {6}};
    add_box(&to, (double[3]){0, 0, 0}, (double[3]){5, 5, 30}, 20);
    move(&to, 1694038, 1816492, 5592);
    expect_shape("tower.ply", to, "z", "front");
}

/// What is long and has no base lies; a box lies on its largest side.
TEST(test_what_lies) {
    shape to = {.random = {8}};
    add_egg(&to, (double[3]){0.5, 2.2, 0.4}, -9, false, 20000);
    expect_shape("fish.ply", to, "z", "iso");
    to = (shape){.random = {8}}; // so round that nothing of it is a base
    add_egg(&to, (double[3]){0.5, 2.2, 0.9}, -9, false, 20000);
    expect_shape("shuttle.ply", to, "z", "iso");
    to = (shape){.random = {8}};
    add_box(&to, (double[3]){0, 0, 0}, (double[3]){3, 2, 0.3}, 3000);
    expect_shape("plate.ply", to, "z", "iso");
    // Nothing speaks for another axis than y.
    to = (shape){.random = {8}};
    add_egg(&to, (double[3]){1, 1, 1}, -9, false, 20000);
    expect_shape("ball.ply", to, "y", "front");
}

/// A drawing is seen face on, whichever plane it lies in.
TEST(test_planes) {
    static const char *const ups[] = {"y", "z", "z"}, *const views[] = {"right", "front", "top"};
    for (int axis = 0; axis < 3; axis++) {
        shape to = {.random = {2}};
        for (int i = 0; i < 4000; i++) {
            double p[3] = {between(&to, 0, 2), between(&to, 0, 2), between(&to, 0, 2)};
            p[axis] = 3;
            add_point(&to, p[0], p[1], p[2]);
        }
        expect_shape("drawing.ply", to, ups[axis], views[axis]);
        run_done("ewa render drawing.ply -o drawing.exr --size 64x48 --background transparent");
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
        OWNED(ewa_image_free) ewa_image image = {0};
        assert_int_equal(ewa_image_load(context, scratch_path("drawing.exr"), &image), EWA_OK);
        size_t covered = 0;
        for (size_t i = 0; i < 64 * 48; i++) covered += image.pixels[image.channel_count * i + 3] > 0.5f;
        assert_true(covered > 64 * 48 / 3);
    }
}

/// The view of --save-camera's file.
static ewa_camera saved_camera(const char *name) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    ewa_camera camera;
    ewa_camera_init(&camera);
    assert_int_equal(ewa_camera_load(context, scratch_path(name), 0, &camera), EWA_OK);
    return camera;
}

/// What a camera at the origin saw is seen from there: upright, all of it, filling the picture.
TEST(test_range_images) {
    for (int pixels = 0; pixels < 2; pixels++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            expect_shape("range.ply", range_image(160, pixels, sign), sign > 0 ? "-y" : "y", "the origin");
            run_done("ewa render range.ply -o range.exr --size 160x120 --background transparent -q "
                     "--save-camera range.json"); // wall and floor meet in a sharp edge, which is told
            const ewa_camera camera = saved_camera("range.json");
            double eye[3];
            ewa_camera_eye(&camera, eye);
            for (int c = 0; c < 3; c++) assert_true(fabs(eye[c]) < 1e-9);
            // y is down in the picture for a camera along +z, up for one along -z.
            assert_true(sign * camera.world_to_camera[5] > 0.9);
            OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
            OWNED(ewa_image_free) ewa_image image = {0};
            assert_int_equal(ewa_image_load(context, scratch_path("range.exr"), &image), EWA_OK);
            size_t covered = 0;
            for (size_t i = 0; i < 160 * 120; i++)
                covered += image.pixels[image.channel_count * i + 3] > 0.5f;
            // Nothing hides behind another: no shadows.
            assert_true(covered > 0.65 * 160 * 120);
        }
    }
    // --fov, --view and --up decide otherwise.
    static const char *const others[] = {"--fov 60", "--view front", "--up 0,1,0", "--azimuth 10",
                                         "--ortho 3"};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        run_done("ewa render range.ply -o a.png --size 40x30 %s --save-camera a.json", others[i]);
        const ewa_camera camera = saved_camera("a.json");
        double eye[3];
        ewa_camera_eye(&camera, eye);
        assert_true(fabs(eye[0]) + fabs(eye[1]) + fabs(eye[2]) > 1e-3);
    }
    // A body ahead of the origin is none: it has a far side.
    shape to = {.random = {12}};
    add_egg(&to, (double[3]){0.3, 0.4, 0.3}, -9, false, 20000);
    move(&to, 0, 0, 3);
    expect_shape("ahead.ply", to, "y", "front");
}

/// The kind of a file speaks where its shape does not.
TEST(test_conventions) {
    static const char ascii[] =
        "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0.4\n"
        "vertex 0 1 0.7\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\n"
        "vertex 1 0 0.4\nvertex 1 1 0\nvertex 0 1 0.7\nendloop\nendfacet\nendsolid s\n";
    scratch_text("saddle.stl", ascii);
    scratch_text("saddle.obj", "v 0 0 0\nv 1 0 0.4\nv 0 1 0.7\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
    expect("saddle.obj", "y", "front");
    expect("saddle.stl", "z", "front");
}

/// Few points with discs of unequal sizes: none is cut by the frame, from any side.
TEST(test_unequal_discs) {
    scratch_text("few.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                            "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                            "property float radius\nend_header\n0 0 0 0 0 1 0.3\n0.2 0.1 0 0 0 1 0.3\n"
                            "0.1 0 0.3 1 0 0 0.3\n1 0.3 0.1 1 0 1 0.8\n-0.4 -0.3 0 0 1 1 0.2\n");
    static const char *const views[] = {"front", "left", "top", "iso"};
    for (size_t k = 0; k < sizeof views / sizeof views[0]; k++) {
        run_done("ewa render few.ply -o few.exr --size 160x120 --background transparent --view %s", views[k]);
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
        OWNED(ewa_image_free) ewa_image image = {0};
        assert_int_equal(ewa_image_load(context, scratch_path("few.exr"), &image), EWA_OK);
        size_t covered = 0, cut = 0;
        for (size_t i = 0; i < 160 * 120; i++) {
            const size_t x = i % 160, y = i / 160;
            const bool some = image.pixels[image.channel_count * i + 3] > 0;
            covered += some;
            cut += some && (x == 0 || y == 0 || x == 159 || y == 119);
        }
        assert_true(covered > 1000);
        assert_int_equal(cut, 0);
    }
}

/// The camera depends neither on the order of the points, nor on copies of them, nor on the threads.
TEST(test_order) {
    shape to = animal();
    while (to.count < 200000) add_box(&to, (double[3]){-0.4, 0.8, -1.5}, (double[3]){0.4, 1.6, 1.5}, 1500);
    shape shuffled = {.random = {13}};
    for (size_t i = 0; i < to.count; i++)
        add_point(&shuffled, to.points[i][0], to.points[i][1], to.points[i][2]);
    for (size_t i = shuffled.count - 1; i > 0; i--) {
        const size_t k = (size_t)between(&shuffled, 0, (double)i + 1);
        double kept[3];
        memcpy(kept, shuffled.points[i], sizeof kept);
        memcpy(shuffled.points[i], shuffled.points[k], sizeof kept);
        memcpy(shuffled.points[k], kept, sizeof kept);
    }
    write_shape("given.ply", &to);
    write_shape("shuffled.ply", &shuffled);
    run_done("ewa render given.ply -o a.png --size 64x48 --save-camera a.json --threads 1 && "
             "ewa render shuffled.ply -o b.png --size 64x48 --save-camera b.json --threads 3");
    assert_true(scratch_same("a.json", "b.json"));
    // A few places many times, in two orders.
    for (int order = 0; order < 2; order++) {
        shape many = {.random = {14}};
        for (int i = 0; i < 300000; i++) {
            const int place = order ? (i * 7) % 50 : i / 6000;
            add_point(&many, place % 5, place / 5 % 5, place / 25 + (place == 49 ? 3 : 0));
        }
        write_shape(order ? "many_b.ply" : "many_a.ply", &many);
    }
    run_done("ewa render many_a.ply -o a.png --size 64x48 --save-camera a.json --quiet && "
             "ewa render many_b.ply -o b.png --size 64x48 --save-camera b.json --quiet");
    assert_true(scratch_same("a.json", "b.json"));
}

int main(void) { return RUN_TESTS(enter, NULL); }
