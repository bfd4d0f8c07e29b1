// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Named bytes that travel with a cloud, and the grid that its decimal coordinates lie on.
#include "cloud/notes.h"
#include "base/base.h"

#include <math.h>
#include <string.h>

enum { FIRST_NOTES = 8 };

const ewa_note *ewa_notes_find(const ewa_notes *notes, const char *name) {
    for (uint32_t i = 0; i < notes->count; i++)
        if (strcmp(notes->notes[i].name, name) == 0) return &notes->notes[i];
    return NULL;
}

static void release_note(ewa_context *context, ewa_note *note) {
    ewa_release(context, note->bytes, note->size_bytes + 1, 1);
}

static void remove_note(ewa_context *context, ewa_notes *notes, const char *name) {
    for (uint32_t i = 0; i < notes->count; i++) {
        if (strcmp(notes->notes[i].name, name) != 0) continue;
        release_note(context, &notes->notes[i]);
        memmove(&notes->notes[i], &notes->notes[i + 1], (notes->count - i - 1) * sizeof *notes->notes);
        notes->count--;
        return;
    }
}

/// Finds the place of a note, or makes one without bytes; NULL without memory.
static ewa_note *place_of(ewa_context *context, ewa_notes *notes, const char *name) {
    ewa_note *found = (ewa_note *)(uintptr_t)ewa_notes_find(notes, name);
    if (found) return found;
    if (notes->count == notes->capacity) {
        const uint32_t capacity = notes->capacity ? 2 * notes->capacity : FIRST_NOTES;
        ewa_note *larger = ewa_allocate(context, capacity, sizeof *larger);
        if (!larger) return NULL;
        if (notes->count) memcpy(larger, notes->notes, notes->count * sizeof *larger);
        ewa_release(context, notes->notes, notes->capacity, sizeof *larger);
        notes->notes = larger;
        notes->capacity = capacity;
    }
    ewa_note *made = &notes->notes[notes->count++];
    *made = (ewa_note){.bytes = NULL};
    memcpy(made->name, name, strlen(name) + 1);
    return made;
}

ewa_status ewa_notes_set(ewa_context *context, ewa_notes *notes, const char *name, const void *bytes,
                         size_t size_bytes) {
    const size_t length = name ? strlen(name) : 0;
    if (length == 0 || length >= EWA_NAME_BYTES)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "name of a note of %zu bytes (1 to %d allowed)", length,
                        EWA_NAME_BYTES - 1);
    if (size_bytes == 0) {
        remove_note(context, notes, name);
        return EWA_OK;
    }
    char *copy = size_bytes < SIZE_MAX ? ewa_allocate(context, size_bytes + 1, 1) : NULL;
    if (!copy) return EWA_ERROR_MEMORY;
    memcpy(copy, bytes, size_bytes);
    copy[size_bytes] = '\0';
    ewa_note *note = place_of(context, notes, name);
    if (!note) {
        ewa_release(context, copy, size_bytes + 1, 1);
        return EWA_ERROR_MEMORY;
    }
    if (note->bytes) release_note(context, note);
    note->bytes = copy;
    note->size_bytes = size_bytes;
    return EWA_OK;
}

void ewa_notes_free(ewa_context *context, ewa_notes *notes) {
    for (uint32_t i = 0; i < notes->count; i++) release_note(context, &notes->notes[i]);
    ewa_release(context, notes->notes, notes->capacity, sizeof *notes->notes);
    *notes = (ewa_notes){.notes = NULL};
}

double ewa_grid_world(const ewa_coordinate_grid *grid, uint32_t axis, double world) {
    const double step = grid->step_world[axis], offset = grid->offset_world[axis];
    const double exact = 0x1p53;
    if (!(step > 0)) return world;
    const double index = nearbyint((world - offset) / step);
    if (!(fabs(index) < exact)) return world;
    // Whole parts of one: then the place is a quotient of whole numbers, which division rounds once.
    const double parts = nearbyint(1 / step), offset_index = nearbyint(offset * parts);
    const double parts_error = fabs(step * parts - 1), offset_error = fabs(offset * parts - offset_index);
    if (parts >= 1 && parts_error < 1e-12 && offset_error < 1e-6 && fabs(offset_index) < exact &&
        fabs(index + offset_index) < exact)
        return (index + offset_index) / parts;
    return offset + index * step;
}
