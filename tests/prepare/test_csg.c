// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of ewa_cloud_csg(): results against closed forms from both sides, coinciding faces, clip lines of the
// operands, operands that are not closed, the same bytes for every thread count, refused arguments.
#include "io/scratch.h"

#include "edges/csg_lines.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define CUTOFF 3.0

static ewa_cloud *make(ewa_context *context, ewa_object object, uint64_t points, double size_world,
                       const double place_world[3]) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.point_count = points;
    options.size_world = size_world;
    options.radius_scale = EWA_DEFAULT_RADIUS_SCALE;
    options.sharp = object == EWA_OBJECT_CUBE;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    const double matrix[16] = {1, 0, 0, place_world[0], 0, 1, 0, place_world[1],
                               0, 0, 1, place_world[2], 0, 0, 0, 1};
    assert_int_equal(ewa_cloud_transform(cloud, matrix), EWA_OK);
    return cloud;
}

static ewa_cloud *combine(const ewa_cloud *a, const ewa_cloud *b, ewa_csg_operation operation) {
    WITH_DEFAULTS(ewa_csg_options, options);
    options.operation = operation;
    ewa_cloud *result = NULL;
    assert_int_equal(ewa_cloud_csg(a, b, &options, &result), EWA_OK);
    return result;
}

typedef struct solid_pair {
    ewa_object object[2];
    double size_world[2], place_world[2][3];
    uint64_t points[2];
} solid_pair;

static double length_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// Signed distance of a place from an operand, and the nearest place of its surface.
static double nearest_of(const solid_pair *pair, int k, const double p[3], double on[3]) {
    double d[3], half = pair->size_world[k] / 2;
    for (int c = 0; c < 3; c++) d[c] = p[c] - pair->place_world[k][c];
    if (pair->object[k] == EWA_OBJECT_SPHERE) {
        const double length = length_of(d);
        for (int c = 0; c < 3; c++) on[c] = pair->place_world[k][c] + d[c] / length * half;
        return length - half;
    }
    double largest = -INFINITY, outside[3], out = 0;
    int axis = 0;
    for (int c = 0; c < 3; c++) {
        const double beyond = fabs(d[c]) - half;
        if (beyond > largest) largest = beyond, axis = c;
        outside[c] = fmin(fmax(d[c], -half), half);
        out += fmax(beyond, 0) * fmax(beyond, 0);
    }
    if (out == 0) outside[axis] = d[axis] > 0 ? half : -half;
    for (int c = 0; c < 3; c++) on[c] = pair->place_world[k][c] + outside[c];
    return out > 0 ? sqrt(out) : largest;
}

/// The side of the other operand on which what is left of operand k lies.
static double side_of(ewa_csg_operation operation, int k) {
    return operation == EWA_CSG_INTERSECTION || (operation == EWA_CSG_DIFFERENCE && k == 1) ? -1 : 1;
}

/// An upper bound of the distance of a place from the result's surface: to the nearest place of an operand's
/// surface where that is left, else by steps between the two surfaces to where they meet.
static double distance_from_result(const solid_pair *pair, ewa_csg_operation operation, const double p[3]) {
    double best = INFINITY, on[3], other[3];
    for (int k = 0; k < 2; k++) {
        nearest_of(pair, k, p, on);
        for (int step = 0; step < 200; step++) {
            const double beyond = side_of(operation, k) * nearest_of(pair, 1 - k, on, other);
            if (beyond >= -1e-6) {
                const double away[3] = {p[0] - on[0], p[1] - on[1], p[2] - on[2]};
                best = fmin(best, length_of(away));
                break;
            }
            memcpy(on, other, sizeof on);
            nearest_of(pair, k, other, on);
        }
    }
    return best;
}

/// The surfels of a cloud as plain numbers.
typedef struct plain_surfels {
    uint64_t count;
    double *position, *normal, *axis[2], *line[2], *mode;
} plain_surfels;

static double *read_stream(const ewa_cloud *cloud, const char *name, uint32_t components) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    assert_non_null(attribute);
    assert_int_equal(attribute->component_count, components);
    double *values = malloc((count + 1) * components * sizeof *values);
    assert_non_null(values);
    ewa_attribute_read_f64(attribute, 0, count, values);
    return values;
}

