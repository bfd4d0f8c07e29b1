// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The record of surfels that represent others: what is written is read again, and damage is found.
#include "check.h"
#include "io/levels.h"

#include <math.h>

enum { SURFELS = 500, PAGES = 3, TYPES = 8 };

/// Attributes of every type, and numbers of each that are as large and as small as there are.
static const ewa_level_attribute attributes[TYPES] = {{"height", EWA_F32},  {"gps_time", EWA_F64}, {"i8", EWA_I8},   {"classification", EWA_U8},
                                                      {"angle", EWA_I16}, {"intensity", EWA_U16}, {"i32", EWA_I32}, {"u32", EWA_U32}};
static const double ends[TYPES][2] = {{-0x1.8p-100, 0x1.fffffep127}, {-0x1.123456789abcdp-1000, 1.7e308}, {-128, 127}, {0, 255},
                                      {-32768, 32767}, {0, 65535}, {-2147483648.0, 2147483647}, {0, 4294967295.0}};

static size_t table_bytes_of(int version) {
    return EWA_LEVELS_HEAD_BYTES + (version > 2 ? TYPES * EWA_LEVELS_ATTRIBUTE_BYTES : 0) + PAGES * EWA_LEVELS_PAGE_BYTES;
}

/// Number `a` of surfel `i`.
static double number_of(size_t i, size_t a) {
    return i % 3 < 2 ? ends[a][i % 3] : attributes[a].type < EWA_I8 ? 0.5 * (double)i : (double)(i % 100);
}

/// Surfels in memory of their own.
typedef struct sample {
    float at[3 * SURFELS], normal[3 * SURFELS], radius_world[SURFELS], curvature[SURFELS];
    uint8_t rgba[4 * SURFELS];
} sample;

static ewa_level_surfels arrays_of(sample *s, bool curved) {
    return (ewa_level_surfels){s->at, s->normal, s->radius_world, curved ? s->curvature : NULL, s->rgba};
}

static void make_sample(sample *s, uint64_t seed) {
    check_random random = {seed};
    for (size_t i = 0; i < SURFELS; i++) {
        double numbers[3], length = 0;
        check_uniform3(&random, 0, 1, numbers);
        for (size_t c = 0; c < 3; c++) s->at[3 * i + c] = (float)numbers[c];
        check_uniform3(&random, -1, 1, numbers);
        for (size_t c = 0; c < 3; c++) length += numbers[c] * numbers[c];
        for (size_t c = 0; c < 3; c++) s->normal[3 * i + c] = (float)(numbers[c] / sqrt(length));
        s->radius_world[i] = (float)exp(check_uniform(&random, -12, 12));
        s->curvature[i] = i % 3 ? (float)check_uniform(&random, -2, 2) : 0;
        for (size_t c = 0; c < 4; c++) s->rgba[4 * i + c] = (uint8_t)check_random_u64(&random);
    }
    // Along the axes, at the sides.
    for (size_t i = 0; i < 6; i++)
        for (size_t c = 0; c < 3; c++) {
            s->normal[3 * i + c] = c == i / 2 ? (i % 2 ? -1.0f : 1.0f) : 0;
            s->at[3 * i + c] = i % 2 ? 1.0f : 0.0f;
        }
}

