// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa photos: what its options do, what is wrong usage, what fails; a COLMAP model, masks, photographs on their side.
#include "run_ewa.h"

#include <math.h>
#include <string.h>

/// A file of the scratch folder as a text; the caller frees.
static char *read_text(const char *name) {
    FILE *file = fopen(scratch_path(name), "rb");
    char *text = calloc(1, (size_t)scratch_size(name) + 1);
    assert_true(file && text);
    assert_int_equal(fread(text, 1, (size_t)scratch_size(name), file), scratch_size(name));
    fclose(file);
    return text;
}

/// Runs ewa photos on the grey ball; it has to succeed.
static void photos_done(const char *options) {
    assert_int_equal(run("ewa photos grey.ply %s", options), 0);
}

/// A marble ball, four photographs of it with their cameras, and the ball in grey.
static int enter(void **state) {
    (void)state;
    if (scratch_enter("cli_photos")) return 1;
    run_done("ewa generate sphere --points 4000 --procedure marble -o marble.ply");
    run_done("ewa generate sphere --points 4000 -o grey.ply");
    char cameras[8000] = "[";
    for (int i = 0; i < 4; i++) {
        char name[32];
        run_done("ewa render marble.ply -o p%d.png --size 90x80 --azimuth %d --elevation 40 --shading none --background transparent "
                 "--save-camera c%d.json",
                 i, 90 * i + 25, i);
        snprintf(name, sizeof name, "c%d.json", i);
        OWNED(check_free) char *camera = read_text(name);
        snprintf(cameras + strlen(cameras), sizeof cameras - strlen(cameras), "%s{\"file_path\": \"p%d.png\", %.*s", i ? ",\n" : "",
                 i, (int)strlen(camera) - 1, camera + 1);
    }
    strcat(cameras, "]");
    scratch_text("cameras.json", cameras);
    return 0;
}

TEST(test_outputs) {
    (void)state;
    photos_done("--cameras cameras.json -o out.ply --report report.json --exposure off");
    assert_non_null(strstr(last_run.err, "4 photographs see "));
    run_done("ewa info out.ply");
    assert_non_null(strstr(last_run.out, "photo_count"));
    assert_non_null(strstr(last_run.out, "photo_residual"));
    char *report = read_text("report.json");
    assert_true(strstr(report, "\"used_count\": 4") && strstr(report, "p3.png"));
    free(report);
    static const char *const methods[] = {"fit", "median", "mean", "best"};
    for (int m = 0; m < 4; m++) {
        char options[200];
        snprintf(options, sizeof options, "--cameras cameras.json -o m.ply --method %s --hold-out 2 --rounds 1", methods[m]);
        photos_done(options);
        assert_non_null(strstr(last_run.err, "2 photographs that were not used"));
    }
    photos_done("--cameras cameras.json -o a.ply --exposure gain-offset --robust 0.1 --ridge 0.2 --spacing 0 --cutoff "
             "2.5 --verbose");
    assert_non_null(strstr(last_run.err, "p0.png: 90 x 80, "));
}

