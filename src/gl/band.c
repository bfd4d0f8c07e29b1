// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A band of rows on the device: programs one behind the other, which find their work in what those before them have counted. The
// host waits once, at the end. What it has to make (host_records.h) takes one wait more, and what found no room is
// drawn again with more of it.
#include "gl/eye_dome.h"
#include "gl/averages.h"

#include <stddef.h>
#include <string.h>

enum { THREADS = 64, READBACK_HEAD = 64, MAX_ROUNDS = 1 << 14 };

/// The numbers of a band.
typedef struct band {
    const ewa_tile_job *job;
    ewa_gl_rows rows;
    uint32_t width_px, height_px;                ///< whole blocks
    uint32_t tiles_per_row, tile_count, parts;
    ewa_gl_result result;
    const ewa_eye_dome_pass *eye_dome; ///< lights it on the device; NULL: nothing does
    bool has_host_records;
    bool is_spoilt; ///< the driver has left something out
} band;

static uint64_t smaller(uint64_t a, uint64_t b) { return a < b ? a : b; }

static ewa_status reserve(ewa_gl_compute *gl, ewa_gl_buffer_kind kind, const char *what, uint64_t size_bytes) {
    return ewa_gl_buffer_reserve(gl->device, &gl->buffers[kind], what, size_bytes);
}

static ewa_status put(ewa_gl_compute *gl, ewa_gl_buffer_kind kind, const char *what, const void *bytes,
                      uint64_t size_bytes) {
    return ewa_gl_buffer_put(gl->device, &gl->buffers[kind], what, bytes, size_bytes);
}

/// Raises a mark to what a frame needed, and some more.
static ewa_status raise(ewa_gl_compute *gl, uint32_t *mark, uint64_t need, ewa_gl_buffer_kind kind, const char *what,
                        uint64_t item_bytes) {
    enum { SPARE = 8 };
    if (need <= *mark) return EWA_OK;
    EWA_TRY(reserve(gl, kind, what, need * item_bytes));
    const uint64_t fit = smaller(gl->device->facts.storage_bytes / item_bytes, UINT32_MAX);
    *mark = (uint32_t)smaller(need + need / SPARE, fit);
    return EWA_OK;
}

enum { PAIR_RECORD_BYTES = EWA_PACKET_LANES * EWA_GL_RECORD_BYTES };

/// Room for what is known before anything is counted; marks that are not set yet begin small.
static ewa_status reserve_work(ewa_gl_compute *gl, const band *b) {
    enum { PAIRS = 1 << 14, REQUESTS = 1 << 8, LIST = 1 << 18 };
    const uint64_t fit = gl->device->facts.storage_bytes;
    ewa_gl_marks *marks = &gl->marks;
    if (!marks->pairs) {
        uint64_t packets = 1;
        for (uint32_t i = 0; i < b->job->source_count; i++) packets += b->job->sources[i].surfels->packet_count;
        marks->pairs = (uint32_t)smaller(smaller(packets + packets / 2, PAIRS), fit / PAIR_RECORD_BYTES);
        marks->requests = REQUESTS;
        marks->list = (uint32_t)smaller(LIST, fit / EWA_GL_ENTRY_BYTES);
        marks->units = (uint32_t)smaller(2 * (uint64_t)b->tile_count, fit / EWA_GL_UNIT_BYTES);
    }
    const uint64_t arguments = (uint64_t)(EWA_GL_OF_PAGES + gl->use_count) * EWA_GL_ARGUMENT_BYTES;
    EWA_TRY(reserve(gl, EWA_GL_PAIRS, "packets", (uint64_t)marks->pairs * EWA_GL_PAIR_BYTES));
    EWA_TRY(reserve(gl, EWA_GL_RECORDS, "splats", (uint64_t)marks->pairs * PAIR_RECORD_BYTES));
    EWA_TRY(reserve(gl, EWA_GL_HOST_REQUESTS, "near surfels", 2 * (uint64_t)marks->requests * sizeof(ewa_gl_host_request)));
    EWA_TRY(reserve(gl, EWA_GL_LIST, "lists", (uint64_t)marks->list * EWA_GL_ENTRY_BYTES));
    EWA_TRY(reserve(gl, EWA_GL_UNITS, "work", (uint64_t)marks->units * EWA_GL_UNIT_BYTES));
    EWA_TRY(reserve(gl, EWA_GL_RANGES, "near surfels", 0));
    EWA_TRY(reserve(gl, EWA_GL_NEARS, "near surfels", 0));
    EWA_TRY(reserve(gl, EWA_GL_CLIPS, "clip lines", 0));
    return reserve(gl, EWA_GL_COUNTS, "counts", sizeof(ewa_gl_tally) + arguments);
}

