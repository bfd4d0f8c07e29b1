// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pipeline as compute programs: the order of a frame's stages, in bands of rows that fit the device.
// Every sum and every rounding is that of src/surface, so that a device that keeps them draws the same bytes.
// Reference: src/reference/surface.c.
#include "gl/compute.h"
#include "gl/backends.h"
#include "gl/tuning.h"

#include <stdio.h>
#include <string.h>

enum { DEFAULT_TILE_PX = 8, DEFAULT_UNIT = 1024, THREADS = 64, COUNTERS = 2 };

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
    ewa_gl_band_free(context, &old->band);
    ewa_buffer_free(context, &old->page_packets);
    ewa_buffer_free(context, &old->indices);
    ewa_buffer_free(context, &old->views);
    ewa_job_room_free(context, &old->room);
    ewa_release(context, old, 1, sizeof *old);
}

ewa_status ewa_gl_try(ewa_gl *device, ewa_gl_verdict *verdict) {
    enum { STORAGE_BLOCKS = 14, GROUP_THREADS = 256 };
    const ewa_gl_facts *facts = &device->facts;
    *verdict = (ewa_gl_verdict){.exact = false};
    if (!facts->compute || !facts->with_doubles || facts->storage_count < STORAGE_BLOCKS ||
        facts->group_threads < GROUP_THREADS)
        return ewa_fail(
            device->context, EWA_ERROR_UNSUPPORTED,
            "OpenGL: %s (%s) has no compute programs, or small ones: %u storage blocks, groups of %u",
            facts->renderer, facts->version, facts->storage_count, facts->group_threads);
    EWA_TRY(ewa_gl_enter(device));
    const uint64_t lose_at = device->lose_at, hang_at = device->hang_at;
    device->lose_at = device->hang_at = 0; // which tests mean of frames
    ewa_status status = ewa_gl_selftest(device, verdict);
    ewa_gl_leave(device);
    device->wait_count = 0, device->lose_at = lose_at, device->hang_at = hang_at;
    device->counts = (ewa_gl_counts){0};
    return status;
}

ewa_status ewa_gl_compute_create(ewa_context *context, void **state) {
    ewa_gl_compute *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->room.eye_dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pipeline_kernels);
    made->tile_px = (uint32_t)ewa_gl_tuning("tile_px", DEFAULT_TILE_PX);
    made->unit_splats = (uint32_t)ewa_gl_tuning("unit", DEFAULT_UNIT);
    made->residents.page_packets = (uint32_t)ewa_gl_tuning("page", 0);
    ewa_status status = ewa_gl_open(context, &made->device);
    if (status == EWA_OK) status = ewa_gl_try(made->device, &made->verdict);
    made->variants.arithmetic = made->verdict.arithmetic;
    if (status != EWA_OK) {
        ewa_gl_compute_destroy(context, made);
        return status;
    }
    *state = made;
    return EWA_OK;
}

static ewa_status reserve(ewa_gl_compute *gl, ewa_gl_buffer_kind kind, const char *what,
                          uint64_t size_bytes) {
    return ewa_gl_buffer_reserve(gl->device, &gl->buffers[kind], what, size_bytes);
}

static ewa_status put(ewa_gl_compute *gl, ewa_gl_buffer_kind kind, const char *what, const void *bytes,
                      uint64_t size_bytes) {
    return ewa_gl_buffer_put(gl->device, &gl->buffers[kind], what, bytes, size_bytes);
}

static void bind(ewa_gl_compute *gl, GLuint binding, ewa_gl_buffer_kind kind) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, gl->buffers[kind].name);
}

/// Waits, and notes what the stages took.
static ewa_status wait_for(ewa_gl_compute *gl, const char *what) {
    EWA_TRY(ewa_gl_wait(gl->device, what));
    ewa_gl_times_read(&gl->times);
    ewa_gl_times_resume(&gl->times);
    return EWA_OK;
}

