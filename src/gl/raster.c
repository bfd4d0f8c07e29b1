// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pipeline of "Perspective Accurate Splatting" (Zwicker, Räsänen, Botsch, Dachsbacher, Pauly 2004), section 6, by
// OpenGL 3.3: the nearest surfaces by MAX, sums by ADD, pixels from sums; then the same beyond, for what lies behind edges and
// through surfaces. Its sums are floats: close to the processor's pictures, not equal to them.
#include "gl/raster.h"
#include "gl/backends.h"
#include "gl/raster_splats.h"
#include "surface/supersampling.h"

#include <stdio.h>
#include <string.h>

void ewa_raster_destroy(ewa_context *context, void *state) {
    ewa_raster *old = state;
    if (old->device && ewa_gl_enter(old->device) == EWA_OK) {
        ewa_raster_programs_free(&old->programs);
        ewa_raster_targets_free(&old->targets);
        ewa_gl_buffer_free(&old->packets);
        ewa_gl_buffer_free(&old->view_blocks);
        ewa_gl_buffer_free(&old->resolve_block);
        ewa_gl_buffer_free(&old->material_block);
        glDeleteTextures(1, &old->environment);
        glDeleteVertexArrays(1, &old->vertices);
        glDeleteQueries(1, &old->query);
        ewa_raster_residents_free(old->device, &old->residents);
        ewa_gl_leave(old->device);
    } else if (old->device) {
        ewa_raster_residents_forget(context, &old->residents);
    }
    ewa_gl_close(&old->device);
    ewa_raster_band_free(context, &old->band);
    ewa_buffer_free(context, &old->indices);
    ewa_buffer_free(context, &old->views);
    ewa_buffer_free(context, &old->row);
    ewa_buffer_free(context, &old->parts);
    ewa_job_room_free(context, &old->room);
    ewa_release(context, old, 1, sizeof *old);
}

ewa_status ewa_raster_create(ewa_context *context, void **state) {
    ewa_raster *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->finer = 1;
    made->room.eye_dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pipeline_kernels);
    ewa_status status = ewa_gl_open(context, &made->device);
    if (status == EWA_OK) status = ewa_gl_enter(made->device);
    if (status == EWA_OK) {
        glGenVertexArrays(1, &made->vertices);
        glGenQueries(1, &made->query);
        status = ewa_gl_check(made->device, "start");
        ewa_gl_leave(made->device);
    }
    if (status != EWA_OK) {
        ewa_raster_destroy(context, made);
        return status;
    }
    *state = made;
    return EWA_OK;
}

/// What this pipeline leaves to others.
static ewa_status check(const ewa_raster *raster, const ewa_tile_job *job) {
    ewa_context *context = raster->context;
    const uint32_t max_px = raster->device->facts.texture_px;
    if (job->tiles.width_px > max_px)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "OpenGL: %u pixels are wider than the %u of %s",
                        job->tiles.width_px, max_px, raster->device->facts.renderer);
    return EWA_OK;
}

/// Whether the nearest splats are found by the test of depths. Materials are not: they would be drawn after that.
static bool is_single(const ewa_tile_job *job) { return job->resolve.one_pass && !job->with_materials; }

/// The pictures that a frame needs.
static uint32_t wanted_pictures(const ewa_tile_job *job, uint32_t finer) {
    const bool layered = job->layers > 1, both = !job->view.cull_back,
               normals = job->with_normals || job->with_depth;
    const ewa_resolve *to = &job->resolve;
    const struct {
        ewa_raster_picture picture;
        bool wanted;
    } needs[] = {{EWA_PICTURE_NEAREST, true},
                 {EWA_PICTURE_PASSED, layered},
                 {EWA_PICTURE_COLOR, true},
                 {EWA_PICTURE_NORMAL, normals},
                 {EWA_PICTURE_CUT, job->with_clips},
                 {EWA_PICTURE_OPACITY, job->with_opacity},
                 {EWA_PICTURE_COLOR_BACK, both},
                 {EWA_PICTURE_NORMAL_BACK, both && normals},
                 {EWA_PICTURE_OPACITY_BACK, both && job->with_opacity},
                 {EWA_PICTURE_COMPOSED, true},
                 {EWA_PICTURE_FIRST_CUT, layered && job->with_clips},
                 {EWA_PICTURE_MATERIAL, job->with_materials},
                 {EWA_PICTURE_REFLECTION, job->with_materials},
                 {EWA_PICTURE_MATERIAL_BACK, both && job->with_materials},
                 {EWA_PICTURE_REFLECTION_BACK, both && job->with_materials},
                 {EWA_PICTURE_DEPTH, is_single(job)},
                 {EWA_PICTURE_PLANES, to->depth || to->normal},
                 {EWA_PICTURE_COVERAGE, to->coverage},
                 {EWA_PICTURE_CODES, to->rgba8},
                 {EWA_PICTURE_FLOATS, to->rgba},
                 {EWA_PICTURE_MEANS, finer > 1 && to->rgba},
                 {EWA_PICTURE_MEAN_PLANES, finer > 1 && (to->depth || to->normal)},
                 {EWA_PICTURE_MEAN_COVERAGE, finer > 1 && to->coverage}};
    uint32_t wanted = 0;
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++)
        if (needs[i].wanted) wanted |= 1u << needs[i].picture;
    return wanted;
}

