// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The thread that reads nodes of octrees while pictures are drawn of those that are there.
#ifndef EWA_VIEWER_NODE_READER_H
#define EWA_VIEWER_NODE_READER_H

#include "painter.h"

typedef struct node_reader node_reader;

/// `turns` outlive it.
ewa_status node_reader_create(octree_turns *turns, node_reader **made);
void node_reader_destroy(node_reader **reader);

/// Has read what a picture of a scene needs, at most `most` nodes at a time, in place of what was asked for before; `moving`: with pauses, for pictures
/// follow each other meanwhile. What the scene points to is borrowed until node_reader_rest().
void node_reader_post(node_reader *reader, const paint_scene *scene, uint32_t most, bool moving);

/// Gives up everything for good. Returns whether nothing is read any more.
bool node_reader_stop(node_reader *reader);
/// Gives up what was asked for and waits until nothing of it is used any more: another scene comes.
void node_reader_rest(node_reader *reader);

/// What it has done.
typedef struct node_reader_state {
    bool busy;              ///< something is read, or will be
    bool ready;             ///< what there is of the scene can be drawn: its coarsest nodes have come, or cannot be read
    uint64_t arrived_count; ///< nodes that have come
} node_reader_state;

void node_reader_tell(node_reader *reader, node_reader_state *state);

#endif
