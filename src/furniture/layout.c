// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Room, sizes, ink.
#include "furniture/layout.h"
#include "base/base.h"
#include "furniture/canvas.h"
#include "furniture/font.h"

#include <math.h>
#include <string.h>

/// Luminance between the grounds of light ink and of dark ink: a middle grey to the eye.
static const double MIDDLE_LUMINANCE = 0.18;
/// Points of a picture's smaller side, and pixels per point at least, where no one says how large a point is.
static const double SIDE_PT = 720, MIN_POINT_PX = 0.84;
/// Pictures that are so many times as high as wide are tall.
static const double TALL = 1.25;
/// Width of the rim of letters, as part of their height.
static const double RIM_PART = 0.13;

/// Pixels of a row or column of a box that are looked at, at most about.
enum { LOOKS = 64 };

ewa_status ewa_layout_check(ewa_context *context, const ewa_canvas *canvas, const char *caller) {
    enum { MAX_SIDE_PX = 65536 };
    const uint32_t width = canvas->width_px, height = canvas->height_px;
    if (width >= 1 && height >= 1 && width <= MAX_SIDE_PX && height <= MAX_SIDE_PX) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: the canvas has %u x %u pixels, allowed are 1 to %d", caller, width, height,
                    MAX_SIDE_PX);
}

bool ewa_layout_is_tall(const ewa_canvas *canvas) { return canvas->height_px > TALL * canvas->width_px; }

double ewa_layout_point_px(const ewa_canvas *canvas, double pixel_scale) {
    const double smaller = canvas->width_px < canvas->height_px ? canvas->width_px : canvas->height_px;
    return pixel_scale > 0 ? pixel_scale : fmax(smaller / SIDE_PT, MIN_POINT_PX);
}

static int clip_side(double px, uint32_t size_px) { return ewa_canvas_clip(px, size_px); }

/// Mean luminance of a box; where nothing is, white.
static double box_luminance(const ewa_canvas *canvas, const ewa_box *box) {
    const int left = clip_side(box->left, canvas->width_px), right = clip_side(box->right, canvas->width_px);
    const int top = clip_side(box->top, canvas->height_px),
              bottom = clip_side(box->bottom, canvas->height_px);
    const int step_x = 1 + (right - left) / LOOKS, step_y = 1 + (bottom - top) / LOOKS;
    double sum = 0, count = 0;
    for (int j = top; j < bottom; j += step_y) {
        for (int i = left; i < right; i += step_x) {
            const uint8_t *pixel = canvas->rgba8 + 4 * ((size_t)j * canvas->width_px + (size_t)i);
            const double alpha = pixel[3] / 255.0;
            const double y = 0.2126 * (double)ewa_srgb_decoded[pixel[0]] +
                             0.7152 * (double)ewa_srgb_decoded[pixel[1]] +
                             0.0722 * (double)ewa_srgb_decoded[pixel[2]];
            sum += alpha * y + (1 - alpha);
            count++;
        }
    }
    return count > 0 ? sum / count : 1;
}

ewa_inks ewa_layout_inks(const ewa_layout *layout, const ewa_box *box) {
    const ewa_ink wanted = layout->options->ink;
    const bool dark = wanted == EWA_INK_DARK ||
                      (wanted == EWA_INK_AUTO && box_luminance(layout->canvas, box) > MIDDLE_LUMINANCE);
    const ewa_inks on_light = {{16, 16, 16, 255}, {255, 255, 255, 220}};
    const ewa_inks on_dark = {{255, 255, 255, 255}, {0, 0, 0, 220}};
    return dark ? on_light : on_dark;
}

ewa_text_style ewa_layout_style(const ewa_layout *layout, const ewa_inks *inks, double points,
                                ewa_text_anchor anchor) {
    const double height_px = points * layout->point_px;
    ewa_text_style style = {.height_px = height_px, .halo_px = RIM_PART * height_px, .anchor = anchor};
    memcpy(style.rgba, inks->ink, 4);
    memcpy(style.halo_rgba, inks->rim, 4);
    return style;
}

bool ewa_layout_shorten(const char *text, double height_px, double max_px,
                        char fitting[EWA_LAYOUT_TEXT_BYTES]) {
    static const char dots[] = "...";
    const double dots_px = ewa_text_width_px(dots, height_px);
    // The longest beginning that leaves room for the dots, and whether all of it needs none.
    const char *at = text, *cut = text;
    double width_px = 0;
    while (*at && width_px <= max_px && at - text < EWA_LAYOUT_TEXT_BYTES - 8) {
        char one[5] = "";
        const char *next = at;
        ewa_font_next(&next);
        memcpy(one, at, (size_t)(next - at));
        width_px += ewa_text_width_px(one, height_px);
        at = next;
        if (width_px + dots_px <= max_px) cut = at;
    }
    if (!*at && width_px <= max_px) {
        memcpy(fitting, text, (size_t)(at - text) + 1);
        return at > text;
    }
    memcpy(fitting, text, (size_t)(cut - text));
    memcpy(fitting + (cut - text), dots, sizeof dots);
    return cut > text;
}
