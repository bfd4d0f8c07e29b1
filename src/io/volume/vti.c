// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// VTK's XML image data; how its arrays are stored is io/vtk_xml.h's.
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 12 to 17; what VTK 9 adds
// (Direction) after its writer's files.
#include "base/base.h"
#include "io/volume/file.h"
#include "io/volume/text.h"
#include "io/vtk_xml.h"

static const ewa_text_word types[] = {
    {"Int8", EWA_I8},     {"UInt8", EWA_U8},    {"Int16", EWA_I16},      {"UInt16", EWA_U16},
    {"Int32", EWA_I32},   {"UInt32", EWA_U32},  {"Int64", EWA_FILE_I64}, {"UInt64", EWA_FILE_U64},
    {"Float32", EWA_F32}, {"Float64", EWA_F64},
};

/// An array of the file, as far as it suits.
typedef struct found_array {
    ewa_xml_tag tag;
    int rank; ///< 0: none; 1: any; 2: of one number per voxel; 3: the active one
} found_array;

/// What of a file matters.
typedef struct vti {
    const ewa_volume_input *in;
    ewa_vtk_xml xml;
    ewa_xml_tag image, piece;
    bool has_image;
    int piece_count;
    found_array points, cells;
} vti;

/// Keeps an array that suits better than what there is; `active` is the name of the active one.
static void offer_array(const ewa_xml_tag *tag, const char *active, found_array *best) {
    char value[EWA_VTK_ATTRIBUTE_BYTES];
    const bool one = !ewa_vtk_attribute(tag, "NumberOfComponents", value) || strcmp(value, "1") == 0;
    const bool is_active = active[0] && ewa_vtk_attribute(tag, "Name", value) && strcmp(value, active) == 0;
    const int rank = is_active ? 3 : one ? 2 : 1;
    if (rank > best->rank) *best = (found_array){*tag, rank};
}

/// Goes through the tags up to appended data or the end.
static void find_tags(vti *file) {
    const char *at = file->xml.text, *end = file->xml.has_appended ? file->xml.appended.open : file->xml.end;
    char active[EWA_VTK_ATTRIBUTE_BYTES] = "";
    found_array *section = NULL;
    ewa_xml_tag tag;
    while (ewa_xml_next(&at, end, &tag)) {
        if (ewa_xml_is(&tag, "PointData") || ewa_xml_is(&tag, "CellData")) {
            section = tag.closing ? NULL : tag.name[0] == 'P' ? &file->points : &file->cells;
            if (!ewa_vtk_attribute(&tag, "Scalars", active)) active[0] = 0;
        } else if (tag.closing) {
            continue;
        } else if (ewa_xml_is(&tag, "ImageData") && !file->has_image) {
            file->image = tag;
            file->has_image = true;
        } else if (ewa_xml_is(&tag, "Piece")) {
            if (!file->piece_count++) file->piece = tag;
        } else if (section && ewa_xml_is(&tag, "DataArray")) {
            offer_array(&tag, active, section);
        }
    }
}

static ewa_status check_tags(const vti *file) {
    const ewa_volume_input *in = file->in;
    if (!file->xml.has_root || !file->has_image || !(file->points.rank || file->cells.rank))
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTI: no ImageData with PointData or CellData");
    if (file->piece_count > 1)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTI: %d pieces; one can be read",
                               file->piece_count);
    return EWA_OK;
}