/// The numbers of materials, and the environment, as pictures and blocks.
static ewa_status put_shading(ewa_raster *raster, const ewa_tile_job *job) {
    ewa_gl *device = raster->device;
    if (job->with_materials) {
        float blocks[EWA_MAX_MATERIALS][8] = {{0}};
        for (int i = 0; i < EWA_MAX_MATERIALS; i++)
            memcpy(blocks[i], job->materials[i], sizeof job->materials[i]);
        EWA_TRY(ewa_gl_buffer_put(device, &raster->material_block, "materials", blocks, sizeof blocks));
    }
    const ewa_environment *environment = job->resolve.environment;
    if (!environment || job->resolve.shading != EWA_PIPELINE_PHONG) return EWA_OK;
    uint64_t count = 0;
    for (uint32_t i = 0; i < environment->level_count; i++)
        count += (uint64_t)environment->levels[i].width * environment->levels[i].height;
    const uint32_t max_px = device->facts.texture_px, width = max_px < 4096 ? max_px : 4096;
    const uint64_t rows = (count + width - 1) / width;
    if (rows > max_px)
        return ewa_fail(raster->context, EWA_ERROR_LIMIT,
                        "OpenGL: an environment of %llu texels is larger than pictures of %s",
                        (unsigned long long)count, device->facts.renderer);
    EWA_TRY(ewa_buffer_reserve(raster->context, &raster->row, (size_t)rows * width, 3 * sizeof(float)));
    float *texels = raster->row.data;
    memset(texels, 0, (size_t)rows * width * 3 * sizeof *texels);
    for (uint32_t i = 0; i < environment->level_count; i++) {
        const size_t here = (size_t)environment->levels[i].width * environment->levels[i].height * 3;
        memcpy(texels, environment->levels[i].texels, here * sizeof *texels);
        texels += here;
    }
    if (!raster->environment) glGenTextures(1, &raster->environment);
    glActiveTexture(GL_TEXTURE0 + EWA_PICTURE_OTHER);
    glBindTexture(GL_TEXTURE_2D, raster->environment);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, (GLsizei)width, (GLsizei)rows, 0, GL_RGB, GL_FLOAT,
                 raster->row.data);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return ewa_gl_check(device, "the environment");
}

static ewa_status put_band(ewa_raster *raster, const ewa_tile_job *job) {
    const ewa_raster_band *band = &raster->band;
    const uint64_t views_bytes = (uint64_t)job->source_count * EWA_RASTER_VIEW_STRIDE;
    EWA_TRY(ewa_buffer_reserve(raster->context, &raster->views, views_bytes, 1));
    memset(raster->views.data, 0, views_bytes);
    for (uint32_t i = 0; i < job->source_count; i++) {
        ewa_raster_view view;
        ewa_raster_view_set(&view, &job->sources[i].view, job, band);
        memcpy((char *)raster->views.data + (size_t)i * EWA_RASTER_VIEW_STRIDE, &view, sizeof view);
    }
    ewa_raster_resolve resolve;
    ewa_raster_resolve_set(&resolve, job, band);
    EWA_TRY(
        ewa_gl_buffer_put(raster->device, &raster->view_blocks, "views", raster->views.data, views_bytes));
    EWA_TRY(ewa_gl_buffer_put(raster->device, &raster->resolve_block, "lights", &resolve, sizeof resolve));
    EWA_TRY(ewa_gl_buffer_put(raster->device, &raster->packets, "packets", band->packets.data,
                              (uint64_t)band->packet_count * sizeof(ewa_raster_packet)));
    return ewa_raster_targets_reserve(raster->device, &raster->targets, job->tiles.width_px,
                                      band->end_row_px - band->first_row_px, wanted_pictures(job, raster->finer));
}

