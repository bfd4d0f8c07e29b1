// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Smooth parts and sharp edges of a triangle mesh: equal places are welded, half edges paired, triangles
// united over edges that do not bend; what is left between two parts is sharp.
#include "mesh/surface.h"
#include "base/base.h"
#include "cloud/mesh.h"

#include <stdlib.h>
#include <string.h>

/// Shortest loop of a border and smallest part that count, in spacings and spacings squared.
#define MIN_BORDER 4.0
#define MIN_PART   1.0

/// Two edges of a border that turn less go on: cosine of 20 degrees.
#define STRAIGHT_COSINE 0.9396926207859084

typedef struct half_edge {
    uint32_t far_vertex; ///< welded; the larger of the two
    uint32_t half;       ///< 3 triangle + corner it starts at
} half_edge;

typedef enum edge_kind { EDGE_SMOOTH = 0, EDGE_CREASE, EDGE_BORDER, EDGE_MANY } edge_kind;

/// An edge end at a vertex of a part.
typedef struct edge_end {
    uint32_t vertex, part, edge;
    uint32_t at_b;
} edge_end;

/// Everything that only the making needs.
typedef struct surface_job {
    mesh_surface *surface;
    uint32_t *weld; ///< by vertex of the mesh: the first vertex at its place
    uint32_t *first_half;
    half_edge *halves;
    uint32_t *mate; ///< by half edge: the other one, or none
    uint8_t *kind;  ///< edge_kind by half edge
    uint32_t *root;
    double *part_area;
    double spacing;
} surface_job;

enum { NONE = UINT32_MAX };

static uint32_t vertex_of(const mesh_surface *surface, uint32_t triangle, uint32_t corner) {
    return surface->mesh->triangles[3 * (size_t)surface->source[triangle] + corner];
}

static ewa_vec3 normal_of(const mesh_surface *surface, uint32_t triangle) {
    const float *n = surface->normal[triangle];
    return vec3_make((double)n[0], (double)n[1], (double)n[2]);
}

static double area_of(const mesh_surface *surface, uint32_t triangle) {
    return surface->area_below[triangle + 1] - surface->area_below[triangle];
}

static uint32_t find_root(uint32_t *root, uint32_t i) {
    while (root[i] != i) {
        root[i] = root[root[i]];
        i = root[i];
    }
    return i;
}

/// Unites two sets; the smaller root stays, so that the result does not depend on the order.
static uint32_t unite(uint32_t *root, uint32_t a, uint32_t b) {
    a = find_root(root, a);
    b = find_root(root, b);
    const uint32_t low = a < b ? a : b;
    root[a] = low;
    root[b] = low;
    return low;
}

/// Keeps the triangles with three different finite places that span an area, and finds their box.
static ewa_status keep_triangles(mesh_surface *surface) {
    const ewa_mesh *mesh = surface->mesh;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles + 3 * (size_t)t;
        ewa_vec3 p[3];
        for (int c = 0; c < 3; c++) {
            if (v[c] >= mesh->vertex_count)
                return ewa_fail(mesh->context, EWA_ERROR_ARGUMENT,
                                "sample: triangle %u has vertex %u, there are %u", t, v[c],
                                mesh->vertex_count);
            p[c] = vec3_load(mesh->positions + 3 * (size_t)v[c]);
        }
        ewa_vec3 normal = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        const double area = 0.5 * vec3_length(normal);
        if (!(area > 0) || !isfinite(area) || !vec3_normalize(&normal)) continue;
        const uint32_t kept = surface->triangle_count++;
        surface->source[kept] = t;
        surface->area_below[kept + 1] = surface->area_below[kept] + area;
        surface->normal[kept][0] = (float)normal.x;
        surface->normal[kept][1] = (float)normal.y;
        surface->normal[kept][2] = (float)normal.z;
        for (int c = 0; c < 3; c++) {
            const double xyz[3] = {p[c].x, p[c].y, p[c].z};
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], xyz[k]);
                high[k] = fmax(high[k], xyz[k]);
            }
        }
    }
    if (!surface->triangle_count)
        return ewa_fail(mesh->context, EWA_ERROR_NUMERIC, "sample: none of %u triangles has an area",
                        mesh->triangle_count);
    for (int k = 0; k < 3; k++) {
        surface->origin_world[k] = low[k];
        surface->extent_world[k] = high[k] - low[k];
    }
    const uint32_t dropped = mesh->triangle_count - surface->triangle_count;
    if (dropped)
        ewa_report(mesh->context, EWA_SEVERITY_INFO, "sample: %u of %u triangles have no area; left out",
                   dropped, mesh->triangle_count);
    return EWA_OK;
}

