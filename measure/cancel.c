// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/files.md on cancelled calls: measure_cancel [JOB...]. What a caller waits for after it has said no is
// the work between two questions of the progress callback, and what is given back. Both are measured as processor time of the
// one thread that works, so that other programs on the machine do not count; more threads wait for less.
#include "measure.h"

#include <string.h>

enum { POINTS = 10000000, SIDE_PX = 8192, CANCELS = 12 };

/// What a job works on, and what has been asked of it.
typedef struct job_run {
    ewa_context *context;
    ewa_cloud *cloud;
    ewa_mesh mesh;
    uint8_t *marks;
    uint32_t asked, refused_at; ///< questions so far, and the one that is answered by no; 0: none
    double asked_s, refused_s;
    double longest_s, longest_fraction; ///< without a question, and where it ended
    char longest_stage[32];
} job_run;

static double thread_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool answer(void *user, const char *stage, double fraction) {
    job_run *run = user;
    const double now = thread_s();
    if (now - run->asked_s > run->longest_s) {
        run->longest_s = now - run->asked_s;
        run->longest_fraction = fraction;
        snprintf(run->longest_stage, sizeof run->longest_stage, "%s", stage);
    }
    run->asked_s = thread_s();
    if (++run->asked != run->refused_at) return true;
    run->refused_s = run->asked_s;
    return false;
}

static uint64_t point_count(void) { return is_quick() ? 20000 : POINTS; }

static void make_points(job_run *run) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = EWA_OBJECT_TERRAIN;
    options.positions_only = true;
    options.point_count = point_count();
    check(ewa_cloud_generate(run->context, &options, &run->cloud));
}

static void make_file(job_run *run) {
    make_points(run);
    check(ewa_cloud_save(run->cloud, "cancel.laz", NULL));
    ewa_cloud_destroy(&run->cloud);
}

/// A square of two triangles; `textured`, with a picture.
static void make_square(job_run *run, bool textured) {
    check(ewa_mesh_create(run->context, 4, 2, 0, textured ? EWA_MESH_TEXCOORDS : 0, &run->mesh));
    for (uint32_t v = 0; v < 4; v++) {
        const double at[3] = {v & 1, v >> 1, 0};
        memcpy(run->mesh.positions + 3 * (size_t)v, at, sizeof at);
        for (uint32_t c = 0; c < 2 && textured; c++) run->mesh.texcoords[2 * v + c] = (float)at[c];
    }
    static const uint32_t corners[6] = {0, 1, 3, 0, 3, 2};
    memcpy(run->mesh.triangles, corners, sizeof corners);
    if (!textured) return;
    const uint32_t side = is_quick() ? 64 : SIDE_PX / 2;
    ewa_image picture;
    check(ewa_image_create(run->context, side, side, 3, &picture));
    for (size_t i = 0; i < 3 * (size_t)side * side; i++) picture.pixels[i] = (float)(i * 2654435761u % 256) / 255;
    check(ewa_mesh_set_picture(&run->mesh, &picture));
}

static void make_bare_square(job_run *run) { make_square(run, false); }
static void make_textured_square(job_run *run) { make_square(run, true); }

static void make_nothing(job_run *run) { (void)run; }

static void make_marks(job_run *run) {
    make_points(run);
    run->marks = malloc(point_count());
    if (!run->marks) exit(1);
}

static ewa_status estimate(job_run *run) {
    ewa_cloud *copy = NULL; // which the call fills
    memset(run->marks, 1, point_count());
    check(ewa_cloud_keep(run->cloud, run->marks, &copy));
    WITH_DEFAULTS(ewa_estimate_options, options);
    run->asked_s = thread_s();
    const ewa_status status = ewa_cloud_estimate(&copy, &options);
    ewa_cloud_destroy(&copy);
    return status;
}

static ewa_status read_file(job_run *run) {
    ewa_cloud *read = NULL;
    const ewa_status status = ewa_cloud_load(run->context, "cancel.laz", &read);
    ewa_cloud_destroy(&read);
    return status;
}

static ewa_status write_laz(job_run *run) { return ewa_cloud_save(run->cloud, "cancel.laz", NULL); }
static ewa_status write_ply(job_run *run) { return ewa_cloud_save(run->cloud, "cancel.ply", NULL); }

