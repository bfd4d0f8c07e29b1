// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// This room in a library that is built without OpenGL: no device, and EWA_BACKEND_AUTO is the CPU.
#include "base/base.h"
#include "gl/backends.h"

#include <stdio.h>

static ewa_status refuse(ewa_context *context) {
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                    "OpenGL: this library was built without it (EWA_WITH_GL, libepoxy)");
}

static ewa_status create(ewa_context *context, void **state) {
    *state = NULL;
    return refuse(context);
}

const ewa_backend ewa_backend_gl = {.name = "gl", .create = create};
const ewa_backend ewa_backend_gl_raster = {.name = "gl-raster", .create = create};

static ewa_status create_cpu(ewa_context *context, void **state) {
    return ewa_backend_cpu.create(context, state);
}
static void destroy_cpu(ewa_context *context, void *state) { ewa_backend_cpu.destroy(context, state); }
static ewa_status draw_cpu(void *state, const ewa_render_job *job, ewa_render_stats *stats) {
    return ewa_backend_cpu.draw(state, job, stats);
}

static void describe_cpu(const void *state, ewa_renderer_info *info) {
    (void)state;
    snprintf(info->backend, sizeof info->backend, "%s", ewa_backend_cpu.name);
    snprintf(info->remark, sizeof info->remark, "the library was built without OpenGL");
}

const ewa_backend ewa_backend_auto = {
    .name = "auto", .create = create_cpu, .destroy = destroy_cpu, .draw = draw_cpu, .describe = describe_cpu};

ewa_status ewa_gpu_find(ewa_context *context, ewa_gpu_info *info) {
    (void)info;
    return refuse(context);
}

ewa_status ewa_gl_gaussians_attach(ewa_context *context, ewa_renderer *surfaces, ewa_gaussian_renderer *gaussians) {
    (void)context, (void)surfaces, (void)gaussians;
    return EWA_OK;
}

ewa_status ewa_gl_volume_attach(ewa_context *context, ewa_renderer *surfaces, ewa_volume_renderer *volumes) {
    (void)context, (void)surfaces, (void)volumes;
    return EWA_OK;
}
