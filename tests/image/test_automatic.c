// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions from volumes alone: what of scans is seen.
#include "check.h"
#include "image/phantoms.h"
#include "image/transfer.h"
#include "image/volume_surfaces.h"

#include <math.h>
#include <string.h>

enum { ALL_TREE = 1 << PHANTOM_LEAVES | 1 << PHANTOM_WOOD | 1 << PHANTOM_POT };

/// A tree in noisy air, whatever the noise, with and without zeros around it.
TEST_ON(test_bonsai, 1) {
    static const phantom_scan scans[] = {
        {12, 5, true}, {12, 5, false}, {14, 7, true}, {2, 1, false}, {30, 5, true}};
    for (size_t n = 0; n < sizeof scans / sizeof scans[0]; n++) {
        OWNED(phantom_free) phantom scene = phantom_make(scans[n].air);
        phantom_add_bonsai(&scene, 50 + scans[n].air, 70 + scans[n].air, 90 + scans[n].air,
                           130 + scans[n].air);
        OWNED(ewa_volume_free) ewa_volume volume = phantom_scan_it(context, &scene, &scans[n]);
        const ewa_transfer transfer = phantom_transfer(&volume);
        const phantom_seen tree = phantom_look(&scene, &volume, &transfer, ALL_TREE);
        const phantom_seen leaves = phantom_look(&scene, &volume, &transfer, 1 << PHANTOM_LEAVES);
        print_message("scan %zu: tree %.2f, elsewhere %.3f; leaves %.2f\n", n, tree.object, tree.elsewhere,
                      leaves.object);
        phantom_expect("tree", tree.object, 0.7, 1);
        phantom_expect("air", tree.elsewhere, 0, 0.04); // borders are blurred
        phantom_expect("leaves", leaves.object, 0.35, 1);
    }
}

/// A nut in a cup: the cup is left out.
TEST_ON(test_walnut, 1) {
    static const struct {
        phantom_scan scan;
        double cup, thick, shell, kernel;
        bool lid;
    } cases[] = {{{10, 6, false}, 60, 3, 150, 110, false}, {{10, 6, true}, 60, 3, 150, 110, true},
                 {{10, 6, false}, 80, 8, 150, 110, true},  {{10, 9, false}, 100, 4, 180, 150, true},
                 {{10, 1, false}, 60, 2, 150, 110, true},  {{0, 0, false}, 60, 4, 150, 150, true}};
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        OWNED(phantom_free) phantom scene = phantom_make(cases[n].scan.air);
        phantom_add_walnut(&scene, cases[n].cup, cases[n].thick, cases[n].lid, cases[n].shell,
                           cases[n].kernel);
        OWNED(ewa_volume_free) ewa_volume volume = phantom_scan_it(context, &scene, &cases[n].scan);
        const ewa_transfer transfer = phantom_transfer(&volume);
        const phantom_seen nut = phantom_look(&scene, &volume, &transfer, 1 << PHANTOM_NUT);
        print_message("case %zu: nut %.2f, elsewhere %.3f\n", n, nut.object, nut.elsewhere);
        phantom_expect("nut", nut.object, 0.8, 1);
        phantom_expect("cup", nut.elsewhere, 0, 0.05);
    }
}

/// A head in computed tomography: skin and bone, the one through the other. In magnetic resonance, where bone
/// is dark, the skin is solid.
TEST_ON(test_heads, 1) {
    OWNED(phantom_free) phantom scene = phantom_make(4);
    phantom_add_head(&scene, 70, 72, 170);
    const phantom_scan tomograph = {4, 2, false};
    OWNED(ewa_volume_free) ewa_volume volume = phantom_scan_it(context, &scene, &tomograph);
    ewa_transfer transfer = phantom_transfer(&volume);
    const phantom_seen bone = phantom_look(&scene, &volume, &transfer, 1 << PHANTOM_BONE);
    const phantom_seen soft = phantom_look(&scene, &volume, &transfer, 1 << PHANTOM_SOFT);
    print_message("CT: bone %.2f, soft %.2f, elsewhere %.3f\n", bone.object, soft.object, soft.elsewhere);
    phantom_expect("bone", bone.object, 0.4, 0.95);
    phantom_expect("soft matter", soft.object, 0.08, 0.6);
    phantom_expect("air", soft.elsewhere, 0, 0.02);
    ewa_volume_free(&volume);
    phantom_free(&scene);

    scene = phantom_make(0);
    phantom_add_head(&scene, 150, 110, 30);
    const phantom_scan magnet = {0, 8, false};
    volume = phantom_scan_it(context, &scene, &magnet);
    // Masked, as it often comes.
    for (int i = 0; i < PHANTOM_VOXELS; i++)
        if (scene.material[i] == PHANTOM_AIR) ((uint8_t *)volume.voxels)[i] = 0;
    transfer = phantom_transfer(&volume);
    const phantom_seen head = phantom_look(&scene, &volume, &transfer, 1 << PHANTOM_SOFT | 1 << PHANTOM_BONE);
    print_message("MR: head %.2f, elsewhere %.3f\n", head.opacity, head.elsewhere);
    phantom_expect("head", head.opacity, 0.85, 1);
    phantom_expect("outside", head.elsewhere, 0, 0.02);
}

