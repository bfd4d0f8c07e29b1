// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa bench: how long each stage takes, over sizes and threads.
//
// Machines are noisy: thread counts are measured in turns (A B A B), and the lower quartile is what ratios
// are of.
#include "bench_clip.h"
#include "bench_scene.h"
#include "commands.h"
#include "inputs.h"
#include "json.h"
#include "view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct bench_arguments {
    view_arguments view; // first: it begins with the common arguments; only the size is an option here
    option_vector splats, pixels, threads;
    int64_t frames;
    int kernel, passes, shading, cpu;
    bool stages;
    const char *json_path;
} bench_arguments;

enum { ONE_PASS = 0, THREE_PASSES = 1, MAX_FRAMES = 1000, WARM_FRAMES = 2, STAGE_RUNS = 3, FRAME_STAGES = 6 };

#define AT(member) offsetof(bench_arguments, member)

static const cli_option work_table[] = {
    {.key = "splats",
     .kind = OPTION_VECTOR,
     .offset = AT(splats),
     .value = "N,...",
     .range = "[1, 4e9]",
     .low = 1,
     .high = OPTION_VECTOR_MAX,
     .help = "numbers of splats, without inputs"},
    {.key = "pixels",
     .kind = OPTION_VECTOR,
     .offset = AT(pixels),
     .value = "P,...",
     .range = "(0, 1e6]",
     .low = 1,
     .high = OPTION_VECTOR_MAX,
     .help = "pixels that a splat covers on average, without inputs"},
    {.key = "size",
     .aliases = "resolution",
     .kind = OPTION_SIZE,
     .offset = AT(view.size),
     .value = "WxH",
     .help = "pixels of the picture"},
    {.key = "kernel",
     .kind = OPTION_CHOICE,
     .offset = AT(kernel),
     .range = "perspective|affine",
     .help = "as for render"},
    {.key = "passes", .kind = OPTION_CHOICE, .offset = AT(passes), .range = "1|3", .help = "as for render"},
    {.key = "shading",
     .kind = OPTION_CHOICE,
     .offset = AT(shading),
     .range = "none|lambert",
     .help = "lambert needs normals in each pixel, none does not"},
    {.key = "stages",
     .kind = OPTION_ON_OFF,
     .offset = AT(stages),
     .help = "also time what comes before and after a frame, for the first scene: PLY, normals, surfels, "
             "PNG; and clipping"},
};

static const cli_option measure_table[] = {
    {.key = "workers",
     .kind = OPTION_VECTOR,
     .offset = AT(threads),
     .value = "N,...",
     .range = "[1, 256]",
     .low = 1,
     .high = OPTION_VECTOR_MAX,
     .absent = "1 and one per processor",
     .help = "numbers of threads to compare"},
    {.key = "frames",
     .kind = OPTION_INTEGER,
     .offset = AT(frames),
     .value = "N",
     .range = "[1, 1000]",
     .help = "frames per scene and number of threads, after two that warm up"},
    {.key = "cpu",
     .kind = OPTION_CHOICE,
     .offset = AT(cpu),
     .range = "all|avx2|plain",
     .help = "instruction sets to use, of those that the processor has"},
    {.key = "json",
     .kind = OPTION_TEXT,
     .offset = AT(json_path),
     .value = "FILE",
     .help = "also write the figures as JSON; -: only that, to standard output"},
};

static void set_defaults(void *data) {
    bench_arguments *arguments = data;
    view_set_defaults(&arguments->view);
    arguments->view.size = (option_size){1280, 1024, false};
    arguments->splats = (option_vector){{1e6, 1e7}, 2};
    arguments->pixels = (option_vector){{9, 25, 100}, 3};
    arguments->frames = 9;
    ewa_render_options render;
    ewa_render_options_init(&render, sizeof render);
    arguments->kernel = (int)render.kernel;
    arguments->passes = render.passes == 1 ? ONE_PASS : THREE_PASSES;
    arguments->shading = (int)render.shading;
    arguments->stages = true;
}

/// One number of threads: its context, what it draws with, what it measured.
typedef struct bench_lane {
    ewa_context *context;
    ewa_surfels *surfels;
    ewa_renderer *renderer;
    double total_s[MAX_FRAMES];
    ewa_render_stats last;
    double stage_s[FRAME_STAGES][MAX_FRAMES]; // thread time
} bench_lane;

static const char *const frame_stages[FRAME_STAGES] = {"bin",        "setup", "visibility",
                                                       "accumulate", "edges", "resolve"};

