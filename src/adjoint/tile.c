// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile: surface after surface, which splats count at which of its pixels, what these show, and back to sums of its
// splats (docs/math.md section 15). Splats are summed from the nearest on, those of one depth by all that they look
// like; each term of what goes back is rounded once to a whole number of units and added as such: neither the order of the
// points nor how the picture is cut into tiles changes a byte.
//
// Splats are projected from the nearest on, and no longer once all pixels have a surface in front of what is left.
#include "adjoint/tiles.h"
#include "base/base.h"

#include <stdlib.h>
#include <string.h>

enum {
    CHUNK_SPLATS = 32, ///< between two looks at how far the surface is
    KEY_NUMBERS = 17,
    LANES = EWA_EIGHT_LANES,
};

double ewa_adjoint_power_of(double size) {
    enum { DIGITS = 52 };
    uint64_t bits;
    if (!(size > 0 && isfinite(size))) return 1;
    memcpy(&bits, &size, sizeof bits);
    if (!(bits >> DIGITS)) return ldexp(1, ilogb(size));
    bits = bits >> DIGITS << DIGITS;
    memcpy(&size, &bits, sizeof bits);
    return size;
}

void ewa_adjoint_scales(const ewa_adjoint_job *job, const ewa_reference_splat *splat, double scales[EWA_MOMENT_COUNT]) {
    const ewa_adjoint_units *units = &job->units;
    for (int m = 0; m < EWA_MOMENT_COUNT; m++) scales[m] = m < EWA_MOMENT_OPACITY ? units->color : units->other;
    if (splat->by_rays || job->width <= EWA_MOMENT_OPACITY) return;
    // Places from the centre in the standard deviations of the filtered ellipse.
    const double *q = splat->inverse, determinant = q[0] * q[2] - q[1] * q[1];
    const double x = 1 / ewa_adjoint_power_of(sqrt(q[2] / determinant)), y = 1 / ewa_adjoint_power_of(sqrt(q[0] / determinant));
    scales[EWA_MOMENT_FIRST] *= x, scales[EWA_MOMENT_FIRST + 1] *= y;
    scales[EWA_MOMENT_SECOND] *= x * x;
    scales[EWA_MOMENT_SECOND + 1] *= x * y;
    scales[EWA_MOMENT_SECOND + 2] *= y * y;
    const double depth = units->depth / (job->frame.view.orthographic ? 1 : ewa_adjoint_power_of(splat->center.z));
    scales[EWA_MOMENT_DEPTH] = depth * x, scales[EWA_MOMENT_DEPTH + 1] = depth * y;
    scales[EWA_MOMENT_DEPTH + 2] = depth;
}

/// A tile on its way.
typedef struct tile_work {
    const ewa_adjoint_job *job;
    ewa_adjoint_scratch *scratch;
    ewa_tile_rect place;
    uint32_t columns, rows;  ///< of blocks
    uint32_t count;          ///< points
    uint32_t surface_count;  ///< that have been found
} tile_work;

uint32_t ewa_adjoint_block_count(const ewa_adjoint_job *job) {
    const uint32_t side = job->tiles.side_px;
    return ((side + EWA_EIGHT_COLUMNS - 1) / EWA_EIGHT_COLUMNS) * ((side + EWA_EIGHT_ROWS - 1) / EWA_EIGHT_ROWS);
}

static ewa_adjoint_area area_of(const tile_work *w, uint32_t surface) {
    const size_t surface_doubles = (size_t)w->columns * w->rows * EWA_PLANES * LANES;
    return (ewa_adjoint_area){&w->job->frame.view,
                              (int32_t)w->place.x_px,
                              (int32_t)w->place.y_px,
                              w->columns,
                              w->rows,
                              w->scratch->planes + surface * surface_doubles,
                              w->job->frame.resolve.layering.transparent,
                              surface > 0};
}

