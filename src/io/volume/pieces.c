// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the parsers of volume files share: messages, and the files and bytes that a header names.
#include "base/base.h"
#include "base/format.h"
#include "io/number.h"
#include "io/referenced_file.h"
#include "io/volume/file.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MESSAGE_BYTES = 512, PATTERN_WIDTH = 9 };

ewa_status ewa_volume_fail(const ewa_volume_input *in, ewa_status status, const char *format, ...) {
    char what[MESSAGE_BYTES];
    va_list arguments;
    va_start(arguments, format);
    ewa_format_list(what, sizeof what, format, arguments);
    va_end(arguments);
    return ewa_fail(in->context, status, "%s: %s", in->name, what);
}

void ewa_volume_header_init(ewa_volume_header *header) {
    *header = (ewa_volume_header){
        .dims = {1, 1, 1}, .component_count = 1, .number = -1, .slope = 1, .axis_count = 3};
    for (int axis = 0; axis < 3; axis++) header->directions[axis][axis] = 1;
}

static ewa_status add_piece(const ewa_volume_input *in, const ewa_file *file, ewa_volume_pieces *pieces) {
    if (pieces->count == pieces->capacity) {
        if (pieces->count >= EWA_VOLUME_MAX_FILES)
            return ewa_volume_fail(in, EWA_ERROR_LIMIT, "more than %d files", EWA_VOLUME_MAX_FILES);
        const size_t capacity = pieces->capacity ? 2 * pieces->capacity : 1;
        ewa_file *larger = ewa_allocate(in->context, capacity, sizeof *larger);
        if (!larger) return EWA_ERROR_MEMORY;
        if (pieces->count) memcpy(larger, pieces->files, pieces->count * sizeof *larger);
        ewa_release(in->context, pieces->files, pieces->capacity, sizeof *larger);
        pieces->files = larger;
        pieces->capacity = capacity;
    }
    pieces->files[pieces->count++] = *file;
    return EWA_OK;
}

ewa_status ewa_volume_add_bytes(const ewa_volume_input *in, const uint8_t *bytes, size_t size_bytes,
                                ewa_volume_pieces *pieces) {
    return add_piece(in, &(ewa_file){.bytes = bytes, .size_bytes = size_bytes}, pieces);
}

ewa_status ewa_volume_add_memory(const ewa_volume_input *in, uint8_t *bytes, size_t size_bytes,
                                 ewa_volume_pieces *pieces) {
    ewa_file file = {.bytes = bytes, .size_bytes = size_bytes, .capacity_bytes = size_bytes};
    pieces->detached = true;
    const ewa_status status = add_piece(in, &file, pieces);
    if (status != EWA_OK) ewa_file_unmap(in->context, &file);
    return status;
}

bool ewa_volume_has_file(const ewa_volume_input *in, const char *file_name) {
    char found[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    return in->path && ewa_referenced_file_find(in->context, in->path, file_name, false, found, reason);
}

ewa_status ewa_volume_add_file(const ewa_volume_input *in, const char *file_name, ewa_volume_pieces *pieces) {
    if (!in->path)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED,
                               "the voxels are in another file, which needs the name of this one");
    if (!*file_name) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "no usable name of the file with the voxels");
    ewa_file file;
    char reason[EWA_REASON_BYTES];
    if (!ewa_referenced_file_map(in->context, in->path, (ewa_text){file_name, strlen(file_name)}, &file, reason))
        return ewa_volume_fail(in, EWA_ERROR_IO, "'%.200s': %s", file_name, reason);
    pieces->detached = true;
    const ewa_status status = add_piece(in, &file, pieces);
    if (status != EWA_OK) ewa_file_unmap(in->context, &file);
    return status;
}

ewa_status ewa_volume_add_list(const ewa_volume_input *in, const char *text, const char *end,
                               ewa_volume_pieces *pieces) {
    ewa_status status = EWA_OK;
    while (text < end && status == EWA_OK) {
        const char *line_end = memchr(text, '\n', (size_t)(end - text));
        const char *stop = line_end ? line_end : end;
        while (stop > text && (stop[-1] == '\r' || stop[-1] == ' ')) stop--;
        char name[EWA_VOLUME_NAME_BYTES];
        if ((size_t)(stop - text) >= sizeof name)
            status = ewa_volume_fail(in, EWA_ERROR_FORMAT, "a name of over %zu bytes", sizeof name - 1);
        if (status == EWA_OK && stop > text) {
            memcpy(name, text, (size_t)(stop - text));
            name[stop - text] = 0;
            status = ewa_volume_add_file(in, name, pieces);
        }
        text = line_end ? line_end + 1 : end;
    }
    return status;
}

/// Splits "PATTERN FIRST LAST [STEP ...]" from behind the name; false when it is none such.
static bool parse_pattern(const char *text, char name[EWA_VOLUME_NAME_BYTES], int64_t range[3]) {
    const char *blank = strchr(text, ' '), *end = text + strlen(text);
    if (!blank || (size_t)(blank - text) >= EWA_VOLUME_NAME_BYTES) return false;
    memcpy(name, text, (size_t)(blank - text));
    name[blank - text] = 0;
    range[2] = 1;
    for (int i = 0; i < 3; i++) {
        while (*blank == ' ') blank++;
        const char *after = ewa_number_read_i64(blank, end, &range[i]);
        if (!after) return i == 2 && !*blank;
        blank = after;
    }
    return range[2] != 0;
}

/// Writes `name` with `number` in the place of its %d, %3d or %03d; false when there is not exactly one or no
/// room.
static bool expand_pattern(const char *name, int64_t number, char expanded[EWA_VOLUME_NAME_BYTES]) {
    const char *percent = strchr(name, '%');
    if (!percent) return false;
    const char *at = percent + 1;
    const bool zeros = *at == '0';
    int width = 0;
    for (; *at >= '0' && *at <= '9' && width <= PATTERN_WIDTH; at++) width = 10 * width + (*at - '0');
    if (*at != 'd' || width > PATTERN_WIDTH || strchr(at, '%')) return false;
    const int length = snprintf(expanded, EWA_VOLUME_NAME_BYTES, zeros ? "%.*s%0*lld%s" : "%.*s%*lld%s",
                                (int)(percent - name), name, width, (long long)number, at + 1);
    return length >= 0 && length < EWA_VOLUME_NAME_BYTES;
}

ewa_status ewa_volume_add_pattern(const ewa_volume_input *in, const char *text, ewa_volume_pieces *pieces) {
    char name[EWA_VOLUME_NAME_BYTES], file_name[EWA_VOLUME_NAME_BYTES];
    int64_t range[3];
    if (!parse_pattern(text, name, range))
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "'%.80s' is no pattern, first, last and step", text);
    const int64_t step = range[2];
    for (int64_t i = range[0]; step > 0 ? i <= range[1] : i >= range[1]; i += step) {
        if (!expand_pattern(name, i, file_name))
            return ewa_volume_fail(in, EWA_ERROR_FORMAT, "'%.80s' has no single %%d", name);
        EWA_TRY(ewa_volume_add_file(in, file_name, pieces));
    }
    return EWA_OK;
}

void ewa_volume_free_pieces(ewa_context *context, ewa_volume_pieces *pieces) {
    for (size_t i = 0; i < pieces->count && pieces->detached; i++) ewa_file_unmap(context, &pieces->files[i]);
    ewa_release(context, pieces->files, pieces->capacity, sizeof *pieces->files);
    *pieces = (ewa_volume_pieces){0};
}
