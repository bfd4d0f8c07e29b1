// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The letters, drawn for this library: capitals 12 high, small letters 8, tails 4 below the baseline. Upright stems and
// bars lie where text.c puts whole pixels.
#include "furniture/font.h"

#include <stddef.h>

enum { FIRST = ' ', LAST = '~' };

static const ewa_glyph ascii[LAST - FIRST + 1] = {
    {2, false, ""},                                        // space
    {0, false, "0g08 04"},                                 // !
    {3, false, "0g0d 3g3d"},                               // "
    {10, false, "144g 649g 0898 1cac"},                    // #
    {8, true, "8d!4g-0d!4a-87!44-07 4i42"},                // $
    {12, false, "2g-0e!2c-4e!2g 14bg a8-86!a4-c6!a8"},     // %
    {10, false, "a42d(0g4g-7e(7c4a(0807!44(84aa"},         // &
    {0, false, "0g0d"},                                    // '
    {3, false, "3h(0e09(0431"},                            // (
    {3, false, "0h(3e39(3401"},                            // )
    {6, true, "3g3a 0f6b 0b6f"},                           // *
    {8, true, "0989 4d45"},                                // +
    {1, false, "1402"},                                    // ,
    {5, false, "0959"},                                    // -
    {0, false, "04"},                                      // .
    {6, false, "026h"},                                    // /
    {8, false, "4g-0c08!44-888c!4g"},                      // 0
    {8, false, "2e5g54 2484"},                             // 1
    {8, false, "0d!4g-8d(8b580484"},                       // 2
    {8, false, "0d!4g-7d!4a3a 4a-87!44-07"},               // 3
    {8, false, "646g0787"},                                // 4
    {8, false, "7g0g0b4b-8887!44-06"},                     // 5
    {8, false, "7e!4g-0b08!44-88!4b-07"},                  // 6
    {8, false, "0g8g34"},                                  // 7
    {8, false, "4a-8d!4g-0d!4a-87!44-07!4a"},              // 8
    {8, false, "16!44-898c!4g-0c!49-8d"},                  // 9
    {0, false, "0b 04"},                                   // :
    {1, false, "1b 1402"},                                 // ;
    {7, false, "7d0975"},                                  // <
    {8, false, "0b8b 0787"},                               // =
    {7, false, "0d7905"},                                  // >
    {7, false, "0d!4g-7d(7b4a48 44"},                      // ?
    {14, false, "7d-4a!77-aa!7d ada9!c7-eaeb!7g-09!72b2"}, // @
    {10, false, "045ga4 2888"},                            // A
    {8, false, "4a0a040g4g-7d!4a5a-87!5404"},              // B
    {9, false, "9d!5g-0b09!54-97"},                        // C
    {9, false, "040g4g-9b99!4404"},                        // D
    {7, false, "74040g7g 0a6a"},                           // E
    {7, false, "040g7g 0a6a"},                             // F
    {9, false, "9d!5g-0b09!54-979a5a"},                    // G
    {9, false, "040g 949g 0a9a"},                          // H
    {0, false, "040g"},                                    // I
    {6, false, "6g67!34-07"},                              // J
    {9, false, "040g 9g08 3b94"},                          // K
    {7, false, "0g0474"},                                  // L
    {10, false, "040g58aga4"},                             // M
    {9, false, "040g949g"},                                // N
    {10, false, "5g-0b09!54-a9ab!5g"},                     // O
    {8, false, "040g5g-8d!5a0a"},                          // P
    {10, false, "5g-0b09!54-a9ab!5g 67a3"},                // Q
    {8, false, "040g5g-8d!5a0a 4a84"},                     // R
    {8, false, "8d!4g-0d!4a-87!44-07"},                    // S
    {8, true, "0g8g 4g44"},                                // T
    {9, false, "0g08!4454-989g"},                          // U
    {10, false, "0g54ag"},                                 // V
    {14, false, "0g447ga4eg"},                             // W
    {9, false, "049g 0g94"},                               // X
    {10, true, "0g5aag 5a54"},                             // Y
    {8, false, "0g8g0484"},                                // Z
    {3, false, "3h0h0131"},                                // [
    {6, false, "0h62"},                                    // backslash
    {3, false, "0h3h3101"},                                // ]
    {8, false, "0b4g8b"},                                  // ^
    {8, false, "0282"},                                    // _
    {3, false, "0g3d"},                                    // `
    {7, false, "0a!3c4c-7974 7838-06!3444-76"},            // a
    {7, false, "0g04 09!3c4c-7977!4434-07"},               // b
    {6, false, "6a!3c-0907!34-66"},                        // c
    {7, false, "7g74 79!4c3c-0907!3444-77"},               // d
    {7, false, "087879!4c3c-0907!3454-75"},                // e
    {5, false, "5g-2d24 0c5c"},                            // f
    {7, false, "7c73!4030-02 79!4c3c-0907!3444-77"},       // g
    {7, false, "0g04 09!4c-7974"},                         // h
    {0, false, "0c04 0g"},                                 // i
    {3, false, "3c32!1000 3g"},                            // j
    {7, false, "040g 7c07 3974"},                          // k
    {2, false, "0g06!24"},                                 // l
    {12, true, "0c04 09!3c-6964 69!9c-c9c4"},              // m
    {7, false, "0c04 09!4c-7974"},                         // n
    {8, false, "4c-0907!44-8789!4c"},                      // o
    {7, false, "0c00 09!3c4c-7977!4434-07"},               // p
    {7, false, "7c70 79!4c3c-0907!3444-77"},               // q
    {4, false, "0c04 09!4c"},                              // r
    {6, false, "6b!4c2c-0a!2848-66!4424-05"},              // s
    {5, false, "2f26!4454 0c5c"},                          // t
    {7, false, "0c07!34-77 7c74"},                         // u
    {8, false, "0c448c"},                                  // v
    {12, false, "0c346c94cc"},                             // w
    {7, false, "047c 0c74"},                               // x
    {8, false, "0c44 8c20"},                               // y
    {6, false, "0c6c0464"},                                // z
    {4, false, "4h-2f2b!09-2723!41"},                      // {
    {0, false, "0h01"},                                    // |
    {4, false, "0h-2f2b!49-2723!01"},                      // }
    {8, false, "08(2c49(668a"},                            // ~
};

