// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The points of ascii PCD files, one per line. Pieces of the text are read in parallel into records like
// those of binary files; each takes the lines that begin in it. Blanks, tabs and commas part numbers.
#include "base/base.h"
#include "io/cloud/pcd.h"
#include "io/number.h"

#include <math.h>
#include <stdio.h>

enum {
    CHUNK_BYTES = 1 << 16, ///< text per parallel task
    WAVE_TASKS = 1 << 4,
    LOOKED_AT_LINES = 1000, ///< for digits that floats would lose
};

/// Why a line could not be read.
typedef enum fault { FAULT_NONE, FAULT_END, FAULT_NUMBER, FAULT_RANGE, FAULT_MORE } fault;

/// A piece of the text that has been read.
typedef struct chunk {
    uint8_t *bytes;      ///< of the records
    uint64_t kept;       ///< records, whose position is finite
    uint64_t points;     ///< lines with a point, also a damaged one
    uint64_t lines;      ///< all of them
    uint64_t bad_points; ///< damaged; of the first:
    uint64_t bad_line;   ///< counted from the first of the piece
    fault why;
    ewa_text word;
    const ewa_pcd_field *field;
} chunk;

struct ewa_pcd_text {
    const ewa_cloud_source *source;
    const ewa_pcd_header *header;
    ewa_pcd_records records; ///< without bytes
    const char *at, *end;    ///< of the text that has not been read
    uint64_t line;           ///< number of its first line
    uint64_t points_left;
    uint8_t *memory; ///< of all records
    size_t memory_bytes;
    chunk chunks[WAVE_TASKS];
    uint32_t chunk_count;
    uint32_t next_chunk;  ///< whose records are handed over next
    uint64_t next_record; ///< of these
};

static bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r'; }

static const char *skip_separators(const char *at, const char *end) {
    while (at < end && is_separator(*at)) at++;
    return at;
}

/// A number that a type cannot hold is told by `*why`.
#define STORE(type)                                                                                          \
    {                                                                                                        \
        const type narrow = (type)value;                                                                     \
        if (narrow != value) *why = FAULT_RANGE;                                                             \
        memcpy(to, &narrow, sizeof narrow);                                                                  \
        return after;                                                                                        \
    }

static const char *read_integer(const char *at, const char *end, const ewa_pcd_field *field, uint8_t *to,
                                fault *why) {
    int64_t value;
    const char *after = ewa_number_read_i64(at, end, &value);
    if (!after || (after < end && (*after == '.' || (*after | 32) == 'e'))) {
        double number;
        after = ewa_number_read_f64(at, end, &number);
        if (!after) return NULL;
        if (!(fabs(number) <= 0x1p53) || number != floor(number)) {
            *why = FAULT_RANGE;
            return after;
        }
        value = (int64_t)number;
    }
    const bool is_signed = field->kind == 'I';
    if (field->size_bytes == 1 && is_signed) STORE(int8_t)
    if (field->size_bytes == 1) STORE(uint8_t)
    if (field->size_bytes == 2 && is_signed) STORE(int16_t)
    if (field->size_bytes == 2) STORE(uint16_t)
    if (is_signed) STORE(int32_t)
    STORE(uint32_t)
}

static inline const char *read_number(const char *at, const char *end, const ewa_pcd_field *field,
                                      uint8_t *to, fault *why) {
    const char *after;
    if (field->kind != 'F') return read_integer(at, end, field, to, why);
    if (field->size_bytes == 4) {
        float value;
        after = ewa_number_read_f32(at, end, &value);
        if (after) memcpy(to, &value, sizeof value);
    } else {
        double value;
        after = ewa_number_read_f64(at, end, &value);
        if (after) memcpy(to, &value, sizeof value);
    }
    return after;
}

static const char *word_end(const char *at, const char *end) {
    while (at < end && !is_separator(*at) && *at != '\n') at++;
    return at;
}

