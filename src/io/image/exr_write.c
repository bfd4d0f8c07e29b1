// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OpenEXR out: scan lines, ZIP. Chunks are compressed side by side and written in order.
#include "base/base.h"
#include "io/file.h"
#include "io/image/exr.h"

#include <openexr.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_CHANNELS = 16,
    NAME_BYTES = 64,
    CHUNKS_PER_WORKER = 2, // compressed before they are written
    ZIP_LEVEL = 2,         // of zlib; 4 to 9 take two to eight times as long for a few per cent
    FIRST_CAPACITY_BYTES = 1 << 20,
};

typedef struct encoder {
    ewa_context *context;
    const ewa_image *image;
    exr_context_t file;
    uint8_t *bytes; // the file so far: OpenEXRCore goes back to fill in its table of chunks
    size_t size_bytes, capacity_bytes;
    bool out_of_memory;
    char names[MAX_CHANNELS][NAME_BYTES]; // by channel of the image
    int part;
    exr_encode_pipeline_t *pipelines; // chunks in flight
    exr_result_t *results;
    uint32_t slot_count;
} encoder;

/// The library prints when it has no handler; what matters comes back as a result.
static void ignore_message(exr_const_context_t file, exr_result_t code, const char *text) {
    (void)file;
    (void)code;
    (void)text;
}

static bool grow(encoder *job, size_t size_bytes) {
    size_t larger = job->capacity_bytes ? job->capacity_bytes : FIRST_CAPACITY_BYTES;
    while (larger < size_bytes) larger *= 2;
    uint8_t *moved = ewa_allocate(job->context, larger, 1);
    if (!moved) return false;
    if (job->size_bytes) memcpy(moved, job->bytes, job->size_bytes);
    ewa_release(job->context, job->bytes, job->capacity_bytes, 1);
    job->bytes = moved;
    job->capacity_bytes = larger;
    return true;
}

static int64_t write_bytes(exr_const_context_t file, void *user, const void *buffer, uint64_t size_bytes,
                           uint64_t offset, exr_stream_error_func_ptr_t fail) {
    encoder *job = user;
    const uint64_t end = offset + size_bytes;
    if (end > job->capacity_bytes && !grow(job, end)) {
        job->out_of_memory = true;
        fail(file, EXR_ERR_OUT_OF_MEMORY, "out of memory");
        return -1;
    }
    if (offset > job->size_bytes) memset(job->bytes + job->size_bytes, 0, offset - job->size_bytes);
    memcpy(job->bytes + offset, buffer, size_bytes);
    job->size_bytes = end > job->size_bytes ? end : job->size_bytes;
    return (int64_t)size_bytes;
}

static ewa_status fail_exr(const encoder *job, const char *path, exr_result_t error) {
    const bool is_memory = job->out_of_memory || error == EXR_ERR_OUT_OF_MEMORY;
    const ewa_status status = is_memory ? EWA_ERROR_MEMORY : EWA_ERROR_UNSUPPORTED;
    return ewa_fail(job->context, status, "%s: OpenEXR: %s", path, exr_get_default_error_message(error));
}

/// Splits "R,G,B" into one name per channel.
static ewa_status name_channels(encoder *job, const char *path, const char *list) {
    static const char *const by_count[] = {"Y", NULL, "R,G,B", "R,G,B,A"};
    const uint32_t count = job->image->channel_count;
    if (!list && count <= 4) list = by_count[count - 1];
    if (!list)
        return ewa_fail(job->context, EWA_ERROR_ARGUMENT, "%s: OpenEXR: %u channels need names", path, count);
    for (uint32_t c = 0; c < count; c++) {
        const size_t length = strcspn(list, ",");
        if (length == 0 || length >= NAME_BYTES || (list[length] == ',') != (c + 1 < count))
            return ewa_fail(job->context, EWA_ERROR_ARGUMENT,
                            "%s: OpenEXR: '%s' does not name channel %u of %u", path, list, c + 1, count);
        memcpy(job->names[c], list, length);
        job->names[c][length] = '\0';
        for (uint32_t earlier = 0; earlier < c; earlier++)
            if (strcmp(job->names[c], job->names[earlier]) == 0)
                return ewa_fail(job->context, EWA_ERROR_ARGUMENT, "%s: OpenEXR: two channels named '%s'",
                                path, job->names[c]);
        list += length + (list[length] == ',');
    }
    return EWA_OK;
}

static exr_result_t write_header(encoder *job, const char *path, const ewa_image_save_options *options) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = job;
    setup.write_fn = write_bytes;
    setup.zip_level = ZIP_LEVEL;
    exr_result_t error = exr_start_write(&job->file, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (!error) error = exr_add_part(job->file, NULL, EXR_STORAGE_SCANLINE, &job->part);
    if (!error)
        error = exr_initialize_required_attr_simple(job->file, job->part, (int32_t)job->image->width_px,
                                                    (int32_t)job->image->height_px, EXR_COMPRESSION_ZIP);
    const exr_pixel_type_t type = options->exr_half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    for (uint32_t c = 0; !error && c < job->image->channel_count; c++)
        error =
            exr_add_channel(job->file, job->part, job->names[c], type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (!error && options->world_to_camera) {
        exr_attr_m44f_t matrix; // OpenEXR's matrices act on row vectors: the transpose of ours
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++) matrix.m[4 * c + r] = (float)options->world_to_camera[4 * r + c];
        error = exr_attr_set_m44f(job->file, job->part, "worldToCamera", &matrix);
    }
    return error ? error : exr_write_header(job->file);
}

