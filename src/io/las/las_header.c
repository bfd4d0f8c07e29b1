// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The public header of LAS files and the walk over their variable length records.
#include "base/base.h"
#include "io/las/las.h"

#include <math.h>
#include <string.h>

enum {
    NEWEST_MINOR = 5,
    MAX_RECORD_BYTES = 1 << 20, // of a file that comes in parts, longer ones are left to who needs a part of them
};

uint16_t ewa_las_format_bytes(uint8_t point_format) {
    static const uint8_t bytes[EWA_LAS_MAX_FORMAT + 1] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    return bytes[point_format];
}

static ewa_status check_numbers(const ewa_cloud_source *source, const ewa_las_header *header) {
    for (int c = 0; c < 3; c++) {
        if (isfinite(header->offset[c]) && isfinite(header->scale[c]) && header->scale[c] > 0) continue;
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: coordinates along %c have scale %g and offset %g; the scale must be above 0",
                        source->name, "xyz"[c], header -> scale[c], header -> offset[c]);
    }
    return EWA_OK;
}

static ewa_status check_places(const ewa_cloud_source *source, const ewa_las_header *header) {
    const uint16_t minimum = ewa_las_format_bytes(header->point_format);
    if (header->record_bytes < minimum)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: records of %u bytes, those of point format %u have at least %u", source->name,
                        header->record_bytes, header->point_format, minimum);
    if (header->head_bytes < EWA_LAS_HEAD_BYTES)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: a header of %u bytes, it has at least %d",
                        source->name, header->head_bytes, EWA_LAS_HEAD_BYTES);
    if (header->points_at < header->head_bytes || header->points_at > source->size_bytes)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: the points are said to begin at byte %llu, between the header of %u bytes and "
                        "the end at %llu they should",
                        source->name, (unsigned long long)header->points_at, header->head_bytes,
                        (unsigned long long)source->size_bytes);
    return EWA_OK;
}

/// Has all records read of a file that comes in parts, but for the bytes of long ones, so that walks find them.
static ewa_status need_records(const ewa_cloud_source *source, const ewa_las_header *header) {
    if (!source->ranges) return EWA_OK;
    const uint64_t size_bytes = source->size_bytes;
    const uint8_t *bytes;
    EWA_TRY(ewa_cloud_need(source, 0, header->points_at, &bytes));
    uint64_t at = header->evlrs_at;
    for (uint32_t i = 0; i < header->evlr_count && at <= size_bytes && size_bytes - at >= EWA_LAS_EXTENDED_BYTES; i++) {
        EWA_TRY(ewa_cloud_need(source, at, EWA_LAS_EXTENDED_BYTES, &bytes));
        const uint64_t record_bytes = ewa_las_u64(bytes + 20);
        at += EWA_LAS_EXTENDED_BYTES;
        if (record_bytes > size_bytes - at) break;
        if (record_bytes <= MAX_RECORD_BYTES) EWA_TRY(ewa_cloud_need(source, at, record_bytes, &bytes));
        at += record_bytes;
    }
    return EWA_OK;
}

ewa_status ewa_las_header_read(const ewa_cloud_source *source, ewa_las_header *header) {
    const uint8_t *bytes;
    *header = (ewa_las_header){0};
    if (source->size_bytes < EWA_LAS_HEAD_BYTES)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: the file ends in the header of LAS: %llu bytes of at least %d", source->name,
                        (unsigned long long)source->size_bytes, EWA_LAS_HEAD_BYTES);
    const uint64_t there = source->size_bytes < EWA_LAS_HEAD_14_BYTES ? source->size_bytes : EWA_LAS_HEAD_14_BYTES;
    EWA_TRY(ewa_cloud_need(source, 0, there, &bytes));
    const uint8_t format = bytes[104];
    *header = (ewa_las_header){.version_minor = bytes[25],
                               .point_format = format & 0x3f,
                               .compressed = (format & 0xc0) != 0,
                               .global_encoding = ewa_las_u16(bytes + 6),
                               .day = ewa_las_u16(bytes + 90),
                               .year = ewa_las_u16(bytes + 92),
                               .head_bytes = ewa_las_u16(bytes + 94),
                               .points_at = ewa_bytes_u32(bytes + 96),
                               .vlr_count = ewa_bytes_u32(bytes + 100),
                               .record_bytes = ewa_las_u16(bytes + 105),
                               .point_count = ewa_bytes_u32(bytes + 107),
                               .system = bytes + 26,
                               .software = bytes + 58};
    if (bytes[24] != 1 || header->version_minor > NEWEST_MINOR)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: LAS of version %u.%u; 1.0 to 1.%d are read", source->name, bytes[24],
                        header->version_minor, NEWEST_MINOR);
    if (header->point_format > EWA_LAS_MAX_FORMAT)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: LAS of point format %u; 0 to %d are read", source->name, header->point_format,
                        EWA_LAS_MAX_FORMAT);
    // Version 1.0 has reserved bytes where later ones have the encoding.
    if (header->version_minor == 0) header->global_encoding = 0;
    for (int c = 0; c < 3; c++) {
        header->scale[c] = ewa_las_f64(bytes + 131 + 8 * c);
        header->offset[c] = ewa_las_f64(bytes + 155 + 8 * c);
        header->high[c] = ewa_las_f64(bytes + 179 + 16 * c);
        header->low[c] = ewa_las_f64(bytes + 187 + 16 * c);
    }
    if (header->version_minor >= 4 && header->head_bytes >= EWA_LAS_HEAD_14_BYTES &&
        source->size_bytes >= EWA_LAS_HEAD_14_BYTES) {
        header->evlrs_at = ewa_las_u64(bytes + 235);
        header->evlr_count = ewa_bytes_u32(bytes + 243);
        const uint64_t count = ewa_las_u64(bytes + 247);
        if (count) header->point_count = count;
    }
    EWA_TRY(check_numbers(source, header));
    EWA_TRY(check_places(source, header));
    return need_records(source, header);
}

