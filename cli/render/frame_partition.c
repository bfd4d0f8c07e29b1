// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Partition of the frames of a film among several processes.
#include "cli/render/frame_partition.h"

#include <stdlib.h>

/// All draw the frames that the first one has chosen: what it saw of files that are there others may not see.
static ewa_status agree(cli_session *session, frame_cameras *frames) {
    const cli_process_group *group = session->group;
    int64_t *wanted = calloc(frames->count, sizeof *wanted);
    if (!wanted) return EWA_ERROR_MEMORY;
    for (size_t i = 0; i < frames->chosen_count && process_group_leads(group); i++)
        wanted[frames->chosen[i]] = 1;
    const ewa_status status = ewa_exchange_add(session->context, &group->exchange, wanted, frames->count);
    frames->chosen_count = 0;
    for (size_t i = 0; i < frames->count && status == EWA_OK; i++)
        if (wanted[i]) frames->chosen[frames->chosen_count++] = i;
    free(wanted);
    return status;
}

bool frame_partition_choose(cli_session *session, frame_cameras *frames) {
    const cli_process_group *group = session->group;
    if (!group) return true;
    if (!session_passed(session, agree(session, frames))) return false;
    if (group->shares_cloud) return true;
    size_t kept = 0;
    for (size_t i = group->exchange.rank; i < frames->chosen_count; i += group->exchange.rank_count)
        frames->chosen[kept++] = frames->chosen[i];
    frames->chosen_count = kept;
    return true;
}

bool frame_partition_check(cli_session *session, bool many, bool film, bool volume) {
    const cli_process_group *group = session->group;
    const char *wrong = NULL;
    if (process_group_shares_cloud(group) && volume)
        wrong = "--split cloud: what a volume shows depends on the order of depth, which sums of parts do "
                "not have; "
                "--split frames divides its films";
    else if (group && !group->shares_cloud && !many)
        wrong = "--split frames: there is one picture only; --split cloud draws one together";
    else if (group && !group->shares_cloud && film)
        wrong = "--split frames: the frames go to numbered files, not to a film";
    if (wrong) session_fail(session, "%s", wrong);
    return !wrong;
}
