// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The program ewa-bench: what `ewa bench` measures. A program of its own, so that ewa has no code for measurements.
#include "bench/cover.h"
#include "bench/files.h"
#include "bench/frames.h"
#include "bench/stages.h"
#include "cli/base/commands.h"
#include "cli/bench/bench.h"
#include "cli/input/scene_input.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// In the order of the words of --cpu.
static const bench_sets cpu_sets[BENCH_MAX_SETS] = {
    {"all", EWA_CPU_ALL}, {"avx2", EWA_CPU_AVX2}, {"plain", 0}};

typedef struct bench_run {
    cli_session session;
    const bench_arguments *arguments;
    bench_plan plan;
    ewa_render_options render;
    bool stages_left; ///< to be measured with the next scene
    bench_sink sink;
} bench_run;

static bool measure_scene(bench_run *bench, const bench_scene *scene) {
    const uint32_t width = scene->camera.width_px, height = scene->camera.height_px;
    uint8_t *rgba8 = malloc((size_t)width * height * 4);
    if (!rgba8) {
        session_fail(&bench->session, "out of memory for %u x %u pixels", width, height);
        return false;
    }
    bool done = bench_frames(&bench->session, &bench->plan, scene, &bench->render, rgba8, &bench->sink);
    if (done && bench->stages_left)
        done = bench_stages(&bench->session, &bench->plan, scene->cloud, &scene->camera, rgba8, &bench->sink);
    bench->stages_left = false;
    free(rgba8);
    return done;
}

/// The numbers that the command line gives, or those of a recipe up to the first zero, at least one.
static option_vector given_or(const option_vector *given, const double *own) {
    if (given->count > 0) return *given;
    option_vector numbers = {{own[0]}, 1};
    for (; numbers.count < BENCH_VARIANTS && own[numbers.count] > 0; numbers.count++)
        numbers.values[numbers.count] = own[numbers.count];
    return numbers;
}

static bool measure_kind(bench_run *bench, bench_scene_kind kind) {
    const bench_arguments *arguments = bench->arguments;
    const bench_recipe *recipe = &bench_recipes[kind];
    const option_vector splats = given_or(&arguments->splats, recipe->splats);
    // Where a scene's splats have a size of their own, that is what the scene is about.
    const option_vector pixels =
        given_or(recipe->pixels[0] > 0 ? &arguments->pixels : &(option_vector){.count = 0}, recipe->pixels);
    const bool sized = arguments->view.size.given;
    for (int s = 0; s < BENCH_VARIANTS && (sized ? s == 0 : recipe->sizes[s].width_px > 0); s++) {
        const option_size *size = sized ? &arguments->view.size : &recipe->sizes[s];
        for (uint32_t i = 0; i < splats.count * pixels.count; i++) {
            bench_scene scene;
            const bool done =
                bench_scene_make(&bench->session, kind, (uint64_t)splats.values[i / pixels.count],
                                 pixels.values[i % pixels.count], size, bench->render.prefilter_px, &scene) &&
                measure_scene(bench, &scene);
            ewa_cloud_destroy(&scene.cloud);
            if (!done) return false;
        }
    }
    return true;
}

static bool measure_files(bench_run *bench) {
    const view_arguments *view = &bench->arguments->view;
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    const char *path = view->common.operands[0], *slash = strrchr(path, '/');
    bench_scene scene = {.name = slash ? slash + 1 : path};
    snprintf(scene.label, sizeof scene.label, "%.24s", scene.name);
    scene.cloud = scene_input_cloud(&bench->session, view->common.operand_count, view->common.operands, surfels.cutoff);
    const bool done =
        scene.cloud &&
        view_make(&bench->session, view, &(view_subject){.cloud = scene.cloud, .radius_scale = 1},
                  &scene.camera, NULL) &&
        measure_scene(bench, &scene);
    ewa_cloud_destroy(&scene.cloud);
    return done;
}

static bool measure(bench_run *bench) {
    bench_report_head(&bench->sink);
    const common_arguments *common = &bench->arguments->view.common;
    if (bench->arguments->files)
        return common->operand_count ? bench_files_read(&bench->session, &bench->plan, common->operands,
                                                        common->operand_count, &bench->sink)
                                     : bench_files(&bench->session, &bench->plan, &bench->sink);
    if (bench->arguments->view.common.operand_count) return measure_files(bench);
    for (int kind = 0; kind < BENCH_SCENE_COUNT; kind++)
        if (bench->arguments->scenes >> kind & 1 && !measure_kind(bench, (bench_scene_kind)kind))
            return false;
    return true;
}

static void make_plan(bench_run *bench) {
    const bench_arguments *arguments = bench->arguments;
    bench_plan *plan = &bench->plan;
    plan->frame_count = (size_t)arguments->frames;
    plan->against = arguments->against;
    plan->backend = (ewa_backend_kind)arguments->backend;
    for (; plan->thread_counts < arguments->threads.count; plan->thread_counts++)
        plan->threads[plan->thread_counts] = (uint32_t)arguments->threads.values[plan->thread_counts];
    if (plan->thread_counts == 0) {
        const uint32_t all = ewa_context_worker_count(bench->session.context);
        plan->threads[plan->thread_counts++] = 1;
        if (all > 1) plan->threads[plan->thread_counts++] = all;
    }
    for (int i = 0; i < BENCH_MAX_SETS; i++)
        if (arguments->cpus >> i & 1) plan->sets[plan->set_count++] = cpu_sets[i];
}

/// Measures what the arguments of `ewa bench` say.
static int measure_all(const void *data) {
    const bench_arguments *arguments = data;
    bench_run bench = {
        .arguments = arguments, .stages_left = arguments->stages, .sink = {.text = stdout, .json = NULL}};
    if (!session_start(&bench.session, &arguments->view.common))
        return session_end(&bench.session, EXIT_FAILED);
    make_plan(&bench);
    bench.render = arguments->render;
    text_file text = {.file = NULL};
    json_writer json;
    const char *json_path = arguments->json_path;
    bool done = !json_path || text_file_open(&bench.session, &text, json_path);
    if (done && json_path) {
        if (text.file == stdout) bench.sink.text = stderr;
        bench.sink.json = &json;
        json_start(&json, text.file);
        json_text(&json, "version", ewa_version());
        json_count(&json, "cpu_features", ewa_context_cpu_features(bench.session.context));
        json_count(&json, "processors", ewa_context_worker_count(bench.session.context));
        json_count(&json, "frames", bench.plan.frame_count);
        json_array(&json, "results");
    }
    done = done && measure(&bench);
    if (text.file) {
        json_close(&json, ']');
        json_end(&json);
        if (done)
            done = text_file_close(&bench.session, &text);
        else
            text_file_drop(&text);
    }
    return session_end(&bench.session, done ? EXIT_DONE : EXIT_FAILED);
}

int main(int argc, char **argv) {
    process_start();
    cli_command command = bench_command;
    command.run = measure_all;
    const int exit_status =
        command_run(&command, NULL, argc > 0 ? (size_t)argc - 1 : 0, (const char *const *)argv + 1);
    cli_session session = {.quiet = false};
    return output_flush(&session, exit_status);
}
