// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Services of a viewer whose files are names of generated objects.
#ifndef EWA_TESTS_VIEWER_VIEW_CONTENTS_H
#define EWA_TESTS_VIEWER_VIEW_CONTENTS_H

#include "viewer/viewer.h"

#include <stdatomic.h>

enum { CONTENTS_POINTS = 20000, CONTENTS_OCTREE_POINTS = 150000 };

/// What the services are asked to do beside, and what they saw.
typedef struct view_contents {
    atomic_int loads, frees;
    ewa_context *context; ///< of the loading thread; to be destroyed after the viewer
    atomic_bool holds; ///< loads wait, with progress, until this is false
    char said[1024], message[1024], clipboard[4096];
    bool preview; ///< loads show one first
} view_contents;

/// "plane", "sphere", "torus": objects of CONTENTS_POINTS points; "volume": a blob; "octree": the torus in a file of
/// the build's folder, of CONTENTS_OCTREE_POINTS; anything else fails.
viewer_services view_contents_services(view_contents *contents);

/// A viewer of nothing, 64 x 48 pixels, of one thread, whose orders are carried out before it goes on.
viewer *view_contents_viewer(view_contents *contents);

#endif
