// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Depth images to surfels: keys of a strip of rows, their slopes, then block by block packets of the grid,
// which the pipeline draws as it draws any.
//
// Based on: Yuan et al., "Hybrid Forward Resampling and Volume Rendering", 2003, section 3. The points of
// that paper are what the pipeline makes of surfels much smaller than its filter (docs/math.md section 4).
#include "warp/warp.h"
#include "cloud/color.h"
#include "image/srgb.h"
#include "surface/color_form.h"
#include "surface/options.h"
#include "warp/warp_options.h"

#include <math.h>
#include <string.h>

enum {
    BLOCKS_PER_CELL = EWA_WARP_CELL_PX / EWA_WARP_BLOCK_PX,
    MEASURED_ROWS = EWA_WARP_STRIP_PX + 2 * EWA_WARP_REACH, // that the slopes of a strip look at
    FINISH_PARTS = 64,
    PACKETS_AHEAD = 10,
};

/// Largest rate at which keys may change per pixel on a plane, and largest second difference there, over the
/// jump that is allowed at any rate.
static const double STEEP = 0.5, BEND_PER_JUMP = 0.25;

/// Tangent of the angle between two planes from which a sample belongs to one of them.
static const double CREASE = 0.36;

/// What one strip came to.
typedef struct strip_facts {
    uint64_t sample_count, flying_count;
    ewa_bounds centers; ///< of packets
} strip_facts;

/// What the tasks share.
typedef struct taking {
    ewa_warp *warp;
    const ewa_warp_kernels *kernels;
    strip_facts *strips;
    uint16_t codes[256], grey_code; // of 8-bit colours
    size_t stride, floats_per_worker;
} taking;

/// Rotation and scale of camera to world, as floats; returns where the eye is.
static ewa_vec3 set_pose(const ewa_camera *camera, float from_camera[9]) {
    const double *m = camera->world_to_camera;
    double square = 0; // of the scale
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) square += m[4 * r + c] * m[4 * r + c] / 3;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) from_camera[3 * r + c] = (float)(m[4 * c + r] / square);
    double eye_world[3];
    ewa_camera_eye(camera, eye_world);
    return vec3_load(eye_world);
}

static void set_source(ewa_warp_source *source, const ewa_warp_options *options) {
    const ewa_depth_image *image = &source->image;
    const ewa_camera *camera = &image->camera;
    ewa_warp_lens *lens = &source->lens;
    lens->ray_x[0] = (float)(1 / camera->fx_px), lens->ray_y[0] = (float)(1 / camera->fy_px);
    lens->ray_x[1] = (float)((0.5 - camera->cx_px) / camera->fx_px);
    lens->ray_y[1] = (float)((0.5 - camera->cy_px) / camera->fy_px);
    lens->sigma = (float)(options->radius_spacings / options->cutoff);
    lens->jump = (float)options->depth_jump, lens->steep = (float)STEEP;
    lens->bend = (float)(BEND_PER_JUMP * options->depth_jump);
    lens->crease_x = (float)(CREASE / camera->fx_px), lens->crease_y = (float)(CREASE / camera->fy_px);
    lens->noise = (float)options->depth_noise;
    lens->drop_flying = options->drop_flying ? 1 : 0;
    source->key_low = (float)(1 / options->farthest_world),
    source->key_high = (float)(1 / options->nearest_world);
    source->key_scale = (float)image->depth_scale;
    source->key_offset = 0;
    if (image->kind == EWA_DEPTH_DISPARITY) {
        source->key_scale = (float)(1 / (image->depth_scale * camera->fx_px * image->baseline_world));
        source->key_offset = (float)(image->disparity_offset_px * image->depth_scale);
    }
}

