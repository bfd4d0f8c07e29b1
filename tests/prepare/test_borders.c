// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/estimate/local_border_body.h and local_body.h: where samples end, and what is no surface.
#include "prepare/square.h"

/// Samples a square, with or without a hole of radius 12 in its middle.
static ewa_cloud *without_borders(ewa_context *context, sampling kind, bool hole) {
    static float xyz[3 * MAXIMUM];
    uint32_t count = sample_square(kind, xyz), kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (hole && hypot((double)xyz[3 * i] - SIDE / 2.0, (double)xyz[3 * i + 1] - SIDE / 2.0) < 12) continue;
        memmove(&xyz[3 * kept++], &xyz[3 * i], 3 * sizeof *xyz);
    }
    void *data = NULL;
    ewa_cloud *cloud = check_cloud_of(context, kept);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &data), EWA_OK);
    memcpy(data, xyz, 3 * kept * sizeof *xyz);
    return cloud;
}

/// The same, estimated.
static ewa_cloud *with_borders(ewa_context *context, sampling kind, ewa_surfel_shape shape, bool hole) {
    ewa_cloud *cloud = without_borders(context, kind, hole);
    ewa_estimate_options options = check_estimate_options();
    options.shape = shape;
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    return cloud;
}

/// How far a place is inside of the square, and of the hole's rim.
static double depth_of(const float *p, bool hole) {
    const double side = (double)fminf(fminf(p[0], p[1]), fminf(SIDE - p[0], SIDE - p[1]));
    return hole ? fmin(side, hypot((double)p[0] - SIDE / 2.0, (double)p[1] - SIDE / 2.0) - 12) : side;
}

/// Where two borders meet.
static bool is_at_corner(const float *p) {
    return fminf(fabsf(p[0] - SIDE / 2), fabsf(p[1] - SIDE / 2)) > SIDE / 2 - 8;
}

/// Borders are where the samples end, and nowhere else; discs reach no farther, lengths in spacings.
TEST_ON(test_borders, 2) {
    static const sampling kinds[] = {REGULAR, JITTERED, SCATTERED, HEXAGONAL, POISSON};
    for (int k = 0; k < 10; k++) {
        const bool hole = k >= 5;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = with_borders(context, kinds[k % 5], EWA_SHAPE_DISC, hole);
        const float *p = check_stream(cloud, EWA_POSITION), *to = check_stream(cloud, EWA_BORDER);
        const float *radius = check_stream(cloud, EWA_RADIUS);
        double off = 0, over = 0;
        uint64_t near = 0;
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++, p += 3, to += 3) {
            const double depth = depth_of(p, hole), x = (double)to[0], y = (double)to[1], length = hypot(x, y);
            const bool ends = length > 0;
            assert_true(to[2] == 0 && (depth < 3.5 || !ends)); // far from all borders there is none
            assert_true(!ends || length < (double)radius[i]);
            if (is_at_corner(p)) continue;
            over = fmax(over, (ends ? length : (double)radius[i]) - depth);
            off += ends ? fabs(length - depth) : 0;
            near += ends;
        }
        print_message("%d%s: %llu at borders, %.3f off, %.3f over\n", (int)kinds[k % 5], hole ? ", hole" : "",
                      (unsigned long long)near, off / (double)near, over);
        assert_true(near >= 4 * (SIDE - 16) && off / (double)near < 0.4 && over < 3);
    }
}

/// A sample of a camera's grid stands for its cell: half of one lies beyond the outermost, seen from the eye, which is the origin.
TEST_ON(test_cells, 2) {
    static const double heights[] = {0, 1e4, 1e-3}; // of the eye over the plane; the first has no grid
    double mean[3] = {0};
    ewa_cloud *clouds[3];
    for (int k = 0; k < 3; k++) {
        clouds[k] = without_borders(context, SCATTERED, false);
        if (k) assert_int_equal(ewa_cloud_set_note(clouds[k], "file.organised", "64 x 64", 7), EWA_OK);
        if (k) ewa_cloud_set_origin(clouds[k], (const double[3]){SIDE, SIDE, -heights[k]});
        const ewa_estimate_options options = check_estimate_options();
        assert_int_equal(ewa_cloud_estimate(&clouds[k], &options), EWA_OK);
    }
    uint64_t count = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(clouds[0]); i++) {
        double length[3];
        for (int k = 0; k < 3; k++) {
            const float *to = check_stream(clouds[k], EWA_BORDER) + 3 * i;
            length[k] = hypot((double)to[0], (double)to[1]);
        }
        if (!(length[0] > 0 && length[1] > 0 && length[2] > 0)) continue;
        for (int k = 0; k < 3; k++) mean[k] += length[k];
        count++;
    }
    print_message("%llu places: %.3f, %.3f, %.3f spacings\n", (unsigned long long)count, mean[0] / (double)count, mean[1] / (double)count,
                  mean[2] / (double)count);
    assert_true(count > 100);
    assert_true(fabs(mean[1] - mean[0] - 0.3 * (double)count) < 0.1 * (double)count);
    assert_true(fabs(mean[2] - mean[1] - 0.5 * (double)count) < 0.1 * (double)count);
    for (int k = 0; k < 3; k++) ewa_cloud_destroy(&clouds[k]);
}

