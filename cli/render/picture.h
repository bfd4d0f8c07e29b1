// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The planes of a frame and the files they go to.
#ifndef EWA_CLI_RENDER_PICTURE_H
#define EWA_CLI_RENDER_PICTURE_H

#include "cli/base/session.h"

/// The row of --quality of commands that write single pictures.
#define PICTURE_QUALITY(at)                                                                                             \
    {"quality", OPTION_INTEGER, at, "Q", "[0, 100]", .help = "quality of a JPEG, from 0 (small) to 100 (good)",         \
     .absent = "auto: 95"}

/// Paths of what is written of a frame; NULL: not asked for.
typedef struct picture_paths {
    /// .png, .jpg, .jpeg, .exr or .pfm; "-": PNG to standard output; NULL: the 8-bit picture is made, but not written here
    const char *color;
    char depth[1024], normal[1024], coverage[1024]; ///< .exr or .pfm; empty: not asked for
    bool no_normals; ///< what is drawn has none: .exr goes without their channels
    int64_t jpeg_quality; ///< from 0 to 100; -1: the library's default
} picture_paths;

/// Fills the paths from -o, or NULL, and --aov; says in `message` what is wrong with them. `aov` may be NULL.
bool picture_parse_paths(const char *color, const char *aov, picture_paths *paths,
                         char message[OPTION_ERROR_BYTES]);

/// What is wrong with a quality (-1: not given) for a picture of this name; NULL: nothing.
const char *picture_check_quality(const char *path, int64_t quality);

/// Memory of a frame: the planes that the paths need.
typedef struct cli_picture {
    ewa_frame frame;
    ewa_image color, depth, normal, coverage;
    uint8_t *rgba8;
} cli_picture;

/// Returns false after reporting; free with picture_free() in any case.
bool picture_make(cli_session *session, const picture_paths *paths, const ewa_camera *camera,
                  cli_picture *picture);
void picture_free(cli_picture *picture);

/// Writes an 8-bit picture, without alpha where that says nothing, which the pixels are packed for; `options` may be NULL. The status of the
/// library.
ewa_status picture_save_codes(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px, bool opaque,
                              uint8_t *rgba8, const ewa_image_save_options *options);

/// Writes all files; false after reporting. `opaque`: the background hides everything, so alpha can be left
/// out.
bool picture_save(cli_session *session, const picture_paths *paths, const ewa_camera *camera, bool opaque,
                  cli_picture *picture);

#endif
