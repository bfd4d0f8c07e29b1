// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The stable sort on the device: any number of items, equal keys in their order, items without a key left out.
#include "check.h"
#include "gl/sort.h"

#include <stdlib.h>

enum { MAX_COUNT = 70000, COUNT_AT = 2 };

static ewa_gl *device;
static ewa_gl_sorter sorter;
static uint32_t keys[MAX_COUNT], values[MAX_COUNT], wanted[MAX_COUNT], found[2][MAX_COUNT];

static int compare_items(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    if (keys[x] != keys[y]) return keys[x] < keys[y] ? -1 : 1;
    return x < y ? -1 : x > y;
}

/// Sorts items of `capacity`, of which there are `count`, into room for `room`.
static void sort(uint32_t count, uint32_t capacity, uint32_t room) {
    ewa_gl_buffer lists[6] = {{0}}, counts = {0};
    const uint32_t numbers[] = {7, 7, count, room < count ? room : count};
    assert_int_equal(ewa_gl_buffer_put(device, &counts, "counts", numbers, sizeof numbers), EWA_OK);
    for (int i = 0; i < 6; i++) assert_int_equal(ewa_gl_buffer_reserve(device, &lists[i], "items", 4ull * capacity), EWA_OK);
    ewa_gl_buffer_write(device, &lists[0], 0, keys, 4ull * count);
    ewa_gl_buffer_write(device, &lists[1], 0, values, 4ull * count);
    uint32_t valid = 0, from = 0;
    for (uint32_t i = 0; i < count; i++)
        if (keys[i] != EWA_GL_NO_KEY) wanted[valid++] = i;
    const uint32_t after[] = {7, 7, count, valid};
    ewa_gl_buffer_write(device, &counts, 0, after, sizeof after);
    for (uint32_t pass = 0; pass < 4; pass++) {
        const uint32_t to = 2 + 2 * (pass % 2);
        const ewa_gl_items before = {&lists[from], &lists[from + 1], pass ? room : capacity},
                           sorted = {&lists[to], &lists[to + 1], room};
        assert_int_equal(ewa_gl_sort_pass(device, &sorter, &before, &sorted, &counts, pass ? 3 : COUNT_AT, 8 * pass), EWA_OK);
        from = to;
    }
    assert_int_equal(ewa_gl_wait(device, "sorting"), EWA_OK);
    qsort(wanted, valid, sizeof *wanted, compare_items);
    for (uint32_t list = 0; list < 2 && valid; list++) {
        glBindBuffer(GL_COPY_READ_BUFFER, lists[from + list].name);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)(4 * (size_t)valid), found[list]);
    }
    for (uint32_t i = 0; i < valid; i++) {
        assert_int_equal(found[0][i], keys[wanted[i]]);
        assert_int_equal(found[1][i], values[wanted[i]]);
    }
    for (int i = 0; i < 6; i++) ewa_gl_buffer_free(&lists[i]);
    ewa_gl_buffer_free(&counts);
}

TEST(test_order) {
    static const uint32_t counts[] = {0, 1, 2, 31, 32, 33, 255, 256, 257, 4095, 4096, 4097, 20000, MAX_COUNT};
    static const uint32_t masks[] = {UINT32_MAX, 0x3, 0x700, 0xff000000u, 0}; // many equal keys
    check_random random = {.state = 5};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        for (size_t m = 0; m < sizeof masks / sizeof masks[0]; m++) {
            for (uint32_t k = 0; k < counts[i]; k++) {
                keys[k] = (uint32_t)check_random_u64(&random) & masks[m];
                values[k] = (uint32_t)check_random_u64(&random);
                if (check_random_u64(&random) % 5 == 0 && m < 3) keys[k] = EWA_GL_NO_KEY;
            }
            sort(counts[i], MAX_COUNT, MAX_COUNT);
        }
}

int main(void) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    if (ewa_gl_open(context, &device) != EWA_OK || !device->facts.compute) {
        printf("skipped: there is no device with compute programs\n");
        ewa_gl_close(&device);
        return 77;
    }
    assert_int_equal(ewa_gl_enter(device), EWA_OK);
    const int failed = RUN_TESTS(NULL, NULL);
    ewa_gl_sorter_free(&sorter);
    ewa_gl_leave(device);
    ewa_gl_close(&device);
    return failed;
}
