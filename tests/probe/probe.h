// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A fixed set of library calls over all rooms, and what they return as named lists of numbers: says whether a
// change of the code changes what the library does (tools/mutate.py, docs/testing.md).
#ifndef EWA_TESTS_PROBE_H
#define EWA_TESTS_PROBE_H

#include "ewa/ewa.h"
#include "tests/defaults.h"
#include "tests/owned.h"

#include <stdio.h>

/// How two lists are compared.
typedef enum probe_kind {
    PROBE_NUMBERS = 0, ///< 1e-3 relative; below a thousandth of the list's largest number, of that
    PROBE_PICTURE = 1, ///< 1/255, colours in [0, 1]
    PROBE_PLANE = 2,   ///< 1/255 of the list's largest finite number
} probe_kind;

/// Where the numbers of a run go.
typedef struct probe {
    FILE *file;
    ewa_context *context;
    const char *source_dir; ///< of the tests
    const char *scratch;    ///< a folder for files
    char prefix[64];        ///< of all names
    bool brief;             ///< leave out the references, and cases of which there are others
} probe;

void probe_doubles(probe *to, const char *name, probe_kind kind, const double *values, size_t count);
void probe_floats(probe *to, const char *name, probe_kind kind, const float *values, size_t count);
void probe_number(probe *to, const char *name, double value);
void probe_status(probe *to, const char *name, ewa_status status);

/// Every attribute of a cloud, its origin and count; a NULL cloud is recorded as such.
void probe_cloud(probe *to, const char *name, const ewa_cloud *cloud);
void probe_image(probe *to, const char *name, const ewa_image *image);
void probe_camera(probe *to, const char *name, const ewa_camera *camera);

/// A frame with all planes but rgba8, which the caller frees with probe_frame_free(); `normals` may be left
/// out.
ewa_frame probe_frame(const ewa_camera *camera, bool normals);
void probe_frame_free(ewa_frame *frame);
void probe_frame_put(probe *to, const char *name, const ewa_camera *camera, const ewa_frame *frame);

/// A camera of 64 pixels a side on a box, as ewa_camera_frame() places it.
ewa_camera probe_view(const ewa_bounds *bounds, double x, double y, double z, bool orthographic);

/// The same numbers everywhere, in [0, 1).
double probe_random(uint64_t *state);

void probe_math(probe *to);
void probe_files(probe *to);
void probe_generated(probe *to);
void probe_estimates(probe *to);
void probe_edited(probe *to);
void probe_solids(probe *to);
void probe_features(probe *to);
void probe_textured(probe *to);
void probe_sampled(probe *to);
void probe_pictures(probe *to);
void probe_splats(probe *to);
void probe_resample(probe *to);
void probe_volumes(probe *to);

#endif
