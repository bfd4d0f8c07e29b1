// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of ewa_cloud_color_from_photos() by a sphere whose colours are known.
#include "tests/photos/photo_scene.h"

#include <math.h>

enum {
    POINTS = 2500,
    PHOTOS = 15,
    HELD_OUT = 5, // every fifth: 12 are used
    SIDE_PX = 135,
};

static ewa_photos_options options_of(ewa_photos_method method) {
    WITH_DEFAULTS(ewa_photos_options, options);
    options.method = method;
    options.hold_out = HELD_OUT;
    return options;
}

static void color(photo_scene *scene, const ewa_photos_options *options, ewa_photos_report *report,
                  ewa_photo_report *per_photo) {
    assert_int_equal(
        ewa_cloud_color_from_photos(scene->cloud, scene->photos, scene->count, options, report, per_photo), EWA_OK);
}

/// How far gains are from those that the photographs were made with, relative to the mean of the logarithms of those that
/// are used: the largest.
static double gains_off(const photo_scene *scene, const ewa_photo_report *per_photo, bool of_held_out) {
    double mean[3] = {0}, worst = 0;
    int used = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        used += !per_photo[i].held_out;
        for (int c = 0; c < 3 && !per_photo[i].held_out; c++) mean[c] += log(scene->gain[i][c]);
    }
    for (uint32_t i = 0; i < scene->count; i++)
        for (int c = 0; c < 3 && per_photo[i].held_out == of_held_out; c++)
            worst = fmax(worst, fabs(per_photo[i].gain[c] / (scene->gain[i][c] / exp(mean[c] / used)) - 1));
    return worst;
}

TEST(test_fit_is_sharper_than_means) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, POINTS, PHOTOS, SIDE_PX, 0.2, 0);
    double held_out_db[4];
    for (int m = 0; m < 4; m++) {
        const ewa_photos_options options = options_of((ewa_photos_method)m);
        ewa_photos_report report;
        ewa_photo_report per_photo[PHOTOS];
        color(scene, &options, &report, per_photo);
        held_out_db[m] = report.held_out_psnr_db;
        print_message("method %d: %.2f dB, held out %.2f dB, gains off %.3f %%, held out %.3f %%\n", m, report.psnr_db,
                      report.held_out_psnr_db, 100 * gains_off(scene, per_photo, false),
                      100 * gains_off(scene, per_photo, true));
        assert_int_equal(report.used_count, 12);
        assert_int_equal(report.held_out_count, 3);
        assert_int_equal(report.seen_count, POINTS);
        assert_true(gains_off(scene, per_photo, false) < 0.002);
        assert_true(gains_off(scene, per_photo, true) < 0.005); // by pixels, which means show less sharp
        assert_true(fabs(report.psnr_db - report.held_out_psnr_db) < 0.5);
    }
    assert_true(held_out_db[EWA_PHOTOS_FIT] > held_out_db[EWA_PHOTOS_MEAN] + 4);
}

/// What 20 % of gains cost where nobody looks for them.
TEST(test_exposure_is_needed) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, POINTS, PHOTOS, SIDE_PX, 0.2, 0.03);
    ewa_photos_options options = options_of(EWA_PHOTOS_FIT);
    ewa_photos_report none, gain, offset;
    ewa_photo_report per_photo[PHOTOS];
    options.exposure = EWA_EXPOSURE_OFF;
    color(scene, &options, &none, per_photo);
    for (uint32_t i = 0; i < PHOTOS; i++) assert_true(per_photo[i].gain[0] == 1 && per_photo[i].offset[0] == 0);
    options.exposure = EWA_EXPOSURE_GAIN;
    color(scene, &options, &gain, per_photo);
    options.exposure = EWA_EXPOSURE_GAIN_OFFSET;
    color(scene, &options, &offset, per_photo);
    print_message("off %.2f dB, gain %.2f dB, gain and offset %.2f dB\n", none.psnr_db, gain.psnr_db, offset.psnr_db);
    assert_true(gain.psnr_db > none.psnr_db + 3);
    assert_true(offset.psnr_db > gain.psnr_db + 0.2);
}

/// Paints a disc into a photograph, as of somebody who walks by.
static void cover(photo_scene *scene, uint32_t index, double x_px, double y_px, double radius_px) {
    ewa_image *image = &scene->images[index];
    for (uint32_t y = 0; y < image->height_px; y++)
        for (uint32_t x = 0; x < image->width_px; x++) {
            float *at = image->pixels + 4 * ((size_t)y * image->width_px + x);
            if (hypot(x - x_px, y - y_px) < radius_px) at[0] = 0.9f, at[1] = 0.05f, at[2] = 0.05f, at[3] = 1;
        }
}

