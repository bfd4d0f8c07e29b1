// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Means of a picture under Gaussians: sums over pixels with Gaussian weights, on the picture or a copy of it
// that is so small that few pixels count.
//
// Along a row the logarithm of the weight is quadratic, so that the ratio of a weight to the one before
// changes by a constant factor: two multiplications per pixel instead of an exponential.
// Based on: P. S. Heckbert, "Fundamentals of Texture Mapping and Image Warping", 1989, section 3.5 (EWA).
#include "image/texture.h"
#include "base/base.h"
#include "math/gaussian.h"

/// Squared radius, in standard deviations, at which weights end: they are 0.0025 there.
#define REACH2 12.0

/// A Gaussian's variances differ by this factor at most.
#define MAX_ASPECT2 256.0

enum { ASKED_ROWS = 64 }; // between two questions of the progress callback

static uint32_t halved(uint32_t size) { return size / 2 + size % 2; }

static void add_level(ewa_texture *texture, const float *pixels, uint32_t channel_count, uint32_t width_px,
                      uint32_t height_px) {
    ewa_texture_level *level = &texture->levels[texture->level_count++];
    level->pixels = pixels;
    level->channel_count = channel_count;
    level->width_px = width_px;
    level->height_px = height_px;
    const ewa_texture_level *first = &texture->levels[0];
    level->scale[0] = (double)width_px / first->width_px;
    level->scale[1] = (double)height_px / first->height_px;
    for (int c = 0; c < 2; c++) level->blur[c] = (1 / (level->scale[c] * level->scale[c]) - 1) / 12;
}

/// Red, green, blue and alpha of a pixel.
static inline void read_pixel(const float *pixel, uint32_t channel_count, float color[4]) {
    for (uint32_t c = 0; c < 3; c++) color[c] = pixel[channel_count == 1 ? 0 : c];
    color[3] = channel_count == 4 ? pixel[3] : 1;
}

static const float *pixel_at(const ewa_texture_level *level, uint32_t x, uint32_t y) {
    return level->pixels + level->channel_count * ((size_t)y * level->width_px + x);
}

/// A copy without what is no number.
static ewa_status copy_finite(const ewa_image *image, ewa_texture *texture) {
    const size_t count = (size_t)image->width_px * image->height_px;
    float *pixels = ewa_allocate(texture->context, count, 4 * sizeof *pixels);
    if (!pixels) return EWA_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        read_pixel(image->pixels + i * image->channel_count, image->channel_count, pixels + 4 * i);
        for (size_t c = 4 * i; c < 4 * i + 4; c++)
            if (!isfinite(pixels[c])) pixels[c] = 0;
    }
    add_level(texture, pixels, 4, image->width_px, image->height_px);
    texture->owns_first = true;
    return EWA_OK;
}

/// Makes the first level: the image's own pixels, where all are numbers, for they may be large.
static ewa_status make_first(const ewa_image *image, ewa_texture *texture) {
    const size_t count = (size_t)image->width_px * image->height_px * image->channel_count;
    bool finite = true;
    for (size_t i = 0; i < count && finite; i++) finite = isfinite(image->pixels[i]);
    if (finite)
        add_level(texture, image->pixels, image->channel_count, image->width_px, image->height_px);
    else
        EWA_TRY(copy_finite(image, texture));
    const ewa_texture_level *first = &texture->levels[0];
    texture->opaque = true;
    for (size_t i = 3; i < count && first->channel_count == 4 && texture->opaque; i += 4)
        texture->opaque = first->pixels[i] >= 1;
    return EWA_OK;
}

/// What of a row of `from` pixels pixel `index` of `to` covers: the first pixel, and shares of up to three.
static void cover(uint32_t from, uint32_t to, uint32_t index, uint32_t *first, float share[3]) {
    const uint64_t low = (uint64_t)index * from, high = low + from; // in units of 1 / to
    *first = (uint32_t)(low / to);
    for (uint32_t i = 0; i < 3; i++) {
        const uint64_t a = ((uint64_t)*first + i) * to, b = a + to;
        const uint64_t begin = a > low ? a : low, end = b < high ? b : high;
        share[i] = end > begin ? (float)((double)(end - begin) / from) : 0;
    }
}

/// Fills the next level with means of one, 4 numbers a pixel. Errors: EWA_CANCELLED.
static ewa_status shrink(ewa_context *context, const ewa_texture_level *from, uint32_t width_px, uint32_t height_px, float *to) {
    for (uint32_t y = 0; y < height_px; y++) {
        if (y % ASKED_ROWS == 0) EWA_TRY(ewa_progress(context, "texture", 0));
        uint32_t first_y, first_x;
        float share_y[3], share_x[3];
        cover(from->height_px, height_px, y, &first_y, share_y);
        for (uint32_t x = 0; x < width_px; x++) {
            cover(from->width_px, width_px, x, &first_x, share_x);
            float sum[4] = {0};
            for (uint32_t j = 0; j < 3; j++) {
                for (uint32_t i = 0; i < 3; i++) {
                    const float share = share_x[i] * share_y[j];
                    if (share == 0) continue; // also: no such pixel
                    float color[4];
                    read_pixel(pixel_at(from, first_x + i, first_y + j), from->channel_count, color);
                    for (int c = 0; c < 4; c++) sum[c] += share * color[c];
                }
            }
            memcpy(to + 4 * ((size_t)y * width_px + x), sum, sizeof sum);
        }
    }
    return EWA_OK;
}

