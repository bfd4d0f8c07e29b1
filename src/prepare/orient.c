// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Consistent orientation of normals.
//
// The signs are propagated along a minimum spanning tree of the neighbour graph whose edges cost 1 - |n.n'|:
// between almost parallel normals first, around sharp bends last. Based on H. Hoppe, T. DeRose, T. Duchamp,
// J. McDonald, W. Stuetzle, "Surface reconstruction from unorganized points", 1992, section 3.3. The tree is
// grown by Kruskal's method with costs rounded up to a few classes; a place keeps the sign that it has
// relative to its set instead of being visited from a root. (R. E. Tarjan, "Efficiency of a good but not
// linear set union algorithm", 1975.)
#include "prepare/orient.h"
#include "base/base.h"

#include <math.h>
#include <string.h>

// Upper ends of the classes of 1 - |n.n'|: 1.8, 3.6, 7.3, 14.5, 29, 60 degrees, anything.
static const float COST_CLASSES[] = {0.0005f, 0.002f, 0.008f, 0.032f, 0.125f, 0.5f, 2.0f};
enum { COST_CLASS_COUNT = sizeof COST_CLASSES / sizeof COST_CLASSES[0] };

// A part counts as closed when its normals, weighted by area, cancel to this share.
static const double CLOSED_MEAN_NORMAL = 0.1;
// An open part still has an inside when on the whole its normals point away from its centre by this share.
static const double OPEN_OUTWARDNESS = 0.1;

typedef struct forest {
    uint32_t *parent;
    uint8_t *flipped; // relative to the parent
} forest;

/// Returns the root of a place's set and whether the place is flipped relative to it; halves the path.
static uint32_t find_root(forest *f, uint32_t place, uint8_t *flipped) {
    uint8_t sum = 0;
    while (f->parent[place] != place) {
        const uint32_t parent = f->parent[place];
        f->flipped[place] ^= f->flipped[parent]; // a root's is 0
        f->parent[place] = f->parent[parent];
        sum ^= f->flipped[place];
        place = f->parent[place];
    }
    *flipped = sum;
    return place;
}

static float dot(const float *a, const float *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Joins the sets along all links up to `cost`. Returns whether a link of this place is still to be decided.
static bool join_links(forest *f, const orient_input *input, const float *normals, uint32_t place,
                       float cost) {
    bool undecided = false;
    for (int i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
        const uint32_t other = input->links[place][i];
        if (other == UINT32_MAX) break;
        uint8_t flipped, other_flipped;
        const uint32_t root = find_root(f, place, &flipped), other_root = find_root(f, other, &other_flipped);
        if (root == other_root) continue;
        const float cosine = dot(&normals[3 * (size_t)place], &normals[3 * (size_t)other]);
        if (1 - fabsf(cosine) > cost) {
            undecided = true;
            continue;
        }
        const uint32_t low = root < other_root ? root : other_root,
                       high = root < other_root ? other_root : root;
        f->parent[high] = low;
        f->flipped[high] = flipped ^ other_flipped ^ (cosine < 0);
    }
    return undecided;
}

static ewa_status grow_forest(ewa_context *context, forest *f, const orient_input *input,
                              const float *normals, uint32_t *active, uint32_t place_count) {
    uint32_t active_count = place_count;
    for (uint32_t place = 0; place < place_count; place++) {
        f->parent[place] = active[place] = place;
        f->flipped[place] = 0;
    }
    for (int class = 0; class < COST_CLASS_COUNT; class ++) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < active_count; i++) {
            const uint32_t place = active[i];
            if (join_links(f, input, normals, place, COST_CLASSES[class])) active[kept++] = place;
        }
        active_count = kept;
        const ewa_status status = ewa_progress(context, "orient", (class + 1.0) / COST_CLASS_COUNT);
        if (status != EWA_OK) return status;
    }
    return EWA_OK;
}

/// Sums over one connected part, positions relative to its first place.
typedef struct part {
    double origin[3];
    double area, moment[3]; // of position
    double normal[3];       // oriented and weighted by area
    double flux;            // of position through the surface
    double extent;          // sum of area * |position|
    bool outward;
} part;

