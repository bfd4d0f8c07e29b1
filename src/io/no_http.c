// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files on servers in a library without libcurl: there are none.
#include "io/http.h"

ewa_status ewa_http_create(ewa_context *context, ewa_http **transfer) {
    *transfer = NULL;
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "files on servers (http, https), which this build does not read (EWA_WITH_CURL)");
}

void ewa_http_destroy(ewa_http **transfer) { *transfer = NULL; }

void ewa_http_read(ewa_http *transfer, const char *address, ewa_http_part *parts, uint32_t count) {
    (void)transfer;
    (void)address;
    for (uint32_t i = 0; i < count; i++) parts[i].status = EWA_ERROR_UNSUPPORTED;
}