typedef struct bench_run {
    cli_session session;
    const bench_arguments *arguments;
    ewa_render_options render;
    uint32_t cpu_mask;
    bench_lane *lanes;
    size_t lane_count;
    uint8_t *pixels;
    FILE *text;        ///< the tables
    json_writer *json; ///< NULL: none wanted
} bench_run;

static void close_lanes(bench_run *bench) {
    for (size_t i = 0; i < bench->lane_count; i++) {
        bench_lane *lane = &bench->lanes[i];
        ewa_renderer_destroy(&lane->renderer);
        ewa_surfels_destroy(&lane->surfels);
        ewa_context_destroy(&lane->context);
    }
}

/// Copies the streams of a cloud into another context without copying the numbers.
static ewa_status borrow_cloud(ewa_context *context, const ewa_cloud *cloud, ewa_cloud **borrowed) {
    ewa_status status = ewa_cloud_create(context, ewa_cloud_point_count(cloud), borrowed);
    const ewa_attribute *attribute;
    for (uint32_t k = 0; status == EWA_OK && (attribute = ewa_cloud_attribute_at(cloud, k)); k++)
        status = ewa_cloud_borrow(*borrowed, attribute->name, attribute->type, attribute->component_count,
                                  attribute->data, attribute->stride_bytes);
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    if (status == EWA_OK) ewa_cloud_set_origin(*borrowed, origin_world);
    return status;
}

static bool open_lanes(bench_run *bench, const ewa_cloud *cloud) {
    for (size_t i = 0; i < bench->lane_count; i++) {
        bench_lane *lane = &bench->lanes[i];
        memset(lane, 0, sizeof *lane);
        lane->context =
            session_context(&bench->session, (uint32_t)bench->arguments->threads.values[i], bench->cpu_mask);
        if (!lane->context) return false;
        ewa_cloud *borrowed = NULL;
        ewa_status status = borrow_cloud(lane->context, cloud, &borrowed);
        if (status == EWA_OK) status = ewa_surfels_create(borrowed, NULL, &lane->surfels);
        if (status == EWA_OK) status = ewa_renderer_create(lane->context, &lane->renderer);
        ewa_cloud_destroy(&borrowed);
        if (status != EWA_OK) {
            session_failed(&bench->session, status);
            return false;
        }
    }
    return true;
}

static bool draw_frame(bench_run *bench, bench_lane *lane, const ewa_camera *camera, int64_t frame) {
    const ewa_frame planes = {.rgba8 = bench->pixels};
    const double started_s = clock_now_s();
    const ewa_status status =
        ewa_render(lane->renderer, lane->surfels, camera, &bench->render, &planes, &lane->last);
    const double took_s = clock_now_s() - started_s;
    if (status != EWA_OK) {
        session_failed(&bench->session, status);
        return false;
    }
    if (frame < 0) return true;
    lane->total_s[frame] = took_s;
    const ewa_render_stats *last = &lane->last;
    const double stages[FRAME_STAGES] = {last->bin_s,        last->setup_s, last->visibility_s,
                                         last->accumulate_s, last->edge_s,  last->resolve_s};
    for (int k = 0; k < FRAME_STAGES; k++) lane->stage_s[k][frame] = stages[k];
    return true;
}

static void report_frames(bench_run *bench, const char *scene, double covered_px) {
    const size_t frames = (size_t)bench->arguments->frames;
    double first_s = 0;
    for (size_t i = 0; i < bench->lane_count; i++) {
        bench_lane *lane = &bench->lanes[i];
        ewa_surfels_info info;
        ewa_surfels_describe(lane->surfels, &info);
        const bench_sample total = bench_summarise(lane->total_s, frames);
        if (i == 0) first_s = total.quartile;
        const double rate = (double)info.point_count / total.median;
        const double bytes_per_point = (double)info.resident_bytes / (double)info.point_count;
        double stages_ms[FRAME_STAGES];
        for (int k = 0; k < FRAME_STAGES; k++)
            stages_ms[k] = 1e3 * bench_summarise(lane->stage_s[k], frames).median;
        fprintf(bench->text, "%-20s %3u %8.2f %8.2f %8.1f %6.2f  %7.2f %7.2f %7.2f %7.2f %7.2f %7.2f %6.1f\n",
                scene, ewa_context_worker_count(lane->context), 1e3 * total.median, 1e3 * total.quartile,
                1e-6 * rate, first_s / total.quartile, stages_ms[0], stages_ms[1], stages_ms[2], stages_ms[3],
                stages_ms[4], stages_ms[5], bytes_per_point);
        fflush(bench->text);
        if (!bench->json) continue;
        json_object(bench->json, NULL);
        json_text(bench->json, "scene", scene);
        json_count(bench->json, "splats", info.point_count);
        if (covered_px > 0) json_number(bench->json, "covered_px", covered_px);
        json_count(bench->json, "threads", ewa_context_worker_count(lane->context));
        json_number(bench->json, "median_ms", 1e3 * total.median);
        json_number(bench->json, "lower_quartile_ms", 1e3 * total.quartile);
        json_number(bench->json, "lowest_ms", 1e3 * total.lowest);
        json_number(bench->json, "splats_per_s", rate);
        json_number(bench->json, "speedup", first_s / total.quartile);
        json_number(bench->json, "resident_bytes_per_point", bytes_per_point);
        json_count(bench->json, "splats_drawn", lane->last.drawn_count);
        json_count(bench->json, "fragment_blocks", lane->last.fragment_count);
        json_object(bench->json, "thread_ms");
        for (int k = 0; k < FRAME_STAGES; k++) json_number(bench->json, frame_stages[k], stages_ms[k]);
        json_close(bench->json, '}');
        json_close(bench->json, '}');
    }
}

