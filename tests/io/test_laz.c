// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Chunks of LAZ: what LASzip and laz-rs write is what we write and read, every kind of records comes back, and
// damaged chunks are told of.
#include "io/las/laz.h"

#include "check.h"
#include "io/laz_facts.h"
#include "io/laz_sample.h"

static ewa_context *context;

static int begin(void **state) {
    context = check_context(1, NULL);
    return 0;
}

static int end(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

static const uint32_t CORE_BYTES[11] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// A plan for a format with further bytes.
static ewa_laz_plan plan_of(uint8_t format, uint32_t extra_bytes) {
    ewa_laz_plan plan;
    ewa_laz_plan_make(format, CORE_BYTES[format] + extra_bytes, &plan);
    assert_null(ewa_laz_plan_check(&plan));
    assert_int_equal(plan.record_bytes, CORE_BYTES[format] + extra_bytes);
    assert_int_equal(plan.layered, format > 5);
    return plan;
}

/// A chunk and the records in it.
typedef struct chunk {
    ewa_laz_plan plan;
    uint32_t point_count;
    uint8_t *records, *decoded;
    ewa_buffer bytes;
    size_t size_bytes;
    ewa_laz_memory *encoder, *decoder;
} chunk;

static chunk chunk_make(ewa_laz_plan plan, laz_sample_kind kind, uint8_t format, uint32_t point_count) {
    chunk c = {.plan = plan, .point_count = point_count};
    c.records = calloc(point_count + 1, plan.record_bytes);
    c.decoded = calloc(point_count + 1, plan.record_bytes);
    assert_true(c.records && c.decoded);
    laz_sample(kind, format, plan.record_bytes, point_count, 7u * format + point_count, c.records);
    assert_int_equal(
        ewa_laz_encode(context, &plan, c.records, point_count, &c.bytes, &c.size_bytes, &c.encoder), EWA_OK);
    return c;
}

static void chunk_free(chunk *c) {
    free(c->records);
    free(c->decoded);
    ewa_buffer_free(context, &c->bytes);
    ewa_laz_memory_free(context, &c->encoder);
    ewa_laz_memory_free(context, &c->decoder);
}

/// Decodes bytes from a block of exactly their size, so that a sanitizer sees what is read beyond.
static ewa_laz_result decode(chunk *c, const uint8_t *bytes, size_t size_bytes, uint64_t point_count) {
    ewa_laz_result result;
    uint8_t *copy = malloc(size_bytes + !size_bytes);
    if (size_bytes) memcpy(copy, bytes, size_bytes);
    assert_int_equal(
        ewa_laz_decode(context, &c->plan, copy, size_bytes, point_count, c->decoded, &c->decoder, &result),
        EWA_OK);
    free(copy);
    assert_true(result.point_count <= point_count);
    assert_true(result.point_count == point_count || result.fault);
    return result;
}

static void check_back(chunk *c) {
    const ewa_laz_result result = decode(c, c->bytes.data, c->size_bytes, c->point_count);
    if (result.fault)
        fail_msg("%s, after %u of %u points", result.fault, (unsigned)result.point_count, c->point_count);
    assert_memory_equal(c->decoded, c->records, (size_t)c->point_count * c->plan.record_bytes);
}

TEST(test_facts) {
    for (size_t i = 0; i < sizeof laz_fact_chunks / sizeof laz_fact_chunks[0]; i++) {
        const uint8_t format = laz_fact_chunks[i].point_format;
        const uint32_t record_bytes = laz_fact_chunks[i].record_bytes;
        OWNED(chunk_free)
        chunk c = chunk_make(plan_of(format, record_bytes - CORE_BYTES[format]), LAZ_SAMPLE_CONSTANT, format,
                             LAZ_FACT_RECORDS);
        for (uint32_t k = 0; k < LAZ_FACT_RECORDS; k++)
            for (uint32_t j = 0; j < record_bytes; j++) c.records[k * record_bytes + j] = laz_fact_byte(k, j);
        c.size_bytes = 0;
        assert_int_equal(
            ewa_laz_encode(context, &c.plan, c.records, c.point_count, &c.bytes, &c.size_bytes, &c.encoder),
            EWA_OK);
        assert_int_equal(c.size_bytes, laz_fact_chunks[i].size_bytes);
        assert_memory_equal(c.bytes.data, laz_fact_chunks[i].bytes, c.size_bytes);
        check_back(&c);
    }
}

TEST(test_long_facts) {
    for (size_t i = 0; i < sizeof laz_fact_long_chunks / sizeof laz_fact_long_chunks[0]; i++) {
        const uint8_t format = laz_fact_long_chunks[i].point_format;
        const uint32_t record_bytes = CORE_BYTES[format];
        OWNED(chunk_free) chunk c = chunk_make(plan_of(format, 0), LAZ_SAMPLE_CONSTANT, format, LAZ_FACT_LONG_RECORDS);
        for (uint32_t k = 0; k < LAZ_FACT_LONG_RECORDS; k++)
            for (uint32_t j = 0; j < record_bytes; j++) c.records[k * record_bytes + j] = laz_fact_mixed_byte(k, j);
        c.size_bytes = 0;
        assert_int_equal(
            ewa_laz_encode(context, &c.plan, c.records, c.point_count, &c.bytes, &c.size_bytes, &c.encoder), EWA_OK);
        uint64_t sum = 0xcbf29ce484222325u;
        for (size_t b = 0; b < c.size_bytes; b++) sum = (sum ^ ((const uint8_t *)c.bytes.data)[b]) * 0x100000001b3u;
        assert_int_equal(c.size_bytes, laz_fact_long_chunks[i].size_bytes);
        assert_true(sum == laz_fact_long_chunks[i].sum);
        check_back(&c);
    }
}

TEST(test_round_trips) {
    static const uint32_t COUNTS[] = {1, 2, 3, 1000};
    for (uint8_t format = 0; format < 11; format++)
        for (int kind = 0; kind < LAZ_SAMPLE_KIND_COUNT; kind++)
            for (int i = 0; i < 4; i++)
                for (uint16_t version = 3; version < (format < 6 ? 4 : 5); version++) {
                    ewa_laz_plan plan = plan_of(format, i * (uint32_t)kind);
                    for (uint32_t k = 0; plan.layered && k < plan.item_count; k++)
                        plan.items[k].version = version;
                    assert_null(ewa_laz_plan_check(&plan));
                    OWNED(chunk_free) chunk c = chunk_make(plan, (laz_sample_kind)kind, format, COUNTS[i]);
                    check_back(&c);
                    check_back(&c); // the memory of the first one is as good as new
                }
}

TEST(test_no_points) {
    OWNED(chunk_free) chunk c = chunk_make(plan_of(3, 0), LAZ_SAMPLE_SMOOTH, 3, 0);
    assert_int_equal(c.size_bytes, 0);
    assert_null(decode(&c, NULL, 0, 0).fault);
    assert_non_null(decode(&c, NULL, 0, 1).fault);
}

TEST(test_constant_is_small) {
    for (uint8_t format = 0; format < 11; format++) {
        OWNED(chunk_free) chunk c = chunk_make(plan_of(format, 0), LAZ_SAMPLE_CONSTANT, format, 5000);
        if (c.size_bytes > 1000) fail_msg("format %d: %u bytes", format, (unsigned)c.size_bytes);
    }
}

TEST(test_truncations) {
    for (uint8_t format = 0; format < 11; format++) {
        OWNED(chunk_free) chunk c = chunk_make(plan_of(format, 2), LAZ_SAMPLE_JUMPS, format, 20);
        const uint32_t record_bytes = c.plan.record_bytes;
        for (size_t size = 0; size < c.size_bytes; size++) {
            const ewa_laz_result result = decode(&c, c.bytes.data, size, c.point_count);
            assert_non_null(result.fault);
            assert_true(result.point_count < c.point_count);
            assert_memory_equal(c.decoded, c.records, (size_t)result.point_count * record_bytes);
        }
        const ewa_laz_result more = decode(&c, c.bytes.data, c.size_bytes, c.point_count - 1);
        assert_non_null(more.fault); // the chunk holds another point
    }
}

TEST(test_changes) {
    static const uint8_t CHANGES[] = {1, 0x80, 0xFF};
    for (uint8_t format = 0; format < 11; format++) {
        uint64_t told = 0, tried = 0;
        OWNED(chunk_free) chunk c = chunk_make(plan_of(format, 1), LAZ_SAMPLE_JUMPS, format, 12);
        uint8_t *bytes = c.bytes.data;
        for (size_t i = c.plan.record_bytes; i < c.size_bytes; i++)
            for (int k = 0; k < 3; k++) {
                bytes[i] ^= CHANGES[k];
                told += decode(&c, bytes, c.size_bytes, c.point_count).fault != NULL;
                tried++;
                bytes[i] ^= CHANGES[k];
            }
        if (told * 10 < tried * 7)
            fail_msg("format %d: only %u of %u changes were told of", format, (unsigned)told,
                     (unsigned)tried);
        check_back(&c);
    }
}

TEST(test_layers) {
    OWNED(chunk_free) chunk c = chunk_make(plan_of(7, 1), LAZ_SAMPLE_SMOOTH, 7, 50);
    uint8_t *bytes = c.bytes.data, *count = bytes + c.plan.record_bytes, *sizes = count + 4;
    laz_sample_put(count, 51, 4);
    assert_non_null(decode(&c, bytes, c.size_bytes, 50).fault);
    laz_sample_put(count, 20, 4);
    const ewa_laz_result fewer = decode(&c, bytes, c.size_bytes, 50);
    assert_non_null(fewer.fault);
    assert_int_equal(fewer.point_count, 20);
    laz_sample_put(count, 50, 4);
    check_back(&c);
    // A layer without bytes, whatever the symbols say; then none has any.
    for (uint32_t layer = 0; layer < 11; layer++) {
        const uint32_t before = sizes[4 * layer] | (uint32_t)sizes[4 * layer + 1] << 8;
        laz_sample_put(sizes + 4 * layer, 0, 4);
        const ewa_laz_result result = decode(&c, bytes, c.size_bytes - before, 50);
        if (layer == 0) assert_int_equal(result.point_count, 1);
        laz_sample_put(sizes + 4 * layer, 0xFFFFFFFF, 4);
        assert_int_equal(decode(&c, bytes, c.size_bytes, 50).point_count, 1);
        laz_sample_put(sizes + 4 * layer, before, 4);
    }
    memset(sizes, 0, 11 * 4);
    assert_int_equal(decode(&c, bytes, c.plan.record_bytes + 4 + 11 * 4, 50).point_count, 1);
}

TEST(test_plans) {
    static const struct {
        ewa_laz_item items[3];
        uint32_t item_count;
        bool good;
    } PLANS[] = {
        {{{EWA_LAZ_POINT10, 20, 2}}, 1, true},
        {{{EWA_LAZ_POINT10, 20, 1}, {EWA_LAZ_GPSTIME11, 8, 2}, {EWA_LAZ_BYTE, 8192, 2}}, 3, true},
        {{{EWA_LAZ_POINT14, 30, 4}, {EWA_LAZ_RGB14, 6, 3}, {EWA_LAZ_BYTE14, 1, 3}}, 3, true},
        {{{EWA_LAZ_POINT10, 20, 2}}, 0, false},
        {{{EWA_LAZ_POINT10, 20, 2}}, EWA_LAZ_MAX_ITEMS + 1, false},
        {{{EWA_LAZ_POINT10, 21, 2}}, 1, false},
        {{{EWA_LAZ_POINT10, 20, 0}}, 1, false},
        {{{EWA_LAZ_POINT10, 20, 3}}, 1, false},
        {{{EWA_LAZ_POINT14, 30, 2}}, 1, false},
        {{{EWA_LAZ_GPSTIME11, 8, 2}, {EWA_LAZ_POINT10, 20, 2}}, 2, false},
        {{{EWA_LAZ_POINT10, 20, 2}, {EWA_LAZ_POINT10, 20, 2}}, 2, false},
        {{{EWA_LAZ_POINT10, 20, 2}, {EWA_LAZ_RGB14, 6, 3}}, 2, false},
        {{{EWA_LAZ_POINT14, 30, 3}, {EWA_LAZ_GPSTIME11, 8, 2}}, 2, false},
        {{{EWA_LAZ_POINT10, 20, 2}, {EWA_LAZ_BYTE, 0, 2}}, 2, false},
        {{{EWA_LAZ_POINT10, 20, 2}, {EWA_LAZ_BYTE, 8193, 2}}, 2, false},
        {{{EWA_LAZ_POINT10, 20, 2}, {1, 4, 2}}, 2, false},
        {{{EWA_LAZ_POINT10, 20, 2}, {99, 4, 2}}, 2, false},
    };
    for (size_t i = 0; i < sizeof PLANS / sizeof PLANS[0]; i++) {
        ewa_laz_plan plan = {.item_count = PLANS[i].item_count};
        memcpy(plan.items, PLANS[i].items, sizeof PLANS[i].items);
        const char *fault = ewa_laz_plan_check(&plan);
        if ((fault == NULL) != PLANS[i].good) fail_msg("plan %d: %s", (int)i, fault ? fault : "accepted");
    }
    ewa_laz_plan plan;
    ewa_laz_plan_make(11, 30, &plan);
    assert_non_null(ewa_laz_plan_check(&plan));
}

static void check_table(const uint64_t (*chunks)[2], uint32_t count, bool variable, const uint8_t *fact,
                        size_t fact_bytes) {
    ewa_laz_chunk *in = calloc(count + 1, sizeof *in), *out = calloc(count + 1, sizeof *out);
    for (uint32_t i = 0; i < count; i++) in[i] = (ewa_laz_chunk){chunks[i][0], chunks[i][1]};
    ewa_buffer bytes = {0};
    size_t size_bytes = 0;
    assert_int_equal(ewa_laz_table_encode(context, in, count, variable, &bytes, &size_bytes), EWA_OK);
    if (fact) {
        assert_int_equal(size_bytes, fact_bytes);
        assert_memory_equal(bytes.data, fact, fact_bytes);
    }
    const uint8_t *body = (const uint8_t *)bytes.data + 8;
    for (size_t size = 0; count > 0 && size < size_bytes - 8; size++)
        assert_non_null(ewa_laz_table_decode(body, size, count, variable, out));
    assert_null(ewa_laz_table_decode(body, size_bytes - 8, count, variable, out));
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(out[i].size_bytes, in[i].size_bytes);
        if (variable) assert_int_equal(out[i].point_count, in[i].point_count);
    }
    ewa_buffer_free(context, &bytes);
    free(in);
    free(out);
}

