// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of volumes: what goes in and out of them. One body (kernels_body.h), one file per instruction
// set, the same bytes from each. Formulas: docs/math.md section 12.
//
// Voxels at the eye, which have no ellipse on the screen, come first: `append_near` lists them for all tiles,
// `draw_near` draws them ray by ray. Then, front to back, one tile at a time: `append` projects the voxels
// of a block and queues those that would show; as the queue fills, and when it is flushed (`flush`), they are
// shaded into buckets, one for each depth unit. A bucket of points is summed with the circular filter
// (`sum_points`), then composited once (`composite`); a bucket of splats is sorted, then composited one by
// one (`draw_splats`).
#ifndef EWA_SRC_VOLUME_KERNELS_H
#define EWA_SRC_VOLUME_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ewa/shade.h"
#include "volume/footprint.h"
#include "wide/isa.h"
#include "wide/lights.h"

enum {
    EWA_VOLUME_TILE_PX = 64,
    EWA_VOLUME_ROW_BLOCKS = EWA_VOLUME_TILE_PX / 4, ///< blocks of 4x4 pixels
    EWA_VOLUME_TILE_BLOCKS = EWA_VOLUME_ROW_BLOCKS * EWA_VOLUME_ROW_BLOCKS,
    EWA_SUMS_MARGIN_PX = 4, ///< around a tile's sums
    EWA_SUMS_SIDE_PX = EWA_VOLUME_TILE_PX + 2 * EWA_SUMS_MARGIN_PX,
    EWA_SUMS_ROW_BLOCKS = EWA_SUMS_SIDE_PX / 4,
    EWA_SUMS_STRIP = EWA_SUMS_SIDE_PX * 16,                     ///< floats of a strip, four pixels wide
    EWA_SUMS_CELLS = EWA_SUMS_ROW_BLOCKS * EWA_SUMS_ROW_BLOCKS, ///< blocks of 4x4 pixels, with the margin
    EWA_SUMS_CELL_ROOM = (EWA_SUMS_CELLS + 7) / 8 * 8,          ///< whole words of them
    EWA_FILTER_PHASES = 32,
    EWA_FILTER_COUNT = 256,
    EWA_PAGE_RECORDS = 64,
    EWA_QUEUE_VOXELS = 64,                  ///< voxels that are shaded at once
    EWA_QUEUE_ROOM = EWA_QUEUE_VOXELS + 16, ///< of them, and of sixteen lanes more
    EWA_NO_PAGE = UINT32_MAX,
    EWA_VOLUME_CHANNELS = 5, ///< of a block's pixels: premultiplied r, g, b, transmittance, depth
};

/// The widest filter of points, px: what four taps hold.
#define EWA_FILTER_MAX_PX 0.9f

/// The circular filter along one axis: taps of the four pixels from floor(x - 1/2) - 1 on, which add up to 1,
/// between four zeros on either side.
typedef float ewa_point_filter[EWA_FILTER_PHASES][12];

/// Where a splat is.
typedef struct ewa_splat_place {
    float x_px, y_px; ///< in the tile
    float z, distance;
} ewa_splat_place;

/// The voxels of one depth unit, all points or all splats: records in pages, in the order in which they came.
typedef struct ewa_volume_bucket {
    _Alignas(16) uint32_t page_count; // 16 bytes, so that a bucket is found by a shift
    uint32_t first_page;
    uint32_t next; ///< record to come; the first one of a page: that page is still to be taken
} ewa_volume_bucket;

static inline uint32_t ewa_bucket_count(const ewa_volume_bucket *bucket) {
    return bucket->page_count * EWA_PAGE_RECORDS - (0u - bucket->next) % EWA_PAGE_RECORDS;
}

/// A voxel at the eye.
typedef struct ewa_near_voxel {
    float offset[3]; ///< from the eye, in standard deviations of the kernel along i, j, k
    float square;    ///< of its length
    float color[3], extinction;
    float z, distance;
    int32_t slice; ///< < 0
} ewa_near_voxel;

