// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a file of points says beside its numbers, for ewa info: where on the earth, on what grid, by whom, what is up;
// and how many points each class has.
#ifndef EWA_CLI_INFO_INFO_FACTS_H
#define EWA_CLI_INFO_INFO_FACTS_H

#include "cli/base/json.h"

/// Prints the coordinate reference system, grid, origin, and the file's own facts; nothing of what there is
/// not.
void info_facts_print(const ewa_cloud *cloud);
void info_facts_write(json_writer *json, const ewa_cloud *cloud);

/// Tells what is up, and from where it is seen.
void info_upright_print(const ewa_upright *upright);
void info_upright_write(json_writer *json, const ewa_upright *upright);

enum { INFO_CLASSES = 256 };

/// Points by class.
typedef struct class_counts {
    const ewa_attribute *attribute; ///< NULL: the cloud has no classes
    uint64_t counts[INFO_CLASSES];
} class_counts;

/// Counts the points of each class of the attribute that is called so, where it holds whole numbers below
/// INFO_CLASSES only.
void info_classes_count(const ewa_cloud *cloud, class_counts *classes);
void info_classes_print(const class_counts *classes);
void info_classes_write(json_writer *json, const class_counts *classes);

#endif
