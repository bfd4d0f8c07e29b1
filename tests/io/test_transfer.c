// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of transfer functions: the JSON files, opacity, presets, what is made from a histogram.
#include "image/transfer.h"
#include "io/volume/transfer.h"
#include "scratch.h"

#include <math.h>

static ewa_status read_text(ewa_context *context, const char *text, ewa_transfer *transfer) {
    const size_t size_bytes = strlen(text);
    OWNED(check_free) uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    memcpy(copy, text, size_bytes);
    const ewa_status status = ewa_transfer_read(context, "look.json", copy, size_bytes, transfer);
    return status;
}

TEST(test_opacity) {
    // Against the library's own logarithm.
    for (int i = 0; i < 100000; i++) {
        const double opacity = i / 100000.0, wanted = -log1p(-opacity);
        assert_true(fabs(ewa_extinction_of_opacity(opacity) - wanted) <= 4e-16 * fmax(wanted, 1));
    }
    assert_true(ewa_extinction_of_opacity(0) == 0);
    assert_true(fabs(ewa_extinction_of_opacity(1) - 20 * log(2)) < 1e-12);
}

static const char WHOLE[] =
    "{\"name\": \"x\", \"unit_length\": 2.5, \"color_space\": \"srgb\", \"gradient\": [1, 4],\n"
    " \"points\": [{\"value\": -5, \"color\": [0, 0.5, 1], \"opacity\": 0},\n"
    "  {\"value\": 10, \"color\": [1, 1, 1], \"opacity\": 0.5},\n"
    "  {\"value\": 10, \"color\": [1, 0, 0], \"extinction\": 3}]}\n";

TEST_ON(test_known_file, 1) {
    ewa_transfer transfer;
    assert_int_equal(read_text(context, WHOLE, &transfer), EWA_OK);
    assert_int_equal(transfer.point_count, 3);
    assert_true(transfer.unit_length_world == 2.5);
    assert_true(transfer.gradient_low == 1 && transfer.gradient_high == 4);
    const ewa_transfer_point *p = transfer.points;
    assert_true(p[0].value == -5 && p[0].extinction == 0 && p[0].color[0] == 0 && p[0].color[2] == 1);
    assert_true(p[0].color[1] == ewa_linear_from_srgb(0.5f));
    assert_true(fabsf(p[1].extinction - (float)log(2)) < 1e-7f && p[2].extinction == 3);
    // The same numbers come back from a file of ours.
    char path[512];
    ewa_transfer again;
    assert_int_equal(ewa_transfer_save(context, &transfer, scratch_path("look.json", path)), EWA_OK);
    assert_int_equal(ewa_transfer_load(context, path, &again), EWA_OK);
    assert_memory_equal(&again, &transfer, sizeof transfer);
    // Linear colours are taken as they are.
    assert_int_equal(read_text(context,
                               "{\"points\": [{\"value\": 0, \"color\": [0.25, 7, 0], \"opacity\": 1}, "
                               "{\"value\": 1, \"color\": [0, 0, 0], \"opacity\": 1}], "
                               "\"color_space\": \"linear\"}",
                               &transfer),
                     EWA_OK);
    assert_true(transfer.points[0].color[0] == 0.25f && transfer.points[0].color[1] == 7);
    assert_true(transfer.unit_length_world == 0 && transfer.gradient_high == 0);
}

#define POINT(value)    "{\"value\": " value ", \"color\": [0, 0, 0], \"opacity\": 0.5}"
#define FILE_OF(points) "{\"points\": [" points "]}"

