// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A fast DEFLATE compressor. Filtered rows of pictures are noise around zero, with runs where the picture is
// flat: Huffman codes and copies from one byte back take nearly all that a search for matches would gain, at
// a fraction of its time. Based on: P. Deutsch, RFC 1951, 1996, sections 3.2.3 to 3.2.7; D. A. Huffman, A
// Method for the Construction of Minimum-Redundancy Codes, 1952, with two sorted queues.
#include "io/deflate.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    SYMBOL_COUNT = 286, // literals 0 to 255, end of block, length codes 257 to 285
    END_OF_BLOCK = 256,
    // A token is a literal, or 253 + the length of a copy from one byte back.
    TOKEN_COUNT = 512,
    TOKEN_OF_LENGTH_0 = 253,
    SHORTEST_COPY = 3,
    LONGEST_COPY = 258,
    // Longest Huffman code. RFC 1951 allows 15; with 12, three tokens of 12 + 5 extra + 1 distance bits fit
    // into 64 bits beside the 7 that may wait.
    LONGEST_CODE = 12,
    STORED_MAX_BYTES = 65535,
    STORED_HEAD_BYTES = 5,
    // 3 + 14 bits of counts, 19 lengths of 3 bits, 287 lengths of 4 bits, end of block, alignment.
    HEAD_MAX_BYTES = 180,
};

/// The first three bytes of a word in memory order.
static const uint32_t THREE_BYTES = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? 0x00ffffffu : 0xffffff00u;

/// Bits on their way out, least significant first.
typedef struct bit_writer {
    uint8_t *next;
    uint64_t bits;
    uint32_t count;
} bit_writer;

static void put_bits(bit_writer *writer, uint32_t value, uint32_t count) {
    writer->bits |= (uint64_t)value << writer->count;
    writer->count += count;
}

/// Moves whole bytes out; at most 7 bits stay of at most 63. Writes 8 bytes, of which those that are not
/// whole are overwritten later.
static void flush_bits(bit_writer *writer) {
    const uint64_t bits = writer->bits;
    for (int byte = 0; byte < 8; byte++) writer->next[byte] = (uint8_t)(bits >> 8 * byte);
    writer->next += writer->count >> 3;
    writer->bits = bits >> (writer->count & 56);
    writer->count &= 7;
}

/// The length code of a copy: its symbol, number of extra bits and their value (RFC 1951, section 3.2.5).
typedef struct length_code {
    uint16_t symbol;
    uint8_t extra_count, extra;
} length_code;

static length_code code_of_length(uint32_t length) {
    if (length == LONGEST_COPY) return (length_code){285, 0, 0};
    const uint32_t offset = length - SHORTEST_COPY;
    if (offset < 8) return (length_code){(uint16_t)(257 + offset), 0, 0};
    // Four codes per octave: two bits below the leading one, then the extra bits.
    const uint32_t extra_count = 29 - (uint32_t)__builtin_clz(offset);
    return (length_code){(uint16_t)(257 + 4 * extra_count + (offset >> extra_count)), (uint8_t)extra_count,
                         (uint8_t)(offset & ((1u << extra_count) - 1))};
}

/// How many bytes from `bytes` on equal `value`, up to `most`.
static size_t run_length(const uint8_t *bytes, uint8_t value, size_t most) {
    const uint64_t repeated = value * 0x0101010101010101u;
    size_t length = 0;
    for (uint64_t word; length + 8 <= most; length += 8) {
        memcpy(&word, bytes + length, sizeof word);
        if (word != repeated) break;
    }
    while (length < most && bytes[length] == value) length++;
    return length;
}

/// Splits the bytes into tokens; returns their number.
static size_t tokenise(const uint8_t *bytes, size_t size_bytes, uint16_t *tokens) {
    uint16_t *next = tokens;
    *next++ = bytes[0];
    size_t at = 1;
    while (at + sizeof(uint32_t) <= size_bytes) {
        // One comparison of three bytes: fewer mispredicted branches than one by one.
        uint32_t word;
        memcpy(&word, bytes + at, sizeof word);
        const uint8_t before = bytes[at - 1];
        if ((word ^ before * 0x01010101u) & THREE_BYTES) {
            *next++ = bytes[at++];
            continue;
        }
        const size_t most = size_bytes - at < LONGEST_COPY ? size_bytes - at : LONGEST_COPY;
        const size_t length = run_length(bytes + at, before, most);
        *next++ = (uint16_t)(TOKEN_OF_LENGTH_0 + length);
        at += length;
    }
    while (at < size_bytes) *next++ = bytes[at++];
    return (size_t)(next - tokens);
}

