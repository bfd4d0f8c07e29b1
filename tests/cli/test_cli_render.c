// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// render: what lands in the picture files.
#include <math.h>
#include <string.h>

#include "check_pictures.h"
#include "image_difference.h"

static int enter(void **state) {
    context = check_context(0, NULL);
    if (scratch_enter("cli_render") != 0) return -1;
    return run("ewa generate torus -n 20000 -o torus.ply && ewa generate sphere -n 5000 -o ball.ply && "
               "ewa generate plane -n 5000 -o plane.ply");
}

/// Share of the pixels whose channel `channel` is over `threshold`.
static double share_over(const ewa_image *image, uint32_t channel, float threshold) {
    const size_t count = (size_t)image->width_px * image->height_px;
    size_t over = 0;
    for (size_t i = 0; i < count; i++) over += image->pixels[i * image->channel_count + channel] > threshold;
    return (double)over / (double)count;
}

TEST(test_png) {
    run_done("ewa render ball.ply -o a.png --size 200x100");
    OWNED(ewa_image_free) ewa_image image = load("a.png");
    assert_int_equal(image.width_px, 200);
    assert_int_equal(image.height_px, 100);
    assert_int_equal(image.channel_count, 3);
    assert_true(image.pixels[0] == 1); // white corner
    ewa_image_free(&image);
    run_done("ewa render ball.ply -o a.png --size 200x100 --background transparent");
    image = load("a.png");
    assert_int_equal(image.channel_count, 4);
    // A disc that fills the height up to the margin and its own splats' reach, of a square of half the
    // picture.
    const double share = share_over(&image, 3, 0.5f);
    assert_true(share > 0.26 && share < 0.34);
    ewa_image_free(&image);
    run_done("ewa render ball.ply -o a.png --size 20x10 --background 0.5,0,1");
    image = load("a.png");
    assert_true(fabs(image.pixels[0] - ewa_linear_from_srgb(0.5f)) < 0.01 && image.pixels[1] == 0);
}

TEST(test_exr) {
    run_done("ewa render torus.ply -o a.exr --size 160x90 --background transparent");
    ewa_image image = load("a.exr");
    assert_int_equal(image.channel_count, 4); // the loader takes R G B A
    assert_true(share_over(&image, 3, 0.99f) > 0.2);
    ewa_image_free(&image);
    // All nine channels are named in the header, in alphabetical order, and the camera's matrix.
    static char header[4096];
    FILE *file = fopen(scratch_path("a.exr"), "rb");
    const size_t size = fread(header, 1, sizeof header, file);
    fclose(file);
    static const char *const names[] = {"A",   "B", "G", "N.X",      "N.Y",
                                        "N.Z", "R", "Z", "coverage", "worldToCamera"};
    const char *at = header;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const size_t length = strlen(names[i]) + 1;
        while (at + length < header + size && memcmp(at, names[i], length) != 0) at++;
        assert_true(at + length < header + size);
    }
}

TEST(test_planes) {
    run_done("ewa render ball.ply -o a.pfm --size 80x60 --aov depth=d.pfm,normal=n.exr,coverage=c.pfm "
             "--eye 0,-5,0 --up 0,0,1 --fov 30");
    OWNED(ewa_image_free)
    ewa_image color = load("a.pfm"), depth = load("d.pfm"), normal = load("n.exr"), coverage = load("c.pfm");
    assert_int_equal(color.channel_count, 3);
    assert_int_equal(normal.channel_count, 3);
    const size_t middle = 30 * 80 + 40;
    assert_true(fabsf(depth.pixels[middle] - 4) < 0.02f); // a unit sphere seen from 5 away
    assert_true(isinf(depth.pixels[0]) && depth.pixels[0] > 0);
    assert_true(normal.pixels[3 * middle + 1] < -0.99f);
    assert_true(coverage.pixels[middle] > 0.6f && coverage.pixels[0] == 0);
}

