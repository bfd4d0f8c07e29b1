// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of Gaussians on the device: records of what is visible, sorted by depth, listed in the tiles that they touch, sorted by
// these, composited. The host waits once, at the end; what found no room is drawn again with more of it.
#include "gl/gaussians.h"

#include <string.h>

enum { LANES = EWA_SPLAT_LANES, THREADS = 256, READBACK_HEAD = 64, BOX_BYTES = 8 };

/// As gaussian_frame.glsl has it.
typedef struct frame_block {
    uint32_t picture_px[2], tiles_per_row, tile_count;
    uint32_t visible_capacity, pair_capacity, orthographic, trained;
    uint32_t keep, expected, normals, with_codes;
    int32_t rgba_at, depth_at, coverage_at;
    float minimum_alpha;
    float minimum_transmittance, near_depth;
    uint32_t block_count, pad;
    float background[4];
    uint32_t with_surface, with_coverage, section_count, sections_pad;
    double unit_camera, unit_pad;
    double lens[4], sections[EWA_MAX_SECTION_PLANES][4];
} frame_block;

/// As gaussian_project.glsl has it.
typedef struct view_block {
    uint32_t orthographic, trained, flat, normals, keep, sh_degree, harmonic_count, with_colors, with_lanes;
    float fx_px, fy_px, cx_px, cy_px, width_px, height_px, last_column, last_row;
    float turn[3][3], origin[3], eye[3], forward[3], slopes[4];
    float near, cutoff2, prefilter_px2, dot_px2, log2_min, minimum_alpha, set_unit;
    float inverse_dot;
} view_block;

/// Words of EWA_GL_SPLAT_COUNTS.
enum { SLOT_COUNT, VISIBLE_COUNT, PAIR_COUNT, NEAR_COUNT, STOPPED_COUNT, COUNT_WORDS = 8 };

/// Packets of a set in a page: as gaussian_project.glsl has it.
typedef struct segment {
    uint32_t first, at, slot, view;
} segment;

/// The segments of a page that a frame draws from: [first, end), and their packets.
typedef struct page_use {
    uint32_t set, page, view, first, end, packet_count;
} page_use;

/// Stages whose times are told, as numbers of ewa_gl_times.
enum { PROJECTION, LISTS, COMPOSITING };

/// The numbers of a frame.
typedef struct frame {
    const ewa_gaussian_job *job;
    ewa_gl_gaussian_detail detail;
    uint32_t use_count, slot_count, parts;
    uint64_t pixel_count, words;          ///< of the result
    int64_t rgba_at, depth_at, coverage_at; ///< -1: not wanted
} frame;

static uint64_t smaller(uint64_t a, uint64_t b) { return a < b ? a : b; }

static ewa_status reserve(ewa_gl_gaussians *of, int kind, const char *what, uint64_t size_bytes) {
    return ewa_gl_buffer_reserve(of->device, &of->buffers[kind], what, size_bytes);
}

static ewa_status put(ewa_gl_gaussians *of, int kind, const char *what, const void *bytes, uint64_t size_bytes) {
    return ewa_gl_buffer_put(of->device, &of->buffers[kind], what, bytes, size_bytes);
}

static void bind(const ewa_gl_gaussians *of, GLuint binding, int kind) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, of->buffers[kind].name);
}

static void set_view_block(view_block *to, const ewa_gaussian_view *view) {
    *to = (view_block){.orthographic = view->orthographic,
                       .trained = view->trained,
                       .flat = view->flat,
                       .normals = view->normals,
                       .keep = view->keep,
                       .sh_degree = view->sh_degree,
                       .harmonic_count = view->harmonic_count,
                       .fx_px = view->fx_px,
                       .fy_px = view->fy_px,
                       .cx_px = view->cx_px,
                       .cy_px = view->cy_px,
                       .width_px = view->width_px,
                       .height_px = view->height_px,
                       .last_column = view->last_column,
                       .last_row = view->last_row,
                       .near = view->near,
                       .cutoff2 = view->cutoff2,
                       .prefilter_px2 = view->prefilter_px2,
                       .dot_px2 = view->dot_px2,
                       .log2_min = view->log2_min,
                       .minimum_alpha = view->minimum_alpha,
                       .set_unit = view->set_unit,
                       .inverse_dot = view->dot_px2 > 0 ? 1 / view->dot_px2 : 1};
    memcpy(to->turn, view->turn, sizeof to->turn);
    memcpy(to->origin, view->origin, sizeof to->origin);
    memcpy(to->eye, view->eye, sizeof to->eye);
    memcpy(to->forward, view->forward, sizeof to->forward);
    memcpy(to->slopes, view->slopes, sizeof to->slopes);
}

