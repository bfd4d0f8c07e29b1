// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a PCD file to points: binary records are moved straight from the file, packed ones after they have
// been unpacked, text wave by wave. Points whose position is not finite, of which organised clouds have many,
// are left out.
#include "base/base.h"
#include "base/format.h"
#include "io/cloud/pcd.h"
#include "io/reader.h"

#include <stdio.h>

enum {
    TASK_BYTES = 1 << 17, ///< of records per parallel task
    WAVE_TASKS = 1 << 5,
    PROBE_BYTES = 1 << 16,
};

typedef struct pcd_state {
    const ewa_cloud_source *source;
    ewa_pcd_header header;
    ewa_pcd_column columns[EWA_PCD_MAX_COLUMNS];
    ewa_pcd_records records;
    uint64_t record_count, at; ///< that are there, that are done with
    uint64_t invalid_count;    ///< of these, without a place
    uint8_t *unpacked;
    uint64_t unpacked_bytes;
    ewa_pcd_text *text;
} pcd_state;

/// Whether the first word that is no comment is one that PCD headers begin with.
static bool begins_as_header(const char *at, const char *end) {
    while (at < end) {
        while (at < end && (ewa_is_blank(*at) || ewa_is_line_end(*at))) at++;
        if (at == end || *at != '#') break;
        while (at < end && !ewa_is_line_end(*at)) at++;
    }
    static const char *const words[] = {"VERSION", "FIELDS", "COLUMNS"};
    for (int i = 0; i < 3; i++) {
        const size_t length = strlen(words[i]);
        if ((size_t)(end - at) > length && memcmp(at, words[i], length) == 0 && ewa_is_blank(at[length]))
            return true;
    }
    return false;
}

/// A file that is called .pcd is one: without its header it would look like a list of numbers.
static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    const size_t length = strlen(name);
    const ewa_text suffix = {name + (length < 4 ? 0 : length - 4), length < 4 ? 0 : 4};
    const uint64_t looked_at = size_bytes < PROBE_BYTES ? size_bytes : PROBE_BYTES;
    return begins_as_header((const char *)bytes + ewa_bytes_mark(bytes, looked_at), (const char *)bytes + looked_at) ||
           ewa_text_is_any_case(suffix, ".pcd");
}

// ---- opening ---------------------------------------------------------------------------------------------

static ewa_status open_binary(pcd_state *state) {
    const ewa_cloud_source *source = state->source;
    const ewa_pcd_header *h = &state->header;
    const uint64_t there = (source->size_bytes - h->data_at_bytes) / h->record_bytes;
    state->records.bytes = source->bytes + h->data_at_bytes;
    state->record_count = h->point_count;
    if (h->point_count <= there) return EWA_OK;
    state->record_count = there;
    return ewa_cloud_damage(source, h->point_count - there,
                            "%s: the file ends after %llu of %llu points of %u bytes", source->name,
                            (unsigned long long)there, (unsigned long long)h->point_count, h->record_bytes);
}

/// Places the fields one behind the other; padding is left out by some writers.
static ewa_status place_columns(pcd_state *state, uint64_t unpacked_bytes) {
    ewa_pcd_header *h = &state->header;
    uint64_t bytes = 0, padded;
    for (uint32_t i = 0; i < h->field_count; i++)
        if (!h->fields[i].padding) bytes += (uint64_t)h->fields[i].size_bytes * h->fields[i].count;
    if (__builtin_mul_overflow((uint64_t)h->record_bytes, h->point_count, &padded)) padded = UINT64_MAX;
    const bool has_padding = padded == unpacked_bytes;
    if (!has_padding && (h->point_count > unpacked_bytes || bytes * h->point_count != unpacked_bytes))
        return ewa_fail(state->source->context, EWA_ERROR_FORMAT,
                        "%s: %llu points of %llu bytes are not the %llu bytes that are packed",
                        state->source->name, (unsigned long long)h->point_count, (unsigned long long)bytes,
                        (unsigned long long)unpacked_bytes);
    uint64_t base = 0;
    for (uint32_t i = 0; i < h->field_count; i++) {
        ewa_pcd_field *field = &h->fields[i];
        field->base_bytes = base;
        field->stride_bytes = (uint64_t)field->size_bytes * field->count;
        if (has_padding || !field->padding) base += field->stride_bytes * h->point_count;
    }
    return EWA_OK;
}

