// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tables of options: every table fits its struct; ranges, text, and structs of older and newer headers.
#include "check.h"

#include <locale.h>
#include <math.h>
#include <string.h>

#include "base/options.h"
#include "ewa/ewa.h"

static const ewa_option_table *const tables[] = {
    &ewa_acquire_options_table,         &ewa_cloud_save_options_table,
    &ewa_context_options_table,         &ewa_limits_table,
    &ewa_csg_options_table,
    &ewa_estimate_options_table,        &ewa_feature_options_table,
    &ewa_furniture_options_table,       &ewa_generate_options_table,
    &ewa_image_save_options_table,      &ewa_material_table,
    &ewa_mesh_sample_options_table,     &ewa_procedure_options_table,
    &ewa_photos_options_table,          &ewa_panorama_options_table,
    &ewa_profile_options_table,         &ewa_profile_graph_options_table,
    &ewa_refit_options_table,           &ewa_render_options_table,
    &ewa_surfels_options_table,         &ewa_texture_options_table,
    &ewa_volume_generate_options_table, &ewa_volume_load_options_table,
    &ewa_gaussian_options_table,        &ewa_volume_options_table,
    &ewa_volume_save_options_table,     &ewa_gaussians_save_options_table,
    &ewa_voxels_options_table,          &ewa_warp_options_table,
};

/// Defaults are allowed, survive as text, and every member is named once, said in a sentence and in its
/// struct.
TEST_LOGGED(test_tables, 1) {
    static double made[512], again[512];
    for (size_t t = 0; t < sizeof tables / sizeof tables[0]; t++) {
        const ewa_option_table *table = tables[t];
        assert_true(table->struct_size <= sizeof made && table->option_count > 0);
        ewa_options_init(table, made, table->struct_size);
        memset(again, 0, sizeof again);
        for (size_t i = 0; i < table->option_count; i++) {
            const ewa_option *option = &table->options[i];
            char text[EWA_OPTION_TEXT_BYTES], range[EWA_OPTION_TEXT_BYTES],
                problem[EWA_OPTION_TEXT_BYTES] = "";
            assert_ptr_equal(ewa_option_find(table, option->name), option);
            assert_true(option->offset < table->struct_size && option->help && option->help[0]);
            assert_true(option->type != EWA_OPTION_CHOICE || option->words);
            ewa_option_get(option, made, text);
            ewa_option_range(option, range);
            if (ewa_option_set(option, again, text, problem) != EWA_OK)
                fail_msg("%s.%s: '%s' of %s: %s", table->name, option->name, text, range, problem);
            for (uint32_t k = 0; k < (option->count ? option->count : 1); k++)
                assert_true(ewa_option_number(option, made, k) == ewa_option_number(option, again, k));
        }
        assert_int_equal(ewa_options_check(context, table, "here", made), EWA_OK);
    }
    assert_null(ewa_option_find(&ewa_render_options_table, "cutof"));
}

typedef struct sample_options {
    size_t struct_size;
    double above, either, any[2];
    uint64_t count;
    uint32_t passes;
    int color;
    bool flag;
} sample_options;

#define AT(member) offsetof(sample_options, member)

enum { ABOVE, EITHER, ANY, COUNT, PASSES, COLOR, FLAG };

static const ewa_option sample_rows[] = {
    {"above", EWA_OPTION_F64, AT(above), 0, 4, EWA_OPTION_ABOVE, .initial = 3, .help = "h"},
    {"either", EWA_OPTION_F64, AT(either), 1, 256, EWA_OPTION_OR_ZERO, .help = "h"},
    {"any", EWA_OPTION_F64, AT(any), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 2,
     .initials = (const double[]){1, -2}, .help = "h"},
    {"count", EWA_OPTION_U64, AT(count), 1, INFINITY, EWA_OPTION_BELOW, .initial = 5, .help = "h"},
    {"passes", EWA_OPTION_U32, AT(passes), .words = "1|3", .initial = 3, .help = "h"},
    {"color", EWA_OPTION_CHOICE, AT(color), .words = "red|green|blue", .initial = 2, .help = "h"},
    {"flag", EWA_OPTION_BOOL, AT(flag), .initial = true, .help = "h"},
};

static const ewa_option_table sample_table = EWA_OPTION_TABLE(sample_options, sample_rows);

