// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Partition of the frames of a film among several processes.
#ifndef EWA_CLI_RENDER_FRAME_PARTITION_H
#define EWA_CLI_RENDER_FRAME_PARTITION_H

#include "cli/render/frames.h"

/// Whether the processes of the session can share a run of one picture, or of `many`, into a `film`; of a `volume`, not
/// the single picture. False after reporting; true where there is but one process.
bool frame_partition_check(cli_session *session, bool many, bool film, bool volume);

/// Leaves of the frames that were planned those that this process takes part in. All processes are to call it. False after
/// reporting.
bool frame_partition_choose(cli_session *session, frame_cameras *frames);

#endif
