// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volume files: the format by content, and the files that a header names.
#include "io/volume/file.h"
#include "base/base.h"
#include "base/options.h"
#include "ewa/io.h"
#include "ewa/model.h"
#include "io/number.h"
#include "io/reader.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define AT(member) offsetof(ewa_volume_load_options, member)

static const ewa_option option_rows[] = {
    {"dims", EWA_OPTION_U32, AT(dims), 0, UINT32_MAX, .count = 3,
     .help = "of raw numbers: how many along each axis, x fastest; 0: as the file says"},
    {"big_endian", EWA_OPTION_BOOL, AT(big_endian), .help = "raw numbers have their highest byte first"},
    {"header_bytes", EWA_OPTION_U64, AT(header_bytes), 0, INFINITY, EWA_OPTION_BELOW,
     .help = "bytes in front of raw numbers"},
    {"spacing_world", EWA_OPTION_F64, AT(spacing_world), 0, INFINITY, EWA_OPTION_BELOW, 3, .unit = "world",
     .help = "distances of the voxels along each axis; 0: as the file says, else 1"},
};

const ewa_option_table ewa_volume_load_options_table = EWA_OPTION_TABLE(ewa_volume_load_options, option_rows);

void ewa_volume_load_options_init(ewa_volume_load_options *options, size_t struct_size) {
    ewa_options_init(&ewa_volume_load_options_table, options, struct_size);
    if (options && struct_size >= AT(type) + sizeof options->type) options->type = -1;
}

bool ewa_volume_is_named(const char *path) {
    static const char *const suffixes[] = {".nrrd", ".nhdr",   ".nii", ".nii.gz", ".mha",
                                           ".mhd",  ".raw",    ".vti", ".vtk",    ".raw.gz",
                                           ".img",  ".img.gz", ".hdr", ".hdr.gz"};
    const size_t length = path ? strlen(path) : 0;
    for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++) {
        const size_t suffix = strlen(suffixes[i]);
        if (length > suffix && strcasecmp(path + length - suffix, suffixes[i]) == 0) return true;
    }
    return false;
}

bool ewa_volume_is_file(ewa_context *context, const char *path) {
    if (!ewa_volume_is_named(path)) return false;
    ewa_model_format format = EWA_MODEL_UNKNOWN;
    const size_t length = strlen(path);
    // What cannot be opened is said by who reads it.
    return strcasecmp(path + length - 4, ".vtk") != 0 || !ewa_file_may_read(context, path) ||
           ewa_model_probe(context, path, &format) != EWA_OK || format != EWA_MODEL_VTK;
}

static ewa_status parse(const ewa_volume_input *in, const ewa_volume_load_options *options,
                        ewa_volume_header *header) {
    if (options->dims[0] || options->dims[1] || options->dims[2]) return ewa_raw_parse(in, options, header);
    // Headers that are text may stand behind a byte order mark.
    ewa_volume_input text = *in;
    const uint32_t mark = ewa_bytes_mark(in->bytes, in->size_bytes);
    if (mark) text.bytes += mark, text.size_bytes -= mark;
    if (ewa_nrrd_recognise(text.bytes, text.size_bytes)) return ewa_nrrd_parse(&text, header);
    if (ewa_vtk_recognise(text.bytes, text.size_bytes)) return ewa_vtk_parse(&text, header);
    if (ewa_vti_recognise(text.bytes, text.size_bytes)) return ewa_vti_parse(&text, header);
    if (ewa_meta_recognise(text.bytes, text.size_bytes)) return ewa_meta_parse(&text, header);
    bool nifti;
    EWA_TRY(ewa_nifti_recognise(in, &nifti));
    return nifti ? ewa_nifti_parse(in, header) : ewa_raw_parse(in, options, header);
}

static ewa_status load(const ewa_volume_input *in, const ewa_volume_load_options *options,
                       ewa_volume *volume) {
    ewa_volume_load_options chosen;
    ewa_volume_load_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(in->context, &ewa_volume_load_options_table, options, &chosen));
    ewa_volume_header header;
    ewa_volume_header_init(&header);
    ewa_status status = parse(in, &chosen, &header);
    if (status == EWA_OK) status = ewa_volume_decode(in, &header, chosen.spacing_world, volume);
    ewa_volume_free_pieces(in->context, &header.pieces);
    return status;
}

ewa_status ewa_volume_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                  const char *name, const ewa_volume_load_options *options,
                                  ewa_volume *volume) {
    if (!context || !name || !volume || (!bytes && size_bytes)) return EWA_ERROR_ARGUMENT;
    *volume = (ewa_volume){0};
    const ewa_volume_input in = {.context = context, .name = name, .bytes = bytes, .size_bytes = size_bytes};
    return load(&in, options, volume);
}

ewa_status ewa_volume_load(ewa_context *context, const char *path, const ewa_volume_load_options *options,
                           ewa_volume *volume) {
    if (!context || !path || !volume) return EWA_ERROR_ARGUMENT;
    *volume = (ewa_volume){0};
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    const bool piped = strcmp(path, "-") == 0;
    const ewa_volume_input in = {.context = context,
                                 .name = piped ? "standard input" : path,
                                 .path = piped ? NULL : path,
                                 .bytes = file.bytes,
                                 .size_bytes = file.size_bytes};
    ewa_status status = load(&in, options, volume);
    ewa_file_unmap(context, &file);
    return status;
}
