// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// VTK's XML image data: numbers as text, in base64 within the array or appended, raw or packed by zlib.
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 12 to 17; what VTK 9 adds
// (Direction, keys within arrays) after its writer's files.
#include "base/base.h"
#include "io/mesh/base64.h"
#include "io/volume/file.h"
#include "io/volume/text.h"
#include "io/volume/xml_tags.h"

enum { ATTRIBUTE_BYTES = 256, PACKED_HEAD_WORDS = 3 };

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
    const char *text, *end;
    ewa_xml_tag root, image, piece, appended;
    bool has_root, has_image, has_appended;
    bool raw;  ///< the appended data are bytes, which no tag is looked for in
    bool ends; ///< with </VTKFile>
    int piece_count;
    found_array points, cells;
    bool wide; ///< block headers have 64 bits
    bool packed, big_endian;
} vti;

/// Where the numbers of an array are: bytes, or their base64 text.
typedef struct array_bytes {
    const char *text;
    size_t text_bytes;
    bool base64;
} array_bytes;

static ewa_status broken(const vti *file, const char *what, const char *text) {
    return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "VTI: %s '%.80s' cannot be read", what, text);
}

static bool read_attribute(const ewa_xml_tag *tag, const char *name, char value[ATTRIBUTE_BYTES]) {
    return ewa_xml_attribute(tag, name, value, ATTRIBUTE_BYTES);
}

/// Keeps an array that suits better than what there is; `active` is the name of the active one.
static void offer_array(const ewa_xml_tag *tag, const char *active, found_array *best) {
    char value[ATTRIBUTE_BYTES];
    const bool one = !read_attribute(tag, "NumberOfComponents", value) || strcmp(value, "1") == 0;
    const bool is_active = active[0] && read_attribute(tag, "Name", value) && strcmp(value, active) == 0;
    const int rank = is_active ? 3 : one ? 2 : 1;
    if (rank > best->rank) *best = (found_array){*tag, rank};
}

