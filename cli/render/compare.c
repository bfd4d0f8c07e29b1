// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa compare: a scene beside the photographs of it.
#include "cli/base/commands.h"
#include "cli/base/json.h"
#include "cli/base/outputs.h"
#include "cli/input/inputs.h"
#include "cli/input/photo_input.h"
#include "cli/input/scene_input.h"
#include "cli/render/compare_sheet.h"
#include "cli/render/gaussians.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct compare_arguments {
    common_arguments common; // first
    photo_arguments photos;
    const char *sheet_path, *json_path;
    int64_t every, worst;
    ewa_gaussian_options gaussians;
    option_color background;
} compare_arguments;

#define AT(member) offsetof(compare_arguments, member)

static const cli_option compare_table[] = {
    PHOTO_OPTIONS(AT(photos)),
    {"every", OPTION_INTEGER, AT(every), "N", "[1, 65535]",
     .help = "compare photographs 0, N, 2N, ... of the file; 8 are those that 3DGS keeps for its tests, where the file "
             "is ordered by names"},
    {"output", OPTION_OUTPUT, AT(sheet_path), "FILE.png",
     .help = "write a sheet of those that differ most: photograph, picture, four times the difference", .letter = 'o'},
    {"worst", OPTION_INTEGER, AT(worst), "N", "[1, 64]", .help = "how many are on the sheet"},
    {"json", OPTION_OUTPUT, AT(json_path), "FILE.json", .help = "write the table as JSON; -: in place of the table"},
};

static const cli_option gaussian_table[] = {GAUSSIAN_OPTIONS(AT(gaussians))};

static const cli_option look_table[] = {
    {"background", OPTION_COLOR, AT(background), "r,g,b", .help = OPTION_COLOR_HELP ", of pictures and of what is "
     "transparent in photographs; opaque"},
};

static void set_defaults(void *data) {
    compare_arguments *arguments = data;
    arguments->every = 1, arguments->worst = 4;
    gaussians_set_defaults(&arguments->gaussians);
    arguments->background = (option_color){{0, 0, 0, 1}};
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const compare_arguments *arguments = data;
    const char *wrong = arguments->background.rgba[3] < 1 ? "--background of compare is opaque" : NULL;
    return photo_input_check(&arguments->photos, "compare", message) && options_fine(wrong, message) &&
           (!arguments->sheet_path || output_check_suffix("output", arguments->sheet_path, ".png|.jpg|.jpeg", message));
}

/// What one photograph came to.
typedef struct compared {
    const ewa_photo *photo;
    ewa_image_quality quality;
} compared;

static const char *name_of(const ewa_photo *photo) {
    const char *slash = strrchr(photo->path, '/');
    return slash ? slash + 1 : photo->path;
}

/// Means over photographs, as papers have them; NaN: none has a pixel that could be compared.
static void find_means(const compared *all, size_t count, double *psnr_db, double *ssim) {
    size_t used = 0;
    *psnr_db = *ssim = 0;
    for (size_t i = 0; i < count; i++) {
        if (!all[i].quality.pixel_count) continue;
        *psnr_db += all[i].quality.psnr_db, *ssim += all[i].quality.ssim;
        used++;
    }
    *psnr_db = used ? *psnr_db / (double)used : NAN, *ssim = used ? *ssim / (double)used : NAN;
}

static void print_table(const compared *all, size_t count) {
    double psnr_db, ssim;
    int width = 10;
    for (size_t i = 0; i < count; i++)
        if ((int)strlen(name_of(all[i].photo)) > width) width = (int)strlen(name_of(all[i].photo));
    printf("%-*s %11s %9s %8s\n", width, "photograph", "pixels", "PSNR, dB", "SSIM");
    for (size_t i = 0; i < count; i++)
        printf("%-*s %5u x %-4u%8.2f %9.4f\n", width, name_of(all[i].photo), all[i].photo->camera.width_px,
               all[i].photo->camera.height_px, all[i].quality.psnr_db, all[i].quality.ssim);
    find_means(all, count, &psnr_db, &ssim);
    printf("%-*s %11s %9.2f %9.4f\n", width, "mean", "", psnr_db, ssim);
}

