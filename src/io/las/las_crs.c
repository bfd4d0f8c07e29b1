// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The coordinate reference system of LAS files: well-known text as it stands, GeoTIFF keys as the codes and
// citations they hold.
//
// Based on: OGC 19-008r4, "OGC GeoTIFF Standard 1.1", sections 7.1 and 7.4; OGC 01-009, section 7.
#include "base/base.h"
#include "io/crs.h"
#include "io/las/las.h"

#include <stdio.h>
#include <string.h>

enum {
    KEY_MODEL = 1024, // 1 projected, 2 geographic, 3 geocentric
    KEY_CITATION = 1026,
    KEY_GEODETIC = 2048,
    KEY_GEODETIC_CITATION = 2049,
    KEY_PROJECTED = 3072,
    KEY_PROJECTED_CITATION = 3073,
    KEY_PROJECTED_UNIT = 3076,
    KEY_VERTICAL = 4096,
    KEY_VERTICAL_UNIT = 4099,
    TEXTS_TAG = 34737, // where a key whose number is text has it
    USER_DEFINED = 32767,
};

bool ewa_las_crs_take(ewa_las_crs *crs, const ewa_las_vlr *vlr) {
    if (!vlr->bytes) return false;
    if (ewa_las_vlr_is(vlr, "LASF_Projection", 2112)) {
        crs->wkt = vlr->bytes;
        crs->wkt_bytes = vlr->size_bytes;
    } else if (ewa_las_vlr_is(vlr, "LASF_Projection", 34735)) {
        crs->keys = vlr->bytes;
        crs->keys_bytes = vlr->size_bytes;
    } else if (ewa_las_vlr_is(vlr, "LASF_Projection", TEXTS_TAG)) {
        crs->texts = vlr->bytes;
        crs->texts_bytes = vlr->size_bytes;
    } else {
        return ewa_las_vlr_is(vlr, "LASF_Projection", 34736) || ewa_las_vlr_is(vlr, "LASF_Projection", 2111);
    }
    return true;
}

/// Finds a key of the directory; NULL when it is not there.
static const uint8_t *find_key(const ewa_las_crs *crs, uint16_t id) {
    enum { ENTRY_BYTES = 8 };
    if (crs->keys_bytes < ENTRY_BYTES) return NULL;
    const uint64_t room = crs->keys_bytes / ENTRY_BYTES - 1, said = ewa_las_u16(crs->keys + 6);
    for (uint64_t i = 0; i < room && i < said; i++) {
        const uint8_t *entry = crs->keys + ENTRY_BYTES * (i + 1);
        if (ewa_las_u16(entry) == id) return entry;
    }
    return NULL;
}

/// Returns the number of a key, 0 when there is none.
static uint16_t key_number(const ewa_las_crs *crs, uint16_t id) {
    const uint8_t *entry = find_key(crs, id);
    return entry && ewa_las_u16(entry + 2) == 0 ? ewa_las_u16(entry + 6) : 0;
}

/// Writes the text of a key; false when there is none.
static bool key_text(const ewa_las_crs *crs, uint16_t id, char name[EWA_LAS_NAME_BYTES]) {
    const uint8_t *entry = find_key(crs, id);
    if (!entry || ewa_las_u16(entry + 2) != TEXTS_TAG) return false;
    uint64_t count = ewa_las_u16(entry + 4);
    const uint64_t at = ewa_las_u16(entry + 6);
    if (at > crs->texts_bytes || count > crs->texts_bytes - at) return false;
    if (count > EWA_LAS_NAME_BYTES - 1) count = EWA_LAS_NAME_BYTES - 1;
    ewa_las_text(crs->texts + at, (size_t)count, name);
    // A bar ends each text.
    for (size_t length = strlen(name); length && (name[length - 1] == '|' || name[length - 1] == ' ');)
        name[--length] = 0;
    return name[0] != 0;
}

static ewa_status copy_text(ewa_context *context, const uint8_t *bytes, size_t size_bytes, char **text,
                            size_t *text_bytes) {
    *text = ewa_allocate(context, size_bytes + 1, 1);
    if (!*text) return EWA_ERROR_MEMORY;
    *text_bytes = size_bytes + 1;
    // What is no ASCII may be UTF-8 and stays.
    for (size_t i = 0; i < size_bytes; i++)
        (*text)[i] = bytes[i] < ' ' || bytes[i] == 0x7f ? ' ' : (char)bytes[i];
    (*text)[size_bytes] = 0;
    return EWA_OK;
}

