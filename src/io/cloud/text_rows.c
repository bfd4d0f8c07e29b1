// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lines of text to points, by waves of chunks.
#include "io/cloud/text_rows.h"

#include <stdio.h>

enum { WAVE_CHUNKS = 64 };

char ewa_rows_end_of_lines(ewa_cursor text) {
    while (text.at < text.end && !ewa_is_line_end(*text.at)) text.at++;
    return text.at < text.end && *text.at == '\r' && (text.at + 1 == text.end || text.at[1] != '\n') ? '\r'
                                                                                                     : '\n';
}

ewa_status ewa_rows_open(ewa_rows *rows, const ewa_cloud_source *source) {
    *rows = (ewa_rows){.source = source};
    EWA_TRY(ewa_text_open(source->context, source->name, source->bytes, source->size_bytes, &rows->text,
                          &rows->owned, &rows->owned_bytes));
    rows->line_end = ewa_rows_end_of_lines(rows->text);
    rows->counted_to = rows->text.at;
    return EWA_OK;
}

void ewa_rows_close(ewa_rows *rows) {
    ewa_context *context = rows->source->context;
    ewa_buffer_free(context, &rows->chunks);
    ewa_release(context, rows->owned, rows->owned_bytes, 1);
    rows->owned = NULL;
}

ewa_status ewa_rows_add(ewa_rows *rows, const ewa_rows_chunk *chunk) {
    EWA_TRY(ewa_buffer_grow(rows->source->context, &rows->chunks, rows->chunk_count, rows->chunk_count + 1,
                            sizeof *chunk));
    ((ewa_rows_chunk *)rows->chunks.data)[rows->chunk_count++] = *chunk;
    return EWA_OK;
}

uint64_t ewa_rows_line(ewa_rows *rows, const char *place) {
    while (rows->counted_to < place) {
        const char *found = memchr(rows->counted_to, rows->line_end, (size_t)(place - rows->counted_to));
        if (!found) break;
        rows->counted_to = found + 1;
        rows->counted_lines++;
    }
    return rows->counted_lines + 1;
}

typedef struct wave_job {
    const ewa_rows *rows;
    const ewa_rows_chunk *chunks;
    const ewa_cloud_sink *sinks;
    uint64_t room;               // points that there is room for
    uint64_t first[WAVE_CHUNKS]; // point of each chunk
    ewa_rows_result results[WAVE_CHUNKS];
} wave_job;

static void read_one(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    wave_job *job = data;
    const ewa_rows_chunk *chunk = &job->chunks[index];
    const uint64_t maximum = chunk->row_count < job->room ? chunk->row_count : job->room;
    job->results[index] = (ewa_rows_result){0};
    job->rows->read_chunk(job->rows->format, chunk, maximum, job->sinks, job->first[index],
                          &job->results[index]);
}

/// Moves points that were read to where they belong.
static void close_up(const ewa_rows *rows, const ewa_cloud_sink *sinks, uint64_t to, uint64_t from,
                     uint64_t count) {
    for (uint32_t a = 0; a < rows->attribute_count; a++) {
        const size_t stride = sinks[a].stride_bytes, bytes = rows->attribute_bytes[a];
        if (!sinks[a].to) continue;
        if (stride == bytes) {
            memmove(sinks[a].to + to * stride, sinks[a].to + from * stride, count * bytes);
            continue;
        }
        for (uint64_t i = 0; i < count; i++)
            memmove(sinks[a].to + (to + i) * stride, sinks[a].to + (from + i) * stride, bytes);
    }
}

