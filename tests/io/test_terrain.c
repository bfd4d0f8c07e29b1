// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures whose colours are heights: both ways of coding them, sizes of pixels by names of tiles, what is no height,
// every truncation; pictures are refused unless they are said to be heights.
#include "io/rows_check.h"

#include <sys/stat.h>
#include <webp/encode.h>

enum { COLUMNS = 3, ROWS = 2 };

/// A path below the scratch folder, whose folders are made.
static const char *make_path(const char *below, char path[512]) {
    scratch_path(below, path);
    for (char *slash = strchr(path + strlen(path) - strlen(below), '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        mkdir(path, 0777);
        *slash = '/';
    }
    return path;
}

static void code_height(double height, ewa_picture_heights heights, uint8_t *rgba) {
    const double steps = heights == EWA_HEIGHTS_TERRARIUM ? (height + 32768) * 256 : (height + 10000) * 10;
    const uint32_t code = (uint32_t)floor(steps + 0.5);
    rgba[0] = (uint8_t)(code >> 16);
    rgba[1] = (uint8_t)(code >> 8);
    rgba[2] = (uint8_t)code;
    rgba[3] = 255;
}

static const double HEIGHTS[COLUMNS * ROWS] = {-431, 0, 8848.5, 12, 3000.5, 100};

static void write_tile(const char *path, ewa_picture_heights heights, bool webp, int hole) {
    uint8_t codes[4 * COLUMNS * ROWS], *packed = NULL;
    for (int i = 0; i < COLUMNS * ROWS; i++) code_height(HEIGHTS[i], heights, codes + 4 * i);
    if (hole >= 0) codes[4 * hole + 3] = 0;
    if (!webp) {
        assert_int_equal(ewa_png_save(context, path, COLUMNS, ROWS, 4, codes, sizeof codes / ROWS), EWA_OK);
        return;
    }
    const size_t size = WebPEncodeLosslessRGBA(codes, COLUMNS, ROWS, 4 * COLUMNS, &packed);
    assert_true(size > 0);
    scratch_write(path, packed, size);
    WebPFree(packed);
}

static ewa_status load(const char *path, ewa_picture_heights heights, ewa_model *model) {
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.heights = heights;
    messages.count = 0;
    messages.text[0] = 0;
    return ewa_model_load(context, path, EWA_MODEL_POINTS, &options, model);
}

/// Holds points to the tile with pixels of a length.
static void expect_tile(const ewa_model *model, double length, int hole) {
    uint64_t point = 0;
    double origin_world[3];
    ewa_cloud_origin(model->points, origin_world);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        double place[3];
        if (i == hole) continue;
        assert_true(point < ewa_cloud_point_count(model->points));
        ewa_attribute_read_f64(ewa_cloud_find(model->points, EWA_POSITION), point++, 1, place);
        const double wanted[3] = {i % COLUMNS * length, -(i / COLUMNS) * length, HEIGHTS[i]};
        for (int c = 0; c < 3; c++)
            if (fabs(origin_world[c] + place[c] - wanted[c]) > 1e-6 * (1 + fabs(wanted[c])))
                fail_msg("point %d: %g, not %g", i, place[c], wanted[c]);
    }
    assert_int_equal(point, ewa_cloud_point_count(model->points));
}

TEST_WITHIN(test_codes, set_up, tear_down) {
    char path[512];
    OWNED(ewa_model_free) ewa_model model;
    for (int heights = EWA_HEIGHTS_TERRAIN_RGB; heights <= EWA_HEIGHTS_TERRARIUM; heights++)
        for (int webp = 0; webp < 2; webp++)
            for (int hole = -1; hole < 2; hole++) {
                write_tile(scratch_path("heights", path), heights, webp, hole);
                assert_int_equal(load(path, heights, &model), EWA_OK);
                assert_int_equal(model.format, EWA_MODEL_TERRAIN);
                assert_int_equal(messages.count, 1);
                assert_non_null(strstr(messages.text, "no name of a tile"));
                expect_tile(&model, 1, hole);
                ewa_model_free(&model);
            }
    assert_string_equal(ewa_model_format_name(EWA_MODEL_TERRAIN), "terrain picture");
    // Black is no height of Terrain-RGB; one of Terrarium, below all ground.
    const uint8_t black[8] = {0, 0, 0, 255, 1, 0, 0, 255};
    assert_int_equal(ewa_png_save(context, path, 2, 1, 4, black, sizeof black), EWA_OK);
    assert_int_equal(load(path, EWA_HEIGHTS_TERRAIN_RGB, &model), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(model.points), 1);
    ewa_model_free(&model);
    assert_int_equal(load(path, EWA_HEIGHTS_TERRARIUM, &model), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(model.points), 2);
}

