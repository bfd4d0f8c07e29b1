// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A picture of an octree: which nodes, with which weights, what has to be read for it, and in which bands.
//
// A node represents its children while what is drawn of it lies no farther apart on the screen than it may.
// From three quarters of that on its children are drawn as well, with weights that grow to one as those of
// the node fall to zero: the picture, a quotient of sums, changes with the camera without a step. The finest
// that is drawn finds the nearest surfaces.
#include "base/base.h"
#include "base/options.h"
#include "homogeneous/vec.h"
#include "lod/tree.h"
#include "surface/options.h"
#include "surface/packets.h"
#include "surface/proxy.h"
#include "surface/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BAND_PX = 128,
    BYTES_PER_SURFEL = 40,
    MAX_SURFELS_SETS = 1024, // of a picture's sets, of one part of it
};

/// Share of the spacing, or of the error, at which parts begin to show.
static const double FADE_FROM = 0.75;

/// Pixels between surfels where errors are measured.
static const double ERROR_SPACING_PX = 0.5;

static const ewa_option lod_rows[] = {
    {"spacing_px", EWA_OPTION_F64, offsetof(ewa_lod_options, spacing_px), 0, 64, EWA_OPTION_ABOVE,
     .initial = 0.5, .unit = "px",
     .help = "nodes are drawn by surfels that represent their points where these are no farther apart"},
    {"error", EWA_OPTION_F64, offsetof(ewa_lod_options, error), 0, 255, .initial = 16,
     .help = "and expected to be off by no more than so much, rms, in 1/255; 0: all points"},
    {"memory_bytes", EWA_OPTION_U64, offsetof(ewa_lod_options, memory_bytes), 0x1p24, 0x1p50,
     .initial = 0x1p30, .unit = "bytes",
     .help = "memory for nodes; a picture that needs more is drawn in bands"},
    {"load_s", EWA_OPTION_F64, offsetof(ewa_lod_options, load_s), 0, 1e15, .unit = "s",
     .help = "time for reading nodes; what is missing then is drawn coarser; 0: as long as it takes"},
    {"share", EWA_OPTION_U32, offsetof(ewa_lod_options, share), 0, 0x1p20,
     .help = "part that a rank draws of what a renderer of several ranks shows"},
    {"share_count", EWA_OPTION_U32, offsetof(ewa_lod_options, share_count), 0, 0x1p20,
     .help = "of so many; 0: no parts"},
};

const ewa_option_table ewa_lod_options_table = EWA_OPTION_TABLE(ewa_lod_options, lod_rows);

void ewa_lod_options_init(ewa_lod_options *options, size_t struct_size) {
    ewa_options_init(&ewa_lod_options_table, options, struct_size);
}

/// A node of the picture.
typedef struct item {
    ewa_lod *lod;
    uint32_t node;
    double weight;
    bool hides;
    double spacing_px, offset_px; ///< of the node; from the picture's middle
    uint32_t first_row, end_row;  ///< of the picture that it may touch
} item;

/// What is known while nodes are chosen.
typedef struct chooser {
    const ewa_lod_scene *scene;
    ewa_lod *home; ///< the first octree, which keeps the list
    ewa_lod *lod;  ///< in which nodes are chosen
    const ewa_camera *camera;
    double to_camera[12]; ///< of the octree's space: rows of an affine map
    const ewa_lod_options *options;
    double scale; ///< camera units that a unit of the octree's space has at most
    double margin_px;
    bool loaded_only; ///< nodes that are not in memory are drawn by what represents them
    item *items;
    uint32_t item_count;
    uint32_t missing_count;
    ewa_status status;
} chooser;

/// A node before the camera.
typedef struct sight_of {
    bool seen;
    double spacing_px; ///< infinite: the camera is in it
    double offset_px;
    uint32_t first_row, end_row;
} sight_of;