TEST(test_camera) {
    run_done("ewa render torus.ply -o a.png --size 160x90 --view right --save-camera c.json && "
             "ewa render torus.ply -o b.png --camera c.json");
    assert_true(scratch_same("a.png", "b.png"));
    run_done("ewa render torus.ply -o c.png --camera c.json --size 320x180");
    ewa_image image = load("c.png");
    assert_int_equal(image.width_px, 320);
    ewa_image_free(&image);
    run_done("ewa render torus.ply -o a.png --size 90x90 --eye 1,2,3 --target 0,0,0.1 --up 0,0,1 --fov 40 && "
             "ewa render torus.ply --output=b.png --resolution 90,90 --camera-position 1,2,3 "
             "--camera-focal-point 0,0,0.1 --camera-view-up 0,0,1 --camera-view-angle 40");
    assert_true(scratch_same("a.png", "b.png"));
    static const char *const axes[] = {"z", "+Z"};
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; i++) {
        run_done("ewa render torus.ply -o b.png --size 90x90 --eye 1,2,3 --target 0,0,0.1 --up %s --fov 40", axes[i]);
        assert_true(scratch_same("a.png", "b.png"));
    }
    // What has y down is seen from the side that cameras are on, as scene files and Python have it.
    run_done("ewa render torus.ply -o a.png --size 90x90 --up=-y && ewa render torus.ply -o b.png --size 90x90 --up 0,-1,0 --view front");
    assert_true(scratch_same("a.png", "b.png"));
    static const char *const wrong[] = {"w", "--z", "zz", "+", "-", "1,2"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        run_fails(2, "is neither three numbers x,y,z nor an axis, x, y or z, -y", "ewa render torus.ply -o b.png --up=%s", wrong[i]);
}

/// Every named view shows the whole torus: something in the middle half, nothing on the border.
TEST(test_views) {
    static const char *const views[] = {"front", "back", "left", "right", "top", "bottom", "iso"};
    static const char *const projections[] = {"", "--ortho 2.6"};
    for (size_t i = 0; i < 14; i++) {
        run_done("ewa render torus.ply -o v.exr --size 64x48 --background transparent --view %s %s",
                 views[i % 7], projections[i / 7]);
        OWNED(ewa_image_free) ewa_image image = load("v.exr");
        assert_true(share_over(&image, 3, 0.5f) > 0.1);
        float border = 0;
        for (uint32_t x = 0; x < 64; x++)
            border += image.pixels[4 * x + 3] + image.pixels[4 * (47 * 64 + x) + 3];
        for (uint32_t y = 0; y < 48; y++)
            border += image.pixels[4 * (64 * y) + 3] + image.pixels[4 * (64 * y + 63) + 3];
        assert_true(border == 0);
    }
}

/// The default view is one that options can ask for: docs/framing.md, test_cli_view.c.
TEST(test_default_view) {
    static const char *const views[][3] = {{"plane", "", "--view top"},
                                           {"ball", "", "--view front --up 0,1,0"},
                                           {"ball", "--translate 500000,4000000,0", "--view iso --up 0,0,1"}};
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++) {
        run_done("ewa convert %s.ply -o moved.ply %s && ewa render moved.ply -o a.png --size 64x48 && "
                 "ewa render moved.ply -o b.png --size 64x48 %s",
                 views[i][0], views[i][1], views[i][2]);
        assert_true(scratch_same("a.png", "b.png"));
    }
}

TEST(test_far_points) {
    scratch_text("far.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                            "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "property float radius\nend_header\n1000 0 0 0 0 1 9 9 9 0.1\n");
    run_done("ewa convert ball.ply far.ply -o both.ply");
    assert_int_equal(run("ewa render both.ply -o a.exr --size 64x48 --background transparent"), 0);
    assert_non_null(strstr(last_run.err, "ewa: both.ply: a few points lie far off"));
    OWNED(ewa_image_free) ewa_image image = load("a.exr");
    assert_true(share_over(&image, 3, 0.5f) > 0.3);
}

/// How many pixels of two pictures, at 320x240, are off by more than a limit in some channel.
static uint32_t count_differing(const ewa_image *a, const ewa_image *b, float limit) {
    uint32_t differing = 0;
    for (size_t i = 0; i < (size_t)320 * 240; i++) {
        float maximum = 0;
        for (uint32_t c = 0; c < 4; c++)
            maximum = fmaxf(maximum, fabsf(a->pixels[i * a->channel_count + c] - b->pixels[i * b->channel_count + c]));
        differing += maximum > limit;
    }
    return differing;
}