/// Says what is wrong with the first damaged line of a wave, and how many there are.
static ewa_status report(ewa_rows *rows, const ewa_rows_result *first, uint64_t bad_count) {
    const ewa_cloud_source *source = rows->source;
    const char *at = first->bad_at, *end = at;
    while (end < rows->text.end && !ewa_is_blank(*end) && !ewa_is_line_end(*end) && *end != ',' &&
           *end != ';')
        end++;
    char quote[EWA_QUOTE_BYTES], more[64] = "";
    ewa_quote((ewa_text){at, (size_t)(end - at)}, quote);
    if (source->options->keep_going && bad_count > 1)
        snprintf(more, sizeof more, "; %llu lines near it are damaged", (unsigned long long)bad_count);
    const unsigned long long line = ewa_rows_line(rows, at);
    static const char *const texts[] = {"is no number", "does not fit the numbers of its column",
                                        "the line ends too early", "stands behind the last column"};
    if (first->fault == EWA_ROWS_SHORT)
        return ewa_cloud_damage(source, bad_count, "%s: line %llu: %s, before column %u%s", source->name,
                                line, texts[first->fault], first->bad_column, more);
    return ewa_cloud_damage(source, bad_count, "%s: line %llu, column %u: %s %s%s", source->name, line,
                            first->bad_column, quote, texts[first->fault], more);
}

/// Reads a wave of whole chunks, or as many points of one as there is room for.
static ewa_status read_wave(ewa_rows *rows, uint32_t count, uint64_t room, const ewa_cloud_sink *sinks,
                            uint64_t *got_count) {
    ewa_rows_chunk *chunks = (ewa_rows_chunk *)rows->chunks.data + rows->next_chunk;
    wave_job job = {.rows = rows, .chunks = chunks, .sinks = sinks, .room = room};
    uint64_t first = *got_count;
    for (uint32_t i = 0; i < count; i++) {
        job.first[i] = first;
        first += chunks[i].row_count;
    }
    ewa_parallel(rows->source->context, read_one, &job, count);
    uint64_t bad_count = 0;
    const ewa_rows_result *bad = NULL;
    for (uint32_t i = 0; i < count; i++) {
        const ewa_rows_result *result = &job.results[i];
        if (*got_count != job.first[i]) close_up(rows, sinks, *got_count, job.first[i], result->point_count);
        *got_count += result->point_count;
        rows->nowhere_count += result->nowhere_count;
        bad_count += result->bad_count;
        if (result->bad_count && !bad) bad = result;
        chunks[i].row_count -= result->point_count;
        chunks[i].at = result->after;
        if (result->after == chunks[i].end || chunks[i].row_count == 0) rows->next_chunk++;
    }
    return bad ? report(rows, bad, bad_count) : EWA_OK;
}

ewa_status ewa_rows_read(ewa_rows *rows, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    const ewa_cloud_source *source = rows->source;
    *got_count = 0;
    while (rows->next_chunk < rows->chunk_count && *got_count < maximum) {
        const ewa_rows_chunk *chunks = (const ewa_rows_chunk *)rows->chunks.data + rows->next_chunk;
        const uint64_t left = rows->chunk_count - rows->next_chunk, room = maximum - *got_count;
        uint64_t total = 0;
        uint32_t count = 0;
        while (count < WAVE_CHUNKS && count < left && chunks[count].row_count <= room - total)
            total += chunks[count++].row_count;
        if (count == 0 && *got_count > 0) break; // the next call has room for the whole chunk, or cuts it
        EWA_TRY(read_wave(rows, count ? count : 1, room, sinks, got_count));
        const char *at = rows->next_chunk < rows->chunk_count
                             ? ((const ewa_rows_chunk *)rows->chunks.data)[rows->next_chunk].at
                             : rows->text.end;
        if (!rows->owned) ewa_cloud_passed(source, (uint64_t)(at - (const char *)source->bytes));
        EWA_TRY(ewa_progress(source->context, "read",
                             (double)(at - rows->text.at) / (double)(rows->text.end - rows->text.at)));
    }
    if (*got_count == 0 && rows->nowhere_count > 0) {
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: %llu points without a place are left out",
                   source->name, (unsigned long long)rows->nowhere_count);
        rows->nowhere_count = 0;
    }
    return EWA_OK;
}
