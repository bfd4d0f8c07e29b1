// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What colours mean: a bar with ticks, or a legend of categories.
#include "furniture/decimal.h"
#include "furniture/layout.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Sizes in points: the bar, its ticks, the room beside it, rows of a legend and their squares.
static const double BAR_WIDTH_PT = 14, BAR_MIN_PT = 60, BAR_MAX_PT = 300, TICK_PT = 4, BESIDE_PT = 6;
static const double ROW_PT = 18, SQUARE_PT = 12, LABEL_ROW_PT = 20;
/// Parts of the picture: height of the bar, widest text.
static const double BAR_PART = 0.6, TEXT_PART = 0.4;
/// Points from a tick to the next one, at least.
static const double TICK_STEP_PT = 30;
/// Points between the texts of ticks that stand side by side, and from such a tick to the next one, at least.
static const double TEXT_GAP_PT = 10, ACROSS_STEP_PT = 44;

/// Points that numbers beside a bar mostly take, and that are left between the bar and what is shown.
static const double USUAL_TEXT_PT = 42, ASIDE_PT = 10;

void ewa_color_bar_room(uint32_t width_px, uint32_t height_px, uint32_t room_px[2]) {
    const ewa_canvas canvas = {NULL, width_px, height_px};
    const double point = ewa_layout_point_px(&canvas, 0), beside = TICK_PT + BESIDE_PT + USUAL_TEXT_PT;
    const bool tall = ewa_layout_is_tall(&canvas);
    const double right = (EWA_MARGIN_PT + beside + BAR_WIDTH_PT + ASIDE_PT) * point;
    const double bottom = (EWA_MARGIN_PT + EWA_TEXT_PT + TICK_PT + BESIDE_PT / 2 + BAR_WIDTH_PT + LABEL_ROW_PT + ASIDE_PT) * point;
    const bool fits = tall ? bottom < height_px / 2.0 && width_px > 2 * BAR_MIN_PT * point
                           : right < TEXT_PART * width_px && height_px * BAR_PART > BAR_MIN_PT * point;
    room_px[0] = fits && !tall ? (uint32_t)ceil(right) : 0;
    room_px[1] = fits && tall ? (uint32_t)ceil(bottom) : 0;
}

/// Fills a rectangle with a rim of a pixel or more around it, in the colour of the text.
static void draw_framed(const ewa_layout *layout, const ewa_inks *inks, const ewa_box *box) {
    const double rim = fmax(1, floor(layout->point_px)), halo = 2 * rim;
    ewa_draw_rectangle(layout->canvas, box->left - halo, box->top - halo, box->right + halo,
                       box->bottom + halo, inks->rim);
    ewa_draw_rectangle(layout->canvas, box->left - rim, box->top - rim, box->right + rim, box->bottom + rim,
                       inks->ink);
}

/// Label and unit in one text that fits; empty when there is none, or no room.
static void write_label(const ewa_layout *layout, double height_px, double max_px,
                        char label[EWA_LAYOUT_TEXT_BYTES]) {
    const ewa_furniture_options *options = layout->options;
    const char *name = options->color_label ? options->color_label : "";
    const char *unit = options->color_unit ? options->color_unit : "";
    char whole[EWA_LAYOUT_TEXT_BYTES];
    snprintf(whole, sizeof whole, unit[0] ? "%s%s[%s]" : "%s", name, name[0] ? " " : "", unit);
    if (!ewa_layout_shorten(whole, height_px, max_px, label)) label[0] = 0;
}

/// Draws the label above a block that begins at (left, top); no farther right than the room.
static void draw_label(const ewa_layout *layout, const ewa_inks *inks, const char *label, double left,
                       double top) {
    const ewa_text_style style = ewa_layout_style(layout, inks, EWA_TEXT_PT, EWA_TEXT_LEFT);
    const double over = left + ewa_text_width_px(label, style.height_px) - layout->room.right;
    ewa_draw_text(layout->canvas, label, left - fmax(over, 0), top - 0.7 * BESIDE_PT * layout->point_px - 2,
                  &style);
}

