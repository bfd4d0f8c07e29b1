// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lines and rectangles. Of + - * / and sqrt only: the same bytes on every machine.
#include "furniture/canvas.h"

#include <math.h>

static const double WIDEST_PX = 10000;

/// Distance of a point from the segment that begins at the origin and ends at (dx, dy), squared length `square`.
static double segment_distance(double x, double y, double dx, double dy, double square) {
    const double along = x * dx + y * dy;
    const double part = along <= 0 || square == 0 ? 0 : along >= square ? 1 : along / square;
    const double off_x = x - part * dx, off_y = y - part * dy;
    return sqrt(off_x * off_x + off_y * off_y);
}

/// Ends along x of the part of the segment from (x0, y0) by (dx, dy) whose y is within `reach` of `y`.
static void row_ends(double x0, double y0, double dx, double dy, double y, double reach, double ends[2]) {
    double first = 0, last = 1;
    if (dy != 0) {
        const double low = (y - reach - y0) / dy, high = (y + reach - y0) / dy;
        first = fmin(fmax(fmin(low, high), 0), 1);
        last = fmin(fmax(fmax(low, high), 0), 1);
    }
    const double a = x0 + first * dx, b = x0 + last * dx;
    ends[0] = fmin(a, b) - reach;
    ends[1] = fmax(a, b) + reach;
}

void ewa_draw_line(const ewa_canvas *canvas, double x0_px, double y0_px, double x1_px, double y1_px,
                   double width_px, const uint8_t rgba[4]) {
    if (!ewa_canvas_near(x0_px, y0_px) || !ewa_canvas_near(x1_px, y1_px)) return;
    if (!(width_px > 0 && width_px <= WIDEST_PX)) return;
    const ewa_paint paint = ewa_paint_make(rgba);
    const double dx = x1_px - x0_px, dy = y1_px - y0_px, square = dx * dx + dy * dy;
    const double radius = width_px / 2, reach = radius + 1;
    const int top = ewa_canvas_clip(fmin(y0_px, y1_px) - reach, canvas->height_px);
    const int bottom = ewa_canvas_clip(fmax(y0_px, y1_px) + reach + 1, canvas->height_px);
    for (int j = top; j < bottom; j++) {
        double ends[2];
        row_ends(x0_px, y0_px, dx, dy, j + 0.5, reach, ends);
        const int left = ewa_canvas_clip(ends[0], canvas->width_px);
        const int right = ewa_canvas_clip(ends[1] + 1, canvas->width_px);
        uint8_t *pixel = canvas->rgba8 + 4 * ((size_t)j * canvas->width_px + (size_t)left);
        for (int i = left; i < right; i++, pixel += 4) {
            const double distance = segment_distance(i + 0.5 - x0_px, j + 0.5 - y0_px, dx, dy, square);
            ewa_paint_pixel(pixel, &paint, (float)ewa_stripe_coverage(distance, radius));
        }
    }
}

void ewa_draw_rectangle(const ewa_canvas *canvas, double x0_px, double y0_px, double x1_px, double y1_px,
                        const uint8_t rgba[4]) {
    if (!ewa_canvas_near(x0_px, y0_px) || !ewa_canvas_near(x1_px, y1_px)) return;
    const ewa_paint paint = ewa_paint_make(rgba);
    const double left = fmin(x0_px, x1_px), right = fmax(x0_px, x1_px);
    const double top = fmin(y0_px, y1_px), bottom = fmax(y0_px, y1_px);
    const int first = ewa_canvas_clip(left, canvas->width_px),
              end = ewa_canvas_clip(right + 1, canvas->width_px);
    const int rows_end = ewa_canvas_clip(bottom + 1, canvas->height_px);
    for (int j = ewa_canvas_clip(top, canvas->height_px); j < rows_end; j++) {
        const double tall = fmax(fmin(bottom, j + 1) - fmax(top, j), 0);
        uint8_t *pixel = canvas->rgba8 + 4 * ((size_t)j * canvas->width_px + (size_t)first);
        for (int i = first; i < end; i++, pixel += 4) {
            const double wide = fmin(right, i + 1) - fmax(left, i);
            ewa_paint_pixel(pixel, &paint, (float)(wide * tall));
        }
    }
}
