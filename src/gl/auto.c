// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The processor and the compute pipeline beside each other: both draw the first frames of a scene, the faster
// the others. They draw the same bytes, so that nobody sees which it was. Whatever the device fails to draw,
// the processor draws.
#include "base/context.h"
#include "gl/backends.h"
#include "gl/choice.h"
#include "gl/compute.h"
#include "gl/tuning.h"
#include "surface/supersampling.h"

#include <stdio.h>
#include <string.h>

/// What decides how long frames take.
typedef struct scene_kind {
    uint64_t splat_count, pixel_count;
    uint32_t passes, layers, edge_layers, planes;
    bool lit, antialiased;
} scene_kind;

/// A kind of frame, and what was measured of it.
typedef struct choice {
    scene_kind kind;
    ewa_gl_choice of;
} choice;

typedef struct auto_state {
    ewa_context *context;
    void *cpu, *gl; ///< of the back ends; gl: NULL: not opened, or gone
    ewa_buffer parts; ///< of pixels
    bool tried;     ///< whether the device has been looked for
    choice choices[2]; ///< of frames; of the finer one of two pictures that a frame is the mean of
    bool drew_by_gl;
    char remark[160];
} auto_state;

static ewa_status create(ewa_context *context, void **state) {
    auto_state *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    const ewa_status status = ewa_backend_cpu.create(context, &made->cpu);
    if (status != EWA_OK) {
        ewa_release(context, made, 1, sizeof *made);
        return status;
    }
    *state = made;
    return EWA_OK;
}

static void drop_gl(auto_state *both) {
    if (both->gl) ewa_backend_gl.destroy(both->context, both->gl);
    both->gl = NULL;
    for (int i = 0; i < 2; i++) both->choices[i].of.by_gl = false;
}

static void destroy(ewa_context *context, void *state) {
    auto_state *old = state;
    drop_gl(old);
    ewa_backend_cpu.destroy(context, old->cpu);
    ewa_buffer_free(context, &old->parts);
    ewa_release(context, old, 1, sizeof *old);
}

/// Opens the device, where there is one that draws the same bytes and is none of software.
static void open_gl(auto_state *both) {
    both->tried = true;
    ewa_failures_hush(both->context, true);
    const ewa_status status = ewa_backend_gl.create(both->context, &both->gl);
    ewa_failures_hush(both->context, false);
    if (status != EWA_OK) {
        both->gl = NULL;
        snprintf(both->remark, sizeof both->remark, "no device");
        return;
    }
    const ewa_gl_compute *gl = both->gl;
    const char *renderer = gl->device->facts.renderer;
    const bool software = gl->device->facts.software && !ewa_gl_tuning("software", 0);
    if (software)
        snprintf(both->remark, sizeof both->remark, "%.100s is software", renderer);
    else if (!gl->verdict.exact)
        snprintf(both->remark, sizeof both->remark, "%.100s is not exact: %s", renderer, gl->verdict.differs);
    if (software || !gl->verdict.exact) drop_gl(both);
}

static scene_kind kind_of(const ewa_render_job *job, uint32_t finer) {
    const ewa_frame *frame = &job->frame;
    scene_kind kind = {.pixel_count = (uint64_t)finer * finer * job->camera.width_px * (job->end_row_px - job->first_row_px),
                       .passes = job->options.passes,
                       .layers = job->options.layers,
                       .edge_layers = job->options.edge_layers,
                       .lit = job->shading.lit,
                       .antialiased = job->options.edge_antialiasing};
    kind.planes = (frame->rgba8 ? 1u : 0u) | (frame->rgba ? 2u : 0u) | (frame->depth ? 4u : 0u) |
                  (frame->normal ? 8u : 0u) | (frame->coverage ? 16u : 0u);
    for (uint32_t i = 0; i < job->source_count; i++) kind.splat_count += job->sources[i].surfels->count;
    return kind;
}

/// Whether what was measured says nothing of this frame.
static bool is_other(const scene_kind *a, const scene_kind *b) {
    return ewa_gl_far_apart(a->splat_count, b->splat_count) || ewa_gl_far_apart(a->pixel_count, b->pixel_count) ||
           a->passes != b->passes || a->layers != b->layers || a->edge_layers != b->edge_layers ||
           a->planes != b->planes || a->lit != b->lit || a->antialiased != b->antialiased;
}