static ewa_status open_compressed(pcd_state *state) {
    const ewa_cloud_source *source = state->source;
    ewa_context *context = source->context;
    const uint64_t at = state->header.data_at_bytes, left = source->size_bytes - at;
    if (left < 8)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the file ends before the packed points",
                        source->name);
    const uint64_t packed_bytes = ewa_bytes_u32(source->bytes + at), bytes = ewa_bytes_u32(source->bytes + at + 4);
    if (packed_bytes > left - 8)
        return ewa_fail(context, EWA_ERROR_FORMAT,
                        "%s: byte %llu: %llu bytes of packed points, of which %llu are there", source->name,
                        (unsigned long long)at, (unsigned long long)packed_bytes,
                        (unsigned long long)(left - 8));
    if (bytes > packed_bytes * EWA_LZF_MAX)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: byte %llu: %llu bytes cannot unpack to %llu",
                        source->name, (unsigned long long)at, (unsigned long long)packed_bytes,
                        (unsigned long long)bytes);
    EWA_TRY(ewa_memory_check(context, bytes, "%s: the points unpacked", source->name));
    EWA_TRY(place_columns(state, bytes));
    state->unpacked = ewa_allocate(context, bytes, 1);
    if (!state->unpacked) return EWA_ERROR_MEMORY;
    state->unpacked_bytes = bytes;
    if (!ewa_lzf_unpack(source->bytes + at + 8, packed_bytes, state->unpacked, bytes))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the packed points from byte %llu on are damaged",
                        source->name, (unsigned long long)at + 8);
    state->records.bytes = state->unpacked;
    state->record_count = state->header.point_count;
    return EWA_OK;
}

/// What the points of a wave are divided into.
typedef struct wave {
    const pcd_state *state;
    const ewa_cloud_sink *sinks;
    uint64_t first, end, task_records;
    uint64_t kept[WAVE_TASKS];
    uint64_t to[WAVE_TASKS]; ///< where the points of a task go
} wave;

static uint64_t task_first(const wave *w, uint32_t task) {
    const uint64_t first = w->first + task * w->task_records;
    return first < w->end ? first : w->end;
}

static void count_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    wave *w = data;
    w->kept[task] = ewa_pcd_count(&w->state->records, task_first(w, task), task_first(w, task + 1));
}

/// Counts what the next wave holds; returns how many tasks it has.
static uint32_t next_wave(const pcd_state *state, uint64_t at, uint64_t maximum, wave *w) {
    const uint64_t task_records = TASK_BYTES / state->header.record_bytes;
    w->state = state;
    w->first = at;
    w->task_records = task_records ? task_records : 1;
    const uint64_t left = state->record_count - at, whole = WAVE_TASKS * w->task_records;
    uint64_t count = left < whole ? left : whole;
    if (state->invalid_count == 0 && count > maximum) count = maximum;
    w->end = at + count;
    const uint32_t tasks = (uint32_t)((count + w->task_records - 1) / w->task_records);
    if (state->invalid_count)
        ewa_parallel(state->source->context, count_task, w, tasks);
    else
        for (uint32_t i = 0; i < tasks; i++) w->kept[i] = task_first(w, i + 1) - task_first(w, i);
    return tasks;
}

static void count_invalid(pcd_state *state) {
    wave w;
    uint64_t kept = 0;
    state->invalid_count = 1; // so that all are looked at
    for (uint64_t at = 0; at < state->record_count; at = w.end) {
        const uint32_t tasks = next_wave(state, at, UINT64_MAX, &w);
        for (uint32_t i = 0; i < tasks; i++) kept += w.kept[i];
    }
    state->invalid_count = state->record_count - kept;
    state->records.all_finite = state->invalid_count == 0;
}

/// The first points show what most files mean; only where they leave it open, all are looked at.
static void look_at_colors(pcd_state *state) {
    enum { LOOKED_AT = 4096 };
    const ewa_pcd_records *records = &state->records;
    const uint64_t some = state->record_count < LOOKED_AT ? state->record_count : LOOKED_AT;
    ewa_pcd_colors colors = {0, 0};
    if (!ewa_pcd_needs_look(state->columns, records->column_count)) return;
    ewa_pcd_look(records, 0, some, &colors);
    if (!colors.alpha_bits && colors.number_bits < 256)
        ewa_pcd_look(records, some, state->record_count, &colors);
    ewa_pcd_settle(&colors, state->columns, records->column_count);
}

