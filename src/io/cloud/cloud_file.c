// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Point clouds in and out: finds the format and leads there.
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "io/cloud/ply.h"
#include "io/file.h"

#include <string.h>
#include <strings.h>

static ewa_status load(ewa_context *context, const uint8_t *bytes, size_t size_bytes, const char *name,
                       ewa_cloud **cloud) {
    const ewa_ply_source source = {context, name, bytes, size_bytes};
    if (size_bytes == 0) return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the file is empty", name);
    if (size_bytes < 3 || memcmp(bytes, "ply", 3) != 0)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: not a point file of a known format (PLY begins with 'ply')", name);
    return ewa_ply_read(&source, cloud);
}

ewa_status ewa_cloud_load_memory(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                                 ewa_cloud **cloud) {
    if (!context || !cloud || !name || (!bytes && size_bytes)) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    return load(context, bytes, size_bytes, name, cloud);
}

ewa_status ewa_cloud_load(ewa_context *context, const char *path, ewa_cloud **cloud) {
    if (!context || !path || !cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    ewa_file file;
    ewa_status status = ewa_file_map(context, path, &file);
    if (status != EWA_OK) return status;
    status =
        load(context, file.bytes, file.size_bytes, strcmp(path, "-") == 0 ? "standard input" : path, cloud);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_ply_describe(ewa_context *context, const char *path, ewa_line_callback *line, void *user) {
    if (!context || !path || !line) return EWA_ERROR_ARGUMENT;
    ewa_file file;
    ewa_status status = ewa_file_map(context, path, &file);
    if (status != EWA_OK) return status;
    const ewa_ply_source source = {context, path, file.bytes, file.size_bytes};
    ewa_ply_header *header = ewa_allocate(context, 1, sizeof *header);
    status = header ? ewa_ply_header_read(&source, header) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) ewa_ply_header_lines(&source, header, line, user);
    ewa_release(context, header, 1, sizeof *header);
    ewa_file_unmap(context, &file);
    return status;
}

#define AT(member) offsetof(ewa_cloud_save_options, member)

static const ewa_option option_rows[] = {
    {"ply_encoding", EWA_OPTION_CHOICE, AT(ply_encoding), .words = "little-endian|big-endian|ascii",
     .help = "how PLY files hold numbers"},
};

const ewa_option_table ewa_cloud_save_options_table = EWA_OPTION_TABLE(ewa_cloud_save_options, option_rows);

void ewa_cloud_save_options_init(ewa_cloud_save_options *options, size_t struct_size) {
    ewa_options_init(&ewa_cloud_save_options_table, options, struct_size);
}

/// Streams and devices have no suffix to choose by.
static bool is_ply_path(const char *path) {
    const size_t length = strlen(path);
    return strcmp(path, "-") == 0 || strncmp(path, "/dev/", 5) == 0 ||
           (length >= 4 && strcasecmp(path + length - 4, ".ply") == 0);
}

ewa_status ewa_cloud_save(const ewa_cloud *cloud, const char *path, const ewa_cloud_save_options *options) {
    if (!cloud || !path) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_cloud_save_options chosen;
    ewa_cloud_save_options_init(&chosen, sizeof chosen);
    ewa_status status = ewa_options_take(context, &ewa_cloud_save_options_table, options, &chosen);
    if (status != EWA_OK) return status;
    if (!is_ply_path(path))
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: point clouds are written as .ply", path);
    ewa_writer *writer = NULL;
    status = ewa_writer_open(context, path, &writer);
    if (status != EWA_OK) return status;
    status = ewa_ply_write(cloud, chosen.elements, chosen.ply_encoding, path, writer);
    if (status == EWA_OK) return ewa_writer_commit(&writer);
    ewa_writer_abort(&writer);
    return status;
}
