// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The viewer's core: what it shows, when, and what it lets go of.
#include "check.h"
#include "view_contents.h"

#include <dirent.h>
#include <malloc.h>
#include <math.h>
#include <time.h>

enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT };

static view_contents contents;

static viewer_options make_options(bool waits) {
    memset(&contents, 0, sizeof contents);
    return (viewer_options){.services = view_contents_services(&contents),
                            .thread_count = 2,
                            .cpu_mask = EWA_CPU_ALL,
                            .width = WIDTH,
                            .height = HEIGHT,
                            .scale = 1,
                            .waits = waits};
}

static viewer *make_viewer(bool waits) {
    const viewer_options options = make_options(waits);
    viewer *v = NULL;
    assert_int_equal(viewer_create(&options, &v), EWA_OK);
    return v;
}

static double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// Shows frames until the picture is still.
static viewer_picture settle(viewer *v) {
    viewer_picture picture;
    for (int i = 0; i < 100000; i++) {
        viewer_frame(v, now_s(), &picture);
        if (picture.still && viewer_is_still(v)) return picture;
        nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
    }
    fail_msg("the picture does not come to rest");
    return picture;
}

static uint8_t *copy_picture(const viewer_picture *picture) {
    const size_t bytes = 4 * (size_t)picture->width_px * picture->height_px;
    uint8_t *copy = malloc(bytes);
    assert_non_null(copy);
    memcpy(copy, picture->rgba8, bytes);
    return copy;
}

static void handle(viewer *v, viewer_event event) {
    event.time_s = now_s();
    viewer_handle(v, &event);
}

static void drag(viewer *v, double x0, double y0, double x1, double y1) {
    handle(v, (viewer_event){.kind = VIEWER_PRESS, .x = x0, .y = y0, .button = VIEWER_LEFT, .clicks = 1});
    handle(v, (viewer_event){.kind = VIEWER_MOVE, .x = x1, .y = y1});
    handle(v, (viewer_event){.kind = VIEWER_RELEASE, .x = x1, .y = y1, .button = VIEWER_LEFT, .clicks = 1});
}

TEST(still_pictures_are_the_renderers) {
    for (int waits = 0; waits < 2; waits++) {
        viewer *v = make_viewer(waits);
        assert_true(viewer_open(v, "torus"));
        settle(v);
        drag(v, 80, 60, 110, 40);
        const viewer_picture picture = settle(v);
        ewa_camera camera;
        viewer_get_camera(v, &camera);
        // The same by the library alone.
        ewa_context *context = check_context(3, NULL);
        WITH_DEFAULTS(ewa_generate_options, object);
        object.object = EWA_OBJECT_TORUS;
        object.point_count = CONTENTS_POINTS;
        ewa_cloud *cloud = NULL;
        WITH_DEFAULTS(ewa_render_options, options);
        for (int c = 0; c < 4; c++) options.background[c] = 1;
        static uint8_t rgba8[4 * PIXELS];
        assert_int_equal(ewa_cloud_generate(context, &object, &cloud), EWA_OK);
        ewa_surfels *surfels = check_surfels(cloud, NULL);
        ewa_renderer *renderer = check_renderer(context);
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &(ewa_frame){.rgba8 = rgba8}, NULL),
                         EWA_OK);
        assert_int_equal(picture.width_px, WIDTH);
        assert_memory_equal(picture.rgba8, rgba8, sizeof rgba8);
        ewa_renderer_destroy(&renderer);
        ewa_surfels_destroy(&surfels);
        ewa_cloud_destroy(&cloud);
        ewa_context_destroy(&context);
        viewer_destroy(&v);
        ewa_context_destroy(&contents.context);
    }
}