static void hold_round_trip(bool curved) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    static sample given, got;
    static uint8_t scratch[18 * SURFELS];
    make_sample(&given, 1);
    memset(&got, 0, sizeof got);
    const ewa_level_surfels from = arrays_of(&given, curved), to = arrays_of(&got, curved);
    ewa_buffer block = {0};
    size_t size_bytes = 0;
    assert_int_equal(ewa_level_encode(context, &from, SURFELS, &block, &size_bytes), EWA_OK);
    assert_int_equal(ewa_level_raw_bytes(SURFELS, curved), (curved ? 18 : 16) * SURFELS);
    const ewa_levels_page page = {.surfel_count = SURFELS, .size_bytes = (uint32_t)size_bytes};
    assert_null(ewa_level_decode(&page, block.data, scratch, &to));
    for (size_t i = 0; i < SURFELS; i++) {
        double cosine = 0, length = 0;
        for (size_t c = 0; c < 3; c++) {
            assert_true(fabsf(given.at[3 * i + c] - got.at[3 * i + c]) <= 0.51f / 65536);
            cosine += (double)given.normal[3 * i + c] * (double)got.normal[3 * i + c];
            length += (double)got.normal[3 * i + c] * (double)got.normal[3 * i + c];
        }
        assert_true(fabs(length - 1) < 1e-5);
        assert_true(cosine > cos(0.001)); // steps of 1/2047
        assert_true(fabsf(got.radius_world[i] / given.radius_world[i] - 1) <= 1.0f / 256);
        assert_true(fabsf(got.curvature[i] - (curved ? given.curvature[i] : 0)) <= fabsf(given.curvature[i]) / 256);
    }
    assert_memory_equal(given.rgba, got.rgba, sizeof given.rgba);
    // Every shorter block is damaged, as is one of another count.
    for (uint32_t left = 0; left < size_bytes; left += 7) {
        const ewa_levels_page cut = {.surfel_count = SURFELS, .size_bytes = left};
        OWNED(check_free) uint8_t *copy = malloc(left + 1);
        assert_non_null(copy);
        memcpy(copy, block.data, left);
        assert_non_null(ewa_level_decode(&cut, copy, scratch, &to));
    }
    const ewa_levels_page fewer = {.surfel_count = SURFELS - 1, .size_bytes = (uint32_t)size_bytes};
    assert_non_null(ewa_level_decode(&fewer, block.data, scratch, &to));
    ewa_buffer_free(context, &block);
}

TEST(test_round_trip) {
    for (int curved = 0; curved < 2; curved++) hold_round_trip(curved);
}

/// A record of a root, a divided part of it and one that is not; the caller frees. Version 1 has no curvatures, 3 attributes.
static uint8_t *make_record(ewa_context *context, int version, size_t *size_bytes) {
    static sample given;
    static double numbers[SURFELS * TYPES];
    const bool curved = version > 1;
    const uint32_t attribute_count = version > 2 ? TYPES : 0;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) numbers[i] = number_of(i / TYPES, i % TYPES);
    ewa_levels_page pages[PAGES] = {
        {.key = {0, {0, 0, 0}}, .point_count = 900, .radius_scale = 1, .error = 3, .unit_coverage = 2},
        {.key = {1, {0, 1, 0}}, .point_count = 700, .radius_scale = 0.75f, .error = 1.5f},
        {.key = {1, {1, 1, 1}}, .point_count = 200, .radius_scale = 1},
    };
    ewa_buffer blocks = {0};
    size_t at_bytes = 0;
    for (uint32_t i = 0; i < 2; i++) {
        make_sample(&given, i);
        const ewa_level_surfels from = arrays_of(&given, curved);
        pages[i].at_bytes = at_bytes;
        pages[i].surfel_count = 10 * (i + 1);
        pages[i].largest_radius_world = 0.5f;
        assert_int_equal(ewa_level_encode(context, &from, pages[i].surfel_count, &blocks, &at_bytes), EWA_OK);
        pages[i].size_bytes = (uint32_t)(at_bytes - pages[i].at_bytes);
        assert_int_equal(ewa_level_encode_attributes(context, attributes, attribute_count, numbers, pages[i].surfel_count,
                                                     &blocks, &at_bytes), EWA_OK);
        pages[i].attributes_bytes = (uint32_t)(at_bytes - pages[i].at_bytes) - pages[i].size_bytes;
        assert_true((pages[i].attributes_bytes > 0) == (version > 2));
    }
    ewa_levels levels = {.unit_coverage = 1.5, .pages = pages, .page_count = PAGES, .surfel_count = 30, .has_curvatures = curved,
                         .attribute_count = attribute_count};
    memcpy(levels.attributes, attributes, attribute_count * sizeof attributes[0]);
    const size_t table_bytes = table_bytes_of(version);
    *size_bytes = table_bytes + at_bytes;
    uint8_t *bytes = malloc(*size_bytes);
    assert_non_null(bytes);
    ewa_levels_write(&levels, bytes);
    assert_int_equal(ewa_levels_table_bytes(bytes, *size_bytes), table_bytes);
    memcpy(bytes + table_bytes, blocks.data, at_bytes);
    ewa_buffer_free(context, &blocks);
    return bytes;
}

