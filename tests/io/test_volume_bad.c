// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of volume files that are cut short, broken, or claim more than they hold.
#include "volume_sample.h"

TEST_LOGGED(test_every_truncation_fails, 1) {
    sample_file file;
    const char *name;
    for (int which = 0; (name = sample_make(which, &file)); which++) {
        // The line feed behind the last number of a text is no loss.
        const size_t whole = which == 2 ? file.size_bytes - 1 : file.size_bytes;
        for (size_t size_bytes = 0; size_bytes < whole; size_bytes++) {
            ewa_volume volume;
            log->count = 0;
            // A number that lost its last digit is still one.
            const ewa_status status = sample_load(context, &file, size_bytes, name, NULL, &volume);
            if (which == 2 && size_bytes + 1 == whole && status == EWA_OK) {
                ewa_volume_free(&volume);
                continue;
            }
            // Half a word of a head may name something else that is not read.
            if ((status != EWA_ERROR_FORMAT && status != EWA_ERROR_UNSUPPORTED) || !log->count)
                fail_msg("%s cut to %zu bytes: status %d, %s", name, size_bytes, status, log->text);
            assert_non_null(strstr(log->text, name));
            assert_null(volume.voxels);
        }
    }
}

/// Every byte of every file is changed in a few ways: whatever comes back, nothing breaks.
TEST(test_every_changed_byte) {
    static const uint8_t others[] = {0x00, 0x20, 0x2d, 0x39, 0x7f, 0x80, 0xff};
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.limits.max_memory_bytes = 1 << 24;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    sample_file file;
    const char *name;
    for (int which = 0; (name = sample_make(which, &file)); which++)
        for (size_t at = 0; at < file.size_bytes; at++)
            for (size_t k = 0; k < sizeof others; k++) {
                const uint8_t kept = file.bytes[at];
                file.bytes[at] = others[k];
                ewa_volume volume;
                const ewa_status status = sample_load(context, &file, file.size_bytes, name, NULL, &volume);
                assert_int_equal(status == EWA_OK, volume.voxels != NULL);
                ewa_volume_free(&volume);
                file.bytes[at] = kept;
            }
}

#define NRRD  "NRRD0004\n"
#define UCHAR "type: uchar\n"
#define CUBE  "dimension: 3\nsizes: 1 1 1\n"
#define RAW   "encoding: raw\n"
#define META  "NDims = 3\nDimSize = 1 1 1\nElementType = MET_UCHAR\n"
#define VTK   "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n"

/// An XML image of 2 x 2 x 2 points up to the attributes of its array.
#define VTI(root, type)                                                                                      \
    "<VTKFile " root "><ImageData WholeExtent=\"0 1 0 1 0 1\"><Piece><PointData><DataArray type=\"" type "\" "
#define VTI_END "</PointData></Piece></ImageData></VTKFile>"
#define ZLIB    "compressor=\"vtkZLibDataCompressor\""

