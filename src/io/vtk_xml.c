// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Arrays of VTK's XML files.
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 12 to 17; what VTK 9 adds (keys within arrays)
// after its writer's files.
#include "io/vtk_xml.h"
#include "base/base.h"
#include "io/mesh/base64.h"
#include "base/unpacking.h"
#include "io/lz4.h"
#include "io/number.h"

#if EWA_WITH_LZMA
#include <lzma.h>
#endif

#include <string.h>

enum { PACKED_HEAD_WORDS = 3 };

/// How blocks are packed that are unpacked here; zlib's are unpacked where numbers are read.
typedef struct ewa_vtk_packing {
    const char *compressor;
    /// Unpacks exactly so many bytes. Errors: EWA_ERROR_FORMAT, without a report; EWA_ERROR_LIMIT.
    ewa_status (*unpack)(const struct ewa_vtk_xml *xml, const uint8_t *from, size_t from_bytes, uint8_t *to, size_t to_bytes);
    uint32_t ratio; ///< a byte unpacks to no more
} ewa_vtk_packing;

static ewa_status unpack_lz4(const ewa_vtk_xml *xml, const uint8_t *from, size_t from_bytes, uint8_t *to, size_t to_bytes) {
    (void)xml;
    return ewa_lz4_unpack(from, from_bytes, to, to_bytes) ? EWA_OK : EWA_ERROR_FORMAT;
}

#if EWA_WITH_LZMA
static ewa_status unpack_lzma(const ewa_vtk_xml *xml, const uint8_t *from, size_t from_bytes, uint8_t *to, size_t to_bytes) {
    static const uint64_t maximum_bytes = 70u << 20; // the largest dictionary that VTK's levels ask for is 64 MiB
    uint64_t needed_bytes = 1;
    size_t from_at = 0, to_at = 0;
    // With a limit that is too low it says what it needs.
    const lzma_ret asked = lzma_stream_buffer_decode(&needed_bytes, 0, NULL, from, &from_at, from_bytes, to, &to_at, to_bytes);
    if (asked != LZMA_MEMLIMIT_ERROR || needed_bytes > maximum_bytes) return EWA_ERROR_FORMAT;
    EWA_TRY(ewa_memory_take(xml->context, needed_bytes, "%s: VTK: the dictionary of an array", xml->name));
    from_at = to_at = 0;
    uint64_t limit_bytes = needed_bytes;
    const lzma_ret done = lzma_stream_buffer_decode(&limit_bytes, 0, NULL, from, &from_at, from_bytes, to, &to_at, to_bytes);
    ewa_memory_give(xml->context, needed_bytes);
    return done == LZMA_OK && from_at == from_bytes && to_at == to_bytes ? EWA_OK : EWA_ERROR_FORMAT;
}
#endif

static const ewa_vtk_packing packings[] = {
    {"vtkLZ4DataCompressor", unpack_lz4, 255},
#if EWA_WITH_LZMA
    {"vtkLZMADataCompressor", unpack_lzma, 8192},
#endif
};

/// Where the numbers of an array are: bytes, or their base64 text.
typedef struct array_bytes {
    const char *text;
    size_t text_bytes;
    bool base64;
} array_bytes;

bool ewa_vtk_attribute(const ewa_xml_tag *tag, const char *name, char value[EWA_VTK_ATTRIBUTE_BYTES]) {
    return ewa_xml_attribute(tag, name, value, EWA_VTK_ATTRIBUTE_BYTES);
}

ewa_status ewa_vtk_broken(const ewa_vtk_xml *xml, const char *what, const char *text) {
    return ewa_fail(xml->context, EWA_ERROR_FORMAT, "%s: %s: %s '%.80s' cannot be read", xml->name, xml->kind, what, text);
}

static ewa_status fail(const ewa_vtk_xml *xml, const char *what) {
    return ewa_fail(xml->context, EWA_ERROR_FORMAT, "%s: %s: %s", xml->name, xml->kind, what);
}

static ewa_status ends_early(const ewa_vtk_xml *xml) { return fail(xml, "the data of the array end early"); }

void ewa_vtk_xml_open(ewa_vtk_xml *xml, const uint8_t *bytes, size_t size_bytes) {
    char value[EWA_VTK_ATTRIBUTE_BYTES];
    ewa_xml_tag tag;
    xml->text = size_bytes ? (const char *)bytes : "";
    xml->end = xml->text + size_bytes;
    for (const char *at = xml->text; !xml->raw && !xml->ends && ewa_xml_next(&at, xml->end, &tag);) {
        if (ewa_xml_is(&tag, "VTKFile")) {
            xml->ends = tag.closing || xml->has_root;
            if (!xml->has_root) xml->root = tag;
            xml->has_root = true;
        } else if (ewa_xml_is(&tag, "AppendedData") && !tag.closing) {
            xml->appended = tag;
            xml->has_appended = true;
            xml->raw = ewa_vtk_attribute(&tag, "encoding", value) && strcmp(value, "raw") == 0;
        }
    }
    if (!xml->has_root) return;
    xml->wide = ewa_vtk_attribute(&xml->root, "header_type", value) && strcmp(value, "UInt64") == 0;
    xml->big_endian = ewa_vtk_attribute(&xml->root, "byte_order", value) && strcmp(value, "BigEndian") == 0;
    xml->packed = ewa_vtk_attribute(&xml->root, "compressor", value) && value[0];
    for (size_t i = 0; i < sizeof packings / sizeof packings[0] && xml->packed; i++)
        if (strcmp(value, packings[i].compressor) == 0) xml->packing = &packings[i];
}

