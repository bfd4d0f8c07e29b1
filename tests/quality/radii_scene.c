// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Samplings, a plain tree of neighbours, and what pictures and radii say of a cloud.
#include "quality/radii_scene.h"

#include <math.h>

#define PI 3.141592653589793

enum { SIDE = 640, LOCAL = 64, LEAF = 8 };

static double gaussian(check_random *random) {
    const double u = 1 - check_uniform(random, 0, 1), v = check_uniform(random, 0, 2 * PI);
    return sqrt(-2 * log(u)) * cos(v);
}

static double hills(double x, double y) {
    return 0.15 * sin(3 * x) * cos(2.5 * y) + 0.05 * sin(11 * x + 2 * y) + 0.02 * cos(23 * y - 7 * x);
}

/// The point of a sampling of the plane that the scene is made of.
static void fill_plane(radii_kind kind, double detail, uint32_t i, uint32_t count, check_random *random,
                       double p[3]) {
    p[0] = check_uniform(random, -1, 1);
    p[1] = check_uniform(random, -1, 1);
    p[2] = 0;
    const double spacing = 2 / sqrt((double)count);
    if (kind == RADII_TERRAIN) p[2] = hills(p[0], p[1]);
    if (kind == RADII_NOISY) p[2] = detail * spacing * gaussian(random);
    if (kind == RADII_LINES) {
        const uint32_t along = (uint32_t)sqrt(count * detail), line = i / along;
        const double step = 2.0 / along;
        p[0] = -1 + step * (i % along + 0.5 + check_uniform(random, -0.3, 0.3));
        p[1] = -1 + step * detail * (line + 0.5) + 0.02 * step * gaussian(random);
    }
    // The sparse half has 1 / detail^2 of the density.
    if (kind == RADII_STEP) {
        const double dense = detail * detail / (1 + detail * detail);
        p[0] =
            check_uniform(random, 0, 1) < dense ? check_uniform(random, -1, 0) : check_uniform(random, 0, 1);
    }
    if (kind == RADII_LONE && i % 5000 == 7) p[2] = check_uniform(random, 0.3, 1);
}

void radii_scene_fill(radii_kind kind, double detail, uint32_t count, float *xyz) {
    check_random random = {2026 + (uint64_t)kind};
    for (uint32_t i = 0; i < count; i++) {
        double p[3];
        fill_plane(kind, detail, i, count, &random, p);
        if (kind == RADII_SPHERE) {
            const double z = check_uniform(&random, -1, 1), a = PI * p[0], r = sqrt(1 - z * z);
            p[0] = r * cos(a), p[1] = r * sin(a), p[2] = z;
        }
        if (kind == RADII_CURVE) {
            const double t = i / (double)count;
            p[0] = cos(4 * PI * t), p[1] = sin(4 * PI * t), p[2] = 2 * t - 1;
        }
        // As many points between each distance and its double, flat as a garden.
        if (kind == RADII_GARDEN) {
            const double z = check_uniform(&random, -1, 1), a = PI * p[0], flat = sqrt(1 - z * z);
            const double r = pow(1000, -check_uniform(&random, 0, 1));
            p[0] = r * flat * cos(a), p[1] = r * flat * sin(a), p[2] = 0.3 * r * z;
        }
        if (kind == RADII_FOG) p[2] = check_uniform(&random, -1, 1);
        for (int c = 0; c < 3; c++) xyz[3 * (size_t)i + (size_t)c] = (float)p[c];
    }
}

struct radii_tree {
    double (*place)[3]; // in the order of the tree: each range is split at its middle
    uint32_t *index, count;
};

