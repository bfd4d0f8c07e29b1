// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// TIFF files of heights: every type of number and way of storing it, places, degrees, marks for no height, what is
// refused, every truncation, hostile sizes. Files of GDAL's writer were held to its numbers by hand.
#include "io/rows_check.h"
#include "io/tiff_sample.h"

#include <tiffio.h>

static tiff_file file;

static ewa_cloud *load(const tiff_file *f, int message_count) {
    ewa_cloud *cloud = NULL;
    messages.count = 0;
    if (ewa_cloud_load_memory(context, f->bytes, f->size, "t", &cloud) != EWA_OK) fail_msg("%s", messages.text);
    if (messages.count != message_count) fail_msg("%d messages, %s", messages.count, messages.text);
    return cloud;
}

static void refuse(tiff_kind kind, ewa_status status, const char *said) {
    ewa_cloud *cloud = NULL;
    tiff_make(&file, kind);
    messages.count = 0;
    messages.text[0] = 0;
    const ewa_status got = ewa_cloud_load_memory(context, file.bytes, file.size, "t", &cloud);
    if (got != status || !strstr(messages.text, said)) fail_msg("status %d: %s\nlacks: %s", got, messages.text, said);
    assert_null(cloud);
}

/// Holds a cloud to cells of 10 from (1000, 5000), the first row in the north, without the cell that has no height.
static void expect_cells(const ewa_cloud *cloud, bool has_hole) {
    rows_expect(cloud, TIFF_COLUMNS * TIFF_ROWS - has_hole, "position");
    uint64_t point = 0;
    for (int row = 0; row < TIFF_ROWS; row++)
        for (int column = 0; column < TIFF_COLUMNS; column++) {
            if (has_hole && row == 1 && column == 2) continue;
            rows_expect_world(cloud, point++, 1005 + 10 * column, 4995 - 10 * row, tiff_height(column, row));
        }
}

static const tiff_kind PLACED = {.scale = 10, .x = 1000, .y = 5000, .model = 1};

TEST_WITHIN(test_numbers, set_up, tear_down) {
    static const struct {
        int bits, kind;
    } kinds[] = {{8, SAMPLE_UINT},  {16, SAMPLE_UINT}, {16, SAMPLE_INT},   {32, SAMPLE_UINT},
                 {32, SAMPLE_INT},  {64, SAMPLE_UINT}, {64, SAMPLE_INT}, {32, SAMPLE_FLOAT}, {64, SAMPLE_FLOAT}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        for (int way = 0; way < 16; way++) {
            tiff_kind kind = PLACED;
            kind.bits = kinds[i].bits;
            kind.kind = kinds[i].kind;
            kind.big_endian = way & 1;
            kind.tiled = way & 2;
            kind.bands = way & 4 ? 2 : 1;
            kind.separate = way & 8;
            tiff_make(&file, kind);
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file, kind.bands > 1);
            expect_cells(cloud, false);
            assert_string_equal(ewa_cloud_note(cloud, "crs", NULL), "EPSG:32632");
        }
}

/// libtiff's own files: packed, with predictors.
TEST_WITHIN(test_packed, set_up, tear_down) {
    static const struct {
        int compression, predictor;
    } ways[] = {{COMPRESSION_LZW, 1}, {COMPRESSION_LZW, 3}, {COMPRESSION_ADOBE_DEFLATE, 2}, {COMPRESSION_PACKBITS, 1}};
    char path[512];
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        TIFF *tiff = TIFFOpen(scratch_path("packed.tif", path), "w");
        assert_non_null(tiff);
        const bool real = ways[i].predictor != 2;
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, TIFF_COLUMNS);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, TIFF_ROWS);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, real ? 32 : 16);
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, real ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_INT);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, ways[i].compression);
        if (ways[i].predictor > 1) TIFFSetField(tiff, TIFFTAG_PREDICTOR, ways[i].predictor);
        for (uint32_t row = 0; row < TIFF_ROWS; row++) {
            float floats[TIFF_COLUMNS];
            int16_t shorts[TIFF_COLUMNS];
            for (int c = 0; c < TIFF_COLUMNS; c++) {
                floats[c] = (float)tiff_height(c, (int)row);
                shorts[c] = (int16_t)tiff_height(c, (int)row);
            }
            assert_int_equal(TIFFWriteScanline(tiff, real ? (void *)floats : shorts, row, 0), 1);
        }
        TIFFClose(tiff);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        messages.count = 0;
        assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_OK);
        assert_int_equal(messages.count, 1); // cells of 1
        assert_non_null(strstr(messages.text, "how large its cells are"));
        rows_expect(cloud, TIFF_COLUMNS * TIFF_ROWS, "position");
        rows_expect_world(cloud, TIFF_COLUMNS + 2, 2.5, -1.5, tiff_height(2, 1));
    }
}

