// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The variable length records of a LAS file that is written: those that the cloud brought along, the
// coordinate reference system, and what describes the extra bytes.
//
// Based on: OGC 19-008r4, "OGC GeoTIFF Standard 1.1", section 7.1.
#include "base/base.h"
#include "io/las/las_wkt.h"
#include "io/las/las_write.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_RECORD_BYTES = 65535, WKT_ID = 2112, KEYS_ID = 34735 };

ewa_status ewa_las_record_append(ewa_context *context, const char *user, uint16_t id, const char *description,
                                 const void *bytes, size_t size_bytes, ewa_buffer *records,
                                 size_t *at_bytes) {
    EWA_TRY(ewa_buffer_grow(context, records, *at_bytes, *at_bytes + EWA_LAS_RECORD_BYTES + size_bytes, 1));
    uint8_t *to = (uint8_t *)records->data + *at_bytes;
    memset(to, 0, EWA_LAS_RECORD_BYTES);
    memcpy(to + 2, user, strnlen(user, 16));
    ewa_las_put_u16(to + 18, id);
    ewa_las_put_u16(to + 20, (uint16_t)size_bytes);
    memcpy(to + 22, description, strnlen(description, 32));
    if (size_bytes) memcpy(to + EWA_LAS_RECORD_BYTES, bytes, size_bytes);
    *at_bytes += EWA_LAS_RECORD_BYTES + size_bytes;
    return EWA_OK;
}

/// Steps over the records of the note, which others may have made; false at the end or where they are broken.
static bool next_kept(const uint8_t *bytes, size_t size_bytes, size_t *at, ewa_las_vlr *vlr) {
    if (size_bytes - *at < EWA_LAS_RECORD_BYTES) return false;
    const uint8_t *head = bytes + *at;
    *vlr = (ewa_las_vlr){.head = head,
                         .bytes = head + EWA_LAS_RECORD_BYTES,
                         .size_bytes = ewa_las_u16(head + 20),
                         .id = ewa_las_u16(head + 18)};
    if (vlr->size_bytes > size_bytes - *at - EWA_LAS_RECORD_BYTES) return false;
    *at += EWA_LAS_RECORD_BYTES + (size_t)vlr->size_bytes;
    return true;
}

/// Whether the records say the same of the coordinate system as the note that other readers and callers set.
static ewa_status compare_crs(const ewa_cloud_target *target, const ewa_las_crs *crs, const char *note,
                              bool *same) {
    *same = false;
    for (int prefer_wkt = 0; prefer_wkt < 2 && !*same; prefer_wkt++) {
        char *text, name[EWA_LAS_NAME_BYTES];
        size_t text_bytes;
        EWA_TRY(ewa_las_crs_text(target->context, crs, prefer_wkt, &text, &text_bytes, name));
        *same = text ? note && strcmp(text, note) == 0 : !note;
        ewa_release(target->context, text, text_bytes, 1);
    }
    return EWA_OK;
}

/// Says that the points' coordinate system is only where older formats have it.
static void warn_of_keys(const ewa_cloud_target *target, const char *crs) {
    ewa_report(target->context, EWA_SEVERITY_WARNING,
               "%s: the coordinate reference system %s is written as GeoTIFF keys, since there is no well-known text of it here; "
               "readers that hold to LAS 1.4 do not look at them",
               target->name, crs);
}

/// Writes the number behind "EPSG:" as the key of a projected or a geographic system.
static ewa_status append_keys(const ewa_cloud_target *target, const char *crs, ewa_buffer *records,
                              size_t *at_bytes, uint32_t *count) {
    char *end;
    const unsigned long code = strtoul(crs, &end, 10);
    const unsigned long vertical = *end == '+' ? strtoul(end + 1, &end, 10) : 0;
    enum { LAST_CODE = 32766 };
    if (code == 0 || code > LAST_CODE || vertical > LAST_CODE || *end) {
        ewa_report(target->context, EWA_SEVERITY_WARNING,
                   "%s: the coordinate reference system EPSG:%s has no GeoTIFF key and is left out",
                   target->name, crs);
        return EWA_OK;
    }
    const bool geographic = code >= 4000 && code < 5000;
    const uint16_t keys[16] = {1,
                               1,
                               0,
                               vertical ? 3 : 2,
                               1024,
                               0,
                               1,
                               geographic ? 2 : 1,
                               (uint16_t)(geographic ? 2048 : 3072),
                               0,
                               1,
                               (uint16_t)code,
                               4096,
                               0,
                               1,
                               (uint16_t)vertical};
    uint8_t bytes[sizeof keys];
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) ewa_las_put_u16(bytes + 2 * i, keys[i]);
    (*count)++;
    return ewa_las_record_append(target->context, "LASF_Projection", KEYS_ID, "GeoTIFF keys", bytes,
                                 vertical ? sizeof bytes : sizeof bytes - 8, records, at_bytes);
}

/// Writes well-known text.
static ewa_status append_wkt(const ewa_cloud_target *target, ewa_las_plan *plan, const char *text, ewa_buffer *records,
                             size_t *at_bytes, uint32_t *count) {
    plan->global_encoding |= EWA_LAS_WKT;
    plan->version_minor = 4;
    (*count)++;
    return ewa_las_record_append(target->context, "LASF_Projection", WKT_ID, "OGC WKT", text, strlen(text) + 1, records, at_bytes);
}

