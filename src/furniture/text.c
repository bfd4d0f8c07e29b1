// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Text: strokes of letters, laid onto whole pixels, as distances from their middle lines.
//
// Each pixel keeps its distance from the nearest stroke, from which the letter and the rim around it follow; so strokes
// that cross, and rims of neighbours, do not add up. Of + - * / and sqrt only: the same bytes on every machine.
#include "furniture/canvas.h"
#include "furniture/font.h"

#include <math.h>
#include <string.h>

/// Limits of ewa_text_style.height_px.
static const double MIN_HEIGHT_PX = 4, MAX_HEIGHT_PX = 1000;
/// Width of a stroke, and the room between two letters, as parts of the height.
static const double STROKE_PART = 0.085, GAP_PART = 0.13;
/// Thinner strokes have whole pixels: part of a pixel more would make them grey rather than thicker.
static const double WHOLE_STROKES_PX = 2.5;
/// How much a dot is thicker than a stroke, if that is not a single pixel, as part of its radius.
static const double DOT_PART = 0.4;
/// Height of capitals, outside, as part of the type's; and of their middle lines on the letters' grid.
static const double CAPITAL_PART = 0.7, CAPITAL_GRID = 12;
/// What reaches farthest beyond baseline and capitals, as parts of the height.
static const double BELOW_PART = 0.35, ABOVE_PART = 1;
/// How far marks may reach beyond the sides of their letters.
static const double MARK_PART = 0.15;
/// Widest rim, as part of the height.
static const double MAX_HALO_PART = 1;

enum { TILE = 64, ARC_STEPS = 8 };

/// Sizes of a type on the pixels.
typedef struct type_size {
    double grid_px;   ///< of a step of the letters' grid
    double radius_px; ///< half a stroke
    double half_px;   ///< the same of whole pixels: the way from a letter's edge to the middle of its stroke
    int gap_px;
} type_size;

/// Rounds a number that is not large.
static int nearest(double number) { return (int)floor(number + 0.5); }

/// False for a height that there is no type of.
static bool find_size(double height_px, type_size *size) {
    if (!(height_px >= MIN_HEIGHT_PX && height_px <= MAX_HEIGHT_PX)) return false;
    const double thick_px = STROKE_PART * height_px;
    const double stroke_px = thick_px < WHOLE_STROKES_PX ? fmax(1, nearest(thick_px)) : thick_px;
    *size = (type_size){.grid_px = (CAPITAL_PART * height_px - stroke_px) / CAPITAL_GRID,
                        .radius_px = stroke_px / 2,
                        .half_px = nearest(stroke_px) / 2.0,
                        .gap_px = nearest(fmax(1, GAP_PART * height_px))};
    return true;
}

/// Width between the middles of a letter's outer strokes: whole pixels, an even number about a stem.
static int inner_px(const type_size *size, const ewa_glyph *glyph) {
    const double wide_px = glyph->width * size->grid_px;
    return glyph->has_stem ? 2 * nearest(wide_px / 2) : nearest(wide_px);
}

/// How far a letter moves the next one.
static int advance_px(const type_size *size, const ewa_glyph *glyph) {
    return inner_px(size, glyph) + nearest(2 * size->half_px) + size->gap_px;
}

double ewa_text_width_px(const char *text, double height_px) {
    type_size size;
    if (!text || !find_size(height_px, &size)) return 0;
    double width_px = 0;
    for (uint32_t code; (code = ewa_font_next(&text));) width_px += advance_px(&size, ewa_font_glyph(code));
    return width_px;
}

/// Squared distances of a square of pixels from the nearest stroke.
typedef struct tile {
    int x, y; ///< its first pixel
    double reach_px;
    float squares[TILE][TILE];
} tile;

typedef struct point {
    double x, y;
} point;

static int clip_tile(double px) { return px > 0 ? (px < TILE ? (int)px : TILE) : 0; }

/// Takes a dot that is `more_px` thicker than a stroke into the distances.
static void add_dot(tile *to, point at, double more_px) {
    const double x0 = at.x - to->x, y0 = at.y - to->y, reach = to->reach_px + more_px;
    const int left = clip_tile(x0 - reach), right = clip_tile(x0 + reach + 1);
    const int top = clip_tile(y0 - reach), bottom = clip_tile(y0 + reach + 1);
    for (int j = top; j < bottom; j++) {
        for (int i = left; i < right; i++) {
            const double x = i + 0.5 - x0, y = j + 0.5 - y0;
            const double distance = fmax(sqrt(x * x + y * y) - more_px, 0);
            to->squares[j][i] = fminf(to->squares[j][i], (float)(distance * distance));
        }
    }
}