/// Adds packets [first, first + count) of a set to the segments, page by page; `slot` is the number of the first of the frame's.
static ewa_status add_packets(ewa_gl_gaussians *of, frame *f, uint32_t *segment_count, uint32_t view, uint32_t set, size_t first,
                              uint32_t count, uint32_t slot) {
    const uint32_t page_packets = ewa_gl_splat_sets_at(&of->sets, set)->page_packets;
    while (count) {
        const uint32_t page = (uint32_t)(first / page_packets), at = (uint32_t)(first % page_packets);
        const uint32_t here = (uint32_t)smaller(count, page_packets - at);
        page_use *use = (page_use *)of->uses.data + f->use_count - 1;
        if (!f->use_count || use->set != set || use->page != page || use->view != view) {
            EWA_TRY(ewa_buffer_grow(of->context, &of->uses, f->use_count, (size_t)f->use_count + 1, sizeof *use));
            use = (page_use *)of->uses.data + f->use_count++;
            *use = (page_use){.set = set, .page = page, .view = view, .first = *segment_count, .end = *segment_count};
        }
        segment *last = (segment *)of->segments.data + *segment_count - 1;
        const bool goes_on = use->end > use->first && last->at + use->packet_count - last->first == at &&
                             last->slot + use->packet_count - last->first == slot;
        if (!goes_on) {
            EWA_TRY(ewa_buffer_grow(of->context, &of->segments, *segment_count, (size_t)*segment_count + 1, sizeof *last));
            ((segment *)of->segments.data)[(*segment_count)++] = (segment){use->packet_count, at, slot, view};
            use->end++;
        }
        use->packet_count += here, first += here, slot += here, count -= here;
    }
    return EWA_OK;
}

/// Copies the planes of surfaces that are there: depth, colours, coverage.
static ewa_status put_surfaces(ewa_gl_gaussians *of, const frame *f) {
    enum { FLOATS = 6 };
    const ewa_surface_planes *planes = &f->job->target.surface;
    const uint64_t plane_bytes = f->pixel_count * sizeof(float);
    const ewa_gl_buffer *buffer = &of->buffers[EWA_GL_SPLAT_SURFACES];
    if (!f->job->view.with_surface) return reserve(of, EWA_GL_SPLAT_SURFACES, "surfaces", 0);
    EWA_TRY(reserve(of, EWA_GL_SPLAT_SURFACES, "surfaces", FLOATS * plane_bytes));
    ewa_gl_buffer_write(of->device, buffer, 0, planes->depth, plane_bytes);
    ewa_gl_buffer_write(of->device, buffer, plane_bytes, planes->rgba, 4 * plane_bytes);
    if (planes->coverage) ewa_gl_buffer_write(of->device, buffer, 5 * plane_bytes, planes->coverage, plane_bytes);
    return EWA_OK;
}

/// What all turns of the frame see: views, sets, which packets of them are drawn.
static ewa_status put_frame(ewa_gl_gaussians *of, frame *f) {
    const ewa_gaussian_job *job = f->job;
    const uint32_t set_count = job->mixture->splats_count;
    const ewa_gaussian_view *views = job->renderer->views.data;
    EWA_TRY(ewa_buffer_reserve(of->context, &of->views, set_count, sizeof(view_block)));
    ewa_gl_splat_sets_start(of->device, &of->sets);
    view_block *blocks = of->views.data;
    uint32_t segment_count = 0, part = 0;
    for (uint32_t i = 0; i < set_count; i++) {
        uint32_t set;
        set_view_block(&blocks[i], &views[i]);
        blocks[i].with_colors = job->colors && job->colors[i];
        blocks[i].with_lanes = job->mixture->splats[i]->shown_lanes != NULL;
        EWA_TRY(ewa_gl_splat_sets_get(of->device, &of->sets, job->mixture->splats[i], &set));
        for (; part < job->part_count && job->parts[part].view == &views[i]; part++) {
            const ewa_gaussian_part *p = &job->parts[part];
            EWA_TRY(add_packets(of, f, &segment_count, i, set, p->first_packet, p->packet_count, p->first_slot / LANES));
        }
    }
    f->slot_count = (uint32_t)job->room;
    EWA_TRY(put_surfaces(of, f));
    EWA_TRY(put(of, EWA_GL_SPLAT_VIEWS, "views", blocks, (uint64_t)set_count * sizeof *blocks));
    return put(of, EWA_GL_SPLAT_SEGMENTS, "packets", of->segments.data, (uint64_t)segment_count * sizeof(segment));
}