/// Rows and columns of the picture that a box in camera space may touch.
static sight_of look_at(const chooser *c, const ewa_lod_node *node) {
    const ewa_camera *camera = c->camera;
    const double *m = c->to_camera;
    const double reach = node->largest_radius_world * c->lod->look.radius_scale * c->scale;
    double at[3], half[3];
    for (int r = 0; r < 3; r++) {
        at[r] = m[4 * r + 3], half[r] = reach;
        for (int k = 0; k < 3; k++) {
            at[r] += m[4 * r + k] * (node->low_world[k] + node->side_world / 2);
            half[r] += fabs(m[4 * r + k]) * node->side_world / 2;
        }
    }
    sight_of s = {.seen = false, .spacing_px = INFINITY, .end_row = camera->height_px};
    const double near_z = at[2] - half[2], far_z = at[2] + half[2];
    if (far_z <= 0) return s;
    const double focal_px[2] = {camera->fx_px, camera->fy_px}, center_px[2] = {camera->cx_px, camera->cy_px};
    const double size_px[2] = {camera->width_px, camera->height_px};
    const double spacing = node->spacing_world * c->scale;
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

/// Share of a node's children in what is drawn of it.
static double share_of_children(const chooser *c, const ewa_lod_node *node, double spacing_px) {
    if (!node->divided) return 0;
    if (c->options->error == 0) return 1;
    const double measure = fmax(spacing_px / c->options->spacing_px,
                                node->error * (spacing_px / ERROR_SPACING_PX) / c->options->error);
    const double share = (measure - FADE_FROM) / (1 - FADE_FROM);
    return share > 0 ? (share < 1 ? share : 1) : 0;
}

static void add_item(chooser *c, uint32_t node, double weight, bool hides, const sight_of *s) {
    ewa_buffer *buffer = &c->home->items;
    c->status =
        ewa_buffer_grow(c->home->context, buffer, c->item_count, (size_t)c->item_count + 1, sizeof(item));
    if (c->status != EWA_OK) return;
    c->items = buffer->data;
    c->items[c->item_count++] =
        (item){c->lod, node, weight, hides, s->spacing_px, s->offset_px, s->first_row, s->end_row};
}

/// Whether a node can be drawn of what is in memory, by itself or by all of its children that are seen.
static bool is_loaded(const chooser *c, uint32_t index) { return c->lod->nodes[index].surfels != NULL; }

/// Whether all children of a node that are seen are in memory.
static bool children_are_loaded(const chooser *c, const ewa_lod_node *node) {
    for (int i = 0; i < 8; i++) {
        if (node->children[i] == EWA_NO_NODE || is_loaded(c, node->children[i])) continue;
        if (look_at(c, &c->lod->nodes[node->children[i]]).seen) return false;
    }
    return true;
}

static void choose(chooser *c, uint32_t index, double weight) {
    const ewa_lod_node *node = &c->lod->nodes[index];
    const sight_of s = look_at(c, node);
    if (!s.seen || c->status != EWA_OK) return;
    double share = share_of_children(c, node, s.spacing_px);
    if (c->loaded_only && share > 0 && !children_are_loaded(c, node)) {
        c->missing_count++;
        share = 0;
    }
    // What represents parts is larger than they are: where these are drawn they say what is in front of what.
    if (share < 1) add_item(c, index, weight * (1 - share), share == 0, &s);
    for (int i = 0; i < 8 && share > 0; i++)
        if (node->children[i] != EWA_NO_NODE) choose(c, node->children[i], weight * share);
}

/// Lists each node that the picture wants with all of its ancestors, so that they can be read from the
/// coarsest on and every picture on the way shows all that is there.
static void choose_ways(chooser *c, uint32_t index) {
    const ewa_lod_node *node = &c->lod->nodes[index];
    const sight_of s = look_at(c, node);
    if (!s.seen || c->status != EWA_OK) return;
    add_item(c, index, 1, true, &s);
    if (share_of_children(c, node, s.spacing_px) > 0)
        for (int i = 0; i < 8; i++)
            if (node->children[i] != EWA_NO_NODE) choose_ways(c, node->children[i]);
}

/// Looks at an octree: cuts are made in its own space.
static void look_into(chooser *c, ewa_lod *lod) {
    const double *view = c->camera->world_to_camera, *place = lod->look.to_world;
    c->lod = lod;
    c->scale = vec3_length(vec3_load(&view[8])) * lod->stretch;
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 4; k++)
            c->to_camera[4 * r + k] = view[4 * r] * place[k] + view[4 * r + 1] * place[4 + k] +
                                      view[4 * r + 2] * place[8 + k] + (k == 3 ? view[4 * r + 3] : 0);
}

static ewa_status choose_nodes(chooser *c, bool loaded_only) {
    c->loaded_only = loaded_only;
    c->item_count = c->missing_count = 0;
    c->status = EWA_OK;
    for (uint32_t i = 0; i < c->scene->lod_count; i++) {
        look_into(c, c->scene->lods[i]);
        choose(c, 0, 1);
    }
    return c->status;
}

