// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What stands over the pictures of render and volume: title, axes, scale bar, colour bar; colours of classes.
#include <string.h>

#include "check_pictures.h"

static int enter(void **state) {
    context = check_context(0, NULL);
    if (scratch_enter("cli_furniture") != 0) return -1;
    return run("ewa generate terrain -n 20000 -o terrain.ply && ewa generate ball --dims 16 -o ball.nrrd");
}

/// A box of a picture, parts of its size.
typedef struct corner {
    double left, top, right, bottom;
} corner;

static const corner upper_middle = {0.2, 0, 0.8, 0.12}, lower_left = {0, 0.75, 0.2, 1},
                    lower_right = {0.7, 0.85, 1, 1}, right_edge = {0.8, 0.15, 1, 0.85};

/// How many pixels within a box differ between two pictures, and beyond it.
static void count_changes(const char *a, const char *b, const corner *box, size_t *inside, size_t *outside) {
    OWNED(ewa_image_free) ewa_image one = load(a), other = load(b);
    assert_int_equal(one.width_px, other.width_px);
    *inside = *outside = 0;
    for (uint32_t y = 0; y < one.height_px; y++) {
        for (uint32_t x = 0; x < one.width_px; x++) {
            const size_t at = ((size_t)y * one.width_px + x) * one.channel_count;
            if (memcmp(one.pixels + at, other.pixels + at, one.channel_count * sizeof(float)) == 0) continue;
            const double u = (x + 0.5) / one.width_px, v = (y + 0.5) / one.height_px;
            const bool in = u >= box->left && u <= box->right && v >= box->top && v <= box->bottom;
            ++*(in ? inside : outside);
        }
    }
}

/// Room is left for a colour bar where the picture shows all: the thing ends before it, at the right, or at the bottom of a tall picture, and is
/// whole. A camera that is given looks where it did.
TEST(test_bar_room) {
    static const char *const sizes[] = {"320x240", "640x480", "1280x720", "240x480"};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        run_done("ewa render terrain.ply -o bar.png --size %s --color-by z --background 0,0,0,0 --color-bar --save-camera bar.json", sizes[k]);
        run_done("ewa render terrain.ply -o there.png --size %s --color-by z --background 0,0,0,0 --camera bar.json", sizes[k]);
        run_done("ewa render terrain.ply -o given.png --size %s --color-by z --background 0,0,0,0 --camera bar.json --color-bar", sizes[k]);
        assert_true(scratch_same("bar.png", "given.png"));
        OWNED(ewa_image_free) ewa_image with = load("bar.png"), without = load("there.png");
        // Where both differ is the bar; where the other has something is the terrain.
        uint32_t shown = 0, covered = 0, rim = 0;
        for (uint32_t y = 0; y < with.height_px; y++)
            for (uint32_t x = 0; x < with.width_px; x++) {
                const size_t at = 4 * ((size_t)y * with.width_px + x);
                const bool is_bar = memcmp(with.pixels + at, without.pixels + at, 4 * sizeof(float)) != 0;
                const bool is_thing = without.pixels[at + 3] > 0;
                shown += is_bar;
                covered += is_bar && is_thing;
                rim += is_thing && (x == 0 || y == 0 || x + 1 == with.width_px || y + 1 == with.height_px);
            }
        assert_true(shown > 400);
        assert_int_equal(covered, 0);
        assert_int_equal(rim, 0);
    }
    run_done("ewa render terrain.ply -o a.png --size 320x240 --color-by z --eye 0,-9,6 --target 0,0,0 --save-camera a.json && "
             "ewa render terrain.ply -o b.png --size 320x240 --color-by z --eye 0,-9,6 --target 0,0,0 --color-bar --save-camera b.json");
    assert_true(scratch_same("a.json", "b.json"));
}

