// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes in every wrapping that the data set has.
#include "tests/data/facts.h"
#include "tests/data/synthetic_data.h"

#include <bzlib.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/// Numbers as they stand in a file, least significant bytes first.
typedef struct numbers {
    uint8_t *data;
    size_t size, count;
} numbers;

static void put_little(uint8_t *to, uint64_t bits, size_t size) {
    for (size_t i = 0; i < size; i++) to[i] = (uint8_t)(bits >> (8 * i));
}

/// A number as bytes of its type.
static void encode(uint8_t *to, ewa_type type, double value) {
    if (type == EWA_F64) {
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        put_little(to, bits, 8);
    } else if (type == EWA_F32) {
        const float rounded = (float)value;
        uint32_t bits;
        memcpy(&bits, &rounded, sizeof bits);
        put_little(to, bits, 4);
    } else {
        put_little(to, (uint64_t)(int64_t)value, ewa_type_bytes(type));
    }
}

/// A range from its low to its high end, in steps that compress well.
static numbers make_numbers(size_t fact, ewa_type type) {
    const uint32_t *dims = volume_facts[fact].dims;
    const double low = volume_facts[fact].low, high = volume_facts[fact].high;
    numbers made = {.count = (size_t)dims[0] * dims[1] * dims[2]};
    const size_t bytes = ewa_type_bytes(type);
    made.size = made.count * bytes;
    made.data = synthetic_memory(made.size);
    const bool whole = type != EWA_F32 && type != EWA_F64;
    for (size_t i = 0; i < made.count; i++) {
        const double share = i == 0 ? 0 : i == made.count - 1 ? 1 : (double)(i / 61 % 97) / 97;
        const double value = i == made.count - 1 ? high : low + share * (high - low);
        encode(made.data + bytes * i, type, whole ? floor(value) : value);
    }
    return made;
}

/// With the head that gzip files have, or zlib's.
static numbers deflated(const numbers *from, bool gzip) {
    z_stream stream = {.next_in = from->data, .avail_in = (uInt)from->size};
    if (deflateInit2(&stream, 1, Z_DEFLATED, gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY) != Z_OK) exit(1);
    numbers made = {.size = deflateBound(&stream, (uLong)from->size) + 64};
    made.data = synthetic_memory(made.size);
    stream.next_out = made.data, stream.avail_out = (uInt)made.size;
    if (deflate(&stream, Z_FINISH) != Z_STREAM_END) exit(1);
    made.size = stream.total_out;
    deflateEnd(&stream);
    return made;
}

static numbers bzipped(const numbers *from) {
    unsigned int size = (unsigned int)(from->size + from->size / 50 + 1000);
    numbers made = {.data = synthetic_memory(size)};
    if (BZ2_bzBuffToBuffCompress((char *)made.data, &size, (char *)from->data, (unsigned int)from->size, 5, 0,
                                 0) != BZ_OK)
        exit(1);
    made.size = size;
    return made;
}

/// A text, then bytes.
static void put(const char *folder, const char *name, const char *head, const numbers *data) {
    char path[256];
    snprintf(path, sizeof path, "volumes/%s", name);
    FILE *file = synthetic_open(folder, path);
    fputs(head, file);
    if (data && fwrite(data->data, 1, data->size, file) != data->size) exit(1);
    if (fclose(file)) exit(1);
}

static size_t fact_of(const char *name) {
    for (size_t i = 0; i < sizeof volume_facts / sizeof *volume_facts; i++)
        if (!strcmp(volume_facts[i].name, name)) return i;
    fprintf(stderr, "no facts about %s\n", name);
    exit(1);
}