/// Checks the images and lays them out; sets the surfels' origin and counts groups.
static ewa_status lay_out(ewa_warp *warp, const ewa_depth_image *images, uint32_t count,
                          const ewa_warp_options *options, uint64_t *group_count, uint32_t *widest_px,
                          double origin_world[3]) {
    ewa_context *context = warp->context;
    EWA_TRY(ewa_buffer_reserve(context, &warp->source_buffer, count, sizeof *warp->sources));
    warp->sources = warp->source_buffer.data;
    warp->strip_count = 0;
    *group_count = *widest_px = 0;
    ewa_vec3 origin = vec3_make(0, 0, 0);
    for (uint32_t i = 0; i < count; i++) {
        ewa_warp_source *source = &warp->sources[i];
        *source = (ewa_warp_source){.first_group = *group_count, .first_strip = warp->strip_count};
        EWA_TRY(ewa_depth_image_choose(context, i, &images[i], &source->image));
        const ewa_camera *camera = &source->image.camera;
        set_source(source, options);
        const ewa_vec3 eye = set_pose(camera, source->lens.from_camera);
        if (i == 0) origin = eye;
        vec3_store(vec3_sub(eye, origin), source->eye);
        source->cells_x = (camera->width_px + EWA_WARP_CELL_PX - 1) / EWA_WARP_CELL_PX;
        source->strip_count = (camera->height_px + EWA_WARP_STRIP_PX - 1) / EWA_WARP_STRIP_PX;
        *group_count += (uint64_t)source->cells_x * source->strip_count;
        if (UINT32_MAX - warp->strip_count < source->strip_count || *group_count > UINT32_MAX)
            return ewa_fail(context, EWA_ERROR_LIMIT, "%u depth images are more than a renderer holds",
                            count);
        warp->strip_count += source->strip_count;
        if (camera->width_px > *widest_px) *widest_px = camera->width_px;
    }
    vec3_store(origin, origin_world);
    warp->source_count = count;
    return EWA_OK;
}

static const ewa_warp_source *source_of_strip(const ewa_warp *warp, uint32_t strip) {
    const ewa_warp_source *source = warp->sources;
    while (strip - source->first_strip >= source->strip_count) source++;
    return source;
}

static const void *row_of(const void *plane, size_t stride_bytes, uint32_t y) {
    return (const char *)plane + y * stride_bytes;
}

static void set_row_nan(const taking *t, float *keys) {
    for (size_t i = 0; i < t->stride; i++) keys[i] = NAN;
}

/// Keys of one row of a picture, NaN where there are none; `keys` points to the first of a row's numbers.
static void read_keys(const taking *t, const ewa_warp_source *source, uint32_t y, float *keys) {
    const ewa_depth_image *image = &source->image;
    const uint32_t width = image->camera.width_px;
    const ewa_warp_lens *lens = &source->lens;
    set_row_nan(t, keys);
    float *key = keys + EWA_WARP_FRONT;
    const void *row = row_of(image->depth, image->depth_stride_bytes, y);
    if (image->depth_type == EWA_U16) {
        const uint16_t *number = row;
        for (uint32_t x = 0; x < width; x++) key[x] = number[x] < UINT16_MAX ? (float)number[x] : 0.0f;
    } else {
        memcpy(key, row, width * sizeof *key);
    }
    const float scale = source->key_scale;
    if (image->kind == EWA_DEPTH_DISPARITY) {
        for (uint32_t x = 0; x < width; x++)
            key[x] = key[x] > 0 ? (key[x] + source->key_offset) * scale : NAN;
    } else if (image->kind == EWA_DEPTH_RAY) {
        const float slope_y = lens->ray_y[0] * (float)y + lens->ray_y[1];
        for (uint32_t x = 0; x < width; x++) {
            const float slope_x = lens->ray_x[0] * (float)x + lens->ray_x[1];
            key[x] = scale * sqrtf(1 + slope_x * slope_x + slope_y * slope_y) / key[x];
        }
    } else {
        for (uint32_t x = 0; x < width; x++) key[x] = scale / key[x];
    }
    const float low = source->key_low, high = source->key_high;
    for (uint32_t x = 0; x < width; x++) key[x] = key[x] >= low && key[x] <= high ? key[x] : NAN;
    if (!image->color || image->color_channel_count != 4) return;
    const void *colors = row_of(image->color, image->color_stride_bytes, y);
    for (uint32_t x = 0; x < width; x++) {
        const bool seen = image->color_type == EWA_U8 ? ((const uint8_t *)colors)[4 * x + 3] > 0
                                                      : ((const float *)colors)[4 * x + 3] > 0;
        if (!seen) key[x] = NAN;
    }
}

/// Light of a float colour: none where it is negative or NaN, and the largest half float where it is
/// infinite, which files of these have for all that is brighter.
static double light_of(float number) {
    if (!(number > 0)) return 0;
    return isfinite(number) ? (double)number : 65504;
}

