// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Estimated radii of a sparse reconstruction of a garden, where points far from all others once became balls.
// Only where the data set is: test_radii holds the rule on samplings that it makes.
#include "quality/radii_scene.h"

TEST_ON(test_garden, 0) {
    char path[1024];
    const char *file = check_data("gaussians/garden_sfm_points.ply", path, sizeof path);
    if (!file) skip();
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_load(context, file, &cloud), EWA_OK);
    WITH_DEFAULTS(ewa_estimate_options, options);
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    radii_sizes sizes;
    radii_measure_sizes(cloud, 300, &sizes);
    print_message("garden: the largest radius is %.2f spacings, %.3f of the diagonal\n", sizes.largest,
                  sizes.of_diagonal);
    assert_true(sizes.largest < 3.6 && sizes.of_diagonal < 0.03);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
