// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa info: what a file holds and what is wrong with it.
#include "cli/base/backend.h"
#include "cli/base/commands.h"
#include "cli/base/json.h"
#include "cli/base/wording.h"
#include "cli/info/info_facts.h"
#include "cli/info/info_gaussians.h"
#include "cli/info/info_lod.h"
#include "cli/info/info_mesh.h"
#include "cli/info/info_scene.h"
#include "cli/info/info_volume.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/import.h"
#include "cli/input/inputs.h"
#include "cli/input/lod_input.h"
#include "cli/input/model_input.h"
#include "cli/input/point_choice.h"
#include "cli/input/scene_input.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct info_arguments {
    common_arguments common; // first
    bool json, gpu;
    volume_input_arguments volume;
} info_arguments;

enum { SPACING_SAMPLES = 1000000, BLOCK_POINTS = 256 };

/// Extent in a direction, relative to the largest, under which points count as lying in a plane or on a line.
/// Floats that are turned in space keep about seven digits.
static const double FLAT_RATIO = 1e-6;

static const cli_option volume_table[] = {VOLUME_INPUT_OPTIONS(offsetof(info_arguments, volume))};

static const cli_option table[] = {
    {"json", OPTION_FLAG, offsetof(info_arguments, json), .help = "print JSON"},
    {"gpu", OPTION_FLAG, offsetof(info_arguments, gpu),
     .help =
         "say what graphics processor --backend gl would draw with, whether it draws the same bytes as the "
         "processor, and its limits; inputs may be left out then"},
};

/// Numbers of one component of an attribute.
typedef struct component_range {
    double low, high; ///< of the finite ones; low > high when there is none
    uint64_t not_finite_count;
} component_range;

/// How many dimensions the points fill.
typedef enum point_shape { SHAPE_NOTHING, SHAPE_POINT, SHAPE_LINE, SHAPE_PLANE, SHAPE_SPACE } point_shape;

static const char *const shape_names[] = {"nothing", "point", "line", "plane", "space"};

typedef struct cloud_facts {
    uint64_t point_count, sampled_count;
    ewa_bounds bounds;
    ewa_spacing spacing;
    point_shape shape;
    ewa_cloud_invalid_points invalid;
    ewa_upright upright; ///< for a cloud with a finite point
    ewa_model_format format;
    bool is_mesh; ///< the points are vertices of:
    mesh_facts mesh;
    const ewa_lod *lod;         ///< NULL: no octree
    uint64_t lod_sampled_count; ///< the points stand for those of an octree; 0: they are all
    ewa_lod_info tree;
    gaussians_told gaussians; ///< count 0: the points are none
} cloud_facts;

static void measure_component(const ewa_attribute *attribute, uint64_t count, uint32_t component,
                              double shift, component_range *range) {
    *range = (component_range){INFINITY, -INFINITY, 0};
    double block[4 * BLOCK_POINTS];
    for (uint64_t first = 0; first < count; first += BLOCK_POINTS) {
        const uint64_t block_count = count - first < BLOCK_POINTS ? count - first : BLOCK_POINTS;
        ewa_attribute_read_f64(attribute, first, block_count, block);
        for (uint64_t i = 0; i < block_count; i++) {
            const double number = block[i * attribute->component_count + component] + shift;
            if (!isfinite(number)) {
                range->not_finite_count++;
                continue;
            }
            range->low = fmin(range->low, number);
            range->high = fmax(range->high, number);
        }
    }
}

