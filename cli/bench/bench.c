// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa bench: its options. The program ewa-bench beside this one measures.
#include "cli/bench/bench.h"
#include "cli/base/backend.h"
#include "cli/base/child.h"
#include "cli/base/commands.h"
#include "cli/input/inputs.h"

#define AT(member)     offsetof(bench_arguments, member)
#define RENDER(member) OPTION_OF(ewa_render_options, AT(render), member)

static const cli_option work_table[] = {
    {"scene", OPTION_SET, AT(scenes), "NAME,...", BENCH_SCENES, .help = "scenes to make, without inputs",
     .absent = "all"},
    {"splats", OPTION_VECTOR, AT(splats), "N,...", "[1, 4e9]", .help = "numbers of splats, without inputs",
     .low = 1, .high = OPTION_VECTOR_MAX, .absent = "auto: each scene's own"},
    {"pixels", OPTION_VECTOR, AT(pixels), "P,...", "[0, 1e6]",
     .help = "pixels that a splat covers on average, without inputs; 0: as many as close the surface",
     .low = 1, .high = OPTION_VECTOR_MAX, .absent = "auto: each scene's own"},
    {"size", OPTION_SIZE, AT(view.size), "WxH", .help = "pixels of the picture", .aliases = "resolution",
     .absent = "auto: each scene's own, mostly 1280x1024"},
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
     .low = 1, .high = OPTION_VECTOR_MAX, .absent = "auto: 1 and one per processor"},
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

static int run(const void *data) {
    const bench_arguments *arguments = data;
    cli_session session = {.quiet = false};
    return child_become(&session, "bench", "ewa-bench",
                        "bench: the program ewa-bench, which measures, is not installed beside this one",
                        &arguments->view.common);
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
                "ewa bench --scene peer --stages off --against build/release/measure/measure_embree\n"
                "ewa bench scan.ply --size 1920x1080\n"
                "ewa bench --backend gl --scene peer --passes 1 --workers 1 --stages off --json gl.json\n",
    .high_operands = 64,
    .groups = (const option_group *const[]){&work_options, &cloud_input_options, &measure_options, NULL},
    .arguments_bytes = sizeof(bench_arguments),
    .set_defaults = set_defaults,
    .run = run,
};
