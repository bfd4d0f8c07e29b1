// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/furniture/text.c and font.c: letters on pixels.
#include <math.h>

#include "furniture/font.h"
#include "painting.h"

static const ewa_text_style plain = {.height_px = 20, .rgba = {255, 255, 255, 255}};

/// Characters beyond ASCII that there are letters for.
static const char *const signs[] = {"°", "±", "²", "³", "µ", "·", "×", "μ", "–", "…",
                                    "Ä", "Ö", "Ü", "ß", "ä", "é", "è", "ê", "ñ", "ö",
                                    "ü", "ø", "Ø", "æ", "Æ", "å", "ç", "î", "ï", "÷"};

enum { SIGNS = sizeof signs / sizeof signs[0], GOLDEN_SIGNS = 10 };

/// The width of a text is the sum of its characters', in whole pixels.
TEST(test_width) {
    check_random random = {1};
    for (int k = 0; k < 2000; k++) {
        char text[41] = "";
        const double height = check_uniform(&random, 4, 100);
        double sum = 0;
        const int length = (int)check_uniform(&random, 0, 40);
        for (int i = 0; i < length; i++) {
            const char one[2] = {(char)(' ' + check_random_u64(&random) % 95), 0};
            sum += ewa_text_width_px(one, height);
            strcat(text, one);
        }
        assert_true(ewa_text_width_px(text, height) == sum);
        assert_true(sum == floor(sum));
    }
    assert_true(ewa_text_width_px("m", 20) > ewa_text_width_px("i", 20));
    assert_true(ewa_text_width_px("1", 20) == ewa_text_width_px("8", 20));
    assert_true(ewa_text_width_px("", 20) == 0);
}

/// Digits are of one width, so that numbers below each other stand in columns.
TEST(test_digits) {
    for (double height = 4; height < 100; height += 0.7)
        for (char digit = '1'; digit <= '9'; digit++)
            assert_true(ewa_text_width_px((const char[]){digit, 0}, height) ==
                        ewa_text_width_px("0", height));
}

/// Upright and level strokes of small letters cover whole pixels; they stand on the baseline and 0.7 high.
TEST(test_whole_pixels) {
    ewa_canvas canvas = painting_empty(60, 60);
    for (int height = 10; height <= 28; height++) {
        ewa_text_style style = plain;
        style.height_px = height;
        painting_clear(&canvas);
        // Without their round ends: the middle of an E and of an H.
        ewa_draw_text(&canvas, "H", 10, 40, &style);
        const double width = ewa_text_width_px("H", height) - fmax(1, floor(0.13 * height + 0.5));
        const int top = 40 - (int)floor(0.7 * height + 0.5);
        uint32_t grey = 0, covered = 0;
        for (uint32_t y = 0; y < 60; y++) {
            for (uint32_t x = 0; x < 60; x++) {
                const int alpha = painting_at(&canvas, x, y)[3];
                const bool inside = x >= 10 && x < 10 + width && y < 40 && (int)y >= top - 1;
                assert_true(inside || alpha == 0);
                covered += alpha == 255;
                grey += alpha > 0 && alpha < 255;
            }
        }
        // Four ends of two pixels each, at most.
        assert_true(grey <= 8 && covered >= 2 * 0.6 * height);
        assert_int_equal(painting_at(&canvas, 10, 39)[3] > 0, 1);
    }
    free(canvas.rgba8);
}

/// Letters that are symmetric are so on the pixels.
TEST(test_symmetric) {
    for (double height = 6; height < 60; height += 1.3) {
        for (const char *c = "oAHIMOTUVWXYvwx018-+=|\".:*^_"; *c; c++) {
            if (*c == '1') continue;
            ewa_text_style style = plain;
            style.height_px = height;
            const char text[2] = {*c, 0};
            ewa_canvas canvas = painting_empty(100, 100);
            ewa_draw_text(&canvas, text, 10, 80, &style);
            uint32_t first = 100, last = 0;
            for (uint32_t y = 0; y < 100; y++) {
                for (uint32_t x = 0; x < 100; x++) {
                    if (!painting_at(&canvas, x, y)[3]) continue;
                    first = x < first ? x : first;
                    last = x > last ? x : last;
                }
            }
            assert_true(first <= last);
            for (uint32_t y = 0; y < 100; y++)
                for (uint32_t x = first; x <= last; x++) {
                    const int off =
                        painting_at(&canvas, x, y)[3] - painting_at(&canvas, first + last - x, y)[3];
                    if (abs(off) > 1) print_error("%s at %g\n", text, height);
                    assert_true(abs(off) <= 1);
                }
            free(canvas.rgba8);
        }
    }
}