/// Sets the float colours of the samples of a block; returns their form.
static uint16_t set_float_colors(const ewa_depth_image *image, uint32_t x, uint32_t y, uint32_t columns,
                                 uint32_t rows, ewa_packet *packet) {
    const uint32_t channels = image->color_channel_count;
    double light[EWA_PACKET_LANES][3] = {{0}};
    for (uint32_t r = 0; r < rows; r++) {
        const float *color =
            (const float *)row_of(image->color, image->color_stride_bytes, y + r) + (size_t)x * channels;
        for (uint32_t i = 4 * r; i < 4 * r + columns; i++, color += channels) {
            const float inverse = channels == 4 ? 1 / color[3] : 1;
            for (uint32_t c = 0; c < 3; c++) light[i][c] = light_of(color[channels > 1 ? c : 0] * inverse);
        }
    }
    const uint16_t form = ewa_color_form_choose((const double(*)[3])light, EWA_PACKET_LANES);
    uint16_t *const codes[3] = {packet->red, packet->green, packet->blue};
    ewa_color_encode(form, (const double(*)[3])light, EWA_PACKET_LANES, codes);
    return form;
}

/// Sets the colours of the samples of a block that are in the picture; returns their form.
static uint16_t set_colors(const taking *t, const ewa_depth_image *image, uint32_t x, uint32_t y,
                           ewa_packet *packet) {
    const uint32_t channels = image->color_channel_count, green = channels > 1, blue = 2 * green;
    const uint32_t columns = image->camera.width_px - x < 4 ? image->camera.width_px - x : 4;
    const uint32_t rows = image->camera.height_px - y < 4 ? image->camera.height_px - y : 4;
    if (image->color && image->color_type == EWA_F32)
        return set_float_colors(image, x, y, columns, rows, packet);
    for (uint32_t r = 0; r < rows; r++) {
        if (!image->color) {
            for (uint32_t i = 4 * r; i < 4 * r + columns; i++)
                packet->red[i] = packet->green[i] = packet->blue[i] = t->grey_code;
            continue;
        }
        const uint8_t *color =
            (const uint8_t *)row_of(image->color, image->color_stride_bytes, y + r) + (size_t)x * channels;
        for (uint32_t i = 4 * r; i < 4 * r + columns; i++, color += channels) {
            packet->red[i] = t->codes[color[0]];
            packet->green[i] = t->codes[color[green]];
            packet->blue[i] = t->codes[color[blue]];
        }
    }
    return EWA_COLOR_FORM_UNIT;
}

/// Reads keys of rows [first_y, first_y + count) of a picture, NaN outside of it.
static void read_rows(const taking *t, const ewa_warp_source *source, int64_t first_y, uint32_t count,
                      float *keys) {
    for (uint32_t i = 0; i < count; i++) {
        const int64_t y = first_y + i;
        if (y < 0 || y >= source->image.camera.height_px)
            set_row_nan(t, keys + i * t->stride);
        else
            read_keys(t, source, (uint32_t)y, keys + i * t->stride);
    }
}

/// Keys and slopes of a strip; returns how many samples were dropped as flying.
static uint64_t measure_strip(const taking *t, const ewa_warp_source *source, uint32_t first_y, float *memory,
                              ewa_warp_rows *rows) {
    const size_t stride = t->stride, plane = EWA_WARP_STRIP_PX * stride;
    const uint32_t count = source->cells_x * EWA_WARP_CELL_PX;
    float *keys = memory;
    *rows = (ewa_warp_rows){.keys = memory + MEASURED_ROWS * stride + EWA_WARP_FRONT, .stride = stride};
    rows->slope_x = rows->keys + plane;
    rows->slope_y = rows->slope_x + plane;
    rows->distance_x = rows->slope_y + plane;
    rows->distance_y = rows->distance_x + plane;
    const float noise = source->lens.noise;
    if (noise > 0) {
        float *noisy = rows->distance_y + plane - EWA_WARP_FRONT;
        read_rows(t, source, (int64_t)first_y - 2 * EWA_WARP_REACH, MEASURED_ROWS + 2 * EWA_WARP_REACH,
                  noisy);
        for (uint32_t i = 0; i < MEASURED_ROWS; i++) {
            set_row_nan(t, keys + i * stride);
            t->kernels->smooth(noise, noisy + (i + EWA_WARP_REACH) * stride + EWA_WARP_FRONT, stride, count,
                               keys + i * stride + EWA_WARP_FRONT);
        }
    } else {
        read_rows(t, source, (int64_t)first_y - EWA_WARP_REACH, MEASURED_ROWS, keys);
    }
    uint64_t dropped = 0;
    for (uint32_t i = 0; i < EWA_WARP_STRIP_PX; i++)
        dropped += t->kernels->slopes(&source->lens, keys + (i + EWA_WARP_REACH) * stride + EWA_WARP_FRONT,
                                      stride, count, rows, i * stride);
    return dropped;
}