/// In place of the pipeline's last step: the compressed chunk stays in the pipeline, to be written in order.
static exr_result_t keep_chunk(exr_encode_pipeline_t *pipeline) {
    (void)pipeline;
    return EXR_ERR_SUCCESS;
}

/// Points a pipeline at the lines from `y` on.
static exr_result_t prepare_chunk(encoder *job, exr_encode_pipeline_t *pipeline, uint32_t y) {
    const ewa_image *image = job->image;
    exr_chunk_info_t chunk = {0};
    exr_result_t error = exr_write_scanline_chunk_info(job->file, job->part, (int)y, &chunk);
    if (error) return error;
    const bool is_first = !pipeline->channels;
    error = is_first ? exr_encoding_initialize(job->file, job->part, &chunk, pipeline)
                     : exr_encoding_update(job->file, job->part, &chunk, pipeline);
    if (error) return error;
    const float *first = image->pixels + (size_t)y * image->width_px * image->channel_count;
    for (int16_t i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        for (uint32_t c = 0; c < image->channel_count; c++)
            if (strcmp(channel->channel_name, job->names[c]) == 0)
                channel->encode_from_ptr = (const uint8_t *)(first + c);
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = (int32_t)(image->channel_count * sizeof(float));
        channel->user_line_stride = (int32_t)(image->width_px * image->channel_count * sizeof(float));
    }
    if (is_first) error = exr_encoding_choose_default_routines(job->file, job->part, pipeline);
    pipeline->write_fn = keep_chunk;
    pipeline->yield_until_ready_fn = NULL;
    return error;
}

static void encode_chunk(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    encoder *job = data;
    job->results[index] = exr_encoding_run(job->file, job->part, &job->pipelines[index]);
}

static exr_result_t write_chunks(encoder *job) {
    int32_t lines_per_chunk = 0;
    exr_result_t error = exr_get_scanlines_per_chunk(job->file, job->part, &lines_per_chunk);
    uint32_t y = 0;
    while (!error && y < job->image->height_px) {
        uint32_t count = 0;
        const uint32_t first_y = y;
        for (; !error && count < job->slot_count && y < job->image->height_px; y += (uint32_t)lines_per_chunk)
            error = prepare_chunk(job, &job->pipelines[count++], y);
        if (error) break;
        ewa_parallel(job->context, encode_chunk, job, count);
        for (uint32_t i = 0; !error && i < count; i++) {
            error = job->results[i];
            if (!error)
                error = exr_write_scanline_chunk(
                    job->file, job->part, (int)(first_y + i * (uint32_t)lines_per_chunk),
                    job->pipelines[i].compressed_buffer, job->pipelines[i].compressed_bytes);
        }
    }
    return error;
}

static ewa_status encode(encoder *job, const char *path, const ewa_image_save_options *options) {
    job->slot_count = CHUNKS_PER_WORKER * ewa_context_worker_count(job->context);
    job->pipelines = ewa_allocate_zeroed(job->context, job->slot_count, sizeof *job->pipelines);
    job->results = ewa_allocate_zeroed(job->context, job->slot_count, sizeof *job->results);
    exr_result_t error = job->pipelines && job->results ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
    if (!error) error = write_header(job, path, options);
    if (!error) error = write_chunks(job);
    for (uint32_t i = 0; job->pipelines && i < job->slot_count; i++)
        if (job->pipelines[i].channels) exr_encoding_destroy(job->file, &job->pipelines[i]);
    ewa_release(job->context, job->pipelines, job->slot_count, sizeof *job->pipelines);
    ewa_release(job->context, job->results, job->slot_count, sizeof *job->results);
    const exr_result_t finished =
        job->file ? exr_finish(&job->file) : EXR_ERR_SUCCESS; // writes the chunk table
    if (!error) error = finished;
    return error ? fail_exr(job, path, error) : EWA_OK;
}

ewa_status ewa_exr_save(const ewa_image *image, const char *path, const ewa_image_save_options *options) {
    encoder job = {.context = image->context, .image = image};
    ewa_status status = name_channels(&job, path, options->channel_names);
    ewa_writer *writer = NULL;
    if (status == EWA_OK) status = ewa_writer_open(job.context, path, &writer);
    if (status == EWA_OK) status = encode(&job, path, options);
    if (status == EWA_OK) status = ewa_writer_put(writer, job.bytes, job.size_bytes);
    ewa_release(job.context, job.bytes, job.capacity_bytes, 1);
    if (status == EWA_OK) return ewa_writer_commit(&writer);
    ewa_writer_abort(&writer);
    return status;
}