/// Signs beyond ASCII.
static const struct {
    uint32_t code;
    ewa_glyph glyph;
} signs[] = {
    {0x00b0, {4, false, "2g-0e!2c-4e!2g"}},                                       // degree
    {0x00b1, {8, true, "0b8b 4f47 0484"}},                                        // plus-minus
    {0x00b2, {4, false, "0f(0g2g(4g4e(4d0a4a"}},                                  // squared
    {0x00b3, {4, false, "0g4g2d(4d4b(4a2a0a"}},                                   // cubed
    {0x00b5, {7, false, "0c00 07!34-77 7c74"}},                                   // micro
    {0x00b7, {0, false, "09"}},                                                   // middle dot
    {0x00c6, {12, false, "046gcg 6g64c4 6aba 2868"}},                             // AE
    {0x00d7, {6, false, "066c 0c66"}},                                            // times
    {0x00d8, {10, false, "5g-0b09!54-a9ab!5g 04ag"}},                             // O slashed
    {0x00df, {7, false, "040d!3g-6d!3a-77!4424"}},                                // sharp s
    {0x00e6, {12, false, "0a!2c3c-6964 6838-06!3444-66 68c8c9!9c-6967!94a4-c5"}}, // ae
    {0x00f7, {8, true, "0989 4d 45"}},                                            // divided by
    {0x00f8, {8, false, "4c-0907!44-8789!4c 048c"}},                              // o slashed
    {0x03bc, {7, false, "0c00 07!34-77 7c74"}},                                   // mu
    {0x2013, {8, false, "0989"}},                                                 // en dash
    {0x2026, {8, false, "04 44 84"}},                                             // ellipsis
};

static const ewa_glyph box = {6, false, "040g6g6404"};
static const ewa_glyph dotless_i = {0, false, "0c04"};

/// What stands above small letters, or below.
static const struct {
    char mark;
    ewa_glyph glyph;
} marks[] = {
    {'`', {3, false, "0g3e"}},           // grave
    {'/', {3, false, "0e3g"}},           // acute
    {'^', {4, false, "0e2g4e"}},         // circumflex
    {'~', {6, false, "0e(1h3f(5d6g"}},   // tilde
    {':', {4, false, "0f 4f"}},          // diaeresis
    {'o', {4, false, "2i-0g!2e-4g!2i"}}, // ring
    {',', {2, false, "14(2101"}},        // cedilla
};

enum { FIRST_MARKED = 0xc0, LAST_MARKED = 0xff };

/// Letters of Latin-1 that are another one with a mark: that one, and the mark; blanks: neither.
static const char bases[] = "AAAAAA CEEEEIIII NOOOOO  UUUUY  aaaaaa ceeeeiiii nooooo  uuuuy y";
static const char marked[] = "`/^~:o ,`/^:`/^: ~`/^~:  `/^:/  `/^~:o ,`/^:`/^: ~`/^~:  `/^:/ :";

const ewa_glyph *ewa_font_glyph(uint32_t code) {
    if (code >= FIRST && code <= LAST) return &ascii[code - FIRST];
    for (size_t i = 0; i < sizeof signs / sizeof signs[0]; i++)
        if (signs[i].code == code) return &signs[i].glyph;
    const char base = code >= FIRST_MARKED && code <= LAST_MARKED ? bases[code - FIRST_MARKED] : ' ';
    return base == ' ' ? &box : base == 'i' ? &dotless_i : &ascii[base - FIRST];
}

const ewa_glyph *ewa_font_mark(uint32_t code, bool *raised) {
    if (code < FIRST_MARKED || code > LAST_MARKED) return NULL;
    for (size_t i = 0; i < sizeof marks / sizeof marks[0]; i++) {
        if (marks[i].mark != marked[code - FIRST_MARKED]) continue;
        *raised = bases[code - FIRST_MARKED] < 'a' && marks[i].mark != ',';
        return &marks[i].glyph;
    }
    return NULL;
}

uint32_t ewa_font_next(const char **text) {
    // Lengths, least codes and ranges of the second byte: The Unicode Standard 15.0, table 3-7.
    const unsigned char *bytes = (const unsigned char *)*text;
    if (!bytes[0]) return 0;
    const uint32_t length = bytes[0] < 0x80 ? 1 : bytes[0] < 0xe0 ? 2 : bytes[0] < 0xf0 ? 3 : 4;
    static const uint32_t minimum[] = {0, 0x80, 0x800, 0x10000};
    uint32_t code = length == 1 ? bytes[0] : bytes[0] & (0x7fu >> length);
    bool fine = length == 1 || (bytes[0] >= 0xc0 && bytes[0] <= 0xf4);
    for (uint32_t i = 1; i < length && fine; i++) {
        fine = (bytes[i] & 0xc0) == 0x80; // the zero at the end is none either
        code = code << 6 | (bytes[i] & 0x3fu);
    }
    fine = fine && code >= minimum[length - 1] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000);
    *text += fine ? length : 1;
    return fine ? code : UINT32_MAX;
}
