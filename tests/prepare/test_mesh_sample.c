// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels from meshes: where they are, how far apart, which lines they get, what bad meshes give.
#include "io/scratch.h"
#include "mesh_shapes.h"

static int face_of(const float *normal) {
    for (int c = 0; c < 3; c++)
        if (fabsf(normal[c]) > 0.999f) return 2 * c + (normal[c] > 0);
    return -1;
}

/// All on the faces, as many on each, within the count, no two of a face too near, bytes the same for any
/// number of threads.
TEST(test_cube_points) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL), *many = check_context(5, NULL);
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_cube(context, &mesh);
    const ewa_mesh_sample_options options = shape_options(6000);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    const uint64_t count = ewa_cloud_point_count(cloud);
    assert_in_range(count, 5700, 6300);
    double *p = shape_places(cloud);
    const float *n = shape_stream(cloud, EWA_NORMAL), *u = shape_stream(cloud, EWA_TANGENT_U);
    const double radius = 3 * sqrt((double)(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])), spacing = radius / 1.6;
    uint64_t of_face[6] = {0}, inner = 0, in_row = 0;
    bool *is_inner = calloc(count, 1);
    assert_non_null(is_inner);
    for (uint64_t i = 0; i < count; i++) {
        const int face = face_of(n + 3 * i);
        assert_true(face >= 0);
        of_face[face]++;
        for (int c = 0; c < 3; c++)
            assert_true(c == face / 2 ? p[3 * i + c] == (face & 1 ? 1 : -1) : fabs(p[3 * i + c]) <= 1);
        bool near_edge = false;
        for (int c = 0; c < 3; c++) {
            if (c == face / 2) continue;
            const double inside = (1 - fabs(p[3 * i + c])) / spacing;
            near_edge = near_edge || inside < 0.21;
            in_row += fabs(inside - 0.2) < 0.002;
        }
        is_inner[i] = !near_edge;
        inner += !near_edge;
        for (uint64_t k = 0; k < i; k++) {
            if (face_of(n + 3 * k) != face) continue;
            double d2 = 0;
            for (int c = 0; c < 3; c++) d2 += pow(p[3 * i + c] - p[3 * k + c], 2);
            // Rows along edges are closer than the inside, corners closest.
            assert_true(d2 > pow(0.39 * spacing, 2));
            if (is_inner[i] && is_inner[k]) assert_true(d2 > pow(0.77 * spacing, 2));
        }
    }
    free(is_inner);
    free(p);
    for (int f = 0; f < 6; f++)
        assert_true(fabs((double)of_face[f] - (double)count / 6) < 0.05 * (double)count / 6);
    assert_true((double)inner > 0.7 * (double)count);
    assert_true(in_row > 800); // some 40 along each side of each of twelve edges, within the steps of floats
    mesh.context = many;
    OWNED(ewa_cloud_destroy) ewa_cloud *other = shape_sample(&mesh, &options);
    mesh.context = context;
    assert_int_equal(ewa_cloud_point_count(other), count);
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(cloud); a++) {
        const ewa_attribute *x = ewa_cloud_attribute_at(cloud, a), *y = ewa_cloud_attribute_at(other, a);
        assert_memory_equal(x->data, y->data, count * x->stride_bytes);
    }
}

