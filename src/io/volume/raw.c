// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Raw numbers: what they are is said by options or by the name, as in the collections of the field
// (aneurism_256x256x256_uint8.raw.gz).
#include "base/base.h"
#include "base/platform.h"
#include "io/foreign.h"
#include "io/image/image_file.h"
#include "io/volume/file.h"
#include "io/volume/text.h"

enum { WORD_BYTES = 16 };

static const struct {
    const char *word;
    ewa_type type;
    bool big_endian;
} types[] = {
    {"uint8", EWA_U8, false},     {"uchar", EWA_U8, false},    {"u8", EWA_U8, false},
    {"int8", EWA_I8, false},      {"uint16", EWA_U16, false},  {"uint16le", EWA_U16, false},
    {"uint16be", EWA_U16, true},  {"ushort", EWA_U16, false},  {"u16", EWA_U16, false},
    {"int16", EWA_I16, false},    {"int16le", EWA_I16, false}, {"int16be", EWA_I16, true},
    {"short", EWA_I16, false},    {"i16", EWA_I16, false},     {"uint32", EWA_U32, false},
    {"int32", EWA_I32, false},    {"float32", EWA_F32, false}, {"float32le", EWA_F32, false},
    {"float32be", EWA_F32, true}, {"float", EWA_F32, false},   {"f32", EWA_F32, false},
    {"float64", EWA_F64, false},  {"double", EWA_F64, false},
};

/// Reads "NxNxN" at `text`, which must end there; NULL when it is none such.
static const char *read_dims(const char *text, uint64_t dims[3]) {
    const char *end = text + strlen(text);
    for (int axis = 0; axis < 3; axis++) {
        int64_t side;
        if (*text < '0' || *text > '9') return NULL;
        text = ewa_number_read_i64(text, end, &side);
        if (!text || side < 1 || side > UINT32_MAX) return NULL;
        dims[axis] = (uint64_t)side;
        if (axis < 2 && *text++ != 'x') return NULL;
    }
    return *text && strchr("_-. ", *text) ? text : NULL;
}

/// Takes dims and type from a name; returns whether it has dims.
static bool guess(const char *name, ewa_volume_header *header) {
    bool found = false;
    for (const char *at = ewa_platform_file_name(name); *at;) {
        char word[WORD_BYTES];
        const size_t length = strcspn(at, "_-. ");
        if (length < sizeof word) {
            memcpy(word, at, length);
            word[length] = 0;
            for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
                if (strcasecmp(types[i].word, word) != 0) continue;
                header->number = (int)types[i].type;
                header->big_endian = types[i].big_endian;
            }
        }
        found = read_dims(at, header->dims) || found;
        at += length + (at[length] != 0);
    }
    return found;
}

ewa_status ewa_raw_parse(const ewa_volume_input *in, const ewa_volume_load_options *options,
                         ewa_volume_header *header) {
    const bool told = options->dims[0] || options->dims[1] || options->dims[2];
    const bool guessed = guess(in->name, header);
    const char *picture = ewa_image_kind(in->bytes, in->size_bytes);
    if (!told && picture)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED,
                               "a picture (%s), which has no voxels", picture);
    const bool packed = in->size_bytes >= 2 && in->bytes[0] == 0x1f && in->bytes[1] == 0x8b; // raw numbers may be
    const char *kind = !told && !guessed && !packed ? ewa_foreign_kind(in->bytes, in->size_bytes) : NULL;
    if (kind) return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "%s", kind);
    if (!told && !guessed)
        return ewa_volume_fail(
            in, EWA_ERROR_FORMAT,
            "no volume: neither NRRD nor NIfTI nor MetaImage nor VTK by its first bytes; raw "
            "numbers need their dims");
    if (told)
        for (int axis = 0; axis < 3; axis++) header->dims[axis] = options->dims[axis];
    if (options->type >= 0) {
        if (options->type > EWA_U32)
            return ewa_volume_fail(in, EWA_ERROR_ARGUMENT, "voxels of type %d", options->type);
        header->number = options->type;
        header->big_endian = false;
    }
    const bool type_known = header->number >= 0;
    if (!type_known) header->number = EWA_U8;
    if (options->big_endian) header->big_endian = true;
    header->skipped_bytes = options->header_bytes;
    header->exact = true;
    if (packed) header->packing = EWA_PACKING_DEFLATE;
    if (!told || !type_known)
        ewa_report(in->context, EWA_SEVERITY_INFO, "%s: taken for %llu x %llu x %llu voxels of type %s%s",
                   in->name, (unsigned long long)header->dims[0], (unsigned long long)header->dims[1],
                   (unsigned long long)header->dims[2], ewa_file_number_name(header->number),
                   header->big_endian ? ", big endian" : "");
    return ewa_volume_add_bytes(in, in->bytes, in->size_bytes, &header->pieces);
}