/// Reads one line into a record; returns where it got to. What is wrong is put into `c`.
static const char *read_line(const ewa_pcd_header *header, const char *at, const char *end, uint8_t *record,
                             chunk *c, fault *why) {
    for (uint32_t i = 0; i < header->field_count; i++) {
        const ewa_pcd_field *field = &header->fields[i];
        uint8_t *to = record + field->base_bytes;
        for (uint32_t e = 0; e < field->count; e++, to += field->size_bytes) {
            at = skip_separators(at, end);
            if (at == end || *at == '\n') {
                *why = FAULT_END;
                c->field = field;
                return at;
            }
            const char *after = field->padding ? word_end(at, end) : read_number(at, end, field, to, why);
            if (!after || (after < end && !is_separator(*after) && *after != '\n')) *why = FAULT_NUMBER;
            if (*why != FAULT_NONE) {
                c->field = field;
                c->word = (ewa_text){at, (size_t)(word_end(at, end) - at)};
                return at;
            }
            at = after;
        }
    }
    at = skip_separators(at, end);
    if (at < end && *at != '\n') {
        *why = FAULT_MORE;
        c->word = (ewa_text){at, (size_t)(word_end(at, end) - at)};
    }
    return at;
}

static const char *line_end(const char *at, const char *end) {
    const char *found = memchr(at, '\n', (size_t)(end - at));
    return found ? found : end;
}

/// Reads the lines that begin from `at` up to before `stop`, at most `max_points`.
static void read_chunk(const ewa_pcd_text *text, const char *at, const char *stop, uint64_t max_points,
                       chunk *c) {
    *c = (chunk){.bytes = c->bytes};
    ewa_pcd_records records = text->records;
    while (at < stop && c->points < max_points) {
        const char *start = skip_separators(at, text->end);
        c->lines++;
        if (start < text->end && *start != '\n' && *start != '#') {
            fault why = FAULT_NONE;
            chunk found = {.bytes = NULL};
            uint8_t *record = c->bytes + c->kept * text->header->record_bytes;
            at = read_line(text->header, start, text->end, record, &found, &why);
            c->points++;
            if (why == FAULT_NONE) {
                records.bytes = record;
                c->kept += ewa_pcd_count(&records, 0, 1);
            } else if (c->bad_points++ == 0) {
                c->bad_line = c->lines - 1;
                c->why = why;
                c->word = found.word;
                c->field = found.field;
            }
        }
        // A line that goes on behind the piece ends it: the next one looks for its own first line.
        const char *next = at < stop ? line_end(at, stop) : stop;
        at = next < stop ? next + 1 : stop;
    }
}

typedef struct wave {
    ewa_pcd_text *text;
    const ewa_cloud_sink *sinks;
    uint64_t to[WAVE_TASKS];
} wave;

static const char *chunk_limit(const ewa_pcd_text *text, uint32_t index) {
    const uint64_t left = (uint64_t)(text->end - text->at), offset = (uint64_t)index * CHUNK_BYTES;
    return text->at + (left < offset ? left : offset);
}

/// First line that begins in a piece, or its end.
static const char *chunk_begin(const ewa_pcd_text *text, uint32_t index) {
    const char *limit = chunk_limit(text, index), *next = chunk_limit(text, index + 1);
    if (limit == (const char *)text->source->bytes + text->header->data_at_bytes || limit == next)
        return limit;
    const char *before = line_end(limit - 1, next - 1);
    return before == next - 1 ? next : before + 1;
}

static void read_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    ewa_pcd_text *text = ((wave *)data)->text;
    read_chunk(text, chunk_begin(text, task), chunk_limit(text, task + 1), UINT64_MAX, &text->chunks[task]);
}

