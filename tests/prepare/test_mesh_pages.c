// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sampling of meshes in which many sharp edges meet, and how often sampling asks whether to go on.
#include "mesh_shapes.h"

static const double PI = 3.14159265358979323846;

/// Pages: triangles with one edge in common, in equal angles around it.
static void make_book(ewa_context *context, uint32_t pages, ewa_mesh *mesh) {
    assert_int_equal(ewa_mesh_create(context, pages + 2, pages, 0, 0, mesh), EWA_OK);
    memset(mesh->positions, 0, 6 * sizeof *mesh->positions);
    mesh->positions[5] = 1;
    for (uint32_t i = 0; i < pages; i++) {
        double *p = mesh->positions + 3 * (i + 2);
        p[0] = cos(2 * PI * i / pages), p[1] = sin(2 * PI * i / pages), p[2] = 0.5;
        uint32_t *t = mesh->triangles + 3 * (size_t)i;
        t[0] = 0, t[1] = 1, t[2] = i + 2;
    }
}

/// What lies on the pages of a book, a number for each.
typedef struct pages_seen {
    uint32_t *points;
    double cut; ///< share of the points that have a line
} pages_seen;

static pages_seen look_at_book(ewa_context *context, uint32_t pages, double spacing_world, uint64_t seed) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    make_book(context, pages, &mesh);
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.spacing_world = spacing_world;
    options.seed = seed;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    const uint64_t count = ewa_cloud_point_count(cloud);
    pages_seen seen = {.points = calloc(pages, sizeof *seen.points)};
    assert_non_null(seen.points);
    OWNED(check_free) double *places = shape_places(cloud);
    const float *normal = ewa_cloud_find(cloud, EWA_NORMAL)->data;
    const float *line = ewa_cloud_find(cloud, EWA_CLIP0)->data;
    for (uint64_t i = 0; i < count; i++) {
        // A page is known by its normal: at the common edge all of them are at one place.
        const double *p = places + 3 * i, x = (double)normal[3 * i + 1], y = -(double)normal[3 * i];
        const long page = lround(atan2(y, x) * pages / (2 * PI));
        const uint32_t index = (uint32_t)(page < 0 ? page + pages : page);
        assert_true(index < pages);
        seen.points[index]++;
        const double angle = 2 * PI * index / pages, out = p[0] * cos(angle) + p[1] * sin(angle);
        assert_float_equal(p[1] * cos(angle) - p[0] * sin(angle), 0, 1e-6);
        assert_true(out > -1e-6 && p[2] > 0.5 * out - 1e-6 && p[2] < 1 - 0.5 * out + 1e-6);
        seen.cut += line[3 * i] != 0 || line[3 * i + 1] != 0 ? 1 / (double)count : 0;
    }
    return seen;
}

/// However many pages meet in one edge, each is sampled and cut as if it were alone; and the work is that of
/// the pages, not of all pairs of them, or this would take very long.
TEST_ON(test_book, 1) {
    enum { PAGES = 5000, ALONE = 200 };
    const double spacing = 0.3;
    double points = 0, cut = 0;
    for (uint64_t seed = 1; seed <= ALONE; seed++) {
        const pages_seen page = look_at_book(context, 1, spacing, seed);
        points += page.points[0], cut += page.points[0] * page.cut;
        free(page.points);
    }
    const pages_seen book = look_at_book(context, PAGES, spacing, 1);
    double sum = 0;
    for (int i = 0; i < PAGES; i++) {
        assert_true(book.points[i] > 0.5 * points / ALONE && book.points[i] < 1.7 * points / ALONE);
        sum += book.points[i];
    }
    print_message("points on a page: %.2f, of these cut %.3f; alone: %.2f, %.3f\n", sum / PAGES, book.cut,
                  points / ALONE, cut / points);
    assert_float_equal(sum / PAGES, points / ALONE, 0.05 * points / ALONE);
    assert_float_equal(book.cut, cut / points, 0.02);
    free(book.points);
}

typedef struct progress_log {
    int calls, late, stop_at;
    double last;
} progress_log;

static bool follow(void *user, const char *stage, double fraction) {
    progress_log *log = user;
    // Curvatures are measured afterwards: stages of their own.
    const bool samples = strcmp(stage, "sample") == 0;
    assert_true(fraction >= (samples ? log->last : 0) && fraction <= 1);
    assert_true(samples || log->last == 1);
    if (samples) log->last = fraction;
    log->late += samples && fraction > 0.7;
    return ++log->calls != log->stop_at;
}

static ewa_status sample_square(progress_log *log, uint64_t point_count, ewa_cloud **cloud) {
    OWNED(ewa_context_destroy)
    ewa_context *context = check_context_telling(1, follow, log); // which of several workers is done first decides how often is told
    static const double places[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_fill(context, 4, places, 2, (const uint32_t[]){0, 1, 2, 2, 1, 3}, &mesh);
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = point_count;
    *cloud = NULL;
    const ewa_status status = ewa_mesh_sample(&mesh, &options, cloud);
    if (status == EWA_OK) { // every point, whenever its turn was, has got what it gets
        const uint64_t count = ewa_cloud_point_count(*cloud);
        const float *normal = ewa_cloud_find(*cloud, EWA_NORMAL)->data;
        assert_true(count > point_count / 10 * 9);
        for (uint64_t i = 0; i < count; i++) assert_true(normal[3 * i + 2] == 1);
        ewa_cloud_destroy(cloud);
    }
    return status;
}

/// Sampling asks all along whether to go on, also while many points get their colours and lines; it ends at
/// whichever no.
TEST(test_progress) {
    ewa_cloud *cloud;
    progress_log many = {.stop_at = -1}, all = {.stop_at = -1};
    assert_int_equal(sample_square(&many, 700000, &cloud), EWA_OK);
    assert_true(many.last == 1 && many.late >= 2);
    assert_int_equal(sample_square(&all, 300, &cloud), EWA_OK);
    assert_true(all.calls > 10 && all.last == 1);
    for (int stop = 1; stop <= all.calls; stop++) {
        progress_log log = {.stop_at = stop};
        assert_int_equal(sample_square(&log, 300, &cloud), EWA_CANCELLED);
        assert_null(cloud);
        assert_int_equal(log.calls, stop);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
