// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// EXIF of JPEG files, as far as it says which way a camera was held.
//
// Based on: CIPA DC-008, "Exchangeable image file format for digital still cameras: Exif Version 2.32", 2019, sections
// 4.5 and 4.6.4; ISO/IEC 10918-1, "Digital compression and coding of continuous-tone still images", 1994, annex B.
#include "io/image/exif.h"
#include "base/base.h"
#include "io/image/jpeg.h"
#include "io/reader.h"

enum {
    MARKER = 0xff,
    APP1 = 0xe1,
    START_OF_SCAN = 0xda,
    ORIENTATION = 0x0112,
    SHORT = 3,
    ENTRY_BYTES = 12,
};

/// A number of `size` bytes in the order of an EXIF block; 0 beyond its end.
static uint32_t number_of(ewa_reader *reader, bool big, uint32_t size) {
    const uint8_t *at = ewa_reader_take(reader, size);
    uint32_t value = 0;
    for (uint32_t i = 0; at && i < size; i++) value |= (uint32_t)at[i] << 8 * (big ? size - 1 - i : i);
    return value;
}

/// Of a TIFF header and the directory that it names.
static uint32_t orientation_of(const uint8_t *bytes, uint64_t size_bytes) {
    ewa_reader reader = {bytes, size_bytes, 0, false};
    const uint8_t *order = ewa_reader_take(&reader, 2);
    const bool big = order && order[0] == 'M';
    if (!order || order[0] != order[1] || (order[0] != 'M' && order[0] != 'I')) return EWA_EXIF_UPRIGHT;
    if (number_of(&reader, big, 2) != 42) return EWA_EXIF_UPRIGHT;
    const uint32_t directory = number_of(&reader, big, 4);
    if (directory > size_bytes) return EWA_EXIF_UPRIGHT;
    reader.at_bytes = directory;
    const uint32_t count = number_of(&reader, big, 2);
    for (uint32_t i = 0; i < count && !reader.failed; i++) {
        const uint32_t tag = number_of(&reader, big, 2), type = number_of(&reader, big, 2);
        const uint32_t values = number_of(&reader, big, 4), value = number_of(&reader, big, 2);
        ewa_reader_take(&reader, 2);
        if (reader.failed || tag != ORIENTATION) continue;
        return type == SHORT && values == 1 && value >= EWA_EXIF_UPRIGHT && value <= EWA_EXIF_LAST ? value
                                                                                                 : EWA_EXIF_UPRIGHT;
    }
    return EWA_EXIF_UPRIGHT;
}

uint32_t ewa_exif_orientation(const uint8_t *bytes, size_t size_bytes) {
    static const char name[6] = "Exif\0";
    if (!ewa_jpeg_recognise(bytes, size_bytes)) return EWA_EXIF_UPRIGHT;
    ewa_reader reader = {bytes, size_bytes, 2, false};
    for (;;) {
        const uint8_t *head = ewa_reader_take(&reader, 4);
        if (!head || head[0] != MARKER || head[1] == START_OF_SCAN) return EWA_EXIF_UPRIGHT;
        const uint32_t length = (uint32_t)head[2] << 8 | head[3]; // with itself
        const uint8_t *body = length >= 2 ? ewa_reader_take(&reader, length - 2) : NULL;
        if (!body) return EWA_EXIF_UPRIGHT;
        if (head[1] == APP1 && length - 2 > sizeof name && memcmp(body, name, sizeof name) == 0)
            return orientation_of(body + sizeof name, length - 2 - sizeof name);
    }
}

ewa_status ewa_exif_turn(ewa_image *image, uint32_t orientation) {
    ewa_image turned;
    EWA_TRY(ewa_image_create(image->context, image->height_px, image->width_px, image->channel_count, &turned));
    const size_t channels = image->channel_count;
    // The first row is 5, 8: the left column, 6, 7: the right one; and begins 5, 6: on top, 7, 8: below.
    const bool from_right = orientation == 6 || orientation == 7, from_below = orientation == 7 || orientation == 8;
    for (uint32_t y = 0; y < image->height_px; y++)
        for (uint32_t x = 0; x < image->width_px; x++) {
            const uint32_t to_x = from_right ? image->height_px - 1 - y : y, to_y = from_below ? image->width_px - 1 - x : x;
            memcpy(turned.pixels + ((size_t)to_y * turned.width_px + to_x) * channels,
                   image->pixels + ((size_t)y * image->width_px + x) * channels, channels * sizeof *image->pixels);
        }
    ewa_image_free(image);
    *image = turned;
    return EWA_OK;
}
