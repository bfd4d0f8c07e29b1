// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects with sharp edges: blocks with boxes and round holes taken out, whose surfels have clip lines.
//
// The block is a lattice of boxes, some of them empty. A face is where a full box meets an empty one; its
// surfels stand on the nodes of a grid that has a row on every edge, so that kernels add up to about the same
// on an edge as inside (a row half a spacing away would leave half), and an edge cuts the kernels on it
// through the middle. A line cuts exactly where the box ends: one for an edge, two that must both hold for a
// convex corner, either for a concave one. Round holes cut faces along their tangents; their walls are cut at
// the rims.
//
// Based on M. Zwicker, J. Rasanen, M. Botsch, C. Dachsbacher, M. Pauly, "Perspective Accurate Splatting",
// 2004, sections 5 and 7, figures 4, 5 and 8.
#include "generate/solid.h"
#include "base/base.h"
#include "generate/generate.h"
#include "math/generate_number.h"

#include <math.h>
#include <string.h>

enum { NONE = -1 };

/// Kernels farther than this from a hole's edge, in cells, are left out of the faces.
#define HOLE_MARGIN 0.75

/// Cells along the circumference of the smallest hole that still make it round.
enum { MIN_HOLE_CELLS = 32 };

/// The grid along one axis: interval m of the lattice has start[m + 1] - start[m] cells.
typedef struct grid_axis {
    const double *at;
    uint32_t interval_count;
    uint32_t start[EWA_SOLID_MAX_BREAKS];
} grid_axis;

typedef struct solid_job {
    const ewa_generate_options *options;
    const ewa_solid_shape *shape;
    double spacing; ///< wanted, in units of size_world
    uint32_t reach; ///< cells that a kernel reaches beyond its own node
    grid_axis axes[3];
    uint64_t count;
    // All NULL while counting.
    float *position, *normal, *radius, *tangent[2], *clip[2];
    uint8_t *color, *clip_mode;
} solid_job;

/// One surfel in units of size_world; lines are for axes one radius_scale / cutoff of a cell long.
typedef struct solid_surfel {
    double position[3], normal[3], axis[2][3];
    double line[2][3];
    uint32_t line_count;
    bool either;
    float color[3];
} solid_surfel;

static const double cube_breaks[] = {-0.5, 0.5};
static const double part_x[] = {-0.5, 0.05, 0.25, 0.35, 0.5}, part_y[] = {-0.35, 0.1, 0.35},
                    part_z[] = {-0.2, 0, 0.2};

static const ewa_solid_shape cube_shape = {
    .breaks = {cube_breaks, cube_breaks, cube_breaks},
    .interval_count = {1, 1, 1},
};

static const ewa_solid_shape part_shape = {
    .breaks = {part_x, part_y, part_z},
    .interval_count = {4, 2, 2},
    .removed = {{{1, 0, 1}, {2, 2, 2}}, {{3, 1, 1}, {4, 2, 2}}},
    .removed_count = 2,
    .holes = {{2, {-0.225, 0}, 0.16, -0.2, 0.2}, {1, {-0.1, 0.395}, 0.05, -0.35, 0.35}},
    .hole_count = 2,
};

const ewa_solid_shape *ewa_solid_shape_of(ewa_object object) {
    return object == EWA_OBJECT_CUBE ? &cube_shape : object == EWA_OBJECT_CSG ? &part_shape : NULL;
}

static bool is_full(const ewa_solid_shape *shape, const int cell[3]) {
    for (int c = 0; c < 3; c++)
        if (cell[c] < 0 || cell[c] >= (int)shape->interval_count[c]) return false;
    for (uint32_t i = 0; i < shape->removed_count; i++) {
        const ewa_solid_box *box = &shape->removed[i];
        bool inside = true;
        for (int c = 0; c < 3; c++) inside &= cell[c] >= box->low[c] && cell[c] < box->end[c];
        if (inside) return false;
    }
    return true;
}

static uint32_t subdivide(double length, double spacing, uint32_t fewest) {
    const double cells = floor(length / spacing + 0.5);
    return cells < fewest ? fewest : (uint32_t)cells;
}

