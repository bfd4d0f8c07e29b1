// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Requests for parts of files on servers, by HTTP: several at once, again where a connection is cut.
//
// Based on: RFC 9110, "HTTP Semantics", section 14.
#ifndef EWA_SRC_HTTP_H
#define EWA_SRC_HTTP_H

#include "base/base.h"

enum {
    EWA_HTTP_TAG_BYTES = 128,
    EWA_HTTP_REASON_BYTES = 256,
    EWA_HTTP_WHOLE_BYTES = 1 << 30, ///< of a file that comes as a whole, at most
};
#define EWA_HTTP_SIZE_UNKNOWN UINT64_MAX

/// Connections of a context, and the library that makes them.
typedef struct ewa_http ewa_http;

/// A part that is wanted, and what came of it.
typedef struct ewa_http_part {
    uint64_t at_bytes;
    size_t size_bytes; ///< > 0
    uint8_t *to;       ///< as many

    size_t got_bytes;                  ///< fewer only at the end of the file
    uint64_t file_bytes;               ///< of the file; EWA_HTTP_SIZE_UNKNOWN: the server does not say
    char tag[EWA_HTTP_TAG_BYTES];  ///< ETag or date, by which a changed file is told; "": none
    uint8_t *whole;                    ///< the whole file, of `file_bytes`, where the server gives no parts; the caller's; else NULL
    ewa_status status;                 ///< EWA_OK, EWA_ERROR_IO, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED
    char reason[EWA_HTTP_REASON_BYTES]; ///< why not, where it is EWA_ERROR_IO or EWA_ERROR_LIMIT
} ewa_http_part;

/// Makes ready to ask servers. Errors: EWA_ERROR_UNSUPPORTED (the library is not there), EWA_ERROR_MEMORY.
ewa_status ewa_http_create(ewa_context *context, ewa_http **transfer);
void ewa_http_destroy(ewa_http **transfer);

/// Reads parts of the file at an address of http or https, a few at a time, on the thread that calls; what is cut, or fails on the
/// server's side, is asked for again three times. Redirects are followed five times, to http and https, from https to https only.
/// Everything that can go wrong is in the parts; reports nothing. Asks the progress callback.
void ewa_http_read(ewa_http *transfer, const char *address, ewa_http_part *parts, uint32_t count);

#endif
