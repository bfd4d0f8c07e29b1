// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What reading and writing scene files share: which members there are.
#ifndef EWA_SRC_SCENE_FILE_H
#define EWA_SRC_SCENE_FILE_H

#include "ewa/scene_file.h"
#include "io/scene_text.h"
#include "scene/parts.h"

enum { EWA_SCENE_LIGHT_ROWS = 2 };

/// Members of a light.
extern const ewa_option ewa_scene_light_rows[EWA_SCENE_LIGHT_ROWS];

/// The table of a section of "options", and where in the options its struct is.
const ewa_option_table *ewa_scene_section_table(ewa_scene_section section, ewa_scene_options *options,
                                                void **part);

/// Whether two structs have the same value of an option.
bool ewa_scene_option_is_same(const ewa_option *option, const void *options, const void *others);

/// Whether scene files have an option.
bool ewa_scene_option_is_kept(const ewa_option *option);

#endif