/// Eigenvalues of a symmetric matrix, ascending, by Jacobi's rotations.
static void eigenvalues(double m[3][3], double values[3]) {
    for (int sweep = 0; sweep < 24; sweep++) {
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                if (m[p][q] == 0) continue;
                const double angle = 0.5 * atan2(2 * m[p][q], m[q][q] - m[p][p]);
                const double c = cos(angle), s = sin(angle);
                for (int k = 0; k < 3; k++) {
                    const double a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b;
                    m[k][q] = s * a + c * b;
                }
                for (int k = 0; k < 3; k++) {
                    const double a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b;
                    m[q][k] = s * a + c * b;
                }
            }
        }
    }
    for (int i = 0; i < 3; i++) values[i] = m[i][i];
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 - i; j++) {
            if (values[j] <= values[j + 1]) continue;
            const double larger = values[j];
            values[j] = values[j + 1];
            values[j + 1] = larger;
        }
    }
}

static point_shape measure_shape(const ewa_cloud *cloud, const ewa_bounds *bounds) {
    if (bounds->finite_count == 0) return SHAPE_NOTHING;
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    double origin_world[3], middle[3], scale = 0, sum[3] = {0}, products[3][3] = {{0}};
    ewa_cloud_origin(cloud, origin_world);
    for (int c = 0; c < 3; c++) {
        middle[c] = 0.5 * bounds->low_world[c] + 0.5 * bounds->high_world[c] - origin_world[c];
        scale = fmax(scale, bounds->high_world[c] - bounds->low_world[c]);
    }
    if (scale == 0) return SHAPE_POINT;
    const uint64_t count = ewa_cloud_point_count(cloud);
    for (uint64_t i = 0; i < count; i++) {
        double p[3];
        ewa_attribute_read_f64(position, i, 1, p);
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2])) continue;
        for (int c = 0; c < 3; c++) sum[c] += p[c] = (p[c] - middle[c]) / scale;
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) products[r][c] += p[r] * p[c];
    }
    const double n = (double)bounds->finite_count;
    double values[3];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) products[r][c] = products[r][c] / n - sum[r] / n * (sum[c] / n);
    eigenvalues(products, values);
    const double minimum = values[2] * FLAT_RATIO * FLAT_RATIO;
    return values[1] <= minimum ? SHAPE_LINE : values[0] <= minimum ? SHAPE_PLANE : SHAPE_SPACE;
}

/// Has the library say how what was loaded is looked at. Meshes of very many triangles are told of by their corners, which
/// are as dense as points on them.
static bool find_upright(cli_session *session, const char *path, const ewa_model *model, cloud_facts *facts) {
    enum { MANY_TRIANGLES = 500000 };
    const bool of_faces = facts->is_mesh && model->mesh.triangle_count < MANY_TRIANGLES;
    const ewa_asset_source source = {.name = ewa_lod_is_folder(session->context, path) ? "ept.json" : path,
                                     .cloud = of_faces ? NULL : model->points,
                                     .mesh = of_faces ? &model->mesh : NULL};
    ewa_asset *asset = NULL;
    ewa_status status = ewa_asset_create(session->context, &source, NULL, &asset);
    if (status == EWA_OK) status = ewa_asset_find_upright(asset, &facts->upright);
    ewa_asset_release(&asset);
    return session_passed(session, status);
}

/// Measures everything; false after reporting.
static bool gather(cli_session *session, const char *path, const ewa_model *model, const ewa_lod *lod,
                   bool sampled, cloud_facts *facts) {
    const ewa_cloud *cloud = model->points;
    *facts = (cloud_facts){.point_count = ewa_cloud_point_count(cloud),
                           .format = model->format,
                           .is_mesh = model->mesh.triangle_count > 0,
                           .lod = lod};
    if (lod) ewa_lod_describe(lod, &facts->tree);
    if (sampled) facts->lod_sampled_count = facts->point_count;
    if (facts->is_mesh && !info_mesh_gather(session, model, &facts->mesh)) return false;
    if (model->format == EWA_MODEL_PLY && gaussian_files_format(session, path) == EWA_GAUSSIANS_PLY &&
        !info_gaussians_gather(session, path, &facts->gaussians))
        return false;
    ewa_status status = ewa_cloud_measure(cloud, &facts->bounds);
    facts->sampled_count = facts->point_count < SPACING_SAMPLES ? facts->point_count : SPACING_SAMPLES;
    if (status == EWA_OK && facts->bounds.finite_count > 1)
        status = ewa_cloud_measure_spacing(cloud, SPACING_SAMPLES, &facts->spacing);
    if (!session_passed(session, status)) return false;
    facts->shape = measure_shape(cloud, &facts->bounds);
    ewa_cloud_count_invalid_points(cloud, &facts->invalid);
    if (facts->gaussians.count) facts->upright = facts->gaussians.upright;
    return facts->gaussians.count || !facts->bounds.finite_count || find_upright(session, path, model, facts);
}

