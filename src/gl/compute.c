// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pipeline as compute programs: a frame, in bands of rows that fit the device.
// Every sum and every rounding is that of src/surface, so that a device that keeps them draws the same bytes.
// Reference: src/reference/surface.c.
#include "gl/compute.h"
#include "gl/backends.h"
#include "gl/tuning.h"
#include "surface/supersampling.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A group takes 0.4 ms for a unit of large splats, as a slow device calculates; watchdogs wait for seconds.
enum { DEFAULT_TILE_PX = 8, DEFAULT_UNIT = 1024, DEFAULT_EDGE_UNITS = 64 };

void ewa_gl_compute_destroy(ewa_context *context, void *state) {
    ewa_gl_compute *old = state;
    if (old->device && !old->device->lost && ewa_gl_enter(old->device) == EWA_OK) {
        for (int i = 0; i < EWA_GL_BUFFERS; i++) ewa_gl_buffer_free(&old->buffers[i]);
        ewa_gl_variants_free(&old->variants);
        ewa_gl_times_free(&old->times);
        ewa_gl_residents_free(old->device, &old->residents);
        ewa_gl_leave(old->device);
    } else if (old->device) {
        ewa_gl_residents_free(old->device, &old->residents);
    }
    ewa_gl_close(&old->device);
    ewa_gl_host_records_free(context, &old->host_records);
    ewa_buffer_free(context, &old->indices);
    ewa_buffer_free(context, &old->segments);
    ewa_buffer_free(context, &old->uses);
    ewa_buffer_free(context, &old->placements);
    ewa_buffer_free(context, &old->views);
    ewa_buffer_free(context, &old->parts);
    ewa_job_room_free(context, &old->room);
    ewa_release(context, old, 1, sizeof *old);
}

ewa_status ewa_gl_try(ewa_gl *device, ewa_gl_verdict *verdict) {
    enum { STORAGE_BLOCKS = 14, BINDINGS = 16, GROUP_THREADS = 256 };
    const ewa_gl_facts *facts = &device->facts;
    *verdict = (ewa_gl_verdict){.exact = false};
    if (!facts->compute || !facts->with_doubles || facts->storage_count < STORAGE_BLOCKS ||
        facts->binding_count < BINDINGS || facts->group_threads < GROUP_THREADS)
        return ewa_fail(
            device->context, EWA_ERROR_UNSUPPORTED,
            "OpenGL: %s (%s) has no compute programs, or small ones: %u storage blocks in %u places, groups of %u",
            facts->renderer, facts->version, facts->storage_count, facts->binding_count, facts->group_threads);
    EWA_TRY(ewa_gl_enter(device));
    const uint64_t lose_at = device->lose_at, hang_at = device->hang_at;
    device->lose_at = device->hang_at = 0; // which tests mean of frames
    ewa_status status = ewa_gl_selftest(device, verdict);
    ewa_gl_leave(device);
    device->wait_count = 0, device->lose_at = lose_at, device->hang_at = hang_at;
    device->counts = (ewa_gl_counts){0};
    return status;
}

/// What is thought of a device before its first frame: as slow as a small one that shares the processor's memory.
static void set_pace(ewa_gl_compute *gl) {
    enum { SURFEL_NS = 100 };
    gl->watched = !gl->device->facts.software || ewa_gl_tuning("surfel_ns", 0);
    gl->surfel_s = 1e-9 * (double)ewa_gl_tuning("surfel_ns", SURFEL_NS);
}