/// A point far from all others is drawn, small: the picture is that without it but for a few pixels. What a covered pixel expects
/// is a median over a sample of the surfels, which one more shifts: at outlines alpha may be another by a hundredth or three.
TEST(test_isolated_point) {
    static const struct {
        const char *options;
        float limit;
    } cases[] = {{"--edge-aa off", 0.01f}, {"", 0.04f}};
    run_done(
        "ewa generate sphere -n 5000 --positions-only -o bare.ply && ewa convert bare.ply -o - --ascii "
        ">bare.txt && "
        "sed 's/element vertex 5000/element vertex 5001/' bare.txt >lone.ply && echo 4 0 0 9 9 9 >>lone.ply");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        run_done("ewa render lone.ply -o lone.exr --size 320x240 --save-camera lone.json %s "
                 "&& ewa render bare.ply -o bare.exr --size 320x240 --camera lone.json %s",
                 cases[i].options, cases[i].options);
        OWNED(ewa_image_free) ewa_image lone = load("lone.exr"), bare = load("bare.exr");
        assert_in_range(count_differing(&lone, &bare, cases[i].limit), 1, 40);
    }
}

TEST(test_looks_differ) {
    static const char *const looks[] = {
        "",
        "--kernel affine --fov 90",
        "--cutoff 1.5",
        "--prefilter 0",
        "--radius-scale 2",
        "--passes 1",
        "--edge-aa off",
        "--shading none",
        "--light 1,0,0",
        "--ambient 0.8",
        "--light 0,0,0,1,0,0",
        "--light 1,0,0 --light 0,1,0",
        "--shading phong",
        "--edl 1",
        "--cull back --view top --eye 0,0,0.1 --target 1,0,0.1",
        "--color-by z",
        "--color-by normal.x",
        "--color-by z --colormap turbo",
        "--color-by z --range 0,0.1",
        "--azimuth 30",
        "--elevation -30",
        "--tau 2",
        "--edge-layers 1",
        "--tolerance 0.01",
    };
    enum { COUNT = sizeof looks / sizeof looks[0] };
    run_done("ewa render torus.ply -o base.png --size 96x64");
    for (size_t i = 1; i < COUNT; i++) {
        if (strstr(looks[i], "--eye")) continue;
        run_done("ewa render torus.ply -o look.png --size 96x64 %s", looks[i]);
        if (scratch_same("look.png", "base.png")) print_error("%s changes nothing\n", looks[i]);
        assert_false(scratch_same("look.png", "base.png"));
    }
    run_fails(1,
              "torus.ply: there is no attribute 'foo'; there are position (x y z), normal (nx ny nz), color "
              "(red green blue), radius",
              "ewa render torus.ply -o look2.png --color-by foo");
    assert_int_equal(scratch_size("look2.png"), -1);
}

