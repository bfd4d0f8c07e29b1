// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clip lines of discs near sharp edges: the nearest edge of the disc's smooth part gives the first line, the
// nearest that does not lie on that line the second.
//
// Based on M. Zwicker et al., "Perspective accurate splatting", 2004, section 4.
#include "mesh/clip.h"
#include "base/base.h"
#include "homogeneous/vec.h"

#include <string.h>

enum { NONE = UINT32_MAX };

/// An edge lies on a line that it leaves by less than this, in radii.
#define ON_LINE 0.05

/// An edge counts whose nearest place is no higher over the disc's plane, in radii, and whose triangle faces
/// the disc's way by this cosine.
#define MAX_HEIGHT 0.6
#define MIN_FACING 0.3

/// An edge within the disc, in the disc's plane.
typedef struct plane_edge {
    double from[2], to[2]; ///< what is left of it within the disc
    double line[3];        ///< unit normal inwards
    double distance;       ///< of the nearest place from the centre
    uint32_t index;
} plane_edge;

/// The bucket of a part's edges in a cell: discs see edges of their own part only, and of sheets that meet in
/// one edge, like the pages of a book, each may be a part.
static size_t bucket_of(const mesh_edge_grid *grid, const int64_t cell[3], uint32_t part) {
    uint64_t hash = part;
    for (int c = 0; c < 3; c++) {
        hash = (hash ^ (uint64_t)cell[c]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash & (grid->bucket_count - 1);
}

static int64_t cell_at(const mesh_edge_grid *grid, double place) {
    // Places farther away than numbers of cells go share the last one.
    return (int64_t)fmin(fmax(floor(place / grid->cell_world), -0x1p62), 0x1p62);
}

/// Calls for the buckets of all cells within reach of an edge: those of the boxes around places along it.
static void enter_edge(mesh_edge_grid *grid, uint32_t index, bool store) {
    const mesh_edge *edge = &grid->surface->edges[index];
    const uint32_t part = grid->surface->part[edge->triangle];
    const ewa_vec3 a = vec3_load(edge->a), b = vec3_load(edge->b);
    const double length = vec3_length(vec3_sub(b, a));
    const uint64_t steps = (uint64_t)(length / grid->reach_world) + 1;
    // Half a step to the next place along the edge, and the reach across it.
    const double margin = grid->reach_world + length / (double)(2 * steps);
    for (uint64_t s = 0; s < steps; s++) {
        const double along = ((double)s + 0.5) / (double)steps;
        double p[3];
        int64_t low[3], high[3], cell[3];
        vec3_store(vec3_add(vec3_scale(a, 1 - along), vec3_scale(b, along)), p);
        for (int c = 0; c < 3; c++) {
            low[c] = cell_at(grid, p[c] - margin);
            high[c] = cell_at(grid, p[c] + margin);
        }
        for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++)
            for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++)
                for (cell[0] = low[0]; cell[0] <= high[0]; cell[0]++) {
                    const size_t bucket = bucket_of(grid, cell, part);
                    if (store)
                        grid->edge[grid->first[bucket + 1]++] = index;
                    else
                        grid->first[bucket + 2]++, grid->entry_count++;
                }
    }
}

ewa_status ewa_mesh_edge_grid_make(const mesh_surface *surface, double reach_world, mesh_edge_grid *grid) {
    ewa_context *context = surface->context;
    *grid = (mesh_edge_grid){.surface = surface, .reach_world = reach_world, .cell_world = 3.5 * reach_world};
    if (!surface->edge_count) return EWA_OK;
    double steps = 0;
    for (uint32_t e = 0; e < surface->edge_count; e++)
        steps += vec3_length(vec3_sub(vec3_load(surface->edges[e].b), vec3_load(surface->edges[e].a))) /
                     reach_world +
                 1;
    if (!(steps < 4e8)) return ewa_fail(context, EWA_ERROR_LIMIT, "sample: edges are %.3g discs long", steps);
    grid->bucket_count = 64;
    while ((double)grid->bucket_count < steps) grid->bucket_count *= 2;
    grid->first = ewa_allocate_zeroed(context, grid->bucket_count + 2, sizeof *grid->first);
    if (!grid->first) return EWA_ERROR_MEMORY;
    for (uint32_t e = 0; e < surface->edge_count; e++) enter_edge(grid, e, false);
    grid->edge = ewa_allocate(context, grid->entry_count, sizeof *grid->edge);
    if (!grid->edge) {
        ewa_mesh_edge_grid_free(grid);
        return EWA_ERROR_MEMORY;
    }
    for (size_t b = 0; b < grid->bucket_count; b++) grid->first[b + 2] += grid->first[b + 1];
    for (uint32_t e = 0; e < surface->edge_count; e++) enter_edge(grid, e, true);
    return EWA_OK;
}

void ewa_mesh_edge_grid_free(mesh_edge_grid *grid) {
    if (!grid->surface || !grid->first) return;
    ewa_context *context = grid->surface->context;
    ewa_release(context, grid->first, grid->bucket_count + 2, sizeof *grid->first);
    ewa_release(context, grid->edge, grid->entry_count, sizeof *grid->edge);
    *grid = (mesh_edge_grid){0};
}