/// Every character is drawn, and no two alike but for the two signs of micro.
TEST(test_letters_differ) {
    enum { ALL = 94 + SIGNS + 1 };
    static const double heights[] = {10, 20, 40};
    for (int h = 0; h < 3; h++) {
        uint64_t hashes[ALL];
        for (int k = 0; k < ALL; k++) {
            const char ascii[2] = {(char)('!' + k), 0};
            const char *text = k < 94 ? ascii : k < 94 + SIGNS ? signs[k - 94] : "\xe2\x82\xac";
            ewa_text_style style = plain;
            style.height_px = heights[h];
            ewa_canvas canvas = painting_empty(60, 60);
            ewa_draw_text(&canvas, text, 5, 40, &style);
            assert_true(painting_area(&canvas) > 0.5);
            hashes[k] = painting_hash(&canvas);
            free(canvas.rgba8);
            for (int other = 0; other < k; other++) {
                const bool micro = k == 94 + 7 && other == 94 + 4;
                if ((hashes[k] == hashes[other]) != micro) print_error("%s and %d\n", text, other);
                assert_true((hashes[k] == hashes[other]) == micro);
            }
        }
    }
}

/// A letter with a mark is the letter, as wide as without, and something above it, or below.
TEST(test_marks) {
    static const struct {
        const char *marked, *bare;
        bool below;
    } cases[] = {{"ä", "a", false}, {"Ä", "A", false}, {"ö", "o", false}, {"Ü", "U", false},
                 {"é", "e", false}, {"È", "E", false}, {"ê", "e", false}, {"ñ", "n", false},
                 {"Å", "A", false}, {"å", "a", false}, {"ÿ", "y", false}, {"Ó", "O", false},
                 {"ç", "c", true},  {"Ç", "C", true}};
    for (int height = 10; height <= 40; height += 5) {
        for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
            ewa_text_style style = plain;
            style.height_px = height;
            ewa_canvas with = painting_empty(80, 80), bare = painting_empty(80, 80);
            ewa_draw_text(&with, cases[k].marked, 20, 50, &style);
            ewa_draw_text(&bare, cases[k].bare, 20, 50, &style);
            assert_true(ewa_text_width_px(cases[k].marked, height) ==
                        ewa_text_width_px(cases[k].bare, height));
            double above = 0, below = 0;
            for (uint32_t y = 0; y < 80; y++) {
                for (uint32_t x = 0; x < 80; x++) {
                    const int more = painting_at(&with, x, y)[3] - painting_at(&bare, x, y)[3];
                    assert_true(more >= 0);
                    *(y < 50 - 0.45 * height ? &above : &below) += more / 255.0;
                }
            }
            assert_true((cases[k].below ? below : above) >= 1);
            assert_true((cases[k].below ? above : below) == 0);
            free(with.rgba8), free(bare.rgba8);
        }
    }
}

/// Paths are what font.h says, and lie within the letter's width and what text.c takes for its height.
TEST(test_paths) {
    static const char digits[] = "0123456789abcdefghijklmnopqrstuvwxyz";
    for (uint32_t k = 0; k < 0x4200; k++) {
        bool raised;
        const ewa_glyph *glyph = k % 2 ? ewa_font_mark(k / 2, &raised) : ewa_font_glyph(k / 2);
        if (!glyph) continue;
        bool begun = false;
        for (const char *c = glyph->path; *c;) {
            int points = 1;
            if (*c == ' ') {
                begun = false;
                c++;
            } else if (*c == '-' || *c == '!' || *c == '(') {
                assert_true(begun);
                points = *c++ == '(' ? 2 : 1;
            }
            for (; points > 0; points--, c += 2) {
                assert_true(c[0] && strchr(digits, c[0]) && c[1] && strchr(digits, c[1]));
                assert_true(strchr(digits, c[0]) - digits <= glyph->width);
                assert_true(strchr(digits, c[1]) - digits <= 18);
            }
            begun = true;
        }
    }
}

/// Takes a text apart, and says what it is made of.
static void check_codes(const char *text, const uint32_t *codes) {
    for (; *codes; codes++) assert_int_equal(ewa_font_next(&text), *codes);
    assert_int_equal(ewa_font_next(&text), 0);
}