TEST(test_broken_files) {
    static const struct {
        const char *text, *said;
        ewa_status status;
    } files[] = {
        {"", "no volume", EWA_ERROR_FORMAT},
        {"hello", "no volume", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "\n", "bytes", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE "\nx", "encoding", EWA_ERROR_FORMAT},
        {NRRD UCHAR RAW "\nx", "dimension", EWA_ERROR_FORMAT},
        {NRRD UCHAR RAW "dimension: 3\n\nx", "sizes", EWA_ERROR_FORMAT},
        {NRRD CUBE RAW "\nx", "type", EWA_ERROR_FORMAT},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:4d\n", "a pointer of Git LFS", EWA_ERROR_UNSUPPORTED},
        {NRRD "type: block\n" CUBE RAW "\nx", "block", EWA_ERROR_UNSUPPORTED},
        {NRRD "type: short\n" CUBE RAW "\nxy", "endian", EWA_ERROR_FORMAT},
        {NRRD "type: short\nendian: middle\n" CUBE RAW "\nxy", "middle", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE "encoding: zip\n\nx", "zip", EWA_ERROR_UNSUPPORTED},
        {NRRD UCHAR "dimension: 0\nsizes: \n" RAW "\nx", "dimension", EWA_ERROR_FORMAT},
        {NRRD UCHAR "dimension: 17\n" RAW "\nx", "dimension", EWA_ERROR_FORMAT},
        {NRRD UCHAR "sizes: 1 1 1\ndimension: 3\n" RAW "\nx", "before dimension", EWA_ERROR_FORMAT},
        {NRRD UCHAR "dimension: 3\nsizes: 1 1\n" RAW "\nx", "sizes", EWA_ERROR_FORMAT},
        {NRRD UCHAR "dimension: 3\nsizes: 1 -1 1\n" RAW "\nx", "sizes", EWA_ERROR_FORMAT},
        {NRRD UCHAR "dimension: 3\nsizes: 99999999999999999999 1 1\n" RAW "\nx", "sizes", EWA_ERROR_FORMAT},
        {NRRD UCHAR "dimension: 3\nsizes: 4294967296 1 1\n" RAW "\nx", "limit", EWA_ERROR_LIMIT},
        {NRRD UCHAR "dimension: 3\nsizes: 2000000 2000000 2000000\n" RAW "\nx", "limit", EWA_ERROR_LIMIT},
        {NRRD UCHAR "dimension: 3\nsizes: 4294967295 4294967295 4294967295\nencoding: bzip2\n\nx", "limit",
         EWA_ERROR_LIMIT},
        {NRRD UCHAR "dimension: 3\nsizes: 1000 1000 1000\nencoding: gzip\n\nx", "at most", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "spacings: 0 1 1\n\nx", "zero", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "spacings: 1 inf 1\n\nx", "finite", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "spacings: 1 1\n\nx", "spacings", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "space: LPS\nspace directions: (1,0,0) (2,0,0) (0,0,1)\n\nx", "plane",
         EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "space: LPS\nspace directions: (1,0,0) (0,1,0) (1,1,1e-9)\n\nx", "plane",
         EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "space: LPS\nspace directions: (nan,0,0) (0,1,0) (0,0,1)\n\nx", "finite",
         EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "space: LPS\nspace directions: (1,0) (0,1,0) (0,0,1)\n\nx", "directions",
         EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "space: LPS\nspace origin: (1,nan,0)\n\nx", "finite", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "space: moon\n\nx", "moon", EWA_ERROR_UNSUPPORTED},
        {NRRD UCHAR CUBE RAW "space dimension: 7\n\nx", "7", EWA_ERROR_UNSUPPORTED},
        {NRRD UCHAR CUBE RAW "line skip: 5\n\nx", "lines", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "byte skip: 5\n\nx", "bytes", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "byte skip: 18446744073709551615\n\nx", "skip", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "nonsense\n\nx", "nonsense", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE RAW "data file: other.raw\n\n", "another file", EWA_ERROR_UNSUPPORTED},
        {NRRD UCHAR CUBE "encoding: hex\n\nzz", "hexadecimal", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE "encoding: ascii\n\nx", "no number", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE "encoding: gzip\n\nxxxxxxxxxxxxxxxxxxx", "broken", EWA_ERROR_FORMAT},
        {NRRD UCHAR CUBE "encoding: bzip2\n\nBZh9xxxxxxxxxxxxxxxxxxx", "broken", EWA_ERROR_FORMAT},
        {META "ElementDataFile = LOCAL\n", "bytes", EWA_ERROR_FORMAT},
        {META, "ElementDataFile", EWA_ERROR_FORMAT},
        {META "ElementDataFile = x.raw\n", "another file", EWA_ERROR_UNSUPPORTED},
        {META "ElementSpacing = 1 0 1\nElementDataFile = LOCAL\nx", "zero", EWA_ERROR_FORMAT},
        {META "TransformMatrix = 1 0 0 0 1 0 1 1 0\nElementDataFile = LOCAL\nx", "plane", EWA_ERROR_FORMAT},
        {META "ElementType = MET_OTHER\nElementDataFile = LOCAL\nx", "MET_OTHER", EWA_ERROR_UNSUPPORTED},
        {META "ElementNumberOfChannels = 7\nElementDataFile = LOCAL\nx", "7", EWA_ERROR_UNSUPPORTED},
        {"NDims = 11\n", "NDims", EWA_ERROR_FORMAT},
        {"NDims = 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nx", "DimSize", EWA_ERROR_FORMAT},
        {VTK "DIMENSIONS 1 1 1\nSCALARS s float\nLOOKUP_TABLE default\nx", "no number", EWA_ERROR_FORMAT},
        {VTK "DIMENSIONS 1 1\nSCALARS s float\nLOOKUP_TABLE default\n1", "DIMENSIONS", EWA_ERROR_FORMAT},
        {VTK "SPACING 0 1 1\n", "zero", EWA_ERROR_FORMAT},
        {VTK "SCALARS s bit\n", "bit", EWA_ERROR_UNSUPPORTED},
        {VTK "CELL_DATA 5\n", "no DIMENSIONS", EWA_ERROR_FORMAT},
        {VTK "DIMENSIONS 2 2 2\nCELL_DATA x\n", "CELL_DATA", EWA_ERROR_FORMAT},
        {VTK "DIMENSIONS 2 2 2\nCELL_DATA 1\nFIELD f 1\na 1 1 string\nb\n", "FIELD", EWA_ERROR_FORMAT},
        {VTK "DIMENSIONS 2 2 2\nPOINT_DATA 8\nVECTORS v float\n1 2 3\n", "no SCALARS", EWA_ERROR_FORMAT},
        {VTK "DIMENSIONS 2 2 2\nPOINT_DATA 8\nVECTORS v bit\n1 2 3\n", "VECTORS", EWA_ERROR_UNSUPPORTED},
        {VTK "DIMENSIONS 2 2 2\nPOINT_DATA 9\nSCALARS s float\nLOOKUP_TABLE default\n", "data of 9 places", EWA_ERROR_FORMAT},
        {VTK "DIMENSIONS 2 2 2\nCELL_DATA 8\nSCALARS s float\nLOOKUP_TABLE default\n", "data of 8 places", EWA_ERROR_FORMAT},
        {"# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nPOINT_DATA 8\nVECTORS v float\n12",
         "end early", EWA_ERROR_FORMAT},
        {"# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nPOINT_DATA 8\n"
         "FIELD f 1\na 1000 18446744073709551615 float\n",
         "FIELD", EWA_ERROR_FORMAT},
        {"# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nPOINT_DATA 8\n"
         "FIELD f 1\na 1000 100000000000000000 float\n",
         "too large", EWA_ERROR_FORMAT},
        {"# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n", "POLYDATA", EWA_ERROR_UNSUPPORTED},
        {"# vtk DataFile Version 3.0\nt\nMAYBE\n", "MAYBE", EWA_ERROR_FORMAT},
        {"<VTKFile type=\"PolyData\"></VTKFile>", "ImageData", EWA_ERROR_UNSUPPORTED},
        {VTI("", "UInt8") "format=\"ascii\">1 2</DataArray>" VTI_END, "8 numbers", EWA_ERROR_FORMAT},
        {VTI("", "UInt8") "format=\"ascii\">1 2 3 4 5 6 7 x</DataArray>" VTI_END, "no number",
         EWA_ERROR_FORMAT},
        {VTI("", "UInt8") "format=\"ascii\">1 2 3 4 5 6 7 8</DataArray>", "ends early", EWA_ERROR_FORMAT},
        {VTI("", "Bit") "format=\"ascii\">1</DataArray>" VTI_END, "Bit", EWA_ERROR_UNSUPPORTED},
        {VTI("", "UInt8") "format=\"morse\">1</DataArray>" VTI_END, "morse", EWA_ERROR_FORMAT},
        {VTI("", "Float32") "NumberOfComponents=\"3\">1</DataArray>" VTI_END, "3", EWA_ERROR_UNSUPPORTED},
        {VTI("", "UInt8") "format=\"binary\"></DataArray>" VTI_END, "end early", EWA_ERROR_FORMAT},
        {VTI("", "UInt8") "format=\"binary\"/>" VTI_END, "end early", EWA_ERROR_FORMAT},
        // A size of 2^32 - 1 or 2^64 - 1, 2^32 - 1 blocks, no block, a block of 2^32 - 1 bytes.
        {VTI("", "UInt8") "format=\"binary\">/////wECAwQFBgcI</DataArray>" VTI_END, "end early",
         EWA_ERROR_FORMAT},
        {VTI("header_type=\"UInt64\"",
             "UInt8") "format=\"binary\">//////////8BAgMEBQYHCA==</DataArray>" VTI_END,
         "end early", EWA_ERROR_FORMAT},
        {VTI(ZLIB, "UInt8") "format=\"binary\">/////wAAAAAAAAAAAAAAAA==</DataArray>" VTI_END, "end early",
         EWA_ERROR_FORMAT},
        {VTI(ZLIB, "UInt8") "format=\"binary\">AAAAAAAAAAAAAAAAAAAAAA==</DataArray>" VTI_END, "end early",
         EWA_ERROR_FORMAT},
        {VTI(ZLIB, "UInt8") "format=\"binary\">AQAAAAgAAAAAAAAA/////w==AAAA</DataArray>" VTI_END, "end early",
         EWA_ERROR_FORMAT},
        {VTI("compressor=\"vtkSnappyDataCompressor\"", "UInt8") "format=\"binary\">AAAA</DataArray>" VTI_END,
         "Snappy", EWA_ERROR_UNSUPPORTED},
        {VTI("compressor=\"vtkLZMADataCompressor\"", "UInt8") "format=\"binary\">AAAA</DataArray>" VTI_END,
         "end early", EWA_ERROR_FORMAT},
        {VTI("", "UInt8") "format=\"appended\" offset=\"0\"/>" VTI_END, "end early", EWA_ERROR_FORMAT},
        {VTI("", "UInt8") "format=\"appended\" offset=\"-1\"/>" VTI_END, "offset", EWA_ERROR_FORMAT},
        {VTI("", "UInt8") "format=\"ascii\">1</DataArray></PointData></Piece><Piece>" VTI_END, "2 pieces",
         EWA_ERROR_UNSUPPORTED},
        {"<VTKFile><ImageData WholeExtent=\"0 1 0 1\"><PointData><DataArray>" VTI_END, "extent",
         EWA_ERROR_FORMAT},
        {"<VTKFile><ImageData WholeExtent=\"0 -1 0 1 0 1\"><PointData><DataArray>" VTI_END, "extent",
         EWA_ERROR_FORMAT},
        {"<VTKFile><ImageData WholeExtent=\"0 1 0 1 0 1\" Spacing=\"1 0 1\"><PointData><DataArray>" VTI_END,
         "zero", EWA_ERROR_FORMAT},
        {"<VTKFile><ImageData WholeExtent=\"0 1 0 1 0 1\" Direction=\"1 0 0 0 1 0 0 "
         "0\"><PointData><DataArray>" VTI_END,
         "Direction", EWA_ERROR_FORMAT},
        {"<VTKFile type=\"ImageData\"><!-- <ImageData>", "ImageData", EWA_ERROR_UNSUPPORTED},
        {"<VTKFile a='<ImageData>' b=\"", "ImageData", EWA_ERROR_UNSUPPORTED},
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        sample_file file = {.size_bytes = 0};
        ewa_volume volume;
        sample_text(&file, files[i].text);
        log.count = 0;
        const ewa_status status = sample_load(context, &file, file.size_bytes, "bad", NULL, &volume);
        const bool lacks = strstr(files[i].text, "LZMA") && !strstr(ewa_parts(), "lzma");
        if (status != (lacks ? EWA_ERROR_UNSUPPORTED : files[i].status) || !log.count || !strstr(log.text, lacks ? "LZMA" : files[i].said) ||
            strncmp(log.text, "bad: ", 5) != 0)
            fail_msg("case %zu (%s): status %d, said '%s'", i, files[i].text, status, log.text);
        assert_null(volume.voxels);
    }
}