/// Whether a place of the plane of point i is kept by its lines.
static bool keeps(const ewa_cloud *cloud, const double *p, uint64_t i, const double at[3]) {
    const float *u = shape_stream(cloud, EWA_TANGENT_U) + 3 * i, *v = shape_stream(cloud, EWA_TANGENT_V) + 3 * i;
    const float *lines[2] = {shape_stream(cloud, EWA_CLIP0) + 3 * i, shape_stream(cloud, EWA_CLIP1) + 3 * i};
    const bool either = ((const uint8_t *)ewa_cloud_find(cloud, EWA_CLIP_MODE)->data)[i];
    double a = 0, b = 0, uu = 0, vv = 0;
    bool kept[2];
    int count = 0;
    for (int c = 0; c < 3; c++) {
        const double d = at[c] - p[3 * i + (uint64_t)c];
        a += d * (double)u[c], b += d * (double)v[c];
        uu += (double)u[c] * (double)u[c], vv += (double)v[c] * (double)v[c];
    }
    for (int k = 0; k < 2; k++)
        if (lines[k][0] != 0 || lines[k][1] != 0)
            kept[count++] =
                (double)lines[k][0] * a / uu + (double)lines[k][1] * b / vv + (double)lines[k][2] >= 0;
    return count == 0 || (count == 1 ? kept[0] : either ? kept[0] || kept[1] : kept[0] && kept[1]);
}

/// How far a place is inside of the outline that a face of the shape has; negative: outside.
typedef double outline(const float *normal, const double at[3]);

static double cube_outline(const float *normal, const double at[3]) {
    double minimum = INFINITY;
    for (int c = 0; c < 3; c++)
        if (fabsf(normal[c]) < 0.5f) minimum = fmin(minimum, 1 - fabs(at[c]));
    return minimum;
}

static double angle_outline(const float *normal, const double at[3]) {
    const double y = 1 - fabs(at[1]), x = 1 - fabs(at[0]), z = 1 - fabs(at[2]);
    if (fabsf(normal[1]) > 0.5f) return fmin(fmin(x, z), fmax(-at[0], -at[2]));
    const int along = fabsf(normal[0]) > 0.5f ? 2 : 0, across = 2 - along;
    if (normal[across] < 0) return fmin(y, along == 0 ? x : z);
    // Of the two faces towards a positive axis one is at 1, below 0 along the other, one at 0, above it.
    return at[across] > 0.5 ? fmin(y, fmin(along == 0 ? x : z, -at[along]))
                            : fmin(y, fmin(along == 0 ? x : z, at[along]));
}

/// What all discs keep is just what lies within the outline of their face, up to rounding.
static void hold_outline(void (*make)(ewa_context *, ewa_mesh *), outline *inside) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    make(context, &mesh);
    const ewa_mesh_sample_options options = shape_options(4000);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    check_random random = {5};
    OWNED(check_free) double *p = shape_places(cloud);
    const float *n = shape_stream(cloud, EWA_NORMAL), *u = shape_stream(cloud, EWA_TANGENT_U),
                *v = shape_stream(cloud, EWA_TANGENT_V);
    uint64_t lines[3] = {0};
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const float *clips[2] = {shape_stream(cloud, EWA_CLIP0) + 3 * i, shape_stream(cloud, EWA_CLIP1) + 3 * i};
        lines[(clips[0][0] != 0 || clips[0][1] != 0) + (clips[1][0] != 0 || clips[1][1] != 0)]++;
        for (int k = 0; k < 20; k++) {
            const double a = check_uniform(&random, -3, 3), b = check_uniform(&random, -3, 3);
            if (a * a + b * b > 9) continue;
            double at[3];
            for (int c = 0; c < 3; c++)
                at[c] = p[3 * i + (uint64_t)c] + a * (double)u[3 * i + c] + b * (double)v[3 * i + c];
            const double depth = inside(n + 3 * i, at);
            if (fabs(depth) < 1e-5) continue;
            assert_int_equal(keeps(cloud, p, i, at), depth > 0);
        }
    }
    assert_true(lines[0] > 500 && lines[1] > 500 && lines[2] >= 24);
}

TEST(test_cube_lines) { hold_outline(shape_cube, cube_outline); }

/// Its ends have a concave corner, where one of two lines is enough.
TEST(test_angle_lines) { hold_outline(shape_angle, angle_outline); }

