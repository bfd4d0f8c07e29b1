// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Records of ascii PLY files. By convention each stands on a line of its own: then lines are counted and
// decoded in parallel. When any line differs (blank, broken in two, too long) the numbers are read one after
// the other instead, whatever the lines; that path also finds the place and the words for every error.
#include "base/base.h"
#include "io/cloud/ply.h"
#include "io/number.h"

#include <string.h>

enum {
    CHUNK_BYTES = 1 << 16, // text per parallel task
    WAVE_CHUNKS = 1 << 6,  // chunks between two reports of progress
    NO_STOP = 256,         // no byte: numbers may stand on any line
};

/// Why a record could not be read.
typedef enum fault {
    FAULT_NONE,
    FAULT_END,    // the text ends
    FAULT_NUMBER, // no number
    FAULT_RANGE,  // a number that its type cannot hold
    FAULT_LENGTH, // no natural number as length of a list
    FAULT_ROOM,   // no room for a list
} fault;

/// A record being read: what it consists of and where the text ends.
typedef struct grammar {
    const ewa_ply_property *properties;
    uint32_t property_count;
    const char *end;
    int stop;                     // byte that ends the record's text, or NO_STOP
    const ewa_ply_source *source; // of lists that are kept:
    ewa_ply_list *lists;          // or NULL
    uint64_t record;
    ewa_status status; // why a list could not be kept
} grammar;

static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

static inline const char *skip_space(const char *text, const char *end, int stop) {
    while (text < end && is_space(*text) && *text != stop) text++;
    return text;
}

static const char *skip_word(const char *text, const char *end) {
    while (text < end && !is_space(*text)) text++;
    return text;
}

/// Reads an integer, also one written like 3.0 or 1e3.
static const char *read_integer(const char *text, const char *end, int64_t *value) {
    const char *after = ewa_number_read_i64(text, end, value);
    if (after && (after == end || is_space(*after))) return after;
    double number;
    after = ewa_number_read_f64(text, end, &number);
    if (!after || !(number >= -0x1p53 && number <= 0x1p53) || number != (double)(int64_t)number) return NULL;
    *value = (int64_t)number;
    return after;
}

#define STORE(type)                                                                                          \
    {                                                                                                        \
        const type narrow = (type)value;                                                                     \
        if (narrow != value) *why = FAULT_RANGE;                                                             \
        memcpy(to, &narrow, sizeof narrow);                                                                  \
        break;                                                                                               \
    }

/// Reads one number of a type into `to`; returns what follows or NULL. A number out of range sets `*why`.
static inline const char *read_number(const char *text, const char *end, ewa_type type, uint8_t *to,
                                      fault *why) {
    if (type == EWA_F32) {
        float value;
        text = ewa_number_read_f32(text, end, &value);
        if (text) memcpy(to, &value, sizeof value);
        return text;
    }
    if (type == EWA_F64) {
        double value;
        text = ewa_number_read_f64(text, end, &value);
        if (text) memcpy(to, &value, sizeof value);
        return text;
    }
    int64_t value;
    text = read_integer(text, end, &value);
    if (!text) return NULL;
    switch (type) {
    case EWA_I8:
        STORE(int8_t)
    case EWA_U8:
        STORE(uint8_t)
    case EWA_I16:
        STORE(int16_t)
    case EWA_U16:
        STORE(uint16_t)
    case EWA_I32:
        STORE(int32_t)
    default:
        STORE(uint32_t)
    }
    return text;
}