/// What is coarse comes first, then what is large and in the middle.
static int compare_urgency(const void *a, const void *b) {
    const item *p = a, *q = b;
    const double of_p = fmin(p->spacing_px, 1e9) / (1 + 1e-3 * p->offset_px),
                 of_q = fmin(q->spacing_px, 1e9) / (1 + 1e-3 * q->offset_px);
    if (of_p != of_q) return of_p > of_q ? -1 : 1;
    return p->node < q->node ? -1 : p->node > q->node;
}

/// Bytes of what is drawn of a node, about where it is not in memory.
static uint64_t bytes_of(const ewa_lod_node *node) {
    return node->surfels ? node->resident_bytes : node->count * BYTES_PER_SURFEL + 4096;
}

/// Bytes that all octrees of a picture but one keep.
static uint64_t bytes_beside(const ewa_lod_scene *scene, const ewa_lod *lod) {
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < scene->lod_count; i++)
        if (scene->lods[i] != lod) bytes += scene->lods[i]->resident_bytes + scene->lods[i]->cloud_bytes;
    return bytes;
}

static uint64_t less(uint64_t a, uint64_t b) { return a > b ? a - b : 0; }

/// Reads nodes for some time, the most urgent first.
static ewa_status load_some(chooser *c, double until_s, ewa_lod_stats *stats) {
    enum { STEP = 8 };
    c->loaded_only = false;
    c->item_count = 0;
    c->status = EWA_OK;
    for (uint32_t i = 0; i < c->scene->lod_count; i++) {
        look_into(c, c->scene->lods[i]);
        choose_ways(c, 0);
    }
    if (c->status != EWA_OK) return c->status;
    for (uint32_t i = 0; i < c->item_count; i++)
        c->items[i].lod->nodes[c->items[i].node].last_frame = c->items[i].lod->frame;
    qsort(c->items, c->item_count, sizeof *c->items, compare_urgency);
    uint32_t step[STEP], count = 0;
    ewa_lod *of_step = NULL;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < c->item_count && status == EWA_OK; i++) {
        ewa_lod *lod = c->items[i].lod;
        const uint32_t node = c->items[i].node;
        const uint64_t memory_bytes = less(c->options->memory_bytes, bytes_beside(c->scene, lod));
        if (count && of_step != lod) {
            EWA_TRY(ewa_tree_load(of_step, step, count, c->options->memory_bytes));
            count = 0;
            if (ewa_now_s() > until_s) return EWA_OK;
        }
        if (lod->nodes[node].surfels) continue;
        if (lod->resident_bytes + lod->cloud_bytes + bytes_of(&lod->nodes[node]) > memory_bytes) {
            ewa_tree_trim(lod, less(memory_bytes, bytes_of(&lod->nodes[node])));
            if (lod->resident_bytes + lod->cloud_bytes + bytes_of(&lod->nodes[node]) > memory_bytes) break;
        }
        of_step = lod;
        step[count++] = node;
        stats->loaded_count++;
        // The roots alone, so that there is something to draw.
        if (count < STEP && i >= c->scene->lod_count) continue;
        status = ewa_tree_load(lod, step, count, memory_bytes);
        count = 0;
        if (ewa_now_s() > until_s) return status;
    }
    if (status == EWA_OK && count) status = ewa_tree_load(of_step, step, count, c->options->memory_bytes);
    return status;
}

/// Reads the nodes of one octree that some items need, within the memory that there is; `all_bytes` is what
/// all octrees need.
static ewa_status load_items_of(ewa_lod *lod, const ewa_lod_scene *scene, const item *items, uint32_t count,
                                uint64_t all_bytes, uint64_t memory_bytes, ewa_lod_stats *stats) {
    ewa_status status = ewa_buffer_reserve(lod->context, &lod->wanted, count, sizeof(uint32_t));
    uint32_t *wanted = lod->wanted.data, wanted_count = 0;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        if (items[i].lod == lod && !lod->nodes[items[i].node].surfels) wanted[wanted_count++] = items[i].node;
    stats->loaded_count += wanted_count;
    if (status != EWA_OK || !all_bytes) return status;
    ewa_tree_trim(lod, less(memory_bytes, all_bytes + bytes_beside(scene, lod)));
    return wanted_count ? ewa_tree_load(lod, wanted, wanted_count, memory_bytes) : EWA_OK;
}