static int compare_halves(const void *a, const void *b) {
    const half_edge *x = a, *y = b;
    if (x->far_vertex != y->far_vertex) return x->far_vertex < y->far_vertex ? -1 : 1;
    return (x->half > y->half) - (x->half < y->half);
}

static void half_vertices(const surface_job *job, uint32_t half, uint32_t *from, uint32_t *to) {
    const uint32_t triangle = half / 3, corner = half % 3;
    *from = job->weld[vertex_of(job->surface, triangle, corner)];
    *to = job->weld[vertex_of(job->surface, triangle, (corner + 1) % 3)];
}

/// Sorts the half edges into one bucket per lower vertex, by their upper one.
static void sort_halves(const surface_job *job) {
    const mesh_surface *surface = job->surface;
    const uint32_t vertex_count = surface->mesh->vertex_count, half_count = 3 * surface->triangle_count;
    uint32_t *first = job->first_half;
    memset(first, 0, ((size_t)vertex_count + 2) * sizeof *first);
    for (uint32_t pass = 0; pass < 2; pass++) {
        for (uint32_t half = 0; half < half_count; half++) {
            uint32_t from, to;
            half_vertices(job, half, &from, &to);
            const uint32_t low = from < to ? from : to, high = from < to ? to : from;
            if (pass == 0)
                first[low + 2]++;
            else
                job->halves[first[low + 1]++] = (half_edge){high, half};
        }
        if (pass == 0)
            for (uint32_t v = 0; v < vertex_count; v++) first[v + 2] += first[v + 1];
    }
    for (uint32_t v = 0; v < vertex_count; v++)
        if (first[v + 1] - first[v] > 1)
            qsort(job->halves + first[v], first[v + 1] - first[v], sizeof *job->halves, compare_halves);
}

/// The welded vertex of a half edge's triangle that is not on the edge.
static uint32_t third_vertex(const surface_job *job, uint32_t half) {
    return job->weld[vertex_of(job->surface, half / 3, (half % 3 + 2) % 3)];
}

/// Pairs the four half edges of a sheet both of whose sides are there, as triangles that are turned the other way: each with that of its own
/// side. False where they are no such ones.
static bool pair_sides(surface_job *job, const half_edge halves[4]) {
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t from, to, mates = 0, copies = 0, mate = NONE;
        half_vertices(job, halves[i].half, &from, &to);
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t other_from, other_to;
            half_vertices(job, halves[k].half, &other_from, &other_to);
            if (other_from == from) continue;
            const bool copy = third_vertex(job, halves[k].half) == third_vertex(job, halves[i].half);
            copies += copy;
            mates += !copy;
            if (!copy) mate = halves[k].half;
        }
        if (mates != 1 || copies != 1) return false;
        job->mate[halves[i].half] = mate;
    }
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t half = halves[i].half;
        const double cosine = vec3_dot(normal_of(job->surface, half / 3), normal_of(job->surface, job->mate[half] / 3));
        job->kind[half] = cosine < job->surface->crease_cosine ? EDGE_CREASE : EDGE_SMOOTH;
    }
    return true;
}

