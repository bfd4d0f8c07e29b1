// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JSON text to cJSON's tree, with the place of what is wrong.
#ifndef EWA_SRC_JSON_TEXT_H
#define EWA_SRC_JSON_TEXT_H

#include "ewa/base.h"

#include <cjson/cJSON.h>

enum { EWA_JSON_BYTES = 1 << 26 }; ///< a text may have

/// A tree and what it holds of the context's memory; zeroed: none.
typedef struct ewa_json {
    cJSON *root;
    uint64_t held_bytes;
} ewa_json;

/// Fails in a library without JSON, which who makes a text to be written asks. Errors: EWA_ERROR_UNSUPPORTED.
ewa_status ewa_json_check(ewa_context *context, const char *name);

/// Parses one JSON text of at most EWA_JSON_BYTES; `what` ("a camera file") is for messages. Before anything is made, the nodes of
/// the tree are counted against max_memory_bytes. Free with ewa_json_free(); `*json` is zeroed after a failure. Errors:
/// EWA_ERROR_LIMIT, EWA_ERROR_FORMAT with line and column, EWA_ERROR_UNSUPPORTED as ewa_json_check().
ewa_status ewa_json_parse(ewa_context *context, const char *name, const char *what, const uint8_t *bytes,
                          size_t size_bytes, ewa_json *json);
void ewa_json_free(ewa_context *context, ewa_json *json);

#endif