static plain_surfels read_surfels(const ewa_cloud *cloud) {
    plain_surfels s = {.count = ewa_cloud_point_count(cloud)};
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    s.position = read_stream(cloud, EWA_POSITION, 3);
    for (uint64_t i = 0; i < 3 * s.count; i++) s.position[i] += origin_world[i % 3];
    s.normal = read_stream(cloud, EWA_NORMAL, 3);
    s.axis[0] = read_stream(cloud, EWA_TANGENT_U, 3);
    s.axis[1] = read_stream(cloud, EWA_TANGENT_V, 3);
    s.line[0] = read_stream(cloud, EWA_CLIP0, 3);
    s.line[1] = read_stream(cloud, EWA_CLIP1, 3);
    s.mode = read_stream(cloud, EWA_CLIP_MODE, 1);
    return s;
}

static void free_surfels(plain_surfels *s) {
    free(s->position);
    free(s->normal);
    for (int k = 0; k < 2; k++) free(s->axis[k]), free(s->line[k]);
    free(s->mode);
}

/// Whether a place of a surfel's plane is part of it.
static bool is_kept(const plain_surfels *s, uint64_t i, double u, double v) {
    if (u * u + v * v > CUTOFF * CUTOFF) return false;
    bool holds[2];
    int count = 0;
    for (int k = 0; k < 2; k++) {
        const double *l = &s->line[k][3 * i];
        if (l[0] == 0 && l[1] == 0) continue;
        holds[count++] = l[0] * u + l[1] * v + l[2] >= -1e-6;
    }
    if (count < 2) return count == 0 || holds[0];
    return s->mode[i] == 1 ? holds[0] || holds[1] : holds[0] && holds[1];
}

/// Largest distance of what is left of the discs, and of their centres, from the result's surface.
static double distance_forth(const solid_pair *pair, ewa_csg_operation operation, const plain_surfels *s,
                             double *of_centers) {
    double largest = 0;
    *of_centers = 0;
    for (uint64_t i = 0; i < s->count; i++) {
        *of_centers = fmax(*of_centers, distance_from_result(pair, operation, &s->position[3 * i]));
        for (int k = 0; k < 49; k++) {
            // To two standard deviations: the rest of the kernel is an eighth of it at most.
            const double u = (k % 7 - 3) * 2.0 / 3, v = (k / 7 - 3) * 2.0 / 3;
            if (u * u + v * v > 4 || !is_kept(s, i, u, v)) continue;
            double p[3];
            for (uint64_t c = 0; c < 3; c++)
                p[c] = s->position[3 * i + c] + u * s->axis[0][3 * i + c] + v * s->axis[1][3 * i + c];
            largest = fmax(largest, distance_from_result(pair, operation, p));
        }
    }
    return largest;
}