TEST_WITHIN(test_tiles, set_up, tear_down) {
    const struct {
        const char *name;
        double length; ///< 0: no name of a tile
    } names[] = {
        // Around the equator is 40,075,016.686 m, times cos(latitude) = 1 / cosh(y).
        {"0/0/0.png", 40075016.686 / 3}, {"tiles/1/0/1.png", 40075016.686 / 6 / cosh(3.14159265358979 / 2)},
        {"t/12/2138/1452.png", 40075016.686 / 4096 / 3 / cosh(3.14159265358979 * (1 - 2 * 1452.5 / 4096))},
        {"12/2138/1452@2x.png", 40075016.686 / 4096 / 3 / cosh(3.14159265358979 * (1 - 2 * 1452.5 / 4096))},
        {"1/2/0.png", 0}, {"1/0/2.png", 0}, {"31/0/0.png", 0}, {"a1/0/0.png", 0}, {"1/0a/0.png", 0}, {"0/0/0a.png", 0},
        {"1/00000000000/0.png", 0},
    };
    char path[512];
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        OWNED(ewa_model_free) ewa_model model;
        write_tile(make_path(names[i].name, path), EWA_HEIGHTS_TERRARIUM, false, -1);
        assert_int_equal(load(path, EWA_HEIGHTS_TERRARIUM, &model), EWA_OK);
        if ((messages.count == 0) != (names[i].length > 0)) fail_msg("%s: %s", names[i].name, messages.text);
        expect_tile(&model, names[i].length > 0 ? names[i].length : 1, -1);
    }
}

TEST_WITHIN(test_refused, set_up, tear_down) {
    char path[512];
    OWNED(ewa_model_free) ewa_model model;
    write_tile(scratch_path("heights", path), EWA_HEIGHTS_TERRARIUM, false, -1);
    assert_int_equal(load(path, EWA_HEIGHTS_NONE, &model), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(messages.text, "a picture (PNG)"));
    // Other files are what they are.
    scratch_write(path, "1 2 3\n4 5 6\n", 12);
    assert_int_equal(load(path, EWA_HEIGHTS_TERRARIUM, &model), EWA_OK);
    assert_int_equal(model.format, EWA_MODEL_TEXT);
}

TEST_WITHIN(test_truncation, set_up, tear_down) {
    char path[512], cut_path[512];
    for (int webp = 0; webp < 2; webp++) {
        size_t size_bytes;
        write_tile(scratch_path("heights", path), EWA_HEIGHTS_TERRARIUM, webp, -1);
        OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
        for (size_t cut = 0; cut < size_bytes; cut++) {
            OWNED(ewa_model_free) ewa_model model;
            scratch_write(scratch_path("cut", cut_path), bytes, cut);
            // libspng needs no end of IEND, libwebp no byte that fills up.
            if (load(cut_path, EWA_HEIGHTS_TERRARIUM, &model) == EWA_OK && cut + 12 > size_bytes)
                expect_tile(&model, 1, -1);
            else
                assert_null(model.points);
        }
    }
}

static ewa_status load_failing(ewa_context *failing, void *user) {
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.heights = EWA_HEIGHTS_TERRARIUM;
    OWNED(ewa_model_free) ewa_model model;
    const ewa_status status = ewa_model_load(failing, user, EWA_MODEL_POINTS, &options, &model);
    return status;
}

TEST_WITHIN(test_failing_allocations, set_up, tear_down) {
    char path[512];
    write_tile(scratch_path("heights", path), EWA_HEIGHTS_TERRARIUM, true, -1);
    scratch_fail_each(load_failing, path);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