/// Percentiles of numbers 0, 1, ..., 100 are the numbers; every colormap is another picture.
TEST(test_colors) {
    static char text[8192] = "ply\nformat ascii 1.0\nelement vertex 102\nproperty float x\nproperty float y\n"
                             "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                             "property float radius\nproperty float q\nend_header\n";
    for (int i = 0; i <= 101; i++) {
        const size_t used = strlen(text);
        const int number = i * 37 % 101; // in any order, with one that is none
        if (i < 101)
            snprintf(text + used, sizeof text - used, "%d 0 0 0 0 1 1 %d\n", number, number);
        else
            snprintf(text + used, sizeof text - used, "50 1 0 0 0 1 1 nan\n");
    }
    scratch_text("row.ply", text);
    run_done("ewa render row.ply -q -o a.png --size 96x16 --view top --color-by q --range 10%%,75%% && "
             "ewa render row.ply -q -o b.png --size 96x16 --view top --color-by q --range 10,75 && "
             "ewa render row.ply -q -o c.png --size 96x16 --view top --color-by q --range 10,75%%");
    assert_true(scratch_same("a.png", "b.png") && scratch_same("a.png", "c.png"));
    run_done("ewa render row.ply -q -o a.png --size 96x16 --view top --color-by q && "
             "ewa render row.ply -q -o b.png --size 96x16 --view top --color-by q --range 0%%,100%%");
    assert_true(scratch_same("a.png", "b.png"));
    run_done(
        "for map in viridis turbo gray plasma inferno magma cividis coolwarm; do "
        "ewa render row.ply -q -o m_$map.png --size 96x16 --view top --color-by q --colormap $map; done; "
        "test $(md5sum m_*.png | cut -c1-32 | sort -u | wc -l) = 8");
    assert_int_equal(run("ewa render row.ply -o a.png --size 96x16 --view top --color-by q"), 0);
    assert_non_null(strstr(last_run.err, "1 of 102 numbers of q are not finite"));
    // A range may go down.
    for (int down = 0; down < 2; down++) {
        run_done("ewa render row.ply -q -o a.pfm --size 96x16 --view top --color-by q --colormap gray "
                 "--shading none --range %s",
                 down ? "100,0" : "0,100");
        OWNED(ewa_image_free) ewa_image image = load("a.pfm");
        const float left = image.pixels[3 * (8 * 96 + 24)], right = image.pixels[3 * (8 * 96 + 72)];
        assert_true(down ? left > right + 0.2f : right > left + 0.2f);
    }
}

/// Discs that the options make small stay so: gaps are closed where the file has them.
TEST(test_small_discs) {
    run_done("ewa render ball.ply -o a.png --size 90x90 --radius-scale 0.3");
    assert_null(strstr(last_run.err, "gaps"));
    run_done("ewa render ball.ply -o b.png --size 90x90 --radius-scale 0.3 --close-gaps off");
    assert_true(scratch_same("a.png", "b.png"));
}

/// The radii of discs do not depend on the cutoff, also beside files with axes, for which they become axes.
TEST(test_cutoff_of_several) {
    scratch_text(
        "beside.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float tu_x\nproperty float tu_y\nproperty float tu_z\nproperty float tv_x\n"
        "property float tv_y\nproperty float tv_z\nend_header\n0 0 9 0.5 0 0 0 0.2 0\n");
    static const char *const view =
        "--cutoff 1.5 --eye 0,-5,0 --target 0,0,0 --up 0,0,1 --fov 30 --size 90x90 --color-by z --range -1,1 "
        "--background transparent";
    run_done("ewa render ball.ply -o alone.png %s && ewa render ball.ply beside.ply -o both.png %s", view,
             view);
    OWNED(ewa_image_free) ewa_image alone = load("alone.png"), both = load("both.png");
    const image_difference difference = image_compare(&alone, &both, 0.02);
    assert_int_equal(difference.over_threshold_count, 0);
}

