// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions from volumes alone: what of scans is seen.
#include "check.h"
#include "image/standins.h"

#include <math.h>

enum { ALL_TREE = 1 << STANDIN_LEAVES | 1 << STANDIN_WOOD | 1 << STANDIN_POT };

static ewa_transfer look_of(const ewa_volume *volume) {
    ewa_volume_facts facts;
    ewa_transfer transfer;
    assert_int_equal(ewa_volume_measure(volume, &facts), EWA_OK);
    assert_int_equal(ewa_transfer_automatic(volume, &facts, &transfer), EWA_OK);
    assert_int_equal(ewa_transfer_check(volume->context, "automatic", &transfer), EWA_OK);
    return transfer;
}

static void expect(const char *what, double value, double low, double high) {
    if (!(value >= low && value <= high)) fail_msg("%s: %g, wanted %g to %g", what, value, low, high);
}

/// A tree in noisy air, whatever the noise, with and without zeros around it.
static void test_bonsai(void **state) {
    (void)state;
    static const standin_scan scans[] = {
        {12, 5, true}, {12, 5, false}, {14, 7, true}, {2, 1, false}, {30, 5, true}};
    ewa_context *context = check_context(1, NULL);
    for (size_t n = 0; n < sizeof scans / sizeof scans[0]; n++) {
        standin scene = standin_make(scans[n].air);
        standin_add_bonsai(&scene, 50 + scans[n].air, 70 + scans[n].air, 90 + scans[n].air,
                           130 + scans[n].air);
        ewa_volume volume = standin_scan_it(context, &scene, &scans[n]);
        const ewa_transfer transfer = look_of(&volume);
        const standin_seen tree = standin_look(&scene, &volume, &transfer, ALL_TREE);
        const standin_seen leaves = standin_look(&scene, &volume, &transfer, 1 << STANDIN_LEAVES);
        print_message("scan %zu: tree %.2f, elsewhere %.3f; leaves %.2f\n", n, tree.object, tree.elsewhere,
                      leaves.object);
        expect("tree", tree.object, 0.7, 1);
        expect("air", tree.elsewhere, 0, 0.04); // borders are blurred
        expect("leaves", leaves.object, 0.35, 1);
        ewa_volume_free(&volume);
        standin_free(&scene);
    }
    ewa_context_destroy(&context);
}

/// A nut in a cup: the cup is left out.
static void test_walnut(void **state) {
    (void)state;
    static const struct {
        standin_scan scan;
        double cup, thick, shell, kernel;
        bool lid;
    } cases[] = {{{10, 6, false}, 60, 3, 150, 110, false}, {{10, 6, true}, 60, 3, 150, 110, true},
                 {{10, 6, false}, 80, 8, 150, 110, true},  {{10, 9, false}, 100, 4, 180, 150, true},
                 {{10, 1, false}, 60, 2, 150, 110, true},  {{0, 0, false}, 60, 4, 150, 150, true}};
    ewa_context *context = check_context(1, NULL);
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        standin scene = standin_make(cases[n].scan.air);
        standin_add_walnut(&scene, cases[n].cup, cases[n].thick, cases[n].lid, cases[n].shell,
                           cases[n].kernel);
        ewa_volume volume = standin_scan_it(context, &scene, &cases[n].scan);
        const ewa_transfer transfer = look_of(&volume);
        const standin_seen nut = standin_look(&scene, &volume, &transfer, 1 << STANDIN_NUT);
        print_message("case %zu: nut %.2f, elsewhere %.3f\n", n, nut.object, nut.elsewhere);
        expect("nut", nut.object, 0.8, 1);
        expect("cup", nut.elsewhere, 0, 0.05);
        ewa_volume_free(&volume);
        standin_free(&scene);
    }
    ewa_context_destroy(&context);
}

/// A head in computed tomography: skin and bone, the one through the other. In magnetic resonance, where bone
/// is dark, the skin is solid.
static void test_heads(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    standin scene = standin_make(4);
    standin_add_head(&scene, 70, 72, 170);
    const standin_scan tomograph = {4, 2, false};
    ewa_volume volume = standin_scan_it(context, &scene, &tomograph);
    ewa_transfer transfer = look_of(&volume);
    const standin_seen bone = standin_look(&scene, &volume, &transfer, 1 << STANDIN_BONE);
    const standin_seen soft = standin_look(&scene, &volume, &transfer, 1 << STANDIN_SOFT);
    print_message("CT: bone %.2f, soft %.2f, elsewhere %.3f\n", bone.object, soft.object, soft.elsewhere);
    expect("bone", bone.object, 0.4, 0.95);
    expect("soft matter", soft.object, 0.08, 0.6);
    expect("air", soft.elsewhere, 0, 0.02);
    ewa_volume_free(&volume);
    standin_free(&scene);

    scene = standin_make(0);
    standin_add_head(&scene, 150, 110, 30);
    const standin_scan magnet = {0, 8, false};
    volume = standin_scan_it(context, &scene, &magnet);
    // Masked, as it often comes.
    for (int i = 0; i < STANDIN_VOXELS; i++)
        if (scene.material[i] == STANDIN_AIR) ((uint8_t *)volume.voxels)[i] = 0;
    transfer = look_of(&volume);
    const standin_seen head = standin_look(&scene, &volume, &transfer, 1 << STANDIN_SOFT | 1 << STANDIN_BONE);
    print_message("MR: head %.2f, elsewhere %.3f\n", head.opacity, head.elsewhere);
    expect("head", head.opacity, 0.85, 1);
    expect("outside", head.elsewhere, 0, 0.02);
    ewa_volume_free(&volume);
    standin_free(&scene);
    ewa_context_destroy(&context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bonsai),
        cmocka_unit_test(test_walnut),
        cmocka_unit_test(test_heads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
