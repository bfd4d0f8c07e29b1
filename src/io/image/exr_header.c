// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Headers of OpenEXR without the attributes that pixels do not need: OpenEXR's C++ makes room for what an attribute claims before it
// looks.
// By: OpenEXR File Layout, "Version Field" and "Header".
#include "io/image/exr_header.h"
#include "io/reader.h"

#include <string.h>

enum {
    VERSION_AT = 4,
    ATTRIBUTES_AT = 8,
    DEEP_DATA = 1 << 11, // of the version
    MULTI_PART = 1 << 12,
    CHANNEL_BYTES = 16, // behind its name
    SIZE_BYTES = 4,
};

/// One attribute: name and type, which end with a zero each, the size of the value, and this.
typedef struct attribute {
    const char *name, *type;
    const uint8_t *value;
    size_t value_bytes;
} attribute;

/// Steps over a text and its zero; NULL where it has no character or no end.
static const uint8_t *skip_text(const uint8_t *at, const uint8_t *end) {
    const uint8_t *zero = memchr(at, 0, (size_t)(end - at));
    return zero && zero > at ? zero + 1 : NULL;
}

/// Reads an attribute; false where it does not end before the file.
static bool read_attribute(const uint8_t *at, const uint8_t *end, attribute *to) {
    const uint8_t *type = skip_text(at, end), *size = type ? skip_text(type, end) : NULL;
    if (!size || end - size < SIZE_BYTES) return false;
    *to = (attribute){(const char *)at, (const char *)type, size + SIZE_BYTES, ewa_bytes_u32(size)};
    return to->value_bytes <= (size_t)(end - to->value);
}

/// Whether a list of channels ends where its attribute does.
static bool is_list_of_channels(const uint8_t *at, size_t size_bytes) {
    const uint8_t *end = at + size_bytes;
    while (at < end && *at) {
        at = skip_text(at, end);
        if (!at || end - at < CHANNEL_BYTES) return false;
        at += CHANNEL_BYTES;
    }
    return end - at == 1;
}

/// Whether pixels need an attribute; `*good` is false where they do and it has another type or size than it must.
static bool is_needed(const attribute *found, bool *good) {
    static const struct {
        const char *name, *type;
        size_t value_bytes; ///< 0: a list of channels
    } needed[] = {{"channels", "chlist", 0},        {"compression", "compression", 1}, {"dataWindow", "box2i", 16},
                  {"displayWindow", "box2i", 16},   {"lineOrder", "lineOrder", 1},     {"pixelAspectRatio", "float", 4},
                  {"screenWindowCenter", "v2f", 8}, {"screenWindowWidth", "float", 4}, {"tiles", "tiledesc", 9}};
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++)
        if (strcmp(found->name, needed[i].name) == 0) {
            *good = strcmp(found->type, needed[i].type) == 0 &&
                    (needed[i].value_bytes ? found->value_bytes == needed[i].value_bytes
                                           : is_list_of_channels(found->value, found->value_bytes));
            return true;
        }
    return false;
}

bool ewa_exr_has_one_part(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= ATTRIBUTES_AT && !(ewa_bytes_u32(bytes + VERSION_AT) & (DEEP_DATA | MULTI_PART));
}

size_t ewa_exr_measure_header(const uint8_t *bytes, size_t size_bytes) {
    if (size_bytes < ATTRIBUTES_AT) return 0;
    const uint8_t *at = bytes + ATTRIBUTES_AT, *end = bytes + size_bytes;
    while (at < end && *at) {
        attribute found;
        bool good = true;
        if (!read_attribute(at, end, &found)) return 0;
        is_needed(&found, &good);
        if (!good) return 0;
        at = found.value + found.value_bytes;
    }
    return at < end ? (size_t)(at - bytes) + 1 : 0;
}

void ewa_exr_copy_header(const uint8_t *bytes, size_t header_bytes, uint8_t *header) {
    static const uint8_t filler[] = {'x', 0, 'x', 0}; // name and type, so that every attribute is at least as long with its size
    const uint8_t *at = bytes + ATTRIBUTES_AT, *end = bytes + header_bytes;
    uint8_t *to = header + ATTRIBUTES_AT;
    attribute found;
    bool good;
    memset(header, 0, header_bytes);
    memcpy(header, bytes, ATTRIBUTES_AT);
    while (*at && read_attribute(at, end, &found)) {
        const uint8_t *next = found.value + found.value_bytes;
        if (is_needed(&found, &good)) {
            memcpy(to, at, (size_t)(next - at));
            to += next - at;
        }
        at = next;
    }
    const size_t left_out_bytes = (size_t)(header + header_bytes - 1 - to);
    if (left_out_bytes == 0) return;
    const size_t value_bytes = left_out_bytes - sizeof filler - SIZE_BYTES;
    memcpy(to, filler, sizeof filler);
    for (size_t i = 0; i < SIZE_BYTES; i++) to[sizeof filler + i] = (uint8_t)(value_bytes >> 8 * i);
}