/// No sharp edges: radii, smooth normals, no lines; an opened one has lines along its border only.
TEST_ON(test_sphere, 0) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_sphere(context, 32, &mesh);
    const ewa_mesh_sample_options options = shape_options(5000);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    assert_null(ewa_cloud_find(cloud, EWA_CLIP0));
    assert_null(ewa_cloud_find(cloud, EWA_TANGENT_U));
    assert_non_null(ewa_cloud_find(cloud, EWA_RADIUS));
    double *p = shape_places(cloud);
    const float *n = shape_stream(cloud, EWA_NORMAL);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const double *a = p + 3 * i, length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        const float *b = n + 3 * i;
        assert_true(length > 0.99 && length < 1.0001);
        assert_true(a[0] * (double)b[0] + a[1] * (double)b[1] + a[2] * (double)b[2] > 0.9995 * length);
    }
    free(p);
    ewa_cloud_destroy(&cloud);

    mesh.triangle_count /= 2; // the upper half
    cloud = shape_sample(&mesh, &options);
    p = shape_places(cloud);
    const float *clip = shape_stream(cloud, EWA_CLIP0), *u = shape_stream(cloud, EWA_TANGENT_U);
    const float reach = 3 * sqrtf(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    uint64_t clipped = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        if (clip[3 * i] == 0 && clip[3 * i + 1] == 0) continue;
        assert_true(p[3 * i + 2] < 1.05 * (double)reach);
        clipped++;
    }
    free(p);
    assert_true(clipped > 100);
    mesh.triangle_count *= 2;
}

/// Fails with a status and a message that has `text` in it.
static void refuse(const ewa_mesh *mesh, const ewa_mesh_sample_options *options, const check_log *log,
                   ewa_status status, const char *text) {
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_mesh_sample(mesh, options, &cloud), status);
    assert_null(cloud);
    if (!strstr(log->text, text)) fail_msg("'%s' is not in '%s'", text, log->text);
}

TEST_LOGGED(test_bad_meshes, 0) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_cube(context, &mesh);
    ewa_mesh_sample_options options = shape_options(1000);
    options.crease_degrees = 181;
    refuse(&mesh, &options, log, EWA_ERROR_ARGUMENT, "crease_degrees is 181");
    options = shape_options(0);
    refuse(&mesh, &options, log, EWA_ERROR_ARGUMENT, "point_count is 0");
    options.spacing_world = NAN;
    refuse(&mesh, &options, log, EWA_ERROR_ARGUMENT, "spacing_world is nan");
    options.spacing_world = 1e-12;
    refuse(&mesh, &options, log, EWA_ERROR_LIMIT, "a spacing of 1e-12 gives");
    options = shape_options(1000);
    mesh.triangles[7] = 8;
    refuse(&mesh, &options, log, EWA_ERROR_ARGUMENT, "triangle 2 has vertex 8, there are 8");
    mesh.triangles[7] = 3;
    // A triangle that is a line, one that is a point, one with a place that is no number: the rest is
    // sampled.
    mesh.triangles[0] = mesh.triangles[1];
    memset(mesh.triangles + 3, 0, 3 * sizeof *mesh.triangles);
    mesh.positions[3 * 7] = NAN;
    ewa_cloud *cloud = shape_sample(&mesh, &options);
    double *p = shape_places(cloud);
    for (uint64_t i = 0; i < 3 * ewa_cloud_point_count(cloud); i++) assert_true(fabs(p[i]) <= 1);
    free(p);
    ewa_cloud_destroy(&cloud);
    for (int i = 0; i < 24; i++) mesh.positions[i] = 1;
    refuse(&mesh, &options, log, EWA_ERROR_NUMERIC, "none of 12 triangles has an area");
    for (int i = 0; i < 24; i++) mesh.positions[i] = i % 2 ? INFINITY : NAN;
    refuse(&mesh, &options, log, EWA_ERROR_NUMERIC, "none of 12 triangles has an area");
    mesh.triangle_count = 0;
    refuse(&mesh, &options, log, EWA_ERROR_NUMERIC, "none of 0 triangles");
    mesh.triangle_count = 12;
}

