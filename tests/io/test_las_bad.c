// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Broken LAS and LAZ files: every truncation, every byte of the header changed, damaged chunks, what breaks
// readers.
#include "io/las_sample.h"
#include "io/scratch.h"

#include "io/fixture.h"

/// A sample as the bytes of LAZ, in chunks of `chunk_points`.
static uint8_t *compress(const las_sample *s, uint32_t chunk_points, size_t *size_bytes) {
    ewa_cloud *cloud = las_load(context, s);
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    options.chunk_points = chunk_points;
    char path[512];
    scratch_path("bad.laz", path);
    assert_int_equal(ewa_cloud_save(cloud, path, &options), EWA_OK);
    ewa_cloud_destroy(&cloud);
    uint8_t *bytes = scratch_read(path, size_bytes);
    remove(path);
    return bytes;
}

/// Loads bytes that lie at the end of their memory, so that a sanitizer sees what is read behind them.
static ewa_status load(const uint8_t *bytes, size_t size_bytes, uint64_t *point_count) {
    uint8_t *copy = malloc(size_bytes + 1);
    assert_non_null(copy);
    memcpy(copy + 1, bytes, size_bytes);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    messages = (check_log){0};
    const ewa_status status = ewa_cloud_load_memory(context, copy + 1, size_bytes, "bad.laz", &cloud);
    free(copy);
    assert_true((status == EWA_OK) == (cloud != NULL));
    assert_true(status == EWA_OK || messages.count > 0);
    if (point_count) *point_count = cloud ? ewa_cloud_point_count(cloud) : 0;
    return status;
}

CASE(test_every_truncation) {
    for (uint8_t format = 3; format <= 7; format += 4) {
        las_sample s = las_make(format, 4, 4, 40, NULL, 0, 0);
        for (size_t size = 0; size < s.size_bytes; size++) {
            uint64_t count;
            const ewa_status status = load(s.bytes, size, &count);
            // A file that ends before its first point holds none.
            if ((status == EWA_OK) != (size == s.points_at) || count) fail_msg("%zu bytes: %d", size, status);
        }
        size_t size_bytes;
        uint8_t *bytes = compress(&s, 15, &size_bytes);
        // Of the table of chunks, only zeros that the coder reads ahead may lack.
        for (size_t size = 0; size < size_bytes; size++)
            if (load(bytes, size, NULL) == EWA_OK && size + 4 < size_bytes)
                fail_msg("%zu bytes are read", size);
        free(bytes);
        free(s.bytes);
    }
}

CASE(test_every_byte_of_the_header) {
    las_sample s = las_make(7, 4, 0, 40, NULL, 0, 0);
    size_t size_bytes;
    uint8_t *bytes = compress(&s, 15, &size_bytes);
    static const uint8_t values[] = {0, 1, 0x7f, 0x80, 0xff};
    const size_t head_bytes = (size_t)las_get(bytes + 96, 4) + 8;
    for (size_t at = 0; at < head_bytes; at++)
        for (size_t k = 0; k < sizeof values; k++) {
            const uint8_t kept = bytes[at];
            bytes[at] = values[k];
            load(bytes, size_bytes, NULL);
            bytes[at] = kept;
        }
    // And every byte of the chunks and their table.
    for (size_t at = head_bytes; at < size_bytes; at++) {
        bytes[at] ^= 0x55;
        load(bytes, size_bytes, NULL);
        bytes[at] ^= 0x55;
    }
    free(bytes);
    free(s.bytes);
}

CASE(test_damaged_chunk) {
    las_sample s = las_make(6, 4, 0, 1000, NULL, 0, 0);
    size_t size_bytes;
    uint8_t *bytes = compress(&s, 100, &size_bytes);
    // The sizes of the layers of the fourth chunk follow its first record and its count.
    const uint8_t *fourth = NULL;
    for (size_t i = 0; i + 30 < size_bytes && !fourth; i++)
        if (memcmp(bytes + i, las_record(&s, 300), 30) == 0) fourth = bytes + i;
    assert_non_null(fourth);
    memset(bytes + (fourth - bytes) + 34, 0xff, 16);
    assert_int_equal(load(bytes, size_bytes, NULL), EWA_ERROR_FORMAT);
    assert_non_null(strstr(messages.text, "bad.laz: chunk 4 of 10, at byte "));
    assert_non_null(strstr(messages.text, " of the file: "));
    char path[512];
    scratch_path("damaged.laz", path);
    scratch_write(path, bytes, size_bytes);
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.keep_going = true;
    static const uint64_t sizes[] = {1000, 64, 250};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        OWNED(ewa_cloud_reader_close) ewa_cloud_reader *reader = NULL;
        assert_int_equal(ewa_cloud_reader_open(context, path, &options, &reader), EWA_OK);
        ewa_cloud *piece = NULL;
        uint64_t at = 0;
        while (ewa_cloud_reader_next(reader, sizes[k], &piece) == EWA_OK && piece) {
            for (uint64_t i = 0; i < ewa_cloud_point_count(piece); i++, at++) {
                double wanted;
                las_number(&s, at < 300 ? at : at + 100, "gps_time", 0, &wanted);
                assert_true(las_value(piece, "gps_time", i, 0) == wanted);
            }
            ewa_cloud_destroy(&piece);
        }
        assert_int_equal(at, 900);
        assert_int_equal(ewa_cloud_reader_lost_count(reader), 100);
    }
    remove(path);
    free(bytes);
    free(s.bytes);
}

