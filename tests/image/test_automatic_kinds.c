// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions from volumes alone that are no scans: labels, fields, pictures, noise.
#include "check.h"
#include "image/phantoms.h"
#include "image/srgb.h"
#include "image/transfer.h"
#include "image/volume_kind.h"

#include <math.h>

enum { SIDE = 64, LAYER = SIDE * SIDE, ALL = SIDE * LAYER };

static ewa_volume_kind kind_of(const ewa_volume *volume) {
    ewa_volume_facts facts;
    ewa_volume_surfaces surfaces;
    ewa_volume_labels labels;
    assert_int_equal(ewa_volume_measure(volume, &facts), EWA_OK);
    ewa_volume_surfaces_measure(volume, &facts, &surfaces);
    return ewa_volume_find_kind(volume, &facts, &surfaces, &labels);
}

static ewa_volume make_volume(ewa_context *context, ewa_type type) {
    ewa_volume volume;
    assert_int_equal(ewa_volume_create(context, (const uint32_t[3]){SIDE, SIDE, SIDE}, type, &volume),
                     EWA_OK);
    return volume;
}

static double at_least(double a, double b) { return a > b ? a : b; }

/// The place of a voxel in [-1, 1].
static void place_of(int i, double p[3]) {
    p[0] = (i % SIDE + 0.5) * 2 / SIDE - 1;
    p[1] = (i / SIDE % SIDE + 0.5) * 2 / SIDE - 1;
    p[2] = (i / LAYER + 0.5) * 2 / SIDE - 1;
}

/// Extinction and colour of a value.
static double look_up(const ewa_transfer *transfer, double value, double color[3]) {
    const ewa_transfer_point *p = transfer->points, *last = p + transfer->point_count - 1;
    for (int c = 0; c < 3; c++) color[c] = 0;
    if (value < p->value || value > last->value) return 0;
    while (p + 1 < last && p[1].value <= value) p++;
    const double t = p[1].value > p->value ? fmin((value - p->value) / (p[1].value - p->value), 1) : 1;
    for (int c = 0; c < 3; c++) color[c] = (1 - t) * (double)p->color[c] + t * (double)p[1].color[c];
    return (1 - t) * (double)p->extinction + t * (double)p[1].extinction;
}

/// Seven organs within a body, codes that leave gaps, zeros outside.
static const int codes[8] = {1, 2, 3, 7, 40, 41, 200, 9};

static int label_at(const double p[3], bool body) {
    for (int n = 1; n < 8; n++) {
        const double angle = 0.9 * n, x = p[0] - 0.45 * cos(angle), y = p[1] - 0.45 * sin(angle);
        if (x * x + y * y + p[2] * p[2] < 0.03) return codes[n];
    }
    return body && p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < 0.9 ? codes[0] : 0;
}

static void fill_labels(ewa_volume *volume, bool body) {
    for (int i = 0; i < ALL; i++) {
        double p[3];
        place_of(i, p);
        const int label = label_at(p, body);
        if (volume->type == EWA_U8)
            ((uint8_t *)volume->voxels)[i] = (uint8_t)label;
        else if (volume->type == EWA_I16)
            ((int16_t *)volume->voxels)[i] = (int16_t)label;
        else
            ((float *)volume->voxels)[i] = (float)label;
    }
}

/// The colour of its class for each label, whatever the type; what is around all others lets them be seen.
TEST_ON(test_labels, 1) {
    static const ewa_type types[] = {EWA_U8, EWA_I16, EWA_F32};
    for (int n = 0; n < 6; n++) {
        OWNED(ewa_volume_free) ewa_volume volume = make_volume(context, types[n % 3]);
        const bool body = n >= 3;
        fill_labels(&volume, body);
        assert_int_equal(kind_of(&volume), EWA_KIND_LABELS);
        const ewa_transfer transfer = phantom_transfer(&volume);
        double color[3];
        phantom_expect("surroundings", look_up(&transfer, 0, color), 0, 0);
        for (int c = body ? 0 : 1; c < 8; c++) {
            uint8_t srgb[3];
            ewa_class_color((uint32_t)codes[c], srgb);
            const double extinction = look_up(&transfer, codes[c], color);
            for (int k = 0; k < 3; k++)
                phantom_expect("colour", color[k], ewa_srgb_decoded[srgb[k]] - 1e-6,
                       ewa_srgb_decoded[srgb[k]] + 1e-6);
            // 128 units of length are a side: a body is crossed along 100 of them, an organ along 20.
            if (c == 0)
                phantom_expect("depth of the body", 100 * extinction, 0.3, 1);
            else
                phantom_expect("depth of an organ", 20 * extinction, 5, 1000);
        }
    }
}

