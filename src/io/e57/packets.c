// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The points of a scan: packets, each with a piece of the bits of every field. The pieces of a field are one
// run of bits, whatever packets they came in, so they are put together before numbers are taken out of them.
#include "io/e57/e57.h"

#include <string.h>

enum {
    SECTION_BYTES = 32,
    PACKET_HEAD_BYTES = 6,
    MAX_PACKET_BYTES = 1 << 16,
    SPARE_BYTES = 8, ///< behind a stream, so that whole words can be read
    PACKET_INDEX = 0,
    PACKET_DATA = 1,
    PACKET_EMPTY = 2,
};

/// The points that the bits of a section can hold at most; fields of no bits do not count.
static uint64_t bound(const ewa_e57_field *fields, uint32_t field_count, uint64_t bytes) {
    uint64_t maximum = UINT64_MAX;
    for (uint32_t i = 0; i < field_count; i++)
        if (fields[i].bits && bytes * 8 / fields[i].bits < maximum) maximum = bytes * 8 / fields[i].bits;
    return maximum == UINT64_MAX ? bytes : maximum;
}

ewa_status ewa_e57_streams_open(const ewa_e57_pages *pages, const ewa_e57_contents *contents, uint32_t scan,
                                bool quiet, ewa_e57_streams *streams, uint64_t *record_count) {
    const ewa_cloud_source *source = pages->source;
    const ewa_e57_scan *s = ewa_e57_scan_at(contents, scan);
    const uint64_t there = pages->page_count * pages->payload_bytes;
    uint8_t head[SECTION_BYTES];
    uint64_t begin = 0, at = 0;
    bool damaged = false;
    *record_count = 0;
    streams->pages = pages;
    streams->fields = ewa_e57_fields_of(contents, s);
    streams->field_count = s->field_count;
    streams->scan_number = scan + 1;
    streams->record = streams->record_count = streams->held_count = 0;
    streams->gap_count = 0;
    streams->at = streams->end = 0;
    for (uint32_t i = 0; i < s->field_count; i++)
        streams->streams[i] = (ewa_e57_stream){.buffer = streams->streams[i].buffer};
    if (s->record_count == 0) return EWA_OK;
    if (!ewa_e57_logical(pages, s->file_offset, &begin) ||
        !ewa_e57_copy(pages, begin, sizeof head, head, &damaged) || head[0] != 1 || damaged ||
        !ewa_e57_logical(pages, ewa_e57_read_le(head + 16, 8), &at))
        return quiet ? EWA_OK
                     : ewa_cloud_damage(source, s->record_count,
                                        "%s: scan %u: there are no points at byte %llu", source->name,
                                        scan + 1, (unsigned long long)s->file_offset);
    const uint64_t said = ewa_e57_read_le(head + 8, 8), maximum = there - begin;
    streams->at = at;
    streams->end = begin + (said < maximum ? said : maximum);
    if (streams->end < at) streams->end = at;
    const uint64_t can = bound(streams->fields, s->field_count, streams->end - at);
    streams->record_count = s->record_count < can ? s->record_count : can;
    *record_count = streams->record_count;
    if (quiet || s->record_count <= can) return EWA_OK;
    return ewa_cloud_damage(source, s->record_count - can,
                            "%s: scan %u: %llu bytes are too few for %llu points", source->name, scan + 1,
                            (unsigned long long)(streams->end - at), (unsigned long long)s->record_count);
}

static uint64_t held_bits(const ewa_e57_stream *stream) { return stream->byte_count * 8 - stream->first_bit; }

/// Records of which all fields are there.
static uint64_t whole_records(const ewa_e57_streams *s) {
    uint64_t maximum = s->record_count - s->record;
    for (uint32_t i = 0; i < s->field_count; i++)
        if (s->fields[i].bits && held_bits(&s->streams[i]) / s->fields[i].bits < maximum)
            maximum = held_bits(&s->streams[i]) / s->fields[i].bits;
    return maximum;
}

