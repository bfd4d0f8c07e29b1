// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes as compute programs: voxels to records of the blocks of each tile, splats of a unit sorted, pixels front to back. Every sum is
// in the order of src/volume, so that a device that rounds as the processor does draws its bytes. The host bins blocks and waits once.
#include "gl/volume.h"
#include "gl/backends.h"
#include "gl/compute.h"
#include "gl/shaders.h"
#include "gl/tuning.h"

#include <stdio.h>
#include <string.h>

enum { PLANES = 4, READBACK_HEAD = 64, VOXEL_BYTES = 16, GROUP_TURNS = 1 << 20, SOFTWARE_TURNS = 1 << 14 };

/// Forgets all objects, which are deleted where the device still has them.
static void free_objects(ewa_gl_volume *gl, bool there) {
    if (there && ewa_gl_enter(gl->device) == EWA_OK) {
        for (int i = 0; i < EWA_GL_VOLUME_BUFFERS; i++) ewa_gl_buffer_free(&gl->buffers[i]);
        for (int i = 0; i < EWA_MAX_VOLUME_LEVELS; i++) ewa_gl_buffer_free(&gl->levels[i]);
        for (int i = 0; i < EWA_GL_VOLUME_PROGRAMS; i++) glDeleteProgram(gl->programs[i]);
        ewa_gl_times_free(&gl->times);
        ewa_gl_leave(gl->device);
    }
    memset(gl->buffers, 0, sizeof gl->buffers);
    memset(gl->levels, 0, sizeof gl->levels);
    memset(gl->programs, 0, sizeof gl->programs);
    memset(&gl->times, 0, sizeof gl->times);
    gl->device = NULL, gl->serial = 0, gl->has_filters = false;
}

/// The compute pipeline of the renderer of surfels; NULL: it has none, and `*remark` says why.
static ewa_gl_compute *pipeline_of(const ewa_gl_volume *gl, bool open, const char **remark) {
    ewa_context *context;
    void *state;
    const ewa_backend *backend = ewa_renderer_backend(gl->surfaces, &context, &state);
    if (backend == &ewa_backend_gl) return state;
    return open ? ewa_gl_auto_device(state, remark) : NULL;
}

static void destroy(ewa_context *context, void *state) {
    ewa_gl_volume *old = state;
    const char *remark;
    const ewa_gl_compute *pipeline = old->device ? pipeline_of(old, true, &remark) : NULL;
    free_objects(old, pipeline && pipeline->device == old->device && !old->device->lost);
    ewa_gl_volume_lists_free(context, &old->lists);
    ewa_release(context, old, 1, sizeof *old);
}

/// Takes the device of the pipeline, whose objects are forgotten where it is another.
static void take_device(ewa_gl_volume *gl, const ewa_gl_compute *pipeline) {
    if (gl->device == pipeline->device) return;
    free_objects(gl, false);
    gl->device = pipeline->device;
    gl->verdict = pipeline->verdict;
    gl->turns = (uint32_t)ewa_gl_tuning("turns", gl->device->facts.software ? SOFTWARE_TURNS : GROUP_TURNS);
    gl->buffers[EWA_GL_VOLUME_READBACK].usage = GL_STREAM_READ;
}

void ewa_gl_volume_program_write(const ewa_gl_arithmetic *arithmetic, ewa_gl_volume_program program, ewa_gl_source *source) {
    static const char *const own[] = {[EWA_GL_VOLUME_PLACE] = ewa_shader_volume_place,
                                      [EWA_GL_VOLUME_BUCKETS] = ewa_shader_volume_buckets,
                                      [EWA_GL_VOLUME_SORT] = ewa_shader_volume_sort,
                                      [EWA_GL_VOLUME_DRAW] = ewa_shader_volume_draw};
    const size_t at = ewa_gl_head_write(arithmetic, source->head);
    snprintf(source->head + at, sizeof source->head - at, "#define MAX_SPAN %d\n", EWA_GL_MAX_SPAN);
    source->piece_count = 0;
    source->pieces[source->piece_count++] = ewa_shader_wide;
    source->pieces[source->piece_count++] = ewa_shader_volume_scene;
    if (program == EWA_GL_VOLUME_DRAW) {
        source->pieces[source->piece_count++] = ewa_shader_codes;
        source->pieces[source->piece_count++] = ewa_shader_share_below;
    }
    source->pieces[source->piece_count++] = own[program];
}

