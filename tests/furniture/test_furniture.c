// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/furniture: furniture.c, layout.c.
#include <math.h>

#include "furniture/decimal.h"
#include "furniture/layout.h"
#include "drawing.h"

/// Pixels of the longest dark run of the lowest row that has one; its right end goes to `*end`.
static uint32_t lowest_run(const ewa_canvas *canvas, uint32_t *end) {
    for (uint32_t y = canvas->height_px; y-- > 0;) {
        uint32_t longest = 0;
        for (uint32_t x = 0, run = 0; x < canvas->width_px; x++) {
            run = is_dark(painting_at(canvas, x, y)) ? run + 1 : 0;
            if (run > longest) longest = run, *end = x + 1;
        }
        if (longest) return longest;
    }
    return 0;
}

/// The scale bar is as long as it says, on canvases of the picture's size and of others, near the lower right corner.
TEST(test_scale_bar) {
    static const struct {
        double scale_px;
        uint32_t wanted_px;
    } cases[] = {{10, 100}, {1, 100}, {3, 150}, {0.7, 140}, {123, 123}, {1e-9, 100}, {1e12, 100}, {40, 80}};
    ewa_canvas canvas = painting_make(1280, 720, white);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        ewa_furniture_options options = no_furniture();
        options.scale_bar = true;
        for (int half = 0; half < 2; half++) {
            memset(canvas.rgba8, 255, 1280 * 720 * 4);
            ewa_camera camera = map_camera(&canvas, cases[k].scale_px / (1 + half));
            // A picture of half the size, shown at twice its pixels.
            camera.width_px /= 1 + (uint32_t)half;
            camera.height_px /= 1 + (uint32_t)half;
            draw(&canvas, &camera, &options);
            uint32_t end = 0;
            const uint32_t run = lowest_run(&canvas, &end);
            assert_in_range(run, cases[k].wanted_px - 1, cases[k].wanted_px + 1);
            assert_in_range(end, 1280 - 40, 1280);
        }
    }
    // A perspective camera has one at a depth only: 1000 px per slope, 50 units off.
    ewa_furniture_options options = no_furniture();
    options.scale_bar = true;
    ewa_camera camera = map_camera(&canvas, 1000);
    camera.projection = EWA_PERSPECTIVE;
    memset(canvas.rgba8, 255, 1280 * 720 * 4);
    ewa_canvas bare = painting_make(1280, 720, white);
    draw(&canvas, &camera, &options);
    assert_true(painting_same(&canvas, &bare));
    options.scale_depth_world = 50;
    draw(&canvas, &camera, &options);
    uint32_t end = 0;
    assert_in_range(lowest_run(&canvas, &end), 99, 101);
    free(canvas.rgba8), free(bare.rgba8);
}

/// A length in metres has the word that suits it, also where it is just one of these: as drawn in that word's unit.
TEST(test_words_of_lengths) {
    static const struct {
        const char *unit;
        double metres;
    } words[] = {{"km", 1000}, {"cm", 0.01}, {"mm", 0.001}};
    ewa_canvas canvas = painting_make(1280, 720, white), expected = painting_make(1280, 720, white);
    ewa_furniture_options options = no_furniture();
    options.scale_bar = true;
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        memset(canvas.rgba8, 255, 1280 * 720 * 4);
        memset(expected.rgba8, 255, 1280 * 720 * 4);
        const ewa_camera of_word = map_camera(&canvas, 123), of_metres = map_camera(&canvas, 123 / words[k].metres);
        options.unit = words[k].unit;
        draw(&expected, &of_word, &options);
        options.unit = "m";
        draw(&canvas, &of_metres, &options);
        assert_true(painting_same(&canvas, &expected));
    }
    free(canvas.rgba8), free(expected.rgba8);
}

/// Pixels of a square that are of a colour: where red, green or blue stands out.
static int count_of(const ewa_canvas *canvas, int channel, double x, double y, int reach) {
    int count = 0;
    for (int j = -reach; j <= reach; j++) {
        for (int i = -reach; i <= reach; i++) {
            const uint8_t *pixel = painting_at(canvas, (uint32_t)(x + i), (uint32_t)(y + j));
            const int other = pixel[(channel + 1) % 3] > pixel[(channel + 2) % 3] ? pixel[(channel + 1) % 3]
                                                                                  : pixel[(channel + 2) % 3];
            count += pixel[channel] > other + 60;
        }
    }
    return count;
}