/// Each piece changes its part of the picture and nothing else; without one, and by default, the picture is as it was.
TEST(test_places) {
    static const struct {
        const char *options;
        const corner *box;
    } cases[] = {{"--title Terrain", &upper_middle}, {"--axes", &lower_left},
                 {"--scale-bar", &lower_right},      {"--scale-bar --unit m", &lower_right},
                 {"--color-bar", &right_edge},       {"--color-bar --unit m", &right_edge}};
    run_done("ewa render terrain.ply -o bare.png --size 640x480 --color-by z --save-camera bare.json");
    run_done("ewa volume ball.nrrd -o none.png --size 640x480");
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        size_t inside, outside;
        // A colour bar moves the camera, but for one that is given.
        const char *camera = strstr(cases[k].options, "color") ? "--camera bare.json" : "";
        run_done("ewa render terrain.ply -o a.png --size 640x480 --color-by z %s %s", cases[k].options, camera);
        count_changes("bare.png", "a.png", cases[k].box, &inside, &outside);
        assert_true(inside > 100);
        assert_int_equal(outside, 0);
        if (strstr(cases[k].options, "color")) continue;
        run_done("ewa volume ball.nrrd -o b.png --size 640x480 %s", cases[k].options);
        count_changes("none.png", "b.png", cases[k].box, &inside, &outside);
        assert_true(inside > 100);
        assert_int_equal(outside, 0);
    }
}

/// Every frame has its furniture, in one ink; units, labels and orthographic cameras are seen in the bytes.
TEST(test_frames) {
    run_done("ewa render terrain.ply -o t%%d.png --turntable 3 --size 320x240");
    run_done(
        "ewa render terrain.ply -o f%%d.png --turntable 3 --size 320x240 --title Frames --scale-bar --axes");
    for (int k = 0; k < 3; k++) {
        char bare[16], furnished[16];
        snprintf(bare, sizeof bare, "t%d.png", k), snprintf(furnished, sizeof furnished, "f%d.png", k);
        size_t inside, outside;
        count_changes(bare, furnished, &upper_middle, &inside, &outside);
        assert_true(inside > 100 && outside > 200);
    }
    run_done("ewa render terrain.ply -o a.png --size 320x240 --view top --ortho 3 --scale-bar && "
             "ewa render terrain.ply -o b.png --size 320x240 --view top --ortho 3 --scale-bar --unit ft && "
             "ewa render terrain.ply -o c.png --size 320x240 --view top --ortho 3 --scale-bar --unit ft "
             "--threads 1");
    assert_false(scratch_same("a.png", "b.png"));
    assert_true(scratch_same("b.png", "c.png"));
}

TEST(test_usage) {
    run_done("ewa generate sphere -n 1000 -o sphere.ply");
    run_fails(1, "--color-bar has nothing to show", "ewa render sphere.ply -o a.png --color-bar");
    run_fails(2, "--unit needs --scale-bar or --color-bar", "ewa render a.ply -o a.png --unit m");
    run_fails(2, "--colormap classes takes no --range",
              "ewa render a.ply -o a.png --color-by z --colormap classes --range 0,1");
    run_fails(2, "color-bar", "ewa volume a.nrrd -o a.png --color-bar");
    static const char *const pieces[] = {"--title x", "--axes", "--scale-bar", "--color-by z --color-bar"};
    for (int k = 0; k < 4; k++) {
        run_fails(2, ".exr and .pfm|hold data", "ewa render a.ply -o a.exr %s", pieces[k]);
        run_fails(2, ".exr and .pfm|hold data", "ewa render a.ply -o a_%%d.pfm --turntable 3 %s", pieces[k]);
    }
    run_fails(2, ".exr and .pfm|hold data", "ewa volume a.nrrd -o a.exr --axes");
}

/// Writes a flat cloud of four stripes along x whose attribute has these numbers.
static void write_stripes(const char *name, const char *attribute, const char *const numbers[4]) {
    char text[1 << 16] = "";
    size_t used =
        (size_t)snprintf(text, sizeof text,
                         "ply\nformat ascii 1.0\nelement vertex 1600\nproperty float x\nproperty float y\n"
                         "property float z\nproperty float %s\nend_header\n",
                         attribute);
    for (int i = 0; i < 1600; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%d %d 0 %s\n", i % 40, i / 40,
                                 numbers[i % 40 / 10]);
    scratch_text(name, text);
}