static void add_place(part *p, const double position[3], const float *normal, double sign, double area) {
    double length2 = 0, through = 0;
    for (int c = 0; c < 3; c++) {
        const double d = position[c] - p->origin[c];
        p->moment[c] += area * d;
        p->normal[c] += area * sign * normal[c];
        through += d * sign * normal[c];
        length2 += d * d;
    }
    p->area += area;
    p->flux += area * through;
    p->extent += area * sqrt(length2);
}

/// Decides whether the part's normals as they are point outward: by the volume that they enclose (the flux of
/// the position through a closed surface is three times its volume), or along the axis that most of them
/// follow.
static bool points_outward(const part *p) {
    double mean2 = 0, flux = p->flux, largest = 0;
    for (int c = 0; c < 3; c++) {
        mean2 += p->normal[c] * p->normal[c];
        flux -= p->moment[c] * p->normal[c] / p->area; // relative to the part's centre
        if (fabs(p->normal[c]) > fabs(largest)) largest = p->normal[c];
    }
    const bool closed = mean2 < CLOSED_MEAN_NORMAL * CLOSED_MEAN_NORMAL * p->area * p->area;
    if (closed || fabs(flux) > OPEN_OUTWARDNESS * p->extent) return flux >= 0;
    return largest >= 0;
}

static void first_position(const orient_input *input, uint32_t place, double p[3]) {
    uint32_t count;
    ewa_attribute_read_f64(input->position, ewa_neighbours_points(input->neighbours, place, &count)[0], 1, p);
}

/// Flips the normals by their place's sign and their part's. `part_of` gets the part of each root.
static ewa_status flip_parts(ewa_context *context, forest *f, const orient_input *input, float *normals,
                             uint32_t *part_of, uint32_t place_count) {
    uint32_t part_count = 0;
    for (uint32_t place = 0; place < place_count; place++)
        if (f->parent[place] == place) part_of[place] = part_count++;
    part *parts = ewa_allocate_zeroed(context, part_count, sizeof *parts);
    if (!parts) return EWA_ERROR_MEMORY;
    for (uint32_t place = 0; place < place_count; place++) {
        uint8_t flipped;
        const uint32_t root = find_root(f, place, &flipped);
        part *p = &parts[part_of[root]];
        double position[3];
        first_position(input, place, position);
        if (root == place) memcpy(p->origin, position, sizeof p->origin);
        const double spacing = input->spacing[place];
        add_place(p, position, &normals[3 * (size_t)place], flipped ? -1 : 1, spacing * spacing);
    }
    for (uint32_t i = 0; i < part_count; i++) parts[i].outward = points_outward(&parts[i]);
    for (uint32_t place = 0; place < place_count; place++) {
        uint8_t flipped;
        const uint32_t root = find_root(f, place, &flipped);
        if ((flipped != 0) == parts[part_of[root]].outward)
            for (int c = 0; c < 3; c++) normals[3 * (size_t)place + (size_t)c] *= -1;
    }
    ewa_release(context, parts, part_count, sizeof *parts);
    return EWA_OK;
}

ewa_status ewa_orient_propagate(ewa_context *context, const orient_input *input, float *normals) {
    const uint32_t place_count = ewa_neighbours_place_count(input->neighbours);
    forest f = {.parent = ewa_allocate(context, place_count, sizeof *f.parent)};
    f.flipped = ewa_allocate(context, place_count, sizeof *f.flipped);
    uint32_t *scratch = ewa_allocate(context, place_count, sizeof *scratch);
    ewa_status status = EWA_ERROR_MEMORY;
    if (f.parent && f.flipped && scratch) {
        status = grow_forest(context, &f, input, normals, scratch, place_count);
        if (status == EWA_OK) status = flip_parts(context, &f, input, normals, scratch, place_count);
    }
    ewa_release(context, scratch, place_count, sizeof *scratch);
    ewa_release(context, f.flipped, place_count, sizeof *f.flipped);
    ewa_release(context, f.parent, place_count, sizeof *f.parent);
    return status;
}