ewa_status ewa_texture_make(const ewa_image *image, ewa_texture_wrap wrap_s, ewa_texture_wrap wrap_t,
                            ewa_texture *texture) {
    *texture = (ewa_texture){.context = image->context};
    if (image->channel_count != 1 && image->channel_count != 3 && image->channel_count != 4)
        return ewa_fail(image->context, EWA_ERROR_ARGUMENT,
                        "texture: a picture of %u channels, must be 1, 3 or 4", image->channel_count);
    texture->repeats[0] = wrap_s == EWA_TEXTURE_REPEAT;
    texture->repeats[1] = wrap_t == EWA_TEXTURE_REPEAT;
    ewa_status status = make_first(image, texture);
    while (status == EWA_OK && texture->level_count < EWA_TEXTURE_LEVELS) {
        const ewa_texture_level *last = &texture->levels[texture->level_count - 1];
        if (last->width_px == 1 && last->height_px == 1) break;
        const uint32_t width = halved(last->width_px), height = halved(last->height_px);
        float *pixels = ewa_allocate(texture->context, (size_t)width * height, 4 * sizeof *pixels);
        if (!pixels) {
            status = EWA_ERROR_MEMORY;
            break;
        }
        status = shrink(texture->context, last, width, height, pixels);
        add_level(texture, pixels, 4, width, height); // in any case, so that it is freed
    }
    if (status != EWA_OK) ewa_texture_free(texture);
    return status;
}

void ewa_texture_free(ewa_texture *texture) {
    for (uint32_t l = texture->owns_first ? 0 : 1; l < texture->level_count; l++) {
        ewa_texture_level *level = &texture->levels[l];
        ewa_release(texture->context, (float *)(uintptr_t)level->pixels, (size_t)level->width_px * level->height_px,
                    4 * sizeof *level->pixels);
    }
    *texture = (ewa_texture){0};
}

/// The smaller and the larger eigenvalue.
static void eigenvalues(double xx, double xy, double yy, double *minimum, double *maximum) {
    const double middle = 0.5 * (xx + yy), half = sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    *maximum = middle + half;
    *minimum = *maximum > 0 ? (xx * yy - xy * xy) / *maximum : 0;
}

void ewa_texture_round(ewa_texture_gauss *gauss) {
    double minimum, maximum;
    eigenvalues(gauss->xx_px2, gauss->xy_px2, gauss->yy_px2, &minimum, &maximum);
    const double more = (maximum - MAX_ASPECT2 * minimum) / (MAX_ASPECT2 - 1);
    if (!(more > 0)) return;
    gauss->xx_px2 += more;
    gauss->yy_px2 += more;
}

/// The Gaussian in pixels of a level, without what the level's boxes have blurred already.
static ewa_texture_gauss on_level(const ewa_texture_level *level, const ewa_texture_gauss *gauss) {
    return (ewa_texture_gauss){
        gauss->x_px * level->scale[0],
        gauss->y_px * level->scale[1],
        (gauss->xx_px2 - level->blur[0]) * level->scale[0] * level->scale[0],
        gauss->xy_px2 * level->scale[0] * level->scale[1],
        (gauss->yy_px2 - level->blur[1]) * level->scale[1] * level->scale[1],
    };
}

uint32_t ewa_texture_level_of(const ewa_texture *texture, const ewa_texture_gauss *gauss) {
    uint32_t level = 0;
    for (; level + 1 < texture->level_count; level++) {
        const ewa_texture_gauss next = on_level(&texture->levels[level + 1], gauss);
        double minimum, maximum;
        eigenvalues(next.xx_px2, next.xy_px2, next.yy_px2, &minimum, &maximum);
        if (!(minimum >= 1)) break;
    }
    return level;
}

static uint32_t wrap(int64_t index, uint32_t size, bool repeats) {
    if (index >= 0 && index < size) return (uint32_t)index;
    if (!repeats) return index < 0 ? 0 : size - 1;
    const int64_t rest = index % size;
    return (uint32_t)(rest < 0 ? rest + size : rest);
}

/// A run of pixels of one row. `weight` is that of the first, `ratio` the second's over it, which changes by the
/// factor `bend` from pixel to pixel.
typedef struct pixel_run {
    const float *row;
    int64_t first, last;
    uint32_t width;
    bool repeats;
    double weight, ratio, bend;
} pixel_run;

