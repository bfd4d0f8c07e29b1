// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/estimate/estimate.c and local_body.h: normals, spacing, radii and axes against known samplings.
#include "prepare/square.h"

static bool is_inner(const float *p) { return fminf(fminf(p[0], p[1]), fminf(SIDE - p[0], SIDE - p[1])) > 6; }

TEST_ON(test_spacing, 2) {
    for (int kind = 0; kind < SAMPLINGS; kind++) {
        float xyz[3 * MAXIMUM];
        const uint32_t count = sample_square((sampling)kind, xyz);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, count);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, xyz, 0), EWA_OK);
        ewa_spacing spacing;
        assert_int_equal(ewa_cloud_measure_spacing(cloud, 0, &spacing), EWA_OK);
        assert_true(fabs(spacing.median_world - 1) < 0.045);
        assert_true(fabs(spacing.mean_world - 1) < 0.045);
        assert_int_equal(spacing.duplicate_count, 0);
        if (kind == REGULAR) assert_true(spacing.low_world > 0.99 && spacing.high_world < 1.1);
        // A sample tells about the same.
        ewa_spacing sampled, again;
        assert_int_equal(ewa_cloud_measure_spacing(cloud, 1000, &sampled), EWA_OK);
        assert_int_equal(ewa_cloud_measure_spacing(cloud, 1000, &again), EWA_OK);
        assert_memory_equal(&sampled, &again, sizeof again);
        assert_true(fabs(sampled.median_world - spacing.median_world) < 0.03);

        ewa_estimate_options options = check_estimate_options();
        options.cutoff = 2; // larger cutoffs need larger supports to cover irregular cells
        options.radius_scale = 1.5;
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const float *radius = check_stream(cloud, EWA_RADIUS), *normal = check_stream(cloud, EWA_NORMAL);
        double inner = 0, border = 0, inner_count = 0, border_count = 0;
        for (uint32_t i = 0; i < count; i++) {
            const float *p = &xyz[3 * i];
            assert_true(normal[3 * i] == 0 && normal[3 * i + 1] == 0 && normal[3 * i + 2] == 1);
            if (is_inner(p)) inner += radius[i], inner_count++;
            if (fminf(fminf(p[0], p[1]), fminf(SIDE - p[0], SIDE - p[1])) < 1)
                border += radius[i], border_count++;
        }
        inner /= inner_count;
        border /= border_count;
        assert_true(fabs(inner / options.radius_scale - 1) < 0.045);
        // What a cell reaches beyond a spacing counts twice, which long cells at the border do on one side.
        assert_true(border < (kind == STRETCHED ? 1.25 : 1.2) * inner && border > 0.9 * inner);
    }
}

/// Shares of the inner square that no disc covers: the plain 1.2 spacings would leave 1 % of a random
/// sampling open.
TEST_ON(test_no_holes, 2) {
    for (int kind = 0; kind < SAMPLINGS; kind++) {
        float xyz[3 * MAXIMUM];
        const uint32_t count = sample_square((sampling)kind, xyz);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, count);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, xyz, 0), EWA_OK);
        ewa_estimate_options options = check_estimate_options();
        options.radius_scale = 0.75;
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const float *radius = check_stream(cloud, EWA_RADIUS);
        check_random random = {9};
        int open = 0;
        enum { PROBES = 4000 };
        for (int probe = 0; probe < PROBES; probe++) {
            const double x = check_uniform(&random, 6, SIDE - 6), y = check_uniform(&random, 6, SIDE - 6);
            bool covered = false;
            for (uint32_t i = 0; i < count && !covered; i++) {
                const double dx = x - (double)xyz[3 * i], dy = y - (double)xyz[3 * i + 1];
                covered = dx * dx + dy * dy < (double)radius[i] * (double)radius[i];
            }
            open += !covered;
        }
        assert_in_range(open, 0, kind == POISSON ? PROBES / 400 : PROBES / 2000);
    }
}

