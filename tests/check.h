// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// cmocka with what it needs before it, and a context for tests.
#ifndef EWA_TESTS_CHECK_H
#define EWA_TESTS_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "defaults.h"
#include "ewa/ewa.h"
#include "owned.h"

/// A test, which RUN_TESTS runs, in the order in which a file has them: TEST(name) { ... }, with `state` as cmocka hands it over.
#define TEST(name) TEST_WITHIN(name, NULL, NULL)

/// A test that `set_up` runs before and `tear_down` after, if only because an assertion of it fails; either may be NULL.
#define TEST_WITHIN(name, set_up, tear_down)                                                                            \
    static void name(void **state);                                                                                     \
    __attribute__((constructor)) static void add_##name(void) {                                                         \
        check_tests[__COUNTER__] = (struct CMUnitTest){#name, name, set_up, tear_down, NULL};                           \
        check_test_count++;                                                                                             \
    }                                                                                                                   \
    static void name(void **state)

/// A test that has a `context` of `threads` workers (0: default), which is destroyed after it.
#define TEST_ON(name, threads)                                                                                          \
    static void name##_on(ewa_context *context);                                                                        \
    TEST(name) {                                                                                                        \
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);                                 \
        name##_on(context);                                                                                             \
    }                                                                                                                   \
    static void name##_on(ewa_context *context)

/// The same, and `log` keeps the last message of the context.
#define TEST_LOGGED(name, threads)                                                                                      \
    static void name##_logged(ewa_context *context, check_log *log);                                                    \
    TEST(name) {                                                                                                        \
        check_log log = {.count = 0};                                                                                   \
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, &log);                                 \
        name##_logged(context, &log);                                                                                   \
    }                                                                                                                   \
    static void name##_logged(ewa_context *context, check_log *log)

/// Runs the tests of a file between `set_up` and `tear_down` of all, which may be NULL; gives how many failed.
#define RUN_TESTS(set_up, tear_down) _cmocka_run_group_tests("tests", check_tests, check_test_count, set_up, tear_down)

static __attribute__((unused)) struct CMUnitTest check_tests[64];
static __attribute__((unused)) size_t check_test_count;

/// Keeps the last message of a context, for tests that look at it.
typedef struct check_log {
    char text[1024];
    int count;
} check_log;

static inline void check_log_keep(void *user, ewa_severity severity, const char *text) {
    check_log *log = user;
    if (severity > EWA_SEVERITY_WARNING) return;
    snprintf(log->text, sizeof log->text, "%s", text);
    log->count++;
}

/// A context with `threads` workers (0: default) whose messages go to `log` (may be NULL).
static inline ewa_context *check_context(uint32_t threads, check_log *log) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = threads;
    if (log) {
        options.message = check_log_keep;
        options.message_user = log;
    }
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

/// A context with `threads` workers and the instruction sets of `cpu_mask`.
static inline ewa_context *check_context_of(uint32_t threads, uint32_t cpu_mask) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = threads;
    options.cpu_mask = cpu_mask;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

/// Memory of which one allocation fails, and what of it is not given back.
typedef struct check_memory {
    long calls_left; ///< allocations before the one that fails; negative: none fails
    int64_t held_bytes, peak_bytes;
} check_memory;

/// Memory aligned as ewa_allocator asks for, and its way back.
static inline void *check_aligned(size_t size_bytes) {
#ifdef _WIN32
    return _aligned_malloc(size_bytes, 64);
#else
    return aligned_alloc(64, (size_bytes + 63) / 64 * 64);
#endif
}

static inline void check_aligned_release(void *block) {
#ifdef _WIN32
    _aligned_free(block);
#else
    free(block);
#endif
}

static inline void *check_allocate(void *user, size_t size_bytes) {
    check_memory *memory = user;
    if (memory->calls_left-- == 0) return NULL;
    void *block = check_aligned(size_bytes);
    // So that a sanitizer sees what is read before it is written.
    if (block) memset(block, 0xa5, size_bytes);
    if (block) memory->held_bytes += (int64_t)size_bytes;
    if (memory->held_bytes > memory->peak_bytes) memory->peak_bytes = memory->held_bytes;
    return block;
}