enum { MAX_PROBLEMS = 16, PROBLEM_BYTES = 400 };

/// What is wrong with a cloud, in words; returns how many there are.
static size_t list_problems(const ewa_cloud *cloud, const cloud_facts *facts,
                            char problems[][PROBLEM_BYTES]) {
    size_t count = 0;
    const uint64_t not_finite = facts->point_count - facts->bounds.finite_count;
    const ewa_attribute *normal = ewa_cloud_find(cloud, EWA_NORMAL);
    if (not_finite)
        snprintf(problems[count++], PROBLEM_BYTES, "%" PRIu64 " points have coordinates that are not finite",
                 not_finite);
    if (facts->invalid.normal_count)
        snprintf(problems[count++], PROBLEM_BYTES, "%" PRIu64 " normals are zero or not finite",
                 facts->invalid.normal_count);
    if (normal && normal->component_count != 3)
        snprintf(problems[count++], PROBLEM_BYTES, "normals have %u components, not 3",
                 normal->component_count);
    if (facts->invalid.radius_count)
        snprintf(problems[count++], PROBLEM_BYTES, "%" PRIu64 " radii are zero, negative or not finite",
                 facts->invalid.radius_count);
    if (facts->invalid.axis_count)
        snprintf(problems[count++], PROBLEM_BYTES,
                 "%" PRIu64 " points have an axis that is zero or not finite", facts->invalid.axis_count);
    if (facts->invalid.color_count)
        snprintf(problems[count++], PROBLEM_BYTES, "%" PRIu64 " colours are not finite",
                 facts->invalid.color_count);
    if (facts->spacing.duplicate_count && !facts->is_mesh)
        snprintf(problems[count++], PROBLEM_BYTES,
                 "%" PRIu64 " of %" PRIu64 " points share their place with another",
                 facts->spacing.duplicate_count, facts->sampled_count);
    char degrees[EWA_DIAGNOSIS_TEXT_BYTES];
    if (!facts->is_mesh && ewa_cloud_find_degrees(cloud, degrees))
        wording_of_program(degrees, problems[count++], PROBLEM_BYTES);
    if (facts->shape == SHAPE_POINT)
        snprintf(problems[count++], PROBLEM_BYTES, "%s",
                 facts->bounds.finite_count == 1 ? "there is one point only"
                                                 : "all points are at the same place");
    if (facts->is_mesh) return count;
    if (facts->shape == SHAPE_LINE) snprintf(problems[count++], PROBLEM_BYTES, "all points lie on one line");
    if (facts->shape == SHAPE_PLANE)
        snprintf(problems[count++], PROBLEM_BYTES, "all points lie in one plane");
    return count;
}

static double shift_of(const ewa_cloud *cloud, const ewa_attribute *attribute, uint32_t component) {
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    return strcmp(attribute->name, EWA_POSITION) == 0 && component < 3 ? origin_world[component] : 0;
}

/// Prints a line of a PLY header that says more than the attributes do.
static void print_header_line(void *user, const char *line) {
    (void)user;
    if (strncmp(line, "property", 8) != 0) printf("    %s\n", line);
}

/// Whether there is a PLY header to show, which is read once more.
static bool has_header(const char *path, const cloud_facts *facts) {
    return facts->format == EWA_MODEL_PLY && strcmp(path, "-") != 0 && !import_is_named(path);
}