/// Makes a program the one in use.
static ewa_status use(ewa_gl_volume *gl, ewa_gl_volume_program program) {
    static const char *const names[] = {[EWA_GL_VOLUME_PLACE] = "voxels",
                                        [EWA_GL_VOLUME_BUCKETS] = "units of splats",
                                        [EWA_GL_VOLUME_SORT] = "order of splats",
                                        [EWA_GL_VOLUME_DRAW] = "pixels of volumes"};
    if (!gl->programs[program]) {
        ewa_gl_source source;
        ewa_gl_volume_program_write(&gl->verdict.arithmetic, program, &source);
        const ewa_gl_stage stage = {GL_COMPUTE_SHADER, source.head, source.pieces, source.piece_count};
        EWA_TRY(ewa_gl_program_make(gl->device, names[program], &stage, 1, &gl->programs[program]));
    }
    glUseProgram(gl->programs[program]);
    return EWA_OK;
}

static ewa_status reserve(ewa_gl_volume *gl, ewa_gl_volume_buffer buffer, const char *what, uint64_t words) {
    return ewa_gl_buffer_reserve(gl->device, &gl->buffers[buffer], what, words * sizeof(uint32_t));
}

static ewa_status put(ewa_gl_volume *gl, ewa_gl_volume_buffer buffer, const char *what, const void *bytes, uint64_t size_bytes) {
    return ewa_gl_buffer_put(gl->device, &gl->buffers[buffer], what, bytes, size_bytes);
}

/// Copies the voxels of a level, unless they are there.
static ewa_status put_voxels(ewa_gl_volume *gl, const ewa_voxels *voxels, const ewa_voxel_level *level) {
    enum { STAGED = 1 << 14 };
    const size_t index = (size_t)(level - voxels->levels);
    if (gl->serial != voxels->serial) {
        for (int i = 0; i < EWA_MAX_VOLUME_LEVELS; i++) ewa_gl_buffer_free(&gl->levels[i]);
        memset(gl->resident, 0, sizeof gl->resident);
        gl->serial = voxels->serial;
    }
    if (gl->resident[index]) return EWA_OK;
    EWA_TRY(ewa_gl_buffer_reserve(gl->device, &gl->levels[index], "voxels", level->voxel_count * VOXEL_BYTES));
    uint32_t(*words)[4] = ewa_allocate(gl->context, STAGED, sizeof *words);
    if (!words) return EWA_ERROR_MEMORY;
    for (uint64_t first = 0; first < level->voxel_count; first += STAGED) {
        const uint64_t left = level->voxel_count - first, here = left < STAGED ? left : STAGED;
        for (uint64_t i = 0; i < here; i++) {
            const uint64_t at = first + i;
            words[i][0] = level->places[at] | (uint32_t)level->colors[0][at] << 16;
            words[i][1] = level->colors[1][at] | (uint32_t)level->colors[2][at] << 16;
            memcpy(&words[i][2], &level->extinctions[at], sizeof words[i][2]);
            memcpy(&words[i][3], &level->normals[at], sizeof words[i][3]);
        }
        ewa_gl_buffer_write(gl->device, &gl->levels[index], first * VOXEL_BYTES, words, here * VOXEL_BYTES);
    }
    ewa_release(gl->context, words, STAGED, sizeof *words);
    gl->resident[index] = true;
    return ewa_gl_check(gl->device, "voxels");
}

/// Copies the taps of all filters.
static ewa_status put_filters(ewa_gl_volume *gl, const ewa_point_filter *filters) {
    enum { TAPS = 4, FIRST_TAP = 4, COUNT = EWA_FILTER_COUNT * EWA_FILTER_PHASES };
    if (gl->has_filters) return EWA_OK;
    float(*taps)[TAPS] = ewa_allocate_zeroed(gl->context, COUNT, sizeof *taps);
    if (!taps) return EWA_ERROR_MEMORY;
    for (int i = 0; i < COUNT; i++)
        memcpy(taps[i], &filters[i / EWA_FILTER_PHASES][i % EWA_FILTER_PHASES][FIRST_TAP], sizeof taps[i]);
    const ewa_status status = put(gl, EWA_GL_VOLUME_FILTERS, "filters", taps, COUNT * sizeof *taps);
    ewa_release(gl->context, taps, COUNT, sizeof *taps);
    gl->has_filters = status == EWA_OK;
    return status;
}

