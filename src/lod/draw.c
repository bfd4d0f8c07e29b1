// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A picture of an octree: which cubes, with which weights, what has to be read for it, and in which bands.
//
// A cube stands for its parts while what is drawn of it lies no farther apart on the screen than it may. From three
// quarters of that on its parts are drawn as well, with weights that grow to one as those of the cube fall to zero:
// the picture, a quotient of sums, changes with the camera without a step. The finest that is drawn finds the nearest
// surfaces.
#include "base/base.h"
#include "base/options.h"
#include "homogeneous/vec.h"
#include "lod/tree.h"
#include "surface/hollow.h"
#include "surface/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BAND_PX = 128,
    BYTES_PER_SURFEL = 40,
    CROWD = 5000000, // surfels of a picture of which fewer fit in cache than a tile of the usual size has
    CROWDED_TILE_PX = 32,
};

/// Share of the spacing, or of the error, at which parts begin to show.
static const double FADE_FROM = 0.75;

/// Pixels between surfels where errors are measured.
static const double ERROR_SPACING_PX = 0.5;

static const ewa_option lod_rows[] = {
    {"spacing_px", EWA_OPTION_F64, offsetof(ewa_lod_options, spacing_px), 0, 64, EWA_OPTION_ABOVE,
     .initial = 0.5, .unit = "px",
     .help = "cubes are drawn by surfels that stand for their points where these are no farther apart"},
    {"error", EWA_OPTION_F64, offsetof(ewa_lod_options, error), 0, 255, .initial = 16,
     .help = "and expected to be off by no more than so much, rms, in 1/255; 0: all points"},
    {"memory_bytes", EWA_OPTION_U64, offsetof(ewa_lod_options, memory_bytes), 0x1p24, 0x1p50,
     .initial = 0x1p30, .unit = "bytes",
     .help = "memory for cubes; a picture that needs more is drawn in bands"},
    {"load_s", EWA_OPTION_F64, offsetof(ewa_lod_options, load_s), 0, 1e15, .unit = "s",
     .help = "time for reading cubes; what is missing then is drawn coarser; 0: as long as it takes"},
    {"share", EWA_OPTION_U32, offsetof(ewa_lod_options, share), 0, 0x1p20,
     .help = "part that a rank draws of what a renderer of several ranks shows"},
    {"share_count", EWA_OPTION_U32, offsetof(ewa_lod_options, share_count), 0, 0x1p20,
     .help = "of so many; 0: no parts"},
};

const ewa_option_table ewa_lod_options_table = EWA_OPTION_TABLE(ewa_lod_options, lod_rows);

void ewa_lod_options_init(ewa_lod_options *options, size_t struct_size) {
    ewa_options_init(&ewa_lod_options_table, options, struct_size);
}

/// A cube of the picture.
typedef struct item {
    uint32_t cube;
    double weight;
    bool hides;
    double spacing_px, offset_px; ///< of the cube; from the picture's middle
    uint32_t first_row, end_row;  ///< of the picture that it may touch
} item;

/// What is known while cubes are chosen.
typedef struct chooser {
    ewa_lod *lod;
    const ewa_camera *camera;
    const ewa_lod_options *options;
    double scale; ///< camera units per world unit
    double margin_px;
    bool loaded_only; ///< cubes that are not in memory are drawn by what stands for them
    item *items;
    uint32_t item_count;
    uint32_t missing_count;
    ewa_status status;
} chooser;

/// A cube before the camera.
typedef struct sight_of {
    bool seen;
    double spacing_px; ///< infinite: the camera is in it
    double offset_px;
    uint32_t first_row, end_row;
} sight_of;

