// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/cloud/filter.c, scalar.c, marks.c and src/io/filter_text.c: points by their numbers.
#include "check.h"

#include <math.h>

#include "io/fixture.h"

enum { POINTS = 3000 };

static const double origin_world[3] = {500000, 4200000, 10};

/// Point i: position (i, 2 i, i / 4) from the origin, class i % 20, intensity 10 i, colour (i, 3 i, 5 i),
/// tenths i / 10 as F32, of which every hundredth is NaN.
static ewa_cloud *make_cloud(void) {
    void *position, *class, *intensity, *color, *tenths;
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &class), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "scalar_Intensity", EWA_U16, 1, &intensity), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &color), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "tenths", EWA_F32, 1, &tenths), EWA_OK);
    ewa_cloud_set_origin(cloud, origin_world);
    for (int i = 0; i < POINTS; i++) {
        for (int c = 0; c < 3; c++) {
            ((double *)position)[3 * i + c] = i * (c == 0 ? 1 : c == 1 ? 2 : 0.25);
            ((uint8_t *)color)[3 * i + c] = (uint8_t)(i * (2 * c + 1));
        }
        ((uint8_t *)class)[i] = (uint8_t)(i % 20);
        ((uint16_t *)intensity)[i] = (uint16_t)(10 * i);
        ((float *)tenths)[i] = i % 100 == 99 ? NAN : (float)i / 10;
    }
    return cloud;
}

/// What a filter of one or two texts says of a point, worked out by the test itself.
typedef bool expected(int i);

static bool is_2_or_6(int i) { return i % 20 == 2 || i % 20 == 6; }
static bool is_not_2(int i) { return i % 20 != 2; }
static bool is_plant(int i) { return i % 20 >= 3 && i % 20 <= 5; }
static bool is_noise(int i) { return i % 20 == 7 || i % 20 == 18; }
static bool is_bright(int i) { return 10 * i > 10000; }
static bool is_bright_or_equal(int i) { return 10 * i >= 10000; }
static bool is_ground_and_dark(int i) { return i % 20 == 2 && 10 * i <= 1220; }
static bool is_in_ranges(int i) { return i % 20 <= 1 || i % 20 == 7 || i % 20 >= 18; }
static bool is_east(int i) { return 500000 + i >= 500100 && 500000 + i < 500200; }
static bool is_blue(int i) { return (uint8_t)(5 * i) > 200 && (uint8_t)i < 50; }
static bool is_a_tenth(int i) { return i == 1 || i == 123; }
static bool is_over_a_tenth(int i) { return i > 1 && i % 100 != 99; }
static bool is_no_tenth(int i) { return i != 1 && i % 100 != 99; }
static bool is_high(int i) { return 10 + 0.25 * i > 400; }

