// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects: a fractal landscape with water, sand, grass, rock and snow.
//
// Heights are a sum of gradient noise: the two coarsest octaves make land and sea, and where there is land a
// ridged multifractal makes mountains. Every step carries its derivatives along, so that the normals are
// exact. Based on: K. Perlin, "Improving noise", 2002 (the quintic fade); F. K. Musgrave in Ebert et al.,
// "Texturing and Modeling: A Procedural Approach", 3rd ed. 2003, chapter 16 (ridged multifractal); here with
// smooth crests.
#include "generate/generate.h"
#include "math/generate_number.h"

#include <math.h>
#include <string.h>

/// Octaves that make land and sea; the others make mountains. The coarsest has BASE_CELLS cells along the
/// edge.
enum { LAND_OCTAVES = 2 };
#define BASE_CELLS 2.5

/// Height of a full mountain and of the land below it, as parts of the edge.
#define MOUNTAIN_HEIGHT 0.15f
#define LAND_HEIGHT     0.10f
#define LAND_LIFT       0.012f

/// How much flatter each octave is, and how round its crests are (1: cones would be sharp at 0).
#define GAIN        0.41f
#define CREST_WIDTH 0.05f

void ewa_terrain_init(ewa_terrain *terrain, uint64_t seed, uint64_t point_count) {
    const double finest = 0.5 * sqrt((double)point_count);
    // Each octave is turned by the angle of the triangle 3, 4, 5, so that lattices never line up.
    double scale = BASE_CELLS, cosine = 1, sine = 0;
    uint32_t count = 0;
    while (count < EWA_TERRAIN_MAX_OCTAVES && (count <= LAND_OCTAVES || scale <= finest)) {
        const uint64_t random = ewa_generate_random(seed, 1000 + count);
        terrain->octaves[count++] = (ewa_terrain_octave){
            .xx = (float)(scale * cosine),
            .xy = (float)(-scale * sine),
            .x0 = (float)(random >> 48) * 0x1p-16f,
            .yx = (float)(scale * sine),
            .yy = (float)(scale * cosine),
            .y0 = (float)(random >> 32 & 0xffff) * 0x1p-16f,
            .key = (uint32_t)random,
        };
        const double turned = 0.8 * cosine - 0.6 * sine;
        sine = 0.6 * cosine + 0.8 * sine;
        cosine = turned;
        scale *= 2;
    }
    terrain->octave_count = count;
}

/// Random bits for a lattice corner; `mixed` differs per corner. One multiplication: integer products are
/// what a vector of the plain instruction set is slowest at.
static inline uint32_t hash_corner(uint32_t mixed) {
    mixed ^= mixed >> 15;
    mixed *= 0x2c1b3c6du;
    return mixed ^ mixed >> 16;
}

/// The two numbers of a corner, in [-2^31, 2^31): its gradient times 2^31.
static inline float gradient_x(uint32_t hash) { return (float)(int32_t)(hash << 16); }
static inline float gradient_y(uint32_t hash) { return (float)(int32_t)hash; }

