// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LZF: a byte below 32 says that as many bytes and one more follow as they are; else its upper three bits and
// one are the length of a piece that came before, its lower five and the next byte how far before. A length
// of 8 goes on in a byte of its own between the two.
#include "io/cloud/pcd.h"

enum { PIECE_BYTES = 16 }; ///< what is copied at once where there is room behind

static void copy_far(uint8_t *to, const uint8_t *from, uint32_t length) {
    for (uint32_t i = 0; i < length; i += PIECE_BYTES) memcpy(to + i, from + i, PIECE_BYTES);
}

bool ewa_lzf_unpack(const uint8_t *from, uint64_t from_bytes, uint8_t *to, uint64_t to_bytes) {
    uint64_t in = 0, out = 0;
    while (in < from_bytes) {
        uint32_t length = from[in++];
        if (length < 32) {
            length++;
            if (length > from_bytes - in || length > to_bytes - out) return false;
            if (from_bytes - in >= length + PIECE_BYTES && to_bytes - out >= length + PIECE_BYTES)
                copy_far(to + out, from + in, length);
            else
                memcpy(to + out, from + in, length);
            in += length;
            out += length;
            continue;
        }
        uint32_t distance = (length & 31) << 8;
        length = (length >> 5) + 2;
        if (length == 9) {
            if (in == from_bytes) return false;
            length += from[in++];
        }
        if (in == from_bytes) return false;
        distance += from[in++] + 1u;
        if (distance > out || length > to_bytes - out) return false;
        const uint8_t *piece = to + out - distance;
        if (distance >= PIECE_BYTES && to_bytes - out >= length + PIECE_BYTES)
            copy_far(to + out, piece, length);
        else
            for (uint32_t i = 0; i < length; i++) to[out + i] = piece[i];
        out += length;
    }
    return out == to_bytes;
}