TEST(moving_ends_in_the_same_picture) {
    viewer *v = make_viewer(false);
    viewer_do(v, "set budget_ms 1");
    assert_true(viewer_open(v, "sphere"));
    viewer_picture picture = settle(v);
    uint8_t *first = copy_picture(&picture);
    for (int i = 0; i < 20; i++) { // to and fro
        viewer_do(v, "zoom 1");
        viewer_frame(v, now_s(), &picture);
        viewer_do(v, "zoom -1");
        viewer_frame(v, now_s(), &picture);
    }
    viewer_do(v, "view reset");
    picture = settle(v);
    assert_memory_equal(picture.rgba8, first, 4 * PIXELS);
    free(first);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

/// Closes a viewer; what it loaded is given back.
static void close_viewer(viewer *v) {
    viewer_do(v, "close 0");
    settle(v);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
    assert_int_equal(contents.loads, contents.frees);
}

/// However little time there is, what moves is at least half as large as the window, of enough surfels or voxels to be told.
TEST(moving_pictures_can_be_told) {
    static const char *const names[] = {"torus", "octree", "volume"};
    for (int i = 0; i < 3; i++) {
        viewer *v = make_viewer(false);
        const uint64_t fewest = i == 2 ? 6 * 6 * 6 + 1 : 12000; // more than the third level of voxels has
        assert_true(viewer_open(v, names[i]));
        viewer_picture picture = settle(v);
        viewer_do(v, "set budget_ms 1");
        // The picture is too large for any machine.
        handle(v, (viewer_event){.kind = VIEWER_RESIZE, .x = 1200, .y = 1000, .amount = 1});
        settle(v);
        uint64_t number = 0;
        uint32_t least_px = UINT32_MAX;
        for (int drawn = 0; drawn < 40;) {
            viewer_do(v, "turn 1 0");
            for (int k = 0; k < 1000; k++) {
                viewer_frame(v, now_s(), &picture);
                if (picture.number != number) break;
                nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
            }
            number = picture.number;
            drawn++;
            if (picture.width_px < least_px) least_px = picture.width_px;
            assert_true(picture.width_px >= 600 && picture.height_px >= 500);
            assert_true(picture.splat_count >= fewest);
        }
        if (i < 2) assert_int_equal(least_px, 600); // it was too slow
        close_viewer(v);
    }
}

/// Two pictures are the same; frees them.
static void compare_pictures(uint8_t *pictures[2]) {
    assert_memory_equal(pictures[0], pictures[1], 4 * PIXELS);
    for (int i = 0; i < 2; i++) free(pictures[i]);
}

/// Of a stepped viewer: events that wait while it draws, and how often it asked.
static int waiting_count, asked_count;

static bool is_waiting(void *user) {
    (void)user;
    asked_count++;
    return waiting_count > 0 && waiting_count-- > 0;
}

/// Without threads, a frame does one thing: loads, makes the scene, draws roughly, draws the whole picture.
TEST(stepped_viewers_show_the_same) {
    static const char *const names[] = {"torus", "volume", "octree"};
    for (int k = 0; k < 3; k++) {
        uint8_t *pictures[2];
        for (int stepped = 0; stepped < 2; stepped++) {
            viewer_options options = make_options(false);
            options.services.waiting = is_waiting;
            options.stepped = stepped;
            viewer *v = NULL;
            assert_int_equal(viewer_create(&options, &v), EWA_OK);
            waiting_count = asked_count = 0;
            assert_true(viewer_open(v, names[k]));
            assert_int_equal(contents.loads, stepped ? 0 : contents.loads); // in a frame, not in the call
            settle(v);
            viewer_do(v, "turn 30 10");
            viewer_do(v, "turn -10 -5");
            viewer_picture picture = settle(v);
            if (stepped) { // a whole picture that is given up for events comes all the same
                assert_true(asked_count > 0);
                waiting_count = 3;
                viewer_do(v, "turn 5 0");
                viewer_do(v, "turn -5 0");
                picture = settle(v);
                assert_int_equal(waiting_count, 0);
            }
            pictures[stepped] = copy_picture(&picture);
            close_viewer(v);
        }
        compare_pictures(pictures);
    }
}

TEST(failing_loads_leave_the_scene) {
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "sphere"));
    viewer_picture picture = settle(v);
    uint8_t *before = copy_picture(&picture);
    handle(v, (viewer_event){.kind = VIEWER_DROP, .text = "nothing"});
    picture = settle(v);
    assert_int_equal(viewer_item_count(v), 1);
    assert_memory_equal(picture.rgba8, before, 4 * PIXELS);
    assert_string_equal(contents.message, "nothing: no such object");
    viewer_state now;
    viewer_get_state(v, &now);
    assert_string_equal(now.message, "nothing: no such object");
    assert_int_equal(contents.loads, 2);
    free(before);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
    assert_int_equal(contents.frees, 1);
}

