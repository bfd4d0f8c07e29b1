// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A run is opened by its gate: threads that come in time pass it, others stay out, and the one that has opened it closes it when all
// tasks are taken and nobody is within. No thread is waited for that has not begun.
#include "threads.h"

#include <stdlib.h>

#define EXPORT(name) __attribute__((export_name(#name))) name

enum { CLOSED = -1, STACK_BYTES = 1 << 20, STACK_ALIGNMENT = 16 };

/// Sets up what the compiler calls thread-local, in memory of its own; the linker makes it.
void __wasm_init_tls(void *memory); // NOLINT(bugprone-reserved-identifier)

/// Returns the end of a stack for another thread, behind which lies what is thread-local; NULL: there is no memory. Nobody frees it: threads
/// end with their page.
char *EXPORT(page_thread_stack)(void);

/// Works for a viewer as its thread `worker` (1, 2, ...), without end. Begun by page_thread_begin(), which the page calls.
void page_thread_work(page_threads *threads, uint32_t worker, char *stack);

/// The page says that a thread has ended within a task.
void EXPORT(page_thread_failed)(page_threads *threads);

/// A thread's own instance of the module begins with the stack of the first one: this puts its own in place, which C cannot say.
__asm__(".globaltype __stack_pointer, i32\n"
        ".functype page_thread_work (i32, i32, i32) -> ()\n"
        ".globl page_thread_begin\n"
        ".export_name page_thread_begin, page_thread_begin\n"
        "page_thread_begin:\n"
        ".functype page_thread_begin (i32, i32, i32) -> ()\n"
        "local.get 2\n"
        "global.set __stack_pointer\n"
        "local.get 0\n"
        "local.get 1\n"
        "local.get 2\n"
        "call page_thread_work\n"
        "end_function\n");

static void wait_while(atomic_int *word, int value) { __builtin_wasm_memory_atomic_wait32((int *)word, value, -1); }

static void wake(atomic_int *word) { __builtin_wasm_memory_atomic_notify((int *)word, UINT32_MAX); }

void page_threads_init(page_threads *threads) {
    *threads = (page_threads){.task = NULL};
    atomic_init(&threads->gate, CLOSED);
}

static void take_tasks(page_threads *threads, uint32_t worker) {
    for (;;) {
        const uint32_t index = atomic_fetch_add(&threads->next, 1);
        if (index >= threads->count) return;
        threads->task(threads->data, index, worker);
    }
}

void page_threads_run(void *user, ewa_task *task, void *data, uint32_t count) {
    page_threads *threads = user;
    if (count < 2) {
        if (count) task(data, 0, 0);
        return;
    }
    threads->task = task;
    threads->data = data;
    threads->count = count;
    atomic_store(&threads->next, 0);
    atomic_store(&threads->gate, 0);
    atomic_fetch_add(&threads->round, 1);
    wake(&threads->round);
    take_tasks(threads, 0);
    for (int within = 0; !atomic_compare_exchange_strong(&threads->gate, &within, CLOSED); within = 0)
        wait_while(&threads->gate, within);
    if (atomic_load(&threads->failed)) abort(); // the page says so
}

/// Leaves a run; the last one out wakes who waits for that.
static void leave(page_threads *threads) {
    if (atomic_fetch_sub(&threads->gate, 1) == 1) wake(&threads->gate);
}

char *page_thread_stack(void) {
    char *room = aligned_alloc(STACK_ALIGNMENT, STACK_BYTES + (__builtin_wasm_tls_size() + STACK_ALIGNMENT - 1) / STACK_ALIGNMENT * STACK_ALIGNMENT);
    return room ? room + STACK_BYTES : NULL;
}

void page_thread_work(page_threads *threads, uint32_t worker, char *stack) {
    __wasm_init_tls(stack);
    for (;;) {
        const int round = atomic_load(&threads->round);
        int within = atomic_load(&threads->gate);
        while (within != CLOSED && !atomic_compare_exchange_weak(&threads->gate, &within, within + 1)) {}
        if (within != CLOSED) {
            take_tasks(threads, worker);
            leave(threads);
        }
        wait_while(&threads->round, round);
    }
}

void page_thread_failed(page_threads *threads) {
    atomic_store(&threads->failed, 1);
    leave(threads);
}