/// Rows and columns of the picture that a box in camera space may touch.
static sight_of look_at(const chooser *c, const ewa_cube *cube) {
    const ewa_camera *camera = c->camera;
    const double *m = camera->world_to_camera;
    const double reach = cube->largest_radius_world * c->scale;
    double at[3], half[3];
    for (int r = 0; r < 3; r++) {
        at[r] = m[4 * r + 3], half[r] = reach;
        for (int k = 0; k < 3; k++) {
            at[r] += m[4 * r + k] * (cube->low_world[k] + cube->side_world / 2);
            half[r] += fabs(m[4 * r + k]) * cube->side_world / 2;
        }
    }
    sight_of s = {.seen = false, .spacing_px = INFINITY, .end_row = camera->height_px};
    const double near_z = at[2] - half[2], far_z = at[2] + half[2];
    if (far_z <= 0) return s;
    const double focal_px[2] = {camera->fx_px, camera->fy_px}, center_px[2] = {camera->cx_px, camera->cy_px};
    const double size_px[2] = {camera->width_px, camera->height_px};
    const double spacing = cube->spacing_world * c->scale;
    double low_px[2] = {0, 0}, high_px[2] = {size_px[0], size_px[1]};
    const bool perspective = camera->projection == EWA_PERSPECTIVE;
    if (!perspective || near_z > 0) {
        for (int k = 0; k < 2; k++) {
            const double low = at[k] - half[k], high = at[k] + half[k];
            const double low_z = low < 0 ? near_z : far_z, high_z = high < 0 ? far_z : near_z;
            low_px[k] = focal_px[k] * (perspective ? low / low_z : low) + center_px[k] - c->margin_px;
            high_px[k] = focal_px[k] * (perspective ? high / high_z : high) + center_px[k] + c->margin_px;
            if (!(low_px[k] < size_px[k] && high_px[k] > 0)) return s;
        }
        s.spacing_px = fmax(focal_px[0], focal_px[1]) * (perspective ? spacing / near_z : spacing);
    }
    s.seen = true;
    s.offset_px = hypot((low_px[0] + high_px[0] - size_px[0]) / 2, (low_px[1] + high_px[1] - size_px[1]) / 2);
    s.first_row = low_px[1] > 0 ? (uint32_t)low_px[1] : 0;
    s.end_row = high_px[1] < size_px[1] ? (uint32_t)ceil(high_px[1]) : camera->height_px;
    return s;
}

/// Share of a cube's parts in what is drawn of it.
static double share_of_parts(const chooser *c, const ewa_cube *cube, double spacing_px) {
    if (!cube->divided) return 0;
    if (c->options->error == 0) return 1;
    const double measure = fmax(spacing_px / c->options->spacing_px,
                                cube->error * (spacing_px / ERROR_SPACING_PX) / c->options->error);
    const double share = (measure - FADE_FROM) / (1 - FADE_FROM);
    return share > 0 ? (share < 1 ? share : 1) : 0;
}

static void add_item(chooser *c, uint32_t cube, double weight, bool hides, const sight_of *s) {
    ewa_buffer *buffer = &c->lod->items;
    c->status =
        ewa_buffer_grow(c->lod->context, buffer, c->item_count, (size_t)c->item_count + 1, sizeof(item));
    if (c->status != EWA_OK) return;
    c->items = buffer->data;
    c->items[c->item_count++] =
        (item){cube, weight, hides, s->spacing_px, s->offset_px, s->first_row, s->end_row};
}

/// Whether a cube can be drawn of what is in memory, by itself or by all of its parts that are seen.
static bool is_loaded(const chooser *c, uint32_t index) { return c->lod->cubes[index].surfels != NULL; }

/// Whether all parts of a cube that are seen are in memory.
static bool parts_are_loaded(const chooser *c, const ewa_cube *cube) {
    for (int i = 0; i < 8; i++) {
        if (cube->parts[i] == EWA_NO_CUBE || is_loaded(c, cube->parts[i])) continue;
        if (look_at(c, &c->lod->cubes[cube->parts[i]]).seen) return false;
    }
    return true;
}