/// Measures the frames of one cloud for all numbers of threads, in turns.
static bool bench_frames(bench_run *bench, const ewa_cloud *cloud, const ewa_camera *camera,
                         const char *scene, double covered_px) {
    bool done = open_lanes(bench, cloud);
    for (int64_t frame = -WARM_FRAMES; done && frame < bench->arguments->frames; frame++)
        for (size_t i = 0; done && i < bench->lane_count; i++)
            done = draw_frame(bench, &bench->lanes[i], camera, frame);
    if (done) report_frames(bench, scene, covered_px);
    close_lanes(bench);
    return done;
}

/// A stage outside the frame: what it is called, on how many bytes and points, how long.
static void report_stage(bench_run *bench, const char *stage, uint64_t point_count, uint64_t bytes,
                         double *times) {
    const bench_sample sample = bench_summarise(times, STAGE_RUNS);
    fprintf(bench->text, "%-20s %3u %8.2f %8.2f %8.1f", stage,
            ewa_context_worker_count(bench->session.context), 1e3 * sample.median, 1e3 * sample.quartile,
            1e-6 * (double)point_count / sample.median);
    if (bytes) fprintf(bench->text, "  %.2f GB/s", 1e-9 * (double)bytes / sample.median);
    fputc('\n', bench->text);
    fflush(bench->text);
    if (!bench->json) return;
    json_object(bench->json, NULL);
    json_text(bench->json, "stage", stage);
    json_count(bench->json, "threads", ewa_context_worker_count(bench->session.context));
    json_number(bench->json, "median_ms", 1e3 * sample.median);
    json_number(bench->json, "lower_quartile_ms", 1e3 * sample.quartile);
    json_count(bench->json, "items", point_count);
    if (bytes) json_count(bench->json, "bytes", bytes);
    json_close(bench->json, '}');
}

/// Files that the stages write and read, in a folder of their own.
typedef struct scratch_folder {
    char folder[256], ply[288], png[288];
} scratch_folder;

static bool scratch_open(cli_session *session, scratch_folder *scratch) {
    const char *parent = getenv("TMPDIR");
    snprintf(scratch->folder, sizeof scratch->folder, "%.200s/ewa-bench-XXXXXX",
             parent && *parent ? parent : "/tmp");
    if (!mkdtemp(scratch->folder)) {
        session_fail(session, "%s: cannot create a folder for the stages' files", scratch->folder);
        return false;
    }
    snprintf(scratch->ply, sizeof scratch->ply, "%s/cloud.ply", scratch->folder);
    snprintf(scratch->png, sizeof scratch->png, "%s/picture.png", scratch->folder);
    return true;
}

static void scratch_close(const scratch_folder *scratch) {
    remove(scratch->ply);
    remove(scratch->png);
    rmdir(scratch->folder);
}

static uint64_t cloud_bytes(const ewa_cloud *cloud) {
    uint64_t bytes = 0;
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++)
        bytes += attribute->component_count * ewa_type_bytes(attribute->type);
    return bytes * ewa_cloud_point_count(cloud);
}

