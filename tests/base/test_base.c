// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/base: contexts, allocation limits, messages, parallel loops.
#include "base/base.h"
#include "check.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static void keep_text(void *user, ewa_severity severity, const char *text) {
    (void)severity;
    strncpy(user, text, 255);
}

TEST(test_defaults) {
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    assert_true(ewa_context_worker_count(context) >= 1);
    ewa_context_destroy(&context);
    assert_null(context);
    ewa_context_destroy(&context);
    ewa_context_destroy(NULL);
}

TEST(test_bad_options) {
    ewa_context *context = NULL;
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 100000;
    assert_int_equal(ewa_context_create(&options, &context), EWA_ERROR_ARGUMENT);
    ewa_context_options_init(&options, sizeof options);
    options.struct_size = 3;
    assert_int_equal(ewa_context_create(&options, &context), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_context_create(NULL, NULL), EWA_ERROR_ARGUMENT);
}

TEST(test_overflowing_allocation_is_a_message) {
    char text[256] = "";
    WITH_DEFAULTS(ewa_context_options, options);
    options.message = keep_text;
    options.message_user = text;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    assert_null(ewa_allocate(context, SIZE_MAX / 2, 16));
    assert_non_null(strstr(text, "address space"));
}

static ewa_context *limited(const ewa_limits *limits, bool untrusted, char text[256]) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.limits = *limits;
    options.untrusted = untrusted;
    options.message = keep_text;
    options.message_user = text;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

/// One budget for blocks, buffers and what libraries take: what is given back can be had again.
TEST(test_memory_is_counted) {
    char text[256] = "";
    OWNED(ewa_context_destroy) ewa_context *context = limited(&(ewa_limits){.max_memory_bytes = 1000}, false, text);
    assert_int_equal(ewa_memory_left(context), 1000);
    void *first = ewa_allocate(context, 6, 100), *none = ewa_allocate(context, 401, 1);
    assert_non_null(first);
    assert_null(none);
    assert_string_equal(text, "out of memory: 401 bytes are needed, 400 of max_memory_bytes 1000 are left");
    void *second = ewa_allocate_zeroed(context, 400, 1);
    assert_non_null(second);
    assert_int_equal(ewa_memory_left(context), 0);
    assert_int_equal(ewa_memory_check(context, 0, "nothing"), EWA_OK);
    assert_int_equal(ewa_memory_check(context, 1, "a.png: PNG of %u x %u pixels", 2u, 3u), EWA_ERROR_LIMIT);
    assert_string_equal(text, "a.png: PNG of 2 x 3 pixels: 1 bytes are needed, 0 of max_memory_bytes 1000 are left");
    ewa_release(context, first, 600, 1);
    assert_int_equal(ewa_memory_take(context, 500, "a library"), EWA_OK);
    assert_int_equal(ewa_memory_take(context, 101, "a library"), EWA_ERROR_LIMIT);
    assert_int_equal(ewa_memory_take(context, UINT64_MAX, "a library"), EWA_ERROR_LIMIT);
    ewa_memory_give(context, 500);
    ewa_release(context, second, 400, 1);
    ewa_buffer buffer = {0};
    assert_int_equal(ewa_buffer_reserve(context, &buffer, 1001, 1), EWA_ERROR_MEMORY);
    assert_int_equal(ewa_buffer_reserve(context, &buffer, 900, 1), EWA_OK);
    assert_int_equal(ewa_memory_left(context), 100);
    ewa_buffer_free(context, &buffer);
    assert_int_equal(ewa_memory_left(context), 1000);
    void *empty = ewa_allocate(context, 0, 8); // which is one byte
    assert_int_equal(ewa_memory_left(context), 999);
    ewa_release(context, empty, 0, 8);
    assert_int_equal(ewa_memory_left(context), 1000);
}

TEST(test_limits) {
    char text[256] = "";
    OWNED(ewa_context_destroy) ewa_context *context = limited(&(ewa_limits){0}, false, text);
    const ewa_limits usual = *ewa_context_limits(context);
    assert_int_equal(usual.max_points, 4294967279u);
    assert_int_equal(usual.max_image_side, 65536);
    assert_int_equal(ewa_context_named_files(context), EWA_NAMED_BELOW);
    ewa_context_destroy(&context);
    context = limited(&(ewa_limits){.max_image_side = 20000}, true, text);
    const ewa_limits small = *ewa_context_limits(context);
    assert_int_equal(small.max_points, 1 << 26);
    assert_int_equal(small.max_image_side, 20000); // what is set stays
    assert_true(small.max_memory_bytes <= 1 << 30 && small.max_memory_bytes <= usual.max_memory_bytes);
    assert_int_equal(ewa_context_named_files(context), EWA_NAMED_NONE);
    ewa_context_destroy(&context);
    WITH_DEFAULTS(ewa_context_options, options);
    options.limits.max_seconds = -1;
    assert_int_equal(ewa_context_create(&options, &context), EWA_ERROR_ARGUMENT);
    // The struct of a header without the last members.
    ewa_context_options_init(&options, offsetof(ewa_context_options, limits.max_seconds));
    options.limits.max_image_side = 77;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    assert_int_equal(ewa_context_limits(context)->max_image_side, 77);
}