static void put_nrrds(const char *folder) {
    static const struct {
        const char *name, *type, *encoding, *place;
        ewa_type stored;
    } files[] = {
        {"tooth.nrrd", "uint8_t", "raw",
         "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n",
         EWA_U8},
        {"mri_head_128.nrrd", "uint8", "gzip", "", EWA_U8},
        {"stent.nrrd", "float", "gzip",
         "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0, 0, 0)\n", EWA_F32},
        {"teem_fmob-c4h.nrrd", "double", "raw",
         "space dimension: 3\nspace directions: (0.0513,0,0) (0,0.0513,0) (0,0,0.0513)\nspace origin: "
         "(-0.79,-1,-0.38)\n",
         EWA_F64},
    };
    char head[512];
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        const size_t fact = fact_of(files[i].name);
        const uint32_t *dims = volume_facts[fact].dims;
        numbers raw = make_numbers(fact, files[i].stored), packed = deflated(&raw, true);
        snprintf(head, sizeof head,
                 "NRRD0004\n# a synthetic file\ntype: %s\ndimension: 3\nsizes: %u %u %u\nendian: "
                 "little\nencoding: "
                 "%s\n%s\n",
                 files[i].type, dims[0], dims[1], dims[2], files[i].encoding, files[i].place);
        put(folder, files[i].name, head, files[i].encoding[0] == 'g' ? &packed : &raw);
        free(raw.data), free(packed.data);
    }
    put(folder, "nrrd_variants/test2d_ascii.nrrd",
        "NRRD0004\ntype: unsigned short\ndimension: 2\nsizes: 3 9\nspacings: 1.0458000000000001 2\nencoding: "
        "ASCII\n\n"
        "1 2 3\n4 5 6\n7 8 9\n10 11 12\n13 14 15\n16 17 18\n19 20 21\n22 23 24\n25 26 27\n",
        NULL);
}

/// One volume, wrapped in five ways.
static void put_twins(const char *folder) {
    const size_t fact = fact_of("nrrd_variants/BallBinary30x30x30_bz2.nrrd");
    static const char BEGIN[] =
        "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 30 30 30\n"
        "space directions: (1,0,0) (0,1,0) (0,0,1)\nendian: little\nspace origin: (0,0,0)\n";
    numbers raw = make_numbers(fact, EWA_I16), gz = deflated(&raw, true), bz2 = bzipped(&raw);
    char head[512];
    snprintf(head, sizeof head, "%sencoding: raw\n\n", BEGIN);
    put(folder, "nrrd_variants/BallBinary30x30x30.nrrd", head, &raw);
    snprintf(head, sizeof head, "%sencoding: raw\ndata file: BallBinary30x30x30.raw\n", BEGIN);
    put(folder, "nrrd_variants/BallBinary30x30x30.nhdr", head, NULL);
    put(folder, "nrrd_variants/BallBinary30x30x30.raw", "", &raw);
    snprintf(head, sizeof head, "%sencoding: gzip\n\n", BEGIN);
    put(folder, "nrrd_variants/BallBinary30x30x30_gz.nrrd", head, &gz);
    snprintf(head, sizeof head,
             "%sencoding: gzip\nline skip: 3\n\nthis line\nand this line\nand this one, skipped\n", BEGIN);
    put(folder, "nrrd_variants/BallBinary30x30x30_gz_lineskip.nrrd", head, &gz);
    snprintf(head, sizeof head, "%sencoding: bzip2\n\n", BEGIN);
    put(folder, "nrrd_variants/BallBinary30x30x30_bz2.nrrd", head, &bz2);
    free(raw.data), free(gz.data), free(bz2.data);
}

/// VTK's XML: blocks of zlib behind their sizes, after an underscore.
static void put_vti(const char *folder) {
    enum { BLOCK = 1 << 20 };
    const size_t fact = fact_of("aneurism.vti");
    numbers raw = make_numbers(fact, EWA_U8);
    const size_t blocks = (raw.size + BLOCK - 1) / BLOCK;
    numbers whole = {.data = synthetic_memory(2 * raw.size + 8 * (blocks + 3)), .size = 8 * (blocks + 3)};
    put_little(whole.data, blocks, 8);
    put_little(whole.data + 8, BLOCK, 8);
    put_little(whole.data + 16, raw.size % BLOCK, 8);
    for (size_t i = 0; i < blocks; i++) {
        const size_t left = raw.size - i * BLOCK;
        const numbers part = {.data = raw.data + i * BLOCK, .size = left < BLOCK ? left : BLOCK};
        numbers packed = deflated(&part, false);
        put_little(whole.data + 24 + 8 * i, packed.size, 8);
        memcpy(whole.data + whole.size, packed.data, packed.size);
        whole.size += packed.size;
        free(packed.data);
    }
    const uint32_t *dims = volume_facts[fact].dims;
    char head[1024], path[256];
    const char *extent = "0 %u 0 %u 0 %u";
    char extents[64];
    snprintf(extents, sizeof extents, extent, dims[0] - 1, dims[1] - 1, dims[2] - 1);
    snprintf(head, sizeof head,
             "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
             "compressor=\"vtkZLibDataCompressor\">\n<ImageData WholeExtent=\"%s\" Origin=\"0 0 0\" "
             "Spacing=\"1 1 1\">\n"
             "<Piece Extent=\"%s\">\n<PointData Scalars=\"a\">\n<DataArray type=\"UInt8\" Name=\"a\" "
             "format=\"appended\" "
             "offset=\"0\"/>\n</PointData>\n<CellData></CellData>\n</Piece>\n</ImageData>\n"
             "<AppendedData encoding=\"raw\">\n_",
             extents, extents);
    snprintf(path, sizeof path, "volumes/aneurism.vti");
    FILE *file = synthetic_open(folder, path);
    fputs(head, file);
    if (fwrite(whole.data, 1, whole.size, file) != whole.size) exit(1);
    fputs("\n</AppendedData>\n</VTKFile>\n", file);
    if (fclose(file)) exit(1);
    numbers gz = deflated(&raw, true);
    put(folder, "aneurism_256x256x256_uint8.raw.gz", "", &gz);
    free(raw.data), free(whole.data), free(gz.data);
}

