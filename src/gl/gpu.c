// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Renderers by the kind of their back end, and what device there is.
#include "ewa/gpu.h"
#include "base/base.h"
#include "gl/backends.h"

#include <stdio.h>
#include <string.h>

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
    case EWA_BACKEND_AUTO:
        return ewa_renderer_create_by(context, &ewa_backend_auto, renderer);
    default:
        break;
    }
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "renderer: %d is no kind of back end", (int)kind);
}

const char *ewa_gpu_class_name(ewa_gpu_class device_class) {
    static const char *const names[] = {"none", "unusable", "close", "exact"};
    return device_class >= 0 && device_class <= EWA_GPU_EXACT ? names[device_class] : "unknown";
}

/// Whether a caller's struct is one that this library knows. Errors: EWA_ERROR_ARGUMENT.
static ewa_status check_size(ewa_context *context, size_t size, size_t known) {
    if (size >= sizeof size && size <= known) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "gpu: struct_size is %zu, not %zu", size, known);
}

ewa_status ewa_gpu_describe(ewa_context *context, ewa_gpu_info *info) {
    if (!context || !info) return EWA_ERROR_ARGUMENT;
    ewa_gpu_info all = {.struct_size = info->struct_size};
    EWA_TRY(check_size(context, all.struct_size, sizeof all));
    EWA_TRY(ewa_gpu_find(context, &all));
    memcpy(info, &all, all.struct_size);
    return EWA_OK;
}

ewa_status ewa_renderer_describe(const ewa_renderer *renderer, ewa_renderer_info *info) {
    if (!renderer || !info) return EWA_ERROR_ARGUMENT;
    ewa_context *context;
    void *state;
    const ewa_backend *backend = ewa_renderer_backend(renderer, &context, &state);
    ewa_renderer_info all = {.struct_size = info->struct_size};
    EWA_TRY(check_size(context, all.struct_size, sizeof all));
    snprintf(all.backend, sizeof all.backend, "%s", backend->name);
    if (backend->describe) backend->describe(state, &all);
    memcpy(info, &all, all.struct_size);
    return EWA_OK;
}