/// Well-formed UTF-8 is read, each byte of what is not counts alone.
TEST(test_utf8) {
    enum { BAD = 0xffffffffu };
    check_codes("aµ…\xf0\x9f\x98\x80", (const uint32_t[]){'a', 0xb5, 0x2026, 0x1f600, 0});
    check_codes("\xff\x80", (const uint32_t[]){BAD, BAD, 0});
    check_codes("\xc0\x80", (const uint32_t[]){BAD, BAD, 0});
    check_codes("\xe0\x80\xaf", (const uint32_t[]){BAD, BAD, BAD, 0});
    check_codes("\xed\xa0\x80", (const uint32_t[]){BAD, BAD, BAD, 0});
    check_codes("\xf4\x90\x80\x80", (const uint32_t[]){BAD, BAD, BAD, BAD, 0});
    check_codes("\xf5z", (const uint32_t[]){BAD, 'z', 0});
    check_codes("x\xe2\x82", (const uint32_t[]){'x', BAD, BAD, 0});
    check_codes("\xe2\x28\xa1", (const uint32_t[]){BAD, '(', BAD, 0});
    check_codes("\xf0", (const uint32_t[]){BAD, 0});
    // Each of these is one box.
    assert_true(ewa_text_width_px("\xe2\x82\xac\xff\t", 20) == 3 * ewa_text_width_px("\n", 20));
}

/// Where a text goes by each of its anchors.
TEST(test_anchors) {
    const double gap = 3, width = ewa_text_width_px("Hello", 20) - gap, high = 14;
    ewa_canvas wanted = painting_empty(200, 80), canvas = painting_empty(200, 80);
    ewa_draw_text(&wanted, "Hello", 50, 40, &plain);
    assert_true(painting_area(&wanted) > 100);
    for (int anchor = EWA_TEXT_LEFT; anchor <= EWA_TEXT_RIGHT_TOP; anchor++) {
        ewa_text_style style = plain;
        style.anchor = (ewa_text_anchor)anchor;
        painting_clear(&canvas);
        const int down = anchor / 3;
        ewa_draw_text(&canvas, "Hello", 50 + width * (anchor % 3) / 2,
                      40 - (down == 1   ? high / 2
                            : down == 2 ? high
                                        : 0),
                      &style);
        assert_true(painting_same(&canvas, &wanted));
    }
    free(wanted.rgba8), free(canvas.rgba8);
}

/// A rim surrounds the letters evenly, and leaves their inside alone.
TEST(test_rim) {
    ewa_text_style style = plain;
    style.height_px = 24;
    ewa_canvas bare = painting_empty(300, 60), rimmed = painting_empty(300, 60);
    ewa_draw_text(&bare, "Rim of letters 9", 10, 40, &style);
    style.halo_px = 3;
    style.halo_rgba[3] = 255;
    ewa_draw_text(&rimmed, "Rim of letters 9", 10, 40, &style);
    for (uint32_t y = 0; y < 60; y++) {
        for (uint32_t x = 0; x < 300; x++) {
            const uint8_t *letter = painting_at(&bare, x, y), *both = painting_at(&rimmed, x, y);
            if (letter[3] == 255) assert_memory_equal(letter, both, 4);
            double nearest = 1e9;
            for (int j = -5; j <= 5; j++) {
                for (int i = -5; i <= 5; i++) {
                    const int64_t u = (int64_t)x + i, v = (int64_t)y + j;
                    if (u < 0 || v < 0 || u >= 300 || v >= 60) continue;
                    if (painting_at(&bare, (uint32_t)u, (uint32_t)v)[3] > 127)
                        nearest = fmin(nearest, hypot(i, j));
                }
            }
            if (nearest <= 1.5) assert_int_equal(both[3], 255);
            if (nearest > 5) assert_int_equal(both[3], 0);
        }
    }
    free(bare.rgba8), free(rimmed.rgba8);
}