/// Distance of a place from the nearest disc in whose kept part its projection lies.
static double distance_from_discs(const plain_surfels *s, const double p[3], double within) {
    double best = INFINITY;
    for (uint64_t i = 0; i < s->count; i++) {
        const double *n = &s->normal[3 * i];
        const double d[3] = {p[0] - s->position[3 * i], p[1] - s->position[3 * i + 1],
                             p[2] - s->position[3 * i + 2]};
        const double height = fabs(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
        if (height >= best || height > within) continue;
        double at[2];
        for (int k = 0; k < 2; k++) {
            const double *axis = &s->axis[k][3 * i];
            at[k] = (d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]) /
                    (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        }
        if (is_kept(s, i, at[0], at[1])) best = height;
    }
    return best;
}

/// Largest distance of places of the result's surface from the discs.
static double distance_back(ewa_context *context, const solid_pair *pair, ewa_csg_operation operation,
                            const plain_surfels *s, double within) {
    double largest = 0;
    uint64_t tried = 0;
    for (int k = 0; k < 2; k++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *samples = make(context, pair->object[k], 1500, pair->size_world[k], pair->place_world[k]);
        double origin_world[3], other[3];
        ewa_cloud_origin(samples, origin_world);
        OWNED(check_free) double *position = read_stream(samples, EWA_POSITION, 3);
        for (uint64_t i = 0; i < ewa_cloud_point_count(samples); i++) {
            for (uint64_t c = 0; c < 3; c++) position[3 * i + c] += origin_world[c];
            if (side_of(operation, k) * nearest_of(pair, 1 - k, &position[3 * i], other) < 1e-3) continue;
            largest = fmax(largest, distance_from_discs(s, &position[3 * i], within));
            tried++;
        }
    }
    assert_true(tried > 100);
    return largest;
}

TEST_ON(test_against_closed_form, 0) {
    static const solid_pair pairs[] = {
        {{EWA_OBJECT_SPHERE, EWA_OBJECT_SPHERE}, {2, 1.6}, {{0, 0, 0}, {0.7, 0.5, 0.3}}, {4000, 4000}},
        {{EWA_OBJECT_CUBE, EWA_OBJECT_SPHERE}, {2, 2.5}, {{0, 0, 0}, {0, 0, 0}}, {4000, 4000}},
        {{EWA_OBJECT_CUBE, EWA_OBJECT_CUBE}, {2, 1.5}, {{0, 0, 0}, {0.63, 0.71, 0.82}}, {4000, 4000}},
        {{EWA_OBJECT_CUBE, EWA_OBJECT_SPHERE}, {2, 1}, {{0, 0, 0}, {1, 1, 1}}, {4000, 400}},
        {{EWA_OBJECT_CUBE, EWA_OBJECT_SPHERE}, {2, 0.4}, {{0, 0, 0}, {0.1, 0.2, 1}}, {1500, 1500}},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        const solid_pair *pair = &pairs[i];
        ewa_cloud *operands[2];
        double spacing = 0;
        for (int k = 0; k < 2; k++) {
            operands[k] =
                make(context, pair->object[k], pair->points[k], pair->size_world[k], pair->place_world[k]);
            const double size = pair->size_world[k], area = pair->object[k] == EWA_OBJECT_CUBE
                                                                ? 6 * size * size
                                                                : 3.141592653589793 * size * size;
            spacing = fmax(spacing, sqrt(area / (double)pair->points[k]));
        }
        for (int operation = 0; operation < 3; operation++) {
            OWNED(ewa_cloud_destroy)
            ewa_cloud *result = combine(operands[0], operands[1], (ewa_csg_operation)operation);
            plain_surfels s = read_surfels(result);
            double centers;
            const double forth = distance_forth(pair, (ewa_csg_operation)operation, &s, &centers);
            const double back = distance_back(context, pair, (ewa_csg_operation)operation, &s, 2 * spacing);
            print_message(
                "pair %zu, operation %d: %llu surfels; in spacings: discs %.3f, centres %.3f from the "
                "solid, solid %.3f from the discs\n",
                i, operation, (unsigned long long)s.count, forth / spacing, centers / spacing,
                back / spacing);
            assert_true(forth < 0.5 * spacing);
            assert_true(centers < 0.5 * spacing);
            assert_true(back < 0.5 * spacing);
            free_surfels(&s);
        }
        for (int k = 0; k < 2; k++) ewa_cloud_destroy(&operands[k]);
    }
}

/// The distance of a place from the plane of a face of the cube that a matrix puts into the world; faces are
/// numbered 0 to 5.
static double distance_from_face(const double matrix[16], double half, int face, const double p[3]) {
    double along = 0;
    for (int c = 0; c < 3; c++) along += matrix[4 * c + face / 2] * (p[c] - matrix[4 * c + 3]);
    return along - (face % 2 ? half : -half);
}

/// How far a line of a surfel is, within the disc, from the plane of a face of either cube that is not the
/// disc's own, at best.
static double distance_from_faces(const plain_surfels *s, uint64_t i, const double *line,
                                  const double (*matrices)[16], const double half[2]) {
    const double length = hypot(line[0], line[1]), along = -line[2] / length;
    const double reach = sqrt(fmax(CUTOFF * CUTOFF - along * along, 0));
    double best = INFINITY;
    for (int face = 0; face < 12; face++) {
        const double *matrix = matrices[face / 6];
        double worst = 0, facing = 0;
        for (int c = 0; c < 3; c++) facing += matrix[4 * c + face % 6 / 2] * s->normal[3 * i + (uint64_t)c];
        if (fabs(facing) > 0.999) continue;
        for (int end = -1; end < 2; end += 2) {
            const double u = (along * line[0] - end * reach * line[1]) / length,
                         v = (along * line[1] + end * reach * line[0]) / length;
            double p[3];
            for (uint64_t c = 0; c < 3; c++)
                p[c] = s->position[3 * i + c] + u * s->axis[0][3 * i + c] + v * s->axis[1][3 * i + c];
            worst = fmax(worst, fabs(distance_from_face(matrix, half[face / 6], face % 6, p)));
        }
        best = fmin(best, worst);
    }
    return best;
}

/// Where every face is a plane, lines are exact: each lies in the plane of a face, that of the own cube
/// beyond an edge or one of the other cube, on whole surfels as on their parts.
TEST_ON(test_lines_of_planes, 0) {
    const double here[3] = {0, 0, 0}, half[2] = {1, 0.75};
    // The second cube is turned by 3-4-5 about z, then by 5-12-13 about x, so that no edge is along an axis.
    const double a = 0.6, b = 0.8, c = 12.0 / 13, d = 5.0 / 13;
    const double matrices[2][16] = {
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
        {a, -b, 0, 0.63, c * b, c * a, -d, 0.71, d * b, d * a, c, 0.82, 0, 0, 0, 1}};
    ewa_cloud *operands[2];
    for (int k = 0; k < 2; k++) {
        operands[k] = make(context, EWA_OBJECT_CUBE, 4000, 2 * half[k], here);
        assert_int_equal(ewa_cloud_transform(operands[k], matrices[k]), EWA_OK);
    }
    for (int operation = 0; operation < 3; operation++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *result = combine(operands[0], operands[1], (ewa_csg_operation)operation);
        plain_surfels s = read_surfels(result);
        uint64_t lines = 0, exact = 0;
        double worst = 0;
        for (uint64_t i = 0; i < s.count; i++)
            for (int k = 0; k < 2; k++) {
                const double *line = &s.line[k][3 * i];
                if (line[0] == 0 && line[1] == 0) continue;
                const double distance = distance_from_faces(&s, i, line, matrices, half);
                lines++, exact += distance < 1e-5, worst = fmax(worst, distance);
            }
        print_message("operation %d: %llu of %llu lines in faces, the worst %g off\n", operation,
                      (unsigned long long)exact, (unsigned long long)lines, worst);
        assert_true(lines > 1000);
        assert_int_equal(exact, lines);
        free_surfels(&s);
    }
    for (int k = 0; k < 2; k++) ewa_cloud_destroy(&operands[k]);
}

/// Counts surfels on the plane x = at within the unit square about the axis.
static uint64_t count_on_plane(const ewa_cloud *cloud, double at) {
    plain_surfels s = read_surfels(cloud);
    uint64_t count = 0;
    for (uint64_t i = 0; i < s.count; i++) {
        const double *p = &s.position[3 * i];
        count += fabs(p[0] - at) < 1e-3 && fabs(p[1]) < 0.8 && fabs(p[2]) < 0.8;
    }
    free_surfels(&s);
    return count;
}

TEST_LOGGED(test_coinciding_faces, 0) {
    const double here[3] = {0, 0, 0}, beside[3] = {2, 0, 0};
    ewa_cloud *a = make(context, EWA_OBJECT_CUBE, 3000, 2, here);
    ewa_cloud *b = make(context, EWA_OBJECT_CUBE, 2500, 2, beside);
    ewa_cloud *joined = combine(a, b, EWA_CSG_UNION);
    assert_int_equal(count_on_plane(joined, 1), 0);
    assert_true(count_on_plane(joined, -1) > 100 && count_on_plane(joined, 3) > 100);
    ewa_cloud *cut = combine(a, b, EWA_CSG_DIFFERENCE);
    assert_true(count_on_plane(cut, 1) > 100);
    const uint64_t count = ewa_cloud_point_count(a);
    ewa_cloud *twice = combine(a, a, EWA_CSG_UNION), *both = combine(a, a, EWA_CSG_INTERSECTION);
    assert_int_equal(count_on_plane(twice, 1), count_on_plane(a, 1));
    assert_int_equal(count_on_plane(both, 1), count_on_plane(a, 1));
    assert_int_equal(log->count, 0);
    ewa_cloud *nothing = combine(a, a, EWA_CSG_DIFFERENCE);
    print_message("%llu surfels: %llu in union with itself, %llu without itself\n", (unsigned long long)count,
                  (unsigned long long)ewa_cloud_point_count(twice),
                  (unsigned long long)ewa_cloud_point_count(nothing));
    // Specks at the corners, where three planes meet and only two are looked at.
    plain_surfels specks = read_surfels(nothing);
    for (uint64_t i = 0; i < specks.count; i++)
        for (uint64_t c = 0; c < 3; c++) assert_true(fabs(fabs(specks.position[3 * i + c]) - 1) < 0.05);
    free_surfels(&specks);
    ewa_cloud *all[] = {a, b, joined, cut, twice, both, nothing};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) ewa_cloud_destroy(&all[i]);
}