static void choose(chooser *c, uint32_t index, double weight) {
    const ewa_cube *cube = &c->lod->cubes[index];
    const sight_of s = look_at(c, cube);
    if (!s.seen || c->status != EWA_OK) return;
    double share = share_of_parts(c, cube, s.spacing_px);
    if (c->loaded_only && share > 0 && !parts_are_loaded(c, cube)) {
        c->missing_count++;
        share = 0;
    }
    // What stands for parts is larger than they are: where these are drawn they say what is in front of what.
    if (share < 1) add_item(c, index, weight * (1 - share), share == 0, &s);
    for (int i = 0; i < 8 && share > 0; i++)
        if (cube->parts[i] != EWA_NO_CUBE) choose(c, cube->parts[i], weight * share);
}

/// All cubes from the root to those that are wanted, for pictures that get finer.
static void choose_ways(chooser *c, uint32_t index) {
    const ewa_cube *cube = &c->lod->cubes[index];
    const sight_of s = look_at(c, cube);
    if (!s.seen || c->status != EWA_OK) return;
    add_item(c, index, 1, true, &s);
    if (share_of_parts(c, cube, s.spacing_px) > 0)
        for (int i = 0; i < 8; i++)
            if (cube->parts[i] != EWA_NO_CUBE) choose_ways(c, cube->parts[i]);
}

static ewa_status choose_cubes(chooser *c, bool loaded_only) {
    c->loaded_only = loaded_only;
    c->item_count = c->missing_count = 0;
    c->status = EWA_OK;
    choose(c, 0, 1);
    return c->status;
}

/// What is coarse comes first, then what is large and in the middle.
static int compare_urgency(const void *a, const void *b) {
    const item *p = a, *q = b;
    const double of_p = fmin(p->spacing_px, 1e9) / (1 + 1e-3 * p->offset_px),
                 of_q = fmin(q->spacing_px, 1e9) / (1 + 1e-3 * q->offset_px);
    return of_p > of_q ? -1 : of_p < of_q ? 1 : p->cube < q->cube ? -1 : p->cube > q->cube;
}

/// Bytes of what is drawn of a cube, about where it is not in memory.
static uint64_t bytes_of(const ewa_cube *cube) {
    return cube->surfels ? cube->resident_bytes : cube->count * BYTES_PER_SURFEL + 4096;
}

/// Reads cubes for some time, the most urgent first.
static ewa_status load_some(chooser *c, double until_s, ewa_lod_stats *stats) {
    enum { STEP = 8 };
    ewa_lod *lod = c->lod;
    c->loaded_only = false;
    c->item_count = 0;
    c->status = EWA_OK;
    choose_ways(c, 0);
    if (c->status != EWA_OK) return c->status;
    for (uint32_t i = 0; i < c->item_count; i++) lod->cubes[c->items[i].cube].last_frame = lod->frame;
    qsort(c->items, c->item_count, sizeof *c->items, compare_urgency);
    uint32_t step[STEP], count = 0;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < c->item_count && status == EWA_OK; i++) {
        const uint32_t cube = c->items[i].cube;
        if (lod->cubes[cube].surfels) continue;
        if (lod->resident_bytes + lod->cloud_bytes + bytes_of(&lod->cubes[cube]) > c->options->memory_bytes) {
            ewa_tree_trim(lod, c->options->memory_bytes - bytes_of(&lod->cubes[cube]));
            if (lod->resident_bytes + lod->cloud_bytes + bytes_of(&lod->cubes[cube]) >
                c->options->memory_bytes)
                break;
        }
        step[count++] = cube;
        stats->loaded_count++;
        // The root alone, so that there is something to draw.
        if (count < STEP && i > 0) continue;
        status = ewa_tree_load(lod, step, count, c->options->memory_bytes);
        count = 0;
        if (ewa_now_s() > until_s) return status;
    }
    if (status == EWA_OK && count) status = ewa_tree_load(lod, step, count, c->options->memory_bytes);
    return status;
}