CASE(test_lies_about_chunks) {
    las_sample s = las_make(6, 4, 0, 100, NULL, 0, 0);
    size_t size_bytes;
    uint8_t *bytes = compress(&s, 30, &size_bytes);
    uint8_t *laz = bytes + 375 + 54, *table_at = bytes + las_get(bytes + 96, 4);
    uint8_t *table = bytes + las_get(table_at, 8);
    const struct {
        uint8_t *at;
        uint64_t value;
        int count;
        const char *said;
    } lies[] = {
        {table + 4, 0xffffffff, 4, "counts 4294967295 chunks"},
        {table + 4, 3, 4, "need 4 chunks, the table has 3"},
        {table, 1, 4, "version 1"},
        {table_at, 1u << 30, 8, "table of chunks, which says where the 100 points are, is missing"},
        {laz, 2, 2, "layered items in chunks without layers"},
        {laz, 9, 2, "compressor 9"},
        {laz + 12, 0, 4, "chunks of 0 points"},
        {laz + 32, 0xffff, 2, "counts 65535 items"},
        {laz + 36, 31, 2, "LASzip's record"},
        {bytes + 105, 31, 2, "not as long together"},
        {bytes + 104, 0x80, 1, "first item"},
        {bytes + 247, UINT64_MAX, 8, "need"},
        {bytes + 104, 11, 1, "point format 11"},
        {bytes + 24, 2, 1, "version 2.4"},
        {bytes + 96, 100, 4, "points are said to begin at byte 100"},
        {bytes + 131, 0, 8, "scale 0"},
        {bytes + 375 + 20, 33, 2, "record of LASzip that says how is missing"},
    };
    for (size_t k = 0; k < sizeof lies / sizeof *lies; k++) {
        uint8_t kept[8];
        memcpy(kept, lies[k].at, 8);
        las_put(lies[k].at, lies[k].value, lies[k].count);
        if (load(bytes, size_bytes, NULL) == EWA_OK) fail_msg("lie %d is believed", (int)k);
        if (!strstr(messages.text, lies[k].said)) fail_msg("lie %d: %s", (int)k, messages.text);
        memcpy(lies[k].at, kept, 8);
    }
    // Where the table is, may stand at the end.
    uint8_t *longer = malloc(size_bytes + 8);
    assert_non_null(longer);
    memcpy(longer, bytes, size_bytes);
    memcpy(longer + size_bytes, table_at, 8);
    memset(longer + (table_at - bytes), 0xff, 8);
    uint64_t count;
    assert_int_equal(load(longer, size_bytes + 8, &count), EWA_OK);
    assert_int_equal(count, 100);
    free(longer);
    free(bytes);
    // No points at all.
    s.count = 0;
    las_put(s.bytes + 247, 0, 8);
    s.size_bytes = s.points_at;
    bytes = compress(&s, 30, &size_bytes);
    assert_int_equal(load(bytes, size_bytes, &count), EWA_OK);
    assert_int_equal(count, 0);
    free(bytes);
    free(s.bytes);
}

CASE(test_pipes) {
    // What cannot be patched is written at once, or not at all.
    las_sample s = las_make(1, 2, 0, 500, NULL, 0, 0);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &s);
    char path[512], got[512];
    for (int compressed = 0; compressed < 2; compressed++) {
        scratch_path(compressed ? "pipe.laz" : "pipe.las", path);
        scratch_path("got.las", got);
        remove(path);
        assert_int_equal(mkfifo(path, 0600), 0);
        char command[1100];
        snprintf(command, sizeof command, "cat '%s' > '%s'", path, got);
        FILE *cat = popen(command, "r");
        assert_non_null(cat);
        assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_OK);
        pclose(cat);
        ewa_cloud *back = NULL;
        assert_int_equal(ewa_cloud_load(context, got, &back), EWA_OK);
        las_compare(cloud, back);
        ewa_cloud_destroy(&back);
        remove(path);
        remove(got);
    }
    free(s.bytes);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
