// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/file.c: what can be read, what cannot, and output that appears whole or not at all.
#define _DEFAULT_SOURCE     // MAP_ANONYMOUS
#define _XOPEN_SOURCE   700 // mkdtemp
#include "check.h"
#include "io/file.h"

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/// A folder of its own for each test, a context and its last message.
typedef struct place {
    char folder[64];
    check_log log;
    ewa_context *context;
} place;

static char *inside(const place *p, const char *name, char path[128]) {
    snprintf(path, 128, "%s/%s", p->folder, name);
    return path;
}

static int set_up(void **state) {
    place *p = calloc(1, sizeof *p);
    snprintf(p->folder, sizeof p->folder, "/tmp/ewa-test-file-XXXXXX");
    assert_non_null(mkdtemp(p->folder));
    p->context = check_context(1, &p->log);
    *state = p;
    return 0;
}

static int count_files(const place *p) {
    DIR *folder = opendir(p->folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(folder));)
        count += entry->d_name[0] != '.' || entry->d_name[1] == 'e';
    closedir(folder);
    return count;
}

static int tear_down(void **state) {
    OWNED(check_free) place *p = *state;
    DIR *folder = opendir(p->folder);
    for (struct dirent *entry; (entry = readdir(folder));) unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    assert_int_equal(rmdir(p->folder), 0);
    ewa_context_destroy(&p->context);
    return 0;
}

static void put_file(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void assert_content(place *p, const char *path, const char *text) {
    ewa_file file;
    assert_int_equal(ewa_file_map(p->context, path, &file), EWA_OK);
    assert_int_equal(file.size_bytes, strlen(text));
    assert_memory_equal(file.bytes, text, strlen(text));
    ewa_file_unmap(p->context, &file);
    assert_null(file.bytes);
}

TEST_WITHIN(test_regular_file_is_mapped, set_up, tear_down) {
    place *p = *state;
    char path[128];
    put_file(inside(p, "a", path), "some bytes");
    ewa_file file;
    assert_int_equal(ewa_file_map(p->context, path, &file), EWA_OK);
    assert_true(file.mapped);
    ewa_file_unmap(p->context, &file);
    ewa_file_unmap(p->context, &file);
    assert_content(p, path, "some bytes");
    put_file(inside(p, "empty", path), "");
    assert_content(p, path, "");
}

TEST_WITHIN(test_unreadable_inputs, set_up, tear_down) {
    place *p = *state;
    char path[128], expected[256];
    ewa_file file;
    assert_int_equal(ewa_file_map(p->context, inside(p, "missing", path), &file), EWA_ERROR_IO);
    snprintf(expected, sizeof expected, "%s: No such file or directory", path);
    assert_string_equal(p->log.text, expected);
    assert_int_equal(ewa_file_map(p->context, p->folder, &file), EWA_ERROR_IO);
    snprintf(expected, sizeof expected, "%s: Is a directory", p->folder);
    assert_string_equal(p->log.text, expected);
    put_file(inside(p, "locked", path), "x");
    chmod(path, 0);
    if (geteuid() != 0) {
        assert_int_equal(ewa_file_map(p->context, path, &file), EWA_ERROR_IO);
        assert_non_null(strstr(p->log.text, "Permission denied"));
    }
    assert_int_equal(p->log.count, geteuid() != 0 ? 3 : 2);
}

static void *feed(void *argument) {
    FILE *pipe = fopen(argument, "wb");
    for (int i = 0; i < 50000; i++) fprintf(pipe, "%09d\n", i);
    fclose(pipe);
    return NULL;
}

TEST_WITHIN(test_pipe_is_read_to_its_end, set_up, tear_down) {
    place *p = *state;
    char path[128];
    assert_int_equal(mkfifo(inside(p, "pipe", path), 0600), 0);
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, feed, path), 0);
    ewa_file file;
    assert_int_equal(ewa_file_map(p->context, path, &file), EWA_OK);
    pthread_join(thread, NULL);
    assert_false(file.mapped);
    assert_int_equal(file.size_bytes, 500000);
    assert_memory_equal(file.bytes + 499990, "000049999\n", 10);
    ewa_file_unmap(p->context, &file);
}

TEST_WITHIN(test_endless_input_meets_the_limit, set_up, tear_down) {
    place *p = *state;
    WITH_DEFAULTS(ewa_context_options, options);
    options.limits.max_memory_bytes = 100000;
    options.thread_count = 1;
    ewa_context *small = NULL;
    assert_int_equal(ewa_context_create(&options, &small), EWA_OK);
    ewa_file file;
    assert_int_equal(ewa_file_map(small, "/dev/zero", &file), EWA_ERROR_LIMIT);
    ewa_context_destroy(&small);
    (void)p;
}

