// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// E57 files: from the header to the points of one scan after the other.
#include "io/e57/e57.h"
#include "base/format.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    HEADER_BYTES = 48,
    MIN_PAGE_BYTES = 64,
    MAX_PAGE_BYTES = 1 << 20,
    WAVE_RECORDS = 1 << 16,
    WAVE_TASKS = WAVE_RECORDS / EWA_E57_CHUNK_RECORDS,
};

typedef struct e57_state {
    const ewa_cloud_source *source;
    ewa_e57_pages pages;
    ewa_e57_contents contents;
    ewa_e57_columns columns;
    uint32_t scan_count_done; ///< scans that have been begun
    bool in_scan;
    ewa_e57_plan plan;
    ewa_e57_streams streams;
    uint64_t at;                        ///< of the records at hand, the next
    uint64_t lost_count;                ///< of this scan, in damaged pages
    uint64_t scan_records, scan_points; ///< of this scan, that are done with, that were handed over
    uint64_t announced, done;           ///< records of all scans, those that are done with
} e57_state;

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    return size_bytes >= 8 && memcmp(bytes, "ASTM-E57", 8) == 0;
}

// ---- opening ---------------------------------------------------------------------------------------------

/// Reads header and XML.
static ewa_status open_contents(e57_state *state) {
    const ewa_cloud_source *source = state->source;
    ewa_context *context = source->context;
    if (source->size_bytes < HEADER_BYTES)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the file ends in the header of %d bytes",
                        source->name, HEADER_BYTES);
    const uint8_t *header = source->bytes;
    const uint64_t major = ewa_e57_read_le(header + 8, 4), size = ewa_e57_read_le(header + 16, 8);
    const uint64_t xml_at = ewa_e57_read_le(header + 24, 8), xml_bytes = ewa_e57_read_le(header + 32, 8);
    const uint64_t page_bytes = ewa_e57_read_le(header + 40, 8);
    if (major != 1)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: E57 of version %llu; 1 is read", source->name,
                        (unsigned long long)major);
    if (page_bytes < MIN_PAGE_BYTES || page_bytes > MAX_PAGE_BYTES || page_bytes % 4)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: pages of %llu bytes", source->name,
                        (unsigned long long)page_bytes);
    if (size > source->size_bytes) {
        EWA_TRY(ewa_cloud_damage(source, 0, "%s: %llu bytes of %llu are there", source->name,
                                 (unsigned long long)source->size_bytes, (unsigned long long)size));
    }
    EWA_TRY(ewa_e57_pages_open(source, page_bytes, size < source->size_bytes ? size : source->size_bytes,
                               &state->pages));
    uint64_t logical;
    if (!ewa_e57_logical(&state->pages, xml_at, &logical))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the XML, from byte %llu on, is not there",
                        source->name, (unsigned long long)xml_at);
    const uint64_t payload = state->pages.payload_bytes;
    for (uint64_t page = logical / payload;
         page < state->pages.page_count && page * payload < logical + xml_bytes && state->pages.damaged_count;
         page++)
        if (state->pages.damaged[page])
            return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the XML is damaged in page %llu, at byte %llu",
                            source->name, (unsigned long long)page, (unsigned long long)(page * page_bytes));
    EWA_TRY(ewa_e57_xml_read(&state->pages, logical, xml_bytes, &state->contents));
    if (state->contents.scan_count == 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: there are no scans in it", source->name);
    return EWA_OK;
}

/// Says where the scanners stood, unless some scan does not say so.
static ewa_status note_scanners(const e57_state *state, ewa_cloud *prototype) {
    enum { LINE_BYTES = 96 };
    ewa_context *context = state->source->context;
    const uint32_t count = state->contents.scan_count;
    char *text = ewa_allocate(context, count, LINE_BYTES);
    if (!text) return EWA_ERROR_MEMORY;
    size_t length = 0;
    bool known = true;
    for (uint32_t i = 0; i < count; i++) {
        const ewa_e57_scan *scan = ewa_e57_scan_at(&state->contents, i);
        const double *t = scan->translation_world;
        bool spherical;
        ewa_e57_has_place(&state->contents, scan, &spherical);
        known = known && (scan->has_pose || spherical);
        length += (size_t)ewa_format(text + length, LINE_BYTES, "%s%.17g %.17g %.17g", i ? "\n" : "", t[0],
                                   t[1], t[2]);
    }
    const ewa_status status = known ? ewa_cloud_set_note(prototype, "scanners", text, length) : EWA_OK;
    ewa_release(context, text, count, LINE_BYTES);
    return status;
}