/// Gradient noise of one octave, about [-0.7, 0.7], with its derivatives by x and y.
static void evaluate_octave(const ewa_terrain_octave *octave, uint32_t count, const float *restrict x,
                            const float *restrict y, float *restrict value, float *restrict by_x,
                            float *restrict by_y) {
    const ewa_terrain_octave o = *octave;
    for (uint32_t i = 0; i < count; i++) {
        const float lattice_x = o.xx * x[i] + o.xy * y[i] + o.x0,
                    lattice_y = o.yx * x[i] + o.yy * y[i] + o.y0;
        int32_t cell_x = (int32_t)lattice_x, cell_y = (int32_t)lattice_y;
        cell_x -= lattice_x < (float)cell_x;
        cell_y -= lattice_y < (float)cell_y;
        const uint32_t mixed_x = (uint32_t)cell_x * 0x8da6b343u, next_x = mixed_x + 0x8da6b343u;
        const uint32_t mixed_y = (uint32_t)cell_y * 0xd8163841u, next_y = mixed_y + 0xd8163841u;
        const uint32_t h00 = hash_corner((mixed_x ^ mixed_y) + o.key),
                       h10 = hash_corner((next_x ^ mixed_y) + o.key);
        const uint32_t h01 = hash_corner((mixed_x ^ next_y) + o.key),
                       h11 = hash_corner((next_x ^ next_y) + o.key);
        const float s = lattice_x - (float)cell_x, t = lattice_y - (float)cell_y;
        const float fade_s = s * s * s * (s * (s * 6 - 15) + 10), slope_s = 30 * s * s * (s * (s - 2) + 1);
        const float fade_t = t * t * t * (t * (t * 6 - 15) + 10), slope_t = 30 * t * t * (t * (t - 2) + 1);
        const float x00 = gradient_x(h00), x10 = gradient_x(h10), x01 = gradient_x(h01),
                    x11 = gradient_x(h11);
        const float y00 = gradient_y(h00), y10 = gradient_y(h10), y01 = gradient_y(h01),
                    y11 = gradient_y(h11);
        const float v00 = x00 * s + y00 * t, v10 = x10 * (s - 1) + y10 * t;
        const float v01 = x01 * s + y01 * (t - 1), v11 = x11 * (s - 1) + y11 * (t - 1);
        // value = v00 + fade_s a + fade_t b + fade_s fade_t c, and likewise for the gradient's two numbers
        const float a = v10 - v00, b = v01 - v00, c = v11 - v10 - b, fade = fade_s * fade_t;
        const float by_s = x00 + fade_s * (x10 - x00) + fade_t * (x01 - x00) +
                           fade * (x11 - x10 - (x01 - x00)) + slope_s * (a + fade_t * c);
        const float by_t = y00 + fade_s * (y10 - y00) + fade_t * (y01 - y00) +
                           fade * (y11 - y10 - (y01 - y00)) + slope_t * (b + fade_s * c);
        value[i] = 0x1p-31f * (v00 + fade_s * a + fade_t * b + fade * c);
        by_x[i] = 0x1p-31f * (by_s * o.xx + by_t * o.yx);
        by_y[i] = 0x1p-31f * (by_s * o.xy + by_t * o.yy);
    }
}

static inline float clamp_unit(float value) { return value < 0 ? 0 : value > 1 ? 1 : value; }