static uint64_t record_bytes(const frame *f) { return 16 * (uint64_t)ewa_gl_record_parts[f->detail]; }

/// Room for what is known before anything is counted; marks that are not set yet begin small.
static ewa_status reserve_work(ewa_gl_gaussians *of, const frame *f) {
    enum { VISIBLE = 1 << 18, TILES_OF_EACH = 4 };
    const uint64_t fit = of->device->facts.storage_bytes, slots = f->slot_count;
    if (!of->visible_mark) of->visible_mark = (uint32_t)smaller(smaller(slots ? slots : 1, VISIBLE), fit / record_bytes(f));
    if (!of->pair_mark) of->pair_mark = (uint32_t)smaller(TILES_OF_EACH * (uint64_t)of->visible_mark, fit / sizeof(uint32_t));
    const uint64_t visible = of->visible_mark, pairs = of->pair_mark, word = sizeof(uint32_t);
    EWA_TRY(reserve(of, EWA_GL_SLOT_KEYS, "Gaussians", slots * word));
    EWA_TRY(reserve(of, EWA_GL_SLOT_NUMBERS, "Gaussians", slots * word));
    EWA_TRY(reserve(of, EWA_GL_SPLAT_RECORDS, "visible Gaussians", visible * record_bytes(f)));
    EWA_TRY(reserve(of, EWA_GL_SPLAT_BOXES, "visible Gaussians", visible * BOX_BYTES));
    for (int i = 0; i < 4; i++) EWA_TRY(reserve(of, EWA_GL_DEPTH_KEYS + i, "visible Gaussians", visible * word));
    EWA_TRY(reserve(of, EWA_GL_BLOCK_SUMS, "visible Gaussians", (visible / EWA_GL_SORT_BLOCK + 1) * word));
    for (int i = 0; i < 4; i++) EWA_TRY(reserve(of, EWA_GL_TILE_KEYS + i, "lists of tiles", pairs * word));
    EWA_TRY(reserve(of, EWA_GL_SPLAT_RESULT, "the picture", f->words * word));
    of->buffers[EWA_GL_SPLAT_READBACK].usage = GL_STREAM_READ;
    return reserve(of, EWA_GL_SPLAT_READBACK, "the picture", READBACK_HEAD + f->words * word);
}

static uint32_t block_count_of(uint32_t items) {
    return (uint32_t)(((uint64_t)items + EWA_GL_SORT_BLOCK - 1) / EWA_GL_SORT_BLOCK);
}