TEST(test_broken_nifti) {
    static const struct {
        size_t at, size;
        uint64_t bits;
        ewa_status status;
    } changes[] = {
        {40, 2, 8, EWA_ERROR_FORMAT},           // axes
        {42, 2, 0, EWA_ERROR_FORMAT},           // an axis of none
        {42, 2, 0x8000, EWA_ERROR_FORMAT},      // of fewer than none
        {42, 2, 0x7fff, EWA_ERROR_FORMAT},      // of more than there are
        {70, 2, 1792, EWA_ERROR_UNSUPPORTED},   // complex doubles
        {80, 4, 0, EWA_ERROR_FORMAT},           // a step of zero
        {80, 4, 0x7fc00000, EWA_ERROR_FORMAT},  // that is no number
        {108, 4, 0xbf800000, EWA_ERROR_FORMAT}, // voxels at byte -1
        {108, 4, 0x7f800000, EWA_ERROR_FORMAT}, // at infinity
        {108, 4, 0x4e800000, EWA_ERROR_FORMAT}, // beyond the end
        {254, 2, 1, EWA_ERROR_FORMAT},          // an sform of zeros
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        sample_file file;
        ewa_volume volume;
        sample_make(4, &file);
        sample_store(file.bytes + changes[i].at, false, changes[i].size, changes[i].bits);
        log.count = 0;
        const ewa_status status = sample_load(context, &file, file.size_bytes, "bad.nii", NULL, &volume);
        if (status != changes[i].status || !log.count) fail_msg("case %zu: %d, %s", i, status, log.text);
    }
}

