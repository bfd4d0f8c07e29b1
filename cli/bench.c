// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa bench: how long each stage takes, over scenes, sizes, threads and instruction sets.
#include "backend.h"
#include "bench_cover.h"
#include "bench_files.h"
#include "bench_frames.h"
#include "bench_stages.h"
#include "commands.h"
#include "inputs.h"
#include "view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bench_arguments {
    view_arguments view; // first: it begins with the common arguments; only the size is an option here
    uint32_t scenes, cpus;
    bool files;
    option_vector splats, pixels, threads;
    int64_t frames;
    ewa_render_options render;
    bool stages;
    int backend;
    const char *against, *json_path;
} bench_arguments;

#define AT(member)     offsetof(bench_arguments, member)
#define RENDER(member) OPTION_OF(ewa_render_options, AT(render), member)

static const cli_option work_table[] = {
    {"scene", OPTION_SET, AT(scenes), "NAME,...", BENCH_SCENES, .help = "scenes to make, without inputs",
     .absent = "all"},
    {"splats", OPTION_VECTOR, AT(splats), "N,...", "[1, 4e9]", .help = "numbers of splats, without inputs",
     .low = 1, .high = OPTION_VECTOR_MAX, .absent = "each scene's own"},
    {"pixels", OPTION_VECTOR, AT(pixels), "P,...", "[0, 1e6]",
     .help = "pixels that a splat covers on average, without inputs; 0: as many as close the surface",
     .low = 1, .high = OPTION_VECTOR_MAX, .absent = "each scene's own"},
    {"size", OPTION_SIZE, AT(view.size), "WxH", .help = "pixels of the picture", .aliases = "resolution",
     .absent = "each scene's own, mostly 1280x1024"},
    {"kernel", RENDER(kernel), .help = "as for render"},
    {"passes", RENDER(passes), .help = "as for render"},
    {"shading", RENDER(shading), .help = "lambert and phong need normals in each pixel, none does not"},
    {"edge-layers", RENDER(edge_layers), .help = "as for render"},
    {"level", RENDER(level), .help = "level of detail to draw, of as many as are needed for it"},
    {"stages", OPTION_ON_OFF, AT(stages),
     .help = "also time what comes before and after a frame, for the first scene: PLY, normals, surfels, "
             "PNG; and clipping"},
    {"files", OPTION_FLAG, AT(files),
     .help = "time how files of points are read and written, instead: a scan of a million points in every "
             "format that is written, or, of inputs, how they are read"},
};

static const cli_option measure_table[] = {
    {"workers", OPTION_VECTOR, AT(threads), "N,...", "[1, 256]", .help = "numbers of threads to compare",
     .low = 1, .high = OPTION_VECTOR_MAX, .absent = "1 and one per processor"},
    {"frames", OPTION_INTEGER, AT(frames), "N", "[1, 1000]",
     .help = "frames per scene and context, after two that warm up; and runs of each other stage"},
    {"cpu", OPTION_SET, AT(cpus), "SET,...", "all|avx2|plain",
     .help = "instruction sets to compare, as far as the processor has them"},
    BACKEND_OPTION(AT(backend)),
    {"against", OPTION_TEXT, AT(against), "PROGRAM",
     .help = "also have another program draw each scene, frame by frame in turns"},
    {"json", OPTION_OUTPUT, AT(json_path), "FILE",
     .help = "also write all figures as JSON; -: only that, to standard output"},
};

/// In the order of the words of --cpu.
static const bench_sets cpu_sets[BENCH_MAX_SETS] = {
    {"all", EWA_CPU_ALL}, {"avx2", EWA_CPU_AVX2}, {"plain", 0}};

static void set_defaults(void *data) {
    bench_arguments *arguments = data;
    view_set_defaults(&arguments->view);
    arguments->view.size = (option_size){1280, 1024, false};
    arguments->scenes = (1u << BENCH_SCENE_COUNT) - 1;
    arguments->cpus = 1;
    arguments->frames = 9;
    ewa_render_options_init(&arguments->render, sizeof arguments->render);
    arguments->stages = true;
}

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
    double estimate_s;
    const char *path = view->common.operands[0], *slash = strrchr(path, '/');
    bench_scene scene = {.name = slash ? slash + 1 : path};
    snprintf(scene.label, sizeof scene.label, "%.24s", scene.name);
    scene.cloud = inputs_as_surfels(&bench->session, &view->common, surfels.cutoff, &estimate_s);
    const bool done = scene.cloud && view_make(&bench->session, view, &(view_subject){.cloud = scene.cloud, .radius_scale = 1},
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

static int run(const void *data) {
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

static const option_group work_options = OPTION_GROUP("Work", work_table);
static const option_group measure_options = OPTION_GROUP("Measurement", measure_table);
const cli_command bench_command = {
    .name = "bench",
    .operands = "[IN...]",
    .summary = "measure the throughput of each stage, with the scaling over sizes and threads",
    .details =
        "With inputs: these, framed whole. Without: scenes whose discs are so large that their "
        "filtered ellipses cover --pixels pixels on average. plane: seen from above, fills the "
        "picture, all visible. color: the same without normals in the pixels. large: the same with "
        "10 million splats. hidden: three wavy sheets with 40, 30 and 30 % of the splats, in front, "
        "seen from behind, and hidden. points: a plane of discs of a quarter of a pixel. culled: one "
        "sheet shows its back, another lies beside the picture. closed: three spheres one inside "
        "another, so that half of the splats show their backs and a third are hidden. seen: as many, "
        "all on the side that is seen. phong: the plane with materials and a light from the side. "
        "peer: sphere and torus, closed. layers: the same without "
        "culling, opaque, in 3 "
        "transparent layers, in all, with 1 edge layer, without edges, without light; beside each "
        "what it is of the first. Back faces are culled in "
        "hidden, culled, closed, seen and peer. ratio: how many times faster than one thread, by "
        "lower quartiles. B/pt: resident bytes per point. Goals and the times of the best other "
        "program stand beside the figures that have them.\n\n"
        "--against starts PROGRAM CLOUD.ply CAMERA.json THREADS for each scene and number of threads. It "
        "loads both, then prints a line with its name. For each line that it reads it draws a frame and "
        "prints a line, which ends the time that bench measures; at the end of its input it ends. "
        "measure_embree, which is built where Embree is found, is such a program.",
    .examples = "ewa bench\n"
                "ewa bench --scene plane,hidden --workers 1,2 --frames 31 --json bench.json\n"
                "ewa bench --scene plane --splats 1e6 --pixels 9 --cpu all,avx2\n"
                "ewa bench --scene peer --stages off --against build/release/tests/quality/measure_embree\n"
                "ewa bench scan.ply --size 1920x1080\n"
                "ewa bench --backend gl --scene peer --passes 1 --workers 1 --stages off --json gl.json\n",
    .high_operands = 64,
    .groups = (const option_group *const[]){&work_options, &cloud_input_options, &measure_options, NULL},
    .arguments_bytes = sizeof(bench_arguments),
    .set_defaults = set_defaults,
    .run = run,
};