/// Takes the record at `at` that must end at `end` or before; false when it does not.
static bool take(const ewa_cloud_source *source, uint64_t at, uint64_t end, bool extended, ewa_las_vlr *vlr) {
    const uint64_t head_bytes = extended ? EWA_LAS_EXTENDED_BYTES : EWA_LAS_RECORD_BYTES;
    if (at > end || end - at < head_bytes) return false;
    const uint8_t *head = ewa_cloud_find_bytes(source, at, head_bytes);
    if (!head) return false;
    *vlr = (ewa_las_vlr){.head = head,
                         .at_bytes = at + head_bytes,
                         .size_bytes = extended ? ewa_las_u64(head + 20) : ewa_las_u16(head + 20),
                         .id = ewa_las_u16(head + 18),
                         .extended = extended};
    if (vlr->size_bytes > end - at - head_bytes) return false;
    vlr->bytes = ewa_cloud_find_bytes(source, vlr->at_bytes, vlr->size_bytes);
    return true;
}

bool ewa_las_walk_next(const ewa_cloud_source *source, const ewa_las_header *header, ewa_las_walk *walk,
                       ewa_las_vlr *vlr) {
    if (!walk->extended) {
        if (walk->at_bytes == 0) walk->at_bytes = header->head_bytes;
        if (walk->seen_count < header->vlr_count) {
            if (take(source, walk->at_bytes, header->points_at, false, vlr)) {
                walk->seen_count++;
                walk->at_bytes += EWA_LAS_RECORD_BYTES + vlr->size_bytes;
                return true;
            }
            walk->fault = "variable length records";
        }
        *walk = (ewa_las_walk){.at_bytes = header->evlrs_at, .extended = true, .fault = walk->fault};
    }
    if (walk->seen_count >= header->evlr_count) return false;
    if (!take(source, walk->at_bytes, source->size_bytes, true, vlr)) {
        walk->fault = "extended variable length records";
        return false;
    }
    walk->seen_count++;
    walk->at_bytes += EWA_LAS_EXTENDED_BYTES + vlr->size_bytes;
    return true;
}

bool ewa_las_vlr_is(const ewa_las_vlr *vlr, const char *user, uint16_t id) {
    return vlr->id == id && strncmp((const char *)vlr->head + 2, user, 16) == 0;
}

bool ewa_las_find(const ewa_cloud_source *source, const ewa_las_header *header, const char *user, uint16_t id,
                  ewa_las_vlr *vlr) {
    ewa_las_walk walk = {0};
    while (ewa_las_walk_next(source, header, &walk, vlr))
        if (ewa_las_vlr_is(vlr, user, id) && vlr->bytes) return true;
    return false;
}

void ewa_las_text(const uint8_t *bytes, size_t size_bytes, char *to) {
    const uint8_t *end = memchr(bytes, 0, size_bytes);
    size_t length = end ? (size_t)(end - bytes) : size_bytes;
    while (length && bytes[length - 1] == ' ') length--;
    for (size_t i = 0; i < length; i++) to[i] = bytes[i] < ' ' || bytes[i] > '~' ? '?' : (char)bytes[i];
    to[length] = 0;
}
