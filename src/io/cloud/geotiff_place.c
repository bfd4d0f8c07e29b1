// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The tags of GeoTIFF that say where cells lie, in which system, and which number is none.
//
// Based on: OGC 19-008r4, "OGC GeoTIFF Standard 1.1", sections 7.1 to 7.3 and annex B.6; GDAL, "GTiff" (tag 42113).
#include "base/base.h"
#include "io/cloud/geotiff.h"
#include "io/las/las.h"
#include "io/text.h"

#include <math.h>
#include <string.h>
#include <tiffio.h>

enum {
    SCALE = 33550,
    TIE_POINTS = 33922,
    TRANSFORMATION = 34264,
    KEYS = 34735,
    TEXTS = 34737,
    NO_DATA = 42113,

    KEY_SHORTS = 4, // of the head and of each entry
    KEY_MODEL = 1024,
    KEY_RASTER = 1025,
    RASTER_IS_POINT = 2,
    GEOCENTRIC = 3,
    TIE_DOUBLES = 6,
    MATRIX_DOUBLES = 16,
};

/// The values of a tag of the given type; NULL, and none, when it is not there or of another one. libtiff does not know
/// these tags: it hands them over as they are in the file.
static const void *find_tag(TIFF *tiff, uint32_t tag, TIFFDataType type, uint32_t *count) {
    const void *values = NULL;
    const TIFFField *field = TIFFFindField(tiff, tag, TIFF_ANY);
    *count = 0;
    if (!field || TIFFFieldDataType(field) != type || !TIFFFieldPassCount(field) ||
        TIFFFieldReadCount(field) != TIFF_VARIABLE2)
        return NULL;
    if (!TIFFGetField(tiff, tag, count, &values)) *count = 0;
    return *count ? values : NULL;
}

/// The number of a key; 0 when there is none.
static uint16_t key_number(TIFF *tiff, uint16_t id) {
    uint32_t count;
    const uint16_t *keys = find_tag(tiff, KEYS, TIFF_SHORT, &count);
    for (uint32_t i = 1; keys && i < count / KEY_SHORTS; i++)
        if (keys[KEY_SHORTS * i] == id && keys[KEY_SHORTS * i + 1] == 0) return keys[KEY_SHORTS * i + 3];
    return 0;
}

/// Fills the map from the raster's coordinates, whose cells have their corners at whole numbers.
static ewa_status read_map(const ewa_cloud_source *source, TIFF *tiff, ewa_geotiff_place *place) {
    uint32_t scale_count, tie_count, matrix_count;
    const double *scale = find_tag(tiff, SCALE, TIFF_DOUBLE, &scale_count),
                 *tie = find_tag(tiff, TIE_POINTS, TIFF_DOUBLE, &tie_count),
                 *matrix = find_tag(tiff, TRANSFORMATION, TIFF_DOUBLE, &matrix_count);
    double *m = place->to_world;
    if (matrix && matrix_count >= MATRIX_DOUBLES) {
        const double map[6] = {matrix[0], matrix[1], matrix[3], matrix[4], matrix[5], matrix[7]};
        memcpy(m, map, sizeof map);
    } else if (scale && scale_count >= 2 && tie && tie_count >= TIE_DOUBLES) {
        const double map[6] = {scale[0], 0, tie[3] - tie[0] * scale[0], 0, -scale[1], tie[4] + tie[1] * scale[1]};
        memcpy(m, map, sizeof map);
    } else if (tie && tie_count >= TIE_DOUBLES) {
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: TIFF with the places of %u single points; a grid needs a scale or a transformation",
                        source->name, tie_count / TIE_DOUBLES);
    } else {
        return EWA_OK;
    }
    if (m[0] * m[4] == m[1] * m[3] || !isfinite(m[0] * m[4] - m[1] * m[3]))
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: TIFF with cells of no area", source->name);
    place->is_placed = true;
    return EWA_OK;
}

ewa_status ewa_geotiff_read(const ewa_cloud_source *source, TIFF *tiff, ewa_geotiff_place *place) {
    *place = (ewa_geotiff_place){.to_world = {1, 0, 0, 0, -1, 0}};
    EWA_TRY(read_map(source, tiff, place));
    const uint16_t model = key_number(tiff, KEY_MODEL);
    if (model == GEOCENTRIC)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED, "%s: TIFF in a geocentric system, which has no up",
                        source->name);
    if (model == EWA_GEOTIFF_PROJECTED || model == EWA_GEOTIFF_GEOGRAPHIC) place->model = model;
    // Numbers are those of cells' middles, which are at whole numbers where the raster is one of points.
    double *m = place->to_world;
    if (key_number(tiff, KEY_RASTER) != RASTER_IS_POINT)
        for (int axis = 0; axis < 2; axis++) m[3 * axis + 2] += 0.5 * (m[3 * axis] + m[3 * axis + 1]);
    uint32_t count;
    const char *text = find_tag(tiff, NO_DATA, TIFF_ASCII, &count);
    while (text && count && (text[count - 1] == 0 || text[count - 1] == ' ')) count--;
    place->has_no_data = text && ewa_text_number((ewa_text){text, count}, &place->no_data);
    return EWA_OK;
}

ewa_status ewa_geotiff_note(ewa_context *context, TIFF *tiff, ewa_cloud *prototype) {
    uint32_t key_count, text_count;
    const uint16_t *keys = find_tag(tiff, KEYS, TIFF_SHORT, &key_count);
    const char *texts = find_tag(tiff, TEXTS, TIFF_ASCII, &text_count);
    if (!keys) return EWA_OK;
    // As LAS files have them: the bytes of numbers, the lowest first.
    uint8_t *bytes = ewa_allocate(context, key_count, 2);
    if (!bytes) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < key_count; i++) {
        bytes[2 * (size_t)i] = (uint8_t)keys[i];
        bytes[2 * (size_t)i + 1] = (uint8_t)(keys[i] >> 8);
    }
    const ewa_las_crs crs = {.keys = bytes,
                             .keys_bytes = 2 * (uint64_t)key_count,
                             .texts = (const uint8_t *)texts,
                             .texts_bytes = text_count};
    const ewa_status status = ewa_las_crs_note(context, &crs, false, prototype);
    ewa_release(context, bytes, key_count, 2);
    return status;
}
