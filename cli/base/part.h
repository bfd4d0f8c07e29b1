// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of a film, so that several processes draw one: a range of frames, or every n-th.
#ifndef EWA_CLI_BASE_PART_H
#define EWA_CLI_BASE_PART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum part_kind {
    PART_ALL,   ///< the whole film
    PART_RANGE, ///< "A-B": frames A to B, both included
    PART_ROBIN, ///< "I/N": frames k with k mod N = I - 1
} part_kind;

/// What --frames asks for.
typedef struct film_part {
    int64_t count; ///< "N": frames on a way, in [1, 1000000]; 0: not given
    part_kind kind;
    uint64_t first, last;  ///< of a range, first <= last
    uint64_t index, parts; ///< of every n-th, 1 <= index <= parts
} film_part;

enum { PART_ERROR_BYTES = 256 };

/// Adds "N", "A-B" or "I/N" to a part; a number and one of the others go together. Says in `message` what is wrong
/// with the text and returns false then.
bool part_add(film_part *part, const char *text, char message[PART_ERROR_BYTES]);

/// Whether a frame, counted from 0, belongs to the part.
bool part_has(const film_part *part, uint64_t frame);

/// Whether a range lies beyond the end of a film of `count` frames; says so in `message` then.
bool part_is_beyond(const film_part *part, uint64_t count, char message[PART_ERROR_BYTES]);

#endif
