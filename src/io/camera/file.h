// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera files, the inner side: every format gives a list of cameras.
#ifndef EWA_SRC_CAMERA_FILE_H
#define EWA_SRC_CAMERA_FILE_H

#include "ewa/camera.h"
#include "ewa/io.h"
#include "io/file.h"
#include "io/json_text.h"
#include "io/text.h"

/// Cameras read from one file, in its order. Zero-initialise with the context and the file's name.
typedef struct ewa_camera_list {
    ewa_context *context;
    const char *name; ///< of the file, for messages
    ewa_camera *cameras;
    char **pictures; ///< names of the pictures that they took, as the file has them; NULL: it does not say
    ewa_lens *lenses; ///< of each camera
    size_t count, capacity;
    bool takes_lenses; ///< false: a lens is left out, with a warning, or refused
    bool of_film;      ///< of a scene file its keyframes alone are wanted
    bool lens_suffices; ///< a file that holds a lens and no pose is a camera at the origin
} ewa_camera_list;

/// Appends a camera after checking it; `where`, such as "frames[3]", names its place in the file.
/// Errors: EWA_ERROR_FORMAT, EWA_ERROR_MEMORY.
ewa_status ewa_camera_list_add(ewa_camera_list *list, const char *where, const ewa_camera *camera);

/// Says which lens the camera has that was added last.
void ewa_camera_list_set_lens(ewa_camera_list *list, const ewa_lens *lens);

/// Says which picture the camera that was added last took; copied. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_camera_list_name(ewa_camera_list *list, ewa_text picture);

/// Whether a path is a folder, as a COLMAP model is.
bool ewa_camera_is_folder(const char *path);

/// Reads the cameras of a file or of a folder, whichever format it has.
ewa_status ewa_camera_list_read(ewa_camera_list *list, const char *path);

void ewa_camera_list_free(ewa_camera_list *list);

/// Reads the cameras of a JSON file. `path` is where the file is, or NULL: pictures named in it are looked
/// for beside it when it does not tell their size.
ewa_status ewa_camera_list_read_json(ewa_camera_list *list, const char *path, const uint8_t *bytes,
                                     size_t size_bytes);

/// Reads the cameras of a part of another file's JSON.
ewa_status ewa_camera_list_read_tree(ewa_camera_list *list, const cJSON *root);

/// Reads the aligned and enabled cameras of Metashape's cameras.xml, of its first chunk.
ewa_status ewa_camera_list_read_metashape(ewa_camera_list *list, const uint8_t *bytes, size_t size_bytes);

/// Reads the cameras of a COLMAP model: a folder with cameras.bin and images.bin, or else .txt.
ewa_status ewa_camera_list_read_colmap(ewa_camera_list *list, const char *folder);

/// Reads the two files of a COLMAP model from memory; `is_text` tells which kind they are.
ewa_status ewa_camera_list_read_colmap_memory(ewa_camera_list *list, bool is_text, const uint8_t *cameras,
                                              size_t cameras_bytes, const uint8_t *images,
                                              size_t images_bytes);

/// Reads the poses of a text file as cameras with the lens of `lens`: see ewa_camera_load_poses().
ewa_status ewa_camera_list_read_poses(ewa_camera_list *list, const ewa_camera *lens, const uint8_t *bytes,
                                      size_t size_bytes);

/// Reads a lens from the text of a 3 x 3 matrix, fx s cx, 0 fy cy, 0 0 1, whose size and all else stay those of `lens`.
/// Errors (lens unchanged): EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED (s is not zero).
ewa_status ewa_camera_read_matrix(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                                  ewa_camera *lens);

/// Writes a camera as an object of our format, without a line's end.
void ewa_camera_write(ewa_writer *writer, const ewa_camera *camera);

/// Sets world_to_camera from the rotation (row-major, possibly scaled) and translation of camera to world.
void ewa_camera_set_inverse(ewa_camera *camera, const double rotation[9], const double centre_world[3]);

#endif