void ewa_terrain_evaluate(const ewa_terrain *terrain, uint32_t count, const double *x, const double *y,
                          ewa_terrain_heights *heights) {
    float at_x[EWA_GENERATE_BLOCK], at_y[EWA_GENERATE_BLOCK];
    for (uint32_t i = 0; i < count; i++) {
        at_x[i] = (float)x[i];
        at_y[i] = (float)y[i];
    }
    float noise[EWA_GENERATE_BLOCK], noise_x[EWA_GENERATE_BLOCK], noise_y[EWA_GENERATE_BLOCK];
    float land[EWA_GENERATE_BLOCK] = {0}, land_x[EWA_GENERATE_BLOCK] = {0}, land_y[EWA_GENERATE_BLOCK] = {0};
    float weight[EWA_GENERATE_BLOCK], weight_x[EWA_GENERATE_BLOCK] = {0}, weight_y[EWA_GENERATE_BLOCK] = {0};
    float ridges[EWA_GENERATE_BLOCK] = {0}, ridges_x[EWA_GENERATE_BLOCK] = {0},
          ridges_y[EWA_GENERATE_BLOCK] = {0};
    float amplitude = 1;
    for (uint32_t k = 0; k < LAND_OCTAVES; k++, amplitude *= 0.5f) {
        evaluate_octave(&terrain->octaves[k], count, at_x, at_y, noise, noise_x, noise_y);
        for (uint32_t i = 0; i < count; i++) {
            land[i] += amplitude * noise[i];
            land_x[i] += amplitude * noise_x[i];
            land_y[i] += amplitude * noise_y[i];
        }
    }
    for (uint32_t i = 0; i < count; i++) weight[i] = 1;
    amplitude = 1;
    for (uint32_t k = LAND_OCTAVES; k < terrain->octave_count; k++, amplitude *= GAIN) {
        evaluate_octave(&terrain->octaves[k], count, at_x, at_y, noise, noise_x, noise_y);
        for (uint32_t i = 0; i < count; i++) {
            // signal = (1 - |noise|)^2 weight, |noise| rounded at 0; the next weight is 2 signal within [0,
            // 1].
            const float size = sqrtf(noise[i] * noise[i] + CREST_WIDTH * CREST_WIDTH), crest = 1 - size;
            const float turn = -2 * crest * noise[i] / size, height = crest * crest;
            const float signal = height * weight[i];
            const float signal_x = turn * noise_x[i] * weight[i] + height * weight_x[i];
            const float signal_y = turn * noise_y[i] * weight[i] + height * weight_y[i];
            ridges[i] += amplitude * signal;
            ridges_x[i] += amplitude * signal_x;
            ridges_y[i] += amplitude * signal_y;
            const float open = 2 * signal < 1 ? 2 : 0;
            weight[i] = clamp_unit(2 * signal);
            weight_x[i] = open * signal_x;
            weight_y[i] = open * signal_y;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        // Mountains fade in over land between -0.15 and 0.55.
        const float raw = (land[i] + 0.15f) / 0.7f, m = clamp_unit(raw);
        const float mask = m * m * (3 - 2 * m), mask_slope = 6 * m * (1 - m) / 0.7f;
        const float peaks = MOUNTAIN_HEIGHT * (ridges[i] - 0.6f);
        heights->height[i] = LAND_HEIGHT * land[i] + mask * peaks + LAND_LIFT;
        heights->by_x[i] =
            (LAND_HEIGHT + mask_slope * peaks) * land_x[i] + mask * MOUNTAIN_HEIGHT * ridges_x[i];
        heights->by_y[i] =
            (LAND_HEIGHT + mask_slope * peaks) * land_y[i] + mask * MOUNTAIN_HEIGHT * ridges_y[i];
        heights->texture[i] = noise[i];
    }
}

/// Rises smoothly from 0 at `low` to 1 at `low` + 1 / `rate`.
static float smooth_step(float low, float rate, float value) {
    const float t = clamp_unit((value - low) * rate);
    return t * t * (3 - 2 * t);
}

static void blend(float color[3], const float over[3], float share) {
    for (int c = 0; c < 3; c++) color[c] += share * (over[c] - color[c]);
}

/// Colour from height, the normal's z and two noises of [-1, 1].
static void color_ground(float height, float upright, float texture, float grain, float color[3]) {
    static const float sand[3] = {218, 200, 154}, meadow[3] = {132, 152, 78}, forest[3] = {62, 96, 54};
    static const float rock[3] = {124, 114, 106}, scree[3] = {164, 152, 134}, snow[3] = {247, 249, 252};
    static const float shallow[3] = {98, 178, 184}, deep[3] = {20, 66, 112};
    if (height < 0) {
        memcpy(color, shallow, sizeof shallow);
        blend(color, deep, smooth_step(0, 30, -height));
        for (int c = 0; c < 3; c++) color[c] += 2 * grain;
        return;
    }
    const float ragged = height + 0.010f * texture;
    memcpy(color, sand, sizeof sand);
    blend(color, meadow, smooth_step(0.002f, 200, ragged));
    blend(color, forest, smooth_step(0.008f, 40, ragged + 0.008f * grain));
    blend(color, scree, smooth_step(0.048f, 40, ragged));
    blend(color, rock, 1 - smooth_step(0.66f, 6, upright + 0.04f * texture));
    blend(color, snow, smooth_step(0.078f, 40, ragged) * smooth_step(0.46f, 5, upright));
    const float light = 1 + 0.05f * grain + 0.10f * texture;
    for (int c = 0; c < 3; c++) color[c] *= light;
}

void ewa_generate_terrain(const ewa_terrain *terrain, ewa_generate_block *block) {
    ewa_terrain_heights heights;
    ewa_terrain_evaluate(terrain, block->count, block->u, block->v, &heights);
    for (uint32_t i = 0; i < block->count; i++) {
        const bool is_water = heights.height[i] < 0;
        const double slope_x = is_water ? 0 : heights.by_x[i], slope_y = is_water ? 0 : heights.by_y[i];
        const double steepness = slope_x * slope_x + slope_y * slope_y, upright = 1 / sqrt(1 + steepness);
        const double position[3] = {block->u[i] - 0.5, block->v[i] - 0.5, is_water ? 0 : heights.height[i]};
        const double normal[3] = {-slope_x * upright, -slope_y * upright, upright};
        for (int c = 0; c < 3; c++) {
            block->position[i][c] = position[c];
            block->normal[i][c] = normal[c];
        }
        // A cell of the ground is 1 by 1/upright on the slope: the radius grows as its diagonal does.
        block->radius[i] = block->spacing * sqrt(1 + 0.5 * steepness);
        color_ground(heights.height[i], (float)upright, heights.texture[i], block->grain[i], block->color[i]);
    }
}
