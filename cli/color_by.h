// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours from an attribute.
#ifndef EWA_CLI_COLOR_BY_H
#define EWA_CLI_COLOR_BY_H

#include "session.h"

/// Writes the name of the attribute that "ATTR", "ATTR.x" or "x" means to `name` and its component to
/// `*component`. Returns false after reporting when the cloud has no such attribute.
bool color_by_find(cli_session *session, const ewa_cloud *cloud, const char *word, char name[EWA_NAME_BYTES],
                   uint32_t *component);

/// Replaces the colours of a cloud by those of one component of an attribute; numbers that are not finite
/// become grey. A `range` that is not given: from the least to the greatest. Returns false after reporting.
bool color_by(cli_session *session, ewa_cloud *cloud, const char *word, ewa_colormap colormap,
              const option_bounds *range);

#endif
