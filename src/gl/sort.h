// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A stable sort of items on the device, each a key and a value of 32 bits: by eight bits of the keys at a time, from the lowest on.
// How many items there are is known to the device only.
#ifndef EWA_SRC_GL_SORT_H
#define EWA_SRC_GL_SORT_H

#include "gl/memory.h"
#include "gl/variant.h"

enum {
    EWA_GL_SORT_STAGES = 3, ///< programs of a pass (shaders/sort.glsl)
    EWA_GL_SORT_BITS = 8,
    EWA_GL_SORT_BLOCK = 4096, ///< items of a group of invocations
};

/// The key of no item: such are left out of what is sorted.
#define EWA_GL_NO_KEY UINT32_MAX

/// Programs and memory. Zero-initialise.
typedef struct ewa_gl_sorter {
    GLuint programs[EWA_GL_SORT_STAGES];
    ewa_gl_buffer table;
} ewa_gl_sorter;

/// Lists of words, one for keys and one for values, of at least `capacity`.
typedef struct ewa_gl_items {
    const ewa_gl_buffer *keys, *values;
    uint32_t capacity;
} ewa_gl_items;

/// Writes the source of a stage's program.
void ewa_gl_sort_write(uint32_t stage, ewa_gl_source *source);

/// Sorts by bits [shift, shift + 8) of the keys, from one list into another; items with equal bits stay in their order. Word `count_at`
/// of `counts` says how many items there are; what has no room in `to` is left out. Of the bindings of storage buffers 0 to 5 are changed.
/// Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED.
ewa_status ewa_gl_sort_pass(ewa_gl *device, ewa_gl_sorter *sorter, const ewa_gl_items *from, const ewa_gl_items *to,
                            const ewa_gl_buffer *counts, uint32_t count_at, uint32_t shift);

void ewa_gl_sorter_free(ewa_gl_sorter *sorter);

#endif