/// Counts the tokens, in two tables, so that a token does not wait for the count of the same one before it.
static void count_tokens(const uint16_t *tokens, size_t token_count, uint32_t uses[TOKEN_COUNT]) {
    uint32_t odd_uses[TOKEN_COUNT] = {0};
    size_t at = 0;
    for (; at + 2 <= token_count; at += 2) {
        uses[tokens[at]]++;
        odd_uses[tokens[at + 1]]++;
    }
    if (at < token_count) uses[tokens[at]]++;
    for (int token = 0; token < TOKEN_COUNT; token++) uses[token] += odd_uses[token];
}

typedef struct leaf {
    uint32_t weight, symbol;
} leaf;

static int compare_leaves(const void *a, const void *b) {
    const leaf *left = a, *right = b;
    if (left->weight != right->weight) return left->weight < right->weight ? -1 : 1;
    return left->symbol < right->symbol ? -1 : 1;
}

/// Lengths of the Huffman code of weights, of which at least two are positive; returns the longest.
static uint32_t huffman_lengths(const uint32_t weight[SYMBOL_COUNT], uint8_t length[SYMBOL_COUNT]) {
    leaf leaves[SYMBOL_COUNT];
    uint32_t leaf_count = 0;
    for (uint32_t symbol = 0; symbol < SYMBOL_COUNT; symbol++)
        if (weight[symbol]) leaves[leaf_count++] = (leaf){weight[symbol], symbol};
    qsort(leaves, leaf_count, sizeof *leaves, compare_leaves);

    // Nodes: the sorted leaves, then the inner nodes, whose weights come out sorted too.
    uint32_t parent[2 * SYMBOL_COUNT], inner_weight[SYMBOL_COUNT];
    uint32_t next_leaf = 0, next_inner = 0;
    const uint32_t inner_count = leaf_count - 1;
    for (uint32_t made = 0; made < inner_count; made++) {
        inner_weight[made] = 0;
        for (int child = 0; child < 2; child++) {
            const bool take_leaf =
                next_leaf < leaf_count &&
                (next_inner == made || leaves[next_leaf].weight <= inner_weight[next_inner]);
            inner_weight[made] += take_leaf ? leaves[next_leaf].weight : inner_weight[next_inner];
            parent[take_leaf ? next_leaf++ : leaf_count + next_inner++] = leaf_count + made;
        }
    }
    uint8_t depth[2 * SYMBOL_COUNT];
    const uint32_t top = leaf_count + inner_count - 1;
    uint32_t longest = 0;
    depth[top] = 0;
    memset(length, 0, SYMBOL_COUNT);
    for (uint32_t node = top; node-- > 0;) {
        depth[node] = (uint8_t)(depth[parent[node]] + 1);
        if (node >= leaf_count) continue;
        length[leaves[node].symbol] = depth[node];
        longest = depth[node] > longest ? depth[node] : longest;
    }
    return longest;
}

/// Flattens the weights until no code is longer than LONGEST_CODE.
static void limited_lengths(uint32_t weight[SYMBOL_COUNT], uint8_t length[SYMBOL_COUNT]) {
    while (huffman_lengths(weight, length) > LONGEST_CODE)
        for (int symbol = 0; symbol < SYMBOL_COUNT; symbol++)
            if (weight[symbol]) weight[symbol] = weight[symbol] / 2 + 1;
}

static uint32_t reverse_bits(uint32_t value, uint32_t count) {
    uint32_t reversed = 0;
    for (uint32_t bit = 0; bit < count; bit++) reversed |= (value >> bit & 1) << (count - 1 - bit);
    return reversed;
}

/// The canonical codes of RFC 1951, section 3.2.2, bit-reversed for output.
static void canonical_codes(const uint8_t length[SYMBOL_COUNT], uint16_t code[SYMBOL_COUNT]) {
    uint32_t next[LONGEST_CODE + 2] = {0}, length_count[LONGEST_CODE + 1] = {0};
    for (int symbol = 0; symbol < SYMBOL_COUNT; symbol++) length_count[length[symbol]]++;
    length_count[0] = 0;
    for (int bits = 1; bits <= LONGEST_CODE; bits++) next[bits + 1] = (next[bits] + length_count[bits]) << 1;
    for (int symbol = 0; symbol < SYMBOL_COUNT; symbol++)
        code[symbol] = (uint16_t)reverse_bits(next[length[symbol]]++, length[symbol]);
}

/// The head of a block with its own codes (RFC 1951, section 3.2.7). The code lengths themselves are sent
/// with four bits each: the 16 plain ones of their alphabet make a complete code, and 150 bytes are little
/// beside a block.
static void put_head(bit_writer *writer, const uint8_t length[SYMBOL_COUNT]) {
    put_bits(writer, 2 << 1, 3);
    put_bits(writer, SYMBOL_COUNT - 257, 5);
    put_bits(writer, 0, 5); // one distance code
    put_bits(writer, 19 - 4, 4);
    for (int place = 0; place < 19; place++) { // 16, 17, 18 come first: repetitions, not used
        put_bits(writer, place < 3 ? 0 : 4, 3);
        flush_bits(writer);
    }
    for (int symbol = 0; symbol < SYMBOL_COUNT; symbol++) {
        put_bits(writer, reverse_bits(length[symbol], 4), 4);
        flush_bits(writer);
    }
    put_bits(writer, reverse_bits(1, 4), 4); // the distance code has one bit
    flush_bits(writer);
}

