// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where clouds go.
#include "cli/convert/cloud_output.h"
#include "cli/base/outputs.h"
#include "cli/base/pattern.h"

#include <string.h>
#include <strings.h>

#define AT(member) offsetof(output_arguments, member)

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(path), "FILE",
     .help = "file to write (.ply, .las, .laz, .pcd, .xyz, .txt, .pts, .csv); -: PLY to standard output",
     .letter = 'o'},
    {"ascii", OPTION_FLAG, AT(ascii), .help = "write text instead of little-endian binary",
     .excludes = "big-endian"},
    {"big-endian", OPTION_FLAG, AT(big_endian), .help = "write big-endian binary"},
};

const option_group cloud_output_options = OPTION_GROUP("Output", output_table);

bool cloud_output_has_faces(const output_arguments *output) {
    const char *dot = strrchr(output->path, '.');
    return strcmp(output->path, "-") == 0 || (dot && strcasecmp(dot, ".ply") == 0);
}

bool cloud_output_check(const output_arguments *output, char message[OPTION_ERROR_BYTES]) {
    const char *dot = output->path ? strrchr(output->path, '.') : NULL;
    const bool ply = !dot || cloud_output_has_faces(output), pcd = dot && strcasecmp(dot, ".pcd") == 0;
    if ((output->ascii && !ply && !pcd) || (output->big_endian && !ply)) {
        snprintf(message, OPTION_ERROR_BYTES, "--%s: %s files have one encoding",
                 output->ascii ? "ascii" : "big-endian", dot);
        return false;
    }
    if (output->path && path_has_suffix(output->path, ".copc.laz")) {
        snprintf(message, OPTION_ERROR_BYTES, "--output: octrees are made by 'ewa lod IN... -o %.200s'", output->path);
        return false;
    }
    if (output->path)
        return output_check_suffix("output", output->path,
                                   output->gaussians
                                       ? ".ply|.las|.laz|.pcd|.xyz|.txt|.asc|.pts|.csv|.splat|.spz|.glb|.sog|meta.json|lod-meta.json|-"
                                       : ".ply|.las|.laz|.pcd|.xyz|.txt|.asc|.pts|.csv|-",
                                   message);
    snprintf(message, OPTION_ERROR_BYTES, "no output; say -o FILE");
    return false;
}

void cloud_output_options_fill(const output_arguments *output, ewa_cloud_save_options *options) {
    ewa_cloud_save_options_init(options, sizeof *options);
    if (output->ascii) options->ply_encoding = EWA_PLY_ASCII;
    if (output->big_endian) options->ply_encoding = EWA_PLY_BINARY_BIG_ENDIAN;
}

bool cloud_output_save(cli_session *session, const output_arguments *output, const ewa_cloud *cloud,
                       const ewa_elements *elements) {
    ewa_cloud_save_options options;
    cloud_output_options_fill(output, &options);
    options.elements = elements;
    session->subject = output->path;
    if (!session_passed(session, ewa_cloud_save(cloud, output->path, &options))) return false;
    session_say(session, "%s: %llu points written", output->path,
                (unsigned long long)ewa_cloud_point_count(cloud));
    return true;
}

int cloud_output_run(const void *arguments, ewa_cloud *(*make)(cli_session *session, const void *arguments)) {
    const output_arguments *output = arguments;
    cli_session session;
    if (!session_start(&session, &output->common)) return session_end(&session, EXIT_FAILED);
    ewa_cloud *cloud = make(&session, arguments);
    const bool done = cloud && cloud_output_save(&session, output, cloud, NULL);
    ewa_cloud_destroy(&cloud);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}