ewa_status ewa_gl_compute_create(ewa_context *context, void **state) {
    ewa_gl_compute *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->finer = 1;
    made->room.eye_dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pipeline_kernels);
    made->tile_px = (uint32_t)ewa_gl_tuning("tile_px", DEFAULT_TILE_PX);
    made->unit_splats = (uint32_t)ewa_gl_tuning("unit", DEFAULT_UNIT);
    made->edge_units = (uint32_t)ewa_gl_tuning("edge_units", DEFAULT_EDGE_UNITS);
    made->min_parts = (uint32_t)ewa_gl_tuning("parts", 1);
    made->residents.page_packets = (uint32_t)ewa_gl_tuning("page", 0);
    made->residents.kept_bytes = ewa_gl_tuning("kept", 0);
    ewa_status status = ewa_gl_open(context, &made->device);
    if (status == EWA_OK) status = ewa_gl_try(made->device, &made->verdict);
    if (status == EWA_OK) set_pace(made);
    made->variants.arithmetic = made->verdict.arithmetic;
    if (status != EWA_OK) {
        ewa_gl_compute_destroy(context, made);
        return status;
    }
    *state = made;
    return EWA_OK;
}

/// How many rows a band of this frame may have: as many as fitted when one like it was drawn.
static void recall_rows(ewa_gl_compute *gl, const ewa_tile_job *job) {
    ewa_gl_fit now = {job->tiles.width_px, job->tiles.height_px, UINT32_MAX, gl->device->surfel_count};
    const ewa_gl_fit *before = &gl->fit;
    if (now.width_px != before->width_px || now.height_px != before->height_px || now.splat_count != before->splat_count)
        gl->fit = now;
}

/// Draws rows, in bands of fewer where they do not fit the device.
static ewa_status draw_rows(ewa_gl_compute *gl, const ewa_tile_job *job, uint32_t first_row_px,
                            uint32_t end_row_px, ewa_gl_outcome *outcome) {
    recall_rows(gl, job);
    for (uint32_t row = first_row_px; row < end_row_px;) {
        const uint32_t left = end_row_px - row, end = left > gl->fit.rows_px ? row + gl->fit.rows_px : end_row_px;
        const uint32_t fields = (end - row + EWA_FIELD_PX - 1) / EWA_FIELD_PX;
        if (fields > 1) ewa_failures_soften(gl->context, true);
        const ewa_status status = ewa_gl_band_draw(gl, job, (ewa_gl_rows){row, end}, outcome);
        if (fields > 1) ewa_failures_soften(gl->context, false);
        if ((status == EWA_ERROR_LIMIT || status == EWA_ERROR_MEMORY) && fields > 1) {
            gl->fit.rows_px = fields / 2 * EWA_FIELD_PX;
            gl->marks = (ewa_gl_marks){0};
            continue;
        }
        EWA_TRY(status);
        row = end;
        EWA_TRY(
            ewa_progress(gl->context, "render", (double)(row - first_row_px) / (end_row_px - first_row_px)));
    }
    return EWA_OK;
}

/// Copies an environment, unless it is there; without one, there is a buffer all the same.
static ewa_status put_environment(ewa_gl_compute *gl, const ewa_environment *environment) {
    if (environment && gl->environment_serial == environment->serial) return EWA_OK;
    uint64_t texels = 0;
    for (uint32_t i = 0; environment && i < environment->level_count; i++)
        texels += (uint64_t)environment->levels[i].width * environment->levels[i].height;
    ewa_gl_buffer *buffer = &gl->buffers[EWA_GL_ENVIRONMENT];
    const ewa_status status = ewa_gl_buffer_reserve(gl->device, buffer, "the environment", texels * 12);
    gl->environment_serial = 0;
    if (status != EWA_OK || !environment) return status;
    texels = 0;
    for (uint32_t i = 0; i < environment->level_count; i++) {
        const ewa_environment_level *level = &environment->levels[i];
        const uint64_t here = (uint64_t)level->width * level->height;
        ewa_gl_buffer_write(gl->device, buffer, texels * 12, level->texels, here * 12);
        texels += here;
    }
    gl->environment_serial = environment->serial;
    return EWA_OK;
}

/// Which streams of a source a frame reads: bits of ewa_gl_stream.
static uint32_t streams_of(const ewa_tile_job *job, const ewa_tile_source *source, const ewa_gl_resident *resident) {
    const bool wanted[EWA_GL_STREAMS] = {[EWA_GL_OPACITIES] = job->with_opacity,
                                         [EWA_GL_CURVATURES] = source->packets.curvatures != NULL,
                                         [EWA_GL_MATERIALS] = job->with_materials,
                                         [EWA_GL_CLIP_MASKS] = source->packets.clip_masks != NULL};
    uint32_t streams = 0;
    for (int stream = 0; stream < EWA_GL_STREAMS; stream++) streams |= wanted[stream] ? resident->streams & 1u << stream : 0;
    return streams;
}