static inline void check_release(void *user, void *block, size_t size_bytes) {
    ((check_memory *)user)->held_bytes -= (int64_t)size_bytes;
    check_aligned_release(block);
}

/// The allocator of ewa_context_options that takes from `memory`.
static inline ewa_allocator check_allocator(check_memory *memory) {
    return (ewa_allocator){memory, check_allocate, check_release};
}

/// A context with `threads` workers that takes from `memory`.
static inline ewa_context *check_context_on(uint32_t threads, check_memory *memory) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.allocator = check_allocator(memory);
    options.thread_count = threads;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

/// A cloud of `count` points without attributes.
static inline ewa_cloud *check_cloud_of(ewa_context *context, uint64_t count) {
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_create(context, count, &cloud), EWA_OK);
    return cloud;
}

/// The numbers of a new attribute, to be filled.
static inline void *check_add(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t component_count) {
    void *data = NULL;
    assert_int_equal(ewa_cloud_add(cloud, name, type, component_count, &data), EWA_OK);
    return data;
}

static inline ewa_surfels *check_surfels(const ewa_cloud *cloud, const ewa_surfels_options *options) {
    ewa_surfels *surfels = NULL;
    assert_int_equal(ewa_surfels_create(cloud, options, &surfels), EWA_OK);
    return surfels;
}

static inline ewa_renderer *check_renderer(ewa_context *context) {
    ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create(context, &renderer), EWA_OK);
    return renderer;
}

/// A camera of a picture of that size, else with its defaults.
static inline ewa_camera check_camera(uint32_t width_px, uint32_t height_px) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = width_px;
    camera.height_px = height_px;
    return camera;
}

/// Goes on as often as the number says that `user` points to.
static inline bool check_go_on(void *user, const char *stage, double fraction) {
    (void)stage, (void)fraction;
    return (*(int *)user)-- > 0;
}

/// A context with `threads` workers (0: default) whose progress goes to `progress`, with `user`.
static inline ewa_context *check_context_telling(uint32_t threads, bool (*progress)(void *user, const char *stage, double fraction),
                                                 void *user) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = threads;
    options.progress = progress;
    options.progress_user = user;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

/// A context that takes from `memory` and is stopped when it has asked `*left` times.
static inline ewa_context *check_context_stopped(int *left, check_memory *memory) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.allocator = check_allocator(memory);
    options.progress = check_go_on;
    options.progress_user = left;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

/// Says that a file of the shared test data is not there; a failure where the folder is said to have all of
/// them.
static inline void check_data_missing(const char *relative) {
    if (getenv("EWA_DATA_IS_WHOLE")) fail_msg("no synthetic file for %s: tests/data makes them", relative);
    print_message("skipped: no test data %s\n", relative);
}

/// Path of a file of the shared test data, or NULL (after saying so) when it is not there.
static inline const char *check_data(const char *relative, char *path, size_t path_bytes) {
    const char *folder = getenv("EWA_DATA");
    if (folder) {
        snprintf(path, path_bytes, "%s/%s", folder, relative);
        FILE *file = fopen(path, "rb");
        if (file) {
            fclose(file);
            return path;
        }
    }
    check_data_missing(relative);
    return NULL;
}

/// A seeded stream of numbers for property tests (splitmix64), the same everywhere.
typedef struct check_random {
    uint64_t state;
} check_random;

static inline uint64_t check_random_u64(check_random *random) {
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// Uniform in [low, high).
static inline double check_uniform(check_random *random, double low, double high) {
    return low + (high - low) * (double)(check_random_u64(random) >> 11) * 0x1p-53;
}

/// Draws three numbers, the last one first. Two draws among the arguments of one call would come in the order
/// that the compiler likes.
static inline void check_uniform3(check_random *random, double low, double high, double numbers[3]) {
    for (int i = 3; i-- > 0;) numbers[i] = check_uniform(random, low, high);
}

#endif