/// Writes the table as JSON; false after reporting.
static bool write_json(cli_session *session, const char *path, const compared *all, size_t count) {
    text_file text;
    double psnr_db, ssim;
    if (!text_file_open(session, &text, path)) return false;
    json_writer json;
    json_start(&json, text.file);
    find_means(all, count, &psnr_db, &ssim);
    json_number(&json, "mean_psnr_db", psnr_db);
    json_number(&json, "mean_ssim", ssim);
    json_array(&json, "photographs");
    for (size_t i = 0; i < count; i++) {
        json_object(&json, NULL);
        json_text(&json, "path", all[i].photo->path);
        json_count(&json, "width_px", all[i].photo->camera.width_px);
        json_count(&json, "height_px", all[i].photo->camera.height_px);
        json_count(&json, "pixel_count", all[i].quality.pixel_count);
        json_number(&json, "psnr_db", all[i].quality.psnr_db);
        json_number(&json, "ssim", all[i].quality.ssim);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_end(&json);
    return text_file_close(session, &text);
}

/// Draws and compares; false after reporting.
static bool compare_all(cli_session *session, ewa_scene *scene, compared *all, size_t count, compare_sheet *sheet) {
    ewa_scene_renderer *renderer = NULL;
    bool done =
        session_passed(session, ewa_scene_renderer_create(session->context, EWA_BACKEND_CPU, NULL, &renderer));
    for (size_t i = 0; i < count && done; i++) {
        ewa_photo_comparison found;
        done = session_passed(session, ewa_scene_compare_photo(scene, renderer, all[i].photo, NULL, &found));
        if (!done) break;
        all[i].quality = found.quality;
        if (!found.quality.pixel_count)
            session_warn(session, "%s: has no pixel that could be compared", all[i].photo->path);
        done = compare_sheet_add(session, sheet, name_of(all[i].photo), &found);
        ewa_image_free(&found.photo);
        ewa_image_free(&found.picture);
        done = done && session_step(session, "photograph", i + 1, count);
    }
    ewa_scene_renderer_destroy(&renderer);
    return done;
}

/// The scene of the operands; NULL after reporting.
static ewa_scene *make_scene(cli_session *session, const compare_arguments *arguments) {
    const common_arguments *common = &arguments->common;
    ewa_scene_options options;
    ewa_scene *scene = NULL;
    ewa_coloring coloring;
    ewa_scene_options_init(&options, sizeof options);
    options.gaussians = arguments->gaussians;
    options.render.shading = EWA_SHADING_NONE; // photographs have their light
    option_color_linear(&arguments->background, options.render.background);
    ewa_coloring_init(&coloring, sizeof coloring);
    ewa_asset_options assets = scene_input_asset_options(session);
    assets.gaussian_levels = options.gaussians.merge_px > 0;
    if (session_passed(session, ewa_scene_create(session->context, &options, &scene)) &&
        scene_input_add(session, common->operand_count, common->operands, &assets, &coloring, scene))
        return scene;
    ewa_scene_destroy(&scene);
    return NULL;
}

/// With the photographs known; false after reporting.
static bool compare_listed(cli_session *session, const compare_arguments *arguments, const ewa_photo *photos,
                           uint32_t photo_count) {
    const size_t every = (size_t)arguments->every, count = (photo_count + every - 1) / every;
    compared *all = calloc(count ? count : 1, sizeof *all);
    if (!all) {
        session_fail(session, "out of memory for %u photographs", photo_count);
        return false;
    }
    for (size_t i = 0; i < count; i++) all[i].photo = &photos[every * i];
    compare_sheet sheet = {.limit = arguments->sheet_path ? (uint32_t)arguments->worst : 0};
    ewa_scene *scene = make_scene(session, arguments);
    bool done = scene && compare_all(session, scene, all, count, &sheet);
    done = done && (!arguments->sheet_path || compare_sheet_save(session, &sheet, arguments->sheet_path)) &&
           (!arguments->json_path || write_json(session, arguments->json_path, all, count));
    if (done && !(arguments->json_path && strcmp(arguments->json_path, "-") == 0)) print_table(all, count);
    compare_sheet_free(&sheet);
    ewa_scene_destroy(&scene);
    free(all);
    return done;
}

static int run(const void *data) {
    const compare_arguments *arguments = data;
    cli_session session;
    if (!session_start(&session, &arguments->common)) return session_end(&session, EXIT_FAILED);
    uint32_t count = 0;
    ewa_photo_list *list = photo_input_load(&session, &arguments->photos);
    const ewa_photo *photos = list ? ewa_photo_list_photos(list, &count) : NULL;
    const bool done = list && compare_listed(&session, arguments, photos, count);
    ewa_photo_list_destroy(&list);
    return session_end(&session, output_flush(&session, done ? EXIT_DONE : EXIT_FAILED));
}

static const option_group compare_options = OPTION_GROUP("Photographs", compare_table);
static const option_group gaussian_options = OPTION_GROUP("Gaussians", gaussian_table);
static const option_group look_options = OPTION_GROUP("Look", look_table);
const cli_command compare_command = {
    .name = "compare",
    .operands = "IN... --cameras PATH",
    .summary = "draw what photographs show, and say how like the pictures are to them",
    .details =
        "Trained Gaussians, clouds, meshes and scene files are drawn by the camera of each photograph, without light, and "
        "compared with it in sRGB numbers: PSNR and SSIM, as 3DGS reports them, and their means. Photographs of lenses are "
        "undistorted; what their lenses do not show is not compared.\n"
        "\n"
        "docs/photos.md says more.",
    .examples = "ewa compare point_cloud.ply --cameras transforms.json -o worst.png\n"
                "ewa compare garden.spz --cameras colmap/sparse/0 --every 8 --json garden.json\n"
                "ewa compare lego.ply --cameras transforms_test.json --background white\n",
    .low_operands = 1,
    .high_operands = 64,
    .groups = (const option_group *const[]){&compare_options, &cloud_input_options, &gaussian_options, &look_options,
                                            NULL},
    .arguments_bytes = sizeof(compare_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