/// A plane that the caller gets.
typedef struct plane {
    void *to;
    uint32_t words; ///< of a pixel
} plane;

static void list_planes(const ewa_volume_target *target, plane planes[PLANES]) {
    planes[0] = (plane){target->rgba8, 1}, planes[1] = (plane){target->rgba, 4};
    planes[2] = (plane){target->depth, 1}, planes[3] = (plane){target->coverage, 1};
}

/// Says where the planes are in the result; returns its words.
static uint64_t place_planes(ewa_gl_volume *gl, const ewa_volume_target *target) {
    const uint64_t pixels = (uint64_t)target->width_px * target->height_px;
    plane planes[PLANES];
    list_planes(target, planes);
    uint64_t words = 0;
    for (int i = 0; i < PLANES; i++) {
        gl->lists.view.planes_at[i] = planes[i].to ? (int32_t)words : -1;
        words += planes[i].to ? planes[i].words * pixels : 0;
    }
    return words;
}

static ewa_status put_frame(ewa_gl_volume *gl, const ewa_voxels *voxels, const ewa_volume_frame *frame, uint64_t result_words) {
    const ewa_gl_volume_lists *lists = &gl->lists;
    EWA_TRY(put_voxels(gl, voxels, frame->job.level));
    EWA_TRY(put_filters(gl, frame->job.filters));
    EWA_TRY(put(gl, EWA_GL_VOLUME_VIEW, "the view", &lists->view, sizeof lists->view));
    EWA_TRY(put(gl, EWA_GL_VOLUME_PAIRS, "blocks", lists->pairs.data, lists->pair_count * sizeof(ewa_gl_volume_pair)));
    EWA_TRY(put(gl, EWA_GL_VOLUME_TILES, "tiles", lists->tiles.data, lists->tile_count * sizeof(ewa_gl_volume_tile)));
    const uint64_t unit_bytes = lists->unit_count * sizeof(ewa_gl_volume_unit), bound_bytes = lists->bound_count * sizeof(float);
    EWA_TRY(ewa_gl_buffer_reserve(gl->device, &gl->buffers[EWA_GL_VOLUME_UNITS], "depth units", unit_bytes + bound_bytes));
    ewa_gl_buffer_write(gl->device, &gl->buffers[EWA_GL_VOLUME_UNITS], 0, lists->units.data, unit_bytes);
    ewa_gl_buffer_write(gl->device, &gl->buffers[EWA_GL_VOLUME_UNITS], unit_bytes, lists->bounds.data, bound_bytes);
    EWA_TRY(put(gl, EWA_GL_VOLUME_NEARS, "voxels at the eye", lists->nears.data, lists->near_count * sizeof(ewa_gl_volume_near)));
    static const uint32_t none[READBACK_HEAD / sizeof(uint32_t)];
    EWA_TRY(put(gl, EWA_GL_VOLUME_COUNTS, "counts", none, sizeof none));
    EWA_TRY(reserve(gl, EWA_GL_VOLUME_RESULT, "the picture", result_words));
    EWA_TRY(ewa_gl_buffer_reserve(gl->device, &gl->buffers[EWA_GL_VOLUME_READBACK], "the picture",
                                  READBACK_HEAD + result_words * sizeof(uint32_t)));
    const ewa_gl_volume_part *parts = lists->parts.data;
    for (uint32_t i = 0; i < lists->part_count; i++) {
        const uint64_t tiles = parts[i].end_tile - parts[i].first_tile;
        EWA_TRY(reserve(gl, EWA_GL_VOLUME_RECORDS, "records", (uint64_t)parts[i].records * lists->record_words));
        EWA_TRY(reserve(gl, EWA_GL_VOLUME_RUNS, "records", parts[i].runs));
        EWA_TRY(reserve(gl, EWA_GL_VOLUME_BUCKET_BEGINS, "splats", parts[i].buckets));
        EWA_TRY(reserve(gl, EWA_GL_VOLUME_SORTED, "splats", parts[i].buckets ? 4 * (uint64_t)parts[i].records : 0));
        EWA_TRY(reserve(gl, EWA_GL_VOLUME_STATES, "pixels", tiles * EWA_GL_STATE_WORDS * EWA_GL_TILE_PIXELS));
        EWA_TRY(reserve(gl, EWA_GL_VOLUME_PROGRESS, "pixels", tiles * EWA_GL_TILE_GROUPS));
    }
    const ewa_gl_buffer *level = &gl->levels[frame->job.level - voxels->levels];
    for (int i = 0; i < EWA_GL_VOLUME_BOUND; i++)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint)i, i == EWA_GL_VOLUME_VOXELS ? level->name : gl->buffers[i].name);
    return ewa_gl_check(gl->device, "the frame");
}

