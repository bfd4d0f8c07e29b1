// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The thread that loads files and makes surfels anew, one order after another.
#ifndef EWA_VIEWER_LOADER_H
#define EWA_VIEWER_LOADER_H

#include "viewer.h"

typedef enum loader_kind {
    LOADER_LOAD,    ///< order: a file; report: it is loaded, the content belongs to the receiver
    LOADER_PREVIEW, ///< report: points of a file that is still being loaded, the receiver's
    LOADER_COLOR,   ///< order: surfels coloured anew; report: they are made, the receiver's
    LOADER_FAILED,  ///< report: the order came to nothing; a message has said why
    LOADER_MESSAGE, ///< report: something to know
} loader_kind;

/// An order, or what came of one.
typedef struct loader_note {
    struct loader_note *next;
    loader_kind kind;
    uint64_t item; ///< whose order it is
    char path[VIEWER_PATH_BYTES];
    viewer_content content; ///< of an order to colour: borrowed
    viewer_coloring coloring;
    ewa_surfels *surfels;
    ewa_severity severity;
    char text[VIEWER_TEXT_BYTES];
} loader_note;

typedef struct loader loader;

ewa_status loader_create(const viewer_services *services, loader **made);
/// Gives up what is under way and frees what nobody took.
void loader_destroy(loader **loader);

/// Orders come after those that wait; false: out of memory.
bool loader_load(loader *loader, uint64_t item, const char *path);
/// Orders surfels; one of the same item that waits is replaced.
bool loader_color(loader *loader, uint64_t item, const viewer_content *content,
                  const viewer_coloring *coloring);
/// Gives up the load that is under way and all that wait.
void loader_cancel(loader *loader);
/// Forgets the orders of an item and waits until none is under way.
void loader_forget(loader *loader, uint64_t item);
/// Waits until all orders are done.
void loader_wait(loader *loader);
bool loader_is_busy(loader *loader);
/// Takes the oldest report, which loader_note_free() frees; NULL: there is none.
loader_note *loader_take(loader *loader);
void loader_note_free(loader_note *note);
/// Tells what is being loaded, how far it is and how many orders wait.
void loader_tell(loader *loader, char path[VIEWER_PATH_BYTES], char stage[64], double *fraction,
                 uint32_t *waiting);

/// Frees what a file gave.
void viewer_content_free(viewer_content *content);

#endif