/// Axes point where the camera sees them point: red x, green y, blue z.
TEST(test_axes) {
    ewa_canvas canvas = painting_make(720, 720, white);
    ewa_furniture_options options = no_furniture();
    options.axes = true;
    ewa_camera camera = check_camera(720, 720);
    // From the front, with z up: x right, z up, y away.
    const double eye[3] = {0, -5, 0}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    draw(&canvas, &camera, &options);
    const double x = 14 + 45, y = 720 - 14 - 45;
    assert_true(count_of(&canvas, 0, x + 20, y, 3) >= 12);
    assert_true(count_of(&canvas, 2, x, y - 20, 3) >= 12);
    assert_int_equal(count_of(&canvas, 0, x - 20, y, 3) + count_of(&canvas, 2, x, y + 20, 3), 0);
    // From above, with y up: y up, z towards the viewer.
    const double above[3] = {0, 0, 5}, north[3] = {0, 1, 0};
    assert_int_equal(ewa_camera_look_at(&camera, above, target, north), EWA_OK);
    memset(canvas.rgba8, 255, 720 * 720 * 4);
    draw(&canvas, &camera, &options);
    assert_true(count_of(&canvas, 0, x + 20, y, 3) >= 12);
    assert_true(count_of(&canvas, 1, x, y - 20, 3) >= 12);
    assert_int_equal(count_of(&canvas, 2, x, y - 20, 3), 0);
    free(canvas.rgba8);
}

/// Luminance of a pixel.
static double luminance(const uint8_t *pixel) {
    const double weights[] = {0.2126, 0.7152, 0.0722};
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += weights[c] * (double)ewa_linear_from_srgb((float)pixel[c] / 255);
    return sum;
}

/// On any ground, given ink or not, all of the letters' ink has something near it that it can be told from: a contrast
/// of 4.5 at least, as WCAG 2 asks of text.
TEST(test_legible) {
    const uint8_t *const grounds[] = {black, white, grey};
    for (int ground = 0; ground < 3; ground++) {
        for (int ink = EWA_INK_AUTO; ink <= EWA_INK_LIGHT; ink++) {
            ewa_canvas canvas = painting_make(400, 100, grounds[ground]);
            ewa_furniture_options options = no_furniture();
            options.title = "Title 0123456789";
            options.pixel_scale = 1;
            options.ink = (ewa_ink)ink;
            const ewa_camera camera = map_camera(&canvas, 1);
            draw(&canvas, &camera, &options);
            double low = 1, high = 0;
            for (uint32_t y = 2; y < 98; y++) {
                for (uint32_t x = 2; x < 398; x++) {
                    const double own = luminance(painting_at(&canvas, x, y));
                    low = fmin(low, own), high = fmax(high, own);
                    const bool letter = ink == EWA_INK_DARK ? own < 0.006 : own > 0.99;
                    if (!letter || ground < 2 || ink == EWA_INK_AUTO) continue;
                    double best = 1;
                    for (int j = -2; j <= 2; j++) {
                        for (int i = -2; i <= 2; i++) {
                            const double other = luminance(
                                painting_at(&canvas, (uint32_t)((int)x + i), (uint32_t)((int)y + j)));
                            best = fmax(best, (fmax(own, other) + 0.05) / (fmin(own, other) + 0.05));
                        }
                    }
                    assert_true(best >= 4.5);
                }
            }
            assert_true((high + 0.05) / (low + 0.05) >= 4.5);
            free(canvas.rgba8);
        }
    }
    // By itself the ink is what differs more.
    for (int ground = 0; ground < 3; ground++) {
        ewa_canvas canvas = painting_make(100, 100, grounds[ground]);
        const ewa_furniture_options options = no_furniture();
        const ewa_layout layout = {&canvas, &options, 1, {0, 0, 100, 100}};
        const ewa_inks inks = ewa_layout_inks(&layout, &(ewa_box){10, 10, 50, 50});
        assert_int_equal(inks.ink[0] > 128, ground == 0);
        free(canvas.rgba8);
    }
}

