// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points or triangles: the one place where the program decides which of them a file holds.
#ifndef EWA_CLI_INPUT_MODEL_INPUT_H
#define EWA_CLI_INPUT_MODEL_INPUT_H

#include "cli/base/session.h"

/// Loads a file of points or triangles; `wanted` are EWA_MODEL_* bits. Formats that the library does not read
/// are read by the helper program, where there is one. False after reporting, also for a volume and a file
/// without points; free with ewa_model_free() in any case.
bool model_input_load(cli_session *session, const char *path, uint32_t wanted, ewa_model *model);

#endif