/// Decides on one edge from all half edges that lie on it; true when there are more than two, or four of a sheet's sides.
static bool classify_edge(surface_job *job, const half_edge *halves, uint32_t count) {
    const mesh_surface *surface = job->surface;
    edge_kind kind = count == 1 ? EDGE_BORDER : EDGE_MANY;
    if (count == 4 && pair_sides(job, halves)) return false;
    for (uint32_t i = 0; i < count && count != 2; i++) job->mate[halves[i].half] = NONE;
    if (count == 2) {
        uint32_t from[2], to;
        half_vertices(job, halves[0].half, &from[0], &to);
        half_vertices(job, halves[1].half, &from[1], &to);
        // Two triangles that go along the edge the same way are wound differently: one normal is turned.
        const double sign = from[0] == from[1] ? -1 : 1;
        const double cosine =
            sign * vec3_dot(normal_of(surface, halves[0].half / 3), normal_of(surface, halves[1].half / 3));
        kind = cosine < job->surface->crease_cosine ? EDGE_CREASE : EDGE_SMOOTH;
        job->mate[halves[0].half] = halves[1].half;
        job->mate[halves[1].half] = halves[0].half;
    }
    for (uint32_t i = 0; i < count; i++) job->kind[halves[i].half] = (uint8_t)kind;
    return kind == EDGE_MANY;
}

/// Sorts and classifies all edges; true when some have more than two triangles.
static bool classify_edges(surface_job *job) {
    memset(job->mate, 0xff, 3 * (size_t)job->surface->triangle_count * sizeof *job->mate);
    sort_halves(job);
    bool many = false;
    const uint32_t vertex_count = job->surface->mesh->vertex_count;
    for (uint32_t v = 0; v < vertex_count; v++) {
        const uint32_t end = job->first_half[v + 1];
        for (uint32_t i = job->first_half[v], next; i < end; i = next) {
            for (next = i + 1; next < end && job->halves[next].far_vertex == job->halves[i].far_vertex;)
                next++;
            many |= classify_edge(job, job->halves + i, next - i);
        }
    }
    return many;
}

/// The welded vertices of a triangle, the lowest first.
static void triangle_key(const surface_job *job, uint32_t triangle, uint32_t key[3]) {
    uint32_t w[3], low = 0;
    for (uint32_t c = 0; c < 3; c++) {
        w[c] = job->weld[vertex_of(job->surface, triangle, c)];
        if (w[c] < w[low]) low = c;
    }
    for (uint32_t c = 0; c < 3; c++) key[c] = w[(low + c) % 3];
}

/// Takes triangles out that are there already, which would make sharp edges of each other's; true when there
/// were some. Those that are turned the other way stay: they are another side.
static ewa_status drop_copies(surface_job *job, bool *dropped) {
    mesh_surface *surface = job->surface;
    const uint32_t count = surface->triangle_count;
    size_t slots = 16;
    while (slots < 2 * (size_t)count) slots *= 2;
    uint32_t *table = ewa_allocate(surface->context, slots, sizeof *table);
    if (!table) return EWA_ERROR_MEMORY;
    memset(table, 0xff, slots * sizeof *table);
    uint32_t kept = 0;
    for (uint32_t t = 0; t < count; t++) {
        uint32_t key[3], other[3];
        triangle_key(job, t, key);
        uint64_t hash =
            (((uint64_t)key[0] << 32 | key[1]) * 0x9e3779b97f4a7c15u ^ key[2]) * 0x9e3779b97f4a7c15u;
        size_t slot = (hash ^ hash >> 29) & (slots - 1);
        for (; table[slot] != NONE; slot = (slot + 1) & (slots - 1)) {
            triangle_key(job, table[slot], other);
            if (memcmp(key, other, sizeof key) == 0) break;
        }
        if (table[slot] != NONE) continue;
        const double area = area_of(surface, t);
        table[slot] = kept;
        surface->source[kept] = surface->source[t];
        memcpy(surface->normal[kept], surface->normal[t], sizeof surface->normal[t]);
        surface->area_below[kept + 1] = surface->area_below[kept] + area;
        kept++;
    }
    ewa_release(surface->context, table, slots, sizeof *table);
    *dropped = kept < count;
    if (*dropped)
        ewa_report(surface->context, EWA_SEVERITY_INFO,
                   "sample: %u of %u triangles are there twice; left out", count - kept, count);
    surface->triangle_count = kept;
    return EWA_OK;
}

