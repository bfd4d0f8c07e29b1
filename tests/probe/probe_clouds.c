// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds: what makes them, measures them, and turns them into surfels.
#include "tests/probe/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static ewa_cloud *generate(probe *to, ewa_object object, uint64_t count, bool sharp, bool texcoords) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object, options.point_count = count;
    options.sharp = sharp, options.texcoords = texcoords;
    ewa_cloud *cloud = NULL;
    probe_status(to, "generate", ewa_cloud_generate(to->context, &options, &cloud));
    return cloud;
}

void probe_generated(probe *to) {
    for (int object = 0; object <= EWA_OBJECT_CSG; object++)
        for (int sharp = 0; sharp < 2; sharp++) {
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud =
                generate(to, (ewa_object)object, object == EWA_OBJECT_CSG ? 1500 : 400, sharp, true);
            probe_cloud(to, "generated", cloud);
        }
}

/// Positions only, moved off the surface.
static ewa_cloud *noisy(probe *to, ewa_object object, uint64_t count, double noise) {
    ewa_cloud *cloud = generate(to, object, count, false, false);
    ewa_cloud_remove(cloud, EWA_NORMAL), ewa_cloud_remove(cloud, EWA_RADIUS);
    float *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    uint64_t state = 5;
    for (uint64_t i = 0; i < 3 * ewa_cloud_point_count(cloud); i++)
        position[i] += (float)(noise * (probe_random(&state) - 0.5));
    return cloud;
}

/// Lines of a scanner: dense along, sparse across.
static ewa_cloud *scan_lines(probe *to) {
    ewa_cloud *cloud = NULL;
    void *data = NULL;
    if (ewa_cloud_create(to->context, 600, &cloud) != EWA_OK) abort();
    if (ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data) != EWA_OK) abort();
    double *position = data;
    for (int i = 0; i < 600; i++) {
        const double x = 0.01 * (i % 100), y = 0.08 * (i / 100);
        position[3 * i] = x, position[3 * i + 1] = y, position[3 * i + 2] = 0.1 * sin(5 * x) * cos(4 * y);
    }
    return cloud;
}

void probe_estimates(probe *to) {
    for (int k = 0; k < 9; k++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *cloud = k == 6   ? scan_lines(to)
                           : k == 7 ? noisy(to, EWA_OBJECT_CUBE, 900, 0)
                                    : noisy(to, k % 2 ? EWA_OBJECT_TORUS : EWA_OBJECT_TERRAIN, 900, 0.02);
        WITH_DEFAULTS(ewa_estimate_options, options);
        options.shape = k % 3 == 1 ? EWA_SHAPE_ELLIPSE : EWA_SHAPE_DISC;
        options.orientation = k == 2 ? EWA_ORIENT_VIEWPOINT : k == 3 ? EWA_ORIENT_NONE : EWA_ORIENT_PROPAGATE;
        options.viewpoint_world[2] = 5;
        options.neighbour_count = k == 4 ? 8 : k == 5 ? 30 : 16;
        options.outlier_factor = k == 0 || k == 5 ? 1.5 : 0;
        ewa_spacing spacing;
        memset(&spacing, 0, sizeof spacing);
        probe_status(to, "spacing", ewa_cloud_measure_spacing(cloud, k == 8 ? 100 : 0, &spacing));
        const double numbers[5] = {spacing.median_world, spacing.mean_world, spacing.low_world,
                                   spacing.high_world, (double)spacing.duplicate_count};
        probe_doubles(to, "spacing", PROBE_NUMBERS, numbers, 5);
        probe_status(to, "estimate", ewa_cloud_estimate(&cloud, &options));
        probe_cloud(to, "estimated", cloud);
    }
}

