// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Bytes that may be packed, read from front to back as if they were not: never more than is asked for, so
// that a small file cannot unpack to more than its reader wants.
#ifndef EWA_SRC_SOURCE_H
#define EWA_SRC_SOURCE_H

#include "ewa/base.h"

typedef enum ewa_packing {
    EWA_PACKING_NONE = 0,
    EWA_PACKING_DEFLATE, ///< gzip or zlib, one stream or several one after the other
    EWA_PACKING_BZIP2,
    EWA_PACKING_HEX,  ///< two digits per byte, blanks between them
    EWA_PACKING_TEXT, ///< decimal numbers; not for ewa_source_open()
} ewa_packing;

typedef struct ewa_source ewa_source;

/// Begins to read `size_bytes` packed bytes, which must stay until ewa_source_close(); `name` is for
/// messages. Errors: EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED where the library is built without what unpacks them.
ewa_status ewa_source_open(ewa_context *context, const char *name, ewa_packing packing, const uint8_t *bytes,
                           size_t size_bytes, ewa_source **source);

/// Reads up to `size_bytes` bytes; `*got_bytes` is less at the end only. Errors: EWA_ERROR_FORMAT (packed
/// data that are broken or end early), EWA_ERROR_MEMORY.
ewa_status ewa_source_read(ewa_source *source, void *to, size_t size_bytes, size_t *got_bytes);

/// Goes to the end of a packed stream whose bytes were all read, so that its checksum is looked at; `*more`:
/// there were bytes left to read, of this stream or of others. Errors as ewa_source_read().
ewa_status ewa_source_settle(ewa_source *source, bool *more);

/// Frees the source and sets `*source` to NULL; accepts a pointer to NULL.
void ewa_source_close(ewa_source **source);

/// Upper bound of the bytes that `size_bytes` packed ones can become; UINT64_MAX when no useful bound is
/// known.
uint64_t ewa_source_bound(ewa_packing packing, uint64_t size_bytes);

#endif
