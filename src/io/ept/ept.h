// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Entwine Point Tiles: a folder with a description, a hierarchy of nodes and a file for the points of each.
//
// Based on: Hobu, "Entwine Point Tile", 1.1.0.
#ifndef EWA_SRC_EPT_H
#define EWA_SRC_EPT_H

#include "io/file.h"
#include "io/json_text.h"
#include "io/las/las_open.h"
#include "io/octree_format.h"

enum {
    EWA_EPT_VERSION_BYTES = 24,
    EWA_EPT_NAME_BYTES = 96, ///< of a file in the folder
    EWA_EPT_FOLDER_BYTES = 4000,
    EWA_EPT_PATH_BYTES = EWA_EPT_FOLDER_BYTES + EWA_EPT_NAME_BYTES,
};

/// How the files hold the points of nodes.
typedef enum ewa_ept_encoding {
    EWA_EPT_LASZIP,
    EWA_EPT_BINARY,
    EWA_EPT_ZSTANDARD, ///< what EWA_EPT_BINARY has, packed
} ewa_ept_encoding;

/// The file of a node that is read.
typedef struct ewa_ept_file {
    ewa_file bytes;
    ewa_laz_layout layout; ///< of EWA_EPT_LASZIP
} ewa_ept_file;

typedef struct ewa_ept {
    ewa_context *context;
    char folder[EWA_EPT_FOLDER_BYTES];
    char kind[EWA_EPT_VERSION_BYTES];
    ewa_ept_encoding encoding;
    ewa_las_table table;    ///< of the records that the files have or unpack to
    double offset_world[3]; ///< world coordinates of the positions' number 0
    ewa_las_header
        header;       ///< of EWA_EPT_LASZIP: of the first node, whose records those of all others are like
    ewa_laz_plan laz; ///< the same
    uint32_t worker_count;
    ewa_laz_memory **memories; ///< one per worker
    ewa_buffer *records;       ///< one per worker
    ewa_ept_file files[EWA_OCTREE_WAVE];
} ewa_ept;

/// Text of a file as messages and names may have it: printable, cut to what fits; NULL is "none".
enum { EWA_EPT_SHOWN_BYTES = 61 };
static inline const char *ewa_ept_show(const char *text, char shown[EWA_EPT_SHOWN_BYTES]) {
    if (!text) return "none";
    ewa_las_text((const uint8_t *)text, strnlen(text, EWA_EPT_SHOWN_BYTES - 1), shown);
    return shown;
}

/// Maps a file of the folder; `what` is "ept-data/" or such, which keys and suffix follow. `path` stands for it in messages.
/// Errors: EWA_ERROR_IO.
ewa_status ewa_ept_open(const ewa_ept *ept, const char *what, const ewa_octree_key *key, const char *suffix,
                        char path[EWA_EPT_PATH_BYTES], ewa_file *file);

/// Reads "ept.json": the facts of the tree, how points are held, notes; of binary points the table of their records.
/// Errors: EWA_ERROR_IO, EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_ept_describe(ewa_octree *octree, ewa_ept *ept, uint64_t *point_count);

/// Makes the table of binary records from a schema. `low_world` is about the lowest place of the points. Errors:
/// EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED.
ewa_status ewa_ept_schema(const char *name, const cJSON *schema, const double low_world[3], ewa_ept *ept);

/// Reads the hierarchy, all files of it, into the tree's nodes. Errors: EWA_ERROR_IO, EWA_ERROR_FORMAT,
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_ept_hierarchy(ewa_octree *octree, const ewa_ept *ept);

#endif