/// Titles that are too long end in dots, within the canvas, and in the middle of it.
TEST(test_shorten) {
    char text[EWA_LAYOUT_TEXT_BYTES];
    assert_true(ewa_layout_shorten("Short", 20, 500, text));
    assert_string_equal(text, "Short");
    const double some = ewa_text_width_px("Shor...", 20);
    assert_true(ewa_layout_shorten("Shortened by far", 20, some, text));
    assert_string_equal(text, "Shor...");
    assert_true(ewa_layout_shorten("°°°°°°°°°°", 20, ewa_text_width_px("°°...", 20), text));
    assert_string_equal(text, "°°...");
    assert_false(ewa_layout_shorten("Nothing", 20, 5, text));
    assert_false(ewa_layout_shorten("Nothing", 20, -5, text));
    assert_false(ewa_layout_shorten("", 20, 500, text));
    enum { LONG = 100000 };
    char *title = malloc(LONG + 1);
    memset(title, '|', LONG);
    title[LONG] = 0;
    assert_true(ewa_layout_shorten(title, 4, 1e9, text));
    assert_int_equal(strlen(text) < EWA_LAYOUT_TEXT_BYTES, 1);
    assert_string_equal(text + strlen(text) - 3, "...");
    ewa_canvas canvas = painting_make(400, 300, white);
    const ewa_camera camera = map_camera(&canvas, 1);
    ewa_furniture_options options = no_furniture();
    memset(title, 'W', LONG);
    options.title = title;
    draw(&canvas, &camera, &options);
    uint32_t first = 400, last = 0;
    for (uint32_t y = 0; y < 300; y++)
        for (uint32_t x = 0; x < 400; x++) {
            if (!is_dark(painting_at(&canvas, x, y))) continue;
            first = x < first ? x : first;
            last = x > last ? x : last;
        }
    assert_true(first >= 10 && last <= 390 && last - first > 300);
    assert_true(abs((int)first - (399 - (int)last)) <= 4);
    free(title), free(canvas.rgba8);
}

/// All that there is.
static ewa_furniture_options all_furniture(bool legend) {
    static const ewa_category categories[] = {
        {2, "ground", {160, 110, 60}}, {6, "building", {220, 80, 50}}, {NAN, NULL, {9, 9, 9}}};
    ewa_furniture_options options = no_furniture();
    options.title = "All of it";
    options.axes = options.scale_bar = options.color_bar = true;
    options.scale_depth_world = 10;
    options.unit = "m";
    options.color_label = legend ? "classification" : "z";
    options.color_unit = "m";
    options.colormap = EWA_COLORMAP_TURBO;
    options.range[0] = -12.5, options.range[1] = 87.5;
    options.categories = legend ? categories : NULL;
    options.category_count = legend ? 3 : 0;
    return options;
}

/// Canvases of every shape: nothing beside them is written, and what has no room is left out.
TEST(test_room) {
    static const uint32_t sizes[][2] = {{1, 1},      {16, 16},    {1, 500},    {500, 1},
                                        {40, 30},    {64, 48},    {100, 80},   {160, 120},
                                        {200, 2000}, {2000, 200}, {320, 1200}, {3840, 2160}};
    static const double scales[] = {0, 0.2, 1, 2, 7, 100};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        for (int s = 0; s < 12; s++) {
            ewa_canvas canvas = painting_make(sizes[k][0], sizes[k][1], grey);
            ewa_furniture_options options = all_furniture(s % 2);
            options.pixel_scale = scales[s / 2];
            ewa_camera camera = map_camera(&canvas, 3);
            if (s % 3 == 0) camera.projection = EWA_PERSPECTIVE;
            draw(&canvas, &camera, &options);
            if (k < 4 && scales[s / 2] != 0.2) {
                ewa_canvas bare = painting_make(sizes[k][0], sizes[k][1], grey);
                assert_true(painting_same(&canvas, &bare));
                free(bare.rgba8);
            }
            free(canvas.rgba8);
        }
    }
}

