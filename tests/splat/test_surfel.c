// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/surface/surfel.c and options.c: what streams become, what is left out, what is refused.
#include "check.h"
#include "surface/options.h"
#include "surface/semantics.h"
#include "surface/surfel.h"

#include <math.h>
#include <string.h>

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static ewa_cloud *make_cloud(ewa_context *context, uint64_t count) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    return cloud;
}

static void *add(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t components) {
    void *data = NULL;
    assert_int_equal(ewa_cloud_add(cloud, name, type, components, &data), EWA_OK);
    return data;
}

static void open_reader(const ewa_cloud *cloud, double cutoff, double radius_scale,
                        ewa_surfel_reader *reader) {
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.cutoff = cutoff;
    options.radius_scale = radius_scale;
    assert_int_equal(ewa_surfel_reader_open(cloud, &options, reader), EWA_OK);
}

/// Discs: orthogonal axes of length radius * scale / F across the unit normal, right-handed with it.
TEST_ON(test_discs, 1) {
    enum { COUNT = 1000 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, COUNT);
    double *position = add(cloud, EWA_POSITION, EWA_F64, 3);
    float *normal = add(cloud, EWA_NORMAL, EWA_F32, 3), *radius = add(cloud, EWA_RADIUS, EWA_F32, 1);
    check_random random = {1};
    for (int i = 0; i < COUNT; i++) {
        for (int c = 0; c < 3; c++) {
            position[3 * i + c] = check_uniform(&random, -10, 10);
            normal[3 * i + c] = (float)(check_uniform(&random, -1, 1) * pow(10, i % 31 - 15));
        }
        radius[i] = (float)check_uniform(&random, 0.5, 2);
    }
    normal[2] = -(normal[0] = normal[1] = 0) - 7; // (0, 0, -7): where a careless frame divides by zero
    const double origin[3] = {5e5, 4e6, 1};
    ewa_cloud_set_origin(cloud, origin);
    ewa_surfel_reader reader;
    open_reader(cloud, 1.5, 3, &reader);
    ewa_surfel surfel[COUNT];
    bool drawable[COUNT];
    assert_int_equal(ewa_surfel_read(&reader, 0, COUNT, surfel, drawable), COUNT);
    for (int i = 0; i < COUNT; i++) {
        const ewa_surfel *s = &surfel[i];
        const double sigma = (double)radius[i] * 3 / 1.5, *u = s->axis_u_world, *v = s->axis_v_world;
        assert_true(drawable[i]);
        assert_true(fabs(dot(u, u) / (sigma * sigma) - 1) < 1e-12 &&
                    fabs(dot(v, v) / (sigma * sigma) - 1) < 1e-12);
        assert_true(fabs(dot(u, v)) < 1e-12 * sigma * sigma);
        const double *n = s->normal_world;
        assert_true(fabs(dot(n, n) - 1) < 1e-14 && fabs(dot(n, u)) < 1e-14 && fabs(dot(n, v)) < 1e-14);
        const double given[3] = {(double)normal[3 * i], (double)normal[3 * i + 1], (double)normal[3 * i + 2]};
        assert_true(dot(n, given) > (1 - 1e-14) * sqrt(dot(given, given)));
        const double uv[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                              u[0] * v[1] - u[1] * v[0]};
        assert_true(dot(uv, n) > 0);
        for (int c = 0; c < 3; c++) {
            assert_true(s->center[c] == position[3 * i + c] && reader.origin_world[c] == origin[c]);
            assert_true(s->color_linear[c] == EWA_DEFAULT_GREY);
        }
        assert_true(s->alpha == 1);
    }
}