/// Unites triangles over smooth edges, then parts smaller than a point's area with their neighbours.
static void unite_parts(surface_job *job) {
    mesh_surface *surface = job->surface;
    const uint32_t count = surface->triangle_count;
    for (uint32_t t = 0; t < count; t++) job->root[t] = t;
    for (uint32_t half = 0; half < 3 * count; half++)
        if (job->kind[half] == EDGE_SMOOTH) unite(job->root, half / 3, job->mate[half] / 3);
    memset(job->part_area, 0, count * sizeof *job->part_area);
    for (uint32_t t = 0; t < count; t++) job->part_area[find_root(job->root, t)] += area_of(surface, t);
    const double minimum = MIN_PART * job->spacing * job->spacing;
    for (uint32_t half = 0; half < 3 * count; half++) {
        if (job->kind[half] != EDGE_CREASE) continue;
        const uint32_t a = find_root(job->root, half / 3), b = find_root(job->root, job->mate[half] / 3);
        if (a == b || (job->part_area[a] >= minimum && job->part_area[b] >= minimum)) continue;
        const double area = job->part_area[a] + job->part_area[b];
        job->part_area[unite(job->root, a, b)] = area;
    }
    for (uint32_t t = 0; t < count; t++) surface->part[t] = find_root(job->root, t);
    for (uint32_t half = 0; half < 3 * count; half++)
        if (job->kind[half] == EDGE_CREASE && surface->part[half / 3] == surface->part[job->mate[half] / 3])
            job->kind[half] = EDGE_SMOOTH;
}

static double half_length(const surface_job *job, uint32_t half) {
    const uint32_t triangle = half / 3, corner = half % 3;
    return vec3_length(
        vec3_sub(ewa_mesh_place(job->surface, vertex_of(job->surface, triangle, (corner + 1) % 3)),
                 ewa_mesh_place(job->surface, vertex_of(job->surface, triangle, corner))));
}

/// Borders of small holes are none. Uses first_half and the front of halves as room: they are done with.
static ewa_status drop_short_borders(surface_job *job) {
    ewa_context *context = job->surface->context;
    const uint32_t vertex_count = job->surface->mesh->vertex_count,
                   half_count = 3 * job->surface->triangle_count;
    uint32_t *root = job->first_half;
    double *length = ewa_allocate_zeroed(context, vertex_count, sizeof *length);
    if (!length) return EWA_ERROR_MEMORY;
    for (uint32_t v = 0; v < vertex_count; v++) root[v] = v;
    for (uint32_t pass = 0; pass < 3; pass++) {
        for (uint32_t half = 0; half < half_count; half++) {
            if (job->kind[half] != EDGE_BORDER) continue;
            uint32_t from, to;
            half_vertices(job, half, &from, &to);
            if (pass == 0)
                unite(root, from, to);
            else if (pass == 1)
                length[find_root(root, from)] += half_length(job, half);
            else if (length[find_root(root, from)] < MIN_BORDER * job->spacing)
                job->kind[half] = EDGE_SMOOTH;
        }
    }
    ewa_release(context, length, vertex_count, sizeof *length);
    return EWA_OK;
}

