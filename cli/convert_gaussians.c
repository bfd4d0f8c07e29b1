// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa convert for Gaussians: to another form of them, moved.
#include "convert_gaussians.h"
#include "gaussian_files.h"

bool convert_gaussians_is_named(const char *path) {
    const ewa_gaussian_format format = ewa_gaussians_format_of(path);
    return format != EWA_GAUSSIANS_NONE && format != EWA_GAUSSIANS_PLY;
}

bool convert_gaussians(cli_session *session, const char *from, const char *to,
                       const ewa_gaussians_save_options *options, const double (*matrices)[16],
                       uint32_t count) {
    ewa_gaussians set;
    if (!gaussian_files_load(session, from, &set, NULL)) return false;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        status = ewa_gaussians_transform(&set, matrices[i]);
    session->subject = to;
    if (status == EWA_OK) status = ewa_gaussians_save(&set, to, options);
    if (status != EWA_OK)
        session_failed(session, status);
    else
        session_say(session, "%s: %u Gaussians written (%s)", to, set.count,
                    ewa_gaussian_format_name(ewa_gaussians_format_of(to)));
    ewa_gaussians_free(&set);
    return status == EWA_OK;
}