/// Any two tangent axes: the principal ones have the same covariance, are orthogonal and sorted; the normal
/// follows the given one.
TEST_ON(test_ellipses, 1) {
    enum { COUNT = 1000 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, COUNT);
    double *position = add(cloud, EWA_POSITION, EWA_F64, 3), *tu = add(cloud, EWA_TANGENT_U, EWA_F64, 3);
    double *tv = add(cloud, EWA_TANGENT_V, EWA_F64, 3), *normal = add(cloud, EWA_NORMAL, EWA_F64, 3);
    memset(position, 0, COUNT * 3 * sizeof *position);
    check_random random = {2};
    for (int i = 0; i < 3 * COUNT; i++) {
        tu[i] = check_uniform(&random, -1, 1);
        tv[i] = check_uniform(&random, -1, 1);
        normal[i] = check_uniform(&random, -1, 1);
    }
    const double chosen[][6] = {{1, 0, 0, 0, 1, 0}, {1, 0, 0, 0, 2, 0},    {0, 0, 3, 3, 0, 0},
                                {1, 1, 0, 1, 2, 0}, {1, 0, 0, -0.5, 1, 0}, {2, 0, 0, 0, 1, 0}};
    for (int i = 0; i < 6; i++) {
        memcpy(&tu[3 * i], &chosen[i][0], 3 * sizeof *tu);
        memcpy(&tv[3 * i], &chosen[i][3], 3 * sizeof *tv);
    }
    ewa_surfel_reader reader;
    open_reader(cloud, 1.25, 2, &reader);
    ewa_surfel surfel[COUNT];
    bool drawable[COUNT];
    assert_int_equal(ewa_surfel_read(&reader, 0, COUNT, surfel, drawable), COUNT);
    for (int i = 0; i < COUNT; i++) {
        const double *u = surfel[i].axis_u_world, *v = surfel[i].axis_v_world, *n = surfel[i].normal_world;
        assert_true(fabs(dot(u, v)) < 1e-14 * 4 && dot(u, u) >= dot(v, v) * (1 - 1e-14));
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                const double wanted = 4 * (tu[3 * i + r] * tu[3 * i + c] + tv[3 * i + r] * tv[3 * i + c]);
                assert_true(fabs(u[r] * u[c] + v[r] * v[c] - wanted) < 1e-13);
            }
        assert_true(fabs(dot(n, n) - 1) < 1e-14 && fabs(dot(n, u)) < 1e-12 && fabs(dot(n, v)) < 1e-12);
        assert_true(dot(n, &normal[3 * i]) >= 0);
    }
}

/// Every reason to leave a point out.
TEST_ON(test_left_out, 1) {
    static const float rows[][7] = {
        // position, normal, radius
        {0, 0, 1, 0, 0, 1, 1},         {NAN, 0, 1, 0, 0, 1, 1},   {0, INFINITY, 1, 0, 0, 1, 1},
        {0, 0, 1, 0, 0, 0, 1},         {0, 0, 1, NAN, 0, 1, 1},   {0, 0, 1, 0, 0, 1, 0},
        {0, 0, 1, 0, 0, 1, -1},        {0, 0, 1, 0, 0, 1, NAN},   {0, 0, 1, 0, 0, 1, INFINITY},
        {3e38f, 0, 1, 0, 0, 1, 1},     {0, 0, 1, 0, 0, 1, 3e38f}, {0, 0, 1, 0, 0, 1e-40f, 1},
        {0, 0, 1, 0, -INFINITY, 1, 1},
    };
    static const bool wanted[] = {true,  false, false, false, false, false, false,
                                  false, false, false, false, true,  false};
    enum { COUNT = sizeof rows / sizeof rows[0] };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, COUNT);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, &rows[0][0], sizeof rows[0]), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_NORMAL, EWA_F32, 3, &rows[0][3], sizeof rows[0]), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_RADIUS, EWA_F32, 1, &rows[0][6], sizeof rows[0]), EWA_OK);
    ewa_surfel_reader reader;
    open_reader(cloud, 2, 1, &reader);
    ewa_surfel surfel[COUNT];
    bool drawable[COUNT];
    assert_int_equal(ewa_surfel_read(&reader, 0, COUNT, surfel, drawable), 2);
    for (int i = 0; i < COUNT; i++) assert_int_equal(drawable[i], wanted[i]);
    ewa_cloud_destroy(&cloud);

    static const float axes[][6] = {{1, 0, 0, 0, 1, 0}, {1, 2, 3, 2, 4, 6},     {1, 0, 0, 0, 0, 0},
                                    {0, 0, 0, 0, 0, 0}, {1e-7f, 0, 0, 0, 1, 0}, {1, 0, 0, 0, NAN, 0},
                                    {1, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 0, 1e-3f}};
    static const bool axes_wanted[] = {true, false, false, false, false, false, false, true};
    cloud = make_cloud(context, 8);
    memset(add(cloud, EWA_POSITION, EWA_F32, 3), 0, 8 * 3 * sizeof(float));
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_TANGENT_U, EWA_F32, 3, &axes[0][0], sizeof axes[0]), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_TANGENT_V, EWA_F32, 3, &axes[0][3], sizeof axes[0]), EWA_OK);
    open_reader(cloud, 2, 1, &reader);
    assert_int_equal(ewa_surfel_read(&reader, 0, 8, surfel, drawable), 2);
    for (int i = 0; i < 8; i++) assert_int_equal(drawable[i], axes_wanted[i]);
}