/// What has no border gets no stream; axes get clip lines where discs get borders.
TEST_ON(test_borders_as_streams, 2) {
    enum { POINTS = 20000 };
    for (int s = 0; s < 2; s++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = with_borders(context, POISSON, (ewa_surfel_shape)s, false);
        assert_true((ewa_cloud_find(cloud, EWA_BORDER) != NULL) == (s == EWA_SHAPE_DISC));
        assert_true((ewa_cloud_find(cloud, EWA_CLIP0) != NULL) == (s == EWA_SHAPE_ELLIPSE));
        // The nearest point of a line is where the border is.
        double off = 0, lines = 0;
        for (uint64_t i = 0; s == EWA_SHAPE_ELLIPSE && i < ewa_cloud_point_count(cloud); i++) {
            const float *p = check_stream(cloud, EWA_POSITION) + 3 * i, *line = check_stream(cloud, EWA_CLIP0) + 3 * i;
            const float *u = check_stream(cloud, EWA_TANGENT_U) + 3 * i,
                        *v = check_stream(cloud, EWA_TANGENT_V) + 3 * i;
            if ((line[0] == 0 && line[1] == 0) || is_at_corner(p)) continue;
            double uu = 0, vv = 0, to[2];
            for (int c = 0; c < 3; c++)
                uu += (double)u[c] * (double)u[c], vv += (double)v[c] * (double)v[c];
            const double a = (double)line[0] / uu, b = (double)line[1] / vv;
            for (int c = 0; c < 2; c++) to[c] = a * (double)u[c] + b * (double)v[c];
            const double slope = hypot(to[0], to[1]), length = (double)line[2] / slope;
            assert_true(length > 0 && length < 4);
            for (int c = 0; c < 2; c++) to[c] = (double)p[c] - to[c] / slope * length;
            off += fabs(fmax(fabs(to[0] - SIDE / 2.0), fabs(to[1] - SIDE / 2.0)) - SIDE / 2.0);
            lines++;
        }
        if (s == EWA_SHAPE_ELLIPSE) print_message("ellipses: %.0f lines, %.3f off\n", lines, off / lines);
        assert_true(s == EWA_SHAPE_DISC || (lines > 300 && off < 0.3 * lines));
    }
    check_random random = {3};
    OWNED(ewa_cloud_destroy) ewa_cloud *sphere = check_cloud_of(context, POINTS);
    float *p = check_add(sphere, EWA_POSITION, EWA_F32, 3);
    for (int i = 0; i < POINTS; i++) {
        const double z = check_uniform(&random, -1, 1), angle = check_uniform(&random, 0, 6.283185307179586);
        p[3 * i] = (float)(sqrt(1 - z * z) * cos(angle)), p[3 * i + 1] = (float)(sqrt(1 - z * z) * sin(angle));
        p[3 * i + 2] = (float)z;
    }
    ewa_estimate_options options = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(&sphere, &options), EWA_OK);
    assert_null(ewa_cloud_find(sphere, EWA_BORDER));
}

/// Points strewn in space are no surface; a plane has no such attribute, and keeps none of before.
TEST_ON(test_surfaceness, 2) {
    enum { COUNT = 4000 };
    for (int kind = 0; kind < 4; kind++) { // a plane; in space; a plane and a wire above it; a box's edge
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, COUNT);
        float *xyz = check_add(cloud, EWA_POSITION, EWA_F32, 3);
        float *before = check_add(cloud, EWA_SURFACENESS, EWA_F32, 1);
        check_random random = {7};
        for (int i = 0; i < COUNT; i++) {
            const bool wire = kind == 2 && i % 40 == 0;
            before[i] = 0;
            for (int c = 0; c < 3; c++) xyz[3 * i + c] = (float)check_uniform(&random, -1, 1);
            if (wire) xyz[3 * i] = xyz[3 * i + 1] / 2, xyz[3 * i + 2] = 3;
            if (kind != 1 && !wire) xyz[3 * i + 2] = 0;
            if (kind == 3) xyz[3 * i] = fabsf(xyz[3 * i]);
            if (kind == 3 && i % 2) xyz[3 * i + 2] = xyz[3 * i], xyz[3 * i] = 0;
        }
        const ewa_estimate_options options = check_estimate_options();
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const ewa_attribute *made = ewa_cloud_find(cloud, EWA_SURFACENESS);
        if (kind == 0) assert_null(made);
        double strewn = 0, wires = 0;
        for (int i = 0; made && i < COUNT; i++) {
            const double none = 1 - (double)((const float *)made->data)[i];
            assert_true(none >= 0 && none <= 1);
            strewn += none >= 0.5;
            wires += none >= 0.5 && kind == 2 && i % 40 == 0;
        }
        print_message("kind %d: %.3f are no surface, of the wire %.2f\n", kind, strewn / COUNT, 40 * wires / COUNT);
        if (kind == 1) assert_true(strewn > 0.7 * COUNT);
        if (kind == 2) assert_true(wires > 0.9 * COUNT / 40 && strewn - wires < 0.001 * COUNT);
        if (kind == 3) assert_true(strewn < 0.01 * COUNT);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