/// Reads cubes that some items need, within the memory that there is.
static ewa_status load_items(ewa_lod *lod, const item *items, uint32_t count, uint64_t memory_bytes,
                             ewa_lod_stats *stats) {
    ewa_status status = ewa_buffer_reserve(lod->context, &lod->wanted, count, sizeof(uint32_t));
    uint32_t *wanted = lod->wanted.data, wanted_count = 0;
    uint64_t wanted_bytes = 0;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        ewa_cube *cube = &lod->cubes[items[i].cube];
        cube->last_frame = lod->frame;
        if (cube->surfels) continue;
        wanted[wanted_count++] = items[i].cube;
        wanted_bytes += bytes_of(cube);
    }
    stats->loaded_count += wanted_count;
    if (status != EWA_OK || !wanted_count) return status;
    ewa_tree_trim(lod, memory_bytes > wanted_bytes ? memory_bytes - wanted_bytes : 0);
    return ewa_tree_load(lod, wanted, wanted_count, memory_bytes);
}

/// Draws the rows [first, end) of the picture; other cubes than those that touch them take part by what is known of them all
/// together. `hollows` are those of all items, where there are several bands; else NULL.
static ewa_status draw_rows(ewa_lod *lod, ewa_renderer *renderer, const ewa_camera *camera,
                            const ewa_render_options *options, const ewa_frame *frame, const item *items,
                            uint32_t count, ewa_surfels *const *hollows, uint32_t first_row, uint32_t end_row,
                            ewa_render_stats *stats) {
    uint64_t surfel_count = 0;
    for (uint32_t i = 0; i < count; i++) surfel_count += lod->cubes[items[i].cube].count;
    ewa_renderer_set_tile(renderer, surfel_count > CROWD ? CROWDED_TILE_PX : 0);
    ewa_status status = ewa_render_begin(renderer, camera, options, frame);
    if (status == EWA_OK && hollows) status = ewa_render_set_rows(renderer, first_row, end_row);
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        const bool touches = items[i].first_row < end_row && items[i].end_row > first_row;
        const ewa_surfels *surfels = !hollows || touches ? lod->cubes[items[i].cube].surfels : hollows[i];
        const ewa_render_source how = {items[i].weight, items[i].hides};
        status = ewa_render_add_source(renderer, surfels, &how);
    }
    return status == EWA_OK ? ewa_render_finish(renderer, stats) : status;
}

static void add_stats(ewa_render_stats *sum, const ewa_render_stats *more) {
    sum->splat_count = more->splat_count > sum->splat_count ? more->splat_count : sum->splat_count;
    sum->culled_count += more->culled_count;
    sum->hidden_count += more->hidden_count;
    sum->drawn_count += more->drawn_count;
    sum->fragment_count += more->fragment_count;
    sum->bin_s += more->bin_s, sum->setup_s += more->setup_s;
    sum->visibility_s += more->visibility_s, sum->accumulate_s += more->accumulate_s;
    sum->edge_s += more->edge_s, sum->resolve_s += more->resolve_s;
    sum->total_s += more->total_s;
}

/// Bytes of the cubes that touch some rows.
static uint64_t bytes_of_rows(const ewa_lod *lod, const item *items, uint32_t count, uint32_t first_row,
                              uint32_t end_row) {
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < count; i++)
        if (items[i].first_row < end_row && items[i].end_row > first_row)
            bytes += bytes_of(&lod->cubes[items[i].cube]);
    return bytes;
}

/// Learns what all cubes are like that a picture needs, however few of them fit in memory at a time.
static ewa_status make_hollows(ewa_lod *lod, const item *items, uint32_t count, uint64_t memory_bytes,
                               ewa_surfels **hollows, ewa_lod_stats *stats) {
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        lod->frame++; // what was looked at before may go
        status = load_items(lod, &items[i], 1, memory_bytes, stats);
        if (status == EWA_OK) status = ewa_surfels_hollow(lod->cubes[items[i].cube].surfels, &hollows[i]);
    }
    return status;
}