TEST_ON(test_axes, 2) {
    float xyz[3 * MAXIMUM];
    const uint32_t count = sample_square(STRETCHED, xyz);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, count);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, xyz, 0), EWA_OK);
    ewa_estimate_options options = check_estimate_options();
    options.shape = EWA_SHAPE_ELLIPSE;
    options.cutoff = 1.5;
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    assert_null(ewa_cloud_find(cloud, EWA_RADIUS));
    const float *u = check_stream(cloud, EWA_TANGENT_U), *v = check_stream(cloud, EWA_TANGENT_V);
    const float *normal = check_stream(cloud, EWA_NORMAL);
    uint32_t checked = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double ux = u[3 * i], uy = u[3 * i + 1], vx = v[3 * i], vy = v[3 * i + 1];
        assert_true((ux * vy - uy * vx) * (double)normal[3 * i + 2] > 0);
        assert_true(fabs(ux * vx + uy * vy) < 1e-5);
        const double longer = hypot(ux, uy), shorter = hypot(vx, vy);
        assert_true(longer >= shorter && longer <= 4.001 * shorter);
        if (!is_inner(&xyz[3 * i])) continue;
        checked++;
        assert_true(fabs(longer / shorter / STRETCH - 1) < 0.1);
        assert_true(fabs(ux * sin(TURN) - uy * cos(TURN)) < 0.035 * longer); // 2 degrees
        const double radius = 1.5 * sqrt(longer * shorter);
        assert_true(fabs(radius - 1) < 0.045);
    }
    assert_true(checked > count / 2);
}

/// A scanner's lines 20 samples apart: 16 neighbours are all on one line, and say nothing about the surface.
TEST_ON(test_scan_lines, 2) {
    enum { ALONG = 600, LINES = 40, GAP = 20, LINE_COUNT = ALONG * LINES };
    float *xyz = NULL;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, LINE_COUNT, &xyz);
    check_random random = {12};
    for (uint32_t i = 0; i < LINE_COUNT; i++) {
        xyz[3 * i] = (float)(i % ALONG + check_uniform(&random, -0.3, 0.3));
        xyz[3 * i + 1] = (float)(i / ALONG * GAP);
        xyz[3 * i + 2] = 0.5f * xyz[3 * i + 1];
    }
    ewa_estimate_options options = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    const float *normal = check_stream(cloud, EWA_NORMAL), *radius = check_stream(cloud, EWA_RADIUS);
    const float half_gap = 0.5f * GAP * sqrtf(1.25f);
    for (uint32_t i = 0; i < LINE_COUNT; i++) {
        const float cosine = (normal[3 * i + 2] - 0.5f * normal[3 * i + 1]) / sqrtf(1.25f);
        assert_true(cosine > 0.999f);
        const uint32_t along = i % ALONG, line = i / ALONG;
        if (along < 40 || along >= ALONG - 40 || line < 2 || line >= LINES - 2) continue;
        assert_true(radius[i] > half_gap && radius[i] < 4 * half_gap);
    }
}

/// PCA against the true normal of a sphere, also for doubles far from the origin.
TEST_ON(test_normals, 2) {
    enum { COUNT = 20000 };
    for (int far = 0; far < 2; far++) {
        const double center[3] = {far ? 512345.25 : 0, far ? 5412345.5 : 0, far ? 321.0 : 0};
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, COUNT);
        double *xyz = check_add(cloud, EWA_POSITION, EWA_F64, 3);
        check_random random = {4};
        for (uint32_t i = 0; i < COUNT; i++) {
            double d[3];
            check_direction(&random, d);
            for (int c = 0; c < 3; c++) xyz[3 * i + (uint32_t)c] = center[c] + d[c];
        }
        ewa_estimate_options options = check_estimate_options();
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const float *normal = check_stream(cloud, EWA_NORMAL);
        double worst = 1, sum = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            double cosine = 0, length2 = 0;
            for (uint32_t c = 0; c < 3; c++) {
                cosine += (xyz[3 * i + c] - center[c]) * (double)normal[3 * i + c];
                length2 += (double)normal[3 * i + c] * (double)normal[3 * i + c];
            }
            assert_true(fabs(length2 - 1) < 1e-5);
            worst = fmin(worst, cosine);
            sum += cosine;
        }
        assert_true(worst > cos(0.06)); // the neighbourhoods span 0.06
        assert_true(sum / COUNT > 1 - 1e-4);
    }
}

