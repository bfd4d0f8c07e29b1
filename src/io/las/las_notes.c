// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a LAS file says about itself, as notes of the cloud: facts for people, and the records that a LAS file
// made from the cloud gets again.
#include "base/base.h"
#include "io/las/copc.h"

#include <stdio.h>
#include <string.h>

/// Records that a writer makes anew, or that mean nothing without what they describe.
static bool is_kept(const ewa_las_vlr *vlr) {
    enum { LASZIP = 22204, EXTRA_BYTES = 4, SUPERSEDED = 7, WAVEFORMS = 65535, MAX_BYTES = 65535 };
    return vlr->size_bytes <= MAX_BYTES && !ewa_las_vlr_is(vlr, "laszip encoded", LASZIP) &&
           !ewa_las_vlr_is(vlr, "LASF_Spec", EXTRA_BYTES) && !ewa_las_vlr_is(vlr, "LASF_Spec", SUPERSEDED) &&
           !ewa_las_vlr_is(vlr, "LASF_Spec", WAVEFORMS) &&
           !ewa_las_vlr_is(vlr, EWA_COPC_LEVELS_USER, EWA_COPC_LEVELS_ID) &&
           strncmp((const char *)vlr->head + 2, "copc", 16) != 0;
}

/// Appends a record, an extended one with the shorter head of the others.
static ewa_status append(ewa_context *context, const ewa_las_vlr *vlr, ewa_buffer *kept, size_t *kept_bytes) {
    const size_t size_bytes = (size_t)vlr->size_bytes, max_bytes = EWA_LAS_RECORD_BYTES + size_bytes;
    EWA_TRY(ewa_buffer_grow(context, kept, *kept_bytes, *kept_bytes + max_bytes, 1));
    uint8_t *to = (uint8_t *)kept->data + *kept_bytes;
    memcpy(to, vlr->head, 20);
    ewa_las_put_u16(to + 20, (uint16_t)size_bytes);
    memcpy(to + 22, vlr->head + (vlr->extended ? 28 : 22), 32);
    if (size_bytes) memcpy(to + EWA_LAS_RECORD_BYTES, vlr->bytes, size_bytes);
    *kept_bytes += max_bytes;
    return EWA_OK;
}

static ewa_status note_text(ewa_cloud *prototype, const char *name, const char *text) {
    return text[0] ? ewa_cloud_set_note(prototype, name, text, strlen(text)) : EWA_OK;
}

/// The day of the year, from 1, as a date; both are 0 where nobody cared.
static ewa_status note_date(const ewa_las_header *header, ewa_cloud *prototype) {
    const uint32_t year = header->year;
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    const uint32_t days[12] = {31, leap ? 29 : 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    uint32_t day = header->day, month = 0;
    while (month < 12 && day > days[month]) day -= days[month++];
    if (year == 0 || day == 0 || month == 12) return EWA_OK;
    char text[32];
    snprintf(text, sizeof text, "%04u-%02u-%02u", year, month + 1, day);
    return note_text(prototype, "file.date", text);
}

static ewa_status note_head(const ewa_las_header *header, ewa_cloud *prototype) {
    char text[80];
    snprintf(text, sizeof text, "LAS 1.%u, point format %u, %u bytes a point", header->version_minor,
             header->point_format, header->record_bytes);
    ewa_status status = note_text(prototype, "file.format", text);
    ewa_las_text(header->software, 32, text);
    if (status == EWA_OK) status = note_text(prototype, "file.software", text);
    ewa_las_text(header->system, 32, text);
    EWA_TRY(status);
    EWA_TRY(note_text(prototype, "file.system", text));
    snprintf(text, sizeof text, "%u", header->global_encoding);
    EWA_TRY(note_text(prototype, EWA_LAS_NOTE_ENCODING, text));
    snprintf(text, sizeof text, "%u", header->point_format);
    EWA_TRY(note_text(prototype, EWA_LAS_NOTE_FORMAT, text));
    return note_date(header, prototype);
}

ewa_status ewa_las_notes(const ewa_cloud_source *source, const ewa_las_header *header, ewa_cloud *prototype) {
    ewa_las_walk walk = {0};
    ewa_las_vlr vlr;
    ewa_las_crs crs = {0};
    ewa_buffer kept = {0};
    size_t kept_bytes = 0;
    ewa_status status = note_head(header, prototype);
    while (status == EWA_OK && ewa_las_walk_next(source, header, &walk, &vlr)) {
        ewa_las_crs_take(&crs, &vlr);
        if (is_kept(&vlr)) status = append(source->context, &vlr, &kept, &kept_bytes);
    }
    if (walk.fault)
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: its %s end before the last that the header counts (%u and %u); what is behind is "
                   "left out",
                   source->name, walk.fault, header->vlr_count, header->evlr_count);
    if (status == EWA_OK && kept_bytes)
        status = ewa_cloud_set_note(prototype, EWA_LAS_NOTE_RECORDS, kept.data, kept_bytes);
    ewa_buffer_free(source->context, &kept);
    const bool prefer_wkt = header->global_encoding & EWA_LAS_WKT || header->point_format >= 6;
    return status == EWA_OK ? ewa_las_crs_note(source->context, &crs, prefer_wkt, prototype) : status;
}
