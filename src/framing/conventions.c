// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is up in the files of a kind. Files that say it themselves (glTF by its specification, SPZ by its own or by an
// extension, PLY of nerfstudio by a comment) are told by their readers.
#include "framing/conventions.h"

#include <string.h>
#include <strings.h>

const double ewa_up_of_gaussians[3] = {0, -1, 0};
const double ewa_up_of_volumes[3] = {0, 0, 1};

/// By the end of the name. PLY, OFF and text are of no convention: as many have y up as z.
static const struct {
    const char *end;
    ewa_up_convention convention;
} kinds[] = {
    {".gltf", EWA_UP_Y_REQUIRED},    {".glb", EWA_UP_Y_REQUIRED}, // specified
    {".obj", EWA_UP_Y_USUAL},        {".stl", EWA_UP_Z_USUAL},    // of modellers; of machines that print layers
    {".las", EWA_UP_Z_SURVEYED},     {".laz", EWA_UP_Z_SURVEYED}, // elevations, COPC too
    {"ept.json", EWA_UP_Z_SURVEYED}, {".e57", EWA_UP_Z_SURVEYED}, // and levelled instruments
    {".ptx", EWA_UP_Z_SURVEYED},     {".pts", EWA_UP_Z_SURVEYED},
    {".tif", EWA_UP_Z_SURVEYED},     {".tiff", EWA_UP_Z_SURVEYED}, // heights
    {".pcd", EWA_UP_CAMERA_USUAL}, // as its VIEWPOINT is, unless it says otherwise
};

static bool ends_with(const char *path, const char *end) {
    const size_t length = strlen(path), end_length = strlen(end);
    return length >= end_length && strcasecmp(path + length - end_length, end) == 0;
}

ewa_up_convention ewa_up_convention_of(size_t path_count, const char *const *paths) {
    ewa_up_convention shared = EWA_UP_ANY;
    for (size_t i = 0; i < path_count; i++) {
        ewa_up_convention own = EWA_UP_ANY;
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
            if (ends_with(paths[i], kinds[k].end)) own = kinds[k].convention;
        if (i > 0 && own != shared) return EWA_UP_ANY;
        shared = own;
    }
    return shared;
}

int ewa_up_axis_of(ewa_up_convention convention) {
    static const int axes[] = {0, 1, 2, 1, 2, 0};
    return (unsigned)convention < sizeof axes / sizeof axes[0] ? axes[convention] : 0;
}
