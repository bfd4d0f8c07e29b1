// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of Gaussians from the files of the command line.
#define _POSIX_C_SOURCE 200809L
#include "cli/input/gaussian_files.h"

#include <string.h>
#include <sys/stat.h>

ewa_gaussian_format gaussian_files_format(cli_session *session, const char *path) {
    struct stat facts;
    ewa_gaussian_format format = EWA_GAUSSIANS_NONE;
    // What is missing is said by who wants to read it.
    if (strcmp(path, "-") == 0 || stat(path, &facts) != 0 || !(S_ISREG(facts.st_mode) || S_ISDIR(facts.st_mode))) return format;
    session->subject = path;
    return ewa_gaussians_probe(session->context, path, &format) == EWA_OK ? format : EWA_GAUSSIANS_NONE;
}

bool gaussian_files_load(cli_session *session, const char *path, ewa_gaussians *set,
                         ewa_gaussian_facts *facts) {
    ewa_gaussian_facts found;
    session->subject = path;
    const double started_s = clock_now_s();
    if (!session_passed(session, ewa_gaussians_load(session->context, path, set, &found))) return false;
    session_say(session, "%s: %u Gaussians read in %.3f s (%s)", path, set->count, clock_now_s() - started_s,
                ewa_gaussian_format_name(found.format));
    if (facts) *facts = found;
    return true;
}

ewa_cloud *gaussian_files_load_surfels(cli_session *session, const char *path) {
    ewa_gaussians set;
    ewa_cloud *cloud = NULL;
    ewa_gaussian_facts facts;
    if (!gaussian_files_load(session, path, &set, &facts)) return NULL;
    const ewa_status status = ewa_gaussians_to_cloud(&set, &cloud);
    ewa_gaussians_free(&set);
    if (status != EWA_OK) session_failed(session, status);
    return cloud;
}