TEST(dropped_files_queue) {
    viewer *v = make_viewer(false);
    contents.holds = true;
    handle(v, (viewer_event){.kind = VIEWER_DROP, .text = "sphere"});
    handle(v, (viewer_event){.kind = VIEWER_DROP, .text = "plane"});
    handle(v, (viewer_event){.kind = VIEWER_DROP, .text = "volume"});
    viewer_state now;
    for (int i = 0; i < 10000 && contents.loads < 1; i++)
        nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
    viewer_get_state(v, &now);
    assert_string_equal(now.loading, "sphere");
    assert_int_equal(now.queued, 2);
    assert_int_equal(contents.loads, 1);
    contents.holds = false;
    settle(v);
    assert_int_equal(viewer_item_count(v), 3);
    viewer_item item;
    assert_true(viewer_item_get(v, 0, &item));
    assert_string_equal(item.name, "sphere");
    assert_int_equal(item.count, CONTENTS_POINTS);
    assert_true(viewer_item_get(v, 2, &item));
    assert_true(item.volume);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
    assert_int_equal(contents.frees, 3);
}

TEST(cancelled_loads_come_to_nothing) {
    viewer *v = make_viewer(false);
    assert_true(viewer_open(v, "torus"));
    settle(v);
    contents.holds = true;
    viewer_open(v, "sphere");
    viewer_open(v, "plane");
    assert_int_equal(viewer_item_count(v), 3);
    for (int i = 0; i < 10000 && contents.loads < 2; i++)
        nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
    assert_true(viewer_do(v, "cancel"));
    settle(v);
    assert_int_equal(viewer_item_count(v), 1);
    assert_int_equal(contents.loads, 2); // the one that waited was never begun
    // What was to be loaded elsewhere stays where it is, and can be moved again.
    viewer_item item;
    assert_true(viewer_do(v, "move 0 1,0,0"));
    assert_true(viewer_do(v, "cancel"));
    settle(v);
    assert_true(viewer_item_get(v, 0, &item));
    assert_true(item.to_world[3] == 0);
    contents.holds = false;
    assert_true(viewer_do(v, "move 0 1,0,0"));
    settle(v);
    assert_true(viewer_item_get(v, 0, &item));
    assert_true(item.to_world[3] == 1 && item.count == CONTENTS_POINTS);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

/// What is closed or given up while it is loaded comes back by undo: what is left of the first load is no news of the second.
TEST(closed_loads_come_back) {
    static const char *const ends[] = {"close 1", "cancel"};
    for (int i = 0; i < 2; i++) {
        viewer *v = make_viewer(false);
        assert_true(viewer_open(v, "torus"));
        settle(v);
        contents.holds = true;
        assert_true(viewer_do(v, "open sphere"));
        for (int k = 0; k < 10000 && contents.loads < 2; k++)
            nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
        assert_true(viewer_do(v, ends[i]));
        assert_int_equal(viewer_item_count(v), 1);
        contents.holds = i == 0; // the first load is given up, or comes to its end
        assert_true(viewer_do(v, "undo"));
        for (int k = 0; k < 10000 && contents.loads < 3; k++)
            nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
        contents.holds = false;
        settle(v);
        assert_int_equal(viewer_item_count(v), 2);
        viewer_destroy(&v);
        ewa_context_destroy(&contents.context);
    }
}

TEST(previews_come_first) {
    viewer *v = make_viewer(false);
    contents.preview = true;
    viewer_open(v, "sphere");
    settle(v);
    viewer_item item;
    assert_true(viewer_item_get(v, 0, &item));
    assert_int_equal(item.count, CONTENTS_POINTS);
    assert_int_equal(contents.frees, 1); // the preview's
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
    assert_int_equal(contents.frees, 2);
}

TEST(picks_name_points_exactly) {
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "sphere"));
    settle(v);
    handle(v, (viewer_event){.kind = VIEWER_PRESS, .x = 80, .y = 60, .button = VIEWER_LEFT, .clicks = 1});
    handle(v, (viewer_event){.kind = VIEWER_RELEASE, .x = 80, .y = 60, .button = VIEWER_LEFT, .clicks = 1});
    unsigned long long point;
    double p[3];
    assert_int_equal(
        sscanf(contents.said, "pick sphere point %llu at %lf %lf %lf", &point, &p[0], &p[1], &p[2]), 4);
    // The pole of the view: x and z within the spacing, y in front.
    const double spacing = sqrt(4 * 3.14159265 / CONTENTS_POINTS);
    assert_true(fabs(p[0]) < spacing && fabs(p[2]) < spacing && fabs(p[1] + 1) < spacing);
    assert_non_null(strstr(contents.said, " color="));
    assert_non_null(strstr(contents.clipboard, "point "));
    // Beside the sphere there is nothing.
    contents.said[0] = 0;
    handle(v, (viewer_event){.kind = VIEWER_PRESS, .x = 3, .y = 3, .button = VIEWER_LEFT, .clicks = 1});
    handle(v, (viewer_event){.kind = VIEWER_RELEASE, .x = 3, .y = 3, .button = VIEWER_LEFT, .clicks = 1});
    assert_int_equal(contents.said[0], 0);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

