// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures: the format by content on input and by suffix on output; float pixels to 8-bit sRGB.
#include "io/image/image_file.h"
#include "base/base.h"
#include "base/options.h"
#include "ewa/io.h"
#include "image/srgb.h"
#include "io/file.h"
#include "io/image/exif.h"
#include "io/image/exr.h"
#include "io/image/hdr.h"
#include "io/image/jpeg.h"
#include "io/image/pfm.h"
#include "io/image/png.h"
#include "io/image/webp.h"

#include <string.h>
#include <strings.h>

enum { ROWS_PER_TASK = 16 };

const char *ewa_image_kind(const uint8_t *bytes, size_t size_bytes) {
    static const struct {
        size_t at, length;
        const char *magic, *name;
    } kinds[] = {{0, 8, "\x89PNG\r\n\x1a\n", "PNG"}, {0, 3, "\xff\xd8\xff", "JPEG"},   {0, 4, "\x76\x2f\x31\x01", "OpenEXR"},
                 {8, 4, "WEBP", "WebP"},              {0, 2, "#?", "Radiance HDR"},  {0, 4, "II*\0", "TIFF"},
                 {0, 4, "MM\0*", "TIFF"},             {0, 4, "GIF8", "GIF"}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (size_bytes >= kinds[i].at + kinds[i].length && memcmp(bytes + kinds[i].at, kinds[i].magic, kinds[i].length) == 0)
            return kinds[i].name;
    return NULL;
}

typedef struct quantiser {
    const ewa_image *image;
    bool unpremultiply;
    uint32_t channel_count; // of the codes: the image's, or 3 for an opaque one of 4
    uint8_t *codes;
} quantiser;

static uint8_t code_of_alpha(float alpha) {
    return alpha > 0 ? (uint8_t)(255.0f * (alpha < 1 ? alpha : 1.0f) + 0.5f) : 0;
}

static void quantise_rows(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const quantiser *job = data;
    const ewa_image *image = job->image;
    const uint32_t first = index * ROWS_PER_TASK, left = image->height_px - first;
    const uint32_t rows = left < ROWS_PER_TASK ? left : ROWS_PER_TASK;
    const size_t first_pixel = (size_t)first * image->width_px, pixel_count = (size_t)rows * image->width_px;
    const uint32_t colours = image->channel_count == 1 ? 1 : 3;
    const float *from = image->pixels + first_pixel * image->channel_count;
    uint8_t *to = job->codes + first_pixel * job->channel_count;
    for (size_t i = 0; i < pixel_count; i++, from += image->channel_count, to += job->channel_count) {
        const float alpha = image->channel_count == 4 ? from[3] : 1;
        if (job->unpremultiply && alpha > 0 && alpha != 1) {
            for (uint32_t c = 0; c < colours; c++) to[c] = ewa_srgb8_from_linear(from[c] / alpha);
        } else {
            for (uint32_t c = 0; c < colours; c++) to[c] = ewa_srgb8_from_linear(from[c]);
        }
        if (job->channel_count == 4) to[3] = code_of_alpha(alpha);
    }
}

static bool is_opaque(const ewa_image *image) {
    const size_t pixel_count = (size_t)image->width_px * image->height_px;
    for (size_t i = 0; i < pixel_count; i++)
        if (code_of_alpha(image->pixels[4 * i + 3]) != 255) return false;
    return true;
}

static bool has_suffix(const char *path, const char *suffix) {
    const size_t length = strlen(path), suffix_length = strlen(suffix);
    return length > suffix_length && strcasecmp(path + length - suffix_length, suffix) == 0;
}

static bool is_jpeg(const char *path) { return has_suffix(path, ".jpg") || has_suffix(path, ".jpeg"); }

/// Or standard output.
static bool is_png(const char *path) { return has_suffix(path, ".png") || strcmp(path, "-") == 0; }

ewa_status ewa_pixels_save(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                           uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes,
                           const ewa_image_save_options *options) {
    if (!context || !path) return EWA_ERROR_ARGUMENT;
    if (is_jpeg(path)) return ewa_jpeg_save(context, path, width_px, height_px, channel_count, pixels, stride_bytes, options);
    if (is_png(path)) return ewa_png_save(context, path, width_px, height_px, channel_count, pixels, stride_bytes);
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: the suffix is none of .png .jpg .jpeg", path);
}

static ewa_status save_codes(const ewa_image *image, const char *path,
                             const ewa_image_save_options *options) {
    ewa_context *context = image->context;
    const uint32_t count = image->channel_count;
    if (count != 1 && count != 3 && count != 4)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: pictures of 8 bits have 1, 3 or 4 channels, not %u", path, count);
    quantiser job = {image, options->srgb_alpha_straight, count == 4 && is_opaque(image) ? 3 : count, NULL};
    const size_t row_bytes = (size_t)image->width_px * job.channel_count;
    job.codes = ewa_allocate(context, image->height_px, row_bytes);
    if (!job.codes) return EWA_ERROR_MEMORY;
    ewa_parallel(context, quantise_rows, &job, (image->height_px - 1) / ROWS_PER_TASK + 1);
    const ewa_status status = ewa_pixels_save(context, path, image->width_px, image->height_px,
                                              job.channel_count, job.codes, row_bytes, options);
    ewa_release(context, job.codes, image->height_px, row_bytes);
    return status;
}

ewa_status ewa_image_save(const ewa_image *image, const char *path, const ewa_image_save_options *options) {
    if (!image || !image->pixels || !path) return EWA_ERROR_ARGUMENT;
    ewa_image_save_options chosen;
    ewa_image_save_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(image->context, &ewa_image_save_options_table, options, &chosen));
    if (is_png(path) || is_jpeg(path))
        return save_codes(image, path, &chosen);
    if (has_suffix(path, ".exr")) return ewa_exr_save(image, path, &chosen);
    if (has_suffix(path, ".pfm")) return ewa_pfm_save(image, path);
    return ewa_fail(image->context, EWA_ERROR_UNSUPPORTED,
                    "%s: the suffix is none of .png .jpg .jpeg .exr .pfm", path);
}

