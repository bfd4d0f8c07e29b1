// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the surface of a cloud ends: what its places find out about that, and the stream it becomes.
#ifndef EWA_SRC_ESTIMATE_BORDERS_H
#define EWA_SRC_ESTIMATE_BORDERS_H

#include "cloud/neighbours.h"

#include <stdatomic.h>

enum { BORDER_NEAR = 1, BORDER_ASKED = 2 };

/// A place near a border, and where that is from there, world units.
typedef struct border_end {
    uint32_t place;
    float to_world[3];
} border_end;

/// What is known of all places.
typedef struct border_set {
    uint32_t place_count;
    _Atomic uint32_t end_count;
    border_end *ends;       ///< in any order; room for all places, of which what is not used is not touched
    _Atomic uint8_t *notes; ///< by place: whether it is near a border, whether its disc may reach over one
} border_set;

/// Errors: EWA_ERROR_MEMORY. To be freed in any case.
ewa_status ewa_borders_make(ewa_context *context, uint32_t place_count, border_set *made);
void ewa_borders_free(ewa_context *context, border_set *set);

/// Notes where the border nearest to a place is, from there, world units. Any thread, for any place once.
void ewa_borders_note(border_set *set, uint32_t place, const float to_world[3]);

/// Whether a place is near a border.
static inline bool ewa_borders_is_near(const border_set *set, uint32_t place) {
    return set->end_count && atomic_load_explicit(&set->notes[place], memory_order_relaxed) & BORDER_NEAR;
}

/// Asks a place to look for a border. Any thread.
void ewa_borders_ask(border_set *set, uint32_t place);

/// Whether there are places that have been asked and know of no border. If so, sets the notes of these to `value`,
/// those of all others to 0.
bool ewa_borders_take_asked(border_set *set, uint8_t value, uint8_t *notes);

/// Adds what is known to the cloud: "border" to discs, "clip0" to ellipses of these tangent axes (by point; NULL:
/// discs), nothing where no surface ends. What it had of that is removed. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_borders_add(const border_set *set, const ewa_neighbours *neighbours, const float *tangent_u,
                           const float *tangent_v, ewa_cloud *cloud);

#endif