/// Runs the program in use, of which times are told under its number.
static void dispatch(ewa_gl_volume *gl, uint64_t group_count, ewa_gl_volume_program program) {
    ewa_gl_program_run(gl->device, group_count);
    ewa_gl_times_mark(&gl->times, (ewa_gl_pass)program);
}

/// The order of splats, a group for each unit of each tile.
static ewa_status sort_splats(ewa_gl_volume *gl, const ewa_gl_volume_part *part) {
    enum { FIRST_TILE, SECOND };
    const uint32_t tiles = part->end_tile - part->first_tile, most = gl->device->facts.group_count;
    EWA_TRY(use(gl, EWA_GL_VOLUME_BUCKETS));
    glUniform1ui(FIRST_TILE, part->first_tile);
    glUniform1ui(SECOND, part->end_tile);
    dispatch(gl, tiles, EWA_GL_VOLUME_SORT);
    EWA_TRY(use(gl, EWA_GL_VOLUME_SORT));
    glUniform1ui(SECOND, part->records);
    for (uint32_t first = 0; first < tiles; first += most) {
        glUniform1ui(FIRST_TILE, part->first_tile + first);
        glDispatchCompute(part->most_units, tiles - first < most ? tiles - first : most, 1);
        gl->device->counts.dispatches++;
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    ewa_gl_times_mark(&gl->times, (ewa_gl_pass)EWA_GL_VOLUME_SORT);
    return EWA_OK;
}

static ewa_status draw_part(ewa_gl_volume *gl, const ewa_gl_volume_part *part) {
    enum { FIRST, END, IS_LAST };
    const uint64_t groups = (uint64_t)(part->end_tile - part->first_tile) * EWA_GL_TILE_GROUPS;
    ewa_gl_buffer_fill(&gl->buffers[EWA_GL_VOLUME_PROGRESS], groups * sizeof(uint32_t), 0);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    if (part->end_pair > part->first_pair) {
        EWA_TRY(use(gl, EWA_GL_VOLUME_PLACE));
        glUniform1ui(FIRST, part->first_pair);
        glUniform1ui(END, part->end_pair);
        dispatch(gl, part->end_pair - part->first_pair, EWA_GL_VOLUME_PLACE);
        if (part->buckets) EWA_TRY(sort_splats(gl, part));
    }
    const uint64_t turns = 1 + part->most_turns / gl->turns;
    EWA_TRY(use(gl, EWA_GL_VOLUME_DRAW));
    glUniform1ui(FIRST, part->first_tile);
    glUniform1ui(END, part->end_tile);
    for (uint64_t turn = 0; turn < turns; turn++) {
        glUniform1ui(IS_LAST, turn + 1 == turns);
        dispatch(gl, groups, EWA_GL_VOLUME_DRAW);
        if (turn + 1 < turns) glFlush();
    }
    return ewa_gl_check(gl->device, "pixels of volumes");
}

/// Copies the counts and the picture to where the host can read them, and waits.
static ewa_status fetch(ewa_gl_volume *gl, const ewa_volume_target *target, uint64_t result_words, ewa_volume_stats *stats) {
    ewa_gl_buffer *buffers = gl->buffers;
    const uint64_t size_bytes = READBACK_HEAD + result_words * sizeof(uint32_t);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffers[EWA_GL_VOLUME_READBACK].name);
    glBindBuffer(GL_COPY_READ_BUFFER, buffers[EWA_GL_VOLUME_COUNTS].name);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, READBACK_HEAD);
    glBindBuffer(GL_COPY_READ_BUFFER, buffers[EWA_GL_VOLUME_RESULT].name);
    if (result_words)
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, READBACK_HEAD, (GLsizeiptr)(size_bytes - READBACK_HEAD));
    EWA_TRY(ewa_gl_wait(gl->device, "the picture"));
    ewa_gl_times_read(&gl->times);
    gl->device->counts.readbacks++, gl->device->counts.readback_bytes += size_bytes;
    glBindBuffer(GL_COPY_READ_BUFFER, buffers[EWA_GL_VOLUME_READBACK].name);
    const uint8_t *from = glMapBufferRange(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)size_bytes, GL_MAP_READ_BIT);
    if (!from) return ewa_gl_check(gl->device, "the picture");
    uint32_t counts[3];
    memcpy(counts, from, sizeof counts);
    const uint64_t pixels = (uint64_t)target->width_px * target->height_px;
    plane planes[PLANES];
    list_planes(target, planes);
    for (int i = 0; i < PLANES; i++) {
        const size_t at = READBACK_HEAD + (size_t)gl->lists.view.planes_at[i] * sizeof(uint32_t);
        if (planes[i].to) memcpy(planes[i].to, from + at, planes[i].words * pixels * sizeof(uint32_t));
    }
    glUnmapBuffer(GL_COPY_READ_BUFFER);
    if (counts[2])
        return ewa_fail(gl->context, EWA_ERROR_LIMIT, "OpenGL: %s stops programs that take long: a depth unit has too many voxels",
                        gl->device->facts.renderer);
    if (target->normal) memset(target->normal, 0, 3 * pixels * sizeof *target->normal);
    stats->splat_count = (uint64_t)counts[0] + gl->lists.near_count, stats->point_count = counts[1];
    return ewa_gl_check(gl->device, "the picture");
}

