// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JSON text to cJSON's tree, with the place of what is wrong.
#include "io/json_text.h"
#include "base/base.h"

enum {
    // cJSON takes up to 40 bytes of memory per byte of text.
    MAX_FILE_BYTES = 1 << 26,
};

static ewa_status fail_syntax(ewa_context *context, const char *name, const uint8_t *bytes,
                              const uint8_t *at) {
    size_t line = 1, column = 1;
    for (; bytes < at; bytes++) {
        column = *bytes == '\n' ? 1 : column + 1;
        line += *bytes == '\n';
    }
    return ewa_fail(context, EWA_ERROR_FORMAT, "%s:%zu:%zu: not JSON from here on", name, line, column);
}

ewa_status ewa_json_parse(ewa_context *context, const char *name, const char *what, const uint8_t *bytes,
                          size_t size_bytes, cJSON **root) {
    *root = NULL;
    if (size_bytes > MAX_FILE_BYTES)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %zu bytes, more than %s may have (%d)", name,
                        size_bytes, what, MAX_FILE_BYTES);
    const char *text = size_bytes ? (const char *)bytes : "", *end = text;
    cJSON *parsed = cJSON_ParseWithLengthOpts(text, size_bytes, &end, false);
    const char *last = text + size_bytes;
    while (parsed && end < last && (*end == ' ' || *end == '\t' || *end == '\r' || *end == '\n')) end++;
    if (!parsed || end != last) {
        cJSON_Delete(parsed);
        return fail_syntax(context, name, bytes, (const uint8_t *)(end < last ? end : last));
    }
    *root = parsed;
    return EWA_OK;
}
