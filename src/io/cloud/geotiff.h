// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the cells of a TIFF file lie: what its tags say.
#ifndef EWA_SRC_GEOTIFF_H
#define EWA_SRC_GEOTIFF_H

#include "io/cloud/height_grid.h"

#include <string.h>

struct tiff;

/// What x and y are.
typedef enum ewa_geotiff_model {
    EWA_GEOTIFF_UNKNOWN,
    EWA_GEOTIFF_PROJECTED,  ///< lengths on a map
    EWA_GEOTIFF_GEOGRAPHIC, ///< longitude and latitude
} ewa_geotiff_model;

typedef struct ewa_geotiff_place {
    bool is_placed;     ///< the file says where its cells are
    double to_world[6]; ///< as ewa_height_grid has it; else cells of 1, the first row in the north
    ewa_geotiff_model model;
    bool has_no_data;
    double no_data;
} ewa_geotiff_place;

/// Whether bytes begin like a TIFF file, classic or of 64 bits.
static inline bool ewa_tiff_recognise(const uint8_t *bytes, uint64_t size_bytes) {
    static const char *const MARKS[] = {"II*\0", "MM\0*", "II+\0", "MM\0+"};
    for (int i = 0; i < 4 && size_bytes >= 8; i++)
        if (memcmp(bytes, MARKS[i], 4) == 0) return true;
    return false;
}

/// Reads the tags of the first directory. Errors: EWA_ERROR_UNSUPPORTED (places of single points only, a geocentric
/// system), EWA_ERROR_FORMAT (cells of no area).
ewa_status ewa_geotiff_read(const ewa_cloud_source *source, struct tiff *tiff, ewa_geotiff_place *place);

/// Adds the coordinate reference system as the note "crs", as of LAS files. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_geotiff_note(ewa_context *context, struct tiff *tiff, ewa_cloud *prototype);

#endif