TEST_ON(test_keep, 2) {
    float xyz[3 * MAXIMUM];
    const uint32_t count = sample_square(JITTERED, xyz);
    for (int keep = 0; keep < 2; keep++) {
        float *tangent = NULL;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, count);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, xyz, 0), EWA_OK);
        float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
        for (uint32_t i = 0; i < 3 * count; i++) normal[i] = 7;
        for (int t = 0; t < 2; t++) {
            assert_int_equal(ewa_cloud_add(cloud, t ? EWA_TANGENT_V : EWA_TANGENT_U, EWA_F32, 3, (void **)&tangent), EWA_OK);
            for (uint32_t i = 0; i < 3 * count; i++) tangent[i] = 8;
        }
        ewa_estimate_options options = check_estimate_options();
        options.keep_normals = options.keep_radii = keep;
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        assert_true((check_stream(cloud, EWA_NORMAL)[2] == 7) == (bool)keep);
        if (keep) {
            assert_true(check_stream(cloud, EWA_TANGENT_U)[0] == 8);
            assert_null(ewa_cloud_find(cloud, EWA_RADIUS));
        } else {
            assert_null(ewa_cloud_find(cloud, EWA_TANGENT_U));
            assert_non_null(ewa_cloud_find(cloud, EWA_RADIUS));
        }
    }
}

/// Fills `count` points with one of many useless shapes.
static void make_degenerate(int kind, uint32_t i, check_random *random, float p[3]) {
    const double a = check_uniform(random, -1, 1), b = check_uniform(random, -1, 1);
    p[0] = p[1] = p[2] = 0;
    switch (kind) {
    case 0:
        p[0] = p[1] = p[2] = 0.5f;
        break; // identical
    case 1:
        p[0] = p[1] = p[2] = (float)a;
        break; // collinear
    case 2:
        p[2] = (float)a;
        break; // collinear, upright
    case 3:
        p[0] = (float)a, p[1] = (float)b;
        break; // coplanar
    case 4:
        p[i % 3] = i % 2 ? NAN : INFINITY;
        break; // nothing finite
    case 5:
        p[0] = i % 4 ? NAN : (float)a, p[1] = (float)b;
        break; // little finite
    case 6:
        p[0] = (float)(a * 1e30), p[1] = (float)(b * 1e30), p[2] = (float)(a * b * 1e30);
        break;
    case 7:
        p[0] = (float)(a * 1e-30), p[1] = (float)(b * 1e-30);
        break;
    case 8:
        p[0] = i % 2 ? (float)a : 1e30f, p[1] = (float)b;
        break;
    case 9:
        p[0] = (float)floor(4 * a), p[1] = (float)floor(4 * b);
        break; // clumps
    default:
        p[0] = a > 0 ? 3e38f : -3e38f, p[1] = b > 0 ? 3e38f : -3e38f;
        break;
    }
}

TEST_ON(test_degenerate, 2) {
    static const uint32_t counts[] = {0, 1, 2, 3, 4, 7, 16, 17, 1000};
    for (int kind = 0; kind < 11; kind++)
        for (size_t n = 0; n < sizeof counts / sizeof counts[0]; n++)
            for (int shape = 0; shape < 2; shape++) {
                float *xyz = NULL;
                OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, counts[n], &xyz);
                check_random random = {(uint64_t)kind};
                for (uint32_t i = 0; i < counts[n]; i++) make_degenerate(kind, i, &random, &xyz[3 * i]);
                ewa_estimate_options options = check_estimate_options();
                options.shape = shape ? EWA_SHAPE_ELLIPSE : EWA_SHAPE_DISC;
                assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
                const float *normal = check_stream(cloud, EWA_NORMAL);
                const float *size = check_stream(cloud, shape ? EWA_TANGENT_U : EWA_RADIUS);
                for (uint32_t i = 0; i < counts[n]; i++) {
                    const float *p = &xyz[3 * i], *at = &normal[3 * i];
                    const bool finite = isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
                    const float length2 = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
                    if (finite)
                        assert_true(fabsf(length2 - 1) < 1e-4f);
                    else
                        assert_true(length2 == 0);
                    for (uint32_t c = 0; c < (shape ? 3 : 1); c++) {
                        const float value = size[(shape ? 3 : 1) * i + c];
                        // The extent of 6e38 has no radius in single precision.
                        assert_true(kind == 10 || isfinite(value));
                        if (!finite) assert_true(value == 0);
                        if (!shape && finite) assert_true(value >= 0);
                    }
                }
                ewa_spacing spacing;
                assert_int_equal(ewa_cloud_measure_spacing(cloud, 0, &spacing), EWA_OK);
                if (kind != 10) assert_true(isfinite(spacing.mean_world) && spacing.median_world >= 0);
                if (kind == 0 && counts[n] > 1) assert_int_equal(spacing.duplicate_count, counts[n]);
            }
}