/// Takes dims and places from the tags; `cells`: the numbers are of the cells between the points.
static ewa_status take_place(const vti *file, bool cells, ewa_volume_header *header) {
    char value[EWA_VTK_ATTRIBUTE_BYTES] = "";
    double extent[6], spacings[3] = {1, 1, 1}, origin[3] = {0}, turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (!(file->piece_count && ewa_vtk_attribute(&file->piece, "Extent", value)) &&
        !ewa_vtk_attribute(&file->image, "WholeExtent", value))
        value[0] = 0;
    if (ewa_text_numbers(value, 6, extent) != 6) return ewa_vtk_broken(&file->xml, "the extent", value);
    header->placed = ewa_vtk_attribute(&file->image, "Origin", value);
    if (header->placed && ewa_text_numbers(value, 3, origin) != 3) return ewa_vtk_broken(&file->xml, "Origin", value);
    if (ewa_vtk_attribute(&file->image, "Spacing", value) && ewa_text_numbers(value, 3, spacings) != 3)
        return ewa_vtk_broken(&file->xml, "Spacing", value);
    if (ewa_vtk_attribute(&file->image, "Direction", value) && ewa_text_numbers(value, 9, turn) != 9)
        return ewa_vtk_broken(&file->xml, "Direction", value);
    memcpy(header->first_world, origin, sizeof origin);
    for (int axis = 0; axis < 3; axis++) {
        const double steps = extent[2 * axis + 1] - extent[2 * axis];
        // A slice has no cells along its normal: one layer.
        const bool between = cells && steps >= 1;
        const double side = between ? steps : steps + 1;
        if (!(side >= 1 && side <= 4294967295.0)) return ewa_vtk_broken(&file->xml, "an extent of a side", "below 1");
        if (spacings[axis] == 0) return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "VTI: a spacing of zero");
        header->dims[axis] = (uint64_t)side;
        const double first = extent[2 * axis] + (between ? 0.5 : 0);
        for (int k = 0; k < 3; k++) {
            header->directions[axis][k] = turn[3 * k + axis] * spacings[axis];
            header->first_world[k] += first * header->directions[axis][k];
        }
    }
    return EWA_OK;
}

static ewa_status take_type(const vti *file, const ewa_xml_tag *array, ewa_volume_header *header) {
    char value[EWA_VTK_ATTRIBUTE_BYTES] = "";
    if (!ewa_vtk_attribute(array, "type", value)) value[0] = 0;
    header->number = ewa_text_find(types, sizeof types / sizeof types[0], value);
    if (header->number < 0)
        return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "VTI: type '%.80s'", value);
    header->big_endian = file->xml.big_endian;
    if (!ewa_vtk_attribute(array, "NumberOfComponents", value) || strcmp(value, "1") == 0) return EWA_OK;
    const bool color = header->number == EWA_U8 && (strcmp(value, "3") == 0 || strcmp(value, "4") == 0);
    if (!color)
        return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED,
                               "VTI: '%.40s' numbers per voxel; one, or a colour of bytes, can be drawn",
                               value);
    header->component_count = (uint32_t)(value[0] - '0');
    return EWA_OK;
}

static ewa_status take_numbers(const vti *file, const ewa_xml_tag *array, ewa_volume_header *header) {
    ewa_vtk_stored stored;
    EWA_TRY(ewa_vtk_xml_find(&file->xml, array, &stored));
    header->packing = stored.packing;
    return stored.owned ? ewa_volume_add_memory(file->in, stored.owned, stored.owned_bytes, &header->pieces)
                        : ewa_volume_add_bytes(file->in, stored.bytes, stored.size_bytes, &header->pieces);
}

bool ewa_vti_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes > 8 && (memcmp(bytes, "<?xml", 5) == 0 || memcmp(bytes, "<VTKFile", 8) == 0);
}

ewa_status ewa_vti_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    vti file = {.in = in, .xml = {.context = in->context, .name = in->name, .kind = "VTI"}};
    ewa_vtk_xml_open(&file.xml, in->bytes, in->size_bytes);
    find_tags(&file);
    EWA_TRY(check_tags(&file));
    const bool cells = file.points.rank == 0;
    const ewa_xml_tag *array = cells ? &file.cells.tag : &file.points.tag;
    EWA_TRY(take_place(&file, cells, header));
    EWA_TRY(take_type(&file, array, header));
    EWA_TRY(take_numbers(&file, array, header));
    char name[EWA_VTK_ATTRIBUTE_BYTES];
    if (ewa_vtk_attribute(array, "Name", name))
        ewa_report(in->context, EWA_SEVERITY_INFO, "%s: the array '%.80s'%s", in->name, name,
                   cells ? " of the cells" : "");
    return EWA_OK;
}