/// The planes of the band's pixels. Those of sums are at their start where the band before left them so; else they are set to it.
static ewa_status reserve_planes(ewa_gl_compute *gl, const band *b) {
    enum { BEHIND = 10, CUT_WORDS = 8 }; // planes of EWA_GL_SURFACES beside the channels (surface.glsl), words of a cut
    const ewa_tile_job *job = b->job;
    const uint64_t pixels = (uint64_t)b->width_px * b->height_px, channels = job->channel_count;
    const uint64_t sums = channels * (job->fine_sums || job->with_depth || job->with_clips ? 4 : 2) * pixels;
    const uint64_t blocks = pixels / (EWA_BLOCK_PX * EWA_BLOCK_PX);
    const struct {
        ewa_gl_buffer_kind kind;
        uint64_t words;
        bool kept;
        uint32_t start;
    } needs[] = {{EWA_GL_TILES, (uint64_t)b->tile_count * EWA_GL_TILE_BYTES / sizeof(uint32_t), true, 0},
                 {EWA_GL_NEAREST, pixels, true, EWA_GL_NEVER},
                 {EWA_GL_SUM_WORDS, sums, true, 0},
                 {EWA_GL_BACK_FACING, sums, true, 0},
                 {EWA_GL_CUT, job->with_clips ? CUT_WORDS * pixels + blocks : 0, true, 0},
                 {EWA_GL_SURFACES, (channels + BEHIND) * pixels, false, 0},
                 {EWA_GL_RESULT, b->result.words, false, 0}};
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        ewa_gl_buffer *buffer = &gl->buffers[needs[i].kind];
        const uint64_t before_bytes = buffer->size_bytes;
        EWA_TRY(reserve(gl, needs[i].kind, "the picture", needs[i].words * sizeof(uint32_t)));
        if (needs[i].kept && (gl->unfinished || buffer->size_bytes != before_bytes))
            ewa_gl_buffer_fill(buffer, buffer->size_bytes, needs[i].start);
    }
    gl->buffers[EWA_GL_READBACK].usage = GL_STREAM_READ;
    return reserve(gl, EWA_GL_READBACK, "the picture", READBACK_HEAD + b->result.read_words * sizeof(uint32_t));
}

/// Tells the programs of the band, whose counts begin at 0.
static ewa_status put_band(ewa_gl_compute *gl, const band *b) {
    const ewa_tile_job *job = b->job;
    ewa_gl_band_block block = {.picture_px = {job->tiles.width_px, b->rows.end_px},
                               .band_px = {b->width_px, b->height_px},
                               .first_px = {0, b->rows.first_px},
                               .tiles_per_row = b->tiles_per_row,
                               .tile_count = b->tile_count,
                               .tile_side_px = gl->tile_px,
                               .exponent_end = job->view.exponent_end,
                               .layers = job->layers,
                               .merge_last = job->merge_last,
                               .with_codes = job->resolve.rgba8 != NULL,
                               .pair_capacity = gl->marks.pairs,
                               .list_capacity = gl->marks.list,
                               .unit_capacity = gl->marks.units,
                               .request_capacity = gl->marks.requests,
                               .unit_splats = gl->unit_splats,
                               .group_limit = gl->device->facts.group_count,
                               .parts = b->parts,
                               .has_host_records = b->has_host_records};
    for (int i = EWA_GL_COLORS; i < EWA_GL_PLANES; i++) block.plane_at[i - EWA_GL_COLORS] = (int32_t)b->result.planes[i].at;
    EWA_TRY(put(gl, EWA_GL_BAND, "the band", &block, sizeof block));
    static const uint8_t none[sizeof(ewa_gl_tally) + EWA_GL_OF_PAGES * EWA_GL_ARGUMENT_BYTES];
    return put(gl, EWA_GL_COUNTS, "counts", none, sizeof none);
}

