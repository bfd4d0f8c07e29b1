// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rare formats of meshes, by a helper program: a process of its own, with limits of memory and time, that
// hands a mesh back as PLY, which is read like every other file.
#ifndef EWA_CLI_INPUT_IMPORT_H
#define EWA_CLI_INPUT_IMPORT_H

#include "cli/base/session.h"

/// What the helper may take.
typedef struct import_limits {
    double wall_s;         ///< from start to end
    uint32_t cpu_s;        ///< of the processor
    uint64_t memory_bytes; ///< of its address space
    uint64_t output_bytes; ///< that it hands back
    ewa_named_files named_files; ///< which files it opens beside
} import_limits;

/// Whether a name has a suffix of formats that only the helper reads.
bool import_is_named(const char *path);

/// Loads such a file; `wanted` as for ewa_model_load(). False after reporting, also when there is no helper.
bool import_load(cli_session *session, const char *path, uint32_t wanted, ewa_model *model);

/// Runs a helper on a file and collects what it hands back; `*bytes` is to be freed with free(). False after
/// reporting: it could not be started, said what is wrong, died, took too long, or gave too much.
bool import_run(cli_session *session, const char *helper, const char *path, const import_limits *limits,
                uint8_t **bytes, size_t *size_bytes);

#endif