static double read_one_color(ewa_context *context, ewa_type type, uint32_t components, const void *value,
                             ewa_surfel *surfel) {
    static const float frame[7] = {0, 0, 0, 0, 0, 1, 1};
    ewa_cloud *cloud = make_cloud(context, 1);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, frame, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_NORMAL, EWA_F32, 3, frame + 3, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_RADIUS, EWA_F32, 1, frame + 6, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_COLOR, type, components, value, 0), EWA_OK);
    ewa_surfel_reader reader;
    open_reader(cloud, 2, 1, &reader);
    bool drawable;
    assert_int_equal(ewa_surfel_read(&reader, 0, 1, surfel, &drawable), 1);
    ewa_cloud_destroy(&cloud);
    return surfel->color_linear[0];
}

static double curve(double s) { return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4); }

TEST_ON(test_colors, 1) {
    ewa_surfel surfel;
    for (int i = 0; i < 256; i++) {
        const uint8_t bytes[4] = {(uint8_t)i, 0, 255, (uint8_t)i};
        assert_true(fabs(read_one_color(context, EWA_U8, 4, bytes, &surfel) - curve(i / 255.0)) < 1e-14);
        assert_true(surfel.color_linear[1] == 0 && fabs(surfel.color_linear[2] - 1) < 1e-14);
        assert_true(surfel.alpha == i / 255.0);
        const uint16_t shorts[3] = {(uint16_t)(257 * i + 100 * (i < 255)), 0, 0};
        assert_true(fabs(read_one_color(context, EWA_U16, 3, shorts, &surfel) - curve(shorts[0] / 65535.0)) <
                    1e-14);
        assert_true(surfel.alpha == 1);
    }
    assert_true(read_one_color(context, EWA_F32, 3, (float[]){0.25f, 2, -1}, &surfel) == 0.25);
    assert_true(surfel.color_linear[1] == 2 && surfel.color_linear[2] == -1); // coefficients have any sign
    assert_true(read_one_color(context, EWA_F64, 4, (double[]){0.25, 0, NAN, 0.5}, &surfel) ==
                EWA_DEFAULT_GREY);
    assert_true(read_one_color(context, EWA_I8, 3, (int8_t[]){-3, 127, 0}, &surfel) == 0);
    assert_true(fabs(surfel.color_linear[1] - 1) < 1e-14);
}

