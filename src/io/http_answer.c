// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Answers of servers: nothing of them is taken for granted.
#include "io/http_answer.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { FIRST_WHOLE_BYTES = 1 << 20 };

void ewa_http_answer_open(ewa_context *context, ewa_http_part *part, ewa_http_answer *answer) {
    part->got_bytes = 0;
    part->whole = NULL;
    part->file_bytes = EWA_HTTP_SIZE_UNKNOWN;
    part->tag[0] = 0;
    *answer = (ewa_http_answer){.context = context, .part = part};
}

void ewa_http_answer_begin(ewa_http_answer *answer) {
    answer->before_bytes = answer->part->got_bytes;
    memcpy(answer->tag_before, answer->part->tag, sizeof answer->tag_before);
    answer->code = 0;
    answer->refused = NULL;
    answer->whole_bytes = 0;
}

static bool begins(const char *line, size_t length, const char *name, const char **value, const char **end) {
    const size_t name_bytes = strlen(name);
    if (length <= name_bytes || strncasecmp(line, name, name_bytes) != 0) return false;
    *value = line + name_bytes;
    *end = line + length;
    while (*value < *end && (**value == ' ' || **value == '\t')) ++*value;
    while (*value < *end && ((*end)[-1] == '\r' || (*end)[-1] == '\n' || (*end)[-1] == ' ')) --*end;
    return true;
}

/// Reads a whole number and steps behind it; EWA_HTTP_SIZE_UNKNOWN where there is none, or too large a one.
static uint64_t read_number(const char **at, const char *end) {
    uint64_t number = 0;
    bool any = false;
    for (; *at < end && **at >= '0' && **at <= '9'; ++*at, any = true) {
        if (number > (UINT64_MAX >> 4)) return EWA_HTTP_SIZE_UNKNOWN;
        number = 10 * number + (uint64_t)(**at - '0');
    }
    return any ? number : EWA_HTTP_SIZE_UNKNOWN;
}

/// Reads "bytes FIRST-LAST/SIZE", of which the size may be "*", and all before it where there is no such part.
static void read_range(ewa_http_answer *answer, const char *value, const char *end) {
    static const char unit[] = "bytes ";
    if ((size_t)(end - value) < sizeof unit || strncasecmp(value, unit, sizeof unit - 1) != 0) return;
    const char *at = value + sizeof unit - 1;
    const uint64_t first = read_number(&at, end);
    const uint64_t last = at < end && *at == '-' ? (at++, read_number(&at, end)) : EWA_HTTP_SIZE_UNKNOWN;
    if (first != EWA_HTTP_SIZE_UNKNOWN && last != EWA_HTTP_SIZE_UNKNOWN && last >= first)
        answer->range_first = first, answer->range_size = last - first + 1;
    while (at < end && *at != '/') at++;
    if (at < end) at++, answer->part->file_bytes = read_number(&at, end);
}

void ewa_http_answer_take_header(ewa_http_answer *answer, const char *line, size_t length) {
    ewa_http_part *part = answer->part;
    const char *value, *end;
    if (length > 5 && strncmp(line, "HTTP/", 5) == 0) {
        // A new answer: of what leads here, or of this address.
        answer->range_first = answer->range_size = answer->length = part->file_bytes = EWA_HTTP_SIZE_UNKNOWN;
        answer->packed = false;
        part->tag[0] = 0;
        const char *at = memchr(line, ' ', length);
        end = line + length;
        answer->code = at ? (at++, (long)read_number(&at, end)) : 0;
    } else if (begins(line, length, "content-range:", &value, &end)) {
        read_range(answer, value, end);
    } else if (begins(line, length, "content-length:", &value, &end)) {
        answer->length = read_number(&value, end);
    } else if (begins(line, length, "content-encoding:", &value, &end)) {
        answer->packed = !(end - value == 8 && strncasecmp(value, "identity", 8) == 0);
    } else if (begins(line, length, "etag:", &value, &end) ||
               (!part->tag[0] && begins(line, length, "last-modified:", &value, &end))) {
        snprintf(part->tag, sizeof part->tag, "%.*s", (int)(end - value), value);
    }
}