TEST_WITHIN(test_places, set_up, tear_down) {
    tiff_kind kind = PLACED;
    kind.is_point = true;
    tiff_make(&file, kind);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file, 0);
    rows_expect_world(cloud, 0, 1000, 5000, 100);
    rows_expect_world(cloud, TIFF_COLUMNS + 2, 1020, 4990, tiff_height(2, 1));
    ewa_cloud_destroy(&cloud);
    kind = PLACED;
    kind.matrix = true;
    tiff_make(&file, kind);
    cloud = load(&file, 0);
    rows_expect_world(cloud, 0, 1005, 5005, 100);
    rows_expect_world(cloud, TIFF_COLUMNS + 2, 1015, 5025, tiff_height(2, 1));
}

/// Cells of 0.01 degrees about 50 degrees north, with the key, and without it, where slopes tell.
TEST_WITHIN(test_degrees, set_up, tear_down) {
    for (int model = 0; model <= 2; model += 2)
        for (int tiled = 0; tiled < 2; tiled++) {
            tiff_make(&file, (tiff_kind){.scale = 0.01, .x = 7, .y = 50.025, .model = model, .tiled = tiled});
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file, 0);
            assert_null(ewa_cloud_note(cloud, "crs", NULL));
            assert_string_equal(ewa_cloud_note(cloud, "file.degrees", NULL), "longitude 7.035, latitude 50");
            double first[3], last[3];
            ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), 0, 1, first);
            ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), TIFF_COLUMNS * TIFF_ROWS - 1, 1, last);
            // A degree of longitude is 71,696 m at 50 degrees, one of latitude 111,229 m.
            if (fabs((last[0] - first[0]) / 0.06 - 71696) > 1 || fabs((first[1] - last[1]) / 0.04 - 111229) > 1)
                fail_msg("%.3f, %.3f", (last[0] - first[0]) / 0.06, (first[1] - last[1]) / 0.04);
            assert_true(first[2] == 100);
        }
    // What may be metres stays: gentle slopes.
    tiff_make(&file, (tiff_kind){.scale = 1, .x = 7, .y = 50});
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file, 0);
    rows_expect_world(cloud, 0, 7.5, 49.5, 100);
}

TEST_WITHIN(test_no_data, set_up, tear_down) {
    static const struct {
        const char *said;
        double hole;
        int bits;
    } cases[] = {{"-1 ", -1, 32},         {"-3.4028234663852886e+38", -3.4028234663852886e38, 32},
                 {"0.1", 0.1, 32},        {NULL, -9999, 32},
                 {NULL, -32768, 32},      {NULL, (double)NAN, 32},
                 {"nan", (double)NAN, 64}, {"12345.678", 12345.678, 64}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tiff_kind kind = PLACED;
        kind.no_data = cases[i].said;
        kind.hole = cases[i].hole;
        kind.bits = cases[i].bits;
        tiff_make(&file, kind);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file, 0);
        expect_cells(cloud, true);
    }
    // A strip that is not there has no heights.
    tiff_kind kind = PLACED;
    kind.no_strips = true;
    tiff_make(&file, kind);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file, 0);
    rows_expect(cloud, TIFF_COLUMNS * (TIFF_ROWS - 2), "position");
    rows_expect_world(cloud, 0, 1005, 4975, tiff_height(0, 2));
}

TEST_WITHIN(test_refused, set_up, tear_down) {
    tiff_kind kind = PLACED;
    kind.photometric = PHOTOMETRIC_RGB;
    kind.bands = 3;
    refuse(kind, EWA_ERROR_UNSUPPORTED, "a TIFF picture");
    refuse((tiff_kind){.bits = 8, .kind = SAMPLE_UINT}, EWA_ERROR_UNSUPPORTED, "a TIFF picture");
    kind = PLACED;
    kind.points_only = true;
    refuse(kind, EWA_ERROR_UNSUPPORTED, "the places of 1 single points");
    kind = PLACED;
    kind.model = 3;
    refuse(kind, EWA_ERROR_UNSUPPORTED, "geocentric");
    kind = PLACED;
    kind.compression = 4242;
    refuse(kind, EWA_ERROR_UNSUPPORTED, "compression 4242");
    kind = PLACED;
    kind.bits = 16;
    refuse(kind, EWA_ERROR_UNSUPPORTED, "numbers of 16 bits");
    kind = PLACED;
    kind.scale = INFINITY;
    refuse(kind, EWA_ERROR_FORMAT, "cells of no area");
}

/// Makes the entry of a tag one number of 32 bits, if the directory has it.
static void set_tag(uint16_t wanted, uint32_t number) {
    for (int i = 0; i < file.entries; i++) {
        const size_t at = 10 + 12 * (size_t)i;
        const uint16_t tag = (uint16_t)(file.bytes[at] | file.bytes[at + 1] << 8), type = 4;
        const uint32_t count = 1;
        if (tag != wanted) continue;
        tiff_put_at(&file, at + 2, &type, 2);
        tiff_put_at(&file, at + 4, &count, 4);
        tiff_put_at(&file, at + 8, &number, 4);
    }
}

