// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Every function of the library with NULL, zero, what is no number and absurd numbers in turn (write_wrong_arguments.py): none
// ends the process. Each call is one of a process of its own, so that all that do are named.
#define _XOPEN_SOURCE 700 // mkdtemp
#include "house/wrong_arguments.h"
#include "check.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { POINTS = 8, SIDE = 8, SECONDS = 20 };

right_things made;

void receive_camera(void *user, uint32_t index, const ewa_camera *camera) { (void)user, (void)index, (void)camera; }
void receive_line(void *user, const char *line) { (void)user, (void)line; }

static ewa_status swap_nothing(void *user, const ewa_parcel *given, const ewa_parcel *taken) {
    (void)user, (void)given, (void)taken;
    return EWA_OK;
}

#define MAKE(call) assert_int_equal(call, EWA_OK)

static void make_clouds(void) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.point_count = POINTS;
    options.texcoords = true;
    MAKE(ewa_cloud_generate(made.context, &options, &made.cloud));
    made.clouds[0] = made.cloud;
    made.attribute = ewa_cloud_find(made.cloud, EWA_POSITION);
    MAKE(ewa_cloud_find_scalar(made.cloud, "z", &made.scalar));
    MAKE(ewa_surfels_create(made.cloud, NULL, &made.surfels));
    MAKE(ewa_framing_create(made.cloud, 1, &made.framing));
    MAKE(ewa_cloud_save(made.cloud, "right.ply", NULL));
    MAKE(ewa_cloud_reader_open(made.context, "right.ply", NULL, &made.reader));
    MAKE(ewa_cloud_writer_open(made.context, "written.ply", NULL, made.cloud, EWA_POINTS_UNKNOWN, NULL, &made.writer));
    const ewa_asset_source source = {.cloud = made.cloud};
    MAKE(ewa_asset_create(made.context, &source, NULL, &made.asset));
    MAKE(ewa_scene_create(made.context, NULL, &made.scene));
    WITH_DEFAULTS(ewa_instance, instance);
    MAKE(ewa_scene_add(made.scene, made.asset, &instance));
    MAKE(ewa_scene_renderer_create(made.context, EWA_BACKEND_CPU, NULL, &made.scene_renderer));
    MAKE(ewa_scene_reader_create(made.context, &made.scene_reader));
    const char *const paths[] = {"right.ply"};
    MAKE(ewa_lod_build(made.context, paths, 1, "right.copc.laz", NULL, NULL));
    MAKE(ewa_lod_open(made.context, "right.copc.laz", &made.lod));
    OWNED(ewa_asset_release) ewa_asset *loaded = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *saved = NULL;
    MAKE(ewa_asset_load(made.context, "right.ply", NULL, &loaded));
    MAKE(ewa_scene_create(made.context, NULL, &saved));
    MAKE(ewa_scene_add(saved, loaded, &instance));
    MAKE(ewa_scene_save(saved, NULL, "right.json"));
    MAKE(ewa_scene_file_load(made.context, "right.json", NULL, &made.scene_file));
}

static void make_pictures(void) {
    MAKE(ewa_image_create(made.context, SIDE, SIDE, 3, &made.image));
    MAKE(ewa_environment_create(&made.image, &made.environment));
    ewa_camera_init(&made.camera);
    made.camera.width_px = made.camera.height_px = SIDE;
    MAKE(ewa_camera_set_fov(&made.camera, 50));
    const double eye[3] = {3, 2, 1}, target[3] = {0}, up[3] = {0, 0, 1};
    MAKE(ewa_camera_look_at(&made.camera, eye, target, up));
    const ewa_camera keys[2] = {made.camera, made.camera};
    MAKE(ewa_camera_path_create(made.context, keys, 2, false, &made.path));
    MAKE(ewa_renderer_create(made.context, &made.renderer));
    MAKE(ewa_warp_create(made.context, &made.warp));
    static uint8_t pixels[4 * SIDE * SIDE];
    made.frame.rgba8 = made.canvas.rgba8 = pixels;
    made.canvas.width_px = made.canvas.height_px = SIDE;
}