static void read_back(ewa_gl_compute *gl, ewa_gl_buffer_kind kind, uint64_t at_bytes, uint64_t size_bytes,
                      void *to) {
    if (!size_bytes) return;
    gl->device->counts.readbacks++;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, gl->buffers[kind].name);
    glGetBufferSubData(GL_COPY_READ_BUFFER, (GLintptr)at_bytes, (GLsizeiptr)size_bytes, to);
}

/// Places of the programs' own uniforms (layout(location) in src/gl/shaders): the first item of a dispatch, then those of the
/// set-up, and those of the passes.
enum { FIRST, END_PAIR, SOURCE, OPACITIES_AT, CURVATURES_AT, MATERIALS_AT, BEHIND = 1, WHOLE = 2 };

/// Runs a program that is in use in groups, as many at a time as the device takes.
static void dispatch(const ewa_gl_compute *gl, uint32_t step, uint32_t from, uint32_t group_count) {
    const uint32_t maximum = gl->device->facts.group_count;
    for (uint32_t done = 0; done < group_count; done += maximum) {
        glUniform1ui(FIRST, from + done * step);
        glDispatchCompute(group_count - done < maximum ? group_count - done : maximum, 1, 1);
        gl->device->counts.dispatches++;
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// What all programs of the frame depend on.
static ewa_gl_variant variant_of(const ewa_gl_compute *gl, const ewa_tile_job *job, ewa_gl_pass pass) {
    ewa_gl_variant v;
    memset(&v, 0, sizeof v);
    v.pass = (uint8_t)pass;
    if (pass == EWA_GL_SETUP || pass == EWA_GL_FILL) return v;
    v.tile_px = (uint8_t)gl->tile_px;
    v.with_clips = job->with_clips;
    v.rays = pass <= EWA_GL_SUMS && job->view.raycast;
    if (pass == EWA_GL_VISIBILITY) return v;
    v.with_normals = job->with_normals, v.with_depth = job->with_depth;
    v.with_materials = job->with_materials, v.with_opacity = job->with_opacity;
    v.with_fine = job->fine_sums;
    v.channel_count = (uint8_t)job->channel_count;
    return v;
}

/// Makes a pass's program the one in use.
static ewa_status use(ewa_gl_compute *gl, const ewa_tile_job *job, ewa_gl_pass pass) {
    const ewa_gl_variant variant = variant_of(gl, job, pass);
    GLuint program = 0;
    EWA_TRY(ewa_gl_variant_get(gl->device, &gl->variants, &variant, &program));
    glUseProgram(program);
    return EWA_OK;
}

/// Words of a channel's sum at a pixel.
static uint32_t sum_words(const ewa_tile_job *job) {
    return job->fine_sums || job->with_depth || job->with_clips ? 4 : 2;
}

/// Sets up the band's surfels and counts them by tile.
static ewa_status set_up(ewa_gl_compute *gl, const ewa_tile_job *job) {
    ewa_gl_band *band = &gl->band;
    EWA_TRY(use(gl, job, EWA_GL_SETUP));
    const uint64_t pairs = band->pair_count, lanes = pairs * EWA_PACKET_LANES;
    EWA_TRY(put(gl, EWA_GL_PAIRS, "packets", band->pairs.data, pairs * sizeof(ewa_gl_pair)));
    EWA_TRY(put(gl, EWA_GL_PLACES, "places", band->places.data, pairs * 24));
    EWA_TRY(put(gl, EWA_GL_WORDS, "packets", band->words.data, pairs * 8));
    EWA_TRY(reserve(gl, EWA_GL_RECORDS, "splats", lanes * EWA_GL_RECORD_BYTES));
    EWA_TRY(reserve(gl, EWA_GL_MASKS, "masks", pairs * 4));
    EWA_TRY(reserve(gl, EWA_GL_COUNTS, "tiles", (uint64_t)band->tile_count * 4));
    ewa_gl_buffer_fill(&gl->buffers[EWA_GL_MASKS], pairs * 4, 0);
    ewa_gl_buffer_fill(&gl->buffers[EWA_GL_COUNTS], (uint64_t)band->tile_count * 4, 0);
    bind(gl, 0, EWA_GL_VIEWS), bind(gl, 2, EWA_GL_PAIRS), bind(gl, 3, EWA_GL_PLACES),
        bind(gl, 4, EWA_GL_WORDS);
    bind(gl, 5, EWA_GL_RECORDS), bind(gl, 6, EWA_GL_COUNTS), bind(gl, 7, EWA_GL_MASKS);
    const uint32_t *indices = gl->indices.data;
    const ewa_gl_batch *batches = band->batches.data;
    for (uint32_t i = 0; i < band->batch_count; i++) {
        const ewa_gl_batch *batch = &batches[i];
        const ewa_gl_page *page =
            &ewa_gl_residents_at(&gl->residents, indices[batch->source])->pages[batch->page];
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, page->packets.name);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, page->attributes.name);
        glUniform1ui(END_PAIR, batch->first_pair + batch->pair_count);
        glUniform1ui(SOURCE, batch->source);
        glUniform1i(OPACITIES_AT, job->with_opacity ? page->opacities_at : -1);
        glUniform1i(CURVATURES_AT, job->sources[batch->source].packets.curvatures ? page->curvatures_at : -1);
        glUniform1i(MATERIALS_AT, job->with_materials ? page->materials_at : -1);
        enum { PAIRS = THREADS / EWA_PACKET_LANES };
        dispatch(gl, PAIRS, batch->first_pair, (batch->pair_count + PAIRS - 1) / PAIRS);
    }
    ewa_gl_times_mark(&gl->times, EWA_GL_TIME_SETUP);
    return ewa_gl_check(gl->device, "set-up");
}