TEST(test_tables) {
    const uint32_t count = sizeof laz_fact_table / sizeof laz_fact_table[0];
    check_table(laz_fact_table, count, false, laz_fact_table_fixed, sizeof laz_fact_table_fixed);
    check_table(laz_fact_table, count, true, laz_fact_table_variable, sizeof laz_fact_table_variable);
    check_table(NULL, 0, false, NULL, 0);
    enum { MANY = 300 };
    uint64_t chunks[MANY][2], seed = 1;
    for (int i = 0; i < MANY; i++) {
        chunks[i][0] = laz_sample_random(&seed) >> (i % 31);
        chunks[i][1] = laz_sample_random(&seed) * 2u + 1;
    }
    check_table((const uint64_t(*)[2])chunks, MANY, true, NULL, 0);
}

/// One memory for several plans, as a program has it that reads one file after the other.
TEST(test_memory) {
    ewa_laz_memory *memory = NULL;
    for (int turn = 0; turn < 4; turn++) {
        const uint8_t format = turn % 2 ? 3 : 7;
        OWNED(chunk_free) chunk c = chunk_make(plan_of(format, 0), LAZ_SAMPLE_SMOOTH, format, 100);
        c.decoder = memory;
        check_back(&c);
        memory = c.decoder;
        c.decoder = NULL;
    }
    ewa_laz_memory_free(context, &memory);
    ewa_laz_memory_free(context, &memory);
}