/// The first plane of a pixel of the tile.
static double *planes_at(const tile_work *w, uint32_t surface, uint32_t x, uint32_t y) {
    const size_t blocks = (size_t)w->columns * w->rows,
                 block = (size_t)(y / EWA_EIGHT_ROWS) * w->columns + x / EWA_EIGHT_COLUMNS;
    return w->scratch->planes + (surface * blocks + block) * EWA_PLANES * LANES + y % EWA_EIGHT_ROWS * EWA_EIGHT_COLUMNS +
           x % EWA_EIGHT_COLUMNS;
}

static ewa_adjoint_pixel *pixel_at(const tile_work *w, uint32_t x, uint32_t y) {
    return &w->scratch->pixels[y * w->place.width_px + x];
}

// ---- Splats in order

/// Sorts places by their upper halves, digit by digit from the last; those that are equal stay as they are. `room` is for as many.
static void sort_places(uint64_t *places, uint64_t *room, uint32_t count) {
    enum { DIGIT_BITS = 8, DIGITS = 1 << DIGIT_BITS };
    uint64_t any = 0, *from = places, *to = room;
    for (uint32_t i = 1; i < count; i++) any |= places[i] ^ places[0];
    for (int shift = 32; shift < 64; shift += DIGIT_BITS) {
        uint32_t starts[DIGITS] = {0}, start = 0;
        if (!(any >> shift & (DIGITS - 1))) continue;
        for (uint32_t i = 0; i < count; i++) starts[from[i] >> shift & (DIGITS - 1)]++;
        for (int d = 0; d < DIGITS; d++) {
            const uint32_t here = starts[d];
            starts[d] = start;
            start += here;
        }
        for (uint32_t i = 0; i < count; i++) to[starts[from[i] >> shift & (DIGITS - 1)]++] = from[i];
        uint64_t *const sorted = to;
        to = from, from = sorted;
    }
    if (from != places) memcpy(places, from, count * sizeof *places);
}

/// A number of which the upper half has the order of depths.
static uint64_t place_of(float begin, uint32_t point) {
    uint32_t bits;
    memcpy(&bits, &begin, sizeof bits);
    return (uint64_t)(bits >> 31 ? ~bits : bits | UINT32_C(1) << 31) << 32 | point;
}

static float begin_of(const tile_work *w, uint32_t k) {
    return w->job->begins[w->scratch->near_first[k] & UINT32_MAX];
}

/// The numbers that tell two splats apart.
static void read_key(const ewa_reference_splat *splat, double key[KEY_NUMBERS]) {
    const ewa_vec3 vectors[5] = {splat->center, splat->color, splat->normal_world, splat->axis_u, splat->axis_v};
    for (int i = 0; i < 5; i++) vec3_store(vectors[i], key + 3 * i);
    key[15] = splat->moved_px[0], key[16] = splat->moved_px[1];
}

/// Orders splats by all that they look like.
static int compare_splats(const void *a, const void *b) {
    const ewa_reference_splat *left = *(const ewa_reference_splat *const *)a;
    const ewa_reference_splat *right = *(const ewa_reference_splat *const *)b;
    double keys[2][KEY_NUMBERS];
    read_key(left, keys[0]), read_key(right, keys[1]);
    for (int i = 0; i < KEY_NUMBERS; i++)
        if (keys[0][i] != keys[1][i]) return keys[0][i] < keys[1][i] ? -1 : 1;
    return (left->opacity > right->opacity) - (left->opacity < right->opacity);
}

/// Projects some more, and all that begin where the last of them does.
static void project_more(const tile_work *w) {
    ewa_adjoint_scratch *s = w->scratch;
    const uint32_t first = s->splat_count;
    uint32_t end = first + CHUNK_SPLATS < w->count ? first + CHUNK_SPLATS : w->count;
    while (end < w->count && begin_of(w, end) == begin_of(w, end - 1)) end++;
    for (uint32_t k = first; k < end; k += CHUNK_SPLATS) {
        uint32_t points[CHUNK_SPLATS];
        const uint32_t here = end - k < CHUNK_SPLATS ? end - k : CHUNK_SPLATS;
        for (uint32_t i = 0; i < here; i++) points[i] = (uint32_t)s->near_first[k + i];
        ewa_adjoint_project(w->job, points, here, s->splats + k);
    }
    uint32_t run = first; // first of those that begin at one depth
    for (uint32_t k = first; k < end; k++) {
        if (begin_of(w, k) != begin_of(w, run)) run = k;
        s->order[k] = &s->splats[k];
        const bool ends = k + 1 == end || begin_of(w, k + 1) != begin_of(w, run);
        if (ends && k > run) qsort(s->order + run, k + 1 - run, sizeof *s->order, compare_splats);
    }
    s->splat_count = end;
}

