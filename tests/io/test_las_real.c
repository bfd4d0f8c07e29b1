// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LAS and LAZ files of the data set, which others' programs have written: counts, bounds and attributes as
// its README has them, and every LAZ equal to its LAS. Only where the data set is there.
#include "io/las_sample.h"
#include "io/scratch.h"

#define FIXTURE_THREADS 0
#include "io/fixture.h"

static ewa_cloud *load(const char *relative) {
    char path[512];
    if (!check_data(relative, path, sizeof path)) return NULL;
    ewa_cloud *cloud = NULL;
    if (ewa_cloud_load(context, path, &cloud) != EWA_OK) fail_msg("%s", messages.text);
    return cloud;
}

/// A file of the data set. `attributes` beside those of its point format, comma-separated.
static const struct {
    const char *path;
    uint64_t count;
    double low[3], high[3], tolerance;
    const char *format, *said;
    int color; ///< bits of a colour; 0: none
} files[] = {
#define ONE_POINT         {470692.44, 4602888.9, 16}, {470692.44, 4602888.9, 16}, 0.006
#define AUTZEN            {635619.85, 848899.7, 406.59}, {638982.55, 853535.43, 586.38}, 0.006
#define AUTZEN_UTM        {493994.87, 4877429.6, 123.93}, {494993.68, 4878817, 178.73}, 0.05
#define NEW_MEXICO        {1694038.4, 1816492.7, 5592.7499}, {1694539.7, 1816498, 5599.0697}, 0.06
#define SIMPLE1_3         {-235434.519, 5800843.14, 265.094}, {-234935.841, 5800946.25, 273.811}, 0.006
#define VEGETATION_1_3    {-98451.205, -55975.417, -81460.091}, {-98447.447, -55969.405, -81455.203}, 1e-6
#define AUTZEN_TRIM       {636001.76, 848935.2, 406.26}, {637179.22, 849497.9, 520.51}, 0.006
#define AUTZEN_LOD01_350K {635578.31, 848884.55, 406.4}, {639003.73, 853535.09, 615.26}, 0.006
#define PLANE             {1423214.5, 4189096.6, 67.860001}, {1423216.8, 4189098.6, 67.900002}, 0.06
#define FULLWAVE          {194267.42, 8249096, 989.944}, {194318.3, 8249137.3, 1003.704}, 0.06
#define LION_TAKANAWA     {-4.985, 1.039, -3.445}, {-0.789, 6.724, 1.124}, 0.006
    {"las/v1.0_pf0.las", 1, ONE_POINT, "LAS 1.0, point format 0, 20", "", 0},
    {"las/v1.0_pf1.las", 1, ONE_POINT, "LAS 1.0, point format 1, 28", "", 0},
    {"las/v1.1_pf0.las", 1, ONE_POINT, "LAS 1.1, point format 0, 20", "", 0},
    {"las/v1.1_pf1.las", 1, ONE_POINT, "LAS 1.1, point format 1, 28", "", 0},
    {"las/v1.2_pf0.las", 1, ONE_POINT, "LAS 1.2, point format 0, 20", "", 0},
    {"las/v1.2_pf1.las", 1, ONE_POINT, "LAS 1.2, point format 1, 28", "", 0},
    {"las/v1.2_pf2.las", 1, ONE_POINT, "LAS 1.2, point format 2, 26", "", 8},
    {"las/v1.2_pf3.las", 1, ONE_POINT, "LAS 1.2, point format 3, 34", "", 8},
    {"las/v1.2_no_points.las", 0, {0}, {0}, 0, "LAS 1.2, point format 3, 34", "counts 1065 points", 8},
    {"las/simple1_1.las", 1065, AUTZEN, "LAS 1.1, point format 1, 28", "", 0},
    {"las/simple1_3.las", 999, SIMPLE1_3, "LAS 1.3, point format 4, 57",
     "z of the points is from 265.094 to 273.811; the header says from 265094 to 273811", 0},
    {"las/simple1_4.las", 22600, {1, 1, 44}, {226, 100, 254}, 1e-9, "LAS 1.4, point format 7, 36", "", 16},
    {"las/simple.las", 1065, AUTZEN, "LAS 1.2, point format 3, 34", "", 8},
    {"las/vegetation_1_3.las", 10683, VEGETATION_1_3, "LAS 1.3, point format 1, 28", "", 0},
    {"las/test1_4.las", 1000, NEW_MEXICO, "LAS 1.4, point format 6, 30", "", 0},
    {"las/1_4_w_evlr.las", 1000, NEW_MEXICO, "LAS 1.4, point format 6, 30", "", 0},
    {"las/extrabytes.las", 1065, AUTZEN, "LAS 1.4, point format 3, 61", "", 8},
    {"las/unregistered_extra_bytes.las", 4, {1, 1, 1}, {4, 4, 4}, 1e-9, "LAS 1.4, point format 6, 34", "", 0},
    {"las/autzen_trim.las", 110000, AUTZEN_TRIM, "LAS 1.2, point format 3, 34", "", 8},
    {"las/1.2-with-color.las", 1065, AUTZEN, "LAS 1.2, point format 3, 34", "", 8},
    {"las/autzen_lod01_350k.las", 350000, AUTZEN_LOD01_350K, "LAS 1.2, point format 2, 26", "", 8},
    {"laz/simple.laz", 1065, AUTZEN, "LAS 1.2, point format 3, 34", "", 8},
    {"laz/plane.laz", 28185, PLANE, "LAS 1.2, point format 3, 34", "", 0},
    {"laz/extra.laz", 1065, AUTZEN, "LAS 1.4, point format 3, 61", "", 8},
    {"laz/fullwave.laz", 10750, FULLWAVE, "LAS 1.4, point format 10, 67", "", -1},
    {"laz/1_4_w_evlr.laz", 1000, NEW_MEXICO, "LAS 1.4, point format 6, 30", "", 0},
    {"laz/autzen_trim.laz", 110000, AUTZEN_TRIM, "LAS 1.2, point format 3, 34", "", 8},
    {"laz/simple.copc.laz", 1065, AUTZEN, "LAS 1.4, point format 7, 36", "", -1},
    {"laz/simple_with_page.copc.laz", 1065, AUTZEN, "LAS 1.4, point format 7, 36", "", -1},
    {"laz/point10.laz", 1065, AUTZEN_UTM, "LAS 1.2, point format 0, 20", "", 0},
    {"laz/point-time.laz", 1065, AUTZEN_UTM, "LAS 1.2, point format 1, 28", "", 0},
    {"laz/point-color.laz", 1065, AUTZEN_UTM, "LAS 1.2, point format 2, 26", "", 8},
    {"laz/point-time-color.laz", 1065, AUTZEN_UTM, "LAS 1.2, point format 3, 34", "", 8},
    {"laz/lion_takanawa.copc.laz", 341989, LION_TAKANAWA, "LAS 1.4, point format 7, 40", "", -1},
};