/// Normals that are shared by the triangles around a vertex, up to edges that bend.
static ewa_status make_group_normals(surface_job *job, bool smooth) {
    mesh_surface *surface = job->surface;
    const uint32_t count = surface->triangle_count;
    uint32_t *root = surface->corner_group;
    for (uint32_t i = 0; i < 3 * count; i++) root[i] = i;
    for (uint32_t half = 0; smooth && half < 3 * count; half++) {
        const uint32_t mate = job->mate[half];
        if (mate == NONE || mate < half) continue;
        uint32_t from, to, mate_from, mate_to;
        half_vertices(job, half, &from, &to);
        half_vertices(job, mate, &mate_from, &mate_to);
        const double cosine = vec3_dot(normal_of(surface, half / 3), normal_of(surface, mate / 3));
        if (from != mate_to || cosine < job->surface->crease_cosine) continue;
        unite(root, half, mate / 3 * 3 + (mate % 3 + 1) % 3);
        unite(root, half / 3 * 3 + (half % 3 + 1) % 3, mate);
    }
    surface->group_normal = ewa_allocate_zeroed(surface->context, 3 * (size_t)count, 3 * sizeof(float));
    if (!surface->group_normal) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < 3 * count; i++) {
        // Weighted by the angle at the corner, so that it does not matter how a polygon is cut. The weight is
        // (1 - cosine), which grows with the angle and needs no library function.
        const uint32_t t = i / 3, c = i % 3;
        const ewa_vec3 p = ewa_mesh_place(surface, vertex_of(surface, t, c));
        ewa_vec3 u = vec3_sub(ewa_mesh_place(surface, vertex_of(surface, t, (c + 1) % 3)), p);
        ewa_vec3 v = vec3_sub(ewa_mesh_place(surface, vertex_of(surface, t, (c + 2) % 3)), p);
        if (!vec3_normalize(&u) || !vec3_normalize(&v)) continue;
        const double weight = 1 - vec3_dot(u, v);
        float *sum = surface->group_normal[find_root(root, i)];
        for (int k = 0; k < 3; k++) sum[k] += (float)(weight * (double)surface->normal[t][k]);
    }
    for (uint32_t i = 0; i < 3 * count; i++) {
        const uint32_t group = find_root(root, i);
        root[i] = group;
        if (group != i) continue;
        float *sum = surface->group_normal[i];
        ewa_vec3 n = vec3_make((double)sum[0], (double)sum[1], (double)sum[2]);
        if (!vec3_normalize(&n)) n = normal_of(surface, i / 3);
        sum[0] = (float)n.x, sum[1] = (float)n.y, sum[2] = (float)n.z;
    }
    return EWA_OK;
}

static bool is_sharp(uint8_t kind) { return kind != EDGE_SMOOTH; }

static void fill_edge(const surface_job *job, uint32_t half, mesh_edge *edge) {
    const mesh_surface *surface = job->surface;
    const uint32_t triangle = half / 3, corner = half % 3;
    const ewa_vec3 a = ewa_mesh_place(surface, vertex_of(surface, triangle, corner)),
                   b = ewa_mesh_place(surface, vertex_of(surface, triangle, (corner + 1) % 3)),
                   c = ewa_mesh_place(surface, vertex_of(surface, triangle, (corner + 2) % 3));
    const ewa_vec3 along = vec3_sub(b, a);
    ewa_vec3 inward = vec3_cross(normal_of(surface, triangle), along);
    vec3_normalize(&inward);
    vec3_store(a, edge->a);
    vec3_store(b, edge->b);
    vec3_store(inward, edge->inward);
    edge->height_world = vec3_dot(vec3_sub(c, a), inward);
    edge->foot = vec3_dot(vec3_sub(c, a), along) / vec3_dot(along, along);
    edge->triangle = triangle;
    edge->corner_a = edge->corner_b = true;
}

