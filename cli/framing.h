// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Getting the whole of a cloud into a picture, as large as it goes.
#ifndef EWA_CLI_FRAMING_H
#define EWA_CLI_FRAMING_H

#include "session.h"

/// Where a cloud is, from a sample of its points that does not depend on their order.
typedef struct cloud_framing {
    ewa_bounds box; ///< of the points to show
    double middle_world[3];
    double (*offsets)[3]; ///< of sampled points inside the box, from its middle
    double *rims_world;   ///< how far their discs reach beyond them, as far as that is usual
    size_t count;
    bool trimmed; ///< a few far points are outside the box
} cloud_framing;

/// Measures a cloud; `radius_scale` multiplies its radii. Returns false after reporting; free in any case.
bool framing_make(cli_session *session, const ewa_cloud *cloud, double radius_scale, cloud_framing *framing);
void framing_free(cloud_framing *framing);

/// Places a camera, whose picture and projection are set, so that it looks along `direction_world` and the
/// sampled points just fit. Returns the status of the library.
ewa_status framing_fit(const cloud_framing *framing, const double direction_world[3],
                       const double up_world[3], ewa_camera *camera);

/// Sets the lens of a camera at `eye_world`, which is outside of the cloud and turned towards it, so that the
/// sampled points just fit. Returns the status of the library.
ewa_status framing_zoom(const cloud_framing *framing, const double eye_world[3], const double up_world[3],
                        ewa_camera *camera);

/// Makes the framing of all that a cloud covers while it turns about an axis through `pivot_world`;
/// `direction` is that of the camera. Returns false after reporting; free in any case.
bool framing_revolve(cli_session *session, const cloud_framing *framing, const double pivot_world[3],
                     const double axis_world[3], const double direction_world[3], cloud_framing *solid);

#endif
