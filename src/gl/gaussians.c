// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians by the device of a renderer of surfaces: which frames it draws.
#include "gl/gaussians.h"
#include "gl/backends.h"
#include "gl/tuning.h"

#include <stdio.h>
#include <string.h>

/// Why a frame is the processor's; NULL: the device can draw it.
static const char *refusal_of(const ewa_gaussian_job *job) {
    if (job->solids) return "ellipsoids and dots are drawn by the CPU";
    if (!job->mixture->splats_count) return "nothing blends but what is drawn by the CPU";
    if (job->mixture->volume_count) return "Gaussians among volumes are drawn by the CPU";
    if (!job->view.by_center) return "Gaussians in the order of rays are drawn by the CPU";
    return NULL;
}

static ewa_gl_gaussian_kind kind_of(const ewa_gaussian_job *job) {
    return (ewa_gl_gaussian_kind){.splat_count = job->room,
                                  .pixel_count = (uint64_t)job->target.width_px * job->target.height_px,
                                  .with_depth = job->view.with_depth,
                                  .normals = job->view.normals,
                                  .among = job->view.with_surface || job->view.with_sections};
}

static bool is_other(const ewa_gl_gaussian_kind *a, const ewa_gl_gaussian_kind *b) {
    return ewa_gl_far_apart(a->splat_count, b->splat_count) || ewa_gl_far_apart(a->pixel_count, b->pixel_count) ||
           a->with_depth != b->with_depth || a->normals != b->normals || a->among != b->among;
}

/// The device of the surfaces; NULL: there is none that is to be used, and `*why` says why.
static ewa_gl_compute *device_of(const ewa_gl_gaussians *of, const char **why) {
    ewa_context *context;
    void *state;
    const ewa_backend *backend = ewa_renderer_backend(of->surfaces, &context, &state);
    return backend == &ewa_backend_auto ? ewa_gl_auto_device(state, why) : state;
}

/// Makes that device the one in use; what was on another went with it.
static void take_device(ewa_gl_gaussians *of, const ewa_gl_compute *compute) {
    if (of->device == compute->device) return;
    ewa_gl_gaussians_reset(of, false);
    of->device = compute->device;
    of->arithmetic = compute->verdict.arithmetic;
    of->exact = compute->verdict.exact;
    of->watched = compute->watched;
    of->splat_s = compute->surfel_s;
    of->sets.page_packets = (uint32_t)ewa_gl_tuning("page", 0);
    of->sets.kept_bytes = ewa_gl_tuning("kept", 0);
}

static ewa_status draw_on(ewa_gl_gaussians *of, const ewa_gl_compute *compute, const ewa_gaussian_job *job,
                          ewa_gaussian_stats *stats) {
    take_device(of, compute);
    EWA_TRY(ewa_gl_enter(of->device));
    of->device->counts = (ewa_gl_counts){0};
    const ewa_status status = ewa_gl_gaussians_draw(of, job, stats);
    ewa_gl_leave(of->device);
    return status == EWA_OK ? ewa_progress(of->context, "gaussians", 1) : status;
}

/// Draws by the device; `*drawn` false: the processor is to.
static ewa_status try_device(ewa_gl_gaussians *of, const ewa_gl_compute *compute, const ewa_gaussian_job *job,
                             ewa_gaussian_stats *stats, bool *drawn) {
    ewa_failures_soften(of->context, true);
    const ewa_status status = draw_on(of, compute, job, stats);
    ewa_failures_soften(of->context, false);
    *drawn = status == EWA_OK;
    const bool fits_not = status == EWA_ERROR_LIMIT || status == EWA_ERROR_MEMORY;
    if (*drawn || status == EWA_CANCELLED || !(fits_not || of->chooses)) return status;
    of->refused = true;
    snprintf(of->remark, sizeof of->remark, "%.100s failed: %s", of->device->facts.renderer, ewa_status_name(status));
    ewa_report(of->context, EWA_SEVERITY_WARNING, "Gaussians: %s; the CPU draws them", of->remark);
    return EWA_OK;
}

static ewa_status draw(void *state, const ewa_gaussian_job *job, ewa_gaussian_stats *stats, bool *drawn, char *remark,
                       size_t remark_bytes) {
    ewa_gl_gaussians *of = state;
    const double start_s = ewa_now_s();
    const char *why = refusal_of(job);
    *drawn = of->measured = false;
    snprintf(remark, remark_bytes, "%s", why ? why : "");
    if (why) return EWA_OK;
    const ewa_gl_gaussian_kind kind = kind_of(job);
    if (is_other(&kind, &of->kind)) {
        of->choice = (ewa_gl_choice){.step = EWA_GL_FIRST};
        of->refused = false;
        of->remark[0] = 0;
        of->kind = kind;
    }
    of->measured = of->chooses && !of->refused;
    if (!of->refused && (!of->chooses || ewa_gl_choice_takes_gl(&of->choice))) {
        const ewa_gl_compute *compute = device_of(of, &why);
        if (compute) EWA_TRY(try_device(of, compute, job, stats, drawn));
        of->refused |= !compute;
        if (!compute) snprintf(of->remark, sizeof of->remark, "%s", why);
    }
    if (*drawn && of->chooses)
        ewa_gl_choice_learn(&of->choice, true, ewa_now_s() - start_s, of->remark, sizeof of->remark);
    snprintf(remark, remark_bytes, "%s", of->remark);
    return EWA_OK;
}

static void learn(void *state, double took_s) {
    ewa_gl_gaussians *of = state;
    if (of->measured && !of->refused) ewa_gl_choice_learn(&of->choice, false, took_s, of->remark, sizeof of->remark);
}

static void describe(const void *state, ewa_renderer_info *info) {
    const ewa_gl_gaussians *of = state;
    if (!of->device) return;
    const ewa_gl_counts *counts = &of->device->counts;
    snprintf(info->device, sizeof info->device, "%s", of->device->facts.renderer);
    info->device_class = of->exact ? EWA_GPU_EXACT : EWA_GPU_CLOSE;
    info->wait_count = counts->waits, info->readback_count = counts->readbacks;
    info->dispatch_count = counts->dispatches, info->upload_bytes = counts->upload_bytes;
    info->readback_bytes = counts->readback_bytes;
}

static void destroy(ewa_context *context, void *state) {
    ewa_gl_gaussians *old = state;
    const char *why;
    const ewa_gl_compute *compute = old->device ? device_of(old, &why) : NULL;
    const bool there = compute && compute->device == old->device && !old->device->lost && ewa_gl_enter(old->device) == EWA_OK;
    ewa_gl *device = old->device;
    ewa_gl_gaussians_reset(old, there);
    if (there) ewa_gl_leave(device);
    ewa_buffer_free(context, &old->views);
    ewa_buffer_free(context, &old->segments);
    ewa_buffer_free(context, &old->uses);
    ewa_release(context, old, 1, sizeof *old);
}

static const ewa_gaussian_backend backend = {.draw = draw, .learn = learn, .describe = describe, .destroy = destroy};

ewa_status ewa_gl_gaussians_attach(ewa_context *context, ewa_renderer *surfaces, ewa_gaussian_renderer *gaussians) {
    ewa_context *own;
    void *state;
    const ewa_backend *of = ewa_renderer_backend(surfaces, &own, &state);
    if (of != &ewa_backend_gl && of != &ewa_backend_auto) return EWA_OK;
    ewa_gl_gaussians *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->surfaces = surfaces;
    made->chooses = of == &ewa_backend_auto;
    ewa_gaussian_renderer_use(gaussians, &backend, made);
    return EWA_OK;
}
