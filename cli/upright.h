// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in a cloud, and from where it is looked at when nobody says: docs/framing.md.
#ifndef EWA_CLI_UPRIGHT_H
#define EWA_CLI_UPRIGHT_H

#include <stdbool.h>
#include <stddef.h>

/// In the order of the words of --view.
typedef enum named_view {
    VIEW_FRONT,
    VIEW_BACK,
    VIEW_LEFT,
    VIEW_RIGHT,
    VIEW_TOP,
    VIEW_BOTTOM,
    VIEW_ISO
} named_view;

/// What the kind of a file says about its axes.
typedef enum up_convention {
    UP_ANY,       ///< nothing: y is as good as z
    UP_Y_USUAL,   ///< OBJ
    UP_Z_USUAL,   ///< STL
    UP_Y_REQUIRED ///< glTF
} up_convention;

/// The convention that the suffixes of all of some files share.
up_convention upright_convention(size_t path_count, const char *const *paths);

/// How a cloud is looked at.
typedef struct upright {
    int axis;         ///< that points up: 1 y, 2 z
    bool reversed;    ///< its negative does: y down and z ahead, as cameras have it
    named_view view;  ///< with that axis up
    bool from_origin; ///< the eye belongs at the origin
    const char *why;  ///< for which reason
} upright;

/// Chooses by the positions of some points alone, in any order: `offsets` from
/// `middle_world`. Cheap: a few passes over the points.
upright upright_choose(size_t count, const double (*offsets)[3], const double middle_world[3],
                       up_convention convention);

/// Names the place that a cloud is seen from: a word of --view, or "the origin".
const char *upright_place(const upright *chosen);

/// Writes what was chosen: "z (map coordinates), seen from iso".
void upright_describe(const upright *chosen, size_t text_bytes, char *text);

/// The view of a cloud of the size `extent` (three numbers) with y (1) or z (2) up: from the front, unless
/// that hides what is long or shows what is wide from its edge.
named_view upright_view(const double extent[3], int axis);

#endif
