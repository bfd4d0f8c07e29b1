// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The graph of a profile: stations to the right, heights upward.
#include "base/base.h"
#include "base/options.h"
#include "ewa/profile.h"
#include "furniture/decimal.h"
#include "furniture/layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Sizes in points: between text and what it belongs to, of ticks, from one tick to the next at least, of dots.
static const double GAP_PT = 6, TICK_PT = 4, TICK_STEP_PT = 70, LEVEL_STEP_PT = 34, DOT_PT = 2;
/// Share of the heights' range that is left free above and below.
static const double HEADROOM = 0.04;

static const uint8_t WHITE[4] = {255, 255, 255, 255}, INK[4] = {16, 16, 16, 255}, GRID[4] = {225, 225, 225, 255};

#define AT(member) offsetof(ewa_profile_graph_options, member)

static const ewa_option option_rows[] = {
    {"exaggeration", EWA_OPTION_F64, AT(exaggeration), 0, 1e6,
     .help = "how many times larger heights are drawn than lengths; 0: so that the graph fills the picture"},
    {"point_size_px", EWA_OPTION_F64, AT(point_size_px), 0, 256, .unit = "px",
     .help = "diameter of dots; 0: two points of text"},
    {"pixel_scale", EWA_OPTION_F64, AT(pixel_scale), 0, 100, .unit = "px",
     .help = "pixels per point, of which text has 12; 0: a 720th of the picture's smaller side, at least 0.84"},
};

const ewa_option_table ewa_profile_graph_options_table = EWA_OPTION_TABLE(ewa_profile_graph_options, option_rows);

void ewa_profile_graph_options_init(ewa_profile_graph_options *options, size_t struct_size) {
    ewa_options_init(&ewa_profile_graph_options_table, options, struct_size);
}

/// A graph that is being drawn.
typedef struct graph {
    const ewa_canvas *canvas;
    const ewa_profile_graph_options *options;
    double point_px;
    ewa_box room;               ///< that is drawn in
    double station_px, height_px; ///< pixels of a unit
    double first_station, low_height; ///< at the left and lower side of the room
} graph;

static double x_of(const graph *g, double station) { return g->room.left + (station - g->first_station) * g->station_px; }

static double y_of(const graph *g, double height) { return g->room.bottom - (height - g->low_height) * g->height_px; }

static ewa_text_style style_of(const graph *g, ewa_text_anchor anchor) {
    return (ewa_text_style){
        .height_px = EWA_TEXT_PT * g->point_px, .rgba = {INK[0], INK[1], INK[2], INK[3]}, .anchor = anchor};
}

/// The lowest and the highest point; 0 and 1 where there are none.
static void find_range(const ewa_profile *profile, double range[2]) {
    const uint64_t count = ewa_cloud_point_count(profile->points);
    const double *heights = count ? ewa_cloud_find(profile->points, EWA_PROFILE_HEIGHT)->data : NULL;
    range[0] = count ? heights[0] : 0, range[1] = count ? heights[0] : 1;
    for (uint64_t i = 0; i < count; i++) {
        range[0] = fmin(range[0], heights[i]);
        range[1] = fmax(range[1], heights[i]);
    }
    // What is level has a unit of the line's length.
    const double extent = range[1] > range[0] ? range[1] - range[0] : profile->length_world * 0.1;
    const double middle = 0.5 * (range[0] + range[1]), half = (0.5 + HEADROOM) * extent;
    range[0] = middle - half, range[1] = middle + half;
}

/// Width of the widest number of a scale.
static double widest(const graph *g, const ewa_ticks *ticks) {
    double width_px = 0;
    for (int64_t k = ticks->first; k <= ticks->last; k++) {
        char text[EWA_DECIMAL_BYTES];
        ewa_decimal_write(ewa_ticks_at(ticks, k), text);
        width_px = fmax(width_px, ewa_text_width_px(text, EWA_TEXT_PT * g->point_px));
    }
    return width_px;
}

static uint32_t ticks_in(double pixels, double step_px) { return (uint32_t)fmax(1, floor(pixels / step_px)); }

