// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JPEG out through libjpeg. Its errors leave by longjmp into encode(), which owns no memory of ours.
#include "base/base.h"
#include "base/options.h"
#include "ewa/io.h"
#include "image/srgb.h"
#include "io/file.h"

#include <stdio.h> // jpeglib.h needs FILE

#include <jpeglib.h>
#include <setjmp.h>
#include <string.h>

enum { CHUNK_BYTES = 1 << 14, OPAQUE = 255 };

typedef struct jpeg_writer {
    struct jpeg_compress_struct encoder; // first: the callbacks get a pointer to it
    struct jpeg_error_mgr errors;
    struct jpeg_destination_mgr to;
    jmp_buf failed;
    char text[JMSG_LENGTH_MAX];
    ewa_writer *writer;
    ewa_status status; // of the writer
    JSAMPLE *row;
    JOCTET chunk[CHUNK_BYTES];
} jpeg_writer;

static void leave(j_common_ptr encoder) {
    jpeg_writer *job = (jpeg_writer *)encoder;
    encoder->err->format_message(encoder, job->text);
    longjmp(job->failed, 1);
}

static void keep_silent(j_common_ptr encoder) { (void)encoder; }

static void start_chunk(j_compress_ptr encoder) {
    jpeg_writer *job = (jpeg_writer *)encoder;
    job->to.next_output_byte = job->chunk;
    job->to.free_in_buffer = CHUNK_BYTES;
}

static void put_chunk(jpeg_writer *job, size_t size_bytes) {
    job->status = ewa_writer_put(job->writer, job->chunk, size_bytes);
    if (job->status != EWA_OK) longjmp(job->failed, 1);
}

static boolean flush_chunk(j_compress_ptr encoder) {
    put_chunk((jpeg_writer *)encoder, CHUNK_BYTES);
    start_chunk(encoder);
    return TRUE;
}

static void finish_chunk(j_compress_ptr encoder) {
    jpeg_writer *job = (jpeg_writer *)encoder;
    put_chunk(job, CHUNK_BYTES - job->to.free_in_buffer);
}

/// A row without alpha: over white, as light adds up.
static void flatten_row(const uint8_t *from, uint32_t width_px, JSAMPLE *to) {
    for (uint32_t i = 0; i < width_px; i++, from += 4, to += 3)
        for (int c = 0; c < 3; c++) {
            const float alpha = (float)from[3] / OPAQUE;
            to[c] = from[3] == OPAQUE
                        ? from[c]
                        : ewa_srgb8_from_linear(alpha * ewa_srgb_decoded[from[c]] + (1 - alpha));
        }
}

/// Everything that may jump.
static ewa_status encode(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                         uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes, uint32_t quality,
                         jpeg_writer *job) {
    struct jpeg_compress_struct *encoder = &job->encoder;
    if (setjmp(job->failed))
        return job->status != EWA_OK ? job->status
                                     : ewa_fail(context, EWA_ERROR_MEMORY, "%s: JPEG: %s", path, job->text);
    jpeg_create_compress(encoder);
    encoder->dest = &job->to;
    encoder->image_width = width_px;
    encoder->image_height = height_px;
    encoder->input_components = channel_count == 1 ? 1 : 3;
    encoder->in_color_space = channel_count == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(encoder);
    jpeg_set_quality(encoder, (int)quality, TRUE);
    encoder->dct_method = JDCT_ISLOW; // the same bytes for every instruction set
    encoder->optimize_coding = TRUE;
    // Colours are as fine as light, for thin lines and text of a picture's furniture.
    encoder->comp_info[0].h_samp_factor = encoder->comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(encoder, TRUE);
    while (encoder->next_scanline < height_px) {
        const uint8_t *from = pixels + encoder->next_scanline * stride_bytes;
        if (channel_count == 4)
            flatten_row(from, width_px, job->row);
        else
            memcpy(job->row, from, (size_t)width_px * channel_count);
        JSAMPROW rows[1] = {job->row};
        jpeg_write_scanlines(encoder, rows, 1);
    }
    jpeg_finish_compress(encoder);
    return EWA_OK;
}

static bool is_opaque(uint32_t width_px, uint32_t height_px, const uint8_t *pixels, size_t stride_bytes) {
    for (uint32_t j = 0; j < height_px; j++)
        for (uint32_t i = 0; i < width_px; i++)
            if (pixels[j * stride_bytes + 4 * (size_t)i + 3] != OPAQUE) return false;
    return true;
}

static ewa_status check(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                        uint32_t channel_count, size_t stride_bytes) {
    if (channel_count != 1 && channel_count != 3 && channel_count != 4)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: JPEG of %u channels (1, 3 or 4 can be written)",
                        path, channel_count);
    const uint32_t own = ewa_context_limits(context)->max_image_side;
    const uint32_t limit = own < JPEG_MAX_DIMENSION ? own : JPEG_MAX_DIMENSION;
    if (width_px == 0 || height_px == 0 || width_px > limit || height_px > limit)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: JPEG of %u x %u pixels (1 to %u a side)", path,
                        width_px, height_px, limit);
    if (stride_bytes < (size_t)width_px * channel_count)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: rows of %zu bytes at a stride of %zu", path,
                        (size_t)width_px * channel_count, stride_bytes);
    return EWA_OK;
}

ewa_status ewa_jpeg_save(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                         uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes,
                         const ewa_image_save_options *options) {
    if (!context || !path || !pixels) return EWA_ERROR_ARGUMENT;
    ewa_image_save_options chosen;
    ewa_image_save_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_image_save_options_table, options, &chosen));
    EWA_TRY(check(context, path, width_px, height_px, channel_count, stride_bytes));
    if (channel_count == 4 && !is_opaque(width_px, height_px, pixels, stride_bytes))
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "%s: JPEG has no transparency: what is transparent is over white; .png has", path);
    const size_t row_bytes = (size_t)width_px * 3;
    jpeg_writer *job = ewa_allocate_zeroed(context, 1, sizeof *job);
    if (!job) return EWA_ERROR_MEMORY;
    job->row = ewa_allocate(context, row_bytes, 1);
    job->encoder.err = jpeg_std_error(&job->errors);
    job->errors.error_exit = leave;
    job->errors.output_message = keep_silent;
    job->to.init_destination = start_chunk;
    job->to.empty_output_buffer = flush_chunk;
    job->to.term_destination = finish_chunk;
    ewa_status status = job->row ? ewa_writer_open(context, path, &job->writer) : EWA_ERROR_MEMORY;
    if (status == EWA_OK)
        status = encode(context, path, width_px, height_px, channel_count, pixels, stride_bytes, chosen.jpeg_quality, job);
    if (job->encoder.mem) jpeg_destroy_compress(&job->encoder);
    if (status == EWA_OK)
        status = ewa_writer_commit(&job->writer);
    else
        ewa_writer_abort(&job->writer);
    ewa_release(context, job->row, row_bytes, 1);
    ewa_release(context, job, 1, sizeof *job);
    return status;
}