/// Checks the colours in the middle of the four stripes.
static void check_stripes(const char *picture, const uint8_t srgb[4][3]) {
    OWNED(ewa_image_free) ewa_image image = load(picture);
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t x = image.width_px * (2 * k + 1) / 8;
        const float *pixel =
            image.pixels + ((size_t)image.height_px / 2 * image.width_px + x) * image.channel_count;
        for (int c = 0; c < 3; c++)
            assert_true((int)(255 * ewa_srgb_from_linear(pixel[c]) + 0.5f) - srgb[k][c] <= 1 &&
                        srgb[k][c] - (int)(255 * ewa_srgb_from_linear(pixel[c]) + 0.5f) <= 1);
    }
}

/// An attribute that is called so has the colours of classes, unless a colormap or a range is asked for; others have
/// them when asked.
TEST(test_classes) {
    static const char view[] = "--view top --ortho 20 --size 80x40 --shading none";
    static const char *const codes[] = {"2", "6", "9", "37"}, *const mixed[] = {"2", "6.5", "-1", "nan"};
    uint8_t classes[4][3], viridis[4][3], partly[4][3];
    for (int k = 0; k < 4; k++) {
        ewa_class_color((const uint32_t[]){2, 6, 9, 37}[k], classes[k]);
        ewa_colormap_color(EWA_COLORMAP_VIRIDIS, ((const double[]){2, 6, 9, 37}[k] - 2) / 35, viridis[k]);
        memset(partly[k], 128, 3);
    }
    memcpy(partly[0], classes[0], 3);
    write_stripes("named.ply", "scalar_Classification", codes);
    write_stripes("other.ply", "q", codes);
    write_stripes("mixed.ply", "classification", mixed);
    run_done("ewa render -q named.ply -o a.png --color-by scalar_Classification %s", view);
    check_stripes("a.png", classes);
    run_done("ewa render -q other.ply -o b.png --color-by q --colormap classes %s", view);
    check_stripes("b.png", classes);
    run_done("ewa render -q named.ply -o c.png --color-by scalar_Classification --colormap viridis %s", view);
    check_stripes("c.png", viridis);
    run_done("ewa render -q named.ply -o d.png --color-by scalar_Classification --range 0%%,100%% %s", view);
    check_stripes("d.png", viridis);
    run_done("ewa render -q other.ply -o e.png --color-by q %s", view);
    check_stripes("e.png", viridis);
    // By itself only where all numbers are codes.
    assert_int_equal(
        run("ewa render mixed.ply -o f.png --color-by classification --colormap classes %s", view), 0);
    check_stripes("f.png", partly);
    assert_non_null(strstr(last_run.err, "1200 of 1600 numbers of classification are no classes"));
    assert_int_equal(run("ewa render mixed.ply -o g.png --color-by classification --verbose %s", view), 0);
    assert_non_null(strstr(last_run.err, "classification from -1 to 6.5"));
    assert_int_equal(run("ewa render named.ply -o h.png --color-by scalar_Classification --verbose %s", view),
                     0);
    assert_non_null(strstr(last_run.err, "has 4 classes, drawn in the colours of classes"));
    // The legend names them.
    run_done("ewa render -q named.ply -o i.png --color-by scalar_Classification --view top --size 640x480 --save-camera i.json");
    run_done("ewa render -q named.ply -o j.png --color-by scalar_Classification --camera i.json --size 640x480 "
             "--color-bar");
    size_t inside, outside;
    count_changes("i.png", "j.png", &(corner){0.7, 0.2, 1, 0.8}, &inside, &outside);
    assert_true(inside > 1000 && outside == 0);
}

int main(void) { return RUN_TESTS(enter, leave); }
