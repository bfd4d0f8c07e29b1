// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/base: contexts, allocation limits, messages, parallel loops.
#include "base/base.h"
#include "check.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static void keep_text(void *user, ewa_severity severity, const char *text) {
    (void)severity;
    strncpy(user, text, 255);
}

static void test_defaults(void **state) {
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    assert_true(ewa_context_worker_count(context) >= 1);
    ewa_context_destroy(&context);
    assert_null(context);
    ewa_context_destroy(&context);
    ewa_context_destroy(NULL);
}

static void test_bad_options(void **state) {
    ewa_context *context = NULL;
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.thread_count = 100000;
    assert_int_equal(ewa_context_create(&options, &context), EWA_ERROR_ARGUMENT);
    ewa_context_options_init(&options, sizeof options);
    options.struct_size = 3;
    assert_int_equal(ewa_context_create(&options, &context), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_context_create(NULL, NULL), EWA_ERROR_ARGUMENT);
}

static void test_overflowing_allocation_is_a_message(void **state) {
    char text[256] = "";
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.message = keep_text;
    options.message_user = text;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    assert_null(ewa_allocate(context, SIZE_MAX / 2, 16));
    assert_non_null(strstr(text, "address space"));
    ewa_context_destroy(&context);
}

typedef struct tally {
    atomic_uint hits[1000];
    uint32_t workers;
    atomic_uint bad_worker;
} tally;

static void count_hit(void *data, uint32_t index, uint32_t worker) {
    tally *t = data;
    atomic_fetch_add(&t->hits[index], 1);
    if (worker >= t->workers) atomic_fetch_add(&t->bad_worker, 1);
}

static void test_parallel_visits_each_index_once(void **state) {
    static const uint32_t counts[] = {1, 2, 7, 32};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        ewa_context *context = check_context(counts[c], NULL);
        tally *t = calloc(1, sizeof *t);
        t->workers = ewa_context_worker_count(context);
        for (int round = 0; round < 50; round++) ewa_parallel(context, count_hit, t, 1000);
        ewa_parallel(context, count_hit, t, 0);
        for (int i = 0; i < 1000; i++) assert_int_equal(t->hits[i], 50);
        assert_int_equal(t->bad_worker, 0);
        free(t);
        ewa_context_destroy(&context);
    }
}

static void test_split_covers(void **state) {
    for (uint64_t count = 0; count < 40; count++) {
        for (uint32_t parts = 1; parts < 9; parts++) {
            assert_int_equal(ewa_split(count, parts, 0), 0);
            assert_int_equal(ewa_split(count, parts, parts), count);
            for (uint32_t p = 0; p < parts; p++)
                assert_true(ewa_split(count, parts, p) <= ewa_split(count, parts, p + 1));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_bad_options),
        cmocka_unit_test(test_overflowing_allocation_is_a_message),
        cmocka_unit_test(test_parallel_visits_each_index_once),
        cmocka_unit_test(test_split_covers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