/// Puts an edge into the disc's plane; false when it is of another part or out of the disc.
static bool project(const mesh_surface *surface, const mesh_clip_disc *disc, uint32_t index,
                    plane_edge *made) {
    const mesh_edge *edge = &surface->edges[index];
    if (surface->part[edge->triangle] != disc->part) return false;
    const float *facing = surface->normal[edge->triangle];
    const ewa_vec3 center = vec3_load(disc->center), u = vec3_load(disc->u), v = vec3_load(disc->v),
                   n = vec3_load(disc->normal);
    if (vec3_dot(vec3_make((double)facing[0], (double)facing[1], (double)facing[2]), n) < MIN_FACING)
        return false;
    const ewa_vec3 a = vec3_sub(vec3_load(edge->a), center), b = vec3_sub(vec3_load(edge->b), center),
                   inward = vec3_load(edge->inward);
    const double from[2] = {vec3_dot(a, u), vec3_dot(a, v)}, to[2] = {vec3_dot(b, u), vec3_dot(b, v)};
    const double along[2] = {to[0] - from[0], to[1] - from[1]};
    const double length2 = along[0] * along[0] + along[1] * along[1];
    if (!(length2 > 0)) return false;
    // Where the line through the edge meets the circle: s of from + s along.
    const double middle = -(from[0] * along[0] + from[1] * along[1]) / length2;
    const double cross = from[0] * along[1] - from[1] * along[0];
    const double half2 =
        disc->radius_world * disc->radius_world / length2 - cross * cross / (length2 * length2);
    if (!(half2 > 0)) return false;
    const double low = fmax(0, middle - sqrt(half2)), high = fmin(1, middle + sqrt(half2));
    if (!(low <= high)) return false;
    const double nearest = fmin(fmax(middle, 0), 1);
    const double height = vec3_dot(a, n) * (1 - nearest) + vec3_dot(b, n) * nearest;
    if (fabs(height) > MAX_HEIGHT * disc->radius_world) return false;
    for (int c = 0; c < 2; c++) {
        made->from[c] = from[c] + low * along[c];
        made->to[c] = from[c] + high * along[c];
    }
    const double place[2] = {from[0] + nearest * along[0], from[1] + nearest * along[1]};
    made->distance = sqrt(place[0] * place[0] + place[1] * place[1]);
    const double side = vec3_dot(inward, u) * -along[1] + vec3_dot(inward, v) * along[0];
    const double scale = (side < 0 ? -1 : 1) / sqrt(length2);
    made->line[0] = -along[1] * scale;
    made->line[1] = along[0] * scale;
    made->line[2] = -(made->line[0] * from[0] + made->line[1] * from[1]);
    made->index = index;
    return true;
}

static double side_of(const double line[3], const double at[2]) {
    return line[0] * at[0] + line[1] * at[1] + line[2];
}

static bool lies_on(const double line[3], const plane_edge *edge, double tolerance) {
    return fabs(side_of(line, edge->from)) <= tolerance && fabs(side_of(line, edge->to)) <= tolerance;
}

/// The nearest edge in the disc, but for those on `line` (may be NULL). Of equally near ones the one that is
/// farther to the inside of its line, then the first.
static bool find_nearest(const mesh_edge_grid *grid, const mesh_clip_disc *disc, size_t bucket,
                         const double *line, plane_edge *nearest) {
    bool found = false;
    for (uint32_t i = grid->first[bucket]; i < grid->first[bucket + 1]; i++) {
        plane_edge edge;
        if (!project(grid->surface, disc, grid->edge[i], &edge)) continue;
        if (line && lies_on(line, &edge, ON_LINE * disc->radius_world)) continue;
        if (found && (edge.distance > nearest->distance ||
                      (edge.distance == nearest->distance && edge.index >= nearest->index)))
            continue;
        *nearest = edge;
        found = true;
    }
    return found;
}

void ewa_mesh_clip_disc(const mesh_edge_grid *grid, mesh_clip_disc *disc) {
    memset(disc->line, 0, sizeof disc->line);
    disc->either = false;
    if (!grid->entry_count) return;
    int64_t cell[3];
    for (int c = 0; c < 3; c++) cell[c] = cell_at(grid, disc->center[c]);
    const size_t bucket = bucket_of(grid, cell, disc->part);
    plane_edge first, second;
    if (!find_nearest(grid, disc, bucket, NULL, &first)) return;
    // A centre beyond its line is the work of a curved part or of an edge that ends: it is left alone.
    const double slack = -ON_LINE * disc->radius_world, center[2] = {0, 0};
    const bool has_second = find_nearest(grid, disc, bucket, first.line, &second);
    if (has_second) {
        const double middle1[2] = {(first.from[0] + first.to[0]) / 2, (first.from[1] + first.to[1]) / 2};
        const double middle2[2] = {(second.from[0] + second.to[0]) / 2, (second.from[1] + second.to[1]) / 2};
        const bool inside1 = side_of(first.line, middle2) >= 0, inside2 = side_of(second.line, middle1) >= 0;
        const double side1 = side_of(first.line, center), side2 = side_of(second.line, center);
        disc->either = !inside1 && !inside2;
        const bool keeps_center = disc->either ? fmax(side1, side2) >= slack : fmin(side1, side2) >= slack;
        if (inside1 == inside2 && keeps_center) {
            memcpy(disc->line[0], first.line, sizeof first.line);
            memcpy(disc->line[1], second.line, sizeof second.line);
            return;
        }
        disc->either = false;
    }
    if (side_of(first.line, center) >= slack) memcpy(disc->line[0], first.line, sizeof first.line);
}