static void start_target(const ewa_raster *raster, ewa_raster_target target) {
    glBindFramebuffer(GL_FRAMEBUFFER, raster->targets.targets[target]);
}

static void clear(const ewa_raster *raster, ewa_raster_target target, ewa_raster_picture picture,
                  GLint output, float value) {
    if (!(raster->targets.made >> picture & 1)) return;
    const float values[4] = {value, value, value, value};
    start_target(raster, target);
    glClearBufferfv(GL_COLOR, output, values);
}

/// Lets programs read a target's pictures; not those that are drawn into.
static void bind_maps(const ewa_raster *raster, uint32_t maps) {
    for (GLuint i = 0; i < EWA_PICTURE_MEANS; i++) {
        if (i == EWA_PICTURE_OTHER) continue;
        glActiveTexture(GL_TEXTURE0 + i);
        glBindTexture(GL_TEXTURE_2D, maps >> i & 1 ? raster->targets.pictures[i] : 0);
    }
}

/// One pass: the nearest splat of each pixel.
static ewa_status gather_single(ewa_raster *raster, const ewa_tile_job *job) {
    static const float nowhere = 0;
    start_target(raster, EWA_TARGET_SUMS);
    glClearBufferfv(GL_DEPTH, 0, &nowhere);
    bind_maps(raster, 0);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    const ewa_status status = ewa_raster_draw_splats(raster, job, EWA_RASTER_SINGLE, false, false, false);
    glDisable(GL_DEPTH_TEST);
    return status;
}

/// Both passes over the band's splats; `behind` the first surface, or of it. `whole`: all that is left is one.
static ewa_status gather(ewa_raster *raster, const ewa_tile_job *job, bool behind, bool whole) {
    static const ewa_raster_picture sums[] = {EWA_PICTURE_COLOR, EWA_PICTURE_NORMAL, EWA_PICTURE_CUT,
                                              EWA_PICTURE_OPACITY};
    static const ewa_raster_picture back_sums[] = {EWA_PICTURE_COLOR_BACK, EWA_PICTURE_NORMAL_BACK,
                                                   EWA_PICTURE_CUT, EWA_PICTURE_OPACITY_BACK};
    clear(raster, EWA_TARGET_NEAREST, EWA_PICTURE_NEAREST, 0, (float)EWA_RASTER_NEVER);
    for (GLint i = 0; i < 2; i++) {
        clear(raster, EWA_TARGET_MATERIAL, (ewa_raster_picture)(EWA_PICTURE_MATERIAL + i), i, 0);
        clear(raster, EWA_TARGET_MATERIAL_BACK, (ewa_raster_picture)(EWA_PICTURE_MATERIAL_BACK + i), i, 0);
    }
    for (GLint i = 0; i < 4; i++) {
        clear(raster, EWA_TARGET_SUMS, sums[i], i, 0);
        clear(raster, EWA_TARGET_BACK_FACING, back_sums[i], i, 0);
    }
    if (is_single(job)) return gather_single(raster, job);
    glEnable(GL_BLEND);
    bind_maps(raster, 1u << EWA_PICTURE_PASSED);
    start_target(raster, EWA_TARGET_NEAREST);
    glBlendEquation(GL_MAX);
    ewa_status status = EWA_OK;
    if (!whole) status = ewa_raster_draw_splats(raster, job, EWA_RASTER_VISIBILITY, false, behind, false);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    bind_maps(raster, 1u << EWA_PICTURE_PASSED | 1u << EWA_PICTURE_NEAREST);
    for (int is_back = 0; is_back < (job->view.cull_back ? 1 : 2) && status == EWA_OK; is_back++) {
        start_target(raster, is_back ? EWA_TARGET_BACK_FACING : EWA_TARGET_SUMS);
        status = ewa_raster_draw_splats(raster, job, EWA_RASTER_SUMS, is_back != 0, behind, whole);
        if (status != EWA_OK || !job->with_materials) continue;
        start_target(raster, is_back ? EWA_TARGET_MATERIAL_BACK : EWA_TARGET_MATERIAL);
        glBindBufferBase(GL_UNIFORM_BUFFER, 2, raster->material_block.name);
        status = ewa_raster_draw_splats(raster, job, EWA_RASTER_MATERIALS, is_back != 0, behind, whole);
    }
    glDisable(GL_BLEND);
    return status;
}