/// Random triangles through each other, with huge, tiny and doubled ones: finite surfels on their planes.
TEST_ON(test_soup, 0) {
    for (uint64_t seed = 1; seed < 20; seed++) {
        check_random random = {seed};
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        assert_int_equal(ewa_mesh_create(context, 40, 60, 0, 0, &mesh), EWA_OK);
        const double size = pow(10, check_uniform(&random, -6, 6));
        for (int i = 0; i < 120; i++)
            mesh.positions[i] = size * check_uniform(&random, -1, 1) * (i < 60 ? 1 : 1e-3);
        for (int i = 0; i < 180; i++) mesh.triangles[i] = (uint32_t)(check_random_u64(&random) % 40);
        const ewa_mesh_sample_options options = shape_options(2000);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
        assert_true(ewa_cloud_point_count(cloud) > 200);
        for (uint32_t a = 0; a < ewa_cloud_attribute_count(cloud); a++) {
            const ewa_attribute *attribute = ewa_cloud_attribute_at(cloud, a);
            if (attribute->type != EWA_F32) continue;
            for (uint64_t i = 0; i < ewa_cloud_point_count(cloud) * attribute->component_count; i++)
                assert_true(isfinite(((const float *)attribute->data)[i]));
        }
    }
}

/// Everything of two clouds but their origin.
static void same_points(const ewa_cloud *a, const ewa_cloud *b) {
    assert_int_equal(ewa_cloud_point_count(a), ewa_cloud_point_count(b));
    assert_int_equal(ewa_cloud_attribute_count(a), ewa_cloud_attribute_count(b));
    for (uint32_t k = 0; k < ewa_cloud_attribute_count(a); k++) {
        const ewa_attribute *x = ewa_cloud_attribute_at(a, k), *y = ewa_cloud_attribute_at(b, k);
        assert_string_equal(x->name, y->name);
        assert_int_equal(x->type, y->type);
        assert_memory_equal(x->data, y->data, ewa_cloud_point_count(a) * x->stride_bytes);
    }
}

/// A mesh far from the origin is sampled as the same mesh at it, bit for bit, where the shift is exact; the
/// origin of the cloud says where it is.
TEST_ON(test_map_coordinates, 0) {
    static const double shifts[][3] = {{500000, 4200000, 0}, {-6378137, 6378137.5, 1e6}, {1e9, -1e9, 1e9}};
    for (int shape = 0; shape < 3; shape++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        void (*const shapes[2])(ewa_context *, ewa_mesh *) = {shape_cube, shape_angle};
        if (shape < 2)
            shapes[shape](context, &mesh);
        else
            shape_sphere(context, 12, &mesh);
        // Multiples of 2^-20, which all the shifts keep.
        for (uint32_t i = 0; i < 3 * mesh.vertex_count; i++)
            mesh.positions[i] = round(mesh.positions[i] * 0x1p20) * 0x1p-20;
        const ewa_mesh_sample_options options = shape_options(3000);
        OWNED(ewa_cloud_destroy) ewa_cloud *near = shape_sample(&mesh, &options);
        for (size_t s = 0; s < sizeof shifts / sizeof shifts[0]; s++) {
            double origin[2][3];
            for (uint32_t i = 0; i < 3 * mesh.vertex_count; i++) mesh.positions[i] += shifts[s][i % 3];
            OWNED(ewa_cloud_destroy) ewa_cloud *far = shape_sample(&mesh, &options);
            for (uint32_t i = 0; i < 3 * mesh.vertex_count; i++) mesh.positions[i] -= shifts[s][i % 3];
            same_points(near, far);
            ewa_cloud_origin(near, origin[0]);
            ewa_cloud_origin(far, origin[1]);
            for (int c = 0; c < 3; c++) assert_true(origin[1][c] - origin[0][c] == shifts[s][c]);
        }
    }
}