/// Orders range [begin, end) so that the middle is in its place along an axis (C. A. R. Hoare, 1961).
static void split_range(radii_tree *tree, uint32_t begin, uint32_t end, int axis) {
    const uint32_t middle = begin + (end - begin) / 2;
    while (end - begin > 1) {
        const double pivot = tree->place[begin + (end - begin - 1) / 2][axis];
        uint32_t low = begin, high = end - 1;
        for (;;) {
            while (tree->place[low][axis] < pivot) low++;
            while (tree->place[high][axis] > pivot) high--;
            if (low >= high) break;
            double p[3];
            memcpy(p, tree->place[low], sizeof p);
            memcpy(tree->place[low], tree->place[high], sizeof p);
            memcpy(tree->place[high], p, sizeof p);
            const uint32_t index = tree->index[low];
            tree->index[low++] = tree->index[high];
            tree->index[high--] = index;
        }
        const uint32_t cut = high + 1;
        if (middle < cut)
            end = cut;
        else
            begin = cut;
    }
}

static void build_range(radii_tree *tree, uint32_t begin, uint32_t end, int axis) {
    if (end - begin <= LEAF) return;
    split_range(tree, begin, end, axis);
    const uint32_t middle = begin + (end - begin) / 2;
    build_range(tree, begin, middle, (axis + 1) % 3);
    build_range(tree, middle + 1, end, (axis + 1) % 3);
}

radii_tree *radii_tree_make(const double (*place)[3], uint32_t count) {
    radii_tree *tree = malloc(sizeof *tree);
    assert_non_null(tree);
    *tree = (radii_tree){malloc((count + (size_t)1) * sizeof *place), malloc((count + (size_t)1) * 4), count};
    assert_true(tree->place && tree->index);
    memcpy(tree->place, place, count * sizeof *place);
    for (uint32_t i = 0; i < count; i++) tree->index[i] = i;
    build_range(tree, 0, count, 0);
    return tree;
}

void radii_tree_free(radii_tree *tree) {
    if (!tree) return;
    free(tree->place);
    free(tree->index);
    free(tree);
}

typedef struct query {
    const radii_tree *tree;
    const double *p;
    uint32_t wanted, count, *found;
    double *distance2;
} query;

static void offer(query *q, uint32_t at) {
    double d2 = 0;
    for (int c = 0; c < 3; c++) d2 += (q->tree->place[at][c] - q->p[c]) * (q->tree->place[at][c] - q->p[c]);
    if (d2 == 0 || (q->count == q->wanted && d2 >= q->distance2[q->count - 1])) return;
    for (uint32_t i = 0; i < q->count; i++)
        if (q->distance2[i] == d2 &&
            memcmp(q->tree->place[at], q->tree->place[q->found[i]], sizeof *q->tree->place) == 0)
            return;
    uint32_t to = q->count < q->wanted ? q->count++ : q->count - 1;
    for (; to > 0 && q->distance2[to - 1] > d2; to--) {
        q->distance2[to] = q->distance2[to - 1];
        q->found[to] = q->found[to - 1];
    }
    q->distance2[to] = d2;
    q->found[to] = at;
}

static void search_range(query *q, uint32_t begin, uint32_t end, int axis) {
    if (end - begin <= LEAF) {
        for (uint32_t i = begin; i < end; i++) offer(q, i);
        return;
    }
    const uint32_t middle = begin + (end - begin) / 2;
    const double side = q->p[axis] - q->tree->place[middle][axis];
    offer(q, middle);
    for (int far = 0; far < 2; far++) {
        if (far && q->count == q->wanted && side * side > q->distance2[q->count - 1]) return;
        if ((side < 0) != (far == 1))
            search_range(q, begin, middle, (axis + 1) % 3);
        else
            search_range(q, middle + 1, end, (axis + 1) % 3);
    }
}

uint32_t radii_tree_nearest(const radii_tree *tree, const double p[3], uint32_t wanted, uint32_t *found,
                            double *distance) {
    query q = {tree, p, wanted, 0, found, distance};
    search_range(&q, 0, tree->count, 0);
    for (uint32_t i = 0; i < q.count; i++) {
        found[i] = tree->index[found[i]];
        distance[i] = sqrt(distance[i]);
    }
    return q.count;
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double (*read_places(const ewa_cloud *cloud))[3] {
    const uint64_t count = ewa_cloud_point_count(cloud);
    double(*place)[3] = malloc((count + 1) * sizeof *place);
    assert_non_null(place);
    ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), 0, count, place[0]);
    return place;
}

