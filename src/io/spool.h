// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Temporary storage: a file without a name, which is gone when the process ends, however it ends.
#ifndef EWA_SRC_SPOOL_H
#define EWA_SRC_SPOOL_H

#include "base/base.h"

typedef struct ewa_spool ewa_spool;

/// Opens a spool in the folder of the file `beside`. The caller closes `*spool`, which is NULL after a failure.
/// Errors: EWA_ERROR_IO, EWA_ERROR_MEMORY.
ewa_status ewa_spool_open(ewa_context *context, const char *beside, ewa_spool **spool);

/// Appends bytes; `*at_bytes` (may be NULL) gets their place. Errors: EWA_ERROR_IO.
ewa_status ewa_spool_put(ewa_spool *spool, const void *bytes, size_t size_bytes, uint64_t *at_bytes);

/// Reads bytes that were put. Errors: EWA_ERROR_IO.
ewa_status ewa_spool_get(ewa_spool *spool, uint64_t at_bytes, void *bytes, size_t size_bytes);

/// Returns how many bytes were put.
uint64_t ewa_spool_size(const ewa_spool *spool);

/// Closes the spool, whose bytes are gone, and sets `*spool` to NULL; accepts NULL and a pointer to NULL.
void ewa_spool_close(ewa_spool **spool);

#endif
