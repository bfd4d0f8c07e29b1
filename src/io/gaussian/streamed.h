// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Streamed SOG, of which a part is read at a time: what lod-meta.json says, and the files that it names.
#ifndef EWA_SRC_GAUSSIAN_STREAMED_H
#define EWA_SRC_GAUSSIAN_STREAMED_H

#include "io/gaussian/gaussian.h"

/// Gaussians of one level of a leaf, of which there are some.
typedef struct ewa_streamed_range {
    uint32_t level, file, offset, count;
} ewa_streamed_range;

/// A leaf of the tree.
typedef struct ewa_streamed_leaf {
    double low_world[3], high_world[3]; ///< what the file says of it; infinite where it says nothing
    uint32_t first, count;              ///< of ranges, the finest first; at least one
} ewa_streamed_leaf;

/// What lod-meta.json says; zeroed: nothing. Immutable once it is there.
typedef struct ewa_streamed {
    ewa_context *context;
    char *path;      ///< of lod-meta.json; NULL: there is none, and no file can be read
    char *name;      ///< that stands for it in messages
    uint32_t version;
    ewa_buffer ranges, leaves;
    uint32_t range_count, leaf_count;
    ewa_buffer names;      ///< the files' names, each with a zero behind it
    ewa_buffer name_first; ///< [file_count] where in `names` that of each begins
    size_t names_bytes;
    uint32_t file_count;
    bool environment; ///< the last file has what belongs to no leaf
} ewa_streamed;

/// Reads lod-meta.json alone. The caller frees `*streamed`, which is zeroed after a failure. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED
/// (another version), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_streamed_open(const ewa_gaussian_source *source, ewa_streamed *streamed);
/// The same of a file, or a folder that holds one; another form is left as it is, with `streamed->context` NULL (gaussian_file.c).
ewa_status ewa_streamed_open_file(ewa_context *context, const char *path, ewa_streamed *streamed);
void ewa_streamed_free(ewa_streamed *streamed);

/// The file that a range, or the environment, is in, as lod-meta.json spells it.
const char *ewa_streamed_file(const ewa_streamed *streamed, uint32_t file);

/// Reads a file of SOG beside lod-meta.json, by a context of the calling thread. The caller frees the set. Errors: EWA_ERROR_IO,
/// EWA_ERROR_FORMAT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_streamed_read_file(ewa_context *context, const ewa_streamed *streamed, uint32_t file, ewa_gaussians *set);

/// Fails unless a file of `count` Gaussians has those of a range. Errors: EWA_ERROR_FORMAT.
ewa_status ewa_streamed_check(ewa_context *context, const ewa_streamed *streamed, const ewa_streamed_range *range, uint32_t count);

/// Copies some of a set, of at most the degree of the other, to where `*at` is in that, and moves it behind them.
void ewa_streamed_copy(const ewa_gaussians *from, size_t first, size_t count, ewa_gaussians *to, size_t *at);

/// Makes one set of the finest level of each leaf, or with `coarsest` of that, in the order of the leaves, and of the environment behind them. The caller frees
/// it. Errors: as ewa_streamed_read_file(); EWA_ERROR_FORMAT (leaves that take what a file has not, or twice).
ewa_status ewa_streamed_join(ewa_context *context, const ewa_streamed *streamed, bool coarsest, ewa_gaussians *set);

#endif