/// Steps over the records that were at hand and forgets their bytes.
static void step(ewa_e57_streams *s) {
    for (uint32_t i = 0; i < s->field_count; i++) {
        ewa_e57_stream *stream = &s->streams[i];
        stream->first_bit += s->held_count * s->fields[i].bits;
        const uint64_t done = stream->first_bit / 8;
        if (!done) continue;
        stream->byte_count -= done;
        memmove(stream->buffer.data, (const uint8_t *)stream->buffer.data + done, stream->byte_count);
        stream->first_bit %= 8;
        stream->taken_bits += done * 8;
    }
    s->record += s->held_count;
    s->held_count = 0;
    ewa_e57_gap *gaps = s->gaps.data;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->gap_count; i++)
        if (gaps[i].end > s->record) gaps[kept++] = gaps[i];
    s->gap_count = kept;
}

/// Appends a piece of a field's bits; the records that it holds bits of are lost when it is `damaged`.
static ewa_status append(ewa_e57_streams *s, uint32_t field, const uint8_t *bytes, uint64_t size_bytes,
                         bool damaged) {
    ewa_context *context = s->pages->source->context;
    ewa_e57_stream *stream = &s->streams[field];
    const uint32_t bits = s->fields[field].bits;
    if (!bits || !size_bytes) return EWA_OK;
    EWA_TRY(ewa_buffer_grow(context, &stream->buffer, stream->byte_count,
                            stream->byte_count + size_bytes + SPARE_BYTES, 1));
    const uint64_t first_bit = stream->taken_bits + stream->byte_count * 8;
    memcpy((uint8_t *)stream->buffer.data + stream->byte_count, bytes, size_bytes);
    stream->byte_count += size_bytes;
    memset((uint8_t *)stream->buffer.data + stream->byte_count, 0, SPARE_BYTES);
    if (!damaged) return EWA_OK;
    const ewa_e57_gap gap = {first_bit / bits, (first_bit + size_bytes * 8 + bits - 1) / bits};
    ewa_e57_gap *last = s->gap_count ? (ewa_e57_gap *)s->gaps.data + s->gap_count - 1 : NULL;
    if (last && gap.first <= last->end && gap.end >= last->first) { // of the same packet, as a rule
        last->first = gap.first < last->first ? gap.first : last->first;
        last->end = gap.end > last->end ? gap.end : last->end;
        return EWA_OK;
    }
    EWA_TRY(ewa_buffer_grow(context, &s->gaps, s->gap_count, s->gap_count + 1, sizeof gap));
    ((ewa_e57_gap *)s->gaps.data)[s->gap_count++] = gap;
    return EWA_OK;
}

/// Gives up the rest of a scan: nothing says where its next packet begins.
static ewa_status give_up(ewa_e57_streams *s, const char *what) {
    const ewa_cloud_source *source = s->pages->source;
    const uint64_t payload = s->pages->payload_bytes;
    const uint64_t byte = s->at / payload * s->pages->page_bytes + s->at % payload;
    const uint64_t whole = whole_records(s), lost = s->record_count - s->record - whole;
    s->end = s->at;
    s->record_count -= lost;
    return ewa_cloud_damage(source, lost, "%s: scan %u: the packet at byte %llu, page %llu, %s", source->name,
                            s->scan_number, (unsigned long long)byte, (unsigned long long)(s->at / payload),
                            what);
}

static ewa_status next_packet(ewa_e57_streams *s) {
    uint8_t *packet = s->packet.data;
    const uint64_t left = s->end - s->at, table_bytes = 2 * (uint64_t)s->field_count;
    bool damaged = false;
    if (left < 4 || !ewa_e57_copy(s->pages, s->at, 4, packet, &damaged) || damaged)
        return give_up(s, left < 4 ? "is cut off" : "is damaged");
    const uint64_t size = ewa_e57_read_le(packet + 2, 2) + 1;
    if (packet[0] > PACKET_EMPTY) return give_up(s, "is of no known kind");
    if (size > left || size < 4) return give_up(s, "is longer than the points");
    if (packet[0] != PACKET_DATA) {
        s->at += size;
        return EWA_OK;
    }
    if (size < PACKET_HEAD_BYTES + table_bytes) return give_up(s, "is too short for its fields");
    bool head_damaged = false;
    if (!ewa_e57_copy(s->pages, s->at, PACKET_HEAD_BYTES + table_bytes, packet, &head_damaged) ||
        head_damaged)
        return give_up(s, "is damaged");
    if (ewa_e57_read_le(packet + 4, 2) != s->field_count) return give_up(s, "has another number of fields");
    if (!ewa_e57_copy(s->pages, s->at, size, packet, &damaged)) return give_up(s, "is cut off");
    uint64_t at = PACKET_HEAD_BYTES + table_bytes;
    for (uint32_t i = 0; i < s->field_count; i++)
        at += ewa_e57_read_le(packet + PACKET_HEAD_BYTES + 2 * i, 2);
    if (at > size) return give_up(s, "is shorter than its fields");
    at = PACKET_HEAD_BYTES + table_bytes;
    for (uint32_t i = 0; i < s->field_count; i++) {
        const uint64_t bytes = ewa_e57_read_le(packet + PACKET_HEAD_BYTES + 2 * i, 2);
        EWA_TRY(append(s, i, packet + at, bytes, damaged));
        at += bytes;
    }
    s->at += size;
    return EWA_OK;
}

