// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JSON text to cJSON's tree, with the place of what is wrong.
#ifndef EWA_SRC_JSON_TEXT_H
#define EWA_SRC_JSON_TEXT_H

#include "ewa/base.h"

#include <cjson/cJSON.h>

/// Parses one JSON text of at most 64 MiB; `what` ("a camera file") is for messages. The caller deletes
/// `*root` by cJSON_Delete(); it is NULL after a failure. Errors: EWA_ERROR_LIMIT, EWA_ERROR_FORMAT with line
/// and column.
ewa_status ewa_json_parse(ewa_context *context, const char *name, const char *what, const uint8_t *bytes,
                          size_t size_bytes, cJSON **root);

#endif
