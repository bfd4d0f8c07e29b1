// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What stands in the columns of a text, of all of its lines: how many digits before and behind the point, the
// greatest number, what is no number at all. That settles types and decimals before the first point is read.
// Only bytes that are no digits are looked at one by one; which these are is found for 64 bytes at once.
#include "io/cloud/text_plain.h"

typedef struct scan_job {
    const ewa_rows *rows;
    const ewa_text_layout *layout;
    const char *at;         // of this wave
    ewa_rows_chunk *chunks; // of this wave
    ewa_text_range *ranges; // column_count per chunk
} scan_job;

/// A line being looked at.
typedef struct line_state {
    const char *start; // of the word, or where one may start
    const char *point; // in it, or NULL
    uint32_t column;
    bool odd;       // the word is no plain number
    bool separated; // the word before ended in a blank: a separator that follows belongs to it
    bool comment;
} line_state;

/// The first characters of a word as one number, later ones less.
static inline uint64_t leading(const char *text, size_t length, const char *end) {
    uint64_t word = 0;
    if (end - text >= 8)
        memcpy(&word, text, sizeof word);
    else
        memcpy(&word, text, (size_t)(end - text));
#if __BYTE_ORDER__ != __ORDER_BIG_ENDIAN__
    word = __builtin_bswap64(word);
#endif
    return length < 8 ? word >> (64 - 8 * length) : word;
}

/// Adds the digits from `start` to `point` and those behind it to a range.
static inline void add_number(const scan_job *job, ewa_text_range *range, const char *start,
                              const char *point, const char *end, bool negative) {
    const uint32_t digits = (uint32_t)(point - start);
    const uint32_t decimals = (uint32_t)(end - point) - (end > point);
    const uint64_t greatest = digits > 0 ? leading(start, digits, job->rows->text.end) : 0;
    range->greatest = greatest > range->greatest ? greatest : range->greatest;
    range->digits = digits > range->digits ? digits : range->digits;
    range->decimals = decimals > range->decimals ? decimals : range->decimals;
    range->negative |= negative;
}

static inline void end_word(const scan_job *job, line_state *line, ewa_text_range *ranges, const char *at) {
    if (line->separated && job->layout->words && line->column > 0) { // the same cell goes on behind a blank
        line->column--;
        line->odd = true;
    }
    if (line->column < job->layout->column_count) {
        ewa_text_range *range = &ranges[line->column];
        if (line->odd) {
            range->other = true;
        } else {
            add_number(job, range, line->start, line->point ? line->point : at, at, false);
        }
    }
    line->column++;
    line->point = NULL;
    line->odd = false;
}

/// Whether a line that ends is a row. An empty cell at its end may be missing.
static inline bool end_line(const scan_job *job, line_state *line, ewa_text_range *ranges) {
    const uint32_t wanted = job->layout->column_count;
    const bool row = !line->comment && line->column + (job->layout->separator != 0) >= wanted;
    if (row && line->column < wanted) ranges[wanted - 1].other = true;
    return row;
}

static const char *chunk_start(const scan_job *job, uint32_t chunk) {
    const uint64_t left = (uint64_t)(job->rows->text.end - job->at),
                   offset = (uint64_t)chunk * EWA_ROWS_CHUNK_BYTES;
    return job->at + (offset < left ? offset : left);
}

/// Where the first line begins that begins in a chunk or behind it.
static const char *first_line(const scan_job *job, uint32_t chunk) {
    const char *at = chunk_start(job, chunk);
    if (at == job->rows->text.end || chunk == 0 || at[-1] == job->layout->line_end) return at;
    at = ewa_rows_line_end(job->rows, at);
    return at < job->rows->text.end ? at + 1 : at;
}

/// Takes a byte that is no digit. Returns how many rows end with it.
static inline uint64_t scan_mark(const scan_job *job, line_state *line, ewa_text_range *ranges, ewa_text_class class,
                                 const char *here, const char *end) {
    uint64_t row_count = 0;
    switch (class) {
    case EWA_TEXT_POINT:
        if (line->point) line->odd = true;
        line->point = here;
        break;
    case EWA_TEXT_BLANK:
        if (here > line->start) {
            end_word(job, line, ranges, here);
            line->separated = true;
        }
        line->start = here + 1;
        break;
    case EWA_TEXT_SEPARATOR:
        if (here == line->start && !line->separated) line->odd = true; // an empty cell
        if (here > line->start || !line->separated) end_word(job, line, ranges, here);
        line->separated = false;
        line->start = here + 1;
        break;
    case EWA_TEXT_LINE_END:
        if (here > line->start && !line->comment) end_word(job, line, ranges, here);
        if (line->column > 0) row_count = end_line(job, line, ranges);
        *line = (line_state){.start = here + 1};
        break;
    case EWA_TEXT_SIGN:
        if (here == line->start) {
            line->start++;
            if (line->column < job->layout->column_count && *here == '-')
                ranges[line->column].negative = true;
        } else {
            line->odd = true;
        }
        break;
    case EWA_TEXT_EXPONENT:
        if (here > line->start && !line->odd && line->column < job->layout->column_count)
            ranges[line->column].unusual = true;
        line->odd = true;
        break;
    case EWA_TEXT_OTHER:
        if (line->column == 0 && here == line->start &&
            ewa_text_is_comment((ewa_text){here, (size_t)(end - here)}))
            line->comment = true;
        if (*here == '"' && line->column < job->layout->column_count)
            ranges[line->column].unusual = true;
        line->odd = true;
        break;
    }
    return row_count;
}