/// Coordinates whose differences are not finite are an error that says so.
TEST(test_huge_coordinates) {
    scratch_text("huge.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                             "property double z\nend_header\n1e300 0 0\n-1e300 1 0\n0 1e300 2\n");
    run_fails(1, "huge.ply: no camera can be placed: the coordinates, from -1e+300,0,0",
              "ewa render huge.ply -o huge.png");
}

TEST(test_several_inputs) {
    run_done("ewa convert torus.ply ball.ply -o joined.ply && ewa render joined.ply -o a.png --size 96x64 && "
             "ewa render torus.ply ball.ply -o b.png --size 96x64");
    assert_true(scratch_same("a.png", "b.png"));
    // Ellipses and discs, colours and none, floats and bytes.
    scratch_text(
        "ellipse.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float tu_x\nproperty float tu_y\nproperty float tu_z\nproperty float tv_x\n"
        "property float tv_y\nproperty float tv_z\nend_header\n0 0 2 0.5 0 0 0 0.2 0\n");
    run_done("ewa render torus.ply ellipse.ply -o c.png --size 96x64");
    assert_false(scratch_same("a.png", "c.png"));
}

/// A mesh is sampled.
TEST(test_mesh) {
    scratch_text("square.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    run_done("ewa render square.obj -o a.png --size 100x100 --view top --background transparent "
             "--shading none");
    OWNED(ewa_image_free) ewa_image image = load("a.png");
    const float *middle = image.pixels + (50 * 100 + 50) * 4;
    assert_true(image.channel_count == 4 && middle[3] == 1 && share_over(&image, 3, 0.99f) > 0.3);
    // Borders are cut by clip lines: nearly every pixel is opaque or empty.
    assert_true(share_over(&image, 3, 0.01f) - share_over(&image, 3, 0.99f) < 0.04);
}

/// Files with clip lines keep them beside files without.
TEST(test_clip_lines_of_one_file) {
    run_done("ewa generate cube --sharp -n 600 -o cube.ply");
    // Few points, so that the median coverage stays the cube's.
    run_done("ewa generate sphere -n 100 -o few.ply");
    run_done("ewa convert few.ply --translate 40,0,0 -o far.ply");
    static const char *const view =
        "--eye 3,2,2.5 --target 0,0,0 --fov 50 --size 150x150 --cull back --background transparent";
    run_done("ewa render cube.ply -o alone.png %s", view);
    run_done("ewa render cube.ply far.ply -o both.png %s", view);
    OWNED(ewa_image_free) ewa_image alone = load("alone.png"), both = load("both.png");
    const image_difference difference = image_compare(&alone, &both, 0.02);
    assert_int_equal(difference.over_threshold_count, 0);
}

/// A box and planes leave their part of a square, seen from above with the view of the whole; of the far side
/// nothing is drawn.
TEST(test_sections) {
    static const struct {
        const char *options;
        double part;
    } rows[] = {{"--clip-box=-2,-2,-1,0,2,1", 0.5},
                {"--clip-box 0,0,-1,1,1,1", 0.25},
                {"--clip-plane 3,0,0,0 --clip-plane 0,-1,0,0.5", 0.375},
                {"--clip-box=-9,-9,-9,9,9,9 --clip-plane=-1,-1,0,0", 0.5},
                {"--clip-plane 0,0,1,0.001", 1}};
    run_done("ewa render plane.ply -o whole.exr --view top --size 120x120 --background transparent");
    ewa_image image = load("whole.exr");
    const double whole = share_over(&image, 3, 0.5f);
    ewa_image_free(&image);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        run_done("ewa render plane.ply -o a.exr --view top --size 120x120 --background transparent %s",
                 rows[i].options);
        image = load("a.exr");
        const double share = share_over(&image, 3, 0.5f);
        if (fabs(share / whole - rows[i].part) > 0.02)
            fail_msg("%s: %g of the square", rows[i].options, share / whole);
        ewa_image_free(&image);
    }
    assert_int_equal(run("ewa render plane.ply -o a.exr --clip-box 5,5,5,6,6,6"), 0);
    assert_non_null(strstr(last_run.err, "the picture shows nothing"));
}

TEST(test_streams) {
    run_done("ewa render torus.ply -o a.png --size 96x64 && cat torus.ply | ewa render - -o - --size 96x64 "
             ">b.png");
    assert_true(scratch_same("a.png", "b.png"));
    run_done("ewa render torus.ply -o c.png --size 96x64 --threads 1 && ewa render torus.ply -o d.png --size "
             "96x64 "
             "--threads 7 --progress 2>bar");
    assert_true(scratch_same("a.png", "c.png"));
    assert_true(scratch_same("a.png", "d.png"));
    assert_int_equal(run("ewa render torus.ply -o a.png --size 96x64 --verbose"), 0);
    assert_non_null(strstr(last_run.err, "ewa: torus.ply: 20000 points read in "));
    run_done("ewa render torus.ply -o a.png --size 96x64 --stats s.json && cat s.json");
    assert_non_null(strstr(last_run.out, "\"splats\": 20000,"));
    assert_non_null(strstr(last_run.out, "\"accumulate\": "));
    assert_non_null(strstr(last_run.out, "\"peak_memory_bytes\": "));
}

int main(void) { return RUN_TESTS(enter, leave); }