void probe_edited(probe *to) {
    ewa_cloud *cloud = generate(to, EWA_OBJECT_CUBE, 300, true, false), *selected = NULL, *merged = NULL;
    static const uint64_t indices[5] = {3, 1, 4, 1, 250};
    const double origin[3] = {10, -20, 30},
                 map[16] = {1, 0.2, 0, 5, 0.1, 2, 0.3, -6, 0, 0.1, 0.7, 7, 0, 0, 0, 1};
    probe_status(to, "select", ewa_cloud_select(cloud, indices, 5, &selected));
    probe_cloud(to, "selected", selected);
    ewa_cloud_set_origin(selected, origin);
    const ewa_cloud *both[2] = {cloud, selected};
    probe_status(to, "merge", ewa_cloud_merge(both, 2, &merged));
    probe_cloud(to, "merged", merged);
    probe_status(to, "transform", ewa_cloud_transform(cloud, map));
    probe_cloud(to, "transformed", cloud);
    ewa_bounds bounds;
    probe_status(to, "measure", ewa_cloud_measure(merged, &bounds));
    probe_doubles(to, "bounds", PROBE_NUMBERS, bounds.low_world, 6);
    probe_status(to, "measure", ewa_cloud_measure(cloud, &bounds));
    probe_doubles(to, "bounds", PROBE_NUMBERS, bounds.low_world, 6);
    ewa_cloud_destroy(&cloud), ewa_cloud_destroy(&selected), ewa_cloud_destroy(&merged);
    cloud = generate(to, EWA_OBJECT_SPHERE, 300, false, false);
    probe_status(to, "transform discs", ewa_cloud_transform(cloud, map));
    probe_cloud(to, "transformed discs", cloud);
    ewa_cloud_destroy(&cloud);
}

void probe_solids(probe *to) {
    static const ewa_object operands[4][2] = {{EWA_OBJECT_SPHERE, EWA_OBJECT_CUBE},
                                              {EWA_OBJECT_CUBE, EWA_OBJECT_CUBE},
                                              {EWA_OBJECT_TORUS, EWA_OBJECT_SPHERE},
                                              {EWA_OBJECT_CSG, EWA_OBJECT_TORUS}};
    for (int k = 0; k < (to->brief ? 4 : 12); k++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *a = generate(to, operands[k % 4][0], 1500, k % 2, false),
                  *b = generate(to, operands[k % 4][1], 1200, k % 4 == 1, false), *result = NULL;
        // Along an axis, where faces of two cubes lie in one plane, or turned.
        const double along[16] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                     turned[16] = {0.8, -0.6, 0, 0.3, 0.6, 0.8, 0, 0.2, 0, 0, 1, 0.35, 0, 0, 0, 1};
        ewa_cloud_transform(b, k % 4 == 1 ? along : turned);
        WITH_DEFAULTS(ewa_csg_options, options);
        options.operation = (ewa_csg_operation)(k / 4);
        probe_status(to, "csg", ewa_cloud_csg(a, b, &options, &result));
        probe_cloud(to, "solid", result);
    }
}

void probe_features(probe *to) {
    for (int k = 0; k < 5; k++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *cloud = noisy(to, k % 2 ? EWA_OBJECT_CSG : EWA_OBJECT_CUBE, 2500, k >= 3 ? 0.03 : 0);
        WITH_DEFAULTS(ewa_feature_options, options);
        options.angle_deg = k == 2 ? 60 : 30;
        options.project = k != 1;
        ewa_feature_counts counts;
        memset(&counts, 0, sizeof counts);
        WITH_DEFAULTS(ewa_estimate_options, estimate);
        probe_status(to, "estimate", ewa_cloud_estimate(&cloud, &estimate));
        probe_status(to, "features", ewa_cloud_detect_features(cloud, &options, &counts));
        const double numbers[5] = {(double)counts.snapped_count, (double)counts.edge_count,
                                   (double)counts.corner_count, counts.noise, counts.neighbour_count};
        for (int i = 0; i < 5; i++) probe_number(to, "feature counts", numbers[i]);
        probe_cloud(to, "features", cloud);
    }
}

static ewa_image picture(probe *to, uint32_t side, uint32_t channels) {
    ewa_image image;
    if (ewa_image_create(to->context, side, side, channels, &image) != EWA_OK) abort();
    uint64_t state = 77;
    for (uint32_t i = 0; i < side * side * channels; i++) {
        const uint32_t x = i / channels % side, y = i / channels / side;
        image.pixels[i] = (float)(0.2 + 0.6 * ((x / 5 + y / 7) % 2) + 0.2 * probe_random(&state));
    }
    for (uint32_t i = 3; channels == 4 && i < side * side * 4; i += 4)
        for (uint32_t c = 1; c < 4; c++) image.pixels[i - c] *= image.pixels[i];
    return image;
}

