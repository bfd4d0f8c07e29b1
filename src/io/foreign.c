// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that people try and that hold neither points nor triangles, or none that can be read, by what they begin with.
#include "io/foreign.h"
#include "io/text.h"

#include <stdbool.h>

enum { LOOKED_BYTES = 4096, DICOM_AT = 128, TAR_AT = 257 };

#define EXPORT_MESH(format) format ", which is not read: exported as glTF or OBJ it is"

static bool has(const char *text, size_t length, const char *part) {
    const size_t size = strlen(part);
    for (size_t i = 0; i + size <= length; i++)
        if (memcmp(text + i, part, size) == 0) return true;
    return false;
}

/// The first line's first word, behind blanks, empty lines and remarks.
static ewa_text first_word(const char *text, size_t length) {
    ewa_cursor cursor = {text, text + length, 1};
    ewa_text word = ewa_cursor_word(&cursor);
    while (!word.length && cursor.at < cursor.end) {
        ewa_cursor_next_line(&cursor);
        word = ewa_cursor_word(&cursor);
    }
    return word;
}

const char *ewa_foreign_kind(const uint8_t *bytes, size_t size_bytes) {
    static const struct {
        const char *start, *kind;
    } starts[] = {
        {"version https://git-lfs", "a pointer of Git LFS in place of the file, which 'git lfs pull' brings"},
        {"# Bundle file", "a reconstruction of Bundler, which is not read; its points are in the PLY that Bundler writes beside it"},
        {"PK\003\004", "a ZIP archive: unpack it, and name the files in it"},
        {"\037\213", "packed by gzip: unpack it"},
        {"7z\274\257\047\034", "a 7z archive: unpack it, and name the files in it"},
        {"Rar!", "a RAR archive: unpack it, and name the files in it"},
        {"%PDF", "a PDF, which has no points"},
        {"ISO-10303-21", "CAD (STEP), which has no triangles: exported as STL, OBJ or glTF it is read"},
        {"\223NUMPY", "an array of NumPy: in Python, ewa.render(numpy.load(...)) draws it"},
        {"\211HDF", "HDF5, which is not read"},
        {"CDF", "netCDF, which is not read"},
        {"SIMPLE  =", "FITS, which is not read"},
        {"BLENDER", "a project of Blender: exported as glTF, OBJ or PLY it is read"},
        {"#usda", EXPORT_MESH("USD")},
        {"PXR-USDC", EXPORT_MESH("USD")},
        {"#VRML", EXPORT_MESH("VRML")},
        {"Kaydara FBX", EXPORT_MESH("FBX")},
        {"MD5Version", EXPORT_MESH("a model of a game (MD5)")},
        {"IDP2", EXPORT_MESH("a model of a game (MD2)")},
        {"IDP3", EXPORT_MESH("a model of a game (MD3)")},
        {"BB3D", EXPORT_MESH("a model of a game (Blitz3D)")},
        {"Caligari", EXPORT_MESH("a model of TrueSpace")},
        {"AC3D", EXPORT_MESH("a model of AC3D")},
    };
    const char *text = size_bytes ? (const char *)bytes : "";
    const size_t looked = size_bytes < LOOKED_BYTES ? size_bytes : LOOKED_BYTES;
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        const size_t length = strlen(starts[i].start);
        if (size_bytes >= length && memcmp(text, starts[i].start, length) == 0) return starts[i].kind;
    }
    if (looked >= DICOM_AT + 4 && memcmp(text + DICOM_AT, "DICM", 4) == 0)
        return "DICOM, which is not read: a NIfTI file of its series is, as dcm2niix makes it";
    if (looked >= TAR_AT + 5 && memcmp(text + TAR_AT, "ustar", 5) == 0) return "an archive (tar): unpack it, and name the files in it";
    const ewa_text word = first_word(text, looked);
    if (ewa_text_is_any_case(word, "newmtl")) return "the materials of a mesh (MTL): name the OBJ that uses them";
    const bool json = word.length && (word.chars[0] == '{' || word.chars[0] == '[');
    if (json && (has(text, looked, "\"transform_matrix\"") || has(text, looked, "\"intrinsic_matrix\"")))
        return "cameras (JSON), which have no points: they are given with what they took";
    if (json)
        return "JSON that is no glTF, no octree (EPT), no set of Gaussians (SOG) and no scene file";
    if (word.length && word.chars[0] == '<') {
        if (has(text, looked, "<VTKFile"))
            return has(text, looked, "\"ImageData\"") ? "a grid of voxels (VTK), which is a volume: its name has to end in .vti"
                                                      : "a kind of VTK's files that is not read";
        if (has(text, looked, "<html") || has(text, looked, "<HTML") || has(text, looked, "<!DOCTYPE html"))
            return "a page of HTML, as servers send where the file is not";
        if (has(text, looked, "<COLLADA")) return EXPORT_MESH("COLLADA");
        if (has(text, looked, "<X3D")) return EXPORT_MESH("X3D");
    }
    return NULL;
}
