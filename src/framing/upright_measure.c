// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is measured of some points to tell how they stand. Everything is counts, smallest and largest numbers,
// so that the order of the points does not matter.
#include "framing/upright_measure.h"
#include "framing/widen.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum {
    GRID = 64,           // cells along the longer side
    POINTS_PER_CELL = 8, // on average, at least
    FEW_POINTS = 100,    // less are no range image
    HEIGHTS = 4096,      // classes of heights
    STRIPS = 256,        // of a convex hull
    CORNERS = 2 * STRIPS + 2,
    MARKS = 1 << 17, // classes of slopes
    MIRROR_GRID = 60,    // cells along the longer side of what is mirrored, at most
    MIRROR_POINTS = 16, // points per square of a cell, at least
};

/// A cell holds two surfaces when its points are so many cells apart: steeper ones are rare.
static const double LAYER_CELLS = 3;

/// Share of the points that may lie below the base, and thickness of the base over the object's size.
static const double BELOW_SHARE = 0.002, BASE_THICKNESS = 0.02;

/// How far from the rim of the base the middle has to be, over the size of the footprint.
static const double STABLE_MARGIN = 0.05;

/// The class of `count` that a place in classes is in. Extents may overflow or vanish, and places be none.
static size_t class_of(double place, size_t count) {
    if (!(place >= 0)) return 0;
    return place < (double)count ? (size_t)place : count - 1;
}

void ewa_measure_extent(point_cloud_sample *points) {
    for (int c = 0; c < 3; c++) {
        points->low[c] = INFINITY;
        points->high[c] = -INFINITY;
    }
    for (size_t i = 0; i < points->count; i++) {
        for (int c = 0; c < 3; c++) widen(&points->low[c], &points->high[c], points->offsets[i][c]);
    }
    for (int c = 0; c < 3; c++) points->extent[c] = points->count ? points->high[c] - points->low[c] : 0;
}

/// Smallest and largest depth of each cell of a picture.
typedef struct depth_grid {
    double low[2], cell; ///< of the picture's corner; side of a cell
    int sides;           ///< cells along the longer side
    double nearest[GRID][GRID], farthest[GRID][GRID];
    int counts[GRID][GRID];
} depth_grid;

/// Makes an empty grid over a rectangle, coarse enough for so many points.
static void start_grid(depth_grid *grid, const double low[2], const double high[2], size_t count) {
    const double longer = fmax(high[0] - low[0], high[1] - low[1]);
    const double shorter = fmin(high[0] - low[0], high[1] - low[1]);
    const double narrow = fmax(shorter, 1e-3 * longer) / longer;
    grid->sides = (int)fmin(GRID, fmax(4, sqrt((double)count / POINTS_PER_CELL / narrow)));
    grid->cell = longer / grid->sides;
    memcpy(grid->low, low, sizeof grid->low);
    for (int y = 0; y < GRID; y++) {
        for (int x = 0; x < GRID; x++) {
            grid->nearest[y][x] = INFINITY;
            grid->farthest[y][x] = -INFINITY;
            grid->counts[y][x] = 0;
        }
    }
}

static size_t cell_of(const depth_grid *grid, int axis, double place) {
    return class_of((place - grid->low[axis]) / grid->cell, (size_t)grid->sides);
}

static void put_in_grid(depth_grid *grid, double x, double y, double depth) {
    const size_t column = cell_of(grid, 0, x), row = cell_of(grid, 1, y);
    widen(&grid->nearest[row][column], &grid->farthest[row][column], depth);
    grid->counts[row][column]++;
}

/// Share of the cells with two points or more whose depths differ by over LAYER_CELLS cells; `relative`: over
/// that share of the nearest depth, as cells are slopes.
static double layered_share(const depth_grid *grid, bool relative) {
    int several = 0, layered = 0;
    for (int y = 0; y < grid->sides; y++) {
        for (int x = 0; x < grid->sides; x++) {
            if (grid->counts[y][x] < 2) continue;
            const double unit = relative ? grid->nearest[y][x] : 1;
            several++;
            layered += grid->farthest[y][x] - grid->nearest[y][x] > LAYER_CELLS * grid->cell * unit;
        }
    }
    return several ? (double)layered / several : 0;
}

double ewa_measure_layers(const point_cloud_sample *points, int axis) {
    const int x = axis == 0 ? 1 : 0, y = axis == 2 ? 1 : 2;
    const double low[2] = {points->low[x], points->low[y]}, high[2] = {points->high[x], points->high[y]};
    if (!(fmax(high[0] - low[0], high[1] - low[1]) > 0)) return 0;
    depth_grid grid;
    start_grid(&grid, low, high, points->count);
    for (size_t i = 0; i < points->count; i++) {
        const double *p = points->offsets[i];
        put_in_grid(&grid, p[x], p[y], p[axis]);
    }
    return layered_share(&grid, false);
}