static double local_median(const radii_tree *tree, const double (*place)[3], uint32_t point) {
    uint32_t around[LOCAL], unused[LOCAL];
    double distance[LOCAL], spacing[LOCAL];
    const uint32_t count = radii_tree_nearest(tree, place[point], LOCAL, around, distance);
    if (!count) return INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t n = radii_tree_nearest(tree, place[around[i]], LOCAL, unused, distance);
        spacing[i] = distance[n - 1] * sqrt(PI / n);
    }
    qsort(spacing, count, sizeof *spacing, compare_doubles);
    return spacing[count / 2];
}

static double box_diagonal(const ewa_cloud *cloud) {
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += pow(bounds.high_world[c] - bounds.low_world[c], 2);
    return sqrt(sum);
}

void radii_measure_sizes(const ewa_cloud *cloud, uint32_t sample_count, radii_sizes *sizes) {
    const uint32_t count = (uint32_t)ewa_cloud_point_count(cloud);
    double(*place)[3] = read_places(cloud);
    radii_tree *tree = radii_tree_make((const double(*)[3])place, count);
    double *radius = malloc((count + (size_t)1) * 2 * sizeof *radius), *sorted = radius + count;
    OWNED(check_free) double *ratio = malloc((count + (size_t)1) * sizeof *ratio);
    assert_true(radius && ratio);
    ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_RADIUS), 0, count, radius);
    memcpy(sorted, radius, count * sizeof *radius);
    qsort(sorted, count, sizeof *sorted, compare_doubles);
    const double large = count > sample_count ? sorted[count - sample_count] : -1;
    const uint32_t step = 1 + (count - 1) / sample_count;
    uint32_t even = 0;
    double largest = 0, sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (i % step != 0 && radius[i] < large) continue;
        const double r = radius[i] / local_median(tree, (const double(*)[3])place, i);
        largest = fmax(largest, r);
        if (i % step == 0) ratio[even++] = r, sum += r;
    }
    qsort(ratio, even, sizeof *ratio, compare_doubles);
    *sizes = (radii_sizes){ratio[even / 2], sum / even, ratio[(uint32_t)(0.999 * (even - 1))], largest,
                           sorted[count - 1] / box_diagonal(cloud)};
    radii_tree_free(tree);
    free(place);
    free(radius);
}

/// What a hole is looked for with.
typedef struct hole_scene {
    ewa_renderer *renderer;
    ewa_surfels *surfels, *larger;
    float rgba[4 * SIDE * SIDE], coverage[SIDE * SIDE];
    bool inside[SIDE * SIDE], missing[SIDE * SIDE];
    int stack[SIDE * SIDE];
} hole_scene;

static void find_inside(hole_scene *scene) {
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            bool all = x > 0 && y > 0 && x < SIDE - 1 && y < SIDE - 1;
            for (int j = -1; j <= 1 && all; j++)
                for (int i = -1; i <= 1 && all; i++) all = scene->coverage[(y + j) * SIDE + x + i] > 0;
            scene->inside[y * SIDE + x] = all;
        }
}

/// Counts the pixels of the connected set around a missing pixel, and forgets them; 0 if one is not inside.
static uint64_t take_set(hole_scene *scene, int pixel) {
    uint64_t count = 0;
    int depth = 0;
    bool enclosed = true;
    scene->stack[depth++] = pixel;
    scene->missing[pixel] = false;
    while (depth) {
        const int at = scene->stack[--depth], x = at % SIDE, y = at / SIDE;
        count++;
        enclosed &= scene->inside[at];
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                if (x + i < 0 || y + j < 0 || x + i >= SIDE || y + j >= SIDE) continue;
                const int next = (y + j) * SIDE + x + i;
                if (!scene->missing[next]) continue;
                scene->missing[next] = false;
                scene->stack[depth++] = next;
            }
    }
    return enclosed ? count : 0;
}

static uint64_t count_missing(hole_scene *scene, float alpha) {
    uint64_t count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        scene->missing[i] = alpha > 0 ? scene->rgba[4 * i + 3] < alpha : !(scene->coverage[i] > 0);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (scene->missing[i]) count += take_set(scene, i);
    return count;
}

