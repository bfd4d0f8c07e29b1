// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volume files, inner side: every format is a header, which says how the voxels are stored, and bytes, which
// are unpacked and converted in one place.
#ifndef EWA_SRC_VOLUME_FILE_H
#define EWA_SRC_VOLUME_FILE_H

#include "ewa/io.h"
#include "ewa/volume.h"
#include "io/file.h"
#include "io/source.h"

/// Types of numbers in files: those of ewa_type, and two more.
enum { EWA_FILE_I64 = EWA_U32 + 1, EWA_FILE_U64 = EWA_U32 + 2 };

size_t ewa_file_number_bytes(int number);
/// In words, for messages.
const char *ewa_file_number_name(int number);

enum { EWA_VOLUME_MAX_FILES = 65536, EWA_VOLUME_NAME_BYTES = 512 };

/// Where the bytes of the voxels are: `count` files or parts of memory, which hold equal shares.
typedef struct ewa_volume_pieces {
    ewa_file *files; ///< of which bytes and size_bytes count; the memory is theirs when `detached`
    size_t count, capacity;
    bool detached;
} ewa_volume_pieces;

/// What the header of a volume file says.
typedef struct ewa_volume_header {
    uint64_t dims[3];         ///< x fastest
    uint32_t component_count; ///< numbers per voxel side by side: 1, or 3 and 4 of a colour
    int number;               ///< type of the numbers: ewa_type or EWA_FILE_*; -1: not said
    bool big_endian;
    ewa_packing packing;
    uint64_t skipped_lines; ///< of each piece, before it is unpacked
    uint64_t skipped_bytes; ///< of each piece, unpacked
    bool at_end;            ///< the voxels are the last bytes of each piece, which is not packed
    bool exact;             ///< bytes beyond the voxels contradict the header
    double slope, intercept;
    double directions[3][3]; ///< world steps from voxel to voxel along each axis
    uint32_t axis_count;     ///< those that the file has; the steps of the others are to choose
    double first_world[3];   ///< the first voxel's centre
    bool placed;             ///< first_world is said; else the middle goes to the origin
    bool anatomical;         ///< of ewa_volume
    ewa_volume_pieces pieces;
} ewa_volume_header;

/// What a parser works on: the whole file, and where files that it names are looked for.
typedef struct ewa_volume_input {
    ewa_context *context;
    const char *name; ///< for messages
    const char *path; ///< NULL: from memory, which can name no files
    const uint8_t *bytes;
    size_t size_bytes;
} ewa_volume_input;

/// Reports "NAME: FORMAT: what" and returns `status`.
ewa_status ewa_volume_fail(const ewa_volume_input *in, ewa_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// A header with nothing said: unit steps, numbers as they are.
void ewa_volume_header_init(ewa_volume_header *header);

/// Adds bytes of the input's own memory.
ewa_status ewa_volume_add_bytes(const ewa_volume_input *in, const uint8_t *bytes, size_t size_bytes,
                                ewa_volume_pieces *pieces);
/// Adds memory of the context's allocator, which becomes the pieces'; it is freed when that fails.
ewa_status ewa_volume_add_memory(const ewa_volume_input *in, uint8_t *bytes, size_t size_bytes,
                                 ewa_volume_pieces *pieces);
/// Adds a file that is named relative to the input's folder; it must be a regular file.
ewa_status ewa_volume_add_file(const ewa_volume_input *in, const char *file_name, ewa_volume_pieces *pieces);
/// Whether there is a file of that name.
bool ewa_volume_has_file(const ewa_volume_input *in, const char *file_name);
/// Adds the files of "PATTERN FIRST LAST STEP", where PATTERN has one %d, %3d or %03d.
ewa_status ewa_volume_add_pattern(const ewa_volume_input *in, const char *text, ewa_volume_pieces *pieces);
/// Adds a file for each line of a text.
ewa_status ewa_volume_add_list(const ewa_volume_input *in, const char *text, const char *end,
                               ewa_volume_pieces *pieces);
void ewa_volume_free_pieces(ewa_context *context, ewa_volume_pieces *pieces);

/// The parsers. Each fills a header that ewa_volume_header_init() has made; pieces are freed by the caller
/// whatever comes back.
bool ewa_nrrd_recognise(const uint8_t *bytes, size_t size_bytes);
ewa_status ewa_nrrd_parse(const ewa_volume_input *in, ewa_volume_header *header);
/// Looks into gzip too, which may fail.
ewa_status ewa_nifti_recognise(const ewa_volume_input *in, bool *is_nifti);
ewa_status ewa_nifti_parse(const ewa_volume_input *in, ewa_volume_header *header);
bool ewa_meta_recognise(const uint8_t *bytes, size_t size_bytes);
ewa_status ewa_meta_parse(const ewa_volume_input *in, ewa_volume_header *header);
bool ewa_vtk_recognise(const uint8_t *bytes, size_t size_bytes);
ewa_status ewa_vtk_parse(const ewa_volume_input *in, ewa_volume_header *header);
bool ewa_vti_recognise(const uint8_t *bytes, size_t size_bytes);
ewa_status ewa_vti_parse(const ewa_volume_input *in, ewa_volume_header *header);
ewa_status ewa_raw_parse(const ewa_volume_input *in, const ewa_volume_load_options *options,
                         ewa_volume_header *header);

/// Makes the volume that a header and its pieces describe; `spacing_world` (0: as it is) replaces the lengths
/// of the steps.
ewa_status ewa_volume_decode(const ewa_volume_input *in, const ewa_volume_header *header,
                             const double spacing_world[3], ewa_volume *volume);

#endif
