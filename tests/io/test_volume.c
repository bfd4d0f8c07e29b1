// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the volume files: known voxels and places in every format, files of several parts, saving.
#include "tests/data/facts.h"
#include "volume_sample.h"

#include <math.h>

/// Loads a sample and compares its place with 12 numbers.
static void check_place(ewa_context *context, const sample_file *file, const char *name,
                        const double wanted[12]) {
    ewa_volume volume;
    assert_int_equal(sample_load(context, file, file->size_bytes, name, NULL, &volume), EWA_OK);
    sample_check(&volume);
    for (int i = 0; i < 12; i++)
        if (fabs(volume.index_to_world[i] - wanted[i]) > 1e-6)
            fail_msg("%s: place %d is %g, not %g", name, i, volume.index_to_world[i], wanted[i]);
    ewa_volume_free(&volume);
}

TEST_LOGGED(test_every_format, 1) {
    sample_file file;
    const char *name;
    for (int which = 0; (name = sample_make(which, &file)); which++) {
        OWNED(ewa_volume_free) ewa_volume volume;
        if (sample_load(context, &file, file.size_bytes, name, NULL, &volume) != EWA_OK)
            fail_msg("%s: %s", name, log->text);
        sample_check(&volume);
    }
    assert_int_equal(log->count, 0);
}

