// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa convert: clouds to another file, whole or in part, moved or merged.
#include "cli/base/commands.h"
#include "cli/cloud/procedure.h"
#include "cli/convert/cloud_output.h"
#include "cli/convert/convert_gaussians.h"
#include "cli/convert/streaming.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/inputs.h"
#include "cli/input/lod_input.h"
#include "cli/input/point_choice.h"
#include "cli/input/scene_input.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct convert_arguments {
    procedure_arguments procedure; // first
    option_vector crop, sphere, transform, scale, translate;
    const char *outline;    ///< of --crop-polygon; NULL: none
    double voxel, distance; ///< world units; 0: no thinning
    double prune;           ///< 0: no Gaussians
    ewa_estimate_options estimate; ///< of which outliers count
    option_color default_color;
    double subsample;          ///< 0: all points; under 1: a share; else a count
    int refit;                 ///< REFIT_*
    ewa_refit_options options; ///< but for the goal
    ewa_gaussians_save_options gaussians;
} convert_arguments;

#define AT(member) offsetof(convert_arguments, member)

/// sRGB of points without colours beside others: as bright as the renderer's grey, linear 0.6.
static const uint8_t GREY_SRGB = 203;

/// In the order of the words of --refit-colors.
enum { REFIT_OFF, REFIT_INTERPOLATE, REFIT_FIT };

static const cli_option change_table[] = {
    {"crop", OPTION_VECTOR, AT(crop), "x0,y0,z0,x1,y1,z1", .help = "keep the points inside a box", .low = 6,
     .high = 6},
    {"crop-sphere", OPTION_VECTOR, AT(sphere), "x,y,z,radius", .help = "keep the points inside a sphere", .low = 4, .high = 4},
    {"crop-polygon", OPTION_TEXT, AT(outline), "FILE|x,y;x,y;...",
     .help =
         "keep the points inside an outline on the map, or on it: corners, or a file of WKT (POLYGON, "
         "MULTIPOLYGON), GeoJSON, or lines of x y; rings in rings, which ;; or an empty line part, are holes",
     .absent = "none"},
    {"outliers", OPTION_OF(ewa_estimate_options, AT(estimate), outlier_factor)},
    {"voxel", OPTION_NUMBER, AT(voxel), "SIZE", "(0, inf)",
     .help =
         "keep one point per voxel of that size: the one nearest to the mean of those in it, with all its "
         "attributes; voxels are aligned to the origin of the coordinates",
     .absent = "all"},
    {"min-distance", OPTION_NUMBER, AT(distance), "D", "(0, inf)",
     .help = "keep points that are at least D from each other, as many as fit: what goes is nearer than D to "
             "what stays",
     .absent = "all"},
    {"subsample", OPTION_NUMBER, AT(subsample), "N", "(0, 1e15]",
     .help = "keep N points, or a share of them when N < 1: one at random of each run of equal length in the "
             "file, the same ones every time",
     .absent = "all"},
    {"scale", OPTION_VECTOR, AT(scale), "s or x,y,z", .help = "multiply coordinates", .low = 1, .high = 3},
    {"transform", OPTION_VECTOR, AT(transform), "16 numbers",
     .help = "map by a matrix, row by row, that acts on column vectors; the last row is 0,0,0,1", .low = 16,
     .high = 16},
    {"translate", OPTION_VECTOR, AT(translate), "x,y,z", .help = "add to coordinates", .low = 3, .high = 3},
    {"default-color", OPTION_COLOR, AT(default_color), "r,g,b",
     .help = "sRGB numbers in [0, 1] for the points of files without colours, beside others that have some"},
    {"refit-colors", OPTION_CHOICE, AT(refit), NULL, "off|interpolate|fit",
     .help = "turn colours into coefficients, so that pictures of the surfels are sharper: they show each "
             "point's colour at the point, or nearly (fit: for noisy or aliased colours)"},
    {"cutoff", OPTION_OF(ewa_refit_options, AT(options), cutoff),
     .help = "standard deviations at which kernels end, as for ewa render, where colours are made"},
};

static const cli_option gaussian_table[] = {
    {"prune", OPTION_NUMBER, AT(prune), "F", "(0, inf)",
     .help = "leave out, before anything else, what floats beside a scene or is never seen: Gaussians whose mean distance to their "
             "neighbours is over the mean of all plus F standard deviations (as --outliers F), that are longer than F times what 99 % "
             "are, or fainter than 1/255",
     .absent = "none"},
    {"sh-degree", OPTION_OF(ewa_gaussians_save_options, AT(gaussians), sh_degree)},
    {"spz-version", OPTION_OF(ewa_gaussians_save_options, AT(gaussians), spz_version)},
};