TEST(test_broken_files) {
    static const struct {
        const char *text, *said;
    } files[] = {
        {"", ""},
        {"[]", "points"},
        {"{}", "points"},
        {"{\"points\": 3}", "points"},
        {FILE_OF(""), "0 points"},
        {FILE_OF(POINT("1")), "1 points"},
        {FILE_OF(POINT("2") "," POINT("1")), "below"},
        {FILE_OF(POINT("1") "," POINT("\"x\"")), "value"},
        {FILE_OF(POINT("1") "," POINT("1e999")), ""},
        {FILE_OF(POINT("1") ", 7"), "not an object"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"color\": [0, 0, 0]}"), "'opacity' is missing"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"opacity\": 0}"), "'color' is missing"},
        {FILE_OF(POINT("1") ", {\"color\": [0, 0, 0], \"opacity\": 0}"), "'value' is missing"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"color\": [0, 0], \"opacity\": 0}"), "three numbers"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"color\": [0, 0, 1.5], \"opacity\": 0}"), "[0, 1]"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"color\": [0, 0, 0], \"opacity\": 1.5}"), "[0, 1]"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"color\": [0, 0, 0], \"extinction\": -1}"), ">= 0"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"color\": [0, 0, 0], \"opacity\": 0, \"extinction\": 1}"),
         "other"},
        {FILE_OF(POINT("1") ", {\"value\": 2, \"colour\": [0, 0, 0], \"opacity\": 0}"), "colour"},
        {"{\"unit_length\": 0, \"points\": [" POINT("1") "," POINT("2") "]}", "unit_length"},
        {"{\"gradient\": [2, 1], \"points\": [" POINT("1") "," POINT("2") "]}", "gradient"},
        {"{\"gradient\": [-1, 1], \"points\": [" POINT("1") "," POINT("2") "]}", "gradient"},
        {"{\"gradient\": 3, \"points\": [" POINT("1") "," POINT("2") "]}", "gradient"},
        {"{\"color_space\": \"lab\", \"points\": [" POINT("1") "," POINT("2") "]}", "color_space"},
        {"{\"other\": 1, \"points\": [" POINT("1") "," POINT("2") "]}", "other"},
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        ewa_transfer transfer;
        log.count = 0;
        const ewa_status status = read_text(context, files[i].text, &transfer);
        if (status != EWA_ERROR_FORMAT || !log.count || !strstr(log.text, files[i].said) ||
            strncmp(log.text, "look.json:", 10) != 0)
            fail_msg("case %zu: status %d, '%s'", i, status, log.text);
        assert_int_equal(transfer.point_count, 0);
    }
}

TEST_ON(test_every_truncation_fails, 1) {
    for (size_t size = 0; size < sizeof WHOLE - 2; size++) {
        char text[sizeof WHOLE];
        ewa_transfer transfer;
        memcpy(text, WHOLE, size);
        text[size] = 0;
        assert_int_equal(read_text(context, text, &transfer), EWA_ERROR_FORMAT);
    }
}

TEST_ON(test_too_many_points, 1) {
    OWNED(check_free) char *text = malloc(EWA_MAX_TRANSFER_POINTS * 64 + 256);
    for (int more = 0; more < 2; more++) {
        char *at = text + sprintf(text, "{\"points\": [" POINT("0"));
        for (int i = 1; i < EWA_MAX_TRANSFER_POINTS + more; i++) at += sprintf(at, "," POINT("1"));
        sprintf(at, "]}");
        ewa_transfer transfer;
        assert_int_equal(read_text(context, text, &transfer), more ? EWA_ERROR_LIMIT : EWA_OK);
    }
}

/// 16 x 16 x 16 shorts from `low` on: noise, in it a ball at 40 %, in that one at 90 %.
static void make_volume(ewa_context *context, int low, int width, ewa_volume *volume) {
    assert_int_equal(ewa_volume_create(context, (const uint32_t[3]){16, 16, 16}, EWA_I16, volume), EWA_OK);
    int16_t *voxels = volume->voxels;
    check_random random = {7};
    for (int i = 0; i < 4096; i++) {
        const double x = i % 16 - 7.5, y = i / 16 % 16 - 7.5, z = i / 256 - 7.5,
                     r = sqrt(x * x + y * y + z * z);
        const double middle = r < 3 ? 0.9 : r < 6.5 ? 0.4 : 0.05;
        voxels[i] = (int16_t)floor(low + width * (middle + check_uniform(&random, -0.03, 0.03)));
    }
    voxels[0] = (int16_t)low;
    voxels[1] = (int16_t)(low + width);
}

/// The extinction at a value.
static double extinction_at(const ewa_transfer *transfer, double value) {
    for (uint32_t i = 0; i + 1 < transfer->point_count; i++) {
        const ewa_transfer_point *a = &transfer->points[i], *b = a + 1;
        if (value < a->value || value > b->value || a->value == b->value) continue;
        const double t = (value - a->value) / (b->value - a->value);
        return (1 - t) * (double)a->extinction + t * (double)b->extinction;
    }
    return 0;
}

