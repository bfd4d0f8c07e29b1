// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which texels reach a tile, and as what they are drawn: a walk down a tree of blocks of texels, from coarse
// levels to fine ones, in a fixed order.
//
// All bounds are linear in texture coordinates before the division by w, so that nothing is cut at the
// horizon: an edge of the tile, pulled back, is a line of the texture, w is linear, and in the tile, w >= 1 /
// max(1 / w).
#include "texture/texture.h"

#include <math.h>

/// Area of a texel of a repeated texture, in square pixels, that is small enough whatever its shape.
static const double DENSE_PX2 = 1.0 / 256;

/// Nodes that a tile of a repeated texture may visit before the rest is drawn from the levels where it is:
/// only maps that squeeze a plane into a line get there.
enum { MAX_VISITS = 1 << 16, MAX_NEAR = 1 << 8, SPLAT_VISITS = 15 };

/// A tile, and what bounds the texels that reach it.
typedef struct tile_bounds {
    const ewa_texture_plan *plan;
    ewa_texture_brush *brush;
    double map[3][3];          ///< to pixels of the tile
    ewa_texture_line sides[6]; ///< of texture coordinates: a texel that reaches the tile is >= 0 on all
    uint32_t side_count;
    uint32_t visit_count, near_count;
    double disc;       ///< reach of a splat, in texels of its level
    double spacing[2]; ///< times w: most pixels from texel to texel along u and v, anywhere in the tile
    double low_w;      ///< smallest w of a texel whose centre is in the tile
    /// Distance from texel to texel along u and v, in pixels, times w^2: linear in v and u, respectively.
    double step_start[2][2], step_slope[2][2];
} tile_bounds;

/// A block of texels of a level; (u, v) is its first.
typedef struct node {
    uint32_t level_u, level_v;
    int64_t u, v;
} node;

static double largest_value(const ewa_texture_line *line, double u0, double u1, double v0, double v1) {
    return line->a * (line->a > 0 ? u1 : u0) + line->b * (line->b > 0 ? v1 : v0) + line->c;
}

static double length(double x, double y) { return sqrt(x * x + y * y); }

/// Maximum number of pixels from texel to texel along axis i, over texels with w >= `low_w` that are in the
/// tile and between `first` and `last` along the other axis.
static double spacing_bound(const tile_bounds *tile, int i, double first, double last, double low_w) {
    double maximum = 0;
    for (int end = 0; end < 2; end++) {
        const double at = end ? last : first;
        maximum = fmax(maximum, length(tile->step_start[i][0] + at * tile->step_slope[i][0],
                                       tile->step_start[i][1] + at * tile->step_slope[i][1]));
    }
    return fmin(tile->spacing[i], maximum / low_w) / low_w;
}

static void make_bounds(const ewa_texture_plan *plan, ewa_texture_brush *brush, uint32_t x, uint32_t y,
                        tile_bounds *tile) {
    *tile = (tile_bounds){.plan = plan, .brush = brush};
    for (int i = 0; i < 3; i++) {
        tile->map[i][0] = plan->map[i][0] - x * plan->map[i][2];
        tile->map[i][1] = plan->map[i][1] - y * plan->map[i][2];
        tile->map[i][2] = plan->map[i][2];
    }
    // A splat reaches no farther than its disc in the texture and the filter in the picture together.
    const ewa_texture_options *options = &plan->options;
    const double filter_px = options->cutoff * options->prefilter_px;
    tile->disc = options->method == EWA_TEXTURE_POINT ? 0 : options->cutoff * options->sigma_texels;
    const double low = -filter_px, high = EWA_TEXTURE_TILE + filter_px;
    const double(*m)[3] = (const double(*)[3])tile->map;
    ewa_texture_line *side = tile->sides;
    for (int c = 0; c < 2; c++) {
        *side++ =
            (ewa_texture_line){m[0][c] - low * m[0][2], m[1][c] - low * m[1][2], m[2][c] - low * m[2][2]};
        *side++ =
            (ewa_texture_line){high * m[0][2] - m[0][c], high * m[1][2] - m[1][c], high * m[2][2] - m[2][c]};
    }
    *side++ = (ewa_texture_line){m[0][2], m[1][2], m[2][2]};
    if (isfinite(plan->far_w)) *side++ = (ewa_texture_line){-m[0][2], -m[1][2], plan->far_w - m[2][2]};
    tile->side_count = (uint32_t)(side - tile->sides);
    // (u m0 + v m1 + m2) / w, derived by u: what depends on u cancels in the numerator.
    for (int c = 0; c < 2; c++) {
        for (int i = 0; i < 2; i++) {
            tile->step_start[i][c] = m[i][c] * m[2][2] - m[2][c] * m[i][2];
            tile->step_slope[i][c] = m[i][c] * m[1 - i][2] - m[1 - i][c] * m[i][2];
        }
    }
    double inverse_w = 0;
    for (int corner = 0; corner < 4; corner++) {
        const double px = corner & 1 ? high : low, py = corner & 2 ? high : low;
        for (int i = 0; i < 2; i++)
            tile->spacing[i] = fmax(tile->spacing[i], length(m[i][0] - px * m[i][2], m[i][1] - py * m[i][2]));
        inverse_w = fmax(inverse_w, (x + px) * plan->inverse[0][2] + (y + py) * plan->inverse[1][2] +
                                        plan->inverse[2][2]);
    }
    tile->low_w = inverse_w > 0 ? 1 / inverse_w : INFINITY;
}

