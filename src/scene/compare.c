// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scene beside a photograph.
#include "base/base.h"
#include "scene/parts.h"

static ewa_status compare(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_photo *photo,
                          const ewa_scene_options *options, ewa_photo_comparison *found) {
    const ewa_camera *camera = &photo->camera;
    float background[3];
    for (int c = 0; c < 3; c++) background[c] = ewa_srgb_from_linear(options->render.background[c]);
    EWA_TRY(ewa_photo_load(scene->context, photo, background, &found->photo));
    EWA_TRY(ewa_image_create(scene->context, camera->width_px, camera->height_px, 4, &found->picture));
    const ewa_frame frame = {.rgba = found->picture.pixels};
    EWA_TRY(ewa_scene_draw(scene, renderer, camera, options, &frame, NULL));
    return ewa_image_compare(&found->picture, &found->photo, &found->quality);
}

ewa_status ewa_scene_compare_photo(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_photo *photo,
                                   const ewa_scene_options *options, ewa_photo_comparison *found) {
    if (!scene || !renderer || !photo || !found) return EWA_ERROR_ARGUMENT;
    *found = (ewa_photo_comparison){0};
    ewa_scene_options opaque = options ? *options : scene->options;
    opaque.render.background[3] = 1;
    const ewa_status status = compare(scene, renderer, photo, &opaque, found);
    if (status == EWA_OK) return EWA_OK;
    ewa_image_free(&found->photo);
    ewa_image_free(&found->picture);
    return status;
}