/// Asks the device what it found, gives it what it needs, and lists the splats of each tile.
static ewa_status list(ewa_gl_compute *gl, const ewa_tile_job *job) {
    ewa_gl_band *band = &gl->band;
    EWA_TRY(wait_for(gl, "set-up"));
    read_back(gl, EWA_GL_MASKS, 0, (uint64_t)band->pair_count * 4, band->masks.data);
    read_back(gl, EWA_GL_COUNTS, 0, (uint64_t)band->tile_count * 4, band->counts.data);
    EWA_TRY(ewa_gl_band_answer(gl->context, band, job));
    EWA_TRY(ewa_gl_band_divide(gl->context, band, job, gl->unit_splats));
    EWA_TRY(use(gl, job, EWA_GL_FILL));
    EWA_TRY(put(gl, EWA_GL_NEARS, "near surfels", band->nears.data,
                (uint64_t)band->near_count * sizeof(ewa_gl_near)));
    EWA_TRY(put(gl, EWA_GL_CLIPS, "clip lines", band->clips.data,
                (uint64_t)band->clip_count * sizeof(ewa_gl_clip)));
    EWA_TRY(put(gl, EWA_GL_CLIPPED, "clip lines", band->clipped.data, (uint64_t)band->pair_count * 8));
    EWA_TRY(put(gl, EWA_GL_COUNTS, "tiles", band->starts.data, (uint64_t)band->tile_count * 4));
    EWA_TRY(
        put(gl, EWA_GL_UNITS, "work", band->units.data, (uint64_t)band->unit_count * sizeof(ewa_gl_unit)));
    EWA_TRY(reserve(gl, EWA_GL_LIST, "lists", band->list_count * 4));
    bind(gl, 4, EWA_GL_CLIPPED), bind(gl, 5, EWA_GL_RECORDS), bind(gl, 6, EWA_GL_LIST),
        bind(gl, 7, EWA_GL_COUNTS);
    const uint32_t record_count = band->pair_count * EWA_PACKET_LANES;
    glUniform1ui(END_PAIR, record_count);
    dispatch(gl, THREADS, 0, (record_count + THREADS - 1) / THREADS);
    ewa_gl_times_mark(&gl->times, EWA_GL_TIME_SETUP);
    return ewa_gl_check(gl->device, "lists");
}

