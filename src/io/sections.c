// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sections with checksums.
#include "io/sections.h"
#include "io/deflate.h"
#include "io/las/las.h"

#include <string.h>

enum { HEAD_BYTES = 16 };

ewa_status ewa_section_put(ewa_context *context, ewa_section *section, const void *bytes, size_t size_bytes) {
    EWA_TRY(
        ewa_buffer_grow(context, &section->buffer, section->size_bytes, section->size_bytes + size_bytes, 1));
    if (!size_bytes) return EWA_OK;
    memcpy((uint8_t *)section->buffer.data + section->size_bytes, bytes, size_bytes);
    section->size_bytes += size_bytes;
    return EWA_OK;
}

ewa_status ewa_section_write(ewa_writer *writer, uint32_t tag, ewa_section *section) {
    uint8_t head[HEAD_BYTES];
    ewa_las_put_u32(head, tag);
    ewa_las_put_u32(head + 4, ewa_crc32(0, section->buffer.data, section->size_bytes));
    ewa_las_put_u64(head + 8, section->size_bytes);
    ewa_status status = ewa_writer_put(writer, head, sizeof head);
    if (status == EWA_OK) status = ewa_writer_put(writer, section->buffer.data, section->size_bytes);
    section->size_bytes = 0;
    return status;
}

void ewa_section_free(ewa_context *context, ewa_section *section) {
    ewa_buffer_free(context, &section->buffer);
}

bool ewa_section_next(ewa_section_view *file, uint32_t *tag, ewa_section_view *section, const char **fault) {
    *fault = NULL;
    if (file->size_bytes == 0) return false;
    *fault = "it ends in the middle of a section";
    const uint8_t *head = ewa_section_skip(file, HEAD_BYTES);
    if (!head) return false;
    section->size_bytes = ewa_las_u64(head + 8);
    section->bytes = ewa_section_skip(file, section->size_bytes);
    if (!section->bytes) return false;
    *fault = "the checksum of a section is wrong";
    *tag = ewa_bytes_u32(head);
    if (ewa_crc32(0, section->bytes, (size_t)section->size_bytes) != ewa_bytes_u32(head + 4))
        return false;
    *fault = NULL;
    return true;
}

const uint8_t *ewa_section_skip(ewa_section_view *section, uint64_t size_bytes) {
    if (size_bytes > section->size_bytes) return NULL;
    const uint8_t *bytes = section->bytes;
    section->bytes += size_bytes;
    section->size_bytes -= size_bytes;
    return bytes;
}

bool ewa_section_take(ewa_section_view *section, void *to, uint64_t size_bytes) {
    const uint8_t *bytes = ewa_section_skip(section, size_bytes);
    if (bytes && size_bytes) memcpy(to, bytes, (size_t)size_bytes);
    if (!bytes) memset(to, 0, (size_t)size_bytes);
    return bytes != NULL;
}