TEST_ON(test_far_apart_and_within, 0) {
    const double here[3] = {0, 0, 0}, far[3] = {50, 0, 0};
    OWNED(ewa_cloud_destroy) ewa_cloud *a = make(context, EWA_OBJECT_SPHERE, 2000, 2, here);
    OWNED(ewa_cloud_destroy) ewa_cloud *b = make(context, EWA_OBJECT_SPHERE, 1000, 2, far);
    OWNED(ewa_cloud_destroy) ewa_cloud *inner = make(context, EWA_OBJECT_SPHERE, 1000, 1, here);
    const struct {
        const ewa_cloud *b;
        uint64_t counts[3];
    } rows[] = {{b, {3000, 0, 2000}}, {inner, {2000, 1000, 3000}}};
    for (int row = 0; row < 2; row++)
        for (int operation = 0; operation < 3; operation++) {
            OWNED(ewa_cloud_destroy) ewa_cloud *result = combine(a, rows[row].b, (ewa_csg_operation)operation);
            assert_int_equal(ewa_cloud_point_count(result), rows[row].counts[operation]);
        }
    // The inner sphere's normals are turned.
    OWNED(ewa_cloud_destroy) ewa_cloud *shell = combine(a, inner, EWA_CSG_DIFFERENCE);
    plain_surfels s = read_surfels(shell);
    for (uint64_t i = 0; i < s.count; i++) {
        const double *p = &s.position[3 * i], *n = &s.normal[3 * i];
        assert_true((p[0] * n[0] + p[1] * n[1] + p[2] * n[2] > 0) == (length_of(p) > 0.75));
    }
    free_surfels(&s);
}