/// Records of voxels on their way, EWA_PAGE_RECORDS to a page, and what page follows each; `free_count` of
/// `free` are to be had. Colours of points: r, g, b, 1, all times the mass; of splats: r, g, b; extinction.
/// Windows of points: where in the filter the taps across begin, from the strip's edge on (9 bits), and those
/// down (9 bits); in which row of all strips of the sums it begins.
typedef struct ewa_volume_pages {
    float (*colors)[4];      ///< [record]
    int32_t *windows;        ///< [record], of points
    ewa_splat_place *splats; ///< [record]; NULL where all are points
    uint32_t *next, *free;   ///< [page]
    uint32_t free_count;
} ewa_volume_pages;

/// What voxels in the queue are known by.
enum {
    QUEUE_SLICE, ///< integers
    QUEUE_WINDOW,
    QUEUE_NORMAL,
    QUEUE_COLOR,                    ///< r, g, b before light
    QUEUE_FACTOR = QUEUE_COLOR + 3, ///< of the colour
    QUEUE_LAST,                     ///< the fourth number of the record's colour
    QUEUE_SLOPE,                    ///< x and y
    QUEUE_LENGTH = QUEUE_SLOPE + 2, ///< of the slopes and 1
    QUEUE_PLACE,                    ///< of a splat: as ewa_splat_place
    QUEUE_FIELDS = QUEUE_PLACE + 4,
};

/// Voxels that touch the tile and are not shaded yet, over the blocks that they come from.
typedef struct ewa_volume_queue {
    uint32_t count;
    _Alignas(64) float fields[QUEUE_FIELDS][EWA_QUEUE_ROOM];
} ewa_volume_queue;

/// Camera, grid and options of a frame in single precision.
typedef struct ewa_volume_view {
    bool orthographic, exact, lit, highlights, with_depth, with_surface, with_sections, has_near, mark_splats;
    float fx_px, fy_px, cx_px, cy_px;
    float axes[3][3];          ///< steps along i, j, k in camera space
    float to_deviations[3][3]; ///< row vectors of camera space to standard deviations along i, j, k
    float deviations_per_step;
    float near;                      ///< perspective: voxels deeper than that behind the eye are not seen
    double unit_camera;              ///< of a depth of ours in the planes of the frame
    float unit_inverse, unit_offset; ///< slice = floor(z unit_inverse + unit_offset)
    int32_t point_slice;             ///< slices from there on are of points
    float color_scale;               ///< of 16-bit colours
    float marked_color[3];           ///< of splats, with mark_splats
    float point_mass, splat_peak, density;
    float covariance[6], inverse[6]; ///< xx xy xz yy yz zz
    float bend;                      ///< of ewa_grid_view
    float cutoff, cutoff2, prefilter2_px2, reach;
    float minimum_transmittance;
    float depth_deviation;  ///< of voxels
    float to_world[9];      ///< world from camera, a rotation
    float toward_viewer[3]; ///< orthographic, world space
    float ambient, diffuse, specular, shininess;
    uint32_t light_count;
    ewa_kernel_light lights[EWA_MAX_LIGHTS]; ///< in world space
    const ewa_footprint_table *table;
} ewa_volume_view;

/// The voxels of a block, and how it lies.
typedef struct ewa_volume_source {
    const uint16_t *places, *colors[3];
    const float *extinctions;
    const int32_t *normals;
    uint32_t count;
    float origin[3];                 ///< its first place in camera space
    float from_eye[3];               ///< the same from the eye in steps along i, j, k; for `append_near`
    int32_t slice_first, slice_last; ///< where its voxels may be
    bool some_hidden;                ///< some of the tile's cells that it touches are hidden; for `append`
} ewa_volume_source;