static void bind(const ewa_gl_compute *gl, GLuint binding, ewa_gl_buffer_kind kind) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, gl->buffers[kind].name);
}

/// What programs see up to the lists; pages have 1, 2, 4, 10, 14 and 15, and while they are set up segments 6.
static void bind_lists(const ewa_gl_compute *gl) {
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, gl->buffers[EWA_GL_BAND].name);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gl->buffers[EWA_GL_COUNTS].name);
    bind(gl, 0, EWA_GL_VIEWS), bind(gl, 3, EWA_GL_TILES), bind(gl, 5, EWA_GL_RECORDS), bind(gl, 6, EWA_GL_LIST);
    bind(gl, 7, EWA_GL_UNITS), bind(gl, 8, EWA_GL_PAIRS), bind(gl, 9, EWA_GL_RANGES), bind(gl, 11, EWA_GL_HOST_REQUESTS);
    bind(gl, 12, EWA_GL_PLACEMENTS), bind(gl, 13, EWA_GL_COUNTS);
}

/// What they see from there on, beside that.
static void bind_pixels(const ewa_gl_compute *gl) {
    bind(gl, 1, EWA_GL_NEAREST), bind(gl, 2, EWA_GL_SURFACES), bind(gl, 4, EWA_GL_SUM_WORDS);
    bind(gl, 8, EWA_GL_BACK_FACING), bind(gl, 9, EWA_GL_CLIPS), bind(gl, 10, EWA_GL_NEARS), bind(gl, 11, EWA_GL_CUT);
    bind(gl, 12, EWA_GL_RESOLVE), bind(gl, 14, EWA_GL_RESULT), bind(gl, 15, EWA_GL_ENVIRONMENT);
}

/// Makes a pass's program the one in use.
static ewa_status use(ewa_gl_compute *gl, const band *b, ewa_gl_pass pass) {
    const ewa_tile_job *job = b->job;
    ewa_gl_variant v;
    memset(&v, 0, sizeof v);
    v.pass = (uint8_t)pass;
    if (pass >= EWA_GL_VISIBILITY) {
        v.tile_px = (uint8_t)gl->tile_px;
        v.with_clips = job->with_clips;
        const bool splats = pass != EWA_GL_FIRST_SURFACE && pass != EWA_GL_PICTURE;
        v.rays = splats && job->view.raycast;
        v.with_nears = splats && b->has_host_records && gl->host_records.near_count;
    }
    if (pass > EWA_GL_VISIBILITY) {
        v.with_normals = job->with_normals, v.with_depth = job->with_depth;
        v.with_materials = job->with_materials, v.with_opacity = job->with_opacity;
        v.with_fine = job->fine_sums;
        v.channel_count = (uint8_t)job->channel_count;
    }
    GLuint program = 0;
    EWA_TRY(ewa_gl_variant_get(gl->device, &gl->variants, &v, &program));
    glUseProgram(program);
    return EWA_OK;
}

/// What follows a dispatch may read all that it wrote.
static void end_dispatch(ewa_gl_compute *gl, ewa_gl_pass pass) {
    gl->device->counts.dispatches++;
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    ewa_gl_times_mark(&gl->times, pass);
}

/// Runs the program in use in so many groups, which it numbers through.
static void dispatch(ewa_gl_compute *gl, uint64_t group_count, ewa_gl_pass pass) {
    const uint64_t columns = smaller(group_count, gl->device->facts.group_count);
    glDispatchCompute((GLuint)columns, (GLuint)((group_count + columns - 1) / columns), 1);
    end_dispatch(gl, pass);
}

/// Runs it in as many as the programs before have found.
static void dispatch_counted(ewa_gl_compute *gl, uint32_t argument, ewa_gl_pass pass) {
    glDispatchComputeIndirect((GLintptr)(sizeof(ewa_gl_tally) + (size_t)argument * EWA_GL_ARGUMENT_BYTES));
    end_dispatch(gl, pass);
}