static void set_defaults(void *data) {
    convert_arguments *arguments = data;
    procedure_set_defaults(&arguments->procedure);
    ewa_estimate_options_init(&arguments->estimate, sizeof arguments->estimate);
    ewa_refit_options_init(&arguments->options, sizeof arguments->options);
    ewa_gaussians_save_options_init(&arguments->gaussians, sizeof arguments->gaussians);
    arguments->procedure.output.gaussians = true;
    arguments->default_color = (option_color){{GREY_SRGB / 255.0, GREY_SRGB / 255.0, GREY_SRGB / 255.0, 1}};
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const convert_arguments *arguments = data;
    if (!procedure_check(&arguments->procedure, message)) return false;
    const char *problem = NULL;
    if (arguments->scale.count == 2)
        problem = "--scale: two numbers are neither s nor x,y,z";
    else if (arguments->sphere.count && arguments->sphere.values[3] < 0)
        problem = "--crop-sphere: the radius is below 0";
    else if (arguments->subsample > 1 && arguments->subsample != floor(arguments->subsample))
        problem = "--subsample: over 1, N has to be a whole number";
    return options_fine(problem, message);
}

/// Replaces a cloud by some of its points; false after reporting.
static bool keep(cli_session *session, ewa_cloud **cloud, const uint64_t *indices, uint64_t count) {
    ewa_cloud *selected = NULL;
    if (!session_passed(session, ewa_cloud_select(*cloud, indices, count, &selected))) return false;
    ewa_cloud_destroy(cloud);
    *cloud = selected;
    return true;
}

static uint64_t *allocate_indices(cli_session *session, uint64_t count) {
    uint64_t *indices = count > SIZE_MAX / sizeof *indices ? NULL : malloc(count * sizeof *indices);
    if (!indices) session_fail(session, "out of memory: %llu indices", (unsigned long long)count);
    return indices;
}