TEST_ON(test_automatic, 1) {
    OWNED(ewa_volume_free) ewa_volume volume;
    ewa_volume_facts facts;
    ewa_transfer transfer;
    make_volume(context, 100, 10000, &volume);
    assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
    assert_true(facts.low == 100 && facts.high == 10100 && facts.finite_count == 4096);
    assert_int_equal(ewa_transfer_automatic(&volume, &facts, &transfer), EWA_OK);
    assert_int_equal(ewa_transfer_check(context, "auto", &transfer), EWA_OK);
    // Empty where the noise is, something at the outer ball, denser and denser up to the top.
    assert_true(extinction_at(&transfer, 150) == 0 && extinction_at(&transfer, 850) == 0);
    double last = 0;
    for (int i = 1; i <= 100; i++) {
        const double now = extinction_at(&transfer, 100 + 100 * i);
        if (now < last - 1e-12) fail_msg("at %d: %g after %g", 100 + 100 * i, now, last);
        last = now;
    }
    assert_true(extinction_at(&transfer, 4100) > 0.001);
    assert_true(extinction_at(&transfer, 10100) > 0.5);
    // 15 spacings across: the unit of length goes with the size.
    assert_true(fabs(transfer.unit_length_world - 15.0 / 128) < 1e-12);
    // The same picture at another scale of the values.
    OWNED(ewa_volume_free) ewa_volume other;
    ewa_transfer shifted;
    make_volume(context, -5000, 10000, &other);
    assert_int_equal(ewa_volume_measure(&other, &facts), EWA_OK);
    assert_int_equal(ewa_transfer_automatic(&other, &facts, &shifted), EWA_OK);
    assert_int_equal(shifted.point_count, transfer.point_count);
    for (uint32_t i = 0; i < shifted.point_count; i++) {
        assert_true(fabs(shifted.points[i].value + 5100 - transfer.points[i].value) < 1e-6);
        assert_true(shifted.points[i].extinction == transfer.points[i].extinction);
    }
}

/// What a volume holds, against sums of our own: every type, numbers that are none, a slanted grid.
TEST_ON(test_measure, 1) {
    static const ewa_type types[] = {EWA_U8, EWA_I8, EWA_U16, EWA_I16, EWA_F32};
    enum { X = 13, Y = 7, Z = 29, COUNT = X * Y * Z };
    for (int t = 0; t < 5; t++) {
        OWNED(ewa_volume_free) ewa_volume volume;
        assert_int_equal(ewa_volume_create(context, (const uint32_t[3]){X, Y, Z}, types[t], &volume), EWA_OK);
        static const double place[12] = {1, 0.5, 0, 10, -2, 0.25, 0, 20, 0, 0, -3, 30};
        memcpy(volume.index_to_world, place, sizeof place);
        double *numbers = malloc(COUNT * sizeof *numbers), low = INFINITY, high = -INFINITY, sum = 0;
        check_random random = {(uint64_t)t};
        uint64_t finite = 0, counts[256] = {0};
        for (int i = 0; i < COUNT; i++) {
            const double u = check_uniform(&random, 0, 1), share = u * u;
            switch (types[t]) {
            case EWA_U8:
                numbers[i] = ((uint8_t *)volume.voxels)[i] = (uint8_t)(share * 256);
                break;
            case EWA_I8:
                numbers[i] = ((int8_t *)volume.voxels)[i] = (int8_t)(share * 200 - 100);
                break;
            case EWA_U16:
                numbers[i] = ((uint16_t *)volume.voxels)[i] = (uint16_t)(share * 60000);
                break;
            case EWA_I16:
                numbers[i] = ((int16_t *)volume.voxels)[i] = (int16_t)(share * 5000 - 1000);
                break;
            default:
                ((float *)volume.voxels)[i] = i % 50 == 3   ? NAN
                                              : i % 77 == 5 ? -INFINITY
                                                            : (float)(share * 1e-3);
                numbers[i] = (double)((float *)volume.voxels)[i];
            }
            if (!isfinite(numbers[i])) continue;
            finite++;
            low = fmin(low, numbers[i]), high = fmax(high, numbers[i]), sum += numbers[i];
        }
        // The middle of bin b is b 255ths of the way.
        for (int i = 0; i < COUNT; i++) {
            int nearest = 0;
            for (int b = 1; b < 256 && isfinite(numbers[i]); b++)
                if (fabs(low + (high - low) * b / 255 - numbers[i]) <=
                    fabs(low + (high - low) * nearest / 255 - numbers[i]))
                    nearest = b;
            counts[nearest] += isfinite(numbers[i]);
        }
        ewa_volume_facts facts;
        assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
        assert_true(facts.voxel_count == COUNT && facts.finite_count == finite);
        assert_true(facts.low == low && facts.high == high);
        assert_true(fabs(facts.mean - sum / (double)finite) <= 1e-9 * (high - low));
        uint64_t moved = 0; // where a number is half-way between two bins
        for (int b = 0; b < 256; b++)
            moved += facts.histogram[b] > counts[b] ? facts.histogram[b] - counts[b]
                                                    : counts[b] - facts.histogram[b];
        assert_true(moved <= 6);
        static const double lengths[3] = {2.23606797749979, 0.5590169943749475, 3};
        static const double corner_low[3] = {10, -4, -54}, corner_high[3] = {25, 21.5, 30};
        for (int axis = 0; axis < 3; axis++) {
            assert_true(fabs(facts.spacing_world[axis] - lengths[axis]) < 1e-12);
            assert_true(facts.low_world[axis] == corner_low[axis] &&
                        facts.high_world[axis] == corner_high[axis]);
        }
        free(numbers);
    }
}

