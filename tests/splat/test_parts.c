// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames in parts: several sources are one picture, in any order; what is refused, and what can be stopped.
#include "tests/splat/picture.h"

#include <math.h>
#include <pthread.h>

enum { POINTS = 6000, SIDE = 160 };

/// Where a point goes: one of the sources.
typedef int sort_point(const double position[3], uint64_t index);

static int left_or_right(const double position[3], uint64_t index) {
    (void)index;
    return position[0] > 0;
}

static int in_turn(const double position[3], uint64_t index) {
    (void)position;
    return (int)(index & 1);
}

/// One of the two parts of a cloud, with radii of its own; part `part` is of material `part`.
static ewa_surfels *make_part(ewa_context *context, const ewa_cloud *cloud, sort_point *sort, int part,
                              bool materials) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *from_position = ewa_cloud_find(cloud, EWA_POSITION),
                        *from_normal = ewa_cloud_find(cloud, EWA_NORMAL),
                        *from_radius = ewa_cloud_find(cloud, EWA_RADIUS);
    double(*kept)[7] = malloc(count * sizeof *kept);
    assert_non_null(kept);
    uint64_t here = 0;
    for (uint64_t i = 0; i < count; i++) {
        ewa_attribute_read_f64(from_position, i, 1, kept[here]);
        ewa_attribute_read_f64(from_normal, i, 1, kept[here] + 3);
        ewa_attribute_read_f64(from_radius, i, 1, kept[here] + 6);
        here += part < 0 || sort(kept[here], i) == part;
    }
    ewa_cloud *made = check_cloud_of(context, here);
    float *position = check_add(made, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(made, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(made, EWA_RADIUS, EWA_F32, 1);
    uint8_t *material = NULL;
    if (materials) assert_int_equal(ewa_cloud_add(made, EWA_MATERIAL, EWA_U8, 1, (void **)&material), EWA_OK);
    for (uint64_t i = 0; i < here; i++) {
        for (int c = 0; c < 3; c++) position[3 * i + (size_t)c] = (float)kept[i][c];
        for (int c = 0; c < 3; c++) normal[3 * i + (size_t)c] = (float)kept[i][3 + c];
        radius[i] = (float)kept[i][6];
        if (material) material[i] = (uint8_t)(part < 0 ? sort(kept[i], i) : part);
    }
    ewa_surfels *surfels = check_surfels(made, NULL);
    ewa_cloud_destroy(&made);
    free(kept);
    return surfels;
}

static void draw(ewa_renderer *renderer, const ewa_surfels *const *sources, int count, const scene *of,
                 const ewa_render_options *options, const picture *to) {
    assert_int_equal(ewa_render_begin(renderer, &of->camera, options, &to->frame), EWA_OK);
    for (int i = 0; i < count; i++) assert_int_equal(ewa_render_add(renderer, sources[i]), EWA_OK);
    ewa_render_stats stats;
    assert_int_equal(ewa_render_finish(renderer, &stats), EWA_OK);
    assert_true(stats.splat_count > 0 && stats.drawn_count > 0);
}

static double psnr(const picture *a, const picture *b) {
    double sum = 0;
    const size_t count = 4 * (size_t)a->width_px * a->height_px;
    for (size_t i = 0; i < count; i++) {
        const double d = (double)a->frame.rgba[i] - (double)b->frame.rgba[i];
        sum += d * d;
    }
    return sum > 0 ? -10 * log10(sum / (double)count) : INFINITY;
}

/// Two parts of a cloud make the picture of the whole, in either order the same.
static void hold_parts(scene_kind kind, sort_point *sort, bool materials, const ewa_render_options *options,
                       double min_db, const char *what) {
    ewa_context *context = check_context(0, NULL);
    scene of;
    assert_int_equal(scene_make(context, kind, POINTS, SIDE, SIDE, &of), EWA_OK);
    ewa_surfels *const whole = make_part(context, of.cloud, sort, -1, materials);
    ewa_surfels *part[2];
    for (int i = 0; i < 2; i++) part[i] = make_part(context, of.cloud, sort, i, materials);
    ewa_renderer *renderer = check_renderer(context);
    picture drawn[3];
    for (int i = 0; i < 3; i++) drawn[i] = picture_make(SIDE, SIDE);
    draw(renderer, (const ewa_surfels *[]){whole}, 1, &of, options, &drawn[0]);
    draw(renderer, (const ewa_surfels *[]){part[0], part[1]}, 2, &of, options, &drawn[1]);
    draw(renderer, (const ewa_surfels *[]){part[1], part[0]}, 2, &of, options, &drawn[2]);
    picture_expect_same(&drawn[1], &drawn[2]);
    const double db = psnr(&drawn[0], &drawn[1]);
    print_message("%s, %s: two sources %.1f dB from one\n", scene_name(kind), what, db);
    assert_true(db > min_db);
    for (int i = 0; i < 3; i++) picture_free(&drawn[i]);
    ewa_renderer_destroy(&renderer);
    for (int i = 0; i < 2; i++) ewa_surfels_destroy(&part[i]);
    ewa_surfels *done = whole;
    ewa_surfels_destroy(&done);
    scene_free(&of);
    ewa_context_destroy(&context);
}

TEST(test_parts_are_the_whole) {
    static const scene_kind kinds[] = {SCENE_SPHERE, SCENE_CUBE, SCENE_TORUS};
    WITH_DEFAULTS(ewa_render_options, options);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        hold_parts(kinds[i], left_or_right, false, &options, 50, "halves");
    options.kernel = EWA_KERNEL_RAYCAST;
    hold_parts(SCENE_SPHERE, left_or_right, false, &options, 50, "halves, raycast");
    options.kernel = EWA_KERNEL_PERSPECTIVE;
    options.opacity = 0.5;
    hold_parts(SCENE_SPHERE, left_or_right, false, &options, 50, "halves, transparent");
    options.opacity = 1;
    options.point_size_px = 3;
    hold_parts(SCENE_SPHERE, in_turn, false, &options, 60, "every other point, as points");
}

/// A source whose surfels all have one material beside one with another: as if each surfel had its own.
TEST(test_materials_of_sources) {
    ewa_material materials[2];
    WITH_DEFAULTS(ewa_render_options, options);
    for (int i = 0; i < 2; i++) ewa_material_init(&materials[i]);
    materials[0].ambient = 0.1, materials[0].diffuse = 0.2, materials[0].specular = 0.9;
    materials[1].ambient = 0.6, materials[1].diffuse = 0.4, materials[1].specular = 0;
    options.shading = EWA_SHADING_PHONG;
    options.materials = materials;
    options.material_count = 2;
    hold_parts(SCENE_SPHERE, left_or_right, true, &options, 50, "halves of two materials");
}

TEST_LOGGED(test_refusals, 1) {
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_SPHERE, 500, SIDE, SIDE, &of), EWA_OK);
    WITH_DEFAULTS(ewa_surfels_options, surfels_options);
    OWNED(ewa_surfels_destroy) ewa_surfels *three = NULL, *two = NULL;
    assert_int_equal(ewa_surfels_create(of.cloud, NULL, &three), EWA_OK);
    surfels_options.cutoff = 2;
    assert_int_equal(ewa_surfels_create(of.cloud, &surfels_options, &two), EWA_OK);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render_add(renderer, three), EWA_ERROR_ARGUMENT);
    assert_string_equal(log->text, "render: no frame has been begun");
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_ERROR_ARGUMENT);
    OWNED(picture_free) picture drawn = picture_make(SIDE, SIDE), other = picture_make(SIDE, SIDE);
    assert_int_equal(ewa_render_begin(NULL, &of.camera, NULL, &drawn.frame), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_begin(renderer, NULL, NULL, &drawn.frame), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_begin(renderer, &of.camera, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_begin(renderer, &of.camera, NULL, &drawn.frame), EWA_OK);
    assert_int_equal(ewa_render_add(renderer, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_add(renderer, three), EWA_OK);
    assert_int_equal(ewa_render_add(renderer, two), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "a cutoff of 2 beside others with"));
    // What was refused leaves the frame as it was.
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
    assert_int_equal(ewa_render(renderer, three, &of.camera, NULL, &other.frame, NULL), EWA_OK);
    picture_expect_same(&drawn, &other);
    // A frame ends when it is finished, and when another is begun.
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_begin(renderer, &of.camera, NULL, &drawn.frame), EWA_OK);
    assert_int_equal(ewa_render_add(renderer, three), EWA_OK);
    WITH_DEFAULTS(ewa_render_options, options);
    const float background[4] = {0.25f, 0.5f, 0.75f, 0.5f};
    memcpy(options.background, background, sizeof background);
    assert_int_equal(ewa_render_begin(renderer, &of.camera, &options, &drawn.frame), EWA_OK);
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        assert_true(isinf(drawn.frame.depth[i]) && drawn.frame.coverage[i] == 0);
        for (size_t c = 0; c < 4; c++)
            assert_true(drawn.frame.rgba[4 * i + c] == background[c] * (c < 3 ? 0.5f : 1));
    }
}

