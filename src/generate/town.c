// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects: a town of boxes with windows, trees of loose leaves, streets, lawns and what stands about: many small
// surfaces, one behind another, which are far below a pixel where the town is far away.
//
// The ground is cut into lots, with one box in each and streets around them. A tree is a trunk and a crown, whose leaves
// lie anywhere in the outer half of an ellipsoid and look roughly away from its middle. All patches have as many points as
// their area says.
#include "generate/generate.h"
#include "math/generate_number.h"

#include <assert.h>
#include <math.h>

enum { LOTS_X = 16, LOTS_Y = 10, SIDES = 4, TREES = 1400, FLOOR_WINDOWS = 6 };
static_assert(EWA_TOWN_PATCHES == 2 + LOTS_X * LOTS_Y * (SIDES + 1) + 2 * TREES, "every patch has a place");

/// As a part of the edge: the height of a floor, of the tallest of what stands about.
#define FLOOR_HEIGHT   0.010
#define SCATTER_HEIGHT 0.008

/// The ground's share in points that stand about.
#define SCATTER_SHARE 0.02

/// How much of a lot's sides is street.
#define STREET_SHARE 0.09

typedef struct lot_box {
    double low[2], size[2], height;
} lot_box;

/// The `k`-th number in [low, high) of thing `index`.
static double number(uint64_t seed, uint64_t index, uint32_t k, double low, double high) {
    const uint64_t random = ewa_generate_random(seed, 2000 + 16 * index + k);
    return low + (high - low) * ((double)(random >> 11) * 0x1p-53);
}

static lot_box box_of(uint64_t seed, uint32_t lot) {
    const double lot_size[2] = {1.0 / LOTS_X, 1.0 / LOTS_Y};
    const uint32_t at[2] = {lot % LOTS_X, lot / LOTS_X};
    lot_box box;
    for (uint32_t c = 0; c < 2; c++) {
        const double share = number(seed, lot, c, 0.4, 0.7), room = 1 - 2 * STREET_SHARE - share;
        box.size[c] = share * lot_size[c];
        box.low[c] = (at[c] + STREET_SHARE + number(seed, lot, 2 + c, 0, room)) * lot_size[c] - 0.5;
    }
    const double tall = number(seed, lot, 4, 0, 1);
    box.height = FLOOR_HEIGHT * (2 + ewa_generate_floor(9 * tall * tall));
    return box;
}

static void set_vector(double v[3], double x, double y, double z) { v[0] = x, v[1] = y, v[2] = z; }

/// A rectangle whose sides lie along two axes.
static ewa_town_patch flat_patch(ewa_town_kind kind, uint32_t thing, const double corner[3], const double along[3],
                                 const double across[3], const double normal[3]) {
    ewa_town_patch patch = {.kind = kind, .thing = thing};
    double length = 0, height = 0;
    for (int c = 0; c < 3; c++) {
        patch.corner[c] = corner[c], patch.along[c] = along[c], patch.across[c] = across[c],
        patch.normal[c] = normal[c];
        length += fabs(along[c]), height += fabs(across[c]);
    }
    patch.area = length * height, patch.height = height;
    return patch;
}

static uint32_t add_box(const lot_box *box, uint32_t lot, ewa_town_patch *patches) {
    double corner[3], along[3], up[3] = {0, 0, box->height}, normal[3];
    for (uint32_t side = 0; side < SIDES; side++) {
        const uint32_t axis = side / 2, other = 1 - axis;
        set_vector(corner, box->low[0], box->low[1], 0), set_vector(along, 0, 0, 0), set_vector(normal, 0, 0, 0);
        corner[axis] += side & 1 ? box->size[axis] : 0;
        along[other] = box->size[other];
        normal[axis] = side & 1 ? 1 : -1;
        patches[side] = flat_patch(EWA_TOWN_WALL, lot, corner, along, up, normal);
    }
    set_vector(corner, box->low[0], box->low[1], box->height), set_vector(normal, 0, 0, 1);
    set_vector(along, box->size[0], 0, 0), set_vector(up, 0, box->size[1], 0);
    patches[SIDES] = flat_patch(EWA_TOWN_ROOF, lot, corner, along, up, normal);
    return SIDES + 1;
}