static bool refuse(ewa_http_answer *answer, ewa_status status, const char *why) {
    answer->refused = why;
    answer->refused_status = status;
    return false;
}

/// Keeps a file that comes as a whole, though a part was asked for.
static bool take_whole(ewa_http_answer *answer, const char *bytes, size_t size_bytes) {
    ewa_http_part *part = answer->part;
    ewa_context *context = answer->context;
    const uint64_t said = answer->length == EWA_HTTP_SIZE_UNKNOWN ? 0 : answer->length;
    if (said > EWA_HTTP_WHOLE_BYTES || answer->whole_bytes + size_bytes > EWA_HTTP_WHOLE_BYTES)
        return refuse(answer, EWA_ERROR_LIMIT,
                      "the server gives no parts of files (ranges), and the whole is more than 1 GiB: download it");
    if (answer->whole_bytes + size_bytes > answer->whole_room_bytes) {
        size_t room = answer->whole_room_bytes ? 2 * answer->whole_room_bytes : FIRST_WHOLE_BYTES;
        if (said > room) room = (size_t)said;
        while (room < answer->whole_bytes + size_bytes) room *= 2;
        uint8_t *larger = ewa_memory_left(context) > room ? ewa_allocate(context, room, 1) : NULL;
        if (!larger)
            return refuse(answer, EWA_ERROR_LIMIT,
                          "the server gives no parts of files (ranges), and the whole needs more memory than may be held");
        if (answer->whole_bytes) memcpy(larger, part->whole, answer->whole_bytes);
        ewa_release(context, part->whole, answer->whole_room_bytes, 1);
        part->whole = larger;
        answer->whole_room_bytes = room;
    }
    memcpy(part->whole + answer->whole_bytes, bytes, size_bytes);
    answer->whole_bytes += size_bytes;
    return true;
}

bool ewa_http_answer_take_body(ewa_http_answer *answer, const char *bytes, size_t size_bytes) {
    ewa_http_part *part = answer->part;
    if (answer->code != 200 && answer->code != 206) return true; // the words of an error
    if (answer->packed) return refuse(answer, EWA_ERROR_IO, "the server sends it compressed, of which there are no parts");
    if (answer->code == 200) return take_whole(answer, bytes, size_bytes);
    if (answer->range_first != part->at_bytes + answer->before_bytes ||
        answer->range_size > part->size_bytes - answer->before_bytes)
        return refuse(answer, EWA_ERROR_IO, "the server sends another part than it was asked for");
    if (answer->before_bytes && strcmp(part->tag, answer->tag_before) != 0)
        return refuse(answer, EWA_ERROR_IO, "the file has become another one");
    const size_t came_bytes = part->got_bytes - answer->before_bytes;
    if (came_bytes > answer->range_size || size_bytes > answer->range_size - came_bytes)
        return refuse(answer, EWA_ERROR_IO, "the server sends more than it says");
    memcpy(part->to + part->got_bytes, bytes, size_bytes);
    part->got_bytes += size_bytes;
    return true;
}

bool ewa_http_answer_is_whole(const ewa_http_answer *answer) {
    const ewa_http_part *part = answer->part;
    // 416: there is nothing there, or what is asked for lies beyond the end.
    return answer->code == 200 || answer->code == 416 ||
           (answer->code == 206 && part->got_bytes == answer->before_bytes + answer->range_size);
}

void ewa_http_answer_end(ewa_http_answer *answer) {
    ewa_http_part *part = answer->part;
    uint8_t *fit = NULL;
    if (part->status == EWA_OK && answer->code == 200) {
        part->file_bytes = answer->whole_bytes;
        // The memory is given back by its size.
        if (answer->whole_bytes) fit = ewa_allocate(answer->context, answer->whole_bytes, 1);
        if (fit) memcpy(fit, part->whole, answer->whole_bytes);
        if (answer->whole_bytes && !fit) part->status = EWA_ERROR_MEMORY;
    }
    ewa_release(answer->context, part->whole, answer->whole_room_bytes, 1);
    part->whole = fit;
    answer->whole_room_bytes = 0;
}