/// What programs see of a page; of a stream that none of its packets has, another stands there, which they do not read.
static void bind_page(const ewa_gl_page *page) {
    static const GLuint bindings[EWA_GL_STREAMS] = {[EWA_GL_PACKETS] = 1,     [EWA_GL_BOUNDS] = 2,
                                                    [EWA_GL_OPACITIES] = 4,   [EWA_GL_CURVATURES] = 10,
                                                    [EWA_GL_MATERIALS] = 14,  [EWA_GL_CLIP_MASKS] = 15};
    for (int stream = 0; stream < EWA_GL_STREAMS; stream++) {
        const GLuint name = page->streams[stream].name;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, bindings[stream], name ? name : page->streams[EWA_GL_BOUNDS].name);
    }
}

/// Culls the packets of all pages, then sets up what is left of them: a dispatch of each for a page, whatever the number of
/// its sources.
static ewa_status set_up(ewa_gl_compute *gl, const band *b) {
    enum { PAGE, FIRST_SEGMENT, END_SEGMENT, PART = 1 };
    const ewa_gl_page_use *uses = gl->uses.data;
    bind(gl, 6, EWA_GL_SEGMENTS);
    for (int pass = EWA_GL_CULL; pass <= EWA_GL_SETUP; pass++) {
        EWA_TRY(use(gl, b, (ewa_gl_pass)pass));
        for (uint32_t i = 0; i < gl->use_count; i++) {
            bind_page(ewa_gl_residents_page(&gl->residents, uses[i].page));
            glUniform1ui(PAGE, i);
            if (pass == EWA_GL_CULL) {
                glUniform1ui(FIRST_SEGMENT, uses[i].first);
                glUniform1ui(END_SEGMENT, uses[i].end);
                dispatch(gl, uses[i].group_count, EWA_GL_CULL);
            } else {
                for (uint32_t part = 0; part < b->parts; part++) {
                    glUniform1ui(PART, part);
                    dispatch_counted(gl, EWA_GL_OF_PAGES + i, EWA_GL_SETUP);
                    if (part + 1 < b->parts) glFlush();
                }
            }
        }
    }
    bind_lists(gl);
    return ewa_gl_check(gl->device, "set-up");
}

/// Waits, and notes what the passes took.
static ewa_status wait_for(ewa_gl_compute *gl, const char *what) {
    EWA_TRY(ewa_gl_wait(gl->device, what));
    ewa_gl_times_read(&gl->times);
    ewa_gl_times_resume(&gl->times);
    return EWA_OK;
}

static void read_back(ewa_gl_compute *gl, ewa_gl_buffer_kind kind, uint64_t at_bytes, uint64_t size_bytes, void *to) {
    if (!size_bytes) return;
    gl->device->counts.readbacks++, gl->device->counts.readback_bytes += size_bytes;
    glBindBuffer(GL_COPY_READ_BUFFER, gl->buffers[kind].name);
    glGetBufferSubData(GL_COPY_READ_BUFFER, (GLintptr)at_bytes, (GLsizeiptr)size_bytes, to);
}

/// Raises the marks that pairs and requests went beyond; `*again`: some did.
static ewa_status check_pairs(ewa_gl_compute *gl, const ewa_gl_tally *tally, bool *again) {
    const uint64_t pairs = tally->pair_count, requests = tally->near_count > tally->clip_count ? tally->near_count
                                                                                                : tally->clip_count;
    *again = pairs > gl->marks.pairs || requests > gl->marks.requests;
    if (tally->carry)
        return ewa_fail(gl->context, EWA_ERROR_LIMIT, "OpenGL: more than %u packets or splats in the tiles of a band",
                        UINT32_MAX);
    EWA_TRY(raise(gl, &gl->marks.pairs, pairs, EWA_GL_RECORDS, "splats", PAIR_RECORD_BYTES));
    return raise(gl, &gl->marks.requests, requests, EWA_GL_HOST_REQUESTS, "near surfels", 2 * sizeof(ewa_gl_host_request));
}

