// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa texture: a flat image, seen through a homography or by a camera.
#include "cli/base/commands.h"
#include "cli/render/picture.h"
#include "cli/render/view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct texture_arguments {
    view_arguments view; // first: it begins with the common arguments
    const char *output;
    option_vector homography, corners, plane;
    ewa_texture_options options;
    option_color background;
    int64_t quality; // of a JPEG; -1: not given
} texture_arguments;

#define AT(member)      offsetof(texture_arguments, member)
#define TEXTURE(member) OPTION_OF(ewa_texture_options, AT(options), member)

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(output), "FILE",
     .help = "the picture: .png or .jpg (8-bit sRGB), .exr (linear floats, premultiplied), .pfm "
             "(linear RGB); -: PNG to standard output",
     .letter = 'o'},
    {"background", OPTION_COLOR, AT(background), "r,g,b[,a]", .help = OPTION_COLOR_HELP,
     .aliases = "background-color", .absent = "transparent"},
    PICTURE_QUALITY(AT(quality)),
};

static const cli_option map_table[] = {
    {"homography", OPTION_VECTOR, AT(homography), "9 numbers",
     .help = "matrix H, row by row, from pixels of the image to pixels of the picture, columns on its right: "
             "(x w, y w, w) = H (u, v, 1), as OpenCV writes it, but with pixel centres at half integers; the "
             "side of the horizon on which the middle of the image lies is seen",
     .low = 9, .high = 9, .excludes = "corners plane " VIEW_PLACING_KEYS},
    {"corners", OPTION_VECTOR, AT(corners), "x1,y1,..,x4,y4",
     .help = "where the upper left, upper right, lower right and lower left corners of the image go, in "
             "pixels of the picture",
     .low = 8, .high = 8, .excludes = "plane " VIEW_PLACING_KEYS},
    {"plane", OPTION_VECTOR, AT(plane), "o,a,d",
     .help = "for a camera: where the image is in the world, three times x,y,z: its upper left corner, the "
             "way along its upper edge, the way down its left edge",
     .low = 9, .high = 9, .absent = "auto: 1 high, upright in the x-y plane, its middle at the origin"},
    {"repeat", TEXTURE(repeat)},
};

static const cli_option filter_table[] = {
    {"method", TEXTURE(method)},
    {"prefilter", TEXTURE(prefilter_px)},
    {"cutoff", TEXTURE(cutoff)},
    {"sigma", TEXTURE(sigma_texels)},
    {"point-spacing", TEXTURE(point_spacing_px)},
};

static void set_defaults(void *data) {
    texture_arguments *arguments = data;
    view_set_defaults(&arguments->view);
    ewa_texture_options_init(&arguments->options, sizeof arguments->options);
    arguments->quality = -1;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const texture_arguments *arguments = data;
    picture_paths paths;
    const char *wrong = NULL;
    if (!arguments->output)
        wrong = "texture: no output; say -o FILE";
    else if (arguments->options.repeat && arguments->options.method == EWA_TEXTURE_SPLAT)
        wrong = "--repeat on needs another --method than splat, which would never end";
    else
        wrong = picture_check_quality(arguments->output, arguments->quality);
    if (!options_fine(wrong, message)) return false;
    const char *file = strcmp(arguments->output, "-") == 0 ? NULL : arguments->output;
    return view_check(&arguments->view, false, message) && picture_parse_paths(file, NULL, &paths, message);
}

/// Where the image is in the world: its corner, and its edges from there.
static void place_plane(const texture_arguments *arguments, const ewa_image *image, double plane[3][3]) {
    const double width = (double)image->width_px / image->height_px;
    const double standing[3][3] = {{-0.5 * width, 0.5, 0}, {width, 0, 0}, {0, -1, 0}};
    memcpy(plane, arguments->plane.count ? arguments->plane.values : &standing[0][0], 9 * sizeof(double));
}

/// Makes the camera: where none is placed, it sees the whole image upright. False after reporting.
static bool make_camera(cli_session *session, const texture_arguments *arguments, double plane[3][3],
                        ewa_camera *camera) {
    double corners[4][3];
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            corners[i][c] = plane[0][c] + (i & 1 ? plane[1][c] : 0) + (i & 2 ? plane[2][c] : 0);
    view_arguments view = arguments->view;
    if (!view.camera_path && !view.up.count && view.view < 0) {
        // Up is up in the image.
        view.up = (option_vector){{-plane[2][0], -plane[2][1], -plane[2][2]}, 3};
        if (!view_is_placed(&arguments->view) && !arguments->plane.count) view.view = 0; // front
    }
    ewa_cloud *cloud = NULL;
    ewa_status status = ewa_cloud_create(session->context, 4, &cloud);
    if (status == EWA_OK)
        status = ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F64, 3, corners, sizeof corners[0]);
    bool done = status == EWA_OK;
    if (!done) session_failed(session, status);
    done =
        done && view_make(session, &view, &(view_subject){.cloud = cloud, .radius_scale = 1}, camera, NULL);
    ewa_cloud_destroy(&cloud);
    return done;
}