void probe_textured(probe *to) {
    for (int k = 0; k < 8; k++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *cloud = generate(to, k % 2 ? EWA_OBJECT_SPHERE : EWA_OBJECT_CUBE, 700, false, true);
        OWNED(ewa_image_free) ewa_image image = picture(to, k < 4 ? 32 : 90, k == 3 ? 4 : k == 5 ? 1 : 3);
        WITH_DEFAULTS(ewa_acquire_options, options);
        options.filter = (ewa_texture_filter)(k % 3);
        options.fit = k == 5 ? EWA_FIT_SUM : EWA_FIT_NORMALIZED;
        options.wrap_s = options.wrap_t = k >= 4 ? EWA_TEXTURE_CLAMP : EWA_TEXTURE_REPEAT;
        options.modulate = k == 6;
        ewa_acquire_report report;
        memset(&report, 0, sizeof report);
        probe_status(to, "acquire", ewa_cloud_acquire(cloud, &image, 1, &options, &report));
        probe_number(to, "textured", (double)report.textured_count);
        probe_number(to, "pairs", (double)report.pair_count);
        probe_cloud(to, "acquired", cloud);
        WITH_DEFAULTS(ewa_refit_options, refit);
        refit.goal = k % 2 ? EWA_REFIT_FIT : EWA_REFIT_INTERPOLATE;
        ewa_refit_report refitted;
        memset(&refitted, 0, sizeof refitted);
        probe_status(to, "refit", ewa_cloud_refit_colors(cloud, &refit, &refitted));
        probe_number(to, "refitted", (double)refitted.surfel_count);
        probe_number(to, "before", refitted.before_rms);
        probe_cloud(to, "refitted", cloud);
        ewa_procedure_options procedure;
        ewa_procedure_options_init(&procedure, (ewa_procedure)(k % 4), sizeof procedure);
        procedure.frequency = k < 4 ? 3 : 20;
        probe_status(to, "procedure", ewa_cloud_color_by_procedure(cloud, &procedure));
        probe_cloud(to, "procedure", cloud);
    }
}

/// A box with a step, whose faces have texture coordinates and two materials, and a fold that is not sharp.
void probe_sampled(probe *to) {
    static const float positions[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},    {0, 1, 0},    {0, 0, 1},
                                         {1, 0, 1}, {1, 1, 1}, {0, 1, 1.3f}, {2, 0, 0.2f}, {2, 1, 0.4f}};
    static const uint32_t triangles[][3] = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6},
                                            {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7},
                                            {4, 5, 6}, {4, 6, 7}, {1, 8, 9}, {1, 9, 2}};
    for (int k = 0; k < 6; k++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        if (ewa_mesh_create(to->context, 10, 14, 2, EWA_MESH_COLORS | EWA_MESH_TEXCOORDS, &mesh) != EWA_OK)
            abort();
        for (uint32_t i = 0; i < 10; i++)
            for (uint32_t c = 0; c < 3; c++) {
                mesh.positions[3 * i + c] = (double)positions[i][c];
                mesh.colors[4 * i + c] = 0.3f + 0.06f * (float)((i + c) % 10);
                mesh.colors[4 * i + 3] = 1;
                if (c < 2) mesh.texcoords[2 * i + c] = positions[i][c] + 0.3f * positions[i][2];
            }
        for (uint32_t i = 0; i < 14; i++) {
            for (uint32_t c = 0; c < 3; c++) mesh.triangles[3 * i + c] = triangles[i][c];
            mesh.triangle_materials[i] = i % 2;
        }
        for (int m = 0; m < 2; m++)
            for (int c = 0; c < 4; c++)
                mesh.materials[m].base_color[c] = c == 3 ? 1 : 0.5f + 0.1f * (float)(m + c);
        if (k >= 3) mesh.textures[1] = picture(to, 24, 3);
        WITH_DEFAULTS(ewa_mesh_sample_options, options);
        options.point_count = 400 + 300 * (uint64_t)k;
        options.texcoords = k == 2;
        options.smooth_normals = k != 1;
        options.crease_degrees = k == 4 ? 80 : 35;
        options.clip_lines = k != 5;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        probe_status(to, "sample", ewa_mesh_sample(&mesh, &options, &cloud));
        probe_cloud(to, "sampled", cloud);
    }
}