/// Lists which packets of which pages the frame draws, page by page.
static ewa_status put_segments(ewa_gl_compute *gl, const ewa_tile_job *job) {
    const ewa_gl_residents *residents = &gl->residents;
    const uint32_t *indices = gl->indices.data;
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->source_count; i++) count += ewa_gl_residents_at(residents, indices[i])->piece_count;
    EWA_TRY(ewa_buffer_reserve(gl->context, &gl->segments, count, sizeof(ewa_gl_segment)));
    EWA_TRY(ewa_buffer_reserve(gl->context, &gl->uses, residents->page_count, sizeof(ewa_gl_page_use)));
    ewa_gl_segment *segments = gl->segments.data;
    ewa_gl_page_use *uses = gl->uses.data;
    gl->use_count = 0;
    uint32_t at = 0;
    for (uint32_t page = 0; page < residents->page_count; page++) {
        ewa_gl_page_use use = {.page = page, .first = at};
        for (uint32_t i = 0; i < job->source_count; i++) {
            const ewa_gl_resident *resident = ewa_gl_residents_at(residents, indices[i]);
            const ewa_gl_piece *pieces = resident->pieces.data;
            for (uint32_t k = 0; k < resident->piece_count; k++) {
                if (pieces[k].page != page) continue;
                segments[at++] = (ewa_gl_segment){.first_group = use.group_count,
                                                  .at = pieces[k].at,
                                                  .count = pieces[k].count,
                                                  .source = i,
                                                  .first = pieces[k].first,
                                                  .streams = streams_of(job, &job->sources[i], resident)};
                use.group_count += (pieces[k].count + EWA_GL_GROUP_PACKETS - 1) / EWA_GL_GROUP_PACKETS;
            }
        }
        use.end = at;
        if (use.group_count) uses[gl->use_count++] = use;
    }
    return ewa_gl_buffer_put(gl->device, &gl->buffers[EWA_GL_SEGMENTS], "packets", segments,
                             (uint64_t)count * sizeof *segments);
}

/// What all bands of the frame see: views, lights, materials, the environment, surfels.
static ewa_status put_frame(ewa_gl_compute *gl, const ewa_tile_job *job) {
    ewa_context *context = gl->context;
    EWA_TRY(ewa_buffer_reserve(context, &gl->views, job->source_count, sizeof(ewa_gl_view)));
    EWA_TRY(ewa_buffer_reserve(context, &gl->indices, job->source_count, sizeof(uint32_t)));
    EWA_TRY(ewa_buffer_reserve(context, &gl->placements, job->source_count, sizeof(ewa_gl_placement)));
    ewa_gl_view *views = gl->views.data;
    ewa_gl_placement *placements = gl->placements.data;
    uint32_t *indices = gl->indices.data;
    ewa_gl_residents_start(gl->device, &gl->residents);
    for (uint32_t i = 0; i < job->source_count; i++) {
        ewa_gl_view_set(&views[i], &job->sources[i].view, job->sources[i].hides);
        ewa_gl_placement_set(&placements[i], &job->sources[i].view, job->sources[i].packets.material);
        EWA_TRY(ewa_gl_residents_get(gl->device, &gl->residents, job->sources[i].surfels, &indices[i]));
    }
    EWA_TRY(put_segments(gl, job));
    ewa_gl_resolve resolve;
    ewa_gl_resolve_set(&resolve, &job->resolve);
    memcpy(resolve.materials, job->materials, sizeof resolve.materials);
    ewa_gl_buffer *buffers = gl->buffers;
    const uint64_t count = job->source_count;
    EWA_TRY(ewa_gl_buffer_put(gl->device, &buffers[EWA_GL_VIEWS], "views", views, count * sizeof *views));
    EWA_TRY(ewa_gl_buffer_put(gl->device, &buffers[EWA_GL_PLACEMENTS], "views", placements, count * sizeof *placements));
    EWA_TRY(ewa_gl_buffer_put(gl->device, &buffers[EWA_GL_RESOLVE], "lights", &resolve, sizeof resolve));
    EWA_TRY(put_environment(gl, job->resolve.environment));
    return ewa_gl_check(gl->device, "the frame");
}

