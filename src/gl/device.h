// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A graphics device without a window: a context of OpenGL by EGL, which is current only while it is used, so that
// programs that draw with OpenGL themselves are not disturbed.
#ifndef EWA_SRC_GL_DEVICE_H
#define EWA_SRC_GL_DEVICE_H

#include "base/base.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

/// Seconds that a device gets for what it was told before it counts as hung, and more for each surfel of a frame.
#define EWA_GL_PATIENCE_S 10.0
#define EWA_GL_PATIENCE_PER_SURFEL_S 1e-6

/// What a device is and can.
typedef struct ewa_gl_facts {
    char vendor[128], renderer[128], version[128];
    bool software;          ///< the processor does the work
    bool compute;           ///< OpenGL 4.3 with what the compute pipeline needs
    bool with_doubles;      ///< of 64 bits in shaders
    uint64_t storage_bytes; ///< of a buffer that shaders see, at most
    uint32_t storage_count; ///< of those at a time
    uint32_t binding_count; ///< places where those are bound
    uint32_t group_threads; ///< of a work group, at most
    uint32_t group_count;   ///< along x, at most
    uint32_t texture_px;    ///< side of a picture that can be drawn into, at most
} ewa_gl_facts;

/// What a device was asked for, since its user set this to zeros.
typedef struct ewa_gl_counts {
    uint32_t waits, readbacks, dispatches;
    uint64_t upload_bytes, readback_bytes;
} ewa_gl_counts;

/// A device with a context of its own. Used by one thread at a time.
typedef struct ewa_gl {
    ewa_context *context;
    EGLDisplay display;
    EGLContext gl;
    ewa_gl_facts facts;
    bool lost;                             ///< nothing works any more
    uint64_t surfel_count;                 ///< of the frame that it draws
    ewa_gl_counts counts;
    uint64_t wait_count, lose_at, hang_at; ///< calls of ewa_gl_wait(), and those that tests make fail
    struct {
        EGLenum api;
        EGLDisplay display;
        EGLSurface draw, read;
        EGLContext gl;
    } outside; ///< what was current before ewa_gl_enter()
} ewa_gl;

/// Opens the device: the first that is no software, else the first. EWA_GL_DEVICE=N in the environment takes the N-th, from
/// 0. The caller closes it. Errors: EWA_ERROR_UNSUPPORTED (none; the message names what to install),
/// EWA_ERROR_MEMORY.
ewa_status ewa_gl_open(ewa_context *context, ewa_gl **device);

/// Writes a line for each device that there is: its number for EWA_GL_DEVICE, its name, or why it gives no context. Cut where
/// that is longer.
void ewa_gl_list(char *text, size_t size_bytes);

/// Closes a device whose objects are deleted, and sets `*device` to NULL; accepts a pointer to NULL.
void ewa_gl_close(ewa_gl **device);

/// Makes the device's context current in this thread. Errors: EWA_ERROR_UNSUPPORTED (it is lost).
ewa_status ewa_gl_enter(ewa_gl *device);

/// Makes current what was before. Always after ewa_gl_enter() that succeeded.
void ewa_gl_leave(ewa_gl *device);

/// Waits until the device has done all it was told. Errors: EWA_ERROR_UNSUPPORTED (it hangs, or is lost: it is not
/// usable any more; `what` was being done).
ewa_status ewa_gl_wait(ewa_gl *device, const char *what);

/// Returns the failure for an error that OpenGL has noted since the last call, or EWA_OK. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_UNSUPPORTED.
ewa_status ewa_gl_check(ewa_gl *device, const char *what);

#endif