/// Every preset's points, where values are Hounsfield units and where they are shares of the range.
TEST_ON(test_preset_points, 1) {
    static const struct {
        const char *name, *points;
    } presets[] = {
        {"bone", "150 0.36 8a3a22 0; 230 0.42 c08a5c 0.05; 400 0.5 e8d2a8 0.35; 1000 0.75 fff6e4 0.7; 3000 1 "
                 "ffffff 0.8; "},
        {"soft", "-350 0.12 b87a5c 0; -120 0.19 d69a78 0.014; 20 0.25 c86a50 0.008; 90 0.3 b04a38 0.012; 250 "
                 "0.44 e4cca4 "
                 "0.3; 1000 0.75 fff6e4 0.7; 3000 1 ffffff 0.8; "},
        {"skin", "-450 0.1 d8a080 0; -200 0.17 e0ac8c 0.45; 100 0.3 e4b494 0.7; 3000 1 f4e4d4 0.8; "},
        {"vessels", "100 0.22 7a1410 0; 180 0.34 b42018 0.12; 350 0.55 d8402c 0.5; 700 0.8 f4c49c 0.7; 3000 "
                    "1 fff6e4 0.8; "},
        {"mri", "0.1 0.1 5a4a44 0; 0.22 0.22 96786a 0.015; 0.45 0.45 c4a48e 0.05; 0.7 0.7 e8d8c4 0.15; 1 1 "
                "ffffff 0.4; "},
        {"gray", "0 0 000000 0; 1 1 ffffff 0.25; "},
        {"fog", "0 0 8494a4 0; 1 1 8494a4 0.03; "},
    };
    ewa_volume volumes[2];
    ewa_volume_facts facts[2];
    for (int kind = 0; kind < 2; kind++) {
        make_volume(context, kind ? 0 : -1000, kind ? 1000 : 4000, &volumes[kind]);
        assert_int_equal(ewa_volume_measure(&volumes[kind], &facts[kind]), EWA_OK);
        assert_true(fabs(ewa_transfer_unit(&facts[kind]) - 15.0 / 128) < 1e-12);
    }
    for (size_t n = 0; n < sizeof presets / sizeof presets[0]; n++) {
        ewa_transfer transfers[2];
        char points[1024] = "";
        for (int kind = 0; kind < 2; kind++)
            assert_int_equal(
                ewa_transfer_preset(&volumes[kind], &facts[kind], presets[n].name, &transfers[kind]), EWA_OK);
        const bool hounsfield = n < 4;
        // What is above the last stop looks like it; the stops' shares are of all but 0.05 % of the voxels.
        uint32_t stops = transfers[1].point_count;
        const ewa_transfer_point *end = &transfers[1].points[stops - 1];
        if (end->extinction == end[-1].extinction && end->color[2] == end[-1].color[2]) stops--;
        const double range = transfers[1].points[stops - 1].value;
        assert_true(range > 900 && range < 950); // there is one voxel beyond
        for (uint32_t i = 0; i < stops; i++) {
            const ewa_transfer_point *p = &transfers[1].points[i];
            const double share = p->value / range;
            const double first = hounsfield ? transfers[0].points[i].value : share;
            unsigned code = 0;
            for (int c = 0; c < 3; c++)
                code = code << 8 | (unsigned)lrint(255 * (double)ewa_srgb_from_linear(p->color[c]));
            char text[64];
            snprintf(text, sizeof text, hounsfield ? "%.6g %.2g %06x %.3g; " : "%.2g %.2g %06x %.3g; ", first,
                     share, code, 1 - exp(-(double)p->extinction));
            strncat(points, text, sizeof points - strlen(points) - 1);
        }
        if (strcmp(points, presets[n].points) != 0) fail_msg("%s: %s", presets[n].name, points);
    }
    for (int kind = 0; kind < 2; kind++) ewa_volume_free(&volumes[kind]);
}

