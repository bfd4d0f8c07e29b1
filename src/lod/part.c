// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of an octree, each made by itself, and the whole of them: not there yet.
#include "base/base.h"
#include "lod/build.h"

ewa_status ewa_lod_part_write(ewa_lod_builder *b, const char *out, uint32_t subset, uint32_t subset_count) {
    return ewa_fail(b->context, EWA_ERROR_UNSUPPORTED, "%s: part %u of %u is not made alone yet", out,
                    subset + 1, subset_count);
}

ewa_status ewa_lod_merge(ewa_context *context, const char *const *parts, uint32_t part_count, const char *out,
                         ewa_lod_build_stats *stats) {
    (void)parts;
    (void)stats;
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: %u parts are not joined yet", out, part_count);
}
