// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a page shows, as files in a folder of its own beside a scene file that names them.
#ifndef EWA_CLI_PAGE_DATA_H
#define EWA_CLI_PAGE_DATA_H

#include "cli/base/path.h"
#include "cli/page/page_assets.h"

enum { PAGE_NAME_BYTES = 256 };

#define PAGE_SCENE_NAME "scene.json"

/// Names of the files in the folder, the scene file last.
typedef struct page_data {
    char folder[PATH_BYTES];
    char (*names)[PAGE_NAME_BYTES];
    size_t count, room;
} page_data;

/// What is put there, and how.
typedef struct page_choice {
    const char *const *paths; ///< files and scene files
    size_t count;
    const ewa_asset_options *assets;
    const ewa_coloring *coloring; ///< of points that have none
    const ewa_scene_options *options;
    const ewa_camera *camera; ///< NULL: each reader's window decides
    bool small;               ///< clouds of bare points become LAZ, Gaussians SPZ
} page_choice;

/// Copies every file into `data->folder`, which is there and empty, or writes it anew where a page cannot read it: other formats of
/// points become PLY, meshes points on their faces, Gaussians SPZ, volumes NRRD. Then writes the scene file. False after reporting;
/// free with page_data_free() in any case.
bool page_data_make(cli_session *session, const page_choice *choice, page_data *data);

/// Removes all files, but not the folder.
void page_data_remove(const page_data *data);
void page_data_free(page_data *data);

/// Adds a name to those that are to be removed. False: no memory.
bool page_data_add(page_data *data, const char *name);

#endif