static void add_weight(const tile_bounds *tile, int column, int row, double weight, const float color[4]) {
    const ewa_texture_sums *sums = &tile->brush->sums;
    const size_t place = (size_t)(row + 1) * EWA_TEXTURE_PITCH + (size_t)column + 1;
    for (int c = 0; c < 4; c++) sums->color[4 * place + c] += (float)weight * color[c];
    if (tile->plan->with_alpha) sums->weight[place] += (float)weight;
}

/// First and last of `count` cells whose middles are within `reach` of `center`.
static void cell_range(double center, double reach, int count, int range[2]) {
    range[0] = (int)fmin(fmax(ceil(center - reach - 0.5), 0), count);
    range[1] = (int)fmax(fmin(floor(center + reach - 0.5), count - 1), -1);
}

/// Adds the texels of a block whose discs are seen along rays: from each pixel back to the discs that it
/// sees.
static void draw_along_rays(const tile_bounds *tile, const ewa_texture_block *block, const node *at,
                            uint32_t x, uint32_t y) {
    const ewa_texture_plan *plan = tile->plan;
    const double reach = plan->options.cutoff * plan->options.sigma_texels;
    for (int row = 0; row < EWA_TEXTURE_TILE; row++) {
        for (int column = 0; column < EWA_TEXTURE_TILE; column++) {
            const double px = (double)x + column + 0.5, py = (double)y + row + 0.5;
            double p[3];
            for (int c = 0; c < 3; c++)
                p[c] = px * plan->inverse[0][c] + py * plan->inverse[1][c] + plan->inverse[2][c];
            if (!(p[2] > 0)) continue;
            int us[2], vs[2];
            cell_range(p[0] / p[2] - (double)at->u, reach, (int)block->width, us);
            cell_range(p[1] / p[2] - (double)at->v, reach, (int)block->height, vs);
            for (int v = vs[0]; v <= vs[1]; v++) {
                for (int u = us[0]; u <= us[1]; u++) {
                    ewa_texel_kernel kernel;
                    if (ewa_texel_place(plan, (double)at->u + u + 0.5, (double)at->v + v + 0.5, false,
                                        &kernel) &&
                        kernel.along_rays)
                        add_weight(tile, column, row, ewa_texel_weight(plan, &kernel, px, py),
                                   block->colors[v][u]);
                }
            }
        }
    }
}

