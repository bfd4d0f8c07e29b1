// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects: plane, checkerboard plane, cube, sphere, torus.
//
// The sphere's rows are those of Archimedes: area is height, z = 1 - 2 v. The torus's rows need the angle t
// (turns) whose share of the area is v = t + (r/R) sin(2 pi t) / (2 pi), which Newton's method finds.
#include "generate/generate.h"
#include "math/curvature.h"
#include "math/generate_number.h"

#include <math.h>

typedef struct palette {
    uint32_t count;
    float colors[8][3]; // sRGB, 0 to 255
} palette;

/// Colour at `place` in [0, 1] of a palette whose colours are evenly spaced.
static void blend_palette(const palette *colors, float place, float color[3]) {
    const float scaled = (place < 0 ? 0 : place > 1 ? 1 : place) * (float)(colors->count - 1);
    uint32_t index = (uint32_t)scaled;
    if (index > colors->count - 2) index = colors->count - 2;
    const float t = scaled - (float)index, smooth = t * t * (3 - 2 * t);
    for (int c = 0; c < 3; c++)
        color[c] =
            colors->colors[index][c] + smooth * (colors->colors[index + 1][c] - colors->colors[index][c]);
}

static bool is_dark_check(double u, double v, double checks) {
    return (ewa_generate_floor(u * checks) + ewa_generate_floor(v * checks)) & 1;
}

static void place_on_square(ewa_generate_block *block, uint32_t i) {
    const double position[3] = {block->u[i] - 0.5, block->v[i] - 0.5, 0}, normal[3] = {0, 0, 1};
    for (int c = 0; c < 3; c++) {
        block->position[i][c] = position[c];
        block->normal[i][c] = normal[c];
    }
    block->radius[i] = block->spacing;
}

void ewa_generate_plane(ewa_generate_block *block) {
    for (uint32_t i = 0; i < block->count; i++) {
        place_on_square(block, i);
        for (int c = 0; c < 3; c++) block->color[i][c] = 204;
    }
}

void ewa_generate_checker(ewa_generate_block *block, double checks) {
    for (uint32_t i = 0; i < block->count; i++) {
        place_on_square(block, i);
        const float grey = is_dark_check(block->u[i], block->v[i], checks) ? 0 : 255;
        for (int c = 0; c < 3; c++) block->color[i][c] = grey;
    }
}

void ewa_generate_cube(ewa_generate_block *block, double checks) {
    static const float light[6][3] = {{139, 195, 201}, {226, 132, 105}, {238, 196, 111},
                                      {132, 165, 157}, {150, 140, 190}, {242, 226, 196}};
    static const float dark[6][3] = {{38, 92, 110}, {140, 52, 44}, {160, 96, 30},
                                     {46, 79, 74},  {70, 58, 120}, {150, 116, 82}};
    const uint32_t axis = block->patch / 2;
    const double side = block->patch & 1 ? 1 : -1;
    for (uint32_t i = 0; i < block->count; i++) {
        const bool is_dark = is_dark_check(block->u[i], block->v[i], checks);
        for (int c = 0; c < 3; c++) {
            block->normal[i][c] = 0;
            block->color[i][c] = is_dark ? dark[block->patch][c] : light[block->patch][c];
        }
        block->normal[i][axis] = side;
        block->position[i][axis] = 0.5 * side;
        block->position[i][(axis + 1) % 3] = block->u[i] - 0.5;
        block->position[i][(axis + 2) % 3] = block->v[i] - 0.5;
        block->radius[i] = block->spacing;
    }
}

/// A banded planet: latitude, stirred by a few sines, looks up a palette.
static void color_planet(ewa_generate_block *block) {
    static const palette bands = {8,
                                  {{112, 92, 98},
                                   {176, 126, 92},
                                   {240, 226, 202},
                                   {188, 112, 72},
                                   {248, 238, 216},
                                   {214, 158, 104},
                                   {150, 88, 62},
                                   {124, 116, 128}}};
    float place[EWA_GENERATE_BLOCK];
    for (uint32_t i = 0; i < block->count; i++) {
        const float x = (float)block->normal[i][0], y = (float)block->normal[i][1],
                    z = (float)block->normal[i][2];
        const float east = x + 0.10f * ewa_generate_sin(0.7f * z + 0.4f * y);
        const float north = y + 0.10f * ewa_generate_sin(0.9f * z - 0.5f * x + 0.3f);
        const float curl = 0.25f * ewa_generate_sin(1.7f * north + 2.1f * z);
        const float swirl = ewa_generate_sin(1.1f * east + 0.7f * z + curl) +
                            0.5f * ewa_generate_sin(2.7f * north - 1.3f * z + 2 * curl);
        const float latitude = z + 0.022f * swirl;
        const float stripes = 0.08f * ewa_generate_sin(4.5f * latitude) +
                              0.035f * ewa_generate_sin(13 * latitude + 0.15f * swirl);
        place[i] = 0.5f + 0.48f * latitude + stripes;
    }
    for (uint32_t i = 0; i < block->count; i++) blend_palette(&bands, place[i], block->color[i]);
}