ewa_status ewa_e57_streams_next(ewa_e57_streams *s, uint64_t maximum) {
    ewa_context *context = s->pages->source->context;
    ewa_status status = ewa_buffer_reserve(context, &s->packet, MAX_PACKET_BYTES, 1);
    step(s);
    const uint64_t left = s->record_count - s->record, wanted = left < maximum ? left : maximum;
    while (status == EWA_OK && s->at < s->end && whole_records(s) < wanted) status = next_packet(s);
    EWA_TRY(status);
    s->held_count = whole_records(s);
    if (s->held_count > maximum) s->held_count = maximum;
    if (s->held_count || s->record == s->record_count) return EWA_OK;
    return give_up(s, "does not come: the points end before it");
}

void ewa_e57_streams_free(ewa_context *context, ewa_e57_streams *streams) {
    for (uint32_t i = 0; i < EWA_E57_MAX_FIELDS; i++) ewa_buffer_free(context, &streams->streams[i].buffer);
    ewa_buffer_free(context, &streams->packet);
    ewa_buffer_free(context, &streams->gaps);
}

/// Numbers of at most 57 bits lie in eight bytes wherever they begin.
static inline uint64_t read_bits(const uint8_t *bytes, uint64_t bit, uint32_t bits) {
    uint64_t word;
    memcpy(&word, bytes + bit / 8, sizeof word);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    word = __builtin_bswap64(word);
#endif
    const uint32_t shift = bit % 8;
    word >>= shift;
    if (bits + shift > 64) word |= (uint64_t)bytes[bit / 8 + 8] << (64 - shift);
    return bits == 64 ? word : word & ((UINT64_C(1) << bits) - 1);
}

static void read_floats(const uint8_t *bytes, bool single, uint32_t count, double *numbers) {
    for (uint32_t i = 0; i < count; i++) {
        if (single) {
            const uint32_t bits = (uint32_t)read_bits(bytes, i * 32, 32);
            float value;
            memcpy(&value, &bits, sizeof value);
            numbers[i] = (double)value;
        } else {
            const uint64_t bits = read_bits(bytes, i * 64, 64);
            memcpy(&numbers[i], &bits, sizeof bits);
        }
    }
}

void ewa_e57_numbers(const ewa_e57_streams *streams, uint32_t field, uint64_t first, uint32_t count,
                     double shift, double *numbers) {
    const ewa_e57_field *f = &streams->fields[field];
    const ewa_e57_stream *stream = &streams->streams[field];
    const uint8_t *bytes = stream->buffer.data;
    uint64_t bit = stream->first_bit + first * f->bits;
    const bool scaled = f->kind == EWA_E57_SCALED;
    if (f->kind == EWA_E57_FLOAT) // of whole bytes, from the first on
        read_floats(bytes + bit / 8, f->single, count, numbers);
    else
        for (uint32_t i = 0; i < count; i++, bit += f->bits) {
            const uint64_t raw = f->bits ? read_bits(bytes, bit, f->bits) : 0;
            numbers[i] = (double)(int64_t)((uint64_t)f->minimum + raw);
        }
    const double scale = scaled ? f->scale : 1, offset = scaled ? f->offset + shift : shift;
    if (scale != 1 || offset != 0)
        for (uint32_t i = 0; i < count; i++) numbers[i] = numbers[i] * scale + offset;
}