static void lay_axis(grid_axis *axis, const double *breaks, uint32_t interval_count, double spacing,
                     uint32_t reach) {
    *axis = (grid_axis){.at = breaks, .interval_count = interval_count};
    for (uint32_t m = 0; m < interval_count; m++)
        axis->start[m + 1] = axis->start[m] + subdivide(breaks[m + 1] - breaks[m], spacing, 2 * reach + 1);
}

/// The interval that a node starts or is in; the last node is in the last one.
static uint32_t interval_of(const grid_axis *axis, uint32_t node) {
    uint32_t m = 0;
    while (m + 1 < axis->interval_count && node >= axis->start[m + 1]) m++;
    return m;
}

static double cell_of(const grid_axis *axis, uint32_t m) {
    return (axis->at[m + 1] - axis->at[m]) / (axis->start[m + 1] - axis->start[m]);
}

/// A node of a grid axis as the faces see it.
typedef struct grid_node {
    double at, cell; ///< where it is, and the larger of the cells beside it
    int column[2];   ///< intervals below and above the break in reach, or twice its own
    double break_at; ///< where that break is
    bool touches[2]; ///< whether the node is on the closure of either interval
    bool has_break;
} grid_node;

static grid_node look_at_node(const grid_axis *axis, uint32_t node, uint32_t reach) {
    const uint32_t m = interval_of(axis, node);
    grid_node made = {.cell = cell_of(axis, m), .column = {(int)m, (int)m}, .touches = {true, true}};
    const double share = (double)(node - axis->start[m]) / (axis->start[m + 1] - axis->start[m]);
    made.at =
        node == axis->start[m + 1] ? axis->at[m + 1] : axis->at[m] + share * (axis->at[m + 1] - axis->at[m]);
    for (uint32_t b = m; b <= m + 1; b++) {
        const uint32_t start = axis->start[b];
        if ((node > start ? node - start : start - node) > reach) continue;
        made.has_break = true;
        made.break_at = axis->at[b];
        made.column[0] = (int)b - 1;
        made.column[1] = (int)b;
        made.touches[0] = node <= start;
        made.touches[1] = node >= start;
        if (node == start && b > 0) made.cell = fmax(made.cell, cell_of(axis, b - 1));
    }
    return made;
}

static void add_line(solid_surfel *surfel, double a, double b, double c) {
    const uint32_t k = surfel->line_count++;
    surfel->line[k][0] = a;
    surfel->line[k][1] = b;
    surfel->line[k][2] = c;
}

/// Keeps the lower (0) or upper (1) side of the break of axis u (0) or v (1).
static void add_break_line(solid_surfel *surfel, int axis, const grid_node *node, int side, double sigma) {
    const double slope = side ? 1 : -1, c = slope * (node->at - node->break_at) / sigma;
    add_line(surfel, axis == 0 ? slope : 0, axis == 1 ? slope : 0, c);
}

/// Sets the lines that the quadrants around the breaks in reach ask for; false when the node is on none that
/// is part of the face. `face[i][j]`: lower or upper side in u, in v.
static bool cut_by_quadrants(const bool face[2][2], const grid_node *u, const grid_node *v,
                             const double sigma[2], solid_surfel *surfel) {
    bool on_face = false;
    int count = 0, odd[2] = {0, 0};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            on_face |= face[i][j] && u->touches[i] && v->touches[j];
            count += face[i][j];
        }
    if (!on_face || count == 4) return on_face;
    if (face[0][0] == face[0][1] && face[1][0] == face[1][1]) {
        add_break_line(surfel, 0, u, face[1][0], sigma[0]);
    } else if (face[0][0] == face[1][0] && face[0][1] == face[1][1]) {
        add_break_line(surfel, 1, v, face[0][1], sigma[1]);
    } else {
        // One full quadrant: both lines have to hold; one empty quadrant: either line.
        const bool lone = count == 1;
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++)
                if (face[i][j] == lone) odd[0] = i, odd[1] = j;
        add_break_line(surfel, 0, u, lone ? odd[0] : !odd[0], sigma[0]);
        add_break_line(surfel, 1, v, lone ? odd[1] : !odd[1], sigma[1]);
        surfel->either = !lone;
    }
    return true;
}