/// What is put on a frame in bands when its last is drawn is of one back end's memory.
static bool needs_one(const ewa_render_job *job) {
    return job->options.eye_dome > 0 && job->end_row_px - job->first_row_px < job->camera.height_px;
}

/// Draws by the device; false: the frame is still to be drawn, and `*status` is EWA_OK unless the call is to end.
static bool draw_by_gl(auto_state *both, choice *now, const ewa_render_job *job, uint32_t finer, ewa_render_stats *stats,
                       ewa_status *status) {
    ewa_failures_soften(both->context, true);
    *status = finer > 1 ? ewa_backend_gl.draw_parts(both->gl, job, finer, stats) : ewa_backend_gl.draw(both->gl, job, stats);
    ewa_failures_soften(both->context, false);
    if (*status == EWA_OK || *status == EWA_CANCELLED) return true;
    // The same scene would not fit again. What else fails, fails for good.
    const bool fits_not = *status == EWA_ERROR_LIMIT || *status == EWA_ERROR_MEMORY;
    snprintf(both->remark, sizeof both->remark, "%.100s failed: %s",
             ((const ewa_gl_compute *)both->gl)->device->facts.renderer, ewa_status_name(*status));
    ewa_report(both->context, EWA_SEVERITY_WARNING, "renderer: %s; the CPU draws %s", both->remark,
               fits_not ? "this scene" : "from here on");
    if (!fits_not) drop_gl(both);
    ewa_gl_choice_leave(&now->of);
    *status = EWA_OK;
    return false;
}

static ewa_status draw_by_cpu(auto_state *both, const ewa_render_job *job, uint32_t finer, ewa_render_stats *stats) {
    if (finer > 1) return ewa_parts_draw(both->context, &ewa_backend_cpu, both->cpu, job, finer, &both->parts, stats);
    return ewa_backend_cpu.draw(both->cpu, job, stats);
}

/// Draws a frame of `finer` squared parts of each pixel, or of pixels, by the faster.
static ewa_status draw_parts(void *state, const ewa_render_job *job, uint32_t finer, ewa_render_stats *stats) {
    auto_state *both = state;
    const double start_s = ewa_now_s();
    const scene_kind kind = kind_of(job, finer);
    choice *now = &both->choices[finer > job->parts.count];
    if (is_other(&kind, &now->kind)) *now = (choice){.kind = kind, .of.step = both->tried && !both->gl ? EWA_GL_DECIDED : EWA_GL_FIRST};
    if (now->of.step == EWA_GL_WARM_UP && !both->tried) open_gl(both);
    if (!both->gl && now->of.step > EWA_GL_FIRST) now->of.step = EWA_GL_DECIDED;
    both->drew_by_gl = ewa_gl_choice_takes_gl(&now->of) && both->gl && !needs_one(job);
    ewa_status status = EWA_OK;
    if (!both->drew_by_gl || !draw_by_gl(both, now, job, finer, stats, &status)) {
        both->drew_by_gl = false;
        status = draw_by_cpu(both, job, finer, stats);
    }
    if (status == EWA_OK && !needs_one(job))
        ewa_gl_choice_learn(&now->of, both->drew_by_gl, ewa_now_s() - start_s, both->remark, sizeof both->remark);
    return status;
}

static ewa_status draw(void *state, const ewa_render_job *job, ewa_render_stats *stats) {
    return draw_parts(state, job, 1, stats);
}

ewa_gl_compute *ewa_gl_auto_device(void *state, const char **remark) {
    auto_state *both = state;
    if (!both->tried) open_gl(both);
    *remark = both->remark;
    return both->gl;
}

static void describe(const void *state, ewa_renderer_info *info) {
    const auto_state *both = state;
    snprintf(info->backend, sizeof info->backend, "%s", ewa_backend_cpu.name);
    if (both->drew_by_gl) {
        snprintf(info->backend, sizeof info->backend, "%s", ewa_backend_gl.name);
        ewa_backend_gl.describe(both->gl, info);
    }
    memcpy(info->remark, both->remark, sizeof info->remark);
}

const ewa_backend ewa_backend_auto = {.name = "auto",
                                      .create = create,
                                      .destroy = destroy,
                                      .draw = draw,
                                      .describe = describe,
                                      .draw_parts = draw_parts};