/// The same look of the same matter: turned, mirrored, in other numbers, with a few that are far off or none.
TEST_ON(test_same_look, 1) {
    OWNED(phantom_free) phantom scene = phantom_make(12);
    phantom_add_bonsai(&scene, 60, 80, 100, 140);
    const phantom_scan scan = {12, 5, true};
    OWNED(ewa_volume_free) ewa_volume volume = phantom_scan_it(context, &scene, &scan);
    const uint8_t *voxels = volume.voxels;
    const ewa_transfer first = phantom_transfer(&volume);
    OWNED(ewa_volume_free) ewa_volume other;
    assert_int_equal(ewa_volume_create(context, volume.dims, EWA_F32, &other), EWA_OK);
    float *numbers = other.voxels;
    for (int n = 0; n < 6; n++) {
        const double scale = n == 3 ? 1e-6 : n == 4 ? 1e6 : 1, shift = n == 3 ? -7e-5 : 0;
        for (int i = 0; i < PHANTOM_VOXELS; i++) {
            const int x = i % PHANTOM_SIDE, y = i / PHANTOM_SIDE % PHANTOM_SIDE,
                      z = i / PHANTOM_SIDE / PHANTOM_SIDE;
            const int from[3] = {n == 1 ? z : x,
                                 n == 1   ? x
                                 : n == 2 ? PHANTOM_SIDE - 1 - y
                                          : y,
                                 n == 1 ? y : z};
            numbers[i] =
                (float)(voxels[(from[2] * PHANTOM_SIDE + from[1]) * PHANTOM_SIDE + from[0]] * scale + shift);
        }
        if (n == 5) { // noise of the file: values far beyond, and none
            for (int i = 0; i < 40; i++) numbers[7919 * (i + 1)] = i % 2 ? 1e30f : -1e30f;
            numbers[4] = NAN, numbers[77777] = INFINITY;
        }
        const ewa_transfer transfer = phantom_transfer(&other);
        // A point more goes to what is far off.
        assert_true(transfer.point_count == first.point_count);
        for (uint32_t i = 0; i + 1 < first.point_count; i++) {
            const double value = (transfer.points[i].value - shift) / scale;
            // Steps of the histogram are another where values are cut off.
            const double wanted = first.points[i].value;
            if (fabs(value - wanted) > (n == 5 ? 3 : n == 3 ? 0.01 : 1e-6))
                fail_msg("%d, point %u: %g, not %g", n, i, value, wanted);
            const double extinction = (double)first.points[i].extinction;
            assert_true(fabs((double)transfer.points[i].extinction - extinction) < 0.1 * extinction + 1e-9);
        }
    }
}

/// Whatever comes, there is a look, and it shows something where there is something.
TEST_ON(test_odd_volumes, 1) {
    static const uint32_t sizes[][3] = {{1, 1, 2},   {2, 1, 1}, {27, 1, 1},   {1, 9, 3},
                                        {64, 64, 1}, {5, 5, 5}, {40, 3, 2000}};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (int kind = 0; kind < 6; kind++) {
            OWNED(ewa_volume_free) ewa_volume volume;
            assert_int_equal(ewa_volume_create(context, sizes[s], EWA_F32, &volume), EWA_OK);
            const size_t count = (size_t)sizes[s][0] * sizes[s][1] * sizes[s][2];
            float *numbers = volume.voxels, largest = -INFINITY;
            check_random random = {5};
            for (size_t i = 0; i < count; i++) {
                const double uniform = check_uniform(&random, 0, 1);
                numbers[i] = kind == 0   ? (float)i
                             : kind == 1 ? (float)(i == count / 2)
                             : kind == 2 ? (float)uniform
                             : kind == 3 ? (float)(i % 2)
                             : kind == 4 ? (float)(uniform < 0.5 ? -1e38 : 1e38)
                                         : (i % 3 ? NAN : (float)i);
                if (numbers[i] > largest) largest = numbers[i];
            }
            ewa_volume_facts facts;
            assert_int_equal(ewa_volume_measure(&volume, &facts), EWA_OK);
            if (facts.low < facts.high) {
                const ewa_transfer transfer = phantom_transfer(&volume);
                const ewa_transfer_point *last = &transfer.points[transfer.point_count - 1];
                assert_true(last->value >= (double)largest && last->extinction > 0);
                // One slice is a picture, of which all is seen.
                const uint32_t *size = sizes[s];
                if ((size[0] == 1) + (size[1] == 1) + (size[2] == 1) != 1)
                    assert_true(transfer.points[0].extinction == 0);
            }
        }
}

