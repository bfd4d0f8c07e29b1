// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which nodes a picture of octrees is drawn of, with which weights.
//
// A node represents its children while what is drawn of it lies no farther apart on the screen than it may, and is expected to be
// off by no more. From fifteen sixteenths of that on its children are drawn as well, with weights that grow to one as those of
// the node fall to zero: the picture, a quotient of sums, changes with the camera without a step. The finest
// that is drawn finds the nearest surfaces.
//
// Where that would be more surfels than the picture is to take, both bounds grow by one factor, the smallest by which it is no more.
// It is found on numbers of surfels that are continuous in the camera too, so that nothing pops by it: each node counts by its
// weight and by the part of its box that is in the picture.
#include "lod/cut.h"
#include "base/base.h"
#include "ewa/prepare.h"
#include "homogeneous/vec.h"
#include "surface/levels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Share of the spacing, or of the error, at which parts begin to show.
static const double FADE_FROM = 0.9375;

/// Pixels between surfels where errors are measured.
static const double ERROR_SPACING_PX = 0.5;

/// Surfels for each pixel, or part of one, that octrees cover, where nobody says how many: half of those that are promised, since boxes cover up to
/// twice what is in them, and what fades is drawn twice.
static const double SURFELS_PER_PIXEL = 4;

/// Surfels that a picture may take for parts of pixels, about: as many as one takes that octrees fill.
static const double SURFELS_FOR_PARTS = 0x1p19;

/// The most that the bounds grow by, and steps by which the factor is found, each of which halves its range.
static const double MAX_COARSER = 4096;
enum { FACTOR_STEPS = 24, COVER_CELLS = 256, COVER_CELL_PX = 16 };

/// A node before the camera.
typedef struct node_view {
    bool seen;
    double spacing_px; ///< infinite: the camera is in it
    double offset_px;
    double low_px[2], high_px[2]; ///< of its box, which the picture may cut
    uint32_t first_row, end_row;
} node_view;