/// Things that are no labels: a ball in few steps, two values, a scan without noise.
TEST_ON(test_no_labels, 1) {
    ewa_volume volume = make_volume(context, EWA_U8);
    uint8_t *voxels = volume.voxels;
    for (int steps = 2; steps <= 200; steps += 33) {
        for (int i = 0; i < ALL; i++) {
            double p[3];
            place_of(i, p);
            voxels[i] = (uint8_t)fmax(0, steps * (1 - p[0] * p[0] - p[1] * p[1] - p[2] * p[2]));
        }
        assert_true(kind_of(&volume) != EWA_KIND_LABELS);
    }
    ewa_volume_free(&volume);
    OWNED(phantom_free) phantom scene = phantom_make(12);
    phantom_add_bonsai(&scene, 50, 70, 90, 130);
    for (int noise = 0; noise <= 6; noise += 2) {
        const phantom_scan scan = {12, noise, true};
        volume = phantom_scan_it(context, &scene, &scan);
        assert_int_equal(kind_of(&volume), EWA_KIND_SCAN);
        ewa_volume_free(&volume);
    }
}

/// Optical depth along a line of voxels parallel to x.
static double depth_along(const ewa_volume *volume, const ewa_transfer *transfer, int y, int z) {
    double sum = 0, color[3];
    for (int x = 0; x < SIDE; x++)
        sum += look_up(transfer, (double)((const float *)volume->voxels)[z * LAYER + y * SIDE + x], color);
    return sum / transfer->unit_length_world;
}

