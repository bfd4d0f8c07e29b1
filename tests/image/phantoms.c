// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes like those of scanners.
#include "image/phantoms.h"
#include "check.h"
#include "image/transfer.h"

#include <math.h>

enum { SIDE = PHANTOM_SIDE, LAYER = SIDE * SIDE };

static const double MIDDLE = 0.5 * (SIDE - 1);

static int place(int i, int j, int k) { return (k * SIDE + j) * SIDE + i; }

phantom phantom_make(double air) {
    phantom scene = {malloc(PHANTOM_VOXELS * sizeof(float)), calloc(PHANTOM_VOXELS, 1)};
    assert_true(scene.values && scene.material);
    for (int i = 0; i < PHANTOM_VOXELS; i++) scene.values[i] = (float)air;
    return scene;
}

void phantom_free(phantom *scene) {
    free(scene->values);
    free(scene->material);
    *scene = (phantom){NULL, NULL};
}

static void set(phantom *scene, int at, double value, int material) {
    scene->values[at] = (float)value;
    scene->material[at] = (uint8_t)material;
}

/// The place of a voxel from the middle of the lowest face, z up.
static void place_of(int at, double place[3]) {
    place[0] = at % SIDE - MIDDLE;
    place[1] = at / SIDE % SIDE - MIDDLE;
    place[2] = at / LAYER;
}

static bool in_box(double x, double y, double z, double half_x, double half_y, double low, double high) {
    return fabs(x) < half_x && fabs(y) < half_y && z > low && z < high;
}

static double trunk_x(double z) { return 5 * sin((z - 20) / 11); }

/// A twig from the trunk outwards, with leaves: flat pieces, two voxels by five by five.
static void add_branch(phantom *scene, check_random *random, double leaves, double wood) {
    const double height = check_uniform(random, 42, 76), angle = check_uniform(random, 0, 6.283);
    const double length = check_uniform(random, 12, 27);
    for (double t = 0; t <= 1; t += 0.7 / length) {
        const double x = trunk_x(height) + cos(angle) * length * t + MIDDLE;
        const double y = sin(angle) * length * t + MIDDLE, z = height + 6 * t;
        for (int n = 0; n < 8; n++)
            set(scene, place((int)x + (n & 1), (int)y + (n >> 1 & 1), (int)z + (n >> 2)), wood, PHANTOM_WOOD);
        for (int leaf = 0; leaf < 4 && t > 0.3; leaf++) {
            const int flat = (int)check_uniform(random, 0, 3);
            const int at[3] = {(int)(x + check_uniform(random, -6, 6)),
                               (int)(y + check_uniform(random, -6, 6)),
                               (int)(z + check_uniform(random, -6, 6))};
            for (int n = 0; n < 75; n++) {
                const int step[3] = {n % 5 - 2, n / 5 % 5 - 2, n / 25};
                const int voxel = place(at[0] + step[(3 - flat) % 3], at[1] + step[(4 - flat) % 3],
                                        at[2] + step[(5 - flat) % 3]);
                if (scene->material[voxel] == PHANTOM_AIR) set(scene, voxel, leaves, PHANTOM_LEAVES);
            }
        }
    }
}

void phantom_add_bonsai(phantom *scene, double leaves, double wood, double earth, double pot) {
    for (int at = 0; at < PHANTOM_VOXELS; at++) {
        double p[3];
        place_of(at, p);
        const double x = p[0], y = p[1], z = p[2];
        const bool hollow = in_box(x, y, z, 22, 16, 9, 40);
        if (hollow && z < 20)
            set(scene, at, earth, PHANTOM_POT);
        else if (!hollow && (in_box(x, y, z, 26, 20, 5, 22) || in_box(x, y, z, 28, 22, 19, 23)))
            set(scene, at, pot, PHANTOM_POT);
        if (z > 19 && z < 78 && hypot(x - trunk_x(z), y) < 4.5 - 0.03 * (z - 19))
            set(scene, at, wood, PHANTOM_WOOD);
    }
    check_random random = {11};
    for (int branch = 0; branch < 12; branch++) add_branch(scene, &random, leaves, wood);
}

void phantom_add_walnut(phantom *scene, double cup, double thick, bool lid, double shell, double kernel) {
    for (int at = 0; at < PHANTOM_VOXELS; at++) {
        double p[3];
        place_of(at, p);
        const double x = p[0], y = p[1], z = p[2];
        const double radius = hypot(x, y), height = z - MIDDLE;
        const bool in_height = z > 4 && (z < 92 || !lid), within = radius < 42 - thick;
        const bool floor = z > 4 && z < 4 + thick, top = lid && z > 92 - thick && z < 92;
        if (radius < 42 && in_height && (!within || floor || top)) set(scene, at, cup, PHANTOM_BOX);
        const double ridges = 1 + 0.03 * sin(8 * atan2(y, x)) + 0.02 * sin(z / 2.3);
        const double from = sqrt(x * x / 529 + y * y / 441 + height * height / 625) / ridges;
        const bool hollow = sin(x / 3) * sin(y / 3) * sin(z / 4) < -0.35;
        if (from < 1 && from > 0.87)
            set(scene, at, shell, PHANTOM_NUT);
        else if (from < 0.8 && !hollow)
            set(scene, at, kernel, PHANTOM_NUT);
    }
}

