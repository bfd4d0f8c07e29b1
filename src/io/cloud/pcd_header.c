// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The header of PCD files: lines of a word and what belongs to it, up to DATA.
#include "base/base.h"
#include "io/cloud/pcd.h"
#include "io/reader.h"

/// A header being read.
typedef struct reading {
    const ewa_cloud_source *source;
    ewa_pcd_header *header;
    ewa_cursor cursor;
    bool has_points, has_width, done;
} reading;

static ewa_status fail_line(const reading *r, const char *what) {
    return ewa_fail(r->source->context, EWA_ERROR_FORMAT, "%s: line %llu: %s", r->source->name,
                    (unsigned long long)r->cursor.line, what);
}

static ewa_status fail_word(const reading *r, ewa_text word, const char *what) {
    char quote[EWA_QUOTE_BYTES];
    return ewa_fail(r->source->context, EWA_ERROR_FORMAT, "%s: line %llu: %s %s", r->source->name,
                    (unsigned long long)r->cursor.line, ewa_quote(word, quote), what);
}

/// Next word of the line, whatever it begins with.
static ewa_text take_word(ewa_cursor *cursor) {
    while (cursor->at < cursor->end && ewa_is_blank(*cursor->at)) cursor->at++;
    const char *start = cursor->at;
    while (cursor->at < cursor->end && !ewa_is_blank(*cursor->at) && !ewa_is_line_end(*cursor->at))
        cursor->at++;
    return (ewa_text){start, (size_t)(cursor->at - start)};
}

static ewa_status take_count(reading *r, uint64_t *count) {
    const ewa_text word = take_word(&r->cursor);
    int64_t value;
    if (!ewa_text_integer(word, &value) || value < 0) return fail_word(r, word, "is no number of points");
    *count = (uint64_t)value;
    return EWA_OK;
}

static ewa_status read_fields(reading *r) {
    ewa_pcd_header *h = r->header;
    if (h->field_count) return fail_line(r, "names fields for the second time");
    for (ewa_text word; (word = take_word(&r->cursor)).length;) {
        if (h->field_count == EWA_PCD_MAX_FIELDS)
            return ewa_fail(r->source->context, EWA_ERROR_LIMIT, "%s: more than %d fields", r->source->name,
                            EWA_PCD_MAX_FIELDS);
        h->fields[h->field_count++] = (ewa_pcd_field){
            .name = word, .kind = 'F', .size_bytes = 4, .count = 1, .padding = ewa_text_is(word, "_")};
    }
    return h->field_count ? EWA_OK : fail_line(r, "names no field");
}

/// SIZE, TYPE or COUNT: one word per field.
static ewa_status read_column(reading *r, char what) {
    ewa_pcd_header *h = r->header;
    for (uint32_t i = 0; i < h->field_count; i++) {
        ewa_pcd_field *field = &h->fields[i];
        const ewa_text word = take_word(&r->cursor);
        int64_t value = 0;
        if (what == 'T') {
            if (word.length != 1 || !memchr("FIU", word.chars[0], 3))
                return fail_word(r, word, "is no type; types are F, I, U");
            field->kind = word.chars[0];
        } else if (!ewa_text_integer(word, &value) || value < 1 || value > EWA_PCD_MAX_RECORD_BYTES) {
            return fail_word(r, word, what == 'S' ? "is no size of a number" : "is no count of numbers");
        } else if (what == 'S') {
            field->size_bytes = (uint32_t)value;
        } else {
            field->count = (uint32_t)value;
        }
    }
    const ewa_text more = take_word(&r->cursor);
    return more.length ? fail_word(r, more, "is one word more than there are fields") : EWA_OK;
}

static ewa_status read_viewpoint(reading *r) {
    double values[7];
    for (int i = 0; i < 7; i++) {
        const ewa_text word = take_word(&r->cursor);
        if (!ewa_text_number(word, &values[i]))
            return fail_word(r, word, "is no number of a VIEWPOINT, which has seven");
    }
    memcpy(r->header->viewpoint, values, sizeof values);
    return EWA_OK;
}

static ewa_status read_data(reading *r) {
    static const char *const words[] = {"ascii", "binary", "binary_compressed"};
    const ewa_text word = take_word(&r->cursor);
    for (int i = 0; i < 3; i++)
        if (ewa_text_is_any_case(word, words[i])) {
            r->header->data = (ewa_pcd_data)i;
            r->done = true;
            return EWA_OK;
        }
    return fail_word(r, word, "is no kind of DATA: ascii, binary, binary_compressed");
}

