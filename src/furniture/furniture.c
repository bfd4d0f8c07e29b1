// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Title, axes cross, scale bar, and where everything stands.
#include "base/base.h"
#include "base/options.h"
#include "furniture/decimal.h"
#include "furniture/layout.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_CATEGORIES = 65536 };

/// Sizes in points.
static const double ARM_PT = 30, LETTER_PT = 12, LETTER_OFF_PT = 9, AXIS_PT = 2;
static const double SCALE_MAX_PT = 180, SCALE_MIN_PT = 20, SCALE_THICK_PT = 2, SCALE_END_PT = 7,
                    SCALE_OFF_PT = 6;
/// Part of the picture's width that the scale bar takes at most.
static const double SCALE_PART = 0.25;
/// Opacity of an axis that points away.
enum { AWAY_ALPHA = 150 };

#define AT(member) offsetof(ewa_furniture_options, member)

static const double whole_range[] = {0, 1};

static const ewa_option option_rows[] = {
    {"axes", EWA_OPTION_BOOL, AT(axes),
     .help = "show how the world's axes x, y, z lie, in the lower left corner"},
    {"scale_bar", EWA_OPTION_BOOL, AT(scale_bar), .help = "show a length, in the lower right corner"},
    {"color_bar", EWA_OPTION_BOOL, AT(color_bar), .help = "show what the colours mean, on the right; at the bottom of a picture that is a quarter higher than wide"},
    {"scale_depth_world", EWA_OPTION_F64, AT(scale_depth_world), 0, 1e30, .unit = "world",
     .help = "distance along the view at which the scale bar of a perspective camera holds; 0: no such bar"},
    {"colormap", EWA_OPTION_CHOICE, AT(colormap),
     .words = "viridis|turbo|gray|plasma|inferno|magma|cividis|coolwarm",
     .help = "colours of the colour bar"},
    {"range", EWA_OPTION_F64, AT(range), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, .count = 2,
     .initials = whole_range, .help = "numbers of the first and the last colour"},
    {"category_count", EWA_OPTION_U32, AT(category_count), 0, MAX_CATEGORIES,
     .help = "rows of a legend in place of the colour bar"},
    {"pixel_scale", EWA_OPTION_F64, AT(pixel_scale), 0, 100, .unit = "px",
     .help =
         "pixels per point, of which text has 12; 0: a 720th of the picture's smaller side, at least 0.84"},
    {"ink", EWA_OPTION_CHOICE, AT(ink), .words = "auto|dark|light", .help = "colour of text and lines"},
};

const ewa_option_table ewa_furniture_options_table = EWA_OPTION_TABLE(ewa_furniture_options, option_rows);

void ewa_furniture_options_init(ewa_furniture_options *options, size_t struct_size) {
    ewa_options_init(&ewa_furniture_options_table, options, struct_size);
}

static void draw_title(ewa_layout *layout) {
    const double margin = EWA_MARGIN_PT * layout->point_px, height_px = EWA_TITLE_PT * layout->point_px;
    const double width = layout->canvas->width_px, top = floor(margin), bottom = top + height_px;
    char text[EWA_LAYOUT_TEXT_BYTES];
    if (bottom > layout->canvas->height_px / 2.0 ||
        !ewa_layout_shorten(layout->options->title, height_px, width - 2 * margin, text))
        return;
    const double half_px = ewa_text_width_px(text, height_px) / 2;
    const ewa_box box = {width / 2 - half_px, top, width / 2 + half_px, bottom};
    const ewa_inks inks = ewa_layout_inks(layout, &box);
    const ewa_text_style style = ewa_layout_style(layout, &inks, EWA_TITLE_PT, EWA_TEXT_CENTER_TOP);
    ewa_draw_text(layout->canvas, text, width / 2, top, &style);
    layout->room.top = bottom + margin / 2;
}

/// An axis of the world on the picture.
typedef struct axis {
    int index;
    double x, y, away; ///< of the unit vector: right, down, from the viewer
} axis;

/// The axes as the camera is turned, the one that points farthest away first.
static void sort_axes(const ewa_camera *camera, axis axes[3]) {
    const double *m = camera->world_to_camera;
    const double scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    for (int k = 0; k < 3; k++) {
        axis next = {k, m[k] / scale, m[4 + k] / scale, m[8 + k] / scale};
        int place = k;
        for (; place > 0 && axes[place - 1].away < next.away; place--) axes[place] = axes[place - 1];
        axes[place] = next;
    }
}