TEST(test_what_walks_by_is_rejected) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, POINTS, PHOTOS, SIDE_PX, 0.1, 0);
    static const uint32_t covered[] = {1, 4, 8, 12};
    for (int i = 0; i < 4; i++) cover(scene, covered[i], 60 + 5 * i, 64, 13);
    ewa_photos_options options = options_of(EWA_PHOTOS_FIT);
    ewa_photos_report robust, plain, mean;
    color(scene, &options, &robust, NULL);
    const ewa_attribute *residual = ewa_cloud_find(scene->cloud, EWA_PHOTO_RESIDUAL);
    float largest = 0;
    for (uint64_t i = 0; i < POINTS; i++) {
        float number;
        ewa_attribute_read_f32(residual, i, 1, &number);
        largest = fmaxf(largest, number);
    }
    assert_true(largest > 0.1f); // the points behind say so
    options.robust = 0;
    color(scene, &options, &plain, NULL);
    options = options_of(EWA_PHOTOS_MEAN);
    color(scene, &options, &mean, NULL);
    print_message("robust %.2f dB, not %.2f dB, mean %.2f dB\n", robust.held_out_psnr_db, plain.held_out_psnr_db,
                  mean.held_out_psnr_db);
    assert_true(robust.held_out_psnr_db > plain.held_out_psnr_db + 5);
    assert_true(robust.held_out_psnr_db > mean.held_out_psnr_db + 6);
}

/// The bytes of what a run gives.
static void keep(const ewa_cloud *cloud, uint8_t *to) {
    const char *const names[] = {EWA_COLOR, EWA_PHOTO_COUNT, EWA_PHOTO_RESIDUAL};
    float *numbers = (float *)(void *)to;
    for (int k = 0; k < 3; k++) {
        const ewa_attribute *attribute = ewa_cloud_find(cloud, names[k]);
        assert_non_null(attribute);
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++, numbers += attribute->component_count)
            ewa_attribute_read_f32(attribute, i, 1, numbers);
    }
}

TEST(test_threads_and_order_change_no_byte) {
    (void)state;
    enum { BYTES = 5 * 2000 * sizeof(float) };
    static uint8_t first[BYTES], other[BYTES];
    for (uint32_t threads = 1; threads <= 5; threads += 2) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
        OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, 2000, 8, 100, 0.2, 0);
        ewa_photos_options options = options_of(EWA_PHOTOS_FIT);
        options.hold_out = 0, options.pose_steps = 1, options.vignetting = true;
        color(scene, &options, NULL, NULL);
        keep(scene->cloud, threads == 1 ? first : other);
        if (threads > 1) assert_memory_equal(first, other, BYTES);
        for (uint32_t i = 0; i < 4; i++) {
            const ewa_photo photo = scene->photos[i];
            scene->photos[i] = scene->photos[7 - i], scene->photos[7 - i] = photo;
        }
        ewa_photo_report per_photo[8];
        color(scene, &options, NULL, per_photo);
        keep(scene->cloud, other);
        assert_memory_equal(first, other, BYTES);
        // Reports keep the caller's order.
        assert_true(fabs(log(per_photo[0].gain[0] / per_photo[7].gain[0]) -
                         log(scene->gain[7][0] / scene->gain[0][0])) < 0.01);
    }
}

/// What is held out is compared with and nothing else: other pictures there change no byte of the cloud.
TEST(test_held_out_changes_no_byte) {
    (void)state;
    enum { BYTES = 5 * 1000 * sizeof(float) };
    static uint8_t first[BYTES], other[BYTES];
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, 1000, 8, 80, 0.2, 0);
    for (int method = 0; method < 4; method++) {
        ewa_photos_options options = options_of((ewa_photos_method)method);
        options.hold_out = 4;
        ewa_photos_report as_it_is, spoilt;
        ewa_photo_report per_photo[8];
        color(scene, &options, &as_it_is, per_photo);
        keep(scene->cloud, first);
        ewa_image kept[8];
        for (uint32_t i = 0; i < 8; i++) {
            kept[i] = scene->images[i];
            if (!per_photo[i].held_out) continue;
            assert_int_equal(ewa_image_create(context, kept[i].width_px, kept[i].height_px, 4, &scene->images[i]), EWA_OK);
            cover(scene, i, 40, 44, 30);
        }
        color(scene, &options, &spoilt, NULL);
        keep(scene->cloud, other);
        assert_memory_equal(first, other, BYTES);
        print_message("method %d: %.2f and %.2f dB, spoilt %.2f and %.2f dB\n", method, as_it_is.psnr_db,
                      as_it_is.held_out_psnr_db, spoilt.psnr_db, spoilt.held_out_psnr_db);
        assert_true(spoilt.psnr_db == as_it_is.psnr_db && spoilt.held_out_psnr_db < as_it_is.held_out_psnr_db - 2);
        for (uint32_t i = 0; i < 8; i++) {
            if (per_photo[i].held_out) ewa_image_free(&scene->images[i]);
            scene->images[i] = kept[i];
        }
    }
}

