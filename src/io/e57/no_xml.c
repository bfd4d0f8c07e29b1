// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// E57 in a library without expat, which reads its head: known, and refused.
#include "base/base.h"
#include "io/e57/e57.h"

ewa_status ewa_e57_xml_read(const ewa_e57_pages *pages, uint64_t logical, uint64_t size_bytes,
                            ewa_e57_contents *contents) {
    (void)logical, (void)size_bytes;
    *contents = (ewa_e57_contents){0};
    return ewa_fail(pages->source->context, EWA_ERROR_UNSUPPORTED, "%s: E57, which this build has not (EWA_WITH_E57)",
                    pages->source->name);
}

void ewa_e57_contents_free(ewa_context *context, ewa_e57_contents *contents) { (void)context, (void)contents; }