TEST_ON(test_every_type, 1) {
    static const struct {
        const char *word;
        ewa_type type, becomes;
    } types[] = {{"int8", EWA_I8, EWA_I8},    {"uint16", EWA_U16, EWA_U16}, {"short", EWA_I16, EWA_I16},
                 {"int", EWA_I32, EWA_F32},   {"uint32", EWA_U32, EWA_F32}, {"float", EWA_F32, EWA_F32},
                 {"double", EWA_F64, EWA_F32}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        for (int big = 0; big < 2; big++) {
            sample_file file = {.size_bytes = 0};
            char head[256];
            snprintf(head, sizeof head,
                     "NRRD0001\ntype: %s\ndimension: 3\nsizes: 2 3 4\nendian: %s\nencoding: raw\n\n",
                     types[i].word, big ? "big" : "little");
            sample_text(&file, head);
            sample_put_numbers(&file, types[i].type, big);
            OWNED(ewa_volume_free) ewa_volume volume;
            assert_int_equal(sample_load(context, &file, file.size_bytes, "t.nrrd", NULL, &volume), EWA_OK);
            assert_int_equal(volume.type, types[i].becomes);
            sample_check(&volume);
        }
}

TEST_ON(test_nrrd_places, 1) {
    sample_file file;
    static const struct {
        const char *fields;
        double place[12];
    } cases[] = {
        {"encoding: raw\n", {1, 0, 0, -0.5, 0, 1, 0, -1, 0, 0, 1, -1.5}},
        {"encoding: raw\nspacings: 2 3 4\n", {2, 0, 0, -1, 0, 3, 0, -3, 0, 0, 4, -6}},
        {"encoding: raw\nspace: LPS\nspace directions: (0,2,0) (3,0,0) (0,0,-4)\nspace origin: (5,6,7)\n",
         {0, 3, 0, 5, 2, 0, 0, 6, 0, 0, -4, 7}},
        {"encoding: raw\nspace: right-anterior-superior\nspace directions: (0,2,0) (3,0,0) (0,0,-4)\n"
         "space origin: (5,6,7)\n",
         {0, -3, 0, -5, -2, 0, 0, -6, 0, 0, -4, 7}},
        {"encoding: raw\nspace: left-anterior-superior\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n"
         "space origin: (5,6,7)\n",
         {2, 0, 0, 5, 0, -3, 0, -6, 0, 0, 4, 7}},
        // Seen in files of some writers: no space dimension.
        {"encoding: raw\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (5,6,7)\n",
         {2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 7}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sample_nrrd(cases[i].fields, &file);
        sample_put_numbers(&file, EWA_U8, false);
        check_place(context, &file, "place.nrrd", cases[i].place);
    }
    // Bytes and lines to skip.
    sample_nrrd("encoding: raw\nline skip: 2\nbyte skip: 3\n", &file);
    sample_text(&file, "one\ntwo\nabc");
    sample_put_numbers(&file, EWA_U8, false);
    check_place(context, &file, "skip.nrrd", cases[0].place);
    sample_nrrd("encoding: raw\nbyte skip: -1\n", &file);
    sample_text(&file, "who knows");
    sample_put_numbers(&file, EWA_U8, false);
    check_place(context, &file, "end.nrrd", cases[0].place);
    // The world of the spacing option.
    WITH_DEFAULTS(ewa_volume_load_options, options);
    options.spacing_world[0] = 10;
    OWNED(ewa_volume_free) ewa_volume volume;
    assert_int_equal(sample_load(context, &file, file.size_bytes, "s.nrrd", &options, &volume), EWA_OK);
    assert_true(volume.index_to_world[0] == 10 && volume.index_to_world[3] == -5 &&
                volume.index_to_world[5] == 1);
}

TEST(test_nrrd_axes) {
    static const struct {
        const char *text;
        ewa_status status;
        uint32_t dims[3];
        int warnings;
    } cases[] = {
        {"dimension: 1\nsizes: 6\n", EWA_OK, {6, 1, 1}, 0},
        {"dimension: 2\nsizes: 2 3\n", EWA_OK, {2, 3, 1}, 0},
        {"dimension: 4\nsizes: 1 2 3 1\n", EWA_OK, {1, 2, 3}, 0},
        {"dimension: 4\nsizes: 1 2 1 3\n", EWA_OK, {1, 2, 1}, 1}, // the first of three
        {"dimension: 3\nsizes: 3 2 1\nkinds: RGB-color domain domain\n", EWA_OK, {2, 1, 1}, 0},
        {"dimension: 3\nsizes: 3 2 1\nkinds: vector domain domain\n", EWA_ERROR_UNSUPPORTED, {0}, 0},
        {"dimension: 3\nsizes: 1 6 1\nkinds: vector domain domain\n", EWA_OK, {6, 1, 1}, 0},
        {"dimension: 3\nsizes: 2 3 1\nkinds: domain time domain\n", EWA_ERROR_UNSUPPORTED, {0}, 0},
        {"dimension: 3\nsizes: 0 3 2\n", EWA_ERROR_FORMAT, {0}, 0},
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sample_file file = {.size_bytes = 0};
        OWNED(ewa_volume_free) ewa_volume volume;
        sample_text(&file, "NRRD0004\ntype: uchar\nencoding: raw\n");
        sample_text(&file, cases[i].text);
        sample_text(&file, "\n\001\002\003\004\005\006");
        log.count = 0;
        if (sample_load(context, &file, file.size_bytes, "x.nrrd", NULL, &volume) != cases[i].status)
            fail_msg("case %zu: %s", i, log.text);
        if (cases[i].status != EWA_OK) continue;
        assert_int_equal(log.count, cases[i].warnings);
        assert_memory_equal(volume.dims, cases[i].dims, sizeof volume.dims);
        if (strstr(cases[i].text, "RGB")) {
            const float *voxels = volume.voxels;
            assert_true(fabsf(voxels[0] - (0.2126f * 1 + 0.7152f * 2 + 0.0722f * 3)) < 1e-6f);
            assert_true(fabsf(voxels[1] - (0.2126f * 4 + 0.7152f * 5 + 0.0722f * 6)) < 1e-6f);
        }
    }
}

TEST_ON(test_nifti_places, 1) {
    for (int kind = 0; kind < 4; kind++) {
        const bool second = kind & 1, big = kind & 2;
        const char *magic = second ? "n+2" : "n+1";
        sample_file file;
        sample_nifti_head(second, big, magic, &file);
        sample_put_numbers(&file, EWA_I16, big);
        // Neither form: steps only, in the middle.
        check_place(context, &file, "n.nii", (const double[12]){2, 0, 0, -1, 0, 3, 0, -3, 0, 0, 4, -6});
        // sform, in right-anterior-superior.
        static const double rows[12] = {0, 3, 0, 5, 2, 0, 0, 6, 0, 0, -4, 7};
        for (size_t i = 0; i < 12; i++)
            sample_store_real(file.bytes + (second ? 400 + 8 * i : 280 + 4 * i), big, second, rows[i]);
        sample_store(file.bytes + (second ? 348 : 254), big, second ? 4 : 2, 1);
        check_place(context, &file, "s.nii", (const double[12]){0, -3, 0, -5, -2, 0, 0, -6, 0, 0, -4, 7});
        // qform: a quarter turn about z (x to y) and a left-handed third axis.
        sample_store(file.bytes + (second ? 348 : 254), big, second ? 4 : 2, 0);
        sample_store(file.bytes + (second ? 344 : 252), big, second ? 4 : 2, 1);
        sample_store_real(file.bytes + (second ? 368 : 264), big, second, sqrt(0.5));
        for (size_t k = 0; k < 3; k++)
            sample_store_real(file.bytes + (second ? 376 + 8 * k : 268 + 4 * k), big, second,
                              10.0 + (double)k);
        sample_store_real(file.bytes + (second ? 104 : 76), big, second, -1);
        check_place(context, &file, "q.nii", (const double[12]){0, 3, 0, -10, -2, 0, 0, -11, 0, 0, -4, 12});
        // A slope makes floats.
        sample_store_real(file.bytes + (second ? 176 : 112), big, second, 0.5);
        sample_store_real(file.bytes + (second ? 184 : 116), big, second, 100);
        OWNED(ewa_volume_free) ewa_volume volume;
        assert_int_equal(sample_load(context, &file, file.size_bytes, "i.nii", NULL, &volume), EWA_OK);
        assert_int_equal(volume.type, EWA_F32);
        for (int i = 0; i < SAMPLE_VOXELS; i++)
            assert_true(((const float *)volume.voxels)[i] == 100 + 0.5f * (float)i);
    }
}

TEST_ON(test_nifti_packed_and_pairs, 1) {
    sample_file whole, packed = {.size_bytes = 0}, head;
    sample_make(4, &whole);
    sample_put_packed(&packed, true, whole.bytes, whole.size_bytes);
    ewa_volume volume;
    assert_int_equal(sample_load(context, &packed, packed.size_bytes, "x", NULL, &volume), EWA_OK);
    sample_check(&volume);
    ewa_volume_free(&volume);
    char path[512], image[512];
    sample_nifti_head(false, true, "ni1", &head);
    sample_store_real(head.bytes + 108, true, false, 0);
    scratch_write(scratch_path("pair.hdr", path), head.bytes, 348);
    sample_file data = {.size_bytes = 0};
    sample_put_numbers(&data, EWA_I16, true);
    scratch_write(scratch_path("pair.img", image), data.bytes, data.size_bytes);
    assert_int_equal(ewa_volume_load(context, path, NULL, &volume), EWA_OK);
    sample_check(&volume);
    ewa_volume_free(&volume);
    // From memory, nothing says where the other file is.
    assert_int_equal(sample_load(context, &head, 348, "pair.hdr", NULL, &volume), EWA_ERROR_UNSUPPORTED);
    remove(image);
    assert_int_equal(ewa_volume_load(context, path, NULL, &volume), EWA_ERROR_IO);
}

TEST_ON(test_meta_places, 1) {
    sample_file file = {.size_bytes = 0};
    sample_text(&file, "NDims = 3\nDimSize = 2 3 4\nElementType = MET_SHORT\nElementByteOrderMSB = True\n"
                       "ElementSpacing = 2 3 4\nTransformMatrix = 0 1 0 1 0 0 0 0 -1\nOffset = 5 6 7\n"
                       "ElementDataFile = LOCAL\n");
    sample_put_numbers(&file, EWA_I16, true);
    // Each row of the matrix is the direction of an axis.
    check_place(context, &file, "p.mha", (const double[12]){0, 3, 0, 5, 2, 0, 0, 6, 0, 0, -4, 7});
}

/// Cells, axes that are turned, places of extents that do not begin at zero.
TEST_ON(test_vti_places, 1) {
    static const struct {
        const char *image, *section;
        double place[12];
    } cases[] = {
        {"WholeExtent=\"2 3 0 2 -1 2\" Origin=\"10 20 30\" Spacing=\"2 3 4\"",
         "PointData",
         {2, 0, 0, 14, 0, 3, 0, 20, 0, 0, 4, 26}},
        {"WholeExtent=\"0 2 0 3 0 4\" Origin=\"10 20 30\" Spacing=\"2 3 4\"",
         "CellData",
         {2, 0, 0, 11, 0, 3, 0, 21.5, 0, 0, 4, 32}},
        {"WholeExtent=\"1 2 0 2 0 3\" Origin=\"10 20 30\" Spacing=\"2 3 4\" Direction=\"0 1 0 1 0 0 0 0 -1\"",
         "PointData",
         {0, 3, 0, 10, 2, 0, 0, 22, 0, 0, -4, 30}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sample_file file = {.size_bytes = 0};
        sample_text(&file, "<VTKFile type=\"ImageData\"><ImageData ");
        sample_text(&file, cases[i].image);
        sample_text(&file, "><Piece><");
        sample_text(&file, cases[i].section);
        sample_text(&file, "><DataArray type=\"UInt8\" format=\"ascii\">");
        for (int n = 0; n < SAMPLE_VOXELS; n++) {
            char word[16];
            snprintf(word, sizeof word, "%d ", n);
            sample_text(&file, word);
        }
        sample_text(&file, "</DataArray></");
        sample_text(&file, cases[i].section);
        sample_text(&file, "></Piece></ImageData></VTKFile>");
        check_place(context, &file, "p.vti", cases[i].place);
    }
}

static void put_other(sample_file *file, bool text, int bytes) {
    for (int i = 0; i < bytes; i++) sample_text(file, text ? "7 " : "\n");
}

static void put_sample(sample_file *file) {
    char word[16];
    for (int i = 0; i < SAMPLE_VOXELS; i++) {
        snprintf(word, sizeof word, "%d ", i);
        sample_text(file, word);
    }
}

/// Legacy files with several arrays, in text and in bytes: scalars of points are taken before a field, both before those of
/// cells, whose grid is smaller by one along each axis. Other arrays are stepped over, bytes that look like lines too.
TEST_ON(test_vtk_arrays, 1) {
    static const double of_points[12] = {2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30},
                        of_cells[12] = {2, 0, 0, 11, 0, 3, 0, 21.5, 0, 0, 4, 32};
    for (int kind = 0; kind < 8; kind++) {
        const bool text = kind % 2, cells = kind / 2 == 2 || kind / 2 == 3;
        sample_file file = {.size_bytes = 0};
        sample_text(&file, text ? "# vtk DataFile Version 4.2\nt\nASCII\n" : "# vtk DataFile Version 4.2\nt\nBINARY\n");
        sample_text(&file, "DATASET STRUCTURED_POINTS\n");
        sample_text(&file, cells ? "DIMENSIONS 3 4 5\n" : "DIMENSIONS 2 3 4\n");
        sample_text(&file, "SPACING 2 3 4\nORIGIN 10 20 30\n");
        if (kind / 2 == 0) { // scalars of points, behind a field of them and arrays of cells
            sample_text(&file, "CELL_DATA 6\nSCALARS c unsigned_char\nLOOKUP_TABLE default\n");
            put_other(&file, text, 6);
            sample_text(&file, "\nFIELD f 2\na%20b 1 6 unsigned_char\n");
            put_other(&file, text, 6);
            sample_text(&file, "\nc 2 6 unsigned_char\n");
            put_other(&file, text, 12);
            sample_text(&file, "\nPOINT_DATA 24\nFIELD f 1\na 1 24 unsigned_char\n");
            put_other(&file, text, 24);
            sample_text(&file, "\nSCALARS s unsigned_char 1\nLOOKUP_TABLE default\n");
        } else if (kind / 2 == 1) { // a field of points, behind scalars of cells and vectors
            sample_text(&file, "CELL_DATA 6\nSCALARS c unsigned_char\nLOOKUP_TABLE default\n");
            put_other(&file, text, 6);
            sample_text(&file, "\nPOINT_DATA 24\nNORMALS v char\n");
            put_other(&file, text, 72);
            sample_text(&file, "\nMETADATA\nINFORMATION 0\n\nFIELD f 3\nm 2 24 unsigned_char\n");
            put_other(&file, text, 48);
            sample_text(&file, "\nMETADATA\nINFORMATION 1\nNAME x LOCATION y\nDATA 1 7\n\ntime 1 1 unsigned_char\n");
            put_other(&file, text, 1);
            sample_text(&file, "\ns 1 24 unsigned_char\n");
        } else if (kind / 2 == 2) { // scalars of cells, behind a field of them
            sample_text(&file, "CELL_DATA 24\nFIELD f 1\na 1 24 unsigned_char\n");
            put_other(&file, text, 24);
            sample_text(&file, "\nSCALARS s unsigned_char\nLOOKUP_TABLE default\n");
        } else { // a field of cells
            sample_text(&file, "CELL_DATA 24\nTENSORS t unsigned_char\n");
            put_other(&file, text, 216);
            sample_text(&file, "\nFIELD f 1\ns 1 24 unsigned_char\n");
        }
        if (text)
            put_sample(&file);
        else
            sample_put_numbers(&file, EWA_U8, false);
        sample_text(&file, "\nPOINT_DATA 60\nVECTORS v bit\n");
        check_place(context, &file, "a.vtk", cells ? of_cells : of_points);
    }
}

/// A MetaImage of two axes may have spacings and offsets of three.
TEST_ON(test_meta_slice, 1) {
    sample_file file = {.size_bytes = 0};
    OWNED(ewa_volume_free) ewa_volume volume;
    sample_text(&file, "NDims = 2\nDimSize = 2 3\nElementType = MET_UCHAR\nElementSpacing = 2 4 5\nOffset = 1 2 3\n"
                       "ElementDataFile = LOCAL\nabcdef");
    assert_int_equal(sample_load(context, &file, file.size_bytes, "a.mha", NULL, &volume), EWA_OK);
    assert_true(volume.dims[0] == 2 && volume.dims[1] == 3 && volume.dims[2] == 1);
    assert_true(volume.index_to_world[0] == 2 && volume.index_to_world[5] == 4 && volume.index_to_world[3] == 1);
}

/// A slice has one layer of cells along its normal.
TEST_ON(test_vtk_slice, 1) {
    sample_file file = {.size_bytes = 0};
    OWNED(ewa_volume_free) ewa_volume volume;
    sample_text(&file, "# vtk DataFile Version 4.2\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 1 2\nCELL_DATA 2\n"
                       "SCALARS s float\nLOOKUP_TABLE default\n1 2\n");
    assert_int_equal(sample_load(context, &file, file.size_bytes, "a.vtk", NULL, &volume), EWA_OK);
    assert_true(volume.dims[0] == 2 && volume.dims[1] == 1 && volume.dims[2] == 1);
}

/// Three bytes for each place: colours, by the kinds, by what early writers did, and in XML images.
TEST_ON(test_colors, 1) {
    sample_file files[2] = {{.size_bytes = 0}, {.size_bytes = 0}};
    sample_text(&files[0], "NRRD0001\ntype: unsigned char\ndimension: 3\nsizes: 3 4 5\nencoding: raw\n\n");
    uint8_t colors[60];
    for (int i = 0; i < 60; i++) colors[i] = (uint8_t)(4 * i);
    sample_put(&files[0], colors, 60);
    sample_text(&files[1],
                "<VTKFile><ImageData WholeExtent=\"0 3 0 4 0 0\"><Piece><PointData><DataArray type=\"UInt8\" "
                "NumberOfComponents=\"3\" format=\"ascii\">");
    for (int i = 0; i < 60; i++) {
        char word[16];
        snprintf(word, sizeof word, "%d ", 4 * i);
        sample_text(&files[1], word);
    }
    sample_text(&files[1], "</DataArray></PointData></Piece></ImageData></VTKFile>");
    for (int f = 0; f < 2; f++) {
        OWNED(ewa_volume_free) ewa_volume volume;
        assert_int_equal(sample_load(context, &files[f], files[f].size_bytes, "c", NULL, &volume), EWA_OK);
        assert_true(volume.dims[0] == 4 && volume.dims[1] == 5 && volume.dims[2] == 1);
        for (int i = 0; i < 20; i++) {
            const double luminance = 0.2126 * 12 * i + 0.7152 * (12 * i + 4) + 0.0722 * (12 * i + 8);
            assert_true(fabs((double)((const float *)volume.voxels)[i] - luminance) < 1e-4);
        }
    }
}

/// Which files say how a patient lies.
TEST_ON(test_anatomical, 1) {
    static const char *const fields[] = {"", "space: RAS\n", "space: left-posterior-superior\n",
                                         "space: 3D-right-handed\n"};
    for (int i = 0; i < 4; i++) {
        sample_file file;
        char text[128];
        snprintf(text, sizeof text, "encoding: raw\n%s", fields[i]);
        sample_nrrd(text, &file);
        sample_put_numbers(&file, EWA_U8, false);
        OWNED(ewa_volume_free) ewa_volume volume;
        assert_int_equal(sample_load(context, &file, file.size_bytes, "x", NULL, &volume), EWA_OK);
        assert_true(volume.anatomical == (i == 1 || i == 2));
    }
}

TEST_ON(test_raw_numbers, 1) {
    sample_file file = {.size_bytes = 0};
    ewa_volume volume;
    WITH_DEFAULTS(ewa_volume_load_options, options);
    options.dims[0] = 2, options.dims[1] = 3, options.dims[2] = 4;
    options.type = EWA_U16;
    options.big_endian = true;
    options.header_bytes = 5;
    sample_text(&file, "abcde");
    sample_put_numbers(&file, EWA_U16, true);
    assert_int_equal(sample_load(context, &file, file.size_bytes, "x", &options, &volume), EWA_OK);
    assert_int_equal(volume.type, EWA_U16);
    sample_check(&volume);
    ewa_volume_free(&volume);
    // One byte too few or too many: the dims are wrong.
    assert_int_equal(sample_load(context, &file, file.size_bytes - 1, "x", &options, &volume),
                     EWA_ERROR_FORMAT);
    sample_text(&file, "!");
    assert_int_equal(sample_load(context, &file, file.size_bytes, "x", &options, &volume), EWA_ERROR_FORMAT);
    // The same in gzip.
    sample_file packed = {.size_bytes = 0};
    sample_put_packed(&packed, true, file.bytes, file.size_bytes);
    assert_int_equal(sample_load(context, &packed, packed.size_bytes, "x", &options, &volume),
                     EWA_ERROR_FORMAT);
    packed.size_bytes = 0;
    sample_put_packed(&packed, true, file.bytes, file.size_bytes - 1);
    assert_int_equal(sample_load(context, &packed, packed.size_bytes, "x", &options, &volume), EWA_OK);
    ewa_volume_free(&volume);
    // By the name.
    file.size_bytes = 0;
    sample_put_numbers(&file, EWA_I16, true);
    assert_int_equal(sample_load(context, &file, file.size_bytes, "a/b_2x3x4_int16be.raw", NULL, &volume),
                     EWA_OK);
    assert_int_equal(volume.type, EWA_I16);
    sample_check(&volume);
    ewa_volume_free(&volume);
    assert_int_equal(sample_load(context, &file, file.size_bytes, "b_2x3_int16be.raw", NULL, &volume),
                     EWA_ERROR_FORMAT);
}

TEST_ON(test_parts, 1) {
    uint8_t numbers[8 * SAMPLE_VOXELS];
    sample_numbers(EWA_U8, false, numbers);
    char path[512], header[512];
    for (int k = 0; k < 4; k++) {
        char name[32];
        snprintf(name, sizeof name, "slice.%03d", 10 - 2 * k);
        scratch_write(scratch_path(name, path), numbers + 6 * k, 6);
    }
    static const char *const headers[] = {
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\ndata file: slice.%03d 10 4 -2\n",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\ndata file: LIST\nslice.010\n"
        "slice.008\nslice.006\nslice.004\n",
        "NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nElementDataFile = LIST\nslice.010\nslice.008\n"
        "slice.006\nslice.004",
    };
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; i++) {
        scratch_write(scratch_path("parts.nhdr", header), headers[i], strlen(headers[i]));
        OWNED(ewa_volume_free) ewa_volume volume;
        assert_int_equal(ewa_volume_load(context, header, NULL, &volume), EWA_OK);
        sample_check(&volume);
    }
    static const struct {
        const char *file;
        ewa_status status;
    } bad[] = {{"slice.%03d 10 5 -2", EWA_ERROR_FORMAT}, // three files
               {"slice.%03d 10 1 -2", EWA_ERROR_IO},     // one that is not there
               {"slice.%s 10 4 -2", EWA_ERROR_FORMAT},
               {"slice.%03d%d 10 4 -2", EWA_ERROR_FORMAT},
               {"slice.%03d 10", EWA_ERROR_FORMAT},
               {"slice.%03d 10 4 0", EWA_ERROR_FORMAT},
               {"slice.010", EWA_ERROR_FORMAT},
               {"/dev/zero", EWA_ERROR_IO},
               {".", EWA_ERROR_IO},
               {"no such file", EWA_ERROR_IO}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n"
                 "data file: %s\n",
                 bad[i].file);
        scratch_write(scratch_path("parts.nhdr", header), text, strlen(text));
        ewa_volume volume;
        if (ewa_volume_load(context, header, NULL, &volume) != bad[i].status) fail_msg("%s", bad[i].file);
        assert_null(volume.voxels);
    }
}

TEST_LOGGED(test_numbers_that_are_none, 1) {
    sample_file file = {.size_bytes = 0};
    sample_text(&file, "\xef\xbb\xbfNRRD0004\ntype: float\ndimension: 3\nsizes: 2 1 2\nencoding: txt\n\n1 nan inf 4\n"); // a byte order mark
    OWNED(ewa_volume_free) ewa_volume volume;
    assert_int_equal(sample_load(context, &file, file.size_bytes, "nan.nrrd", NULL, &volume), EWA_OK);
    assert_int_equal(log->count, 1);
    assert_non_null(strstr(log->text, "2 of 4 voxels"));
    const float *voxels = volume.voxels;
    assert_true(voxels[0] == 1 && isnan(voxels[1]) && isnan(voxels[2]) && voxels[3] == 4);
    ewa_volume_facts facts;
    assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
    assert_true(facts.finite_count == 2 && facts.low == 1 && facts.high == 4 && facts.mean == 2.5);
}

TEST_ON(test_saving, 1) {
    static const ewa_type types[] = {EWA_U8, EWA_I8, EWA_U16, EWA_I16, EWA_F32};
    char path[512];
    scratch_path("saved.nrrd", path);
    for (size_t t = 0; t < 2 * sizeof types / sizeof types[0]; t++) {
        OWNED(ewa_volume_free) ewa_volume volume, again;
        assert_int_equal(ewa_volume_create(context, (const uint32_t[3]){5, 4, 3}, types[t / 2], &volume),
                         EWA_OK);
        const size_t bytes = 60 * ewa_type_bytes(types[t / 2]);
        for (size_t i = 0; i < bytes; i++) ((uint8_t *)volume.voxels)[i] = (uint8_t)(i * 7 % 64);
        const double place[12] = {0.1, 2, 3, 1.0 / 3, -4, 0.5, 6, -7e-9, 7, 8, 9.25, 1e6};
        memcpy(volume.index_to_world, place, sizeof place);
        WITH_DEFAULTS(ewa_volume_save_options, options);
        options.plain = t & 1;
        assert_int_equal(ewa_volume_save(&volume, path, &options), EWA_OK);
        assert_int_equal(ewa_volume_load(context, path, NULL, &again), EWA_OK);
        assert_int_equal(again.type, volume.type);
        assert_memory_equal(again.dims, volume.dims, sizeof again.dims);
        assert_memory_equal(again.voxels, volume.voxels, bytes);
        for (int i = 0; i < 12; i++)
            assert_true(fabs(again.index_to_world[i] - place[i]) <= 1e-15 * fabs(place[i]));
        assert_int_equal(ewa_volume_save(&volume, "volume.ply", NULL), EWA_ERROR_UNSUPPORTED);
    }
}

/// Voxels of a file of the shared data; false when there is none.
static bool load_data(ewa_context *context, const char *name, ewa_volume *volume) {
    char relative[256], path[512];
    snprintf(relative, sizeof relative, "volumes/%s", name);
    if (!check_data(relative, path, sizeof path)) return false;
    assert_int_equal(ewa_volume_load(context, path, NULL, volume), EWA_OK);
    return true;
}

TEST_ON(test_real_files, 0) {
    for (size_t i = 0; i < sizeof volume_facts / sizeof volume_facts[0]; i++) {
        OWNED(ewa_volume_free) ewa_volume volume;
        ewa_volume_facts facts;
        if (!load_data(context, volume_facts[i].name, &volume)) continue;
        assert_memory_equal(volume.dims, volume_facts[i].dims, sizeof volume.dims);
        assert_int_equal(volume.type, volume_facts[i].type);
        assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
        if (fabs(facts.low - volume_facts[i].low) > 1e-8 || fabs(facts.high - volume_facts[i].high) > 1e-7)
            fail_msg("%s: %.9g .. %.9g", volume_facts[i].name, facts.low, facts.high);
    }
}

/// The same voxels in different wrappings.
TEST_ON(test_real_twins, 0) {
    static const char *const twins[][2] = {
        {"aneurism.vti", "aneurism_256x256x256_uint8.raw.gz"},
        {"nrrd_variants/BallBinary30x30x30.nrrd", "nrrd_variants/BallBinary30x30x30.nhdr"},
        {"nrrd_variants/BallBinary30x30x30.nrrd", "nrrd_variants/BallBinary30x30x30_gz.nrrd"},
        {"nrrd_variants/BallBinary30x30x30.nrrd", "nrrd_variants/BallBinary30x30x30_bz2.nrrd"},
        {"nrrd_variants/BallBinary30x30x30.nrrd", "nrrd_variants/BallBinary30x30x30_gz_lineskip.nrrd"},
    };
    for (size_t i = 0; i < sizeof twins / sizeof twins[0]; i++) {
        ewa_volume a, b;
        if (!load_data(context, twins[i][0], &a)) continue;
        if (load_data(context, twins[i][1], &b)) {
            assert_memory_equal(a.dims, b.dims, sizeof a.dims);
            assert_int_equal(a.type, b.type);
            assert_memory_equal(a.voxels, b.voxels,
                                (size_t)a.dims[0] * a.dims[1] * a.dims[2] * ewa_type_bytes(a.type));
            ewa_volume_free(&b);
        }
        ewa_volume_free(&a);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
