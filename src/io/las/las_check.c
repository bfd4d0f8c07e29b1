// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What was read of LAS and LAZ, beside what the header says of it.
#include "io/las/las_check.h"
#include "base/base.h"

#include <math.h>

enum { LEGACY_RETURNS = 5 };

void ewa_las_unpack_seen(const ewa_las_table *table, const uint8_t *records, uint64_t count, const ewa_cloud_sink *sinks,
                         ewa_las_seen *seen) {
    if (count == 0) return;
    seen->above_count += ewa_las_unpack(table, records, count, sinks);
    ewa_las_seen here = {.count = count, .low = {INT32_MAX, INT32_MAX, INT32_MAX}, .high = {INT32_MIN, INT32_MIN, INT32_MIN}};
    const ewa_las_column *returns = NULL;
    for (uint32_t i = 0; i < table->column_count; i++)
        if (table->columns[i].kind == EWA_LAS_BITS && strcmp(table->columns[i].name, "return_number") == 0)
            returns = &table->columns[i];
    const uint32_t return_at = returns ? returns->at_bytes[0] : 0, shift = returns ? returns->shift : 0,
                   mask = returns ? returns->mask : 0;
    for (uint64_t i = 0; i < count; i++) {
        const uint8_t *record = records + i * table->record_bytes; // which begin with x, y, z in every format
        for (int c = 0; c < 3; c++) {
            const int32_t number = (int32_t)ewa_bytes_u32(record + 4 * c);
            here.low[c] = number < here.low[c] ? number : here.low[c];
            here.high[c] = number > here.high[c] ? number : here.high[c];
        }
        here.by_return[record[return_at] >> shift & mask & (EWA_LAS_RETURN_KINDS - 1)]++;
    }
    ewa_las_seen_add(seen, &here);
}

void ewa_las_seen_add(ewa_las_seen *seen, const ewa_las_seen *more) {
    for (int c = 0; c < 3 && more->count; c++) {
        seen->low[c] = !seen->count || more->low[c] < seen->low[c] ? more->low[c] : seen->low[c];
        seen->high[c] = !seen->count || more->high[c] > seen->high[c] ? more->high[c] : seen->high[c];
    }
    for (int i = 0; i < EWA_LAS_RETURN_KINDS; i++) seen->by_return[i] += more->by_return[i];
    seen->count += more->count;
    seen->above_count += more->above_count;
}

static void check_bounds(const ewa_cloud_source *source, const ewa_las_header *header, const ewa_las_seen *seen) {
    static const char axes[3] = {'x', 'y', 'z'};
    bool said = false;
    for (int c = 0; c < 3; c++) said = said || header->low[c] != 0 || header->high[c] != 0;
    for (int c = 0; c < 3 && said; c++) {
        const double a = seen->low[c] * header->scale[c] + header->offset[c], b = seen->high[c] * header->scale[c] + header->offset[c];
        const double low = fmin(a, b), high = fmax(a, b);
        // Writers round bounds in many ways, some to the digits that they print.
        const double step = fabs(header->scale[c]), slack = 1.5 * step + 1e-9 * fmax(fabs(low), fabs(high));
        const bool outside = !(low >= header->low[c] - slack && high <= header->high[c] + slack);
        const bool inside = low > header->low[c] + slack || high < header->high[c] - slack;
        if (outside || inside)
            ewa_report(source->context, outside ? EWA_SEVERITY_WARNING : EWA_SEVERITY_NOTE,
                       "%s: %c of the points is from %.10g to %.10g; the header says from %.10g to %.10g", source->name, axes[c],
                       low, high, header->low[c], header->high[c]);
    }
}

static void check_returns(const ewa_cloud_source *source, const ewa_las_header *header, const ewa_las_seen *seen) {
    const bool wide = header->version_minor >= 4 && header->head_bytes >= EWA_LAS_HEAD_14_BYTES;
    const int kinds = wide ? EWA_LAS_RETURN_KINDS - 1 : LEGACY_RETURNS;
    uint64_t said[EWA_LAS_RETURN_KINDS] = {0}, all = 0;
    for (int i = 0; i < kinds; i++)
        all += said[i] = wide ? ewa_las_u64(source->bytes + 255 + 8 * i) : ewa_bytes_u32(source->bytes + 111 + 4 * i);
    for (int i = 0; i < kinds && all; i++) {
        if (said[i] == seen->by_return[i + 1]) continue;
        ewa_report(source->context, EWA_SEVERITY_NOTE, "%s: return %d has %llu points; the header says %llu", source->name, i + 1,
                   (unsigned long long)seen->by_return[i + 1], (unsigned long long)said[i]);
        return;
    }
}

void ewa_las_check(const ewa_cloud_source *source, const ewa_las_header *header, const ewa_las_seen *seen) {
    if (seen->count == 0 || seen->count != header->point_count) return;
    check_bounds(source, header, seen);
    check_returns(source, header, seen);
}