/// How far a node of a face is outside of the nearest hole through it (negative inside), and that hole.
static double distance_from_holes(const solid_job *job, int axis, const grid_node *u, const grid_node *v,
                                  const ewa_solid_hole **nearest) {
    double minimum = INFINITY;
    for (uint32_t h = 0; h < job->shape->hole_count; h++) {
        const ewa_solid_hole *hole = &job->shape->holes[h];
        if (hole->axis != axis) continue;
        const double du = u->at - hole->center[0], dv = v->at - hole->center[1];
        const double outside = sqrt(du * du + dv * dv) - hole->radius;
        if (outside >= minimum) continue;
        minimum = outside;
        *nearest = hole;
    }
    return minimum;
}

/// The line along the tangent of a hole at the place nearest to a node.
static void add_tangent(solid_surfel *surfel, const ewa_solid_hole *hole, const grid_node *u,
                        const grid_node *v, const double sigma[2]) {
    const double du = u->at - hole->center[0], dv = v->at - hole->center[1],
                 distance = sqrt(du * du + dv * dv);
    add_line(surfel, sigma[0] * du / distance, sigma[1] * dv / distance, distance - hole->radius);
}

static void put(solid_job *job, const solid_surfel *surfel) {
    const uint64_t i = job->count++;
    if (!job->position) return;
    const double size = job->options->size_world, scale = size * job->options->radius_scale;
    const double cutoff = EWA_SOLID_CUTOFF;
    double longest = 0;
    for (int k = 0; k < 2; k++) {
        const double *axis = surfel->axis[k];
        longest = fmax(longest, sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]));
    }
    for (uint64_t c = 0; c < 3; c++) {
        job->position[3 * i + c] = (float)(size * surfel->position[c]);
        job->color[3 * i + c] = (uint8_t)(surfel->color[c] + 0.5f);
        if (job->normal) job->normal[3 * i + c] = (float)surfel->normal[c];
        for (int k = 0; k < 2 && job->clip_mode; k++) {
            job->tangent[k][3 * i + c] = (float)(scale / cutoff * surfel->axis[k][c]);
            job->clip[k][3 * i + c] = (float)surfel->line[k][c];
        }
    }
    if (job->radius) job->radius[i] = (float)(scale * longest);
    if (job->clip_mode) job->clip_mode[i] = surfel->either;
}

/// Colours of the cube's checks, taken just inside of the face; the part's outside is steel, its cuts copper.
static void color_surfel(const solid_job *job, int axis, int side, double u, double v, bool cut,
                         solid_surfel *surfel) {
    if (!job->position) return; // only counted
    static const float steel[3] = {176, 188, 198}, copper[3] = {222, 138, 96};
    if (job->shape != &cube_shape) {
        memcpy(surfel->color, cut ? copper : steel, sizeof steel);
        return;
    }
    ewa_generate_block block = {.count = 1, .patch = (uint32_t)(2 * axis + side)};
    const double inside = 1e-9;
    block.u[0] = fmin(fmax(u + 0.5, inside), 1 - inside);
    block.v[0] = fmin(fmax(v + 0.5, inside), 1 - inside);
    ewa_generate_cube(&block, job->options->checks);
    memcpy(surfel->color, block.color[0], sizeof block.color[0]);
}

/// Puts a surfel of a face, whose lines are set, on a node.
static void put_face_surfel(solid_job *job, int axis, int side, bool cut_in, const grid_node *u,
                            const grid_node *v, solid_surfel *surfel) {
    const int au = (axis + 1) % 3, av = (axis + 2) % 3;
    surfel->position[au] = u->at;
    surfel->position[av] = v->at;
    surfel->axis[0][au] = u->cell;
    surfel->axis[1][av] = v->cell;
    color_surfel(job, axis, side, u->at, v->at, cut_in, surfel);
    put(job, surfel);
}