static const char *format_name(const char *path, const cloud_facts *facts) {
    if (facts->format == EWA_MODEL_UNKNOWN && facts->lod) return facts->tree.kind;
    return import_is_named(path) ? "imported" : ewa_model_format_name(facts->format);
}

/// How many points there are, of which those of the facts may be a sample.
static uint64_t all_points(const cloud_facts *facts) {
    return facts->lod_sampled_count ? facts->tree.point_count : facts->point_count;
}

static void print_text(cli_session *session, const char *path, const ewa_cloud *cloud,
                       const cloud_facts *facts) {
    const double *low = facts->bounds.low_world, *high = facts->bounds.high_world;
    printf("%s\n", path);
    printf("  format      %s\n", format_name(path, facts));
    if (facts->is_mesh) info_mesh_print(&facts->mesh);
    if (has_header(path, facts)) {
        printf("  header\n");
        ewa_ply_describe(session->context, path, print_header_line, NULL);
    }
    printf("  %-11s %" PRIu64 "\n", facts->is_mesh ? "vertices" : "points", all_points(facts));
    if (facts->lod) info_lod_print(facts->lod, facts->lod_sampled_count);
    if (facts->bounds.finite_count) {
        const int digits = ewa_cloud_find(cloud, EWA_POSITION)->type == EWA_F64 ? 12 : 8;
        printf("  low         %.*g %.*g %.*g\n", digits, low[0], digits, low[1], digits, low[2]);
        printf("  high        %.*g %.*g %.*g\n", digits, high[0], digits, high[1], digits, high[2]);
        printf("  extent      %.6g %.6g %.6g\n", high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    }
    info_facts_print(cloud);
    if (facts->spacing.median_world > 0)
        printf("  spacing     %.4g (5 %%: %.4g, 95 %%: %.4g)\n", facts->spacing.median_world,
               facts->spacing.low_world, facts->spacing.high_world);
    if (facts->bounds.finite_count) info_upright_print(&facts->upright);
    if (facts->gaussians.count) info_gaussians_print(&facts->gaussians);
    printf("  attributes\n");
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        printf("    %-20s %-6s", attribute->name, ewa_type_name(attribute->type));
        const int digits =
            attribute->type == EWA_F64 || attribute->type == EWA_I32 || attribute->type == EWA_U32 ? 12 : 6;
        for (uint32_t c = 0; c < attribute->component_count; c++) {
            component_range range;
            measure_component(attribute, facts->point_count, c, shift_of(cloud, attribute, c), &range);
            printf("%s ", c ? "," : "");
            if (range.low <= range.high)
                printf("%.*g .. %.*g", digits, range.low, digits, range.high);
            else
                printf("nothing finite");
            if (range.not_finite_count) printf(" (%" PRIu64 " not finite)", range.not_finite_count);
        }
        printf("\n");
    }
    class_counts classes;
    info_classes_count(cloud, &classes);
    info_classes_print(&classes);
    char problems[MAX_PROBLEMS][PROBLEM_BYTES];
    const size_t count = list_problems(cloud, facts, problems);
    printf("  problems%s\n", count ? "" : "    none");
    for (size_t i = 0; i < count; i++) printf("    %s\n", problems[i]);
}

/// Adds a line of a PLY header to a list.
static void add_header_line(void *user, const char *line) { json_text(user, NULL, line); }