/// Goes through the tags up to appended bytes or the end.
static void find_tags(vti *file) {
    const char *at = file->text;
    char active[ATTRIBUTE_BYTES] = "";
    found_array *section = NULL;
    ewa_xml_tag tag;
    while (ewa_xml_next(&at, file->end, &tag)) {
        if (ewa_xml_is(&tag, "VTKFile")) {
            if (tag.closing) file->ends = true;
            if (tag.closing || file->has_root) return;
            file->root = tag;
            file->has_root = true;
        } else if (ewa_xml_is(&tag, "AppendedData")) {
            if (tag.closing) continue;
            char encoding[ATTRIBUTE_BYTES];
            file->appended = tag;
            file->has_appended = true;
            file->raw = read_attribute(&tag, "encoding", encoding) && strcmp(encoding, "raw") == 0;
            if (file->raw) return;
        } else if (ewa_xml_is(&tag, "PointData") || ewa_xml_is(&tag, "CellData")) {
            section = tag.closing ? NULL : tag.name[0] == 'P' ? &file->points : &file->cells;
            if (!read_attribute(&tag, "Scalars", active)) active[0] = 0;
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

static ewa_status check_tags(vti *file) {
    const ewa_volume_input *in = file->in;
    char value[ATTRIBUTE_BYTES];
    if (!file->has_root || !file->has_image || !(file->points.rank || file->cells.rank))
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTI: no ImageData with PointData or CellData");
    if (file->piece_count > 1)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTI: %d pieces; one can be read",
                               file->piece_count);
    file->wide = read_attribute(&file->root, "header_type", value) && strcmp(value, "UInt64") == 0;
    file->big_endian = read_attribute(&file->root, "byte_order", value) && strcmp(value, "BigEndian") == 0;
    file->packed = read_attribute(&file->root, "compressor", value) && value[0];
    if (file->packed && strcmp(value, "vtkZLibDataCompressor") != 0)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTI: compressor '%.80s'", value);
    return EWA_OK;
}

/// Takes dims and places from the tags; `cells`: the numbers are of the cells between the points.
static ewa_status take_place(const vti *file, bool cells, ewa_volume_header *header) {
    char value[ATTRIBUTE_BYTES] = "";
    double extent[6], spacings[3] = {1, 1, 1}, origin[3] = {0}, turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (!(file->piece_count && read_attribute(&file->piece, "Extent", value)) &&
        !read_attribute(&file->image, "WholeExtent", value))
        value[0] = 0;
    if (ewa_text_numbers(value, 6, extent) != 6) return broken(file, "the extent", value);
    header->placed = read_attribute(&file->image, "Origin", value);
    if (header->placed && ewa_text_numbers(value, 3, origin) != 3) return broken(file, "Origin", value);
    if (read_attribute(&file->image, "Spacing", value) && ewa_text_numbers(value, 3, spacings) != 3)
        return broken(file, "Spacing", value);
    if (read_attribute(&file->image, "Direction", value) && ewa_text_numbers(value, 9, turn) != 9)
        return broken(file, "Direction", value);
    memcpy(header->first_world, origin, sizeof origin);
    for (int axis = 0; axis < 3; axis++) {
        const double steps = extent[2 * axis + 1] - extent[2 * axis];
        // A slice has no cells along its normal: one layer.
        const bool between = cells && steps >= 1;
        const double side = between ? steps : steps + 1;
        if (!(side >= 1 && side <= 4294967295.0)) return broken(file, "an extent of a side", "below 1");
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
    char value[ATTRIBUTE_BYTES] = "";
    if (!read_attribute(array, "type", value)) value[0] = 0;
    header->number = ewa_text_find(types, sizeof types / sizeof types[0], value);
    if (header->number < 0)
        return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "VTI: type '%.80s'", value);
    header->big_endian = file->big_endian;
    if (!read_attribute(array, "NumberOfComponents", value) || strcmp(value, "1") == 0) return EWA_OK;
    const bool color = header->number == EWA_U8 && (strcmp(value, "3") == 0 || strcmp(value, "4") == 0);
    if (!color)
        return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED,
                               "VTI: '%.40s' numbers per voxel; one, or a colour of bytes, can be drawn",
                               value);
    header->component_count = (uint32_t)(value[0] - '0');
    return EWA_OK;
}

/// What stands between the tags of an array.
static array_bytes content_of(const vti *file, const ewa_xml_tag *array) {
    const char *from = array->end[-1] == '/' ? file->end : array->end + 1;
    const char *to = memchr(from, '<', (size_t)(file->end - from));
    return (array_bytes){from, to ? (size_t)(to - from) : 0, true};
}

/// What stands at an offset behind the underscore of the appended data.
static ewa_status find_appended(const vti *file, uint64_t offset, array_bytes *found) {
    const char *from = file->has_appended ? file->appended.end + 1 : file->end;
    const char *mark = memchr(from, '_', (size_t)(file->end - from));
    if (!mark || offset > (uint64_t)(file->end - mark - 1))
        return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "VTI: the appended data end early");
    *found =
        (array_bytes){mark + 1 + offset, (size_t)((uint64_t)(file->end - mark - 1) - offset), !file->raw};
    return EWA_OK;
}

/// Copies `size_bytes` bytes from behind the first `skipped_bytes`; returns how many there are.
static size_t copy_bytes(const array_bytes *from, size_t skipped_bytes, uint8_t *to, size_t size_bytes) {
    if (from->base64)
        return ewa_base64_read(from->text, from->text_bytes, skipped_bytes, to, size_bytes, NULL);
    if (skipped_bytes > from->text_bytes) return 0;
    const size_t left = from->text_bytes - skipped_bytes, count = left < size_bytes ? left : size_bytes;
    memcpy(to, from->text + skipped_bytes, count);
    return count;
}

static uint64_t read_word(const vti *file, const uint8_t *bytes) {
    const size_t size_bytes = file->wide ? 8 : 4;
    uint64_t word = 0;
    for (size_t i = 0; i < size_bytes; i++)
        word = word << 8 | bytes[file->big_endian ? i : size_bytes - 1 - i];
    return word;
}

static ewa_status ends_early(const vti *file) {
    return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "VTI: the data of the array end early");
}

/// Sums what the blocks of a packed array take.
static ewa_status add_blocks(const vti *file, const array_bytes *array, uint64_t block_count,
                             uint64_t head_bytes, uint64_t *data_bytes) {
    const size_t word_bytes = file->wide ? 8 : 4;
    uint8_t *head = ewa_allocate(file->in->context, (size_t)head_bytes, 1);
    if (!head) return EWA_ERROR_MEMORY;
    bool good = copy_bytes(array, 0, head, (size_t)head_bytes) == head_bytes;
    for (uint64_t block = 0; block < block_count && good; block++) {
        const uint64_t size = read_word(file, head + (PACKED_HEAD_WORDS + block) * word_bytes);
        good = size <= array->text_bytes - *data_bytes;
        if (good) *data_bytes += size;
    }
    ewa_release(file->in->context, head, (size_t)head_bytes, 1);
    return good ? EWA_OK : ends_early(file);
}