/// Where a tree stands: beside the boxes, but for the few that find no place there.
static void place_tree(uint64_t seed, uint32_t tree, double at[2]) {
    for (uint32_t attempt = 0; attempt < 8; attempt++) {
        uint32_t lot[2];
        for (uint32_t c = 0; c < 2; c++) {
            at[c] = number(seed, LOTS_X * LOTS_Y + tree, 2 * attempt + c, -0.49, 0.49);
            lot[c] = (uint32_t)((at[c] + 0.5) * (c ? LOTS_Y : LOTS_X));
        }
        const lot_box box = box_of(seed, lot[1] * LOTS_X + lot[0]);
        const double x = (at[0] - box.low[0]) / box.size[0], y = (at[1] - box.low[1]) / box.size[1];
        if (x < -0.2 || x > 1.2 || y < -0.1 || y > 1.1) return;
    }
}

static uint32_t add_tree(uint64_t seed, uint32_t tree, ewa_town_patch *patches) {
    const double pi = 3.141592653589793;
    double at[2];
    place_tree(seed, tree, at);
    const uint64_t index = LOTS_X * LOTS_Y + TREES + (uint64_t)tree;
    const double radius = number(seed, index, 0, 0.0045, 0.010), height = radius * number(seed, index, 1, 1, 1.6);
    const double stem = radius * number(seed, index, 2, 0.6, 1.2), thickness = 0.12 * radius;
    ewa_town_patch crown = {
        .kind = EWA_TOWN_CROWN, .thing = tree, .area = 4 * pi * radius * height, .height = 2 * height};
    set_vector(crown.corner, at[0], at[1], stem + height), set_vector(crown.along, radius, radius, height);
    ewa_town_patch trunk = {.kind = EWA_TOWN_TRUNK, .thing = tree, .area = 2 * pi * thickness * (stem + height)};
    trunk.height = stem + height;
    set_vector(trunk.corner, at[0], at[1], 0), set_vector(trunk.along, thickness, thickness, stem + height);
    patches[0] = crown, patches[1] = trunk;
    return 2;
}

double ewa_town_make(uint64_t seed, ewa_town_patch *patches) {
    const double corner[3] = {-0.5, -0.5, 0}, along[3] = {1, 0, 0}, across[3] = {0, 1, 0}, up[3] = {0, 0, 1};
    uint32_t count = 0;
    patches[count++] = flat_patch(EWA_TOWN_GROUND, 0, corner, along, across, up);
    for (uint32_t lot = 0; lot < LOTS_X * LOTS_Y; lot++) {
        const lot_box box = box_of(seed, lot);
        count += add_box(&box, lot, patches + count);
    }
    for (uint32_t tree = 0; tree < TREES; tree++) count += add_tree(seed, tree, patches + count);
    patches[count] = flat_patch(EWA_TOWN_SCATTER, 0, corner, along, across, up);
    patches[count].area *= SCATTER_SHARE;
    double area = 0;
    for (uint32_t p = 0; p < EWA_TOWN_PATCHES; p++) area += patches[p].area;
    return area;
}

/// A direction, uniform on the sphere, of 32 random bits.
static void random_direction(uint64_t random, double direction[3]) {
    const double z = (double)(random & 0xffff) * 0x1p-15 - 1, ring = sqrt(1 - z * z);
    double sine, cosine;
    ewa_generate_sincos((double)(random >> 16 & 0xffff) * 0x1p-16, &sine, &cosine);
    set_vector(direction, ring * cosine, ring * sine, z);
}

static void color_point(float color[3], const float base[3], float light) {
    for (int c = 0; c < 3; c++) color[c] = base[c] * light;
}

/// Asphalt around the lots, with a bright line in its middle, lawns on them.
static void color_ground(double u, double v, float grain, float color[3]) {
    static const float lawn[3] = {112, 138, 72}, asphalt[3] = {92, 92, 96}, line[3] = {214, 210, 196};
    const double x = LOTS_X * u, y = LOTS_Y * v;
    const double off_x = fabs(x - ewa_generate_floor(x + 0.5)), off_y = fabs(y - ewa_generate_floor(y + 0.5));
    const double off = fmin(off_x * LOTS_Y / LOTS_X, off_y);
    if (off > 0.7 * STREET_SHARE * LOTS_Y / LOTS_X)
        color_point(color, lawn, 1 + 0.15f * grain);
    else
        color_point(color, off < 0.004 ? line : asphalt, 1 + 0.04f * grain);
}

