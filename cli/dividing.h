// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Who of several processes draws which frame.
#ifndef EWA_CLI_DIVIDING_H
#define EWA_CLI_DIVIDING_H

#include "frames.h"

/// Whether the processes of the session can share a run of one picture, or of `many`, into a `film`; of a `volume`, not
/// the single picture. False after reporting; true where there is but one process.
bool dividing_check(cli_session *session, bool many, bool film, bool volume);

/// Leaves of the frames that were planned those that this process takes part in. All processes are to call it. False after
/// reporting.
bool dividing_choose(cli_session *session, frame_cameras *frames);

#endif
