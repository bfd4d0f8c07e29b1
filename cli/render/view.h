// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the camera stands: options, default views, framing.
#ifndef EWA_CLI_RENDER_VIEW_H
#define EWA_CLI_RENDER_VIEW_H

#include "cli/base/session.h"

/// Options of the camera, first in the arguments of a command.
typedef struct view_arguments {
    common_arguments common;
    const char *camera_path, *intrinsics;
    int64_t camera_index;
    option_vector eye, target, up;
    double fov_deg;      ///< 0: not given
    double ortho_height; ///< 0: perspective
    int view;            ///< index of a named view; -1: none given
    double azimuth_deg, elevation_deg;
    option_size size;
    bool color_bar; ///< no option of the camera: whether there will be a colour bar, which room is left for
} view_arguments;

extern const option_group view_options;

/// Keys of the options that say where the camera is, where it looks and through which lens.
#define VIEW_PLACING_KEYS "camera camera-index intrinsics eye target up fov ortho view azimuth elevation"

void view_set_defaults(view_arguments *arguments);

/// What is wrong with the options of the camera together; see command.check. `poses`: a lens is wanted, for
/// the poses of another option than --camera.
bool view_check(const view_arguments *arguments, bool poses, char message[OPTION_ERROR_BYTES]);

/// Whether an option says where the camera is or where it looks.
bool view_is_placed(const view_arguments *arguments);

/// What a camera looks at: a scene, or one cloud.
typedef struct view_subject {
    ewa_scene *scene;       ///< NULL: the cloud
    const ewa_cloud *cloud; ///< with at least one finite point
    double radius_scale;    ///< that the cloud's radii are drawn times
} view_subject;

/// Finds the middle of what is looked at, or the target. Returns false after reporting.
bool view_middle(cli_session *session, const view_arguments *arguments, const view_subject *subject,
                 double middle_world[3]);

/// What a turntable turns about.
typedef struct view_turn {
    double pivot_world[3], axis_world[3];
} view_turn;

/// Makes the camera that the options ask for. With `turn`, which may be NULL, it is the first of a turntable: all is
/// in the picture whichever way it is turned. Returns false after reporting.
bool view_make(cli_session *session, const view_arguments *arguments, const view_subject *subject,
               ewa_camera *camera, view_turn *turn);

/// Makes the camera of a panorama of a scene, and fills what is upright in it. Returns false after reporting.
bool view_make_panorama(cli_session *session, const view_arguments *arguments, const view_subject *subject,
                        ewa_panorama_options *panorama, ewa_camera *camera);

/// Finds what a turntable would turn about. Returns false after reporting.
bool view_axis(cli_session *session, const view_arguments *arguments, const view_subject *subject,
               view_turn *turn);

/// Makes the lens that the cameras of a file get if they are poses: a camera at the origin. Says so when the
/// options have none. Returns false after reporting.
bool view_load_lens(cli_session *session, const view_arguments *arguments, const char *path,
                    ewa_camera *lens);

/// Scales a camera's picture to another size, if one is given.
void view_resize(ewa_camera *camera, const option_size *size);

#endif