/// Missing and misshapen attributes are named.
TEST(test_refused_clouds) {
    static const struct {
        const char *names[4];
        uint32_t components[4];
        const char *message;
    } rows[] = {
        {{EWA_NORMAL, EWA_RADIUS}, {3, 1}, "'position' is missing"},
        {{EWA_POSITION}, {3}, "'normal' is missing"},
        {{EWA_POSITION, EWA_NORMAL}, {3, 3}, "'radius' is missing"},
        {{EWA_POSITION, EWA_RADIUS}, {3, 1}, "'normal' is missing"},
        {{EWA_POSITION, EWA_TANGENT_U}, {3, 3}, "'tangent_v' is missing"},
        {{EWA_POSITION, EWA_TANGENT_V}, {3, 3}, "'tangent_u' is missing"},
        {{EWA_POSITION, EWA_NORMAL, EWA_RADIUS}, {2, 3, 1}, "'position' has 2"},
        {{EWA_POSITION, EWA_NORMAL, EWA_RADIUS}, {3, 1, 1}, "'normal' has 1"},
        {{EWA_POSITION, EWA_NORMAL, EWA_RADIUS}, {3, 3, 2}, "'radius' has 2"},
        {{EWA_POSITION, EWA_TANGENT_U, EWA_TANGENT_V}, {3, 2, 3}, "'tangent_u' has 2"},
        {{EWA_POSITION, EWA_TANGENT_U, EWA_TANGENT_V, EWA_COLOR}, {3, 3, 3, 1}, "'color' has 1"},
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, 1);
        for (int a = 0; a < 4 && rows[i].names[a]; a++)
            add(cloud, rows[i].names[a], EWA_F32, rows[i].components[a]);
        WITH_DEFAULTS(ewa_surfels_options, options);
        ewa_surfel_reader reader;
        assert_int_equal(ewa_surfel_reader_open(cloud, &options, &reader), EWA_ERROR_ARGUMENT);
        if (!strstr(log.text, rows[i].message)) fail_msg("'%s' lacks \"%s\"", log.text, rows[i].message);
    }
}

/// Every member out of its range, named in the message.
TEST_LOGGED(test_options, 1) {
    ewa_surfels_options surfels, chosen_surfels;
    assert_int_equal(ewa_surfels_options_choose(context, NULL, &chosen_surfels), EWA_OK);
    assert_true(chosen_surfels.cutoff == 3 && chosen_surfels.radius_scale == 1);
    static const double bad_surfels[][2] = {{0, 1}, {4.1, 1}, {NAN, 1}, {2, 0}, {2, -1}, {2, INFINITY}};
    for (int i = 0; i < 6; i++) {
        ewa_surfels_options_init(&surfels, sizeof surfels);
        surfels.cutoff = bad_surfels[i][0];
        surfels.radius_scale = bad_surfels[i][1];
        assert_int_equal(ewa_surfels_options_choose(context, &surfels, &chosen_surfels), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, i < 3 ? "cutoff" : "radius_scale"));
    }
    memset(&surfels, 0, sizeof surfels);
    assert_int_equal(ewa_surfels_options_choose(context, &surfels, &chosen_surfels), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "struct_size"));

    ewa_render_options render, chosen;
    assert_int_equal(ewa_render_options_choose(context, NULL, &chosen), EWA_OK);
    assert_true(chosen.prefilter_px == 0.35 && chosen.edge_threshold == 0.45 && chosen.passes == 3 &&
                chosen.edge_antialiasing);
#define REFUSES(member, value)                                                                               \
    do {                                                                                                     \
        ewa_render_options_init(&render, sizeof render);                                                     \
        render.member = value;                                                                               \
        assert_int_equal(ewa_render_options_choose(context, &render, &chosen), EWA_ERROR_ARGUMENT);          \
        if (!strstr(log->text, #member)) fail_msg("'%s' lacks " #member, log->text);                           \
    } while (0)
    REFUSES(struct_size, 8);
    REFUSES(kernel, (ewa_kernel)5);
    REFUSES(opacity, 1.5);
    REFUSES(cull, (ewa_cull)-1);
    REFUSES(shading, (ewa_shading)7);
    REFUSES(passes, 2);
    REFUSES(prefilter_px, 4.5);
    REFUSES(prefilter_px, -0.5);
    REFUSES(tolerance, NAN);
    REFUSES(edge_threshold, 0);
    REFUSES(ambient, 1.5);
    REFUSES(background[3], 1.5f);
    REFUSES(background[0], NAN);
    ewa_render_options_init(&render, sizeof render);
    render.light_count = 1;
    render.lights[0].direction_world[1] = INFINITY;
    assert_int_equal(ewa_render_options_choose(context, &render, &chosen), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "direction_world"));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
