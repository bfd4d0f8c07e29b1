// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the tests of picture and camera files share: a folder for what they write, whole files, an allocator
// that fails on request.
#ifndef EWA_TESTS_SCRATCH_H
#define EWA_TESTS_SCRATCH_H

#include "check.h"

#include <dirent.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// Path of a file in a folder of the test's own, beside others that run, in the build folder (by hand, without
/// ctest: in /tmp); the buffer is the caller's.
static inline const char *scratch_path(const char *name, char path[512]) {
    const char *folder = getenv("EWA_BINARY_DIR"), *test = getenv("EWA_TEST");
    const int shared = snprintf(path, 512, "%s/scratch", folder ? folder : "/tmp");
    mkdir(path, 0777);
    const int own = snprintf(path + shared, 512 - (size_t)shared, "/%s", test ? test : "by_hand");
    mkdir(path, 0777);
    snprintf(path + shared + own, 512 - (size_t)(shared + own), "/%s", name);
    return path;
}

/// Reads a whole file; the caller frees.
static inline uint8_t *scratch_read(const char *path, size_t *size_bytes) {
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("cannot read %s", path);
    fseek(file, 0, SEEK_END);
    *size_bytes = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*size_bytes + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size_bytes, file), *size_bytes);
    fclose(file);
    return bytes;
}

static inline void scratch_write(const char *path, const void *bytes, size_t size_bytes) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size_bytes, file), size_bytes);
    fclose(file);
}

/// Calls `visit` for every file of a folder of the shared data; returns how many there were.
static inline int scratch_each(const char *relative, void (*visit)(void *user, const char *path),
                               void *user) {
    const char *data = getenv("EWA_DATA");
    char folder[512], path[1024];
    snprintf(folder, sizeof folder, "%s/%s", data ? data : ".", relative);
    DIR *listing = opendir(folder);
    if (!listing) {
        check_data_missing(relative);
        return 0;
    }
    int count = 0;
    for (struct dirent *entry; (entry = readdir(listing));) {
        if (entry->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        visit(user, path);
        count++;
    }
    closedir(listing);
    return count;
}

/// Broken pictures: each loads or is refused with a message that begins with its path.
typedef struct scratch_pictures {
    ewa_context *context;
    check_log log; ///< of `context`
    int refused;
} scratch_pictures;

static inline void scratch_load_picture(void *user, const char *path) {
    scratch_pictures *pictures = user;
    pictures->log = (check_log){0};
    ewa_image image;
    const ewa_status status = ewa_image_load(pictures->context, path, &image);
    if (status == EWA_OK) {
        ewa_image_free(&image);
        return;
    }
    assert_null(image.pixels);
    assert_true(pictures->log.count > 0 && strncmp(pictures->log.text, path, strlen(path)) == 0);
    pictures->refused++;
}

/// A context of one worker on `memory`.
static inline ewa_context *scratch_context(check_memory *memory, check_log *log) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.allocator = check_allocator(memory);
    options.thread_count = 1;
    options.message = check_log_keep;
    options.message_user = log;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

/// Runs `work` with its first, second, ... allocation failing, until it succeeds: each failure must be
/// EWA_ERROR_MEMORY with a message and leave nothing allocated.
static inline void scratch_fail_each(ewa_status (*work)(ewa_context *context, void *user), void *user) {
    for (long nth = 0;; nth++) {
        check_memory memory = {.calls_left = -1};
        check_log log = {0};
        ewa_context *context = scratch_context(&memory, &log);
        const int64_t before = memory.held_bytes;
        memory.calls_left = nth;
        const ewa_status status = work(context, user);
        const bool reached = memory.calls_left < 0;
        assert_int_equal(memory.held_bytes, before);
        ewa_context_destroy(&context);
        if (!reached) {
            assert_int_equal(status, EWA_OK);
            assert_true(nth > 0);
            return;
        }
        assert_int_equal(status, EWA_ERROR_MEMORY);
        assert_true(log.count > 0);
    }
}

#endif
