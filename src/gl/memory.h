// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Memory of the device that grows and never shrinks, as ewa_buffer.
#ifndef EWA_SRC_GL_MEMORY_H
#define EWA_SRC_GL_MEMORY_H

#include "gl/device.h"

/// A buffer of the device. Zero-initialise.
typedef struct ewa_gl_buffer {
    GLuint name;
    GLenum usage; ///< 0: GL_DYNAMIC_COPY
    uint64_t size_bytes;
} ewa_gl_buffer;

/// Makes room for `size_bytes`; what was there is lost where it grows. Errors: EWA_ERROR_LIMIT (more than shaders can see),
/// EWA_ERROR_MEMORY.
ewa_status ewa_gl_buffer_reserve(ewa_gl *device, ewa_gl_buffer *buffer, const char *what,
                                 uint64_t size_bytes);

/// The same, but what was there stays. Both are there for a while.
ewa_status ewa_gl_buffer_grow(ewa_gl *device, ewa_gl_buffer *buffer, const char *what, uint64_t size_bytes);

/// Sets bytes from `at_bytes` on, for which there is room.
void ewa_gl_buffer_write(ewa_gl *device, const ewa_gl_buffer *buffer, uint64_t at_bytes, const void *bytes,
                         uint64_t size_bytes);

/// Reserves and fills. Errors: as ewa_gl_buffer_reserve().
ewa_status ewa_gl_buffer_put(ewa_gl *device, ewa_gl_buffer *buffer, const char *what, const void *bytes,
                             uint64_t size_bytes);

/// Sets all of its words from the start to one value; needs OpenGL 4.3.
void ewa_gl_buffer_fill(const ewa_gl_buffer *buffer, uint64_t size_bytes, uint32_t word);

void ewa_gl_buffer_free(ewa_gl_buffer *buffer);

#endif
