// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small volume files in memory, one of each format, that all hold the same 2 x 3 x 4 voxels: 0, 1, 2, ... 23.
#ifndef EWA_TESTS_VOLUME_SAMPLE_H
#define EWA_TESTS_VOLUME_SAMPLE_H

#include "scratch.h"

#include <libdeflate.h>

enum { SAMPLE_VOXELS = 24, SAMPLE_ROOM = 4096 };

typedef struct sample_file {
    uint8_t bytes[SAMPLE_ROOM];
    size_t size_bytes;
} sample_file;

static inline void sample_put(sample_file *file, const void *bytes, size_t size_bytes) {
    assert_true(file->size_bytes + size_bytes <= SAMPLE_ROOM);
    memcpy(file->bytes + file->size_bytes, bytes, size_bytes);
    file->size_bytes += size_bytes;
}

static inline void sample_text(sample_file *file, const char *text) { sample_put(file, text, strlen(text)); }

/// The voxels as numbers of one to eight bytes, integers or floats.
static inline size_t sample_numbers(ewa_type type, bool big_endian, uint8_t numbers[8 * SAMPLE_VOXELS]) {
    const size_t size = ewa_type_bytes(type);
    for (int i = 0; i < SAMPLE_VOXELS; i++) {
        uint64_t bits = (uint64_t)i;
        const float f = (float)i;
        const double d = i;
        if (type == EWA_F32) {
            uint32_t word;
            memcpy(&word, &f, 4);
            bits = word;
        }
        if (type == EWA_F64) memcpy(&bits, &d, 8);
        for (size_t b = 0; b < size; b++)
            numbers[size * (size_t)i + (big_endian ? size - 1 - b : b)] = (uint8_t)(bits >> 8 * b);
    }
    return size * SAMPLE_VOXELS;
}

static inline void sample_put_numbers(sample_file *file, ewa_type type, bool big_endian) {
    uint8_t numbers[8 * SAMPLE_VOXELS];
    sample_put(file, numbers, sample_numbers(type, big_endian, numbers));
}

/// Appends bytes packed as gzip or zlib.
static inline void sample_put_packed(sample_file *file, bool gzip, const uint8_t *bytes, size_t size_bytes) {
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
    uint8_t packed[SAMPLE_ROOM];
    const size_t packed_bytes =
        gzip ? libdeflate_gzip_compress(compressor, bytes, size_bytes, packed, sizeof packed)
             : libdeflate_zlib_compress(compressor, bytes, size_bytes, packed, sizeof packed);
    assert_true(packed_bytes > 0);
    sample_put(file, packed, packed_bytes);
    libdeflate_free_compressor(compressor);
}

/// NRRD of unsigned bytes with further fields.
static inline void sample_nrrd(const char *fields, sample_file *file) {
    file->size_bytes = 0;
    sample_text(file, "NRRD0004\n# a comment\nkey:=value\ntype: uchar\ndimension: 3\nsizes: 2 3 4\n");
    sample_text(file, fields);
    sample_text(file, "\n");
}

static inline void sample_store(uint8_t *at, bool big_endian, size_t size, uint64_t bits) {
    for (size_t b = 0; b < size; b++) at[big_endian ? size - 1 - b : b] = (uint8_t)(bits >> 8 * b);
}

static inline void sample_store_real(uint8_t *at, bool big_endian, bool wide, double value) {
    const float narrow = (float)value;
    uint64_t bits = 0;
    uint32_t word;
    memcpy(&word, &narrow, 4);
    memcpy(&bits, &value, 8);
    sample_store(at, big_endian, wide ? 8 : 4, wide ? bits : word);
}

/// A header of NIfTI-1 or -2 for shorts, with steps of 2, 3 and 4 and neither qform nor sform.
static inline void sample_nifti_head(bool second, bool big_endian, const char *magic, sample_file *file) {
    memset(file->bytes, 0, SAMPLE_ROOM);
    uint8_t *h = file->bytes;
    static const uint64_t dims[] = {3, 2, 3, 4, 1, 1, 1, 1};
    static const double steps[] = {1, 2, 3, 4, 1, 1, 1, 1};
    file->size_bytes = second ? 544 : 352;
    sample_store(h, big_endian, 4, second ? 540 : 348);
    memcpy(h + (second ? 4 : 344), magic, 4);
    for (size_t i = 0; i < 8; i++) {
        sample_store(h + (second ? 16 + 8 * i : 40 + 2 * i), big_endian, second ? 8 : 2, dims[i]);
        sample_store_real(h + (second ? 104 + 8 * i : 76 + 4 * i), big_endian, second, steps[i]);
    }
    sample_store(h + (second ? 12 : 70), big_endian, 2, 4);
    sample_store(h + (second ? 14 : 72), big_endian, 2, 16);
    if (second)
        sample_store(h + 168, big_endian, 8, 544);
    else
        sample_store_real(h + 108, big_endian, false, 352);
}

