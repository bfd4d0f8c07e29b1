// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OpenEXR in: chunk by chunk through OpenEXRCore's decoding pipeline, which does not have DWA.
#include "base/base.h"
#include "base/unpacking.h"
#include "io/image/exr.h"
#include "io/image/exr_dwa.h"
#include "io/image/exr_header.h"

#include <openexr.h>
#include <stdio.h>
#include <string.h>

enum {
    MAX_CHANNELS = 16,
    MESSAGE_BYTES = 256,
    // ZIP makes at most 1032 bytes of one and the other methods less, DWA aside: a shorter file cannot hold
    // the pixels that its header claims.
    MAX_RATIO = 1032,
    PART = 0,
    OWN_CHUNKS = 3, // that the library holds: packed, unpacked, and between
};

typedef struct reader {
    ewa_context *context;
    const char *name;
    const uint8_t *bytes;
    size_t size_bytes;
    exr_context_t file;
    char message[MESSAGE_BYTES]; // the library's first complaint
    exr_attr_box2i_t window;
    uint32_t width_px, height_px;
    uint32_t channel_count;
    int selected[MAX_CHANNELS]; // by channel of the image: its index among the file's
    const char *names[MAX_CHANNELS];
    bool is_dwa;
    exr_decode_pipeline_t pipeline;
    bool pipeline_ready;
    uint64_t own_bytes; // what the library takes to decode
} reader;

static int64_t read_bytes(exr_const_context_t file, void *user, void *buffer, uint64_t size_bytes,
                          uint64_t offset, exr_stream_error_func_ptr_t fail) {
    (void)file;
    (void)fail;
    const reader *in = user;
    if (offset >= in->size_bytes) return 0;
    const uint64_t left = in->size_bytes - offset, count = size_bytes < left ? size_bytes : left;
    memcpy(buffer, in->bytes + offset, count);
    return (int64_t)count;
}

static int64_t file_size(exr_const_context_t file, void *user) {
    (void)file;
    return (int64_t)((const reader *)user)->size_bytes;
}

/// Keeps a complaint, which quotes names from the file, which may be any bytes.
static void keep_text(reader *in, const char *text) {
    snprintf(in->message, sizeof in->message, "%s", text);
    for (char *at = in->message; *at; at++)
        if (*at < ' ' || *at > '~') *at = '?';
}

static void keep_message(exr_const_context_t file, exr_result_t code, const char *text) {
    (void)code;
    void *user = NULL;
    if (!file || exr_get_user_data(file, &user) != EXR_ERR_SUCCESS || !user) return;
    reader *in = user;
    if (!in->message[0]) keep_text(in, text);
}

static ewa_status fail_exr(reader *in, exr_result_t error) {
    const ewa_status status = error == EXR_ERR_OUT_OF_MEMORY             ? EWA_ERROR_MEMORY
                              : error == EXR_ERR_FEATURE_NOT_IMPLEMENTED ? EWA_ERROR_UNSUPPORTED
                                                                         : EWA_ERROR_FORMAT;
    const char *text = in->message[0] ? in->message : exr_get_default_error_message(error);
    return ewa_fail(in->context, status, "%s: OpenEXR: %s", in->name, text);
}

static ewa_status open_exr(reader *in) {
    const int side = (int)ewa_context_limits(in->context)->max_image_side;
    exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
    options.error_handler_fn = keep_message;
    options.user_data = in;
    options.read_fn = read_bytes;
    options.size_fn = file_size;
    options.max_tile_width = options.max_tile_height = side;
    options.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    const exr_result_t error = exr_start_read(&in->file, in->name, &options);
    return error ? fail_exr(in, error) : EWA_OK;
}

/// Chooses R G B [A], or the first channels.
static ewa_status choose_channels(reader *in, const exr_attr_chlist_t *channels) {
    static const char *const names[] = {"R", "G", "B", "A"};
    int found[4] = {-1, -1, -1, -1};
    for (int i = 0; i < channels->num_channels; i++)
        for (int c = 0; c < 4; c++)
            if (strcmp(channels->entries[i].name.str, names[c]) == 0) found[c] = i;
    if (found[0] >= 0 && found[1] >= 0 && found[2] >= 0) {
        in->channel_count = found[3] >= 0 ? 4 : 3;
        memcpy(in->selected, found, sizeof found);
    } else {
        in->channel_count =
            channels->num_channels < MAX_CHANNELS ? (uint32_t)channels->num_channels : MAX_CHANNELS;
        for (uint32_t c = 0; c < in->channel_count; c++) in->selected[c] = (int)c;
    }
    if (in->channel_count == 0)
        return ewa_fail(in->context, EWA_ERROR_FORMAT, "%s: OpenEXR: no channels", in->name);
    for (uint32_t c = 0; c < in->channel_count; c++) {
        const exr_attr_chlist_entry_t *channel = &channels->entries[in->selected[c]];
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return ewa_fail(in->context, EWA_ERROR_UNSUPPORTED,
                            "%s: OpenEXR: channel %s is subsampled %d x %d", in->name, channel->name.str,
                            channel->x_sampling, channel->y_sampling);
        in->names[c] = channel->name.str;
    }
    return EWA_OK;
}