/// Takes the line from `a` to `b` into the distances.
static void add_line(tile *to, point a, point b) {
    const double x0 = a.x - to->x, y0 = a.y - to->y, dx = b.x - a.x, dy = b.y - a.y;
    const double square = dx * dx + dy * dy, reach = to->reach_px;
    const int left = clip_tile(fmin(x0, x0 + dx) - reach), right = clip_tile(fmax(x0, x0 + dx) + reach + 1);
    const int top = clip_tile(fmin(y0, y0 + dy) - reach), bottom = clip_tile(fmax(y0, y0 + dy) + reach + 1);
    const double scale = square > 0 ? 1 / square : 0;
    for (int j = top; j < bottom; j++) {
        const double y = j + 0.5 - y0;
        for (int i = left; i < right; i++) {
            const double x = i + 0.5 - x0;
            const double along = (x * dx + y * dy) * scale;
            const double part = along > 0 ? (along < 1 ? along : 1) : 0;
            const double off_x = x - part * dx, off_y = y - part * dy;
            const float near = (float)(off_x * off_x + off_y * off_y);
            if (near < to->squares[j][i]) to->squares[j][i] = near;
        }
    }
}

/// Takes a quarter of an ellipse from `a` to `b` about `center` into the distances.
static void add_arc(tile *to, point a, point b, point center) {
    // cos(k 90 / ARC_STEPS degrees); sines are the same backwards.
    static const double cosines[ARC_STEPS + 1] = {1,
                                                  0.98078528040323043,
                                                  0.92387953251128674,
                                                  0.83146961230254524,
                                                  0.70710678118654757,
                                                  0.55557023301960218,
                                                  0.38268343236508977,
                                                  0.19509032201612825,
                                                  0};
    point last = a;
    for (int k = 1; k <= ARC_STEPS; k++) {
        const double cosine = cosines[k], sine = cosines[ARC_STEPS - k];
        const point next = {center.x + cosine * (a.x - center.x) + sine * (b.x - center.x),
                            center.y + cosine * (a.y - center.y) + sine * (b.y - center.y)};
        add_line(to, last, next);
        last = next;
    }
}

/// Takes a parabola from `a` to `b`, tangents through `control`, into the distances.
static void add_parabola(tile *to, point a, point control, point b) {
    point last = a;
    for (int k = 1; k <= ARC_STEPS; k++) {
        const double t = (double)k / ARC_STEPS, s = 1 - t;
        const point next = {s * s * a.x + 2 * s * t * control.x + t * t * b.x,
                            s * s * a.y + 2 * s * t * control.y + t * t * b.y};
        add_line(to, last, next);
        last = next;
    }
}

/// Where a letter stands.
typedef struct letter {
    const type_size *size;
    const ewa_glyph *glyph;
    double left_px, baseline_px;
} letter;

static int digit(char character) { return character <= '9' ? character - '0' : character - 'a' + 10; }

/// The pixel coordinate of a point of the path; on whole pixels, along x, along y, if it is to be.
static point place(const letter *at, const char *digits, bool whole_x, bool whole_y) {
    const type_size *size = at->size;
    const int u = digit(digits[0]), v = digit(digits[1]) - 4, inner = inner_px(size, at->glyph);
    // From the nearer side, so that what is symmetric stays so.
    const int side = 2 * u > at->glyph->width ? at->glyph->width - u : u;
    const double stretched = at->glyph->width ? (double)inner / at->glyph->width : 0;
    double x = whole_x && 2 * u != at->glyph->width ? nearest(side * size->grid_px) : side * stretched;
    if (2 * u > at->glyph->width) x = inner - x;
    const double y = whole_y ? nearest(v * size->grid_px) : v * size->grid_px;
    return (point){at->left_px + size->half_px + x, at->baseline_px - size->half_px - y};
}

/// Takes the strokes of a letter into the distances. Where a curve runs along an axis its ends need not lie on whole
/// pixels along that axis; nor need those of parabolas.
static void add_letter(tile *to, const letter *at) {
    point last = {0, 0};
    char joint = ' ';
    for (const char *c = at->glyph->path; *c;) {
        joint = *c == ' ' || c == at->glyph->path ? ' ' : strchr("-!(", *c) ? *c : '+';
        if (strchr(" -!(", *c)) c++;
        point control = {0, 0};
        if (joint == '(') {
            control = place(at, c, false, false);
            c += 2;
        }
        const char after = c[2];
        const bool free_x = joint == '!' || after == '-' || joint == '(' || after == '(';
        const bool free_y = joint == '-' || after == '!' || joint == '(' || after == '(';
        const point next = place(at, c, !free_x, !free_y);
        c += 2;
        if (joint == ' ' && (*c == ' ' || !*c))
            add_dot(to, next, at->size->radius_px >= 1 ? DOT_PART * at->size->radius_px : 0);
        else if (joint == '-')
            add_arc(to, last, next, (point){last.x, next.y});
        else if (joint == '!')
            add_arc(to, last, next, (point){next.x, last.y});
        else if (joint == '(')
            add_parabola(to, last, control, next);
        else if (joint == '+')
            add_line(to, last, next);
        last = next;
    }
}