static ewa_status draw_all(ewa_gl_volume *gl, const ewa_voxels *voxels, const ewa_volume_frame *frame, ewa_volume_stats *stats) {
    ewa_gl_volume_lists *lists = &gl->lists;
    EWA_TRY(ewa_gl_volume_lists_fill(gl->device, lists, frame));
    lists->view.turns = gl->turns;
    const uint64_t result_words = place_planes(gl, &frame->job.target);
    EWA_TRY(put_frame(gl, voxels, frame, result_words));
    ewa_gl_times_resume(&gl->times);
    const ewa_gl_volume_part *parts = lists->parts.data;
    for (uint32_t i = 0; i < lists->part_count; i++) EWA_TRY(draw_part(gl, &parts[i]));
    return fetch(gl, &frame->job.target, result_words, stats);
}

/// Draws by the device that is taken.
static ewa_status draw_by_device(ewa_gl_volume *gl, const ewa_voxels *voxels, const ewa_volume_frame *frame, ewa_volume_stats *stats) {
    gl->device->counts = (ewa_gl_counts){0};
    EWA_TRY(ewa_gl_enter(gl->device));
    gl->device->surfel_count = frame->job.level->voxel_count;
    ewa_gl_times_start(&gl->times);
    const ewa_status status = draw_all(gl, voxels, frame, stats);
    ewa_gl_leave(gl->device);
    stats->setup_s = gl->times.seconds[EWA_GL_VOLUME_PLACE];
    stats->splats_s = gl->times.seconds[EWA_GL_VOLUME_SORT];
    stats->points_s = gl->times.seconds[EWA_GL_VOLUME_DRAW];
    return status;
}

/// Says why the processor draws a frame; "": it does not.
static ewa_status leave(const char *why, char *remark, size_t remark_bytes) {
    snprintf(remark, remark_bytes, "%s", why);
    return EWA_OK;
}

