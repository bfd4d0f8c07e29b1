// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/polygon_text.c, polygon_json.c and src/cloud/polygon.c: outlines.
#include "scratch.h"

#include <math.h>

#include "io/fixture.h"

static ewa_status read_text(const char *text, ewa_polygon **polygon) {
    // From memory that ends with the text, so that a sanitizer sees a step too far.
    const size_t length = strlen(text);
    OWNED(check_free) char *copy = malloc(length + 1);
    assert_non_null(copy);
    char *exact = copy + 1;
    memcpy(exact, text, length);
    const ewa_status status = ewa_polygon_read(context, "outline", exact, length, polygon);
    return status;
}

/// Which of 11 x 11 places are inside, row by row from the lowest, as text.
static void draw(const ewa_polygon *polygon, char picture[11 * 12 + 1]) {
    void *data;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 121);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    const double origin[3] = {500000, 4200000, 0};
    ewa_cloud_set_origin(cloud, origin);
    for (int i = 0; i < 121; i++) {
        ((double *)data)[3 * i] = i % 11 - 500000;
        ((double *)data)[3 * i + 1] = i / 11 - 4200000;
        ((double *)data)[3 * i + 2] = 7;
    }
    uint8_t marks[121];
    memset(marks, 1, sizeof marks);
    assert_int_equal(ewa_polygon_mark(polygon, cloud, marks), EWA_OK);
    int used = 0;
    for (int i = 0; i < 121; i++) {
        picture[used++] = marks[i] ? '#' : '.';
        if (i % 11 == 10) picture[used++] = '\n';
    }
    picture[used] = 0;
}

static const char square_with_hole[] = "...........\n"
                                       ".########..\n"
                                       ".########..\n"
                                       ".########..\n"
                                       ".###..###..\n"
                                       ".###..###..\n"
                                       ".########..\n"
                                       ".########..\n"
                                       ".########..\n"
                                       "...........\n"
                                       "...........\n";

/// The same outline in all forms; what is on an edge, of a hole too, is inside.
TEST(test_forms) {
    static const char *const texts[] = {
        "1,1;8,1;8,8;1,8;;3,3;6,3;6,6;3,6",
        "1 1\n8 1\n8 8\n1 8\n1 1\n\n3 3\n6 3\n6 6\n3 6\n",
        "# plot\r\n> ring one\r\n1,1\r\n8,1 99\r\n8 , 8\r\n1\t8\r\n>\r\n\r\n3 3 # a corner\r\n6 3\r\n6 "
        "6\r\n3 6",
        "POLYGON((1 1,8 1,8 8,1 8,1 1),(3 3,6 3,6 6,3 6,3 3))",
        "srid=4326; polygon zm ((1 1 5 6, 8 1 5 6, 8 8 5 6, 1 8 5 6, 1 1 5 6),\n (3 3 0 0, 6 3 0 0, 6 6 0 0, "
        "3 6 0 "
        "0, 3 3 0 0))\n",
        "MULTIPOLYGON (((1 1, 8 1, 8 8, 1 8), (3 3, 6 3, 6 6, 3 6)))",
        "POLYGON ((1 1, 8 1, 8 8, 1 8))\nPOLYGON ((3 3, 6 3, 6 6, 3 6))\nPOLYGON EMPTY",
        "\xef\xbb\xbf{\"type\": \"Polygon\", \"coordinates\": [[[1,1,0],[8,1,0],[8,8],[1,8],[1,1]], "
        "[[3,3],[6,3],[6,6],[3,6],[3,3]]]}",
        "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"geometry\": null}, "
        "{\"type\": "
        "\"Feature\", \"geometry\": {\"type\": \"GeometryCollection\", \"geometries\": [{\"type\": "
        "\"Point\", "
        "\"coordinates\": [1, 2]}, {\"type\": \"MultiPolygon\", \"coordinates\": "
        "[[[[1,1],[8,1],[8,8],[1,8]], "
        "[[3,3],[6,3],[6,6],[3,6]]]]}]}}]}",
    };
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
        OWNED(ewa_polygon_destroy) ewa_polygon *polygon = NULL;
        if (read_text(texts[k], &polygon) != EWA_OK) fail_msg("%s: %s", texts[k], messages.text);
        char picture[11 * 12 + 1];
        draw(polygon, picture);
        // The hole's edges belong to it: 3 to 6 of its rows and columns are drawn.
        assert_string_equal(picture, square_with_hole);
        double box[4];
        ewa_polygon_box(polygon, box);
        assert_true(box[0] == 1 && box[1] == 1 && box[2] == 8 && box[3] == 8);
    }
}

