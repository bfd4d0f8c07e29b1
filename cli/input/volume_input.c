// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes from the files of the command line.
#include "cli/input/volume_input.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

void volume_input_set_defaults(volume_input_arguments *arguments) { arguments->type = -1; }

bool volume_input_check(const volume_input_arguments *arguments, char message[OPTION_ERROR_BYTES]) {
    const char *wrong = NULL;
    for (uint32_t k = 0; k < arguments->dims.count; k++) {
        const double side = arguments->dims.values[k];
        if (!(side >= 1 && side <= 4294967295.0) || side != (double)(uint32_t)side)
            wrong = "--dims: three whole numbers from 1 on";
    }
    for (uint32_t k = 0; k < arguments->spacing.count; k++)
        if (!(arguments->spacing.values[k] > 0)) wrong = "--spacing: three numbers > 0";
    return options_fine(wrong, message);
}

bool volume_input_load(cli_session *session, const volume_input_arguments *arguments, const char *path,
                       ewa_volume *volume) {
    // In the order of the words of --type.
    static const ewa_type types[] = {EWA_F32, EWA_F64, EWA_I8, EWA_U8, EWA_I16, EWA_U16, EWA_I32, EWA_U32};
    session->subject = path;
    ewa_volume_load_options options;
    ewa_volume_load_options_init(&options, sizeof options);
    for (uint32_t k = 0; k < arguments->dims.count; k++)
        options.dims[k] = (uint32_t)arguments->dims.values[k];
    for (uint32_t k = 0; k < arguments->spacing.count; k++)
        options.spacing_world[k] = arguments->spacing.values[k];
    if (arguments->type >= 0) options.type = (int)types[arguments->type];
    options.big_endian = arguments->big_endian;
    options.header_bytes = (uint64_t)arguments->header_bytes;
    const double started_s = clock_now_s();
    if (!session_passed(session, ewa_volume_load(session->context, path, &options, volume))) return false;
    session_say(session, "%s: %u x %u x %u voxels of %s read in %.3f s", path, volume->dims[0],
                volume->dims[1], volume->dims[2], ewa_type_name(volume->type), clock_now_s() - started_s);
    return true;
}
