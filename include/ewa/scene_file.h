// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scene files: a small text (JSON) that names the files of a scene and says how each is shown, so that program, viewer
// and Python open the same picture again. docs/scene.md has the format.
#ifndef EWA_SCENE_FILE_H
#define EWA_SCENE_FILE_H

#include "ewa/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EWA_SCENE_FILE_DEPTH = 8,    ///< scene files that name one another, at most
    EWA_SCENE_FILE_COUNT = 1024, ///< scene files that are read for one, at most
};

/// What a scene file says, with the scene files that it names: immutable; any thread.
typedef struct ewa_scene_file ewa_scene_file;

/// A file of a scene, and how it is shown. What it points to is the scene file's, and that of the options that this was
/// loaded with.
typedef struct ewa_scene_entry {
    const char *path;
    ewa_asset_options asset;
    ewa_instance instance;
} ewa_scene_entry;

/// Says whether a regular file is a scene file, by its first bytes. Reports nothing. Any thread.
EWA_API bool ewa_scene_file_probe(const char *path);

/// Reads a scene file, and those that it names; of what they show, nothing is loaded. Names are relative to the folder
/// of the file that they stand in, below which they must lie when links are resolved. `options` (may be NULL) are those of
/// every asset where the file says nothing; its pointers are borrowed as long as entries are used. The caller destroys
/// `*file`, NULL after a failure. Errors, with the file and the place: EWA_ERROR_IO, EWA_ERROR_FORMAT (text, members,
/// values, a singular map, a name that leads to nothing or out of the folder), EWA_ERROR_UNSUPPORTED (version),
/// EWA_ERROR_LIMIT (a circle, EWA_SCENE_FILE_DEPTH, EWA_SCENE_FILE_COUNT, EWA_SCENE_MAX_INSTANCES), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_file_load(ewa_context *context, const char *path,
                                       const ewa_asset_options *options, ewa_scene_file **file);
EWA_API void ewa_scene_file_destroy(ewa_scene_file **file);

EWA_API uint32_t ewa_scene_file_count(const ewa_scene_file *file);

/// Fills what is said of file `index`, in the order of the text. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_scene_file_entry(const ewa_scene_file *file, uint32_t index, ewa_scene_entry *entry);

/// Fills the camera; false: the file has none. Those of files that it names do not count, nor do their options.
EWA_API bool ewa_scene_file_camera(const ewa_scene_file *file, ewa_camera *camera);

/// Fills measurement `index`; false: there is none. Those of files that it names do not count.
EWA_API bool ewa_scene_file_measure(const ewa_scene_file *file, uint32_t index, ewa_measure *measure);

/// Fills keyframe `index`; false: there is none. Those of files that it names do not count.
EWA_API bool ewa_scene_file_keyframe(const ewa_scene_file *file, uint32_t index, ewa_camera *camera);

/// Sets those options that have their defaults to what the file says: what a caller has set otherwise wins.
EWA_API void ewa_scene_file_apply(const ewa_scene_file *file, ewa_scene_options *options);

/// Adds everything that a scene file names to a scene, whose options become those of ewa_scene_file_apply(). Points of
/// which a filter takes none are left out, which a note says; the file's camera, measurements and keyframes become the scene's where it
/// has none. After a failure the scene is as it was. Errors: those of ewa_scene_file_load(),
/// ewa_asset_load() and ewa_scene_add().
EWA_API ewa_status ewa_scene_open(ewa_scene *scene, const char *path, const ewa_asset_options *options);

/// Writes a scene file: the options that are no defaults, and every instance, whose assets must be of files below the
/// folder of `path`. `camera` (may be NULL: the scene's, if it has one) is written with it. Materials and environments are of no scene file. Errors:
/// EWA_ERROR_UNSUPPORTED (an asset of no file, of one that lies elsewhere, or of chosen columns; materials, an
/// environment), EWA_ERROR_IO, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_save(const ewa_scene *scene, const ewa_camera *camera, const char *path);

/// Writes what a scene is as JSON text, UTF-8, ended by a zero: of every instance its name, kind, count, box and how it is
/// shown; the box of all; the options that are no defaults. `*text` is the caller's, to be freed with ewa_text_free();
/// NULL after a failure. Errors: EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_describe_json(const ewa_scene *scene, char **text);
EWA_API void ewa_text_free(char **text);

#ifdef __cplusplus
}
#endif
#endif