// ---- Surfaces

/// Begins a surface behind those that there are, at the pixels that are open.
static void start_surface(const tile_work *w) {
    const uint32_t surface = w->surface_count;
    const ewa_adjoint_area area = area_of(w, surface);
    for (size_t i = 0; i < (size_t)w->columns * w->rows; i++) {
        double *planes = area.planes + i * EWA_PLANES * LANES;
        memset(planes, 0, EWA_SUM_PLANES * LANES * sizeof *planes);
        for (uint32_t lane = 0; lane < LANES; lane++)
            planes[EWA_PLANE_BOUND * LANES + lane] = -INFINITY, planes[EWA_PLANE_PASSED * LANES + lane] = INFINITY;
    }
    for (uint32_t y = 0; y < w->place.height_px; y++)
        for (uint32_t x = 0; x < w->place.width_px; x++) {
            if (!(pixel_at(w, x, y)->through > 0)) continue;
            double *planes = planes_at(w, surface, x, y);
            planes[EWA_PLANE_BOUND * LANES] = INFINITY;
            planes[EWA_PLANE_PASSED * LANES] =
                surface ? planes_at(w, surface - 1, x, y)[EWA_PLANE_BOUND * LANES] : -INFINITY;
        }
}

static bool is_merged(const tile_work *w, uint32_t surface) {
    const ewa_reference_layering *layering = &w->job->frame.resolve.layering;
    return layering->merge_last && surface + 1 == layering->max_layers;
}

/// Where each splat counts in a surface.
static ewa_adjoint_visit *visits_of(const tile_work *w, uint32_t surface) {
    return w->scratch->visits + (size_t)surface * w->scratch->splat_capacity;
}

/// Finds the next surface; returns how many splats may be part of it.
static uint32_t find_surface(const tile_work *w) {
    ewa_adjoint_scratch *s = w->scratch;
    const ewa_adjoint_area area = area_of(w, w->surface_count);
    const bool merged = is_merged(w, w->surface_count);
    double farthest = INFINITY;
    ewa_adjoint_visit *visits = visits_of(w, w->surface_count);
    uint32_t done = 0;
    while (done < w->count && (double)begin_of(w, done) <= farthest) {
        if (done == s->splat_count) project_more(w);
        const uint32_t left = s->splat_count - done, here = left < CHUNK_SPLATS ? left : CHUNK_SPLATS;
        if (merged)
            for (uint32_t i = 0; i < here; i++) visits[done + i] = (ewa_adjoint_visit){UINT64_MAX, 0, EWA_NO_SAMPLES}; // wherever it is
        else
            farthest = w->job->kernels->find(&area, s->order + done, here, &s->samples, visits + done);
        done += here;
    }
    return done;
}

// ---- Pixels

static void read_side(const double *planes, const float material[5], ewa_reference_sums *side) {
    side->weight = planes[EWA_PLANE_WEIGHT * LANES];
    const double *color = planes + EWA_PLANE_COLOR * LANES, *normal = planes + EWA_PLANE_NORMAL * LANES;
    side->color = vec3_make(color[0], color[LANES], color[2 * LANES]);
    side->normal_world = vec3_make(normal[0], normal[LANES], normal[2 * LANES]);
    side->z = planes[EWA_PLANE_Z * LANES];
    side->opacity = planes[EWA_PLANE_OPACITY * LANES];
    for (int i = 0; i < 5; i++) side->material[i] = side->weight * (double)material[i];
}

