// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What reading and writing scene files share: which members there are, and what they set.
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

/// A file that is being read, and the one that names it.
typedef struct ewa_scene_reading {
    const struct ewa_scene_reading *by;
    const char *path;
    const ewa_scene_text *text;
    double to_world[16];
    bool visible;
    uint32_t depth;
} ewa_scene_reading;

/// Says what is wrong with a member, with the file and the place in it.
ewa_status ewa_scene_fail_at(const ewa_scene_reading *in, const ewa_scene_member *member, const char *what);

/// Sets an option from a member.
ewa_status ewa_scene_set_option(const ewa_scene_reading *in, const ewa_scene_member *member, const ewa_option *option,
                                void *options);

/// Reads the measurements of a text: text->measure_count.
ewa_status ewa_scene_read_measures(const ewa_scene_reading *in, ewa_measure *measures);

/// Sets all that a text says of options; `only_defaults`: where the options have their default.
ewa_status ewa_scene_apply_text(const ewa_scene_reading *in, bool only_defaults, ewa_scene_options *options);

#endif
