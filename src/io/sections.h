// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of sections, for what this library writes for itself to read again: each has a tag, a checksum and a size.
#ifndef EWA_SRC_SECTIONS_H
#define EWA_SRC_SECTIONS_H

#include "base/base.h"
#include "io/file.h"

/// Bytes of a section that are gathered before it is written. Zero-initialise.
typedef struct ewa_section {
    ewa_buffer buffer;
    size_t size_bytes;
} ewa_section;

/// Appends bytes. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_section_put(ewa_context *context, ewa_section *section, const void *bytes, size_t size_bytes);

/// Writes the section and empties it. Errors: as ewa_writer_put().
ewa_status ewa_section_write(ewa_writer *writer, uint32_t tag, ewa_section *section);
void ewa_section_free(ewa_context *context, ewa_section *section);

/// What is left of a section that is read, or of a file.
typedef struct ewa_section_view {
    const uint8_t *bytes;
    uint64_t size_bytes;
} ewa_section_view;

/// Steps over the next section of a file; false at its end, and where its checksum or its size is wrong, which
/// `*fault` says (NULL: nothing).
bool ewa_section_next(ewa_section_view *file, uint32_t *tag, ewa_section_view *section, const char **fault);

/// Copies the next bytes of a section; false, with zeros, when there are fewer.
bool ewa_section_take(ewa_section_view *section, void *to, uint64_t size_bytes);

/// Steps over the next bytes of a section; NULL when there are fewer.
const uint8_t *ewa_section_skip(ewa_section_view *section, uint64_t size_bytes);

#endif