double ewa_measure_face(const point_cloud_sample *points, int axis, bool high) {
    const int x = axis == 0 ? 1 : 0, y = axis == 2 ? 1 : 2;
    const double low[2] = {points->low[x], points->low[y]}, ends[2] = {points->high[x], points->high[y]};
    const double size = fmax(points->extent[axis], fmax(ends[0] - low[0], ends[1] - low[1]));
    if (!(fmax(ends[0] - low[0], ends[1] - low[1]) > 0)) return 0;
    depth_grid grid;
    start_grid(&grid, low, ends, points->count);
    for (size_t i = 0; i < points->count; i++) {
        const double *p = points->offsets[i];
        put_in_grid(&grid, p[x], p[y], high ? points->high[axis] - p[axis] : p[axis] - points->low[axis]);
    }
    int occupied = 0, flat = 0;
    for (int row = 0; row < grid.sides; row++) {
        for (int column = 0; column < grid.sides; column++) {
            occupied += grid.counts[row][column] > 0;
            flat += grid.counts[row][column] > 0 && grid.nearest[row][column] <= BASE_THICKNESS * size;
        }
    }
    return occupied ? (double)flat / occupied : 0;
}

double ewa_measure_inside(const point_cloud_sample *points, const float (*normals)[3], int axis, bool high) {
    const int x = axis == 0 ? 1 : 0, y = axis == 2 ? 1 : 2;
    const double low[2] = {points->low[x], points->low[y]}, ends[2] = {points->high[x], points->high[y]};
    if (!(fmax(ends[0] - low[0], ends[1] - low[1]) > 0)) return 0;
    depth_grid grid;
    float facing[GRID][GRID];
    start_grid(&grid, low, ends, points->count);
    for (size_t i = 0; i < points->count; i++) {
        const double *p = points->offsets[i], depth = high ? points->high[axis] - p[axis] : p[axis] - points->low[axis];
        const float along = high ? normals[i][axis] : -normals[i][axis];
        const size_t column = cell_of(&grid, 0, p[x]), row = cell_of(&grid, 1, p[y]);
        const double before = grid.nearest[row][column];
        // Of points at the same depth the one that is turned away, whatever the order.
        if (depth < before || (depth == before && along < facing[row][column])) facing[row][column] = along;
        put_in_grid(&grid, p[x], p[y], depth);
    }
    int occupied = 0, inside = 0;
    for (int row = 0; row < grid.sides; row++) {
        for (int column = 0; column < grid.sides; column++) {
            if (!grid.counts[row][column]) continue;
            occupied++;
            inside += facing[row][column] < 0;
        }
    }
    return occupied ? (double)inside / occupied : 0;
}

/// How many of MARKS classes of numbers in [low, high] are met.
typedef struct mark_set {
    uint64_t bits[MARKS / 64];
} mark_set;

static void mark(mark_set *set, double number, double low, double high) {
    const size_t place = high > low ? class_of((number - low) / (high - low) * (MARKS - 1), MARKS) : 0;
    set->bits[place / 64] |= (uint64_t)1 << place % 64;
}

/// Classes side by side count as one: rounding spreads a number over two.
static size_t count_marks(const mark_set *set) {
    size_t count = 0;
    bool before = false;
    for (size_t i = 0; i < MARKS; i++) {
        const bool now = set->bits[i / 64] >> i % 64 & 1;
        count += now && !before;
        before = now;
    }
    return count;
}

/// Slopes x/z and y/z of a point; false when it is not before the eye.
static bool slopes_of(const point_cloud_sample *points, size_t index, double sign, double slopes[2],
                      double *depth) {
    const double *p = points->offsets[index], *middle = points->middle_world;
    *depth = sign * (p[2] + middle[2]);
    slopes[0] = (p[0] + middle[0]) / *depth;
    slopes[1] = (p[1] + middle[1]) / *depth;
    return *depth > 0;
}

