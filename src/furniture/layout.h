// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the pieces of furniture share: room, sizes, ink.
#ifndef EWA_SRC_FURNITURE_LAYOUT_H
#define EWA_SRC_FURNITURE_LAYOUT_H

#include "ewa/furniture.h"

/// Sizes in points.
#define EWA_MARGIN_PT 14.0
#define EWA_TEXT_PT   12.0
#define EWA_TITLE_PT  18.0

/// A rectangle, pixels.
typedef struct ewa_box {
    double left, top, right, bottom;
} ewa_box;

/// Where furniture goes.
typedef struct ewa_layout {
    const ewa_canvas *canvas;
    const ewa_furniture_options *options;
    double point_px;
    ewa_box room; ///< what title and scale bar leave to the colour bar
} ewa_layout;

/// Colours of a piece: that of its text and lines, and that of their rims.
typedef struct ewa_inks {
    uint8_t ink[4], rim[4];
} ewa_inks;

/// Checks that a canvas has pixels, at most 65,536 along each side; `caller` is named in the message. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_layout_check(ewa_context *context, const ewa_canvas *canvas, const char *caller);

/// Pixels of a point on a canvas: `pixel_scale`, or, where it is 0, as suits its size.
double ewa_layout_point_px(const ewa_canvas *canvas, double pixel_scale);

/// Whether a picture is so much higher than wide, as on a phone, that what tells colours stands at the bottom, where such pictures have room, in place
/// of the right, where it would hide what is shown.
bool ewa_layout_is_tall(const ewa_canvas *canvas);

/// Colours that can be read on what the picture has in a box.
ewa_inks ewa_layout_inks(const ewa_layout *layout, const ewa_box *box);

/// A style of text in these colours.
ewa_text_style ewa_layout_style(const ewa_layout *layout, const ewa_inks *inks, double points,
                                ewa_text_anchor anchor);

enum { EWA_LAYOUT_TEXT_BYTES = 512 };

/// Copies a text, shortened by "..." in place of its end until it is at most `max_px` wide; false when not
/// even one character and the dots have room.
bool ewa_layout_shorten(const char *text, double height_px, double max_px,
                        char fitting[EWA_LAYOUT_TEXT_BYTES]);

/// The pixels off a picture's right, or off the bottom of a tall one, that a colour bar takes with numbers of a usual length: which they are
/// is not known where a camera is placed. None where a picture is too small for a bar.
void ewa_color_bar_room(uint32_t width_px, uint32_t height_px, uint32_t room_px[2]);

/// Draws the colour bar, or the legend of categories, at the right of the room, or at the bottom of that of a tall picture.
void ewa_color_bar_draw(const ewa_layout *layout);
void ewa_legend_draw(const ewa_layout *layout);

#endif