/// Rows and columns of the picture that a box in camera space may touch.
static node_view view_node(const ewa_cut *c, const ewa_lod_node *node) {
    const ewa_camera *camera = c->camera;
    const double *m = c->to_camera;
    const double reach = node->largest_radius_world * c->lod->appearance.radius_scale * c->scale;
    double at[3], half[3];
    for (int r = 0; r < 3; r++) {
        at[r] = m[4 * r + 3], half[r] = reach;
        for (int k = 0; k < 3; k++) {
            at[r] += m[4 * r + k] * (node->box_low_world[k] + node->box_high_world[k]) / 2;
            half[r] += fabs(m[4 * r + k]) * (node->box_high_world[k] - node->box_low_world[k]) / 2;
        }
    }
    node_view s = {.seen = false, .spacing_px = INFINITY, .end_row = camera->height_px,
                  .high_px = {camera->width_px, camera->height_px}};
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
            s.low_px[k] = focal_px[k] * (perspective ? low / low_z : low) + center_px[k];
            s.high_px[k] = focal_px[k] * (perspective ? high / high_z : high) + center_px[k];
            low_px[k] = s.low_px[k] - c->margin_px, high_px[k] = s.high_px[k] + c->margin_px;
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

/// Levels of a root's surfels beside all of them; of a root that is not divided none.
static uint32_t root_levels(const ewa_cut *c) {
    const ewa_lod_node *root = c->lod->nodes;
    uint32_t level = 0;
    if (!root->divided) return 0;
    while (level + 1 < EWA_MAX_LEVELS && root->count >> 2 * (level + 1) >= EWA_LEVEL_MIN_SURFELS) level++;
    return level;
}

/// By how much what is drawn of a node is coarser than it may be.
static double coarseness_of(const ewa_cut *c, const ewa_lod_node *node, double spacing_px) {
    return fmax(spacing_px / c->options->spacing_px, node->error * (spacing_px / ERROR_SPACING_PX) / c->options->error);
}

/// Share of what is finer beside that.
static double share_beside(double coarseness, double coarser) {
    const double measure = coarseness / coarser;
    const double share = (measure - FADE_FROM) / (1 - FADE_FROM);
    return share > 0 ? (share < 1 ? share : 1) : 0;
}

/// Share of what is finer in what is drawn of a divided node: of its children, or of its surfels beside a level of these.
static double share_of_finer(const ewa_cut *c, const ewa_lod_node *node, double spacing_px, double coarser) {
    return c->options->error == 0 ? 1 : share_beside(coarseness_of(c, node, spacing_px), coarser);
}

/// Share of finer surfels of a root beside a level of them. By default no bound of surfels makes these coarser: what of a town is merged
/// so far is blurred, and has other colours than it has from far away.
static double share_of_level(const ewa_cut *c, uint32_t level, double spacing_px) {
    return share_of_finer(c, c->lod->nodes, ldexp(spacing_px, (int)level), c->options->max_splats ? c->coarser : 1);
}

/// Share of a node's children in what is drawn of it.
static double share_of_children(const ewa_cut *c, const ewa_lod_node *node, double spacing_px) {
    return node->divided ? share_of_finer(c, node, spacing_px, c->coarser) : 0;
}

static void add_item(ewa_cut *c, uint32_t node, uint32_t level, double weight, bool hides, const node_view *s) {
    ewa_buffer *buffer = &c->home->items;
    c->status =
        ewa_buffer_grow(c->home->context, buffer, c->item_count, (size_t)c->item_count + 1, sizeof(ewa_cut_item));
    if (c->status != EWA_OK) return;
    c->items = buffer->data;
    c->items[c->item_count++] =
        (ewa_cut_item){c->lod, node, level, weight, hides, ldexp(s->spacing_px, (int)level), s->offset_px, s->first_row, s->end_row};
}

/// Whether a node can be drawn of what is in memory, by itself or by all of its children that are seen.
static bool is_loaded(const ewa_cut *c, uint32_t index) { return c->lod->nodes[index].surfels != NULL; }

/// Whether all children of a node that are seen are in memory.
static bool children_are_loaded(const ewa_cut *c, const ewa_lod_node *node) {
    for (int i = 0; i < 8; i++) {
        if (node->children[i] == EWA_NO_NODE || is_loaded(c, node->children[i])) continue;
        if (view_node(c, &c->lod->nodes[node->children[i]]).seen) return false;
    }
    return true;
}

static void choose(ewa_cut *c, uint32_t index, double weight) {
    const ewa_lod_node *node = &c->lod->nodes[index];
    const node_view s = view_node(c, node);
    if (!s.seen || c->status != EWA_OK) return;
    double share = share_of_children(c, node, s.spacing_px);
    if (c->loaded_only && share > 0 && !children_are_loaded(c, node)) {
        c->missing_count++;
        share = 0;
    }
    // What represents parts is larger than they are: where these are drawn they say what is in front of what.
    if (share < 1) add_item(c, index, 0, weight * (1 - share), share == 0, &s);
    for (int i = 0; i < 8 && share > 0; i++)
        if (node->children[i] != EWA_NO_NODE) choose(c, node->children[i], weight * share);
}

/// Chooses from the root on: levels of its surfels represent it as it represents its children, where it is far away.
static void choose_all(ewa_cut *c) {
    const node_view s = view_node(c, c->lod->nodes);
    double weight = 1;
    for (uint32_t level = root_levels(c); level > 0 && s.seen && weight > 0; level--) {
        const double share = share_of_level(c, level, s.spacing_px);
        if (share < 1) add_item(c, 0, level, weight * (1 - share), share == 0, &s);
        weight *= share;
    }
    if (weight > 0) choose(c, 0, weight);
}

static void choose_with_ancestors(ewa_cut *c, uint32_t index) {
    const ewa_lod_node *node = &c->lod->nodes[index];
    const node_view s = view_node(c, node);
    if (!s.seen || c->status != EWA_OK) return;
    add_item(c, index, 0, 1, true, &s);
    if (share_of_children(c, node, s.spacing_px) > 0)
        for (int i = 0; i < 8; i++)
            if (node->children[i] != EWA_NO_NODE) choose_with_ancestors(c, node->children[i]);
}

/// Takes up an octree: cuts are made in its own space.
static void enter_octree(ewa_cut *c, ewa_lod *lod) {
    const double *view = c->camera->world_to_camera, *place = lod->appearance.to_world;
    c->lod = lod;
    c->scale = vec3_length(vec3_load(&view[8])) * lod->stretch;
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 4; k++)
            c->to_camera[4 * r + k] = view[4 * r] * place[k] + view[4 * r + 1] * place[4 + k] +
                                      view[4 * r + 2] * place[8 + k] + (k == 3 ? view[4 * r + 3] : 0);
}