static void write_attributes(json_writer *json, const ewa_cloud *cloud, uint64_t point_count) {
    json_array(json, "attributes");
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        double low[4] = {0}, high[4] = {0};
        uint64_t not_finite_count = 0;
        for (uint32_t c = 0; c < attribute->component_count; c++) {
            component_range range;
            measure_component(attribute, point_count, c, shift_of(cloud, attribute, c), &range);
            low[c] = range.low;
            high[c] = range.high;
            not_finite_count += range.not_finite_count;
        }
        json_object(json, NULL);
        json_text(json, "name", attribute->name);
        json_text(json, "type", ewa_type_name(attribute->type));
        json_count(json, "components", attribute->component_count);
        json_vector(json, "low", attribute->component_count, low);
        json_vector(json, "high", attribute->component_count, high);
        json_count(json, "not_finite", not_finite_count);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void print_json(cli_session *session, json_writer *json, const char *path, const ewa_cloud *cloud,
                       const cloud_facts *facts) {
    json_object(json, NULL);
    json_text(json, "file", path);
    json_array(json, "header");
    if (has_header(path, facts)) ewa_ply_describe(session->context, path, add_header_line, json);
    json_close(json, ']');
    json_text(json, "format", format_name(path, facts));
    if (facts->is_mesh) info_mesh_write(json, &facts->mesh);
    json_count(json, "points", all_points(facts));
    if (facts->lod) info_lod_write(json, facts->lod, facts->lod_sampled_count);
    json_count(json, "finite_points", facts->bounds.finite_count);
    if (facts->bounds.finite_count) {
        json_vector(json, "low", 3, facts->bounds.low_world);
        json_vector(json, "high", 3, facts->bounds.high_world);
    }
    info_facts_write(json, cloud);
    json_text(json, "fills", shape_names[facts->shape]);
    if (facts->bounds.finite_count) info_upright_write(json, &facts->upright);
    if (facts->gaussians.count) info_gaussians_write(json, &facts->gaussians);
    json_object(json, "spacing");
    json_number(json, "median", facts->spacing.median_world);
    json_number(json, "mean", facts->spacing.mean_world);
    json_number(json, "percentile_5", facts->spacing.low_world);
    json_number(json, "percentile_95", facts->spacing.high_world);
    json_count(json, "sampled_points", facts->sampled_count);
    json_count(json, "duplicates", facts->spacing.duplicate_count);
    json_close(json, '}');
    write_attributes(json, cloud, facts->point_count);
    class_counts classes;
    info_classes_count(cloud, &classes);
    info_classes_write(json, &classes);
    json_count(json, "zero_normals", facts->invalid.normal_count);
    json_count(json, "bad_radii", facts->invalid.radius_count);
    json_count(json, "bad_axes", facts->invalid.axis_count);
    json_count(json, "bad_colors", facts->invalid.color_count);
    char problems[MAX_PROBLEMS][PROBLEM_BYTES];
    const size_t count = list_problems(cloud, facts, problems);
    json_array(json, "problems");
    for (size_t i = 0; i < count; i++) json_text(json, NULL, problems[i]);
    json_close(json, ']');
    json_close(json, '}');
}

/// Loads a file; a filter looks at points, of which a mesh has its vertices. `sampled`: of an octree, `*lod` or NULL,
/// some of its points. False after reporting.
static bool load(cli_session *session, const char *path, bool sampled, ewa_model *model, ewa_lod **lod) {
    session->subject = path;
    if (!info_lod_open(session, path, lod)) return false;
    if (sampled) {
        if (!session_passed(session, ewa_lod_sample(*lod, EWA_OCTREE_SAMPLE_POINTS, &model->points))) return false;
        return ewa_lod_is_folder(session->context, path) ||
               ewa_model_probe(session->context, path, &model->format) == EWA_OK;
    }
    const uint32_t wanted = session->filter ? EWA_MODEL_POINTS : EWA_MODEL_POINTS | EWA_MODEL_MESH;
    if (!model_input_load(session, path, wanted, model)) return false;
    if (session->filter && model->face_count)
        session_note(session, "a mesh of %" PRIu64 " faces; --filter looks at its vertices",
                     model->face_count);
    return choose_points(session, &(point_choice){.filter = session->filter}, &model->points);
}

/// Tells of points and what is drawn of points; `json` is NULL for text.
static bool tell_points(cli_session *session, const char *path, bool sampled, json_writer *json) {
    ewa_model model = {.points = NULL};
    cloud_facts facts;
    ewa_lod *lod = NULL;
    const bool done = load(session, path, sampled, &model, &lod) &&
                      gather(session, path, &model, lod, sampled, &facts);
    if (done && json)
        print_json(session, json, path, model.points, &facts);
    else if (done)
        print_text(session, path, model.points, &facts);
    ewa_model_free(&model);
    ewa_lod_close(&lod);
    return done;
}

/// Tells of a file as what a scene would make of it.
static bool tell(cli_session *session, const info_arguments *arguments, const char *path, json_writer *json) {
    session->reported = false;
    session->subject = NULL; // messages name the file
    if (arguments->volume.dims.count) return info_volume(session, &arguments->volume, path, json);
    if (ewa_scene_file_probe(path)) return info_scene(session, path, json);
    const ewa_asset_options options = scene_input_asset_options(session);
    ewa_asset_kind kind;
    if (!session_passed(session, ewa_asset_probe(session->context, path, &options, &kind))) return false;
    if (kind == EWA_ASSET_VOLUME) return info_volume(session, &arguments->volume, path, json);
    if (kind == EWA_ASSET_GAUSSIANS && gaussian_files_format(session, path) != EWA_GAUSSIANS_PLY)
        return info_gaussians(session, path, json);
    return tell_points(session, path, kind == EWA_ASSET_OCTREE, json);
}

static int run(const void *data) {
    const info_arguments *arguments = data;
    cli_session session;
    if (!session_start(&session, &arguments->common)) return session_end(&session, EXIT_FAILED);
    json_writer json;
    if (arguments->json) json_start(&json, stdout);
    int exit_status = EXIT_DONE;
    if (arguments->gpu && !backend_print_gpu(&session, arguments->json ? &json : NULL))
        exit_status = EXIT_FAILED;
    if (arguments->json) json_array(&json, "files");
    for (size_t i = 0; i < arguments->common.operand_count; i++)
        if (!tell(&session, arguments, arguments->common.operands[i], arguments->json ? &json : NULL))
            exit_status = EXIT_FAILED;
    if (arguments->json) {
        json_close(&json, ']');
        json_end(&json);
    }
    return session_end(&session, exit_status);
}

static const option_group info_options = OPTION_GROUP("Output", table);
static const option_group volume_options = OPTION_GROUP("Raw volumes", volume_table);
static void set_defaults(void *data) { volume_input_set_defaults(&((info_arguments *)data)->volume); }

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const info_arguments *arguments = data;
    const bool asks = arguments->gpu || arguments->common.operand_count;
    return options_fine(asks ? NULL : "info: an input is missing; usage: ewa info [IN...]", message) &&
           volume_input_check(&arguments->volume, message);
}

const cli_command info_command = {
    .name = "info",
    .operands = "[IN...]",
    .summary = "say what files hold: counts, bounds, attributes with their ranges, spacing, problems",
    .details =
        "A file that has faces is a mesh: faces, area, whether it is closed, materials; then its vertices. "
        "Of an octree (COPC, EPT) the tree is told; of one with more than 4 million points, ranges and "
        "problems are those of a sample. Of Gaussians (PLY, compressed PLY, splat, SPZ, glTF, ksplat, SOG, streamed SOG) "
        "the form, sizes and opacities are told. Problems are counted, not judged: the exit status is 0 when "
        "the "
        "files could be read. Volumes "
        "are told by their suffix (.nrrd, .nhdr, .nii, .mha, .mhd, .vti, .vtk, .raw, and .gz of "
        "these) or by --dims.",
    .examples = "ewa info scan.ply\n"
                "ewa info --json *.ply > scans.json\n"
                "ewa info scan.nii.gz\n"
                "ewa info --gpu\n",
    .high_operands = 4096,
    .groups = (const option_group *const[]){&info_options, &cloud_input_options, &volume_options, NULL},
    .arguments_bytes = sizeof(info_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
