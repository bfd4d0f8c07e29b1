// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a page shows, as files in a folder of its own beside a scene file that names them.
#include "cli/page/page_data.h"
#include "cli/base/pattern.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/inputs.h"
#include "cli/input/scene_input.h"
#include "cli/page/page_assets.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { COPY_BYTES = 1 << 20 };

bool page_data_add(page_data *data, const char *name) {
    if (data->count == data->room) {
        const size_t room = data->room ? 2 * data->room : 16;
        char(*larger)[PAGE_NAME_BYTES] = realloc(data->names, room * sizeof *larger);
        if (!larger) return false;
        data->names = larger;
        data->room = room;
    }
    snprintf(data->names[data->count++], PAGE_NAME_BYTES, "%s", name);
    return true;
}

void page_data_remove(const page_data *data) {
    char path[PATH_BYTES];
    for (size_t i = 0; i < data->count; i++)
        if (snprintf(path, sizeof path, "%s/%s", data->folder, data->names[i]) < (int)sizeof path) unlink(path);
}

void page_data_free(page_data *data) {
    free(data->names);
    data->names = NULL;
    data->count = data->room = 0;
}

static bool has_name(const page_data *data, const char *name) {
    for (size_t i = 0; i < data->count; i++)
        if (strcmp(data->names[i], name) == 0) return true;
    return strcmp(name, PAGE_SCENE_NAME) == 0;
}

/// Takes a name for a file, that of `path` with the suffix `suffix` (NULL: its own) where no other has it, of letters that every
/// system, address and text takes; writes where it is. False after reporting.
static bool take_name(cli_session *session, page_data *data, const char *path, const char *suffix, char target[PATH_BYTES]) {
    const char *from = path_file_name(path);
    char plain[PAGE_NAME_BYTES / 2], name[PAGE_NAME_BYTES];
    size_t length = 0;
    for (; *from && length + 1 < sizeof plain; from++) {
        const unsigned char c = (unsigned char)*from;
        const bool kept = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || strchr("._-", c) || c >= 0x80;
        plain[length] = kept && !(c == '.' && length == 0) ? (char)c : '_';
        length++;
    }
    plain[length] = 0;
    char *dot = suffix ? strrchr(plain, '.') : NULL;
    if (dot) *dot = 0;
    snprintf(name, sizeof name, "%s%s", plain, suffix ? suffix : "");
    for (int i = 2; has_name(data, name); i++) snprintf(name, sizeof name, "%d-%s%s", i, plain, suffix ? suffix : "");
    if (!page_data_add(data, name)) return session_fail(session, "out of memory") == EXIT_DONE;
    if (snprintf(target, PATH_BYTES, "%s/%s", data->folder, name) < PATH_BYTES) return true;
    return session_fail(session, "%s: the path is too long", data->folder) == EXIT_DONE;
}

static bool copy_file(cli_session *session, const char *from, const char *to) {
    FILE *input = fopen(from, "rb"), *output = input ? fopen(to, "wb") : NULL;
    const char *subject = input ? to : from;
    int error = errno;
    char *buffer = output ? malloc(COPY_BYTES) : NULL;
    bool done = buffer != NULL;
    if (output && !buffer) error = ENOMEM;
    while (done && !session_interrupted()) {
        const size_t got = fread(buffer, 1, COPY_BYTES, input);
        done = fwrite(buffer, 1, got, output) == got && !ferror(input);
        error = errno;
        if (got < COPY_BYTES) break;
    }
    free(buffer);
    if (input) fclose(input);
    if (output && fclose(output) != 0 && done) {
        done = false;
        error = errno;
    }
    if (!done) session_fail(session, "%s: %s", subject, strerror(error));
    return done && !session_interrupted();
}

/// Writes a cloud, which is freed.
static bool save_cloud(cli_session *session, ewa_cloud *cloud, const char *target) {
    const bool done = cloud && session_passed(session, ewa_cloud_save(cloud, target, NULL));
    ewa_cloud_destroy(&cloud);
    return done;
}

static bool contains(const page_bytes *in, const char *word) {
    const char *const end = in->bytes + in->size_bytes;
    const size_t length = strlen(word);
    for (const char *at = in->bytes; (at = memchr(at, word[0], (size_t)(end - at))); at++)
        if ((size_t)(end - at) >= length && memcmp(at, word, length) == 0) return true;
    return false;
}