/// Asks for the memory of a packet that is written soon: packets are far more than a cache holds.
static inline void prefetch_packet(const ewa_packet *packet) {
    enum { LINE_BYTES = 64 };
    for (size_t line = 0; line < sizeof *packet; line += LINE_BYTES)
        __builtin_prefetch((const char *)packet + line, 1);
}

/// Makes the surfels of one block; returns the mask of those that exist.
static uint16_t make_block(const taking *t, const ewa_warp_source *source, const ewa_warp_rows *rows,
                           uint32_t x, uint32_t y, uint64_t index) {
    ewa_surfels *surfels = &t->warp->grid.surfels;
    ewa_packet *packet = &surfels->packets[index];
    prefetch_packet(packet + PACKETS_AHEAD);
    float normal[3][16], axis_u[3][16], axis_v[3][16];
    const uint32_t mask = t->kernels->block(
        &source->lens, x, y, rows, y % EWA_WARP_STRIP_PX * rows->stride + x, packet, normal, axis_u, axis_v);
    if (!mask) return 0;
    t->warp->grid.kernels->code_ellipses((const float(*)[16])normal, (const float(*)[16])axis_u,
                                         (const float(*)[16])axis_v, packet);
    surfels->bounds.colors[index] = set_colors(t, &source->image, x, y, packet);
    return (uint16_t)mask;
}

static void grow_bounds(ewa_bounds *bounds, ewa_vec3 low, ewa_vec3 high) {
    const double lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    for (int c = 0; c < 3; c++) {
        bounds->low_world[c] = fmin(bounds->low_world[c], lows[c]);
        bounds->high_world[c] = fmax(bounds->high_world[c], highs[c]);
    }
}