/// A directory that claims any size costs no memory and no time.
/// Pictures one behind another without a place are a volume.
TEST_WITHIN(test_stack, set_up, tear_down) {
    char path[512];
    TIFF *tiff = TIFFOpen(scratch_path("stack.tif", path), "w");
    assert_non_null(tiff);
    for (int page = 0; page < 3; page++) {
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, TIFF_COLUMNS);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, TIFF_ROWS);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFF_ROWS);
        uint16_t row[TIFF_COLUMNS];
        for (int k = 0; k < TIFF_COLUMNS; k++) row[k] = (uint16_t)(100 + k);
        for (uint32_t k = 0; k < TIFF_ROWS; k++) assert_int_equal(TIFFWriteScanline(tiff, row, k, 0), 1);
        assert_int_equal(TIFFWriteDirectory(tiff), 1);
    }
    TIFFClose(tiff);
    ewa_cloud *cloud = NULL;
    messages.count = 0;
    assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(messages.text, "a stack of pictures"));
    assert_null(cloud);
}

TEST_WITHIN(test_sizes, set_up, tear_down) {
    static const uint32_t sizes[] = {0, 1, 65535, 1u << 20, 1u << 30, UINT32_MAX};
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            for (int tiled = 0; tiled < 2; tiled++) {
                tiff_kind kind = PLACED;
                kind.tiled = tiled;
                tiff_make(&file, kind);
                // Of width and height, or of the blocks, as numbers of 32 bits.
                for (int blocks = 0; blocks < 2; blocks++) {
                    set_tag(blocks ? (tiled ? 322 : 278) : 256, sizes[a]);
                    if (!blocks || tiled) set_tag(blocks ? 323 : 257, sizes[b]);
                }
                OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
                ewa_cloud_load_memory(context, file.bytes, file.size, "t", &cloud);
            }
}

/// Nor do 2^40 cells in strips that are not there, also where their slopes have to say whether they are in degrees.
TEST_WITHIN(test_empty, set_up, tear_down) {
    for (int model = 0; model < 2; model++) {
        tiff_make(&file, (tiff_kind){.scale = 1e-5, .model = model});
        set_tag(256, 1 << 20); // columns
        set_tag(257, 1 << 20); // rows
        set_tag(278, 16);      // of a strip
        set_tag(279, 0);       // bytes of the strips
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file, 0);
        assert_int_equal(ewa_cloud_point_count(cloud), 0);
    }
}

TEST_WITHIN(test_truncation, set_up, tear_down) {
    tiff_make(&file, PLACED);
    char path[512];
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.keep_going = true;
    uint64_t last = 0;
    for (size_t cut = 0; cut < file.size; cut++) {
        uint8_t *part = malloc(cut + 1);
        assert_non_null(part);
        memcpy(part, file.bytes, cut);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        assert_int_not_equal(ewa_cloud_load_memory(context, part, cut, "t", &cloud), EWA_OK);
        assert_null(cloud);
        scratch_write(scratch_path("cut.tif", path), part, cut);
        free(part);
        OWNED(ewa_cloud_reader_close) ewa_cloud_reader *reader = NULL;
        if (ewa_cloud_reader_open(context, path, &options, &reader) != EWA_OK) continue;
        assert_int_equal(ewa_cloud_reader_next(reader, 100, &cloud), EWA_OK);
        const uint64_t count = cloud ? ewa_cloud_point_count(cloud) : 0;
        assert_int_equal(count + ewa_cloud_reader_lost_count(reader), TIFF_COLUMNS * TIFF_ROWS);
        assert_true(count >= last);
        last = count;
        for (uint64_t i = 0; i < count; i++)
            rows_expect_world(cloud, i, 1005 + 10.0 * (double)(i % TIFF_COLUMNS),
                              4995 - 10.0 * (double)(i / TIFF_COLUMNS),
                              tiff_height((int)(i % TIFF_COLUMNS), (int)(i / TIFF_COLUMNS)));
    }
    assert_int_equal(last, 2 * 2 * TIFF_COLUMNS);
}

TEST_WITHIN(test_name, set_up, tear_down) {
    char path[512];
    ewa_model_format format;
    tiff_make(&file, PLACED);
    scratch_write(scratch_path("a.tif", path), file.bytes, file.size);
    assert_int_equal(ewa_model_probe(context, path, &format), EWA_OK);
    assert_int_equal(format, EWA_MODEL_TIFF);
    assert_string_equal(ewa_model_format_name(format), "GeoTIFF");
}

static ewa_status load_failing(ewa_context *failing, void *user) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    const tiff_file *f = user;
    const ewa_status status = ewa_cloud_load_memory(failing, f->bytes, f->size, "t", &cloud);
    return status;
}

TEST(test_failing_allocations) {
    tiff_make(&file, (tiff_kind){.scale = 0.01, .x = 7, .y = 50});
    scratch_fail_each(load_failing, &file);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