TEST(test_expressions) {
    static const struct {
        const char *texts[2];
        expected *fulfils;
    } cases[] = {
        {{"classification=2,6"}, is_2_or_6},
        {{" classification == 2 , 6 "}, is_2_or_6},
        {{"Classification=ground,BUILDING"}, is_2_or_6},
        {{"classification!=ground"}, is_not_2},
        {{"classification=low_vegetation,Medium-Vegetation,high vegetation"}, is_plant},
        {{"classification=vegetation"}, is_plant},
        {{"classification=noise"}, is_noise},
        {{"intensity>10000"}, is_bright},
        {{"scalar_Intensity > 1e4"}, is_bright},
        {{"intensity>=10000"}, is_bright_or_equal},
        {{"intensity=10000.."}, is_bright_or_equal},
        {{"classification=2 and intensity<=1220"}, is_ground_and_dark},
        {{"classification=2", "intensity<=1220"}, is_ground_and_dark},
        {{"classification=2 AND intensity<1221"}, is_ground_and_dark},
        {{"classification=..1,7,18.."}, is_in_ranges},
        {{"classification=0 .. 1 , 7 , 18..25"}, is_in_ranges},
        {{"x>=500100 and x<500200"}, is_east},
        {{"position.x=500100..500199.5"}, is_east},
        {{"blue>200 and red<50"}, is_blue},
        {{"color.b>200 and color.r<50"}, is_blue},
        {{"tenths=0.1,12.3"}, is_a_tenth},
        {{"tenths>0.1"}, is_over_a_tenth},
        {{"tenths!=0.1"}, is_no_tenth},
        {{"z>400"}, is_high},
    };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud();
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        ewa_filter filter = {.term_count = 0};
        char problem[EWA_OPTION_TEXT_BYTES] = "";
        for (int t = 0; t < 2 && cases[k].texts[t]; t++)
            if (ewa_filter_add(&filter, cases[k].texts[t], problem) != EWA_OK)
                fail_msg("%s: %s", cases[k].texts[t], problem);
        uint8_t marks[POINTS];
        memset(marks, 7, sizeof marks);
        marks[2] = marks[102] = 0; // what is not marked stays so
        assert_int_equal(ewa_filter_mark(&filter, cloud, marks), EWA_OK);
        for (int i = 0; i < POINTS; i++)
            if ((marks[i] != 0) != (cases[k].fulfils(i) && i != 2 && i != 102))
                fail_msg("%s: point %d is%s marked", cases[k].texts[0], i, marks[i] ? "" : " not");
    }
}

TEST(test_bad_texts) {
    static const char *const cases[][2] = {
        {"", "name of an attribute is missing"},
        {"classification", "a comparison (= != < <= > >=) is missing"},
        {"classification!2", "a comparison (= != < <= > >=) is missing"},
        {"=2", "name of an attribute is missing"},
        {"classification=", "a number behind 'classification' is missing"},
        {"classification=2,", "a number behind 'classification' is missing"},
        {"classification=grund", "'grund' is neither a number nor a class (ground, building"},
        {"intensity>>3", "'>3' is not a number"},
        {"intensity>ground", "'ground' is not a number"},
        {"intensity>nan", "'nan' is not a number"},
        {"intensity=3..1", "'3..1' is not a range LOW..HIGH"},
        {"intensity=..", "'..' is not a range LOW..HIGH"},
        {"intensity=1...2..3", "is not a range LOW..HIGH"},
        {"intensity>1 and", "'1 and' is not a number"},
        {"intensity>1 and and x>2", "name of an attribute is missing"},
        {"a=1 and b=1 and c=1 and d=1 and e=1 and f=1 and g=1 and h=1 and i=1 and j=1 and k=1 and l=1 and "
         "m=1 "
         "and n=1 and o=1 and p=1 and q=1",
         "more than 16 conditions"},
        {"a=1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31,32,33",
         "'a' has more than 32 numbers"},
        {"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa=1", "too long"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        ewa_filter filter = {.term_count = 0};
        char problem[EWA_OPTION_TEXT_BYTES] = "";
        assert_int_equal(ewa_filter_add(&filter, "x>1", problem), EWA_OK);
        if (ewa_filter_add(&filter, cases[k][0], problem) != EWA_ERROR_ARGUMENT)
            fail_msg("'%s' is taken", cases[k][0]);
        if (!strstr(problem, cases[k][1])) fail_msg("'%s': said '%s'", cases[k][0], problem);
        assert_int_equal(filter.term_count, 1);
        assert_int_equal(ewa_filter_add(&filter, cases[k][0], NULL), EWA_ERROR_ARGUMENT);
    }
}

TEST(test_unknown_attribute) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud();
    static const char *const words[] = {"height>1", "normal.x>1", "nx>1", "color.w>1", "alpha>1", ".x>1"};
    uint8_t marks[POINTS] = {0};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        ewa_filter filter = {.term_count = 0};
        assert_int_equal(ewa_filter_add(&filter, words[k], NULL), EWA_OK);
        assert_int_equal(ewa_filter_mark(&filter, cloud, marks), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(messages.text, "there are position (x y z), classification, scalar_Intensity, "
                                              "color (red green blue), tenths"));
    }
    assert_non_null(strstr(messages.text, "there is no attribute '.x'"));
    // A list that is too long ends in dots.
    for (int k = 0; k < 40; k++) {
        char name[EWA_NAME_BYTES];
        snprintf(name, sizeof name, "a_very_long_name_that_takes_much_room_in_a_message_%d", k);
        assert_int_equal(ewa_cloud_add(cloud, name, EWA_U8, 1, NULL), EWA_OK);
    }
    ewa_scalar scalar;
    assert_int_equal(ewa_cloud_find_scalar(cloud, "nothing", &scalar), EWA_ERROR_ARGUMENT);
    assert_string_equal(messages.text + strlen(messages.text) - 5, ", ...");
}