/// A frame of EWA_BACKEND_GL: what the device has no room for is the processor's, too.
static ewa_status draw(void *state, const ewa_voxels *voxels, const ewa_volume_frame *frame, ewa_volume_stats *stats, bool *drawn,
                       char *remark, size_t remark_bytes) {
    ewa_gl_volume *gl = state;
    take_device(gl, pipeline_of(gl, false, NULL));
    const char *refused = ewa_gl_volume_refuse(gl->device, frame);
    *drawn = false;
    if (refused) return leave(refused, remark, remark_bytes);
    ewa_failures_soften(gl->context, true);
    const ewa_status status = draw_by_device(gl, voxels, frame, stats);
    ewa_failures_soften(gl->context, false);
    *drawn = status == EWA_OK;
    if (status == EWA_OK) return leave("", remark, remark_bytes);
    if (status == EWA_ERROR_LIMIT || status == EWA_ERROR_MEMORY) return leave("volumes that do not fit the device are drawn by the CPU", remark, remark_bytes);
    return ewa_fail(gl->context, status, "OpenGL: %s draws no volume any more", gl->device->facts.renderer);
}

/// A frame of EWA_BACKEND_AUTO.
static ewa_status draw_faster(void *state, const ewa_voxels *voxels, const ewa_volume_frame *frame, ewa_volume_stats *stats, bool *drawn,
                              char *remark, size_t remark_bytes) {
    ewa_gl_volume *gl = state;
    const double start_s = ewa_now_s();
    const uint64_t count = frame->job.level->voxel_count;
    const uint64_t pixels = (uint64_t)frame->job.target.width_px * frame->job.target.height_px;
    if (ewa_gl_far_apart(count, gl->chosen_voxels) || ewa_gl_far_apart(pixels, gl->chosen_pixels)) {
        gl->choice = (ewa_gl_choice){.step = EWA_GL_FIRST};
        gl->chosen_voxels = count, gl->chosen_pixels = pixels;
    }
    *drawn = false;
    if (!ewa_gl_choice_takes_gl(&gl->choice)) return EWA_OK;
    const char *why = "";
    const ewa_gl_compute *pipeline = pipeline_of(gl, true, &why);
    if (pipeline) take_device(gl, pipeline);
    if (pipeline) why = ewa_gl_volume_refuse(gl->device, frame);
    if (!pipeline || why) {
        ewa_gl_choice_leave(&gl->choice);
        return leave(why, remark, remark_bytes);
    }
    ewa_failures_soften(gl->context, true);
    const ewa_status status = draw_by_device(gl, voxels, frame, stats);
    ewa_failures_soften(gl->context, false);
    *drawn = status == EWA_OK;
    if (status == EWA_OK) {
        ewa_gl_choice_learn(&gl->choice, true, ewa_now_s() - start_s, remark, remark_bytes);
        return EWA_OK;
    }
    ewa_gl_choice_leave(&gl->choice);
    snprintf(remark, remark_bytes, "%.100s failed: %s", gl->device->facts.renderer, ewa_status_name(status));
    ewa_report(gl->context, EWA_SEVERITY_WARNING, "volume: %s; the CPU draws this volume", remark);
    return EWA_OK;
}

static void learn(void *state, double took_s) {
    ewa_gl_volume *gl = state;
    char remark[160];
    ewa_gl_choice_learn(&gl->choice, false, took_s, remark, sizeof remark);
}

static void describe(const void *state, ewa_renderer_info *info) {
    const ewa_gl_volume *gl = state;
    ewa_gl_describe_device(gl->device, &gl->verdict, info);
}

ewa_status ewa_gl_volume_attach(ewa_context *context, ewa_renderer *surfaces, ewa_volume_renderer *volumes) {
    static const ewa_volume_backend by_gl = {draw, learn, describe, destroy}, by_faster = {draw_faster, learn, describe, destroy};
    ewa_context *own;
    void *state;
    const ewa_backend *backend = ewa_renderer_backend(surfaces, &own, &state);
    if (backend != &ewa_backend_gl && backend != &ewa_backend_auto) return EWA_OK;
    ewa_gl_volume *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->surfaces = surfaces;
    ewa_volume_renderer_use(volumes, backend == &ewa_backend_gl ? &by_gl : &by_faster, made);
    return EWA_OK;
}
