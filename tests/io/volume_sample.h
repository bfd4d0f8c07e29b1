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

/// Appends bytes as base64, padded.
static inline void sample_put_base64(sample_file *file, const uint8_t *bytes, size_t size_bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size_bytes; i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++) bits = bits << 8 | (i + k < size_bytes ? bytes[i + k] : 0);
        char four[4];
        for (size_t k = 0; k < 4; k++) four[k] = i + k > size_bytes ? '=' : digits[bits >> (18 - 6 * k) & 63];
        sample_put(file, four, 4);
    }
}

/// How the numbers of an XML image are stored.
typedef struct sample_vti_form {
    const char *root;    ///< attributes of VTKFile
    const char *array;   ///< of DataArray
    bool base64, packed; ///< in two blocks of 24 and 24 bytes
    bool wide, big_endian, appended;
    bool apart; ///< uncompressed: the size and the numbers are base64 texts of their own
} sample_vti_form;

/// Appends the sizes and the voxels, as shorts.
static inline void sample_put_array(sample_file *file, const sample_vti_form *form) {
    uint8_t numbers[8 * SAMPLE_VOXELS], head[64];
    const size_t bytes = sample_numbers(EWA_I16, form->big_endian, numbers), word = form->wide ? 8 : 4;
    sample_file data = {.size_bytes = 0};
    size_t head_bytes = word;
    if (form->packed) {
        uint64_t sizes[5] = {2, bytes / 2, 0};
        for (size_t half = 0; half < 2; half++) {
            const size_t before = data.size_bytes;
            sample_put_packed(&data, false, numbers + half * bytes / 2, bytes / 2);
            sizes[3 + half] = data.size_bytes - before;
        }
        head_bytes = 5 * word;
        for (size_t i = 0; i < 5; i++) sample_store(head + i * word, form->big_endian, word, sizes[i]);
    } else {
        sample_store(head, form->big_endian, word, bytes);
        sample_put(&data, numbers, bytes);
    }
    if (!form->base64) {
        sample_put(file, head, head_bytes);
        sample_put(file, data.bytes, data.size_bytes);
    } else if (form->packed || form->apart) {
        sample_put_base64(file, head, head_bytes);
        sample_put_base64(file, data.bytes, data.size_bytes);
    } else {
        sample_file both = {.size_bytes = 0};
        sample_put(&both, head, head_bytes);
        sample_put(&both, data.bytes, data.size_bytes);
        sample_put_base64(file, both.bytes, both.size_bytes);
    }
}

/// An XML image whose array is preceded by one that is not the active one.
static inline void sample_vti(const sample_vti_form *form, sample_file *file) {
    file->size_bytes = 0;
    sample_text(file, "<?xml version=\"1.0\"?>\n<!-- <VTKFile> -->\n<VTKFile type=\"ImageData\" ");
    sample_text(file, form->root);
    sample_text(file, ">\n <ImageData WholeExtent = '0 1 0 2 0 3' Origin=\"0 0 0\" Spacing=\"1 1 1\">\n"
                      "<FieldData><DataArray type=\"String\" format=\"ascii\">1</DataArray></FieldData>"
                      "<Piece Extent=\"0 1 0 2 0 3\"><PointData Scalars=\"the one\">"
                      "<DataArray type=\"Int8\" Name=\"other\" format=\"ascii\">5</DataArray>"
                      "<DataArray Name=\"the one\" ");
    sample_text(file, form->array);
    if (form->appended) {
        sample_text(file, "/></PointData></Piece></ImageData><AppendedData encoding=\"base64\">\n_");
        sample_put_array(file, form);
        sample_text(file, "</AppendedData>");
    } else {
        sample_text(file, ">\n");
        if (form->base64)
            sample_put_array(file, form);
        else
            for (int i = 0; i < SAMPLE_VOXELS; i++) {
                char word[16];
                snprintf(word, sizeof word, "%d\n", i);
                sample_text(file, word);
            }
        sample_text(file, "\n<InformationKey name=\"x\"><Value index=\"0\">7</Value></InformationKey>"
                          "</DataArray></PointData></Piece></ImageData>");
    }
    sample_text(file, "</VTKFile>");
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
    case 10:
        sample_vti(&(sample_vti_form){"byte_order=\"LittleEndian\"", "type=\"Int16\" format=\"binary\"",
                                      .base64 = true},
                   file);
        return "k.vti";
    case 11:
        sample_vti(&(sample_vti_form){"byte_order='BigEndian' header_type=\"UInt64\" "
                                      "compressor=\"vtkZLibDataCompressor\"",
                                      "type=\"Int16\" format=\"binary\"", .base64 = true, .packed = true,
                                      .wide = true, .big_endian = true},
                   file);
        return "l.vti";
    case 12:
        sample_vti(&(sample_vti_form){"header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\"",
                                      "type=\"Int16\" format=\"appended\" offset=\"0\"", .base64 = true,
                                      .packed = true, .appended = true},
                   file);
        return "m.vti";
    case 13:
        sample_vti(&(sample_vti_form){"", "type=\"Float32\" format=\"ascii\"", .base64 = false}, file);
        return "n.vti";
    case 14:
        sample_vti(&(sample_vti_form){"header_type=\"UInt64\"", "type=\"Int16\" format=\"binary\"",
                                      .base64 = true, .wide = true, .apart = true},
                   file);
        return "o.vti";
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