TEST_WITHIN(test_output_appears_on_commit, set_up, tear_down) {
    place *p = *state;
    char path[128];
    inside(p, "out", path);
    ewa_writer *writer = NULL;
    assert_int_equal(ewa_writer_open(p->context, path, &writer), EWA_OK);
    assert_int_equal(ewa_writer_put(writer, "abc", 3), EWA_OK);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(ewa_writer_commit(&writer), EWA_OK);
    assert_null(writer);
    assert_content(p, path, "abc");
    assert_int_equal(count_files(p), 1);
    const mode_t mask = umask(0);
    umask(mask);
    struct stat facts;
    stat(path, &facts);
    assert_int_equal(facts.st_mode & 0777, 0666 & ~mask);
}

TEST_WITHIN(test_large_and_small_pieces_keep_their_order, set_up, tear_down) {
    place *p = *state;
    char path[128];
    enum { SIZE = 1000000 };
    OWNED(check_free) uint8_t *bytes = malloc(SIZE);
    check_random random = {7};
    for (int i = 0; i < SIZE; i++) bytes[i] = (uint8_t)check_random_u64(&random);
    ewa_writer *writer = NULL;
    assert_int_equal(ewa_writer_open(p->context, inside(p, "out", path), &writer), EWA_OK);
    for (size_t at = 0; at < SIZE;) {
        const uint64_t r = check_random_u64(&random);
        size_t piece = r % 5 == 0 ? r / 8 % 200000 : r / 8 % 100;
        if (piece > SIZE - at) piece = SIZE - at;
        assert_int_equal(ewa_writer_put(writer, bytes + at, piece), EWA_OK);
        at += piece;
    }
    assert_int_equal(ewa_writer_commit(&writer), EWA_OK);
    ewa_file file;
    assert_int_equal(ewa_file_map(p->context, path, &file), EWA_OK);
    assert_int_equal(file.size_bytes, SIZE);
    assert_memory_equal(file.bytes, bytes, SIZE);
    ewa_file_unmap(p->context, &file);
}

TEST_WITHIN(test_abort_leaves_the_old_file, set_up, tear_down) {
    place *p = *state;
    char path[128];
    put_file(inside(p, "out", path), "old");
    ewa_writer *writer = NULL;
    assert_int_equal(ewa_writer_open(p->context, path, &writer), EWA_OK);
    assert_int_equal(ewa_writer_put(writer, "new", 3), EWA_OK);
    ewa_writer_abort(&writer);
    assert_null(writer);
    ewa_writer_abort(&writer);
    assert_content(p, path, "old");
    assert_int_equal(count_files(p), 1);
}

TEST_WITHIN(test_replacing_keeps_permissions_and_links, set_up, tear_down) {
    place *p = *state;
    char path[128], link_path[128];
    put_file(inside(p, "out", path), "old");
    chmod(path, 0640);
    assert_int_equal(symlink("out", inside(p, "link", link_path)), 0);
    ewa_writer *writer = NULL;
    assert_int_equal(ewa_writer_open(p->context, link_path, &writer), EWA_OK);
    assert_int_equal(ewa_writer_put(writer, "new", 3), EWA_OK);
    assert_int_equal(ewa_writer_commit(&writer), EWA_OK);
    struct stat facts;
    lstat(link_path, &facts);
    assert_true(S_ISLNK(facts.st_mode));
    stat(path, &facts);
    assert_int_equal(facts.st_mode & 0777, 0640);
    assert_content(p, path, "new");
}

TEST_WITHIN(test_outputs_that_cannot_be, set_up, tear_down) {
    place *p = *state;
    char path[128], expected[256];
    ewa_writer *writer = NULL;
    assert_int_equal(ewa_writer_open(p->context, p->folder, &writer), EWA_ERROR_IO);
    snprintf(expected, sizeof expected, "%s: Is a directory", p->folder);
    assert_string_equal(p->log.text, expected);
    assert_int_equal(ewa_writer_open(p->context, inside(p, "no/such/folder", path), &writer), EWA_ERROR_IO);
    assert_non_null(strstr(p->log.text, "No such file or directory"));
    assert_int_equal(ewa_writer_open(p->context, "", &writer), EWA_ERROR_IO);
    assert_null(writer);
    put_file(inside(p, "protected", path), "old");
    chmod(path, 0444);
    if (geteuid() != 0) {
        assert_int_equal(ewa_writer_open(p->context, path, &writer), EWA_ERROR_IO);
        assert_non_null(strstr(p->log.text, "Permission denied"));
    }
    assert_content(p, path, "old");
    assert_int_equal(count_files(p), 1);
}

