// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files on servers (http, https), of which parts are read and kept for a while: a file is looked at by several readers in turn,
// and what was seen is seen again.
#ifndef EWA_SRC_REMOTE_H
#define EWA_SRC_REMOTE_H

#include "io/ranges.h"

/// An open file on a server. All calls come on the thread that uses the context.
typedef struct ewa_remote_file ewa_remote_file;

/// Whether a path is an address of http or https.
bool ewa_remote_is(const char *path);

/// Opens a file on a server, of which it reads the begin; a file that was opened a moment before is not asked for again. Errors,
/// "ADDRESS: reason": EWA_ERROR_IO, EWA_ERROR_LIMIT, EWA_ERROR_UNSUPPORTED (no libcurl; an untrusted context; a user's name in the
/// address), EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_remote_open(ewa_context *context, const char *path, ewa_remote_file **file);
void ewa_remote_close(ewa_remote_file **file);

uint64_t ewa_remote_size_bytes(const ewa_remote_file *file);

/// Reads parts of the file, which lie within it, to where each `to` is, several at a time. Errors as ewa_remote_open(), also where the
/// file has become another one.
ewa_status ewa_remote_read(ewa_remote_file *file, const ewa_range *parts, uint8_t *const *to, uint32_t count);

#endif