static ewa_status put_numbers(ewa_gl_gaussians *of, const frame *f) {
    const ewa_gaussian_job *job = f->job;
    frame_block block = {.picture_px = {job->target.width_px, job->target.height_px},
                         .tiles_per_row = job->tiles.columns,
                         .tile_count = ewa_tiles_count(&job->tiles),
                         .visible_capacity = of->visible_mark,
                         .pair_capacity = of->pair_mark,
                         .orthographic = job->view.orthographic,
                         .trained = job->view.trained,
                         .keep = job->view.keep,
                         .expected = job->view.expected,
                         .normals = job->view.normals,
                         .with_codes = job->target.rgba8 != NULL,
                         .rgba_at = (int32_t)f->rgba_at,
                         .depth_at = (int32_t)f->depth_at,
                         .coverage_at = (int32_t)f->coverage_at,
                         .minimum_alpha = job->view.minimum_alpha,
                         .minimum_transmittance = job->view.minimum_transmittance,
                         .near_depth = job->view.near,
                         .block_count = block_count_of(of->visible_mark),
                         .with_surface = job->view.with_surface,
                         .with_coverage = job->target.surface.coverage != NULL,
                         .section_count = job->sections.count,
                         .unit_camera = job->view.unit_camera,
                         .lens = {job->sections.fx_px, job->sections.fy_px, job->sections.cx_px, job->sections.cy_px}};
    memcpy(block.background, job->target.background, sizeof block.background);
    memcpy(block.sections, job->sections.planes, sizeof block.sections);
    EWA_TRY(put(of, EWA_GL_SPLAT_FRAME, "the frame", &block, sizeof block));
    const uint32_t counts[COUNT_WORDS] = {[SLOT_COUNT] = f->slot_count};
    return put(of, EWA_GL_SPLAT_COUNTS, "counts", counts, sizeof counts);
}

static ewa_status use(ewa_gl_gaussians *of, const frame *f, ewa_gl_gaussian_pass pass) {
    return ewa_gl_gaussian_program_use(of->device, &of->programs, &of->arithmetic, pass, f->detail);
}

/// Records and keys of all splats: a dispatch for each page.
static ewa_status project(ewa_gl_gaussians *of, const frame *f) {
    enum { FIRST_SEGMENT, END_SEGMENT, PACKET_COUNT };
    EWA_TRY(use(of, f, EWA_GL_SPLATS_PROJECT));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, of->buffers[EWA_GL_SPLAT_FRAME].name);
    bind(of, 0, EWA_GL_SPLAT_VIEWS), bind(of, 3, EWA_GL_SPLAT_SEGMENTS), bind(of, 4, EWA_GL_SLOT_KEYS);
    bind(of, 5, EWA_GL_SLOT_NUMBERS), bind(of, 6, EWA_GL_SPLAT_RECORDS), bind(of, 7, EWA_GL_SPLAT_BOXES);
    bind(of, 8, EWA_GL_SPLAT_COUNTS);
    const page_use *uses = of->uses.data;
    for (uint32_t i = 0; i < f->use_count; i++) {
        const ewa_gaussian_job *job = f->job;
        const ewa_gl_splat_look look = {job->mixture->splats[uses[i].view], job->colors ? job->colors[uses[i].view] : NULL};
        const ewa_gl_splat_page *page;
        EWA_TRY(ewa_gl_splat_sets_look(of->device, &of->sets, uses[i].set, uses[i].page, &look, &page));
        // Where a page lacks something another stands there, which the program does not read.
        const GLuint packets = page->packets.name, harmonics = page->harmonics.name, colors = page->colors.name,
                     lanes = page->lanes.name;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, packets);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, harmonics ? harmonics : packets);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 9, colors ? colors : packets);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 10, lanes ? lanes : packets);
        glUniform1ui(FIRST_SEGMENT, uses[i].first);
        glUniform1ui(END_SEGMENT, uses[i].end);
        glUniform1ui(PACKET_COUNT, uses[i].packet_count);
        ewa_gl_program_run(of->device, ((uint64_t)uses[i].packet_count * LANES + THREADS - 1) / THREADS);
    }
    ewa_gl_times_mark(&of->times, (ewa_gl_pass)PROJECTION);
    return ewa_gl_check(of->device, "Gaussians");
}

static ewa_gl_items items_of(const ewa_gl_gaussians *of, int keys, int numbers, uint32_t capacity) {
    return (ewa_gl_items){&of->buffers[keys], &of->buffers[numbers], capacity};
}

/// Sorts what is visible by depth; returns which of the two lists it ends in.
static ewa_status sort_depths(ewa_gl_gaussians *of, const frame *f, int *in) {
    enum { PASSES = 32 / EWA_GL_SORT_BITS };
    const ewa_gl_buffer *counts = &of->buffers[EWA_GL_SPLAT_COUNTS];
    ewa_gl_items from = items_of(of, EWA_GL_SLOT_KEYS, EWA_GL_SLOT_NUMBERS, f->slot_count);
    for (int pass = 0; pass < PASSES; pass++) {
        *in = pass % 2;
        const ewa_gl_items to = items_of(of, EWA_GL_DEPTH_KEYS + *in, EWA_GL_DEPTH_NUMBERS + *in, of->visible_mark);
        EWA_TRY(ewa_gl_sort_pass(of->device, &of->sorter, &from, &to, counts, pass ? VISIBLE_COUNT : SLOT_COUNT,
                                 (uint32_t)pass * EWA_GL_SORT_BITS));
        from = to;
    }
    return EWA_OK;
}

