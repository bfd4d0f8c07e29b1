// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lists of VTK's XML files: those of parallel writers (.pvtp, .pvtu, .pvts, .pvtr), of blocks (.vtm) and of times (.pvd). What
// they name is read as if it were pieces of one file.
//
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 17 to 19; lists of blocks and times after files of
// VTK 9 and ParaView 5.
#include "base/base.h"
#include "io/mesh/formats.h"
#include "io/mesh/vtk_cells.h"
#include "io/referenced_file.h"
#include "io/vtk_xml.h"

enum { MAX_DEPTH = 4 }; ///< of lists that lists name: times of blocks of parallel pieces

/// Kinds of lists, and what of them names a file.
static const struct list_kind {
    const char *kind, *tag, *attribute;
} list_kinds[] = {{"PPolyData", "Piece", "Source"},
                  {"PUnstructuredGrid", "Piece", "Source"},
                  {"PStructuredGrid", "Piece", "Source"},
                  {"PRectilinearGrid", "Piece", "Source"},
                  {"vtkMultiBlockDataSet", "DataSet", "file"},
                  {"vtkPartitionedDataSet", "DataSet", "file"},
                  {"vtkPartitionedDataSetCollection", "DataSet", "file"},
                  {"Collection", "DataSet", "file"}};

/// The kind of list that bytes are; NULL: none.
static const struct list_kind *kind_of(const uint8_t *bytes, size_t size_bytes) {
    const char *at = (const char *)bytes;
    char value[EWA_VTK_ATTRIBUTE_BYTES];
    ewa_xml_tag tag;
    if (!size_bytes || *at != '<' || !ewa_xml_next(&at, at + size_bytes, &tag) || !ewa_xml_is(&tag, "VTKFile") ||
        !ewa_vtk_attribute(&tag, "type", value))
        return NULL;
    for (size_t i = 0; i < sizeof list_kinds / sizeof list_kinds[0]; i++)
        if (strcmp(value, list_kinds[i].kind) == 0) return &list_kinds[i];
    return NULL;
}

bool ewa_mesh_is_vtk_list(const uint8_t *bytes, size_t size_bytes) { return kind_of(bytes, size_bytes) != NULL; }

static ewa_status read_any(ewa_mesh_build *build, const char *path, const ewa_file *file, int depth);

/// Reads what a list names.
static ewa_status read_named(ewa_mesh_build *build, const char *path, const char *name, int depth) {
    char found[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    ewa_file file;
    if (!ewa_referenced_file_find(build->context, path, name, false, found, reason) ||
        !ewa_referenced_file_map(build->context, path, (ewa_text){name, strlen(name)}, &file, reason))
        return ewa_fail(build->context, EWA_ERROR_IO, "%s: '%.200s', which it names: %s", path, name, reason);
    const ewa_status status = read_any(build, found, &file, depth);
    ewa_file_unmap(build->context, &file);
    return status;
}

static ewa_status read_list(ewa_mesh_build *build, const char *path, const uint8_t *bytes, size_t size_bytes, int depth) {
    const struct list_kind *kind = kind_of(bytes, size_bytes);
    const char *at = (const char *)bytes, *end = at + size_bytes;
    char name[EWA_VTK_ATTRIBUTE_BYTES], time[EWA_VTK_ATTRIBUTE_BYTES], first_time[EWA_VTK_ATTRIBUTE_BYTES] = "";
    bool any = false, later = false;
    if (depth == MAX_DEPTH)
        return ewa_fail(build->context, EWA_ERROR_FORMAT, "%s: VTK: lists name each other %d deep", path, MAX_DEPTH);
    for (ewa_xml_tag tag; ewa_xml_next(&at, end, &tag);) {
        if (tag.closing || !ewa_xml_is(&tag, kind->tag) || !ewa_vtk_attribute(&tag, kind->attribute, name)) continue;
        if (!ewa_vtk_attribute(&tag, "timestep", time)) time[0] = 0;
        if (!any) memcpy(first_time, time, sizeof time);
        later |= strcmp(time, first_time) != 0;
        any = true;
        if (strcmp(time, first_time) == 0) EWA_TRY(read_named(build, path, name, depth + 1));
    }
    if (!any) return ewa_fail(build->context, EWA_ERROR_FORMAT, "%s: VTK: the list names no files", path);
    if (later)
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: of several times the first is read: %s", path, first_time);
    return EWA_OK;
}

static ewa_status read_any(ewa_mesh_build *build, const char *path, const ewa_file *file, int depth) {
    if (ewa_mesh_is_vtk_list(file->bytes, file->size_bytes)) return read_list(build, path, file->bytes, file->size_bytes, depth);
    if (ewa_mesh_is_vtk_xml(file->bytes, file->size_bytes))
        return ewa_mesh_read_vtk_pieces(build, path, file->bytes, file->size_bytes);
    return ewa_fail(build->context, EWA_ERROR_UNSUPPORTED, "%s: no mesh in VTK's XML, as what names it is", path);
}

ewa_status ewa_mesh_read_vtk_list(ewa_mesh_build *build) {
    const ewa_mesh_source *source = build->source;
    if (!source->path)
        return ewa_fail(build->context, EWA_ERROR_UNSUPPORTED, "%s: VTK: a list of files, which are not read without its folder",
                        source->name);
    return read_list(build, source->path, source->bytes, source->size_bytes, 0);
}