TEST(picks_respect_the_box) {
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "sphere"));
    assert_true(viewer_do(v, "box -2,0,-2,2,2,2")); // the half that is behind
    settle(v);
    handle(v, (viewer_event){.kind = VIEWER_PRESS, .x = 92, .y = 76, .button = VIEWER_LEFT, .clicks = 1});
    handle(v, (viewer_event){.kind = VIEWER_RELEASE, .x = 92, .y = 76, .button = VIEWER_LEFT, .clicks = 1});
    unsigned long long point;
    double p[3];
    assert_int_equal(
        sscanf(contents.said, "pick sphere point %llu at %lf %lf %lf", &point, &p[0], &p[1], &p[2]), 4);
    assert_true(p[1] > 0.5);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

/// Beside the cut, where the nearest point of all may have been cut off.
TEST(picks_beside_the_box_are_inside) {
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "plane"));
    assert_true(viewer_do(v, "view top"));
    assert_true(viewer_do(v, "box 0,-2,-2,2,2,2"));
    settle(v);
    for (int y = 26; y < 46; y++) {
        const viewer_event press = {
            .kind = VIEWER_PRESS, .x = 80.1, .y = y, .button = VIEWER_LEFT, .clicks = 1};
        viewer_event release = press;
        release.kind = VIEWER_RELEASE;
        contents.said[0] = 0;
        handle(v, press);
        handle(v, release);
        double x;
        assert_int_equal(sscanf(contents.said, "pick plane point %*u at %lf", &x), 1);
        assert_true(x >= 0);
    }
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

TEST(cameras_are_copied) {
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "torus"));
    settle(v);
    ewa_camera first, second;
    viewer_get_camera(v, &first);
    assert_true(viewer_do(v, "camera copy"));
    assert_non_null(strstr(contents.clipboard, "world_to_camera"));
    drag(v, 80, 75, 30, 50);
    viewer_get_camera(v, &second);
    assert_memory_not_equal(first.world_to_camera, second.world_to_camera, sizeof first.world_to_camera);
    assert_true(viewer_do(v, "camera paste"));
    viewer_get_camera(v, &second);
    assert_memory_equal(first.world_to_camera, second.world_to_camera, sizeof first.world_to_camera);
    snprintf(contents.clipboard, sizeof contents.clipboard, "no camera at all");
    assert_false(viewer_do(v, "camera paste"));
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

TEST(opening_more_never_moves_the_camera) {
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "sphere"));
    settle(v);
    drag(v, 80, 60, 90, 70);
    ewa_camera before, after;
    viewer_get_camera(v, &before);
    assert_true(viewer_open(v, "plane"));
    settle(v);
    viewer_get_camera(v, &after);
    assert_memory_equal(before.world_to_camera, after.world_to_camera, sizeof before.world_to_camera);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

TEST(commands_refuse_what_is_wrong) {
    static const char *const wrong[] = {"",
                                        "nothing",
                                        "close 7",
                                        "close",
                                        "show 0 maybe",
                                        "show x on",
                                        "set",
                                        "set nothing 1",
                                        "set kernel round",
                                        "set opacity 2",
                                        "set level 1",
                                        "view inside",
                                        "mode walk",
                                        "ortho perhaps",
                                        "box 1,2,3",
                                        "box 1,1,1,0,0,0",
                                        "slab x",
                                        "slab 2,1",
                                        "color 0",
                                        "color 5 none",
                                        "color 0 x rainbow",
                                        "color 0 x viridis 1",
                                        "tint 0 2,0,0",
                                        "tint 0 red",
                                        "alpha 0 -1",
                                        "alpha 0 x",
                                        "radius 0",
                                        "zoom x",
                                        "shot 0x0",
                                        "shot 70000x1",
                                        "camera",
                                        "camera load /nowhere/at/all",
                                        "next title",
                                        "next nothing",
                                        "help maybe",
                                        "set background 2,0,0",
                                        "set background red"};
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "sphere"));
    viewer_picture picture = settle(v);
    uint8_t *before = copy_picture(&picture);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        contents.message[0] = 0;
        if (viewer_do(v, wrong[i])) fail_msg("'%s' was not refused", wrong[i]);
        if (!contents.message[0]) fail_msg("'%s' was refused without a word", wrong[i]);
    }
    picture = settle(v);
    assert_memory_equal(picture.rgba8, before, 4 * PIXELS);
    free(before);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