/// Lists splats in tiles, from depth list `in` on, and sorts them by these; `*in` becomes that of the lists of tiles.
static ewa_status list_tiles(ewa_gl_gaussians *of, const frame *f, int *in) {
    const uint32_t blocks = block_count_of(of->visible_mark);
    const uint64_t groups[] = {blocks, 1, blocks, ((uint64_t)of->pair_mark + THREADS - 1) / THREADS};
    bind(of, 0, EWA_GL_DEPTH_NUMBERS + *in), bind(of, 1, EWA_GL_SPLAT_BOXES), bind(of, 2, EWA_GL_BLOCK_SUMS);
    bind(of, 3, EWA_GL_DEPTH_KEYS + *in), bind(of, 4, EWA_GL_TILE_KEYS), bind(of, 5, EWA_GL_TILE_NUMBERS);
    for (int stage = 0; stage < 4; stage++) {
        EWA_TRY(use(of, f, (ewa_gl_gaussian_pass)(EWA_GL_SPLATS_COUNT + stage)));
        ewa_gl_program_run(of->device, groups[stage]);
    }
    *in = 0;
    for (uint32_t shift = 0; shift < 32 && (ewa_tiles_count(&f->job->tiles) - 1) >> shift; shift += EWA_GL_SORT_BITS) {
        const ewa_gl_items from = items_of(of, EWA_GL_TILE_KEYS + *in, EWA_GL_TILE_NUMBERS + *in, of->pair_mark);
        *in = !*in;
        const ewa_gl_items to = items_of(of, EWA_GL_TILE_KEYS + *in, EWA_GL_TILE_NUMBERS + *in, of->pair_mark);
        EWA_TRY(ewa_gl_sort_pass(of->device, &of->sorter, &from, &to, &of->buffers[EWA_GL_SPLAT_COUNTS], PAIR_COUNT, shift));
    }
    ewa_gl_times_mark(&of->times, (ewa_gl_pass)LISTS);
    return EWA_OK;
}

/// Composites the tiles, in parts, and copies pixels and counts to where the host can read them.
static ewa_status composite(ewa_gl_gaussians *of, const frame *f, int in) {
    enum { FIRST_TILE, QUARTERS = 4 };
    const uint32_t tile_count = ewa_tiles_count(&f->job->tiles), step = (tile_count + f->parts - 1) / f->parts;
    bind(of, 0, EWA_GL_TILE_KEYS + in), bind(of, 1, EWA_GL_TILE_NUMBERS + in), bind(of, 2, EWA_GL_SPLAT_RECORDS);
    bind(of, 3, EWA_GL_SPLAT_RESULT), bind(of, 4, EWA_GL_SPLAT_SURFACES);
    EWA_TRY(use(of, f, EWA_GL_SPLATS_DRAW));
    for (uint32_t first = 0; first < tile_count; first += step) {
        glUniform1ui(FIRST_TILE, first);
        ewa_gl_program_run(of->device, QUARTERS * smaller(step, tile_count - first));
        if (first + step < tile_count) glFlush();
    }
    ewa_gl_times_mark(&of->times, (ewa_gl_pass)COMPOSITING);
    glBindBuffer(GL_COPY_WRITE_BUFFER, of->buffers[EWA_GL_SPLAT_READBACK].name);
    glBindBuffer(GL_COPY_READ_BUFFER, of->buffers[EWA_GL_SPLAT_COUNTS].name);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, COUNT_WORDS * sizeof(uint32_t));
    glBindBuffer(GL_COPY_READ_BUFFER, of->buffers[EWA_GL_SPLAT_RESULT].name);
    if (f->words)
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, READBACK_HEAD, (GLsizeiptr)(f->words * sizeof(uint32_t)));
    return ewa_gl_check(of->device, "the picture");
}