/// Reads nodes that some items need, within the memory that there is.
static ewa_status load_items(const ewa_lod_scene *scene, const item *items, uint32_t count,
                             uint64_t memory_bytes, ewa_lod_stats *stats) {
    uint64_t all_bytes = 0;
    for (uint32_t i = 0; i < count; i++) {
        ewa_lod_node *node = &items[i].lod->nodes[items[i].node];
        node->last_frame = items[i].lod->frame;
        if (!node->surfels) all_bytes += bytes_of(node);
    }
    for (uint32_t i = 0; i < scene->lod_count; i++)
        EWA_TRY(load_items_of(scene->lods[i], scene, items, count, all_bytes, memory_bytes, stats));
    return EWA_OK;
}

/// What was wanted before may go.
static void next_frame(const ewa_lod_scene *scene) {
    for (uint32_t i = 0; i < scene->lod_count; i++) scene->lods[i]->frame++;
}

/// Draws the rows [first, end) of the picture; other nodes than those that touch them take part by what is
/// known of them all together. `proxies` are those of all items, where there are several bands; else NULL.
static ewa_status draw_rows(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                            const ewa_render_options *options, const ewa_frame *frame, const item *items,
                            uint32_t count, ewa_surfels *const *proxies, uint32_t first_row, uint32_t end_row,
                            ewa_render_stats *stats) {
    uint64_t surfel_count = 0;
    for (uint32_t i = 0; i < count; i++) surfel_count += items[i].lod->nodes[items[i].node].count;
    for (uint32_t i = 0; i < scene->surfels_count; i++) surfel_count += scene->surfels[i]->count;
    ewa_renderer_set_tile(renderer, surfel_count > EWA_DENSE_SURFELS ? EWA_DENSE_TILE_PX : 0);
    EWA_TRY(ewa_render_begin(renderer, camera, options, frame));
    if (proxies) EWA_TRY(ewa_render_set_rows(renderer, first_row, end_row));
    for (uint32_t i = 0; i < count; i++) {
        const bool touches = items[i].first_row < end_row && items[i].end_row > first_row;
        const ewa_surfels *surfels =
            !proxies || touches ? items[i].lod->nodes[items[i].node].surfels : proxies[i];
        const ewa_render_source how = {items[i].weight, items[i].hides};
        EWA_TRY(ewa_render_add_source(renderer, surfels, &how));
    }
    for (uint32_t i = 0; i < scene->surfels_count; i++) EWA_TRY(ewa_render_add(renderer, scene->surfels[i]));
    return ewa_render_finish(renderer, stats);
}

/// Bytes of the nodes that touch some rows.
static uint64_t bytes_of_rows(const item *items, uint32_t count, uint32_t first_row, uint32_t end_row) {
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < count; i++)
        if (items[i].first_row < end_row && items[i].end_row > first_row)
            bytes += bytes_of(&items[i].lod->nodes[items[i].node]);
    return bytes;
}

/// Learns what all nodes are like that a picture needs, however few of them fit in memory at a time.
static ewa_status make_proxies(const ewa_lod_scene *scene, const item *items, uint32_t count,
                               uint64_t memory_bytes, ewa_surfels **proxies, ewa_lod_stats *stats) {
    for (uint32_t i = 0; i < count; i++) {
        next_frame(scene);
        EWA_TRY(load_items(scene, &items[i], 1, memory_bytes, stats));
        EWA_TRY(ewa_surfels_proxy(items[i].lod->nodes[items[i].node].surfels, &proxies[i]));
    }
    return EWA_OK;
}

