// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files whose bytes the caller of the library has (ewa_context_options.open_file), and files on servers: read as a whole, or part by part when a
// part is asked for, so that of a file behind a network only what is seen comes over it.
#ifndef EWA_SRC_RANGES_H
#define EWA_SRC_RANGES_H

#include "ewa/base.h"

/// An open file of which parts are held. The calls of its source come on the thread that calls these functions.
typedef struct ewa_ranges ewa_ranges;

/// Opens a file of the caller's, or one on a server; `*ranges` is NULL where the path is none of those. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_ARGUMENT (a source without read_at), those of ewa_remote_open().
ewa_status ewa_ranges_open(ewa_context *context, const char *path, ewa_ranges **ranges);

/// Closes it, gives back what is held, and sets `*ranges` to NULL; accepts a pointer to NULL.
void ewa_ranges_close(ewa_ranges **ranges);

uint64_t ewa_ranges_size_bytes(const ewa_ranges *ranges);

/// Whether the file is on a server.
bool ewa_ranges_are_remote(const ewa_ranges *ranges);

/// Reads bytes [at, at + size) to `to`. Errors, with the message "PATH: bytes FROM to TO ...": EWA_ERROR_IO, also for what lies beyond
/// the file, EWA_CANCELLED.
ewa_status ewa_ranges_read(ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes, uint8_t *to);

/// Reads bytes [at, at + size) to memory of its own, which ewa_release() gives back. Errors: as ewa_ranges_read(), EWA_ERROR_MEMORY.
ewa_status ewa_ranges_take(ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes, uint8_t **bytes);

/// Makes `*bytes` point to bytes [at, at + size), read with some that follow unless they are held already; they stay until
/// ewa_ranges_let_go(). Errors: as ewa_ranges_read(), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_ranges_need(ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes, const uint8_t **bytes);

/// A part of a file.
typedef struct ewa_range {
    uint64_t at_bytes, size_bytes;
} ewa_range;

/// Reads many parts, those that lie near each other at once; sorts and joins `parts`. Errors as ewa_ranges_need().
ewa_status ewa_ranges_need_all(ewa_ranges *ranges, ewa_range *parts, uint32_t count);

/// Returns where bytes [at, at + size) are held; NULL: they are not. Any thread, while nothing else is called.
const uint8_t *ewa_ranges_find(const ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes);

/// Counts what is held, and lets go of all that has come since it was `count`.
uint32_t ewa_ranges_count(const ewa_ranges *ranges);
void ewa_ranges_let_go(ewa_ranges *ranges, uint32_t count);

#endif