static ewa_status set_notes(const e57_state *state, ewa_cloud *prototype) {
    const ewa_e57_contents *c = &state->contents;
    const uint8_t *header = state->source->bytes;
    char text[128];
    int length = snprintf(text, sizeof text, "E57 %u.%u", (unsigned)ewa_e57_read_le(header + 8, 4),
                          (unsigned)ewa_e57_read_le(header + 12, 4));
    EWA_TRY(ewa_cloud_set_note(prototype, "file.format", text, (size_t)length));
    if (c->guid_bytes) EWA_TRY(ewa_cloud_set_note(prototype, "file.guid", c->guid.data, c->guid_bytes));
    if (c->library_bytes)
        EWA_TRY(ewa_cloud_set_note(prototype, "file.library", c->library.data, c->library_bytes));
    if (c->crs_bytes) EWA_TRY(ewa_cloud_set_note(prototype, "crs", c->crs.data, c->crs_bytes));
    if (c->image_count) {
        length = snprintf(text, sizeof text, "%llu", (unsigned long long)c->image_count);
        EWA_TRY(ewa_cloud_set_note(prototype, "file.images", text, (size_t)length));
    }
    const ewa_e57_limits limits = ewa_e57_scan_at(c, 0)->intensity;
    if (limits.low <= limits.high) {
        length = ewa_format(text, sizeof text, "%.17g to %.17g", limits.low, limits.high);
        EWA_TRY(ewa_cloud_set_note(prototype, "file.intensity", text, (size_t)length));
    }
    return note_scanners(state, prototype);
}

/// How many points can be there.
static ewa_status count_points(e57_state *state, uint64_t *point_count) {
    *point_count = 0;
    for (uint32_t i = 0; i < state->contents.scan_count; i++) {
        uint64_t count;
        EWA_TRY(ewa_e57_streams_open(&state->pages, &state->contents, i, false, &state->streams, &count));
        *point_count += count;
    }
    return EWA_OK;
}

static void close_file(void *opened) {
    e57_state *state = opened;
    if (!state) return;
    ewa_context *context = state->source->context;
    ewa_e57_streams_free(context, &state->streams);
    ewa_e57_contents_free(context, &state->contents);
    ewa_e57_pages_close(&state->pages);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_points(e57_state *state, ewa_cloud *prototype, uint64_t *point_count) {
    EWA_TRY(open_contents(state));
    EWA_TRY(ewa_e57_columns_map(state->source, &state->contents, &state->columns));
    for (uint32_t i = 0; i < state->columns.count; i++) {
        const ewa_e57_column *column = &state->columns.columns[i];
        EWA_TRY(ewa_cloud_add(prototype, column->name, column->type, column->component_count, NULL));
    }
    EWA_TRY(set_notes(state, prototype));
    ewa_cloud_set_origin(prototype, state->columns.origin_world);
    ewa_cloud_set_grid(prototype, &state->columns.grid);
    ewa_status status = count_points(state, point_count);
    state->announced = *point_count;
    return status;
}

static ewa_status open_file(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                            void **opened) {
    e57_state *state = ewa_allocate_zeroed(source->context, 1, sizeof *state);
    *opened = NULL;
    if (!state) return EWA_ERROR_MEMORY;
    state->source = source;
    const ewa_status status = open_points(state, prototype, point_count);
    if (status == EWA_OK)
        *opened = state;
    else
        close_file(state);
    return status;
}

// ---- reading ---------------------------------------------------------------------------------------------

/// The records at hand, divided into chunks.
typedef struct wave {
    const e57_state *state;
    const ewa_cloud_sink *sinks;
    uint64_t first, end;
    uint32_t kept_count[WAVE_TASKS];
    uint64_t lost_count[WAVE_TASKS];
    uint64_t to[WAVE_TASKS];
} wave;

static uint64_t chunk_first(const wave *w, uint32_t chunk) {
    const uint64_t first = w->first + (uint64_t)chunk * EWA_E57_CHUNK_RECORDS;
    return first < w->end ? first : w->end;
}

static void list_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    wave *w = data;
    uint16_t kept[EWA_E57_CHUNK_RECORDS];
    w->kept_count[task] = ewa_e57_list(&w->state->plan, &w->state->streams, chunk_first(w, task),
                                       chunk_first(w, task + 1), kept, &w->lost_count[task]);
}