/// Reads the header and checks sizes before anything of the picture's size is made.
static ewa_status check_header(reader *in) {
    exr_storage_t storage;
    exr_compression_t compression;
    const exr_attr_chlist_t *channels = NULL;
    exr_result_t error = exr_get_storage(in->file, PART, &storage);
    if (!error) error = exr_get_data_window(in->file, PART, &in->window);
    if (!error) error = exr_get_compression(in->file, PART, &compression);
    if (!error) error = exr_get_channels(in->file, PART, &channels);
    if (error) return fail_exr(in, error);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return ewa_fail(in->context, EWA_ERROR_UNSUPPORTED, "%s: OpenEXR: deep pixels", in->name);
    const ewa_limits *limits = ewa_context_limits(in->context);
    const int64_t width = (int64_t)in->window.max.x - in->window.min.x + 1;
    const int64_t height = (int64_t)in->window.max.y - in->window.min.y + 1;
    if (width < 1 || height < 1)
        return ewa_fail(in->context, EWA_ERROR_FORMAT, "%s: OpenEXR: data window of %lld x %lld pixels",
                        in->name, (long long)width, (long long)height);
    if (width > limits->max_image_side || height > limits->max_image_side)
        return ewa_fail(in->context, EWA_ERROR_LIMIT,
                        "%s: %lld x %lld pixels are over the limit of %u a side", in->name, (long long)width,
                        (long long)height, limits->max_image_side);
    in->width_px = (uint32_t)width;
    in->height_px = (uint32_t)height;
    EWA_TRY(choose_channels(in, channels));

    uint64_t chunk_bytes = 0;
    error = exr_get_chunk_unpacked_size(in->file, PART, &chunk_bytes);
    if (error) return fail_exr(in, error);
    const uint64_t pixel_count = (uint64_t)width * (uint64_t)height;
    in->own_bytes = OWN_CHUNKS * chunk_bytes;
    const uint64_t decoded_bytes = pixel_count * in->channel_count * sizeof(float) + in->own_bytes;
    EWA_TRY(ewa_memory_check_unpacked(in->context, in->size_bytes, EWA_UNPACKED_RATIO, decoded_bytes,
                                      "%s: OpenEXR of %u x %u pixels", in->name, in->width_px, in->height_px));
    in->is_dwa = compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB;
    const uint64_t min_stored_bytes = pixel_count * in->channel_count * sizeof(uint16_t);
    if (!in->is_dwa && min_stored_bytes / MAX_RATIO > in->size_bytes)
        return ewa_fail(in->context, EWA_ERROR_FORMAT, "%s: OpenEXR: %zu bytes cannot hold %u x %u pixels",
                        in->name, in->size_bytes, in->width_px, in->height_px);
    return EWA_OK;
}

/// Decodes one chunk to the pixels from (x, y) of the image on.
static exr_result_t decode_chunk(reader *in, const exr_chunk_info_t *chunk, ewa_image *image, uint32_t x,
                                 uint32_t y) {
    exr_decode_pipeline_t *pipeline = &in->pipeline;
    const bool is_first = !in->pipeline_ready;
    exr_result_t error = is_first ? exr_decoding_initialize(in->file, PART, chunk, pipeline)
                                  : exr_decoding_update(in->file, PART, chunk, pipeline);
    if (error) return error;
    in->pipeline_ready = true;
    float *first = image->pixels + ((size_t)y * image->width_px + x) * image->channel_count;
    for (int16_t i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        channel->decode_to_ptr = NULL;
        for (uint32_t c = 0; c < image->channel_count; c++)
            if (in->selected[c] == i) channel->decode_to_ptr = (uint8_t *)(first + c);
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = (int32_t)(image->channel_count * sizeof(float));
        channel->user_line_stride = (int32_t)(image->width_px * image->channel_count * sizeof(float));
    }
    if (is_first) error = exr_decoding_choose_default_routines(in->file, PART, pipeline);
    return error ? error : exr_decoding_run(in->file, PART, pipeline);
}