TEST_WITHIN(test_full_device_fails_once, set_up, tear_down) {
    place *p = *state;
    if (access("/dev/full", W_OK) != 0) skip();
    ewa_writer *writer = NULL;
    assert_int_equal(ewa_writer_open(p->context, "/dev/full", &writer), EWA_OK);
    static const char zeros[100000];
    assert_int_equal(ewa_writer_put(writer, zeros, sizeof zeros), EWA_ERROR_IO);
    assert_int_equal(ewa_writer_put(writer, zeros, sizeof zeros), EWA_ERROR_IO);
    assert_int_equal(ewa_writer_commit(&writer), EWA_ERROR_IO);
    assert_string_equal(p->log.text, "/dev/full: No space left on device");
    assert_int_equal(p->log.count, 1);
    assert_int_equal(access("/dev/full", F_OK), 0);
    // Small output fails when it leaves the buffer, which is at the commit.
    assert_int_equal(ewa_writer_open(p->context, "/dev/full", &writer), EWA_OK);
    assert_int_equal(ewa_writer_put(writer, zeros, 3), EWA_OK);
    assert_int_equal(ewa_writer_commit(&writer), EWA_ERROR_IO);
}

TEST_WITHIN(test_vanished_folder_fails_at_commit, set_up, tear_down) {
    place *p = *state;
    char folder[128], path[160];
    assert_int_equal(mkdir(inside(p, "sub", folder), 0700), 0);
    snprintf(path, sizeof path, "%s/out", folder);
    ewa_writer *writer = NULL;
    assert_int_equal(ewa_writer_open(p->context, path, &writer), EWA_OK);
    char elsewhere[128];
    assert_int_equal(rename(folder, inside(p, "elsewhere", elsewhere)), 0);
    assert_int_equal(ewa_writer_commit(&writer), EWA_ERROR_IO);
    assert_non_null(strstr(p->log.text, path));
    assert_int_equal(rmdir(elsewhere), 0);
}

TEST_WITHIN(test_standard_output, set_up, tear_down) {
    place *p = *state;
    char path[128];
    fflush(stdout);
    const int saved = dup(STDOUT_FILENO);
    const int redirected = open(inside(p, "stdout", path), O_WRONLY | O_CREAT, 0600);
    dup2(redirected, STDOUT_FILENO);
    ewa_writer *writer = NULL;
    ewa_status opened = ewa_writer_open(p->context, "-", &writer);
    if (opened == EWA_OK) ewa_writer_put(writer, "one ", 4);
    const ewa_status closed = opened == EWA_OK ? ewa_writer_commit(&writer) : opened;
    opened = ewa_writer_open(p->context, "/dev/stdout", &writer);
    if (opened == EWA_OK) ewa_writer_put(writer, "two", 3);
    if (opened == EWA_OK) opened = ewa_writer_commit(&writer);
    dup2(saved, STDOUT_FILENO);
    close(saved);
    close(redirected);
    assert_int_equal(opened, EWA_OK);
    assert_int_equal(closed, EWA_OK);
    assert_content(p, path, "one two");
}

/// What was given up of a mapped file belongs to whom the system gives its addresses, also when the file is closed.
TEST_WITHIN(test_given_up, set_up, tear_down) {
    place *p = *state;
    char path[128];
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), size_bytes = 64 * page;
    OWNED(check_free) uint8_t *bytes = malloc(size_bytes);
    for (size_t i = 0; i < size_bytes; i++) bytes[i] = (uint8_t)(i / page + i % 7);
    FILE *out = fopen(inside(p, "large", path), "wb");
    assert_int_equal(fwrite(bytes, 1, size_bytes, out), size_bytes);
    assert_int_equal(fclose(out), 0);
    ewa_file file;
    assert_int_equal(ewa_file_map(p->context, path, &file), EWA_OK);
    ewa_file_give_up(&file, page + 1, 40 * page + 5);
    assert_int_equal(file.bytes[page], bytes[page]);
    assert_int_equal(file.bytes[40 * page], bytes[40 * page]);
    // Somebody else's page in the hole; a system that puts it elsewhere has nothing to show.
    void *wanted = (void *)(uintptr_t)(file.bytes + 10 * page);
    uint8_t *other = mmap(wanted, page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(other, MAP_FAILED);
    other[0] = 17;
    const int descriptor = ewa_file_open_pieces(path, size_bytes);
    assert_true(descriptor >= 0);
    ewa_file piece;
    const uint8_t *found = NULL;
    assert_true(ewa_file_piece_map(descriptor, 5 * page + 3, 2 * page, &piece, &found));
    assert_memory_equal(found, bytes + 5 * page + 3, 2 * page);
    ewa_file_unmap(p->context, &piece);
    assert_int_equal(ewa_file_open_pieces(path, size_bytes + 1), -1);
    close(descriptor);
    ewa_file_unmap(p->context, &file);
    assert_int_equal(msync(other, page, MS_ASYNC), 0); // still there
    assert_int_equal(other[0], 17);
    munmap(other, page);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
