// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Noisy samplings of solids whose sharp edges are known.
#include "quality/feature_scene.h"

#include <math.h>
#include <string.h>
#include <time.h>

#define PI           3.141592653589793
#define SHARP_COSINE 0.8191520442889918 // 35 degrees
#define VAGUE_COSINE 0.9396926207859084 // 20 degrees

enum { MAX_VERTICES = 1 << 16 };

/// A mesh of triangles.
typedef struct mesh {
    double (*vertices)[3];
    uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
} mesh;

static void *get_memory(size_t count, size_t size) {
    void *memory = calloc(count, size);
    assert_non_null(memory);
    return memory;
}

static void add_place(feature_scene *scene, const double p[3], uint32_t capacity) {
    assert_true(scene->count < capacity);
    memcpy(scene->place[scene->count++], p, 3 * sizeof *p);
}

static double jitter(check_random *random) { return 0.5 + check_uniform(random, -0.25, 0.25); }

static void make_cube(feature_scene *scene, uint32_t count) {
    check_random random = {3};
    const uint32_t side = (uint32_t)sqrt(count / 6.0), capacity = 6 * side * side;
    scene->spacing = 2.0 / side;
    scene->place = get_memory(capacity, sizeof *scene->place);
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t i = 0; i < side * side; i++) {
            double p[3];
            p[face % 3] = face < 3 ? -1 : 1;
            p[(face + 1) % 3] = scene->spacing * (i % side + jitter(&random)) - 1;
            p[(face + 2) % 3] = scene->spacing * (i / side + jitter(&random)) - 1;
            add_place(scene, p, capacity);
        }
}

static void make_cylinder(feature_scene *scene, uint32_t count) {
    check_random random = {4};
    const double h = scene->spacing = sqrt(6 * PI / count);
    const uint32_t around = (uint32_t)(2 * PI / h), rows = (uint32_t)(2 / h), side = (uint32_t)(2 / h) + 1;
    const uint32_t capacity = around * rows + 2 * side * side;
    scene->place = get_memory(capacity, sizeof *scene->place);
    for (uint32_t i = 0; i < around * rows; i++) {
        const double angle = 2 * PI * (i % around + jitter(&random)) / around;
        const double p[3] = {cos(angle), sin(angle), 2 * (i / around + jitter(&random)) / rows - 1};
        add_place(scene, p, capacity);
    }
    for (uint32_t i = 0; i < 2 * side * side; i++) {
        const double p[3] = {h * (i % side + jitter(&random)) - 1,
                             h * (i / side % side + jitter(&random)) - 1, i < side * side ? -1 : 1};
        if (p[0] * p[0] + p[1] * p[1] < 1) add_place(scene, p, capacity);
    }
}

/// Reads vertices and triangles of a Wavefront file; false when it is missing.
static bool read_mesh(const char *path, mesh *read) {
    FILE *file = path ? fopen(path, "r") : NULL;
    if (!file) return false;
    *read = (mesh){.vertices = get_memory(MAX_VERTICES, sizeof *read->vertices),
                   .triangles = get_memory(2 * MAX_VERTICES, sizeof *read->triangles)};
    char line[256];
    while (fgets(line, sizeof line, file)) {
        if (line[0] == 'v' && line[1] == ' ' && read->vertex_count < MAX_VERTICES) {
            char *at = line + 2;
            for (int c = 0; c < 3; c++) read->vertices[read->vertex_count][c] = strtod(at, &at);
            read->vertex_count++;
        } else if (line[0] == 'f' && line[1] == ' ' && read->triangle_count < 2 * MAX_VERTICES) {
            char *at = line + 2;
            for (int c = 0; c < 3; c++) {
                const unsigned long index = strtoul(at, &at, 10);
                assert_true(index >= 1 && index <= read->vertex_count);
                read->triangles[read->triangle_count][c] = (uint32_t)index - 1;
                at += strcspn(at, " \n");
            }
            read->triangle_count++;
        }
    }
    fclose(file);
    return true;
}

