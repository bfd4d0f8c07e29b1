// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The planes of a frame and the files they go to.
#include "cli/render/picture.h"
#include "cli/base/outputs.h"
#include "cli/base/pattern.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXR_CHANNELS = 9, NORMAL_CHANNELS = 3 };

static bool is_exr(const char *path) { return path && path_has_suffix(path, ".exr"); }

/// Takes one "name=FILE" of --aov.
static bool take_aov(const char *word, size_t length, picture_paths *paths,
                     char message[OPTION_ERROR_BYTES]) {
    static const char *const names[] = {"depth", "normal", "coverage"};
    char *const targets[] = {paths->depth, paths->normal, paths->coverage};
    const char *equals = memchr(word, '=', length);
    for (size_t i = 0; equals && i < 3; i++) {
        const size_t name_length = (size_t)(equals - word), path_length = length - name_length - 1;
        if (name_length != strlen(names[i]) || memcmp(word, names[i], name_length) != 0) continue;
        if (path_length == 0 || path_length >= sizeof paths->depth) break;
        memcpy(targets[i], equals + 1, path_length);
        targets[i][path_length] = 0;
        return output_check_suffix("aov", targets[i], ".exr|.pfm", message);
    }
    snprintf(message, OPTION_ERROR_BYTES, "--aov: '%.*s' is not depth=FILE, normal=FILE or coverage=FILE",
             (int)(length < 80 ? length : 80), word);
    return false;
}

bool picture_parse_paths(const char *color, const char *aov, picture_paths *paths,
                         char message[OPTION_ERROR_BYTES]) {
    *paths = (picture_paths){.color = color, .jpeg_quality = -1};
    if (color && !output_check_suffix("output", color, ".png|.jpg|.jpeg|.exr|.pfm|-", message)) return false;
    while (aov) {
        const size_t length = strcspn(aov, ",");
        if (!take_aov(aov, length, paths, message)) return false;
        aov = aov[length] ? aov + length + 1 : NULL;
    }
    return true;
}

const char *picture_check_quality(const char *path, int64_t quality) {
    return quality >= 0 && !path_has_suffix(path, ".jpg|.jpeg") ? "--quality is for JPEG (.jpg)" : NULL;
}

bool picture_make(cli_session *session, const picture_paths *paths, const ewa_camera *camera,
                  cli_picture *picture) {
    *picture = (cli_picture){.rgba8 = NULL};
    ewa_context *context = session->context;
    const uint32_t width = camera->width_px, height = camera->height_px;
    const bool exr = is_exr(paths->color),
               codes = !paths->color || path_has_suffix(paths->color, ".png|.jpg|.jpeg|-");
    ewa_status status = EWA_OK;
    if (codes) {
        picture->rgba8 = malloc((size_t)width * height * 4);
        if (!picture->rgba8) status = EWA_ERROR_MEMORY;
    } else {
        status = ewa_image_create(context, width, height, 4, &picture->color);
    }
    if (status == EWA_OK && (exr || paths->depth[0]))
        status = ewa_image_create(context, width, height, 1, &picture->depth);
    if (status == EWA_OK && ((exr && !paths->no_normals) || paths->normal[0]))
        status = ewa_image_create(context, width, height, 3, &picture->normal);
    if (status == EWA_OK && (exr || paths->coverage[0]))
        status = ewa_image_create(context, width, height, 1, &picture->coverage);
    if (status != EWA_OK) {
        if (!session->reported) session_fail(session, "out of memory for %u x %u pixels", width, height);
        return false;
    }
    picture->frame = (ewa_frame){.rgba8 = picture->rgba8,
                                 .rgba = picture->color.pixels,
                                 .depth = picture->depth.pixels,
                                 .normal = picture->normal.pixels,
                                 .coverage = picture->coverage.pixels};
    return true;
}