static ewa_status thin_distance(job_run *run) {
    memset(run->marks, 1, point_count());
    return ewa_cloud_thin_distance(run->cloud, 0.002, run->marks);
}

static ewa_status thin_voxels(job_run *run) {
    memset(run->marks, 1, point_count());
    return ewa_cloud_thin_voxels(run->cloud, 0.002, run->marks);
}

static ewa_status sample(job_run *run) {
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = point_count() / (run->mesh.texcoords ? 10 : 2);
    ewa_cloud *made = NULL;
    const ewa_status status = ewa_mesh_sample(&run->mesh, &options, &made);
    ewa_cloud_destroy(&made);
    return status;
}

static ewa_status map_texture(job_run *run) {
    const uint32_t side = is_quick() ? 64 : SIDE_PX;
    uint8_t *pixels[2] = {calloc((size_t)side * side, 4), malloc((size_t)side * side * 4)};
    if (!pixels[0] || !pixels[1]) exit(1);
    const double high = side, corners[4][2] = {{0, 0}, {0.9 * high, 0.01 * high}, {high, high}, {0.01 * high, 0.9 * high}};
    ewa_mat3 map;
    check(ewa_texture_map_from_corners(run->context, side, side, corners, &map));
    const ewa_texture_source source = {pixels[0], EWA_PIXEL_SRGB8, 4, side, side, (size_t)side * 4};
    const ewa_texture_target target = {pixels[1], EWA_PIXEL_SRGB8, 4, side, side, (size_t)side * 4};
    run->asked_s = thread_s();
    const ewa_status status = ewa_texture_map(run->context, &source, &map, NULL, &target, NULL);
    free(pixels[0]);
    free(pixels[1]);
    return status;
}

typedef struct job {
    const char *name, *text;
    void (*prepare)(job_run *run);
    ewa_status (*call)(job_run *run);
} job;

static void print_job(const job *row) {
    job_run run = {0};
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.message = tell_of_failure;
    options.progress = answer;
    options.progress_user = &run;
    check(ewa_context_create(&options, &run.context));
    row->prepare(&run);
    run.longest_s = run.asked = 0;
    const double began_s = run.asked_s = thread_s();
    check(row->call(&run));
    const double took_s = thread_s() - began_s;
    const uint32_t asked = run.asked;
    answer(&run, "end", 1);
    double back_s = 0; // from no to the return
    for (uint32_t i = 0; i < CANCELS; i++) {
        run.asked = 0;
        run.refused_at = 1 + (uint32_t)((uint64_t)(asked - 1) * i / (CANCELS - 1));
        if (row->call(&run) != EWA_CANCELLED) fprintf(stderr, "%s: went on\n", row->name);
        const double seconds = thread_s() - run.refused_s;
        if (seconds > back_s) back_s = seconds;
    }
    printf("| %s | %.2f | %u | %.3f, before \"%s\" %.3f | %.3f |\n", row->text, took_s, asked, run.longest_s, run.longest_stage,
           run.longest_fraction, back_s);
    fflush(stdout);
    ewa_cloud_destroy(&run.cloud);
    ewa_mesh_free(&run.mesh);
    free(run.marks);
    ewa_context_destroy(&run.context);
}

int main(int count, char **words) {
    static const job jobs[] = {
        {"estimate", "estimate of 10 M points", make_marks, estimate},
        {"read", "10 M points of LAZ, read", make_file, read_file},
        {"write", "the same, written", make_points, write_laz},
        {"ply", "10 M points of PLY, written", make_points, write_ply},
        {"distance", "10 M points thinned by distance", make_marks, thin_distance},
        {"voxels", "10 M points thinned by cubes", make_marks, thin_voxels},
        {"sample", "5 M points of a mesh", make_bare_square, sample},
        {"pictures", "1 M points of a mesh with a picture of 4096 x 4096", make_textured_square, sample},
        {"texture", "a picture of 8192 x 8192, mapped", make_nothing, map_texture},
    };
    printf("| | s | questions | longest without one, s | from no to the end, s |\n|---|--:|--:|--:|--:|\n");
    for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
        bool wanted = count == 1;
        for (int k = 1; k < count; k++) wanted |= strcmp(words[k], jobs[i].name) == 0;
        if (wanted) print_job(&jobs[i]);
    }
    remove("cancel.laz");
    remove("cancel.ply");
    return 0;
}