/// Draws a picture whose nodes do not fit in memory together.
static ewa_status draw_bands(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                             const ewa_render_options *options, const ewa_frame *frame, const item *items,
                             uint32_t count, uint64_t memory_bytes, ewa_lod_stats *stats) {
    ewa_context *context = scene->lods[0]->context;
    ewa_surfels **proxies = ewa_allocate_zeroed(context, count, sizeof *proxies);
    item *touching = ewa_allocate(context, count, sizeof *touching);
    ewa_status status = proxies && touching ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = make_proxies(scene, items, count, memory_bytes, proxies, stats);
    for (uint32_t first = 0, end; first < camera->height_px && status == EWA_OK; first = end) {
        end = first + BAND_PX;
        while (end < camera->height_px && bytes_of_rows(items, count, first, end + BAND_PX) <= memory_bytes)
            end += BAND_PX;
        if (end > camera->height_px) end = camera->height_px;
        const uint64_t bytes = bytes_of_rows(items, count, first, end);
        if (bytes > memory_bytes) {
            status = ewa_fail(
                context, EWA_ERROR_LIMIT,
                "rows %u to %u of the picture need %llu bytes of nodes, more than the %llu that are allowed",
                first, end, (unsigned long long)bytes, (unsigned long long)memory_bytes);
            break;
        }
        uint32_t touching_count = 0;
        for (uint32_t i = 0; i < count; i++)
            if (items[i].first_row < end && items[i].end_row > first) touching[touching_count++] = items[i];
        next_frame(scene);
        status = load_items(scene, touching, touching_count, memory_bytes, stats);
        ewa_render_stats took = {0};
        if (status == EWA_OK)
            status =
                draw_rows(scene, renderer, camera, options, frame, items, count, proxies, first, end, &took);
        ewa_render_stats_add(&stats->render, &took);
        stats->band_count++;
    }
    for (uint32_t i = 0; proxies && i < count; i++) ewa_surfels_destroy(&proxies[i]);
    ewa_release(context, proxies, count, sizeof *proxies);
    ewa_release(context, touching, count, sizeof *touching);
    return status;
}

/// Keeps one part of the nodes, which are in an order in which neighbours are near each other: those whose
/// surfels begin in that part of all.
static ewa_status keep_share(chooser *c) {
    const ewa_lod_options *options = c->options;
    uint64_t all = 0, before = 0, bytes = 0;
    for (uint32_t i = 0; i < c->item_count; i++) all += c->items[i].lod->nodes[c->items[i].node].count;
    const uint64_t first = ewa_split(all, options->share_count, options->share),
                   end = ewa_split(all, options->share_count, options->share + 1);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->item_count; i++) {
        const ewa_lod_node *node = &c->items[i].lod->nodes[c->items[i].node];
        if (before >= first && before < end) {
            c->items[kept++] = c->items[i];
            bytes += bytes_of(node);
        }
        before += node->count;
    }
    c->item_count = kept;
    if (bytes <= options->memory_bytes) return EWA_OK;
    return ewa_fail(c->home->context, EWA_ERROR_LIMIT,
                    "part %u of %u of the picture needs %llu bytes of nodes, more than the %llu that are "
                    "allowed: more ranks or more memory each",
                    options->share + 1, options->share_count, (unsigned long long)bytes,
                    (unsigned long long)options->memory_bytes);
}

static ewa_status render(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                         const ewa_render_options *options, const ewa_lod_options *chosen,
                         const ewa_frame *frame, ewa_lod_stats *stats) {
    const double start_s = ewa_now_s();
    // Filters reach some pixels beyond a surfel.
    chooser c = {.scene = scene,
                 .home = scene->lods[0],
                 .camera = camera,
                 .options = chosen,
                 .margin_px = 16};
    next_frame(scene);
    ewa_status status = EWA_OK;
    if (chosen->load_s > 0) {
        status = load_some(&c, start_s + chosen->load_s, stats);
        stats->load_s = ewa_now_s() - start_s;
    }
    const double before_s = ewa_now_s();
    if (status == EWA_OK) status = choose_nodes(&c, chosen->load_s > 0);
    if (status == EWA_OK && chosen->share_count) status = keep_share(&c);
    EWA_TRY(status);
    stats->choose_s = ewa_now_s() - before_s;
    stats->missing_count = c.missing_count;
    stats->node_count = c.item_count;
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < c.item_count; i++) bytes += bytes_of(&c.items[i].lod->nodes[c.items[i].node]);
    if (bytes <= chosen->memory_bytes || chosen->load_s > 0) {
        const double load_from_s = ewa_now_s();
        status = load_items(scene, c.items, c.item_count, chosen->memory_bytes, stats);
        stats->load_s += ewa_now_s() - load_from_s;
        stats->band_count = 1;
        if (status == EWA_OK)
            status = draw_rows(scene, renderer, camera, options, frame, c.items, c.item_count, NULL, 0,
                               camera->height_px, &stats->render);
    } else {
        status = draw_bands(scene, renderer, camera, options, frame, c.items, c.item_count,
                            chosen->memory_bytes, stats);
    }
    for (uint32_t i = 0; i < c.item_count; i++)
        stats->surfel_count += c.items[i].lod->nodes[c.items[i].node].count;
    for (uint32_t i = 0; i < scene->lod_count; i++)
        stats->resident_bytes += scene->lods[i]->resident_bytes + scene->lods[i]->cloud_bytes;
    return status;
}