/// Raises a mark to what a frame needed, and some more.
static ewa_status raise(ewa_gl_gaussians *of, uint32_t *mark, uint32_t need, int kind, const char *what, uint64_t item_bytes) {
    enum { SPARE = 8 };
    if (need <= *mark) return EWA_OK;
    EWA_TRY(reserve(of, kind, what, need * item_bytes));
    *mark = (uint32_t)smaller(need + (uint64_t)need / SPARE, of->device->facts.storage_bytes / item_bytes);
    return EWA_OK;
}

/// Raises the marks that a frame went beyond; `*again`: it has to be drawn again.
static ewa_status check_counts(ewa_gl_gaussians *of, const frame *f, const uint32_t *counts, bool *again) {
    *again = counts[VISIBLE_COUNT] > of->visible_mark || counts[PAIR_COUNT] > of->pair_mark;
    EWA_TRY(raise(of, &of->visible_mark, counts[VISIBLE_COUNT], EWA_GL_SPLAT_RECORDS, "visible Gaussians", record_bytes(f)));
    EWA_TRY(raise(of, &of->pair_mark, counts[PAIR_COUNT], EWA_GL_TILE_KEYS, "lists of tiles", sizeof(uint32_t)));
    if (*again || !counts[STOPPED_COUNT]) return EWA_OK;
    return ewa_fail(of->context, EWA_ERROR_LIMIT, "OpenGL: %s stops programs that take long: too many Gaussians lie in %u pixels",
                    of->device->facts.renderer, counts[STOPPED_COUNT]);
}

/// Normals: the surface's where it gave the depth, as store_geometry() of src/volume has it; 0 elsewhere. Frames
/// with normals have depths.
static void set_normals(const frame *f) {
    const ewa_volume_target *to = &f->job->target;
    const ewa_surface_planes *surface = &to->surface;
    for (size_t i = 0; i < f->pixel_count; i++) {
        const bool own = surface->normal && (f->job->view.expected || to->depth[i] == surface->depth[i]);
        for (size_t c = 0; c < 3; c++) to->normal[3 * i + c] = own ? surface->normal[3 * i + c] : 0;
    }
}

static void copy_planes(const frame *f, const uint8_t *from) {
    const ewa_volume_target *to = &f->job->target;
    const size_t pixels = f->pixel_count, word = sizeof(uint32_t);
    if (to->rgba8) memcpy(to->rgba8, from, pixels * word);
    if (to->rgba) memcpy(to->rgba, from + (size_t)f->rgba_at * word, 4 * pixels * word);
    if (to->depth) memcpy(to->depth, from + (size_t)f->depth_at * word, pixels * word);
    if (to->coverage) memcpy(to->coverage, from + (size_t)f->coverage_at * word, pixels * word);
    if (to->normal) set_normals(f);
}

/// Fetches counts and, unless it has to be drawn again, pixels.
static ewa_status fetch(ewa_gl_gaussians *of, const frame *f, uint32_t *counts, bool *again) {
    EWA_TRY(ewa_gl_wait(of->device, "Gaussians"));
    ewa_gl_times_read(&of->times);
    ewa_gl_times_resume(&of->times);
    const uint64_t size_bytes = READBACK_HEAD + f->words * sizeof(uint32_t);
    of->device->counts.readbacks++, of->device->counts.readback_bytes += size_bytes;
    glBindBuffer(GL_COPY_READ_BUFFER, of->buffers[EWA_GL_SPLAT_READBACK].name);
    const uint8_t *from = glMapBufferRange(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)size_bytes, GL_MAP_READ_BIT);
    if (!from) return ewa_gl_check(of->device, "the picture");
    memcpy(counts, from, COUNT_WORDS * sizeof *counts);
    const ewa_status status = check_counts(of, f, counts, again);
    if (status == EWA_OK && !*again) copy_planes(f, from + READBACK_HEAD);
    glUnmapBuffer(GL_COPY_READ_BUFFER);
    return status == EWA_OK ? ewa_gl_check(of->device, "the picture") : status;
}