TEST(test_ranges) {
    static const struct {
        int row;
        const char *range;
        double good[3], bad[4];
    } rows[] = {
        {ABOVE, "(0, 4]", {1e-9, 4, 2}, {0, 4.001, -1, NAN}},
        {EITHER, "0 or [1, 256]", {0, 1, 256}, {0.5, -1, 257, NAN}},
        {ANY, "(-inf, inf)", {0, -1e300, 1e300}, {INFINITY, -INFINITY, NAN, NAN}},
        {COUNT, "[1, inf)", {1, 2, 1e18}, {0, -1, INFINITY, NAN}},
        {PASSES, "1|3", {1, 3, 1}, {0, 2, 4, NAN}},
        {COLOR, "red|green|blue", {0, 1, 2}, {-1, 3, 1e9, NAN}},
        {FLAG, "on|off", {0, 1, 1}, {2, -1, 0.5, NAN}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const ewa_option *option = &sample_rows[rows[i].row];
        char text[EWA_OPTION_TEXT_BYTES];
        ewa_option_range(option, text);
        assert_string_equal(text, rows[i].range);
        for (int k = 0; k < 3; k++) assert_true(ewa_option_allows(option, rows[i].good[k]));
        for (int k = 0; k < 4; k++) assert_false(ewa_option_allows(option, rows[i].bad[k]));
    }
}

TEST(test_text) {
    static const struct {
        int row;
        const char *text, *said; ///< said NULL: accepted, and written as it was read
    } rows[] = {
        {ABOVE, "0.25", NULL},
        {ABOVE, "0", "0 is outside (0, 4]"},
        {ABOVE, "abc", "'abc' is not a number"},
        {ABOVE, "1x", "'1x' is not a number"},
        {ABOVE, "", "'' is not a number"},
        {ABOVE, "1,2", "'1,2' is not a number"},
        {ABOVE, "nan", "'nan' is not a number"},
        {ABOVE, " 1", "' 1' is not a number"},
        {EITHER, "0", NULL},
        {EITHER, "0.5", "0.5 is outside 0 or [1, 256]"},
        {ANY, "1.5,-2e300", NULL},
        {ANY, "1", "'1' is not 2 numbers separated by commas"},
        {ANY, "1,2,3", "'1,2,3' is not 2 numbers separated by commas"},
        {ANY, "1,", "'' is not a number"},
        {ANY, "inf,1", "'inf,1' is not a number"},
        {COUNT, "9007199254740993", NULL},
        {COUNT, "0", "0 is outside [1, inf)"},
        {COUNT, "-1", "-1 is outside [1, inf)"},
        {COUNT, "2.5", "'2.5' is not a whole number"},
        {COUNT, "99999999999999999999", "'99999999999999999999' is not a whole number"},
        {COUNT, "-1e3", "-1000 is outside [1, inf)"},
        {COUNT, "25e-1", "'25e-1' is not a whole number"},
        {COUNT, "3.0", "'3.0' is not a whole number"},
        {COUNT, "1e", "'1e' is not a whole number"},
        {COUNT, "1e16", "'1e16' is not a whole number"},
        {COUNT, "nan", "'nan' is not a whole number"},
        {COUNT, "inf", "'inf' is not a whole number"},
        {PASSES, "1", NULL},
        {PASSES, "2", "'2' is not one of 1|3"},
        {COLOR, "green", NULL},
        {COLOR, "gree", "'gree' is not one of red|green|blue"},
        {COLOR, "red,green", "'red,green' is not"},
        {COLOR, "1", "'1' is not one of red|green|blue"},
        {FLAG, "off", NULL},
        {FLAG, "yes", "'yes' is not one of off|on"},
    };
    static const char *const locales[] = {"C", "de_DE.UTF-8"};
    for (size_t i = 0; i < 2 * sizeof rows / sizeof rows[0]; i++) {
        setlocale(LC_NUMERIC, locales[i % 2]);
        const ewa_option *option = &sample_rows[rows[i / 2].row];
        const char *said = rows[i / 2].said;
        sample_options options, before;
        char text[EWA_OPTION_TEXT_BYTES] = "";
        ewa_options_init(&sample_table, &options, sizeof options);
        before = options;
        const ewa_status status = ewa_option_set(option, &options, rows[i / 2].text, text);
        if (status != (said ? EWA_ERROR_ARGUMENT : EWA_OK) ||
            (said && strncmp(text, said, strlen(said)) != 0))
            fail_msg("%s '%s': %d, '%s'", option->name, rows[i / 2].text, (int)status, text);
        if (said) assert_memory_equal(&options, &before, sizeof options);
        if (!said) ewa_option_get(option, &options, text);
        if (!said) assert_string_equal(text, rows[i / 2].text);
    }
    setlocale(LC_NUMERIC, "C");
    // Whole numbers may have an exponent.
    static const struct {
        const char *text, *kept;
    } powers[] = {{"1e9", "1000000000"}, {"2.5e3", "2500"}, {"90071992547409920E-1", "9007199254740992"}, {"5e0", "5"}};
    for (size_t i = 0; i < sizeof powers / sizeof powers[0]; i++) {
        sample_options options;
        char text[EWA_OPTION_TEXT_BYTES] = "";
        ewa_options_init(&sample_table, &options, sizeof options);
        assert_int_equal(ewa_option_set(&sample_rows[COUNT], &options, powers[i].text, text), EWA_OK);
        ewa_option_get(&sample_rows[COUNT], &options, text);
        assert_string_equal(text, powers[i].kept);
    }
    sample_options options = {.struct_size = sizeof options};
    assert_int_equal(ewa_option_set(&sample_rows[ABOVE], &options, "9", NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_option_set(NULL, &options, "9", NULL), EWA_ERROR_ARGUMENT);
}

/// The struct as a header of the next version might have it.
typedef struct later_options {
    sample_options old;
    double added;
    double more[2];
} later_options;

/// What an older header does not have gets its default; what a newer one has may be zero only.
TEST_LOGGED(test_sizes, 1) {
    sample_options given, chosen;
    for (size_t size = 0; size <= sizeof given; size++) {
        memset(&given, 0xee, sizeof given);
        ewa_options_init(&sample_table, &given, size);
        if (size < sizeof given) assert_int_equal(((unsigned char *)&given)[size], 0xee);
        if (size < sizeof given.struct_size) continue;
        if (size >= AT(either)) given.above = 1.5;
        ewa_options_init(&sample_table, &chosen, sizeof chosen);
        const ewa_status status = ewa_options_take(context, &sample_table, &given, &chosen);
        // Members end at multiples of 8, but for two that share one.
        const bool whole = size % 8 == 0 && size > 8 && size != AT(any) + 8;
        assert_int_equal(status, whole ? EWA_OK : EWA_ERROR_ARGUMENT);
        if (!whole) assert_non_null(strstr(log->text, "sample_options: struct_size is"));
        if (!whole) continue;
        assert_true(chosen.struct_size == sizeof chosen && chosen.above == 1.5 && chosen.any[1] == -2);
        assert_true(chosen.count == 5 && chosen.passes == 3 && chosen.color == 2 && chosen.flag);
    }
    later_options later = {.added = 0};
    ewa_options_init(&sample_table, &later, sizeof later);
    later.old.above = 2;
    assert_int_equal(ewa_options_take(context, &sample_table, &later, &chosen), EWA_OK);
    assert_true(chosen.above == 2 && chosen.struct_size == sizeof chosen);
    later.more[1] = 1;
    assert_int_equal(ewa_options_take(context, &sample_table, &later, &chosen), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, "sample_options: a member at byte"));
    later.old.struct_size = (size_t)1 << 40; // never set: nothing is read
    assert_int_equal(ewa_options_take(context, &sample_table, &later, &chosen), EWA_ERROR_ARGUMENT);
    given = chosen;
    given.either = 0.5;
    assert_int_equal(ewa_options_take(context, &sample_table, &given, &chosen), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "sample_options: either is 0.5, allowed is 0 or [1, 256]"));
    ewa_options_init(&sample_table, &given, sizeof given);
    given.any[1] = NAN;
    assert_int_equal(ewa_options_take(context, &sample_table, &given, &chosen), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "any[1] is nan, allowed is (-inf, inf)"));
}