/// Volumes that are filled to their faces show their denser half.
TEST_ON(test_full_volume, 1) {
    OWNED(phantom_free) phantom scene = phantom_make(40);
    for (int i = 0; i < PHANTOM_VOXELS; i++)
        if (i / PHANTOM_SIDE % PHANTOM_SIDE > 40) scene.values[i] = 160, scene.material[i] = PHANTOM_SOFT;
    const phantom_scan scan = {40, 3, false};
    OWNED(ewa_volume_free) ewa_volume volume = phantom_scan_it(context, &scene, &scan);
    const ewa_transfer transfer = phantom_transfer(&volume);
    const phantom_seen dense = phantom_look(&scene, &volume, &transfer, 1 << PHANTOM_SOFT);
    phantom_expect("dense half", dense.object, 0.85, 1);
    phantom_expect("other half", dense.elsewhere, 0, 0.05);
}

/// Nearly all voxels have the value next to the highest, and the lowest is in a row that is not looked at: no
/// class begins above the last threshold.
TEST_ON(test_highest_class, 1) {
    enum { SIDE = 128 };
    const uint32_t dims[3] = {SIDE, SIDE, SIDE};
    OWNED(ewa_volume_free) ewa_volume volume;
    assert_int_equal(ewa_volume_create(context, dims, EWA_U8, &volume), EWA_OK);
    uint8_t *voxels = volume.voxels;
    memset(voxels, 254, (size_t)SIDE * SIDE * SIDE);
    memset(voxels, 255, 50);
    voxels[(size_t)5 * SIDE * SIDE + SIDE + 7] = 0;
    const ewa_transfer transfer = phantom_transfer(&volume);
    for (uint32_t i = 0; i < transfer.point_count; i++)
        phantom_expect("point", transfer.points[i].value, 254.4999, 255);
}

/// A look along one column of voxels, from its two ends: three voxels in front hide, two do not; a gap of
/// three parts, one of two does not. Across, lines are too short to meet anything.
TEST_ON(test_sight, 1) {
    static const struct {
        const char *column; // o: outer, i: inner, anything else: neither
        double hit, hidden, apart;
    } cases[] = {
        {"..ii..", 2, 0, 0},       {"ooii..", 2, 0, 0},           {"oooii.", 2, 0.5, 0},
        {"oooiioo", 2, 0.5, 0},    {"oooiiooo", 2, 1, 0},         {"oo..ii", 2, 0, 0},
        {"oo...ii", 2, 0, 0.5},    {"oo...iioo...oo", 2, 0.5, 1}, {"o.o.o.ii", 2, 0.5, 0},
        {"o...ii", 2, 0, 0},       {"oo...ii..oo", 2, 0, 0.5},    {"oo...ii...oo", 2, 0, 1},
        {"oo.o.o.oii", 2, 0.5, 0}, {"ooo.i.ooo", 0, 0, 0},
    };
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        const char *column = cases[n].column;
        for (int axis = 0; axis < 3; axis++) {
            uint32_t dims[3] = {1, 1, 1};
            dims[axis] = (uint32_t)strlen(column);
            OWNED(ewa_volume_free) ewa_volume volume;
            assert_int_equal(ewa_volume_create(context, dims, EWA_U8, &volume), EWA_OK);
            for (uint32_t i = 0; i < dims[axis]; i++)
                ((uint8_t *)volume.voxels)[i] = column[i] == 'i' ? 200 : column[i] == 'o' ? 100 : 3;
            ewa_volume_sight sight;
            assert_int_equal(ewa_volume_sight_measure(&volume, 100, 200, &sight), EWA_OK);
            phantom_expect(column, sight.hit, cases[n].hit, cases[n].hit);
            phantom_expect(column, sight.hidden, cases[n].hidden, cases[n].hidden);
            phantom_expect(column, sight.separated, cases[n].apart, cases[n].apart);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
