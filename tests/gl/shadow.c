// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Makes a test of the renderer one of the graphics processor, too: linked into it with --wrap=ewa_renderer_create, renderers
// have a back end that draws each frame twice, by the processor and by compute programs, and compares the bytes.
//
// Drivers in software are a hundred times slower than the processor. So large frames are drawn once, and so are those like one
// that has been compared, unless EWA_SHADOW is "all".
#include "gl/compute.h"
#include "surface/levels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Sums of larger colours overflow, to bytes that mean nothing.
#define MAX_COLOR 1e30

enum { MAX_PIXELS = 320 * 240, MAX_SPLATS = 20000, MAX_KINDS = 1024 };

/// What this process has compared, and with what: one device for all renderers, so that programs are made once.
static struct {
    ewa_context *context;
    ewa_gl_compute *gl; ///< NULL: there is no device
    bool asked;
    uint32_t compared, passed_by;
    double spent_s;
    uint64_t kinds[MAX_KINDS];
    uint32_t kind_count;
} done;

static void tell(void) {
    if (!done.gl) {
        printf("no frame compared with a graphics processor: there is none\n");
        return;
    }
    printf("compared with the graphics processor: %u frames of %u kinds in %.1f s, %u others passed by\n",
           done.compared, done.kind_count, done.spent_s, done.passed_by);
}

/// Opens the device, once.
static void open_device(void) {
    if (done.asked) return;
    done.asked = true;
    void *state = NULL;
    if (ewa_context_create(NULL, &done.context) != EWA_OK) return;
    if (ewa_gl_compute_create(done.context, &state) == EWA_OK) done.gl = state;
    atexit(tell);
}

static ewa_status create(ewa_context *context, void **state) {
    open_device();
    return ewa_backend_cpu.create(context, state);
}

static void destroy(ewa_context *context, void *state) { ewa_backend_cpu.destroy(context, state); }

static void mix(uint64_t *hash, uint64_t value) {
    *hash = (*hash ^ value) * 0x9e3779b97f4a7c15u + (*hash >> 29);
}

/// What a frame asks of the programs, as one number.
static uint64_t kind_of(const ewa_render_job *job) {
    const ewa_render_options *o = &job->options;
    const ewa_frame *f = &job->frame;
    uint64_t hash = 1;
    const uint64_t facts[] = {(uint64_t)job->camera.projection,
                              (uint64_t)o->kernel,
                              o->passes,
                              o->layers < 4 ? o->layers : 4,
                              o->edge_layers < 4 ? o->edge_layers : 4,
                              o->edge_antialiasing,
                              (uint64_t)o->cull,
                              o->opacity<1, o->point_size_px> 0,
                              o->section_count < 3 ? o->section_count : 3,
                              o->prefilter_px > 0,
                              o->eye_dome > 0,
                              o->environment != NULL,
                              o->background[3] > 0,
                              f->rgba != NULL,
                              f->depth != NULL,
                              f->normal != NULL,
                              job->shading.lit,
                              job->shading.highlights,
                              job->shading.has_table,
                              job->shading.light_count,
                              job->source_count < 3 ? job->source_count : 3,
                              job->first_row_px != 0};
    for (size_t i = 0; i < sizeof facts / sizeof facts[0]; i++) mix(&hash, facts[i]);
    for (uint32_t i = 0; i < job->source_count && i < 3; i++) {
        const ewa_surfels *s = job->sources[i].surfels;
        mix(&hash, (s->opacities ? 1u : 0) | (s->clips ? 2u : 0) | (s->materials ? 4u : 0) |
                       (s->ellipses ? 8u : 0) | (job->sources[i].hides ? 16u : 0) |
                       (s->fine_colors ? 32u : 0) | (s->largest_color > 1 ? 64u : 0));
        mix(&hash, (uint64_t)(s->cutoff * 16));
    }
    return hash;
}

/// Whether a frame is worth its time.
static bool is_wanted(const ewa_render_job *job) {
    const char *asked = getenv("EWA_SHADOW");
    const bool all = asked && strcmp(asked, "all") == 0;
    uint64_t splats = 0;
    for (uint32_t i = 0; i < job->source_count; i++) {
        splats += job->sources[i].surfels->count;
        if (job->sources[i].surfels->largest_color > MAX_COLOR) return false;
    }
    const uint64_t pixels = (uint64_t)job->camera.width_px * job->camera.height_px;
    if (!all && (pixels > MAX_PIXELS || splats > MAX_SPLATS)) return false;
    const uint64_t kind = kind_of(job);
    for (uint32_t i = 0; i < done.kind_count; i++)
        if (done.kinds[i] == kind) return all;
    if (done.kind_count < MAX_KINDS) done.kinds[done.kind_count++] = kind;
    return true;
}

