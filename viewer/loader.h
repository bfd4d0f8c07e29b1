// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The thread that loads files and makes surfels anew, one order after another.
#ifndef EWA_VIEWER_LOADER_H
#define EWA_VIEWER_LOADER_H

#include "viewer.h"

/// What a person has chosen of how a file is loaded. Zeros behind the end of its string: it is compared byte for byte.
typedef struct item_load {
    double to_world[16];              ///< where its coordinates lie
    char transfer[VIEWER_PATH_BYTES]; ///< of a volume: a preset, "auto" or a file; empty: as the scene file says, else automatic
    char colored[VIEWER_PATH_BYTES];  ///< file of its points in colours of photographs, which is read in its place; empty: none
} item_load;

typedef enum loader_kind {
    LOADER_LOAD,    ///< order: a file; report: it is loaded, the asset is the receiver's
    LOADER_PREVIEW, ///< report: something to look at of a file that is still being loaded, the receiver's
    LOADER_SCENE,   ///< order: a scene of assets; report: it is made, the receiver's
    LOADER_VALUES,  ///< order: what a volume's file holds; report: `values` are counted, the receiver's
    LOADER_PHOTOS,  ///< order: colours of photographs; report: they are in the file `photos.to`
    LOADER_FAILED,  ///< report: the order came to nothing; a message has said why
    LOADER_MESSAGE, ///< report: something to know
} loader_kind;

/// What a scene is ordered of; the assets are retained.
typedef struct loader_scene {
    uint32_t count;
    uint64_t items[VIEWER_MAX_ITEMS];
    ewa_asset *assets[VIEWER_MAX_ITEMS];
    ewa_instance instances[VIEWER_MAX_ITEMS];
    viewer_coloring colorings[VIEWER_MAX_ITEMS]; ///< the items' wishes
    ewa_scene_options options;                   ///< of how surfaces are made
} loader_scene;

/// An order, or what came of one.
typedef struct loader_note {
    struct loader_note *next;
    loader_kind kind;
    uint64_t item; ///< whose order it is; 0: a scene's
    char path[VIEWER_PATH_BYTES];
    const ewa_scene_file *file; ///< of an order: that names the file, borrowed; NULL: none does
    uint32_t entry;             ///< which of its files
    item_load load;             ///< of an order of a file
    viewer_values *values;      ///< of a report of LOADER_VALUES
    viewer_photos photos;       ///< of LOADER_PHOTOS
    ewa_photos_report found;    ///< of a report of LOADER_PHOTOS
    ewa_asset *asset;
    bool as_points; ///< of a preview
    loader_scene of;
    ewa_scene *scene;
    ewa_severity severity;
    char text[VIEWER_TEXT_BYTES];
} loader_note;

typedef struct loader loader;

/// `stepped`: it has no thread, and works in loader_step() and loader_wait() only.
ewa_status loader_create(const viewer_services *services, bool stepped, loader **made);
/// Gives up what is under way and frees what nobody took.
void loader_destroy(loader **loader);

/// Orders come after those that wait; false: out of memory.
/// `file` (may be NULL) names the file, as `entry`; it is borrowed until the order is done.
bool loader_load(loader *loader, uint64_t item, const char *path, const ewa_scene_file *file, uint32_t entry,
                 const item_load *load);
/// Orders what values a volume holds, and its transfer function; false: out of memory.
bool loader_count(loader *loader, uint64_t item, const char *path, const item_load *load);
/// Orders a file of an item's points in colours of photographs; false: out of memory. `file`, `entry`: as of loader_load().
bool loader_photos(loader *loader, uint64_t item, const char *path, const ewa_scene_file *file, uint32_t entry,
                   const viewer_photos *photos);
/// Orders a scene in place of one that waits; takes the references of `of` over, also when it returns false.
bool loader_make(loader *loader, loader_scene *of);
/// Gives up what is under way and all that waits. Scenes report that they came to nothing; of files nothing more is reported.
void loader_cancel(loader *loader);
/// Forgets the orders of an item, and gives up the one that is under way: nothing more is reported of them.
void loader_forget(loader *loader, uint64_t item);
/// Gives up everything for good. Returns whether nothing is under way any more.
bool loader_stop(loader *loader);
/// Carries out the oldest order, where there is no thread.
void loader_step(loader *loader);
/// Waits until all orders are done.
void loader_wait(loader *loader);
bool loader_is_busy(loader *loader);
/// Takes the oldest report, which loader_note_free() frees; NULL: there is none.
loader_note *loader_take(loader *loader);
void loader_note_free(loader_note *note);
/// Tells what is being loaded, how far it is and how many orders wait.
void loader_tell(loader *loader, char path[VIEWER_PATH_BYTES], char stage[64], double *fraction,
                 uint32_t *waiting);

#endif