/// Adds the texels of a block one after another: where the eye plane is so near that some are seen along
/// rays.
static void draw_near(const tile_bounds *tile, const ewa_texture_block *block, const node *at, uint32_t x,
                      uint32_t y) {
    const ewa_texture_plan *plan = tile->plan;
    bool along_rays = false;
    for (uint32_t j = 0; j < block->height; j++) {
        for (uint32_t i = 0; i < block->width; i++) {
            ewa_texel_kernel kernel;
            if (!ewa_texel_place(plan, (double)at->u + i + 0.5, (double)at->v + j + 0.5, false, &kernel))
                continue;
            tile->brush->counts.splat_count++;
            tile->brush->counts.texel_count++;
            along_rays = along_rays || kernel.along_rays;
            if (kernel.along_rays) continue;
            int columns[2], rows[2];
            cell_range(kernel.center_px[0] - x, kernel.half_px[0], EWA_TEXTURE_TILE, columns);
            cell_range(kernel.center_px[1] - y, kernel.half_px[1], EWA_TEXTURE_TILE, rows);
            for (int row = rows[0]; row <= rows[1]; row++)
                for (int column = columns[0]; column <= columns[1]; column++)
                    add_weight(
                        tile, column, row,
                        ewa_texel_weight(plan, &kernel, (double)x + column + 0.5, (double)y + row + 0.5),
                        block->colors[j][i]);
        }
    }
    if (along_rays) draw_along_rays(tile, block, at, x, y);
}

/// Draws the texels of a node, less those beyond the texture's end.
static void draw_node(const tile_bounds *tile, const node *at, bool as_points, bool near, uint32_t x,
                      uint32_t y) {
    const ewa_texture_plan *plan = tile->plan;
    ewa_texture_brush *brush = tile->brush;
    const ewa_texture_axis *axes = plan->axes;
    const uint32_t level_u = at->level_u < axes[0].stored_count ? at->level_u : axes[0].stored_count - 1;
    const uint32_t level_v = at->level_v < axes[1].stored_count ? at->level_v : axes[1].stored_count - 1;
    if (brush->wanted) {
        brush->wanted[level_u * EWA_TEXTURE_MAX_LEVELS + level_v] = 1;
        brush->spared_texels += EWA_TEXTURE_NODE_U * EWA_TEXTURE_NODE_V *
                                (axes[0].size[at->level_u] * axes[1].size[at->level_v] - 1);
        return;
    }
    ewa_texture_block *block = brush->block;
    const int64_t left_u = axes[0].count[at->level_u] - at->u, left_v = axes[1].count[at->level_v] - at->v;
    const bool whole = plan->options.repeat;
    block->width = !whole && left_u < EWA_TEXTURE_NODE_U ? (uint32_t)left_u : EWA_TEXTURE_NODE_U;
    block->height = !whole && left_v < EWA_TEXTURE_NODE_V ? (uint32_t)left_v : EWA_TEXTURE_NODE_V;
    const double size_u = axes[0].size[at->level_u], size_v = axes[1].size[at->level_v];
    ewa_texture_levels_read(plan, level_u, level_v, at->u, at->v, block);
    if (near) {
        draw_near(tile, block, at, x, y);
        return;
    }
    for (int c = 0; c < 3; c++) {
        const double step_u = size_u * tile->map[0][c], step_v = size_v * tile->map[1][c];
        block->step_u[c] = (float)step_u;
        block->step_v[c] = (float)step_v;
        const double first =
            ((double)at->u + 0.5) * step_u + ((double)at->v + 0.5) * step_v + tile->map[2][c];
        for (uint32_t j = 0; j < block->height; j++) block->row_start[j][c] = (float)(first + j * step_v);
    }
    block->area_scale = (float)((double)brush->filter.determinant * size_u * size_v);
    const uint32_t drawn =
        (as_points ? brush->kernels->points : brush->kernels->splats)(&brush->filter, block, &brush->sums);
    const uint64_t texels = (uint64_t)(drawn * size_u * size_v);
    *(as_points ? &brush->counts.point_count : &brush->counts.splat_count) += drawn;
    brush->counts.texel_count += texels;
    if (as_points) brush->counts.point_texel_count += texels;
}