/// Two small cubes far apart: places are doubles, and lie on their faces to a billionth of the distance.
TEST_ON(test_far_parts, 0) {
    OWNED(ewa_mesh_free) ewa_mesh cube, mesh;
    shape_cube(context, &cube);
    assert_int_equal(ewa_mesh_create(context, 16, 24, 0, 0, &mesh), EWA_OK);
    const double apart = 1e5;
    for (uint32_t i = 0; i < 72; i++) mesh.triangles[i] = cube.triangles[i % 36] + i / 36 * 8;
    for (uint32_t i = 0; i < 48; i++) mesh.positions[i] = cube.positions[i % 24] + (i >= 24 ? apart : 0);
    const ewa_mesh_sample_options options = shape_options(4000);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    assert_int_equal(ewa_cloud_find(cloud, EWA_POSITION)->type, EWA_F64);
    OWNED(check_free) double *p = shape_places(cloud);
    const float *n = shape_stream(cloud, EWA_NORMAL);
    uint64_t far = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const int face = face_of(n + 3 * i);
        assert_true(face >= 0);
        const bool second = p[3 * i] > apart / 2;
        far += second;
        for (int c = 0; c < 3; c++) {
            const double at = p[3 * i + (uint64_t)c] - (second ? apart : 0);
            assert_true(c == face / 2 ? fabs(at - (face & 1 ? 1 : -1)) < 1e-10 : fabs(at) <= 1 + 1e-10);
        }
    }
    assert_true(far > 1800 && far < 2200);
}

/// Triangles that are there twice count once; those of another side stay.
TEST_ON(test_copies, 0) {
    OWNED(ewa_mesh_free) ewa_mesh cube, mesh;
    shape_cube(context, &cube);
    const ewa_mesh_sample_options options = shape_options(3000);
    OWNED(ewa_cloud_destroy) ewa_cloud *once = shape_sample(&cube, &options);
    // Each triangle five times, begun at other corners, through vertices of their own.
    assert_int_equal(ewa_mesh_create(context, 40, 60, 0, 0, &mesh), EWA_OK);
    for (uint32_t t = 0; t < 60; t++)
        for (uint32_t c = 0; c < 3; c++)
            mesh.triangles[3 * t + c] = cube.triangles[3 * (t % 12) + (c + t / 12) % 3] + t / 12 * 8;
    for (uint32_t i = 0; i < 120; i++) mesh.positions[i] = cube.positions[i % 24];
    ewa_cloud *copies = shape_sample(&mesh, &options);
    same_points(once, copies);
    ewa_cloud_destroy(&copies);
    // Turned, they are the inside: as many points on each side.
    mesh.triangle_count = 24;
    for (uint32_t i = 36; i < 72; i += 3) {
        const uint32_t kept = mesh.triangles[i];
        mesh.triangles[i] = mesh.triangles[i + 1];
        mesh.triangles[i + 1] = kept;
    }
    OWNED(ewa_cloud_destroy) ewa_cloud *both = shape_sample(&mesh, &options);
    const float *n = shape_stream(both, EWA_NORMAL);
    double *p = shape_places(both);
    uint64_t outward = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(both); i++) {
        double dot = 0;
        for (uint64_t c = 0; c < 3; c++) dot += p[3 * i + c] * (double)n[3 * i + c];
        outward += dot > 0;
    }
    assert_true(fabs((double)outward / (double)ewa_cloud_point_count(both) - 0.5) < 0.05);
    free(p);
    mesh.triangle_count = 60;
}