/// Leaves room for the numbers, and chooses the scales.
static void lay_out(graph *g, const ewa_profile *profile, const double range[2]) {
    const double point = g->point_px, margin = floor(EWA_MARGIN_PT * point), row = (EWA_TEXT_PT + GAP_PT) * point;
    const double title = g->options->title ? (EWA_TITLE_PT + GAP_PT) * point : 0;
    // The number of a line at the top reaches half of it into the row of the names.
    g->room = (ewa_box){margin, floor(margin + title + row + 0.5 * EWA_TEXT_PT * point), floor(g->canvas->width_px - margin),
                        floor(g->canvas->height_px - margin - 2 * row - TICK_PT * point)};
    ewa_ticks levels;
    const double tall = fmax(g->room.bottom - g->room.top, 1);
    if (ewa_ticks_find(range[0], range[1], ticks_in(tall, LEVEL_STEP_PT * point), &levels))
        g->room.left = floor(margin + widest(g, &levels) + (TICK_PT + GAP_PT) * point);
    const double wide = fmax(g->room.right - g->room.left, 1), length = profile->length_world, extent = range[1] - range[0];
    g->station_px = wide / length;
    g->height_px = tall / extent;
    const double exaggeration = g->options->exaggeration;
    if (exaggeration > 0) { // both as large as the one that needs more room allows
        g->station_px = fmin(g->station_px, g->height_px / exaggeration);
        g->height_px = g->station_px * exaggeration;
    }
    g->first_station = 0.5 * (length - wide / g->station_px);
    g->low_height = 0.5 * (range[0] + range[1] - tall / g->height_px);
}

/// Draws the lines and numbers of both scales.
static void draw_scales(const graph *g) {
    const ewa_box *room = &g->room;
    const double point = g->point_px, thin = fmax(1, floor(point)), tick = floor(TICK_PT * point);
    const double last_station = g->first_station + (room->right - room->left) / g->station_px;
    const double high = g->low_height + (room->bottom - room->top) / g->height_px;
    const ewa_text_style below = style_of(g, EWA_TEXT_CENTER_TOP), beside = style_of(g, EWA_TEXT_RIGHT_MIDDLE);
    ewa_ticks ticks;
    char text[EWA_DECIMAL_BYTES];
    if (ewa_ticks_find(g->first_station, last_station, ticks_in(room->right - room->left, TICK_STEP_PT * point), &ticks))
        for (int64_t k = ticks.first; k <= ticks.last; k++) {
            const ewa_decimal number = ewa_ticks_at(&ticks, k);
            const double x = floor(x_of(g, ewa_decimal_value(number)));
            ewa_draw_rectangle(g->canvas, x, room->top, x + thin, room->bottom, GRID);
            ewa_draw_rectangle(g->canvas, x, room->bottom, x + thin, room->bottom + tick, INK);
            ewa_decimal_write(number, text);
            ewa_draw_text(g->canvas, text, x, room->bottom + tick + 0.5 * GAP_PT * point, &below);
        }
    if (ewa_ticks_find(g->low_height, high, ticks_in(room->bottom - room->top, LEVEL_STEP_PT * point), &ticks))
        for (int64_t k = ticks.first; k <= ticks.last; k++) {
            const ewa_decimal number = ewa_ticks_at(&ticks, k);
            const double y = floor(y_of(g, ewa_decimal_value(number)));
            ewa_draw_rectangle(g->canvas, room->left, y, room->right, y + thin, GRID);
            ewa_draw_rectangle(g->canvas, room->left - tick, y, room->left, y + thin, INK);
            ewa_decimal_write(number, text);
            ewa_draw_text(g->canvas, text, room->left - tick - 0.5 * GAP_PT * point, y, &beside);
        }
    ewa_draw_rectangle(g->canvas, room->left, room->bottom, room->right, room->bottom + thin, INK);
    ewa_draw_rectangle(g->canvas, room->left - thin, room->top, room->left, room->bottom + thin, INK);
}

