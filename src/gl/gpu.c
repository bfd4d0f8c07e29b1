// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Renderers by the kind of their back end.
#include "ewa/gpu.h"
#include "base/base.h"
#include "gl/backends.h"
#include "surface/render.h"

ewa_status ewa_renderer_create_on(ewa_context *context, ewa_backend_kind kind, ewa_renderer **renderer) {
    if (!context || !renderer) return EWA_ERROR_ARGUMENT;
    *renderer = NULL;
    switch (kind) {
    case EWA_BACKEND_CPU:
        return ewa_renderer_create_by(context, &ewa_backend_cpu, renderer);
    case EWA_BACKEND_GL:
        return ewa_renderer_create_by(context, &ewa_backend_gl, renderer);
    case EWA_BACKEND_GL_RASTER:
        return ewa_renderer_create_by(context, &ewa_backend_gl_raster, renderer);
    default:
        break;
    }
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "renderer: %d is no kind of back end", (int)kind);
}