CASE(test_counts_bounds_and_formats) {
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        char relative[256];
        snprintf(relative, sizeof relative, "clouds/%s", files[k].path);
        messages = (check_log){0};
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(relative);
        if (!cloud) skip();
        if (files[k].said[0] ? !strstr(messages.text, files[k].said) : messages.count)
            fail_msg("%s: %s", relative, messages.text);
        assert_int_equal(ewa_cloud_point_count(cloud), files[k].count);
        ewa_bounds bounds;
        assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
        for (int c = 0; c < 3 && files[k].count; c++)
            if (fabs(bounds.low_world[c] - files[k].low[c]) > files[k].tolerance ||
                fabs(bounds.high_world[c] - files[k].high[c]) > files[k].tolerance)
                fail_msg("%s: %c from %.10g to %.10g", relative, "xyz"[c], bounds.low_world[c],
                         bounds.high_world[c]);
        const char *format = ewa_cloud_note(cloud, "file.format", NULL);
        if (strncmp(format, files[k].format, strlen(files[k].format)) != 0)
            fail_msg("%s: %s", relative, format);
        const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
        const int bits = color ? 8 * (int)ewa_type_bytes(color->type) : 0;
        if (files[k].color >= 0 && bits != files[k].color) fail_msg("%s: colours of %d bits", relative, bits);
        assert_non_null(ewa_cloud_find(cloud, "classification"));
    }
}