/// Paints the part of a tile that is on the canvas.
static void paint_tile(const ewa_canvas *canvas, const tile *from, const type_size *size,
                       const ewa_text_style *style, double halo_px) {
    const ewa_paint ink = ewa_paint_make(style->rgba), halo = ewa_paint_make(style->halo_rgba);
    for (int j = 0; j < TILE; j++) {
        if (from->y + j < 0 || from->y + j >= (int64_t)canvas->height_px) continue;
        for (int i = 0; i < TILE; i++) {
            const float square = from->squares[j][i];
            if (from->x + i < 0 || from->x + i >= (int64_t)canvas->width_px || square == INFINITY) continue;
            uint8_t *pixel =
                canvas->rgba8 + 4 * ((size_t)(from->y + j) * canvas->width_px + (size_t)(from->x + i));
            const double distance = sqrt((double)square);
            if (halo_px > 0)
                ewa_paint_pixel(pixel, &halo,
                                (float)ewa_stripe_coverage(distance, size->radius_px + halo_px));
            ewa_paint_pixel(pixel, &ink, (float)ewa_stripe_coverage(distance, size->radius_px));
        }
    }
}

/// Takes a character's letter, which stands at `pen_px`, and its mark into the distances.
static void add_character(tile *to, const type_size *size, uint32_t code, double pen_px, int baseline_px) {
    const ewa_glyph *glyph = ewa_font_glyph(code);
    bool raised = false;
    const ewa_glyph *mark = ewa_font_mark(code, &raised);
    add_letter(to, &(letter){size, glyph, pen_px, baseline_px});
    if (!mark) return;
    const double offset_px = floor((inner_px(size, glyph) - inner_px(size, mark)) / 2.0);
    const int lift_px = raised ? nearest(EWA_FONT_RAISE * size->grid_px) : 0;
    add_letter(to, &(letter){size, mark, pen_px + offset_px, baseline_px - lift_px});
}

/// Draws what of a text, whose first letter stands at (left, baseline), lies in a tile.
static void draw_tile(const ewa_canvas *canvas, tile *work, const char *text, const type_size *size,
                      int left_px, int baseline_px, const ewa_text_style *style, double halo_px) {
    for (int j = 0; j < TILE; j++)
        for (int i = 0; i < TILE; i++) work->squares[j][i] = INFINITY;
    bool any = false;
    double pen_px = left_px;
    const double reach_px = work->reach_px + MARK_PART * style->height_px;
    for (uint32_t code; (code = ewa_font_next(&text)) && pen_px - reach_px < work->x + TILE;) {
        const double next_px = pen_px + advance_px(size, ewa_font_glyph(code));
        if (next_px + reach_px > work->x) {
            add_character(work, size, code, pen_px, baseline_px);
            any = true;
        }
        pen_px = next_px;
    }
    if (any) paint_tile(canvas, work, size, style, halo_px);
}

void ewa_draw_text(const ewa_canvas *canvas, const char *text, double x_px, double y_px,
                   const ewa_text_style *style) {
    type_size size;
    if (!text || !find_size(style->height_px, &size) || !ewa_canvas_near(x_px, y_px)) return;
    const double height_px = style->height_px, capital_px = nearest(CAPITAL_PART * height_px);
    const double width_px = ewa_text_width_px(text, height_px) - size.gap_px;
    if (!(width_px > 0 && width_px < EWA_CANVAS_FARTHEST_PX)) return;
    const int across = (int)style->anchor % 3, down = (int)style->anchor / 3;
    const int left_px = nearest(x_px - width_px * across / 2);
    const int baseline_px = nearest(y_px + (down == 1 ? capital_px / 2 : down == 2 ? capital_px : 0));
    const double halo_px = style->halo_px > 0 ? fmin(style->halo_px, MAX_HALO_PART * height_px) : 0;
    tile work = {.reach_px = size.radius_px + halo_px + 1};
    const int top = ewa_canvas_clip(baseline_px - ABOVE_PART * height_px - work.reach_px, canvas->height_px);
    const int bottom =
        ewa_canvas_clip(baseline_px + BELOW_PART * height_px + work.reach_px, canvas->height_px);
    const double sides_px = work.reach_px + MARK_PART * height_px;
    const int first = ewa_canvas_clip(left_px - sides_px, canvas->width_px);
    const int end = ewa_canvas_clip(left_px + width_px + sides_px + 1, canvas->width_px);
    for (work.y = top; work.y < bottom; work.y += TILE)
        for (work.x = first; work.x < end; work.x += TILE)
            draw_tile(canvas, &work, text, &size, left_px, baseline_px, style, halo_px);
}
