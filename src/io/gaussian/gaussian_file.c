// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of Gaussians in: finds the format and leads there.
#include "base/platform.h"
#include "io/file.h"
#include "io/gaussian/streamed.h"

#include <stdio.h>
#include <string.h>

static const ewa_gaussian_reader *const readers[] = {
    &ewa_gaussians_ply, &ewa_gaussians_packed_ply, &ewa_gaussians_spz,  &ewa_gaussians_gltf,
    &ewa_gaussians_sog, &ewa_gaussians_sog_streamed, &ewa_gaussians_ksplat, &ewa_gaussians_splat};

const char *ewa_gaussian_format_name(ewa_gaussian_format format) {
    static const char *const names[] = {"unknown", "3DGS PLY", "compressed PLY", "splat",
                                        "SPZ",     "glTF",     "ksplat",         "SOG", "streamed SOG"};
    return (unsigned)format < sizeof names / sizeof names[0] ? names[format] : names[0];
}

/// The file that a path stands for: that of a folder of SOG, with levels or without, else the path.
static const char *file_of(ewa_context *context, const char *path, char file[EWA_PATH_BYTES]) {
    static const char *const names[] = {"lod-meta.json", "meta.json"};
    ewa_platform_facts facts;
    if (!ewa_platform_stat(path, &facts) || !facts.folder) return path;
    const size_t length = strlen(path);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const int written = snprintf(file, EWA_PATH_BYTES, "%s%s%s", path, length && path[length - 1] == '/' ? "" : "/", names[i]);
        if (written > 0 && written < EWA_PATH_BYTES && ewa_file_may_read(context, file)) return file;
    }
    return path;
}

/// Sets `*reader` to who reads the file, or NULL.
static ewa_status find_reader(const ewa_gaussian_source *source, const ewa_gaussian_reader **reader) {
    ewa_status status = EWA_OK;
    *reader = NULL;
    for (size_t i = 0; i < sizeof readers / sizeof readers[0] && !*reader && status == EWA_OK; i++)
        if (source->size_bytes && readers[i]->probe(source, &status)) *reader = readers[i];
    return status;
}

static ewa_status load(const ewa_gaussian_source *source, ewa_gaussians *gaussians,
                       ewa_gaussian_facts *facts) {
    if (source->size_bytes == 0)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the file is empty", source->name);
    const ewa_gaussian_reader *reader;
    EWA_TRY(find_reader(source, &reader));
    if (!reader)
        return ewa_fail(
            source->context, EWA_ERROR_UNSUPPORTED,
            "%s: no Gaussians of a known form (PLY, compressed PLY, splat, SPZ, glTF, ksplat, SOG, streamed SOG)",
            source->name);
    facts->format = reader->format;
    facts->size_bytes = source->size_bytes;
    return reader->read(source, gaussians, facts);
}

ewa_status ewa_gaussians_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                     const char *name, const char *path, ewa_gaussians *gaussians,
                                     ewa_gaussian_facts *facts) {
    if (!context || !name || !gaussians || (!bytes && size_bytes)) return EWA_ERROR_ARGUMENT;
    *gaussians = (ewa_gaussians){0};
    const ewa_gaussian_source source = {context, name, path, bytes, size_bytes};
    ewa_gaussian_facts found = {0};
    const ewa_status status = load(&source, gaussians, &found);
    if (status != EWA_OK) ewa_gaussians_free(gaussians);
    if (facts) *facts = status == EWA_OK ? found : (ewa_gaussian_facts){0};
    return status;
}

ewa_status ewa_gaussians_load(ewa_context *context, const char *path, ewa_gaussians *gaussians,
                              ewa_gaussian_facts *facts) {
    if (!context || !path || !gaussians) return EWA_ERROR_ARGUMENT;
    *gaussians = (ewa_gaussians){0};
    const bool stream = strcmp(path, "-") == 0;
    char inside[EWA_PATH_BYTES];
    ewa_file file;
    path = file_of(context, path, inside);
    EWA_TRY(ewa_file_map(context, path, &file));
    ewa_status status =
        ewa_gaussians_load_memory(context, file.bytes, file.size_bytes, stream ? "standard input" : path,
                                  stream ? NULL : path, gaussians, facts);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_streamed_open_file(ewa_context *context, const char *path, ewa_streamed *streamed) {
    const bool stream = strcmp(path, "-") == 0;
    char inside[EWA_PATH_BYTES];
    ewa_file file;
    *streamed = (ewa_streamed){.context = NULL};
    path = file_of(context, path, inside);
    EWA_TRY(ewa_file_map(context, path, &file));
    const ewa_gaussian_source source = {context, stream ? "standard input" : path, stream ? NULL : path, file.bytes, file.size_bytes};
    const ewa_gaussian_reader *reader;
    ewa_status status = find_reader(&source, &reader);
    if (status == EWA_OK && reader == &ewa_gaussians_sog_streamed) status = ewa_streamed_open(&source, streamed);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_gaussians_probe(ewa_context *context, const char *path, ewa_gaussian_format *format) {
    if (!context || !path || !format) return EWA_ERROR_ARGUMENT;
    *format = EWA_GAUSSIANS_NONE;
    char inside[EWA_PATH_BYTES];
    ewa_file file;
    ewa_platform_facts facts;
    path = file_of(context, path, inside);
    if (ewa_platform_stat(path, &facts) && facts.folder) return EWA_OK;
    EWA_TRY(ewa_file_map(context, path, &file));
    const ewa_gaussian_source source = {context, path, path, file.bytes, file.size_bytes};
    const ewa_gaussian_reader *reader;
    const ewa_status status = find_reader(&source, &reader);
    if (reader) *format = reader->format;
    ewa_file_unmap(context, &file);
    return status;
}