/// Draws a triangle over the band.
static ewa_status draw_stage(ewa_raster *raster, const ewa_tile_job *job, ewa_raster_stage stage,
                             ewa_raster_target target, uint32_t maps, bool behind, bool whole) {
    GLuint program = 0;
    EWA_TRY(ewa_raster_stage_program(raster->device, &raster->programs, stage, job->with_clips, &program));
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "behind"), behind);
    glUniform1i(glGetUniformLocation(program, "whole"), whole);
    glUniform1i(glGetUniformLocation(program, "finer"), (GLint)raster->finer);
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, raster->resolve_block.name);
    start_target(raster, target);
    bind_maps(raster, maps);
    glActiveTexture(GL_TEXTURE0 + EWA_PICTURE_OTHER);
    glBindTexture(GL_TEXTURE_2D, raster->environment);
    glBindVertexArray(raster->vertices);
    for (GLuint i = 0; i < EWA_RASTER_ATTRIBUTES; i++) glDisableVertexAttribArray(i);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return ewa_gl_check(raster->device, "surfaces");
}

enum {
    SUM_MAPS = 1u << EWA_PICTURE_COLOR | 1u << EWA_PICTURE_NORMAL | 1u << EWA_PICTURE_CUT |
               1u << EWA_PICTURE_OPACITY | 1u << EWA_PICTURE_COLOR_BACK | 1u << EWA_PICTURE_NORMAL_BACK |
               1u << EWA_PICTURE_OPACITY_BACK | 1u << EWA_PICTURE_MATERIAL | 1u << EWA_PICTURE_REFLECTION |
               1u << EWA_PICTURE_MATERIAL_BACK | 1u << EWA_PICTURE_REFLECTION_BACK,
    COMPOSED_MAP = 1u << EWA_PICTURE_COMPOSED
};

/// Puts the surface that has been gathered under those before it.
static ewa_status compose(ewa_raster *raster, const ewa_tile_job *job, bool behind, bool whole) {
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    const uint32_t maps = SUM_MAPS | (behind ? 1u << EWA_PICTURE_FIRST_CUT : 0);
    const ewa_status status =
        draw_stage(raster, job, EWA_RASTER_COMPOSE, EWA_TARGET_COMPOSED, maps, behind, whole);
    glDisable(GL_BLEND);
    return status;
}

/// Counts the pixels that a stage draws.
static ewa_status draw_counted(ewa_raster *raster, const ewa_tile_job *job, ewa_raster_stage stage,
                               ewa_raster_target target, uint32_t maps, GLenum counter, GLuint *count) {
    glBeginQuery(counter, raster->query);
    ewa_status status = draw_stage(raster, job, stage, target, maps, false, false);
    glEndQuery(counter);
    if (status == EWA_OK) status = ewa_gl_wait(raster->device, "surfaces");
    if (status == EWA_OK) glGetQueryObjectuiv(raster->query, GL_QUERY_RESULT, count);
    return status;
}

/// Draws what lies behind the first surface, while any pixel is open.
static ewa_status draw_layers(ewa_raster *raster, const ewa_tile_job *job) {
    if (job->with_clips && job->layers > 1)
        EWA_TRY(draw_stage(raster, job, EWA_RASTER_CUT, EWA_TARGET_FIRST_CUT, SUM_MAPS, false, false));
    for (uint32_t layer = 1; layer < job->layers; layer++) {
        GLuint open = 0;
        clear(raster, EWA_TARGET_PASSED, EWA_PICTURE_PASSED, 0, (float)EWA_RASTER_NEVER);
        EWA_TRY(draw_counted(raster, job, EWA_RASTER_PEEL, EWA_TARGET_PASSED,
                             COMPOSED_MAP | 1u << EWA_PICTURE_NEAREST, GL_SAMPLES_PASSED, &open));
        if (!open) break;
        const bool whole = job->merge_last && layer + 1 == job->layers;
        EWA_TRY(gather(raster, job, true, whole));
        EWA_TRY(compose(raster, job, true, whole));
        EWA_TRY(ewa_progress(raster->context, "render", 0));
    }
    return EWA_OK;
}

/// Pixels that the caller gets of the band: the first, and its size.
typedef struct band_pixels {
    uint64_t first;
    uint32_t width_px, height_px;
} band_pixels;

static band_pixels pixels_of(const ewa_raster *raster, const ewa_tile_job *job) {
    const uint32_t finer = raster->finer, first_row_px = raster->band.first_row_px / finer;
    band_pixels of = {.width_px = job->tiles.width_px / finer, .height_px = raster->band.end_row_px / finer - first_row_px};
    of.first = (uint64_t)of.width_px * first_row_px;
    return of;
}