TEST(test_usage) {
    (void)state;
    static const char *const wrong[][2] = {
        {"grey.ply -o a.ply", "no cameras"},
        {"grey.ply --cameras cameras.json", "output"},
        {"grey.ply --cameras cameras.json -o a.ply --method magic", "magic"},
        {"grey.ply --cameras cameras.json -o a.ply --rounds 0", "rounds"},
        {"grey.ply --cameras cameras.json -o a.ply --ridge 0", "ridge"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        run_fails(2, wrong[i][1], "ewa photos %s", wrong[i][0]);
    }
}

TEST(test_failures) {
    (void)state;
    run_done("ewa convert grey.ply -o far.ply --translate 1000,0,0");
    scratch_text("bundle.out", "# Bundle file v0.3\n4 100\n");
    scratch_text("gone.json", "[{\"file_path\": \"gone.png\", \"width\": 9, \"height\": 9, \"fx\": 9, \"fy\": 9, \"cx\": 4, \"cy\": 4, "
                              "\"world_to_camera\": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]");
    scratch_text("size.json", "[{\"file_path\": \"p1.png\", \"width\": 91, \"height\": 80, \"fx\": 90, \"fy\": 90, \"cx\": 45, \"cy\": 40, "
                              "\"world_to_camera\": [1,0,0,0,0,1,0,0,0,0,1,4,0,0,0,1]}]");
    run_done("mkdir -p lens");
    scratch_text("lens/cameras.txt", "7 THIN_PRISM_FISHEYE 90 80 35 35 45 40 0 0 0 0 0 0 0 0\n");
    scratch_text("lens/images.txt", "1 1 0 0 0 0 0 4 7 p0.png\n\n");
    static const char *const wrong[][2] = {
        {"grey.ply --cameras size.json -o none.ply", "p1.png: is 90 x 80 pixels, and its camera is of 91 x 80"},
        {"grey.ply --cameras lens --images . -o none.ply", "model THIN_PRISM_FISHEYE"},
        {"grey.ply --cameras cameras.json --method mean --pose-steps 1 -o none.ply",
         "pose_steps is 1, and poses are refined by the method fit alone"},
        {"far.ply --cameras cameras.json -o none.ply", "none of 4 photographs that are used sees any of 4000 points"},
        {"grey.ply --cameras bundle.out -o none.ply", "bundle.out: is Bundler's bundle.out; cameras are the folder of a COLMAP model"},
        {"grey.ply --cameras gone.json -o none.ply", "gone.png"},
        {"grey.ply --cameras cameras.json --images nowhere -o none.ply", "p0.png"},
        {"grey.ply --cameras cameras.json --hold-out 1 -o none.ply", "hold_out is 1"},
        {"grey.ply --cameras cameras.json --masks nowhere -o none.ply", "there is no mask of"},
        {"nowhere.ply --cameras cameras.json -o none.ply", "nowhere.ply"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        run_fails(1, wrong[i][1], "ewa photos %s", wrong[i][0]);
        assert_true(scratch_size("none.ply") <= 0); // nothing is left half-written
    }
}

/// A camera that sees nothing is named, and the others count.
TEST(test_camera_that_sees_nothing) {
    (void)state;
    char *cameras = read_text("cameras.json"), text[9000];
    snprintf(text, sizeof text, "%.*s,\n{\"file_path\": \"p0.png\", \"width\": 90, \"height\": 80, \"fx\": 90, \"fy\": 90, \"cx\": 45, "
             "\"cy\": 40, \"world_to_camera\": [1,0,0,0,0,1,0,0,0,0,1,-50,0,0,0,1]}]", (int)strlen(cameras) - 1, cameras);
    free(cameras);
    scratch_text("away.json", text);
    photos_done("--cameras away.json -o away.ply");
    assert_non_null(strstr(last_run.err, "p0.png: photograph 4 sees none of the points"));
    assert_true(scratch_size("away.ply") > 0);
}

static uint64_t seen_points(void) {
    const char *said = strstr(last_run.err, " photographs see ");
    assert_non_null(said);
    return strtoull(said + strlen(" photographs see "), NULL, 10);
}

/// The same photographs by a COLMAP model, whose names are relative to the folder "images" beside it.
TEST(test_colmap) {
    (void)state;
    run_done("mkdir -p colmap/sparse/0 colmap/images");
    char images[2000] = "# Image list\n";
    for (int i = 0; i < 4; i++) {
        char name[32];
        run_done("cp p%d.png colmap/images/view%d.png", i, i);
        snprintf(name, sizeof name, "c%d.json", i);
        ewa_context *context = check_context(1, NULL);
        ewa_camera camera;
        assert_int_equal(ewa_camera_load(context, scratch_path(name), 0, &camera), EWA_OK);
        ewa_context_destroy(&context);
        const double *m = camera.world_to_camera;
        // Turns here have no angle of 180 degrees: w is not 0.
        const double w = 0.5 * sqrt(1 + m[0] + m[5] + m[10]);
        assert_true(w > 0.01);
        snprintf(images + strlen(images), sizeof images - strlen(images), "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 view%d.png\n\n",
                 i + 1, w, (m[9] - m[6]) / (4 * w), (m[2] - m[8]) / (4 * w), (m[4] - m[1]) / (4 * w), m[3], m[7], m[11], i);
        if (i == 0) {
            char cameras[200];
            snprintf(cameras, sizeof cameras, "# Camera list\n1 PINHOLE 90 80 %.17g %.17g %.17g %.17g\n", camera.fx_px, camera.fy_px,
                     camera.cx_px, camera.cy_px);
            scratch_text("colmap/sparse/0/cameras.txt", cameras);
        }
    }
    scratch_text("colmap/sparse/0/images.txt", images);
    photos_done("--cameras cameras.json -o own.ply --method mean --verbose");
    const uint64_t seen = seen_points();
    photos_done("--cameras colmap/sparse/0 -o model.ply --method mean --verbose");
    assert_non_null(strstr(last_run.err, "images/view3.png: 90 x 80"));
    assert_true(llabs((long long)seen_points() - (long long)seen) <= 2);
    photos_done("--cameras colmap/sparse/0 --images colmap/images -o model.ply --method mean");
}

/// Masks: white counts, black does not; a photograph without one counts as a whole.
TEST(test_masks) {
    (void)state;
    photos_done("--cameras cameras.json -o a.ply --method mean");
    const uint64_t all = seen_points();
    run_done("mkdir -p masks partly");
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    OWNED(ewa_image_free) ewa_image mask;
    assert_int_equal(ewa_image_create(context, 90, 80, 1, &mask), EWA_OK);
    for (int half = 0; half < 2; half++) {
        for (int i = 0; i < 80 * 90; i++) mask.pixels[i] = half && i / 90 < 40;
        char path[64];
        for (int i = 0; i < 4; i++) { // by either name
            snprintf(path, sizeof path, i % 2 ? "masks/p%d.png" : "masks/p%d.png.png", i);
            assert_int_equal(ewa_image_save(&mask, scratch_path(path), NULL), EWA_OK);
        }
        if (!half) {
            assert_int_equal(run("ewa photos grey.ply --cameras cameras.json --masks masks -o a.ply --method mean"), 1);
            assert_non_null(strstr(last_run.err, "none of 4 photographs that are used sees any"));
        }
    }
    photos_done("--cameras cameras.json --masks masks -o a.ply --method mean");
    assert_true(seen_points() > all / 4 && seen_points() < all * 3 / 4);
    assert_int_equal(ewa_image_save(&mask, scratch_path("partly/p2.png"), NULL), EWA_OK);
    photos_done("--cameras cameras.json --masks partly -o a.ply --method mean");
    assert_non_null(strstr(last_run.err, "3 of 4 photographs have no mask"));
    ewa_image_free(&mask);
    assert_int_equal(ewa_image_create(context, 9, 8, 1, &mask), EWA_OK);
    memset(mask.pixels, 0, 9 * 8 * sizeof *mask.pixels);
    assert_int_equal(ewa_image_save(&mask, scratch_path("partly/p2.png"), NULL), EWA_OK);
    assert_int_equal(run("ewa photos grey.ply --cameras cameras.json --masks partly -o a.ply --method mean"), 1);
    assert_non_null(strstr(last_run.err, "the mask is 9 x 8 pixels, its photograph 90 x 80"));
}

int main(void) { return RUN_TESTS(enter, NULL); }