static void subtract(const double a[3], const double b[3], double d[3]) {
    for (int c = 0; c < 3; c++) d[c] = a[c] - b[c];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The unit normal of a triangle; returns twice its area.
static double find_normal(const mesh *m, uint32_t t, double n[3]) {
    double a[3], b[3];
    subtract(m->vertices[m->triangles[t][1]], m->vertices[m->triangles[t][0]], a);
    subtract(m->vertices[m->triangles[t][2]], m->vertices[m->triangles[t][0]], b);
    for (int c = 0; c < 3; c++) n[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    const double length = sqrt(dot(n, n));
    for (int c = 0; c < 3 && length > 0; c++) n[c] /= length;
    return length;
}

/// Sorts the mesh's edges into sharp, vague and smooth ones.
static void find_edges(feature_scene *scene, const mesh *m) {
    scene->edges = get_memory(3 * m->triangle_count, sizeof *scene->edges);
    scene->vague = get_memory(3 * m->triangle_count, sizeof *scene->vague);
    for (uint32_t i = 0; i < 3 * m->triangle_count; i++) {
        const uint32_t a = m->triangles[i / 3][i % 3], b = m->triangles[i / 3][(i + 1) % 3];
        for (uint32_t j = i + 1; j < 3 * m->triangle_count; j++) {
            if (m->triangles[j / 3][j % 3] != b || m->triangles[j / 3][(j + 1) % 3] != a) continue;
            double n[2][3];
            find_normal(m, i / 3, n[0]);
            find_normal(m, j / 3, n[1]);
            const double cosine = dot(n[0], n[1]);
            if (cosine > VAGUE_COSINE) continue;
            double(*to)[3] = cosine > SHARP_COSINE ? scene->vague[scene->vague_count++]
                                                   : scene->edges[scene->edge_count++];
            memcpy(to[0], m->vertices[a], sizeof to[0]);
            memcpy(to[1], m->vertices[b], sizeof to[1]);
        }
    }
}

/// Samples every triangle on a jittered grid of its own.
static void sample_mesh(feature_scene *scene, const mesh *m, uint32_t count) {
    check_random random = {5};
    double area = 0, n[3];
    for (uint32_t t = 0; t < m->triangle_count; t++) area += find_normal(m, t, n) / 2;
    const double h = scene->spacing = sqrt(area / count);
    scene->place = get_memory(2 * (size_t)count, sizeof *scene->place);
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        const double *o = m->vertices[m->triangles[t][0]];
        double a[3], b[3], v[3];
        const double twice = find_normal(m, t, n);
        subtract(m->vertices[m->triangles[t][1]], o, a);
        subtract(m->vertices[m->triangles[t][2]], o, b);
        const double length = sqrt(dot(a, a));
        if (!(twice > 0)) continue;
        for (int c = 0; c < 3; c++) a[c] /= length;
        for (int c = 0; c < 3; c++) v[c] = n[(c + 1) % 3] * a[(c + 2) % 3] - n[(c + 2) % 3] * a[(c + 1) % 3];
        const double bx = dot(b, a), by = dot(b, v);
        const double start = floor(fmin(bx, 0) / h) * h, end = fmax(bx, length);
        for (double y = 0; y < by; y += h) {
            for (double x = start; x < end; x += h) {
                const double px = x + h * jitter(&random), py = y + h * jitter(&random);
                // Inside: left of the two other sides.
                if (py >= by || px * by < py * bx || (px - length) * by > py * (bx - length)) continue;
                double p[3];
                for (int c = 0; c < 3; c++) p[c] = o[c] + px * a[c] + py * v[c];
                add_place(scene, p, 2 * count);
            }
        }
    }
}

static double distance_to_edges(double (*edges)[2][3], uint32_t count, const double p[3]) {
    double nearest = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        double along[3], d[3];
        subtract(edges[i][1], edges[i][0], along);
        subtract(p, edges[i][0], d);
        const double t = fmin(fmax(dot(d, along) / dot(along, along), 0), 1);
        for (int c = 0; c < 3; c++) d[c] -= t * along[c];
        nearest = fmin(nearest, sqrt(dot(d, d)));
    }
    return nearest;
}

static double edge_distance(const feature_scene *scene, const double p[3]) {
    if (scene->solid == SOLID_PART) return distance_to_edges(scene->edges, scene->edge_count, p);
    if (scene->solid == SOLID_CYLINDER) {
        const double r = sqrt(p[0] * p[0] + p[1] * p[1]) - 1, z = fabs(p[2]) - 1;
        return sqrt(r * r + z * z);
    }
    double nearest = INFINITY;
    for (int c = 0; c < 3; c++) {
        const double x = fabs(p[(c + 1) % 3]) - 1, y = fabs(p[(c + 2) % 3]) - 1, z = fmax(fabs(p[c]) - 1, 0);
        nearest = fmin(nearest, sqrt(x * x + y * y + z * z));
    }
    return nearest;
}