TEST(hostile_events_do_no_harm) {
    check_random random = {9};
    viewer *v = make_viewer(true);
    assert_true(viewer_open(v, "torus"));
    static const double odd[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 0, -5, 80, 60};
    for (int i = 0; i < 400; i++) {
        const uint64_t bits = check_random_u64(&random);
        handle(v, (viewer_event){.kind = (viewer_event_kind)(bits % (VIEWER_LEAVE + 1)),
                                 .x = odd[bits >> 8 & 7],
                                 .y = odd[bits >> 16 & 7],
                                 .amount = odd[bits >> 24 & 7],
                                 .button = (int)(bits >> 32 & 3),
                                 .clicks = (int)(bits >> 34 & 3),
                                 .modifiers = (uint32_t)(bits >> 36 & 7),
                                 .key = (int)(bits >> 40 & 127) == 'q' ? 'a' : (int)(bits >> 40 & 127),
                                 .text = bits >> 48 & 1 ? "nothing" : NULL});
        viewer_picture picture;
        if (i % 20 == 0) viewer_frame(v, now_s(), &picture);
    }
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
}

static size_t count_descriptors(void) {
    size_t count = 0;
    DIR *folder = opendir("/proc/self/fd");
    assert_non_null(folder);
    while (readdir(folder)) count++;
    closedir(folder);
    return count;
}

TEST(resizes_and_loads_leave_nothing_behind) {
    enum { RESIZES = 1000, LOADS = 100 };
    viewer *v = make_viewer(false);
    viewer_picture picture;
    size_t descriptors = 0;
    for (int i = 0; i < RESIZES; i++) {
        handle(v, (viewer_event){
                      .kind = VIEWER_RESIZE, .x = 20 + i % 97, .y = 20 + i % 61, .amount = 1 + i % 2});
        viewer_frame(v, now_s(), &picture);
    }
    for (int i = 0; i < LOADS; i++) {
        static const char *const names[] = {"sphere", "plane", "nothing", "torus", "volume"};
        viewer_open(v, names[i % 5]);
        if (i % 3 == 0) viewer_frame(v, now_s(), &picture);
        if (i % 7 == 0) viewer_do(v, "color 0 position.x");
        if (i % 2) settle(v);
        while (viewer_item_count(v) > 0) viewer_do(v, "close 0");
        if (i == 10) descriptors = count_descriptors();
    }
    settle(v);
    assert_int_equal(count_descriptors(), descriptors);
    viewer_destroy(&v);
    ewa_context_destroy(&contents.context);
    assert_true(contents.frees <= contents.loads && contents.frees >= contents.loads * 3 / 5);
}

/// What is seen of an octree gets finer until nothing is missing: then it is the picture of viewers that wait.
TEST(octrees_get_finer) {
    uint8_t *pictures[2];
    for (int waits = 0; waits < 2; waits++) {
        viewer *v = make_viewer(waits);
        assert_true(viewer_do(v, "set spacing_px 0.2"));
        assert_true(viewer_open(v, "octree"));
        settle(v);
        assert_true(viewer_do(v, "zoom 4"));
        viewer_item item;
        assert_true(viewer_item_get(v, 0, &item));
        assert_int_equal(item.count, CONTENTS_OCTREE_POINTS);
        assert_false(item.volume);
        const viewer_picture picture = settle(v);
        assert_true(picture.splat_count > 0);
        pictures[waits] = copy_picture(&picture);
        handle(v, (viewer_event){.kind = VIEWER_PRESS, .x = 80, .y = 60, .button = VIEWER_LEFT, .clicks = 1});
        handle(v,
               (viewer_event){.kind = VIEWER_RELEASE, .x = 80, .y = 60, .button = VIEWER_LEFT, .clicks = 1});
        assert_non_null(strstr(contents.said, "pick octree point at"));
        settle(v);
        // Other things beside it; colours, and some that it cannot have.
        assert_true(viewer_open(v, "sphere"));
        assert_true(viewer_do(v, "color 0 z"));
        settle(v);
        assert_true(viewer_item_get(v, 0, &item));
        assert_string_equal(item.coloring.attribute, "z");
        assert_true(item.coloring.range[1] > item.coloring.range[0]);
        assert_true(viewer_do(v, "color 0 intensity")); // which what stands for its points does not have
        settle(v);
        assert_true(viewer_item_get(v, 0, &item));
        assert_string_equal(item.coloring.attribute, "z");
        close_viewer(v);
    }
    compare_pictures(pictures);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