static void make_others(void) {
    MAKE(ewa_mesh_create(made.context, 3, 1, 1, EWA_MESH_TEXCOORDS, &made.mesh));
    made.mesh.positions[3] = made.mesh.positions[7] = 1;
    for (uint32_t v = 0; v < 3; v++) made.mesh.triangles[v] = v;
    const uint32_t dims[3] = {SIDE, SIDE, SIDE};
    MAKE(ewa_volume_create(made.context, dims, EWA_U8, &made.volume));
    for (size_t i = 0; i < (size_t)SIDE * SIDE * SIDE; i++) ((uint8_t *)made.volume.voxels)[i] = (uint8_t)(i / 2);
    MAKE(ewa_volume_measure(&made.volume, &made.facts));
    MAKE(ewa_transfer_automatic(&made.volume, &made.facts, &made.transfer));
    MAKE(ewa_voxels_create(&made.volume, &made.transfer, NULL, &made.voxels));
    MAKE(ewa_volume_renderer_create(made.context, &made.volume_renderer));
    MAKE(ewa_gaussians_create(made.context, 1, 0, &made.gaussians));
    made.gaussians.rotations[0] = 1;
    for (int c = 0; c < 3; c++) made.gaussians.scales[c] = 1;
    made.gaussians.opacities[0] = 1;
    MAKE(ewa_splats_create(&made.gaussians, false, &made.splats));
    MAKE(ewa_gaussian_renderer_create(made.context, &made.gaussian_renderer));
    const double corners[] = {0, 0, 1, 0, 0, 1};
    const uint32_t rings[] = {3};
    MAKE(ewa_polygon_create(made.context, corners, rings, 1, &made.polygon));
    made.exchange = (ewa_exchange){.rank_count = 1, .swap = swap_nothing};
    made.names[0] = "nothing.ply";
    for (size_t i = 0; i < sizeof made.numbers / sizeof *made.numbers; i++) made.numbers[i] = i % 5 == 0;
    for (size_t i = 0; i < sizeof made.vectors / sizeof *made.vectors; i++) made.vectors[i] = (double)(1 + i * i % 7);
    for (int i = 0; i < 3; i++) made.mat3.m[i][i] = 1;
    for (int i = 0; i < 4; i++) made.mat4.m[i][i] = 1;
    made.conic = (ewa_conic){.xx = 1, .yy = 1, .ww = -1};
}

/// How a call ended: NULL, or what of it is wrong.
static const char *run(const wrong_call *wrong, char text[128]) {
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL}; // which the test's own handler would take
        for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) signal(signals[i], SIG_DFL);
        const struct rlimit limit = {SECONDS, SECONDS};
        setrlimit(RLIMIT_CPU, &limit);
        wrong->call(wrong->which);
        _exit(0);
    }
    int state = 0;
    assert_true(child > 0 && waitpid(child, &state, 0) == child);
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0) return NULL;
    if (WIFSIGNALED(state))
        snprintf(text, 128, "signal %d", WTERMSIG(state));
    else
        snprintf(text, 128, "status %d", WEXITSTATUS(state));
    return text;
}

TEST(test_no_wrong_argument_ends_the_process) {
    char folder[] = "/tmp/ewa-wrong-arguments-XXXXXX";
    assert_true(mkdtemp(folder) && chdir(folder) == 0);
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1; // others would be gone in a child
    options.limits.max_memory_bytes = 1 << 30;
    MAKE(ewa_context_create(&options, &made.context));
    make_clouds();
    make_pictures();
    make_others();
    uint32_t count = 0, failed = 0;
    for (const wrong_call *wrong = wrong_calls; wrong->function; wrong++, count++) {
        char text[128];
        const char *ended = run(wrong, text);
        if (!ended) continue;
        failed++;
        print_message("%s %s: %s\n", wrong->function, wrong->what, ended);
    }
    print_message("%u calls\n", count);
    assert_true(count > 1000);
    assert_int_equal(failed, 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