/// A plane of the frame.
typedef struct wanted_plane {
    float *plane; ///< NULL: it is not wanted
    uint32_t floats;
} wanted_plane;

enum { PLANES = 4 };

/// The planes in the order in which the device has them.
static void list_planes(const ewa_resolve *to, wanted_plane planes[PLANES]) {
    planes[0] = (wanted_plane){to->rgba, 4}, planes[1] = (wanted_plane){to->depth, 1};
    planes[2] = (wanted_plane){to->normal, 3}, planes[3] = (wanted_plane){to->coverage, 1};
}

/// Tells all programs of the band, and returns how many floats its planes have.
static ewa_status put_band(ewa_gl_compute *gl, const ewa_tile_job *job, uint64_t *float_count) {
    const ewa_gl_band *band = &gl->band;
    const uint64_t pixels = (uint64_t)job->tiles.width_px * (band->end_row_px - band->first_row_px);
    ewa_gl_band_block block = {.picture_px = {job->tiles.width_px, band->end_row_px},
                               .band_px = {band->width_px, band->height_px},
                               .first_px = {0, band->first_row_px},
                               .tiles_per_row = band->tiles_per_row,
                               .tile_count = band->tile_count,
                               .tile_side_px = band->tile_px,
                               .exponent_end = job->view.exponent_end,
                               .layered = job->layers > 1,
                               .with_codes = job->resolve.rgba8 != NULL};
    wanted_plane planes[PLANES];
    list_planes(&job->resolve, planes);
    *float_count = 0;
    for (int i = 0; i < PLANES; i++) {
        block.plane_at[i] = planes[i].plane ? (int32_t)*float_count : -1;
        if (planes[i].plane) *float_count += planes[i].floats * pixels;
    }
    EWA_TRY(put(gl, EWA_GL_BAND, "the band", &block, sizeof block));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, gl->buffers[EWA_GL_BAND].name);
    return EWA_OK;
}

/// The planes of the band's pixels, all at their start.
static ewa_status reserve_planes(ewa_gl_compute *gl, const ewa_tile_job *job) {
    const ewa_gl_band *band = &gl->band;
    const uint64_t pixels = (uint64_t)band->width_px * band->height_px, channels = job->channel_count;
    const uint64_t cut_words = job->with_clips ? 8 * pixels + pixels / (EWA_BLOCK_PX * EWA_BLOCK_PX) : 0;
    const uint64_t picture_px = (uint64_t)job->tiles.width_px * (band->end_row_px - band->first_row_px);
    uint64_t float_count = 0;
    EWA_TRY(put_band(gl, job, &float_count));
    const struct {
        ewa_gl_buffer_kind kind;
        uint64_t words;
        bool filled;
        uint32_t word;
    } needs[] = {{EWA_GL_NEAREST, pixels, true, EWA_GL_NEVER},
                 {EWA_GL_PASSED, pixels, false, 0},
                 {EWA_GL_OPEN, (uint64_t)band->tile_count + COUNTERS, true, 0},
                 {EWA_GL_SUM_WORDS, channels * sum_words(job) * pixels, true, 0},
                 {EWA_GL_BACK_FACING, channels * sum_words(job) * pixels, true, 0},
                 {EWA_GL_CUT, cut_words, true, 0},
                 {EWA_GL_SETTLED, channels * pixels, false, 0},
                 {EWA_GL_BEHIND, 8 * pixels, false, 0},
                 {EWA_GL_CODES, job->resolve.rgba8 ? picture_px : 0, false, 0},
                 {EWA_GL_PLANES, float_count, false, 0}};
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        EWA_TRY(reserve(gl, needs[i].kind, "the picture", needs[i].words * 4));
        if (needs[i].filled)
            ewa_gl_buffer_fill(&gl->buffers[needs[i].kind], needs[i].words * 4, needs[i].word);
    }
    return ewa_gl_check(gl->device, "the picture");
}