/// Steps over a list, or keeps its numbers when `list` is not NULL; returns what follows it.
static const char *read_list(grammar *g, ewa_type type, const char *text, ewa_ply_list *list, fault *why) {
    int64_t count;
    const char *after = read_integer(text, g->end, &count);
    if (!after || (after < g->end && !is_space(*after)) || count < 0) {
        *why = FAULT_LENGTH;
        return text;
    }
    const size_t number_bytes = ewa_type_bytes(type);
    for (; count > 0; count--) {
        text = skip_space(after, g->end, g->stop);
        if (text == g->end || *text == g->stop) {
            *why = FAULT_END;
            return text;
        }
        if (!list) {
            after = skip_word(text, g->end);
            continue;
        }
        uint8_t *to = ewa_ply_list_add(g->source, list, 1, number_bytes, &g->status);
        if (!to) {
            *why = FAULT_ROOM;
            return text;
        }
        after = read_number(text, g->end, type, to, why);
        if (*why != FAULT_NONE) return text;
        if (!after || (after < g->end && !is_space(*after))) {
            *why = FAULT_NUMBER;
            return text;
        }
    }
    if (list) list->first[g->record + 1] = list->count;
    return after;
}

/// Reads one record; its scalars go to `record`, or are only stepped over when that is NULL. Returns what
/// follows the last word, or the offending word with `*why` set.
static inline const char *read_record(grammar *g, const char *text, uint8_t *record, fault *why) {
    ewa_ply_list *list = g->lists;
    for (uint32_t i = 0; i < g->property_count; i++) {
        const ewa_ply_property *property = &g->properties[i];
        text = skip_space(text, g->end, g->stop);
        if (text == g->end || *text == g->stop) {
            *why = FAULT_END;
            return text;
        }
        const char *after;
        if (property->is_list) {
            after = read_list(g, property->type, text, list, why);
            if (list) list++;
            if (*why != FAULT_NONE) return after;
        } else if (record) {
            after = read_number(text, g->end, property->type, record + property->offset_bytes, why);
            if (*why != FAULT_NONE) return text;
            if (!after || (after < g->end && !is_space(*after))) {
                *why = FAULT_NUMBER;
                return text;
            }
        } else {
            after = skip_word(text, g->end);
        }
        text = after;
    }
    return text;
}

static uint64_t line_of(const ewa_ply_source *source, const ewa_ply_header *header, const char *place) {
    uint64_t line = header->line_count + 1;
    for (const char *c = (const char *)source->bytes + header->body_at; c < place; c++)
        line += *c == header->line_end;
    return line;
}

static ewa_status fail_record(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t index, const grammar *g,
                              const char *place, fault why) {
    char quote[EWA_QUOTE_BYTES], element_quote[EWA_QUOTE_BYTES];
    ewa_quote(element->name, element_quote);
    if (why == FAULT_END) // the last line with something on it says more than the empty one after it
        while (place > (const char *)source->bytes + header->body_at && is_space(place[-1])) place--;
    const unsigned long long line = line_of(source, header, place), record = element->before_count + index,
                             count = element->before_count + element->count + element->after_count;
    const ewa_text word = {place, (size_t)(skip_word(place, g->end) - place)};
    if (why == FAULT_END)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: line %llu: the file ends in %s %llu of %llu",
                        source->name, line, element_quote, record, count);
    return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: line %llu: %s %llu of %llu: %s %s", source->name,
                    line, element_quote, record, count, ewa_quote(word, quote),
                    why == FAULT_RANGE    ? "does not fit the type of its property"
                    : why == FAULT_LENGTH ? "is no length of a list"
                                          : "is no number of the type of its property");
}

static grammar grammar_of(const ewa_ply_source *source, const ewa_ply_header *header,
                          const ewa_ply_element *element, int stop) {
    return (grammar){.properties = &header->properties[element->first_property],
                     .property_count = element->property_count,
                     .end = (const char *)source->bytes + source->size_bytes,
                     .stop = stop,
                     .source = source};
}

/// Steps over the rest of a line if nothing stands there.
static const char *finish_line(const ewa_ply_header *header, const char *text, const char *end, bool *blank) {
    const char *rest = skip_space(text, end, header->line_end);
    *blank = rest == end || *rest == header->line_end;
    if (!*blank) return text;
    return rest == end ? rest : rest + 1;
}