void picture_free(cli_picture *picture) {
    free(picture->rgba8);
    ewa_image_free(&picture->color);
    ewa_image_free(&picture->depth);
    ewa_image_free(&picture->normal);
    ewa_image_free(&picture->coverage);
}

/// Packs `from` of `from_count` numbers per pixel into channels [first, first + count) of an image.
static void put_channels(const float *from, uint32_t from_count, uint32_t count, uint32_t first,
                         ewa_image *image) {
    const size_t pixel_count = (size_t)image->width_px * image->height_px;
    float *to = image->pixels + first;
    for (size_t i = 0; i < pixel_count; i++, from += from_count, to += image->channel_count)
        for (uint32_t c = 0; c < count; c++) to[c] = from[c];
}

/// Writes the colour as the channels that .exr or .pfm hold.
static ewa_status save_linear(const picture_paths *paths, const ewa_image_save_options *options,
                              const cli_picture *picture) {
    const bool exr = path_has_suffix(paths->color, ".exr"), normals = picture->normal.pixels != NULL;
    const uint32_t exr_channels = normals ? EXR_CHANNELS : EXR_CHANNELS - NORMAL_CHANNELS;
    ewa_image all;
    ewa_status status = ewa_image_create(picture->color.context, picture->color.width_px,
                                         picture->color.height_px, exr ? exr_channels : 3, &all);
    if (status != EWA_OK) return status;
    put_channels(picture->color.pixels, 4, exr ? 4 : 3, 0, &all);
    ewa_image_save_options chosen = *options;
    if (exr) {
        put_channels(picture->depth.pixels, 1, 1, 4, &all);
        if (normals) put_channels(picture->normal.pixels, 3, NORMAL_CHANNELS, 5, &all);
        put_channels(picture->coverage.pixels, 1, 1, exr_channels - 1, &all);
        chosen.channel_names = normals ? "R,G,B,A,Z,N.X,N.Y,N.Z,coverage" : "R,G,B,A,Z,coverage";
    }
    status = ewa_image_save(&all, paths->color, &chosen);
    ewa_image_free(&all);
    return status;
}

ewa_status picture_save_codes(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px, bool opaque,
                              uint8_t *rgba8, const ewa_image_save_options *options) {
    const size_t width = width_px, pixel_count = width * height_px;
    if (!opaque) return ewa_pixels_save(context, path, width_px, height_px, 4, rgba8, 4 * width, options);
    for (size_t i = 0; i < pixel_count; i++) memmove(rgba8 + 3 * i, rgba8 + 4 * i, 3);
    return ewa_pixels_save(context, path, width_px, height_px, 3, rgba8, 3 * width, options);
}

bool picture_save(cli_session *session, const picture_paths *paths, const ewa_camera *camera, bool opaque,
                  cli_picture *picture) {
    ewa_image_save_options options;
    ewa_image_save_options_init(&options, sizeof options);
    options.world_to_camera = camera->world_to_camera;
    if (paths->jpeg_quality >= 0) options.jpeg_quality = (uint32_t)paths->jpeg_quality;
    const struct {
        const char *path, *channels;
        const ewa_image *image;
    } planes[] = {{paths->depth, "Z", &picture->depth},
                  {paths->normal, "N.X,N.Y,N.Z", &picture->normal},
                  {paths->coverage, "coverage", &picture->coverage}};
    ewa_status status = EWA_OK;
    for (size_t i = 0; i < 3 && status == EWA_OK; i++) {
        if (!planes[i].path[0]) continue;
        session->subject = planes[i].path;
        options.channel_names = planes[i].channels;
        status = ewa_image_save(planes[i].image, planes[i].path, &options);
    }
    options.channel_names = NULL;
    if (status == EWA_OK && paths->color) {
        session->subject = paths->color;
        status = picture->rgba8 ? picture_save_codes(session->context, paths->color, camera->width_px, camera->height_px, opaque,
                                                     picture->rgba8, &options)
                                : save_linear(paths, &options, picture);
    }
    return session_passed(session, status);
}
