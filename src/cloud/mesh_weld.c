// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Vertices at the same place are one: a hash table of places. And whether the triangles over them close.
#include "base/base.h"
#include "cloud/mesh.h"

#include <math.h>
#include <string.h>

enum { NONE = UINT32_MAX };

static uint64_t mix(uint64_t hash, uint64_t bits) {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
}

static uint64_t hash_place(const double p[3]) {
    uint64_t hash = 0;
    for (int c = 0; c < 3; c++) {
        const double value = p[c] + 0.0; // -0 becomes 0
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = mix(hash, bits ^ bits >> 32); // the low half of a short number is zero
    }
    return hash;
}

/// Slots of a table for `count` entries, a power of two that leaves half of them empty.
static size_t slots_for(uint64_t count) {
    size_t slots = 16;
    while (slots < 2 * count) slots *= 2;
    return slots;
}

ewa_status ewa_mesh_weld(ewa_context *context, const double *positions, uint32_t count, uint32_t *weld) {
    const size_t slots = slots_for(count);
    uint32_t *table = ewa_allocate(context, slots, sizeof *table);
    if (!table) return EWA_ERROR_MEMORY;
    memset(table, 0xff, slots * sizeof *table);
    for (uint32_t v = 0; v < count; v++) {
        const double *p = positions + 3 * (size_t)v;
        size_t slot = hash_place(p) & (slots - 1);
        for (;; slot = (slot + 1) & (slots - 1)) {
            const uint32_t other = table[slot];
            if (other == NONE) break;
            const double *q = positions + 3 * (size_t)other;
            // Equal bits are one place even where they are no number, or NaN would fill one long chain.
            if ((p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) || memcmp(p, q, 3 * sizeof *p) == 0) break;
        }
        if (table[slot] == NONE) table[slot] = v;
        weld[v] = table[slot];
    }
    ewa_release(context, table, slots, sizeof *table);
    return EWA_OK;
}

/// An edge from its lower to its higher vertex, and how its triangles go along it.
typedef struct closed_edge {
    uint32_t low, high;
    bool up, down; ///< a triangle goes from low to high, and back; neither: a free slot
} closed_edge;

typedef struct closed_table {
    closed_edge *slots;
    size_t slot_count;
    uint64_t edges_left; ///< more than these cannot be the edges of a closed mesh
} closed_table;

/// Enters one side of a triangle; false when the mesh cannot be closed: two triangles go along an edge in the
/// same direction, or there are too many edges.
static bool enter_side(closed_table *table, uint32_t from, uint32_t to) {
    const uint32_t low = from < to ? from : to, high = from < to ? to : from;
    size_t slot = mix(mix(0, low), high) & (table->slot_count - 1);
    closed_edge *edge = &table->slots[slot];
    while ((edge->up || edge->down) && (edge->low != low || edge->high != high)) {
        slot = (slot + 1) & (table->slot_count - 1);
        edge = &table->slots[slot];
    }
    if (!edge->up && !edge->down && table->edges_left-- == 0) return false;
    edge->low = low;
    edge->high = high;
    bool *direction = from < to ? &edge->up : &edge->down;
    const bool taken = *direction;
    *direction = true;
    return !taken;
}

static bool triangles_close(const ewa_mesh *mesh, const uint32_t *weld, closed_table *table) {
    bool any = false;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles + 3 * (size_t)t;
        const uint32_t w[3] = {weld[v[0]], weld[v[1]], weld[v[2]]};
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                if (!isfinite(mesh->positions[3 * (size_t)w[c] + (size_t)k])) return false;
        if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) continue;
        any = true;
        for (int c = 0; c < 3; c++)
            if (!enter_side(table, w[c], w[(c + 1) % 3])) return false;
    }
    for (size_t slot = 0; slot < table->slot_count; slot++)
        if (table->slots[slot].up != table->slots[slot].down) return false;
    return any;
}

ewa_status ewa_mesh_is_closed(const ewa_mesh *mesh, bool *closed) {
    if (!mesh || !mesh->context || !closed) return EWA_ERROR_ARGUMENT;
    *closed = false;
    ewa_context *context = mesh->context;
    for (uint64_t i = 0; i < 3 * (uint64_t)mesh->triangle_count; i++)
        if (mesh->triangles[i] >= mesh->vertex_count)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "mesh: triangle %u has vertex %u, there are %u",
                            (unsigned)(i / 3), mesh->triangles[i], mesh->vertex_count);
    // A closed mesh has three edges for two triangles.
    closed_table table = {.edges_left = 3 * (uint64_t)mesh->triangle_count / 2};
    table.slot_count = slots_for(table.edges_left);
    uint32_t *weld = ewa_allocate(context, mesh->vertex_count, sizeof *weld);
    table.slots = weld ? ewa_allocate_zeroed(context, table.slot_count, sizeof *table.slots) : NULL;
    ewa_status status =
        table.slots ? ewa_mesh_weld(context, mesh->positions, mesh->vertex_count, weld) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) *closed = triangles_close(mesh, weld, &table);
    ewa_release(context, table.slots, table.slot_count, sizeof *table.slots);
    ewa_release(context, weld, mesh->vertex_count, sizeof *weld);
    return status;
}
