// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Threads of a page: workers of the browser that run this module on the same memory (page/threads.js), beside the one that calls the
// library. The C library of the module knows no threads: they allocate nothing, and wait by instructions of the processor.
#ifndef EWA_PAGE_THREADS_H
#define EWA_PAGE_THREADS_H

#include "ewa/base.h"

#include <stdatomic.h>

typedef struct page_threads {
    atomic_int round; ///< another one for another run, on which idle threads wait
    atomic_int gate;  ///< threads that are within the run; CLOSED: there is no run
    atomic_int failed; ///< one of them has ended within it
    ewa_task *task;
    void *data;
    uint32_t count;
    atomic_uint next;
} page_threads;

void page_threads_init(page_threads *threads);

/// The `run` of an ewa_executor whose user they are.
void page_threads_run(void *user, ewa_task *task, void *data, uint32_t count);

#endif