/// Makes what the device requests of the host; `*again`: it had no room for its requests.
static ewa_status make_host_records(ewa_gl_compute *gl, const band *b, bool *again) {
    ewa_gl_tally tally;
    EWA_TRY(wait_for(gl, "set-up"));
    read_back(gl, EWA_GL_COUNTS, 0, sizeof tally, &tally);
    EWA_TRY(check_pairs(gl, &tally, again));
    if (*again) return EWA_OK;
    ewa_gl_host_records *host_records = &gl->host_records;
    const uint64_t nears = tally.near_count, clips = tally.clip_count;
    EWA_TRY(ewa_gl_host_records_reserve(gl->context, host_records, tally.near_count, tally.clip_count));
    ewa_gl_host_request *requests = host_records->requests.data;
    read_back(gl, EWA_GL_HOST_REQUESTS, 0, nears * sizeof *requests, requests);
    read_back(gl, EWA_GL_HOST_REQUESTS, gl->marks.requests * sizeof *requests, clips * sizeof *requests, requests + nears);
    EWA_TRY(ewa_gl_host_records_make(gl->context, host_records, b->job, b->rows.first_px / EWA_FIELD_PX,
                                     (b->rows.end_px - b->rows.first_px + EWA_FIELD_PX - 1) / EWA_FIELD_PX));
    EWA_TRY(put(gl, EWA_GL_NEARS, "near surfels", host_records->nears.data, nears * sizeof(ewa_gl_near)));
    EWA_TRY(put(gl, EWA_GL_CLIPS, "clip lines", host_records->clips.data, clips * sizeof(ewa_gl_clip)));
    EWA_TRY(put(gl, EWA_GL_RANGES, "near surfels", host_records->ranges.data,
                (uint64_t)host_records->field_count * 2 * sizeof(uint32_t)));
    bind_lists(gl); // some may have moved
    return ewa_gl_check(gl->device, "near surfels");
}

/// Goes over the splats of units in parts.
static ewa_status pass_over(ewa_gl_compute *gl, const band *b, ewa_gl_pass pass) {
    enum { PART };
    EWA_TRY(use(gl, b, pass));
    for (uint32_t part = 0; part < b->parts; part++) {
        glUniform1ui(PART, part);
        dispatch_counted(gl, EWA_GL_OF_UNITS, pass);
        if (part + 1 < b->parts) glFlush();
    }
    return EWA_OK;
}

/// Goes over the splats of tiles whose edges are open, in rounds [first, end) of as many parts.
static ewa_status go_behind_edges(ewa_gl_compute *gl, const band *b, uint32_t first, uint32_t end) {
    enum { PART, MOST_STEPS, ROUND_NUMBER, IS_LAST_ROUND };
    EWA_TRY(use(gl, b, EWA_GL_EDGES));
    glUniform1ui(MOST_STEPS, gl->edge_units);
    for (uint32_t round = first; round < end; round++) {
        glUniform1ui(ROUND_NUMBER, round);
        glUniform1ui(IS_LAST_ROUND, round + 1 == end);
        for (uint32_t part = 0; part < b->parts; part++) {
            glUniform1ui(PART, part);
            dispatch(gl, (b->tile_count + b->parts - 1) / b->parts, EWA_GL_EDGES);
            if (part + 1 < b->parts || round + 1 < end) glFlush();
        }
    }
    return EWA_OK;
}

/// Lists and sums, to the first surface.
static ewa_status draw_first_surface(ewa_gl_compute *gl, const band *b) {
    EWA_TRY(use(gl, b, EWA_GL_DIVIDE));
    dispatch(gl, (b->tile_count + THREADS - 1) / THREADS, EWA_GL_DIVIDE);
    EWA_TRY(use(gl, b, EWA_GL_FILL));
    dispatch_counted(gl, EWA_GL_OF_LISTS, EWA_GL_FILL);
    bind_pixels(gl);
    EWA_TRY(pass_over(gl, b, EWA_GL_VISIBILITY));
    EWA_TRY(pass_over(gl, b, EWA_GL_SUMS));
    EWA_TRY(use(gl, b, EWA_GL_FIRST_SURFACE));
    dispatch(gl, b->tile_count, EWA_GL_FIRST_SURFACE);
    return EWA_OK;
}