TEST_LOGGED(test_presets, 1) {
    OWNED(ewa_volume_free) ewa_volume volume;
    ewa_volume_facts facts;
    ewa_transfer transfer;
    const char *name, *what;
    // Hounsfield units, and those of nobody.
    for (int kind = 0; kind < 2; kind++) {
        make_volume(context, kind ? 0 : -1000, 3000, &volume);
        assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
        for (uint32_t i = 0; (name = ewa_transfer_preset_name(i, &what)); i++) {
            assert_non_null(what);
            assert_int_equal(ewa_transfer_preset(&volume, &facts, name, &transfer), EWA_OK);
            assert_int_equal(ewa_transfer_check(context, name, &transfer), EWA_OK);
            assert_true(transfer.points[0].extinction == 0);
            assert_true(transfer.points[transfer.point_count - 1].value >= facts.high);
        }
        assert_int_equal(ewa_transfer_preset(&volume, &facts, "bone", &transfer), EWA_OK);
        assert_true(kind ? transfer.points[0].value > 900 : transfer.points[0].value == 150);
        assert_int_equal(ewa_transfer_preset(&volume, &facts, "blood", &transfer), EWA_ERROR_ARGUMENT);
        ewa_volume_free(&volume);
    }
    // Volumes of one value have nothing to tell apart.
    assert_int_equal(ewa_volume_create(context, (const uint32_t[3]){2, 2, 2}, EWA_F32, &volume), EWA_OK);
    assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
    assert_int_equal(ewa_transfer_preset(&volume, &facts, "gray", &transfer), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_transfer_automatic(&volume, &facts, &transfer), EWA_ERROR_NUMERIC);
    for (int i = 0; i < 8; i++) ((float *)volume.voxels)[i] = NAN;
    assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
    assert_int_equal(ewa_transfer_automatic(&volume, &facts, &transfer), EWA_ERROR_NUMERIC);
}

static ewa_status save_and_load(ewa_context *context, void *user) {
    ewa_transfer transfer;
    ewa_status status = read_text(context, WHOLE, &transfer);
    if (status == EWA_OK) status = ewa_transfer_save(context, &transfer, user);
    if (status == EWA_OK) status = ewa_transfer_load(context, user, &transfer);
    return status;
}

TEST_ON(test_failing_allocations, 1) {
    char path[512];
    scratch_fail_each(save_and_load, (void *)(uintptr_t)scratch_path("failing.json", path));
    ewa_transfer transfer;
    assert_int_equal(ewa_transfer_load(context, "/no/such/file", &transfer), EWA_ERROR_IO);
    assert_int_equal(read_text(context, WHOLE, &transfer), EWA_OK);
    assert_int_equal(ewa_transfer_save(context, &transfer, "/no/such/folder/file"), EWA_ERROR_IO);
    transfer.points[0].value = NAN;
    assert_int_equal(ewa_transfer_save(context, &transfer, path), EWA_ERROR_ARGUMENT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