ewa_status ewa_cut_list_with_ancestors(ewa_cut *c) {
    c->loaded_only = false;
    c->item_count = 0;
    c->status = EWA_OK;
    for (uint32_t i = 0; i < c->scene->lod_count; i++) {
        enter_octree(c, c->scene->lods[i]);
        choose_with_ancestors(c, 0);
    }
    return c->status;
}

ewa_status ewa_cut_choose(ewa_cut *c, bool loaded_only) {
    c->loaded_only = loaded_only;
    c->item_count = c->missing_count = 0;
    c->status = EWA_OK;
    for (uint32_t i = 0; i < c->scene->lod_count; i++) {
        enter_octree(c, c->scene->lods[i]);
        if (c->options->resident_only && !is_loaded(c, 0))
            c->missing_count++;
        else
            choose_all(c);
    }
    return c->status;
}

/// What is coarse comes first, then what is large and in the middle.
static int compare_urgency(const void *a, const void *b) {
    const ewa_cut_item *p = a, *q = b;
    const double of_p = fmin(p->spacing_px, 1e9) / (1 + 1e-3 * p->offset_px),
                 of_q = fmin(q->spacing_px, 1e9) / (1 + 1e-3 * q->offset_px);
    if (of_p != of_q) return of_p > of_q ? -1 : 1;
    return p->node < q->node ? -1 : p->node > q->node;
}

ewa_status ewa_cut_list_urgent(ewa_cut *c) {
    EWA_TRY(ewa_cut_list_with_ancestors(c));
    for (uint32_t i = 0; i < c->item_count; i++)
        c->items[i].lod->nodes[c->items[i].node].last_frame = c->items[i].lod->frame;
    if (c->item_count) qsort(c->items, c->item_count, sizeof *c->items, compare_urgency);
    return EWA_OK;
}

void ewa_cut_next_frame(const ewa_lod_scene *scene) {
    for (uint32_t i = 0; i < scene->lod_count; i++) scene->lods[i]->frame++;
}

uint64_t ewa_cut_bytes_beside(const ewa_lod_scene *scene, const ewa_lod *lod) {
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < scene->lod_count; i++)
        if (scene->lods[i] != lod) bytes += scene->lods[i]->resident_bytes + scene->lods[i]->cloud_bytes;
    return bytes;
}

// ---- The budget

/// A node of the finest cut or above it, as the picture has it.
typedef struct measured_node {
    double coarseness; ///< 0: it has no parts
    double part;       ///< of its box that is in the picture
    double count;      ///< of its surfels
    uint32_t end;      ///< of the list of what is below it, which follows
} measured_node;

/// Lists a node and what is below it in the finest cut.
static void measure_below(ewa_cut *c, uint32_t index, uint32_t *count) {
    const ewa_lod_node *node = &c->lod->nodes[index];
    const node_view s = view_node(c, node);
    if ((!s.seen && index) || c->status != EWA_OK) return;
    ewa_buffer *list = &c->home->measured;
    c->status = ewa_buffer_grow(c->home->context, list, *count, (size_t)*count + 1, sizeof(measured_node));
    if (c->status != EWA_OK) return;
    const uint32_t own = (*count)++;
    measured_node measured = {.coarseness = node->divided && s.seen ? coarseness_of(c, node, s.spacing_px) : 0};
    if (s.seen) {
        const double size_px[2] = {c->camera->width_px, c->camera->height_px};
        measured.part = 1, measured.count = (double)node->count;
        for (int k = 0; k < 2; k++) {
            const double whole = s.high_px[k] - s.low_px[k];
            const double seen = fmin(s.high_px[k], size_px[k]) - fmax(s.low_px[k], 0);
            if (whole > 0) measured.part *= fmin(fmax(seen / whole, 0), 1);
        }
    }
    for (int i = 0; i < 8 && share_beside(measured.coarseness, 1) > 0; i++)
        if (node->children[i] != EWA_NO_NODE) measure_below(c, node->children[i], count);
    if (c->status != EWA_OK) return;
    measured.end = *count;
    ((measured_node *)list->data)[own] = measured;
}

/// Surfels of the cut below a node, each node by its weight and by its part of the picture.
static double count_below(const measured_node *list, uint32_t index, double coarser) {
    const measured_node *node = &list[index];
    const double share = share_beside(node->coarseness, coarser);
    const double count = share < 1 ? (1 - share) * node->part * node->count : 0;
    double parts = 0;
    for (uint32_t i = index + 1; i < node->end && share > 0; i = list[i].end) parts += count_below(list, i, coarser);
    return count + share * parts;
}