/// Surfaces to pixels, and the way of these and the counts to where the host can read them.
static ewa_status draw_picture(ewa_gl_compute *gl, const band *b) {
    EWA_TRY(use(gl, b, EWA_GL_PICTURE));
    dispatch(gl, b->tile_count, EWA_GL_PICTURE);
    if (b->eye_dome) {
        uint64_t group_count;
        EWA_TRY(ewa_gl_eye_dome_use(gl, &b->eye_dome->eye_dome, &group_count));
        dispatch(gl, group_count, EWA_GL_EYE_DOME);
    }
    if (b->result.finer > 1) {
        uint64_t group_count;
        EWA_TRY(ewa_gl_averages_use(gl, &b->result, b->job, b->rows, &group_count));
        dispatch(gl, group_count, EWA_GL_AVERAGES);
    }
    glBindBuffer(GL_COPY_WRITE_BUFFER, gl->buffers[EWA_GL_READBACK].name);
    glBindBuffer(GL_COPY_READ_BUFFER, gl->buffers[EWA_GL_COUNTS].name);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, sizeof(ewa_gl_tally));
    glBindBuffer(GL_COPY_READ_BUFFER, gl->buffers[EWA_GL_RESULT].name);
    if (b->result.read_words)
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, READBACK_HEAD,
                            (GLsizeiptr)(b->result.read_words * sizeof(uint32_t)));
    return ewa_gl_check(gl->device, "the picture");
}

/// Raises the marks that a band went beyond; `*again`: it has to be drawn again.
static ewa_status check_band(ewa_gl_compute *gl, const band *b, const ewa_gl_tally *tally, bool *again) {
    EWA_TRY(check_pairs(gl, tally, again));
    gl->needs_host = tally->near_count + tally->clip_count > 0;
    if (*again) return EWA_OK;
    *again = (gl->needs_host && !b->has_host_records) || tally->list_count > gl->marks.list ||
             tally->unit_count > gl->marks.units;
    EWA_TRY(raise(gl, &gl->marks.list, tally->list_count, EWA_GL_LIST, "lists", EWA_GL_ENTRY_BYTES));
    return raise(gl, &gl->marks.units, tally->unit_count, EWA_GL_UNITS, "work", EWA_GL_UNIT_BYTES);
}

/// Of a band of which the driver has left something out, since a program took long, fewer units are taken at a time; at last it is
/// refused. `*again`: it has to be drawn again.
static ewa_status check_loops(ewa_gl_compute *gl, band *b, const ewa_gl_tally *tally, bool *again) {
    enum { FEWER = 4 };
    b->is_spoilt = tally->stopped_count > 0;
    if (!b->is_spoilt) return EWA_OK;
    if (gl->edge_units == 1)
        return ewa_fail(gl->context, EWA_ERROR_LIMIT,
                        "OpenGL: %s stops programs that take long: too many splats lie behind the edges of %u pixels; draw by the "
                        "CPU, or with one edge layer",
                        gl->device->facts.renderer, tally->stopped_count);
    gl->edge_units = gl->edge_units > FEWER ? gl->edge_units / FEWER : 1;
    *again = true;
    return EWA_OK;
}

/// Fetches the counts and, unless it has to be drawn again or `*unfinished`, the pixels.
static ewa_status fetch(ewa_gl_compute *gl, band *b, ewa_gl_outcome *outcome, bool *again, bool *unfinished) {
    EWA_TRY(wait_for(gl, "the picture"));
    const uint64_t size_bytes = READBACK_HEAD + b->result.read_words * sizeof(uint32_t);
    gl->device->counts.readbacks++, gl->device->counts.readback_bytes += size_bytes;
    glBindBuffer(GL_COPY_READ_BUFFER, gl->buffers[EWA_GL_READBACK].name);
    const uint8_t *from = glMapBufferRange(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)size_bytes, GL_MAP_READ_BIT);
    if (!from) return ewa_gl_check(gl->device, "the picture");
    ewa_gl_tally tally;
    memcpy(&tally, from, sizeof tally);
    ewa_status status = check_band(gl, b, &tally, again);
    if (status == EWA_OK && !*again) status = check_loops(gl, b, &tally, again);
    *unfinished = tally.unfinished_count > 0;
    if (status == EWA_OK && !*again && !*unfinished) {
        enum { SPARE = 8 };
        gl->marks.rounds = tally.round_count + tally.round_count / SPARE;
        ewa_gl_result_copy(&b->result, from + READBACK_HEAD);
        outcome->broken += tally.broken_count, outcome->drawn += tally.list_count;
        outcome->kept_packets = tally.kept_count;
        outcome->lit = b->eye_dome != NULL;
    }
    glBindBuffer(GL_COPY_READ_BUFFER, gl->buffers[EWA_GL_READBACK].name);
    glUnmapBuffer(GL_COPY_READ_BUFFER);
    return status == EWA_OK ? ewa_gl_check(gl->device, "the picture") : status;
}