/// Both passes over the band's splats; `behind` the first surface, or of it. `whole`: all that is left is one surface.
static ewa_status gather(ewa_gl_compute *gl, const ewa_tile_job *job, bool behind, bool whole) {
    const ewa_gl_band *band = &gl->band;
    bind(gl, 0, EWA_GL_VIEWS), bind(gl, 1, EWA_GL_NEAREST), bind(gl, 2, EWA_GL_PASSED),
        bind(gl, 3, EWA_GL_OPEN);
    bind(gl, 4, EWA_GL_SUM_WORDS), bind(gl, 5, EWA_GL_RECORDS), bind(gl, 6, EWA_GL_LIST);
    bind(gl, 7, EWA_GL_UNITS), bind(gl, 8, EWA_GL_BACK_FACING), bind(gl, 9, EWA_GL_CLIPS),
        bind(gl, 10, EWA_GL_NEARS);
    bind(gl, 11, EWA_GL_CUT), bind(gl, 12, EWA_GL_MATERIALS);
    for (int pass = whole ? EWA_GL_SUMS : EWA_GL_VISIBILITY; pass <= EWA_GL_SUMS; pass++) {
        EWA_TRY(use(gl, job, (ewa_gl_pass)pass));
        glUniform1ui(BEHIND, behind);
        glUniform1ui(WHOLE, whole);
        dispatch(gl, 1, 0, band->unit_count);
        ewa_gl_times_mark(&gl->times, behind                       ? EWA_GL_TIME_EDGES
                                      : pass == EWA_GL_VISIBILITY ? EWA_GL_TIME_VISIBILITY
                                                                  : EWA_GL_TIME_ACCUMULATE);
    }
    return ewa_gl_check(gl->device, "sums");
}

/// Makes the surface that has been gathered: the first, or one behind it.
static ewa_status make_surface(ewa_gl_compute *gl, const ewa_tile_job *job, bool behind, bool whole) {
    const ewa_gl_band *band = &gl->band;
    EWA_TRY(use(gl, job, behind ? EWA_GL_NEXT_SURFACE : EWA_GL_FIRST_SURFACE));
    bind(gl, 0, EWA_GL_RESOLVE), bind(gl, 1, EWA_GL_NEAREST), bind(gl, 2, EWA_GL_PASSED),
        bind(gl, 3, EWA_GL_OPEN);
    bind(gl, 4, EWA_GL_SUM_WORDS), bind(gl, 8, EWA_GL_BACK_FACING), bind(gl, 11, EWA_GL_CUT);
    bind(gl, 13, EWA_GL_SETTLED), bind(gl, 14, EWA_GL_BEHIND), bind(gl, 15, EWA_GL_ENVIRONMENT);
    glUniform1ui(WHOLE, whole);
    dispatch(gl, 1, 0, band->tile_count);
    ewa_gl_times_mark(&gl->times, behind ? EWA_GL_TIME_EDGES : EWA_GL_TIME_RESOLVE);
    return ewa_gl_check(gl->device, "surfaces");
}

/// Draws what lies behind the first surface, while any pixel is open.
static ewa_status draw_layers(ewa_gl_compute *gl, const ewa_tile_job *job) {
    const uint64_t counter_at = (uint64_t)gl->band.tile_count * 4;
    for (uint32_t layer = 1; layer < job->layers; layer++) {
        uint32_t open = 0;
        EWA_TRY(wait_for(gl, "surfaces"));
        read_back(gl, EWA_GL_OPEN, counter_at, 4, &open);
        if (!open) return EWA_OK;
        static const uint32_t none = 0;
        ewa_gl_buffer_write(gl->device, &gl->buffers[EWA_GL_OPEN], counter_at, &none, 4);
        const bool whole = job->merge_last && layer + 1 == job->layers;
        EWA_TRY(gather(gl, job, true, whole));
        EWA_TRY(make_surface(gl, job, true, whole));
        EWA_TRY(ewa_progress(gl->context, "render", 0));
    }
    return EWA_OK;
}