/// Measures the nodes of all octrees, a root after the other.
static ewa_status measure_all(ewa_cut *c) {
    uint32_t count = 0;
    c->status = EWA_OK;
    for (uint32_t i = 0; i < c->scene->lod_count; i++) {
        enter_octree(c, c->scene->lods[i]);
        measure_below(c, 0, &count);
    }
    return c->status;
}

static double count_all(ewa_cut *c, double coarser) {
    const measured_node *list = c->home->measured.data;
    double count = 0;
    uint32_t root = 0;
    c->coarser = coarser;
    for (uint32_t i = 0; i < c->scene->lod_count; i++, root = list[root].end) {
        enter_octree(c, c->scene->lods[i]);
        const node_view s = view_node(c, c->lod->nodes);
        double weight = 1;
        for (uint32_t level = root_levels(c); level > 0 && s.seen; level--) {
            const double share = share_of_level(c, level, s.spacing_px);
            count += weight * (1 - share) * ldexp((double)c->lod->nodes->count, -2 * (int)level);
            weight *= share;
        }
        count += weight * count_below(list, root, coarser);
    }
    return count;
}

/// The picture in cells, each with the share of it that nodes cover.
typedef struct cover {
    uint32_t side_px, columns, rows;
    float *shares;
} cover;

/// Adds a box of the picture: a cell has the largest share of all.
static void add_box(const cover *to, const double low_px[2], const double high_px[2]) {
    const uint32_t cells[2] = {to->columns, to->rows};
    uint32_t first[2], end[2];
    for (int k = 0; k < 2; k++) {
        const double low = fmax(low_px[k] / to->side_px, 0), high = fmin(high_px[k] / to->side_px, cells[k]);
        if (!(low < high)) return;
        first[k] = (uint32_t)low;
        end[k] = (uint32_t)ceil(high);
    }
    for (uint32_t y = first[1]; y < end[1]; y++) {
        const double high = fmin(high_px[1] / to->side_px - y, 1) - fmax(low_px[1] / to->side_px - y, 0);
        for (uint32_t x = first[0]; x < end[0]; x++) {
            const double wide = fmin(high_px[0] / to->side_px - x, 1) - fmax(low_px[0] / to->side_px - x, 0);
            float *share = &to->shares[(size_t)y * to->columns + x];
            if ((float)(wide * high) > *share) *share = (float)(wide * high);
        }
    }
}

/// Adds the boxes of a node's parts, down to those that are as small as cells.
static void add_node(const ewa_cut *c, const cover *to, uint32_t index) {
    const ewa_lod_node *node = &c->lod->nodes[index];
    const node_view s = view_node(c, node);
    if (!s.seen) return;
    const double side_px = fmax(s.high_px[0] - s.low_px[0], s.high_px[1] - s.low_px[1]);
    bool parts = false;
    for (int i = 0; i < 8 && (side_px > to->side_px || isinf(s.spacing_px)); i++)
        if (node->children[i] != EWA_NO_NODE) {
            parts = true;
            add_node(c, to, node->children[i]);
        }
    if (!parts) add_box(to, s.low_px, s.high_px);
}

/// Finds how many pixels octrees cover, or somewhat more: their nodes do.
static ewa_status measure_cover(ewa_cut *c, double *pixels) {
    const uint32_t width_px = c->camera->width_px, height_px = c->camera->height_px;
    const uint32_t longest_px = width_px > height_px ? width_px : height_px;
    cover to = {.side_px = COVER_CELL_PX};
    while (to.side_px * COVER_CELLS < longest_px) to.side_px *= 2;
    to.columns = (width_px + to.side_px - 1) / to.side_px;
    to.rows = (height_px + to.side_px - 1) / to.side_px;
    const size_t count = (size_t)to.columns * to.rows;
    EWA_TRY(ewa_buffer_reserve(c->home->context, &c->home->cover, count, sizeof(float)));
    to.shares = c->home->cover.data;
    memset(to.shares, 0, count * sizeof(float));
    for (uint32_t i = 0; i < c->scene->lod_count; i++) {
        enter_octree(c, c->scene->lods[i]);
        add_node(c, &to, 0);
    }
    double cells = 0;
    for (size_t i = 0; i < count; i++) cells += (double)to.shares[i];
    *pixels = cells * to.side_px * to.side_px;
    return EWA_OK;
}

