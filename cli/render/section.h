// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture leaves out: a box and planes that cut the scene.
#ifndef EWA_CLI_RENDER_SECTION_H
#define EWA_CLI_RENDER_SECTION_H

#include "cli/base/options.h"

#include "ewa/render.h"

/// Options of sections.
typedef struct section_arguments {
    option_vector box;     ///< low corner, high corner
    option_vectors planes; ///< a, b, c, d: keep a x + b y + c z + d >= 0
} section_arguments;

/// Rows of an option table; `at` is the offset of the section_arguments in the command's arguments.
#define SECTION_OPTIONS(at)                                                                                  \
    {"clip-box",                                                                                             \
     OPTION_VECTOR,                                                                                          \
     (at) + offsetof(section_arguments, box),                                                                \
     "x0,y0,z0,x1,y1,z1",                                                                                    \
     .help =                                                                                                 \
         "draw only what lies inside a box: its lower, then its upper corner, in the file's coordinates",    \
     .low = 6,                                                                                               \
     .high = 6},                                                                                             \
    {                                                                                                        \
        "clip-plane", OPTION_VECTORS, (at) + offsetof(section_arguments, planes), "a,b,c,d",                 \
            .help = "draw only what fulfils a x + b y + c z + d >= 0; may be given up to 8 times, beside "   \
                    "--clip-box twice",                                                                      \
            .low = 4, .high = 4                                                                              \
    }

/// Says in `message` what is wrong with the options together; see command.check.
bool section_check(const section_arguments *arguments, char message[OPTION_ERROR_BYTES]);

/// Fills in the section planes of a picture; there is room for EWA_MAX_SECTION_PLANES.
void section_fill(const section_arguments *arguments, double planes[][4], uint32_t *count);

#endif