static int compare_ends(const void *a, const void *b) {
    const edge_end *x = a, *y = b;
    if (x->vertex != y->vertex) return x->vertex < y->vertex ? -1 : 1;
    if (x->part != y->part) return x->part < y->part ? -1 : 1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

/// Direction of an edge away from one of its ends.
static ewa_vec3 direction_from(const mesh_edge *edge, uint32_t at_b) {
    ewa_vec3 d = vec3_sub(vec3_load(edge->b), vec3_load(edge->a));
    vec3_normalize(&d);
    return at_b ? vec3_scale(d, -1) : d;
}

/// Where exactly two edges of a part go on straight there is no corner.
static ewa_status mark_corners(surface_job *job, const uint32_t *half_of_edge) {
    mesh_surface *surface = job->surface;
    const size_t count = 2 * (size_t)surface->edge_count;
    edge_end *ends = ewa_allocate(surface->context, count, sizeof *ends);
    if (!ends) return EWA_ERROR_MEMORY;
    for (uint32_t e = 0; e < surface->edge_count; e++) {
        uint32_t from, to;
        half_vertices(job, half_of_edge[e], &from, &to);
        const uint32_t part = surface->part[surface->edges[e].triangle];
        ends[2 * (size_t)e] = (edge_end){from, part, e, 0};
        ends[2 * (size_t)e + 1] = (edge_end){to, part, e, 1};
    }
    qsort(ends, count, sizeof *ends, compare_ends);
    for (size_t i = 0, next; i < count; i = next) {
        for (next = i + 1;
             next < count && ends[next].vertex == ends[i].vertex && ends[next].part == ends[i].part;)
            next++;
        if (next - i != 2) continue;
        mesh_edge *a = &surface->edges[ends[i].edge], *b = &surface->edges[ends[i + 1].edge];
        if (vec3_dot(direction_from(a, ends[i].at_b), direction_from(b, ends[i + 1].at_b)) > -STRAIGHT_COSINE)
            continue;
        *(ends[i].at_b ? &a->corner_b : &a->corner_a) = false;
        *(ends[i + 1].at_b ? &b->corner_b : &b->corner_a) = false;
    }
    ewa_release(surface->context, ends, count, sizeof *ends);
    return EWA_OK;
}

static ewa_status collect_edges(surface_job *job) {
    mesh_surface *surface = job->surface;
    const uint32_t half_count = 3 * surface->triangle_count;
    uint32_t count = 0;
    for (uint32_t half = 0; half < half_count; half++) count += is_sharp(job->kind[half]);
    if (!count) return EWA_OK;
    uint32_t *half_of_edge = ewa_allocate(surface->context, count, sizeof *half_of_edge);
    surface->edges = ewa_allocate_zeroed(surface->context, count, sizeof *surface->edges);
    surface->edge_count = count;
    ewa_status status = half_of_edge && surface->edges ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        uint32_t edge = 0;
        for (uint32_t half = 0; half < half_count; half++) {
            if (!is_sharp(job->kind[half])) continue;
            half_of_edge[edge] = half;
            fill_edge(job, half, &surface->edges[edge++]);
        }
        status = mark_corners(job, half_of_edge);
    }
    ewa_release(surface->context, half_of_edge, count, sizeof *half_of_edge);
    return status;
}

/// Cosine of an angle of [0, 180] degrees, from + - * / only: the Taylor series of a quarter of it, doubled
/// twice.
static double cosine_of_degrees(double degrees) {
    const double x = degrees * (3.141592653589793 / 180) / 4, xx = x * x;
    double cosine =
        1 - xx / 2 * (1 - xx / 12 * (1 - xx / 30 * (1 - xx / 56 * (1 - xx / 90 * (1 - xx / 132)))));
    for (int i = 0; i < 2; i++) cosine = 2 * cosine * cosine - 1;
    return cosine;
}