static ewa_status read_line(reading *r) {
    const ewa_text word = take_word(&r->cursor);
    if (word.length == 0 || word.chars[0] == '#') return EWA_OK;
    if (ewa_text_is(word, "VERSION")) {
        r->header->version = take_word(&r->cursor);
        return EWA_OK;
    }
    if (ewa_text_is(word, "FIELDS") || ewa_text_is(word, "COLUMNS")) return read_fields(r);
    if (ewa_text_is(word, "SIZE") || ewa_text_is(word, "TYPE") || ewa_text_is(word, "COUNT"))
        return read_column(r, word.chars[0]);
    if (ewa_text_is(word, "WIDTH")) {
        r->has_width = true;
        return take_count(r, &r->header->width);
    }
    if (ewa_text_is(word, "HEIGHT")) return take_count(r, &r->header->height);
    if (ewa_text_is(word, "POINTS")) {
        r->has_points = true;
        return take_count(r, &r->header->point_count);
    }
    if (ewa_text_is(word, "VIEWPOINT")) return read_viewpoint(r);
    if (ewa_text_is(word, "DATA")) return read_data(r);
    return fail_word(r, word, "is no word of a PCD header");
}

static ewa_status check_fields(const ewa_cloud_source *source, const ewa_pcd_header *h) {
    uint64_t record_bytes = 0;
    for (uint32_t i = 0; i < h->field_count; i++) {
        const ewa_pcd_field *f = &h->fields[i];
        const uint32_t size = f->size_bytes;
        const bool known =
            f->padding || size == 4 || size == 8 || (f->kind != 'F' && (size == 1 || size == 2));
        char quote[EWA_QUOTE_BYTES];
        if (!known)
            return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: field %s is of type %c with %u bytes",
                            source->name, ewa_quote(f->name, quote), f->kind, size);
        record_bytes += (uint64_t)size * f->count;
    }
    if (record_bytes > EWA_PCD_MAX_RECORD_BYTES)
        return ewa_fail(source->context, EWA_ERROR_LIMIT, "%s: points of %llu bytes; more than %d",
                        source->name, (unsigned long long)record_bytes, EWA_PCD_MAX_RECORD_BYTES);
    return EWA_OK;
}

/// How many points there are by POINTS, WIDTH and HEIGHT, of which old files have only some.
static ewa_status settle_count(const reading *r) {
    ewa_pcd_header *h = r->header;
    uint64_t product;
    const bool overflow = __builtin_mul_overflow(h->width, h->height, &product);
    if (!r->has_points && !r->has_width)
        return ewa_fail(r->source->context, EWA_ERROR_FORMAT, "%s: neither POINTS nor WIDTH is given",
                        r->source->name);
    if (!r->has_width) {
        h->width = h->point_count;
        h->height = 1;
    } else if (overflow || (r->has_points && product != h->point_count)) {
        return ewa_fail(r->source->context, EWA_ERROR_FORMAT,
                        "%s: WIDTH %llu and HEIGHT %llu do not make %llu POINTS", r->source->name,
                        (unsigned long long)h->width, (unsigned long long)h->height,
                        (unsigned long long)h->point_count);
    } else {
        h->point_count = product;
    }
    return EWA_OK;
}

void ewa_pcd_lay_out(ewa_pcd_header *header) {
    header->record_bytes = header->value_count = 0;
    for (uint32_t i = 0; i < header->field_count; i++) {
        ewa_pcd_field *field = &header->fields[i];
        field->base_bytes = header->record_bytes;
        header->record_bytes += field->size_bytes * field->count;
        header->value_count += field->count;
    }
    for (uint32_t i = 0; i < header->field_count; i++) header->fields[i].stride_bytes = header->record_bytes;
}

ewa_status ewa_pcd_header_read(const ewa_cloud_source *source, ewa_pcd_header *header) {
    const char *start = (const char *)source->bytes;
    reading r = {source, header, {start + ewa_bytes_mark(start, source->size_bytes), start + source->size_bytes, 1}, false, false, false};
    *header = (ewa_pcd_header){.height = 1, .viewpoint = {0, 0, 0, 1, 0, 0, 0}};
    while (!r.done) {
        if (r.cursor.at == r.cursor.end)
            return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the PCD header has no line DATA",
                            source->name);
        EWA_TRY(read_line(&r));
        while (r.cursor.at < r.cursor.end && !ewa_is_line_end(*r.cursor.at)) r.cursor.at++;
        ewa_cursor_step_line(&r.cursor);
    }
    if (header->field_count == 0)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the PCD header has no line FIELDS",
                        source->name);
    ewa_status status = check_fields(source, header);
    for (uint32_t i = 0; i < header->field_count && header->data == EWA_PCD_ASCII; i++)
        if (header->fields[i].size_bytes == 8) header->fields[i].kind = 'F'; // as which text is read
    if (status == EWA_OK) status = settle_count(&r);
    header->data_at_bytes = (uint64_t)(r.cursor.at - start);
    header->data_line = r.cursor.line;
    ewa_pcd_lay_out(header);
    return status;
}