bool ewa_measure_range(const point_cloud_sample *points, double sign, double max_slope, range_facts *facts) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, slopes[2], depth;
    if (points->count < FEW_POINTS) return false;
    for (size_t i = 0; i < points->count; i++) {
        if (!slopes_of(points, i, sign, slopes, &depth) || fabs(slopes[0]) > max_slope ||
            fabs(slopes[1]) > max_slope)
            return false;
        for (int c = 0; c < 2; c++) widen(&low[c], &high[c], slopes[c]);
    }
    if (!(low[0] < high[0] && low[1] < high[1])) return false;
    depth_grid grid;
    mark_set columns = {{0}}, rows = {{0}};
    start_grid(&grid, low, high, points->count);
    for (size_t i = 0; i < points->count; i++) {
        slopes_of(points, i, sign, slopes, &depth);
        put_in_grid(&grid, slopes[0], slopes[1], depth);
        mark(&columns, slopes[0], low[0], high[0]);
        mark(&rows, slopes[1], low[1], high[1]);
    }
    const double width = high[0] - low[0], height = high[1] - low[1];
    *facts = (range_facts){layered_share(&grid, true), count_marks(&columns), count_marks(&rows),
                           fmin(width, height) / fmax(width, height)};
    return true;
}

typedef struct point2 {
    double x, y;
} point2;

/// Outermost points of strips across x: their convex hull is that of all, but for what is within one strip.
typedef struct strip_hull {
    double low, high; ///< of x
    point2 bottom[STRIPS], top[STRIPS];
    bool occupied[STRIPS];
    point2 first, last; ///< of smallest and largest x
} strip_hull;

static void put_in_hull(strip_hull *hull, double x, double y) {
    const double place = hull->high > hull->low ? (x - hull->low) / (hull->high - hull->low) : 0;
    const size_t strip = class_of(place * STRIPS, STRIPS);
    // Of equal ones the one with the lesser x, whatever the order.
    point2 *bottom = &hull->bottom[strip], *top = &hull->top[strip];
    const bool occupied = hull->occupied[strip];
    if (!occupied || y < bottom->y || (y == bottom->y && x < bottom->x)) *bottom = (point2){x, y};
    if (!occupied || y > top->y || (y == top->y && x < top->x)) *top = (point2){x, y};
    hull->occupied[strip] = true;
    if (x < hull->first.x || (x == hull->first.x && y < hull->first.y)) hull->first = (point2){x, y};
    if (x > hull->last.x || (x == hull->last.x && y > hull->last.y)) hull->last = (point2){x, y};
}

