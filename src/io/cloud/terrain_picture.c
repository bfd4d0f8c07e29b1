// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Heights in the colours of pictures, of tiles of maps: PNG, or lossless WebP. Nothing in such a picture says so: it is
// read like this only when asked for.
//
// Based on: Mapbox, "Mapbox Terrain-RGB v1"; Mapzen, "Terrain tiles: Terrarium"; OSGeo, "Tile Map Service" (zoom,
// column and row of tiles of the Web Mercator projection).
#include "base/base.h"
#include "base/platform.h"
#include "io/cloud/height_grid.h"
#include "io/image/png.h"
#include "io/image/webp.h"
#include "math/angle.h"
#include "math/gaussian.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_ZOOM = 30, MAX_DIGITS = 10, COLOR_BYTES = 4 };

typedef struct picture_state {
    const ewa_cloud_source *source;
    ewa_height_grid grid;
    uint8_t *codes; ///< red green blue alpha
    size_t code_bytes;
    uint64_t cell; ///< the next one
} picture_state;

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    return ewa_png_recognise(bytes, (size_t)size_bytes) || ewa_webp_recognise(bytes, (size_t)size_bytes);
}

/// Reads the number before `*end`, which becomes the begin of it; false when there is none, or no slash before it but
/// at the begin of the path.
static bool take_number(const char *path, const char **end, uint64_t *number) {
    const char *at = *end;
    while (at > path && at[-1] >= '0' && at[-1] <= '9') at--;
    if (at == *end || *end - at > MAX_DIGITS || (at > path && !ewa_platform_is_separator(at[-1]))) return false;
    *number = strtoull(at, NULL, 10);
    *end = at;
    return true;
}

/// Finds the tile that a path names: .../zoom/column/row.png, or row@2x.png.
static bool find_tile(const char *path, uint64_t tile[3]) {
    const char *name = path ? ewa_platform_file_name(path) : NULL;
    if (!name || name == path) return false;
    const char *end = name + strspn(name, "0123456789");
    if (*end != '.' && *end != '@') return false;
    for (int i = 2; i >= 0; i--) {
        if (!take_number(path, &end, &tile[i])) return false;
        if (i && end == path) return false;
        if (i) end--;
    }
    return tile[0] <= MAX_ZOOM && tile[1] >> tile[0] == 0 && tile[2] >> tile[0] == 0;
}

/// Length of a pixel in the middle of a tile, metres on the ground.
static double pixel_length(const uint64_t tile[3], uint32_t width_px) {
    static const double AROUND_M = 40075016.685578488;
    const double tiles = (double)((uint64_t)1 << tile[0]);
    // The projection stretches by 1 / cos(latitude) = cosh(y).
    const double y = EWA_PI * (1 - 2 * ((double)tile[2] + 0.5) / tiles), e = ewa_exp(fabs(y));
    return AROUND_M / (tiles * width_px) / (0.5 * (e + 1 / e));
}

static ewa_status decode(picture_state *state, uint32_t *width_px, uint32_t *height_px) {
    const ewa_cloud_source *source = state->source;
    const size_t size_bytes = (size_t)source->size_bytes;
    return (ewa_png_recognise(source->bytes, size_bytes) ? ewa_png_decode_codes : ewa_webp_decode_codes)(
        source->context, source->name, source->bytes, size_bytes, width_px, height_px, &state->codes,
        &state->code_bytes);
}

static ewa_status prepare(picture_state *state, ewa_cloud *prototype) {
    const ewa_cloud_source *source = state->source;
    uint32_t width_px, height_px;
    uint64_t tile[3];
    double length = 1;
    EWA_TRY(decode(state, &width_px, &height_px));
    if (find_tile(source->path, tile))
        length = pixel_length(tile, width_px);
    else
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: no name of a tile (zoom/column/row), which says how large pixels are: 1 is taken",
                   source->name);
    state->grid = (ewa_height_grid){.columns = width_px, .rows = height_px, .to_world = {length, 0, 0, 0, -length, 0}};
    return ewa_height_grid_settle(source, &state->grid, prototype);
}

static void close_picture(void *data) {
    picture_state *state = data;
    if (!state) return;
    ewa_context *context = state->source->context;
    ewa_release(context, state->codes, state->code_bytes, 1);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_picture(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                               void **data) {
    picture_state *state = ewa_allocate_zeroed(source->context, 1, sizeof *state);
    if (!state) return EWA_ERROR_MEMORY;
    state->source = source;
    const ewa_status status = prepare(state, prototype);
    if (status != EWA_OK) {
        close_picture(state);
        return status;
    }
    *point_count = state->grid.columns * state->grid.rows;
    *data = state;
    return EWA_OK;
}

/// The height of a colour; false where there is none: transparent, or the lowest of Terrain-RGB, which is black.
static bool find_height(const uint8_t *rgba, ewa_picture_heights heights, double *height) {
    const double red = rgba[0], green = rgba[1], blue = rgba[2];
    if (rgba[3] == 0) return false;
    if (heights == EWA_HEIGHTS_TERRARIUM) {
        *height = red * 256 + green + blue / 256 - 32768;
        return true;
    }
    *height = (red * 65536 + green * 256 + blue) / 10 - 10000;
    return red + green + blue > 0;
}

static ewa_status read_picture(void *data, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    picture_state *state = data;
    const uint64_t columns = state->grid.columns, cells = columns * state->grid.rows;
    uint64_t got = 0;
    for (; got < maximum && state->cell < cells; state->cell++) {
        double height;
        if (!find_height(state->codes + COLOR_BYTES * state->cell, state->source->options->heights, &height)) continue;
        if (sinks[0].to)
            ewa_height_grid_place(&state->grid, state->cell % columns, state->cell / columns, height,
                                  sinks[0].to + got * sinks[0].stride_bytes);
        got++;
    }
    *got_count = got;
    return ewa_progress(state->source->context, "read", (double)state->cell / (double)cells);
}

const ewa_cloud_format ewa_format_terrain = {EWA_MODEL_TERRAIN, probe, open_picture, read_picture, close_picture};