/// Colours of what is hidden, and of clouds without photographs on one side, stay.
TEST(test_unseen_points_keep_their_colors) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, 2000, 12, 100, 0, 0);
    uint8_t *old = check_add(scene->cloud, EWA_COLOR, EWA_U8, 4);
    for (uint32_t i = 0; i < 2000; i++) old[4 * i] = 255, old[4 * i + 1] = 0, old[4 * i + 2] = 255, old[4 * i + 3] = 255;
    ewa_photos_options chosen = options_of(EWA_PHOTOS_FIT);
    chosen.hold_out = 0;
    ewa_photos_report report;
    assert_int_equal(ewa_cloud_color_from_photos(scene->cloud, scene->photos, 1, &chosen, &report, NULL), EWA_OK);
    assert_true(report.seen_count > 500 && report.seen_count < 1000); // less than half of a sphere
    const ewa_attribute *color_of = ewa_cloud_find(scene->cloud, EWA_COLOR);
    const ewa_attribute *count_of = ewa_cloud_find(scene->cloud, EWA_PHOTO_COUNT);
    assert_int_equal(color_of->component_count, 4);
    assert_int_equal(count_of->type, EWA_U16);
    double eye[3];
    ewa_camera_eye(&scene->photos[0].camera, eye);
    for (uint64_t i = 0; i < 2000; i++) {
        float rgba[4], count, facing = -1;
        ewa_attribute_read_f32(color_of, i, 1, rgba);
        ewa_attribute_read_f32(count_of, i, 1, &count);
        for (int c = 0; c < 3; c++) facing += (float)eye[c] * scene->position[3 * i + (uint64_t)c];
        if (facing < -0.2f) assert_true(count == 0);
        if (count == 0) assert_true(rgba[0] == 1 && rgba[1] == 0 && rgba[2] == 1 && rgba[3] == 1);
        if (count > 0) assert_true(rgba[1] > 0.05f);
    }
}

TEST(test_photographs_are_halved) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, 1000, 4, 301, 0, 0);
    ewa_photos_options options = options_of(EWA_PHOTOS_MEAN);
    options.hold_out = 0;
    ewa_photo_report per_photo[4];
    ewa_photos_report halved, whole;
    color(scene, &options, &halved, per_photo); // points are some 14 pixels apart
    assert_int_equal(per_photo[0].width_px, 75);
    assert_int_equal(per_photo[0].height_px, 77);
    options.spacing_px = 0;
    color(scene, &options, &whole, per_photo);
    assert_int_equal(per_photo[0].width_px, 301);
    assert_true(fabs(halved.psnr_db - whole.psnr_db) < 3);
}

static void fails(photo_scene *scene, uint32_t count, const ewa_photos_options *options, const check_log *log,
                  const char *words) {
    const ewa_status status = ewa_cloud_color_from_photos(scene->cloud, scene->photos, count, options, NULL, NULL);
    assert_int_not_equal(status, EWA_OK);
    if (!strstr(log->text, words)) fail_msg("'%s' is not in '%s'", words, log->text);
    assert_null(ewa_cloud_find(scene->cloud, EWA_COLOR));
    assert_null(ewa_cloud_find(scene->cloud, EWA_PHOTO_COUNT));
}