/// Says stop at a report of progress.
typedef struct stopper {
    int reports, stop_at; ///< 0: never
    double last;
    pthread_t caller;
    bool from_caller;
} stopper;

static bool on_progress(void *user, const char *stage, double fraction) {
    stopper *self = user;
    if (strcmp(stage, "render") != 0) return true;
    self->from_caller = self->from_caller && pthread_equal(pthread_self(), self->caller);
    self->from_caller = self->from_caller && fraction >= 0 && fraction <= 1;
    self->last = fraction;
    return ++self->reports != self->stop_at;
}

/// An executor of others, with one worker that never is the thread that calls.
typedef struct foreign_run {
    ewa_task *task;
    void *data;
    uint32_t count;
} foreign_run;

static void *run_foreign(void *data) {
    const foreign_run *run = data;
    for (uint32_t i = 0; i < run->count; i++) run->task(run->data, i, 0);
    return NULL;
}

static void foreign(void *user, ewa_task *task, void *data, uint32_t count) {
    (void)user;
    foreign_run run = {task, data, count};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, run_foreign, &run), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
}

static void hold_stop(uint32_t threads, bool foreign_executor) {
    stopper self = {.caller = pthread_self(), .from_caller = true};
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = threads;
    options.progress = on_progress;
    options.progress_user = &self;
    if (foreign_executor) options.executor = (ewa_executor){.worker_count = 1, .run = foreign};
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_SPHERE, POINTS, 512, 512, &of), EWA_OK);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(of.cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    OWNED(picture_free) picture first = picture_make(512, 512), other = picture_make(512, 512);
    // Of several threads the one that calls, which reports, may have got fewer tiles: then once more.
    enum { TRIES = 50 };
    for (int i = 0; i < TRIES && self.reports < 3; i++) {
        self.reports = 0;
        assert_int_equal(ewa_render(renderer, surfels, &of.camera, NULL, &first.frame, NULL), EWA_OK);
        assert_true(self.last == 1);
    }
    assert_true(self.reports >= 3);
    for (int at = 1; at <= 3; at++) {
        ewa_status status = EWA_OK;
        self.stop_at = at;
        for (int i = 0; i < TRIES && status == EWA_OK; i++) {
            self.reports = 0;
            status = ewa_render(renderer, surfels, &of.camera, NULL, &other.frame, NULL);
            assert_true(self.reports == at || status == EWA_OK);
        }
        assert_int_equal(status, EWA_CANCELLED);
    }
    // The renderer is as good as new.
    self.stop_at = 0;
    assert_int_equal(ewa_render(renderer, surfels, &of.camera, NULL, &other.frame, NULL), EWA_OK);
    picture_expect_same(&first, &other);
    assert_true(self.from_caller);
}

TEST(test_stops_between_tiles) {
    hold_stop(1, false);
    hold_stop(3, false);
    hold_stop(1, true);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