/// Draws a picture whose cubes do not fit in memory together.
static ewa_status draw_bands(ewa_lod *lod, ewa_renderer *renderer, const ewa_camera *camera,
                             const ewa_render_options *options, const ewa_frame *frame, const item *items,
                             uint32_t count, uint64_t memory_bytes, ewa_lod_stats *stats) {
    ewa_surfels **hollows = ewa_allocate_zeroed(lod->context, count, sizeof *hollows);
    item *touching = ewa_allocate(lod->context, count, sizeof *touching);
    ewa_status status = hollows && touching ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = make_hollows(lod, items, count, memory_bytes, hollows, stats);
    for (uint32_t first = 0, end; first < camera->height_px && status == EWA_OK; first = end) {
        end = first + BAND_PX;
        while (end < camera->height_px &&
               bytes_of_rows(lod, items, count, first, end + BAND_PX) <= memory_bytes)
            end += BAND_PX;
        if (end > camera->height_px) end = camera->height_px;
        const uint64_t bytes = bytes_of_rows(lod, items, count, first, end);
        if (bytes > memory_bytes) {
            status = ewa_fail(
                lod->context, EWA_ERROR_LIMIT,
                "rows %u to %u of the picture need %llu bytes of cubes, more than the %llu that are allowed",
                first, end, (unsigned long long)bytes, (unsigned long long)memory_bytes);
            break;
        }
        uint32_t touching_count = 0;
        for (uint32_t i = 0; i < count; i++)
            if (items[i].first_row < end && items[i].end_row > first) touching[touching_count++] = items[i];
        lod->frame++;
        status = load_items(lod, touching, touching_count, memory_bytes, stats);
        ewa_render_stats took = {0};
        if (status == EWA_OK)
            status =
                draw_rows(lod, renderer, camera, options, frame, items, count, hollows, first, end, &took);
        add_stats(&stats->render, &took);
        stats->band_count++;
    }
    for (uint32_t i = 0; hollows && i < count; i++) ewa_surfels_destroy(&hollows[i]);
    ewa_release(lod->context, hollows, count, sizeof *hollows);
    ewa_release(lod->context, touching, count, sizeof *touching);
    return status;
}

/// Keeps one part of the cubes, which are in an order in which neighbours are near each other: those whose surfels
/// begin in that part of all.
static ewa_status keep_share(chooser *c) {
    const ewa_lod_options *options = c->options;
    uint64_t all = 0, before = 0, bytes = 0;
    for (uint32_t i = 0; i < c->item_count; i++) all += c->lod->cubes[c->items[i].cube].count;
    const uint64_t first = ewa_split(all, options->share_count, options->share),
                   end = ewa_split(all, options->share_count, options->share + 1);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->item_count; i++) {
        const ewa_cube *cube = &c->lod->cubes[c->items[i].cube];
        if (before >= first && before < end) {
            c->items[kept++] = c->items[i];
            bytes += bytes_of(cube);
        }
        before += cube->count;
    }
    c->item_count = kept;
    if (bytes <= options->memory_bytes) return EWA_OK;
    return ewa_fail(c->lod->context, EWA_ERROR_LIMIT,
                    "part %u of %u of the picture needs %llu bytes of cubes, more than the %llu that are "
                    "allowed: more ranks or more memory each",
                    options->share + 1, options->share_count, (unsigned long long)bytes,
                    (unsigned long long)options->memory_bytes);
}

static double scale_of(const ewa_camera *camera) {
    return vec3_length(vec3_load(&camera->world_to_camera[8]));
}

