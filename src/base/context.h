// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a context is made of; src/base/services.c is what it does for others.
#ifndef EWA_SRC_BASE_CONTEXT_H
#define EWA_SRC_BASE_CONTEXT_H

#include "base/base.h"
#include "base/pool.h"

#include <stdatomic.h>

struct ewa_context {
    ewa_context_options options;
    ewa_pool *pool;
    uint32_t cpu_features;
    int soft_failures, hushed_failures, hushed_reports; ///< how many ask for each
    atomic_uint_fast64_t serial;                        ///< the last that ewa_serial_next() has given
    atomic_uint_fast64_t held_bytes;                    ///< of memory, against max_memory_bytes
    /// max_memory_bytes is the caller's: nothing unpacks to more than is explained otherwise.
    bool memory_is_set;
    uint64_t packed_before_bytes, unpacked_before_bytes; ///< of ewa_memory_unpacked_before()
    double started_s;
    bool time_is_over; ///< and that was reported
    struct ewa_kept_file *kept_file;    ///< of ewa_file_keep_begin() (src/io/file.h); NULL: nothing is kept
    struct ewa_stoppable_run *run;      ///< the one that ewa_goes_on() is about; NULL: none
    struct ewa_remote *remote;          ///< of ewa_remote_open() (src/io/remote.h); NULL: no server was asked
    void (*end_remote)(struct ewa_remote **remote);
    const char *subject;                ///< what messages are about; NULL: they say so themselves
};

/// While `hushed`, ewa_fail() reports at EWA_SEVERITY_DEBUG: what fails is not missed. In pairs, which nest.
void ewa_failures_hush(ewa_context *context, bool hushed);

/// The allocator's function unless the caller gives one; any thread may call it.
void *ewa_allocate_default(void *user, size_t size_bytes);

#endif