/// What stands between the tags of an array.
static array_bytes content_of(const ewa_vtk_xml *xml, const ewa_xml_tag *array) {
    const char *from = array->end[-1] == '/' ? xml->end : array->end + 1;
    const char *to = memchr(from, '<', (size_t)(xml->end - from));
    return (array_bytes){from, to ? (size_t)(to - from) : 0, true};
}

/// What stands at an offset behind the underscore of the appended data.
static ewa_status find_appended(const ewa_vtk_xml *xml, uint64_t offset, array_bytes *found) {
    const char *from = xml->has_appended ? xml->appended.end + 1 : xml->end;
    const char *mark = memchr(from, '_', (size_t)(xml->end - from));
    if (!mark || offset > (uint64_t)(xml->end - mark - 1))
        return fail(xml, "the appended data end early");
    *found =
        (array_bytes){mark + 1 + offset, (size_t)((uint64_t)(xml->end - mark - 1) - offset), !xml->raw};
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

static uint64_t read_word(const ewa_vtk_xml *xml, const uint8_t *bytes) {
    const size_t size_bytes = xml->wide ? 8 : 4;
    uint64_t word = 0;
    for (size_t i = 0; i < size_bytes; i++)
        word = word << 8 | bytes[xml->big_endian ? i : size_bytes - 1 - i];
    return word;
}

/// Sums what the blocks of a packed array take.
static ewa_status add_blocks(const ewa_vtk_xml *xml, const array_bytes *array, uint64_t block_count,
                             uint64_t head_bytes, uint64_t *data_bytes) {
    const size_t word_bytes = xml->wide ? 8 : 4;
    uint8_t *head = ewa_allocate(xml->context, (size_t)head_bytes, 1);
    if (!head) return EWA_ERROR_MEMORY;
    bool good = copy_bytes(array, 0, head, (size_t)head_bytes) == head_bytes;
    for (uint64_t block = 0; block < block_count && good; block++) {
        const uint64_t size = read_word(xml, head + (PACKED_HEAD_WORDS + block) * word_bytes);
        good = size <= array->text_bytes - *data_bytes;
        if (good) *data_bytes += size;
    }
    ewa_release(xml->context, head, (size_t)head_bytes, 1);
    return good ? EWA_OK : ends_early(xml);
}

/// How many bytes the sizes in front of the data take, and the data behind them. What they claim is compared
/// with the bytes that there are.
static ewa_status measure_array(const ewa_vtk_xml *xml, const array_bytes *array, uint64_t *head_bytes,
                                uint64_t *data_bytes) {
    const size_t word_bytes = xml->wide ? 8 : 4;
    const uint64_t maximum = array->text_bytes;
    uint8_t bytes[8];
    if (copy_bytes(array, 0, bytes, word_bytes) != word_bytes) return ends_early(xml);
    const uint64_t first = read_word(xml, bytes);
    *head_bytes = word_bytes;
    *data_bytes = first;
    ewa_status status = EWA_OK;
    if (xml->packed) {
        // The number of blocks, their size, that of the last one, then what each takes when packed.
        if (first == 0 || first > maximum / word_bytes) return ends_early(xml);
        *head_bytes = (first + PACKED_HEAD_WORDS) * word_bytes;
        *data_bytes = 0;
        if (*head_bytes > maximum) return ends_early(xml);
        status = add_blocks(xml, array, first, *head_bytes, data_bytes);
    }
    return status == EWA_OK && *data_bytes > maximum - *head_bytes ? ends_early(xml) : status;
}

/// Unpacks the blocks of an array from the data behind their sizes.
static ewa_status unpack_blocks(const ewa_vtk_xml *xml, const uint8_t *head, const uint8_t *data, size_t data_bytes, ewa_vtk_stored *stored) {
    const size_t word_bytes = xml->wide ? 8 : 4;
    const uint64_t count = read_word(xml, head), block = read_word(xml, head + word_bytes), last = read_word(xml, head + 2 * word_bytes);
    uint64_t bytes;
    if (__builtin_mul_overflow(last ? count - 1 : count, block, &bytes) || __builtin_add_overflow(bytes, last, &bytes) ||
        last > block || bytes / xml->packing->ratio > data_bytes)
        return ends_early(xml);
    EWA_TRY(ewa_memory_check_unpacked(xml->context, data_bytes, xml->packing->ratio, bytes, "%s: VTK: an array", xml->name));
    uint8_t *to = ewa_allocate(xml->context, (size_t)bytes, 1);
    if (!to) return EWA_ERROR_MEMORY;
    ewa_status status = EWA_OK;
    uint64_t done = 0;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        const size_t packed = (size_t)read_word(xml, head + (PACKED_HEAD_WORDS + i) * word_bytes);
        const uint64_t own = bytes - done < block ? bytes - done : block;
        status = xml->packing->unpack(xml, data, packed, to + done, (size_t)own);
        data += packed, done += own;
    }
    if (status != EWA_OK) {
        ewa_release(xml->context, to, (size_t)bytes, 1);
        return status == EWA_ERROR_FORMAT ? fail(xml, "a packed array is damaged") : status;
    }
    *stored = (ewa_vtk_stored){EWA_PACKING_NONE, to, (size_t)bytes, to, (size_t)bytes};
    return EWA_OK;
}