/// The points of a cloud whose coordinate `axis` is below a limit.
static ewa_cloud *cut_off(const ewa_cloud *cloud, int axis, double limit) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    OWNED(check_free) double *position = read_stream(cloud, EWA_POSITION, 3);
    uint64_t *indices = malloc((count + 1) * sizeof *indices), kept = 0;
    assert_non_null(indices);
    for (uint64_t i = 0; i < count; i++)
        if (position[3 * i + (uint64_t)axis] < limit) indices[kept++] = i;
    ewa_cloud *part = NULL;
    assert_int_equal(ewa_cloud_select(cloud, indices, kept, &part), EWA_OK);
    free(indices);
    return part;
}

TEST_LOGGED(test_open_operands, 0) {
    const double here[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    ewa_cloud *ball = make(context, EWA_OBJECT_SPHERE, 20000, 2, here);
    ewa_cloud *other = make(context, EWA_OBJECT_SPHERE, 3000, 0.5, up), *result = NULL;
    ewa_cloud *bowl = cut_off(ball, 2, 0), *dented = cut_off(ball, 2, 0.9);
    assert_int_equal(ewa_cloud_csg(other, bowl, NULL, &result), EWA_ERROR_ARGUMENT);
    assert_null(result);
    assert_non_null(strstr(log->text, "operand B is not closed"));
    assert_int_equal(ewa_cloud_csg(bowl, other, NULL, &result), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "operand A is not closed"));
    // A missing cap is too small for the sum of normals to tell, but leads from outside to inside.
    assert_int_equal(ewa_cloud_csg(other, dented, NULL, &result), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "operand B is not closed"));
    ewa_cloud *all[] = {ball, other, bowl, dented};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) ewa_cloud_destroy(&all[i]);
}