/// Whether a page reads a mesh as it is: all in one file, and packed by nothing that takes a library of its own.
static bool is_readable_mesh(const char *path) {
    static const char *const packed[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_texture_basisu"};
    page_bytes read;
    int error;
    if (!path_has_suffix(path, ".glb") || !page_bytes_read(path, &read, &error)) return false;
    bool readable = true;
    for (size_t i = 0; i < sizeof packed / sizeof packed[0] && readable; i++) readable = !contains(&read, packed[i]);
    page_bytes_free(&read);
    return readable;
}

/// Whether points have neither normals nor sizes, which LAZ would not keep as they are.
static bool is_bare(const ewa_cloud *cloud) {
    static const char *const more[] = {EWA_NORMAL, EWA_RADIUS, EWA_TANGENT_U};
    for (size_t i = 0; i < sizeof more / sizeof more[0]; i++)
        if (ewa_cloud_find(cloud, more[i])) return false;
    return true;
}

static bool put_points(cli_session *session, const char *path, const ewa_asset_options *options, bool small, page_data *data,
                       char target[PATH_BYTES]) {
    ewa_model_format format;
    if (!session_passed(session, ewa_model_probe(session->context, path, &format))) return false;
    const bool mesh = format == EWA_MODEL_OBJ || format == EWA_MODEL_GLTF || format == EWA_MODEL_UNKNOWN;
    const bool rare = format == EWA_MODEL_E57 || format == EWA_MODEL_TIFF || format == EWA_MODEL_TERRAIN;
    if (mesh && !is_readable_mesh(path)) // with pictures and libraries beside them, which a page has not
        return take_name(session, data, path, ".ply", target) &&
               save_cloud(session, scene_input_cloud(session, 1, &path, options->cutoff), target);
    const bool packed = path_has_suffix(path, ".laz");
    ewa_cloud *cloud = NULL;
    if (rare || (small && !packed && format != EWA_MODEL_STL && format != EWA_MODEL_OFF && format != EWA_MODEL_VTK)) {
        cloud = input_load(session, path);
        if (!cloud) return false;
        if (small && is_bare(cloud)) return take_name(session, data, path, ".laz", target) && save_cloud(session, cloud, target);
        if (rare) return take_name(session, data, path, ".ply", target) && save_cloud(session, cloud, target);
        ewa_cloud_destroy(&cloud);
    }
    return take_name(session, data, path, NULL, target) && copy_file(session, path, target);
}

static bool put_gaussians(cli_session *session, const char *path, bool small, page_data *data, char target[PATH_BYTES]) {
    const ewa_gaussian_format format = gaussian_files_format(session, path);
    const bool read = format == EWA_GAUSSIANS_PLY || format == EWA_GAUSSIANS_PACKED_PLY || format == EWA_GAUSSIANS_SPLAT ||
                      format == EWA_GAUSSIANS_SPZ || format == EWA_GAUSSIANS_KSPLAT;
    if (read && (!small || format == EWA_GAUSSIANS_SPZ))
        return take_name(session, data, path, NULL, target) && copy_file(session, path, target);
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    if (!take_name(session, data, path, ".spz", target) || !gaussian_files_load(session, path, &set, &facts)) return false;
    ewa_gaussians_save_options options;
    ewa_gaussians_save_options_init(&options, sizeof options);
    memcpy(options.up_world, facts.up_world, sizeof options.up_world);
    const bool done = session_passed(session, ewa_gaussians_save(&set, target, &options));
    ewa_gaussians_free(&set);
    return done;
}

static bool put_volume(cli_session *session, const char *path, page_data *data, char target[PATH_BYTES]) {
    if (path_has_suffix(path, ".nrrd")) return take_name(session, data, path, NULL, target) && copy_file(session, path, target);
    ewa_volume volume;
    if (!take_name(session, data, path, ".nrrd", target) ||
        !session_passed(session, ewa_volume_load(session->context, path, NULL, &volume)))
        return false;
    const bool done = session_passed(session, ewa_volume_save(&volume, target, NULL));
    ewa_volume_free(&volume);
    return done;
}

/// Puts one file into the folder; where it is then. False after reporting.
static bool put(cli_session *session, const char *path, const ewa_asset_options *options, bool small, page_data *data,
                char target[PATH_BYTES]) {
    ewa_asset_kind kind;
    if (!session_passed(session, ewa_asset_probe(session->context, path, options, &kind))) return false;
    if (kind == EWA_ASSET_GAUSSIANS) return put_gaussians(session, path, small, data, target);
    if (kind == EWA_ASSET_VOLUME) return put_volume(session, path, data, target);
    struct stat facts;
    const bool is_folder = stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
    if (is_folder || path_has_suffix(path, ".json")) // an octree of many files (EPT) becomes one
        return take_name(session, data, path, ".laz", target) && save_cloud(session, input_load(session, path), target);
    return put_points(session, path, options, small, data, target);
}

/// Puts the file of a transfer function beside the data, if it is one, and has the options name it there. False after reporting.
static bool put_transfer(cli_session *session, page_data *data, char target[PATH_BYTES], ewa_asset_options *options) {
    if (!options->transfer || access(options->transfer, F_OK) != 0) return true;
    const bool done = take_name(session, data, options->transfer, NULL, target) && copy_file(session, options->transfer, target);
    options->transfer = target;
    return done;
}

/// Adds what was put there to the scene that the page opens.
static bool add(cli_session *session, const char *target, const ewa_asset_options *options, const ewa_instance *instance,
                ewa_scene *scene) {
    ewa_asset *asset = NULL;
    ewa_status status = ewa_asset_load(session->context, target, options, &asset);
    ewa_asset_info info = {.count = 0};
    if (status == EWA_OK) ewa_asset_describe(asset, &info);
    if (status == EWA_OK && !(info.changeable && !info.count)) status = ewa_scene_add(scene, asset, instance);
    ewa_asset_release(&asset);
    return session_passed(session, status);
}

/// Puts what a scene file names.
static bool put_scene(cli_session *session, const char *path, const page_choice *choice, ewa_scene_options *options, ewa_scene *scene,
                      page_data *data) {
    ewa_scene_file *file = NULL;
    if (!session_passed(session, ewa_scene_file_load(session->context, path, choice->assets, &file))) return false;
    ewa_scene_file_apply(file, options);
    bool done = true;
    for (uint32_t i = 0; i < ewa_scene_file_count(file) && done; i++) {
        ewa_scene_entry entry;
        char target[PATH_BYTES], transfer[PATH_BYTES];
        done = session_passed(session, ewa_scene_file_entry(file, i, &entry)) &&
               put(session, entry.path, &entry.asset, choice->small, data, target);
        done = done && put_transfer(session, data, transfer, &entry.asset);
        if (entry.instance.coloring.attribute[0] == 0 && !entry.instance.coloring.tinted) entry.instance.coloring = *choice->coloring;
        done = done && add(session, target, &entry.asset, &entry.instance, scene);
    }
    ewa_scene_file_destroy(&file);
    return done;
}

static bool put_file(cli_session *session, const char *path, const page_choice *choice, ewa_scene *scene, page_data *data) {
    char target[PATH_BYTES], transfer[PATH_BYTES];
    ewa_instance instance;
    ewa_instance_init(&instance, sizeof instance);
    ewa_asset_options options = *choice->assets;
    ewa_asset_kind kind;
    if (!put(session, path, &options, choice->small, data, target) ||
        !session_passed(session, ewa_asset_probe(session->context, target, &options, &kind)) ||
        (kind == EWA_ASSET_VOLUME && !put_transfer(session, data, transfer, &options)))
        return false;
    if (kind != EWA_ASSET_GAUSSIANS && kind != EWA_ASSET_VOLUME) instance.coloring = *choice->coloring;
    return add(session, target, &options, &instance, scene);
}

bool page_data_make(cli_session *session, const page_choice *choice, page_data *data) {
    ewa_scene_options options = *choice->options;
    ewa_scene *scene = NULL;
    char path[PATH_BYTES];
    bool done = session_passed(session, ewa_scene_create(session->context, &options, &scene));
    for (size_t i = 0; i < choice->count && done; i++)
        done = ewa_scene_file_probe(choice->paths[i]) ? put_scene(session, choice->paths[i], choice, &options, scene, data)
                                                      : put_file(session, choice->paths[i], choice, scene, data);
    if (done) done = session_passed(session, ewa_scene_set_options(scene, &options));
    if (done && snprintf(path, sizeof path, "%s/%s", data->folder, PAGE_SCENE_NAME) < (int)sizeof path)
        done = session_passed(session, ewa_scene_save(scene, choice->camera, path));
    ewa_scene_destroy(&scene);
    return done && page_data_add(data, PAGE_SCENE_NAME);
}
