// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points or triangles: the one place that decides which of them a file holds.
#include "base/base.h"
#include "base/options.h"
#include "io/cloud/format.h"
#include "io/cloud/ply.h"
#include "io/cloud/text_table.h"
#include "io/file.h"
#include "io/foreign.h"
#include "io/image/image_file.h"
#include "io/mesh/formats.h"
#include "io/reader.h"

typedef ewa_status read_format(ewa_mesh_build *build);

/// Makes what is wanted of a build.
static ewa_status take_build(ewa_mesh_build *build, uint32_t wanted, ewa_model *model) {
    const bool faces = build->face_count > 0;
    model->face_count = build->face_count;
    if (!faces || wanted & EWA_MODEL_POINTS) EWA_TRY(ewa_mesh_build_points(build, &model->points));
    if (faces && wanted & EWA_MODEL_ELEMENTS) EWA_TRY(ewa_mesh_build_elements(build, &model->elements));
    if (faces && wanted & EWA_MODEL_MESH) EWA_TRY(ewa_mesh_build_mesh(build, &model->mesh));
    return EWA_OK;
}

/// Reads a format other than PLY.
static ewa_status read_other(const ewa_mesh_source *source, read_format *read, uint32_t wanted,
                             ewa_model *model) {
    ewa_mesh_build build;
    ewa_mesh_build_open(source, &build);
    ewa_status status = read(&build);
    if (status == EWA_OK) status = take_build(&build, wanted, model);
    ewa_mesh_build_close(&build);
    return status;
}

/// Reads one of VTK's files, perhaps behind a byte order mark.
static ewa_status read_vtk(ewa_mesh_source source, uint32_t wanted, ewa_model *model) {
    const uint32_t mark = ewa_bytes_mark(source.bytes, source.size_bytes);
    source.bytes += mark, source.size_bytes -= mark;
    return read_other(&source,
                      ewa_mesh_is_vtk_xml(source.bytes, source.size_bytes)    ? ewa_mesh_read_vtk_xml
                      : ewa_mesh_is_vtk_list(source.bytes, source.size_bytes) ? ewa_mesh_read_vtk_list
                                                                              : ewa_mesh_read_vtk,
                      wanted, model);
}

/// Makes a mesh of what a PLY file holds.
static ewa_status make_ply_mesh(const ewa_mesh_source *source, ewa_model *model) {
    ewa_mesh_build build;
    ewa_mesh_build_open(source, &build);
    ewa_status status = ewa_mesh_read_ply(&build, model->points, model->elements);
    if (status == EWA_OK) status = ewa_mesh_build_mesh(&build, &model->mesh);
    ewa_mesh_build_close(&build);
    return status;
}

static ewa_status count_ply_faces(const ewa_ply_source *source, uint64_t *count) {
    ewa_ply_header *header = ewa_allocate(source->context, 1, sizeof *header);
    if (!header) return EWA_ERROR_MEMORY;
    const ewa_status status = ewa_ply_header_read(source, header);
    *count = status == EWA_OK ? ewa_ply_count_faces(header) : 0;
    ewa_release(source->context, header, 1, sizeof *header);
    return status;
}

/// Reads a file of points alone.
static ewa_status read_points(const ewa_mesh_source *source, const ewa_cloud_format *format,
                              const ewa_cloud_load_options *options, ewa_model *model) {
    model->format = format->format;
    const ewa_cloud_source points = {.context = source->context,
                                     .name = source->name,
                                     .path = source->path,
                                     .bytes = source->bytes,
                                     .size_bytes = source->size_bytes,
                                     .options = options,
                                     .lost_count = &model->lost_count};
    EWA_TRY(ewa_cloud_read_all(&points, format, &model->points));
    ewa_cloud_settle(model->points);
    return EWA_OK;
}

static ewa_status read_ply(const ewa_mesh_source *source, uint32_t wanted,
                           const ewa_cloud_load_options *options, ewa_model *model) {
    const ewa_ply_source ply = {source->context, source->name, source->bytes, source->size_bytes};
    EWA_TRY(count_ply_faces(&ply, &model->face_count));
    const bool faces = model->face_count > 0;
    ewa_status status = EWA_OK;
    // Faces that nobody asks for need not be whole.
    if (!(wanted & (EWA_MODEL_ELEMENTS | (faces ? EWA_MODEL_MESH : 0u)))) {
        status = read_points(source, &ewa_format_ply, options, model);
    } else {
        status = ewa_ply_read_all(&ply, &model->points, &model->elements);
        if (status == EWA_OK && faces && wanted & EWA_MODEL_MESH) status = make_ply_mesh(source, model);
    }
    if (faces && !(wanted & EWA_MODEL_POINTS)) ewa_cloud_destroy(&model->points);
    if (!(wanted & EWA_MODEL_ELEMENTS)) ewa_elements_free(&model->elements);
    return status;
}