/// Makes the band's pixels and fetches them; counts those without a colour.
static ewa_status finish_band(ewa_gl_compute *gl, const ewa_tile_job *job, uint64_t *broken) {
    const ewa_gl_band *band = &gl->band;
    const ewa_resolve *to = &job->resolve;
    EWA_TRY(use(gl, job, EWA_GL_PICTURE));
    const uint64_t width = job->tiles.width_px, first = width * band->first_row_px,
                   pixels = width * (band->end_row_px - band->first_row_px);
    bind(gl, 5, EWA_GL_CODES), bind(gl, 6, EWA_GL_PLANES);
    dispatch(gl, 1, 0, band->tile_count);
    ewa_gl_times_mark(&gl->times, EWA_GL_TIME_RESOLVE);
    EWA_TRY(wait_for(gl, "the picture"));
    if (to->rgba8) read_back(gl, EWA_GL_CODES, 0, pixels * 4, to->rgba8 + first * 4);
    wanted_plane planes[PLANES];
    list_planes(to, planes);
    uint64_t at = 0;
    for (int i = 0; i < PLANES; i++) {
        if (!planes[i].plane) continue;
        const uint64_t floats = pixels * planes[i].floats;
        read_back(gl, EWA_GL_PLANES, at * 4, floats * 4, planes[i].plane + first * planes[i].floats);
        at += floats;
    }
    uint32_t count = 0;
    read_back(gl, EWA_GL_OPEN, (uint64_t)band->tile_count * 4 + 4, 4, &count);
    *broken += count;
    return ewa_gl_check(gl->device, "the picture");
}

/// Draws rows of the picture.
static ewa_status draw_band(ewa_gl_compute *gl, const ewa_tile_job *job, uint32_t first_row_px,
                            uint32_t end_row_px, uint64_t *broken) {
    EWA_TRY(ewa_gl_band_start(gl->context, &gl->band, job, first_row_px, end_row_px, gl->tile_px,
                              gl->page_packets.data));
    EWA_TRY(reserve_planes(gl, job));
    EWA_TRY(set_up(gl, job));
    EWA_TRY(list(gl, job));
    EWA_TRY(gather(gl, job, false, false));
    EWA_TRY(make_surface(gl, job, false, false));
    EWA_TRY(draw_layers(gl, job));
    return finish_band(gl, job, broken);
}