static ewa_status set_notes(const pcd_state *state, ewa_cloud *prototype) {
    static const char *const kinds[] = {"ascii", "binary", "binary_compressed"};
    const ewa_pcd_header *h = &state->header;
    char text[256];
    int length =
        snprintf(text, sizeof text, "PCD %.*s %s", (int)(h->version.length < 16 ? h->version.length : 16),
                 h->version.chars, kinds[h->data]);
    EWA_TRY(ewa_cloud_set_note(prototype, "file.format", text, (size_t)length));
    if (h->height > 1 && h->width > 1) {
        length = snprintf(text, sizeof text, "%llu x %llu", (unsigned long long)h->width,
                          (unsigned long long)h->height);
        EWA_TRY(ewa_cloud_set_note(prototype, "file.organised", text, (size_t)length));
    }
    if (state->invalid_count) {
        length = snprintf(text, sizeof text, "%llu of %llu points have no place and are left out",
                          (unsigned long long)state->invalid_count, (unsigned long long)h->point_count);
        EWA_TRY(ewa_cloud_set_note(prototype, "file.invalid", text, (size_t)length));
    }
    static const double identity[7] = {0, 0, 0, 1, 0, 0, 0};
    if (memcmp(h->viewpoint, identity, sizeof identity) != 0) {
        const double *v = h->viewpoint;
        length = ewa_format(text, sizeof text, "%.17g %.17g %.17g", v[0], v[1], v[2]);
        EWA_TRY(ewa_cloud_set_note(prototype, "scanners", text, (size_t)length));
    }
    return EWA_OK;
}

static ewa_status open_points(pcd_state *state) {
    const ewa_cloud_source *source = state->source;
    ewa_pcd_header *header = &state->header;
    ewa_pcd_records *records = &state->records;
    EWA_TRY(ewa_pcd_header_read(source, header));
    EWA_TRY(ewa_pcd_columns_map(source, header, state->columns, &records->column_count));
    records->columns = state->columns;
    if (header->data == EWA_PCD_ASCII)
        return ewa_pcd_text_open(source, header, state->columns, records->column_count, &state->text,
                                 &state->invalid_count);
    EWA_TRY(header->data == EWA_PCD_BINARY ? open_binary(state) : open_compressed(state));
    look_at_colors(state);
    count_invalid(state);
    return EWA_OK;
}

static void close_file(void *opened) {
    pcd_state *state = opened;
    if (!state) return;
    ewa_context *context = state->source->context;
    ewa_pcd_text_close(&state->text);
    ewa_release(context, state->unpacked, state->unpacked_bytes, 1);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_file(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                            void **opened) {
    pcd_state *state = ewa_allocate_zeroed(source->context, 1, sizeof *state);
    *opened = NULL;
    if (!state) return EWA_ERROR_MEMORY;
    state->source = source;
    ewa_status status = open_points(state);
    for (uint32_t i = 0; i < state->records.column_count && status == EWA_OK; i++)
        status = ewa_cloud_add(prototype, state->columns[i].attribute, state->columns[i].type,
                               state->columns[i].component_count, NULL);
    if (status == EWA_OK) status = set_notes(state, prototype);
    if (status != EWA_OK) {
        close_file(state);
        return status;
    }
    *point_count = state->text ? state->header.point_count : state->record_count - state->invalid_count;
    *opened = state;
    return EWA_OK;
}

// ---- reading ---------------------------------------------------------------------------------------------

static void move_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const wave *w = data;
    uint64_t moved;
    ewa_pcd_move(&w->state->records, task_first(w, task), task_first(w, task + 1), w->sinks, w->to[task],
                 w->kept[task], &moved);
}

static ewa_status read_points(void *opened, uint64_t maximum, const ewa_cloud_sink *sinks,
                              uint64_t *got_count) {
    pcd_state *state = opened;
    if (state->text) return ewa_pcd_text_read(state->text, maximum, sinks, got_count);
    uint64_t got = 0;
    ewa_status status = EWA_OK;
    wave w = {.sinks = sinks};
    while (got < maximum && state->at < state->record_count && status == EWA_OK) {
        const uint32_t tasks = next_wave(state, state->at, maximum - got, &w);
        uint32_t whole = 0;
        while (whole < tasks && w.kept[whole] <= maximum - got) {
            w.to[whole] = got;
            got += w.kept[whole++];
        }
        ewa_parallel(state->source->context, move_task, &w, whole);
        state->at = task_first(&w, whole);
        if (whole < tasks) {
            uint64_t moved;
            state->at = ewa_pcd_move(&state->records, state->at, w.end, sinks, got, maximum - got, &moved);
            got += moved;
        }
        if (!state->unpacked)
            ewa_cloud_passed(state->source,
                             state->header.data_at_bytes + state->at * state->header.record_bytes);
        status =
            ewa_progress(state->source->context, "read", (double)state->at / (double)state->record_count);
    }
    *got_count = got;
    return status;
}

const ewa_cloud_format ewa_format_pcd = {EWA_MODEL_PCD, probe, open_file, read_points, close_file};