/// One node of the grid on plane `plane` of `axis`, seen from its lower (0) or upper (1) side.
static void put_face_node(solid_job *job, int axis, uint32_t plane, int side, const grid_node *u,
                          const grid_node *v) {
    const int au = (axis + 1) % 3, av = (axis + 2) % 3;
    bool face[2][2];
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            int cell[3];
            cell[au] = u->column[i];
            cell[av] = v->column[j];
            cell[axis] = (int)plane - side;
            const bool full = is_full(job->shape, cell);
            cell[axis] = (int)plane - 1 + side;
            face[i][j] = full && !is_full(job->shape, cell);
        }
    const double per_cell = job->options->radius_scale / EWA_SOLID_CUTOFF;
    const double sigma[2] = {per_cell * u->cell, per_cell * v->cell};
    const bool cut_in = plane > 0 && plane < job->axes[axis].interval_count;
    solid_surfel surfel = {.line_count = 0};
    surfel.position[axis] = job->axes[axis].at[plane];
    surfel.normal[axis] = side ? 1 : -1;
    if (!cut_by_quadrants((const bool(*)[2])face, u, v, sigma, &surfel)) return;
    const ewa_solid_hole *hole = NULL;
    const double reach = job->options->radius_scale * fmax(u->cell, v->cell);
    if (surfel.line_count || distance_from_holes(job, axis, u, v, &hole) > reach) {
        put_face_surfel(job, axis, side, cut_in, u, v, &surfel);
        return;
    }
    // Tangents of a small hole leave its edge within a cell: four surfels half as large stay closer to it.
    const double half[2] = {sigma[0] / 2, sigma[1] / 2};
    for (int k = 0; k < 4; k++) {
        grid_node pu = *u, pv = *v;
        pu.cell /= 2, pv.cell /= 2;
        pu.at += k & 1 ? pu.cell / 2 : -pu.cell / 2;
        pv.at += k & 2 ? pv.cell / 2 : -pv.cell / 2;
        const double outside = distance_from_holes(job, axis, &pu, &pv, &hole);
        if (outside < -HOLE_MARGIN * fmax(pu.cell, pv.cell)) continue;
        solid_surfel part = surfel;
        if (outside < reach / 2) add_tangent(&part, hole, &pu, &pv, half);
        put_face_surfel(job, axis, side, cut_in, &pu, &pv, &part);
    }
}

static void put_faces(solid_job *job, int axis) {
    const grid_axis *gu = &job->axes[(axis + 1) % 3], *gv = &job->axes[(axis + 2) % 3];
    for (uint32_t plane = 0; plane <= job->axes[axis].interval_count; plane++)
        for (int side = 0; side < 2; side++)
            for (uint32_t j = 0; j <= gv->start[gv->interval_count]; j++) {
                const grid_node v = look_at_node(gv, j, job->reach);
                for (uint32_t i = 0; i <= gu->start[gu->interval_count]; i++) {
                    const grid_node u = look_at_node(gu, i, job->reach);
                    put_face_node(job, axis, plane, side, &u, &v);
                }
            }
}

/// The wall of a round hole: columns around, rows from rim to rim.
static void put_wall(solid_job *job, const ewa_solid_hole *hole) {
    const int axis = hole->axis, au = (axis + 1) % 3, av = (axis + 2) % 3;
    const double breaks[2] = {hole->low, hole->high}, around = 6.283185307179586 * hole->radius;
    const uint32_t columns = subdivide(around, job->spacing, MIN_HOLE_CELLS);
    const double width = around / columns;
    grid_axis rows;
    lay_axis(&rows, breaks, 1, job->spacing, job->reach);
    for (uint32_t j = 0; j <= rows.start[1]; j++) {
        const grid_node v = look_at_node(&rows, j, job->reach);
        const double sigma = job->options->radius_scale / EWA_SOLID_CUTOFF * v.cell;
        for (uint32_t i = 0; i < columns; i++) {
            solid_surfel surfel = {0};
            if (v.has_break) add_break_line(&surfel, 1, &v, v.column[0] < 0, sigma);
            double sine, cosine;
            ewa_generate_sincos((double)i / columns, &sine, &cosine);
            surfel.position[axis] = v.at;
            surfel.position[au] = hole->center[0] + hole->radius * cosine;
            surfel.position[av] = hole->center[1] + hole->radius * sine;
            surfel.normal[au] = -cosine;
            surfel.normal[av] = -sine;
            surfel.axis[0][au] = -sine * width;
            surfel.axis[0][av] = cosine * width;
            surfel.axis[1][axis] = v.cell;
            color_surfel(job, axis, 0, 0, 0, true, &surfel);
            put(job, &surfel);
        }
    }
}

