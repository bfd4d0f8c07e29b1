// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A program outside of the house, C and C++: uses the installed library and prints its version.
#include <ewa/ewa.h>
#include <stdio.h>

int main(void) {
    ewa_context *context = NULL;
    if (ewa_context_create(NULL, &context) != EWA_OK) return 1;
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.object = EWA_OBJECT_SPHERE;
    options.point_count = 1000;
    ewa_cloud *cloud = NULL;
    ewa_bounds bounds;
    if (ewa_cloud_generate(context, &options, &cloud) != EWA_OK) return 1;
    if (ewa_cloud_measure(cloud, &bounds) != EWA_OK || bounds.finite_count != 1000) return 1;
    ewa_renderer *renderer = NULL; // which brings all that draws with it
    if (ewa_renderer_create_on(context, EWA_BACKEND_AUTO, &renderer) != EWA_OK) return 1;
    printf("ewa %s\n", ewa_version());
    ewa_renderer_destroy(&renderer);
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
    return 0;
}