void ewa_generate_sphere(ewa_generate_block *block) {
    const uint32_t count = block->count;
    double sine[EWA_GENERATE_BLOCK], cosine[EWA_GENERATE_BLOCK];
    for (uint32_t i = 0; i < count; i++) ewa_generate_sincos(block->u[i], &sine[i], &cosine[i]);
    for (uint32_t i = 0; i < count; i++) {
        const double z = 1 - 2 * block->v[i], ring = sqrt(4 * block->v[i] * (1 - block->v[i]));
        const double normal[3] = {ring * cosine[i], ring * sine[i], z};
        for (int c = 0; c < 3; c++) {
            block->normal[i][c] = normal[c];
            block->position[i][c] = 0.5 * normal[c];
        }
        block->radius[i] = block->spacing;
        block->curvature[i] = 2;
    }
    color_planet(block);
}

/// Glazed ribbons that wind around the ring, with fine gold lines between them.
static void color_ribbons(ewa_generate_block *block, const double *tube_turns) {
    static const palette glaze = {
        6, {{18, 70, 92}, {42, 143, 148}, {238, 230, 210}, {233, 136, 102}, {176, 56, 70}, {18, 70, 92}}};
    static const float gold[3] = {232, 190, 96};
    float winding[EWA_GENERATE_BLOCK];
    for (uint32_t i = 0; i < block->count; i++) {
        const float around = (float)block->u[i], across = (float)tube_turns[i];
        winding[i] = 3 * around + across + 0.06f * ewa_generate_sin(3 * around - 2 * across) +
                     0.04f * ewa_generate_sin(5 * around + 3 * across);
    }
    for (uint32_t i = 0; i < block->count; i++) {
        blend_palette(&glaze, winding[i] - (float)ewa_generate_floor(winding[i]), block->color[i]);
        const float line = 10 * winding[i], off = line - (float)ewa_generate_floor(line) - 0.5f;
        const float share = 2 - 25 * (off < 0 ? -off : off), part = 0.8f * (share < 0   ? 0
                                                                            : share > 1 ? 1
                                                                                        : share);
        for (int c = 0; c < 3; c++) block->color[i][c] += part * (gold[c] - block->color[i][c]);
    }
}

/// Turns t of the tube's angle with t + (r/R) sin(2 pi t) / (2 pi) = area[i].
static void find_tube_turns(uint32_t count, const double *area, double *turns) {
    const double ratio = EWA_TORUS_MINOR / EWA_TORUS_MAJOR, circle = 6.283185307179586;
    for (uint32_t i = 0; i < count; i++) turns[i] = area[i];
    // Newton with the second-order term (Halley); the error falls from 0.07 to 1e-3, 1e-10, 1e-16.
    for (int step = 0; step < 3; step++) {
        for (uint32_t i = 0; i < count; i++) {
            double sine, cosine;
            ewa_generate_sincos(turns[i], &sine, &cosine);
            const double excess = turns[i] + ratio / circle * sine - area[i], slope = 1 + ratio * cosine;
            turns[i] -= excess / (slope + 0.5 * ratio * circle * sine * excess / slope);
        }
    }
}

void ewa_generate_torus(ewa_generate_block *block) {
    double turns[EWA_GENERATE_BLOCK], sine[EWA_GENERATE_BLOCK], cosine[EWA_GENERATE_BLOCK];
    double ring_x[EWA_GENERATE_BLOCK], ring_y[EWA_GENERATE_BLOCK];
    find_tube_turns(block->count, block->v, turns);
    for (uint32_t i = 0; i < block->count; i++) {
        ewa_generate_sincos(turns[i], &sine[i], &cosine[i]);
        ewa_generate_sincos(block->u[i], &ring_y[i], &ring_x[i]);
    }
    for (uint32_t i = 0; i < block->count; i++) {
        const double ring[3] = {ring_x[i], ring_y[i], 0};
        const double normal[3] = {cosine[i] * ring_x[i], cosine[i] * ring_y[i], sine[i]};
        for (int c = 0; c < 3; c++) {
            block->normal[i][c] = normal[c];
            block->position[i][c] = 0.5 * (EWA_TORUS_MAJOR * ring[c] + EWA_TORUS_MINOR * normal[c]);
        }
        block->radius[i] = block->spacing;
        const double around = cosine[i] / (EWA_TORUS_MAJOR + EWA_TORUS_MINOR * cosine[i]);
        block->curvature[i] = ewa_signed_curvature(2 / EWA_TORUS_MINOR, 2 * around);
    }
    color_ribbons(block, turns);
}