/// Which way from its end the letter of an axis stands: on, or, of one that is seen end on, away from the others.
static void letter_way(const axis axes[3], int which, double way[2]) {
    static const double SHORT = 0.3;
    way[0] = axes[which].x, way[1] = axes[which].y;
    if (way[0] * way[0] + way[1] * way[1] < SHORT * SHORT) {
        way[0] = way[1] = 0;
        for (int k = 0; k < 3; k++) {
            if (k == which) continue;
            way[0] -= axes[k].x;
            way[1] -= axes[k].y;
        }
    }
    const double length = sqrt(way[0] * way[0] + way[1] * way[1]);
    for (int i = 0; i < 2; i++) way[i] = length > 0 ? way[i] / length : 0;
}

/// Draws the cross; returns how far right it reaches, 0 without it.
static double draw_axes(ewa_layout *layout, const ewa_camera *camera) {
    static const uint8_t on_light[3][3] = {{215, 45, 40}, {30, 140, 45}, {50, 90, 230}};
    static const uint8_t on_dark[3][3] = {{255, 95, 85}, {95, 215, 95}, {120, 165, 255}};
    const double point = layout->point_px, margin = EWA_MARGIN_PT * point;
    const double reach = (ARM_PT + LETTER_OFF_PT + LETTER_PT / 2) * point;
    const double x0 = floor(margin + reach), y0 = floor(layout->canvas->height_px - margin - reach);
    if (x0 + reach > layout->canvas->width_px / 2.0 || y0 - reach < layout->canvas->height_px / 2.0) return 0;
    const ewa_inks inks = ewa_layout_inks(layout, &(ewa_box){x0 - reach, y0 - reach, x0 + reach, y0 + reach});
    const uint8_t(*colors)[3] = inks.ink[0] < inks.rim[0] ? on_light : on_dark;
    axis axes[3];
    sort_axes(camera, axes);
    for (int k = 0; k < 3; k++) {
        const axis *at = &axes[k];
        const uint8_t *color = colors[at->index];
        const double x = x0 + ARM_PT * point * at->x, y = y0 + ARM_PT * point * at->y;
        const uint8_t rgba[4] = {color[0], color[1], color[2], at->away > 0 ? AWAY_ALPHA : 255};
        ewa_draw_line(layout->canvas, x0, y0, x, y, (AXIS_PT + 2) * point, inks.rim);
        ewa_draw_line(layout->canvas, x0, y0, x, y, AXIS_PT * point, rgba);
    }
    for (int k = 0; k < 3; k++) {
        const axis *at = &axes[k];
        double way[2];
        letter_way(axes, k, way);
        const char letter[2] = {(char)('x' + at->index), 0};
        ewa_text_style style = ewa_layout_style(layout, &inks, LETTER_PT, EWA_TEXT_CENTER_MIDDLE);
        memcpy(style.rgba, colors[at->index], 3);
        // Small letters are lower than the capitals that are centred.
        ewa_draw_text(layout->canvas, letter, x0 + (ARM_PT * at->x + LETTER_OFF_PT * way[0]) * point,
                      y0 + (ARM_PT * at->y + LETTER_OFF_PT * way[1] - LETTER_PT / 10) * point, &style);
    }
    if (ewa_layout_is_tall(layout->canvas)) layout->room.bottom = fmin(layout->room.bottom, y0 - reach - margin / 2);
    return x0 + reach;
}

/// Pixels of the canvas per world unit; 0 when there is none.
static double find_scale(const ewa_layout *layout, const ewa_camera *camera) {
    const double *m = camera->world_to_camera, depth_world = layout->options->scale_depth_world;
    const double fx_px = camera->fx_px * layout->canvas->width_px / camera->width_px;
    if (camera->projection == EWA_ORTHOGRAPHIC) return fx_px * sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    return depth_world > 0 ? fx_px / depth_world : 0;
}

enum { LENGTH_BYTES = 128 };

/// Writes a length with its unit; metres as the word that suits them.
static void write_length(ewa_decimal length, const char *unit, char text[LENGTH_BYTES]) {
    static const struct {
        double minimum;
        const char *unit;
        int exponent;
    } words[] = {{1e3, "km", 3}, {1, "m", 0}, {1e-2, "cm", -2}, {1e-3, "mm", -3}, {0, "µm", -6}};
    if (unit && strcmp(unit, "m") == 0) {
        size_t k = 0;
        // A little less, because values are rounded.
        while (ewa_decimal_value(length) < words[k].minimum * (1 - 1e-9)) k++;
        length.exponent -= words[k].exponent;
        unit = words[k].unit;
    }
    char number[EWA_DECIMAL_BYTES];
    ewa_decimal_write(length, number);
    snprintf(text, LENGTH_BYTES, "%s%s%.24s", number, unit && unit[0] ? " " : "", unit ? unit : "");
}