static ewa_status run(surface_job *job, const ewa_mesh_sample_options *options) {
    mesh_surface *surface = job->surface;
    EWA_TRY(
        ewa_mesh_weld(surface->context, surface->mesh->positions, surface->mesh->vertex_count, job->weld));
    bool again = classify_edges(job);
    if (again) EWA_TRY(drop_copies(job, &again));
    if (again) classify_edges(job);
    const double area = surface->area_below[surface->triangle_count];
    job->spacing =
        options->spacing_world > 0 ? options->spacing_world : sqrt(area / (double)options->point_count);
    unite_parts(job);
    EWA_TRY(drop_short_borders(job));
    EWA_TRY(make_group_normals(job, options->smooth_normals));
    if (options->clip_lines) EWA_TRY(collect_edges(job));
    return EWA_OK;
}

ewa_status ewa_mesh_surface_make(const ewa_mesh *mesh, const ewa_mesh_sample_options *options,
                                 mesh_surface *surface) {
    ewa_context *context = mesh->context;
    *surface = (mesh_surface){.context = context, .mesh = mesh};
    const size_t count = mesh->triangle_count, halves = 3 * count, vertices = mesh->vertex_count;
    surface->source = ewa_allocate(context, count, sizeof *surface->source);
    surface->area_below = ewa_allocate_zeroed(context, count + 1, sizeof *surface->area_below);
    surface->normal = ewa_allocate(context, count, sizeof *surface->normal);
    surface->part = ewa_allocate(context, count, sizeof *surface->part);
    surface->corner_group = ewa_allocate(context, halves, sizeof *surface->corner_group);
    surface->crease_cosine = cosine_of_degrees(options->crease_degrees);
    surface_job job = {.surface = surface};
    job.weld = ewa_allocate(context, vertices, sizeof *job.weld);
    job.first_half = ewa_allocate(context, vertices + 2, sizeof *job.first_half);
    job.halves = ewa_allocate(context, halves, sizeof *job.halves);
    job.mate = ewa_allocate(context, halves, sizeof *job.mate);
    job.kind = ewa_allocate_zeroed(context, halves, sizeof *job.kind);
    job.root = ewa_allocate(context, count, sizeof *job.root);
    job.part_area = ewa_allocate(context, count, sizeof *job.part_area);
    ewa_status status = EWA_ERROR_MEMORY;
    if (surface->source && surface->area_below && surface->normal && surface->part && surface->corner_group &&
        job.weld && job.first_half && job.halves && job.mate && job.kind && job.root && job.part_area) {
        status = keep_triangles(surface);
        if (status == EWA_OK) status = run(&job, options);
    }
    ewa_release(context, job.weld, vertices, sizeof *job.weld);
    ewa_release(context, job.first_half, vertices + 2, sizeof *job.first_half);
    ewa_release(context, job.halves, halves, sizeof *job.halves);
    ewa_release(context, job.mate, halves, sizeof *job.mate);
    ewa_release(context, job.kind, halves, sizeof *job.kind);
    ewa_release(context, job.root, count, sizeof *job.root);
    ewa_release(context, job.part_area, count, sizeof *job.part_area);
    if (status != EWA_OK) ewa_mesh_surface_free(surface);
    return status;
}

void ewa_mesh_surface_free(mesh_surface *surface) {
    if (!surface->mesh) return;
    ewa_context *context = surface->context;
    const size_t count = surface->mesh->triangle_count;
    ewa_release(context, surface->source, count, sizeof *surface->source);
    ewa_release(context, surface->area_below, count + 1, sizeof *surface->area_below);
    ewa_release(context, surface->normal, count, sizeof *surface->normal);
    ewa_release(context, surface->part, count, sizeof *surface->part);
    ewa_release(context, surface->corner_group, 3 * count, sizeof *surface->corner_group);
    ewa_release(context, surface->group_normal, 3 * (size_t)surface->triangle_count, 3 * sizeof(float));
    ewa_release(context, surface->edges, surface->edge_count, sizeof *surface->edges);
    *surface = (mesh_surface){0};
}