ewa_status ewa_gl_compute_draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats) {
    ewa_gl_compute *gl = state;
    const double start_s = ewa_now_s();
    ewa_tile_job job;
    EWA_TRY(ewa_tile_job_make(gl->context, &gl->room, frame, EWA_FIELD_PX, &job));
    ewa_gl_outcome outcome = {0};
    EWA_TRY(ewa_gl_enter(gl->device));
    gl->device->counts = (ewa_gl_counts){0};
    gl->device->surfel_count = 0;
    for (uint32_t i = 0; i < job.source_count; i++) gl->device->surfel_count += job.sources[i].surfels->count;
    ewa_gl_times_start(&gl->times);
    ewa_gl_times_resume(&gl->times);
    ewa_status status = put_frame(gl, &job);
    if (status == EWA_OK) status = draw_rows(gl, &job, frame->first_row_px, frame->end_row_px, &outcome);
    ewa_gl_leave(gl->device);
    EWA_TRY(status);
    if (outcome.lit) gl->room.with_eye_dome = false;
    ewa_job_finish(gl->context, &gl->room, frame, outcome.broken);
    *stats = (ewa_render_stats){0};
    ewa_gl_times_tell(&gl->times, stats);
    const double *passes_s = gl->times.seconds; // those that are given in parts
    const double longest_s = fmax(fmax(passes_s[EWA_GL_SETUP], passes_s[EWA_GL_VISIBILITY]),
                                  fmax(passes_s[EWA_GL_SUMS], passes_s[EWA_GL_EDGES]));
    if (gl->device->surfel_count) gl->surfel_s = longest_s / (double)gl->device->surfel_count;
    ewa_job_count(&job, 0, stats);
    uint64_t packets = 0;
    for (uint32_t i = 0; i < job.source_count; i++) packets += job.sources[i].surfels->packet_count;
    const uint64_t culled = (packets - outcome.kept_packets) * EWA_PACKET_LANES;
    stats->culled_count = culled < stats->splat_count ? culled : stats->splat_count;
    stats->drawn_count = outcome.drawn;
    stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

static ewa_status draw_parts(void *state, const ewa_render_job *job, uint32_t finer, ewa_render_stats *stats) {
    ewa_gl_compute *gl = state;
    return ewa_parts_draw_averaged(gl->context, &ewa_backend_gl, state, job, finer, &gl->parts, &gl->finer, stats);
}

void ewa_gl_describe_device(const ewa_gl *device, const ewa_gl_verdict *verdict, ewa_renderer_info *info) {
    snprintf(info->device, sizeof info->device, "%s", device->facts.renderer);
    info->device_class = verdict->exact ? EWA_GPU_EXACT : EWA_GPU_CLOSE;
    const ewa_gl_counts *counts = &device->counts;
    info->wait_count = counts->waits, info->readback_count = counts->readbacks;
    info->dispatch_count = counts->dispatches, info->upload_bytes = counts->upload_bytes;
    info->readback_bytes = counts->readback_bytes;
    if (device->facts.software) snprintf(info->remark, sizeof info->remark, "%.100s is software", device->facts.renderer);
}

static void describe(const void *state, ewa_renderer_info *info) {
    const ewa_gl_compute *gl = state;
    ewa_gl_describe_device(gl->device, &gl->verdict, info);
}

const ewa_backend ewa_backend_gl = {.name = "gl",
                                    .create = ewa_gl_compute_create,
                                    .destroy = ewa_gl_compute_destroy,
                                    .draw = ewa_gl_compute_draw,
                                    .describe = describe,
                                    .draw_parts = draw_parts};