/// A bumpy surface with uneven sampling, duplicates and a few points that are not finite.
static void make_uneven(float *xyz, uint32_t count) {
    check_random random = {8};
    for (uint32_t i = 0; i < count; i++) {
        const double a = check_uniform(&random, 0, 1), b = check_uniform(&random, -1, 1);
        xyz[3 * i] = (float)(a * a * a);
        xyz[3 * i + 1] = (float)b;
        xyz[3 * i + 2] = (float)(0.1 * sin(9 * a * a * a) * cos(7 * b) + check_uniform(&random, 0, 1e-3));
        if (i % 50 == 7) memcpy(&xyz[3 * i], &xyz[3 * (i / 2)], 3 * sizeof *xyz);
        if (i % 1000 == 3) xyz[3 * i] = NAN;
    }
}

static ewa_cloud *estimate_uneven(uint32_t threads, uint32_t mask, const float *xyz, uint32_t count,
                                  ewa_surfel_shape shape, ewa_context **context) {
    WITH_DEFAULTS(ewa_context_options, context_options);
    context_options.thread_count = threads;
    context_options.cpu_mask = mask;
    assert_int_equal(ewa_context_create(&context_options, context), EWA_OK);
    ewa_cloud *cloud = check_cloud_of(*context, count);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, xyz, 0), EWA_OK);
    ewa_estimate_options options = check_estimate_options();
    options.shape = shape;
    options.outlier_factor = 4;
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    return cloud;
}

/// Whether the estimate finds sharp edges in a generated object's places, moved by some noise.
static bool tells_edges(ewa_object object, uint64_t count, double noise_spacings) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.point_count = count;
    options.jitter = 1;
    ewa_cloud *made = NULL, *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &made), EWA_OK);
    count = ewa_cloud_point_count(made);
    assert_int_equal(ewa_cloud_create(context, count, &cloud), EWA_OK);
    double(*places)[3] = NULL;
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, (void **)&places), EWA_OK);
    ewa_attribute_read_f64(ewa_cloud_find(made, EWA_POSITION), 0, count, places[0]);
    ewa_cloud_destroy(&made);
    check_random random = {7};
    const double noise = noise_spacings * 5 / sqrt((double)count); // an edge of 2 has some 24 / 5^2 of it
    for (uint64_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) places[i][c] += check_uniform(&random, -noise, noise);
    const ewa_estimate_options estimate = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(&cloud, &estimate), EWA_OK);
    const bool told = ewa_cloud_note(cloud, "estimate.sharp_edges", NULL) != NULL;
    ewa_cloud_destroy(&cloud);
    return told;
}

TEST(test_sharp_edges_are_told) {
    assert_true(tells_edges(EWA_OBJECT_CUBE, 2000, 0));
    assert_true(tells_edges(EWA_OBJECT_CUBE, 100000, 0));
    assert_true(tells_edges(EWA_OBJECT_CSG, 20000, 0));
    assert_false(tells_edges(EWA_OBJECT_CUBE, 20000, 0.2)); // where faces are not flat, detection is less sure
    assert_false(tells_edges(EWA_OBJECT_PLANE, 20000, 0));
    assert_false(tells_edges(EWA_OBJECT_SPHERE, 20000, 0));
    assert_false(tells_edges(EWA_OBJECT_TOWN, 100000, 0));
}

/// Around doubles beyond the range of floats there are no numbers, but nothing that is not finite comes out.
TEST(test_overflow) {
    enum { COUNT = 400 };
    for (int shape = 0; shape < 2; shape++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, COUNT);
        double *xyz = check_add(cloud, EWA_POSITION, EWA_F64, 3);
        check_random random = {8};
        for (uint32_t i = 0; i < 3 * COUNT; i++) xyz[i] = i % 3 == 2 ? 0 : check_uniform(&random, -1, 1);
        xyz[0] = 1e200, xyz[3] = -1e200, xyz[7] = 1.7e308;
        ewa_estimate_options options = check_estimate_options();
        options.shape = shape ? EWA_SHAPE_ELLIPSE : EWA_SHAPE_DISC;
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const float *normal = check_stream(cloud, EWA_NORMAL);
        const float *size = check_stream(cloud, shape ? EWA_TANGENT_U : EWA_RADIUS);
        for (uint32_t i = 0; i < COUNT; i++) {
            const float *n = &normal[3 * i];
            assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-5f);
        }
        for (uint32_t i = 0; i < (shape ? 3u : 1u) * COUNT; i++) assert_true(isfinite(size[i]));
    }
}