/// Makes the map that the options ask for, and the size of the picture in `camera`. False after reporting.
static bool make_map(cli_session *session, const texture_arguments *arguments, const ewa_image *image,
                     ewa_mat3 *map, ewa_camera *camera) {
    const bool flat = arguments->homography.count || arguments->corners.count;
    ewa_status status = EWA_OK;
    ewa_camera_init(camera);
    if (flat) {
        const option_size *size = &arguments->view.size;
        camera->width_px = size->given ? size->width_px : image->width_px;
        camera->height_px = size->given ? size->height_px : image->height_px;
    }
    if (arguments->homography.count) {
        const double *h = arguments->homography.values;
        const double w = h[6] * 0.5 * image->width_px + h[7] * 0.5 * image->height_px + h[8];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) map->m[i][j] = w < 0 ? -h[3 * j + i] : h[3 * j + i];
    } else if (arguments->corners.count) {
        double corners[4][2];
        memcpy(corners, arguments->corners.values, sizeof corners);
        status = ewa_texture_map_from_corners(session->context, image->width_px, image->height_px,
                                              (const double(*)[2])corners, map);
    } else {
        double plane[3][3];
        place_plane(arguments, image, plane);
        if (!make_camera(session, arguments, plane, camera)) return false;
        session->subject = NULL;
        status = ewa_texture_map_from_camera(session->context, image->width_px, image->height_px, camera,
                                             plane[0], plane[1], plane[2], map);
    }
    return session_passed(session, status);
}

/// Draws into a new picture, which the caller frees in any case. False after reporting.
static bool draw(cli_session *session, const texture_arguments *arguments, const ewa_image *image,
                 const ewa_mat3 *map, const ewa_camera *camera, ewa_image *picture) {
    ewa_status status = ewa_image_create(session->context, camera->width_px, camera->height_px, 4, picture);
    const size_t pixel_bytes = image->channel_count * sizeof(float);
    const ewa_texture_source source = {image->pixels,   EWA_PIXEL_LINEAR, image->channel_count,
                                       image->width_px, image->height_px, image->width_px * pixel_bytes};
    const ewa_texture_target target = {
        picture->pixels,   EWA_PIXEL_LINEAR,   4,
        picture->width_px, picture->height_px, picture->width_px * 4 * sizeof(float)};
    ewa_texture_options options = arguments->options;
    option_color_linear(&arguments->background, options.background);
    ewa_texture_stats stats;
    if (status == EWA_OK) status = ewa_texture_map(session->context, &source, map, &options, &target, &stats);
    if (!session_passed(session, status)) return false;
    if (arguments->options.method != EWA_TEXTURE_BILINEAR && stats.splat_count + stats.point_count == 0)
        session_warn(session, "nothing of the image is in the picture");
    session_say(session,
                "%llu splats, %llu points for %llu texels in %.1f ms, %.3g million pixels per second",
                (unsigned long long)stats.splat_count, (unsigned long long)stats.point_count,
                (unsigned long long)stats.texel_count, 1e3 * stats.total_s,
                1e-6 * picture->width_px * picture->height_px / stats.total_s);
    return true;
}

static int run(const void *data) {
    const texture_arguments *arguments = data;
    cli_session session;
    const common_arguments *common = &arguments->view.common;
    if (!session_start(&session, common)) return session_end(&session, EXIT_FAILED);
    ewa_image image = {.pixels = NULL}, picture = {.pixels = NULL};
    ewa_mat3 map;
    ewa_camera camera;
    session.subject = common->operands[0];
    ewa_status status = ewa_image_load(session.context, common->operands[0], &image);
    if (status != EWA_OK) session_failed(&session, status);
    bool done = status == EWA_OK;
    if (done && image.channel_count != 1 && image.channel_count != 3 && image.channel_count != 4) {
        session_fail(&session, "%u channels are no picture; grey, RGB and RGBA are", image.channel_count);
        done = false;
    }
    done = done && make_map(&session, arguments, &image, &map, &camera) &&
           draw(&session, arguments, &image, &map, &camera, &picture);
    if (done) {
        ewa_image_save_options save;
        ewa_image_save_options_init(&save, sizeof save);
        if (!arguments->homography.count && !arguments->corners.count)
            save.world_to_camera = camera.world_to_camera;
        if (arguments->quality >= 0) save.jpeg_quality = (uint32_t)arguments->quality;
        session.subject = arguments->output;
        status = ewa_image_save(&picture, arguments->output, &save);
        if (status != EWA_OK) session_failed(&session, status);
        done = status == EWA_OK;
    }
    ewa_image_free(&picture);
    ewa_image_free(&image);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static const option_group output_options = OPTION_GROUP("Output", output_table);
static const option_group map_options = OPTION_GROUP("Map", map_table);
static const option_group filter_options = OPTION_GROUP("Filter", filter_table);
const cli_command texture_command = {
    .name = "texture",
    .operands = "IMAGE -o OUT",
    .summary = "map a flat image by a homography, by its corners or by a camera, antialiased forward",
    .details = "Every pixel of the image (PNG, JPEG, EXR, PFM, HDR) is sent to the picture: as a point under "
               "a circular "
               "filter where it gets small, as the exact ellipse of its disc where it does not. Colours are "
               "averaged in linear "
               "light, alpha premultiplied; at its edges the image covers pixels by the exact share of their "
               "area.\n\n"
               "With --homography or --corners the picture has the size of the image, unless --size says "
               "otherwise. With "
               "neither, a camera sees the image in the world: without --eye and such, the whole of it, from "
               "the front.",
    .examples = "ewa texture photo.jpg -o tilted.png --corners 80,40,600,10,630,470,20,400\n"
                "ewa texture check.png -o floor.png --repeat on --plane -1,1,0,2,0,0,0,-2,0 --eye 0,-2,0.4 "
                "--up 0,0,1 --target 0,1,0.2\n"
                "ewa texture photo.png -o shifted.exr --homography 1,0,8,0,1,3,0,0,1 --method splat\n",
    .low_operands = 1,
    .high_operands = 1,
    .groups =
        (const option_group *const[]){&output_options, &map_options, &view_options, &filter_options, NULL},
    .arguments_bytes = sizeof(texture_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
