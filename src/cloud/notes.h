// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Named bytes that travel with a cloud: what a file says beside its points.
#ifndef EWA_SRC_NOTES_H
#define EWA_SRC_NOTES_H

#include "ewa/cloud.h"

typedef struct ewa_note {
    char name[EWA_NAME_BYTES];
    char *bytes; ///< a zero stands behind them
    size_t size_bytes;
} ewa_note;

/// Notes in the order of addition. Zero-initialised means: none.
typedef struct ewa_notes {
    ewa_note *notes;
    uint32_t count, capacity;
} ewa_notes;

/// Puts a copy of bytes in place of the note of that name, or at the end; no bytes remove it. Errors:
/// EWA_ERROR_ARGUMENT (name empty or too long), EWA_ERROR_MEMORY.
ewa_status ewa_notes_set(ewa_context *context, ewa_notes *notes, const char *name, const void *bytes,
                         size_t size_bytes);

/// The note of that name or NULL.
const ewa_note *ewa_notes_find(const ewa_notes *notes, const char *name);

void ewa_notes_free(ewa_context *context, ewa_notes *notes);

#endif
