// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Who of several processes draws which frame.
#include "dividing.h"

#include <stdlib.h>

/// All draw the frames that the first one has chosen: what it saw of files that are there others may not see.
static ewa_status agree(cli_session *session, frame_cameras *frames) {
    const cli_crew *crew = session->crew;
    int64_t *wanted = calloc(frames->count, sizeof *wanted);
    if (!wanted) return EWA_ERROR_MEMORY;
    for (size_t i = 0; i < frames->chosen_count && crew_leads(crew); i++) wanted[frames->chosen[i]] = 1;
    const ewa_status status = ewa_exchange_add(session->context, &crew->exchange, wanted, frames->count);
    frames->chosen_count = 0;
    for (size_t i = 0; i < frames->count && status == EWA_OK; i++)
        if (wanted[i]) frames->chosen[frames->chosen_count++] = i;
    free(wanted);
    return status;
}

bool dividing_choose(cli_session *session, frame_cameras *frames) {
    const cli_crew *crew = session->crew;
    if (!crew) return true;
    const ewa_status status = agree(session, frames);
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    if (crew->shares_cloud) return true;
    size_t kept = 0;
    for (size_t i = crew->exchange.rank; i < frames->chosen_count; i += crew->exchange.rank_count)
        frames->chosen[kept++] = frames->chosen[i];
    frames->chosen_count = kept;
    return true;
}

bool dividing_check(cli_session *session, bool many, bool film, bool volume) {
    const cli_crew *crew = session->crew;
    const char *wrong = NULL;
    if (crew_shares_cloud(crew) && volume)
        wrong = "--split cloud: what a volume shows depends on the order of depth, which sums of parts do "
                "not have; "
                "--split frames divides its films";
    else if (crew && !crew->shares_cloud && !many)
        wrong = "--split frames: there is one picture only; --split cloud draws one together";
    else if (crew && !crew->shares_cloud && film)
        wrong = "--split frames: the frames go to numbered files, not to a film";
    if (wrong) session_fail(session, "%s", wrong);
    return !wrong;
}
