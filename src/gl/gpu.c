// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Renderers by the kind of their back end, and what device there is.
#include "ewa/gpu.h"
#include "base/base.h"
#include "gl/backends.h"

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
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "renderer: no raster back end yet");
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

ewa_status ewa_gpu_describe(ewa_context *context, ewa_gpu_info *info) {
    if (!context || !info) return EWA_ERROR_ARGUMENT;
    const size_t size = info->struct_size;
    if (size < sizeof size || size > sizeof *info)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "gpu: struct_size is %zu, not %zu", size, sizeof *info);
    ewa_gpu_info all = {.struct_size = size};
    const ewa_status status = ewa_gpu_find(context, &all);
    if (status == EWA_OK) memcpy(info, &all, size);
    return status;
}