/// Draws surfels alone; of several ranks the part of this one.
static ewa_status render_surfels(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                                 const ewa_render_options *options, const ewa_frame *frame,
                                 ewa_render_stats *stats) {
    EWA_TRY(ewa_render_begin(renderer, camera, options, frame));
    for (uint32_t i = 0; i < scene->surfels_count; i++) EWA_TRY(ewa_render_add(renderer, scene->surfels[i]));
    return ewa_render_finish(renderer, stats);
}

/// Puts instances in the place of octrees that are there several times.
static ewa_status list_instances(ewa_lod_scene *scene) {
    if (!scene->lod_count) return EWA_OK;
    ewa_lod *home = scene->lods[0];
    EWA_TRY(ewa_buffer_reserve(home->context, &home->instances, scene->lod_count, sizeof(ewa_lod *)));
    ewa_lod **instances = home->instances.data;
    for (uint32_t i = 0; i < scene->lod_count; i++) {
        uint32_t number = 0;
        for (uint32_t k = 0; k < i; k++) number += scene->lods[k] == scene->lods[i];
        EWA_TRY(ewa_tree_instance(scene->lods[i], number, &instances[i]));
    }
    scene->lods = instances;
    return EWA_OK;
}

ewa_status ewa_lod_scene_draw(const ewa_lod_scene *scene, const ewa_lod_look *const *looks,
                              ewa_renderer *renderer, const ewa_camera *camera,
                              const ewa_render_options *options, const ewa_lod_options *lod_options,
                              const ewa_frame *frame, ewa_lod_stats *stats) {
    if (!scene || !renderer || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->lod_count ? scene->lods[0]->context : NULL; // that messages go to
    ewa_lod_options chosen;
    ewa_lod_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_lod_options_table, lod_options, &chosen));
    if (context) EWA_TRY(ewa_camera_check(context, camera));
    if (chosen.share_count && (chosen.share >= chosen.share_count || chosen.load_s > 0))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "lod: part %u of %u, or parts that a time limit makes",
                        chosen.share, chosen.share_count);
    ewa_lod_stats took = {.node_count = 0};
    // Surfels i are those of part i mod share_count; they are few.
    ewa_lod_scene own = *scene;
    const ewa_surfels *kept[MAX_SURFELS_SETS];
    if (chosen.share_count) {
        own.surfels = kept;
        own.surfels_count = 0;
        for (uint32_t i = chosen.share; i < scene->surfels_count; i += chosen.share_count) {
            if (own.surfels_count == MAX_SURFELS_SETS)
                return ewa_fail(context, EWA_ERROR_LIMIT, "lod: %u sets of surfels in %u parts",
                                scene->surfels_count, chosen.share_count);
            kept[own.surfels_count++] = scene->surfels[i];
        }
    }
    EWA_TRY(list_instances(&own));
    for (uint32_t i = 0; i < own.lod_count; i++)
        EWA_TRY(ewa_tree_set_look(own.lods[i], looks ? looks[i] : NULL));
    ewa_status status = EWA_OK;
    if (own.lod_count) {
        ewa_render_options plain;
        EWA_TRY(ewa_render_options_choose(context, options, &plain));
        plain.budget_s = 0;
        // Nodes are chosen so that their surfels are about as large as a pixel, or a part of one.
        if (plain.supersampling == 0) plain.supersampling = 1;
        chosen.spacing_px /= plain.supersampling;
        status = render(&own, renderer, camera, &plain, &chosen, frame, &took);
    } else {
        status = render_surfels(&own, renderer, camera, options, frame, &took.render);
    }
    if (stats) *stats = took;
    return status;
}

ewa_status ewa_lod_scene_render(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                                const ewa_render_options *options, const ewa_lod_options *lod_options,
                                const ewa_frame *frame, ewa_lod_stats *stats) {
    return ewa_lod_scene_draw(scene, NULL, renderer, camera, options, lod_options, frame, stats);
}

ewa_status ewa_lod_render(ewa_lod *lod, ewa_renderer *renderer, const ewa_camera *camera,
                          const ewa_render_options *options, const ewa_lod_options *lod_options,
                          const ewa_frame *frame, ewa_lod_stats *stats) {
    if (!lod) return EWA_ERROR_ARGUMENT;
    const ewa_lod_scene scene = {&lod, 1, 0, NULL};
    return ewa_lod_scene_render(&scene, renderer, camera, options, lod_options, frame, stats);
}