TEST(test_allocations_fail) {
    for (uint8_t format = 3; format < 8; format += 4) {
        long calls = 0;
        for (ewa_status status = EWA_ERROR_MEMORY; status != EWA_OK; calls++) {
            check_memory memory = {.calls_left = calls + 1000};
            ewa_context *poor = check_context_on(1, &memory);
            const ewa_laz_plan plan = plan_of(format, 0);
            enum { COUNT = 400 };
            uint8_t *records = calloc(COUNT, plan.record_bytes);
            laz_sample(LAZ_SAMPLE_RANDOM, format, plan.record_bytes, COUNT, 1, records);
            ewa_buffer bytes = {0};
            size_t size_bytes = 0;
            ewa_laz_memory *worker = NULL;
            memory.calls_left = calls;
            status = ewa_laz_encode(poor, &plan, records, COUNT, &bytes, &size_bytes, &worker);
            assert_true(status == EWA_OK || status == EWA_ERROR_MEMORY);
            memory.calls_left = -1;
            ewa_laz_memory_free(poor, &worker);
            ewa_buffer_free(poor, &bytes);
            free(records);
            ewa_context_destroy(&poor);
            assert_int_equal(memory.held_bytes, 0);
        }
        assert_true(calls > 2);
    }
}

int main(void) { return RUN_TESTS(begin, end); }
