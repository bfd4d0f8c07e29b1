// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Point clouds in and out: finds the format and leads there.
#include "base/base.h"
#include "cloud/cloud.h"
#include "io/cloud/format.h"
#include "io/cloud/ply.h"
#include "io/file.h"

#include <string.h>

static ewa_status load(ewa_context *context, const uint8_t *bytes, size_t size_bytes, const char *name,
                       const char *path, ewa_cloud **cloud) {
    if (size_bytes == 0) return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the file is empty", name);
    const ewa_cloud_format *format = ewa_cloud_format_of(name, bytes, size_bytes, EWA_PROBE_ALL, NULL);
    if (!format)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: not a point file of a known format (" EWA_CLOUD_FORMATS ")", name);
    ewa_cloud_load_options options;
    ewa_cloud_load_options_init(&options, sizeof options);
    uint64_t lost_count = 0;
    const ewa_cloud_source source = {.context = context,
                                     .name = name,
                                     .path = path,
                                     .bytes = bytes,
                                     .size_bytes = size_bytes,
                                     .options = &options,
                                     .lost_count = &lost_count};
    EWA_TRY(ewa_cloud_read_all(&source, format, cloud));
    ewa_cloud_settle(*cloud);
    return EWA_OK;
}

ewa_status ewa_cloud_load_memory(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                                 ewa_cloud **cloud) {
    if (!context || !cloud || !name || (!bytes && size_bytes)) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    return load(context, bytes, size_bytes, name, NULL, cloud);
}

ewa_status ewa_cloud_load(ewa_context *context, const char *path, ewa_cloud **cloud) {
    if (!context || !path || !cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    const bool stream = strcmp(path, "-") == 0;
    ewa_status status = load(context, file.bytes, file.size_bytes, stream ? "standard input" : path,
                             stream ? NULL : path, cloud);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_ply_describe(ewa_context *context, const char *path, ewa_line_callback *line, void *user) {
    if (!context || !path || !line) return EWA_ERROR_ARGUMENT;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    const ewa_ply_source source = {context, path, file.bytes, file.size_bytes};
    ewa_ply_header *header = ewa_allocate(context, 1, sizeof *header);
    ewa_status status = header ? ewa_ply_header_read(&source, header) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) ewa_ply_header_lines(&source, header, line, user);
    ewa_release(context, header, 1, sizeof *header);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_cloud_save(const ewa_cloud *cloud, const char *path, const ewa_cloud_save_options *options) {
    if (!cloud || !path) return EWA_ERROR_ARGUMENT;
    ewa_bounds bounds;
    const ewa_cloud_write_format *format = ewa_cloud_write_format_of(path);
    const bool measured = format && format->needs_bounds && ewa_cloud_find(cloud, EWA_POSITION) &&
                          ewa_cloud_measure(cloud, &bounds) == EWA_OK;
    ewa_cloud_writer *writer = NULL;
    EWA_TRY(ewa_cloud_writer_open(ewa_cloud_context(cloud), path, options, cloud,
                                  ewa_cloud_point_count(cloud), measured ? &bounds : NULL, &writer));
    ewa_status status = ewa_cloud_writer_put(writer, cloud);
    if (status == EWA_OK) return ewa_cloud_writer_commit(&writer);
    ewa_cloud_writer_abort(&writer);
    return status;
}
