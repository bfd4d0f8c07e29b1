// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras where nobody says: which way is up in a cloud, from where it is looked at, and how all of it gets into
// a picture, as large as it goes. The rules are those of docs/framing.md.
//
// The order of the points, copies of them and the number of threads change nothing.
#ifndef EWA_FRAMING_H
#define EWA_FRAMING_H

#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/cloud.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Side from which something is seen.
typedef enum ewa_named_view {
    EWA_VIEW_FRONT = 0, ///< +z with y up, -y with z up
    EWA_VIEW_BACK = 1,
    EWA_VIEW_LEFT = 2,
    EWA_VIEW_RIGHT = 3,
    EWA_VIEW_TOP = 4,
    EWA_VIEW_BOTTOM = 5,
    EWA_VIEW_ISO = 6, ///< from above, 35.3 degrees, in the direction (-1, 1, -1) with z up
} ewa_named_view;

/// What the kind of a file says about its axes: the table in docs/framing.md.
typedef enum ewa_up_convention {
    EWA_UP_ANY = 0,        ///< nothing: y is as good as z
    EWA_UP_Y_USUAL = 1,    ///< OBJ
    EWA_UP_Z_USUAL = 2,    ///< STL
    EWA_UP_Y_REQUIRED = 3, ///< glTF
    EWA_UP_Z_SURVEYED = 4, ///< LAS, LAZ, COPC, EPT, E57, PTX, PTS: instruments that stand upright
    EWA_UP_CAMERA_USUAL = 5, ///< PCD: y down and z ahead in drawings, of bodies nothing
} ewa_up_convention;

/// Returns the convention that all of `path_count` files share by the ends of their names, in any case. Any thread.
EWA_API ewa_up_convention ewa_up_convention_of(size_t path_count, const char *const *paths);

/// How something is looked at.
typedef struct ewa_upright {
    int axis;            ///< that points up: 1 y, 2 z
    bool reversed;       ///< its negative does: y down and z ahead, as cameras have it
    ewa_named_view view; ///< with that axis up
    bool from_origin;    ///< the eye belongs at the origin: ewa_framing_zoom()
    const char *why;     ///< for which reason, in a few words that live as long as the library; UTF-8
} ewa_upright;

enum { EWA_UPRIGHT_TEXT_BYTES = 160 };

/// Returns the word for the place that something is seen from: "front", "back", "left", "right", "top",
/// "bottom", "iso" or "the origin". Any thread.
EWA_API const char *ewa_upright_place(const ewa_upright *upright);

/// Writes what was chosen and why: "z (map coordinates), seen from iso". Any thread.
EWA_API void ewa_upright_describe(const ewa_upright *upright, char text[EWA_UPRIGHT_TEXT_BYTES]);

/// Returns the view of something of the size `extent_world` that has y (1) or z (2) up: from the front, or iso
/// where it is lower than 0.4 of its width, or 1.5 times as deep as wide and not higher. Any thread.
EWA_API ewa_named_view ewa_upright_view(const double extent_world[3], int axis);

/// Gives the direction of the view, from the eye to what it sees, not of unit length, and what points up in its
/// picture: the axis, but seen from above the back, and from below the front. Any thread.
EWA_API void ewa_upright_look(const ewa_upright *upright, double direction_world[3], double up_world[3]);

/// Carries a direction of view and the up of its picture about `axis_world` by `azimuth_deg`, counter-clockwise
/// seen from the axis' end, then raises the eye by `elevation_deg`. Up goes along, so that nothing flips at the
/// poles. Both become unit vectors. Errors (both unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC for a zero
/// vector or what is not finite. Any thread.
EWA_API ewa_status ewa_upright_turn(const double axis_world[3], double azimuth_deg, double elevation_deg,
                                    double direction_world[3], double up_world[3]);

/// Where a cloud is: about 65,536 of its points, chosen by their coordinates, and how far they reach as drawn.
typedef struct ewa_framing ewa_framing;

/// What a framing is of.
typedef struct ewa_framing_info {
    ewa_bounds box;         ///< of the points to show
    double middle_world[3]; ///< of the box
    uint64_t sample_count;  ///< points that are framed
    bool trimmed; ///< less than one point in a hundred, so far off that the rest would be tiny, is outside
} ewa_framing_info;

/// Measures a cloud whose radii are drawn times `radius_scale`, in [0, inf). Discs count as far as three times
/// their median radius. The caller owns `*framing`, which is NULL after a failure and needs the cloud no more.
/// Errors: EWA_ERROR_ARGUMENT (no positions), EWA_ERROR_NUMERIC (no point is finite), EWA_ERROR_MEMORY. One
/// thread per context. Needs up to 7 MiB meanwhile, 4 MiB then.
EWA_API ewa_status ewa_framing_create(const ewa_cloud *cloud, double radius_scale, ewa_framing **framing);

/// Frees a framing; sets `*framing` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_framing_destroy(ewa_framing **framing);

/// Says what a framing is of. Any thread.
EWA_API void ewa_framing_describe(const ewa_framing *framing, ewa_framing_info *info);

/// Chooses what is up and the view, by the points alone and the convention of their file. Costs a few passes over the
/// sample. Any thread. Based on H. Fu, D. Cohen-Or, G. Dror, A. Sheffer, "Upright Orientation of Man-Made
/// Objects", 2008.
EWA_API void ewa_framing_choose(const ewa_framing *framing, ewa_up_convention convention,
                                ewa_upright *upright);

/// Places a camera, whose picture and projection are set, so that it looks along `direction_world` and what is
/// framed just fits, with 0.04 of the picture free at its sides; orthographic ones get their scale. Errors
/// (camera unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC (a zero direction, coordinates that overflow). One
/// thread per context.
EWA_API ewa_status ewa_framing_fit(const ewa_framing *framing, const double direction_world[3],
                                   const double up_world[3], ewa_camera *camera);

/// Turns a perspective camera at `eye_world`, which is outside of what is framed, towards it, and sets its
/// focal lengths so that it just fits. Errors (camera unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC (no
/// lens shows it, coordinates that overflow). One thread per context.
EWA_API ewa_status ewa_framing_zoom(const ewa_framing *framing, const double eye_world[3],
                                    const double up_world[3], ewa_camera *camera);

/// Makes the framing of all that is covered while what is framed turns about an axis through `pivot_world`,
/// for a camera that looks along `direction_world`. The caller owns `*solid`, NULL after a failure. Errors:
/// EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY. One thread per context.
EWA_API ewa_status ewa_framing_revolve(const ewa_framing *framing, const double pivot_world[3],
                                       const double axis_world[3], const double direction_world[3],
                                       ewa_framing **solid);

#ifdef __cplusplus
}
#endif
#endif