static ewa_status read_target(ewa_raster *raster, const band_pixels *of, ewa_raster_target target, GLuint output, GLenum format,
                              GLenum kind, void *to) {
    start_target(raster, target);
    glReadBuffer(GL_COLOR_ATTACHMENT0 + output);
    glReadPixels(0, 0, (GLsizei)of->width_px, (GLsizei)of->height_px, format, kind, to);
    return ewa_gl_check(raster->device, "the picture");
}

/// Fetches the first surface's normals and depths.
static ewa_status read_planes(ewa_raster *raster, const ewa_tile_job *job, const band_pixels *of) {
    const ewa_resolve *to = &job->resolve;
    const uint64_t pixels = (uint64_t)of->width_px * of->height_px;
    const bool means = raster->finer > 1;
    const ewa_raster_target target = means ? EWA_TARGET_MEANS : EWA_TARGET_PLANES;
    if (to->coverage) EWA_TRY(read_target(raster, of, target, means ? 2 : 1, GL_RED, GL_FLOAT, to->coverage + of->first));
    if (!(to->normal || to->depth)) return EWA_OK;
    EWA_TRY(ewa_buffer_reserve(raster->context, &raster->row, pixels, 4 * sizeof(float)));
    EWA_TRY(read_target(raster, of, target, means ? 1 : 0, GL_RGBA, GL_FLOAT, raster->row.data));
    const float *from = raster->row.data;
    for (uint64_t i = 0; i < pixels; i++) {
        if (to->normal) memcpy(to->normal + 3 * (of->first + i), from + 4 * i, 3 * sizeof *from);
        if (to->depth) to->depth[of->first + i] = from[4 * i + 3];
    }
    return EWA_OK;
}

/// Makes the averages of the band's parts of pixels.
static ewa_status draw_means(ewa_raster *raster, const ewa_tile_job *job, const band_pixels *of) {
    const uint32_t maps = 1u << EWA_PICTURE_FLOATS | 1u << EWA_PICTURE_PLANES | 1u << EWA_PICTURE_COVERAGE;
    glViewport(0, 0, (GLsizei)of->width_px, (GLsizei)of->height_px);
    return draw_stage(raster, job, EWA_RASTER_AVERAGE, EWA_TARGET_MEANS, maps, false, false);
}

/// Makes the band's pixels and fetches them; counts those without a colour.
static ewa_status finish_band(ewa_raster *raster, const ewa_tile_job *job, uint64_t *broken) {
    const ewa_resolve *to = &job->resolve;
    const band_pixels of = pixels_of(raster, job);
    const bool means = raster->finer > 1;
    ewa_status status = EWA_OK;
    if (to->rgba8 || to->rgba) {
        GLuint count = 0;
        status = draw_counted(raster, job, EWA_RASTER_BROKEN, EWA_TARGET_PICTURE, COMPOSED_MAP,
                              GL_SAMPLES_PASSED, &count);
        *broken += count;
        if (status == EWA_OK)
            status =
                draw_stage(raster, job, EWA_RASTER_PICTURE, EWA_TARGET_PICTURE, COMPOSED_MAP, false, false);
    }
    if (status == EWA_OK && means) status = draw_means(raster, job, &of);
    EWA_TRY(status);
    EWA_TRY(ewa_gl_wait(raster->device, "the picture"));
    if (to->rgba8)
        EWA_TRY(read_target(raster, &of, EWA_TARGET_PICTURE, 0, GL_RGBA, GL_UNSIGNED_BYTE, to->rgba8 + 4 * of.first));
    if (to->rgba)
        EWA_TRY(read_target(raster, &of, means ? EWA_TARGET_MEANS : EWA_TARGET_PICTURE, means ? 0 : 1, GL_RGBA, GL_FLOAT,
                            to->rgba + 4 * of.first));
    return read_planes(raster, job, &of);
}