static double gauss(check_random *random) {
    double sum = 0;
    for (int i = 0; i < 12; i++) sum += check_uniform(random, -0.5, 0.5);
    return sum;
}

/// The point of a surfel's first line that is nearest to its centre.
static void find_foot(const float *position, const float *u, const float *v, const float *line,
                      double foot[3]) {
    double uu = 0, vv = 0;
    for (int c = 0; c < 3; c++) uu += (double)u[c] * (double)u[c], vv += (double)v[c] * (double)v[c];
    // Axes are orthogonal: the world vector a u / |u|^2 + b v / |v|^2 is across the line.
    double across[3], length2 = 0;
    for (int c = 0; c < 3; c++) {
        across[c] = (double)line[0] * (double)u[c] / uu + (double)line[1] * (double)v[c] / vv;
        length2 += across[c] * across[c];
    }
    for (int c = 0; c < 3; c++) foot[c] = (double)position[c] - (double)line[2] * across[c] / length2;
}

static void compare(const feature_scene *scene, const ewa_cloud *cloud, feature_score *score) {
    const ewa_attribute *clip = ewa_cloud_find(cloud, EWA_CLIP0);
    const float *lines = clip ? clip->data : NULL, *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    const float *u = clip ? ewa_cloud_find(cloud, EWA_TANGENT_U)->data : NULL;
    const float *v = clip ? ewa_cloud_find(cloud, EWA_TANGENT_V)->data : NULL;
    double close = 0, close_found = 0, right = 0, strict = 0, strict_found = 0, error2 = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        const double h = scene->spacing, d = edge_distance(scene, scene->place[i]) / h;
        if (d > 2 && distance_to_edges(scene->vague, scene->vague_count, scene->place[i]) < 2.5 * h) continue;
        const bool found = lines && (lines[3 * i] != 0 || lines[3 * i + 1] != 0);
        close += d <= 1, close_found += found && d <= 1;
        strict += d <= 1.5, strict_found += found && d <= 1.5;
        score->clipped += found;
        if (!found || d > 2) continue;
        right++;
        double foot[3];
        find_foot(&position[3 * i], &u[3 * i], &v[3 * i], &lines[3 * i], foot);
        const double error = edge_distance(scene, foot) / h;
        error2 += error * error;
    }
    const double clipped = score->clipped > 0 ? score->clipped : 1;
    score->recall = close_found / close;
    score->precision = right / clipped;
    score->strict_recall = strict_found / strict;
    score->strict_precision = strict_found / clipped;
    score->line_error = right > 0 ? sqrt(error2 / right) : 0;
}

static double now_s(void) {
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool feature_scene_make(feature_solid solid, const char *path, uint32_t count, feature_scene *scene) {
    *scene = (feature_scene){.solid = solid};
    if (solid == SOLID_CUBE) make_cube(scene, count);
    if (solid == SOLID_CYLINDER) make_cylinder(scene, count);
    if (solid == SOLID_PART) {
        mesh part;
        if (!read_mesh(path, &part)) return false;
        find_edges(scene, &part);
        sample_mesh(scene, &part, count);
        free(part.vertices);
        free(part.triangles);
    }
    return true;
}

void feature_scene_free(feature_scene *scene) {
    free(scene->place);
    free(scene->edges);
    free(scene->vague);
    *scene = (feature_scene){0};
}

ewa_cloud *feature_scene_detect(ewa_context *context, const feature_scene *scene, double noise,
                                ewa_feature_counts *counts, double *seconds) {
    check_random random = {17};
    ewa_cloud *cloud = check_cloud_of(context, scene->count);
    float *xyz = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    for (uint32_t i = 0; i < scene->count; i++)
        for (int c = 0; c < 3; c++)
            xyz[3 * i + (uint32_t)c] = (float)(scene->place[i][c] + noise * scene->spacing * gauss(&random));
    WITH_DEFAULTS(ewa_estimate_options, estimate);
    assert_int_equal(ewa_cloud_estimate(&cloud, &estimate), EWA_OK);
    WITH_DEFAULTS(ewa_feature_options, options);
    const double started_s = now_s();
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, counts), EWA_OK);
    *seconds = now_s() - started_s;
    return cloud;
}

void feature_scene_measure(ewa_context *context, const feature_scene *scene, double noise,
                           feature_score *score) {
    *score = (feature_score){0};
    ewa_cloud *cloud = feature_scene_detect(context, scene, noise, &score->counts, &score->seconds);
    compare(scene, cloud, score);
    ewa_cloud_destroy(&cloud);
}