/// Finds the format: those with a magic first, then meshes, then text, which has none. `*points` is NULL for
/// meshes.
static ewa_model_format probe(const char *name, const uint8_t *bytes, size_t size_bytes,
                              const ewa_cloud_load_options *options, const ewa_cloud_format **points) {
    *points = ewa_cloud_format_of(name, bytes, size_bytes, EWA_PROBE_MAGIC, options);
    if (*points) return (*points)->format;
    const ewa_model_format mesh = ewa_mesh_probe(name, bytes, size_bytes);
    if (mesh != EWA_MODEL_UNKNOWN) return mesh;
    *points = ewa_cloud_format_of(name, bytes, size_bytes, EWA_PROBE_ALL, options);
    return *points ? (*points)->format : EWA_MODEL_UNKNOWN;
}

ewa_status ewa_model_probe(ewa_context *context, const char *path, ewa_model_format *format) {
    if (!context || !path || !format) return EWA_ERROR_ARGUMENT;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    const ewa_cloud_format *points;
    *format = probe(path, file.bytes, file.size_bytes, NULL, &points);
    ewa_file_unmap(context, &file);
    return EWA_OK;
}

/// Says why a file holds neither points nor triangles.
static ewa_status refuse(const ewa_mesh_source *source) {
    const char *picture = ewa_image_kind(source->bytes, source->size_bytes);
    if (picture)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: a picture (%s), which has no points: heights says that colours of PNG or WebP are such",
                        source->name, picture);
    const char *kind = ewa_foreign_kind(source->bytes, source->size_bytes);
    if (kind) return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED, "%s: %s", source->name, kind);
    EWA_TRY(ewa_text_refuse_odd(source->context, source->name, source->bytes, source->size_bytes));
    return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                    "%s: no file of points or triangles of a known format (" EWA_CLOUD_FORMATS ", OBJ, STL, OFF, glTF, VTK)",
                    source->name);
}

static ewa_status load(const ewa_mesh_source *source, uint32_t wanted, const ewa_cloud_load_options *given,
                       ewa_model *model) {
    if (source->size_bytes == 0)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the file is empty", source->name);
    const ewa_cloud_format *points;
    ewa_cloud_load_options chosen, *options = &chosen;
    ewa_cloud_load_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(source->context, &ewa_cloud_load_options_table, given, &chosen));
    model->format = probe(source->name, source->bytes, source->size_bytes, options, &points);
    switch (model->format) {
    case EWA_MODEL_PLY:
        return read_ply(source, wanted, options, model);
    case EWA_MODEL_OBJ:
        return read_other(source, ewa_mesh_read_obj, wanted, model);
    case EWA_MODEL_STL:
        return read_other(source, ewa_mesh_read_stl, wanted, model);
    case EWA_MODEL_OFF:
        return read_other(source, ewa_mesh_read_off, wanted, model);
    case EWA_MODEL_VTK:
        return read_vtk(*source, wanted, model);
    case EWA_MODEL_GLTF:
        return read_other(source, ewa_mesh_read_gltf, wanted, model);
    default:
        if (points) return read_points(source, points, options, model);
        return refuse(source);
    }
}

ewa_status ewa_model_load_memory(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                                 const char *path, uint32_t wanted, const ewa_cloud_load_options *options,
                                 ewa_model *model) {
    if (!context || !model || !name || (!bytes && size_bytes)) return EWA_ERROR_ARGUMENT;
    *model = (ewa_model){0};
    const ewa_mesh_source source = {context, name, path, bytes, size_bytes};
    const ewa_status status = load(&source, wanted, options, model);
    if (status != EWA_OK) ewa_model_free(model);
    return status;
}

ewa_status ewa_model_load(ewa_context *context, const char *path, uint32_t wanted,
                          const ewa_cloud_load_options *options, ewa_model *model) {
    if (!context || !path || !model) return EWA_ERROR_ARGUMENT;
    *model = (ewa_model){0};
    const bool stream = strcmp(path, "-") == 0;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    ewa_status status =
        ewa_model_load_memory(context, file.bytes, file.size_bytes, stream ? "standard input" : path,
                              stream ? NULL : path, wanted, options, model);
    ewa_file_unmap(context, &file);
    return status;
}

void ewa_model_free(ewa_model *model) {
    if (!model) return;
    ewa_mesh_free(&model->mesh);
    ewa_cloud_destroy(&model->points);
    ewa_elements_free(&model->elements);
    *model = (ewa_model){0};
}

ewa_status ewa_mesh_load(ewa_context *context, const char *path, ewa_mesh *mesh) {
    if (!context || !path || !mesh) return EWA_ERROR_ARGUMENT;
    *mesh = (ewa_mesh){0};
    ewa_model model;
    EWA_TRY(ewa_model_load(context, path, EWA_MODEL_MESH, NULL, &model));
    ewa_status status = EWA_OK;
    if (model.mesh.triangle_count) {
        *mesh = model.mesh;
        model.mesh = (ewa_mesh){0};
    } else {
        status = ewa_fail(context, EWA_ERROR_FORMAT, "%s: there are no faces", path);
    }
    ewa_model_free(&model);
    return status;
}
