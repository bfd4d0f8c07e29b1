// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes as NRRD.
#include "base/base.h"
#include "base/options.h"
#include "ewa/io.h"
#include "io/deflate.h"
#include "io/file.h"
#include "io/number.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { GZIP_LEVEL = 6, HEAD_BYTES = 1024, TRIPLE_BYTES = 3 * EWA_NUMBER_BYTES + 8 };

#define AT(member) offsetof(ewa_volume_save_options, member)

static const ewa_option option_rows[] = {
    {"plain", EWA_OPTION_BOOL, AT(plain), .help = "not compressed"},
};

const ewa_option_table ewa_volume_save_options_table = EWA_OPTION_TABLE(ewa_volume_save_options, option_rows);

void ewa_volume_save_options_init(ewa_volume_save_options *options, size_t struct_size) {
    ewa_options_init(&ewa_volume_save_options_table, options, struct_size);
}

/// "(a,b,c)" from every fourth number.
static const char *triple(const double *numbers, char text[TRIPLE_BYTES]) {
    char words[3][EWA_NUMBER_BYTES];
    for (int k = 0; k < 3; k++) {
        const size_t length = ewa_number_write_f64(numbers[4 * k], words[k]);
        words[k][length] = 0;
    }
    snprintf(text, TRIPLE_BYTES, "(%s,%s,%s)", words[0], words[1], words[2]);
    return text;
}

static const char *type_word(ewa_type type) {
    switch (type) {
    case EWA_U8:
        return "uint8";
    case EWA_I8:
        return "int8";
    case EWA_U16:
        return "uint16";
    case EWA_I16:
        return "int16";
    default:
        return "float";
    }
}

static ewa_status put_header(const ewa_volume *volume, bool plain, ewa_writer *writer) {
    char head[HEAD_BYTES], steps[3][TRIPLE_BYTES], origin[TRIPLE_BYTES];
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    for (int axis = 0; axis < 3; axis++) triple(volume->index_to_world + axis, steps[axis]);
    const int length = snprintf(head, sizeof head,
                                "NRRD0004\ntype: %s\ndimension: 3\nspace: left-posterior-superior\n"
                                "sizes: %u %u %u\nspace directions: %s %s %s\nkinds: domain domain domain\n"
                                "endian: %s\nencoding: %s\nspace origin: %s\n\n",
                                type_word(volume->type), volume->dims[0], volume->dims[1], volume->dims[2],
                                steps[0], steps[1], steps[2], first ? "little" : "big",
                                plain ? "raw" : "gzip", triple(volume->index_to_world + 3, origin));
    return ewa_writer_put(writer, head, (size_t)length);
}

/// Packs the voxels as one gzip stream.
static ewa_status put_packed(const ewa_volume *volume, size_t size_bytes, ewa_writer *writer) {
    ewa_deflated packed;
    EWA_TRY(ewa_deflate(volume->context, EWA_DEFLATE_GZIP, GZIP_LEVEL, volume->voxels, size_bytes, &packed));
    const ewa_status status = ewa_writer_put(writer, packed.bytes, packed.size_bytes);
    ewa_deflated_free(volume->context, &packed);
    return status;
}

ewa_status ewa_volume_save(const ewa_volume *volume, const char *path,
                           const ewa_volume_save_options *options) {
    if (!volume || !volume->voxels || !path) return EWA_ERROR_ARGUMENT;
    ewa_volume_save_options chosen;
    ewa_volume_save_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(volume->context, &ewa_volume_save_options_table, options, &chosen));
    const size_t length = strlen(path);
    if (strcmp(path, "-") != 0 && (length < 6 || strcasecmp(path + length - 5, ".nrrd") != 0))
        return ewa_fail(volume->context, EWA_ERROR_UNSUPPORTED, "%s: the suffix of a volume is .nrrd", path);
    const size_t size_bytes =
        (size_t)volume->dims[0] * volume->dims[1] * volume->dims[2] * ewa_type_bytes(volume->type);
    ewa_writer *writer;
    EWA_TRY(ewa_writer_open(volume->context, path, &writer));
    ewa_status status = put_header(volume, chosen.plain, writer);
    if (status == EWA_OK)
        status = chosen.plain ? ewa_writer_put(writer, volume->voxels, size_bytes)
                              : put_packed(volume, size_bytes, writer);
    if (status == EWA_OK) return ewa_writer_commit(&writer);
    ewa_writer_abort(&writer);
    return status;
}