/// How many dispatches keep each below what a system's watchdog waits for, by what the last frame took; software has none.
static uint32_t count_parts(const ewa_gl_compute *gl) {
    enum { MAX_PARTS = 256 };
    static const double PART_S = 0.05;
    const double parts = gl->watched ? gl->surfel_s * (double)gl->device->surfel_count / PART_S : 0;
    const uint32_t wanted = 1 + (uint32_t)(parts < MAX_PARTS ? parts : MAX_PARTS);
    return wanted > gl->min_parts ? wanted : gl->min_parts;
}

/// Draws the band once; `*again`: there was too little room for it, or it lacked what the host makes.
static ewa_status draw_once(ewa_gl_compute *gl, band *b, ewa_gl_outcome *outcome, bool *again) {
    b->has_host_records = gl->needs_host;
    b->parts = count_parts(gl);
    EWA_TRY(reserve_work(gl, b));
    EWA_TRY(reserve_planes(gl, b));
    EWA_TRY(put_band(gl, b));
    gl->unfinished = true;
    bind_lists(gl);
    EWA_TRY(set_up(gl, b));
    if (b->has_host_records) EWA_TRY(make_host_records(gl, b, again));
    if (*again) return EWA_OK;
    EWA_TRY(draw_first_surface(gl, b));
    bool unfinished = true;
    uint32_t round = 0, end = gl->marks.rounds ? gl->marks.rounds : 1;
    for (; unfinished && !*again; round = end, end *= 2) {
        static const uint32_t none = 0;
        if (round > MAX_ROUNDS)
            return ewa_fail(gl->context, EWA_ERROR_LIMIT, "OpenGL: more splats lie behind the edges of a tile than %u rounds of %u units go over",
                            round, gl->edge_units);
        if (round) ewa_gl_buffer_write(gl->device, &gl->buffers[EWA_GL_COUNTS], offsetof(ewa_gl_tally, unfinished_count), &none, sizeof none);
        if (b->job->layers > 1) EWA_TRY(go_behind_edges(gl, b, round, end));
        EWA_TRY(draw_picture(gl, b));
        EWA_TRY(fetch(gl, b, outcome, again, &unfinished));
    }
    gl->unfinished = b->is_spoilt;
    return EWA_OK;
}

ewa_status ewa_gl_band_draw(ewa_gl_compute *gl, const ewa_tile_job *job, ewa_gl_rows rows, ewa_gl_outcome *outcome) {
    enum { SIDE = EWA_BLOCK_PX };
    band b = {.job = job, .rows = rows};
    b.width_px = (job->tiles.width_px + SIDE - 1) / SIDE * SIDE;
    b.height_px = (rows.end_px - rows.first_px + SIDE - 1) / SIDE * SIDE;
    b.tiles_per_row = (b.width_px + gl->tile_px - 1) / gl->tile_px;
    b.tile_count = b.tiles_per_row * ((b.height_px + gl->tile_px - 1) / gl->tile_px);
    b.eye_dome = ewa_gl_eye_dome_of(gl, job, rows);
    b.result = ewa_gl_result_of(&job->resolve, b.eye_dome, gl->finer, (uint64_t)job->tiles.width_px * rows.first_px,
                                (uint64_t)job->tiles.width_px * (rows.end_px - rows.first_px));
    bool again = true;
    while (again) {
        again = false;
        EWA_TRY(draw_once(gl, &b, outcome, &again));
    }
    return EWA_OK;
}
