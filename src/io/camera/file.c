// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera files: which format it is, one camera of many, and our own format out.
#include "io/camera/file.h"
#include "base/base.h"
#include "base/platform.h"
#include "ewa/io.h"
#include "homogeneous/camera.h"
#include "io/file.h"
#include "io/number.h"

#include <string.h>

bool ewa_camera_is_folder(const char *path) {
    ewa_platform_facts facts;
    return ewa_platform_stat(path, &facts) && facts.folder;
}

/// Says what a file is that begins with neither JSON nor XML and that people take for cameras. Errors: EWA_ERROR_FORMAT, or EWA_OK
/// where it may be one of these, `*xml` which.
static ewa_status check_begin(const ewa_camera_list *list, const ewa_file *file, bool *xml) {
    static const struct {
        const char *begin, *kind;
    } kinds[] = {{"# Bundle file", "Bundler's bundle.out"},
                 {"NVM_V3", "a model of VisualSFM"},
                 {"# Camera list", "a file of a COLMAP model, of which the folder is wanted"},
                 {"# Image list", "a file of a COLMAP model, of which the folder is wanted"},
                 {"# 3D point list", "a file of a COLMAP model, of which the folder is wanted"},
                 {"ply", "points (PLY)"},
                 {"\xff\xd8\xff", "a picture"},
                 {"\x89PNG", "a picture"}};
    size_t at = 0;
    while (at < file->size_bytes && file->bytes[at] && strchr(" \t\r\n\xef\xbb\xbf", file->bytes[at])) at++;
    *xml = at < file->size_bytes && file->bytes[at] == '<';
    if (*xml || at == file->size_bytes || strchr("{[", file->bytes[at])) return EWA_OK;
    const char *kind = "no JSON";
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        const size_t length = strlen(kinds[i].begin);
        if (file->size_bytes - at >= length && memcmp(file->bytes + at, kinds[i].begin, length) == 0) kind = kinds[i].kind;
    }
    return ewa_fail(list->context, EWA_ERROR_FORMAT,
                    "%s: is %s; cameras are the folder of a COLMAP model, Metashape's cameras.xml, or JSON: transforms.json "
                    "(nerfstudio), cameras.json (INRIA), Open3D's, our own",
                    list->name, kind);
}

ewa_status ewa_camera_list_read(ewa_camera_list *list, const char *path) {
    if (ewa_camera_is_folder(path)) return ewa_camera_list_read_colmap(list, path);
    ewa_file file;
    EWA_TRY(ewa_file_map(list->context, path, &file));
    bool xml;
    ewa_status status = check_begin(list, &file, &xml);
    if (status == EWA_OK)
        status = xml ? ewa_camera_list_read_metashape(list, file.bytes, file.size_bytes)
                     : ewa_camera_list_read_json(list, path, file.bytes, file.size_bytes);
    ewa_file_unmap(list->context, &file);
    return status;
}

ewa_status ewa_camera_load(ewa_context *context, const char *path, uint32_t index, ewa_camera *camera) {
    if (!context || !path || !camera) return EWA_ERROR_ARGUMENT;
    ewa_camera_list list = {.context = context, .name = path};
    ewa_status status = ewa_camera_list_read(&list, path);
    if (status == EWA_OK && index >= list.count)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: camera %u wanted, %zu there (counted from 0)",
                          path, index, list.count);
    if (status == EWA_OK) *camera = list.cameras[index];
    ewa_camera_list_free(&list);
    return status;
}

/// Whether a file begins with a number, as the text of a matrix does and JSON does not.
static bool begins_with_number(const ewa_file *file) {
    size_t at = 0;
    while (at < file->size_bytes && file->bytes[at] && strchr(" \t\r\n", file->bytes[at])) at++;
    return at < file->size_bytes && file->bytes[at] && strchr("+-.0123456789#", file->bytes[at]);
}