ewa_status ewa_ply_ascii_skip(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t *at) {
    if (element->count == 0 || element->property_count == 0) return EWA_OK;
    grammar g = grammar_of(source, header, element, NO_STOP);
    const char *text = (const char *)source->bytes + *at;
    fault why = FAULT_NONE;
    for (uint64_t i = 0; i < element->count; i++) {
        text = read_record(&g, text, NULL, &why);
        if (why != FAULT_NONE) return fail_record(source, header, element, i, &g, text, why);
    }
    bool blank;
    text = finish_line(header, text, g.end, &blank);
    *at = (uint64_t)(text - (const char *)source->bytes);
    return EWA_OK;
}

// ---- one record per line ---------------------------------------------------------------------------------

typedef struct line_job {
    const ewa_ply_element *element;
    const ewa_ply_sink *sink;
    grammar grammar;
    const char *start;               // of the first record
    const char *first;               // text of this wave
    uint64_t lines[WAVE_CHUNKS + 1]; // first the count of lines that end in a chunk, then of all before it
    const char *after;               // where the last record ends, set by the task that reads it
    bool regular[WAVE_CHUNKS];
} line_job;

static const char *chunk_start(const line_job *job, uint32_t chunk) {
    const uint64_t left = (uint64_t)(job->grammar.end - job->first), offset = (uint64_t)chunk * CHUNK_BYTES;
    return job->first + (offset < left ? offset : left);
}

static void count_lines(void *data, uint32_t chunk, uint32_t worker) {
    (void)worker;
    line_job *job = data;
    const uint64_t ones = 0x0101010101010101u, pattern = ones * (uint8_t)job->grammar.stop;
    const char *text = chunk_start(job, chunk), *end = chunk_start(job, chunk + 1);
    uint64_t count = 0;
    for (; end - text >= 8; text += 8) {
        uint64_t word;
        memcpy(&word, text, sizeof word);
        word ^= pattern; // the bytes that are looked for become zero
        const uint64_t others = ((word & 0x7f * ones) + 0x7f * ones) | word;
        count += (~others >> 7 & ones) * ones >> 56;
    }
    for (; text < end; text++) count += *text == job->grammar.stop;
    job->lines[chunk] = count;
}

/// Decodes the records whose lines begin in a chunk.
static void read_lines(void *data, uint32_t chunk, uint32_t worker) {
    (void)worker;
    line_job *job = data;
    grammar own = job->grammar, *g = &own;
    const uint32_t record_bytes = job->element->record_bytes;
    const uint64_t block = ewa_ply_block_records(record_bytes);
    uint64_t index = job->lines[chunk];
    const char *text = chunk_start(job, chunk), *end = chunk_start(job, chunk + 1);
    if (text != job->start && text[-1] != g->stop) {
        text = memchr(text, g->stop, (size_t)(end - text));
        if (!text) return; // one line covers the chunk; the chunk where it begins reads it
        text++;
        index++;
    }
    uint8_t records[EWA_PLY_BLOCK_BYTES];
    uint64_t held = 0;
    fault why = FAULT_NONE;
    for (; text < end && index + held < job->element->count; held++) {
        if (held == block) {
            ewa_ply_sink_put(job->sink, index, records, record_bytes, held);
            index += held;
            held = 0;
        }
        text = skip_space(read_record(g, text, records + held * record_bytes, &why), g->end, g->stop);
        if (why != FAULT_NONE || (text < g->end && *text != g->stop)) {
            job->regular[chunk] = false;
            return;
        }
        text += text < g->end;
        if (index + held + 1 == job->element->count) job->after = text;
    }
    ewa_ply_sink_put(job->sink, index, records, record_bytes, held);
}