/// The ink of the scale bar is that of what is behind it, and of nothing else; it is no shorter than 20 points.
TEST(test_scale_bar_ground) {
    for (int inside = 0; inside < 2; inside++) { // black under it, white around it, and the other way round
        ewa_canvas canvas = painting_make(1280, 720, inside ? white : black);
        const ewa_camera camera = map_camera(&canvas, 10); // a bar of 100 pixels, longer than its text
        ewa_furniture_options options = no_furniture();
        options.scale_bar = true;
        options.pixel_scale = 1;
        painting_fill(&canvas, 1166, 681, 1266, 706, inside ? black : white);
        draw(&canvas, &camera, &options);
        const uint8_t *ink = painting_at(&canvas, 1166 + 50, 705);
        assert_true(inside ? ink[0] > 240 : ink[0] < 40);
        free(canvas.rgba8);
    }
    static const struct {
        double scale_px;
        bool drawn;
    } cases[] = {{1, true}, {1.05, true}, {0.95, false}, {10, true}, {9.5, false}};
    for (int k = 0; k < 5; k++) { // a quarter of the picture are 25 pixels, of which 20 or so are a nice length
        ewa_canvas canvas = painting_make(100, 400, white), bare = painting_make(100, 400, white);
        const ewa_camera camera = map_camera(&canvas, cases[k].scale_px);
        ewa_furniture_options options = no_furniture();
        options.scale_bar = true;
        options.pixel_scale = 1;
        draw(&canvas, &camera, &options);
        assert_int_equal(!painting_same(&canvas, &bare), cases[k].drawn);
        free(canvas.rgba8), free(bare.rgba8);
    }
}

/// Of a box about 64 pixels of a row and of a column are looked at: every third of 128.
TEST(test_looks) {
    for (int rows = 0; rows < 2; rows++) {
        ewa_canvas canvas = painting_make(300, 300, white);
        ewa_furniture_options options = no_furniture();
        const ewa_layout layout = {.canvas = &canvas, .options = &options, .point_px = 1};
        for (uint32_t y = 0; y < 300; y++)
            for (uint32_t x = 0; x < 300; x++)
                if (((rows ? y : x) + 2) % 3 == 0) memcpy(canvas.rgba8 + 4 * (y * 300 + x), black, 4);
        assert_true(ewa_layout_inks(&layout, &(ewa_box){40, 40, 168, 168}).ink[0] > 240);
        assert_true(ewa_layout_inks(&layout, &(ewa_box){41, 41, 169, 169}).ink[0] < 40); // the box beside
        free(canvas.rgba8);
    }
}

/// The title's ink is that of what is behind it; a legend stands on whole pixels, as far right as its texts let it.
TEST(test_title_and_legend_places) {
    ewa_canvas canvas = painting_make(400, 100, white);
    ewa_camera camera = map_camera(&canvas, 1);
    ewa_furniture_options options = no_furniture();
    options.title = "Title";
    options.pixel_scale = 1;
    const double half_px = ewa_text_width_px("Title", 18) / 2;
    painting_fill(&canvas, (uint32_t)(200 - half_px), 14, (uint32_t)ceil(200 + half_px), 32, black);
    draw(&canvas, &camera, &options);
    uint32_t bright = 0; // a rim is less white than ink
    for (uint32_t y = 16; y < 30; y++)
        for (uint32_t x = (uint32_t)(202 - half_px); x < 198 + half_px; x++)
            bright += painting_at(&canvas, x, y)[0] == 255;
    assert_true(bright > 10);
    free(canvas.rgba8);
    const ewa_category categories[] = {{.value = 0, .srgb = {255, 1, 0}}, {.value = 8, .srgb = {254, 2, 0}}};
    canvas = painting_make(1280, 720, white);
    camera = map_camera(&canvas, 1);
    options = no_furniture();
    options.color_bar = true;
    options.pixel_scale = 1.3;
    options.categories = categories;
    options.category_count = 2;
    draw(&canvas, &camera, &options);
    const double widest_px = fmax(ewa_text_width_px("0", 12 * 1.3), ewa_text_width_px("8", 12 * 1.3));
    const double left = 1280 - floor(14 * 1.3) - widest_px - 6 * 1.3 - floor(12 * 1.3);
    uint32_t found = 1280;
    for (uint32_t y = 0; y < 720; y++)
        for (uint32_t x = 0; x < found; x++)
            if (memcmp(painting_at(&canvas, x, y), categories[0].srgb, 3) == 0) found = x;
    assert_true(left != floor(left));
    assert_int_equal(found, floor(left));
    free(canvas.rgba8);
}