static void put_all(solid_job *job) {
    job->count = 0;
    for (int c = 0; c < 3; c++)
        lay_axis(&job->axes[c], job->shape->breaks[c], job->shape->interval_count[c], job->spacing,
                 job->reach);
    for (int axis = 0; axis < 3; axis++) put_faces(job, axis);
    for (uint32_t h = 0; h < job->shape->hole_count; h++) put_wall(job, &job->shape->holes[h]);
}

/// Finds the finest grid that has no more points than asked for; returns false when the coarsest has more.
static bool fit_spacing(solid_job *job) {
    // The surface is about 6 (cube) or 3.4 (part); a few steps make up for the rows on both ends.
    const double coarsest = 1;
    job->spacing = sqrt(6.0 / (double)job->options->point_count);
    for (;;) {
        put_all(job);
        if (job->count <= job->options->point_count) break;
        if (job->spacing > coarsest) return false;
        job->spacing *= sqrt((double)job->count / (double)job->options->point_count) * 1.0001;
    }
    // From above: closer while it still fits.
    for (double step = 0.25; step > 4e-3; step /= 2) {
        const double fits = job->spacing;
        job->spacing = fits * (1 - step);
        put_all(job);
        if (job->count > job->options->point_count) job->spacing = fits;
    }
    put_all(job);
    return true;
}

static ewa_status add_streams(ewa_cloud *cloud, solid_job *job) {
    const bool surfels = !job->options->positions_only, sharp = surfels && job->options->sharp;
    void *data[9] = {NULL};
    const struct {
        const char *name;
        ewa_type type;
        uint32_t component_count;
        bool wanted;
    } streams[9] = {
        {EWA_POSITION, EWA_F32, 3, true},   {EWA_NORMAL, EWA_F32, 3, surfels},
        {EWA_COLOR, EWA_U8, 3, true},       {EWA_RADIUS, EWA_F32, 1, surfels && !sharp},
        {EWA_TANGENT_U, EWA_F32, 3, sharp}, {EWA_TANGENT_V, EWA_F32, 3, sharp},
        {EWA_CLIP0, EWA_F32, 3, sharp},     {EWA_CLIP1, EWA_F32, 3, sharp},
        {EWA_CLIP_MODE, EWA_U8, 1, sharp},
    };
    for (int i = 0; i < 9; i++) {
        if (!streams[i].wanted) continue;
        EWA_TRY(ewa_cloud_add(cloud, streams[i].name, streams[i].type, streams[i].component_count, &data[i]));
    }
    job->position = data[0];
    job->normal = data[1];
    job->color = data[2];
    job->radius = data[3];
    for (int k = 0; k < 2; k++) job->tangent[k] = data[4 + k], job->clip[k] = data[6 + k];
    job->clip_mode = data[8];
    return EWA_OK;
}

ewa_status ewa_generate_solid(ewa_context *context, const ewa_generate_options *options, ewa_cloud **made) {
    solid_job job = {.options = options, .shape = ewa_solid_shape_of(options->object)};
    if (options->radius_scale > EWA_SOLID_MAX_REACH)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "generate: radius_scale is %g, must be at most %d here",
                        options->radius_scale, EWA_SOLID_MAX_REACH);
    job.reach = (uint32_t)options->radius_scale;
    if (options->point_count == 0 || !fit_spacing(&job))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "generate: point_count is %llu; rows on every edge take at least %llu here",
                        (unsigned long long)options->point_count,
                        (unsigned long long)(options->point_count ? job.count : 1));
    EWA_TRY(ewa_progress(context, "generate", 0.5));
    EWA_TRY(ewa_cloud_create(context, job.count, made));
    EWA_TRY(add_streams(*made, &job));
    put_all(&job);
    return ewa_progress(context, "generate", 1);
}
