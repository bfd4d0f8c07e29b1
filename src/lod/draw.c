// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A picture of an octree: what has to be read for it, and in which bands it is drawn.
#include "base/base.h"
#include "base/options.h"
#include "lod/cut.h"
#include "lod/reading.h"
#include "lod/tree.h"
#include "surface/levels.h"
#include "surface/options.h"
#include "surface/packets.h"
#include "surface/proxy.h"
#include "surface/render.h"
#include "surface/supersampling.h"

#include <math.h>
#include <string.h>

enum {
    BAND_PX = 128,
    MAX_SURFELS_SETS = 1024, // of a picture's sets, of one part of it
};

static const ewa_option lod_rows[] = {
    {"spacing_px", EWA_OPTION_F64, offsetof(ewa_lod_options, spacing_px), 0, 64, EWA_OPTION_ABOVE,
     .initial = 1, .unit = "px",
     .help = "nodes are drawn by surfels that represent their points where these are no farther apart"},
    {"error", EWA_OPTION_F64, offsetof(ewa_lod_options, error), 0, 255, .initial = 3,
     .help = "and expected to be off by no more than so much, rms, in 1/255; 0: all points"},
    {"memory_bytes", EWA_OPTION_U64, offsetof(ewa_lod_options, memory_bytes), 0x1p24, 0x1p50,
     .initial = 0x1p30, .unit = "bytes",
     .help = "memory for nodes; a picture that needs more is drawn in bands; and for streamed Gaussians, coarser ones where it needs more"},
    {"load_s", EWA_OPTION_F64, offsetof(ewa_lod_options, load_s), 0, 1e15, .unit = "s",
     .help = "time for reading nodes; what is missing then is drawn coarser; 0: as long as it takes"},
    {"share", EWA_OPTION_U32, offsetof(ewa_lod_options, share), 0, 0x1p20,
     .help = "part that a rank draws of what a renderer of several ranks shows"},
    {"share_count", EWA_OPTION_U32, offsetof(ewa_lod_options, share_count), 0, 0x1p20,
     .help = "of so many; 0: no parts"},
    {"max_splats", EWA_OPTION_U64, offsetof(ewa_lod_options, max_splats), 0, 0x1p53,
     .help = "about so many surfels and points are drawn of octrees, coarser ones where it would be more; 0: 8 for each pixel "
             "that they cover"},
    {"resident_only", EWA_OPTION_BOOL, offsetof(ewa_lod_options, resident_only),
     .help = "nothing is read: nodes that are not in memory are drawn coarser and counted as missing"},
};

const ewa_option_table ewa_lod_options_table = EWA_OPTION_TABLE(ewa_lod_options, lod_rows);

void ewa_lod_options_init(ewa_lod_options *options, size_t struct_size) {
    ewa_options_init(&ewa_lod_options_table, options, struct_size);
}

static uint64_t less(uint64_t a, uint64_t b) { return a > b ? a - b : 0; }

