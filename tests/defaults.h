// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options as they are where nobody says otherwise.
#ifndef EWA_TESTS_DEFAULTS_H
#define EWA_TESTS_DEFAULTS_H

/// Declares options of a type that has an ewa_..._init() for them: WITH_DEFAULTS(ewa_render_options, options);
#define WITH_DEFAULTS(type, name) \
    type name;                    \
    type##_init(&name, sizeof name)

#endif