/// Where planes are in the result.
static void place_planes(frame *f) {
    const ewa_volume_target *to = &f->job->target;
    f->pixel_count = (uint64_t)to->width_px * to->height_px;
    f->words = to->rgba8 ? f->pixel_count : 0;
    const struct {
        const float *plane;
        int64_t *at;
        uint32_t words;
    } planes[] = {{to->rgba, &f->rgba_at, 4}, {to->depth, &f->depth_at, 1}, {to->coverage, &f->coverage_at, 1}};
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++) {
        *planes[i].at = planes[i].plane ? (int64_t)f->words : -1;
        if (planes[i].plane) f->words += planes[i].words * f->pixel_count;
    }
}

/// How many dispatches keep each below what a system's watchdog waits for, by what the last frame took; software has none.
static uint32_t count_parts(const ewa_gl_gaussians *of, const frame *f) {
    static const double PART_S = 0.05, MAX_PARTS = 256;
    const double parts = of->watched ? of->splat_s * f->slot_count / PART_S : 0;
    return 1 + (uint32_t)(parts < MAX_PARTS ? parts : MAX_PARTS);
}

/// Draws the frame once; `*again`: there was too little room for it.
static ewa_status draw_once(ewa_gl_gaussians *of, const frame *f, uint32_t *counts, bool *again) {
    int in;
    EWA_TRY(reserve_work(of, f));
    EWA_TRY(put_numbers(of, f));
    EWA_TRY(project(of, f));
    EWA_TRY(sort_depths(of, f, &in));
    EWA_TRY(list_tiles(of, f, &in));
    EWA_TRY(composite(of, f, in));
    return fetch(of, f, counts, again);
}

ewa_status ewa_gl_gaussians_draw(ewa_gl_gaussians *of, const ewa_gaussian_job *job, ewa_gaussian_stats *stats) {
    frame f = {.job = job};
    const ewa_gaussian_view *view = &job->view;
    const bool among = view->with_surface || view->with_sections;
    if (view->with_flat) f.detail = among ? EWA_GL_SPLATS_FLAT_AMONG : EWA_GL_SPLATS_FLAT;
    else if (among || view->with_depth || !view->trained) f.detail = among ? EWA_GL_SPLATS_DEEP_AMONG : EWA_GL_SPLATS_DEEP;
    place_planes(&f);
    *stats = (ewa_gaussian_stats){.splat_count = 0};
    for (uint32_t i = 0; i < job->mixture->splats_count; i++) stats->splat_count += job->mixture->splats[i]->info.splat_count;
    of->device->surfel_count = stats->splat_count;
    ewa_gl_times_start(&of->times);
    ewa_gl_times_resume(&of->times);
    EWA_TRY(put_frame(of, &f));
    f.parts = count_parts(of, &f);
    uint32_t counts[COUNT_WORDS];
    bool again = true;
    while (again) EWA_TRY(draw_once(of, &f, counts, &again));
    const double *seconds = of->times.seconds;
    if (f.slot_count) of->splat_s = seconds[COMPOSITING] / f.slot_count;
    stats->visible_count = counts[VISIBLE_COUNT], stats->near_count = counts[NEAR_COUNT], stats->tile_count = counts[PAIR_COUNT];
    stats->project_s = seconds[PROJECTION], stats->bin_s = seconds[LISTS];
    stats->draw_s = seconds[COMPOSITING];
    return EWA_OK;
}

void ewa_gl_gaussians_reset(ewa_gl_gaussians *of, bool there) {
    ewa_gl_splat_sets_free(of->context, &of->sets, there);
    if (there) {
        ewa_gl_gaussian_programs_free(&of->programs);
        ewa_gl_sorter_free(&of->sorter);
        ewa_gl_times_free(&of->times);
        for (int i = 0; i < EWA_GL_SPLAT_BUFFERS; i++) ewa_gl_buffer_free(&of->buffers[i]);
    }
    of->programs = (ewa_gl_gaussian_programs){.programs = {{0}}};
    of->sorter = (ewa_gl_sorter){.programs = {0}};
    memset(&of->times, 0, sizeof of->times);
    memset(of->buffers, 0, sizeof of->buffers);
    of->visible_mark = of->pair_mark = 0;
    of->device = NULL;
}