/// Writing and reading the cloud, normals and radii from bare positions, surfels.
static ewa_status time_cloud_stages(bench_run *bench, const ewa_cloud *cloud, const scratch_folder *scratch) {
    double write_s[STAGE_RUNS], read_s[STAGE_RUNS], estimate_s[STAGE_RUNS], pack_s[STAGE_RUNS];
    ewa_status status = EWA_OK;
    for (int i = 0; status == EWA_OK && i < STAGE_RUNS; i++) {
        ewa_cloud *loaded = NULL;
        ewa_surfels *surfels = NULL;
        double started_s = clock_now_s();
        status = ewa_cloud_save(cloud, scratch->ply, NULL);
        write_s[i] = clock_now_s() - started_s;
        started_s = clock_now_s();
        if (status == EWA_OK) status = ewa_cloud_load(bench->session.context, scratch->ply, &loaded);
        read_s[i] = clock_now_s() - started_s;
        started_s = clock_now_s();
        if (status == EWA_OK) status = ewa_surfels_create(loaded, NULL, &surfels);
        pack_s[i] = clock_now_s() - started_s;
        ewa_surfels_destroy(&surfels);
        static const char *const estimated[] = {EWA_NORMAL, EWA_RADIUS, EWA_TANGENT_U, EWA_TANGENT_V};
        for (int k = 0; status == EWA_OK && k < 4; k++) ewa_cloud_remove(loaded, estimated[k]);
        ewa_estimate_options options;
        ewa_estimate_options_init(&options, sizeof options);
        started_s = clock_now_s();
        if (status == EWA_OK) status = ewa_cloud_estimate(&loaded, &options);
        estimate_s[i] = clock_now_s() - started_s;
        ewa_cloud_destroy(&loaded);
    }
    if (status != EWA_OK) return status;
    const uint64_t count = ewa_cloud_point_count(cloud), bytes = cloud_bytes(cloud);
    report_stage(bench, "write PLY", count, bytes, write_s);
    report_stage(bench, "read PLY", count, bytes, read_s);
    report_stage(bench, "normals and radii", count, 0, estimate_s);
    report_stage(bench, "surfels", count, 0, pack_s);
    return EWA_OK;
}

/// Writing the picture that the last frame left, with random noise instead when there is none.
static ewa_status time_png(bench_run *bench, const ewa_camera *camera, const scratch_folder *scratch) {
    double png_s[STAGE_RUNS];
    ewa_status status = EWA_OK;
    for (int i = 0; status == EWA_OK && i < STAGE_RUNS; i++) {
        const double started_s = clock_now_s();
        status = ewa_png_save(bench->session.context, scratch->png, camera->width_px, camera->height_px, 4,
                              bench->pixels, 4 * (size_t)camera->width_px);
        png_s[i] = clock_now_s() - started_s;
    }
    if (status == EWA_OK) {
        const uint64_t pixel_count = (uint64_t)camera->width_px * camera->height_px;
        report_stage(bench, "PNG (RGBA)", pixel_count, 0, png_s);
    }
    return status;
}

static ewa_status time_clipping(bench_run *bench) {
    double clip_s[STAGE_RUNS];
    const ewa_status status = bench_clip(bench->session.context, clip_s, STAGE_RUNS);
    if (status == EWA_OK) report_stage(bench, "clip segments", BENCH_CLIP_SEGMENTS, 0, clip_s);
    return status;
}

/// Times what lies before and after the frames; the last frame is in bench->pixels.
static bool bench_stages(bench_run *bench, const ewa_cloud *cloud, const ewa_camera *camera) {
    scratch_folder scratch;
    if (!scratch_open(&bench->session, &scratch)) return false;
    ewa_status status = time_cloud_stages(bench, cloud, &scratch);
    if (status == EWA_OK) status = time_png(bench, camera, &scratch);
    if (status == EWA_OK) status = time_clipping(bench);
    scratch_close(&scratch);
    if (status != EWA_OK) session_failed(&bench->session, status);
    return status == EWA_OK;
}

static bool bench_generated(bench_run *bench) {
    const bench_arguments *arguments = bench->arguments;
    bool done = true;
    for (uint32_t i = 0; done && i < arguments->splats.count; i++) {
        ewa_camera camera;
        const uint64_t point_count = (uint64_t)arguments->splats.values[i];
        ewa_cloud *cloud = bench_scene_make(&bench->session, point_count, &arguments->view.size, &camera);
        done = cloud != NULL;
        for (uint32_t k = 0; done && k < arguments->pixels.count; k++) {
            const double covered_px = arguments->pixels.values[k];
            char scene[64];
            snprintf(scene, sizeof scene, "%.4g M of %g px", 1e-6 * (double)point_count, covered_px);
            done =
                bench_scene_cover(&bench->session, cloud, &camera, bench->render.prefilter_px, covered_px) &&
                bench_frames(bench, cloud, &camera, scene, covered_px);
        }
        if (done && i == 0 && arguments->stages) done = bench_stages(bench, cloud, &camera);
        ewa_cloud_destroy(&cloud);
    }
    return done;
}

