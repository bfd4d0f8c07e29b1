// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JSON in a library without cJSON: known, and refused.
#include "base/base.h"
#include "io/json_text.h"

ewa_status ewa_json_check(ewa_context *context, const char *name) {
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: JSON, which this build has not (EWA_WITH_CJSON)", name);
}

ewa_status ewa_json_parse(ewa_context *context, const char *name, const char *what, const uint8_t *bytes,
                          size_t size_bytes, ewa_json *json) {
    (void)what, (void)bytes, (void)size_bytes;
    *json = (ewa_json){0};
    return ewa_json_check(context, name);
}

void ewa_json_free(ewa_context *context, ewa_json *json) { (void)context, (void)json; }