/// Nothing is drawn of what has no size or no place; edges clip; long texts take no time off the canvas.
TEST(test_hostile) {
    static const double heights[] = {NAN, INFINITY, -INFINITY, 0, -10, 3.9, 1001, 1e300};
    ewa_canvas canvas = painting_empty(31, 17);
    for (size_t k = 0; k < sizeof heights / sizeof heights[0]; k++) {
        ewa_text_style style = plain;
        style.height_px = heights[k];
        ewa_draw_text(&canvas, "Text", 5, 10, &style);
        ewa_draw_text(&canvas, "Text", k % 2 ? heights[k % 3] : 5, k % 2 ? 5 : heights[k % 3], &plain);
        assert_true(ewa_text_width_px("Text", heights[k]) == 0);
    }
    ewa_draw_text(&canvas, NULL, 5, 10, &plain);
    ewa_draw_text(&canvas, "", 5, 10, &plain);
    assert_true(ewa_text_width_px(NULL, 10) == 0);
    assert_true(painting_area(&canvas) == 0);
    enum { LONG = 40000 };
    char *text = malloc(LONG + 1);
    memset(text, 'W', LONG);
    text[LONG] = 0;
    ewa_text_style style = plain;
    for (int anchor = 0; anchor <= 8; anchor++) {
        style.anchor = (ewa_text_anchor)anchor;
        ewa_draw_text(&canvas, text, 15, 10, &style);
    }
    assert_true(painting_area(&canvas) > 50);
    check_random random = {7};
    for (int k = 0; k < 2000; k++) {
        style.height_px = check_uniform(&random, 4, k % 50 ? 40 : 1000);
        style.halo_px = k % 3 ? check_uniform(&random, -1, 9) : NAN;
        style.halo_rgba[3] = 99;
        style.anchor = (ewa_text_anchor)(k % 9);
        ewa_draw_text(&canvas, "Ag|_%@~µ\xfe", check_uniform(&random, -60, 90),
                      check_uniform(&random, -60, 90), &style);
    }
    free(text), free(canvas.rgba8);
}

/// Pixels do not depend on where the canvas lies in memory, nor on how it is cut off.
TEST(test_same) {
    ewa_text_style style = {22.5, {250, 240, 20, 230}, 7, {10, 20, 90, 160}, EWA_TEXT_LEFT};
    enum { WIDE = 211, HIGH = 60 };
    ewa_canvas whole = painting_make(WIDE, HIGH, (const uint8_t[4]){40, 90, 60, 255});
    ewa_draw_text(&whole, "Äïk 0.5 m² & Îço", 7, 40, &style);
    uint8_t *block = malloc(WIDE * HIGH * 4 + 8);
    for (size_t shift = 0; shift < 5; shift++) {
        ewa_canvas moved = {block + shift, WIDE, HIGH};
        for (size_t i = 0; i < WIDE * HIGH; i++)
            memcpy(moved.rgba8 + 4 * i, (const uint8_t[4]){40, 90, 60, 255}, 4);
        ewa_draw_text(&moved, "Äïk 0.5 m² & Îço", 7, 40, &style);
        assert_true(painting_same(&whole, &moved));
    }
    free(block);
    for (uint32_t cut = 1; cut < 100; cut += 7) {
        ewa_canvas part = painting_make(WIDE - cut, HIGH - cut / 2, (const uint8_t[4]){40, 90, 60, 255});
        ewa_draw_text(&part, "Äïk 0.5 m² & Îço", 7.0 - cut, 40.0 - cut / 2, &style);
        for (uint32_t y = 0; y < part.height_px; y++)
            assert_memory_equal(painting_at(&part, 0, y), painting_at(&whole, cut, y + cut / 2),
                                4 * (size_t)part.width_px);
        free(part.rgba8);
    }
    free(whole.rgba8);
}

/// The same bytes on every machine: all letters in three sizes.
TEST(test_golden) {
    static const double heights[] = {10, 14, 37};
    ewa_canvas canvas = painting_make(800, 260, (const uint8_t[4]){70, 130, 180, 255});
    double y = 20;
    for (int h = 0; h < 3; h++) {
        ewa_text_style style = {
            heights[h], {16, 16, 16, 255}, 0.13 * heights[h], {255, 255, 255, 200}, EWA_TEXT_LEFT};
        for (int row = 0; row < 3; row++, y += 1.4 * heights[h]) {
            char text[128] = "";
            for (int k = 0; k < 32 && row * 32 + k < 95; k++) text[k] = (char)(' ' + row * 32 + k);
            for (int k = 0; k < GOLDEN_SIGNS && row == 2; k++) strcat(text, signs[k]);
            ewa_draw_text(&canvas, text, 5, y, &style);
        }
    }
    assert_int_equal(painting_hash(&canvas), UINT64_C(0xc56ad6c1f73fde29));
    free(canvas.rgba8);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