static ewa_status report(const ewa_pcd_text *text, const chunk *c) {
    const ewa_cloud_source *source = text->source;
    const unsigned long long line = text->line + c->bad_line, more = c->bad_points - 1;
    char quote[EWA_QUOTE_BYTES], name[EWA_QUOTE_BYTES], others[64] = "";
    ewa_quote(c->word, quote);
    if (c->field) ewa_quote(c->field->name, name);
    if (more && source->options->keep_going)
        snprintf(others, sizeof others, ", and %llu more lines of the next %llu", more,
                 (unsigned long long)(c->lines - c->bad_line - 1));
    switch (c->why) {
    case FAULT_END:
        return ewa_cloud_damage(source, c->bad_points, "%s: line %llu ends before field %s%s", source->name,
                                line, name, others);
    case FAULT_MORE:
        return ewa_cloud_damage(source, c->bad_points, "%s: line %llu: %s follows the last of %u numbers%s",
                                source->name, line, quote, text->header->value_count, others);
    case FAULT_RANGE:
        return ewa_cloud_damage(source, c->bad_points, "%s: line %llu: %s is beyond the type of field %s%s",
                                source->name, line, quote, name, others);
    default:
        return ewa_cloud_damage(source, c->bad_points, "%s: line %llu: %s is no number of field %s%s",
                                source->name, line, quote, name, others);
    }
}

/// Reads the next pieces; while `quiet`, nothing is said about damaged lines.
static ewa_status next_wave(ewa_pcd_text *text, bool quiet) {
    wave w = {.text = text};
    const uint64_t left = (uint64_t)(text->end - text->at);
    const uint64_t pieces = (left + CHUNK_BYTES - 1) / CHUNK_BYTES;
    text->chunk_count = pieces < WAVE_TASKS ? (uint32_t)pieces : WAVE_TASKS;
    text->next_chunk = 0;
    text->next_record = 0;
    ewa_parallel(text->source->context, read_task, &w, text->chunk_count);
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < text->chunk_count && status == EWA_OK; i++) {
        chunk *c = &text->chunks[i];
        if (c->points > text->points_left)
            read_chunk(text, chunk_begin(text, i), chunk_limit(text, i + 1), text->points_left, c);
        text->points_left -= c->points;
        if (c->bad_points && !quiet) status = report(text, c);
        text->line += c->lines;
    }
    text->at = chunk_limit(text, text->chunk_count);
    return status;
}

static void move_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const wave *w = data;
    ewa_pcd_records records = w->text->records; // only finite positions have been kept
    records.all_finite = true;
    const uint32_t index = w->text->next_chunk + task;
    const chunk *c = &w->text->chunks[index];
    uint64_t moved;
    records.bytes = c->bytes;
    ewa_pcd_move(&records, task ? 0 : w->text->next_record, c->kept, w->sinks, w->to[task], c->kept, &moved);
}

/// Hands over records that have been read; returns how many.
static uint64_t move(ewa_pcd_text *text, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t to) {
    wave w = {.text = text, .sinks = sinks};
    uint64_t got = 0;
    uint32_t whole = 0;
    for (uint64_t first = text->next_record; text->next_chunk + whole < text->chunk_count; first = 0) {
        const uint64_t kept = text->chunks[text->next_chunk + whole].kept - first;
        if (kept > maximum - got) break;
        w.to[whole++] = to + got;
        got += kept;
    }
    ewa_parallel(text->source->context, move_task, &w, whole);
    if (whole) text->next_record = 0;
    text->next_chunk += whole;
    if (got < maximum && text->next_chunk < text->chunk_count) {
        const chunk *c = &text->chunks[text->next_chunk];
        ewa_pcd_records records = text->records;
        uint64_t moved;
        records.bytes = c->bytes;
        records.all_finite = true;
        text->next_record =
            ewa_pcd_move(&records, text->next_record, c->kept, sinks, to + got, maximum - got, &moved);
        got += moved;
    }
    return got;
}