static void add_camera(hole_scene *scene, const ewa_camera *camera, radii_holes *holes) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    const ewa_frame larger = {.coverage = scene->coverage};
    const ewa_frame frame = {.rgba = scene->rgba, .coverage = scene->coverage};
    assert_int_equal(ewa_render(scene->renderer, scene->larger, camera, &options, &larger, NULL), EWA_OK);
    find_inside(scene);
    assert_int_equal(ewa_render(scene->renderer, scene->surfels, camera, &options, &frame, NULL), EWA_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        holes->inside += scene->inside[i];
        holes->rim += scene->inside[i] && !(scene->coverage[i] > 0);
    }
    holes->empty += count_missing(scene, 0);
    holes->translucent += count_missing(scene, 0.5f);
    holes->thin += count_missing(scene, 0.99f);
}

/// A camera that sees `extent` around `target` from an elevation and an azimuth.
static ewa_camera look_at(const double target[3], double extent, double elevation_deg, double azimuth_deg) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    assert_int_equal(ewa_camera_set_fov(&camera, 40), EWA_OK);
    const double e = elevation_deg * PI / 180, a = azimuth_deg * PI / 180;
    const double distance = extent / 2 / tan(20 * PI / 180);
    const double eye[3] = {target[0] + distance * cos(e) * cos(a), target[1] + distance * cos(e) * sin(a),
                           target[2] + distance * sin(e)};
    static const double up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    return camera;
}

/// The middle and the size of the box without the outermost hundredths along each axis.
static double find_middle(const double (*place)[3], uint32_t count, double middle[3]) {
    double *sorted = malloc((count + (size_t)1) * sizeof *sorted), sum = 0;
    assert_non_null(sorted);
    for (int c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < count; i++) sorted[i] = place[i][c];
        qsort(sorted, count, sizeof *sorted, compare_doubles);
        const double low = sorted[count / 100], high = sorted[count - 1 - count / 100];
        middle[c] = (low + high) / 2;
        sum += (high - low) * (high - low);
    }
    free(sorted);
    return sqrt(sum);
}

void radii_measure_holes(ewa_context *context, const ewa_cloud *cloud, int views, uint32_t near_count,
                         radii_holes *holes) {
    *holes = (radii_holes){0};
    const uint32_t count = (uint32_t)ewa_cloud_point_count(cloud);
    hole_scene *scene = calloc(1, sizeof *scene);
    double(*place)[3] = read_places(cloud), middle[3];
    WITH_DEFAULTS(ewa_surfels_options, options);
    assert_non_null(scene);
    assert_int_equal(ewa_surfels_create(cloud, &options, &scene->surfels), EWA_OK);
    options.radius_scale = 1.5;
    assert_int_equal(ewa_surfels_create(cloud, &options, &scene->larger), EWA_OK);
    assert_int_equal(ewa_renderer_create(context, &scene->renderer), EWA_OK);
    const double size = find_middle((const double(*)[3])place, count, middle);
    static const double elevations_deg[] = {90, 35, 10};
    for (int i = 0; i < 3 && (views & RADII_WHOLE); i++) {
        const ewa_camera camera = look_at(middle, size, elevations_deg[i], 40 + 90 * i);
        add_camera(scene, &camera, holes);
    }
    radii_tree *tree = radii_tree_make((const double(*)[3])place, count);
    check_random random = {7};
    for (uint32_t i = 0; i < near_count && (views & RADII_NEAR); i++) {
        const uint32_t point = (uint32_t)(check_random_u64(&random) % count);
        const double spacing = local_median(tree, (const double(*)[3])place, point);
        if (!isfinite(spacing)) continue;
        const ewa_camera camera = look_at(place[point], spacing * SIDE / 12, check_uniform(&random, 25, 90),
                                          check_uniform(&random, 0, 360));
        add_camera(scene, &camera, holes);
    }
    radii_tree_free(tree);
    ewa_renderer_destroy(&scene->renderer);
    ewa_surfels_destroy(&scene->surfels);
    ewa_surfels_destroy(&scene->larger);
    free(place);
    free(scene);
}