static ewa_status draw_band(ewa_raster *raster, const ewa_tile_job *job, uint32_t first_row_px,
                            uint32_t end_row_px, uint64_t *broken) {
    const ewa_resolve *to = &job->resolve;
    EWA_TRY(ewa_raster_band_start(raster->context, &raster->band, job, first_row_px, end_row_px));
    EWA_TRY(put_band(raster, job));
    glViewport(0, 0, (GLsizei)job->tiles.width_px, (GLsizei)(end_row_px - first_row_px));
    clear(raster, EWA_TARGET_COMPOSED, EWA_PICTURE_COMPOSED, 0, 0);
    EWA_TRY(gather(raster, job, false, false));
    EWA_TRY(compose(raster, job, false, false));
    if (to->depth || to->normal || to->coverage)
        EWA_TRY(draw_stage(raster, job, EWA_RASTER_PLANES, EWA_TARGET_PLANES, SUM_MAPS, false, false));
    EWA_TRY(draw_layers(raster, job));
    return finish_band(raster, job, broken);
}

/// Draws rows, in bands of pictures that the device can hold.
static ewa_status draw_rows(ewa_raster *raster, const ewa_tile_job *job, uint32_t first_row_px,
                            uint32_t end_row_px, uint64_t *broken, uint64_t *surfel_count) {
    enum { MAX_PIXELS = 1 << 22 };
    const uint32_t width_px = job->tiles.width_px, texture_px = raster->device->facts.texture_px;
    uint32_t rows = MAX_PIXELS / width_px;
    if (rows > texture_px) rows = texture_px;
    rows = rows < EWA_FIELD_PX ? EWA_FIELD_PX : rows / EWA_FIELD_PX * EWA_FIELD_PX;
    for (uint32_t row = first_row_px; row < end_row_px; row += rows) {
        const uint32_t end = end_row_px - row < rows ? end_row_px : row + rows;
        ewa_status status = draw_band(raster, job, row, end, broken);
        *surfel_count += raster->band.surfel_count;
        if (status == EWA_OK)
            status = ewa_progress(raster->context, "render",
                                  (double)(end - first_row_px) / (end_row_px - first_row_px));
        EWA_TRY(status);
    }
    return EWA_OK;
}

static ewa_status put_surfels(ewa_raster *raster, const ewa_tile_job *job) {
    ewa_status status =
        ewa_buffer_reserve(raster->context, &raster->indices, job->source_count, sizeof(uint32_t));
    uint32_t *indices = raster->indices.data;
    ewa_raster_residents_start(raster->device, &raster->residents);
    for (uint32_t i = 0; i < job->source_count && status == EWA_OK; i++)
        status = ewa_raster_residents_get(raster->device, &raster->residents, job->sources[i].surfels,
                                          &indices[i]);
    return status;
}

ewa_status ewa_raster_draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats) {
    ewa_raster *raster = state;
    const double start_s = ewa_now_s();
    ewa_tile_job job;
    EWA_TRY(ewa_tile_job_make(raster->context, &raster->room, frame, EWA_FIELD_PX, &job));
    EWA_TRY(ewa_tile_job_bin(raster->context, &raster->room, &job));
    EWA_TRY(check(raster, &job));
    const double binned_s = ewa_now_s();
    uint64_t broken = 0, surfel_count = 0;
    EWA_TRY(ewa_gl_enter(raster->device));
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DITHER);
    ewa_status status = put_surfels(raster, &job);
    if (status == EWA_OK) status = put_shading(raster, &job);
    if (status == EWA_OK)
        status = draw_rows(raster, &job, frame->first_row_px, frame->end_row_px, &broken, &surfel_count);
    ewa_gl_leave(raster->device);
    EWA_TRY(status);
    ewa_job_finish(raster->context, &raster->room, frame, broken);
    *stats = (ewa_render_stats){.bin_s = binned_s - start_s};
    ewa_job_count(&job, 0, stats);
    stats->drawn_count = surfel_count;
    stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

static ewa_status draw_parts(void *state, const ewa_render_job *job, uint32_t finer, ewa_render_stats *stats) {
    ewa_raster *raster = state;
    return ewa_parts_draw_averaged(raster->context, &ewa_backend_gl_raster, state, job, finer, &raster->parts, &raster->finer, stats);
}

static void describe(const void *state, ewa_renderer_info *info) {
    const ewa_raster *raster = state;
    snprintf(info->device, sizeof info->device, "%s", raster->device->facts.renderer);
    info->device_class = EWA_GPU_CLOSE; // by its arithmetic, whatever the device
    if (raster->device->facts.software)
        snprintf(info->remark, sizeof info->remark, "%.100s is software", raster->device->facts.renderer);
}

const ewa_backend ewa_backend_gl_raster = {.name = "gl-raster",
                                           .create = ewa_raster_create,
                                           .destroy = ewa_raster_destroy,
                                           .draw = ewa_raster_draw,
                                           .describe = describe,
                                           .draw_parts = draw_parts};