static void write_side(const ewa_reference_sums *side, double *planes) {
    const double numbers[EWA_SIDE_PLANES] = {side->weight,         side->color.x,        side->color.y,
                                             side->color.z,        side->normal_world.x, side->normal_world.y,
                                             side->normal_world.z, side->z,              side->opacity};
    for (int p = 0; p < EWA_SIDE_PLANES; p++) planes[p * LANES] = numbers[p];
}

static void read_gathered(const tile_work *w, const double *planes, ewa_reference_gathered *gathered) {
    float material[5];
    ewa_reference_material_of(&w->job->frame.resolve, material);
    read_side(planes, material, &gathered->facing);
    read_side(planes + EWA_SIDE_PLANES * LANES, material, &gathered->is_back);
    ewa_reference_cut *cut = &gathered->cut;
    cut->kept = planes[EWA_PLANE_KEPT * LANES], cut->whole = planes[EWA_PLANE_WHOLE * LANES];
    for (int c = 0; c < 2; c++) cut->inward[c] = planes[(EWA_PLANE_INWARD + c) * LANES];
}

static void write_gathered(const ewa_reference_gathered *gathered, double *planes) {
    write_side(&gathered->facing, planes);
    write_side(&gathered->is_back, planes + EWA_SIDE_PLANES * LANES);
    const ewa_reference_cut *cut = &gathered->cut;
    planes[EWA_PLANE_KEPT * LANES] = cut->kept, planes[EWA_PLANE_WHOLE * LANES] = cut->whole;
    for (int c = 0; c < 2; c++) planes[(EWA_PLANE_INWARD + c) * LANES] = cut->inward[c];
}

/// The cotangents of a pixel; depths per unit of the view.
static ewa_reference_values cotangent_of(const ewa_adjoint_job *job, size_t index) {
    const ewa_frame_cotangent *from = &job->cotangent;
    ewa_reference_values values = {.depth = 0};
    for (size_t c = 0; c < 4 && from->rgba; c++) values.rgba[c] = (double)from->rgba[4 * index + c];
    for (size_t c = 0; c < 3 && from->normal; c++) values.normal[c] = (double)from->normal[3 * index + c];
    if (from->depth) values.depth = (double)from->depth[index] * job->frame.view.placement.unit;
    if (from->coverage) values.coverage = (double)from->coverage[index];
    return values;
}

/// Sets surface `index` of scratch->layers from the sums of a pixel.
static void finalize_layer(const tile_work *w, uint32_t x, uint32_t y, uint32_t index, double through) {
    ewa_reference_layer *layer = &w->scratch->layers[index];
    read_gathered(w, planes_at(w, index, x, y), &layer->gathered);
    ewa_reference_layer_settle(&w->job->frame.resolve, w->place.x_px + x + 0.5, w->place.y_px + y + 0.5, index, through,
                               &pixel_at(w, x, y)->first, layer);
}

/// Ends a pixel that has `count` surfaces, those from `settled` on in scratch->layers: what it shows, and back.
static void end_pixel(const tile_work *w, uint32_t x, uint32_t y, uint32_t count, uint32_t settled) {
    const ewa_adjoint_job *job = w->job;
    ewa_adjoint_scratch *s = w->scratch;
    const ewa_reference_resolve *to = &job->frame.resolve;
    const size_t index = (size_t)(w->place.y_px + y) * job->tiles.width_px + w->place.x_px + x;
    double through = 1;
    for (uint32_t i = 0; i < settled; i++) {
        finalize_layer(w, x, y, i, through);
        through = s->layers[i].through * (1 - s->layers[i].alpha);
    }
    pixel_at(w, x, y)->through = 0;
    if (job->gradient.rgba) {
        const ewa_reference_values shown = ewa_reference_layers_show(to, s->layers, count);
        memcpy(job->gradient.rgba + 4 * index, shown.rgba, sizeof shown.rgba);
    }
    if (count == 0 || job->width == 0) return;
    const ewa_reference_values cotangent = cotangent_of(job, index);
    double camera[EWA_CAMERA_NUMBERS] = {0};
    ewa_reference_layers_pull_back(to, w->place.x_px + x + 0.5, w->place.y_px + y + 0.5, &cotangent, s->layers, count, camera);
    for (int i = 0; i < EWA_CAMERA_NUMBERS && s->camera; i++)
        if (camera[i] != 0) ewa_exact_add(&s->camera[i], camera[i]);
    for (uint32_t i = 0; i < count; i++) write_gathered(&s->layers[i].cotangent, planes_at(w, i, x, y));
}

