// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of Gaussians as other programs wrote them: one scene in five forms is one scene, within what each form can say.
#include "../check.h"

#include <math.h>

typedef struct loaded {
    ewa_gaussians set;
    ewa_gaussian_facts facts;
} loaded;

static bool load(ewa_context *context, const char *relative, loaded *made) {
    char path[512];
    *made = (loaded){.facts = {0}};
    if (!check_data(relative, path, sizeof path)) return false;
    assert_int_equal(ewa_gaussians_load(context, path, &made->set, &made->facts), EWA_OK);
    return true;
}

static double distance2(const float *a, const float *b) {
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += pow((double)a[k] - (double)b[k], 2);
    return sum;
}

/// The largest differences of Gaussians that are the same, of which number `of[i]` of `b` is number i of `a`.
typedef struct differences {
    double center, scale, turn, opacity, color;
} differences;

/// The colour that a form can hold: in [0, 1] for those of bytes.
static double shown(float coefficient, bool clamped) {
    const double color = 0.5 + 0.28209479177387814 * (double)coefficient;
    return clamped ? fmin(fmax(color, 0), 1) : color;
}

static differences compare(const ewa_gaussians *a, const ewa_gaussians *b, const uint32_t *of, bool clamped) {
    differences maximum = {0};
    for (uint32_t i = 0; i < a->count; i++) {
        const uint32_t j = of ? of[i] : i;
        double cosine = 0;
        for (uint32_t k = 0; k < 4; k++)
            cosine += (double)a->rotations[4 * i + k] * (double)b->rotations[4 * j + k];
        for (uint32_t k = 0; k < 3; k++) {
            // What is smaller is as good as nothing, and SPZ has no number for it.
            maximum.scale = fmax(maximum.scale, fabs(fmax(log((double)a->scales[3 * i + k]), -10) -
                                                     fmax(log((double)b->scales[3 * j + k]), -10)));
            maximum.color = fmax(maximum.color, fabs(shown(a->harmonics[3 * i + k], clamped) -
                                                     shown(b->harmonics[3 * j + k], clamped)));
        }
        maximum.center = fmax(maximum.center, sqrt(distance2(a->centers + 3 * i, b->centers + 3 * j)));
        maximum.turn = fmax(maximum.turn, 1 - fabs(cosine));
        maximum.opacity = fmax(maximum.opacity, fabs((double)a->opacities[i] - (double)b->opacities[j]));
    }
    print_message("most: centre %.3g, log scale %.3g, turn %.3g, opacity %.3g, colour %.3g\n", maximum.center,
                  maximum.scale, maximum.turn, maximum.opacity, maximum.color);
    return maximum;
}

