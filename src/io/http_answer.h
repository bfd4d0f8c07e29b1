// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What servers answer to a request for a part of a file: header lines and bytes, which may be anything.
//
// Based on: RFC 9110, "HTTP Semantics", sections 8.3 to 8.8 and 14.4.
#ifndef EWA_SRC_HTTP_ANSWER_H
#define EWA_SRC_HTTP_ANSWER_H

#include "io/http.h"

/// The answers to the requests for one part, of which each goes on where the last one was cut.
typedef struct ewa_http_answer {
    ewa_context *context;
    ewa_http_part *part;
    const char *refused; ///< why the rest is not taken; NULL: it is
    ewa_status refused_status;
    // Of the present one:
    long code;
    uint64_t range_first, range_size, length; ///< Content-Range and Content-Length; EWA_HTTP_SIZE_UNKNOWN: not said
    bool packed;                              ///< Content-Encoding
    size_t before_bytes;                      ///< of the part that earlier ones have brought
    char tag_before[EWA_HTTP_TAG_BYTES];      ///< of the file that these were of
    size_t whole_room_bytes, whole_bytes;     ///< of part->whole
} ewa_http_answer;

/// Empties a part, whose answers come next.
void ewa_http_answer_open(ewa_context *context, ewa_http_part *part, ewa_http_answer *answer);

/// Begins the next answer, to a request for what is missing.
void ewa_http_answer_begin(ewa_http_answer *answer);

/// Takes one line of its head, with or without its end.
void ewa_http_answer_take_header(ewa_http_answer *answer, const char *line, size_t length);

/// Takes bytes of its body; returns false, and says why in `refused`, where it is not to go on.
bool ewa_http_answer_take_body(ewa_http_answer *answer, const char *bytes, size_t size_bytes);

/// Whether all came that could be asked for: the part, the whole file instead of it, or word that the file ends before it.
bool ewa_http_answer_is_whole(const ewa_http_answer *answer);

/// Ends the part by its status: what came as a whole is the caller's where that is EWA_OK, else it is let go. May turn EWA_OK into
/// EWA_ERROR_MEMORY.
void ewa_http_answer_end(ewa_http_answer *answer);

#endif