/// A plane of the frame, and what the other back end makes of it.
typedef struct plane {
    const char *name;
    void *of_cpu;
    uint8_t *of_gl;
    size_t size_bytes, pixel_bytes;
} plane;

static void compare(const ewa_render_job *job, const plane *p) {
    if (!p->of_cpu || memcmp(p->of_cpu, p->of_gl, p->size_bytes) == 0) return;
    size_t count = 0, first = 0;
    for (size_t i = p->size_bytes; i-- > 0;)
        if (((const uint8_t *)p->of_cpu)[i] != p->of_gl[i]) count++, first = i;
    const size_t pixel = first / p->pixel_bytes, width = job->camera.width_px;
    fprintf(stderr, "%s: %zu of %zu bytes of %ux%u differ, the first at pixel %zu, %zu\n", p->name, count,
            p->size_bytes, job->camera.width_px, job->camera.height_px, pixel % width, pixel / width);
    exit(1);
}

static ewa_status draw(void *state, const ewa_render_job *job, ewa_render_stats *stats) {
    const size_t pixels = (size_t)job->camera.width_px * job->camera.height_px;
    if (!done.gl || !is_wanted(job)) {
        done.passed_by++;
        return ewa_backend_cpu.draw(state, job, stats);
    }
    const ewa_frame *frame = &job->frame;
    plane planes[] = {{"rgba8", frame->rgba8, NULL, pixels * 4, 4},
                      {"rgba", frame->rgba, NULL, pixels * 16, 16},
                      {"depth", frame->depth, NULL, pixels * 4, 4},
                      {"normal", frame->normal, NULL, pixels * 12, 12},
                      {"coverage", frame->coverage, NULL, pixels * 4, 4}};
    enum { PLANES = sizeof planes / sizeof planes[0] };
    for (int i = 0; i < PLANES; i++) {
        if (!planes[i].of_cpu) continue;
        planes[i].of_gl = malloc(planes[i].size_bytes);
        memcpy(planes[i].of_gl, planes[i].of_cpu, planes[i].size_bytes); // what is not drawn stays
    }
    const ewa_status status = ewa_backend_cpu.draw(state, job, stats);
    if (status == EWA_OK) {
        const double before = ewa_now_s();
        ewa_render_job other = *job;
        other.frame = (ewa_frame){.rgba8 = planes[0].of_gl,
                                  .rgba = (float *)(void *)planes[1].of_gl,
                                  .depth = (float *)(void *)planes[2].of_gl,
                                  .normal = (float *)(void *)planes[3].of_gl,
                                  .coverage = (float *)(void *)planes[4].of_gl};
        ewa_render_stats its;
        const ewa_status drawn = ewa_gl_compute_draw(done.gl, &other, &its);
        if (drawn != EWA_OK) {
            fprintf(stderr, "the graphics processor: %s\n", ewa_status_name(drawn));
            exit(1);
        }
        done.gl->environment_serial = 0; // another context counts anew
        if (ewa_gl_enter(done.gl->device) == EWA_OK) {
            ewa_gl_residents_free(done.gl->device, &done.gl->residents);
            ewa_gl_leave(done.gl->device);
        }
        for (int i = 0; i < PLANES; i++) compare(job, &planes[i]);
        done.spent_s += ewa_now_s() - before;
        done.compared++;
    }
    for (int i = 0; i < PLANES; i++) free(planes[i].of_gl);
    return status;
}

static const ewa_backend shadow_backend = {
    .name = "shadow", .create = create, .destroy = destroy, .draw = draw};

ewa_status __wrap_ewa_renderer_create(ewa_context *context, ewa_renderer **renderer);

ewa_status __wrap_ewa_renderer_create(ewa_context *context, ewa_renderer **renderer) {
    if (!context || !renderer) return EWA_ERROR_ARGUMENT;
    return ewa_renderer_create_by(context, &shadow_backend, renderer);
}