static ewa_bounds no_bounds(void) {
    return (ewa_bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
}

static void take_strip(void *data, uint32_t strip, uint32_t worker) {
    const taking *t = data;
    ewa_warp *warp = t->warp;
    const ewa_warp_source *source = source_of_strip(warp, strip);
    const uint32_t cell_row = strip - source->first_strip, first_y = cell_row * EWA_WARP_STRIP_PX;
    strip_facts *facts = &t->strips[strip];
    ewa_warp_rows rows;
    float *memory = (float *)warp->row_buffer.data + worker * t->floats_per_worker;
    facts->flying_count = measure_strip(t, source, first_y, memory, &rows);
    facts->sample_count = 0;
    facts->centers = no_bounds();
    for (uint32_t cell = 0; cell < source->cells_x; cell++) {
        const uint64_t group = source->first_group + (uint64_t)cell_row * source->cells_x + cell;
        uint16_t masks[EWA_GRID_GROUP];
        for (uint32_t k = 0; k < EWA_GRID_GROUP; k++) {
            const uint32_t x = cell * EWA_WARP_CELL_PX + k % BLOCKS_PER_CELL * EWA_WARP_BLOCK_PX;
            const uint32_t y = first_y + k / BLOCKS_PER_CELL * EWA_WARP_BLOCK_PX;
            masks[k] = make_block(t, source, &rows, x, y, group * EWA_GRID_GROUP + k);
            facts->sample_count += (uint64_t)__builtin_popcount(masks[k]);
        }
        ewa_grid_end_group(&warp->grid, group, masks, source->eye);
        for (uint32_t k = 0; k < EWA_GRID_GROUP; k++) {
            if (!masks[k]) continue;
            const ewa_vec3 center =
                ewa_packet_center(&warp->grid.surfels, (uint32_t)(group * EWA_GRID_GROUP + k));
            grow_bounds(&facts->centers, center, center);
        }
    }
}

/// The kernels of a plane's grid sum to sigma^2 (1 - exp(-F^2 / 2)) in units of the spacing (docs/math.md
/// section 7); of sources that overlap, each alone covers.
static double unit_coverage(const ewa_warp_options *options) {
    const double sigma = options->radius_spacings / options->cutoff;
    return sigma * sigma * (1 - exp(-0.5 * options->cutoff * options->cutoff));
}

static ewa_status reserve(taking *t, uint64_t group_count, uint32_t widest_px,
                          const ewa_warp_options *options) {
    enum { ROWS = MEASURED_ROWS + 5 * EWA_WARP_STRIP_PX + MEASURED_ROWS + 2 * EWA_WARP_REACH };
    ewa_warp *warp = t->warp;
    ewa_context *context = warp->context;
    EWA_TRY(ewa_buffer_reserve(context, &warp->strip_buffer, warp->strip_count, sizeof *t->strips));
    t->strips = warp->strip_buffer.data;
    for (int i = 0; i < 256; i++) t->codes[i] = ewa_color_unit_code((double)ewa_srgb_decoded[i]);
    t->grey_code = ewa_color_unit_code(EWA_DEFAULT_GREY);
    t->stride = EWA_WARP_FRONT + ((size_t)widest_px + 15) / 16 * 16 + EWA_WARP_BACK;
    t->floats_per_worker = ROWS * t->stride;
    EWA_TRY(ewa_buffer_reserve(context, &warp->row_buffer, ewa_context_worker_count(context),
                               t->floats_per_worker * sizeof(float)));
    return ewa_grid_reserve(context, &warp->grid, group_count, options->cutoff);
}

ewa_status ewa_warp_create(ewa_context *context, ewa_warp **warp) {
    if (!context || !warp) return EWA_ERROR_ARGUMENT;
    *warp = NULL;
    ewa_warp *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    const ewa_status status = ewa_renderer_create(context, &made->renderer);
    if (status == EWA_OK)
        *warp = made;
    else
        ewa_warp_destroy(&made);
    return status;
}

void ewa_warp_destroy(ewa_warp **warp) {
    if (!warp || !*warp) return;
    ewa_warp *old = *warp;
    ewa_context *context = old->context;
    ewa_renderer_destroy(&old->renderer);
    ewa_grid_free(context, &old->grid);
    ewa_warp_nearest_free(context, &old->nearest);
    ewa_buffer *const buffers[] = {&old->source_buffer, &old->strip_buffer, &old->row_buffer,
                                   &old->surface_buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
    ewa_release(context, old, 1, sizeof *old);
    *warp = NULL;
}

ewa_status ewa_warp_take(ewa_warp *warp, const ewa_depth_image *images, uint32_t count,
                         const ewa_warp_options *options, ewa_warp_facts *facts) {
    if (!warp || !images || count == 0) return EWA_ERROR_ARGUMENT;
    ewa_context *context = warp->context;
    const double started_s = ewa_now_s();
    warp->source_count = 0;
    ewa_warp_options chosen;
    ewa_status status = ewa_warp_options_choose(context, options, &chosen);
    uint64_t group_count = 0;
    uint32_t widest_px = 0;
    double origin_world[3];
    if (status == EWA_OK)
        status = lay_out(warp, images, count, &chosen, &group_count, &widest_px, origin_world);
    taking t = {.warp = warp, .kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_warp_kernels)};
    if (status == EWA_OK) status = reserve(&t, group_count, widest_px, &chosen);
    if (status == EWA_OK) status = ewa_parallel_stoppable(context, "warp", take_strip, &t, warp->strip_count);
    if (status != EWA_OK) {
        warp->source_count = 0;
        return status;
    }
    ewa_surfels *surfels = &warp->grid.surfels;
    ewa_warp_facts all = {.pixel_count = 0};
    for (uint32_t i = 0; i < count; i++)
        all.pixel_count += (uint64_t)images[i].camera.width_px * images[i].camera.height_px;
    surfels->extent = no_bounds();
    for (uint32_t i = 0; i < warp->strip_count; i++) {
        const strip_facts *strip = &t.strips[i];
        all.sample_count += strip->sample_count;
        all.flying_count += strip->flying_count;
        grow_bounds(&surfels->extent, vec3_load(strip->centers.low_world),
                    vec3_load(strip->centers.high_world));
    }
    memcpy(surfels->origin_world, origin_world, sizeof origin_world);
    surfels->count = (uint32_t)all.sample_count;
    surfels->left_out_count = all.pixel_count - all.sample_count;
    surfels->unit_coverage = unit_coverage(&chosen);
    ewa_packets_sum_up(surfels);
    all.take_s = ewa_now_s() - started_s;
    if (facts) *facts = all;
    return EWA_OK;
}

/// What finishes pictures whose holes are wanted: they are drawn over nothing.
typedef struct finishing {
    const ewa_frame *frame;
    const float *surfaces; // premultiplied, over nothing
    float background[4];   // straight
    uint8_t *holes;
    size_t pixel_count;
} finishing;

static void finish_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const finishing *f = data;
    const float *background = f->background;
    const size_t end = (size_t)ewa_split(f->pixel_count, FINISH_PARTS, part + 1);
    for (size_t i = (size_t)ewa_split(f->pixel_count, FINISH_PARTS, part); i < end; i++) {
        const float *from = f->surfaces + 4 * i, through = background[3] * (1 - from[3]);
        f->holes[i] = from[3] < 0.5f ? 255 : 0;
        if (background[3] == 0) continue;
        const float alpha = from[3] + through, inverse = alpha > 0 ? 1 / alpha : 0;
        float light[3];
        for (int c = 0; c < 3; c++) light[c] = from[c] + background[c] * through;
        if (f->frame->rgba8) {
            for (int c = 0; c < 3; c++)
                f->frame->rgba8[4 * i + c] = ewa_srgb8_from_linear(light[c] * inverse);
            f->frame->rgba8[4 * i + 3] = (uint8_t)(255 * (alpha < 1 ? alpha : 1) + 0.5f);
        }
        if (f->frame->rgba) {
            memcpy(f->frame->rgba + 4 * i, light, sizeof light);
            f->frame->rgba[4 * i + 3] = alpha;
        }
    }
}

