// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture leaves out: a box and planes that cut the scene.
#include "cli/render/section.h"

#include <string.h>

enum { BOX_PLANES = 6 };

_Static_assert(EWA_MAX_SECTION_PLANES == 8 && OPTION_VECTORS_MAX == 8, "the help of --clip-plane says so");

bool section_check(const section_arguments *arguments, char message[OPTION_ERROR_BYTES]) {
    const char *wrong = NULL;
    const double *box = arguments->box.values;
    for (int c = 0; arguments->box.count && c < 3; c++)
        if (box[c] > box[c + 3]) wrong = "--clip-box: the first corner is not the lower one";
    for (uint32_t i = 0; i < arguments->planes.count; i++) {
        const double *plane = arguments->planes.each[i].values;
        if (plane[0] == 0 && plane[1] == 0 && plane[2] == 0) wrong = "--clip-plane: 0,0,0,d has no normal";
    }
    if (arguments->box.count && BOX_PLANES + arguments->planes.count > EWA_MAX_SECTION_PLANES)
        wrong = "--clip-plane: given more than twice beside --clip-box";
    return options_fine(wrong, message);
}

void section_fill(const section_arguments *arguments, double planes[][4], uint32_t *count) {
    *count = 0;
    for (int side = 0; arguments->box.count && side < BOX_PLANES; side++) {
        double *plane = planes[(*count)++];
        const int axis = side / 2, inward = side % 2 ? -1 : 1;
        memset(plane, 0, 4 * sizeof *plane);
        plane[axis] = inward;
        plane[3] = -inward * arguments->box.values[axis + 3 * (side % 2)];
    }
    for (uint32_t i = 0; i < arguments->planes.count; i++)
        memcpy(planes[(*count)++], arguments->planes.each[i].values, sizeof planes[0]);
}