ewa_status ewa_pcd_text_read(ewa_pcd_text *text, uint64_t maximum, const ewa_cloud_sink *sinks,
                             uint64_t *got_count) {
    const ewa_cloud_source *source = text->source;
    ewa_status status = EWA_OK;
    uint64_t got = 0;
    while (got < maximum && status == EWA_OK) {
        if (text->next_chunk < text->chunk_count) {
            got += move(text, maximum - got, sinks, got);
        } else if (text->points_left && text->at < text->end) {
            const uint64_t begin = (uint64_t)(text->at - (const char *)source->bytes);
            ewa_cloud_passed(source, begin);
            status = next_wave(text, false);
            if (status == EWA_OK)
                status = ewa_progress(source->context, "read", (double)begin / (double)source->size_bytes);
        } else if (text->points_left) {
            const uint64_t lost = text->points_left;
            text->points_left = 0;
            status = ewa_cloud_damage(source, lost, "%s: the text ends after %llu of %llu points",
                                      source->name, (unsigned long long)(text->header->point_count - lost),
                                      (unsigned long long)text->header->point_count);
        } else {
            break;
        }
    }
    *got_count = got;
    return status;
}

// ---- before the points -----------------------------------------------------------------------------------

/// Whether a float says less than the digits of a number: whether it is farther off than half of the last, and
/// its own digits are others.
static bool loses_digits(ewa_text word) {
    const char *end = word.chars + word.length;
    double value;
    float narrow;
    if (ewa_number_read_f64(word.chars, end, &value) != end || !isfinite(value)) return false;
    ewa_number_read_f32(word.chars, end, &narrow);
    long decimals = 0;
    bool behind_point = false;
    for (const char *c = word.chars; c < end; c++) {
        if ((*c | 32) == 'e') {
            int64_t exponent = 0;
            ewa_number_read_i64(c + 1, end, &exponent);
            decimals -= (long)(exponent < -99 ? -99 : exponent > 99 ? 99 : exponent);
            break;
        }
        decimals += behind_point;
        behind_point |= *c == '.';
    }
    if (fabs(value - (double)narrow) <= 0.5000001 * pow(10, (double)-decimals)) return false;
    char text[EWA_NUMBER_BYTES];
    double own = 0;
    ewa_number_read_f64(text, text + ewa_number_write_f32(narrow, text), &own);
    return own != value;
}

/// Whether coordinates of the first lines have more digits than floats hold.
static bool needs_doubles(const ewa_pcd_text *text, const ewa_pcd_column *position) {
    const char *at = text->at;
    for (int line = 0; line < LOOKED_AT_LINES && at < text->end; line++) {
        for (uint32_t i = 0; i < text->header->field_count; i++) {
            const ewa_pcd_field *field = &text->header->fields[i];
            const bool is_coordinate = field == position->sources[0] || field == position->sources[1] ||
                                       field == position->sources[2];
            for (uint32_t e = 0; e < field->count; e++) {
                at = skip_separators(at, text->end);
                const ewa_text word = {at, (size_t)(word_end(at, text->end) - at)};
                if (is_coordinate && word.length && loses_digits(word)) return true;
                if (!word.length) break;
                at += word.length;
            }
        }
        at = line_end(at, text->end);
        at += at < text->end;
    }
    return false;
}

/// Whether any number may be a word: nan, inf.
static bool has_words(const ewa_pcd_text *text) {
    for (const char *at = text->at; at < text->end;) {
        const char *stop = text->end - at < 4096 ? text->end : at + 4096;
        int found = 0;
        for (; at < stop; at++) found |= (*at | 32) == 'n';
        if (found) return true;
    }
    return false;
}