void phantom_add_head(phantom *scene, double skin, double brain, double bone) {
    for (int at = 0; at < PHANTOM_VOXELS; at++) {
        double p[3];
        place_of(at, p);
        const double x = p[0], y = p[1], z = p[2];
        const double height = z - 56, neck = hypot(x, y - 6);
        const double from = sqrt(x * x / 900 + y * y / 1296 + height * height / 1156);
        const double nose = hypot(x, height + 6) + 0.6 * fabs(y + 38);
        const double eye = sqrt((fabs(x) - 12) * (fabs(x) - 12) + (y + 28) * (y + 28) + (z - 56) * (z - 56));
        if (from < 1 || nose < 6 || (neck < 17 && z < 40)) set(scene, at, skin, PHANTOM_SOFT);
        if (from < 0.86) set(scene, at, bone, PHANTOM_BONE);
        if (from < 0.74) set(scene, at, brain, PHANTOM_SOFT);
        if (eye < 7 && from < 0.9) set(scene, at, brain, PHANTOM_SOFT);
        if (neck < 6 && z < 32) set(scene, at, bone, PHANTOM_BONE);
    }
}

/// Means of neighbours along one axis, weights 1 2 1.
static void blur(float *values, int step) {
    OWNED(check_free) float *before = malloc(PHANTOM_VOXELS * sizeof *before);
    assert_non_null(before);
    memcpy(before, values, PHANTOM_VOXELS * sizeof *before);
    for (int at = 0; at < PHANTOM_VOXELS; at++) {
        const int along = at / step % SIDE;
        const int low = along ? at - step : at, high = along + 1 < SIDE ? at + step : at;
        values[at] = 0.25f * before[low] + 0.5f * before[at] + 0.25f * before[high];
    }
}

static double normal_number(check_random *random) {
    const double radius = sqrt(-2 * log(check_uniform(random, 1e-12, 1)));
    return radius * cos(check_uniform(random, 0, 6.283185307179586));
}

ewa_volume phantom_scan_it(ewa_context *context, const phantom *scene, const phantom_scan *scan) {
    ewa_volume volume;
    assert_int_equal(ewa_volume_create(context, (const uint32_t[3]){SIDE, SIDE, SIDE}, EWA_U8, &volume),
                     EWA_OK);
    OWNED(check_free) float *values = malloc(PHANTOM_VOXELS * sizeof *values);
    assert_non_null(values);
    memcpy(values, scene->values, PHANTOM_VOXELS * sizeof *values);
    for (int step = 1; step <= LAYER; step *= SIDE) blur(values, step);
    check_random random = {23};
    uint8_t *to = volume.voxels;
    for (int at = 0; at < PHANTOM_VOXELS; at++) {
        double p[3];
        place_of(at, p);

        const double value = (double)values[at] + scan->noise * normal_number(&random);
        const bool outside = scan->padded && hypot(p[0], p[1]) > MIDDLE;
        to[at] = outside ? 0 : (uint8_t)fmin(fmax(value + 0.5, 0), 255);
    }
    return volume;
}

/// Extinction at a value per world unit: the plain definition, a search and a straight line.
static double extinction_at(const ewa_transfer *transfer, double value) {
    const ewa_transfer_point *p = transfer->points;
    for (uint32_t i = 0; i + 1 < transfer->point_count; i++) {
        if (value < p[i].value || value > p[i + 1].value || p[i].value == p[i + 1].value) continue;
        const double t = (value - p[i].value) / (p[i + 1].value - p[i].value);
        return ((1 - t) * (double)p[i].extinction + t * (double)p[i + 1].extinction) /
               transfer->unit_length_world;
    }
    return 0;
}

phantom_seen phantom_look(const phantom *scene, const ewa_volume *volume, const ewa_transfer *transfer,
                          unsigned materials) {
    double extinctions[256], object = 0, opacity = 0, elsewhere = 0, with = 0, without = 0;
    for (int v = 0; v < 256; v++) extinctions[v] = extinction_at(transfer, v);
    static const int steps[3] = {1, SIDE, LAYER};
    const uint8_t *voxels = volume->voxels;
    for (int side = 0; side < 6; side++)
        for (int line = 0; line < LAYER; line++) {
            const int axis = side / 2;
            int at = line % SIDE * steps[(axis + 1) % 3] + line / SIDE * steps[(axis + 2) % 3];
            const int step = side & 1 ? -steps[axis] : steps[axis];
            if (side & 1) at += (SIDE - 1) * steps[axis];
            double through = 1, seen = 0;
            bool hit = false;
            for (int n = 0; n < SIDE; n++, at += step) {
                const bool is_object = materials >> scene->material[at] & 1;
                const double weight = through * (1 - exp(-extinctions[voxels[at]]));
                seen += is_object ? weight : 0;
                through -= weight;
                hit |= is_object;
            }
            object += hit ? seen : 0;
            opacity += hit ? 1 - through : 0;
            elsewhere += hit ? 0 : 1 - through;
            with += hit;
            without += !hit;
        }
    return (phantom_seen){with > 0 ? object / with : 0, without > 0 ? elsewhere / without : 0,
                          with > 0 ? opacity / with : 0};
}

ewa_transfer phantom_transfer(const ewa_volume *volume) {
    ewa_volume_facts facts;
    ewa_transfer transfer;
    assert_int_equal(ewa_volume_measure(volume, &facts), EWA_OK);
    assert_int_equal(ewa_transfer_automatic(volume, &facts, &transfer), EWA_OK);
    assert_int_equal(ewa_transfer_check(volume->context, "automatic", &transfer), EWA_OK);
    return transfer;
}

void phantom_expect(const char *what, double value, double low, double high) {
    if (!(value >= low && value <= high)) fail_msg("%s: %g, wanted %g to %g", what, value, low, high);
}