/// Reads records that stand one per line. `*regular` says whether all do; if not, some points may hold
/// numbers.
static ewa_status read_by_line(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at,
                               bool *regular) {
    line_job job = {.element = element,
                    .sink = sink,
                    .grammar = grammar_of(source, header, element, header->line_end),
                    .start = (const char *)source->bytes + *at,
                    .first = (const char *)source->bytes + *at};
    uint64_t lines_before = 0;
    *regular = false;
    while (!job.after && job.first < job.grammar.end) {
        const uint64_t left = (uint64_t)(job.grammar.end - job.first);
        const uint64_t chunks = (left + CHUNK_BYTES - 1) / CHUNK_BYTES;
        const uint32_t count = chunks < WAVE_CHUNKS ? (uint32_t)chunks : WAVE_CHUNKS;
        ewa_parallel(source->context, count_lines, &job, count);
        for (uint32_t chunk = 0; chunk < count; chunk++) {
            const uint64_t lines = job.lines[chunk];
            job.lines[chunk] = lines_before;
            lines_before += lines;
            job.regular[chunk] = true;
        }
        ewa_parallel(source->context, read_lines, &job, count);
        for (uint32_t chunk = 0; chunk < count; chunk++)
            if (!job.regular[chunk]) return EWA_OK;
        job.first = chunk_start(&job, count);
        const double done = (double)(job.first - (const char *)source->bytes) / (double)source->size_bytes;
        EWA_TRY(ewa_progress(source->context, "read", done));
    }
    if (job.after) *at = (uint64_t)(job.after - (const char *)source->bytes);
    *regular = job.after != NULL;
    return EWA_OK;
}

// ---- number by number ------------------------------------------------------------------------------------

/// Reads records as a stream of numbers. Warns once when lines and records differ by more than blank lines.
static ewa_status read_by_number(const ewa_ply_source *source, const ewa_ply_header *header,
                                 const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at) {
    grammar g = grammar_of(source, header, element, NO_STOP);
    g.lists = sink->lists;
    const uint64_t block = ewa_ply_block_records(element->record_bytes);
    uint8_t records[EWA_PLY_BLOCK_BYTES];
    const char *text = (const char *)source->bytes + *at;
    bool warned = false;
    for (uint64_t first = 0; first < element->count;) {
        const uint64_t count = element->count - first < block ? element->count - first : block;
        for (uint64_t i = 0; i < count; i++) {
            fault why = FAULT_NONE;
            const char *start = skip_space(text, g.end, NO_STOP);
            g.record = first + i;
            text = read_record(&g, start, records + i * element->record_bytes, &why);
            if (why == FAULT_ROOM) return g.status;
            if (why != FAULT_NONE) return fail_record(source, header, element, first + i, &g, text, why);
            bool line_ends;
            const char *next = finish_line(header, text, g.end, &line_ends);
            if (!warned && (!line_ends || memchr(start, header->line_end, (size_t)(text - start)))) {
                ewa_report(source->context, EWA_SEVERITY_WARNING,
                           "%s: line %llu does not hold one record of %u values; read number by number",
                           source->name, (unsigned long long)line_of(source, header, start),
                           element->property_count);
                warned = true;
            }
            text = next;
        }
        ewa_ply_sink_put(sink, first, records, element->record_bytes, count);
        first += count;
    }
    const char *rest = skip_space(text, g.end, NO_STOP);
    const ewa_ply_element *last = &header->elements[header->element_count - 1];
    const bool is_last = element->name.chars == last->name.chars && element->after_count == 0;
    if (warned && is_last && rest < g.end) {
        char quote[EWA_QUOTE_BYTES];
        const ewa_text word = {rest, (size_t)(skip_word(rest, g.end) - rest)};
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: line %llu: %s follows the last of %llu records", source->name,
                        (unsigned long long)line_of(source, header, rest), ewa_quote(word, quote),
                        (unsigned long long)(element->before_count + element->count));
    }
    *at = (uint64_t)(text - (const char *)source->bytes);
    return ewa_progress(source->context, "read", 1);
}

ewa_status ewa_ply_ascii_read(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at) {
    if (element->count == 0 || element->property_count == 0) return EWA_OK;
    bool regular = false; // lists are kept in the order of the file
    const ewa_status status =
        sink->lists ? EWA_OK : read_by_line(source, header, element, sink, at, &regular);
    return status != EWA_OK || regular ? status : read_by_number(source, header, element, sink, at);
}
