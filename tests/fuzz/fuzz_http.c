// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as answers of a server, by lines: "=N" begins the next answer, N bytes of which are asked for at first; "> BYTES" is
// of its body; others are of its head.
#include "fuzz.h"
#include "io/http_answer.h"

#include <string.h>

enum { MAX_SIZE_BYTES = 4096, AT_BYTES = 1000 };

static void hold(const ewa_http_answer *answer) {
    const ewa_http_part *part = answer->part;
    fuzz_require(part->got_bytes <= part->size_bytes, "a part is not more than it was asked for");
    fuzz_require(answer->before_bytes <= part->got_bytes, "what came stays");
    fuzz_require(answer->whole_bytes <= answer->whole_room_bytes, "a whole file is within its memory");
    fuzz_require(memchr(part->tag, 0, sizeof part->tag) != NULL, "a tag ends");
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    const uint8_t *at = bytes, *end = bytes + size_bytes;
    ewa_http_part part = {.at_bytes = AT_BYTES, .size_bytes = 100};
    if (size_bytes > 2 && at[0] == '=') part.size_bytes = 1 + (size_t)at[1] * at[2] % MAX_SIZE_BYTES;
    part.to = malloc(part.size_bytes);
    fuzz_require(part.to != NULL, "memory");
    ewa_http_answer answer;
    ewa_http_answer_open(context, &part, &answer);
    ewa_http_answer_begin(&answer);
    while (at < end && !answer.refused) {
        const uint8_t *next = memchr(at, '\n', (size_t)(end - at));
        const size_t length = (size_t)((next ? next : end) - at);
        // Of exactly its size, so that what reads beyond it is seen.
        char *line = malloc(length ? length : 1);
        fuzz_require(line != NULL, "memory");
        memcpy(line, at, length);
        if (length && line[0] == '=')
            ewa_http_answer_begin(&answer);
        else if (length > 2 && line[0] == '>')
            ewa_http_answer_take_body(&answer, line + 2, length - 2);
        else
            ewa_http_answer_take_header(&answer, line, length);
        free(line);
        hold(&answer);
        at += length + 1;
    }
    part.status = answer.refused ? answer.refused_status : ewa_http_answer_is_whole(&answer) ? EWA_OK : EWA_ERROR_IO;
    ewa_http_answer_end(&answer);
    if (part.status == EWA_OK && part.whole) fuzz_require(part.file_bytes == answer.whole_bytes, "a whole file has its size");
    if (part.status != EWA_OK) fuzz_require(!part.whole, "nothing is left of a part that failed");
    if (part.whole) ewa_release(context, part.whole, (size_t)part.file_bytes, 1);
    free(part.to);
    ewa_context_destroy(&context);
    return 0;
}
