// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Memory of the device.
#include "gl/memory.h"

ewa_status ewa_gl_buffer_reserve(ewa_gl *device, ewa_gl_buffer *buffer, const char *what,
                                 uint64_t size_bytes) {
    enum { MIN_BYTES = 256 };
    if (size_bytes < MIN_BYTES) size_bytes = MIN_BYTES;
    if (size_bytes <= buffer->size_bytes) return EWA_OK;
    if (device->facts.compute && size_bytes > device->facts.storage_bytes)
        return ewa_fail(device->context, EWA_ERROR_LIMIT,
                        "OpenGL: %llu bytes for %s are more than the %llu that programs of %s can see",
                        (unsigned long long)size_bytes, what, (unsigned long long)device->facts.storage_bytes,
                        device->facts.renderer);
    EWA_TRY(ewa_gl_check(device, what)); // not for what came before
    if (!buffer->name) glGenBuffers(1, &buffer->name);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->name);
    glBufferData(GL_COPY_WRITE_BUFFER, (GLsizeiptr)size_bytes, NULL, buffer->usage ? buffer->usage : GL_DYNAMIC_COPY);
    ewa_status status = ewa_gl_check(device, what);
    buffer->size_bytes = status == EWA_OK ? size_bytes : 0;
    return status;
}

ewa_status ewa_gl_buffer_grow(ewa_gl *device, ewa_gl_buffer *buffer, const char *what, uint64_t size_bytes) {
    if (size_bytes <= buffer->size_bytes) return EWA_OK;
    ewa_gl_buffer grown = {.usage = buffer->usage};
    const ewa_status status = ewa_gl_buffer_reserve(device, &grown, what, size_bytes);
    if (status != EWA_OK) {
        ewa_gl_buffer_free(&grown);
        return status;
    }
    if (buffer->size_bytes) {
        glBindBuffer(GL_COPY_READ_BUFFER, buffer->name);
        glBindBuffer(GL_COPY_WRITE_BUFFER, grown.name);
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, (GLsizeiptr)buffer->size_bytes);
    }
    ewa_gl_buffer_free(buffer);
    *buffer = grown;
    return EWA_OK;
}

void ewa_gl_buffer_write(ewa_gl *device, const ewa_gl_buffer *buffer, uint64_t at_bytes, const void *bytes,
                         uint64_t size_bytes) {
    if (!size_bytes) return;
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->name);
    glBufferSubData(GL_COPY_WRITE_BUFFER, (GLintptr)at_bytes, (GLsizeiptr)size_bytes, bytes);
    device->counts.upload_bytes += size_bytes;
}

ewa_status ewa_gl_buffer_put(ewa_gl *device, ewa_gl_buffer *buffer, const char *what, const void *bytes,
                             uint64_t size_bytes) {
    EWA_TRY(ewa_gl_buffer_reserve(device, buffer, what, size_bytes));
    ewa_gl_buffer_write(device, buffer, 0, bytes, size_bytes);
    return EWA_OK;
}

void ewa_gl_buffer_fill(const ewa_gl_buffer *buffer, uint64_t size_bytes, uint32_t word) {
    if (!size_bytes) return;
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->name);
    glClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI, 0, (GLsizeiptr)size_bytes, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, &word);
}

void ewa_gl_buffer_free(ewa_gl_buffer *buffer) {
    if (buffer->name) glDeleteBuffers(1, &buffer->name);
    *buffer = (ewa_gl_buffer){.usage = buffer->usage};
}
