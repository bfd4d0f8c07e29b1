// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The letters: strokes on a grid of twentieths of the type's size.
#ifndef EWA_SRC_FURNITURE_FONT_H
#define EWA_SRC_FURNITURE_FONT_H

#include <stdbool.h>
#include <stdint.h>

/// The middle line of a letter's strokes.
///
/// A point is two digits to the base 36: how far right of the letter's first stroke, and how far above the baseline,
/// plus 4. A space begins another stroke; a stroke of one point is a dot. Points are joined by lines, but for these,
/// before the point that they lead to: '-' a quarter of an ellipse that leaves across, '!' one that leaves up or down,
/// '(' a parabola that begins and ends towards the point that follows at once.
typedef struct ewa_glyph {
    uint8_t width; ///< from the first to the last stroke
    bool has_stem; ///< in its middle, which stands on whole pixels too
    const char *path;
} ewa_glyph;

/// Returns the letter of a character, without its mark; an empty box for one that there is none of.
const ewa_glyph *ewa_font_glyph(uint32_t code);

/// Returns the mark of an accented letter, NULL for others. It stands in the middle of the letter's width; `*raised`:
/// higher by EWA_FONT_RAISE, as above a capital.
const ewa_glyph *ewa_font_mark(uint32_t code, bool *raised);

enum { EWA_FONT_RAISE = 4 };

/// Takes one character off zero-terminated UTF-8: its code, UINT32_MAX for a byte that begins none, 0 at the end.
uint32_t ewa_font_next(const char **text);

#endif