TEST_ON(guitar, 2) {
    loaded plain, packed, splat, spz, flat;
    if (load(context, "gaussians/guitar_3dgs.ply", &plain) &&
        load(context, "gaussians/guitar.compressed.ply", &packed)) {
        assert_int_equal(plain.set.count, 90854);
        assert_int_equal(packed.set.count, 90854);
        assert_int_equal(packed.facts.format, EWA_GAUSSIANS_PACKED_PLY);
        const differences d = compare(&plain.set, &packed.set, NULL, false);
        // Its decoder kept logits finite by half a step.
        assert_true(d.center < 2e-6 && d.scale < 1e-5 && d.turn < 1e-6 && d.opacity < 0.51 / 255 &&
                    d.color < 1e-6);
    }
    const bool some = load(context, "gaussians/guitar_40k.splat", &splat);
    if (some && plain.set.count) {
        // The same numbers are in both, in another order: found by the centre's bits.
        uint32_t *of = malloc(splat.set.count * sizeof *of), found = 0;
        for (uint32_t i = 0; i < splat.set.count; i++) {
            of[i] = UINT32_MAX;
            for (uint32_t j = 0; j < plain.set.count && of[i] == UINT32_MAX; j++)
                if (distance2(splat.set.centers + 3 * (size_t)i, plain.set.centers + 3 * (size_t)j) == 0 &&
                    fabs((double)splat.set.scales[3 * i] / (double)plain.set.scales[3 * j] - 1) < 1e-4)
                    of[i] = j;
            found += of[i] != UINT32_MAX;
        }
        assert_int_equal(found, splat.set.count);
        const differences d = compare(&splat.set, &plain.set, of, true);
        assert_true(d.scale < 1e-4 && d.turn < 3e-4 && d.opacity < 1 / 254.0 && d.color < 1 / 254.0);
        free(of);
    }
    if (load(context, "gaussians/guitar_40k_v2_derived.spz", &spz) && some) {
        // It was made of the other's numbers as they are, which SPZ means to be right, up, back.
        for (size_t i = 0; i < spz.set.count; i++)
            for (size_t k = 1; k < 3; k++) {
                spz.set.centers[3 * i + k] = -spz.set.centers[3 * i + k];
                spz.set.rotations[4 * i + 1 + k] = -spz.set.rotations[4 * i + 1 + k];
            }
        const differences d = compare(&spz.set, &splat.set, NULL, true);
        assert_true(d.center < 3e-4 && d.scale < 0.033 && d.turn < 6e-3 && d.opacity < 2 / 254.0 &&
                    d.color < 1.0 / 128 + 1.0 / 200);
    }
    if (load(context, "gaussians/guitar_40k_2dgs_derived.ply", &flat) && some) {
        assert_true(flat.set.flat);
        assert_int_equal(flat.set.count, splat.set.count);
        // The two longest of three axes, longest first.
        for (uint32_t i = 0; i < flat.set.count; i++) {
            const float *three = splat.set.scales + 3 * (size_t)i, *two = flat.set.scales + 3 * (size_t)i;
            const double maximum = fmax(fmax((double)three[0], (double)three[1]), (double)three[2]);
            assert_true(fabs((double)two[0] / maximum - 1) < 1e-4 && two[1] <= two[0] && two[2] == 0);
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        assert_int_equal(ewa_gaussians_to_cloud(&flat.set, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(cloud), flat.set.count);
    }
    ewa_gaussians_free(&plain.set);
    ewa_gaussians_free(&packed.set);
    ewa_gaussians_free(&splat.set);
    ewa_gaussians_free(&spz.set);
    ewa_gaussians_free(&flat.set);
}

/// Small ones: what is in them is known.
TEST_ON(small, 1) {
    static const struct {
        const char *name;
        ewa_gaussian_format format;
        uint32_t count, sh_degree, version;
    } files[] = {{"gaussians/minimal.splat", EWA_GAUSSIANS_SPLAT, 4, 0, 0},
                 {"gaussians/minimal.ksplat", EWA_GAUSSIANS_KSPLAT, 4, 0, 1},
                 {"gaussians/minimal-v4.spz", EWA_GAUSSIANS_SPZ, 4, 0, 4},
                 {"gaussians/pc_short_100_sh3.ply", EWA_GAUSSIANS_PLY, 100, 3, 0},
                 {"gaussians/train_3_points.ply", EWA_GAUSSIANS_PLY, 3, 3, 0}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        loaded made;
        if (!load(context, files[i].name, &made)) continue;
        assert_int_equal(made.facts.format, files[i].format);
        assert_int_equal(made.set.count, files[i].count);
        assert_int_equal(made.set.sh_degree, files[i].sh_degree);
        assert_int_equal(made.facts.version, files[i].version);
        if (i < 3) {
            // Opacities of 230, colours of 85 and 170.
            for (uint32_t n = 0; n < 4; n++) {
                assert_true(fabs((double)made.set.opacities[n] - 230 / 255.0) < 1e-6);
                const double red = shown(made.set.harmonics[3 * n], true);
                assert_true(fabs(red - (n % 2 ? 170 : 85) / 255.0) < 1e-2);
            }
        }
        ewa_gaussians_free(&made.set);
    }
    ewa_gaussian_format format;
    char path[512];
    if (check_data("gaussians/garden_sfm_points.ply", path, sizeof path)) {
        assert_int_equal(ewa_gaussians_probe(context, path, &format), EWA_OK);
        assert_int_equal(format, EWA_GAUSSIANS_NONE);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