static uint64_t scan_lines(const scan_job *job, const char *at, const char *end, ewa_text_range *ranges) {
    const uint8_t *classes = job->layout->classes;
    line_state line = {.start = at};
    uint64_t row_count = 0;
    char last[EWA_PLAIN_BLOCK_BYTES];
    for (; at < end; at += EWA_PLAIN_BLOCK_BYTES) {
        const char *block = at;
        if (end - at < EWA_PLAIN_BLOCK_BYTES) {
            memset(last, '0', sizeof last);
            memcpy(last, at, (size_t)(end - at));
            block = last;
        }
        for (uint64_t others = ewa_plain_find(block); others; others &= others - 1) {
            const char *here = at + __builtin_ctzll(others);
            const ewa_text_class class = (ewa_text_class)classes[(uint8_t)*here];
            if (line.comment && class != EWA_TEXT_LINE_END) continue;
            row_count += scan_mark(job, &line, ranges, class, here, end);
        }
    }
    if (end > line.start && !line.comment) end_word(job, &line, ranges, end);
    if (line.column > 0) row_count += end_line(job, &line, ranges);
    return row_count;
}

/// Adds a line of plain numbers to the ranges.
static inline void scan_plain(const scan_job *job, const ewa_plain_cell *cells, ewa_text_range *ranges) {
    for (uint32_t c = 0; c < job->layout->column_count; c++)
        add_number(job, &ranges[c], cells[c].start, cells[c].point, cells[c].end, cells[c].negative);
}

/// Looks at the lines of a chunk; returns how many are rows.
static uint64_t scan_all(const scan_job *job, const char *at, const char *end, ewa_text_range *ranges) {
    ewa_plain_cell cells[EWA_ROWS_MAX_COLUMNS];
    ewa_plain_walk walk = ewa_plain_begin(at, job->rows->text.end);
    uint64_t row_count = 0;
    while (at < end) {
        const char *next = ewa_plain_split(job->layout, &walk, at, cells);
        if (next) {
            scan_plain(job, cells, ranges);
            row_count++;
        } else {
            next = ewa_rows_line_end(job->rows, at);
            next += next < end;
            row_count += scan_lines(job, at, next, ranges);
            walk = ewa_plain_begin(next, job->rows->text.end);
        }
        at = next;
    }
    return row_count;
}

static void scan_chunk(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const scan_job *job = data;
    const char *at = first_line(job, index), *end = first_line(job, index + 1);
    ewa_text_range *ranges = job->ranges + (size_t)index * job->layout->column_count;
    memset(ranges, 0, job->layout->column_count * sizeof *ranges);
    job->chunks[index] = (ewa_rows_chunk){at, end, scan_all(job, at, end, ranges), 0};
}

static void join(ewa_text_range *all, const ewa_text_range *part) {
    if (part->greatest > all->greatest) all->greatest = part->greatest;
    if (part->digits > all->digits) all->digits = part->digits;
    if (part->decimals > all->decimals) all->decimals = part->decimals;
    all->negative |= part->negative;
    all->unusual |= part->unusual;
    all->other |= part->other;
}

ewa_status ewa_text_scan(ewa_rows *rows, const ewa_text_layout *layout, const char *at,
                         ewa_text_range *ranges, uint64_t *row_count) {
    enum { WAVE_CHUNKS = 64 };
    ewa_context *context = rows->source->context;
    ewa_rows_chunk chunks[WAVE_CHUNKS];
    const size_t range_count = (size_t)WAVE_CHUNKS * layout->column_count;
    scan_job job = {rows, layout, at, chunks, ewa_allocate(context, range_count, sizeof *ranges)};
    ewa_status status = job.ranges ? EWA_OK : EWA_ERROR_MEMORY;
    memset(ranges, 0, layout->column_count * sizeof *ranges);
    *row_count = 0;
    while (status == EWA_OK && job.at < rows->text.end) {
        const uint64_t left = (uint64_t)(rows->text.end - job.at);
        const uint64_t maximum = (left + EWA_ROWS_CHUNK_BYTES - 1) / EWA_ROWS_CHUNK_BYTES;
        const uint32_t count = maximum < WAVE_CHUNKS ? (uint32_t)maximum : WAVE_CHUNKS;
        ewa_parallel(context, scan_chunk, &job, count);
        for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
            for (uint32_t c = 0; c < layout->column_count; c++)
                join(&ranges[c], &job.ranges[(size_t)i * layout->column_count + c]);
            if (chunks[i].at == chunks[i].end) continue;
            *row_count += chunks[i].row_count;
            status = ewa_rows_add(rows, &chunks[i]);
        }
        job.at = chunks[count - 1].end;
        if (!rows->owned)
            ewa_cloud_passed(rows->source, (uint64_t)(job.at - (const char *)rows->source->bytes));
        if (status == EWA_OK)
            status = ewa_progress(
                context, "scan", (double)(job.at - rows->text.at) / (double)(rows->text.end - rows->text.at));
    }
    ewa_release(context, job.ranges, range_count, sizeof *ranges);
    return status;
}