/// Twice the area of a triangle, positive counter-clockwise.
static double turn(point2 a, point2 b, point2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Appends a corner to a chain that turns left; drops those before it that would be inside.
static size_t add_corner(point2 *corners, size_t count, size_t chain_start, point2 next) {
    while (count > chain_start + 1 && turn(corners[count - 2], corners[count - 1], next) <= 0) count--;
    corners[count] = next;
    return count + 1;
}

static bool is_before(point2 a, point2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// The corners of the convex hull, counter-clockwise (Andrew's monotone chain, 1979).
static size_t hull_corners(const strip_hull *hull, point2 corners[2 * CORNERS]) {
    // Strips are in the order of x; within one, the two points have to be put so.
    point2 sorted[CORNERS];
    size_t sorted_count = 0;
    sorted[sorted_count++] = hull->first;
    for (int i = 0; i < STRIPS; i++) {
        if (!hull->occupied[i]) continue;
        const bool swapped = is_before(hull->top[i], hull->bottom[i]);
        sorted[sorted_count++] = swapped ? hull->top[i] : hull->bottom[i];
        sorted[sorted_count++] = swapped ? hull->bottom[i] : hull->top[i];
    }
    sorted[sorted_count++] = hull->last;
    size_t count = 0;
    for (size_t i = 0; i < sorted_count; i++) count = add_corner(corners, count, 0, sorted[i]);
    const size_t lower_count = count;
    for (size_t i = sorted_count - 1; i-- > 0;)
        count = add_corner(corners, count, lower_count - 1, sorted[i]);
    return count > 1 ? count - 1 : count;
}

static double polygon_area(size_t count, const point2 *corners) {
    double sum = 0;
    for (size_t i = 2; i < count; i++) sum += turn(corners[0], corners[i - 1], corners[i]);
    return 0.5 * sum;
}

/// Smallest distance of a point inside of a convex polygon from its edges; negative outside.
static double polygon_depth(size_t count, const point2 *corners, point2 p) {
    double minimum = count < 3 ? -INFINITY : INFINITY;
    for (size_t i = 0; i < count && count >= 3; i++) {
        const point2 a = corners[i], b = corners[(i + 1) % count];
        const double length = sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        if (length > 0) minimum = fmin(minimum, turn(a, b, p) / length);
    }
    return minimum;
}

/// The middle of the cubes that points are in, of GRID along the longest side: dense places weigh no more
/// than others.
static void occupied_middle(const point_cloud_sample *points, double size, double middle[3]) {
    uint64_t cubes[GRID][GRID] = {{0}}; // bit x
    for (size_t i = 0; i < points->count; i++) {
        size_t place[3];
        for (int c = 0; c < 3; c++)
            place[c] = class_of((points->offsets[i][c] - points->low[c]) / size * GRID, GRID);
        cubes[place[2]][place[1]] |= (uint64_t)1 << place[0];
    }
    uint64_t count = 0, sums[3] = {0};
    for (uint64_t z = 0; z < GRID; z++) {
        for (uint64_t y = 0; y < GRID; y++) {
            for (uint64_t x = 0; x < GRID; x++) {
                const uint64_t occupied = cubes[z][y] >> x & 1;
                count += occupied;
                sums[0] += occupied * x;
                sums[1] += occupied * y;
                sums[2] += occupied * z;
            }
        }
    }
    for (int c = 0; c < 3; c++)
        middle[c] = points->low[c] + size / GRID * ((double)sums[c] / (double)count + 0.5);
}

/// The height that all but BELOW_SHARE of the points reach.
static double base_height(const point_cloud_sample *points, int axis) {
    size_t counts[HEIGHTS] = {0}, below = 0;
    const double low = points->low[axis], extent = points->extent[axis];
    if (!(extent > 0)) return low;
    for (size_t i = 0; i < points->count; i++)
        counts[class_of((points->offsets[i][axis] - low) / extent * (HEIGHTS - 1), HEIGHTS)]++;
    size_t step = 0;
    while (step < HEIGHTS - 1 && (double)(below + counts[step]) <= BELOW_SHARE * (double)points->count)
        below += counts[step++];
    return low + extent * (double)step / (HEIGHTS - 1);
}

void ewa_measure_base(const point_cloud_sample *points, int axis, base_facts *facts) {
    *facts = (base_facts){.share = 0};
    const int x = axis == 0 ? 1 : 0, y = axis == 2 ? 1 : 2;
    const double size = fmax(points->extent[0], fmax(points->extent[1], points->extent[2]));
    if (!(size > 0)) return;
    const double top = base_height(points, axis) + BASE_THICKNESS * size;
    strip_hull all = {
        .low = points->low[x], .high = points->high[x], .first = {INFINITY, 0}, .last = {-INFINITY, 0}};
    strip_hull base = all;
    for (size_t i = 0; i < points->count; i++) {
        const double *p = points->offsets[i];
        put_in_hull(&all, p[x], p[y]);
        if (p[axis] <= top) put_in_hull(&base, p[x], p[y]);
    }
    point2 corners[2 * CORNERS];
    const double footprint = polygon_area(hull_corners(&all, corners), corners);
    if (!(footprint > 1e-9 * size * size)) return;
    const size_t count = hull_corners(&base, corners);
    double middle[3];
    occupied_middle(points, size, middle);
    facts->share = polygon_area(count, corners) / footprint;
    facts->stable =
        polygon_depth(count, corners, (point2){middle[x], middle[y]}) > STABLE_MARGIN * sqrt(footprint);
}

/// Bits of a row and of the places beside them.
static uint64_t grow(uint64_t row) { return row | row << 1 | row >> 1; }

double ewa_measure_mirror(const point_cloud_sample *points, int axis) {
    const double size = fmax(points->extent[0], fmax(points->extent[1], points->extent[2]));
    uint64_t cubes[MIRROR_GRID + 2][MIRROR_GRID + 2] = {{0}}; // bit x + 1, with a rim
    uint64_t images[MIRROR_GRID + 2][MIRROR_GRID + 2] = {{0}};
    if (!(size > 0)) return 0;
    const double fitting = sqrt((double)points->count / MIRROR_POINTS);
    const size_t side = fitting < MIRROR_GRID ? (size_t)fitting : MIRROR_GRID;
    if (side < 2) return 0;
    for (size_t i = 0; i < points->count; i++) {
        size_t place[3], image[3];
        for (int c = 0; c < 3; c++) {
            const double low = points->offsets[i][c] - points->low[c], high = points->high[c] - points->offsets[i][c];
            place[c] = class_of(low / size * (double)side, side) + 1;
            image[c] = c != axis ? place[c] : class_of(high / size * (double)side, side) + 1;
        }
        cubes[place[2]][place[1]] |= (uint64_t)1 << place[0];
        images[image[2]][image[1]] |= (uint64_t)1 << image[0];
    }
    uint64_t count = 0, found = 0;
    for (size_t z = 1; z <= side; z++) {
        for (size_t y = 1; y <= side; y++) {
            uint64_t near = 0;
            for (size_t k = 0; k < 9; k++) near |= grow(cubes[z + k / 3 - 1][y + k % 3 - 1]);
            count += (uint64_t)__builtin_popcountll(images[z][y]);
            found += (uint64_t)__builtin_popcountll(images[z][y] & near);
        }
    }
    return count ? (double)found / (double)count : 0;
}
