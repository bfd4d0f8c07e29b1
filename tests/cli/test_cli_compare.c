// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa compare: pictures that the program drew itself are the photographs; one of them is spoilt.
#include "check_pictures.h"

#include <math.h>

static int enter(void **state) {
    const int status = scratch_enter("cli_compare");
    WITH_DEFAULTS(ewa_context_options, options);
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    FILE *file = fopen(scratch_path("set.ply"), "w");
    assert_non_null(file);
    fprintf(file, "ply\nformat ascii 1.0\nelement vertex 60\nproperty float x\nproperty float y\nproperty float z\n"
                  "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nproperty float opacity\n"
                  "property float scale_0\nproperty float scale_1\nproperty float scale_2\nproperty float rot_0\n"
                  "property float rot_1\nproperty float rot_2\nproperty float rot_3\nend_header\n");
    for (int i = 0; i < 60; i++)
        fprintf(file, "%g %g %g %g %g %g 1 -1.2 -1.2 -4 %g %g 0.3 0.1\n", cos(i), sin(1.7 * i), cos(2.3 * i), sin(i),
                cos(3 * i), sin(5 * i), 1 + 0.5 * sin(i), cos(7 * i));
    fclose(file);
    return status;
}

/// Cameras of a turntable with the photographs' names, one of which is that of another.
static void write_cameras(const char *name, const char *third) {
    char *text = calloc(1, 16384), *to = text;
    FILE *file = fopen(scratch_path("turn.json"), "r");
    assert_non_null(file);
    int c, count = 0;
    while ((c = fgetc(file)) != EOF) {
        *to++ = (char)c;
        if (c != '{') continue;
        if (count == 2)
            to += sprintf(to, "\"file_path\": \"%s\", ", third);
        else
            to += sprintf(to, "\"file_path\": \"view_%d.png\", ", count);
        count++;
    }
    fclose(file);
    assert_int_equal(count, 4);
    scratch_text(name, text);
    free(text);
}

/// The number behind a name in the table of the last run.
static double number_of(const char *name, int which) {
    const char *row = strstr(last_run.out, name);
    unsigned width, height;
    double psnr_db, ssim;
    assert_non_null(row);
    if (strcmp(name, "mean") == 0)
        assert_int_equal(sscanf(row + 4, "%lf %lf", &psnr_db, &ssim), 2);
    else
        assert_int_equal(sscanf(row + strlen(name), "%u x %u %lf %lf", &width, &height, &psnr_db, &ssim), 4);
    return which ? ssim : psnr_db;
}

TEST(compared) {
    run_done("ewa render set.ply -o view_%%d.png --turntable 4 --size 96x72 --background 0.2,0.3,0.4 --save-camera "
             "turn.json");
    write_cameras("cameras.json", "view_2.png");
    write_cameras("spoilt.json", "view_0.png");
    run_done("ewa compare set.ply --cameras cameras.json --background 0.2,0.3,0.4 --json all.json -o sheet.png");
    assert_true(number_of("view_2.png", 0) > 50 && number_of("view_2.png", 1) > 0.999);
    assert_true(number_of("mean", 0) > 50);
    char said[4096];
    strcpy(said, last_run.out);
    // Whoever counts.
    run_done("ewa compare set.ply --cameras cameras.json --background 0.2,0.3,0.4 --threads 1");
    assert_string_equal(said, last_run.out);
    run_done("ewa compare set.ply --cameras cameras.json --background 0.2,0.3,0.4 --json - && cat all.json");
    assert_non_null(strstr(last_run.out, "\"mean_psnr_db\""));
    assert_non_null(strstr(last_run.out, "view_3.png"));
    assert_null(strstr(last_run.out, "photograph  "));
    // Another order, background or photograph is seen.
    run_done("ewa compare set.ply --cameras cameras.json --background 0.2,0.3,0.4 --order ray");
    assert_true(number_of("mean", 0) < 45);
    run_done("ewa compare set.ply --cameras cameras.json");
    assert_true(number_of("mean", 0) < 25);
    run_done("ewa compare set.ply --cameras spoilt.json --background 0.2,0.3,0.4 -o worst.png --worst 1");
    const char *second = strstr(strstr(last_run.out, "view_0.png") + 1, "view_0.png");
    assert_non_null(second);
    ewa_image sheet = load("worst.png");
    assert_true(sheet.width_px == 3 * 96 + 2 * 4 && sheet.height_px > 72 && sheet.height_px < 120);
    // Its photograph is the first one, its picture the third.
    ewa_image first = load("view_0.png"), third = load("view_2.png");
    const size_t top = sheet.height_px - 4 - 72;
    double off[2] = {0, 0};
    for (size_t y = 0; y < 72; y++)
        for (size_t x = 0; x < 96; x++)
            for (size_t c = 0; c < 3; c++) {
                const ewa_image *const views[2] = {&first, &third};
                for (size_t k = 0; k < 2; k++) {
                    const float shown = sheet.pixels[sheet.channel_count * ((top + y) * sheet.width_px + 100 * k + x) + c];
                    const float was = views[k]->pixels[views[k]->channel_count * (y * 96 + x) + c];
                    off[k] = fmax(off[k], fabs((double)(shown - was)));
                }
            }
    assert_true(off[0] < 0.01 && off[1] < 0.02);
    for (ewa_image *const *at = (ewa_image *const[]){&sheet, &first, &third, NULL}; *at; at++) ewa_image_free(*at);
    run_done("ewa compare set.ply --cameras cameras.json --every 3");
    assert_true(strstr(last_run.out, "view_3.png") && !strstr(last_run.out, "view_1.png"));
}

TEST(refused) {
    const int before = scratch_count();
    run_fails(2, "--cameras", "ewa compare set.ply");
    run_fails(2, "opaque", "ewa compare set.ply --cameras cameras.json --background transparent");
    run_fails(2, "--output", "ewa compare set.ply --cameras cameras.json -o x.txt");
    run_fails(1, "none.json", "ewa compare set.ply --cameras none.json");
    run_fails(1, "none.ply", "ewa compare none.ply --cameras cameras.json -o x.png --json x.json");
    write_cameras("missing.json", "view_9.png");
    run_fails(1, "view_9.png", "ewa compare set.ply --cameras missing.json -o x.png");
    run_done("ewa render set.ply -o large.png --size 100x72");
    write_cameras("large.json", "large.png");
    run_fails(1, "is 100 x 72 pixels, and its camera is of 96 x 72", "ewa compare set.ply --cameras large.json -o x.png");
    assert_int_equal(scratch_count(), before + 3);
}

int main(void) { return RUN_TESTS(enter, leave); }