/// The texts of the ticks of a bar.
typedef struct bar_scale {
    ewa_ticks ticks;
    bool single; ///< both ends are one number
    double widest_px;
} bar_scale;

/// Writes tick `index`.
static void write_tick(const ewa_layout *layout, const bar_scale *scale, int64_t index,
                       char text[EWA_DECIMAL_BYTES]) {
    const ewa_decimal number =
        scale->single ? ewa_decimal_near(layout->options->range[0]) : ewa_ticks_at(&scale->ticks, index);
    ewa_decimal_write(number, text);
}

/// Finds the ticks of a bar, so many at most; false when there is none.
static bool find_scale(const ewa_layout *layout, uint32_t maximum, bar_scale *scale) {
    const double *range = layout->options->range;
    *scale = (bar_scale){.single = range[0] == range[1]};
    if (!scale->single &&
        !ewa_ticks_find(fmin(range[0], range[1]), fmax(range[0], range[1]), maximum, &scale->ticks))
        return false;
    for (int64_t k = scale->ticks.first; k <= scale->ticks.last; k++) {
        char text[EWA_DECIMAL_BYTES];
        write_tick(layout, scale, k, text);
        scale->widest_px = fmax(scale->widest_px, ewa_text_width_px(text, EWA_TEXT_PT * layout->point_px));
    }
    return true;
}

/// Where on the bar a tick is, from its first colour to its last.
static double share_of(const ewa_layout *layout, const bar_scale *scale, int64_t index) {
    const double *range = layout->options->range, extent = range[1] - range[0];
    if (scale->single) return 0.5;
    const double value = ewa_decimal_value(ewa_ticks_at(&scale->ticks, index));
    return isfinite(extent) ? (value - range[0]) / extent : (value / 2 - range[0] / 2) / (range[1] / 2 - range[0] / 2);
}

/// Draws the ticks right of a bar.
static void draw_ticks(const ewa_layout *layout, const ewa_inks *inks, const ewa_box *bar,
                       const bar_scale *scale) {
    const double point = layout->point_px;
    const ewa_text_style style = ewa_layout_style(layout, inks, EWA_TEXT_PT, EWA_TEXT_LEFT_MIDDLE);
    const double thick = fmax(1, floor(point));
    for (int64_t k = scale->ticks.first; k <= scale->ticks.last; k++) {
        char text[EWA_DECIMAL_BYTES];
        write_tick(layout, scale, k, text);
        const double y = bar->bottom - share_of(layout, scale, k) * (bar->bottom - bar->top);
        const double top = fmin(fmax(floor(y - thick / 2 + 0.5), bar->top - thick), bar->bottom);
        ewa_draw_rectangle(layout->canvas, bar->right, top, bar->right + floor(TICK_PT * point), top + thick,
                           inks->ink);
        ewa_draw_text(layout->canvas, text, bar->right + (TICK_PT + BESIDE_PT) * point, top + thick / 2,
                      &style);
    }
}

/// Fills a bar with its colours, from the left to the right, or from its lower end to the upper one.
static void fill_bar(const ewa_layout *layout, const ewa_box *bar, bool across) {
    const double *range = layout->options->range, length = across ? bar->right - bar->left : bar->bottom - bar->top;
    for (int j = 0; j < (int)length; j++) {
        uint8_t rgba[4] = {0, 0, 0, 255};
        ewa_colormap_color(layout->options->colormap, range[0] == range[1] ? 0.5 : (j + 0.5) / length, rgba);
        if (across)
            ewa_draw_rectangle(layout->canvas, bar->left + j, bar->top, bar->left + j + 1, bar->bottom, rgba);
        else
            ewa_draw_rectangle(layout->canvas, bar->left, bar->bottom - j - 1, bar->right, bar->bottom - j, rgba);
    }
}

