// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How much memory an input may take that unpacks: a few bytes of WebP say that they are a picture of a gigabyte, and are.
#ifndef EWA_SRC_BASE_UNPACKING_H
#define EWA_SRC_BASE_UNPACKING_H

#include "base/base.h"

enum {
    EWA_UNPACKED_RATIO = 1032, ///< most that deflate can do: a match of 258 bytes takes at least two bits
    EWA_JSON_RATIO = 16,       ///< a tree of a text of ordinary names and numbers
};

/// What a reader asks before it unpacks: ewa_memory_check(), which besides, unless the caller set max_memory_bytes, fails for
/// more than 1 GiB and more than `ratio` times the `packed_bytes` of the input. So a few bytes cannot take all of the machine,
/// and large files can be as large as they are. Errors: EWA_ERROR_LIMIT.
ewa_status ewa_memory_check_unpacked(ewa_context *context, uint64_t packed_bytes, uint32_t ratio, uint64_t bytes,
                                     const char *format, ...) __attribute__((format(printf, 5, 6)));

/// What of the same file has been unpacked, and is still held, from how many bytes: until it is set to 0, 0 again,
/// ewa_memory_check_unpacked() counts it with what comes. So many small pictures are bounded as one large one is.
void ewa_memory_unpacked_before(ewa_context *context, uint64_t packed_bytes, uint64_t bytes);

#endif