/// Reads nodes for some time, the most urgent first.
static ewa_status load_some(ewa_cut *c, double until_s, ewa_lod_stats *stats) {
    enum { STEP = 8 };
    EWA_TRY(ewa_cut_list_urgent(c));
    uint32_t step[STEP], count = 0;
    ewa_lod *of_step = NULL;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < c->item_count && status == EWA_OK; i++) {
        ewa_lod *lod = c->items[i].lod;
        const uint32_t node = c->items[i].node;
        const uint64_t memory_bytes = less(c->options->memory_bytes, ewa_cut_bytes_beside(c->scene, lod));
        if (count && of_step != lod) {
            EWA_TRY(ewa_tree_load(of_step, step, count, c->options->memory_bytes));
            count = 0;
            if (ewa_now_s() > until_s) return EWA_OK;
        }
        if (lod->nodes[node].surfels) continue;
        if (!ewa_tree_make_room(lod, node, memory_bytes)) break;
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
static ewa_status load_items_of(ewa_lod *lod, const ewa_lod_scene *scene, const ewa_cut_item *items, uint32_t count,
                                uint64_t all_bytes, uint64_t memory_bytes, ewa_lod_stats *stats) {
    ewa_status status = ewa_buffer_reserve(lod->context, &lod->wanted, count, sizeof(uint32_t));
    uint32_t *wanted = lod->wanted.data, wanted_count = 0;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        if (items[i].lod == lod && !lod->nodes[items[i].node].surfels) wanted[wanted_count++] = items[i].node;
    stats->loaded_count += wanted_count;
    if (status != EWA_OK || !all_bytes) return status;
    ewa_tree_trim(lod, less(memory_bytes, all_bytes + ewa_cut_bytes_beside(scene, lod)));
    return wanted_count ? ewa_tree_load(lod, wanted, wanted_count, memory_bytes) : EWA_OK;
}

/// Reads nodes that some items need, within the memory that there is.
static ewa_status load_items(const ewa_lod_scene *scene, const ewa_cut_item *items, uint32_t count,
                             uint64_t memory_bytes, ewa_lod_stats *stats) {
    uint64_t all_bytes = 0;
    for (uint32_t i = 0; i < count; i++) {
        ewa_lod_node *node = &items[i].lod->nodes[items[i].node];
        node->last_frame = items[i].lod->frame;
        if (!node->surfels) all_bytes += ewa_tree_bytes_of(node);
    }
    for (uint32_t i = 0; i < scene->lod_count; i++)
        EWA_TRY(load_items_of(scene->lods[i], scene, items, count, all_bytes, memory_bytes, stats));
    return EWA_OK;
}

/// Draws the rows [first, end) of the picture; other nodes than those that touch them take part by what is
/// known of them all together. `proxies` are those of all items, where there are several bands; else NULL.
static ewa_status draw_rows(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                            const ewa_render_options *options, const ewa_frame *frame, const ewa_cut_item *items,
                            uint32_t count, ewa_surfels *const *proxies, uint32_t first_row, uint32_t end_row,
                            ewa_render_stats *stats) {
    uint64_t surfel_count = 0;
    for (uint32_t i = 0; i < count; i++) surfel_count += ewa_cut_item_count(&items[i]);
    for (uint32_t i = 0; i < scene->surfels_count; i++) surfel_count += scene->surfels[i]->count;
    ewa_renderer_set_tile(renderer, surfel_count > EWA_DENSE_SURFELS ? EWA_DENSE_TILE_PX : 0);
    EWA_TRY(ewa_render_begin(renderer, camera, options, frame));
    if (proxies) EWA_TRY(ewa_render_set_rows(renderer, first_row, end_row));
    for (uint32_t i = 0; i < count; i++) {
        const bool touches = items[i].first_row < end_row && items[i].end_row > first_row;
        const ewa_surfels *surfels =
            !proxies || touches ? items[i].lod->nodes[items[i].node].surfels : proxies[i];
        const ewa_render_source how = {items[i].weight, items[i].hides};
        uint32_t level = items[i].level;
        EWA_TRY(ewa_render_add_source(renderer, ewa_levels_find(surfels, &level), &how));
    }
    for (uint32_t i = 0; i < scene->surfels_count; i++) EWA_TRY(ewa_render_add(renderer, scene->surfels[i]));
    return ewa_render_finish(renderer, stats);
}

/// Bytes of the nodes that touch some rows.
static uint64_t bytes_of_rows(const ewa_cut_item *items, uint32_t count, uint32_t first_row, uint32_t end_row) {
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < count; i++)
        if (items[i].first_row < end_row && items[i].end_row > first_row)
            bytes += ewa_tree_bytes_of(&items[i].lod->nodes[items[i].node]);
    return bytes;
}

/// Learns what all nodes are like that a picture needs, however few of them fit in memory at a time.
static ewa_status make_proxies(const ewa_lod_scene *scene, const ewa_cut_item *items, uint32_t count,
                               uint64_t memory_bytes, ewa_surfels **proxies, ewa_lod_stats *stats) {
    for (uint32_t i = 0; i < count; i++) {
        ewa_cut_next_frame(scene);
        EWA_TRY(load_items(scene, &items[i], 1, memory_bytes, stats));
        EWA_TRY(ewa_surfels_proxy(items[i].lod->nodes[items[i].node].surfels, &proxies[i]));
    }
    return EWA_OK;
}