TEST(test_threads_and_machines) {
    enum { COUNT = 60000 };
    static const uint32_t threads[] = {2, 7, 32, 1, 1};
    static const uint32_t masks[] = {EWA_CPU_ALL, EWA_CPU_ALL, EWA_CPU_ALL, EWA_CPU_AVX2, 0};
    OWNED(check_free) float *xyz = calloc(3 * (size_t)COUNT, sizeof *xyz);
    make_uneven(xyz, COUNT);
    for (int shape = 0; shape < 2; shape++) {
        ewa_context *first_context = NULL, *context = NULL;
        ewa_cloud *first =
            estimate_uneven(1, EWA_CPU_ALL, xyz, COUNT, (ewa_surfel_shape)shape, &first_context);
        for (int t = 0; t < 5; t++) {
            ewa_cloud *cloud =
                estimate_uneven(threads[t], masks[t], xyz, COUNT, (ewa_surfel_shape)shape, &context);
            assert_int_equal(ewa_cloud_point_count(cloud), ewa_cloud_point_count(first));
            assert_int_equal(ewa_cloud_attribute_count(cloud), ewa_cloud_attribute_count(first));
            for (uint32_t a = 0; a < ewa_cloud_attribute_count(first); a++) {
                const ewa_attribute *l = ewa_cloud_attribute_at(first, a),
                                    *r = ewa_cloud_attribute_at(cloud, a);
                assert_memory_equal(l->data, r->data, l->stride_bytes * ewa_cloud_point_count(first));
            }
            ewa_cloud_destroy(&cloud);
            ewa_context_destroy(&context);
        }
        ewa_cloud_destroy(&first);
        ewa_context_destroy(&first_context);
    }
}

/// Each point's surfel is the same wherever it stands in the file.
TEST(test_order_of_points) {
    enum { COUNT = 20000, STEP = 7919 };
    float *xyz = calloc(6 * (size_t)COUNT, sizeof *xyz), *shuffled = xyz + 3 * (size_t)COUNT;
    make_uneven(xyz, COUNT);
    for (uint64_t i = 0; i < COUNT; i++)
        memcpy(&shuffled[3 * i], &xyz[3 * (i * STEP % COUNT)], 3 * sizeof *xyz);
    ewa_context *contexts[2] = {NULL, NULL};
    ewa_cloud *clouds[2] = {NULL, NULL};
    for (int c = 0; c < 2; c++) {
        contexts[c] = check_context(2, NULL);
        assert_int_equal(ewa_cloud_create(contexts[c], COUNT, &clouds[c]), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(clouds[c], EWA_POSITION, EWA_F32, 3, c ? shuffled : xyz, 0),
                         EWA_OK);
        ewa_estimate_options options = check_estimate_options();
        assert_int_equal(ewa_cloud_estimate(&clouds[c], &options), EWA_OK);
    }
    const float *normal = check_stream(clouds[0], EWA_NORMAL),
                *normal_of_shuffled = check_stream(clouds[1], EWA_NORMAL);
    const float *radius = check_stream(clouds[0], EWA_RADIUS),
                *radius_of_shuffled = check_stream(clouds[1], EWA_RADIUS);
    const float *border = check_stream(clouds[0], EWA_BORDER),
                *border_of_shuffled = check_stream(clouds[1], EWA_BORDER);
    for (uint64_t i = 0; i < COUNT; i++) {
        const uint64_t from = i * STEP % COUNT;
        assert_memory_equal(&normal_of_shuffled[3 * i], &normal[3 * from], 3 * sizeof *normal);
        assert_true(radius_of_shuffled[i] == radius[from]);
        assert_memory_equal(&border_of_shuffled[3 * i], &border[3 * from], 3 * sizeof *border);
    }
    for (int c = 0; c < 2; c++) {
        ewa_cloud_destroy(&clouds[c]);
        ewa_context_destroy(&contexts[c]);
    }
    free(xyz);
}