/// Draws a bar that lies at the bottom, its ticks below it.
static void draw_across(const ewa_layout *layout) {
    const double point = layout->point_px, text_px = EWA_TEXT_PT * point, thick = fmax(1, floor(point));
    const ewa_box *room = &layout->room;
    const double label_px = layout->options->color_label || layout->options->color_unit ? LABEL_ROW_PT * point : 0;
    // Half a text stands beside each end, where there are ticks.
    bar_scale scale;
    double width = floor(fmin(room->right - room->left, BAR_MAX_PT * point));
    uint32_t maximum = (uint32_t)fmax(1, floor(width / (ACROSS_STEP_PT * point)));
    bool fits = find_scale(layout, maximum, &scale);
    while (fits && maximum > 1 && (scale.widest_px + TEXT_GAP_PT * point) * maximum > width) fits = find_scale(layout, --maximum, &scale);
    if (!fits) return;
    width = floor(fmin(width, room->right - room->left - scale.widest_px));
    const double left = floor((room->left + room->right - width) / 2), below = (TICK_PT + BESIDE_PT / 2) * point + text_px;
    const double bottom = floor(room->bottom - below), top = bottom - floor(BAR_WIDTH_PT * point);
    const ewa_box bar = {left, top, left + width, bottom};
    if (width < BAR_MIN_PT * point || top - label_px < layout->canvas->height_px / 2.0) return;
    const ewa_inks inks = ewa_layout_inks(layout, &(ewa_box){left, top - label_px, bar.right, room->bottom});
    draw_framed(layout, &inks, &bar);
    fill_bar(layout, &bar, true);
    const ewa_text_style style = ewa_layout_style(layout, &inks, EWA_TEXT_PT, EWA_TEXT_CENTER_TOP);
    for (int64_t k = scale.ticks.first; k <= scale.ticks.last; k++) {
        char text[EWA_DECIMAL_BYTES];
        write_tick(layout, &scale, k, text);
        const double x = left + share_of(layout, &scale, k) * width;
        const double from = fmin(fmax(floor(x - thick / 2 + 0.5), left - thick), bar.right);
        ewa_draw_rectangle(layout->canvas, from, bottom, from + thick, bottom + floor(TICK_PT * point), inks.ink);
        ewa_draw_text(layout->canvas, text, from + thick / 2, bottom + (TICK_PT + BESIDE_PT / 2) * point, &style);
    }
    char label[EWA_LAYOUT_TEXT_BYTES];
    write_label(layout, text_px, width, label);
    draw_label(layout, &inks, label, left, top);
}

void ewa_color_bar_draw(const ewa_layout *layout) {
    if (ewa_layout_is_tall(layout->canvas)) {
        draw_across(layout);
        return;
    }
    const double point = layout->point_px, text_px = EWA_TEXT_PT * point;
    const ewa_box *room = &layout->room;
    const double label_px =
        layout->options->color_label || layout->options->color_unit ? LABEL_ROW_PT * point : 0;
    // Half a text stands above and below the bar, where its ends have ticks.
    const double tall = room->bottom - room->top - label_px - text_px;
    const double height = floor(fmin(fmin(tall, BAR_PART * layout->canvas->height_px), BAR_MAX_PT * point));
    bar_scale scale;
    if (height < BAR_MIN_PT * point || !find_scale(layout, (uint32_t)floor(height / point / TICK_STEP_PT), &scale)) return;
    const double beside = (TICK_PT + BESIDE_PT) * point + scale.widest_px;
    const double right = floor(room->right - beside), left = right - floor(BAR_WIDTH_PT * point);
    const double top = floor(room->top + label_px + text_px / 2 + (tall - height) / 2);
    const ewa_box bar = {left, top, right, top + height};
    if (left < layout->canvas->width_px * (1 - TEXT_PART)) return;
    const ewa_inks inks =
        ewa_layout_inks(layout, &(ewa_box){left, top - label_px, room->right, top + height});
    draw_framed(layout, &inks, &bar);
    fill_bar(layout, &bar, false);
    draw_ticks(layout, &inks, &bar, &scale);
    char label[EWA_LAYOUT_TEXT_BYTES];
    write_label(layout, text_px, TEXT_PART * layout->canvas->width_px, label);
    draw_label(layout, &inks, label, left, top - text_px / 2);
}

