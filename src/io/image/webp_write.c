// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// WebP out, lossless, through libwebp.
#include "base/base.h"
#include "io/image/webp.h"

#include <webp/encode.h>

/// What libwebp takes by itself for a pixel: the picture as words, its prediction, chains of what repeats.
enum { OWN_BYTES_PER_PIXEL = 40, OWN_BYTES = 1 << 22 };

/// The encoding grows in a block of the context, twice as large each time.
static int append(const uint8_t *data, size_t data_bytes, const WebPPicture *picture) {
    ewa_webp *to = picture->custom_ptr;
    if (data_bytes > to->room_bytes - to->size_bytes) {
        const size_t room_bytes = 2 * to->room_bytes + data_bytes;
        uint8_t *more = ewa_allocate(to->context, room_bytes, 1);
        if (!more) return 0;
        if (to->size_bytes) memcpy(more, to->bytes, to->size_bytes);
        ewa_release(to->context, to->bytes, to->room_bytes, 1);
        to->bytes = more, to->room_bytes = room_bytes;
    }
    memcpy(to->bytes + to->size_bytes, data, data_bytes);
    to->size_bytes += data_bytes;
    return 1;
}

static ewa_status encode(const char *name, const uint8_t *codes, WebPPicture *picture, ewa_webp *webp) {
    WebPConfig config;
    const bool known = WebPConfigInit(&config);
    config.lossless = 1;
    config.exact = 1; // what is said of pixels without alpha counts
    if (known && WebPPictureImportRGBA(picture, codes, 4 * picture->width) && WebPEncode(&config, picture)) return EWA_OK;
    if (picture->error_code == VP8_ENC_ERROR_OUT_OF_MEMORY || picture->error_code == VP8_ENC_ERROR_BITSTREAM_OUT_OF_MEMORY ||
        picture->error_code == VP8_ENC_ERROR_BAD_WRITE)
        return ewa_fail(webp->context, EWA_ERROR_MEMORY, "%s: no memory for WebP of %d x %d pixels", name, picture->width, picture->height);
    return ewa_fail(webp->context, EWA_ERROR_UNSUPPORTED, "%s: libwebp encodes no %d x %d pixels (its error %d)", name, picture->width,
                    picture->height, (int)picture->error_code);
}

ewa_status ewa_webp_encode_codes(ewa_context *context, const char *name, uint32_t width_px, uint32_t height_px, const uint8_t *codes,
                                 ewa_webp *webp) {
    *webp = (ewa_webp){.context = context};
    if (width_px == 0 || height_px == 0 || width_px > WEBP_MAX_DIMENSION || height_px > WEBP_MAX_DIMENSION)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %u x %u pixels; WebP has sides of 1 to %d", name, width_px, height_px,
                        WEBP_MAX_DIMENSION);
    WebPPicture picture;
    if (!WebPPictureInit(&picture)) return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: libwebp is of another version", name);
    picture.use_argb = 1;
    picture.width = (int)width_px, picture.height = (int)height_px;
    picture.writer = append;
    picture.custom_ptr = webp;
    const uint64_t own_bytes = OWN_BYTES + (uint64_t)width_px * height_px * OWN_BYTES_PER_PIXEL;
    EWA_TRY(ewa_memory_take(context, own_bytes, "%s: WebP of %u x %u pixels", name, width_px, height_px));
    const ewa_status status = encode(name, codes, &picture, webp);
    WebPPictureFree(&picture);
    ewa_memory_give(context, own_bytes);
    if (status != EWA_OK) ewa_webp_free(webp);
    return status;
}

void ewa_webp_free(ewa_webp *webp) {
    ewa_release(webp->context, webp->bytes, webp->room_bytes, 1);
    *webp = (ewa_webp){.context = webp->context};
}