/// A hydrogen atom, |3d z2|^2: two lobes, and a ring of a quarter of their density, are seen; what is far off is not. The
/// same in other units.
TEST_ON(test_field, 1) {
    OWNED(ewa_volume_free) ewa_volume volume = make_volume(context, EWA_F32);
    float *numbers = volume.voxels;
    for (int n = 0; n < 3; n++) {
        const double scale = n == 0 ? 1 : n == 1 ? 1e-9 : 1e9;
        for (int i = 0; i < ALL; i++) {
            double p[3];
            place_of(i, p);
            const double rr = 484 * (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
            const double psi = (3 * 484 * p[2] * p[2] - rr) * exp(-sqrt(rr) / 3);
            numbers[i] = (float)(scale * psi * psi);
        }
        assert_int_equal(kind_of(&volume), EWA_KIND_FIELD);
        const ewa_transfer transfer = phantom_transfer(&volume);
        const int middle = SIDE / 2, reach = 9; // the density is largest 6 of 22 from the middle
        print_message(
            "lobe %.2f, ring %.2f, far off %.3f\n", depth_along(&volume, &transfer, middle, middle + reach),
            depth_along(&volume, &transfer, middle + reach, middle), depth_along(&volume, &transfer, 2, 2));
        phantom_expect("lobe", depth_along(&volume, &transfer, middle, middle + reach), 3, 1000);
        phantom_expect("ring", depth_along(&volume, &transfer, middle + reach, middle), 0.4, 8);
        phantom_expect("far off", depth_along(&volume, &transfer, 2, 2), 0, 0);
    }
}

/// What is smooth within its slices, and not across them, is a scan that was resampled.
TEST_ON(test_smooth_slices, 1) {
    OWNED(ewa_volume_free) ewa_volume volume = make_volume(context, EWA_F32);
    for (int axis = 1; axis < 3; axis++) {
        for (int i = 0; i < ALL; i++) {
            double p[3];
            place_of(i, p);
            const int slice = axis == 1 ? i / SIDE % SIDE : i / LAYER;
            ((float *)volume.voxels)[i] = (float)(sin(5 * p[0]) + sin(6 * p[3 - axis]) + 0.4 * (slice * 7 % 5));
        }
        assert_int_equal(kind_of(&volume), EWA_KIND_SCAN);
    }
}

/// Fields that reach the faces of the box have shells, too.
TEST_ON(test_full_field, 1) {
    OWNED(ewa_volume_free) ewa_volume volume = make_volume(context, EWA_F32);
    for (int i = 0; i < ALL; i++) {
        double p[3];
        place_of(i, p);
        ((float *)volume.voxels)[i] = (float)(sin(9 * p[0]) + sin(8 * p[1]) + cos(7 * p[2]));
    }
    assert_int_equal(kind_of(&volume), EWA_KIND_FIELD);
    const ewa_transfer transfer = phantom_transfer(&volume);
    double color[3];
    phantom_expect("low", look_up(&transfer, -2.5, color), 0, 0);
    phantom_expect("outermost shell", transfer.points[1].value, 0.5, 2);
    assert_true(look_up(&transfer, 2.9, color) > 0.5);
}

/// One slice along any axis: greys that become lighter, all of it solid.
TEST_ON(test_picture, 1) {
    for (int axis = 0; axis < 3; axis++) {
        uint32_t dims[3] = {SIDE, SIDE, SIDE};
        dims[axis] = 1;
        OWNED(ewa_volume_free) ewa_volume volume;
        assert_int_equal(ewa_volume_create(context, dims, EWA_U8, &volume), EWA_OK);
        check_random random = {3};
        for (int i = 0; i < LAYER; i++)
            ((uint8_t *)volume.voxels)[i] =
                (uint8_t)(i % SIDE * 255 / (SIDE - 1) / 2 + check_uniform(&random, 0, 120));
        assert_int_equal(kind_of(&volume), EWA_KIND_PICTURE);
        const ewa_transfer transfer = phantom_transfer(&volume);
        ewa_volume_facts facts;
        assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
        double last = -1;
        for (int value = (int)facts.low; value <= (int)facts.high; value++) {
            double color[3];
            phantom_expect("extinction of a voxel", look_up(&transfer, value, color), 5, 1000);
            assert_true(color[0] == color[1] && color[1] == color[2] && color[0] >= last);
            last = color[0];
        }
        phantom_expect("white", last, 1, 1);
    }
}

/// Noise is told of, and scans with noise are not.
TEST_LOGGED(test_noise, 1) {
    OWNED(ewa_volume_free) ewa_volume volume = make_volume(context, EWA_U8);
    check_random random = {11};
    for (int i = 0; i < ALL; i++) ((uint8_t *)volume.voxels)[i] = (uint8_t)check_uniform(&random, 0, 256);
    assert_int_equal(kind_of(&volume), EWA_KIND_NOISE);
    const ewa_transfer transfer = phantom_transfer(&volume);
    assert_int_equal(log->count, 1);
    assert_non_null(strstr(log->text, "nothing in common"));
    double depth = 0, color[3];
    for (int value = 0; value < 256; value++) depth += 128 * look_up(&transfer, value, color) / 256;
    phantom_expect("depth through the box", depth, 0.5, 3);
    ewa_volume_free(&volume);
    OWNED(phantom_free) phantom scene = phantom_make(12);
    phantom_add_bonsai(&scene, 50, 70, 90, 130);
    const phantom_scan scan = {12, 9, false};
    volume = phantom_scan_it(context, &scene, &scan);
    assert_int_equal(kind_of(&volume), EWA_KIND_SCAN);
}

/// A nut packed in foam in a cup: lines of sight pass much of the foam, which lets the nut be seen.
TEST_ON(test_packed, 1) {
    OWNED(phantom_free) phantom scene = phantom_make(12);
    phantom_add_walnut(&scene, 60, 3, false, 150, 110);
    check_random random = {7};
    for (int i = 0; i < PHANTOM_VOXELS; i++) {
        const double x = i % PHANTOM_SIDE - 47.5, y = i / PHANTOM_SIDE % PHANTOM_SIDE - 47.5;
        if (scene.material[i] == PHANTOM_AIR && at_least(fabs(x), fabs(y)) < 30 &&
            check_uniform(&random, 0, 1) < 0.5)
            scene.values[i] = 40, scene.material[i] = PHANTOM_BOX;
    }
    const phantom_scan scan = {12, 5, false};
    OWNED(ewa_volume_free) ewa_volume volume = phantom_scan_it(context, &scene, &scan);
    const ewa_transfer transfer = phantom_transfer(&volume);
    const phantom_seen nut = phantom_look(&scene, &volume, &transfer, 1 << PHANTOM_NUT);
    print_message("packed nut %.2f\n", nut.object);
    phantom_expect("nut", nut.object, 0.69, 1); // 0.67 by the mean chord of the foam's pieces
}

int main(void) { return RUN_TESTS(NULL, NULL); }