CASE(test_twins) {
    static const char *const twins[][2] = {{"laz/point10.las", "laz/point10.laz"},
                                           {"laz/point-time.las", "laz/point-time.laz"},
                                           {"laz/point-color.las", "laz/point-color.laz"},
                                           {"laz/point-time-color.las", "laz/point-time-color.laz"},
                                           {"las/simple.las", "laz/simple.laz"},
                                           {"las/extrabytes.las", "laz/extra.laz"},
                                           {"las/autzen_trim.las", "laz/autzen_trim.laz"},
                                           {"las/1_4_w_evlr.las", "laz/1_4_w_evlr.laz"},
                                           {"laz/simple.copc.laz", "laz/simple_with_page.copc.laz"}};
    for (size_t k = 0; k < sizeof twins / sizeof *twins; k++) {
        ewa_cloud *clouds[2];
        for (int i = 0; i < 2; i++) {
            char relative[256];
            snprintf(relative, sizeof relative, "clouds/%s", twins[k][i]);
            clouds[i] = load(relative);
            if (!clouds[i]) skip();
        }
        las_compare(clouds[0], clouds[1]);
        las_compare(clouds[1], clouds[0]);
        ewa_cloud_destroy(&clouds[0]);
        ewa_cloud_destroy(&clouds[1]);
    }
    assert_int_equal(messages.count, 0);
}

/// What a visit of a folder is told.
typedef struct visit {
    int refused;
} visit;

static void round_trip(void *user, const char *path) {
    (void)user;
    ewa_cloud *cloud = NULL, *back = NULL;
    if (ewa_cloud_load(context, path, &cloud) != EWA_OK) fail_msg("%s", messages.text);
    for (int compressed = 0; compressed < 2; compressed++) {
        char copy[512];
        scratch_path(compressed ? "real.laz" : "real.las", copy);
        if (ewa_cloud_save(cloud, copy, NULL) != EWA_OK) fail_msg("%s: %s", path, messages.text);
        assert_int_equal(ewa_cloud_load(context, copy, &back), EWA_OK);
        las_compare(cloud, back);
        static const char *const notes[] = {"crs", "crs_name", "las.vlrs", "file.system"};
        for (size_t k = 0; k < sizeof notes / sizeof *notes; k++) {
            const char *a = ewa_cloud_note(cloud, notes[k], NULL), *b = ewa_cloud_note(back, notes[k], NULL);
            if (a && (!b || strcmp(a, b) != 0)) fail_msg("%s: %s '%s' becomes '%s'", path, notes[k], a, b);
        }
        ewa_cloud_destroy(&back);
        remove(copy);
    }
    ewa_cloud_destroy(&cloud);
}

CASE(test_round_trips) {
    if (scratch_each("clouds/las", round_trip, NULL) == 0) skip();
    scratch_each("clouds/laz", round_trip, NULL);
}

static void refuse_or_read(void *user, const char *path) {
    visit *v = user;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    messages = (check_log){0};
    if (ewa_cloud_load(context, path, &cloud) != EWA_OK) {
        assert_true(strncmp(messages.text, path, strlen(path)) == 0);
        v->refused++;
    }
}

CASE(test_hostile) {
    visit v = {0};
    if (scratch_each("hostile/las", refuse_or_read, &v) == 0) skip();
    assert_int_equal(v.refused, 1); // the other two are merely odd
}

int main(void) { return RUN_TESTS(NULL, NULL); }