/// Draws over nothing, whose alpha tells the holes, and puts the background behind.
static ewa_status draw_with_holes(ewa_warp *warp, const ewa_camera *target, const ewa_render_options *options,
                                  const ewa_frame *frame, uint8_t *holes, ewa_render_stats *stats) {
    const size_t pixel_count = (size_t)target->width_px * target->height_px;
    ewa_frame drawn = *frame;
    if (!drawn.rgba) {
        EWA_TRY(
            ewa_buffer_reserve(warp->context, &warp->surface_buffer, pixel_count, 4 * sizeof *drawn.rgba));
        drawn.rgba = warp->surface_buffer.data;
    }
    finishing f = {.frame = frame, .surfaces = drawn.rgba, .holes = holes, .pixel_count = pixel_count};
    memcpy(f.background, options->background, sizeof f.background);
    ewa_render_options over_nothing = *options;
    memset(over_nothing.background, 0, sizeof over_nothing.background);
    if (f.background[3] > 0) drawn.rgba8 = NULL;
    EWA_TRY(ewa_render(warp->renderer, &warp->grid.surfels, target, &over_nothing, &drawn, stats));
    return ewa_parallel_stoppable(warp->context, "warp", finish_part, &f, FINISH_PARTS);
}

ewa_status ewa_warp_draw(ewa_warp *warp, const ewa_camera *target, ewa_warp_method method,
                         const ewa_render_options *options, const ewa_frame *frame, uint8_t *holes,
                         ewa_render_stats *stats) {
    if (!warp || !target || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = warp->context;
    if (warp->source_count == 0)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "warp: no depth image was taken");
    ewa_render_options standard, chosen;
    ewa_warp_render_options_init(&standard, sizeof standard);
    EWA_TRY(ewa_render_options_choose(context, options ? options : &standard, &chosen));
    EWA_TRY(ewa_camera_check(context, target));
    if (method == EWA_WARP_MCMILLAN) return ewa_warp_draw_nearest(warp, target, &chosen, frame, holes);
    if (method != EWA_WARP_HYBRID)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "warp: method %d is none of EWA_WARP_*", (int)method);
    if (holes) return draw_with_holes(warp, target, &chosen, frame, holes, stats);
    return ewa_render(warp->renderer, &warp->grid.surfels, target, &chosen, frame, stats);
}