static exr_result_t decode_lines(reader *in, ewa_image *image) {
    int32_t lines_per_chunk = 0;
    exr_result_t error = exr_get_scanlines_per_chunk(in->file, PART, &lines_per_chunk);
    for (uint32_t y = 0; !error && y < in->height_px; y += (uint32_t)lines_per_chunk) {
        exr_chunk_info_t chunk = {0};
        error = exr_read_scanline_chunk_info(in->file, PART, in->window.min.y + (int32_t)y, &chunk);
        if (!error) error = decode_chunk(in, &chunk, image, 0, y);
    }
    return error;
}

static exr_result_t decode_tiles(reader *in, ewa_image *image) {
    int32_t tile_width = 0, tile_height = 0;
    exr_result_t error = exr_get_tile_sizes(in->file, PART, 0, 0, &tile_width, &tile_height);
    if (!error && (tile_width < 1 || tile_height < 1)) error = EXR_ERR_INVALID_ATTR;
    int32_t tile_y = 0;
    for (uint32_t y = 0; !error && y < in->height_px; y += (uint32_t)tile_height, tile_y++) {
        int32_t tile_x = 0;
        for (uint32_t x = 0; !error && x < in->width_px; x += (uint32_t)tile_width, tile_x++) {
            exr_chunk_info_t chunk = {0};
            error = exr_read_tile_chunk_info(in->file, PART, tile_x, tile_y, 0, 0, &chunk);
            if (!error) error = decode_chunk(in, &chunk, image, x, y);
        }
    }
    return error;
}

/// Decodes all by OpenEXR's C++.
static ewa_status decode_dwa(reader *in, ewa_image *image) {
    if (!ewa_exr_has_one_part(in->bytes, in->size_bytes))
        return ewa_fail(in->context, EWA_ERROR_UNSUPPORTED,
                        "%s: OpenEXR: several parts, packed by DWA, which is read of files of one part", in->name);
    const size_t header_bytes = ewa_exr_measure_header(in->bytes, in->size_bytes);
    if (!header_bytes)
        return ewa_fail(in->context, EWA_ERROR_FORMAT, "%s: OpenEXR: an attribute of the header is damaged", in->name);
    uint8_t *header = ewa_allocate(in->context, header_bytes, 1);
    if (!header) return EWA_ERROR_MEMORY;
    ewa_exr_copy_header(in->bytes, header_bytes, header);
    char reason[MESSAGE_BYTES];
    const ewa_exr_dwa_result result =
        ewa_exr_dwa_decode(header, header_bytes, in->bytes, in->size_bytes, in->names, in->channel_count, in->width_px,
                           in->height_px, image->pixels, reason, sizeof reason);
    ewa_release(in->context, header, header_bytes, 1);
    if (result == EWA_EXR_DWA_DONE) return EWA_OK;
    if (result != EWA_EXR_DWA_MEMORY) keep_text(in, reason);
    return fail_exr(in, result == EWA_EXR_DWA_MEMORY   ? EXR_ERR_OUT_OF_MEMORY
                        : result == EWA_EXR_DWA_ABSENT ? EXR_ERR_FEATURE_NOT_IMPLEMENTED
                                                       : EXR_ERR_CORRUPT_CHUNK);
}

static ewa_status decode_pixels(reader *in, ewa_image *image) {
    if (in->is_dwa) return decode_dwa(in, image);
    exr_storage_t storage;
    exr_result_t error = exr_get_storage(in->file, PART, &storage);
    if (!error) error = storage == EXR_STORAGE_TILED ? decode_tiles(in, image) : decode_lines(in, image);
    if (in->pipeline_ready) exr_decoding_destroy(in->file, &in->pipeline);
    return error ? fail_exr(in, error) : EWA_OK;
}

ewa_status ewa_exr_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          ewa_image *image) {
    *image = (ewa_image){0};
    reader in = {.context = context, .name = name, .bytes = bytes, .size_bytes = size_bytes};
    ewa_status status = open_exr(&in);
    if (status == EWA_OK) status = check_header(&in);
    if (status == EWA_OK)
        status = ewa_image_create(context, in.width_px, in.height_px, in.channel_count, image);
    if (status == EWA_OK) status = ewa_memory_take(context, in.own_bytes, "%s: OpenEXR", name);
    if (status == EWA_OK) {
        status = decode_pixels(&in, image);
        ewa_memory_give(context, in.own_bytes);
    }
    if (in.file) exr_finish(&in.file);
    if (status != EWA_OK) ewa_image_free(image);
    return status;
}