/// One whole file of each format; returns its name, NULL beyond the last.
static inline const char *sample_make(int which, sample_file *file) {
    uint8_t numbers[8 * SAMPLE_VOXELS];
    const size_t bytes = sample_numbers(EWA_U8, false, numbers);
    file->size_bytes = 0;
    switch (which) {
    case 0:
        sample_nrrd("encoding: raw\n", file);
        sample_put_numbers(file, EWA_U8, false);
        return "a.nrrd";
    case 1:
        sample_nrrd("encoding: gzip\n", file);
        sample_put_packed(file, true, numbers, bytes);
        return "b.nrrd";
    case 2:
        sample_nrrd("encoding: txt\n", file);
        for (int i = 0; i < SAMPLE_VOXELS; i++) {
            char word[16];
            snprintf(word, sizeof word, i % 5 ? "%d " : "%d\n", i);
            sample_text(file, word);
        }
        // So that a cut within the last number is seen.
        file->size_bytes--;
        sample_text(file, "\n");
        return "c.nrrd";
    case 3:
        sample_nrrd("encoding: hex\n", file);
        for (int i = 0; i < SAMPLE_VOXELS; i++) {
            char word[8];
            snprintf(word, sizeof word, i % 5 ? "%02x" : "%02X\n", (unsigned)i);
            sample_text(file, word);
        }
        return "d.nrrd";
    case 4:
        sample_nifti_head(false, false, "n+1", file);
        sample_put_numbers(file, EWA_I16, false);
        return "e.nii";
    case 5:
        sample_nifti_head(true, true, "n+2", file);
        memcpy(file->bytes + 8, "\r\n\032\n", 4);
        sample_put_numbers(file, EWA_I16, true);
        return "f.nii";
    case 6:
        sample_text(file, "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\n"
                          "CompressedData = True\nElementDataFile = LOCAL\n");
        sample_put_packed(file, false, numbers, bytes);
        return "g.mha";
    case 7:
        sample_text(file, "# vtk DataFile Version 3.0\ntitle\nBINARY\nDATASET STRUCTURED_POINTS\n"
                          "DIMENSIONS 2 3 4\nSPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 24\n"
                          "SCALARS s unsigned_char\nLOOKUP_TABLE default\n");
        sample_put_numbers(file, EWA_U8, false);
        return "h.vtk";
    case 8:
        sample_text(file, "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt32\">"
                          "<ImageData WholeExtent=\"0 1 0 2 0 3\" Origin=\"0 0 0\" Spacing=\"1 1 1\">"
                          "<Piece Extent=\"0 1 0 2 0 3\"><PointData><DataArray type=\"UInt8\" "
                          "format=\"appended\" offset=\"0\"/></PointData></Piece></ImageData>"
                          "<AppendedData encoding=\"raw\">_");
        sample_put(file, "\x18\0\0\0", 4);
        sample_put_numbers(file, EWA_U8, false);
        return "i.vti";
    case 9:
        sample_put_packed(file, true, numbers, bytes);
        return "j_2x3x4_uint8.raw.gz";
    default:
        return NULL;
    }
}

/// Loads from exactly as many bytes as there are, so that a sanitizer sees the first one too many.
static inline ewa_status sample_load(ewa_context *context, const sample_file *file, size_t size_bytes,
                                     const char *name, const ewa_volume_load_options *options,
                                     ewa_volume *volume) {
    uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    memcpy(copy, file->bytes, size_bytes);
    const ewa_status status = ewa_volume_load_memory(context, copy, size_bytes, name, options, volume);
    free(copy);
    return status;
}

/// Whether a volume holds 0, 1, 2, ... 23 in 2 x 3 x 4 voxels.
static inline void sample_check(const ewa_volume *volume) {
    assert_true(volume->dims[0] == 2 && volume->dims[1] == 3 && volume->dims[2] == 4);
    for (int i = 0; i < SAMPLE_VOXELS; i++) {
        double value = -1;
        switch (volume->type) {
        case EWA_U8:
            value = ((const uint8_t *)volume->voxels)[i];
            break;
        case EWA_I8:
            value = ((const int8_t *)volume->voxels)[i];
            break;
        case EWA_U16:
            value = ((const uint16_t *)volume->voxels)[i];
            break;
        case EWA_I16:
            value = ((const int16_t *)volume->voxels)[i];
            break;
        case EWA_F32:
            value = (double)((const float *)volume->voxels)[i];
            break;
        default:
            fail_msg("type %d", volume->type);
        }
        assert_true(value == i);
    }
}

#endif