/// Plaster or brick with a row of windows on each floor.
static void color_wall(const ewa_town_patch *patch, double u, double v, float grain, float color[3]) {
    static const float paints[6][3] = {{226, 214, 190}, {198, 120, 92}, {236, 236, 228},
                                       {214, 184, 122}, {172, 92, 76},  {178, 188, 196}};
    static const float glass[3] = {52, 66, 84};
    const double across = FLOOR_WINDOWS * u, up = v * patch->height / FLOOR_HEIGHT;
    const double x = across - ewa_generate_floor(across), y = up - ewa_generate_floor(up);
    const bool window = x > 0.28 && x < 0.72 && y > 0.3 && y < 0.8;
    color_point(color, window ? glass : paints[ewa_generate_random(7, patch->thing) % 6], 1 + 0.03f * grain);
}

static void place_flat(const ewa_town_patch *patch, ewa_generate_block *block, uint32_t i) {
    static const float roofs[4][3] = {{150, 72, 56}, {112, 110, 112}, {86, 88, 94}, {168, 160, 150}};
    const double u = block->u[i], v = block->v[i];
    for (int c = 0; c < 3; c++) {
        block->position[i][c] = patch->corner[c] + u * patch->along[c] + v * patch->across[c];
        block->normal[i][c] = patch->normal[c];
    }
    if (patch->kind == EWA_TOWN_GROUND)
        color_ground(u, v, block->grain[i], block->color[i]);
    else if (patch->kind == EWA_TOWN_WALL)
        color_wall(patch, u, v, block->grain[i], block->color[i]);
    else
        color_point(block->color[i], roofs[ewa_generate_random(8, patch->thing) % 4], 1 + 0.06f * block->grain[i]);
}

/// Bits of a point that its place in the patch does not tell.
static uint64_t bits_of(const ewa_generate_block *block, uint32_t i) {
    const uint64_t grain = (uint64_t)((block->grain[i] + 1) * 0x1p15f);
    return ewa_generate_random(block->patch, grain << 32 ^ (uint64_t)(block->u[i] * 0x1p31));
}

static void place_on_tree(const ewa_town_patch *patch, ewa_generate_block *block, uint32_t i) {
    static const float greens[4][3] = {{74, 112, 50}, {58, 96, 48}, {104, 128, 54}, {88, 104, 44}};
    static const float bark[3] = {96, 76, 58};
    double sine, cosine, out[3], turned[3];
    ewa_generate_sincos(block->u[i], &sine, &cosine);
    if (patch->kind == EWA_TOWN_TRUNK) {
        set_vector(block->position[i], patch->corner[0] + cosine * patch->along[0],
                   patch->corner[1] + sine * patch->along[1], block->v[i] * patch->along[2]);
        set_vector(block->normal[i], cosine, sine, 0);
        color_point(block->color[i], bark, 1 + 0.1f * block->grain[i]);
        return;
    }
    const uint64_t random = bits_of(block, i);
    const double z = 1 - 2 * block->v[i], ring = sqrt(4 * block->v[i] * (1 - block->v[i]));
    const double share = 0.5 + 0.5 * sqrt((double)(random >> 48) * 0x1p-16);
    set_vector(out, ring * cosine, ring * sine, z);
    random_direction(random, turned);
    double normal[3], length2 = 0;
    for (int c = 0; c < 3; c++) {
        block->position[i][c] = patch->corner[c] + share * out[c] * patch->along[c];
        normal[c] = out[c] + 0.8 * turned[c];
        length2 += normal[c] * normal[c];
    }
    for (int c = 0; c < 3; c++) block->normal[i][c] = normal[c] / sqrt(length2);
    color_point(block->color[i], greens[patch->thing % 4],
                (float)(0.35 + 0.65 * share) * (1 + 0.15f * block->grain[i]));
}

static void place_loose(ewa_generate_block *block, uint32_t i) {
    const uint64_t random = bits_of(block, i);
    const double height = (double)(random >> 48) * 0x1p-16;
    set_vector(block->position[i], block->u[i] - 0.5, block->v[i] - 0.5, SCATTER_HEIGHT * height * height);
    random_direction(random, block->normal[i]);
    for (uint32_t c = 0; c < 3; c++) block->color[i][c] = 40 + (float)(random >> (8 * c) & 0x7f);
}

void ewa_generate_town(const ewa_town_patch *patches, ewa_generate_block *block) {
    const ewa_town_patch *patch = &patches[block->patch];
    for (uint32_t i = 0; i < block->count; i++) {
        block->radius[i] = block->spacing;
        if (patch->kind == EWA_TOWN_CROWN || patch->kind == EWA_TOWN_TRUNK)
            place_on_tree(patch, block, i);
        else if (patch->kind == EWA_TOWN_SCATTER)
            place_loose(block, i);
        else
            place_flat(patch, block, i);
    }
}