/// What one token becomes: its Huffman code, extra bits and the distance code 0 in one piece.
typedef struct piece {
    uint32_t bits, count;
} piece;

/// Works on a copy of the writer, which the compiler keeps in registers: bytes going out could alias the
/// original.
static bit_writer put_tokens(bit_writer writer, const piece *pieces, const uint16_t *tokens,
                             size_t token_count) {
    size_t at = 0;
    for (; at + 3 <= token_count; at += 3) {
        for (int i = 0; i < 3; i++)
            put_bits(&writer, pieces[tokens[at + i]].bits, pieces[tokens[at + i]].count);
        flush_bits(&writer);
    }
    for (; at < token_count; at++) {
        put_bits(&writer, pieces[tokens[at]].bits, pieces[tokens[at]].count);
        flush_bits(&writer);
    }
    return writer;
}

static size_t put_stored(const uint8_t *bytes, size_t size_bytes, uint8_t *out) {
    uint8_t *next = out;
    for (size_t at = 0; at < size_bytes;) {
        const size_t length = size_bytes - at < STORED_MAX_BYTES ? size_bytes - at : STORED_MAX_BYTES;
        *next++ = 0;
        *next++ = (uint8_t)length;
        *next++ = (uint8_t)(length >> 8);
        *next++ = (uint8_t)~length;
        *next++ = (uint8_t)(~length >> 8);
        memcpy(next, bytes + at, length);
        next += length;
        at += length;
    }
    return (size_t)(next - out);
}

static size_t stored_bound(size_t size_bytes) {
    return size_bytes + (size_bytes / STORED_MAX_BYTES + 1) * STORED_HEAD_BYTES;
}

size_t ewa_deflate_bound(size_t size_bytes) {
    return stored_bound(size_bytes) + HEAD_MAX_BYTES + STORED_HEAD_BYTES + sizeof(uint64_t);
}

size_t ewa_deflate_block(const uint8_t *bytes, size_t size_bytes, uint16_t *tokens, uint8_t *out) {
    uint32_t token_uses[TOKEN_COUNT] = {0}, weight[SYMBOL_COUNT] = {0};
    const size_t token_count = tokenise(bytes, size_bytes, tokens);
    count_tokens(tokens, token_count, token_uses);
    memcpy(weight, token_uses, END_OF_BLOCK * sizeof *weight);
    weight[END_OF_BLOCK] = 1;
    for (uint32_t length = SHORTEST_COPY; length <= LONGEST_COPY; length++)
        weight[code_of_length(length).symbol] += token_uses[TOKEN_OF_LENGTH_0 + length];

    uint8_t code_length[SYMBOL_COUNT];
    uint16_t code[SYMBOL_COUNT];
    limited_lengths(weight, code_length);
    canonical_codes(code_length, code);

    piece pieces[TOKEN_COUNT];
    uint64_t total_bits = 0;
    for (uint32_t token = 0; token < TOKEN_COUNT; token++) {
        length_code symbol = {(uint16_t)token, 0, 0};
        if (token >= END_OF_BLOCK) symbol = code_of_length(token - TOKEN_OF_LENGTH_0);
        const uint32_t huffman_count = code_length[symbol.symbol], is_copy = token >= END_OF_BLOCK;
        pieces[token].bits = code[symbol.symbol] | (uint32_t)symbol.extra << huffman_count;
        pieces[token].count = huffman_count + symbol.extra_count + is_copy;
        total_bits += (uint64_t)pieces[token].count * token_uses[token];
    }
    if (total_bits / 8 + HEAD_MAX_BYTES >= stored_bound(size_bytes))
        return put_stored(bytes, size_bytes, out);

    bit_writer writer = {out, 0, 0};
    put_head(&writer, code_length);
    writer = put_tokens(writer, pieces, tokens, token_count);
    // An empty stored block brings the stream to a byte boundary.
    put_bits(&writer, code[END_OF_BLOCK], code_length[END_OF_BLOCK]);
    put_bits(&writer, 0, 3);
    put_bits(&writer, 0, (8 - writer.count % 8) % 8);
    flush_bits(&writer);
    memcpy(writer.next, "\0\0\xff\xff", 4);
    return (size_t)(writer.next - out) + 4;
}

size_t ewa_deflate_end(uint8_t *out) {
    // A last block with the fixed codes that holds its end only.
    out[0] = 3;
    out[1] = 0;
    return 2;
}