/// The first quoted name of well-known text, which is that of the system.
static void wkt_name(const char *text, char name[EWA_LAS_NAME_BYTES]) {
    const char *from = strchr(text, '"'), *to = from ? strchr(from + 1, '"') : NULL;
    if (!to) return;
    size_t length = (size_t)(to - from - 1);
    if (length > EWA_LAS_NAME_BYTES - 1) length = EWA_LAS_NAME_BYTES - 1;
    ewa_las_text((const uint8_t *)from + 1, length, name);
}

ewa_status ewa_las_crs_text(ewa_context *context, const ewa_las_crs *crs, bool prefer_wkt, char **text,
                            size_t *text_bytes, char name[EWA_LAS_NAME_BYTES]) {
    *text = NULL;
    *text_bytes = 0;
    name[0] = 0;
    const uint16_t projected = key_number(crs, KEY_PROJECTED), geodetic = key_number(crs, KEY_GEODETIC);
    const uint16_t model = key_number(crs, KEY_MODEL), vertical = key_number(crs, KEY_VERTICAL);
    const bool is_projected = model ? model == 1 : projected != 0;
    const uint16_t code = is_projected ? projected : geodetic;
    uint64_t wkt_bytes = crs->wkt_bytes;
    while (wkt_bytes && crs->wkt[wkt_bytes - 1] <= ' ') wkt_bytes--;
    // Where the keys only hold a definition, well-known text says more.
    if (wkt_bytes && (prefer_wkt || code == 0 || code == USER_DEFINED)) {
        EWA_TRY(copy_text(context, crs->wkt, (size_t)wkt_bytes, text, text_bytes));
        wkt_name(*text, name);
        return EWA_OK;
    }
    if (!is_projected || !key_text(crs, KEY_PROJECTED_CITATION, name))
        if (!key_text(crs, KEY_CITATION, name) &&
            (is_projected || !key_text(crs, KEY_GEODETIC_CITATION, name)))
            name[0] = 0;
    char said[EWA_LAS_NAME_BYTES + 64];
    if (code && code != USER_DEFINED && vertical && vertical != USER_DEFINED)
        snprintf(said, sizeof said, "EPSG:%u+%u", code, vertical);
    else if (code && code != USER_DEFINED)
        snprintf(said, sizeof said, "EPSG:%u", code);
    else if (crs->keys && name[0])
        snprintf(said, sizeof said, "user-defined: %s", name);
    else if (crs->keys && (code || model))
        snprintf(said, sizeof said, "user-defined");
    else
        return EWA_OK;
    if (!name[0]) memcpy(name, said, strnlen(said, EWA_LAS_NAME_BYTES - 1) + 1);
    return copy_text(context, (const uint8_t *)said, strlen(said), text, text_bytes);
}

static ewa_status note_text(ewa_cloud *prototype, const char *name, const char *text) {
    return text && text[0] ? ewa_cloud_set_note(prototype, name, text, strlen(text)) : EWA_OK;
}

/// The unit that keys name, which stands in well-known text by itself.
static const char *key_unit(const ewa_las_crs *crs) {
    const uint16_t unit = key_number(crs, KEY_PROJECTED_UNIT), vertical = key_number(crs, KEY_VERTICAL_UNIT);
    return vertical && vertical != unit ? NULL : ewa_crs_unit_name(ewa_crs_unit_of_code(unit));
}

ewa_status ewa_las_crs_note(ewa_context *context, const ewa_las_crs *crs, bool prefer_wkt, ewa_cloud *prototype) {
    char *text, name[EWA_LAS_NAME_BYTES];
    size_t text_bytes;
    ewa_status status = ewa_las_crs_text(context, crs, prefer_wkt, &text, &text_bytes, name);
    if (status == EWA_OK) status = note_text(prototype, "crs", text);
    if (status == EWA_OK && text) status = note_text(prototype, "crs_name", name);
    if (status == EWA_OK && text && !strchr(text, '[')) status = note_text(prototype, "crs_unit", key_unit(crs));
    ewa_release(context, text, text_bytes, 1);
    return status;
}