TEST(test_bad) {
    static const char *const cases[][2] = {
        {"", "there is no polygon"},
        {"1 2\n3 4\n", "ring 1 of the outline has 2 corners"},
        {"0,0;1,0;0,0", "ring 1 of the outline has 2 corners"},
        {"1 2\n3 four\n5 6", "line 2: what is no number"},
        {"1 2\n3\n5 6", "line 2: two numbers of a corner wanted"},
        {"1 2\n3 nan\n5 6", "corner 2 is not finite"},
        {"LINESTRING (1 2, 3 4)", "POLYGON or MULTIPOLYGON of WKT wanted"},
        {"POLYGON (1 2, 3 4, 5 6)", "'(' of WKT wanted"},
        {"POLYGON ((1 2, 3 4, 5 6)", "',' or ')' of WKT wanted"},
        {"POLYGON ((1 2, 3, 5 6))", "two numbers of a corner wanted"},
        {"POLYGON ((1 2 3 4 5, 3 4, 5 6))", "more than four numbers"},
        {"POLYGON EMPTY", "there is no polygon"},
        {"SRID=4326 POLYGON EMPTY", "';' behind SRID wanted"},
        {"{\"type\": \"Polygon\"", "not JSON from here on"},
        {"{\"type\": \"Polygon\"}", "\"coordinates\" is no array"},
        {"{\"type\": \"Point\", \"coordinates\": [1, 2]}", "there is no polygon"},
        {"{\"type\": \"Polygon\", \"coordinates\": [[[1, \"2\"]]]}", "no array of two numbers"},
        {"{\"type\": \"Polygon\", \"coordinates\": [5]}", "a ring is no array"},
        {"{\"type\": \"Polygon\", \"coordinates\": [[[1, 1e999], [0, 0], [1, 0]]]}", "not finite"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        ewa_polygon *polygon = NULL;
        messages.text[0] = 0;
        if (read_text(cases[k][0], &polygon) != EWA_ERROR_FORMAT) fail_msg("%s is taken", cases[k][0]);
        assert_null(polygon);
        if (!strstr(messages.text, cases[k][1])) fail_msg("%s: %s", cases[k][0], messages.text);
        assert_non_null(strstr(messages.text, "outline"));
    }
}

/// Every begin of a text is read or refused, with a message then.
TEST(test_truncations) {
    static const char *const texts[] = {
        "1,1;8,1;8,8;1,8;;3,3;6,3;6,6;3,6",
        "SRID=4326;MULTIPOLYGON ZM (((1 1 2 3, 8 1 2 3, 8 8 2 3)), ((1 1 0 0, 2 2 0 0, 3 1 0 0)))",
        "{\"type\": \"MultiPolygon\", \"coordinates\": [[[[1,1],[8,1],[8,8],[1,8]], "
        "[[3,3],[6,3],[6,6],[3,6]]]]}",
    };
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++)
        for (size_t length = 0; length <= strlen(texts[k]); length++) {
            OWNED(check_free) char *exact = malloc(length ? length : 1);
            assert_non_null(exact);
            memcpy(exact, texts[k], length);
            OWNED(ewa_polygon_destroy) ewa_polygon *polygon = NULL;
            messages.count = 0;
            const ewa_status status = ewa_polygon_read(context, "outline", exact, length, &polygon);
            assert_true((status == EWA_OK) == (polygon != NULL) &&
                        (status == EWA_OK) == (messages.count == 0));
        }
}

/// Many corners in many bands: against the definition, edge by edge.
TEST(test_many_corners) {
    enum { CORNERS = 5000, POINTS = 3000 };
    static double corners[2 * CORNERS];
    check_random random = {5};
    for (int star = 0; star < 2; star++) {
        for (int i = 0; i < CORNERS; i++) {
            const double angle = 2 * 3.14159265358979323846 * i / CORNERS;
            const double radius = star ? check_uniform(&random, 1, 9) : 5 + sin(40 * angle);
            corners[2 * i] = 500000 + radius * cos(angle);
            corners[2 * i + 1] = 4200000 + radius * sin(angle);
        }
        OWNED(ewa_polygon_destroy) ewa_polygon *polygon = NULL;
        const uint32_t ring = CORNERS;
        assert_int_equal(ewa_polygon_create(context, corners, &ring, 1, &polygon), EWA_OK);
        void *data;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, POINTS);
        assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
        double *p = data;
        for (int i = 0; i < POINTS; i++) {
            p[3 * i] = check_uniform(&random, 499990, 500010);
            p[3 * i + 1] = check_uniform(&random, 4199990, 4200010);
            p[3 * i + 2] = 0;
        }
        uint8_t marks[POINTS];
        memset(marks, 1, sizeof marks);
        assert_int_equal(ewa_polygon_mark(polygon, cloud, marks), EWA_OK);
        int inside_count = 0;
        for (int i = 0; i < POINTS; i++) {
            bool inside = false;
            for (int a = 0, b = CORNERS - 1; a < CORNERS; b = a++) {
                const double ya = corners[2 * a + 1], yb = corners[2 * b + 1], xa = corners[2 * a],
                             xb = corners[2 * b], y = p[3 * i + 1];
                if ((ya > y) != (yb > y) && p[3 * i] < xa + (xb - xa) * (y - ya) / (yb - ya))
                    inside = !inside;
            }
            assert_int_equal(marks[i], inside);
            inside_count += inside;
        }
        assert_in_range(inside_count, 200, 2000);
    }
}

int main(void) { return RUN_TESTS(begin, end); }