/// Draws rows, in halves where they do not fit the device.
static ewa_status draw_rows(ewa_gl_compute *gl, const ewa_tile_job *job, uint32_t first_row_px,
                            uint32_t end_row_px, uint64_t *broken) {
    enum { DEEPEST = 32 };
    uint32_t ends[DEEPEST], depth = 0;
    ends[0] = end_row_px;
    for (uint32_t row = first_row_px; row < end_row_px;) {
        const uint32_t end = ends[depth], fields = (end - row + EWA_FIELD_PX - 1) / EWA_FIELD_PX;
        const bool divisible = fields > 1 && depth + 1 < DEEPEST;
        if (divisible) ewa_failures_soften(gl->context, true);
        const ewa_status status = draw_band(gl, job, row, end, broken);
        if (divisible) ewa_failures_soften(gl->context, false);
        if ((status == EWA_ERROR_LIMIT || status == EWA_ERROR_MEMORY) && divisible) {
            ends[++depth] = row + fields / 2 * EWA_FIELD_PX;
            continue;
        }
        EWA_TRY(status);
        row = end;
        if (depth) depth--;
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
    const ewa_status status = reserve(gl, EWA_GL_ENVIRONMENT, "the environment", texels * 12);
    gl->environment_serial = 0;
    if (status != EWA_OK || !environment) return status;
    texels = 0;
    for (uint32_t i = 0; i < environment->level_count; i++) {
        const ewa_environment_level *level = &environment->levels[i];
        const uint64_t here = (uint64_t)level->width * level->height;
        ewa_gl_buffer_write(gl->device, &gl->buffers[EWA_GL_ENVIRONMENT], texels * 12, level->texels, here * 12);
        texels += here;
    }
    gl->environment_serial = environment->serial;
    return EWA_OK;
}

/// What all bands of the frame see: views, lights, materials, the environment, surfels.
static ewa_status put_frame(ewa_gl_compute *gl, const ewa_tile_job *job) {
    ewa_context *context = gl->context;
    EWA_TRY(ewa_buffer_reserve(context, &gl->views, job->source_count, sizeof(ewa_gl_view)));
    EWA_TRY(ewa_buffer_reserve(context, &gl->indices, job->source_count, sizeof(uint32_t)));
    EWA_TRY(ewa_buffer_reserve(context, &gl->page_packets, job->source_count, sizeof(uint32_t)));
    ewa_gl_view *views = gl->views.data;
    uint32_t *indices = gl->indices.data, *page_packets = gl->page_packets.data;
    ewa_gl_residents_start(gl->device, &gl->residents);
    for (uint32_t i = 0; i < job->source_count; i++) {
        ewa_gl_view_set(&views[i], &job->sources[i].view, job->sources[i].hides);
        EWA_TRY(ewa_gl_residents_get(gl->device, &gl->residents, job->sources[i].surfels, &indices[i]));
        page_packets[i] = ewa_gl_residents_at(&gl->residents, indices[i])->pages[0].count;
    }
    ewa_gl_resolve resolve;
    ewa_gl_resolve_set(&resolve, &job->resolve);
    EWA_TRY(put(gl, EWA_GL_VIEWS, "views", views, (uint64_t)job->source_count * sizeof *views));
    EWA_TRY(put(gl, EWA_GL_RESOLVE, "lights", &resolve, sizeof resolve));
    EWA_TRY(put(gl, EWA_GL_MATERIALS, "materials", job->materials, sizeof job->materials));
    EWA_TRY(put_environment(gl, job->resolve.environment));
    return ewa_gl_check(gl->device, "the frame");
}

ewa_status ewa_gl_compute_draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats) {
    ewa_gl_compute *gl = state;
    const double start_s = ewa_now_s();
    ewa_tile_job job;
    EWA_TRY(ewa_tile_job_make(gl->context, &gl->room, frame, EWA_FIELD_PX, &job));
    const double binned_s = ewa_now_s();
    uint64_t broken = 0;
    EWA_TRY(ewa_gl_enter(gl->device));
    gl->device->counts = (ewa_gl_counts){0};
    ewa_gl_times_start(&gl->times);
    ewa_gl_times_resume(&gl->times);
    ewa_status status = put_frame(gl, &job);
    if (status == EWA_OK) status = draw_rows(gl, &job, frame->first_row_px, frame->end_row_px, &broken);
    ewa_gl_leave(gl->device);
    EWA_TRY(status);
    ewa_job_finish(gl->context, &gl->room, frame, broken);
    *stats = (ewa_render_stats){.bin_s = binned_s - start_s};
    ewa_gl_times_tell(&gl->times, stats);
    ewa_job_count(&job, 0, stats);
    stats->drawn_count = gl->band.list_count;
    stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

static void describe(const void *state, ewa_renderer_info *info) {
    const ewa_gl_compute *gl = state;
    snprintf(info->device, sizeof info->device, "%s", gl->device->facts.renderer);
    info->device_class = gl->verdict.exact ? EWA_GPU_EXACT : EWA_GPU_CLOSE;
    const ewa_gl_counts *counts = &gl->device->counts;
    info->wait_count = counts->waits, info->readback_count = counts->readbacks;
    info->dispatch_count = counts->dispatches, info->upload_bytes = counts->upload_bytes;
    if (gl->device->facts.software)
        snprintf(info->remark, sizeof info->remark, "%.100s is software", gl->device->facts.renderer);
}

const ewa_backend ewa_backend_gl = {"gl", ewa_gl_compute_create, ewa_gl_compute_destroy, ewa_gl_compute_draw,
                                    describe, false};