static bool bench_files(bench_run *bench) {
    const bench_arguments *arguments = bench->arguments;
    double estimate_s;
    ewa_camera camera;
    ewa_cloud *cloud = inputs_as_surfels(&bench->session, &arguments->view.common, NULL, &estimate_s);
    const char *path = arguments->view.common.operands[0], *slash = strrchr(path, '/');
    char scene[64];
    snprintf(scene, sizeof scene, "%.20s", slash ? slash + 1 : path);
    const bool done = cloud && view_make(&bench->session, &arguments->view, cloud, 1, &camera) &&
                      bench_frames(bench, cloud, &camera, scene, 0) &&
                      (!arguments->stages || bench_stages(bench, cloud, &camera));
    ewa_cloud_destroy(&cloud);
    return done;
}

static bool measure(bench_run *bench) {
    const option_size *size = &bench->arguments->view.size;
    const size_t pixel_bytes = (size_t)size->width_px * size->height_px * 4;
    bench->lanes = calloc(bench->lane_count, sizeof *bench->lanes);
    bench->pixels = malloc(pixel_bytes);
    bool done = bench->lanes && bench->pixels;
    if (!done)
        session_fail(&bench->session, "out of memory for %u x %u pixels", size->width_px, size->height_px);
    if (done) {
        fprintf(bench->text, "%-20s %3s %8s %8s %8s %6s  %7s %7s %7s %7s %7s %7s %6s\n", "", "thr", "median",
                "quartile", "M/s", "ratio", "bin", "setup", "visib.", "accum.", "edges", "resolve", "B/pt");
        fprintf(bench->text, "%-20s %3s %8s %8s %8s %6s  %47s\n", "", "", "ms", "ms", "", "",
                "ms of thread time");
        done = bench->arguments->view.common.operand_count ? bench_files(bench) : bench_generated(bench);
    }
    free(bench->lanes);
    free(bench->pixels);
    return done;
}

static int run(const void *data) {
    bench_arguments arguments = *(const bench_arguments *)data;
    static const uint32_t masks[] = {EWA_CPU_ALL, EWA_CPU_AVX2, 0};
    bench_run bench = {.arguments = &arguments, .cpu_mask = masks[arguments.cpu], .text = stdout};
    if (!session_start(&bench.session, &arguments.view.common))
        return session_end(&bench.session, EXIT_FAILED);
    if (arguments.threads.count == 0) {
        const double all = ewa_context_worker_count(bench.session.context);
        arguments.threads = (option_vector){{1, all}, all > 1 ? 2 : 1};
    }
    bench.lane_count = arguments.threads.count;
    ewa_render_options_init(&bench.render, sizeof bench.render);
    bench.render.kernel = (ewa_kernel)arguments.kernel;
    bench.render.passes = arguments.passes == ONE_PASS ? 1 : 3;
    bench.render.shading = (ewa_shading)arguments.shading;
    text_file text = {.file = NULL};
    json_writer json;
    const char *json_path = arguments.json_path;
    bool done = !json_path ||
                (output_check(&bench.session, json_path) && text_file_open(&bench.session, &text, json_path));
    if (done && json_path) {
        if (text.file == stdout) bench.text = stderr;
        bench.json = &json;
        json_start(&json, text.file);
        json_text(&json, "version", ewa_version());
        json_count(&json, "width", arguments.view.size.width_px);
        json_count(&json, "height", arguments.view.size.height_px);
        json_count(&json, "cpu_features", ewa_context_cpu_features(bench.session.context) & bench.cpu_mask);
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

static const option_group work_options = {"Work", work_table, sizeof work_table / sizeof work_table[0]};
static const option_group measure_options = {"Measurement", measure_table,
                                             sizeof measure_table / sizeof measure_table[0]};
static const option_group *const groups[] = {&work_options, &measure_options};

const cli_command bench_command = {
    .name = "bench",
    .operands = "[IN...]",
    .summary = "measure the throughput of each stage, with the scaling over sizes and threads",
    .details =
        "Without inputs: a plane seen from above that fills the picture, its discs so large that their "
        "filtered ellipses cover --pixels pixels on average. With inputs: these, framed whole. ratio: how "
        "many "
        "times faster than the first number of threads, by lower quartiles. B/pt: resident bytes per point.",
    .examples = "ewa bench\n"
                "ewa bench --splats 1e6 --pixels 9 --workers 1,2 --frames 31 --json bench.json\n"
                "ewa bench scan.ply --size 1920x1080\n",
    .high_operands = 64,
    .groups = groups,
    .group_count = sizeof groups / sizeof groups[0],
    .arguments_bytes = sizeof(bench_arguments),
    .set_defaults = set_defaults,
    .run = run,
};
