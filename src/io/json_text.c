// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JSON text to cJSON's tree, with the place of what is wrong.
#include "io/json_text.h"
#include "base/base.h"
#include "base/unpacking.h"

enum {
    NODE_BYTES = (sizeof(cJSON) + 8 + 15) / 16 * 16, // of a block of the C library's memory
    STRING_BYTES = 32,                               // around the letters
};

/// What the tree of a text takes at most. A container begins with its first node, and each comma begins another.
static uint64_t tree_bytes(const uint8_t *bytes, size_t size_bytes) {
    uint64_t nodes = 1, quotes = 0;
    for (size_t i = 0; i < size_bytes; i++) {
        nodes += (bytes[i] == ',') + (bytes[i] == '[') + (bytes[i] == '{');
        quotes += bytes[i] == '"';
    }
    return NODE_BYTES * nodes + STRING_BYTES * (quotes / 2) + size_bytes;
}

static ewa_status fail_syntax(ewa_context *context, const char *name, const char *text, const char *at) {
    size_t line = 1, column = 1;
    for (; text < at; text++) {
        column = *text == '\n' ? 1 : column + 1;
        line += *text == '\n';
    }
    return ewa_fail(context, EWA_ERROR_FORMAT, "%s:%zu:%zu: not JSON from here on", name, line, column);
}

ewa_status ewa_json_check(ewa_context *context, const char *name) {
    (void)context, (void)name;
    return EWA_OK;
}

ewa_status ewa_json_parse(ewa_context *context, const char *name, const char *what, const uint8_t *bytes,
                          size_t size_bytes, ewa_json *json) {
    *json = (ewa_json){0};
    if (size_bytes > EWA_JSON_BYTES)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %zu bytes, more than %s may have (%d)", name,
                        size_bytes, what, EWA_JSON_BYTES);
    ewa_json made = {.held_bytes = tree_bytes(bytes, size_bytes)};
    EWA_TRY(ewa_memory_check_unpacked(context, size_bytes, EWA_JSON_RATIO, made.held_bytes, "%s: JSON of %zu bytes", name, size_bytes));
    EWA_TRY(ewa_memory_take(context, made.held_bytes, "%s: JSON of %zu bytes", name, size_bytes));
    const char *text = size_bytes ? (const char *)bytes : "", *end = text;
    made.root = cJSON_ParseWithLengthOpts(text, size_bytes, &end, false);
    const char *last = text + size_bytes;
    while (made.root && end < last && (*end == ' ' || *end == '\t' || *end == '\r' || *end == '\n')) end++;
    if (made.root && end == last) {
        *json = made;
        return EWA_OK;
    }
    ewa_json_free(context, &made);
    return fail_syntax(context, name, text, end < last ? end : last);
}

void ewa_json_free(ewa_context *context, ewa_json *json) {
    cJSON_Delete(json->root);
    if (json->held_bytes) ewa_memory_give(context, json->held_bytes);
    *json = (ewa_json){0};
}