TEST(test_bad_input_is_named) {
    (void)state;
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, &log);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, 1000, 4, 60, 0, 0);
    ewa_photos_options options = options_of(EWA_PHOTOS_MEAN);
    fails(scene, 0, NULL, &log, "no photographs");
    options.pose_steps = 2;
    fails(scene, 4, &options, &log, "pose_steps is 2, and poses are refined by the method fit alone");
    options.pose_steps = 0;
    options.hold_out = 1;
    fails(scene, 4, &options, &log, "hold_out is 1");
    options.hold_out = 0, options.rounds = 0;
    fails(scene, 4, &options, &log, "rounds is 0");
    const ewa_photo good = scene->photos[2];
    scene->photos[2].camera.width_px = 61;
    fails(scene, 4, NULL, &log, "photograph 2: is 60 x 68 pixels, and its camera is of 61 x 68");
    scene->photos[2] = good, scene->photos[2].image = NULL;
    fails(scene, 4, NULL, &log, "photograph 2: has neither a path nor an image");
    scene->photos[2].path = "/nowhere/there.png";
    fails(scene, 4, NULL, &log, "/nowhere/there.png");
    scene->photos[2] = good, scene->photos[2].camera.fx_px = NAN;
    fails(scene, 4, NULL, &log, "fx");
    scene->photos[2] = good;
    for (int i = 0; i < 4; i++) scene->photos[i].camera.world_to_camera[11] = -100; // all is behind
    fails(scene, 4, NULL, &log, "none of 4 photographs");
}

/// Turns and shifts cameras, so that what is seen moves by about `off_px`.
static void disturb(photo_scene *scene, double off_px) {
    check_random random = {7};
    for (uint32_t i = 0; i < scene->count; i++) {
        ewa_camera *camera = &scene->photos[i].camera;
        const double distance = 3, turn = off_px / camera->fx_px;
        double r[3], t[3], *m = camera->world_to_camera;
        for (int c = 0; c < 3; c++) r[c] = check_uniform(&random, -1, 1) * turn, t[c] = check_uniform(&random, -1, 1) * turn * distance;
        for (int c = 0; c < 4; c++) {
            const double p[3] = {m[c], m[4 + c], m[8 + c]};
            for (int k = 0; k < 3; k++) {
                const int a = (k + 1) % 3, b = (k + 2) % 3;
                m[4 * k + c] += r[a] * p[b] - r[b] * p[a] + (c == 3 ? t[k] : 0);
            }
        }
    }
}

/// Photographs whose poses are a pixel off are as good, after pose steps, as those with the true ones.
TEST(test_pose_steps) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, POINTS, PHOTOS, SIDE_PX, 0.2, 0);
    ewa_photos_options options = options_of(EWA_PHOTOS_FIT);
    ewa_photos_report exact, off, refined;
    ewa_photo_report per_photo[PHOTOS];
    color(scene, &options, &exact, NULL);
    disturb(scene, 1);
    color(scene, &options, &off, per_photo);
    for (uint32_t i = 0; i < PHOTOS; i++) assert_true(per_photo[i].shift_px == 0);
    options.pose_steps = 1;
    color(scene, &options, &refined, per_photo);
    print_message("exact %.2f dB, held out %.2f dB; off %.2f, %.2f dB; refined %.2f, %.2f dB, gains off %.3f %%\n", exact.psnr_db,
                  exact.held_out_psnr_db, off.psnr_db, off.held_out_psnr_db, refined.psnr_db, refined.held_out_psnr_db,
                  100 * gains_off(scene, per_photo, false));
    assert_true(off.held_out_psnr_db < exact.held_out_psnr_db - 5);
    assert_true(refined.psnr_db > exact.psnr_db - 0.15 && refined.held_out_psnr_db > exact.held_out_psnr_db - 0.35);
    assert_true(gains_off(scene, per_photo, false) < 0.002);
    for (uint32_t i = 0; i < PHOTOS; i++) {
        const double *m = per_photo[i].world_to_camera;
        assert_true(per_photo[i].shift_px > 0.1 && per_photo[i].shift_px < 3);
        for (int r = 0; r < 3; r++) // a turn is still one
            assert_true(fabs(m[4 * r] * m[4 * r] + m[4 * r + 1] * m[4 * r + 1] + m[4 * r + 2] * m[4 * r + 2] - 1) < 1e-4);
    }
}