/// Decodes a page's attributes into memory that ends with them; what is wrong, NULL: they are `numbers`.
static const char *decode_attributes(const ewa_levels *levels, const ewa_levels_page *page, const uint8_t *record, bool known) {
    const size_t count = page->surfel_count, raw_bytes = ewa_level_attribute_bytes(levels, page->surfel_count);
    OWNED(check_free) uint8_t *scratch = malloc(raw_bytes + 1);
    void *streams[EWA_LEVELS_MAX_ATTRIBUTES] = {NULL};
    for (uint32_t a = 0; a < levels->attribute_count; a++) // one that nobody wants
        streams[a] = a == 2 ? NULL : malloc(count * ewa_type_bytes(levels->attributes[a].type) + 1);
    const char *fault = ewa_level_decode_attributes(levels, page, record + page->at_bytes + page->size_bytes, scratch, streams);
    for (uint32_t a = 0; a < levels->attribute_count; a++) {
        ewa_attribute read = {.type = levels->attributes[a].type, .component_count = 1, .data = streams[a]};
        read.stride_bytes = ewa_type_bytes(read.type);
        for (size_t i = 0; known && !fault && streams[a] && i < count; i++) {
            double number;
            ewa_attribute_read_f64(&read, i, 1, &number);
            assert_true(number == (read.type == EWA_F32 ? (double)(float)number_of(i, a) : number_of(i, a)));
        }
        free(streams[a]);
    }
    return fault;
}

/// Reads bytes from memory that ends with them; what is read can be used.
static ewa_status read_record(ewa_context *context, const uint8_t *bytes, size_t size_bytes) {
    OWNED(check_free) uint8_t *copy = malloc(size_bytes + !size_bytes);
    assert_non_null(copy);
    memcpy(copy, bytes, size_bytes);
    ewa_levels levels;
    const ewa_status status = ewa_levels_read(context, "test", copy, size_bytes, &levels);
    for (uint32_t i = 0; status == EWA_OK && i < levels.page_count; i++) {
        const ewa_levels_page *page = &levels.pages[i];
        assert_true(i == 0 || ewa_octree_key_compare(&page[-1].key, &page->key) < 0);
        assert_true(page->at_bytes <= size_bytes && page->size_bytes <= size_bytes - page->at_bytes);
        assert_true(page->radius_scale > 0 && page->error >= 0 && page->largest_radius_world >= 0);
        if (!page->size_bytes || page->surfel_count > SURFELS) continue;
        static sample got;
        static uint8_t scratch[18 * SURFELS];
        const ewa_level_surfels to = arrays_of(&got, levels.has_curvatures);
        (void)ewa_level_decode(page, copy + page->at_bytes, scratch, &to);
        assert_true(page->attributes_bytes <= size_bytes - page->at_bytes - page->size_bytes);
        (void)decode_attributes(&levels, page, copy, false);
    }
    ewa_levels_free(context, &levels);
    return status;
}

static void hold_record(int version) {
    const bool curved = version > 1;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = make_record(context, version, &size_bytes);
    ewa_levels levels;
    assert_int_equal(ewa_levels_read(context, "test", bytes, size_bytes, &levels), EWA_OK);
    assert_int_equal(levels.page_count, PAGES);
    assert_int_equal(levels.surfel_count, 30);
    assert_int_equal(bytes[4], version);
    assert_int_equal(levels.attribute_count, version > 2 ? TYPES : 0);
    for (int i = 0; i < 2 && version > 2; i++) assert_null(decode_attributes(&levels, &levels.pages[i], bytes, true));
    assert_true(levels.has_curvatures == curved);
    assert_true(levels.unit_coverage == 1.5);
    assert_int_equal(levels.pages[0].point_count, 900);
    assert_true(levels.pages[0].unit_coverage == 2 && levels.pages[0].error == 3);
    assert_int_equal(levels.pages[1].key.cell[1], 1);
    assert_true(levels.pages[1].radius_scale == 0.75f && levels.pages[1].largest_radius_world == 0.5f);
    assert_int_equal(levels.pages[2].size_bytes, 0);
    static sample given, got;
    static uint8_t scratch[18 * SURFELS];
    const ewa_level_surfels to = arrays_of(&got, curved);
    make_sample(&given, 1);
    assert_null(ewa_level_decode(&levels.pages[1], bytes + levels.pages[1].at_bytes, scratch, &to));
    assert_memory_equal(given.rgba, got.rgba, (size_t)4 * levels.pages[1].surfel_count);
    ewa_levels_free(context, &levels);
}

TEST(test_record) {
    for (int version = 1; version <= 3; version++) hold_record(version);
}