static void put_niftis(const char *folder) {
    static const char *const names[] = {"avg152T1_RL_nifti.nii.gz", "chris_MRA.nii.gz", "anatomical.nii"};
    for (int i = 0; i < 3; i++) {
        const size_t fact = fact_of(names[i]);
        const bool words = volume_facts[fact].type == EWA_I16;
        numbers raw = make_numbers(fact, volume_facts[fact].type);
        numbers whole = {.data = synthetic_memory(352 + raw.size), .size = 352 + raw.size};
        uint8_t *head = whole.data;
        put_little(head, 348, 4);
        put_little(head + 40, 3, 2);
        for (size_t c = 0; c < 3; c++) put_little(head + 42 + 2 * c, volume_facts[fact].dims[c], 2);
        for (size_t c = 3; c < 7; c++) put_little(head + 42 + 2 * c, 1, 2);
        put_little(head + 70, words ? 4 : 2, 2);
        put_little(head + 72, words ? 16 : 8, 2);
        for (size_t c = 0; c < 4; c++) encode(head + 76 + 4 * c, EWA_F32, c ? 1.5 : 1);
        encode(head + 108, EWA_F32, 352);
        memcpy(head + 344, "n+1", 4);
        memcpy(head + 352, raw.data, raw.size);
        numbers gz = deflated(&whole, true);
        put(folder, names[i], "", i < 2 ? &gz : &whole);
        free(raw.data), free(whole.data), free(gz.data);
    }
}

static void put_others(const char *folder) {
    size_t fact = fact_of("neghip.mha");
    char head[512];
    numbers raw = make_numbers(fact, EWA_U8), packed = deflated(&raw, false);
    snprintf(head, sizeof head,
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = "
             "False\nCompressedData = True\n"
             "CompressedDataSize = %zu\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing "
             "= 1 1 1\n"
             "DimSize = 70 70 70\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
             packed.size);
    put(folder, "neghip.mha", head, &packed);
    free(raw.data), free(packed.data);
    fact = fact_of("HeadMRVolume.mhd"), raw = make_numbers(fact, EWA_U8);
    put(folder, "HeadMRVolume.mhd",
        "NDims = 3\nDimSize = 48 62 42\nElementSpacing = 4.000000e+000 4.000000e+000 4.000000e+000\n"
        "ElementType = MET_UCHAR\nElementByteOrderMSB = False\nElementDataFile = HeadMRVolume.raw\n",
        NULL);
    put(folder, "HeadMRVolume.raw", "", &raw);
    free(raw.data);
    fact = fact_of("ironProt.vtk"), raw = make_numbers(fact, EWA_U8);
    put(folder, "ironProt.vtk",
        "# vtk DataFile Version 1.0\na synthetic file\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 68 68 "
        "68\n"
        "ASPECT_RATIO 1.0 1.0 1.0\nORIGIN 0.0 0.0 0.0\nPOINT_DATA 314432\nSCALARS scalars unsigned_char\n"
        "LOOKUP_TABLE default\n",
        &raw);
    free(raw.data);
    static const char *const raws[] = {"engine_256x256x128_uint8.raw.gz", "headsq_64x64x93_uint16le.raw.gz"};
    for (int i = 0; i < 2; i++) {
        fact = fact_of(raws[i]), raw = make_numbers(fact, volume_facts[fact].type),
        packed = deflated(&raw, true);
        put(folder, raws[i], "", &packed);
        free(raw.data), free(packed.data);
    }
}

void synthetic_volumes(const char *folder) {
    put_nrrds(folder);
    put_twins(folder);
    put_vti(folder);
    put_niftis(folder);
    put_others(folder);
}
