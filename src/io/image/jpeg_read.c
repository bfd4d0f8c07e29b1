// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JPEG through libjpeg. Its errors leave by longjmp into decode(), which owns no memory of ours.
#include "base/base.h"
#include "base/unpacking.h"
#include "image/srgb.h"
#include "io/image/jpeg.h"

#include <stdio.h> // jpeglib.h needs FILE

#include <jpeglib.h>
#include <setjmp.h>

/// Progressive files repeat scans; more than this is an attempt to keep us busy.
enum { MAX_SCANS = 200 };

/// What libjpeg takes for any picture.
enum { OWN_BYTES = 1 << 20 };

typedef struct jpeg_reader {
    struct jpeg_decompress_struct decoder; // first: the callbacks get a pointer to it
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf failed;
    char text[JMSG_LENGTH_MAX];
    JSAMPLE *row; // of the picture's width
    size_t row_bytes;
    uint64_t own_bytes; // of libjpeg's memory, counted as held
} jpeg_reader;

static void leave(j_common_ptr decoder) {
    jpeg_reader *reader = (jpeg_reader *)decoder;
    decoder->err->format_message(decoder, reader->text);
    longjmp(reader->failed, 1);
}

static void keep_silent(j_common_ptr decoder) { (void)decoder; }

static void watch_scans(j_common_ptr decoder) {
    jpeg_reader *reader = (jpeg_reader *)decoder;
    if (reader->decoder.input_scan_number > MAX_SCANS) {
        snprintf(reader->text, sizeof reader->text, "more than %d scans", MAX_SCANS);
        longjmp(reader->failed, 1);
    }
}

/// Everything that may jump. `*image` is made on the way and stays the caller's to free.
static ewa_status decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                         jpeg_reader *reader, ewa_image *image) {
    struct jpeg_decompress_struct *decoder = &reader->decoder;
    if (setjmp(reader->failed))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: JPEG: %s", name, reader->text);
    jpeg_create_decompress(decoder);
    reader->progress.progress_monitor = watch_scans;
    decoder->progress = &reader->progress;
    jpeg_mem_src(decoder, bytes, (unsigned long)size_bytes);
    jpeg_read_header(decoder, TRUE);
    const bool grey = decoder->jpeg_color_space == JCS_GRAYSCALE;
    if (!grey && decoder->jpeg_color_space != JCS_RGB && decoder->jpeg_color_space != JCS_YCbCr)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: JPEG of %d components in no RGB nor grey colour space", name,
                        decoder->num_components);
    decoder->out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
    const uint32_t width = decoder->image_width, height = decoder->image_height, channels = grey ? 1 : 3;
    // Of several scans libjpeg holds all coefficients, 16 bits each; else some lines.
    const uint64_t numbers = (uint64_t)width * height * (uint64_t)decoder->num_components;
    const uint64_t own_bytes = OWN_BYTES + (jpeg_has_multiple_scans(decoder) ? numbers * sizeof(JCOEF) : 0);
    const uint64_t image_bytes = (uint64_t)width * height * channels * sizeof(float);
    EWA_TRY(ewa_memory_check_unpacked(context, size_bytes, EWA_UNPACKED_RATIO, own_bytes + image_bytes,
                                      "%s: JPEG of %u x %u pixels", name, width, height));
    EWA_TRY(ewa_image_create(context, width, height, channels, image));
    EWA_TRY(ewa_memory_take(context, own_bytes, "%s: JPEG", name));
    reader->own_bytes = own_bytes;
    reader->row_bytes = (size_t)width * channels;
    reader->row = ewa_allocate(context, reader->row_bytes, 1);
    if (!reader->row) return EWA_ERROR_MEMORY;
    jpeg_start_decompress(decoder);
    while (decoder->output_scanline < height) {
        float *to = image->pixels + (size_t)decoder->output_scanline * width * channels;
        JSAMPROW rows[1] = {reader->row};
        jpeg_read_scanlines(decoder, rows, 1);
        for (size_t i = 0; i < (size_t)width * channels; i++) to[i] = ewa_srgb_decoded[reader->row[i]];
    }
    if (reader->errors.num_warnings)
        ewa_report(context, EWA_SEVERITY_WARNING, "%s: JPEG: parts are missing or broken", name);
    return EWA_OK;
}

ewa_status ewa_jpeg_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                           ewa_image *image) {
    jpeg_reader *reader = ewa_allocate_zeroed(context, 1, sizeof *reader);
    if (!reader) return EWA_ERROR_MEMORY;
    reader->decoder.err = jpeg_std_error(&reader->errors);
    reader->errors.error_exit = leave;
    reader->errors.output_message = keep_silent;
    const ewa_status status = decode(context, name, bytes, size_bytes, reader, image);
    if (reader->decoder.mem) jpeg_destroy_decompress(&reader->decoder);
    ewa_memory_give(context, reader->own_bytes);
    if (status != EWA_OK) ewa_image_free(image);
    ewa_release(context, reader->row, reader->row_bytes, 1);
    ewa_release(context, reader, 1, sizeof *reader);
    return status;
}