TEST_ON(test_damage, 1) {
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = make_record(context, 3, &size_bytes);
    const size_t table_bytes = table_bytes_of(3);
    // Whatever is cut off, a page's block is not whole.
    for (size_t left = 0; left < size_bytes; left++)
        assert_int_equal(read_record(context, bytes, left), EWA_ERROR_FORMAT);
    int refused = 0;
    for (size_t at = 0; at < table_bytes; at++)
        for (int bit = 0; bit < 8; bit++) {
            bytes[at] ^= (uint8_t)(1 << bit);
            refused += read_record(context, bytes, size_bytes) != EWA_OK;
            bytes[at] ^= (uint8_t)(1 << bit);
        }
    assert_true(refused > 500);
    for (size_t at = table_bytes; at < size_bytes; at++) {
        bytes[at] ^= 0x55;
        assert_int_equal(read_record(context, bytes, size_bytes), EWA_OK);
        bytes[at] ^= 0x55;
    }
}

/// Reads a record in which `size_bytes` bytes at a place are others.
static ewa_status read_with(ewa_context *context, const uint8_t *bytes, size_t record_bytes, size_t at,
                            const void *other, size_t size_bytes) {
    uint8_t *copy = malloc(record_bytes);
    assert_non_null(copy);
    memcpy(copy, bytes, record_bytes);
    memcpy(copy + at, other, size_bytes);
    const ewa_status status = read_record(context, copy, record_bytes);
    free(copy);
    return status;
}

TEST(test_refusals) {
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = make_record(context, 3, &size_bytes);
    static const uint8_t version[4] = {4}, zero[4] = {0}, many[4] = {1, 0, 0, 1},
                         minus[4] = {255, 255, 255, 255};
    static const uint8_t nan[4] = {0, 0, 0xc0, 0x7f}, two[4] = {2}, deep[4] = {31};
    enum {
        FIRST = EWA_LEVELS_HEAD_BYTES,
        SECOND = FIRST + EWA_LEVELS_ATTRIBUTE_BYTES,
        ROOT = FIRST + TYPES * EWA_LEVELS_ATTRIBUTE_BYTES,
        PART = ROOT + EWA_LEVELS_PAGE_BYTES,
        LEAF = PART + EWA_LEVELS_PAGE_BYTES
    };
    assert_int_equal(read_with(context, bytes, size_bytes, 4, version, 4), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "version 4"));
    static const struct {
        size_t at;
        const uint8_t *bytes;
        const char *said;
    } wrong[] = {
        {0, zero, "no head"},
        {8, many, "its head"},
        {12, many, "its head"},
        {12, minus, "its head"},
        {FIRST, zero, "comes twice"}, // no name
        {FIRST + EWA_NAME_BYTES, many, "an attribute"},
        {ROOT + 48, zero, "no part of one that is divided"}, // the root has no block: it is not divided
        {LEAF, two, "no part of one that is divided"},       // no parent
        {LEAF + 4, two, "no node"},
        {LEAF + 4, minus, "no node"},
        {LEAF, deep, "level"},
        {LEAF, minus, "level"},
        {PART + 24, many, "too many"},
        {PART + 28, nan, "out of range"},
        {PART + 28, zero, "out of range"},
        {PART + 32, nan, "out of range"},
        {PART + 36, nan, "out of range"},
        {PART + 52, nan, "out of range"},
        {PART + 44, minus, "beyond"},
        {PART + 48, minus, "beyond"},
        {PART + 56, minus, "beyond"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        log = (check_log){0};
        assert_int_equal(read_with(context, bytes, size_bytes, wrong[i].at, wrong[i].bytes, 4),
                         EWA_ERROR_FORMAT);
        if (!strstr(log.text, wrong[i].said)) fail_msg("%s: no '%s'", log.text, wrong[i].said);
    }
    assert_int_equal(read_with(context, bytes, size_bytes, LEAF, bytes + PART, 16), EWA_ERROR_FORMAT);
    assert_non_null(strstr(log.text, "twice"));
    // A name that surfels have anyhow, that of another attribute, and one without an end.
    static const char *const taken[] = {"position", "color", "radius", "normal", "signed_curvature", "gps_time"};
    for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++)
        assert_int_equal(read_with(context, bytes, size_bytes, FIRST, taken[i], strlen(taken[i]) + 1), EWA_ERROR_FORMAT);
    uint8_t endless[EWA_NAME_BYTES];
    memset(endless, 'a', sizeof endless);
    assert_int_equal(read_with(context, bytes, size_bytes, SECOND, endless, sizeof endless), EWA_ERROR_FORMAT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