/// How many bytes the sizes in front of the data take, and the data behind them. What they claim is compared
/// with the bytes that there are.
static ewa_status measure_array(const vti *file, const array_bytes *array, uint64_t *head_bytes,
                                uint64_t *data_bytes) {
    const size_t word_bytes = file->wide ? 8 : 4;
    const uint64_t maximum = array->text_bytes;
    uint8_t bytes[8];
    if (copy_bytes(array, 0, bytes, word_bytes) != word_bytes) return ends_early(file);
    const uint64_t first = read_word(file, bytes);
    *head_bytes = word_bytes;
    *data_bytes = first;
    ewa_status status = EWA_OK;
    if (file->packed) {
        // The number of blocks, their size, that of the last one, then what each takes when packed.
        if (first == 0 || first > maximum / word_bytes) return ends_early(file);
        *head_bytes = (first + PACKED_HEAD_WORDS) * word_bytes;
        *data_bytes = 0;
        if (*head_bytes > maximum) return ends_early(file);
        status = add_blocks(file, array, first, *head_bytes, data_bytes);
    }
    return status == EWA_OK && *data_bytes > maximum - *head_bytes ? ends_early(file) : status;
}

/// Adds the bytes of an array behind its sizes; those of base64 are decoded into memory of their own.
static ewa_status add_array(const vti *file, const array_bytes *array, ewa_volume_header *header) {
    const ewa_volume_input *in = file->in;
    uint64_t head_bytes = 0, data_bytes = 0;
    EWA_TRY(measure_array(file, array, &head_bytes, &data_bytes));
    header->packing = file->packed ? EWA_PACKING_DEFLATE : EWA_PACKING_NONE;
    if (!array->base64)
        return ewa_volume_add_bytes(in, (const uint8_t *)array->text + head_bytes, (size_t)data_bytes,
                                    &header->pieces);
    uint8_t *bytes = ewa_allocate(in->context, (size_t)data_bytes, 1);
    if (!bytes) return EWA_ERROR_MEMORY;
    const size_t got = copy_bytes(array, (size_t)head_bytes, bytes, (size_t)data_bytes);
    if (got == data_bytes) return ewa_volume_add_memory(in, bytes, got, &header->pieces);
    ewa_release(in->context, bytes, (size_t)data_bytes, 1);
    return ends_early(file);
}

static ewa_status take_numbers(const vti *file, const ewa_xml_tag *array, ewa_volume_header *header) {
    const ewa_volume_input *in = file->in;
    char value[ATTRIBUTE_BYTES] = "";
    if (!file->ends && !file->raw) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTI: the file ends early");
    if (!read_attribute(array, "format", value)) snprintf(value, sizeof value, "ascii");
    array_bytes bytes = content_of(file, array);
    if (strcmp(value, "appended") == 0) {
        uint64_t offset = 0;
        if (!read_attribute(array, "offset", value) || ewa_text_counts(value, 1, &offset) != 1)
            return broken(file, "offset", value);
        EWA_TRY(find_appended(file, offset, &bytes));
        return add_array(file, &bytes, header);
    }
    if (strcmp(value, "binary") == 0) return add_array(file, &bytes, header);
    if (strcmp(value, "ascii") != 0) return broken(file, "format", value);
    header->packing = EWA_PACKING_TEXT;
    return ewa_volume_add_bytes(in, (const uint8_t *)bytes.text, bytes.text_bytes, &header->pieces);
}

bool ewa_vti_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes > 8 && (memcmp(bytes, "<?xml", 5) == 0 || memcmp(bytes, "<VTKFile", 8) == 0);
}

ewa_status ewa_vti_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    vti file = {.in = in, .text = (const char *)in->bytes};
    file.end = file.text + in->size_bytes;
    find_tags(&file);
    EWA_TRY(check_tags(&file));
    const bool cells = file.points.rank == 0;
    const ewa_xml_tag *array = cells ? &file.cells.tag : &file.points.tag;
    EWA_TRY(take_place(&file, cells, header));
    EWA_TRY(take_type(&file, array, header));
    EWA_TRY(take_numbers(&file, array, header));
    char name[ATTRIBUTE_BYTES];
    if (read_attribute(array, "Name", name))
        ewa_report(in->context, EWA_SEVERITY_INFO, "%s: the array '%.80s'%s", in->name, name,
                   cells ? " of the cells" : "");
    return EWA_OK;
}