/// A lens that leaves 70 % of the light in the corners.
TEST(test_vignetting) {
    (void)state;
    static const double lens[2] = {-0.4, 0.1};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, POINTS, PHOTOS, SIDE_PX, 0.2, 0);
    for (uint32_t i = 0; i < PHOTOS; i++) {
        ewa_image *image = &scene->images[i];
        const double middle[2] = {0.5 * image->width_px, 0.5 * image->height_px};
        for (uint32_t k = 0; k < image->width_px * image->height_px; k++) {
            const double x = k % image->width_px + 0.5 - middle[0], y = k / image->width_px + 0.5 - middle[1];
            const double r2 = (x * x + y * y) / (middle[0] * middle[0] + middle[1] * middle[1]);
            for (size_t c = 0; c < 3; c++) image->pixels[4 * (size_t)k + c] *= (float)(1 + lens[0] * r2 + lens[1] * r2 * r2);
        }
    }
    ewa_photos_options options = options_of(EWA_PHOTOS_FIT);
    ewa_photos_report as_it_is, corrected;
    color(scene, &options, &as_it_is, NULL);
    assert_true(as_it_is.vignetting[0] == 0 && as_it_is.vignetting[1] == 0);
    options.vignetting = true;
    color(scene, &options, &corrected, NULL);
    print_message("held out %.2f dB; corrected %.2f dB, %.4f %.4f\n", as_it_is.held_out_psnr_db, corrected.held_out_psnr_db,
                  corrected.vignetting[0], corrected.vignetting[1]);
    assert_true(corrected.held_out_psnr_db > as_it_is.held_out_psnr_db + 4);
    for (double r2 = 0.1; r2 < 0.45; r2 += 0.1) // the ball ends there
        assert_true(fabs(r2 * (corrected.vignetting[0] - lens[0] + r2 * (corrected.vignetting[1] - lens[1]))) < 0.003);
}

/// What progress has told; it gives up when so many calls are left.
typedef struct phases {
    char stages[200]; ///< one after another
    double fraction;
    uint32_t calls;
    int64_t calls_left;
} phases;

static bool note_phase(void *user, const char *stage, double fraction) {
    phases *seen = user;
    if (strncmp(stage, "photos: ", 8) != 0) return true;
    const size_t length = strlen(seen->stages), own = strlen(stage + 8);
    if (length < own + 1 || strncmp(seen->stages + length - own - 1, stage + 8, own) != 0) {
        char word[64];
        snprintf(word, sizeof word, "%.60s ", stage + 8);
        strcat(seen->stages, word);
    }
    assert_true(fraction >= seen->fraction && fraction <= 1);
    seen->fraction = fraction;
    seen->calls++;
    return seen->calls_left-- != 0;
}

TEST(test_progress_names_phases_and_gives_up) {
    (void)state;
    phases seen = {.calls_left = -1};
    OWNED(ewa_context_destroy) ewa_context *context = check_context_telling(0, note_phase, &seen);
    OWNED(photo_scene_free) photo_scene *scene = photo_scene_make(context, 300, 3, 40, 0, 0);
    ewa_photos_options options = options_of(EWA_PHOTOS_FIT);
    options.hold_out = 0, options.rounds = 1;
    assert_int_equal(ewa_cloud_color_from_photos(scene->cloud, scene->photos, 3, &options, NULL, NULL), EWA_OK);
    assert_string_equal(seen.stages, "samples exposures fit comparison ");
    assert_true(seen.fraction == 1);
    float before[900], after[900];
    ewa_attribute_read_f32(ewa_cloud_find(scene->cloud, EWA_COLOR), 0, 300, before);
    const uint32_t calls = seen.calls;
    for (uint32_t i = 0; i < calls; i++) {
        seen = (phases){.calls_left = i};
        assert_int_equal(ewa_cloud_color_from_photos(scene->cloud, scene->photos, 3, &options, NULL, NULL), EWA_CANCELLED);
        ewa_attribute_read_f32(ewa_cloud_find(scene->cloud, EWA_COLOR), 0, 300, after);
        assert_memory_equal(before, after, sizeof before);
    }
}

TEST(test_nothing_is_left_where_memory_ends) {
    (void)state;
    check_memory memory = {.calls_left = -1};
    ewa_context *context = check_context_on(2, &memory);
    photo_scene *scene = photo_scene_make(context, 300, 3, 40, 0, 0);
    ewa_photos_options options = options_of(EWA_PHOTOS_FIT);
    options.hold_out = 0, options.rounds = 1, options.pose_steps = 1, options.vignetting = true;
    const int64_t before = memory.held_bytes;
    bool done = false;
    for (long calls = 0; !done; calls += calls < 40 ? 1 : 17) {
        memory.calls_left = calls;
        const ewa_status status =
            ewa_cloud_color_from_photos(scene->cloud, scene->photos, scene->count, &options, NULL, NULL);
        done = status == EWA_OK;
        if (done) break;
        assert_int_equal(status, EWA_ERROR_MEMORY);
        assert_int_equal(memory.held_bytes, before);
        assert_null(ewa_cloud_find(scene->cloud, EWA_COLOR));
        assert_null(ewa_cloud_find(scene->cloud, EWA_PHOTO_COUNT));
    }
    memory.calls_left = -1;
    photo_scene_free(&scene);
    ewa_context_destroy(&context);
    assert_int_equal(memory.held_bytes, 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