/// A name that is the same wins over one that is alike, an attribute over a word for a component.
TEST(test_names) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud();
    ewa_scalar scalar;
    assert_int_equal(ewa_cloud_add(cloud, "ReturnNumber", EWA_U8, 1, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_find_scalar(cloud, "return_number", &scalar), EWA_OK);
    assert_string_equal(scalar.attribute.name, "ReturnNumber");
    assert_int_equal(ewa_cloud_add(cloud, "return_number", EWA_U8, 1, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_find_scalar(cloud, "return_number", &scalar), EWA_OK);
    assert_string_equal(scalar.attribute.name, "return_number");
    assert_int_equal(ewa_cloud_find_scalar(cloud, "X", &scalar), EWA_OK);
    assert_string_equal(scalar.attribute.name, EWA_POSITION);
    assert_int_equal(ewa_cloud_add(cloud, "z", EWA_U8, 1, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_find_scalar(cloud, "z", &scalar), EWA_OK);
    assert_string_equal(scalar.attribute.name, "z");
    // A box is about positions whatever else is called x.
    uint8_t marks[POINTS];
    memset(marks, 1, sizeof marks);
    const double corners[2][3] = {{500010, 0, 0}, {500012, 5e6, 12.75}};
    assert_int_equal(ewa_box_mark(corners, cloud, marks), EWA_OK);
    for (int i = 0; i < POINTS; i++) assert_int_equal(marks[i], i == 10 || i == 11);
    const double swapped[2][3] = {{500012, 5e6, 12.75}, {500010, 0, 0}};
    memset(marks, 1, sizeof marks);
    assert_int_equal(ewa_box_mark(swapped, cloud, marks), EWA_OK);
    for (int i = 0; i < POINTS; i++) assert_int_equal(marks[i], i == 10 || i == 11);
    // A sphere has the points at its radius: 7 and 9 are (1, 2, 1/4) from 8, a length of 2.25.
    memset(marks, 1, sizeof marks);
    const double middle[3] = {500008, 4200016, 12};
    assert_int_equal(ewa_sphere_mark(middle, 2.25, cloud, marks), EWA_OK);
    for (int i = 0; i < POINTS; i++) assert_int_equal(marks[i], i >= 7 && i <= 9);
    assert_int_equal(ewa_sphere_mark(middle, NAN, cloud, marks), EWA_ERROR_ARGUMENT);
}

/// Coordinates of a grid are the decimals of the file, whatever the binary fractions make of them.
TEST(test_grid) {
    void *data;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1000);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    const double origin[3] = {637000.37, 849000.01, 400.11};
    ewa_cloud_set_origin(cloud, origin);
    ewa_cloud_set_grid(cloud, &(ewa_coordinate_grid){{0.01, 0.01, 0.01}, {0, 0, 0}});
    for (int i = 0; i < 3000; i++) ((double *)data)[i] = i / 3 * 0.01;
    int missed = 0;
    for (int i = 0; i < 1000; i++) {
        char text[64];
        snprintf(text, sizeof text, "x=%.2f", 637000.37 + i * 0.01);
        ewa_filter filter = {.term_count = 0};
        assert_int_equal(ewa_filter_add(&filter, text, NULL), EWA_OK);
        uint8_t marks[1000];
        memset(marks, 1, sizeof marks);
        assert_int_equal(ewa_filter_mark(&filter, cloud, marks), EWA_OK);
        for (int k = 0; k < 1000; k++) missed += marks[k] != (k == i);
    }
    assert_int_equal(missed, 0);
}

/// The pieces of a cloud, of any size, give what the whole does, and so does any number of threads.
TEST(test_pieces_and_keep) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud();
    ewa_filter filter = {.term_count = 0};
    assert_int_equal(ewa_filter_add(&filter, "classification=2,6 and red<100", NULL), EWA_OK);
    uint8_t whole[POINTS], pieces[POINTS];
    memset(whole, 1, sizeof whole);
    assert_int_equal(ewa_filter_mark(&filter, cloud, whole), EWA_OK);
    static const uint64_t sizes[] = {1, 7, 512, 513, 1024};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        memset(pieces, 1, sizeof pieces);
        for (uint64_t first = 0; first < POINTS; first += sizes[k]) {
            uint64_t indices[1024], count = 0;
            while (count < sizes[k] && first + count < POINTS) indices[count] = first + count, count++;
            OWNED(ewa_cloud_destroy) ewa_cloud *piece = NULL;
            assert_int_equal(ewa_cloud_select(cloud, indices, count, &piece), EWA_OK);
            assert_int_equal(ewa_filter_mark(&filter, piece, pieces + first), EWA_OK);
        }
        assert_memory_equal(whole, pieces, sizeof whole);
    }
    OWNED(ewa_cloud_destroy) ewa_cloud *kept = NULL;
    assert_int_equal(ewa_cloud_keep(cloud, whole, &kept), EWA_OK);
    const ewa_attribute *tenths = ewa_cloud_find(kept, "tenths");
    uint64_t count = 0;
    for (int i = 0; i < POINTS; i++) {
        if (!whole[i]) continue;
        float number;
        ewa_attribute_read_f32(tenths, count++, 1, &number);
        assert_true(i % 100 == 99 ? isnan(number) : number == (float)i / 10);
    }
    assert_true(count > 0 && count == ewa_cloud_point_count(kept));
    double origin[3];
    ewa_cloud_origin(kept, origin);
    assert_memory_equal(origin, origin_world, sizeof origin);
    ewa_cloud_destroy(&kept);
    memset(whole, 0, sizeof whole);
    assert_int_equal(ewa_cloud_keep(cloud, whole, &kept), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(kept), 0);
}

static int compare_numbers(const void *a, const void *b) {
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

/// A number by its rank is that of the sorted ones, of any sign and size, equal ones among them.
TEST(test_ranks) {
    enum { MAXIMUM = 300 };
    check_random random = {12};
    for (size_t count = 1; count <= MAXIMUM; count += count < 10 ? 1 : 29) {
        double numbers[MAXIMUM], sorted[MAXIMUM], shuffled[MAXIMUM];
        for (size_t i = 0; i < count; i++) {
            const double size = pow(10, check_uniform(&random, -300, 300));
            numbers[i] =
                i % 5 == 0 ? floor(check_uniform(&random, -3, 3)) : check_uniform(&random, -1, 1) * size;
            if (i % 31 == 7) numbers[i] = i % 2 ? INFINITY : -INFINITY;
        }
        memcpy(sorted, numbers, count * sizeof *sorted);
        qsort(sorted, count, sizeof *sorted, compare_numbers);
        for (size_t rank = 0; rank < count; rank++) {
            memcpy(shuffled, numbers, count * sizeof *shuffled);
            assert_true(ewa_rank_select(shuffled, count, rank) == sorted[rank]);
        }
    }
}

int main(void) { return RUN_TESTS(begin, end); }