/// Looks at the surface that a pixel has gathered; returns whether there may be another behind it.
static bool finalize_pixel(const tile_work *w, uint32_t x, uint32_t y, bool last) {
    const uint32_t surface = w->surface_count;
    double *planes = planes_at(w, surface, x, y);
    ewa_adjoint_pixel *pixel = pixel_at(w, x, y);
    const double weight = planes[EWA_PLANE_WEIGHT * LANES] + planes[(EWA_SIDE_PLANES + EWA_PLANE_WEIGHT) * LANES];
    if (!(planes[EWA_PLANE_BOUND * LANES] < INFINITY || is_merged(w, surface)) || !(weight > 0)) {
        planes[EWA_PLANE_BOUND * LANES] = -INFINITY; // nothing counts
        end_pixel(w, x, y, surface, surface);
        return false;
    }
    finalize_layer(w, x, y, surface, pixel->through);
    const ewa_reference_layer *layer = &w->scratch->layers[surface];
    const double through = layer->through * (1 - layer->alpha);
    if (surface == 0) pixel->first = layer->cover;
    if (last || !(through > 0)) {
        end_pixel(w, x, y, surface + 1, surface);
        return false;
    }
    pixel->through = through;
    return true;
}

/// Ends the pixels of a first surface that it fills, and those in which nothing is.
static void end_filled(const tile_work *w) {
    const ewa_adjoint_job *job = w->job;
    ewa_adjoint_scratch *s = w->scratch;
    const ewa_adjoint_area area = area_of(w, 0);
    ewa_adjoint_filling filling = job->filling;
    filling.rgba += 4 * ((size_t)w->place.y_px * job->tiles.width_px + w->place.x_px);
    filling.width_px = w->place.width_px, filling.height_px = w->place.height_px;
    double camera[EWA_CAMERA_NUMBERS];
    job->kernels->fill(&area, &filling, s->done, camera);
    for (int i = 0; i < EWA_CAMERA_NUMBERS && filling.with_camera; i++)
        if (camera[i] != 0) ewa_exact_add(&s->camera[i], camera[i]);
    for (uint32_t y = 0; y < w->place.height_px; y++)
        for (uint32_t x = 0; x < w->place.width_px; x++) {
            const uint32_t lane = y % EWA_EIGHT_ROWS * EWA_EIGHT_COLUMNS + x % EWA_EIGHT_COLUMNS;
            if (s->done[y / EWA_EIGHT_ROWS * w->columns + x / EWA_EIGHT_COLUMNS] >> lane & 1) pixel_at(w, x, y)->through = 0;
        }
}

/// Looks at the surface that has been gathered; returns whether there may be another behind it.
static bool finalize_surface(const tile_work *w) {
    if (w->surface_count == 0 && w->job->fills) end_filled(w);
    const bool last = w->surface_count + 1 == w->job->surface_count;
    bool open = false;
    for (uint32_t y = 0; y < w->place.height_px; y++)
        for (uint32_t x = 0; x < w->place.width_px; x++)
            if (pixel_at(w, x, y)->through > 0) open |= finalize_pixel(w, x, y, last);
    return open;
}

// ---- Back to splats