/// Finds how much coarser the picture has to be, so that it takes no more surfels than it may.
static ewa_status choose_coarseness(ewa_cut *c) {
    c->coarser = 1;
    if (c->options->error == 0) return EWA_OK;
    double limit = (double)c->options->max_splats, pixels;
    if (!c->options->max_splats) {
        EWA_TRY(measure_cover(c, &pixels));
        limit = SURFELS_PER_PIXEL * pixels * c->parts_per_pixel;
    }
    EWA_TRY(measure_all(c));
    double low = 1, high = MAX_COARSER;
    if (count_all(c, 1) <= limit) return EWA_OK;
    for (int i = 0; i < FACTOR_STEPS; i++) {
        const double middle = sqrt(low * high);
        if (count_all(c, middle) <= limit)
            high = middle;
        else
            low = middle;
    }
    c->coarser = high;
    const uint64_t fewest = c->options->max_splats && !c->home->fewest_reported ? count_all(c, high) : 0;
    if (fewest <= c->options->max_splats) return EWA_OK;
    c->home->fewest_reported = true;
    ewa_report(c->home->context, EWA_SEVERITY_NOTE,
               "octrees: %llu surfels and points are drawn, the fewest that there are; max_splats is %llu", (unsigned long long)fewest,
               (unsigned long long)c->options->max_splats);
    return EWA_OK;
}

static ewa_cut make_cut(const ewa_lod_scene *scene, const ewa_camera *camera, const ewa_lod_options *chosen) {
    // Filters reach some pixels beyond a surfel.
    return (ewa_cut){.scene = scene, .home = scene->lods[0], .camera = camera, .options = chosen, .coarser = 1, .margin_px = 16};
}

/// Adds the areas of what would be drawn of the finest parts. What has children is smaller than any part: its points are.
static ewa_status add_areas(ewa_cut *c, ewa_part_areas *areas) {
    enum { LARGEST_PX = 64 }; // the camera is in some
    EWA_TRY(ewa_cut_choose(c, false));
    for (uint32_t i = 0; i < c->item_count; i++) {
        const ewa_cut_item *it = &c->items[i];
        const double spacing_px = fmin(it->spacing_px, LARGEST_PX);
        const double radius_px = it->lod->nodes[it->node].divided ? 0 : EWA_DEFAULT_RADIUS_SCALE * spacing_px;
        ewa_part_areas_add(areas, radius_px, it->weight * (double)ewa_cut_item_count(it) * spacing_px * spacing_px);
    }
    uint64_t packet_count = 0;
    for (uint32_t i = 0; i < c->scene->surfels_count; i++) packet_count += c->scene->surfels[i]->packet_count;
    for (uint32_t i = 0; i < c->scene->surfels_count; i++)
        ewa_part_areas_add_surfels(areas, c->camera, c->scene->surfels[i], ewa_part_areas_step(packet_count));
    return EWA_OK;
}

ewa_status ewa_cut_choose_parts(const ewa_lod_scene *scene, const ewa_camera *camera, const ewa_render_options *options,
                                const ewa_lod_options *chosen, ewa_division *parts) {
    *parts = (ewa_division){.count = options->supersampling ? options->supersampling : 1};
    if (options->supersampling) return EWA_OK;
    ewa_lod_options finest = *chosen;
    ewa_cut_divide(&finest, EWA_MAX_SUPERSAMPLING);
    ewa_cut c = make_cut(scene, camera, &finest);
    double octaves = INFINITY;
    if (chosen->error > 0) {
        double pixels, limit = SURFELS_FOR_PARTS;
        EWA_TRY(measure_cover(&c, &pixels));
        if (chosen->max_splats) limit = fmin(limit, (double)chosen->max_splats);
        if (pixels > 0) octaves = log2(limit / (SURFELS_PER_PIXEL * pixels)) / 2;
        if (!(octaves > 0)) return EWA_OK;
    }
    ewa_part_areas areas = {.at = {0}};
    EWA_TRY(add_areas(&c, &areas));
    *parts = ewa_parts_for(fmin(octaves, ewa_part_areas_octaves(&areas)), camera);
    return EWA_OK;
}

ewa_status ewa_cut_begin(ewa_cut *c, const ewa_lod_scene *scene, const ewa_camera *camera, const ewa_render_options *options,
                         const ewa_lod_options *chosen) {
    *c = make_cut(scene, camera, chosen);
    c->parts_per_pixel = (double)options->supersampling * options->supersampling;
    ewa_cut_next_frame(scene);
    return choose_coarseness(c);
}