/// As find_bytes(), of what is unpacked here.
static ewa_status find_unpacked(const ewa_vtk_xml *xml, const array_bytes *array, size_t head_bytes, size_t data_bytes, ewa_vtk_stored *stored) {
    const size_t size_bytes = head_bytes + data_bytes;
    uint8_t *bytes = ewa_allocate(xml->context, size_bytes, 1);
    if (!bytes) return EWA_ERROR_MEMORY;
    const bool whole = copy_bytes(array, 0, bytes, head_bytes) == head_bytes &&
                       copy_bytes(array, head_bytes, bytes + head_bytes, data_bytes) == data_bytes;
    const ewa_status status = whole ? unpack_blocks(xml, bytes, bytes + head_bytes, data_bytes, stored) : ends_early(xml);
    ewa_release(xml->context, bytes, size_bytes, 1);
    return status;
}

/// Finds the bytes of an array behind its sizes; those of base64 are decoded into memory of their own.
static ewa_status find_bytes(const ewa_vtk_xml *xml, const array_bytes *array, ewa_vtk_stored *stored) {
    uint64_t head_bytes = 0, data_bytes = 0;
    EWA_TRY(measure_array(xml, array, &head_bytes, &data_bytes));
    if (xml->packing) return find_unpacked(xml, array, (size_t)head_bytes, (size_t)data_bytes, stored);
    stored->packing = xml->packed ? EWA_PACKING_DEFLATE : EWA_PACKING_NONE;
    stored->bytes = (const uint8_t *)array->text + head_bytes;
    stored->size_bytes = (size_t)data_bytes;
    if (!array->base64) return EWA_OK;
    uint8_t *bytes = ewa_allocate(xml->context, (size_t)data_bytes, 1);
    if (!bytes) return EWA_ERROR_MEMORY;
    if (copy_bytes(array, (size_t)head_bytes, bytes, (size_t)data_bytes) != data_bytes) {
        ewa_release(xml->context, bytes, (size_t)data_bytes, 1);
        return ends_early(xml);
    }
    stored->bytes = stored->owned = bytes;
    stored->owned_bytes = (size_t)data_bytes;
    return EWA_OK;
}

ewa_status ewa_vtk_xml_find(const ewa_vtk_xml *xml, const ewa_xml_tag *array, ewa_vtk_stored *stored) {
    char value[EWA_VTK_ATTRIBUTE_BYTES] = "";
    *stored = (ewa_vtk_stored){0};
    if (xml->packed && !xml->packing && ewa_vtk_attribute(&xml->root, "compressor", value) && strcmp(value, "vtkZLibDataCompressor") != 0)
        return ewa_fail(xml->context, EWA_ERROR_UNSUPPORTED, "%s: %s: compressor '%.80s', which this build does not read; VTK and ParaView write the same by zlib, LZ4 or not packed",
                        xml->name, xml->kind, value);
    if (!xml->ends && !xml->raw) return fail(xml, "the file ends early");
    if (!ewa_vtk_attribute(array, "format", value)) memcpy(value, "ascii", sizeof "ascii");
    array_bytes bytes = content_of(xml, array);
    if (strcmp(value, "appended") == 0) {
        int64_t offset = -1;
        const char *end = NULL;
        if (ewa_vtk_attribute(array, "offset", value)) end = ewa_number_read_i64(value, value + strlen(value), &offset);
        if (!end || *end || offset < 0) return ewa_vtk_broken(xml, "offset", value);
        EWA_TRY(find_appended(xml, (uint64_t)offset, &bytes));
        return find_bytes(xml, &bytes, stored);
    }
    if (strcmp(value, "binary") == 0) return find_bytes(xml, &bytes, stored);
    if (strcmp(value, "ascii") != 0) return ewa_vtk_broken(xml, "format", value);
    stored->packing = EWA_PACKING_TEXT;
    stored->bytes = (const uint8_t *)bytes.text;
    stored->size_bytes = bytes.text_bytes;
    return EWA_OK;
}
