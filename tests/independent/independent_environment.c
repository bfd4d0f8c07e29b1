// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What mirrors show: a picture of all directions and its smaller copies, by what ewa/shade.h and
// image/environment.h say.
#include "tests/independent/independent.h"

#include <math.h>
#include <stdlib.h>

static const real PI = 3.141592653589793238463L;

static double *level_memory(const independent_level *level) {
    double *texels = calloc((size_t)3 * level->width * level->height, sizeof *texels);
    if (!texels) exit(1);
    return texels;
}

/// The part of texel i of a row of `width` that lies in [from, to), both of which may go around.
static double overlap(uint32_t i, uint32_t width, double from, double to) {
    double sum = 0;
    for (int turn = -2; turn <= 2; turn++) {
        const double begin = i + turn * (double)width;
        sum += fmax(0, fmin(begin + 1, to) - fmax(begin, from));
    }
    return sum;
}

/// Towards the poles texels are narrower than high: each becomes the mean of its row over as much as it is
/// high.
static void round_texels(independent_level *level) {
    double *rounded = level_memory(level);
    const uint32_t width = level->width, height = level->height;
    for (uint32_t y = 0; y < height; y++) {
        const double sine = sin((double)PI * (y + 0.5) / height);
        const double reach = fmin(width / (2.0 * height * sine), width);
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < 3; c++) {
                double sum = 0;
                for (uint32_t i = 0; i < width && reach > 1; i++)
                    sum += level->texels[3 * (y * width + i) + c] *
                           overlap(i, width, x + 0.5 - reach / 2, x + 0.5 + reach / 2);
                rounded[3 * (y * width + x) + c] =
                    reach > 1 ? sum / reach : level->texels[3 * (y * width + x) + c];
            }
    }
    free(level->texels);
    level->texels = rounded;
}

/// The mean over the sphere of what a texel of half the size covers.
static void halve(const independent_level *fine, independent_level *coarse) {
    const double columns = (double)fine->width / coarse->width, rows = (double)fine->height / coarse->height;
    for (uint32_t i = 0; i < coarse->width * coarse->height; i++) {
        const double left = i % coarse->width * columns, top = i / coarse->width * rows;
        double sum[3] = {0, 0, 0}, area = 0;
        for (uint32_t y = 0; y < fine->height; y++)
            for (uint32_t x = 0; x < fine->width; x++) {
                const double high = fmin(y + 1, top + rows) - fmax(y, top),
                             wide = fmin(x + 1, left + columns) - fmax(x, left);
                if (!(high > 0) || !(wide > 0)) continue;
                const double share = high * wide * sin((double)PI * (y + 0.5) / fine->height);
                for (int c = 0; c < 3; c++)
                    sum[c] += share * fine->texels[3 * (y * fine->width + x) + (uint32_t)c];
                area += share;
            }
        for (uint32_t c = 0; c < 3; c++) coarse->texels[3 * i + c] = sum[c] / area;
    }
}

void independent_environment_make(const ewa_image *sky, independent_environment *made) {
    *made = (independent_environment){.count = 0};
    uint32_t width = sky->width_px, height = sky->height_px;
    for (;;) {
        independent_level *level = &made->levels[made->count++];
        *level = (independent_level){width, height, NULL};
        level->texels = level_memory(level);
        if (made->count == 1)
            for (size_t i = 0; i < (size_t)width * height; i++)
                for (size_t c = 0; c < 3; c++)
                    level->texels[3 * i + c] =
                        (double)sky->pixels[sky->channel_count * i + (sky->channel_count < 3 ? 0 : c)];
        else
            halve(level - 1, level);
        round_texels(level);
        if (width == 1 && height == 1) return;
        width = (width + 1) / 2, height = (height + 1) / 2;
    }
}

void independent_environment_free(independent_environment *made) {
    for (uint32_t i = 0; i < made->count; i++) free(made->levels[i].texels);
    made->count = 0;
}

/// Between the four texels around a place of a level.
static real3 sample(const independent_level *level, real column, real row) {
    real3 sum = {0, 0, 0};
    const real left = floorl(column - 0.5L), top = floorl(row - 0.5L);
    for (int k = 0; k < 4; k++) {
        real x = left + k % 2, y = top + k / 2;
        const real share = (1 - fabsl(column - 0.5L - x)) * (1 - fabsl(row - 0.5L - y));
        // Over a pole the same row goes on, half way around.
        if (y < 0) y = 0, x += level->width / 2;
        if (y > level->height - 1) y = level->height - 1, x += level->width / 2;
        x -= level->width * floorl(x / level->width);
        const double *texel = level->texels + 3 * ((size_t)y * level->width + (size_t)x);
        sum = real3_add(sum, real3_times(real3_of(texel), share));
    }
    return sum;
}

static real3 look_up(const independent_environment *sky, real3 direction, real footprint) {
    const real longitude = atan2l(direction.x, direction.z);
    const real latitude = atan2l(direction.y, hypotl(direction.x, direction.z));
    const real texels = footprint * sky->levels[0].height / PI;
    real level = texels > 1 ? log2l(texels) : 0;
    if (level > sky->count - 1) level = sky->count - 1;
    const uint32_t fine = (uint32_t)level;
    real3 light = {0, 0, 0};
    for (uint32_t k = fine; k <= fine + 1 && k < sky->count; k++) {
        const independent_level *at = &sky->levels[k];
        const real share = 1 - fabsl(level - k);
        light = real3_add(light, real3_times(sample(at, at->width * (0.5L - longitude / (2 * PI)),
                                                    at->height * (0.5L - latitude / PI)),
                                             share));
    }
    return light;
}

/// Turns the world so that `up` becomes +y, the shortest way: the rotation is two mirrorings, the first at
/// the plane across `up`, the second at that half way to +y.
static real3 turned(const double up[3], real3 v) {
    const real3 from = real3_unit(real3_of(up)), to = {0, 1, 0};
    const real3 half_way = real3_add(from, to);
    if (real3_length(half_way) < 1e-12L) return (real3){v.x, -v.y, -v.z}; // upside down: around x
    const real3 middle = real3_unit(half_way);
    const real3 first = real3_add(v, real3_times(from, -2 * real3_dot(v, from)));
    return real3_add(first, real3_times(middle, -2 * real3_dot(first, middle)));
}

/// The direction of the environment that a surface mirrors.
static real3 mirrored(const ewa_render_options *options, const independent_surface *at) {
    const real3 back = real3_times(at->normal, 2 * real3_dot(at->normal, at->eye));
    return turned(options->environment_up, real3_add(back, real3_times(at->eye, -1)));
}

real3 independent_reflection(const independent_environment *sky, const ewa_render_options *options,
                             const independent_surface *at, const independent_surface *beside,
                             const independent_surface *below) {
    const real3 direction = mirrored(options, at);
    real footprint = 0;
    const independent_surface *others[2] = {beside, below};
    for (int k = 0; k < 2; k++) {
        if (!others[k]->there) continue;
        const real distance =
            real3_length(real3_add(direction, real3_times(mirrored(options, others[k]), -1)));
        if (distance > footprint) footprint = distance;
    }
    return look_up(sky, direction, footprint);
}
