// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A photograph as the pinhole of its camera took it.
#include "base/base.h"
#include "image/srgb.h"
#include "io/image/image_file.h"
#include "photos/parts.h"

#include <stdio.h>
#include <string.h>

/// Makes a copy that is owned.
static ewa_status own_image(ewa_context *context, ewa_image *image, bool *owned) {
    if (*owned) return EWA_OK;
    const ewa_image from = *image;
    EWA_TRY(ewa_image_create(context, from.width_px, from.height_px, from.channel_count, image));
    memcpy(image->pixels, from.pixels, (size_t)from.width_px * from.height_px * from.channel_count * sizeof(float));
    *owned = true;
    return EWA_OK;
}

/// Lays what is transparent over sRGB numbers, by sRGB numbers.
static void lay_over(ewa_image *image, const float background[3]) {
    for (size_t i = 0; i < (size_t)image->width_px * image->height_px; i++) {
        float *at = image->pixels + 4 * i;
        const float alpha = at[3];
        if (alpha >= 1) continue;
        for (int c = 0; c < 3; c++) {
            const float own = alpha > 0 ? ewa_srgb_from_linear(at[c] / alpha) : 0;
            at[c] = ewa_linear_from_srgb(own * alpha + background[c] * (1 - alpha));
        }
        at[3] = 1;
    }
}

/// Makes what a mask has black transparent: `*image`, which is owned then, becomes one of four channels.
static ewa_status put_mask(const char *path, ewa_image *image, bool *owned) {
    ewa_image mask, masked;
    EWA_TRY(ewa_image_load_sized(image->context, path, image->width_px, image->height_px, &mask));
    ewa_status status = EWA_OK;
    if (mask.width_px != image->width_px || mask.height_px != image->height_px)
        status = ewa_fail(image->context, EWA_ERROR_ARGUMENT, "%s: the mask is %u x %u pixels, its photograph %u x %u", path,
                          mask.width_px, mask.height_px, image->width_px, image->height_px);
    if (status == EWA_OK) status = ewa_image_create(image->context, image->width_px, image->height_px, 4, &masked);
    const size_t pixels = (size_t)image->width_px * image->height_px, from = image->channel_count;
    for (size_t i = 0; i < pixels && status == EWA_OK; i++) {
        const bool counts = ewa_srgb_from_linear(mask.pixels[i * mask.channel_count]) >= 0.5f;
        for (size_t c = 0; c < 4; c++) {
            const float number = c < 3 ? image->pixels[i * from + (from < 3 ? 0 : c)] : from == 4 ? image->pixels[i * from + 3] : 1;
            masked.pixels[4 * i + c] = counts ? number : 0;
        }
    }
    ewa_image_free(&mask);
    EWA_TRY(status);
    if (*owned) ewa_image_free(image);
    *image = masked, *owned = true;
    return EWA_OK;
}

static ewa_status prepare_image(ewa_context *context, const ewa_photo *photo, const float background[3], ewa_image *image,
                         bool *owned) {
    if (background && image->channel_count == 4) {
        EWA_TRY(own_image(context, image, owned));
        lay_over(image, background);
    }
    if (photo->mask_path) EWA_TRY(put_mask(photo->mask_path, image, owned));
    if (photo->lens.model == EWA_LENS_PINHOLE) return EWA_OK;
    ewa_image pinhole;
    EWA_TRY(ewa_image_undistort(image, &photo->camera, &photo->lens, &pinhole));
    if (*owned) ewa_image_free(image);
    *image = pinhole, *owned = true;
    return EWA_OK;
}

ewa_status ewa_photo_take(ewa_context *context, const ewa_photo *photo, uint32_t number, const float background[3],
                          ewa_image *image, bool *owned) {
    char name[32];
    snprintf(name, sizeof name, "photograph %u", number);
    const char *subject = photo->path ? photo->path : name;
    *owned = false;
    if (!photo->image && !photo->path)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: has neither a path nor an image", subject);
    if (photo->image) {
        *image = *photo->image;
        image->context = context; // a caller's may have none
    } else {
        EWA_TRY(ewa_image_load_sized(context, photo->path, photo->camera.width_px, photo->camera.height_px, image));
        *owned = true;
    }
    const ewa_camera *camera = &photo->camera;
    ewa_status status = EWA_OK;
    if (!image->pixels || image->width_px != camera->width_px || image->height_px != camera->height_px)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: is %u x %u pixels, and its camera is of %u x %u", subject,
                          image->width_px, image->height_px, camera->width_px, camera->height_px);
    else if (image->channel_count != 1 && image->channel_count != 3 && image->channel_count != 4)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: has %u channels; 1, 3 or 4 are needed", subject,
                          image->channel_count);
    if (status == EWA_OK) status = prepare_image(context, photo, background, image, owned);
    if (status != EWA_OK && *owned) ewa_image_free(image);
    return status;
}

ewa_status ewa_photo_load(ewa_context *context, const ewa_photo *photo, const float background[3], ewa_image *image) {
    if (!context || !photo || !image) return EWA_ERROR_ARGUMENT;
    *image = (ewa_image){0};
    ewa_image taken;
    bool owned;
    EWA_TRY(ewa_camera_check(context, &photo->camera));
    EWA_TRY(ewa_photo_take(context, photo, 0, background, &taken, &owned));
    EWA_TRY(own_image(context, &taken, &owned));
    *image = taken;
    return EWA_OK;
}
