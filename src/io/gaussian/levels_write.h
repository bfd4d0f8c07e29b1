// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Levels of Gaussians as streamed SOG, of Gaussians that come one after the other along the Morton curve (sog_streamed_write.c).
#ifndef EWA_SRC_GAUSSIAN_LEVELS_WRITE_H
#define EWA_SRC_GAUSSIAN_LEVELS_WRITE_H

#include "io/gaussian/save.h"

typedef struct ewa_levels_writer ewa_levels_writer;

/// Opens a writer of lod-meta.json at `target`, which stays as long as it. Of the target's set the count, the degree, the origin and the filter
/// are needed, no streams. Close it with ewa_levels_writer_close(), also after a failure. Errors: EWA_ERROR_UNSUPPORTED (2D Gaussians), EWA_ERROR_MEMORY.
ewa_status ewa_levels_writer_open(const ewa_gaussian_target *target, ewa_levels_writer **writer);

/// Takes the next Gaussians along the curve, of which `order` has the numbers in `set`; `*taken` says how many of them, as many as whole
/// leaves have: the others have to come again, first. Errors: EWA_ERROR_IO, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_levels_writer_add(ewa_levels_writer *writer, const ewa_gaussians *set, const uint32_t *order, uint32_t count, uint32_t *taken);

/// Writes lod-meta.json when all were taken, and gives the files their names, but for that of `target`. Errors: EWA_ERROR_IO, EWA_ERROR_MEMORY.
ewa_status ewa_levels_writer_finish(ewa_levels_writer *writer);

/// Closes a writer, whose files are gone unless it was finished; sets `*writer` to NULL; accepts a pointer to NULL.
void ewa_levels_writer_close(ewa_levels_writer **writer);

/// Writes the levels of a file, a binary PLY of Gaussians with centres in floats, of which a part is in memory at a time (levels_file.c); `*count` gets how
/// many there are, 0 where it is another file, of which nothing is written. Errors: as ewa_gaussians_load() and ewa_gaussians_save().
ewa_status ewa_gaussians_write_file_levels(ewa_context *context, const char *from, const char *to, const ewa_gaussians_save_options *options,
                                           uint64_t *count);

#endif