TEST(test_out_of_memory) {
    enum { COUNT = 2000 };
    OWNED(check_free) float *xyz = calloc(3 * (size_t)COUNT, sizeof *xyz);
    make_uneven(xyz, COUNT);
    for (int shape = 0; shape < 2; shape++) {
        ewa_status status = EWA_ERROR_MEMORY;
        int calls = 0;
        for (; status == EWA_ERROR_MEMORY && calls < 500; calls++) {
            check_memory memory = {.calls_left = -1};
            ewa_context *context = check_context_on(2, &memory);
            ewa_cloud *cloud = check_cloud_of(context, COUNT);
            assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, xyz, 0), EWA_OK);
            ewa_estimate_options options = check_estimate_options();
            options.shape = (ewa_surfel_shape)shape;
            options.outlier_factor = 3;
            memory.calls_left = calls;
            status = ewa_cloud_estimate(&cloud, &options);
            if (status == EWA_OK) {
                memory.calls_left = -1;
            } else {
                assert_int_equal(status, EWA_ERROR_MEMORY);
                assert_null(ewa_cloud_find(cloud, EWA_NORMAL));
                assert_null(ewa_cloud_find(cloud, EWA_RADIUS));
                assert_null(ewa_cloud_find(cloud, EWA_TANGENT_U));
            }
            ewa_cloud_destroy(&cloud);
            ewa_context_destroy(&context);
            assert_int_equal(memory.held_bytes, 0);
        }
        assert_int_equal(status, EWA_OK);
        assert_true(calls > 20);
    }
}

/// What is marked is what the estimate leaves, whatever is marked before; points that are not finite are none.
TEST_ON(test_marked_outliers, 2) {
    enum { COUNT = 3000, FAR = 40 };
    float *xyz = NULL;
    ewa_cloud *cloud = check_cloud(context, COUNT, &xyz), *left = NULL;
    check_random random = {11};
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++) xyz[3 * i + c] = (float)(c == 2 ? 0 : check_uniform(&random, -1, 1));
    for (int i = 0; i < FAR; i++) xyz[3 * i + 2] = (float)(3 + i);
    xyz[3 * FAR] = NAN;
    ewa_estimate_options options = check_estimate_options();
    options.outlier_factor = 1;
    static uint8_t marks[COUNT];
    memset(marks, 1, sizeof marks);
    marks[COUNT - 1] = 0;
    assert_int_equal(ewa_cloud_mark_outliers(cloud, &options, marks), EWA_OK);
    for (int i = 0; i <= FAR; i++) assert_int_equal(marks[i], 0);
    for (int i = FAR + 1; i < COUNT - 1; i++) assert_int_equal(marks[i], 1);
    assert_int_equal(marks[COUNT - 1], 0);
    marks[COUNT - 1] = 1;
    assert_int_equal(ewa_cloud_keep(cloud, marks, &left), EWA_OK);
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(cloud), COUNT - 1 - FAR);
    assert_memory_equal(check_stream(cloud, EWA_POSITION), check_stream(left, EWA_POSITION), (COUNT - 1 - FAR) * 3 * sizeof *xyz);
    ewa_cloud_destroy(&left);
    options.outlier_factor = 0;
    assert_int_equal(ewa_cloud_mark_outliers(cloud, &options, marks), EWA_ERROR_ARGUMENT);
    options.outlier_factor = NAN;
    assert_int_equal(ewa_cloud_mark_outliers(cloud, &options, marks), EWA_ERROR_ARGUMENT);
    options.outlier_factor = 1;
    assert_int_equal(ewa_cloud_mark_outliers(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    ewa_cloud_remove(cloud, EWA_POSITION);
    assert_int_equal(ewa_cloud_mark_outliers(cloud, &options, marks), EWA_ERROR_ARGUMENT);
    ewa_cloud_destroy(&cloud);
}

static bool cancel_at(void *user, const char *stage, double fraction) {
    (void)fraction;
    return strcmp(stage, user) != 0;
}

TEST(test_cancel_and_options) {
    float xyz[3 * MAXIMUM];
    const uint32_t count = sample_square(JITTERED, xyz);
    static char stages[3][16] = {"outliers", "estimate", "orient"};
    for (int s = 0; s < 3; s++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_telling(0, cancel_at, stages[s]);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, count);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, xyz, 0), EWA_OK);
        ewa_estimate_options options = check_estimate_options();
        options.outlier_factor = 3;
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_CANCELLED);
        assert_null(ewa_cloud_find(cloud, EWA_NORMAL));
        ewa_estimate_options wrong = options;
        wrong.neighbour_count = 5;
        assert_int_equal(ewa_cloud_estimate(&cloud, &wrong), EWA_ERROR_ARGUMENT);
        wrong = options;
        wrong.radius_scale = NAN;
        assert_int_equal(ewa_cloud_estimate(&cloud, &wrong), EWA_ERROR_ARGUMENT);
        wrong = options;
        wrong.outlier_factor = -1;
        assert_int_equal(ewa_cloud_estimate(&cloud, &wrong), EWA_ERROR_ARGUMENT);
        ewa_cloud_remove(cloud, EWA_POSITION);
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_ERROR_ARGUMENT);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