/// Bits that look random and depend on the number only (splitmix64 of Vigna, 2015).
static uint64_t scramble(uint64_t number) {
    uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static bool subsample(cli_session *session, ewa_cloud **cloud, double wanted) {
    const uint64_t point_count = ewa_cloud_point_count(*cloud);
    const double target = wanted < 1 ? floor(wanted * (double)point_count + 0.5) : wanted;
    if (target >= (double)point_count) return true;
    const uint64_t count = target < 1 ? 1 : (uint64_t)target;
    uint64_t *indices = allocate_indices(session, count);
    if (!indices) return false;
    for (uint64_t i = 0; i < count; i++) {
        // Run i is [floor(i n / k), floor((i + 1) n / k)), in halves so that the products stay in 64 bits.
        const uint64_t first = point_count / count * i + point_count % count * i / count;
        const uint64_t end = point_count / count * (i + 1) + point_count % count * (i + 1) / count;
        indices[i] = first + scramble(i) % (end - first);
    }
    const bool done = keep(session, cloud, indices, count);
    free(indices);
    return done;
}

enum { MAX_MAPS = 3 };

/// The maps of --scale, then --transform, then --translate; returns how many there are.
static uint32_t list_maps(const convert_arguments *arguments, double maps[MAX_MAPS][16]) {
    uint32_t count = 0;
    memset(maps, 0, MAX_MAPS * sizeof maps[0]);
    for (int m = 0; m < MAX_MAPS; m++)
        for (int c = 0; c < 4; c++) maps[m][5 * c] = 1;
    if (arguments->scale.count) {
        const double *s = arguments->scale.values;
        for (int c = 0; c < 3; c++) maps[count][5 * c] = s[arguments->scale.count == 3 ? c : 0];
        count++;
    }
    if (arguments->transform.count) memcpy(maps[count++], arguments->transform.values, sizeof maps[0]);
    if (arguments->translate.count) {
        for (int c = 0; c < 3; c++) maps[count][4 * c + 3] = arguments->translate.values[c];
        count++;
    }
    return count;
}

static bool move(cli_session *session, ewa_cloud *cloud, const convert_arguments *arguments) {
    double maps[MAX_MAPS][16];
    const uint32_t count = list_maps(arguments, maps);
    ewa_status status = EWA_OK;
    for (uint32_t m = 0; m < count && status == EWA_OK; m++) status = ewa_cloud_transform(cloud, maps[m]);
    return session_passed(session, status);
}

/// Estimates normals and radii that the cloud lacks for new colours; returns false after reporting.
static bool complete(cli_session *session, ewa_cloud **cloud, const convert_arguments *arguments) {
    const bool wanted = arguments->refit != REFIT_OFF ||
                        (arguments->procedure.procedure && arguments->procedure.options.prefilter > 0);
    if (!wanted || ewa_cloud_is_drawable(*cloud)) return true;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    options.cutoff = arguments->options.cutoff;
    return session_passed(session, ewa_cloud_estimate(cloud, &options));
}

/// Turns colours into coefficients.
static bool refit(cli_session *session, ewa_cloud *cloud, const convert_arguments *arguments) {
    const double started_s = clock_now_s();
    ewa_refit_options options = arguments->options;
    options.goal = arguments->refit == REFIT_FIT ? EWA_REFIT_FIT : EWA_REFIT_INTERPOLATE;
    ewa_refit_report report;
    const ewa_status status = ewa_cloud_refit_colors(cloud, &options, &report);
    if (status != EWA_OK)
        session_failed(session, status);
    else
        session_say(
            session,
            "colours refitted in %.3f s, %u steps: error at the points %.4f -> %.4f, coefficients %.3g "
            "to %.3g",
            clock_now_s() - started_s, report.iteration_count, report.before_rms, report.after_rms,
            (double)report.low, (double)report.high);
    return status == EWA_OK;
}

/// Frees elements that the result cannot have, and says what is lost.
static void drop_elements(cli_session *session, ewa_elements **elements, const char *why) {
    const uint64_t count = ewa_elements_face_count(*elements);
    if (count) session_note(session, "%llu faces are dropped: %s", (unsigned long long)count, why);
    ewa_elements_free(elements);
}

/// What is done, with what was made of its options.
typedef struct convert_job {
    const convert_arguments *arguments;
    ewa_polygon *polygon;
} convert_job;

/// Whether parts of space are chosen.
static bool cuts(const convert_job *job) {
    return job->arguments->crop.count || job->arguments->sphere.count || job->polygon;
}

/// What --filter, where it is not done yet, --crop, --crop-sphere and --crop-polygon choose.
static point_choice choose_parts(const cli_session *session, const convert_job *job) {
    const convert_arguments *arguments = job->arguments;
    const bool one = arguments->procedure.output.common.operand_count == 1;
    return (point_choice){.filter = one ? session->filter : NULL,
                          .corners_world = arguments->crop.count ? arguments->crop.values : NULL,
                          .sphere_world = arguments->sphere.count ? arguments->sphere.values : NULL,
                          .polygon = job->polygon};
}

/// What can be done to a part of a cloud as to the whole.
static bool change_piece(cli_session *session, const void *data, ewa_cloud **cloud) {
    const convert_job *job = data;
    const point_choice choice = choose_parts(session, job);
    return choose_points(session, &choice, cloud) && move(session, *cloud, job->arguments);
}

/// Whether only such things are to be done.
static bool is_piecewise(const convert_arguments *arguments) {
    return arguments->procedure.output.common.operand_count == 1 && arguments->subsample == 0 &&
           arguments->estimate.outlier_factor == 0 && arguments->voxel == 0 && arguments->distance == 0 && arguments->refit == REFIT_OFF &&
           !arguments->procedure.procedure;
}

static bool has_points(cli_session *session, const ewa_cloud *cloud) {
    if (ewa_cloud_point_count(cloud)) return true;
    session_fail(session, "none of the points is left");
    return false;
}

/// Leaves the points that all options together choose. False after reporting.
static bool choose(cli_session *session, const void *data, ewa_cloud **cloud) {
    const convert_job *job = data;
    point_choice choice = choose_parts(session, job);
    if (job->arguments->estimate.outlier_factor > 0) choice.outliers = &job->arguments->estimate;
    choice.voxel_world = job->arguments->voxel;
    choice.distance_world = job->arguments->distance;
    return choose_points(session, &choice, cloud) && has_points(session, *cloud) &&
           (job->arguments->subsample == 0 || subsample(session, cloud, job->arguments->subsample));
}

/// Whether only the nodes of an octree that meet a box, which is set, are to be read.
static bool is_part_of_octree(cli_session *session, const convert_job *job, double corners_world[6]) {
    const common_arguments *common = &job->arguments->procedure.output.common;
    if (common->operand_count != 1 || !cuts(job) || session->load.keep_going) return false;
    for (int c = 0; c < 6; c++) corners_world[c] = c < 3 ? -DBL_MAX : DBL_MAX;
    if (job->polygon) {
        double box_world[4];
        ewa_polygon_box(job->polygon, box_world);
        corners_world[0] = box_world[0], corners_world[1] = box_world[1];
        corners_world[3] = box_world[2], corners_world[4] = box_world[3];
    }
    const double *crop = job->arguments->crop.values, *sphere = job->arguments->sphere.values;
    for (int c = 0; c < 3 && job->arguments->crop.count; c++) {
        corners_world[c] = fmax(corners_world[c], fmin(crop[c], crop[3 + c]));
        corners_world[3 + c] = fmin(corners_world[3 + c], fmax(crop[c], crop[3 + c]));
    }
    for (int c = 0; c < 3 && job->arguments->sphere.count; c++) {
        corners_world[c] = fmax(corners_world[c], sphere[c] - sphere[3]);
        corners_world[3 + c] = fmin(corners_world[3 + c], sphere[c] + sphere[3]);
    }
    return lod_input_serves(session, common->operands[0], corners_world);
}

/// Loads the operands; one alone keeps its faces. NULL after reporting.
static ewa_cloud *load(cli_session *session, const convert_job *job, ewa_elements **elements) {
    const convert_arguments *arguments = job->arguments;
    const common_arguments *common = &arguments->procedure.output.common;
    *elements = NULL;
    double corners_world[6];
    if (is_part_of_octree(session, job, corners_world))
        return lod_input_read(session, common->operands[0], corners_world);
    if (common->operand_count == 1 && ewa_scene_file_probe(common->operands[0]))
        return scene_input_points(session, common->operands[0]);
    return common->operand_count == 1 ? input_load_elements(session, common->operands[0], elements)
                                      : inputs_merge(session, common, arguments->default_color.rgba);
}

static ewa_cloud *make(cli_session *session, const convert_job *job, ewa_elements **elements) {
    const convert_arguments *arguments = job->arguments;
    ewa_cloud *cloud = load(session, job, elements);
    const uint64_t loaded_count = cloud ? ewa_cloud_point_count(cloud) : 0;
    if (arguments->procedure.output.common.operand_count > 1) session->subject = NULL;
    const bool done = cloud && choose(session, job, &cloud) && move(session, cloud, arguments) &&
                      complete(session, &cloud, arguments) &&
                      procedure_apply(session, &arguments->procedure, arguments->options.cutoff, cloud) &&
                      (arguments->refit == REFIT_OFF || refit(session, cloud, arguments));
    if (!done) ewa_cloud_destroy(&cloud);
    if (cloud && ewa_cloud_point_count(cloud) != loaded_count)
        drop_elements(session, elements, "some of their vertices are left out");
    if (!cloud_output_has_faces(&arguments->procedure.output))
        drop_elements(session, elements, "only PLY is written with faces");
    return cloud;
}

/// Whether a file is read and written as Gaussians, not as points with numbers: where only these are written, where
/// points do not say what is read, and where more than centres moves.
static bool is_of_gaussians(cli_session *session, const convert_arguments *arguments) {
    const output_arguments *output = &arguments->procedure.output;
    if (convert_gaussians_is_named(output->path) || arguments->prune > 0) return true;
    if (output->common.operand_count != 1 || ewa_gaussians_format_of(output->path) != EWA_GAUSSIANS_PLY)
        return false;
    if (scene_input_is_of_gaussians(session, output->common.operands[0])) return true;
    const ewa_gaussian_format format = gaussian_files_format(session, output->common.operands[0]);
    return format > EWA_GAUSSIANS_PLY ||
           (format == EWA_GAUSSIANS_PLY && (arguments->scale.count || arguments->transform.count));
}

/// Converts Gaussians, which are chosen and moved like points, but keep their numbers. False after reporting.
static bool convert_set(cli_session *session, const convert_job *job) {
    const convert_arguments *arguments = job->arguments;
    const output_arguments *output = &arguments->procedure.output;
    const struct {
        const char *name;
        bool given;
    } others[] = {{"refit-colors", arguments->refit != REFIT_OFF},
                  {"procedure", arguments->procedure.procedure},
                  {"ascii", output->ascii},
                  {"big-endian", output->big_endian}};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (others[i].given) {
            session_fail(session,
                         "--%s: Gaussians are not changed that way; --filter, --crop, --crop-sphere, --crop-polygon, --outliers, --voxel, "
                         "--min-distance, --subsample and --prune choose some, --scale, --transform and --translate move them",
                         others[i].name);
            return false;
        }
    if (output->common.operand_count != 1) {
        session_fail(session, "Gaussians of several files are not merged");
        return false;
    }
    double maps[MAX_MAPS][16];
    const uint32_t count = list_maps(arguments, maps);
    const bool some = cuts(job) || session->filter || arguments->estimate.outlier_factor > 0 ||
                      arguments->voxel > 0 || arguments->distance > 0 || arguments->subsample > 0;
    return convert_gaussians(session, output->common.operands[0], output->path, &arguments->gaussians,
                             arguments->prune, some ? choose : NULL, job, (const double(*)[16])maps, count);
}

/// Reads, changes and writes, a file alone piece by piece where that can be. False after reporting.
static bool convert(cli_session *session, const convert_job *job) {
    const output_arguments *output = &job->arguments->procedure.output;
    double corners_world[6];
    if (is_piecewise(job->arguments) && !is_part_of_octree(session, job, corners_world)) {
        const bool keeps_count = !cuts(job) && !session->filter;
        const streaming_result result =
            streaming_run(session, output->common.operands[0], output, job, change_piece, keeps_count);
        if (result != STREAMING_IMPOSSIBLE) return result == STREAMING_DONE;
    }
    ewa_elements *elements = NULL;
    ewa_cloud *cloud = make(session, job, &elements);
    const bool done = cloud && cloud_output_save(session, output, cloud, elements);
    ewa_elements_free(&elements);
    ewa_cloud_destroy(&cloud);
    return done;
}

static int run(const void *data) {
    const convert_arguments *arguments = data;
    cli_session session;
    if (!session_start(&session, &arguments->procedure.output.common))
        return session_end(&session, EXIT_FAILED);
    convert_job job = {.arguments = arguments};
    if (arguments->outline) job.polygon = choose_outline(&session, arguments->outline);
    bool done = !arguments->outline || job.polygon;
    if (done) done = is_of_gaussians(&session, arguments) ? convert_set(&session, &job) : convert(&session, &job);
    ewa_polygon_destroy(&job.polygon);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static const option_group change_options = OPTION_GROUP("Changes, in this order", change_table);
static const option_group gaussian_options = OPTION_GROUP("Files of Gaussians", gaussian_table);
const cli_command convert_command = {
    .name = "convert",
    .operands = "IN... -o OUT",
    .summary = "write clouds to another file: another encoding, a part, moved, several as one",
    .details =
        "All attributes are kept with their types. A scene file gives the points that it shows, or, where it shows nothing else, its Gaussians. Of several inputs, attributes that only some have are "
        "NaN, "
        "in whole numbers 0, for the points of the others, which a warning says; normals, radii and axes are "
        "kept only where all have them. Of one mesh the faces are kept, of PLY all else too; they are "
        "dropped, which a message says, when some of their vertices are left out. Normals, radii and axes "
        "follow --scale and --transform. Moved clouds are "
        "written with double coordinates. Gaussians become others by the suffix (.ply, .compressed.ply, .splat, .spz, .glb, .sog, meta.json; lod-meta.json with levels), and "
        "move "
        "with their axes and colours; points with the columns of 3DGS that go to PLY keep every bit.",
    .examples = "ewa convert scan.ply -o scan_text.ply --ascii\n"
                "ewa convert a.ply b.ply -o both.ply --subsample 1000000\n"
                "ewa convert scan.laz -o ground.laz --filter classification=ground --min-distance 0.5\n"
                "ewa convert scan.las -o plot.las --crop-polygon plot.geojson --voxel 0.1\n"
                "ewa convert scan.ply -o sharp.ply --refit-colors fit\n"
                "ewa convert scene.ply -o scene.spz\n"
                "ewa convert mm.ply -o m.ply --scale 0.001 --crop -1,-1,0,1,1,2\n",
    .low_operands = 1,
    .high_operands = 4096,
    .groups = (const option_group *const[]){&cloud_output_options, &cloud_input_options, &change_options,
                                            &procedure_options, &gaussian_options, NULL},
    .arguments_bytes = sizeof(convert_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