/// Writes the text of row `index` of a legend of `row_count`, as far as it fits; the last one may count the rest.
static void write_row(const ewa_layout *layout, uint32_t index, uint32_t row_count, double max_px,
                      char text[EWA_LAYOUT_TEXT_BYTES]) {
    const ewa_furniture_options *options = layout->options;
    const ewa_category *category = &options->categories[index];
    char number[EWA_DECIMAL_BYTES];
    const char *name = category->name;
    if (index + 1 == row_count && row_count < options->category_count) {
        snprintf(number, sizeof number, "and %u more", options->category_count - index);
        name = number;
    } else if (!name) {
        if (isfinite(category->value))
            ewa_decimal_write(ewa_decimal_near(category->value), number);
        else
            snprintf(number, sizeof number, "no number");
        name = number;
    }
    if (!ewa_layout_shorten(name, EWA_TEXT_PT * layout->point_px, max_px, text)) text[0] = 0;
}

void ewa_legend_draw(const ewa_layout *layout) {
    const ewa_furniture_options *options = layout->options;
    const double point = layout->point_px, text_px = EWA_TEXT_PT * point, row_px = floor(ROW_PT * point);
    const ewa_box *room = &layout->room;
    const double label_px = options->color_label || options->color_unit ? LABEL_ROW_PT * point : 0;
    const double tall = room->bottom - room->top - label_px;
    if (options->category_count == 0 || tall < row_px) return;
    const double fitting = floor(tall / row_px);
    const uint32_t row_count =
        fitting < options->category_count ? (uint32_t)fitting : options->category_count;
    const double max_px = TEXT_PART * layout->canvas->width_px - (SQUARE_PT + BESIDE_PT) * point;
    char text[EWA_LAYOUT_TEXT_BYTES];
    double widest_px = 0;
    for (uint32_t i = 0; i < row_count; i++) {
        write_row(layout, i, row_count, max_px, text);
        widest_px = fmax(widest_px, ewa_text_width_px(text, text_px));
    }
    if (widest_px == 0) return;
    const double square_px = floor(SQUARE_PT * point);
    const double left = floor(room->right - widest_px - BESIDE_PT * point - square_px);
    const double over = tall - row_count * row_px; // room that is left
    const double top = floor(room->top + label_px + (ewa_layout_is_tall(layout->canvas) ? over : over / 2));
    const ewa_inks inks =
        ewa_layout_inks(layout, &(ewa_box){left, top - label_px, room->right, top + row_count * row_px});
    const ewa_text_style style = ewa_layout_style(layout, &inks, EWA_TEXT_PT, EWA_TEXT_LEFT_MIDDLE);
    for (uint32_t i = 0; i < row_count; i++) {
        const bool rest = i + 1 == row_count && row_count < options->category_count;
        const double y = top + i * row_px + floor((row_px - square_px) / 2);
        const ewa_box square = {left, y, left + square_px, y + square_px};
        const uint8_t *srgb = options->categories[i].srgb, rgba[4] = {srgb[0], srgb[1], srgb[2], 255};
        if (!rest) draw_framed(layout, &inks, &square);
        if (!rest)
            ewa_draw_rectangle(layout->canvas, square.left, square.top, square.right, square.bottom, rgba);
        write_row(layout, i, row_count, max_px, text);
        ewa_draw_text(layout->canvas, text, square.right + BESIDE_PT * point, y + square_px / 2, &style);
    }
    write_label(layout, text_px, TEXT_PART * layout->canvas->width_px, text);
    draw_label(layout, &inks, text, left, top);
}
