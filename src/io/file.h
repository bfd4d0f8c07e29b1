// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whole files in, whole files out: every format of this room reads from one block of bytes and writes through
// one writer, so that the messages of the operating system and the promise "whole or not at all" live in one
// place.
#ifndef EWA_SRC_FILE_H
#define EWA_SRC_FILE_H

#include "ewa/base.h"

/// The bytes of a file, read only. Zero-initialised means: nothing held.
typedef struct ewa_file {
    const uint8_t *bytes;
    size_t size_bytes;
    size_t capacity_bytes;       ///< of the memory behind `bytes`
    bool mapped;                 ///< true: a view of the page cache, false: memory of the context's allocator
    size_t hole_first, hole_end; ///< bytes that were given up, whose addresses may be others' now
} ewa_file;

enum { EWA_FILE_HEAD_BYTES = 512 }; ///< by which kinds of files are told

/// A file of the caller's whose bytes stay while it is not mapped.
typedef struct ewa_kept_file {
    struct ewa_kept_file *outer; ///< that was kept before, by the loading that this one is within; NULL: none
    const char *path;
    ewa_file file;
    bool mapped;
    size_t head_bytes; ///< 0: its head was not read yet
    uint8_t head[EWA_FILE_HEAD_BYTES];
} ewa_kept_file;

/// Makes all bytes of a file readable: a regular file is mapped, anything else ("-": standard input, pipes)
/// is read to its end, at most max_memory_bytes of the context's limits. Release with ewa_file_unmap(). A
/// mapped file must not be cut short by others meanwhile: the system answers reads past the new end with
/// SIGBUS. Errors, with the message "PATH: reason": EWA_ERROR_IO, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_file_map(ewa_context *context, const char *path, ewa_file *file);

/// The same for a regular file that is open, at its begin; false, without a report, when it cannot be read.
/// An empty file has no bytes and is held by nothing.
bool ewa_file_map_descriptor(ewa_context *context, int descriptor, ewa_file *file);

/// Makes all bytes of a file of the caller's readable (ewa_context_options.open_file); false, with EWA_OK, where it is none of these.
/// Errors: those of ewa_ranges_read(), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
bool ewa_file_map_source(ewa_context *context, const char *path, ewa_file *file, ewa_status *status);

/// Returns whether a path is a file of the caller's.
bool ewa_file_is_source(ewa_context *context, const char *path);

/// Returns whether a path is a regular file that may be read, or one of the caller's.
bool ewa_file_may_read(ewa_context *context, const char *path);

/// Between these two, the file at `path`, if it is one of the caller's, stays when it is unmapped, so that what finds out what it is
/// and what reads it then get it by one reading. It is not mapped when they end.
/// Pairs nest.
void ewa_file_keep_begin(ewa_context *context, ewa_kept_file *kept, const char *path);
void ewa_file_keep_end(ewa_context *context, ewa_kept_file *kept);

/// Reads the first bytes of a regular file, as many as there is room for, at most EWA_FILE_HEAD_BYTES, and returns how many; 0
/// where it is none or cannot be read, which is not reported. Without a context, of files of the operating system.
size_t ewa_file_head(ewa_context *context, const char *path, uint8_t *bytes, size_t room);

/// Lets the first pages of a mapped file, up to byte `at_bytes`, leave memory; they come back when read.
void ewa_file_passed(const uint8_t *bytes, uint64_t at_bytes);

/// Gives up bytes [from, to) of a mapped file, which are not to be read any more, so that they take no room among
/// addresses, where the system can give up a part; ewa_file_piece_map() reads from them again. Once for a file.
void ewa_file_give_up(ewa_file *file, uint64_t from, uint64_t to);

/// Opens a file again whose pieces are to be mapped; -1 where that cannot be, or it is not of that size.
int ewa_file_open_pieces(const char *path, uint64_t size_bytes);

/// Maps bytes [at, at + size_bytes) of an open file; false, without a report, when that cannot be. Any thread.
bool ewa_file_piece_map(int descriptor, uint64_t at_bytes, size_t size_bytes, ewa_file *piece,
                        const uint8_t **bytes);

/// Gives the bytes back and clears `*file`; accepts a cleared one.
void ewa_file_unmap(ewa_context *context, ewa_file *file);

/// One output file that is being written.
typedef struct ewa_writer ewa_writer;

/// Starts an output file. The bytes go to a new file in the folder of `path` that takes its name on commit, and has none
/// before where the system can, so that nothing is left of it when the process is killed;
/// the permissions are those of the file that is replaced, or what the umask allows. A symbolic link is
/// followed; one that leads nowhere is refused, for it is not to be replaced, nor to choose where a new file lies.
/// "-" and "/dev/stdout" are standard output; what exists and is no regular file (a device, a pipe) is
/// written directly, since there is nothing to rename. Errors, with the message "PATH: reason": EWA_ERROR_IO,
/// EWA_ERROR_MEMORY; `*writer` is then NULL.
ewa_status ewa_writer_open(ewa_context *context, const char *path, ewa_writer **writer);

/// Appends bytes, collecting small pieces. After a failure, which is reported once, does nothing and returns
/// the same status.
ewa_status ewa_writer_put(ewa_writer *writer, const void *data, size_t size_bytes);

/// Overwrites bytes that were appended before, from byte `at_bytes` of the file on. Fails with EWA_ERROR_IO
/// where the file is standard output, a pipe or a device (ewa_writer_can_patch()).
ewa_status ewa_writer_patch(ewa_writer *writer, uint64_t at_bytes, const void *data, size_t size_bytes);
bool ewa_writer_can_patch(const ewa_writer *writer);

/// Returns how many bytes were appended so far.
uint64_t ewa_writer_size(const ewa_writer *writer);

/// Finishes the file, gives it its name and frees the writer; after an earlier failure, or one now, the file
/// is removed instead and the failure returned. Sets `*writer` to NULL.
ewa_status ewa_writer_commit(ewa_writer **writer);

/// Removes what was written and frees the writer. Sets `*writer` to NULL; accepts a pointer to NULL.
void ewa_writer_abort(ewa_writer **writer);

#endif