static void visit(tile_bounds *tile, const node *at, uint32_t x, uint32_t y) {
    const ewa_texture_plan *plan = tile->plan;
    const ewa_texture_options *options = &plan->options;
    const ewa_texture_axis *axis_u = &plan->axes[0], *axis_v = &plan->axes[1];
    const double size[2] = {axis_u->size[at->level_u], axis_v->size[at->level_v]};
    const double u0 = (double)at->u * size[0], v0 = (double)at->v * size[1];
    double u1 = u0 + EWA_TEXTURE_NODE_U * size[0], v1 = v0 + EWA_TEXTURE_NODE_V * size[1];
    bool beyond_u = false, beyond_v = false; // part of the node is no whole texel of its level
    if (!options->repeat) {
        if (u0 >= plan->source.width_px || v0 >= plan->source.height_px) return;
        beyond_u = at->level_u > 0 && at->u + EWA_TEXTURE_NODE_U > axis_u->count[at->level_u];
        beyond_v = at->level_v > 0 && at->v + EWA_TEXTURE_NODE_V > axis_v->count[at->level_v];
        u1 = fmin(u1, plan->source.width_px);
        v1 = fmin(v1, plan->source.height_px);
    }
    for (uint32_t i = 0; i < tile->side_count; i++) {
        const ewa_texture_line *side = &tile->sides[i];
        const double reach = tile->disc * (fabs(side->a) * size[0] + fabs(side->b) * size[1]);
        if (largest_value(side, u0, u1, v0, v1) + reach < 0) return;
    }
    const ewa_texture_line minus_w = {-tile->map[0][2], -tile->map[1][2], -tile->map[2][2]};
    const double min_w = -largest_value(&minus_w, u0, u1, v0, v1);
    const double low_w = fmax(min_w, tile->low_w);
    tile->visit_count++;
    const double spacing_u = size[0] * spacing_bound(tile, 0, v0, v1, low_w);
    const double spacing_v = size[1] * spacing_bound(tile, 1, u0, u1, low_w);
    // Where a repeated texture is sheared so much that both axes stay long, coarse levels bound the work.
    const double area = plan->determinant * size[0] * size[1] / (low_w * low_w * low_w);
    const bool dense = options->repeat && (area <= DENSE_PX2 || tile->visit_count > MAX_VISITS);
    // Along each axis, a level is fine enough when its texels are minified, or when there is none below.
    const bool minified_u = !beyond_u && spacing_u <= options->point_spacing_px;
    const bool minified_v = !beyond_v && spacing_v <= options->point_spacing_px;
    const bool as_points = options->method == EWA_TEXTURE_POINT ||
                           (options->method == EWA_TEXTURE_HYBRID && minified_u && minified_v);
    const double support_w = EWA_TEXTURE_NEAR * options->cutoff * plan->tangent_w * fmax(size[0], size[1]);
    const bool near = !as_points && !(min_w > support_w), first = at->level_u == 0 && at->level_v == 0;
    const bool fine = dense || ((minified_u || at->level_u == 0) && (minified_v || at->level_v == 0));
    if (first || (fine && !near && !plan->flat)) {
        if (near && tile->near_count++ >= MAX_NEAR && options->repeat) return;
        if (!as_points) tile->visit_count += SPLAT_VISITS;
        draw_node(tile, at, as_points, near, x, y);
        return;
    }
    const bool split_u =
        at->level_u > 0 &&
        (at->level_v == 0 || (minified_u != minified_v ? minified_v : spacing_u >= spacing_v));
    const uint32_t children = split_u ? axis_u->factor[at->level_u] : axis_v->factor[at->level_v];
    for (uint32_t i = 0; i < children; i++) {
        const node child =
            split_u ? (node){at->level_u - 1, at->level_v, at->u * children + i * EWA_TEXTURE_NODE_U, at->v}
                    : (node){at->level_u, at->level_v - 1, at->u, at->v * children + i * EWA_TEXTURE_NODE_V};
        visit(tile, &child, x, y);
    }
}

void ewa_texture_walk(const ewa_texture_plan *plan, ewa_texture_brush *brush, uint32_t x, uint32_t y) {
    tile_bounds tile;
    make_bounds(plan, brush, x, y, &tile);
    const uint32_t level_u = plan->axes[0].level_count - 1, level_v = plan->axes[1].level_count - 1;
    if (!plan->options.repeat) {
        visit(&tile, &(node){level_u, level_v, 0, 0}, x, y);
        return;
    }
    for (int i = 0; i < 4; i++)
        visit(&tile,
              &(node){level_u, level_v, i & 1 ? 0 : -EWA_TEXTURE_NODE_U, i & 2 ? 0 : -EWA_TEXTURE_NODE_V}, x,
              y);
}