static void move_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const wave *w = data;
    uint16_t kept[EWA_E57_CHUNK_RECORDS];
    uint64_t lost_count;
    const uint32_t count = ewa_e57_list(&w->state->plan, &w->state->streams, chunk_first(w, task),
                                        chunk_first(w, task + 1), kept, &lost_count);
    ewa_e57_move(&w->state->plan, &w->state->streams, chunk_first(w, task), kept, count, w->sinks,
                 w->to[task]);
}

/// Hands over points that are at hand, at most `maximum`; returns how many.
static uint64_t hand_over(e57_state *state, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t to) {
    wave w = {.state = state, .sinks = sinks, .first = state->at, .end = state->streams.held_count};
    const uint32_t chunks = (uint32_t)((w.end - w.first + EWA_E57_CHUNK_RECORDS - 1) / EWA_E57_CHUNK_RECORDS);
    ewa_parallel(state->source->context, list_task, &w, chunks);
    uint64_t got = 0;
    uint32_t whole = 0;
    while (whole < chunks && w.kept_count[whole] <= maximum - got) {
        w.to[whole] = to + got;
        got += w.kept_count[whole];
        state->lost_count += w.lost_count[whole++];
    }
    ewa_parallel(state->source->context, move_task, &w, whole);
    state->at = chunk_first(&w, whole);
    if (whole == chunks || got == maximum) return got;
    uint16_t kept[EWA_E57_CHUNK_RECORDS];
    uint64_t lost_count;
    ewa_e57_list(&state->plan, &state->streams, state->at, chunk_first(&w, whole + 1), kept, &lost_count);
    const uint32_t count = (uint32_t)(maximum - got);
    ewa_e57_move(&state->plan, &state->streams, state->at, kept, count, sinks, to + got);
    const uint64_t end = state->at + kept[count - 1] + 1;
    ewa_e57_list(&state->plan, &state->streams, state->at, end, kept, &lost_count);
    state->lost_count += lost_count;
    state->at = end;
    return maximum;
}

static ewa_status end_scan(e57_state *state) {
    const uint64_t lost = state->lost_count, left = state->scan_records - state->scan_points - lost;
    if (left)
        ewa_report(state->source->context, EWA_SEVERITY_INFO,
                   "%s: scan %u: %llu of %llu points have no place and are left out", state->source->name,
                   state->scan_count_done, (unsigned long long)left, (unsigned long long)state->scan_records);
    state->scan_records = state->scan_points = 0;
    state->in_scan = false;
    state->lost_count = 0;
    if (!lost) return EWA_OK;
    return ewa_cloud_damage(state->source, lost, "%s: scan %u: points lie in damaged pages",
                            state->source->name, state->scan_count_done);
}

static ewa_status begin_scan(e57_state *state) {
    const uint32_t index = state->scan_count_done++;
    const ewa_e57_scan *scan = ewa_e57_scan_at(&state->contents, index);
    bool spherical;
    uint64_t count;
    if (!ewa_e57_has_place(&state->contents, scan, &spherical)) {
        if (!scan->record_count) return EWA_OK;
        return ewa_cloud_damage(state->source, scan->record_count, "%s: scan %u has no coordinates",
                                state->source->name, index + 1);
    }
    ewa_e57_plan_make(&state->contents, &state->columns, index, &state->plan);
    state->in_scan = true;
    state->at = 0;
    return ewa_e57_streams_open(&state->pages, &state->contents, index, true, &state->streams, &count);
}

static ewa_status read_points(void *opened, uint64_t maximum, const ewa_cloud_sink *sinks,
                              uint64_t *got_count) {
    e57_state *state = opened;
    uint64_t got = 0;
    ewa_status status = EWA_OK;
    while (got < maximum && status == EWA_OK) {
        if (!state->in_scan) {
            if (state->scan_count_done == state->contents.scan_count) break;
            status = begin_scan(state);
        } else if (state->at < state->streams.held_count) {
            const uint64_t handed = hand_over(state, maximum - got, sinks, got);
            got += handed;
            state->scan_points += handed;
        } else {
            state->done += state->streams.held_count;
            state->scan_records += state->streams.held_count;
            state->at = 0;
            status = ewa_e57_streams_next(&state->streams, WAVE_RECORDS);
            if (status == EWA_OK && state->streams.held_count == 0) status = end_scan(state);
            if (status == EWA_OK && state->announced)
                status = ewa_progress(state->source->context, "read",
                                      (double)state->done / (double)state->announced);
        }
    }
    *got_count = got;
    return status;
}

const ewa_cloud_format ewa_format_e57 = {EWA_MODEL_E57, probe, open_file, read_points, close_file};