/// Adds a run, for each number of channels by itself.
static inline void add_channels(const pixel_run *run, uint32_t channel_count, double total[5]) {
    float sum[5] = {0}, color[4];
    double weight = run->weight, ratio = run->ratio;
    const bool is_inside = run->first >= 0 && run->last < run->width;
    for (int64_t x = run->first; x <= run->last; x++) {
        const size_t column = is_inside ? (size_t)x : wrap(x, run->width, run->repeats);
        const float w = (float)weight;
        read_pixel(run->row + channel_count * column, channel_count, color);
        for (int c = 0; c < 4; c++) sum[c] += w * color[c];
        sum[4] += w;
        weight *= ratio;
        ratio *= run->bend;
    }
    for (int c = 0; c < 5; c++) total[c] += (double)sum[c];
}

static void add_run(const pixel_run *run, uint32_t channel_count, double total[5]) {
    if (channel_count == 4)
        add_channels(run, 4, total);
    else if (channel_count == 3)
        add_channels(run, 3, total);
    else
        add_channels(run, 1, total);
}

/// A side of the Gaussian that is many times the picture's needs no more: everything is under it already.
static void bound_side(double *variance, double *mixed, uint32_t size) {
    const double maximum = 4.0 * size + 16;
    if (!(*variance > maximum * maximum)) return;
    *mixed *= maximum / sqrt(*variance);
    *variance = maximum * maximum;
}

void ewa_texture_nearest(const ewa_texture *texture, double x_px, double y_px, double color[4]) {
    const ewa_texture_level *level = &texture->levels[0];
    const double reach = 0x1p62; // beyond, all places are alike
    const uint32_t x = wrap((int64_t)fmin(fmax(floor(x_px), -reach), reach), level->width_px,
                            texture->repeats[0]),
                   y = wrap((int64_t)fmin(fmax(floor(y_px), -reach), reach), level->height_px,
                            texture->repeats[1]);
    float found[4];
    read_pixel(pixel_at(level, x, y), level->channel_count, found);
    for (int c = 0; c < 4; c++) color[c] = (double)found[c];
}

void ewa_texture_mean(const ewa_texture *texture, uint32_t index, const ewa_texture_gauss *gauss,
                      double color[4]) {
    const ewa_texture_level *level = &texture->levels[index];
    ewa_texture_gauss g = on_level(level, gauss);
    if (level->width_px == 1 && level->height_px == 1) {
        float found[4];
        read_pixel(level->pixels, level->channel_count, found);
        for (int c = 0; c < 4; c++) color[c] = (double)found[c];
        return;
    }
    bound_side(&g.xx_px2, &g.xy_px2, level->width_px);
    bound_side(&g.yy_px2, &g.xy_px2, level->height_px);
    const double determinant = g.xx_px2 * g.yy_px2 - g.xy_px2 * g.xy_px2;
    const double a = g.yy_px2 / determinant, b = -g.xy_px2 / determinant, c = g.xx_px2 / determinant;
    // Also false for what is not finite, and for places at which pixels are no longer told apart.
    if (!(determinant > 0 && g.xx_px2 > 0 && fabs(g.x_px) < 0x1p50 && fabs(g.y_px) < 0x1p50)) {
        ewa_texture_nearest(texture, gauss->x_px, gauss->y_px, color);
        return;
    }
    const double half_height = sqrt(REACH2 * g.yy_px2), bend = ewa_exp(-a);
    double sum[5] = {0};
    const int64_t low = (int64_t)ceil(g.y_px - half_height - 0.5),
                  high = (int64_t)floor(g.y_px + half_height - 0.5);
    for (int64_t y = low; y <= high; y++) {
        const double dy = (double)y + 0.5 - g.y_px;
        const double room = (REACH2 - dy * dy / g.yy_px2) / a;
        if (!(room >= 0)) continue;
        const double middle = g.x_px - b / a * dy, half_width = sqrt(room);
        const int64_t first = (int64_t)ceil(middle - half_width - 0.5),
                      last = (int64_t)floor(middle + half_width - 0.5);
        if (first > last) continue;
        const double dx = (double)first + 0.5 - g.x_px;
        const double weight = ewa_exp(-0.5 * (a * dx * dx + 2 * b * dx * dy + c * dy * dy));
        const double ratio = ewa_exp(-0.5 * a * (2 * dx + 1) - b * dy);
        const uint32_t line = wrap(y, level->height_px, texture->repeats[1]);
        const pixel_run run = {pixel_at(level, 0, line), first,  last, level->width_px,
                               texture->repeats[0],      weight, ratio, bend};
        add_run(&run, level->channel_count, sum);
    }
    if (!(sum[4] > 0)) {
        ewa_texture_nearest(texture, gauss->x_px, gauss->y_px, color);
        return;
    }
    for (int k = 0; k < 4; k++) color[k] = sum[k] / sum[4];
}