static ewa_status allocate(ewa_pcd_text *text) {
    const uint64_t left = (uint64_t)(text->end - text->at);
    const uint64_t pieces = (left + CHUNK_BYTES - 1) / CHUNK_BYTES;
    const size_t tasks = pieces < WAVE_TASKS ? (size_t)pieces : WAVE_TASKS;
    const size_t line_bytes = 2 * (size_t)text->header->value_count; // of the shortest line
    const size_t chunk_bytes = (CHUNK_BYTES / line_bytes + 2) * text->header->record_bytes;
    text->memory = ewa_allocate(text->source->context, tasks * chunk_bytes, 1);
    if (!text->memory) return EWA_ERROR_MEMORY;
    text->memory_bytes = tasks * chunk_bytes;
    for (size_t i = 0; i < tasks; i++) text->chunks[i].bytes = text->memory + i * chunk_bytes;
    return EWA_OK;
}

static void rewind_text(ewa_pcd_text *text) {
    const ewa_pcd_header *header = text->header;
    text->at = (const char *)text->source->bytes + header->data_at_bytes;
    text->end = (const char *)text->source->bytes + text->source->size_bytes;
    text->line = header->data_line;
    text->points_left = header->point_count;
    text->chunk_count = text->next_chunk = 0;
}

/// Reads all of the text before any of it is handed over, where there is something to know before.
static ewa_status look_ahead(ewa_pcd_text *text, ewa_pcd_column *columns, uint64_t *invalid_count) {
    const uint32_t column_count = text->records.column_count;
    if (!has_words(text) && !ewa_pcd_needs_look(columns, column_count)) return EWA_OK;
    ewa_pcd_colors colors = {0, 0};
    uint64_t invalid = 0;
    while (text->points_left && text->at < text->end) {
        EWA_TRY(next_wave(text, true));
        for (uint32_t i = 0; i < text->chunk_count; i++) {
            const chunk *c = &text->chunks[i];
            ewa_pcd_records records = text->records;
            records.bytes = c->bytes;
            ewa_pcd_look(&records, 0, c->kept, &colors);
            invalid += c->points - c->kept - c->bad_points;
        }
    }
    ewa_pcd_settle(&colors, columns, column_count);
    *invalid_count = invalid;
    rewind_text(text);
    return EWA_OK;
}

ewa_status ewa_pcd_text_open(const ewa_cloud_source *source, ewa_pcd_header *header, ewa_pcd_column *columns,
                             uint32_t column_count, ewa_pcd_text **opened, uint64_t *invalid_count) {
    ewa_pcd_text *text = ewa_allocate_zeroed(source->context, 1, sizeof *text);
    if (!text) return EWA_ERROR_MEMORY;
    text->source = source;
    text->header = header;
    text->records = (ewa_pcd_records){.columns = columns, .column_count = column_count};
    rewind_text(text);
    if (needs_doubles(text, &columns[0])) {
        columns[0].type = EWA_F64;
        for (uint32_t i = 0; i < header->field_count; i++)
            for (uint32_t c = 0; c < 3; c++)
                if (columns[0].sources[c] == &header->fields[i] && header->fields[i].kind == 'F')
                    header->fields[i].size_bytes = 8;
        ewa_pcd_lay_out(header);
    }
    const uint64_t line_bytes = 2 * (uint64_t)header->value_count; // of the shortest line
    const uint64_t max_lines = (uint64_t)(text->end - text->at) / line_bytes + 1;
    ewa_status status = allocate(text);
    if (status == EWA_OK && header->point_count > max_lines) {
        status =
            ewa_cloud_damage(source, header->point_count - max_lines,
                             "%s: the text from line %llu on is too short for %llu points", source->name,
                             (unsigned long long)header->data_line, (unsigned long long)header->point_count);
        header->point_count = text->points_left = max_lines;
    }
    if (status == EWA_OK) status = look_ahead(text, columns, invalid_count);
    if (status == EWA_OK)
        *opened = text;
    else
        ewa_pcd_text_close(&text);
    return status;
}

void ewa_pcd_text_close(ewa_pcd_text **opened) {
    ewa_pcd_text *text = *opened;
    if (!text) return;
    ewa_release(text->source->context, text->memory, text->memory_bytes, 1);
    ewa_release(text->source->context, text, 1, sizeof *text);
    *opened = NULL;
}