static void wait_a_little(void *data, uint32_t index, uint32_t worker) {
    (void)index, (void)worker;
    const double end_s = ewa_now_s() + 0.01;
    while (ewa_now_s() < end_s) {}
    atomic_fetch_add((atomic_uint *)data, 1);
}

TEST(test_time_is_over) {
    char text[256] = "";
    OWNED(ewa_context_destroy) ewa_context *context = limited(&(ewa_limits){.max_seconds = 0.05}, false, text);
    atomic_uint done = 0;
    assert_int_equal(ewa_progress(context, "begin", 0), EWA_OK);
    assert_int_equal(ewa_parallel_stoppable(context, "wait", wait_a_little, &done, 1000), EWA_CANCELLED);
    assert_true(atomic_load(&done) > 0 && atomic_load(&done) < 100);
    assert_string_equal(text, "0.05 s are over (max_seconds)");
    text[0] = 0;
    assert_int_equal(ewa_progress(context, "further", 0), EWA_CANCELLED);
    assert_string_equal(text, ""); // said once
}

/// A run of tasks that go on until they are told not to, and a callback that stops it once all have begun.
typedef struct endless {
    ewa_context *context;
    atomic_uint begun, told;
    uint32_t count, asked;
} endless;

static bool stop_when_all_run(void *user, const char *stage, double fraction) {
    endless *run = user;
    (void)stage, (void)fraction;
    if (atomic_load(&run->begun) < run->count) return true;
    return ++run->asked != 3; // said once
}

static void run_until_told(void *data, uint32_t index, uint32_t worker) {
    endless *run = data;
    (void)index;
    atomic_fetch_add(&run->begun, 1);
    const double end_s = ewa_now_s() + 10; // a run that nobody stops fails, rather than hang
    while (ewa_now_s() < end_s)
        if (!ewa_goes_on(run->context, worker)) {
            atomic_fetch_add(&run->told, 1);
            return;
        }
}

/// Long tasks hear of a stop while they run, on the thread that is asked and on the others.
TEST(test_long_tasks_are_stopped) {
    for (uint32_t workers = 1; workers <= 3; workers++) {
        endless run = {.count = workers};
        WITH_DEFAULTS(ewa_context_options, options);
        options.thread_count = workers;
        options.progress = stop_when_all_run;
        options.progress_user = &run;
        assert_int_equal(ewa_context_create(&options, &run.context), EWA_OK);
        assert_true(ewa_goes_on(run.context, 0)); // of no run
        assert_int_equal(ewa_parallel_stoppable(run.context, "wait", run_until_told, &run, workers),
                         EWA_CANCELLED);
        assert_int_equal(atomic_load(&run.told), workers);
        assert_true(ewa_goes_on(run.context, 0));
        ewa_context_destroy(&run.context);
    }
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

TEST(test_parallel_visits_each_index_once) {
    static const uint32_t counts[] = {1, 2, 7, 32};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(counts[c], NULL);
        OWNED(check_free) tally *t = calloc(1, sizeof *t);
        t->workers = ewa_context_worker_count(context);
        for (int round = 0; round < 50; round++) ewa_parallel(context, count_hit, t, 1000);
        ewa_parallel(context, count_hit, t, 0);
        for (int i = 0; i < 1000; i++) assert_int_equal(t->hits[i], 50);
        assert_int_equal(t->bad_worker, 0);
    }
}

/// A run in a task of a run, and two threads' runs by one context: each is whole, and none waits for the other for ever.
typedef struct nested_run {
    ewa_context *context;
    tally inner[64];
} nested_run;

static void run_inner(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    nested_run *run = data;
    ewa_parallel(run->context, count_hit, &run->inner[index], 100);
}

static void *run_again(void *data) {
    nested_run *run = data;
    for (uint32_t round = 0; round < 200; round++) ewa_parallel(run->context, count_hit, &run->inner[1], 100);
    return NULL;
}

TEST(test_runs_beside_runs) {
    OWNED(check_free) nested_run *run = calloc(1, sizeof *run);
    run->context = check_context(4, NULL);
    for (int i = 0; i < 64; i++) run->inner[i].workers = 4;
    ewa_parallel(run->context, run_inner, run, 64);
    for (int i = 0; i < 64; i++)
        for (int k = 0; k < 100; k++) assert_int_equal(run->inner[i].hits[k], 1);
    pthread_t other;
    assert_int_equal(pthread_create(&other, NULL, run_again, run), 0);
    for (int round = 0; round < 200; round++) ewa_parallel(run->context, count_hit, &run->inner[0], 100);
    pthread_join(other, NULL);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 100; k++) assert_int_equal(run->inner[i].hits[k], 201);
    for (int i = 0; i < 64; i++) assert_int_equal(run->inner[i].bad_worker, 0);
    ewa_context_destroy(&run->context);
}

TEST(test_split_covers) {
    for (uint64_t count = 0; count < 40; count++) {
        for (uint32_t parts = 1; parts < 9; parts++) {
            assert_int_equal(ewa_split(count, parts, 0), 0);
            assert_int_equal(ewa_split(count, parts, parts), count);
            for (uint32_t p = 0; p < parts; p++)
                assert_true(ewa_split(count, parts, p) <= ewa_split(count, parts, p + 1));
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