static ewa_status render(ewa_lod *lod, ewa_renderer *renderer, const ewa_camera *camera,
                         const ewa_render_options *options, const ewa_lod_options *chosen,
                         const ewa_frame *frame, ewa_lod_stats *stats) {
    const double start_s = ewa_now_s();
    // Filters reach some pixels beyond a surfel.
    chooser c = {.lod = lod, .camera = camera, .options = chosen, .scale = scale_of(camera), .margin_px = 16};
    lod->frame++;
    ewa_status status = EWA_OK;
    if (chosen->load_s > 0) {
        status = load_some(&c, start_s + chosen->load_s, stats);
        stats->load_s = ewa_now_s() - start_s;
    }
    const double before_s = ewa_now_s();
    if (status == EWA_OK) status = choose_cubes(&c, chosen->load_s > 0);
    if (status == EWA_OK && chosen->share_count) status = keep_share(&c);
    if (status != EWA_OK) return status;
    stats->choose_s = ewa_now_s() - before_s;
    stats->missing_count = c.missing_count;
    stats->cube_count = c.item_count;
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < c.item_count; i++) bytes += bytes_of(&lod->cubes[c.items[i].cube]);
    if (bytes <= chosen->memory_bytes || chosen->load_s > 0) {
        const double load_from_s = ewa_now_s();
        status = load_items(lod, c.items, c.item_count, chosen->memory_bytes, stats);
        stats->load_s += ewa_now_s() - load_from_s;
        stats->band_count = 1;
        if (status == EWA_OK)
            status = draw_rows(lod, renderer, camera, options, frame, c.items, c.item_count, NULL, 0,
                               camera->height_px, &stats->render);
    } else {
        status = draw_bands(lod, renderer, camera, options, frame, c.items, c.item_count,
                            chosen->memory_bytes, stats);
    }
    for (uint32_t i = 0; i < c.item_count; i++) {
        const ewa_cube *cube = &lod->cubes[c.items[i].cube];
        stats->surfel_count += cube->count;
    }
    stats->resident_bytes = lod->resident_bytes + lod->cloud_bytes;
    return status;
}

ewa_status ewa_lod_render(ewa_lod *lod, ewa_renderer *renderer, const ewa_camera *camera,
                          const ewa_render_options *options, const ewa_lod_options *lod_options,
                          const ewa_frame *frame, ewa_lod_stats *stats) {
    if (!lod || !renderer || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_lod_options chosen;
    ewa_lod_options_init(&chosen, sizeof chosen);
    ewa_status status = ewa_options_take(lod->context, &ewa_lod_options_table, lod_options, &chosen);
    if (status == EWA_OK) status = ewa_camera_check(lod->context, camera);
    if (status != EWA_OK) return status;
    if (chosen.share_count && (chosen.share >= chosen.share_count || chosen.load_s > 0))
        return ewa_fail(lod->context, EWA_ERROR_ARGUMENT,
                        "lod: part %u of %u, or parts that a time limit makes", chosen.share,
                        chosen.share_count);
    ewa_render_options plain;
    ewa_render_options_init(&plain, sizeof plain);
    if (options) plain = *options;
    plain.level = 0;
    plain.budget_s = 0;
    ewa_lod_stats took = {.cube_count = 0};
    status = render(lod, renderer, camera, &plain, &chosen, frame, &took);
    if (stats) *stats = took;
    return status;
}

// interim
ewa_status ewa_lod_scene_render(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                                const ewa_render_options *options, const ewa_lod_options *lod_options,
                                const ewa_frame *frame, ewa_lod_stats *stats) {
    *stats = (ewa_lod_stats){.cube_count = 0};
    if (scene->lod_count == 1 && !scene->surfels_count)
        return ewa_lod_render(scene->lods[0], renderer, camera, options, lod_options, frame, stats);
    ewa_status status = ewa_render_begin(renderer, camera, options, frame);
    for (uint32_t i = 0; i < scene->surfels_count && status == EWA_OK; i++)
        status = ewa_render_add(renderer, scene->surfels[i]);
    return status == EWA_OK ? ewa_render_finish(renderer, &stats->render) : status;
}