ewa_status ewa_image_decode(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                            bool straight, ewa_image *image) {
    *image = (ewa_image){0};
    if (ewa_png_recognise(bytes, size_bytes))
        return ewa_png_decode(context, name, bytes, size_bytes, straight, image);
    if (ewa_webp_recognise(bytes, size_bytes))
        return ewa_webp_decode(context, name, bytes, size_bytes, straight, image);
    if (ewa_exr_recognise(bytes, size_bytes)) return ewa_exr_decode(context, name, bytes, size_bytes, image);
    if (ewa_pfm_recognise(bytes, size_bytes)) return ewa_pfm_decode(context, name, bytes, size_bytes, image);
    if (ewa_hdr_recognise(bytes, size_bytes)) return ewa_hdr_decode(context, name, bytes, size_bytes, image);
    if (ewa_jpeg_recognise(bytes, size_bytes))
        return ewa_jpeg_decode(context, name, bytes, size_bytes, image);
    return ewa_fail(
        context, EWA_ERROR_FORMAT,
        "%s: no picture: neither PNG nor JPEG nor WebP nor OpenEXR nor PFM nor Radiance by its first bytes",
        name);
}

ewa_status ewa_image_load_memory(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                                 ewa_image *image) {
    if (!context || !image || !name || (!bytes && size_bytes)) return EWA_ERROR_ARGUMENT;
    return ewa_image_decode(context, bytes, size_bytes, name, false, image);
}

ewa_status ewa_depth_load_memory(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                                 ewa_image *depth) {
    if (!context || !depth || !name || (!bytes && size_bytes)) return EWA_ERROR_ARGUMENT;
    *depth = (ewa_image){0};
    if (ewa_png_recognise(bytes, size_bytes))
        return ewa_png_decode_numbers(context, name, bytes, size_bytes, depth);
    if (!ewa_exr_recognise(bytes, size_bytes) && !ewa_pfm_recognise(bytes, size_bytes))
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: depths are PNG, OpenEXR or PFM, this is none by its first bytes", name);
    EWA_TRY(ewa_image_load_memory(context, bytes, size_bytes, name, depth));
    if (depth->channel_count == 1) return EWA_OK;
    const uint32_t channel_count = depth->channel_count;
    ewa_image_free(depth);
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: a picture of %u channels; depths are one", name,
                    channel_count);
}

/// A reader of pictures from memory.
typedef ewa_status load_memory(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                               ewa_image *image);

static ewa_status load_file(ewa_context *context, const char *path, load_memory *load, ewa_image *image) {
    if (!context || !path || !image) return EWA_ERROR_ARGUMENT;
    *image = (ewa_image){0};
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    ewa_status status = load(context, file.bytes, file.size_bytes, name, image);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_depth_load(ewa_context *context, const char *path, ewa_image *depth) {
    return load_file(context, path, ewa_depth_load_memory, depth);
}

ewa_status ewa_image_load(ewa_context *context, const char *path, ewa_image *image) {
    return load_file(context, path, ewa_image_load_memory, image);
}

ewa_status ewa_image_load_sized(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                                ewa_image *image) {
    *image = (ewa_image){0};
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    const uint32_t orientation = ewa_exif_orientation(file.bytes, file.size_bytes);
    ewa_status status = ewa_image_load_memory(context, file.bytes, file.size_bytes, path, image);
    ewa_file_unmap(context, &file);
    if (status == EWA_OK && orientation >= EWA_EXIF_SIDEWAYS && image->width_px == height_px &&
        image->height_px == width_px && width_px != height_px)
        status = ewa_exif_turn(image, orientation);
    if (status != EWA_OK) ewa_image_free(image);
    return status;
}