TEST(test_limit) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.limits.max_memory_bytes = 1000;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    sample_file file = {.size_bytes = 0};
    // 1,001 voxels that the file does hold.
    sample_text(&file, "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 7 11 13\nencoding: raw\n\n");
    memset(file.bytes + file.size_bytes, 1, 1001);
    file.size_bytes += 1001;
    ewa_volume volume;
    assert_int_equal(sample_load(context, &file, file.size_bytes, "big", NULL, &volume), EWA_ERROR_LIMIT);
}

static ewa_status load_one(ewa_context *context, void *user) {
    sample_file file;
    const char *name = sample_make(*(int *)user, &file);
    OWNED(ewa_volume_free) ewa_volume volume;
    const ewa_status status = sample_load(context, &file, file.size_bytes, name, NULL, &volume);
    return status;
}

TEST(test_failing_allocations) {
    sample_file file;
    for (int which = 0; sample_make(which, &file); which++) scratch_fail_each(load_one, &which);
}

static ewa_status save_one(ewa_context *context, void *user) {
    OWNED(ewa_volume_free) ewa_volume volume;
    ewa_status status = ewa_volume_create(context, (const uint32_t[3]){4, 4, 4}, EWA_U8, &volume);
    if (status == EWA_OK) status = ewa_volume_save(&volume, user, NULL);
    return status;
}

TEST_ON(test_failing_save, 1) {
    char path[512];
    scratch_fail_each(save_one, (void *)(uintptr_t)scratch_path("failing.nrrd", path));
    assert_int_equal(save_one(context, "/no/such/folder/a.nrrd"), EWA_ERROR_IO);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
