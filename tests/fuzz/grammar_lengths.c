// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lengths around a text that was edited: the chunk of a GLB, a stored file of a zip archive, the pages of an E57. Without them a
// reader would see the old end of the new text.
#include "grammar.h"

#include <stdlib.h>
#include <string.h>

static uint64_t get(const uint8_t *at, int bytes) {
    uint64_t value = 0;
    for (int i = bytes - 1; i >= 0; i--) value = value << 8 | at[i];
    return value;
}

static void put(uint8_t *at, int bytes, uint64_t value) {
    for (int i = 0; i < bytes; i++) at[i] = (uint8_t)(value >> (8 * i));
}

enum { PAGE = 1024, PAYLOAD = 1020 };

bool fuzz_e57_open(const fuzz_input *input, fuzz_input *plain) {
    if (input->size_bytes < PAGE || memcmp(input->bytes, "ASTM-E57", 8) != 0 || get(input->bytes + 40, 8) != PAGE) return false;
    *plain = (fuzz_input){.bytes = malloc(input->room_bytes + 1), .room_bytes = input->room_bytes, .random = input->random};
    if (!plain->bytes) return false;
    for (size_t at = 0; at < input->size_bytes; at += PAGE) {
        const size_t left = input->size_bytes - at, bytes = left < PAYLOAD ? left : PAYLOAD;
        memcpy(plain->bytes + plain->size_bytes, input->bytes + at, bytes);
        plain->size_bytes += bytes;
    }
    return true;
}

void fuzz_e57_close(fuzz_input *input, fuzz_input *plain) {
    const size_t pages = (plain->size_bytes + PAYLOAD - 1) / PAYLOAD;
    input->full = plain->full || pages * PAGE > input->room_bytes;
    if (!input->full) {
        input->size_bytes = pages * PAGE;
        memset(input->bytes, 0, input->size_bytes);
        for (size_t page = 0; page < pages; page++) {
            const size_t at = page * PAYLOAD, left = plain->size_bytes - at;
            memcpy(input->bytes + page * PAGE, plain->bytes + at, left < PAYLOAD ? left : PAYLOAD);
        }
    }
    free(plain->bytes);
}

/// Places in the file as E57 counts them, with checksums.
static uint64_t physical(uint64_t at) { return at / PAYLOAD * PAGE + at % PAYLOAD; }

static void fit_e57(fuzz_input *plain, size_t begin, size_t new_end) {
    uint8_t *head = plain->bytes;
    if (get(head + 24, 8) != physical(begin)) return;
    put(head + 32, 8, new_end - begin);
    // What is behind the XML was padding of the last page, or is read as such.
    plain->size_bytes = new_end;
    put(head + 16, 8, (new_end + PAYLOAD - 1) / PAYLOAD * PAGE);
}

static void fit_glb(fuzz_input *input, size_t end, size_t new_end) {
    const uint64_t chunk_bytes = get(input->bytes + 12, 4) + new_end - end;
    const size_t padding = (4 - chunk_bytes % 4) % 4;
    fuzz_splice(input, new_end, new_end, "   ", padding);
    put(input->bytes + 12, 4, chunk_bytes + padding);
    put(input->bytes + 8, 4, input->size_bytes);
}

/// Archives that need no data descriptors; the reader looks at no checksum.
static void fit_zip(fuzz_input *input, size_t begin, size_t end, size_t new_end) {
    enum { ENTRY = 46, LOCAL = 30, LAST = 22 };
    uint8_t *last = input->bytes + input->size_bytes - LAST;
    const uint64_t more = new_end - end;
    if (input->size_bytes < LAST || memcmp(last, "PK\5\6", 4) != 0) return;
    uint64_t at = get(last + 16, 4) + more;
    put(last + 16, 4, at);
    while (at < input->size_bytes && input->size_bytes - at >= ENTRY && memcmp(input->bytes + at, "PK\1\2", 4) == 0) {
        uint8_t *entry = input->bytes + at;
        const uint64_t local = get(entry + 42, 4), bytes = get(entry + 20, 4);
        if (local > begin)
            put(entry + 42, 4, local + more);
        else if (local + LOCAL <= begin && begin <= local + LOCAL + get(entry + 28, 2) + get(input->bytes + local + 28, 2) + bytes) {
            put(entry + 20, 4, bytes + more);
            put(entry + 24, 4, bytes + more);
            put(input->bytes + local + 18, 4, bytes + more);
            put(input->bytes + local + 22, 4, bytes + more);
        }
        at += ENTRY + get(entry + 28, 2) + get(entry + 30, 2) + get(entry + 32, 2);
    }
}

void fuzz_fit_lengths(fuzz_input *input, size_t begin, size_t end, size_t new_end) {
    if (input->full || input->size_bytes < 64) return;
    if (memcmp(input->bytes, "ASTM-E57", 8) == 0)
        fit_e57(input, begin, new_end);
    else if (memcmp(input->bytes, "glTF", 4) == 0 && begin == 20)
        fit_glb(input, end, new_end);
    else if (memcmp(input->bytes, "PK", 2) == 0)
        fit_zip(input, begin, end, new_end);
}