/// Adds to the sums of a point. Several tiles may do so at a time: whole numbers, in any order.
static void add_to_point(const ewa_adjoint_job *job, uint32_t point, const int64_t sums[EWA_MOMENT_COUNT]) {
    const ewa_adjoint_range *range = &job->ranges[point];
    const bool alone = job->worker_count == 1 || range->end - range->first == (1 | 1 << 16);
    int64_t *to = job->sums + (size_t)point * job->width;
    for (uint32_t m = 0; m < job->width; m++)
        if (alone)
            to[m] += sums[m];
        else if (sums[m])
            __atomic_fetch_add(&to[m], sums[m], __ATOMIC_RELAXED);
}

static bool counts_anywhere(const tile_work *w, uint32_t splat) {
    bool counts = false;
    for (uint32_t i = 0; i < w->surface_count; i++) counts |= splat < w->scratch->reached[i] && visits_of(w, i)[splat].counts != 0;
    return counts;
}

/// The sums of splats that come later are fetched by then.
static void fetch_sums(const tile_work *w, uint32_t splat) {
    enum { LINE_NUMBERS = 8 };
    const uint32_t point = (uint32_t)w->scratch->near_first[splat];
    const int64_t *sums = w->job->sums + (size_t)point * w->job->width;
    for (uint32_t m = 0; m < w->job->width; m += LINE_NUMBERS) __builtin_prefetch(sums + m, 1);
}

static void gather_splats(const tile_work *w) {
    enum { AHEAD = 8 };
    const ewa_adjoint_job *job = w->job;
    const ewa_adjoint_scratch *s = w->scratch;
    uint32_t maximum = 0;
    for (uint32_t i = 0; i < w->surface_count; i++) maximum = s->reached[i] > maximum ? s->reached[i] : maximum;
    for (uint32_t k = 0; k < maximum; k++) {
        double scales[EWA_MOMENT_COUNT];
        int64_t sums[EWA_MOMENT_COUNT] = {0};
        if (k + AHEAD < maximum && counts_anywhere(w, k + AHEAD)) fetch_sums(w, k + AHEAD);
        if (!counts_anywhere(w, k)) continue;
        ewa_adjoint_scales(job, s->order[k], scales);
        for (uint32_t i = 0; i < w->surface_count; i++) {
            const ewa_adjoint_area area = area_of(w, i);
            if (k < s->reached[i])
                job->kernels->gather(&area, s->order[k], &s->samples, &visits_of(w, i)[k], job->width, job->cotangent.depth != NULL,
                                     scales, sums);
        }
        add_to_point(job, (uint32_t)s->near_first[s->order[k] - s->splats], sums);
    }
}

void ewa_adjoint_tile(void *data, uint32_t index, uint32_t worker) {
    const ewa_adjoint_job *job = data;
    ewa_adjoint_scratch *s = &job->scratch[worker];
    const uint64_t first = job->lists.starts[index];
    tile_work w = {.job = job, .scratch = s, .place = ewa_tiles_rect(&job->tiles, index),
                   .count = (uint32_t)(job->lists.starts[index + 1] - first)};
    w.columns = (w.place.width_px + EWA_EIGHT_COLUMNS - 1) / EWA_EIGHT_COLUMNS;
    w.rows = (w.place.height_px + EWA_EIGHT_ROWS - 1) / EWA_EIGHT_ROWS;
    for (uint32_t k = 0; k < w.count; k++) {
        const uint32_t point = job->lists.ids[first + k];
        s->near_first[k] = place_of(job->begins[point], point);
    }
    sort_places(s->near_first, s->near_room, w.count);
    s->splat_count = s->samples.count = 0;
    for (uint32_t i = 0; i < w.place.width_px * w.place.height_px; i++) s->pixels[i].through = 1;
    for (bool open = true; open && ewa_goes_on(job->frame.context, worker); w.surface_count++) {
        start_surface(&w);
        const ewa_adjoint_area area = area_of(&w, w.surface_count);
        s->reached[w.surface_count] = find_surface(&w);
        job->kernels->sum(&area, s->order, s->reached[w.surface_count], &s->samples, visits_of(&w, w.surface_count));
        open = finalize_surface(&w);
    }
    if (job->width) gather_splats(&w);
}