/// The scale bar is there where it and its text stay a margin away from the axes.
TEST(test_scale_bar_beside_axes) {
    int drawn_count = 0;
    for (uint32_t width = 212; width < 420; width += 8) {
        ewa_canvas canvas = painting_make(width, 500, white), alone = painting_make(width, 500, white);
        const ewa_camera camera = map_camera(&canvas, 10);
        ewa_furniture_options options = no_furniture();
        options.pixel_scale = 1;
        options.axes = true;
        draw(&alone, &camera, &options);
        options.scale_bar = true;
        options.unit = "lengths of a longer unit";
        draw(&canvas, &camera, &options);
        ewa_decimal length;
        assert_true(ewa_decimal_nice(fmin(0.25 * width, 180) / 10, &length));
        char number[EWA_DECIMAL_BYTES], text[128];
        ewa_decimal_write(length, number);
        snprintf(text, sizeof text, "%s %s", number, options.unit);
        const double wide = fmax(10 * ewa_decimal_value(length), ewa_text_width_px(text, 12));
        const bool drawn = width - 14 - wide >= 2 * 45 + 14 + 14; // the axes reach 45 points to both sides
        assert_int_equal(!painting_same(&canvas, &alone), drawn);
        drawn_count += drawn;
        free(canvas.rgba8), free(alone.rgba8);
    }
    assert_in_range(drawn_count, 3, 22);
}

/// What the contract excludes is refused with the name of the member, and nothing is drawn.
TEST(test_refused) {
    check_log log = {.count = 0};
    ewa_context *context = check_context(1, &log);
    ewa_canvas canvas = painting_make(640, 480, white), bare = painting_make(640, 480, white);
    ewa_camera camera = map_camera(&canvas, 1);
    ewa_furniture_options options = all_furniture(false);
    const struct {
        double *member, wrong;
        const char *said;
    } cases[] = {{&options.range[0], NAN, "range[0]"},
                 {&options.range[1], INFINITY, "range[1]"},
                 {&options.pixel_scale, -1, "pixel_scale"},
                 {&options.pixel_scale, 101, "pixel_scale"},
                 {&options.scale_depth_world, NAN, "scale_depth_world"},
                 {&options.scale_depth_world, -2, "scale_depth_world"},
                 {&camera.fx_px, 0, "fx"}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const double fine = *cases[k].member;
        *cases[k].member = cases[k].wrong;
        assert_int_equal(ewa_furniture_draw(context, &camera, &options, &canvas), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log.text, cases[k].said));
        *cases[k].member = fine;
    }
    options.category_count = 3;
    assert_int_equal(ewa_furniture_draw(context, &camera, &options, &canvas), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "category_count is 3"));
    options.category_count = 0;
    options.ink = (ewa_ink)3;
    assert_int_equal(ewa_furniture_draw(context, &camera, &options, &canvas), EWA_ERROR_ARGUMENT);
    options.ink = EWA_INK_AUTO;
    const ewa_canvas wrong[] = {{NULL, 640, 480}, {canvas.rgba8, 0, 480}, {canvas.rgba8, 640, 65537}};
    for (int k = 0; k < 3; k++)
        assert_int_equal(ewa_furniture_draw(context, &camera, &options, &wrong[k]), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_furniture_draw(context, NULL, &options, &canvas), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_furniture_draw(context, &camera, &options, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_furniture_draw(context, &camera, NULL, &canvas), EWA_OK);
    const ewa_furniture_options nothing = no_furniture();
    assert_int_equal(ewa_furniture_draw(context, &camera, &nothing, &canvas), EWA_OK);
    assert_true(painting_same(&canvas, &bare));
    ewa_context_destroy(&context);
    free(canvas.rgba8), free(bare.rgba8);
}

/// The same bytes on every machine.
TEST(test_golden) {
    static const uint64_t wanted[2] = {UINT64_C(0x63f8a141e555b726), UINT64_C(0xad321c233212d2e1)};
    for (int legend = 0; legend < 2; legend++) {
        ewa_canvas canvas = painting_make(900, 720, white);
        for (size_t i = 0; i < 900 * 720; i++) {
            canvas.rgba8[4 * i] = (uint8_t)(i / 900 / 3);
            canvas.rgba8[4 * i + 1] = (uint8_t)(i % 900 / 4);
            canvas.rgba8[4 * i + 3] = i % 900 < 100 ? 100 : 255;
        }
        ewa_camera camera;
        ewa_camera_init(&camera);
        const double eye[3] = {3, -5, 2}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        const ewa_furniture_options options = all_furniture(legend);
        draw(&canvas, &camera, &options);
        assert_int_equal(painting_hash(&canvas), wanted[legend]);
        free(canvas.rgba8);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