/// Refuses a picture of which the nodes of some band do not fit in memory: before any is read.
static ewa_status check_bands(ewa_context *context, const ewa_cut_item *items, uint32_t count, uint32_t height_px,
                              uint64_t memory_bytes) {
    uint64_t maximum = 0;
    for (uint32_t first = 0; first < height_px; first += BAND_PX) {
        const uint64_t bytes = bytes_of_rows(items, count, first, first + BAND_PX);
        if (bytes > maximum) maximum = bytes;
    }
    if (maximum <= memory_bytes) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_LIMIT,
                    "%d rows of the picture need %llu bytes of nodes, more than the %llu that are allowed: with so many, or with "
                    "fewer pixels, a larger spacing of surfels or fewer of them (max_splats), it can be drawn",
                    BAND_PX, (unsigned long long)maximum, (unsigned long long)memory_bytes);
}

/// Draws a picture whose nodes do not fit in memory together.
static ewa_status draw_bands(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                             const ewa_render_options *options, const ewa_frame *frame, const ewa_cut_item *items,
                             uint32_t count, uint64_t memory_bytes, ewa_lod_stats *stats) {
    ewa_context *context = scene->lods[0]->context;
    EWA_TRY(check_bands(context, items, count, camera->height_px, memory_bytes));
    ewa_surfels **proxies = ewa_allocate_zeroed(context, count, sizeof *proxies);
    ewa_cut_item *touching = ewa_allocate(context, count, sizeof *touching);
    ewa_status status = proxies && touching ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = make_proxies(scene, items, count, memory_bytes, proxies, stats);
    for (uint32_t first = 0, end; first < camera->height_px && status == EWA_OK; first = end) {
        end = first + BAND_PX;
        while (end < camera->height_px && bytes_of_rows(items, count, first, end + BAND_PX) <= memory_bytes)
            end += BAND_PX;
        if (end > camera->height_px) end = camera->height_px;
        uint32_t touching_count = 0;
        for (uint32_t i = 0; i < count; i++)
            if (items[i].first_row < end && items[i].end_row > first) touching[touching_count++] = items[i];
        ewa_cut_next_frame(scene);
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
static ewa_status keep_share(ewa_cut *c) {
    const ewa_lod_options *options = c->options;
    uint64_t all = 0, before = 0, bytes = 0;
    for (uint32_t i = 0; i < c->item_count; i++) all += ewa_cut_item_count(&c->items[i]);
    const uint64_t first = ewa_split(all, options->share_count, options->share),
                   end = ewa_split(all, options->share_count, options->share + 1);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->item_count; i++) {
        const ewa_lod_node *node = &c->items[i].lod->nodes[c->items[i].node];
        if (before >= first && before < end) {
            c->items[kept++] = c->items[i];
            bytes += ewa_tree_bytes_of(node);
        }
        before += ewa_cut_item_count(&c->items[i]);
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
    ewa_cut c;
    ewa_status status = ewa_cut_begin(&c, scene, camera, options, chosen);
    stats->coarser = c.coarser;
    const double settled_s = ewa_now_s() - start_s;
    if (status == EWA_OK && chosen->load_s > 0 && !chosen->resident_only) {
        status = load_some(&c, start_s + chosen->load_s, stats);
        stats->load_s = ewa_now_s() - start_s;
    }
    const double before_s = ewa_now_s();
    if (status == EWA_OK) status = ewa_cut_choose(&c, chosen->load_s > 0 || chosen->resident_only);
    if (status == EWA_OK && chosen->share_count) status = keep_share(&c);
    EWA_TRY(status);
    stats->choose_s = ewa_now_s() - before_s + settled_s;
    stats->missing_count = c.missing_count;
    stats->node_count = c.item_count;
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < c.item_count; i++) bytes += ewa_tree_bytes_of(&c.items[i].lod->nodes[c.items[i].node]);
    if (chosen->resident_only) {
        for (uint32_t i = 0; i < c.item_count; i++) c.items[i].lod->nodes[c.items[i].node].last_frame = c.items[i].lod->frame;
        stats->band_count = 1;
        status = draw_rows(scene, renderer, camera, options, frame, c.items, c.item_count, NULL, 0, camera->height_px,
                           &stats->render);
    } else if (bytes <= chosen->memory_bytes || chosen->load_s > 0) {
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
        stats->surfel_count += ewa_cut_item_count(&c.items[i]);
    for (uint32_t i = 0; i < scene->lod_count; i++)
        // Points are the business of who reads.
        stats->resident_bytes += scene->lods[i]->resident_bytes + (chosen->resident_only ? 0 : scene->lods[i]->cloud_bytes);
    return status;
}

/// Draws by nodes that are as fine as so many parts along a pixel's side; `stats` counts on.
static ewa_status render_divided(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                                 const ewa_render_options *options, const ewa_lod_options *chosen, uint32_t parts,
                                 const ewa_frame *frame, ewa_lod_stats *stats) {
    ewa_render_options own = *options;
    ewa_lod_options divided = *chosen;
    own.supersampling = parts;
    ewa_cut_divide(&divided, parts);
    ewa_lod_stats took = {.node_count = 0};
    EWA_TRY(render(scene, renderer, camera, &own, &divided, frame, &took));
    took.loaded_count += stats->loaded_count;
    took.surfel_count += stats->surfel_count;
    took.choose_s += stats->choose_s;
    took.load_s += stats->load_s;
    ewa_render_stats_add(&took.render, &stats->render);
    *stats = took;
    return EWA_OK;
}

static ewa_status render_by_parts(const ewa_lod_scene *scene, ewa_renderer *renderer, const ewa_camera *camera,
                                  const ewa_render_options *options, const ewa_lod_options *chosen, ewa_division parts,
                                  const ewa_frame *frame, ewa_lod_stats *stats) {
    if (!(parts.finer_share > 0)) return render_divided(scene, renderer, camera, options, chosen, parts.count, frame, stats);
    ewa_lod *home = scene->lods[0];
    ewa_frame_pair pair;
    EWA_TRY(ewa_frame_pair_reserve(home->context, &home->mixing, camera, frame, &pair));
    EWA_TRY(render_divided(scene, renderer, camera, options, chosen, parts.count, &pair.coarse, stats));
    EWA_TRY(render_divided(scene, renderer, camera, options, chosen, 2 * parts.count, &pair.fine, stats));
    ewa_frame_pair_mix(home->context, &pair, parts.finer_share, camera, 0, camera->height_px, frame);
    return EWA_OK;
}

/// Draws surfels alone; of several ranks the part of this one, while those of `all`, which each of them knows, say what parts pixels have.
static ewa_status render_surfels(const ewa_lod_scene *scene, const ewa_lod_scene *all, ewa_renderer *renderer,
                                 const ewa_camera *camera, const ewa_render_options *options, const ewa_frame *frame,
                                 ewa_render_stats *stats) {
    EWA_TRY(ewa_render_begin(renderer, camera, options, frame));
    if (all) ewa_render_choose_parts(renderer, all->surfels, all->surfels_count);
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

ewa_status ewa_lod_begin_picture(ewa_lod_scene *scene, const ewa_lod_appearance *const *appearances, const ewa_render_options *options,
                           ewa_render_options *plain) {
    EWA_TRY(list_instances(scene));
    for (uint32_t i = 0; i < scene->lod_count; i++) EWA_TRY(ewa_tree_set_appearance(scene->lods[i], appearances ? appearances[i] : NULL));
    EWA_TRY(ewa_render_options_choose(scene->lods[0]->context, options, plain));
    if (plain->budget_s > 0 && !plain->supersampling) plain->supersampling = 1;
    plain->budget_s = 0;
    return EWA_OK;
}

ewa_status ewa_lod_scene_draw(const ewa_lod_scene *scene, const ewa_lod_appearance *const *appearances,
                              ewa_renderer *renderer, const ewa_camera *camera,
                              const ewa_render_options *options, const ewa_lod_options *lod_options,
                              const ewa_frame *frame, ewa_lod_stats *stats) {
    if (!scene || !renderer || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->lod_count ? scene->lods[0]->context : NULL; // that messages go to
    ewa_lod_options chosen;
    ewa_lod_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_lod_options_table, lod_options, &chosen));
    if (context) EWA_TRY(ewa_camera_check(context, camera));
    if (chosen.share_count && (chosen.share >= chosen.share_count || chosen.load_s > 0 || chosen.resident_only))
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
    ewa_status status = EWA_OK;
    if (own.lod_count) {
        ewa_render_options plain;
        EWA_TRY(ewa_lod_begin_picture(&own, appearances, options, &plain));
        const ewa_lod_scene whole = {own.lods, own.lod_count, scene->surfels_count, scene->surfels};
        ewa_division parts;
        EWA_TRY(ewa_cut_choose_parts(&whole, camera, &plain, &chosen, &parts));
        status = render_by_parts(&own, renderer, camera, &plain, &chosen, parts, frame, &took);
    } else {
        status = render_surfels(&own, chosen.share_count ? scene : NULL, renderer, camera, options, frame, &took.render);
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