/// Whether point formats of the plan have their coordinate system as well-known text only (LAS 1.4, section 2.5).
static bool needs_wkt(const ewa_las_plan *plan) { return plan->point_format >= 6; }

/// Writes the coordinate system that the cloud names.
static ewa_status append_crs(const ewa_cloud_target *target, ewa_las_plan *plan, const char *crs,
                             ewa_buffer *records, size_t *at_bytes, uint32_t *count) {
    char made[EWA_LAS_WKT_BYTES];
    if (strncmp(crs, "EPSG:", 5) == 0) {
        if (needs_wkt(plan) && ewa_las_wkt_make(crs + 5, made)) return append_wkt(target, plan, made, records, at_bytes, count);
        if (needs_wkt(plan)) warn_of_keys(target, crs);
        return append_keys(target, crs + 5, records, at_bytes, count);
    }
    if (!strchr(crs, '[') || strlen(crs) + 1 > MAX_RECORD_BYTES) {
        ewa_report(target->context, EWA_SEVERITY_WARNING,
                   "%s: the coordinate reference system is no well-known text or EPSG code and is left out",
                   target->name);
        return EWA_OK;
    }
    return append_wkt(target, plan, crs, records, at_bytes, count);
}

/// Whether the system that a cloud names by its codes can be written as text; warns where it cannot.
static bool becomes_wkt(const ewa_cloud_target *target, const char *crs) {
    char made[EWA_LAS_WKT_BYTES];
    if (crs && strncmp(crs, "EPSG:", 5) == 0 && ewa_las_wkt_make(crs + 5, made)) return true;
    if (crs) warn_of_keys(target, crs);
    return false;
}

ewa_status ewa_las_records_make(const ewa_cloud_target *target, ewa_las_plan *plan, ewa_buffer *records,
                                size_t *size_bytes, uint32_t *count) {
    enum { ENCODING_KEPT = 1u << 0 | 1u << 3 }; // what GPS times count from, return numbers that were made up
    const ewa_cloud *prototype = target->prototype;
    const char *encoding = ewa_cloud_note(prototype, EWA_LAS_NOTE_ENCODING, NULL);
    const unsigned said = encoding ? (unsigned)atoi(encoding) : 0;
    const char *crs_note = ewa_cloud_note(prototype, "crs", NULL);
    size_t note_bytes = 0, at = 0;
    const uint8_t *note = (const uint8_t *)ewa_cloud_note(prototype, EWA_LAS_NOTE_RECORDS, &note_bytes);
    ewa_las_crs crs = {0};
    ewa_las_vlr vlr;
    *size_bytes = 0;
    *count = 0;
    plan->global_encoding = (uint16_t)(said & ENCODING_KEPT);
    while (note && next_kept(note, note_bytes, &at, &vlr)) ewa_las_crs_take(&crs, &vlr);
    bool keeps_crs;
    ewa_status status = compare_crs(target, &crs, crs_note, &keeps_crs);
    // Keys of an older point format become text where there is one, which is written like any other.
    if (keeps_crs && crs.keys && !crs.wkt && needs_wkt(plan)) keeps_crs = !becomes_wkt(target, crs_note);
    at = 0;
    while (status == EWA_OK && note && next_kept(note, note_bytes, &at, &vlr)) {
        if (!keeps_crs && ewa_las_crs_take(&crs, &vlr)) continue;
        status = ewa_buffer_grow(target->context, records, *size_bytes,
                                 *size_bytes + EWA_LAS_RECORD_BYTES + vlr.size_bytes, 1);
        if (status != EWA_OK) break;
        memcpy((uint8_t *)records->data + *size_bytes, vlr.head, EWA_LAS_RECORD_BYTES + vlr.size_bytes);
        *size_bytes += EWA_LAS_RECORD_BYTES + (size_t)vlr.size_bytes;
        (*count)++;
    }
    const bool was_wkt = said & EWA_LAS_WKT || !crs.keys;
    // From point format 6 on the bit is set with or without a system.
    if (needs_wkt(plan) || (keeps_crs && crs.wkt && plan->version_minor >= 4 && was_wkt)) plan->global_encoding |= EWA_LAS_WKT;
    if (status == EWA_OK && !keeps_crs && crs_note)
        status = append_crs(target, plan, crs_note, records, size_bytes, count);
    const size_t extra_bytes = (size_t)plan->extra_count * EWA_LAS_EXTRA_BYTES;
    if (status != EWA_OK || extra_bytes == 0) return status;
    if (extra_bytes > MAX_RECORD_BYTES)
        return ewa_fail(target->context, EWA_ERROR_LIMIT, "%s: %u attributes beside those of LAS, %d at most",
                        target->name, plan->extra_count, MAX_RECORD_BYTES / EWA_LAS_EXTRA_BYTES);
    (*count)++;
    return ewa_las_record_append(target->context, "LASF_Spec", 4, "Extra bytes", plan->extras.data,
                                 extra_bytes, records, size_bytes);
}