/// Normals of the mesh are used where they are within the crease angle of the triangle, and only there.
TEST_ON(test_given_normals, 0) {
    static const double positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    assert_int_equal(ewa_mesh_create(context, 4, 2, 0, EWA_MESH_NORMALS, &mesh), EWA_OK);
    memcpy(mesh.positions, positions, sizeof positions);
    memcpy(mesh.triangles, triangles, sizeof triangles);
    // Leaning by 27 degrees to both sides; any length.
    for (int v = 0; v < 4; v++) {
        mesh.normals[3 * v] = positions[3 * v] > 0 ? 1 : -1;
        mesh.normals[3 * v + 2] = 2;
    }
    for (int kind = 0; kind < 4; kind++) {
        ewa_mesh_sample_options options = shape_options(400);
        if (kind == 1) options.smooth_normals = false;
        if (kind == 2) options.crease_degrees = 20;
        if (kind == 3) memset(mesh.normals + 6, 0, 3 * sizeof(float)); // one is missing
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
        const float *n = shape_stream(cloud, EWA_NORMAL), *u = shape_stream(cloud, EWA_TANGENT_U),
                    *v = shape_stream(cloud, EWA_TANGENT_V);
        OWNED(check_free) double *p = shape_places(cloud);
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
            const double x = 2 * p[3 * i] - 1, wanted = kind ? 0 : x / sqrt(x * x + 4);
            assert_float_equal(n[3 * i], wanted, 1e-5);
            assert_float_equal(n[3 * i] * u[3 * i] + n[3 * i + 2] * u[3 * i + 2], 0, 1e-6);
            assert_float_equal(n[3 * i] * v[3 * i] + n[3 * i + 2] * v[3 * i + 2], 0, 1e-6);
        }
    }
}

/// A cube with colours, a picture and copies of triangles, so that every allocation of the sampling is
/// reached.
static ewa_status sample_all(ewa_context *context, void *user) {
    (void)user;
    static const double positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1};
    static const uint32_t triangles[12] = {0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 3, 1};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    ewa_status status = ewa_mesh_create(context, 4, 4, 1, EWA_MESH_COLORS | EWA_MESH_TEXCOORDS, &mesh);
    if (status != EWA_OK) return status;
    memcpy(mesh.positions, positions, sizeof positions);
    memcpy(mesh.triangles, triangles, sizeof triangles);
    for (int i = 0; i < 8; i++) mesh.texcoords[i] = (float)positions[i / 2 * 3 + i % 2];
    status = ewa_image_create(context, 4, 4, 3, &mesh.textures[0]);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    const ewa_mesh_sample_options options = shape_options(100);
    if (status == EWA_OK) status = ewa_mesh_sample(&mesh, &options, &cloud);
    assert_true((status == EWA_OK) == (cloud != NULL));
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(sample_all, NULL); }

/// A needle of 1e20 by 1e32: its rows, not its area, say how far points are from each other.
TEST(test_needle) {
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    static const double places[9] = {0, 0, 0, 1e20, 0, 0, 0, 1e32, 0};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_fill(context, 3, places, 1, (const uint32_t[]){0, 1, 2}, &mesh);
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = 32;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    assert_in_range(ewa_cloud_point_count(cloud), 8, 128);
}