/// The same through the public functions.
TEST_LOGGED(test_callers, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    struct {
        ewa_generate_options options;
        double later;
    } newer = {.later = 0};
    ewa_generate_options_init(&newer.options, sizeof newer);
    newer.options.point_count = 12;
    assert_int_equal(ewa_cloud_generate(context, &newer.options, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(cloud), 12);
    newer.later = 1;
    ewa_cloud *other = NULL;
    assert_int_equal(ewa_cloud_generate(context, &newer.options, &other), EWA_ERROR_UNSUPPORTED);
    assert_null(other);
    WITH_DEFAULTS(ewa_surfels_options, older);
    older.struct_size = offsetof(ewa_surfels_options, radius_scale);
    older.radius_scale = -1; // of another program's variable
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, &older);
}

TEST(test_colors) {
    static const struct {
        const char *text;
        double srgba[4];
    } good[] = {{"white", {1, 1, 1, 1}},
                {"black", {0, 0, 0, 1}},
                {"transparent", {0, 0, 0, 0}},
                {"grey", {0.5, 0.5, 0.5, 1}},
                {"#f80", {1, 136 / 255.0, 0, 1}},
                {"#FF8800", {1, 136 / 255.0, 0, 1}},
                {"#f80c", {1, 136 / 255.0, 0, 0.8}},
                {"#ff8800cc", {1, 136 / 255.0, 0, 0.8}},
                {"0,0.25,1", {0, 0.25, 1, 1}},
                {"1,0,0.5,0.125", {1, 0, 0.5, 0.125}}};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        double srgba[4];
        assert_true(ewa_color_read(good[i].text, srgba));
        for (int c = 0; c < 4; c++) assert_true(fabs(srgba[c] - good[i].srgba[c]) < 1e-15);
    }
    static const char *const bad[] = {"",       "red",      "#",          "#f8",     "#f8000",
                                      "#ff880", "#ff88000", "#ff8800ccc", "#gg0000", "#+f-f 1",
                                      "1,2,3",  "1,1",      "1,1,1,1,1",  "1,1,",    ",1,1,1",
                                      "1,1,1,", "-1,0,0",   "nan,0,0",    "1 1 1",   "white "};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double srgba[4] = {7, 7, 7, 7};
        if (ewa_color_read(bad[i], srgba)) fail_msg("'%s' is a colour", bad[i]);
        for (int c = 0; c < 4; c++) assert_true(srgba[c] == 7);
    }
    assert_false(ewa_color_read(NULL, NULL));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