/// Reads a lens from the text of a matrix. `*found`: the file may be one.
static ewa_status load_matrix(ewa_context *context, const char *path, ewa_camera *lens, bool *found) {
    *found = false;
    if (ewa_camera_is_folder(path)) return EWA_OK;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    ewa_status status = EWA_OK;
    *found = begins_with_number(&file);
    if (*found) status = ewa_camera_read_matrix(context, path, file.bytes, file.size_bytes, lens);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_camera_load_lens(ewa_context *context, const char *path, ewa_camera *lens) {
    if (!context || !path || !lens) return EWA_ERROR_ARGUMENT;
    bool matrix;
    const ewa_status read = load_matrix(context, path, lens, &matrix);
    if (read != EWA_OK || matrix) return read;
    ewa_camera_list list = {.context = context, .name = path, .lens_suffices = true};
    const ewa_status status = ewa_camera_list_read(&list, path);
    if (status == EWA_OK) {
        ewa_camera_init(lens);
        lens->projection = list.cameras->projection;
        lens->width_px = list.cameras->width_px;
        lens->height_px = list.cameras->height_px;
        lens->fx_px = list.cameras->fx_px;
        lens->fy_px = list.cameras->fy_px;
        lens->cx_px = list.cameras->cx_px;
        lens->cy_px = list.cameras->cy_px;
    }
    ewa_camera_list_free(&list);
    return status;
}

ewa_status ewa_camera_load_each(ewa_context *context, const char *path, ewa_camera_callback *receive,
                                void *user) {
    if (!context || !path || !receive) return EWA_ERROR_ARGUMENT;
    ewa_camera_list list = {.context = context, .name = path, .of_film = true};
    const ewa_status status = ewa_camera_list_read(&list, path);
    for (size_t i = 0; status == EWA_OK && i < list.count; i++) receive(user, (uint32_t)i, &list.cameras[i]);
    ewa_camera_list_free(&list);
    return status;
}

ewa_status ewa_camera_load_poses(ewa_context *context, const char *path, const ewa_camera *lens,
                                 ewa_camera_callback *receive, void *user) {
    if (!context || !path || !lens || !receive) return EWA_ERROR_ARGUMENT;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    ewa_camera_list list = {.context = context, .name = path};
    ewa_status status = ewa_camera_list_read_poses(&list, lens, file.bytes, file.size_bytes);
    ewa_file_unmap(context, &file);
    for (size_t i = 0; status == EWA_OK && i < list.count; i++) receive(user, (uint32_t)i, &list.cameras[i]);
    ewa_camera_list_free(&list);
    return status;
}

static void put_text(ewa_writer *writer, const char *text) { ewa_writer_put(writer, text, strlen(text)); }

static void put_number(ewa_writer *writer, double value) {
    char text[EWA_NUMBER_BYTES];
    ewa_writer_put(writer, text, ewa_number_write_f64(value, text));
}

static void put_member(ewa_writer *writer, const char *name, double value) {
    put_text(writer, "  \"");
    put_text(writer, name);
    put_text(writer, "\": ");
    put_number(writer, value);
    put_text(writer, ",\n");
}

void ewa_camera_write(ewa_writer *writer, const ewa_camera *camera) {
    put_text(writer, "{\n");
    if (camera->projection == EWA_ORTHOGRAPHIC) put_text(writer, "  \"projection\": \"orthographic\",\n");
    put_member(writer, "width", camera->width_px);
    put_member(writer, "height", camera->height_px);
    put_member(writer, "fx", camera->fx_px);
    put_member(writer, "fy", camera->fy_px);
    put_member(writer, "cx", camera->cx_px);
    put_member(writer, "cy", camera->cy_px);
    put_text(writer, "  \"world_to_camera\": [");
    for (int i = 0; i < 16; i++) {
        put_text(writer, i == 0 ? "\n    " : i % 4 ? ", " : ",\n    ");
        put_number(writer, camera->world_to_camera[i]);
    }
    put_text(writer, "\n  ]\n}");
}

ewa_status ewa_camera_save(ewa_context *context, const ewa_camera *camera, const char *path) {
    if (!context || !camera || !path) return EWA_ERROR_ARGUMENT;
    EWA_TRY(ewa_camera_check(context, camera));
    ewa_writer *writer = NULL;
    EWA_TRY(ewa_writer_open(context, path, &writer));
    ewa_camera_write(writer, camera);
    put_text(writer, "\n");
    return ewa_writer_commit(&writer);
}

ewa_status ewa_camera_save_list(ewa_context *context, const ewa_camera *cameras, size_t count,
                                const char *path) {
    if (!context || !cameras || count == 0 || !path) return EWA_ERROR_ARGUMENT;
    for (size_t i = 0; i < count; i++) EWA_TRY(ewa_camera_check(context, &cameras[i]));
    ewa_writer *writer = NULL;
    EWA_TRY(ewa_writer_open(context, path, &writer));
    for (size_t i = 0; i < count; i++) {
        put_text(writer, i ? ",\n" : "[\n");
        ewa_camera_write(writer, &cameras[i]);
    }
    put_text(writer, "\n]\n");
    return ewa_writer_commit(&writer);
}