TEST(test_same_bytes) {
    ewa_cloud *results[3];
    ewa_context *contexts[3];
    for (uint32_t t = 0; t < 3; t++) {
        contexts[t] = check_context(t * t + 1, NULL);
        const double here[3] = {0, 0, 0}, there[3] = {0.8, 0.7, 0.6};
        OWNED(ewa_cloud_destroy) ewa_cloud *a = make(contexts[t], EWA_OBJECT_CUBE, 20000, 2, here);
        OWNED(ewa_cloud_destroy) ewa_cloud *b = make(contexts[t], EWA_OBJECT_SPHERE, 20000, 2, there);
        results[t] = combine(a, b, EWA_CSG_DIFFERENCE);
    }
    for (uint32_t t = 1; t < 3; t++) {
        assert_int_equal(ewa_cloud_point_count(results[t]), ewa_cloud_point_count(results[0]));
        for (uint32_t k = 0; k < ewa_cloud_attribute_count(results[0]); k++) {
            const ewa_attribute *expected = ewa_cloud_attribute_at(results[0], k);
            const ewa_attribute *found = ewa_cloud_find(results[t], expected->name);
            assert_non_null(found);
            assert_memory_equal(found->data, expected->data,
                                expected->stride_bytes * (size_t)ewa_cloud_point_count(results[0]));
        }
    }
    for (uint32_t t = 0; t < 3; t++) {
        ewa_cloud_destroy(&results[t]);
        ewa_context_destroy(&contexts[t]);
    }
}

/// A point so far off that squares overflow is no surfel, in either operand.
TEST_ON(test_overflow, 1) {
    enum { POINTS = 500 };
    const double here[3] = {0, 0, 0}, aside[3] = {0.5, 0, 0};
    ewa_cloud *clouds[2] = {make(context, EWA_OBJECT_SPHERE, POINTS, 2, here),
                            make(context, EWA_OBJECT_SPHERE, POINTS, 2, aside)};
    double numbers[3 * POINTS], *position = NULL;
    ewa_attribute_read_f64(ewa_cloud_find(clouds[0], EWA_POSITION), 0, POINTS, numbers);
    assert_int_equal(ewa_cloud_add(clouds[0], EWA_POSITION, EWA_F64, 3, (void **)&position), EWA_OK);
    memcpy(position, numbers, sizeof numbers);
    position[0] = 1e200;
    for (int k = 0; k < 2; k++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *both = combine(clouds[k], clouds[1 - k], EWA_CSG_UNION);
        OWNED(check_free) double *found = read_stream(both, EWA_POSITION, 3);
        assert_true(ewa_cloud_point_count(both) > POINTS);
        for (uint64_t i = 0; i < 3 * ewa_cloud_point_count(both); i++) assert_true(fabs(found[i]) < 2);
    }
    for (int k = 0; k < 2; k++) ewa_cloud_destroy(&clouds[k]);
}

