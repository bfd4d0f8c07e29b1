// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What stands over a picture: lines, text, and the furniture made of them: title, axes cross, scale bar, colour bar.
//
// All of it is the same bytes on every machine: the letters are strokes of this library's own, no font is looked for.
#ifndef EWA_FURNITURE_H
#define EWA_FURNITURE_H

#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/image.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A picture to draw on, borrowed: rows from the top, tightly packed, as ewa_frame.rgba8.
///
/// What is drawn is put over what is there in linear light, antialiased by the part of each pixel that is covered, and
/// clipped. What is not finite, or reaches more than a million pixels beyond, is not drawn.
typedef struct ewa_canvas {
    uint8_t *rgba8; ///< 4 per pixel: sRGB, straight alpha
    uint32_t width_px, height_px;
} ewa_canvas;

/// Draws a line with round ends from (x0, y0) to (x1, y1), pixels; the same end twice is a disc. `width_px` in
/// (0, 10000]; `rgba`: sRGB, straight alpha. Any thread; a canvas is drawn on by one.
EWA_API void ewa_draw_line(const ewa_canvas *canvas, double x0_px, double y0_px, double x1_px, double y1_px,
                           double width_px, const uint8_t rgba[4]);

/// Fills the rectangle between two opposite corners, pixels. Any thread.
EWA_API void ewa_draw_rectangle(const ewa_canvas *canvas, double x0_px, double y0_px, double x1_px,
                                double y1_px, const uint8_t rgba[4]);

/// Which point of a text is where it is put: across, left, middle or right of its width; down, the baseline, or the
/// top, middle or bottom (baseline) of its capitals.
typedef enum ewa_text_anchor {
    EWA_TEXT_LEFT = 0, ///< of the baseline
    EWA_TEXT_CENTER = 1,
    EWA_TEXT_RIGHT = 2,
    EWA_TEXT_LEFT_MIDDLE = 3, ///< half-way up the capitals
    EWA_TEXT_CENTER_MIDDLE = 4,
    EWA_TEXT_RIGHT_MIDDLE = 5,
    EWA_TEXT_LEFT_TOP = 6, ///< of the capitals
    EWA_TEXT_CENTER_TOP = 7,
    EWA_TEXT_RIGHT_TOP = 8,
} ewa_text_anchor;

/// How a text looks.
typedef struct ewa_text_style {
    double height_px; ///< size of the type, [4, 1000]: capitals are 0.7 of it high, small letters 0.5
    uint8_t rgba[4];  ///< sRGB, straight alpha
    double halo_px; ///< width of the rim around the letters, so that they can be read on any ground; 0: none
    uint8_t halo_rgba[4];
    ewa_text_anchor anchor;
} ewa_text_style;

/// Draws one line of text: UTF-8, ASCII, the letters of Latin-1 but for ð and þ, and the signs ° ² ³ · × ÷ ± µ μ – …;
/// another character, each control character and each byte that is no UTF-8 is an empty box. Letters stand on whole
/// pixels. Any thread.
EWA_API void ewa_draw_text(const ewa_canvas *canvas, const char *text, double x_px, double y_px,
                           const ewa_text_style *style);

/// Returns how far ewa_draw_text() goes to the right, whole pixels: the sum of its characters'. Any thread.
EWA_API double ewa_text_width_px(const char *text, double height_px);

/// One row of a legend.
typedef struct ewa_category {
    double value;
    const char *name; ///< UTF-8, borrowed; NULL: the number
    uint8_t srgb[3];
} ewa_category;

/// Colour of the furniture's text and lines; the other one is their rim.
typedef enum ewa_ink {
    EWA_INK_AUTO = 0, ///< that which differs more from the picture there; nothing counts as white
    EWA_INK_DARK = 1,
    EWA_INK_LIGHT = 2,
} ewa_ink;

/// What stands over a picture; nothing by default. Fill with ewa_furniture_options_init(). Texts are UTF-8, borrowed.
typedef struct ewa_furniture_options {
    size_t struct_size;
    const char *title; ///< top middle, shortened when too long; NULL: none
    bool axes;         ///< lower left: the world's axes x y z, as the camera is turned; default off
    bool scale_bar;    ///< lower right: a length of 1, 2 or 5 times a power of ten; default off
    bool color_bar;    ///< right: `colormap` over `range`, or the legend of `categories`; default off
    /// Distance along the view, in world units, at which the scale bar of a perspective camera holds, which it says;
    /// [0, 1e30]; 0 (default): such a camera has no scale bar. Orthographic cameras need none.
    double scale_depth_world;
    /// Unit of the world, such as ewa_scene_info.unit, behind the lengths of the scale bar; "m" turns into mm, cm and km. NULL:
    /// none.
    const char *unit;
    ewa_colormap colormap;
    double range[2];                ///< numbers of the first and the last colour; default 0, 1
    const char *color_label;        ///< above the colour bar; NULL: none
    const char *color_unit;         ///< behind it, in brackets; NULL: none
    const ewa_category *categories; ///< borrowed; in place of the continuous bar; NULL: none
    uint32_t category_count; ///< those that have no room are counted in a last row; [0, 65536]; default 0
    /// Pixels per point: text has 12 points, a title 18; [0, 100]; 0 (default): a 720th of the picture's
    /// smaller side, at least 0.84, which is text of 10 pixels.
    double pixel_scale;
    ewa_ink ink; ///< default EWA_INK_AUTO
} ewa_furniture_options;

EWA_API extern const ewa_option_table ewa_furniture_options_table;
EWA_API void ewa_furniture_options_init(ewa_furniture_options *options, size_t struct_size);

/// Draws furniture over a picture that `camera` has drawn, or a smaller or larger copy of it: the canvas's size counts,
/// and the camera's lens is scaled to it. What has no room is left out. `options` NULL: nothing is drawn. Allocates
/// nothing. Errors (the picture is unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_UNSUPPORTED.
EWA_API ewa_status ewa_furniture_draw(ewa_context *context, const ewa_camera *camera,
                                      const ewa_furniture_options *options, const ewa_canvas *canvas);

#ifdef __cplusplus
}
#endif
#endif
