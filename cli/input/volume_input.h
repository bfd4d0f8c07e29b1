// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes from the files of the command line.
#ifndef EWA_CLI_INPUT_VOLUME_INPUT_H
#define EWA_CLI_INPUT_VOLUME_INPUT_H

#include "cli/base/session.h"

/// Options of what a volume file does not say.
typedef struct volume_input_arguments {
    option_vector dims, spacing;
    int type; ///< index of the word of --type; -1: not given
    bool big_endian;
    int64_t header_bytes;
} volume_input_arguments;

// clang-format off
/// Rows of an option table; `at` is the offset of the volume_input_arguments in the command's arguments.
#define VOLUME_INPUT_OPTIONS(at)                                                                             \
    {"dims", OPTION_VECTOR, (at) + offsetof(volume_input_arguments, dims), "x,y,z",                          \
     .help = "the file is raw numbers, also in gzip, x fastest: how many along each axis", .low = 3,         \
     .high = 3, .absent = "auto: as the file or its name says"},                                                   \
        {"type", OPTION_CHOICE, (at) + offsetof(volume_input_arguments, type), NULL,                         \
         "float|double|char|uchar|short|ushort|int|uint", .help = "type of raw numbers",                     \
         .absent = "auto: as the file's name says, else uchar", .needs = "dims"},                                  \
        {"big-endian", OPTION_FLAG, (at) + offsetof(volume_input_arguments, big_endian),                     \
         .help = "raw numbers have their highest byte first", .needs = "dims"},                              \
        {"header-bytes", OPTION_INTEGER, (at) + offsetof(volume_input_arguments, header_bytes), "N",         \
         "[0, inf)", .help = "bytes in front of raw numbers", .needs = "dims"},                              \
    {                                                                                                        \
        "spacing", OPTION_VECTOR, (at) + offsetof(volume_input_arguments, spacing), "x,y,z", .low = 3,       \
            .high = 3, .absent = "auto: as the file says, else 1,1,1",                                             \
            .help = "distances of the voxels along each axis, in world units"                                \
    }
// clang-format on

void volume_input_set_defaults(volume_input_arguments *arguments);

/// What is wrong with the options together; see command.check.
bool volume_input_check(const volume_input_arguments *arguments, char message[OPTION_ERROR_BYTES]);

/// Loads a volume. Returns false after reporting; free with ewa_volume_free() in any case.
bool volume_input_load(cli_session *session, const volume_input_arguments *arguments, const char *path,
                       ewa_volume *volume);

#endif