/// Gives a length of few digits, for what is not exact.
static ewa_decimal round_length(double length) {
    ewa_decimal digit;
    if (!ewa_decimal_nice(length, &digit)) return (ewa_decimal){0, 0};
    const ewa_decimal unit = {1, digit.exponent - 1};
    return ewa_decimal_near(floor(length / ewa_decimal_value(unit) + 0.5) * ewa_decimal_value(unit));
}

/// Draws the scale bar right of `left_px`.
static void draw_scale_bar(ewa_layout *layout, const ewa_camera *camera, double left_px) {
    const double point = layout->point_px, margin = EWA_MARGIN_PT * point, text_px = EWA_TEXT_PT * point;
    const double per_world = find_scale(layout, camera);
    const double max_px = fmin(SCALE_PART * layout->canvas->width_px, SCALE_MAX_PT * point);
    ewa_decimal length;
    if (!(per_world > 0) || !ewa_decimal_nice(max_px / per_world, &length)) return;
    const double width = ewa_decimal_value(length) * per_world;
    char text[2 * LENGTH_BYTES + 8], away[LENGTH_BYTES];
    write_length(length, layout->options->unit, text);
    if (camera->projection == EWA_PERSPECTIVE) {
        write_length(round_length(layout->options->scale_depth_world), layout->options->unit, away);
        snprintf(text + strlen(text), LENGTH_BYTES + 8, " at %s", away);
    }
    const double wide = fmax(width, ewa_text_width_px(text, text_px));
    const double right = floor(layout->canvas->width_px - margin),
                 bottom = floor(layout->canvas->height_px - margin);
    const double end_px = floor(SCALE_END_PT * point), top = bottom - end_px - SCALE_OFF_PT * point - text_px;
    if (width < SCALE_MIN_PT * point || right - wide < left_px + margin ||
        top < layout->canvas->height_px / 2.0)
        return;
    const ewa_inks inks = ewa_layout_inks(layout, &(ewa_box){right - wide, top, right, bottom});
    const double thick = fmax(1, floor(SCALE_THICK_PT * point + 0.5)), rim = fmax(1, floor(point));
    const double middle = right - wide / 2, first = middle - width / 2, last = middle + width / 2;
    const ewa_box parts[] = {{first, bottom - thick, last, bottom},
                             {first, bottom - end_px, first + thick, bottom - thick},
                             {last - thick, bottom - end_px, last, bottom - thick}};
    ewa_draw_rectangle(layout->canvas, first - rim, bottom - end_px - rim, last + rim, bottom + rim,
                       inks.rim);
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++)
        ewa_draw_rectangle(layout->canvas, parts[k].left, parts[k].top, parts[k].right, parts[k].bottom,
                           inks.ink);
    const ewa_text_style style = ewa_layout_style(layout, &inks, EWA_TEXT_PT, EWA_TEXT_CENTER);
    ewa_draw_text(layout->canvas, text, middle, bottom - end_px - SCALE_OFF_PT * point, &style);
    layout->room.bottom = fmin(layout->room.bottom, top - margin / 2);
}

/// Takes the caller's options; what is wrong with several members together is checked here.
static ewa_status take_options(ewa_context *context, const ewa_furniture_options *given,
                               ewa_furniture_options *chosen) {
    ewa_furniture_options_init(chosen, sizeof *chosen);
    EWA_TRY(ewa_options_take(context, &ewa_furniture_options_table, given, chosen));
    if (chosen->category_count > 0 && !chosen->categories)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "ewa_furniture_options: category_count is %u, but there are no categories",
                        chosen->category_count);
    return EWA_OK;
}

ewa_status ewa_furniture_draw(ewa_context *context, const ewa_camera *camera,
                              const ewa_furniture_options *options, const ewa_canvas *canvas) {
    if (!camera || !canvas || !canvas->rgba8)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "ewa_furniture_draw: no camera, or no canvas");
    EWA_TRY(ewa_layout_check(context, canvas, "ewa_furniture_draw"));
    ewa_furniture_options chosen;
    EWA_TRY(take_options(context, options, &chosen));
    EWA_TRY(ewa_camera_check(context, camera));
    const double point = ewa_layout_point_px(canvas, chosen.pixel_scale);
    const double margin = floor(EWA_MARGIN_PT * point);
    ewa_layout layout = {.canvas = canvas,
                         .options = &chosen,
                         .point_px = point,
                         .room = {margin, margin, canvas->width_px - margin, canvas->height_px - margin}};
    if (chosen.title) draw_title(&layout);
    const double left_px = chosen.axes ? draw_axes(&layout, camera) : 0;
    if (chosen.scale_bar) draw_scale_bar(&layout, camera, left_px);
    if (chosen.color_bar && chosen.categories)
        ewa_legend_draw(&layout);
    else if (chosen.color_bar)
        ewa_color_bar_draw(&layout);
    return EWA_OK;
}