TEST_LOGGED(test_refused, 0) {
    const double here[3] = {0, 0, 0};
    ewa_cloud *ball = make(context, EWA_OBJECT_SPHERE, 500, 2, here), *bare = NULL, *result = NULL;
    assert_int_equal(ewa_cloud_create(context, 3, &bare), EWA_OK);
    assert_int_equal(ewa_cloud_csg(NULL, ball, NULL, &result), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_csg(ball, bare, NULL, &result), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "operand B"));
    WITH_DEFAULTS(ewa_csg_options, options);
    options.operation = (ewa_csg_operation)3;
    assert_int_equal(ewa_cloud_csg(ball, ball, &options, &result), EWA_ERROR_ARGUMENT);
    options.operation = EWA_CSG_UNION;
    options.cutoff = 0;
    assert_int_equal(ewa_cloud_csg(ball, ball, &options, &result), EWA_ERROR_ARGUMENT);
    // Points that are no surfels are left out; none that is one is an error.
    ewa_cloud *flat = check_cloud_of(context, 2);
    float *position = check_add(flat, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(flat, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(flat, EWA_RADIUS, EWA_F32, 1);
    memset(position, 0, 6 * sizeof *position);
    memset(normal, 0, 6 * sizeof *normal);
    position[0] = NAN;
    radius[0] = radius[1] = 1;
    assert_int_equal(ewa_cloud_csg(flat, ball, NULL, &result), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "none of the 2 points"));
    assert_null(result);
    ewa_cloud_destroy(&flat);
    ewa_cloud_destroy(&ball);
    ewa_cloud_destroy(&bare);
}

/// Two operands of their own and what is left of them.
static ewa_status combine_work(ewa_context *context, void *user) {
    const ewa_csg_operation operation = *(const ewa_csg_operation *)user;
    ewa_cloud *operands[2] = {NULL, NULL}, *result = NULL;
    WITH_DEFAULTS(ewa_generate_options, options);
    options.point_count = 700;
    ewa_status status = EWA_OK;
    for (int k = 0; k < 2 && status == EWA_OK; k++) {
        static const double aside[16] = {1, 0, 0, 0.6, 0, 1, 0, 0.4, 0, 0, 1, 0.3, 0, 0, 0, 1};
        options.object = k ? EWA_OBJECT_SPHERE : EWA_OBJECT_CUBE;
        options.sharp = k == 0;
        status = ewa_cloud_generate(context, &options, &operands[k]);
        if (k && status == EWA_OK) status = ewa_cloud_transform(operands[k], aside);
    }
    WITH_DEFAULTS(ewa_csg_options, csg);
    csg.operation = operation;
    if (status == EWA_OK) status = ewa_cloud_csg(operands[0], operands[1], &csg, &result);
    if (status != EWA_OK) assert_null(result);
    ewa_cloud_destroy(&operands[0]);
    ewa_cloud_destroy(&operands[1]);
    ewa_cloud_destroy(&result);
    return status;
}

TEST(test_failing_allocations) {
    for (ewa_csg_operation operation = EWA_CSG_UNION; operation <= EWA_CSG_DIFFERENCE; operation++)
        scratch_fail_each(combine_work, &operation);
}

/// Whether two half-planes have a place of the disc in common, beside trying places all over it.
TEST(test_common_places) {
    enum { PAIRS = 400, RINGS = 40, TURNS = 360 };
    const double cutoff = 2.5, TURN = 6.283185307179586;
    check_random random = {17};
    int apart = 0;
    for (int pair = 0; pair < PAIRS; pair++) {
        ewa_line_set sets[2];
        for (int k = 0; k < 2; k++) {
            const double angle = check_uniform(&random, 0, TURN), scale = check_uniform(&random, 0.5, 2);
            sets[k] = (ewa_line_set){.count = 1};
            sets[k].line[0] = (ewa_vec3){scale * cos(angle), scale * sin(angle), scale * check_uniform(&random, -2.5, 1)};
        }
        double deepest = -INFINITY;
        for (int ring = 0; ring <= RINGS; ring++)
            for (int turn = 0; turn < TURNS; turn++) {
                const double u = cutoff * ring / RINGS * cos(TURN * turn / TURNS), v = cutoff * ring / RINGS * sin(TURN * turn / TURNS);
                double depth = INFINITY;
                for (int k = 0; k < 2; k++) {
                    const ewa_vec3 l = sets[k].line[0];
                    depth = fmin(depth, (l.x * u + l.y * v + l.z) / hypot(l.x, l.y));
                }
                deepest = fmax(deepest, depth);
            }
        if (fabs(deepest - 0.02) < 0.03) continue; // between the places
        assert_int_equal(ewa_lines_exclude(&sets[0], &sets[1], cutoff), deepest < 0.02);
        apart += deepest < 0.02;
    }
    assert_in_range(apart, PAIRS / 10, PAIRS);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