/// Writes the names of the axes, the exaggeration and the title.
static void draw_names(const graph *g) {
    const double point = g->point_px, top = g->room.top - 0.5 * (GAP_PT + EWA_TEXT_PT) * point, middle = 0.5 * g->canvas->width_px;
    const char *unit = g->options->unit ? g->options->unit : "";
    const double width_px = g->canvas->width_px - 2 * EWA_MARGIN_PT * point;
    char text[EWA_LAYOUT_TEXT_BYTES], fitting[EWA_LAYOUT_TEXT_BYTES];
    const ewa_text_style left = style_of(g, EWA_TEXT_LEFT), center = style_of(g, EWA_TEXT_CENTER),
                         right = style_of(g, EWA_TEXT_RIGHT);
    snprintf(text, sizeof text, *unit ? "height [%.200s]" : "height", unit);
    ewa_draw_text(g->canvas, text, EWA_MARGIN_PT * point, top, &left);
    snprintf(text, sizeof text, *unit ? "station [%.200s]" : "station", unit);
    ewa_draw_text(g->canvas, text, middle, g->canvas->height_px - EWA_MARGIN_PT * point, &center);
    const double times = g->height_px / g->station_px;
    ewa_decimal rounded;
    if (fabs(times - 1) > 1e-6 && ewa_decimal_nice(times, &rounded)) {
        char number[EWA_DECIMAL_BYTES];
        rounded = (ewa_decimal){1, rounded.exponent - 2}; // to three digits
        rounded.digits = (int64_t)(times / ewa_decimal_value(rounded) + 0.5);
        ewa_decimal_write(ewa_decimal_near(ewa_decimal_value(rounded)), number);
        snprintf(text, sizeof text, "heights \xc3\x97 %s", number);
        ewa_draw_text(g->canvas, text, g->room.right, top, &right);
    }
    if (!g->options->title ||
        !ewa_layout_shorten(g->options->title, EWA_TITLE_PT * point, width_px, fitting))
        return;
    ewa_text_style title = style_of(g, EWA_TEXT_CENTER_TOP);
    title.height_px = EWA_TITLE_PT * point;
    ewa_draw_text(g->canvas, fitting, middle, EWA_MARGIN_PT * point, &title);
}

/// A point and how far it is from the line.
typedef struct dot {
    double away;
    uint64_t point;
} dot;

/// The farthest first, of equals as the profile has them.
static int compare_dots(const void *a, const void *b) {
    const dot *p = a, *q = b;
    if (p->away != q->away) return p->away > q->away ? -1 : 1;
    return p->point < q->point ? -1 : 1;
}

static void draw_dots(const graph *g, const ewa_profile *profile, const dot *dots, uint64_t count) {
    const double size_px = g->options->point_size_px > 0 ? g->options->point_size_px : DOT_PT * g->point_px;
    const double *stations = ewa_cloud_find(profile->points, EWA_PROFILE_STATION)->data,
                 *heights = ewa_cloud_find(profile->points, EWA_PROFILE_HEIGHT)->data;
    for (uint64_t k = 0; k < count; k++) {
        const uint64_t i = dots[k].point;
        const uint8_t *srgb = profile->srgb + 3 * i, rgba[4] = {srgb[0], srgb[1], srgb[2], 255};
        const double x = x_of(g, stations[i]), y = y_of(g, heights[i]);
        ewa_draw_line(g->canvas, x, y, x, y, size_px, rgba);
    }
}

ewa_status ewa_profile_draw(const ewa_profile *profile, const ewa_profile_graph_options *given, const ewa_canvas *canvas) {
    if (!profile || !profile->context || !profile->points || !canvas || !canvas->rgba8) return EWA_ERROR_ARGUMENT;
    ewa_context *context = profile->context;
    EWA_TRY(ewa_layout_check(context, canvas, "ewa_profile_draw"));
    ewa_profile_graph_options options;
    ewa_profile_graph_options_init(&options, sizeof options);
    EWA_TRY(ewa_options_take(context, &ewa_profile_graph_options_table, given, &options));
    const uint64_t count = ewa_cloud_point_count(profile->points);
    dot *dots = ewa_allocate(context, count, sizeof *dots);
    if (!dots) return EWA_ERROR_MEMORY;
    const double *offsets = count ? ewa_cloud_find(profile->points, EWA_PROFILE_OFFSET)->data : NULL;
    for (uint64_t i = 0; i < count; i++) dots[i] = (dot){fabs(offsets[i]), i};
    qsort(dots, count, sizeof *dots, compare_dots);
    if (!options.unit) options.unit = profile->unit;
    graph g = {.canvas = canvas, .options = &options, .point_px = ewa_layout_point_px(canvas, options.pixel_scale)};
    double range[2];
    find_range(profile, range);
    lay_out(&g, profile, range);
    ewa_draw_rectangle(canvas, 0, 0, canvas->width_px, canvas->height_px, WHITE);
    draw_scales(&g);
    if (count) draw_dots(&g, profile, dots, count);
    draw_names(&g);
    ewa_release(context, dots, count, sizeof *dots);
    return EWA_OK;
}