static int by_value(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// A strip that is thinner than samples are exact, 2^-32 of its length, has its points all along it.
TEST(test_thin_strip) {
    (void)state;
    static const double lengths[] = {1e6, 1e33}, widths[] = {1e-9, 1};
    for (int i = 0; i < 2; i++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
        const double length = lengths[i], width = widths[i];
        const double places[12] = {0, 0, 0, length, 0, 0, length, width, 0, 0, width, 0};
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        shape_fill(context, 4, places, 2, (const uint32_t[]){0, 1, 2, 0, 2, 3}, &mesh);
        const ewa_mesh_sample_options options = shape_options(1000);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
        const uint64_t count = ewa_cloud_point_count(cloud);
        assert_in_range(count, 500, 2000);
        OWNED(check_free) double *p = shape_places(cloud), *along = calloc(count, sizeof *along);
        assert_non_null(along);
        for (uint64_t k = 0; k < count; k++) {
            along[k] = p[3 * k] / length;
            assert_true(along[k] >= 0 && along[k] <= 1 && p[3 * k + 1] >= 0 && p[3 * k + 1] <= width);
        }
        qsort(along, count, sizeof *along, by_value);
        for (uint64_t k = 1; k < count; k++) assert_true(along[k] - along[k - 1] < 8.0 / (double)count);
        assert_true(along[0] < 0.01 && along[count - 1] > 0.99);
    }
}

/// A sheet both of whose sides are there, as triangles that are turned the other way, is sharp at its borders only, and smooth within.
TEST_ON(test_both_sides, 2) {
    enum { CELLS = 12, ROW = CELLS + 1 };
    double places[3 * ROW * ROW];
    uint32_t triangles[12 * CELLS * CELLS], used = 0;
    for (uint32_t i = 0; i < ROW * ROW; i++) {
        const double x = (double)(i % ROW) / CELLS - 0.5, y = (double)(i / ROW) / CELLS - 0.5;
        places[3 * i] = x, places[3 * i + 1] = y, places[3 * i + 2] = 0.4 * (x * x + y * y);
    }
    for (uint32_t side = 0; side < 2; side++)
        for (uint32_t i = 0; i < CELLS * CELLS; i++) {
            const uint32_t a = i / CELLS * ROW + i % CELLS, corners[6] = {a, a + 1, a + ROW + 1, a, a + ROW + 1, a + ROW};
            for (uint32_t c = 0; c < 6; c++) triangles[used++] = corners[side ? 5 - c : c];
        }
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_fill(context, ROW * ROW, places, 4 * CELLS * CELLS, triangles, &mesh);
    const ewa_mesh_sample_options options = shape_options(6000);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    OWNED(check_free) double *p = shape_places(cloud);
    const float *n = shape_stream(cloud, EWA_NORMAL), *line = shape_stream(cloud, EWA_CLIP0);
    uint64_t cut = 0, inner = 0, sides[2] = {0, 0};
    double least = 1;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        sides[n[3 * i + 2] > 0]++;
        if (fmax(fabs(p[3 * i]), fabs(p[3 * i + 1])) > 0.4) continue;
        inner++;
        cut += line[3 * i] != 0 || line[3 * i + 1] != 0;
        const double slope[2] = {0.8 * p[3 * i], 0.8 * p[3 * i + 1]}, length = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
        least = fmin(least, fabs((double)n[3 * i + 2] - slope[0] * (double)n[3 * i] - slope[1] * (double)n[3 * i + 1]) / length);
    }
    print_message("%llu of %llu cut, normals up to %.1f degrees off\n", (unsigned long long)cut, (unsigned long long)inner,
                  acos(least) * 180 / 3.141592653589793);
    assert_true(inner > 3000 && cut == 0);
    assert_true(sides[0] > 2500 && sides[1] > 2500 && least > cos(1.5 * 3.141592653589793 / 180));
}

/// The tip of a cone has no normal that suits its triangles: discs there lie in these, up to the crease.
TEST_ON(test_tip, 2) {
    enum { SIDES = 32 };
    double places[3 * (SIDES + 1)] = {0, 0, 1.5};
    uint32_t triangles[3 * SIDES];
    for (uint32_t i = 0; i < SIDES; i++) {
        const double around = 2 * 3.141592653589793 * i / SIDES;
        places[3 * i + 3] = 0.5 * cos(around), places[3 * i + 4] = 0.5 * sin(around);
        triangles[3 * i] = 0, triangles[3 * i + 1] = i + 1, triangles[3 * i + 2] = (i + 1) % SIDES + 1;
    }
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_fill(context, SIDES + 1, places, SIDES, triangles, &mesh);
    const ewa_mesh_sample_options options = shape_options(4000);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    OWNED(check_free) double *p = shape_places(cloud);
    const float *n = shape_stream(cloud, EWA_NORMAL);
    double least = 1;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const double around = atan2(p[3 * i + 1], p[3 * i]);
        least = fmin(least, 0.948683 * (cos(around) * (double)n[3 * i] + sin(around) * (double)n[3 * i + 1]) +
                                0.316228 * (double)n[3 * i + 2]);
    }
    print_message("normals are up to %.1f degrees off\n", acos(least) * 180 / 3.141592653589793);
    assert_true(least > cos(12 * 3.141592653589793 / 180));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