/// A tile of the picture while it is drawn.
typedef struct ewa_volume_tile {
    int32_t x_px, y_px, width_px, height_px;
    float *sums;    ///< of a slice, in strips: [column / 4][row][column % 4]: r, g, b, optical depth
    float *pixels;  ///< [block][EWA_VOLUME_CHANNELS][16]
    float *surface; ///< [block][16] depths of opaque surfaces, and where section planes end what is left
    float *enter;   ///< [block][16] where section planes begin it
    uint8_t touched[EWA_SUMS_CELL_ROOM]; ///< [ewa_sums_cell()]: 1 where the sums may have something in them
    uint8_t hidden[EWA_SUMS_CELL_ROOM];  ///< 1 where nothing more would show, as in the margin
    uint32_t cell_count, visible_count;  ///< of cells within the picture; of those that are not hidden
    ewa_volume_bucket *ring;             ///< [slice & ring_mask]
    uint32_t ring_mask;
    ewa_volume_pages pages;
    ewa_volume_queue *queue;
} ewa_volume_tile;

/// The cell of a tile's block of 4x4 pixels. Cells go down the strips of the sums.
static inline uint32_t ewa_sums_cell(uint32_t row, uint32_t column) {
    return (column + 1) * EWA_SUMS_ROW_BLOCKS + row + 1; // the margin is one block
}

static inline void ewa_hide_cell(ewa_volume_tile *tile, uint32_t cell) {
    tile->visible_count -= !tile->hidden[cell];
    tile->hidden[cell] = 1;
}

/// Opaque surfaces, as ewa_render() gives them; all NULL: none.
typedef struct ewa_surface_planes {
    const float *depth, *rgba;
    const float *normal, *coverage; ///< NULL: normals are 0, coverage is the alpha of `rgba`
} ewa_surface_planes;

/// Those of options.
#define EWA_SURFACE_PLANES_OF(options)                                                                       \
    {                                                                                                        \
        (options)->surface_depth, (options)->surface_rgba, (options)->surface_normal,                        \
            (options)->surface_coverage                                                                      \
    }

/// Where pixels go.
typedef struct ewa_volume_target {
    uint32_t width_px, height_px;
    float background[4]; ///< premultiplied
    ewa_surface_planes surface;
    uint8_t *rgba8;
    float *rgba, *depth, *normal, *coverage;
} ewa_volume_target;

struct ewa_volume_layers;

typedef struct ewa_volume_kernels {

    /// Projects the voxels of a block and queues those that would show in the tile; a full queue is shaded,
    /// and its voxels added to the tile's buckets. Returns how many voxels touch the tile, but hidden cells only.
    uint32_t (*append)(const ewa_volume_view *view, const ewa_volume_source *source, ewa_volume_tile *tile);

    /// Shades what is left in the queue and adds it to the tile's buckets.
    void (*flush)(const ewa_volume_view *view, ewa_volume_tile *tile);

    /// Lists the voxels of a block that lie at the eye, in front of slice 0; returns how many, at most all.
    uint32_t (*append_near)(const ewa_volume_view *view, const ewa_volume_source *source,
                            ewa_near_voxel *voxels);

    /// Composites such voxels in the order given.
    void (*draw_near)(const ewa_volume_view *view, ewa_volume_tile *tile, const ewa_near_voxel *voxels,
                      uint32_t count);

    /// Adds the points of a bucket to the tile's sums.
    void (*sum_points)(ewa_volume_tile *tile, const ewa_volume_bucket *bucket,
                       const ewa_point_filter *filter);

    /// Composites the touched sums behind what is there, and clears them. `z`: of the slice's middle.
    void (*composite)(const ewa_volume_view *view, ewa_volume_tile *tile, float z);

    /// Composites splats in the order given; `order` are records' numbers, 64 to a page.
    void (*draw_splats)(const ewa_volume_view *view, ewa_volume_tile *tile, const uint32_t *order,
                        uint32_t count);

    /// Empties the pixels.
    void (*clear)(ewa_volume_tile *tile);

    /// Adds what the pixels have got since the last call to the layers, at depth `z`; there is room.
    void (*take_layers)(const ewa_volume_tile *tile, float z, struct ewa_volume_layers *layers);

    /// Writes the pixels over the background or the surfaces.
    void (*resolve)(const ewa_volume_view *view, const ewa_volume_tile *tile, const ewa_volume_target *to);
} ewa_volume_kernels;

EWA_DECLARE_VERSIONS(const ewa_volume_kernels, ewa_volume_kernels);

#endif
